//! The wrenches that a whole grasp can resist.

use super::primitive::{Primitive, near_unit};
use crate::scalar::{Real, Vector, norm};
use crate::support::{Failure, Support};

/// The size of all contact forces together (paper, eq. 4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Norm {
    /// The sum of the normal forces, each divided by its cap, is at most 1: the contacts share one supply.
    L1,
    /// Each normal force is at most its cap: every contact has a supply of its own.
    LInf,
}

/// The grasp wrench set W (paper, eq. 3, with all forces up to unit size: {0} is in it), for any number of primitives.
///
/// ```text
/// L1:   hull of {0} and all W_i            h = max(0, h_1, ..., h_m)
/// LInf: sum of the hulls of {0} and W_i    h = max(0, h_1) + ... + max(0, h_m)
/// ```
///
/// One pass over the m primitives per support call, about 50 operations each, one square root included. Empty
/// primitives add nothing. The witness is the point itself.
///
/// `error`, with e_i the error of primitive i, at least 24 u times its size: a computed value h_i is within e_i of the
/// true one. L1 picks a primitive by two such values, `3 max e_i` with the point's own. LInf decides by signs, which
/// may cost e_i where it is wrong, and adds m points, one roundoff of the sum for each: `(2 + m/24) sum e_i`.
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
pub struct WrenchSet<'a, T> {
    primitives: &'a [Primitive<T>],
    norm: Norm,
    extent: T,
    error: T,
}

impl<'a, T: Real> WrenchSet<'a, T> {
    /// The wrench set of `primitives`, which stay the caller's. Reads all of them, and for LInf calls the support
    /// function 12 times to bound the extent.
    pub fn new(primitives: &'a [Primitive<T>], norm: Norm) -> Self {
        let zero = T::zero();
        let largest = |f: fn(&Primitive<T>) -> T| primitives.iter().fold(zero, |m, p| m.at_least(f(p)));
        let total = |f: fn(&Primitive<T>) -> T| primitives.iter().fold(zero, |s, p| s + f(p));
        let (extent, error) = match norm {
            Norm::L1 => (largest(Support::extent), T::count(3) * largest(Support::error)),
            Norm::LInf => {
                let m = T::count(primitives.len());
                // m additions of the bounds themselves.
                let above = T::one() + (m + T::count(8)) * T::ROUNDOFF;
                (total(Support::extent) * above, (T::count(2) + m / T::count(24)) * total(Support::error) * above)
            }
        };
        let mut set = Self { primitives, norm, extent, error };
        if norm == Norm::LInf {
            set.extent = set.extent.at_most(set.half_diagonal());
        }
        set
    }

    /// The primitives.
    pub fn primitives(&self) -> &'a [Primitive<T>] {
        self.primitives
    }

    /// How contact forces are measured.
    pub fn norm(&self) -> Norm {
        self.norm
    }

    /// h(u) >= 0, for u not far from unit length, to within [`error`](Support::error) |u|.
    pub fn value(&self, u: &Vector<T, 6>) -> T {
        let values = self.primitives.iter().map(|p| T::zero().at_least(p.farthest(u).value));
        match self.norm {
            Norm::L1 => values.fold(T::zero(), T::at_least),
            Norm::LInf => values.fold(T::zero(), |s, x| s + x),
        }
    }

    /// Is the set provably the same after its coordinates are multiplied by `signs`, each 1 or -1?
    ///
    /// True when every primitive, mirrored, is in the list: the same center and, up to order and sign, the same columns
    /// of the disc, by exact comparison of floating-point numbers; for LInf as often as the primitive itself. False
    /// means that it is not known. m^2 comparisons of up to 24 numbers.
    pub fn is_mirrored(&self, signs: &Vector<T, 6>) -> bool {
        if !signs.iter().all(|s| s.abs() == T::one()) {
            return false;
        }
        let same = Vector::repeat(T::one());
        let count = |of: &Primitive<T>, signs| self.primitives.iter().filter(|p| p.is_mirror_of(of, signs)).count();
        self.primitives.iter().all(|p| match self.norm {
            Norm::L1 => self.primitives.iter().any(|q| q.is_mirror_of(p, signs)),
            Norm::LInf => count(p, signs) == count(p, &same),
        })
    }

    /// Half the diagonal of the box that contains the set: opposed contacts cancel in it, not in the sum of extents.
    fn half_diagonal(&self) -> T {
        let mut corner = Vector::<T, 6>::zeros();
        for i in 0..6 {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, 6>::zeros();
                axis[i] = sign;
                corner[i] = corner[i].at_least(self.value(&axis) + self.error);
            }
        }
        norm(&corner) * (T::one() + T::count(16) * T::ROUNDOFF)
    }
}

impl<T: Real> Support<T, 6> for WrenchSet<'_, T> {
    fn mirrored(&self, signs: u8) -> bool {
        self.is_mirrored(&Vector::from_fn(|i, _| if signs >> i & 1 == 1 { -T::one() } else { T::one() }))
    }
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        let u = near_unit(u);
        let zero = T::zero();
        Ok(match self.norm {
            Norm::L1 => {
                let mut best = (zero, None);
                for p in self.primitives {
                    let farthest = p.farthest(&u);
                    if farthest.value > best.0 {
                        best = (farthest.value, Some((p, farthest)));
                    }
                }
                best.1.map_or(Vector::zeros(), |(p, farthest)| p.point(&farthest))
            }
            Norm::LInf => self.primitives.iter().fold(Vector::zeros(), |sum, p| {
                let farthest = p.farthest(&u);
                if farthest.value > zero { sum + p.point(&farthest) } else { sum }
            }),
        })
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error
    }
}
