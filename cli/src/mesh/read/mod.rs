//! Meshes from files: OBJ, STL, PLY and OFF, told apart by the ending of the name.
//!
//! Vertices are the file's, in double precision where the format has it, and polygons become fans about their first corner. Nothing is
//! repaired, but for STL: its triangles have no common vertices, so corners with equal coordinates become one. The groups of an
//! OBJ file and the solids of an STL file are one mesh, and normals, colours and textures are not read.
//!
//! What is wrong is told with its line, or in binary files with its byte; and what a mesh cannot be made of (indices of no vertex, coordinates that
//! are not finite) is refused here, where the line is known.

mod obj;
mod off;
mod ply;
mod stl;

use std::path::Path;

use qdist::mesh::MAX_COORDINATE;

use crate::Trouble;

/// Vertices and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Triangles {
    /// A polygon as a fan; points and lines are no triangles.
    fn push_polygon(&mut self, corners: &[u32]) {
        if let [first, rest @ ..] = corners {
            self.triangles.extend(rest.windows(2).map(|w| [*first, w[0], w[1]]));
        }
    }
}

/// Reads a file. The trouble names it, and the line or the byte.
pub fn mesh(file: &Path) -> Result<Triangles, Trouble> {
    let name = file.display();
    let bytes = std::fs::read(file).map_err(|e| format!("{name}: {e}"))?;
    let ending = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let read = match ending.as_str() {
        "obj" => obj::read(&bytes),
        "stl" => stl::read(bytes),
        "ply" => ply::read(&bytes),
        "off" => off::read(&bytes),
        _ => Err("the name ends neither with .obj nor .stl, .ply or .off".into()),
    };
    match read {
        Ok(mesh) if mesh.triangles.is_empty() => {
            Err(format!("{name}: there are no triangles in it ({} vertices)", mesh.vertices.len()))
        }
        read => read.map_err(|trouble| format!("{name}: {trouble}")),
    }
}

/// The text of a file whose names need not be in UTF-8; a mark at the beginning is no part of it.
fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes))
}

/// The first three numbers of a line.
fn coordinates<'a>(mut words: impl Iterator<Item = &'a str>) -> Result<[f64; 3], Trouble> {
    let mut x = [0.0; 3];
    for (k, x) in x.iter_mut().enumerate() {
        let word = words.next().ok_or(format!("a vertex has three numbers, here are {k}"))?;
        *x = word.parse().map_err(|_| format!("`{word}` is no number"))?;
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
        }
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
            ("a.obj", "", "there are no triangles in it (0 vertices)"),
            ("b.OBJ", "v 0 0 0\n", "there are no triangles in it (0 vertices)"),
            ("c.obj", "v 0 0 zero\n", "line 1: `zero` is no number"),
            ("d.off", "OFF\n1 0 0\n0 0 0\n", "there are no triangles in it (1 vertices)"),
            ("e.stl", "solid x\nendsolid x\n", "there are no triangles in it (0 vertices)"),
        ] {
            let file = folder.join(name);
            std::fs::write(&file, content).unwrap();
            assert_eq!(mesh(&file), Err(format!("{}: {says}", file.display())));
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
