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

mod layout;
mod preset;

use super::contact::{Contact, ContactError, GraspError};
use super::contribution::Contribution;
use super::frame::WrenchFrame;
use super::numbers::usable;
use super::primitive::frobenius;
use crate::math::{Vector, norm};
use crate::qset::Segment;
use crate::scalar::Real;
use crate::support::failure::EMPTY;
use crate::support::{Failure, Points, Support};

pub use layout::Layout;
pub use preset::Preset;

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
    fn support_above(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
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
