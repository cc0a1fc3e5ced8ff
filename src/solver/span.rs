//! Flat sets: d_Q in the subspace that A spans.
//!
//! A set in a subspace R has depth 0 in the whole space, but a depth of its own in R (the active wrench set of planar fingers, paper, Section III). With an
//! orthonormal basis B of R, the subspace is R^K with
//!
//! ```text
//! h(c) = h_A(B c)      and      h_Q(B c), the support function of the projection of Q on R
//! ```
//!
//! for directions c in R^K, so the same solver answers there, in the same memory.

use crate::bounds::Bracket;
use crate::math::{Vector, norm, unit};
use crate::plan::expansion::sample;
use crate::plan::start::Start;
use crate::polytope::simplex::{Corner, Simplex, Vertex};
use crate::qset::UnitSet;
use crate::query::answer::{Answer, Outcome, Stop};
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Failure, Support, total};
use heapless::Vec;
use nalgebra::SMatrix;

/// A set or a unit set seen in a subspace.
struct Within<'a, S: ?Sized, T, const N: usize, const K: usize> {
    inner: &'a S,
    basis: &'a SMatrix<T, N, K>,
    /// What the basis adds to the error: its tilt out of A's true span, times the size.
    blur: T,
}

impl<S: ?Sized, T: Real, const N: usize, const K: usize> Within<'_, S, T, N, K> {
    /// Signs of coordinates in the subspace as signs in space; `None` unless the basis is one of coordinate axes.
    fn signs(&self, signs: u8) -> Option<u8> {
        (0..K).try_fold(0, |bits, j| {
            let mut axes = (0..N).filter(|&i| self.basis[(i, j)] != T::zero());
            let axis = axes.next().filter(|_| axes.next().is_none())?;
            Some(bits | (signs >> j & 1) << axis)
        })
    }
}

impl<T: Real, const N: usize, const K: usize> Support<T, K> for Within<'_, dyn Support<T, N> + '_, T, N, K> {
    fn support(&self, u: &Vector<T, K>) -> Result<Vector<T, K>, Failure> {
        Ok(self.basis.tr_mul(&self.inner.support(&(self.basis * u))?))
    }
    fn support_with_witness(&self, u: &Vector<T, K>) -> Result<(Vector<T, K>, Vector<T, K>), Failure> {
        let (point, witness) = self.inner.support_with_witness(&(self.basis * u))?;
        Ok((self.basis.tr_mul(&point), self.basis.tr_mul(&witness)))
    }
    fn exhaustive(&self, u: &Vector<T, K>) -> Result<(Vector<T, K>, Vector<T, K>), Failure> {
        let (point, witness) = self.inner.exhaustive(&(self.basis * u))?;
        Ok((self.basis.tr_mul(&point), self.basis.tr_mul(&witness)))
    }
    fn has_shortcuts(&self) -> bool {
        self.inner.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.inner.radius()
    }
    fn extent(&self) -> T {
        self.inner.extent() * T::of(1.01)
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.signs(signs).is_some_and(|signs| self.inner.mirrored(signs))
    }
    fn contains_origin(&self) -> bool {
        self.inner.contains_origin()
    }
    fn error(&self) -> T {
        total(self.inner.error(), self.blur)
    }
}

impl<T: Real, const N: usize, const K: usize> UnitSet<T, K> for Within<'_, dyn UnitSet<T, N> + '_, T, N, K> {
    fn value(&self, u: &Vector<T, K>) -> Result<T, Failure> {
        self.inner.value(&(self.basis * u))
    }
    fn ball_radius(&self) -> Option<T> {
        self.inner.ball_radius()
    }
    fn mapping(&self, u: &Vector<T, K>) -> Option<Vector<T, K>> {
        self.inner.mapping(&(self.basis * u)).map(|q| self.basis.tr_mul(&q))
    }
    fn vertex_count(&self) -> usize {
        self.inner.vertex_count()
    }
    fn vertex(&self, index: usize) -> Vector<T, K> {
        self.basis.tr_mul(&self.inner.vertex(index))
    }
    fn inner_radius(&self) -> T {
        (self.inner.inner_radius() * T::of(0.999) - self.blur).at_least(T::zero())
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.signs(signs).is_some_and(|signs| self.inner.mirrored(signs))
    }
    fn error(&self) -> T {
        self.inner.error() + self.blur
    }
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// d_Q(A) in the linear span of A, where A contains the origin: what is flat is measured in its own subspace, with the projection
    /// of Q on it. [`Answer::dimension`] tells its dimension; directions and points are those of the whole space. A set that spans the
    /// whole space is solved there, one whose affine hull misses the origin as [`solve`](Solver::solve) does.
    ///
    /// A subspace of coordinate axes is that subspace; any other is known as well as A's points are, over A's width, and the bracket allows for that.
    /// Flat means: no wider than the rounding of A's support function (some 100 roundoffs of its size). Cost: N + 1 to 2 N + 2 more support
    /// calls.
    pub fn solve_in_span(
        &mut self,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        options: &Options<'_, T, N>,
    ) -> Answer<T, N> {
        let mut calls = 0;
        let answer = match span(a, q, options, &mut calls) {
            Some(span) => self.solve_within(a, q, &span, options, &mut calls),
            None => self.solve(a, q, options),
        };
        Answer { support_calls: answer.support_calls.saturating_add(calls), ..answer }
    }

