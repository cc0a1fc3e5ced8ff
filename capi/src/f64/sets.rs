//! CONVEX SETS
//!
//! A convex set is known by its support function: the point of the set that is farthest along a direction. A set is
//! given in two parts, core + radius * ball: the support function gives points of the core, and `radius` is
//! the radius of a ball swept over it. A sphere is a point with a radius, a capsule a segment with a radius, a safety margin
//! is a radius on anything. Write a support function for your own shapes; the built-in shapes are made of the same parts.

use super::super::generic::{aligned, ask, coordinates, flag, gaps, is_mirrored, lengths, put, shared};
use super::super::status::{
    Check, QDIST_ERROR_ALIGNMENT, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_NULL, qdist_status, status,
};
use super::super::symmetry::{
    QDIST_SYMMETRY_AXIS, QDIST_SYMMETRY_FULL, QDIST_SYMMETRY_NONE, qdist_mirrored, qdist_turning, qdist_unbounded,
};
use core::ffi::c_void;
use qdist::Body;
use qdist::support::{Failure, Support, Symmetry, Turning};
use qdist::{BodyError, Matrix3};
use qdist::{Real, TwoWords, Vector};

/// Writes a point of the core that is farthest along `direction` to `point`.
///
/// user: the pointer from the set. direction: as many numbers as the dimension; finite and not all zero, but
/// not necessarily of unit length. point: room for as many.
///
/// Returns 0, or a code of your own, which ends the query and comes back as `callback_code`. Not INT32_MIN to
/// INT32_MIN + 3. The function must not unwind or longjmp, nor use the solver that is calling it. Where several
/// points are equally far, any of them.
pub type qdist_support_f64 =
    Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32>;

/// For sets that know themselves in twice the precision: writes a point of the core that is farthest along a direction u. Both are exact sums of two
/// vectors: u = direction[0 .. N - 1] + direction[N .. 2 N - 1], near unit length, and the point point[0 .. N - 1] + point[N .. 2 N - 1]. Coordinate i of
/// the point may be off by 2^8 roundoff^2 extents[i], its height by what that makes. Returns 0, or anything else where it has no answer.
pub type qdist_precise_f64 =
    Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32>;

/// A convex set, core + radius * ball. Start with `= {0}`: what is zero takes its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_set_f64 {
    /// The support function of the core.
    pub support: qdist_support_f64,
    /// NULL; or, if `support` takes shortcuts and may miss the farthest point, a slower function that does not. It checks
    /// the direction that is about to be reported.
    pub exhaustive: qdist_support_f64,
    /// NULL: not known. Which mirror images of the core are the core itself.
    pub mirrored: qdist_mirrored,
    /// First argument of all functions.
    pub user: *mut c_void,
    /// Radius of the ball swept over the core, >= 0.
    pub radius: f64,
    /// An upper bound of |x| over the core, for the rounding margin; 0: not known, the largest norm seen is taken.
    pub extent: f64,
    /// An upper bound of the rounding error of the support function, as a length: how far its points are off the core, and
    /// how much farther along a unit direction the farthest point may be. 0: 16 * dimension * roundoff * extent, which covers
    /// a few operations on coordinates of the core's size.
    pub error: f64,
    /// The dimension that the functions work in; 0: not known, and not checked.
    pub dimension: u32,
    /// 1: the core contains the origin by its definition, as that of a grasp's wrenches does. Then d >= 0 is known where the origin lies on the boundary,
    /// which no support function can tell, and `lower` is 0 there instead of less by the rounding margin. 0: not known, unless `mirrored` shows
    /// it (what is its own image under a change of all signs contains the origin). What is stated must be true, or the bracket is not.
    pub contains_origin: u32,
}

gaps!(qdist_set_f64, contains_origin..);

