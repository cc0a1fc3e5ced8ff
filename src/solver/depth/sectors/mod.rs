//! Arcs of minimisers: a search sector by sector around the axis of a body of revolution.
//!
//! Where a corner or an edge of one body lies near the axis of a cylinder, a cone or a disc, or two bodies of revolution are nearly
//! coaxial, the minimisers of h_M are an arc of directions around the axis, or so near to one that expansion in space must tile
//! it: to a relative 1e-6 with thousands of facets. But the rim that makes the arc is known. Let C be the body
//! of revolution, a its axis, e(w) the unit vector across a at azimuth w, and M = K + C with K all the rest (the other body and the
//! offset; which of the two is subtracted does not matter here). A direction of azimuth w is u = s e(w) + c a with s >= 0.
//!
//! # A sector is a plane problem
//!
//! Let W be a sector of azimuths. A support call finds a point p + c of M, p in K, c in C. C contains the whole circle of c about the
//! axis, so for every u of the sector
//!
//! ```text
//! h_M(u) >= s (min over W of e.p + |c across a|) + c (a.p + a.c)
//! ```
//!
//! which is the value at (s, c) of *one* point of the half plane. A chain of such points, its offsets at least d, proves h_M >= d on all of the sector
//! (module `meridian`, whose argument asks nothing else). What is lost is what p varies over the sector: nothing for a p on the axis, and next
//! to nothing near it. So a corner on the axis is done at once, with one sector around all the axis, and a corner d off the axis
//! costs about log2(d / tolerance) halvings near the best azimuth. There is no threshold, hence no cliff.
//!
//! When K turns about an axis b of its own, it contains a circle too: centre q on b, radius r, through p. At azimuth w take in its disc
//!
//! ```text
//! q + r v,    v = k (z - b (b.z)),    z = s e(w) + c a,    k <= 1 / |z - b (b.z)| on all of W
//! ```
//!
//! for the (s, c) that was asked. With g = b.z and t = b.e(w), its radius e.v = k (s - t g) and height a.v = k (c - (a.b) g) vary as t does: by the
//! tilt of b against a, times the width of the sector. The height counts with its lowest value in the upper part of the chain, and
//! with its highest in the lower part: each part has its own.
//!
//! # Around an edge
//!
//! Nothing asks C to turn about a: with the whole point of M in the place of p and no circle, the argument is the same. So where K is a body of
//! revolution and C has an edge that runs nearly along its axis b, the minimisers are nearly the arc of directions across the edge, and the
//! search goes around that: it leaves both ends of the edge exactly where they are, however far from each other, and K's circle is taken
//! in as above. (Around b, each sector would have to be as narrow as the edge's ends are off b.)
//!
//! # Minima over a sector
//!
//! W lies between two unit vectors e, f less than a straight angle apart, so e(w) = (x e + y f) / |x e + y f| with x, y >= 0, and
//! (x + y) cos(half the angle) <= |x e + y f| <= x + y. Hence, with m the lower of v.e and v.f,
//!
//! ```text
//! min over W of v.e(w) >= m  where m >= 0,  else the higher of m / cos(half the angle) and -|v across a|
//! ```
//!
//! Neighbouring sectors share the vector between them, number for number: rounding leaves no gap. (A vector that is off the plane across a, or not quite of
//! unit length, by some roundoffs moves v.e by so many of |v|, which the margin includes: module `depth::arcs`.)
//!
//! # The search
//!
//! Depth first around the circle: first the circle as one sector, then quarters from the best azimuth that is known, halved until the chain of each has offsets that end the query. Every call of
//! the chain is one of M too, and may lower the upper bound. No memory is needed but that of one chain. Directions without an arc, where M is smooth or has corners off the
//! axis, need small sectors; the search gives up after [`CALLS`], and expansion goes on.

mod sector;

use crate::math::{Vector, norm, unit};
use crate::plan::distance::nearest;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::query::Query;
use crate::query::answer::{Answer, Plan, Stop};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::solver::depth::meridian::{across, trace};
use crate::support::Failure;
use heapless::Vec;
use sector::Sector;

