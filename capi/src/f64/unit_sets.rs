//! UNIT SETS
//!
//! What one unit of depth means in each direction: a convex set Q that contains the origin, known by its support function
//! h_Q. The depth of the origin in A is the largest number d with d * Q inside A. Pass NULL for the unit ball, the
//! ordinary Euclidean depth. The structs and lists must outlive the unit set that is made of them. A struct's `dimension` is 2 to 6; of its
//! six numbers the first `dimension` count.

use super::*;
use core::cell::Cell;
use qdist::NOT_FINITE;
use qdist::internal::norm;
use qdist::qset::Ball;

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
pub struct qdist_ellipsoid_unit_f64 {
    pub semi_axes: [f64; 6],
    /// Row-major, `dimension` x `dimension`; NULL: identity.
    pub rotation: In<f64>,
    pub dimension: u32,
}

/// The box |x_i| <= half[i]; sizes >= 0, not all zero.
#[repr(C)]
pub struct qdist_box_unit_f64 {
    pub half: [f64; 6],
    pub dimension: u32,
}

/// The hull of the points +- semi_axes[i] on axis i; sizes >= 0, not all zero.
#[repr(C)]
pub struct qdist_cross_unit_f64 {
    pub semi_axes: [f64; 6],
    pub dimension: u32,
}

/// The segment from the origin to `end`, which is not zero: the depth is how many times `end` fits into A from the origin, as
/// for a ray.
#[repr(C)]
pub struct qdist_segment_unit_f64 {
    pub end: [f64; 6],
    pub dimension: u32,
}
gaps!(qdist_segment_unit_f64, dimension..);

/// Makes the ball of this radius > 0 around the origin, of any dimension.
///
/// Status: ARGUMENT (radius is not above 0), NONFINITE (radius).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_ball_f64(unit: Out<qdist_unit_f64>, radius: f64) -> qdist_status {
    let ball = qdist_unit_f64 { extent: radius, ball_radius: radius, inner_radius: radius, ..qdist_unit_f64::ZERO };
    status(semi_axes(&[radius]).and_then(|()| unit.put(ball)))
}

/// Makes an ellipsoid.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a semi axis is negative, or all are 0), NONFINITE (semi axes or rotation), ROTATION (rotation:
/// its columns are not orthonormal, to 1e-4).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_ellipsoid_f64(
    unit: Out<qdist_unit_f64>,
    shape: In<qdist_ellipsoid_unit_f64>,
) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_unit::<_, N>(unit, shape))))
}

/// Makes a box.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a half size is negative, or all are 0), NONFINITE (a half size, or the diagonal is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_box_f64(unit: Out<qdist_unit_f64>, shape: In<qdist_box_unit_f64>) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_unit::<_, N>(unit, shape))))
}

/// Makes a cross-polytope.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (a semi axis is negative, or all are 0), NONFINITE (a semi axis).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_cross_f64(unit: Out<qdist_unit_f64>, shape: In<qdist_cross_unit_f64>) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_unit::<_, N>(unit, shape))))
}

/// Makes a segment.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (end is 0), NONFINITE (end).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_segment_f64(unit: Out<qdist_unit_f64>, shape: In<qdist_segment_unit_f64>) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_unit::<_, N>(unit, shape))))
}

/// Makes the hull of the origin and a list of points, not all zero. Reads all of them.
///
/// Status: DIMENSION (shape->dimension), ARGUMENT (shape->count is 0, or all points are), NONFINITE (a coordinate).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_unit_vertices_f64(unit: Out<qdist_unit_f64>, shape: In<qdist_points_f64>) -> qdist_status {
    status(shape.get().and_then(|s| in_dimension!(s.dimension, fill_unit::<_, N>(unit, shape))))
}

/// A unit set of the caller that has passed the checks.
pub(super) enum CheckedUnit<'a> {
    Ball(Ball<f64>),
    Other(CallbackUnit<'a>),
}

impl<'a> CheckedUnit<'a> {
    /// Checks the numbers for dimension `N`; NULL: the unit ball.
    pub(super) fn new<const N: usize>(q: &'a In<qdist_unit_f64>) -> Check<Self> {
        let Some(q) = q.optional()? else { return Ok(Self::Ball(Ball::unit())) };
        if q.dimension != 0 && q.dimension as usize != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        if length(q.ball_radius)? > 0.0 {
            return Ball::new(q.ball_radius).map(Self::Ball).map_err(from_shape);
        }
        CallbackUnit::new::<N>(q).map(Self::Other)
    }

