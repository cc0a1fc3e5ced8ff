//! Distances: against all pairs of triangles, closed forms, and in all frames and sizes.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use common::shared;
use mesh_common::*;
use nalgebra::{Isometry3, Vector3};
use qdist::mesh::{Feature, Mesh, Pair};

/// Whether the point is on the feature.
fn is_on(mesh: &Mesh, feature: Feature, p: &Vector3<f64>, tolerance: f64) -> bool {
    let at = |v: u32| mesh.vertices()[v as usize].coords;
    let off = match feature {
        Feature::Vertex(v) => (p - at(v)).norm(),
        Feature::Edge(e) => {
            let [x, y] = mesh.topology().edges()[e as usize].vertices;
            point_segment(p, &at(x), &at(y))
        }
        Feature::Face(f) => point_triangle(p, &mesh.triangles()[f as usize].map(at)),
    };
    off <= tolerance
}

fn check(a: &Mesh, b: &Mesh, seed: u64, count: usize, reach: f64) {
    let mut dice = Dice::new(seed);
    let mut pair = Pair::new(a, b);
    let mut apart = 0;
    for _ in 0..count {
        let pose = random_pose(&mut dice, reach);
        let expected = brute_distance(a, b, &pose);
        let found = pair.distance(&pose);
        let tolerance = 1e-12 * (a.diagonal() + b.diagonal() + reach);
        assert!((found.distance - expected).abs() <= tolerance, "{} for {expected}", found.distance);
        assert_eq!(pair.surfaces_meet(&pose), expected == 0.0);
        assert!(is_on(a, found.feature_a, &pose.inverse_transform_point(&found.on_a).coords, tolerance));
        assert!(is_on(b, found.feature_b, &found.on_b.coords, tolerance));
        if expected > 0.0 {
            assert!(((found.on_a - found.on_b).norm() - expected).abs() <= tolerance);
            assert!(!pair.distance_greater_than(&pose, expected * (1.0 + 1e-9) + tolerance));
            assert!(pair.distance_greater_than(&pose, (expected * (1.0 - 1e-9) - 20.0 * tolerance).max(0.0)));
            apart += 1;
        } else {
            assert!(!pair.distance_greater_than(&pose, 0.0));
        }
    }
    assert!(apart > 0);
}

#[test]
fn agrees_with_all_pairs() {
    let (l, knot, ring) = (l_shape().mesh(), torus_knot(60, 8, 0.2).mesh(), torus(24, 10, 1.0, 0.3).mesh());
    check(&l, &knot, 1, 40, 3.0);
    check(&cuboid([0.3, 0.5, 0.1]).mesh(), &ring, 2, 100, 2.0);
    check(&tetrahedron().mesh(), &l, 3, 300, 2.5);
    check(&icosphere(2).mesh(), &ring, 4, 40, 3.0);
    check(&knot, &ring, 5, 15, 3.0);
    // A soup: no inside, two-sided faces, open edges.
    check(&l_shape().without(4).mesh(), &torus(24, 10, 1.0, 0.3).without(7).mesh(), 6, 100, 2.5);
}

#[test]
#[ignore = "needs ../shared/data"]
fn soups_of_the_shared_data() {
    let folder = shared("meshes/real");
    let (rob, env) = (read_obj(&folder.join("rob.obj")).mesh(), read_obj(&folder.join("env.obj")).mesh());
    check(&rob, &env, 1, 6, 0.6 * env.diagonal());
}

#[test]
fn boxes() {
    let mut dice = Dice::new(5);
    for scale in [1e-6, 1.0, 1e6] {
        let h = Vector3::new(0.5, 0.3, 0.2) * scale;
        let (a, b) = (cuboid(h.into()).mesh(), cuboid((2.0 * h).into()).mesh());
        let mut pair = Pair::new(&a, &b);
        for _ in 0..200 {
            let t = Vector3::from_fn(|i, _| 3.0 * h[i] * dice.range(-3.0, 3.0));
            let gap = (t.abs() - 3.0 * h).map(|x| x.max(0.0));
            let found = pair.distance(&Isometry3::translation(t.x, t.y, t.z));
            if gap.norm() > 0.0 {
                assert!((found.distance - gap.norm()).abs() <= 1e-14 * scale, "{t:?}");
            }
        }
    }
}

