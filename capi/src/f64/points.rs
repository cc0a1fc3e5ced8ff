//! HULLS OF POINTS
//!
//! The convex hull of a list of points, in any dimension, by looking at all of them; and large hulls in space, by
//! climbing from vertex to vertex. The lists must outlive the set or body that is made of them, which is when their
//! coordinates are read and checked: make it anew when they change.

use super::super::generic::{
    Deadline, MAX_DIMENSION, aligned, array, as_points, coordinates, dimension, farthest, gaps, in_range, put, reach,
    shared, tiny,
};
use super::super::handle::{self, qdist_solver};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_HULL_POINTS, QDIST_ERROR_WORKSPACE_SIZE,
    from_graph, qdist_interrupt, qdist_status, status,
};
use super::sets::{answer_precisely, arguments, qdist_body_f64, qdist_set_f64, qdist_support_f64, room};
use core::ffi::c_void;
use qdist::Real;
use qdist::internal::{List, near_unit, one_by_one};
use qdist::support::{HullGraph, Points, Support, Word, graph_len, large_graph_len};
use qdist::{HullFacet, hull_facets, prepare_hull};

/// The convex hull of `count` points, 1 or more. Coordinate k of point i is points[i * dimension + k].
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_points_f64 {
    pub points: *const f64,
    pub count: u32,
    /// 2 to 6.
    pub dimension: u32,
}

/// A convex hull in space of up to QDIST_HULL_POINTS points, and the graph of its edges. Made by qdist_hull_prepare_f64. The
/// graph is plain numbers without addresses: it may be kept in a file or in flash. Any content is safe to use, and the time of a
/// support call is bounded by the number of points.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_hull_f64 {
    /// Of dimension 3.
    pub points: qdist_points_f64,
    pub graph: *const u16,
    /// Length of `graph`.
    pub graph_len: u32,
}

gaps!(qdist_hull_f64, points.dimension..graph, graph_len..);

/// The same of any number of points. Made by qdist_hull_large_prepare_f64.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_hull_large_f64 {
    /// Of dimension 3.
    pub points: qdist_points_f64,
    pub graph: *const u32,
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
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_points_f64(set: *mut qdist_set_f64, shape: *const qdist_points_f64) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller.
        let points = unsafe { shared(shape) }?;
        let n = dimension(points.dimension)?;
        // SAFETY: what the header asks of the caller.
        let list = unsafe { points.coordinates() }?;
        coordinates(list)?;
        let extent = reach(list, n);
        let made = qdist_set_f64 {
            support: Some(qdist_points_support_f64),
            exhaustive: None,
            mirrored: None,
            user: shape.cast_mut().cast(),
            radius: 0.0,
            extent,
            error: f64::count(2 * n + 2) * f64::ROUNDOFF * extent,
            dimension: points.dimension,
            contains_origin: 0,
        };
        // SAFETY: checked.
        unsafe { put(set, made) };
        Ok(())
    };
    status(fill())
}

/// Makes a body of a list of points of dimension 3. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_points_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_points_f64,
) -> qdist_status {
    let supports: [qdist_support_f64; 2] = [Some(qdist_points3_support_f64), Some(qdist_points3_far_support_f64)];
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe { fill(body, shared(shape)?, shape.cast(), supports, [None; 2]) }
    };
    status(fill())
}

/// Computes the graph of a hull: the words go to `graph`, and `hull` is filled with points and graph. The solver is one of
/// dimension 3, as workspace: max_facets >= 2 * count always suffices, whatever max_vertices is. QDIST_HULL_GRAPH_LEN(count) words
/// are needed. Points inside the hull are legal, and so are equal points.
///
/// `count` is at most QDIST_HULL_POINTS. Up to 65534 points (with max_facets = 65535) are tried, too: they can be prepared when few
/// enough of them are vertices of the hull; otherwise the status is QDIST_ERROR_HULL_POINTS, and qdist_hull_large_prepare_f64 is
/// the function to call.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_prepare_f64(
    hull: *mut qdist_hull_f64,
    points: *const f64,
    count: u32,
    graph: *mut u16,
    graph_capacity: u32,
    solver: *mut qdist_solver,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { prepare_until(hull, points, count, graph, graph_capacity, solver, Deadline::NEVER) })
}

