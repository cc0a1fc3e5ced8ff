//! The step of a search in contact space: which small motion brings a body nearest to a given pose, by a metric, and
//! violates no contact?
//!
//! To first order a motion is a twist, a contact is a linear inequality in it, and a metric's square is a convex function
//! of it: a quadratic ([`Quadratic`]) for an averaging metric, the largest of many quadratics for the largest displacement. So
//! there are two small convex problems in six variables, and one solver beneath both:
//!
//! ```text
//! minimax     largest displacement: successive quadratic programs, closed by a dual bound
//!  quadratic  one quadratic program; where constraints contradict each other, the least violation
//!   project   nearest point of a polyhedron: Goldfarb and Idnani
//! ```
//!
//! **Variables.** A twist (v, w) of the body about its centre, in axes fixed to the body, with the angle multiplied by the
//! body's radius: y = (v, radius w), six lengths. The centre, the axes and the radius are the metric's ([`BodyFrame`]); so steps do
//! not depend on the world's frame, nor on the mesh's own as far as its axes are unique, and scale with the mesh. The trust region is
//! a box in these variables.
//!
//! Nothing here allocates but [`StepMemory::new`].
//!
//! [`BodyFrame`]: super::metric::BodyFrame

use core::fmt;
use nalgebra::{Isometry3, Matrix6, Point3, Translation3, UnitQuaternion, Vector3, Vector6};

pub(crate) mod minimax;
pub(crate) mod project;
pub(crate) mod quadratic;

/// A contact as a constraint of a step: the motion of the moving body's point `point` along `normal` is at least `-gap`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constraint {
    /// Where, in the world.
    pub point: Point3<f64>,
    /// Unit vector from the fixed body to the moving one, in the world.
    pub normal: Vector3<f64>,
    /// How far the moving body may approach here: the distance less the clearance to keep. Negative where it must recede.
    pub gap: f64,
}

/// A small rigid motion: the world's point p moves by `linear + angular x (p - about)` to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Displacement of the body's point at `about`.
    pub linear: Vector3<f64>,
    /// Rotation vector: axis times angle in radians.
    pub angular: Vector3<f64>,
    /// The point of the world that the rotation is about.
    pub about: Point3<f64>,
}

impl Twist {
    /// First-order displacement of a point of the body, given in the world.
    #[must_use]
    pub fn velocity(&self, point: &Point3<f64>) -> Vector3<f64> {
        self.linear + self.angular.cross(&(point - self.about))
    }

    /// The same twist, a fraction of it.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Twist {
        Twist { linear: self.linear * factor, angular: self.angular * factor, about: self.about }
    }

    /// The pose after the motion: a rotation by `angular` about `about`, then a translation by `linear`. A rigid
    /// motion whatever the size of the twist.
    #[must_use]
    pub fn applied(&self, pose: &Isometry3<f64>) -> Isometry3<f64> {
        let turn = UnitQuaternion::from_scaled_axis(self.angular);
        let moved = self.about.coords + self.linear + turn * (pose.translation.vector - self.about.coords);
        let mut rotation = turn * pose.rotation;
        rotation.renormalize();
        Isometry3::from_parts(Translation3::from(moved), rotation)
    }
}

/// What a step may be, and how well it is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepOptions {
    /// Half width of the trust region, a length: each component of the motion of the body's centre, and of the rotation vector times the
    /// body's radius. Infinite for none.
    pub trust: f64,
    /// An iterative step ends when its value is proved within this fraction of the least. In (0, 1).
    pub tolerance: f64,
}

impl Default for StepOptions {
    fn default() -> Self {
        StepOptions { trust: f64::INFINITY, tolerance: 1e-4 }
    }
}

/// How a step ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepEnd {
    /// The least value, to the tolerance. All contacts hold, or contradict each other by at most 1e-10 of the body's radius.
    Optimal,
    /// No motion satisfies all contacts within the trust region. The step is the one whose largest violation is least.
    Infeasible,
    /// The limit of iterations: a step that satisfies the contacts to [`Step::violation`], and may not be the best.
    Limit,
}

/// A step: a motion and what it is worth, to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The motion.
    pub twist: Twist,
    /// The metric's value after the motion, a length, by the linearised model.
    pub value: f64,
    /// No motion within the constraints has a lower value, by the same model and to rounding. 0 where nothing is proved.
    pub lower: f64,
    /// The largest violation of a contact, a length, to first order; 0 where all hold exactly. Unless the step is infeasible, it is
    /// rounding: below 1e-10 of the body's radius, and of a plate or needle that times the radius over the thickness.
    pub violation: f64,
    /// Quadratic programs solved.
    pub programs: usize,
    /// How it ended.
    pub end: StepEnd,
}

/// Why a step cannot be computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepError {
    /// A pose is not finite.
    Pose,
    /// This contact is not finite.
    Contact {
        /// Position in the list.
        index: usize,
    },
    /// There are more contacts than the memory has room for.
    Capacity,
    /// The trust region is not positive, or the tolerance is not in (0, 1).
    Options,
    /// The metric's model is not finite at these poses.
    Model,
}

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StepError::Pose => write!(f, "a pose is not finite"),
            StepError::Contact { index } => write!(f, "contact {index} is not finite"),
            StepError::Capacity => write!(f, "more contacts than the step memory has room for"),
            StepError::Options => write!(f, "trust must be positive and tolerance between 0 and 1"),
            StepError::Model => write!(f, "the metric's model is not finite"),
        }
    }
}

impl std::error::Error for StepError {}

/// The square of a metric near a pose: value + 2 gradient.y + y^T hessian y, a length squared, y as in the module's head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadratic {
    /// At y = 0.
    pub value: f64,
    /// Half of the derivative.
    pub gradient: Vector6<f64>,
    /// Positive semidefinite, without unit, of order 1.
    pub hessian: Matrix6<f64>,
}

impl Quadratic {
    /// The square after a step; not below 0.
    #[must_use]
    pub fn at(&self, y: &Vector6<f64>) -> f64 {
        (self.value + y.dot(&(self.gradient * 2.0 + self.hessian * y))).max(0.0)
    }
}

/// A linear constraint of y: normal.y >= offset.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear {
    pub normal: Vector6<f64>,
    pub offset: f64,
}

/// Memory of steps: allocated once, for a number of contacts.
#[derive(Clone, Debug)]
pub struct StepMemory {
    pub(crate) contacts: Vec<Linear>,
    pub(crate) rows: Vec<project::Row>,
    capacity: usize,
}

impl StepMemory {
    /// Room for steps with up to `contacts` contacts.
    #[must_use]
    pub fn new(contacts: usize) -> Self {
        let others = quadratic::TRUST_ROWS + minimax::MEMBERS;
        StepMemory {
            contacts: Vec::with_capacity(contacts),
            rows: Vec::with_capacity(contacts + others),
            capacity: contacts,
        }
    }

    /// How many contacts a step may have.
    #[must_use]
    pub fn capacity(&self) -> usize {
        self.capacity
    }
}
