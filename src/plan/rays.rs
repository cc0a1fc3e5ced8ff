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

use super::ray::Ray;
use super::shoot::{Shot, shoot};
use crate::answer::Stop;
use crate::bounds::Bracket;
use crate::query::Query;
use crate::scalar::{Real, Vector, finite};
use crate::simplex::Simplex;
use crate::support::Failure;

/// A query that may be cut short begins with a pass to this share of d, for an early lower bound. The last pass is one with room for what the
/// lower bound loses to rounding, where that was too much.
const FIRST_GAP: f64 = 0.5;

/// What the rays have shown.
pub(crate) struct Crossings<T, const N: usize> {
    pub stop: Stop,
    pub lower: T,
    pub witness: Simplex<T, N>,
}

/// d by one ray per vertex of Q. `None` when rays cannot decide: Q is not polytopal, or the origin is not certainly inside A.
#[inline(never)]
pub(crate) fn solve_rays<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
) -> Result<Option<Crossings<T, N>>, Failure> {
    let count = query.rays();
    if count == 0 {
        return Ok(None);
    }
    if !(query.size() > T::zero()) {
        let first = query.first_direction();
        query.support(&first)?; // A does not know its extent: the first corners need a size.
    }
    let mut reserve = T::zero();
    let mut found: Option<Crossings<T, N>> = None;
    for gap in [T::of(FIRST_GAP), T::zero(), T::zero()] {
        if gap > T::zero() && !query.may_be_cut_short() {
            continue;
        }
        let (rays, radius) = match (shoot_all(query, count, gap, reserve), &mut found) {
            (Ok(Some(shot)), _) => shot,
            (Err(failure), None) => return Err(failure),
            // What an earlier pass has shown still holds.
            (Err(Failure(code)), Some(earlier)) => {
                earlier.stop = Stop::Failed(code);
                return Ok(found);
            }
            (Ok(None), None) => return Ok(None),
            (Ok(None), Some(earlier)) => {
                earlier.stop = query.exhausted().unwrap_or(Stop::Rounding);
                return Ok(found);
            }
        };
        let margin = query.margin() + rays.error + rays.least * query.gauge_error();
        let loss = match (query.inner_radius(), radius) {
            (inner, _) if inner > T::zero() => margin / inner,
            (_, Some(radius)) if radius > margin => rays.least * (margin / radius),
            _ => return Ok(found),
        };
        let Some(witness) = rays.witness else { return Ok(found) };
        let lower = rays.least - loss;
        let lower = lower - lower.abs() * (T::count(8) * T::ROUNDOFF);
        if !(lower > T::zero()) {
            return Ok(found);
        }
        let verdict =
            query.verdict(&Bracket { lower, upper: query.upper() }).filter(|_| query.verify().is_ok_and(|held| held));
        found = Some(Crossings { stop: verdict.unwrap_or(Stop::Rounding), lower, witness });
        if verdict.is_some() {
            break;
        }
        reserve = loss * T::of(1.25);
    }
    Ok(found)
}

/// All rays, each until it cannot be the one that counts; and, where Q says nothing about some directions, the radius of a ball in A.
#[allow(clippy::type_complexity)]
fn shoot_all<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    count: usize,
    gap: T,
    reserve: T,
) -> Result<Option<(Rays<T, N>, Option<T>)>, Failure> {
    let mut rays = Rays { least: T::HUGE, error: T::zero(), witness: None };
    let mut last: Option<Ray<T, N>> = None;
    for index in 0..count {
        let target = query.ray(index);
        if !finite(&target) {
            return Err(Failure(crate::NOT_FINITE));
        }
        if target.iter().all(|&x| x == T::zero()) {
            continue; // The origin is in A whenever d >= 0.
        }
        let (ray, shot) =
            shoot(query, &target, last.take(), T::zero(), |query| query.level(gap, reserve + query.reserve(4)))?;
        if matches!(shot, Shot::Stopped(_)) || !rays.take(&ray) {
            return Ok(None);
        }
        last = Some(ray);
    }
    let radius = if query.inner_radius() > T::zero() { None } else { ball_inside(query)? };
    Ok(Some((rays, radius)))
}

/// The least crossing of several rays.
struct Rays<T, const N: usize> {
    least: T,
    /// How far the points may be off A beside the margin.
    error: T,
    witness: Option<Simplex<T, N>>,
}

impl<T: Real, const N: usize> Rays<T, N> {
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

/// Radius of a ball around the origin in A, up to the margin: the points e_i and minus their mean, scaled to their crossings,
/// have it in their hull.
#[inline(never)]
fn ball_inside<T: Real, const N: usize>(query: &mut Query<'_, T, N>) -> Result<Option<T>, Failure> {
    let mut rays = Rays { least: T::HUGE, error: T::zero(), witness: None };
    let root = T::count(N).root();
    // The facet opposite e_k of the simplex { e_i, -(1 .. 1) / sqrt(N) } has the normal with 1 in all places but k.
    let tilt = root + T::count(N - 1);
    let inradius = T::one() / (T::count(N - 1) + tilt * tilt).root();
    // So large that the margin costs a tenth of the tolerance, and never small.
    let costly = query.margin() * query.ratio() / (query.slack() * T::of(0.1)) / inradius;
    let enough = (query.reach() * T::of(0.02)).at_least(costly).at_most(query.reach());
    for index in 0..=N {
        let target = Vector::<T, N>::from_fn(|i, _| match index {
            _ if index == N => -T::one() / root,
            _ if i == index => T::one(),
            _ => T::zero(),
        });
        let (ray, shot) = shoot(query, &target, None, T::of(0.1), |_| enough)?;
        if matches!(shot, Shot::Stopped(_)) || !rays.take(&ray) {
            return Ok(None);
        }
    }
    Ok(Some(rays.least * inradius - rays.error))
}
