//! What comes after what in a query: the lower bound, seeds, walks from them, and the end.

use super::finish::finish;
use super::schedule::Schedule;
use super::search::PoseSearch;
use super::seeds::pushout;
use super::seeds::rays::{self, Seed};
use super::{MeshDepth, Outcome};
use crate::mesh::metric::Certificate;
use crate::mesh::pose::{is_usable, normalised};
use nalgebra::Isometry3;

/// Walks whose ends are nearer to the best pose than this fraction of its value have found it.
const SAME: f64 = 0.05;

impl PoseSearch<'_, '_, '_> {
    pub fn run(mut self) -> MeshDepth {
        if !self.is_valid() {
            return self.answer(Outcome::Invalid);
        }
        if !self.pair.collides(&self.start) {
            self.upper = 0.0;
            let distance = self.pair.distance(&self.start);
            return MeshDepth { distance: Some(distance), ..self.answer(Outcome::Separated) };
        }
        self.lower = self.certify();
        let schedule = Schedule::new(self.options.effort, self.a, self.b, self.metric.certificate());
        self.leave_by_the_proof();
        let escape = rays::escape(&mut self);
        for pose in self.options.poses {
            self.walk_from(pose, &schedule);
        }
        if let Some(seed) = escape {
            self.begin(&schedule, seed);
        }
        // Dear, and of use where rays have missed a narrow passage.
        if self.options.push_out
            && self.may_be_much_less()
            && self.goes_on()
            && let Some(seed) = pushout::push_out(&mut self, schedule.work)
        {
            self.walk(&seed, schedule.gain, f64::INFINITY);
        }
        for round in 1..schedule.rounds {
            if !self.options.rays
                || self.upper == f64::INFINITY
                || !schedule.patience.goes_on(round, self.lower, self.upper, self.returns())
            {
                break;
            }
            let best = Seed { pose: self.pose, value: self.upper };
            self.explore(&schedule, round, &best);
        }
        finish(&mut self, &schedule);
        self.answer(self.outcome())
    }

    /// Whether the lower bound leaves room for a far better pose. The object norm's is wider in any case.
    fn may_be_much_less(&self) -> bool {
        let near = match self.metric.certificate() {
            Certificate::Disp => 1.15,
            Certificate::SqrtSigma | Certificate::None => 1.3,
        };
        self.upper > near * self.lower
    }

    /// The first round. Where translations and the lower bound say nearly the same, no ray that turns is cast.
    fn begin(&mut self, schedule: &Schedule, escape: Seed) {
        let Some(near) = schedule.translations_suffice.filter(|_| self.options.rays && self.lower > 0.0) else {
            return self.explore(schedule, 0, &escape);
        };
        let translations = rays::Fan { screws: 0, seeds: 1, ..schedule.rays };
        for seed in rays::cast(self, &translations, 0, &escape) {
            self.walk(&seed.pose, schedule.coarse, f64::INFINITY);
        }
        if self.upper.is_finite() && self.upper > near * self.lower {
            let best = Seed { pose: self.pose, value: self.upper };
            self.explore(schedule, 0, &best);
        }
    }

    /// Casts rays that end where they are not much worse than a seed that is known, and walks from what they find.
    fn explore(&mut self, schedule: &Schedule, round: usize, known: &Seed) {
        let seeds = if self.options.rays { rays::cast(self, &schedule.rays, round, known) } else { vec![*known] };
        // Where a walk has begun or ended, none begins.
        let walked = self.scratch.walked.iter().flatten().any(|pose| *pose == known.pose);
        let seeds = seeds.iter().filter(|seed| !walked || seed.pose != known.pose);
        for (k, seed) in seeds.enumerate() {
            self.fraction =
                (round as f64 + (k as f64 + 1.0) / (schedule.rays.seeds as f64 + 1.0)) / schedule.rounds as f64;
            self.walk(&seed.pose, schedule.coarse, self.upper * schedule.hope);
            if schedule.patience.is_satisfied(self.lower, self.upper, self.returns()) {
                break;
            }
        }
    }

    /// How many walks have ended at the best pose.
    fn returns(&self) -> usize {
        let is_at_best = |end: &Isometry3<f64>| self.metric.distance(&self.pose, end) < SAME * self.upper;
        self.scratch.walked.iter().filter(|[_, end]| is_at_best(end)).count()
    }

    /// Walks from the caller's pose, or from where pushing out from there leads.
    fn walk_from(&mut self, pose: &Isometry3<f64>, schedule: &Schedule) {
        if !is_usable(pose) || !self.goes_on() {
            return;
        }
        let pose = normalised(pose);
        let seed =
            if self.pair.collides(&pose) { pushout::push_out_from(self, &pose, schedule.work) } else { Some(pose) };
        if let Some(seed) = seed {
            self.walk(&seed, schedule.gain, f64::INFINITY);
        }
    }
}
