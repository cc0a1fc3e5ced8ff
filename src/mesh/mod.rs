//! Generalized penetration depth of triangle meshes.

pub mod hull;
pub mod mass;
pub mod metric;
pub mod optimize;
