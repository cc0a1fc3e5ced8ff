//! Depth of a body of revolution and another body: the directions that minimise h_M may be an arc around its axis (module `sectors`), which expansion would have
//! to tile with thousands of facets.
//!
//! In this order, until one ends the query:
//!
//! 1. Two bodies of revolution that are coaxial up to [`NEARLY_COAXIAL`](super::axis::NEARLY_COAXIAL) of the tolerance are measured in one plane through the axis (module
//!    `meridian`), as if they were coaxial; the bracket is wider by what they are not.
//! 2. Expansion as for any pair, but only to [`PATIENCE`] vertices: enough where the minimiser is not on an arc.
//! 3. The sectors around each body's axis.
//! 4. The sectors around an edge of the other body that runs nearly along the axis.
//! 5. Expansion with all the memory there is: smooth bodies, tolerances near roundoff.
//! 6. Where memory has ended that, the sectors as exactly as rounding lets them.
//!
//! The rounding of the sectors' points, beside that of M's own: axes and azimuths are unit and orthogonal to 4 u, a point is split in two and put together again
//! in circles, in some 20 operations on numbers up to M's extent: less than 32 u of it. A matrix that is a rotation up to
//! s only makes circles of the set's circles up to 4 s times their size.

use super::answer::Depth;
use super::axis::{AXIS_ROUNDOFFS, Axis};
use super::body::{Body, skew};
use super::pair::Pair;
use super::route::Need;
use super::sectors::{SectorsEnd, Spin};
use crate::bounds::Bracket;
use crate::math::{Vector, norm, unit};
use crate::qset::Ball;
use crate::query::answer::{Answer, Outcome};
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Failure, Support, Symmetry};

/// More vertices than expansion takes where no minimisers lie on an arc.
const PATIENCE: usize = 48;

/// How far the directions are leant that find both ends of an edge.
const LEAN: f64 = 0.03125;

/// Shorter edges than this share of the extent make no arc.
const SHORTEST: f64 = 1e-3;

/// Cosine of the angle between axis and edge beyond which minimisers lie on no arc that expansion could not tile.
const ALIGNED: f64 = 0.75;

impl<T: Real> Body<'_, T> {
    /// The axis that the placed body turns about, as far as its matrix is a rotation.
    fn axis(&self) -> Option<Vector<T, 3>> {
        let turns = self.shape.symmetry() == Symmetry::Axis && self.shape.center().is_none();
        let rigid = || skew(&self.rotation) <= T::count(AXIS_ROUNDOFFS) * T::ROUNDOFF;
        (turns && rigid()).then(|| unit(&self.rotation.column(2).into_owned()))
    }
}

impl<T: Real> Pair<'_, '_, T, 3> {
    /// The first or the second body as the one whose arcs are searched for.
    fn spin(&self, first: bool) -> Option<Spin<T>> {
        let (body, other) = if first { (self.a, self.b) } else { (self.b, self.a) };
        body.shape.route().filter(|route| route.need == Need::Arcs)?;
        let axis = body.axis()?;
        let other = other.axis().map(|b| if b.dot(&axis) < T::zero() { -b } else { b });
        Some(Spin { axis, turns: true, first, offset: self.offset, other })
    }

    /// See above.
    pub(super) fn rounding_of_sectors(&self) -> T {
        let off = (skew(&self.a.rotation) + skew(&self.b.rotation)) * T::count(4);
        (off + T::count(32) * T::ROUNDOFF) * self.extent
    }

