//! Active forces: every rank and every sign of Delta, against the paper's eq. 10-15 as they stand, and closed forms of
//! planar fingers.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use grasp_common::{random_contact, vector, wide};
use nalgebra::{Matrix3, SMatrix, Vector3};
use qdist::grasp::{
    ActiveForces, Contact, ContactError, Friction, HandContact, Jacobian, Norm, Primitive, Subspace, WrenchFrame,
    WrenchSet, active_wrenches, default_tolerance,
};
use qdist::support::Support;
use qdist::{Real, Vector};

fn upright<T: Real>(friction: Friction<T>) -> Contact<T> {
    let (x, y) = (vector([1.0, 0.0, 0.0]), vector([0.0, 1.0, 0.0]));
    Contact::new(Vector::zeros(), vector([0.0, 0.0, 1.0]), friction).unwrap().with_tangents(x, y).unwrap()
}

fn plain<T: Real>() -> WrenchFrame<T> {
    WrenchFrame::new(Vector::zeros(), T::one()).unwrap()
}

/// The active forces of a contact whose Jacobian has these columns.
fn active<T: Real>(friction: Friction<T>, columns: &[[f64; 4]]) -> ActiveForces<T> {
    let rows: [Vec<T>; 4] = core::array::from_fn(|r| columns.iter().map(|c| T::of(c[r])).collect());
    let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap();
    ActiveForces::new(&upright(friction), &jacobian, &plain(), default_tolerance()).unwrap()
}

/// (rank, Delta, dimension) and the center for each case that the paper names.
fn cases<T: Real>() {
    let soft = Friction::Soft { mu: T::of(0.5), mus: T::of(0.25) };
    let hard = Friction::Hard { mu: T::of(0.5) };
    let few = 40.0 * T::ROUNDOFF.to_f64();
    let check = |friction, columns: &[[f64; 4]], rank, delta: Option<f64>, set: Option<(usize, [f64; 4])>| {
        let a = active::<T>(friction, columns);
        let what = format!("{columns:?} {a:?}");
        assert_eq!(a.rank(), rank, "{what}");
        assert_eq!(a.delta().is_some(), delta.is_some(), "{what}");
        assert!(a.delta().is_none_or(|d| (d.to_f64() - delta.unwrap()).abs() <= few), "{what}");
        assert_eq!(a.dimension(), set.map(|(dimension, _)| dimension), "{what}");
        if let (Some((center, _)), Some((_, want))) = (a.set(), set) {
            assert!((wide(center) - Vector::from(want)).amax() <= few, "{what}");
        }
    };
    let n = [1.0, 0.0, 0.0, 0.0];
    let (o, t, s) = ([0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]);
    let tilted = |x: f64| [2.0, 2.0 * x, 0.0, 0.0];
    // r = 0: no joint, or none that moves the contact.
    check(soft, &[], 0, None, None);
    check(soft, &[[0.0; 4]; 3], 0, None, None);
    // r = 1: a point on the normal, inside, on and outside of the cone; no normal component.
    check(soft, &[n], 1, Some(1.0), Some((0, n)));
    check(soft, &[tilted(0.25)], 1, Some(0.75), Some((0, [1.0, 0.25, 0.0, 0.0])));
    check(soft, &[tilted(0.5)], 1, Some(0.0), Some((0, [1.0, 0.5, 0.0, 0.0])));
    check(soft, &[tilted(1.0)], 1, Some(-3.0), None);
    check(soft, &[o], 1, None, None);
    check(soft, &[[1.0, 0.0, 0.0, 0.125]], 1, Some(0.75), Some((0, [1.0, 0.0, 0.0, 0.125])));
    // r = 2.
    check(soft, &[n, o], 2, Some(1.0), Some((1, n)));
    check(soft, &[tilted(0.25), t], 2, Some(0.75), Some((1, [1.0, 0.25, 0.0, 0.0])));
    check(soft, &[tilted(0.5), t], 2, Some(0.0), Some((0, [1.0, 0.5, 0.0, 0.0])));
    check(soft, &[tilted(1.0), t], 2, Some(-3.0), None);
    check(soft, &[t, s, t], 2, None, None);
    // r = 3.
    check(soft, &[n, o, t], 3, Some(1.0), Some((2, n)));
    check(soft, &[tilted(0.25), t, s], 3, Some(0.75), Some((2, [1.0, 0.25, 0.0, 0.0])));
    check(soft, &[tilted(0.5), t, s], 3, Some(0.0), Some((0, [1.0, 0.5, 0.0, 0.0])));
    check(soft, &[tilted(1.0), t, s, t, s], 3, Some(-3.0), None);
    check(soft, &[o, t, s], 3, None, None);
    // r = 4: everything.
    check(soft, &[n, o, t, s], 4, Some(1.0), Some((3, n)));
    // Coefficients that are zero: f4 = 0, f2 = f3 = f4 = 0.
    check(hard, &[n, o, t, s], 4, Some(1.0), Some((2, n)));
    check(hard, &[tilted(0.25), s], 2, Some(0.75), Some((0, [1.0, 0.25, 0.0, 0.0])));
    check(hard, &[[1.0, 0.0, 0.0, 0.1]], 1, None, None);
    check(hard, &[[1.0, 0.0, 0.0, 0.1], s], 2, Some(1.0), Some((0, n)));
    check(Friction::Frictionless, &[n, s], 2, Some(1.0), Some((0, n)));
    check(Friction::Frictionless, &[tilted(0.25)], 1, None, None);
    check(Friction::Frictionless, &[tilted(0.25), o], 2, Some(1.0), Some((0, n)));
    check(Friction::Soft { mu: T::zero(), mus: T::of(0.25) }, &[n, s, o], 3, Some(1.0), Some((1, n)));
}

