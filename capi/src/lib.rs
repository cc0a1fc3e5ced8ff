//! The C ABI of qdist: `include/qdist.h`, `qdist_grasp.h` and `qdist_mesh.h`, generated from this crate by `./x header`.
//!
//! * [`status`], [`symmetry`], [`version`], [`workspace`]: codes and their names, and callbacks without a scalar.
//! * [`handle`]: a solver in the caller's memory.
//! * `grasp` (feature): codes of the second header, `include/qdist_grasp.h`, whose structs and functions are in `f64::grasp`.
//! * `mesh` (feature): the third header, `include/qdist_mesh.h`, of a library that needs `std`.
//! * [`pointer`]: pointers of the caller as types, `In` and `Out`. [`callback`]: the caller's functions. [`numbers`]: checks, and loops over
//!   run-time dimensions.
//! * [`f64`](mod@f64): the structs and functions with suffix `_f64`. [`f32`](mod@f32): the same with `_f32`, made of their text by `build.rs`.
//! * `vocabulary`: the one namespace of all these names, as C has it, so that files import little else.
//! * `panic` (feature): what the freestanding library does about a panic, which cannot happen.
//!
//! Why text, and not structs and functions that are generic in the scalar: C sees names, and the generator of the header sees no macros, so that
//! every function would be written out for each scalar all the same, with a generic body behind it. The text is shorter, reads without type
//! parameters, and what is behind a function of C is one function away. What does not name a struct of the header is generic, and exists once.
//!
//! A pointer is checked where it comes in, and is a reference from there on. So exported functions are safe code, and `unsafe` stands in [`pointer`],
//! [`callback`] and [`handle`], where a struct of the header is behind a `user` ([`f64::answers`]), where a unit set of the caller answers
//! ([`f64::unit_sets`]), and in a few lines elsewhere, each with the fact that makes it right. (The compiler's lint `unsafe_code` also refuses names for
//! C, which every chapter has; so a test looks, `tests/core/house.rs`.)
//!
//! Nothing here switches between dimensions, shapes or scalars at run time where that would link much code which a program does not use: nearly
//! every entry point names all three.
#![cfg_attr(not(any(test, feature = "std")), no_std)]
// The comments are the header's text, where brackets are not links.
#![allow(rustdoc::broken_intra_doc_links, rustdoc::private_intra_doc_links)]
// Fields whose name says all need no comment in the header.
#![allow(missing_docs)]
#![allow(non_camel_case_types)]
#![deny(clippy::undocumented_unsafe_blocks)]

include!(concat!(env!("OUT_DIR"), "/f32.rs"));
#[cfg(chosen)] // (Some functions only: `build.rs`.)
include!(concat!(env!("OUT_DIR"), "/f64.rs"));
mod callback;
#[cfg(not(chosen))]
pub mod f64;
#[cfg(feature = "grasp")]
pub mod grasp;
pub mod handle;
mod layout;
#[cfg(feature = "mesh")]
pub mod mesh;
mod numbers;
#[cfg(all(feature = "panic-handler", not(feature = "std"), not(test), panic = "abort"))]
mod panic;
mod pointer;
pub mod status;
pub mod symmetry;
pub mod version;
mod vocabulary;
pub mod workspace;
