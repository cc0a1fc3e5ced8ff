//! The state of one query: the best pose so far, the bounds, and the budget.

use super::random::Random;
use super::{DepthOptions, DepthSolver, MeshDepth, Outcome, Progress, Scratch, Walk, Watch};
use crate::mesh::certificate::Certifier;
use crate::mesh::metric::{Certificate, Metric, Sigma};
use crate::mesh::pose::{is_usable, normalised};
use crate::mesh::{Counters, Model, Pair, Screw};
use nalgebra::{Isometry3, Translation3};

pub(super) struct PoseSearch<'s, 'm, 'w> {
    pub pair: &'s mut Pair<'m>,
    pub scratch: &'s mut Scratch,
    certifier: &'s mut Certifier,
    pub a: &'m Model,
    pub b: &'m Model,
    pub metric: &'s dyn Metric,
    /// A's object norm, if it has one.
    pub sigma: Option<&'m Sigma>,
    pub options: &'s DepthOptions<'s>,
    watch: Option<Watch<'w>>,
    /// The query's pose.
    pub start: Isometry3<f64>,
    pub random: Random,
    /// A's diagonal: the unit of all lengths that are chosen.
    pub size: f64,
    /// The best free pose, and its distance from the start; infinite before there is one.
    pub pose: Isometry3<f64>,
    pub upper: f64,
    pub lower: f64,
    pub walks: u32,
    /// How the walks step.
    pub walk_kind: Walk,
    /// Share of the work that is done.
    pub fraction: f64,
    stop: Option<Outcome>,
    before: Counters,
}

fn total(c: &Counters) -> u64 {
    c.collision + c.contact + c.distance
}

impl<'s, 'm, 'w> PoseSearch<'s, 'm, 'w> {
    pub fn new(
        solver: &'s mut DepthSolver<'m>,
        pose: &Isometry3<f64>,
        metric: &'s dyn Metric,
        options: &'s DepthOptions<'s>,
        watch: Option<Watch<'w>>,
    ) -> Self {
        let before = solver.pair.counters();
        solver.scratch.walked.clear();
        let pose = normalised(pose);
        PoseSearch {
            size: solver.a.mesh().diagonal(),
            pair: &mut solver.pair,
            scratch: &mut solver.scratch,
            certifier: &mut solver.certifier,
            a: solver.a,
            b: solver.b,
            metric,
            sigma: solver.a.sigma(),
            options,
            watch,
            start: pose,
            random: Random::new(options.seed),
            pose,
            upper: f64::INFINITY,
            lower: 0.0,
            walks: 0,
            walk_kind: options.walk,
            fraction: 0.0,
            stop: None,
            before,
        }
    }

    /// Whether the query's pose and options are proper numbers.
    pub fn is_valid(&self) -> bool {
        let here = self.metric.distance(&self.start, &self.start);
        self.options.relative >= 0.0 && here.is_finite() && is_usable(&self.start)
    }

    /// How the search ended.
    pub fn outcome(&self) -> Outcome {
        match self.stop {
            // The last queries, or a certificate after them, may have closed the bracket.
            Some(Outcome::Budget) if self.is_closed() => Outcome::Converged,
            Some(outcome) => outcome,
            None if self.upper == f64::INFINITY => Outcome::Stuck,
            None if self.is_closed() => Outcome::Converged,
            None => Outcome::Bounded,
        }
    }

    pub fn is_closed(&self) -> bool {
        self.upper.is_finite() && self.upper - self.lower <= self.options.relative * self.upper
    }

    pub fn answer(&self, outcome: Outcome) -> MeshDepth {
        let (now, before) = (self.pair.counters(), self.before);
        MeshDepth {
            outcome,
            lower: self.lower.min(self.upper),
            upper: self.upper,
            pose: self.pose,
            distance: None,
            solid: self.pair.has_inside(),
            counters: Counters {
                collision: now.collision - before.collision,
                contact: now.contact - before.contact,
                distance: now.distance - before.distance,
            },
            walks: self.walks,
        }
    }

    /// Queries so far.
    fn queries(&self) -> u64 {
        total(&self.pair.counters()) - total(&self.before)
    }

    /// Whether the caller has said stop. Asks, until it was said.
    pub fn is_interrupted(&mut self) -> bool {
        let queries = self.queries();
        let progress =
            Progress { lower: self.lower, upper: self.upper, pose: &self.pose, fraction: self.fraction, queries };
        if self.stop != Some(Outcome::Interrupted) && self.watch.as_mut().is_some_and(|watch| watch(&progress)) {
            self.stop = Some(Outcome::Interrupted);
        }
        self.stop == Some(Outcome::Interrupted)
    }

    /// Whether to go on. Asks the caller.
    pub fn goes_on(&mut self) -> bool {
        if self.stop.is_some() || self.is_interrupted() {
            return false;
        }
        if self.queries() >= self.options.max_queries {
            self.stop = Some(Outcome::Budget);
        } else if self.is_closed() {
            self.stop = Some(Outcome::Converged);
        }
        self.stop.is_none()
    }

    pub fn distance(&self, pose: &Isometry3<f64>) -> f64 {
        self.metric.distance(&self.start, pose)
    }

    /// Takes a pose that is known to be free.
    pub fn take(&mut self, pose: &Isometry3<f64>) {
        let value = self.distance(pose);
        if value < self.upper {
            self.upper = value;
            self.pose = *pose;
        }
    }

    /// The lower bound, from the pieces of both bodies.
    pub fn certify(&mut self) -> f64 {
        let (Some(a), Some(b)) = (self.a.pieces(), self.b.pieces()) else { return 0.0 };
        match self.metric.certificate() {
            Certificate::None => 0.0,
            Certificate::Disp => self.certifier.disp(a, b, &self.start, self.options.effort),
            Certificate::SqrtSigma => self.certifier.sqrt_sigma(a, b, &self.start, self.options.effort),
        }
    }

    /// The translation that parts what proves the lower bound: of two convex bodies the best pose there is. A little farther, since
    /// what just touches collides.
    pub fn leave_by_the_proof(&mut self) {
        let Some(out) = self.certifier.way_out.take() else { return };
        let convex = |model: &Model| model.pieces().is_some_and(|pieces| pieces.pieces().len() == 1);
        let tries = if convex(self.a) && convex(self.b) { 4 } else { 1 };
        for clearance in [1e-12, 1e-11, 1e-10, 1e-8].into_iter().take(tries) {
            let further = out + out.normalize() * (clearance * self.size);
            let pose = Translation3::from(further) * self.start;
            if !self.pair.collides(&pose) {
                return self.take(&pose);
            }
        }
    }

    /// The last free pose on the way from a free one to the start, to a length.
    pub fn slide(&mut self, free: &Isometry3<f64>, tolerance: f64) -> Isometry3<f64> {
        let screw = Screw::new(&self.start, free);
        let s = self.pair.bisect(&screw, 1.0, 0.0, tolerance);
        screw.at(s)
    }
}
