//! Conewise expansion: d_Q in any memory.
//!
//! A polytope inside a smooth A of dimension 6 needs tens of thousands of facets for three digits. But d is a minimum over
//! directions, and directions can be searched one cone after the other ([`cone`](super::cone)): in the cone C with generators G,
//!
//! ```text
//! min over u in C of h_A(u) / h_Q(u) = min over c >= 0 of h_{G^T A}(c) / h_{G^T Q}(c)
//! ```
//!
//! which the same expansion bounds from below with a polyhedron that is open towards -infinity in every coordinate
//! (`polytope::orthant`): the walls of the cone are rays that belong to it from the start. A cone is done as soon as its lowest
//! facet is near enough to the best upper bound *of all cones*, so most take a handful of points. One that
//! fills the memory is halved between the two generators that divide its unfinished facets most evenly, and both halves start anew:
//! that is complete in any memory that holds the first few steps, since in a cone that is narrow enough one point is.
//!
//! Half a search adds nothing to the lower bound, so there are passes over all cones, at gaps that shrink to the one asked for. A run
//! that is cut short keeps the lower bound of the last completed pass. Where A and Q are both unchanged when some coordinates change
//! sign, so are the cones, and one of each kind is searched.
//!
//! # The lower bound
//!
//! Let every facet F have a normal c_F >= 0 with c_F.x >= e_F for its finite vertices x, and zeros where its rays point. Then every point of F, rays included,
//! has c_F.x >= e_F.
//!
//! 1. The surface is a closed cycle (up to infinity), made from that of one point's orthant by replacing patches with cones over their
//!    boundaries. A patch has finite vertices only or with rays, never the facet at infinity; so what lies between patch and cone goes
//!    to infinity in fewer than N of the directions -e_i, and a line in the direction (1, .., 1) crosses the two together an even number of times. So
//!    every such line crosses the surface an odd number of times, as it did the first.
//! 2. Let λ h_Q(c_F) < e_F for all F. Then the half line from a point q of λQ in the direction -(1, .., 1) misses all facets: c_F.x <= c_F.q < e_F on
//!    it, as c_F >= 0.
//! 3. Were there a c >= 0 with c.v < c.q for all vertices v, the half line in the direction (1, .., 1) would miss them too, and the whole
//!    line would cross nothing. So max over v of c.v >= λ h_Q(c): for every direction of the cone, h_A >= λ h_Q.
//!
//! Neither convexity of the surface nor the accuracy of c_F is used, nor that the origin is inside A: it is when λ > 0. As in
//! [`bounds`](crate::bounds), λQ stands for λQ + mB where heights are known up to m; here m counts three times (|c|_1 <= sqrt(6) |c|), and
//! once more for each halving (module `cone`; that u = G c is rounded in h_Q(u) is less, as λ times the size of Q is at most that of A).
//!
//! # What was tried and lost
//!
//! Facets made for the paper's grasp a1 at 1e-4 (lowest facet first: 100 %): last made first 103 to 119 %; first made first 135 %; at random 117 to 120 %.
//! Halving between the generators that divide the unfinished facets most evenly, however near to each other: never ends, as
//! cones become flat instead of narrow. Expansion that starts from the simplex which the polar iteration pierces at a local
//! minimum: 0.2 to 3 times the time of ten grasps, about 1 in the median, and slivers that leave the origin on the surface.
//!
//! Not tried: Newton's iteration on the active set for the upper bound, which needs derivatives of the support mapping that a set does not
//! give (the polar iteration ends within the tolerance of a local minimum; its error counts squared); and curvature beyond the ball that rolls inside an
//! ellipsoid, which is taken out exactly. A wrench set has no such ball: its primitives are cones over discs of three dimensions in six.

use super::cone::Cone;
use super::expansion::Expanded;
use super::shoot::{Shot, descend, shoot};
use crate::bounds::Bracket;
use crate::math::{Vector, norm};
use crate::polytope::simplex::{Simplex, Vertex};
use crate::polytope::{Facet, Insertion, Polytope};
use crate::query::Query;
use crate::query::answer::Stop;
use crate::scalar::Real;
use crate::support::Failure;
use heapless::Vec;

