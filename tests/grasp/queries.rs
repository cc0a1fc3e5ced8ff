//! Yes-no questions and batches: force closure against an independent convex solver, the best of many grasps against asking for each.
use crate::common;
use crate::grasp_common;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use common::dice::Dice;
use grasp_common::{contact_map, radii, recorded, value, vector, wide};
use nalgebra::SMatrix;
use qdist::grasp::{Closure, Contact, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{Failure, Support};
use qdist::{Options, Real, Vector, Workspace};

type Memory<T> = Workspace<T, 6, 128, 1024>;

fn frame<T: Real>() -> WrenchFrame<T> {
    WrenchFrame::new(Vector::zeros(), T::one()).unwrap()
}

fn primitives<T: Real>(contacts: &[Contact<T>]) -> Vec<Primitive<T>> {
    let mut memory = vec![Primitive::empty(); contacts.len()];
    wrenches(contacts, &frame(), &mut memory).unwrap().to_vec()
}

fn closure<T: Real>(contacts: &[Contact<T>], norm: Norm) -> Closure<T> {
    let primitives = primitives(contacts);
    Memory::<T>::new().solver().force_closure(&WrenchSet::new(&primitives, norm), &Options::default())
}

/// Contacts around the unit ball, normals up to 45 degrees off.
fn contacts<T: Real>(dice: &mut Dice, count: usize) -> Vec<Contact<T>> {
    let kind = dice.below(4);
    (0..count)
        .map(|_| {
            let p = Vector::from(dice.direction::<3>());
            let n = (-p + Vector::from(dice.direction::<3>()) * 0.7).normalize();
            let (mu, mus) = (T::of(0.2 + 0.8 * dice.unit()), T::of(0.1 + 0.4 * dice.unit()));
            let friction = match if kind == 3 { dice.below(3) } else { kind } {
                0 => Friction::Frictionless,
                1 => Friction::Hard { mu },
                _ => Friction::Soft { mu, mus },
            };
            Contact::new(vector(p.into()), vector(n.into()), friction).unwrap()
        })
        .collect()
}

/// The largest t such that contact forces of sum 1 are in equilibrium and every one is t inside its cone; above 0 for a force-closed
/// grasp whose contact maps span R^6 (Murray, Li, Sastry, Proposition 5.4): the second value, their least singular value, is not 0. `None` when Clarabel
/// gives up.
fn equilibrium<T: Real>(contacts: &[Contact<T>]) -> Option<(f64, f64)> {
    let m = contacts.len();
    let columns = 4 * m + 1;
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut right = Vec::new();
    let maps: Vec<_> = contacts.iter().map(|c| contact_map(c, &frame())).collect();
    let friction: Vec<_> = contacts.iter().map(|c| radii(c, &frame())).collect();
    // Zero: G f = 0, sum f1 = 1, and components without friction.
    for i in 0..6 {
        let mut row = vec![0.0; columns];
        maps.iter().enumerate().for_each(|(c, map)| (0..4).for_each(|k| row[4 * c + k] = map[k][i]));
        rows.push(row);
        right.push(0.0);
    }
    let mut row = vec![0.0; columns];
    (0..m).for_each(|c| row[4 * c] = 1.0);
    rows.push(row);
    right.push(1.0);
    for c in 0..m {
        for k in (0..3).filter(|&k| friction[c][k] == 0.0) {
            let mut row = vec![0.0; columns];
            row[4 * c + k + 1] = 1.0;
            rows.push(row);
            right.push(0.0);
        }
    }
    let mut cones = vec![SupportedConeT::ZeroConeT(rows.len())];
    // |f2 / mu, f3 / mu, f4 / mus| <= f1 - t.
    for c in 0..m {
        let mut row = vec![0.0; columns];
        (row[4 * c], row[4 * m]) = (-1.0, 1.0);
        rows.push(row);
        let used: Vec<usize> = (0..3).filter(|&k| friction[c][k] > 0.0).collect();
        for &k in &used {
            let mut row = vec![0.0; columns];
            row[4 * c + k + 1] = -1.0 / friction[c][k];
            rows.push(row);
        }
        right.extend(vec![0.0; 1 + used.len()]);
        cones.push(match used.len() {
            0 => SupportedConeT::NonnegativeConeT(1),
            n => SupportedConeT::SecondOrderConeT(1 + n),
        });
    }
    let mut cost = vec![0.0; columns];
    cost[4 * m] = -1.0;
    let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
    let a = CscMatrix::from(&rows);
    let mut solver =
        DefaultSolver::new(&CscMatrix::zeros((columns, columns)), &cost, &a, &right, &cones, settings).unwrap();
    solver.solve();
    let t = match solver.solution.status {
        SolverStatus::Solved | SolverStatus::AlmostSolved => -solver.solution.obj_val,
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => -1.0,
        _ => return None,
    };
    let mut all = SMatrix::<f64, 32, 6>::zeros();
    for c in 0..m {
        for k in (0..4).filter(|&k| k == 0 || friction[c][k - 1] > 0.0) {
            all.set_row(4 * c + k, &maps[c][k].transpose());
        }
    }
    Some((t, all.singular_values().min()))
}

/// Every verdict is right, and comes with its proof.
fn verdicts<T: Real>(rounding: f64) {
    let (mut dice, mut closed, mut open) = (Dice::new(41), 0, 0);
    for case in 0..300 {
        let count = 1 + dice.below(8);
        let contacts = contacts::<T>(&mut dice, count);
        let Some((t, least)) = equilibrium(&contacts) else { continue };
        let full = least > 1e-6;
        let norm = if case % 2 == 0 { Norm::L1 } else { Norm::LInf };
        let height = |u: &Vector<f64, 6>| contacts.iter().map(|c| value(c, &frame(), u).max(0.0)).sum::<f64>();
        match closure(&contacts, norm) {
            Closure::Closed { radius } => {
                assert!(radius > T::zero() && full && t > 0.0, "{case}: said to be closed, t = {t:e}");
                for _ in 0..100 {
                    let u = Vector::<f64, 6>::from(dice.direction::<6>());
                    assert!(height(&u) >= radius.to_f64() * (1.0 - rounding), "{case}");
                }
                closed += 1;
            }
            Closure::Open { direction } => {
                assert!(t < rounding || !full, "{case}: said to be open, t = {t:e}");
                let u = wide(&direction);
                assert!(height(&u) <= rounding, "{case}: {:e} along what separates", height(&u));
                open += 1;
            }
            Closure::Undecided { .. } => assert!(t.abs() < rounding, "{case}: undecided, t = {t:e}"),
        }
    }
    assert!(closed > 80 && open > 80, "{closed} closed, {open} open");
}

#[test]
fn force_closure_is_decided_right_f64() {
    verdicts::<f64>(1e-7);
}

#[test]
fn force_closure_is_decided_right_f32() {
    verdicts::<f32>(1e-3);
}

/// Two fingertips on a line, a cube without friction, no contacts, contacts that all push to one side, a hair from closure.
#[test]
fn force_closure_at_its_limits() {
    let touch = |p: [f64; 3], n: [f64; 3], friction| Contact::new(Vector::from(p), Vector::from(n), friction).unwrap();
    let pair = |friction| [1.0, -1.0].map(|x| touch([x, 0.0, 0.0], [-x, 0.0, 0.0], friction));
    for norm in [Norm::L1, Norm::LInf] {
        assert!(closure(&pair(Friction::Soft { mu: 0.5, mus: 1e-6 }), norm).is_closed());
        let separated = |contacts: &[Contact<f64>]| match closure(contacts, norm) {
            Closure::Open { direction } => Some(direction),
            _ => None,
        };
        let spin = separated(&pair(Friction::Hard { mu: 0.5 })).unwrap();
        assert!(spin[3].abs() > 1.0 - 1e-9, "{spin}");
        assert!(separated(&pair(Friction::Frictionless)).is_some());
        assert!(separated(&[]).is_some());
        let soft = Friction::Soft { mu: 0.5, mus: 0.5 };
        assert!(separated(&[touch([0.0; 3], [0.0, 0.0, 1.0], soft)]).is_some());
        let hands = [-1.0, 0.0, 1.0].map(|x| touch([x, 0.0, 0.0], [0.0, 0.0, 1.0], soft));
        assert!(separated(&hands).unwrap()[2] < 0.0);
        // Contacts on one line through the object whose cones just do not see each other: atan(0.5) is 26.6 degrees.
        for (angle, is_closed) in [(0.4636f64, true), (0.4637, false)] {
            let tilted = |x: f64| touch([x, 0.0, 0.0], [-x * angle.cos(), angle.sin(), 0.0], soft);
            assert_eq!(closure(&[tilted(1.0), tilted(-1.0)], norm).is_closed(), is_closed, "{angle}");
        }
    }
}

/// Little spin friction is closure, in `f32` down to 1e-4 of the largest wrench.
#[test]
fn little_spin_friction_closes_in_single_precision() {
    let cube = |m: usize, mus: f32| -> Vec<Contact<f32>> {
        let tip = |i: usize| {
            let x = if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let soft = Friction::Soft { mu: 0.5, mus };
            Contact::new(Vector::from([x, 0.0, 0.0]), Vector::from([-x, 0.0, 0.0]), soft).unwrap()
        };
        (0..m).map(tip).collect()
    };
    for norm in [Norm::L1, Norm::LInf] {
        for m in [2, 6, 12] {
            assert!(closure(&cube(m, 2e-4), norm).is_closed(), "{m} {norm:?}");
            assert!(!closure(&cube(m, 0.0), norm).is_closed(), "{m} {norm:?}");
        }
    }
}

#[test]
#[ignore = "needs ../shared/data"]
fn recorded_grasps_are_closed_or_not_as_their_references_say() {
    let grasps = recorded();
    let mut told = 0;
    for grasp in &grasps {
        let point = |c: &serde_json::Value, key: &str| Vector::from_fn(|i, _| c[key][i].as_f64().unwrap());
        let contacts: Vec<Contact<f64>> = grasp["contacts"]
            .as_array()
            .unwrap()
            .iter()
            .map(|c| {
                let number = |key: &str| c[key].as_f64().unwrap_or(0.0);
                let friction = match c["type"].as_str().unwrap() {
                    "soft" => Friction::Soft { mu: number("mu"), mus: number("mus") },
                    "hard" => Friction::Hard { mu: number("mu") },
                    _ => Friction::Frictionless,
                };
                Contact::new(point(c, "p"), point(c, "n"), friction).unwrap()
            })
            .collect();
        for r in grasp["refs"].as_array().unwrap().iter().filter(|r| r["set"] == "W" && r["force_closure"].is_boolean())
        {
            let norm = if r["norm"] == "L1" { Norm::L1 } else { Norm::LInf };
            assert_eq!(closure(&contacts, norm).is_closed(), r["force_closure"].as_bool().unwrap(), "{}", grasp["id"]);
            told += 1;
        }
    }
    assert!(told > 10);
}

/// Contacts of the kinds that are closed or open by little: rings, opposed and collinear ones, cones that just see each other, any. Numbers of
/// `f32`, so that both formats have the same.
fn near_the_boundary(dice: &mut Dice) -> Vec<Contact<f32>> {
    let count = 2 + dice.below(4);
    let mu = dice.decade(-3.0, 0.0);
    let family = dice.below(6);
    let turn = if dice.chance(0.5) { SMatrix::identity() } else { SMatrix::<f64, 3, 3>::from(dice.rotation::<3>()) };
    let jitter = dice.pick(&[0.0, 1e-9, 1e-6, 1e-4, 1e-2]);
    let sign = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
    (0..count)
        .map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / count as f64;
            let (p, n) = match family {
                0 => ([angle.cos(), angle.sin(), 0.0], [-angle.cos(), -angle.sin(), 0.0]),
                1 => ([sign(k), 0.0, 0.0], [-sign(k), 0.0, 0.0]),
                2 => ([2.0 * k as f64 / (count - 1) as f64 - 1.0, 0.0, 0.0], [0.0, sign(k), 0.0]),
                3 => {
                    let p = dice.direction::<3>();
                    (p, (Vector::from(dice.direction::<3>()) * 0.5 - Vector::from(p)).into())
                }
                4 => {
                    let p = dice.direction::<3>();
                    (p, p.map(|x| -x))
                }
                _ => {
                    let tilt = mu.atan() + mu * dice.pick(&[-1e-2, -1e-5, -1e-7, 0.0, 1e-7, 1e-5, 1e-2]);
                    ([sign(k), 0.0, 0.0], [-sign(k) * tilt.cos(), tilt.sin(), 0.0])
                }
            };
            let mut moved = |v: [f64; 3]| turn * Vector::from(v) + Vector::from(dice.direction::<3>()) * jitter;
            let (p, n) = (moved(p), moved(n).normalize());
            let mus = (0.1 * mu) as f32;
            let friction = match dice.below(5) {
                0 if family != 1 && family != 5 => Friction::Frictionless,
                0..3 => Friction::Hard { mu: mu as f32 },
                _ => Friction::Soft { mu: mu as f32, mus },
            };
            Contact::new(vector(p.into()), vector(n.into()), friction).unwrap()
        })
        .collect()
}

