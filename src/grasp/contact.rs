//! One contact: where it touches, along what, and with how much friction.

use core::fmt;

use super::numbers::usable;
use crate::math::{Vector, unit};
use crate::scalar::Real;

/// Why a contact, or what belongs to it, is refused. In a list of contacts [`GraspError`] says which one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactError {
    /// A coordinate of the position is not finite or too large.
    Position,
    /// The normal is not a unit vector.
    Normal,
    /// The tangents are not unit vectors with n = o x t.
    Tangents,
    /// A friction coefficient is negative, not finite or too large.
    Friction,
    /// The force cap is negative, not finite or too large.
    ForceCap,
    /// The reference point is not finite, or the torque scale is not a positive number of usual size.
    Frame,
    /// A coordinate of a wrench is not finite or too large: a position or friction that is huge for the torque scale.
    Wrench,
    /// A Jacobian has rows of different lengths, too many joints, or a number that is not finite or too large.
    Jacobian,
    /// A coupling matrix does not fit the Jacobian's joints, or has a number that is not finite or too large.
    Coupling,
    /// A rank tolerance below 16 roundoffs or above 1/2.
    Tolerance,
    /// The list for the results is too short, or a finger has more contacts than [`MAX_CONTACTS`](super::MAX_CONTACTS).
    Room,
    /// The torque limit of a joint is negative or not a number, or there is not one limit for each joint. `contact` of a
    /// [`GraspError`] is then 0.
    TorqueLimit {
        /// Index of the joint, from 0; of a list of a wrong length, the first joint without limit or limit without joint.
        joint: usize,
    },
}

impl fmt::Display for ContactError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::TorqueLimit { joint } => {
                return write!(f, "the torque limit of joint {joint} is negative, or missing");
            }
            Self::Position => "the position is not finite or too large",
            Self::Normal => "the normal is not a unit vector",
            Self::Tangents => "the tangents are not unit vectors with n = o x t",
            Self::Friction => "a friction coefficient is negative, not finite or too large",
            Self::ForceCap => "the force cap is negative, not finite or too large",
            Self::Frame => "the reference point is not finite or the torque scale is not a positive number",
            Self::Wrench => "the wrench is too large for the torque scale",
            Self::Jacobian => "the Jacobian is not 4 x q with q <= 8 and finite entries",
            Self::Coupling => "the coupling matrix does not fit the Jacobian",
            Self::Tolerance => "the rank tolerance is out of range",
            Self::Room => "there is no room for the result",
        })
    }
}

impl core::error::Error for ContactError {}

/// What is wrong with a list of contacts, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GraspError {
    /// Index of the contact in its list, from 0.
    pub contact: usize,
    /// What is wrong with it.
    pub error: ContactError,
}

impl fmt::Display for GraspError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "contact {}: {}", self.contact, self.error)
    }
}

impl core::error::Error for GraspError {}

/// The friction of a contact (paper, eq. 1). Coefficients are >= 0; zero is the model above it in this list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction<T> {
    /// A normal force only: f2 = f3 = f4 = 0.
    Frictionless,
    /// A point with Coulomb friction: sqrt(f2^2 + f3^2) <= mu f1, f4 = 0.
    Hard {
        /// Tangential force per normal force.
        mu: T,
    },
    /// A soft finger: sqrt((f2^2 + f3^2) / mu^2 + f4^2 / mus^2) <= f1.
    Soft {
        /// Tangential force per normal force.
        mu: T,
        /// Spin moment per normal force: a length, in the unit of the position.
        mus: T,
    },
}

impl<T: Real> Friction<T> {
    /// (mu, mus), with 0 for what the model does not have.
    ///
    /// ```
    /// assert_eq!(qdist::grasp::Friction::Hard { mu: 0.5 }.coefficients(), (0.5, 0.0));
    /// ```
    pub fn coefficients(&self) -> (T, T) {
        match *self {
            Self::Frictionless => (T::zero(), T::zero()),
            Self::Hard { mu } => (mu, T::zero()),
            Self::Soft { mu, mus } => (mu, mus),
        }
    }
}