/// Support calls that a search may take.
const CALLS: u32 = 2048;

/// Steps of the search for a good azimuth.
const TURNS: usize = 32;

/// How far the directions are leant aside that find both ends of a line.
const LEAN: f64 = 1e-4;

/// A sector of the circle is halved so many times at most.
const HALVINGS: usize = 40;

/// The bodies, as the search sees them.
pub(crate) struct Spin<T: Real> {
    /// The axis to search around, of C or along an edge of it; a unit vector.
    pub axis: Vector<T, 3>,
    /// Does C turn about it?
    pub turns: bool,
    /// Is C the first body?
    pub first: bool,
    /// The anchor of A minus that of B, in the caller's units.
    pub offset: Vector<T, 3>,
    /// The unit axis b of the other body, if it turns about one; with a.b >= 0.
    pub other: Option<Vector<T, 3>>,
}

/// How a search by sectors ended.
pub(crate) enum SectorsEnd<T: Real> {
    /// With the answer.
    Done(Answer<T, 3>),
    /// At a limit.
    Stopped(Stop),
    /// Not at all.
    Failed,
}

/// The sectors that are not done, in their order around the axis: each begins where the one before it ends.
struct Round<T: Real> {
    /// Where the next one begins.
    left: Vector<T, 3>,
    /// Where they end, the next one last; none: the whole circle, which comes first.
    right: Vec<Vector<T, 3>, { HALVINGS + 4 }>,
    /// The lowest offset of those that are done.
    lower: T,
}

impl<T: Real> Round<T> {
    /// The whole circle, from an azimuth.
    fn new(start: Vector<T, 3>) -> Self {
        Self { left: start, right: Vec::new(), lower: T::HUGE }
    }

    fn is_whole(&self) -> bool {
        self.right.is_empty()
    }

    /// The next sector.
    fn sector<'s>(&self, spin: &'s Spin<T>, offset: Vector<T, 3>) -> Sector<'s, T> {
        let left = self.left;
        let (ends, cosine, middle) = match self.right.last() {
            None => ([left, left], T::zero(), left),
            Some(end) => {
                let sum = left + end;
                ([left, *end], norm(&sum) * T::of(0.5), unit(&sum))
            }
        };
        Sector { spin, offset, ends, cosine, middle }
    }

    /// Instead of the whole circle its quarters, from an azimuth.
    fn quarter(&mut self, axis: &Vector<T, 3>, start: Vector<T, 3>) {
        self.left = start;
        let side = unit(&axis.cross(&start));
        for end in [start, -side, -start, side] {
            let _ = self.right.push(end);
        }
    }

    /// Instead of the next sector its halves; false: too often.
    fn halve(&mut self, middle: Vector<T, 3>) -> bool {
        self.right.push(middle).is_ok()
    }

    /// The next sector is done, with this offset. Was it the last one?
    fn done(&mut self, offset: T) -> bool {
        self.lower = self.lower.at_most(offset);
        if let Some(end) = self.right.pop() {
            self.left = end;
        }
        self.right.is_empty()
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// The search around the axis of `spin`. The query's error includes what the axes are off (module `depth`).
    pub(crate) fn search_sectors(
        &mut self,
        query: &mut Query<'_, T, 3>,
        spin: &Spin<T>,
    ) -> Result<SectorsEnd<T>, Failure> {
        let axis = spin.axis;
        let limit = query.support_calls().saturating_add(CALLS);
        let guess = query.first_direction();
        query.support(&guess)?;
        let poles = [query.support(&-axis)?.0, query.support(&axis)?.0];
        if query.is_at_zero() {
            return Ok(SectorsEnd::Failed);
        }
        let offset = spin.offset * query.scale();
        let mut round = Round::new(azimuth(query, &axis));
        loop {
            let sector = round.sector(spin, offset);
            let Some(first) = sector.chain(query, &poles)? else { return Ok(SectorsEnd::Failed) };
            let is_last = match trace(&mut self.polytope, query, &sector, first)? {
                Some(traced) if traced.stop == Stop::Met => round.done(traced.offset),
                Some(traced) if !matches!(traced.stop, Stop::Rounding | Stop::Capacity) => {
                    return Ok(SectorsEnd::Stopped(traced.stop));
                }
                _ if round.is_whole() => {
                    turn_down(query, &axis)?;
                    round.quarter(&axis, azimuth(query, &axis));
                    false
                }
                _ if query.support_calls() > limit || !round.halve(sector.middle) => return Ok(SectorsEnd::Failed),
                _ => false,
            };
            if is_last {
                return self.conclude_sectors(query, &axis, round.lower);
            }
        }
    }

    /// The answer once all sectors are done, `lower` the lowest of their offsets.
    fn conclude_sectors(
        &mut self,
        query: &mut Query<'_, T, 3>,
        axis: &Vector<T, 3>,
        lower: T,
    ) -> Result<SectorsEnd<T>, Failure> {
        if !query.verify()? {
            return Ok(SectorsEnd::Failed);
        }
        let Some(lower) = query.lower_from_offset(lower, query.margin()) else { return Ok(SectorsEnd::Failed) };
        let witness = witness(query, axis)?;
        // Witnesses that are short of the plane by more than the tolerance are none: expansion finds better ones.
        let foot = query.foot().unwrap_or_else(Vector::zeros);
        if !(query.best.direction.dot(&(foot - witness.point())) <= query.slack()) {
            return Ok(SectorsEnd::Failed);
        }
        query.plan = Plan::Meridian;
        let answer = self.report(query, Stop::Met, lower, witness);
        // (What the axes are off is charged in all directions: too much where bodies are uneven.)
        Ok(if answer.outcome.is_inconclusive() { SectorsEnd::Failed } else { SectorsEnd::Done(answer) })
    }
}

