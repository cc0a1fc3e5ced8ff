//! Translational penetration depth of two bodies in space or in the plane: the query that collision code asks.
//!
//! The Minkowski difference M = A - B = { a - b } contains the origin exactly when the bodies overlap. Moving B by x turns M into
//! M - x, so the shortest x that separates them ends on the boundary of M:
//!
//! ```text
//! depth = min over unit u of h_M(u),     h_M(u) = h_A(u) + h_B(-u)
//! ```
//!
//! which is d_Q(M) for the unit ball Q; where the bodies are apart, the same minimum is minus their distance.
//! The minimiser u points from A to B. In the plane everything is the same, with polygons for polyhedra; only bodies that share an
//! axis of revolution, and the plan for them, are of space alone.

use core::fmt;

use crate::bounds::Axes;
use crate::math::load::one_by_one;
use crate::math::{Accumulator, Vector, finite, norm};
use crate::qset::Ball;
use crate::query::answer::{Answer, Outcome};
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::failure::{NOT_FINITE, TOO_LARGE};
use crate::support::{Failure, Measured, Support, Symmetry, is_worth_measuring, measuring_calls};
use nalgebra::SMatrix;

mod arcs;
mod ellipsoids;
mod fine;
pub(crate) mod half_space;
mod meridian;
mod sectors;

use arcs::NEARLY_COAXIAL;
pub use arcs::Turning;
use fine::{Fine, Recorder, fine_error};

/// A 3 x 3 matrix.
pub type Matrix3<T> = SMatrix<T, 3, 3>;
/// A 2 x 2 matrix.
pub type Matrix2<T> = SMatrix<T, 2, 2>;

/// Why a body cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum BodyError {
    /// A coordinate is NaN or infinite.
    NonFinite,
    /// The matrix is not a rotation: |R^T R - I| > 1e-4 in some entry, or det R < 0.
    Rotation,
}

impl fmt::Display for BodyError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NonFinite => "a coordinate of the body's pose is NaN or infinite",
            Self::Rotation => "the matrix of the body's pose is not a rotation to within 1e-4",
        })
    }
}

impl core::error::Error for BodyError {}

/// A set placed in the world, which is space or the plane (`N` = 2): x -> rotation x + translation. A rotation of the plane by
/// the angle of cosine c and sine s is the matrix (c, -s; s, c).
#[derive(Clone, Copy)]
pub struct Body<'a, T: Real, const N: usize = 3> {
    shape: &'a (dyn Support<T, N> + Sync),
    rotation: SMatrix<T, N, N>,
    translation: Vector<T, N>,
    /// Radius of the ball swept over the placed core.
    ball: T,
    /// Radius of the ball that goes into the support points instead: see `Support::rolling_radius`.
    inflation: T,
}

impl<T: Real, const N: usize> fmt::Debug for Body<'_, T, N> {
    /// Where the shape is placed; of the shape itself nothing but its support function is known.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let pose = (&self.rotation, &self.translation);
        f.debug_struct("Body").field("rotation", pose.0).field("translation", pose.1).finish_non_exhaustive()
    }
}

/// A matrix whose columns are orthonormal to so many roundoffs leaves balls what they are, but for an error.
const SKEW_ROUNDOFFS: usize = 32;

impl<'a, T: Real, const N: usize> Body<'a, T, N> {
    /// Places a shape, which may serve several threads at a time. The matrix is used as it is given: the body is the image of the shape, except that balls (spheres,
    /// the rounding of capsules, margins) stay balls.
    ///
    /// # Errors
    /// [`BodyError`], naming what is wrong.
    pub fn new(
        shape: &'a (dyn Support<T, N> + Sync),
        rotation: SMatrix<T, N, N>,
        translation: Vector<T, N>,
    ) -> Result<Self, BodyError> {
        const { assert!(N == 2 || N == 3, "bodies are of dimension 2 or 3") };
        if !finite(&translation) {
            return Err(BodyError::NonFinite);
        }
        let skew = skew(&rotation);
        if !(skew <= T::of(1e-4)) || !is_proper(&rotation) {
            let numbers = rotation.iter().all(|x| x.finite());
            return Err(if numbers { BodyError::Rotation } else { BodyError::NonFinite });
        }
        let mut body = Body { rotation, ..Body::at(shape, translation) };
        if skew > T::count(SKEW_ROUNDOFFS) * T::ROUNDOFF {
            body.inflation = shape.rolling_radius();
            body.ball -= body.inflation;
        }
        Ok(body)
    }

