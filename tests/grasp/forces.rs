//! Contact forces of least size: against an independent convex solver, closed forms and the references of the shared data; the
//! optimality conditions one by one; palms, flat sets, wrenches that nothing resists.
use crate::common;
use crate::grasp_common;

use clarabel::solver::{DefaultSettings, SolverStatus};
use common::dice::Dice;
use grasp_common::socp::LeastForces;
use grasp_common::{contact_map, radii, random_contact, recorded, value, vector, wide};
use qdist::grasp::{
    Contact, Contribution, ForceError, ForceOptions, ForceOutcome, ForceSolver, Forces, Friction, Norm, Primitive,
    WrenchFrame, WrenchSet, wrenches,
};
use qdist::support::{Failure, Support};
use qdist::{Real, Vector};

const NORMS: [Norm; 2] = [Norm::L1, Norm::LInf];

/// The least size by Clarabel: (primal, dual) objective, `None` when it says that there is none.
fn reference(
    contacts: &[Contact<f64>],
    frame: &WrenchFrame<f64>,
    norm: Norm,
    external: &Vector<f64, 6>,
) -> Option<(f64, f64)> {
    let program = LeastForces::new(contacts, frame, norm, external);
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: 1e-13,
        tol_gap_rel: 1e-12,
        tol_feas: 1e-12,
        ..DefaultSettings::default()
    };
    let solver = program.solved(settings);
    let found = &solver.solution;
    match found.status {
        SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => None,
        SolverStatus::Solved | SolverStatus::AlmostSolved => {
            Some((found.obj_val * program.unit, found.obj_val_dual * program.unit))
        }
        // It gives up.
        _ => Some((f64::NAN, f64::NAN)),
    }
}

/// What one search gave: its answer and the shares.
struct Found<T> {
    forces: Forces<T>,
    shares: Vec<Vector<T, 6>>,
}

fn primitives<T: Real>(contacts: &[Contact<T>], frame: &WrenchFrame<T>) -> Vec<Primitive<T>> {
    let mut memory = vec![Primitive::empty(); contacts.len()];
    wrenches(contacts, frame, &mut memory).unwrap();
    memory
}

/// Forces against `external`, checked by their definition: equilibrium, friction, size; and the direction by what it proves.
fn resist<T: Real>(contacts: &[Contact<T>], frame: &WrenchFrame<T>, norm: Norm, external: &Vector<T, 6>) -> Found<T> {
    resist_with(&mut ForceSolver::new(), contacts, frame, norm, external)
}

fn resist_with<T: Real>(
    solver: &mut ForceSolver<T>,
    contacts: &[Contact<T>],
    frame: &WrenchFrame<T>,
    norm: Norm,
    external: &Vector<T, 6>,
) -> Found<T> {
    let primitives = primitives(contacts, frame);
    let set = WrenchSet::new(&primitives, norm);
    let mut shares = vec![Vector::zeros(); contacts.len()];
    let forces = solver.resist(&set, external, &ForceOptions::default(), &mut shares).unwrap();
    let found = Found { forces, shares };
    check(&found, contacts, frame, norm, external);
    found
}

fn check<T: Real>(
    found: &Found<T>,
    contacts: &[Contact<T>],
    frame: &WrenchFrame<T>,
    norm: Norm,
    external: &Vector<T, 6>,
) {
    let Found { forces, shares } = found;
    let (lower, upper) = (forces.lower.to_f64(), forces.upper.to_f64());
    let u = T::ROUNDOFF.to_f64();
    let wrench = -wide(external);
    let size = wrench.norm();
    assert!(0.0 <= lower && lower <= upper && forces.residual.finite(), "{forces:?}");
    // The residual is what it says, to rounding.
    let sum: Vector<f64, 6> = shares.iter().map(wide).sum();
    let largest = shares.iter().map(|s| wide(s).norm()).sum::<f64>();
    assert!(
        ((sum - wrench).norm() - forces.residual.to_f64()).abs()
            <= 8.0 * u * (shares.len() as f64 + 4.0) * (largest + size)
    );
    // The forces: exactly those of the shares, in their cones, and not larger than `upper`.
    let mut total = 0.0f64;
    for (contact, share) in contacts.iter().zip(shares) {
        let f = wide(&frame.contact_force(contact, share));
        let (mu, mus) = contact.friction().coefficients();
        let (mu, mus) = (mu.to_f64(), mus.to_f64());
        let used = |f: f64, r: f64| if f == 0.0 { 0.0 } else { f / r };
        let friction = used(f[1], mu).hypot(used(f[2], mu)).hypot(used(f[3], mus));
        assert!(f[0] >= 0.0 && friction <= f[0] * (1.0 + 1e4 * u), "{f} {contact:?}");
        let map = contact_map(contact, frame);
        let scale = frame.torque_scale().to_f64();
        let back = map[0] * f[0] + map[1] * f[1] + map[2] * f[2] + map[3] * (f[3] / scale);
        let rough = map.iter().map(|c| c.norm()).fold(0.0, f64::max) * (f.norm() + f[3].abs() / scale);
        // A share is a sum of forces up to the friction of the largest.
        let rough = rough + upper.min(1e30) * map[0].norm() * contact.force_cap().to_f64() * (1.0 + mu);
        assert!((back - wide(share)).norm() <= 1e5 * u * rough + 1e-300, "{back} {share}");
        let cap = contact.force_cap().to_f64();
        let part = if cap > 0.0 { f[0] / cap } else { 0.0 };
        // A large tangential force hides the rounding of a small normal force.
        let part = part - 1e3 * u * if cap > 0.0 { f.norm() / cap } else { 0.0 };
        total = if norm == Norm::L1 { total + part } else { total.max(part) };
    }
    if forces.upper < T::HUGE {
        assert!(total <= upper * (1.0 + 1e3 * u), "{total} {upper}");
    } else {
        assert!(shares.iter().flat_map(|s| s.iter()).all(|x| *x == T::zero()));
    }
    // The direction: u.w >= lower h(u), with the paper's formula for h.
    let direction = wide(&forces.direction);
    if size > 0.0 {
        assert!((direction.norm() - 1.0).abs() < 8.0 * u);
        let heights: Vec<f64> = contacts.iter().map(|c| value(c, frame, &direction).max(0.0)).collect();
        let height = if norm == Norm::L1 { heights.iter().copied().fold(0.0, f64::max) } else { heights.iter().sum() };
        let along = if forces.upper < T::HUGE { direction.dot(&sum) } else { direction.dot(&wrench) };
        assert!(along > 0.0 || lower == 0.0);
        if u < 1e-10 {
            let noise: f64 = contacts
                .iter()
                .map(|c| contact_map(c, frame).iter().map(|g| g.norm()).sum::<f64>() * c.force_cap().to_f64())
                .sum();
            assert!(
                lower >= T::HUGE.to_f64() && height <= 1e-15 * noise
                    || lower * (height - 1e-15 * noise) <= along * (1.0 + 1e-12),
                "{forces:?} {height}"
            );
        }
    }
    match forces.outcome {
        ForceOutcome::Converged => {
            let relative = ForceOptions::<T>::default().relative.to_f64();
            assert!(upper - lower <= relative.max(1e-3) * upper && forces.residual.to_f64() <= relative * size);
        }
        ForceOutcome::NotResistible => assert!(forces.upper >= T::HUGE && lower > 0.0, "{forces:?}"),
        _ => {}
    }
}

