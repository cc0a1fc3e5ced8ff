//! The polytope V^ch of Section IV: vertices, facets, who touches whom, and which facet is lowest. The
//! bookkeeping, and nothing else: no support function, no Q, no bound.
//!
//! Facets are simplices of N vertices. Each stores its unit outward normal and its neighbours, so that the facets
//! which a new point eliminates (Proposition 3) are found by walking from one that is known, and the
//! horizon (Proposition 4) is what the walk meets. Dead facets are recycled. Memory is borrowed; resetting
//! costs nothing.
//!
//! # Why the surface stays closed
//!
//! A new point p replaces the visible facets, a connected patch found by adjacency, by the cone of p over the
//! patch's boundary ridges. Neighbours of the new facets are found by turning around each sub-ridge
//! *through the old patch* ([`insert`]), never by comparing coordinates. So whatever rounding does to the
//! visibility test, every ridge keeps exactly two facets and the surface stays a closed cycle around the
//! same points. A wrong decision can cost tightness, never topology, and the lower bound (module `bounds`) needs only
//! the latter, and that no facet turned inside out on the way, which [`Polytope::is_sound`] tells.

use crate::bounds::Axes;
use crate::math::{Vector, norm, zeros};
use crate::polytope::simplex::{Simplex, Vertex};
use crate::scalar::Real;

mod chain;
mod heap;
mod insert;
mod orthant;
mod plane;
pub(crate) mod simplex;

pub use chain::Edge;
pub use heap::{Entry, Heap};
pub use insert::Insertion;

/// Position of a vertex or facet in its array. 16 bits: a million-facet polytope would not fit a controller.
pub type Index = u16;

/// No vertex, no facet.
pub const NONE: Index = Index::MAX;

/// A number, not an enumeration: any memory is a facet, so that memory can change its dimension without being written anew.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
struct State(u8);

#[allow(non_upper_case_globals)]
impl State {
    const Free: State = State(0);
    const Live: State = State(1);
    /// Eliminated by the point that is being inserted.
    const Visible: State = State(2);
    /// Made by the point that is being inserted.
    const Fresh: State = State(3);
}

/// A facet: the simplex of N vertices, its plane and its neighbours.
#[derive(Clone, Copy)]
pub struct Facet<T, const N: usize> {
    /// Unit outward normal n.
    pub normal: Vector<T, N>,
    /// min n.v over the facet's vertices: every point x of the facet has n.x >= offset, whatever the
    /// error of n (module `bounds`).
    pub offset: T,
    /// The facet's distance with respect to Q (eq. 24).
    pub key: T,
    pub vertices: [Index; N],
    /// `neighbors[i]` lies across the ridge opposite `vertices[i]`.
    neighbors: [Index; N],
    /// Next in the list this facet is on: free, visible, or fresh.
    link: Index,
    state: State,
}

impl<T: Real, const N: usize> Facet<T, N> {
    fn is_live(&self) -> bool {
        self.state == State::Live
    }

    /// The slot of a neighbour that is met across the ridge opposite its vertex `left`. There is one such neighbour, since two ridges have all
    /// vertices of a facet. But where rounding has made the surface touch itself, two facets may have all vertices in common and
    /// several ridges; each is opposite one and the same vertex in both.
    #[inline(always)]
    fn slot_towards(&self, neighbor: Index, left: Index) -> Option<usize> {
        let slot = place(&self.neighbors, neighbor)?;
        let once = self.neighbors.iter().filter(|&&n| n == neighbor).count() == 1;
        if once { Some(slot) } else { self.slot(left) }
    }

    /// The slot of a vertex.
    fn slot(&self, vertex: Index) -> Option<usize> {
        place(&self.vertices, vertex)
    }
}

/// Where an index stands in a list, last. Without branches: which slot it is cannot be predicted.
#[inline(always)]
fn place<const N: usize>(list: &[Index; N], index: Index) -> Option<usize> {
    let mut slot = N;
    for i in 0..N {
        slot = if list[i] == index { i } else { slot };
    }
    (slot < N).then_some(slot)
}

/// A convex polytope in borrowed memory.
pub struct Polytope<'a, T, const N: usize> {
    vertices: &'a mut [Vertex<T, N>],
    facets: &'a mut [Facet<T, N>],
    heap: Heap<'a, T>,
    vertex_count: usize,
    /// The first so many vertices are points at infinity (module `orthant`): 0 or N.
    rays: usize,
    /// Facets at this position and above were never used since the last reset.
    facet_top: usize,
    free: Index,
    live: usize,
    peak: usize,
    /// The most vertices stored at one time, before the last start.
    peak_vertices: usize,
    /// Head of the list of facets that the last insertion made.
    fresh: Index,
    /// The centroid of the first simplex.
    center: Vector<T, N>,
    /// Every facet ever made had the centre certainly beneath it: the surface winds around the centre once (module `bounds`).
    sound: bool,
    /// Largest |v|^2 over the vertices.
    reach_squared: T,
    reach: T,
    /// Resolutions by direction, where they are asked for.
    pub axes: Option<Axes<T, N>>,
}

