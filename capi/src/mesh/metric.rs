//! METRICS
//!
//! How far is one pose of A from another? A length, in each case, that depends on A's motion only.

use super::*;
use qdist::mesh::mass::MassProperties;
use qdist::mesh::metric::{BodyFrame, Certificate, Metric, Weighted, WeightedError};
use qdist::mesh::optimize::Quadratic;
use qdist::nalgebra::{Matrix3, Matrix6, Vector6};

/// Which metric?
pub type qdist_mesh_metric = u32;

/// The farthest that any point of A moves (DISP).
pub const QDIST_MESH_DISP: qdist_mesh_metric = 0;
/// The root mean square over the solid A of the lengths that its points move: the root of the object norm sigma. Needs a solid A, or `mass` of
/// the options. With A's own mass never more than QDIST_MESH_DISP.
pub const QDIST_MESH_SIGMA: qdist_mesh_metric = 1;
/// One of yours: `own` of the options.
pub const QDIST_MESH_OWN: qdist_mesh_metric = 2;

/// The distance between two poses, a length: 0 between equal poses, and proportional to A's scale. A pose for which it is negative or not finite is
/// never an answer.
pub type qdist_mesh_own_distance =
    Option<unsafe extern "C" fn(user: *mut c_void, from: *const qdist_mesh_pose, to: *const qdist_mesh_pose) -> f64>;

/// The square of the distance from `from` when A at `to` makes a small motion m:
///
///   distance(from, to)^2 + 2 gradient.m + m^T hessian m
///
/// with m = (v, w): the centre moves by v, and A turns about it by the rotation vector w, both in the axes of B. Write the gradient, exact, and the
/// Hessian, positive semidefinite, row-major; it may be rough, since every step is measured by `distance`. Both are 0 before the call.
pub type qdist_mesh_own_model = Option<
    unsafe extern "C" fn(
        user: *mut c_void,
        from: *const qdist_mesh_pose,
        to: *const qdist_mesh_pose,
        gradient: *mut f64,
        hessian: *mut f64,
    ),
>;

/// A metric of yours. The bracket is true whatever the functions return, as far as `distance` does not change: with a poor model the
/// answer is poor. They are called hundreds of times in a query, and must not unwind, longjmp, or use the pair or tracker that is calling them.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_mesh_own_metric {
    pub struct_size: u32,
    /// What the distance is nowhere less than, between any two poses: QDIST_MESH_DISP, or QDIST_MESH_SIGMA with A's own mass. Its lower bounds hold
    /// for yours, too, then. QDIST_MESH_OWN: not known, and `lower` is 0.
    pub at_least: qdist_mesh_metric,
    /// What rotations are about, in A's frame; coordinates of at most 1e60.
    pub centre: [f64; 3],
    /// What makes an angle a length, e.g. A's radius of gyration; above 0.
    pub radius: f64,
    pub distance: qdist_mesh_own_distance,
    pub model: qdist_mesh_own_model,
    /// For both.
    pub user: *mut c_void,
}
versioned!(qdist_mesh_own_metric);

/// What was chosen, checked.
pub(super) enum Chosen {
    Disp,
    Sigma,
    Weighted(Weighted),
    Own(Own),
}

impl Chosen {
    /// The header: the functions of `own` may be called with its `user` during the call.
    pub(super) fn new(
        metric: qdist_mesh_metric,
        mass: In<qdist_mesh_mass>,
        own: In<qdist_mesh_own_metric>,
    ) -> Check<Chosen> {
        match metric {
            QDIST_MESH_DISP => Ok(Chosen::Disp),
            QDIST_MESH_SIGMA if mass.is_null() => Ok(Chosen::Sigma),
            QDIST_MESH_SIGMA => weighted(mass.get()?).map(Chosen::Weighted),
            QDIST_MESH_OWN => Own::new(own.current()?).map(Chosen::Own),
            _ => Err(QDIST_ERROR_ARGUMENT),
        }
    }