/// Clarabel's value in the bracket, up to its own accuracy, and the bars: size to 1e-6, equilibrium to 1e-9.
fn compare(
    found: &Found<f64>,
    contacts: &[Contact<f64>],
    frame: &WrenchFrame<f64>,
    norm: Norm,
    external: &Vector<f64, 6>,
) {
    let forces = &found.forces;
    match reference(contacts, frame, norm, external) {
        None => {
            assert!(forces.upper == f64::MAX, "{forces:?}");
            assert!(
                forces.outcome == ForceOutcome::NotResistible || forces.lower > 1e9 * external.norm(),
                "{forces:?}"
            );
        }
        Some((primal, dual)) => {
            if primal.is_nan() {
                return;
            }
            let doubt = 10.0 * (primal - dual).abs() + 2e-8 * primal;
            assert!(forces.lower <= primal + doubt && dual - doubt <= forces.upper, "{forces:?} {primal} {dual}");
            assert!(forces.upper <= primal * (1.0 + 1e-6), "{forces:?} {primal}");
            // A torque scale far off makes errors of moments count as errors of forces: the lower bound pays.
            assert!(forces.upper <= forces.lower * (1.0 + 1e-5), "{forces:?} {primal}");
            assert!(forces.residual <= 1e-9 * external.norm(), "{forces:?}");
        }
    }
}

/// A soft, hard or frictionless contact at `p`.
fn contact(p: [f64; 3], n: [f64; 3], friction: Friction<f64>) -> Contact<f64> {
    Contact::new(vector(p), vector(n), friction).unwrap()
}

fn origin(scale: f64) -> WrenchFrame<f64> {
    WrenchFrame::new(Vector::zeros(), scale).unwrap()
}

/// Contacts of every kind with caps, any torque scale, any wrench.
#[test]
fn random_grasps_against_clarabel() {
    let mut dice = Dice::new(1);
    let (mut held, mut not_held) = (0, 0);
    for _ in 0..250 {
        let frame = origin(dice.decade(-3.0, 3.0));
        let contacts: Vec<Contact<f64>> = (0..2 + dice.below(7)).map(|_| random_contact(&mut dice, 1.0)).collect();
        let external = Vector::from(dice.direction::<6>()) * dice.decade(-6.0, 6.0);
        for norm in NORMS {
            let found = resist(&contacts, &frame, norm, &external);
            compare(&found, &contacts, &frame, norm, &external);
            *if found.forces.upper < f64::MAX { &mut held } else { &mut not_held } += 1;
        }
    }
    println!("{held} held, {not_held} not");
    assert!(held > 100 && not_held > 100);
}

/// The origin on the boundary of W: contacts on one plane, all pushing up.
#[test]
fn an_object_on_a_palm_against_clarabel() {
    let mut dice = Dice::new(2);
    let mut held = 0;
    for _ in 0..100 {
        let frame = origin(dice.decade(-3.0, 3.0));
        let contacts: Vec<Contact<f64>> = (0..3 + dice.below(4))
            .map(|_| {
                let friction = random_contact::<f64>(&mut dice, 1.0).friction();
                contact([dice.signed(), dice.signed(), 0.0], [0.0, 0.0, 1.0], friction)
            })
            .collect();
        let external = Vector::from([dice.pick(&[0.0, 1e-3]), 0.0, -1.0, 0.0, 0.0, 0.0]);
        for norm in NORMS {
            let found = resist(&contacts, &frame, norm, &external);
            compare(&found, &contacts, &frame, norm, &external);
            held += usize::from(found.forces.outcome == ForceOutcome::Converged);
        }
    }
    assert!(held > 60, "{held}");
}

