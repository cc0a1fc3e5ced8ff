//! Where the edges of a pyramid are.

use super::super::contact::{Contact, Friction};
use crate::scalar::Real;

/// Where the edges of a pyramid are, in units of the cone: x on the unit circle for hard contacts, on the unit sphere for soft ones, for
/// the force (1, mu x1, mu x2, mus x3) times the force cap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Layout<T> {
    /// `sides` edges on the circle, the first along o, inside the cone; soft contacts have two more at the poles. At least 3.
    Inscribed {
        /// Edges on the circle.
        sides: usize,
    },
    /// The same, so much longer that the pyramid contains the cone.
    Circumscribed {
        /// Edges on the circle.
        sides: usize,
    },
    /// GraspIt!: 8 for hard contacts. For soft ones 1, 5, 8, 5 and 1 at the latitudes 90, 45, 0, -45, -90 degrees, measured before
    /// the sphere is stretched to the ellipsoid with the semi axes 1, 1, mus / (mu `millimetre`).
    GraspIt {
        /// One millimetre in the unit of the positions.
        millimetre: T,
    },
    /// Dex-Net: `sides` edges on the circle, and for soft contacts two wrenches more, moments of π r^2 mu about n *without a normal force*: mus does
    /// not count, and the set is no subset of any friction cone.
    DexNet {
        /// Edges on the circle, 8 in its default.
        sides: usize,
        /// Radius r of the fingertip, 0.005 m in its default. The product is a moment when it is read as such; no unit fits.
        finger_radius: T,
    },
}

impl<T: Real> Layout<T> {
    /// How many edges a contact has.
    pub fn edges(&self, friction: Friction<T>) -> usize {
        let soft = matches!(friction, Friction::Soft { .. });
        match (*self, soft) {
            (Self::GraspIt { .. }, true) => 20,
            (Self::GraspIt { .. }, false) => 8,
            (Self::Inscribed { sides } | Self::Circumscribed { sides } | Self::DexNet { sides, .. }, true) => {
                sides.saturating_add(2)
            }
            (Self::Inscribed { sides } | Self::Circumscribed { sides } | Self::DexNet { sides, .. }, false) => sides,
        }
    }

    /// Edge number `index` as (normal force, x); x3 of Dex-Net in units of L.
    pub(super) fn edge(&self, index: usize, contact: &Contact<T>, torque_scale: T) -> (T, [T; 3]) {
        let (zero, one) = (T::zero(), T::one());
        let (mu, mus) = contact.friction().coefficients();
        let soft = matches!(contact.friction(), Friction::Soft { .. });
        let angle = |k: usize, n: usize| {
            let turn = T::two_pi() * T::count(k) / T::count(n);
            [turn.cos(), turn.sin()]
        };
        let pole = |k: usize, n: usize| if k == n { one } else { -one };
        match *self {
            Self::Inscribed { sides } | Self::Circumscribed { sides } => {
                let x = match angle(index, sides) {
                    _ if index >= sides => [zero, zero, pole(index, sides)],
                    [c, s] => [c, s, zero],
                };
                let half = (T::pi() / T::count(sides)).cos();
                // Of the polygon, and of the double pyramid over it: the distance of a face.
                let depth = if soft { (one + one / (half * half)).root().recip() } else { half };
                (one, if let Self::Circumscribed { .. } = self { x.map(|x| x / depth) } else { x })
            }
            Self::DexNet { sides, finger_radius } if index >= sides => {
                let moment = T::pi() * finger_radius * finger_radius * mu / torque_scale;
                (zero, [zero, zero, moment * pole(index, sides)])
            }
            Self::DexNet { sides, .. } => {
                let [c, s] = angle(index, sides);
                (one, [c, s, zero])
            }
            Self::GraspIt { .. } if !soft => {
                let [c, s] = angle(index, 8);
                (one, [c, s, zero])
            }
            Self::GraspIt { millimetre } => {
                let (first, count, latitude) = match index {
                    0 => (0, 1, T::frac_pi_2()),
                    1..6 => (1, 5, T::frac_pi_4()),
                    6..14 => (6, 8, zero),
                    14..19 => (14, 5, -T::frac_pi_4()),
                    _ => (19, 1, -T::frac_pi_2()),
                };
                let [c, s] = angle(index - first, count);
                let (level, rise) = (latitude.cos(), latitude.sin());
                let height = if mu > zero { mus / (mu * millimetre) } else { one };
                // |(c, s, rise / height)|: from the sphere out to the ellipsoid, then back to units of its axes.
                if !(height > zero) {
                    return (one, if rise.is_zero() { [c, s, zero] } else { [zero; 3] });
                }
                let up = rise / height;
                let length = (level * level + up * up).root();
                if length > zero {
                    (one, [c * level / length, s * level / length, up / length])
                } else {
                    (one, [zero; 3])
                }
            }
        }
    }
}
