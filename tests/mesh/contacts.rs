//! Contacts: each is a local minimum of the distance, none is missing, and closed forms.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use mesh_common::*;
use nalgebra::{Isometry3, UnitQuaternion, Vector3};
use qdist::mesh::{Contact, Feature, Mesh, Pair};

type Triangle = [Vector3<f64>; 3];

/// Points a step away from p on the triangles that contain it, p itself among them.
fn nearby(triangles: &[Triangle], p: &Vector3<f64>, step: f64, dice: &mut Dice) -> Vec<Vector3<f64>> {
    let mut points = vec![*p];
    for t in triangles.iter().filter(|t| point_triangle(p, t) < 1e-11) {
        for k in 0..3 {
            points.push(p + (t[k] - p) * step);
        }
        for _ in 0..12 {
            let (x, y) = (dice.unit(), dice.unit());
            let (x, y) = if x + y > 1.0 { (1.0 - x, 1.0 - y) } else { (x, y) };
            points.push(p + (t[0] + (t[1] - t[0]) * x + (t[2] - t[0]) * y - p) * step);
        }
    }
    points
}

/// Length of the steps, relative to the gap and the edges.
const STEP: f64 = 1e-6;

/// How much nearer the surfaces get around two points: about 0 for a local minimum.
fn descent(a: &[Triangle], b: &[Triangle], p: &Vector3<f64>, q: &Vector3<f64>, dice: &mut Dice) -> f64 {
    // So short that the second order, step^2 / 2 gap, does not hide the first.
    let step = STEP * (p - q).norm();
    let (around_p, around_q) = (nearby(a, p, step, dice), nearby(b, q, step, dice));
    let least = around_p.iter().flat_map(|x| around_q.iter().map(move |y| (x - y).norm())).fold(f64::MAX, f64::min);
    (p - q).norm() - least
}

/// Nearest points of a vertex and the inside of a face, or of the insides of two edges.
fn all_pairs(a: &[Triangle], b: &[Triangle], margin: f64) -> Vec<(Vector3<f64>, Vector3<f64>)> {
    let mut pairs = Vec::new();
    let foot = |p: &Vector3<f64>, t: &Triangle| {
        let n = (t[1] - t[0]).cross(&(t[2] - t[0])).normalize();
        let inside = (0..3).all(|k| n.cross(&(t[(k + 1) % 3] - t[k])).dot(&(p - t[k])) > 1e-9);
        inside.then(|| p - n * n.dot(&(p - t[0])))
    };
    for s in a {
        for t in b {
            if triangle_triangle(s, t) > margin {
                continue;
            }
            for i in 0..3 {
                pairs.extend(foot(&s[i], t).map(|q| (s[i], q)));
                pairs.extend(foot(&t[i], s).map(|p| (p, t[i])));
                for j in 0..3 {
                    let (p, d, q, e) = (s[i], s[(i + 1) % 3] - s[i], t[j], t[(j + 1) % 3] - t[j]);
                    let n = d.cross(&e);
                    let x = (q - p).cross(&e).dot(&n) / n.norm_squared();
                    let y = (q - p).cross(&d).dot(&n) / n.norm_squared();
                    if (1e-6..1.0 - 1e-6).contains(&x) && (1e-6..1.0 - 1e-6).contains(&y) {
                        pairs.push((p + d * x, q + e * y));
                    }
                }
            }
        }
    }
    pairs.retain(|(p, q)| (p - q).norm() <= margin);
    pairs
}

fn check(a: &Mesh, b: &Mesh, seed: u64, rounds: usize, reach: f64, margin: f64) {
    let mut dice = Dice::new(seed);
    let mut pair = Pair::new(a, b);
    let mut contacts = Vec::new();
    let (mut seen, mut free) = (0, 0);
    for _ in 0..rounds {
        let pose = random_pose(&mut dice, reach);
        if pair.surfaces_meet(&pose) {
            continue;
        }
        free += 1;
        pair.contacts(&pose, margin, &mut contacts);
        let (on_a, on_b) = both(a, b, &pose);
        // Seen through a solid it is no contact.
        let outside = |p: &Vector3<f64>, q: &Vector3<f64>| {
            let (leaves_a, leaves_b) = (p + (q - p) * 1e-4, q + (p - q) * 1e-4);
            let in_a = a.is_solid() && winding(a, &pose.inverse_transform_point(&leaves_a.into()).coords) > 0.5;
            let in_b = b.is_solid() && winding(b, &leaves_b) > 0.5;
            !in_a && !in_b
        };
        for c in &contacts {
            assert!(outside(&c.on_a.coords, &c.on_b.coords), "{c:?}");
            assert!((c.on_a - c.on_b - c.normal * c.gap).norm() < 1e-9 && c.gap <= margin);
            assert!(
                descent(&on_a, &on_b, &c.on_a.coords, &c.on_b.coords, &mut dice) < 1e-5 * STEP * c.gap + 1e-15,
                "{c:?}"
            );
        }
        let keys: Vec<_> = contacts.iter().map(|c| (c.feature_a, c.feature_b)).collect();
        assert!(keys.windows(2).all(|w| w[0] < w[1]), "ascending, no repetition");
        for (p, q) in all_pairs(&on_a, &on_b, margin) {
            if !outside(&p, &q) {
                continue;
            }
            if descent(&on_a, &on_b, &p, &q, &mut dice) < 1e-15 {
                let found = |c: &Contact| (c.on_a.coords - p).norm() + (c.on_b.coords - q).norm() < 1e-8;
                assert!(contacts.iter().any(found), "missed {p:?} {q:?}");
                seen += 1;
            }
        }
        let distance = pair.distance(&pose).distance;
        let least = contacts.iter().map(|c| c.gap).fold(f64::MAX, f64::min);
        assert!(distance > margin || (least - distance).abs() < 1e-12, "{least} for {distance}");
    }
    assert!(free > 0 && seen > 0, "{free} free poses, {seen} minima");
}