    /// Places a shape without turning it.
    pub fn at(shape: &'a (dyn Support<T, N> + Sync), translation: Vector<T, N>) -> Self {
        Body { shape, rotation: SMatrix::identity(), translation, ball: shape.radius(), inflation: T::zero() }
    }

    /// The same body, with its shape as it was measured.
    fn remade<'m>(&'m self, measured: Option<&'m Measured<'m, dyn Support<T, N> + Sync + 'm, T, N>>) -> Body<'m, T, N> {
        let shape = measured.map_or(self.shape, |measured| measured);
        Body { shape, ..*self }
    }

    /// Where the body's support points are measured from, in its own frame, and an upper bound of the core's distance
    /// from there: the shape's own word, else half the diagonal of the box that support calls along the axes draw around it.
    fn anchor(&self) -> Result<Anchor<T, N>, Failure> {
        let mut anchor = self.core_anchor()?;
        // What the shape says of itself, NaN refused. (Sums would hide a negative length; what else is infinite is found in them.)
        let zero = T::zero();
        let ball = (self.ball >= zero) & (self.ball <= T::HUGE) & (self.inflation >= zero);
        if !(ball & (anchor.extent >= zero) & (anchor.error >= zero)) {
            return Err(Failure(NOT_FINITE));
        }
        anchor.extent += self.inflation;
        anchor.error += self.ball_error();
        Ok(anchor)
    }

    /// What the ball that was split off a rounded shape is off. In the support points it is rounded. Left as it is, it stands for its image, whose height along a
    /// unit vector n is |R^T n| times the radius: with s the largest entry of R^T R - I, that is 1 up to N s / 2. (Measuring s costs 4 roundoffs.)
    fn ball_error(&self) -> T {
        let rolling = self.shape.rolling_radius();
        if self.inflation > T::zero() {
            T::count(8) * T::ROUNDOFF * self.inflation
        } else if rolling > T::zero() && !is_exact(&self.rotation) {
            (skew(&self.rotation) + T::count(4) * T::ROUNDOFF) * T::of(N as f64 * 0.505) * rolling
        } else {
            T::zero()
        }
    }

    fn core_anchor(&self) -> Result<Anchor<T, N>, Failure> {
        if let Some((center, extent)) = self.shape.center() {
            if !finite(&center) {
                return Err(Failure(NOT_FINITE));
            }
            return Ok(Anchor { center: Some(center), extent, error: self.shape.error(), calls: 0 });
        }
        let known = self.shape.extent();
        if known != T::zero() {
            return Ok(Anchor { center: None, extent: known, error: self.shape.error(), calls: 0 });
        }
        let extent = norm(&self.corner()?);
        // What `Support::error` would be, had the shape known its extent.
        let error = self.shape.error().at_least(T::count(16 * N) * T::ROUNDOFF * extent);
        Ok(Anchor { center: None, extent, error, calls: 2 * N as u32 })
    }

    /// The box that support calls along the axes draw around the core.
    fn corner(&self) -> Result<Vector<T, N>, Failure> {
        let mut corner = Vector::<T, N>::zeros();
        for i in 0..N {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, N>::zeros();
                axis[i] = sign;
                // Without shortcuts, which may fall short. Written so that NaN is kept.
                let reach = self.shape.exhaustive(&axis)?.0[i].abs();
                corner[i] = if reach < corner[i] { corner[i] } else { reach };
            }
        }
        Ok(corner)
    }

    /// The anchor in the world, computed as in twice the precision: the shape may be far from its frame, and the frame's position undo that.
    fn origin(&self, anchor: &Anchor<T, N>) -> Vector<T, N> {
        let Some(center) = &anchor.center else { return self.translation };
        Vector::from_fn(|i, _| {
            let mut sum = Accumulator::new(self.translation[i]);
            for j in 0..N {
                sum.add_product(self.rotation[(i, j)], center[j]);
            }
            sum.value()
        })
    }

    /// Extents and errors along the axes of the world.
    fn axes(&self, anchor: &Anchor<T, N>) -> Axes<T, N> {
        let (mut extents, mut errors) = (self.shape.extents(), self.shape.errors());
        if anchor.center.is_some() || !(self.shape.extent() > T::zero()) {
            extents = Vector::repeat(anchor.extent);
            errors = errors.map(|e| if self.shape.extent() > T::zero() { e } else { e.at_least(anchor.error) });
        }
        let reach = spread(&self.rotation, &extents.add_scalar(self.inflation));
        Axes { errors: spread(&self.rotation, &errors.add_scalar(self.ball_error())), reach }
    }

    /// The support point relative to the placed anchor.
    fn farthest(&self, u: &Vector<T, N>, anchor: &Anchor<T, N>, exhaustive: bool) -> Result<Vector<T, N>, Failure> {
        let local = self.rotation.tr_mul(u);
        let point =
            if exhaustive { self.shape.exhaustive(&local).map(|(point, _)| point) } else { self.shape.support(&local) };
        let point = match &point {
            Ok(point) => one_by_one(point),
            Err(failure) => return Err(*failure),
        };
        let point = match &anchor.center {
            Some(center) => point - center,
            None => point,
        };
        let point = if self.inflation > T::zero() {
            let swell = self.inflation / norm(&local);
            point + local * swell
        } else {
            point
        };
        Ok(turned(&self.rotation, &point))
    }
}

