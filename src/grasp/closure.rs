//! Force closure: does the grasp hold against any wrench? Yes or no, with a certificate, or neither.
//!
//! A grasp is *force-closed* when contact forces within friction exert every wrench (paper, Section II), that is, when the origin lies
//! in the interior of its wrench set W, with the support function h_W. Neither norm nor force caps matter, but for caps of 0; nor does the torque scale.
//!
//! * *Closed*: a ball around the origin lies in W, all rounding taken into account: d > 0, for the exact numbers of the contacts.
//! * *Open*: there is a direction u with h_W(u) = 0: no contact pushes along it. Floating-point numbers have such a direction
//!   by luck only: the line between two fingertips, say, is rounded. So open means that h_W(u), as it is computed, is no more than half of the bound
//!   E(u) = Σ |u_i| e_i of its own rounding, with the e_i of [`Support::errors`]: some 20 to 60 roundoffs of the wrenches that the terms of h_W(u) are made
//!   of, row by row. Contacts whose numbers differ by as much make an open grasp, and no bracket of d in this format tells d from 0.
//! * *Undecided*: h_W(u) is too small for the one and too large for the other, between 1/2 and about 5 times E(u), or the query was cut short.
//!
//! # How it is decided
//!
//! By the query of d, in other units and with a threshold.
//!
//! **Coordinates.** A linear map of W leaves closure as it is. The query divides each coordinate by a power of two near its error e_i: moments
//! of a thousand or a thousandth of the forces' size then count like forces, and the small ones are not drowned in the rounding of the
//! large ones.
//!
//! **Thresholds.** A query whose threshold is a few times the rounding ends at the first ball in W above it, or at the first direction below it: a candidate for
//! open, which is judged by h_W(u), summed in twice the precision. If it fails, the next query has a lower threshold; the last has next to none, and rounding
//! ends it.

use crate::math::{Accumulator, Vector, norm, unit};
use crate::qset::Ball;
use crate::query::Options;
use crate::query::answer::Outcome;
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Failure, Support};

/// Thresholds that are tried one after the other, in halves of a margin; the last ends at the first ball in W.
const THRESHOLDS: [usize; 3] = [8, 3, 0];

/// Points that the last of them may add, when the caller sets no lower limit: what is not decided then is next to undecidable.
const MOST: u32 = 200;

/// What was found out about force closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closure<T> {
    /// The grasp is certainly force-closed: W contains the ball of this radius, above 0, around the origin. It proves closure; d can be much larger.
    Closed {
        /// A lower bound of d for the unit ball.
        radius: T,
    },
    /// It is not, as far as the numbers of its contacts tell: along `direction` no contact forces exert more than their own rounding. d cannot be told
    /// from 0. The external wrench that the grasp does not resist is `-direction`.
    Open {
        /// A unit vector u that separates the grasp's wrenches from the others: h_W(u) is 0, or as small as its rounding (module `closure` has
        /// the number).
        direction: Vector<T, 6>,
    },
    /// Neither is proved: d is above 0 by little more than rounding, if it is; or memory, iterations, the deadline or a failing support function
    /// ended the query.
    Undecided {
        /// The weakest direction so far.
        direction: Vector<T, 6>,
    },
}

impl<T: Real> Closure<T> {
    /// Is the grasp certainly force-closed?
    pub fn is_closed(&self) -> bool {
        matches!(self, Self::Closed { .. })
    }

    /// Is it open, as far as the numbers of its contacts tell? (Neither this nor [`is_closed`](Self::is_closed): undecided.)
    pub fn is_open(&self) -> bool {
        matches!(self, Self::Open { .. })
    }
}