fn widened(contacts: &[Contact<f32>]) -> Vec<Contact<f64>> {
    let wider = |c: &Contact<f32>| {
        let friction = match c.friction() {
            Friction::Frictionless => Friction::Frictionless,
            Friction::Hard { mu } => Friction::Hard { mu: mu.into() },
            Friction::Soft { mu, mus } => Friction::Soft { mu: mu.into(), mus: mus.into() },
        };
        let [o, t] = c.tangents().map(|v| wide(&v));
        // The same numbers, as far as unit vectors of `f32` are some in `f64`.
        Contact::new(wide(c.position()), wide(c.normal()), friction).and_then(|c| c.with_tangents(o, t)).unwrap()
    };
    contacts.iter().map(wider).collect()
}

/// What is known about closure in one format, at one torque scale, and whether `solve` proves it.
fn asked<T: Real>(contacts: &[Contact<T>], scale: f64, norm: Norm) -> (Closure<T>, bool, f64) {
    let frame = WrenchFrame::new(Vector::zeros(), T::of(scale)).unwrap();
    let mut memory = vec![Primitive::empty(); contacts.len()];
    let set = WrenchSet::new(wrenches(contacts, &frame, &mut memory).unwrap(), norm);
    let mut workspace = Box::new(Workspace::<T, 6, 128, 2048>::new());
    let closure = workspace.solver().force_closure(&set, &Options::default());
    let options = Options { threshold: Some(T::TINY), max_iterations: Some(200), ..Options::default() };
    let solved = workspace.solver().solve(&set, &Ball::unit(), &options);
    let along = match closure {
        Closure::Open { direction } => {
            // Row by row, as the module promises: in units of the terms' rounding.
            let own = set.errors();
            let scaled = (0..6).fold(0.0, |s, i| s + direction[i].abs().to_f64() * own[i].to_f64());
            let heights = contacts.iter().map(|c| value(c, &frame, &wide(&direction)).max(0.0));
            let height = if norm == Norm::L1 { heights.fold(0.0, f64::max) } else { heights.sum() };
            height / scaled.max(f64::MIN_POSITIVE)
        }
        _ => 0.0,
    };
    (closure, solved.lower > T::zero(), along)
}