    /// The answer in A's span. Adds support calls that the answer does not count to `calls`.
    fn solve_within(
        &mut self,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        span: &Span<T, N>,
        options: &Options<'_, T, N>,
        calls: &mut u32,
    ) -> Answer<T, N> {
        match span.dimension {
            1 => solve_line(a, q, span, options, calls).unwrap_or_else(|| self.solve(a, q, options)),
            2 if N > 2 => self.within::<2>(a, q, span, options),
            3 if N > 3 => self.within::<3>(a, q, span, options),
            4 if N > 4 => self.within::<4>(a, q, span, options),
            5 if N > 5 => self.within::<5>(a, q, span, options),
            _ => self.solve(a, q, options),
        }
    }

    fn within<const K: usize>(
        &mut self,
        a: &dyn Support<T, N>,
        q: &dyn UnitSet<T, N>,
        span: &Span<T, N>,
        options: &Options<'_, T, N>,
    ) -> Answer<T, N> {
        let basis = SMatrix::<T, N, K>::from_fn(|i, j| span.axes[j.min(N - 1)][i]);
        let Some(mut narrow) = self.in_dimension::<K>() else { return self.solve(a, q, options) };
        let options = Options {
            absolute: options.absolute,
            relative: options.relative,
            threshold: options.threshold,
            max_iterations: options.max_iterations,
            guess: options.guess.map(|guess| basis.tr_mul(&guess)),
            interrupt: options.interrupt,
        };
        let (a, q) = (span.seen(a, &basis, span.reach), span.seen(q, &basis, span.unit_size));
        widened(&narrow.solve(&a, &q, &options), &basis)
    }
}

/// The answer in space.
fn widened<T: Real, const N: usize, const K: usize>(answer: &Answer<T, K>, basis: &SMatrix<T, N, K>) -> Answer<T, N> {
    let mut corners = Vec::new();
    for corner in &answer.witness.corners {
        let vertex = Vertex { point: basis * corner.vertex.point, witness: basis * corner.vertex.witness };
        let _ = corners.push(Corner { vertex, weight: corner.weight });
    }
    Answer {
        outcome: answer.outcome,
        lower: answer.lower,
        upper: answer.upper,
        direction: basis * answer.direction,
        support: basis * answer.support,
        unit: answer.unit,
        rival: answer.rival.map(|rival| basis * rival),
        plan: answer.plan,
        witness: Simplex { corners },
        dimension: answer.dimension,
        iterations: answer.iterations,
        support_calls: answer.support_calls,
        vertices: answer.vertices,
        facets: answer.facets,
        cones: answer.cones,
        splits: answer.splits,
        failure: answer.failure,
    }
}

/// The subspace that a set spans.
struct Span<T, const N: usize> {
    /// The first `dimension` are an orthonormal basis.
    axes: [Vector<T, N>; N],
    dimension: usize,
    /// Sine of the angle by which the axes may be out of A's true span: a point is off by the margin, an axis by that over the width
    /// that it was found from.
    tilt: T,
    /// Largest |a| seen in A.
    reach: T,
    /// Q lies in a ball of this radius.
    unit_size: T,
}

impl<T: Real, const N: usize> Span<T, N> {
    /// A set or a unit set of this size in the subspace.
    fn seen<'a, S: ?Sized, const K: usize>(
        &self,
        inner: &'a S,
        basis: &'a SMatrix<T, N, K>,
        size: T,
    ) -> Within<'a, S, T, N, K> {
        Within { inner, basis, blur: self.tilt * size }
    }
}

/// Q lies in a ball of the radius h_Q(e_1) + h_Q(-e_1) + ...
fn size<T: Real, const N: usize>(q: &dyn UnitSet<T, N>) -> Result<T, Failure> {
    let mut size = T::zero();
    for i in 0..N {
        for sign in [T::one(), -T::one()] {
            let mut axis = Vector::<T, N>::zeros();
            axis[i] = sign;
            size += q.value(&axis)?;
        }
    }
    Ok(size)
}

