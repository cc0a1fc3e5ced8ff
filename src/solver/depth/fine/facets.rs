//! Expansion, continued with points in two words: lower bounds of facets, and the lowest of them pushed out.

use super::level::Level;
use super::{Fine, Found, STEPS};
use crate::bounds::Bracket;
use crate::math::{Vector, norm};
use crate::polytope::simplex::Edges;
use crate::polytope::{Facet, Index, Insertion};
use crate::scalar::Real;

impl<'f, 'm, 'q, 'p, 'b, 'a, T: Real, const N: usize> Fine<'f, 'm, 'q, 'p, 'b, 'a, T, N> {
    /// For the others.
    #[inline(never)]
    pub(super) fn by_facets(&mut self, found: &mut Found<T, N>) -> Option<()> {
        if !self.polytope.is_sound() {
            return None;
        }
        let (polytope, scale) = (&self.polytope, self.query.scale());
        self.recorder.freeze(|point| {
            let vertex = point * scale;
            polytope.facets().any(|facet| polytope.corners(facet).corners().iter().any(|c| c.vertex.point == vertex))
        });
        let lowest = self.expand(found);
        if let Some(direction) = found.direction {
            // The query's best direction is the best in one word; the witness belongs to the one that is reported.
            let foot = direction * (found.bracket.upper - self.query.bounds.radius);
            let relative = self.query.options.relative;
            self.polytope.find_simplex(Some(foot), &direction, relative, lowest, &mut found.witness);
            found.witness.rescale(T::one() / self.query.scale());
        }
        lowest.map(drop)
    }

    /// Expansion, goes on; the lowest facet at last.
    fn expand(&mut self, found: &mut Found<T, N>) -> Option<Index> {
        let start = self.widest(found.bracket.upper)?;
        let corners = self.corners(&start);
        let level = self.level(&start.normal, &corners, &self.exact(&corners)?)?;
        self.ask_along(&level, found)?;
        for place in 0..self.polytope.places() {
            self.rate(place, &level, &found.bracket)?;
        }
        let mut last = None;
        for _ in 0..STEPS {
            let (index, facet) = self.polytope.lowest_numbered()?;
            last = Some(index);
            found.bracket.lower = found.bracket.lower.at_least(facet.key);
            if self.query.is_met(&found.bracket) || self.query.exhausted().is_some() {
                break;
            }
            let corners = self.corners(&facet);
            let points = self.exact(&corners)?;
            let level = self.level(&facet.normal, &corners, &points)?;
            let asked = self.ask_along(&level, found)?;
            // (The new upper end may do.)
            if self.query.is_met(&found.bracket) {
                break;
            }
            if !(level.upper(&asked.point) - level.lower(&points) > self.error * T::count(8)) {
                break;
            }
            let mut vertex = asked.vertex;
            vertex.point *= self.query.scale();
            vertex.witness *= self.query.scale();
            // Points are right to a roundoff of their own size here: neighbours that are as near tell as little as that.
            let size = points.iter().fold(T::zero(), |size, point| size.at_least(norm(&point.high)));
            let near = size * self.query.scale() * (T::count(2 * N) * T::ROUNDOFF);
            if !self.polytope.is_far_beneath(&facet.normal, facet.normal.dot(&vertex.point)) {
                break;
            }
            if self.polytope.insert(index, vertex, near) != Some(Insertion::Done) {
                break;
            }
            while let Some(fresh) = self.polytope.next_fresh() {
                self.rate(fresh, &level, &found.bracket)?;
            }
            if !self.polytope.is_sound() {
                break;
            }
        }
        last
    }

    /// What one word says of a facet; `None` where it may be at the origin.
    fn rough(&self, facet: &Facet<T, N>) -> Option<T> {
        let margin = self.query.margin_along(&facet.normal);
        (facet.offset > margin).then(|| self.query.lower_of_plane(facet.offset, margin))
    }

    /// The widest of the facets that may be the lowest.
    fn widest(&self, upper: T) -> Option<Facet<T, N>> {
        let width = |facet: &Facet<T, N>| {
            let corners = self.polytope.corners(facet).corners;
            let base = corners.first().map_or(Vector::zeros(), |corner| corner.vertex.point);
            let mut edges = Edges::<T, N>::new();
            corners.iter().skip(1).map(|corner| corner.vertex.point - base).fold(T::one(), |size, edge| {
                edges.push(&edge, T::zero());
                size * norm(edges.q.get(edges.count.saturating_sub(1)).unwrap_or(&edge))
            })
        };
        let near = self.polytope.facets().filter(|facet| self.rough(facet).is_none_or(|lower| lower < upper));
        near.map(|facet| (facet, width(facet))).reduce(|a, b| if b.1 > a.1 { b } else { a }).map(|(facet, _)| *facet)
    }

    /// The key of a facet: what it bounds d by, along this level or its own, where one word does not suffice. `None` where the origin or the
    /// centre may be outside.
    #[inline(never)]
    fn rate(&mut self, index: Index, level: &Level<T, N>, bracket: &Bracket<T>) -> Option<()> {
        let Some(facet) = self.polytope.live_facet(index).copied() else { return Some(()) };
        if !self.polytope.is_far_beneath(&facet.normal, facet.offset) {
            return None;
        }
        let mut bound = self.rough(&facet)?;
        let is_enough = |lower: T| self.query.is_met(&Bracket { lower, ..*bracket });
        if !is_enough(bound) {
            let corners = self.corners(&facet);
            if let Some(points) = self.exact(&corners) {
                bound = bound.at_least(level.lower(&points) * self.query.scale());
                if !is_enough(bound)
                    && let Some(own) = self.level(&facet.normal, &corners, &points)
                {
                    bound = bound.at_least(own.lower(&points) * self.query.scale());
                }
            }
        }
        self.polytope.set_key(index, bound, false);
        Some(())
    }
}
