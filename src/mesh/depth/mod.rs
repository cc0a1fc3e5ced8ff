//! The generalized penetration depth of two meshes: how little must A move, rotations included, to be free of B?
//!
//! ```text
//! PD(q0) = min { metric(q0, q) : A at q does not overlap B }
//! ```
//!
//! (Zhang, Kim and Manocha 2007). The metric is a length: the largest displacement of A's points, or their root mean
//! square. Local minima abound, and no practical method finds the least of them with certainty; so the answer is a bracket. The upper bound
//! is the metric of a pose that is proved free by the solid test, and the lower bound is that of the convex pieces of both bodies (module
//! [`certificate`](super::certificate)), which holds whatever the search missed. It is 0 for models without pieces
//! ([`Model::with_pieces`]).
//!
//! # The search
//!
//! * *Seeds* (`seeds`) are free poses found from afar: along rays in configuration space, by pushing out what penetrates, or given by the caller,
//!   who may take them from stored [`ContactSamples`].
//! * A *walk* (`walk`) goes from a seed along the boundary of the free space to where the metric is least.
//! * `contact_space` knows what contacts say of motions near by; `sampling` and `branching` are the walk's other kinds of step.
//! * `search` keeps the best pose and the budget; `schedule` says how much is done, and when more is of no use; `finish` makes the best pose the answer.
//! * The warm query of a control loop is a [`DepthTracker`] (`tracker`).
//!
//! All lengths that the search chooses are in units of A's bounding box, so depths scale with the scene. Random directions come
//! from a small generator of its own: the same query with the same seed number gives the same answer, to the last digit.
//!
//! ```
//! use qdist::mesh::{DepthOptions, DepthSolver, Model, Outcome};
//! use qdist::nalgebra::Isometry3;
//!
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])?.with_pieces(&Default::default())?;
//! let mut solver = DepthSolver::new(&body, &body);
//! let pose = Isometry3::translation(0.0, 0.0, 0.9);
//! let depth = solver.depth(&pose, body.disp(), &DepthOptions::default(), None);
//! assert!(depth.outcome == Outcome::Converged && depth.lower <= depth.upper && depth.upper < 0.0578);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod branching;
mod budget;
mod contact_space;
mod finish;
mod order;
mod random;
mod sampling;
mod schedule;
mod search;
mod seeds;
mod step;
mod tick;
mod tracker;
mod translation;
mod walk;

use super::certificate::{Certifier, Effort};
use super::metric::Metric;
use super::optimize::{Constraint, StepMemory};
use super::{Contact, Counters, Distance, Model, Pair};
use branching::Branches;
pub use budget::Budget;
use contact_space::{ContactSpace, Primitive};
use nalgebra::Isometry3;
use search::PoseSearch;
pub use seeds::samples::{ContactSamples, SamplesError};
pub use tracker::DepthTracker;

/// How the boundary of the free space is searched around a pose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Walk {
    /// Contacts as linear constraints of a convex program.
    #[default]
    Linearised,
    /// The same with unions of constraints where convex corners meet corners or edges, each member in turn (sections IV-A and IV-B.2 of
    /// the paper). From a seed it finds what the linearised walk finds, and takes longer; in the end a linearised search takes one from the best
    /// pose.
    Branching,
    /// Random samples on the contacts (section IV-B.1 of the paper).
    Sampling,
}

/// What a query does.
#[derive(Clone, Copy, Debug)]
pub struct DepthOptions<'a> {
    /// How much is done, default [`Effort::Default`].
    pub effort: Effort,
    /// Number of the random sequence, default 0.
    pub seed: u64,
    /// The query ends when `upper - lower` is at most this fraction of `upper`, default 1e-3.
    pub relative: f64,
    /// The query ends after this many collision, contact and distance queries, but for some tens to bring the best pose to contact; default
    /// `u64::MAX`.
    pub max_queries: u64,
    /// How the boundary is searched.
    pub walk: Walk,
    /// Whether rays in configuration space are seeds, default true.
    pub rays: bool,
    /// Whether pushing out what penetrates is a seed, default true.
    pub push_out: bool,
    /// Poses to begin with, free or not: the last frame's answer, the answer for another metric, the nearest of some
    /// [`ContactSamples`], a guess.
    pub poses: &'a [Isometry3<f64>],
}

