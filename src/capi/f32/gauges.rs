// generated from f64/gauges.rs by `make header`; do not edit
//! GAUGE SETS
//!
//! What one unit of depth means in each direction: a convex set Q that contains the origin, known by its support function
//! h_Q. The depth of the origin in A is the largest number d with d * Q inside A. Pass NULL for the unit ball, the
//! ordinary Euclidean depth. The structs and lists must outlive the gauge that is made of them.

use super::super::generic::{
    MAX_DIMENSION, ValueFn, aligned, array, coordinates, dimension, dot, farthest, finite, first, in_range, largest,
    length, reach, semi_axes, shared,
};
use super::super::status::{Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_ROTATION, qdist_status, status};
use super::points::qdist_points_f32;
use crate::scalar::Real;
use core::ffi::c_void;

/// h_Q(direction) = max { direction . q : q in Q } >= 0, for a finite direction that is not zero. A NaN or a negative number ends
/// the query with QDIST_CALLBACK_NONFINITE.
pub type qdist_gauge_value_f32 = Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f32) -> f32>;

/// A gauge set. Start with `= {0}`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_gauge_f32 {
    pub value: qdist_gauge_value_f32,
    /// First argument of `value`.
    pub user: *mut c_void,
    /// An upper bound of |q| over Q, for the rounding margin; 0: not known, and found by asking along the axes.
    pub extent: f32,
    /// Above 0: Q is the ball of this radius around the origin, and `value` is not used. Balls swept over A are then exact.
    pub ball_radius: f32,
    /// The dimension that `value` works in; 0: not known, and not checked.
    pub dimension: u32,
}

/// The ellipsoid with these semi axes >= 0, not all zero, along the columns of `rotation`.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_ellipsoid_gauge_f32 {
    /// The first `dimension` numbers count.
    pub semi_axes: [f32; 6],
    /// Row-major, `dimension` x `dimension`; NULL: identity.
    pub rotation: *const f32,
    /// 2 to 6.
    pub dimension: u32,
}

/// The box |x_i| <= half[i]; sizes >= 0, not all zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_box_gauge_f32 {
    /// The first `dimension` numbers count.
    pub half: [f32; 6],
    /// 2 to 6.
    pub dimension: u32,
}

/// The hull of the points +- semi_axes[i] on axis i; sizes >= 0, not all zero.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_cross_gauge_f32 {
    /// The first `dimension` numbers count.
    pub semi_axes: [f32; 6],
    /// 2 to 6.
    pub dimension: u32,
}

/// The segment from the origin to `end`, which is not zero: the depth is how many times `end` fits into A from the origin, as
/// for a ray.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_segment_gauge_f32 {
    /// The first `dimension` numbers count.
    pub end: [f32; 6],
    /// 2 to 6.
    pub dimension: u32,
}

/// Makes the ball of this radius > 0 around the origin, of any dimension.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_ball_f32(gauge: *mut qdist_gauge_f32, radius: f32) -> qdist_status {
    let fill = || {
        semi_axes(&[radius])?;
        let ball = qdist_gauge_f32 {
            value: None,
            user: core::ptr::null_mut(),
            extent: radius,
            ball_radius: radius,
            dimension: 0,
        };
        // SAFETY: what the header asks of the caller.
        unsafe { write(gauge, ball) }
    };
    status(fill())
}

/// Makes an ellipsoid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_ellipsoid_f32(
    gauge: *mut qdist_gauge_f32,
    shape: *const qdist_ellipsoid_gauge_f32,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let ellipsoid = shared(shape)?;
            let (axes, rotation) = ellipsoid.parts()?;
            semi_axes(axes)?;
            if let Some(rotation) = rotation {
                orthonormal(rotation, axes.len())?;
            }
            made(gauge, qdist_ellipsoid_gauge_value_f32, shape, largest(axes) * 1.001, ellipsoid.dimension)
        }
    };
    status(fill())
}

/// Makes a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_box_f32(
    gauge: *mut qdist_gauge_f32,
    shape: *const qdist_box_gauge_f32,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let cuboid = shared(shape)?;
            let half = first(&cuboid.half, dimension(cuboid.dimension)?)?;
            semi_axes(half)?;
            made(gauge, qdist_box_gauge_value_f32, shape, reach(half, half.len()), cuboid.dimension)
        }
    };
    status(fill())
}

/// Makes a cross-polytope.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_cross_f32(
    gauge: *mut qdist_gauge_f32,
    shape: *const qdist_cross_gauge_f32,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let cross = shared(shape)?;
            let axes = first(&cross.semi_axes, dimension(cross.dimension)?)?;
            semi_axes(axes)?;
            made(gauge, qdist_cross_gauge_value_f32, shape, largest(axes), cross.dimension)
        }
    };
    status(fill())
}

/// Makes a segment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_segment_f32(
    gauge: *mut qdist_gauge_f32,
    shape: *const qdist_segment_gauge_f32,
) -> qdist_status {
    let fill = || {
        // SAFETY: what the header asks of the caller.
        unsafe {
            let segment = shared(shape)?;
            let end = first(&segment.end, dimension(segment.dimension)?)?;
            coordinates(end)?;
            if !(largest(end) > 0.0) {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            made(gauge, qdist_segment_gauge_value_f32, shape, reach(end, end.len()), segment.dimension)
        }
    };
    status(fill())
}

/// Makes the hull of the origin and a list of points, not all zero. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_gauge_vertices_f32(
    gauge: *mut qdist_gauge_f32,
    shape: *const qdist_points_f32,
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
            made(gauge, qdist_vertices_gauge_value_f32, shape, reach(list, n), points.dimension)
        }
    };
    status(fill())
}

