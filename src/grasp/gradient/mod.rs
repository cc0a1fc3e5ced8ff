//! The gradient of d with respect to what a grasp is made of.
//!
//! d is a minimum over directions u of a maximum over contact forces f (module `refine`). Where both are unique, the first-order
//! change of d is that of the objective at both as they are (the envelope theorem; Danskin, 1967):
//!
//! ```text
//! d' = Σ_i λ_i u . (G_i cap_i f_i)' / h_Q(u)
//! ```
//!
//! with the weakest direction u, the share λ_i of its full load that contact i carries there, its force f_i for a normal force of 1, as (normal, two
//! tangential, spin moment over L), its cap, and the map G_i of such forces to wrenches. L is the torque scale.
//!
//! # One contact
//!
//! f maximises h = g . f, where g = G^T u, over the contact's forces: f = S (1, x) with |x| <= 1, S = diag(1, mu, mu, mus/L), and, if joints of the Jacobian J
//! make them, f = J c for some c. f' is how that optimum moves as the set changes. The Lagrangian `g . f - y . (f - J c)` gives, at cap 1,
//!
//! ```text
//! dh/dp = F x b / L                                    (a, b) = u: force and moment; F = the force in space, r = (p - reference) / L
//! dh/dω = F x (a + b x r) + f4 n x b                   n, o, t turn together: n' = ω x n, ...
//! dh/dmu = (g - y)_{2,3} . x_{1,2}     dh/dmus = (g - y)_4 x_3 / L     dh/dcap = g . f
//! dh/dJ = y c^T,   c = J^+ f                           (the spin row times L)
//! ```
//!
//! The multiplier y is the price of staying in range(J), and orthogonal to it: y = B η, with the columns of B an orthonormal basis of the complement. A passive
//! contact has y = 0. At the maximum, the last three entries of S (g - y) are β x, where β is the multiplier of |x| <= 1; so η solves K^T η = (S g)_{2,3,4} - β x, where
//! K is what B^T S has for x. In terms of [`ActiveForces`], whose set is { center + disc z : |z| <= 1 }: β = |disc^T g| / Delta.
//!
//! # Where there is none
//!
//! The active set changes smoothly with a J of q joints only where its rank is min(4, q), so that no small change of J raises it, and K
//! has full row rank. Where Delta is 0 the disc opens like a square root, and nothing but d itself is known.

mod newton;
mod problem;
mod refine;
mod search;
mod ties;

pub use refine::{Kink, Refined, Share};

use super::contact::{Contact, ContactError};
use super::frame::WrenchFrame;
use super::hand::{ActiveForces, HandContact};
use super::jacobian::MAX_JOINTS;
use super::svd::Svd;
use crate::math::{Vector, dot, norm};
use crate::scalar::Real;

/// The gradient of d with respect to one contact. Units: those of d over those of the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactGradient<T> {
    /// With respect to the position.
    pub position: Vector<T, 3>,
    /// With respect to a small turn of n, o, t together, as a rotation vector in the frame of the contacts.
    pub rotation: Vector<T, 3>,
    /// With respect to the normal; tangent to the sphere, `rotation x n`: o and t turn along, without spin about n. (Passive
    /// contacts do not feel spin. For active ones whose tangents are derived from n, use `rotation`.)
    pub normal: Vector<T, 3>,
    /// With respect to the friction coefficient mu; 0 where the model has none.
    pub mu: T,
    /// With respect to mus; 0 where the model has none.
    pub mus: T,
    /// With respect to the force cap.
    pub force_cap: T,
    /// With respect to the entries of the Jacobian, row by row; zero from its number of joints on. `None`: no Jacobian, or
    /// the active forces do not change smoothly with it.
    pub jacobian: Option<[[T; MAX_JOINTS]; 4]>,
}

