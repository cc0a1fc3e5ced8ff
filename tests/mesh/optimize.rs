//! The steps of the mesh layer against Clarabel, an interior point solver, and against the conditions of optimality.
use crate::common;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, SupportedConeT,
};
use common::dice::Dice;
use nalgebra::{Isometry3, Matrix3, Matrix6, Point3, UnitQuaternion, Vector3, Vector6};
use qdist::mesh::mass::MassProperties;
use qdist::mesh::metric::{BodyFrame, Disp, Metric, Sigma};
use qdist::mesh::optimize::{Constraint, Quadratic, Step, StepEnd, StepError, StepMemory, StepOptions, Twist};
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

fn direction(dice: &mut Dice) -> Vector3<f64> {
    Vector3::from_fn(|_, _| dice.normal()).normalize()
}

fn pose(dice: &mut Dice, reach: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(direction(dice) * dice.range(0.0, 3.0));
    Isometry3::from_parts((Vector3::from_fn(|_, _| dice.signed()) * reach).into(), turn)
}

/// A pose near another one.
fn near(dice: &mut Dice, pose: &Isometry3<f64>, length: f64, angle: f64) -> Isometry3<f64> {
    let turn = UnitQuaternion::from_scaled_axis(direction(dice) * angle);
    let shift = direction(dice) * length;
    Isometry3::from_parts((pose.translation.vector + shift).into(), turn * pose.rotation)
}

struct Problem {
    vertices: Vec<Point3<f64>>,
    from: Isometry3<f64>,
    at: Isometry3<f64>,
    contacts: Vec<Constraint>,
    options: StepOptions,
}

/// A body of points on an ellipsoid, moved away from a pose, with contacts that hold at rest, some of them repeated or nearly so.
fn problem(dice: &mut Dice, corners: usize, contacts: usize, scale: f64, trust: f64) -> Problem {
    let axes = Vector3::from_fn(|_, _| dice.range(0.2, 1.0)) * scale;
    let offset = Vector3::from_fn(|_, _| dice.signed()) * scale;
    let vertices: Vec<Point3<f64>> =
        (0..corners).map(|_| Point3::from(direction(dice).component_mul(&axes) + offset)).collect();
    let from = pose(dice, scale);
    let (length, angle) = (dice.range(0.0, 0.3) * scale, dice.range(0.0, 0.4));
    let at = near(dice, &from, length, angle);
    let mut list: Vec<Constraint> = Vec::new();
    for _ in 0..contacts {
        let point = at * vertices[dice.below(corners)];
        let mut contact = Constraint {
            point,
            normal: direction(dice),
            gap: if dice.chance(0.3) { 0.0 } else { dice.range(0.0, 0.1) * scale },
        };
        if let Some(&last) = list.last() {
            if dice.chance(0.1) {
                contact = last;
            } else if dice.chance(0.2) {
                let tilt = direction(dice) * dice.decade(-14.0, -2.0);
                contact = Constraint { normal: (last.normal + tilt).normalize(), ..last };
            }
        }
        list.push(contact);
    }
    Problem { vertices, from, at, contacts: list, options: StepOptions { trust: trust * scale, tolerance: 1e-6 } }
}

type Inequality = (Vector6<f64>, f64);

/// The contacts and the walls of the trust region, a.x >= b for the twist x = (linear, radius angular) about a point, in the world's axes.
fn rows(problem: &Problem, metric: &dyn Metric) -> (Vec<Inequality>, Vec<Inequality>) {
    let frame = metric.frame();
    let about = problem.at * frame.centre;
    let wrench = |f: Vector3<f64>, m: Vector3<f64>| Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
    let contacts =
        problem.contacts.iter().map(|c| (wrench(c.normal, (c.point - about).cross(&c.normal) / frame.radius), -c.gap));
    let mut walls = Vec::new();
    if problem.options.trust.is_finite() {
        for k in 0..3 {
            let axis: Vector3<f64> = problem.at.rotation * frame.axes.column(k).into_owned();
            for sign in [-1.0, 1.0] {
                walls.push((wrench(axis * sign, Vector3::zeros()), -problem.options.trust));
                walls.push((wrench(Vector3::zeros(), axis * sign), -problem.options.trust));
            }
        }
    }
    (contacts.collect(), walls)
}

