//! The solver: which plan a query takes, and how what the plan shows becomes the answer.

pub(crate) mod batch;
pub(crate) mod depth;
pub(crate) mod prepare;
mod second_look;
mod span;
pub(crate) mod warm;
pub(crate) mod workspace;

use core::fmt;

use crate::bounds::Bracket;
use crate::math::Vector;
use crate::plan::distance::{Cloud, Inflated, Nearest, nearest};
use crate::plan::expansion::Expanded;
use crate::plan::race::{Ended, by_rays, race};
use crate::polytope::Polytope;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::qset::UnitSet;
use crate::query::answer::{Answer, Plan, Stop};
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::support::failure::EMPTY;
use crate::support::{Failure, Support};

/// Solves queries in one piece of borrowed memory. Made by [`Workspace`](crate::solver::workspace::Workspace) or
/// [`place`](crate::solver::workspace::place).
///
/// A solver keeps nothing between queries; the memory is overwritten. One solver per thread.
pub struct Solver<'w, T, const N: usize> {
    pub(crate) polytope: Polytope<'w, T, N>,
}

impl<T: Real, const N: usize> fmt::Debug for Solver<'_, T, N> {
    /// The capacities; what the memory contains says nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [vertices, facets] = self.polytope.capacities();
        f.debug_struct("Solver").field("vertices", &vertices).field("facets", &facets).finish_non_exhaustive()
    }
}

/// What is known when the plans that any query begins with have had their say.
struct Opening<T, const N: usize, E> {
    /// How the plan ended; or, with no plan, the end of the distance iteration, which decided.
    end: Result<E, Stop>,
    /// The point of A nearest to the origin, where A has a ball term.
    near: Option<Nearest<T, N>>,
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The generalized penetration distance d_Q(A) = max { λ : λQ ⊂ A } of the origin in A.
    ///
    /// The plan is chosen by what the query is, and told in [`Answer::plan`]:
    /// * a polytope is expanded, best first (Algorithm 1);
    /// * a polytopal Q may take one ray per vertex of Q instead, and no memory: expansion begins, and where it takes as long as the rays are
    ///   expected to, the two take turns;
    /// * when it outgrows the memory, d is searched cone by cone in the same memory. That converges, given the iterations, with any
    ///   capacity of at least 4 N facets and 3 N vertices; with N = 6, 512 facets and 64 vertices are a sensible least.
    ///
    /// Where a height of A is 0 up to rounding, as for a grasp that is open, d is 0 and the query is over: `lower` is 0 where the set
    /// [contains the origin](Support::contains_origin) by definition, else what its nearest point shows. A [`Segment`](crate::qset::Segment) asks for its own
    /// direction only, and may have d > 0 there; how much of one that runs along the boundary of A is in A is not for arithmetic to tell: 0 <= d <=
    /// `upper`. ([`solve_in_span`](Self::solve_in_span) for sets that are flat.)
    ///
    /// With a Euclidean Q, A's ball term is taken out exactly, and a negative answer is minus the distance.
    ///
    /// Cost: one support call an iteration, and with N = 3 about five facets, with N = 6 about fifty. 10 to 40 iterations in space for
    /// a relative 1e-6; some thousand for a smooth A in six dimensions and a relative 1e-3. The work is bounded by `options.max_iterations`.
    ///
    /// Never fails: bad input to the support function or the unit set ends with `SupportFailed` and a bracket that is
    /// true for the values that were returned.
    pub fn solve(&mut self, a: &dyn Support<T, N>, q: &dyn UnitSet<T, N>, options: &Options<'_, T, N>) -> Answer<T, N> {
        self.solve_unless(a, q, options, |_| Ok(None))
    }

