//! The root mean square over a mass that need not be the body's own volume: a shell, a load, a body whose mesh is open.

use super::super::mass::MassProperties;
use super::super::optimize::Quadratic;
use super::super::surface::MAX_COORDINATE;
use super::{BodyFrame, Metric, Sigma};
use core::fmt;
use nalgebra::Isometry3;

/// Root mean square displacement over a distribution of mass of yours. What is proved of a solid's own volume is not of this one, so it is a metric of
/// its own, without a lower bound ([`Certificate::None`](super::Certificate::None)).
///
/// ```
/// use nalgebra::{Isometry3, Matrix3, Point3};
/// use qdist::mesh::{mass::MassProperties, metric::{Metric, Weighted}};
///
/// let shell = MassProperties { volume: 3.0, centre: Point3::origin(), inertia: Matrix3::identity() * 2.0 };
/// let shift = Isometry3::translation(0.0, 3.0, 4.0);
/// assert!((Weighted::new(&shell)?.distance(&Isometry3::identity(), &shift) - 5.0).abs() < 1e-15);
/// # Ok::<(), qdist::mesh::metric::WeightedError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Weighted(Sigma);

/// Why numbers are no distribution of mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WeightedError {
    /// A number is not finite, or a coordinate of the centre too large.
    NotFinite,
    /// The volume is not above 0, or no body has this inertia tensor: symmetric, positive, and its principal moments keep the triangle inequality.
    NoBody,
}

impl fmt::Display for WeightedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            WeightedError::NotFinite => "a number of the mass is not finite or too large",
            WeightedError::NoBody => "no body has this volume and inertia",
        })
    }
}

impl core::error::Error for WeightedError {}

impl Weighted {
    /// The metric of a mass, of which the volume only scales the inertia.
    ///
    /// # Errors
    /// [`WeightedError`]: no body has this mass, to 1e-9 of the inertia tensor's largest entry, or it lies on a line.
    pub fn new(mass: &MassProperties) -> Result<Self, WeightedError> {
        let finite = mass.volume.is_finite() && mass.inertia.iter().all(|x| x.is_finite());
        if !(finite && mass.centre.iter().all(|x| x.abs() <= MAX_COORDINATE)) {
            return Err(WeightedError::NotFinite);
        }
        let size = mass.inertia.amax();
        if !(mass.volume > 0.0 && (size / mass.volume).is_normal()) {
            return Err(WeightedError::NoBody);
        }
        // Mass has no negative second moments, trace / 2 - I, and here it does not lie on a line.
        let scaled = mass.inertia / size;
        let principal = scaled.symmetric_eigenvalues();
        let is_body = principal.min() > 1e-9 && 2.0 * principal.max() <= principal.sum() + 1e-9;
        if (scaled - scaled.transpose()).amax() > 1e-9 || !is_body {
            return Err(WeightedError::NoBody);
        }
        Ok(Weighted(Sigma::new(mass)))
    }
}

impl Metric for Weighted {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        self.0.distance(from, to)
    }

    fn frame(&self) -> &BodyFrame {
        self.0.frame()
    }

    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        self.0.model(from, at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Point3, Vector3};

    fn mass(volume: f64, moments: [f64; 3]) -> MassProperties {
        MassProperties { volume, centre: Point3::origin(), inertia: Matrix3::from_diagonal(&Vector3::from(moments)) }
    }

    #[test]
    fn what_no_body_has_is_refused() {
        let tried = |mass: &MassProperties| Weighted::new(mass).err();
        assert_eq!(tried(&mass(1.0, [1.0, 1.0, 1.0])), None);
        assert_eq!(tried(&mass(1e-9, [1.0, 1.0, 2.0])), None);
        for none in [[1.0, 1.0, 2.1], [1.0, 1.0, 0.0], [-1.0, 1.0, 1.0], [0.0; 3]] {
            assert_eq!(tried(&mass(1.0, none)), Some(WeightedError::NoBody), "{none:?}");
        }
        let mut skew = mass(1.0, [1.0, 1.0, 1.0]);
        skew.inertia[(0, 1)] = 0.1;
        assert_eq!(tried(&skew), Some(WeightedError::NoBody));
        assert_eq!(tried(&mass(0.0, [1.0; 3])), Some(WeightedError::NoBody));
        assert_eq!(tried(&mass(f64::NAN, [1.0; 3])), Some(WeightedError::NotFinite));
        let far = MassProperties { centre: Point3::new(1e61, 0.0, 0.0), ..mass(1.0, [1.0; 3]) };
        assert_eq!(tried(&far), Some(WeightedError::NotFinite));
    }
}
