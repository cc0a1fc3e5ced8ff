//! Where contacts become wrenches: the reference point of moments, and what a moment is worth.

use nalgebra::SMatrix;

use super::contact::{Contact, ContactError};
use super::numbers::{ceiling, usable};
use crate::math::{Vector, norm};
use crate::scalar::Real;

/// Reference point and torque scale of wrenches: a wrench is (force, moment about `reference` / `torque_scale`).
///
/// ```
/// use qdist::{Vector, grasp::{Contact, ContactError, Friction, WrenchFrame}};
/// let frame = WrenchFrame::new(Vector::from([0.0, 0.0, 1.0]), 0.5)?;
/// let contact = Contact::new(Vector::from([0.0, 1.0, 1.0]), Vector::from([1.0, 0.0, 0.0]), Friction::Frictionless)?;
/// let unit_normal_force = frame.contact_map(&contact).column(0).into_owned();
/// assert_eq!(unit_normal_force, Vector::from([1.0, 0.0, 0.0, 0.0, 0.0, -2.0]));
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WrenchFrame<T> {
    reference: Vector<T, 3>,
    torque_scale: T,
}

impl<T: Real> WrenchFrame<T> {
    /// Moments about `reference`, usually the centre of mass, divided by the length `torque_scale` > 0, usually the
    /// object's radius about it; both in the unit of the contacts' positions. 1 leaves moments as they are.
    ///
    /// # Errors
    /// [`ContactError::Frame`].
    pub fn new(reference: Vector<T, 3>, torque_scale: T) -> Result<Self, ContactError> {
        let scale_is_usable = torque_scale <= ceiling() && torque_scale * ceiling() >= T::one();
        if !(usable(reference.iter()) && scale_is_usable) {
            return Err(ContactError::Frame);
        }
        Ok(Self { reference, torque_scale })
    }

    /// The point about which moments are taken.
    pub fn reference(&self) -> &Vector<T, 3> {
        &self.reference
    }

    /// The length by which moments are divided.
    pub fn torque_scale(&self) -> T {
        self.torque_scale
    }

    /// The contact map G (paper, eq. 2): the wrench of a contact force (f1, f2, f3, f4) along n, o, t and, divided by
    /// the torque scale as all moments, about n.
    ///
    /// Rounding, in units of roundoff: the arm r = (p - reference)/L has two; a cross product with it 6 |r|
    /// in all, since each coordinate is the difference of two products with one rounding each.
    pub fn contact_map(&self, contact: &Contact<T>) -> SMatrix<T, 6, 4> {
        let arm = (contact.position() - self.reference).map(|x| x / self.torque_scale);
        let ([o, t], n) = (contact.tangents(), contact.normal());
        let column = |force: &Vector<T, 3>| {
            let moment = arm.cross(force);
            Vector::from([force.x, force.y, force.z, moment.x, moment.y, moment.z])
        };
        let zero = T::zero();
        SMatrix::from_columns(&[column(n), column(o), column(t), Vector::from([zero, zero, zero, n.x, n.y, n.z])])
    }

    /// What the terms of each entry of the contact map add up to in absolute value: its rounding is relative to that.
    pub(super) fn contact_map_sizes(&self, contact: &Contact<T>) -> SMatrix<T, 6, 4> {
        let arm = (contact.position() - self.reference).map(|x| x.abs() / self.torque_scale);
        let ([o, t], n) = (contact.tangents(), contact.normal());
        let column = |force: &Vector<T, 3>| {
            let f = force.abs();
            let [x, y, z] = [arm.y * f.z + arm.z * f.y, arm.z * f.x + arm.x * f.z, arm.x * f.y + arm.y * f.x];
            Vector::from([f.x, f.y, f.z, x, y, z])
        };
        let (zero, f) = (T::zero(), n.abs());
        SMatrix::from_columns(&[column(n), column(o), column(t), Vector::from([zero, zero, zero, f.x, f.y, f.z])])
    }

    /// The wrench of a force on the object and a moment about the reference point, in the units of force and of force times position.
    pub fn wrench(&self, force: &Vector<T, 3>, moment: &Vector<T, 3>) -> Vector<T, 6> {
        let scaled = moment.map(|x| x / self.torque_scale);
        Vector::from([force.x, force.y, force.z, scaled.x, scaled.y, scaled.z])
    }