    pub(super) fn unit<const N: usize>(&self) -> &dyn UnitSet<f64, N> {
        match self {
            Self::Ball(ball) => ball,
            Self::Other(unit) => unit,
        }
    }

    /// The failure of a query as the caller sees it.
    pub(super) fn code(&self, failure: Option<Failure>) -> i32 {
        match self {
            Self::Ball(_) => code(failure),
            Self::Other(unit) => unit.code(failure),
        }
    }
}

/// A unit set of the caller that is no ball, as a [`UnitSet`].
pub(super) struct CallbackUnit<'a> {
    given: &'a qdist_unit_f64,
    value: unsafe extern "C" fn(user: *mut c_void, direction: *const f64) -> f64,
    error: f64,
    /// The code of the vertex function that failed, else 0.
    code: Cell<i32>,
}

impl<'a> CallbackUnit<'a> {
    /// Checks the numbers. Where the extent is not known, the values along the axes bound it. (The header: the functions may be called with `user`, in
    /// dimension `N`, during the call.)
    fn new<const N: usize>(given: &'a qdist_unit_f64) -> Check<Self> {
        let value = given.value.ok_or(QDIST_ERROR_NULL)?;
        if given.vertex_count > 0 && given.vertex.is_none() {
            return Err(QDIST_ERROR_NULL);
        }
        let mut extent = length(given.extent)?;
        if length(given.inner_radius)? > extent && extent > 0.0 {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let mut unit = Self { given, value, error: 0.0, code: Cell::new(0) };
        if !(extent > 0.0) {
            let mut corner = Vector::<f64, N>::zeros();
            let mut axis = Vector::<f64, N>::zeros();
            let mut empty = true;
            for i in 0..N {
                for sign in [1.0, -1.0] {
                    axis[i] = sign;
                    let value = unit.ask(&axis);
                    // What is no value of a unit set makes the error NaN, and ends the query.
                    corner[i] = if value >= 0.0 { corner[i].at_least(value) } else { f64::NAN };
                    empty &= value == 0.0;
                }
                axis[i] = 0.0;
            }
            if empty {
                return Err(QDIST_ERROR_ARGUMENT);
            }
            extent = norm(&corner);
        }
        unit.error = f64::count(16 * N) * f64::ROUNDOFF * extent;
        Ok(unit)
    }

    /// The code of the vertex function, if that ended the query with `failure`.
    pub fn code(&self, failure: Option<Failure>) -> i32 {
        let failure = code(failure);
        if failure == NOT_FINITE && self.code.get() != 0 { self.code.get() } else { failure }
    }

    #[inline(always)]
    fn ask<const N: usize>(&self, u: &Vector<f64, N>) -> f64 {
        // SAFETY: the promise of `new`; the vector is N numbers in a row.
        unsafe { (self.value)(self.given.user, u.as_ptr()) }
    }
}

impl<const N: usize> UnitSet<f64, N> for CallbackUnit<'_> {
    #[inline]
    fn value(&self, u: &Vector<f64, N>) -> Result<f64, Failure> {
        Ok(self.ask(u))
    }
    fn mapping(&self, u: &Vector<f64, N>) -> Option<Vector<f64, N>> {
        let mut point = Vector::<f64, N>::from_element(f64::NAN);
        // SAFETY: the promise of `new`.
        let code = unsafe { support(self.given.point, self.given.user, u.as_slice(), point.as_mut_slice()) };
        (code == 0).then(|| one_by_one(&point))
    }
    fn vertex_count(&self) -> usize {
        self.given.vertex_count as usize
    }
    /// NaN, which no ray is shot at, when the function fails.
    fn vertex(&self, index: usize) -> Vector<f64, N> {
        let mut point = Vector::<f64, N>::from_element(f64::NAN);
        if let Some(function) = self.given.vertex {
            // SAFETY: the promise of `new`; the vector is N numbers in a row.
            let code = unsafe { function(self.given.user, index as u32, point.as_mut_ptr()) };
            if code != 0 {
                self.code.set(code);
            }
            if code != 0 || coordinates(point.as_slice()).is_err() {
                point = Vector::from_element(f64::NAN);
            }
        }
        point
    }
    fn inner_radius(&self) -> f64 {
        self.given.inner_radius
    }
    fn mirrored(&self, signs: u8) -> bool {
        // SAFETY: the promise of `new`.
        unsafe { is_mirrored(self.given.mirrored, self.given.user, signs) }
    }
    fn error(&self) -> f64 {
        self.error
    }
}
