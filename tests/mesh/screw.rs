//! Motion along a screw: constant twist, bounds of speed, bisection and advancement.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use mesh_common::*;
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use qdist::mesh::{Pair, Screw, Stop};

fn apart(p: &Isometry3<f64>, q: &Isometry3<f64>) -> f64 {
    (p.to_homogeneous() - q.to_homogeneous()).amax()
}

/// A random pose near another: the angle is up to 3, or tiny, or 0.
fn step(dice: &mut Dice, from: &Isometry3<f64>) -> Isometry3<f64> {
    let size = dice.pick(&[0.0, 1e-14, 1e-9, 1e-5, 0.1, 3.0]);
    let axis = random_rotation(dice) * Vector3::x();
    let mut to = *from;
    to.rotation = UnitQuaternion::new(axis * size) * to.rotation;
    to.translation.vector += random_rotation(dice) * Vector3::x() * dice.pick(&[0.0, 1e-9, 1.0]);
    to
}

#[test]
fn the_twist_is_constant() {
    let mut dice = Dice::new(1);
    for _ in 0..500 {
        let from = random_pose(&mut dice, 2.0);
        let to = step(&mut dice, &from);
        let screw = Screw::new(&from, &to);
        assert!(apart(&screw.at(0.0), &from) == 0.0 && apart(&screw.at(1.0), &to) == 0.0);
        assert!(apart(&screw.at(1e-15), &from) < 1e-13 && apart(&screw.at(1.0 - 1e-16), &to) < 1e-13);
        // Equal steps are equal motions, seen in the frame of B.
        let motions: Vec<_> =
            (0..5).map(|k| screw.at(0.2 * f64::from(k + 1)) * screw.at(0.2 * f64::from(k)).inverse()).collect();
        assert!(motions.iter().all(|m| apart(m, &motions[0]) < 1e-12));
    }
}

#[test]
fn no_point_is_faster_than_the_bound() {
    let mut dice = Dice::new(2);
    let (mut tightest, radius) = (f64::MAX, 0.7);
    for _ in 0..300 {
        let from = random_pose(&mut dice, 2.0);
        let screw = Screw::new(&from, &step(&mut dice, &from));
        let centre = Point3::new(dice.signed(), dice.signed(), dice.signed());
        let speed = screw.speed(&centre, radius);
        for _ in 0..20 {
            let p = centre + random_rotation(&mut dice) * Vector3::x() * radius;
            let (s, t) = (dice.unit(), dice.unit());
            let moved = (screw.at(s) * p - screw.at(t) * p).norm();
            assert!(moved <= speed * (s - t).abs() + 1e-14, "{moved} > {speed}");
            tightest = tightest.min(speed * (s - t).abs() / moved.max(1e-12));
        }
    }
    assert!(tightest < 1.001, "the bound is attained: {tightest}");
}

#[test]
fn a_ball_meets_a_wall() {
    let (ball, wall) = (icosphere(3).mesh(), cuboid([0.5, 5.0, 5.0]).mesh());
    let mut pair = Pair::new(&ball, &wall);
    let screw = Screw::new(&Isometry3::translation(4.0, 0.1, 0.2), &Isometry3::translation(0.0, 0.1, 0.2));
    // The icosphere reaches x = -1 to 0.5 %.
    let low = ball.vertices().iter().map(|v| v.x).fold(0.0, f64::min);
    for security in [0.0, 0.1] {
        let exact = (4.0 - 0.5 + low - security) / 4.0;
        let impact = pair.advance(&screw, security, 1e-9, 200);
        assert_eq!(impact.stop, Stop::Contact);
        assert!(impact.s <= exact && exact - impact.s < 1e-9, "{} for {exact}", impact.s);
        assert!(!pair.collides(&screw.at(impact.s)));
    }
    let exact = (4.0 - 0.5 + low) / 4.0;
    let s = pair.bisect(&screw, 0.0, 1.0, 1e-12);
    assert!(!pair.collides(&screw.at(s)) && s <= exact && exact - s < 1e-12);
    let past = Screw::new(&Isometry3::translation(4.0, 0.1, 0.2), &Isometry3::translation(4.0, 3.0, 0.2));
    assert_eq!(pair.advance(&past, 0.0, 1e-9, 200).stop, Stop::End);
    assert_eq!(pair.advance(&past, 9.0, 1e-9, 200).stop, Stop::Start);
    let within = Screw::new(&Isometry3::identity(), &Isometry3::translation(9.0, 0.0, 0.0));
    assert_eq!(pair.advance(&within, 0.0, 1e-9, 200).stop, Stop::Start);
    assert_eq!(pair.advance(&screw, 0.0, 0.0, 1).stop, Stop::Limit);
}

