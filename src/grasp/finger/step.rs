//! One step of the interior point method: predictor, corrector, and how far they go.

use super::super::svd::dot;
use super::lorentz::{Scaling, add, divided, exit, inside, jordan};
use super::program::{Iterate, Program};
use crate::scalar::Real;

/// Products of slack and dual are not made smaller than this many roundoffs: what would be gained is lost to rounding.
const LEAST_PRODUCT: usize = 4;
/// Tries to shorten a step that rounding has carried over an edge.
const SHORTER: usize = 6;

/// A number for each constraint, in the order of cones and rows.
type Sides<T, const K: usize, const R: usize> = ([[T; 4]; K], [T; R]);

/// A step of z, those of slacks and duals in scaled coordinates, and how much of it stays inside.
struct Step<T, const K: usize, const N: usize, const R: usize> {
    z: [T; N],
    slacks: Sides<T, K, R>,
    duals: Sides<T, K, R>,
    length: T,
}

/// The linear equations of a step, in scaled coordinates, where slack and dual are the same point.
struct Equations<'p, T, const K: usize, const N: usize, const R: usize> {
    program: &'p Program<T, K, N, R>,
    at: &'p Iterate<T, K, N, R>,
    scalings: [Scaling<T>; K],
    widths: [T; R],
    points: Sides<T, K, R>,
    /// The number of constraints.
    degree: T,
    factor: Factor<T, K, N, R>,
    residual: [T; N],
}

/// One step towards the optimum; `None` when arithmetic has nothing left to say.
pub(super) fn step<T: Real, const K: usize, const N: usize, const R: usize>(
    program: &Program<T, K, N, R>,
    b: &[T; N],
    at: &Iterate<T, K, N, R>,
) -> Option<Iterate<T, K, N, R>> {
    let one = T::one();
    let equations = Equations::new(program, b, at)?;
    let (degree, gap) = (equations.degree, program.gap(at));
    // Straight to complementarity zero, to see how far that goes.
    let straight = equations.straight();
    let left = one - straight.length;
    let wanted = (gap / degree * (left * left * left)).at_least(T::count(LEAST_PRODUCT) * T::ROUNDOFF);
    // Then with the curvature that this step has met, towards the central path; or, where that is a short way, straight to its
    // nearest point.
    let mut step = equations.centred(&straight, wanted, one);
    if step.length < T::of(0.25) {
        step = equations.centred(&straight, gap / degree, T::zero());
    }
    // Rounding may be more than what is left to the edge.
    let mut length = step.length;
    for _ in 0..SHORTER {
        if let Some(next) = equations.moved(&step, length) {
            return Some(next);
        }
        length *= T::of(0.5);
    }
    None
}

impl<'p, T: Real, const K: usize, const N: usize, const R: usize> Equations<'p, T, K, N, R> {
    fn new(program: &'p Program<T, K, N, R>, b: &[T; N], at: &'p Iterate<T, K, N, R>) -> Option<Self> {
        let (zero, one) = (T::zero(), T::one());
        let (mut scalings, mut widths) = ([Scaling::none(); K], [one; R]);
        let mut columns: [Sides<T, K, R>; N] = [([[zero; 4]; K], [zero; R]); N];
        let mut points: Sides<T, K, R> = ([[zero; 4]; K], [zero; R]);
        let mut degree = zero;
        for i in 0..K {
            if program.has_cone(i) {
                scalings[i] = Scaling::new(&at.cone_slacks[i], &at.cone_duals[i])?;
                for d in 0..N {
                    columns[d].0[i] = scalings[i].inverse(&program.cones[i].map(|row| row[d]));
                }
                points.0[i] = scalings[i].point;
                degree += one;
            }
        }
        for r in 0..R {
            if program.has_row(r) {
                let (slack, dual) = (at.row_slacks[r], at.row_duals[r]);
                widths[r] = (slack / dual).root();
                for d in 0..N {
                    columns[d].1[r] = -program.rows[r][d] / widths[r];
                }
                points.1[r] = (slack * dual).root();
                degree += one;
            }
        }
        let factor = Factor::new(columns);
        let residual = factor.forward(&program.residual(b, at));
        Some(Self { program, at, scalings, widths, points, degree, factor, residual })
    }

