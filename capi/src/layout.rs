//! The layout of structs of the header: those that may grow begin with their size, and bytes that belong to no field are known, so that results are
//! written whole (module [`pointer`](super::pointer)).

use super::vocabulary::*;

/// A struct that may grow: `struct_size` first, new fields last.
///
/// # Safety
/// It begins with `struct_size: u32`, and any bits are legal in every field.
pub(super) unsafe trait Versioned: Copy {
    /// The sizes that it had in earlier headers, which are at least 4.
    const EARLIER: &'static [usize];
}

/// One that is read.
pub(super) trait Defaults: Versioned {
    /// What stands for fields that an earlier version did not have.
    fn defaults() -> Self;
}

/// The size of a struct, if it is that of a version that this library knows.
#[inline(always)]
pub(super) fn known<S: Versioned>(size: u32) -> Check<usize> {
    let size = size as usize;
    if size == size_of::<S>() || S::EARLIER.contains(&size) { Ok(size) } else { Err(QDIST_ERROR_STRUCT_SIZE) }
}

/// The size of a struct must be that of today's version.
#[cfg(feature = "grasp")]
#[inline(always)]
pub(super) fn current<S: Versioned>(size: u32) -> Check {
    if size as usize == size_of::<S>() { Ok(()) } else { Err(QDIST_ERROR_STRUCT_SIZE) }
}

/// `versioned!(type)`, `versioned!(type, earlier sizes)`.
macro_rules! versioned {
    ($type:ty $(, $earlier:expr)*) => {
        // SAFETY: the assertion; numbers and pointers of C.
        unsafe impl $crate::layout::Versioned for $type {
            const EARLIER: &'static [usize] = {
                assert!(core::mem::offset_of!($type, struct_size) == 0);
                &[$($earlier),*]
            };
        }
    };
}
pub(crate) use versioned;

/// A struct of the header, as C begins one.
pub(super) trait Zeros: Sized {
    /// `= {0}`
    const ZERO: Self;
}

/// A struct of the header: where it has bytes that belong to no field.
pub(super) trait Gaps {
    /// Where they begin, and how many.
    const GAPS: &'static [(usize, usize)];
}

/// `gaps!(type, field..next, last..)`: of a struct of the header; there may be a gap between these fields, and behind the last one. A field of a field is written with a dot.
macro_rules! gaps {
    ($type:ty $(, $($from:ident).+ .. $($until:ident)?)*) => {
        impl $crate::layout::Gaps for $type {
            const GAPS: &'static [(usize, usize)] = &[$({
                let end = core::mem::offset_of!($type, $($from).+)
                    + $crate::layout::field_size(|all: &$type| &all.$($from).+);
                (end, $crate::layout::gaps!(@until $type, $($until)?) - end)
            }),*];
        }

        impl $crate::layout::Zeros for $type {
            // SAFETY: numbers, pointers and optional functions of C. (The compiler refuses to make zeros of what they are no value of.)
            const ZERO: Self = unsafe { core::mem::zeroed() };
        }
    };
    (@until $type:ty, $until:ident) => { core::mem::offset_of!($type, $until) };
    (@until $type:ty,) => { size_of::<$type>() };
}
pub(crate) use gaps;

gaps!(f64);
gaps!(f32);
gaps!(u32);

impl<S> Gaps for *mut S {
    const GAPS: &'static [(usize, usize)] = &[];
}

impl<S, const K: usize> Gaps for [S; K] {
    const GAPS: &'static [(usize, usize)] = &[];
}

/// The size of the field that a function picks.
pub(super) const fn field_size<S, F>(_: fn(&S) -> &F) -> usize {
    size_of::<F>()
}