/// R x, the columns added from the first to the last.
#[inline(always)]
fn turned<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    let mut sum = rotation.column(0) * x[0];
    for j in 1..N {
        sum += rotation.column(j) * x[j];
    }
    sum
}

/// |R| x: how far a box of half lengths x reaches along the axes, when it is turned.
fn spread<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    let mut sum = Vector::zeros();
    for j in 0..N {
        sum += rotation.column(j).abs() * x[j];
    }
    sum
}

/// The largest entry of |R^T R - I|.
fn skew<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>) -> T {
    let mut most = T::zero();
    for i in 0..N {
        let column = rotation.column(i);
        most = most.at_least((column.dot(&column) - T::one()).abs());
        for j in i + 1..N {
            most = most.at_least(column.dot(&rotation.column(j)).abs());
        }
    }
    most
}

/// Are all entries 0, 1 or -1?
fn is_exact<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>) -> bool {
    rotation.iter().all(|x| x.is_zero() || x.abs() == T::one())
}

/// Does an almost orthonormal matrix of dimension 2 or 3 leave right what is right? (One with NaN in it does not.)
fn is_proper<T: Real, const N: usize>(matrix: &SMatrix<T, N, N>) -> bool {
    let minor = |i: usize, j: usize| matrix[(i, 0)] * matrix[(j, 1)] - matrix[(j, 0)] * matrix[(i, 1)];
    let determinant = if N == 2 {
        minor(0, 1)
    } else {
        minor(1, 2) * matrix[(0, 2)] + minor(2, 0) * matrix[(1, 2)] + minor(0, 1) * matrix[(2, 2)]
    };
    determinant > T::zero()
}

/// Where a body is measured from: the origin of its frame, or a point near the shape when that is far away.
struct Anchor<T: Real, const N: usize> {
    center: Option<Vector<T, N>>,
    extent: T,
    /// Error of the shape's support function.
    error: T,
    /// Calls of the support function that it took to find out.
    calls: u32,
}

/// A - B, with B's anchor taken relative to A's, so that the error grows neither with the bodies' distance
/// from the world's origin nor with that of their vertices from their frames'.
pub(crate) struct Pair<'p, 'a, T: Real, const N: usize> {
    a: &'p Body<'a, T, N>,
    b: &'p Body<'a, T, N>,
    on_a: Anchor<T, N>,
    on_b: Anchor<T, N>,
    /// A's anchor minus B's, in the world.
    offset: Vector<T, N>,
    extent: T,
    error: T,
    /// What the offset's own rounding and the axis that is used for both bodies add to it.
    extra: T,
}

impl<'p, 'a, T: Real, const N: usize> Pair<'p, 'a, T, N> {
    fn new(a: &'p Body<'a, T, N>, b: &'p Body<'a, T, N>) -> Result<Self, Failure> {
        if !finite(&a.translation) || !finite(&b.translation) {
            return Err(Failure(NOT_FINITE));
        }
        let (on_a, on_b) = (a.anchor()?, b.anchor()?);
        let (offset, left) = if on_a.center.is_none() && on_b.center.is_none() {
            (a.translation - b.translation, T::zero())
        } else {
            anchor_offset(a, &on_a, b, &on_b)
        };
        let cores = on_a.extent + on_b.extent;
        let apart = norm(&offset);
        // Stated for space; the plane needs less. Beside the shapes' own errors, for each core of extent E (unit roundoff u): the local direction is off by
        // at most 5.2 u, which costs that times the diameter 2 E; the anchor's subtraction u E; the product with the rotation 5.2 u E.
        // The two additions cost u times the sizes of their sums, the rounding of `offset` u of its own (2 u when
        // anchors are involved). A rotation that is off by 1e-4 stretches all of it by less than 1 %.
        let rounding = (cores * T::count(20) + apart * T::count(4)) * T::ROUNDOFF;
        let error = (on_a.error + on_b.error + rounding) * T::of(1.01) + left;
        let extent = cores * T::of(1.01) + apart;
        if !((extent < T::HUGE) & (error < T::HUGE)) {
            let said = [on_a.extent, on_a.error, on_b.extent, on_b.error].iter().all(|x| x.finite());
            return Err(Failure(if said { TOO_LARGE } else { NOT_FINITE }));
        }
        Ok(Pair { a, b, on_a, on_b, offset, extent, error, extra: left })
    }

