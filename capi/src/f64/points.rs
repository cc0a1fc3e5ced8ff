//! HULLS OF POINTS
//!
//! The convex hull of a list of points, in any dimension, by looking at all of them; and large hulls in space, by
//! climbing from vertex to vertex. The lists must outlive the set or body that is made of them, which is when their
//! coordinates are read and checked: make it anew when they change.

use super::*;
use qdist::internal::{List, near_unit};
use qdist::support::{HullGraph, Points, Word, graph_len, large_graph_len};
use qdist::{HullFacet, hull_facets, prepare_hull};

/// The convex hull of `count` points, 1 or more. Coordinate k of point i is points[i * dimension + k].
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_points_f64 {
    pub points: In<f64>,
    pub count: u32,
    /// 2 to 6.
    pub dimension: u32,
}

/// A convex hull in space of up to QDIST_HULL_POINTS points, and the graph of its edges. Made by qdist_hull_prepare_f64. The
/// graph is plain numbers without addresses: it may be kept in a file or in flash. Any content is safe to use, and the time of a
/// support call is bounded by the number of points.
#[repr(C)]
pub struct qdist_hull_f64 {
    /// Of dimension 3.
    pub points: qdist_points_f64,
    pub graph: In<u16>,
    /// Length of `graph`.
    pub graph_len: u32,
}
gaps!(qdist_hull_f64, points.dimension..graph, graph_len..);

/// The same of any number of points. Made by qdist_hull_large_prepare_f64.
#[repr(C)]
pub struct qdist_hull_large_f64 {
    /// Of dimension 3.
    pub points: qdist_points_f64,
    pub graph: In<u32>,
    /// Length of `graph`.
    pub graph_len: u32,
}
gaps!(qdist_hull_large_f64, points.dimension..graph, graph_len..);

// The macros of the header.
const _: () = {
    assert!(graph_len(0) <= 16 && graph_len(1000) <= 11 * 1000 + 16 && graph_len(65535) <= 11 * 65535 + 16);
    assert!(large_graph_len(0) <= 16 && large_graph_len(1 << 27) <= 8 * (1 << 27) + 16);
    assert!(<u16 as Word>::MAX_POINTS == 26214 && <u32 as Word>::MAX_POINTS == 134_217_728);
    assert!(
        hull_facets(1000) * size_of::<HullFacet>() <= 4 * 18 * 1000 && align_of::<HullFacet>() == align_of::<u32>()
    );
    assert!(18 * <u32 as Word>::MAX_POINTS as u64 <= u32::MAX as u64);
};

/// Makes a set of a list of points of any dimension. Reads all of them.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_points_f64(set: Out<qdist_set_f64>, shape: In<qdist_points_f64>) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_set::<N>(set, shape))))
}

/// Makes a body of a list of points of dimension 3. Reads all of them.
///
/// Status: DIMENSION (shape->dimension is not 3), ARGUMENT (shape->count is 0), NONFINITE (a coordinate).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_points_f64(body: Out<qdist_body_f64>, shape: In<qdist_points_f64>) -> qdist_status {
    status(fill_points(body, shape))
}

/// Computes the graph of a hull: the words go to `graph`, and `hull` is filled with points and graph. The solver is one of
/// dimension 3, as workspace: max_facets >= 2 * count always suffices, whatever max_vertices is. QDIST_HULL_GRAPH_LEN(count) words
/// are needed. Points inside the hull are legal, and so are equal points. With `interrupt`, which may be NULL, the status may be
/// QDIST_ERROR_INTERRUPTED.
///
/// `count` is at most QDIST_HULL_POINTS. Up to 65534 points (with max_facets = 65535) are tried, too: they can be prepared when few
/// enough of them are vertices of the hull; otherwise the status is QDIST_ERROR_HULL_POINTS, and qdist_hull_large_prepare_f64 is
/// the function to call.
///
/// Status: those of a solver; ARGUMENT (count is 0), WORKSPACE_SIZE (graph_capacity), NONFINITE (a coordinate), FLAT (the points), CAPACITY
/// (max_facets of the solver), HULL_POINTS (count, or so many points are vertices), INTERRUPTED (interrupt).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_hull_prepare_f64(
    hull: Out<qdist_hull_f64>,
    solver: Out<qdist_solver>,
    points: In<f64>,
    count: u32,
    interrupt: qdist_interrupt,
    interrupt_user: *mut c_void,
    graph: Out<u16>,
    graph_capacity: u32,
) -> qdist_status {
    let list = qdist_points_f64 { points, count, dimension: 3 };
    status_of(|| {
        hull.checked()?;
        graph.checked()?;
        let (coordinates, mut solver) = (list.coordinates()?, handle::open::<f64, 3>(&solver)?);
        // Checked before the first word is written.
        if (graph_capacity as usize) < graph_len(count as usize) {
            return Err(QDIST_ERROR_WORKSPACE_SIZE);
        }
        let words = graph.zeroed(graph_capacity as usize)?;
        Deadline::new(interrupt, interrupt_user)
            .asked(|interrupt| solver.prepare_hull(as_points(coordinates), words, interrupt).map(|_| ()))
            .map_err(from_graph)?;
        hull.put(qdist_hull_f64 { points: list, graph: graph.filled_from(0), graph_len: graph_capacity })
    })
}

