//! Mass properties, the hull filter and the metrics against closed forms, quadrature and brute force.
use crate::common;

use common::dice::Dice;
use nalgebra::{Isometry3, Matrix3, Point3, UnitQuaternion, Vector3};
use qdist::mesh::hull::{HullError, hull_vertices};
use qdist::mesh::mass::{MassError, MassProperties};
use qdist::mesh::metric::{Disp, DispError, Metric, Sigma};

type Mesh = (Vec<Point3<f64>>, Vec<[u32; 3]>);

fn direction(dice: &mut Dice) -> Vector3<f64> {
    Vector3::from_fn(|_, _| dice.normal()).normalize()
}

fn pose(dice: &mut Dice, reach: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(direction(dice) * dice.range(0.0, 3.1));
    Isometry3::from_parts((Vector3::from_fn(|_, _| dice.signed()) * reach).into(), turn)
}

/// An axis-parallel box with half extents h.
fn cuboid(h: [f64; 3]) -> Mesh {
    let sign = |k: u32, bit: u32| if k >> bit & 1 == 1 { 1.0 } else { -1.0 };
    let corners = (0..8).map(|k| Point3::new(sign(k, 0) * h[0], sign(k, 1) * h[1], sign(k, 2) * h[2])).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    (corners, faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

/// A subdivided octahedron on the unit sphere.
fn sphere(levels: usize) -> Mesh {
    let mut points: Vec<Point3<f64>> =
        [1.0, -1.0].into_iter().flat_map(|s| (0..3).map(move |k| Point3::from(Vector3::ith(k, s)))).collect();
    let mut triangles: Vec<[u32; 3]> =
        vec![[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    for _ in 0..levels {
        let mut middles = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for &[a, b, c] in &triangles {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let m = points[a as usize].coords + points[b as usize].coords;
                    points.push(Point3::from(m.normalize()));
                    points.len() as u32 - 1
                })
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    (points, triangles)
}

fn map(mesh: &Mesh, f: impl Fn(&Point3<f64>) -> Point3<f64>) -> Mesh {
    (mesh.0.iter().map(f).collect(), mesh.1.clone())
}

fn mass(mesh: &Mesh) -> MassProperties {
    MassProperties::new(&mesh.0, &mesh.1).unwrap()
}

fn box_inertia(volume: f64, h: [f64; 3]) -> Matrix3<f64> {
    let [a, b, c] = h.map(|x| x * x / 3.0);
    Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b)) * volume
}

#[test]
fn mass_of_boxes_anywhere() {
    let mut dice = Dice::new(1);
    for _ in 0..200 {
        let scale = dice.decade(-6.0, 6.0);
        let h = [0.1, 0.1, 0.1].map(|x| x * dice.decade(0.0, 2.0) * scale);
        let offset = if dice.chance(0.5) { 0.0 } else { 1e4 };
        let at = pose(&mut dice, offset * scale);
        let found = mass(&map(&cuboid(h), |p| at * p));
        let volume = 8.0 * h[0] * h[1] * h[2];
        let tolerance = if offset > 0.0 { 1e-9 } else { 1e-12 };
        let turn = at.rotation.to_rotation_matrix().into_inner();
        let inertia = turn * box_inertia(volume, h) * turn.transpose();
        assert!((found.volume / volume - 1.0).abs() < tolerance);
        assert!((found.centre.coords - at.translation.vector).norm() < tolerance * scale);
        assert!((found.inertia - inertia).norm() < tolerance * inertia.norm());
    }
}

#[test]
fn mass_of_a_tetrahedron() {
    // Volume 1/6, centre (1/4, 1/4, 1/4); about it the variance of each coordinate is 3/80, every covariance -1/80.
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from);
    let found = MassProperties::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]).unwrap();
    assert!((found.volume - 1.0 / 6.0).abs() < 1e-16);
    assert!((found.centre - Point3::new(0.25, 0.25, 0.25)).norm() < 1e-15);
    let inertia = Matrix3::from_fn(|i, j| if i == j { 6.0 / 80.0 } else { 1.0 / 80.0 }) / 6.0;
    assert!((found.inertia - inertia).norm() < 1e-16);
}