#[test]
fn balls() {
    // Inscribed polyhedra with edges shorter than 0.16: at most 1 - cos(0.1) too far apart, each.
    let ball = icosphere(3).mesh();
    let mut dice = Dice::new(6);
    let mut pair = Pair::new(&ball, &ball);
    for _ in 0..50 {
        let pose = random_pose(&mut dice, 4.0);
        let exact = pose.translation.vector.norm() - 2.0;
        if exact > 0.0 {
            let found = pair.distance(&pose).distance;
            assert!(exact - 1e-12 <= found && found <= exact + 0.011, "{found} for {exact}");
        }
    }
}

#[test]
fn the_same_in_all_frames_and_sizes() {
    let (a, b) = (l_shape(), torus(20, 8, 1.0, 0.35));
    let (mesh_a, mesh_b) = (a.mesh(), b.mesh());
    let mut dice = Dice::new(11);
    for round in 0..60 {
        let pose = random_pose(&mut dice, 3.0);
        let expected = Pair::new(&mesh_a, &mesh_b).distance(&pose).distance;
        let (frame_a, frame_b, s) = (random_pose(&mut dice, 3.0), random_pose(&mut dice, 3.0), dice.decade(-6.0, 6.0));
        let scaled = |mut pose: Isometry3<f64>| {
            pose.translation.vector *= s;
            pose
        };
        let (other_a, other_b) = (a.placed(&scaled(frame_a), s).mesh(), b.placed(&scaled(frame_b), s).mesh());
        let other_pose = scaled(frame_b * pose * frame_a.inverse());
        let there = Pair::new(&other_a, &other_b).distance(&other_pose).distance;
        let back = Pair::new(&other_b, &other_a).distance(&other_pose.inverse()).distance;
        assert!((there - s * expected).abs() < 1e-12 * s && (back - s * expected).abs() < 1e-12 * s, "round {round}");
    }
}

#[test]
fn garbage_neither_panics_nor_hangs() {
    let mut dice = Dice::new(13);
    for _ in 0..1500 {
        let n = 1 + dice.below(8);
        let m = 1 + dice.below(12);
        let mut garbage = || {
            let scale = dice.decade(-30.0, 30.0);
            let flat = dice.chance(0.3);
            let vertices: Vec<[f64; 3]> = (0..n)
                .map(|_| [0, 1, 2].map(|i| if flat && i == 2 { 0.0 } else { (4.0 * dice.signed()).round() * scale }))
                .collect();
            let triangles: Vec<[u32; 3]> = (0..m).map(|_| [0; 3].map(|_| dice.below(n) as u32)).collect();
            Mesh::new(&vertices, &triangles).unwrap()
        };
        let (a, b) = (garbage(), garbage());
        let reach = dice.decade(-30.0, 30.0);
        let pose = random_pose(&mut dice, reach);
        let mut pair = Pair::new(&a, &b);
        let mut contacts = Vec::new();
        let collides = pair.collides(&pose);
        let found = pair.distance(&pose);
        assert!(found.distance >= 0.0 && found.distance.is_finite());
        assert!(collides || found.distance > 0.0, "free, and at distance 0");
        pair.contacts(&pose, reach, &mut contacts);
        for c in &contacts {
            assert!(c.gap <= reach && (c.normal.norm() - 1.0).abs() < 1e-9);
        }
        let end = random_pose(&mut dice, reach);
        let impact = pair.advance(&qdist::mesh::Screw::new(&pose, &end), 0.0, 1e-3 * reach, 50);
        assert!((0.0..=1.0).contains(&impact.s));
    }
}

