//! The C ABI for `f64`.

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
pub mod warm;