    /// Adds to the error, in all directions; returns what it was.
    fn charge(&mut self, error: T) -> [T; 2] {
        let before = [self.error, self.extra];
        self.error += error;
        self.extra += error;
        before
    }

    /// Takes it away again.
    fn discharge(&mut self, before: [T; 2]) {
        [self.error, self.extra] = before;
    }

    /// The options, with the direction to look in first.
    #[inline(always)]
    fn aimed<'o>(&self, options: &Options<'o, T, N>) -> Options<'o, T, N> {
        let mut options = *options;
        if options.guess.is_none() && self.offset.iter().any(|&x| x != T::zero()) {
            options.guess = Some(-self.offset);
        }
        options
    }

    /// The error along a unit vector, as [`axes`](Self::axes) tells it.
    fn error_along(&self, n: &Vector<T, N>) -> T {
        let along = |body: &Body<'_, T, N>| {
            let seen = body.rotation.map(|x| x.abs()).tr_mul(&n.abs());
            seen.dot(&body.shape.errors()) + seen.dot(&body.shape.extents()) * (T::count(13) * T::ROUNDOFF)
        };
        along(self.a) + along(self.b) + self.offset.abs().dot(&n.abs()) * (T::count(4) * T::ROUNDOFF)
    }

    /// Is a height along this unit vector known much better than in any direction?
    fn is_finer_along(&self, n: &Vector<T, N>) -> bool {
        // (The first product says at once that the offset's own rounding leaves nothing to gain.)
        let aside = self.offset.dot(n).abs() * (T::count(16) * T::ROUNDOFF) < self.error;
        aside && self.error_along(n) * T::count(4) < self.error
    }

    /// Extents and errors along each axis of the world, with E_i = (|R| E)_i in the place of E: the local direction is off by 3 u (|R|^T |u|)_j, which
    /// costs that times 2 E_j, 6 u sum of |u_i| E_i together; the anchor's subtraction u, the product with the rotation 3 u, and the rest as in `new`.
    fn axes(&self) -> Axes<T, N> {
        let (a, b) = (self.a.axes(&self.on_a), self.b.axes(&self.on_b));
        let (spans, offsets) = (a.reach + b.reach, self.offset.abs());
        let rounding = (spans * T::count(13) + offsets * T::count(4)) * T::ROUNDOFF;
        let errors = ((a.errors + b.errors + rounding) * T::of(1.01)).add_scalar(self.extra);
        Axes { errors, reach: spans * T::of(1.01) + offsets }
    }

    /// Support calls of each body so far.
    fn calls(&self) -> u32 {
        self.on_a.calls.max(self.on_b.calls)
    }

    /// The query for the depth, after so many support calls. `set` is the pair, or stands for it.
    #[inline(always)]
    fn query<'q>(
        set: &'q dyn Support<T, N>,
        ball: &'q Ball<T>,
        calls: u32,
        options: &Options<'q, T, N>,
    ) -> (Query<'q, T, N>, Result<(), Failure>) {
        let (mut query, checked) = Query::new(set, ball, set.radius(), *options);
        query.rivals.sought = false;
        query.count_calls(calls);
        (query, checked)
    }

    fn sample(&self, u: &Vector<T, N>, exhaustive: bool) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let on_a = self.a.farthest(u, &self.on_a, exhaustive)?;
        let on_b = self.b.farthest(&-u, &self.on_b, exhaustive)?;
        Ok((on_a - on_b + self.offset, on_a))
    }
}

