//! How the joints of a finger move a contact.

use super::contact::ContactError;
use super::numbers::{check_tolerance, usable};
use super::svd::Svd;
use crate::math::dot;
use crate::scalar::Real;

/// The largest number of joints of a finger.
pub const MAX_JOINTS: usize = 8;

/// The Jacobian of a contact, 4 x q with q <= 8: joint torques are `J^T f` (paper, eq. 9).
///
/// Column j is what one unit of joint velocity j does to the finger at the contact point: its velocity along n, o, t,
/// and its angular velocity about n. Units: those of position per joint unit in the first three rows, 1 per joint unit
/// (radians) in the last. Locked joints have no column.
///
/// ```
/// use qdist::grasp::{ContactError, Jacobian, default_tolerance};
/// // A finger of four joints, the last coupled 1:1 to the third: three actuators.
/// let joints = Jacobian::new([
///     &[0.0, 0.9, 0.5, 0.2],
///     &[0.0, 0.3, 0.4, 0.3],
///     &[0.8, 0.0, 0.0, 0.0],
///     &[0.6, 0.0, 0.0, 0.0],
/// ])?;
/// let finger = joints.coupled(&[&[1.0, 0.0, 0.0], &[0.0, 1.0, 0.0], &[0.0, 0.0, 1.0], &[0.0, 0.0, 1.0]])?;
/// assert_eq!(finger.joints(), 3);
/// assert_eq!(finger.rank(1.0, default_tolerance())?, 3);
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jacobian<T> {
    /// Row by row; zero from column `joints` on.
    rows: [[T; MAX_JOINTS]; 4],
    joints: usize,
}

impl<T: Real> Jacobian<T> {
    /// The Jacobian with these rows (n, o, t, spin), all of one length from 0 to 8.
    ///
    /// # Errors
    /// [`ContactError::Jacobian`].
    pub fn new(rows: [&[T]; 4]) -> Result<Self, ContactError> {
        let [first, ..] = rows;
        let fits = rows.iter().all(|row| row.len() == first.len() && usable(row.iter()));
        if !(fits && first.len() <= MAX_JOINTS) {
            return Err(ContactError::Jacobian);
        }
        Ok(Self { rows: rows.map(padded), joints: first.len() })
    }

    /// The Jacobian of actuators that drive the joints together: `J C`, where row j of the coupling matrix C says how
    /// fast joint j turns per unit velocity of each actuator. One row per joint, all of one length from 0 to 8.
    ///
    /// # Errors
    /// [`ContactError::Coupling`]; [`ContactError::Jacobian`] when an entry of the product is too large.
    pub fn coupled(&self, coupling: &[&[T]]) -> Result<Self, ContactError> {
        let actuators = coupling.first().map_or(0, |row| row.len());
        let fits = coupling.iter().all(|row| row.len() == actuators && usable(row.iter()));
        if !(fits && coupling.len() == self.joints && actuators <= MAX_JOINTS) {
            return Err(ContactError::Coupling);
        }
        let rows = self.rows.map(|own| {
            own.iter().zip(coupling).fold([T::zero(); MAX_JOINTS], |mut sum, (&x, row)| {
                sum.iter_mut().zip(*row).for_each(|(s, &c)| *s += x * c);
                sum
            })
        });
        if !usable(rows.iter().flatten()) {
            return Err(ContactError::Jacobian);
        }
        Ok(Self { rows, joints: actuators })
    }

    /// Column j, with its spin entry times `torque_scale`: what a force, moments divided by the scale, does to joint j.
    pub(super) fn column(&self, j: usize, torque_scale: T) -> [T; 4] {
        let [n, o, t, spin] = self.rows.each_ref().map(|row| row.get(j).copied().unwrap_or(T::zero()));
        [n, o, t, spin * torque_scale]
    }

    /// The number q of columns.
    pub fn joints(&self) -> usize {
        self.joints
    }

    /// Entry of row 0 to 3 and column 0 to q - 1; `None` elsewhere.
    pub fn entry(&self, row: usize, column: usize) -> Option<T> {
        self.rows.get(row)?.get(..self.joints)?.get(column).copied()
    }

    /// The rank r, 0 to 4: the number of singular values above `tolerance` times the largest one, of the Jacobian with
    /// its spin row times `torque_scale`, the unit in which moments count ([`WrenchFrame`](super::WrenchFrame)).
    ///
    /// # Errors
    /// [`ContactError::Tolerance`]: below 16 roundoffs or above 1/2. [`ContactError::Frame`]: a torque scale that is
    /// not finite or too large.
    pub fn rank(&self, torque_scale: T, tolerance: T) -> Result<usize, ContactError> {
        if !usable([torque_scale].iter()) {
            return Err(ContactError::Frame);
        }
        Ok(self.range(torque_scale, tolerance)?.0)
    }

