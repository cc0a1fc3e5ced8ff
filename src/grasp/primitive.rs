//! The wrenches of one contact at full normal force: the image of a disc.

use nalgebra::SMatrix;

use super::contact::{Contact, ContactError};
use super::contribution::{Contribution, near_unit};
use super::frame::WrenchFrame;
use super::numbers::usable;
use crate::math::{Vector, dot, norm, unit};
use crate::scalar::Real;
use crate::support::failure::EMPTY;
use crate::support::{Failure, Support};

/// A primitive wrench set W_i = { center + disc x : |x| <= 1 } in R^6 (paper, eq. 6): an ellipsoid of at most three
/// dimensions, a point, or empty.
///
/// Support function `h(u) = center.u + |disc^T u|`, mapping `center + disc w/|w|` with w = disc^T u.
///
/// `error`, with E = |center| + |disc| (Frobenius): 6 roundoffs for w and thus twice 6 for the choice of the point, 5
/// for the unit vector, 4 for center + disc x make `24 u E`. A primitive made of a contact counts the roundings of the
/// contact map, too, 14 for the map and its product with the force, `16 u |G| |f|`: it keeps the promise for the
/// contact's exact numbers. `errors` are the same row by row: each rounding is one of a sum of products, and relative to
/// their sizes. So forces are as exact as they are beside moments of any size.
///
/// ```
/// use qdist::{Vector, grasp::{Contact, ContactError, Friction, Primitive, WrenchFrame}, support::Support};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let contact = Contact::new(Vector::zeros(), Vector::from([0.0, 0.0, 1.0]), Friction::Hard { mu: 0.5 })?;
/// let w = Primitive::passive(&contact, &frame)?;
/// let u = Vector::from([3.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
/// assert_eq!(w.value(&u), 1.0 + 0.5 * 3.0);
/// assert_eq!(w.support(&u).unwrap(), Vector::from([0.5, 0.0, 1.0, 0.0, 0.0, 0.0]));
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)] // numbers in a row, as C callers keep them
pub struct Primitive<T> {
    center: Vector<T, 6>,
    disc: SMatrix<T, 6, 3>,
    /// Bounds of what rounding has moved each coordinate of center + disc x by, when they were computed.
    rounding: Vector<T, 6>,
    /// 0 or 1.
    empty: u32,
}

impl<T: Real> Primitive<T> {
    /// The empty set: a contact that can exert nothing. In a [`WrenchSet`](super::WrenchSet) it is as if it were not there.
    pub fn empty() -> Self {
        Self { center: Vector::zeros(), disc: SMatrix::zeros(), rounding: Vector::zeros(), empty: 1 }
    }

    /// { center + disc x : |x| <= 1 } for any wrenches: a contact model of your own. A disc of zeros is a point.
    ///
    /// # Errors
    /// [`ContactError::Wrench`].
    pub fn new(center: Vector<T, 6>, disc: SMatrix<T, 6, 3>) -> Result<Self, ContactError> {
        if !(usable(center.iter()) && usable(disc.iter())) {
            return Err(ContactError::Wrench);
        }
        Ok(Self { center, disc, rounding: Vector::zeros(), empty: 0 })
    }

    /// All wrenches of the contact with its full normal force, whoever generates them: G(U) with the U of eq. 7 times
    /// the force cap. The center is the wrench of the normal force, the disc that of mu o, mu t and mus about n.
    ///
    /// # Errors
    /// [`ContactError::Wrench`].
    pub fn passive(contact: &Contact<T>, frame: &WrenchFrame<T>) -> Result<Self, ContactError> {
        let [o, t, n] = frame.friction_radii(contact);
        let (one, zero) = (T::one(), T::zero());
        let disc = SMatrix::from([[zero, o, zero, zero], [zero, zero, t, zero], [zero, zero, zero, n]]);
        Self::of_forces(contact, frame, &Vector::from([one, zero, zero, zero]), &disc)
    }

    /// The image of the contact forces cap * { center + disc x : |x| <= 1 }.
    pub(super) fn of_forces(
        contact: &Contact<T>,
        frame: &WrenchFrame<T>,
        center: &Vector<T, 4>,
        disc: &SMatrix<T, 4, 3>,
    ) -> Result<Self, ContactError> {
        let (map, cap) = (frame.contact_map(contact), contact.force_cap());
        let image = Self::new(map * center * cap, map * disc * cap)?;
        // What the terms of each coordinate add up to, whatever their signs.
        let forces = disc.column_iter().fold(center.abs(), |sum, column| sum + column.abs());
        let sizes = frame.contact_map_sizes(contact) * forces;
        let rounding = sizes * (T::count(16) * T::ROUNDOFF * cap);
        if usable(rounding.iter()) { Ok(Self { rounding, ..image }) } else { Err(ContactError::Wrench) }
    }

    /// The center: of a contact without friction the only wrench. Zero for the empty set.
    pub fn center(&self) -> &Vector<T, 6> {
        &self.center
    }