/// Slivers whose normals are rounding: such a normal may point along the sliver, and the plane through one corner bounds nothing.
#[test]
fn slivers_are_no_farther_than_their_corners() {
    let mut dice = Dice::new(17);
    for _ in 0..20_000 {
        let far = dice.decade(3.0, 9.0);
        let mut sliver = || {
            let p = Vector3::from([0; 3].map(|_| far * dice.signed()));
            let d = Vector3::from([0; 3].map(|_| dice.signed()));
            let corners: [[f64; 3]; 3] = [p.into(), (p + d).into(), (p + d * dice.unit()).into()];
            Mesh::new(&corners, &[[0, 1, 2]]).unwrap()
        };
        let (a, b) = (sliver(), sliver());
        let pose =
            Isometry3::from((b.vertices()[0] - a.vertices()[0]) + Vector3::from([0; 3].map(|_| 2.0 * dice.signed())));
        let mut pair = Pair::new(&a, &b);
        let corners = a.vertices().iter().flat_map(|p| b.vertices().iter().map(move |q| (pose * p - q).norm()));
        let least = corners.fold(f64::MAX, f64::min);
        let slack = 1e-14 * far;
        let found = pair.distance(&pose).distance;
        assert!(found <= least + slack, "{found} {least}");
        assert!(!pair.distance_greater_than(&pose, least + slack), "{least}");
        // Whatever query was before.
        assert!((Pair::new(&b, &a).distance(&pose.inverse()).distance - found).abs() <= slack.max(1e-9 * found));
    }
}

/// A closed surface that crosses itself is wound inward in parts, and its reentrant edges stick out there.
#[test]
fn tangled_surfaces_are_as_near_as_they_are() {
    let mut dice = Dice::new(19);
    let mut solids = 0;
    for _ in 0..300 {
        let mut tangle = || {
            let mut shape = icosphere(0);
            shape.vertices.iter_mut().for_each(|v| *v = [0; 3].map(|_| dice.signed()));
            shape.mesh()
        };
        let (a, b) = (tangle(), tangle());
        solids += usize::from(a.is_solid());
        for _ in 0..4 {
            let pose = random_pose(&mut dice, 3.0);
            let mut pair = Pair::new(&a, &b);
            if !brute_meet(&a, &b, &pose) {
                let (found, exact) = (pair.distance(&pose).distance, brute_distance(&a, &b, &pose));
                assert!((found - exact).abs() < 1e-12, "{found} {exact}");
                assert!(!pair.distance_greater_than(&pose, exact));
            }
        }
    }
    assert!(solids > 50, "{solids}");
}

/// Coordinates of up to 1e60 have products of four, but not of six.
#[test]
fn distances_at_the_ends_of_what_numbers_can_do() {
    let (a, b) = (l_shape(), icosphere(1));
    let mut dice = Dice::new(23);
    for size in [1e-150, 1e-100, 1e-80, 1e-77, 1e52, 1e57, 1e59] {
        let [x, y] = [&a, &b].map(|shape| shape.placed(&Isometry3::identity(), size).mesh());
        for _ in 0..40 {
            let pose = random_pose(&mut dice, 4.0);
            let exact = Pair::new(&a.mesh(), &b.mesh()).distance(&pose).distance;
            let mut far = pose;
            far.translation.vector *= size;
            let mut pair = Pair::new(&x, &y);
            let found = pair.distance(&far).distance;
            assert!(size < 1e-70 || (found - exact * size).abs() <= 1e-12 * size, "{found:e} {exact} {size:e}");
            assert!(size < 1e-70 || !pair.distance_greater_than(&far, found * (1.0 + 1e-9)), "{found:e}");
        }
    }
}

/// From inside, a solid's reentrant edges are the nearest, which are not looked at: nothing is proved there.
#[test]
fn nothing_is_greater_than_the_distance_of_a_body_inside() {
    let (l, needle) = (l_shape().mesh(), cuboid([0.01, 0.01, 0.2]).mesh());
    // Near the reentrant edge (1, 1).
    let pose = Isometry3::translation(0.9, 0.9, 0.0);
    let mut pair = Pair::new(&needle, &l);
    assert!(pair.collides(&pose) && !pair.surfaces_meet(&pose));
    let least = brute_distance(&needle, &l, &pose);
    assert!(pair.distance(&pose).distance >= least - 1e-12);
    for share in [0.5, 1.0, 1.5] {
        assert!(!pair.distance_greater_than(&pose, share * least));
    }
}
