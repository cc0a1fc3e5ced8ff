//! One tick of the [tracker](super::DepthTracker): what is remembered from the ticks before, and what is done with the budget, in this order.

use super::budget::Budget;
use super::random::Random;
use super::search::PoseSearch;
use super::seeds::{pushout, rays};
use super::walk::{Bounds, LEAST, TRUST, follow};
use super::{MeshDepth, Outcome};
use crate::mesh::metric::{Certificate, Metric};
use crate::mesh::optimize::Twist;
use crate::mesh::{Model, Screw};
use nalgebra::Isometry3;

/// Free poses that are remembered.
const POSES: usize = 4;
/// Two remembered poses are as one when they are nearer to each other than this, in diagonals of A.
const SAME: f64 = 0.02;
/// Steps of the walk of the best pose, and of another.
const STEPS: usize = 6;
const STEPS_BESIDE: usize = 2;
/// The first trust region, in motions of the query.
const AHEAD: f64 = 4.0;
/// A walk ends when it gains less.
const GAIN: f64 = 1e-3;
/// A pose is refined beside the best unless it is worse by this factor.
const WORSE: f64 = 1.5;
/// Where a probe is made, as a fraction of the best value.
const NEARER: f64 = 0.97;
/// A motion of more than this fraction of A's diagonal is a jump.
const JUMP: f64 = 0.1;
/// The pairs of triangles that a push-out may look at.
const WORK: usize = 1000;
/// Every so many ticks a push-out looks for another valley.
const LOOK: u64 = 4;
/// And the pairs of triangles that it may look at.
const LOOK_WORK: usize = 300;
/// Bisections of the way from a new pose to the query's.
const BISECTIONS: usize = 8;
/// A new lower bound is asked for when this fraction of the upper bound is lost.
const LOST: f64 = 0.1;
/// Rounding of a metric's distance, in units of coordinates.
const ROUNDING: f64 = 1e-12;

/// A free pose, and the trust region where its walk ended; `None` before the first walk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub pose: Isometry3<f64>,
    trust: Option<f64>,
}

/// A lower bound, where it was certified.
#[derive(Clone, Copy, Debug)]
pub(super) struct Certified {
    kind: Certificate,
    at: Isometry3<f64>,
    lower: f64,
}

/// What is remembered from tick to tick.
pub(super) struct Memory {
    /// Free poses.
    pub known: Vec<Known>,
    /// The last query's pose, and its answer's.
    last: Option<(Isometry3<f64>, Isometry3<f64>)>,
    /// Of DISP and of the object norm.
    certified: [Option<Certified>; 2],
    random: Random,
    ticks: u64,
}

impl Memory {
    pub fn new() -> Self {
        let known = Vec::with_capacity(POSES + 1);
        Memory { known, last: None, certified: [None; 2], random: Random::new(0), ticks: 0 }
    }

    pub fn clear(&mut self) {
        self.known.clear();
        self.last = None;
        self.certified = [None; 2];
        self.random = Random::new(0);
        self.ticks = 0;
    }

    /// Takes a free pose of A from elsewhere.
    pub fn merge(&mut self, pose: Isometry3<f64>, a: &Model) {
        let Some((start, _)) = self.last else {
            self.known.truncate(POSES - 1);
            self.known.push(Known { pose, trust: None });
            return;
        };
        remember(&mut self.known, Known { pose, trust: None }, a.disp(), &start, SAME * a.mesh().diagonal());
    }
}

/// A tick that has begun.
pub(super) struct Tick<'t, 's, 'm, 'w> {
    search: PoseSearch<'s, 'm, 'w>,
    memory: &'t mut Memory,
    budget: &'t Budget,
    /// Where the lower bound of this metric is remembered.
    slot: Option<usize>,
    /// How far the query's pose has moved since the last tick.
    motion: f64,
}

impl<'t, 's, 'm, 'w> Tick<'t, 's, 'm, 'w> {
    /// For a valid query.
    pub fn new(search: PoseSearch<'s, 'm, 'w>, memory: &'t mut Memory, budget: &'t Budget) -> Self {
        let slot = match search.metric.certificate() {
            Certificate::None => None,
            Certificate::Disp => Some(0),
            Certificate::SqrtSigma => Some(1),
        };
        Tick { search, memory, budget, slot, motion: f64::INFINITY }
    }

    pub fn is_apart(&mut self) -> bool {
        !self.search.pair.collides(&self.search.start)
    }