#[test]
fn mass_of_a_fine_ellipsoid_tends_to_the_closed_form() {
    let axes = Vector3::new(1.0, 2.0, 3.0);
    let found = mass(&map(&sphere(5), |p| Point3::from(p.coords.component_mul(&axes))));
    let volume = 4.0 / 3.0 * std::f64::consts::PI * axes.product();
    let inertia = Matrix3::from_diagonal(&Vector3::new(13.0, 10.0, 5.0)) * (volume / 5.0);
    assert!((found.volume / volume - 1.0).abs() < 3e-3 && found.volume < volume);
    assert!((found.inertia - inertia).norm() < 6e-3 * inertia.norm());
    assert!(found.centre.coords.norm() < 1e-12);
}

#[test]
fn what_has_no_volume_says_why() {
    let (points, triangles) = cuboid([1.0, 2.0, 3.0]);
    let new = |t: &[[u32; 3]]| MassProperties::new(&points, t);
    assert_eq!(new(&[]), Err(MassError::Empty));
    assert_eq!(new(&[[0, 1, 2], [0, 1, 8]]), Err(MassError::Index { triangle: 1 }));
    assert!(matches!(new(&triangles[1..]), Err(MassError::Open { edges: 3, .. })));
    let mut flipped = triangles.clone();
    flipped[4].swap(0, 1);
    assert!(matches!(new(&flipped), Err(MassError::Open { edges: 6, .. })));
    let inverted: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    assert!(matches!(new(&inverted), Err(MassError::Inverted { volume }) if (volume + 48.0).abs() < 1e-12));
    assert_eq!(new(&[[0, 1, 2], [0, 2, 1]]), Err(MassError::Flat));
    assert_eq!(new(&[[0, 0, 0]]), Err(MassError::Flat));
    for bad in [f64::NAN, f64::INFINITY] {
        let mut points = points.clone();
        points[3].y = bad;
        assert_eq!(MassProperties::new(&points, &triangles), Err(MassError::NotFinite { vertex: 3 }));
        assert_eq!(hull_vertices(&points), Err(HullError::NotFinite { vertex: 3 }));
        assert!(matches!(Disp::new(&points), Err(DispError::Hull(HullError::NotFinite { vertex: 3 }))));
    }
    // Corners repeated for each triangle, as in STL files: the surface is closed by position.
    let soup: Vec<_> = triangles.iter().flatten().map(|&i| points[i as usize]).collect();
    let own: Vec<_> = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    assert_eq!(MassProperties::new(&soup, &own), new(&triangles));
    assert_eq!(hull_vertices(&[]), Err(HullError::Empty));
    assert_eq!(Disp::new(&[Point3::origin(), Point3::origin()]).unwrap_err(), DispError::Collinear);
    let line: Vec<_> = (0..9).map(|k| Point3::new(f64::from(k), 2.0 * f64::from(k), 1.0)).collect();
    assert_eq!(Disp::new(&line).unwrap_err(), DispError::Collinear);
}

/// The largest height over some directions, of all points and of those kept.
fn assert_hull_kept(points: &[Point3<f64>], directions: impl Iterator<Item = Vector3<f64>>) -> usize {
    let kept = hull_vertices(points).unwrap();
    assert!(kept.windows(2).all(|w| w[0] < w[1]));
    let middle = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let height = |p: &Point3<f64>, d: &Vector3<f64>| (p.coords - middle).dot(d);
    for d in directions {
        let all = points.iter().map(|p| height(p, &d)).fold(f64::MIN, f64::max);
        let of_kept = kept.iter().map(|&i| height(&points[i as usize], &d)).fold(f64::MIN, f64::max);
        assert_eq!(all, of_kept);
    }
    kept.len()
}

