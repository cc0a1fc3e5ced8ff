//! Grasps that are nearly flat: two soft fingers that hardly resist torsion. Their wrench sets reach as far as the friction torque along one axis, and a
//! million times as far along the others.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use grasp_common::{contact_map, radii, socp, vector, wide};
use nalgebra::SMatrix;
use qdist::grasp::{Contact, Friction, HandContact, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::qset::{Ball, CrossPolytope, UnitEllipsoid, UnitSet};
use qdist::support::{Failure, Support};
use qdist::{Options, Outcome, Real, Vector, Workspace};

/// The same contacts in `f64`, by the formulas of the paper.
struct Wide {
    maps: Vec<([Vector<f64, 6>; 4], [f64; 3])>,
    norm: Norm,
}

impl Wide {
    fn new<T: Real>(contacts: &[Contact<T>], frame: &WrenchFrame<T>, norm: Norm) -> Self {
        Wide { maps: contacts.iter().map(|c| (contact_map(c, frame), radii(c, frame))).collect(), norm }
    }

    /// Height and point of a contact.
    fn of((map, r): &([Vector<f64, 6>; 4], [f64; 3]), u: &Vector<f64, 6>) -> (f64, Vector<f64, 6>) {
        let g: Vec<f64> = map.iter().map(|column| column.dot(u)).collect();
        let friction = (0..3).map(|i| (r[i] * g[i + 1]).powi(2)).sum::<f64>().sqrt();
        let share = |i: usize| if friction > 0.0 { r[i] * r[i] * g[i + 1] / friction } else { 0.0 };
        (g[0] + friction, map[0] + map[1] * share(0) + map[2] * share(1) + map[3] * share(2))
    }
}

impl Support<f64, 6> for Wide {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        let found = self.maps.iter().map(|contact| Self::of(contact, u)).filter(|(h, _)| *h > 0.0);
        Ok(match self.norm {
            Norm::LInf => found.fold(Vector::zeros(), |sum, (_, p)| sum + p),
            Norm::L1 => found.reduce(|a, b| if b.0 > a.0 { b } else { a }).map_or(Vector::zeros(), |(_, p)| p),
        })
    }
    fn extent(&self) -> f64 {
        8.0
    }
}

fn pair<T: Real>(dice: &mut Dice, mus: f64) -> Vec<Contact<T>> {
    let (n, at) = (dice.direction::<3>(), dice.direction::<3>());
    let (apart, mu) = (dice.range(0.2, 1.5), dice.range(0.1, 1.0));
    let friction = Friction::Soft { mu: T::of(mu), mus: T::of(mus) };
    [1.0, -1.0]
        .map(|s| {
            let p = std::array::from_fn(|i| 0.3 * at[i] + s * apart * n[i]);
            Contact::new(vector(p), vector(n.map(|x| -s * x)), friction).unwrap()
        })
        .to_vec()
}