/// The same with a deadline: with `interrupt`, which may be NULL, the status may be QDIST_ERROR_INTERRUPTED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_prepare_until_f64(
    hull: *mut qdist_hull_f64,
    points: *const f64,
    count: u32,
    graph: *mut u16,
    graph_capacity: u32,
    solver: *mut qdist_solver,
    interrupt: qdist_interrupt,
    interrupt_user: *mut c_void,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe {
        let deadline = Deadline::new(interrupt, interrupt_user);
        prepare_until(hull, points, count, graph, graph_capacity, solver, deadline)
    })
}

/// Computes the graph of a hull of any number of points, at most QDIST_HULL_LARGE_POINTS. QDIST_HULL_LARGE_GRAPH_LEN(count) words of
/// `graph` and QDIST_HULL_LARGE_WORKSPACE_LEN(count) words of `workspace` are needed; the latter may be used otherwise
/// afterwards. With `interrupt`, which may be NULL, the status may be QDIST_ERROR_INTERRUPTED.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_large_prepare_f64(
    hull: *mut qdist_hull_large_f64,
    points: *const f64,
    count: u32,
    graph: *mut u32,
    graph_capacity: u32,
    workspace: *mut u32,
    workspace_capacity: u32,
    interrupt: qdist_interrupt,
    interrupt_user: *mut c_void,
) -> qdist_status {
    let prepare = || {
        aligned(hull)?;
        aligned(graph)?;
        aligned(workspace)?;
        let list = qdist_points_f64 { points, count, dimension: 3 };
        // SAFETY: what the header asks of the caller.
        let coordinates = unsafe { list.coordinates()? };
        if count as usize > <u32 as Word>::MAX_POINTS {
            return Err(QDIST_ERROR_HULL_POINTS);
        }
        // Checked before the first word is written.
        let facets = hull_facets(count as usize);
        let needed = facets * (size_of::<HullFacet>() / size_of::<u32>());
        if (graph_capacity as usize) < large_graph_len(count as usize) || (workspace_capacity as usize) < needed {
            return Err(QDIST_ERROR_WORKSPACE_SIZE);
        }
        // SAFETY: what the header asks of the caller: as many words, which nothing else refers to. They need no initial value,
        // but a reference does.
        let (words, facets, deadline) = unsafe {
            graph.write_bytes(0, graph_capacity as usize);
            workspace.write_bytes(0, needed);
            let words = core::slice::from_raw_parts_mut(graph, graph_capacity as usize);
            let facets = core::slice::from_raw_parts_mut(workspace.cast::<HullFacet>(), facets);
            (words, facets, Deadline::new(interrupt, interrupt_user))
        };
        deadline
            .during(|interrupt| prepare_hull(as_points(coordinates), words, facets, interrupt).map(|_| ()))
            .map_err(from_graph)?;
        // SAFETY: checked.
        unsafe { put(hull, qdist_hull_large_f64 { points: list, graph, graph_len: graph_capacity }) };
        Ok(())
    };
    status(prepare())
}

/// Makes a body of a prepared hull. Reads all points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_hull_f64(body: *mut qdist_body_f64, shape: *const qdist_hull_f64) -> qdist_status {
    let supports: [qdist_support_f64; 2] = [Some(qdist_hull_support_f64), Some(qdist_hull_far_support_f64)];
    // The points are the first member of the hull, so that a function of points serves for a hull.
    let exhaustive: [qdist_support_f64; 2] = [Some(qdist_points3_support_f64), Some(qdist_points3_far_support_f64)];
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let hull = shared(shape)?;
            hull.open()?;
            fill(body, &hull.points, shape.cast(), supports, exhaustive)
        }
    };
    status(fill())
}

/// Makes a body of a large hull. Reads all points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_hull_large_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_hull_large_f64,
) -> qdist_status {
    let supports: [qdist_support_f64; 2] = [Some(qdist_hull_large_support_f64), Some(qdist_hull_large_far_support_f64)];
    // The points are the first member of the hull, so that a function of points serves for a hull.
    let exhaustive: [qdist_support_f64; 2] = [Some(qdist_points3_support_f64), Some(qdist_points3_far_support_f64)];
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let hull = shared(shape)?;
            hull.open()?;
            fill(body, &hull.points, shape.cast(), supports, exhaustive)
        }
    };
    status(fill())
}

/// Support function of a list of points of any dimension.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    let ask = || {
        // SAFETY: what the header asks of the caller.
        let (list, n, u) = unsafe {
            let shape = shared(user.cast::<qdist_points_f64>().cast_const())?;
            let n = dimension(shape.dimension)?;
            (shape.coordinates()?, n, array(direction, Some(n))?)
        };
        room::<1>(point)?;
        let (_, best) = farthest(list, n, in_range(u, &mut [0.0; MAX_DIMENSION])).ok_or(QDIST_ERROR_ARGUMENT)?;
        // SAFETY: `best` and the caller's room have n numbers.
        unsafe { best.as_ptr().copy_to(point, n) };
        Ok(())
    };
    status(ask())
}

