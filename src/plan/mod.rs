//! The plans of a query: what it needs is done, and nothing else.
//!
//! ```text
//!  race                           polytopal Q: rays or expansion, by cost
//!  rays     conewise  expansion   one ray per vertex; any Q in any memory; Algorithm 1
//!    shoot    cone                rays shot at A, and the upper bounds they find; cones of directions
//!      ray                        the simplex that a ray pierces
//!       basis                     its points, and the inverse of their matrix
//!                     polar       open sets: a direction in which A ends at the origin
//! ```

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
