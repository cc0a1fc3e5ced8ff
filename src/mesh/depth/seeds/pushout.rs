//! Pushing out what penetrates: the walk from the inside, for narrow passages that no ray finds.
//!
//! At a pose that overlaps, features that have passed through each other are contacts with negative gaps, and the metric's step finds the
//! motion that is least from the start and undoes them all, to first order. Features are looked for within a reach: it grows when
//! nothing is seen though the bodies overlap, and is halved where a query would have too much to look at. A few steps lead to a free pose, if there is one near by, or
//! to a value that says that this is no way out.

use super::super::search::PoseSearch;
use super::super::step::limit;
use crate::mesh::metric::Metric;
use crate::mesh::optimize::{Constraint, StepOptions};
use nalgebra::Isometry3;

/// Steps at most.
const STEPS: usize = 12;
/// How deep features are looked for, in diagonals of A.
const REACH: f64 = 0.05;
/// And at least, where there is so much to see that less must do.
const LEAST_REACH: f64 = 0.01;
/// The gap that is aimed at first, in diagonals of A.
const CLEARANCE: f64 = 1e-3;
/// What counts as a local minimum, as a sine.
const TILT: f64 = 0.1;
/// It is given up beyond this multiple of the best value: the walk that would follow hardly gains as much.
const HOPE: f64 = 1.4;
/// Step length at most, in diagonals of A.
const TRUST: f64 = 0.2;

/// A free pose from the query's.
pub fn push_out(search: &mut PoseSearch, work: usize) -> Option<Isometry3<f64>> {
    let start = search.start;
    push_out_from(search, &start, work)
}

/// A free pose from one that overlaps. `work` is how many pairs of triangles a query may look at.
pub fn push_out_from(search: &mut PoseSearch, from: &Isometry3<f64>, work: usize) -> Option<Isometry3<f64>> {
    // The object norm's steps are a single quadratic program, and hardly worse a guide to another metric.
    let metric = search.sigma.map_or(search.metric, |sigma| sigma as &dyn Metric);
    let mut clearance = CLEARANCE * search.size;
    let mut pose = *from;
    let mut reach = REACH * search.size;
    let mut most = 0.5 * search.size;
    for _ in 0..STEPS {
        loop {
            if !search.goes_on() {
                return None;
            }
            let mut left = work;
            let whole = search.pair.overlaps(&pose, reach, TILT, &mut left, &mut search.scratch.contacts);
            if whole {
                break;
            }
            reach *= 0.5;
            most = reach;
            if reach < LEAST_REACH * search.size {
                return None;
            }
        }
        limit(&mut search.scratch.contacts);
        let scratch = &mut *search.scratch;
        if !scratch.contacts.iter().any(|c| c.gap < 0.0) {
            if scratch.contacts.is_empty() && reach >= most {
                return None;
            }
            // What still overlaps is deeper than the reach, or touches in a way that is no minimum: more of both.
            reach = (2.0 * reach).min(most);
            clearance *= 2.0;
        }
        scratch.constraints.clear();
        scratch.constraints.extend(scratch.contacts.iter().map(|c| Constraint {
            point: c.on_a,
            normal: c.normal,
            gap: c.gap - clearance,
        }));
        let options = StepOptions { trust: TRUST * search.size, tolerance: 1e-2 };
        let step = metric.step(&search.start, &pose, &scratch.constraints, &options, &mut scratch.memory).ok()?;
        pose = step.twist.applied(&pose);
        if search.distance(&pose) > HOPE * search.upper {
            return None;
        }
        if !search.goes_on() {
            return None;
        }
        if !search.pair.collides(&pose) {
            return Some(pose);
        }
    }
    None
}
