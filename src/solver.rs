//! The d_Q loop: Algorithm 1 of Zheng & Yamane.

use crate::answer::{Answer, Stop};
use crate::bounds::Bracket;
use crate::distance::{Cloud, Inflated, Nearest, nearest};
use crate::polytope::{Facet, Index, Insertion, Polytope};
use crate::qset::Gauge;
use crate::query::{Options, Query};
use crate::scalar::{Real, Vector, norm};
use crate::simplex::{Simplex, Vertex};
use crate::start::Start;
use crate::support::{Failure, Support};

/// Solves queries in one piece of borrowed memory. Made by [`Workspace`](crate::workspace::Workspace) or
/// [`place`](crate::workspace::place).
///
/// A solver keeps nothing between queries; the memory is overwritten. One solver per thread.
pub struct Solver<'w, T, const N: usize> {
    pub(crate) polytope: Polytope<'w, T, N>,
}

/// Insertions per dimension that [`Solver::widen`] may spend.
const WIDENINGS: usize = 8;

/// What the expansion ended with: the lowest key, and its facet if it is known.
struct Expanded<T> {
    stop: Stop,
    key: T,
    facet: Option<Index>,
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The generalized penetration distance d_Q(A) = max { λ : λQ ⊂ A } of the origin in A.
    ///
    /// Best-first polytope expansion (Algorithm 1): the facet that bounds λQ now is pushed out to the boundary of A
    /// until inner polytope and outer half-space agree. With a Euclidean Q, A's ball term is taken out exactly, and a
    /// negative answer is minus the distance.
    ///
    /// Cost: one support call and, for N = 3, about five facets an iteration; 10 to 40 iterations for a relative 1e-6. The work is
    /// bounded by the capacity.
    ///
    /// Never fails: bad input to the support function or the gauge ends with `SupportFailed` and a bracket that is
    /// true for the values that were returned.
    pub fn solve(&mut self, a: &dyn Support<T, N>, q: &dyn Gauge<T, N>, options: &Options<T, N>) -> Answer<T, N> {
        self.polytope.reset();
        let radius = a.radius();
        if q.ball_radius().is_none() && radius > T::zero() {
            let inflated = Inflated(a);
            return self.run(Query::new(&inflated, q, T::zero(), *options));
        }
        self.run(Query::new(a, q, radius, *options))
    }

