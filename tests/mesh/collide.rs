//! The solid test: against all pairs of triangles, winding numbers and closed forms.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use common::shared;
use mesh_common::*;
use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use qdist::mesh::{Mesh, Pair};

fn brute_collides(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> bool {
    let inside = |host: &Mesh, guest: &Mesh, pose: &Isometry3<f64>| {
        host.is_solid() && guest.vertices().iter().any(|v| winding(host, &(pose * v).coords) > 0.5)
    };
    brute_meet(a, b, pose) || inside(b, a, pose) || inside(a, b, &pose.inverse())
}

fn check(a: &Mesh, b: &Mesh, seed: u64, count: usize, reach: f64) {
    let mut dice = Dice::new(seed);
    let mut pair = Pair::new(a, b);
    let mut hits = 0;
    for _ in 0..count {
        let pose = random_pose(&mut dice, reach);
        let expected = brute_collides(a, b, &pose);
        assert_eq!(pair.collides(&pose), expected, "{pose:?}");
        hits += usize::from(expected);
    }
    assert!(hits > 0 && hits < count, "{hits} of {count}: a test that sees one outcome only");
}

#[test]
fn agrees_with_all_pairs() {
    let (l, knot, ring) = (l_shape().mesh(), torus_knot(60, 8, 0.2).mesh(), torus(24, 10, 1.0, 0.3).mesh());
    let (box_, ball) = (cuboid([0.3, 0.5, 0.1]).mesh(), icosphere(2).mesh());
    check(&l, &knot, 1, 60, 2.0);
    check(&box_, &ring, 2, 300, 1.5);
    check(&tetrahedron().mesh(), &l, 3, 500, 2.0);
    check(&ball, &ring, 4, 60, 2.5);
    check(&ring, &ring, 5, 60, 1.5);
}

#[test]
fn a_body_inside_a_body_collides_and_one_in_a_cavity_does_not() {
    let small = cuboid([0.1; 3]).mesh();
    let (solid, outer, cavity) = (icosphere(3), cuboid([1.0; 3]), cuboid([0.5; 3]).flipped());
    let hollow = outer.and(&cavity).mesh();
    assert!(hollow.is_solid());
    let inside = Isometry3::translation(0.05, 0.02, 0.03);
    assert!(Pair::new(&small, &solid.mesh()).collides(&inside));
    assert!(Pair::new(&solid.mesh(), &small).collides(&inside));
    assert!(!Pair::new(&small, &solid.mesh()).surfaces_meet(&inside));
    assert!(!Pair::new(&small, &hollow).collides(&inside), "free inside the cavity");
    assert!(Pair::new(&small, &hollow).collides(&Isometry3::translation(0.75, 0.0, 0.0)), "inside the wall");
    // A hollow body around another hollow body's wall: only the inner shell of one is inside the other.
    let wall = cuboid([0.75; 3]).and(&cuboid([0.6; 3]).flipped()).mesh();
    assert!(Pair::new(&wall, &hollow).collides(&Isometry3::identity()));
}

#[test]
fn one_of_many_components_is_enough() {
    let crumbs = cuboid([0.1; 3]).moved([5.0, 0.0, 0.0]).and(&cuboid([0.1; 3]).moved([-5.0, 0.0, 0.0])).mesh();
    let block = cuboid([1.0; 3]).mesh();
    let mut pair = Pair::new(&crumbs, &block);
    assert!(!pair.collides(&Isometry3::identity()));
    for x in [5.0, -5.0] {
        assert!(pair.collides(&Isometry3::translation(x, 0.01, 0.02)));
        assert!(Pair::new(&block, &crumbs).collides(&Isometry3::translation(-x, 0.01, 0.02)));
    }
}

#[test]
fn soups_have_no_inside() {
    let soup = cuboid([1.0; 3]).without(0).mesh();
    let small = cuboid([0.1; 3]);
    assert!(!soup.is_solid());
    assert!(!Pair::new(&small.mesh(), &soup).collides(&Isometry3::identity()));
    assert!(Pair::new(&small.mesh(), &soup).collides(&Isometry3::translation(1.0, 0.3, 0.2)));
    // The other way round, a soup inside a solid is inside.
    let crumb = small.without(3).mesh();
    let mut pair = Pair::new(&crumb, &soup);
    assert!(!pair.has_inside() && !pair.collides(&Isometry3::identity()));
    let block = cuboid([1.0; 3]).mesh();
    let mut pair = Pair::new(&crumb, &block);
    assert!(pair.has_inside() && pair.collides(&Isometry3::identity()));
}

#[test]
fn axis_aligned_boxes_to_the_last_digits() {
    // Coplanar faces, parallel edges: everything is degenerate but the answer.
    let mut dice = Dice::new(7);
    for scale in [1e-6, 1.0, 1e6] {
        let h = Vector3::new(0.5, 0.3, 0.2) * scale;
        let (a, b) = (cuboid(h.into()).mesh(), cuboid((2.0 * h).into()).mesh());
        let mut pair = Pair::new(&a, &b);
        for _ in 0..300 {
            let axis = dice.below(3);
            let mut t = Vector3::from_fn(|i, _| if dice.chance(0.5) { 0.0 } else { h[i] * dice.signed() });
            for (gap, expected) in [(1e-12, false), (-1e-12, true), (0.3, false), (-0.3, true), (0.0, true)] {
                t[axis] = (3.0 * h[axis] + gap * scale) * if dice.chance(0.5) { 1.0 } else { -1.0 };
                assert_eq!(pair.collides(&Isometry3::translation(t.x, t.y, t.z)), expected, "{t:?} {gap}");
            }
        }
    }
}

#[test]
fn needles_and_coplanar_triangles() {
    let needle = |z: f64| Mesh::new(&[[0.0, 0.0, z], [1.0, 1e-13, z], [0.5, 0.0, z]], &[[0, 1, 2]]).unwrap();
    let plate = Mesh::new(&[[-1.0, -1.0, 0.0], [2.0, -1.0, 0.0], [0.0, 3.0, 0.0]], &[[0, 1, 2]]).unwrap();
    assert!(Pair::new(&needle(0.0), &plate).collides(&Isometry3::identity()));
    assert!(!Pair::new(&needle(1e-9), &plate).collides(&Isometry3::identity()));
    let side = Isometry3::translation(2.5, 0.0, 0.0);
    assert!(!Pair::new(&needle(0.0), &plate).collides(&side));
    // A point and a segment as triangles.
    let point = Mesh::new(&[[0.0, 0.0, 0.0]], &[[0, 0, 0]]).unwrap();
    let segment = Mesh::new(&[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]], &[[0, 1, 0]]).unwrap();
    for (x, expected) in [(0.0, true), (0.1, false)] {
        assert_eq!(Pair::new(&point, &plate).collides(&Isometry3::translation(x, x, x)), expected);
        assert_eq!(Pair::new(&point, &segment).collides(&Isometry3::translation(x, 0.0, 0.0)), expected);
        assert_eq!(Pair::new(&segment, &segment).collides(&Isometry3::translation(x, 0.0, 0.0)), expected);
    }
}

