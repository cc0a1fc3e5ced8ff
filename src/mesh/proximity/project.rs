//! The point of a mesh that is nearest to a point, by descent into the nearer box first.

use super::super::Mesh;
use super::super::bvh::{Below, Node};
use super::candidate::feature;
use crate::mesh::Feature;
use crate::mesh::triangle::nearest_on_triangle;
use nalgebra::Point3;

/// A point of a mesh, in the mesh's frame.
pub(super) struct Projection {
    pub point: Point3<f64>,
    pub feature: Feature,
    pub triangle: u32,
    pub squared: f64,
}

/// The squared distance of a point from a box.
fn bound(node: &Node, p: &Point3<f64>) -> f64 {
    ((p.coords - node.centre).abs() - node.half).map(|x| x.max(0.0)).norm_squared()
}

/// Pairs of a squared distance of a box, and its node: what a descent has still to look at.
pub(in crate::mesh) type Stack = Vec<(f64, (u32, u32))>;

/// Shows triangles to `look`, nearer boxes first, but for those in boxes whose squared distance from `p` is not less than what `look` returned
/// last; at first `below`.
pub(in crate::mesh) fn descend(
    mesh: &Mesh,
    p: &Point3<f64>,
    mut below: f64,
    stack: &mut Stack,
    mut look: impl FnMut(u32, f64) -> f64,
) {
    stack.clear();
    stack.push((0.0, (0, 0)));
    while let Some((least, (i, _))) = stack.pop() {
        if least >= below {
            continue;
        }
        match mesh.bvh().node(i).below() {
            Below::Children(both) => {
                let [x, y] = both.map(|child| (bound(mesh.bvh().node(child), p), (child, 0)));
                stack.extend(if x.0 < y.0 { [y, x] } else { [x, y] });
            }
            Below::Triangle(triangle) => below = look(triangle, below),
        }
    }
}

/// The nearest point of the mesh if its squared distance is less than `below`.
pub(super) fn project(mesh: &Mesh, p: &Point3<f64>, below: f64, stack: &mut Stack) -> Option<Projection> {
    let mut found = None;
    descend(mesh, p, below, stack, |triangle, best| {
        let (point, place) = nearest_on_triangle(p, mesh.corners(triangle));
        let squared = (point - p).norm_squared();
        if squared < best {
            found = Some(Projection { point, feature: feature(mesh, triangle, place), triangle, squared });
            squared
        } else {
            best
        }
    });
    found
}
