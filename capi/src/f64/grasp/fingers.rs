//! FINGERS WITH TORQUE LIMITS
//!
//! A finger as a whole: up to four contacts that share their joints, whose torques have limits. What it can exert is the sum of its
//! contacts' wrenches over all contact forces (f_1, ..., f_k) within friction cones, force caps and |sum of J_i^T f_i| <= limits, joint by
//! joint; with QDIST_FORCE_MODEL_ACTIVE only those that the joints make at all contacts together. Its support function is a small convex
//! program, each time with a proof: 0.1 microseconds where the limits do not count, else some 10 for one contact to 130 for four (`./x figures`),
//! with up to 27 KB of stack in double (`./x stack`). Without limits a passive finger exerts what its contacts' primitives do; a palm is a finger without joints.

use super::*;
use core::borrow::Borrow;

/// A finger, made by qdist_finger_init. Plain bytes without addresses: it may be copied and moved.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_finger_f64 {
    /// Says that it is a finger.
    tag: u32,
    /// 1 to 4.
    contacts: u32,
    /// That of its frame.
    torque_scale: f64,
    /// Opaque.
    words: [u64; 577],
}

const _: () = assert!(MAX_CONTACTS == 4);
const _: () =
    assert!(size_of::<Finger<f64>>() <= size_of::<[u64; 577]>() && align_of::<Finger<f64>>() <= align_of::<u64>());

/// Differs between the scalar types.
const TAG: u32 = u32::from_le_bytes(*b"qdfi") ^ size_of::<f64>() as u32;

/// The wrench set of a list of fingers, 1 or more, with {0} in it. In QDIST_L1 the fingers share one supply; the contacts of one
/// finger do not. The list must outlive the sets that are made of it.
#[repr(C)]
pub struct qdist_finger_wrenches_f64 {
    pub fingers: In<qdist_finger_f64>,
    pub count: u32,
    /// QDIST_L1 or QDIST_LINF.
    pub norm: qdist_norm,
}

/// A finger that has passed the check, where it lies.
#[repr(transparent)]
pub(super) struct CheckedFinger(qdist_finger_f64);

impl CheckedFinger {
    fn list(list: &[qdist_finger_f64]) -> Check<&[Self]> {
        if list.iter().any(|finger| finger.tag != TAG) {
            return Err(QDIST_ERROR_FINGER);
        }
        // SAFETY: transparent.
        Ok(unsafe { core::slice::from_raw_parts(list.as_ptr().cast(), list.len()) })
    }

    fn finger(&self) -> &Finger<f64> {
        // SAFETY: what the header asks of the caller: a finger with the tag is as `qdist_finger_init` made it. Large and aligned enough.
        unsafe { &*self.0.words.as_ptr().cast() }
    }

    /// Forces of its contacts in units of force and force times position.
    fn in_units(&self, force: &Vector<f64, 4>) -> [f64; 4] {
        let [normal, o, t, spin] = (*force).into();
        [normal, o, t, spin * self.0.torque_scale]
    }
}

impl Borrow<Finger<f64>> for CheckedFinger {
    fn borrow(&self) -> &Finger<f64> {
        self.finger()
    }
}

impl Support<f64, 6> for CheckedFinger {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        self.finger().support(u)
    }
    fn extent(&self) -> f64 {
        self.finger().extent()
    }
    fn error(&self) -> f64 {
        self.finger().error()
    }
}

impl Contribution<f64> for CheckedFinger {
    fn support_above(&self, u: &Vector<f64, 6>, floor: f64) -> Result<Option<(f64, Vector<f64, 6>)>, Failure> {
        self.finger().support_above(u, floor)
    }
}

impl qdist_finger_wrenches_f64 {
    fn fingers(&self) -> Check<&[CheckedFinger]> {
        CheckedFinger::list(self.fingers.array(Some(self.count as usize))?)
    }
}

impl Wrenches for qdist_finger_wrenches_f64 {
    type Contribution<'a> = CheckedFinger;
    fn checked(&self) -> Check<WrenchSet<'_, f64, CheckedFinger>> {
        Ok(WrenchSet::new(self.fingers()?, checked_norm(self.norm)?))
    }
    fn unchecked(&self) -> Check<WrenchSet<'_, f64, CheckedFinger>> {
        Ok(WrenchSet::without_size(self.fingers()?, checked_norm(self.norm)?))
    }
}

