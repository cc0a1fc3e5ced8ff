//! How a query becomes an [`Answer`].

use super::Query;
use crate::bounds::Bracket;
use crate::math::Vector;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::query::answer::{Answer, Outcome, Stop};
use crate::scalar::Real;
use crate::support::Failure;
use crate::support::failure::NOT_FINITE;

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// Checks the direction that is about to be reported without shortcuts. False when that raises the upper bound;
    /// shortcuts are then over for this query.
    pub fn verify(&mut self) -> Result<bool, Failure> {
        if !self.takes_shortcuts() || !(self.best.height < T::HUGE) {
            return Ok(true);
        }
        self.exhaustive = true;
        let direction = self.best.direction;
        let (point, height) = self.ask_without_shortcuts(&direction)?;
        if height <= self.best.height {
            return Ok(true);
        }
        // The shortcut was wrong: what it said is forgotten.
        (self.best.height, self.best.ratio, self.best.apart) = (T::HUGE, T::HUGE, false);
        (self.rivals.met, self.spent) = (None, false);
        self.note(&direction, height, &point, T::zero())?;
        Ok(false)
    }

    /// May a support call still be answered by a shortcut?
    pub fn takes_shortcuts(&self) -> bool {
        !self.exhaustive && self.a.has_shortcuts()
    }

    fn ask_without_shortcuts(&mut self, direction: &Vector<T, N>) -> Result<(Vector<T, N>, T), Failure> {
        self.count_calls(1);
        let point = self.a.exhaustive(direction)?.0 * self.scale;
        self.see(&point)?;
        Ok((point, direction.dot(&point)))
    }

    /// The rival too is reported only if it ties without shortcuts.
    fn verify_rival(&mut self) -> Result<(), Failure> {
        if let Some(direction) = self.rival()
            && self.a.has_shortcuts()
        {
            let (_, height) = self.ask_without_shortcuts(&direction)?;
            let ratio = self.quotient(&direction, height)?;
            self.rivals.met = self.rivals.met.filter(|_| self.ties(ratio));
        }
        Ok(())
    }

    /// h_A / h_Q of a direction whose height is known; the largest number where Q has no extent that way.
    fn quotient(&self, direction: &Vector<T, N>, height: T) -> Result<T, Failure> {
        if self.best.apart {
            return Ok(height);
        }
        let unit = self.value_of_q(direction)?;
        Ok(if unit > self.unit_error { (height + self.bounds.radius) / unit } else { T::HUGE })
    }

    /// The stop after best direction and rival have been asked for without shortcuts.
    #[inline]
    fn verified(&mut self, stop: Stop) -> Stop {
        let stop = match self.verify() {
            Ok(_) => stop,
            Err(Failure(code)) => {
                (self.best.height, self.best.unit) = (T::HUGE, T::one());
                Stop::Failed(code)
            }
        };
        match self.verify_rival() {
            Ok(()) => stop,
            Err(Failure(code)) => Stop::Failed(code),
        }
    }

    /// Whatever ended the run, a threshold that the final bracket decides is decided, and no other.
    #[inline]
    fn decided(&self, stop: Stop, lower: T, upper: T) -> Stop {
        match (stop, self.options.threshold) {
            (Stop::Failed(code), _) => Stop::Failed(code),
            (_, Some(t)) if lower >= t => Stop::Above,
            (_, Some(t)) if upper < t => Stop::Below,
            (Stop::Above | Stop::Below, _) => Stop::Rounding,
            (stop, _) => stop,
        }
    }

    /// The answer for this stop, lower bound and evidence; whoever used memory adds how much.
    pub fn answer(&mut self, stop: Stop, lower: T, mut witness: Simplex<T, N>) -> Answer<T, N> {
        let stop = self.verified(stop);
        // (The points have been checked as they came.)
        let numbers = witness.corners.iter().flat_map(|corner| corner.vertex.witness.iter());
        // 0 x is 0, unless x is infinite or NaN.
        let stop = if numbers.fold(T::zero(), |sum, &x| sum + x * T::zero()) == T::zero() {
            stop
        } else {
            witness = Simplex::new(Vertex::empty());
            Stop::Failed(NOT_FINITE)
        };
        let upper = self.upper();
        let mut lower = self.floored(lower);
        if lower < T::zero() && self.is_never_negative() {
            (lower, witness) = (T::zero(), Simplex::new(Vertex::empty()));
        }
        // Bounds that contradict each other say that A's support function is none (or its error larger than it says).
        let (lower, stop) = match stop {
            Stop::Failed(_) if lower > upper => (-T::HUGE, stop),
            _ if lower > upper => (-T::HUGE, Stop::Rounding),
            _ => (lower, stop),
        };
        let known = lower > -T::HUGE && lower < T::HUGE && upper < T::HUGE;
        let met = known && self.is_met(&Bracket { lower, upper });
        let stop = self.decided(stop, lower, upper);
        // Too thin for its margin is not flat: that takes an upper bound that says so.
        let stop = match stop {
            Stop::Flat if !self.is_at_zero() => Stop::Rounding,
            Stop::Flat if self.is_thin => Stop::Thin,
            _ => stop,
        };
        let at_zero = lower <= T::zero() && (met || self.is_tight(&Bracket { lower, upper }));
        let outcome = stop.outcome(lower, upper, met, at_zero);
        witness.rescale(T::one() / self.scale);
        Answer {
            outcome,
            lower: self.unscaled(lower, -T::one()),
            upper: self.unscaled(upper, T::one()),
            direction: self.best.direction,
            support: (self.best.point + self.best.direction * self.bounds.radius) / self.scale,
            unit: self.best.unit,
            rival: self.rival().filter(|_| !matches!(stop, Stop::Failed(_))),
            witness,
            plan: self.plan,
            dimension: self.dimension,
            iterations: self.limits.iterations,
            support_calls: self.limits.support_calls,
            vertices: 0,
            facets: 0,
            cones: 0,
            splits: 0,
            failure: if let Stop::Failed(code) = stop { Some(Failure(code)) } else { None },
        }
    }

    /// Gives the answer a bracket that is known better, in scaled units, and the direction that proves its upper end, where that is new.
    pub fn refine(&self, answer: &mut Answer<T, N>, bracket: &Bracket<T>, direction: Option<Vector<T, N>>) {
        answer.outcome = match self.options.threshold {
            Some(t) if bracket.lower >= t => Outcome::Above,
            Some(t) if bracket.upper < t => Outcome::Below,
            _ if self.is_met(bracket) => Outcome::Converged,
            _ => answer.outcome,
        };
        answer.lower = self.unscaled(bracket.lower, -T::one());
        answer.upper = self.unscaled(bracket.upper, T::one());
        answer.direction = direction.unwrap_or(answer.direction);
        answer.iterations = self.limits.iterations;
        answer.support_calls = self.limits.support_calls;
    }
}
