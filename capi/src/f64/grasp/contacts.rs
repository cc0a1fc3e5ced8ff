//! CONTACTS AND FINGERS
//!
//! A contact force f = (f1, f2, f3, f4) has components along the normal n, the tangents o and t, and a spin moment about n. Contacts become
//! primitives: the wrenches that one contact can exert on the object with its full normal force. A contact of a finger link has a
//! Jacobian; its active primitive counts only forces that joint torques generate. One of the palm has none, and keeps all.

use super::*;
use qdist::internal::usable;

const _: () = assert!(MAX_JOINTS == 8);

/// A contact, in one frame of your choice. Start with `= {0}`: what is zero takes its default.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_contact_f64 {
    /// Where it touches: a length.
    pub position: [f64; 3],
    /// The unit normal n, into the object.
    pub normal: [f64; 3],
    /// The unit tangents, o and then t, with n = o x t. All zero: derived from n. They matter only to a Jacobian and to contact forces.
    pub tangents: [f64; 6],
    /// Tangential force per normal force.
    pub mu: f64,
    /// Spin moment per normal force: a length.
    pub mus: f64,
    /// The largest normal force; 0: 1. (A contact that is not there has no place in the list.)
    pub force_cap: f64,
    /// QDIST_FRICTIONLESS, QDIST_HARD or QDIST_SOFT.
    pub friction: qdist_friction,
    /// 1: a contact of a finger, with a Jacobian; 0: of the palm.
    pub actuated: u32,
    /// Joints of the finger, 0 to 8.
    pub joints: u32,
    /// jacobian[8 * row + joint]: what a unit of joint velocity does to the finger at the contact: its velocity along n, o and t, and its
    /// angular velocity about n. Joint torques are J^T f. Locked joints have no column; joints that one actuator drives together share one.
    pub jacobian: [f64; 32],
}
gaps!(qdist_contact_f64, joints..jacobian);

/// Wrenches are (force, moment about `reference` / `torque_scale`).
#[repr(C)]
pub struct qdist_wrench_frame_f64 {
    /// Usually the centre of mass.
    pub reference: [f64; 3],
    /// A length > 0, usually the object's radius about the reference: what makes moments comparable to forces. 1: moments as they are.
    pub torque_scale: f64,
}

/// The wrenches of one contact at full normal force, { center + disc x : |x| <= 1 }. Plain numbers; made by the functions below.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_primitive_f64 {
    /// Of a contact without friction the only wrench.
    pub center: [f64; 6],
    /// disc[6 * column + row].
    pub disc: [f64; 18],
    /// How far rounding may have moved each coordinate of them.
    pub rounding: [f64; 6],
    /// 1: the contact can exert nothing.
    pub empty: u32,
}
gaps!(qdist_primitive_f64, empty..);

/// What the joints of a finger can do about a contact.
#[repr(C)]
pub struct qdist_active_f64 {
    /// The rank of the Jacobian, 0 to 4.
    pub rank: u32,
    /// 1: the joints can press within friction.
    pub can_press: u32,
    /// The dimension of the set of active forces with unit normal force, 0 (one force) to 3.
    pub dimension: u32,
    /// 1 less the square of the friction that the force in the middle needs; below 0: the joints press outside of the friction cone.
    pub delta: f64,
}
gaps!(qdist_active_f64, dimension..delta);

impl qdist_contact_f64 {
    pub(super) fn checked(&self) -> Result<Contact<f64>, ContactError> {
        let (mu, mus) = (self.mu, self.mus);
        let friction = match self.friction {
            QDIST_FRICTIONLESS => Friction::Frictionless,
            QDIST_HARD => Friction::Hard { mu },
            QDIST_SOFT => Friction::Soft { mu, mus },
            _ => return Err(ContactError::Friction),
        };
        let contact = Contact::new(Vector::from(self.position), Vector::from(self.normal), friction)?;
        let [a, b, c, d, e, f] = self.tangents;
        let contact = if self.tangents == [0.0; 6] {
            contact
        } else {
            contact.with_tangents(Vector::from([a, b, c]), Vector::from([d, e, f]))?
        };
        if self.force_cap == 0.0 { Ok(contact) } else { contact.with_force_cap(self.force_cap) }
    }

    /// The contact with its finger.
    pub(super) fn of_hand(&self) -> Result<HandContact<f64>, ContactError> {
        let contact = self.checked()?;
        let jacobian = if flag(self.actuated).map_err(|_| ContactError::Jacobian)? {
            let (rows, _) = self.jacobian.as_chunks::<8>();
            let row =
                |i: usize| rows.get(i).and_then(|row| row.get(..self.joints as usize)).ok_or(ContactError::Jacobian);
            Some(Jacobian::new([row(0)?, row(1)?, row(2)?, row(3)?])?)
        } else {
            None
        };
        Ok(HandContact { contact, jacobian })
    }
}

impl qdist_wrench_frame_f64 {
    pub(super) fn checked(&self) -> Check<WrenchFrame<f64>> {
        WrenchFrame::new(Vector::from(self.reference), self.torque_scale).map_err(from_contact)
    }
}

// The library's own struct.
const _: () = assert!(size_of::<qdist_primitive_f64>() == size_of::<Primitive<f64>>());
const _: () = assert!(align_of::<qdist_primitive_f64>() == align_of::<Primitive<f64>>());

