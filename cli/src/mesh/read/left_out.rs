//! What a file has and a mesh has no place for: counted, so that nothing is left out in silence.

use std::collections::BTreeMap;
use std::fmt;

use super::quoted;

/// Kinds of lines that are told by name.
const TOLD: usize = 5;

/// Counts of what is not in the mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LeftOut {
    /// Of no face, in a format that need not keep them.
    pub vertices: usize,
    /// Of fewer than three corners: points and lines.
    pub faces: usize,
    /// Of something else, by its name.
    others: BTreeMap<String, usize>,
}

impl LeftOut {
    /// So many of this name.
    pub fn add(&mut self, name: &str, count: usize) {
        *self.others.entry(quoted(name).chars().take(20).collect()).or_default() += count;
    }

    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }
}

impl fmt::Display for LeftOut {
    /// `2 vertices of no face, 1 face of fewer than three corners, 3 of l`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let some = |count: usize, one: &str, many: &str| match count {
            0 => None,
            1 => Some(format!("1 {one}")),
            _ => Some(format!("{count} {many}")),
        };
        let more: usize = self.others.values().skip(TOLD).sum();
        let known = [
            some(self.vertices, "vertex of no face", "vertices of no face"),
            some(self.faces, "face of fewer than three corners", "faces of fewer than three corners"),
        ];
        let named = self.others.iter().take(TOLD).map(|(name, count)| Some(format!("{count} of `{name}`")));
        let all = known.into_iter().chain(named).chain([some(more, "of another kind", "of other kinds")]);
        f.write_str(&all.flatten().collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_in_words() {
        let mut left = LeftOut::default();
        assert!(left.is_nothing() && left.to_string().is_empty());
        (left.vertices, left.faces) = (1, 2);
        left.add("l", 1);
        left.add("l", 2);
        assert_eq!(left.to_string(), "1 vertex of no face, 2 faces of fewer than three corners, 3 of `l`");
        assert!(!left.is_nothing());
        let mut junk = LeftOut::default();
        (0..9).for_each(|i| junk.add(&format!("{i}{}", "x".repeat(100)), 1));
        let told = junk.to_string();
        assert!(told.ends_with("1 of `4xxxxxxxxxxxxxxxxxxx`, 4 of other kinds"), "{told}");
    }
}