impl<'a, T: Real, const N: usize> Polytope<'a, T, N> {
    pub fn new(vertices: &'a mut [Vertex<T, N>], facets: &'a mut [Facet<T, N>], heap: &'a mut [Entry<T>]) -> Self {
        Polytope {
            vertices,
            facets,
            heap: Heap::new(heap),
            vertex_count: 0,
            rays: 0,
            facet_top: 0,
            free: NONE,
            live: 0,
            peak: 0,
            peak_vertices: 0,
            fresh: NONE,
            center: Vector::zeros(),
            sound: true,
            reach_squared: T::zero(),
            reach: T::zero(),
            axes: None,
        }
    }

    /// The memory: vertices, facets and queue.
    #[allow(clippy::type_complexity)]
    pub fn memory(&mut self) -> (&mut [Vertex<T, N>], &mut [Facet<T, N>], &mut [Entry<T>]) {
        (self.vertices, self.facets, self.heap.memory())
    }

    /// The most vertices and the most facets that there is room for.
    pub fn capacities(&self) -> [usize; 2] {
        [self.vertices.len(), self.facets.len()]
    }

    /// Forgets everything, in constant time.
    pub fn reset(&mut self) {
        self.heap.clear();
        self.vertex_count = 0;
        self.rays = 0;
        self.facet_top = 0;
        self.free = NONE;
        self.live = 0;
        self.peak = 0;
        self.peak_vertices = 0;
        self.fresh = NONE;
        self.sound = true;
        self.reach_squared = T::zero();
        self.reach = T::zero();
        self.axes = None;
    }

    /// Forgets everything but how much memory was used.
    pub fn forget(&mut self) {
        let (peak, peak_vertices) = (self.peak, self.peak_vertices());
        self.reset();
        (self.peak, self.peak_vertices) = (peak, peak_vertices);
    }

    pub fn vertices(&self) -> &[Vertex<T, N>] {
        self.vertices.get(self.rays..self.vertex_count).unwrap_or(&[])
    }

    /// The most facets alive at one time since the last reset.
    pub fn peak_facets(&self) -> usize {
        self.peak
    }

    /// The most vertices stored at one time since the last reset.
    pub fn peak_vertices(&self) -> usize {
        self.peak_vertices.max(self.vertex_count)
    }

    /// Do the capacities allow a search by cones to make progress with every cone?
    pub fn holds_cones(&self) -> bool {
        self.facets.len() >= 4 * N && self.vertices.len() >= 3 * N
    }

    /// Lengths below this cannot be told from zero in a plane equation: the rounding error of n.v for a unit n and |v| <= reach, with room for that of n.
    pub fn resolution(&self) -> T {
        T::count(8 * N) * T::ROUNDOFF * self.reach
    }

    /// The same along n.
    pub fn resolution_along(&self, n: &Vector<T, N>) -> T {
        let whole = self.resolution();
        self.axes.as_ref().map_or(whole, |axes| axes.resolution(n).at_most(whole))
    }

    /// Does the surface certainly wind around every point that all facets are certainly above?
    pub fn is_sound(&self) -> bool {
        self.sound
    }

    pub fn facet(&self, facet: Index) -> Option<&Facet<T, N>> {
        self.facets.get(usize::from(facet))
    }

    fn facet_mut(&mut self, facet: Index) -> Option<&mut Facet<T, N>> {
        self.facets.get_mut(usize::from(facet))
    }

    /// All live facets.
    pub fn facets(&self) -> impl Iterator<Item = &Facet<T, N>> {
        self.facets.iter().take(self.facet_top).filter(|f| f.is_live())
    }

    /// Facets are at positions below this.
    pub fn places(&self) -> Index {
        Index::try_from(self.facet_top).unwrap_or(NONE)
    }

    /// The facet at a position, if one is alive there.
    pub fn live_facet(&self, index: Index) -> Option<&Facet<T, N>> {
        self.facet(index).filter(|facet| facet.is_live())
    }

    /// The facet with the lowest key, and its position.
    pub fn lowest_numbered(&self) -> Option<(Index, Facet<T, N>)> {
        let lowest = self.numbered_facets().reduce(|best, f| if f.1.key < best.1.key { f } else { best });
        lowest.map(|(index, facet)| (index, *facet))
    }

    /// The facet whose plane is nearest to the origin, with its normal and offset.
    pub fn nearest_facet(&self) -> Option<(Index, Vector<T, N>, T)> {
        let (index, f) = self.numbered_facets().reduce(|best, f| if f.1.offset < best.1.offset { f } else { best })?;
        Some((index, f.normal, f.offset))
    }

    /// All live facets with their positions.
    fn numbered_facets(&self) -> impl Iterator<Item = (Index, &Facet<T, N>)> {
        let numbered = self.facets.iter().take(self.facet_top).enumerate().filter(|(_, f)| f.is_live());
        numbered.filter_map(|(number, f)| Some((Index::try_from(number).ok()?, f)))
    }