#[test]
fn no_corner_of_a_hull_is_dropped() {
    let mut dice = Dice::new(2);
    for run in 0..60 {
        let count = dice.pick(&[1, 2, 3, 5, 30, 300, 3000]);
        let axes = Vector3::from_fn(|_, _| dice.decade(-4.0, 0.0)) * dice.decade(-6.0, 6.0);
        let offset = if run % 3 == 0 { 1e6 * axes.amax() } else { 0.0 };
        let kind = run % 5;
        let points: Vec<_> = (0..count)
            .map(|_| {
                let mut x = match kind {
                    0 => direction(&mut dice),
                    1 => Vector3::from_fn(|_, _| dice.signed()),
                    // A coarse grid: repeated and coplanar points.
                    2 => Vector3::from_fn(|_, _| f64::from(dice.below(5) as u32)),
                    3 => Vector3::new(dice.signed(), dice.signed(), 0.0),
                    _ => direction(&mut dice) * dice.unit().powi(4),
                };
                x.component_mul_assign(&axes);
                Point3::from(x + Vector3::repeat(offset))
            })
            .collect();
        let mut directions: Vec<_> = (0..300).map(|_| direction(&mut dice).component_div(&axes)).collect();
        // Normals of triples: facets, where the set is small.
        for _ in 0..300 {
            let [a, b, c] = [0; 3].map(|_| points[dice.below(points.len())]);
            let n = (b - a).cross(&(c - a));
            directions.extend([n, -n]);
        }
        let kept = assert_hull_kept(&points, directions.into_iter());
        if kind == 4 && count >= 3000 {
            assert!(kept < count / 4, "{kept} of {count}");
        }
    }
}

#[test]
fn every_corner_of_a_sphere_is_kept_and_nothing_inside() {
    let mut dice = Dice::new(3);
    let (mut points, _) = sphere(4);
    let corners = points.len();
    let inside = (0..20_000).map(|_| Point3::from(direction(&mut dice) * dice.range(0.0, 0.9)));
    points.extend(inside);
    let kept = hull_vertices(&points).unwrap();
    assert!((0..corners as u32).all(|i| kept.contains(&i)));
    assert!(kept.len() < corners + 200, "{}", kept.len() - corners);
}

/// The integral's root: quadrature of degree 2 on the tetrahedra between a point and the triangles.
fn mean_square_displacement(mesh: &Mesh, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
    let apex = mesh.0[0];
    let (near, far) = ((5.0 - 5f64.sqrt()) / 20.0, (5.0 + 3.0 * 5f64.sqrt()) / 20.0);
    let (mut volume, mut sum) = (0.0, 0.0);
    for t in &mesh.1 {
        let corners = [apex, mesh.0[t[0] as usize], mesh.0[t[1] as usize], mesh.0[t[2] as usize]];
        let [a, b, c] = [1, 2, 3].map(|k| corners[k] - apex);
        let part = a.dot(&b.cross(&c)) / 6.0;
        volume += part;
        for k in 0..4 {
            let weight = |i| if i == k { far } else { near };
            let x = Point3::from((0..4).map(|i| corners[i].coords * weight(i)).sum::<Vector3<f64>>());
            sum += part / 4.0 * (to * x - from * x).norm_squared();
        }
    }
    (sum / volume).sqrt()
}

#[test]
fn metrics_agree_with_quadrature_and_brute_force() {
    let mut dice = Dice::new(4);
    for run in 0..100 {
        let axes = Vector3::from_fn(|_, _| dice.range(0.05, 1.0));
        let scale = dice.decade(-6.0, 6.0);
        let base = if run % 2 == 0 { cuboid([1.0, 1.0, 1.0]) } else { sphere(3) };
        let shape = map(&base, |p| Point3::from(p.coords.component_mul(&axes) * scale));
        let body = pose(&mut dice, 3.0 * scale);
        let mesh = map(&shape, |p| body * p);
        let from = pose(&mut dice, scale);
        let to = match run % 4 {
            0 => Isometry3::translation(0.1 * scale, 0.2 * scale, -0.3 * scale) * from,
            1 => from * Isometry3::rotation(direction(&mut dice) * 1e-5),
            _ => pose(&mut dice, scale),
        };
        let (sigma, disp) = (Sigma::new(&mass(&mesh)), Disp::new(&mesh.0).unwrap());
        let (mean, most) = (sigma.distance(&from, &to), disp.distance(&from, &to));
        let expected = mean_square_displacement(&mesh, &from, &to);
        let brute = mesh.0.iter().map(|x| (to * x - from * x).norm()).fold(0.0, f64::max);
        let rounding = 1e-13 * scale;
        assert!((mean - expected).abs() < 1e-10 * expected + rounding, "run {run}: {mean} {expected}");
        assert!((most - brute).abs() < 1e-12 * brute + rounding, "run {run}: {most} {brute}");
        assert!(mean <= most * (1.0 + 1e-12) + rounding);
        assert!((sigma.distance(&to, &from) - mean).abs() < rounding + 1e-12 * mean);

        // Other frames, of the world and of the body; another scale.
        let (world, own) = (pose(&mut dice, scale), pose(&mut dice, scale));
        let back = own.inverse();
        let other = map(&mesh, |p| own * p);
        let (f, t) = (world * from * back, world * to * back);
        let mean_there = Sigma::new(&mass(&other)).distance(&f, &t);
        let most_there = Disp::new(&other.0).unwrap().distance(&f, &t);
        assert!((mean_there - mean).abs() < 1e-9 * mean + 10.0 * rounding, "run {run}: {mean_there} {mean}");
        assert!((most_there - most).abs() < 1e-9 * most + 10.0 * rounding, "run {run}: {most_there} {most}");
        let large = map(&mesh, |p| p * 1024.0);
        let enlarged = |q: &Isometry3<f64>| Isometry3::from_parts((q.translation.vector * 1024.0).into(), q.rotation);
        let (f, t) = (enlarged(&from), enlarged(&to));
        assert!((Sigma::new(&mass(&large)).distance(&f, &t) / 1024.0 - mean).abs() < 1e-9 * mean + rounding);
        assert!((Disp::new(&large.0).unwrap().distance(&f, &t) / 1024.0 - most).abs() < 1e-9 * most + rounding);
    }
}

