//! Gradients of d against central differences of d from cone programs in the contact forces; kinks are told.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use common::memory::Memory;
use grasp_common::socp::ray;
use grasp_common::vector;
use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, Friction, HandContact, Jacobian, Kink, Norm, Primitive, Refined, WrenchFrame, WrenchSet, active_wrenches,
    default_tolerance,
};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::{Options, Vector};

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
        let mut rows: [[f64; 8]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| dice.signed()));
        // The first joint presses, more or less along the normal.
        (0..4).for_each(|i| rows[i][0] = if i == 0 { 1.0 } else { 0.2 * rows[i][0] });
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
#[allow(clippy::large_enum_variant)] // a few at a time
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
        let mut changes = vec![Self::Position(dice.direction()), Self::Turn(dice.direction()), Self::Mu, Self::Cap];
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
fn d(
    grasp: &Grasp,
    frame: &WrenchFrame<f64>,
    norm: Norm,
    q: &dyn UnitSet<f64, 6>,
    near: &Vector<f64, 6>,
) -> Option<f64> {
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

fn unit_sets(dice: &mut Dice) -> Vec<(&'static str, Box<dyn UnitSet<f64, 6>>)> {
    let mut axes = || Vector::from_fn(|_, _| dice.range(0.5, 2.0));
    let (ellipsoid, half, semi, end) = (axes(), axes(), axes(), axes());
    let turn = SMatrix::from(dice.rotation::<6>());
    vec![
        ("ball", Box::new(Ball::unit())),
        ("ellipsoid", Box::new(UnitEllipsoid::new(ellipsoid, turn).unwrap())),
        ("box", Box::new(UnitBox::new(half).unwrap())),
        ("cross-polytope", Box::new(CrossPolytope::new(semi).unwrap())),
        ("segment", Box::new(Segment::new(end.component_mul(&Vector::from(dice.direction()))).unwrap())),
    ]
}

#[derive(Default, Debug)]
struct Tally {
    closed: usize,
    smooth: usize,
    compared: usize,
    jacobians: usize,
    unsolved: usize,
    worst: f64,
}

/// Random grasps, every kind of parameter of every contact.
fn compare(seed: u64, rounds: usize, relative: f64, joints: &dyn Fn(&mut Dice) -> Option<usize>) -> Tally {
    let mut dice = Dice::new(seed);
    let mut memory = Memory::new::<f64, 6>(4096, 4096);
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
        let (name, q) = unit_sets(&mut dice).swap_remove(round % 5);
        let options = Options { relative, ..Options::default() };
        let answer = memory.solver::<f64, 6>().solve(&set, &*q, &options);
        if !(answer.lower > 1e-3) {
            continue;
        }
        tally.closed += 1;
        let refined = Refined::new(&set, &*q, &answer);
        if let Some(kink) = refined.kink {
            println!("{round} {name} {norm:?} m {m} soft {soft}: {kink:?} [{} {}]", answer.lower, answer.upper);
            continue;
        }
        tally.smooth += 1;
        let u = refined.answer.direction;
        let Some(exact) = d(&grasp, &frame, norm, &*q, &u) else { continue };
        assert!((exact - refined.answer.upper).abs() < 1e-9 * exact, "{round} {name} {norm:?}");
        assert!(refined.answer.upper <= answer.upper && refined.answer.lower == answer.lower);
        assert!((refined.answer.support - q.mapping(&u).unwrap() * exact).norm() < 1e-7 || q.vertex_count() > 0);
        let mut by_caps = 0.0;
        let mut pairs = Vec::new();
        for (i, numbers) in numbers.iter().enumerate() {
            let gradient = refined.gradient(i, &grasp[i], &frame, default_tolerance()).unwrap().unwrap();
            by_caps += gradient.force_cap * numbers.cap;
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
                // Central differences with Richardson's extrapolation; the step that agrees best with twice itself.
                let mut best = (f64::MAX, 0.0);
                for h in [1e-4, 3e-4, 2e-5] {
                    let at = |h: f64| {
                        let mut new = grasp.clone();
                        new[i] = change.apply(numbers, h).contact();
                        d(&new, &frame, norm, &*q, &u)
                    };
                    let [Some(a), Some(b), Some(c), Some(e)] = [at(h), at(-h), at(2.0 * h), at(-2.0 * h)] else {
                        continue;
                    };
                    let (fine, coarse) = ((a - b) / (2.0 * h), (c - e) / (4.0 * h));
                    if (fine - coarse).abs() < best.0 {
                        best = ((fine - coarse).abs(), (4.0 * fine - coarse) / 3.0);
                    }
                    if best.0 < 1e-6 {
                        break;
                    }
                }
                if best.0 > 1e-4 {
                    tally.unsolved += 1;
                    continue;
                }
                tally.jacobians += usize::from(matches!(change, Change::Jacobian(_)) && value != 0.0);
                pairs.push((i, change, value, best.1));
            }
        }
        // d is proportional to all caps together.
        assert!((by_caps - exact).abs() < 1e-9 * exact, "{by_caps} {exact}");
        let scale = pairs.iter().fold(1e-3, |m: f64, p| m.max(p.2.abs()));
        for (i, change, value, difference) in pairs {
            let off = (value - difference).abs() / scale;
            tally.compared += 1;
            tally.worst = tally.worst.max(off);
            assert!(off < 1e-5, "{round} {name} {norm:?} contact {i} {change:?}: {value} {difference} of {scale}");
        }
    }
    println!("{tally:?}");
    tally
}