/// Support function of an ellipsoid gauge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_ellipsoid_gauge_value_f32(user: *mut c_void, direction: *const f32) -> f32 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (axes, rotation, u) = unsafe {
            let (axes, rotation) = shared(user.cast::<qdist_ellipsoid_gauge_f32>().cast_const())?.parts()?;
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

/// Support function of a box gauge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_box_gauge_value_f32(user: *mut c_void, direction: *const f32) -> f32 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (half, u) = unsafe {
            let shape = shared(user.cast::<qdist_box_gauge_f32>().cast_const())?;
            let half = first(&shape.half, dimension(shape.dimension)?)?;
            (half, array(direction, Some(half.len()))?)
        };
        Ok(half.iter().zip(u).fold(0.0, |s, (&h, &x)| s + h * x.abs()))
    };
    or_nan(value())
}

/// Support function of a cross-polytope gauge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_cross_gauge_value_f32(user: *mut c_void, direction: *const f32) -> f32 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (axes, u) = unsafe {
            let shape = shared(user.cast::<qdist_cross_gauge_f32>().cast_const())?;
            let axes = first(&shape.semi_axes, dimension(shape.dimension)?)?;
            (axes, array(direction, Some(axes.len()))?)
        };
        Ok(axes.iter().zip(u).fold(0.0, |m: f32, (&s, &x)| m.at_least(s * x.abs())))
    };
    or_nan(value())
}

/// Support function of a segment gauge.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_segment_gauge_value_f32(user: *mut c_void, direction: *const f32) -> f32 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (end, u) = unsafe {
            let shape = shared(user.cast::<qdist_segment_gauge_f32>().cast_const())?;
            let end = first(&shape.end, dimension(shape.dimension)?)?;
            (end, array(direction, Some(end.len()))?)
        };
        Ok(dot(end, u).at_least(0.0))
    };
    or_nan(value())
}

/// Support function of a gauge of vertices.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_vertices_gauge_value_f32(user: *mut c_void, direction: *const f32) -> f32 {
    let value = || {
        // SAFETY: what the header asks of the caller.
        let (list, n, u) = unsafe {
            let shape = shared(user.cast::<qdist_points_f32>().cast_const())?;
            let n = dimension(shape.dimension)?;
            (shape.coordinates()?, n, array(direction, Some(n))?)
        };
        let (_, best) = farthest(list, n, in_range(u, &mut [0.0; MAX_DIMENSION])).ok_or(QDIST_ERROR_ARGUMENT)?;
        Ok(dot(best, u).at_least(0.0))
    };
    or_nan(value())
}

impl qdist_ellipsoid_gauge_f32 {
    /// Semi axes, and the rotation if there is one.
    ///
    /// # Safety
    /// If not NULL and aligned, `rotation` is valid for reads of its entries.
    unsafe fn parts(&self) -> Check<(&[f32], Option<&[f32]>)> {
        let n = dimension(self.dimension)?;
        let axes = first(&self.semi_axes, n)?;
        // SAFETY: the caller's promise.
        let rotation = if self.rotation.is_null() { None } else { Some(unsafe { array(self.rotation, Some(n * n)) }?) };
        Ok((axes, rotation))
    }
}

/// Are the columns of a row-major matrix orthonormal to 1e-4?
fn orthonormal(matrix: &[f32], n: usize) -> Check {
    finite(matrix)?;
    for i in 0..n {
        for j in 0..=i {
            let column = |k: usize| matrix.iter().skip(k).step_by(n.max(1));
            let product = column(i).zip(column(j)).fold(0.0, |s, (&x, &y)| s + x * y);
            let off: f32 = if i == j { product - 1.0 } else { product };
            if !(off.abs() <= 1e-4) {
                return Err(QDIST_ERROR_ROTATION);
            }
        }
    }
    Ok(())
}

/// # Safety
/// If not NULL and aligned, `gauge` is valid for writes.
unsafe fn write(gauge: *mut qdist_gauge_f32, value: qdist_gauge_f32) -> Check {
    aligned(gauge)?;
    // SAFETY: checked.
    unsafe { gauge.write(value) };
    Ok(())
}

/// Fills a gauge that a struct and a function make.
///
/// # Safety
/// As for [`write`].
unsafe fn made<S>(
    gauge: *mut qdist_gauge_f32,
    value: ValueFn<f32>,
    shape: *const S,
    extent: f32,
    dimension: u32,
) -> Check {
    let user = shape.cast_mut().cast();
    let made = qdist_gauge_f32 { value: Some(value), user, extent: length(extent)?, ball_radius: 0.0, dimension };
    // SAFETY: the caller's promise.
    unsafe { write(gauge, made) }
}

/// How a gauge function says that its arguments are wrong.
fn or_nan(value: Check<f32>) -> f32 {
    value.unwrap_or(f32::NAN)
}
