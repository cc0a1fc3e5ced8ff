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
//! The cone's own algebra is in `lorentz`, one step of the method in `step`.
//!
//! * L. Vandenberghe, *The CVXOPT linear and quadratic cone program solvers*, 2010 (all formulas).

use super::super::svd::dot;
use super::lorentz::add;
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

impl<T: Real, const K: usize, const N: usize, const R: usize> Program<T, K, N, R> {
    pub fn has_cone(&self, i: usize) -> bool {
        self.cones.get(i).is_some_and(|[first, ..]| first.iter().any(|x| !x.is_zero()))
    }

    pub fn has_row(&self, r: usize) -> bool {
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
}