#[test]
fn the_same_in_all_frames_and_sizes() {
    let (a, b) = (l_shape(), torus(20, 8, 1.0, 0.35));
    let (mesh_a, mesh_b) = (a.mesh(), b.mesh());
    let mut dice = Dice::new(11);
    for round in 0..60 {
        let pose = random_pose(&mut dice, 2.0);
        let expected = Pair::new(&mesh_a, &mesh_b).collides(&pose);
        let (frame_a, frame_b, scale) =
            (random_pose(&mut dice, 3.0), random_pose(&mut dice, 3.0), dice.decade(-6.0, 6.0));
        let scaled = |mut pose: Isometry3<f64>| {
            pose.translation.vector *= scale;
            pose
        };
        let (other_a, other_b) = (a.placed(&scaled(frame_a), scale).mesh(), b.placed(&scaled(frame_b), scale).mesh());
        let other_pose = scaled(frame_b * pose * frame_a.inverse());
        assert_eq!(Pair::new(&other_a, &other_b).collides(&other_pose), expected, "round {round}");
        assert_eq!(Pair::new(&other_b, &other_a).collides(&other_pose.inverse()), expected, "round {round}");
    }
}

#[test]
fn bad_poses_are_never_free() {
    let mesh = tetrahedron().mesh();
    let mut pair = Pair::new(&mesh, &mesh);
    for x in [f64::NAN, f64::INFINITY, 1e300] {
        assert!(pair.collides(&Isometry3::translation(x, 0.0, 0.0)));
    }
    assert!(!pair.collides(&Isometry3::translation(1e50, 0.0, 0.0)));
}

#[test]
#[ignore = "needs ../shared/data"]
fn poses_of_the_shared_queries() {
    let folder = shared("meshes");
    let text = std::fs::read_to_string(folder.join("queries.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let pose = |value: &serde_json::Value| {
        let q: Vec<f64> = serde_json::from_value(value["q_wxyz"].clone()).unwrap();
        let t: [f64; 3] = serde_json::from_value(value["t"].clone()).unwrap();
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3]));
        Isometry3::from_parts(Vector3::from(t).into(), rotation)
    };
    for query in json["queries"].as_array().unwrap() {
        let mesh = |key: &str| read_obj(&folder.join(query[key].as_str().unwrap())).mesh();
        let (a, b) = (mesh("A"), mesh("B"));
        let mut pair = Pair::new(&a, &b);
        assert!(pair.collides(&pose(&query["pose0"])), "{}", query["id"]);
        for best in ["disp_pose", "sigma_pose"] {
            let free = pose(&query[best]);
            assert!(!pair.collides(&free) && pair.distance(&free).distance > 0.0, "{} {best}", query["id"]);
        }
    }
}