/// A contact between finger or palm and object, in a frame of the caller's choice.
///
/// The numbers count as they are given: a normal or tangent may be off unit length, and off the right angle, by
/// rounding, up to 1e-6 (`f64`) or 1e-4 (`f32`), and is not corrected.
///
/// ```
/// use qdist::{Vector, grasp::{Contact, ContactError, Friction}};
/// let (p, n) = (Vector::from([0.0, 0.0, 0.1]), Vector::from([0.0, 0.0, -1.0]));
/// let contact = Contact::new(p, n, Friction::Hard { mu: 0.6 })?.with_force_cap(20.0)?;
/// assert_eq!(contact.tangents()[0].cross(&contact.tangents()[1]), n);
/// assert_eq!(Contact::new(p, n * 2.0, Friction::Hard { mu: 0.6 }), Err(ContactError::Normal));
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<T> {
    position: Vector<T, 3>,
    normal: Vector<T, 3>,
    tangents: [Vector<T, 3>; 2],
    friction: Friction<T>,
    force_cap: T,
}

impl<T: Real> Contact<T> {
    /// A contact at `position`, a length in any unit, with the unit `normal` that points into the object.
    ///
    /// Tangents are derived: o = e x n / |e x n| with e the coordinate axis that is farthest from n (the first of several),
    /// and t = n x o. A mirrored normal (coordinates with other signs) gets mirrored tangents, up to sign. They matter only
    /// to a Jacobian, whose rows refer to them.
    ///
    /// # Errors
    /// [`ContactError::Position`], [`ContactError::Normal`], [`ContactError::Friction`].
    pub fn new(position: Vector<T, 3>, normal: Vector<T, 3>, friction: Friction<T>) -> Result<Self, ContactError> {
        if !usable(position.iter()) {
            return Err(ContactError::Position);
        }
        if !near(normal.dot(&normal), T::one()) {
            return Err(ContactError::Normal);
        }
        let (mu, mus) = friction.coefficients();
        if !(mu >= T::zero() && mus >= T::zero() && usable([mu, mus].iter())) {
            return Err(ContactError::Friction);
        }
        let tangents = derived_tangents(&normal);
        Ok(Self { position, normal, tangents, friction, force_cap: T::one() })
    }

    /// The same contact with the unit tangents `o` and `t`, where n = o x t.
    ///
    /// # Errors
    /// [`ContactError::Tangents`].
    pub fn with_tangents(self, o: Vector<T, 3>, t: Vector<T, 3>) -> Result<Self, ContactError> {
        let off = o.cross(&t) - self.normal;
        let fits = near(o.dot(&o), T::one()) && near(t.dot(&t), T::one()) && near(o.dot(&t), T::zero());
        if !(fits && off.iter().all(|&x| near(x, T::zero()))) {
            return Err(ContactError::Tangents);
        }
        Ok(Self { tangents: [o, t], ..self })
    }

    /// The same contact with the largest normal force `cap` >= 0, 1 otherwise: the "unit force" of this contact.
    ///
    /// # Errors
    /// [`ContactError::ForceCap`].
    pub fn with_force_cap(self, cap: T) -> Result<Self, ContactError> {
        if !(cap >= T::zero() && usable([cap].iter())) {
            return Err(ContactError::ForceCap);
        }
        Ok(Self { force_cap: cap, ..self })
    }

    /// Position p.
    pub fn position(&self) -> &Vector<T, 3> {
        &self.position
    }

    /// Unit normal n, into the object.
    pub fn normal(&self) -> &Vector<T, 3> {
        &self.normal
    }

    /// Unit tangents o and t; n = o x t.
    pub fn tangents(&self) -> &[Vector<T, 3>; 2] {
        &self.tangents
    }

    /// The friction model.
    pub fn friction(&self) -> Friction<T> {
        self.friction
    }

