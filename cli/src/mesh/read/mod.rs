//! Meshes from files: OBJ, STL, PLY and OFF, told apart by the ending of the name.
//!
//! Vertices are the file's, in double precision where the format has it, and polygons become fans about their first corner. Nothing is
//! repaired, but for STL: its triangles have no common vertices, so corners with equal coordinates become one. The groups of an
//! OBJ file and the solids of an STL file are one mesh, and normals, colours and textures are not read. Whatever else a mesh has no place for (points,
//! lines, curves, what is not known) is left out, and told on the error output with its count.
//!
//! What is wrong is told with its line, or in binary files with its byte; and what a mesh cannot be made of (indices of no vertex, coordinates that
//! are not finite) is refused here, where the line is known.

mod left_out;
mod obj;
mod off;
mod ply;
mod stl;

use std::path::Path;

use qdist::mesh::MAX_COORDINATE;

use crate::Trouble;
use left_out::LeftOut;

/// Vertices and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// What else the file has.
    pub left_out: LeftOut,
}

impl Triangles {
    /// A polygon as a fan; points and lines are no triangles.
    fn push_polygon(&mut self, corners: &[u32]) {
        match corners {
            [first, rest @ ..] if rest.len() > 1 => {
                self.triangles.extend(rest.windows(2).map(|w| [*first, w[0], w[1]]));
            }
            _ => self.left_out.faces += 1,
        }
    }
}

/// Reads a file. The trouble names it, and the line or the byte. What is left out is told on the error output.
pub fn mesh(file: &Path) -> Result<Triangles, Trouble> {
    let name = file.display();
    let bytes = std::fs::read(file).map_err(|e| format!("{name}: {e}"))?;
    if bytes.is_empty() {
        return Err(format!("{name}: the file is empty"));
    }
    let ending = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let read = match ending.as_str() {
        "obj" => obj::read(&bytes),
        "stl" => stl::read(bytes),
        "ply" => ply::read(&bytes),
        "off" => off::read(&bytes),
        _ => Err("the name ends neither with .obj nor .stl, .ply or .off".into()),
    };
    let mesh = read.map_err(|trouble| format!("{name}: {trouble}"))?;
    let Triangles { vertices, triangles, left_out } = &mesh;
    let rest = if left_out.is_nothing() { String::new() } else { format!("left out: {left_out}") };
    if triangles.is_empty() {
        let count = vertices.len() + left_out.vertices;
        let rest = if rest.is_empty() { rest } else { format!("; {rest}") };
        return Err(format!("{name}: there are no triangles in it (vertices: {count}{rest})"));
    }
    if !rest.is_empty() {
        eprintln!("{name}: {rest}");
    }
    Ok(mesh)
}

/// The text of a file whose names need not be in UTF-8; a mark at the beginning is no part of it.
fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// Where something is wrong, and what is there.
fn at_line(bytes: &[u8], line: usize) -> String {
    let content = bytes.split(|&c| c == b'\n').nth(line.saturating_sub(1)).unwrap_or_default();
    let content = quoted(String::from_utf8_lossy(content).trim());
    if content.is_empty() { format!("line {line}, which is empty") } else { format!("line {line}, `{content}`") }
}

/// What messages say of a text from a file, which may be anything: its beginning, and nothing that a terminal obeys.
fn quoted(text: &str) -> String {
    text.chars().take(60).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

/// The first three numbers of a line.
fn coordinates<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3], Trouble> {
    let mut x = [0.0; 3];
    for (k, x) in x.iter_mut().enumerate() {
        let word = words.next().ok_or(format!("a vertex has three numbers, here are {k}"))?;
        *x = word.parse().map_err(|_| format!("`{}` is no number", quoted(word)))?;
    }
    finite(x)
}

fn finite(x: [f64; 3]) -> Result<[f64; 3], Trouble> {
    match x.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        true => Ok(x),
        false => Err("a coordinate is not finite, or larger than 1e60".into()),
    }
}

/// A corner, counted from 0.
fn corner(index: i64, vertices: usize) -> Result<u32, Trouble> {
    let found = u32::try_from(index).ok().filter(|&i| (i as usize) < vertices);
    found.ok_or(format!("{index} is not the index of a vertex: there are {vertices}, counted from 0"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle and a square, which is two.
    pub fn expected() -> Triangles {
        Triangles {
            vertices: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0], [0.1, 0.0, -1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3], [1, 0, 4]],
            left_out: LeftOut::default(),
        }
    }

    #[test]
    fn what_is_quoted_is_short_and_plain() {
        assert_eq!(quoted("1 \u{1b}[2J\t\u{fc}"), "1 \u{fffd}[2J\u{fffd}\u{fc}");
        assert_eq!(quoted(&"x".repeat(1000)).len(), 60);
    }

    #[test]
    fn a_name_with_another_ending_is_refused() {
        let trouble = mesh(Path::new("Cargo.toml")).unwrap_err();
        assert!(trouble.contains("Cargo.toml") && trouble.contains(".off"), "{trouble}");
        assert!(mesh(Path::new("missing.obj")).unwrap_err().contains("missing.obj"));
    }

    /// Whatever a file says, the trouble names it; a file without triangles is no mesh.
    #[test]
    fn no_triangles_and_the_name_of_the_file() {
        let folder = std::env::temp_dir().join(format!("qdist_read_{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        for (name, content, says) in [
            ("a.obj", "", "the file is empty"),
            (
                "b.OBJ",
                "v 0 0 0\nv 1 0 0\nl 1 2\n",
                "there are no triangles in it (vertices: 2; left out: 2 vertices of no face, 1 of `l`)",
            ),
            ("c.obj", "v 0 0 zero\n", "line 1: `zero` is no number"),
            ("d.off", "OFF\n1 0 0\n0 0 0\n", "there are no triangles in it (vertices: 1)"),
            ("e.stl", "solid x\nendsolid x\n", "there are no triangles in it (vertices: 0)"),
            ("f.ply", "", "the file is empty"),
        ] {
            let file = folder.join(name);
            std::fs::write(&file, content).unwrap();
            assert_eq!(mesh(&file), Err(format!("{}: {says}", file.display())));
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