#[test]
fn a_ball_that_turns_about_its_centre_and_a_plate_in_a_slot() {
    // sqrt(sigma) = 2 sin(D/2) sqrt((l^2 + w^2)/12), DISP = sqrt(l^2 + w^2) sin(D/2) for a plate turned by D about its middle.
    let (l, w, angle) = (1.2, 0.3, 0.4f64);
    let plate = cuboid([l / 2.0, w / 2.0, 0.5]);
    let turn = Isometry3::rotation(Vector3::z() * angle);
    let diagonal = f64::hypot(l, w);
    let sine = (angle / 2.0).sin();
    let stay = Isometry3::identity();
    assert!((Disp::new(&plate.0).unwrap().distance(&stay, &turn) - diagonal * sine).abs() < 1e-15);
    assert!((Sigma::new(&mass(&plate)).distance(&stay, &turn) - 2.0 * sine * diagonal / 12f64.sqrt()).abs() < 1e-15);
    // q and -q are one rotation.
    let other = Isometry3::from_parts(turn.translation, UnitQuaternion::new_unchecked(-turn.rotation.into_inner()));
    assert_eq!(Sigma::new(&mass(&plate)).distance(&turn, &other), 0.0);
}

#[test]
fn models_are_the_square_to_first_order_and_sigma_is_quadratic_in_its_chart() {
    let mut dice = Dice::new(5);
    for _ in 0..50 {
        let mesh = map(&cuboid([1.0, 0.4, 0.2]), |p| p + Vector3::new(0.3, -1.0, 2.0));
        let sigma = Sigma::new(&mass(&mesh));
        let (from, at) = (pose(&mut dice, 1.0), pose(&mut dice, 1.0));
        let model = sigma.model(&from, &at);
        assert!((model.value.sqrt() - sigma.distance(&from, &at)).abs() < 1e-12);
        let frame = sigma.frame();
        let y = nalgebra::Vector6::from_fn(|_, _| dice.signed());
        // Central differences along y.
        let square = |h: f64| sigma.distance(&from, &frame.twist(&at, &(y * h)).applied(&at)).powi(2);
        let slope = (square(1e-5) - square(-1e-5)) / 2e-5;
        assert!((slope - 2.0 * model.gradient.dot(&y)).abs() < 1e-8 * (1.0 + slope.abs()));
        // The pose whose quaternion is moved along a straight line, in the axes of the body: exactly the model.
        let relative = (from.rotation.inverse() * at.rotation).into_inner();
        let relative = if relative.w < 0.0 { -relative } else { relative };
        let h = 0.02;
        let w = frame.axes * y.fixed_rows::<3>(3) * (h / frame.radius);
        let q = relative.imag() + (w * relative.w + relative.imag().cross(&w)) / 2.0;
        if q.norm() < 1.0 {
            let turned =
                UnitQuaternion::from_quaternion(nalgebra::Quaternion::from_parts((1.0 - q.norm_squared()).sqrt(), q));
            let rotation = from.rotation * turned;
            let linear = frame.twist(&at, &(y * h)).linear;
            let centre = at * frame.centre + linear;
            let to = Isometry3::from_parts((centre.coords - rotation * frame.centre.coords).into(), rotation);
            let exact = sigma.distance(&from, &to).powi(2);
            assert!((model.at(&(y * h)) - exact).abs() < 1e-12 * (1.0 + exact));
        }
    }
}