    /// The largest normal force.
    pub fn force_cap(&self) -> T {
        self.force_cap
    }
}

/// Equal to within what a unit vector may be off.
fn near<T: Real>(a: T, b: T) -> bool {
    (a - b).abs() <= T::RELATIVE_TOLERANCE
}

fn derived_tangents<T: Real>(n: &Vector<T, 3>) -> [Vector<T, 3>; 2] {
    let (x, y, z) = (n.x.abs(), n.y.abs(), n.z.abs());
    let zero = T::zero();
    let across = if x <= y && x <= z {
        Vector::from([zero, -n.z, n.y])
    } else if y <= z {
        Vector::from([n.z, zero, -n.x])
    } else {
        Vector::from([-n.y, n.x, zero])
    };
    let o = unit(&across);
    [o, n.cross(&o)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_normals() -> impl Iterator<Item = Vector<f64, 3>> {
        let mut s = 7u64;
        let mut next = move || {
            s = s.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (s >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let axes = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [1.0, 1.0, 1.0]];
        let random = core::iter::repeat_with(move || [next(), next(), next()]).take(1000);
        axes.into_iter().chain(random).map(|n| Vector::from(n).normalize())
    }

    #[test]
    fn derived_tangents_are_orthonormal_and_mirror() {
        for n in unit_normals() {
            let [o, t] = derived_tangents(&n);
            assert!((o.cross(&t) - n).amax() < 8e-16 && (o.norm() - 1.0).abs() < 4e-16, "{n}");
            for flips in 0..8 {
                let flip = |v: Vector<f64, 3>| v.map_with_location(|i, _, x| if flips >> i & 1 == 1 { -x } else { x });
                for (a, b) in derived_tangents(&flip(n)).into_iter().zip([o, t]) {
                    assert!(a == flip(b) || a == -flip(b), "{n} {flips}");
                }
            }
        }
    }

    #[test]
    fn bad_numbers_are_named() {
        let (p, n) = (Vector::zeros(), Vector::from([0.0, 0.0, 1.0]));
        let hard = Friction::Hard { mu: 0.5 };
        for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e200] {
            for i in 0..3 {
                let mut v = p;
                v[i] = bad;
                assert_eq!(Contact::new(v, n, hard), Err(ContactError::Position));
                let mut v = n;
                v[i] = bad;
                assert_eq!(Contact::new(p, v, hard), Err(ContactError::Normal));
                let contact = Contact::new(p, n, hard).unwrap();
                assert_eq!(contact.with_tangents(v, v), Err(ContactError::Tangents));
            }
            for friction in [
                Friction::Hard { mu: bad },
                Friction::Soft { mu: bad, mus: 0.1 },
                Friction::Soft { mu: 0.1, mus: bad },
                Friction::Soft { mu: 0.1, mus: -1e-300 },
            ] {
                assert_eq!(Contact::new(p, n, friction), Err(ContactError::Friction));
            }
            assert_eq!(Contact::new(p, n, hard).unwrap().with_force_cap(bad), Err(ContactError::ForceCap));
        }
        assert_eq!(Contact::new(p, n * 1.001, hard), Err(ContactError::Normal));
        assert_eq!(Contact::new(p, p, hard), Err(ContactError::Normal));
        let contact = Contact::new(p, n, hard).unwrap();
        let (x, y) = (Vector::from([1.0, 0.0, 0.0]), Vector::from([0.0, 1.0, 0.0]));
        assert!(contact.with_tangents(x, y).is_ok());
        assert_eq!(contact.with_tangents(y, x), Err(ContactError::Tangents));
        assert_eq!(contact.with_tangents(x, x), Err(ContactError::Tangents));
        assert_eq!(contact.with_force_cap(-1.0), Err(ContactError::ForceCap));
        let error = GraspError { contact: 3, error: ContactError::Normal };
        assert_eq!(std::format!("{error}"), "contact 3: the normal is not a unit vector");
    }
}