    /// The facet with the smallest key, queued or not.
    pub fn lowest(&self) -> Option<&Facet<T, N>> {
        self.facets().reduce(|best, f| if f.key < best.key { f } else { best })
    }

    /// The vertices of a facet.
    pub fn corners(&self, facet: &Facet<T, N>) -> Simplex<T, N> {
        let mut simplex = Simplex::vacant();
        self.write_corners(facet, &mut simplex);
        simplex
    }

    /// Writes them in the place of another simplex. (Copies of simplices cost as much as the arithmetic on them.)
    #[inline(always)]
    pub fn write_corners(&self, facet: &Facet<T, N>, simplex: &mut Simplex<T, N>) {
        let finite = facet.vertices.iter().filter(|&&v| usize::from(v) >= self.rays);
        let mut vertices = finite.filter_map(|&v| self.vertices.get(usize::from(v)));
        simplex.restart(vertices.next().unwrap_or(&Vertex::empty()));
        for vertex in vertices {
            simplex.push(*vertex);
        }
    }

    /// Stores a vertex, or nothing when the capacity is used up.
    pub fn add_vertex(&mut self, vertex: Vertex<T, N>) -> Option<Index> {
        let index = Index::try_from(self.vertex_count).ok().filter(|&i| i != NONE)?;
        *self.vertices.get_mut(self.vertex_count)? = vertex;
        self.vertex_count += 1;
        let squared = vertex.point.dot(&vertex.point);
        if squared > self.reach_squared {
            self.reach_squared = squared;
            self.reach = norm(&vertex.point);
        }
        Some(index)
    }

    fn take_slot(&mut self) -> Option<Index> {
        let slot = if self.free != NONE {
            let slot = self.free;
            self.free = self.facet(slot)?.link;
            slot
        } else {
            let slot = Index::try_from(self.facet_top).ok().filter(|&i| i != NONE)?;
            self.facets.get(self.facet_top)?;
            self.facet_top += 1;
            slot
        };
        self.live += 1;
        self.peak = self.peak.max(self.live);
        Some(slot)
    }

    fn free_slots(&self) -> usize {
        self.facets.len() - self.live
    }

    /// Takes the next facet from the list of those that the last operation made.
    pub fn next_fresh(&mut self) -> Option<Index> {
        let facet = self.fresh;
        self.fresh = self.facet(facet)?.link;
        Some(facet)
    }

    /// Gives a facet its key; with `queue`, it becomes a candidate for [`pop_lowest`](Self::pop_lowest). True when it is one.
    pub fn set_key(&mut self, facet: Index, key: T, queue: bool) -> bool {
        if let Some(f) = self.facet_mut(facet) {
            f.key = key;
        }
        queue && self.heap.push(key, facet, self.facets)
    }

    /// Queues all live facets with a key below `ceiling`, and returns the lowest key of the others.
    pub fn requeue(&mut self, ceiling: T) -> Option<T> {
        self.heap.clear();
        let mut lowest: Option<T> = None;
        for number in 0..self.facet_top {
            let (Some(facet), Ok(index)) = (self.facets.get(number), Index::try_from(number)) else { break };
            let key = facet.key;
            if !facet.is_live() {
                continue;
            }
            if key >= ceiling || !self.heap.push(key, index, self.facets) {
                lowest = Some(lowest.map_or(key, |least| least.at_most(key)));
            }
        }
        lowest
    }

    /// The queued live facet with the smallest key (eq. 21). It leaves the queue, not the polytope.
    pub fn pop_lowest(&mut self) -> Option<(T, Index)> {
        self.heap.pop(self.facets)
    }

    /// The simplex of the first N + 1 vertices, given its N + 1 outward unit normals (`normals[i]` belongs to
    /// the facet opposite vertex i).
    pub fn make_simplex(&mut self, normals: &[Vector<T, N>]) -> Option<()> {
        let share = T::one() / T::count(N + 1);
        self.center = self.vertices.iter().take(N + 1).fold(Vector::zeros(), |sum, v| sum + v.point * share);
        for (opposite, normal) in normals.iter().enumerate().take(N + 1) {
            let mut vertices = [NONE; N];
            let others = (0..=N).filter(|&v| v != opposite);
            for (slot, v) in vertices.iter_mut().zip(others) {
                *slot = v as Index;
            }
            let facet = self.take_slot()?;
            // Facet i is stored at slot i, so the neighbour across the ridge opposite vertex v is facet v.
            let fresh = core::mem::replace(&mut self.fresh, facet);
            let (normal, offset) = self.plane(&vertices, *normal)?;
            *self.facet_mut(facet)? = Facet {
                normal,
                offset,
                key: T::zero(),
                vertices,
                neighbors: vertices,
                link: fresh,
                state: State::Live,
            };
        }
        Some(())
    }
}

impl<T: Real, const N: usize> Facet<T, N> {
    /// Fills untouched memory.
    pub const fn empty() -> Self {
        Facet {
            normal: zeros(),
            offset: T::ZERO,
            key: T::ZERO,
            vertices: [NONE; N],
            neighbors: [NONE; N],
            link: NONE,
            state: State::Free,
        }
    }
}
