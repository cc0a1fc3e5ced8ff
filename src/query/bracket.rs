//! What the query knows of d: bounds with their rounding, and when they are enough.

use super::Query;
use crate::bounds::{Axes, Bracket, Tolerance};
use crate::math::{Vector, norm};
use crate::polytope::Facet;
use crate::polytope::simplex::{Corner, Edges, Simplex};
use crate::query::answer::Stop;
use crate::scalar::Real;

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// The upper bound: proved by `direction`.
    pub fn upper(&self) -> T {
        if self.best.height >= T::HUGE {
            return T::HUGE; // nothing has been asked yet
        }
        let margin = self.margin_along(&self.best.direction);
        match self.ball {
            Some(_) => self.bounds.upper_ball(self.best.height, margin, self.per_ball),
            None if self.best.apart => {
                let upper = self.bounds.upper(self.best.height, margin, T::one(), T::zero());
                // (Points that were seen since may have shown that A knows its points too badly to be called apart.)
                if upper >= T::zero() && self.bounds.unknown_extent { T::HUGE } else { upper }
            }
            None => self.bounds.upper(self.best.height, margin, self.best.unit, self.unit_error),
        }
    }

    /// Lower bound from a simplex in A whose point has this distance from the origin: d >= -distance, whether or not the origin is inside.
    pub fn lower_from_simplex(&self, simplex: &Simplex<T, N>, distance: T) -> T {
        let lower = self.bounds.lower_ball(-distance, self.margin(), self.per_ball);
        let Some(axes) = &self.axes else { return lower };
        lower.at_least(self.lower_by_axes(axes, simplex, distance))
    }

    /// The same with margins by direction.
    #[cold]
    fn lower_by_axes(&self, axes: &Axes<T, N>, simplex: &Simplex<T, N>, distance: T) -> T {
        // Nearer than that, the point has no direction.
        let line =
            if distance > self.margin() { simplex.towards_origin(distance, self.reach) } else { self.best.direction };
        let crossing = self.highest_crossing(simplex, &line);
        let crossing =
            crossing.map_or(-T::HUGE, |height| self.bounds.lower_ball(-height, axes.margin(&line), self.per_ball));
        // An error δ of x changes its norm by at most δ.x / |x| + |δ|^2 / (2 |x|).
        let (point, whole) = (simplex.point(), self.margin());
        if !(distance > whole) {
            return crossing;
        }
        let margin = axes.margin(&(point / distance)) + whole * (whole / (distance + distance)) * T::of(1.01);
        crossing.at_least(self.bounds.lower_ball(-distance, margin, self.per_ball))
    }

    /// For a simplex of N corners that certainly crosses the line through the origin in this unit direction: the crossing is a point of A,
    /// no farther from the origin than the corner that is highest along the line, up or down.
    ///
    /// Seen along the line the origin is w_i h_i inside of the side opposite corner i, with its weight and its height over that side, up to what the
    /// weights' point is off. Where that is more than the corners are off, no side can have crossed the origin.
    fn highest_crossing(&self, simplex: &Simplex<T, N>, line: &Vector<T, N>) -> Option<T> {
        let across = |v: &Vector<T, N>| v - line * line.dot(v);
        let seen = |corner: &Corner<T, N>| across(&corner.vertex.point);
        let safe = self.margin() * T::count(3) + norm(&across(&simplex.point()));
        // A corner that only rounding gives a weight is none.
        let corners = || simplex.corners.iter().filter(|c| c.weight > T::count(64) * T::ROUNDOFF).enumerate();
        let mut highest = T::zero();
        for (i, corner) in corners() {
            let mut others = corners().filter(|&(j, _)| j != i).map(|(_, other)| seen(other));
            let base = others.next()?;
            let mut side = Edges::<T, N>::new();
            for other in others {
                side.push(&(other - base), T::zero());
            }
            let over = norm(&side.complement(&side.complement(&(seen(corner) - base))));
            if !(corner.weight * over > safe) {
                return None;
            }
            highest = highest.at_least(line.dot(&corner.vertex.point).abs());
        }
        (corners().count() == N).then_some(highest)
    }

    /// Lower bound from the lowest offset of a closed surface around the origin, for a ball; `None` when the origin is
    /// not certainly inside (module `bounds`). Heights are known up to `margin`.
    pub fn lower_from_offset(&self, offset: T, margin: T) -> Option<T> {
        (offset > margin).then(|| self.bounds.lower_ball(offset, margin, self.per_ball))
    }

    /// The same from the offset of one facet, whose height is known up to `margin`, for a ball.
    pub fn lower_of_plane(&self, offset: T, margin: T) -> T {
        self.bounds.lower_ball(offset, margin, self.per_ball)
    }

    /// The same for any Q, with margins by direction: the least of (e - m(n)) / h over all facets.
    pub fn lower_by_direction<'f>(&self, facets: impl Iterator<Item = &'f Facet<T, N>>) -> Option<T>
    where
        T: 'f,
    {
        let mut least = T::HUGE;
        for facet in facets {
            let margin = self.margin_along(&facet.normal);
            if !(facet.offset > margin) {
                return None;
            }
            least = least.at_most(match self.ball {
                Some(_) => self.bounds.lower_ball(facet.offset, margin, self.per_ball),
                None => (facet.key - facet.key * (margin / facet.offset)) * (T::one() - T::count(16) * T::ROUNDOFF),
            });
        }
        (least < T::HUGE).then_some(least)
    }

    /// The same for any Q, from (offset, key) of all facets of a surface whose heights are known up to `margin`.
    pub fn lower_from_facets(&self, facets: impl Iterator<Item = (T, T)>, margin: T) -> Option<T> {
        let (mut inradius, mut least) = (T::HUGE, T::HUGE);
        for (offset, key) in facets {
            // (e - m) / h, from e and e / h.
            inradius = inradius.at_most(offset);
            least = least.at_most(key - key * (margin / offset));
        }
        (inradius > margin).then(|| least * (T::one() - T::count(16) * T::ROUNDOFF))
    }

    /// A lower end that would end the query now, `reserve` included; at least a share `gap` below the upper end.
    pub fn level(&self, gap: T, reserve: T) -> T {
        let met = self.tolerance(Self::sharpness() * T::of(0.99)).below(self.best.ratio) + reserve;
        let enough = self.options.threshold.map_or(met, |threshold| met.at_most(threshold + reserve));
        enough.at_most(self.best.ratio - self.best.ratio * gap)
    }

    /// So many margins, as a difference of d. (A Q of no known inner radius: as wide as it is along the best direction.)
    pub fn reserve(&self, margins: usize) -> T {
        let inner = self.inner_radius();
        let margin = T::count(margins) * self.margin();
        margin / if inner > T::zero() { inner } else { self.best.unit.at_least(T::TINY) }
    }

    /// Is d certainly below the threshold?
    pub fn is_below(&self) -> bool {
        self.options.threshold.is_some_and(|threshold| self.upper() < threshold)
    }

    /// The better of a lower bound and the one that was known before, unless an upper bound has disproved that.
    pub fn floored(&self, lower: T) -> T {
        let holds =
            self.floor.lower > T::zero() && self.floor.lower <= self.best.ratio && self.still_holds(self.floor.reach);
        if holds { lower.at_least(self.floor.lower) } else { lower }
    }

    /// Is d >= 0, whatever A's heights? So it is for a set that contains the origin, unless an upper bound has disproved that.
    pub(super) fn is_never_negative(&self) -> bool {
        self.contains_origin() && self.upper() >= T::zero()
    }

    /// Is d at least the threshold for that reason?
    pub fn is_above_anyway(&self) -> bool {
        self.options.threshold.is_some_and(|threshold| threshold <= T::zero()) && self.is_never_negative()
    }

    /// A quick no to [`verdict`](Query::verdict): the gap between lowest key and best quotient is too wide even
    /// without margins.
    #[inline]
    pub fn is_gap_wide(&self, key: T) -> bool {
        let gap = Bracket { lower: self.floored(key), upper: self.best.ratio };
        self.options.threshold.is_none() && !self.tolerance(Self::sharpness()).met(&gap)
    }

    /// Does the bracket end the query?
    pub fn verdict(&self, bracket: &Bracket<T>) -> Option<Stop> {
        let bracket = &Bracket { lower: self.floored(bracket.lower), upper: bracket.upper };
        if let Some(threshold) = self.options.threshold {
            if bracket.lower >= threshold {
                return Some(Stop::Above);
            }
            if bracket.upper < threshold {
                return Some(Stop::Below);
            }
        }
        self.tolerance(Self::sharpness()).met(bracket).then_some(Stop::Met)
    }

    /// In space, a bracket of width ε pins the direction of a smooth minimum to about sqrt(ε) only. Running to a quarter of the
    /// tolerance halves that error and costs an iteration at most. In higher dimensions it would multiply the work.
    fn sharpness() -> T {
        if N <= 3 { T::of(0.25) } else { T::one() }
    }

    pub(super) fn tolerance(&self, share: T) -> Tolerance<T> {
        Tolerance { absolute: self.options.absolute * share, relative: self.options.relative * share }
    }

    /// The width that the tolerance allows a bracket at the best upper bound.
    pub fn slack(&self) -> T {
        self.tolerance(T::one()).above(self.best.ratio) - self.best.ratio
    }

    /// Is this bracket as narrow as asked for?
    pub fn is_met(&self, bracket: &Bracket<T>) -> bool {
        self.tolerance(T::one()).met(bracket)
    }

    /// Has a height of A come so near to 0 that rounding is all that is left to say of it?
    pub fn is_at_zero(&self) -> bool {
        self.best.height + self.bounds.radius <= self.margin_along(&self.best.direction) * T::count(64)
    }

    /// Is the lower end at 0 all that is left to find out? So it is as soon as a height of A is within its rounding of 0: no surface proves
    /// more than d >= 0 then. (Not along a direction in which Q has next to no extent, which says nothing of d; and a threshold so small may still be
    /// decided by a lower height.)
    pub fn is_spent(&self) -> bool {
        let nothing =
            self.best.height + self.bounds.radius <= self.margin_along(&self.best.direction) && !self.best.apart;
        self.spent || nothing && self.options.threshold.is_none() && self.is_wide()
    }

    /// Is Q about as wide along the best direction as elsewhere?
    fn is_wide(&self) -> bool {
        self.inner_radius() > T::zero() || self.best.unit * T::count(16) >= self.best.widest
    }

    /// Says so, for other reasons.
    pub fn spend(&mut self) {
        self.spent = true;
    }

    /// Is this bracket about as narrow as rounding allows?
    pub fn is_tight(&self, bracket: &Bracket<T>) -> bool {
        bracket.upper - bracket.lower <= self.margin() * T::count(64) * self.per_ball
    }
}
