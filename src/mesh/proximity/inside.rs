//! Whether a point lies inside a solid: the winding number, counted along a ray.
//!
//! A ray that passes an edge or a corner within rounding says nothing, and another one is tried; when none is clear, the solid angles of all
//! triangles are added up.

use super::super::Mesh;
use super::super::bvh::{Below, Node};
use super::super::check::solid_angle;
use nalgebra::{Point3, Vector3};

/// Directions without symmetry, so that no edge of a man-made part is parallel to them.
const RAYS: [[f64; 3]; 6] = [
    [0.8017, 0.4451, 0.3990],
    [-0.3719, 0.8443, 0.3859],
    [0.2887, -0.4013, 0.8693],
    [-0.6121, -0.5309, -0.5861],
    [0.1103, 0.7211, -0.6841],
    [0.5477, -0.8101, -0.2091],
];

/// Whether the point, not on the surface, is inside the solid. O(log n) in the mean; the stack is scratch memory.
pub(super) fn is_inside(mesh: &Mesh, p: &Point3<f64>, stack: &mut Vec<(u32, u32)>) -> bool {
    mesh.is_solid() && winds_around(mesh, p, stack)
}

/// Whether the winding number of a closed surface, solid or not, is positive at the point.
pub(in crate::mesh) fn winds_around(mesh: &Mesh, p: &Point3<f64>, stack: &mut Vec<(u32, u32)>) -> bool {
    if !mesh.is_in_bounds(p, 0.0) {
        return false;
    }
    for ray in RAYS {
        if let Some(winding) = winding_along(mesh, p, &Vector3::from(ray), stack) {
            return winding > 0;
        }
    }
    let all: f64 = mesh.triangles().iter().zip(0u32..).map(|(_, t)| solid_angle(p, mesh.corners(t).each_ref())).sum();
    all > 2.0 * std::f64::consts::PI
}

/// Signed crossings of the surface: outward is +1.
fn winding_along(mesh: &Mesh, p: &Point3<f64>, d: &Vector3<f64>, stack: &mut Vec<(u32, u32)>) -> Option<i32> {
    let inverse = d.map(|x| 1.0 / x);
    let doubt = 16.0 * f64::EPSILON * (mesh.scale() + p.coords.amax());
    let mut winding = 0;
    stack.clear();
    stack.push((0, 0));
    while let Some((i, _)) = stack.pop() {
        let node = mesh.bvh().node(i);
        if !is_met(node, p, &inverse, doubt) {
            continue;
        }
        match node.below() {
            Below::Children(both) => stack.extend(both.map(|child| (child, 0))),
            Below::Triangle(t) => winding += crossing(mesh.corners(t), p, d, doubt)?,
        }
    }
    Some(winding)
}

fn is_met(node: &Node, p: &Point3<f64>, inverse: &Vector3<f64>, doubt: f64) -> bool {
    let middle = (node.centre - p.coords).component_mul(inverse);
    let reach = node.half.add_scalar(doubt).component_mul(&inverse.abs());
    let (enter, leave) = ((middle - reach).max(), (middle + reach).min());
    leave >= enter.max(0.0)
}

/// 1, -1 or 0; `None` when the ray is too close to the triangle's edge or the point to its plane.
fn crossing(corners: &[Point3<f64>; 3], p: &Point3<f64>, d: &Vector3<f64>, doubt: f64) -> Option<i32> {
    let v = corners.map(|x| x - p);
    let (mut above, mut below, mut unsure) = (false, false, false);
    for k in 0..3 {
        let (x, y) = (v[k], v[(k + 1) % 3]);
        let side = d.dot(&x.cross(&y));
        if side.abs() <= 4.0 * doubt * (x.norm() + y.norm()) {
            unsure = true;
        } else if side > 0.0 {
            above = true;
        } else {
            below = true;
        }
    }
    if above && below {
        return Some(0);
    }
    let normal = (v[1] - v[0]).cross(&(v[2] - v[0]));
    let height = normal.dot(&v[0]);
    if height.abs() <= 4.0 * doubt * normal.norm() + 16.0 * f64::EPSILON * normal.norm() * v[0].norm() {
        // In the plane of the triangle: a miss only if the triangle is wholly behind.
        return if v.iter().all(|x| d.dot(x) < -doubt) { Some(0) } else { None };
    }
    match (above, height > 0.0) {
        _ if unsure && v.iter().all(|x| d.dot(x) < -doubt) => Some(0),
        _ if unsure => None,
        (true, true) => Some(1),
        (false, false) => Some(-1),
        _ => Some(0),
    }
}
