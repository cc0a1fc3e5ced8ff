//! Meshes made by code, a reader for those of the shared data, and slow oracles over all pairs of triangles.
#![allow(dead_code)]

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use qdist::mesh::Mesh;
use qdist::mesh::metric::{BodyFrame, Certificate, Metric};
use qdist::mesh::optimize::Quadratic;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::path::Path;

use crate::common::dice::Dice;

/// A metric of the caller's: distances of its own, in all else like another.
pub struct Own<'m, F> {
    pub like: &'m dyn Metric,
    pub certificate: Certificate,
    pub distance: F,
}

impl<F: Fn(&Isometry3<f64>, &Isometry3<f64>) -> f64> Metric for Own<'_, F> {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        (self.distance)(from, to)
    }

    fn certificate(&self) -> Certificate {
        self.certificate
    }

    fn frame(&self) -> &BodyFrame {
        self.like.frame()
    }

    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        self.like.model(from, at)
    }
}

/// Vertices and triangles.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

impl Shape {
    pub fn mesh(&self) -> Mesh {
        Mesh::new(&self.vertices, &self.triangles).unwrap()
    }

    /// x -> R s x + t.
    pub fn placed(&self, pose: &Isometry3<f64>, s: f64) -> Shape {
        let vertices = self.vertices.iter().map(|&x| (pose * Point3::from(Vector3::from(x) * s)).into()).collect();
        Shape { vertices, triangles: self.triangles.clone() }
    }

    pub fn moved(&self, t: [f64; 3]) -> Shape {
        self.placed(&Isometry3::translation(t[0], t[1], t[2]), 1.0)
    }

    /// Wound the other way.
    pub fn flipped(&self) -> Shape {
        Shape {
            vertices: self.vertices.clone(),
            triangles: self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        }
    }

    /// Both, as two components.
    pub fn and(&self, other: &Shape) -> Shape {
        let n = self.vertices.len() as u32;
        let mut both = self.clone();
        both.vertices.extend(&other.vertices);
        both.triangles.extend(other.triangles.iter().map(|t| t.map(|v| v + n)));
        both
    }

    pub fn without(&self, triangle: usize) -> Shape {
        let mut rest = self.clone();
        rest.triangles.remove(triangle);
        rest
    }
}

pub fn tetrahedron() -> Shape {
    Shape {
        vertices: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        triangles: vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
    }
}

/// The polygon (counterclockwise) times [-half, half] along z, with the triangles of its caps.
pub fn prism_capped(polygon: &[[f64; 2]], caps: &[[u32; 3]], half: f64) -> Shape {
    let n = polygon.len() as u32;
    let mut shape = Shape::default();
    for z in [-half, half] {
        shape.vertices.extend(polygon.iter().map(|&[x, y]| [x, y, z]));
    }
    for &[a, b, c] in caps {
        shape.triangles.extend([[a, c, b], [n + a, n + b, n + c]]);
    }
    for i in 0..n {
        let j = (i + 1) % n;
        shape.triangles.extend([[i, j, n + j], [i, n + j, n + i]]);
    }
    shape
}

/// The same for a polygon that is star-shaped about its first corner.
pub fn prism(polygon: &[[f64; 2]], half: f64) -> Shape {
    let fan: Vec<_> = (1..polygon.len() as u32 - 1).map(|i| [0, i, i + 1]).collect();
    prism_capped(polygon, &fan, half)
}

/// [-h, h], 12 triangles.
pub fn cuboid(h: [f64; 3]) -> Shape {
    prism(&[[-h[0], -h[1]], [h[0], -h[1]], [h[0], h[1]], [-h[0], h[1]]], h[2])
}

/// An L of arms 2 long and 1 wide, 20 triangles.
pub fn l_shape() -> Shape {
    // The fan starts at the reentrant corner.
    prism(&[[1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0], [2.0, 0.0], [2.0, 1.0]], 0.5)
}

