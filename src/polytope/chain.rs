//! A chain of vertices in a plane, for searches in meridian planes: its edges live in the slots of facets and wait in the facets'
//! queue, so that pushing out the lowest of n edges costs log n.

use super::{Facet, Index, NONE, Polytope, State};
use crate::math::Vector;
use crate::scalar::Real;

/// An edge of the chain.
#[derive(Clone, Copy)]
pub struct Edge<T> {
    /// Its vertices, the one nearer to the equator first.
    pub ends: [Index; 2],
    /// Does it belong to the part of the chain above the equator?
    pub upper: bool,
    /// Unit outward normal, in space.
    pub normal: Vector<T, 3>,
    /// Both vertices are at least so far out along the normal.
    pub offset: T,
}

impl<T: Real> Polytope<'_, T, 3> {
    /// Adds an edge to the queue; `None` when the memory is full.
    pub fn add_edge(&mut self, edge: &Edge<T>) -> Option<()> {
        let slot = self.take_slot()?;
        let Edge { ends: [from, to], upper, normal, offset } = *edge;
        *self.facet_mut(slot)? = Facet {
            normal,
            offset,
            key: offset,
            vertices: [from, to, Index::from(upper)],
            neighbors: [NONE; 3],
            link: NONE,
            state: State::Live,
        };
        self.heap.push(offset, slot, self.facets).then_some(())
    }

    /// Removes and returns the edge with the lowest offset.
    pub fn take_lowest_edge(&mut self) -> Option<Edge<T>> {
        let (_, slot) = self.pop_lowest()?;
        let free = core::mem::replace(&mut self.free, slot);
        self.live -= 1;
        let facet = self.facet_mut(slot)?;
        facet.state = State::Free;
        facet.link = free;
        let [from, to, upper] = facet.vertices;
        Some(Edge { ends: [from, to], upper: upper != 0, normal: facet.normal, offset: facet.offset })
    }
}
