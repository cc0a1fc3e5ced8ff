//! A grasp's wrench sets, and where they are measured.
//!
//! A set that spans R^6 is measured there; a flat Q is a set there like any other. Where the set itself is flat and Q lies in its span, all of eq. 16
//! takes place in that span. W^a is measured in the subspace R that it spans (the paper, end of Section III): a Q that spans R^6, like the unit ball,
//! then stands for its projection on R. Otherwise a Q that sticks out of a flat set is nowhere inside, and d is 0.
//!
//! R is found with the rank tolerance of the active forces, since a Jacobian is no better known than that. What sticks out of R by less is rounding, and
//! is taken off.

use nalgebra::SMatrix;
use qdist::Vector;
use qdist::grasp::{
    ActiveForces, ContactError, GraspError, HandContact, Primitive, Subspace, WrenchFrame, active_wrenches,
    default_tolerance, wrenches,
};

use crate::Trouble;
use crate::gauges::Q;
use crate::input::{Grasp, Set};

/// The sine of an angle: axes of Q that are nearer to a span are in it, but for the rounding of files.
const OUT_OF_SPAN: f64 = 1e-7;

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

    /// Is d measured in the span of the set?
    pub fn holds(&self, set: Set, q: &Q) -> bool {
        let axes = q.span();
        let contained = axes.iter().all(|axis| self.contains(axis));
        self.dimension() < 6 && (contained || set == Set::Active && axes.len() == 6)
    }

    /// Is the wrench in the span of the set?
    pub fn contains(&self, wrench: &Vector<f64, 6>) -> bool {
        self.span.distance(wrench) <= OUT_OF_SPAN * wrench.norm()
    }

    /// The projection on the span.
    pub fn projected(&self, wrench: &Vector<f64, 6>) -> Vector<f64, 6> {
        projected(wrench, &self.span)
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