/// A set in space with a pose: x -> rotation * x + translation.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_body_f64 {
    /// The set, in the body's frame.
    pub set: qdist_set_f64,
    /// Row-major: rotation[3 * row + column]. A rotation to within 1e-4; used as it is given.
    pub rotation: [f64; 9],
    /// Position of the body's frame in the world.
    pub translation: [f64; 3],
    /// For a set far from the origin of its frame: a point near it. Used when `spread` is above 0.
    pub center: [f64; 3],
    /// The part of set.radius that is not a ball by itself but was split off a rounded shape, as the body functions of ellipsoids
    /// do; 0 to set.radius. Where `rotation` is a rotation only roughly, it does not leave this part a ball.
    pub rolling_radius: f64,
    /// An upper bound of the core's distance from `center`; `set.error` then says how well the support function works relative
    /// to `center`. 0: measured from the origin.
    pub spread: f64,
    /// Upper bounds of |x|, |y| and |z| over the core, in the body's frame: a body that is long and flat along its axes, as a floor, is known better
    /// across. All zero: set.extent along every axis.
    pub extents: [f64; 3],
    /// With `extents`: the rounding error set.error axis by axis; along a unit direction u it is the sum of |u_i| errors[i]. Zero is exact.
    pub errors: [f64; 3],
    /// Exact symmetry of the set in its frame. QDIST_SYMMETRY_NONE (0) is always right; the others make two bodies that turn
    /// about one axis a plane problem.
    pub symmetry: u32,
    /// NULL; what qdist_body_half_space puts here answers in place of the support function. Not for functions of your own.
    pub unbounded: qdist_unbounded,
    /// How depth is found with cylinders, cones and ellipsoids, whose body functions set it: arcs of minimisers around the axis, a closed form. NULL
    /// for your own sets.
    pub turning: qdist_turning,
    /// NULL; or the support function in twice the precision: shallow contact of such bodies is measured to the last digits. The body functions of all
    /// shapes, points and hulls put it here. Called with set.user.
    pub precise: qdist_precise_f64,
}

gaps!(qdist_body_f64, set.contains_origin..rotation, symmetry..unbounded, precise..);

impl qdist_set_f64 {
    /// Checks the numbers for dimension `N`.
    ///
    /// # Safety
    /// For the life of the reference the functions may be called with `user` in dimension `N`, as the header states.
    #[inline(always)]
    pub(super) unsafe fn checked<const N: usize>(&self) -> Check<&CheckedSet> {
        if self.support.is_none() {
            return Err(QDIST_ERROR_NULL);
        }
        lengths([self.radius, self.extent, self.error])?;
        flag(self.contains_origin)?;
        if self.dimension != 0 && self.dimension as usize != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        // SAFETY: transparent.
        Ok(unsafe { &*core::ptr::from_ref(self).cast() })
    }

    /// Does the set state, or its mirror function show, that it contains the origin? As [`Support::contains_origin`].
    pub(super) fn knows_origin(&self, n: usize) -> bool {
        // SAFETY: the header: a mirror function may be called with `user` and any signs.
        self.contains_origin == 1 || unsafe { is_mirrored(self.mirrored, self.user, u8::MAX >> (8 - n.clamp(1, 8))) }
    }

    /// The rounding error that the set states, or the default in dimension `n`.
    pub(super) fn stated_error(&self, n: usize) -> f64 {
        if self.error > 0.0 { self.error } else { f64::count(16 * n) * f64::ROUNDOFF * self.extent }
    }
}

/// A set that has passed the checks, where it lies, as a [`Support`].
#[repr(transparent)]
pub(super) struct CheckedSet(qdist_set_f64);

impl<const N: usize> Support<f64, N> for CheckedSet {
    #[inline]
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        // SAFETY: the promise of `checked`.
        unsafe { ask(self.0.support, self.0.user, u) }
    }
    fn exhaustive(&self, u: &Vector<f64, N>) -> Result<(Vector<f64, N>, Vector<f64, N>), Failure> {
        // SAFETY: the promise of `checked`.
        unsafe { ask(self.0.exhaustive.or(self.0.support), self.0.user, u) }.map(|p| (p, p))
    }
    fn has_shortcuts(&self) -> bool {
        self.0.exhaustive.is_some()
    }
    fn radius(&self) -> f64 {
        self.0.radius
    }
    fn extent(&self) -> f64 {
        self.0.extent
    }
    fn mirrored(&self, signs: u8) -> bool {
        // SAFETY: the promise of `checked`.
        unsafe { is_mirrored(self.0.mirrored, self.0.user, signs) }
    }
    fn contains_origin(&self) -> bool {
        self.0.knows_origin(N)
    }
    fn error(&self) -> f64 {
        self.0.stated_error(N)
    }
}

