//! What A and Q say of themselves, in the query's units.

use super::{Query, Work};
use crate::math::{Vector, finite};
use crate::scalar::Real;
use crate::support::Failure;
use crate::support::failure::NOT_FINITE;

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// h_Q along a direction.
    pub(super) fn value_of_q(&self, direction: &Vector<T, N>) -> Result<T, Failure> {
        match self.ball {
            Some(radius) => Ok(radius),
            None => {
                let value = self.q.value(direction)?;
                if value.finite() && value >= T::zero() { Ok(value) } else { Err(Failure(NOT_FINITE)) }
            }
        }
    }

    /// s_Q(u), if Q tells.
    pub fn mapping(&self, direction: &Vector<T, N>) -> Option<Vector<T, N>> {
        self.q.mapping(direction).filter(|q| finite(q) && q.iter().any(|&x| x != T::zero()))
    }

    /// How far h_Q may be off, as a length.
    pub fn unit_error(&self) -> T {
        self.unit_error
    }

    /// How many rays decide the query, for a polytopal Q; else 0.
    pub fn rays(&self) -> usize {
        self.q.vertex_count()
    }

    pub fn ray(&self, index: usize) -> Vector<T, N> {
        self.q.vertex(index)
    }

    pub fn inner_radius(&self) -> T {
        self.q.inner_radius()
    }

    /// Is the origin certainly in A, whatever its heights?
    pub fn contains_origin(&self) -> bool {
        self.a.contains_origin()
    }

    /// A's size, as far as it is known.
    pub fn size(&self) -> T {
        if self.extent > T::zero() { self.extent * self.scale } else { self.reach }
    }

    /// Does A state its extent?
    pub fn knows_extent(&self) -> bool {
        self.extent > T::zero()
    }

    /// Which changes of sign leave both A and Q as they are: bit s for the coordinates named by the bits of s.
    pub fn mirrors(&self) -> u64 {
        let both = |signs: u8| self.q.mirrored(signs) && self.a.mirrored(signs);
        (1..1 << N).filter(|&signs| both(signs)).fold(0, |bits, signs| bits | 1 << signs)
    }

    /// Does a value of Q cost more than a step of a ray? Then Q is asked only where it may count.
    pub fn spares_unit(&self) -> bool {
        self.work.unit() > Work::<N>::STEP
    }

    /// The key of a facet, eq. 24: no more than its true distance with respect to Q, up to the margin of the bracket.
    pub fn key(&mut self, normal: &Vector<T, N>, offset: T) -> Result<T, Failure> {
        let top = offset + self.bounds.radius;
        let bottom = match self.ball {
            Some(_) => return Ok(top * self.per_ball),
            None => {
                self.work.add(Work::<N>::FACET + self.work.unit());
                self.value_of_q(normal)? + self.unit_error
            }
        };
        Ok(if bottom > T::zero() { top / bottom } else { T::HUGE })
    }
}