    /// The answer when the bodies are apart: the pose itself is free.
    pub fn apart(mut self) -> MeshDepth {
        let (pose, search) = (self.search.start, &mut self.search);
        let same = SAME * search.size;
        remember(&mut self.memory.known, Known { pose, trust: None }, search.metric, &pose, same);
        self.memory.last = Some((pose, pose));
        let distance = search.goes_on().then(|| search.pair.distance(&pose));
        search.upper = 0.0;
        MeshDepth { distance, ..search.answer(Outcome::Separated) }
    }

    /// The lower bound that is left of the remembered one, and the upper bounds of the poses that are known.
    pub fn recall(&mut self) {
        let (pose, search) = (self.search.start, &mut self.search);
        let bound = self.slot.and_then(|slot| self.memory.certified[slot]);
        search.lower = bound.map_or(0.0, |bound| carried(&bound, search.a, &pose));
        self.memory.known.iter().for_each(|known| search.take(&known.pose));
        let last = self.memory.last.as_ref();
        self.motion = last.map_or(f64::INFINITY, |(start, _)| search.metric.distance(start, &pose));
    }

    /// Moves the last answer along with the query.
    pub fn follow_the_last_answer(&mut self) {
        let (pose, search) = (self.search.start, &mut self.search);
        if let Some((start, answer)) = self.memory.last
            && start != answer
            && search.upper > search.metric.distance(&start, &answer)
            && search.goes_on()
        {
            let mut moved = pose * start.inverse() * answer;
            moved.rotation.renormalize();
            if !search.pair.collides(&moved) {
                self.take(moved);
            }
        }
    }

    /// A pose that is known, a cold answer's perhaps, may be all that is needed; nothing else tells.
    pub fn certify_what_is_known(&mut self) {
        if let (Some(slot), Some(_)) = (self.slot, self.budget.certificate)
            && self.memory.certified[slot].is_none()
            && self.search.upper.is_finite()
            && !self.search.is_interrupted()
        {
            self.memory.certified[slot] = certify(&mut self.search);
        }
    }

    /// Where no pose is known, A escapes from B's box; after a jump it is pushed out.
    pub fn find_a_way_out(&mut self) {
        let search = &mut self.search;
        if self.memory.known.is_empty() && !search.is_interrupted() && rays::escape(search).is_some() {
            self.memory.known.push(Known { pose: search.pose, trust: None });
        }
        if self.motion > JUMP * search.size
            && search.goes_on()
            && let Some(pushed) = pushout::push_out(search, WORK)
        {
            self.take(pushed);
        }
    }

    /// Follows the nearest pose, and looks for better valleys at random.
    pub fn walk_and_probe(&mut self) {
        self.refine(0, STEPS);
        for _ in 0..self.budget.probes {
            if !self.search.upper.is_finite() || !self.search.goes_on() {
                break;
            }
            let probe = probe(&self.search, &mut self.memory.random);
            if self.search.distance(&probe) < self.search.upper && !self.search.pair.collides(&probe) {
                self.take(probe);
                self.refine(0, STEPS_BESIDE);
            }
        }
    }

    /// Now and then a push-out for a way that no probe finds, else another remembered pose.
    pub fn look_beside(&mut self) {
        self.memory.ticks += 1;
        if self.memory.ticks.is_multiple_of(LOOK) {
            if let Some(pushed) = pushout::push_out(&mut self.search, LOOK_WORK) {
                self.take(pushed);
            }
        } else if self.memory.known.len() > 1 {
            let beside = 1 + self.memory.random.below(self.memory.known.len() - 1);
            self.refine(beside, STEPS_BESIDE);
        }
    }

    /// A new lower bound, where there is none or much of it is lost.
    pub fn renew_the_bound(&mut self) {
        let (Some(slot), Some(_)) = (self.slot, self.budget.certificate) else { return };
        let search = &mut self.search;
        let is_stale = |bound: Certified| {
            let lost = bound.lower - search.lower.min(bound.lower);
            lost.max(search.metric.distance(&bound.at, &search.start)) > LOST * search.upper
        };
        if self.memory.certified[slot].is_none_or(is_stale) && !search.is_interrupted() {
            self.memory.certified[slot] = certify(search);
        }
    }

    pub fn end(self) -> MeshDepth {
        let search = &self.search;
        self.memory.last = Some((search.start, search.pose));
        let outcome = if search.upper == f64::INFINITY { Outcome::Stuck } else { search.outcome() };
        search.answer(outcome)
    }

