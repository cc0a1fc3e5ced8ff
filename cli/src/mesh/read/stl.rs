//! STL, as text (`solid ...`, of which there may be several) or in numbers.

use std::cell::Cell;
use std::collections::HashMap;
use std::io::{Cursor, Error, ErrorKind, Read, Seek, SeekFrom};

use super::{Triangles, at_line, finite};
use crate::{Trouble, text};

/// Bytes before the triangles, and of each.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// Corners with equal coordinates become one.
#[derive(Default)]
struct Joined {
    mesh: Triangles,
    known: HashMap<[u32; 3], u32>,
}

impl Joined {
    fn push(&mut self, triangle: &stl_io::Triangle) -> Result<(), Trouble> {
        let mut corners = [0; 3];
        for (corner, v) in corners.iter_mut().zip(&triangle.vertices) {
            let x = finite(v.0.map(f64::from))?;
            // -0.0 equals 0.0.
            *corner = *self.known.entry(v.0.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                self.mesh.vertices.push(x);
                self.mesh.vertices.len() as u32 - 1
            });
        }
        self.mesh.triangles.push(corners);
        Ok(())
    }
}

/// Text begins with `solid`; but so do files in numbers now and then, and these have the length that their count says.
pub fn read(mut bytes: Vec<u8>) -> Result<Triangles, Trouble> {
    let count = bytes.get(80..HEAD).map(|c| u32::from_le_bytes([c[0], c[1], c[2], c[3]]) as usize);
    let length = count.map(|count| HEAD + count * TRIANGLE);
    if bytes.starts_with(b"solid") && length != Some(bytes.len()) {
        return in_text(&bytes);
    }
    let (Some(count), Some(length)) = (count, length) else {
        return Err(format!("the file ends at byte {}: it neither begins with `solid` nor has a count", bytes.len()));
    };
    if bytes.len() < length {
        let (end, whole) = (bytes.len(), (bytes.len() - HEAD) / TRIANGLE);
        return Err(format!("the file ends at byte {end}, in triangle {whole} of {count} (is it STL?)"));
    }
    if bytes.len() >= length + TRIANGLE {
        return Err(format!("byte {length}: here is more than the {count} triangles that the file begins with"));
    }
    // The head is not read, but must not look like text.
    bytes[0] = 0;
    let mut bytes = Cursor::new(bytes);
    let mut joined = Joined::default();
    for (i, triangle) in stl_io::create_stl_reader(&mut bytes).map_err(|e| e.to_string())?.enumerate() {
        let pushed = triangle.map_err(|e| e.to_string()).and_then(|triangle| joined.push(&triangle));
        pushed.map_err(|trouble| format!("byte {}, triangle {i}: {trouble}", HEAD + i * TRIANGLE))?;
    }
    Ok(joined.mesh)
}

/// What the library says of text, by its beginning, and what that means.
const WORDS: [(&str, &str); 8] = [
    ("vertex f32", "`vertex` and three numbers are expected here"),
    ("invalid facet", "`facet normal` and three numbers, or `endsolid`, are expected here"),
    ("expected [\"outer", "`outer loop` is expected here"),
    ("expected [\"endloop", "`endloop` is expected here, after three vertices"),
    ("expected [\"endfacet", "`endfacet` is expected here"),
    ("invalid float", "numbers are expected here"),
    ("expected finite", "a number is not finite, or too large for single precision"),
    ("EOF", "the file ends here, within a solid"),
];

fn meaning(said: &str) -> Trouble {
    let known = WORDS.iter().find(|(begin, _)| said.starts_with(begin));
    known.map_or(said, |(_, meaning)| meaning).into()
}

/// Solid after solid.
fn in_text(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let mut joined = Joined::default();
    let at = Cell::new(0usize);
    // What was read ends with the line that is wrong.
    let words = |trouble: String| {
        let line = text::line(bytes, at.get().saturating_sub(1));
        format!("{}: {trouble}", at_line(bytes, line))
    };
    loop {
        // The first line has the name, if there is one, which is not read; the library wants one.
        let rest = &bytes[at.get()..];
        let spaces = rest.iter().take_while(|c| c.is_ascii_whitespace()).count();
        if spaces == rest.len() {
            return Ok(joined.mesh);
        }
        at.set(at.get() + spaces);
        let mut solid = Solid { bytes, begin: end_of_line(bytes, at.get()), at: &at, begun: false };
        let begins = bytes[at.get()..].starts_with(b"solid");
        at.set(solid.begin);
        if !begins {
            return Err(words("here is more than the solid".into()));
        }
        for triangle in stl_io::create_stl_reader(&mut solid).map_err(|e| words(e.to_string()))? {
            let triangle = triangle.map_err(|e| words(meaning(&e.to_string())))?;
            joined.push(&triangle).map_err(words)?;
        }
    }
}

/// Where the line ends that has this byte.
fn end_of_line(bytes: &[u8], at: usize) -> usize {
    bytes[at..].iter().position(|&c| c == b'\n').map_or(bytes.len(), |length| at + length + 1)
}

/// A solid after its first line, which gives a line at a time, so that it is known how far the library has come.
struct Solid<'a> {
    bytes: &'a [u8],
    begin: usize,
    at: &'a Cell<usize>,
    /// Has it said `solid`?
    begun: bool,
}

