//! Placeholder, being written.

/// Adjacency of a hull's vertices.
#[derive(Clone, Copy, Debug)]
pub struct HullGraph<'a> {
    words: &'a [u16],
}

/// Length.
pub const fn graph_len(count: usize) -> usize {
    8 * count + 32
}

impl<'a> HullGraph<'a> {
    /// Seeds.
    pub fn seeds(&self) -> &[u16] {
        self.words.get(..0).unwrap_or(&[])
    }
    /// Neighbours.
    pub fn neighbors(&self, _vertex: u16) -> &[u16] {
        &[]
    }
}
