//! The certificate of a mesh query: a lower bound of the generalized penetration depth that is true whatever the search for an
//! upper bound found.
//!
//! Whatever motion takes A out of B takes every convex piece A_i of A out of every convex piece B_j of B. At the end a plane separates
//! the two, so the point of A_i that was farthest across the plane has moved at least their translational depth. Hence
//!
//! ```text
//! PD^g_DISP(A, B)  >=  max over i, j of PD^t(A_i, B_j)
//! ```
//!
//! with equality where A and B are convex. How far that point moves for a given object norm sigma depends on where it lies; module
//! `sigma` turns the same separation into a bound of sqrt(sigma).
//!
//! * **Pieces** are made once per mesh ([`Pieces::new`]): the mesh itself where it is convex, otherwise polytopes grown from the centres of
//!   inscribed balls (`decompose`, `grow`), each proved to be inside (`piece`). They overlap, and need not fill the solid.
//! * **A query** ([`Certifier`]) looks for the pair with the greatest depth and asks the core of this crate for a certified lower
//!   bound of that depth. It need not find the best pair: every pair is a proof. Rounding of the pose is subtracted.
//!
//! * With all effort, inscribed balls of A that are deep in B look for the nearest place outside of all of B (`travel`).
//!
//! What it cannot see: a concave B that holds A from several sides, each of which would yield alone to a turn (a plate that is jammed
//! in a slot). There the bound stays below the optimum whatever the effort.
//!
//! ```
//! use nalgebra::{Isometry3, Point3};
//! use qdist::mesh::certificate::{BuildOptions, Certifier, Effort, Pieces};
//!
//! // A tetrahedron with three edges of length 1 along the axes.
//! let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from);
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
//! let solid = Pieces::new(&corners, &triangles, &BuildOptions::default())?;
//!
//! let lower = Certifier::new().disp(&solid, &solid, &Isometry3::translation(-0.9, 0.0, 0.0), Effort::Default);
//! assert!(lower <= 0.1 / 3f64.sqrt() && lower > 0.0577); // its tip is 0.1 deep: along the slanted face that is less
//! # Ok::<(), qdist::mesh::certificate::SolidError>(())
//! ```

use std::fmt;

use super::Mesh;
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};
use std::sync::Arc;

mod cell;
mod decompose;
mod grow;
mod piece;
mod search;
mod sigma;
mod solid;
mod travel;

pub use decompose::BuildOptions;
pub use piece::Piece;
pub use sigma::InertiaError;
pub use solid::SolidError;

/// Convex pieces of a solid, each proved to be inside of it.
#[derive(Clone, Debug)]
pub struct Pieces {
    pieces: Vec<Piece>,
    surface: travel::Surface,
    lever: Option<sigma::Lever>,
}

impl Pieces {
    /// Cuts pieces out of the solid that a closed, outward-wound mesh bounds. Deterministic. Time grows with triangles times pieces: about
    /// a second for 3,000 triangles. A thin or intricate solid may get no piece at all; then every bound is 0.
    ///
    /// # Errors
    /// [`SolidError`]: what is wrong, and where. A polygon soup has no inside, and no certificate.
    pub fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]], options: &BuildOptions) -> Result<Self, SolidError> {
        if !triangles.is_empty() {
            solid::check_size(vertices)?;
        }
        Self::of_mesh(Arc::new(Mesh::new(vertices, triangles)?), options)
    }

    /// The same of a mesh.
    pub(super) fn of_mesh(mesh: Arc<Mesh>, options: &BuildOptions) -> Result<Self, SolidError> {
        let pieces = decompose::pieces(&solid::Solid::new(&mesh)?, options);
        let surface = travel::Surface::new(mesh, &pieces);
        Ok(Pieces { pieces, surface, lever: None })
    }

    /// Prepares the bounds of the object norm for this solid as the moving one: `center` of mass and inertia tensor about it per
    /// volume (an area), both in the mesh's frame.
    ///
    /// # Errors
    /// [`InertiaError`]; nothing changes then.
    pub fn weigh(&mut self, center: &Point3<f64>, inertia_per_volume: &Matrix3<f64>) -> Result<(), InertiaError> {
        self.lever = Some(sigma::Lever::new(&self.pieces, center, inertia_per_volume)?);
        Ok(())
    }

    /// All pieces.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}

/// How long to look for a better bound. More effort never gives a lower one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effort {
    /// From the most promising pair, 150 pairs at most: 0.1 to 0.3 ms with hundreds of pieces.
    Fast,
    /// From a few pairs, 550 at most: 0.1 to 0.6 ms, for the object norm 0.5 to 1.2 ms.
    #[default]
    Default,
    /// All pairs, and the travel of inscribed balls: 1 to 100 ms, at worst a few times that.
    Heavy,
}

/// Answers queries; holds the solver's memory (100 KB).
pub struct Certifier {
    memory: Box<search::Memory>,
    /// The translation that parts the pair of pieces which proved the last bound of DISP.
    pub(super) way_out: Option<Vector3<f64>>,
}

impl fmt::Debug for Certifier {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Certifier").finish_non_exhaustive()
    }
}

impl Default for Certifier {
    fn default() -> Self {
        Self::new()
    }
}

impl Certifier {
    /// Allocates the memory.
    #[must_use]
    pub fn new() -> Self {
        Certifier { memory: Box::new(search::Memory::new()), way_out: None }
    }

    /// A lower bound of PD^g_DISP: of the largest displacement of a vertex of A in any motion of A out of B. `pose` places A: x -> R x + t in
    /// B's frame. At least 0; 0 also where the bodies are apart, nothing is known, or the pose is not finite.
    pub fn disp(&mut self, a: &Pieces, b: &Pieces, pose: &Isometry3<f64>, effort: Effort) -> f64 {
        let mut search = search::PairSearch::new(&mut self.memory, a, b, pose, search::Goal::Disp);
        for level in levels(effort) {
            search.run(level);
        }
        let depth = search.refined();
        let way_out = search.way_out();
        let depth = if effort < Effort::Heavy { depth } else { depth.max(search.travel(depth)) };
        self.way_out = way_out;
        depth
    }

    /// A lower bound of the root of PD^g in the object norm, a length: sqrt of the mean squared displacement of A's points in any motion of A
    /// out of B. 0 also where A was not [weighed](Pieces::weigh).
    pub fn sqrt_sigma(&mut self, a: &Pieces, b: &Pieces, pose: &Isometry3<f64>, effort: Effort) -> f64 {
        let Some(lever) = &a.lever else { return 0.0 };
        let mut search = search::PairSearch::new(&mut self.memory, a, b, pose, search::Goal::SqrtSigma(lever));
        let mut best: f64 = 0.0;
        for level in levels(effort) {
            search.run(level);
            best = best.max(search.sqrt_sigma(lever, level));
        }
        if effort < Effort::Heavy { best } else { best.max(search.travel(best)) }
    }
}

/// The levels up to this one: each adds to what the one before has found.
fn levels(effort: Effort) -> impl Iterator<Item = Effort> {
    [Effort::Fast, Effort::Default, Effort::Heavy].into_iter().filter(move |&level| level <= effort)
}
