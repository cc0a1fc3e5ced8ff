//! The C ABI for `f64`: a file for each chapter of the header, and what the chapters share, in `answers`, `asked`, `bodies` and `unit_shapes`.

mod answers;
mod asked;
mod bodies;
pub mod combine;
#[cfg(feature = "grasp")]
pub mod grasp;
pub mod half_space;
pub mod join;
pub mod plane;
pub mod points;
pub mod query;
pub mod sets;
pub mod shapes;
pub mod solver;
pub mod span;
pub mod unit_sets;
mod unit_shapes;
pub mod warm;

use crate::vocabulary::*;
use qdist::nalgebra::SMatrix;
use qdist::qset::UnitSet;
use {answers::*, asked::*, bodies::*, points::*, query::*, sets::*, shapes::*, unit_sets::*, warm::*};

// The exported functions of the dimensions 3 to 6, made of those of dimension 2 by `build.rs`.
include!(concat!(env!("OUT_DIR"), "/dimensions_f64.rs"));
