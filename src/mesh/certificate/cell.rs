//! A bounded polytope that is cut by planes, one after the other: its faces as polygons.
//!
//! Rounding may leave a face a little off its plane. Nothing here is trusted: what is made of the polytope is proved
//! afterwards (`piece`).

use nalgebra::{Matrix3, Vector3};

/// The half-space normal . x <= offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub normal: Vector3<f64>,
    pub offset: f64,
}

impl Plane {
    pub fn height(&self, p: &Vector3<f64>) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

/// Volume, centroid, and second moment about the centroid divided by the volume.
pub(super) struct Moments {
    pub volume: f64,
    pub centroid: Vector3<f64>,
    pub covariance: Matrix3<f64>,
}

/// A convex polytope with the origin inside.
pub(super) struct Cell {
    faces: Vec<Vec<Vector3<f64>>>,
}

impl Cell {
    /// The cube of this half side.
    pub fn cube(half: f64) -> Self {
        let face = |axis: usize, side: f64| {
            let around = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
            let corner = |[s, t]: [f64; 2]| {
                let mut p = Vector3::zeros();
                p[axis] = side * half;
                p[(axis + 1) % 3] = s * side * half;
                p[(axis + 2) % 3] = t * half;
                p
            };
            around.map(corner).to_vec()
        };
        Cell { faces: (0..3).flat_map(|axis| [face(axis, 1.0), face(axis, -1.0)]).collect() }
    }

    /// Keeps what is below the plane; its offset is positive.
    pub fn cut(&mut self, plane: &Plane) {
        let mut rim = Vec::new();
        for face in &mut self.faces {
            let heights: Vec<f64> = face.iter().map(|p| plane.height(p)).collect();
            if heights.iter().all(|&h| h <= 0.0) {
                continue;
            }
            let mut kept = Vec::with_capacity(face.len() + 1);
            for (k, p) in face.iter().enumerate() {
                let next = (k + 1) % face.len();
                let (h, g) = (heights[k], heights[next]);
                if h <= 0.0 {
                    kept.push(*p);
                }
                if (h <= 0.0) != (g <= 0.0) {
                    let on = p + (face[next] - p) * (h / (h - g));
                    kept.push(on);
                    rim.push(on);
                }
            }
            *face = kept;
        }
        self.faces.retain(|face| face.len() >= 3);
        if rim.len() >= 3 {
            self.faces.push(sorted_around(rim, &plane.normal));
        }
    }

    /// The corners, each once up to `near`.
    pub fn corners(&self, near: f64) -> Vec<Vector3<f64>> {
        let mut corners: Vec<Vector3<f64>> = Vec::new();
        for p in self.faces.iter().flatten() {
            if !corners.iter().any(|q| (q - p).amax() <= near) {
                corners.push(*p);
            }
        }
        corners
    }

    /// By tetrahedra from the origin.
    pub fn moments(&self) -> Moments {
        let (mut volume, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for face in &self.faces {
            let a = face[0];
            for edge in face[1..].windows(2) {
                let (b, c) = (edge[0], edge[1]);
                let six = a.cross(&b).dot(&c).abs();
                let sum = a + b + c;
                volume += six / 6.0;
                first += sum * (six / 24.0);
                let squares = a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose();
                second += squares * (six / 120.0);
            }
        }
        let centroid = first / volume;
        Moments { volume, centroid, covariance: second / volume - centroid * centroid.transpose() }
    }
}

/// A convex polygon from its corners in any order.
fn sorted_around(mut corners: Vec<Vector3<f64>>, normal: &Vector3<f64>) -> Vec<Vector3<f64>> {
    let middle = corners.iter().sum::<Vector3<f64>>() / corners.len() as f64;
    let mut axis = Vector3::zeros();
    axis[normal.iamin()] = 1.0;
    let x = normal.cross(&axis);
    let y = normal.cross(&x);
    let angle = |p: &Vector3<f64>| (p - middle).dot(&y).atan2((p - middle).dot(&x));
    corners.sort_by(|p, q| angle(p).total_cmp(&angle(q)));
    // Each corner came from two faces.
    let near = 1e-12 * corners.iter().map(|p| (p - middle).amax()).fold(0.0, f64::max);
    corners.dedup_by(|p, q| (*p - *q).amax() <= near);
    corners
}
