//! The C ABI of the mesh layer: `include/qdist_mesh.h`, generated from this module by `./x header`.
//!
//! * [`model`]: meshes from arrays, what is wrong with them, and their mass.
//! * [`pair`]: two of them: collision, distance, contacts.
//! * [`metric`]: how far one pose is from another; a metric of the caller's.
//! * [`depth`]: generalized penetration depth.
//! * [`tracker`]: the same in a control loop, tick by tick.
//! * `allocator` (feature `c-allocator`): where the C library's memory comes from.
//!
//! Handles are boxes. Pairs and trackers share their meshes by reference counting (`between`), so that they may be freed in any order. Every call
//! runs in [`guard`]: a panic, which would be a defect, becomes a status.

#[cfg(feature = "c-allocator")]
pub mod allocator;
mod between;
pub mod depth;
mod guard;
pub mod metric;
pub mod model;
pub mod pair;
pub mod tracker;

use crate::vocabulary::*;
use qdist::mesh::{MAX_COORDINATE, MeshDepth, Model, Outcome};
use qdist::nalgebra::{Isometry3, Point3};
use {between::*, depth::*, guard::*, metric::*, model::*, pair::*, tracker::*};