    /// The other body's edge that `direction` touches, as the axis to search around, where it runs along the axis of `spin`, nearly. (Any unit
    /// vector would do for the proof.) Its ends are what two directions find that are leant along the axis; and if that is no such edge, from a step to either
    /// side: the direction may be the normal of a face.
    fn edge(&self, spin: &Spin<T>, direction: &Vector<T, 3>, calls: &mut u32) -> Option<Spin<T>> {
        if spin.other.is_some() {
            return None;
        }
        let (lean, side) = (spin.axis * T::of(LEAN), direction.cross(&spin.axis) * T::of(LEAN));
        [*direction, direction + side, direction - side].iter().find_map(|middle| {
            *calls = calls.saturating_add(2);
            let end = |u| {
                let (point, witness) = self.sample(&unit(&u), false).ok()?;
                Some(if spin.first { point - witness } else { witness })
            };
            let along = end(middle + lean)? - end(middle - lean)?;
            let along = if along.dot(&spin.axis) < T::zero() { -along } else { along };
            let length = norm(&along);
            let is_edge = length > self.extent * T::of(SHORTEST) && length <= T::HUGE;
            let axis = unit(&along);
            let aligned = is_edge && axis.dot(&spin.axis) > T::of(ALIGNED);
            aligned.then_some(Spin { axis, turns: false, first: !spin.first, other: Some(spin.axis), ..*spin })
        })
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// Depth where one body turns.
    pub(super) fn depth_with_arcs(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        axis: Option<Axis<T>>,
        mut calls: u32,
        options: &Options<'_, T, 3>,
    ) -> Depth<T> {
        let options = pair.aimed(options);
        if let Some(axis) = axis
            && let Some(answer) = self.depth_near_axis(pair, &axis, &mut calls, &options)
        {
            return Depth::new(&answer, pair);
        }
        let ball = Ball::unit();
        let answer = self.bounded(PATIENCE).expand_only(Pair::query(pair, &ball, calls, &options));
        if answer.outcome != Outcome::Capacity {
            return self.conclude_pair(pair, &answer, &options);
        }
        self.depth_on_arcs(pair, &answer, options)
    }

    /// Both bodies turn about nearly the same axis: is the answer in its plane good enough? Not near the poles, where no arc is left, and the witnesses
    /// of one plane do not stand for the others.
    #[cold]
    fn depth_near_axis(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        axis: &Axis<T>,
        calls: &mut u32,
        options: &Options<'_, T, 3>,
    ) -> Option<Answer<T, 3>> {
        let answer = self.depth_on_axis(pair, axis, calls, options)?;
        let known = matches!(answer.outcome, Outcome::Converged | Outcome::Above | Outcome::Below);
        (known && !axis.has_pole(&answer.direction)).then_some(answer)
    }

    /// Expansion has spent its patience: the sectors, else expansion with all memory.
    #[cold]
    fn depth_on_arcs(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        before: &Answer<T, 3>,
        mut options: Options<T, 3>,
    ) -> Depth<T> {
        let mut calls = before.support_calls;
        options.guess = Some(before.direction);
        if let Some(answer) = self.search_arcs(pair, &mut calls, &options, before) {
            return Depth::new(&answer, pair);
        }
        let ball = Ball::unit();
        let answer = self.expand_only(resumed(pair, &ball, calls, &options, before));
        if answer.outcome == Outcome::Capacity
            && let Some(better) = self.search_arcs_roughly(pair, &mut calls, &options, &answer)
        {
            return Depth::new(&better, pair);
        }
        self.conclude_pair(pair, &answer, &options)
    }

    /// The sectors once more, with a tolerance that rounding can meet, where they tell more than expansion did.
    fn search_arcs_roughly(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        calls: &mut u32,
        options: &Options<'_, T, 3>,
        known: &Answer<T, 3>,
    ) -> Option<Answer<T, 3>> {
        let error = pair.error + pair.rounding_of_sectors();
        let rough = Options { absolute: options.absolute.at_least(error * T::count(16)), ..*options };
        let mut found = self.search_arcs(pair, calls, &rough, known).filter(|found| found.lower > known.lower)?;
        (found.vertices, found.facets) = (found.vertices.max(known.vertices), found.facets.max(known.facets));
        if found.outcome == Outcome::Converged {
            found.outcome = Outcome::Precision;
        }
        // That the sectors' points are off says nothing of a height: it is asked for once more without that charge.
        let ball = Ball::unit();
        let (mut query, checked) = resumed(pair, &ball, *calls, options, &found);
        let asked = checked.and_then(|()| query.normalize()).and_then(|()| query.support(&found.direction));
        let mut bracket = Bracket { lower: found.lower, upper: found.upper }.scaled(query.scale());
        if asked.is_ok() && query.best.direction == found.direction {
            bracket.upper = bracket.upper.at_most(query.upper());
        }
        query.refine(&mut found, &bracket, None);
        Some(found)
    }

    /// The search around each axis, then around edges, after an answer that did not suffice. Adds to the support calls.
    fn search_arcs(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        calls: &mut u32,
        options: &Options<'_, T, 3>,
        known: &Answer<T, 3>,
    ) -> Option<Answer<T, 3>> {
        for (first, edge) in [(true, false), (false, false), (true, true), (false, true)] {
            let Some(mut spin) = pair.spin(first) else { continue };
            if edge {
                let Some(around) = pair.edge(&spin, &known.direction, calls) else { continue };
                spin = around;
            }
            let uncharged = pair.charge(pair.rounding_of_sectors());
            let ball = Ball::unit();
            let (mut query, checked) = resumed(pair, &ball, *calls, options, known);
            let found = checked.and_then(|()| query.normalize()).and_then(|()| self.search_sectors(&mut query, &spin));
            let iterations = query.iterations();
            *calls = query.support_calls();
            pair.discharge(uncharged);
            match found {
                Ok(SectorsEnd::Done(answer)) => return Some(answer),
                Ok(SectorsEnd::Stopped(stop)) => {
                    let outcome = stop.outcome(known.lower, known.upper, false, false);
                    return Some(Answer { outcome, iterations, support_calls: *calls, ..known.clone() });
                }
                _ => {}
            }
        }
        None
    }
}

/// A query of the pair that goes on from an answer.
fn resumed<'q, T: Real>(
    set: &'q dyn Support<T, 3>,
    ball: &'q Ball<T>,
    calls: u32,
    options: &Options<'q, T, 3>,
    known: &Answer<T, 3>,
) -> (Query<'q, T, 3>, Result<(), Failure>) {
    let (mut query, checked) = Pair::query(set, ball, calls, options);
    query.resume(known);
    (query, checked)
}
