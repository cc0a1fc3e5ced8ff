//! A finger as a whole: contacts that share their joints, and what the joints can bear.

mod face;
mod lorentz;
mod program;
mod tuples;

pub use face::MAX_CONTACTS;
use nalgebra::SMatrix;

use super::contact::{ContactError, GraspError};
use super::contribution::Contribution;
use super::contribution::near_unit;
use super::frame::WrenchFrame;
use super::hand::{ActiveForces, HandContact};
use super::jacobian::MAX_JOINTS;
use super::numbers::{check_tolerance, usable};
use super::primitive::frobenius;
use super::svd::Triangular;
use crate::math::{Vector, norm};
use crate::scalar::Real;
use crate::support::{Failure, Support};
use face::{Face, WIDTH};
use tuples::{Tuple, Tuples};

/// Failure code: the support function of a [`Finger`] found no point that is provably as good as its `error` promises.
pub const UNSOLVED: i32 = i32::MIN + 2;

/// Rounds of lowering caps to what the limits permit. Each gains many orders of magnitude.
const TIGHTENINGS: usize = 6;

/// Who makes the contact forces of a finger.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ForceModel {
    /// Anyone: the structure bears what the joints do not. The limits hold for the torques that reach the joints, `J^T f`.
    Passive,
    /// The joints, at all contacts of the finger together: the forces f = (f_1, ..., f_k) are in the range of the Jacobians
    /// on top of each other (paper, eq. 9-10, for k contacts). A finger without Jacobian, the palm, is passive.
    Active,
}

/// The wrenches of a finger with k contacts: the images `sum G_i f_i` of
///
/// ```text
/// F = { (f_1, ..., f_k) : f_i in its friction cone, f_i1 <= cap_i, |sum_i J_i^T f_i| <= tau, joint by joint }
/// ```
///
/// and, with [`ForceModel::Active`], f in range([J_1; ...; J_k]). F is convex and contains 0, and so does the set. It
/// is a [`Contribution`]: `WrenchSet::<T, Finger<T>>` adds fingers for L-infinity. For L1 it takes their hull: the
/// *fingers* then share one supply, of which each may use a part of what F permits; the contacts of one finger do not
/// share.
///
/// Without limits a passive finger is the sum of its contacts' [`Primitive`](super::Primitive)s with {0}, and an
/// active one with one contact is that of [`ActiveForces`]. Limits never make the set larger, and from some size on
/// they do not count. Forces that several contacts make actively *together* are a subset of what
/// [`active_wrenches`](super::active_wrenches) permits to each.
///
/// # What is exact, and what has a tolerance
///
/// The support function is in closed form where the limits do not count; elsewhere it is a convex program of at most
/// 16 variables, and the answer has a proof that its value is within `error` of h(u), or is refused with the failure
/// code [`UNSOLVED`]. That is known of numbers far from any hand only, such as friction coefficients of 1e9. `error`
/// is 4096 (1 + 1/t) roundoffs of the size of the set (the sum of its contacts' largest wrenches), 1e-12 or less of
/// it in `f64` where t is near 1. t is 1 for passive fingers without zero limits. Elsewhere it tells how far inside
/// of the friction cones forces are possible: next to the edge where they just stop being so it is small. The size is
/// that of the forces that the limits permit; caps may be generous.
///
/// A support call takes 0.1 microseconds on a desktop machine in closed form, otherwise 10 for one contact, 30 for
/// two, 70 for three and 130 for four. A finger has 4.6 KB in `f64`.
///
/// Rank decisions and forces on the edge of the friction cone are subject to the tolerance, as for [`ActiveForces`].
/// A limit that is less than 16 roundoffs of the torque that the caps permit is zero. Forces obey cones, caps, limits
/// and the range up to rounding, which is relative to the forces that the caps permit, not to those returned.
///
/// ```
/// use qdist::{Vector, grasp::*, support::Support};
/// // A link turns about the z axis at the origin, and presses along y: 0.1 m from the joint, and at the tip, 0.2 m from it.
/// let frame = WrenchFrame::new(Vector::zeros(), 0.1)?;
/// let touch = |x: f64| {
///     let y = Vector::from([0.0, 1.0, 0.0]);
///     let contact = Contact::new(Vector::from([x, 0.0, 0.0]), y, Friction::Frictionless)?.with_force_cap(50.0)?;
///     let jacobian = Jacobian::new([&[x], &[0.0], &[0.0], &[0.0]])?;
///     Ok::<_, ContactError>(HandContact { contact, jacobian: Some(jacobian) })
/// };
/// let contacts = [touch(0.1)?, touch(0.2)?];
/// // 1 N m makes 10 N next to the joint, or 5 N at the tip, or something between.
/// let finger = Finger::new(&contacts, &[1.0], ForceModel::Passive, &frame, default_tolerance()).unwrap();
/// let up = Vector::from([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
/// assert!((finger.support(&up).unwrap() - up * 10.0 - Vector::from([0.0, 0.0, 0.0, 0.0, 0.0, 10.0])).norm() < 1e-6);
/// let [near, tip, ..] = finger.forces(&up).unwrap();
/// assert!((near[0] - 10.0).abs() < 1e-6 && tip[0] < 1e-6);
/// // The joint cannot press with one of them only: its torque moves both, in proportion to the arms.
/// let finger = Finger::new(&contacts, &[1.0], ForceModel::Active, &frame, default_tolerance()).unwrap();
/// let [near, tip, ..] = finger.forces(&up).unwrap();
/// assert!((near[0] - 2.0).abs() < 1e-9 && (tip[0] - 4.0).abs() < 1e-9);
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finger<T> {
    /// Not as a `usize`: what it measures is then the same on all targets.
    contacts: u32,
    tuples: Tuples<T>,
    /// F_i by columns, for forces up to the largest cap.
    forces: [[[T; 4]; 4]; MAX_CONTACTS],
    /// G_i F_i by columns.
    wrenches: [[Vector<T, 6>; 4]; MAX_CONTACTS],
    /// Sum of the largest wrenches of all contacts.
    size: T,
    error: T,
}

