//! The end of a query: from the best pose that the search has met to the answer.
//!
//! Walks of the search end early. What they leave is taken here:
//!
//! * Where corners meet corners, planes stop a walk short of its end; one from the best pose takes unions instead (`branching`).
//! * Translations near by may be over the edge of a neighbouring valley (`rays::beside`).
//! * The least motion often does not turn at all. A walk that turns comes near it and creeps; the program in three variables ends there.
//! * The pose is brought to where it touches.

use super::Walk;
use super::schedule::Schedule;
use super::search::PoseSearch;
use super::seeds::rays;
use super::walk::{Bounds, ITERATIONS, follow, translate};

/// The first trust region of the walk from the best pose, in diagonals of A. The pose is nearly there.
const REFINE_TRUST: f64 = 0.01;
/// How often a neighbour's neighbours are tried.
const HOPS: usize = 3;
/// No translation is looked for where it would gain less than this fraction.
const WORTHWHILE: f64 = 5e-4;
/// The least gain of an iteration of the last translation.
const LAST_GAIN: f64 = 1e-5;

/// Improves the best pose as far as that goes.
pub fn finish(search: &mut PoseSearch, schedule: &Schedule) {
    refine(search, schedule.gain);
    if search.walk_kind == Walk::Linearised {
        if hop(search, schedule) {
            refine(search, schedule.gain);
        }
        if is_worthwhile(search)
            && let Some(pose) = rays::without_turning(search)
        {
            translate(search, &pose, LAST_GAIN);
        }
    }
    polish(search);
}

/// Whether the lower bound leaves room for a gain.
fn is_worthwhile(search: &mut PoseSearch) -> bool {
    search.upper.is_finite() && search.upper * (1.0 - WORTHWHILE) > search.lower && search.goes_on()
}

/// Walks on from the best pose.
fn refine(search: &mut PoseSearch, gain: f64) {
    if !search.upper.is_finite() || !search.goes_on() {
        return;
    }
    let kind = search.walk_kind;
    if kind == Walk::Linearised {
        search.walk_kind = Walk::Branching;
    }
    let pose = search.pose;
    follow(search, &pose, REFINE_TRUST * search.size, ITERATIONS, &Bounds { gain, hopeless: f64::INFINITY });
    search.walk_kind = kind;
}

/// Goes over to better valleys beside the best pose. Whether there was one.
fn hop(search: &mut PoseSearch, schedule: &Schedule) -> bool {
    let before = search.upper;
    for _ in 0..HOPS {
        if !is_worthwhile(search) {
            break;
        }
        let Some(pose) = rays::beside(search, schedule.beside) else { break };
        search.walk(&pose, schedule.coarse, f64::INFINITY);
    }
    search.upper < before
}

/// Brings the best pose to where it touches; nearer where that is all that is left between the bounds.
fn polish(search: &mut PoseSearch) {
    for tolerance in [1e-6, 1e-10] {
        if search.upper.is_finite() && (tolerance == 1e-6 || search.is_closed()) {
            let pose = search.pose;
            let slid = search.slide(&pose, tolerance * search.size);
            search.take(&slid);
        }
    }
}
