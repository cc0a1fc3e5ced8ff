//! UNIT SETS
//!
//! What one unit of depth means in each direction: a convex set Q that contains the origin, known by its support function
//! h_Q. The depth of the origin in A is the largest number d with d * Q inside A. Pass NULL for the unit ball, the
//! ordinary Euclidean depth. The structs and lists must outlive the unit set that is made of them.

use super::super::generic::{
    CallbackUnit, MAX_DIMENSION, Parts, aligned, array, coordinates, dimension, dot, farthest, finite, first, gaps,
    in_range, largest, length, mirrored_always, padded, put, reach, semi_axes, shared,
};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_ROTATION, from_shape, qdist_status, status,
};
use super::super::symmetry::qdist_mirrored;
use super::points::qdist_points_f64;
use core::ffi::c_void;
use qdist::Real;
use qdist::qset::{Ball, UnitSet};

/// h_Q(direction) = max { direction . q : q in Q } >= 0, for a finite direction that is not zero. A NaN or a negative number ends
/// the query with QDIST_CALLBACK_NONFINITE.
pub type qdist_unit_value_f64 = Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64) -> f64>;

/// Writes a point q of Q with direction . q = h_Q(direction) to `point`: where the plane touches Q. Returns 0, or anything else where
/// that is not known.
pub type qdist_unit_point_f64 =
    Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32>;

/// Writes point number `index` < vertex_count to `point`. Returns 0, or a code that ends the query, as that of a support function
/// does. Coordinates that are not finite end it too.
pub type qdist_unit_vertex_f64 = Option<unsafe extern "C" fn(user: *mut c_void, index: u32, point: *mut f64) -> i32>;

/// A unit set. Start with `= {0}`: what is zero is not known, and only `value` or `ball_radius` must be. What is stated must be
/// true, or the bracket is not.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_unit_f64 {
    pub value: qdist_unit_value_f64,
    /// Helps to find the minimum: in a search by cones, and in qdist_solve_warm.
    pub point: qdist_unit_point_f64,
    /// With vertex_count: the points of which, and of the origin, Q is the hull. `value` must be theirs. d is then found by shooting
    /// a ray at each (QDIST_PLAN_RAYS), unless expansion is cheaper.
    pub vertex: qdist_unit_vertex_f64,
    /// Which mirror images of Q are Q itself.
    pub mirrored: qdist_mirrored,
    /// First argument of all functions.
    pub user: *mut c_void,
    /// An upper bound of |q| over Q, for the rounding margin; 0: found by asking along the axes.
    pub extent: f64,
    /// Above 0: Q is the ball of this radius around the origin, and no function is used. Balls swept over A are then exact.
    pub ball_radius: f64,
    /// Radius of a ball around the origin that Q contains. Without, qdist_solve_warm knows no lower bound once A has moved.
    pub inner_radius: f64,
    /// How many points `vertex` knows.
    pub vertex_count: u32,
    /// The dimension that the functions work in; 0: not checked.
    pub dimension: u32,
}

gaps!(qdist_unit_f64, user..extent, dimension..);

/// The ellipsoid with these semi axes >= 0, not all zero, along the columns of `rotation`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_ellipsoid_unit_f64 {
    /// The first `dimension` numbers count.
    pub semi_axes: [f64; 6],
    /// Row-major, `dimension` x `dimension`; NULL: identity.
    pub rotation: *const f64,
    /// 2 to 6.
    pub dimension: u32,
}

/// The box |x_i| <= half[i]; sizes >= 0, not all zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_box_unit_f64 {
    /// The first `dimension` numbers count.
    pub half: [f64; 6],
    /// 2 to 6.
    pub dimension: u32,
}

/// The hull of the points +- semi_axes[i] on axis i; sizes >= 0, not all zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_cross_unit_f64 {
    /// The first `dimension` numbers count.
    pub semi_axes: [f64; 6],
    /// 2 to 6.
    pub dimension: u32,
}

/// The segment from the origin to `end`, which is not zero: the depth is how many times `end` fits into A from the origin, as
/// for a ray.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_segment_unit_f64 {
    /// The first `dimension` numbers count.
    pub end: [f64; 6],
    /// 2 to 6.
    pub dimension: u32,
}

gaps!(qdist_segment_unit_f64, dimension..);

/// Makes the ball of this radius > 0 around the origin, of any dimension.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_ball_f64(unit: *mut qdist_unit_f64, radius: f64) -> qdist_status {
    let fill = || {
        semi_axes(&[radius])?;
        let ball = qdist_unit_f64 { extent: radius, ball_radius: radius, inner_radius: radius, ..UNKNOWN };
        // SAFETY: what the header asks of the caller.
        unsafe { write(unit, ball) }
    };
    status(fill())
}