/// Two hard fingers in any position: W has five dimensions, none of them along an axis.
#[test]
fn flat_sets_against_clarabel() {
    let mut dice = Dice::new(3);
    for _ in 0..100 {
        let frame = origin(dice.decade(-3.0, 3.0));
        let n = Vector::from(dice.direction::<3>());
        let friction = Friction::Hard { mu: dice.decade(-3.0, 1.0) };
        let contacts = [contact((-n).into(), n.into(), friction), contact(n.into(), (-n).into(), friction)];
        let moment = n.cross(&Vector::from(dice.direction::<3>()));
        let within = frame.wrench(&Vector::from(dice.direction::<3>()), &moment);
        let across = within + frame.wrench(&Vector::zeros(), &(n * 0.1));
        for norm in NORMS {
            let found = resist(&contacts, &frame, norm, &within);
            compare(&found, &contacts, &frame, norm, &within);
            let found = resist(&contacts, &frame, norm, &across);
            assert_eq!(found.forces.outcome, ForceOutcome::NotResistible, "{:?}", found.forces);
        }
    }
}

/// A box held at many places with equal contacts, and wrenches with small integers: ties everywhere.
#[test]
fn symmetric_grasps_against_clarabel() {
    let mut dice = Dice::new(4);
    for _ in 0..60 {
        let friction =
            dice.pick(&[Friction::Frictionless, Friction::Hard { mu: 0.5 }, Friction::Soft { mu: 0.5, mus: 0.5 }]);
        let mut contacts = Vec::new();
        for (side, axis) in [(-1.0, 0), (-1.0, 1), (-1.0, 2), (1.0, 0), (1.0, 1), (1.0, 2)] {
            for shift in [-0.5, 0.5] {
                let (mut p, mut n) = ([0.0; 3], [0.0; 3]);
                (p[axis], p[(axis + 1) % 3], n[axis]) = (side, shift, -side);
                contacts.push(contact(p, n, friction));
            }
        }
        let external = Vector::from(dice.direction::<6>().map(|x| (2.0 * x).round()));
        if external.norm() > 0.0 {
            for norm in NORMS {
                let found = resist(&contacts, &origin(1.0), norm, &external);
                compare(&found, &contacts, &origin(1.0), norm, &external);
            }
        }
    }
}

/// A hundred contacts; wrenches of one kind; friction from none to more than any.
#[test]
fn many_contacts_and_extreme_friction_against_clarabel() {
    let mut dice = Dice::new(5);
    for round in 0..60 {
        let frame = origin(dice.decade(-1.0, 1.0));
        let mut contacts: Vec<Contact<f64>> =
            (0..if round < 10 { 100 } else { 6 }).map(|_| random_contact(&mut dice, 1.0)).collect();
        if round >= 10 {
            let value = |dice: &mut Dice| dice.pick(&[0.0, 1e-6, 1e-3, 1e3]);
            contacts = contacts
                .iter()
                .map(|c| {
                    let friction = Friction::Soft { mu: value(&mut dice), mus: value(&mut dice) };
                    Contact::new(*c.position(), *c.normal(), friction).unwrap()
                })
                .collect();
        }
        let external = Vector::from(dice.direction::<6>().map(|x| x.min(-0.1)));
        for norm in NORMS {
            let found = resist(&contacts, &frame, norm, &external);
            compare(&found, &contacts, &frame, norm, &external);
        }
    }
}

/// On the friction cone, and a little inside and outside of it: the bracket holds, and 1e-3 is decided.
#[test]
fn wrenches_on_the_edge() {
    let mut dice = Dice::new(6);
    for _ in 0..100 {
        let frame = origin(dice.decade(-1.0, 1.0));
        let mu = dice.decade(-2.0, 0.5);
        let finger = random_contact::<f64>(&mut dice, 1.0);
        let finger = [Contact::new(*finger.position(), *finger.normal(), Friction::Hard { mu }).unwrap()];
        let [normal, tangent, ..] = contact_map(&finger[0], &frame);
        for off in [0.0, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6, -1e-6, 1e-3, -1e-3] {
            let external = -(normal + tangent * (mu * (1.0 + off)));
            for norm in NORMS {
                let forces = resist(&finger, &frame, norm, &external).forces;
                match off {
                    1e-3 => assert_eq!(forces.outcome, ForceOutcome::NotResistible, "{forces:?}"),
                    -1e-3 => {
                        assert_eq!(forces.outcome, ForceOutcome::Converged);
                        assert!((forces.upper - 1.0).abs() < 1e-8, "{forces:?}");
                    }
                    _ if off <= 0.0 => assert!(forces.lower <= 1.0 + 1e-9, "{forces:?}"),
                    _ => {}
                }
            }
        }
    }
}

