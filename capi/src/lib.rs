//! The C ABI of qdist: `include/qdist.h`, `qdist_grasp.h` and `qdist_mesh.h`, generated from this crate by `make header`.
//!
//! * [`status`], [`symmetry`], [`version`]: codes and their names, and callbacks without a scalar.
//! * [`handle`]: a solver in the caller's memory.
//! * `grasp` (feature): codes of the second header, `include/qdist_grasp.h`, whose structs and functions are in `f64::grasp`.
//! * `mesh` (feature): the third header, `include/qdist_mesh.h`, of a library that needs `std`.
//! * [`generic`]: what the entry points of both scalars share. Checked pointers, callbacks as a
//!   [`Support`](qdist::support::Support) and a [`UnitSet`](qdist::qset::Unit set), and loops over run-time dimensions.
//! * [`f64`](mod@f64): the structs and functions with suffix `_f64`, written by hand, since the header generator does not
//!   expand macros. [`f32`](mod@f32): the same with `_f32`, made of it by `build.rs`.
//! * `panic` (feature): what the freestanding library does about a panic, which cannot happen.
//!
//! Nothing here switches between dimensions, shapes or scalars at run time where that would link code which a program does
//! not use: each entry point names all three.
//!
//! The functions are `unsafe` to call from Rust; the header states what C callers promise, once for all of them.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
// The comments are the header's text, where brackets are not links.
#![allow(rustdoc::broken_intra_doc_links, rustdoc::private_intra_doc_links)]
// Fields whose name says all need no comment in the header.
#![allow(missing_docs)]
#![allow(non_camel_case_types, clippy::missing_safety_doc, clippy::neg_cmp_op_on_partial_ord)]

include!(concat!(env!("OUT_DIR"), "/f32.rs"));
pub mod f64;
mod generic;
#[cfg(feature = "grasp")]
pub mod grasp;
pub mod handle;
#[cfg(feature = "mesh")]
pub mod mesh;
#[cfg(all(feature = "panic-handler", not(feature = "std"), not(test), panic = "abort"))]
mod panic;
pub mod status;
pub mod symmetry;
pub mod version;
