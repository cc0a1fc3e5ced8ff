//! qdist (essay to come)
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![warn(missing_docs)]
#![allow(clippy::needless_range_loop)]

pub mod answer;
pub mod bounds;
pub mod depth;
mod distance;
mod meridian;
mod polytope;
pub mod prepare;
pub mod qset;
mod query;
pub mod scalar;
pub mod simplex;
pub mod solver;
pub mod support;
pub mod workspace;

pub use answer::{Answer, Outcome};
pub use depth::{Body, BodyError, Depth};
pub use polytope::Vertex;
pub use query::Options;
pub use scalar::{Real, Vector};
pub use solver::Solver;
pub use workspace::Workspace;

/// Failure code: a callback returned a value that is not finite.
pub const NOT_FINITE: i32 = i32::MIN;
/// Failure code: an internal set has no points.
pub(crate) const EMPTY: i32 = i32::MIN + 1;
