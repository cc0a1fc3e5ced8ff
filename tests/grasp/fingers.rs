//! Fingers as a whole: contacts that share joints, torque limits, and forces that joints make together. The oracle is Clarabel, a
//! convex solver of others, on the program as it is defined, in newtons and newton metres.
use crate::common;
use crate::grasp_common;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use common::dice::Dice;
use grasp_common::{contact_map, direction, radii, random_contact, vector, wide};
use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, ContactError, Finger, ForceModel, ForceOptions, ForceSolver, Friction, GraspError, HandContact, Jacobian,
    MAX_CONTACTS, Norm, Primitive, UNSOLVED, WrenchFrame, WrenchSet, active_wrenches, default_tolerance, wrenches,
};
use qdist::qset::Ball;
use qdist::support::{Failure, Support};
use qdist::{Options, Outcome, Real, Vector, Workspace};

/// What a finger is made of.
#[derive(Debug)]
struct Parts<T: Real> {
    contacts: Vec<HandContact<T>>,
    limits: Vec<T>,
    model: ForceModel,
    frame: WrenchFrame<T>,
}

impl<T: Real> Parts<T> {
    fn finger(&self) -> Finger<T> {
        Finger::new(&self.contacts, &self.limits, self.model, &self.frame, default_tolerance()).unwrap()
    }

    /// Of the Jacobian of contact i, its spin row times the torque scale.
    fn entry(&self, i: usize, row: usize, j: usize) -> f64 {
        let x = self.contacts[i].jacobian.unwrap().entry(row, j).unwrap().to_f64();
        if row == 3 { x * self.frame.torque_scale().to_f64() } else { x }
    }
}

/// h(u) by Clarabel: lower and upper.
fn oracle<T: Real>(parts: &Parts<T>, u: &Vector<f64, 6>) -> Option<(f64, f64)> {
    let (k, q) = (parts.contacts.len(), parts.limits.len());
    let active = parts.model == ForceModel::Active && parts.contacts[0].jacobian.is_some();
    let width = 4 * k + if active { q } else { 0 };
    let mut objective = vec![0.0; width];
    let (mut rows, mut right, mut cones) = (Vec::<Vec<f64>>::new(), Vec::new(), Vec::new());
    let unit = |at: usize, x: f64| {
        let mut row = vec![0.0; width];
        row[at] = x;
        row
    };
    for (i, own) in parts.contacts.iter().enumerate() {
        for (c, column) in contact_map(&own.contact, &parts.frame).iter().enumerate() {
            objective[4 * i + c] = -column.dot(u);
        }
        // f = cap x.
        let radii = radii(&own.contact, &parts.frame);
        rows.push(unit(4 * i, -1.0));
        right.push(0.0);
        for c in 0..3 {
            if radii[c] > 0.0 {
                rows.push(unit(4 * i + 1 + c, -1.0 / radii[c]));
                right.push(0.0);
            }
        }
        cones.push(SupportedConeT::SecondOrderConeT(1 + radii.iter().filter(|&&r| r > 0.0).count()));
        for c in 0..3 {
            if radii[c] == 0.0 {
                rows.push(unit(4 * i + 1 + c, 1.0));
                right.push(0.0);
                cones.push(SupportedConeT::ZeroConeT(1));
            }
        }
        rows.push(unit(4 * i, 1.0));
        right.push(own.contact.force_cap().to_f64());
        cones.push(SupportedConeT::NonnegativeConeT(1));
    }
    for (j, limit) in parts.limits.iter().enumerate() {
        let limit = limit.to_f64();
        let mut row = vec![0.0; width];
        for i in 0..k {
            for c in 0..4 {
                row[4 * i + c] = parts.entry(i, c, j);
            }
        }
        if limit == 0.0 {
            rows.push(row);
            right.push(0.0);
            cones.push(SupportedConeT::ZeroConeT(1));
        } else if limit.is_finite() {
            rows.push(row.clone());
            rows.push(row.iter().map(|x| -x).collect());
            right.extend([limit, limit]);
            cones.push(SupportedConeT::NonnegativeConeT(2));
        }
    }
    if active {
        for i in 0..k {
            for c in 0..4 {
                let mut row = unit(4 * i + c, 1.0);
                for j in 0..q {
                    row[4 * k + j] = -parts.entry(i, c, j);
                }
                rows.push(row);
                right.push(0.0);
                cones.push(SupportedConeT::ZeroConeT(1));
            }
        }
    }
    let matrix = CscMatrix::from(&rows);
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-12)
        .tol_gap_rel(1e-12)
        .tol_feas(1e-12)
        .build()
        .unwrap();
    let p = CscMatrix::zeros((width, width));
    let mut solver = DefaultSolver::new(&p, &objective, &matrix, &right, &cones, settings).unwrap();
    solver.solve();
    let s = &solver.solution;
    matches!(s.status, SolverStatus::Solved | SolverStatus::AlmostSolved | SolverStatus::InsufficientProgress)
        .then(|| (-s.obj_val, -s.obj_val_dual))
}

