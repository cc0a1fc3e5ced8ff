//! The local contact space (section IV-A of the paper): what contacts between features say of all motions near by.
//!
//! # Primitive constraints
//!
//! A corner on a face, a face on a corner and an edge on an edge each have a gap that is a smooth function of the pose,
//!
//! ```text
//! v-f: n.(a' - b)      f-v: (R n).(a' - b)      e-e: +-(R u) x v / |(R u) x v| . (a' - b)
//! ```
//!
//! with a' the moved point of A, R the rotation since the contact was found, n the normal, and u and v the edges. A constraint's
//! linearisation forgets the curvature; the difference between both is what [`Primitive::gap`] tells.
//!
//! # Unions and intersections
//!
//! Where a corner meets a corner or an edge, no single primitive tells. The tangent cones there, with their tips at a' and b, are apart
//! when a plane is between them,
//!
//! ```text
//! n.(a' - b) >= 0   for some n in N = N_B(b) and -R N_A(a), the directions in the normal cones of both features
//! ```
//!
//! and N is a convex cone if the features are convex. A linear function is nowhere positive on N unless it is on one of the edges of N, which are
//! normals of faces of B, normals of faces of A, and products of edges: the primitives that the contact decomposes into. So a contact of
//! convex features is the *union* of the primitives whose normals lie in N, which is asked after the motion. When none does, the bodies turn about something
//! else, and each one's corner must be outside of the other.
//!
//! A reentrant feature has no normal cone. What meets it meets faces, edges and corners beside it, each at a local minimum of its own, and
//! these are *intersected*, as contacts at different places are. A corner at which convex and reentrant edges end is the intersection of what its
//! convex edges say.
//!
//! Contacts know features by the nearest points. A corner above a face, near a convex edge of it, is beyond that edge after a motion, so
//! convex features within a length of the nearest point take the face's place. Cones are true only as far as the features go: where they hardly
//! open, as of a face that rests on a face, other corners decide. There the planes across the gaps of all contacts are true, which elsewhere allow too
//! little. So a clause of the [`ContactSpace`] holds where its planes do, or its union.

use crate::mesh::{Contact, EdgeKind, Feature, Mesh};
use nalgebra::{Isometry3, Point3, Vector3};
use std::ops::Range;

/// Sine of the angle by which a normal may miss a normal cone, for rounding.
const CONE: f64 = 1e-6;
/// Edges with a smaller sine of the angle between them are parallel.
const PARALLEL: f64 = 1e-6;

#[derive(Clone, Copy, Debug, PartialEq)]
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
        self.gap_along(&self.normal_after(motion), motion)
    }

    fn gap_along(&self, normal: &Vector3<f64>, motion: &Isometry3<f64>) -> f64 {
        normal.dot(&(motion * self.on_a - self.on_b))
    }
}

/// What meets at a place: it holds where the planes of all contacts there do, or one member.
#[derive(Clone, Debug)]
struct Clause {
    members: Range<usize>,
    /// What spans the surfaces around both features, among the directions.
    around_a: Range<usize>,
    around_b: Range<usize>,
}

/// The motions from a pose that contacts allow: all clauses.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactSpace {
    /// Of the contacts, across their gaps.
    planes: Vec<Primitive>,
    clauses: Vec<Clause>,
    /// Clauses and the contacts that are part of them, ascending.
    parts: Vec<(usize, usize)>,
    members: Vec<Primitive>,
    /// Unit vectors in the frame of B; those of A at the pose.
    directions: Vec<Vector3<f64>>,
    /// Pairs of features and their clauses.
    met: Vec<((Feature, Feature), usize)>,
    met_a: Vec<Feature>,
    met_b: Vec<Feature>,
}

