//! Polytopal Q: one convex problem per vertex of Q instead of a hull.
//!
//! λQ lies in A when λ times each vertex of Q does, so d is the smallest of the crossings t_v of the rays along the vertices
//! ([`ray`](super::ray)). Every plane that a ray meets bounds d by h_A / h_Q with the whole of Q in the denominator, so one ray's upper bounds
//! end the others early: a ray is done when its crossing is beyond what the tolerance asks of the best bound so far.
//!
//! # The lower bound
//!
//! The crossings are those of points near A: with m the support function's error, the rounding and what [`Ray::reach`]
//! measures (and t_v times the error of v, as Q tells it), t_v v is in A + mB for every vertex v; let λ = min t_v.
//!
//! * Q contains a ball of radius ρ around the origin: then λQ is in A + mB, and mB in (m/ρ)Q. What is added to both sides of an
//!   inclusion of compact convex sets can be taken away again, so d >= λ - m/ρ.
//! * Otherwise Q (a segment, say) says nothing about the other directions, and A must have a margin of its own: rays along the axes
//!   and back along their mean show a ball of radius r in A + mB, so A contains the ball of radius
//!   r - m, and the convex combination of λv + mB and that ball puts λ (1 - m / r) v in A.
//! * The origin may lie on the boundary of A, without a margin. Where A contains it by definition
//!   ([`contains_origin`](crate::support::Support::contains_origin)), balls of radius r around the points s v of the rays do: the same
//!   combination puts (λ - (λ - s) m / r) v in A, and the segment from there to the origin is in A because both ends are. (r is concave along a ray, so
//!   the nearer s to λ, the less is lost, as long as r is well above m.) A ray along the boundary of A has no such ball: how much of it is in A
//!   is not for arithmetic to tell, and the answer is that 0 <= d <= λ.

use super::ray::Ray;
use super::shoot::{Shot, shoot, shoot_from};
use crate::bounds::Bracket;
use crate::math::{Vector, finite};
use crate::polytope::simplex::Simplex;
use crate::query::Query;
use crate::query::answer::Stop;
use crate::scalar::Real;
use crate::support::Failure;
use crate::support::failure::NOT_FINITE;

/// A query that may be cut short begins with a pass to this share of d, for an early lower bound. The last pass is one with room for what the
/// lower bound loses to rounding, where that was too much.
const FIRST_GAP: f64 = 0.5;

/// Where balls are looked for when there is none around the origin: s / λ.
const FAR: f64 = 0.96875;

/// What the rays have shown.
pub(crate) struct Crossings<T, const N: usize> {
    pub stop: Stop,
    pub lower: T,
    pub witness: Simplex<T, N>,
    /// The largest norm of a point until then.
    pub reach: T,
}

/// Vertices of Q that are the origin, between two questions for the caller's deadline.
const IDLE: usize = 1024;

/// d by one ray per vertex of Q: as far as it has come.
pub(crate) struct RaySearch<T, const N: usize> {
    count: usize,
    /// This pass: the share of d that it leaves open, and what it has shown. The next vertex, and the last ray.
    gap: T,
    rays: Rays<T, N>,
    index: usize,
    last: Option<Ray<T, N>>,
    /// What the lower bound loses to rounding.
    reserve: T,
    /// Is this the pass that knows that?
    again: bool,
    /// The origin is on the boundary of A, up to rounding.
    at_edge: bool,
    /// Have all rays been shot as far as the tolerance asks? Then the upper end is found, whatever the lower one loses.
    pub upper_is_found: bool,
    /// What the passes before have shown; nothing when they cannot decide, as the origin is not certainly inside A.
    pub found: Option<Crossings<T, N>>,
}

impl<T: Real, const N: usize> RaySearch<T, N> {
    /// Nothing is shot yet. A has been asked for its first points.
    pub fn new(query: &Query<'_, T, N>) -> Self {
        RaySearch {
            count: query.rays(),
            gap: if query.may_be_cut_short() { T::of(FIRST_GAP) } else { T::zero() },
            rays: Rays::new(),
            index: 0,
            last: None,
            reserve: T::zero(),
            again: false,
            at_edge: false,
            upper_is_found: false,
            found: None,
        }
    }

    /// Rays left, if this pass is the last, or the next one where this is for an early bound. (Those around the origin are short.)
    pub fn left(&self, query: &Query<'_, T, N>) -> u64 {
        let around = if query.inner_radius() > T::zero() { 0 } else { N.div_ceil(2) };
        let again = if self.gap > T::zero() { self.count.saturating_add(around) } else { 0 };
        self.count.saturating_sub(self.index).saturating_add(around).saturating_add(again) as u64
    }

