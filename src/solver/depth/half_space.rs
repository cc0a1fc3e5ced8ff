//! Half spaces as bodies: the ground, a wall, a joint limit; in the plane, half planes.
//!
//! A half space H = { x : n.x <= c } has no end, so it has no support mapping, and nothing can be expanded. But M = A - H has a finite
//! height along one direction only, and there the depth is the height:
//!
//! ```text
//! depth = min over u of h_A(u) + h_H(-u) = h_A(-n/|n|) + c/|n|
//! ```
//!
//! One call of A's support function answers, whatever A is (after those that measure A, where it does not state its extent); A's
//! ball term is added as it is.
//!
//! # Rounding
//!
//! In the world, the height of A's point p over the plane is w.(R p + t - s) - c with w = S n, where (R, t) is the pose of A and (S, s) that of H.
//! Its terms may be large and cancel: a foot on the ground, ten kilometres from the origin. So all sums of products carry
//! their rounding along ([`Accumulator`]), and w and R p + t - s are kept as the sum of two numbers. What is left is u^2 times the
//! terms, and a few roundoffs of the depth itself.
//!
//! The direction that A is asked along, v = -R^T w, is known up to its own rounding g as well. The true height along v is at most that
//! of p, plus A's error e |v|, plus |g| times A's diameter. Where both poses are turned by multiples of 90 degrees, and the ground usually
//! is, g is 0.
//!
//! # What a rotation that is none means
//!
//! Matrices are used as they are given: y belongs to the placed half space when n.S^T (y - s) <= c. For a rotation that is the image of H.
//!
//! # Two half spaces
//!
//! overlap without end, and no translation separates them, unless their normals are exactly opposite: d is infinite, and the outcome
//! [`Unbounded`](Outcome::Unbounded). Opposite normals (a floor and a ceiling) leave c_a/|n_a| + c_b/|n_b| between positions. Normals of turned
//! bodies are known up to rounding: where that does not tell, the lower bound is of the case that they are opposite, and there
//! is no upper bound.

use super::answer::Depth;
use super::body::{Body, is_exact};
use crate::bounds::{Bracket, Tolerance};
use crate::math::{Accumulator, Vector, finite, largest, norm};
use crate::query::Options;
use crate::query::answer::{Outcome, Stop};
use crate::scalar::Real;
use crate::support::failure::{NOT_FINITE, TOO_LARGE, UNBOUNDED};
use crate::support::range::check_numbers;
use crate::support::{Failure, ShapeError, Support};
use nalgebra::SMatrix;

/// The half space { x : normal.x <= offset }; in the plane, a half plane. The normal points out of it.
///
/// A body for [`Solver::depth`](crate::Solver::depth), against compact bodies and other half spaces. It is the exception among sets: it has no end
/// and so no farthest points. In any other place (a sum, a join, a query of one set) its support function fails with code
/// [`UNBOUNDED`]. Bullet calls it a static plane shape, FCL a half space, most engines a plane.
///
/// ```
/// use qdist::{Body, Options, Vector, Workspace, support::{BoxShape, HalfSpace}};
/// let ground = HalfSpace::new(Vector::from([0.0, 0.0, 1.0]), 0.0).unwrap();
/// let cube = BoxShape::new(Vector::from([0.5, 0.5, 0.5])).unwrap();
/// let (ground, cube) = (Body::at(&ground, Vector::zeros()), Body::at(&cube, Vector::from([4.0, 2.0, 0.375])));
/// let mut memory = Workspace::<f64, 3, 4, 6>::new();
/// let depth = memory.solver().depth(&ground, &cube, &Options::default());
/// assert!(depth.lower <= 0.125 && 0.125 <= depth.upper);
/// assert_eq!(depth.normal, Vector::from([0.0, 0.0, 1.0]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace<T, const N: usize> {
    /// Scaled by a power of two: its largest coordinate is 1 to 2.
    normal: Vector<T, N>,
    offset: T,
}

