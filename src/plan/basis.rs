//! N points of R^N and the inverse of their matrix: the basis of a revised simplex method, point by point.
//!
//! Coordinates of x are the weights that make x of the points. Exchanging a point costs N^2 operations. The inverse is updated, and
//! its error is not bounded: whoever concludes something from it measures first, and may [`polish`](Basis::polish).

use crate::math::Vector;
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;
use nalgebra::SMatrix;

/// N points, some of them *artificial*: there only to begin with.
#[derive(Clone)]
pub(crate) struct Basis<T, const N: usize> {
    pub points: [Vertex<T, N>; N],
    pub artificial: [bool; N],
    pub inverse: SMatrix<T, N, N>,
}

impl<T: Real, const N: usize> Basis<T, N> {
    /// Artificial points on the axes, at these coordinates, none of them zero.
    pub fn new(along: &Vector<T, N>) -> Self {
        let mut basis = Basis { points: [Vertex::empty(); N], artificial: [true; N], inverse: SMatrix::zeros() };
        for i in 0..N {
            basis.points[i].point[i] = along[i];
            basis.inverse[(i, i)] = T::one() / along[i];
        }
        basis
    }

    /// The coordinates of a point.
    pub fn coordinates(&self, point: &Vector<T, N>) -> Vector<T, N> {
        self.inverse * point
    }

    /// The point with these coordinates.
    pub fn point(&self, coordinates: &Vector<T, N>) -> Vector<T, N> {
        let mut point = Vector::zeros();
        for i in 0..N {
            point += self.points[i].point * coordinates[i];
        }
        point
    }

    /// y with y.a_i = `costs`_i for all points a_i.
    pub fn plane(&self, costs: &Vector<T, N>) -> Vector<T, N> {
        let mut plane = Vector::zeros();
        for j in 0..N {
            for i in 0..N {
                plane[j] += self.inverse[(i, j)] * costs[i];
            }
        }
        plane
    }

    /// Puts a point with these `coordinates` in the place `out`, whose coordinate is not zero.
    pub fn exchange(&mut self, out: usize, vertex: &Vertex<T, N>, coordinates: &Vector<T, N>) {
        let mut row = Vector::<T, N>::zeros();
        for i in 0..N {
            if i == out {
                let pivot = T::one() / coordinates[i];
                self.points[i] = *vertex;
                self.artificial[i] = false;
                for j in 0..N {
                    self.inverse[(i, j)] *= pivot;
                    row[j] = self.inverse[(i, j)];
                }
            }
        }
        for i in 0..N {
            if i != out {
                for j in 0..N {
                    self.inverse[(i, j)] -= coordinates[i] * row[j];
                }
            }
        }
    }

    /// One step of Newton's iteration for the inverse, X (2 - B X).
    pub fn polish(&mut self) {
        let mut miss = SMatrix::<T, N, N>::identity();
        for k in 0..N {
            for j in 0..N {
                for i in 0..N {
                    miss[(i, j)] -= self.points[k].point[i] * self.inverse[(k, j)];
                }
            }
        }
        self.inverse += self.inverse * miss;
    }

    /// The inverse anew, by elimination with row pivots; stays as it is when the points have become dependent.
    #[cfg(feature = "grasp")] // nobody else needs it
    pub fn rebuild(&mut self) {
        let mut left = SMatrix::<T, N, N>::from_fn(|i, j| self.points[j].point[i]);
        let mut right = SMatrix::<T, N, N>::identity();
        for c in 0..N {
            let mut largest = T::zero();
            let mut best = c;
            for r in c..N {
                if left[(r, c)].abs() > largest {
                    (largest, best) = (left[(r, c)].abs(), r);
                }
            }
            if !(largest > T::zero()) {
                return;
            }
            for r in c..N {
                if r == best && r != c {
                    for j in 0..N {
                        (left[(r, j)], left[(c, j)]) = (left[(c, j)], left[(r, j)]);
                        (right[(r, j)], right[(c, j)]) = (right[(c, j)], right[(r, j)]);
                    }
                }
            }
            let pivot = T::one() / left[(c, c)];
            for j in 0..N {
                left[(c, j)] *= pivot;
                right[(c, j)] *= pivot;
            }
            for r in 0..N {
                let factor = left[(r, c)];
                if r != c {
                    for j in 0..N {
                        let (a, b) = (left[(c, j)], right[(c, j)]);
                        left[(r, j)] -= factor * a;
                        right[(r, j)] -= factor * b;
                    }
                }
            }
        }
        // Y + (1 - Y B) Y: now each row x has x.a_k right to the rounding of the row itself, however large others are.
        let mut miss = SMatrix::<T, N, N>::identity();
        for i in 0..N {
            for k in 0..N {
                for j in 0..N {
                    miss[(i, k)] -= right[(i, j)] * self.points[k].point[j];
                }
            }
        }
        let refined = right + miss * right;
        if refined.iter().all(|x| x.finite()) {
            self.inverse = refined;
        }
    }
}