/// (t_a + R_a c_a) - (t_b + R_b c_b), computed as in twice the precision: the terms may be large and cancel. And a bound
/// of what that leaves beside the rounding of the result: u^2 times the terms, eight in each of at most three coordinates.
#[cold]
fn anchor_offset<T: Real, const N: usize>(
    a: &Body<'_, T, N>,
    on_a: &Anchor<T, N>,
    b: &Body<'_, T, N>,
    on_b: &Anchor<T, N>,
) -> (Vector<T, N>, T) {
    let mut offset = Vector::<T, N>::zeros();
    let far = |anchor: &Anchor<T, N>| anchor.center.map_or(T::zero(), |center| norm(&center));
    let terms = norm(&a.translation) + norm(&b.translation) + far(on_a) + far(on_b);
    for i in 0..N {
        let mut sum = Accumulator::new(a.translation[i]);
        sum.add(-b.translation[i]);
        for (body, anchor, sign) in [(a, on_a, T::one()), (b, on_b, -T::one())] {
            if let Some(center) = &anchor.center {
                for j in 0..N {
                    sum.add_product(body.rotation[(i, j)], sign * center[j]);
                }
            }
        }
        offset[i] = sum.value();
    }
    (offset, terms * T::count(256) * T::ROUNDOFF * T::ROUNDOFF)
}

/// Lengths that an axis may be off, in roundoffs of the bodies' extents: what poses computed from one another are.
const AXIS_ROUNDOFFS: usize = 64;

/// The axis of two bodies of revolution, or of one and a ball.
#[derive(Clone, Copy)]
pub(crate) struct Axis<T: Real> {
    /// A unit vector along the first body's.
    along: Vector<T, 3>,
    /// How far the second axis, or the second body's anchor, is off the first: the angle, plus the length as a share of the extents.
    aside: T,
    /// How far the matrices are from rotations.
    stretched: T,
}

impl<T: Real> Axis<T> {
    /// Is it theirs up to rounding?
    fn is_common(&self) -> bool {
        self.aside <= T::count(AXIS_ROUNDOFFS) * T::ROUNDOFF
    }

    /// Is this direction the axis', or nearly so? Else the minimisers are a circle around it.
    fn has_pole(&self, direction: &Vector<T, 3>) -> bool {
        !(direction.dot(&self.along).abs() < T::of(0.99))
    }
}

impl<T: Real> Pair<'_, '_, T, 3> {
    /// The axis that both bodies turn about, up to rounding or up to `near`.
    fn axis(&self, near: T) -> Option<Axis<T>> {
        let axis = |body: &Body<'_, T>| body.rotation.column(2).into_owned();
        let (first, second) = match (self.a.shape.symmetry(), self.b.shape.symmetry()) {
            (Symmetry::Axis, Symmetry::Axis) => (axis(self.a), axis(self.b)),
            (Symmetry::Axis, Symmetry::Full) => (axis(self.a), axis(self.a)),
            (Symmetry::Full, Symmetry::Axis) => (axis(self.b), axis(self.b)),
            _ => return None,
        };
        let aside = norm(&first.cross(&second)) + norm(&first.cross(&self.offset)) / self.extent;
        let roundoff = T::count(AXIS_ROUNDOFFS) * T::ROUNDOFF;
        if !(aside <= roundoff.at_least(near)) || self.on_a.center.is_some() || self.on_b.center.is_some() {
            return None;
        }
        let stretched = skew(&self.a.rotation).at_least(skew(&self.b.rotation));
        (stretched <= roundoff).then(|| Axis { along: first * (T::one() / norm(&first)), aside, stretched })
    }
}

impl<T: Real, const N: usize> Support<T, N> for Pair<'_, '_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.sample(u, false)?.0)
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, false)
    }
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u, true)
    }
    fn has_shortcuts(&self) -> bool {
        self.a.shape.has_shortcuts() || self.b.shape.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.a.ball + self.b.ball
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error
    }
    fn extents(&self) -> Vector<T, N> {
        self.axes().reach
    }
    fn errors(&self) -> Vector<T, N> {
        self.axes().errors
    }
}

