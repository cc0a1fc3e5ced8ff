//! Pointers of the C caller as types, so that `unsafe` is where memory is touched and nowhere else.
//!
//! [`In`] and [`Out`] have the layout of a pointer, and stand for one in every exported function and in the structs of the header. Their values come
//! from C, with the promise that the header states once for all functions: a pointer is NULL, misaligned (both are told apart here), or valid
//! for what the function's text says, during the call; a pointer in a struct for as long as the struct is in use. Rust code makes one by an
//! `unsafe` function only. So the methods are safe, and what they lend lives no longer than the pointer that was handed in. (The generator of
//! the header reads `In<S>` as `const S *` and `Out<S>` as `S *`.)
//!
//! Structs that may grow begin with their size ([`Versioned`], module [`layout`](super::layout)). One from an earlier header is shorter: what it lacks takes its default when it is
//! read, and stays unwritten when it is a result.

use super::vocabulary::*;
use core::mem::MaybeUninit;

/// Neither NULL nor misaligned.
#[inline(always)]
fn aligned<S>(pointer: *const S) -> Check {
    if pointer.is_null() {
        Err(QDIST_ERROR_NULL)
    } else if pointer.is_aligned() {
        Ok(())
    } else {
        Err(QDIST_ERROR_ALIGNMENT)
    }
}

/// A length that an array of `S` in memory can have, 0 left out.
#[inline(always)]
fn possible<S>(length: Option<usize>) -> Check<usize> {
    let fits = |n: &usize| *n > 0 && n.checked_mul(size_of::<S>()).is_some_and(|bytes| bytes <= isize::MAX as usize);
    length.filter(fits).ok_or(QDIST_ERROR_ARGUMENT)
}

/// What is read: one `S`, or a list of them.
#[repr(transparent)]
pub struct In<S>(*const S);

impl<S> Clone for In<S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S> Copy for In<S> {}

impl<S> In<S> {
    /// # Safety
    /// As C callers promise, see above.
    #[inline(always)]
    pub(super) unsafe fn new(pointer: *const S) -> Self {
        Self(pointer)
    }

    pub(super) fn is_null(&self) -> bool {
        self.0.is_null()
    }

    /// The address, to be handed back to C.
    pub(super) fn address(&self) -> *const S {
        self.0
    }

    /// The same for a struct's `user`.
    pub(super) fn user(&self) -> *mut c_void {
        self.0.cast_mut().cast()
    }

    /// The struct.
    #[inline(always)]
    pub(super) fn get(&self) -> Check<&S> {
        aligned(self.0)?;
        // SAFETY: checked, and the promise of the type.
        Ok(unsafe { &*self.0 })
    }

    /// The struct; NULL: none.
    #[inline(always)]
    pub(super) fn optional(&self) -> Check<Option<&S>> {
        if self.0.is_null() { Ok(None) } else { self.get().map(Some) }
    }

    /// A list, never of length 0.
    #[inline(always)]
    pub(super) fn array(&self, length: Option<usize>) -> Check<&[S]> {
        aligned(self.0)?;
        let length = possible::<S>(length)?;
        // SAFETY: not NULL, aligned, a length that an object can have, and the promise of the type.
        Ok(unsafe { core::slice::from_raw_parts(self.0, length) })
    }

    /// A list whose length the function fixes.
    #[cfg(feature = "grasp")]
    #[inline(always)]
    pub(super) fn numbers<const K: usize>(&self) -> Check<[S; K]>
    where
        S: Copy,
    {
        let list = self.array(Some(K))?;
        list.first_chunk().copied().ok_or(QDIST_ERROR_ARGUMENT)
    }

    /// A struct of today's version.
    #[cfg(feature = "grasp")]
    #[inline(always)]
    pub(super) fn current(&self) -> Check<&S>
    where
        S: Versioned,
    {
        aligned(self.0)?;
        // SAFETY: checked; a struct of any version begins with its size, which is all that is read before it is known.
        super::layout::current::<S>(unsafe { self.0.cast::<u32>().read() })?;
        self.get()
    }

    /// A struct that may be of an earlier version, and its defaults for what it lacks.
    #[inline(always)]
    pub(super) fn version(&self) -> Check<S>
    where
        S: Defaults,
    {
        aligned(self.0)?;
        // SAFETY: checked; a struct of any version begins with its size, which is all that is read before it is known.
        let size = known::<S>(unsafe { self.0.cast::<u32>().read() })?;
        let mut value = MaybeUninit::new(S::defaults());
        // SAFETY: the caller's struct has `size` bytes, which is not more than the value has; any bits are legal in both (`Versioned`).
        unsafe {
            self.0.cast::<u8>().copy_to(value.as_mut_ptr().cast(), size);
            Ok(value.assume_init())
        }
    }

