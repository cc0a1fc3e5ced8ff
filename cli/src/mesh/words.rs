//! What is wrong with a mesh, where, and how it is treated.

use std::fmt::Write;
use std::path::Path;

use qdist::mesh::Model;
use qdist::mesh::mass::MassProperties;
use qdist::nalgebra::Point3;

/// Places that are told of each kind of defect.
const TOLD: usize = 3;

/// Several lines.
pub fn report(file: &Path, model: &Model) -> String {
    let mesh = model.mesh();
    let report = mesh.report();
    let (triangles, vertices, components) = (mesh.triangles().len(), mesh.vertices().len(), report.components);
    let mut text = format!("{}: triangles {triangles}, vertices {vertices}, components {components}: ", file.display());
    let mass = MassProperties::new(mesh.vertices(), mesh.triangles());
    match (report.solid, mass) {
        (true, Ok(mass)) => text += &format!("a solid of volume {:.6e}", mass.volume),
        (true, Err(_)) => text += "a solid",
        (false, _) => text += "a polygon soup. Queries see its surface only, and it has no object norm",
    }
    match model.pieces().map_or(0, |p| p.pieces().len()) {
        0 => text += ", without convex pieces: lower bounds are 0",
        count => text += &format!(", convex pieces {count}"),
    }
    text += if report.is_clean() { ", clean\n" } else { "\n" };
    let point = |p: &Point3<f64>| format!("({}, {}, {})", p.x, p.y, p.z);
    let vertex = |v: u32| point(&mesh.vertices()[v as usize]);
    let edge = |e: u32| {
        let edge = &mesh.topology().edges()[e as usize];
        format!("{} - {} of triangle {}", vertex(edge.vertices[0]), vertex(edge.vertices[1]), edge.faces[0])
    };
    let triangle = |t: u32| format!("{t} at {}", point(&mesh.corners(t)[0]));
    let component = |c: u32| {
        let first = mesh.topology().components().iter().position(|other| *other == c).unwrap_or_default();
        format!("{c}, with triangle {}", triangle(first as u32))
    };
    let mut tell = |what: &str, list: &[u32], place: &dyn Fn(u32) -> String| {
        if !list.is_empty() {
            let places: Vec<String> = list.iter().take(TOLD).map(|&i| place(i)).collect();
            let more = if list.len() > TOLD { "; ..." } else { "" };
            let _ = writeln!(text, "  {what}: {}: {}{more}", list.len(), places.join("; "));
        }
    };
    tell("open edges", &report.open_edges, &edge);
    tell("edges of more than two triangles", &report.non_manifold_edges, &edge);
    tell("edges between triangles of opposite winding", &report.inconsistent_edges, &edge);
    tell("triangles without area", &report.degenerate_triangles, &triangle);
    tell("triangles that are there twice", &report.duplicate_triangles, &triangle);
    tell("vertices of no triangle", &report.unreferenced_vertices, &|v| format!("{v} at {}", vertex(v)));
    tell("components that are inside out", &report.inverted_components, &component);
    tell("components without volume", &report.flat_components, &component);
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn of(triangles: &[[u32; 3]]) -> String {
        let model = crate::mesh::bodies::with_pieces(Model::new(&CORNERS, triangles).unwrap());
        report(Path::new("body.off"), &model)
    }

    #[test]
    fn a_clean_mesh_says_so() {
        assert_eq!(of(&TRIANGLES).lines().count(), 1);
        assert!(of(&TRIANGLES).contains("body.off: triangles 4, vertices 4, components 1: a solid of volume 1.66"));
        assert!(of(&TRIANGLES).ends_with(", convex pieces 1, clean\n"));
    }

    #[test]
    fn defects_have_places() {
        let open = of(&TRIANGLES[1..]);
        assert!(open.contains("soup") && open.contains("open edges: 3: (0, 0, 0)"), "{open}");
        let inverted = of(&TRIANGLES.map(|[a, b, c]| [a, c, b]));
        assert!(inverted.contains("inside out: 1: 0, with triangle 0 at (0, 0, 0)"), "{inverted}");
        let mut turned = TRIANGLES;
        turned[3].swap(0, 1);
        assert!(of(&turned).contains("opposite winding: 3"), "{}", of(&turned));
    }
}