impl qdist_primitive_f64 {
    /// The list, with all numbers checked: finite, and as small as those of contacts.
    pub(super) fn checked(list: &[Self]) -> Check<&[Primitive<f64>]> {
        for primitive in list {
            let numbers = primitive.center.iter().chain(&primitive.disc).chain(&primitive.rounding);
            if !usable(numbers) {
                return Err(QDIST_ERROR_CONTACT_WRENCH);
            }
            lengths(primitive.rounding)?;
            flag(primitive.empty)?;
        }
        Ok(Self::list(list))
    }

    /// As C has it.
    fn of(primitive: &Primitive<f64>) -> Self {
        // SAFETY: asserted above; both are `repr(C)` with the same numbers in the same order.
        unsafe { core::ptr::from_ref(primitive).cast::<Self>().read() }
    }

    /// Unchecked: numbers that are none end a query.
    pub(super) fn list(list: &[Self]) -> &[Primitive<f64>] {
        // SAFETY: asserted above; both are `repr(C)` with the same numbers in the same order, of which any bits are legal.
        unsafe { core::slice::from_raw_parts(list.as_ptr().cast(), list.len()) }
    }
}

/// 0 stands for the default.
pub(super) fn tolerance(tolerance: f64) -> f64 {
    if tolerance == 0.0 { default_tolerance() } else { tolerance }
}

/// Primitives of `count` contacts. active: 0: whoever generates the forces, joints or the structure; 1: of the forces that joint torques generate,
/// for contacts of fingers, and of all forces, for those of the palm. `primitives` has room for as many.
///
/// rank_tolerance: for active primitives, decides what counts as zero: singular values of a Jacobian relative to the largest, and how far a force
/// may be from what the joints generate. 0: 1e-9 (float: 4e-6).
///
/// Status: ARGUMENT (active is neither 0 nor 1, or count is 0), FRAME (frame), TOLERANCE (rank_tolerance, where a contact has a Jacobian that
/// counts); of a contact, which `which` names: CONTACT_POSITION, CONTACT_NORMAL, CONTACT_TANGENTS, CONTACT_FRICTION (friction, mu or mus),
/// CONTACT_CAP, CONTACT_WRENCH; with active also CONTACT_JACOBIAN (actuated, joints or jacobian).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_primitives_f64(
    contacts: In<qdist_contact_f64>,
    count: u32,
    frame: In<qdist_wrench_frame_f64>,
    active: u32,
    rank_tolerance: f64,
    primitives: Out<qdist_primitive_f64>,
    which: Out<u32>,
) -> qdist_status {
    status_of(|| {
        primitives.checked()?;
        which.optional()?;
        let active = flag(active)?;
        let (contacts, frame) = (contacts.array(Some(count as usize))?, frame.get()?.checked()?);
        let primitive = |_: usize, contact: &qdist_contact_f64| {
            if !active {
                return Primitive::passive(&contact.checked()?, &frame);
            }
            let HandContact { contact, jacobian } = contact.of_hand()?;
            let Some(jacobian) = jacobian else { return Primitive::passive(&contact, &frame) };
            ActiveForces::new(&contact, &jacobian, &frame, tolerance(rank_tolerance))?.primitive(&contact, &frame)
        };
        all_of(contacts, &which, primitive, |index, made| primitives.put_at(index, qdist_primitive_f64::of(&made)))
    })
}

/// What the joints of a finger can do about its contact: rank, and the shape of the set of active forces. rank_tolerance as above.
///
/// Status: FRAME (frame), ARGUMENT (contact->actuated is 0), TOLERANCE (rank_tolerance); of the contact, as of qdist_primitives.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_active_forces_f64(
    contact: In<qdist_contact_f64>,
    frame: In<qdist_wrench_frame_f64>,
    rank_tolerance: f64,
    active: Out<qdist_active_f64>,
) -> qdist_status {
    status_of(|| {
        active.checked()?;
        let (contact, frame) = (contact.get()?, frame.get()?.checked()?);
        let HandContact { contact, jacobian } = contact.of_hand().map_err(from_contact)?;
        let jacobian = jacobian.ok_or(QDIST_ERROR_ARGUMENT)?;
        let forces = ActiveForces::new(&contact, &jacobian, &frame, tolerance(rank_tolerance)).map_err(from_contact)?;
        active.put(qdist_active_f64 {
            rank: forces.rank() as u32,
            can_press: u32::from(forces.dimension().is_some()),
            dimension: forces.dimension().unwrap_or(0) as u32,
            delta: forces.delta().unwrap_or(-1.0),
        })
    })
}

/// The smallest subspace of R^6 that contains the wrenches of `count` primitives: its dimension, 0 to 6, and an orthonormal basis: coordinate k
/// of vector j is basis[6 * j + k]. Unused vectors are 0.
///
/// rank_tolerance: of singular values relative to the largest, each direction having length 1; 0: 1e-9 (float: 4e-6).
///
/// Status: ARGUMENT (count is 0, an `empty` is neither 0 nor 1, or a `rounding` is negative), CONTACT_WRENCH (a number of a primitive), TOLERANCE
/// (rank_tolerance).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_wrench_subspace_f64(
    primitives: In<qdist_primitive_f64>,
    count: u32,
    rank_tolerance: f64,
    dimension: Out<u32>,
    basis: Out<f64>,
) -> qdist_status {
    status_of(|| {
        dimension.checked()?;
        basis.checked()?;
        let list = qdist_primitive_f64::checked(primitives.array(Some(count as usize))?)?;
        let found = Subspace::new(list, tolerance(rank_tolerance)).map_err(from_contact)?;
        let axes = found.basis().iter().flatten().copied();
        for (index, x) in axes.chain(core::iter::repeat(0.0)).take(36).enumerate() {
            basis.put_at(index, x)?;
        }
        dimension.put(found.dimension() as u32)
    })
}
