//! What tools that linearise friction do, as read in their sources.

use super::super::contact::{Contact, ContactError, Friction};
use super::super::frame::WrenchFrame;
use super::super::numbers::usable;
use super::super::wrench_set::Norm;
use super::Layout;
use crate::math::{Vector, norm, unit};
use crate::scalar::Real;

/// What one tool computes: contacts, frame, layout and norm. Q is the unit ball.
///
/// ```
/// use qdist::grasp::{ContactError, Friction, PyramidalCone, Preset, WrenchSet, linearized};
/// use qdist::{Options, Vector, Workspace, qset::Ball};
/// let preset = Preset::frogger(4, 1.0)?;
/// let contact = |x: f64, y: f64, z: f64| {
///     let p = Vector::from([x, y, z]);
///     preset.contact(p, -p.normalize(), Friction::Hard { mu: 0.7 })
/// };
/// let contacts = [contact(1.0, 0.1, 0.2)?, contact(-0.4, 0.8, 0.1)?, contact(-0.5, -0.9, -0.2)?];
/// let (mut edges, mut cones) = ([[0.0; 6]; 12], [PyramidalCone::empty(); 3]);
/// let cones = linearized(&contacts, &preset.frame, &preset.layout, &mut edges, &mut cones).unwrap();
/// let mut memory = Workspace::<f64, 6, 256, 2048>::new();
/// let theirs = memory.solver().solve(&WrenchSet::new(cones, preset.norm), &Ball::unit(), &Options::default());
/// assert!(theirs.lower > 0.0);
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset<T> {
    /// Reference point and torque scale.
    pub frame: WrenchFrame<T>,
    /// The edges.
    pub layout: Layout<T>,
    /// How forces of several contacts are measured together.
    pub norm: Norm,
    tangents: Tangents,
}

/// How a tool lays the tangents.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Tangents {
    /// o = n x e_x, or n x e_z where n is along e_x.
    GraspIt,
    /// o is the projection of e_x.
    DexNet,
    /// o is the projection of (1.2, 2.3, 3.4); edges of unit length.
    Frogger,
}

impl<T: Real> Preset<T> {
    /// GraspIt! with an object of this centre of gravity and largest radius about it (`getMaxRadius`), L1 or LInf. `millimetre`, its unit of
    /// length, in the caller's: where the edges of soft contacts are depends on it. A soft contact's mus is its `8 sqrt(a b) / 15 mu`, with a
    /// and b the semi axes of the contact ellipse.
    ///
    /// # Errors
    /// [`ContactError::Frame`], also for a millimetre that is not positive.
    pub fn graspit(center: Vector<T, 3>, max_radius: T, millimetre: T, norm: Norm) -> Result<Self, ContactError> {
        WrenchFrame::new(center, millimetre)?;
        let frame = WrenchFrame::new(center, max_radius)?;
        Ok(Self { frame, layout: Layout::GraspIt { millimetre }, norm, tangents: Tangents::GraspIt })
    }

    /// Dex-Net's `ferrari_canny_L1`, for an object of this centre of mass; `torque_scale` is the inverse of its `torque_scaling`: unless
    /// configured, the median of the three coordinates of the upper corner of the bounding box. 8 sides and a fingertip of 0.005 are its defaults.
    ///
    /// Dex-Net aligns o with e_x to the nearest of 1000 angles; here it is exact, which moves edges by up to 0.003 rad. Where n is along
    /// e_x, its tangents are those of a numerical SVD: set them by [`Contact::with_tangents`].
    ///
    /// # Errors
    /// [`ContactError::Frame`]; [`ContactError::Wrench`] for a radius that is negative or not finite.
    pub fn dex_net(
        center: Vector<T, 3>,
        torque_scale: T,
        sides: usize,
        finger_radius: T,
    ) -> Result<Self, ContactError> {
        if !(finger_radius >= T::zero() && usable([finger_radius].iter())) {
            return Err(ContactError::Wrench);
        }
        let frame = WrenchFrame::new(center, torque_scale)?;
        let layout = Layout::DexNet { sides, finger_radius };
        Ok(Self { frame, layout, norm: Norm::L1, tangents: Tangents::DexNet })
    }

    /// FRoGGeR's `ferrari_canny_L1` with its `ns` sides and `lamb` > 0, both by default 4 and 1; positions in the object's frame. For
    /// its min-weight metric see [`opposed_mean`](super::opposed_mean).
    ///
    /// # Errors
    /// [`ContactError::Frame`] for a `lamb` that is not a positive number of usual size.
    pub fn frogger(sides: usize, lamb: T) -> Result<Self, ContactError> {
        if !(lamb > T::zero() && lamb.finite()) {
            return Err(ContactError::Frame);
        }
        let frame = WrenchFrame::new(Vector::zeros(), lamb.root().recip())?;
        Ok(Self { frame, layout: Layout::Inscribed { sides }, norm: Norm::L1, tangents: Tangents::Frogger })
    }

    /// A contact as the tool has it, with its tangents and the length of its edges as force cap. (Dex-Net's normal force is the
    /// cosine between closing direction and normal: set it by [`Contact::with_force_cap`].) The *exact* d beside the tool's number is
    /// that of the [`Primitive`](super::super::Primitive)s of the same contacts.
    ///
    /// # Errors
    /// Those of [`Contact::new`].
    pub fn contact(
        &self,
        position: Vector<T, 3>,
        normal: Vector<T, 3>,
        friction: Friction<T>,
    ) -> Result<Contact<T>, ContactError> {
        let contact = Contact::new(position, normal, friction)?;
        let (zero, one) = (T::zero(), T::one());
        let x = Vector::from([one, zero, zero]);
        let projected = |v: Vector<T, 3>| v - normal * normal.dot(&v);
        let o = match self.tangents {
            Tangents::GraspIt if norm(&normal.cross(&x)) > T::ROUNDOFF.root() => normal.cross(&x),
            Tangents::GraspIt => normal.cross(&Vector::from([zero, zero, one])),
            Tangents::DexNet => projected(x),
            Tangents::Frogger => projected(Vector::from([1.2, 2.3, 3.4].map(T::of))),
        };
        let contact = if norm(&o) > T::ROUNDOFF.root() {
            let o = unit(&o);
            contact.with_tangents(o, normal.cross(&o))?
        } else {
            contact
        };
        match self.tangents {
            Tangents::Frogger => {
                let (mu, _) = friction.coefficients();
                contact.with_force_cap((one + mu * mu).root().recip())
            }
            _ => Ok(contact),
        }
    }
}
