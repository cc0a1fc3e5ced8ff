//! Gradients of d against central differences of d from cone programs in the contact forces; kinks are told.
#![cfg(feature = "grasp")]

mod common;
mod grasp_common;

use common::dice::Dice;
use grasp_common::socp::ray;
use grasp_common::vector;
use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, Friction, HandContact, Jacobian, Kink, Norm, Primitive, Refined, WrenchFrame, WrenchSet, active_wrenches,
    default_tolerance,
};
use qdist::qset::{Ball, BoxGauge, CrossPolytope, EllipsoidGauge, Gauge, Segment};
use qdist::{Options, Vector, Workspace};

type Grasp = Vec<HandContact<f64>>;

/// One contact by its numbers, which may be changed one by one.
#[derive(Clone, Copy)]
struct Numbers {
    p: Vector<f64, 3>,
    axes: [Vector<f64, 3>; 3],
    friction: Friction<f64>,
    cap: f64,
    rows: [[f64; 8]; 4],
    joints: Option<usize>,
}

impl Numbers {
    fn random(dice: &mut Dice, soft: bool, joints: Option<usize>) -> Self {
        let p: Vector<f64, 3> = Vector::from(dice.direction::<3>()) * dice.range(0.7, 1.3);
        let n = (-p.normalize() + Vector::from(dice.direction::<3>()) * 0.3).normalize();
        let o = n.cross(&Vector::from(dice.direction::<3>())).normalize();
        let mu = dice.range(0.3, 1.0);
        let friction = if soft { Friction::Soft { mu, mus: dice.range(0.1, 0.5) } } else { Friction::Hard { mu } };
        let rows = std::array::from_fn(|_| std::array::from_fn(|_| dice.signed()));
        Self { p, axes: [n, o, n.cross(&o)], friction, cap: dice.range(0.5, 2.0), rows, joints }
    }

    fn contact(&self) -> HandContact<f64> {
        let [n, o, t] = self.axes;
        let contact = Contact::new(self.p, n, self.friction).unwrap();
        let contact = contact.with_tangents(o, t).unwrap().with_force_cap(self.cap).unwrap();
        let jacobian = self.joints.map(|q| Jacobian::new([0, 1, 2, 3].map(|i| &self.rows[i][..q])).unwrap());
        HandContact { contact, jacobian }
    }
}

/// What is changed, and along what.
#[derive(Clone, Copy, Debug)]
enum Change {
    Position([f64; 3]),
    Turn([f64; 3]),
    Mu,
    Mus,
    Cap,
    Jacobian([[f64; 8]; 4]),
}

impl Change {
    fn all(dice: &mut Dice, numbers: &Numbers) -> Vec<Self> {
        let mut changes = vec![
            Self::Position(dice.direction()),
            Self::Turn(dice.direction()),
            Self::Mu,
            Self::Cap,
        ];
        if let Friction::Soft { .. } = numbers.friction {
            changes.push(Self::Mus);
        }
        if numbers.joints.is_some() {
            changes.push(Self::Jacobian(std::array::from_fn(|_| dice.direction())));
        }
        changes
    }

    fn apply(&self, numbers: &Numbers, h: f64) -> Numbers {
        let mut new = *numbers;
        let (mu, mus) = numbers.friction.coefficients();
        let friction = |mu, mus| match numbers.friction {
            Friction::Soft { .. } => Friction::Soft { mu, mus },
            _ => Friction::Hard { mu },
        };
        match self {
            Self::Position(by) => new.p += Vector::from(*by) * h,
            Self::Turn(axis) => {
                let turn = nalgebra::Rotation3::new(Vector::from(*axis) * h);
                new.axes = numbers.axes.map(|a| turn * a);
            }
            Self::Mu => new.friction = friction(mu + h, mus),
            Self::Mus => new.friction = friction(mu, mus + h),
            Self::Cap => new.cap += h,
            Self::Jacobian(by) => (0..4).for_each(|i| (0..8).for_each(|j| new.rows[i][j] += h * by[i][j])),
        }
        new
    }
}

