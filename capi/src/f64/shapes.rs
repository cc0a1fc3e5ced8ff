//! SHAPES IN SPACE
//!
//! Plain structs that you own. All are centred at the origin of the body's frame, with their axes along its axes. A size
//! may be zero: flat shapes are legal.
//!
//! `qdist_body_..._f64` checks a shape, makes body->set point at it and sets the identity pose; the shape must outlive
//! the body. Sizes are not checked again: make the body anew when they change. (A size that has become NaN or
//! infinite ends the query with QDIST_CALLBACK_NONFINITE; after any other change, the answer means nothing.)
//!
//! body->set.support is the support function of the shape's core (without the ball that body->set.radius sweeps over it: a sphere's core is
//! its centre, an ellipsoid's a smaller ellipsoid-like set); its user is the shape, and the code that it returns is a qdist_status. For a shape
//! in qdist_solve3, take body.set.

use super::*;
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, ShapeError, Sphere};

/// All points within `radius` of the origin.
#[repr(C)]
pub struct qdist_sphere_f64 {
    pub radius: f64,
}

/// |x| <= half[0], |y| <= half[1], |z| <= half[2].
#[repr(C)]
pub struct qdist_box_f64 {
    pub half: [f64; 3],
}

/// The ellipsoid with these semi axes along x, y and z.
#[repr(C)]
pub struct qdist_ellipsoid_f64 {
    pub semi_axes: [f64; 3],
}

/// x^2 + y^2 <= radius^2, |z| <= half_height.
#[repr(C)]
pub struct qdist_cylinder_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// All points within `radius` of the segment from (0, 0, -half_height) to (0, 0, half_height).
#[repr(C)]
pub struct qdist_capsule_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// The hull of the disk of `radius` at z = -half_height and the apex (0, 0, half_height).
#[repr(C)]
pub struct qdist_cone_f64 {
    pub radius: f64,
    pub half_height: f64,
}

/// A struct of shape as the set that it stands for.
pub(super) trait Shape<const N: usize>: 'static {
    type Set: Support<f64, N>;
    /// Checks the sizes.
    fn set(&self) -> Result<Self::Set, ShapeError>;
    /// Trusts them: they were checked when the body was made.
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
        gaps!($struct);
    };
}
pub(super) use shape;

shape!(qdist_sphere_f64, 3, Sphere<f64, 3>, |s| s.radius);
shape!(qdist_box_f64, 3, BoxShape<f64, 3>, |s| Vector::from(s.half));
shape!(qdist_ellipsoid_f64, 3, Ellipsoid<f64, 3>, |s| Vector::from(s.semi_axes));
shape!(qdist_cylinder_f64, 3, Cylinder<f64>, |s| s.radius, s.half_height);
shape!(qdist_capsule_f64, 3, Capsule<f64, 3>, |s| s.radius, s.half_height);
shape!(qdist_cone_f64, 3, Cone<f64>, |s| s.radius, s.half_height);

/// The support function of a shape.
struct Kernel<S>(core::marker::PhantomData<S>);

impl<S: Shape<N>, const N: usize> Answers<N> for Kernel<S> {
    type Struct = S;
    #[inline(always)]
    fn farthest(shape: &S, u: &Vector<f64, N>, _exhaustive: bool) -> Check<Vector<f64, N>> {
        shape.trusted().support(u).map_err(|Failure(code)| code)
    }
    fn precise(shape: &S, u: &TwoWords<f64, N>) -> Option<TwoWords<f64, N>> {
        shape.trusted().support_in_two_words(u)
    }
}

/// Fills a body with a shape.
pub(super) fn fill<S: Shape<N>, B: Placed<N>, const N: usize>(body: Out<B>, shape: In<S>) -> Check {
    body.checked()?;
    let set = shape.get()?.set().map_err(from_shape)?;
    let mirrored: qdist_mirrored = match (set.mirrored(7), set.mirrored(3)) {
        (true, _) => Some(mirrored_always),
        (_, true) => Some(mirrored_sideways),
        _ => None,
    };
    let made = qdist_set_f64 {
        support: support_of::<Kernel<S>, N>(),
        mirrored,
        user: shape.user(),
        ..qdist_set_f64::stated_by(&set)
    };
    let is_precise = set.support_in_two_words(&TwoWords::from(Vector::repeat(1.0))).is_some();
    let precise = if is_precise { precise_of::<Kernel<S>, N>() } else { None };
    body.put(B::new(made, Stated { precise, ..Stated::of(&set) }))
}

placed!(qdist_body_f64, 3, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0], symmetry, route);

/// Makes a body of a sphere, in the identity pose, like all that follow.
///
/// Status: ARGUMENT (the radius negative), NONFINITE (the radius NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_sphere_f64(body: Out<qdist_body_f64>, shape: In<qdist_sphere_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a box.
///
/// Status: ARGUMENT (a half size negative), NONFINITE (a half size NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_box_f64(body: Out<qdist_body_f64>, shape: In<qdist_box_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of an ellipsoid.
///
/// Status: ARGUMENT (a semi axis negative), NONFINITE (a semi axis NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_ellipsoid_f64(body: Out<qdist_body_f64>, shape: In<qdist_ellipsoid_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a cylinder.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_cylinder_f64(body: Out<qdist_body_f64>, shape: In<qdist_cylinder_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a capsule.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_capsule_f64(body: Out<qdist_body_f64>, shape: In<qdist_capsule_f64>) -> qdist_status {
    status(fill(body, shape))
}

/// Makes a body of a cone.
///
/// Status: ARGUMENT (radius or half height negative), NONFINITE (radius or half height NaN, infinite or too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_cone_f64(body: Out<qdist_body_f64>, shape: In<qdist_cone_f64>) -> qdist_status {
    status(fill(body, shape))
}
