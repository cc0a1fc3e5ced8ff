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

use super::lorentz::{Scaling, divided, exit, inside, jordan};
use crate::math::dot;
use crate::scalar::Real;

/// The program without its objective.
pub(super) struct ConeProgram<T, const K: usize, const N: usize, const R: usize> {
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

impl<T: Real, const K: usize, const N: usize, const R: usize> ConeProgram<T, K, N, R> {
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
        let one = T::one();
        let mut scaled = Scaled::empty();
        if !scaled.scale(self, it) {
            return None;
        }
        scaled.factor.orthogonalise();
        scaled.residual = scaled.factor.forward(&self.residual(b, it));

        // Straight to complementarity zero, to see how far that goes.
        let (mut straight, mut step) = (Step::empty(), Step::empty());
        scaled.solve(&scaled.towards_zero(), &mut straight);
        let left = one - self.longest(&scaled, &straight, one);
        let gap = self.gap(it) / scaled.degree;
        let wanted = (gap * (left * left * left)).at_least(T::count(LEAST_PRODUCT) * T::ROUNDOFF);
        // Then with the curvature that this step has met, towards the central path; or, where that is a short way, straight to its
        // nearest point.
        let mut length = self.centre(&scaled, &straight, wanted, one, &mut step);
        if length < T::of(0.25) {
            length = self.centre(&scaled, &straight, gap, T::zero(), &mut step);
        }
        // Rounding may be more than what is left to the edge.
        for _ in 0..SHORTER {
            if let Some(next) = self.moved(&scaled, it, &step, length) {
                return Some(next);
            }
            length *= T::of(0.5);
        }
        None
    }

    /// How far one can go, up to 1: the share of the way to the nearest edge.
    fn longest(&self, scaled: &Scaled<T, K, N, R>, step: &Step<T, K, N, R>, share: T) -> T {
        let reach = |sides: &Sides<T, K, R>| {
            let mut inverse = T::zero();
            for i in 0..K {
                if self.has_cone(i) {
                    inverse = inverse.at_least(exit(&scaled.points.0[i], &sides.0[i]));
                }
            }
            for r in 0..R {
                if self.has_row(r) {
                    inverse = inverse.at_least(-sides.1[r] / scaled.points.1[r]);
                }
            }
            inverse
        };
        let inverse = reach(&step.slacks).at_least(reach(&step.duals));
        if inverse > share { share / inverse } else { T::one() }
    }

    /// The step to where all products of slack and dual are `product`, if a step `straight` has met the share `met` of its own curvature; and how far
    /// to go along it.
    fn centre(
        &self,
        scaled: &Scaled<T, K, N, R>,
        straight: &Step<T, K, N, R>,
        product: T,
        met: T,
        step: &mut Step<T, K, N, R>,
    ) -> T {
        let mut q = scaled.towards_zero();
        for i in 0..K {
            if self.has_cone(i) {
                let [first, a, b, c] = jordan(&straight.slacks.0[i], &straight.duals.0[i]).map(|x| -x * met);
                let wanted = divided(&scaled.points.0[i], &[product + first, a, b, c]);
                add(&mut q.0[i], T::one(), &wanted);
            }
        }
        for r in 0..R {
            if self.has_row(r) {
                q.1[r] += (product - met * (straight.slacks.1[r] * straight.duals.1[r])) / scaled.points.1[r];
            }
        }
        scaled.solve(&q, step);
        self.longest(scaled, step, T::of(0.99))
    }

    /// The iterate after so much of a step, if it is strictly inside.
    fn moved(
        &self,
        scaled: &Scaled<T, K, N, R>,
        it: &Iterate<T, K, N, R>,
        step: &Step<T, K, N, R>,
        length: T,
    ) -> Option<Iterate<T, K, N, R>> {
        let mut next = it.clone();
        add(&mut next.z, length, &step.z);
        for i in 0..K {
            if self.has_cone(i) {
                let scaling = &scaled.scalings[i];
                let (slack, dual) = (scaling.apply(&step.slacks.0[i]), scaling.inverse(&step.duals.0[i]));
                add(&mut next.cone_slacks[i], length, &slack);
                add(&mut next.cone_duals[i], length, &dual);
                if !(inside(&next.cone_slacks[i]) && inside(&next.cone_duals[i])) {
                    return None;
                }
            }
        }
        for r in 0..R {
            if self.has_row(r) {
                next.row_slacks[r] += length * (step.slacks.1[r] * scaled.widths[r]);
                next.row_duals[r] += length * (step.duals.1[r] / scaled.widths[r]);
                if !(next.row_slacks[r] > T::zero() && next.row_duals[r] > T::zero()) {
                    return None;
                }
            }
        }
        next.z.iter().all(|x| x.finite()).then_some(next)
    }
}

