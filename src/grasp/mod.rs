//! Grasps: contacts, friction, wrench sets, and what the joints of a hand can do about them.
//!
//! A hand holds an object at m contacts. The wrenches that it can resist with contact forces of unit size form a convex
//! set W around the origin of R^6; how far the origin is inside W, measured by a set Q of wrenches of interest, is the
//! *grasp force efficiency* d_Q(W) (paper, Section II, eq. 8). The *active* efficiency d_Q(W^a) counts only the forces
//! that joint torques generate (Section III). Here W and W^a become a [`Support`](crate::support::Support), with
//! support function and mapping in closed form; the solver does the rest.
//!
//! ```
//! use qdist::grasp::{Contact, Friction, Norm, Primitive, WrenchFrame, WrenchSet};
//! use qdist::{Options, Vector, Workspace, qset::Segment};
//!
//! // Two soft fingertips pinch a block along x: positions and torque scale in metres, forces in newtons.
//! let rubber = Friction::Soft { mu: 0.5, mus: 0.01 };
//! let frame = WrenchFrame::new(Vector::zeros(), 0.05)?; // about the centre of mass; 1 N counts as much as 0.05 N m
//! let left = Contact::new(Vector::from([-0.03, 0.0, 0.0]), Vector::from([1.0, 0.0, 0.0]), rubber)?;
//! let right = Contact::new(Vector::from([0.03, 0.0, 0.0]), Vector::from([-1.0, 0.0, 0.0]), rubber)?;
//! let primitives = [Primitive::passive(&left, &frame)?, Primitive::passive(&right, &frame)?];
//! let w = WrenchSet::new(&primitives, Norm::LInf);
//!
//! // How much weight can it hold when neither finger presses with more than 1 N? Friction bears 2 * 0.5 N.
//! let weight = Segment::new(Vector::from([0.0, 0.0, -1.0, 0.0, 0.0, 0.0])).unwrap();
//! let mut memory = Workspace::<f64, 6, 64, 1024>::new();
//! let answer = memory.solver().solve(&w, &weight, &Options { relative: 1e-3, ..Options::default() });
//! assert!(answer.lower <= 1.0 && 1.0 <= answer.upper + 1e-12);
//! # Ok::<(), qdist::grasp::ContactError>(())
//! ```
//!
//! # Conventions
//!
//! * A contact has a position p, the unit normal n that points **into the object**, and unit tangents o, t with n = o x t,
//!   all in one frame of the caller's choice ([`Contact`]).
//! * A contact force f = (f1, f2, f3, f4) has components along n, o, t and a spin moment about n. The wrench that it
//!   exerts on the object is G f (eq. 2); the external wrench that it resists is -G f.
//! * A wrench is (force, moment / L): moments about the reference point, divided by a torque scale L > 0, a
//!   characteristic length ([`WrenchFrame`]). Then all six coordinates are forces, and lengths in R^6 have a meaning.
//!   Every Euclidean statement depends on L: d for a ball, and also *which* forces count as active, since the
//!   pseudo-inverse in eq. 9 weighs moments against forces.
//! * Friction (eq. 1): sqrt((f2^2 + f3^2)/mu^2 + f4^2/mus^2) <= f1. A hard finger has f4 = 0, a frictionless contact
//!   f2 = f3 = f4 = 0. mu has no unit, mus is a length ([`Friction`]).
//! * Size of a set of contact forces (eq. 4), with c_i the contact's force cap, 1 unless stated: L-infinity
//!   `max f_i1 / c_i`, every contact has its own limit; L1 `sum f_i1 / c_i`, all share one ([`Norm`]).
//!
//! # The sets
//!
//! The forces of contact i with f1 = c_i form a disc of at most three dimensions, U_i (eq. 7). Its wrenches
//! `W_i = G_i U_i = { center + disc x : |x| <= 1 }` are a [`Primitive`], with h_i(u) = center.u + |disc^T u|. Then
//! ([`WrenchSet`])
//!
//! ```text
//! W_L1   = hull({0} ∪ W_1 ∪ ... ∪ W_m)                   h = max(0, h_1, ..., h_m)
//! W_Linf = hull({0} ∪ W_1) + ... + hull({0} ∪ W_m)       h = max(0, h_1) + ... + max(0, h_m)
//! ```
//!
//! **{0} belongs to every primitive.** Read literally, eq. 5 adds sets in which every contact presses with full force.
//! That misses the forces below the limit, and contradicts the paper's own row (a5) of Table I, 1.0000, which two
//! fingers that press with equal forces could not give. The formulas above are those of eq. 3 with ||f|| <= 1.
//!
//! The active set U_i^a = U_i ∩ range(J_i) (Section III, eq. 9-15) is again such a disc, of fewer dimensions, a point,
//! or empty ([`ActiveForces`]); a contact without Jacobian, the palm, keeps U_i ([`HandContact`]). W^a may be flat:
//! [`Subspace`] finds the smallest subspace R that contains it.
//!
//! A finger as a whole is a [`Finger`]: its contacts share the joints, whose torques have limits. The tuples of its
//! contact forces
//!
//! ```text
//! F = { (f_1, ..., f_k) : f_i in its friction cone, f_i1 <= c_i, |sum J_i^T f_i| <= tau }        W_finger = sum G_i F
//! ```
//!
//! are a convex set that contains 0. Actively, the tuple is also in the range of the Jacobians on top of each other:
//! the torques of the joints make all its forces *together* (eq. 9-10 for several contacts). Without limits and with
//! one contact W_finger is hull({0} ∪ W_i) or hull({0} ∪ W_i^a). It has no closed form in general; its support
//! function is the value of a small convex program, each time with a proof that the point is as good as promised.
//! [`WrenchSet`] takes fingers instead of primitives:
//!
//! ```text
//! W_Linf(tau) = W_finger 1 + ... + W_finger m        W_L1(tau) = hull(W_finger 1 ∪ ... ∪ W_finger m)
//! ```
//!
//! In L1 the fingers share one supply, the contacts of one finger do not.
//!
//! W^a of a hand whose fingers have several contacts is that of its active fingers. [`active_wrenches`] judges
//! contacts one by one, each against its own Jacobian, as if the others did not need the joints. It is in closed form
//! and some hundred times faster; of fingers with one contact it is W^a, of others an upper estimate.
//!
//! # Beside d
//!
//! * [`Refined`]: the weakest direction to rounding, what each contact carries there ([`Share`]), and the gradient of d with
//!   respect to each contact ([`ContactGradient`]), or why there is none ([`Kink`]).
//! * [`fn@linearized`]: friction pyramids instead of cones, as other tools have them ([`Preset`]): their number beside the exact one.
//! * [`Closure`]: is the grasp force-closed? Yes or no, with a ball in W or a direction that separates; or undecided, next to rounding.
//!   [`Best`](crate::Best): the best of many grasps.
//! * [`ForceSolver`]: the smallest contact forces that resist one given wrench, in microseconds: the same question with a segment for
//!   Q, and the shares of all contacts as its answer.
//!
//! # What is not modelled
//!
//! * Compliance and dynamics: links, fingertips and object are rigid and at rest.
//! * Joints that several fingers share, and limits that are not symmetric, such as those of a tendon that only pulls.
//! * Which of many possible contact forces a passive finger really has: its structure may bear anything that friction permits.
//!
//! # Failure
//!
//! What cannot be a contact is refused when it is built, with a [`ContactError`]; lists name the index of the contact
//! ([`GraspError`]). A grasp that does not hold the object is not an error: its d is 0. Nothing here allocates or panics.
//!
//! # Sources
//!
//! The paper's Sections II and III. R. M. Murray, Z. X. Li, S. S. Sastry, *A Mathematical Introduction to Robotic
//! Manipulation*, 1994 (contact maps, friction models). J. Demmel and K. Veselic, *Jacobi's method is more accurate
//! than QR*, 1992 (the SVD). L. Vandenberghe, *The CVXOPT linear and quadratic cone program solvers*, 2010 (fingers).

mod closure;
mod contact;
mod contribution;
mod finger;
pub(crate) mod forces;
mod frame;
mod gradient;
mod hand;
mod jacobian;
pub(crate) mod linearized;
pub(crate) mod numbers;
mod primitive;
mod span;
mod svd;
mod wrench_set;

pub use closure::Closure;
pub use contact::{Contact, ContactError, Friction, GraspError};
pub use contribution::Contribution;
pub use finger::{Finger, ForceModel, MAX_CONTACTS, UNSOLVED};
pub use forces::{ForceError, ForceOptions, ForceOutcome, ForceSolver, Forces};
pub use frame::WrenchFrame;
pub use gradient::{ContactGradient, Kink, Refined, Share};
pub use hand::{ActiveForces, HandContact, active_wrenches, wrenches};
pub use jacobian::{Jacobian, MAX_JOINTS};
pub use linearized::{Layout, Preset, PyramidalCone, linearized, min_weight, opposed_mean};
pub use numbers::default_tolerance;
pub use primitive::Primitive;
pub use span::Subspace;
pub use wrench_set::{Norm, WrenchSet};