/// Two opposed soft fingers hold a weight, which also twists them: each takes half of both, and presses with
/// sqrt((g / 2 mu)^2 + (m / 2 mus)^2).
#[test]
fn two_fingers_hold_a_weight() {
    let mut dice = Dice::new(7);
    for _ in 0..40 {
        let (mu, mus, cap, weight, twist) = (
            dice.decade(-2.0, 1.0),
            dice.decade(-3.0, 0.0),
            dice.decade(-1.0, 2.0),
            dice.decade(-2.0, 2.0),
            dice.signed(),
        );
        let frame = origin(dice.decade(-3.0, 3.0));
        let finger = |x: f64| {
            let c = contact([x, 0.0, 0.0], [-x.signum(), 0.0, 0.0], Friction::Soft { mu, mus });
            c.with_force_cap(cap).unwrap()
        };
        let contacts = [finger(-0.3), finger(0.7)];
        // Their forces are equal when the weight hangs halfway between.
        let moment =
            Vector::from([twist, 0.0, 0.0]) + Vector::from([0.2, 0.0, 0.0]).cross(&Vector::from([0.0, 0.0, -weight]));
        let external = frame.wrench(&Vector::from([0.0, 0.0, -weight]), &moment);
        let press = (0.5 * weight / mu).hypot(0.5 * twist / mus);
        for (norm, size) in [(Norm::LInf, press / cap), (Norm::L1, 2.0 * press / cap)] {
            let found = resist(&contacts, &frame, norm, &external);
            let forces = found.forces;
            assert!(forces.lower <= size * (1.0 + 1e-12) && size <= forces.upper * (1.0 + 1e-12), "{forces:?} {size}");
            assert!(forces.upper - forces.lower <= 1e-6 * size, "{forces:?}");
            for (contact, share) in contacts.iter().zip(&found.shares) {
                let f = frame.contact_force(contact, share);
                assert!((f[0] - press).abs() <= 2e-6 * press, "{f} {press}");
                let along: f64 = (0..2).map(|k| contact.tangents()[k].z * f[k + 1]).sum();
                assert!((along - 0.5 * weight).abs() <= 2e-3 * mu * press, "{f} {weight}");
            }
        }
    }
}

/// d of a segment Q is 1 / the least size of forces that exert its end.
#[test]
#[ignore = "needs ../shared/data"]
fn segments_of_the_shared_data() {
    let grasps = recorded();
    let numbers =
        |v: &serde_json::Value| v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<f64>>();
    let mut count = 0;
    for grasp in &grasps {
        let read = |c: &serde_json::Value| {
            let point = |key: &str| numbers(&c[key]).try_into().unwrap();
            let coefficient = |key: &str| c[key].as_f64().unwrap_or(0.0);
            let friction = Friction::Soft { mu: coefficient("mu"), mus: coefficient("mus") };
            contact(point("p"), point("n"), friction)
        };
        let contacts: Vec<Contact<f64>> = grasp["contacts"].as_array().unwrap().iter().map(read).collect();
        let segments =
            grasp["refs"].as_array().unwrap().iter().filter(|r| r["Q"]["type"] == "segment" && r["set"] == "W");
        for r in segments {
            let end = Vector::<f64, 6>::from_column_slice(&numbers(&r["Q"]["wrench"]));
            let norm = if r["norm"] == "L1" { Norm::L1 } else { Norm::LInf };
            let forces = resist(&contacts, &origin(1.0), norm, &-end).forces;
            let size = 1.0 / r["d"].as_f64().unwrap();
            assert!(forces.lower <= size * (1.0 + 1e-9) && size <= forces.upper * (1.0 + 1e-9), "{forces:?} {size}");
            assert_eq!(forces.outcome, ForceOutcome::Converged);
            count += 1;
        }
    }
    assert!(count >= 6);
}

/// Complementary slackness, contact by contact: no share could do more along u than it does, w_i.u <= size max(0, h_i(u)), and
/// with LInf all of them together lose no more than the bracket's gap; with L1 only contacts with the largest h_i carry anything.
#[test]
fn optimality_conditions() {
    let mut dice = Dice::new(8);
    let mut count = 0;
    while count < 100 {
        let frame = origin(dice.decade(-1.0, 1.0));
        let contacts: Vec<Contact<f64>> = (0..3 + dice.below(4)).map(|_| random_contact(&mut dice, 1.0)).collect();
        let external = Vector::from(dice.direction::<6>());
        for norm in NORMS {
            let Found { forces, shares } = resist(&contacts, &frame, norm, &external);
            if forces.outcome != ForceOutcome::Converged {
                continue;
            }
            count += 1;
            let u = &forces.direction;
            let height: Vec<f64> = contacts.iter().map(|c| value(c, &frame, u).max(0.0)).collect();
            let most = height.iter().copied().fold(0.0, f64::max);
            let mut slack = 0.0;
            for ((contact, share), h) in contacts.iter().zip(&shares).zip(&height) {
                let used = frame.contact_force(contact, share)[0] / contact.force_cap();
                let loss = match norm {
                    Norm::LInf => forces.upper * h - share.dot(u),
                    Norm::L1 => used * most - share.dot(u),
                };
                assert!(loss >= -1e-10 * forces.upper * most, "{loss} {forces:?}");
                slack += loss;
            }
            let along = -external.dot(u);
            assert!(slack <= 4e-9 * along, "{slack} {along} {forces:?}");
        }
    }
}

/// Twice the wrench, twice the forces; L1 counts more than LInf; one more contact never hurts; the torque scale is a unit.
#[test]
fn laws_of_the_size() {
    let mut dice = Dice::new(9);
    for _ in 0..60 {
        let frame = origin(dice.decade(-1.0, 1.0));
        let contacts: Vec<Contact<f64>> = (0..7).map(|_| random_contact(&mut dice, 1.0)).collect();
        let (force, moment) = (Vector::from(dice.direction::<3>()), Vector::from(dice.direction::<3>()));
        let external = frame.wrench(&force, &moment);
        let other = origin(dice.decade(-3.0, 3.0));
        let of = |contacts: &[Contact<f64>], frame, norm, external: &Vector<f64, 6>| {
            resist(contacts, frame, norm, external).forces
        };
        for norm in NORMS {
            let forces = of(&contacts, &frame, norm, &external);
            let factor = dice.decade(-8.0, 8.0);
            let scaled = of(&contacts, &frame, norm, &(external * factor));
            let again = of(&contacts, &other, norm, &other.wrench(&force, &moment));
            let fewer = of(&contacts[1..], &frame, norm, &external);
            assert!(forces.lower <= fewer.upper * (1.0 + 1e-12));
            if forces.upper < f64::MAX {
                assert!(
                    forces.lower * factor <= scaled.upper * (1.0 + 1e-12)
                        && scaled.lower <= forces.upper * factor * (1.0 + 1e-12)
                );
                assert!(forces.lower <= again.upper * (1.0 + 1e-9) && again.lower <= forces.upper * (1.0 + 1e-9));
            }
        }
        let [sum, most] = NORMS.map(|norm| of(&contacts, &frame, norm, &external));
        assert!(most.lower <= sum.upper * (1.0 + 1e-12));
    }
}