/// Vertices and triangles of an OBJ file; polygons as fans.
fn read_obj(path: &std::path::Path) -> Mesh {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(path).unwrap().lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.split_first() {
            Some((&"v", x)) => points.push(Point3::from([0, 1, 2].map(|k| x[k].parse::<f64>().unwrap()))),
            Some((&"f", corners)) => {
                let index = |word: &&str| word.split('/').next().unwrap().parse::<u32>().unwrap() - 1;
                let corners: Vec<u32> = corners.iter().map(index).collect();
                triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
            }
            _ => {}
        }
    }
    (points, triangles)
}

/// The shared queries' values were computed elsewhere, from their poses and the files.
#[test]
#[ignore = "needs ../shared/data"]
fn metrics_agree_with_the_shared_queries() {
    let path = common::shared("meshes/queries.json");
    let data: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&path).unwrap()).unwrap();
    let pose = |value: &serde_json::Value| {
        let numbers =
            |key: &str| value[key].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
        let (q, t) = (numbers("q_wxyz"), numbers("t"));
        let turn = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
        Isometry3::from_parts(Vector3::from_column_slice(&t).into(), turn)
    };
    let mut compared = 0;
    for query in data["queries"].as_array().unwrap() {
        let mesh = read_obj(&path.with_file_name(query["A"].as_str().unwrap()));
        let from = pose(&query["pose0"]);
        let disp = Disp::new(&mesh.0).unwrap();
        let solid = MassProperties::new(&mesh.0, &mesh.1).map(|mass| Sigma::new(&mass));
        let close = |value: f64, key: &str| {
            let expected = query[key].as_f64().unwrap();
            assert!((value - expected).abs() < 1e-9 * expected, "{} {key}: {value} {expected}", query["id"]);
        };
        close(disp.distance(&from, &pose(&query["disp_pose"])), "disp_ub");
        let sigma = solid.unwrap_or_else(|error| panic!("{}: {error}", query["A"]));
        close(sigma.distance(&from, &pose(&query["sigma_pose"])), "sqrt_sigma_ub");
        compared += 1;
    }
    assert!(compared > 50);
}

/// A body that is inside out in parts may have a mean square displacement that is negative.
#[test]
fn a_tangled_surface_has_no_object_norm() {
    let ((mut points, mut triangles), (small, inward)) = (cuboid([1.0; 3]), cuboid([0.9; 3]));
    triangles.extend(inward.iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]));
    points.extend(small.iter().map(|p| p + 9.0 * Vector3::z()));
    assert_eq!(MassProperties::new(&points, &triangles), Err(MassError::Tangled));
}

/// Their smallest moments are lost in rounding.
#[test]
fn slender_bodies_have_an_object_norm() {
    let mut dice = Dice::new(6);
    for half in [1e-3, 1e-6, 1e-9].iter().flat_map(|&thin| [[1.0, 1.0, thin], [1.0, thin, thin]]) {
        for _ in 0..50 {
            let (points, triangles) = cuboid(half);
            let turned = pose(&mut dice, 1.0);
            let points: Vec<_> = points.iter().map(|p| turned * p).collect();
            let mass = match MassProperties::new(&points, &triangles) {
                Ok(mass) => mass,
                Err(error) => {
                    assert!(error == MassError::Flat && half[1] < 1e-5, "{error:?} {half:?}");
                    continue;
                }
            };
            let value = Sigma::new(&mass).distance(&Isometry3::identity(), &pose(&mut dice, 1.0));
            assert!(value > 0.0 && value.is_finite(), "{value}");
        }
    }
}
