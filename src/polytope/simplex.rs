//! Small simplices, and the point of one nearest to the origin.
//!
//! It rests on Gram-Schmidt over at most N edges, with no matrix to invert and nothing to pivot on that could vanish
//! unnoticed.

use crate::math::{Vector, norm, unit, zeros};
use crate::scalar::Real;
use heapless::Vec;

/// The most vertices that a simplex in R^N can have here, N + 1 <= 7.
pub const MAX_CORNERS: usize = 7;

/// A support point: a point of A, and the witness that came with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex<T, const N: usize> {
    /// A point of A.
    pub point: Vector<T, N>,
    /// For a difference of two bodies, the point of the first one; elsewhere `point` itself.
    pub witness: Vector<T, N>,
}

impl<T: Real, const N: usize> Vertex<T, N> {
    /// Fills untouched memory.
    pub const fn empty() -> Self {
        Vertex { point: zeros(), witness: zeros() }
    }
}

/// A simplex with the barycentric weights of its point nearest to the origin.
#[derive(Clone, Debug)]
pub struct Simplex<T, const N: usize> {
    pub(crate) corners: Vec<Corner<T, N>, MAX_CORNERS>,
}

/// A vertex and its barycentric weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corner<T, const N: usize> {
    /// The point and its witness.
    pub vertex: Vertex<T, N>,
    /// Barycentric weight, >= 0; the weights add up to 1.
    pub weight: T,
}

/// Gram-Schmidt without square roots: orthogonal vectors q_i, and the unit upper triangle R with e_j = sum over i <= j of
/// R[i][j] q_i for the edges e_j = v_j - v_0.
pub(crate) struct Edges<T, const N: usize> {
    pub q: [Vector<T, N>; N],
    /// 1 / |q_i|^2
    pub inverse: [T; N],
    r: [[T; N]; N],
    pub count: usize,
}

impl<T: Real, const N: usize> Edges<T, N> {
    pub fn new() -> Self {
        Edges { q: [Vector::zeros(); N], inverse: [T::zero(); N], r: [[T::zero(); N]; N], count: 0 }
    }

    /// Adds an edge; false when it lies in the span of the others up to `resolution`.
    #[inline(always)]
    pub fn push(&mut self, edge: &Vector<T, N>, resolution: T) -> bool {
        self.push_by::<false>(edge, resolution)
    }

    /// The same; `TWICE`: what cancellation leaves of the edge is made orthogonal once more.
    #[inline(always)]
    fn push_by<const TWICE: bool>(&mut self, edge: &Vector<T, N>, resolution: T) -> bool {
        let column = self.count;
        let mut rest = *edge;
        for i in 0..N {
            if i < column {
                let along = rest.dot(&self.q[i]) * self.inverse[i];
                rest -= self.q[i] * along;
                if let Some(entry) = self.r[i].get_mut(column) {
                    *entry = along;
                }
            }
        }
        let mut squared = rest.dot(&rest);
        if TWICE && squared < edge.dot(edge) * T::of(1e-3) {
            rest = self.cleared(&rest);
            squared = rest.dot(&rest);
        }
        if !(squared > resolution * resolution) {
            return false;
        }
        let (Some(q), Some(inverse)) = (self.q.get_mut(column), self.inverse.get_mut(column)) else { return false };
        *q = rest;
        *inverse = T::one() / squared;
        self.count += 1;
        true
    }

    /// The rest of an edge without what it still has along the others.
    #[cold]
    #[inline(never)]
    fn cleared(&mut self, rest: &Vector<T, N>) -> Vector<T, N> {
        let (column, mut rest) = (self.count, *rest);
        for (row, (q, inverse)) in self.r.iter_mut().zip(self.q.iter().zip(&self.inverse)).take(column) {
            let along = rest.dot(q) * *inverse;
            rest -= q * along;
            if let Some(entry) = row.get_mut(column) {
                *entry += along;
            }
        }
        rest
    }

    /// The part of v orthogonal to all edges.
    pub fn complement(&self, v: &Vector<T, N>) -> Vector<T, N> {
        let mut rest = *v;
        for i in 0..N {
            if i < self.count {
                rest -= self.q[i] * (rest.dot(&self.q[i]) * self.inverse[i]);
            }
        }
        rest
    }

    /// Solves R x = b by back substitution; the entries may be scalars or vectors.
    pub fn back_substitute<X>(&self, b: &mut [X; N])
    where
        X: Copy + core::ops::Sub<Output = X> + core::ops::Mul<T, Output = X>,
    {
        for i in (0..N).rev() {
            let mut x = b[i];
            for j in 0..N {
                if j > i && j < self.count {
                    x = x - b[j] * self.r[i][j];
                }
            }
            b[i] = x;
        }
    }
}

impl<T: Real, const N: usize> Simplex<T, N> {
    /// One point, with weight 1.
    pub fn new(vertex: Vertex<T, N>) -> Self {
        let mut simplex = Simplex::vacant();
        simplex.restart(&vertex);
        simplex
    }

    /// Room for one that is to be written.
    pub(crate) fn vacant() -> Self {
        Simplex { corners: Vec::new() }
    }

    /// One point again, with weight 1.
    pub(crate) fn restart(&mut self, vertex: &Vertex<T, N>) {
        self.corners.clear();
        let _ = self.corners.push(Corner { vertex: *vertex, weight: T::one() });
    }

    /// 1 to N + 1 vertices with their weights.
    pub fn corners(&self) -> &[Corner<T, N>] {
        &self.corners
    }

    /// The point that the weights stand for.
    pub fn point(&self) -> Vector<T, N> {
        self.corners.iter().fold(Vector::zeros(), |sum, c| sum + c.vertex.point * c.weight)
    }

