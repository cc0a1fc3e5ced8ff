//! The pairs of features that a pair of triangles is responsible for.
//!
//! The distance of two meshes is attained by a vertex and a triangle or by two edges. Each vertex and each edge is owned by one triangle
//! of its mesh, and the boxes of the owners are as near as the features, so a traversal that looks only at what the two triangles own
//! still meets every pair, once: some 3 instead of 15 per pair of triangles.

use super::super::{Feature, Mesh};
use super::relative::Relative;
use crate::mesh::triangle::{Place, nearest_on_segments, nearest_on_triangle};
use nalgebra::Point3;

/// Two features and their nearest points, in the frame of B.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub feature_a: Feature,
    pub feature_b: Feature,
    pub on_a: Point3<f64>,
    pub on_b: Point3<f64>,
    /// Squared distance; not a number where degenerate triangles have no answer.
    pub squared: f64,
}

/// The feature that a place on a triangle is.
pub(super) fn feature(mesh: &Mesh, triangle: u32, place: Place) -> Feature {
    match place {
        Place::Face => Feature::Face(triangle),
        Place::Edge(k) => Feature::Edge(mesh.topology().face_edges(triangle)[k as usize % 3]),
        Place::Corner(k) => Feature::Vertex(mesh.triangles()[triangle as usize][k as usize % 3]),
    }
}

/// The pairs that the triangles s of A and t of B own; the corners of s are given in the frame of B.
pub(super) fn candidates(
    (a, s, on_s): (&Mesh, u32, &[Point3<f64>; 3]),
    (b, t, on_t): (&Mesh, u32, &[Point3<f64>; 3]),
    mut visit: impl FnMut(Candidate),
) {
    let (own_a, own_b) = (a.topology().owned(s), b.topology().owned(t));
    let mut offer = |feature_a, feature_b, on_a: Point3<f64>, on_b: Point3<f64>| {
        visit(Candidate { feature_a, feature_b, on_a, on_b, squared: (on_a - on_b).norm_squared() });
    };
    for k in 0..3u8 {
        if own_a & (1 << k) != 0 {
            let p = on_s[k as usize];
            let (q, place) = nearest_on_triangle(&p, on_t);
            offer(feature(a, s, Place::Corner(k)), feature(b, t, place), p, q);
        }
        if own_b & (1 << k) != 0 {
            let q = on_t[k as usize];
            let (p, place) = nearest_on_triangle(&q, on_s);
            offer(feature(a, s, place), feature(b, t, Place::Corner(k)), p, q);
        }
    }
    let edge = |corners: &[Point3<f64>; 3], k: usize| (corners[k], corners[(k + 1) % 3] - corners[k]);
    let at = |x: f64, k: usize| match k as u8 {
        k if x <= 0.0 => Place::Corner(k),
        k if x >= 1.0 => Place::Corner((k + 1) % 3),
        k => Place::Edge(k),
    };
    for i in 0..3 {
        if own_a & (8 << i) == 0 {
            continue;
        }
        let (p, d) = edge(on_s, i);
        for j in 0..3 {
            if own_b & (8 << j) == 0 {
                continue;
            }
            let (q, e) = edge(on_t, j);
            let (x, y) = nearest_on_segments(&p, &d, &q, &e);
            offer(feature(a, s, at(x, i)), feature(b, t, at(y, j)), p + d * x, q + e * y);
        }
    }
}

/// The squared distance of two triangles, as far as they own it, and their features.
pub(super) fn nearest(a: &Mesh, b: &Mesh, relative: &Relative, s: u32, t: u32, mut best: Candidate) -> Candidate {
    let on_s = relative.place_all(a.corners(s));
    candidates((a, s, &on_s), (b, t, b.corners(t)), |x| {
        if x.squared < best.squared {
            best = x;
        }
    });
    best
}

/// The first corners of two triangles: any pair of points, to begin with.
pub(super) fn any(a: &Mesh, b: &Mesh, relative: &Relative, s: u32, t: u32) -> Candidate {
    let (on_a, on_b) = (relative.place(&a.corners(s)[0]), b.corners(t)[0]);
    Candidate {
        feature_a: feature(a, s, Place::Corner(0)),
        feature_b: feature(b, t, Place::Corner(0)),
        on_a,
        on_b,
        squared: (on_a - on_b).norm_squared(),
    }
}
