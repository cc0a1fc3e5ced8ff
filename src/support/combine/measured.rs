//! A set whose stated extent is loose, with the one that its support function shows.
//!
//! The default [`error`](Support::error) of a set is a share of its stated extent. Where that bound is true but loose (a bound for a whole family of shapes,
//! say), so is the error, and with it every margin. 2 N support calls along the axes draw a box around the core; the default error is then the
//! same share of that box's size, in any direction: what is rounded along a short axis may have been as long as a long one. An error that the set
//! states by itself says something else, and stays.

use crate::math::{TwoWords, Vector, norm};
use crate::scalar::Real;
use crate::support::{Failure, Support, Symmetry};

/// A set, and the box around its core.
pub(crate) struct Measured<'a, S: ?Sized, T, const N: usize> {
    set: &'a S,
    extents: Vector<T, N>,
}

/// The support calls that it takes to measure a set in N dimensions.
pub(crate) const fn measuring_calls<const N: usize>() -> u32 {
    2 * N as u32
}

/// May a set be worth measuring whose points were seen no farther out than `reach`? Not where its error does not hang on the extent.
pub(crate) fn is_worth_measuring<T: Real, const N: usize>(set: &dyn Support<T, N>, reach: T) -> bool {
    let stated = set.extent();
    let by_default = set.error() == T::count(16 * N) * T::ROUNDOFF * stated && set.center().is_none();
    by_default && stated > reach + reach
}

impl<'a, S: Support<T, N> + ?Sized, T: Real, const N: usize> Measured<'a, S, T, N> {
    /// Measures a set; `None` where the extent that it states is not loose.
    pub fn new(set: &'a S) -> Option<Self> {
        let stated = set.extent();
        let mut extents = Vector::<T, N>::zeros();
        for i in 0..N {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, N>::zeros();
                axis[i] = sign;
                extents[i] = extents[i].at_least(set.exhaustive(&axis).ok()?.0[i].abs());
            }
        }
        // What the support function may have missed along the axes.
        let extents = extents * (T::one() + T::count(32 * N) * T::ROUNDOFF);
        let size = norm(&extents);
        (size > T::zero() && size + size < stated).then_some(Measured { set, extents })
    }
}

impl<S: Support<T, N> + ?Sized, T: Real, const N: usize> Support<T, N> for Measured<'_, S, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        self.set.support(u)
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.set.support_with_witness(u)
    }
    fn exhaustive(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.set.exhaustive(u)
    }
    fn has_shortcuts(&self) -> bool {
        self.set.has_shortcuts()
    }
    fn radius(&self) -> T {
        self.set.radius()
    }
    fn rolling_radius(&self) -> T {
        self.set.rolling_radius()
    }
    fn extent(&self) -> T {
        norm(&self.extents)
    }
    fn extents(&self) -> Vector<T, N> {
        self.extents
    }
    fn symmetry(&self) -> Symmetry {
        self.set.symmetry()
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.set.mirrored(signs)
    }
    fn support_in_two_words(&self, u: &TwoWords<T, N>) -> Option<TwoWords<T, N>> {
        self.set.support_in_two_words(u)
    }
    fn contains_origin(&self) -> bool {
        self.set.contains_origin()
    }
}
