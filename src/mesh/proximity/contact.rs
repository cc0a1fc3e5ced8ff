//! Contacts: the pairs of features within a margin that are local minima of the distance.
//!
//! A pair of features is one when the direction d between its nearest points lies in the normal cone of A's feature and -d in
//! that of B's (see [`topology`](super::super::topology)). Each then stands for one way in which the bodies will touch when they move a
//! little; all other pairs within the margin are dominated by these.
//!
//! Directions of vertex-face and edge-edge pairs are normals of faces and products of edges, so they do not
//! depend on the gap; only their sign does, and in a touching contact the neighbourhoods of the features decide it.

use super::super::{EdgeKind, Feature, Mesh};
use super::Pair;
use super::candidate::{Candidate, candidates};
use super::pairs::walk_culled;
use super::relative::Relative;
use crate::mesh::pose::is_usable;
use crate::mesh::triangle::plane_gap_squared;
use nalgebra::{Isometry3, Point3, Vector3};
use std::ops::ControlFlow;

/// Two features at a local minimum of their distance, in the frame of B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The feature of A.
    pub feature_a: Feature,
    /// The feature of B.
    pub feature_b: Feature,
    /// On A.
    pub on_a: Point3<f64>,
    /// On B.
    pub on_b: Point3<f64>,
    /// Unit direction from B to A.
    pub normal: Vector3<f64>,
    /// Distance of the points, at least 0; negative where they have passed through each other ([`Pair::overlaps`]).
    pub gap: f64,
}

/// Sine of the angle by which a direction may miss a normal cone.
const CONE: f64 = 1e-6;

impl Pair<'_> {
    /// Writes the contacts with a gap of at most `margin` into `out`, ascending by features, each pair of features once. Vertex-face,
    /// face-vertex and edge-edge contacts, and vertex-edge and vertex-vertex ones where corners face each other. For a
    /// free pose; in a colliding one, features that have passed through each other are still found.
    ///
    /// Parallel faces and edges touch along an area; its corners are the contacts.
    pub fn contacts(&mut self, pose: &Isometry3<f64>, margin: f64, out: &mut Vec<Contact>) {
        self.collect(pose, margin, CONE, false, &mut { usize::MAX }, out);
    }

    /// The same with those that become local minima when A turns by up to an angle of this sine.
    pub fn contacts_when_tilted(&mut self, pose: &Isometry3<f64>, margin: f64, tilt: f64, out: &mut Vec<Contact>) {
        self.collect(pose, margin, tilt.max(CONE), false, &mut { usize::MAX }, out);
    }

    /// The same of two solids that overlap: contacts with a negative gap are features that have passed through each other by at most
    /// `reach`, vertex-face, face-vertex and edge-edge. Their normals are those of the contacts that they were, so that to move
    /// by minus the gap along the normal undoes them.
    ///
    /// Looks at `work` pairs of triangles at most, and subtracts those that it looked at; returns whether that was enough.
    ///
    /// Depth is only local: a vertex beyond a thin wall counts as one that has passed through its far side.
    pub fn overlaps(
        &mut self,
        pose: &Isometry3<f64>,
        reach: f64,
        tilt: f64,
        work: &mut usize,
        out: &mut Vec<Contact>,
    ) -> bool {
        self.collect(pose, reach, tilt.max(CONE), self.a.is_solid() && self.b.is_solid(), work, out)
    }

    fn collect(
        &mut self,
        pose: &Isometry3<f64>,
        margin: f64,
        tilt: f64,
        through: bool,
        work: &mut usize,
        out: &mut Vec<Contact>,
    ) -> bool {
        self.counters.contact += 1;
        out.clear();
        if !is_usable(pose) || !(margin >= 0.0) {
            return true;
        }
        let (a, b) = (self.a, self.b);
        let relative = Relative::new(pose, a, b);
        let enough = margin * margin;
        let never_faces = |(i, j): (u32, u32)| match (a.caps().get(i as usize), b.caps().get(j as usize)) {
            (Some(x), Some(y)) => x.never_faces(&relative.turn(&x.axis), y, tilt),
            _ => false,
        };
        let walked = walk_culled::<()>(a, b, &relative, margin, &mut self.stack, never_faces, |s, t| {
            if *work == 0 {
                return ControlFlow::Break(());
            }
            *work -= 1;
            let on_s = relative.place_all(a.corners(s));
            if plane_gap_squared(&on_s, b.corners(t)) <= enough {
                candidates((a, s, &on_s), (b, t, b.corners(t)), |x| {
                    if x.squared <= enough
                        && let Some(contact) = local_minimum(a, b, &relative, &x, tilt, through)
                    {
                        out.push(contact);
                    }
                });
            }
            ControlFlow::Continue(())
        });
        out.sort_unstable_by_key(|c| (c.feature_a, c.feature_b));
        out.dedup_by_key(|c| (c.feature_a, c.feature_b));
        walked.is_continue()
    }
}

