//! Primitive contact constraints (section IV-A of the paper): what a contact between two features says of all motions near by.
//!
//! A corner on a face, a face on a corner and an edge on an edge each have a gap that is a smooth function of the pose,
//!
//! ```text
//! v-f: n.(a' - b)      f-v: (R n).(a' - b)      e-e: +-(R u) x v / |(R u) x v| . (a' - b)
//! ```
//!
//! with a' the moved point of A, R the rotation since the contact was found, n the normal, and u and v the edges. A constraint's
//! linearisation forgets the curvature; the difference between both is what [`Primitive::gap`] tells.

use crate::mesh::{Contact, Feature, Mesh};
use nalgebra::{Isometry3, Point3, Vector3};

#[derive(Clone, Copy, Debug)]
enum Kind {
    /// The normal rests.
    VertexFace,
    /// The normal moves with A.
    FaceVertex,
    /// Edges of A and B.
    Edges(Vector3<f64>, Vector3<f64>),
}

/// One primitive constraint, in the frame of B.
#[derive(Clone, Copy, Debug)]
pub(super) struct Primitive {
    pub on_a: Point3<f64>,
    pub on_b: Point3<f64>,
    pub normal: Vector3<f64>,
    kind: Kind,
}

impl Primitive {
    /// Of a contact of these meshes, found at a pose.
    pub fn new(contact: &Contact, a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> Primitive {
        let along = |mesh: &Mesh, edge: u32| {
            let [p, q] = mesh.topology().edges()[edge as usize].vertices.map(|v| mesh.vertices()[v as usize]);
            q - p
        };
        let kind = match (contact.feature_a, contact.feature_b) {
            (Feature::Face(_), _) => Kind::FaceVertex,
            (Feature::Edge(i), Feature::Edge(j)) => Kind::Edges(pose.rotation * along(a, i), along(b, j)),
            _ => Kind::VertexFace,
        };
        Primitive { on_a: contact.on_a, on_b: contact.on_b, normal: contact.normal, kind }
    }

    /// The normal after a motion of A in the frame of B.
    pub fn normal_after(&self, motion: &Isometry3<f64>) -> Vector3<f64> {
        match self.kind {
            Kind::VertexFace => self.normal,
            Kind::FaceVertex => motion.rotation * self.normal,
            Kind::Edges(u, v) => {
                let across = (motion.rotation * u).cross(&v);
                let sign = if across.dot(&self.normal) < 0.0 { -1.0 } else { 1.0 };
                across.try_normalize(0.0).map_or(self.normal, |n| n * sign)
            }
        }
    }

    /// The signed gap after a motion.
    pub fn gap(&self, motion: &Isometry3<f64>) -> f64 {
        self.normal_after(motion).dot(&(motion * self.on_a - self.on_b))
    }
}
