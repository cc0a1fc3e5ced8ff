//! Many sets, one workspace: what a planner asks.
//!
//! A solver keeps nothing between queries, so a batch is a loop. What it adds is to stop early: to find the best of many grasps, the depth of most
//! need not be known. As soon as one is certainly no better than the best so far, it is done, and that costs a fraction of a full answer.

use crate::qset::UnitSet;
use crate::query::Options;
use crate::query::answer::{Answer, Outcome};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::Support;

/// The deepest of many sets.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Best<T, const N: usize> {
    /// Its number in the batch, from 0.
    pub index: usize,
    /// Its answer, to the tolerance of the options.
    pub answer: Answer<T, N>,
    /// No set of the batch has a larger d: the largest upper bound of all. Above `answer.upper` where the tolerance, or what ended a query, does
    /// not tell which of two is better.
    pub ceiling: T,
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// d_Q of one set after another: `each` gets the set's number, from 0, and its answer, and ends the batch by `true`.
    ///
    /// ```
    /// use qdist::{Options, Workspace, qset::Ball, support::Sphere, Vector};
    /// let mut memory = Workspace::<f64, 3, 16, 32>::new();
    /// let spheres = [0.5, 1.5].map(|r| Sphere::new(r).unwrap());
    /// let mut sum = 0.0;
    /// memory.solver().solve_each(spheres, &Ball::unit(), &Options::default(), |_, answer| {
    ///     sum += answer.lower;
    ///     false
    /// });
    /// assert!((sum - 2.0).abs() < 1e-9);
    /// ```
    pub fn solve_each<S: Support<T, N>>(
        &mut self,
        sets: impl IntoIterator<Item = S>,
        q: &dyn UnitSet<T, N>,
        options: &Options<'_, T, N>,
        mut each: impl FnMut(usize, Answer<T, N>) -> bool,
    ) {
        for (index, set) in sets.into_iter().enumerate() {
            if each(index, self.solve(&set, q, options)) {
                return;
            }
        }
    }

    /// The set with the largest lower bound of d_Q; `None` when there are no sets. The first of several that are alike. A set is left as soon as it
    /// is certainly not deeper than the best so far; one that is deeper is asked twice. A threshold in `options` is not used;
    /// once the deadline has passed, each set keeps the bounds that it has.
    ///
    /// ```
    /// use qdist::{Options, Workspace, qset::Ball, support::Sphere};
    /// let mut memory = Workspace::<f64, 3, 16, 32>::new();
    /// let spheres = [0.5, 1.5, 1.0].map(|r| Sphere::new(r).unwrap());
    /// let best = memory.solver().best_of(spheres, &Ball::unit(), &Options::default()).unwrap();
    /// assert_eq!((best.index, best.ceiling), (1, best.answer.upper));
    /// ```
    pub fn best_of<S: Support<T, N>>(
        &mut self,
        sets: impl IntoIterator<Item = S>,
        q: &dyn UnitSet<T, N>,
        options: &Options<'_, T, N>,
    ) -> Option<Best<T, N>> {
        let full = Options { threshold: None, ..*options };
        let mut best: Option<Best<T, N>> = None;
        for (index, set) in sets.into_iter().enumerate() {
            let Some(so_far) = &mut best else {
                let answer = self.solve(&set, q, &full);
                best = Some(Best { index, ceiling: answer.upper, answer });
                continue;
            };
            let threshold = so_far.answer.lower;
            let mut answer = self.solve(&set, q, &Options { threshold: Some(threshold), ..full });
            if answer.outcome == Outcome::Above {
                answer = self.solve(&set, q, &Options { guess: Some(answer.direction), ..full });
            }
            so_far.ceiling = so_far.ceiling.at_least(answer.upper);
            if answer.lower > threshold {
                best = Some(Best { index, ceiling: so_far.ceiling, answer });
            }
        }
        best
    }
}