#[test]
fn every_rank_and_every_delta() {
    cases::<f64>();
    cases::<f32>();
}

/// The tolerance is where it is said to be: an almost singular J, a force almost on the cone.
#[test]
fn tolerances() {
    let soft = Friction::Soft { mu: 0.5, mus: 0.25 };
    let at = |columns: &[[f64; 4]]| active::<f64>(soft, columns);
    let (n, o) = ([1.0, 0.0, 0.0, 0.0], |x: f64| [0.0, x, 0.0, 0.0]);
    assert_eq!((at(&[n, o(2e-9)]).dimension(), at(&[n, o(0.5e-9)]).dimension()), (Some(1), Some(0)));
    let usage = |x: f64| at(&[[1.0, 0.5 * x, 0.0, 0.0]]);
    assert!(usage(1.0 + 1e-8).set().is_none());
    let (center, _) = usage(1.0 + 0.4e-9).set().map(|(c, d)| (*c, *d)).unwrap();
    assert!((center[1] - 0.5).abs() < 1e-15, "drawn back into the cone");
    assert_eq!(usage(1.0 - 1e-8).dimension(), Some(0));
    for bad in [0.0, f64::NAN, 1.0, -1e-9] {
        let jacobian = Jacobian::new([&[1.0]; 4]).unwrap();
        let refused = ActiveForces::new(&upright(soft), &jacobian, &plain(), bad);
        assert_eq!(refused, Err(ContactError::Tolerance));
    }
}

/// eq. 12-15 as they are printed, for an orthonormal basis A of the range with r = R columns, N = R - 1: Delta, f_0 and
/// P P^T.
fn as_printed<const R: usize, const N: usize>(
    a: SMatrix<f64, 4, R>,
    mu: f64,
    mus: f64,
) -> (f64, Vector<f64, 4>, SMatrix<f64, 4, 4>) {
    let (a1, a2) = (a.fixed_rows::<1>(0).into_owned(), a.fixed_rows::<3>(1).into_owned());
    let d = Matrix3::from_diagonal(&Vector3::new(1.0 / (mu * mu), 1.0 / (mu * mu), 1.0 / (mus * mus)));
    let a1_plus = a1.transpose() / a1.norm_squared();
    let form = a2.transpose() * d * a2;
    // The null space of A1: the complement of A1 in R^r, by a Householder reflection that takes e_1 to A1.
    let mut v = a1.transpose() / a1.norm();
    v[0] += if v[0] > 0.0 { 1.0 } else { -1.0 };
    let h = SMatrix::<f64, R, R>::identity() - v * v.transpose() * (2.0 / v.norm_squared());
    let n = h.fixed_columns::<N>(1).into_owned();
    let q = n.transpose() * form * n;
    let b = n.transpose() * form * a1_plus;
    let c = a1_plus.dot(&(form * a1_plus)) - 1.0;
    let inverse = q.try_inverse().unwrap();
    let p = a * n;
    (b.dot(&(inverse * b)) - c, a * (a1_plus - n * inverse * b), p * inverse * p.transpose())
}

