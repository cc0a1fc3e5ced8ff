//! The paper's own search of the local contact space (section IV-B.1): random samples on the contacts.
//!
//! A sample turns A by a random small rotation. That makes every primitive constraint linear in the translation, n_i.t = c_i,
//! and a random translation is projected onto the planes of up to three contacts, so that the sample touches there. Samples
//! outside of the contact space, with its unions and intersections, are discarded; of the others, the one nearest to the start is the step.

use super::search::PoseSearch;
use super::step::see_space;
use crate::mesh::optimize::Twist;
use nalgebra::{Isometry3, Matrix3, Vector3};

/// Samples of a step.
const SAMPLES: usize = 200;

/// The best of some random motions under the contacts.
pub fn sampled_step(
    search: &mut PoseSearch,
    pose: &Isometry3<f64>,
    trust: f64,
    margin: f64,
    clearance: f64,
) -> Option<Twist> {
    see_space(search, pose, trust, margin);
    let (about, radius) = (pose * search.metric.frame().centre, search.metric.frame().radius);
    let back = pose.inverse();
    let mut best = None;
    let mut least = search.distance(pose);
    for _ in 0..SAMPLES {
        // Sizes of all orders: fine steps are needed near a minimum.
        let (turn, shift) = (search.random.signed().abs().powi(3), search.random.signed().abs().powi(3));
        let angular = search.random.direction() * (turn * trust / radius);
        let linear = search.random.direction() * (shift * trust);
        let mut twist = Twist { linear, angular, about };
        project(search, &mut twist, pose, &back, clearance);
        let moved = twist.applied(pose);
        let motion = moved * back;
        let value = search.distance(&moved);
        if value < least && search.scratch.space.value(&motion) >= 0.5 * clearance {
            least = value;
            best = Some(twist);
        }
    }
    best
}

/// Translates so that up to three random contacts have the gap that remains.
fn project(search: &mut PoseSearch, twist: &mut Twist, pose: &Isometry3<f64>, back: &Isometry3<f64>, clearance: f64) {
    let (planes, members) = (search.scratch.space.planes().len(), search.scratch.space.members().len());
    let count = planes + members;
    if count == 0 {
        return;
    }
    let motion = twist.applied(pose) * back;
    // Orthonormal normals (Gram and Schmidt), so that each correction leaves the planes before in peace.
    let mut basis = Matrix3::zeros();
    let mut shift = Vector3::zeros();
    let chosen = search.random.below(4).min(count);
    for k in 0..chosen {
        let (pick, space) = (search.random.below(count), &search.scratch.space);
        let p = space.planes().get(pick).unwrap_or_else(|| &space.members()[pick - planes]);
        let normal = p.normal_after(&motion);
        let rest = normal - basis * basis.tr_mul(&normal);
        let length = rest.norm();
        if length > 1e-3 {
            let missing = clearance - (p.gap(&motion) + normal.dot(&shift));
            shift += rest * (missing / (length * length));
            basis.set_column(k, &(rest / length));
        }
    }
    twist.linear += shift;
}
