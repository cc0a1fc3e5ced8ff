//! d_Q of grasps, where all plans are at work in six dimensions: budgets, capacities and thresholds of any size, stiff numbers,
//! the shared grasps with their reference values, gradients. The truth is that of the paper's formulas in plain `f64` for the numbers
//! as they were rounded.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use common::memory::{Memory, Seen, broken_promise};
use grasp_common::{recorded, value, vector, wide};
use nalgebra::SMatrix;
use qdist::grasp::{Contact, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{Failure, Rigid, Support};
use qdist::{Answer, Options, Outcome, Plan, Real, Vector};
use serde_json::Value;
use std::cell::Cell;

/// A grasp in scalar type T.
struct Grasp<T: Real> {
    contacts: Vec<Contact<T>>,
    frame: WrenchFrame<T>,
    primitives: Vec<Primitive<T>>,
    norm: Norm,
}

impl<T: Real> Grasp<T> {
    fn new(contacts: Vec<Contact<T>>, torque_scale: f64, norm: Norm) -> Self {
        let frame = WrenchFrame::new(Vector::zeros(), T::of(torque_scale)).unwrap();
        let mut memory = vec![Primitive::empty(); contacts.len()];
        let primitives = wrenches(&contacts, &frame, &mut memory).unwrap().to_vec();
        Grasp { contacts, frame, primitives, norm }
    }

    fn set(&self) -> WrenchSet<'_, T> {
        WrenchSet::new(&self.primitives, self.norm)
    }

    /// h_W(u) by the formulas.
    fn height(&self, u: &Vector<f64, 6>) -> f64 {
        let values = self.contacts.iter().map(|c| value(c, &self.frame, u).max(0.0));
        match self.norm {
            Norm::L1 => values.fold(0.0, f64::max),
            Norm::LInf => values.sum(),
        }
    }

    /// The error of `height`: some roundoffs of all forces.
    fn blur(&self) -> f64 {
        1e-14 * self.primitives.iter().map(|p| p.extent().to_f64()).sum::<f64>()
    }
}

/// Contacts all around the unit ball, the fingertips pressing inwards.
fn contacts<T: Real>(dice: &mut Dice, count: usize, mu: f64, mus: f64) -> Vec<Contact<T>> {
    (0..count)
        .map(|i| {
            // Three around the equator, so that most grasps hold.
            let angle = std::f64::consts::TAU * i as f64 / count as f64;
            let p = [angle.cos() + 0.3 * dice.signed(), angle.sin() + 0.3 * dice.signed(), 0.6 * dice.signed()];
            let l = p.iter().map(|x| x * x).sum::<f64>().sqrt();
            let n = p.map(|x| -x / l + 0.1 * dice.signed());
            let l = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            touch(p, n.map(|x| x / l), mu, mus)
        })
        .collect()
}

fn touch<T: Real>(p: [f64; 3], n: [f64; 3], mu: f64, mus: f64) -> Contact<T> {
    Contact::new(vector(p), vector(n), Friction::Soft { mu: T::of(mu), mus: T::of(mus) }).unwrap()
}

/// Q and its support function in `f64`.
enum Task {
    Ball,
    Ellipsoid([f64; 6]),
    Box([f64; 6]),
}

impl Task {
    fn value<T: Real>(&self, u: &Vector<f64, 6>) -> f64 {
        let scaled = |s: &[f64; 6]| Vector::<f64, 6>::from_fn(|i, _| T::of(s[i]).to_f64() * u[i]);
        match self {
            Task::Ball => u.norm(),
            Task::Ellipsoid(s) => scaled(s).norm(),
            Task::Box(s) => scaled(s).abs().sum(),
        }
    }

    fn unit<T: Real>(&self) -> Box<dyn UnitSet<T, 6>> {
        match self {
            Task::Ball => Box::new(Ball::unit()),
            Task::Ellipsoid(s) => Box::new(UnitEllipsoid::new(vector(*s), SMatrix::identity()).unwrap()),
            Task::Box(s) => Box::new(UnitBox::new(vector(*s)).unwrap()),
        }
    }
}