    /// For wanted sums q of scaled slack and dual steps: the step of z, and those of the slacks and the duals.
    fn direction(&self, q: &Sides<T, K, R>) -> ([T; N], Sides<T, K, R>, Sides<T, K, R>) {
        let (mut rest, mut y) = (*q, self.residual);
        // Twice: what the duals get is then orthogonal to the constraints to rounding, and no residual is made.
        for _ in 0..2 {
            for (y, column) in y.iter_mut().zip(&self.factor.columns) {
                let along = product(column, &rest);
                *y += along;
                add_sides(&mut rest, -along, column);
            }
        }
        let mut slacks = *q;
        add_sides(&mut slacks, -T::one(), &rest);
        for (t, column) in self.residual.iter().zip(&self.factor.columns) {
            add_sides(&mut slacks, *t, column);
        }
        let duals = (
            core::array::from_fn(|i| core::array::from_fn(|c| q.0[i][c] - slacks.0[i][c])),
            core::array::from_fn(|r| q.1[r] - slacks.1[r]),
        );
        (self.factor.backward(&y), slacks, duals)
    }

    /// The step for these sums, of which this share of what there is until the edge is gone at most.
    fn step(&self, q: &Sides<T, K, R>, share: T) -> Step<T, K, N, R> {
        let (z, slacks, duals) = self.direction(q);
        let inverse = self.reach(&slacks).at_least(self.reach(&duals));
        let length = if inverse > share { share / inverse } else { T::one() };
        Step { z, slacks, duals, length }
    }

    /// 1 / t for the t at which the step leaves the constraints; 0: it never does.
    fn reach(&self, step: &Sides<T, K, R>) -> T {
        let mut inverse = T::zero();
        for i in 0..K {
            if self.program.has_cone(i) {
                inverse = inverse.at_least(exit(&self.points.0[i], &step.0[i]));
            }
        }
        for r in 0..R {
            if self.program.has_row(r) {
                inverse = inverse.at_least(-step.1[r] / self.points.1[r]);
            }
        }
        inverse
    }

    fn towards_zero(&self) -> Sides<T, K, R> {
        (self.points.0.map(|p| p.map(|x| -x)), self.points.1.map(|x| -x))
    }

    /// The step to complementarity zero.
    fn straight(&self) -> Step<T, K, N, R> {
        self.step(&self.towards_zero(), T::one())
    }

    /// The step to products of this size, with the share `met` of the curvature that the straight step has met.
    fn centred(&self, straight: &Step<T, K, N, R>, size: T, met: T) -> Step<T, K, N, R> {
        let mut q = self.towards_zero();
        for i in 0..K {
            if self.program.has_cone(i) {
                let [first, a, b, c] = jordan(&straight.slacks.0[i], &straight.duals.0[i]).map(|x| -x * met);
                let wanted = divided(&self.points.0[i], &[size + first, a, b, c]);
                add(&mut q.0[i], T::one(), &wanted);
            }
        }
        for r in 0..R {
            if self.program.has_row(r) {
                q.1[r] += (size - met * (straight.slacks.1[r] * straight.duals.1[r])) / self.points.1[r];
            }
        }
        self.step(&q, T::of(0.99))
    }

    /// The iterate after a part of a step; `None` where rounding has carried it over an edge.
    fn moved(&self, step: &Step<T, K, N, R>, length: T) -> Option<Iterate<T, K, N, R>> {
        let mut next = self.at.clone();
        add(&mut next.z, length, &step.z);
        for i in 0..K {
            if self.program.has_cone(i) {
                let scaling = &self.scalings[i];
                let (slack, dual) = (scaling.apply(&step.slacks.0[i]), scaling.inverse(&step.duals.0[i]));
                add(&mut next.cone_slacks[i], length, &slack);
                add(&mut next.cone_duals[i], length, &dual);
                if !(inside(&next.cone_slacks[i]) && inside(&next.cone_duals[i])) {
                    return None;
                }
            }
        }
        for r in 0..R {
            if self.program.has_row(r) {
                next.row_slacks[r] += length * (step.slacks.1[r] * self.widths[r]);
                next.row_duals[r] += length * (step.duals.1[r] / self.widths[r]);
                if !(next.row_slacks[r] > T::zero() && next.row_duals[r] > T::zero()) {
                    return None;
                }
            }
        }
        next.z.iter().all(|x| x.finite()).then_some(next)
    }
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
