//! A grasp's wrench sets, and where they are measured.
//!
//! A set that spans R^6 is measured there; a flat Q is a set there like any other. Where the set itself is flat and Q lies in its span, all of eq. 16
//! takes place in that span. W^a is measured in the subspace R that it spans (the paper, end of Section III): a Q that spans R^6, like the unit ball,
//! then stands for its projection on R. Otherwise a Q that sticks out of a flat set is nowhere inside, and d is 0.
//!
//! R is found with the rank tolerance of the active forces, since a Jacobian is no better known than that. What sticks out of R by less is rounding, and
//! is taken off.
//!
//! A contact contributes the wrenches of its own forces. Where joints have torque limits, all contacts of the finger are one contribution: they share the
//! joints. (Under L1 the fingers then share one supply, the contacts of one finger do not.)

use qdist::grasp::{
    ActiveForces, ContactError, Contribution, Finger, ForceModel, GraspError, HandContact, Primitive, Subspace,
    WrenchFrame, WrenchSet, active_wrenches, default_tolerance, wrenches,
};
use qdist::nalgebra::SMatrix;
use qdist::support::{Failure, Support};
use qdist::{Real, Vector};

use crate::Trouble;
use crate::grasp::input::{Grasp, Set, Touch};
use crate::grasp::unit_sets::Q;

/// The sine of an angle: axes of Q that are nearer to a span are in it, but for the rounding of files.
const OUT_OF_SPAN: f64 = 1e-7;

/// What contributes to a wrench set: a contact, or a finger whose joints have limits.
pub enum Part<T = f64> {
    Contact(Box<Primitive<T>>),
    Finger(Box<Finger<T>>),
}

impl<T: Real> Part<T> {
    fn support_set(&self) -> &dyn Support<T, 6> {
        match self {
            Self::Contact(primitive) => &**primitive,
            Self::Finger(finger) => &**finger,
        }
    }
}

impl Part {
    /// h(u) of the part with {0}.
    pub fn value(&self, u: &Vector<f64, 6>) -> f64 {
        match self {
            Self::Contact(primitive) => primitive.value(u).max(0.0),
            Self::Finger(finger) => finger.support(u).map_or(0.0, |point| point.dot(u)),
        }
    }
}

impl<T: Real> Support<T, 6> for Part<T> {
    fn support(&self, u: &Vector<T, 6>) -> Result<Vector<T, 6>, Failure> {
        self.support_set().support(u)
    }
    fn extent(&self) -> T {
        self.support_set().extent()
    }
    fn error(&self) -> T {
        self.support_set().error()
    }
    fn errors(&self) -> Vector<T, 6> {
        self.support_set().errors()
    }
    fn extents(&self) -> Vector<T, 6> {
        self.support_set().extents()
    }
}

impl<T: Real> Contribution<T> for Part<T> {
    fn support_above(&self, u: &Vector<T, 6>, floor: T) -> Result<Option<(T, Vector<T, 6>)>, Failure> {
        match self {
            Self::Contact(primitive) => primitive.support_above(u, floor),
            Self::Finger(finger) => finger.support_above(u, floor),
        }
    }
    fn is_mirror_of(&self, other: &Self, signs: &Vector<T, 6>) -> bool {
        match (self, other) {
            (Self::Contact(own), Self::Contact(other)) => own.is_mirror_of(other, signs),
            _ => false,
        }
    }
}

/// h(u) of the whole set.
pub fn value(set: &WrenchSet<'_, f64, Part>, u: &Vector<f64, 6>) -> f64 {
    set.support(u).map_or(f64::MAX, |point| point.dot(u))
}

/// The wrenches of each contact or finger, and the subspace that all of them span.
pub struct Wrenches {
    pub parts: Vec<Part>,
    /// One name a part.
    pub names: Vec<String>,
    pub span: Subspace<f64>,
}