/// Computes the graph of a hull of any number of points, at most QDIST_HULL_LARGE_POINTS. QDIST_HULL_LARGE_GRAPH_LEN(count) words of
/// `graph` and QDIST_HULL_LARGE_WORKSPACE_LEN(count) words of `workspace` are needed; the latter may be used otherwise
/// afterwards. With `interrupt`, which may be NULL, the status may be QDIST_ERROR_INTERRUPTED.
///
/// Status: ARGUMENT (count is 0), HULL_POINTS (count), WORKSPACE_SIZE (workspace_capacity or graph_capacity), NONFINITE (a coordinate), FLAT (the
/// points), INTERRUPTED (interrupt).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_hull_large_prepare_f64(
    hull: Out<qdist_hull_large_f64>,
    workspace: Out<u32>,
    workspace_capacity: u32,
    points: In<f64>,
    count: u32,
    interrupt: qdist_interrupt,
    interrupt_user: *mut c_void,
    graph: Out<u32>,
    graph_capacity: u32,
) -> qdist_status {
    let list = qdist_points_f64 { points, count, dimension: 3 };
    status_of(|| {
        hull.checked()?;
        graph.checked()?;
        workspace.checked()?;
        let coordinates = list.coordinates()?;
        if count as usize > <u32 as Word>::MAX_POINTS {
            return Err(QDIST_ERROR_HULL_POINTS);
        }
        // Checked before the first word is written.
        let facets = hull_facets(count as usize);
        let needed = facets * (size_of::<HullFacet>() / size_of::<u32>());
        if (graph_capacity as usize) < large_graph_len(count as usize) || (workspace_capacity as usize) < needed {
            return Err(QDIST_ERROR_WORKSPACE_SIZE);
        }
        let rows = workspace.rows::<HullFacet>();
        let (words, facets) = (graph.zeroed(graph_capacity as usize)?, rows.zeroed(facets)?);
        Deadline::new(interrupt, interrupt_user)
            .asked(|interrupt| prepare_hull(as_points(coordinates), words, facets, interrupt).map(|_| ()))
            .map_err(from_graph)?;
        hull.put(qdist_hull_large_f64 { points: list, graph: graph.filled_from(0), graph_len: graph_capacity })
    })
}

/// Makes a body of a prepared hull. Reads all points.
///
/// Status: ARGUMENT (shape->graph or graph_len is not that of a prepared hull, or count is 0), DIMENSION (shape->points.dimension is not 3),
/// NONFINITE (a coordinate).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_hull_f64(body: Out<qdist_body_f64>, shape: In<qdist_hull_f64>) -> qdist_status {
    status(fill_hull(body, shape))
}

/// Makes a body of a large hull. Reads all points.
///
/// Status: as of qdist_body_hull.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_hull_large_f64(
    body: Out<qdist_body_f64>,
    shape: In<qdist_hull_large_f64>,
) -> qdist_status {
    status(fill_hull(body, shape))
}

impl qdist_points_f64 {
    #[inline(always)]
    pub(super) fn coordinates(&self) -> Check<&[f64]> {
        self.points.array((self.count as usize).checked_mul(self.dimension as usize))
    }

    /// The points, of dimension `N`.
    #[inline(always)]
    pub(super) fn points<const N: usize>(&self) -> Check<&[[f64; N]]> {
        if self.dimension as usize == N { Ok(as_points(self.coordinates()?)) } else { Err(QDIST_ERROR_DIMENSION) }
    }

    /// The points, to be searched.
    #[inline(always)]
    pub(super) fn list<const N: usize>(&self) -> Check<List<'_, f64, N>> {
        List::new(self.points()?).ok_or(QDIST_ERROR_ARGUMENT)
    }
}

