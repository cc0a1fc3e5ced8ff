//! Preparing a large hull for hill climbing: its vertices, and which of them share an edge.
//!
//! The hull is built by Quickhull on exact integers (modules `quickhull`, `grid`). So there is no input that it fails on: it ends with the
//! graph, or says that the points lie in a plane as far as the scalar can tell, or that memory is short.
//! The facets live in the caller's memory ([`HullFacet`]), or in a solver's; the chains of points in the words of the
//! graph, which is written last.

use core::fmt;

use crate::math::{Vector, norm};
use crate::polytope::Facet;
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{GraphWriter, HullGraph, Points, SEEDS, ShapeError, Word};
use grid::{Grid, Plane, distance};
use quickhull::{quickhull, triangles};

mod grid;
mod quickhull;

/// Why a hull cannot be prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum GraphError {
    /// No points, or a coordinate is not finite.
    Shape(ShapeError),
    /// All points lie in one plane, to within 16 roundoffs of the largest distance from the first: use [`Points`].
    Flat,
    /// More points than the words can number: see [`Word::MAX_POINTS`], and use `u32` for more.
    Points,
    /// The facets are fewer than the hull has: [`hull_facets`] always suffice.
    Capacity,
    /// The words are fewer than the graph needs: [`graph_len`](crate::support::graph_len) or
    /// [`large_graph_len`](crate::support::large_graph_len) always suffices.
    Words,
    /// The deadline said so.
    Interrupted,
}

impl fmt::Display for GraphError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shape(error) => return fmt::Display::fmt(error, f),
            Self::Flat => "the points of the hull lie in one plane",
            Self::Points => "the hull has more points than the words of its graph can number",
            Self::Capacity => "the solver or the workspace has too few facets for the hull",
            Self::Words => "the words are fewer than the hull's graph needs",
            Self::Interrupted => "the deadline ended the preparation of the hull",
        })
    }
}

impl core::error::Error for GraphError {}

/// A facet of a hull that is being prepared: 36 bytes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct HullFacet {
    vertices: [u32; 3],
    /// `neighbors[i]` lies across the edge opposite `vertices[i]`.
    neighbors: [u32; 3],
    /// The farthest of the points above the facet, at the head of their list.
    above: u32,
    /// The list that the facet is on while a vertex is added.
    link: u32,
    /// The next of the facets that have points.
    pending: u32,
}

/// A number of facets that suffices for the hull of `count` points: V vertices have 2 V - 4 facets.
#[must_use]
pub const fn hull_facets(count: usize) -> usize {
    2 * count
}

/// Computes the vertex graph of the hull of `points` into `words`, of 16 or of 32 bits.
///
/// `facets` is workspace: [`hull_facets`] always suffice. `interrupt` is asked at least once for every 1,024 points looked at, and ends
/// the work by `true`. Points inside the hull get no edges, and few that lie in its facets and are no corners do. Cost: n log n for points
/// as they come (100,000 on a sphere: half a second); n^2 for some that are made for it.
///
/// ```
/// use qdist::{HullFacet, hull_facets, prepare_hull};
/// use qdist::support::{Hull, large_graph_len};
/// let corners: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(f64::from)).collect();
/// let mut words = vec![0u32; large_graph_len(8)];
/// let graph = prepare_hull(&corners, &mut words, &mut vec![HullFacet::EMPTY; hull_facets(8)], None)?;
/// let cube = Hull::new(&corners, graph).unwrap();
/// # Ok::<(), qdist::GraphError>(())
/// ```
///
/// # Errors
/// [`GraphError`]; the contents of `words` are unspecified then.
pub fn prepare_hull<'g, T: Real, W: Word>(
    points: &[[T; 3]],
    words: &'g mut [W],
    facets: &mut [HullFacet],
    interrupt: Option<&dyn Fn() -> bool>,
) -> Result<HullGraph<'g, W>, GraphError> {
    // Finite, and not so large that differences overflow.
    Points::new(points).map_err(GraphError::Shape)?;
    let count = W::from_position(points.len()).ok_or(GraphError::Points)?;
    let mut clock = Clock { interrupt, ticks: 0 };
    let grid = Grid::new(points).ok_or(GraphError::Flat)?;
    let corners = first_simplex(&grid, points.len(), &mut clock)?;
    let links = words.get_mut(..points.len()).ok_or(GraphError::Words)?;
    let facets = quickhull(grid, corners, links, facets, &mut clock)?;
    let seeds = seeds(points, facets, links, &mut clock)?;
    let seed_count = W::from_position(seeds.len()).ok_or(GraphError::Words)?;
    let mut writer = GraphWriter::new(words, seed_count, count).ok_or(GraphError::Words)?;
    for (word, &seed) in writer.seeds.iter_mut().zip(&seeds) {
        *word = seed;
    }
    write_lists(facets, &mut writer)?;
    HullGraph::from_words(words).ok_or(GraphError::Words)
}

