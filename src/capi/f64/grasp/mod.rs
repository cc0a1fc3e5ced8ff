//! Grasps from C, for `f64`.

pub mod contacts;
pub mod quality;
pub mod wrenches;