impl<T: Real> Finger<T> {
    /// A finger with `contacts`, at most [`MAX_CONTACTS`], whose Jacobians have the same joints, and one torque limit, not
    /// negative, for each joint; infinite is none. The palm is a finger without Jacobians and limits. `limits` have the
    /// unit of force times that of the Jacobian's entries. `tolerance` is that of [`ActiveForces::new`], usually
    /// [`default_tolerance`](super::default_tolerance).
    ///
    /// Cost: 5 microseconds on a desktop machine where no limit counts. Else some support calls for each contact, and
    /// with equations between the forces of several contacts some singular value decompositions of 16 x 16 numbers:
    /// up to 5 milliseconds.
    ///
    /// # Errors
    /// [`ContactError::Tolerance`]; [`ContactError::TorqueLimit`]; at a contact: [`ContactError::Room`] (too many of them),
    /// [`ContactError::Jacobian`] (missing, of other joints than the first, or too large for the torque scale),
    /// [`ContactError::Wrench`].
    pub fn new(
        contacts: &[HandContact<T>],
        limits: &[T],
        model: ForceModel,
        frame: &WrenchFrame<T>,
        tolerance: T,
    ) -> Result<Self, GraspError> {
        let at = |contact: usize| move |error: ContactError| GraspError { contact, error };
        check_tolerance(tolerance).map_err(at(0))?;
        if contacts.len() > MAX_CONTACTS {
            return Err(at(MAX_CONTACTS)(ContactError::Room));
        }
        let joints = contacts.first().and_then(|c| c.jacobian).map(|j| j.joints());
        check_limits(limits, joints.unwrap_or(0)).map_err(at(0))?;

        let mut parts = Parts::new(limits);
        for (index, own) in contacts.iter().enumerate() {
            if own.jacobian.map(|j| j.joints()) != joints {
                return Err(at(index)(ContactError::Jacobian));
            }
            let alone = contacts.len() == 1 && model == ForceModel::Active;
            parts.add(index, own, alone, frame, tolerance).map_err(at(index))?;
        }
        let together = contacts.len() > 1 && model == ForceModel::Active && joints.is_some();
        let range = if together { parts.complement(tolerance) } else { [[T::zero(); WIDTH]; WIDTH] };
        let mut finger = parts.finger(contacts.len(), &range, tolerance).map_err(|(index, error)| at(index)(error))?;
        for _ in 0..TIGHTENINGS {
            if !parts.tighten(&finger) {
                break;
            }
            finger = parts.finger(contacts.len(), &range, tolerance).map_err(|(index, error)| at(index)(error))?;
        }
        Ok(finger)
    }

