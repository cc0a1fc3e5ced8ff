//! The end of a depth query in twice the precision: shallow contact.
//!
//! Bodies of size 1 that overlap by d = 0.001 are asked for d to a share of 1e-4. In `f32` that is 1.7 roundoffs of their size: no height computed from
//! their points in one word is known that well, nor is a normal in one word good enough to say it, since a roundoff of tilt costs as much. What
//! the expansion has found out is right all the same: *which* points of the bodies the answer hangs on. The query is run once more with points in two
//! words, and this module computes the bracket from its last polytope anew, with every length as a sum of two words.
//!
//! # Exact points
//!
//! A vertex v of the polytope is the rounded image of a point a of A minus one b of B, which the bodies tell in two words
//! (`Support::support_in_two_words`), and so is v' = (R_A a + t_A) - (R_B b + t_B). A [`Recorder`] rounds v' to v, which is right to a roundoff of |v|, not of the
//! bodies' size: near the origin that is much less. And it remembers v'.
//!
//! # Bounds
//!
//! Both are those of module [`bounds`](crate::bounds) with a smaller margin. Let n be any vector in two words and E bound the error of heights along it.
//!
//! ```text
//! upper:   d <= (n.v' + E) / |n|,     v' the point that is farthest along n
//! lower:   d >= min over F of max( e_F - m(n_F),  (min over v' of n.v' - E) / |n| )
//! ```
//!
//! For the lower one, move each vertex v straight to its v' as under "By direction" there: no facet crosses the origin on the way, since every facet
//! has e_F > m, and afterwards λB misses each of them, by its old plane or by the new one; any n will do for that.
//! For n the plane through the v' of a facet is taken: its normal in one word, corrected once by the heights that this leaves. The upper bound is
//! proved by the direction that is reported, which is n in one word, and is as good as that: within half a roundoff of the bodies' size.
//!
//! # Curved bodies
//!
//! One word loses sight of a curved surface where a facet is a roundoff of the size beneath it. There expansion goes on as it began, the lowest facet
//! first, with lower bounds in two words for keys: each step asks along the corrected normal, and inserts the point where it is higher than the facet
//! by more than E. In one word, the point may be beneath the facet. That the surface winds around the origin is as good as before ("Around the origin" in
//! module [`bounds`](crate::bounds)) when along each facet's normal the facet and the point are above the centre by more than heights in one word are off.
//!
//! # Cores that are apart
//!
//! Shallow contact of bodies with a ball term leaves their cores apart, by D. Then d = r - D, and the point x of the cores' difference that is nearest to the
//! origin is a combination of at most N vertices. Let x' be the same combination of the points behind them, and p the part of it across n:
//!
//! ```text
//! d >= r - |x'|,     |x'| <= |n.x'| / |n| + p^2 |n| / (2 |n.x'|)     -n.x' <= max of -n.v'
//! ```
//!
//! x' is added up in two words: p is then as small as the weights are good, and squared. n is the direction from x' to the origin, corrected for equal
//! heights of the vertices as it is for a facet: along them, a roundoff of tilt would cost one of their size, across only the square of one. Curved cores are
//! approached further in the same way: the point that is farthest along n joins the vertices, and new weights are found in coordinates about x'.
//!
//! # Balls of turned bodies
//!
//! A placed ellipsoid is its image under R, which is a rotation to some roundoffs only; the ball of radius ρ that its core leaves over is no ball then, but R ρ B, off
//! by as much. With s bounding R^T R - I, the semi axes of R ρ B are between ρ (1 - 2 s) and ρ (1 + 2 s), and a ball of radius ρ' = ρ (1 - 8 s) rolls in it as well: that is
//! what counts as ball term here, and the rest goes into the points: shapes tell them with ρ w / |w| put on, w = R^T n, and ρ' n is taken away. (Spheres and margins stay balls by definition.)
//!
//! # Errors
//!
//! Products are split and sums are compensated (`Accumulator`): k terms of sum S are known to 2 k^2 u^2 S, and a unit roundoff of the result, which
//! here is as small as d. A direction turned into a body's frame is 2 N terms, no sum above 2 |n|; a point 4 N + 2 terms, the difference of two 4, a height 3 N to 4 N. With L the
//! sum of all extents and offsets, these are 288, 679, 55 and 288 u^2 L in space, and what a shape adds of its own is 2^8 u^2 L: together below 2^11. Rounding modes
//! other than the usual one double u, and make it 2^13; E is twice that.

mod facets;
mod level;
mod nearest;
mod recorder;

use super::body::Body;
use super::pair::Pair;
use crate::bounds::Bracket;
use crate::math::{TwoWords, Vector, unit};
use crate::polytope::simplex::{Edges, MAX_CORNERS, Simplex, Vertex};
use crate::polytope::{Facet, Polytope};
use crate::query::Query;
use crate::query::answer::{Answer, Plan};
use crate::scalar::Real;
use heapless::Vec;
pub(super) use level::Level;
pub(super) use recorder::Recorder;

/// Steps in two words. (Polyhedra need one or two, curved bodies some ten.)
const STEPS: usize = 32;

/// What two words tell.
struct Found<T: Real, const N: usize> {
    bracket: Bracket<T>,
    /// Proves the upper end, if that is new.
    direction: Option<Vector<T, N>>,
    witness: Simplex<T, N>,
}

