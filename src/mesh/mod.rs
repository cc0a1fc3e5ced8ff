//! Triangle meshes.

pub mod certificate;
