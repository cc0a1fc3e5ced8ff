//! Vectors, and arithmetic with more than one word.

mod accumulator;
pub(crate) mod load;
mod two_words;

use crate::scalar::Real;
pub(crate) use accumulator::Accumulator;
use load::one_by_one;
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
    if squared > T::SAFE_SQUARE && squared < T::HUGE { squared.root() } else { far_norm(v) }
}

/// |x| without a call.
#[inline(always)]
pub(crate) fn magnitude<T: Real>(x: T) -> T {
    x.at_least(-x)
}

/// max |x_i|, of those that are numbers.
#[inline(always)]
pub(crate) fn largest<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    v.iter().fold(T::zero(), |m, &x| m.at_least(magnitude(x)))
}

/// v / |v|, also where squares under- or overflow; zero for zero.
#[inline]
pub(crate) fn unit<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    let squared = v.dot(v);
    if squared > T::SAFE_SQUARE && squared < T::HUGE {
        v * (T::one() / squared.root())
    } else if N > 3 {
        // (A copy of a long vector would cost every caller its place on the stack.)
        scaled_unit(v)
    } else {
        one_by_one(&far_unit(*v))
    }
}

/// x . y of numbers in a row, added up in their order.
#[cfg(feature = "grasp")] // nobody else needs it
#[inline]
pub(crate) fn dot<T: Real, const K: usize>(x: &[T; K], y: &[T; K]) -> T {
    x.iter().zip(y).fold(T::zero(), |s, (&a, &b)| s + a * b)
}

/// In and out by value, so that the caller's vector stays in registers on the usual path.
#[cold]
#[inline(never)]
fn far_unit<T: Real, const N: usize>(v: Vector<T, N>) -> Vector<T, N> {
    scaled_unit(&v)
}

#[inline(always)]
fn scaled_unit<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<T, N> {
    let largest = largest(v);
    if !(largest > T::zero()) {
        return *v;
    }
    let scaled = v.map(|x| x / largest);
    scaled * (T::one() / scaled.dot(&scaled).root())
}

#[cold]
#[inline(never)]
fn far_norm<T: Real, const N: usize>(v: &Vector<T, N>) -> T {
    let largest = largest(v);
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