#[test]
fn agrees_with_the_equations_as_printed() {
    let mut dice = Dice::new(1);
    let mut seen = [[0; 2]; 5];
    for _ in 0..4000 {
        let (mu, mus) = (dice.decade(-2.0, 0.5), dice.decade(-2.0, 0.5));
        let rank = 1 + dice.below(4);
        let joints = rank + dice.below(9 - rank);
        // The range leans towards the normal, or most ranges of low rank would miss the cone.
        let base: [[f64; 4]; 4] = core::array::from_fn(|k| {
            core::array::from_fn(|i| {
                if k >= rank {
                    0.0
                } else if i == 0 {
                    1.0
                } else {
                    0.5 * dice.signed()
                }
            })
        });
        let mix = SMatrix::<f64, 4, 8>::from_fn(|_, j| if j < joints { dice.signed() } else { 0.0 });
        let j = SMatrix::from(base) * mix;
        let rows: [Vec<f64>; 4] = core::array::from_fn(|r| j.row(r).iter().copied().take(joints).collect());
        let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap();
        let friction = Friction::Soft { mu, mus };
        let ours = ActiveForces::new(&upright(friction), &jacobian, &plain(), 1e-9).unwrap();
        let svd = j.svd(true, false);
        let r = svd.singular_values.iter().filter(|&&s| s > 1e-9 * svd.singular_values[0]).count();
        assert_eq!(ours.rank(), r);
        let u = svd.u.unwrap();
        let (delta, f0, pp) = match r {
            1 => {
                let f0 = u.column(0) / u[(0, 0)]; // c = 1 / A_1
                let usage = (f0[1].powi(2) + f0[2].powi(2)) / (mu * mu) + (f0[3] / mus).powi(2);
                (1.0 - usage, f0, SMatrix::zeros())
            }
            2 => as_printed::<2, 1>(u.fixed_columns::<2>(0).into_owned(), mu, mus),
            3 => as_printed::<3, 2>(u.fixed_columns::<3>(0).into_owned(), mu, mus),
            _ => as_printed::<4, 3>(u.fixed_columns::<4>(0).into_owned(), mu, mus),
        };
        let found = ours.delta().unwrap();
        assert!((found - delta).abs() <= 1e-8 * (1.0 + delta.abs()), "{found} {delta}");
        seen[r][usize::from(delta > 0.0)] += 1;
        let Some((center, disc)) = ours.set() else {
            assert!(delta < 0.0);
            continue;
        };
        assert!((center - f0).amax() < 1e-7, "{center}");
        assert!((disc * disc.transpose() - pp * delta).amax() < 1e-7);
    }
    assert!(seen[1..4].iter().flatten().all(|&n| n > 50) && seen[4] == [0, seen[4][1]], "{seen:?}");
}

/// Random forces J c of unit normal component: those in the cone are in the set, and the set's points are such forces.
#[test]
fn sets_hold_the_forces_of_joint_torques() {
    let mut dice = Dice::new(2);
    let mut inside = 0;
    for _ in 0..1000 {
        let (mu, mus) = (dice.decade(-1.0, 0.0), dice.decade(-1.0, 0.0));
        let q = 2 + dice.below(2);
        let columns: Vec<[f64; 4]> =
            (0..q).map(|_| core::array::from_fn(|i| if i == 0 { 1.0 } else { 0.3 * dice.signed() })).collect();
        let a = active::<f64>(Friction::Soft { mu, mus }, &columns);
        let usage = |f: &Vector<f64, 4>| ((f[1] / mu).powi(2) + (f[2] / mu).powi(2) + (f[3] / mus).powi(2)).sqrt();
        for _ in 0..50 {
            let c: Vec<f64> = (0..q).map(|_| dice.signed()).collect();
            let f = columns.iter().zip(&c).fold(Vector::<f64, 4>::zeros(), |s, (j, c)| s + Vector::from(*j) * *c);
            let f = f / f[0];
            let u = Vector::<f64, 4>::from(dice.direction::<4>());
            if usage(&f) <= 1.0 {
                inside += 1;
                let (center, disc) = a.set().unwrap();
                assert!(u.dot(&f) <= center.dot(&u) + disc.tr_mul(&u).norm() + 1e-9);
            }
            if let Some((center, disc)) = a.set() {
                let f = center + disc * Vector::<f64, 3>::from(dice.direction::<3>());
                assert!((f[0] - 1.0).abs() < 1e-12 && usage(&f) <= 1.0 + 1e-9);
                let basis = SMatrix::<f64, 4, 3>::from_fn(|i, j| columns.get(j).map_or(0.0, |c| c[i]));
                let off = basis * basis.svd(true, true).solve(&f, 1e-12).unwrap() - f;
                assert!(off.norm() < 1e-9);
            }
        }
    }
    assert!(inside > 1000, "{inside}");
}

