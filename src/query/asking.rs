//! A is asked: each support point may make the best upper bound better, and shows how far out A reaches.

use super::{Query, Work};
use crate::math::{Vector, finite};
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;
use crate::support::Failure;
use crate::support::failure::{NOT_FINITE, TOO_LARGE};

/// The best upper bound, and what was seen on the way to it.
pub(crate) struct Upper<T, const N: usize> {
    /// Unit direction.
    pub direction: Vector<T, N>,
    /// Support value along it, value of Q, and their quotient without margins.
    pub(super) height: T,
    pub(super) unit: T,
    pub(super) ratio: T,
    /// The support point of the core along it.
    pub(super) point: Vector<T, N>,
    /// For a general Q: the origin is certainly outside of A, and `height` is minus a distance.
    pub(super) apart: bool,
    /// The largest value of a general Q that was seen.
    pub(super) widest: T,
}

impl<T: Real, const N: usize> Upper<T, N> {
    /// Nothing has been asked.
    pub(super) fn none() -> Self {
        Upper {
            direction: Vector::zeros(),
            height: T::HUGE,
            unit: T::one(),
            ratio: T::HUGE,
            point: Vector::zeros(),
            apart: false,
            widest: T::zero(),
        }
    }
}

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// Asks A along a unit direction, and keeps the upper bound if it is the best.
    pub fn support(&mut self, direction: &Vector<T, N>) -> Result<(Vertex<T, N>, T), Failure> {
        self.support_beyond(direction, T::zero())
    }

    /// The same where h_Q is at least `floor`: if that is above 0 and makes the direction no better than the best one, Q is not asked; nor for the
    /// largest number.
    pub fn support_beyond(&mut self, direction: &Vector<T, N>, floor: T) -> Result<(Vertex<T, N>, T), Failure> {
        self.work.add(Work::<N>::STEP);
        self.limits.support_calls = self.limits.support_calls.saturating_add(1);
        let (point, witness) =
            if self.exhaustive { self.a.exhaustive(direction)? } else { self.a.support_with_witness(direction)? };
        let (point, witness) =
            if self.scale == T::one() { (point, witness) } else { (point * self.scale, witness * self.scale) };
        self.see(&point)?;
        let height = direction.dot(&point);
        self.note(direction, height, &point, floor)?;
        Ok((Vertex { point, witness }, height))
    }

    /// The same, but the best direction stays what it is.
    pub fn ask(&mut self, direction: &Vector<T, N>) -> Result<Vertex<T, N>, Failure> {
        let best = (self.best.direction, self.best.point, self.best.height, self.best.unit, self.best.ratio);
        let found = self.support(direction);
        (self.best.direction, self.best.point, self.best.height, self.best.unit, self.best.ratio) = best;
        found.map(|(vertex, _)| vertex)
    }

    /// Refuses a point that is not finite, and lets the margin grow with its norm.
    #[inline(always)]
    pub(super) fn see(&mut self, point: &Vector<T, N>) -> Result<(), Failure> {
        let squared = point.dot(point);
        if !squared.finite() {
            return Err(Failure(if finite(point) { TOO_LARGE } else { NOT_FINITE }));
        }
        if squared > self.reach * self.reach {
            self.reach = squared.root();
        }
        Ok(())
    }

    pub(super) fn note(
        &mut self,
        direction: &Vector<T, N>,
        height: T,
        point: &Vector<T, N>,
        floor: T,
    ) -> Result<(), Failure> {
        let top = height + self.bounds.radius;
        let (unit, ratio) = if let Some(radius) = self.ball {
            (radius, top * self.per_ball)
        } else if self.best.apart || self.is_outside(direction, height) {
            // Outside, Q has no say: the distance counts.
            if !self.best.apart {
                (self.best.apart, self.best.ratio) = (true, T::HUGE);
            }
            (T::one(), height)
        } else if floor >= T::HUGE || floor > T::zero() && !(top < self.best.ratio * floor) {
            return Ok(());
        } else {
            self.work.add(self.work.unit());
            let unit = self.value_of_q(direction)?;
            self.best.widest = self.best.widest.at_least(unit);
            if unit <= self.unit_error {
                return Ok(()); // Q has no extent that way: it bounds nothing.
            }
            (unit, top / unit)
        };
        if ratio < self.best.ratio {
            if self.rivals.sought {
                self.rivals.bar = self.tolerance(T::one()).above(ratio);
                let (old, old_ratio) = (self.best.direction, self.best.ratio);
                self.meet(&old, old_ratio, direction);
            }
            (self.best.direction, self.best.point) = (*direction, *point);
            (self.best.height, self.best.unit, self.best.ratio) = (height, unit, ratio);
        } else if self.rivals.sought {
            let best = self.best.direction;
            self.meet(direction, ratio, &best);
        }
        Ok(())
    }

    /// Is the origin certainly outside the core, by this support value?
    #[inline]
    pub fn is_outside(&self, direction: &Vector<T, N>, height: T) -> bool {
        height < T::zero() && height + self.margin_along(direction) < T::zero() && !self.contains_origin()
    }

    /// The point of A's core that is known along the best direction.
    pub fn supported(&self) -> Vertex<T, N> {
        Vertex { point: self.best.point, witness: self.best.point }
    }

    /// Where dQ touches the plane that proves the upper bound (less the ball term): there A's core ends, if the bracket is narrow. `None`
    /// where Q does not tell.
    pub fn foot(&self) -> Option<Vector<T, N>> {
        if self.best.ratio >= T::HUGE {
            None // nothing bounds d from above yet
        } else if self.ball.is_some() {
            Some(self.best.direction * self.best.height)
        } else {
            Some(self.mapping(&self.best.direction)? * self.best.ratio)
        }
    }
}