    pub(super) fn of<'q>(&'q self, a: &'q Model) -> Check<&'q dyn Metric> {
        match self {
            Chosen::Disp => Ok(a.disp()),
            Chosen::Sigma => a.sigma().map(|sigma| sigma as _).ok_or(QDIST_ERROR_MESH_NOT_SOLID),
            Chosen::Weighted(weighted) => Ok(weighted),
            Chosen::Own(own) if matches!(own.certificate, Certificate::SqrtSigma) && a.sigma().is_none() => {
                Err(QDIST_ERROR_MESH_NOT_SOLID)
            }
            Chosen::Own(own) => Ok(own),
        }
    }
}

/// The caller's mass, checked.
fn weighted(mass: &qdist_mesh_mass) -> Check<Weighted> {
    let (centre, inertia) = (Point3::from(mass.centre), Matrix3::from_row_slice(&mass.inertia));
    Weighted::new(&MassProperties { volume: mass.volume, centre, inertia }).map_err(|error| match error {
        WeightedError::NotFinite => QDIST_ERROR_NONFINITE,
        _ => QDIST_ERROR_ARGUMENT,
    })
}

/// The caller's functions as a metric.
pub(super) struct Own {
    frame: BodyFrame,
    certificate: Certificate,
    distance: unsafe extern "C" fn(*mut c_void, *const qdist_mesh_pose, *const qdist_mesh_pose) -> f64,
    model: unsafe extern "C" fn(*mut c_void, *const qdist_mesh_pose, *const qdist_mesh_pose, *mut f64, *mut f64),
    user: *mut c_void,
}

impl Own {
    fn new(own: &qdist_mesh_own_metric) -> Check<Own> {
        let (Some(distance), Some(model)) = (own.distance, own.model) else { return Err(QDIST_ERROR_NULL) };
        coordinates(&[own.radius])?;
        if !own.centre.iter().all(|x| x.abs() <= MAX_COORDINATE) {
            return Err(QDIST_ERROR_NONFINITE);
        }
        if !(own.radius > 0.0) {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let certificate = match own.at_least {
            QDIST_MESH_DISP => Certificate::Disp,
            QDIST_MESH_SIGMA => Certificate::SqrtSigma,
            QDIST_MESH_OWN => Certificate::None,
            _ => return Err(QDIST_ERROR_ARGUMENT),
        };
        let frame = BodyFrame { centre: Point3::from(own.centre), axes: Matrix3::identity(), radius: own.radius };
        Ok(Own { frame, certificate, distance, model, user: own.user })
    }
}

impl Metric for Own {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        let [from, to] = [from, to].map(qdist_mesh_pose::new);
        // SAFETY: the promise of `Chosen::new`.
        let value = unsafe { (self.distance)(self.user, &from, &to) };
        // What is no distance is farther than anything.
        if value >= 0.0 { value } else { f64::INFINITY }
    }

    fn certificate(&self) -> Certificate {
        self.certificate
    }

    fn frame(&self) -> &BodyFrame {
        &self.frame
    }

    /// m = (R y_v, R y_w / radius), R being the rotation of `at`.
    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        let (mut gradient, mut hessian) = ([0.0; 6], [0.0; 36]);
        let poses = [from, at].map(qdist_mesh_pose::new);
        // SAFETY: the promise of `Chosen::new`; the arrays have the lengths that the header says.
        unsafe { (self.model)(self.user, &poses[0], &poses[1], gradient.as_mut_ptr(), hessian.as_mut_ptr()) };
        let turn = at.rotation.to_rotation_matrix().into_inner();
        let mut motion = Matrix6::zeros();
        motion.fixed_view_mut::<3, 3>(0, 0).copy_from(&turn);
        motion.fixed_view_mut::<3, 3>(3, 3).copy_from(&(turn / self.frame.radius));
        Quadratic {
            value: self.distance(from, at).powi(2),
            gradient: motion.tr_mul(&Vector6::from(gradient)),
            hessian: motion.tr_mul(&Matrix6::from_row_slice(&hessian)) * motion,
        }
    }
}
