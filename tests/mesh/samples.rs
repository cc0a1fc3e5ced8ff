//! Contact samples: free and touching, the same for the same seed, nearest ones as by brute force, bytes that are checked.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use mesh_common::*;
use nalgebra::{Isometry3, Quaternion, UnitQuaternion, Vector3};
use qdist::mesh::metric::{Certificate, Metric};
use qdist::mesh::{ContactSamples, DepthOptions, DepthSolver, Model, Pair, SamplesError};

fn model(shape: &Shape) -> Model {
    Model::new(&shape.vertices, &shape.triangles).unwrap()
}

fn pairs() -> [(Model, Model); 3] {
    // The third is a polygon soup on a solid.
    [
        (model(&l_shape()), model(&torus_knot(48, 8, 0.25))),
        (model(&tetrahedron()), model(&slot(3.0, 4.0, 1.3, 1.0, 3.0))),
        (model(&l_shape().without(3)), model(&cuboid([0.5, 0.4, 0.8]))),
    ]
}

#[test]
fn samples_are_free_and_touch() {
    for (a, b) in &pairs() {
        let samples = ContactSamples::new(a, b, 60, 1, None);
        assert_eq!(samples.poses().len(), 60);
        let mut pair = Pair::new(a.mesh(), b.mesh());
        for pose in samples.poses() {
            assert!(!pair.collides(pose));
            // No point of A moves farther than the tolerance from here to a colliding pose, so none was farther from B.
            let distance = pair.distance(pose).distance;
            assert!(distance <= 1e-6 * a.mesh().diagonal(), "{distance}");
        }
    }
}

/// Bodies that hardly ever meet, and scales from end to end.
#[test]
fn thin_tiny_and_huge_bodies_have_samples() {
    let wire = cuboid([1e-4, 1e-4, 1.0]);
    let far = [3.0e6, -1.0e6, 2.0e6];
    for (a, b) in [
        (wire.clone(), wire.clone()),
        (wire.placed(&Isometry3::identity(), 1e-6), wire.placed(&Isometry3::identity(), 1e-6)),
        (cuboid([1e-3; 3]), l_shape().placed(&Isometry3::identity(), 1e6)),
        (l_shape().moved(far), cuboid([0.5; 3])),
    ] {
        let (a, b) = (model(&a), model(&b));
        let samples = ContactSamples::new(&a, &b, 20, 1, None);
        assert_eq!(samples.poses().len(), 20);
        let mut pair = Pair::new(a.mesh(), b.mesh());
        assert!(samples.poses().iter().all(|pose| !pair.collides(pose)));
    }
}

#[test]
fn the_same_seed_gives_the_same_samples_and_a_larger_count_goes_on() {
    let [(a, b), ..] = &pairs();
    let samples = ContactSamples::new(a, b, 40, 5, None);
    assert_eq!(samples, ContactSamples::new(a, b, 40, 5, None));
    assert_eq!(samples.poses(), &ContactSamples::new(a, b, 50, 5, None).poses()[..40]);
    assert_ne!(samples.poses()[0], ContactSamples::new(a, b, 1, 6, None).poses()[0]);
}

#[test]
fn the_caller_may_stop() {
    let [(a, b), ..] = &pairs();
    let mut told = Vec::new();
    let mut watch = |made: usize| {
        told.push(made);
        made >= 7
    };
    let samples = ContactSamples::new(a, b, 40, 5, Some(&mut watch));
    assert_eq!(told, [1, 2, 3, 4, 5, 6, 7]);
    assert_eq!(samples.poses(), ContactSamples::new(a, b, 7, 5, None).poses());
    assert!(ContactSamples::new(a, b, 0, 5, None).poses().is_empty());
}

/// All of them sorted by distance, then one after another.
fn brute(
    samples: &ContactSamples,
    metric: &dyn Metric,
    pose: &Isometry3<f64>,
    k: usize,
    apart: f64,
) -> Vec<Isometry3<f64>> {
    let mut all = samples.poses().to_vec();
    all.sort_by(|x, y| metric.distance(pose, x).total_cmp(&metric.distance(pose, y)));
    let mut chosen: Vec<Isometry3<f64>> = Vec::new();
    for sample in all {
        if chosen.len() < k && chosen.iter().all(|c| metric.distance(c, &sample) > apart) {
            chosen.push(sample);
        }
    }
    chosen
}