/// `f32` finds what `f64` finds, to its tolerance.
#[test]
fn single_precision() {
    let mut dice = Dice::new(10);
    let (mut held, mut converged) = (0, 0);
    for _ in 0..200 {
        let narrow: Vec<Contact<f32>> = (0..3 + dice.below(4)).map(|_| random_contact(&mut dice, 1.0)).collect();
        let external = dice.direction::<6>();
        let contacts: Vec<Contact<f64>> = narrow
            .iter()
            .map(|c| {
                let (mu, mus) = c.friction().coefficients();
                let friction = Friction::Soft { mu: mu.into(), mus: mus.into() };
                // Not quite a unit vector in `f64`: a difference of 1e-7 in the result.
                Contact::new(wide(c.position()), wide(c.normal()).normalize(), friction)
                    .unwrap()
                    .with_force_cap(c.force_cap().into())
                    .unwrap()
            })
            .collect();
        for norm in NORMS {
            let frame = WrenchFrame::new(Vector::zeros(), 0.5f32).unwrap();
            let found = resist(&narrow, &frame, norm, &vector(external)).forces;
            let exact = resist(&contacts, &origin(0.5), norm, &Vector::from(external)).forces;
            assert!(
                found.outcome != ForceOutcome::NotResistible || exact.lower > 10.0 * f64::from(found.lower).min(10.0),
                "{found:?} {exact:?}"
            );
            if exact.upper < 100.0 && found.residual < 1e-3 {
                held += 1;
                converged += usize::from(found.outcome == ForceOutcome::Converged);
                assert!(f64::from(found.lower) <= exact.upper * (1.0 + 1e-3), "{found:?} {exact:?}");
                assert!(
                    found.upper == f32::MAX || exact.lower <= f64::from(found.upper) * (1.0 + 1e-3),
                    "{found:?} {exact:?}"
                );
            }
        }
    }
    println!("{converged} of {held} converged");
    assert!(held > 50 && converged * 3 > held);
}

/// Fingers around an object, with usual friction and one force cap: `f32` converges, too.
#[test]
fn usual_grasps_converge_in_single_precision() {
    let mut dice = Dice::new(14);
    let mut converged = 0;
    for _ in 0..100 {
        let frame = WrenchFrame::new(Vector::zeros(), 0.05f32).unwrap();
        let mu = dice.range(0.3, 1.0) as f32;
        let contacts: Vec<Contact<f32>> = (0..5)
            .map(|k| {
                let angle = 1.2566f64 * f64::from(k) + 0.3 * dice.signed();
                let n = vector::<f32, 3>([-angle.cos(), -angle.sin(), 0.0]);
                let p = -n * 0.05 + Vector::from([0.0, 0.0, (0.02 * dice.signed()) as f32]);
                Contact::new(p, n, Friction::Soft { mu, mus: 0.005 }).unwrap().with_force_cap(10.0).unwrap()
            })
            .collect();
        let external = frame.wrench(&vector(dice.direction::<3>()), &vector(dice.direction::<3>().map(|x| 0.01 * x)));
        for norm in NORMS {
            let forces = resist(&contacts, &frame, norm, &external).forces;
            converged += usize::from(forces.outcome == ForceOutcome::Converged);
        }
    }
    assert!(converged >= 196, "{converged}");
}

/// A control loop: the wrench turns, the fingers move. What was known makes it much shorter and changes nothing else.
#[test]
fn warm_starts() {
    let mut dice = Dice::new(11);
    let options = ForceOptions { relative: 1e-3, ..ForceOptions::default() };
    let (mut cold_steps, mut warm_steps) = (0, 0);
    for _ in 0..10 {
        let fingers = [[1.0, 0.0], [-0.5, 0.9], [-0.5, -0.9], [0.3, 0.95]];
        let mut solver = ForceSolver::new();
        let (start, turn) = (dice.direction::<6>(), dice.direction::<6>());
        for tick in 0..40 {
            let t = 1e-3 * f64::from(tick);
            let contacts = fingers.map(|[x, y]| {
                let p = Vector::from([x, y, 0.05 * x + 0.1 * t]);
                Contact::new(p, -p.normalize(), Friction::Soft { mu: 0.6, mus: 0.05 }).unwrap()
            });
            let external = Vector::from(start) + Vector::from(turn) * t;
            let primitives = primitives(&contacts, &origin(1.0));
            let set = WrenchSet::new(&primitives, Norm::LInf);
            let run = |solver: &mut ForceSolver<f64>| {
                let mut shares = vec![Vector::zeros(); 4];
                let forces = solver.resist(&set, &external, &options, &mut shares).unwrap();
                assert!(forces.upper - forces.lower <= 1e-3 * forces.upper);
                check(&Found { forces, shares }, &contacts, &origin(1.0), Norm::LInf, &external);
                forces
            };
            let (warm, cold) = (run(&mut solver), run(&mut ForceSolver::new()));
            assert!(warm.lower <= cold.upper && cold.lower <= warm.upper);
            warm_steps += warm.iterations;
            cold_steps += cold.iterations;
        }
    }
    println!("{warm_steps} warm, {cold_steps} cold");
    assert!(warm_steps * 3 < cold_steps);
}

