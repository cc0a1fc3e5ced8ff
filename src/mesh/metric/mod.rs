//! Distances between two poses of one body, as lengths, and the step that reduces them.
//!
//! A metric that knows the body needs no choice of weights between translation and rotation, and does not depend on
//! frames: it says how far the body's points move.
//!
//! * [`Disp`]: the farthest that any point moves.
//! * [`Sigma`]: the root mean square over the solid (the object norm's root).
//! * [`Weighted`]: the same over a mass of yours.
//!
//! Always sqrt(sigma) <= DISP. A metric of your own implements [`Metric`] with a distance and a quadratic model of its square
//! near a pose; the step comes with it.

mod disp;
mod sigma;
mod weighted;

pub use disp::{Disp, DispError};
pub use sigma::Sigma;
pub use weighted::{Weighted, WeightedError};

use super::optimize::project::End;
use super::optimize::quadratic::{self, minimise};
use super::optimize::{Constraint, Linear, Quadratic, Step, StepEnd, StepError, StepMemory, StepOptions, Twist};
use nalgebra::{Isometry3, Matrix3, Point3, SymmetricEigen, Vector3, Vector6};

/// Where a body's motions are measured, in the body's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyFrame {
    /// The point that rotations are about.
    pub centre: Point3<f64>,
    /// The axes of motions: the columns of a rotation.
    pub axes: Matrix3<f64>,
    /// What makes an angle a length.
    pub radius: f64,
}

impl BodyFrame {
    /// The frame with the principal axes of a symmetric matrix.
    #[must_use]
    pub fn principal(centre: Point3<f64>, moments: &Matrix3<f64>, radius: f64) -> Self {
        let mut axes = SymmetricEigen::new(moments / moments.amax().max(f64::MIN_POSITIVE)).eigenvectors;
        if axes.determinant() < 0.0 {
            axes.neg_mut();
        }
        BodyFrame { centre, axes, radius }
    }

    /// The columns are the axes in the world.
    fn world_axes(&self, pose: &Isometry3<f64>) -> Matrix3<f64> {
        pose.rotation.to_rotation_matrix().into_inner() * self.axes
    }

    /// The displacement field from one pose to another, by the body's coordinates relative to the centre and in its axes,
    /// in the world's axes: matrix r + vector.
    fn displacement(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> (Matrix3<f64>, Vector3<f64>) {
        let turn = to.rotation.to_rotation_matrix().into_inner() - from.rotation.to_rotation_matrix().into_inner();
        (turn * self.axes, turn * self.centre.coords + (to.translation.vector - from.translation.vector))
    }

    /// A motion y (module `optimize`) of the body at a pose, in the world.
    #[must_use]
    pub fn twist(&self, at: &Isometry3<f64>, y: &Vector6<f64>) -> Twist {
        let axes = self.world_axes(at);
        Twist {
            linear: axes * y.fixed_rows::<3>(0),
            angular: axes * y.fixed_rows::<3>(3) / self.radius,
            about: at * self.centre,
        }
    }

    /// A contact as a constraint of y.
    fn constraint(&self, axes: &Matrix3<f64>, about: &Point3<f64>, contact: &Constraint) -> Linear {
        let force = axes.tr_mul(&contact.normal);
        let moment = axes.tr_mul(&(contact.point - about).cross(&contact.normal)) / self.radius;
        let normal = Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z);
        Linear { normal, offset: -contact.gap }
    }
}

/// Contacts that contradict each other by less than this fraction of the body's radius hold: positions are not known better.
const SLACK: f64 = 1e-10;

/// Which lower bound of depths a metric admits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Certificate {
    /// None: nothing is proved.
    #[default]
    None,
    /// The metric is nowhere less than the body's largest displacement.
    Disp,
    /// It is nowhere less than the body's root mean square displacement.
    SqrtSigma,
}

/// How far a body is from a pose, and which way back.
pub trait Metric {
    /// The distance between two poses, a length: not negative, 0 between equal poses, proportional to the body's scale.
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64;

    /// Which lower bound of depths holds for it.
    fn certificate(&self) -> Certificate {
        Certificate::None
    }