/// Closed is said of closed grasps only, open of none that `solve` proves to be closed, and neither of few. Truth: double precision, and there
/// an independent convex solver.
#[test]
fn three_answers_near_the_boundary() {
    let mut dice = Dice::new(46);
    let (mut counts, mut judged, mut doubtful) = ([0; 3], 0, 0);
    for case in 0..600 {
        let contacts = near_the_boundary(&mut dice);
        let twins = widened(&contacts);
        let norm = if dice.chance(0.5) { Norm::L1 } else { Norm::LInf };
        let scale = f64::from(dice.decade(-6.0, 6.0) as f32);
        let (single, single_solves, single_height) = asked(&contacts, scale, norm);
        let (double, double_solves, double_height) = asked(&twins, scale, norm);
        let what = format!("{case} at {scale:e}, {norm:?}: {single:?} {double:?}");
        assert!(!(single.is_open() && single_solves || double.is_open() && double_solves), "{what}");
        assert!(!single_solves || single.is_closed(), "{what}");
        assert!(!(single.is_closed() && double.is_open()), "{what}");
        assert!(single_height <= 1.6 && double_height <= 1.6, "{what}: {single_height} {double_height}");
        if let Some((t, least)) = equilibrium(&twins) {
            // Clarabel is right to 1e-8 of forces over friction; it does not see that forces a hair off a line are in no equilibrium.
            assert!(!double.is_closed() || (least > 1e-15 && t > -1e-5), "{what}: {t:e} {least:e}");
            assert!(!double.is_open() || least < 1e-6 || t < 1e-5, "{what}: {t:e} {least:e}");
            judged += 1;
        }
        let code = |open: bool, closed: bool| if closed { 0 } else { 1 + usize::from(!open) };
        counts[code(single.is_open(), single.is_closed())] += 1;
        doubtful += code(double.is_open(), double.is_closed()) / 2;
    }
    println!("single precision: {counts:?} closed, open, undecided; double: {doubtful} undecided; {judged} judged");
    assert!(counts[0] > 150 && counts[1] > 150 && counts[2] < 30 && doubtful < 20 && judged > 300);
}

