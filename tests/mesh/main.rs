//! Triangle meshes: queries of pairs, certificates, depth.
#![cfg(feature = "mesh")]

#[macro_use]
#[path = "../common/mod.rs"]
mod common;
#[path = "../mesh_common/mod.rs"]
mod mesh_common;

mod certificate;
mod collide;
mod contacts;
mod depth;
mod distance;
mod golden;
mod metric;
mod optimize;
mod samples;
mod screw;
mod surface;
mod tracker;
mod walks;
