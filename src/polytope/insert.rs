//! Propositions 3 and 4: which facets a new point eliminates, and which it makes.

use super::{Facet, Index, NONE, Polytope, State};
use crate::math::{Vector, norm};
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;

/// What became of an insertion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Insertion {
    /// The polytope has grown.
    Done,
    /// It would not fit; nothing changed.
    Full,
    /// The point cannot be added consistently (every facet sees it); nothing changed.
    Rejected,
}

/// The visible set: a list through `Facet::link`, with what its horizon will need.
struct Visible {
    head: Index,
    count: usize,
    horizon: usize,
}

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// Adds a point that facet `from` sees. A facet is visible when the point is more than `tolerance` above
    /// its plane; ties count as not visible, which drops nothing but rounding. (With resolutions by direction they are the tolerance.)
    ///
    /// `None` means that the bookkeeping contradicts itself (it never happened): the surface proves nothing any more, and
    /// the caller must stop.
    pub fn insert(&mut self, from: Index, vertex: Vertex<T, N>, tolerance: T) -> Option<Insertion> {
        let inserted = self.try_insert(from, vertex, tolerance);
        self.sound &= inserted.is_some();
        inserted
    }

    fn try_insert(&mut self, from: Index, vertex: Vertex<T, N>, mut tolerance: T) -> Option<Insertion> {
        if self.vertex_count >= self.vertices.len() {
            return Some(Insertion::Full);
        }
        // Heights of a point farther out than all others are rounded more coarsely.
        if vertex.point.dot(&vertex.point) > self.reach_squared {
            tolerance = tolerance.at_least(T::count(8 * N) * T::ROUNDOFF * norm(&vertex.point));
        }
        let visible = self.mark_visible(from, &vertex.point, tolerance)?;
        if visible.horizon > self.free_slots() || visible.count == self.live {
            self.unmark(visible.head)?;
            return Some(if visible.count == self.live { Insertion::Rejected } else { Insertion::Full });
        }
        let apex = self.add_vertex(vertex)?;
        self.fresh = NONE;
        self.make_cone(visible.head, apex)?;
        self.link_cone(visible.head, visible.count)?;
        self.recycle(visible.head)?;
        Some(Insertion::Done)
    }

    /// Proposition 3 by walking: breadth first over neighbours, starting at a facet known to be visible.
    fn mark_visible(&mut self, from: Index, point: &Vector<T, N>, tolerance: T) -> Option<Visible> {
        let axes = self.axes;
        let sees = |f: &Facet<T, N>| {
            let height = f.normal.dot(point) - f.offset;
            height > tolerance || axes.as_ref().is_some_and(|axes| height > axes.resolution(&f.normal))
        };
        let first = self.facet_mut(from)?;
        first.state = State::Visible;
        first.link = NONE;
        let mut visible = Visible { head: from, count: 1, horizon: 0 };
        let (mut tail, mut at) = (from, from);
        while at != NONE {
            let neighbors = self.facet(at)?.neighbors;
            for &next in &neighbors {
                let neighbor = self.facet_mut(next)?;
                if neighbor.state == State::Visible {
                    continue;
                }
                if sees(neighbor) {
                    neighbor.state = State::Visible;
                    neighbor.link = NONE;
                    self.facet_mut(tail)?.link = next;
                    tail = next;
                    visible.count += 1;
                } else {
                    visible.horizon += 1;
                }
            }
            at = self.facet(at)?.link;
        }
        Some(visible)
    }

    fn unmark(&mut self, head: Index) -> Option<()> {
        let mut at = head;
        while at != NONE {
            let facet = self.facet_mut(at)?;
            facet.state = State::Live;
            at = facet.link;
        }
        Some(())
    }

    /// Proposition 4: a new facet over every ridge between a visible facet and one that is not. The visible
    /// facet's link across that ridge is turned to the new facet, for [`link_cone`](Self::link_cone) to find.
    fn make_cone(&mut self, head: Index, apex: Index) -> Option<()> {
        let point = self.vertices.get(usize::from(apex))?.point;
        let mut at = head;
        while at != NONE {
            let eliminated = *self.facet(at)?;
            let above = eliminated.normal.dot(&point) - eliminated.offset;
            for i in 0..N {
                let beyond = eliminated.neighbors[i];
                let outside = self.facet(beyond)?;
                if outside.state != State::Live {
                    continue;
                }
                let below = (outside.normal.dot(&point) - outside.offset).at_most(T::zero());
                let normal = Self::join(above, below, &eliminated.normal, &outside.normal);
                let back = outside.slot_towards(at, eliminated.vertices[i])?;

                let mut vertices = eliminated.vertices;
                vertices[i] = apex;
                let mut neighbors = [NONE; N];
                neighbors[i] = beyond;
                let (normal, offset) = self.plane(&vertices, normal)?;
                let facet = self.take_slot()?;
                let link = core::mem::replace(&mut self.fresh, facet);
                let key = T::zero();
                *self.facet_mut(facet)? = Facet { normal, offset, key, vertices, neighbors, link, state: State::Fresh };
                *self.facet_mut(beyond)?.neighbors.get_mut(back)? = facet;
                *self.facet_mut(at)?.neighbors.get_mut(i)? = facet;
            }
            at = self.facet(at)?.link;
        }
        Some(())
    }

    /// Joins the new facets with each other. The neighbour of a new facet across (sub-ridge S, apex) is found
    /// by turning around S through the visible patch, from the facet it replaced to the next horizon ridge.
    fn link_cone(&mut self, head: Index, visible: usize) -> Option<()> {
        let mut at = head;
        while at != NONE {
            let Facet { neighbors: around, vertices: corners, link, .. } = *self.facet(at)?;
            for i in 0..N {
                let made = around[i];
                if self.facet(made)?.state != State::Fresh {
                    continue;
                }
                for j in 0..N {
                    if j == i || *self.facet(made)?.neighbors.get(j)? != NONE {
                        continue;
                    }
                    let (other, slot) = self.turn(at, around[j], [corners[i], corners[j]], visible)?;
                    *self.facet_mut(made)?.neighbors.get_mut(j)? = other;
                    *self.facet_mut(other)?.neighbors.get_mut(slot)? = made;
                }
            }
            at = link;
        }
        Some(())
    }

    /// Turns around a sub-ridge through the visible patch, from facet `at` across the ridge to `next`, until a new facet is met; returns
    /// it and its slot opposite the sub-ridge. `kept` is the vertex of `at` on that ridge which is not on the sub-ridge, `left` the one off the
    /// ridge. At most one step per visible facet.
    fn turn(
        &self,
        mut at: Index,
        mut next: Index,
        [mut kept, mut left]: [Index; 2],
        visible: usize,
    ) -> Option<(Index, usize)> {
        for _ in 0..=visible {
            let neighbor = self.facet(next)?;
            let across = neighbor.slot(kept)?;
            if neighbor.state == State::Fresh {
                return Some((next, across));
            }
            debug_assert!(next != at);
            let entered = neighbor.slot_towards(at, left)?;
            left = kept;
            kept = *neighbor.vertices.get(entered)?;
            at = next;
            next = *neighbor.neighbors.get(across)?;
        }
        None
    }

    /// A facet has got no key: the surface proves nothing any more.
    #[cold]
    pub fn doubt(&mut self) {
        self.sound = false;
    }

    /// Puts the visible facets on the free list and the fresh ones into service.
    fn recycle(&mut self, head: Index) -> Option<()> {
        let mut at = head;
        while at != NONE {
            let free = self.free;
            let facet = self.facet_mut(at)?;
            let next = core::mem::replace(&mut facet.link, free);
            facet.state = State::Free;
            self.free = at;
            self.live -= 1;
            at = next;
        }
        let mut at = self.fresh;
        while at != NONE {
            let facet = self.facet_mut(at)?;
            facet.state = State::Live;
            at = facet.link;
        }
        Some(())
    }
}