impl Wrenches {
    /// `fingers`: what takes the place of contacts, with their indices.
    fn new(primitives: Vec<Primitive<f64>>, names: &[String], fingers: Vec<Group>) -> Result<Self, ContactError> {
        let span = Subspace::new(&primitives, default_tolerance())?;
        let full = span.dimension() == 6;
        let alone = (0..primitives.len()).filter(|i| !fingers.iter().any(|group| group.contacts.contains(i)));
        let mut parts: Vec<(usize, Part)> = alone
            .map(|i| Ok((i, Part::Contact(Box::new(if full { primitives[i] } else { flat(&primitives[i], &span)? })))))
            .collect::<Result<_, _>>()?;
        parts.extend(fingers.into_iter().map(|group| (group.contacts[0], Part::Finger(Box::new(group.finger)))));
        parts.sort_by_key(|(first, _)| *first);
        let names = parts.iter().map(|(first, _)| names[*first].clone()).collect();
        Ok(Self { parts: parts.into_iter().map(|(_, part)| part).collect(), names, span })
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

/// A finger, and which contacts of the grasp are its.
struct Group {
    contacts: Vec<usize>,
    finger: Finger<f64>,
}

/// The contacts of a finger whose joints have limits, and these.
pub struct Limited {
    pub contacts: Vec<usize>,
    pub limits: Vec<f64>,
}

impl Limited {
    /// Those of a grasp. The trouble names the contact.
    pub fn all(touches: &[Touch]) -> Result<Vec<Self>, Trouble> {
        let mut all: Vec<Self> = Vec::new();
        for (i, touch) in touches.iter().enumerate() {
            let Some(limits) = &touch.limits else { continue };
            match all.iter().find(|finger| finger.contacts.contains(&i)) {
                Some(finger) if finger.limits == *limits => {}
                Some(_) => {
                    return Err(format!(
                        "contact {i}: `torque_limits` are not those that a contact of finger {} has before",
                        touch.name
                    ));
                }
                None => {
                    let contacts = (0..touches.len()).filter(|&j| touches[j].name == touch.name).collect();
                    all.push(Self { contacts, limits: limits.clone() });
                }
            }
        }
        Ok(all)
    }

    fn group(&self, touches: &[Touch], model: ForceModel, frame: &WrenchFrame<f64>) -> Result<Group, Trouble> {
        let own: Vec<_> = self.contacts.iter().map(|&i| touches[i].contact).collect();
        let finger = Finger::new(&own, &self.limits, model, frame, default_tolerance()).map_err(|fault| {
            let index = self.contacts[fault.contact.min(self.contacts.len() - 1)];
            format!("contact {index}, of finger {}: {}", touches[index].name, fault.error)
        })?;
        Ok(Group { contacts: self.contacts.clone(), finger })
    }
}

impl Sets {
    /// Of contacts without limits; moments refer to the origin, in units of length.
    pub fn new(hand: &[HandContact<f64>]) -> Result<Self, Trouble> {
        let frame = WrenchFrame::new(Vector::zeros(), 1.0).map_err(|e| e.to_string())?;
        let touch = |(i, c): (usize, &HandContact<f64>)| Touch { name: i.to_string(), contact: *c, limits: None };
        Self::of_contacts(&hand.iter().enumerate().map(touch).collect::<Vec<_>>(), &frame)
    }

    fn of_contacts(contacts: &[Touch], frame: &WrenchFrame<f64>) -> Result<Self, Trouble> {
        let words = |error: GraspError| error.to_string();
        let hand: Vec<_> = contacts.iter().map(|c| c.contact).collect();
        let bare: Vec<_> = hand.iter().map(|c| c.contact).collect();
        let (mut passive, mut active) = (vec![Primitive::empty(); hand.len()], vec![Primitive::empty(); hand.len()]);
        wrenches(&bare, frame, &mut passive).map_err(words)?;
        active_wrenches(&hand, frame, default_tolerance(), &mut active).map_err(words)?;
        let limited = Limited::all(contacts)?;
        let forces = |c: &HandContact<f64>| {
            c.jacobian.as_ref().map(|j| ActiveForces::new(&c.contact, j, frame, default_tolerance())).transpose()
        };
        let names: Vec<_> = contacts.iter().map(|c| c.name.clone()).collect();
        let set = |primitives, model| {
            let fingers = limited.iter().map(|own| own.group(contacts, model, frame)).collect::<Result<_, _>>()?;
            Wrenches::new(primitives, &names, fingers).map_err(|error| error.to_string())
        };
        Ok(Self {
            passive: set(passive, ForceModel::Passive)?,
            active: set(active, ForceModel::Active)?,
            fingers: hand.iter().map(forces).collect::<Result<_, _>>().map_err(|error| error.to_string())?,
        })
    }

    pub fn of_grasp(grasp: &Grasp) -> Result<Self, Trouble> {
        Self::of_contacts(&grasp.contacts, &grasp.frame).map_err(|trouble| format!("grasp {}, {trouble}", grasp.id))
    }

    pub fn get(&self, set: Set) -> &Wrenches {
        match set {
            Set::Passive => &self.passive,
            Set::Active => &self.active,
        }
    }
}