    /// Goes on, for one ray at least, until the turn is over. Is that the end?
    #[inline(never)]
    pub fn advance(&mut self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        if !(query.size() > T::zero()) {
            return Ok(true); // A is the origin, as far as it was asked: no size for the first corners.
        }
        let ends = self.shoot_passes(query).inspect_err(|_| self.keep(query))?;
        // A limit that was met while the cost of the margin was looked for is one, too.
        if let Some(found) = self.found.as_mut().filter(|found| found.stop == Stop::Rounding) {
            found.stop = query.stopped().unwrap_or(Stop::Rounding);
        }
        Ok(ends)
    }

    /// What has been shown holds, whatever else ends the query.
    pub fn keep(&self, query: &mut Query<'_, T, N>) {
        if let Some(found) = &self.found {
            query.raise(found.lower, found.reach);
        }
    }

    /// Pass after pass.
    fn shoot_passes(&mut self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        loop {
            let ended = match self.shoot_pass(query)? {
                Shot::Again => continue,
                Shot::Stopped(Stop::Turn) => return Ok(false),
                Shot::Hit => {
                    if self.at_edge && query.stopped().is_none() {
                        query.spend(); // No surface around the origin proves more.
                    }
                    return Ok(true);
                }
                shot => {
                    if matches!(shot, Shot::Left) {
                        query.spend();
                    }
                    query.exhausted().unwrap_or(Stop::Rounding)
                }
            };
            // What an earlier pass has shown still holds.
            self.found.iter_mut().for_each(|earlier| earlier.stop = ended);
            return Ok(true);
        }
    }

    /// The rays of this pass, and what they show. `Again`: another one follows.
    fn shoot_pass(&mut self, query: &mut Query<'_, T, N>) -> Result<Shot, Failure> {
        let shot = self.shoot_all(query)?;
        match self.verify(query, shot)? {
            // What a shortcut showed is no end of A: from now on there are none.
            Shot::Again => {
                self.restart();
                Ok(Shot::Again)
            }
            Shot::Hit if !self.conclude(query)? => Ok(Shot::Again),
            shot => Ok(shot),
        }
    }

    /// This pass anew.
    pub fn restart(&mut self) {
        (self.rays, self.index, self.last, self.upper_is_found) = (Rays::new(), 0, None, false);
    }

    /// Does A end where a ray says so, without its shortcuts?
    fn verify(&self, query: &mut Query<'_, T, N>, shot: Shot) -> Result<Shot, Failure> {
        let ends = matches!(shot, Shot::Left | Shot::Stopped(Stop::Zero));
        Ok(if ends && !query.verify()? { Shot::Again } else { shot })
    }

    /// The rays of this pass, each until it cannot be the one that counts.
    fn shoot_all(&mut self, query: &mut Query<'_, T, N>) -> Result<Shot, Failure> {
        while let Some(target) = next_target(query, &mut self.index, self.count)? {
            let (gap, reserve) = (self.gap, self.reserve);
            let level = move |query: &Query<'_, T, N>| query.level(gap, reserve + query.reserve(4));
            let (ray, shot) = shoot(query, &target, self.last.take(), T::zero(), &level)?;
            if !matches!(shot, Shot::Hit) {
                return Ok(shot);
            }
            if !self.rays.take(&ray) {
                return Ok(Shot::Stopped(Stop::Rounding));
            }
            self.last = Some(ray);
            if query.work.is_over() && self.index < self.count {
                return Ok(Shot::Stopped(Stop::Turn));
            }
        }
        Ok(query.stopped().map_or(Shot::Hit, Shot::Stopped))
    }

    /// What this pass has shown: is that the end?
    fn conclude(&mut self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        let rays = core::mem::replace(&mut self.rays, Rays::new());
        self.upper_is_found |= !(self.gap > T::zero());
        let Some(witness) = rays.witness else { return Ok(true) };
        let Some(loss) = self.cost_of_margin(query, rays.least, rays.error)? else {
            // The upper end is found as well as asked for all the same.
            (self.gap, self.index, self.last) = (T::zero(), 0, None);
            return Ok(self.upper_is_found);
        };
        let lower = rays.least - loss;
        let lower = lower - lower.abs() * (T::count(8) * T::ROUNDOFF);
        if !(lower > T::zero()) {
            return Ok(true);
        }
        let verdict =
            query.verdict(&Bracket { lower, upper: query.upper() }).filter(|_| query.verify().is_ok_and(|held| held));
        self.found = Some(Crossings { stop: verdict.unwrap_or(Stop::Rounding), lower, witness, reach: query.reach() });
        let is_last = self.again;
        self.again = !(self.gap > T::zero());
        (self.gap, self.reserve) = (T::zero(), loss * T::of(1.25));
        (self.index, self.last) = (0, None);
        Ok(verdict.is_some() || is_last)
    }

