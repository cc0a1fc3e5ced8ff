//! Grasps that are nearly flat: two soft fingers that hardly resist torsion. Their wrench sets reach as far as the friction torque along one axis, and a
//! million times as far along the others.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use grasp_common::{contact_map, radii, vector};
use nalgebra::SMatrix;
use qdist::grasp::{Contact, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::qset::{Ball, EllipsoidGauge, Gauge};
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
        let round = |semi: [f64; 6]| EllipsoidGauge::new(Vector::from(semi), SMatrix::identity()).unwrap();
        let stretched = EllipsoidGauge::new(vector::<T, 6>(semi), SMatrix::identity()).unwrap();
        let gauges: [(&dyn Gauge<T, 6>, EllipsoidGauge<f64, 6>); 2] =
            [(&Ball::unit(), round([1.0; 6])), (&stretched, round(semi))];
        for (q, wide_q) in gauges {
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
            let margin = (set.error() + rounding).to_f64() / answer.gauge.to_f64();
            if answer.outcome == Outcome::Degenerate {
                assert!(lower <= 0.0 && truth.lower < 2.5 * margin, "{what} {margin:e}");
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

fn options<T: Real>() -> Options<T, 6> {
    Options { relative: T::of(1e-2), max_iterations: 3000, ..Options::default() }
}

#[test]
fn two_soft_fingers_f32() {
    two_soft_fingers::<f32>(1);
}

#[test]
fn two_soft_fingers_f64() {
    two_soft_fingers::<f64>(2);
}
