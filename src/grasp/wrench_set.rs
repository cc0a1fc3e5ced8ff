//! The wrenches that a whole grasp can resist.

use super::contribution::{Contribution, near_unit};
use super::primitive::Primitive;
use crate::math::{Vector, norm};
use crate::scalar::Real;
use crate::support::{Failure, Support};

/// The size of all contact forces together (paper, eq. 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// The sum of the normal forces, each divided by its cap, is at most 1: the contacts share one supply.
    L1,
    /// Each normal force is at most its cap: every contact has a supply of its own.
    LInf,
}

/// The grasp wrench set W (paper, eq. 3, with all forces up to unit size: {0} is in it), for any number of contributions,
/// usually the [`Primitive`]s of contacts.
///
/// ```text
/// L1:   hull of {0} and all W_i            h = max(0, h_1, ..., h_m)
/// LInf: sum of the hulls of {0} and W_i    h = max(0, h_1) + ... + max(0, h_m)
/// ```
///
/// One pass over the m contributions per support call, for primitives about 50 operations each, one square root included. Empty
/// primitives add nothing. The witness is the point itself.
///
/// `error`, with e_i the error of contribution i: a computed value h_i is within e_i of the true one. L1 picks one by two such
/// values, `3 max e_i` with the point's own. LInf decides by signs, which may cost e_i where it is wrong, and adds m
/// points, one roundoff u of the sum for each: `2 sum e_i + m u sum |W_i|`. `errors` are the same coordinate by coordinate.
///
/// ```
/// use qdist::Vector;
/// use qdist::grasp::{Contact, ContactError, Friction, Norm, Primitive, WrenchFrame, WrenchSet};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let mut primitives = [Primitive::empty(); 2];
/// for (primitive, x) in primitives.iter_mut().zip([-1.0, 1.0]) {
///     let inward = Vector::from([-x, 0.0, 0.0]);
///     let contact = Contact::new(Vector::from([x, 0.0, 0.0]), inward, Friction::Hard { mu: 0.5 })?;
///     *primitive = Primitive::passive(&contact, &frame)?;
/// }
/// let up = Vector::from([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
/// assert_eq!(WrenchSet::new(&primitives, Norm::L1).value(&up), 0.5); // one of them, fully
/// assert_eq!(WrenchSet::new(&primitives, Norm::LInf).value(&up), 1.0); // both, fully
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct WrenchSet<'a, T, C = Primitive<T>> {
    contributions: &'a [C],
    norm: Norm,
    extent: T,
    error: T,
}

impl<'a, T: Real, C: Contribution<T>> WrenchSet<'a, T, C> {
    /// The wrench set of `contributions`, which stay the caller's. Reads all of them, and for LInf calls the support
    /// function 12 times to bound the extent.
    pub fn new(contributions: &'a [C], norm: Norm) -> Self {
        let zero = T::zero();
        let largest = |f: fn(&C) -> T| contributions.iter().fold(zero, |m, c| m.at_least(f(c)));
        let total = |f: fn(&C) -> T| contributions.iter().fold(zero, |s, c| s + f(c));
        let (extent, error) = match norm {
            Norm::L1 => (largest(Support::extent), T::count(3) * largest(Support::error)),
            Norm::LInf => {
                let m = T::count(contributions.len());
                // m additions of the bounds themselves.
                let above = T::one() + (m + T::count(8)) * T::ROUNDOFF;
                let size = total(Support::extent);
                (size * above, (T::count(2) * total(Support::error) + m * T::ROUNDOFF * size) * above)
            }
        };
        let mut set = Self { contributions, norm, extent, error };
        if norm == Norm::LInf
            && let Ok(half_diagonal) = set.half_diagonal()
        {
            set.extent = set.extent.at_most(half_diagonal);
        }
        set
    }

    /// A set for support calls only: it knows neither extent nor error.
    #[doc(hidden)]
    pub fn without_size(contributions: &'a [C], norm: Norm) -> Self {
        Self { contributions, norm, extent: T::zero(), error: T::zero() }
    }

