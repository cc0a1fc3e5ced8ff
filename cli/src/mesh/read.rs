//! Meshes from files: OBJ, STL, PLY and OFF, told apart by the ending of the name.
//!
//! Vertices are the file's, in double precision where the format has it, and polygons become fans about their first corner. Nothing is
//! repaired, but for STL: its triangles have no common vertices, so corners with equal coordinates become one. The groups of an
//! OBJ file are one mesh, and normals, colours and textures are not read.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::Path;

use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

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

/// Reads a file. The trouble names it.
pub fn mesh(file: &Path) -> Result<Triangles, Trouble> {
    let name = file.display();
    let bytes = std::fs::read(file).map_err(|e| format!("{name}: {e}"))?;
    let ending = file.extension().and_then(|e| e.to_str()).unwrap_or_default().to_ascii_lowercase();
    let read = match ending.as_str() {
        "obj" => obj(&bytes),
        "stl" => stl(bytes),
        "ply" => ply(&bytes),
        "off" => off(&bytes),
        _ => Err("the name ends neither with .obj nor .stl, .ply or .off".into()),
    };
    read.map_err(|trouble| format!("{name}: {trouble}"))
}

fn text(bytes: &[u8]) -> std::borrow::Cow<'_, str> {
    String::from_utf8_lossy(bytes)
}

/// Groups would become meshes of their own, with a copy of the vertices on their borders; so only the lines of geometry are read.
pub fn obj(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let geometry = |line: &&str| matches!(line.split_whitespace().next(), Some("v" | "vt" | "vn" | "f"));
    // A backslash at the end of a line continues it.
    let whole = text(bytes).replace("\\\r\n", " ").replace("\\\n", " ");
    let lines: Vec<&str> = whole.lines().filter(geometry).collect();
    let options = tobj::LoadOptions { ignore_points: true, ignore_lines: true, ..Default::default() };
    let no_materials = |_: &Path| Err(tobj::LoadError::OpenFileFailed);
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(lines.join("\n")), &options, no_materials)
        .map_err(|e| format!("OBJ: {e}"))?;
    let mut mesh = Triangles::default();
    for tobj::Model { mesh: part, .. } in models {
        let before = mesh.vertices.len() as u32;
        mesh.vertices.extend(part.positions.chunks_exact(3).map(|x| [x[0], x[1], x[2]]));
        let corners: Vec<u32> = part.indices.iter().map(|i| before + i).collect();
        let mut rest = corners.as_slice();
        // No sizes: triangles only.
        let triangles = vec![3; if part.face_arities.is_empty() { corners.len() / 3 } else { 0 }];
        for size in part.face_arities.iter().chain(&triangles) {
            let (polygon, more) = rest.split_at(*size as usize);
            mesh.push_polygon(polygon);
            rest = more;
        }
    }
    Ok(mesh)
}

pub fn stl(bytes: Vec<u8>) -> Result<Triangles, Trouble> {
    let mut bytes = Cursor::new(bytes);
    let words = |e: std::io::Error| format!("STL: {e}");
    let mut mesh = Triangles::default();
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    for triangle in stl_io::create_stl_reader(&mut bytes).map_err(words)? {
        let corners = triangle.map_err(words)?.vertices.map(|v| {
            // -0.0 equals 0.0.
            *known.entry(v.0.map(|x| (x + 0.0).to_bits())).or_insert_with(|| {
                mesh.vertices.push(v.0.map(f64::from));
                mesh.vertices.len() as u32 - 1
            })
        });
        mesh.triangles.push(corners);
    }
    Ok(mesh)
}