    /// Takes a free pose, and remembers it.
    fn take(&mut self, pose: Isometry3<f64>) {
        let search = &mut self.search;
        search.take(&pose);
        remember(&mut self.memory.known, Known { pose, trust: None }, search.metric, &search.start, 0.0);
    }

    fn refine(&mut self, rank: usize, steps: usize) {
        refine(&mut self.search, &mut self.memory.known, rank, self.motion, steps);
    }
}

/// A new lower bound.
fn certify(search: &mut PoseSearch) -> Option<Certified> {
    search.lower = search.lower.max(search.certify()).min(search.upper);
    Some(Certified { kind: search.metric.certificate(), at: search.start, lower: search.lower })
}

/// A lower bound at another pose. DISP and the object norm are A's own, whatever metric they certify.
fn carried(bound: &Certified, a: &Model, pose: &Isometry3<f64>) -> f64 {
    let motion = match (bound.kind, a.sigma()) {
        (Certificate::SqrtSigma, Some(sigma)) => sigma.distance(&bound.at, pose),
        _ => a.disp().distance(&bound.at, pose),
    };
    let (low, high) = a.mesh().bounds();
    let reach = low.coords.amax().max(high.coords.amax());
    let extent = reach + bound.at.translation.vector.amax().max(pose.translation.vector.amax());
    (bound.lower - motion - ROUNDING * extent).max(0.0)
}

/// Adds a free pose. Of poses that are nearer to each other than `same`, the one nearer to the query's stays; of too many, the farthest goes.
fn remember(known: &mut Vec<Known>, new: Known, metric: &dyn Metric, start: &Isometry3<f64>, same: f64) {
    let value = |known: &Known| metric.distance(start, &known.pose);
    known.push(new);
    known.sort_by(|x, y| value(x).total_cmp(&value(y)));
    let mut kept = 0;
    for i in 0..known.len() {
        if known[..kept].iter().all(|better| metric.distance(&better.pose, &known[i].pose) > same) {
            known.swap(kept, i);
            kept += 1;
        }
    }
    known.truncate(kept.min(POSES));
}

/// Walks from a remembered pose, the `rank`-th by its distance, and remembers where that leads.
fn refine(search: &mut PoseSearch, known: &mut Vec<Known>, rank: usize, motion: f64, steps: usize) {
    let (metric, start, size) = (search.metric, search.start, search.size);
    known.sort_by(|x, y| search.distance(&x.pose).total_cmp(&search.distance(&y.pose)));
    let Some(from) = known.get(rank).copied() else { return };
    if search.distance(&from.pose) > WORSE * search.upper || !search.goes_on() {
        return;
    }
    let pose = if from.trust.is_some() { from.pose } else { approach(search, &from.pose) };
    let trust = from.trust.map_or(TRUST * size, |trust| trust.max(AHEAD * motion).max(2.0 * LEAST * size));
    let (pose, trust) = follow(search, &pose, trust, steps, &Bounds { gain: GAIN, hopeless: f64::INFINITY });
    known.swap_remove(rank);
    remember(known, Known { pose, trust: Some(trust) }, metric, &start, SAME * size);
}

/// Towards the query's pose until it touches, roughly.
fn approach(search: &mut PoseSearch, free: &Isometry3<f64>) -> Isometry3<f64> {
    let screw = Screw::new(free, &search.start);
    let (mut s, mut colliding) = (0.0, 1.0);
    for _ in 0..BISECTIONS {
        if !search.goes_on() {
            break;
        }
        let middle = 0.5 * (s + colliding);
        if search.pair.collides(&screw.at(middle)) {
            colliding = middle;
        } else {
            s = middle;
        }
    }
    screw.at(s)
}

/// A random pose that is a little nearer than the best.
fn probe(search: &PoseSearch, random: &mut Random) -> Isometry3<f64> {
    let frame = search.metric.frame();
    let turn = random.signed().max(0.0);
    let twist = Twist {
        linear: random.direction() * (1.0 - turn),
        angular: random.direction() * (turn / frame.radius),
        about: search.start * frame.centre,
    };
    let mut length = search.upper;
    // The metric is nearly linear along a screw.
    for _ in 0..2 {
        let value = search.distance(&twist.scaled(length).applied(&search.start));
        length *= NEARER * search.upper / value.max(f64::MIN_POSITIVE);
    }
    twist.scaled(length).applied(&search.start)
}