impl qdist_body_f64 {
    /// The identity pose.
    pub(super) fn at_origin(set: qdist_set_f64) -> Self {
        let rotation = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        Self {
            set,
            rotation,
            translation: [0.0; 3],
            center: [0.0; 3],
            rolling_radius: 0.0,
            spread: 0.0,
            extents: [0.0; 3],
            errors: [0.0; 3],
            symmetry: QDIST_SYMMETRY_NONE,
            unbounded: None,
            turning: None,
            precise: None,
        }
    }

    /// Are extents and errors stated axis by axis?
    fn states_axes(&self) -> bool {
        self.extents.iter().any(|&x| x > 0.0)
    }

    /// Checks the numbers, except for the pose, which [`place`](Self::place) does.
    ///
    /// # Safety
    /// As for [`qdist_set_f64::checked`], in dimension 3.
    #[inline(always)]
    pub(super) unsafe fn checked(&self) -> Check<&CheckedBody> {
        // SAFETY: the caller's promise.
        unsafe { self.set.checked::<3>() }?;
        let [[a, b, c], [d, e, f]] = [self.extents, self.errors];
        lengths([self.spread, self.rolling_radius, a, b, c, d, e, f])?;
        if self.spread > 0.0 {
            coordinates(&self.center)?;
        }
        if self.rolling_radius > self.set.radius || self.symmetry > QDIST_SYMMETRY_FULL {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        // SAFETY: transparent.
        Ok(unsafe { &*core::ptr::from_ref(self).cast() })
    }
}

/// A body that has passed the checks, where it lies, as a [`Support`] in its own frame.
#[repr(transparent)]
pub(super) struct CheckedBody(qdist_body_f64);

impl CheckedBody {
    /// The body in its pose.
    #[inline(always)]
    pub(super) fn place(&self) -> Result<Body<'_, f64>, BodyError> {
        let [a, b, c, d, e, f, g, h, i] = self.0.rotation;
        let rotation = Matrix3::new(a, b, c, d, e, f, g, h, i);
        Body::new(self, rotation, Vector::from(self.0.translation))
    }
}

impl Support<f64, 3> for CheckedBody {
    #[inline]
    fn support(&self, u: &Vector<f64, 3>) -> Result<Vector<f64, 3>, Failure> {
        // SAFETY: the promise of `checked`.
        unsafe { ask(self.0.set.support, self.0.set.user, u) }
    }
    fn exhaustive(&self, u: &Vector<f64, 3>) -> Result<(Vector<f64, 3>, Vector<f64, 3>), Failure> {
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
    fn center(&self) -> Option<(Vector<f64, 3>, f64)> {
        (self.0.spread > 0.0).then(|| (Vector::from(self.0.center), self.0.spread))
    }
    fn symmetry(&self) -> Symmetry {
        match self.0.symmetry {
            QDIST_SYMMETRY_AXIS => Symmetry::Axis,
            QDIST_SYMMETRY_FULL => Symmetry::Full,
            _ => Symmetry::None,
        }
    }
    fn turning(&self) -> Option<Turning<f64>> {
        // SAFETY: what the header asks of the caller: NULL, or what a body function of this scalar type has written.
        self.0.turning.map(|turning| unsafe { Turning::from_raw(turning) })
    }
    fn contains_origin(&self) -> bool {
        self.0.set.knows_origin(3)
    }
    fn error(&self) -> f64 {
        self.0.set.stated_error(3)
    }
    fn support_in_two_words(&self, u: &TwoWords<f64, 3>) -> Option<TwoWords<f64, 3>> {
        // SAFETY: the promise of `checked`.
        unsafe { ask_precisely(self.0.precise, self.0.set.user, u) }
    }
    fn errors(&self) -> Vector<f64, 3> {
        if self.0.states_axes() { Vector::from(self.0.errors) } else { Vector::repeat(self.0.set.stated_error(3)) }
    }
    fn extents(&self) -> Vector<f64, 3> {
        if self.0.states_axes() { Vector::from(self.0.extents) } else { Vector::repeat(self.0.set.extent) }
    }
}

/// Makes a body of any set of dimension 3, in the identity pose. Checks and copies the set; what it points to must outlive the
/// body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_body_set_f64(body: *mut qdist_body_f64, set: *const qdist_set_f64) -> qdist_status {
    let fill = || {
        aligned(body)?;
        // SAFETY: what the header asks of the caller.
        let set = unsafe { shared(set) }?;
        // SAFETY: what the header asks of the caller; the functions are not called here.
        unsafe { set.checked::<3>() }?;
        // SAFETY: checked.
        unsafe { put(body, qdist_body_f64::at_origin(*set)) };
        Ok(())
    };
    status(fill())
}