    /// What its contacts or fingers contribute.
    pub fn contributions(&self) -> &'a [C] {
        self.contributions
    }

    /// How contact forces are measured.
    pub fn norm(&self) -> Norm {
        self.norm
    }

    /// The point s(u) of the set by its parts: `each(i, w_i)` is called for every contribution i that has a share w_i in it, and s(u) is the
    /// sum of these. For LInf these are all with h_i(u) > 0, for L1 the one with the largest h_i(u), if that is above 0. `u` is not zero.
    ///
    /// # Errors
    /// Those of the contributions.
    pub fn shares(&self, u: &Vector<T, 6>, mut each: impl FnMut(usize, &Vector<T, 6>)) -> Result<(), Failure> {
        let u = near_unit(u);
        let mut best = (T::zero(), None);
        for (index, contribution) in self.contributions.iter().enumerate() {
            match (contribution.support_above(&u, best.0)?, self.norm) {
                (None, _) => {}
                (Some((_, point)), Norm::LInf) => each(index, &point),
                (Some((value, point)), Norm::L1) => best = (value, Some((index, point))),
            }
        }
        if let (_, Some((index, point))) = best {
            each(index, &point);
        }
        Ok(())
    }

    /// Is the set provably the same after its coordinates are multiplied by `signs`, each 1 or -1?
    ///
    /// True when every contribution, mirrored, is in the list ([`Contribution::is_mirror_of`]): for primitives the same center and,
    /// up to order and sign, the same columns of the disc, by exact comparison of floating-point numbers; for LInf as often
    /// as the contribution itself. False means that it is not known. m^2 comparisons, of up to 24 numbers for primitives.
    pub fn is_mirrored(&self, signs: &Vector<T, 6>) -> bool {
        if !signs.iter().all(|s| s.abs() == T::one()) {
            return false;
        }
        let same = Vector::repeat(T::one());
        let count = |of: &C, signs| self.contributions.iter().filter(|c| c.is_mirror_of(of, signs)).count();
        self.contributions.iter().all(|c| match self.norm {
            Norm::L1 => self.contributions.iter().any(|q| q.is_mirror_of(c, signs)),
            Norm::LInf => count(c, &same) > 0 && count(c, signs) == count(c, &same),
        })
    }

    /// What contributions have in common: the largest of each coordinate, or the sum.
    fn gather(&self, sum: &Vector<T, 6>, own: &Vector<T, 6>) -> Vector<T, 6> {
        match self.norm {
            Norm::L1 => sum.zip_map(own, |a, b| a.at_least(b)),
            Norm::LInf => sum + own,
        }
    }

    /// Half the diagonal of the box that contains the set: opposed contacts cancel in it, not in the sum of extents.
    fn half_diagonal(&self) -> Result<T, Failure> {
        let mut corner = Vector::<T, 6>::zeros();
        for i in 0..6 {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, 6>::zeros();
                axis[i] = sign;
                corner[i] = corner[i].at_least(self.support(&axis)?.dot(&axis) + self.error);
            }
        }
        Ok(norm(&corner) * (T::one() + T::count(16) * T::ROUNDOFF))
    }
}

impl<T: Real> WrenchSet<'_, T> {
    /// h(u) >= 0, for u not far from unit length, to within [`error`](Support::error) |u|.
    pub fn value(&self, u: &Vector<T, 6>) -> T {
        let values = self.contributions.iter().map(|p| T::zero().at_least(p.value(u)));
        match self.norm {
            Norm::L1 => values.fold(T::zero(), T::at_least),
            Norm::LInf => values.fold(T::zero(), |s, x| s + x),
        }
    }
}

impl<T: Real, C: Contribution<T>> Support<T, 6> for WrenchSet<'_, T, C> {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        let mut sum = Vector::zeros();
        self.shares(u, |_, share| sum += share)?;
        Ok(sum)
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.is_mirrored(&Vector::from_fn(|i, _| if signs >> i & 1 == 1 { -T::one() } else { T::one() }))
    }
    fn contains_origin(&self) -> bool {
        true // {0} is in it.
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error
    }
    fn errors(&self) -> Vector<T, 6> {
        let add = |sum: Vector<T, 6>, c: &C| self.gather(&sum, &c.errors());
        let own = self.contributions.iter().fold(Vector::zeros(), add);
        match self.norm {
            Norm::L1 => own * T::count(3),
            Norm::LInf => {
                let m = T::count(self.contributions.len());
                let above = T::one() + (m + T::count(8)) * T::ROUNDOFF;
                (own * T::count(2) + self.extents() * (m * T::ROUNDOFF)) * above
            }
        }
    }
    fn extents(&self) -> Vector<T, 6> {
        let add = |sum: Vector<T, 6>, c: &C| self.gather(&sum, &c.extents());
        let m = T::count(self.contributions.len());
        self.contributions.iter().fold(Vector::zeros(), add) * (T::one() + (m + T::count(2)) * T::ROUNDOFF)
    }
}
