//! PAIRS
//!
//! Two meshes and the memory that their queries reuse. A moves, B rests. A pair serves one call at a time; make one per thread, meshes are
//! shared.

use super::*;
use qdist::mesh::{Contact, DepthSolver, Distance, Feature};
use qdist::nalgebra::{Quaternion, Translation3, UnitQuaternion};

/// A pair: opaque.
pub struct qdist_mesh_pair(pub(super) Exclusive<Between<Searches>>);

/// What borrows from the two meshes, and contacts in the order of the last call.
pub(super) struct Searches {
    pub(super) solver: DepthSolver<'static>,
    contacts: Vec<Contact>,
}

impl Searches {
    fn new(a: &'static Model, b: &'static Model) -> Self {
        Self { solver: DepthSolver::new(a, b), contacts: Vec::new() }
    }
}

/// Where A is, in the frame of B: x_B = R x_A + t.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_pose {
    /// The rotation R as a quaternion (w, x, y, z) of unit length, to 1e-6; it is normalised.
    pub rotation: [f64; 4],
    /// t, coordinates of at most 1e60.
    pub translation: [f64; 3],
}

impl qdist_mesh_pose {
    /// The pose, checked.
    pub(super) fn checked(&self) -> Check<Isometry3<f64>> {
        let [w, i, j, k] = self.rotation;
        coordinates(&self.rotation)?;
        if !self.translation.iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return Err(QDIST_ERROR_NONFINITE);
        }
        let quaternion = Quaternion::new(w, i, j, k);
        if !((quaternion.norm() - 1.0).abs() <= 1e-6) {
            return Err(QDIST_ERROR_ROTATION);
        }
        Ok(Isometry3::from_parts(Translation3::from(self.translation), UnitQuaternion::new_normalize(quaternion)))
    }

    pub(super) fn new(pose: &Isometry3<f64>) -> Self {
        let q = pose.rotation.quaternion();
        qdist_mesh_pose { rotation: [q.w, q.i, q.j, q.k], translation: pose.translation.vector.into() }
    }
}

/// What of a mesh touches or is nearest?
pub type qdist_mesh_feature = u32;

/// A vertex; index: its place in your array.
pub const QDIST_MESH_VERTEX: qdist_mesh_feature = 0;
/// An edge; index: a number of the library's own, the same at every call.
pub const QDIST_MESH_EDGE: qdist_mesh_feature = 1;
/// A triangle; index: its place in your array.
pub const QDIST_MESH_FACE: qdist_mesh_feature = 2;

fn feature(feature: Feature) -> (qdist_mesh_feature, u32) {
    match feature {
        Feature::Vertex(i) => (QDIST_MESH_VERTEX, i),
        Feature::Edge(i) => (QDIST_MESH_EDGE, i),
        Feature::Face(i) => (QDIST_MESH_FACE, i),
    }
}

fn xyz(point: &Point3<f64>) -> [f64; 3] {
    point.coords.into()
}

/// Nearest points of two surfaces, in the frame of B.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_distance {
    /// 0 where the surfaces meet.
    pub distance: f64,
    /// Points of A and of B.
    pub on_a: [f64; 3],
    pub on_b: [f64; 3],
    /// Where on A, and on B: QDIST_MESH_VERTEX, QDIST_MESH_EDGE or QDIST_MESH_FACE, and which.
    pub feature_a: qdist_mesh_feature,
    pub index_a: u32,
    pub feature_b: qdist_mesh_feature,
    pub index_b: u32,
}

impl qdist_mesh_distance {
    pub(super) fn new(found: &Distance) -> Self {
        let ((feature_a, index_a), (feature_b, index_b)) = (feature(found.feature_a), feature(found.feature_b));
        let (on_a, on_b) = (xyz(&found.on_a), xyz(&found.on_b));
        qdist_mesh_distance { distance: found.distance, on_a, on_b, feature_a, index_a, feature_b, index_b }
    }
}
gaps!(qdist_mesh_distance);

/// Two features at a local minimum of their distance, in the frame of B.
#[repr(C)]
pub struct qdist_mesh_contact {
    /// Distance of the points, at least 0.
    pub gap: f64,
    /// Points of A and of B.
    pub on_a: [f64; 3],
    pub on_b: [f64; 3],
    /// Unit direction from B to A.
    pub normal: [f64; 3],
    /// Where on A, and on B: QDIST_MESH_VERTEX, QDIST_MESH_EDGE or QDIST_MESH_FACE, and which.
    pub feature_a: qdist_mesh_feature,
    pub index_a: u32,
    pub feature_b: qdist_mesh_feature,
    pub index_b: u32,
}

