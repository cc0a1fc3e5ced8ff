//! Cones of normals over the tree of boxes, which tell where no contact can be (Johnson and Cohen 2001).
//!
//! A solid's features touch another body along a direction in their normal cones. That of an edge or a vertex lies in the convex hull of the
//! normals of the faces around it: a vertex that is highest in a direction d is a maximum of the height, about which the spherical
//! polygon of these normals winds. So a cap of the sphere that contains the normals of all faces at the corners of some triangles contains every
//! direction in which these triangles' features can be met, if the cap is less than half of the sphere. Two boxes of triangles with caps (u, a)
//! and (v, b) have no contact when the angle between u and -v is larger than a + b.

use super::bvh::{Below, Bvh};
use super::topology::{EdgeKind, Topology};
use nalgebra::{Rotation3, Unit, Vector3};

/// A cap of the sphere; one of half of it or more stands for all directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cap {
    pub axis: Vector3<f64>,
    pub cosine: f64,
    pub sine: f64,
}

const ALL: Cap = Cap { axis: Vector3::new(0.0, 0.0, 0.0), cosine: -1.0, sine: 0.0 };
/// What is added to angles for rounding, and for what a contact may miss its cone by.
const SLACK: f64 = 1e-5;

impl Cap {
    fn new(axis: Vector3<f64>, angle: f64) -> Cap {
        let angle = angle + SLACK;
        if angle < 0.5 * std::f64::consts::PI { Cap { axis, cosine: angle.cos(), sine: angle.sin() } } else { ALL }
    }

    fn is_all(&self) -> bool {
        self.cosine < 0.0
    }

    /// Around these unit vectors.
    fn around(normals: impl Iterator<Item = Vector3<f64>> + Clone) -> Cap {
        let Some(axis) = normals.clone().sum::<Vector3<f64>>().try_normalize(1e-9) else { return ALL };
        let angle = normals.fold(0.0, |most, n| f64::max(most, n.angle(&axis)));
        Cap::new(axis, angle)
    }

    /// Around two caps.
    fn join(&self, other: &Cap) -> Cap {
        if self.is_all() || other.is_all() {
            return ALL;
        }
        let (a, b) = (self.sine.atan2(self.cosine), other.sine.atan2(other.cosine));
        let between = self.axis.angle(&other.axis);
        if between + b <= a {
            return *self;
        }
        if between + a <= b {
            return *other;
        }
        let half = 0.5 * (a + b + between);
        let Some(about) = Unit::try_new(self.axis.cross(&other.axis), 1e-12) else {
            return Cap::new(self.axis, a.max(b) + between);
        };
        Cap::new(Rotation3::from_axis_angle(&about, half - a) * self.axis, half)
    }

    /// Whether no direction in this cap is opposite to one in the other; `axis` is this cap's axis in the other's frame.
    /// Angles may be `tilt` larger.
    #[inline]
    pub fn never_faces(&self, axis: &Vector3<f64>, other: &Cap, tilt: f64) -> bool {
        // The sum of two angles below a right one is below pi, where the cosine falls.
        !self.is_all()
            && !other.is_all()
            && -axis.dot(&other.axis) < self.cosine * other.cosine - self.sine * other.sine - tilt
    }
}

/// The cap of every node, in the order of the tree.
pub(super) fn caps(
    bvh: &Bvh,
    vertices: usize,
    triangles: &[[u32; 3]],
    topology: &Topology,
    normals: &[Vector3<f64>],
) -> Vec<Cap> {
    let mut irregular = vec![false; vertices];
    for edge in topology.edges().iter().filter(|e| matches!(e.kind, EdgeKind::Irregular | EdgeKind::Open)) {
        edge.vertices.iter().for_each(|&v| irregular[v as usize] = true);
    }
    let mut faces: Vec<Vec<u32>> = vec![Vec::new(); vertices];
    for (face, corners) in (0u32..).zip(triangles) {
        for &v in corners {
            faces[v as usize].push(face);
            irregular[v as usize] |= normals[face as usize] == Vector3::zeros();
        }
    }
    let leaf = |triangle: u32| {
        let corners = &triangles[triangle as usize];
        if corners.iter().any(|&v| irregular[v as usize]) {
            return ALL;
        }
        Cap::around(corners.iter().flat_map(|&v| &faces[v as usize]).map(|&f| normals[f as usize]))
    };
    let mut caps = vec![ALL; bvh.len()];
    // Children stand behind their parents.
    for i in (0..bvh.len() as u32).rev() {
        caps[i as usize] = match bvh.node(i).below() {
            Below::Triangle(triangle) => leaf(triangle),
            Below::Children([x, y]) => caps[x as usize].join(&caps[y as usize]),
        };
    }
    caps
}