impl ContactSpace {
    /// Of contacts found at a pose. Convex edges and corners within `near` of a contact's points count as met, and products of edges
    /// are members if they may lie in the normal cones after a turn of up to an angle of the sine `tilt`.
    pub fn set(&mut self, contacts: &[Contact], (a, b): (&Mesh, &Mesh), pose: &Isometry3<f64>, near: f64, tilt: f64) {
        self.planes.clear();
        self.clauses.clear();
        self.parts.clear();
        self.members.clear();
        self.directions.clear();
        self.met.clear();
        let solid = a.is_solid() && b.is_solid();
        for (index, contact) in contacts.iter().enumerate() {
            self.planes.push(Primitive::new(contact, a, b, pose));
            let known = self.parts.len();
            if solid {
                let on_a = pose.inverse_transform_point(&contact.on_a);
                met(a, contact.feature_a, &on_a, near, &mut self.met_a);
                met(b, contact.feature_b, &contact.on_b, near, &mut self.met_b);
                for k in 0..self.met_a.len() * self.met_b.len() {
                    let pair = (self.met_a[k % self.met_a.len()], self.met_b[k / self.met_a.len()]);
                    let before = self.met.iter().find(|(other, _)| *other == pair).map(|(_, clause)| *clause);
                    let clause = before.unwrap_or_else(|| {
                        self.met.push((pair, self.clauses.len()));
                        self.decompose((a, pair.0), (b, pair.1), pose, tilt)
                    });
                    self.parts.push((clause, index));
                }
            }
            if self.parts.len() == known {
                self.parts.push((self.clauses.len(), index));
                self.clauses.push(Clause { members: 0..0, around_a: 0..0, around_b: 0..0 });
            }
        }
        self.parts.sort_unstable();
    }

    /// Notes the directions that span the surface around a corner or an edge, of A at a pose.
    fn span(&mut self, mesh: &Mesh, feature: Feature, pose: Option<&Isometry3<f64>>) -> Range<usize> {
        let first = self.directions.len();
        let (at, around) = match feature {
            Feature::Vertex(v) => (v, mesh.topology().neighbours(v)),
            Feature::Edge(e) => (mesh.topology().edges()[e as usize].vertices[0], mesh.topology().wings(e)),
            Feature::Face(_) => return 0..0,
        };
        let direction = |&u: &u32| {
            let side =
                (mesh.vertices()[u as usize] - mesh.vertices()[at as usize]).try_normalize(0.0).unwrap_or_default();
            pose.map_or(side, |pose| pose.rotation * side)
        };
        self.directions.extend(around.iter().map(direction));
        first..self.directions.len()
    }

    /// Adds the union of two convex features, and returns its number.
    fn decompose(
        &mut self,
        (a, of_a): (&Mesh, Feature),
        (b, of_b): (&Mesh, Feature),
        pose: &Isometry3<f64>,
        tilt: f64,
    ) -> usize {
        let (around_a, around_b) = (self.span(a, of_a, Some(pose)), self.span(b, of_b, None));
        let first = self.members.len();
        let clause = Clause { members: first..first, around_a, around_b };
        let (on_a, on_b) = (pose * point(a, of_a), point(b, of_b));
        let Self { members, directions, .. } = self;
        let mut add = |normal: Vector3<f64>, kind| {
            let is_new = |p: &Primitive| (p.normal - normal).norm() > CONE || p.kind != kind;
            if members[first..].iter().all(is_new) {
                members.push(Primitive { on_a, on_b, normal, kind });
            }
        };
        if let Feature::Vertex(_) = of_a {
            faces(b, of_b, |face| add(b.normal(face), Kind::VertexFace));
        }
        if let Feature::Vertex(_) = of_b {
            faces(a, of_a, |face| add(-(pose.rotation * a.normal(face)), Kind::FaceVertex));
        }
        edges(a, of_a, |i| {
            edges(b, of_b, |j| {
                let bends = |mesh: &Mesh, e: u32| mesh.topology().edges()[e as usize].kind == EdgeKind::Convex;
                let (u, v) = (pose.rotation * along(a, i), along(b, j));
                let (Some(u), Some(v)) = (u.try_normalize(0.0), v.try_normalize(0.0)) else { return };
                if !(bends(a, i) && bends(b, j)) {
                    return;
                }
                // The product of nearly parallel edges turns faster than they do. That of parallel ones is not known before they turn.
                let product = u.cross(&v);
                let normal = product.try_normalize(PARALLEL).unwrap_or_default();
                let blur = tilt.max(CONE) / product.norm();
                let sides = [normal, -normal].map(|n| clause.admits(directions, &n, &Isometry3::identity(), blur));
                match sides {
                    [true, true] | [true, false] => add(normal, Kind::Edges(u, v)),
                    [false, true] => add(-normal, Kind::Edges(u, v)),
                    [false, false] => {}
                }
            });
        });
        self.clauses.push(Clause { members: first..self.members.len(), ..clause });
        self.clauses.len() - 1
    }