/// Three hard fingertips on a ring, little friction, moments a thousand times too large: d is 0.01, and closure does not depend on the scale.
#[test]
fn a_ring_with_little_friction_is_closed_at_any_torque_scale() {
    let ring = |mu: f64| -> Vec<Contact<f32>> {
        let tip = |k: i32| {
            let (y, x) = (std::f64::consts::TAU / 3.0 * f64::from(k)).sin_cos();
            let hard = Friction::Hard { mu: mu as f32 };
            Contact::new(vector([x, y, 0.0]), vector([-x, -y, 0.0]), hard).unwrap()
        };
        (0..3).map(tip).collect()
    };
    for norm in [Norm::L1, Norm::LInf] {
        for power in -6..=6 {
            let scale = 10f64.powi(power);
            for mu in [1e-2, 1e-3] {
                assert!(asked(&ring(mu), scale, norm).0.is_closed(), "{mu} {scale}");
                assert!(asked(&widened(&ring(mu)), scale, norm).0.is_closed(), "{mu} {scale}");
            }
            assert!(asked(&ring(0.0), scale, norm).0.is_open(), "{scale}");
        }
        // d itself, as its bracket in double precision says.
        let frame = WrenchFrame::new(Vector::zeros(), 1e-3).unwrap();
        let mut memory = [Primitive::empty(); 3];
        let contacts = widened(&ring(1e-2));
        let set = WrenchSet::new(wrenches(&contacts, &frame, &mut memory).unwrap(), Norm::L1);
        let mut workspace = Box::new(Workspace::<f64, 6, 128, 2048>::new());
        let d = workspace.solver().solve(&set, &Ball::unit(), &Options { relative: 1e-2, ..Options::default() });
        assert!(d.lower <= 0.0101 && 0.0099 <= d.upper && d.lower > 0.0, "{} {}", d.lower, d.upper);
    }
}

