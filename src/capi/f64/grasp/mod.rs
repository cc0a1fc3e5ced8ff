//! Grasps from C, for `f64`.

pub mod contacts;
pub mod forces;
pub mod gradients;
pub mod quality;
pub mod wrenches;