/// A finger of any kind.
fn random_parts<T: Real>(dice: &mut Dice, contacts: usize) -> Parts<T> {
    let reach = dice.decade(-2.0, 2.0);
    let frame = WrenchFrame::new(Vector::zeros(), T::of(reach * dice.decade(-0.5, 0.5))).unwrap();
    let q = dice.below(9);
    let rank = dice.below(q + 1).max(1);
    let base: Vec<Vec<[f64; 4]>> = (0..rank)
        .map(|_| {
            (0..contacts)
                .map(|_| {
                    let d = dice.direction::<4>();
                    [d[0].abs() + 0.3, d[1], d[2], d[3] / reach].map(|x| reach * x)
                })
                .collect()
        })
        .collect();
    let mix: Vec<Vec<f64>> = (0..rank)
        .map(|r| {
            (0..q)
                .map(|j| {
                    if r == j {
                        1.0
                    } else if dice.chance(0.5) {
                        0.0
                    } else {
                        dice.signed()
                    }
                })
                .collect()
        })
        .collect();
    let hand = (0..contacts)
        .map(|i| {
            let rows: [Vec<T>; 4] = core::array::from_fn(|c| {
                (0..q).map(|j| T::of((0..rank).map(|r| base[r][i][c] * mix[r][j]).sum())).collect()
            });
            let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap();
            HandContact { contact: random_contact(dice, reach), jacobian: Some(jacobian) }
        })
        .collect();
    let limits = (0..q)
        .map(|_| {
            T::of(match dice.below(6) {
                0 => f64::INFINITY,
                1 if dice.chance(0.3) => 0.0,
                _ => reach * dice.decade(-2.0, 1.0),
            })
        })
        .collect();
    let model = if dice.chance(0.5) { ForceModel::Passive } else { ForceModel::Active };
    Parts { contacts: hand, limits, model, frame }
}

/// h within `error` of Clarabel's, forces that obey everything, and a point that is made of them.
fn check<T: Real>(parts: &Parts<T>, finger: &Finger<T>, u: &Vector<f64, 6>) -> bool {
    let point = finger.support(&vector(u.data.0[0])).unwrap();
    let u = wide(&vector::<T, 6>(u.data.0[0]));
    let forces = finger.forces(&vector(u.data.0[0])).unwrap().map(|f| wide(&f));
    let what = || format!("{:?} {:?} {u:?}", parts.contacts, parts.limits);
    let cap = parts.contacts.iter().map(|c| c.contact.force_cap().to_f64()).fold(0.0, f64::max);
    let fine = T::ROUNDOFF.to_f64() * 1e4;
    // What all contacts could exert without limits.
    let mut reach = 0.0;
    let mut sum = Vector::<f64, 6>::zeros();
    for (own, f) in parts.contacts.iter().zip(&forces) {
        let (map, radii) = (contact_map(&own.contact, &parts.frame), radii(&own.contact, &parts.frame));
        map.iter().zip(f.iter()).for_each(|(column, f)| sum += column * *f);
        let widest = radii.iter().fold(1.0, |m: f64, &r| m.max(r));
        let size = map.iter().map(|c| c.norm()).sum::<f64>() * widest * own.contact.force_cap().to_f64();
        reach += size;
        assert!(f[0] >= -fine * cap && f[0] <= own.contact.force_cap().to_f64() + fine * cap, "{}", what());
        let used: f64 = (0..3).map(|c| if radii[c] > 0.0 { (f[c + 1] / radii[c]).powi(2) } else { 0.0 }).sum();
        assert!(used.sqrt() <= f[0] + fine * cap, "{}", what());
        assert!((0..3).all(|c| radii[c] > 0.0 || f[c + 1] == 0.0));
    }
    for (j, limit) in parts.limits.iter().enumerate() {
        let (mut torque, mut size) = (0.0, 0.0);
        for (i, own) in parts.contacts.iter().enumerate() {
            let radii = radii(&own.contact, &parts.frame);
            for c in 0..4 {
                let x = parts.entry(i, c, j);
                torque += x * forces[i][c];
                size += x.abs() * cap * if c == 0 { 1.0 } else { radii[c - 1] };
            }
        }
        assert!(torque.abs() <= limit.to_f64() + fine * size, "{torque:e} {limit} {}", what());
    }
    assert!((sum - wide(&point)).norm() <= fine * reach, "{}", what());
    assert!(wide(&point).norm() <= finger.extent().to_f64());
    let Some((low, high)) = oracle(parts, &u) else { return false };
    let allowed = finger.error().to_f64() * u.norm() + (high - low).abs() + 1e-10 * reach * u.norm();
    let value = wide(&point).dot(&u);
    assert!(value >= low - allowed && value <= high + allowed, "{value:e} {low:e} {high:e} {allowed:e} {}", what());
    true
}