/// Sets that know nothing of their rounding: none is taken for open or closed that is not.
#[test]
fn closure_of_sets_of_the_callers_own() {
    struct Cross<const SIDES: usize>(f64);
    impl<const SIDES: usize> Support<f64, 6> for Cross<SIDES> {
        fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
            let (i, x) = (u.iamax(), u[u.iamax()]);
            let one_sided = i >= SIDES && x < 0.0;
            Ok(Vector::from_fn(|j, _| if j == i && !one_sided { self.0 * x.signum() } else { 0.0 }))
        }
    }
    for size in [1e-100, 1e-3, 1.0, 1e100] {
        let ask = |set: &dyn Support<f64, 6>| Memory::new().solver().force_closure(set, &Options::default());
        assert!(ask(&Cross::<6>(size)).is_closed(), "{size}");
        assert!(!ask(&Cross::<5>(size)).is_closed(), "{size}");
    }
}

/// A set whose support function gives up.
struct Broken;

impl Support<f64, 6> for Broken {
    fn support(&self, _: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        Err(Failure(7))
    }
}

#[test]
fn a_failing_support_function_leaves_closure_undecided() {
    let closure = Memory::new().solver().force_closure(&Broken, &Options::default());
    assert!(matches!(closure, Closure::Undecided { .. }));
}

