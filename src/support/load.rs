//! Vectors on their way from one function to another.

use crate::scalar::{Real, Vector};

/// The coordinates, loaded one by one.
///
/// A vector that is handed over in memory has just been stored, in pieces that the compiler chose there: x and (y, z), say. A load
/// of other pieces here, (x, y) and z, spans two stores and must wait until both have reached the cache: a dozen cycles, several
/// times in every support call. A single coordinate lies within one store, whatever the pieces were. The loads are volatile
/// because the compiler would join others.
#[inline(always)]
pub(crate) fn one_by_one<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    // SAFETY: a reference is valid for a read.
    Vector::from(v.data.0[0].each_ref().map(|x| unsafe { core::ptr::read_volatile(x) }))
}
