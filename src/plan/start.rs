//! The first simplex of the polytope: N + 1 affinely independent support points (Section IV-D).
//!
//! The paper takes them from a closest-point iteration; none is needed, since expansion tolerates an origin outside. A flat
//! set shows up here.

use crate::math::{Vector, norm, unit};
use crate::polytope::simplex::{Edges, MAX_CORNERS};
use crate::scalar::Real;
use heapless::Vec;

/// Asks for directions and takes points until A's affine hull is known.
///
/// The caller asks for [`direction`](Start::direction), supports A there and in the opposite direction when the
/// first answer is poor, and [`accept`](Start::accept)s the point, or [`flat`](Start::flat)tens a direction without width.
pub struct Start<T, const N: usize> {
    base: Option<Vector<T, N>>,
    edges: Edges<T, N>,
    /// Directions in which A has no width.
    flat: Edges<T, N>,
    first: Vector<T, N>,
}

impl<T: Real, const N: usize> Start<T, N> {
    /// `first` is the direction to look in first (non-zero).
    pub fn new(first: Vector<T, N>) -> Self {
        Start { base: None, edges: Edges::new(), flat: Edges::new(), first }
    }

    /// How many directions are still to be spanned or found flat (N + 1 with the base point).
    pub fn missing(&self) -> usize {
        if self.base.is_none() { N + 1 } else { N - self.edges.count - self.flat.count }
    }

    /// The affine dimension found so far.
    pub fn dimension(&self) -> usize {
        self.edges.count
    }

    /// Distance of the origin from the affine hull found so far.
    pub fn height(&self) -> T {
        self.base.map_or(T::HUGE, |base| norm(&self.edges.complement(&self.edges.complement(&base))))
    }

    /// The least width by which a point stuck out of those before it.
    pub fn least_width(&self) -> T {
        let mut least = T::HUGE;
        for i in 0..N {
            if i < self.edges.count {
                least = least.at_most(norm(&self.edges.q[i]));
            }
        }
        least
    }

    /// An orthonormal basis of the affine hull's directions; the rest is zero.
    pub fn axes(&self) -> [Vector<T, N>; N] {
        let mut axes = [Vector::zeros(); N];
        for i in 0..N {
            if i < self.edges.count {
                axes[i] = unit(&self.edges.q[i]);
            }
        }
        axes
    }

    /// The next direction: from the affine hull of the points so far towards the origin, so that the simplex
    /// grows around it; where the hull contains the origin, the coordinate axis that sticks out most.
    pub fn direction(&self) -> Vector<T, N> {
        let Some(base) = self.base else { return self.first };
        let outside = |v: &Vector<T, N>| self.flat.complement(&self.edges.complement(v));
        let mut towards = outside(&-base);
        let (squared, whole) = (towards.dot(&towards), base.dot(&base));
        if squared > whole * T::of(1e-6) {
            if squared < whole * T::of(0.01) {
                // Much was cancelled: once more, for what rounding left.
                towards = outside(&towards);
            }
            return unit(&towards);
        }
        // (Nothing is longer where the square of an edge has no inverse: what is so short is flat.)
        let mut best = self.first;
        let mut longest = T::zero();
        for i in 0..N {
            let mut axis = Vector::<T, N>::zeros();
            axis[i] = T::one();
            let rest = outside(&outside(&axis));
            let length = norm(&rest);
            if length > longest {
                longest = length;
                best = rest * (T::one() / length);
            }
        }
        best
    }

    /// How far a point sticks out of the points so far along a direction.
    pub fn progress(&self, direction: &Vector<T, N>, point: &Vector<T, N>) -> T {
        self.base.map_or(T::HUGE, |base| (point - base).dot(direction).abs())
    }

    /// Takes the point as the next vertex; false when it adds no dimension.
    pub fn accept(&mut self, point: &Vector<T, N>, resolution: T) -> bool {
        match self.base {
            None => {
                self.base = Some(*point);
                true
            }
            Some(base) => self.edges.push(&(point - base), resolution),
        }
    }

    /// Records that A has no width along a unit direction.
    pub fn flat(&mut self, direction: &Vector<T, N>) {
        if !self.flat.push(direction, T::zero()) {
            self.flat.count = (self.flat.count + 1).min(N);
        }
    }

    /// The N + 1 outward normals of the simplex (not unit): facet i is opposite vertex i. They are minus the gradients of
    /// the barycentric coordinates, the rows of the inverse edge matrix: X = R^-1 Q^-1.
    pub fn normals(&self) -> Vec<Vector<T, N>, MAX_CORNERS> {
        let mut rows = self.edges.q;
        for i in 0..N {
            rows[i] *= self.edges.inverse[i];
        }
        self.edges.back_substitute(&mut rows);
        let mut normals = Vec::new();
        let _ = normals.push(rows.iter().fold(Vector::zeros(), |sum, row| sum + row));
        for row in rows {
            let _ = normals.push(-row);
        }
        normals
    }
}