    /// The same; NULL: the defaults.
    #[cfg(feature = "grasp")]
    pub(super) fn or_default(&self) -> Check<S>
    where
        S: Defaults,
    {
        if self.0.is_null() { Ok(S::defaults()) } else { self.version() }
    }
}

/// What is written: one `S`, or room for a list of them. Nothing else refers to it during the call.
#[repr(transparent)]
pub struct Out<S>(*mut S);

impl<S> Out<S> {
    /// # Safety
    /// As C callers promise, see above.
    #[inline(always)]
    pub(super) unsafe fn new(pointer: *mut S) -> Self {
        Self(pointer)
    }

    /// The address, to be handed back to C.
    pub(super) fn address(&self) -> *mut S {
        self.0
    }

    #[cfg(feature = "grasp")]
    pub(super) fn is_null(&self) -> bool {
        self.0.is_null()
    }

    /// Neither NULL nor misaligned.
    #[inline(always)]
    pub(super) fn checked(&self) -> Check {
        aligned(self.0)
    }

    /// NULL or not misaligned.
    #[cfg(feature = "grasp")]
    #[inline(always)]
    pub(super) fn optional(&self) -> Check {
        if self.0.is_null() { Ok(()) } else { self.checked() }
    }

    /// What is there, for structs that are read and written.
    #[inline(always)]
    pub(super) fn get(&self) -> Check<&S> {
        self.checked()?;
        // SAFETY: checked, and the promise of the type.
        Ok(unsafe { &*self.0 })
    }

    /// Writes a struct, and zeros where it has no field: the compiler would leave there what happened to be on the stack.
    #[inline(always)]
    pub(super) fn put(&self, value: S) -> Check
    where
        S: Gaps,
    {
        self.put_at(0, value)
    }

    /// The same in a list.
    #[inline(always)]
    pub(super) fn put_at(&self, index: usize, value: S) -> Check
    where
        S: Gaps,
    {
        self.checked()?;
        let to = self.0.wrapping_add(index);
        // SAFETY: checked, and the promise of the type: room for more than `index` of them. The gaps are in the struct.
        unsafe {
            to.write(value);
            for &(from, length) in S::GAPS {
                to.cast::<u8>().add(from).write_bytes(0, length);
            }
        }
        Ok(())
    }

    /// Is the result's struct of a version that this library knows? Asked before a query begins.
    #[inline(always)]
    pub(super) fn known(&self) -> Check
    where
        S: Versioned,
    {
        self.checked()?;
        // SAFETY: checked; a struct of any version begins with its size.
        known::<S>(unsafe { self.0.cast::<u32>().read() }).map(|_| ())
    }

    /// Writes a result, as far as the caller's struct goes.
    #[inline(always)]
    pub(super) fn put_version(&self, value: S) -> Check
    where
        S: Versioned + Gaps,
    {
        self.checked()?;
        // SAFETY: checked; a struct of any version begins with its size.
        let size = known::<S>(unsafe { self.0.cast::<u32>().read() })?;
        if size == size_of::<S>() {
            return self.put(value);
        }
        let mut whole = MaybeUninit::<S>::zeroed();
        // SAFETY: `whole` is one struct.
        unsafe { Out::new(whole.as_mut_ptr()) }.put(value)?;
        // SAFETY: the caller's struct has `size` bytes, which is not more than `whole` has; its size, the first four, stays as it is.
        unsafe { whole.as_ptr().cast::<u8>().add(4).copy_to(self.0.cast::<u8>().add(4), size - 4) };
        Ok(())
    }

    /// Room for a list, filled with zeros: it needs no initial value, but a reference does.
    #[allow(clippy::mut_from_ref)] // Nothing else refers to what is written.
    pub(super) fn zeroed(&self, length: usize) -> Check<&mut [S]>
    where
        S: Zero,
    {
        self.checked()?;
        if length == 0 {
            return Ok(&mut []);
        }
        possible::<S>(Some(length))?;
        // SAFETY: checked, and the promise of the type; zeros are a value.
        unsafe {
            self.0.write_bytes(0, length);
            Ok(core::slice::from_raw_parts_mut(self.0, length))
        }
    }

