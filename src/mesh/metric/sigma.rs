//! The object norm of Kazerounian and Rastegar: the mean square displacement over the solid, here its root, a length.
//!
//! Between two poses with relative rotation quaternion (s, q) and displacement e of the centre of mass
//!
//! ```text
//! sigma = |e|^2 + (4/V) q^T I q = |e|^2 + (2q)^T K (2q),     K = I / V
//! ```
//!
//! with I the inertia tensor about the centre of mass at density 1, q and I in the same axes, whichever. (Equation 4 of Zhang, Kim
//! and Manocha, who give the square.) A rotation w of the moved body, in the body's axes, takes q to q + (s w + q x w)/2 to first
//! order, so the square is a quadratic of the motion with Hessian (1, M^T K M), M = s + [q]x, which is exact
//! in the variables (e, 2q). M is singular for a half turn: turning on about certain axes then changes nothing to first order.

use super::super::mass::MassProperties;
use super::super::optimize::Quadratic;
use super::{BodyFrame, Certificate, Metric};
use nalgebra::{Isometry3, Matrix3, Matrix6, Vector3, Vector6};

/// Root mean square displacement over a solid.
///
/// ```
/// use nalgebra::{Isometry3, Point3, Vector3};
/// use qdist::mesh::{mass::MassProperties, metric::{Metric, Sigma}};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from);
/// let solid = MassProperties::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
/// let shift = Isometry3::translation(0.0, 3.0, 4.0);
/// assert!((Sigma::new(&solid).distance(&Isometry3::identity(), &shift) - 5.0).abs() < 1e-15);
/// # Ok::<(), qdist::mesh::mass::MassError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sigma {
    /// At the centre of mass, in principal axes; the radius is the root mean square distance from it.
    frame: BodyFrame,
    /// K in these axes, diagonal.
    gyration: Vector3<f64>,
}

impl Sigma {
    /// The metric of a solid.
    #[must_use]
    pub fn new(mass: &MassProperties) -> Self {
        let gyration = mass.inertia / mass.volume;
        // The trace of the inertia tensor is twice the integral of |x|^2.
        let frame = BodyFrame::principal(mass.centre, &gyration, (gyration.trace() / 2.0).sqrt());
        // A needle's smallest is lost in rounding.
        let gyration = (frame.axes.transpose() * gyration * frame.axes).diagonal().map(|x| x.max(0.0));
        Sigma { frame, gyration }
    }

    /// The relative rotation's (s, 2q), s >= 0, in the body's axes.
    fn rotation(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> (f64, Vector3<f64>) {
        // Of the difference's sine and cosine the vector part is exact to rounding for small turns.
        let turn = (from.rotation.inverse() * to.rotation).into_inner();
        let norm = turn.norm();
        let sign = if turn.w < 0.0 { -1.0 } else { 1.0 } / if norm > 0.0 { norm } else { 1.0 };
        (turn.w * sign, self.frame.axes.tr_mul(&turn.imag()) * (2.0 * sign))
    }
}

impl Metric for Sigma {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        let (_, e) = self.frame.displacement(from, to);
        let (_, z) = self.rotation(from, to);
        (e.norm_squared() + z.dot(&z.component_mul(&self.gyration))).sqrt()
    }

    fn certificate(&self) -> Certificate {
        Certificate::SqrtSigma
    }

    fn frame(&self) -> &BodyFrame {
        &self.frame
    }

    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        let (_, e) = self.frame.displacement(from, at);
        let e = self.frame.world_axes(at).tr_mul(&e);
        let (s, z) = self.rotation(from, at);
        let k = Matrix3::from_diagonal(&self.gyration);
        let m = (Matrix3::identity() * s + z.cross_matrix() / 2.0) / self.frame.radius;
        let couple = m.tr_mul(&(k * z));
        let mut hessian = Matrix6::identity();
        hessian.fixed_view_mut::<3, 3>(3, 3).copy_from(&(m.transpose() * k * m));
        Quadratic {
            value: e.norm_squared() + z.dot(&(k * z)),
            gradient: Vector6::new(e.x, e.y, e.z, couple.x, couple.y, couple.z),
            hessian,
        }
    }
}