fn local_minimum(a: &Mesh, b: &Mesh, relative: &Relative, x: &Candidate, tilt: f64, through: bool) -> Option<Contact> {
    let gap = x.squared.sqrt();
    let touching = gap <= 8.0 * relative.doubt;
    let toward = if touching {
        let from_a = away(a, x.feature_a, &relative.place_back(&x.on_a));
        relative.turn(&from_a) - away(b, x.feature_b, &x.on_b)
    } else {
        x.on_b - x.on_a
    };
    let fixed = match (x.feature_a, x.feature_b) {
        (Feature::Vertex(_), Feature::Face(t)) => Some(b.normal(t)),
        (Feature::Face(s), Feature::Vertex(_)) => Some(relative.turn(&a.normal(s))),
        (Feature::Edge(i), Feature::Edge(j)) => Some(relative.turn(&along(a, i)).cross(&along(b, j))),
        _ => None,
    };
    let mut blur = tilt;
    let direction = match fixed {
        Some(axis) if axis.dot(&toward) < 0.0 => -axis,
        Some(axis) => axis,
        None if touching => toward,
        None => {
            blur += 8.0 * relative.doubt / gap;
            toward
        }
    };
    // Parallel edges have no direction of their own; their ends are contacts.
    let direction = direction.try_normalize(1e-9 * direction_scale(x, &toward))?;
    let in_cones = |direction: &Vector3<f64>| {
        in_normal_cone(a, x.feature_a, &relative.turn_back(direction), blur)
            && in_normal_cone(b, x.feature_b, &-direction, blur)
    };
    let contact = |normal: Vector3<f64>, gap: f64| Contact {
        feature_a: x.feature_a,
        feature_b: x.feature_b,
        on_a: x.on_a,
        on_b: x.on_b,
        normal,
        gap,
    };
    if in_cones(&direction) {
        return Some(contact(-direction, gap));
    }
    (through && fixed.is_some() && in_cones(&-direction)).then(|| contact(direction, -gap))
}

/// What the length of an unnormalised direction is compared with: unit vectors for fixed ones and touching pairs.
fn direction_scale(x: &Candidate, toward: &Vector3<f64>) -> f64 {
    match (x.feature_a, x.feature_b) {
        (Feature::Vertex(_) | Feature::Edge(_), Feature::Vertex(_)) | (Feature::Vertex(_), Feature::Edge(_)) => {
            toward.norm().min(1.0)
        }
        _ => 1.0,
    }
}

fn along(mesh: &Mesh, edge: u32) -> Vector3<f64> {
    let [p, q] = mesh.topology().edges()[edge as usize].vertices.map(|v| mesh.vertices()[v as usize]);
    (q - p).try_normalize(0.0).unwrap_or_default()
}

/// The corners that span the surface around a feature.
fn around(mesh: &Mesh, feature: Feature) -> (Point3<f64>, &[u32]) {
    let vertex = |v: u32| mesh.vertices()[v as usize];
    match feature {
        Feature::Vertex(v) => (vertex(v), mesh.topology().neighbours(v)),
        Feature::Edge(e) => (vertex(mesh.topology().edges()[e as usize].vertices[0]), mesh.topology().wings(e)),
        Feature::Face(f) => (mesh.corners(f)[0], &[]),
    }
}

fn in_normal_cone(mesh: &Mesh, feature: Feature, d: &Vector3<f64>, blur: f64) -> bool {
    // From its back, a solid's feature is seen through the solid.
    if outward(mesh, feature).is_some_and(|n| !(d.dot(&n) > 0.0)) {
        return false;
    }
    let (at, spanned) = around(mesh, feature);
    spanned.iter().all(|&u| {
        let side = mesh.vertices()[u as usize] - at;
        let climb = d.dot(&side);
        climb <= 0.0 || climb * climb <= blur * blur * side.norm_squared()
    })
}

/// The outward side of a solid at a feature.
fn outward(mesh: &Mesh, feature: Feature) -> Option<Vector3<f64>> {
    if !mesh.is_solid() {
        return None;
    }
    match feature {
        Feature::Face(f) => Some(mesh.normal(f)),
        Feature::Vertex(v) => Some(mesh.vertex_normal(v)),
        Feature::Edge(e) => {
            let edge = &mesh.topology().edges()[e as usize];
            let sum = mesh.normal(edge.faces[0]) + mesh.normal(edge.faces[1]);
            (edge.kind != EdgeKind::Irregular).then_some(sum)
        }
    }
}

/// A direction away from the surface around a feature: a solid's outward side, or away from the neighbours.
fn away(mesh: &Mesh, feature: Feature, at: &Point3<f64>) -> Vector3<f64> {
    let away = outward(mesh, feature).unwrap_or_else(|| {
        let line = if let Feature::Edge(e) = feature { along(mesh, e) } else { Vector3::zeros() };
        let (_, spanned) = around(mesh, feature);
        let side = |&u: &u32| {
            let side = mesh.vertices()[u as usize] - at;
            (side - line * line.dot(&side)).try_normalize(0.0).unwrap_or_default()
        };
        -spanned.iter().map(side).sum::<Vector3<f64>>()
    });
    away.try_normalize(0.0).unwrap_or_default()
}
