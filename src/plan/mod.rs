//! The plans of a query: what it needs is done, and nothing else.
//!
//! ```text
//! race                 polytopal Q: rays or expansion, by cost
//!   rays                 one ray per vertex
//!     shoot, ray, basis    rays shot at A, and the upper bounds they find; the simplex that a ray pierces; its points, and the inverse of their matrix
//! conewise             any Q in any memory: expansion cone by cone, after expansion has filled it
//!   cone                 cones of directions
//! expansion            Algorithm 1
//!   start                the first simplex
//!   polar                open sets: a direction in which A ends at the origin
//! distance             the nearest point, where cores are apart
//! ```
//!
//! Which one a query takes is decided in [`Solver`](crate::Solver) (`solver`: `decide`, `open`, `choose`). Plans that only bodies have are in `solver::depth`.

pub(crate) mod basis;
mod cone;
mod conewise;
pub(crate) mod distance;
pub(crate) mod expansion;
mod polar;
pub(crate) mod race;
mod ray;
pub(crate) mod rays;
pub(crate) mod shoot;
pub(crate) mod start;
