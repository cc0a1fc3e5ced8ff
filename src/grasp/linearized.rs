//! Linearised friction cones, for comparison with the tools that use them.
//!
//! Grasp planners commonly replace the friction cone by a pyramid of m edges and compute d from the facets of the hull of
//! all edges. That is d of another, smaller set, and by how much smaller is not known to them. Here a pyramid is a
//! [`Contribution`] like any other, so the same solver brackets *their* number, and beside it stands the exact one of the cone.
//! An inscribed pyramid bounds d from below; a circumscribed one from above. For hard contacts the friction of one is cos(π/m) of that of the other.
//!
//! A [`Preset`] is what one tool does, as read in its source: where moments are taken and what they are divided by, how the tangents
//! lie, how many edges there are and how long, and the norm. Q is the unit ball in all of them.
//!
//! | | GraspIt! | Dex-Net 2 | FRoGGeR |
//! |---|---|---|---|
//! | edges, hard | 8, unit normal force | 8 (`num_cone_faces`), unit normal force | 4 (`ns`), unit length |
//! | edges, soft | 1, 5, 8, 5, 1 at five torsions | 8, and two torsions *without* normal force | - |
//! | torsion per force | 8 sqrt(ab)/15 mu | π r^2 mu | - |
//! | moments about | centre of gravity | centre of mass | origin of the object frame |
//! | divided by | largest radius of the object | median of the upper corner of its bounding box | 1 / sqrt(lamb), 1 |
//! | norm | L1 or LInf | L1 | L1 |
//!
//! Sources, by file and function:
//! * GraspIt! (graspit-simulator/graspit): `contact/contact.cpp` `wrenchFromFrictionEdge`, `setUpFrictionEllipsoid`;
//!   `contact/pointContact.cpp` and `softContact.cpp` `setUpFrictionEdges`; `gws.cpp` `L1GWS::build`, `minkowskiSum`.
//! * Dex-Net (BerkeleyAutomation/dex-net): `grasping/contacts.py` `tangents`, `friction_cone`, `normal_force_magnitude`;
//!   `grasping/quality.py` `grasp_quality`, `grasp_matrix`, `ferrari_canny_L1`.
//! * FRoGGeR (alberthli/frogger): `grasping.py` `compute_gOCs`, `compute_primitive_forces`; `metrics.py` `ferrari_canny_L1`,
//!   `min_weight_lp`; `robots/robot_core.py` `_finish_ineq_cons`.
//!
//! Their L1 hulls do not contain {0} by definition. That is the same set where the grasp is closed; where it is not, d is 0 here, 0 in
//! Dex-Net, -1 in FRoGGeR.
//! Dex-Net adds a regularizer of 1e-10 to the squared distance of each facet: its number is sqrt(d^2 + 1e-10 |v|^2) with convex
//! weights v, at most 1e-5 above d. GraspIt! lets Qhull merge facets whose centres are within 1e-4 of each other's planes (`C-0.0001`).
//!
//! **FRoGGeR's min-weight metric** is a ray. It is the largest l with 0 = Σ α_j w_j, Σ α_j = 1, α_j >= l, over all N edges, times N: with w the mean
//! of the edges and t the largest number with -t w in their hull, `N l = t / (1 + t)`. So t is d for Q = [`Segment`] from 0 to -w
//! ([`opposed_mean`]), and [`min_weight`] its N l.

use super::contact::{Contact, ContactError, Friction, GraspError};
use super::contribution::Contribution;
use super::frame::WrenchFrame;
use super::numbers::usable;
use super::primitive::frobenius;
use super::wrench_set::Norm;
use crate::math::{Vector, norm, unit};
use crate::qset::Segment;
use crate::scalar::Real;
use crate::support::failure::EMPTY;
use crate::support::{Failure, Points, Support};

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
    fn edge(&self, index: usize, contact: &Contact<T>, torque_scale: T) -> (T, [T; 3]) {
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

/// The wrenches of a friction pyramid with full normal force: the hull of its edges. A [`WrenchSet`](super::WrenchSet) of these is the set
/// of the linearised grasp.
///
/// Support function by a scan of the edges, which stay in the caller's memory. `error`: that of [`Points`], and 32 roundoffs of
/// |G| |f| for the edges.
///
/// ```
/// use qdist::{Vector, grasp::{Contact, ContactError, Friction, Layout, PyramidalCone, WrenchFrame}, support::Support};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let contact = Contact::new(Vector::zeros(), Vector::from([0.0, 0.0, 1.0]), Friction::Hard { mu: 0.5 })?;
/// let mut memory = [[0.0; 6]; 4];
/// let pyramid = PyramidalCone::new(&contact, &frame, &Layout::Inscribed { sides: 4 }, &mut memory)?;
/// let u = Vector::from([1.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
/// let reach: f64 = pyramid.support(&u).unwrap().dot(&u);
/// assert!((reach - 0.5).abs() < 1e-15); // the cone reaches 0.5 sqrt(2)
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PyramidalCone<'a, T> {
    /// `None`: empty.
    points: Option<Points<'a, T, 6>>,
    rounding: T,
}

impl<'a, T: Real> PyramidalCone<'a, T> {
    /// The empty set, to make a list with.
    pub fn empty() -> Self {
        Self { points: None, rounding: T::zero() }
    }

