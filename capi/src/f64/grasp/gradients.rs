//! GRADIENTS
//!
//! How d changes with what a grasp is made of, for planners that improve grasps. The weakest direction of a result is refined to rounding by
//! Newton's method, in some 10 to 100 microseconds (`./x figures`); where d has no gradient there, `kink` says why.

use super::*;

/// The weakest direction to rounding.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_refined_f64 {
    pub struct_size: u32,
    /// QDIST_KINK_NONE: d has a gradient. Else why it has none; `upper` and `direction` hold all the same.
    pub kink: qdist_kink,
    /// d is not more; not above that of the result. (`lower` stays as it is: only the result's bracket tells how far a deeper minimum may be.)
    pub upper: f64,
    /// The unit vector that proves `upper`.
    pub direction: [f64; 6],
}
gaps!(qdist_refined_f64);
versioned!(qdist_refined_f64);

/// The gradient of d with respect to one contact. Units: those of d over those of the parameter.
#[repr(C)]
pub struct qdist_contact_gradient_f64 {
    /// 0: there is none, and all numbers are 0: a kink, or a contact whose joints press on the very edge of its friction cone.
    pub known: u32,
    /// 0: not with respect to the Jacobian: there is none, or the active forces do not change smoothly with it.
    pub jacobian_known: u32,
    /// With respect to the position.
    pub position: [f64; 3],
    /// With respect to a small turn of n, o and t together, as a rotation vector.
    pub rotation: [f64; 3],
    /// With respect to the normal, along the unit sphere; o and t turn with it.
    pub normal: [f64; 3],
    /// With respect to mu and mus; 0 where the model has none.
    pub mu: f64,
    pub mus: f64,
    /// With respect to the force cap.
    pub force_cap: f64,
    /// With respect to the entries of the Jacobian.
    pub jacobian: [f64; 32],
}
gaps!(qdist_contact_gradient_f64);

/// The gradients of d with respect to `count` contacts, as many as there are primitives in `wrenches`, which were made of them with this frame and,
/// for active primitives (active: 1; passive: 0), this rank_tolerance. q (NULL: the unit ball) and result are those of the query; a relative
/// tolerance of 1e-2 is usually enough.
///
/// gradients: room for `count`.
///
/// Status: ARGUMENT (active is neither 0 nor 1; count is 0, or not that of wrenches; a flag of result), NONFINITE (a number of result), FRAME
/// (frame), TOLERANCE (rank_tolerance), those of qdist_set_wrenches (wrenches) and of a unit set (q); of a contact, as of qdist_primitives.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_grasp_gradients_f64(
    wrenches: In<qdist_wrenches_f64>,
    contacts: In<qdist_contact_f64>,
    count: u32,
    frame: In<qdist_wrench_frame_f64>,
    active: u32,
    rank_tolerance: f64,
    q: In<qdist_unit_f64>,
    result: In<qdist_result_f64>,
    refined: Out<qdist_refined_f64>,
    gradients: Out<qdist_contact_gradient_f64>,
    which: Out<u32>,
) -> qdist_status {
    status_of(|| {
        refined.checked()?;
        gradients.checked()?;
        which.optional()?;
        let active = flag(active)?;
        refined.known()?;
        let set = wrenches.get()?.checked()?;
        let contacts = contacts.array(Some(count as usize))?;
        let (frame, q) = (frame.get()?.checked()?, CheckedUnit::new::<6>(&q)?);
        let result = result.current()?;
        if set.contributions().len() != contacts.len() {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let found = Refined::new(&set, q.unit(), &to_answer(result)?);
        let gradient = |index: usize, contact: &qdist_contact_f64| {
            let hand = contact.of_hand()?;
            let hand = if active { hand } else { HandContact { jacobian: None, ..hand } };
            found.gradient(index, &hand, &frame, tolerance(rank_tolerance))
        };
        all_of(contacts, &which, gradient, |index, made| gradients.put_at(index, from_gradient(made.as_ref())))?;
        refined.put_version(qdist_refined_f64 {
            struct_size: size_of::<qdist_refined_f64>() as u32,
            kink: kink(found.kink),
            upper: found.answer.upper,
            direction: padded(found.answer.direction.iter().copied()),
        })
    })
}

fn from_gradient(gradient: Option<&ContactGradient<f64>>) -> qdist_contact_gradient_f64 {
    let mut made = qdist_contact_gradient_f64::ZERO;
    if let Some(gradient) = gradient {
        made.known = 1;
        made.position = gradient.position.into();
        made.rotation = gradient.rotation.into();
        made.normal = gradient.normal.into();
        (made.mu, made.mus, made.force_cap) = (gradient.mu, gradient.mus, gradient.force_cap);
        if let Some(rows) = &gradient.jacobian {
            made.jacobian_known = 1;
            let (slots, _) = made.jacobian.as_chunks_mut::<MAX_JOINTS>();
            slots.iter_mut().zip(rows).for_each(|(slot, row)| *slot = *row);
        }
    }
    made
}
