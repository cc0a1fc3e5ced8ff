//! BODIES IN THE PLANE
//!
//! All that qdist_depth3 does in space, in the plane: discs, boxes, ellipses, capsules, polygons, half planes, hulls of two bodies, and support
//! functions of your own. The solver is one of dimension 2; for polygons of m and n vertices, m + n vertices and as many facets
//! suffice. Results are those of space, with 0 as the third numbers.
//!
//! A pose has a 2 x 2 matrix, as one in space has a 3 x 3 matrix, and not an angle, whose sine and cosine would be rounded here, each in its own
//! way: write { c, -s, s, c } for the cosine and sine that you have.

use super::super::generic::{aligned, ask, coordinates, gaps, known_size, lengths, put, shared, tiny};
use super::super::handle::{self, qdist_solver};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_UNBOUNDED, from_body, from_shape, from_status, overflow, qdist_status,
    status,
};
use super::super::symmetry::qdist_unbounded;
use super::points::{self, qdist_points_f64};
use super::query::{conclude, convert, from_depth, qdist_depth_f64, qdist_options_f64};
use super::sets::{arguments, ask_precisely, qdist_precise_f64, qdist_set_f64, qdist_support_f64};
use super::shapes::{self, Shape, shape};
use core::ffi::c_void;
use qdist::Body;
use qdist::internal;
use qdist::support::{BoxShape, Capsule, Ellipsoid, Failure, HalfSpace, Join, Rigid, ShapeError, Sphere, Support};
use qdist::{BodyError, Matrix2};
use qdist::{Real, TwoWords, Vector};

/// A set in the plane with a pose: x -> rotation * x + translation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_body2_f64 {
    /// The set, in the body's frame.
    pub set: qdist_set_f64,
    /// Row-major: { c, -s, s, c } for cosine c and sine s. A rotation to within 1e-4; used as it is given.
    pub rotation: [f64; 4],
    /// Position of the body's frame in the world.
    pub translation: [f64; 2],
    /// As in qdist_body_f64.
    pub center: [f64; 2],
    pub rolling_radius: f64,
    pub spread: f64,
    pub extents: [f64; 2],
    pub errors: [f64; 2],
    /// NULL; what qdist_body2_half_plane puts here answers in place of the support function. Not for functions of your own.
    pub unbounded: qdist_unbounded,
    /// As in qdist_body_f64.
    pub precise: qdist_precise_f64,
}

gaps!(qdist_body2_f64, set.contains_origin..rotation, errors..unbounded, precise..);

/// All points within `radius` of the origin.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_disc_f64 {
    pub radius: f64,
}

/// |x| <= half[0], |y| <= half[1].
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_box2_f64 {
    pub half: [f64; 2],
}

/// The ellipse with these semi axes along x and y.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_ellipse_f64 {
    pub semi_axes: [f64; 2],
}

/// All points within `radius` of the segment from (0, -half_height) to (0, half_height).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_capsule2_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// The points x with normal . x <= offset. The normal points out of the half plane; it need not be of unit length, but not 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_half_plane_f64 {
    pub normal: [f64; 2],
    pub offset: f64,
}

/// The convex hull of two bodies, as qdist_join_f64.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_join2_f64 {
    pub a: *const qdist_body2_f64,
    pub b: *const qdist_body2_f64,
}

shape!(qdist_disc_f64, 2, Sphere<f64, 2>, |s| s.radius);
shape!(qdist_box2_f64, 2, BoxShape<f64, 2>, |s| Vector::from(s.half));
shape!(qdist_ellipse_f64, 2, Ellipsoid<f64, 2>, |s| Vector::from(s.semi_axes));
shape!(qdist_capsule2_f64, 2, Capsule<f64, 2>, |s| s.radius, s.half_height);

// ------------------------------------------------------------------------------------------------------------- bodies