pub fn ply(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let file = Parser::<DefaultElement>::new().read_ply(&mut Cursor::new(bytes)).map_err(|e| format!("PLY: {e}"))?;
    let elements = |name: &str| file.payload.iter().find(|(key, _)| *key == name).map(|(_, list)| list.as_slice());
    let mut mesh = Triangles::default();
    for (i, vertex) in elements("vertex").ok_or("PLY: there is no element `vertex`")?.iter().enumerate() {
        let x = ["x", "y", "z"].map(|axis| vertex.get(axis).and_then(scalar));
        let [Some(x), Some(y), Some(z)] = x else {
            return Err(format!("PLY: vertex {i} has not the numbers x, y and z"));
        };
        mesh.vertices.push([x, y, z]);
    }
    for (i, face) in elements("face").ok_or("PLY: there is no element `face`")?.iter().enumerate() {
        let corners = face.get("vertex_indices").or(face.get("vertex_index"));
        let corners = corners.and_then(indices).ok_or(format!("PLY: face {i} has no list `vertex_indices`"))?;
        let negative = || format!("PLY: face {i} has an index that is negative or too large");
        let corners: Vec<u32> =
            corners.into_iter().map(u32::try_from).collect::<Result<_, _>>().map_err(|_| negative())?;
        mesh.push_polygon(&corners);
    }
    Ok(mesh)
}

fn scalar(p: &Property) -> Option<f64> {
    Some(match *p {
        Property::Char(x) => x.into(),
        Property::UChar(x) => x.into(),
        Property::Short(x) => x.into(),
        Property::UShort(x) => x.into(),
        Property::Int(x) => x.into(),
        Property::UInt(x) => x.into(),
        Property::Float(x) => x.into(),
        Property::Double(x) => x,
        _ => return None,
    })
}

fn indices(p: &Property) -> Option<Vec<i64>> {
    fn wide<I: Copy + Into<i64>>(list: &[I]) -> Vec<i64> {
        list.iter().map(|&i| i.into()).collect()
    }
    Some(match p {
        Property::ListChar(list) => wide(list),
        Property::ListUChar(list) => wide(list),
        Property::ListShort(list) => wide(list),
        Property::ListUShort(list) => wide(list),
        Property::ListInt(list) => wide(list),
        Property::ListUInt(list) => wide(list),
        _ => return None,
    })
}