impl<T: Real, const N: usize> HalfSpace<T, N> {
    /// { x : normal.x <= offset }, for a normal of any length.
    ///
    /// # Errors
    /// [`ShapeError::NonFinite`], also where offset / |normal| is too large; [`ShapeError::Direction`] when the normal is zero.
    pub fn new(normal: Vector<T, N>, offset: T) -> Result<Self, ShapeError> {
        check_numbers(normal.iter())?;
        check_numbers(core::iter::once(&offset))?;
        let size = largest(&normal);
        if size.is_zero() {
            return Err(ShapeError::Direction);
        }
        // Below the normal numbers a power of two is not had from the exponent; all is lifted first, which is exact.
        let lift = if size < T::TINY { T::one() / T::ROUNDOFF } else { T::one() };
        let (normal, offset, size) = (normal * lift, offset * lift, size * lift);
        let power = size.power_of_two();
        let half_space = HalfSpace { normal: normal / power, offset: offset / power };
        check_numbers(core::iter::once(&half_space.offset))?;
        Ok(half_space)
    }
}

impl<T: Real, const N: usize> Support<T, N> for HalfSpace<T, N> {
    /// Fails: there is no farthest point.
    fn support(&self, _: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Err(Failure(UNBOUNDED))
    }
    fn unbounded(&self) -> Option<&dyn Unbounded<T, N>> {
        Some(self)
    }
}

/// A set without end, with an answer of its own.
pub trait Unbounded<T: Real, const N: usize> {
    /// Normal and offset.
    fn plane(&self) -> (&Vector<T, N>, T);

    /// The depth of this set, placed like `own`, and of `other`; `first`: this is A.
    fn depth(
        &self,
        own: &Body<'_, T, N>,
        other: &Body<'_, T, N>,
        first: bool,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N>;
}

impl<T: Real, const N: usize> Unbounded<T, N> for HalfSpace<T, N> {
    fn plane(&self) -> (&Vector<T, N>, T) {
        (&self.normal, self.offset)
    }

    fn depth(
        &self,
        own: &Body<'_, T, N>,
        other: &Body<'_, T, N>,
        first: bool,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N> {
        if !finite(&own.translation) || !finite(&other.translation) {
            return Depth::failed(Failure(NOT_FINITE));
        }
        let plane = Plane::new(self, own);
        let found = match other.shape.unbounded() {
            None => plane.overlap(other),
            Some(wall) => Ok(plane.facing(&Plane::new(wall, other))),
        };
        match found {
            Ok(found) if found.is_sound() => found.conclude(first, options),
            Ok(_) => Depth::failed(Failure(TOO_LARGE)),
            Err(failure) => Depth::failed(failure),
        }
    }
}

/// A vector as the sum of two numbers in each coordinate: as in twice the precision.
struct Twofold<T: Real, const N: usize> {
    high: Vector<T, N>,
    low: Vector<T, N>,
}

impl<T: Real, const N: usize> Twofold<T, N> {
    fn of(coordinate: impl Fn(usize) -> Accumulator<T>) -> Self {
        let mut sum = Twofold { high: Vector::zeros(), low: Vector::zeros() };
        for i in 0..N {
            (sum.high[i], sum.low[i]) = coordinate(i).parts();
        }
        sum
    }
}

/// A half space in the world.
struct Plane<'b, 'a, T: Real, const N: usize> {
    body: &'b Body<'a, T, N>,
    /// In its own frame.
    local: Vector<T, N>,
    offset: T,
    normal: Twofold<T, N>,
    /// The sums of the absolute values that `normal` is made of: no less than its coordinates' sizes.
    weights: Vector<T, N>,
    /// |normal|.
    length: T,
}

/// What was found: A against B where B is the half space.
struct Found<T: Real, const N: usize> {
    bracket: Bracket<T>,
    /// Unit vector from A into the half space.
    normal: Vector<T, N>,
    on_a: Vector<T, N>,
    on_b: Vector<T, N>,
    calls: u32,
    outcome: Option<Outcome>,
}

/// A bound of what sums in twice the precision leave, in u^2 of the terms' sizes: up to eight in each coordinate of a point and three in that
/// of a normal, products of the parts, and seven in the end: 64 + 9 + 16 + 64 by the bound n^2 u^2 of Ogita, Rump & Oishi,
/// and room for second order.
const TWOFOLD_ROUNDOFFS: usize = 256;

impl<'b, 'a, T: Real, const N: usize> Plane<'b, 'a, T, N> {
    fn new(half_space: &dyn Unbounded<T, N>, body: &'b Body<'a, T, N>) -> Self {
        let (&local, offset) = half_space.plane();
        let normal = Twofold::of(|i| {
            let mut sum = Accumulator::new(T::zero());
            (0..N).for_each(|j| sum.add_product(body.rotation[(i, j)], local[j]));
            sum
        });
        let weights = sizes(&body.rotation, &local);
        let length = norm(&normal.high);
        Plane { body, local, offset, normal, weights, length }
    }

