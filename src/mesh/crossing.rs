//! Whether a surface crosses itself.
//!
//! A closed surface that is wound outward and does not cross itself has its reentrant edges where nothing can be nearest to them: their
//! neighbours are in the way. One that crosses itself may be wound inward in parts, and there what is called reentrant sticks out. The answer
//! may be yes for a surface that only touches itself, or takes too long to tell; it is no only where that is proved.

use super::bvh::{Below, Bvh, Node};
use super::triangle::apart;
use nalgebra::{Point3, Vector3};

/// Pairs of triangles that are looked at, per triangle.
const WORK: usize = 256;

/// Whether two of these triangles may cross, whose tree this is; `scale` is the largest coordinate. Neighbours are known by their corners'
/// positions.
pub(super) fn crosses_itself(corners: &[[Point3<f64>; 3]], bvh: &Bvh, scale: f64) -> bool {
    let doubt = 4.0 * f64::EPSILON * scale;
    let mut work = WORK * corners.len();
    let mut stack = vec![(0u32, 0u32)];
    while let Some((i, j)) = stack.pop() {
        let (x, y) = (bvh.node(i), bvh.node(j));
        if !overlap(x, y) {
            continue;
        }
        match (x.below(), y.below()) {
            (Below::Children([a, b]), _) if i == j => stack.extend([(a, a), (b, b), (a, b)]),
            (Below::Children(both), _) if y.is_leaf() || x.size >= y.size => stack.extend(both.map(|k| (k, j))),
            (_, Below::Children(both)) => stack.extend(both.map(|k| (i, k))),
            (Below::Triangle(s), Below::Triangle(t)) if s != t => {
                let (s, t) = (&corners[s as usize], &corners[t as usize]);
                if work == 0 || cross(s, t, doubt) || cross(t, s, doubt) {
                    return true;
                }
                work -= 1;
            }
            _ => {}
        }
    }
    false
}

fn overlap(x: &Node, y: &Node) -> bool {
    let gap: Vector3<f64> = (x.centre - y.centre).abs() - x.half - y.half;
    gap.max() <= 0.0
}

/// Whether what the first triangle does not share with the other may touch it.
fn cross(s: &[Point3<f64>; 3], t: &[Point3<f64>; 3], doubt: f64) -> bool {
    let mut own = s.iter().filter(|p| !t.contains(p));
    match (own.next(), own.next(), own.next()) {
        (Some(p), Some(q), Some(r)) => !apart(&[*p, *q, *r], t, doubt),
        (Some(p), q, _) => !apart(&[*p, *q.unwrap_or(p), *p], t, doubt),
        _ => false,
    }
}
