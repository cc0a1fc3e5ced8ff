// generated from f64/grasp/mod.rs by `make header`; do not edit
//! Grasps from C, for `f32`.

pub mod contacts;
pub mod fingers;
pub mod forces;
pub mod gradients;
pub mod linearized;
pub mod quality;
pub mod wrenches;
