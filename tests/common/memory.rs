//! A solver's memory with capacities chosen at run time.

use qdist::support::Failure;
use qdist::{Answer, Depth, Layout, Options, Outcome, Real, Solver, place};
use std::mem::MaybeUninit;

pub struct Memory {
    bytes: Vec<MaybeUninit<u8>>,
    pub vertices: usize,
    pub facets: usize,
}

impl Memory {
    pub fn new<T: Real, const N: usize>(vertices: usize, facets: usize) -> Self {
        let layout = Layout::new::<T, N>(vertices, facets).unwrap();
        Memory { bytes: vec![MaybeUninit::uninit(); layout.bytes() + Layout::ALIGN], vertices, facets }
    }

    /// The least memory that is allowed.
    pub fn least<T: Real, const N: usize>() -> Self {
        Self::new::<T, N>(N + 1, 2 * N)
    }

    pub fn solver<T: Real, const N: usize>(&mut self) -> Solver<'_, T, N> {
        let skip = self.bytes.as_ptr().align_offset(Layout::ALIGN);
        place(&mut self.bytes[skip..], self.vertices, self.facets).unwrap()
    }
}

/// What both kinds of answers have in common, as `f64` (which holds every `f32` exactly).
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    pub outcome: Outcome,
    pub lower: f64,
    pub upper: f64,
    pub iterations: u32,
    pub vertices: usize,
    pub facets: usize,
    pub failure: Option<Failure>,
    pub direction_length: f64,
}

impl<T: Real, const N: usize> From<&Answer<T, N>> for Seen {
    fn from(a: &Answer<T, N>) -> Self {
        Seen {
            outcome: a.outcome,
            lower: a.lower.to_f64(),
            upper: a.upper.to_f64(),
            iterations: a.iterations,
            vertices: a.vertices,
            facets: a.facets,
            failure: a.failure,
            direction_length: a.direction.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt(),
        }
    }
}

impl<T: Real, const N: usize> From<&Depth<T, N>> for Seen {
    fn from(a: &Depth<T, N>) -> Self {
        Seen {
            outcome: a.outcome,
            lower: a.lower.to_f64(),
            upper: a.upper.to_f64(),
            iterations: a.iterations,
            vertices: a.vertices,
            facets: a.facets,
            failure: a.failure,
            direction_length: a.normal.iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt(),
        }
    }
}

/// The default, but for what a search by cones may take of the test's time.
pub fn brisk<T: Real, const N: usize>() -> Options<'static, T, N> {
    Options { max_iterations: Some(2000), ..Options::default() }
}

/// What every answer promises whatever it is about; the first broken promise as text. `vertices` and `facets` are the
/// capacities.
pub fn broken_promise<T: Real, const N: usize>(
    s: &Seen,
    options: &Options<'_, T, N>,
    vertices: usize,
    facets: usize,
) -> Option<String> {
    let (absolute, relative) = (options.absolute.to_f64(), options.relative.to_f64());
    // The tolerance in the answer's own arithmetic: one rounding each for width and product.
    let u = T::ROUNDOFF.to_f64();
    let width = s.upper - s.lower;
    let allowed = absolute.max(relative * s.upper.abs().max(s.lower.abs())) * (1.0 + 8.0 * u);
    let limit = options.max_iterations;
    let claim = |holds: bool, text: &str| (!holds).then(|| text.to_string());
    claim(!s.lower.is_nan() && !s.upper.is_nan(), "an end of the bracket is NaN")
        .or_else(|| claim(s.lower <= s.upper, "lower > upper"))
        .or_else(|| claim(s.vertices <= vertices && s.facets <= facets, "more memory used than there is"))
        .or_else(|| claim(limit.is_none_or(|limit| s.iterations <= limit), "more iterations than allowed"))
        .or_else(|| {
            claim(s.failure.is_some() == (s.outcome == Outcome::SupportFailed), "failure code and outcome disagree")
        })
        .or_else(|| {
            let unbounded = s.upper >= T::HUGE.to_f64() || s.outcome == Outcome::SupportFailed;
            claim(unbounded || (s.direction_length - 1.0).abs() <= 32.0 * u * N as f64, "direction is no unit vector")
        })
        .or_else(|| match s.outcome {
            Outcome::Converged => {
                claim(width <= allowed && s.lower > 0.0, "Converged, but the bracket is wide or not above 0")
            }
            Outcome::Separated => claim(s.upper < 0.0, "Separated, but upper >= 0"),
            Outcome::Above => {
                claim(options.threshold.is_some_and(|t| s.lower >= t.to_f64()), "Above, but lower < threshold")
            }
            Outcome::Below => {
                claim(options.threshold.is_some_and(|t| s.upper < t.to_f64()), "Below, but upper >= threshold")
            }
            Outcome::Iterations => claim(s.iterations >= limit.unwrap_or(0), "Iterations, but below the limit"),
            Outcome::Interrupted => None,
            Outcome::Touching => claim(s.lower <= 0.0 && s.upper >= 0.0, "Touching, but the bracket misses 0"),
            Outcome::Precision | Outcome::Capacity => claim(s.upper >= 0.0, "apart, but not Separated"),
            Outcome::Degenerate => claim(s.lower <= 0.0, "Degenerate, but lower > 0"),
            Outcome::SupportFailed => None,
            Outcome::Unbounded => claim(s.lower >= T::HUGE.to_f64(), "Unbounded, but a lower bound that is not"),
            _ => claim(false, "an outcome that no test knows"),
        })
}