    /// c - w.y for a point y relative to the half space's frame, and a bound of its error; `sizes` bound the terms of y's coordinates.
    fn height(&self, y: &Twofold<T, N>, sizes: &Vector<T, N>) -> (T, T) {
        let w = &self.normal;
        let mut sum = Accumulator::new(self.offset);
        for i in 0..N {
            sum.add_product(-w.high[i], y.high[i]);
            sum.add(-(w.high[i] * y.low[i] + w.low[i] * y.high[i]));
        }
        let terms = self.offset.abs() + self.weights.dot(sizes);
        (sum.value(), T::count(TWOFOLD_ROUNDOFFS) * (T::ROUNDOFF * T::ROUNDOFF * terms + T::TINY))
    }

    /// Half the roundings of a quotient by |w|, a sum with a radius, and of a normal that is not quite a unit vector: in roundoffs of both.
    fn slack(parts: T) -> T {
        T::count(N + 8) * T::ROUNDOFF * parts
    }

    /// The depth of a compact body in the half space.
    fn overlap(&self, a: &Body<'_, T, N>) -> Result<Found<T, N>, Failure> {
        let anchor = a.anchor()?;
        let sane = [anchor.extent, anchor.error, a.ball].iter().all(|x| x.finite() && *x >= T::zero());
        if !sane {
            return Err(Failure(NOT_FINITE));
        }
        let (direction, astray) = self.downward(&a.rotation);
        let point =
            if a.shape.has_shortcuts() { a.shape.exhaustive(&direction)?.0 } else { a.shape.support(&direction)? };
        if !finite(&point) {
            return Err(Failure(NOT_FINITE));
        }
        let swell = direction * (a.inflation / norm(&direction));
        let relative = |frame: &Vector<T, N>| {
            Twofold::of(|i| {
                let mut sum = Accumulator::new(a.translation[i]);
                sum.add(-frame[i]);
                for j in 0..N {
                    sum.add_product(a.rotation[(i, j)], point[j]);
                    sum.add_product(a.rotation[(i, j)], swell[j]);
                }
                sum
            })
        };
        let sizes =
            sizes(&a.rotation, &(point.abs() + swell.abs())) + a.translation.abs() + self.body.translation.abs();
        let (height, lost) = self.height(&relative(&self.body.translation), &sizes);
        let inverse = T::one() / self.length;
        let core = height * inverse;
        let depth = core + a.ball;
        // Both ways: the sums, the point's distance from A, and the quotient. Upwards: what A reaches beyond the point.
        let along = norm(&direction) * T::of(1.01);
        let off = lost + anchor.error * along;
        let beyond = anchor.error * along + astray * (anchor.extent + anchor.error) * T::count(2);
        let slack = Self::slack(core.abs() + depth.abs());
        let bracket = Bracket {
            lower: depth - (off * inverse * T::of(1.01) + slack),
            upper: depth + ((lost + beyond) * inverse * T::of(1.01) + slack),
        };
        let normal = -self.normal.high * inverse;
        let on_a = relative(&Vector::zeros()).high + normal * a.ball;
        Ok(Found { bracket, normal, on_a, on_b: on_a - normal * depth, calls: 1 + anchor.calls, outcome: None })
    }

    /// The direction into the half space in the frame of a body, -R^T w, and a bound of how far it is off.
    fn downward(&self, rotation: &SMatrix<T, N, N>) -> (Vector<T, N>, T) {
        let w = &self.normal;
        let v = Twofold::of(|j| {
            let mut sum = Accumulator::new(T::zero());
            for i in 0..N {
                sum.add_product(-rotation[(i, j)], w.high[i]);
                sum.add(-rotation[(i, j)] * w.low[i]);
            }
            sum
        });
        let lost = T::count(TWOFOLD_ROUNDOFFS) * (T::ROUNDOFF * T::ROUNDOFF * self.length + T::TINY);
        (v.high, norm(&v.low) * T::of(1.01) + lost)
    }