    /// Of the contacts, in their order, across their gaps.
    pub fn planes(&self) -> &[Primitive] {
        &self.planes
    }

    /// The members of all clauses.
    pub fn members(&self) -> &[Primitive] {
        &self.members
    }

    /// Number of clauses.
    pub fn len(&self) -> usize {
        self.clauses.len()
    }

    /// Clauses and the contacts that are part of them, ascending.
    pub fn parts(&self) -> &[(usize, usize)] {
        &self.parts
    }

    /// The members of a clause whose normals lie in the normal cones now, or after a turn of up to an angle of this sine.
    pub fn choices(&self, clause: usize, tilt: f64) -> impl Iterator<Item = &Primitive> {
        let clause = &self.clauses[clause];
        let admitted = move |p: &&Primitive| {
            p.normal != Vector3::zeros()
                && clause.admits(&self.directions, &p.normal, &Isometry3::identity(), tilt.max(CONE))
        };
        self.members[clause.members.clone()].iter().filter(admitted)
    }

    /// The least gap of the clauses after a motion. Not negative: the bodies are free, as far as these contacts know.
    pub fn value(&self, motion: &Isometry3<f64>) -> f64 {
        let gap = |parts: &[(usize, usize)]| {
            let planes = parts.iter().map(|part| self.planes[part.1].gap(motion)).fold(f64::INFINITY, f64::min);
            let clause = &self.clauses[parts[0].0];
            if clause.members.is_empty() { planes } else { planes.max(self.union(clause, motion)) }
        };
        self.parts.chunk_by(|x, y| x.0 == y.0).map(gap).fold(f64::INFINITY, f64::min)
    }

    /// The largest gap of the members that separate the cones.
    fn union(&self, clause: &Clause, motion: &Isometry3<f64>) -> f64 {
        let mut largest = f64::NEG_INFINITY;
        let mut outside = [None::<f64>; 2];
        for p in &self.members[clause.members.clone()] {
            let normal = p.normal_after(motion);
            let gap = p.gap_along(&normal, motion);
            let mut separate = |normal: Vector3<f64>, gap: f64| {
                if normal != Vector3::zeros() && clause.admits(&self.directions, &normal, motion, CONE) {
                    largest = largest.max(gap);
                }
            };
            separate(normal, gap);
            let outside = match p.kind {
                Kind::VertexFace => &mut outside[0],
                Kind::FaceVertex => &mut outside[1],
                Kind::Edges(..) => {
                    separate(-normal, -gap);
                    continue;
                }
            };
            *outside = Some(outside.map_or(gap, |x| x.max(gap)));
        }
        if largest > f64::NEG_INFINITY {
            return largest;
        }
        outside.into_iter().flatten().fold(f64::INFINITY, f64::min)
    }
}

