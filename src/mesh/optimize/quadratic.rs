//! One quadratic program: the least of a metric's quadratic model under contacts and a trust box.
//!
//! With the Cholesky factor H = L L^T and x = L^T y + L^-1 g the square of the metric is |x|^2 plus a constant, and a
//! constraint a.y >= b is (L^-1 a).x >= b + (L^-1 a).(L^-1 g): the nearest point of a polyhedron (module `project`).
//! Directions that the metric hardly sees (pivots below 1e-14 of the largest) get that much stiffness, so that the program is
//! strictly convex.
//!
//! **Contradicting constraints.** Then every contact yields by one more variable e, which costs: minimise e^2 + d |x|^2 with a tiny d,
//! or |x|^2 + z^2 with e = sqrt(d) z. That is the least of the largest violation to about d, and among the motions that attain
//! it one of the best. The trust box does not yield.

use super::project::{End, LAST, Projected, Row, WIDTH, Wide, project};
use super::{Linear, Quadratic};
use nalgebra::{Matrix6, Vector6};

/// Rows of a trust box.
pub const TRUST_ROWS: usize = 12;
/// sqrt(d).
const YIELD: f64 = 1e-5;

/// A Cholesky factor.
pub struct Factor {
    lower: [[f64; 6]; 6],
    inverse: [f64; 6],
}

impl Factor {
    pub fn new(hessian: &Matrix6<f64>) -> Self {
        let largest = (0..6).fold(f64::MIN_POSITIVE, |m, i| f64::max(m, hessian[(i, i)]));
        let mut lower = [[0.0; 6]; 6];
        let mut inverse = [0.0; 6];
        for i in 0..6 {
            for j in 0..=i {
                let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
                let left = hessian[(i, j)] - known;
                if i == j {
                    lower[i][i] = left.max(1e-14 * largest).sqrt();
                    inverse[i] = 1.0 / lower[i][i];
                } else {
                    lower[i][j] = left * inverse[j];
                }
            }
        }
        Factor { lower, inverse }
    }

    /// L^-1 v, with room for more.
    #[inline]
    pub fn forward(&self, v: &Vector6<f64>) -> Wide {
        let mut x = [0.0; WIDTH];
        for i in 0..6 {
            let mut sum = v[i];
            for k in 0..i {
                sum -= self.lower[i][k] * x[k];
            }
            x[i] = sum * self.inverse[i];
        }
        x
    }

    /// L^-T x, of the first six.
    pub fn backward(&self, x: &Wide) -> Vector6<f64> {
        let mut y = Vector6::zeros();
        for i in (0..6).rev() {
            let known: f64 = (i + 1..6).map(|k| self.lower[k][i] * y[k]).sum();
            y[i] = (x[i] - known) * self.inverse[i];
        }
        y
    }
}

/// The walls of the trust box around 0, none where it is infinite.
pub fn walls(trust: f64) -> impl Iterator<Item = Linear> {
    let count = if trust.is_finite() { TRUST_ROWS } else { 0 };
    (0..count).map(move |k| {
        let mut normal = Vector6::zeros();
        normal[k % 6] = if k < 6 { 1.0 } else { -1.0 };
        Linear { normal, offset: -trust }
    })
}

/// The largest violation of these constraints, at least 0.
pub fn violation(constraints: &[Linear], y: &Vector6<f64>) -> f64 {
    constraints.iter().fold(0.0, |m, c| f64::max(m, c.offset - c.normal.dot(y)))
}

/// A program's solution.
pub struct Solution {
    pub y: Vector6<f64>,
    pub end: End,
    /// Programs solved: 1, or 2 where the constraints contradict each other.
    pub programs: usize,
}

/// Minimises the quadratic; where that is impossible, the largest violation.
pub fn minimise(quadratic: &Quadratic, contacts: &[Linear], trust: f64, rows: &mut Vec<Row>) -> Solution {
    let factor = Factor::new(&quadratic.hessian);
    let shift = factor.forward(&quadratic.gradient);
    let back = |projected: &Projected| {
        let mut x = projected.point;
        x.iter_mut().zip(&shift).for_each(|(x, s)| *x -= s);
        factor.backward(&x)
    };
    fill(rows, &factor, &shift, contacts, trust, 0.0);
    let strict = project(rows, 6);
    if strict.end == End::Found {
        return Solution { y: back(&strict), end: End::Found, programs: 1 };
    }
    fill(rows, &factor, &shift, contacts, trust, YIELD);
    let yielding = project(rows, 7);
    // A point of the yielding program that violates nothing refutes that the strict one is empty.
    let end = if strict.end == End::Limit || yielding.end != End::Found { End::Limit } else { End::Empty };
    Solution { y: back(&yielding), end, programs: 2 }
}

fn fill(rows: &mut Vec<Row>, factor: &Factor, shift: &Wide, contacts: &[Linear], trust: f64, yields: f64) {
    rows.clear();
    let mut add = |c: &Linear, extra: f64| {
        let mut normal = factor.forward(&c.normal);
        let offset = c.offset + crate::math::dot(&normal, shift);
        normal[LAST] = extra;
        rows.push(Row::new(normal, offset));
    };
    contacts.iter().for_each(|c| add(c, yields));
    walls(trust).for_each(|c| add(&c, 0.0));
}
