//! Two bodies as one set, their difference.

use super::body::{Anchor, Body};
use crate::bounds::Axes;
use crate::math::{Accumulator, Vector, finite, norm};
use crate::qset::Ball;
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::support::failure::{NOT_FINITE, TOO_LARGE};
use crate::support::{Failure, Support};

/// A - B, with B's anchor taken relative to A's, so that the error grows neither with the bodies' distance
/// from the world's origin nor with that of their vertices from their frames'.
pub(crate) struct Pair<'p, 'a, T: Real, const N: usize> {
    pub(super) a: &'p Body<'a, T, N>,
    pub(super) b: &'p Body<'a, T, N>,
    pub(super) on_a: Anchor<T, N>,
    pub(super) on_b: Anchor<T, N>,
    /// A's anchor minus B's, in the world.
    pub(super) offset: Vector<T, N>,
    pub(super) extent: T,
    pub(super) error: T,
    /// What the offset's own rounding and the axis that is used for both bodies add to it.
    extra: T,
}

impl<'p, 'a, T: Real, const N: usize> Pair<'p, 'a, T, N> {
    pub(super) fn new(a: &'p Body<'a, T, N>, b: &'p Body<'a, T, N>) -> Result<Self, Failure> {
        if !finite(&a.translation) || !finite(&b.translation) {
            return Err(Failure(NOT_FINITE));
        }
        let (on_a, on_b) = (a.anchor()?, b.anchor()?);
        let (offset, left) = if on_a.center.is_none() && on_b.center.is_none() {
            (a.translation - b.translation, T::zero())
        } else {
            anchor_offset(a, &on_a, b, &on_b)
        };
        let cores = on_a.extent + on_b.extent;
        let apart = norm(&offset);
        // Stated for space; the plane needs less. Beside the shapes' own errors, for each core of extent E (unit roundoff u): the local direction is off by
        // at most 5.2 u, which costs that times the diameter 2 E; the anchor's subtraction u E; the product with the rotation 5.2 u E.
        // The two additions cost u times the sizes of their sums, the rounding of `offset` u of its own (2 u when
        // anchors are involved). A rotation that is off by 1e-4 stretches all of it by less than 1 %.
        let rounding = (cores * T::count(20) + apart * T::count(4)) * T::ROUNDOFF;
        let error = (on_a.error + on_b.error + rounding) * T::of(1.01) + left;
        let extent = cores * T::of(1.01) + apart;
        if !((extent < T::HUGE) & (error < T::HUGE)) {
            let said = [on_a.extent, on_a.error, on_b.extent, on_b.error].iter().all(|x| x.finite());
            return Err(Failure(if said { TOO_LARGE } else { NOT_FINITE }));
        }
        Ok(Pair { a, b, on_a, on_b, offset, extent, error, extra: left })
    }

    /// Adds to the error, in all directions; returns what it was.
    pub(super) fn charge(&mut self, error: T) -> [T; 2] {
        let before = [self.error, self.extra];
        self.error += error;
        self.extra += error;
        before
    }

    /// Takes it away again.
    pub(super) fn discharge(&mut self, before: [T; 2]) {
        [self.error, self.extra] = before;
    }