#[test]
fn passive_contacts() {
    let tally = compare(1, 60, 1e-2, &|_| None);
    assert!(tally.closed > 30 && tally.smooth == tally.closed && tally.compared > 600 && tally.unsolved < 100);
    let tally = compare(3, 60, 1e-4, &|_| None);
    assert!(tally.closed > 30 && tally.smooth == tally.closed && tally.compared > 600 && tally.unsolved < 100);
}

#[test]
fn active_contacts() {
    let tally = compare(2, 150, 1e-2, &|dice| Some(dice.pick(&[1, 2, 3, 3, 4, 5])).filter(|_| dice.chance(0.8)));
    assert!(tally.closed > 30 && 10 * tally.smooth >= 9 * tally.closed && tally.jacobians > 50);
}

fn soft(p: [f64; 3], n: [f64; 3]) -> HandContact<f64> {
    let contact = Contact::new(Vector::from(p), Vector::from(n), Friction::Soft { mu: 0.2, mus: 0.2 }).unwrap();
    HandContact { contact, jacobian: None }
}

fn refined<'a>(primitives: &'a [Primitive<f64>], norm: Norm, q: &dyn UnitSet<f64, 6>) -> Refined<'a, f64> {
    let mut memory = Memory::new::<f64, 6>(4096, 4096);
    let set = WrenchSet::new(primitives, norm);
    let answer = memory.solver::<f64, 6>().solve_in_span(&set, q, &Options { relative: 1e-2, ..Options::default() });
    Refined::new(&set, q, &answer)
}