/// Support function of a list of points of dimension 3.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points3_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { scan::<false, 3>(user, direction, point) })
}

/// The same, more accurate where all points are far from the origin compared with their spread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points3_far_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { scan::<true, 3>(user, direction, point) })
}

/// Support function of a prepared hull.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { climb::<false, qdist_hull_f64>(user, direction, point) })
}

/// The same, more accurate where all points are far from the origin compared with their spread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_far_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { climb::<true, qdist_hull_f64>(user, direction, point) })
}

/// Support function of a large hull.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_large_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { climb::<false, qdist_hull_large_f64>(user, direction, point) })
}

/// The same, more accurate where all points are far from the origin compared with their spread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_hull_large_far_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { climb::<true, qdist_hull_large_f64>(user, direction, point) })
}

impl qdist_points_f64 {
    /// # Safety
    /// If not NULL and aligned, `points` is valid for reads of all coordinates.
    #[inline(always)]
    pub(super) unsafe fn coordinates<'a>(&self) -> Check<&'a [f64]> {
        let length = (self.count as usize).checked_mul(self.dimension as usize);
        // SAFETY: the caller's promise.
        unsafe { array(self.points, length) }
    }

    /// The points, of dimension `N`.
    ///
    /// # Safety
    /// As for [`coordinates`](Self::coordinates).
    #[inline(always)]
    unsafe fn points<'a, const N: usize>(&self) -> Check<&'a [[f64; N]]> {
        if self.dimension as usize != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        // SAFETY: the caller's promise.
        Ok(as_points(unsafe { self.coordinates() }?))
    }

    /// The points, to be searched.
    ///
    /// # Safety
    /// As for [`coordinates`](Self::coordinates).
    #[inline(always)]
    unsafe fn list<'a, const N: usize>(&self) -> Check<List<'a, f64, N>> {
        // SAFETY: the caller's promise.
        List::new(unsafe { self.points() }?).ok_or(QDIST_ERROR_ARGUMENT)
    }
}

/// A hull of either size.
trait Hull {
    type Word: Word + 'static;
    fn points(&self) -> &qdist_points_f64;
    /// # Safety
    /// If not NULL and aligned, `graph` is valid for reads of `graph_len` words.
    unsafe fn open<'a>(&self) -> Check<HullGraph<'a, Self::Word>>;
}

impl Hull for qdist_hull_f64 {
    type Word = u16;
    #[inline(always)]
    fn points(&self) -> &qdist_points_f64 {
        &self.points
    }
    #[inline(always)]
    unsafe fn open<'a>(&self) -> Check<HullGraph<'a>> {
        // SAFETY: the caller's promise.
        HullGraph::from_words(unsafe { array(self.graph, Some(self.graph_len as usize)) }?).ok_or(QDIST_ERROR_ARGUMENT)
    }
}

impl Hull for qdist_hull_large_f64 {
    type Word = u32;
    #[inline(always)]
    fn points(&self) -> &qdist_points_f64 {
        &self.points
    }
    #[inline(always)]
    unsafe fn open<'a>(&self) -> Check<HullGraph<'a, u32>> {
        // SAFETY: the caller's promise.
        HullGraph::from_words(unsafe { array(self.graph, Some(self.graph_len as usize)) }?).ok_or(QDIST_ERROR_ARGUMENT)
    }
}

/// [`qdist_hull_prepare_until_f64`].
///
/// # Safety
/// What the header asks of the caller.
unsafe fn prepare_until(
    hull: *mut qdist_hull_f64,
    points: *const f64,
    count: u32,
    graph: *mut u16,
    graph_capacity: u32,
    solver: *mut qdist_solver,
    deadline: Deadline,
) -> Check {
    aligned(hull)?;
    aligned(graph)?;
    let list = qdist_points_f64 { points, count, dimension: 3 };
    // SAFETY: the caller's promise.
    let (coordinates, mut solver) = unsafe { (list.coordinates()?, handle::open::<f64, 3>(solver)?) };
    // Checked before the first word is written.
    if (graph_capacity as usize) < graph_len(count as usize) {
        return Err(QDIST_ERROR_WORKSPACE_SIZE);
    }
    // SAFETY: the caller's promise: as many words, which nothing else refers to. They need no initial value, but a reference
    // does.
    let words = unsafe {
        graph.write_bytes(0, graph_capacity as usize);
        core::slice::from_raw_parts_mut(graph, graph_capacity as usize)
    };
    deadline
        .during(|interrupt| solver.prepare_hull_until(as_points(coordinates), words, interrupt).map(|_| ()))
        .map_err(from_graph)?;
    // SAFETY: checked.
    unsafe { put(hull, qdist_hull_f64 { points: list, graph, graph_len: graph_capacity }) };
    Ok(())
}