impl qdist_body2_f64 {
    /// The identity pose.
    fn at_origin(set: qdist_set_f64) -> Self {
        Self {
            set,
            rotation: [1.0, 0.0, 0.0, 1.0],
            translation: [0.0; 2],
            center: [0.0; 2],
            rolling_radius: 0.0,
            spread: 0.0,
            extents: [0.0; 2],
            errors: [0.0; 2],
            unbounded: None,
            precise: None,
        }
    }

    /// Checks the numbers, except for the pose, which [`place`](CheckedBody2::place) does.
    ///
    /// # Safety
    /// As for [`qdist_set_f64::checked`], in dimension 2.
    #[inline(always)]
    unsafe fn checked(&self) -> Check<&CheckedBody2> {
        // SAFETY: the caller's promise.
        unsafe { self.set.checked::<2>() }?;
        let [[a, b], [c, d]] = [self.extents, self.errors];
        lengths([self.spread, self.rolling_radius, a, b, c, d])?;
        if self.spread > 0.0 {
            coordinates(&self.center)?;
        }
        if self.rolling_radius > self.set.radius {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        // SAFETY: transparent.
        Ok(unsafe { &*core::ptr::from_ref(self).cast() })
    }

    fn matrix(&self) -> Matrix2<f64> {
        Matrix2::from_row_slice(&self.rotation)
    }
}

/// A body that has passed the checks, where it lies, as a [`Support`] in its own frame.
#[repr(transparent)]
struct CheckedBody2(qdist_body2_f64);

impl CheckedBody2 {
    /// The body in its pose.
    #[inline(always)]
    fn place(&self) -> Result<Body<'_, f64, 2>, BodyError> {
        Body::new(self, self.0.matrix(), Vector::from(self.0.translation))
    }
}

impl Support<f64, 2> for CheckedBody2 {
    #[inline]
    fn support(&self, u: &Vector<f64, 2>) -> Result<Vector<f64, 2>, Failure> {
        // SAFETY: the promise of `checked`.
        unsafe { ask(self.0.set.support, self.0.set.user, u) }
    }
    fn exhaustive(&self, u: &Vector<f64, 2>) -> Result<(Vector<f64, 2>, Vector<f64, 2>), Failure> {
        // SAFETY: the promise of `checked`.
        unsafe { ask(self.0.set.exhaustive.or(self.0.set.support), self.0.set.user, u) }.map(|p| (p, p))
    }
    fn has_shortcuts(&self) -> bool {
        self.0.set.exhaustive.is_some()
    }
    fn radius(&self) -> f64 {
        self.0.set.radius
    }
    fn rolling_radius(&self) -> f64 {
        self.0.rolling_radius
    }
    fn extent(&self) -> f64 {
        self.0.set.extent
    }
    fn center(&self) -> Option<(Vector<f64, 2>, f64)> {
        (self.0.spread > 0.0).then(|| (Vector::from(self.0.center), self.0.spread))
    }
    fn contains_origin(&self) -> bool {
        self.0.set.knows_origin(2)
    }
    fn error(&self) -> f64 {
        self.0.set.stated_error(2)
    }
    fn support_in_two_words(&self, u: &TwoWords<f64, 2>) -> Option<TwoWords<f64, 2>> {
        // SAFETY: the promise of `checked`.
        unsafe { ask_precisely(self.0.precise, self.0.set.user, u) }
    }
    fn errors(&self) -> Vector<f64, 2> {
        let stated = self.0.extents.iter().any(|&x| x > 0.0);
        if stated { Vector::from(self.0.errors) } else { Vector::repeat(self.0.set.stated_error(2)) }
    }
    fn extents(&self) -> Vector<f64, 2> {
        let stated = self.0.extents.iter().any(|&x| x > 0.0);
        if stated { Vector::from(self.0.extents) } else { Vector::repeat(self.0.set.extent) }
    }
}

