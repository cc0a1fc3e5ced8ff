//! Memory: one layout, placed in the caller's memory or owned by a const-generic struct.

use crate::polytope::simplex::Vertex;
use crate::polytope::{Entry, Facet, Polytope};
use crate::scalar::Real;
use crate::solver::Solver;
use core::fmt;
use core::mem::{MaybeUninit, align_of, size_of};

/// The largest number of vertices or facets.
pub const MAX_CAPACITY: usize = u16::MAX as usize;

/// Why memory cannot hold a solver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WorkspaceError {
    /// `max_vertices` < N + 1, `max_facets` < 2 N, or one of them above [`MAX_CAPACITY`].
    Capacity,
    /// The memory is shorter than [`Layout::bytes`].
    Size,
    /// The memory is not aligned to [`Layout::ALIGN`].
    Alignment,
}

impl fmt::Display for WorkspaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Capacity => "the capacity is below N + 1 vertices or 2 N facets, or above 65,535",
            Self::Size => "the memory is too short for the solver",
            Self::Alignment => "the memory is not aligned to 8 bytes",
        })
    }
}

impl core::error::Error for WorkspaceError {}

/// Where vertices, facets and queue lie in one block of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    vertices: usize,
    facets: usize,
    facets_at: usize,
    queue_at: usize,
    bytes: usize,
}

impl Layout {
    /// Alignment of the block, in bytes.
    pub const ALIGN: usize = 8;

    /// The layout for these capacities: 2 N scalars a vertex, N + 2 scalars and 4 N + 3 bytes a facet (rounded up to the scalar),
    /// two scalars a queue entry, one entry a facet.
    ///
    /// # Errors
    /// [`WorkspaceError::Capacity`].
    pub const fn new<T: Real, const N: usize>(max_vertices: usize, max_facets: usize) -> Result<Self, WorkspaceError> {
        const { assert!(N >= 2 && N <= 6, "qdist solves in 2 to 6 dimensions") };
        if max_vertices < N + 1 || max_facets < 2 * N || max_vertices > MAX_CAPACITY || max_facets > MAX_CAPACITY {
            return Err(WorkspaceError::Capacity);
        }
        // All three types have the alignment of T and sizes that are multiples of it.
        let facets_at = max_vertices * size_of::<Vertex<T, N>>();
        let queue_at = facets_at + max_facets * size_of::<Facet<T, N>>();
        let bytes = queue_at + max_facets * size_of::<Entry<T>>();
        Ok(Layout { vertices: max_vertices, facets: max_facets, facets_at, queue_at, bytes })
    }

    /// Size of the block in bytes.
    pub const fn bytes(&self) -> usize {
        self.bytes
    }
}

/// Places a solver in caller memory, which it borrows.
///
/// # Errors
/// [`WorkspaceError`]; the memory is not touched then.
pub fn place<T: Real, const N: usize>(
    memory: &mut [MaybeUninit<u8>],
    max_vertices: usize,
    max_facets: usize,
) -> Result<Solver<'_, T, N>, WorkspaceError> {
    let layout = Layout::new::<T, N>(max_vertices, max_facets)?;
    if memory.len() < layout.bytes {
        return Err(WorkspaceError::Size);
    }
    if !memory.as_ptr().cast::<u8>().addr().is_multiple_of(Layout::ALIGN) {
        return Err(WorkspaceError::Alignment);
    }
    // SAFETY: the block is long enough and aligned, it is borrowed mutably for the solver's life, and `initialize`
    // writes every element before `open` reads it.
    unsafe {
        let base = memory.as_mut_ptr().cast::<u8>();
        initialize(base, &layout);
        Ok(open(base, &layout))
    }
}

/// Writes every byte of the block once. Vertices, facets and queue are numbers only, and what is in them is written before it is read: zeros will do, in every
/// dimension.
///
/// # Safety
/// `base` is valid for writes of `layout.bytes` bytes.
#[doc(hidden)]
pub unsafe fn initialize(base: *mut u8, layout: &Layout) {
    // SAFETY: the caller's promise.
    unsafe { base.write_bytes(0, layout.bytes()) }
}

