//! Planes of facets: the incremental normal and its repair.

use super::{Index, Polytope};
use crate::bounds::Axes;
use crate::math::{Vector, norm, unit};
use crate::scalar::Real;

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// The normal of the plane through the ridge that facets F and G share, and a point at height `above` > 0
    /// over F and `below` <= 0 over G: the combination of n_F and n_G that vanishes on the point. O(N), and unlike
    /// solving eq. 22 it stays a supporting direction when the new facet is a sliver.
    pub(super) fn join(above: T, below: T, normal_f: &Vector<T, N>, normal_g: &Vector<T, N>) -> Vector<T, N> {
        normal_g * above - normal_f * below
    }

    /// Normalises a facet's normal, repairs it where it lost accuracy, and returns it with the offset.
    ///
    /// Where F and G are almost opposite (a thin polytope), the combination cancels. That shows as a spread of
    /// n.v over the facet's vertices above the resolution; then the normal is projected once more onto the orthogonal
    /// complement of the facet's edges.
    pub(super) fn plane(&mut self, vertices: &[Index; N], normal: Vector<T, N>) -> Option<(Vector<T, N>, T)> {
        if self.rays > 0 {
            return self.plane_in_orthant(vertices, &normal);
        }
        let normal = unit(&normal);
        let (lowest, highest) = self.heights(vertices, &normal)?;
        let (normal, offset) = if highest - lowest <= self.resolution_along(&normal) {
            (normal, lowest)
        } else {
            let repaired = self.repair(vertices, &normal, N - 1)?;
            let (low, high) = self.heights(vertices, &repaired)?;
            // Not a number compares false: the first normal is kept, unless it is none itself.
            let better = high - low < highest - lowest || !(lowest <= highest);
            if better { (repaired, low) } else { (normal, lowest) }
        };
        if self.is_beneath(&normal, offset) { Some((normal, offset)) } else { self.turn_away(vertices, normal, offset) }
    }

    /// Is the centre certainly beneath the facet with this plane? (Module `bounds`.)
    fn is_beneath(&self, normal: &Vector<T, N>, offset: T) -> bool {
        self.is_beneath_by(normal, offset, 3 * N + 8, 1)
    }

    /// Is it certainly beneath what is at this height, and by a rounding of any height more?
    pub fn is_far_beneath(&self, normal: &Vector<T, N>, height: T) -> bool {
        self.is_beneath_by(normal, height, 16 * N, 2)
    }

    /// Is it beneath by so many roundoffs, or by so many resolutions by direction? (One is 8 N roundoffs; what is needed is less.)
    #[inline(always)]
    fn is_beneath_by(&self, normal: &Vector<T, N>, height: T, roundoffs: usize, resolutions: usize) -> bool {
        let over = height - normal.dot(&self.center);
        let along = |axes: &Axes<T, N>| over > axes.resolution(normal) * T::count(resolutions);
        over > T::count(roundoffs) * T::ROUNDOFF * self.reach || self.axes.as_ref().is_some_and(along)
    }

    /// For a facet whose plane may cut the centre off: a sliver has more normals than one, up to rounding, and one that
    /// points away from the centre may do. The lower bound holds for any.
    #[cold]
    fn turn_away(&mut self, vertices: &[Index; N], normal: Vector<T, N>, offset: T) -> Option<(Vector<T, N>, T)> {
        let away = self.vertices.get(usize::from(*vertices.first()?))?.point - self.center;
        let away = unit(&away);
        for edges in (0..N).rev() {
            if let Some(turned) = self.repair(vertices, &away, edges) {
                let (low, _) = self.heights(vertices, &turned)?;
                if self.is_beneath(&turned, low) {
                    return Some((turned, low));
                }
            }
        }
        self.sound = false;
        Some((normal, offset))
    }

    /// min and max of n.v over the vertices.
    fn heights(&self, vertices: &[Index; N], normal: &Vector<T, N>) -> Option<(T, T)> {
        let mut range: Option<(T, T)> = None;
        for &v in vertices {
            let height = self.vertices.get(usize::from(v))?.point.dot(normal);
            range = Some(match range {
                None => (height, height),
                Some((low, high)) => (low.at_most(height), high.at_least(height)),
            });
        }
        range
    }

    /// A unit vector orthogonal to the facet's `count` largest edges, on the side of `hint`. Gram-Schmidt with pivoting; where
    /// the facet is flat in more than one direction, any of its normals will do.
    #[cold]
    fn repair(&self, vertices: &[Index; N], hint: &Vector<T, N>, count: usize) -> Option<Vector<T, N>> {
        let mut edges = [Vector::<T, N>::zeros(); N];
        let base = self.vertices.get(usize::from(*vertices.first()?))?.point;
        for (edge, &v) in edges.iter_mut().zip(vertices) {
            *edge = self.vertices.get(usize::from(v))?.point - base;
        }
        let mut hint = if hint.iter().all(|x| x.finite()) { *hint } else { Vector::zeros() };
        let mut axes = [Vector::<T, N>::zeros(); N];
        for i in 0..N {
            axes[i][i] = T::one();
        }
        for _ in 0..count {
            let Some(longest) = edges
                .iter()
                .copied()
                .max_by(|a, b| a.dot(a).partial_cmp(&b.dot(b)).unwrap_or(core::cmp::Ordering::Equal))
            else {
                break;
            };
            let length = norm(&longest);
            if !(length > T::zero()) {
                break;
            }
            let q = longest * (T::one() / length);
            // Twice is enough: the second pass removes what the first left by rounding.
            for _ in 0..2 {
                for v in edges.iter_mut().chain(axes.iter_mut()).chain(core::iter::once(&mut hint)) {
                    let along = v.dot(&q);
                    v.axpy(-along, &q, T::one());
                }
            }
        }
        let small = T::of(0.01);
        let normal = if hint.dot(&hint) > small * small {
            hint
        } else {
            let axis = axes
                .iter()
                .copied()
                .max_by(|a, b| a.dot(a).partial_cmp(&b.dot(b)).unwrap_or(core::cmp::Ordering::Equal))?;
            if axis.dot(&(self.center - base)) > T::zero() { -axis } else { axis }
        };
        let length = norm(&normal);
        (length > T::zero()).then(|| normal * (T::one() / length))
    }
}