/// A set, its center and its spread about that, and its extents and errors along the axes.
/// cbindgen:ignore
type Placed<const N: usize> = (qdist_set_f64, Option<([f64; N], f64)>, [[f64; N]; 2]);

/// A set of points, and where they lie when that is far from the origin; of each pair of functions the first is for points around
/// the origin, the second for points far from it.
///
/// # Safety
/// `user` is what the functions expect; if not NULL and aligned, the points are valid for reads.
pub(super) unsafe fn set_of<const N: usize>(
    points: &qdist_points_f64,
    user: *const c_void,
    supports: [qdist_support_f64; 2],
    exhaustive: [qdist_support_f64; 2],
) -> Check<Placed<N>> {
    // SAFETY: the caller's promise.
    let list = unsafe { points.points::<N>() }?;
    let all = Points::new(list).map_err(super::super::status::from_shape)?;
    let [near, far] = supports;
    let [exhaustive_near, exhaustive_far] = exhaustive;
    let center = all.center();
    let set = qdist_set_f64 {
        support: if center.is_some() { far } else { near },
        exhaustive: if center.is_some() { exhaustive_far } else { exhaustive_near },
        mirrored: None,
        user: user.cast_mut(),
        radius: 0.0,
        extent: all.extent().at_least(tiny()),
        error: all.error().at_least(tiny()),
        dimension: N as u32,
        contains_origin: 0,
    };
    let center = center.map(|(center, spread)| (center.into(), spread.at_least(tiny())));
    Ok((set, center, [all.extents().into(), all.errors().into()]))
}

/// The support function of points in two words. (The points are the first member of a hull.)
pub(super) unsafe extern "C" fn precise<const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        answer_precisely(user, direction, point, |points: &qdist_points_f64, u| {
            points.list::<N>().ok()?.support_in_two_words(u)
        })
    }
}

/// Fills a body with points.
///
/// # Safety
/// As for [`set_of`]; if not NULL and aligned, `body` is valid for writes.
unsafe fn fill(
    body: *mut qdist_body_f64,
    points: &qdist_points_f64,
    user: *const c_void,
    supports: [qdist_support_f64; 2],
    exhaustive: [qdist_support_f64; 2],
) -> Check {
    aligned(body)?;
    // SAFETY: the caller's promise.
    let (set, center, [extents, errors]) = unsafe { set_of::<3>(points, user, supports, exhaustive) }?;
    let mut made = qdist_body_f64 { extents, errors, precise: Some(precise::<3>), ..qdist_body_f64::at_origin(set) };
    if let Some((center, spread)) = center {
        (made.center, made.spread) = (center, spread);
    }
    // SAFETY: checked.
    unsafe { put(body, made) };
    Ok(())
}

/// # Safety
/// Those of a support function.
#[inline(always)]
pub(super) unsafe fn scan<const FAR: bool, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check {
    // SAFETY: the caller's promise.
    let (list, u, room) = unsafe {
        let (points, u, room) = arguments::<qdist_points_f64, N>(user, direction, point)?;
        (points.list()?, u, room)
    };
    // SAFETY: `arguments` has checked it.
    unsafe { room.write(*list.scan::<FAR>(&near_unit(one_by_one(u)))) };
    Ok(())
}

/// # Safety
/// Those of a support function.
#[inline(always)]
unsafe fn climb<const FAR: bool, H: Hull>(user: *mut c_void, direction: *const f64, point: *mut f64) -> Check {
    // SAFETY: the caller's promise.
    let (list, graph, u, room) = unsafe {
        let (hull, u, room) = arguments::<H, 3>(user, direction, point)?;
        (hull.points().list()?, hull.open()?, u, room)
    };
    // SAFETY: `arguments` has checked it.
    unsafe { room.write(*list.climb::<FAR, H::Word>(&graph, &near_unit(one_by_one(u)))) };
    Ok(())
}
