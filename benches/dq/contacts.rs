//! Grasps as sets: the wrenches that contacts can exert, known by their support function (paper, Section II).
//!
//! A contact at p with inward normal n and tangents o, t maps a force (f1, f2, f3) and a torque f4 about the normal
//! to the wrench G f, with G = [n o t 0; p x n, p x o, p x t, n]. A soft finger exerts the f with f1 <= 1 and
//! sqrt((f2^2 + f3^2) / mu^2 + f4^2 / mus^2) <= f1: a cone over an ellipsoid, so that with g = G' u
//!
//! ```text
//! h_i(u) = g1 + s,  s = sqrt(mu^2 (g2^2 + g3^2) + mus^2 g4^2)
//!                   attained at f = (1, mu^2 g2 / s, mu^2 g3 / s, mus^2 g4 / s)
//! ```
//!
//! A hard finger has mus = 0 and a frictionless one mu = 0 too. Columns of G are stored times 1, mu, mu, mus: then the
//! ellipsoid is the unit ball, and one formula serves all kinds and, with columns left out, planar fingers.
//!
//! No force at all is a force: {0} belongs to the wrenches of every contact.

use nalgebra::{SMatrix, Vector3, Vector4};
use qdist::support::{Failure, Support};
use qdist::{Real, Vector};

/// What the unit bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Norm {
    /// Every normal force (L-infinity): the set is a sum over the contacts.
    Each,
    /// Their sum (L1): the set is a hull.
    Total,
}

/// One contact: G with its columns times 1, mu, mu, mus.
pub type Contact<const N: usize> = SMatrix<f64, N, 4>;

/// A contact in space, in wrenches (f, p x f).
pub fn spatial(p: Vector3<f64>, [n, o, t]: [Vector3<f64>; 3], mu: f64, mus: f64) -> Contact<6> {
    let wrench = |f: Vector3<f64>, torque: Vector3<f64>| {
        Vector::<f64, 6>::from_fn(|i, _| if i < 3 { f[i] } else { torque[i - 3] })
    };
    let force = |f: Vector3<f64>| wrench(f, p.cross(&f));
    Contact::from_columns(&[force(n), force(o) * mu, force(t) * mu, wrench(Vector3::zeros(), n) * mus])
}

/// The part of a contact that a finger exerts whose joints all turn about z, in (f_x, f_y, m_z): no force along z, no
/// torque about the normal. (For a contact with p, n, o in that plane; W^a of Section III.)
pub fn planar(contact: &Contact<6>) -> Contact<3> {
    Contact::from_fn(|i, j| if j < 2 { contact[([0, 1, 5][i], j)] } else { 0.0 })
}

/// The wrenches of all contacts together.
pub struct Grasp<T, const N: usize> {
    contacts: Vec<SMatrix<T, N, 4>>,
    norm: Norm,
    extent: T,
}

impl<T: Real, const N: usize> Grasp<T, N> {
    pub fn new(contacts: &[Contact<N>], norm: Norm) -> Self {
        let contacts: Vec<_> = contacts.iter().map(|c| c.map(T::of)).collect();
        // |c1 + sum t_k c_k| <= |c1| + sqrt(sum |c_k|^2) for |t| <= 1.
        let size = |c: &SMatrix<T, N, 4>| c.column(0).norm() + c.columns(1, 3).norm();
        let sizes = contacts.iter().map(size);
        let size = match norm {
            Norm::Each => sizes.fold(T::zero(), |sum, x| sum + x),
            Norm::Total => sizes.fold(T::zero(), T::at_least),
        };
        let up = T::one() + T::count(64) * T::ROUNDOFF;
        Self { contacts, norm, extent: size * up }
    }
}

/// A contact's h_i(u), and the point where it is attained.
#[inline(always)]
fn farthest<T: Real, const N: usize>(contact: &SMatrix<T, N, 4>, u: &Vector<T, N>) -> (T, Vector4<T>) {
    let g = contact.tr_mul(u);
    let squares = g[1] * g[1] + g[2] * g[2] + g[3] * g[3];
    // Below this, squares have lost digits, and the root is far below the rounding of g1.
    if squares > T::SAFE_SQUARE {
        let s = squares.root();
        let inverse = T::one() / s;
        (g[0] + s, Vector4::new(T::one(), g[1] * inverse, g[2] * inverse, g[3] * inverse))
    } else {
        (g[0], Vector4::new(T::one(), T::zero(), T::zero(), T::zero()))
    }
}

impl<T: Real, const N: usize> Support<T, N> for Grasp<T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let mut point = Vector::zeros();
        let mut most = T::zero();
        for contact in &self.contacts {
            let (height, force) = farthest(contact, u);
            match self.norm {
                Norm::Each if height > T::zero() => point += contact * force,
                Norm::Total if height > most => (most, point) = (height, contact * force),
                _ => {}
            }
        }
        Ok(point)
    }

    /// Where every contact is: its center, and up to signs the axes of its ellipsoid.
    fn mirrored(&self, signs: u8) -> bool {
        let flip = |i: usize, x: T| if signs >> i & 1 == 1 { -x } else { x };
        self.contacts.iter().all(|contact| {
            let kept = |j: usize, sign: T| (0..N).all(|i| flip(i, contact[(i, j)]) == contact[(i, j)] * sign);
            kept(0, T::one()) && (1..4).all(|j| kept(j, T::one()) || kept(j, -T::one()))
        })
    }

    fn extent(&self) -> T {
        self.extent
    }

    /// Roundings, each relative to a contact's size: N + 1 in every g, which count twice, as they may choose another
    /// point and a wrong sign; 8 in the point of the unit ball, 5 in its wrench; one for each contact in the sum.
    /// Twice that, to be safe.
    fn error(&self) -> T {
        T::count(2 * (N + 1) + 13 + self.contacts.len()) * T::count(2) * T::ROUNDOFF * self.extent
    }
}