/// Random pairs, by a unit ball and by an ellipsoid, against the same in `f64` by the formulas of the paper. What is not told from 0 is so by the set's
/// margin alone.
fn two_soft_fingers<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let frame = WrenchFrame::new(Vector::zeros(), T::one()).unwrap();
    let semi = [1.0, 0.7, 0.5, 0.3, 0.2, 0.4];
    let mut told = 0;
    for case in 0..240 {
        // (The first cases are the one that was called flat, with d = 0.)
        let mus = match case % 4 {
            0 if case < 32 => 1e-6,
            0 | 1 => dice.decade(-5.0, -4.0),
            _ => dice.decade(-12.0, -2.0),
        };
        let (contacts, norm) = (pair::<T>(&mut dice, mus), [Norm::LInf, Norm::L1][case % 2]);
        let mut memory = vec![Primitive::empty(); contacts.len()];
        let set = WrenchSet::new(wrenches(&contacts, &frame, &mut memory).unwrap(), norm);
        let wide = Wide::new(&contacts, &frame, norm);
        let round = |semi: [f64; 6]| UnitEllipsoid::new(Vector::from(semi), SMatrix::identity()).unwrap();
        let stretched = UnitEllipsoid::new(vector::<T, 6>(semi), SMatrix::identity()).unwrap();
        let units: [(&dyn UnitSet<T, 6>, UnitEllipsoid<f64, 6>); 2] =
            [(&Ball::unit(), round([1.0; 6])), (&stretched, round(semi))];
        for ((q, wide_q), least) in units.into_iter().zip([1.0, 0.2]) {
            let answer = Workspace::<T, 6, 128, 1024>::new().solver().solve(&set, q, &options());
            let truth = Workspace::<f64, 6, 256, 2048>::new().solver().solve(&wide, &wide_q, &options());
            let (lower, upper) = (answer.lower.to_f64(), answer.upper.to_f64());
            let what = format!(
                "{case} {mus:e} {norm:?} [{lower:e}, {upper:e}] {:?}, not [{:e}, {:e}]",
                answer.outcome, truth.lower, truth.upper
            );
            assert!(lower <= truth.upper && truth.lower <= upper, "{what}");
            assert!(truth.lower > 0.0, "{what}");
            let rounding = T::count(16) * T::ROUNDOFF * Support::<T, 6>::extent(&set);
            let margin = (set.error() + rounding).to_f64() / answer.unit.to_f64();
            if answer.outcome == Outcome::Degenerate {
                assert!(lower <= 0.0 && truth.lower <= flat_at_most(&set, least), "{what} {margin:e}");
                assert!(upper <= truth.upper + 3.0 * margin, "{what} {margin:e}");
            }
            if truth.lower > 2.5 * margin {
                told += 1;
                assert!(lower > 0.0 && upper - lower < 0.05 * truth.upper + 4.0 * margin, "{what} {margin:e}");
            }
        }
    }
    assert!(told > 40, "{told}");
}

/// What d may be at most where a set is called flat: along the normal n of the flat, a point sticks out by 2 N u R of those before it at
/// most, as computed, so that h(n) + h(-n) <= 2 N u R + 2 m(n) and the smaller of both, d h_Q(n) or more, is half of it. `least` is less than h_Q(n).
fn flat_at_most<T: Real>(set: &dyn Support<T, 6>, least: f64) -> f64 {
    let (u, reach) = (T::ROUNDOFF.to_f64(), set.extent().to_f64());
    (set.error().to_f64() + 16.0 * u * reach + 6.0 * u * reach * 1.01) / least
}

