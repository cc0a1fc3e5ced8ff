//! d_Q of a wrench set: what is asked of the library, and what is asked again.

use std::cell::Cell;
use std::time::{Duration, Instant};

use qdist::grasp::{Norm, WrenchSet};
use qdist::nalgebra::SMatrix;
use qdist::qset::{Segment, UnitSet};
use qdist::support::{Rigid, Support};
use qdist::{Answer, Options, Outcome, Solver, Vector, Workspace};

use crate::Trouble;
use crate::grasp::input::Set;
use crate::grasp::sets::{Part, Wrenches, value};
use crate::grasp::unit_sets::Q;

/// Facets and vertices of the workspace.
pub type Memory = Workspace<f64, 6, 1024, 4096>;

/// The tolerance for a Q of which every vertex is a convex problem.
const POLYTOPE_RELATIVE: f64 = 1e-10;

/// More than what a query needs in six dimensions for four digits; the time is over before.
const MAX_ITERATIONS: u32 = 5_000_000;

/// How narrow a bracket must be where Q is smooth, and how long it may take: what a query needs grows with up to the power of 5/2 of 1 / tolerance,
/// so a tolerance that is within reach of the arithmetic need not be within that of a life.
pub struct Effort {
    pub relative: f64,
    pub time: Duration,
}

/// A query that takes less is repeated for its time.
const SAMPLE: Duration = Duration::from_millis(20);
const REPETITIONS: usize = 9;

/// An answer, and what it took.
pub struct Found {
    pub answer: Answer<f64, 6>,
    /// Of the space in which it was solved.
    pub dimension: usize,
    pub time: Duration,
    /// A wrench of Q that the grasp exerts at most `upper` times: farthest along the weakest direction.
    pub weakest: Vector<f64, 6>,
}

/// Is the bracket wider than asked for, and not around 0 either?
fn is_open(answer: &Answer<f64, 6>, relative: f64) -> bool {
    matches!(answer.outcome, Outcome::Precision | Outcome::Iterations | Outcome::Capacity)
        && !(answer.upper - answer.lower <= relative * answer.upper)
}

fn smooth(relative: f64, late: &dyn Fn() -> bool) -> Options<'_, f64, 6> {
    Options { relative, max_iterations: Some(MAX_ITERATIONS), interrupt: Some(late), ..Options::default() }
}

/// A set, where it is measured, and by what.
struct Query<'a> {
    set: WrenchSet<'a, f64, Part>,
    unit: Box<dyn UnitSet<f64, 6> + 'a>,
    /// The end of the segment, if Q is one.
    end: Option<Vector<f64, 6>>,
    /// In the span of the set, or in all of R^6.
    within: bool,
    /// What is asked first, and the tolerance that will do.
    options: Options<'a, f64, 6>,
    relative: f64,
    /// Is the time over?
    late: &'a dyn Fn() -> bool,
}

