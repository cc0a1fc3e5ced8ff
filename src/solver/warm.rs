//! Warm start: what a control loop remembers from one tick to the next.
//!
//! From tick to tick the set A moves a little. If it moves by no more than δ (Hausdorff distance: |h_A'(u) - h_A(u)| <= δ for all unit u), then
//!
//! ```text
//! d_Q(A') >= d_Q(A) - δ / ρ        (Q contains a ball of radius ρ around the origin)
//! ```
//!
//! since h_A' / h_Q >= h_A / h_Q - δ / h_Q. And any direction bounds d_Q(A') from above, so the minimisers of the last ticks (several, as equal ones
//! swap places) give the other end for one support call each. That is a certified bracket at once; if it is not narrow enough,
//! the polar iteration follows the minimisers to where they have gone, and the solver does the rest from there, as far as the budget
//! of iterations allows. Its bracket is never worse than the one at once. So the first tick should converge, without a limit and to a tighter
//! tolerance than the others: ticks are answered at once while what the moves have cost fits between the two.

use crate::bounds::Bracket;
use crate::math::Vector;
use crate::plan::shoot::descend;
use crate::polytope::simplex::Simplex;
use crate::qset::UnitSet;
use crate::query::answer::{Answer, Plan, Stop};
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Failure, Support};

/// Directions remembered.
pub const REMEMBERED: usize = 4;

/// Directions nearer to each other than this cosine (18 degrees) are remembered once.
const DISTINCT: f64 = 0.95;

/// The state of a warm start: plain data, to be kept by the caller between the ticks of one loop over one unit set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracker<T, const N: usize> {
    /// Minimisers of the last ticks, unit vectors, the latest first.
    pub directions: [Option<Vector<T, N>>; REMEMBERED],
    /// A lower bound of d for the set of the last tick, where one is known.
    pub lower: Option<T>,
}

impl<T: Real, const N: usize> Default for Tracker<T, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real, const N: usize> Tracker<T, N> {
    /// Nothing is known.
    #[must_use]
    pub fn new() -> Self {
        Tracker { directions: [None; REMEMBERED], lower: None }
    }

    /// Takes note of an answer: its direction, its rival and its lower bound.
    pub fn remember(&mut self, answer: &Answer<T, N>) {
        self.lower = Some(answer.lower).filter(|&lower| lower > -T::HUGE && lower < T::HUGE);
        let old = core::mem::replace(&mut self.directions, [None; REMEMBERED]);
        let mut count = 0;
        for direction in core::iter::once(answer.direction).chain(answer.rival).chain(old.into_iter().flatten()) {
            let known = direction.iter().any(|&x| x != T::zero());
            let distinct = self.directions.iter().flatten().all(|u| u.dot(&direction) < T::of(DISTINCT));
            if known
                && distinct
                && let Some(slot) = self.directions.get_mut(count)
            {
                *slot = Some(direction);
                count += 1;
            }
        }
    }

    /// The lower bound after the set has moved by at most `moved` (a Hausdorff distance, >= 0, in A's unit); `None` where nothing is known, or where Q
    /// has no known inner radius.
    #[must_use]
    pub fn lower_after(&self, moved: T, q: &dyn UnitSet<T, N>) -> Option<T> {
        let inner = Some(q.inner_radius()).filter(|inner| inner.finite()).unwrap_or(T::zero());
        let before = self.lower.filter(|&lower| lower > -T::HUGE)?;
        if !(moved >= T::zero()) || !(inner > T::zero() || moved == T::zero()) {
            return None;
        }
        // Below 0, d is minus a distance, in units of the radius for a ball: the less favourable of the two is taken.
        let steps = |length: T| if length > T::zero() { (length / inner).at_least(length) } else { T::zero() };
        let lower = if before < T::zero() {
            before - steps(moved)
        } else {
            let left = if moved > T::zero() { before - moved / inner } else { before };
            if left < T::zero() { left.at_most(left * inner) } else { left }
        };
        let positive = before.at_least(T::zero());
        let slack = (positive + moved + before.abs() + lower.abs()) * (T::count(8) * T::ROUNDOFF);
        let slack = if inner > T::zero() && inner < T::one() { slack / inner } else { slack };
        Some(lower - slack).filter(|&lower| lower > -T::HUGE)
    }
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// d_Q(A) for the next tick of a loop: A is the set of the tick before, moved by at most `moved` (Hausdorff distance >= 0, in A's unit; `None`:
    /// anything), and `tracker` what was remembered of it. Updates the tracker.
    ///
    /// When the moved bracket already meets the options, it is the answer ([`Plan::Warm`]) for a support call per
    /// remembered direction. Otherwise the solver goes on for `options.max_iterations`, knowing it.
    pub fn solve_warm(
        &mut self,
        tracker: &mut Tracker<T, N>,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        moved: Option<T>,
        options: &Options<'_, T, N>,
    ) -> Answer<T, N> {
        let lower = moved.and_then(|moved| tracker.lower_after(moved, q));
        let answer = self.solve_unless(a, q, options, |query| at_once(query, tracker, lower));
        tracker.remember(&answer);
        answer
    }
}

/// The answer that needs no memory, if that is good enough.
fn at_once<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    tracker: &Tracker<T, N>,
    lower: Option<T>,
) -> Result<Option<Answer<T, N>>, Failure> {
    if let Some(lower) = lower {
        query.know(lower);
    }
    for direction in tracker.directions.iter().flatten() {
        query.support(direction)?;
    }
    if query.upper() >= T::HUGE || !lower.is_some_and(|lower| lower > T::zero()) {
        return Ok(None);
    }
    let verdict = |query: &Query<'_, T, N>| query.verdict(&Bracket { lower: -T::HUGE, upper: query.upper() });
    let mut stop = verdict(query);
    if stop.is_none() && query.upper() > T::zero() {
        // The minimiser has moved too.
        let direction = query.best.direction;
        stop = descend(query, &direction)?.filter(|&stop| stop != Stop::Outside).or_else(|| verdict(query));
    }
    Ok(stop.map(|stop| {
        query.plan = Plan::Warm;
        let touched = query.supported();
        query.answer(stop, -T::HUGE, Simplex::new(touched))
    }))
}
