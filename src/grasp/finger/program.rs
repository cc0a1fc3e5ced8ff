//! A small convex program: a linear function over Lorentz cones and half-spaces, by a primal-dual interior point method.
//!
//! ```text
//! maximise b.z   subject to   C_i z in L = { (s, y) in R^4 : |y| <= s },  i < K        row_r . z <= bound_r,  r < R
//! ```
//!
//! with duals l_i in L and k_r >= 0. At the optimum `b + sum C_i^T l_i - sum k_r row_r = 0`, and every slack is
//! complementary to its dual. The method follows the central path, where all products of slack and dual are equal,
//! with the scaling of Nesterov and Todd and the predictor and corrector of Mehrotra: each step is two least squares
//! problems with one matrix of N columns, and 10 to 25 steps are usual. They are solved by orthogonalisation, not by
//! normal equations: near the optimum some constraints weigh 1e16 times as much as others.
//!
//! Nothing that is *promised* rests on its convergence. It begins at a feasible z with feasible duals and keeps slacks
//! and duals strictly positive, so z is feasible at any time; and any duals whatever are a proof of an upper bound,
//! which whoever asked computes from them.
//!
//! * L. Vandenberghe, *The CVXOPT linear and quadratic cone program solvers*, 2010 (all formulas).

use super::super::svd::dot;
use crate::scalar::Real;

/// The program without its objective.
pub(super) struct Program<T, const K: usize, const N: usize, const R: usize> {
    /// The rows of C_i. A first row of zeros: there is no such cone.
    pub cones: [[[T; N]; 4]; K],
    pub rows: [[T; N]; R],
    /// Positive. 0: there is no such row.
    pub bounds: [T; R],
}

/// A point z with its slacks, and the duals.
#[derive(Clone)]
pub(super) struct Iterate<T, const K: usize, const N: usize, const R: usize> {
    pub z: [T; N],
    pub cone_slacks: [[T; 4]; K],
    pub cone_duals: [[T; 4]; K],
    pub row_slacks: [T; R],
    pub row_duals: [T; R],
}

/// Products of slack and dual are not made smaller than this many roundoffs: what would be gained is lost to rounding.
const LEAST_PRODUCT: usize = 4;
/// Tries to shorten a step that rounding has carried over an edge.
const SHORTER: usize = 6;

/// A number for each constraint, in the order of cones and rows.
type Sides<T, const K: usize, const R: usize> = ([[T; 4]; K], [T; R]);

impl<T: Real, const K: usize, const N: usize, const R: usize> Program<T, K, N, R> {
    fn has_cone(&self, i: usize) -> bool {
        self.cones.get(i).is_some_and(|[first, ..]| first.iter().any(|x| !x.is_zero()))
    }

    fn has_row(&self, r: usize) -> bool {
        self.bounds.get(r).is_some_and(|bound| *bound > T::zero())
    }

    /// The iterate at z with these duals, all strictly inside.
    pub fn start(&self, z: [T; N], cone_duals: [[T; 4]; K], row_duals: [T; R]) -> Iterate<T, K, N, R> {
        Iterate {
            z,
            cone_slacks: self.cones.map(|cone| cone.map(|row| dot(&row, &z))),
            cone_duals,
            row_slacks: core::array::from_fn(|r| self.bounds[r] - dot(&self.rows[r], &z)),
            row_duals,
        }
    }

    /// The sum of all products of slack and dual: how far the bound that the duals prove is above b.z, but for the residual.
    pub fn gap(&self, it: &Iterate<T, K, N, R>) -> T {
        let cones =
            (0..K).filter(|&i| self.has_cone(i)).fold(T::zero(), |s, i| s + dot(&it.cone_slacks[i], &it.cone_duals[i]));
        (0..R).filter(|&r| self.has_row(r)).fold(cones, |s, r| s + it.row_slacks[r] * it.row_duals[r])
    }

