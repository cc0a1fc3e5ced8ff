//! The warm query: the depth of a body that moves a little from tick to tick, within a hard budget (section IV-D of the paper, motion
//! coherence).
//!
//! B rests, so a pose of A that was free stays free: *free poses are remembered*, and at every tick the metric's distance of the nearest of them
//! is an upper bound at once, without any query. The rest of the budget makes it better:
//!
//! * The last answer, moved along with the query, keeps its distance; where it is free it is as good as it was.
//! * The nearest remembered pose lies on the boundary, where the last walk ended. A walk of a few steps follows the query, with a trust region of
//!   a few times the motion.
//! * A *probe* is one test at a random pose that is a little nearer than the best. Where it is free, a better valley has been found; that is
//!   how the tracker leaves a local minimum. Every fourth tick a small push-out from the query's pose looks for a way out that no
//!   probe finds; in the others another remembered pose is refined beside the best.
//! * A free pose from elsewhere, a cold query in the background, is [merged](DepthTracker::merge) in.
//!
//! Without a remembered pose (the first tick, a body that was never free) A escapes from B's box and is pushed out.
//!
//! The depth changes by no more than the query's pose moves, |PD(q0) - PD(q1)| <= metric(q0, q1), by the triangle inequality. So a *lower bound*
//! stays one when the motion is subtracted, and a new one is asked of the certificate when there is none or a tenth of the depth has been lost.
//!
//! Nothing waits for anything: a tick is at most the budget's queries, and no query begins when the caller's clock says that it is late.
//! A query that has begun is finished; the longest is a contact query, or a certificate.

use super::random::Random;
use super::search::Search;
use super::seeds::{pushout, rays};
use super::walk::{Bounds, LEAST, TRUST, follow};
use super::{DepthOptions, DepthSolver, Effort, MeshDepth, Outcome, Progress};
use crate::mesh::metric::{Certificate, Metric};
use crate::mesh::optimize::Twist;
use crate::mesh::pose::normalised;
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

/// What a tick may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Collision, contact and distance queries, at least 1, default 16: the pose itself is always tested. Where no free pose is known the
    /// escape from B's box comes on top, six tests at most.
    pub max_queries: u64,
    /// The tick ends when `upper - lower` is at most this fraction of `upper`, default 1e-3.
    pub relative: f64,
    /// Tests at random poses that are nearer than the best, default 4.
    pub probes: u32,
    /// Whether lower bounds are renewed, and with what effort (0.1 to 1 ms), default fast. Without, they are 0.
    pub certificate: Option<Effort>,
}

impl Default for Budget {
    /// 16 queries, 4 probes, fast certificates.
    fn default() -> Self {
        Budget { max_queries: 16, relative: 1e-3, probes: 4, certificate: Some(Effort::Fast) }
    }
}

/// A free pose, and the trust region where its walk ended; `None` before the first walk.
#[derive(Clone, Copy, Debug)]
struct Known {
    pose: Isometry3<f64>,
    trust: Option<f64>,
}

/// A lower bound, where it was certified.
#[derive(Clone, Copy, Debug)]
struct Certified {
    kind: Certificate,
    at: Isometry3<f64>,
    lower: f64,
}

/// Follows the depth of a moving body: one [`update`](DepthTracker::update) per tick of a control loop.
///
/// ```
/// use qdist::mesh::{Budget, DepthTracker, Model, Outcome};
/// use qdist::nalgebra::Isometry3;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?.with_pieces(&Default::default())?;
/// let mut tracker = DepthTracker::new(&body, &body);
/// for tick in 0..200 {
///     let pose = Isometry3::translation(0.0, 0.0, 1.1 - 1e-3 * f64::from(tick));
///     let depth = tracker.update(&pose, body.disp(), &Budget::default(), None);
///     assert!(depth.lower <= depth.upper && depth.upper < 0.11);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct DepthTracker<'m> {
    solver: DepthSolver<'m>,
    known: Vec<Known>,
    /// The last query's pose, and its answer's.
    last: Option<(Isometry3<f64>, Isometry3<f64>)>,
    certified: [Option<Certified>; 2],
    random: Random,
    ticks: u64,
}

