//! What the contact space says of small motions, against the solid test.

use super::super::random::Random;
use super::*;
use crate::mesh::optimize::Twist;
use crate::mesh::{ContactSamples, Model, Pair};
use nalgebra::{Unit, UnitQuaternion, Vector3};

/// The polygon (counterclockwise, star-shaped about its first corner) times [-1/2, 1/2].
fn prism(polygon: &[[f64; 2]]) -> Mesh {
    let n = polygon.len() as u32;
    let level = |z: f64| polygon.iter().map(move |&[x, y]| [x, y, z]);
    let vertices: Vec<_> = level(-0.5).chain(level(0.5)).collect();
    let caps = (1..n - 1).flat_map(|i| [[0, i + 1, i], [n, n + i, n + i + 1]]);
    let sides = (0..n).map(|i| (i, (i + 1) % n)).flat_map(|(i, j)| [[i, j, n + j], [i, n + j, n + i]]);
    Mesh::new(&vertices, &caps.chain(sides).collect::<Vec<_>>()).unwrap()
}

fn cube() -> Mesh {
    prism(&[[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
}

/// Its reentrant edge is at the origin.
fn l_shape() -> Mesh {
    prism(&[[0.0, 0.0], [0.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [1.0, 0.0]])
}

/// A thin tip at the origin, upward.
fn needle() -> Mesh {
    let corners = [[0.0, 0.0, 0.0], [0.25, 0.0, 1.0], [-0.12, 0.2, 1.0], [-0.12, -0.2, 1.0]];
    Mesh::new(&corners, &[[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]).unwrap()
}

/// Sizes of motions, offsets from touching, and neighbourhoods.
const MOTION: f64 = 1e-3;
const OFFSET: f64 = 3e-4;
const NEAR: f64 = 2e-2;

/// How motions were judged.
#[derive(Clone, Copy, Debug, Default)]
struct Judged {
    free: u32,
    colliding: u32,
    /// Called free, and they collide.
    free_wrongly: u32,
    /// Called colliding, and they are free.
    colliding_wrongly: u32,
}

impl Judged {
    fn note(&mut self, gap: f64, is_free: bool) {
        *match (gap >= 0.0, is_free) {
            (true, true) => &mut self.free,
            (false, false) => &mut self.colliding,
            (true, false) => &mut self.free_wrongly,
            (false, true) => &mut self.colliding_wrongly,
        } += 1;
    }

    /// The solid test agrees, of many motions of either kind.
    fn assert_exact(&self) {
        assert!(self.free > 100 && self.colliding > 100, "{self:?}");
        assert_eq!((self.free_wrongly, self.colliding_wrongly), (0, 0), "{self:?}");
    }

    /// Too much is forbidden.
    fn assert_too_strict(&self) {
        assert!(self.free_wrongly == 0 && self.colliding_wrongly > self.free / 20, "{self:?}");
    }
}

/// Small motions from free poses near this one, about a point: judged by the space, and by the planes of all contacts together.
fn judged(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>, about: Point3<f64>, seed: u64) -> [Judged; 2] {
    judged_tilted(a, b, pose, about, seed, 0.1)
}

/// The same with poses that differ by a rotation of up to this angle.
fn judged_tilted(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>, about: Point3<f64>, seed: u64, tilt: f64) -> [Judged; 2] {
    let (mut pair, mut random) = (Pair::new(a, b), Random::new(seed));
    let (mut space, mut contacts) = (ContactSpace::default(), Vec::new());
    let mut judged = [Judged::default(); 2];
    for _ in 0..40 {
        let shift = random.direction() * (OFFSET * random.signed());
        let angular = random.direction() * (tilt * random.signed());
        let pose = Twist { linear: shift, angular, about }.applied(pose);
        if pair.collides(&pose) {
            continue;
        }
        pair.contacts_when_tilted(&pose, NEAR, MOTION, &mut contacts);
        space.set(&contacts, (a, b), &pose, NEAR, MOTION);
        assert!(space.value(&Isometry3::identity()) >= 0.0);
        for _ in 0..50 {
            let linear = random.direction() * (MOTION * random.signed());
            let angular = random.direction() * (MOTION * random.signed());
            let moved = Twist { linear, angular, about }.applied(&pose);
            let motion = moved * pose.inverse();
            let gap = space.value(&motion);
            if gap.abs() < 1e-9 {
                continue;
            }
            let is_free = !pair.collides(&moved);
            judged[0].note(gap, is_free);
            let planes = contacts.iter().map(|c| Primitive::new(c, a, b, &pose).gap(&motion)).fold(f64::MAX, f64::min);
            judged[1].note(planes, is_free);
        }
    }
    judged
}

/// Turned about x, then about y.
fn placed(at: [f64; 3], x: f64, y: f64) -> Isometry3<f64> {
    let turn =
        UnitQuaternion::from_axis_angle(&Vector3::y_axis(), y) * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), x);
    Isometry3::from_parts(at.into(), turn)
}

#[test]
fn a_tip_on_a_convex_edge_is_outside_of_either_face() {
    // The cube's edge along y at x = z = 1/2.
    let edge = [0.5, 0.0, 0.5];
    for y in [0.3, 0.8, 1.2] {
        let [space, planes] = judged(&needle(), &cube(), &placed(edge, 0.1, y), edge.into(), 1);
        space.assert_exact();
        planes.assert_too_strict();
        // The same seen from the other body.
        let [space, planes] = judged(&cube(), &needle(), &placed(edge, 0.1, y).inverse(), Point3::origin(), 1);
        space.assert_exact();
        planes.assert_too_strict();
    }
}

#[test]
fn a_corner_on_a_corner_is_outside_of_any_plane_between_them() {
    let tip = Point3::new(0.5, 0.5, 0.5);
    for (a, corner) in [(needle(), Point3::origin()), (cube(), Point3::new(-0.5, -0.5, -0.5))] {
        for (x, y) in [(0.0, 0.7), (0.6, 0.7), (-0.5, 0.2)] {
            let rotation = placed([0.0; 3], x, y).rotation;
            let pose = Isometry3::from_parts((tip - rotation * corner).into(), rotation);
            let [space, planes] = judged(&a, &cube(), &pose, tip, 2);
            space.assert_exact();
            planes.assert_too_strict();
        }
    }
}

#[test]
fn edges_that_cross_have_one_plane() {
    // A cube's edge stands on another's, turned about their common normal.
    let turn = UnitQuaternion::from_axis_angle(&Unit::new_normalize(Vector3::new(1.0, 0.0, 1.0)), 1.0);
    let at = Vector3::new(0.5, 0.0, 0.5) - turn * Vector3::new(-0.5, 0.1, -0.5);
    let [space, _] = judged(&cube(), &cube(), &Isometry3::from_parts(at.into(), turn), [0.5, 0.0, 0.5].into(), 3);
    space.assert_exact();
}

#[test]
fn a_reentrant_edge_is_met_by_its_faces_together() {
    // A tip in the notch; and the notch over a tip.
    let into_notch = UnitQuaternion::rotation_between(&Vector3::z(), &Vector3::new(1.0, 1.2, 0.1)).unwrap();
    for turn in [0.0, 1.5, 3.0] {
        let rotation = into_notch * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
        let pose = Isometry3::from_parts([0.0, 0.0, 0.1].into(), rotation);
        judged(&needle(), &l_shape(), &pose, [0.0, 0.0, 0.1].into(), 4)[0].assert_exact();
        judged(&l_shape(), &needle(), &pose.inverse(), Point3::origin(), 4)[0].assert_exact();
    }
}

#[test]
fn where_convex_and_reentrant_edges_end_both_operators_hold() {
    // The end of the notch, where two convex edges and the reentrant one meet.
    let end = [0.0, 0.0, 0.5];
    for (x, y) in [(0.2, 0.3), (-0.4, 0.2), (0.4, 0.6), (-0.7, 0.7)] {
        let [space, planes] = judged(&needle(), &l_shape(), &placed(end, x, y), end.into(), 5);
        space.assert_exact();
        planes.assert_too_strict();
    }
}

/// Here no plane through the corner above the edge may be between both cones, and other corners carry the face.
#[test]
fn a_face_that_rests_on_a_face_turns_about_its_corners() {
    for (x, y, turn) in [(0.99, 0.3, 0.0), (0.99, 0.3, 0.4), (0.6, 0.7, 0.8)] {
        let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
        let pose = Isometry3::from_parts([x, y, 1.0 + OFFSET].into(), rotation);
        for tilt in [0.0, MOTION] {
            let about = pose * Point3::new(-0.5, -0.5, -0.5);
            let [space, planes] = judged_tilted(&cube(), &cube(), &pose, about, 7, tilt);
            space.assert_exact();
            assert_eq!((planes.free_wrongly, planes.colliding_wrongly), (0, 0));
        }
    }
}

/// Contacts of all kinds, most of which are one plane, or several at different places.
#[test]
fn wherever_bodies_touch_the_space_is_that_of_the_solid_test() {
    let models = [l_shape(), cube(), needle()].map(|mesh| Model::from_mesh(mesh).unwrap());
    for a in &models {
        for b in &models {
            let (mut free, mut colliding) = (0, 0);
            for pose in ContactSamples::new(a, b, 30, 0, None).poses() {
                let about = Pair::new(a.mesh(), b.mesh()).distance(pose).on_b;
                let [space, _] = judged(a.mesh(), b.mesh(), pose, about, 6);
                assert_eq!((space.free_wrongly, space.colliding_wrongly), (0, 0), "{space:?}");
                (free, colliding) = (free + space.free, colliding + space.colliding);
            }
            assert!(free > 1000 && colliding > 1000, "{free} {colliding}");
        }
    }
}

#[test]
fn soups_are_met_from_any_side_and_keep_their_planes() {
    let half = Mesh::new(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]).unwrap();
    let pose = placed([0.0, 0.0, 1e-4], 0.3, 0.2);
    let (mut space, mut contacts) = (ContactSpace::default(), Vec::new());
    Pair::new(&needle(), &half).contacts_when_tilted(&pose, NEAR, MOTION, &mut contacts);
    space.set(&contacts, (&needle(), &half), &pose, NEAR, MOTION);
    assert_eq!((contacts.len(), space.len(), space.members().len()), (1, 1, 0));
    assert!((space.value(&Isometry3::translation(0.0, 0.0, 1e-3)) - 1.1e-3).abs() < 1e-12);
    assert!((space.value(&Isometry3::translation(0.0, 0.0, -1e-3)) + 0.9e-3).abs() < 1e-12);
}