    /// The witness that the weights stand for.
    pub fn witness(&self) -> Vector<T, N> {
        self.corners.iter().fold(Vector::zeros(), |sum, c| sum + c.vertex.witness * c.weight)
    }

    /// Adds a vertex with weight zero; false when the simplex is full.
    pub fn push(&mut self, vertex: Vertex<T, N>) -> bool {
        self.corners.len() <= N && self.corners.push(Corner { vertex, weight: T::zero() }).is_ok()
    }

    /// Moves all points, not the witnesses.
    pub(crate) fn translate(&mut self, by: &Vector<T, N>) {
        for corner in &mut self.corners {
            corner.vertex.point += by;
        }
    }

    /// Multiplies all points and witnesses.
    pub(crate) fn rescale(&mut self, factor: T) {
        if factor != T::one() {
            for corner in &mut self.corners {
                corner.vertex.point *= factor;
                corner.vertex.witness *= factor;
            }
        }
    }

    /// Unit vector from the simplex's point, at `distance`, towards the origin.
    ///
    /// The point is known to a roundoff of the vertices' norms, so close to the origin its direction is not. But the
    /// direction is orthogonal to the simplex, whose edges are long: what cancellation left along them is taken out.
    pub(crate) fn towards_origin(&self, distance: T, reach: T) -> Vector<T, N> {
        let rough = -unit(&self.point());
        let Some((first, rest)) = self.corners.split_first() else { return rough };
        if rest.is_empty() || distance > reach * T::of(1e-2) {
            return rough;
        }
        let mut edges = Edges::<T, N>::new();
        for corner in rest {
            edges.push(&(corner.vertex.point - first.vertex.point), T::zero());
        }
        let exact = edges.complement(&edges.complement(&rough));
        let length = norm(&exact);
        if length > T::of(0.1) { exact * (T::one() / length) } else { rough }
    }

    /// Moves the weights to the point of the simplex nearest to the origin and drops the corners that it does not
    /// need (Wolfe's minor cycle: minimise over the affine hull; while that leaves the simplex, walk to its
    /// boundary and drop what vanished). False when the corners are affinely dependent up to
    /// `resolution`: then the weights are still those of a point of the simplex, but perhaps not of the nearest.
    #[inline(always)]
    pub fn minimize(&mut self, resolution: T) -> bool {
        self.minimize_by::<false>(resolution)
    }

    /// The same; `TWICE`: for corners that are near each other and far from the rest.
    pub(crate) fn minimize_by<const TWICE: bool>(&mut self, resolution: T) -> bool {
        for _ in 0..MAX_CORNERS {
            let Some(target) = self.affine_minimizer::<TWICE>(resolution) else { return false };
            // The largest step from the weights towards the target that keeps all of them >= 0.
            let mut step = T::one();
            for (corner, &goal) in self.corners.iter().zip(&target) {
                if goal <= T::zero() && corner.weight - goal > T::zero() {
                    step = step.at_most(corner.weight / (corner.weight - goal));
                } else if goal <= T::zero() {
                    step = T::zero();
                }
            }
            let moved = |weight: T, goal: T| (weight + (goal - weight) * step).at_least(T::zero());
            let sum = self.corners.iter().zip(&target).fold(T::zero(), |sum, (c, &goal)| sum + moved(c.weight, goal));
            if !(sum > T::zero()) {
                return false;
            }
            for (corner, &goal) in self.corners.iter_mut().zip(&target) {
                corner.weight = moved(corner.weight, goal) / sum;
            }
            if step >= T::one() {
                return true;
            }
            self.drop_vanished(&target);
        }
        false
    }

    /// Removes the corners that the walk has brought to zero and that the target wants gone.
    fn drop_vanished(&mut self, target: &[T; MAX_CORNERS]) {
        let mut goals = target.iter();
        let tiny = T::count(4) * T::ROUNDOFF;
        self.corners.retain(|c| goals.next().is_some_and(|&g| c.weight > tiny || g > T::zero()));
    }

    /// Weights of the point of the affine hull nearest to the origin.
    fn affine_minimizer<const TWICE: bool>(&self, resolution: T) -> Option<[T; MAX_CORNERS]> {
        let mut weights = [T::zero(); MAX_CORNERS];
        let base = self.corners.first()?.vertex.point;
        let mut edges = Edges::<T, N>::new();
        for corner in self.corners.iter().skip(1) {
            if !edges.push_by::<TWICE>(&(corner.vertex.point - base), resolution) {
                return None;
            }
        }
        // v_0 + Q R x nearest to 0: R x = -Q^T v_0; then the same for what rounding left, which thin simplices need.
        let mut x = [T::zero(); N];
        let mut point = base;
        for _ in 0..2 {
            let mut step = [T::zero(); N];
            for i in 0..N {
                step[i] = -edges.q[i].dot(&point) * edges.inverse[i];
            }
            edges.back_substitute(&mut step);
            for i in 0..N {
                x[i] += step[i];
            }
            point = base;
            for (i, corner) in self.corners.iter().skip(1).enumerate() {
                if let Some(&along) = x.get(i) {
                    point += (corner.vertex.point - base) * along;
                }
            }
            let squared = point.dot(&point);
            if squared > base.dot(&base) * T::of(1e-6) || squared <= resolution * resolution {
                break;
            }
        }
        let mut first = T::one();
        for i in 0..N {
            if i < edges.count {
                first -= x[i];
                *weights.get_mut(i + 1)? = x[i];
            }
        }
        *weights.first_mut()? = first;
        Some(weights)
    }
}