/// Soft fingers on a ring hold a wrench that drifts: one `ForceSolver` throughout, against a new one at every tick.
fn drift<T: Real>(seed: u64, ticks: usize, mut each: impl FnMut(usize, &Forces<T>, &Forces<T>, f64)) {
    let mut dice = Dice::new(seed);
    let count = 2 + dice.below(4);
    let scale = 0.05 * dice.decade(-1.0, 1.5);
    let spin = dice.pick(&[0.0, 0.0, 0.2, 1.0]) * 0.05 / scale;
    let frame = WrenchFrame::new(Vector::zeros(), T::of(scale)).unwrap();
    let kind = dice.below(3);
    let contacts: Vec<Contact<T>> = (0..count)
        .map(|k| {
            let off = if kind == 0 { 0.0 } else { 0.3 * dice.signed() };
            let angle = std::f64::consts::TAU * k as f64 / count as f64 + off;
            let n = [-angle.cos(), -angle.sin(), 0.0];
            let p = [-n[0] * 0.05, -n[1] * 0.05, if kind == 2 { 0.02 * dice.signed() } else { 0.0 }];
            let soft = Friction::Soft { mu: T::of(dice.range(0.2, 1.0)), mus: T::of(0.005) };
            Contact::new(vector(p), vector(n), soft).unwrap().with_force_cap(T::of(10.0)).unwrap()
        })
        .collect();
    let primitives = primitives(&contacts, &frame);
    let set = WrenchSet::new(&primitives, if dice.chance(0.5) { Norm::L1 } else { Norm::LInf });
    let (start, turn) = (dice.direction::<6>(), dice.direction::<6>());
    let rate = dice.decade(-5.0, 0.0);
    let mut warm = ForceSolver::new();
    let mut shares = vec![Vector::zeros(); count];
    for tick in 0..ticks {
        let wrench = |i: usize| (start[i] + turn[i] * rate * tick as f64) * if i < 3 { 1.0 } else { spin };
        let external = vector(std::array::from_fn(wrench));
        let mut resist = |solver: &mut ForceSolver<T>| {
            let forces = solver.resist(&set, &external, &ForceOptions::default(), &mut shares).unwrap();
            let sum = shares.iter().map(wide).sum::<Vector<f64, 6>>() + wide(&external);
            assert!(forces.upper == T::HUGE || sum.norm() <= forces.residual.to_f64() + 1e-5, "{forces:?}");
            forces
        };
        let found = resist(&mut warm);
        each(tick, &found, &resist(&mut ForceSolver::new()), wide(&external).norm());
    }
}

/// As asked, or with forces at all.
fn quality<T: Real>(forces: &Forces<T>) -> u32 {
    match forces.outcome {
        ForceOutcome::Converged => 2,
        ForceOutcome::NotResistible => 1,
        _ => u32::from(forces.upper < T::HUGE),
    }
}

/// Memory never costs an answer: what a cold start finds, a warm one finds, and as well.
fn warm_is_never_worse<T: Real>(seeds: std::ops::Range<u64>) {
    let (mut warm_steps, mut cold_steps) = (0, 0);
    for seed in seeds {
        drift::<T>(seed, 100, |tick, warm, cold, whole| {
            let what = format!("{seed} {tick}: {warm:?} {cold:?}");
            assert!(quality(warm) >= quality(cold), "{what}");
            if cold.upper < T::HUGE {
                let miss = |f: &Forces<T>| {
                    let gap = (f.upper - f.lower).to_f64() / f.upper.to_f64();
                    gap.max(f.residual.to_f64() / whole)
                };
                let asked = ForceOptions::<T>::default().relative.to_f64();
                assert!(miss(warm) <= asked.max(miss(cold) * (1.0 + 1e-6)), "{what}");
            }
            let off = (whole + 1.0) * if T::ROUNDOFF.to_f64() < 1e-10 { 1e-8 } else { 1e-2 };
            assert!(warm.lower.to_f64() <= cold.upper.to_f64() * (1.0 + off), "{what}");
            assert!(cold.lower.to_f64() <= warm.upper.to_f64() * (1.0 + off), "{what}");
            warm_steps += warm.iterations;
            cold_steps += cold.iterations;
        });
    }
    println!("{warm_steps} warm, {cold_steps} cold");
    assert!(warm_steps < cold_steps);
}

#[test]
fn memory_never_costs_an_answer_f32() {
    warm_is_never_worse::<f32>(0..400);
}

#[test]
fn memory_never_costs_an_answer_f64() {
    warm_is_never_worse::<f64>(0..150);
}

/// Two soft fingers, single precision: points that the tick before was made of left no room for others, and no forces were found.
#[test]
fn forces_of_a_drifting_wrench_where_memory_misled() {
    for (seed, ticks) in [(6, [49, 63]), (15, [69, 69]), (16, [41, 96])] {
        let mut asked = 0;
        drift::<f32>(seed, 100, |tick, warm, _, _| {
            if ticks.contains(&tick) {
                assert_eq!(warm.outcome, ForceOutcome::Converged, "{seed} {tick}: {warm:?}");
                asked += 1;
            }
        });
        assert!(asked > 0);
    }
}