impl<T: Real> Solver<'_, T, 3> {
    /// [`prepare_hull`] with words of 16 bits and this solver's memory as workspace: as many facets as it has.
    ///
    /// # Errors
    /// [`GraphError`]; the contents of `words` are unspecified then.
    pub fn prepare_hull<'g>(
        &mut self,
        points: &[[T; 3]],
        words: &'g mut [u16],
        interrupt: Option<&dyn Fn() -> bool>,
    ) -> Result<HullGraph<'g>, GraphError> {
        prepare_hull(points, words, self.hull_facets(), interrupt)
    }

    /// The memory of the facets as workspace of another kind: as many as the solver has.
    fn hull_facets(&mut self) -> &mut [HullFacet] {
        const {
            assert!(size_of::<HullFacet>() <= size_of::<Facet<T, 3>>());
            assert!(align_of::<HullFacet>() <= align_of::<Facet<T, 3>>());
        };
        self.polytope.reset();
        let (_, facets, _) = self.polytope.memory();
        let (first, count) = (facets.as_mut_ptr().cast::<HullFacet>(), facets.len());
        // SAFETY: as many smaller elements of no greater alignment, written before they are read. Both kinds are made of numbers
        // only, and these have no padding: what they leave behind is a facet again.
        unsafe {
            for i in 0..count {
                first.add(i).write(HullFacet::EMPTY);
            }
            core::slice::from_raw_parts_mut(first, count)
        }
    }
}

/// The deadline, asked now and then.
struct Clock<'a> {
    interrupt: Option<&'a dyn Fn() -> bool>,
    ticks: u32,
}

impl Clock<'_> {
    /// Counts one step.
    #[inline(always)]
    fn tick(&mut self) -> Result<(), GraphError> {
        self.ticks = self.ticks.wrapping_add(1);
        if self.ticks.is_multiple_of(1024) && self.interrupt.is_some_and(|interrupt| interrupt()) {
            return Err(GraphError::Interrupted);
        }
        Ok(())
    }
}

/// Four points that span space, farther than rounding: the first, the farthest from it, the farthest from their line and the
/// farthest from the plane of these.
fn first_simplex<T: Real>(grid: &Grid<'_, T>, count: usize, clock: &mut Clock<'_>) -> Result<[u32; 4], GraphError> {
    let offset = |i: usize| grid.offset(i).ok_or(GraphError::Points);
    let b = farthest(count, clock, |i| Ok(norm(&offset(i)?)))?;
    let along = offset(b)?;
    let thin = T::count(16) * T::ROUNDOFF * norm(&along);
    let c = farthest(count, clock, |i| Ok(norm(&outside(offset(i)?, &[along]))))?;
    let across = outside(offset(c)?, &[along]);
    if !(norm(&across) > thin) {
        return Err(GraphError::Flat);
    }
    // Exact: across a needle, no unit normal is accurate enough to find the point with.
    let node = |i: usize| grid.node(i).ok_or(GraphError::Points);
    let plane = Plane::through([node(0)?, node(b)?, node(c)?]);
    let d = farthest(count, clock, |i| Ok(distance(plane.height(&node(i)?))))?;
    if !(norm(&outside(offset(d)?, &[along, across])) > thin) {
        return Err(GraphError::Flat);
    }
    Ok([0, b as u32, c as u32, d as u32])
}

/// The first of the points for which a measure is largest.
fn farthest<K: PartialOrd>(
    count: usize,
    clock: &mut Clock<'_>,
    measure: impl Fn(usize) -> Result<K, GraphError>,
) -> Result<usize, GraphError> {
    let (mut best, mut most) = (0, measure(0)?);
    for i in 1..count {
        clock.tick()?;
        let here = measure(i)?;
        if here > most {
            (best, most) = (i, here);
        }
    }
    Ok(best)
}