/// Row (a1) of Table I: two planar fingers, each with unit normal force and friction along y; W^a is three-dimensional.
fn planar_fingers<T: Real>() {
    let soft = Friction::Soft { mu: T::of(0.2), mus: T::of(0.2) };
    let r = |x: f64| T::of(x);
    let planar = [[r(1.0), r(0.4), r(0.2)], [r(0.3), r(0.9), r(0.5)], [r(0.0); 3], [r(0.0); 3]];
    let jacobian = Jacobian::new([&planar[0], &planar[1], &planar[2], &planar[3]]).unwrap();
    let finger = |x: f64| {
        let (n, y) = (vector([-x.signum(), 0.0, 0.0]), vector([0.0, 1.0, 0.0]));
        let contact = Contact::new(vector([x, 0.0, 0.0]), n, soft).unwrap().with_tangents(y, n.cross(&y)).unwrap();
        HandContact { contact, jacobian: Some(jacobian) }
    };
    let hand = [finger(-0.75), finger(1.3)];
    let mut memory = [Primitive::empty(); 2];
    let primitives = active_wrenches(&hand, &plain(), default_tolerance(), &mut memory).unwrap();
    let subspace = Subspace::new(primitives, default_tolerance()).unwrap();
    assert_eq!(subspace.dimension(), 3);
    let axis = |i: usize| vector(core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    // Forces in the plane and the moment about z.
    assert_eq!(subspace.matrix::<3>(), Some(SMatrix::from_columns(&[axis(0), axis(1), axis(5)])));
    assert_eq!(subspace.matrix::<2>(), None);
    let mut dice = Dice::new(3);
    for _ in 0..1000 {
        let u = vector::<T, 6>(dice.direction());
        let v = wide(&u);
        let one = |x: f64| -x.signum() * v[0] + 0.2 * (v[1] + x * v[5]).abs();
        let (a, b) = (one(-0.75).max(0.0), one(1.3).max(0.0));
        for (norm, h) in [(Norm::L1, a.max(b)), (Norm::LInf, a + b)] {
            let set = WrenchSet::new(primitives, norm);
            assert!((set.value(&u).to_f64() - h).abs() <= set.error().to_f64());
        }
    }
}

#[test]
fn planar_fingers_are_planar() {
    planar_fingers::<f64>();
    planar_fingers::<f32>();
}

/// Rank 4 and the palm are passive, number for number.
#[test]
fn full_rank_and_palm_are_passive() {
    let mut dice = Dice::new(4);
    for _ in 0..200 {
        let contact = random_contact::<f64>(&mut dice, 1.0);
        let frame = WrenchFrame::new(Vector::from(dice.direction::<3>()), dice.decade(-2.0, 2.0)).unwrap();
        let rows: [[f64; 5]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| dice.signed()));
        let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap();
        let hand = [HandContact { contact, jacobian: Some(jacobian) }, HandContact { contact, jacobian: None }];
        let mut memory = [Primitive::empty(); 2];
        let primitives = active_wrenches(&hand, &frame, 1e-9, &mut memory).unwrap();
        let passive = Primitive::passive(&contact, &frame).unwrap();
        assert_eq!(primitives, &[passive, passive]);
    }
}

/// Metres or centimetres: the same wrenches, when the torque scale is the same length.
#[test]
fn units_do_not_matter() {
    let mut dice = Dice::new(5);
    for _ in 0..200 {
        let rows: [[f64; 3]; 4] =
            core::array::from_fn(|i| core::array::from_fn(|_| dice.signed() + if i == 0 { 2.0 } else { 0.0 }));
        let (p, n) = (Vector::from(dice.direction::<3>()), Vector::from(dice.direction::<3>()));
        // Lengths times k: position, mus, velocities, torque scale.
        let run = |k: f64| {
            let soft = Friction::Soft { mu: 0.7, mus: 0.4 * k };
            let contact = Contact::new(p * k, n, soft).unwrap();
            let [a, b, c, spin] = rows;
            let jacobian = Jacobian::new([&a.map(|x| x * k), &b.map(|x| x * k), &c.map(|x| x * k), &spin]).unwrap();
            let frame = WrenchFrame::new(Vector::zeros(), 0.3 * k).unwrap();
            let mut memory = [Primitive::empty()];
            active_wrenches(&[HandContact { contact, jacobian: Some(jacobian) }], &frame, 1e-9, &mut memory).unwrap()[0]
        };
        let (metres, centimetres) = (run(1.0), run(100.0));
        assert_eq!(metres.is_empty(), centimetres.is_empty());
        assert!((metres.center() - centimetres.center()).amax() < 1e-9);
        let square = |p: &Primitive<f64>| p.disc() * p.disc().transpose();
        assert!((square(&metres) - square(&centimetres)).amax() < 1e-9);
    }
}