impl Read for Solid<'_> {
    fn read(&mut self, to: &mut [u8]) -> Result<usize, Error> {
        let at = self.at.get();
        let line = if self.begun { &self.bytes[at..end_of_line(self.bytes, at)] } else { &b"solid x\n"[..] };
        let count = line.len().min(to.len());
        to[..count].copy_from_slice(&line[..count]);
        if self.begun {
            self.at.set(at + count);
        }
        self.begun = true;
        Ok(count)
    }
}

impl Seek for Solid<'_> {
    /// To the beginning: the library looks at the first line, and goes back.
    fn seek(&mut self, to: SeekFrom) -> Result<u64, Error> {
        if to != SeekFrom::Start(0) {
            return Err(ErrorKind::Unsupported.into());
        }
        self.at.set(self.begin);
        self.begun = false;
        Ok(0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::expected;
    use super::*;

    fn single() -> Vec<[f32; 3]> {
        expected().vertices.iter().map(|x| x.map(|x| x as f32)).collect()
    }

    fn in_lines() -> String {
        let facet = |t: [u32; 3]| {
            let corner = |v: u32| single()[v as usize].map(|x| x.to_string()).join(" ");
            let corners = t.map(|v| format!("    vertex {}\n", corner(v))).concat();
            format!("  facet normal 0 0 0\n  outer loop\n{corners}  endloop\n  endfacet\n")
        };
        let faces: String = expected().triangles.into_iter().map(facet).collect();
        format!("solid x\n{faces}endsolid x\n")
    }

    fn in_numbers() -> Vec<u8> {
        let mut binary = vec![0u8; 80];
        binary.extend(3u32.to_le_bytes());
        for t in expected().triangles {
            let numbers = [[0f32; 3]].into_iter().chain(t.map(|v| single()[v as usize])).flatten();
            binary.extend(numbers.flat_map(f32::to_le_bytes));
            binary.extend([0, 0]);
        }
        binary
    }

    fn told(bytes: impl Into<Vec<u8>>) -> String {
        read(bytes.into()).err().unwrap_or_default()
    }

    #[test]
    fn corners_are_joined() {
        let mesh = read(in_lines().replacen("vertex 1 0 0", "vertex 1 -0 0", 1).into()).unwrap();
        assert_eq!(mesh.vertices.iter().map(|x| x.map(|x| x as f32)).collect::<Vec<_>>(), single());
        assert_eq!(mesh.triangles, expected().triangles);
        assert_eq!(read(in_numbers()), Ok(mesh.clone()));
        // In numbers, though it begins like text.
        let mut binary = in_numbers();
        binary[..6].copy_from_slice(b"solid ");
        assert_eq!(read(binary), Ok(mesh.clone()));
        // Without a name, with other ends of lines, and with the triangles in two solids.
        assert_eq!(read(in_lines().replacen("solid x", "solid", 1).into()), Ok(mesh.clone()));
        assert_eq!(read(in_lines().replace('\n', "\r\n").into()), Ok(mesh.clone()));
        let two = in_lines().replacen("  endfacet\n", "  endfacet\nendsolid\n\nsolid\n", 1);
        assert_eq!(read(two.into()), Ok(mesh));
    }

    #[test]
    fn trouble_names_the_line() {
        for (from, to, says) in [
            (
                "    vertex 1 0 0",
                "    vertex 1 0",
                "line 5, `vertex 1 0`: `vertex` and three numbers are expected here",
            ),
            ("    vertex 1 0 0", "    vertex 1 zero 0", "line 5, `vertex 1 zero 0`: numbers are expected here"),
            ("    vertex 1 0 0", "    vertex 1 inf 0", "line 5, `vertex 1 inf 0`: a number is not finite"),
            (
                "    vertex 1 0 0",
                "    vertex 1 1e39 0",
                "line 5, `vertex 1 1e39 0`: a number is not finite, or too large",
            ),
            ("  outer", "\n  uter", "line 4, `uter loop`: `outer loop` is expected here"),
            ("  endloop", "  vertex 1 0 0\n  endloop", "line 7, `vertex 1 0 0`: `endloop` is expected here"),
            ("  endfacet", "  end", "line 8, `end`: `endfacet` is expected here"),
            ("  facet normal", "  face normal", "line 2, `face normal 0 0 0`: `facet normal` and three numbers, or"),
            ("endsolid x", "", "line 23, which is empty: the file ends here, within a solid"),
            (
                "endsolid x",
                "endsolid x\nfacet normal 0 0 0",
                "line 24, `facet normal 0 0 0`: here is more than the solid",
            ),
        ] {
            let told = told(in_lines().replacen(from, to, 1));
            assert!(told.starts_with(says), "{to}: {told}");
        }
    }

    #[test]
    fn trouble_names_the_byte() {
        assert!(told("").starts_with("the file ends at byte 0: it neither begins with"));
        assert!(told(&in_numbers()[..200]).starts_with("the file ends at byte 200, in triangle 2 of 3"));
        assert!(told([in_numbers(), vec![0; 50]].concat()).starts_with("byte 234: here is more than the 3 triangles"));
        let mut infinite = in_numbers();
        infinite[HEAD + TRIANGLE + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(told(infinite).starts_with("byte 134, triangle 1: a coordinate is not finite"));
    }
}
