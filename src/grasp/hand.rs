//! The contact forces that joint torques generate (paper, Section III), and the primitives of a whole hand.

use nalgebra::SMatrix;

use super::contact::{Contact, ContactError, GraspError};
use super::frame::WrenchFrame;
use super::jacobian::Jacobian;
use super::primitive::Primitive;
use super::svd::Svd;
use crate::math::{Vector, dot};
use crate::scalar::Real;

/// The active forces of a contact, U^a = U ∩ range(J): { center + disc x : |x| <= 1 } in R^4, for unit normal force
/// (paper, eq. 10-15).
///
/// U is the set of f = S (1, x) with S = diag(1, mu, mu, mus/L) and |x| <= 1. With B an orthonormal basis of the
/// complement of range(J), f is active if B^T f = 0, linear equations for x: K x = -k, where K and k are the parts of
/// B^T S. Let x0 be their solution of least norm. Then, whatever the rank r of J,
///
/// * no solution: the joints cannot press along the normal within the friction model; U^a is empty;
/// * Delta = 1 - |x0|^2 < 0: they press, but outside of the friction cone; U^a is empty;
/// * Delta = 0: U^a is the point S (1, x0);
/// * Delta > 0: the disc x0 + sqrt(Delta) N y, |y| <= 1, with N an orthonormal basis of the null space of K.
///
/// Since |x|^2 is f^T D f of eq. 11b, Delta, f_0 = S (1, x0) and P = S N, up to a rotation, are those of eq. 14-15; but
/// mu and mus may be zero, and ranks 0 (empty), 1 and 4 (all of U, exactly the passive set) are no special cases.
///
/// Moments are divided by the torque scale L here, too: range(J) is that of J with its spin row times L.
///
/// ```
/// use qdist::{Vector, grasp::{ActiveForces, Contact, ContactError, Friction, Jacobian, WrenchFrame, default_tolerance}};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let soft = Friction::Soft { mu: 0.5, mus: 0.1 };
/// let contact = Contact::new(Vector::zeros(), Vector::from([0.0, 0.0, 1.0]), soft)?;
/// // Two joints that move the fingertip in the plane of n and o.
/// let planar = Jacobian::new([&[1.0, 0.3], &[0.2, 0.9], &[0.0, 0.0], &[0.0, 0.0]])?;
/// let active = ActiveForces::new(&contact, &planar, &frame, default_tolerance())?;
/// assert_eq!((active.rank(), active.dimension(), active.delta()), (2, Some(1), Some(1.0)));
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ActiveForces<T> {
    rank: usize,
    delta: Option<T>,
    /// `None`: empty.
    set: Option<(Vector<T, 4>, SMatrix<T, 4, 3>)>,
}

impl<T: Real> ActiveForces<T> {
    /// The active forces of `contact`, moved by `jacobian`.
    ///
    /// `tolerance`, usually [`default_tolerance`](super::default_tolerance), decides what counts as zero: singular
    /// values of J relative to the largest; how far a force with unit normal component may be from range(J); and Delta.
    /// A force that is outside of the friction cone by no more than that is drawn back into it.
    ///
    /// Cost: two singular value decompositions, of 4 x 8 and 4 x 3 numbers; about a microsecond on a desktop machine.
    ///
    /// # Errors
    /// [`ContactError::Tolerance`].
    pub fn new(
        contact: &Contact<T>,
        jacobian: &Jacobian<T>,
        frame: &WrenchFrame<T>,
        tolerance: T,
    ) -> Result<Self, ContactError> {
        let (rank, basis) = jacobian.range(frame.torque_scale(), tolerance)?;
        let radii = frame.friction_radii(contact);
        let widest = radii.iter().fold(T::zero(), |m, &x| m.at_least(x));
        // Without friction, or less than counts, x has no effect on f.
        let scale = if widest > tolerance { widest } else { T::one() };
        // The rows of B^T; those of range(J) are zero. K is divided by `scale`, so that x comes out times `scale`.
        let mut complement = basis;
        complement.iter_mut().take(rank).for_each(|row| *row = [T::zero(); 4]);
        let zero = T::zero();
        let column = |j: usize, radius: T| complement.map(|row| row[j] * (radius / scale));
        let [n, o, t] = radii.map(|radius| if widest > tolerance { radius } else { zero });
        let (k, matrix) = (complement.map(|row| row[0]), [column(1, n), column(2, o), column(3, t)]);
        let svd = Svd::new(matrix);
        // Column j of K V belongs to x = V_j: a null direction if it is zero, else it carries its share of -k.
        let (mut x0, mut rest, mut null) = ([zero; 3], k, [[zero; 3]; 3]);
        for j in 0..3 {
            let (image, direction, sigma) = (svd.image[j], svd.v[j], svd.sigma[j]);
            if sigma > tolerance {
                let share = -dot(&image, &k) / (sigma * sigma);
                rest = core::array::from_fn(|i| rest[i] + share * image[i]);
                x0 = core::array::from_fn(|i| x0[i] + share * direction[i]);
            } else {
                null[j] = direction;
            }
        }
        if !(dot(&rest, &rest).root() <= tolerance) {
            return Ok(Self { rank, delta: None, set: None });
        }
        let x0 = x0.map(|x| x / scale);
        let squared = dot(&x0, &x0);
        let delta = T::one() - squared;
        if !(delta >= -tolerance) {
            return Ok(Self { rank, delta: Some(delta), set: None });
        }
        let inside = if squared > T::one() { squared.root().recip() } else { T::one() };
        let [a, b, c] = x0.map(|x| x * inside);
        let width = if delta > tolerance { delta.root() } else { zero };
        let [mu, _, mus] = radii;
        let center = Vector::from([T::one(), mu * a, mu * b, mus * c]);
        let disc = null.map(|[a, b, c]| [zero, width * mu * a, width * mu * b, width * mus * c]);
        Ok(Self { rank, delta: Some(delta), set: Some((center, SMatrix::from(disc))) })
    }

