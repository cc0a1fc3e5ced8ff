//! What a mesh says about itself: refusals, defects with places, solids, edges.
use crate::common;
use crate::mesh_common;

use common::shared;
use mesh_common::*;
use qdist::mesh::{EdgeKind, Mesh, MeshError};
use std::f64::consts::FRAC_PI_2;

#[test]
fn what_is_no_mesh_is_refused() {
    let v = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(Mesh::new(&v, &[]).unwrap_err(), MeshError::NoTriangles);
    let wrong = Mesh::new(&v, &[[0, 1, 2], [0, 3, 1]]).unwrap_err();
    assert_eq!(wrong, MeshError::IndexOutOfRange { triangle: 1, corner: 1 });
    assert!(wrong.to_string().contains("triangle 1"));
    for x in [f64::NAN, f64::INFINITY, 1e100] {
        let bad = Mesh::new(&[v[0], v[1], [0.0, x, 0.0]], &[[0, 1, 2]]).unwrap_err();
        assert_eq!(bad, MeshError::BadCoordinate { vertex: 2 });
    }
    assert_eq!(
        Mesh::new::<[f64; 3]>(&[], &[[0, 1, 2]]).unwrap_err(),
        MeshError::IndexOutOfRange { triangle: 0, corner: 0 }
    );
}

#[test]
fn clean_solids() {
    let volumes = [
        (tetrahedron(), 1.0 / 6.0),
        (cuboid([1.0, 2.0, 3.0]), 48.0),
        (l_shape(), 3.0),
        (cuboid([2.0; 3]).and(&cuboid([1.0; 3]).flipped()), 56.0),
    ];
    for (shape, volume) in volumes {
        let mesh = shape.mesh();
        assert!(mesh.is_solid() && mesh.report().is_clean(), "{:?}", mesh.report());
        assert!((mesh.report().volumes.iter().sum::<f64>() - volume).abs() < 1e-12);
        // Euler, Poincare: the boundary of a ball per component.
        let count = mesh.vertices().len() + mesh.triangles().len() - mesh.topology().edges().len();
        assert_eq!(count, 2 * mesh.report().components as usize);
    }
    for shape in [torus(20, 10, 1.0, 0.3), torus_knot(100, 8, 0.15), icosphere(3)] {
        let mesh = shape.mesh();
        assert!(mesh.report().is_clean());
        let flipped = shape.flipped().mesh();
        assert!(!flipped.is_solid() && flipped.report().inverted_components == [0]);
    }
}

#[test]
fn defects_have_places() {
    let open = cuboid([1.0; 3]).without(0).mesh();
    assert!(!open.is_solid() && open.report().open_edges.len() == 3);
    let removed = cuboid([1.0; 3]).triangles[0];
    for &e in &open.report().open_edges {
        assert!(open.topology().edges()[e as usize].vertices.iter().all(|v| removed.contains(v)));
        assert_eq!(open.topology().edges()[e as usize].kind, EdgeKind::Open);
    }

    let mut shape = cuboid([1.0; 3]);
    shape.triangles[4].swap(1, 2);
    let twisted = shape.mesh();
    assert!(!twisted.is_solid() && twisted.report().inconsistent_edges.len() == 3);

    let mut shape = tetrahedron();
    shape.triangles.push([3, 1, 2]);
    shape.triangles.push([0, 0, 1]);
    shape.vertices.push([9.0; 3]);
    let mesh = shape.mesh();
    let report = mesh.report();
    assert_eq!(report.duplicate_triangles, [4]);
    assert_eq!(report.degenerate_triangles, [5]);
    assert_eq!(report.unreferenced_vertices, [4]);
    assert!(!report.non_manifold_edges.is_empty() && !report.solid);

    // An inverted box beside a good one is not a cavity.
    let beside = cuboid([1.0; 3]).and(&cuboid([0.5; 3]).flipped().moved([4.0, 0.0, 0.0])).mesh();
    assert_eq!(beside.report().inverted_components, [1]);
    let flat = Mesh::new(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2], [0, 2, 1]]).unwrap();
    assert!(!flat.is_solid() && flat.report().flat_components == [0]);
}