/// Steps of z, and those of slacks and duals in scaled coordinates.
struct Step<T, const K: usize, const N: usize, const R: usize> {
    z: [T; N],
    slacks: Sides<T, K, R>,
    duals: Sides<T, K, R>,
}

impl<T: Real, const K: usize, const N: usize, const R: usize> Step<T, K, N, R> {
    #[inline(always)]
    fn empty() -> Self {
        Self { z: [T::zero(); N], slacks: no_sides(), duals: no_sides() }
    }
}

/// The constraints in scaled coordinates, where slack and dual are the same point. All of what a step needs is here, in one frame of the stack: its
/// parts take it by reference, since the columns are some kilobytes.
struct Scaled<T, const K: usize, const N: usize, const R: usize> {
    scalings: [Scaling<T>; K],
    widths: [T; R],
    points: Sides<T, K, R>,
    /// Number of constraints.
    degree: T,
    factor: Factor<T, K, N, R>,
    /// U^-T times what the duals leave of the equation.
    residual: [T; N],
}

impl<T: Real, const K: usize, const N: usize, const R: usize> Scaled<T, K, N, R> {
    #[inline(always)]
    fn empty() -> Self {
        let zero = T::zero();
        Self {
            scalings: [Scaling::none(); K],
            widths: [T::one(); R],
            points: no_sides(),
            degree: zero,
            factor: Factor { columns: [no_sides(); N], upper: [[zero; N]; N], inverse: [zero; N] },
            residual: [zero; N],
        }
    }

    /// Scalings, points and columns at the iterate; false where it is not strictly inside.
    fn scale(&mut self, program: &ConeProgram<T, K, N, R>, it: &Iterate<T, K, N, R>) -> bool {
        for i in 0..K {
            if program.has_cone(i) {
                let Some(scaling) = Scaling::new(&it.cone_slacks[i], &it.cone_duals[i]) else { return false };
                for d in 0..N {
                    self.factor.columns[d].0[i] = scaling.inverse(&program.cones[i].map(|row| row[d]));
                }
                self.points.0[i] = scaling.point;
                self.scalings[i] = scaling;
                self.degree += T::one();
            }
        }
        for r in 0..R {
            if program.has_row(r) {
                let (slack, dual) = (it.row_slacks[r], it.row_duals[r]);
                self.widths[r] = (slack / dual).root();
                for d in 0..N {
                    self.factor.columns[d].1[r] = -program.rows[r][d] / self.widths[r];
                }
                self.points.1[r] = (slack * dual).root();
                self.degree += T::one();
            }
        }
        true
    }

    /// The sums of slack and dual steps that lead to complementarity zero.
    fn towards_zero(&self) -> Sides<T, K, R> {
        (self.points.0.map(|p| p.map(|x| -x)), self.points.1.map(|x| -x))
    }

    /// The steps for wanted sums q of slack and dual steps.
    fn solve(&self, q: &Sides<T, K, R>, step: &mut Step<T, K, N, R>) {
        // What is left of q, in the place of what comes of it.
        let rest = &mut step.duals;
        *rest = *q;
        let mut y = self.residual;
        // Twice: what the duals get is then orthogonal to the constraints to rounding, and no residual is made.
        for _ in 0..2 {
            for (y, column) in y.iter_mut().zip(&self.factor.columns) {
                let along = product(column, rest);
                *y += along;
                add_sides(rest, -along, column);
            }
        }
        step.slacks = *q;
        add_sides(&mut step.slacks, -T::one(), rest);
        for (t, column) in self.residual.iter().zip(&self.factor.columns) {
            add_sides(&mut step.slacks, *t, column);
        }
        step.z = self.factor.backward(&y);
        step.duals = *q;
        add_sides(&mut step.duals, -T::one(), &step.slacks);
    }
}

fn add<T: Real, const M: usize>(to: &mut [T; M], factor: T, x: &[T; M]) {
    to.iter_mut().zip(x).for_each(|(t, &x)| *t += factor * x);
}

#[inline(always)]
fn no_sides<T: Real, const K: usize, const R: usize>() -> Sides<T, K, R> {
    ([[T::zero(); 4]; K], [T::zero(); R])
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
    /// Gram-Schmidt, each column twice, or almost dependent ones would not be orthogonal. Dependent ones get no step. In place, from the constraints'
    /// own columns.
    fn orthogonalise(&mut self) {
        for j in 0..N {
            let mut column = self.columns[j];
            let whole = product(&column, &column);
            for _ in 0..2 {
                for k in 0..j {
                    let along = product(&self.columns[k], &column);
                    self.upper[k][j] += along;
                    add_sides(&mut column, -along, &self.columns[k]);
                }
            }
            let rest = product(&column, &column);
            if rest > T::ROUNDOFF * T::ROUNDOFF * whole {
                self.inverse[j] = rest.root().recip();
            }
            column.0.iter_mut().flatten().chain(&mut column.1).for_each(|x| *x *= self.inverse[j]);
            self.columns[j] = column;
        }
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