struct Oracle {
    value: f64,
    solved: bool,
    infeasible: bool,
}

/// min x^T P x / 2 + q^T x with slack b - A x in the cones, dense.
fn clarabel(p: &[Vec<f64>], q: &[f64], a: &[Vec<f64>], b: &[f64], cones: &[SupportedConeT<f64>]) -> Oracle {
    let dense = |rows: &[Vec<f64>], upper: bool| {
        let (mut starts, mut at, mut values) = (vec![0], Vec::new(), Vec::new());
        for j in 0..q.len() {
            for (i, row) in rows.iter().enumerate() {
                if row[j] != 0.0 && !(upper && i > j) {
                    at.push(i);
                    values.push(row[j]);
                }
            }
            starts.push(at.len());
        }
        CscMatrix::new(rows.len(), q.len(), starts, at, values)
    };
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-11,
        tol_gap_rel: 1e-11,
        tol_feas: 1e-11,
        max_iter: 200,
        ..DefaultSettings::default()
    };
    let mut solver = DefaultSolver::new(&dense(p, true), q, &dense(a, false), b, cones, settings).unwrap();
    solver.solve();
    let status = solver.solution.status;
    Oracle {
        value: solver.solution.obj_val,
        solved: matches!(status, SolverStatus::Solved | SolverStatus::AlmostSolved),
        infeasible: matches!(status, SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible),
    }
}