#[test]
fn agrees_with_an_independent_solver() {
    let mut dice = Dice::new(11);
    let mut solved = 0;
    for round in 0..1200 {
        let parts = random_parts::<f64>(&mut dice, 1 + round % 4);
        let finger = parts.finger();
        for _ in 0..3 {
            let u = Vector::from(direction(&mut dice)).normalize() * dice.decade(-1.0, 1.0);
            solved += usize::from(check(&parts, &finger, &u));
        }
    }
    assert!(solved > 3500, "{solved}");
}

/// Without rank decisions, which rounded matrices leave open.
#[test]
fn agrees_in_single_precision() {
    let mut dice = Dice::new(12);
    let (mut solved, mut active) = (0, 0);
    for round in 0..600 {
        let mut parts = random_parts::<f32>(&mut dice, 1 + round % 3);
        let (height, width) = (4 * parts.contacts.len(), parts.limits.len());
        let stacked =
            SMatrix::<f64, 16, 8>::from_fn(
                |r, j| if r < height && j < width { parts.entry(r / 4, r % 4, j) } else { 0.0 },
            );
        let sigma = stacked.singular_values();
        let smallest = width.min(height).checked_sub(1).map_or(0.0, |last| sigma[last]);
        if !(smallest > 1e-2 * sigma[0]) {
            parts.model = ForceModel::Passive;
        }
        active += usize::from(parts.model == ForceModel::Active);
        let finger = parts.finger();
        for _ in 0..3 {
            solved += usize::from(check(&parts, &finger, &Vector::from(direction(&mut dice)).normalize()));
        }
    }
    assert!(solved > 1700 && active > 50, "{solved} {active}");
}

/// Limits far below what the caps permit make duals large. Each answer is proven nevertheless.
fn unequal<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    for round in 0..1500 {
        let mut parts = random_parts::<T>(&mut dice, 1 + round % 4);
        for own in &mut parts.contacts {
            own.contact = own.contact.with_force_cap(T::of(dice.decade(-3.0, 3.0))).unwrap();
        }
        for limit in parts.limits.iter_mut().filter(|limit| limit.finite()) {
            *limit *= T::of(dice.decade(-6.0, 2.0));
        }
        let finger = parts.finger();
        for _ in 0..3 {
            let u = vector(dice.direction::<6>());
            let p = finger.support(&u).unwrap();
            assert!(p.dot(&u) >= -finger.error() && finger.error() <= finger.extent());
        }
    }
}

#[test]
fn unequal_limits_are_solved() {
    unequal::<f64>(17);
    unequal::<f32>(18);
}

