//! Answers as a table to read, beside what was known.

use std::collections::BTreeMap;
use std::io::{self, Write};

use crate::mesh::answer::Row;
use crate::mesh::input::Kind;

pub fn head(out: &mut impl Write) -> io::Result<()> {
    writeln!(
        out,
        "{:18} {:6} {:11} {:>13} {:>13} {:>13} {:>9} {:>10}  bracket",
        "query", "metric", "outcome", "lower", "upper", "best known", "ratio", "ms"
    )
}

pub fn line(out: &mut impl Write, row: &Row) -> io::Result<()> {
    let text = |x: Option<f64>, digits: usize| x.map_or("-".into(), |x| format!("{x:.digits$}"));
    let known = row.known.least().map_or("-".into(), number);
    let (ratio, check) = (text(row.ratio(), 5), check(row));
    let (kind, lower, upper, ms) = (row.kind.name(), number(row.lower), number(row.upper), row.ns as f64 / 1e6);
    let (id, outcome) = (&row.query, row.outcome);
    writeln!(out, "{id:18} {kind:6} {outcome:11} {lower:>13} {upper:>13} {known:>13} {ratio:>9} {ms:>10.3}  {check}")
}

/// The pose that proves `upper`, as `--pose` takes it.
pub fn pose(out: &mut impl Write, row: &Row) -> io::Result<()> {
    let (q, t) = (row.pose.rotation, row.pose.translation);
    if row.upper.is_finite() {
        writeln!(out, "{:18} {:6} free at {},{},{},{},{},{},{}", "", "", q.w, q.i, q.j, q.k, t.x, t.y, t.z)?;
    }
    Ok(())
}

/// Some digits, whatever the size.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-4..1e6).contains(&x) { format!("{x:.8}") } else { format!("{x:.6e}") }
}

/// Whether the bracket agrees with what is known, how wide it is, and what is remarkable.
fn check(row: &Row) -> String {
    if let Some(contradiction) = row.contradiction() {
        return contradiction.into();
    }
    if let Some(distance) = row.distance {
        return format!("separated by {}", number(distance));
    }
    let width = match row.upper > 0.0 && row.upper.is_finite() {
        true => format!("{:.2} % wide", 100.0 * (1.0 - row.lower / row.upper)),
        false if row.upper == f64::INFINITY => "no upper bound".to_string(),
        false => "no depth".to_string(),
    };
    let compared = row.known.least().or(row.known.lower).is_some();
    let width = if compared { format!("true, {width}") } else { width };
    if row.translation.is_some_and(|t| row.upper > t * (1.0 + 1e-3)) {
        return width + ", A TRANSLATION IS BETTER";
    }
    let better = row.known.exact.is_none() && row.ratio().is_some_and(|r| r < 1.0 - 1e-5);
    if better { width + ", better than known" } else { width }
}

/// For every group and metric: how many there are, how good, how fast.
pub fn summary(out: &mut impl Write, rows: &[Row]) -> io::Result<()> {
    let mut groups: BTreeMap<(&str, Kind), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        if !row.group.is_empty() {
            groups.entry((&row.group, row.kind)).or_default().push(row);
        }
        groups.entry(("all", row.kind)).or_default().push(row);
    }
    writeln!(
        out,
        "\n{:12} {:6} {:>7} {:>10} {:>10} {:>13} {:>10} {:>10}",
        "group", "metric", "queries", "within 1%", "worst", "certified 5%", "median ms", "p90 ms"
    )?;
    for ((group, kind), rows) in &groups {
        let ratios: Vec<f64> = rows.iter().filter_map(|r| r.ratio()).collect();
        let near = ratios.iter().filter(|r| **r <= 1.01).count();
        let worst = ratios.iter().copied().fold(0.0, f64::max);
        let certified = rows.iter().filter(|r| r.lower >= 0.95 * r.upper).count();
        let ms: Vec<f64> = rows.iter().map(|r| r.ns as f64 / 1e6).collect();
        let (kind, count, known) = (kind.name(), rows.len(), ratios.len());
        let certified = format!("{certified}/{count}");
        // (Where nothing is known, nothing was compared.)
        let [near, worst] = match known {
            0 => ["-".into(), "-".into()],
            _ => [format!("{near}/{known}"), format!("{worst:.4}")],
        };
        let [median, late] = [0.5, 0.9].map(|share| quantile(&ms, share));
        writeln!(
            out,
            "{group:12} {kind:6} {count:>7} {near:>10} {worst:>10} {certified:>13} {median:>10.3} {late:>10.3}"
        )?;
    }
    Ok(())
}

/// The value that this share of the list undercuts; 0 for an empty one.
pub fn quantile(list: &[f64], share: f64) -> f64 {
    let mut list = list.to_vec();
    list.sort_by(f64::total_cmp);
    let last = list.len().saturating_sub(1);
    list.get((last as f64 * share).round() as usize).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::answer::ask;
    use crate::mesh::input::Query;
    use qdist::mesh::{DepthOptions, DepthSolver, Model};
    use qdist::nalgebra::Isometry3;

    /// Where nothing is known there is nothing to compare, and no quotient of zeros.
    #[test]
    fn a_summary_of_what_is_not_known() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
        let query = Query::new("one".into(), "a".into(), "b".into(), Isometry3::translation(0.0, 0.0, 0.9));
        let mut row = ask(&mut DepthSolver::new(&body, &body), &query, Kind::Disp, &DepthOptions::default(), None);
        let told = |row: &Row| {
            let mut text = Vec::new();
            summary(&mut text, std::slice::from_ref(row)).unwrap();
            let text = String::from_utf8(text).unwrap();
            text.lines().last().unwrap().split_whitespace().skip(2).take(3).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(told(&row), "1 - -");
        row.known.best = Some(row.upper);
        assert_eq!(told(&row), "1 1/1 1.0000");
    }
}
