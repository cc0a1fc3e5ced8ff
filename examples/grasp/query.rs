//! A grasp's wrench sets, and d_Q of them.
//!
//! W is measured in all of R^6. A flat Q is a set there like any other; where W itself is flat and Q lies in its span, all of eq. 16
//! takes place in that span. W^a is measured in the subspace R that it spans (the paper, end of Section III), by the projection of Q on R.
//!
//! R is found with the rank tolerance of the active forces, since a Jacobian is no better known than that. What sticks out of R by less is rounding, and
//! is taken off.

use std::time::{Duration, Instant};

use nalgebra::SMatrix;
use qdist::grasp::{
    ActiveForces, ContactError, GraspError, HandContact, Norm, Primitive, Subspace, WrenchFrame, WrenchSet,
    active_wrenches, default_tolerance, wrenches,
};
use qdist::{Answer, Options, Outcome, Solver, Vector, Workspace};

use crate::Trouble;
use crate::gauges::Q;
use crate::input::{Grasp, Set};

/// Facets and vertices of the workspace.
pub type Memory = Workspace<f64, 6, 1024, 4096>;

/// The tolerance for a Q of which every vertex is a convex problem.
const POLYTOPE_RELATIVE: f64 = 1e-10;

/// More than what a query needs in six dimensions for four digits; some minutes at worst.
const MAX_ITERATIONS: u32 = 5_000_000;

/// A query that takes less is repeated for its time.
const SAMPLE: Duration = Duration::from_millis(20);
const REPETITIONS: usize = 9;

/// The wrenches of each contact, and the subspace that all of them span.
pub struct Wrenches {
    pub primitives: Vec<Primitive<f64>>,
    pub span: Subspace<f64>,
}

impl Wrenches {
    fn new(primitives: Vec<Primitive<f64>>) -> Result<Self, ContactError> {
        let span = Subspace::new(&primitives, default_tolerance())?;
        let full = span.dimension() == 6;
        let primitives = match full {
            true => primitives,
            false => primitives.iter().map(|p| flat(p, &span)).collect::<Result<_, _>>()?,
        };
        Ok(Self { primitives, span })
    }

    pub fn dimension(&self) -> usize {
        self.span.dimension()
    }

    /// Does the span contain Q?
    fn contains(&self, q: &Q) -> bool {
        q.span().iter().all(|axis| self.span.distance(axis) <= default_tolerance::<f64>() * axis.norm())
    }
}

/// The projection on a subspace.
fn projected(wrench: &Vector<f64, 6>, span: &Subspace<f64>) -> Vector<f64, 6> {
    let axes = span.basis().iter().map(|axis| Vector::from(*axis));
    axes.fold(Vector::zeros(), |sum, axis| sum + axis * axis.dot(wrench))
}

fn flat(primitive: &Primitive<f64>, span: &Subspace<f64>) -> Result<Primitive<f64>, ContactError> {
    if primitive.is_empty() {
        return Ok(*primitive);
    }
    let [a, b, c] = primitive.disc().data.0.map(|column| projected(&Vector::from(column), span));
    Primitive::new(projected(primitive.center(), span), SMatrix::from_columns(&[a, b, c]))
}

/// W and W^a of a grasp.
pub struct Sets {
    passive: Wrenches,
    active: Wrenches,
    /// What each contact's joints can do; `None` for the palm.
    pub fingers: Vec<Option<ActiveForces<f64>>>,
}

impl Sets {
    pub fn new(hand: &[HandContact<f64>]) -> Result<Self, Trouble> {
        let frame = WrenchFrame::new(Vector::zeros(), 1.0).map_err(|e| e.to_string())?;
        let words = |error: GraspError| error.to_string();
        let contacts: Vec<_> = hand.iter().map(|c| c.contact).collect();
        let (mut passive, mut active) = (vec![Primitive::empty(); hand.len()], vec![Primitive::empty(); hand.len()]);
        wrenches(&contacts, &frame, &mut passive).map_err(words)?;
        active_wrenches(hand, &frame, default_tolerance(), &mut active).map_err(words)?;
        let forces = |c: &HandContact<f64>| {
            c.jacobian.as_ref().map(|j| ActiveForces::new(&c.contact, j, &frame, default_tolerance())).transpose()
        };
        let words = |error: ContactError| error.to_string();
        Ok(Self {
            passive: Wrenches::new(passive).map_err(words)?,
            active: Wrenches::new(active).map_err(words)?,
            fingers: hand.iter().map(forces).collect::<Result<_, _>>().map_err(words)?,
        })
    }

    pub fn of_grasp(grasp: &Grasp) -> Result<Self, Trouble> {
        Self::new(&grasp.hand).map_err(|trouble| format!("grasp {}, {trouble}", grasp.id))
    }

    pub fn get(&self, set: Set) -> &Wrenches {
        match set {
            Set::Passive => &self.passive,
            Set::Active => &self.active,
        }
    }
}

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

/// d_Q of the set. Where a query ends with too wide a bracket, it is asked once more, from the direction it ended with: another start
/// makes another polytope, and rounding ends that elsewhere. `relative` is the tolerance where Q is smooth.
pub fn solve(
    solver: &mut Solver<'_, f64, 6>,
    wrenches: &Wrenches,
    set: Set,
    norm: Norm,
    q: &Q,
    relative: f64,
) -> Result<Found, Trouble> {
    let gauge = q.gauge()?;
    let within = wrenches.dimension() < 6 && (set == Set::Active || wrenches.contains(q));
    let a = WrenchSet::new(&wrenches.primitives, norm);
    let mut ask = |options: &Options<f64, 6>| match within {
        true => solver.solve_in_span(&a, &*gauge, options),
        false => solver.solve(&a, &*gauge, options),
    };
    let wanted = Options { relative, max_iterations: MAX_ITERATIONS, ..Options::default() };
    let exact = Options { relative: relative.min(POLYTOPE_RELATIVE), ..Options::default() };
    let mut times = Vec::new();
    let begin = Instant::now();
    let answer = loop {
        let before = Instant::now();
        let mut answer = ask(if q.is_polytope() { &exact } else { &wanted });
        if is_open(&answer, relative) {
            answer = ask(&Options { guess: Some(answer.direction), ..wanted });
        }
        times.push(before.elapsed());
        if begin.elapsed() > SAMPLE || times.len() == REPETITIONS {
            break answer;
        }
    };
    times.sort();
    let weakest = q.farthest(&answer.direction).unwrap_or(answer.direction);
    let weakest = if within { projected(&weakest, &wrenches.span) } else { weakest };
    let dimension = if within { wrenches.dimension() } else { 6 };
    Ok(Found { answer, dimension, time: times[times.len() / 2], weakest })
}
