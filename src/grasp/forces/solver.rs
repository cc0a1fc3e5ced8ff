//! Contact forces that resist a given wrench and are as small as they can be.
//!
//! The question is that of ray shooting (paper, end of Section II: Q is a segment). An external wrench acts on the object; the contacts
//! shall exert w = -(external wrench) (eq. 2), as a sum of *shares* w_i, one wrench per contact, each of forces in its friction cone. The
//! size of the forces (eq. 4) is the least multiple of W that contains w:
//!
//! ```text
//! least size = min { s >= 0 : w in s W } = max over u of u.w / h_W(u)
//! ```
//!
//! The left side is bounded from above by any shares, the right side from below by any direction: the answer is a bracket. Both
//! sides come from one linear program over the points of W, solved by column generation ([`program`](super::program), run by
//! [`search`](super::search)). W may be flat, or have the
//! origin on its boundary: an object that lies on a palm is not held against every wrench, but it is against its weight.
//!
//! * **Scale.** Coordinates are divided by the largest ones of W, by powers of two, exactly: the search does not see the torque scale. The error
//!   bound of W does: it is one number for forces and moments, and where these differ by orders of magnitude the lower bound pays.
//! * **Shares.** A point s_W(u) is the sum of one point of each hull({0} ∪ W_i), and only u is stored: at the end the shares are asked for again and
//!   weighted. They are sums of points of the cones with weights >= 0, so friction holds by construction, and the sum of the
//!   weights bounds the size.
//! * **Out of reach.** While w is not in the cone of the points so far, y separates it from them. If the support value along y
//!   vanishes, too, no forces resist w.
//! * **Rounding.** The lower bound of the best direction is computed once more at the end with the errors of all
//!   contributions added to h_W(u) and that of u.w taken away, where w is what the shares exert. How far that is from equilibrium is
//!   reported, too.

use super::super::contribution::Contribution;
use super::super::finger::{Finger, MAX_CONTACTS};
use super::super::numbers::usable;
use super::super::wrench_set::WrenchSet;
use super::search::ForceSearch;
use super::{ForceError, ForceOptions, ForceOutcome, Forces, precision};
use crate::math::{Vector, norm, unit};
use crate::scalar::Real;
use crate::support::Failure;
use core::borrow::Borrow;
use heapless::Vec;

/// Finds the smallest contact forces that resist a wrench; remembers where the last ones came from, for the next tick of a
/// control loop. 300 bytes in `f64`.
///
/// ```
/// use qdist::Vector;
/// use qdist::grasp::{Contact, ForceOptions, ForceOutcome, ForceSolver, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
///
/// // Two soft fingertips, 6 cm apart, hold 0.1 kg; none shall press with more than 10 N.
/// let rubber = Friction::Soft { mu: 0.5, mus: 0.01 };
/// let frame = WrenchFrame::new(Vector::zeros(), 0.05)?;
/// let left = Contact::new(Vector::from([-0.03, 0.0, 0.0]), Vector::from([1.0, 0.0, 0.0]), rubber)?;
/// let right = Contact::new(Vector::from([0.03, 0.0, 0.0]), Vector::from([-1.0, 0.0, 0.0]), rubber)?;
/// let contacts = [left.with_force_cap(10.0)?, right.with_force_cap(10.0)?];
/// let mut memory = [Primitive::empty(); 2];
/// let w = WrenchSet::new(wrenches(&contacts, &frame, &mut memory)?, Norm::LInf);
///
/// let weight: Vector<f64, 6> = frame.wrench(&Vector::from([0.0, 0.0, -0.981]), &Vector::zeros());
/// let mut shares = [Vector::zeros(); 2];
/// let forces = ForceSolver::new().resist(&w, &weight, &ForceOptions::default(), &mut shares)?;
///
/// assert_eq!(forces.outcome, ForceOutcome::Converged);
/// assert!(forces.lower <= 0.0981 && 0.0981 <= forces.upper); // of 10 N: friction bears 2 * 0.5 * 0.981 N
/// let f: Vector<f64, 4> = frame.contact_force(&contacts[0], &shares[0]);
/// assert!((f.x - 0.981).abs() < 1e-8 && f.y.hypot(f.z) <= 0.5 * f.x * (1.0 + 1e-12) && f.w.abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ForceSolver<T> {
    /// Directions of the points that the last forces were made of.
    known: Vec<Vector<T, 6>, 6>,
    /// Their weights; none when there are no forces.
    weights: Vec<T, 6>,
}

impl<T: Real> Default for ForceSolver<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> ForceSolver<T> {
    /// A solver that knows nothing yet.
    pub fn new() -> Self {
        Self { known: Vec::new(), weights: Vec::new() }
    }

    /// A solver that knows the directions of another one, [`known`](Self::known), for those who keep them as numbers; six at most.
    pub fn knowing(directions: impl Iterator<Item = Vector<T, 6>>) -> Self {
        Self { known: directions.take(6).collect(), weights: Vec::new() }
    }

