//! Depth of two ellipsoids whose centres and axes agree: a closed form.
//!
//! The two least axes of equal ellipsoids are the hardest thing there is for expansion: both poles are smooth, and each must be tiled. But in the frame of
//! their axes, A and B the diagonal matrices of the semi axes in one order,
//!
//! ```text
//! h(u) = |A u| + |B u| >= |(A + B) u| >= min over i of (a_i + b_i)        for unit u
//! ```
//!
//! (the triangle inequality, then the least entry of a diagonal matrix), and at axis i both are equal. So three support calls along the axes are the whole
//! answer, witnesses included.
//!
//! # What is off
//!
//! Centres c apart add c.u to h: |c| at most. The three directions are taken against c, so what they show is not more than a_i + b_i.
//!
//! For the placed matrices R, S let P = R^T S, Π the permutation that it is but for signs and a rest of (Frobenius) norm e, and s the
//! largest entry of R^T R - I and S^T S - I. With w = R^T u: S^T u = P^T w + S^T (I - R R^T) u, which is Π^T w up to signs and 1.01 e + 3.1 s;
//! |w| is 1 up to 3 s; the balls that were split off stay balls, which is worth 3 s. With E the sum of both bodies' extents all that is at most (1.01 e +
//! 16 s) E, once for u and once for the axes that are asked in its place. The roundoffs are those of measuring it.

use super::answer::Depth;
use super::body::{Body, SKEW_ROUNDOFFS, skew};
use super::pair::Pair;
use super::route::Need;
use crate::bounds::Bracket;
use crate::math::{Vector, norm, unit};
use crate::polytope::simplex::Simplex;
use crate::qset::Ball;
use crate::query::Options;
use crate::query::answer::{Answer, Outcome, Stop};
use crate::scalar::Real;
use crate::solver::Solver;

/// How far the axes may be from one another for the estimates above.
const NEARLY_PARALLEL: f64 = 0.0625;

impl<T: Real> Body<'_, T> {
    fn is_ellipsoid(&self) -> bool {
        // (What is measured from another point than its center has its offset from there.)
        self.shape.route().is_some_and(|route| route.need == Need::Ellipsoid) && self.shape.center().is_none()
    }
}

impl<T: Real> Pair<'_, '_, T, 3> {
    /// What is off, where the closed form may serve.
    fn off_common_axes(&self, options: &Options<'_, T, 3>) -> Option<T> {
        let apart = norm(&self.offset);
        let near = apart <= options.absolute.at_least(options.relative * self.extent);
        if !(near && self.a.is_ellipsoid() && self.b.is_ellipsoid()) {
            return None;
        }
        let stretched = skew(&self.a.rotation).at_least(skew(&self.b.rotation));
        let rest = self.a.rotation.tr_mul(&self.b.rotation).map(|x| {
            let x = x.abs();
            if x > T::of(0.5) { x - T::one() } else { x }
        });
        let aside = rest.dot(&rest).root();
        let serves = stretched <= T::count(SKEW_ROUNDOFFS) * T::ROUNDOFF && aside < T::of(NEARLY_PARALLEL);
        let turned = aside * T::of(2.1) + stretched * T::count(32) + T::count(64) * T::ROUNDOFF;
        serves.then(|| apart + turned * self.extent)
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// Depth where one body is an ellipsoid, and the other does not turn.
    pub(super) fn depth_with_ellipsoid(
        &mut self,
        pair: &Pair<'_, '_, T, 3>,
        calls: u32,
        options: &Options<'_, T, 3>,
    ) -> Depth<T> {
        match pair.off_common_axes(options).and_then(|off| self.ask_along_axes(pair, off, calls, options)) {
            Some(known) if !known.outcome.is_inconclusive() => Depth::new(&known, pair),
            Some(known) => self.expand_beside(pair, &known, options),
            None => self.expand_pair(pair, calls, options),
        }
    }

    /// Expansion, where the closed form leaves more open than was asked for; or the latter, where that is narrower.
    #[cold]
    fn expand_beside(
        &mut self,
        pair: &Pair<'_, '_, T, 3>,
        known: &Answer<T, 3>,
        options: &Options<'_, T, 3>,
    ) -> Depth<T> {
        let found = self.expand_pair(pair, known.support_calls, options);
        let done =
            matches!(found.outcome, Outcome::Converged | Outcome::Above | Outcome::Below | Outcome::SupportFailed);
        if done || found.upper - found.lower <= known.upper - known.lower {
            return found;
        }
        let cut = matches!(found.outcome, Outcome::Iterations | Outcome::Interrupted);
        let outcome = if cut { found.outcome } else { known.outcome };
        let Depth { iterations, support_calls, vertices, facets, .. } = found;
        Depth { outcome, iterations, support_calls, vertices, facets, ..Depth::new(known, pair) }
    }

    /// The closed form.
    #[cold]
    fn ask_along_axes(
        &mut self,
        pair: &Pair<'_, '_, T, 3>,
        off: T,
        calls: u32,
        options: &Options<'_, T, 3>,
    ) -> Option<Answer<T, 3>> {
        let ball = Ball::unit();
        let (mut query, checked) = Pair::query(pair, &ball, calls, options);
        checked.and_then(|()| query.normalize()).ok()?;
        self.polytope.reset();
        let mut lowest = None;
        for column in pair.a.rotation.data.0 {
            let axis = unit(&Vector::from(column));
            let axis = if axis.dot(&pair.offset) > T::zero() { -axis } else { axis };
            let (vertex, height) = query.support(&axis).ok()?;
            lowest = lowest.filter(|&(_, lowest)| lowest <= height).or(Some((vertex, height)));
        }
        let (vertex, height) = lowest?;
        let lower = query.lower_from_offset(height - off * query.scale(), query.margin())?;
        let stop = query.verdict(&Bracket { lower, upper: query.upper() }).unwrap_or(Stop::Rounding);
        Some(self.report(&mut query, stop, lower, Simplex::new(vertex)))
    }
}
