//! A polytopal Q: by rays or by expansion?
//!
//! Rays cost about the same for each vertex of Q, whatever A is like; expansion looks at all vertices for each facet, and how many facets it makes
//! depends on A: ten inside an octahedron, thousands inside a smooth set of dimension 6. Which of the two is cheaper is guessed from the first ray, and a
//! wrong guess is not paid for long:
//!
//! * **Guess.** The first ray takes k steps from nothing to its end: the more, the more facets A has where they count. Expansion
//!   makes about k^2 of them; in five and six dimensions k^3 / N, unless the ray has ended on a facet of A itself (measured on
//!   octahedra, random points, boxes, ellipsoids and wrench sets: mostly within a factor of 3). Later rays start from the simplex before and take
//!   about k / 3 + 3 steps; where Q says nothing about some directions, N + 1 more rays are needed.
//! * **Few vertices**, no more than a box of six dimensions has, are left to the rays, which take no memory of the workspace.
//! * **Turns.** The plan that is expected to be cheaper begins, and may do as much work as the other is expected to need. Then the
//!   other has its turn, and so on, each with twice as much as before. Both stop where they are and go on from there, and each
//!   knows the other's upper bounds.

use super::expansion::Expanded;
use super::rays::{Crossings, RaySearch};
use crate::answer::{Plan, Stop};
use crate::polytope::Polytope;
use crate::query::{Query, Work};
use crate::scalar::Real;
use crate::support::Failure;

/// So many vertices of Q are left to the rays.
const FEW: usize = 64;

/// Which plan has answered.
pub(crate) enum Ended<T, const N: usize> {
    Rays(Crossings<T, N>),
    Expansion(Expanded<T>),
}

/// Rays and expansion by turns, from the first simplex, until one of them has an answer.
#[inline(never)]
pub(crate) fn race<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
) -> Result<Ended<T, N>, Failure> {
    let mut rays = RaySearch::new(query)?;
    if query.rays() <= FEW {
        query.work.allow(u64::MAX);
        let found = rays.advance(query)?.flatten();
        return finish(polytope, query, found);
    }
    let before = query.support_calls();
    query.work.allow(0); // one ray
    if let Some(found) = rays.advance(query)? {
        return finish(polytope, query, found);
    }
    let steps = u64::from(query.support_calls() - before);
    let by_rays = rays.left(query).saturating_mul(ray_cost(steps, query));
    let by_expansion = expansion_cost::<N>(steps, rays.landed(), query.work.gauge());
    let mut share = by_rays.max(by_expansion);
    let mut expands = by_expansion < by_rays;
    loop {
        query.work.allow(share);
        if expands {
            let expanded = polytope.expand(query)?;
            match expanded.stop {
                Stop::Turn => {}
                Stop::Rounding | Stop::Capacity => return second(polytope, query, expanded, rays),
                _ => return Ok(Ended::Expansion(expanded)),
            }
        } else if let Some(found) = rays.advance(query)? {
            return finish(polytope, query, found);
        }
        expands = !expands;
        share = share.saturating_mul(2);
    }
}

/// The answer after the rays' end.
fn finish<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    found: Option<Crossings<T, N>>,
) -> Result<Ended<T, N>, Failure> {
    query.work.allow(u64::MAX);
    match decided(query, found) {
        Some(rays) => Ok(Ended::Rays(rays)),
        None => polytope.expand(query).map(Ended::Expansion),
    }
}

/// The answer after an expansion that memory or rounding has ended: rays need no memory, and may lose less to rounding.
fn second<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    expanded: Expanded<T>,
    mut rays: RaySearch<T, N>,
) -> Result<Ended<T, N>, Failure> {
    query.work.allow(u64::MAX);
    if !polytope.widen(query, expanded.stop, expanded.key)? {
        let found = rays.advance(query)?.flatten();
        if let Some(rays) = decided(query, found) {
            return Ok(Ended::Rays(rays));
        }
    }
    Ok(Ended::Expansion(expanded))
}

/// Rays that have decided the query; of others the lower bound is kept.
fn decided<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    found: Option<Crossings<T, N>>,
) -> Option<Crossings<T, N>> {
    let rays = found?;
    match rays.stop {
        // Where rounding cost the rays too much, expansion loses less, unless there is nothing left for it.
        Stop::Rounding if !query.is_spent() => {}
        // Where they were cut short, expansion may know more.
        Stop::Iterations | Stop::Interrupted => query.plan = Plan::Rays,
        _ => {
            query.plan = Plan::Rays;
            return Some(rays);
        }
    }
    query.raise(rays.lower);
    None
}

/// What another ray may cost where the first has taken so many steps.
fn ray_cost<T: Real, const N: usize>(steps: u64, query: &Query<'_, T, N>) -> u64 {
    let gauge = if query.spares_gauge() { 0 } else { query.work.gauge() };
    (steps / 3 + 3).saturating_mul(Work::<N>::STEP + gauge)
}

/// What expansion may cost then.
fn expansion_cost<const N: usize>(steps: u64, landed: bool, gauge: u64) -> u64 {
    let square = steps * steps;
    let facets = if N < 5 || landed { square } else { square * steps / N as u64 };
    facets.saturating_mul(Work::<N>::FACET + gauge)
}