    /// The directions whose points the last forces were made of.
    pub fn known(&self) -> &[Vector<T, 6>] {
        &self.known
    }

    /// What the last forces were made of: directions u and weights >= 0, whose sum is at most `upper`. The shares are the sums of
    /// weight times what [`WrenchSet::shares`] gives along u. Empty when no forces were found.
    pub fn parts(&self) -> impl Iterator<Item = (&Vector<T, 6>, T)> {
        self.known.iter().zip(self.weights.iter().copied())
    }

    /// The forces of all contacts of all fingers, of which the last shares were made; `set` is that of the last call. `forces[i]` are those
    /// of finger i as [`Finger::forces`] gives them; those beyond are left alone. They are a sum of points of F with weights that add up
    /// to `upper` at most: within friction cones, and within `upper` times caps and torque limits.
    ///
    /// Cost: 12 calls of the support function.
    ///
    /// # Errors
    /// Those of the fingers, which the search would have met before.
    pub fn contact_forces<C: Contribution<T> + Borrow<Finger<T>>>(
        &self,
        set: &WrenchSet<'_, T, C>,
        forces: &mut [[Vector<T, 4>; MAX_CONTACTS]],
    ) -> Result<(), Failure> {
        forces.iter_mut().take(set.contributions().len()).for_each(|own| *own = [Vector::zeros(); MAX_CONTACTS]);
        for (u, weight) in self.parts() {
            let mut failed = Ok(());
            set.shares(u, |i, _| {
                if let (Some(finger), Some(sums)) = (set.contributions().get(i), forces.get_mut(i)) {
                    match finger.borrow().forces(u) {
                        Ok(own) => sums.iter_mut().zip(own).for_each(|(sum, f)| *sum += f * weight),
                        Err(failure) => failed = Err(failure),
                    }
                }
            })?;
            failed?;
        }
        Ok(())
    }

    /// The smallest contact forces that keep the object in equilibrium with the `external` wrench: their `shares` sum up to -external (eq. 2).
    ///
    /// `external` is a wrench in the coordinates of the set ([`WrenchFrame::wrench`](crate::grasp::WrenchFrame::wrench)): force, and
    /// moment over the torque scale. `shares[i]` becomes the wrench of contribution i; shares beyond are left alone.
    /// [`WrenchFrame::contact_force`](crate::grasp::WrenchFrame::contact_force) makes a contact force of it. How the size is measured is the
    /// set's [`Norm`](crate::grasp::Norm). Whatever the outcome, the shares are wrenches that the contacts can exert with size `upper`, and
    /// `residual` away from equilibrium; or they are zero, when the search ended before there were any.
    ///
    /// Forces that were found before make the search shorter, and cost no answer: they may belong to another wrench or set. Where the search from
    /// them does not end as asked, one from nothing follows, with as many iterations, and the better of both counts.
    ///
    /// Cost: 13 calls of the support function, 6 for what is known, one per iteration, with about 700 operations beside; memory on the
    /// stack, 16 KB in `f64` (`./x stack`). Convergence is linear: random grasps of 2 to 8 contacts to 1e-9 take 65 iterations in the median, 145
    /// in one case of ten; two to five soft fingers 30 microseconds on a desktop computer. With a tick before that differed by 1e-3, to 1e-3, 7 iterations in the mean instead of 47. A zero wrench is resisted by zero forces.
    ///
    /// # Errors
    /// [`ForceError`].
    pub fn resist<C: Contribution<T>>(
        &mut self,
        set: &WrenchSet<'_, T, C>,
        external: &Vector<T, 6>,
        options: &ForceOptions<T>,
        shares: &mut [Vector<T, 6>],
    ) -> Result<Forces<T>, ForceError> {
        check(external, options)?;
        let shares = shares.get_mut(..set.contributions().len()).ok_or(ForceError::Room)?;
        shares.fill(Vector::zeros());
        self.weights.clear();
        let zero = T::zero();
        let mut forces = Forces {
            outcome: ForceOutcome::Converged,
            lower: zero,
            upper: zero,
            direction: Vector::zeros(),
            residual: norm(external),
            iterations: 0,
            failure: None,
        };
        if external.iter().all(|&x| x == zero) {
            return Ok(forces);
        }
        forces.upper = T::HUGE;
        forces.direction = unit(&-external);
        if let Err(failure) = self.search(set, options, &mut forces, shares, external) {
            shares.fill(Vector::zeros());
            forces = Forces {
                outcome: ForceOutcome::SupportFailed,
                upper: T::HUGE,
                residual: norm(external),
                failure: Some(failure),
                ..forces
            };
        }
        Ok(forces)
    }