/// Makes a finger of 1 to 4 contacts, all with Jacobians of the same joints, or all without (the palm).
///
/// limits: NULL: there are none; or the largest torque of each joint, not negative, INFINITY for none, in units of force times that of the
/// Jacobian's entries. The palm has none to read. model: QDIST_FORCE_MODEL_PASSIVE or QDIST_FORCE_MODEL_ACTIVE. rank_tolerance as for
/// qdist_primitives. QDIST_ERROR_CAPACITY: more than four contacts; QDIST_ERROR_CONTACT_JACOBIAN: also one of other joints than the first.
/// which: of QDIST_ERROR_TORQUE_LIMIT the index of the joint.
///
/// 5 microseconds where no limit counts; a millisecond or more, with 69 KB of stack in double, where there are limits and several contacts (`./x
/// figures`, `./x stack`).
///
/// Status: ARGUMENT (model, or count is 0), CAPACITY (count is above 4), FRAME (frame), TORQUE_LIMIT (limits), TOLERANCE (rank_tolerance); of a
/// contact, as of qdist_primitives; CONTACT_JACOBIAN also where its joints are not those of the first.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_finger_init_f64(
    finger: Out<qdist_finger_f64>,
    contacts: In<qdist_contact_f64>,
    count: u32,
    frame: In<qdist_wrench_frame_f64>,
    limits: In<f64>,
    model: qdist_force_model,
    rank_tolerance: f64,
    which: Out<u32>,
) -> qdist_status {
    status_of(|| {
        finger.checked()?;
        which.optional()?;
        let model = force_model(model)?;
        let (contacts, frame) = (contacts.array(Some(count as usize))?, frame.get()?.checked()?);
        let refuse = |contact: usize, error| from_grasp(GraspError { contact, error }, &which);

        let (x, zero) = (Vector::from([1.0, 0.0, 0.0]), Vector::zeros());
        let place = Contact::new(zero, x, Friction::Frictionless).map_err(|error| refuse(0, error))?;
        let mut list = [HandContact { contact: place, jacobian: None }; MAX_CONTACTS];
        for (index, contact) in contacts.iter().enumerate() {
            let to = list.get_mut(index).ok_or_else(|| refuse(index, ContactError::Room))?;
            *to = contact.of_hand().map_err(|error| refuse(index, error))?;
        }
        let list = list.get(..contacts.len()).unwrap_or_default();
        let joints = list.first().and_then(|first| first.jacobian).map_or(0, |jacobian| jacobian.joints());
        let limits = if limits.is_null() || joints == 0 {
            [f64::INFINITY; MAX_JOINTS].get(..joints).unwrap_or_default()
        } else {
            limits.array(Some(joints))?
        };
        let made = Finger::new(list, limits, model, &frame, tolerance(rank_tolerance)).map_err(|error| {
            let at = match error.error {
                ContactError::TorqueLimit { joint } => joint,
                _ => error.contact,
            };
            refuse(at, error.error)
        })?;
        write(&finger, count, frame.torque_scale(), made);
        Ok(())
    })
}

/// Writes a finger with all of its bytes: its own and zeros.
fn write(finger: &Out<qdist_finger_f64>, contacts: u32, torque_scale: f64, made: Finger<f64>) {
    let finger = finger.address();
    // SAFETY: the pointer has been checked; the words are large and aligned enough.
    unsafe {
        finger.write_bytes(0, 1);
        (&raw mut (*finger).tag).write(TAG);
        (&raw mut (*finger).contacts).write(contacts);
        (&raw mut (*finger).torque_scale).write(torque_scale);
        (&raw mut (*finger).words).cast::<Finger<f64>>().write(made);
    }
}

/// Makes a set of a list of fingers, for the same questions as that of primitives. Its `error` is larger by the precision of the programs.
///
/// Status: ARGUMENT (wrenches->norm, or count is 0), FINGER (one of wrenches->fingers), NONFINITE (all of them together are too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_finger_wrenches_f64(
    set: Out<qdist_set_f64>,
    wrenches: In<qdist_finger_wrenches_f64>,
) -> qdist_status {
    status(Wrenches::fill(set, wrenches))
}

/// The contact forces whose wrenches add up to the finger's farthest wrench along a direction, six numbers: force i is forces[4 * i] to
/// forces[4 * i + 3], as qdist_contact_force has it. `forces` has room for 4 * contacts numbers.
///
/// QDIST_ERROR_CALLBACK: the program was not solved (QDIST_CALLBACK_UNSOLVED); nothing was written.
///
/// Status: FINGER (finger), NONFINITE (direction), CALLBACK (finger).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_finger_forces_f64(
    finger: In<qdist_finger_f64>,
    direction: In<f64>,
    forces: Out<f64>,
) -> qdist_status {
    status_of(|| {
        forces.checked()?;
        let (list, u) = (CheckedFinger::list(finger.array(Some(1))?)?, direction.numbers::<6>()?);
        finite(&u)?;
        let forces = forces.rows::<[f64; 4]>();
        for finger in list {
            let found = finger.finger().forces(&Vector::from(u)).map_err(|_| QDIST_ERROR_CALLBACK)?;
            for (index, force) in found.iter().take(finger.finger().contacts()).enumerate() {
                forces.put_at(index, finger.in_units(force))?;
            }
        }
        Ok(())
    })
}

/// The smallest contact forces that keep the object in equilibrium with an external wrench, as qdist_contact_forces: share i is that of finger
/// i. Size is measured in force caps and torque limits together: forces of size 1 or less keep all of both.
///
/// forces: NULL; or room for 16 * count numbers: forces[16 * i + 4 * k] and the three after it become the force of contact k of finger i, as
/// qdist_contact_force has it; 0 for contacts that are not there. They keep friction, and `upper` times caps and limits.
///
/// The bracket is as wide as the error bound of the fingers makes it: in float ask for a relative gap of 1e-2.
///
/// Status: those of qdist_set_finger_wrenches (wrenches), and of qdist_contact_forces.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_finger_contact_forces_f64(
    wrenches: In<qdist_finger_wrenches_f64>,
    memory: Out<qdist_force_memory_f64>,
    external: In<f64>,
    options: In<qdist_force_options_f64>,
    shares: Out<f64>,
    forces: Out<f64>,
    result: Out<qdist_forces_f64>,
) -> qdist_status {
    status_of(|| {
        forces.optional()?;
        let wrenches = wrenches.get()?;
        let (fingers, set) = (wrenches.fingers()?, wrenches.checked()?);
        let rows = forces.rows::<[Vector<f64, 4>; MAX_CONTACTS]>();
        resist(&set, memory, external, options, shares, result, |solver| {
            if rows.is_null() {
                return Ok(());
            }
            let list = rows.zeroed(fingers.len()).map_err(Failure)?;
            solver.contact_forces(&set, list)?;
            for (own, finger) in list.iter_mut().zip(fingers) {
                own.iter_mut().for_each(|force| *force = finger.in_units(force).into());
            }
            Ok(())
        })
    })
}