/// Mirror images have mirror minimisers, which are rivals, or minimisers on a circle.
#[test]
fn symmetric_grasps_have_kinks() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let (c, s) = (0.5, 0.75f64.sqrt());
    let pinch = [soft([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), soft([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0])];
    let three =
        [soft([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), soft([-c, s, 0.0], [c, -s, 0.0]), soft([-c, -s, 0.0], [c, s, 0.0])];
    let ball = Ball::unit();
    let boxed = UnitBox::new(Vector::repeat(1.0)).unwrap();
    for hand in [&pinch[..], &three[..]] {
        for norm in [Norm::L1, Norm::LInf] {
            for q in [&ball as &dyn UnitSet<f64, 6>, &boxed] {
                let mut out = [Primitive::empty(); 3];
                let primitives = active_wrenches(hand, &frame, default_tolerance(), &mut out).unwrap();
                let refined = refined(primitives, norm, q);
                assert!(refined.kink.is_some(), "{norm:?} {:?}", refined.answer.direction);
                assert_eq!(refined.share(0), None);
                assert_eq!(refined.gradient(0, &hand[0], &frame, default_tolerance()), Ok(None));
            }
        }
    }
}

/// Three planar fingers: W^a is flat, of forces in the plane and moments across. Its gradient against differences of d in the span, for changes
/// that keep it; and the same grasp turned in space, where the span is not one of coordinate axes.
#[test]
fn planar_fingers() {
    let planar = Jacobian::new([&[1.0, 0.4], &[0.3, 0.9], &[0.0, 0.0], &[0.0, 0.0]]).unwrap();
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let places = [(0.1, 1.0, 0.5, 0.1), (2.0, 0.8, 0.6, -0.2), (4.1, 1.2, 0.4, 0.15)];
    // Angle, radius, friction and tilt of the normal of each finger.
    let hand = |places: &[(f64, f64, f64, f64); 3], turn: &nalgebra::Rotation3<f64>| -> Grasp {
        let finger = |&(angle, radius, mu, tilt): &(f64, f64, f64, f64)| {
            let at = |a: f64| turn * Vector::from([a.cos(), a.sin(), 0.0]);
            let (n, z) = (-at(angle + tilt), turn * Vector::from([0.0, 0.0, 1.0]));
            let contact = Contact::new(at(angle) * radius, n, Friction::Soft { mu, mus: 0.2 }).unwrap();
            HandContact { contact: contact.with_tangents(z.cross(&n), z).unwrap(), jacobian: Some(planar) }
        };
        places.iter().map(finger).collect()
    };
    let still = nalgebra::Rotation3::identity();
    let ellipse = UnitEllipsoid::new(Vector::from([1.0, 1.3, 1.0, 1.0, 1.0, 0.7]), SMatrix::identity()).unwrap();
    for norm in [Norm::L1, Norm::LInf] {
        for q in [&Ball::unit() as &dyn UnitSet<f64, 6>, &ellipse] {
            let at = |places: &[(f64, f64, f64, f64); 3], turn: &nalgebra::Rotation3<f64>| {
                let hand = hand(places, turn);
                let mut out = [Primitive::empty(); 3];
                let primitives = active_wrenches(&hand, &frame, default_tolerance(), &mut out).unwrap();
                let refined = refined(primitives, norm, q);
                assert_eq!((refined.kink, refined.answer.dimension), (None, 3));
                let d = refined.set().value(&refined.answer.direction) / refined.answer.unit;
                // No direction of the plane is weaker.
                for i in 0..2000 {
                    let (z, a) = (1.0 - f64::from(i) / 1000.0, f64::from(i) * 2.4);
                    let r = (1.0 - z * z).max(0.0).sqrt();
                    let (f, m) =
                        (turn * Vector::from([r * a.cos(), r * a.sin(), 0.0]), turn * Vector::from([0.0, 0.0, z]));
                    let u = Vector::from([f.x, f.y, f.z, m.x, m.y, m.z]);
                    assert!(refined.set().value(&u) / q.value(&u).unwrap() >= d * (1.0 - 1e-12));
                }
                let gradients: Vec<_> = (0..3)
                    .map(|i| refined.gradient(i, &hand[i], &frame, default_tolerance()).unwrap().unwrap())
                    .collect();
                (d, gradients)
            };
            let (_, gradients) = at(&places, &still);
            for i in 0..3 {
                let (angle, radius, _, _) = places[i];
                let g = &gradients[i];
                let out = Vector::from([angle.cos(), angle.sin(), 0.0]);
                let along = Vector::from([-angle.sin(), angle.cos(), 0.0]) * radius;
                let expected = [g.position.dot(&along) + g.rotation.z, g.position.dot(&out), g.mu, g.rotation.z];
                for (k, expected) in expected.into_iter().enumerate() {
                    let change = |h: f64| {
                        let mut new = places;
                        let (angle, radius, mu, tilt) = &mut new[i];
                        *[angle, radius, mu, tilt][k] += h;
                        at(&new, &still).0
                    };
                    let h = 1e-5;
                    let difference = (change(h) - change(-h)) / (2.0 * h);
                    assert!((expected - difference).abs() < 1e-7, "{norm:?} {i} {k} {expected} {difference}");
                }
            }
            if q.ball_radius().is_some() {
                let turn = nalgebra::Rotation3::new(Vector::from([0.3, -1.1, 0.6]));
                let (_, turned) = at(&places, &turn);
                for (a, b) in gradients.iter().zip(&turned) {
                    assert!((turn * a.position - b.position).norm() < 1e-9 && (a.mu - b.mu).abs() < 1e-9);
                }
            }
        }
    }
}

/// A finger of two joints whose one force with a normal part is on the edge of the cone: d changes like a square root.
#[test]
fn an_active_set_about_to_open_has_no_gradient() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let edge = Jacobian::new([&[1.0], &[0.2], &[0.0], &[0.0]]).unwrap();
    let mut dice = Dice::new(8);
    let mut hand: Grasp = (0..5).map(|_| Numbers::random(&mut dice, true, None).contact()).collect();
    let x = hand[0].contact;
    let contact = Contact::new(*x.position(), *x.normal(), Friction::Soft { mu: 0.2, mus: 0.1 }).unwrap();
    hand.push(HandContact { contact, jacobian: Some(edge) });
    let mut out = [Primitive::empty(); 6];
    let primitives = active_wrenches(&hand, &frame, default_tolerance(), &mut out).unwrap();
    let refined = refined(primitives, Norm::LInf, &Ball::unit());
    assert_eq!(refined.kink, None);
    assert_eq!(refined.gradient(5, &hand[5], &frame, default_tolerance()), Ok(None));
    assert!(refined.gradient(0, &hand[0], &frame, default_tolerance()).unwrap().is_some());
    assert_eq!(refined.gradient(6, &hand[5], &frame, default_tolerance()), Ok(None));
    assert!(refined.gradient(0, &hand[5], &frame, 0.0).is_err());
}

