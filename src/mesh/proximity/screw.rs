//! Motion along a screw: the last free pose by bisection, and the first contact by conservative advancement.
//!
//! Any two poses are joined by a motion of constant twist: a rotation by theta about a unit axis u together with a translation, M(s) = exp(s xi).
//! With the origin o of A, its displacement D from the first pose to the last splits into D_u along the axis and D_p across, and
//!
//! ```text
//! R(s) = Rot(u, s theta)            o(s) = o(0) + s D_u + sin(s theta / 2) / sin(theta / 2) Rot(u, (s - 1) theta / 2) D_p
//! ```
//!
//! which needs no centre of rotation and is exact for theta = 0 and at both ends. A point at distance r of A's centre c
//! moves with speed at most sqrt(|D_u|^2 + (v + theta r)^2) per unit of s, v being the speed of c across the axis. While the distance of
//! the surfaces is d, no contact happens before d / speed (Mirtich 1996).

use super::Pair;
use super::relative::Relative;
use crate::mesh::pose::{is_usable, normalised};
use nalgebra::{Isometry3, Point3, Translation3, Unit, UnitQuaternion, Vector3};

/// The motion of constant twist from one pose (s = 0) to another (s = 1).
#[derive(Clone, Copy, Debug)]
pub struct Screw {
    from: Isometry3<f64>,
    to: Isometry3<f64>,
    axis: Unit<Vector3<f64>>,
    angle: f64,
}

impl Screw {
    /// The shorter way round.
    pub fn new(from: &Isometry3<f64>, to: &Isometry3<f64>) -> Screw {
        let (from, to) = (normalised(from), normalised(to));
        let turn = to.rotation * from.rotation.inverse();
        let v = turn.imag();
        let sine = v.norm();
        let flip = if turn.w < 0.0 { -1.0 } else { 1.0 };
        let angle = 2.0 * sine.atan2(turn.w.abs());
        let axis = if sine > 0.0 { Unit::new_unchecked(v * (flip / sine)) } else { Vector3::x_axis() };
        Screw { from, to, axis, angle }
    }

    /// The pose at s; 0 and 1 give the two poses as they are, their quaternions normalised.
    pub fn at(&self, s: f64) -> Isometry3<f64> {
        if s == 0.0 {
            return self.from;
        }
        if s == 1.0 {
            return self.to;
        }
        let rotation = UnitQuaternion::from_axis_angle(&self.axis, s * self.angle) * self.from.rotation;
        let (o, d) = (self.from.translation.vector, self.to.translation.vector - self.from.translation.vector);
        Isometry3::from_parts(Translation3::from(o + self.chord(&d, s)), rotation)
    }

    /// Angle of the rotation, 0 to pi.
    pub fn angle(&self) -> f64 {
        self.angle
    }

    /// How far a point has moved at s that moves by d in all.
    fn chord(&self, d: &Vector3<f64>, s: f64) -> Vector3<f64> {
        let along = self.axis.into_inner() * self.axis.dot(d);
        let ratio = if self.angle > 1e-9 { (0.5 * s * self.angle).sin() / (0.5 * self.angle).sin() } else { s };
        let turned = UnitQuaternion::from_axis_angle(&self.axis, 0.5 * (s - 1.0) * self.angle) * (d - along);
        along * s + turned * ratio
    }

    /// No point within `radius` of `centre`, a point of A, moves faster than this per unit of s.
    pub fn speed(&self, centre: &Point3<f64>, radius: f64) -> f64 {
        let d = self.to * centre - self.from * centre;
        let along = self.axis.dot(&d);
        let across = (d - self.axis.into_inner() * along).norm();
        let arc = if self.angle > 1e-9 { 0.5 * self.angle / (0.5 * self.angle).sin() } else { 1.0 };
        along.hypot(across * arc + self.angle * radius) * (1.0 + 1e-9)
    }
}

/// Why an advance ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// At s = 1, without contact.
    End,
    /// A contact (or the security distance) is within the tolerance.
    Contact,
    /// The first pose collides or is nearer than the security distance.
    Start,
    /// The number of steps is used up; the motion is free as far as it got.
    Limit,
}

/// How far a motion is free.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact {
    /// The motion is free, and keeps the security distance, from 0 up to here.
    pub s: f64,
    /// The distance of the surfaces there.
    pub distance: f64,
    /// Why it ended.
    pub stop: Stop,
}

impl Pair<'_> {
    /// A bound of the displacement of A's points per unit of s.
    fn speed(&self, screw: &Screw) -> f64 {
        let (low, high) = self.a.bounds();
        screw.speed(&nalgebra::center(&low, &high), 0.5 * self.a.diagonal())
    }

    /// The last free pose between a free one and a colliding one on the screw, to `tolerance` (a length: no point of A moves farther between
    /// the result and a colliding pose). Returns its s: `free` itself, or one that was tested. The first pose is not tested. At most 64 tests.
    pub fn bisect(&mut self, screw: &Screw, mut free: f64, mut colliding: f64, tolerance: f64) -> f64 {
        let speed = self.speed(screw);
        for _ in 0..64 {
            let middle = 0.5 * (free + colliding);
            if (colliding - free).abs() * speed <= tolerance || middle == free || middle == colliding {
                break;
            }
            if self.collides(&screw.at(middle)) {
                colliding = middle;
            } else {
                free = middle;
            }
        }
        free
    }

    /// Moves along the screw until something is in the way: no pose from 0 to the result collides or comes nearer than
    /// `security`, at least 0; and if it stops for a contact, the distance there is at most `security` + `tolerance`, but for some 1e-13 of the
    /// coordinates.
    /// One distance query per step, at most `limit` steps.
    pub fn advance(&mut self, screw: &Screw, security: f64, tolerance: f64, limit: u32) -> Impact {
        let start = Impact { s: 0.0, distance: 0.0, stop: Stop::Start };
        if !is_usable(&screw.to) || !(security >= 0.0) || self.collides(&screw.from) {
            return start;
        }
        let speed = self.speed(screw);
        let mut impact = start;
        let mut s = 0.0;
        for step in 0..=limit {
            let distance = self.distance(&screw.at(s)).distance;
            // What is nearer than rounding counts as a collision.
            let free = distance - security - 8.0 * Relative::new(&screw.at(s), self.a, self.b).doubt;
            if !(free > 0.0) {
                // Only rounding brings a later step here: the pose before was free.
                return if step == 0 { impact } else { Impact { stop: Stop::Contact, ..impact } };
            }
            impact = Impact { s, distance, stop: Stop::Limit };
            // Less than the whole way: the distance itself is rounded.
            let next = (s + free / speed * (1.0 - 1e-6)).min(1.0);
            if s >= 1.0 {
                return Impact { stop: Stop::End, ..impact };
            }
            if free <= tolerance || !(next > s) {
                return Impact { stop: Stop::Contact, ..impact };
            }
            s = next;
        }
        impact
    }
}
