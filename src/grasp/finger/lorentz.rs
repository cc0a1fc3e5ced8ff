//! The Lorentz cone L = { (s, y) in R^4 : |y| <= s }: scalings that map it onto itself, its product, its edge.
//!
//! L. Vandenberghe, *The CVXOPT linear and quadratic cone program solvers*, 2010.

use crate::math::dot;
use crate::scalar::Real;

/// The scaling W of a cone: symmetric, maps L onto itself, and `W dual = W^-1 slack`, which is `point`.
/// `W = beta (2 v v^T - J)` with J = diag(1, -1, -1, -1).
#[derive(Clone, Copy)]
pub struct Scaling<T> {
    beta: T,
    v: [T; 4],
    pub point: [T; 4],
}

impl<T: Real> Scaling<T> {
    /// That of a cone that is not there.
    #[inline(always)]
    pub fn none() -> Self {
        Self { beta: T::one(), v: [T::zero(); 4], point: [T::zero(); 4] }
    }

    /// Of a slack and a dual; `None` where one of them is not strictly inside.
    pub fn new(slack: &[T; 4], dual: &[T; 4]) -> Option<Self> {
        let (one, two) = (T::one(), T::count(2));
        let (s, d) = (determinant(slack).root(), determinant(dual).root());
        if !(s > T::zero() && d > T::zero()) {
            return None;
        }
        let (slack_unit, dual_unit) = (slack.map(|x| x / s), dual.map(|x| x / d));
        let gamma = ((one + dot(&slack_unit, &dual_unit)) / two).root();
        let mirrored = reflected(&dual_unit);
        let mut v: [T; 4] = core::array::from_fn(|c| (slack_unit[c] + mirrored[c]) / (two * gamma));
        v[0] += one;
        let length = (two * v[0]).root();
        let mut scaling = Self { beta: (s / d).root(), v: v.map(|x| x / length), point: [T::zero(); 4] };
        scaling.point = scaling.apply(dual);
        Some(scaling)
    }

    /// W x.
    pub fn apply(&self, x: &[T; 4]) -> [T; 4] {
        let (along, mirrored) = (T::count(2) * dot(&self.v, x), reflected(x));
        core::array::from_fn(|c| self.beta * (self.v[c] * along - mirrored[c]))
    }

    /// W^-1 x.
    pub fn inverse(&self, x: &[T; 4]) -> [T; 4] {
        let (v, mirrored) = (reflected(&self.v), reflected(x));
        let along = T::count(2) * dot(&v, x);
        core::array::from_fn(|c| (v[c] * along - mirrored[c]) / self.beta)
    }
}

/// J x.
fn reflected<T: Real>(&[s, a, b, c]: &[T; 4]) -> [T; 4] {
    [s, -a, -b, -c]
}

/// s^2 - |y|^2, as (s - |y|)(s + |y|): the first factor is what counts near the boundary.
fn determinant<T: Real>(&[s, a, b, c]: &[T; 4]) -> T {
    let y = (a * a + b * b + c * c).root();
    (s - y) * (s + y)
}

/// Strictly inside of L?
pub fn inside<T: Real>(x: &[T; 4]) -> bool {
    let [s, ..] = *x;
    s > T::zero() && determinant(x) > T::zero()
}

/// The product of the cone's Jordan algebra: (x.y, x_0 y_1 + y_0 x_1).
pub fn jordan<T: Real>(x: &[T; 4], y: &[T; 4]) -> [T; 4] {
    let mut product = core::array::from_fn(|c| x[0] * y[c] + y[0] * x[c]);
    product[0] = dot(x, y);
    product
}

/// The y with `jordan(x, y) = d`, for x inside of the cone.
pub fn divided<T: Real>(x: &[T; 4], d: &[T; 4]) -> [T; 4] {
    let first = dot(&reflected(x), d) / determinant(x);
    let mut y = core::array::from_fn(|c| (d[c] - first * x[c]) / x[0]);
    y[0] = first;
    y
}

/// 1 / t for the t at which `point + t step` leaves the cone; 0 or less: it never does.
pub fn exit<T: Real>(point: &[T; 4], step: &[T; 4]) -> T {
    let size = determinant(point).root();
    let (p, d) = (point.map(|x| x / size), step.map(|x| x / size));
    let first = dot(&reflected(&p), &d);
    let share = (first + d[0]) / (p[0] + T::one());
    let [_, a, b, c] = core::array::from_fn(|i| d[i] - share * p[i]);
    (a * a + b * b + c * c).root() - first
}