/// A's affine hull, if it contains the origin; its basis are coordinate axes where they span it. Adds its support calls to `calls`.
///
/// (Never inlined: its query and its simplex would lie on the stack beneath all of the query in the subspace.)
#[inline(never)]
fn span<T: Real, const N: usize>(
    a: &dyn Support<T, N>,
    q: &dyn UnitSet<T, N>,
    options: &Options<'_, T, N>,
    calls: &mut u32,
) -> Option<Span<T, N>> {
    let (mut query, checked) = Query::new(a, q, a.radius(), *options);
    let found = checked.and_then(|()| query.normalize()).ok().and_then(|()| span_seen(&mut query, a, q));
    *calls = calls.saturating_add(query.support_calls());
    found
}

fn span_seen<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    a: &dyn Support<T, N>,
    q: &dyn UnitSet<T, N>,
) -> Option<Span<T, N>> {
    let mut start = Start::new(query.first_direction());
    while start.missing() > 0 {
        let direction = start.direction();
        let point = sample(query, &start, &direction, false).ok()??.point;
        let thin = (query.resolution() + query.margin()) * T::count(4);
        if !start.accept(&point, thin) {
            start.flat(&direction);
        }
    }
    let thin = (query.resolution() + query.margin()) * T::count(8);
    if a.radius() > T::zero() || start.dimension() == N || start.height() > thin {
        return None;
    }
    let mut axes = start.axes();
    // Coordinates that no axis uses are no part of it; if as many are left as the dimension, they span it.
    let used = |i: usize| axes.iter().any(|axis| axis[i].abs() > T::ROUNDOFF * T::count(64));
    let coordinates = (0..N).filter(|&i| used(i)).count();
    // The direction and the point of a support call are off by N roundoffs.
    let mut tilt = T::count(8 * N) * T::ROUNDOFF;
    if coordinates == start.dimension() {
        let mut number = 0;
        let used: [bool; N] = core::array::from_fn(used);
        axes = [Vector::zeros(); N];
        for i in 0..N {
            if used[i]
                && let Some(axis) = axes.get_mut(number)
            {
                axis[i] = T::one();
                number += 1;
            }
        }
    } else {
        tilt += T::count(4 * N) * (query.margin() + query.resolution()) / start.least_width();
    }
    // (Where a unit set fails, the query in space says so.)
    let unit_size = size(q).ok()?;
    Some(Span { axes, dimension: start.dimension(), tilt, reach: query.true_reach(), unit_size })
}

/// On a line, two directions are all there are. `None`, with its support calls added to `calls`, when that does not decide.
/// (Never inlined, for the same reason as [`span`].)
#[inline(never)]
fn solve_line<T: Real, const N: usize>(
    a: &dyn Support<T, N>,
    q: &dyn UnitSet<T, N>,
    span: &Span<T, N>,
    options: &Options<'_, T, N>,
    calls: &mut u32,
) -> Option<Answer<T, N>> {
    let identity = SMatrix::<T, N, N>::identity();
    let (a, q) = (span.seen(a, &identity, span.reach), span.seen(q, &identity, span.unit_size));
    let axis = unit(span.axes.first()?);
    let (mut query, checked) = Query::new(&a, &q, T::zero(), *options);
    checked.and_then(|()| query.normalize()).ok()?;
    let answer = line_between(&mut query, &axis);
    if answer.is_none() {
        *calls = calls.saturating_add(query.support_calls());
    }
    answer
}

fn line_between<T: Real, const N: usize>(query: &mut Query<'_, T, N>, axis: &Vector<T, N>) -> Option<Answer<T, N>> {
    let axis = *axis;
    let mut ends = Simplex::new(query.support(&axis).ok()?.0);
    ends.push(query.support(&-axis).ok()?.0);
    query.dimension = 1;
    let facets = [axis, -axis].map(|u| {
        let height = ends.corners.iter().fold(-T::HUGE, |most, c| most.at_least(c.vertex.point.dot(&u)));
        query.key(&u, height).map(|key| (height, key)).ok()
    });
    let [Some(first), Some(second)] = facets else { return None };
    let inside = query.lower_from_facets([first, second].into_iter(), query.margin());
    ends.minimize(query.resolution());
    // An end at the origin, as far as rounding can tell. What is farther out has a distance that is no business of the line's.
    let at_end = || (query.upper() >= T::zero()).then(|| query.lower_from_simplex(&ends, norm(&ends.point())));
    let lower = inside.or_else(at_end)?;
    let stop = query.verdict(&Bracket { lower, upper: query.upper() });
    let answer = query.answer(stop.unwrap_or(Stop::Rounding), lower, ends);
    (answer.outcome != Outcome::SupportFailed).then_some(answer)
}
