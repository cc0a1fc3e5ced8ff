//! Wrench sets of contacts: values by brute force, the promise of a support function in `f32` against `f64`, mirrors,
//! bad input.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use grasp_common::{contact_map, direction, radii, random_contact, value, vector, wide};
use nalgebra::SMatrix;
use qdist::grasp::{Contact, ContactError, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::internal::norm as norm_of;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitSet};
use qdist::support::Support;
use qdist::{Options, Real, Vector, Workspace};

fn frame<T: Real>(dice: &mut Dice, reach: f64) -> WrenchFrame<T> {
    let scale = if dice.chance(0.5) { reach } else { reach * dice.decade(-2.0, 2.0) };
    WrenchFrame::new(vector(dice.direction::<3>().map(|x| x * reach)), T::of(scale)).unwrap()
}

fn primitives<T: Real>(contacts: &[Contact<T>], frame: &WrenchFrame<T>) -> Vec<Primitive<T>> {
    let mut out = vec![Primitive::empty(); contacts.len()];
    assert_eq!(wrenches(contacts, frame, &mut out).unwrap().len(), contacts.len());
    out
}

fn total(values: impl Iterator<Item = f64>, norm: Norm) -> f64 {
    let values = values.map(|h| h.max(0.0));
    match norm {
        Norm::L1 => values.fold(0.0, f64::max),
        Norm::LInf => values.sum(),
    }
}

/// Forces of the friction cone at full normal force, at random: none of their wrenches is farther than h, and the best of
/// many is almost as far.
#[test]
fn values_are_those_of_the_best_force() {
    let mut dice = Dice::new(1);
    for _ in 0..60 {
        let frame = frame::<f64>(&mut dice, 1.0);
        let contacts: Vec<Contact<f64>> = (0..4).map(|_| random_contact(&mut dice, 1.0)).collect();
        let primitives = primitives(&contacts, &frame);
        let u = Vector::from(dice.direction::<6>());
        let best: Vec<f64> = contacts
            .iter()
            .map(|contact| {
                let (map, r) = (contact_map(contact, &frame), radii(contact, &frame));
                let wrench = |x: [f64; 3]| {
                    (map[0] + map[1] * r[0] * x[0] + map[2] * r[1] * x[1] + map[3] * r[2] * x[2]) * contact.force_cap()
                };
                (0..2000).map(|_| wrench(dice.direction::<3>()).dot(&u)).fold(f64::NEG_INFINITY, f64::max)
            })
            .collect();
        for norm in [Norm::L1, Norm::LInf] {
            let h = WrenchSet::new(&primitives, norm).value(&u);
            let sampled = total(best.iter().copied(), norm);
            let exact = total(contacts.iter().map(|c| value(c, &frame, &u)), norm);
            let size = primitives.iter().map(Support::extent).sum::<f64>();
            assert!((h - exact).abs() <= 1e-14 * size, "{h} {exact}");
            assert!(sampled <= h + 1e-14 * size && h <= sampled + 5e-3 * size, "{h} {sampled}");
        }
    }
}

