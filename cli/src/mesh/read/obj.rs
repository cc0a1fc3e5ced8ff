//! OBJ: the lines `v` and `f`; vertices that no face has are left out, and the others numbered as faces come to them. What says how things are named,
//! grouped or look is passed over; any other line is left out, and counted.

use super::left_out::LeftOut;
use super::{Triangles, coordinates, quoted, text};
use crate::Trouble;

/// What the lines have said.
#[derive(Default)]
struct Lines {
    vertices: Vec<[f64; 3]>,
    /// Corners, counted from 0, and the line: a face may come before its vertices.
    faces: Vec<(Vec<usize>, usize)>,
    left_out: LeftOut,
}

/// What says nothing of a mesh's shape.
const LOOKS: &str = "vt vn vp g o s mg usemtl mtllib usemap maplib lod bevel c_interp d_interp shadow_obj trace_obj";

impl Lines {
    fn read(&mut self, statement: &str, line: usize) -> Result<(), Trouble> {
        let mut words = statement.split('#').next().unwrap_or_default().split_whitespace();
        match words.next() {
            Some("v") => self.vertices.push(coordinates(words)?),
            Some("f") => {
                let corners = words.map(|word| self.corner(word)).collect::<Result<_, _>>()?;
                self.faces.push((corners, line));
            }
            Some(word) if LOOKS.split(' ').all(|known| known != word) => self.left_out.add(word, 1),
            _ => {}
        }
        Ok(())
    }

    /// `5`, `5/1`, `5//1`, `5/1/1`, `-1`: the vertex is the first.
    fn corner(&self, word: &str) -> Result<usize, Trouble> {
        let bad = || format!("`{}` is no corner of a face", quoted(word));
        let numbers: Vec<Option<i64>> = word.split('/').map(|number| number.parse().ok()).collect();
        let fits = numbers.len() <= 3 && word.split('/').zip(&numbers).all(|(word, n)| word.is_empty() || n.is_some());
        let first = numbers.first().copied().flatten().filter(|_| fits).ok_or_else(bad)?;
        let (first, known) = (i128::from(first), self.vertices.len());
        let index = if first < 0 { known as i128 + first } else { first - 1 };
        usize::try_from(index).map_err(|_| match first {
            0 => format!("`{word}` is no corner of a face: vertices are counted from 1"),
            _ => format!("`{word}` is no corner of a face: there are {known} vertices before"),
        })
    }

    fn mesh(self) -> Result<Triangles, Trouble> {
        let mut mesh = Triangles { left_out: self.left_out, ..Triangles::default() };
        let count = self.vertices.len();
        let mut numbers: Vec<Option<u32>> = vec![None; count];
        for (face, line) in self.faces {
            if let Some(index) = face.iter().find(|&&index| index >= count) {
                return Err(format!("line {line}: vertex {} is not there: there are {count}", index.saturating_add(1)));
            }
            // (The vertices of points and lines have no number.)
            if face.len() < 3 {
                mesh.left_out.faces += 1;
                continue;
            }
            let number = |&index: &usize| {
                *numbers[index].get_or_insert_with(|| {
                    mesh.vertices.push(self.vertices[index]);
                    mesh.vertices.len() as u32 - 1
                })
            };
            let corners: Vec<u32> = face.iter().map(number).collect();
            mesh.push_polygon(&corners);
        }
        mesh.left_out.vertices = count - mesh.vertices.len();
        Ok(mesh)
    }
}

pub fn read(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let text = text(bytes);
    let mut found = Lines::default();
    let mut lines = text.lines().enumerate();
    while let Some((first, line)) = lines.next() {
        let mut statement = std::borrow::Cow::from(line);
        // A backslash at the end of a line continues it.
        while let Some(begin) = statement.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, line)| line);
            statement = format!("{begin} {next}").into();
        }
        found.read(&statement, first + 1).map_err(|trouble| format!("line {}: {trouble}", first + 1))?;
    }
    found.mesh()
}

#[cfg(test)]
mod tests {
    use super::super::tests::expected;
    use super::*;

    #[test]
    fn groups_are_one_mesh() {
        let file = "# two groups\nmtllib x.mtl\no first\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvn 0 0 1\nv 0.1 0 -1 # the tip\n\
                    g a\nf 1//1 2//1 3//1 4//1\nusemtl m\ng b\ns 1\nf -4 -5 \\\n -1\nl 1 2\n";
        let mut expected = expected();
        expected.left_out.add("l", 1);
        assert_eq!(read(file.as_bytes()), Ok(expected.clone()));
        assert_eq!(read(file.replace('\n', "\r\n").as_bytes()), Ok(expected));
        assert_eq!(read(b""), Ok(Triangles::default()));
    }

    /// As faces come to them; and a face may be before its vertices.
    #[test]
    fn vertices_are_numbered_by_their_faces() {
        let mesh = read(b"v 9 9 9\nf 4 3 2\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 2 4\n").unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.vertices.iter().map(|x| x[0]).collect::<Vec<_>>(), [4.0, 3.0, 2.0]);
    }

    #[test]
    fn what_is_left_out_is_counted() {
        let file = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 5 5 5\nvt 0 0\nf 1 2 3\nf 1 2\nf\np 4\np 1\nl 1 2 3\nface 1 2 3\n";
        let left_out = read(file.as_bytes()).unwrap().left_out;
        let says = "1 vertex of no face, 2 faces of fewer than three corners, 1 of `face`, 1 of `l`, 2 of `p`";
        assert_eq!(left_out.to_string(), says);
    }

    #[test]
    fn trouble_names_the_line() {
        let good = "# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 \\\n0\nf 1 2 3\n";
        assert!(read(good.as_bytes()).is_ok());
        for (from, to, says) in [
            ("v 1 0 0", "v 1 0 zero", "line 3: `zero` is no number"),
            ("v 1 0 0", "v 1 0", "line 3: a vertex has three numbers, here are 2"),
            ("v 1 0 0", "v 1 nan 0", "line 3: a coordinate is not finite"),
            ("v 1 0 0", "v 1 1e61 0", "line 3: a coordinate is not finite, or larger than 1e60"),
            ("\n0\n", "\nx\n", "line 4: `x` is no number"),
            ("f 1 2 3", "f 1 2 9", "line 6: vertex 9 is not there: there are 3"),
            ("f 1 2 3", "f 1 2 0", "line 6: `0` is no corner of a face: vertices are counted from 1"),
            ("f 1 2 3", "f 1 2 -4", "line 6: `-4` is no corner of a face: there are 3 vertices before"),
            ("f 1 2 3", "f 1 2 -9223372036854775808", "line 6: `-9223372036854775808` is no corner"),
            ("f 1 2 3", "f 1 2 9223372036854775807", "line 6: vertex 9223372036854775807 is not there"),
            ("f 1 2 3", "f 1 2 3.0", "line 6: `3.0` is no corner"),
            ("f 1 2 3", "f 1/1/1/1 2 3", "line 6: `1/1/1/1` is no corner"),
            ("f 1 2 3", "f /1 2 3", "line 6: `/1` is no corner"),
        ] {
            let told = read(good.replace(from, to).as_bytes()).unwrap_err();
            assert!(told.starts_with(says), "{to}: {told}");
        }
    }
}