    /// The number k of contacts.
    pub fn contacts(&self) -> usize {
        self.contacts as usize
    }

    /// The contact forces (f1, f2, f3, f4) whose wrenches add up to the support point along `u`, of the k contacts in
    /// their order; zero for others. f4 is divided by the torque scale, so that the point is the sum of
    /// [`contact_map`](WrenchFrame::contact_map) times force. A [`WrenchSet`](super::WrenchSet) of fingers tells by
    /// [`shares`](super::WrenchSet::shares) which of them have a share in its support point.
    ///
    /// # Errors
    /// [`UNSOLVED`].
    pub fn forces(&self, u: &Vector<T, 6>) -> Result<[Vector<T, 4>; MAX_CONTACTS], Failure> {
        let x = self.farthest(&near_unit(u), T::zero())?;
        Ok(core::array::from_fn(|i| {
            let columns = self.forces[i].iter().zip(&x[i]);
            columns.fold(Vector::zeros(), |s, (column, &x)| s + Vector::from(*column) * x)
        }))
    }

    /// The tuple farthest along u; zero if h(u) is provably not above `floor` >= 0.
    fn farthest(&self, u: &Vector<T, 6>, floor: T) -> Result<Tuple<T>, Failure> {
        let unit = norm(u) * self.size;
        if !(unit > T::zero()) {
            return Ok([[T::zero(); 4]; MAX_CONTACTS]);
        }
        let values = self.wrenches.each_ref().map(|columns| columns.each_ref().map(|column| column.dot(u) / unit));
        if self.tuples.alone(&values).1 * unit * (T::one() + T::count(32) * T::ROUNDOFF) <= floor {
            return Ok([[T::zero(); 4]; MAX_CONTACTS]);
        }
        Ok(self.tuples.farthest(&values, self.contacts())?.0)
    }

    fn wrench(&self, x: &Tuple<T>) -> Vector<T, 6> {
        let terms = self.wrenches.iter().flatten().zip(x.iter().flatten());
        terms.fold(Vector::zeros(), |s, (column, &x)| s + column * x)
    }
}

impl<T: Real> Support<T, 6> for Finger<T> {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        Ok(self.wrench(&self.farthest(&near_unit(u), T::zero())?))
    }
    fn extent(&self) -> T {
        self.size * (T::one() + T::count(32) * T::ROUNDOFF) + self.error
    }
    fn error(&self) -> T {
        self.error
    }
}

impl<T: Real> Contribution<T> for Finger<T> {
    fn support_above(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
        let point = self.wrench(&self.farthest(u, floor.at_least(T::zero()))?);
        let value = point.dot(u);
        Ok((value > floor).then_some((value, point)))
    }
}

/// What a finger is computed from.
struct Parts<'a, T> {
    /// F_i by columns, for unit force.
    forces: [[[T; 4]; 4]; MAX_CONTACTS],
    maps: [SMatrix<T, 6, 4>; MAX_CONTACTS],
    caps: [T; MAX_CONTACTS],
    /// Columns of all Jacobians on top of each other.
    columns: [[T; WIDTH]; MAX_JOINTS],
    limits: &'a [T],
}