#[test]
fn the_best_of_a_batch_is_the_best_of_its_answers() {
    let mut dice = Dice::new(43);
    let grasps: Vec<Vec<Primitive<f64>>> = (0..60).map(|_| primitives(&contacts::<f64>(&mut dice, 4))).collect();
    let mut memory = Workspace::<f64, 6, 128, 2048>::new();
    let options = Options { relative: 1e-3, absolute: 1e-6, ..Options::default() };
    let q = Ball::unit();
    for norm in [Norm::L1, Norm::LInf] {
        let sets = || grasps.iter().map(|g| WrenchSet::new(g, norm));
        let mut answers = Vec::new();
        memory.solver().solve_each(sets(), &q, &options, |index, answer| {
            assert_eq!(index, answers.len());
            answers.push(answer);
            false
        });
        assert_eq!(answers.len(), grasps.len());
        let best = memory.solver().best_of(sets(), &q, &options).unwrap();
        let deepest = answers.iter().map(|a| a.lower).fold(0.0, f64::max);
        assert!(best.ceiling >= best.answer.upper && best.ceiling >= deepest);
        assert!(best.answer.lower >= deepest * (1.0 - 2e-3), "{} against {deepest}", best.answer.lower);
        let own = &answers[best.index];
        assert!(own.lower <= best.answer.upper && best.answer.lower <= own.upper);
    }
    let none: [WrenchSet<'_, f64>; 0] = [];
    assert!(memory.solver().best_of(none, &q, &options).is_none());
    let mut asked = 0;
    memory.solver().solve_each(grasps.iter().map(|g| WrenchSet::new(g, Norm::L1)), &q, &options, |_, _| {
        asked += 1;
        asked >= 3
    });
    assert_eq!(asked, 3);
}

/// The weakest wrench is in Q times the upper bound, and W's support function proves that no more is possible along its normal.
#[test]
fn the_weakest_wrench_touches_the_boundary() {
    let mut dice = Dice::new(44);
    let axes = Vector::from([1.0, 2.0, 0.5, 1.0, 0.2, 3.0]);
    let units: [Box<dyn UnitSet<f64, 6>>; 5] = [
        Box::new(Ball::unit()),
        Box::new(UnitEllipsoid::new(axes, SMatrix::identity()).unwrap()),
        Box::new(UnitBox::new(axes).unwrap()),
        Box::new(CrossPolytope::new(axes).unwrap()),
        Box::new(Segment::new(axes).unwrap()),
    ];
    let mut memory = Workspace::<f64, 6, 128, 2048>::new();
    let mut asked = 0;
    while asked < 20 {
        let primitives = primitives(&contacts::<f64>(&mut dice, 5));
        let set = WrenchSet::new(&primitives, Norm::LInf);
        for q in &units {
            let answer = memory.solver().solve(&set, q.as_ref(), &Options { relative: 1e-3, ..Options::default() });
            if !(answer.lower > 0.0) {
                continue;
            }
            asked += 1;
            let wrench = answer.weakest(q.as_ref()).unwrap();
            let u = answer.direction;
            assert!((u.dot(&wrench) - set.value(&u)).abs() <= 1e-9 * set.extent());
            assert_eq!(answer.is_at_least(answer.lower), Some(true));
            assert_eq!(answer.is_at_least(answer.upper * 1.001), Some(false));
            if answer.lower < answer.upper {
                assert_eq!(answer.is_at_least(answer.upper), None);
            }
            // The solver's other question: can the grasp exert it?
            let ray = memory.solver().solve(&set, &Segment::new(wrench).unwrap(), &Options::default());
            assert!(ray.lower <= 1.0 + 1e-6 && ray.upper >= 1.0 - 2e-3, "{} {}", ray.lower, ray.upper);
        }
    }
}
