//! *How deep is this point, body or grasp inside that set, and how sure are we?*
//!
//! qdist computes the generalized penetration distance of Zheng & Yamane,
//!
//! ```text
//! d_Q(A) = max { λ : λQ ⊂ A } = min over u of h_A(u) / h_Q(u)         (eq. 16, Proposition 1)
//! ```
//!
//! of the origin in a compact convex set A, measured by a convex set Q, for controllers that have no heap and no
//! time. Every answer is a **bracket** `lower <= d <= upper`, true in floating point, with the direction that proves `upper` and
//! the points of A that prove `lower`, whatever stopped the run. Depth of two bodies, in space or in the plane, is the special case
//! A = difference of the bodies, Q = unit ball:
//!
//! ```
//! use qdist::{Body, Options, Vector, Workspace, support::{BoxShape, Cylinder}};
//!
//! let crate_ = BoxShape::new(Vector::from([0.5, 0.5, 0.5]))?;
//! let post = Cylinder::new(0.1, 1.0)?;
//! let mut memory = Workspace::<f64, 3, 64, 128>::new(); // 64 vertices, 128 facets: 12 KB, no heap
//!
//! let a = Body::at(&crate_, Vector::zeros());
//! let b = Body::at(&post, Vector::from([0.55, 0.0, 0.0]));
//! let depth = memory.solver().depth(&a, &b, &Options::default());
//!
//! assert!(depth.lower <= 0.05 && 0.05 <= depth.upper); // the post is 5 cm inside the crate
//! assert!((depth.normal - Vector::from([1.0, 0.0, 0.0])).amax() < 1e-6); // and leaves along x
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # How it works
//!
//! Both sets are known by their support functions only ([`support`], [`qset`]). The solver ([`Solver`]) grows a polytope inside A
//! (`plan::expansion`, Algorithm 1 of the paper). The facet that is lowest with respect to Q bounds d from below; the support value along that facet's normal
//! bounds d from above, since *any* direction does; and the support point, put into the polytope, raises the facet.
//! It ends when both bounds agree to the tolerance, when a threshold is decided, when arithmetic has nothing left to
//! say, or when the caller's limit is reached; the bracket is true at every moment, so any end is a good end.
//!
//! In six dimensions a polytope outgrows any memory. Then the same expansion goes over all directions cone by cone (`plan::conewise`), in the same
//! memory, whatever its size. A polytopal Q needs neither: one ray per vertex is a convex problem (`plan::rays`); where a polytope may be
//! cheaper, the two take turns (`plan::race`). From tick to tick of a control loop the bracket moves along with the set ([`Tracker`]). Meshes, which are not
//! convex, have a search of their own, and a tracker of their own (`mesh::depth`).
//!
//! In `f32`, the default tolerance of a depth that is a thousandth of the bodies' size is two roundoffs of theirs: what rounding leaves open is measured once
//! more with points in two words (`solver::depth::fine`).
//!
//! Three things keep it exact and fast:
//!
//! * The **bookkeeping** (`polytope`) is adjacency: what a new point eliminates is found by walking, the new facets'
//!   neighbours by turning through the eliminated patch, their normals as combinations of two old ones. Rounding can
//!   make the surface loose, not inconsistent.
//! * The **bounds** (`bounds`) use of that surface only that it is closed and where its vertices lie. The rounding
//!   margins are derived there.
//! * **What a query does not need is not done.** Balls swept over a set (spheres, capsules, margins, and the ball that
//!   rolls inside an ellipsoid) are added at the end, exactly, and where that leaves the cores apart their distance
//!   (`plan::distance`, GJK) is the whole answer. Bodies that turn about one axis are solved in a plane (`solver::depth::meridian`), those
//!   that nearly do, or of which one has a corner on the other's axis, sector by sector (`solver::depth::sectors`). Facets above the best upper
//!   bound are never queued.
//!
//! # The house
//!
//! Arrows point down; nobody knows who is above, but for one name: a shape says by which route of `solver::depth` it wants to be measured, so that a program
//! without that shape does not contain the route (`tests/core/house.rs` checks all of it).
//!
//! ```text
//! mesh        triangle meshes: how far out (feature)
//! grasp       contacts, friction, hands: wrench sets (feature)
//! solver      which plan answers, and what one can ask: depth of bodies, warm start, flat sets, many sets, graphs of large hulls
//! plan        rays, their race with expansion, expansion (Algorithm 1), conewise expansion, distance
//! query       one query's state: options, best upper bound, bracket, answer
//! polytope    vertices, facets, ridges, horizon, queue; small simplices
//! bounds      what certifies the bracket, and its rounding
//! qset        the sets Q
//! support     the sets A: shapes, combinations, hulls
//! math        vectors, sums in twice the precision
//! scalar      f32 and f64
//! ```
//!
//! The C layer is a package of its own, `capi`, and stands on all of this. (`tests/core/house.rs` reads this list, and fails where an arrow points up.) Where a test goes, of a new shape,
//! plan, seed or margin: `tests/README.md`.
//!
//! # Memory, threads, failure
//!
//! All memory is the caller's: a [`Workspace`] in a static or on the stack, or any aligned bytes ([`place`]). Capacities are run-time numbers,
//! so there is one compiled solver per dimension (2 to 6) and scalar. There are no globals; a [`Solver`] is used by
//! one thread at a time. A support function may fail; a query never does: it returns an [`Outcome`] and a bracket.
//! A bound that is not known at all is plus or minus the scalar's largest finite number.
//!
//! # Features
//!
//! * `std`: square roots from the standard library; `grasp` and `mesh`, which a host has room for.
//! * `grasp`: contacts, friction and hands as sets.
//! * `mesh`: triangle meshes, with `std`.
//!
//! # Sources
//!
//! * Y. Zheng and K. Yamane, *Evaluation of grasp force efficiency considering hand configuration and using novel
//!   generalized penetration distance algorithm*, ICRA 2013: "the paper" throughout.
//! * E. G. Gilbert, D. W. Johnson, S. S. Keerthi, *A fast procedure for computing the distance between complex objects
//!   in three-dimensional space*, 1988. P. Wolfe, *Finding the nearest point in a polytope*, 1976.
//! * W. Blaschke, *Kreis und Kugel*, 1916 (balls that roll inside convex bodies).
#![cfg_attr(not(any(test, feature = "std")), no_std)]
#![warn(missing_docs, missing_debug_implementations)]