/// Not closed, or not solved: an answer without a gradient. And `f32` comes near `f64`.
#[test]
fn other_answers() {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let hand = [soft([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0])];
    let mut out = [Primitive::empty(); 1];
    let open =
        refined(active_wrenches(&hand, &frame, default_tolerance(), &mut out).unwrap(), Norm::LInf, &Ball::unit());
    assert_eq!(open.kink, Some(Kink::NotClosed));

    let mut dice = Dice::new(5);
    let mut compared = 0;
    for _ in 0..20 {
        let hand: Grasp = (0..4).map(|_| Numbers::random(&mut dice, true, None).contact()).collect();
        let mut out = [Primitive::empty(); 4];
        let wide =
            refined(active_wrenches(&hand, &frame, default_tolerance(), &mut out).unwrap(), Norm::LInf, &Ball::unit());
        let narrow: Vec<Primitive<f32>> = wide
            .set()
            .contributions()
            .iter()
            .map(|p| {
                let (center, disc) = (p.center().map(|x| x as f32), p.disc().map(|x| x as f32));
                Primitive::new(center, disc).unwrap()
            })
            .collect();
        let set = WrenchSet::new(&narrow, Norm::LInf);
        let mut memory = Memory::new::<f32, 6>(4096, 4096);
        let answer =
            memory.solver::<f32, 6>().solve(&set, &Ball::unit(), &Options { relative: 1e-2, ..Options::default() });
        let narrow = Refined::new(&set, &Ball::unit(), &answer);
        if wide.kink.is_none() && narrow.kink.is_none() {
            compared += 1;
            assert!((wide.answer.upper - f64::from(narrow.answer.upper)).abs() < 1e-3 * wide.answer.upper);
            let ratio = set.value(&narrow.answer.direction) / narrow.answer.unit;
            assert!((wide.answer.upper - f64::from(ratio)).abs() < 1e-5 * wide.answer.upper);
            for i in 0..4 {
                let (a, b) = (wide.share(i).unwrap(), narrow.share(i).unwrap());
                assert!((a.weight - f64::from(b.weight)).abs() < 1e-2, "{a:?} {b:?}");
            }
        }
    }
    assert!(compared > 8, "{compared}");
}

/// Neither units nor the size of the grasp matter: millimetres, millinewtons, and forces near the ends of the format.
#[test]
fn units() {
    let mut dice = Dice::new(6);
    let mut closed = 0;
    for round in 0..20 {
        let numbers: Vec<Numbers> = (0..4).map(|_| Numbers::random(&mut dice, round % 2 == 0, None)).collect();
        let gradients = |length: f64, force: f64| {
            let frame = WrenchFrame::new(Vector::zeros(), length).unwrap();
            let hand: Grasp = numbers
                .iter()
                .map(|n| {
                    let (mu, mus) = n.friction.coefficients();
                    let friction = match n.friction {
                        Friction::Soft { .. } => Friction::Soft { mu, mus: mus * length },
                        _ => n.friction,
                    };
                    Numbers { p: n.p * length, cap: n.cap * force, friction, ..*n }.contact()
                })
                .collect();
            let mut out = [Primitive::empty(); 4];
            let primitives = active_wrenches(&hand, &frame, default_tolerance(), &mut out).unwrap();
            let refined = refined(primitives, Norm::LInf, &Ball::unit());
            hand.iter()
                .enumerate()
                .map(|(i, h)| refined.gradient(i, h, &frame, default_tolerance()).unwrap())
                .collect::<Option<Vec<_>>>()
        };
        let (Some(a), Some(b)) = (gradients(1.0, 1.0), gradients(1e3, 1e6)) else { continue };
        for force in [1e-100, 1e100] {
            let c = gradients(1.0, force).unwrap();
            a.iter().zip(&c).for_each(|(a, c)| assert!((a.mu - c.mu / force).abs() < 1e-8));
        }
        closed += 1;
        for (a, b) in a.iter().zip(&b) {
            assert!((a.position - b.position * 1e-3).norm() < 1e-8, "{} {}", a.position, b.position);
            assert!((a.rotation - b.rotation * 1e-6).norm() < 1e-8);
            assert!((a.mu - b.mu * 1e-6).abs() < 1e-8 && (a.mus - b.mus * 1e-3).abs() < 1e-8);
            assert!((a.force_cap - b.force_cap).abs() < 1e-8);
        }
    }
    assert!(closed > 8, "{closed}");
}
