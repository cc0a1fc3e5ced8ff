//! Polyhedra that go to infinity along minus every coordinate axis: conv V + { x <= 0 }, for directions >= 0 (module
//! `conewise`).
//!
//! The first N vertices are *rays*, the points at infinity in the directions -e_1 .. -e_N, and one facet at infinity
//! closes the surface. The normal n of a facet that contains ray i has n_i = 0, exactly: a normal is a combination with
//! weights >= 0 of two old ones, which share the rays of the new facet. So all normals are >= 0, nothing cancels, and
//! no plane needs repair.

use super::{Facet, Index, NONE, Polytope, State};
use crate::math::{Vector, unit};
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// Starts anew with the region below one point: N facets, fresh, and the one at infinity.
    pub fn make_orthant(&mut self, apex: Vertex<T, N>) -> Option<()> {
        self.forget();
        for _ in 0..N {
            self.add_vertex(Vertex::empty())?;
        }
        self.rays = N;
        self.add_vertex(apex)?;
        for opposite in 0..=N {
            let mut vertices = [NONE; N];
            let others = (0..=N).filter(|&v| v != opposite);
            for (slot, v) in vertices.iter_mut().zip(others) {
                *slot = v as Index;
            }
            // The facet opposite the apex is at infinity: 0 x <= 1, which no point violates.
            let (mut normal, mut offset) = (Vector::zeros(), T::one());
            for i in 0..N {
                if i == opposite {
                    normal[i] = T::one();
                    offset = apex.point[i];
                }
            }
            let facet = self.take_slot()?;
            let mut link = NONE;
            if opposite < N {
                link = core::mem::replace(&mut self.fresh, facet);
            }
            // Facet i is stored at slot i, so the neighbour across the ridge opposite vertex v is facet v.
            *self.facet_mut(facet)? =
                Facet { normal, offset, key: T::HUGE, vertices, neighbors: vertices, link, state: State::Live };
        }
        Some(())
    }

    /// Unit normal >= 0 and offset of a facet of which some vertices may be rays, but not all.
    pub(super) fn plane_in_orthant(&self, vertices: &[Index; N], normal: &Vector<T, N>) -> Option<(Vector<T, N>, T)> {
        let normal = unit(normal);
        if !normal.iter().all(|&x| x >= T::zero()) {
            return None; // What the lower bound rests on (module `conewise`).
        }
        let mut offset = T::HUGE;
        for &v in vertices {
            if usize::from(v) >= N {
                offset = offset.at_most(self.vertices.get(usize::from(v))?.point.dot(&normal));
            }
        }
        Some((normal, offset))
    }

    /// Scales a facet's equation.
    pub fn scale(&mut self, facet: Index, factor: T) {
        if let Some(f) = self.facet_mut(facet) {
            f.normal *= factor;
            f.offset *= factor;
        }
    }
}