/// In `f32`, with everything of the exact contacts in `f64`: a point is almost in the set and almost as far as any, and
/// the extent covers it, for directions and torque scales of all sizes.
#[test]
fn sets_keep_their_promise() {
    let mut dice = Dice::new(2);
    let mut tightest = f64::INFINITY;
    for round in 0..300 {
        let reach = dice.pick(&[1.0, 1e-6, 1e6]);
        let frame = frame::<f32>(&mut dice, reach);
        let m = 1 + dice.below(8);
        let contacts: Vec<Contact<f32>> = (0..m).map(|_| random_contact(&mut dice, reach)).collect();
        let primitives = primitives(&contacts, &frame);
        for norm in [Norm::L1, Norm::LInf] {
            let set = WrenchSet::new(&primitives, norm);
            let exact = |u: &Vector<f64, 6>| total(contacts.iter().map(|c| value(c, &frame, u)), norm);
            let (e, extent) = (f64::from(set.error()), f64::from(set.extent()));
            assert!(e > 0.0 && e < 1e-3 * extent, "{round}: {e} {extent}");
            for _ in 0..30 {
                let scale = dice.pick(&[1.0, 1e-30, 1e30, 1e-44, 10.0]);
                let u32 = Vector::from(direction(&mut dice).map(|x| (x * scale) as f32));
                let u = wide(&u32);
                if u.norm() == 0.0 {
                    continue;
                }
                let p = wide(&set.support(&u32).unwrap());
                assert!(u.dot(&p) >= exact(&u) - e * u.norm(), "{round} {norm:?} {u} {p}");
                assert!(p.norm() <= extent + e);
                // No direction separates p from the set by more than e: tried are those in which p is far out.
                for _ in 0..20 {
                    let v = u / u.norm() + Vector::from(dice.direction::<6>()) * dice.decade(-4.0, 0.0);
                    let v = v / v.norm();
                    assert!(v.dot(&p) <= exact(&v) + e, "{round} {norm:?} {u} {v}");
                }
                if scale == 1.0 || scale == 10.0 {
                    assert!((f64::from(set.value(&u32)) - exact(&u)).abs() <= e * u.norm());
                    tightest = tightest.min(extent / p.norm());
                }
            }
        }
    }
    // The extent of a single contact is attained, to rounding.
    assert!(tightest < 1.05, "{tightest}");
}

/// A fingertip whose spin friction is long, on a long arm: force closure is decided to roundoffs of the largest wrench, not to the
/// product of both lengths.
#[test]
fn spin_friction_on_a_long_arm_costs_no_precision() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let touch = |x: f64| {
        let soft = Friction::Soft { mu: 0.5, mus: 1e5 };
        Contact::new(Vector::from([x, 0.0, 0.0]), Vector::from([-x.signum(), 0.0, 0.0]), soft).unwrap()
    };
    let primitives = primitives(&[touch(-1e5), touch(1e5)], &frame);
    for norm in [Norm::L1, Norm::LInf] {
        let set = WrenchSet::new(&primitives, norm);
        assert!(set.error() < 1e-13 * set.extent(), "{:e} {:e}", set.error(), set.extent());
    }
}

