//! Contact configurations that are sampled once and serve every query as seeds (section IV-D of the paper).
//!
//! A sample is a pose at which the bodies touch: a random free pose and a random colliding one are joined by a screw, and the last free
//! pose before the colliding one is found by bisection (`draw`). Rotations are uniform, and translations such that the bounding balls overlap,
//! so the samples lie all over the boundary of the free space.
//!
//! A query takes the K samples that are nearest by its own metric, none of them nearer to another than a given distance, so that they
//! do not all lie in one valley. They come best first: a sample is entered with a lower bound of its distance, how far A's centre moves, and
//! the metric itself is asked only for those whose bound comes up. (A root mean square displacement is not less than that of the centre of
//! mass, and a largest one not less than that of any point of the convex hull.)
//!
//! Samples are kept as bytes (`bytes`), with fingerprints of the bodies that they belong to.

mod bytes;
mod draw;

use super::super::DepthSolver;
use crate::mesh::metric::{Certificate, Metric};
use crate::mesh::{MAX_COORDINATE, Model};
pub use bytes::SamplesError;
use bytes::fingerprint;
use draw::Sampler;
use nalgebra::{Isometry3, Point3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How much a quaternion's norm may differ from 1.
const UNIT: f64 = 1e-9;
/// Rounding of lower bounds, relative to the coordinates.
const ROUNDING: f64 = 1e-12;

/// Contact configurations of a pair, built once.
///
/// Queries take them as [`DepthOptions::poses`](crate::mesh::DepthOptions::poses). They never harm an answer: a query tests every pose itself.
///
/// ```
/// use qdist::mesh::{ContactSamples, DepthOptions, DepthSolver, Model};
/// use qdist::nalgebra::Isometry3;
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
/// let samples = ContactSamples::new(&body, &body, 100, 0, None);
///
/// let bytes = samples.to_bytes();
/// let samples = ContactSamples::from_bytes(&bytes, &body, &body)?;
///
/// let pose = Isometry3::translation(0.0, 0.0, 0.9);
/// let near = samples.nearest(body.disp(), &pose, 4, 0.1);
/// let options = DepthOptions { poses: &near, rays: false, push_out: false, ..DepthOptions::default() };
/// let depth = DepthSolver::new(&body, &body).depth(&pose, body.disp(), &options, None);
/// assert!(near.len() == 4 && depth.upper < 0.11);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSamples {
    pair: [u64; 2],
    poses: Vec<Isometry3<f64>>,
    /// A's centre of mass, or a point of its convex hull.
    centre: Point3<f64>,
    /// Whether it is the centre of mass.
    solid: bool,
    /// Where the poses place it.
    placed: Vec<Point3<f64>>,
}

impl ContactSamples {
    /// Makes so many samples, from the random sequence of this number: the same bodies, count and seed give the same samples, and a larger
    /// count the same with others behind. `watch` is told how many there are, after each; true stops, and what there is is kept.
    ///
    /// All are free by the solid test, and touch to 1e-6 of A's diagonal. There are fewer only where no free pose can be written down. Cost: some 30
    /// collision queries each, a tenth of a millisecond to half of one for meshes of 3,000 triangles.
    pub fn new(
        a: &Model,
        b: &Model,
        count: usize,
        seed: u64,
        mut watch: Option<&mut dyn FnMut(usize) -> bool>,
    ) -> ContactSamples {
        let mut sampler = Sampler::new(a.mesh(), b.mesh(), seed);
        let mut poses = Vec::with_capacity(count.min(1 << 16));
        // A pair without any free pose (coordinates at the end of what numbers can do) has no samples.
        while poses.len() < count {
            let Some(pose) = sampler.sample() else { break };
            poses.push(pose);
            if watch.as_mut().is_some_and(|watch| watch(poses.len())) {
                break;
            }
        }
        ContactSamples::of(a, b, poses)
    }

    /// Takes poses that were kept elsewhere ([`poses`](ContactSamples::poses)). They need not touch.
    ///
    /// # Errors
    /// [`SamplesError::Pose`].
    pub fn from_poses(a: &Model, b: &Model, poses: Vec<Isometry3<f64>>) -> Result<ContactSamples, SamplesError> {
        match poses.iter().position(|pose| !is_proper(pose)) {
            Some(index) => Err(SamplesError::Pose { index }),
            None => Ok(ContactSamples::of(a, b, poses)),
        }
    }

    fn of(a: &Model, b: &Model, poses: Vec<Isometry3<f64>>) -> ContactSamples {
        let sigma = a.sigma();
        let centre = sigma.map_or(a.disp() as &dyn Metric, |sigma| sigma).frame().centre;
        let placed = poses.iter().map(|pose| pose * centre).collect();
        ContactSamples { pair: [a, b].map(|m| fingerprint(m.mesh())), poses, centre, solid: sigma.is_some(), placed }
    }

    /// The poses of A in the frame of B.
    pub fn poses(&self) -> &[Isometry3<f64>] {
        &self.poses
    }

    /// Whether they were made for the bodies of this solver. O(n) in vertices and triangles.
    pub fn fit(&self, solver: &DepthSolver) -> bool {
        self.pair == [solver.a(), solver.b()].map(|m| fingerprint(m.mesh()))
    }

    /// The `k` samples that are nearest to a pose by this metric, the nearest first; of two that are not farther from each other than `apart`, a length,
    /// only the nearer. Fewer than `k` where there are no more.
    ///
    /// Cost: O(n + m log n) and the metric m + k m times, m being the number of samples whose centre of A is nearer than the last one's distance;
    /// all n for a metric with [`Certificate::None`].
    #[must_use]
    pub fn nearest(&self, metric: &dyn Metric, pose: &Isometry3<f64>, k: usize, apart: f64) -> Vec<Isometry3<f64>> {
        let bounded = match metric.certificate() {
            Certificate::None => false,
            Certificate::Disp => true,
            Certificate::SqrtSigma => self.solid,
        };
        let centre = pose * self.centre;
        let bound = |placed: &Point3<f64>| {
            let slack = ROUNDING * (centre.coords.amax() + placed.coords.amax() + self.centre.coords.amax());
            if bounded { (centre - placed).norm() * (1.0 - ROUNDING) - slack } else { 0.0 }
        };
        // The bound of a sample comes before its distance, and of equals the one with the lower number comes first.
        let entry = |key: f64, exact: bool, index: usize| Reverse((ordered(key), exact, index));
        let mut queue: BinaryHeap<_> =
            self.placed.iter().enumerate().map(|(i, placed)| entry(bound(placed), false, i)).collect();
        let mut chosen: Vec<Isometry3<f64>> = Vec::with_capacity(k.min(self.poses.len()));
        while chosen.len() < k
            && let Some(Reverse((_, exact, i))) = queue.pop()
        {
            let sample = &self.poses[i];
            if !exact {
                queue.push(entry(metric.distance(pose, sample), true, i));
            } else if chosen.iter().all(|c| metric.distance(c, sample) > apart) {
                chosen.push(*sample);
            }
        }
        chosen
    }
}

fn is_proper(pose: &Isometry3<f64>) -> bool {
    (pose.rotation.quaternion().norm() - 1.0).abs() <= UNIT
        && pose.translation.vector.iter().all(|x| x.abs() <= MAX_COORDINATE)
}

/// Numbers from 0 up in their order; what is below counts as 0, and what is no number stands behind all.
fn ordered(x: f64) -> u64 {
    if x <= 0.0 { 0 } else { x.abs().to_bits() }
}