/// Fills a body with a shape.
///
/// # Safety
/// If not NULL and aligned, `body` is valid for writes and `shape` for reads.
unsafe fn fill<S: Shape<2>>(body: *mut qdist_body2_f64, shape: *const S, support: qdist_support_f64) -> Check {
    aligned(body)?;
    // SAFETY: the caller's promise.
    let (made, set) = unsafe { shapes::set_of(shape, support) }?;
    let rolling_radius = set.rolling_radius();
    let (extents, errors) = (set.extents().into(), set.errors().into());
    let precise = shapes::precise_of::<S, 2>(&set);
    let made = qdist_body2_f64 { rolling_radius, extents, errors, precise, ..qdist_body2_f64::at_origin(made) };
    // SAFETY: not NULL, aligned, and the caller's promise.
    unsafe { put(body, made) };
    Ok(())
}

/// Makes a body of a disc, in the identity pose, like all that follow.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_disc_f64(
    body: *mut qdist_body2_f64,
    shape: *const qdist_disc_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_disc_support_f64)) })
}

/// Makes a body of a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_box_f64(body: *mut qdist_body2_f64, shape: *const qdist_box2_f64) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_box2_support_f64)) })
}

/// Makes a body of an ellipse.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_ellipse_f64(
    body: *mut qdist_body2_f64,
    shape: *const qdist_ellipse_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_ellipse_support_f64)) })
}

/// Makes a body of a capsule.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_capsule_f64(
    body: *mut qdist_body2_f64,
    shape: *const qdist_capsule2_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_capsule2_support_f64)) })
}

/// Makes a body of the convex hull of a list of points of dimension 2, in any order: a convex polygon. Reads all of them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_points_f64(
    body: *mut qdist_body2_f64,
    shape: *const qdist_points_f64,
) -> qdist_status {
    let supports: [qdist_support_f64; 2] = [Some(qdist_points2_support_f64), Some(qdist_points2_far_support_f64)];
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let (set, center, [extents, errors]) =
            unsafe { points::set_of::<2>(shared(shape)?, shape.cast(), supports, [None; 2]) }?;
        let precise: qdist_precise_f64 = Some(points::precise::<2>);
        let mut made = qdist_body2_f64 { extents, errors, precise, ..qdist_body2_f64::at_origin(set) };
        if let Some((center, spread)) = center {
            (made.center, made.spread) = (center, spread);
        }
        // SAFETY: checked.
        unsafe { put(body, made) };
        Ok(())
    };
    status(fill())
}

/// Makes a body of any set of dimension 2. Checks and copies the set; what it points to must outlive the body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_set_f64(body: *mut qdist_body2_f64, set: *const qdist_set_f64) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller; the functions are not called here.
        unsafe {
            let set = shared(set)?;
            set.checked::<2>()?;
            put(body, qdist_body2_f64::at_origin(*set));
        }
        Ok(())
    };
    status(fill())
}

/// Makes a body of the hull of two bodies. Their support functions are called where they do not state their extent.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_join_f64(
    body: *mut qdist_body2_f64,
    join: *const qdist_join2_f64,
) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let set = unsafe {
            let parts = shared(join)?;
            let set = parts.set()?;
            for part in [parts.a, parts.b] {
                // The pose as queries check it.
                shared(part)?.checked()?.place().map_err(from_body)?;
            }
            set
        };
        let made = qdist_set_f64 {
            support: Some(qdist_join2_support_f64),
            exhaustive: if set.has_shortcuts() { Some(qdist_join2_exhaustive_f64) } else { None },
            mirrored: None,
            user: join.cast_mut().cast(),
            radius: set.radius(),
            extent: set.extent().at_least(tiny()),
            error: set.error().at_least(tiny()),
            dimension: 2,
            contains_origin: set.contains_origin().into(),
        };
        let made = qdist_body2_f64 { rolling_radius: set.rolling_radius(), ..qdist_body2_f64::at_origin(made) };
        // SAFETY: what the header asks of the caller; a measured extent may be infinite.
        unsafe {
            made.checked()?;
            put(body, made);
        }
        Ok(())
    };
    status(fill())
}