impl qdist_mesh_contact {
    fn new(found: &Contact) -> Self {
        let ((feature_a, index_a), (feature_b, index_b)) = (feature(found.feature_a), feature(found.feature_b));
        let (on_a, on_b, normal) = (xyz(&found.on_a), xyz(&found.on_b), found.normal.into());
        qdist_mesh_contact { gap: found.gap, on_a, on_b, normal, feature_a, index_a, feature_b, index_b }
    }
}
gaps!(qdist_mesh_contact);

/// Makes a pair of two meshes, which may be the same. Allocates; O(1). The meshes may be freed before it.
///
/// Status: none but those of all functions.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_create(
    a: In<qdist_mesh>,
    b: In<qdist_mesh>,
    pair: Out<*mut qdist_mesh_pair>,
) -> qdist_status {
    guard(|| {
        pair.checked()?;
        pair.put(Box::into_raw(Box::new(qdist_mesh_pair(Between::of(a, b, Searches::new)?))))
    })
}

/// Frees a pair; NULL is nothing, and so is the pair that is calling the caller.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_free(pair: Out<qdist_mesh_pair>) {
    if pair.get().is_ok_and(|pair| pair.0.take().is_ok()) {
        // SAFETY: the header: from qdist_mesh_pair_create, once.
        drop(unsafe { pair.boxed() });
    }
}

/// Writes 1 to `collides` if A at the pose overlaps B, else 0. Solids overlap when one contains the other, too. Touching, which rounding cannot
/// tell from overlap, counts: 0 is proved, to the last digit. Microseconds, and less where the last answer still holds.
///
/// Status: those of a pose (pose).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_collides(
    pair: Out<qdist_mesh_pair>,
    pose: In<qdist_mesh_pose>,
    collides: Out<u32>,
) -> qdist_status {
    guard(|| {
        collides.checked()?;
        let (mut pair, pose) = (pair.get()?.0.take()?, pose.get()?.checked()?);
        let found = pair.ask(|searches| searches.solver.pair().collides(&pose))?;
        collides.put(found.into())
    })
}

/// The distance of the surfaces. A body inside another one has a positive distance, too: qdist_mesh_pair_collides tells. Some 20
/// microseconds (`./x figures`), and less where the pose has changed little.
///
/// Status: those of a pose (pose).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_distance(
    pair: Out<qdist_mesh_pair>,
    pose: In<qdist_mesh_pose>,
    distance: Out<qdist_mesh_distance>,
) -> qdist_status {
    guard(|| {
        distance.checked()?;
        let (mut pair, pose) = (pair.get()?.0.take()?, pose.get()?.checked()?);
        let found = pair.ask(|searches| searches.solver.pair().distance(&pose))?;
        distance.put(qdist_mesh_distance::new(&found))
    })
}

/// Contacts with a gap of at most `margin`, in the order of their features, each pair of features once: only local minima of the distance,
/// through which the bodies will touch when they move a little. Parallel faces and edges touch along an area; its corners are the contacts.
/// For a pose that does not collide; otherwise features that have passed through each other are still found.
///
/// Writes the first `capacity` contacts, and to `count` how many there are: more than `capacity` if there was no room for all. With a capacity
/// of 0 `contacts` may be NULL. Allocates when there are more of them than at any call before.
///
/// Status: those of a pose (pose); ARGUMENT (margin is negative), NONFINITE (margin).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_mesh_pair_contacts(
    pair: Out<qdist_mesh_pair>,
    pose: In<qdist_mesh_pose>,
    margin: f64,
    contacts: Out<qdist_mesh_contact>,
    capacity: u32,
    count: Out<u32>,
) -> qdist_status {
    guard(|| {
        count.checked()?;
        if capacity > 0 {
            contacts.checked()?;
        }
        let (mut pair, pose) = (pair.get()?.0.take()?, pose.get()?.checked()?);
        not_negative(margin)?;
        pair.ask(|searches| searches.solver.pair().contacts(&pose, margin, &mut searches.contacts))?;
        let found = &pair.inside.contacts;
        for (place, contact) in found.iter().take(capacity as usize).enumerate() {
            contacts.put_at(place, qdist_mesh_contact::new(contact))?;
        }
        count.put(found.len() as u32)
    })
}
