//! Where contacts become wrenches: the reference point of moments, and what a moment is worth.

use nalgebra::SMatrix;

use super::contact::{Contact, ContactError};
use super::{ceiling, usable};
use crate::scalar::{Real, Vector};

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

    /// The radii of the friction ellipsoid at unit normal force: mu along o and t, mus / L for the spin moment.
    pub(super) fn friction_radii(&self, contact: &Contact<T>) -> [T; 3] {
        let (mu, mus) = contact.friction().coefficients();
        [mu, mu, mus / self.torque_scale]
    }
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
