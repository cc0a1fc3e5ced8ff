//! The steps of the mesh layer against Clarabel, an interior point solver, and against the conditions of optimality.
#![cfg(feature = "mesh")]

mod common;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus, SupportedConeT,
};
use common::dice::Dice;
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3, Vector6};
use qdist::mesh::mass::MassProperties;
use qdist::mesh::metric::{Disp, Metric, Sigma};
use qdist::mesh::optimize::{Contact, Step, StepEnd, StepError, StepMemory, StepOptions};

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
    contacts: Vec<Contact>,
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
    let mut list: Vec<Contact> = Vec::new();
    for _ in 0..contacts {
        let point = at * vertices[dice.below(corners)];
        let mut contact = Contact {
            point,
            normal: direction(dice),
            gap: if dice.chance(0.3) { 0.0 } else { dice.range(0.0, 0.1) * scale },
        };
        if let Some(&last) = list.last() {
            if dice.chance(0.1) {
                contact = last;
            } else if dice.chance(0.2) {
                let tilt = direction(dice) * dice.decade(-14.0, -2.0);
                contact = Contact { normal: (last.normal + tilt).normalize(), ..last };
            }
        }
        list.push(contact);
    }
    Problem { vertices, from, at, contacts: list, options: StepOptions { trust: trust * scale, tolerance: 1e-6 } }
}

/// a.x >= b for the twist x = (linear, radius angular) about a point, in the world's axes.
fn rows(problem: &Problem, metric: &dyn Metric) -> (Vec<(Vector6<f64>, f64)>, Vec<(Vector6<f64>, f64)>) {
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
    let one = |c: &Contact| -c.gap - c.normal.dot(&step.twist.velocity(&c.point));
    problem.contacts.iter().map(one).fold(0.0, f64::max)
}

#[test]
fn displacement_steps_agree_with_a_cone_solver() {
    let mut dice = Dice::new(11);
    let mut memory = StepMemory::new(100);
    let (mut programs, mut runs, mut most) = (0, 0, 0);
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
            println!("run {run}: the oracle failed");
            continue;
        }
        let (value, lower) = (step.value / scale, step.lower / scale);
        let tell = format!(
            "run {run}: {corners} corners, {contacts} contacts, {value} >= {} >= {lower}, {:?} {}",
            oracle.value, step.end, step.programs
        );
        println!("{tell}");
        let slack = 1e-8;
        assert!(value >= oracle.value - slack && lower <= oracle.value + slack, "{tell}");
        assert!(step.end == StepEnd::Optimal && value <= oracle.value * (1.0 + 2e-6) + slack, "{tell}");
        programs += step.programs;
        most = most.max(step.programs);
        runs += 1;
    }
    println!("{runs} runs, {programs} programs, at most {most}");
    assert!(runs > 140);
}
