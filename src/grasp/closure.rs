//! Does the grasp hold against any wrench? Yes or no, with a proof.
//!
//! A grasp is *force-closed* when contact forces within friction exert every wrench (paper, Section II), that is, when the origin lies
//! in the interior of W. Both answers have a certificate: a ball in W, or a direction u with h_W(u) = 0, along which no contact pushes.
//! The query ends as soon as it has one of them, usually after a dozen support calls. Neither norm nor force caps matter, but for caps of 0.

use crate::Outcome;
use crate::qset::Ball;
use crate::query::Options;
use crate::scalar::{Real, Vector};
use crate::solver::Solver;
use crate::support::Support;

/// What was found out about force closure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Closure<T> {
    /// The grasp is force-closed: W contains the ball of this radius, above 0, around the origin. It proves closure; d can be much larger.
    Closed {
        /// A lower bound of d for the unit ball.
        radius: T,
    },
    /// It is not, or by no more than rounding can tell: no contact forces exert a wrench w with `direction`.w > 0 beyond rounding. The
    /// external wrench that the grasp cannot resist at all is `-direction`.
    Open {
        /// A unit vector that separates the grasp's wrenches from the others.
        direction: Vector<T, 6>,
    },
    /// Memory, iterations, rounding or a failing support function ended the query before either was certain.
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
}

impl<T: Real> Solver<'_, T, 6> {
    /// Is the origin in the interior of the wrench set `w`?
    ///
    /// Ends at the first ball in W, or direction along which W has no extent, that is larger, or not larger, than rounding: 64 roundoffs
    /// of W's size and four times what [`Support::error`] says; four times as much where arithmetic has no ball above that. Of `options`,
    /// `max_iterations` and `guess` count.
    ///
    /// Cost: that of the start and a few points; some 10 to 100 support calls, tens of microseconds on a desktop machine.
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
    pub fn force_closure(&mut self, w: &dyn Support<T, 6>, options: &Options<T, 6>) -> Closure<T> {
        self.force_closure_until(w, options, None)
    }

    /// The same with a deadline, as in [`solve_until`](Solver::solve_until).
    pub fn force_closure_until(
        &mut self,
        w: &dyn Support<T, 6>,
        options: &Options<T, 6>,
        interrupt: Option<&dyn Fn() -> bool>,
    ) -> Closure<T> {
        let rounding = (T::count(4) * w.error() + T::count(64) * T::ROUNDOFF * w.extent()).at_least(T::TINY);
        let mut ask = |threshold: T| {
            self.solve_until(w, &Ball::unit(), &Options { threshold: Some(threshold), ..*options }, interrupt)
        };
        let mut answer = ask(rounding);
        if answer.outcome == Outcome::Precision && !(answer.lower > T::zero()) {
            answer = ask(T::count(4) * rounding);
        }
        let direction = answer.direction;
        match answer.outcome {
            Outcome::SupportFailed => Closure::Undecided { direction },
            _ if answer.lower > T::zero() => Closure::Closed { radius: answer.lower },
            Outcome::Below | Outcome::Separated | Outcome::Touching | Outcome::Degenerate => {
                Closure::Open { direction }
            }
            _ => Closure::Undecided { direction },
        }
    }
}