/// Random primitives in random subspaces: the dimension is found, all wrenches lie in it, and sizes do not matter.
#[test]
fn subspaces_are_found() {
    let mut dice = Dice::new(6);
    for round in 0..700 {
        let k = round % 7;
        let axes = dice.rotation::<6>();
        let mut wrench =
            |size: f64| (0..k).fold(Vector::<f64, 6>::zeros(), |s, i| s + Vector::from(axes[i]) * dice.signed()) * size;
        let sizes = [1.0, 1e-6, 1e-3, 1e3];
        let primitives: Vec<Primitive<f64>> = sizes
            .iter()
            .map(|&size| {
                let disc = SMatrix::from_columns(&[wrench(size), wrench(size * 1e-5), Vector::zeros()]);
                Primitive::new(wrench(size), disc).unwrap()
            })
            .chain([Primitive::empty()])
            .collect();
        let subspace = Subspace::new(&primitives, 1e-9).unwrap();
        assert_eq!(subspace.dimension(), k);
        let basis = subspace.basis();
        for (i, a) in basis.iter().enumerate() {
            for (j, b) in basis.iter().enumerate() {
                let unit = if i == j { 1.0 } else { 0.0 };
                assert!((Vector::from(*a).dot(&Vector::from(*b)) - unit).abs() < 64.0 * f64::EPSILON);
            }
        }
        for p in &primitives {
            let p = p.support(&Vector::from(dice.direction::<6>())).unwrap_or(Vector::zeros());
            assert!(subspace.distance(&p) <= 1e-9 * p.norm());
        }
    }
    assert_eq!(Subspace::<f64>::new(&[], 1e-9).unwrap().dimension(), 0);
    assert_eq!(Subspace::<f64>::new(&[], 1e-17), Err(ContactError::Tolerance));
}

/// Jacobians of any size and kind: refused, or usable sets.
#[test]
fn any_jacobian_is_refused_or_works() {
    fn run<T: Real>(dice: &mut Dice) -> bool {
        let mut number = || match dice.below(10) {
            0 => 0.0,
            1 => dice.decade(-320.0, 308.0),
            2 => dice.pick(&[f64::NAN, f64::INFINITY, -1.0, f64::MAX, 5e-324]),
            3 => dice.decade(-10.0, 10.0),
            _ => dice.signed(),
        };
        let rows: [[T; 3]; 4] = core::array::from_fn(|_| core::array::from_fn(|_| T::of(number())));
        let (mu, mus, scale) = (T::of(number()), T::of(number()), T::of(number()));
        let Ok(jacobian) = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]) else { return false };
        let n = vector(dice.direction::<3>());
        let Ok(contact) = Contact::new(vector(dice.direction::<3>()), n, Friction::Soft { mu, mus }) else {
            return false;
        };
        let Ok(frame) = WrenchFrame::new(Vector::zeros(), scale) else { return false };
        let hand = [HandContact { contact, jacobian: Some(jacobian) }; 2];
        let mut memory = [Primitive::empty(); 2];
        let Ok(primitives) = active_wrenches(&hand, &frame, default_tolerance(), &mut memory) else { return false };
        let set = WrenchSet::new(primitives, Norm::LInf);
        let p = set.support(&vector(dice.direction::<6>())).unwrap();
        assert!(p.iter().all(|x| x.finite()) && set.error().finite() && set.extent().finite());
        assert!(Subspace::new(primitives, default_tolerance()).unwrap().dimension() <= 6);
        true
    }
    let mut dice = Dice::new(7);
    let worked = (0..100_000).filter(|_| run::<f64>(&mut dice) | run::<f32>(&mut dice)).count();
    assert!(worked > 1000, "{worked}");
}