/// The penetration of two bodies, or their distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Depth<T, const N: usize = 3> {
    /// What was concluded.
    pub outcome: Outcome,
    /// The signed depth is not less. Positive: penetration; negative: minus the distance.
    pub lower: T,
    /// The signed depth is not more.
    pub upper: T,
    /// Unit vector from A to B, which proves `upper`: after moving B by `upper * normal` the bodies do not overlap.
    pub normal: Vector<T, N>,
    /// Witness on A, world frame.
    pub point_a: Vector<T, N>,
    /// Witness on B, world frame. Where converged, `point_a - point_b` is depth * normal: in length up to the tolerance, sideways up
    /// to a few times its square root. The points that touch after B is moved, or the nearest points of separated bodies.
    pub point_b: Vector<T, N>,
    /// Affine dimension of the cores' difference, as far as it was found out.
    pub dimension: usize,
    /// Steps of all plans: directions along which A - B was asked for one point more to go on with.
    pub iterations: u32,
    /// Calls of the support function of the body that was asked more often: of both, unless one alone had to be measured because it does not
    /// know its extent.
    pub support_calls: u32,
    /// Vertices used.
    pub vertices: usize,
    /// Facets used at one time.
    pub facets: usize,
    /// Why a set gave no point, with outcome `SupportFailed`.
    pub failure: Option<Failure>,
}

impl<T: Real> Solver<'_, T, 3> {
    /// Translational penetration depth of two bodies, or their distance, as a bracket with witness points.
    ///
    /// Swapping the bodies turns the normal and swaps the witnesses. Balls (spheres, capsules, margins) are exact. Against a
    /// [half space](crate::support::HalfSpace) the answer is a closed form, and the solver is not used.
    /// `options.guess` is a direction from A to B to look in first; without one, that of the bodies' positions.
    pub fn depth(&mut self, a: &Body<'_, T>, b: &Body<'_, T>, options: &Options<'_, T, 3>) -> Depth<T> {
        if let Some(depth) = unbounded(a, b, options) {
            return depth;
        }
        let mut pair = match Pair::new(a, b) {
            Ok(pair) => pair,
            Err(failure) => return Depth::failed(failure),
        };
        let mut calls = pair.calls();
        let axis = pair.axis(options.relative * T::of(NEARLY_COAXIAL));
        if let Some(axis) = axis.filter(Axis::is_common)
            && let Some(answer) = self.depth_on_axis(&mut pair, &axis, &mut calls, options)
        {
            // (What a plane of one word leaves open in shallow contact, expansion in two may close: at a pole, where no circle is to be tiled.)
            return if is_shallow(&answer) && axis.has_pole(&answer.direction) {
                self.conclude_pair(&pair, &answer, &pair.aimed(options))
            } else {
                Depth::new(&answer, &pair)
            };
        }
        match a.shape.turning().or(b.shape.turning()) {
            Some(turning) => (turning.depth)(self, &mut pair, axis, calls, options),
            None => self.expand_pair(&pair, calls, options),
        }
    }

    /// The answer in a plane of the axis, as if both bodies turned about it: what they are off goes into the error. Adds to the support calls.
    fn depth_on_axis(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        axis: &Axis<T>,
        calls: &mut u32,
        options: &Options<'_, T, 3>,
    ) -> Option<Answer<T, 3>> {
        // Putting the second body on the axis moves its points by at most `aside` times the extents, making both matrices rotations by 1.5
        // `stretched` times those. What is asked in one plane is moved once, and once more where it stands for another plane: twice the sum.
        // The roundoffs are those of measuring it.
        let moved = axis.aside + axis.stretched + axis.stretched + T::count(4) * T::ROUNDOFF;
        let before = pair.charge(moved * T::of(2.1) * pair.extent);
        let ball = Ball::unit();
        let (mut query, checked) = Query::new(&*pair, &ball, pair.radius(), *options);
        query.count_calls(*calls);
        let ready = checked.and_then(|()| query.normalize()).is_ok();
        let answer = if ready { self.solve_meridian(&mut query, &axis.along) } else { None };
        *calls = query.support_calls();
        pair.discharge(before);
        answer
    }
}

