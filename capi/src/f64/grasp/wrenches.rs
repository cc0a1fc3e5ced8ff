//! WRENCH SETS
//!
//! The wrenches that a grasp can exert on the object with contact forces of size up to 1: a set of dimension 6, for qdist_solve6 with
//! any Q. The external wrench that it resists is the negative. qdist_solve6 gives the force efficiency d of the grasp; qdist_solve_in_span that
//! in the smallest subspace, for the active wrenches of fingers that cannot move in all directions; a segment as Q asks how large one wrench
//! may be. In the result, `direction` is the weakest one, and the wrench of d * Q that is farthest along it the one that is hardest to exert.

use super::*;

/// The wrench set of a list of primitives, 1 or more, with {0} in it. The list must outlive the sets that are made of it.
#[repr(C)]
pub struct qdist_wrenches_f64 {
    pub primitives: In<qdist_primitive_f64>,
    pub count: u32,
    /// QDIST_L1 or QDIST_LINF.
    pub norm: qdist_norm,
}

/// A struct of a list and a norm: the wrench set of what is in the list.
pub(super) trait Wrenches: 'static {
    type Contribution<'a>: Contribution<f64>;
    /// The set, of a list that has been looked at.
    fn checked(&self) -> Check<WrenchSet<'_, f64, Self::Contribution<'_>>>;
    /// The same without what takes a pass over the numbers.
    fn unchecked(&self) -> Check<WrenchSet<'_, f64, Self::Contribution<'_>>>;
    /// Is the set certainly its own mirror image?
    fn mirrored(&self, _signs: u8) -> bool {
        false
    }

    /// Makes a set of it.
    fn fill(set: Out<qdist_set_f64>, wrenches: In<Self>) -> Check
    where
        Self: Sized,
    {
        set.checked()?;
        let checked = wrenches.get()?.checked()?;
        lengths([checked.extent(), checked.error()])?;
        set.put(qdist_set_f64 {
            support: support_of::<Exerted<Self>, 6>(),
            mirrored: mirrored_of::<Exerted<Self>, 6>(),
            user: wrenches.user(),
            extent: checked.extent(),
            error: checked.error(),
            dimension: 6,
            contains_origin: checked.contains_origin().into(),
            ..qdist_set_f64::ZERO
        })
    }
}

/// The support function of a list.
pub(super) struct Exerted<W>(PhantomData<W>);

impl<W: Wrenches> Answers<6> for Exerted<W> {
    type Struct = W;
    fn farthest(wrenches: &W, u: &Vector<f64, 6>, _exhaustive: bool) -> Check<Vector<f64, 6>> {
        let found = wrenches.unchecked()?.support(u).map_err(|Failure(code)| code)?;
        Ok(one_by_one(&found))
    }
    fn mirrored(wrenches: &W, signs: u8) -> bool {
        wrenches.mirrored(signs)
    }
}

impl Wrenches for qdist_wrenches_f64 {
    type Contribution<'a> = Primitive<f64>;
    /// By comparison of all contributions.
    fn mirrored(&self, signs: u8) -> bool {
        self.unchecked().is_ok_and(|set| set.mirrored(signs))
    }
    fn checked(&self) -> Check<WrenchSet<'_, f64>> {
        let norm = checked_norm(self.norm)?;
        let list = self.primitives.array(Some(self.count as usize))?;
        Ok(WrenchSet::new(qdist_primitive_f64::checked(list)?, norm))
    }
    fn unchecked(&self) -> Check<WrenchSet<'_, f64>> {
        let list = self.primitives.array(Some(self.count as usize))?;
        Ok(WrenchSet::without_size(qdist_primitive_f64::list(list), checked_norm(self.norm)?))
    }
}

/// The list behind a set, if the set is as `qdist_set_wrenches` makes it: the list knows its rounding coordinate by coordinate.
pub(super) fn behind(set: &qdist_set_f64) -> Option<WrenchSet<'_, f64>> {
    let own = support_of::<Exerted<qdist_wrenches_f64>, 6>()?;
    if set.exhaustive.is_some() || !set.support.is_some_and(|support| core::ptr::fn_addr_eq(support, own)) {
        return None;
    }
    // SAFETY: what the header asks of the caller: with this function, that is what `user` points to, for as long as the set is in use.
    let wrenches: &qdist_wrenches_f64 = unsafe { set.user.cast::<qdist_wrenches_f64>().as_ref() }?;
    let list = wrenches.checked().ok()?;
    (set.error == list.error() && set.extent == list.extent() && set.radius == 0.0).then_some(list)
}

/// Makes a set of a list of primitives. Reads all of them.
///
/// Status: ARGUMENT (wrenches->norm, count is 0, an `empty` is neither 0 nor 1, or a `rounding` is negative), CONTACT_WRENCH (a number of a
/// primitive), NONFINITE (all of them together are too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_wrenches_f64(set: Out<qdist_set_f64>, wrenches: In<qdist_wrenches_f64>) -> qdist_status {
    status(Wrenches::fill(set, wrenches))
}