/// `OFF` (it may be missing), the numbers of vertices, faces and edges, then coordinates, then polygons: their size, their corners,
/// and perhaps a colour.
pub fn off(bytes: &[u8]) -> Result<Triangles, Trouble> {
    let text = text(bytes);
    let lines = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let mut lines = lines.filter(|line| !line.is_empty());
    let mut next = |what: &str| lines.next().ok_or(format!("OFF: it ends where {what} should be"));
    let mut head = next("the counts")?;
    if let Some(rest) = head.strip_prefix("OFF") {
        head = if rest.trim().is_empty() { next("the counts")? } else { rest.trim() };
    }
    let counts: Vec<usize> = head.split_whitespace().map_while(|w| w.parse().ok()).collect();
    let [vertices, faces, ..] = counts[..] else { return Err("OFF: the counts are not two or three numbers".into()) };
    let mut mesh = Triangles::default();
    for i in 0..vertices {
        let line = next(&format!("vertex {i}"))?;
        let x: Vec<f64> = line.split_whitespace().map_while(|w| w.parse().ok()).collect();
        let [x, y, z, ..] = x[..] else { return Err(format!("OFF: vertex {i} is not three numbers")) };
        mesh.vertices.push([x, y, z]);
    }
    for i in 0..faces {
        let line = next(&format!("face {i}"))?;
        let mut numbers = line.split_whitespace();
        let size: usize = numbers.next().and_then(|w| w.parse().ok()).ok_or(format!("OFF: face {i} has no size"))?;
        let corners: Vec<u32> = numbers.map_while(|w| w.parse().ok()).take(size).collect();
        if corners.len() != size {
            return Err(format!("OFF: face {i} has not {size} indices"));
        }
        mesh.push_polygon(&corners);
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle and a square, which is two.
    fn expected() -> Triangles {
        Triangles {
            vertices: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0], [0.1, 0.0, -1.0]],
            triangles: vec![[0, 1, 2], [0, 2, 3], [1, 0, 4]],
        }
    }

    #[test]
    fn obj_groups_are_one_mesh() {
        let file = "# two groups\nmtllib x.mtl\no first\nv 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvn 0 0 1\nv 0.1 0 -1\n\
                    g a\nf 1//1 2//1 3//1 4//1\nusemtl m\ng b\ns 1\nf -4 -5 \\\n -1\nl 1 2\n";
        assert_eq!(obj(file.as_bytes()), Ok(expected()));
        assert!(obj(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n").is_err());
        assert!(obj(b"v 0 0 zero\n").is_err());
        assert_eq!(obj(b""), Ok(Triangles::default()));
    }

    #[test]
    fn stl_corners_are_joined() {
        let facet = |p: [[f32; 3]; 3]| {
            let corner = |x: [f32; 3]| format!("vertex {} {} {}\n", x[0], x[1], x[2]);
            format!("facet normal 0 0 0\nouter loop\n{}endloop\nendfacet\n", p.map(corner).concat())
        };
        let corners = expected().vertices.iter().map(|x| x.map(|x| x as f32)).collect::<Vec<_>>();
        let faces = expected().triangles.iter().map(|t| facet(t.map(|v| corners[v as usize]))).collect::<String>();
        let ascii = format!("solid x\n{faces}endsolid x\n").replacen("vertex 1 0 0", "vertex 1 -0 0", 1);
        let read = stl(ascii.into_bytes()).unwrap();
        let single = |t: &Triangles| t.vertices.iter().map(|x| x.map(|x| x as f32)).collect::<Vec<_>>();
        assert_eq!(single(&read), single(&expected()));
        assert_eq!(read.triangles, expected().triangles);

        let mut binary = vec![0u8; 80];
        binary.extend(3u32.to_le_bytes());
        for t in expected().triangles {
            let numbers = [[0f32; 3]].into_iter().chain(t.map(|v| corners[v as usize])).flatten();
            binary.extend(numbers.flat_map(f32::to_le_bytes));
            binary.extend([0, 0]);
        }
        assert_eq!(stl(binary.clone()), Ok(read));
        binary.truncate(200);
        assert!(stl(binary).is_err());
    }

    #[test]
    fn ply_in_text_and_in_numbers() {
        let head = "ply\nformat ascii 1.0\nelement vertex 5\nproperty double x\nproperty double y\nproperty double z\n\
                    element face 2\nproperty list uchar int vertex_indices\nend_header\n";
        let body = "0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n0.1 0 -1\n4 0 1 2 3\n3 1 0 4\n";
        assert_eq!(ply(format!("{head}{body}").as_bytes()), Ok(expected()));
        let negative = body.replace("3 1 0 4", "3 1 0 -4");
        assert!(ply(format!("{head}{negative}").as_bytes()).unwrap_err().contains("face 1"));

        let head = head.replace("ascii", "binary_little_endian").replace("vertex_indices", "vertex_index");
        let mut binary = head.into_bytes();
        binary.extend(expected().vertices.iter().flatten().flat_map(|x| x.to_le_bytes()));
        for polygon in [&[0i32, 1, 2, 3][..], &[1, 0, 4]] {
            binary.push(polygon.len() as u8);
            binary.extend(polygon.iter().flat_map(|i| i.to_le_bytes()));
        }
        assert_eq!(ply(&binary), Ok(expected()));
    }

    #[test]
    fn off_with_comments_and_without_its_name() {
        let body = "5 2 0\n0 0 0\n1 0 0 # a corner\n\n1 1 0.5\n0 1 0\n0.1 0 -1\n4 0 1 2 3 255 0 0\n3 1 0 4\n";
        assert_eq!(off(format!("OFF\n# made by hand\n{body}").as_bytes()), Ok(expected()));
        assert_eq!(off(format!("OFF {body}").as_bytes()), Ok(expected()));
        assert_eq!(off(body.as_bytes()), Ok(expected()));
        assert!(off(b"OFF\n5 2 0\n0 0 0\n").unwrap_err().contains("vertex 1"));
        assert!(off(b"OFF\n1 1 0\n0 0 0\n3 0 0\n").unwrap_err().contains("face 0"));
    }

    #[test]
    fn a_name_with_another_ending_is_refused() {
        let trouble = mesh(Path::new("Cargo.toml")).unwrap_err();
        assert!(trouble.contains("Cargo.toml") && trouble.contains(".off"), "{trouble}");
        assert!(mesh(Path::new("missing.obj")).unwrap_err().contains("missing.obj"));
    }
}