#[test]
fn a_small_ball_does_not_pass_through_a_thin_sheet() {
    let ball = icosphere(1).placed(&Isometry3::identity(), 1e-3).mesh();
    let sheet = cuboid([1e-6, 1.0, 1.0]).mesh();
    let mut pair = Pair::new(&ball, &sheet);
    let screw = Screw::new(&Isometry3::translation(1.0, 0.0, 0.0), &Isometry3::translation(-1.0, 0.0, 0.0));
    let impact = pair.advance(&screw, 0.0, 1e-7, 300);
    assert!(impact.stop == Stop::Contact && impact.s < 0.5);
    // The start is inside nothing, but around it is a shell: containment is found at the start.
    let shell = Pair::new(&ball, &icosphere(2).mesh()).advance(&screw, 0.0, 1e-7, 300);
    assert!(shell.s == 0.0 || shell.stop == Stop::Contact);
}

#[test]
fn motions_are_free_up_to_the_impact() {
    let (l, ring) = (l_shape().mesh(), torus(24, 10, 1.0, 0.3).mesh());
    let mut pair = Pair::new(&l, &ring);
    let mut dice = Dice::new(5);
    let (mut hits, mut ends) = (0, 0);
    for _ in 0..60 {
        let screw = Screw::new(&random_pose(&mut dice, 3.0), &random_pose(&mut dice, 3.0));
        let security = dice.pick(&[0.0, 0.05]);
        let impact = pair.advance(&screw, security, 1e-6, 2000);
        if impact.stop == Stop::Start {
            let start = pair.distance(&screw.at(0.0)).distance;
            assert!(pair.collides(&screw.at(0.0)) || start <= security);
            continue;
        }
        for k in 0..=50 {
            let pose = screw.at(impact.s * f64::from(k) / 50.0);
            assert!(!pair.collides(&pose) && pair.distance(&pose).distance >= security - 1e-12);
        }
        if impact.stop == Stop::Contact {
            assert!(impact.distance <= security + 1e-6);
            hits += 1;
        }
        ends += usize::from(impact.stop == Stop::End);
    }
    assert!(hits > 0 && ends > 0, "{hits} {ends}");
}

#[test]
fn queries_are_counted() {
    let mesh = tetrahedron().mesh();
    let mut pair = Pair::new(&mesh, &mesh);
    let pose = Isometry3::translation(2.0, 0.0, 0.0);
    pair.collides(&pose);
    pair.distance(&pose);
    pair.distance_greater_than(&pose, 0.1);
    pair.contacts(&pose, 0.1, &mut Vec::new());
    let seen = pair.counters();
    assert_eq!((seen.collision, seen.distance, seen.contact), (1, 2, 1));
}

/// Found by fuzzing: it ended at a distance above 0 that a test for collision could not tell from contact.
#[test]
fn a_grain_beside_a_boulder_stops_before_rounding_does() {
    let boulder = cuboid([1.0, 1.0, 1.0]).mesh();
    let grain = cuboid([1e-20, 1e-20, 1e-20]).mesh();
    let mut pair = Pair::new(&grain, &boulder);
    let from = Isometry3::translation(2.0, 0.3, 0.1);
    let impact = pair.advance(&Screw::new(&from, &Isometry3::translation(0.0, 0.3, 0.1)), 1e-23, 1e-24, 200);
    let end = Screw::new(&from, &Isometry3::translation(0.0, 0.3, 0.1)).at(impact.s);
    assert!(!pair.collides(&end), "{impact:?}");
    assert!(impact.distance < 1e-12, "{impact:?}");
}