/// A channel: a block of width 2 w and height h with a slot of width g from the top down to height f.
pub fn slot(w: f64, h: f64, g: f64, f: f64, half: f64) -> Shape {
    let s = 0.5 * g;
    let section = [[-w, 0.0], [w, 0.0], [w, h], [s, h], [s, f], [-s, f], [-s, h], [-w, h]];
    prism_capped(&section, &[[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [0, 5, 6], [0, 6, 7]], half)
}

/// A tube of n x m quads around a closed curve.
pub fn tube(n: usize, m: usize, radius: f64, curve: impl Fn(f64) -> Vector3<f64>) -> Shape {
    let mut shape = Shape::default();
    for i in 0..n {
        let s = TAU * i as f64 / n as f64;
        let along = (curve(s + 1e-4) - curve(s - 1e-4)).normalize();
        let side = along.cross(&Vector3::new(0.12, 0.05, 1.0)).normalize();
        let up = side.cross(&along);
        for j in 0..m {
            let t = TAU * j as f64 / m as f64;
            shape.vertices.push((curve(s) + (side * t.cos() + up * t.sin()) * radius).into());
        }
    }
    for i in 0..n {
        for j in 0..m {
            let v = |i: usize, j: usize| ((i % n) * m + j % m) as u32;
            shape.triangles.extend([[v(i, j), v(i + 1, j + 1), v(i, j + 1)], [v(i, j), v(i + 1, j), v(i + 1, j + 1)]]);
        }
    }
    shape
}

/// A ring of the given radii in the xy plane.
pub fn torus(n: usize, m: usize, large: f64, small: f64) -> Shape {
    tube(n, m, small, |s| Vector3::new(s.cos(), s.sin(), 0.0) * large)
}

/// The (2, 3) torus knot.
pub fn torus_knot(n: usize, m: usize, radius: f64) -> Shape {
    tube(n, m, radius, |s| {
        let r = 1.0 + 0.4 * (3.0 * s).cos();
        Vector3::new(r * (2.0 * s).cos(), r * (2.0 * s).sin(), 0.4 * (3.0 * s).sin())
    })
}

/// The unit sphere, 20 * 4^level triangles.
pub fn icosphere(level: usize) -> Shape {
    let g = 0.5 * (1.0 + 5f64.sqrt());
    let mut vertices: Vec<Vector3<f64>> = Vec::new();
    for k in 0..3 {
        for (s, t) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut x = Vector3::zeros();
            (x[k], x[(k + 1) % 3]) = (s, t * g);
            vertices.push(x.normalize());
        }
    }
    let mut triangles = Vec::new();
    let near = |x: &Vector3<f64>, y: &Vector3<f64>| (x - y).norm() < 1.1;
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let [a, b, c] = [vertices[i], vertices[j], vertices[k]];
                if near(&a, &b) && near(&b, &c) && near(&a, &c) {
                    let outward = a.dot(&b.cross(&c)) > 0.0;
                    triangles.push(if outward { [i, j, k] } else { [i, k, j] }.map(|v| v as u32));
                }
            }
        }
    }
    for _ in 0..level {
        let mut middle = HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let mut half = |x: u32, y: u32| {
                *middle.entry((x.min(y), x.max(y))).or_insert_with(|| {
                    vertices.push((vertices[x as usize] + vertices[y as usize]).normalize());
                    vertices.len() as u32 - 1
                })
            };
            let (x, y, z) = (half(a, b), half(b, c), half(c, a));
            finer.extend([[a, x, z], [x, b, y], [z, y, c], [x, y, z]]);
        }
        triangles = finer;
    }
    Shape { vertices: vertices.into_iter().map(Into::into).collect(), triangles }
}

/// Vertices and faces of an OBJ file; polygons become fans.
pub fn read_obj(path: &Path) -> Shape {
    let mut shape = Shape::default();
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let x: Vec<f64> = words.take(3).map(|w| w.parse().unwrap()).collect();
                shape.vertices.push([x[0], x[1], x[2]]);
            }
            Some("f") => {
                let f: Vec<u32> = words.map(|w| w.split('/').next().unwrap().parse::<u32>().unwrap() - 1).collect();
                shape.triangles.extend((1..f.len() - 1).map(|i| [f[0], f[i], f[i + 1]]));
            }
            _ => {}
        }
    }
    shape
}

pub fn random_rotation(dice: &mut Dice) -> UnitQuaternion<f64> {
    loop {
        let q = nalgebra::Quaternion::new(dice.signed(), dice.signed(), dice.signed(), dice.signed());
        if (0.01..1.0).contains(&q.norm_squared()) {
            return UnitQuaternion::from_quaternion(q);
        }
    }
}

/// Any rotation, and a translation in a cube of this half extent.
pub fn random_pose(dice: &mut Dice, reach: f64) -> Isometry3<f64> {
    let t = Translation3::new(reach * dice.signed(), reach * dice.signed(), reach * dice.signed());
    Isometry3::from_parts(t, random_rotation(dice))
}

type Triangle = [Vector3<f64>; 3];

