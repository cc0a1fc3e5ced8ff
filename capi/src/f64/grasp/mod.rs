//! Grasps from C, for `f64`.

pub mod contacts;
pub mod fingers;
pub mod forces;
pub mod gradients;
pub mod linearized;
pub mod pyramids;
pub mod quality;
pub mod wrenches;