fn fill_set<const N: usize>(set: Out<qdist_set_f64>, shape: In<qdist_points_f64>) -> Check {
    set.checked()?;
    let all = Points::new(shape.get()?.points::<N>()?).map_err(from_shape)?;
    let stated = qdist_set_f64::stated_by(&all);
    let extent = stated.extent;
    // The function measures from the origin, wherever the points are.
    let error = f64::count(2 * N + 2) * f64::ROUNDOFF * extent;
    set.put(qdist_set_f64 { support: support_of::<Scan<false>, N>(), user: shape.user(), error, ..stated })
}

/// By looking at all points; `FAR`: more accurate where all are far from the origin compared with their spread.
struct Scan<const FAR: bool>;

impl<const FAR: bool, const N: usize> Answers<N> for Scan<FAR> {
    type Struct = qdist_points_f64;
    #[inline(always)]
    fn farthest(points: &qdist_points_f64, u: &Vector<f64, N>, _exhaustive: bool) -> Check<Vector<f64, N>> {
        Ok(Vector::from(*points.list()?.scan::<FAR>(&near_unit(one_by_one(u)))))
    }
    fn precise(points: &qdist_points_f64, u: &TwoWords<f64, N>) -> Option<TwoWords<f64, N>> {
        points.list::<N>().ok()?.support_in_two_words(u)
    }
}

/// Fills a body with a list of points.
pub(super) fn fill_points<B: Placed<N>, const N: usize>(body: Out<B>, shape: In<qdist_points_f64>) -> Check {
    body.checked()?;
    let [near, far] = [support_of::<Scan<false>, N>(), support_of::<Scan<true>, N>()];
    body.put(of_points(shape.get()?, shape.user(), [(near, None), (far, None)])?)
}

/// A body of points, with the first functions, `support` and `exhaustive`, for points around the origin, the second for points far from it.
fn of_points<B: Placed<N>, const N: usize>(
    points: &qdist_points_f64,
    user: *mut c_void,
    [near, far]: [(qdist_support_f64, qdist_support_f64); 2],
) -> Check<B> {
    let all = Points::new(points.points::<N>()?).map_err(from_shape)?;
    let stated = Stated { precise: precise_of::<Scan<false>, N>(), ..Stated::of(&all) };
    let (support, exhaustive) = if stated.spread > 0.0 { far } else { near };
    let (extent, error) = (all.extent().at_least(tiny()), all.error().at_least(tiny()));
    let set = qdist_set_f64 { support, exhaustive, user, extent, error, dimension: N as u32, ..qdist_set_f64::ZERO };
    Ok(B::new(set, stated))
}

// ------------------------------------------------------------------------------------------------- prepared hulls

/// A hull of either size.
trait Hull: 'static {
    type Word: Word + 'static;
    fn points(&self) -> &qdist_points_f64;
    fn open(&self) -> Check<HullGraph<'_, Self::Word>>;
}

macro_rules! hull {
    ($struct:ty, $word:ty) => {
        impl Hull for $struct {
            type Word = $word;
            #[inline(always)]
            fn points(&self) -> &qdist_points_f64 {
                // The first member, so that a function of points serves for a hull.
                const { assert!(core::mem::offset_of!($struct, points) == 0) };
                &self.points
            }
            #[inline(always)]
            fn open(&self) -> Check<HullGraph<'_, $word>> {
                HullGraph::from_words(self.graph.array(Some(self.graph_len as usize))?).ok_or(QDIST_ERROR_ARGUMENT)
            }
        }
    };
}

hull!(qdist_hull_f64, u16);
hull!(qdist_hull_large_f64, u32);

/// By climbing from vertex to vertex.
struct Climb<H, const FAR: bool>(PhantomData<H>);

impl<H: Hull, const FAR: bool> Answers<3> for Climb<H, FAR> {
    type Struct = H;
    #[inline(always)]
    fn farthest(hull: &H, u: &Vector<f64, 3>, _exhaustive: bool) -> Check<Vector<f64, 3>> {
        let (list, graph) = (hull.points().list()?, hull.open()?);
        Ok(Vector::from(*list.climb::<FAR, H::Word>(&graph, &near_unit(one_by_one(u)))))
    }
}

fn fill_hull<H: Hull>(body: Out<qdist_body_f64>, shape: In<H>) -> Check {
    let hull = shape.get()?;
    hull.open()?;
    body.checked()?;
    let near = (support_of::<Climb<H, false>, 3>(), exhaustive_of::<Scan<false>, 3>());
    let far = (support_of::<Climb<H, true>, 3>(), exhaustive_of::<Scan<true>, 3>());
    body.put(of_points(hull.points(), shape.user(), [near, far])?)
}