/// Makes an ellipsoid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_ellipsoid_f64(
    unit: *mut qdist_unit_f64,
    shape: *const qdist_ellipsoid_unit_f64,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let ellipsoid = shared(shape)?;
            let (axes, rotation) = ellipsoid.parts()?;
            semi_axes(axes)?;
            let least = least(axes);
            let inner_radius = match rotation {
                // Columns that are orthonormal to 1e-4 shorten by less than 6e-4.
                Some(rotation) => orthonormal(rotation, axes.len()).map(|()| least * 0.999)?,
                None => least,
            };
            let parts = qdist_unit_f64 {
                value: Some(qdist_ellipsoid_unit_value_f64),
                point: Some(ellipsoid_point),
                mirrored: Some(ellipsoid_mirrored),
                extent: length(largest(axes) * 1.001)?,
                inner_radius,
                dimension: ellipsoid.dimension,
                ..UNKNOWN
            };
            made(unit, shape, parts)
        }
    };
    status(fill())
}

/// Makes a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_box_f64(
    unit: *mut qdist_unit_f64,
    shape: *const qdist_box_unit_f64,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let cuboid = shared(shape)?;
            let half = cuboid.half()?;
            semi_axes(half)?;
            let parts = qdist_unit_f64 {
                value: Some(qdist_box_unit_value_f64),
                point: Some(box_point),
                vertex: Some(box_vertex),
                mirrored: Some(mirrored_always),
                extent: length(reach(half, half.len()))?,
                inner_radius: least(half),
                vertex_count: 1 << (positive(half).count() as u32),
                dimension: cuboid.dimension,
                ..UNKNOWN
            };
            made(unit, shape, parts)
        }
    };
    status(fill())
}

/// Makes a cross-polytope.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_cross_f64(
    unit: *mut qdist_unit_f64,
    shape: *const qdist_cross_unit_f64,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let cross = shared(shape)?;
            let axes = cross.semi_axes()?;
            semi_axes(axes)?;
            // The ball touches the facet with the normal 1 / axes.
            let least = least(axes);
            let sum = axes.iter().fold(0.0, |sum, &x| sum + (least / x) * (least / x));
            let slack = f64::count(4 * MAX_DIMENSION) * f64::ROUNDOFF;
            let parts = qdist_unit_f64 {
                value: Some(qdist_cross_unit_value_f64),
                point: Some(cross_point),
                vertex: Some(cross_vertex),
                mirrored: Some(mirrored_always),
                extent: length(largest(axes))?,
                inner_radius: if least > 0.0 { least / sum.root() * (1.0 - slack) } else { 0.0 },
                vertex_count: 2 * positive(axes).count() as u32,
                dimension: cross.dimension,
                ..UNKNOWN
            };
            made(unit, shape, parts)
        }
    };
    status(fill())
}

/// Makes a segment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_segment_f64(
    unit: *mut qdist_unit_f64,
    shape: *const qdist_segment_unit_f64,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let segment = shared(shape)?;
            let end = segment.end()?;
            coordinates(end)?;
            if !(largest(end) > 0.0) {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            let parts = qdist_unit_f64 {
                value: Some(qdist_segment_unit_value_f64),
                point: Some(segment_point),
                vertex: Some(segment_vertex),
                extent: length(reach(end, end.len()))?,
                vertex_count: 1,
                dimension: segment.dimension,
                ..UNKNOWN
            };
            made(unit, shape, parts)
        }
    };
    status(fill())
}

/// Makes the hull of the origin and a list of points, not all zero. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_unit_vertices_f64(
    unit: *mut qdist_unit_f64,
    shape: *const qdist_points_f64,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let points = shared(shape)?;
            let n = dimension(points.dimension)?;
            let list = points.coordinates()?;
            coordinates(list)?;
            if !(largest(list) > 0.0) {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            let parts = qdist_unit_f64 {
                value: Some(qdist_vertices_unit_value_f64),
                point: Some(vertices_point),
                vertex: Some(vertices_vertex),
                extent: length(reach(list, n))?,
                vertex_count: points.count,
                dimension: points.dimension,
                ..UNKNOWN
            };
            made(unit, shape, parts)
        }
    };
    status(fill())
}