/// The palm has no Jacobian; nobody has neither contacts nor joints.
#[test]
fn without_limits_it_is_what_its_contacts_are() {
    let mut dice = Dice::new(13);
    for round in 0..600 {
        let mut parts = random_parts::<f64>(&mut dice, 1 + round % 4);
        parts.limits.fill(f64::INFINITY);
        if dice.chance(0.3) {
            parts.contacts.iter_mut().for_each(|c| c.jacobian = None);
            parts.limits.clear();
        } else if parts.contacts.len() > 1 {
            parts.model = ForceModel::Passive;
        }
        let primitives: Vec<Primitive<f64>> = match parts.model {
            ForceModel::Active => {
                let mut memory = [Primitive::empty(); 4];
                active_wrenches(&parts.contacts, &parts.frame, default_tolerance(), &mut memory).unwrap().to_vec()
            }
            ForceModel::Passive => {
                parts.contacts.iter().map(|c| Primitive::passive(&c.contact, &parts.frame).unwrap()).collect()
            }
        };
        let (finger, set) = (parts.finger(), WrenchSet::new(&primitives, Norm::LInf));
        for _ in 0..10 {
            let u = Vector::from(direction(&mut dice)).normalize();
            let (a, b) = (finger.support(&u).unwrap(), set.support(&u).unwrap());
            assert!((a.dot(&u) - b.dot(&u)).abs() <= 1e-13 * set.extent(), "{parts:?}");
        }
    }
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let none = Finger::<f64>::new(&[], &[], ForceModel::Active, &frame, 1e-9).unwrap();
    assert_eq!(none.support(&Vector::x()).unwrap(), Vector::<f64, 6>::zeros());
}

/// A contact at (x, 0, 0) that presses along y, moved by joints with these velocities along n, o = z and t = x.
fn touch(x: f64, friction: Friction<f64>, cap: f64, joints: &[[f64; 3]]) -> HandContact<f64> {
    let (n, o) = (Vector::from([0.0, 1.0, 0.0]), Vector::from([0.0, 0.0, 1.0]));
    let contact = Contact::new(Vector::from([x, 0.0, 0.0]), n, friction).unwrap();
    let contact = contact.with_tangents(o, n.cross(&o)).unwrap().with_force_cap(cap).unwrap();
    let rows: [Vec<f64>; 4] =
        core::array::from_fn(|r| joints.iter().map(|j| j.get(r).copied().unwrap_or(0.0)).collect());
    HandContact { contact, jacobian: Some(Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap()) }
}

fn finger(contacts: &[HandContact<f64>], limits: &[f64], model: ForceModel) -> Finger<f64> {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    Finger::new(contacts, limits, model, &frame, default_tolerance()).unwrap()
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * (1.0 + b.abs())
}

/// One joint and a frictionless contact: min(cap, tau / j), for any sizes of both.
#[test]
fn one_joint_presses_with_its_torque() {
    for cap in [1e-100, 1e-3, 1.0, 50.0, 1e5, 1e100] {
        for (arm, share) in [(0.1, 0.5), (1e3, 1e-3), (-0.7, 3.0), (1e-60, 1e-7), (2.0, 0.0), (2.0, f64::INFINITY)] {
            let limit = arm * share * cap;
            let one = [touch(0.0, Friction::Frictionless, cap, &[[arm, 0.0, 0.0]])];
            for model in [ForceModel::Passive, ForceModel::Active] {
                let finger = finger(&one, &[limit.abs()], model);
                let p = finger.support(&Vector::from([0.3, 2.0, 0.0, 1.0, 0.0, 0.0])).unwrap();
                let want = cap * share.min(1.0);
                assert!((p[1] - want).abs() <= 1e-9 * want, "{cap} {arm} {share} {p}");
                assert!(
                    finger.error() <= 1e-10 * want + f64::MIN_POSITIVE
                        && finger.extent() <= 1.01 * want + f64::MIN_POSITIVE
                );
                assert_eq!(
                    finger.support(&Vector::from([0.3, -2.0, 0.0, 1.0, 0.0, 0.0])).unwrap(),
                    Vector::<f64, 6>::zeros()
                );
            }
        }
    }
}