    /// [`solve`](Self::solve), unless `known` has the answer of the query before any plan begins.
    pub(crate) fn solve_unless(
        &mut self,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        options: &Options<'_, T, N>,
        known: impl FnOnce(&mut Query<'_, T, N>) -> Result<Option<Answer<T, N>>, Failure>,
    ) -> Answer<T, N> {
        self.polytope.reset();
        let inflated = Inflated(a);
        let (set, radius) = inflated.for_unit(q);
        let (mut query, checked) = Query::new(set, q, radius, *options);
        let answer = match checked.and_then(|()| query.normalize()).and_then(|()| known(&mut query)) {
            Ok(Some(answer)) => return answer,
            Ok(None) => self.decide(&mut query),
            Err(failure) => return self.give_up(&mut query, failure),
        };
        self.look_again(answer, set, options, |solver, set, options, first, measured| {
            let (mut query, checked) = Query::new(set, q, radius, options);
            solver.polytope.reset();
            solver.sharpen(&mut query, checked, first, measured).then(|| solver.decide(&mut query))
        })
    }

    /// The plan for a query that has been made ready.
    fn decide(&mut self, query: &mut Query<'_, T, N>) -> Answer<T, N> {
        match self.open(query, choose) {
            Ok(Opening { end: Ok(Ended::Expansion(expanded)), near }) if expanded.stop == Stop::Capacity => {
                self.solve_cones(query, expanded, near.as_ref())
            }
            Ok(Opening { end: Ok(Ended::Expansion(expanded)), near }) => self.conclude(query, expanded, near.as_ref()),
            Ok(Opening { end: Ok(Ended::Rays(rays)), .. }) => self.report(query, rays.stop, rays.lower, rays.witness),
            Ok(Opening { end: Err(stop), near }) => self.conclude_near(query, stop, near.as_ref()),
            Err(failure) => self.give_up(query, failure),
        }
    }

    /// The same by expansion of one polytope alone: the work is bounded by the capacity, whose exhaustion ends the query with outcome
    /// [`Capacity`](crate::Outcome::Capacity). A program that calls this and not [`solve`](Self::solve) does without the other plans'
    /// code.
    pub fn solve_by_expansion(
        &mut self,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        options: &Options<'_, T, N>,
    ) -> Answer<T, N> {
        let inflated = Inflated(a);
        let (set, radius) = inflated.for_unit(q);
        let answer = self.expand_only(Query::new(set, q, radius, *options));
        self.look_again(answer, set, options, |solver, set, options, first, measured| {
            solver.expand_sharper(Query::new(set, q, radius, options), first, measured)
        })
    }

    #[inline(always)]
    pub(crate) fn expand_only(&mut self, (mut query, checked): (Query<'_, T, N>, Result<(), Failure>)) -> Answer<T, N> {
        match checked.and_then(|()| query.normalize()) {
            Ok(()) => self.expand_ready(&mut query),
            Err(failure) => self.give_up(&mut query, failure),
        }
    }

    /// The same as a second look; `None` when that would show nothing new.
    pub(crate) fn expand_sharper(
        &mut self,
        (mut query, checked): (Query<'_, T, N>, Result<(), Failure>),
        first: &Vector<T, N>,
        measured: bool,
    ) -> Option<Answer<T, N>> {
        self.sharpen(&mut query, checked, first, measured).then(|| self.expand_ready(&mut query))
    }

    #[inline(always)]
    pub(crate) fn expand_ready(&mut self, query: &mut Query<'_, T, N>) -> Answer<T, N> {
        self.polytope.reset();
        // (By reference: what was nearest is not copied.)
        match &self.open(query, expand) {
            Ok(Opening { end: Ok(expanded), near }) => self.conclude(query, *expanded, near.as_ref()),
            Ok(Opening { end: Err(stop), near }) => self.conclude_near(query, *stop, near.as_ref()),
            Err(failure) => self.give_up(query, *failure),
        }
    }

    /// The answer of the distance iteration.
    fn conclude_near(&self, query: &mut Query<'_, T, N>, stop: Stop, near: Option<&Nearest<T, N>>) -> Answer<T, N> {
        query.plan = Plan::Distance;
        self.lower_by_vertices(query, stop, near)
    }

    /// Distance where that decides; else the first simplex, and the plan that it is for.
    fn open<E>(
        &mut self,
        query: &mut Query<'_, T, N>,
        plan: impl FnOnce(&mut Polytope<'_, T, N>, &mut Query<'_, T, N>, Option<Stop>) -> Result<E, Failure>,
    ) -> Result<Opening<T, N, E>, Failure> {
        if query.is_above_anyway() {
            return Ok(Opening { end: Err(Stop::Above), near: None });
        }
        let first = query.first_direction();
        // With a ball term, shallow contact leaves the cores apart: then the distance is the whole answer.
        let mut so_far = None;
        if query.bounds.radius > T::zero() {
            let (stop, near) = self.approach(query, &first)?;
            let bracket =
                Bracket { lower: query.lower_from_simplex(&near.simplex, near.distance), upper: query.upper() };
            if stop != Stop::Rounding || query.is_met(&bracket) || query.is_tight(&bracket) {
                return Ok(Opening { end: Err(stop), near: Some(near) });
            }
            so_far = Some(near);
        }
        let stop = self.polytope.start(query, &first)?;
        let end = plan(&mut self.polytope, query, stop)?;
        Ok(Opening { end: Ok(end), near: so_far })
    }

    /// Cone by cone, after the polytope has outgrown the memory.
    fn solve_cones(
        &mut self,
        query: &mut Query<'_, T, N>,
        expanded: Expanded<T>,
        so_far: Option<&Nearest<T, N>>,
    ) -> Answer<T, N> {
        // What the search stores are images of A's points in its cones. Until it has a bound, those stored before are what is known.
        let known = self.polytope.lower(query, expanded.key).is_some();
        let stored = if known { None } else { self.nearest_stored(query, so_far) };
        let so_far = stored.as_ref().or(so_far);
        let Some(found) = self.polytope.conewise(query, &expanded) else {
            return self.conclude(query, expanded, so_far);
        };
        query.plan = Plan::Cones;
        if found.stop != Stop::Outside && found.lower > -T::HUGE {
            let answer = self.report(query, found.stop, found.lower, found.witness);
            return Answer { cones: found.cones, splits: found.splits, ..answer };
        }
        self.polytope.forget();
        match found.stop {
            Stop::Failed(_) => self.lower_by_vertices(query, found.stop, so_far),
            stop => self.conclude(query, Expanded { stop, key: -T::HUGE, facet: None }, so_far),
        }
    }

    /// The answer, with what was used of the memory.
    pub(crate) fn report(
        &self,
        query: &mut Query<'_, T, N>,
        stop: Stop,
        lower: T,
        witness: Simplex<T, N>,
    ) -> Answer<T, N> {
        let mut answer = query.answer(stop, lower, witness);
        answer.vertices = self.polytope.peak_vertices();
        answer.facets = self.polytope.peak_facets();
        answer
    }

    /// The distance iteration on the core of A, watched by the bracket.
    fn approach(
        &mut self,
        query: &mut Query<'_, T, N>,
        first: &Vector<T, N>,
    ) -> Result<(Stop, Nearest<T, N>), Failure> {
        let mut stop = Stop::Rounding;
        let axes = query.axes;
        let shared = core::cell::RefCell::new(query);
        let near = nearest(
            first,
            axes.as_ref(),
            |u| shared.try_borrow_mut().map_err(|_| Failure(EMPTY))?.support(u).map(|(vertex, _)| vertex),
            |simplex, distance| {
                let Ok(mut query) = shared.try_borrow_mut() else { return true };
                let bracket = Bracket { lower: query.lower_from_simplex(simplex, distance), upper: query.upper() };
                let verdict = query.verdict(&bracket);
                let end = verdict.or_else(|| query.exhausted());
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
        so_far: Option<&Nearest<T, N>>,
    ) -> Answer<T, N> {
        let Expanded { stop, key, facet } = expanded;
        let apart = query.upper() < T::zero();
        if !apart && stop != Stop::Zero && self.polytope.facets().next().is_some() {
            if let Err(failure) = self.polytope.widen(query, stop, key) {
                return self.give_up(query, failure);
            }
            // (After a limit nothing is asked that would not be asked after a later one.)
            if query.stopped().is_none()
                && let Err(failure) = self.meet_rival(query)
            {
                return self.give_up(query, failure);
            }
            if let Some(lower) = self.polytope.lower(query, key) {
                let facet = facet.filter(|_| query.ball.is_some());
                let witness = self.polytope.touching_simplex(query, facet);
                return self.report(query, stop, lower, witness);
            }
        }
        // The origin is outside, on the boundary, or in a flat set: the nearest point of A is the other end, unless that is the origin.
        let is_known = !apart && matches!(stop, Stop::Zero | Stop::Flat) && query.contains_origin();
        let is_cut_short = matches!(stop, Stop::Capacity | Stop::Iterations | Stop::Interrupted);
        if query.bounds.radius == T::zero() && !is_known && !is_cut_short {
            let first = if apart { query.best.direction } else { query.first_direction() };
            match self.approach(query, &first) {
                // A walk that was cut short may know less than the vertices stored before it.
                Ok((stop @ (Stop::Iterations | Stop::Interrupted), near)) => {
                    let near = so_far.into_iter().fold(&near, |a, b| if b.distance < a.distance { b } else { a });
                    return self.lower_by_vertices(query, stop, Some(near));
                }
                Ok((end, near)) => {
                    let stop = if stop == Stop::Flat && near.inside { stop } else { end };
                    let lower = query.lower_from_simplex(&near.simplex, near.distance);
                    return self.report(query, stop, lower, near.simplex);
                }
                Err(failure) => return self.give_up(query, failure),
            }
        }
        self.lower_by_vertices(query, stop, so_far)
    }

    /// An answer whose lower bound comes from points that are known, without asking A again: the stored vertices, or
    /// the point that was nearest before.
    #[inline(never)]
    fn lower_by_vertices(
        &self,
        query: &mut Query<'_, T, N>,
        stop: Stop,
        so_far: Option<&Nearest<T, N>>,
    ) -> Answer<T, N> {
        let stored = self.nearest_stored(query, so_far);
        match stored.as_ref().or(so_far) {
            Some(near) => {
                let lower = query.lower_from_simplex(&near.simplex, near.distance);
                self.report(query, stop, lower, near.simplex.clone())
            }
            None => self.report(query, stop, -T::HUGE, Simplex::new(Vertex::empty())),
        }
    }

    /// Facets that tie with the lowest are never pushed out. The lowest of those far from the best direction, if it ties, is asked for
    /// once: a minimiser of its own?
    fn meet_rival(&self, query: &mut Query<'_, T, N>) -> Result<(), Failure> {
        if let Some(best) = query.lonely() {
            let far = self.polytope.facets().filter(|f| query.is_far(&f.normal, &best));
            let lowest = far.reduce(|low, f| if f.key < low.key { f } else { low });
            if let Some(facet) = lowest.filter(|f| query.ties(f.key)) {
                let normal = facet.normal;
                query.support(&normal)?;
            }
        }
        Ok(())
    }

    /// The point nearest to the origin of the stored vertices' hull, if one from before is not nearer.
    fn nearest_stored(&self, query: &Query<'_, T, N>, before: Option<&Nearest<T, N>>) -> Option<Nearest<T, N>> {
        let cloud = Cloud { vertices: self.polytope.vertices(), origin: Vector::zeros() };
        if cloud.vertices.is_empty() {
            return None;
        }
        cloud.nearest(&query.first_direction()).filter(|stored| before.is_none_or(|b| !(b.distance < stored.distance)))
    }

    /// The answer after a failure: what the surface proves that is there, else the stored vertices.
    #[cold]
    #[inline(never)]
    fn give_up(&mut self, query: &mut Query<'_, T, N>, failure: Failure) -> Answer<T, N> {
        let stop = Stop::Failed(failure.0);
        let key = self.polytope.lowest().map(|facet| facet.key.at_most(query.skipped()));
        match key.and_then(|key| self.polytope.lower(query, key)) {
            Some(lower) if query.upper() >= T::zero() => {
                let witness = self.polytope.touching_simplex(query, None);
                self.report(query, stop, lower, witness)
            }
            _ => self.lower_by_vertices(query, stop, None),
        }
    }
}

/// Expansion, and nothing else; unless the first simplex is none for this reason.
fn expand<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    stop: Option<Stop>,
) -> Result<Expanded<T>, Failure> {
    match stop {
        None => polytope.expand(query),
        Some(stop) => Ok(Expanded { stop, key: -T::HUGE, facet: None }),
    }
}

/// Expansion; and rays by turns with it where Q is a polytope. Where A is flat, a Q that asks for some directions only is left to the rays.
fn choose<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    stop: Option<Stop>,
) -> Result<Ended<T, N>, Failure> {
    if query.rays() > 0 && stop.is_none() {
        return race(polytope, query);
    }
    if query.rays() > 0 && stop == Some(Stop::Flat) && !(query.inner_radius() > T::zero()) {
        if let Some(rays) = by_rays(query)? {
            return Ok(Ended::Rays(rays));
        }
        // (A limit that was met on the way is what ended the query.)
        return expand(polytope, query, query.stopped().or(stop)).map(Ended::Expansion);
    }
    expand(polytope, query, stop).map(Ended::Expansion)
}