    /// The disc as a matrix; its columns need not be orthogonal, and some may be zero.
    pub fn disc(&self) -> &SMatrix<T, 6, 3> {
        &self.disc
    }

    /// Has it no wrench at all?
    pub fn is_empty(&self) -> bool {
        self.empty != 0
    }

    /// h(u) for u not far from unit length, to within [`error`](Support::error) |u|; `-HUGE` for the empty set. About
    /// 50 operations.
    pub fn value(&self, u: &Vector<T, 6>) -> T {
        if self.is_empty() { -T::HUGE } else { self.farthest(u).value }
    }

    /// The value and what the point needs. `u` near unit length ([`near_unit`]), or rounding may go below the format's
    /// range.
    #[inline]
    fn farthest(&self, u: &Vector<T, 6>) -> Farthest<T> {
        let along: Vector<T, 3> = Vector::from(self.disc.data.0.each_ref().map(|column| dot(column, &u.data.0[0])));
        let length = norm(&along);
        Farthest { value: dot(&self.center.data.0[0], &u.data.0[0]) + length, along, length }
    }

    /// The point that [`farthest`](Self::farthest) found.
    #[inline]
    fn point(&self, farthest: &Farthest<T>) -> Vector<T, 6> {
        if !(farthest.length > T::zero()) {
            return self.center;
        }
        self.center + self.disc * unit(&farthest.along)
    }

    /// |center| + |disc|: every rounding is relative to it.
    fn size(&self) -> T {
        norm(&self.center) + frobenius(&self.disc)
    }

    /// The same row by row: no wrench has a larger coordinate.
    fn sizes(&self) -> Vector<T, 6> {
        Vector::from_fn(|i, _| self.center[i].abs() + norm(&self.disc.row(i).transpose()))
    }
}

struct Farthest<T> {
    value: T,
    along: Vector<T, 3>,
    length: T,
}

impl<T: Real> Support<T, 6> for Primitive<T> {
    /// # Errors
    /// The empty set has no point.
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        if self.is_empty() {
            return Err(Failure(EMPTY));
        }
        Ok(self.point(&self.farthest(&near_unit(u))))
    }
    /// |c + D x|^2 <= |c|^2 + 2 |D^T c| + |D|^2, with |D|^2 at most the trace and at most the largest row sum of D^T D.
    fn extent(&self) -> T {
        let gram = self.disc.tr_mul(&self.disc);
        let row_sum = |row: usize| (0..3).fold(T::zero(), |s, j| s + gram[(row, j)].abs());
        let largest = (0..3).fold(T::zero(), |m, i| m.at_least(row_sum(i)));
        let cross = norm(&self.disc.tr_mul(&self.center));
        let squared = self.center.dot(&self.center) + cross + cross + gram.trace().at_most(largest);
        // Squares may have left the range of the format.
        let length = if squared > T::SAFE_SQUARE { squared.root().at_most(self.size()) } else { self.size() };
        length * (T::one() + T::count(32) * T::ROUNDOFF) + norm(&self.rounding)
    }
    fn error(&self) -> T {
        // TINY: products that leave the range of the format.
        norm(&self.rounding) + T::count(24) * T::ROUNDOFF * self.size() + T::TINY
    }
    fn errors(&self) -> Vector<T, 6> {
        (self.rounding + self.sizes() * (T::count(24) * T::ROUNDOFF)).add_scalar(T::TINY)
    }
    fn extents(&self) -> Vector<T, 6> {
        self.sizes() * (T::one() + T::count(8) * T::ROUNDOFF) + self.rounding
    }
}

impl<T: Real> Contribution<T> for Primitive<T> {
    fn support_above(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
        if self.is_empty() {
            return Ok(None);
        }
        let farthest = self.farthest(u);
        Ok((farthest.value > floor).then(|| (farthest.value, self.point(&farthest))))
    }
    /// Number for number; columns of the disc may be in another order and have other signs: |x| <= 1 does not see that. Rounded numbers
    /// are compared without tolerance.
    fn is_mirror_of(&self, other: &Self, signs: &Vector<T, 6>) -> bool {
        let flipped = other.center.component_mul(signs);
        if self.empty != other.empty || self.center != flipped {
            return false;
        }
        let mut taken = [false; 3];
        other.disc.column_iter().all(|column| {
            let column = column.component_mul(signs);
            let same = |own: &[T; 6]| {
                let own = own.iter().zip(column.iter());
                own.clone().all(|(a, b)| *a == *b) || own.clone().all(|(a, b)| *a == -*b)
            };
            let mut candidates = self.disc.data.0.iter().zip(taken.iter_mut());
            candidates.find(|(own, taken)| !**taken && same(own)).map(|(_, taken)| *taken = true).is_some()
        })
    }
}

/// Root of the sum of squares, column by column so that small squares are not lost.
pub(super) fn frobenius<T: Real, const R: usize, const C: usize>(m: &SMatrix<T, R, C>) -> T {
    norm(&Vector::<T, C>::from(m.data.0.map(|column| norm(&Vector::<T, R>::from(column)))))
}