/// What is remembered may be anything: no directions at all, those of another grasp, one of them many times.
#[test]
fn any_memory_will_do() {
    let mut dice = Dice::new(77);
    let soft = Friction::Soft { mu: 0.5f32, mus: 0.01 };
    let fingers =
        [-1.0f32, 1.0].map(|x| Contact::new(Vector::from([x, 0.0, 0.0]), Vector::from([-x, 0.0, 0.0]), soft).unwrap());
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let primitives = primitives(&fingers, &frame);
    let set = WrenchSet::new(&primitives, Norm::LInf);
    let mut shares = [Vector::zeros(); 2];
    for case in 0..300 {
        let external = vector::<f32, 6>(dice.direction::<6>().map(|x| 0.1 * x));
        let known: Vec<Vector<f32, 6>> = (0..1 + dice.below(6))
            .map(|_| match case % 5 {
                0 => Vector::zeros(),
                1 => Vector::repeat(f32::NAN),
                2 => Vector::repeat(1e30),
                3 => vector(dice.direction::<6>().map(|x| x * 1e-30)),
                _ => vector(dice.direction::<6>()),
            })
            .collect();
        let mut resist = |mut solver: ForceSolver<f32>| {
            solver.resist(&set, &external, &ForceOptions::default(), &mut shares).unwrap()
        };
        let (warm, cold) = (resist(ForceSolver::knowing(known.into_iter())), resist(ForceSolver::new()));
        assert!(quality(&warm) >= quality(&cold), "{case}: {warm:?} {cold:?}");
    }
}

/// A contact that can exert any force in a ball around its normal force: a model of the caller's own.
struct Suction {
    primitive: Primitive<f64>,
    fails: bool,
}

impl Support<f64, 6> for Suction {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        if self.fails { Err(Failure(7)) } else { self.primitive.support(u) }
    }
    fn extent(&self) -> f64 {
        self.primitive.extent()
    }
    fn error(&self) -> f64 {
        self.primitive.error()
    }
}

impl Contribution<f64> for Suction {}

#[test]
fn contributions_of_any_kind() {
    let contacts =
        [-1.0, 1.0].map(|x: f64| contact([x, 0.0, 0.0], [-x, 0.0, 0.0], Friction::Soft { mu: 0.5, mus: 0.1 }));
    let external = Vector::from([0.1, 0.2, -1.0, 0.01, 0.1, 0.0]);
    for norm in NORMS {
        let own = |fails: bool| {
            let contributions: Vec<Suction> =
                primitives(&contacts, &origin(1.0)).into_iter().map(|primitive| Suction { primitive, fails }).collect();
            let mut shares = [Vector::repeat(9.0); 3];
            let set = WrenchSet::new(&contributions, norm);
            let forces = ForceSolver::new().resist(&set, &external, &ForceOptions::default(), &mut shares).unwrap();
            assert!(shares[2] == Vector::<f64, 6>::repeat(9.0));
            Found { forces, shares: shares[..2].to_vec() }
        };
        let found = own(false);
        check(&found, &contacts, &origin(1.0), norm, &external);
        compare(&found, &contacts, &origin(1.0), norm, &external);
        let failed = own(true);
        assert_eq!((failed.forces.outcome, failed.forces.failure), (ForceOutcome::SupportFailed, Some(Failure(7))));
        assert_eq!((failed.forces.lower, failed.forces.upper), (0.0, f64::MAX));
        assert_eq!(failed.shares, vec![Vector::<f64, 6>::zeros(); 2]);
    }
}

#[test]
fn limits() {
    let contacts =
        [-1.0, 1.0].map(|x: f64| contact([x, 0.0, 0.0], [-x, 0.0, 0.0], Friction::Soft { mu: 0.5, mus: 0.1 }));
    let primitives = primitives(&contacts, &origin(1.0));
    let set = WrenchSet::new(&primitives, Norm::LInf);
    let external = Vector::from([0.1, 0.2, -1.0, 0.01, 0.1, 0.0]);
    let mut shares = [Vector::zeros(); 2];
    let mut run = |options: ForceOptions<f64>| {
        let forces = ForceSolver::new().resist(&set, &external, &options, &mut shares).unwrap();
        check(&Found { forces, shares: shares.to_vec() }, &contacts, &origin(1.0), Norm::LInf, &external);
        forces
    };
    let best = run(ForceOptions::default());
    assert_eq!(best.outcome, ForceOutcome::Converged);
    for limit in [0.0, 0.5 * best.lower, 2.0 * best.upper, f64::INFINITY] {
        let forces = run(ForceOptions { limit, ..ForceOptions::default() });
        if limit < best.lower {
            assert!(forces.outcome == ForceOutcome::Above && forces.lower > limit);
        } else {
            assert_eq!(forces, best);
        }
    }
    for iterations in 0..best.iterations {
        let forces = run(ForceOptions { iterations, ..ForceOptions::default() });
        // The last step may only have confirmed what was known.
        assert!(forces.outcome == ForceOutcome::Iterations || forces.outcome == ForceOutcome::Converged);
        assert!(forces.lower <= best.upper && best.lower <= forces.upper && forces.iterations == iterations);
    }
    let finest = run(ForceOptions { relative: 0.0, ..ForceOptions::default() });
    assert!(finest.outcome == ForceOutcome::Precision && finest.upper - finest.lower <= 1e-9 * finest.upper);
}