/// The set is its own mirror image, and does not say so.
struct Silent<'a, T: Real>(WrenchSet<'a, T>);

impl<T: Real> Support<T, 6> for Silent<'_, T> {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        self.0.support(u)
    }
    fn extent(&self) -> T {
        self.0.extent()
    }
    fn error(&self) -> T {
        self.0.error()
    }
    fn extents(&self) -> Vector<T, 6> {
        self.0.extents()
    }
    fn errors(&self) -> Vector<T, 6> {
        self.0.errors()
    }
    fn contains_origin(&self) -> bool {
        true
    }
}

/// The promises; the direction proves the upper bound; no direction of a search contradicts the lower one. Returns the least
/// quotient that was found.
fn check<T: Real>(
    what: &str,
    answer: &Answer<T, 6>,
    options: &Options<'_, T, 6>,
    size: (usize, usize),
    quotient: impl Fn(&Vector<f64, 6>) -> f64,
    blur: f64,
    dice: &mut Dice,
) -> f64 {
    let seen = Seen::from(answer);
    let tell =
        || format!("{what}, u = {:.0e}, {size:?}, {options:?}: {seen:?} {:?}", T::ROUNDOFF.to_f64(), answer.plan);
    assert_eq!(broken_promise(&seen, options, size.0, size.1), None, "{}", tell());
    assert!(seen.outcome != Outcome::SupportFailed, "{}", tell());
    let u = wide(&answer.direction);
    let mut best = (f64::MAX, u);
    if seen.upper < T::HUGE.to_f64() {
        let proved = quotient(&u);
        assert!(proved <= seen.upper + blur, "{proved:e} is what the direction proves: {}", tell());
        best = (proved, u);
    }
    // A walk downhill.
    let mut step = 0.3;
    while step > 1e-4 {
        let mut improved = false;
        for _ in 0..6 {
            let by = Vector::from(dice.direction::<6>()) * step;
            let v = (best.1 + by).normalize();
            let q = quotient(&v);
            if q < best.0 {
                (best, improved) = ((q, v), true);
            }
        }
        if !improved {
            step *= 0.3;
        }
    }
    assert!(seen.lower <= best.0 + blur, "{:e} along {} contradicts {}", best.0, best.1.transpose(), tell());
    best.0
}

/// Four points of one contact's disc span the disc's space: a fifth makes slivers, the surface touches itself, and facets share several ridges
/// with one neighbour. That is no reason to stop.
#[test]
fn surfaces_that_touch_themselves_still_converge() {
    let mut dice = Dice::new(73);
    let options = Options { relative: 1e-3, ..Options::default() };
    let mut held = 0;
    for round in 0..600 {
        let grasp = Grasp::<f64>::new(contacts(&mut dice, 5, 0.6, 0.3), 1.0, Norm::L1);
        let mut memory = Memory::new::<f64, 6>(256, 4096);
        let answer = memory.solver::<f64, 6>().solve(&grasp.set(), &Ball::unit(), &options);
        if answer.upper > 1e-3 {
            assert_eq!(answer.outcome, Outcome::Converged, "grasp {round}: [{:e}, {:e}]", answer.lower, answer.upper);
            held += 1;
        }
    }
    assert!(held > 500);
}

