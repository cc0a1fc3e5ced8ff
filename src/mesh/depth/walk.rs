//! The walk along the boundary of the free space, by linearised contacts (Algorithm 1 of the paper, section IV-B.2).
//!
//! Every iterate is free. At one, the contacts within a margin say to first order how A may move, n.(v + w x r) >= -(gap - clearance),
//! and the metric's step says which of these motions brings A nearest to the start. A pair of features at a local minimum of the distance has
//! one normal, along the gap; so a corner that faces a corner is one plane that either may slide along, and unions of constraints
//! (section IV-A) arise only where a gap vanishes, which the clearance prevents.
//!
//! The step is tried; as long as it collides it is halved, and the trust region shrinks with it. The clearance pays for what the linearisation
//! leaves out, so it shrinks with the trust region too: both vanish as the walk converges. In the end A slides along the screw
//! to the start until it touches.

use super::search::Search;
use crate::mesh::optimize::{Constraint, StepOptions};
use nalgebra::Isometry3;

/// The first trust region, in diagonals of A.
const TRUST: f64 = 0.05;
/// The margin within which contacts are seen, in trust regions.
const MARGIN: f64 = 0.1;
/// The gap that remains, in margins.
const CLEARANCE: f64 = 0.01;
/// A walk has converged when its trust region is this small, in diagonals of A.
const LEAST: f64 = 2e-5;
/// Iterations at most.
const ITERATIONS: usize = 30;
/// Contacts that a step can take; of more, the nearest.
pub const CONTACTS: usize = 256;

/// How far a walk goes.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// It ends when an iteration improves by less than this fraction.
    pub gain: f64,
    /// It ends when it seems unlikely to become better than this.
    pub hopeless: f64,
}

/// Walks from a free pose; offers every improvement of the best. Returns where it ends, a free pose.
pub fn walk(search: &mut Search, from: &Isometry3<f64>, bounds: &Bounds) -> Isometry3<f64> {
    search.walks += 1;
    let mut pose = *from;
    let mut value = search.distance(&pose);
    let mut trust = TRUST * search.size;
    let mut poor = 0;
    for iteration in 0..ITERATIONS {
        if !search.goes_on() {
            break;
        }
        let margin = MARGIN * trust;
        let Some((next, length, fraction)) = step(search, &pose, value, trust, margin) else {
            trust *= 0.25;
            if trust < LEAST * search.size {
                break;
            }
            continue;
        };
        let next_value = search.distance(&next);
        let gain = 1.0 - next_value / value;
        pose = next;
        value = next_value;
        trust = if fraction < 1.0 { (2.0 * fraction * trust).min(0.5 * trust) } else { trust.min(4.0 * length) };
        if trust < LEAST * search.size {
            break;
        }
        poor = if gain < bounds.gain { poor + 1 } else { 0 };
        if poor >= 2 {
            break;
        }
        // A walk converges fast: what remains is a small multiple of what was just won.
        if iteration >= 2 && value * (1.0 - 4.0 * gain) > bounds.hopeless {
            break;
        }
    }
    let slid = search.slide(&pose, 1e-6 * search.size);
    search.take(&slid);
    slid
}

/// One step: the next pose, the length of the full step, and the fraction of it that was free.
fn step(
    search: &mut Search,
    pose: &Isometry3<f64>,
    value: f64,
    trust: f64,
    margin: f64,
) -> Option<(Isometry3<f64>, f64, f64)> {
    search.pair.contacts(pose, margin, &mut search.scratch.contacts);
    search.limit_contacts();
    let scratch = &mut *search.scratch;
    scratch.constraints.clear();
    scratch.constraints.extend(scratch.contacts.iter().map(|c| Constraint {
        point: c.on_a,
        normal: c.normal,
        gap: c.gap - CLEARANCE * margin,
    }));
    let options = StepOptions { trust, tolerance: 1e-3 };
    let found =
        search.metric.step(&search.start, pose, &scratch.constraints, &options, &mut scratch.memory).ok()?;
    let length = found.twist.linear.norm().max(found.twist.angular.norm() * search.metric.frame().radius);
    let mut fraction = 1.0;
    for _ in 0..8 {
        let next = found.twist.scaled(fraction).applied(pose);
        if search.distance(&next) < value && !search.pair.collides(&next) {
            return Some((next, length, fraction));
        }
        fraction *= 0.5;
    }
    None
}
