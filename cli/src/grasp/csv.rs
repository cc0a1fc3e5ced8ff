//! One line for every reference: numbers with all their digits, for machines.

use std::io::{self, Write};

use qdist::Outcome;

use crate::grasp::input::{Grasp, norm_name};
use crate::grasp::query::Found;

pub const HEADER: &str = "id,ref,set,norm,q,lower,upper,outcome,dim,iterations,peak_facets,ns";

/// The outcome in one word.
pub fn outcome_name(outcome: Outcome) -> String {
    outcome.to_string().replace(' ', "_")
}

/// A text as one field.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.into() }
}

/// The row of query `index` of a grasp.
pub fn row(out: &mut dyn Write, grasp: &Grasp, index: usize, found: &Found) -> io::Result<()> {
    let (query, answer) = (&grasp.queries[index], &found.answer);
    writeln!(
        out,
        "{},{index},{},{},{},{:.16e},{:.16e},{},{},{},{},{}",
        quoted(&grasp.id),
        query.set.name(),
        norm_name(query.norm),
        query.q.kind(),
        answer.lower,
        answer.upper,
        outcome_name(answer.outcome),
        found.dimension,
        answer.iterations,
        answer.facets,
        found.time.as_nanos(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comma_in_a_name() {
        assert_eq!(quoted("a"), "a");
        assert_eq!(quoted("a, \"b\""), "\"a, \"\"b\"\"\"");
    }
}
