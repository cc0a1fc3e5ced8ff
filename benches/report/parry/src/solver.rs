//! Depth of two bodies by parry: `query::contact`, which has no tolerance, no iterations and no other settings.
//!
//! Where parry has a shape, it is parry's. It has no ellipsoids; and its polyhedra look at every vertex, so those with many are walked over here, as the other peers do
//! it. Both are given to it as support maps, and to the function that `query::contact` itself would call for them.

use std::cell::Cell;

use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::{contact, details::contact_support_map_support_map};
use parry3d_f64::shape::{Ball, Capsule, Cone, ConvexPolyhedron, Cuboid, Cylinder, Shape, SupportMap};

use crate::cases::{Case, Form};

/// Hulls with more vertices are searched by walking over edges.
const LINEAR_SCAN_MAX: usize = 32;

pub struct Answer {
    pub outcome: &'static str,
    /// Negative is minus the distance.
    pub depth: f64,
    /// From A to B.
    pub normal: Vector,
}

pub struct Query {
    bodies: [Solid; 2],
    poses: [Pose; 2],
}

impl Query {
    /// Shapes and poses, which are not timed. None where parry cannot make the hull.
    pub fn new(case: &Case) -> Option<Self> {
        let [(a, pose_a), (b, pose_b)] = &case.bodies;
        let ((a, turn_a), (b, turn_b)) = (solid(a)?, solid(b)?);
        Some(Query { bodies: [a, b], poses: [turned(pose_a, turn_a), turned(pose_b, turn_b)] })
    }

    pub fn run(&self) -> Answer {
        let ([a, b], [pose_a, pose_b]) = (&self.bodies, &self.poses);
        // Bodies that are apart are told about, too, however far.
        let found = match (a, b) {
            (Solid::Known(a), Solid::Known(b)) => match contact(pose_a, &**a, pose_b, &**b, f64::MAX) {
                Ok(found) => found.map(|contact| (contact.dist, contact.normal1)),
                Err(_) => return Answer { outcome: "unsupported", depth: f64::NAN, normal: Vector::NAN },
            },
            _ => contact_support_map_support_map(&pose_a.inv_mul(pose_b), a.map(), b.map(), f64::MAX)
                .map(|contact| (contact.dist, pose_a.rotation * contact.normal1)),
        };
        match found {
            Some((distance, normal)) => {
                Answer { outcome: if distance.is_finite() { "ok" } else { "nan" }, depth: -distance, normal }
            }
            None => Answer { outcome: "no_collision", depth: f64::NAN, normal: Vector::NAN },
        }
    }
}

enum Solid {
    Known(Box<dyn Shape>),
    Own(Box<dyn SupportMap>),
}

impl Solid {
    fn map(&self) -> &dyn SupportMap {
        match self {
            // Every shape that is made below has one.
            Solid::Known(shape) => shape.as_support_map().expect("a convex shape"),
            Solid::Own(map) => &**map,
        }
    }
}

/// The shape, and whether its axis is y where it should be z.
fn solid(form: &Form) -> Option<(Solid, bool)> {
    Some(match *form {
        Form::Sphere(radius) => (Solid::Known(Box::new(Ball::new(radius))), false),
        Form::Box(half) => (Solid::Known(Box::new(Cuboid::new(half))), false),
        Form::Capsule(radius, half) => (Solid::Known(Box::new(Capsule::new_z(half, radius))), false),
        Form::Cylinder(radius, half) => (Solid::Known(Box::new(Cylinder::new(half, radius))), true),
        Form::Cone(radius, half) => (Solid::Known(Box::new(Cone::new(half, radius))), true),
        Form::Ellipsoid(semi_axes) => (Solid::Own(Box::new(Ellipsoid { semi_axes })), false),
        Form::Hull(ref points) => (hull(ConvexPolyhedron::from_convex_hull(points)?), false),
    })
}

/// Turned about x such that y becomes z.
fn turned(pose: &Pose, turn: bool) -> Pose {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let rotation = if turn { pose.rotation * Rotation::from_xyzw(half, 0.0, 0.0, half) } else { pose.rotation };
    Pose::from_parts(pose.translation, rotation)
}

struct Ellipsoid {
    semi_axes: Vector,
}

impl SupportMap for Ellipsoid {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let scaled = self.semi_axes * direction;
        let length = scaled.length();
        if length > 0.0 { self.semi_axes * scaled / length } else { Vector::ZERO }
    }
}

fn hull(polyhedron: ConvexPolyhedron) -> Solid {
    let points = polyhedron.points();
    if points.len() <= LINEAR_SCAN_MAX {
        return Solid::Known(Box::new(polyhedron));
    }
    let mut around = vec![Vec::new(); points.len()];
    for edge in polyhedron.edges() {
        let [i, j] = edge.vertices;
        around[i as usize].push(j);
        around[j as usize].push(i);
    }
    Solid::Own(Box::new(Walked { points: points.to_vec(), around, last: Cell::new(0) }))
}

struct Walked {
    points: Vec<Vector>,
    around: Vec<Vec<u32>>,
    /// A walk begins where the last one ended: directions of one query are close.
    last: Cell<usize>,
}

impl SupportMap for Walked {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let mut best = self.last.get();
        let mut value = self.points[best].dot(direction);
        loop {
            let from = best;
            for &next in &self.around[from] {
                let at_next = self.points[next as usize].dot(direction);
                if at_next > value {
                    (best, value) = (next as usize, at_next);
                }
            }
            if best == from {
                self.last.set(best);
                return self.points[best];
            }
        }
    }
}