/// Support function of an ellipsoid unit set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_ellipsoid_unit_value_f64(user: *mut c_void, direction: *const f64) -> f64 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (axes, rotation, u) = unsafe {
            let (axes, rotation) = shared(user.cast::<qdist_ellipsoid_unit_f64>().cast_const())?.parts()?;
            (axes, rotation, array(direction, Some(axes.len()))?)
        };
        // |D R^T u|, with the axes divided by the largest, so that squares stay in range.
        let size = largest(axes);
        let mut squares = 0.0;
        for (i, (&axis, &x)) in axes.iter().zip(u).enumerate() {
            let along = match rotation {
                None => x,
                Some(matrix) => matrix.iter().skip(i).step_by(axes.len()).zip(u).fold(0.0, |s, (&r, &x)| s + r * x),
            };
            let y = axis / size * along;
            squares += y * y;
        }
        Ok(size * squares.root())
    };
    or_nan(value())
}

/// Support function of a box unit set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_box_unit_value_f64(user: *mut c_void, direction: *const f64) -> f64 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (half, u) = unsafe {
            let shape = shared(user.cast::<qdist_box_unit_f64>().cast_const())?;
            let half = shape.half()?;
            (half, array(direction, Some(half.len()))?)
        };
        Ok(half.iter().zip(u).fold(0.0, |s, (&h, &x)| s + h * x.abs()))
    };
    or_nan(value())
}

/// Support function of a cross-polytope unit set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_cross_unit_value_f64(user: *mut c_void, direction: *const f64) -> f64 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (axes, u) = unsafe {
            let shape = shared(user.cast::<qdist_cross_unit_f64>().cast_const())?;
            let axes = shape.semi_axes()?;
            (axes, array(direction, Some(axes.len()))?)
        };
        Ok(axes.iter().zip(u).fold(0.0, |m: f64, (&s, &x)| m.at_least(s * x.abs())))
    };
    or_nan(value())
}

/// Support function of a segment unit set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_segment_unit_value_f64(user: *mut c_void, direction: *const f64) -> f64 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (end, u) = unsafe {
            let shape = shared(user.cast::<qdist_segment_unit_f64>().cast_const())?;
            let end = shape.end()?;
            (end, array(direction, Some(end.len()))?)
        };
        Ok(dot(end, u).at_least(0.0))
    };
    or_nan(value())
}

/// Support function of a unit set of vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_vertices_unit_value_f64(user: *mut c_void, direction: *const f64) -> f64 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (list, n, u) = unsafe {
            let shape = shared(user.cast::<qdist_points_f64>().cast_const())?;
            let n = dimension(shape.dimension)?;
            (shape.coordinates()?, n, array(direction, Some(n))?)
        };
        let (_, best) = farthest(list, n, in_range(u, &mut [0.0; MAX_DIMENSION])).ok_or(QDIST_ERROR_ARGUMENT)?;
        Ok(dot(best, u).at_least(0.0))
    };
    or_nan(value())
}

impl qdist_ellipsoid_unit_f64 {
    /// Semi axes, and the rotation if there is one.
    ///
    /// # Safety
    /// If not NULL and aligned, `rotation` is valid for reads of its entries.
    unsafe fn parts(&self) -> Check<(&[f64], Option<&[f64]>)> {
        let n = dimension(self.dimension)?;
        let axes = first(&self.semi_axes, n)?;
        // SAFETY: the caller's promise.
        let rotation = if self.rotation.is_null() { None } else { Some(unsafe { array(self.rotation, Some(n * n)) }?) };
        Ok((axes, rotation))
    }
}

impl qdist_box_unit_f64 {
    fn half(&self) -> Check<&[f64]> {
        first(&self.half, dimension(self.dimension)?)
    }
}

impl qdist_cross_unit_f64 {
    fn semi_axes(&self) -> Check<&[f64]> {
        first(&self.semi_axes, dimension(self.dimension)?)
    }
}

impl qdist_segment_unit_f64 {
    fn end(&self) -> Check<&[f64]> {
        first(&self.end, dimension(self.dimension)?)
    }
}

