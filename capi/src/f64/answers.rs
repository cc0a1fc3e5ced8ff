//! The library's own support functions and unit sets, as C calls them: a struct of the header is behind `user`, and says what it is a set of. What
//! the arguments are is the same for all, and is looked at here.

use super::*;
use core::mem::MaybeUninit;

/// How a struct answers as a set of dimension `N`.
pub(super) trait Answers<const N: usize>: 'static {
    type Struct: 'static;
    /// A point of the core that is farthest along `u`, or a code.
    fn farthest(of: &Self::Struct, u: &Vector<f64, N>, exhaustive: bool) -> Check<Vector<f64, N>>;
    /// The same in two words, where the struct has that.
    fn precise(_of: &Self::Struct, _u: &TwoWords<f64, N>) -> Option<TwoWords<f64, N>> {
        None
    }
    /// Does the set not change when these coordinates change sign?
    fn mirrored(_of: &Self::Struct, _signs: u8) -> bool {
        false
    }
}

/// The support function, for a set's `support`.
pub(super) fn support_of<A: Answers<N>, const N: usize>() -> qdist_support_f64 {
    Some(support::<A, N, false>)
}

/// The same without shortcuts, for `exhaustive`.
pub(super) fn exhaustive_of<A: Answers<N>, const N: usize>() -> qdist_support_f64 {
    Some(support::<A, N, true>)
}

pub(super) fn precise_of<A: Answers<N>, const N: usize>() -> qdist_precise_f64 {
    Some(precise::<A, N>)
}

pub(super) fn mirrored_of<A: Answers<N>, const N: usize>() -> qdist_mirrored {
    Some(mirrored::<A, N>)
}

type Arguments<'a, S, const N: usize, const M: usize> = (&'a S, &'a Vector<f64, N>, &'a mut MaybeUninit<[f64; M]>);

/// The arguments of a support function: the struct behind `user`, the direction, and room for the point.
///
/// # Safety
/// Each pointer that is neither NULL nor misaligned is valid for an `S`, for `N` numbers, and for writes of `M` numbers.
#[inline(always)]
unsafe fn arguments<'a, S, const N: usize, const M: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> Check<Arguments<'a, S, N, M>> {
    let user = user.cast::<S>().cast_const();
    if user.is_null() || direction.is_null() || point.is_null() {
        return Err(QDIST_ERROR_NULL);
    }
    // One branch for all three.
    if !(user.is_aligned() & direction.is_aligned() & point.is_aligned()) {
        return Err(QDIST_ERROR_ALIGNMENT);
    }
    // SAFETY: neither NULL nor misaligned, and the caller's promise; a vector is its numbers in a row.
    unsafe { Ok((&*user, &*direction.cast(), &mut *point.cast())) }
}

unsafe extern "C" fn support<A: Answers<N>, const N: usize, const EXHAUSTIVE: bool>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller of a support function; `user` is the set's.
    let arguments = unsafe { arguments::<A::Struct, N, N>(user, direction, point) };
    status_of(|| {
        let (of, u, room) = arguments?;
        room.write(A::farthest(of, u, EXHAUSTIVE)?.into());
        Ok(())
    })
}

unsafe extern "C" fn precise<A: Answers<N>, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller of such a function: two directions in a row, and room for two points.
    let arguments = unsafe { arguments::<A::Struct, N, N>(user, direction, point) };
    let ask = || {
        let (of, high, room) = arguments.ok()?;
        // SAFETY: the second of the two directions.
        let low = unsafe { direction.add(N).cast::<[f64; N]>().read() };
        let found = A::precise(of, &TwoWords { high: *high, low: Vector::from(low) })?;
        room.write(found.high.into());
        // SAFETY: the second of the two points.
        unsafe { point.add(N).cast::<[f64; N]>().write(found.low.into()) };
        Some(())
    };
    i32::from(ask().is_none())
}