/// The last polytope of a query, with what is known of the points behind its vertices.
pub(super) struct Fine<'f, 'm, 'q, 'p, 'b, 'a, T: Real, const N: usize> {
    polytope: &'f mut Polytope<'m, T, N>,
    query: &'f mut Query<'q, T, N>,
    recorder: &'f Recorder<'p, 'b, 'a, T, N>,
    error: T,
}

/// E: see "Errors".
pub(super) fn fine_error<T: Real, const N: usize>(pair: &Pair<'_, '_, T, N>) -> T {
    let size = |body: &Body<'_, T, N>| body.shape.extents().sum() + body.translation.abs().sum() + body.ball;
    (size(pair.a) + size(pair.b)) * (T::count(1 << 14) * T::ROUNDOFF * T::ROUNDOFF) + T::count(1 << 10) * T::TINY
}

impl<'f, 'm, 'q, 'p, 'b, 'a, T: Real, const N: usize> Fine<'f, 'm, 'q, 'p, 'b, 'a, T, N> {
    pub fn new(
        polytope: &'f mut Polytope<'m, T, N>,
        query: &'f mut Query<'q, T, N>,
        recorder: &'f Recorder<'p, 'b, 'a, T, N>,
    ) -> Self {
        Fine { polytope, query, recorder, error: fine_error(recorder.pair) }
    }

    /// Gives the answer the bracket in two words.
    #[inline(never)]
    pub fn refine(&mut self, answer: &mut Answer<T, N>) {
        let bracket = Bracket { lower: answer.lower, upper: answer.upper }.scaled(self.query.scale());
        let mut found = Found { bracket, direction: None, witness: answer.witness.clone() };
        // (What was proved before an end without a result stays proved.)
        let _ = match answer.plan {
            Plan::Expansion if self.polytope.facets().next().is_some() => self.by_facets(&mut found),
            Plan::Distance | Plan::Expansion => self.by_nearest(&mut found),
            _ => None,
        };
        if !(found.bracket.lower <= found.bracket.upper) {
            return;
        }
        answer.witness = found.witness;
        answer.vertices = self.polytope.peak_vertices();
        answer.facets = self.polytope.peak_facets();
        self.query.refine(answer, &found.bracket, found.direction);
    }

    /// Asks along a level's vector, as it will be reported; the upper bound that this proves counts.
    #[inline(never)]
    fn ask_along(&mut self, level: &Level<T, N>, found: &mut Found<T, N>) -> Option<Asked<T, N>> {
        let normal = unit(&(level.n.high + level.n.low));
        let (mut vertex, _) = self.query.support(&normal).ok()?;
        let scale = self.query.scale();
        vertex.point /= scale;
        vertex.witness /= scale;
        let point = self.recorder.latest()?;
        let upper = self.seen_along(TwoWords::from(normal)).upper(&point) * scale;
        if upper < found.bracket.upper {
            found.bracket.upper = upper;
            found.direction = Some(normal);
        }
        Some(Asked { vertex, point })
    }

    fn seen_along(&self, n: TwoWords<T, N>) -> Level<T, N> {
        Level::new(n, self.recorder.balls(), self.error)
    }

    /// The exact points behind a simplex's corners, which are in the bodies' unit.
    #[inline(never)]
    fn exact(&self, simplex: &Simplex<T, N>) -> Option<Vec<TwoWords<T, N>, MAX_CORNERS>> {
        let mut points = Vec::new();
        for corner in &simplex.corners {
            points.push(self.recorder.behind(&corner.vertex.point)?).ok()?;
        }
        Some(points)
    }

    /// The corners of a facet, in the bodies' unit.
    #[inline(never)]
    fn corners(&self, facet: &Facet<T, N>) -> Simplex<T, N> {
        let mut corners = self.polytope.corners(facet);
        corners.rescale(T::one() / self.query.scale());
        corners
    }

    /// Heights along the vector next to `normal` along which the points behind these corners are equally high.
    #[inline(never)]
    fn level(&self, normal: &Vector<T, N>, corners: &Simplex<T, N>, points: &[TwoWords<T, N>]) -> Option<Level<T, N>> {
        let rough = TwoWords::from(*normal);
        // x.(v_k - v_0) = -n.(v_k - v_0) for all k makes n + x level: x in the span of the edges, one after the other.
        let (first, base) = (rough.dot(points.first()?), corners.corners.first()?.vertex.point);
        let mut edges = Edges::<T, N>::new();
        let mut low = Vector::zeros();
        for (point, corner) in points.iter().zip(&corners.corners).skip(1) {
            let edge = corner.vertex.point - base;
            let rise = rough.dot(point).minus(&first);
            if edges.push(&edge, T::zero())
                && let Some(index) = edges.count.checked_sub(1)
                && let (Some(q), Some(inverse)) = (edges.q.get(index), edges.inverse.get(index))
            {
                low += q * ((-rise - edge.dot(&low)) * *inverse);
            }
        }
        let small = low.dot(&low) <= T::of(1e-4);
        Some(self.seen_along(if small { TwoWords { high: *normal, low } } else { rough }))
    }
}

/// The point that is farthest along a normal, in the bodies' unit.
struct Asked<T: Real, const N: usize> {
    vertex: Vertex<T, N>,
    point: TwoWords<T, N>,
}