impl<T: Real> Solver<'_, T, 6> {
    /// Is the origin in the interior of the wrench set `w`?
    ///
    /// Ends at the first ball in W, or the first direction along which W has no extent; what rounding has to do with it is told at [`Closure`]. Of
    /// `options`, `max_iterations`, `guess` and `interrupt` count.
    ///
    /// Cost: that of the start and a few points; some 10 to 100 support calls, tens of microseconds on a desktop machine. Grasps that rounding
    /// leaves undecided take three such queries, and the last of them up to 200 points.
    ///
    /// ```
    /// use qdist::{Options, Vector, Workspace};
    /// use qdist::grasp::{Closure, Contact, ContactError, Friction, Norm, Primitive, WrenchFrame, WrenchSet};
    /// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
    /// let touch = |x: f64, friction| {
    ///     let contact = Contact::new(Vector::from([x, 0.0, 0.0]), Vector::from([-x, 0.0, 0.0]), friction)?;
    ///     Primitive::passive(&contact, &frame)
    /// };
    /// let soft = Friction::Soft { mu: 0.5, mus: 0.1 };
    /// let mut memory = Workspace::<f64, 6, 64, 512>::new();
    /// let pinch = [touch(-1.0, soft)?, touch(1.0, soft)?];
    /// let closure = memory.solver().force_closure(&WrenchSet::new(&pinch, Norm::LInf), &Options::default());
    /// assert!(closure.is_closed());
    ///
    /// // Without spin friction the object turns about the line between the fingertips.
    /// let hard = Friction::Hard { mu: 0.5 };
    /// let pivot = [touch(-1.0, hard)?, touch(1.0, hard)?];
    /// let closure = memory.solver().force_closure(&WrenchSet::new(&pivot, Norm::LInf), &Options::default());
    /// let Closure::Open { direction } = closure else { panic!() };
    /// assert!((direction[3].abs() - 1.0) < 1e-9);
    /// # Ok::<(), ContactError>(())
    /// ```
    pub fn force_closure(&mut self, w: &dyn Support<T, 6>, options: &Options<'_, T, 6>) -> Closure<T> {
        let even = Even::new(w);
        let margin = even.error() + T::count(16) * T::ROUNDOFF * even.extent();
        let mut guess = options.guess.map(|u| even.direction_in(&u));
        let mut weakest = Vector::zeros();
        for halves in THRESHOLDS {
            let threshold = Some((margin * T::count(halves) / T::count(2)).at_least(T::TINY));
            let limit = match (options.max_iterations, halves) {
                (None, 0) => Some(MOST),
                (Some(own), 0) => Some(own.min(MOST)),
                (own, _) => own,
            };
            let options = Options { threshold, guess, max_iterations: limit, ..*options };
            let answer = self.solve(&even, &Ball::unit(), &options);
            weakest = even.direction_out(&answer.direction);
            let radius = answer.lower * even.least();
            if radius >= T::TINY {
                return Closure::Closed { radius };
            }
            if answer.outcome == Outcome::SupportFailed {
                break;
            }
            if answer.upper < T::zero() || even.is_nothing(&answer.direction, &answer.support) {
                return Closure::Open { direction: weakest };
            }
            if matches!(answer.outcome, Outcome::Interrupted | Outcome::Iterations | Outcome::Capacity) {
                break;
            }
            guess = Some(answer.direction);
        }
        Closure::Undecided { direction: weakest }
    }
}

/// A set in coordinates that are all known equally well: s_i x_i, with powers of two s_i >= 1.
struct Even<'a, T> {
    set: &'a dyn Support<T, 6>,
    scales: Vector<T, 6>,
    /// Of the coordinates s_i x_i.
    errors: Vector<T, 6>,
    extents: Vector<T, 6>,
}

impl<'a, T: Real> Even<'a, T> {
    fn new(set: &'a dyn Support<T, 6>) -> Self {
        let errors = set.errors();
        let largest = errors.iter().fold(T::zero(), |m, &e| m.at_least(e));
        let least = T::ROUNDOFF * T::ROUNDOFF;
        // A ball term stays one only where all are equal; what is no number ends the query as it is.
        let apart = largest > T::zero() && largest.finite() && !(set.radius() > T::zero());
        let scale = |e: T| if apart { T::one() / (e / largest).at_least(least).power_of_two() } else { T::one() };
        let scales = errors.map(scale);
        Even { set, scales, errors: errors.component_mul(&scales), extents: set.extents().component_mul(&scales) }
    }

    /// A ball of radius 1 contains one of this radius in the coordinates of the set.
    fn least(&self) -> T {
        T::one() / self.scales.iter().fold(T::one(), |m, &s| m.at_least(s))
    }

    fn direction_in(&self, u: &Vector<T, 6>) -> Vector<T, 6> {
        u.component_div(&self.scales)
    }

    fn direction_out(&self, u: &Vector<T, 6>) -> Vector<T, 6> {
        let out = u.component_mul(&self.scales);
        if out.iter().any(|&x| x != T::zero()) { unit(&out) } else { out }
    }

    /// Is the height of this support point along u no more than half of what its rounding may be?
    fn is_nothing(&self, u: &Vector<T, 6>, point: &Vector<T, 6>) -> bool {
        let mut height = Accumulator::new(T::zero());
        let mut error = T::zero();
        for i in 0..6 {
            height.add_product(u[i], point[i]);
            error += u[i].abs() * self.errors[i];
        }
        // A set that does not know its extent has no error either: then the default for the point that it gave.
        let known = self.set.extent() > T::zero();
        let error = if known { error } else { error.at_least(T::count(96) * T::ROUNDOFF * norm(point)) };
        u.iter().any(|&x| x != T::zero()) && height.value() * T::count(2) <= error
    }
}

impl<T: Real> Support<T, 6> for Even<'_, T> {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        Ok(self.set.support(&u.component_mul(&self.scales))?.component_mul(&self.scales))
    }
    fn exhaustive(&self, u: &Vector<T, 6>) -> Result<(Vector<T, 6>, Vector<T, 6>), Failure> {
        let (point, witness) = self.set.exhaustive(&u.component_mul(&self.scales))?;
        Ok((point.component_mul(&self.scales), witness.component_mul(&self.scales)))
    }
    fn has_shortcuts(&self) -> bool {
        self.set.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.set.radius()
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.set.mirrored(signs)
    }
    fn contains_origin(&self) -> bool {
        self.set.contains_origin()
    }
    fn extent(&self) -> T {
        norm(&self.extents) * (T::one() + T::count(16) * T::ROUNDOFF)
    }
    fn error(&self) -> T {
        norm(&self.errors) * (T::one() + T::count(16) * T::ROUNDOFF)
    }
    fn errors(&self) -> Vector<T, 6> {
        self.errors
    }
    fn extents(&self) -> Vector<T, 6> {
        self.extents
    }
}