/// Where joints make forces at two contacts together, the edge of the cone decides what is left: everything, a ray, nothing.
#[test]
fn what_two_contacts_can_do_together() {
    let hard = |mu| Friction::Hard { mu };
    let (up, right) = (Vector::from([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]), Vector::from([1.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    // The first joint moves the first contact with a slope of 0.5, and the second contact upright; the second joint only the second.
    let pair = |mu| {
        [
            touch(1.0, hard(mu), 1.0, &[[1.0, 0.0, 0.5], [0.0, 0.0, 0.0]]),
            touch(2.0, hard(0.5), 1.0, &[[1.0, 0.0, 0.0], [1.0, 0.0, 0.25]]),
        ]
    };
    let free = [f64::INFINITY; 2];
    for (mu, first) in [(1.0, 1.0), (0.5, 1.0), (0.4999, 0.0), (0.1, 0.0)] {
        let finger = finger(&pair(mu), &free, ForceModel::Active);
        let [a, b, _, _] = finger.forces(&up).unwrap();
        assert!(near(a[0], first) && near(a[2].abs(), 0.5 * first) && near(b[0], 1.0), "{mu} {a} {b}");
        // Upright c1 with c2 (1, 0.25): |0.25 c2| <= 0.5 (c1 + c2) always for c >= 0.
        let sideways = finger.support(&right).unwrap().dot(&right);
        let tuples = |c1: f64, c2: f64| {
            let fits = c1 >= 0.0 && c1 <= first && c1 + c2 >= (0.25 * c2).abs() / 0.5 && c1 + c2 <= 1.0;
            if fits { (0.5 * c1 + 0.25 * c2).abs() } else { 0.0 }
        };
        let steps = || (-400..=400).map(|i| f64::from(i) / 100.0);
        let want = steps().flat_map(|x| steps().map(move |y| (x, y))).fold(0.0, |m: f64, (x, y)| m.max(tuples(x, y)));
        let back = finger.support(&-right).unwrap().dot(&-right);
        assert!(near(sideways.max(back), want), "{mu}: {sideways} {back} {want}");
    }
    // One joint that presses with one contact and pulls with the other.
    let scissors = [touch(1.0, hard(0.5), 1.0, &[[1.0, 0.0, 0.0]]), touch(2.0, hard(0.5), 1.0, &[[-1.0, 0.0, 0.0]])];
    assert_eq!(finger(&scissors, &[1.0], ForceModel::Active).support(&up).unwrap(), Vector::<f64, 6>::zeros());
    // Passively both press, and the joint does not notice.
    let p = finger(&scissors, &[0.0], ForceModel::Passive).support(&up).unwrap();
    assert!(near(p[1], 2.0));
    // A joint without torque: what would turn it slides off the contact, unless friction holds it.
    let loose = |mu| [touch(1.0, hard(mu), 1.0, &[[1.0, 0.0, 0.5]])];
    for (mu, want) in [(1.9, 0.0), (2.0, 1.0), (4.0, 1.0)] {
        let p = finger(&loose(mu), &[0.0], ForceModel::Passive).support(&up).unwrap();
        assert!(near(p[1], want) && near(p[0].abs(), 2.0 * want), "{mu} {p}");
    }
}

/// Positively homogeneous, subadditive, grows with limits and caps; 0 and all support points belong to the set.
#[test]
fn it_is_a_convex_set_that_grows_with_limits() {
    let mut dice = Dice::new(14);
    for round in 0..400 {
        let parts = random_parts::<f64>(&mut dice, 1 + round % 4);
        let finger = parts.finger();
        let h = |finger: &Finger<f64>, u: &Vector<f64, 6>| finger.support(u).unwrap().dot(u);
        let (u, v) = (Vector::from(dice.direction::<6>()), Vector::from(direction(&mut dice)));
        let e = 2.0 * finger.error();
        let (hu, hv) = (h(&finger, &u), h(&finger, &v));
        assert!(hu >= 0.0 && h(&finger, &(u + v)) <= hu + hv + e * (2.0 + 2.0 * v.norm()));
        assert!((h(&finger, &(u * 1e6)) - 1e6 * hu).abs() <= 1e6 * e);
        assert!(u.dot(&finger.support(&v).unwrap()) <= hu + e);
        let grown = |factor: f64, caps: f64| {
            let contacts: Vec<_> = parts
                .contacts
                .iter()
                .map(|c| {
                    let contact = c.contact.with_force_cap(c.contact.force_cap() * caps).unwrap();
                    HandContact { contact, ..*c }
                })
                .collect();
            let limits: Vec<f64> = parts.limits.iter().map(|t| t * factor).collect();
            Finger::new(&contacts, &limits, parts.model, &parts.frame, default_tolerance()).unwrap()
        };
        for (limits, caps) in [(1.5, 1.0), (1.0, 1.5), (100.0, 1.0)] {
            let larger = grown(limits, caps);
            assert!(h(&larger, &u) >= hu - e - 2.0 * larger.error());
        }
        // With another finger: the sum, and the hull.
        let pair = [finger, grown(0.5, 1.0)];
        let (a, b) = (h(&pair[0], &u), h(&pair[1], &u));
        for (norm, want) in [(Norm::LInf, a + b), (Norm::L1, a.max(b))] {
            let set = WrenchSet::new(&pair, norm);
            assert!((set.support(&u).unwrap().dot(&u) - want).abs() <= 2.0 * e && set.error() >= finger.error());
        }
        // All forces in another unit.
        for scale in [1e-120, 1e-6, 1e80] {
            let other = grown(scale, scale);
            assert!((h(&other, &u) - scale * hu).abs() <= scale * e + 2.0 * other.error(), "{scale}");
        }
    }
}

#[test]
fn bad_fingers_are_named() {
    let one = touch(0.0, Friction::Frictionless, 1.0, &[[1.0, 0.0, 0.0]; 2]);
    let other = touch(0.0, Friction::Frictionless, 1.0, &[[1.0, 0.0, 0.0]; 3]);
    let palm = HandContact { jacobian: None, ..one };
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let new = |contacts: &[HandContact<f64>], limits: &[f64]| {
        Finger::new(contacts, limits, ForceModel::Active, &frame, 1e-9).map(|_| ()).map_err(|e| (e.contact, e.error))
    };
    let limit = |joint| Err((0, ContactError::TorqueLimit { joint }));
    assert_eq!(new(&[one, one], &[1.0, 2.0]), Ok(()));
    assert_eq!(new(&[one], &[1.0]), limit(1));
    assert_eq!(new(&[one], &[1.0; 3]), limit(2));
    assert_eq!(new(&[palm], &[1.0]), limit(0));
    assert_eq!(new(&[one], &[1.0, -1.0]), limit(1));
    assert_eq!(new(&[one], &[f64::NAN, 1.0]), limit(0));
    assert_eq!(new(&[one, other], &[1.0; 2]), Err((1, ContactError::Jacobian)));
    assert_eq!(new(&[one, palm], &[1.0; 2]), Err((1, ContactError::Jacobian)));
    assert_eq!(new(&[one; 5], &[1.0; 2]), Err((4, ContactError::Room)));
    assert_eq!(new(&[palm; 4], &[]), Ok(()));
    let bad = Finger::new(&[one], &[1.0; 2], ForceModel::Active, &frame, 0.0);
    assert_eq!(bad.map(|_| ()), Err(GraspError { contact: 0, error: ContactError::Tolerance }));
    let text = std::format!("{}", new(&[one], &[1.0]).unwrap_err().1);
    assert_eq!(text, "the torque limit of joint 1 is negative, or missing");
}

/// Numbers of any size: refused, or a set with finite points.
#[test]
fn any_finger_is_refused_or_works() {
    let mut dice = Dice::new(15);
    let (mut worked, mut failed) = (0, 0);
    for _ in 0..20_000 {
        let mut number = || match dice.below(12) {
            0 => 0.0,
            1 => dice.decade(-320.0, 308.0),
            2 => dice.pick(&[f64::NAN, f64::INFINITY, -1.0, f64::MAX, 5e-324]),
            3 => dice.decade(-10.0, 10.0),
            _ => dice.signed(),
        };
        let (mu, mus, scale, cap) = (number().abs(), number().abs(), number().abs(), number().abs());
        let limits = [number().abs(), number().abs()];
        let rows: [[f64; 2]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| number()));
        let Ok(jacobian) = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]) else { continue };
        let position = Vector::from([number(), number(), number()]);
        let n = Vector::from(dice.direction::<3>());
        let Ok(contact) = Contact::new(position, n, Friction::Soft { mu, mus }) else { continue };
        let Ok(contact) = contact.with_force_cap(cap) else { continue };
        let Ok(frame) = WrenchFrame::new(Vector::zeros(), scale) else { continue };
        let contacts = [HandContact { contact, jacobian: Some(jacobian) }; 2];
        let model = dice.pick(&[ForceModel::Active, ForceModel::Passive]);
        let Ok(finger) = Finger::new(&contacts[..1 + dice.below(2)], &limits, model, &frame, 1e-9) else { continue };
        assert!(finger.error().finite() && finger.extent().finite());
        match finger.support(&Vector::from(dice.direction::<6>())) {
            Ok(p) => {
                assert!(p.iter().all(|x| x.finite()) && p.norm() <= finger.extent());
                worked += 1;
            }
            Err(code) => {
                assert_eq!(code, Failure(UNSOLVED));
                failed += 1;
            }
        }
    }
    assert!(worked > 2000 && failed * 100 < worked, "{worked} {failed}");
}