    /// The depth of two half spaces, the other one as A.
    fn facing(&self, a: &Self) -> Found<T, N> {
        let inverse = T::one() / a.length;
        let normal = a.normal.high * inverse;
        let foot = a.body.translation + normal * (a.offset * inverse);
        match self.is_opposite(a) {
            Some(false) => {
                let on_b = self.body.translation + self.normal.high * (self.offset / self.length / self.length);
                let bracket = Bracket { lower: T::HUGE, upper: T::HUGE };
                Found { bracket, normal, on_a: foot, on_b, calls: 0, outcome: Some(Outcome::Unbounded) }
            }
            told => {
                // A's normal is along -w: its offset and the way between the frames count along it.
                let way = Twofold::of(|i| {
                    let mut sum = Accumulator::new(self.body.translation[i]);
                    sum.add(-a.body.translation[i]);
                    sum
                });
                let sizes = self.body.translation.abs() + a.body.translation.abs();
                let (height, lost) = a.height(&way, &sizes);
                let (first, second) = (height * inverse, self.offset / self.length);
                let depth = first + second;
                let slack = lost * inverse * T::of(1.01) + Self::slack(first.abs() + second.abs() + depth.abs());
                let upper = if told.is_some() { depth + slack } else { T::HUGE };
                let bracket = Bracket { lower: depth - slack, upper };
                Found { bracket, normal, on_a: foot, on_b: foot - normal * depth, calls: 0, outcome: None }
            }
        }
    }

    /// Are the normals exactly opposite? `None` where rounding does not tell.
    fn is_opposite(&self, other: &Self) -> Option<bool> {
        let (r, s) = (&self.body.rotation, &other.body.rotation);
        // Turned alike, or by exact quarter turns: no rounding.
        if r == s {
            return Some(self.local.dot(&other.local) < T::zero() && is_parallel(&self.local, &other.local));
        }
        let (n, m) = (&self.normal.high, &other.normal.high);
        if is_exact(r) && is_exact(s) {
            return Some(n.dot(m) < T::zero() && is_parallel(n, m));
        }
        let mut across = T::zero();
        for i in 0..N {
            for j in 0..i {
                across = across.at_least((n[i] * m[j] - n[j] * m[i]).abs());
            }
        }
        let rounding = T::count(8) * T::ROUNDOFF * self.length * other.length;
        (n.dot(m) > T::zero() || across > rounding).then_some(false)
    }
}

/// |R| |x|, coordinate by coordinate: what the terms of R x add up to in size.
fn sizes<T: Real, const N: usize>(rotation: &SMatrix<T, N, N>, x: &Vector<T, N>) -> Vector<T, N> {
    rotation.abs() * x.abs()
}

/// Are two vectors parallel, exactly?
fn is_parallel<T: Real, const N: usize>(n: &Vector<T, N>, m: &Vector<T, N>) -> bool {
    let product = |x: T, y: T| {
        let mut sum = Accumulator::new(T::zero());
        sum.add_product(x, y);
        sum.parts()
    };
    let mut parallel = true;
    for i in 0..N {
        for j in 0..i {
            parallel &= product(n[i], m[j]) == product(n[j], m[i]);
        }
    }
    parallel
}

impl<T: Real, const N: usize> Found<T, N> {
    /// Did no product overflow?
    fn is_sound(&self) -> bool {
        let (lower, upper) = (self.bracket.lower, self.bracket.upper);
        lower.finite() && upper.finite() && [&self.normal, &self.on_a, &self.on_b].iter().all(|v| finite(v))
    }

    /// The answer for A and the half space, or the other way round.
    fn conclude(self, half_space_first: bool, options: &Options<'_, T, N>) -> Depth<T, N> {
        let Bracket { lower, upper } = self.bracket;
        let met =
            upper < T::HUGE && Tolerance { absolute: options.absolute, relative: options.relative }.met(&self.bracket);
        let stop = match options.threshold {
            Some(threshold) if lower >= threshold => Stop::Above,
            Some(threshold) if upper < threshold => Stop::Below,
            _ => Stop::Met,
        };
        let outcome = match (stop, self.outcome) {
            (Stop::Met, Some(outcome)) => outcome,
            // The bracket is always as narrow as arithmetic allows.
            _ => stop.outcome(lower, upper, met, lower <= T::zero() && upper < T::HUGE),
        };
        let (normal, point_a, point_b) =
            if half_space_first { (-self.normal, self.on_b, self.on_a) } else { (self.normal, self.on_a, self.on_b) };
        let support_calls = self.calls;
        Depth { outcome, lower, upper, normal, point_a, point_b, dimension: N, support_calls, ..Depth::unknown() }
    }
}