    /// Where motions are measured.
    fn frame(&self) -> &BodyFrame;

    /// The square of the distance from `from`, as a function of a small motion y of the body at `at` (head of module
    /// [`optimize`](super::optimize)). Exact at y = 0 for a metric whose steps are the trait's own.
    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic;

    /// The motion at `at` that brings the body nearest to `from`, to first order, and violates no contact.
    ///
    /// With `at` equal to `from` this is the smallest motion that satisfies the contacts: the push-out of a penetrating
    /// pose. Where no motion satisfies all contacts, the one whose largest violation is least
    /// ([`StepEnd::Infeasible`]).
    ///
    /// # Errors
    /// [`StepError`]: input that is not finite, or too much of it.
    ///
    /// Cost: one quadratic program in six variables, some microseconds; two where it is infeasible.
    fn step(
        &self,
        from: &Isometry3<f64>,
        at: &Isometry3<f64>,
        contacts: &[Constraint],
        options: &StepOptions,
        memory: &mut StepMemory,
    ) -> Result<Step, StepError> {
        prepare(self.frame(), [from, at], contacts, options, memory)?;
        let model = self.model(from, at);
        Ok(quadratic_step(self.frame(), &model, options, memory)?.finish(self.frame(), at))
    }
}

/// Checks a step's input and writes its contacts as constraints into the memory.
fn prepare(
    frame: &BodyFrame,
    poses: [&Isometry3<f64>; 2],
    contacts: &[Constraint],
    options: &StepOptions,
    memory: &mut StepMemory,
) -> Result<(), StepError> {
    if !(options.trust > 0.0 && options.tolerance > 0.0 && options.tolerance < 1.0) {
        return Err(StepError::Options);
    }
    if !poses.iter().all(|p| finite(p)) {
        return Err(StepError::Pose);
    }
    if contacts.len() > memory.capacity() {
        return Err(StepError::Capacity);
    }
    let [_, at] = poses;
    let (axes, about) = (frame.world_axes(at), at * frame.centre);
    memory.contacts.clear();
    for (index, contact) in contacts.iter().enumerate() {
        let linear = frame.constraint(&axes, &about, contact);
        if !(linear.normal.iter().all(|x| x.is_finite()) && linear.offset.is_finite()) {
            return Err(StepError::Contact { index });
        }
        memory.contacts.push(linear);
    }
    Ok(())
}

fn finite(pose: &Isometry3<f64>) -> bool {
    pose.translation.vector.iter().chain(pose.rotation.coords.iter()).all(|x| x.is_finite())
}

/// A step in its own variables.
struct LocalStep {
    y: Vector6<f64>,
    value: f64,
    lower: f64,
    violation: f64,
    programs: usize,
    end: StepEnd,
}

impl LocalStep {
    fn finish(self, frame: &BodyFrame, at: &Isometry3<f64>) -> Step {
        let LocalStep { ref y, value, lower, violation, programs, end } = self;
        Step { twist: frame.twist(at, y), value, lower, violation, programs, end }
    }
}

/// The least of a quadratic under the prepared constraints.
fn quadratic_step(
    frame: &BodyFrame,
    model: &Quadratic,
    options: &StepOptions,
    memory: &mut StepMemory,
) -> Result<LocalStep, StepError> {
    let StepMemory { contacts, rows, .. } = memory;
    let known = model.value.is_finite() && model.gradient.iter().chain(model.hessian.iter()).all(|x| x.is_finite());
    if !known {
        return Err(StepError::Model);
    }
    let solution = minimise(model, contacts, options.trust, rows);
    let value = model.at(&solution.y).sqrt();
    let violation = quadratic::violation(contacts, &solution.y);
    let (end, lower) = match solution.end {
        End::Found => (StepEnd::Optimal, value),
        // Opposite contacts that leave no room but for rounding.
        End::Empty if violation <= SLACK * frame.radius => (StepEnd::Optimal, 0.0),
        End::Empty => (StepEnd::Infeasible, 0.0),
        End::Limit => (StepEnd::Limit, 0.0),
    };
    Ok(LocalStep { y: solution.y, value, lower, violation, programs: solution.programs, end })
}