/// A solver over a block that [`initialize`] has written.
///
/// # Safety
/// The block was initialised for the same layout, and is not used otherwise for the life `'w`.
#[doc(hidden)]
pub unsafe fn open<'w, T: Real, const N: usize>(base: *mut u8, layout: &Layout) -> Solver<'w, T, N> {
    use core::slice::from_raw_parts_mut;
    const { assert!(align_of::<Facet<T, N>>() <= Layout::ALIGN && align_of::<Vertex<T, N>>() <= Layout::ALIGN) };
    // SAFETY: three disjoint parts of an initialised block.
    unsafe {
        let vertices = from_raw_parts_mut(base.cast(), layout.vertices);
        let facets = from_raw_parts_mut(base.add(layout.facets_at).cast(), layout.facets);
        let queue = from_raw_parts_mut(base.add(layout.queue_at).cast(), layout.facets);
        Solver { polytope: Polytope::new(vertices, facets, queue) }
    }
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// A solver with the same memory, of at most so many vertices.
    pub(crate) fn bounded(&mut self, vertices: usize) -> Solver<'_, T, N> {
        let (all, facets, queue) = self.polytope.memory();
        let count = all.len().min(vertices);
        Solver { polytope: Polytope::new(all.get_mut(..count).unwrap_or(&mut []), facets, queue) }
    }

    /// A solver of a lower dimension in the same memory, with the same capacities; `None` when K is not lower.
    pub(crate) fn in_dimension<const K: usize>(&mut self) -> Option<Solver<'_, T, K>> {
        use core::slice::from_raw_parts_mut;
        if K >= N {
            return None;
        }
        const {
            assert!(K >= N || size_of::<Facet<T, K>>() <= size_of::<Facet<T, N>>());
            assert!(K >= N || size_of::<Vertex<T, K>>() <= size_of::<Vertex<T, N>>());
        };
        let (vertices, facets, queue) = self.polytope.memory();
        // SAFETY: the same number of smaller elements, of the same alignment (that of T), made of numbers only: any initialised memory is
        // one, then and when it is read in the higher dimension again.
        unsafe {
            let vertices = from_raw_parts_mut(vertices.as_mut_ptr().cast(), vertices.len());
            let facets = from_raw_parts_mut(facets.as_mut_ptr().cast(), facets.len());
            Some(Solver { polytope: Polytope::new(vertices, facets, queue) })
        }
    }
}

/// A solver's memory as a value: `V` vertices and `F` facets, for a `static` or the stack.
///
/// ```
/// use qdist::{Options, Vector, Workspace, qset::Ball, support::BoxShape};
/// let mut memory = Workspace::<f64, 3, 64, 128>::new();
/// let cuboid = BoxShape::new(Vector::from([1.0, 2.0, 3.0])).unwrap();
/// let answer = memory.solver().solve(&cuboid, &Ball::unit(), &Options::default());
/// assert!(answer.lower <= 1.0 && 1.0 <= answer.upper);
/// ```
///
/// In a `static`, behind what the program has for a lock:
///
/// ```
/// use std::sync::Mutex;
/// use qdist::{Body, Options, Vector, Workspace, support::Sphere};
/// static MEMORY: Mutex<Workspace<f32, 3, 64, 128>> = Mutex::new(Workspace::new());
///
/// let ball = Sphere::new(1.0)?;
/// let (a, b) = (Body::at(&ball, Vector::zeros()), Body::at(&ball, Vector::from([1.5, 0.0, 0.0])));
/// let depth = MEMORY.lock().unwrap().solver().depth(&a, &b, &Options::default());
/// assert!(depth.lower <= 0.5 && 0.5 <= depth.upper);
/// # Ok::<(), qdist::support::ShapeError>(())
/// ```
///
/// Other dimensions than 2 to 6, and capacities below the least, do not compile:
///
/// ```compile_fail,E0080
/// let memory = qdist::Workspace::<f64, 7, 64, 128>::new();
/// ```
///
/// ```compile_fail,E0080
/// let memory = qdist::Workspace::<f64, 3, 3, 128>::new(); // a tetrahedron has four vertices
/// ```
pub struct Workspace<T, const N: usize, const V: usize, const F: usize> {
    vertices: [Vertex<T, N>; V],
    facets: [Facet<T, N>; F],
    queue: [Entry<T>; F],
}

impl<T: Real, const N: usize, const V: usize, const F: usize> Workspace<T, N, V, F> {
    /// Fresh memory. What it is for is checked when this is compiled: N of 2 to 6, `V` >= N + 1 and `F` >= 2 N.
    pub const fn new() -> Self {
        const { assert!(Layout::new::<T, N>(V, F).is_ok(), "V >= N + 1, F >= 2 N, both below 65536") };
        Workspace { vertices: [Vertex::empty(); V], facets: [Facet::empty(); F], queue: [Entry::EMPTY; F] }
    }

    /// A solver that borrows this memory.
    pub fn solver(&mut self) -> Solver<'_, T, N> {
        Solver { polytope: Polytope::new(&mut self.vertices, &mut self.facets, &mut self.queue) }
    }
}

impl<T, const N: usize, const V: usize, const F: usize> fmt::Debug for Workspace<T, N, V, F> {
    /// The capacities; what the memory contains says nothing.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workspace").field("vertices", &V).field("facets", &F).finish_non_exhaustive()
    }
}

impl<T: Real, const N: usize, const V: usize, const F: usize> Default for Workspace<T, N, V, F> {
    fn default() -> Self {
        Self::new()
    }
}