    fn run(&mut self, (mut query, checked): (Query<'_, T, N>, Result<(), Failure>)) -> Answer<T, N> {
        if let Err(failure) = checked.and_then(|()| query.normalize()) {
            return self.give_up(&mut query, failure);
        }
        let first = query.first_direction();
        // With a ball term, shallow contact leaves the cores apart: then the distance is the whole answer.
        let mut floor = None;
        if query.bounds.radius > T::zero() {
            match self.approach(&mut query, &first) {
                Ok((stop, near)) => {
                    let bracket = Bracket { lower: query.lower_from_distance(near.distance), upper: query.upper() };
                    if stop != Stop::Rounding || query.is_met(&bracket) || query.is_tight(&bracket) {
                        return query.answer(stop, bracket.lower, near.simplex, &self.polytope);
                    }
                    floor = Some(near);
                }
                Err(failure) => return self.give_up(&mut query, failure),
            }
        }
        let expanded = match self.start(&mut query, &first) {
            Ok(None) => self.expand(&mut query),
            Ok(Some(stop)) => Ok(Expanded { stop, key: -T::HUGE, facet: None }),
            Err(failure) => Err(failure),
        };
        match expanded {
            Ok(expanded) => self.conclude(&mut query, expanded, floor),
            Err(failure) => self.give_up(&mut query, failure),
        }
    }

    /// Lines 5 to 9 of Algorithm 1.
    fn expand(&mut self, query: &mut Query<'_, T, N>) -> Result<Expanded<T>, Failure> {
        loop {
            let Some((key, index)) = self.polytope.pop_lowest() else {
                // No facet below the best upper bound is left.
                if !self.confirm(query)? {
                    continue;
                }
                let key = query.skipped().at_most(query.ratio());
                return Ok(Expanded { stop: Stop::Rounding, key, facet: None });
            };
            let key = key.at_most(query.skipped());
            let end = |stop| Ok(Expanded { stop, key, facet: Some(index) });
            let Some(&Facet { normal, offset, .. }) = self.polytope.facet(index) else { return end(Stop::Rounding) };
            if let Some(stop) = self.verdict(query, key) {
                if !self.confirm(query)? {
                    continue;
                }
                return end(stop);
            }
            if query.exhausted() {
                return end(Stop::Iterations);
            }
            let (vertex, height) = query.support(&normal)?;
            if query.is_outside(height) {
                if !self.confirm(query)? {
                    continue;
                }
                return end(Stop::Outside);
            }
            let tolerance = self.polytope.resolution();
            // On the boundary of A, as far as arithmetic can tell?
            let final_facet = (height - offset <= tolerance).then_some(Stop::Rounding);
            if let Some(stop) = self.verdict(query, key).or(final_facet) {
                if !self.confirm(query)? {
                    continue;
                }
                return end(stop);
            }
            match self.polytope.insert(index, vertex, tolerance) {
                Some(Insertion::Done) => self.rate_fresh(query)?,
                Some(Insertion::Full) => return end(Stop::Capacity),
                Some(Insertion::Rejected) | None => return end(Stop::Rounding),
            }
        }
    }

    /// Checks the best upper bound without A's shortcuts. When it rises, facets that were above it before matter
    /// again, and the search goes on; that happens once at most.
    fn confirm(&mut self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        if query.verify()? {
            return Ok(true);
        }
        query.forget_skipped();
        if let Some(lowest) = self.polytope.requeue(query.ratio()) {
            query.skip(lowest);
        }
        Ok(false)
    }

    /// Does the bracket, with this lowest key, end the query? First without the margins, which for a general Q cost a
    /// pass over the facets.
    fn verdict(&self, query: &Query<'_, T, N>, key: T) -> Option<Stop> {
        if query.is_open(key) {
            return None;
        }
        let upper = query.upper();
        let stop = query.verdict(&Bracket { lower: key, upper })?;
        if stop == Stop::Below {
            return Some(stop);
        }
        query.verdict(&Bracket { lower: self.lower(query, key)?, upper })
    }

    /// The lower bound that the polytope proves when its lowest key is this; `None` when the origin is not certainly
    /// inside.
    fn lower(&self, query: &Query<'_, T, N>, key: T) -> Option<T> {
        if !self.polytope.is_sound() {
            return None;
        }
        match query.ball {
            Some(radius) => {
                // Back from the key to the offset, rounded down: four roundings there and back.
                let whole = key * radius;
                query.lower_from_offset(whole - query.bounds.radius - whole.abs() * (T::count(5) * T::ROUNDOFF))
            }
            None => query.lower_from_facets(self.polytope.facets().map(|f| (f.offset, f.key))),
        }
    }

    /// Line 7: keys of the new facets. One above the best upper bound will never be the lowest that matters.
    fn rate_fresh(&mut self, query: &mut Query<'_, T, N>) -> Result<(), Failure> {
        while let Some(index) = self.polytope.next_fresh() {
            let Some(facet) = self.polytope.facet(index) else { break };
            let key = query.key(&facet.normal, facet.offset)?;
            if !self.polytope.set_key(index, key, key < query.ratio()) {
                query.skip(key);
            }
        }
        Ok(())
    }

    /// Lines 1 to 3: the first simplex. A stop instead when A is flat, or when it certainly does not contain the
    /// origin.
    fn start(&mut self, query: &mut Query<'_, T, N>, first: &Vector<T, N>) -> Result<Option<Stop>, Failure> {
        let mut start = Start::new(*first);
        while start.missing() > 0 {
            let direction = start.direction();
            let (mut vertex, height) = query.support(&direction)?;
            if query.is_outside(height) && query.bounds.radius == T::zero() && query.verify()? {
                return Ok(Some(Stop::Outside));
            }
            if start.progress(&direction, &vertex.point) < query.reach() * T::of(0.01) {
                let (other, height) = query.support(&-direction)?;
                if query.is_outside(height) && query.bounds.radius == T::zero() && query.verify()? {
                    return Ok(Some(Stop::Outside));
                }
                if start.progress(&direction, &other.point) > start.progress(&direction, &vertex.point) {
                    vertex = other;
                }
            }
            let thin = (self.polytope.resolution() + query.margin()) * T::count(4);
            if start.accept(&vertex.point, thin) {
                if self.polytope.add_vertex(vertex).is_none() {
                    return Ok(Some(Stop::Capacity));
                }
            } else {
                start.flat(&direction);
            }
        }
        query.dimension = start.dimension();
        if start.dimension() < N {
            return Ok(Some(Stop::Flat));
        }
        if self.polytope.make_simplex(&start.normals()).is_none() {
            return Ok(Some(Stop::Capacity));
        }
        self.rate_fresh(query)?;
        Ok(None)
    }

    /// The distance iteration on the core of A, watched by the bracket.
    fn approach(
        &mut self,
        query: &mut Query<'_, T, N>,
        first: &Vector<T, N>,
    ) -> Result<(Stop, Nearest<T, N>), Failure> {
        let mut stop = Stop::Rounding;
        let shared = core::cell::RefCell::new(query);
        let near = nearest(
            first,
            |u| shared.try_borrow_mut().map_err(|_| Failure(crate::EMPTY))?.support(u).map(|(vertex, _)| vertex),
            |distance| {
                let Ok(mut query) = shared.try_borrow_mut() else { return true };
                let bracket = Bracket { lower: query.lower_from_distance(distance), upper: query.upper() };
                let verdict = query.verdict(&bracket);
                let end = verdict.or_else(|| query.exhausted().then_some(Stop::Iterations));
                stop = end.unwrap_or(stop);
                end.is_some()
            },
        )?;
        Ok((stop, near))
    }

    /// Turns the state of the polytope into an answer.
    fn conclude(
        &mut self,
        query: &mut Query<'_, T, N>,
        expanded: Expanded<T>,
        floor: Option<Nearest<T, N>>,
    ) -> Answer<T, N> {
        let Expanded { stop, key, facet } = expanded;
        let apart = query.upper() < T::zero();
        if !apart && self.polytope.peak_facets() > 0 {
            if let Err(failure) = self.widen(query, stop, key) {
                return self.give_up(query, failure);
            }
            if let Some(lower) = self.lower(query, key) {
                let facet = facet.filter(|_| query.ball.is_some());
                let witness = self.touching_simplex(query, facet);
                return query.answer(stop, lower, witness, &self.polytope);
            }
        }
        // The origin is outside, on the boundary, or in a flat set: the nearest point of A is the other end.
        if query.bounds.radius == T::zero() && !matches!(stop, Stop::Capacity | Stop::Iterations) {
            let first = if apart { query.direction } else { query.first_direction() };
            match self.approach(query, &first) {
                // A walk that was cut short may know less than the vertices stored before it.
                Ok((Stop::Iterations, near)) => return self.lower_by_vertices(query, Stop::Iterations, Some(near)),
                Ok((end, near)) => {
                    let stop = if stop == Stop::Flat && near.inside { stop } else { end };
                    let lower = query.lower_from_distance(near.distance);
                    return query.answer(stop, lower, near.simplex, &self.polytope);
                }
                Err(failure) => return self.give_up(query, failure),
            }
        }
        self.lower_by_vertices(query, stop, floor)
    }

    /// For a Q that is not a ball, expansion towards a few directions of Q can leave facets so near to the origin that
    /// the margin swallows them, and the bracket open. Then the nearest facets are pushed out too.
    fn widen(&mut self, query: &mut Query<'_, T, N>, stop: Stop, key: T) -> Result<(), Failure> {
        if query.ball.is_some() || stop != Stop::Rounding {
            return Ok(());
        }
        let bracket = |solver: &Self, query: &Query<'_, T, N>| {
            solver.lower(query, key).map(|lower| Bracket { lower, upper: query.upper() })
        };
        for _ in 0..WIDENINGS * N {
            if bracket(self, query).is_some_and(|b| query.is_met(&b)) {
                return Ok(());
            }
            let Some((index, normal, offset)) = self.polytope.nearest_facet() else { return Ok(()) };
            let (vertex, height) = query.support(&normal)?;
            let tolerance = self.polytope.resolution();
            if height - offset <= tolerance + tolerance {
                return Ok(());
            }
            match self.polytope.insert(index, vertex, tolerance) {
                Some(Insertion::Done) => self.rate_fresh(query)?,
                _ => return Ok(()),
            }
        }
        Ok(())
    }

