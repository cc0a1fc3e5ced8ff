//! The convex hull in space: Quickhull (Barber, Dobkin & Huhdanpaa 1996) with exact decisions, in borrowed memory.
//!
//! A facet is a triangle with its neighbours and a list of points above it; a point is in one list, or in none when it is inside.
//! A facet with points takes the farthest of them as a new vertex: the facets that the vertex sees, found by walking over neighbours,
//! are replaced by the cone of the vertex over their boundary, and the points of their lists are shared out among the new
//! facets, or are inside. (A point above some facet that stays, and above one that goes, is above a new one: the
//! facets that it sees hang together, so two of them, one of each kind, meet at an edge of the boundary, and the new facet over
//! that edge lies in the span of both.)
//!
//! Every decision is one exact determinant (module [`grid`](super::grid)), and a point *in* the plane of a facet does not see it.
//! So the facets that a vertex sees are a disc whose boundary passes each corner once, no new facet is flat, the surface is
//! convex after every step, no step is undone, and n points in general need about n log n decisions.
//!
//! # Memory
//!
//! V vertices have 2 V - 4 facets, and never more are alive: new ones take the places of those that they replace. The lists
//! are chained through one word for each point. A vertex is in no list, so its word is free: while a cone is joined, it holds
//! the facet whose boundary edge begins there.

use super::grid::{Grid, Height, LEVEL, Plane};
use super::{Clock, GraphError, HullFacet};
use crate::scalar::Real;
use crate::support::Word;

/// No facet, no point, the end of a list.
const NONE: u32 = u32::MAX;
/// `HullFacet::link` of a facet of the surface; others are on lists.
const LIVE: u32 = u32::MAX - 1;
/// `HullFacet::pending` of a facet that does not wait.
const IDLE: u32 = u32::MAX - 1;

impl HullFacet {
    /// Fills untouched memory.
    pub const EMPTY: Self =
        HullFacet { vertices: [NONE; 3], neighbors: [NONE; 3], above: NONE, link: NONE, pending: IDLE };

    fn is_live(&self) -> bool {
        self.link == LIVE
    }
}

/// The facets as triangles, counterclockwise seen from outside.
pub(super) fn triangles(facets: &[HullFacet]) -> impl Iterator<Item = [u32; 3]> {
    facets.iter().filter(|f| f.is_live()).map(|f| f.vertices)
}

/// The hull of the points spanned by four of them and all others. The facets used are the first so many.
pub(super) fn quickhull<'f, T: Real, W: Word>(
    grid: Grid<'_, T>,
    corners: [u32; 4],
    links: &mut [W],
    facets: &'f mut [HullFacet],
    clock: &mut Clock<'_>,
) -> Result<&'f [HullFacet], GraphError> {
    let mut hull = Quickhull { grid, links, facets, top: 0, free: NONE, live: 0, pending: NONE, clock };
    hull.simplex(corners)?;
    while let Some(facet) = hull.next_pending()? {
        hull.raise(facet)?;
    }
    let Quickhull { facets, top, .. } = hull;
    facets.get(..top).ok_or(GraphError::Capacity)
}

struct Quickhull<'a, 'f, 'c, T, W> {
    grid: Grid<'a, T>,
    /// Of a point in a list the next point; of a vertex a facet, for a while.
    links: &'a mut [W],
    facets: &'f mut [HullFacet],
    /// Facets at this position and above were never used.
    top: usize,
    /// Head of the list of facets that were used and are not.
    free: u32,
    live: usize,
    /// Head of the list of facets that may have points above them. A facet that dies stays in it, and the next one in its place.
    pending: u32,
    clock: &'a mut Clock<'c>,
}

/// Facets that a point sees: a list through `HullFacet::link`.
struct Visible {
    head: u32,
    count: usize,
    /// Edges of the boundary.
    horizon: usize,
}