impl<'a, T: Real> Parts<'a, T> {
    fn new(limits: &'a [T]) -> Self {
        Self {
            forces: [[[T::zero(); 4]; 4]; MAX_CONTACTS],
            maps: [SMatrix::zeros(); MAX_CONTACTS],
            caps: [T::zero(); MAX_CONTACTS],
            columns: [[T::zero(); WIDTH]; MAX_JOINTS],
            limits,
        }
    }

    /// A contact; `alone`: its forces are those of [`ActiveForces`], again a cone over a disc.
    fn add(
        &mut self,
        index: usize,
        own: &HandContact<T>,
        alone: bool,
        frame: &WrenchFrame<T>,
        tolerance: T,
    ) -> Result<(), ContactError> {
        let (zero, one) = (T::zero(), T::one());
        let [a, b, c] = frame.friction_radii(&own.contact);
        let mut forces = [[one, zero, zero, zero], [zero, a, zero, zero], [zero, zero, b, zero], [zero, zero, zero, c]];
        if let (true, Some(jacobian)) = (alone, &own.jacobian) {
            forces = match ActiveForces::new(&own.contact, jacobian, frame, tolerance)?.set() {
                Some((center, disc)) => {
                    let ([center], [a, b, c]) = (center.data.0, disc.data.0);
                    [center, a, b, c]
                }
                None => [[zero; 4]; 4],
            };
        }
        if !usable(forces.iter().flatten()) {
            return Err(ContactError::Wrench);
        }
        let all = self.forces.iter_mut().zip(&mut self.maps).zip(&mut self.caps).nth(index);
        if let (Some(((to, map), cap)), true) = (all, own.contact.force_cap() > zero) {
            (*to, *map, *cap) = (forces, frame.contact_map(&own.contact), own.contact.force_cap());
        }
        for (j, column) in self.columns.iter_mut().enumerate() {
            let own = own.jacobian.map_or([zero; 4], |jacobian| jacobian.column(j, frame.torque_scale()));
            if !usable(own.iter()) {
                return Err(ContactError::Jacobian);
            }
            column.iter_mut().skip(4 * index).zip(own).for_each(|(to, x)| *to = x);
        }
        Ok(())
    }

    /// An orthonormal basis of the complement of the range of all Jacobians on top of each other; the rest is zero.
    fn complement(&self, tolerance: T) -> [[T; WIDTH]; WIDTH] {
        let largest = self.columns.iter().flatten().fold(T::zero(), |m, x| m.at_least(x.abs()));
        let mut triangle = Triangular::<T, WIDTH>::new();
        for column in &self.columns {
            triangle.add(column.map(|x| if largest > T::zero() { x / largest } else { x }));
        }
        let mut svd = triangle.svd();
        let [sigma, ..] = svd.sigma;
        for (v, s) in svd.v.iter_mut().zip(&svd.sigma) {
            if *s > tolerance * sigma {
                *v = [T::zero(); WIDTH];
            }
        }
        svd.v
    }