/// The same pairs by a cross-polytope, against second-order cone programs in the contact forces: d is the least of 12 crossings, each by another solver.
fn two_soft_fingers_by_conic_programs<T: Real>(seed: u64) {
    let mut dice = Dice::new(seed);
    let frame = WrenchFrame::new(Vector::zeros(), T::one()).unwrap();
    let wide_frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let semi = [1.0, 0.75, 0.5, 0.25, 0.25, 0.5];
    let cross = CrossPolytope::new(vector::<T, 6>(semi)).unwrap();
    let (mut known, mut open) = (0, 0);
    for case in 0..60 {
        // (The first one is the one that was called flat, with d = 0.)
        let mus = if case < 8 { 1e-6 } else { dice.decade(-9.0, -2.0) };
        let (contacts, norm) = (pair::<T>(&mut dice, mus), [Norm::LInf, Norm::L1][case % 2]);
        let hand: Vec<_> = contacts.iter().map(|c| HandContact { contact: widened(c), jacobian: None }).collect();
        let corners = (0..12)
            .map(|k| Vector::<f64, 6>::from_fn(|i, _| if i == k / 2 { [semi[i], -semi[i]][k % 2] } else { 0.0 }));
        let crossings: Option<Vec<f64>> =
            corners.map(|q| socp::ray(&hand, &wide_frame, norm, &q).map(|(t, _)| t)).collect();
        let Some(d) = crossings.map(|list| list.into_iter().fold(f64::MAX, f64::min)) else { continue };
        known += 1;
        let mut memory = vec![Primitive::empty(); contacts.len()];
        let set = WrenchSet::new(wrenches(&contacts, &frame, &mut memory).unwrap(), norm);
        let answer = Workspace::<T, 6, 128, 1024>::new().solver().solve(&set, &cross, &options());
        let (lower, upper) = (answer.lower.to_f64(), answer.upper.to_f64());
        let what = format!("{case} {mus:e} {norm:?} [{lower:e}, {upper:e}] {:?}, not {d:e}", answer.outcome);
        assert!(lower <= d + 1e-10 && d - 1e-10 <= upper, "{what}");
        // h_Q of a unit vector is at least the least axis over root 6.
        let least = 0.25 / 6f64.sqrt();
        match answer.outcome {
            Outcome::Degenerate => assert!(lower <= 0.0 && d <= flat_at_most(&set, least), "{what}"),
            outcome => open += usize::from(lower <= 0.0 && outcome == Outcome::Precision),
        }
        // Half a margin more than what the first simplex asks of a width, along any direction.
        let margin = set.error().to_f64() + 16.0 * T::ROUNDOFF.to_f64() * set.extent().to_f64();
        if d * least > 4.5 * margin + 48.0 * T::ROUNDOFF.to_f64() * set.extent().to_f64() {
            assert!(lower > 0.0 && upper - lower <= 0.05 * d + 2.0 * margin / answer.unit.to_f64(), "{what}");
        }
    }
    assert!(known > 40, "{known}");
    let wide = T::ROUNDOFF.to_f64() > 1e-10;
    assert!(!wide || open > 4, "{open}");
}

/// The same contact, to the last bit.
fn widened<T: Real>(contact: &Contact<T>) -> Contact<f64> {
    let (mu, mus) = contact.friction().coefficients();
    let friction = Friction::Soft { mu: mu.to_f64(), mus: mus.to_f64() };
    let [o, t] = contact.tangents().map(|v| wide(&v));
    Contact::new(wide(contact.position()), wide(contact.normal()), friction).unwrap().with_tangents(o, t).unwrap()
}

#[test]
fn two_soft_fingers_by_conic_programs_f32() {
    two_soft_fingers_by_conic_programs::<f32>(3);
}

#[test]
fn two_soft_fingers_by_conic_programs_f64() {
    two_soft_fingers_by_conic_programs::<f64>(4);
}

/// The row: torsion of 1e-6 in `f32`. It was called flat, which says that d is 0; d is 1.9e-6.
#[test]
fn two_soft_fingers_that_hardly_twist_are_not_flat() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let axis = Vector::from([0.6, 0.64, 0.48]);
    let contact = |x: f32| Contact::new(axis * x, axis * -x, Friction::Soft { mu: 0.5, mus: 1e-6 }).unwrap();
    let contacts = [contact(1.0), contact(-1.0)];
    let mut memory = [Primitive::empty(); 2];
    let set = WrenchSet::new(wrenches(&contacts, &frame, &mut memory).unwrap(), Norm::LInf);
    let answer = Workspace::<f32, 6, 128, 1024>::new().solver().solve(&set, &Ball::unit(), &Options::default());
    assert_eq!(answer.outcome, Outcome::Precision);
    assert!(answer.lower <= 1.9e-6 && 2e-6 <= answer.upper && answer.upper - answer.lower < 1e-4);
}

fn options<T: Real>() -> Options<'static, T, 6> {
    Options { relative: T::of(1e-2), max_iterations: Some(3000), ..Options::default() }
}

#[test]
fn two_soft_fingers_f32() {
    two_soft_fingers::<f32>(1);
}

#[test]
fn two_soft_fingers_f64() {
    two_soft_fingers::<f64>(2);
}
