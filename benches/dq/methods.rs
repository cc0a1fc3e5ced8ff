//! What is timed, and how: one run of one method is one [`Row`] of the table.

use crate::cases::Case;
use crate::report::Row;
use crate::scan_and_match::{self, Matching};
use nalgebra::{Const, DimMin};
use qdist::{Layout, MAX_CAPACITY, place};
use qdist::{Options, Outcome, Real};
use std::hint::black_box;
use std::mem::MaybeUninit;
use std::time::{Duration, Instant};

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// The solver as users call it.
    Qdist,
    /// Expansion only, whatever the query: what the solver's plans are measured against.
    Expand,
    /// The paper's bookkeeping.
    Scan(Matching),
}

impl Method {
    /// What it adds to the name of a case.
    pub fn suffix(self) -> &'static str {
        match self {
            Method::Qdist => "",
            Method::Expand => "/expand",
            Method::Scan(Matching::Pairs) => "/scan",
            Method::Scan(Matching::Sorted) => "/scan_sorted",
        }
    }
}

/// How close the bracket has to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tolerance {
    Absolute(f64),
    Relative(f64),
}

impl Tolerance {
    pub fn value(self) -> f64 {
        match self {
            Tolerance::Absolute(eps) | Tolerance::Relative(eps) => eps,
        }
    }

    fn options<T: Real, const N: usize>(self) -> Options<'static, T, N> {
        let (absolute, relative) = match self {
            Tolerance::Absolute(eps) => (T::of(eps), T::zero()),
            Tolerance::Relative(eps) => (T::zero(), T::of(eps)),
        };
        Options { absolute, relative, ..Options::default() }
    }
}

/// Vertices that go with so many facets. Each vertex has about 1, 2, 5, 10 and 35 live facets in dimension 2 to 6, and
/// more in large hulls; dead vertices keep their place.
pub fn vertices(n: usize, facets: usize) -> usize {
    (facets / [1, 1, 1, 2, 4, 4, 8][n]).max(64)
}

/// The most facets, up to `wanted`, of a workspace of at most so many bytes.
pub fn facets_within<T: Real, const N: usize>(bytes: usize, wanted: usize) -> usize {
    let size = |facets: usize| Layout::new::<T, N>(vertices(N, facets), facets).map_or(usize::MAX, |l| l.bytes());
    (2 * N..=wanted).rev().find(|&facets| size(facets) <= bytes).expect("room for the least workspace")
}

/// One row: `sample` is the time to spend on repetitions.
pub fn run<T: Real, const N: usize>(
    case: &Case<N>,
    method: Method,
    tolerance: Tolerance,
    max_facets: usize,
    sample: Duration,
) -> Row {
    let max_vertices = vertices(N, max_facets);
    let layout = Layout::new::<T, N>(max_vertices, max_facets).expect("a capacity");
    let mut memory = vec![MaybeUninit::uninit(); layout.bytes() + Layout::ALIGN];
    let skip = memory.as_ptr().align_offset(Layout::ALIGN);
    let mut solver = place::<T, N>(&mut memory[skip..], max_vertices, max_facets).expect("memory of that layout");
    let (a, q, options) = (case.a::<T>(), case.q::<T>(), tolerance.options());
    let mut solve = || match method {
        Method::Qdist => solver.solve(&*a, &*q, &options),
        _ => solver.solve_by_expansion(&*a, &*q, &options),
    };
    let (answer, times) = repeat(sample, || black_box(solve()));
    Row {
        max_facets,
        bytes: layout.bytes(),
        lower: answer.lower.to_f64(),
        upper: answer.upper.to_f64(),
        outcome: answer.outcome,
        iterations: answer.iterations,
        support_calls: answer.support_calls,
        peak_facets: answer.facets,
        spare: 2 * answer.facets <= max_facets && 2 * answer.vertices <= max_vertices,
        ..Row::new::<T, N>(case, method, tolerance, times)
    }
}

/// One row of the baseline, for which `bytes` is what its list and its points took.
pub fn scan<const N: usize>(
    case: &Case<N>,
    matching: Matching,
    tolerance: Tolerance,
    sample: Duration,
    limit: Duration,
) -> Row
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let (a, q) = (case.a::<f64>(), case.q::<f64>());
    let (found, times) =
        repeat(sample, || black_box(scan_and_match::solve(&*a, &*q, matching, tolerance.value(), MAX_CAPACITY, limit)));
    Row {
        max_facets: MAX_CAPACITY,
        bytes: found.bytes,
        lower: found.lower,
        upper: found.upper,
        outcome: found.outcome,
        iterations: found.iterations,
        support_calls: found.support_calls,
        peak_facets: found.peak,
        spare: found.outcome == Outcome::Converged,
        ..Row::new::<f64, N>(case, Method::Scan(matching), tolerance, times)
    }
}

/// Runs for `sample`, at least five times after one to warm up; long runs need none, and are run three times up to a
/// second, once beyond. The times are in nanoseconds, ascending.
pub fn repeat<R>(sample: Duration, mut run: impl FnMut() -> R) -> (R, Vec<f64>) {
    let mut timed = || {
        let start = Instant::now();
        let result = run();
        (result, start.elapsed().as_secs_f64() * 1e9)
    };
    let (mut result, first) = timed();
    let (mut times, least) = match first {
        ns if ns > 1e9 => (vec![first], 1),
        ns if ns > 1e8 => (vec![first], 3),
        _ => (Vec::new(), 5),
    };
    let begin = Instant::now();
    while times.len() < least || (begin.elapsed() < sample && times.len() < 1001 && first < 1e8) {
        let (again, time) = timed();
        result = again;
        times.push(time);
    }
    times.sort_by(f64::total_cmp);
    (result, times)
}
