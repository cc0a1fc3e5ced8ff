//! OFF: `OFF` (it may be missing), the numbers of vertices, faces and edges, then coordinates, then polygons: their size, their corners, and perhaps
//! a colour; one line each.

use super::{Triangles, coordinates, corner, quoted, text};
use crate::Trouble;

/// What is left of the file, in lines with their numbers; comments and empty lines are left out.
struct Lines<'a, I: Iterator<Item = (usize, &'a str)>>(I);

impl<'a, I: Iterator<Item = (usize, &'a str)>> Lines<'a, I> {
    fn next(&mut self, what: &str) -> Result<(usize, &'a str), Trouble> {
        self.0.next().ok_or(format!("the file ends where {what} should be"))
    }
}

pub fn read(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let text = text(bytes);
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let mut lines = Lines((1..).zip(lines).filter(|(_, line)| !line.is_empty()));
    let (mut number, mut head) = lines.next("OFF, or the counts,")?;
    if let Some(rest) = head.strip_prefix("OFF") {
        (number, head) = if rest.trim().is_empty() { lines.next("the counts")? } else { (number, rest.trim()) };
    }
    let counts: Option<Vec<usize>> = head.split_whitespace().map(|word| word.parse().ok()).collect();
    let Some(&[vertices, faces] | &[vertices, faces, _]) = counts.as_deref() else {
        return Err(format!("line {number}: `{}` is not the numbers of vertices, faces and edges", quoted(head)));
    };
    let mut mesh = Triangles::default();
    for i in 0..vertices {
        let (number, line) = lines.next(&format!("vertex {i} of {vertices}"))?;
        mesh.vertices
            .push(coordinates(line.split_whitespace()).map_err(|trouble| format!("line {number}: {trouble}"))?);
    }
    for i in 0..faces {
        let (number, line) = lines.next(&format!("face {i} of {faces}"))?;
        let corners = polygon(line, vertices).map_err(|trouble| format!("line {number}: {trouble}"))?;
        mesh.push_polygon(&corners);
    }
    match lines.0.next() {
        Some((number, _)) => Err(format!("line {number}: here is more than {vertices} vertices and {faces} faces")),
        None => Ok(mesh),
    }
}

fn polygon(line: &str, vertices: usize) -> Result<Vec<u32>, Trouble> {
    let mut words = line.split_whitespace();
    let mut next = |what: &str| {
        let word = words.next().ok_or(format!("the line ends where {what} should be"))?;
        word.parse::<i64>().map_err(|_| format!("`{}` is no whole number, as {what} must be", quoted(word)))
    };
    let size = next("the size of a face")?;
    if size < 0 {
        return Err(format!("{size} is no size of a face"));
    }
    (0..size).map(|k| next(&format!("corner {k} of {size}")).and_then(|index| corner(index, vertices))).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::expected;
    use super::*;

    const BODY: &str = "5 2 0\n0 0 0\n1 0 0 # a corner\n\n1 1 0.5\n0 1 0\n0.1 0 -1\n4 0 1 2 3 255 0 0\n3 1 0 4\n";

    #[test]
    fn comments_and_a_missing_name() {
        assert_eq!(read(format!("OFF\n# made by hand\n{BODY}").as_bytes()), Ok(expected()));
        assert_eq!(read(format!("OFF {BODY}").as_bytes()), Ok(expected()));
        assert_eq!(read(format!("\u{feff}{BODY}").as_bytes()), Ok(expected()));
        assert_eq!(read(BODY.as_bytes()), Ok(expected()));
    }

    #[test]
    fn trouble_names_the_line() {
        for (from, to, says) in [
            ("5 2 0", "5 2", ""),
            ("5 2 0", "5 2 zero", "line 1: `5 2 zero` is not the numbers"),
            ("5 2 0", "COFF", "line 1: `COFF` is not the numbers"),
            ("5 2 0", "-5 2 0", "line 1: `-5 2 0` is not the numbers"),
            ("5 2 0", "99999999999 2 0", "the file ends where vertex 7 of 99999999999 should be"),
            ("5 2 0", "5 99999999999 0", "the file ends where face 2 of 99999999999 should be"),
            ("5 2 0", "5 1 0", "line 9: here is more than 5 vertices and 1 faces"),
            ("0.1 0 -1", "0.1 0", "line 7: a vertex has three numbers, here are 2"),
            ("0.1 0 -1", "0.1 0 inf", "line 7: a coordinate is not finite"),
            ("0.1 0 -1", "0.1 0 x", "line 7: `x` is no number"),
            ("3 1 0 4", "3 1 0 5", "line 9: 5 is not the index of a vertex: there are 5, counted from 0"),
            ("3 1 0 4", "3 1 0 -1", "line 9: -1 is not the index of a vertex"),
            ("3 1 0 4", "3 1 0", "line 9: the line ends where corner 2 of 3 should be"),
            ("3 1 0 4", "3 1 0 4.5", "line 9: `4.5` is no whole number, as corner 2 of 3 must be"),
            ("3 1 0 4", "-3 1 0 4", "line 9: -3 is no size of a face"),
            ("3 1 0 4", "9223372036854775807 1 0 4", "line 9: the line ends where corner 3 of"),
        ] {
            let told = read(BODY.replace(from, to).as_bytes()).err().unwrap_or_default();
            assert!(told.starts_with(says) && told.is_empty() == says.is_empty(), "{to}: {told}");
        }
        assert_eq!(read(b"").unwrap_err(), "the file ends where OFF, or the counts, should be");
    }
}
