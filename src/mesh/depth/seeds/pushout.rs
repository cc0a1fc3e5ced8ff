//! Pushing out what penetrates: the walk from the inside, for narrow passages that no ray finds.
//!
//! At a pose that overlaps, features that have passed through each other are contacts with negative gaps, and the metric's step finds the
//! motion that is least from the start and undoes them all, to first order. A few steps lead to a free pose, if there is one near by, or
//! to a value that says that this is no way out.

use super::super::search::Search;
use crate::mesh::optimize::{Constraint, StepOptions};
use nalgebra::Isometry3;

/// Steps at most.
const STEPS: usize = 12;
/// How deep features are looked for, in diagonals of A.
const REACH: f64 = 0.05;
/// The gap that is aimed at, in diagonals of A.
const CLEARANCE: f64 = 1e-3;
/// Step length at most, in diagonals of A.
const TRUST: f64 = 0.2;

/// A free pose from one that overlaps.
pub fn push_out(search: &mut Search, from: &Isometry3<f64>) -> Option<Isometry3<f64>> {
    let mut pose = *from;
    let mut reach = REACH * search.size;
    for _ in 0..STEPS {
        if !search.goes_on() {
            return None;
        }
        search.pair.overlaps(&pose, reach, &mut search.scratch.contacts);
        search.limit_contacts();
        let scratch = &mut *search.scratch;
        if !scratch.contacts.iter().any(|c| c.gap < 0.0) {
            reach *= 2.0;
        }
        scratch.constraints.clear();
        scratch.constraints.extend(scratch.contacts.iter().map(|c| Constraint {
            point: c.on_a,
            normal: c.normal,
            gap: c.gap - CLEARANCE * search.size,
        }));
        let options = StepOptions { trust: TRUST * search.size, tolerance: 1e-2 };
        let step = search.metric.step(&search.start, &pose, &scratch.constraints, &options, &mut scratch.memory).ok()?;
        pose = step.twist.applied(&pose);
        if std::env::var("DBG").is_ok() { eprintln!("  push reach {:.3} n {} neg {} end {:?} value {:.4} viol {:.2e}", reach, scratch.contacts.len(), scratch.contacts.iter().filter(|c| c.gap<0.0).count(), step.end, search.metric.distance(&search.start, &pose), step.violation); }
        if search.distance(&pose) > 1.2 * search.upper {
            return None;
        }
        if !search.pair.collides(&pose) {
            return Some(pose);
        }
    }
    None
}