impl<T: Real> ContactGradient<T> {
    fn zero(jacobian: Option<[[T; MAX_JOINTS]; 4]>) -> Self {
        let (none, zero) = (Vector::zeros(), T::zero());
        Self { position: none, rotation: none, normal: none, mu: zero, mus: zero, force_cap: zero, jacobian }
    }

    /// With respect to position, rotation and normal, of `scale` times a contact force as it stands.
    fn of_motion(
        contact: &Contact<T>,
        frame: &WrenchFrame<T>,
        force: &Vector<T, 4>,
        u: &Vector<T, 6>,
        scale: T,
    ) -> Self {
        let ([o, t], n) = (contact.tangents(), contact.normal());
        let in_space = n * force[0] + o * force[1] + t * force[2];
        let (a, b) = (Vector::from([u[0], u[1], u[2]]), Vector::from([u[3], u[4], u[5]]));
        let arm = (contact.position() - frame.reference()).map(|x| x / frame.torque_scale());
        let rotation = (in_space.cross(&(a + b.cross(&arm))) + n.cross(&b) * force[3]) * scale;
        Self {
            position: in_space.cross(&b).map(|x| x / frame.torque_scale()) * scale,
            rotation,
            normal: rotation.cross(n),
            ..Self::zero(None)
        }
    }
}

/// What the equations K force = 0 of joints cost, K^T y for the y of the least squares solution; and how many of them count. `basis`: first of
/// range(J), `rank` rows, then of its complement; `target`: what the friction part of the price has to be.
fn price<T: Real>(basis: &[[T; 4]; 4], rank: usize, radii: &[T; 3], target: &[T; 3], tolerance: T) -> ([T; 4], usize) {
    let zero = T::zero();
    // The columns of K^T; those of range(J) are zero.
    let mut complement = *basis;
    complement.iter_mut().take(rank).for_each(|row| *row = [zero; 4]);
    let svd = Svd::new(complement.map(|row| core::array::from_fn::<T, 3, _>(|i| row[i + 1] * radii[i])));
    let [largest, ..] = svd.sigma;
    let full = svd.rank(tolerance * largest);
    let mut price = [zero; 4];
    for ((image, v), sigma) in svd.image.iter().zip(&svd.v).zip(svd.sigma).take(full) {
        let share = dot(image, target) / sigma / sigma;
        for (row, x) in complement.iter().zip(v) {
            price.iter_mut().zip(row).for_each(|(y, &b)| *y += share * *x * b);
        }
    }
    (price, full)
}