/// d of three fingers: below h in all directions, equal to Clarabel's where it is said to be attained; it grows with the limits up
/// to that of the contacts alone.
#[test]
fn efficiency_with_limited_joints() {
    let mut dice = Dice::new(16);
    let frame = WrenchFrame::new(Vector::zeros(), 0.05).unwrap();
    for round in 0..3 {
        let base: Vec<Vec<HandContact<f64>>> = (0..3)
            .map(|i| {
                let angle = std::f64::consts::TAU * f64::from(i) / 3.0;
                let contacts = 1 + usize::from(round > 0);
                (0..contacts)
                    .map(|k| {
                        let height = 0.02 * k as f64 + 0.01 * dice.signed();
                        let p = Vector::from([0.04 * angle.cos(), 0.04 * angle.sin(), height]);
                        let n = -Vector::from([angle.cos(), angle.sin(), 0.1]).normalize();
                        let soft = Friction::Soft { mu: 0.6, mus: 0.01 };
                        let rows: [[f64; 3]; 4] = core::array::from_fn(|r| {
                            core::array::from_fn(|j| {
                                if r == 3 {
                                    0.3 * dice.signed()
                                } else {
                                    0.05 * (dice.signed() + f64::from(u8::from(r == j)))
                                }
                            })
                        });
                        let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap();
                        HandContact { contact: Contact::new(p, n, soft).unwrap(), jacobian: Some(jacobian) }
                    })
                    .collect()
            })
            .collect();
        let options = Options { relative: 2e-2, ..Options::default() };
        let mut memory = Box::new(Workspace::<f64, 6, 512, 4096>::new());
        let mut before = 0.0;
        for limit in [0.003, 0.02, 0.05, 10.0] {
            let parts: Vec<Parts<f64>> = base
                .iter()
                .map(|contacts| Parts {
                    contacts: contacts.clone(),
                    limits: vec![limit; 3],
                    model: ForceModel::Passive,
                    frame,
                })
                .collect();
            let fingers: Vec<Finger<f64>> = parts.iter().map(Parts::finger).collect();
            let set = WrenchSet::new(&fingers, Norm::LInf);
            let ball = Ball::new(1.0).unwrap();
            let answer = memory.solver().solve(&set, &ball, &options);
            assert_eq!(answer.outcome, Outcome::Converged);
            assert!(answer.lower > 0.0 && answer.upper >= before);
            before = answer.lower;
            let height = |u: &Vector<f64, 6>| parts.iter().map(|p| oracle(p, u).unwrap().0).sum::<f64>();
            let u = answer.direction.normalize();
            assert!((height(&u) - answer.upper).abs() <= 1e-7 * answer.upper, "{} {}", height(&u), answer.upper);
            // From many directions downhill: the support point is the gradient of h.
            let mut lowest = f64::MAX;
            for _ in 0..10 {
                let mut u = Vector::from(dice.direction::<6>());
                for step in 1..60 {
                    let p = set.support(&u).unwrap();
                    u = (u - (p - u * p.dot(&u)) * (0.3 / (p.norm() * f64::from(step).sqrt()))).normalize();
                }
                lowest = f64::min(lowest, height(&u));
            }
            assert!(lowest >= answer.lower * (1.0 - 1e-9), "{lowest} {}", answer.lower);
            if limit == 10.0 {
                let contacts: Vec<Contact<f64>> = base.iter().flatten().map(|c| c.contact).collect();
                let mut room = [Primitive::empty(); 6];
                let primitives = wrenches(&contacts, &frame, &mut room).unwrap();
                let whole = memory.solver().solve(&WrenchSet::new(primitives, Norm::LInf), &ball, &options);
                assert!(whole.lower <= answer.upper && answer.lower <= whole.upper);
            }
        }
    }
}

