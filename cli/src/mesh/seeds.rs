//! Contact samples of a pair as seeds of its queries.

use qdist::mesh::{ContactSamples, Model};
use qdist::nalgebra::Isometry3;

use crate::mesh::bodies;
use crate::mesh::input::Kind;

/// How many are seeds of a query.
const NEAREST: usize = 6;
/// How far they are from each other at least, in diagonals of A.
const APART: f64 = 0.1;

/// The nearest samples of this body, by a metric that it has.
pub fn nearest(samples: &ContactSamples, a: &Model, kind: Kind, pose: &Isometry3<f64>) -> Vec<Isometry3<f64>> {
    let apart = APART * a.mesh().diagonal();
    bodies::metric(a, kind).map_or(Vec::new(), |metric| samples.nearest(metric, pose, NEAREST, apart))
}