/// d near a direction: for a polytope the ray along its vertex, for others the polar iteration. Richardson's
/// extrapolation is not needed: d is stationary there.
fn d(grasp: &Grasp, frame: &WrenchFrame<f64>, norm: Norm, q: &dyn Gauge<f64, 6>, near: &Vector<f64, 6>) -> Option<f64> {
    let mut u = *near;
    let mut best = f64::MAX;
    for _ in 0..200 {
        let point = q.mapping(&u)?;
        let (t, normal) = ray(grasp, frame, norm, &point)?;
        if q.vertex_count() > 0 {
            return Some(t);
        }
        let value = t * point.dot(&normal) / q.value(&normal).ok()?;
        u = normal;
        if value > best - 1e-13 * best {
            return Some(best.min(value));
        }
        best = value;
    }
    Some(best)
}

fn gauges(dice: &mut Dice) -> Vec<(&'static str, Box<dyn Gauge<f64, 6>>)> {
    let mut axes = || Vector::from_fn(|_, _| dice.range(0.5, 2.0));
    let (ellipsoid, half, semi, end) = (axes(), axes(), axes(), axes());
    let turn = SMatrix::from(dice.rotation::<6>());
    vec![
        ("ball", Box::new(Ball::unit())),
        ("ellipsoid", Box::new(EllipsoidGauge::new(ellipsoid, turn).unwrap())),
        ("box", Box::new(BoxGauge::new(half).unwrap())),
        ("cross-polytope", Box::new(CrossPolytope::new(semi).unwrap())),
        ("segment", Box::new(Segment::new(end.component_mul(&Vector::from(dice.direction()))).unwrap())),
    ]
}

#[derive(Default, Debug)]
struct Tally {
    closed: usize,
    smooth: usize,
    degenerate: usize,
    compared: usize,
    worst: f64,
}