    /// The options, with the direction to look in first.
    #[inline(always)]
    pub(super) fn aimed<'o>(&self, options: &Options<'o, T, N>) -> Options<'o, T, N> {
        let mut options = *options;
        if options.guess.is_none() && self.offset.iter().any(|&x| x != T::zero()) {
            options.guess = Some(-self.offset);
        }
        options
    }

    /// The error along a unit vector, as [`axes`](Self::axes) tells it.
    fn error_along(&self, n: &Vector<T, N>) -> T {
        let along = |body: &Body<'_, T, N>| {
            let seen = body.rotation.map(|x| x.abs()).tr_mul(&n.abs());
            seen.dot(&body.shape.errors()) + seen.dot(&body.shape.extents()) * (T::count(13) * T::ROUNDOFF)
        };
        along(self.a) + along(self.b) + self.offset.abs().dot(&n.abs()) * (T::count(4) * T::ROUNDOFF)
    }

    /// Is a height along this unit vector known much better than in any direction?
    pub(super) fn is_finer_along(&self, n: &Vector<T, N>) -> bool {
        // (The first product says at once that the offset's own rounding leaves nothing to gain.)
        let aside = self.offset.dot(n).abs() * (T::count(16) * T::ROUNDOFF) < self.error;
        aside && self.error_along(n) * T::count(4) < self.error
    }

    /// Extents and errors along each axis of the world, with E_i = (|R| E)_i in the place of E: the local direction is off by 3 u (|R|^T |u|)_j, which
    /// costs that times 2 E_j, 6 u sum of |u_i| E_i together; the anchor's subtraction u, the product with the rotation 3 u, and the rest as in `new`.
    fn axes(&self) -> Axes<T, N> {
        let (a, b) = (self.a.axes(&self.on_a), self.b.axes(&self.on_b));
        let (spans, offsets) = (a.reach + b.reach, self.offset.abs());
        let rounding = (spans * T::count(13) + offsets * T::count(4)) * T::ROUNDOFF;
        let errors = ((a.errors + b.errors + rounding) * T::of(1.01)).add_scalar(self.extra);
        Axes { errors, reach: spans * T::of(1.01) + offsets }
    }

    /// Support calls of each body so far.
    pub(super) fn calls(&self) -> u32 {
        self.on_a.calls.max(self.on_b.calls)
    }

    /// The query for the depth, after so many support calls. `set` is the pair, or stands for it.
    #[inline(always)]
    pub(super) fn query<'q>(
        set: &'q dyn Support<T, N>,
        ball: &'q Ball<T>,
        calls: u32,
        options: &Options<'q, T, N>,
    ) -> (Query<'q, T, N>, Result<(), Failure>) {
        let (mut query, checked) = Query::new(set, ball, set.radius(), *options);
        query.rivals.sought = false;
        query.count_calls(calls);
        (query, checked)
    }

    pub(super) fn sample(&self, u: &Vector<T, N>, exhaustive: bool) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let on_a = self.a.farthest(u, &self.on_a, exhaustive)?;
        let on_b = self.b.farthest(&-u, &self.on_b, exhaustive)?;
        Ok((on_a - on_b + self.offset, on_a))
    }
}

/// (t_a + R_a c_a) - (t_b + R_b c_b), computed as in twice the precision: the terms may be large and cancel. And a bound
/// of what that leaves beside the rounding of the result: u^2 times the terms, eight in each of at most three coordinates.
#[cold]
fn anchor_offset<T: Real, const N: usize>(
    a: &Body<'_, T, N>,
    on_a: &Anchor<T, N>,
    b: &Body<'_, T, N>,
    on_b: &Anchor<T, N>,
) -> (Vector<T, N>, T) {
    let mut offset = Vector::<T, N>::zeros();
    let far = |anchor: &Anchor<T, N>| anchor.center.map_or(T::zero(), |center| norm(&center));
    let terms = norm(&a.translation) + norm(&b.translation) + far(on_a) + far(on_b);
    for i in 0..N {
        let mut sum = Accumulator::new(a.translation[i]);
        sum.add(-b.translation[i]);
        for (body, anchor, sign) in [(a, on_a, T::one()), (b, on_b, -T::one())] {
            if let Some(center) = &anchor.center {
                for j in 0..N {
                    sum.add_product(body.rotation[(i, j)], sign * center[j]);
                }
            }
        }
        offset[i] = sum.value();
    }
    (offset, terms * T::count(256) * T::ROUNDOFF * T::ROUNDOFF)
}