#[test]
fn two_boxes_that_share_an_edge_are_a_solid() {
    // Cells (0, 0) and (1, 1) of a checkerboard, with the vertices of the common edge merged.
    let mut shape = cuboid([0.5; 3]).and(&cuboid([0.5; 3]).moved([1.0, 1.0, 0.0]));
    let twin = |v: u32| shape.vertices.iter().position(|x| *x == shape.vertices[v as usize]).unwrap() as u32;
    let triangles = shape.triangles.iter().map(|t| t.map(twin)).collect();
    shape.triangles = triangles;
    let mesh = shape.mesh();
    assert!(mesh.is_solid() && mesh.report().non_manifold_edges.len() == 1 && mesh.report().components == 1);
    assert!(!mesh.report().is_clean());
}

#[test]
fn edges_of_a_box_and_an_l() {
    for (shape, convex, reentrant) in [(cuboid([1.0, 2.0, 3.0]), 12, 0), (l_shape(), 17, 1)] {
        for scale in [1e-6, 1.0, 1e6] {
            let pose = nalgebra::Isometry3::translation(scale, 2.0 * scale, 3.0 * scale);
            let mesh = shape.placed(&pose, scale).mesh();
            let count = |kind| mesh.topology().edges().iter().filter(|e| e.kind == kind).count();
            assert_eq!((count(EdgeKind::Convex), count(EdgeKind::Reentrant)), (convex, reentrant));
            assert_eq!(count(EdgeKind::Flat) + convex + reentrant, mesh.topology().edges().len());
            for edge in mesh.topology().edges() {
                let expected = match edge.kind {
                    EdgeKind::Convex => FRAC_PI_2,
                    EdgeKind::Reentrant => -FRAC_PI_2,
                    _ => 0.0,
                };
                assert!((edge.angle - expected).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn neighbours_and_wings() {
    let mesh = icosphere(1).mesh();
    let topology = mesh.topology();
    for (face, corners) in (0u32..).zip(mesh.triangles()) {
        for (k, edge) in topology.face_edges(face).into_iter().enumerate() {
            let [p, q, w] = [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
            assert_eq!(topology.edges()[edge as usize].vertices, [p.min(q), p.max(q)]);
            assert!(topology.wings(edge).contains(&w) && topology.wings(edge).len() == 2);
            assert!(topology.neighbours(p).contains(&q) && topology.neighbours(q).contains(&p));
        }
    }
    let fives = (0..mesh.vertices().len() as u32).filter(|&v| topology.neighbours(v).len() == 5).count();
    assert_eq!(fives, 12);
}

#[test]
#[ignore = "needs ../shared/data"]
fn shared_meshes_are_what_their_sources_say() {
    let folder = shared("meshes");
    for (name, count, solid) in [
        ("lshape", 20, true),
        ("torusknot", 2880, true),
        ("pawn", 304, true),
        ("cad", 2442, true),
        ("hammer", 1692, true),
        ("bumpysphere", 2880, true),
        ("real/quadknot", 2880, true),
        ("real/angle_block", 704, true),
        ("real/idler_riser", 1572, true),
        ("real/featuretype", 3476, true),
        ("real/plate_holes", 1252, true),
        ("real/fuze", 1000, true),
        ("real/fixed_top", 4772, true),
        ("real/1002_tray_bottom", 4520, true),
        ("real/rob", 216, false),
        ("real/env", 2180, false),
    ] {
        let mesh = read_obj(&folder.join(format!("{name}.obj"))).mesh();
        assert_eq!((mesh.triangles().len(), mesh.is_solid()), (count, solid), "{name}");
    }
}
