//! Vectors, and arithmetic with more than one word.

mod accumulator;
mod two_words;

use crate::scalar::Real;
pub(crate) use accumulator::Accumulator;
use nalgebra::{ArrayStorage, SVector};
pub use two_words::TwoWords;

/// A vector of dimension `N`.
pub type Vector<T, const N: usize> = SVector<T, N>;

/// The origin, for memory that is made before the program runs.
pub(crate) const fn zeros<T: Real, const N: usize>() -> Vector<T, N> {
    Vector::from_array_storage(ArrayStorage([[T::ZERO; N]; 1]))
}

/// Euclidean norm, also where squares under- or overflow.
#[inline(always)]
pub fn norm<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    let squared = v.dot(v);
    if squared > T::SAFE_SQUARE && squared <= T::HUGE { squared.root() } else { far_norm(v) }
}

/// v / |v| for v not zero, also where squares under- or overflow.
#[inline]
pub(crate) fn unit<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    let squared = v.dot(v);
    if squared > T::SAFE_SQUARE && squared <= T::HUGE {
        return v * (T::one() / squared.root());
    }
    let largest = v.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
    let scaled = v.map(|x| x / largest);
    scaled * (T::one() / scaled.dot(&scaled).root())
}

#[cold]
#[inline(never)]
fn far_norm<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    let largest = v.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
    if !(largest > T::zero()) {
        return T::zero();
    }
    let scaled = v.map(|x| x / largest);
    largest * scaled.dot(&scaled).root()
}

/// Are all coordinates finite?
#[inline]
pub fn finite<T: Real, const N: usize>(v: &Vector<T, N>) -> bool {
    v.iter().all(|x| x.finite())
}