impl<T: Real, const N: usize> Support<T, N> for Pair<'_, '_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.sample(u, false)?.0)
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, false)
    }
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, true)
    }
    fn has_shortcuts(&self) -> bool {
        self.a.shape.has_shortcuts() || self.b.shape.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.a.ball + self.b.ball
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error
    }
    fn extents(&self) -> Vector<T, N> {
        self.axes().reach
    }
    fn errors(&self) -> Vector<T, N> {
        self.axes().errors
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::dice;
    use super::*;
    use nalgebra::Rotation3;

    /// Points without error, chosen without one.
    struct Exact(Vec<Vector<f32, 3>>);

    impl Support<f32, 3> for Exact {
        fn support(&self, u: &Vector<f32, 3>) -> Result<Vector<f32, 3>, Failure> {
            let height = |p: &Vector<f32, 3>| wide(p).dot(&wide(u));
            Ok(*self.0.iter().reduce(|a, b| if height(b) > height(a) { b } else { a }).unwrap())
        }
        fn extent(&self) -> f32 {
            self.0.iter().fold(1e-30, |most, p| most.max(p.norm() * 1.0001))
        }
        fn extents(&self) -> Vector<f32, 3> {
            Vector::from_fn(|i, _| self.0.iter().fold(0.0, |most, p| p[i].abs().max(most)))
        }
        fn error(&self) -> f32 {
            0.0
        }
    }

    /// Products of such numbers are exact, and sums of some as good as that.
    fn wide(x: &Vector<f32, 3>) -> Vector<f64, 3> {
        x.map(f64::from)
    }

    /// What a pair of exact sets with so many points says of its error, in any direction and coordinate by coordinate, is true: of its height, and of where its
    /// point lies.
    fn keeps_its_promise(seed: u64, sizes: [f64; 2], points: usize, far: f64) {
        let mut next = dice(seed);
        for _ in 0..2000 {
            let sets = sizes.map(|size| {
                Exact((0..points).map(|_| Vector::from_fn(|_, _| (size * next()) as f32)).collect::<Vec<_>>())
            });
            let turns = [0, 1].map(|_| {
                let angles = Vector::<f64, 3>::from_fn(|_, _| 3.0 * next());
                Rotation3::new(angles).matrix().map(|x| x as f32)
            });
            let places = [0, 1].map(|_| Vector::from_fn(|_, _| (far * next()) as f32));
            let bodies = [0, 1].map(|i| Body::new(&sets[i], turns[i], places[i]).unwrap());
            let pair = Pair::new(&bodies[0], &bodies[1]).unwrap();
            let u = Vector::<f32, 3>::from_fn(|_, _| next() as f32).normalize();
            let (point, error, errors) =
                (wide(&pair.support(&u).unwrap()), f64::from(pair.error()), wide(&pair.errors()));
            let image = |i: usize, p: &Vector<f32, 3>| turns[i].map(f64::from) * wide(p) + wide(&places[i]);
            let all: Vec<_> = sets[0].0.iter().flat_map(|a| sets[1].0.iter().map(move |b| (a, b))).collect();
            let all: Vec<_> = all.into_iter().map(|(a, b)| image(0, a) - image(1, b)).collect();
            // (The point is one of M's to the error: of two that are as far along u, either.)
            let within = |p: &Vector<f64, 3>| (0..3).all(|i| (p - point)[i].abs() <= errors[i]);
            assert!(all.iter().any(within), "{point:?} {errors:?}");
            assert!(all.iter().any(|p| (p - point).norm() <= error), "{point:?} {error}");
            let highest = all.iter().map(|p| p.dot(&wide(&u))).fold(f64::MIN, f64::max);
            let lost = highest - point.dot(&wide(&u));
            assert!(lost <= wide(&u).abs().dot(&errors) && lost <= error, "{lost} {errors:?} {error}");
        }
    }

    #[test]
    fn turned_points_are_rounded() {
        keeps_its_promise(1, [1.0, 1.0], 5, 0.0);
        keeps_its_promise(2, [1.0, 1e-3], 5, 0.0);
    }

    #[test]
    fn the_offset_is_rounded() {
        keeps_its_promise(3, [0.0, 0.0], 1, 1.0);
        keeps_its_promise(4, [1e-3, 1e-3], 5, 1.0);
    }
}
