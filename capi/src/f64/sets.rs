//! CONVEX SETS
//!
//! A convex set is known by its support function: the point of the set that is farthest along a direction. A set is
//! given in two parts, core + radius * ball: the support function gives points of the core, and `radius` is
//! the radius of a ball swept over it. A sphere is a point with a radius, a capsule a segment with a radius, a safety margin
//! is a radius on anything. Write a support function for your own shapes; the built-in shapes are made of the same parts.

use super::*;

/// Writes a point of the core that is farthest along `direction` to `point`.
///
/// user: the pointer from the set. direction: as many numbers as the dimension; finite and not all zero, but
/// not necessarily of unit length. point: room for as many.
///
/// Returns 0, or a code of your own, which ends the query and comes back as `callback_code`. (Once there is an answer that rounding has left open, what was to make it
/// better ends, and the answer stands.) Not INT32_MIN to INT32_MIN + 3. The function must not unwind or longjmp, nor use the solver that is calling it. Where several
/// points are equally far, any of them.
pub type qdist_support_f64 =
    Option<unsafe extern "C" fn(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32>;

/// For sets that know themselves in twice the precision: writes a point of the core (with the ball of rolling_radius put on, where there is one) that is farthest
/// along a direction u. Both are exact sums of two vectors: u = direction[0 .. N - 1] + direction[N .. 2 N - 1], near unit length, and the point point[0 .. N - 1] + point[N .. 2 N - 1]. Coordinate i of
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
    /// How depth is found, as the function that has made the body says: boxes by their axes, cylinders and cones by arcs of minimisers around theirs, your
    /// own sets by expansion. (Boxes by what their function wrote: what is changed in their `set` afterwards, but for its radius, counts only beside other shapes.) A program does without the plans of shapes that it does not make.
    pub route: qdist_route,
    /// NULL; or the support function in twice the precision: shallow contact of such bodies is measured to the last digits. The body functions of all
    /// shapes, points and hulls put it here. Called with set.user.
    pub precise: qdist_precise_f64,
}
gaps!(qdist_body_f64, set.contains_origin..rotation, symmetry..unbounded, precise..);

impl qdist_set_f64 {
    /// What a set of the library states of itself; 0 would be "not known", so what is 0 is next to nothing.
    pub(super) fn stated_by<const N: usize>(set: &impl Support<f64, N>) -> Self {
        Self {
            radius: set.radius(),
            extent: set.extent().at_least(tiny()),
            error: set.error().at_least(tiny()),
            dimension: N as u32,
            contains_origin: set.contains_origin().into(),
            ..Self::ZERO
        }
    }

    /// Checks the numbers for dimension `n`.
    #[inline(always)]
    pub(super) fn check(&self, n: usize) -> Check {
        if self.support.is_none() {
            return Err(QDIST_ERROR_NULL);
        }
        lengths([self.radius, self.extent, self.error])?;
        flag(self.contains_origin)?;
        if self.dimension != 0 && self.dimension as usize != n { Err(QDIST_ERROR_DIMENSION) } else { Ok(()) }
    }

    /// A point of the core that is farthest along `u`, of as many numbers as `u`, written to `point`; or the callback's code.
    #[inline(always)]
    pub(super) fn ask(&self, u: &[f64], exhaustive: bool, point: &mut [f64]) -> i32 {
        let slow = if exhaustive { self.exhaustive } else { None };
        // SAFETY: the header: the functions of a set may be called with its `user`, in its dimension, which the caller has checked.
        unsafe { support(slow.or(self.support), self.user, u, point) }
    }

    /// The same in dimension `N`.
    #[inline(always)]
    pub(super) fn farthest<const N: usize>(
        &self,
        u: &Vector<f64, N>,
        exhaustive: bool,
    ) -> Result<Vector<f64, N>, Failure> {
        // A coordinate that the callback does not write stays NaN, and the query ends with that.
        let mut point = Vector::<f64, N>::from_element(f64::NAN);
        let code = self.ask(u.as_slice(), exhaustive, point.as_mut_slice());
        if code == 0 { Ok(one_by_one(&point)) } else { Err(Failure(code)) }
    }

    /// Does the set not change when these coordinates change sign?
    pub(super) fn is_mirrored(&self, signs: u8) -> bool {
        // SAFETY: the header: a mirror function may be called with `user` and any signs.
        unsafe { is_mirrored(self.mirrored, self.user, signs) }
    }

    /// Does the set state, or its mirror function show, that it contains the origin? As [`Support::contains_origin`].
    pub(super) fn knows_origin(&self, n: usize) -> bool {
        self.contains_origin == 1 || self.is_mirrored(u8::MAX >> (8 - n.clamp(1, 8)))
    }

    /// The rounding error that the set states, or the default in dimension `n`.
    pub(super) fn stated_error(&self, n: usize) -> f64 {
        if self.error > 0.0 { self.error } else { f64::count(16 * n) * f64::ROUNDOFF * self.extent }
    }
}

/// A set that has passed the checks, where it lies, as a [`Support`].
pub(super) struct CheckedSet<'a>(&'a qdist_set_f64);

impl<'a> CheckedSet<'a> {
    #[inline(always)]
    pub(super) fn new<const N: usize>(set: &'a qdist_set_f64) -> Check<Self> {
        set.check(N)?;
        Ok(Self(set))
    }
}

impl<const N: usize> Support<f64, N> for CheckedSet<'_> {
    #[inline]
    fn support(&self, u: &Vector<f64, N>) -> Result<Vector<f64, N>, Failure> {
        self.0.farthest(u, false)
    }
    fn exhaustive(&self, u: &Vector<f64, N>) -> Result<(Vector<f64, N>, Vector<f64, N>), Failure> {
        self.0.farthest(u, true).map(|p| (p, p))
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
        self.0.is_mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.0.knows_origin(N)
    }
    fn error(&self) -> f64 {
        self.0.stated_error(N)
    }
}

/// Makes a body of any set of dimension 3, in the identity pose. Checks and copies the set; what it points to must outlive the
/// body.
///
/// Status: those of a set (set).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_body_set_f64(body: Out<qdist_body_f64>, set: In<qdist_set_f64>) -> qdist_status {
    status(Placed::of_set(body, set))
}