#[test]
fn the_nearest_are_those_of_brute_force_and_keep_their_distance() {
    let mut dice = Dice::new(4);
    for (a, b) in &pairs() {
        let samples = ContactSamples::new(a, b, 300, 2, None);
        // No bound is known of it, and it mostly ignores translations.
        let distance = |from: &Isometry3<f64>, to: &Isometry3<f64>| {
            from.rotation.angle_to(&to.rotation) + 1e-3 * (from.translation.vector - to.translation.vector).norm()
        };
        let turning = Own { like: a.disp(), certificate: Certificate::None, distance };
        let mut metrics: Vec<&dyn Metric> = vec![a.disp(), &turning];
        metrics.extend(a.sigma().map(|sigma| sigma as &dyn Metric));
        for _ in 0..20 {
            let pose = random_pose(&mut dice, 1.0);
            for &metric in &metrics {
                for (k, apart) in [(1, 0.0), (6, 0.0), (6, 0.3), (25, 0.8), (1000, 0.0), (1000, 1.0), (0, 1.0)] {
                    let near = samples.nearest(metric, &pose, k, apart);
                    assert_eq!(near, brute(&samples, metric, &pose, k, apart));
                    for (i, x) in near.iter().enumerate() {
                        assert!(near[..i].iter().all(|y| metric.distance(y, x) > apart));
                    }
                }
            }
        }
    }
}

#[test]
fn the_metric_is_asked_for_few_samples() {
    let [(a, b), ..] = &pairs();
    let samples = ContactSamples::new(a, b, 1000, 2, None);
    let (sigma, asked) = (a.sigma().unwrap(), std::cell::Cell::new(0));
    let distance = |from: &Isometry3<f64>, to: &Isometry3<f64>| {
        asked.set(asked.get() + 1);
        sigma.distance(from, to)
    };
    let metric = Own { like: sigma, certificate: sigma.certificate(), distance };
    for pose in ContactSamples::new(a, b, 10, 3, None).poses() {
        assert_eq!(samples.nearest(&metric, pose, 6, 0.0).len(), 6);
    }
    let mean = asked.get() / 10;
    assert!(mean < 300, "{mean} of 1000");
}

#[test]
fn equally_near_samples_come_in_their_order() {
    let (a, b) = (model(&tetrahedron()), model(&tetrahedron()));
    let twice = |t: [f64; 3]| [Isometry3::translation(t[0], t[1], t[2]), Isometry3::translation(t[1], t[0], t[2])];
    let poses: Vec<_> = [[2.0, 0.0, 0.0], [0.0, 2.0, 0.0]].into_iter().flat_map(twice).collect();
    let samples = ContactSamples::from_poses(&a, &b, poses.clone()).unwrap();
    assert_eq!(samples.nearest(a.disp(), &Isometry3::identity(), 4, -1.0), poses);
    assert_eq!(samples.nearest(a.disp(), &Isometry3::identity(), 4, 0.0), poses[..2]);
}

#[test]
fn seeds_alone_give_a_depth_that_is_true() {
    let [(a, b), ..] = &pairs();
    let samples = ContactSamples::new(a, b, 300, 0, None);
    let pose = Isometry3::translation(-0.9, -0.7, 0.1);
    let mut solver = DepthSolver::new(a, b);
    assert!(samples.fit(&solver) && !samples.fit(&DepthSolver::new(b, a)));
    for metric in [a.disp() as &dyn Metric, a.sigma().unwrap()] {
        let near = samples.nearest(metric, &pose, 6, 0.2);
        let options = DepthOptions { poses: &near, rays: false, push_out: false, ..Default::default() };
        let found = solver.depth(&pose, metric, &options, None);
        assert!(!solver.pair().collides(&found.pose));
        assert!(found.upper <= metric.distance(&pose, &near[0]), "{found:?}");
        let best = solver.depth(&pose, metric, &DepthOptions::default(), None).upper;
        assert!(found.upper <= 2.0 * best, "{} {best}", found.upper);
    }
}

#[test]
fn bytes_are_the_same_samples_to_the_last_bit() {
    let [(a, b), ..] = &pairs();
    let samples = ContactSamples::new(a, b, 30, 5, None);
    let bytes = samples.to_bytes();
    assert_eq!(bytes.len(), 48 + 30 * 56);
    let again = ContactSamples::from_bytes(&bytes, a, b).unwrap();
    assert_eq!((&again, again.to_bytes()), (&samples, bytes));
    let empty = ContactSamples::new(a, b, 0, 5, None).to_bytes();
    assert!(ContactSamples::from_bytes(&empty, a, b).unwrap().poses().is_empty());
}

