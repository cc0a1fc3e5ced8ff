//! A polytopal Q: by rays or by expansion?
//!
//! A ray costs about the same for each vertex of Q, whatever A is like: some steps, most of them ended early by what the rays before have shown.
//! Expansion looks at all vertices for each facet, and how many facets it makes depends on A: ten inside an octahedron, thousands inside a smooth
//! set of dimension 6; nobody knows before it is done. So expansion begins, and may do one and a half times the work that the rays need at least.
//! Then they take turns: rays so much at a time, and expansion a sixteenth of it, then twice that, and in the end as much, since rays that take that long are no better a
//! guess. Both stop where they are and go on from there, and each knows the other's upper bounds.
//!
//! No schedule that does not know how much work the plans need keeps below twice the better one always. This one does nearly always, as long as a
//! support point costs about what it does for a small A.
//!
//! What rays need was measured on octahedra, boxes, ellipsoids and hulls of random points in two to six dimensions, with 1 to 20,000 vertices of
//! Q: between (N + 9) / 4 steps for each and twice as many; more where A is smooth or Q has a few vertices only. (Where Q says nothing about some
//! directions, N + 1 short rays more are needed.)

use super::expansion::Expanded;
use super::rays::{Crossings, RaySearch};
use crate::polytope::Polytope;
use crate::query::answer::{Plan, Stop};
use crate::query::{Query, Work};
use crate::scalar::Real;
use crate::support::Failure;

/// Shares of what rays need at least: how many of them expansion may do at first, and how many rays may do in a turn, and expansion in the end.
const OF: u64 = 16;
const FIRST: u64 = 24;
const TURN: u64 = 16;

/// Which plan has answered.
pub(crate) enum Ended<T, const N: usize> {
    Rays(Crossings<T, N>),
    Expansion(Expanded<T>),
}

/// Expansion from the first simplex, and rays by turns with it, until one of them has an answer.
#[inline(never)]
pub(crate) fn race<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
) -> Result<Ended<T, N>, Failure> {
    let mut rays = RaySearch::new(query);
    let mut turns = Turns { share: (cost(&rays, query) / OF).max(1), surplus: [0; 2], expands: true, expansion: 1 };
    query.work.allow(turns.share.saturating_mul(FIRST));
    loop {
        if turns.expands {
            let expanded = polytope.expand(query);
            match expanded.as_ref().map(|expanded| expanded.stop) {
                Ok(Stop::Turn) => {}
                Ok(Stop::Rounding | Stop::Capacity) => return second(polytope, query, expanded?, &mut rays),
                _ => {
                    rays.keep(query);
                    return expanded.map(Ended::Expansion);
                }
            }
        } else if rays.advance(query)? {
            query.work.allow(u64::MAX);
            if let Some(rays) = told(polytope, query, &mut rays)? {
                return Ok(Ended::Rays(rays));
            }
            let expanded = polytope.expand(query)?;
            return match expanded.stop {
                Stop::Rounding | Stop::Capacity => last(polytope, query, expanded, &mut rays),
                _ => Ok(Ended::Expansion(expanded)),
            };
        }
        let turn = turns.pass(query.work.surplus());
        query.work.allow(turn);
    }
}

/// Whose turn it is. A plan stops where it can; what it has done too much by then is missing in its next turn.
struct Turns {
    share: u64,
    surplus: [u64; 2],
    expands: bool,
    /// How many shares expansion may do in its next turn.
    expansion: u64,
}

impl Turns {
    /// The turn is over. How much work is the next one?
    fn pass(&mut self, surplus: u64) -> u64 {
        let [expansion, rays] = &mut self.surplus;
        *(if self.expands { expansion } else { rays }) = surplus;
        loop {
            self.expands = !self.expands;
            let shares = if self.expands { self.expansion } else { TURN };
            if self.expands {
                self.expansion = TURN.min(self.expansion * 2);
            }
            let [expansion, rays] = &mut self.surplus;
            let surplus = if self.expands { expansion } else { rays };
            let turn = self.share.saturating_mul(shares);
            if *surplus < turn {
                return turn - core::mem::take(surplus);
            }
            *surplus -= turn;
        }
    }
}