mod bounds;
#[cfg(feature = "grasp")]
pub mod grasp;
mod math;
#[cfg(feature = "mesh")]
pub mod mesh;
mod plan;
mod polytope;
pub mod qset;
mod query;
mod scalar;
mod solver;
pub mod support;

/// The linear algebra in this crate's signatures.
pub use nalgebra;

pub use math::{TwoWords, Vector};
pub use polytope::simplex::{Corner, Simplex, Vertex};
pub use query::Options;
pub use query::answer::{Answer, Outcome, Plan};
pub use scalar::Real;
pub use solver::Solver;
pub use solver::batch::Best;
pub use solver::depth::answer::Depth;
pub use solver::depth::body::{Body, BodyError, Matrix2, Matrix3};
pub use solver::prepare::{GraphError, HullFacet, hull_facets, prepare_hull};
pub use solver::warm::Tracker;
pub use solver::workspace::{Layout, MAX_CAPACITY, Workspace, WorkspaceError, place};
pub use support::failure::{NOT_FINITE, TOO_LARGE, UNBOUNDED};

/// What the C layer and the tests of this repository stand on beside the interface. No part of it: anything here may change.
#[doc(hidden)]
pub mod internal {
    pub use crate::bounds::{Axes, Bounds};
    #[cfg(feature = "grasp")]
    pub use crate::grasp::{forces::check as check_forces, linearized::opposed, numbers::usable};
    pub use crate::math::load::{alone, one_by_one};
    pub use crate::math::norm;
    pub use crate::solver::depth::{by_routes as depth_by_routes, unbounded};
    pub use crate::solver::warm::REMEMBERED;
    pub use crate::solver::workspace::{initialize, open};
    pub use crate::support::hull::List;
    pub use crate::support::range::{check_numbers, check_sizes, near_unit};
}

/// README's examples run as tests.
#[cfg(all(doctest, feature = "mesh"))]
#[doc = include_str!("../README.md")]
struct Readme;