/// Fills `point` with what `fill` makes of the shape behind `user` and the direction.
///
/// # Safety
/// Those of a unit set function: pointers that are neither NULL nor misaligned are valid, for as many numbers as `fill` asks for.
unsafe fn point_of<'a, S: 'a>(
    user: *mut c_void,
    point: *mut f64,
    fill: impl FnOnce(&'a S) -> Check<([f64; MAX_DIMENSION], usize)>,
) -> i32 {
    let answer = || {
        // SAFETY: the caller's promise.
        let (found, n) = fill(unsafe { shared(user.cast::<S>().cast_const()) }?)?;
        aligned(point)?;
        // SAFETY: room for n numbers.
        unsafe { first(&found, n)?.as_ptr().copy_to(point, n) };
        Ok(())
    };
    status(answer())
}

unsafe extern "C" fn ellipsoid_point(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_ellipsoid_unit_f64| {
            let (axes, rotation) = shape.parts()?;
            let n = axes.len();
            let u = array(direction, Some(n))?;
            let size = largest(axes);
            // R D^2 R^T u / |D R^T u|, with the axes divided by the largest.
            let along = |i: usize| match rotation {
                None => u.get(i).copied().unwrap_or(0.0),
                Some(matrix) => matrix.iter().skip(i).step_by(n).zip(u).fold(0.0, |s, (&r, &x)| s + r * x),
            };
            let inner = padded(axes.iter().enumerate().map(|(i, &axis)| axis / size * along(i)));
            let length = dot(&inner, &inner).root();
            if !(length > 0.0) {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            let local = padded(axes.iter().zip(&inner).map(|(&axis, &x)| axis * (x / length)));
            let turned = match rotation {
                None => local,
                Some(matrix) => padded(matrix.chunks_exact(n).map(|row| dot(row, &local))),
            };
            Ok((turned, n))
        })
    }
}

/// Each axis must stay on its line.
unsafe extern "C" fn ellipsoid_mirrored(user: *mut c_void, signs: u32) -> i32 {
    let ask = || {
        // SAFETY: what the header asks of the caller.
        let (axes, rotation) = unsafe { shared(user.cast::<qdist_ellipsoid_unit_f64>().cast_const())?.parts()? };
        let n = axes.len();
        let stays = |matrix: &[f64], j: usize| {
            let touched = |flipped: bool| {
                let column = matrix.iter().skip(j).step_by(n).enumerate();
                column.filter(|&(i, _)| (signs >> i & 1 == 1) == flipped).any(|(_, &x)| x != 0.0)
            };
            !(touched(true) && touched(false))
        };
        Ok(rotation.is_none_or(|matrix| (0..n).all(|j| stays(matrix, j))))
    };
    let answer: Check<bool> = ask();
    i32::from(answer.unwrap_or(false))
}

unsafe extern "C" fn box_point(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_box_unit_f64| {
            let half = shape.half()?;
            let u = array(direction, Some(half.len()))?;
            Ok((padded(half.iter().zip(u).map(|(&h, &x)| if x < 0.0 { -h } else { h })), half.len()))
        })
    }
}

/// In Gray code: one coordinate changes at a time.
unsafe extern "C" fn box_vertex(user: *mut c_void, index: u32, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_box_unit_f64| {
            let half = shape.half()?;
            let mut code = index ^ (index >> 1);
            let corner = half.iter().map(|&h| {
                let negative = h > 0.0 && code & 1 == 1;
                code >>= u32::from(h > 0.0);
                if negative { -h } else { h }
            });
            Ok((padded(corner), half.len()))
        })
    }
}

unsafe extern "C" fn cross_point(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_cross_unit_f64| {
            let axes = shape.semi_axes()?;
            let u = array(direction, Some(axes.len()))?;
            let best = axes.iter().zip(u).fold(0.0, |m: f64, (&s, &x)| m.at_least(s * x.abs()));
            let mut done = false;
            let tip = axes.iter().zip(u).map(|(&s, &x)| {
                let here = !done && s * x.abs() == best;
                done |= here;
                match (here, x < 0.0) {
                    (false, _) => 0.0,
                    (true, true) => -s,
                    (true, false) => s,
                }
            });
            Ok((padded(tip), axes.len()))
        })
    }
}

unsafe extern "C" fn cross_vertex(user: *mut c_void, index: u32, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_cross_unit_f64| {
            let axes = shape.semi_axes()?;
            let (axis, _) = positive(axes).nth(index as usize / 2).ok_or(QDIST_ERROR_ARGUMENT)?;
            let sign = if index % 2 == 1 { -1.0 } else { 1.0 };
            Ok((padded(axes.iter().enumerate().map(|(i, &s)| if i == axis { sign * s } else { 0.0 })), axes.len()))
        })
    }
}

unsafe extern "C" fn segment_point(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_segment_unit_f64| {
            let end = shape.end()?;
            let ahead = dot(end, array(direction, Some(end.len()))?) > 0.0;
            // Behind, the origin touches the plane: no direction to look in.
            if ahead { Ok((padded(end.iter().copied()), end.len())) } else { Err(QDIST_ERROR_ARGUMENT) }
        })
    }
}

unsafe extern "C" fn segment_vertex(user: *mut c_void, _index: u32, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_segment_unit_f64| {
            shape.end().map(|end| (padded(end.iter().copied()), end.len()))
        })
    }
}