impl<T: Real> Solver<'_, T, 2> {
    /// Translational penetration depth of two bodies in the plane, or their distance, as a bracket with witness points.
    ///
    /// Everything is as in space, with polygons for polyhedra: discs are [`Sphere`](crate::support::Sphere)s, and
    /// what else is generic over the dimension serves. For polygons of m and n vertices, m + n vertices and as many facets suffice.
    ///
    /// ```
    /// use nalgebra::Matrix2;
    /// use qdist::{Body, Options, Vector, Workspace, support::{BoxShape, Sphere}};
    /// let door = BoxShape::new(Vector::from([1.0, 0.125])).unwrap();
    /// let ball = Sphere::new(0.5).unwrap();
    /// let (c, s) = (0.8, 0.6);
    /// let a = Body::new(&door, Matrix2::new(c, -s, s, c), Vector::from([1.0, 2.0])).unwrap();
    /// // Half a unit from the middle of the door's long side, which is 1/8 thick.
    /// let b = Body::at(&ball, Vector::from([1.0 - 0.6 * 0.5, 2.0 + 0.8 * 0.5]));
    /// let mut memory = Workspace::<f64, 2, 8, 8>::new();
    /// let depth = memory.solver().depth(&a, &b, &Options::default());
    /// assert!((depth.upper - 0.125).abs() < 1e-6 && depth.lower <= depth.upper);
    /// assert!((depth.normal - Vector::from([-0.6, 0.8])).amax() < 1e-6);
    /// ```
    pub fn depth(&mut self, a: &Body<'_, T, 2>, b: &Body<'_, T, 2>, options: &Options<'_, T, 2>) -> Depth<T, 2> {
        if let Some(depth) = unbounded(a, b, options) {
            return depth;
        }
        match Pair::new(a, b) {
            Ok(pair) => self.expand_pair(&pair, pair.calls(), options),
            Err(failure) => Depth::failed(failure),
        }
    }
}

/// The answer of a body without end, which needs no solver.
#[doc(hidden)]
pub fn unbounded<T: Real, const N: usize>(
    a: &Body<'_, T, N>,
    b: &Body<'_, T, N>,
    options: &Options<'_, T, N>,
) -> Option<Depth<T, N>> {
    if let Some(half_space) = b.shape.unbounded() {
        return Some(half_space.depth(b, a, false, options));
    }
    a.shape.unbounded().map(|half_space| half_space.depth(a, b, true, options))
}

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The depth of a pair by expansion, or by distance where that decides, after so many support calls.
    fn expand_pair(&mut self, pair: &Pair<'_, '_, T, N>, calls: u32, options: &Options<'_, T, N>) -> Depth<T, N> {
        let options = pair.aimed(options);
        let answer = self.expand_once(pair, calls, &options);
        self.conclude_pair(pair, &answer, &options)
    }

    /// The answer of a first look. (Its query leaves the stack before a second one begins.)
    #[inline(never)]
    fn expand_once(&mut self, pair: &Pair<'_, '_, T, N>, calls: u32, options: &Options<'_, T, N>) -> Answer<T, N> {
        let ball = Ball::unit();
        let (mut query, checked) = Pair::query(pair, &ball, calls, options);
        match checked.and_then(|()| query.normalize()) {
            Ok(()) => self.expand_apart(&mut query),
            Err(failure) => self.give_up(&mut query, failure),
        }
    }

    /// Expansion for a first and a second look, with a place on the stack of its own.
    #[inline(never)]
    fn expand_apart(&mut self, query: &mut Query<'_, T, N>) -> Answer<T, N> {
        self.expand_ready(query)
    }

    /// The answer, or that of a second look where it is open.
    #[inline(always)]
    fn conclude_pair(
        &mut self,
        pair: &Pair<'_, '_, T, N>,
        answer: &Answer<T, N>,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N> {
        if !answer.outcome.is_open() {
            return Depth::new(answer, pair);
        }
        let second = self.look_again_at_pair(pair, answer, options);
        Depth::new(second.as_ref().unwrap_or(answer), pair)
    }

    /// A second look (module `second_look`), at each body by itself.
    #[cold]
    #[inline(never)]
    fn look_again_at_pair(
        &mut self,
        pair: &Pair<'_, '_, T, N>,
        answer: &Answer<T, N>,
        options: &Options<'_, T, N>,
    ) -> Option<Answer<T, N>> {
        let asks = [pair.a, pair.b].map(|body| is_worth_measuring(body.shape, T::zero()));
        let finer = answer.outcome == Outcome::Degenerate || pair.is_finer_along(&answer.direction);
        // (A normal in one word proves an upper bound to half a roundoff of the bodies' size: where that is too much, two do not help. Nor do they where what
        // two words leave open is.)
        let width = options.absolute.at_least(options.relative * answer.upper);
        let tellable = width >= pair.extent * (T::of(0.25) * T::ROUNDOFF) && width > fine_error(pair) * T::count(4);
        let shallow = tellable && is_shallow(answer) && Recorder::suits(pair);
        if !finer && !shallow && asks == [false; 2] {
            return None;
        }
        let (ball, options) = (Ball::unit(), &options.after(answer.iterations)?);
        let [a, b] = [(pair.a, asks[0]), (pair.b, asks[1])]
            .map(|(body, asks)| if asks { Measured::new(body.shape) } else { None });
        let measured = a.is_some() || b.is_some();
        let asked = asks.map(|asks| if asks { measuring_calls::<N>() } else { 0 });
        // Those of the body that was asked more often: the query's, which are both bodies', and those that measured it.
        let both = answer.support_calls.saturating_sub(pair.calls());
        let measuring = [pair.on_a.calls + asked[0], pair.on_b.calls + asked[1]];
        let total = |more: [u32; 2]| both.saturating_add((measuring[0] + more[0]).max(measuring[1] + more[1]));
        if !finer && !shallow && !measured {
            return Some(Answer { support_calls: total([0, 0]), ..answer.clone() });
        }
        let (a, b) = (pair.a.remade(a.as_ref()), pair.b.remade(b.as_ref()));
        let sharper = Pair::new(&a, &b).ok()?;
        let calls = total([sharper.on_a.calls, sharper.on_b.calls]);
        let recorder = (shallow && Recorder::suits(&sharper)).then(|| Recorder::new(&sharper));
        let set: &dyn Support<T, N> = recorder.as_ref().map_or(&sharper, |recorder| recorder);
        let (mut query, checked) = Pair::query(set, &ball, calls, options);
        let mut ready = (finer || measured) && self.sharpen(&mut query, checked, &answer.direction, measured);
        if !ready && recorder.is_some() {
            let checked;
            (query, checked) = Pair::query(set, &ball, calls, options);
            ready = checked.and_then(|()| query.normalize()).is_ok();
        }
        if !ready {
            return Some(Answer { support_calls: calls, ..answer.clone() });
        }
        let mut second = self.expand_apart(&mut query);
        match &recorder {
            // (A body that does not tell a point in two words after all has not failed: the first answer stands.)
            Some(_) if second.failure.is_some() => {
                return Some(Answer { support_calls: second.support_calls, ..answer.clone() });
            }
            Some(recorder) if is_shallow(&second) => {
                Fine::new(&mut self.polytope, &mut query, recorder).refine(&mut second);
            }
            _ => {}
        }
        Some(second.or_wider(answer))
    }
}