/// Iterations, capacities and thresholds of any size; interrupts at the same places; with symmetry told and not told.
fn budgets<T: Real>() {
    let mut dice = Dice::new(71);
    let mut above = 0;
    for round in 0..20 {
        let count = 3 + round % 3;
        let norm = if round % 2 == 0 { Norm::LInf } else { Norm::L1 };
        // Every fourth is an object with a plane of symmetry.
        let list = if round % 4 == 3 {
            vec![
                touch([-0.75, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5, 0.2),
                touch([1.25, 0.25, 0.0], [-1.0, 0.0, 0.0], 0.5, 0.2),
                touch([1.25, -0.25, 0.0], [-1.0, 0.0, 0.0], 0.5, 0.2),
            ]
        } else {
            contacts::<T>(&mut dice, count, 0.6, 0.3)
        };
        let grasp = Grasp::new(list, 1.0, norm);
        let task = match round % 3 {
            0 => Task::Ball,
            1 => Task::Ellipsoid([2.0, 1.0, 1.0, 0.5, 1.0, 1.0]),
            _ => Task::Box([1.0, 1.0, 1.0, 0.5, 0.5, 0.5]),
        };
        let (set, unit) = (grasp.set(), task.unit::<T>());
        let quotient = |u: &Vector<f64, 6>| grasp.height(u) / task.value::<T>(u);
        let blur = grasp.blur();
        let (mut lower, mut upper) = (f64::MIN, f64::MAX);
        for size in [(18, 24), (40, 100), (100, 512), (7, 12)] {
            let mut limit = 0;
            let mut best = (f64::MIN, f64::MAX);
            while limit < 1200 {
                limit += 1 + dice.below(5 + limit as usize) as u32;
                let o = Options { max_iterations: Some(limit), relative: T::of(1e-2), ..Options::default() };
                let mut memory = Memory::new::<T, 6>(size.0, size.1);
                let answer = memory.solver::<T, 6>().solve(&set, &*unit, &o);
                let what = format!("grasp {round}");
                let found = check(&what, &answer, &o, size, quotient, blur, &mut dice);
                let seen = Seen::from(&answer);
                (lower, upper) = (lower.max(seen.lower), upper.min(found.min(seen.upper)));
                assert!(lower <= upper + blur, "{what} {size:?} {limit}: {lower:e} and {upper:e}, {seen:?}");
                let rounding = 4096.0 * T::ROUNDOFF.to_f64();
                assert!(
                    seen.lower >= best.0 - rounding && seen.upper <= best.1 + rounding,
                    "{what} {size:?} got worse at {limit}: {best:?} {seen:?}"
                );
                best = (best.0.max(seen.lower), best.1.min(seen.upper));
                // The same as an interrupt, by a set that does not tell its symmetry if it has one.
                let asked = Cell::new(0);
                let stop = || {
                    asked.set(asked.get() + 1);
                    asked.get() > limit
                };
                let free = Options { max_iterations: None, interrupt: Some(&stop), ..o };
                let cut = memory.solver::<T, 6>().solve(&Silent(set), &*unit, &free);
                check(&what, &cut, &free, size, quotient, blur, &mut dice);
                assert!(cut.iterations <= limit, "{what} {limit} {}", cut.iterations);
                if round % 4 != 3 {
                    let ended =
                        if answer.outcome == Outcome::Iterations { Outcome::Interrupted } else { answer.outcome };
                    assert_eq!(
                        (cut.outcome, cut.lower, cut.upper),
                        (ended, answer.lower, answer.upper),
                        "{what} {size:?} {limit} {seen:?}"
                    );
                }
                // A threshold near what is known of d.
                let near = T::of(0.5 * (lower.max(0.0) + upper) * (1.0 + dice.pick(&[0.0, 0.1, -0.1, 0.5, -0.5])));
                let asked = Options { threshold: Some(near), ..o };
                let answer = memory.solver::<T, 6>().solve(&set, &*unit, &asked);
                check(&what, &answer, &asked, size, quotient, blur, &mut dice);
                let near = near.to_f64();
                match answer.outcome {
                    Outcome::Above => assert!(near <= upper + blur, "{what} {near} {upper}"),
                    Outcome::Below => assert!(near > lower - blur, "{what} {near} {lower}"),
                    _ => {}
                }
                above += usize::from(answer.outcome == Outcome::Above);
                if seen.outcome != Outcome::Iterations {
                    break;
                }
            }
        }
    }
    assert!(above > 5, "{above}");
}

#[test]
fn budgets_of_any_size_in_f64() {
    budgets::<f64>();
}

#[test]
fn budgets_of_any_size_in_f32() {
    budgets::<f32>();
}

/// Torque scales, friction, axis ratios and contacts that nearly coincide. Required: the bracket is true and the run bounded;
/// and where the numbers are not extreme, it converges.
fn stiff<T: Real>() {
    let mut dice = Dice::new(72);
    let size = (150, 1500);
    let mut memory = Memory::new::<T, 6>(size.0, size.1);
    let (mut converged, mut all) = (0, 0);
    for round in 0..140 {
        let (mut scale, mut mu, mut mus) = (1.0, 0.6, 0.3);
        let mut task = if round % 2 == 0 { Task::Ball } else { Task::Ellipsoid([1.0, 2.0, 1.0, 0.5, 1.0, 0.5]) };
        let mut near = 0.0;
        match round % 7 {
            0 => scale = dice.pick(&[1e-3, 1e-2, 1e2, 1e3]),
            1 => mu = dice.pick(&[1e-6, 1e-3, 10.0]),
            2 => mus = dice.pick(&[1e-6, 1e-3, 10.0]),
            3 => task = Task::Ellipsoid([1.0, 1e-6, 1.0, 1.0, 1e-3, 1.0]),
            4 => task = Task::Ellipsoid(std::array::from_fn(|_| dice.decade(-3.0, 3.0))),
            5 => near = dice.pick(&[1e-3, 1e-5, 1e-7, 1e-9]),
            _ => {
                scale = dice.decade(-3.0, 3.0);
                mu = dice.decade(-6.0, 1.0);
                near = dice.decade(-9.0, -3.0);
                task = Task::Box(std::array::from_fn(|_| dice.decade(-3.0, 3.0)));
            }
        }
        let mut list = contacts::<T>(&mut dice, 4, mu, mus);
        if near > 0.0 {
            let (p, n) = (wide(list[0].position()), wide(list[0].normal()));
            list.push(touch(std::array::from_fn(|i| p[i] + near * dice.signed()), n.into(), mu, mus));
        }
        let grasp = Grasp::new(list, scale, if round % 3 == 0 { Norm::L1 } else { Norm::LInf });
        let (set, unit) = (grasp.set(), task.unit::<T>());
        let quotient = |u: &Vector<f64, 6>| grasp.height(u) / task.value::<T>(u);
        let o = Options { relative: T::of(0.02), max_iterations: Some(1500), ..Options::default() };
        let answer = memory.solver::<T, 6>().solve(&set, &*unit, &o);
        // In units of Q, that the blur of a height is.
        let u = wide(&answer.direction);
        let least = match task {
            Task::Ball => 1.0,
            Task::Ellipsoid(s) | Task::Box(s) => s.iter().copied().fold(f64::MAX, f64::min),
        };
        let blur = grasp.blur() / least.min(task.value::<T>(&u).max(1e-30));
        let what = format!("stiff {round}: torque scale {scale:e}, mu {mu:e}, mus {mus:e}, near {near:e}");
        check(&what, &answer, &o, size, quotient, blur, &mut dice);
        let seen = Seen::from(&answer);
        if std::env::var("QDIST_TELL").is_ok() {
            println!("{what} {:e} {seen:?} {:?} {}", T::ROUNDOFF.to_f64(), answer.plan, answer.splits);
        }
        all += 1;
        converged += usize::from(seen.outcome == Outcome::Converged);
    }
    println!("{converged} of {all} converged in u = {:.0e}", T::ROUNDOFF.to_f64());
    assert!(converged * 2 >= all, "{converged} of {all}");
}

#[test]
fn stiff_grasps_in_f64() {
    stiff::<f64>();
}

#[test]
fn stiff_grasps_in_f32() {
    stiff::<f32>();
}

/// Contacts on one side only hold nothing, d = 0: that is found out, not searched for.
#[test]
fn grasps_that_do_not_hold() {
    let mut dice = Dice::new(76);
    let size = (200, 1500);
    let mut memory = Memory::new::<f64, 6>(size.0, size.1);
    for round in 0..20 {
        let list = (0..3 + round % 3).map(|_| {
            let p = [1.0, 0.5 * dice.signed(), 0.5 * dice.signed()];
            let n = [-1.0, 0.3 * dice.signed(), 0.3 * dice.signed()];
            let l = n.iter().map(|x| x * x).sum::<f64>().sqrt();
            touch(p, n.map(|x| x / l), 0.5, 0.2)
        });
        let norm = if round % 2 == 0 { Norm::LInf } else { Norm::L1 };
        let grasp = Grasp::new(list.collect(), 1.0, norm);
        let o = Options { relative: 1e-3, ..Options::default() };
        let answer = memory.solver::<f64, 6>().solve(&grasp.set(), &Ball::unit(), &o);
        let seen = Seen::from(&answer);
        assert_eq!(broken_promise(&seen, &o, size.0, size.1), None, "{round} {seen:?}");
        assert!(seen.lower <= 0.0 && 0.0 <= seen.upper && seen.upper - seen.lower < 1e-12, "{round} {seen:?}");
        if std::env::var("QDIST_TELL").is_ok() {
            println!("no hold {round} {seen:?} {:?}", answer.plan);
        }
        assert!(seen.outcome == Outcome::Touching && seen.iterations < 2000, "{round} {seen:?} {:?}", answer.plan);
    }
}

/// The origin next to the boundary: W moved along its weakest direction until a distance is left.
fn next_to_the_boundary<T: Real>() {
    let mut dice = Dice::new(73);
    let size = (200, 2048);
    let mut memory = Memory::new::<T, 6>(size.0, size.1);
    for round in 0..12 {
        let grasp = Grasp::new(contacts::<T>(&mut dice, 3 + round % 2, 0.6, 0.3), 1.0, Norm::LInf);
        let set = grasp.set();
        let o = Options { relative: T::of(1e-3), max_iterations: Some(2000), ..Options::default() };
        let first = memory.solver::<T, 6>().solve(&set, &Ball::unit(), &o);
        let u = wide(&first.direction).normalize();
        let height = grasp.height(&u);
        assert!(height > 0.0);
        for gap in [1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6, -1e-3] {
            let at: Vector<T, 6> = (u * -(height - gap)).map(T::of);
            let moved = Rigid::new(set, SMatrix::identity(), at).unwrap();
            let at = wide(&at);
            // The ball around the old origin holds one around the new.
            let surely = first.lower.to_f64() - at.norm();
            let quotient = |v: &Vector<f64, 6>| (grasp.height(v) + at.dot(v)) / v.norm();
            let extent = moved.extent().to_f64();
            for (relative, absolute, limit) in [(0.0, 2e-2, 1500), (1e-6, 0.0, 300)] {
                let o = Options {
                    relative: T::of(relative),
                    absolute: T::of(absolute),
                    max_iterations: Some(limit),
                    ..Options::default()
                };
                let answer = memory.solver::<T, 6>().solve(&moved, &Ball::unit(), &o);
                let what = format!("round {round}, {gap:e} from the boundary");
                let seen = Seen::from(&answer);
                let blur = grasp.blur();
                check(&what, &answer, &o, size, quotient, blur, &mut dice);
                assert!(surely <= seen.upper + blur, "{what}: {surely:e} {seen:?}");
                let room = quotient(&u);
                if room > 0.0 && surely > 0.0 {
                    assert!(seen.outcome != Outcome::Separated, "{what} {seen:?}");
                }
                // The tolerance, or what the walk to the nearest point leaves.
                if absolute > 0.0 {
                    assert!(seen.upper - seen.lower <= 0.05 * extent, "{what}: wide {seen:?} {:?}", answer.plan);
                }
            }
        }
    }
}

#[test]
fn the_origin_next_to_the_boundary_in_f64() {
    next_to_the_boundary::<f64>();
}

#[test]
fn the_origin_next_to_the_boundary_in_f32() {
    next_to_the_boundary::<f32>();
}

// The shared grasps.

fn six(v: &Value) -> [f64; 6] {
    let list: Vec<f64> = v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    list.try_into().unwrap()
}

fn three<T: Real>(v: &Value) -> Vector<T, 3> {
    Vector::from_fn(|i, _| T::of(v[i].as_f64().unwrap()))
}

/// Every reference in the whole space: its d in every bracket, whatever the memory and the budget.
fn references<T: Real>(loose: f64) {
    let grasps = recorded();
    let mut dice = Dice::new(74);
    let (mut runs, mut converged) = (0, 0);
    for v in &grasps {
        let list = v["contacts"].as_array().unwrap().iter().map(|c| {
            let number = |key: &str| T::of(c[key].as_f64().unwrap());
            let friction = match c["type"].as_str().unwrap() {
                "soft" => Friction::Soft { mu: number("mu"), mus: number("mus") },
                "hard" => Friction::Hard { mu: number("mu") },
                _ => Friction::Frictionless,
            };
            let contact = Contact::new(three(&c["p"]), three(&c["n"]), friction).unwrap();
            contact.with_tangents(three(&c["o"]), three(&c["t"])).unwrap()
        });
        let list: Vec<Contact<T>> = list.collect();
        for r in v["refs"].as_array().unwrap() {
            if r["set"] != "W" || !r["R"].is_null() || !r["Q"]["S"].is_null() {
                continue;
            }
            let norm = if r["norm"] == "L1" { Norm::L1 } else { Norm::LInf };
            let grasp = Grasp::new(list.clone(), 1.0, norm);
            let q = &r["Q"];
            let unit: Box<dyn UnitSet<T, 6>> = match q["type"].as_str().unwrap() {
                "ball" => Box::new(Ball::unit()),
                "ellipsoid" => Box::new(UnitEllipsoid::new(vector(six(&q["semi_axes"])), SMatrix::identity()).unwrap()),
                "box" => Box::new(UnitBox::new(vector(six(&q["half_widths"]))).unwrap()),
                "cross_polytope" => Box::new(CrossPolytope::new(vector(six(&q["half_axes"]))).unwrap()),
                "segment" => Box::new(Segment::new(vector(six(&q["wrench"]))).unwrap()),
                other => panic!("Q {other}"),
            };
            let d = r["d"].as_f64().unwrap();
            let off = r["tol"].as_f64().unwrap().max(1e-12) + loose * d;
            let set = grasp.set();
            for (size, limit, relative) in [
                ((18, 24), 1 + dice.below(600), 1e-2),
                ((64, 256), 1 + dice.below(600), 1e-2),
                ((200, 2048), 1 + dice.below(600), 1e-2),
                ((128, 512), 4000, 2e-2),
            ] {
                let o = Options { relative: T::of(relative), max_iterations: Some(limit as u32), ..Options::default() };
                let mut memory = Memory::new::<T, 6>(size.0, size.1);
                let answer = memory.solver::<T, 6>().solve(&set, &*unit, &o);
                let seen = Seen::from(&answer);
                let tell =
                    format!("{} {norm:?} {} {size:?} {limit}: {d} {seen:?} {:?}", v["id"], q["type"], answer.plan);
                assert_eq!(broken_promise(&seen, &o, size.0, size.1), None, "{tell}");
                assert!(seen.lower <= d + off && d - off <= seen.upper, "{tell}");
                let polytopal = !matches!(q["type"].as_str().unwrap(), "ball" | "ellipsoid");
                let fine = T::ROUNDOFF.to_f64() < 1e-10;
                assert!(!polytopal || !fine || limit < 600 || answer.plan != Plan::Cones, "{tell}");
                runs += 1;
                if limit == 4000 {
                    assert!(!fine || answer.outcome == Outcome::Converged, "{tell}");
                    assert!(seen.upper - seen.lower < 0.1 * d, "{tell}");
                    converged += 1;
                }
            }
        }
    }
    println!("{runs} runs, {converged} converged");
    assert!(runs > 100);
}

#[test]
#[ignore = "needs ../shared/data"]
fn references_are_in_every_bracket_in_f64() {
    references::<f64>(0.0);
}

#[test]
#[ignore = "needs ../shared/data"]
fn references_are_in_every_bracket_in_f32() {
    // The data's own rounding to f32 moves d.
    references::<f32>(2e-5);
}

// Gradients.

/// With respect to what moves the points linearly (torque scale, reference point, all forces), and by the direction alone what does not
/// (friction, one contact's position), against central differences.
#[test]
fn derivatives_of_a_grasp() {
    let mut dice = Dice::new(75);
    let size = (400, 4096);
    let mut compared = 0;
    for round in 0..8 {
        let list = contacts::<f64>(&mut dice, 4, 0.6, 0.3);
        let solve = |grasp: &Grasp<f64>| {
            let o = Options { relative: 1e-4, ..Options::default() };
            let mut memory = Memory::new::<f64, 6>(size.0, size.1);
            let answer = memory.solver::<f64, 6>().solve(&grasp.set(), &Ball::unit(), &o);
            assert_eq!(answer.outcome, Outcome::Converged, "{:?}", Seen::from(&answer));
            answer
        };
        let base = Grasp::new(list.clone(), 1.0, Norm::LInf);
        let answer = solve(&base);
        if answer.rival.is_some() {
            continue;
        }
        compared += 1;
        let (d, step) = (answer.upper, 0.002);
        let differ =
            |make: &dyn Fn(f64) -> Grasp<f64>| (solve(&make(step)).upper - solve(&make(-step)).upper) / (2.0 * step);
        let near = |a: f64, b: f64, what: &str| assert!((a - b).abs() < 0.08 * d, "{round} {what}: {a} {b}, d = {d}");
        // All forces: d grows with them.
        near(answer.derivative(|x| *x), d, "forces");
        // Torque scale.
        let by = answer.derivative(|x| Vector::from_fn(|i, _| if i < 3 { 0.0 } else { -x[i] }));
        near(by, differ(&|s| Grasp::new(list.clone(), 1.0 + s, Norm::LInf)), "torque scale");
        // The reference point moves along e: moments change by -e x f.
        let e = Vector::<f64, 3>::new(0.0, 1.0, 0.0);
        let by = answer.derivative(|x| {
            let m = -e.cross(&Vector::<f64, 3>::new(x[0], x[1], x[2]));
            Vector::from([0.0, 0.0, 0.0, m.x, m.y, m.z])
        });
        let shifted = |s: f64| {
            let c = list.iter().map(|c| Contact::new(c.position() - e * s, *c.normal(), c.friction()).unwrap());
            Grasp::new(c.collect(), 1.0, Norm::LInf)
        };
        near(by, differ(&shifted), "reference");
        // Friction and one position: u* and h_Q chain. A contact with h_i = 0 at u* counts for a share that u* does not tell.
        let u = answer.direction;
        let chained = |make: &dyn Fn(f64) -> Grasp<f64>, found: f64, what: &str| {
            let h = 1e-5;
            let (more, less) = (make(h), make(-h));
            let (mut low, mut high) = (0.0, 0.0);
            for i in 0..4 {
                let middle = value(&base.contacts[i], &base.frame, &u);
                let change = value(&more.contacts[i], &more.frame, &u) - value(&less.contacts[i], &less.frame, &u);
                let change = change / (2.0 * h) / answer.unit;
                if middle.abs() < 0.05 {
                    (low, high) = (low + f64::min(change, 0.0), high + f64::max(change, 0.0));
                } else if middle > 0.0 {
                    (low, high) = (low + change, high + change);
                }
            }
            assert!(
                found > low - 0.08 * d && found < high + 0.08 * d,
                "{round} {what}: {found} not in {low} {high}, d = {d}"
            );
        };
        let rough = |s: f64| {
            let c = list
                .iter()
                .map(|c| Contact::new(*c.position(), *c.normal(), Friction::Soft { mu: 0.6 + s, mus: 0.3 }).unwrap());
            Grasp::new(c.collect(), 1.0, Norm::LInf)
        };
        chained(&rough, differ(&rough), "friction");
        let moved = |s: f64| {
            let mut c = list.clone();
            c[0] =
                Contact::new(c[0].position() + Vector::from([0.0, 0.0, s]), *c[0].normal(), c[0].friction()).unwrap();
            Grasp::new(c, 1.0, Norm::LInf)
        };
        chained(&moved, differ(&moved), "position");
    }
    println!("{compared} compared");
    assert!(compared >= 4);
}