#[test]
fn primitives_are_sets_of_their_own() {
    let axis = |i: usize| Vector::from(core::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
    let u: Vector<f64, 6> = axis(0) + axis(1) * 2.0;
    let empty = Primitive::empty();
    assert!(empty.is_empty() && empty.support(&u).is_err() && empty.value(&u) == -f64::MAX);
    let point = Primitive::new(axis(0), SMatrix::zeros()).unwrap();
    assert_eq!((point.support(&u), point.value(&u)), (Ok(axis(0)), 1.0));
    let disc = Primitive::new(axis(0), SMatrix::from_columns(&[axis(1), axis(2) * 0.5, axis(3) * 0.0])).unwrap();
    assert_eq!((disc.support(&u), disc.value(&u)), (Ok(axis(0) + axis(1)), 3.0));
    assert!((disc.extent() - 2f64.sqrt()).abs() < 1e-14);
    // As if they were not there.
    for norm in [Norm::L1, Norm::LInf] {
        let with = WrenchSet::new(&[empty, point, empty], norm).support(&u);
        assert_eq!(with, WrenchSet::new(&[point], norm).support(&u));
        assert_eq!(WrenchSet::<f64>::new(&[], norm).support(&u), Ok(Vector::zeros()));
        assert_eq!(WrenchSet::new(&[point], norm).support(&-u), Ok(Vector::zeros()));
    }
    // A direction along which the disc is seen edge on, up to the smallest number.
    let tiny = axis(0) + (axis(1) + axis(2)) * 5e-324;
    let disc = Primitive::new(axis(0), SMatrix::from_columns(&[axis(1), axis(2), axis(3)])).unwrap();
    assert!((disc.support(&tiny).unwrap() - axis(0)).norm() < 1.0 + 1e-15);
}

/// Row (a1) of the paper: mirrored in y, in z, and half a turn about x, but not in x: the fingers are at different
/// distances.
#[test]
fn mirrors_of_two_fingers() {
    let soft = Friction::Soft { mu: 0.2, mus: 0.2 };
    let at = |x: f64| Contact::new(vector([x, 0.0, 0.0]), vector([-x.signum(), 0.0, 0.0]), soft).unwrap();
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let (uneven, even) = (primitives(&[at(-0.75), at(1.3)], &frame), primitives(&[at(-1.0), at(1.0)], &frame));
    for norm in [Norm::L1, Norm::LInf] {
        let mirrored =
            |p: &[Primitive<f64>], signs: [f64; 6]| WrenchSet::new(p, norm).is_mirrored(&Vector::from(signs));
        // Forces mirrored in a plane, moments accordingly.
        for (x, y, z, same) in [
            (1.0, 1.0, 1.0, true),
            (1.0, -1.0, 1.0, true),
            (1.0, 1.0, -1.0, true),
            (1.0, -1.0, -1.0, true),
            (-1.0, 1.0, 1.0, false),
        ] {
            let signs = [x, y, z, y * z, x * z, x * y];
            assert_eq!(mirrored(&uneven, signs), same, "{signs:?}");
            assert!(mirrored(&even, signs), "{signs:?}");
        }
        // Spin moments come in both signs on their own.
        assert!(mirrored(&uneven, [1.0, 1.0, 1.0, -1.0, 1.0, 1.0]));
        assert!(!mirrored(&uneven, [1.0, 1.0, 1.0, 1.0, -1.0, 1.0]));
        for bad in [0.0, 2.0, f64::NAN] {
            assert!(!mirrored(&even, [1.0, 1.0, bad, 1.0, 1.0, 1.0]));
        }
    }
    // Three times on one side and once on the other is symmetric for L1 only.
    let lopsided = primitives(&[at(1.0), at(-1.0), at(1.0), at(1.0)], &frame);
    let signs = Vector::from([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0]);
    assert!(WrenchSet::new(&lopsided, Norm::L1).is_mirrored(&signs));
    assert!(!WrenchSet::new(&lopsided, Norm::LInf).is_mirrored(&signs));
}

/// Table I of the paper, rows (a1), (a3), (a4) and (a5): the solver's brackets around the closed forms.
#[test]
fn table_one_by_the_solver() {
    let soft = Friction::Soft { mu: 0.2, mus: 0.2 };
    let at = |x: f64| Contact::new(vector([x, 0.0, 0.0]), vector([-x.signum(), 0.0, 0.0]), soft).unwrap();
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let primitives = primitives(&[at(-0.75), at(1.3)], &frame);
    let set = WrenchSet::new(&primitives, Norm::LInf);
    let mut memory = Box::new(Workspace::<f64, 6, 512, 8192>::new());
    let options = Options { relative: 1e-3, ..Options::default() };
    let mut row = |q: &dyn UnitSet<f64, 6>, d: f64| {
        let answer = memory.solver().solve(&set, q, &options);
        let (lower, upper) = (answer.lower, answer.upper);
        assert!(lower <= d * (1.0 + 1e-15) && d * (1.0 - 1e-15) <= upper, "{d}: [{lower}, {upper}]");
        println!("{d:.6}: [{lower:.6}, {upper:.6}]");
    };
    let ones = Vector::repeat(1.0);
    row(&Ball::unit(), 0.41 / (0.1681f64 + 1.69 + 1.0).sqrt());
    row(&CrossPolytope::new(ones).unwrap(), 0.41 / 1.3);
    row(&UnitBox::new(ones).unwrap(), 0.41 / (0.41 + 2.3 * 2f64.sqrt()));
    row(&Segment::new(Vector::from([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])).unwrap(), 1.0);
}

/// A random grasp and its mirror image together are symmetric, with derived tangents, exactly; and what `mirrored` says
/// is true.
#[test]
fn mirrored_sets_have_mirrored_values() {
    let mut dice = Dice::new(3);
    let frame = WrenchFrame::new(Vector::zeros(), 0.7).unwrap();
    let mut found = 0;
    for _ in 0..50 {
        let flip: [f64; 3] = core::array::from_fn(|_| dice.pick(&[1.0, -1.0]));
        let mut contacts = Vec::new();
        for _ in 0..3 {
            let a = random_contact::<f64>(&mut dice, 1.0);
            let plain = |p: Vector<f64, 3>, n: Vector<f64, 3>| Contact::new(p, n, a.friction()).unwrap();
            let flip = Vector::from(flip);
            contacts.extend([
                plain(*a.position(), *a.normal()),
                plain(a.position().component_mul(&flip), a.normal().component_mul(&flip)),
            ]);
        }
        let primitives = primitives(&contacts, &frame);
        let [x, y, z] = flip;
        for norm in [Norm::L1, Norm::LInf] {
            let set = WrenchSet::new(&primitives, norm);
            assert!(set.is_mirrored(&Vector::from([x, y, z, y * z, x * z, x * y])));
            for bits in 0..64 {
                let signs = Vector::from(core::array::from_fn(|i| if bits >> i & 1 == 1 { -1.0 } else { 1.0 }));
                if set.is_mirrored(&signs) {
                    found += 1;
                    let u = Vector::from(dice.direction::<6>());
                    assert!((set.value(&u) - set.value(&u.component_mul(&signs))).abs() <= 1e-13 * set.extent());
                }
            }
        }
    }
    assert!(found >= 150);
}

/// Numbers of any size and kind: an error or a usable set, never a panic, a NaN or an endless loop.
#[test]
fn any_input_is_refused_or_works() {
    fn number(dice: &mut Dice) -> f64 {
        match dice.below(12) {
            0 => f64::NAN,
            1 => dice.pick(&[f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -f64::MAX, 5e-324, 1e-310]),
            2 => dice.decade(-320.0, 308.0),
            3 => dice.decade(-140.0, 146.0),
            4 | 5 => 0.0,
            6 => -dice.unit(),
            _ => dice.pick(&[1.0, -1.0, 0.5]),
        }
    }
    fn run<T: Real>(dice: &mut Dice) -> bool {
        let mut v = || vector::<T, 3>(core::array::from_fn(|_| number(dice)));
        let (p, reference, tangents) = (v(), v(), [v(), v()]);
        let n = if dice.chance(0.7) {
            vector(dice.direction::<3>())
        } else {
            vector(core::array::from_fn(|_| number(dice)))
        };
        let (mu, mus) = (T::of(number(dice)), T::of(number(dice)));
        let Ok(frame) = WrenchFrame::new(reference, T::of(number(dice))) else { return false };
        let Ok(contact) = Contact::new(p, n, Friction::Soft { mu, mus }) else { return false };
        let contact = contact.with_tangents(tangents[0], tangents[1]).unwrap_or(contact);
        let contact = contact.with_force_cap(T::of(number(dice))).unwrap_or(contact);
        let primitive = match Primitive::passive(&contact, &frame) {
            Ok(primitive) => primitive,
            Err(error) => {
                assert_eq!(error, ContactError::Wrench);
                return false;
            }
        };
        for norm in [Norm::L1, Norm::LInf] {
            let two = [primitive; 2];
            let set = WrenchSet::new(&two, norm);
            assert!(set.extent().finite() && set.error().finite() && set.error() >= T::zero());
            let u = vector::<T, 6>(core::array::from_fn(|_| number(dice)));
            if u.iter().all(|x| x.finite()) {
                let p = set.support(&u).unwrap();
                assert!(p.iter().all(|x| x.finite()), "{primitive:?} {u} {p}");
                assert!(
                    norm_of(&wide(&p)) <= (set.extent() + set.error()).to_f64() * (1.0 + 1e-6),
                    "{primitive:?} {u} {p}"
                );
            }
        }
        true
    }
    let mut dice = Dice::new(4);
    let worked = (0..200_000).filter(|_| run::<f64>(&mut dice) | run::<f32>(&mut dice)).count();
    assert!(worked > 1000, "{worked}");
}

#[test]
fn lists_name_the_contact() {
    let frame = WrenchFrame::new(Vector::zeros(), 1e-100).unwrap();
    let at = |x: f64| Contact::new(vector([x, 0.0, 0.0]), vector([0.0, 0.0, 1.0]), Friction::Frictionless).unwrap();
    let mut out = [Primitive::empty(); 3];
    let error = wrenches(&[at(0.0), at(1.0), at(1e100)], &frame, &mut out).unwrap_err();
    assert_eq!((error.contact, error.error), (2, ContactError::Wrench));
    let error = wrenches(&[at(0.0); 4], &frame, &mut out).unwrap_err();
    assert_eq!((error.contact, error.error), (3, ContactError::Room));
    assert_eq!(wrenches(&[at(0.0); 2], &frame, &mut out).unwrap().len(), 2);
    let huge = Primitive::new(Vector::repeat(f64::NAN), SMatrix::zeros());
    assert_eq!(huge, Err(ContactError::Wrench));
}

/// The promise of a support function coordinate by coordinate, for the contacts' exact numbers: moments a million times as large as forces, or
/// as small, leave the rounding of forces as it is.
#[test]
fn rounding_is_known_row_by_row() {
    let mut dice = Dice::new(91);
    let (mut tightest, mut asked) = (f64::MAX, 0);
    for _ in 0..300 {
        let frame = WrenchFrame::new(vector([0.1, -0.2, 0.3]), (dice.decade(-6.0, 6.0)) as f32).unwrap();
        let contacts: Vec<Contact<f32>> = (0..1 + dice.below(5)).map(|_| random_contact(&mut dice, 1.0)).collect();
        let mut memory = vec![Primitive::empty(); contacts.len()];
        wrenches(&contacts, &frame, &mut memory).unwrap();
        for norm in [Norm::L1, Norm::LInf] {
            let set = WrenchSet::new(&memory, norm);
            let (errors, extents) = (wide(&set.errors()), wide(&set.extents()));
            let height = |u: &Vector<f64, 6>| {
                let own = contacts.iter().map(|c| value(c, &frame, u).max(0.0));
                if norm == Norm::L1 { own.fold(0.0, f64::max) } else { own.sum() }
            };
            // Directions along which all rows count alike.
            let even = |dice: &mut Dice| Vector::from(direction(dice)).component_div(&errors.map(|e| e / errors.max()));
            for _ in 0..20 {
                let u = even(&mut dice);
                let narrow = vector::<f32, 6>((u / u.amax()).into());
                let u = wide(&narrow);
                let point = wide(&set.support(&narrow).unwrap());
                let allowed = errors.dot(&u.abs());
                let exact = height(&u);
                assert!(point.dot(&u) >= exact - allowed, "{} {exact} {allowed}", point.dot(&u));
                assert!((0..6).all(|i| point[i].abs() <= extents[i]), "{point} {extents}");
                let v = even(&mut dice);
                assert!(point.dot(&v) <= height(&v) + errors.dot(&v.abs()));
                if exact > 0.0 {
                    tightest = tightest.min(allowed / errors.norm());
                    asked += 1;
                }
            }
            assert!(errors.norm() <= 2.0 * f64::from(set.error()), "{errors} {}", set.error());
        }
    }
    assert!(asked > 3000 && tightest < 1e-4, "{asked} {tightest}");
}
