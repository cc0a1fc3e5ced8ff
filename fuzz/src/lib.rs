//! What the fuzzers check answers against. The oracles are those of the tests.

#[path = "../../tests/common/mod.rs"]
pub mod common;
#[path = "../../tests/mesh_common/mod.rs"]
pub mod mesh_common;