    /// The contact force (f1, f2, f3, f4) that exerts a wrench: components along n, o, t, and the spin moment about n, in the unit of force
    /// times position. (eq. 2 solved for f; G has full column rank. Moments about o and t follow from the force, and are not read.)
    ///
    /// What the contact's friction does not allow at all, spin at a hard finger, say, is zero. A force outside of the cone by no more than the
    /// rounding of the wrench, 64 (1 + mu) roundoffs of its size, is moved onto it; any other is returned as it is.
    ///
    /// ```
    /// use qdist::{Vector, grasp::{Contact, ContactError, Friction, WrenchFrame}};
    /// let frame = WrenchFrame::new(Vector::zeros(), 0.5)?;
    /// let finger = Friction::Soft { mu: 1.0, mus: 0.25 };
    /// let contact = Contact::new(Vector::from([0.0, 1.0, 0.0]), Vector::from([0.0, -1.0, 0.0]), finger)?;
    /// let wrench = frame.wrench(&Vector::from([0.0, -8.0, 0.0]), &Vector::from([0.0, -1.0, 0.0]));
    /// assert_eq!(frame.contact_force(&contact, &wrench), Vector::from([8.0, 0.0, 0.0, 1.0]));
    /// # Ok::<(), ContactError>(())
    /// ```
    pub fn contact_force(&self, contact: &Contact<T>, wrench: &Vector<T, 6>) -> Vector<T, 4> {
        let ([o, t], n) = (contact.tangents(), contact.normal());
        let [x, y, z, moments @ ..] = wrench.data.0[0];
        let force = Vector::from([x, y, z]);
        // Tangents and normal are orthonormal up to what a contact tolerates: their dual basis.
        let duals = [o.cross(t), t.cross(n), n.cross(o)];
        let volume = n.dot(&duals[0]);
        let [f1, f2, f3] = duals.map(|dual| force.dot(&dual) / volume);
        let arm = contact.position() - self.reference;
        let moment = Vector::from(moments.map(|x| x * self.torque_scale));
        let f4 = n.dot(&(moment - arm.cross(&force))) / n.dot(n);
        let rounding = T::count(64) * T::ROUNDOFF * (T::one() + contact.friction().coefficients().0);
        let (slide, spin) = (rounding * norm(&force), rounding * (norm(&moment) + norm(&arm) * norm(&force)));
        onto_cone(contact, &Vector::from([f1, f2, f3, f4]), slide, spin)
    }

    /// The radii of the friction ellipsoid at unit normal force: mu along o and t, mus / L for the spin moment.
    pub(super) fn friction_radii(&self, contact: &Contact<T>) -> [T; 3] {
        let (mu, mus) = contact.friction().coefficients();
        [mu, mu, mus / self.torque_scale]
    }
}

/// The force moved onto the friction cone, where it is outside by no more than its rounding: of f1 to f3 `slide`, of f4 `spin`.
fn onto_cone<T: Real>(contact: &Contact<T>, force: &Vector<T, 4>, slide: T, spin: T) -> Vector<T, 4> {
    let zero = T::zero();
    let [f1, friction @ ..] = force.data.0[0];
    let press = if f1 < zero && -f1 <= slide { zero } else { f1 };
    let (mu, mus) = contact.friction().coefficients();
    let (radii, roundings) = ([mu, mu, mus], [slide, slide, spin]);
    let allowed = |i: usize, x: T| if radii[i] > zero { x / radii[i] } else { zero };
    let share = Vector::<T, 3>::from_fn(|i, _| allowed(i, friction[i]));
    let rounding = (0..3).fold(slide, |sum, i| sum + allowed(i, roundings[i]));
    // Somewhat inside: whoever checks rounds, too.
    let (used, inside) = (norm(&share), press * (T::one() - T::count(8) * T::ROUNDOFF));
    let factor = if used > inside && used - inside <= rounding { inside / used } else { T::one() };
    let scaled = |i: usize| share[i] * factor * radii[i];
    Vector::from([press, scaled(0), scaled(1), scaled(2)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_frames_are_refused() {
        let zero = Vector::zeros();
        for scale in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e-200, 1e200] {
            assert_eq!(WrenchFrame::new(zero, scale), Err(ContactError::Frame));
        }
        for x in [f64::NAN, f64::INFINITY, 1e200] {
            assert_eq!(WrenchFrame::new(Vector::from([x, 0.0, 0.0]), 1.0), Err(ContactError::Frame));
        }
    }
}