/// The least of the largest displacement, as a second-order cone program.
fn least_displacement(problem: &Problem, metric: &Disp) -> Oracle {
    let (contacts, walls) = rows(problem, metric);
    let (mut a, mut b) = (Vec::new(), Vec::new());
    for (normal, offset) in contacts.iter().chain(&walls) {
        a.push(normal.iter().map(|x| -x).chain([0.0]).collect::<Vec<f64>>());
        b.push(-offset);
    }
    let mut cones = vec![NonnegativeConeT(a.len())];
    let frame = metric.frame();
    for x in &problem.vertices {
        let v = problem.at * x - problem.from * x;
        let arm = (problem.at * x - problem.at * frame.centre) / frame.radius;
        a.push(vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
        b.push(0.0);
        for k in 0..3 {
            let mut row = vec![0.0; 7];
            row[k] = -1.0;
            // (w x arm)_k = sum over j of w_j (e_j x arm)_k
            for j in 0..3 {
                row[3 + j] = -Vector3::ith(j, 1.0).cross(&arm)[k];
            }
            a.push(row);
            b.push(v[k]);
        }
        cones.push(SecondOrderConeT(4));
    }
    clarabel(&vec![vec![0.0; 7]; 7], &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &a, &b, &cones)
}

/// The largest displacement after a twist, to first order, over all vertices.
fn moved(problem: &Problem, step: &Step) -> f64 {
    let displacement = |x: &Point3<f64>| {
        let now = problem.at * x;
        (now - problem.from * x + step.twist.velocity(&now)).norm()
    };
    problem.vertices.iter().map(displacement).fold(0.0, f64::max)
}

/// The largest violation of a contact.
fn violation(problem: &Problem, step: &Step) -> f64 {
    let one = |c: &Constraint| -c.gap - c.normal.dot(&step.twist.velocity(&c.point));
    problem.contacts.iter().map(one).fold(0.0, f64::max)
}

#[test]
fn displacement_steps_agree_with_a_cone_solver() {
    let mut dice = Dice::new(11);
    let mut memory = StepMemory::new(100);
    let (mut programs, mut runs) = (0, 0);
    for run in 0..150 {
        let scale = dice.decade(-6.0, 6.0);
        let corners = dice.pick(&[4, 8, 20, 60]);
        let contacts = dice.pick(&[0, 1, 3, 10, 30, 100]);
        let trust = dice.pick(&[f64::INFINITY, 0.1, 0.02]);
        let mut p = problem(&mut dice, corners, contacts, scale, trust);
        let disp = Disp::new(&p.vertices).unwrap();
        let step = disp.step(&p.from, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
        p.options.trust /= scale;
        // The oracle sees the problem at scale 1.
        for x in &mut p.vertices {
            x.coords /= scale;
        }
        for pose in [&mut p.from, &mut p.at] {
            pose.translation.vector /= scale;
        }
        for c in &mut p.contacts {
            c.point.coords /= scale;
            c.gap /= scale;
        }
        let unit = Disp::new(&p.vertices).unwrap();
        let oracle = least_displacement(&p, &unit);
        if !oracle.solved {
            continue;
        }
        let (value, lower) = (step.value / scale, step.lower / scale);
        let tell = format!(
            "run {run}: {corners} corners, {contacts} contacts, {value} >= {} >= {lower}, {:?} {}",
            oracle.value, step.end, step.programs
        );
        let slack = 1e-8;
        let left = violation(&p, &Step { twist: unit_twist(&step, scale), ..step });
        assert!(left < 1e-10 && step.violation < 1e-10 * scale, "{tell}: {left}");
        let again = moved(&p, &Step { twist: unit_twist(&step, scale), ..step });
        assert!((again - value).abs() < 1e-10, "{tell}: {again}");
        assert!(value >= oracle.value - slack && lower <= oracle.value + slack, "{tell}");
        assert!(step.end == StepEnd::Optimal && value <= oracle.value * (1.0 + 2e-6) + slack, "{tell}");
        programs += step.programs;
        runs += 1;
    }
    assert!(runs > 140);
    assert!(programs < 8 * runs, "{programs} programs in {runs} steps");
}

/// The twist at scale 1.
fn unit_twist(step: &Step, scale: f64) -> Twist {
    Twist { linear: step.twist.linear / scale, angular: step.twist.angular, about: step.twist.about / scale }
}

fn solid(dice: &mut Dice, scale: f64) -> Sigma {
    let k = Vector3::from_fn(|_, _| dice.range(0.05, 1.0)).normalize() * scale * scale;
    let gyration = Matrix3::from_diagonal(&Vector3::new(k.y + k.z, k.x + k.z, k.x + k.y));
    let turn = pose(dice, 1.0).rotation.to_rotation_matrix().into_inner();
    let centre = Point3::from(Vector3::from_fn(|_, _| dice.signed()) * scale);
    Sigma::new(&MassProperties {
        volume: scale.powi(3),
        centre,
        inertia: turn * gyration * turn.transpose() * scale.powi(3),
    })
}

/// The twist as the variables of the rows.
fn variables(step: &Step, radius: f64) -> Vector6<f64> {
    let (v, w) = (step.twist.linear, step.twist.angular * radius);
    Vector6::new(v.x, v.y, v.z, w.x, w.y, w.z)
}

/// The least violation of the contacts within the walls, and the least of the quadratic model, in the world's axes.
fn quadratic_oracles(problem: &Problem, metric: &dyn Metric) -> (Oracle, Oracle) {
    let (contacts, walls) = rows(problem, metric);
    let table = |extra: f64| {
        let row = |(n, _): &Inequality, e: f64| n.iter().map(|x| -x).chain([-e]).collect::<Vec<f64>>();
        let a: Vec<_> = contacts.iter().map(|c| row(c, extra)).chain(walls.iter().map(|c| row(c, 0.0))).collect();
        let b: Vec<_> = contacts.iter().chain(&walls).map(|c| -c.1).collect();
        (a, b)
    };
    let (mut a, mut b) = table(1.0);
    a.push(vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    b.push(0.0);
    let cones = [NonnegativeConeT(a.len())];
    let relaxed = clarabel(&vec![vec![0.0; 7]; 7], &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], &a, &b, &cones);

    let (a, b) = table(0.0);
    let model = metric.model(&problem.from, &problem.at);
    // The model's variables are in the body's axes.
    let axes = problem.at.rotation.to_rotation_matrix().into_inner() * metric.frame().axes;
    let mut turn = Matrix6::zeros();
    for k in [0, 3] {
        turn.fixed_view_mut::<3, 3>(k, k).copy_from(&axes);
    }
    let (h, g) = (turn * model.hessian * turn.transpose(), turn * model.gradient);
    let p: Vec<Vec<f64>> =
        (0..7).map(|i| (0..7).map(|j| if i < 6 && j < 6 { 2.0 * h[(i, j)] } else { 0.0 }).collect()).collect();
    let q: Vec<f64> = g.iter().map(|x| 2.0 * x).chain([0.0]).collect();
    let mut least = clarabel(&p, &q, &a, &b, &[NonnegativeConeT(a.len())]);
    least.value = (least.value + model.value).max(0.0).sqrt();
    (relaxed, least)
}

#[test]
fn quadratic_steps_agree_with_an_interior_point_solver() {
    let mut dice = Dice::new(12);
    let mut memory = StepMemory::new(300);
    let mut contradictions = 0;
    for run in 0..300 {
        let contacts = dice.pick(&[0, 1, 3, 10, 30, 100, 300]);
        let trust = dice.pick(&[f64::INFINITY, 0.1, 0.02]);
        let mut p = problem(&mut dice, 20, contacts, 1.0, trust);
        if run % 3 == 0 {
            // Penetrating: deep, and hardly.
            let depth = dice.decade(-6.0, -0.5);
            p.contacts.iter_mut().for_each(|c| c.gap -= depth);
        }
        let sigma = solid(&mut dice, 1.0);
        let step = sigma.step(&p.from, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
        let (relaxed, least) = quadratic_oracles(&p, &sigma);
        let left = violation(&p, &step);
        let tell = format!("run {run}: {contacts} contacts, {step:?}, {} {}, left {left}", relaxed.value, least.value);
        assert!(variables(&step, sigma.frame().radius).iter().all(|x| x.abs() <= 2.0 * p.options.trust), "{tell}");
        match step.end {
            StepEnd::Optimal => {
                assert!(left < 1e-9, "{tell}");
                if least.solved {
                    assert!((step.value - least.value).abs() < 1e-6, "{tell}");
                }
                assert!(!least.infeasible || relaxed.value < 1e-8, "{tell}");
            }
            StepEnd::Infeasible => {
                contradictions += 1;
                assert!(relaxed.solved && relaxed.value > 1e-10, "{tell}");
                assert!((left - step.violation).abs() < 1e-9 && left < relaxed.value * (1.0 + 1e-4) + 1e-7, "{tell}");
            }
            StepEnd::Limit => panic!("{tell}"),
        }
    }
    assert!(contradictions > 20, "{contradictions}");
}

/// A metric with a model and nothing else.
struct Plain(BodyFrame);

impl Metric for Plain {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        (to * self.0.centre - from * self.0.centre).norm()
    }

    fn frame(&self) -> &BodyFrame {
        &self.0
    }

    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        let e = at.rotation.inverse() * (at * self.0.centre - from * self.0.centre);
        let mut hessian = Matrix6::zeros();
        hessian.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
        Quadratic { value: e.norm_squared(), gradient: Vector6::new(e.x, e.y, e.z, 0.0, 0.0, 0.0), hessian }
    }
}

#[test]
fn a_metric_of_ones_own_that_does_not_see_rotations() {
    let metric = Plain(BodyFrame { centre: Point3::origin(), axes: Matrix3::identity(), radius: 1.0 });
    let mut memory = StepMemory::new(4);
    let (from, at) = (Isometry3::identity(), Isometry3::translation(0.0, 0.0, 0.5));
    let options = StepOptions { trust: 0.7, ..StepOptions::default() };
    let free = metric.step(&from, &at, &[], &options, &mut memory).unwrap();
    assert!(free.value < 1e-12 && free.end == StepEnd::Optimal);
    // A contact away from the centre: turning about it is free, as far as the trust region goes.
    let contact = Constraint { point: Point3::new(1.0, 0.0, 0.5), normal: Vector3::z(), gap: 0.0 };
    let step = metric.step(&from, &at, &[contact], &options, &mut memory).unwrap();
    assert!(step.value < 1e-6 && violation_of(&contact, &step) < 1e-9, "{step:?}");
    let centred = Constraint { point: Point3::new(0.0, 0.0, 0.5), ..contact };
    let step = metric.step(&from, &at, &[centred], &options, &mut memory).unwrap();
    assert!((step.value - 0.5).abs() < 1e-12);
}

fn violation_of(c: &Constraint, step: &Step) -> f64 {
    -c.gap - c.normal.dot(&step.twist.velocity(&c.point))
}

#[test]
fn pushing_a_penetrating_pose_out() {
    // A unit cube 0.1 deep in the floor, and in a wall: out along both normals, without turning.
    let corners: Vec<Point3<f64>> =
        (0..8).map(|k| Point3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let contacts: Vec<Constraint> = corners
        .iter()
        .flat_map(|&point| {
            [(Vector3::z(), point.z), (Vector3::x(), point.x)]
                .into_iter()
                .filter(|c| c.1 == 0.0)
                .map(move |(normal, _)| Constraint { point, normal, gap: -0.1 })
        })
        .collect();
    let disp = Disp::new(&corners).unwrap();
    let cube = MassProperties {
        volume: 1.0,
        centre: Point3::new(0.5, 0.5, 0.5),
        inertia: Matrix3::from_diagonal_element(1.0 / 6.0),
    };
    let here = Isometry3::identity();
    let mut memory = StepMemory::new(8);
    for metric in [&disp as &dyn Metric, &Sigma::new(&cube)] {
        let step = metric.step(&here, &here, &contacts, &StepOptions::default(), &mut memory).unwrap();
        assert!(step.end == StepEnd::Optimal && (step.value - 0.02f64.sqrt()).abs() < 1e-6, "{step:?}");
        assert!((step.twist.linear - Vector3::new(0.1, 0.0, 0.1)).norm() < 1e-6 && step.twist.angular.norm() < 1e-6);
        let out = step.twist.applied(&here);
        assert!((metric.distance(&here, &out) - step.value).abs() < 1e-6);

        // A ceiling 0.05 too low: half of it is left above and below, and nothing else gets worse.
        let ceiling =
            corners.iter().filter(|p| p.z == 1.0).map(|&point| Constraint { point, normal: -Vector3::z(), gap: 0.05 });
        let both: Vec<Constraint> = contacts.iter().copied().chain(ceiling).collect();
        let mut memory = StepMemory::new(both.len());
        let step = metric.step(&here, &here, &both, &StepOptions::default(), &mut memory).unwrap();
        assert!(step.end == StepEnd::Infeasible && (step.violation - 0.025).abs() < 1e-6, "{step:?}");
        assert!(step.twist.linear.x > 0.07);

        // Deeper than the trust region: as far as it goes.
        let options = StepOptions { trust: 0.04, ..StepOptions::default() };
        let step = metric.step(&here, &here, &contacts, &options, &mut memory).unwrap();
        assert!(step.end == StepEnd::Infeasible && step.violation < 0.061, "{step:?}");
    }
}

#[test]
fn a_pose_that_is_reached_is_left_alone() {
    let mut dice = Dice::new(13);
    let mut memory = StepMemory::new(30);
    for _ in 0..100 {
        let p = problem(&mut dice, 20, 30, 1.0, 0.1);
        let disp = Disp::new(&p.vertices).unwrap();
        let sigma = solid(&mut dice, 1.0);
        for metric in [&disp as &dyn Metric, &sigma] {
            let step = metric.step(&p.at, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
            assert!(step.end == StepEnd::Optimal && step.value < 1e-14, "{step:?}");
            let away = near(&mut dice, &p.at, 1e-4, 1e-4);
            let step = metric.step(&p.at, &away, &[], &p.options, &mut memory).unwrap();
            assert!(step.end == StepEnd::Optimal && step.value < 1e-7, "{step:?}");
            assert!(metric.distance(&p.at, &step.twist.applied(&away)) < 1e-7);
        }
    }
}

/// Where the axes are unique, a step is the same motion whatever the frames of the world and of the mesh.
#[test]
fn steps_do_not_depend_on_frames() {
    let mut dice = Dice::new(18);
    let mut memory = StepMemory::new(30);
    for _ in 0..100 {
        let mut p = problem(&mut dice, 40, 30, 1.0, 0.05);
        p.options.tolerance = 1e-9;
        let (world, own) = (pose(&mut dice, 2.0), pose(&mut dice, 2.0));
        let back = own.inverse();
        let there = Problem {
            vertices: p.vertices.iter().map(|x| own * x).collect(),
            from: world * p.from * back,
            at: world * p.at * back,
            contacts: p
                .contacts
                .iter()
                .map(|c| Constraint { point: world * c.point, normal: world * c.normal, gap: c.gap })
                .collect(),
            options: p.options,
        };
        let mass = MassProperties {
            volume: 1.0,
            centre: Point3::new(0.1, 0.2, 0.3),
            inertia: Matrix3::from_diagonal(&Vector3::new(0.3, 0.4, 0.5)),
        };
        let turn = own.rotation.to_rotation_matrix().into_inner();
        let mass_there =
            MassProperties { centre: own * mass.centre, inertia: turn * mass.inertia * turn.transpose(), ..mass };
        let disps = [Disp::new(&p.vertices).unwrap(), Disp::new(&there.vertices).unwrap()];
        let sigmas = [Sigma::new(&mass), Sigma::new(&mass_there)];
        for [metric, other] in [[&disps[0] as &dyn Metric, &disps[1]], [&sigmas[0], &sigmas[1]]] {
            let step = metric.step(&p.from, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
            let image = other.step(&there.from, &there.at, &there.contacts, &there.options, &mut memory).unwrap();
            assert!((step.value - image.value).abs() < 1e-7, "{step:?} {image:?}");
            assert!((world * step.twist.about - image.twist.about).norm() < 1e-9);
        }
        let step = sigmas[0].step(&p.from, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
        let image = sigmas[1].step(&there.from, &there.at, &there.contacts, &there.options, &mut memory).unwrap();
        assert!((world * step.twist.linear - image.twist.linear).norm() < 1e-7);
        assert!((world * step.twist.angular - image.twist.angular).norm() < 1e-7);
    }
}

#[test]
fn bad_input_is_named() {
    let mut dice = Dice::new(14);
    let p = problem(&mut dice, 20, 3, 1.0, 0.1);
    let disp = Disp::new(&p.vertices).unwrap();
    let sigma = solid(&mut dice, 1.0);
    let mut memory = StepMemory::new(3);
    for metric in [&disp as &dyn Metric, &sigma] {
        let mut step = |at: &Isometry3<f64>, contacts: &[Constraint], options: &StepOptions| {
            metric.step(&p.from, at, contacts, options, &mut memory)
        };
        let more = [p.contacts.clone(), p.contacts.clone()].concat();
        assert_eq!(step(&p.at, &more, &p.options), Err(StepError::Capacity));
        let mut bad = p.contacts.clone();
        bad[2].normal.y = f64::NAN;
        assert_eq!(step(&p.at, &bad, &p.options), Err(StepError::Contact { index: 2 }));
        bad[1].gap = f64::INFINITY;
        assert_eq!(step(&p.at, &bad, &p.options), Err(StepError::Contact { index: 1 }));
        assert_eq!(step(&Isometry3::translation(0.0, f64::NAN, 0.0), &[], &p.options), Err(StepError::Pose));
        for trust in [0.0, -1.0, f64::NAN] {
            assert_eq!(step(&p.at, &[], &StepOptions { trust, ..p.options }), Err(StepError::Options));
        }
        assert_eq!(step(&p.at, &[], &StepOptions { tolerance: 0.0, ..p.options }), Err(StepError::Options));
        // A contact without a normal says nothing, or cannot be met.
        let none = Constraint { normal: Vector3::zeros(), ..p.contacts[0] };
        assert_eq!(step(&p.at, &[Constraint { gap: 0.0, ..none }], &p.options).unwrap().end, StepEnd::Optimal);
        let never = step(&p.at, &[Constraint { gap: -0.1, ..none }], &p.options).unwrap();
        assert!(never.end == StepEnd::Infeasible && (never.violation - 0.1).abs() < 1e-9);
    }
}

#[test]
fn twists_are_rigid_motions() {
    let mut dice = Dice::new(15);
    for _ in 0..50 {
        let at = pose(&mut dice, 1.0);
        let about = Point3::from(direction(&mut dice));
        let twist = Twist { linear: direction(&mut dice), angular: direction(&mut dice), about };
        let (x, y) = (Point3::from(direction(&mut dice)), Point3::from(direction(&mut dice)));
        let after = twist.applied(&at);
        assert!(((after * x - after * y).norm() - (x - y).norm()).abs() < 1e-14);
        let h = 1e-6;
        let moved = |h: f64| twist.scaled(h).applied(&at) * x;
        assert!(((moved(h) - moved(-h)) / (2.0 * h) - twist.velocity(&(at * x))).norm() < 1e-9);
    }
}

/// Counts the allocations of its thread.
struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

// SAFETY: the system's allocator does the work.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|n| n.set(n.get() + 1));
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn steps_and_distances_do_not_allocate() {
    let mut dice = Dice::new(16);
    let mut memory = StepMemory::new(100);
    for run in 0..50 {
        let mut p = problem(&mut dice, 300, 100, 1.0, 0.05);
        if run % 2 == 0 {
            p.contacts.iter_mut().for_each(|c| c.gap -= 0.2);
        }
        let (disp, sigma) = (Disp::new(&p.vertices).unwrap(), solid(&mut dice, 1.0));
        let before = ALLOCATIONS.with(Cell::get);
        for metric in [&disp as &dyn Metric, &sigma] {
            let step = metric.step(&p.from, &p.at, &p.contacts, &p.options, &mut memory);
            let length = metric.distance(&p.from, &p.at);
            assert!(step.is_ok() && length > 0.0);
        }
        assert_eq!(ALLOCATIONS.with(Cell::get), before);
    }
}

/// Contacts as they come: few normals, on both sides, flat on a face, hardly apart, and a body that may be a plate or a needle.
#[test]
fn degenerate_contacts_are_solved_to_the_tolerance() {
    let mut dice = Dice::new(17);
    let mut memory = StepMemory::new(300);
    let (mut runs, mut programs, mut open, mut infeasible) = (0, 0, 0, 0);
    for run in 0..3000 {
        let thin = dice.pick(&[1.0, 1e-2, 1e-3]);
        let axes = Vector3::new(1.0, if dice.chance(0.5) { 1.0 } else { thin }, thin);
        let corners = dice.pick(&[8, 30, 300]);
        let boxed = dice.chance(0.4);
        let vertices: Vec<Point3<f64>> = (0..corners)
            .map(|k| {
                let bit = |b: usize| if k >> b & 1 == 1 { 1.0 } else { -1.0 };
                let unit = if boxed { Vector3::new(bit(0), bit(1), bit(2)) } else { direction(&mut dice) };
                Point3::from(unit.component_mul(&axes))
            })
            .collect();
        let from = if dice.chance(0.3) { Isometry3::identity() } else { pose(&mut dice, 1.0) };
        let angle = dice.pick(&[0.3, 3.0, 1e-6, 0.0]) * dice.unit();
        let length = 0.2 * dice.unit();
        let at = near(&mut dice, &from, length, angle);
        let normals = [0; 3].map(|_| direction(&mut dice));
        let small = dice.pick(&[0.0, 1e-12, 1e-9, 1e-3]);
        let count = dice.pick(&[1, 5, 20, 100, 300]);
        let contacts: Vec<Constraint> = (0..count)
            .map(|k| {
                let point = at * vertices[dice.below(corners)];
                let side = if k % 2 == 0 { 1.0 } else { -1.0 };
                let tilt = direction(&mut dice) * dice.decade(-12.0, 0.0);
                let (normal, gap) = match run % 5 {
                    0 => (dice.pick(&normals) * side, small * dice.unit()),
                    1 => (Vector3::ith(dice.below(3), side), 0.0),
                    2 => (Vector3::z(), -0.05),
                    3 => ((normals[0] + tilt).normalize(), 0.01 * dice.signed()),
                    _ => (direction(&mut dice), small * dice.signed()),
                };
                Constraint { point, normal, gap }
            })
            .collect();
        let trust = dice.pick(&[f64::INFINITY, 0.05, 1e-3]);
        let p = Problem { vertices, from, at, contacts, options: StepOptions { trust, tolerance: 1e-4 } };
        let disp = Disp::new(&p.vertices).unwrap();
        let step = disp.step(&p.from, &p.at, &p.contacts, &p.options, &mut memory).unwrap();
        let left = violation(&p, &step);
        assert!((moved(&p, &step) - step.value).abs() < 1e-10, "run {run}: {step:?}");
        runs += 1;
        programs += step.programs;
        assert!((left - step.violation).abs() < 1e-12, "run {run}: {left} {step:?}");
        assert!(step.end == StepEnd::Infeasible || left < 1e-10 / thin, "run {run}: {left} {step:?}");
        infeasible += usize::from(step.end == StepEnd::Infeasible);
        open += usize::from(step.end == StepEnd::Limit);
        assert!(step.lower <= step.value * (1.0 + 1e-9) && step.value.is_finite());
    }
    // A curved valley once took 40 programs.
    assert!(
        programs < 6 * runs && open <= 3,
        "{programs} programs in {runs} steps, {open} not closed, {infeasible} infeasible"
    );
    assert!(infeasible > 100 && infeasible < runs / 3);
}