/// The gap of the first pass, as a share of d: cheap, and a lower bound.
const FIRST_GAP: f64 = 0.5;
/// How much smaller the gap of the next pass is, for a query that may be cut short and for one that may not. (Time of six grasps at 1e-4 and
/// 2,048 facets, against 16: with 4, 1.43; with 8, 1.13; with 64, 0.83; with 1,024, that is without passes in between, 0.73.)
const NARROWINGS: [f64; 2] = [8.0, 64.0];
/// Directions from which upper bounds are sought before the first pass.
const STARTS: usize = 4;

/// What the passes have shown.
pub(crate) struct Cones<T, const N: usize> {
    pub stop: Stop,
    /// The lower bound; -HUGE: none.
    pub lower: T,
    pub witness: Simplex<T, N>,
    /// Cones in the last completed pass, and the most halvings in any.
    pub cones: u32,
    pub splits: u32,
}

/// One pass over all cones.
struct Pass<T, const N: usize> {
    lower: T,
    witness: Option<Simplex<T, N>>,
    cones: u32,
    splits: u32,
}

/// How a cone ended.
enum End<T> {
    /// The key of its lowest facet.
    Done(T),
    /// The memory is full; the generators between which to halve.
    Full(usize, usize),
    Stopped(Stop),
}

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// Searches cone by cone after the expansion that is still in memory; `None` when there is too little of it for a start.
    pub(crate) fn conewise(&mut self, query: &mut Query<'_, T, N>, expanded: &Expanded<T>) -> Option<Cones<T, N>> {
        if !self.holds_cones() {
            return None;
        }
        let lower = self.lower(query, expanded.key).unwrap_or(-T::HUGE);
        let witness = self.touching_simplex(query, expanded.facet.filter(|_| query.ball.is_some()));
        let mut found = Cones { stop: Stop::Capacity, lower, witness, cones: 0, splits: 0 };
        let searched = self.descend_from_lowest(query).and_then(|stop| match stop {
            Some(stop) => {
                found.stop = stop;
                Ok(())
            }
            None => self.passes(query, &mut found).and_then(|()| touch(query, &mut found)),
        });
        if let Err(Failure(code)) = searched {
            found.stop = Stop::Failed(code);
        }
        Some(found)
    }

    /// The polar power iteration from the best direction and the normals of the lowest facets.
    #[inline(never)]
    fn descend_from_lowest(&mut self, query: &mut Query<'_, T, N>) -> Result<Option<Stop>, Failure> {
        let mut starts = Vec::<Vector<T, N>, STARTS>::new();
        let _ = starts.push(query.best.direction);
        for _ in 0..16 * STARTS {
            let lowest = self.pop_lowest().and_then(|(_, index)| self.facet(index));
            let Some(Facet { normal, .. }) = lowest else { break };
            if starts.iter().all(|u| u.dot(normal) < T::of(0.95)) && starts.push(*normal).is_err() {
                break;
            }
        }
        for start in &starts {
            let stop = descend(query, start)?;
            if stop.is_some() {
                return Ok(stop);
            }
        }
        Ok(None)
    }

    /// Passes at shrinking gaps.
    #[inline(never)]
    fn passes(&mut self, query: &mut Query<'_, T, N>, found: &mut Cones<T, N>) -> Result<(), Failure> {
        let mirrors = query.mirrors();
        let [often, seldom] = NARROWINGS;
        let narrowing = T::of(if query.may_be_cut_short() { often } else { seldom });
        let mut gap = T::of(FIRST_GAP);
        loop {
            let is_last = query.level(gap, T::zero()) >= query.level(T::zero(), T::zero());
            // The last one has room for what rounding takes of the lower bound.
            let level = if is_last { gap * T::of(0.25) } else { gap };
            let pass = match self.pass(query, level, mirrors)? {
                Ok(pass) => pass,
                Err(stop) => {
                    found.stop = stop;
                    return Ok(());
                }
            };
            (found.cones, found.splits) = (pass.cones, found.splits.max(pass.splits));
            if pass.lower > found.lower {
                found.lower = pass.lower;
                if let Some(witness) = pass.witness {
                    found.witness = witness;
                }
            }
            let verdict = query.verdict(&Bracket { lower: found.lower, upper: query.upper() });
            if let Some(stop) = verdict.or_else(|| is_last.then_some(Stop::Rounding))
                && query.verify()?
            {
                found.stop = stop;
                return Ok(());
            }
            gap = next_gap(query, gap, narrowing);
        }
    }

    /// Searches all cones, those that hold the best direction first; `mirrors` tells which orthants are images of others.
    fn pass(&mut self, query: &mut Query<'_, T, N>, gap: T, mirrors: u64) -> Result<Result<Pass<T, N>, Stop>, Failure> {
        let mut pass = Pass { lower: T::HUGE, witness: None, cones: 0, splits: 0 };
        let first = Cone::<N>::orthant_of(&query.best.direction);
        for orthant in (0..Cone::<N>::ORTHANTS).filter(|&o| (0..o).all(|other| mirrors >> (o ^ other) & 1 == 0)) {
            let mut cone = Cone::<N>::new(orthant ^ first);
            loop {
                match self.expand_cone(query, &cone, gap)? {
                    End::Done(key) => {
                        pass.cones = pass.cones.saturating_add(1);
                        let margin = query.margin() * T::count(3 + cone.depth());
                        let lower = self.lower_up_to(query, key, margin).unwrap_or(-T::HUGE);
                        if lower < pass.lower {
                            pass.lower = lower;
                            pass.witness = self.cone_witness(&cone);
                        }
                        if !cone.advance() {
                            break;
                        }
                    }
                    End::Full(i, j) if cone.split(i, j) => pass.splits = pass.splits.max(cone.depth() as u32),
                    End::Full(..) => return Ok(Err(Stop::Capacity)),
                    End::Stopped(stop) => return Ok(Err(stop)),
                }
            }
        }
        Ok(Ok(pass))
    }

    /// Algorithm 1 in one cone, until no facet is below the level of this gap.
    #[inline(never)]
    fn expand_cone(&mut self, query: &mut Query<'_, T, N>, cone: &Cone<N>, gap: T) -> Result<End<T>, Failure> {
        // Margins of the lower bound, and one for the upper.
        let margins = 4 + cone.depth();
        let level = |query: &Query<'_, T, N>| query.level(gap, query.reserve(margins));
        if let Some(stop) = query.exhausted() {
            return Ok(End::Stopped(stop));
        }
        let center = cone.direction(&Vector::repeat(T::one()));
        let center = center * (T::one() / norm(&center));
        let (apex, height) = query.support(&center)?;
        if query.is_outside(&center, height) {
            return Ok(End::Stopped(Stop::Outside));
        }
        let within = |v: Vertex<T, N>| Vertex { point: cone.coordinates(&v.point), ..v };
        if self.make_orthant(within(apex)).is_none() {
            return Ok(End::Stopped(Stop::Capacity));
        }
        // The lowest key of a facet that is not queued.
        let mut final_key = T::HUGE;
        self.rate_cone(query, cone, level(query), &mut final_key)?;
        while let Some((key, index)) = self.pop_lowest() {
            if key >= level(query) {
                return Ok(End::Done(final_key.at_most(key)));
            }
            if let Some(stop) = query.exhausted() {
                return Ok(End::Stopped(stop));
            }
            let Some(&Facet { normal, offset, .. }) = self.facet(index) else { break };
            let direction = cone.direction(&normal);
            let (vertex, height) = query.support(&direction)?;
            if query.is_outside(&direction, height) {
                return Ok(End::Stopped(Stop::Outside));
            }
            if query.is_below() {
                return Ok(End::Stopped(Stop::Below));
            }
            if query.is_at_zero() {
                return Ok(End::Stopped(Stop::Rounding));
            }
            // Heights in the cone, to which the points were brought: those count for the facets.
            let vertex = within(vertex);
            let tolerance = self.resolution().at_least(query.resolution());
            if normal.dot(&vertex.point) - offset <= tolerance {
                // On the boundary of A: nothing raises this facet.
                final_key = final_key.at_most(key);
                continue;
            }
            match self.insert(index, vertex, tolerance) {
                Some(Insertion::Done) => self.rate_cone(query, cone, level(query), &mut final_key)?,
                Some(Insertion::Rejected) => final_key = final_key.at_most(key),
                Some(Insertion::Full) => {
                    let (i, j) = self.halves(cone, level(query));
                    return Ok(End::Full(i, j));
                }
                None => return Ok(End::Stopped(Stop::Rounding)),
            }
        }
        Ok(End::Done(final_key))
    }

    /// Keys of the new facets, whose normals are scaled to unit directions.
    fn rate_cone(
        &mut self,
        query: &mut Query<'_, T, N>,
        cone: &Cone<N>,
        level: T,
        final_key: &mut T,
    ) -> Result<(), Failure> {
        while let Some(index) = self.next_fresh() {
            let Some(&Facet { normal, mut offset, .. }) = self.facet(index) else { break };
            let mut direction = cone.direction(&normal);
            if !cone.is_orthant() {
                let factor = T::one() / norm(&direction);
                self.scale(index, factor);
                (direction, offset) = (direction * factor, offset * factor);
            }
            let key = query.key(&direction, offset)?;
            if !self.set_key(index, key, key < level) {
                *final_key = final_key.at_most(key);
            }
        }
        Ok(())
    }

    /// The points of the lowest facet.
    fn cone_witness(&self, cone: &Cone<N>) -> Option<Simplex<T, N>> {
        let mut simplex = self.corners(self.lowest()?);
        for corner in &mut simplex.corners {
            corner.vertex.point = cone.point(&corner.vertex.point);
        }
        simplex.minimize(self.resolution());
        Some(simplex)
    }

    /// The two generators between which to halve a cone: of those nearly as far apart as any, those between which the unfinished
    /// facets divide most evenly. (By evenness alone cones become flat, not narrow. With 9/10 of the longest edge L, the edges from the midpoint
    /// are shorter than sqrt(1 - 0.9^2 / 4) L < 0.9 L, so all edges become shorter in turn.)
    fn halves(&self, cone: &Cone<N>, level: T) -> (usize, usize) {
        let apart = cone.squared_edges::<T>();
        let longest = apart.iter().flatten().fold(T::zero(), |most, &x| most.at_least(x));
        let mut best = (0, 1);
        let mut most: Option<(usize, T)> = None;
        for i in 0..N {
            for j in 0..i {
                if apart[i][j] < longest * T::of(0.81) {
                    continue;
                }
                let (mut near_i, mut near_j) = (0, 0);
                for facet in self.facets().filter(|f| f.key < level) {
                    if facet.normal[i] >= facet.normal[j] {
                        near_i += 1;
                    } else {
                        near_j += 1;
                    }
                }
                let evenness = (core::cmp::min(near_i, near_j), apart[i][j]);
                if most.is_none_or(|most| evenness > most) {
                    (best, most) = ((i, j), Some(evenness));
                }
            }
        }
        best
    }
}