impl<T: Real, W: Word> Quickhull<'_, '_, '_, T, W> {
    /// (A position outside of memory is never met: it would be a facet that does not fit.)
    fn facet(&self, facet: u32) -> Result<&HullFacet, GraphError> {
        self.facets.get(facet as usize).ok_or(GraphError::Capacity)
    }

    fn facet_mut(&mut self, facet: u32) -> Result<&mut HullFacet, GraphError> {
        self.facets.get_mut(facet as usize).ok_or(GraphError::Capacity)
    }

    fn next_of(&self, point: u32) -> Result<u32, GraphError> {
        let word = self.links.get(point as usize).ok_or(GraphError::Words)?;
        Ok(if *word == W::EMPTY { NONE } else { word.position() as u32 })
    }

    fn set_next(&mut self, point: u32, next: u32) -> Result<(), GraphError> {
        let word = W::from_position(next as usize).unwrap_or(W::EMPTY);
        *self.links.get_mut(point as usize).ok_or(GraphError::Words)? = word;
        Ok(())
    }

    fn plane(&self, vertices: [u32; 3]) -> Result<Plane, GraphError> {
        let mut nodes = [[0; 3]; 3];
        for i in 0..3 {
            nodes[i] = self.grid.node(vertices[i] as usize).ok_or(GraphError::Points)?;
        }
        Ok(Plane::through(nodes))
    }

    fn height(&mut self, plane: &Plane, point: u32) -> Result<Height, GraphError> {
        self.clock.tick()?;
        Ok(plane.height(&self.grid.node(point as usize).ok_or(GraphError::Points)?))
    }

    fn take_slot(&mut self) -> Result<u32, GraphError> {
        let slot = self.free;
        if slot != NONE {
            self.free = self.facet(slot)?.link;
            return Ok(slot);
        }
        let slot = self.top as u32;
        if self.top >= self.facets.len() || W::from_position(self.top).is_none() {
            return Err(self.full());
        }
        *self.facet_mut(slot)? = HullFacet::EMPTY;
        self.top += 1;
        Ok(slot)
    }

    /// A facet's number must fit into a word: where memory has as many facets as that, more would not help.
    fn full(&self) -> GraphError {
        if W::from_position(self.facets.len()).is_some() { GraphError::Capacity } else { GraphError::Points }
    }

    /// The first four facets, with all points shared out among them.
    fn simplex(&mut self, corners: [u32; 4]) -> Result<(), GraphError> {
        let [a, b, c, d] = corners;
        let plane = self.plane([a, b, c])?;
        let [a, b] = match self.height(&plane, d)?.cmp(&LEVEL) {
            core::cmp::Ordering::Less => [a, b],
            core::cmp::Ordering::Greater => [b, a],
            core::cmp::Ordering::Equal => return Err(GraphError::Flat),
        };
        // Facet i is opposite corner i and stored at i, so that the neighbour opposite a corner is the corner's facet.
        let corners = [a, b, c, d];
        let mut fresh = NONE;
        for turn in [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]] {
            let slot = self.take_slot()?;
            let vertices = turn.map(|i: u32| corners[i as usize & 3]);
            *self.facet_mut(slot)? = HullFacet { vertices, neighbors: turn, link: fresh, ..HullFacet::EMPTY };
            fresh = slot;
        }
        self.live = 4;
        let count = self.links.len() as u32;
        for point in 0..count {
            self.set_next(point, if point + 1 < count { point + 1 } else { NONE })?;
        }
        self.share_out(fresh, 0)
    }

    /// A facet with points above it.
    fn next_pending(&mut self) -> Result<Option<u32>, GraphError> {
        while self.pending != NONE {
            let facet = self.pending;
            self.pending = core::mem::replace(&mut self.facet_mut(facet)?.pending, IDLE);
            let f = self.facet(facet)?;
            if f.is_live() && f.above != NONE {
                return Ok(Some(facet));
            }
        }
        Ok(None)
    }

    /// Makes the farthest point above a facet a vertex.
    fn raise(&mut self, facet: u32) -> Result<(), GraphError> {
        let apex = self.facet(facet)?.above;
        let visible = self.mark_visible(facet, apex)?;
        self.live = self.live + visible.horizon - visible.count;
        if self.live > self.facets.len() {
            return Err(self.full());
        }
        let orphans = self.gather(visible.head)?;
        let edged = self.free_inner(visible.head)?;
        let fresh = self.make_cone(edged, apex)?;
        self.join_cone(fresh)?;
        self.share_out(fresh, orphans)
    }

    /// The facets that a point sees, breadth first from one of them.
    fn mark_visible(&mut self, from: u32, point: u32) -> Result<Visible, GraphError> {
        let mut visible = Visible { head: from, count: 1, horizon: 0 };
        self.facet_mut(from)?.link = NONE;
        let (mut at, mut tail) = (from, from);
        while at != NONE {
            for next in self.facet(at)?.neighbors {
                let neighbor = self.facet(next)?;
                if !neighbor.is_live() {
                    continue;
                }
                let plane = self.plane(neighbor.vertices)?;
                if self.height(&plane, point)? > LEVEL {
                    self.facet_mut(next)?.link = NONE;
                    self.facet_mut(tail)?.link = next;
                    tail = next;
                    visible.count += 1;
                } else {
                    visible.horizon += 1;
                }
            }
            at = self.facet(at)?.link;
        }
        Ok(visible)
    }

    /// The points above a list of facets, as one list.
    fn gather(&mut self, head: u32) -> Result<u32, GraphError> {
        let (mut at, mut orphans) = (head, NONE);
        while at != NONE {
            let facet = self.facet_mut(at)?;
            let mut point = core::mem::replace(&mut facet.above, NONE);
            at = facet.link;
            while point != NONE {
                self.clock.tick()?;
                let next = self.next_of(point)?;
                self.set_next(point, orphans)?;
                orphans = point;
                point = next;
            }
        }
        Ok(orphans)
    }

    /// Frees those of a list of visible facets that have no edge on the boundary; the others are returned.
    fn free_inner(&mut self, head: u32) -> Result<u32, GraphError> {
        let (mut at, mut edged) = (head, NONE);
        while at != NONE {
            let HullFacet { neighbors, link, .. } = *self.facet(at)?;
            let mut inner = true;
            for next in neighbors {
                inner &= !self.facet(next)?.is_live();
            }
            let list = if inner { &mut self.free } else { &mut edged };
            let rest = core::mem::replace(list, at);
            self.facet_mut(at)?.link = rest;
            at = link;
        }
        Ok(edged)
    }

    /// A facet over each boundary edge of a list of visible facets, in their places; returned as a list. Each knows the facet beyond its
    /// edge, and the word of the vertex at which the edge begins knows the new facet.
    fn make_cone(&mut self, edged: u32, apex: u32) -> Result<u32, GraphError> {
        let (mut at, mut fresh) = (edged, NONE);
        while at != NONE {
            let HullFacet { vertices: [a, b, c], neighbors: [opposite_a, opposite_b, opposite_c], link, .. } =
                *self.facet(at)?;
            let mut place = Some(at);
            for (beyond, from, to) in [(opposite_a, b, c), (opposite_b, c, a), (opposite_c, a, b)] {
                if !self.facet(beyond)?.is_live() {
                    continue;
                }
                let slot = match place.take() {
                    Some(slot) => slot,
                    None => self.take_slot()?,
                };
                for neighbor in &mut self.facet_mut(beyond)?.neighbors {
                    if *neighbor == at {
                        *neighbor = slot;
                    }
                }
                let facet = self.facet_mut(slot)?;
                facet.vertices = [from, to, apex];
                facet.neighbors = [NONE, NONE, beyond];
                facet.link = core::mem::replace(&mut fresh, slot);
                self.set_next(from, slot)?;
            }
            at = link;
        }
        Ok(fresh)
    }

    /// Makes the facets of a cone neighbours of each other.
    fn join_cone(&mut self, fresh: u32) -> Result<(), GraphError> {
        let mut at = fresh;
        while at != NONE {
            let HullFacet { vertices: [_, to, _], link, .. } = *self.facet(at)?;
            let next = self.next_of(to)?;
            self.facet_mut(at)?.neighbors[0] = next;
            self.facet_mut(next)?.neighbors[1] = at;
            at = link;
        }
        Ok(())
    }

    /// Puts new facets into service, each with those of the points that it is the first to be seen by, the farthest at the head.
    fn share_out(&mut self, fresh: u32, orphans: u32) -> Result<(), GraphError> {
        let (mut at, mut orphans) = (fresh, orphans);
        while at != NONE {
            let HullFacet { vertices, link, .. } = *self.facet(at)?;
            let plane = self.plane(vertices)?;
            let (mut head, mut most, mut others) = (NONE, LEVEL, NONE);
            while orphans != NONE {
                let point = orphans;
                orphans = self.next_of(point)?;
                let height = self.height(&plane, point)?;
                if height > most {
                    self.set_next(point, head)?;
                    (head, most) = (point, height);
                } else if height > LEVEL {
                    let second = self.next_of(head)?;
                    self.set_next(point, second)?;
                    self.set_next(head, point)?;
                } else {
                    self.set_next(point, others)?;
                    others = point;
                }
            }
            orphans = others;
            let waiting = self.pending;
            let facet = self.facet_mut(at)?;
            (facet.above, facet.link) = (head, LIVE);
            if head != NONE && facet.pending == IDLE {
                facet.pending = waiting;
                self.pending = at;
            }
            at = link;
        }
        Ok(())
    }
}