    /// From what is known; where that does not settle the question, once more from nothing, and the better of both counts.
    fn search<C: Contribution<T>>(
        &mut self,
        set: &WrenchSet<'_, T, C>,
        options: &ForceOptions<T>,
        forces: &mut Forces<T>,
        shares: &mut [Vector<T, 6>],
        external: &Vector<T, 6>,
    ) -> Result<(), Failure> {
        let known = core::mem::take(&mut self.known);
        let mut search = ForceSearch::new(set, -external, *options)?;
        let (unknown, mut aside, mut warm) = (*forces, forces.direction, None);
        if !known.is_empty() {
            // A failure along a direction that is known from elsewhere says nothing of this search.
            let ended = self.attempt(&mut search, &known, &aside, forces, shares, external);
            if ended.is_ok() && is_settled(forces) {
                return Ok(());
            }
            if ended.is_ok() && forces.upper < T::HUGE {
                warm = Some((core::mem::take(self), *forces));
            }
            (*forces, aside) = (unknown, forces.direction);
            search.restart();
        }
        self.attempt(&mut search, &[], &aside, forces, shares, external)?;
        if let Some((solver, found)) = warm
            && is_better(&found, forces, external)
        {
            let directions = [found.direction, forces.direction];
            *self = solver;
            *forces = Forces { iterations: search.iterations, outcome: found.outcome, ..unknown };
            self.conclude(&mut search, &directions, forces, shares, external)?;
        }
        Ok(())
    }

    /// One search from the directions `known`, and what it ends with. A direction from `aside` may prove the lower bound, too.
    #[inline(never)] // called twice
    fn attempt<C: Contribution<T>>(
        &mut self,
        search: &mut ForceSearch<'_, '_, T, C>,
        known: &[Vector<T, 6>],
        aside: &Vector<T, 6>,
        forces: &mut Forces<T>,
        shares: &mut [Vector<T, 6>],
        external: &Vector<T, 6>,
    ) -> Result<(), Failure> {
        if search.unit.finite() && search.unit > T::zero() {
            let ended = search.recall(known).and_then(|()| search.recall(&[-external])).and_then(|()| search.run());
            forces.iterations = search.iterations;
            forces.outcome = ended?;
        } else {
            forces.outcome = ForceOutcome::Precision; // W is nothing beside w, or w beside W.
        }
        search.program.polish();
        if !search.program.holds(precision()) || search.program.is_short() {
            search.program = search.sound.clone();
        }
        self.known.clear();
        self.weights.clear();
        let found = !search.program.is_short() && search.unit > T::zero();
        for (vertex, weight) in search.program.parts() {
            let _ = self.known.push(vertex.witness);
            if found {
                let _ = self.weights.push((weight * search.unit).at_least(T::zero()));
            }
        }
        let directions = [search.best.1, search.last, forces.direction, *aside];
        self.conclude(search, &directions, forces, shares, external)
    }

    /// Shares, bracket and outcome from what is known; one of the `directions` proves the lower bound.
    #[inline(never)] // called twice
    fn conclude<C: Contribution<T>>(
        &mut self,
        search: &mut ForceSearch<'_, '_, T, C>,
        directions: &[Vector<T, 6>],
        forces: &mut Forces<T>,
        shares: &mut [Vector<T, 6>],
        external: &Vector<T, 6>,
    ) -> Result<(), Failure> {
        shares.fill(Vector::zeros());
        if !self.weights.is_empty() {
            search.distribute(self.parts(), shares, forces, external)?;
        }
        if forces.upper >= T::HUGE {
            self.weights.clear();
        }
        for (i, direction) in directions.iter().enumerate() {
            if directions.iter().take(i).any(|before| before == direction) {
                continue;
            }
            let lower = search.lower(direction)?;
            if lower > forces.lower {
                (forces.lower, forces.direction) = (lower.at_most(forces.upper), unit(direction));
            }
        }
        forces.outcome = search.verdict(forces, external);
        Ok(())
    }
}

/// Is the question answered as asked, or for certain?
fn is_settled<T: Real>(forces: &Forces<T>) -> bool {
    matches!(forces.outcome, ForceOutcome::Converged | ForceOutcome::Above) || forces.lower >= T::HUGE
}

/// Are the forces `a` nearer to what is asked for than `b`, in bracket and equilibrium?
fn is_better<T: Real>(a: &Forces<T>, b: &Forces<T>, external: &Vector<T, 6>) -> bool {
    let whole = norm(external);
    let miss = |f: &Forces<T>| ((f.upper - f.lower) / f.upper).at_least(f.residual / whole);
    a.upper < T::HUGE && !is_settled(b) && (b.upper >= T::HUGE || miss(a) < miss(b))
}

/// Is everything but the room for the shares as it should be?
pub fn check<T: Real>(external: &Vector<T, 6>, options: &ForceOptions<T>) -> Result<(), ForceError> {
    if !usable(external.iter()) {
        return Err(ForceError::Wrench);
    }
    if !(options.relative >= T::zero() && options.relative.finite()) {
        return Err(ForceError::Tolerance);
    }
    if !(options.limit >= T::zero()) {
        return Err(ForceError::Limit);
    }
    Ok(())
}