    /// The rank r and an orthonormal basis of R^4 whose first r vectors span the range of J, which is that of its
    /// pseudo-inverse J^{+T}: the columns of A in eq. 10.
    pub(super) fn range(&self, torque_scale: T, tolerance: T) -> Result<(usize, [[T; 4]; 4]), ContactError> {
        check_tolerance(tolerance)?;
        let (svd, _) = self.decomposed(torque_scale);
        let [sigma, ..] = svd.sigma;
        Ok((svd.rank(tolerance * sigma), svd.v))
    }

    /// J^+ f, from as many singular values as its rank: the shortest c with J c = f for an f in the range. `f` and the
    /// rows of J with moments divided by the torque scale.
    pub(super) fn pseudo_inverse(&self, torque_scale: T, rank: usize, f: &[T; 4]) -> [T; MAX_JOINTS] {
        let (svd, largest) = self.decomposed(torque_scale);
        let mut c = [T::zero(); MAX_JOINTS];
        for ((image, v), sigma) in svd.image.iter().zip(&svd.v).zip(svd.sigma).take(rank) {
            let share = dot(v, f) / sigma / sigma / largest;
            c.iter_mut().zip(image).for_each(|(c, &x)| *c += share * x);
        }
        c
    }

    /// The singular value decomposition of J^T / m, and m, the largest entry: J^T V has orthogonal columns.
    fn decomposed(&self, torque_scale: T) -> (Svd<T, MAX_JOINTS, 4>, T) {
        let [n, o, t, spin] = self.rows;
        let rows = [n, o, t, spin.map(|x| x * torque_scale)];
        let largest = rows.iter().flatten().fold(T::zero(), |m, x| m.at_least(x.abs()));
        // The rows of J are the columns of J^T.
        let scaled = rows.map(|row| row.map(|x| if largest > T::zero() { x / largest } else { x }));
        (Svd::new(scaled), largest)
    }
}

fn padded<T: Real>(row: &[T]) -> [T; MAX_JOINTS] {
    let mut all = [T::zero(); MAX_JOINTS];
    all.iter_mut().zip(row).for_each(|(to, from)| *to = *from);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_matrices_are_refused() {
        let long = [0.0; 9];
        assert_eq!(Jacobian::new([&long; 4]), Err(ContactError::Jacobian));
        assert_eq!(Jacobian::new([&long[..2], &long[..2], &long[..3], &long[..2]]), Err(ContactError::Jacobian));
        for bad in [f64::NAN, f64::INFINITY, 1e200] {
            assert_eq!(Jacobian::new([&[0.0], &[0.0], &[bad], &[0.0]]), Err(ContactError::Jacobian));
            let j = Jacobian::new([&[1.0, 2.0]; 4]).unwrap();
            assert_eq!(j.coupled(&[&[1.0], &[bad]]), Err(ContactError::Coupling));
            assert_eq!(j.rank(bad, 1e-9), Err(ContactError::Frame));
        }
        let j = Jacobian::new([&[1e140, 2.0]; 4]).unwrap();
        assert_eq!(j.coupled(&[&[1.0]]), Err(ContactError::Coupling));
        assert_eq!(j.coupled(&[&[1.0], &[1.0, 0.0]]), Err(ContactError::Coupling));
        assert_eq!(j.coupled(&[&long, &long]), Err(ContactError::Coupling));
        assert_eq!(j.coupled(&[&[1e140], &[1.0]]), Err(ContactError::Jacobian));
        for bad in [f64::NAN, 0.0, 1e-16, 0.6, -1.0] {
            assert_eq!(j.rank(1.0, bad), Err(ContactError::Tolerance));
        }
    }

    #[test]
    fn ranks() {
        let rank = |rows: [&[f64]; 4]| Jacobian::new(rows).unwrap().rank(1.0, 1e-9).unwrap();
        assert_eq!(rank([&[]; 4]), 0);
        assert_eq!(rank([&[0.0, 0.0]; 4]), 0);
        assert_eq!(rank([&[1.0, 2.0]; 4]), 1);
        assert_eq!(rank([&[1.0, 0.0], &[0.0, 1.0], &[0.0, 0.0], &[0.0, 0.0]]), 2);
        let small = |x: f64| rank([&[1e100, 0.0], &[0.0, x * 1e100], &[0.0, 0.0], &[0.0, 0.0]]);
        assert_eq!((small(2e-9), small(0.5e-9)), (2, 1));
        let j = Jacobian::new([&[0.0], &[0.0], &[0.0], &[1.0]]).unwrap();
        assert_eq!((j.entry(3, 0), j.entry(3, 1), j.entry(4, 0)), (Some(1.0), None, None));
        assert_eq!(j.coupled(&[&[]]).unwrap().rank(1.0, 1e-9), Ok(0));
    }
}