/// What is left of a vector without its parts along orthogonal axes; twice, for what rounding leaves.
fn outside<T: Real>(v: Vector<T, 3>, axes: &[Vector<T, 3>]) -> Vector<T, 3> {
    let mut rest = v;
    for _ in 0..2 {
        for axis in axes {
            rest -= axis * (rest.dot(axis) / axis.dot(axis));
        }
    }
    rest
}

fn relative<T: Real>(points: &[[T; 3]], p: &[T; 3]) -> Vector<T, 3> {
    Vector::from(*p) - points.first().map_or(Vector::zeros(), |p| Vector::from(*p))
}

/// The axes and the diagonals of a cube, both ways.
fn seed_directions<T: Real>() -> impl Iterator<Item = Vector<T, 3>> {
    let one = [-T::one(), T::zero(), T::one()];
    let all =
        one.into_iter().flat_map(move |x| one.into_iter().flat_map(move |y| one.into_iter().map(move |z| [x, y, z])));
    all.filter(|d| matches!(d.iter().filter(|&&x| x == T::zero()).count(), 0 | 2)).map(Vector::from)
}

/// The farthest vertices along the seed directions, each once. Marks vertices in one word for each point.
fn seeds<T: Real, W: Word>(
    points: &[[T; 3]],
    facets: &[HullFacet],
    marks: &mut [W],
    clock: &mut Clock<'_>,
) -> Result<heapless::Vec<W, SEEDS>, GraphError> {
    let vertex = W::from_position(0).ok_or(GraphError::Words)?;
    marks.fill(W::EMPTY);
    for corner in triangles(facets).flatten() {
        *marks.get_mut(corner as usize).ok_or(GraphError::Words)? = vertex;
    }
    let mut seeds = heapless::Vec::<W, SEEDS>::new();
    for direction in seed_directions::<T>() {
        let mut best: Option<(T, usize)> = None;
        for (i, (p, mark)) in points.iter().zip(marks.iter()).enumerate() {
            clock.tick()?;
            let height = relative(points, p).dot(&direction);
            if *mark == vertex && best.is_none_or(|(most, _)| height > most) {
                best = Some((height, i));
            }
        }
        let seed = best.and_then(|(_, i)| W::from_position(i)).ok_or(GraphError::Points)?;
        if !seeds.contains(&seed) {
            let _ = seeds.push(seed);
        }
    }
    Ok(seeds)
}

/// Two passes over the edges: count the neighbours of each vertex, then fill its list.
fn write_lists<W: Word>(facets: &[HullFacet], writer: &mut GraphWriter<'_, W>) -> Result<(), GraphError> {
    // Each edge once from either end: a facet has three, and its neighbours have them the other way round.
    let edges = || triangles(facets).flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)]);
    let one_more = |word: &mut W| {
        *word = W::from_position(word.position() + 1).ok_or(GraphError::Points)?;
        Ok::<(), GraphError>(())
    };
    let zero = W::from_position(0).ok_or(GraphError::Words)?;
    writer.starts.fill(zero);
    writer.lists.fill(zero);
    for (from, _) in edges() {
        one_more(writer.starts.get_mut(from as usize).ok_or(GraphError::Words)?)?;
    }
    let mut block = 0;
    for start in writer.starts.iter_mut() {
        let degree = start.position();
        *start = if degree == 0 { W::EMPTY } else { W::from_position(block).ok_or(GraphError::Points)? };
        block += if degree == 0 { 0 } else { (degree + 1).div_ceil(W::BLOCK) };
    }
    for (from, to) in edges() {
        let start = writer.starts.get(from as usize).ok_or(GraphError::Words)?.position();
        let list = writer.lists.get_mut(W::BLOCK * start..).ok_or(GraphError::Words)?;
        let (count, neighbors) = list.split_first_mut().ok_or(GraphError::Words)?;
        *neighbors.get_mut(count.position()).ok_or(GraphError::Words)? =
            W::from_position(to as usize).ok_or(GraphError::Points)?;
        one_more(count)?;
    }
    Ok(())
}