/// The points of A around the one that dQ touches along the best direction, with their weights: the simplex that the ray to it
/// pierces. (A cone's lowest facet may belong to another direction, and some of its points are at infinity.)
fn touch<T: Real, const N: usize>(query: &mut Query<'_, T, N>, found: &mut Cones<T, N>) -> Result<(), Failure> {
    if matches!(found.stop, Stop::Met | Stop::Rounding)
        && let Some(target) = query.mapping(&query.best.direction)
    {
        let (ray, shot) = shoot(query, &target, None, T::of(1e-9).at_least(query.options.relative), &|_| T::HUGE)?;
        if matches!(shot, Shot::Hit) && ray.reach().is_some() {
            found.witness = ray.simplex();
        }
    }
    Ok(())
}

/// The next gap: the one that is asked for, times a power of `narrowing`, well below the last.
fn next_gap<T: Real, const N: usize>(query: &Query<'_, T, N>, last: T, narrowing: T) -> T {
    let asked = T::one() - query.level(T::zero(), T::zero()) / query.ratio();
    // (So much less that rounding does not make another pass of it.)
    let mut gap = asked.at_least(T::ROUNDOFF) * T::of(0.999);
    while gap * narrowing < last * T::of(0.5) {
        gap *= narrowing;
    }
    gap
}