/// Makes a body of a half plane, as qdist_body_half_space in space. Numbers are read at every query.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body2_half_plane_f64(
    body: *mut qdist_body2_f64,
    shape: *const qdist_half_plane_f64,
) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        unsafe { shared(shape) }?.set()?;
        let set = qdist_set_f64 {
            support: Some(refuse),
            exhaustive: None,
            mirrored: None,
            user: shape.cast_mut().cast(),
            radius: 0.0,
            extent: 0.0,
            error: 0.0,
            dimension: 2,
            contains_origin: 0,
        };
        // SAFETY: checked.
        unsafe { put(body, qdist_body2_f64 { unbounded: Some(answer), ..qdist_body2_f64::at_origin(set) }) };
        Ok(())
    };
    status(fill())
}

// -------------------------------------------------------------------------------------------------- support functions

/// Support function of a disc's core.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_disc_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { shapes::ask::<qdist_disc_f64, 2>(user, direction, point) })
}

/// Support function of a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_box2_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { shapes::ask::<qdist_box2_f64, 2>(user, direction, point) })
}

/// Support function of an ellipse's core.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_ellipse_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { shapes::ask::<qdist_ellipse_f64, 2>(user, direction, point) })
}

/// Support function of a capsule's core, a segment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_capsule2_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { shapes::ask::<qdist_capsule2_f64, 2>(user, direction, point) })
}

/// Support function of a list of points of dimension 2.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points2_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { points::scan::<false, 2>(user, direction, point) })
}

/// The same, more accurate where all points are far from the origin compared with their spread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_points2_far_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { points::scan::<true, 2>(user, direction, point) })
}

/// Support function of the core of a hull of two bodies: without the smaller of the two radii.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_join2_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_join(user, direction, point, false) })
}

/// The same, where a part has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_join2_exhaustive_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_join(user, direction, point, true) })
}

/// cbindgen:ignore
type Part<'a> = Rigid<&'a CheckedBody2, f64, 2>;

impl qdist_join2_f64 {
    /// # Safety
    /// If not NULL and aligned, the bodies are valid for reads, and as [`qdist_body2_f64::checked`] asks.
    unsafe fn set<'a>(&self) -> Check<Join<Part<'a>, Part<'a>>> {
        // SAFETY: the caller's promise.
        unsafe { Ok(Join::new(part(self.a)?, part(self.b)?)) }
    }
}

/// # Safety
/// As for [`qdist_join2_f64::set`].
#[inline(always)]
unsafe fn part<'a>(body: *const qdist_body2_f64) -> Check<Part<'a>> {
    // SAFETY: the caller's promise.
    let body = unsafe { shared(body) }?;
    if body.unbounded.is_some() {
        return Err(QDIST_ERROR_UNBOUNDED);
    }
    // SAFETY: the caller's promise.
    let set = unsafe { body.checked() }?;
    Rigid::new(set, body.matrix(), Vector::from(body.translation)).map_err(from_shape)
}

/// # Safety
/// Those of a support function.
unsafe fn ask_join(user: *mut c_void, direction: *const f64, point: *mut f64, exhaustive: bool) -> Check {
    // SAFETY: what the header asks of the caller.
    let (set, u, room) = unsafe {
        let (join, u, room) = arguments::<qdist_join2_f64, 2>(user, direction, point)?;
        (join.set()?, u, room)
    };
    let farthest = if exhaustive { set.exhaustive(u).map(|(point, _)| point) } else { set.support(u) };
    // SAFETY: `arguments` has checked it.
    unsafe { room.write(farthest.map_err(|failure| failure.0)?.into()) };
    Ok(())
}

/// A half plane has no farthest point.
unsafe extern "C" fn refuse(_user: *mut c_void, _direction: *const f64, _point: *mut f64) -> i32 {
    QDIST_ERROR_UNBOUNDED
}