impl Query<'_> {
    fn once(
        &self,
        solver: &mut Solver<'_, f64, 6>,
        a: &dyn Support<f64, 6>,
        options: &Options<'_, f64, 6>,
    ) -> Answer<f64, 6> {
        match self.within {
            true => solver.solve_in_span(a, &*self.unit, options),
            false => solver.solve(a, &*self.unit, options),
        }
    }

    /// What is left open by one start is asked again from another: that of a ray further on; else from the direction where the first
    /// ended, which makes another polytope, and rounding ends that elsewhere.
    fn answer(&self, solver: &mut Solver<'_, f64, 6>) -> Answer<f64, 6> {
        let mut answer = self.once(solver, &self.set, &self.options);
        if let Some(end) = self.end {
            let open = is_open(&answer, self.options.relative) && answer.lower <= 0.0;
            return if open { self.further_on(solver, answer, &end) } else { answer };
        }
        if is_open(&answer, self.relative) {
            let options = Options { guess: Some(answer.direction), ..smooth(self.relative, self.late) };
            let found = self.once(solver, &self.set, &options);
            if !(found.upper - found.lower > answer.upper - answer.lower) {
                answer = found;
            }
        }
        answer
    }

    /// The ray from a point s q further on, where the origin is too near to the surface for rounding. If s q is inside of W, so is the way to it, since W
    /// contains the origin: the rest of the ray is all that is asked for. If it is outside, the direction that shows it bounds d by less than s.
    fn further_on(
        &self,
        solver: &mut Solver<'_, f64, 6>,
        mut best: Answer<f64, 6>,
        end: &Vector<f64, 6>,
    ) -> Answer<f64, 6> {
        let least = POLYTOPE_RELATIVE * self.set.extent() / end.norm();
        for s in [best.upper / 2.0, best.upper / 16.0, least] {
            // A power of two: its products are exact.
            let s = 2f64.powi(s.max(least).log2().floor() as i32);
            let Ok(moved) = Rigid::new(&self.set, SMatrix::identity(), -end * s) else { break };
            let mut rest = self.once(solver, &moved, &self.options);
            let along = rest.direction.dot(end);
            if rest.lower > 0.0 {
                rest.lower = (s + rest.lower).next_down();
                rest.upper = (s + rest.upper).next_up().min(best.upper);
                rest.support += end * s;
                return rest;
            }
            let upper = (value(&self.set, &rest.direction) + self.set.error()) / along;
            if rest.upper < 0.0 && along > 0.0 && upper < best.upper {
                (best.upper, best.unit) = (upper, along);
                (best.direction, best.support) = (rest.direction, rest.support + end * s);
            }
            if best.upper <= 2.0 * least {
                best.outcome = Outcome::Touching;
                return best;
            }
        }
        best
    }
}

/// d_Q of the set.
pub fn solve(
    solver: &mut Solver<'_, f64, 6>,
    wrenches: &Wrenches,
    set: Set,
    norm: Norm,
    q: &Q,
    effort: &Effort,
) -> Result<Found, Trouble> {
    let within = wrenches.holds(set, q);
    let end = q.segment().map(|end| if within { wrenches.projected(&end) } else { end });
    let set = WrenchSet::new(&wrenches.parts, norm);
    let relative = effort.relative;
    let before = Cell::new(Instant::now());
    let late = || before.get().elapsed() > effort.time;
    let options = match q.is_polytope() {
        true => Options { relative: relative.min(POLYTOPE_RELATIVE), ..Options::default() },
        false => smooth(relative, &late),
    };
    let query = Query { set, unit: q.unit()?, end, within, options, relative, late: &late };
    let mut times = Vec::new();
    let begin = Instant::now();
    let answer = loop {
        before.set(Instant::now());
        let answer = query.answer(solver);
        times.push(before.get().elapsed());
        if begin.elapsed() > SAMPLE || times.len() == REPETITIONS {
            break answer;
        }
    };
    times.sort();
    let weakest = q.farthest(&answer.direction).unwrap_or(answer.direction);
    let weakest = if within { wrenches.projected(&weakest) } else { weakest };
    let dimension = if within { wrenches.dimension() } else { 6 };
    Ok(Found { answer, dimension, time: times[times.len() / 2], weakest })
}

