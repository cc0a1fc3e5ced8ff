//! The table, `dq.csv`, and the fitted exponents, `fit.csv`.

use crate::cases::Case;
use crate::methods::{Method, Tolerance};
use qdist::{Outcome, Real};
use std::collections::BTreeMap;
use std::fmt::Write;

/// One measured run.
#[derive(Clone, Debug)]
pub struct Row {
    /// Without the method's suffix.
    pub case: String,
    pub method: Method,
    pub n: usize,
    pub scalar: &'static str,
    pub tolerance: Tolerance,
    pub max_facets: usize,
    pub bytes: usize,
    pub lower: f64,
    pub upper: f64,
    pub outcome: Outcome,
    pub iterations: u32,
    pub support_calls: u32,
    pub peak_facets: usize,
    pub median: f64,
    /// 10 % and 90 % of the times.
    pub spread: [f64; 2],
    /// Half of the memory was left: with more of it this run would be the same.
    pub spare: bool,
    /// The known value, and how far it may be off.
    pub truth: Option<(f64, f64)>,
}

impl Row {
    /// What is known of a run before its answer, and its times (nanoseconds, ascending).
    pub fn new<T: Real, const N: usize>(case: &Case<N>, method: Method, tolerance: Tolerance, times: Vec<f64>) -> Self {
        let at = |share: f64| times[((times.len() - 1) as f64 * share).round() as usize];
        // A known value is that of the set in f64: built in f32, it is another one.
        let blur = if size_of::<T>() == 4 { 1e-6 } else { 0.0 };
        Row {
            case: case.name.clone(),
            method,
            n: N,
            scalar: if size_of::<T>() == 4 { "f32" } else { "f64" },
            tolerance,
            max_facets: 0,
            bytes: 0,
            lower: 0.0,
            upper: 0.0,
            outcome: Outcome::Converged,
            iterations: 0,
            support_calls: 0,
            peak_facets: 0,
            median: at(0.5),
            spread: [at(0.1), at(0.9)],
            spare: false,
            truth: case.truth.map(|(d, error)| (d, error + blur)),
        }
    }

    /// The name in the table.
    pub fn name(&self) -> String {
        format!("{}{}", self.case, self.method.suffix())
    }

    pub fn converged(&self) -> bool {
        self.outcome == Outcome::Converged
    }

    /// `None` where no value is known.
    pub fn holds_truth(&self) -> Option<bool> {
        self.truth.map(|(d, error)| self.lower <= d + error && d - error <= self.upper)
    }

    pub fn outcome_name(&self) -> String {
        let mut name = String::new();
        for c in format!("{:?}", self.outcome).chars() {
            if c.is_uppercase() && !name.is_empty() {
                name.push('_');
            }
            name.push(c.to_ascii_lowercase());
        }
        name
    }

    /// For people.
    pub fn line(&self) -> String {
        let [low, high] = self.spread.map(duration);
        let wrong = if self.holds_truth() == Some(false) { "  FALSE BRACKET" } else { "" };
        format!(
            "{:32} {} {:5.0e} {:6} [{:.8}, {:.8}] {:10} K {:5}, facets {:5}, {} ({low} .. {high}){wrong}",
            self.name(),
            self.scalar,
            self.tolerance.value(),
            self.max_facets,
            self.lower,
            self.upper,
            self.outcome_name(),
            self.iterations,
            self.peak_facets,
            duration(self.median),
        )
    }
}

/// Nanoseconds in a unit that suits them.
pub fn duration(ns: f64) -> String {
    match ns {
        ns if ns < 1e3 => format!("{ns:.0} ns"),
        ns if ns < 1e6 => format!("{:.3} us", ns / 1e3),
        ns if ns < 1e9 => format!("{:.3} ms", ns / 1e6),
        ns => format!("{:.3} s", ns / 1e9),
    }
}

/// `dq.csv`.
pub fn table(rows: &[Row]) -> String {
    let mut text = String::from(
        "case,n,scalar,eps,max_facets,bytes,lower,upper,outcome,iterations,support_calls,peak_facets,median_ns\n",
    );
    for r in rows {
        let (name, eps, outcome) = (r.name(), r.tolerance.value(), r.outcome_name());
        let _ = write!(text, "{name},{},{},{eps:e},{},{},", r.n, r.scalar, r.max_facets, r.bytes);
        let _ = write!(text, "{:?},{:?},{outcome},{},", r.lower, r.upper, r.iterations);
        let _ = writeln!(text, "{},{},{:.0}", r.support_calls, r.peak_facets, r.median);
    }
    text
}

/// For every eps the converged run with most memory.
pub fn best_by_eps<'a>(rows: impl Iterator<Item = &'a Row>) -> Vec<&'a Row> {
    let mut best: Vec<&Row> = Vec::new();
    for row in rows.filter(|r| r.converged()) {
        match best.iter_mut().find(|b| b.tolerance == row.tolerance) {
            Some(b) if b.max_facets < row.max_facets => *b = row,
            Some(_) => {}
            None => best.push(row),
        }
    }
    best
}

/// `fit.csv`: time ~ K^p and peak facets ~ K^p, where at least three runs differ in K. Where a run fills its memory and
/// goes on, the facets are the capacity, and their exponent is near 0.
pub fn fits(rows: &[Row]) -> String {
    let mut groups: BTreeMap<(String, &str), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        groups.entry((row.name(), row.scalar)).or_default().push(row);
    }
    let mut text = String::from("case,n,scalar,points,k_min,k_max,time_exponent,facets_exponent\n");
    for ((name, scalar), group) in groups {
        let runs = best_by_eps(group.into_iter().filter(|r| r.iterations > 0));
        let mut ks: Vec<u32> = runs.iter().map(|r| r.iterations).collect();
        ks.sort_unstable();
        ks.dedup();
        let (Some(first), Some(last)) = (ks.first(), ks.last()) else { continue };
        if ks.len() < 3 {
            continue;
        }
        let exponent =
            |of: fn(&Row) -> f64| slope(runs.iter().map(|r| (f64::from(r.iterations).ln(), of(r).max(1.0).ln())));
        let (time, facets) = (exponent(|r| r.median), exponent(|r| r.peak_facets as f64));
        let (n, points) = (runs[0].n, runs.len());
        let _ = writeln!(text, "{name},{n},{scalar},{points},{first},{last},{time:.3},{facets:.3}");
    }
    text
}

/// Least squares.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let count = points.clone().count() as f64;
    let (x, y) = points.clone().fold((0.0, 0.0), |(x, y), p| (x + p.0 / count, y + p.1 / count));
    let (xy, xx) = points.fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - x) * (p.1 - y), xx + (p.0 - x) * (p.0 - x)));
    xy / xx
}
