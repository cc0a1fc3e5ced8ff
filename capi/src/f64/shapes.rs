//! SHAPES IN SPACE
//!
//! Plain structs that you own. All are centred at the origin of the body's frame, with their axes along its axes. A size
//! may be zero: flat shapes are legal.
//!
//! `qdist_body_..._f64` checks a shape, makes body->set point at it and sets the identity pose; the shape must outlive
//! the body. Sizes are not checked again: make the body anew when they change. (A size that has become NaN or
//! infinite ends the query with QDIST_CALLBACK_NONFINITE; after any other change, the answer means nothing.)
//!
//! `qdist_..._support_f64` is the support function that the body gets, that of the shape's core (without the ball
//! that body->set.radius sweeps over it: a sphere's core is its centre, an ellipsoid's a smaller ellipsoid-like set); user is the
//! shape, and the code that it returns is a qdist_status. For a shape in qdist_solve3, take body.set.

use super::super::generic::{aligned, mirrored_always, put, shared, tiny};
use super::super::status::{Check, from_shape, qdist_status, status};
use super::super::symmetry::{QDIST_SYMMETRY_AXIS, QDIST_SYMMETRY_FULL, QDIST_SYMMETRY_NONE, qdist_mirrored};
use super::sets::{answer_precisely, arguments, qdist_body_f64, qdist_precise_f64, qdist_set_f64, qdist_support_f64};
use core::ffi::c_void;
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, ShapeError, Sphere, Support, Symmetry, Turning};
use qdist::{Real, TwoWords, Vector};

/// All points within `radius` of the origin.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_sphere_f64 {
    pub radius: f64,
}

/// |x| <= half[0], |y| <= half[1], |z| <= half[2].
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_box_f64 {
    pub half: [f64; 3],
}

/// The ellipsoid with these semi axes along x, y and z.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_ellipsoid_f64 {
    pub semi_axes: [f64; 3],
}

/// x^2 + y^2 <= radius^2, |z| <= half_height.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_cylinder_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// All points within `radius` of the segment from (0, 0, -half_height) to (0, 0, half_height).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_capsule_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// The hull of the disk of `radius` at z = -half_height and the apex (0, 0, half_height).
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_cone_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// A struct of shape as the set that it stands for.
pub(super) trait Shape<const N: usize> {
    type Set: Support<f64, N>;
    /// Checks the sizes.
    fn set(&self) -> Result<Self::Set, ShapeError>;
    /// Trusts them.
    fn trusted(&self) -> Self::Set;
}

macro_rules! shape {
    ($struct:ty, $dimension:literal, $set:ty, |$s:ident| $($size:expr),+) => {
        impl Shape<$dimension> for $struct {
            type Set = $set;
            fn set(&self) -> Result<Self::Set, ShapeError> {
                let $s = self;
                <$set>::new($($size),+)
            }
            #[inline(always)]
            fn trusted(&self) -> Self::Set {
                let $s = self;
                <$set>::trusted($($size),+)
            }
        }
    };
}

pub(super) use shape;

shape!(qdist_sphere_f64, 3, Sphere<f64, 3>, |s| s.radius);
shape!(qdist_box_f64, 3, BoxShape<f64, 3>, |s| Vector::from(s.half));
shape!(qdist_ellipsoid_f64, 3, Ellipsoid<f64, 3>, |s| Vector::from(s.semi_axes));
shape!(qdist_cylinder_f64, 3, Cylinder<f64>, |s| s.radius, s.half_height);
shape!(qdist_capsule_f64, 3, Capsule<f64, 3>, |s| s.radius, s.half_height);
shape!(qdist_cone_f64, 3, Cone<f64>, |s| s.radius, s.half_height);

/// The set of a shape, for the C interface and as it is.
///
/// # Safety
/// If not NULL and aligned, `shape` is valid for reads.
pub(super) unsafe fn set_of<S: Shape<N>, const N: usize>(
    shape: *const S,
    support: qdist_support_f64,
) -> Check<(qdist_set_f64, S::Set)> {
    // SAFETY: the caller's promise.
    let set = unsafe { shared(shape) }?.set().map_err(from_shape)?;
    let mirrored: qdist_mirrored = match (set.mirrored(7), set.mirrored(3)) {
        (true, _) => Some(mirrored_always),
        (_, true) => Some(mirrored_sideways),
        _ => None,
    };
    let made = qdist_set_f64 {
        support,
        exhaustive: None,
        mirrored,
        user: shape.cast_mut().cast(),
        radius: set.radius(),
        extent: set.extent().at_least(tiny()),
        error: set.error().at_least(tiny()),
        dimension: N as u32,
        contains_origin: set.contains_origin().into(),
    };
    Ok((made, set))
}