    /// The simplex of the surface that touches the largest d Q. For a ball, the one around the foot of the perpendicular on
    /// the plane that proves the upper bound: usually the lowest facet; but that one may be another of several in
    /// the plane, or belong to another of several minima.
    fn touching_simplex(&self, query: &Query<'_, T, N>, facet: Option<Index>) -> Simplex<T, N> {
        let lowest = match facet {
            Some(index) => self.polytope.facet(index),
            None => self.polytope.lowest(),
        };
        let Some(facet) = lowest else { return Simplex::new(Vertex::empty()) };
        let mut simplex = self.polytope.corners(facet);
        if query.ball.is_none() {
            return simplex;
        }
        let foot = query.foot();
        let resolution = self.polytope.resolution();
        simplex.translate(&-foot);
        simplex.minimize(resolution);
        let miss = simplex.point();
        let near = resolution * T::count(64) + query.options.relative.at_least(T::zero()).root() * norm(&foot);
        if miss.dot(&miss) > near * near {
            let cloud = Cloud { vertices: self.polytope.vertices(), origin: foot };
            if let Some(found) = cloud.nearest(&facet.normal)
                && found.distance * found.distance < miss.dot(&miss)
            {
                simplex = found.simplex;
            }
        }
        simplex.translate(&foot);
        simplex
    }

    /// An answer whose lower bound comes from points that are known, without asking A again: the stored vertices, or
    /// the point that was nearest before.
    fn lower_by_vertices(&self, query: &mut Query<'_, T, N>, stop: Stop, floor: Option<Nearest<T, N>>) -> Answer<T, N> {
        let cloud = Cloud { vertices: self.polytope.vertices(), origin: Vector::zeros() };
        let stored = cloud.nearest(&query.first_direction());
        match stored.into_iter().chain(floor).reduce(|a, b| if b.distance < a.distance { b } else { a }) {
            Some(near) => {
                let lower = query.lower_from_distance(near.distance);
                query.answer(stop, lower, near.simplex, &self.polytope)
            }
            None => query.answer(stop, -T::HUGE, Simplex::new(Vertex::empty()), &self.polytope),
        }
    }

    fn give_up(&mut self, query: &mut Query<'_, T, N>, failure: Failure) -> Answer<T, N> {
        self.lower_by_vertices(query, Stop::Failed(failure.0), None)
    }
}
