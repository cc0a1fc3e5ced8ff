//! The walk along the boundary of the free space, by linearised contacts (Algorithm 1 of the paper, section IV-B.2).
//!
//! Every iterate is free. At one, the contacts within a margin say to first order how A may move, n.(v + w x r) >= -(gap - clearance),
//! and the metric's step says which of these motions brings A nearest to the start. A pair of features at a local minimum of the distance has
//! one normal, along the gap; so a corner that faces a corner is one plane that either may slide along. Where the gap is small that plane turns
//! fast, and a walk round the corner creeps; in the end a walk from the best pose takes the union of what the faces forbid instead (section IV-A,
//! `branching`).
//!
//! Contacts that would become local minima when A turns a little count too: where a corner lies near an edge, the corner on the face and the
//! edge on the edge are minima in turns, and a walk that sees only one of them at a time goes to and fro between both.
//!
//! A seed that is a translation is first walked without turning: there the depth of translations is found, which no answer should exceed, and a
//! program in three variables finds it in fewer steps.
//!
//! The step is tried; as long as it collides it is halved, and the trust region shrinks with it. The clearance pays for what linearisation
//! and second-order correction leave out, so it shrinks with the trust region too: both vanish as the walk converges. The margin stays: contacts that
//! are out of sight would stop the next step.

use super::branching::branched_step;
use super::sampling::sampled_step;
use super::search::PoseSearch;
use super::step::{corrected_step, see};
use super::translation::Translation;
use super::{Scratch, Walk};
use crate::mesh::optimize::{Constraint, Twist};
use nalgebra::Isometry3;

/// The first trust region, in diagonals of A.
pub const TRUST: f64 = 0.05;
/// The margin within which contacts are seen, in diagonals of A.
const MARGIN: f64 = 0.003;
/// The gap that remains, in trust regions.
const CLEARANCE: f64 = 3e-3;
/// A walk has converged when its trust region is this small, in diagonals of A.
pub const LEAST: f64 = 2e-5;
/// Iterations at most.
pub const ITERATIONS: usize = 30;
/// The least gain of an iteration while A only translates: what follows gains the rest.
const TRANSLATION_GAIN: f64 = 1e-3;
/// How far a walk goes.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// It ends when an iteration improves by less than this fraction.
    pub gain: f64,
    /// It ends when it seems unlikely to become better than this.
    pub hopeless: f64,
}

/// How A may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Freedom {
    Translation,
    Motion,
}

/// Walks from a free pose, and offers where it ends. Returns that pose.
pub fn walk(search: &mut PoseSearch, from: &Isometry3<f64>, bounds: &Bounds) -> Isometry3<f64> {
    let mut pose = search.slide(from, 0.2 * MARGIN * search.size);
    if from.rotation == search.start.rotation && search.walk_kind == Walk::Linearised {
        let bounds = Bounds { gain: TRANSLATION_GAIN, ..*bounds };
        pose = advance(search, &pose, TRUST * search.size, ITERATIONS, Freedom::Translation, &bounds).0;
    }
    follow(search, &pose, TRUST * search.size, ITERATIONS, bounds).0
}

/// Walks from a free pose without turning, by linearised steps, and offers where it ends.
pub fn translate(search: &mut PoseSearch, from: &Isometry3<f64>, gain: f64) {
    let pose = search.slide(from, 0.2 * MARGIN * search.size);
    let bounds = Bounds { gain, hopeless: f64::INFINITY };
    advance(search, &pose, TRUST * search.size, ITERATIONS, Freedom::Translation, &bounds);
}

/// Walks from a free pose near the boundary, with a first trust region and so many steps, and offers where it ends. Returns that pose, and
/// the trust region there.
pub fn follow(
    search: &mut PoseSearch,
    from: &Isometry3<f64>,
    trust: f64,
    steps: usize,
    bounds: &Bounds,
) -> (Isometry3<f64>, f64) {
    search.walks += 1;
    advance(search, from, trust, steps, Freedom::Motion, bounds)
}

fn advance(
    search: &mut PoseSearch,
    from: &Isometry3<f64>,
    trust: f64,
    steps: usize,
    freedom: Freedom,
    bounds: &Bounds,
) -> (Isometry3<f64>, f64) {
    let margin = MARGIN * search.size;
    let most = TRUST * search.size;
    let mut pose = *from;
    let mut value = search.distance(&pose);
    let mut trust = trust.min(most);
    let mut poor = 0;
    for iteration in 0..steps {
        if !search.goes_on() {
            break;
        }
        let clearance = (CLEARANCE * trust).min(0.1 * margin);
        let Some((next, length, fraction)) = step(search, &pose, value, trust, margin, clearance, freedom) else {
            trust *= 0.1;
            if trust < LEAST * search.size {
                break;
            }
            continue;
        };
        let next_value = search.distance(&next);
        let gain = 1.0 - next_value / value;
        pose = next;
        value = next_value;
        trust = if fraction < 1.0 { fraction * length } else { (2.0 * trust).min(4.0 * length).min(most) };
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
    search.take(&pose);
    (pose, trust)
}

/// One step: the next pose, the length of the full step, and the fraction of it that was free.
fn step(
    search: &mut PoseSearch,
    pose: &Isometry3<f64>,
    value: f64,
    trust: f64,
    margin: f64,
    clearance: f64,
    freedom: Freedom,
) -> Option<(Isometry3<f64>, f64, f64)> {
    let found = match search.walk_kind {
        Walk::Linearised => linear_step(search, pose, trust, margin, clearance, freedom)?,
        Walk::Branching => branched_step(search, pose, trust, margin, clearance)?,
        Walk::Sampling => sampled_step(search, pose, trust, margin, clearance)?,
    };
    let length = found.linear.norm().max(found.angular.norm() * search.metric.frame().radius);
    let mut fraction = 1.0;
    for _ in 0..6 {
        let next = found.scaled(fraction).applied(pose);
        if !search.goes_on() {
            return None;
        }
        if search.distance(&next) < value && !search.pair.collides(&next) {
            return Some((next, length, fraction));
        }
        fraction *= 0.5;
    }
    None
}

/// The best motion under the contacts, each as the plane across its gap.
fn linear_step(
    search: &mut PoseSearch,
    pose: &Isometry3<f64>,
    trust: f64,
    margin: f64,
    clearance: f64,
    freedom: Freedom,
) -> Option<Twist> {
    let turns = freedom == Freedom::Motion;
    see(search, pose, if turns { trust } else { 0.0 }, margin);
    let translation = Translation { frame: *search.metric.frame() };
    let metric = if turns { search.metric } else { &translation };
    // At the centre a contact has no moment.
    let centre = pose * translation.frame.centre;
    let Scratch { contacts, constraints, .. } = &mut *search.scratch;
    constraints.clear();
    constraints.extend(contacts.iter().map(|c| Constraint {
        point: if turns { c.on_a } else { centre },
        normal: c.normal,
        gap: c.gap - clearance,
    }));
    corrected_step(search, metric, pose, trust, clearance)
}

impl PoseSearch<'_, '_, '_> {
    /// Walks from a free pose, and notes where that began and ended.
    pub fn walk(&mut self, from: &Isometry3<f64>, gain: f64, hopeless: f64) {
        if self.goes_on() {
            let end = walk(self, from, &Bounds { gain, hopeless });
            self.scratch.walked.push([*from, end]);
        }
    }
}