    /// The rank r of the Jacobian, 0 to 4.
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Delta of eq. 14: 1 less the square of how much of the friction the force in the middle needs, at most 1.
    /// `None` when no force with a normal component is both active and possible in the friction model.
    pub fn delta(&self) -> Option<T> {
        self.delta
    }

    /// Center (1, f2, f3, f4) and disc for unit normal force, without the contact's force cap; moments divided by the
    /// torque scale. `None`: empty.
    pub fn set(&self) -> Option<(&Vector<T, 4>, &SMatrix<T, 4, 3>)> {
        self.set.as_ref().map(|(center, disc)| (center, disc))
    }

    /// The dimension of the disc, 0 (a point) to 3; `None`: empty.
    pub fn dimension(&self) -> Option<usize> {
        let (_, disc) = self.set()?;
        Some(disc.column_iter().filter(|column| column.iter().any(|x| !x.is_zero())).count())
    }

    /// Their wrenches, W^a of this contact: G(U^a) times the force cap.
    ///
    /// # Errors
    /// [`ContactError::Wrench`].
    pub fn primitive(&self, contact: &Contact<T>, frame: &WrenchFrame<T>) -> Result<Primitive<T>, ContactError> {
        match &self.set {
            Some((center, disc)) => Primitive::of_forces(contact, frame, center, disc),
            None => Ok(Primitive::empty()),
        }
    }
}

/// A contact of a hand: of a finger link with a Jacobian, or of the palm without, which is passive: it resists with
/// whatever force friction allows. A finger with several contacts has a Jacobian for each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandContact<T> {
    /// Where, and with how much friction.
    pub contact: Contact<T>,
    /// How the finger's joints move the contact; `None` for the palm.
    pub jacobian: Option<Jacobian<T>>,
}

/// The active primitives of a hand, into the front of `out`; the slice of them is returned. Palm contacts are passive.
///
/// Every contact is judged alone, against its own Jacobian. Where a finger has several contacts the set of them is an
/// upper estimate of what its joints can make together: see [`Finger`](super::Finger).
///
/// ```
/// use qdist::{Vector, grasp::*};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let soft = Friction::Soft { mu: 0.2, mus: 0.2 };
/// let planar = Jacobian::new([&[1.0, 0.4], &[0.3, 0.9], &[0.0, 0.0], &[0.0, 0.0]])?; // in the plane of n and o
/// let y = Vector::from([0.0, 1.0, 0.0]);
/// let finger = |x: f64| {
///     let n = Vector::from([-x.signum(), 0.0, 0.0]);
///     let contact = Contact::new(Vector::from([x, 0.0, 0.0]), n, soft)?.with_tangents(y, n.cross(&y))?;
///     Ok::<_, ContactError>(HandContact { contact, jacobian: Some(planar) })
/// };
/// let hand = [finger(-0.75)?, finger(1.3)?]; // row (a1) of the paper's Table I
/// let mut memory = [Primitive::empty(); 8];
/// let active = active_wrenches(&hand, &frame, default_tolerance(), &mut memory).unwrap();
/// assert_eq!(Subspace::new(active, default_tolerance())?.dimension(), 3);
/// # Ok::<(), ContactError>(())
/// ```
///
/// # Errors
/// [`ContactError::Tolerance`], [`ContactError::Wrench`]; [`ContactError::Room`] at the first contact for which `out`
/// has no room.
pub fn active_wrenches<'o, T: Real>(
    hand: &[HandContact<T>],
    frame: &WrenchFrame<T>,
    tolerance: T,
    out: &'o mut [Primitive<T>],
) -> Result<&'o [Primitive<T>], GraspError> {
    collect(hand, out, |HandContact { contact, jacobian }| match jacobian {
        Some(jacobian) => ActiveForces::new(contact, jacobian, frame, tolerance)?.primitive(contact, frame),
        None => Primitive::passive(contact, frame),
    })
}

/// The passive primitives of contacts, whoever makes the forces, into the front of `out`; the slice of them is returned.
///
/// # Errors
/// [`ContactError::Wrench`]; [`ContactError::Room`] at the first contact for which `out` has no room.
pub fn wrenches<'o, T: Real>(
    contacts: &[Contact<T>],
    frame: &WrenchFrame<T>,
    out: &'o mut [Primitive<T>],
) -> Result<&'o [Primitive<T>], GraspError> {
    collect(contacts, out, |contact| Primitive::passive(contact, frame))
}

fn collect<'o, C, T: Real>(
    contacts: &[C],
    out: &'o mut [Primitive<T>],
    primitive: impl Fn(&C) -> Result<Primitive<T>, ContactError>,
) -> Result<&'o [Primitive<T>], GraspError> {
    let room = out.len();
    let out = out.get_mut(..contacts.len()).ok_or(GraspError { contact: room, error: ContactError::Room })?;
    for (index, (to, contact)) in out.iter_mut().zip(contacts).enumerate() {
        *to = primitive(contact).map_err(|error| GraspError { contact: index, error })?;
    }
    Ok(out)
}
