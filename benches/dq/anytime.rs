//! `anytime.csv`: one query, cut off after more and more iterations, and the bracket that it has by then.
//!
//! This is what a caller with a deadline gets. Limits are on iterations and not on time, so that brackets are the same on every machine.

use crate::cases::{self, Case};
use crate::methods::repeat;
use qdist::{Options, Outcome, Workspace};
use std::fmt::Write;
use std::hint::black_box;
use std::time::Duration;

/// Row a1 of Table I, a random grasp and a regular one. Symmetry makes many directions nearly the best, which takes longest.
fn chosen() -> impl Iterator<Item = Case<6>> {
    let a1 = cases::table_in_space().into_iter().take(1);
    let random = cases::random(3).into_iter().skip(2);
    a1.chain(random).chain([cases::regular(4)])
}

/// The table. No longer run than of `patience`; each is repeated for `sample`.
pub fn table(sample: Duration, patience: Duration) -> String {
    let mut text = String::from("case,limit,lower,upper,outcome,iterations,support_calls,facets,median_ns\n");
    let mut memory = Box::new(Workspace::<f64, 6, 512, 4096>::new());
    for case in chosen() {
        let (a, q) = (case.a::<f64>(), case.q::<f64>());
        for step in 2..40 {
            // Two in an octave.
            let limit = f64::powf(2.0, f64::from(step) / 2.0).round() as u32;
            let options = Options { max_iterations: Some(limit), relative: 1e-5, ..Options::default() };
            let (answer, times) = repeat(sample, || black_box(memory.solver().solve(&*a, &*q, &options)));
            let median = times[times.len() / 2];
            let (lower, upper, outcome) = (answer.lower, answer.upper, answer.outcome);
            let _ = write!(text, "{},{limit},{lower:?},{upper:?},{outcome:?},", case.name);
            let (calls, facets) = (answer.support_calls, answer.facets);
            let _ = writeln!(text, "{},{calls},{facets},{median:.0}", answer.iterations);
            if outcome == Outcome::Converged || median > patience.as_secs_f64() * 1e9 {
                break;
            }
        }
    }
    text
}