    /// What has been written from an index on, as something to read.
    pub(super) fn filled_from(&self, index: usize) -> In<S> {
        In(self.0.wrapping_add(index))
    }

    /// A struct in the struct, `offset` bytes from its beginning.
    #[cfg(feature = "grasp")]
    pub(super) fn part<P>(&self, offset: usize) -> Check<Out<P>> {
        if offset + size_of::<P>() > size_of::<S>() {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        Ok(Out(self.0.wrapping_byte_add(offset).cast()))
    }

    /// The box that a handle is, to be freed; nothing for NULL.
    ///
    /// # Safety
    /// It is from `Box::into_raw`, and nobody uses it any more.
    #[cfg(feature = "mesh")]
    pub(super) unsafe fn boxed(&self) -> Option<Box<S>> {
        // SAFETY: the caller's promise.
        if self.0.is_null() { None } else { Some(unsafe { Box::from_raw(self.0) }) }
    }

    /// Room for lists of `R`, which are numbers in a row.
    pub(super) fn rows<R>(&self) -> Out<R>
    where
        S: Zero,
        R: RowOf<S>,
    {
        Out(self.0.cast())
    }
}

/// What zeros are a value of, and what has no gaps.
///
/// # Safety
/// It is so.
pub(super) unsafe trait Zero {}
// SAFETY: numbers.
unsafe impl Zero for f64 {}
// SAFETY: as above.
unsafe impl Zero for f32 {}
// SAFETY: as above.
unsafe impl Zero for u16 {}
// SAFETY: as above.
unsafe impl Zero for u32 {}
// SAFETY: numbers in a row.
unsafe impl<S: Zero, const K: usize> Zero for [S; K] {}
// SAFETY: numbers in a row.
unsafe impl<S: Zero, const K: usize> Zero for qdist::Vector<S, K> {}
// SAFETY: three words in a row.
unsafe impl Zero for qdist::HullFacet {}

/// A row of numbers in memory.
///
/// # Safety
/// It has the layout of an array of them.
pub(super) unsafe trait RowOf<S>: Zero {}
// SAFETY: an array.
unsafe impl<S: Zero, const K: usize> RowOf<S> for [S; K] {}
// SAFETY: a vector is its numbers in a row.
unsafe impl<S: Zero, const K: usize> RowOf<S> for qdist::Vector<S, K> {}
// SAFETY: nine words in a row.
unsafe impl RowOf<u32> for qdist::HullFacet {}
// SAFETY: an array of vectors.
unsafe impl<S: Zero, const K: usize, const M: usize> RowOf<S> for [qdist::Vector<S, K>; M] {}

#[cfg(test)]
mod tests {
    use super::super::layout::{gaps, versioned};
    use super::super::status::QDIST_ERROR_STRUCT_SIZE;
    use super::*;

    /// As of today; the first version ended behind `a`.
    #[repr(C)]
    #[derive(Clone, Copy, Debug, PartialEq)]
    struct Grown {
        struct_size: u32,
        a: u32,
        b: f64,
        c: u32,
    }

    versioned!(Grown, 8);
    gaps!(Grown, c..);

    impl Defaults for Grown {
        fn defaults() -> Self {
            Self { struct_size: 24, a: 1, b: 2.0, c: 3 }
        }
    }

    #[test]
    fn an_earlier_struct_is_read_with_defaults_and_written_as_far_as_it_goes() {
        let mut slot = Grown::defaults();
        let place = &raw mut slot;
        // SAFETY: as many words.
        unsafe { place.cast::<[u32; 6]>().write([8, 5, 77, 77, 77, 77]) };
        // SAFETY: valid for reads and writes.
        let (old, out) = unsafe { (In::new(place.cast_const()), Out::new(place)) };
        assert_eq!(old.version(), Ok(Grown { struct_size: 8, a: 5, b: 2.0, c: 3 }));
        assert_eq!(out.known(), Ok(()));
        out.put_version(Grown { struct_size: 24, a: 9, b: 9.0, c: 9 }).unwrap();
        // SAFETY: still words.
        assert_eq!(unsafe { place.cast::<[u32; 6]>().read() }, [8, 9, 77, 77, 77, 77]);
        for size in [0, 4, 12, 25] {
            // SAFETY: still words.
            unsafe { place.cast::<u32>().write(size) };
            assert_eq!(
                (out.known(), old.version().err()),
                (Err(QDIST_ERROR_STRUCT_SIZE), Some(QDIST_ERROR_STRUCT_SIZE))
            );
        }
    }
}