    /// `b + sum C_i^T l_i - sum k_r row_r`: zero for duals that prove a bound.
    pub fn residual(&self, b: &[T; N], it: &Iterate<T, K, N, R>) -> [T; N] {
        let mut sum = *b;
        for i in 0..K {
            if self.has_cone(i) {
                for c in 0..4 {
                    add(&mut sum, it.cone_duals[i][c], &self.cones[i][c]);
                }
            }
        }
        for r in 0..R {
            if self.has_row(r) {
                add(&mut sum, -it.row_duals[r], &self.rows[r]);
            }
        }
        sum
    }

    /// One step towards the optimum; `None` when arithmetic has nothing left to say.
    pub fn step(&self, b: &[T; N], it: &Iterate<T, K, N, R>) -> Option<Iterate<T, K, N, R>> {
        let (zero, one) = (T::zero(), T::one());
        let mut scalings = [Scaling { beta: one, v: [zero; 4], point: [zero; 4] }; K];
        let mut widths = [one; R];
        // The constraints in scaled coordinates, where slack and dual are the same point.
        let mut columns: [Sides<T, K, R>; N] = [([[zero; 4]; K], [zero; R]); N];
        let mut points: Sides<T, K, R> = ([[zero; 4]; K], [zero; R]);
        let mut degree = zero;
        for i in 0..K {
            if self.has_cone(i) {
                scalings[i] = Scaling::new(&it.cone_slacks[i], &it.cone_duals[i])?;
                for d in 0..N {
                    columns[d].0[i] = scalings[i].inverse(&self.cones[i].map(|row| row[d]));
                }
                points.0[i] = scalings[i].point;
                degree += one;
            }
        }
        for r in 0..R {
            if self.has_row(r) {
                let (slack, dual) = (it.row_slacks[r], it.row_duals[r]);
                widths[r] = (slack / dual).root();
                for d in 0..N {
                    columns[d].1[r] = -self.rows[r][d] / widths[r];
                }
                points.1[r] = (slack * dual).root();
                degree += one;
            }
        }
        let factor = Factor::new(columns);
        let residual = factor.forward(&self.residual(b, it));
        // For wanted sums q of scaled slack and dual steps: the step of z, and those of the slacks.
        let direction = |q: &Sides<T, K, R>| {
            let (mut rest, mut y) = (*q, residual);
            // Twice: what the duals get is then orthogonal to the constraints to rounding, and no residual is made.
            for _ in 0..2 {
                for (y, column) in y.iter_mut().zip(&factor.columns) {
                    let along = product(column, &rest);
                    *y += along;
                    add_sides(&mut rest, -along, column);
                }
            }
            let mut slacks = *q;
            add_sides(&mut slacks, -one, &rest);
            for (t, column) in residual.iter().zip(&factor.columns) {
                add_sides(&mut slacks, *t, column);
            }
            (factor.backward(&y), slacks)
        };
        let duals = |q: &Sides<T, K, R>, slacks: &Sides<T, K, R>| -> Sides<T, K, R> {
            (
                core::array::from_fn(|i| core::array::from_fn(|c| q.0[i][c] - slacks.0[i][c])),
                core::array::from_fn(|r| q.1[r] - slacks.1[r]),
            )
        };
        let reach = |step: &Sides<T, K, R>| {
            let mut inverse = zero;
            for i in 0..K {
                if self.has_cone(i) {
                    inverse = inverse.at_least(exit(&points.0[i], &step.0[i]));
                }
            }
            for r in 0..R {
                if self.has_row(r) {
                    inverse = inverse.at_least(-step.1[r] / points.1[r]);
                }
            }
            inverse
        };
        let longest = |s: &Sides<T, K, R>, d: &Sides<T, K, R>, share: T| {
            let inverse = reach(s).at_least(reach(d));
            if inverse > share { share / inverse } else { one }
        };

        // Straight to complementarity zero, to see how far that goes.
        let towards = (points.0.map(|p| p.map(|x| -x)), points.1.map(|x| -x));
        let (_, slack_steps) = direction(&towards);
        let dual_steps = duals(&towards, &slack_steps);
        let left = one - longest(&slack_steps, &dual_steps, one);
        let wanted = (self.gap(it) / degree * (left * left * left)).at_least(T::count(LEAST_PRODUCT) * T::ROUNDOFF);
        // Then with the curvature that this step has met, towards the central path; or, where that is a short way, straight to its
        // nearest point.
        let centred = |product: T, met: T| {
            let mut q = towards;
            for i in 0..K {
                if self.has_cone(i) {
                    let [first, a, b, c] = jordan(&slack_steps.0[i], &dual_steps.0[i]).map(|x| -x * met);
                    let wanted = divided(&points.0[i], &[product + first, a, b, c]);
                    add(&mut q.0[i], T::one(), &wanted);
                }
            }
            for r in 0..R {
                if self.has_row(r) {
                    q.1[r] += (product - met * (slack_steps.1[r] * dual_steps.1[r])) / points.1[r];
                }
            }
            let (dz, slacks) = direction(&q);
            let duals = duals(&q, &slacks);
            let length = longest(&slacks, &duals, T::of(0.99));
            (dz, slacks, duals, length)
        };
        let mut step = centred(wanted, one);
        if step.3 < T::of(0.25) {
            step = centred(self.gap(it) / degree, zero);
        }
        let (dz, slack_steps, dual_steps, length) = step;

        let moved = |length: T| {
            let mut next = it.clone();
            add(&mut next.z, length, &dz);
            for i in 0..K {
                if self.has_cone(i) {
                    let (slack, dual) = (scalings[i].apply(&slack_steps.0[i]), scalings[i].inverse(&dual_steps.0[i]));
                    add(&mut next.cone_slacks[i], length, &slack);
                    add(&mut next.cone_duals[i], length, &dual);
                    if !(inside(&next.cone_slacks[i]) && inside(&next.cone_duals[i])) {
                        return None;
                    }
                }
            }
            for r in 0..R {
                if self.has_row(r) {
                    next.row_slacks[r] += length * (slack_steps.1[r] * widths[r]);
                    next.row_duals[r] += length * (dual_steps.1[r] / widths[r]);
                    if !(next.row_slacks[r] > zero && next.row_duals[r] > zero) {
                        return None;
                    }
                }
            }
            next.z.iter().all(|x| x.finite()).then_some(next)
        };
        // Rounding may be more than what is left to the edge.
        let mut length = length;
        for _ in 0..SHORTER {
            if let Some(next) = moved(length) {
                return Some(next);
            }
            length *= T::of(0.5);
        }
        None
    }
}