impl Default for DepthOptions<'_> {
    fn default() -> Self {
        DepthOptions {
            effort: Effort::Default,
            seed: 0,
            relative: 1e-3,
            max_queries: u64::MAX,
            walk: Walk::Linearised,
            rays: true,
            push_out: true,
            poses: &[],
        }
    }
}

/// How a query ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Outcome {
    /// The bodies do not overlap: both bounds are 0.
    Separated,
    /// The bracket is as narrow as asked for.
    Converged,
    /// All that the effort or the tick's budget provides for was done, and the bracket is wider than asked for. More effort may find better.
    Bounded,
    /// The caller said stop. The bracket is true.
    Interrupted,
    /// The number of queries is used up. The bracket is true.
    Budget,
    /// No free pose was found: `upper` is infinite, and `pose` is the query's.
    Stuck,
    /// The pose or an option is no proper number: nothing is known.
    Invalid,
}

/// An answer: `lower` <= depth <= `upper`.
#[derive(Clone, Copy, Debug)]
pub struct MeshDepth {
    /// How the query ended.
    pub outcome: Outcome,
    /// No free pose is nearer than this.
    pub lower: f64,
    /// The metric's distance of `pose` from the query's, whose quaternion is taken over its length.
    pub upper: f64,
    /// A free pose by the solid test, in the frame of B; the query's own when it is free, or when the outcome is
    /// [`Outcome::Stuck`] or [`Outcome::Invalid`].
    pub pose: Isometry3<f64>,
    /// The distance of the surfaces, when separated.
    pub distance: Option<Distance>,
    /// Whether an inside was seen: A or B is a solid. Otherwise the depth is that of surfaces.
    pub solid: bool,
    /// Queries that it took.
    pub counters: Counters,
    /// Walks that were made.
    pub walks: u32,
}

/// How far a query is.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// The lower bound so far.
    pub lower: f64,
    /// The upper bound so far; infinite before the first free pose.
    pub upper: f64,
    /// The pose that proves it, once it is finite.
    pub pose: &'a Isometry3<f64>,
    /// Share of the search that is done, 0 to 1.
    pub fraction: f64,
    /// Queries so far.
    pub queries: u64,
}

/// What is called now and then during a query; true stops it, after some tens of queries at most that bring the best pose to contact.
pub type Watch<'a> = &'a mut (dyn FnMut(&Progress) -> bool + 'a);

/// Two models and the memory of their queries.
#[derive(Debug)]
pub struct DepthSolver<'m> {
    a: &'m Model,
    b: &'m Model,
    pair: Pair<'m>,
    scratch: Scratch,
    certifier: Certifier,
}

/// Memory that walks reuse.
#[derive(Clone, Debug)]
struct Scratch {
    contacts: Vec<Contact>,
    primitives: Vec<Primitive>,
    space: ContactSpace,
    branches: Branches,
    constraints: Vec<Constraint>,
    memory: StepMemory,
    /// Where walks of this query began and ended.
    walked: Vec<[Isometry3<f64>; 2]>,
}

impl<'m> DepthSolver<'m> {
    /// A moves, B rests.
    pub fn new(a: &'m Model, b: &'m Model) -> DepthSolver<'m> {
        DepthSolver {
            a,
            b,
            pair: Pair::new(a.mesh(), b.mesh()),
            certifier: Certifier::new(),
            scratch: Scratch {
                contacts: Vec::new(),
                primitives: Vec::new(),
                space: ContactSpace::default(),
                branches: Branches::default(),
                constraints: Vec::new(),
                memory: StepMemory::new(step::CONTACTS),
                walked: Vec::new(),
            },
        }
    }

    /// The body that moves.
    pub fn a(&self) -> &'m Model {
        self.a
    }

    /// The body that rests.
    pub fn b(&self) -> &'m Model {
        self.b
    }

    /// The pair, for other queries with the same memory.
    pub fn pair(&mut self) -> &mut Pair<'m> {
        &mut self.pair
    }

    /// The depth of A at a pose, by a metric of A ([`Model::disp`], [`Model::sigma`] or the caller's own). `watch` is called
    /// several times a millisecond.
    pub fn depth(
        &mut self,
        pose: &Isometry3<f64>,
        metric: &dyn Metric,
        options: &DepthOptions,
        watch: Option<Watch>,
    ) -> MeshDepth {
        PoseSearch::new(self, pose, metric, options, watch).run()
    }
}