/// Random grasps, every kind of parameter of every contact.
fn compare(seed: u64, rounds: usize, relative: f64, joints: &dyn Fn(&mut Dice) -> Option<usize>) -> Tally {
    let mut dice = Dice::new(seed);
    let mut memory = Workspace::<f64, 6, 4096, 4096>::new();
    let mut tally = Tally::default();
    for round in 0..rounds {
        let m = 3 + dice.below(3);
        let frame = WrenchFrame::new(vector(dice.direction::<3>().map(|x| 0.2 * x)), dice.range(0.5, 2.0)).unwrap();
        let soft = dice.chance(0.6);
        let numbers: Vec<Numbers> = (0..m)
            .map(|_| {
                let joints = joints(&mut dice);
                Numbers::random(&mut dice, soft, joints)
            })
            .collect();
        let grasp: Grasp = numbers.iter().map(Numbers::contact).collect();
        let mut out = [Primitive::empty(); 8];
        let primitives = active_wrenches(&grasp, &frame, default_tolerance(), &mut out).unwrap();
        let norm = dice.pick(&[Norm::L1, Norm::LInf]);
        let set = WrenchSet::new(primitives, norm);
        let (name, q) = gauges(&mut dice).swap_remove(round % 5);
        let options = Options { relative, ..Options::default() };
        let answer = memory.solver().solve(&set, &*q, &options);
        if !(answer.lower > 1e-3) {
            continue;
        }
        tally.closed += 1;
        let refined = Refined::new(&set, &*q, &answer);
        if let Some(kink) = refined.kink {
            println!("{round} {name} {norm:?} m {m} soft {soft}: {kink:?} {:?} [{} {}]", answer.outcome, answer.lower, answer.upper);
            for (i, p) in set.contributions().iter().enumerate() { let u = &answer.direction; println!("   {i} h {:.3e} tip {:.3e}", p.value(u), p.disc().tr_mul(u).norm()); }
            let mut v = answer.direction;
            for _ in 0..100 { let (t, n) = ray(&grasp, &frame, norm, &q.mapping(&v).unwrap()).unwrap(); v = n; if q.vertex_count() > 0 { println!("t {t}"); break; } }
            println!("polar {} of {}", set.value(&v)/q.value(&v).unwrap(), answer.upper);
            for (i, p) in set.contributions().iter().enumerate() { let u = &v; println!("   {i} h {:.3e} tip {:.3e}", p.value(u), p.disc().tr_mul(u).norm()); }
            tally.degenerate += 1;
            continue;
        }
        tally.smooth += 1;
        let u = refined.answer.direction;
        let exact = d(&grasp, &frame, norm, &*q, &u).unwrap();
        if (exact - refined.answer.upper).abs() > 1e-9 * exact {
            println!("VALUE {round} {:?} {}", q.mapping(&u), set.value(&u)/q.value(&u).unwrap());
            println!("{:?}", (q.mapping(&answer.direction), answer.upper, answer.lower, ray(&grasp,&frame,norm,&q.mapping(&u).unwrap())));
            continue;
        }
        assert!((exact - refined.answer.upper).abs() < 1e-9 * exact, "{round} {name} {norm:?}: {exact} {}", refined.answer.upper);
        let mut pairs = Vec::new();
        for (i, numbers) in numbers.iter().enumerate() {
            let gradient = refined.gradient(i, &grasp[i], &frame, default_tolerance()).unwrap().unwrap();
            for change in Change::all(&mut dice, numbers) {
                let value = match change {
                    Change::Position(by) => gradient.position.dot(&Vector::from(by)),
                    Change::Turn(axis) => gradient.rotation.dot(&Vector::from(axis)),
                    Change::Mu => gradient.mu,
                    Change::Mus => gradient.mus,
                    Change::Cap => gradient.force_cap,
                    Change::Jacobian(by) => match gradient.jacobian {
                        None => continue,
                        Some(g) => (0..4).map(|i| (0..8).map(|j| g[i][j] * by[i][j]).sum::<f64>()).sum(),
                    },
                };
                let h = 1e-4;
                let at = |h: f64| {
                    let mut new = grasp.clone();
                    new[i] = change.apply(numbers, h).contact();
                    d(&new, &frame, norm, &*q, &u)
                };
                let ends = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)];
                let [Some(a), Some(b), Some(c), Some(e)] = ends else { continue };
                // A kink between the samples: the differences disagree, and say nothing.
                let (fine, coarse) = ((a - b) / (2.0 * h), (c - e) / (4.0 * h));
                let bent = ((a - exact) - (exact - b)).abs() / h > 1e-2 && ((c - exact) - (exact - e)).abs() / h > 1e-2;
                if bent || (fine - coarse).abs() > 1e-5 {
                    println!("{round} {name} {norm:?} contact {i} {change:?}: bent {bent} {fine} {coarse} ours {value}");
                }
                pairs.push((i, change, value, (4.0 * fine - coarse) / 3.0));
            }
        }
        let scale = pairs.iter().fold(1e-3, |m: f64, p| m.max(p.2.abs()));
        for (i, change, value, difference) in pairs {
            let off = (value - difference).abs() / scale;
            tally.compared += 1;
            tally.worst = tally.worst.max(off);
            if off > 1e-5 { println!("OFF {round} {name} {norm:?} contact {i} soft {soft} {change:?}: {value} {difference} scale {scale}"); }
        }
    }
    println!("{tally:?}");
    tally
}

#[test]
fn passive() {
    for relative in [1e-2, 1e-3, 1e-4] {
        let tally = compare(1, 60, relative, &|_| None);
        assert!(tally.smooth > 20);
    }
}

#[test]
fn active() {
    for relative in [1e-2, 1e-3] {
        let tally = compare(2, 100, relative, &|dice| Some(dice.pick(&[2, 3, 3, 4, 5])).filter(|_| dice.chance(0.8)));
        assert!(tally.smooth > 20);
    }
}