    /// The pyramid of a contact; its edges are written into `memory`, from the front.
    ///
    /// # Errors
    /// [`ContactError::Room`]: there are fewer places than [`edges`](Layout::edges), or fewer than 3 sides.
    /// [`ContactError::Wrench`]: a coordinate is not finite or too large, or a finger radius is no length.
    /// [`ContactError::Frame`]: a millimetre that is not a positive number of usual size.
    pub fn new(
        contact: &Contact<T>,
        frame: &WrenchFrame<T>,
        layout: &Layout<T>,
        memory: &'a mut [[T; 6]],
    ) -> Result<Self, ContactError> {
        if let Layout::GraspIt { millimetre } = *layout {
            WrenchFrame::new(*frame.reference(), millimetre)?;
        }
        let count = layout.edges(contact.friction());
        let edges = memory.get_mut(..count).filter(|edges| edges.len() >= 3).ok_or(ContactError::Room)?;
        let (map, radii) = (frame.contact_map(contact), frame.friction_radii(contact));
        let [mu, _, mus] = radii;
        let mut longest = T::zero();
        for (index, edge) in edges.iter_mut().enumerate() {
            let (normal, [x, y, z]) = layout.edge(index, contact, frame.torque_scale());
            let spin = if normal > T::zero() { mus } else { T::one() };
            let force = Vector::from([normal, mu * x, mu * y, spin * z]) * contact.force_cap();
            longest = longest.at_least(norm(&force));
            *edge = (map * force).data.0[0];
        }
        if !usable(edges.iter().flatten()) {
            return Err(ContactError::Wrench);
        }
        let rounding = T::count(32) * T::ROUNDOFF * frobenius(&map) * longest;
        let points = Points::new(&*edges).map_err(|_| ContactError::Wrench)?;
        Ok(Self { points: Some(points), rounding })
    }

    /// The edges, as wrenches.
    pub fn edges(&self) -> &'a [[T; 6]] {
        self.points.as_ref().map_or(&[], |points| points.points())
    }
}

impl<T: Real> Support<T, 6> for PyramidalCone<'_, T> {
    /// # Errors
    /// The empty set has no point.
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        self.points.as_ref().ok_or(Failure(EMPTY))?.support(u)
    }
    fn extent(&self) -> T {
        self.points.as_ref().map_or(T::zero(), |points| points.extent() + self.rounding)
    }
    fn error(&self) -> T {
        self.points.as_ref().map_or(T::zero(), |points| points.error() + self.rounding + T::TINY)
    }
}

impl<T: Real> Contribution<T> for PyramidalCone<'_, T> {
    fn reach(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
        let Some(points) = &self.points else { return Ok(None) };
        let point = points.support(u)?;
        let value = point.dot(u);
        Ok((value > floor).then_some((value, point)))
    }
}

/// The pyramids of contacts, into the front of `out`; the slice of them is returned. `memory` has room for all their
/// [`edges`](Layout::edges).
///
/// # Errors
/// Those of [`PyramidalCone::new`]; [`ContactError::Room`] at the first contact for which `memory` or `out` has no room.
pub fn linearized<'a, 'o, T: Real>(
    contacts: &[Contact<T>],
    frame: &WrenchFrame<T>,
    layout: &Layout<T>,
    mut memory: &'a mut [[T; 6]],
    out: &'o mut [PyramidalCone<'a, T>],
) -> Result<&'o [PyramidalCone<'a, T>], GraspError> {
    let room = out.len();
    let out = out.get_mut(..contacts.len()).ok_or(GraspError { contact: room, error: ContactError::Room })?;
    for (index, (to, contact)) in out.iter_mut().zip(contacts).enumerate() {
        let fault = |error| GraspError { contact: index, error };
        let count = layout.edges(contact.friction());
        let (own, rest) = memory.split_at_mut_checked(count).ok_or(fault(ContactError::Room))?;
        *to = PyramidalCone::new(contact, frame, layout, own).map_err(fault)?;
        memory = rest;
    }
    Ok(out)
}

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
    /// its min-weight metric see [`opposed_mean`].
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
    /// that of the [`Primitive`](super::Primitive)s of the same contacts.
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

/// The segment from 0 to minus the mean of all edges: d of the L1 set for this Q is t of FRoGGeR's min-weight metric. `None`: there
/// are no edges, or the mean is 0 and the metric 1.
pub fn opposed_mean<T: Real>(cones: &[PyramidalCone<'_, T>]) -> Option<Segment<T, 6>> {
    opposed(cones.iter().flat_map(|cone| cone.edges()))
}

/// The same of edges, wherever they are.
#[doc(hidden)]
pub fn opposed<'a, T: Real>(edges: impl Iterator<Item = &'a [T; 6]>) -> Option<Segment<T, 6>> {
    let add = |(sum, count): (Vector<T, 6>, usize), edge: &[T; 6]| (sum + Vector::from(*edge), count + 1);
    let (sum, count) = edges.fold((Vector::zeros(), 0), add);
    Segment::new(sum / -T::count(count)).ok()
}

/// FRoGGeR's normalised min-weight metric N l from the t of [`opposed_mean`]: t / (1 + t). Increasing in t, so that it takes a bracket
/// to a bracket. Its default asks for 0.3.
///
/// ```
/// assert_eq!(qdist::grasp::min_weight(1.0), 0.5);
/// ```
pub fn min_weight<T: Real>(t: T) -> T {
    t / (T::one() + t)
}
