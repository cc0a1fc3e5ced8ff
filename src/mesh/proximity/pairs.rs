//! The walk over pairs of boxes, from the roots of both trees to the pairs of triangles that may be near.

use super::super::Mesh;
use super::super::bvh::Below;
use super::boxes::Boxes;
use super::relative::Relative;
use std::ops::ControlFlow;

/// The children of the larger box of a pair, each with the other box.
#[inline]
pub(super) fn open(a: &Mesh, b: &Mesh, pair: (u32, u32)) -> Result<[(u32, u32); 2], (u32, u32)> {
    let (i, j) = pair;
    let (node_a, node_b) = (a.bvh().node(i), b.bvh().node(j));
    let a_first = !node_a.is_leaf() && (node_b.is_leaf() || node_a.size >= node_b.size);
    match (node_a.below(), node_b.below()) {
        (Below::Children([x, y]), _) if a_first => Ok([(x, j), (y, j)]),
        (_, Below::Children([x, y])) => Ok([(i, x), (i, y)]),
        (Below::Triangle(s), Below::Triangle(t)) => Err((s, t)),
        (Below::Children([x, y]), _) => Ok([(x, j), (y, j)]),
    }
}

/// Visits all pairs of triangles whose boxes may be nearer than the margin, until the visitor breaks.
pub(super) fn walk<B>(
    a: &Mesh,
    b: &Mesh,
    relative: &Relative,
    margin: f64,
    stack: &mut Vec<(u32, u32)>,
    visit: impl FnMut(u32, u32) -> ControlFlow<B>,
) -> ControlFlow<B> {
    walk_culled(a, b, relative, margin, stack, |_| false, visit)
}

/// The same without the pairs of boxes that `skip` knows to hold nothing.
pub(super) fn walk_culled<B>(
    a: &Mesh,
    b: &Mesh,
    relative: &Relative,
    margin: f64,
    stack: &mut Vec<(u32, u32)>,
    skip: impl Fn((u32, u32)) -> bool,
    mut visit: impl FnMut(u32, u32) -> ControlFlow<B>,
) -> ControlFlow<B> {
    let boxes = Boxes::new(relative, a, b, margin);
    stack.clear();
    stack.push((0, 0));
    while let Some(pair) = stack.pop() {
        let (node_a, node_b) = (a.bvh().node(pair.0), b.bvh().node(pair.1));
        if boxes.are_apart(node_a, node_b) || skip(pair) {
            continue;
        }
        match open(a, b, pair) {
            Ok(both) => stack.extend(both),
            Err((s, t)) => visit(s, t)?,
        }
    }
    ControlFlow::Continue(())
}