#[test]
fn local_minima_all_of_them() {
    check(&l_shape().mesh(), &torus(16, 8, 1.0, 0.3).mesh(), 1, 40, 2.0, 0.3);
    check(&tetrahedron().mesh(), &l_shape().mesh(), 2, 150, 1.8, 0.4);
    check(&cuboid([0.3, 0.5, 0.1]).mesh(), &slot(1.0, 1.0, 0.8, 0.2, 0.5).mesh(), 3, 150, 1.2, 0.4);
    check(&l_shape().mesh(), &l_shape().mesh(), 4, 150, 2.0, 0.4);
    // Polygon soups: any winding, open edges.
    check(&l_shape().without(2).mesh(), &torus(16, 8, 1.0, 0.3).without(9).mesh(), 5, 40, 2.0, 0.3);
    check(&tetrahedron().flipped().mesh(), &l_shape().without(0).mesh(), 6, 150, 1.8, 0.4);
}

#[test]
fn a_box_on_a_table_touches_at_its_corners() {
    let (table, block) = (cuboid([2.0, 2.0, 0.5]).mesh(), cuboid([0.5, 0.3, 0.2]).mesh());
    let mut contacts = Vec::new();
    for gap in [0.0, 1e-15, 1e-12, 1e-6, 1e-2] {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.3);
        let pose = Isometry3::from_parts(Vector3::new(0.1, 0.2, 0.7 + gap).into(), turn);
        Pair::new(&block, &table).contacts(&pose, 0.05, &mut contacts);
        for v in 0..4 {
            let of_v: Vec<_> = contacts.iter().filter(|c| c.feature_a == Feature::Vertex(v)).collect();
            assert!(!of_v.is_empty(), "gap {gap}, corner {v}");
            assert!(of_v.iter().all(|c| (c.normal - Vector3::z()).norm() < 1e-9 && (c.gap - gap).abs() < 1e-14));
        }
        assert!(contacts.iter().all(|c| (c.normal - Vector3::z()).norm() < 1e-9), "gap {gap}: {contacts:?}");
        // The other way round: the table lies on the block.
        Pair::new(&table, &block).contacts(&pose.inverse(), 0.05, &mut contacts);
        assert!(contacts.len() >= 4);
        assert!(contacts.iter().all(|c| (c.normal + Vector3::z()).norm() < 1e-9), "gap {gap}: {contacts:?}");
    }
}

#[test]
fn edges_that_cross_touch_in_one_point() {
    let ridge = prism(&[[-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 1.0).mesh();
    let over = UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::PI);
    let across = UnitQuaternion::from_euler_angles(0.0, 1.0, 0.0);
    let mut contacts = Vec::new();
    for gap in [0.0, 1e-14, 1e-9, 1e-3] {
        let pose = Isometry3::from_parts(Vector3::new(0.0, 2.0 + gap, 0.0).into(), across * over);
        Pair::new(&ridge, &ridge).contacts(&pose, 0.01, &mut contacts);
        let [c] = contacts[..] else { panic!("{contacts:?}") };
        assert!(matches!((c.feature_a, c.feature_b), (Feature::Edge(_), Feature::Edge(_))));
        assert!((c.normal - Vector3::y()).norm() < 1e-9 && (c.gap - gap).abs() < 1e-14, "{c:?}");
    }
}

#[test]
fn a_plate_in_a_slot_touches_both_walls() {
    let channel = slot(2.0, 2.0, 1.0, 0.1, 1.0).mesh();
    let plate = cuboid([0.495, 0.3, 0.2]).mesh();
    let mut contacts = Vec::new();
    Pair::new(&plate, &channel).contacts(&Isometry3::translation(0.0, 1.0, 0.0), 0.01, &mut contacts);
    for side in [1.0, -1.0] {
        let one: Vec<_> = contacts.iter().filter(|c| (c.normal.x - side).abs() < 1e-9).collect();
        assert!(one.len() >= 4 && one.iter().all(|c| (c.gap - 0.005).abs() < 1e-12));
    }
    assert!(contacts.iter().all(|c| c.normal.x.abs() > 0.999));
}