unsafe extern "C" fn vertices_point(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_points_f64| {
            let n = dimension(shape.dimension)?;
            let u = array(direction, Some(n))?;
            let list = shape.coordinates()?;
            let (_, best) = farthest(list, n, in_range(u, &mut [0.0; MAX_DIMENSION])).ok_or(QDIST_ERROR_ARGUMENT)?;
            Ok((padded(best.iter().copied()), n))
        })
    }
}

unsafe extern "C" fn vertices_vertex(user: *mut c_void, index: u32, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe {
        point_of(user, point, |shape: &qdist_points_f64| {
            let n = dimension(shape.dimension)?;
            let vertex = shape.coordinates()?.chunks_exact(n).nth(index as usize).ok_or(QDIST_ERROR_ARGUMENT)?;
            Ok((padded(vertex.iter().copied()), n))
        })
    }
}

/// Those that are above 0, with their places.
fn positive(list: &[f64]) -> impl Iterator<Item = (usize, &f64)> {
    list.iter().enumerate().filter(|&(_, &x)| x > 0.0)
}

/// The smallest of some numbers >= 0.
fn least(list: &[f64]) -> f64 {
    list.iter().fold(f64::HUGE, |least, &x| least.at_most(x))
}

/// A unit set that says nothing.
const UNKNOWN: qdist_unit_f64 = qdist_unit_f64 {
    value: None,
    point: None,
    vertex: None,
    mirrored: None,
    user: core::ptr::null_mut(),
    extent: 0.0,
    ball_radius: 0.0,
    inner_radius: 0.0,
    vertex_count: 0,
    dimension: 0,
};

/// A unit set of the caller that has passed the checks.
pub(super) enum CheckedUnit {
    Ball(Ball<f64>),
    Other(CallbackUnit<f64>),
}

impl CheckedUnit {
    /// Checks the numbers for dimension `N`; NULL: the unit ball.
    ///
    /// # Safety
    /// If not NULL and aligned, `q` is valid for reads; for the life of the value its functions may be called in dimension `N`.
    pub(super) unsafe fn new<const N: usize>(q: *const qdist_unit_f64) -> Check<Self> {
        if q.is_null() {
            return Ok(Self::Ball(Ball::unit()));
        }
        // SAFETY: the caller's promise.
        let q = unsafe { shared(q) }?;
        if q.dimension != 0 && q.dimension as usize != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        if length(q.ball_radius)? > 0.0 {
            return Ball::new(q.ball_radius).map(Self::Ball).map_err(from_shape);
        }
        let &qdist_unit_f64 { value, point, vertex, mirrored, user, extent, inner_radius, vertex_count, .. } = q;
        // SAFETY: the caller's promise.
        unsafe {
            CallbackUnit::new::<N>(Parts { value, point, vertex, mirrored, user, extent, inner_radius, vertex_count })
        }
        .map(Self::Other)
    }

    pub(super) fn unit<const N: usize>(&self) -> &dyn UnitSet<f64, N> {
        match self {
            Self::Ball(ball) => ball,
            Self::Other(unit) => unit,
        }
    }

    /// The failure of a query as the caller sees it.
    pub(super) fn code(&self, failure: i32) -> i32 {
        match self {
            Self::Ball(_) => failure,
            Self::Other(unit) => unit.code(failure),
        }
    }
}

/// Are the columns of a row-major matrix orthonormal to 1e-4?
fn orthonormal(matrix: &[f64], n: usize) -> Check {
    finite(matrix)?;
    for i in 0..n {
        for j in 0..=i {
            let column = |k: usize| matrix.iter().skip(k).step_by(n.max(1));
            let product = column(i).zip(column(j)).fold(0.0, |s, (&x, &y)| s + x * y);
            let off: f64 = if i == j { product - 1.0 } else { product };
            if !(off.abs() <= 1e-4) {
                return Err(QDIST_ERROR_ROTATION);
            }
        }
    }
    Ok(())
}

/// # Safety
/// If not NULL and aligned, `unit` is valid for writes.
unsafe fn write(unit: *mut qdist_unit_f64, value: qdist_unit_f64) -> Check {
    aligned(unit)?;
    // SAFETY: checked.
    unsafe { put(unit, value) };
    Ok(())
}

/// Fills a unit set that a struct and its functions make.
///
/// # Safety
/// As for [`write`].
unsafe fn made<S>(unit: *mut qdist_unit_f64, shape: *const S, parts: qdist_unit_f64) -> Check {
    // SAFETY: the caller's promise.
    unsafe { write(unit, qdist_unit_f64 { user: shape.cast_mut().cast(), ..parts }) }
}

/// How a unit set function says that its arguments are wrong.
fn or_nan(value: Check<f64>) -> f64 {
    value.unwrap_or(f64::NAN)
}