impl Clause {
    /// Whether a direction from B to A lies in both normal cones after a motion, but for an angle of this sine.
    fn admits(&self, directions: &[Vector3<f64>], normal: &Vector3<f64>, motion: &Isometry3<f64>, blur: f64) -> bool {
        let in_a = motion.rotation.inverse_transform_vector(normal);
        directions[self.around_a.clone()].iter().all(|d| d.dot(&in_a) >= -blur)
            && directions[self.around_b.clone()].iter().all(|d| d.dot(normal) <= blur)
    }
}

/// Writes the convex features near a point of a feature: a corner or edges, those that end at a corner which is not convex. Nothing
/// for the inside of a face.
fn met(mesh: &Mesh, feature: Feature, at: &Point3<f64>, near: f64, out: &mut Vec<Feature>) {
    let topology = mesh.topology();
    out.clear();
    let (corners, sides): (&[u32], &[u32]) = match feature {
        Feature::Vertex(ref v) => (std::slice::from_ref(v), &[]),
        Feature::Edge(ref e) => (&topology.edges()[*e as usize].vertices, std::slice::from_ref(e)),
        Feature::Face(f) => (&mesh.triangles()[f as usize], &topology.face_edges(f)),
    };
    let is_near = |v: u32| matches!(feature, Feature::Vertex(_)) || (mesh.vertices()[v as usize] - at).norm() <= near;
    for v in corners.iter().copied().filter(|&v| is_near(v)) {
        if is_convex(mesh, Feature::Vertex(v)) {
            out.clear();
            out.push(Feature::Vertex(v));
            return;
        }
        edges(mesh, Feature::Vertex(v), |e| out.push(Feature::Edge(e)));
    }
    let is_beside = |e: u32| {
        let line = along(mesh, e).try_normalize(0.0).unwrap_or_default();
        let side = at - point(mesh, Feature::Edge(e));
        (side - line * line.dot(&side)).norm() <= near
    };
    let is_met = |&&e: &&u32| matches!(feature, Feature::Edge(_)) || is_beside(e);
    out.extend(sides.iter().filter(is_met).map(|&e| Feature::Edge(e)));
    out.retain(|&edge| is_convex(mesh, edge));
    out.sort_unstable();
    out.dedup();
}

/// Whether a solid is convex around a feature, and not flat.
fn is_convex(mesh: &Mesh, feature: Feature) -> bool {
    let (mut convex, mut other) = (false, false);
    edges(mesh, feature, |e| match mesh.topology().edges()[e as usize].kind {
        EdgeKind::Convex => convex = true,
        EdgeKind::Flat => {}
        EdgeKind::Reentrant | EdgeKind::Open | EdgeKind::Irregular => other = true,
    });
    convex && !other
}

/// Of an edge itself, of a corner those that end there.
fn edges(mesh: &Mesh, feature: Feature, mut visit: impl FnMut(u32)) {
    match feature {
        Feature::Vertex(v) => {
            let topology = mesh.topology();
            topology.neighbours(v).iter().filter_map(|&u| topology.edge_between(u, v)).for_each(visit);
        }
        Feature::Edge(e) => visit(e),
        Feature::Face(_) => {}
    }
}

/// The faces at an edge or a corner of a solid, some of them twice.
fn faces(mesh: &Mesh, feature: Feature, mut visit: impl FnMut(u32)) {
    edges(mesh, feature, |e| mesh.topology().edges()[e as usize].faces.into_iter().for_each(&mut visit));
}

/// A point of a feature.
fn point(mesh: &Mesh, feature: Feature) -> Point3<f64> {
    match feature {
        Feature::Vertex(v) => mesh.vertices()[v as usize],
        Feature::Edge(e) => mesh.vertices()[mesh.topology().edges()[e as usize].vertices[0] as usize],
        Feature::Face(f) => mesh.corners(f)[0],
    }
}

fn along(mesh: &Mesh, edge: u32) -> Vector3<f64> {
    let [p, q] = mesh.topology().edges()[edge as usize].vertices.map(|v| mesh.vertices()[v as usize]);
    q - p
}

#[cfg(test)]
mod tests;