    /// What the margin costs of the least crossing (see above), whose points may be off by `error` beside; `None` when nothing of it is certain.
    fn cost_of_margin(&mut self, query: &mut Query<'_, T, N>, least: T, error: T) -> Result<Option<T>, Failure> {
        // Taken after the last question of each kind: where A does not know its extent, the margin is one of the points that were seen.
        let margin = |query: &Query<'_, T, N>| query.margin() + error + least * query.unit_error();
        let inner = query.inner_radius();
        if inner > T::zero() {
            return Ok(Some(margin(query) / inner));
        }
        let ball = ball_inside(query, &Vector::zeros(), T::one())?;
        // (Where A ends within the margin, each surface has a facet that may be at the origin.)
        self.at_edge = ball.as_ref().is_some_and(|ball| ball.shortest <= query.margin());
        let radius = ball.map(|ball| ball.radius);
        let around = |query: &Query<'_, T, N>| {
            let margin = margin(query);
            radius.filter(|&radius| radius > margin).map(|radius| least * (margin / radius))
        };
        let known = around(query);
        if !query.contains_origin() || known.is_some_and(|loss| loss <= query.slack() * T::of(0.25)) {
            return Ok(known);
        }
        let rest = T::one() - T::of(FAR);
        let along = balls_along(query, self.count, least * T::of(FAR), rest)?;
        // (What is seen from elsewhere is rounded once more.)
        let margin = margin(query) + query.resolution();
        let along = along.filter(|&radius| radius > margin).map(|radius| least * rest * (margin / radius));
        Ok(around(query).into_iter().chain(along).reduce(T::at_most))
    }
}

/// The next vertex of Q that is not the origin, which is in A whenever d >= 0. `None` after the last, and where the caller has no more time.
fn next_target<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    index: &mut usize,
    count: usize,
) -> Result<Option<Vector<T, N>>, Failure> {
    while *index < count {
        if *index > 0 && (*index).is_multiple_of(IDLE) && query.interrupted().is_some() {
            return Ok(None);
        }
        let target = query.ray(*index);
        *index += 1;
        query.work.add(1);
        if !finite(&target) {
            return Err(Failure(NOT_FINITE));
        }
        if target.iter().any(|&x| x != T::zero()) {
            return Ok(Some(target));
        }
    }
    Ok(None)
}

/// The least radius of the balls in A, up to the margin, around the points at `distance` on all rays.
fn balls_along<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    count: usize,
    distance: T,
    rest: T,
) -> Result<Option<T>, Failure> {
    let (mut radius, mut index) = (T::HUGE, 0);
    while let Some(target) = next_target(query, &mut index, count)? {
        let Some(own) = ball_inside(query, &(target * distance), rest)? else { return Ok(None) };
        radius = radius.at_most(own.radius);
    }
    Ok((query.stopped().is_none()).then_some(radius))
}

/// The least crossing of several rays.
struct Rays<T, const N: usize> {
    least: T,
    /// How far the points may be off A beside the margin.
    error: T,
    witness: Option<Simplex<T, N>>,
}

impl<T: Real, const N: usize> Rays<T, N> {
    fn new() -> Self {
        Rays { least: T::HUGE, error: T::zero(), witness: None }
    }

    fn take(&mut self, ray: &Ray<T, N>) -> bool {
        let Some((t, miss)) = ray.reach().filter(|(t, miss)| t.finite() && miss.finite()) else { return false };
        self.error = self.error.at_least(miss);
        if t < self.least {
            self.least = t;
            self.witness = Some(ray.simplex());
        }
        true
    }
}

/// A ball around a point in A.
struct Inside<T> {
    /// Its radius, up to the margin.
    radius: T,
    /// The shortest way out of A that was met.
    shortest: T,
}

/// A ball around `center` in A: the points e_i and minus their mean, scaled to their crossings, have it in their hull. Both lengths are 0
/// where A ends at the center. What the margin costs is this share `rest` of d times margin over radius.
#[inline(never)]
fn ball_inside<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    center: &Vector<T, N>,
    rest: T,
) -> Result<Option<Inside<T>>, Failure> {
    let mut rays = Rays::new();
    let root = T::count(N).root();
    // The facet opposite e_k of the simplex { e_i, -(1 .. 1) / sqrt(N) } has the normal with 1 in all places but k.
    let tilt = root + T::count(N - 1);
    let inradius = T::one() / (T::count(N - 1) + tilt * tilt).root();
    // So large that the margin costs a tenth of the tolerance, and never small.
    let costly = query.margin() * query.ratio() / (query.slack() * T::of(0.1)) / inradius;
    let enough = (query.reach() * T::of(0.02)).at_least(costly).at_most(query.reach()) * rest;
    for index in 0..=N {
        let target = Vector::<T, N>::from_fn(|i, _| match index {
            _ if index == N => -T::one() / root,
            _ if i == index => T::one(),
            _ => T::zero(),
        });
        let (ray, shot) = shoot_from(query, center, &target, T::of(0.1), &|_| enough)?;
        if matches!(shot, Shot::Left) {
            return Ok(Some(Inside { radius: T::zero(), shortest: T::zero() }));
        }
        if !matches!(shot, Shot::Hit) || !rays.take(&ray) {
            return Ok(None);
        }
    }
    Ok(Some(Inside { radius: rays.least * inradius - rays.error, shortest: rays.least }))
}