/// The forces that a load is distributed to make the shares, within friction, and within `upper` times caps and limits.
#[test]
fn distributed_forces_make_the_shares() {
    let mut dice = Dice::new(0x5ba7e);
    let (mut found, mut limited) = (0, 0);
    for case in 0..120 {
        let first: Parts<f64> = random_parts(&mut dice, 1 + case % 3);
        let second = Parts { frame: first.frame, ..random_parts(&mut dice, 1 + case % 2) };
        let hand = [first, second];
        let fingers = [hand[0].finger(), hand[1].finger()];
        let set = WrenchSet::new(&fingers, if case % 2 == 0 { Norm::LInf } else { Norm::L1 });
        let mut farthest = || set.support(&Vector::from(dice.direction::<6>())).unwrap();
        let load = -(farthest() * 0.3 + farthest() * 0.2);
        let mut solver = ForceSolver::new();
        let mut shares = [Vector::zeros(); 2];
        let mut forces = [[Vector::repeat(7.0); MAX_CONTACTS]; 2];
        let options = ForceOptions { relative: 1e-6, ..ForceOptions::default() };
        let answer = solver.resist(&set, &load, &options, &mut shares).unwrap();
        solver.contact_forces(&set, &mut forces).unwrap();
        if answer.upper >= f64::MAX {
            assert!(solver.parts().next().is_none() && forces.iter().flatten().flatten().all(|&x| x == 0.0));
            continue;
        }
        found += 1;
        assert!(solver.parts().map(|(_, weight)| weight).sum::<f64>() <= answer.upper);
        for ((parts, forces), (share, finger)) in hand.iter().zip(&forces).zip(shares.iter().zip(&fingers)) {
            let tiny = 1e-9 * answer.upper;
            let mut sum = Vector::<f64, 6>::zeros();
            for (own, f) in parts.contacts.iter().zip(forces) {
                sum += parts.frame.contact_map(&own.contact) * f;
                let radii = radii(&own.contact, &parts.frame);
                let edge = f[0] + tiny * own.contact.force_cap();
                assert!(f[0] <= (answer.upper + tiny) * own.contact.force_cap() && edge >= 0.0);
                let y: f64 = (0..3).filter(|&c| radii[c] > 0.0).map(|c| (f[1 + c] / radii[c]).powi(2)).sum();
                assert!(y.sqrt() <= edge, "case {case}: {} {edge}", y.sqrt());
                assert!((0..3).all(|c| radii[c] > 0.0 || f[1 + c] == 0.0));
            }
            assert!(forces.iter().skip(parts.contacts.len()).flatten().all(|&x| x == 0.0));
            assert!((sum - share).norm() <= tiny * finger.extent(), "case {case}: {sum} {share}");
            for (j, &limit) in parts.limits.iter().enumerate().filter(|(_, limit)| limit.is_finite()) {
                let torques = || {
                    let all = (0..parts.contacts.len()).flat_map(|i| (0..4).map(move |row| (i, row)));
                    all.map(|(i, row)| (i, parts.entry(i, row, j), row))
                };
                let torque: f64 = torques().map(|(i, x, row)| x * forces[i][row]).sum();
                let size: f64 = torques().map(|(i, x, _)| x.abs() * parts.contacts[i].contact.force_cap()).sum();
                assert!(torque.abs() <= answer.upper * limit + tiny * size, "case {case}: {torque} {limit}");
                limited += usize::from(torque.abs() > 0.9 * answer.upper * limit && torque != 0.0);
            }
        }
    }
    assert!(found > 80 && limited > 20, "{found} {limited}");
}