// -------------------------------------------------------------------------------------------------------------- query

/// Penetration depth or distance of two bodies in the plane, with witness points. A and B may be the same body. The solver is
/// one of dimension 2. Swapping A and B turns the normal and swaps the points.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_depth2_f64(
    solver: *mut qdist_solver,
    a: *const qdist_body2_f64,
    b: *const qdist_body2_f64,
    options: *const qdist_options_f64,
    result: *mut qdist_depth_f64,
) -> qdist_status {
    let solve = || {
        aligned(result)?;
        // SAFETY: what the header asks of the caller.
        let (mut solver, one, other) = unsafe {
            let (a, b) = (shared(a)?, shared(b)?);
            let solver = handle::open::<f64, 2>(solver)?;
            known_size((&raw const (*result).struct_size).read(), size_of::<qdist_depth_f64>())?;
            (solver, a, b)
        };
        if let Some(answer) = one.unbounded.or(other.unbounded) {
            // SAFETY: a function of this library for these arguments, which are checked.
            return from_status(unsafe { answer(a.cast(), b.cast(), options.cast(), result.cast()) });
        }
        // SAFETY: what the header asks of the caller.
        let (one, other, (options, deadline)) = unsafe { (one.checked()?, other.checked()?, convert::<2>(options)?) };
        let (one, other) = (one.place().map_err(from_body)?, other.place().map_err(from_body)?);
        let depth = deadline.during(|interrupt| solver.depth_until(&one, &other, &options, interrupt));
        overflow(depth.failure)?;
        // SAFETY: checked.
        unsafe { put(result, from_depth(&depth)) };
        conclude(depth.outcome)
    };
    status(solve())
}

impl qdist_half_plane_f64 {
    fn set(&self) -> Check<HalfSpace<f64, 2>> {
        HalfSpace::new(Vector::from(self.normal), self.offset).map_err(from_shape)
    }
}

/// A body of either kind.
enum Either<'a> {
    HalfPlane(HalfSpace<f64, 2>, &'a qdist_body2_f64),
    Compact(&'a CheckedBody2),
}

impl<'a> Either<'a> {
    /// # Safety
    /// As for [`qdist_body2_f64::checked`].
    unsafe fn new(body: &'a qdist_body2_f64) -> Check<Self> {
        if body.unbounded.is_some() {
            // SAFETY: the caller's promise.
            let shape = unsafe { shared(body.set.user.cast::<qdist_half_plane_f64>().cast_const()) }?;
            return Ok(Either::HalfPlane(shape.set()?, body));
        }
        // SAFETY: the caller's promise.
        Ok(Either::Compact(unsafe { body.checked() }?))
    }

    fn place(&self) -> Result<Body<'_, f64, 2>, BodyError> {
        match self {
            Either::Compact(body) => body.place(),
            Either::HalfPlane(shape, body) => Body::new(shape, body.matrix(), Vector::from(body.translation)),
        }
    }
}

/// The query of two bodies, one of which is a half plane.
unsafe extern "C" fn answer(
    a: *const c_void,
    b: *const c_void,
    options: *const c_void,
    result: *mut c_void,
) -> qdist_status {
    let solve = || {
        // SAFETY: `qdist_depth2_f64` has checked the pointers.
        let (a, b, (options, _)) = unsafe {
            let (a, b) = (Either::new(&*a.cast())?, Either::new(&*b.cast())?);
            (a, b, convert::<2>(options.cast())?)
        };
        let (a, b) = (a.place().map_err(from_body)?, b.place().map_err(from_body)?);
        let depth = internal::unbounded(&a, &b, &options).ok_or(QDIST_ERROR_UNBOUNDED)?;
        overflow(depth.failure)?;
        // SAFETY: `qdist_depth2_f64` has checked it.
        unsafe { put(result.cast::<qdist_depth_f64>(), from_depth(&depth)) };
        conclude(depth.outcome)
    };
    status(solve())
}
