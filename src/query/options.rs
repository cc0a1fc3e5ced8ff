//! What the caller says of a query: how it ends, and where it looks first.

use core::fmt;

use crate::math::Vector;
use crate::scalar::Real;

/// How a query ends, and where it looks first.
///
/// Fields may be added: write `Options { relative: 1e-3, ..Options::default() }`.
#[derive(Clone, Copy)]
pub struct Options<'a, T, const N: usize> {
    /// Stop when upper - lower <= max(absolute, relative |d|). Default 0.
    pub absolute: T,
    /// See `absolute`. Default 1e-6 in `f64`, 1e-4 in `f32`.
    pub relative: T,
    /// Stop as soon as d >= threshold or d < threshold is certain.
    pub threshold: Option<T>,
    /// Most steps (see [`Answer::iterations`](crate::Answer::iterations)). `None`, the default: 50,000, and 64 for each vertex of a
    /// polytopal Q. (What a query needs grows with a power of 1 / tolerance, up to (dimension - 1) / 2 where A is smooth; how long that
    /// takes, `examples/worst_case.rs` measures.)
    pub max_iterations: Option<u32>,
    /// The direction to look in first (any length, not zero): where the answer was last time.
    pub guess: Option<Vector<T, N>>,
    /// The deadline: asked before every iteration, it ends the query by `true`, with outcome
    /// [`Interrupted`](crate::Outcome::Interrupted) and the best bracket so far.
    pub interrupt: Option<&'a dyn Fn() -> bool>,
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Options<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("absolute", &self.absolute)
            .field("relative", &self.relative)
            .field("threshold", &self.threshold)
            .field("max_iterations", &self.max_iterations)
            .field("guess", &self.guess)
            .field("interrupt", &self.interrupt.map(|_| "..."))
            .finish()
    }
}

impl<T: Real, const N: usize> Default for Options<'_, T, N> {
    fn default() -> Self {
        Options {
            absolute: T::zero(),
            relative: T::RELATIVE_TOLERANCE,
            threshold: None,
            max_iterations: None,
            guess: None,
            interrupt: None,
        }
    }
}

impl<T: Real, const N: usize> Options<'_, T, N> {
    /// What is left of the limit after so many iterations; `None`: nothing.
    pub(crate) fn after(&self, iterations: u32) -> Option<Self> {
        let left = self.limit().saturating_sub(iterations);
        (left > 0).then_some(Options { max_iterations: Some(left), ..*self })
    }

    /// The most steps, with so many vertices of Q.
    pub(super) fn most(&self, vertices: usize) -> u32 {
        let more = MAX_ITERATIONS_PER_VERTEX.saturating_mul(vertices as u32);
        if self.max_iterations.is_none() { self.limit().saturating_add(more) } else { self.limit() }
    }

    fn limit(&self) -> u32 {
        self.max_iterations.unwrap_or(MAX_ITERATIONS)
    }
}

/// Steps when the caller sets no limit; and for each vertex of a polytopal Q.
const MAX_ITERATIONS: u32 = 50_000;
const MAX_ITERATIONS_PER_VERTEX: u32 = 64;
