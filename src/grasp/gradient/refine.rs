//! The weakest direction to rounding, and the contact forces that it loads.
//!
//! A bracket of relative width e pins the minimiser u of h_W / h_Q to about e where h_W has a kink across it, and to sqrt(e) only
//! where h_W is smooth. What depends on u to first order, as the gradient of d does (module `gradient`), wants it to rounding. Near
//! the minimiser everything has a closed form, so Newton's method does the rest. The conditions of a minimum are
//!
//! ```text
//! Σ λ_i (c_i + D_i x_i) = d s_Q(u)                  a point of W, and the same of d Q
//! ```
//!
//! with the parts of the primitives { c + D x : |x| <= 1 }. Kinks of h_W are where minima like to be, and each has its equation and
//! its multiplier:
//!
//! ```text
//! LInf   h_i(u) > 0: λ_i = 1     h_i(u) < 0: λ_i = 0     h_i(u) = 0: 0 <= λ_i <= 1
//! L1     h_i(u) = d h_Q(u): λ_i >= 0, the sum is 1       h_i(u) less: λ_i = 0
//! both   D_i^T u = 0: |x_i| <= 1, at a tip               else x_i = D_i^T u / |D_i^T u|
//! ```
//!
//! Which contacts are at a kink is guessed, from the widest notion of "is zero" to the narrowest, corrected by the signs of
//! the multipliers, and then **verified**: an optimum is only called smooth when all inequalities hold strictly, the equations are
//! regular, and h_W grows to second order along all that they leave free. Then u and the multipliers are unique, and follow the
//! grasp smoothly (Fiacco, *Introduction to Sensitivity and Stability Analysis*, 1983): d has a gradient. One irregular case is
//! common and harmless: three hard fingers are weakest about the line through two of them, whose squeeze is then free.
//!
//! The Hessian of h_Q is taken from differences of its mapping s_Q: zero for polytopes, good to sqrt(roundoff) for others,
//! which costs Newton's method nothing that counts, since the equations themselves are exact.

use super::super::numbers::default_tolerance;
use super::super::span::Subspace;
use super::super::wrench_set::{Norm, WrenchSet};
use super::problem::Problem;
use super::ties::{Kind, Part, Tie, Ties, tip};
use crate::math::{Vector, norm};
use crate::qset::UnitSet;
use crate::query::answer::Answer;
use crate::scalar::Real;

/// Why an optimum has no gradient, or none that could be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kink {
    /// Another direction bounds d as tightly: the minimiser is not unique.
    Rival,
    /// Two or more points of Q touch the boundary of W.
    UnitSet,
    /// No minimum with strict inequalities and regular equations was found near the answer's direction: a contact is just
    /// about to carry load, contacts share it in more than one way, h_W / h_Q is constant along a curve, or the answer was
    /// too far from a minimum.
    Degenerate,
    /// The grasp is not known to be closed: d is not known to be above 0.
    NotClosed,
}

/// What one contact carries at the weakest direction: `weight (center + disc x)` of its primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share<T> {
    /// λ, 0 to 1: the share of the full normal force.
    pub weight: T,
    /// |x| <= 1: how the friction is used, in the coordinates of the primitive's disc.
    pub friction: Vector<T, 3>,
}

/// An answer whose upper end and direction are those of an exact local minimum.
///
/// ```
/// use qdist::grasp::{Contact, ContactError, Friction, Norm, Primitive, Refined, WrenchFrame, WrenchSet, wrenches};
/// use qdist::{Options, Vector, Workspace, qset::Ball};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let soft = Friction::Soft { mu: 0.5, mus: 0.2 };
/// let contact = |x: f64, y: f64, z: f64| {
///     let p = Vector::from([x, y, z]);
///     Contact::new(p, -p.normalize(), soft)
/// };
/// let contacts = [contact(1.0, 0.1, 0.2)?, contact(-0.4, 0.8, 0.1)?, contact(-0.5, -0.9, -0.2)?];
/// let mut primitives = [Primitive::empty(); 3];
/// let set = WrenchSet::new(wrenches(&contacts, &frame, &mut primitives).unwrap(), Norm::L1);
/// let mut memory = Workspace::<f64, 6, 2048, 2048>::new();
/// let coarse = memory.solver().solve(&set, &Ball::unit(), &Options { relative: 1e-2, ..Options::default() });
/// let refined = Refined::new(&set, &Ball::unit(), &coarse);
/// assert_eq!(refined.kink, None);
/// assert!(refined.answer.upper <= coarse.upper && refined.answer.upper >= coarse.lower);
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Refined<'a, T> {
    /// The answer; `lower` is untouched, `upper` not worse. Where the minimum was found, `direction`, `support` (the point of W that
    /// touches d Q) and `unit` are those of it, and `rival` is what still is one.
    pub answer: Answer<T, 6>,
    /// Why there is no gradient; `None`: there is one.
    pub kink: Option<Kink>,
    set: WrenchSet<'a, T>,
    ties: Ties<T>,
}