/// Fills a body with a shape.
///
/// # Safety
/// If not NULL and aligned, `body` is valid for writes and `shape` for reads.
unsafe fn fill<S: Shape<3>>(body: *mut qdist_body_f64, shape: *const S, support: qdist_support_f64) -> Check {
    aligned(body)?;
    // SAFETY: the caller's promise.
    let (made, set) = unsafe { set_of(shape, support) }?;
    let rolling_radius = set.rolling_radius();
    let symmetry = from_symmetry(set.symmetry());
    let turning = set.turning().map(Turning::into_raw);
    let (extents, errors) = (set.extents().into(), set.errors().into());
    let precise = precise_of::<S, 3>(&set);
    let made = qdist_body_f64 {
        symmetry,
        rolling_radius,
        turning,
        extents,
        errors,
        precise,
        ..qdist_body_f64::at_origin(made)
    };
    // SAFETY: not NULL, aligned, and the caller's promise.
    unsafe { put(body, made) };
    Ok(())
}

/// The support function in two words, for shapes that have it.
pub(super) fn precise_of<S: Shape<N>, const N: usize>(set: &S::Set) -> qdist_precise_f64 {
    set.support_in_two_words(&TwoWords::from(Vector::repeat(1.0)))?;
    Some(precise::<S, N>)
}

unsafe extern "C" fn precise<S: Shape<N>, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    unsafe { answer_precisely(user, direction, point, |shape: &S, u| shape.trusted().support_in_two_words(u)) }
}

pub(super) fn from_symmetry(symmetry: Symmetry) -> u32 {
    match symmetry {
        Symmetry::None => QDIST_SYMMETRY_NONE,
        Symmetry::Axis => QDIST_SYMMETRY_AXIS,
        Symmetry::Full => QDIST_SYMMETRY_FULL,
    }
}

/// The mirror function of solids of revolution.
unsafe extern "C" fn mirrored_sideways(_user: *mut c_void, signs: u32) -> i32 {
    i32::from(signs & 4 == 0)
}

/// Asks a shape. Its sizes were checked when the body was made.
///
/// # Safety
/// Those of [`arguments`].
#[inline(always)]
pub(super) unsafe fn ask<S: Shape<N>, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check {
    // SAFETY: the caller's promise.
    let (shape, u, room) = unsafe { arguments::<S, N>(user, direction, point) }?;
    let farthest = shape.trusted().support(u).map_err(|failure| failure.0)?;
    // SAFETY: `arguments` has checked it.
    unsafe { room.write(farthest.into()) };
    Ok(())
}

/// Makes a body of a sphere.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_sphere_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_sphere_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_sphere_support_f64)) })
}

/// Makes a body of a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_box_f64(body: *mut qdist_body_f64, shape: *const qdist_box_f64) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_box_support_f64)) })
}

/// Makes a body of an ellipsoid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_ellipsoid_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_ellipsoid_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_ellipsoid_support_f64)) })
}

/// Makes a body of a cylinder.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_cylinder_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_cylinder_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_cylinder_support_f64)) })
}

/// Makes a body of a capsule.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_capsule_f64(
    body: *mut qdist_body_f64,
    shape: *const qdist_capsule_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_capsule_support_f64)) })
}

/// Makes a body of a cone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_cone_f64(body: *mut qdist_body_f64, shape: *const qdist_cone_f64) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill(body, shape, Some(qdist_cone_support_f64)) })
}

/// Support function of a sphere's core.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_sphere_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_sphere_f64, 3>(user, direction, point) })
}

/// Support function of a box.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_box_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_box_f64, 3>(user, direction, point) })
}

/// Support function of an ellipsoid's core.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_ellipsoid_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_ellipsoid_f64, 3>(user, direction, point) })
}

/// Support function of a cylinder.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_cylinder_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_cylinder_f64, 3>(user, direction, point) })
}

/// Support function of a capsule's core, a segment.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_capsule_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_capsule_f64, 3>(user, direction, point) })
}

/// Support function of a cone.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_cone_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask::<qdist_cone_f64, 3>(user, direction, point) })
}