/// The largest t with t v in the set, for pictures: to 1e-4, and with no more than some hundred points.
pub fn reach(solver: &mut Solver<'_, f64, 6>, wrenches: &Wrenches, norm: Norm, v: &Vector<f64, 6>) -> Option<f64> {
    if !wrenches.contains(v) {
        return Some(0.0);
    }
    let (set, unit) = (WrenchSet::new(&wrenches.parts, norm), Box::new(Segment::new(*v).ok()?));
    let options =
        Options { relative: 1e-4, absolute: 1e-6 * set.extent(), max_iterations: Some(200), ..Options::default() };
    let within = wrenches.dimension() < 6;
    let query = Query { set, unit, end: Some(*v), within, options, relative: 1e-4, late: &|| false };
    let upper = query.answer(solver).upper.max(0.0);
    (upper < f64::MAX).then_some(upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grasp::input::{self, Reference};
    use crate::grasp::sets::Sets;
    use crate::grasp::unit_sets::Shape;
    use crate::grasp::{csv, table};
    use qdist::grasp::{Contact, Friction, HandContact, Jacobian};

    pub const FIXTURE: &str = include_str!("../../../tests/data/grasps.json");

    fn ask(sets: &Sets, set: Set, norm: Norm, q: &Q) -> Found {
        let mut memory = Box::new(Memory::new());
        let effort = Effort { relative: 1e-4, time: Duration::from_secs(600) };
        solve(&mut memory.solver(), sets.get(set), set, norm, q, &effort).unwrap()
    }

    /// A tolerance that is out of reach ends with the time, and a bracket that is true.
    #[test]
    fn the_time_is_the_limit() {
        let grasp = &input::read(FIXTURE, false).unwrap()[0];
        let sets = Sets::of_grasp(grasp).unwrap();
        let query = &grasp.queries[0];
        let effort = Effort { relative: 1e-15, time: Duration::from_millis(100) };
        let mut memory = Box::new(Memory::new());
        let wrenches = sets.get(query.set);
        let found = solve(&mut memory.solver(), wrenches, query.set, query.norm, &query.q, &effort).unwrap();
        assert_eq!((query.q.kind(), found.answer.outcome), ("ball", Outcome::Interrupted));
        assert_eq!(table::contains(&found, query), Some(true));
        assert!(found.time >= effort.time && found.time < Duration::from_secs(20), "{:?}", found.time);
    }

    /// Every reference is in a bracket as narrow as promised, and a row of numbers that mean the same.
    #[test]
    fn the_fixtures_references() {
        let mut rows = Vec::new();
        for grasp in input::read(FIXTURE, false).unwrap() {
            let sets = Sets::of_grasp(&grasp).unwrap();
            for (i, query) in grasp.queries.iter().enumerate() {
                let Reference { set, norm, q, d, .. } = query;
                let found = ask(&sets, *set, *norm, q);
                let (lower, upper, d) = (found.answer.lower, found.answer.upper, d.unwrap());
                let what = format!("{} {i}: {d} in {lower} {upper}", grasp.id);
                assert_eq!(table::contains(&found, query), Some(true), "{what}");
                assert_eq!(found.answer.outcome, Outcome::Converged, "{what}");
                assert!(upper - lower <= if q.is_polytope() { 1e-9 } else { 1e-4 * upper }, "{what}");
                assert_eq!(found.answer.dimension, found.dimension, "{what}");
                let start = rows.len();
                csv::row(&mut rows, &grasp, i, &found).unwrap();
                let line = std::str::from_utf8(&rows[start..]).unwrap().trim_end();
                let fields: Vec<&str> = line.split(',').collect();
                assert_eq!(fields.len(), csv::HEADER.split(',').count(), "{line}");
                assert_eq!(fields[..3], [grasp.id.as_str(), &i.to_string(), set.name()], "{line}");
                assert_eq!((fields[5].parse(), fields[6].parse()), (Ok(lower), Ok(upper)), "{line}");
                assert_eq!(
                    (fields[7], fields[8]),
                    ("converged", if *set == Set::Active { "3" } else { "6" }),
                    "{line}"
                );
            }
        }
        assert_eq!(rows.iter().filter(|&&c| c == b'\n').count(), 24);
    }

    /// What a file says of caps, torque limits, torque scale and reference point is in the answer; each has a closed form.
    #[test]
    fn caps_limits_and_frames_take_part() {
        let pinch = |of_grasp: &str, of_contact: &str| {
            let touch = |x: i32| {
                let jacobian = r#""J": [[1], [0], [0], [0]]"#;
                format!(r#"{{"p": [{x}, 0, 0], "n": [{}, 0, 0], "mu": 0.5, "mus": 0.2, {jacobian}{of_contact}}}"#, -x)
            };
            let text = format!(r#"{{"contacts": [{}, {}]{of_grasp}}}"#, touch(-1), touch(1));
            Sets::of_grasp(&input::read(&text, false).unwrap()[0]).unwrap()
        };
        let (push, spin) = ([1.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        for (of_grasp, of_contact, wrench, d) in [
            ("", "", push, 1.0),
            ("", r#", "force_cap": 3"#, push, 3.0),
            ("", r#", "torque_limits": [0.25]"#, push, 0.25),
            ("", r#", "torque_limits": [null]"#, push, 1.0),
            ("", r#", "torque_limits": [2], "force_cap": 3"#, push, 2.0),
            ("", "", spin, 0.4),
            (r#", "torque_scale": 0.5"#, "", spin, 0.8),
            (r#", "L": 2"#, r#", "torque_limits": [0.5]"#, spin, 0.1),
        ] {
            let sets = pinch(of_grasp, of_contact);
            let q = Q::new(Shape::Segment(wrench.to_vec()), None).unwrap();
            let found = ask(&sets, Set::Passive, Norm::LInf, &q).answer;
            let what = format!("{of_grasp}{of_contact}: {d} in {} {}", found.lower, found.upper);
            assert!((found.lower - d).abs() < 1e-6 && (found.upper - d).abs() < 1e-6, "{what}");
        }
        let moved = r#"{"reference": [1, 0, 0], "contacts": [{"p": [0, 0, 1], "n": [0, 0, -1]}]}"#;
        let sets = Sets::of_grasp(&input::read(moved, false).unwrap()[0]).unwrap();
        let q = Q::new(Shape::Segment(vec![0.0, 0.0, -1.0, 0.0, -1.0, 0.0]), None).unwrap();
        let found = ask(&sets, Set::Passive, Norm::L1, &q).answer;
        assert!((found.lower - 1.0).abs() < 1e-9 && (found.upper - 1.0).abs() < 1e-9, "{}", found.upper);
        // Two contacts of one finger state other limits than each other.
        let text = r#"{"contacts": [{"p": [0, 0, 1], "n": [0, 0, -1], "finger": "a", "J": [[1], [0], [0], [0]], "torque_limits": [1]},
                                    {"p": [1, 0, 1], "n": [0, 0, -1], "finger": "a", "J": [[1], [0], [0], [0]], "torque_limits": [2]}]}"#;
        let told = Sets::of_grasp(&input::read(text, false).unwrap()[0]).err().unwrap();
        assert!(told.starts_with("grasp 0, contact 1: `torque_limits` are not those"), "{told}");
    }

    /// Planar fingers in a plane that is no coordinate plane, with Jacobians known to 1e-11: W^a has three dimensions, and the value of
    /// the plane.
    #[test]
    fn a_plane_known_to_rounding() {
        let turn = qdist::nalgebra::Rotation3::from_euler_angles(0.3, -0.7, 1.1);
        let finger = |x: f64| {
            let (n, o) = (turn * Vector::from([-x.signum(), 0.0, 0.0]), turn * Vector::from([0.0, 1.0, 0.0]));
            let contact =
                Contact::new(turn * Vector::from([x, 0.0, 0.0]), n, Friction::Soft { mu: 0.2, mus: 0.2 }).unwrap();
            let noise = [3e-12, -1e-11, 7e-12];
            let jacobian =
                Jacobian::new([&[1.0, 0.4, 0.2], &[0.3, 0.9, 0.5], &noise, &noise.map(|x| -2.0 * x)]).unwrap();
            HandContact { contact: contact.with_tangents(o, n.cross(&o)).unwrap(), jacobian: Some(jacobian) }
        };
        let sets = Sets::new(&[finger(-0.75), finger(1.3)]).unwrap();
        assert_eq!(sets.get(Set::Active).dimension(), 3);
        let ball = ask(&sets, Set::Active, Norm::LInf, &Q::new(Shape::Ball(1.0), None).unwrap());
        let d = 0.41 / (0.1681f64 + 1.69 + 1.0).sqrt();
        assert!(
            (ball.answer.lower - d).abs() < 1e-4 * d && (ball.answer.upper - d).abs() < 1e-4 * d,
            "{:?}",
            ball.answer.upper
        );
        assert_eq!((ball.answer.outcome, ball.answer.dimension), (Outcome::Converged, 3));
        // A weight out of the plane is not held at all.
        let out = turn * Vector::<f64, 3>::z();
        let weight = Q::new(Shape::Segment(vec![out.x, out.y, out.z, 0.0, 0.0, 0.0]), None).unwrap();
        let found = ask(&sets, Set::Active, Norm::LInf, &weight);
        assert!(
            found.answer.lower <= 0.0 && 0.0 <= found.answer.upper && found.answer.upper < 1e-9,
            "{:?}",
            found.answer.upper
        );
        assert!(ask(&sets, Set::Passive, Norm::LInf, &weight).answer.lower > 0.3);
        // A box along the plane's own axes.
        let axis = |v: Vector<f64, 3>, moment: bool| {
            let v = turn * v;
            Vector::<f64, 6>::from_fn(|i, _| if (i >= 3) == moment { v[i % 3] } else { 0.0 })
        };
        let axes = vec![axis(Vector::x(), false), axis(Vector::y(), false), axis(Vector::z(), true)];
        let q = Q::new(Shape::Box(vec![1.0; 3]), Some(axes)).unwrap();
        let found = ask(&sets, Set::Active, Norm::LInf, &q).answer;
        let d = 0.41 / (0.41 + 2.3);
        assert!((found.lower - d).abs() < 1e-9 && (found.upper - d).abs() < 1e-9, "{} {}", found.lower, found.upper);
    }

    /// Two frictionless contacts: W is a line. Along it d is 1; a ball is not in it at all.
    #[test]
    fn a_flat_passive_set() {
        let contact = |x: f64| {
            let n = Vector::from([-x.signum(), 0.0, 0.0]);
            HandContact {
                contact: Contact::new(Vector::from([x, 0.0, 0.0]), n, Friction::Frictionless).unwrap(),
                jacobian: None,
            }
        };
        let sets = Sets::new(&[contact(-1.0), contact(1.0)]).unwrap();
        let x = Q::new(Shape::Segment(vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), None).unwrap();
        let found = ask(&sets, Set::Passive, Norm::LInf, &x);
        assert!((found.answer.lower - 1.0).abs() < 1e-9 && (found.answer.upper - 1.0).abs() < 1e-9);
        assert_eq!(found.dimension, 1);
        let found = ask(&sets, Set::Passive, Norm::LInf, &Q::new(Shape::Ball(1.0), None).unwrap());
        assert_eq!((found.answer.outcome, found.dimension), (Outcome::Degenerate, 6));
        assert!(found.answer.lower <= 0.0 && 0.0 <= found.answer.upper && found.answer.upper < 1e-12);
    }

    /// One contact is no force closure: the origin is on the surface of W. The ray along its normal ends where the contact's force does, one
    /// out of the cone at once.
    #[test]
    fn a_ray_from_the_surface() {
        let n = Vector::from([0.6, 0.0, 0.8]);
        let contact = Contact::new(Vector::zeros(), n, Friction::Hard { mu: 0.5 }).unwrap();
        let across = Contact::new(Vector::from([0.0, 1.0, 0.0]), n, Friction::Soft { mu: 0.5, mus: 0.1 }).unwrap();
        let hand = [contact, across].map(|contact| HandContact { contact, jacobian: None });
        let sets = Sets::new(&hand).unwrap();
        let segment = |end: [f64; 6]| Q::new(Shape::Segment(end.to_vec()), None).unwrap();
        for (norm, d) in [(Norm::L1, 2.0), (Norm::LInf, 4.0)] {
            // Half the force from each contact.
            let found = ask(&sets, Set::Passive, norm, &segment([0.3, 0.0, 0.4, 0.2, 0.0, -0.15])).answer;
            assert!(
                (found.lower - d).abs() < 1e-9 && (found.upper - d).abs() < 1e-9,
                "{} {}",
                found.lower,
                found.upper
            );
            let found = ask(&sets, Set::Passive, norm, &segment([-0.6, 0.0, -0.8, 0.0, 0.0, 0.0])).answer;
            assert!(found.lower <= 0.0 && 0.0 <= found.upper && found.upper < 1e-9, "{} {}", found.lower, found.upper);
        }
    }

    /// No contact, or none that can do anything, is an answer.
    #[test]
    fn nothing_holds_nothing() {
        let sets = Sets::new(&[]).unwrap();
        for set in [Set::Passive, Set::Active] {
            let found = ask(&sets, set, Norm::L1, &Q::new(Shape::Ball(1.0), None).unwrap()).answer;
            assert!(found.lower <= 0.0 && found.upper >= 0.0 && found.upper < 1e-12, "{:?}", found.outcome);
        }
    }
}