    /// The finger, or the contact with wrenches that are too large. `range`: equations of its forces.
    fn finger(
        &self,
        contacts: usize,
        range: &[[T; WIDTH]; WIDTH],
        tolerance: T,
    ) -> Result<Finger<T>, (usize, ContactError)> {
        let zero = T::zero();
        let cap = self.caps.iter().fold(zero, |m, &cap| m.at_least(cap));
        let caps = self.caps.map(|own| if own > zero { own / cap } else { zero });
        let mut equations = [[zero; WIDTH]; WIDTH + MAX_JOINTS];
        equations.iter_mut().zip(range).for_each(|(to, row)| *to = *row);
        // Limits in units of the largest cap; none where they never count, an equation where they leave nothing.
        let (mut rows, mut bounds) = ([[zero; WIDTH]; MAX_JOINTS], [zero; MAX_JOINTS]);
        for (j, (column, limit)) in self.columns.iter().zip(self.limits).enumerate() {
            let size = column.iter().fold(zero, |m, x| m.at_least(x.abs()));
            if !(size > zero && cap > zero) {
                continue;
            }
            let row = column.map(|x| x / size);
            let limit = *limit / size / cap;
            let most = self.most_torque(&row, &caps);
            if limit <= T::count(16) * T::ROUNDOFF * most {
                equations.iter_mut().skip(WIDTH + j).take(1).for_each(|to| *to = row);
            } else if limit < most {
                let all = rows.iter_mut().zip(&mut bounds).skip(j).take(1);
                all.for_each(|(to, bound)| (*to, *bound) = (row, limit));
            }
        }
        let free = equations.iter().flatten().all(|x| x.is_zero());
        let face = Face::new(self.forces, &equations, tolerance);
        let tuples = Tuples::new(&face, caps, &rows, bounds, free);
        let forces = face.forces.map(|map| map.map(|column| column.map(|x| x * cap)));
        let mut wrenches = [[Vector::zeros(); 4]; MAX_CONTACTS];
        let (mut size, mut rounding) = (zero, zero);
        for i in 0..MAX_CONTACTS {
            let own = SMatrix::<T, 4, 4>::from(forces[i]);
            let product = self.maps[i] * own;
            wrenches[i] = product.data.0.map(Vector::from);
            let [center, disc @ ..] = wrenches[i];
            size += tuples.caps[i] * (norm(&center) + norm(&Vector::from(disc.map(|column| norm(&column)))));
            rounding += tuples.caps[i] * frobenius(&self.maps[i]) * frobenius(&own);
            if !(usable(product.iter()) && usable([size, rounding].iter())) {
                return Err((i, ContactError::Wrench));
            }
        }
        let error = tuples.gap * size + T::count(32) * T::ROUNDOFF * rounding + T::TINY;
        Ok(Finger { contacts: contacts as u32, tuples, forces, wrenches, size, error })
    }

    /// The largest torque of a joint with the row `row`, if no joint had limits.
    fn most_torque(&self, row: &[T; WIDTH], caps: &[T; MAX_CONTACTS]) -> T {
        let mut most = T::zero();
        for i in 0..MAX_CONTACTS {
            let torque = |column: &[T; 4]| (0..4).fold(T::zero(), |s, f| s + row[4 * i + f] * column[f]);
            let [s, a, b, c] = self.forces[i].each_ref().map(torque);
            most += caps[i] * (s.abs() + (a * a + b * b + c * c).root());
        }
        most
    }

    /// Lowers the caps to what the limits permit: accuracy is relative to them. False if they are about that already.
    fn tighten(&mut self, finger: &Finger<T>) -> bool {
        let (zero, one) = (T::zero(), T::one());
        let cap = self.caps.iter().fold(zero, |m, &cap| m.at_least(cap));
        let before = self.caps;
        for i in 0..MAX_CONTACTS {
            let mut values = [[zero; 4]; MAX_CONTACTS];
            values[i][0] = one;
            if finger.tuples.caps[i] > zero
                && let Ok((_, most)) = finger.tuples.farthest(&values, finger.contacts())
            {
                self.caps[i] = before[i].at_most(cap * most * (one + T::count(16) * T::ROUNDOFF));
            }
        }
        self.caps.iter().zip(before).any(|(now, before)| *now < before * T::of(0.9))
    }
}

fn check_limits<T: Real>(limits: &[T], joints: usize) -> Result<(), ContactError> {
    if limits.len() != joints {
        return Err(ContactError::TorqueLimit { joint: limits.len().min(joints) });
    }
    match limits.iter().position(|limit| !(*limit >= T::zero())) {
        Some(joint) => Err(ContactError::TorqueLimit { joint }),
        None => Ok(()),
    }
}