/// The format is fixed: these bytes were written by hand.
#[test]
fn the_format_is_what_it_says() {
    let body = model(&tetrahedron());
    let turn = UnitQuaternion::new_unchecked(Quaternion::new(0.6, 0.0, 0.8, 0.0));
    let pose = Isometry3::from_parts(Vector3::new(1.0, -2.0, 0.5).into(), turn);
    let bytes = ContactSamples::from_poses(&body, &body, vec![pose]).unwrap().to_bytes();
    let fnv =
        |bytes: &[u8]| bytes.iter().fold(0xcbf29ce484222325u64, |h, b| (h ^ u64::from(*b)).wrapping_mul(0x100000001b3));
    let mut print = [4u64.to_le_bytes(), 4u64.to_le_bytes()].concat();
    for x in [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1] {
        print.extend(f64::from(x).to_le_bytes());
    }
    for v in [0u32, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] {
        print.extend(v.to_le_bytes());
    }
    let mut by_hand = b"QDISTCS\0\x01\0\0\0\0\0\0\0".to_vec();
    by_hand.extend([fnv(&print).to_le_bytes(), fnv(&print).to_le_bytes(), 1u64.to_le_bytes()].concat());
    for x in [0.6, 0.0, 0.8, 0.0, 1.0, -2.0, 0.5f64] {
        by_hand.extend(x.to_le_bytes());
    }
    by_hand.extend(fnv(&by_hand).to_le_bytes());
    assert_eq!(bytes, by_hand);
}

#[test]
fn samples_of_another_pair_are_refused() {
    let [(a, b), (c, _), _] = &pairs();
    let bytes = ContactSamples::new(a, b, 3, 5, None).to_bytes();
    let error = |a: &Model, b: &Model| ContactSamples::from_bytes(&bytes, a, b).unwrap_err();
    assert_eq!(error(c, b), SamplesError::Pair { a: true, b: false });
    assert_eq!(error(a, c), SamplesError::Pair { a: false, b: true });
    assert_eq!(error(b, a), SamplesError::Pair { a: true, b: true });
    assert!(error(c, b).to_string().contains("other bodies: A"));
    // A body that differs by one digit, or by one triangle's corners.
    let mut shape = l_shape();
    shape.vertices[2][1] = shape.vertices[2][1].next_up();
    assert_eq!(error(&model(&shape), b), SamplesError::Pair { a: true, b: false });
    let mut shape = l_shape();
    shape.triangles[0].rotate_left(1);
    assert_eq!(error(&model(&shape), b), SamplesError::Pair { a: true, b: false });
    // A zero with a sign is the same number.
    let mut shape = l_shape();
    shape.vertices.iter_mut().flatten().filter(|x| **x == 0.0).for_each(|x| *x = -0.0);
    assert!(ContactSamples::from_bytes(&bytes, &model(&shape), b).is_ok());
}

#[test]
fn broken_bytes_are_refused_and_named() {
    let [(a, b), ..] = &pairs();
    let bytes = ContactSamples::new(a, b, 3, 5, None).to_bytes();
    let error = |bytes: &[u8]| ContactSamples::from_bytes(bytes, a, b).unwrap_err();
    for end in 0..bytes.len() {
        let expected = match end {
            0..8 => SamplesError::NotSamples,
            8..48 => SamplesError::Length { expected: Some(48), found: end },
            _ => SamplesError::Length { expected: Some(bytes.len()), found: end },
        };
        assert_eq!(error(&bytes[..end]), expected);
    }
    let longer = [&bytes[..], &[0]].concat();
    assert_eq!(error(&longer), SamplesError::Length { expected: Some(bytes.len()), found: bytes.len() + 1 });
    for at in 0..bytes.len() {
        let mut changed = bytes.clone();
        changed[at] ^= 0x10;
        let expected = match at {
            0..8 => SamplesError::NotSamples,
            8..12 => SamplesError::Version { found: 1 ^ (0x10 << (8 * (at - 8))) },
            32..40 => {
                assert!(matches!(error(&changed), SamplesError::Length { .. }), "{at}");
                continue;
            }
            _ => SamplesError::Checksum,
        };
        assert_eq!(error(&changed), expected, "{at}");
    }
    let mut absurd = bytes.clone();
    absurd[32..40].fill(0xff);
    assert_eq!(error(&absurd), SamplesError::Length { expected: None, found: bytes.len() });
    assert!(error(&absurd).to_string().starts_with("bytes: "));
}

#[test]
fn poses_that_are_none_are_refused() {
    let body = model(&tetrahedron());
    let good = Isometry3::translation(1.0, 2.0, 3.0);
    let turned = |w: f64| {
        Isometry3::from_parts(good.translation, UnitQuaternion::new_unchecked(Quaternion::new(w, 0.0, 0.0, 0.0)))
    };
    for bad in [
        turned(1.001),
        turned(0.0),
        turned(f64::NAN),
        Isometry3::translation(f64::NAN, 0.0, 0.0),
        Isometry3::translation(0.0, f64::INFINITY, 0.0),
        Isometry3::translation(0.0, 0.0, 1e61),
    ] {
        let samples = ContactSamples::from_poses(&body, &body, vec![good, bad, good]);
        assert_eq!(samples, Err(SamplesError::Pose { index: 1 }));
    }
    let samples = ContactSamples::from_poses(&body, &body, vec![good]).unwrap();
    assert_eq!(samples.poses(), [good]);
    assert_eq!(samples.nearest(body.disp(), &turned(1.0), 1, 0.0), [good]);
}