/// The arguments of a support function in dimension `N`, checked: the struct behind `user`, the direction, and room for the point.
///
/// # Safety
/// Each pointer that is neither NULL nor misaligned is valid for a `S`, for `N` numbers, and for writes of `N` numbers.
#[inline(always)]
pub(super) unsafe fn arguments<'a, S, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check<(&'a S, &'a Vector<f64, N>, *mut [f64; N])> {
    let user = user.cast::<S>().cast_const();
    if user.is_null() || direction.is_null() || point.is_null() {
        return Err(QDIST_ERROR_NULL);
    }
    // One branch for all three.
    if !(user.is_aligned() & direction.is_aligned() & point.is_aligned()) {
        return Err(QDIST_ERROR_ALIGNMENT);
    }
    // SAFETY: neither NULL nor misaligned, and the caller's promise; a vector is its numbers in a row.
    unsafe { Ok((&*user, &*direction.cast(), point.cast())) }
}

/// Room for a point; the pointer is checked, the memory not yet written.
#[inline(always)]
pub(super) fn room<const N: usize>(point: *mut f64) -> Check<*mut [f64; N]> {
    aligned(point)?;
    Ok(point.cast())
}

/// Asks for a support point in two words.
///
/// # Safety
/// The function may be called with `user` in dimension `N`.
pub(super) unsafe fn ask_precisely<const N: usize>(
    function: qdist_precise_f64,
    user: *mut c_void,
    u: &TwoWords<f64, N>,
) -> Option<TwoWords<f64, N>> {
    let function = function?;
    let mut direction = [0.0; 6];
    for (to, &word) in direction.iter_mut().zip(u.high.iter().chain(u.low.iter())) {
        *to = word;
    }
    let mut point = [f64::NAN; 6];
    // SAFETY: the caller's promise.
    let code = unsafe { function(user, direction.as_ptr(), point.as_mut_ptr()) };
    let (high, low) = (point.iter(), point.iter().skip(N));
    let point = [Vector::from_iterator(high.take(N).copied()), Vector::from_iterator(low.take(N).copied())];
    (code == 0).then_some(TwoWords { high: point[0], low: point[1] })
}

/// Answers for a support point in two words, with the struct behind `user`.
///
/// # Safety
/// Each pointer that is not NULL is aligned and valid for a `S`, for 2 `N` numbers, and for writes of as many.
#[inline(always)]
pub(super) unsafe fn answer_precisely<S, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
    find: impl FnOnce(&S, &TwoWords<f64, N>) -> Option<TwoWords<f64, N>>,
) -> i32 {
    let found = || {
        // SAFETY: the caller's promise.
        let (shape, [high, low], room) = unsafe {
            let (shape, _, room) = arguments::<S, N>(user, direction, point).ok()?;
            (shape, direction.cast::<[[f64; N]; 2]>().read(), room.cast::<[[f64; N]; 2]>())
        };
        let found = find(shape, &TwoWords { high: Vector::from(high), low: Vector::from(low) })?;
        // SAFETY: `arguments` has checked it.
        unsafe { room.write([found.high.into(), found.low.into()]) };
        Some(())
    };
    i32::from(found().is_none())
}