impl<T: Real> Refined<'_, T> {
    /// The gradient of d with respect to contact `index`, which is `hand`; the set's primitive of that index was made of it
    /// with this `frame` and `tolerance`. `None` where there is none: a [`kink`](Self::kink), no such contact, or a contact
    /// whose Delta is 0. All contacts that are not asked for stay as they are; gradients of several changes add up.
    ///
    /// Exact to rounding times the condition of the minimum. **Flat sets**: it is that of d in the span of W^a, for changes that
    /// keep its dimension; changes that do not, raise the dimension, and d is another question. For a ball the span may turn
    /// with the change, since the balance lies in it. For any other Q it must stay as it is.
    ///
    /// ```
    /// use qdist::grasp::*;
    /// use qdist::{Options, Vector, Workspace, qset::Ball};
    /// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
    /// let contact = |x: f64, y: f64, z: f64| {
    ///     let p = Vector::from([x, y, z]);
    ///     let contact = Contact::new(p, -p.normalize(), Friction::Soft { mu: 0.5, mus: 0.2 })?;
    ///     Ok::<_, ContactError>(HandContact { contact, jacobian: None })
    /// };
    /// let hand = [contact(1.0, 0.1, 0.2)?, contact(-0.4, 0.8, 0.1)?, contact(-0.5, -0.9, -0.2)?];
    /// let mut primitives = [Primitive::empty(); 3];
    /// let w = active_wrenches(&hand, &frame, default_tolerance(), &mut primitives).unwrap();
    /// let set = WrenchSet::new(w, Norm::L1);
    /// let mut memory = Workspace::<f64, 6, 2048, 2048>::new();
    /// let answer = memory.solver().solve(&set, &Ball::unit(), &Options { relative: 1e-2, ..Options::default() });
    /// let refined = Refined::new(&set, &Ball::unit(), &answer);
    /// let mut by_cap = 0.0;
    /// for (index, contact) in hand.iter().enumerate() {
    ///     let gradient = refined.gradient(index, contact, &frame, default_tolerance())?.unwrap();
    ///     assert!(gradient.mu >= 0.0); // more friction, a larger set
    ///     by_cap += gradient.force_cap;
    /// }
    /// assert!((by_cap - refined.answer.upper).abs() < 1e-9); // d is proportional to all caps
    /// # Ok::<(), ContactError>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Tolerance`].
    pub fn gradient(
        &self,
        index: usize,
        hand: &HandContact<T>,
        frame: &WrenchFrame<T>,
        tolerance: T,
    ) -> Result<Option<ContactGradient<T>>, ContactError> {
        let Some(share) = self.share(index) else { return Ok(None) };
        let (one, zero) = (T::one(), T::zero());
        let contact = &hand.contact;
        let radii = frame.friction_radii(contact);
        let [mu, _, mus] = radii;
        let x = &share.friction;
        let (force, active) = match &hand.jacobian {
            None => (Vector::from([one, mu * x[0], mu * x[1], mus * x[2]]), None),
            Some(jacobian) => {
                let active = ActiveForces::new(contact, jacobian, frame, tolerance)?;
                match (active.set(), active.delta()) {
                    (Some((center, disc)), Some(delta)) if delta > tolerance => {
                        (center + disc * x, Some((jacobian, active, delta)))
                    }
                    (None, Some(delta)) if delta >= -tolerance => return Ok(None),
                    (Some(_), _) => return Ok(None),
                    (None, _) => return Ok(Some(ContactGradient::zero(Some([[zero; MAX_JOINTS]; 4])))),
                }
            }
        };
        if share.weight.is_zero() {
            let jacobian = hand.jacobian.map(|_| [[zero; MAX_JOINTS]; 4]);
            return Ok(Some(ContactGradient::zero(jacobian)));
        }
        let g = frame.contact_map(contact).tr_mul(&self.answer.direction);
        let scale = contact.force_cap() * share.weight / self.answer.unit;
        // The force is S (1, used).
        let used: [T; 3] = core::array::from_fn(|i| if radii[i] > zero { force[i + 1] / radii[i] } else { zero });
        let (price, jacobian) = match active {
            None => (Vector::zeros(), None),
            Some((jacobian, active, delta)) => {
                let (rank, basis) = jacobian.range(frame.torque_scale(), tolerance)?;
                let beta = active.set().map_or(zero, |(_, disc)| norm(&disc.tr_mul(&g))) / delta;
                let target: [T; 3] = core::array::from_fn(|i| radii[i] * g[i + 1] - beta * used[i]);
                let (price, full) = price(&basis, rank, &radii, &target, tolerance);
                let generic = rank == jacobian.joints().min(4) && full + rank == 4;
                let by_jacobian = generic.then(|| {
                    let c = jacobian.pseudo_inverse(frame.torque_scale(), rank, &force.data.0[0]);
                    let [n, o, t, spin] = price.map(|y| c.map(|c| scale * y * c));
                    [n, o, t, spin.map(|x| x * frame.torque_scale())]
                });
                (Vector::from(price), by_jacobian)
            }
        };
        let rest: Vector<T, 4> = g - price;
        Ok(Some(ContactGradient {
            mu: (rest[1] * used[0] + rest[2] * used[1]) * scale,
            mus: rest[3] * used[2] * scale / frame.torque_scale(),
            force_cap: g.dot(&force) * share.weight / self.answer.unit,
            jacobian,
            ..ContactGradient::of_motion(contact, frame, &force, &self.answer.direction, scale)
        }))
    }
}