/// The azimuth of the best direction.
fn azimuth<T: Real>(query: &Query<'_, T, 3>, axis: &Vector<T, 3>) -> Vector<T, 3> {
    let level = query.best.direction - axis * axis.dot(&query.best.direction);
    if norm(&level) > T::of(0.01) { unit(&(level - axis * axis.dot(&level))) } else { across(axis) }
}

/// Turns the best direction about the axis as long as that lowers the upper bound: the sectors are the fewer, the better it is.
fn turn_down<T: Real>(query: &mut Query<'_, T, 3>, axis: &Vector<T, 3>) -> Result<(), Failure> {
    let mut tangent = T::one();
    for _ in 0..TURNS {
        let (best, before) = (query.best.direction, query.ratio());
        let up = axis * axis.dot(&best);
        let cosine = T::one() / (T::one() + tangent * tangent).root();
        for sign in [T::one(), -T::one()] {
            let level = best - up + axis.cross(&best) * (tangent * sign);
            query.support(&unit(&(up + level * cosine)))?;
        }
        if !(query.ratio() < before) {
            tangent *= T::of(0.5);
        }
    }
    Ok(())
}

/// Points of M around the point where the best direction's plane touches the ball of radius d: first the two ends of what C has there across the
/// arc, a line in most cases, then what a walk finds.
fn witness<T: Real>(query: &mut Query<'_, T, 3>, axis: &Vector<T, 3>) -> Result<Simplex<T, 3>, Failure> {
    let foot = query.foot().unwrap_or_else(Vector::zeros);
    let direction = query.best.direction;
    let near = query.slack() * T::of(0.25);
    let mut ask = |u: &Vector<T, 3>| query.ask(u).map(|vertex| Vertex { point: vertex.point - foot, ..vertex });
    let lean = axis * T::of(LEAN);
    let mut simplex = Simplex::new(ask(&unit(&(direction + lean)))?);
    simplex.push(ask(&unit(&(direction - lean)))?);
    simplex.minimize(T::zero());
    let distance = norm(&simplex.point());
    if distance > near {
        let found = nearest(&direction, None, ask, |_, distance| distance <= near)?;
        if found.distance < distance {
            simplex = found.simplex;
        }
    }
    simplex.translate(&foot);
    Ok(simplex)
}