impl<'a, T: Real> Refined<'a, T> {
    /// Refines an answer of [`Solver::solve`](crate::Solver::solve) or [`solve_in_span`](crate::Solver::solve_in_span) for the same
    /// `set` and `q`, to be called with a Q that has a [`mapping`](UnitSet::mapping). The answer's bracket may be coarse, 1e-2
    /// is usually enough; but only the bracket tells how far another, deeper minimum may be below.
    ///
    /// Cost: some ten Newton steps for each guess, of some 12 calls of the mapping, m primitives of 200 operations, and one elimination
    /// with 13 unknowns.
    pub fn new(set: &WrenchSet<'a, T>, q: &dyn UnitSet<T, 6>, answer: &Answer<T, 6>) -> Self {
        let mut refined = Self { answer: answer.clone(), kink: Some(Kink::Degenerate), set: *set, ties: Ties::new() };
        if !(answer.lower > T::zero()) {
            refined.kink = Some(Kink::NotClosed);
            return refined;
        }
        let flat = answer.dimension < 6;
        let span = if flat { Subspace::new(set.contributions(), default_tolerance()).ok() } else { None };
        if flat && span.is_none_or(|span| span.dimension() != answer.dimension) {
            return refined;
        }
        let Some(problem) = Problem::new(set, q, span, &answer.direction) else { return refined };
        let Some(mut best) = problem.search(&answer.direction, answer.upper) else { return refined };
        if let Some(rival) = answer.rival {
            // Is it still one? What is not settled counts as a tie.
            let slack = best.ratio * T::count(1 << 20) * T::ROUNDOFF;
            match problem.search(&rival, T::HUGE) {
                Some(other) if other.ratio > best.ratio + slack => refined.answer.rival = None,
                Some(other) if norm(&(other.u - best.u)) <= T::ROUNDOFF.root() => refined.answer.rival = None,
                Some(other) if other.ratio < best.ratio - slack => {
                    best = other;
                    refined.answer.rival = None;
                }
                _ => {}
            }
        }
        refined.answer.rival = refined.answer.rival.or_else(|| problem.mirror_image(&best.u));
        refined.kink = match refined.answer.rival {
            Some(_) => Some(Kink::Rival),
            None if !best.sharp => Some(Kink::UnitSet),
            None => None,
        };
        problem.conclude(&best, &mut refined.answer);
        refined.ties = best.ties;
        refined
    }

    /// The set that the answer is about.
    pub fn set(&self) -> &WrenchSet<'a, T> {
        &self.set
    }

    /// What contribution `index` carries at the minimum; `None` where there is a [`kink`](Self::kink) or no such contribution.
    pub fn share(&self, index: usize) -> Option<Share<T>> {
        if self.kink.is_some() {
            return None;
        }
        let part = Part::new(self.set.contributions().get(index)?, &self.answer.direction);
        let own = |tie: &&Tie<T>| tie.kind == Kind::Weight(index);
        let weight = match (self.ties.iter().find(own), self.set.norm()) {
            (Some(tie), _) => tie.multiplier,
            (None, Norm::LInf) if part.value > T::zero() => T::one(),
            (None, _) => T::zero(),
        };
        let friction = tip(&self.ties, index).map_or(part.x, |y| y / weight);
        Some(Share { weight, friction })
    }
}