/// Was rounding the end of a query of bodies that overlap for certain?
fn is_shallow<T: Real, const N: usize>(answer: &Answer<T, N>) -> bool {
    answer.outcome == Outcome::Precision && answer.lower > T::zero()
}

impl<T: Real, const N: usize> Depth<T, N> {
    fn new(answer: &Answer<T, N>, pair: &Pair<'_, '_, T, N>) -> Self {
        let n = answer.direction;
        let (a, b) = (pair.a, pair.b);
        let origin = a.origin(&pair.on_a);
        // b = a - (a - b), both from A's anchor.
        let on_a = answer.witness.witness();
        let on_b = on_a - answer.witness.point();
        Depth {
            outcome: answer.outcome,
            lower: answer.lower,
            upper: answer.upper,
            normal: n,
            point_a: origin + on_a + n * a.ball,
            point_b: origin + on_b - n * b.ball,
            dimension: answer.dimension,
            iterations: answer.iterations,
            support_calls: answer.support_calls,
            vertices: answer.vertices,
            facets: answer.facets,
            failure: answer.failure,
        }
    }

    /// The same in `f64`, to the last bit.
    #[must_use]
    pub fn to_f64(&self) -> Depth<f64, N> {
        Depth {
            outcome: self.outcome,
            lower: self.lower.to_f64(),
            upper: self.upper.to_f64(),
            normal: self.normal.map(T::to_f64),
            point_a: self.point_a.map(T::to_f64),
            point_b: self.point_b.map(T::to_f64),
            dimension: self.dimension,
            iterations: self.iterations,
            support_calls: self.support_calls,
            vertices: self.vertices,
            facets: self.facets,
            failure: self.failure,
        }
    }

    fn failed(failure: Failure) -> Self {
        Depth { outcome: Outcome::SupportFailed, failure: Some(failure), ..Depth::unknown() }
    }

    /// Nothing is known.
    fn unknown() -> Self {
        Depth {
            outcome: Outcome::Interrupted,
            lower: -T::HUGE,
            upper: T::HUGE,
            normal: Vector::zeros(),
            point_a: Vector::zeros(),
            point_b: Vector::zeros(),
            dimension: 0,
            iterations: 0,
            support_calls: 0,
            vertices: 0,
            facets: 0,
            failure: None,
        }
    }
}