/// The triangles of A in the frame of B, and those of B.
pub fn both(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> (Vec<Triangle>, Vec<Triangle>) {
    let of = |mesh: &Mesh, pose: &Isometry3<f64>| {
        mesh.triangles().iter().map(|t| t.map(|v| (pose * mesh.vertices()[v as usize]).coords)).collect()
    };
    (of(a, pose), of(b, &Isometry3::identity()))
}

/// Whether the segment crosses the triangle, by the signs of volumes.
fn pierces(p: &Vector3<f64>, q: &Vector3<f64>, [a, b, c]: &Triangle) -> bool {
    let volume =
        |a: &Vector3<f64>, b: &Vector3<f64>, c: &Vector3<f64>, d: &Vector3<f64>| (b - a).cross(&(c - a)).dot(&(d - a));
    if (volume(a, b, c, p) > 0.0) == (volume(a, b, c, q) > 0.0) {
        return false;
    }
    let signs = [volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a)];
    signs.iter().all(|&v| v > 0.0) || signs.iter().all(|&v| v < 0.0)
}

fn cross_each_other(s: &Triangle, t: &Triangle) -> bool {
    (0..3).any(|k| pierces(&s[k], &s[(k + 1) % 3], t) || pierces(&t[k], &t[(k + 1) % 3], s))
}

/// Whether any two triangles cross (proper crossings only).
pub fn brute_meet(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> bool {
    let (a, b) = both(a, b, pose);
    a.iter().any(|s| b.iter().any(|t| cross_each_other(s, t)))
}

/// The distance of a point from a segment.
pub fn point_segment(p: &Vector3<f64>, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    let d = b - a;
    let s = if d.norm_squared() > 0.0 { ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
    (p - a - d * s).norm()
}

/// The distance of a point from a triangle: its three edges, and its plane where the foot is inside.
pub fn point_triangle(p: &Vector3<f64>, t: &Triangle) -> f64 {
    let mut best = (0..3).map(|k| point_segment(p, &t[k], &t[(k + 1) % 3])).fold(f64::MAX, f64::min);
    let n = (t[1] - t[0]).cross(&(t[2] - t[0]));
    if n.norm() > 0.0 && (0..3).all(|k| n.cross(&(t[(k + 1) % 3] - t[k])).dot(&(p - t[k])) >= 0.0) {
        best = best.min((p - t[0]).dot(&n.normalize()).abs());
    }
    best
}

/// The distance of two segments: the four ends, and the common perpendicular where it meets both.
pub fn segment_segment(p: &Vector3<f64>, q: &Vector3<f64>, a: &Vector3<f64>, b: &Vector3<f64>) -> f64 {
    let ends = [point_segment(p, a, b), point_segment(q, a, b), point_segment(a, p, q), point_segment(b, p, q)];
    let mut best = ends.into_iter().fold(f64::MAX, f64::min);
    let (d, e) = (q - p, b - a);
    let n = d.cross(&e);
    if n.norm() > 1e-12 * d.norm() * e.norm() {
        let s = (a - p).cross(&e).dot(&n) / n.norm_squared();
        let t = (a - p).cross(&d).dot(&n) / n.norm_squared();
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            best = best.min((a - p).dot(&n.normalize()).abs());
        }
    }
    best
}

/// The distance of two triangles that do not cross.
pub fn triangle_triangle(s: &Triangle, t: &Triangle) -> f64 {
    let mut best = f64::MAX;
    for i in 0..3 {
        best = best.min(point_triangle(&s[i], t)).min(point_triangle(&t[i], s));
        for j in 0..3 {
            best = best.min(segment_segment(&s[i], &s[(i + 1) % 3], &t[j], &t[(j + 1) % 3]));
        }
    }
    best
}

/// The distance of the surfaces, over all pairs of triangles.
pub fn brute_distance(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> f64 {
    let (a, b) = both(a, b, pose);
    let mut best = f64::MAX;
    for s in &a {
        for t in &b {
            if cross_each_other(s, t) {
                return 0.0;
            }
            // The boxes of the two triangles say most of it.
            let far = (0..3).any(|i| {
                let of = |t: &Triangle| (t[0][i].min(t[1][i]).min(t[2][i]), t[0][i].max(t[1][i]).max(t[2][i]));
                let ((l, h), (m, n)) = (of(s), of(t));
                l - n > best || m - h > best
            });
            if !far {
                best = best.min(triangle_triangle(s, t));
            }
        }
    }
    best
}

/// The winding number of a surface about a point, by solid angles.
pub fn winding(mesh: &Mesh, p: &Vector3<f64>) -> f64 {
    let angle = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| mesh.vertices()[v as usize].coords - p);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let across = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        a.dot(&b.cross(&c)).atan2(across)
    };
    mesh.triangles().iter().map(angle).sum::<f64>() / TAU
}