/// The scaling W of a cone: symmetric, maps L onto itself, and `W dual = W^-1 slack`, which is `point`.
/// `W = beta (2 v v^T - J)` with J = diag(1, -1, -1, -1).
#[derive(Clone, Copy)]
struct Scaling<T> {
    beta: T,
    v: [T; 4],
    point: [T; 4],
}

impl<T: Real> Scaling<T> {
    fn new(slack: &[T; 4], dual: &[T; 4]) -> Option<Self> {
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

    fn apply(&self, x: &[T; 4]) -> [T; 4] {
        let (along, mirrored) = (T::count(2) * dot(&self.v, x), reflected(x));
        core::array::from_fn(|c| self.beta * (self.v[c] * along - mirrored[c]))
    }

    fn inverse(&self, x: &[T; 4]) -> [T; 4] {
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

fn inside<T: Real>(x: &[T; 4]) -> bool {
    let [s, ..] = *x;
    s > T::zero() && determinant(x) > T::zero()
}

/// The product of the cone's Jordan algebra: (x.y, x_0 y_1 + y_0 x_1).
fn jordan<T: Real>(x: &[T; 4], y: &[T; 4]) -> [T; 4] {
    let mut product = core::array::from_fn(|c| x[0] * y[c] + y[0] * x[c]);
    product[0] = dot(x, y);
    product
}

/// The y with `jordan(x, y) = d`, for x inside of the cone.
fn divided<T: Real>(x: &[T; 4], d: &[T; 4]) -> [T; 4] {
    let first = dot(&reflected(x), d) / determinant(x);
    let mut y = core::array::from_fn(|c| (d[c] - first * x[c]) / x[0]);
    y[0] = first;
    y
}

/// 1 / t for the t at which `point + t step` leaves the cone; 0 or less: it never does.
fn exit<T: Real>(point: &[T; 4], step: &[T; 4]) -> T {
    let size = determinant(point).root();
    let (p, d) = (point.map(|x| x / size), step.map(|x| x / size));
    let first = dot(&reflected(&p), &d);
    let share = (first + d[0]) / (p[0] + T::one());
    let [_, a, b, c] = core::array::from_fn(|i| d[i] - share * p[i]);
    (a * a + b * b + c * c).root() - first
}

fn add<T: Real, const M: usize>(to: &mut [T; M], factor: T, x: &[T; M]) {
    to.iter_mut().zip(x).for_each(|(t, &x)| *t += factor * x);
}

/// x.y.
fn product<T: Real, const K: usize, const R: usize>(x: &Sides<T, K, R>, y: &Sides<T, K, R>) -> T {
    x.0.iter().zip(&y.0).fold(dot(&x.1, &y.1), |s, (x, y)| s + dot(x, y))
}

fn add_sides<T: Real, const K: usize, const R: usize>(to: &mut Sides<T, K, R>, factor: T, x: &Sides<T, K, R>) {
    to.0.iter_mut().zip(&x.0).for_each(|(t, x)| add(t, factor, x));
    add(&mut to.1, factor, &x.1);
}

/// Q U of the scaled constraints, by columns of Q; U upper triangular. Directions that no constraint sees, the
/// padding of smaller programs, get no step.
struct Factor<T, const K: usize, const N: usize, const R: usize> {
    columns: [Sides<T, K, R>; N],
    upper: [[T; N]; N],
    /// 1 / diagonal, or 0.
    inverse: [T; N],
}

impl<T: Real, const K: usize, const N: usize, const R: usize> Factor<T, K, N, R> {
    /// Gram-Schmidt, each column twice, or almost dependent ones would not be orthogonal. Dependent ones get no step.
    fn new(mut columns: [Sides<T, K, R>; N]) -> Self {
        let (mut upper, mut inverse) = ([[T::zero(); N]; N], [T::zero(); N]);
        for j in 0..N {
            let mut column = columns[j];
            let whole = product(&column, &column);
            for _ in 0..2 {
                for k in 0..j {
                    let along = product(&columns[k], &column);
                    upper[k][j] += along;
                    add_sides(&mut column, -along, &columns[k]);
                }
            }
            let rest = product(&column, &column);
            if rest > T::ROUNDOFF * T::ROUNDOFF * whole {
                inverse[j] = rest.root().recip();
            }
            column.0.iter_mut().flatten().chain(&mut column.1).for_each(|x| *x *= inverse[j]);
            columns[j] = column;
        }
        Self { columns, upper, inverse }
    }

    /// U^-T x.
    fn forward(&self, x: &[T; N]) -> [T; N] {
        let mut x = *x;
        for i in 0..N {
            let rest = (0..i).fold(x[i], |s, k| s - self.upper[k][i] * x[k]);
            x[i] = rest * self.inverse[i];
        }
        x
    }

    /// U^-1 x.
    fn backward(&self, x: &[T; N]) -> [T; N] {
        let mut x = *x;
        for i in (0..N).rev() {
            let rest = (i + 1..N).fold(x[i], |s, k| s - self.upper[i][k] * x[k]);
            x[i] = rest * self.inverse[i];
        }
        x
    }
}