impl<'m> DepthTracker<'m> {
    /// A moves, B rests.
    pub fn new(a: &'m Model, b: &'m Model) -> DepthTracker<'m> {
        DepthTracker {
            solver: DepthSolver::new(a, b),
            known: Vec::with_capacity(POSES + 1),
            last: None,
            certified: [None; 2],
            random: Random::new(0),
            ticks: 0,
        }
    }

    /// The solver, for other queries with the same memory.
    pub fn solver(&mut self) -> &mut DepthSolver<'m> {
        &mut self.solver
    }

    /// Forgets everything: the next update is the first.
    pub fn reset(&mut self) {
        self.known.clear();
        self.last = None;
        self.certified = [None; 2];
        self.random = Random::new(0);
        self.ticks = 0;
    }

    /// The free poses that are remembered, four at most.
    pub fn poses(&self) -> impl Iterator<Item = &Isometry3<f64>> {
        self.known.iter().map(|known| &known.pose)
    }

    /// Takes over the pose of an answer from elsewhere, for whatever pose of the query it was found. It counts from the next update, if it is
    /// better there or far from what is known. Its freedom is tested here (one query); false if it is not free.
    pub fn merge(&mut self, answer: &MeshDepth) -> bool {
        let pose = normalised(&answer.pose);
        let free = answer.upper.is_finite() && !self.solver.pair.collides(&pose);
        if free {
            let Some((start, _)) = self.last else {
                self.known.truncate(POSES - 1);
                self.known.push(Known { pose, trust: None });
                return true;
            };
            let (disp, size) = (self.solver.a.disp(), self.solver.a.mesh().diagonal());
            remember(&mut self.known, Known { pose, trust: None }, disp, &start, SAME * size);
        }
        free
    }

    /// The depth of A at a pose, by a metric of A. `late` is asked before every query (the escape from B's box counts as one);
    /// once it says true, no other query begins. The bracket
    /// is true however little was allowed: its pose was tested free, or `upper` is infinite ([`Outcome::Stuck`]).
    ///
    /// When the bodies are apart the answer is [`Outcome::Separated`], with the distance if the budget has a query left for it. The outcome is
    /// [`Outcome::Budget`] or [`Outcome::Interrupted`] when the budget or the time ended the tick, [`Outcome::Invalid`] for a pose or a budget that is no proper
    /// number; the tracker goes on from what it knew.
    pub fn update(
        &mut self,
        pose: &Isometry3<f64>,
        metric: &dyn Metric,
        budget: &Budget,
        late: Option<&dyn Fn() -> bool>,
    ) -> MeshDepth {
        let DepthTracker { solver, known, last, certified, random, ticks } = self;
        let a = solver.a;
        let options = DepthOptions {
            max_queries: budget.max_queries,
            relative: budget.relative,
            effort: budget.certificate.unwrap_or_default(),
            ..DepthOptions::default()
        };
        let mut watch = |_: &Progress| !late.is_some_and(|late| late());
        let mut search = Search::new(solver, pose, metric, &options, Some(&mut watch));
        if !search.is_valid() {
            return search.answer(Outcome::Invalid);
        }
        let pose = &{ search.start };
        let same = SAME * search.size;
        if !search.pair.collides(pose) {
            remember(known, Known { pose: *pose, trust: None }, metric, pose, same);
            *last = Some((*pose, *pose));
            let distance = search.goes_on().then(|| search.pair.distance(pose));
            search.upper = 0.0;
            return MeshDepth { distance, ..search.answer(Outcome::Separated) };
        }
        let slot = match metric.certificate() {
            Certificate::None => None,
            Certificate::Disp => Some(0),
            Certificate::SqrtSigma => Some(1),
        };
        let bound = slot.and_then(|slot| certified[slot]);
        search.lower = bound.map_or(0.0, |bound| carried(&bound, a, pose));
        known.iter().for_each(|known| search.take(&known.pose));

        let motion = last.as_ref().map_or(f64::INFINITY, |(start, _)| metric.distance(start, pose));
        if let Some((start, answer)) = last
            && start != answer
            && search.upper > metric.distance(start, answer)
            && search.goes_on()
        {
            let mut moved = pose * start.inverse() * *answer;
            moved.rotation.renormalize();
            if !search.pair.collides(&moved) {
                search.take(&moved);
                remember(known, Known { pose: moved, trust: None }, metric, pose, 0.0);
            }
        }
        // A pose that is known, a cold answer's perhaps, may be all that is needed; nothing else tells.
        if let (Some(slot), Some(_), None) = (slot, budget.certificate, bound)
            && search.upper.is_finite()
            && !search.is_interrupted()
        {
            certified[slot] = certify(&mut search);
        }
        if known.is_empty() && !search.is_interrupted() && rays::escape(&mut search).is_some() {
            known.push(Known { pose: search.pose, trust: None });
        }
        if motion > JUMP * search.size
            && search.goes_on()
            && let Some(pushed) = pushout::push_out(&mut search, WORK)
        {
            search.take(&pushed);
            remember(known, Known { pose: pushed, trust: None }, metric, pose, 0.0);
        }

        refine(&mut search, known, 0, motion, STEPS);
        for _ in 0..budget.probes {
            if !search.upper.is_finite() || !search.goes_on() {
                break;
            }
            let probe = probe(&search, random);
            if search.distance(&probe) < search.upper && !search.pair.collides(&probe) {
                search.take(&probe);
                remember(known, Known { pose: probe, trust: None }, metric, pose, 0.0);
                refine(&mut search, known, 0, motion, STEPS_BESIDE);
            }
        }
        *ticks += 1;
        if ticks.is_multiple_of(LOOK) {
            if let Some(pushed) = pushout::push_out(&mut search, LOOK_WORK) {
                search.take(&pushed);
                remember(known, Known { pose: pushed, trust: None }, metric, pose, 0.0);
            }
        } else if known.len() > 1 {
            let beside = 1 + random.below(known.len() - 1);
            refine(&mut search, known, beside, motion, STEPS_BESIDE);
        }

        if let (Some(slot), Some(_)) = (slot, budget.certificate) {
            let is_stale = |bound: Certified| {
                let lost = bound.lower - search.lower.min(bound.lower);
                lost.max(metric.distance(&bound.at, pose)) > LOST * search.upper
            };
            if certified[slot].is_none_or(is_stale) && !search.is_interrupted() {
                certified[slot] = certify(&mut search);
            }
        }
        *last = Some((*pose, search.pose));
        if search.upper == f64::INFINITY {
            return search.answer(Outcome::Stuck);
        }
        search.answer(search.outcome())
    }
}

/// A new lower bound.
fn certify(search: &mut Search) -> Option<Certified> {
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
fn refine(search: &mut Search, known: &mut Vec<Known>, rank: usize, motion: f64, steps: usize) {
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
fn approach(search: &mut Search, free: &Isometry3<f64>) -> Isometry3<f64> {
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
fn probe(search: &Search, random: &mut Random) -> Isometry3<f64> {
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