/// Rays alone, where A is flat: they end where it ends along each. `None` where they do not decide the query.
#[inline(never)]
pub(crate) fn by_rays<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
) -> Result<Option<Crossings<T, N>>, Failure> {
    let mut rays = RaySearch::new(query);
    rays.advance(query)?;
    Ok(decided(query, &mut rays))
}

/// The answer after an expansion that memory or rounding has ended: rays need no memory, and may lose less to rounding.
fn second<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    expanded: Expanded<T>,
    rays: &mut RaySearch<T, N>,
) -> Result<Ended<T, N>, Failure> {
    query.work.allow(u64::MAX);
    match polytope.widen(query, expanded.stop, expanded.key) {
        Ok(false) => {}
        widened => {
            rays.keep(query);
            return widened.map(|_| Ended::Expansion(expanded));
        }
    }
    rays.advance(query)?;
    match told(polytope, query, rays)? {
        Some(rays) => Ok(Ended::Rays(rays)),
        None => last(polytope, query, expanded, rays),
    }
}

/// Neither plan has an answer. Where rays were given up on their way, they are shot once more, with patience.
fn last<T: Real, const N: usize>(
    polytope: &mut Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    expanded: Expanded<T>,
    rays: &mut RaySearch<T, N>,
) -> Result<Ended<T, N>, Failure> {
    if !rays.upper_is_found && !query.is_spent() && query.stopped().is_none() {
        query.is_patient = true;
        rays.restart();
        rays.advance(query)?;
        if let Some(rays) = told(polytope, query, rays)? {
            return Ok(Ended::Rays(rays));
        }
    }
    // (After a limit nothing is asked that would not be asked after a later one.)
    let end = if query.is_spent() && query.verify()? { Some(Stop::Zero) } else { query.stopped() };
    Ok(Ended::Expansion(Expanded { stop: end.unwrap_or(expanded.stop), ..expanded }))
}

/// Rays that have decided the query. Where A ends next to the origin and the upper end is found, nothing is left for expansion either: others have
/// decided it then, too.
fn told<T: Real, const N: usize>(
    polytope: &Polytope<'_, T, N>,
    query: &mut Query<'_, T, N>,
    rays: &mut RaySearch<T, N>,
) -> Result<Option<Crossings<T, N>>, Failure> {
    if let Some(found) = decided(query, rays) {
        return Ok(Some(found));
    }
    if !rays.upper_is_found || query.is_spent() || !polytope.ends_near_origin(query)? {
        return Ok(None);
    }
    query.spend();
    Ok(decided(query, rays))
}

/// Rays that have decided the query; of others the lower bound is kept.
fn decided<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    rays: &mut RaySearch<T, N>,
) -> Option<Crossings<T, N>> {
    let found = rays.found.as_ref().filter(|found| query.still_holds(found.reach))?;
    match found.stop {
        // Where rounding cost the rays too much, expansion loses less, unless there is nothing left for it.
        Stop::Rounding if !query.is_spent() => {}
        // Where they were cut short, expansion may know more.
        Stop::Iterations | Stop::Interrupted => query.plan = Plan::Rays,
        _ => {
            query.plan = Plan::Rays;
            return rays.found.take();
        }
    }
    query.raise(found.lower, found.reach);
    None
}

/// What the rays may cost.
fn cost<T: Real, const N: usize>(rays: &RaySearch<T, N>, query: &Query<'_, T, N>) -> u64 {
    let unit = if query.spares_unit() { 0 } else { query.work.unit() };
    rays.left(query).saturating_mul((N as u64 + 9) * (Work::<N>::STEP + unit)) / 4
}