unsafe extern "C" fn mirrored<A: Answers<N>, const N: usize>(user: *mut c_void, signs: u32) -> i32 {
    // SAFETY: what the header asks of the caller of a mirror function; `user` is the set's.
    let of = unsafe { In::<A::Struct>::new(user.cast()) };
    i32::from(of.get().is_ok_and(|of| A::mirrored(of, signs as u8)))
}

// ------------------------------------------------------------------------------------------------- unit sets

/// The unit set that a struct stands for in dimension `N`.
pub(super) trait AnswersUnit<const N: usize>: 'static {
    type Set<'a>: UnitSet<f64, N>;
    /// Checks the numbers. The set, and an upper bound of |q| over it.
    fn stated(&self) -> Check<(Self::Set<'_>, f64)>;
    /// Radius of a ball in the set.
    fn inner_radius(&self, set: &Self::Set<'_>) -> f64 {
        set.inner_radius()
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.trusted().is_ok_and(|set| set.mirrored(signs))
    }
    /// Trusts them: they were checked when the unit set was made.
    fn trusted(&self) -> Check<Self::Set<'_>>;
}

pub(super) fn fill_unit<S: AnswersUnit<N>, const N: usize>(unit: Out<qdist_unit_f64>, shape: In<S>) -> Check {
    let of = shape.get()?;
    let (set, extent) = of.stated()?;
    let vertex_count = u32::try_from(set.vertex_count()).map_err(|_| QDIST_ERROR_ARGUMENT)?;
    unit.put(qdist_unit_f64 {
        value: Some(unit_value::<S, N>),
        point: Some(unit_point::<S, N>),
        vertex: if vertex_count > 0 { Some(unit_vertex::<S, N>) } else { None },
        mirrored: Some(unit_mirrored::<S, N>),
        user: shape.user(),
        extent: length(extent)?,
        inner_radius: of.inner_radius(&set),
        vertex_count,
        dimension: N as u32,
        ..qdist_unit_f64::ZERO
    })
}

/// NaN says that the arguments are wrong.
unsafe extern "C" fn unit_value<S: AnswersUnit<N>, const N: usize>(user: *mut c_void, direction: *const f64) -> f64 {
    // SAFETY: what the header asks of the caller of a unit set's function; `user` is the set's.
    let (of, u) = unsafe { (In::<S>::new(user.cast()), In::<Vector<f64, N>>::new(direction.cast())) };
    let ask = || of.get()?.trusted()?.value(u.get()?).map_err(|Failure(code)| code);
    ask().unwrap_or(f64::NAN)
}

unsafe extern "C" fn unit_point<S: AnswersUnit<N>, const N: usize>(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller of a unit set's function; `user` is the set's.
    let arguments = unsafe { arguments::<S, N, N>(user, direction, point) };
    status_of(|| {
        let (of, u, room) = arguments?;
        room.write(of.trusted()?.mapping(u).ok_or(QDIST_ERROR_ARGUMENT)?.into());
        Ok(())
    })
}

unsafe extern "C" fn unit_vertex<S: AnswersUnit<N>, const N: usize>(
    user: *mut c_void,
    index: u32,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller of a unit set's function; `user` is the set's.
    let (of, room) = unsafe { (In::<S>::new(user.cast()), Out::<[f64; N]>::new(point.cast())) };
    status_of(|| {
        let set = of.get()?.trusted()?;
        let index = Some(index as usize).filter(|&index| index < set.vertex_count());
        room.put(set.vertex(index.ok_or(QDIST_ERROR_ARGUMENT)?).into())
    })
}

unsafe extern "C" fn unit_mirrored<S: AnswersUnit<N>, const N: usize>(user: *mut c_void, signs: u32) -> i32 {
    // SAFETY: what the header asks of the caller of a mirror function; `user` is the set's.
    let of = unsafe { In::<S>::new(user.cast()) };
    i32::from(of.get().is_ok_and(|of| of.mirrored(signs as u8)))
}
