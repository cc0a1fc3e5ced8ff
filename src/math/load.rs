//! Loads that need not wait: the coordinates of a vector that another function has just written to memory.
//!
//! A processor hands a store that is still on its way over to a load that lies within it (store forwarding). What a function returns in memory has just
//! been stored, in pieces that the compiler chose there: x and (y, z), say. A load of other pieces here, (x, y) and z, spans two stores and must wait until
//! both have reached the cache: a dozen cycles, several times in every support call. A single number lies within one store, whatever the pieces were.

use super::Vector;
use crate::scalar::Real;

/// A number, by a load of its own: a volatile one, since the compiler would join it with its neighbours.
#[inline(always)]
pub fn alone<X: Copy>(x: &X) -> X {
    // SAFETY: a reference is valid for a read.
    unsafe { core::ptr::read_volatile(x) }
}

/// The coordinates, each loaded [`alone`].
#[inline(always)]
pub fn one_by_one<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    Vector::from(v.data.0[0].each_ref().map(alone))
}