#[test]
fn bad_arguments_have_a_name() {
    let contacts = [contact([0.0; 3], [0.0, 0.0, 1.0], Friction::Frictionless); 2];
    let primitives = primitives(&contacts, &origin(1.0));
    let set = WrenchSet::new(&primitives, Norm::L1);
    let run = |external: Vector<f64, 6>, options: ForceOptions<f64>, room: usize| {
        let mut shares = [Vector::repeat(1.0); 3];
        ForceSolver::new().resist(&set, &external, &options, &mut shares[..room])
    };
    let fine = ForceOptions::default();
    let weight = Vector::from([0.0, 0.0, -3.0, 0.0, 0.0, 0.0]);
    assert_eq!(run(weight, fine, 1), Err(ForceError::Room));
    for bad in [f64::NAN, f64::INFINITY, 1e200] {
        assert_eq!(run(weight * bad, fine, 2), Err(ForceError::Wrench));
    }
    for relative in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(run(weight, ForceOptions { relative, ..fine }, 2), Err(ForceError::Tolerance));
    }
    for limit in [-1.0, f64::NAN] {
        assert_eq!(run(weight, ForceOptions { limit, ..fine }, 2), Err(ForceError::Limit));
    }
    let forces = run(weight, fine, 3).unwrap();
    assert!(forces.lower <= 3.0 && 3.0 <= forces.upper);
    let nothing = run(Vector::zeros(), fine, 2).unwrap();
    assert_eq!(
        (nothing.outcome, nothing.lower, nothing.upper, nothing.residual),
        (ForceOutcome::Converged, 0.0, 0.0, 0.0)
    );
    // Straight into the palm: nothing resists it, and that is proved.
    let up = run(-weight, fine, 2).unwrap();
    assert_eq!((up.outcome, up.lower, up.upper), (ForceOutcome::NotResistible, f64::MAX, f64::MAX));
    assert!(up.direction.dot(&weight) > 0.0);
    let none: [Primitive<f64>; 0] = [];
    let forces = ForceSolver::new().resist(&WrenchSet::new(&none, Norm::LInf), &weight, &fine, &mut []).unwrap();
    assert_eq!((forces.outcome, forces.lower), (ForceOutcome::NotResistible, f64::MAX));
}

/// Numbers of any size: a true bracket, never a NaN.
#[test]
fn any_size_works() {
    fn run<T: Real>(dice: &mut Dice, range: f64) {
        let frame = WrenchFrame::new(Vector::zeros(), T::of(dice.decade(-range, range))).unwrap();
        let size = T::of(dice.decade(-range, range));
        let contacts: Vec<Primitive<T>> = (0..4)
            .filter_map(|_| {
                let c = random_contact::<T>(dice, 1.0);
                let c = Contact::new(c.position() * size, *c.normal(), c.friction()).ok()?;
                Primitive::passive(&c.with_force_cap(T::of(dice.decade(-range, range))).ok()?, &frame).ok()
            })
            .collect();
        let external = vector::<T, 6>(dice.direction::<6>().map(|x| x * dice.decade(-range, range)));
        for norm in NORMS {
            let set = WrenchSet::new(&contacts, norm);
            let mut shares = [Vector::zeros(); 4];
            let forces = ForceSolver::new().resist(&set, &external, &ForceOptions::default(), &mut shares).unwrap();
            let Forces { lower, upper, residual, direction, .. } = forces;
            assert!(T::zero() <= lower && lower <= upper && upper <= T::HUGE && residual.finite(), "{forces:?}");
            assert!(direction.iter().chain(shares.iter().flat_map(|s| s.iter())).all(|x| x.finite()), "{forces:?}");
        }
    }
    let mut dice = Dice::new(12);
    for _ in 0..1500 {
        for range in [2.0, 6.0, 14.0] {
            run::<f32>(&mut dice, range);
            run::<f64>(&mut dice, 10.0 * range);
        }
    }
}

/// Contact forces come back from their wrenches, whatever frame, tangents and friction.
#[test]
fn contact_forces_come_back() {
    let mut dice = Dice::new(13);
    for _ in 0..1000 {
        let frame = WrenchFrame::new(Vector::from(dice.direction::<3>()), dice.decade(-3.0, 3.0)).unwrap();
        let contact = random_contact::<f64>(&mut dice, 1.0);
        let [mu, _, mus] = radii(&contact, &frame);
        let x = Vector::from(dice.direction::<3>()) * dice.pick(&[1.0, 0.5, 2.0]);
        let (press, scale) = (dice.decade(-3.0, 3.0), frame.torque_scale());
        let f = [1.0, mu * x[0], mu * x[1], mus * x[2]].map(|f| press * f);
        let map = contact_map(&contact, &frame);
        let wrench: Vector<f64, 6> = (0..4).map(|k| map[k] * f[k]).sum();
        let found = frame.contact_force(&contact, &wrench);
        let want = Vector::from([f[0], f[1], f[2], f[3] * scale]);
        assert!((found - want).amax() <= 1e-13 * (1.0 + mu) * press * 4.0, "{found} {want}");
    }
    let frame = origin(2.0);
    let palm = contact([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], Friction::Frictionless);
    assert_eq!(
        frame.contact_force(&palm, &Vector::from([0.5, 0.0, 3.0, 0.0, -1.5, 0.1])),
        Vector::from([3.0, 0.0, 0.0, 0.0])
    );
    // What pulls is returned as it is.
    assert_eq!(
        frame.contact_force(&palm, &Vector::from([0.0, 0.0, -3.0, 0.0, 1.5, 0.0])),
        Vector::from([-3.0, 0.0, 0.0, 0.0])
    );
}
