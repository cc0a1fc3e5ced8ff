//! Random numbers, grasps and meshes made by code, which benches share with the tests.

#[path = "../tests/common/mod.rs"]
pub mod common;
pub mod fingertips;
#[path = "../tests/grasp_common/mod.rs"]
pub mod grasp_common;
#[path = "../tests/mesh_common/mod.rs"]
pub mod mesh_common;
