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

use std::fmt;

use super::budget::Budget;
use super::search::PoseSearch;
use super::tick::{Memory, Tick};
use super::{DepthOptions, DepthSolver, MeshDepth, Outcome, Progress};
use crate::mesh::Model;
use crate::mesh::metric::Metric;
use crate::mesh::pose::normalised;
use nalgebra::Isometry3;

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
    memory: Memory,
}

impl fmt::Debug for DepthTracker<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DepthTracker").field("solver", &self.solver).finish_non_exhaustive()
    }
}

impl<'m> DepthTracker<'m> {
    /// A moves, B rests.
    pub fn new(a: &'m Model, b: &'m Model) -> DepthTracker<'m> {
        DepthTracker { solver: DepthSolver::new(a, b), memory: Memory::new() }
    }

    /// The solver, for other queries with the same memory.
    pub fn solver(&mut self) -> &mut DepthSolver<'m> {
        &mut self.solver
    }

    /// Forgets everything: the next update is the first.
    pub fn reset(&mut self) {
        self.memory.clear();
    }

    /// The free poses that are remembered, four at most.
    pub fn poses(&self) -> impl Iterator<Item = &Isometry3<f64>> {
        self.memory.known.iter().map(|known| &known.pose)
    }

    /// Takes over the pose of an answer from elsewhere, for whatever pose of the query it was found. It counts from the next update, if it is
    /// better there or far from what is known. Its freedom is tested here (one query); false if it is not free.
    pub fn merge(&mut self, answer: &MeshDepth) -> bool {
        let pose = normalised(&answer.pose);
        let free = answer.upper.is_finite() && !self.solver.pair.collides(&pose);
        if free {
            self.memory.merge(pose, self.solver.a);
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
        let options = DepthOptions {
            max_queries: budget.max_queries,
            relative: budget.relative,
            effort: budget.certificate.unwrap_or_default(),
            ..DepthOptions::default()
        };
        let mut watch = |_: &Progress| late.is_some_and(|late| late());
        let search = PoseSearch::new(&mut self.solver, pose, metric, &options, Some(&mut watch));
        if !search.is_valid() {
            return search.answer(Outcome::Invalid);
        }
        let mut tick = Tick::new(search, &mut self.memory, budget);
        if tick.is_apart() {
            return tick.apart();
        }
        tick.recall();
        tick.follow_the_last_answer();
        tick.certify_what_is_known();
        tick.find_a_way_out();
        tick.walk_and_probe();
        tick.look_beside();
        tick.renew_the_bound();
        tick.end()
    }
}
