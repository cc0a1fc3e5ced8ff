//! Triangle meshes: what they are made of, and how two of them lie to each other.
//!
//! Everything here is `f64` only and may allocate, but only when something is built; queries reuse the memory of their
//! [`Pair`]. A pose is an [`Isometry3`](nalgebra::Isometry3) that places A in the frame of B: x_B = R x_A + t. B rests. Every point and every
//! direction that a query returns is in the frame of B.
//!
//! ```
//! use qdist::mesh::{Mesh, Pair};
//! use qdist::nalgebra::{Isometry3, Vector3};
//!
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let tetrahedron = Mesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?;
//! assert!(tetrahedron.is_solid());
//!
//! let mut pair = Pair::new(&tetrahedron, &tetrahedron);
//! assert!(pair.collides(&Isometry3::translation(0.1, 0.1, 0.1)));
//! let apart = Isometry3::from_parts(Vector3::new(0.0, 0.0, 1.5).into(), Default::default());
//! assert!(!pair.collides(&apart));
//! assert!((pair.distance(&apart).distance - 0.5).abs() < 1e-12);
//! # Ok::<(), qdist::mesh::MeshError>(())
//! ```
//!
//! Depth is asked of [`Model`]s, meshes with what queries derive from them once; [`Model::with_pieces`] adds what lower bounds come from, which are 0
//! without:
//!
//! ```
//! use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, Model, Outcome};
//! use qdist::nalgebra::Isometry3;
//!
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?.with_pieces(&Default::default())?;
//!
//! let pose = Isometry3::translation(0.0, 0.0, 0.9);
//! let cold = DepthSolver::new(&body, &body).depth(&pose, body.disp(), &DepthOptions::default(), None);
//! assert_eq!(cold.outcome, Outcome::Converged);
//! assert!(cold.lower > 0.0576 && cold.upper < 0.0578); // 0.1 / sqrt(3), across the slanted face
//!
//! let mut tracker = DepthTracker::new(&body, &body); // for a control loop
//! tracker.merge(&cold);
//! let warm = tracker.update(&pose, body.disp(), &Budget::default(), None);
//! assert!(warm.lower <= warm.upper && warm.upper < 0.0578);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Parts
//!
//! ```text
//! depth                       generalized penetration depth: seeds, walks, bracket
//!  model                      a body: a mesh with its metrics
//! certificate                 how far A must move at the least: convex pieces inside both, and the core's depth
//! metric                      how far a pose is from another: DISP, object norm
//!  optimize                   the best small motion that contacts allow
//!   mass  hull                volume, centre, inertia; vertices of the convex hull
//! proximity                   two meshes: solid test, distance, contacts, motion along a screw
//!  pose                       which poses are accepted, and what they mean
//!  surface                    a mesh: vertices, triangles, and all that is derived from them once
//!   check                     what is wrong with it, and whether it bounds a solid
//!   cones                     a tree of cones of normals over the triangles
//!   crossing                  whether it crosses itself
//!   bvh                       a tree of boxes over the triangles
//!    topology                 edges, neighbours, components, convexity
//!    triangle                 two triangles, a point and a triangle, two segments
//! ```
//!
//! # Solids and soups
//!
//! A mesh is taken as it is; nothing is repaired. If its triangles close up with a consistent winding, outward, it bounds a solid and
//! is treated as one: what lies inside it collides with it. Otherwise it is a *polygon soup*, a surface without an inside, and queries see the
//! surface only. [`Report`] says which, and what is wrong where.

mod bvh;
pub mod certificate;
mod check;
mod cones;
mod crossing;
mod depth;
pub mod hull;
pub mod mass;
pub mod metric;
mod model;
pub mod optimize;
mod pose;
mod proximity;
mod surface;
mod topology;
mod triangle;

pub use check::Report;
pub use depth::{
    Budget, ContactSamples, DepthOptions, DepthSolver, DepthTracker, MeshDepth, Outcome, Progress, SamplesError, Walk,
    Watch,
};
pub use model::{Model, ModelError};
pub use proximity::{Contact, Counters, Distance, Impact, Pair, Screw, Stop};
pub use surface::{MAX_COORDINATE, Mesh, MeshError};
pub use topology::{Edge, EdgeKind, Feature, Topology};
