//! What the solver has to reach, against what it did.

use crate::methods::{Method, Tolerance};
use crate::report::{Row, best_by_eps, duration};
use crate::scan_and_match::Matching;

/// A case, what was found, the bar, and whether it is met (`None`: not measured).
struct Bar {
    what: String,
    found: String,
    bar: String,
    met: Option<bool>,
}

const FINE: Tolerance = Tolerance::Absolute(1e-4);

/// The row in `f64` that tells what happens at 1e-4 with this capacity. A run that left memory over stands for those
/// with more of it, and one that ended for want of memory for those with a smaller eps: neither is repeated.
fn find<'a>(rows: &'a [Row], case: &str, capacity: usize) -> Option<&'a Row> {
    let of_case = rows.iter().filter(|r| r.case == case && r.method == Method::Qdist && r.scalar == "f64");
    let stands = |r: &&Row| {
        let memory = r.max_facets == capacity || r.max_facets < capacity && r.spare;
        let eps = r.tolerance == FINE || r.tolerance.value() > FINE.value() && !r.converged();
        memory && eps
    };
    of_case.filter(stands).max_by_key(|r| r.max_facets)
}

/// These runs converge, the slowest within so many milliseconds.
fn within(what: &str, runs: &[Option<&Row>], limit: f64) -> Bar {
    let bar = format!("<= {}", duration(limit * 1e6));
    let Some(runs) = runs.iter().copied().collect::<Option<Vec<_>>>().filter(|r| !r.is_empty()) else {
        return Bar { what: what.into(), found: "not measured".into(), bar, met: None };
    };
    let slowest = runs.iter().max_by(|a, b| a.median.total_cmp(&b.median)).expect("not empty");
    let open = runs.iter().find(|r| !r.converged());
    let tail = open.map_or(String::new(), |r| format!(", {}: {}", r.name(), r.outcome_name()));
    let [low, high] = slowest.spread.map(duration);
    let found = format!("{} ({low} .. {high}){tail}", duration(slowest.median));
    Bar { what: what.into(), found, bar, met: Some(open.is_none() && slowest.median <= limit * 1e6) }
}

/// These runs converge.
fn completes(what: &str, runs: &[Option<&Row>]) -> Bar {
    Bar { bar: "converged".into(), ..within(what, runs, f64::MAX) }
}

/// The median of the random grasps.
fn random(rows: &[Row]) -> Bar {
    let runs: Vec<_> = rows.iter().filter(|r| r.case.starts_with("random_") && r.method == Method::Qdist).collect();
    let mut times: Vec<f64> = runs.iter().map(|r| r.median).collect();
    times.sort_by(f64::total_cmp);
    let open = runs.iter().filter(|r| !r.converged()).count();
    let what = format!("{} random grasps, relative 1e-3, median", runs.len());
    match times.get(times.len() / 2) {
        Some(&median) => {
            let (last, tail) =
                (times[times.len() - 1], if open > 0 { format!(", {open} open") } else { String::new() });
            let found = format!("{}, worst {}{tail}", duration(median), duration(last));
            Bar { what, found, bar: "<= 2.000 ms".into(), met: Some(open == 0 && median <= 2e6) }
        }
        None => Bar { what, found: "not measured".into(), bar: "<= 2.000 ms".into(), met: None },
    }
}

/// How many times faster than a baseline, at the smallest eps from 1e-4 up that both finish. Each side counts with the time that 10 %
/// of its runs undercut: on a machine that others use, a median of runs of a few milliseconds can be off by a factor of
/// two, and a ratio of two of them says anything.
fn faster(rows: &[Row], case: &str, than: Method, least: f64) -> Bar {
    let of = |m: Method| best_by_eps(rows.iter().filter(move |r| r.case == case && r.method == m && r.scalar == "f64"));
    let (ours, theirs) = (of(Method::Qdist), of(than));
    let pairs = ours.iter().filter_map(|a| theirs.iter().find(|b| b.tolerance == a.tolerance).map(|b| (a, b)));
    let coarse = pairs.filter(|x| x.0.tolerance.value() > 0.99e-4);
    let finest = coarse.min_by(|x, y| x.0.tolerance.value().total_cmp(&y.0.tolerance.value()));
    let name = than.suffix().trim_start_matches('/');
    let bar = if least > 0.0 { format!(">= {least:.1} x") } else { String::new() };
    match finest {
        Some((a, b)) => {
            let ([ours, _], [theirs, _]) = (a.spread, b.spread);
            let (ratio, eps) = (theirs / ours, a.tolerance.value());
            let (ours, theirs) = (duration(ours), duration(theirs));
            let what = format!("{case} at {eps:.0e} against {name}");
            Bar { what, found: format!("{ratio:.1} x ({ours}, {theirs})"), bar, met: Some(ratio >= least) }
        }
        None => Bar { what: format!("{case} against {name}"), found: "not both finished".into(), bar, met: None },
    }
}

/// One line a bar.
pub fn summary(rows: &[Row], small: usize) -> String {
    let at = |case: &str, capacity| find(rows, case, capacity);
    let mut cases: Vec<&str> = rows.iter().map(|r| r.case.as_str()).collect();
    cases.sort_unstable();
    cases.dedup();
    let four: Vec<&str> = cases.iter().copied().filter(|c| c.starts_with("soft4_")).collect();
    let fours = |capacity| four.iter().map(|c| at(c, capacity)).collect::<Vec<_>>();
    let plane: Vec<_> = (1..=5).map(|i| at(&format!("a{i}_plane"), 512)).collect();
    let mut bars = vec![
        within("a1, 2048 facets", &[at("a1", 2048)], 10.0),
        within("a2, 2048 facets", &[at("a2", 2048)], 6.0),
        within("a3", &[at("a3", 2048)], 0.1),
        within("a4", &[at("a4", 2048)], 0.3),
        within("a5", &[at("a5", 2048)], 0.02),
        within("a1..a5 in the plane, slowest", &plane, 0.01),
        within("four soft contacts, 4096 facets, slowest", &fours(4096), 60.0),
        completes("four soft contacts, 512 facets, slowest", &fours(512)),
        completes(&format!("a1 in 64 KB ({small} facets)"), &[at("a1", small)]),
        random(rows),
    ];
    let ball = |c: &&str| *c == "a1" || c.starts_with("soft"); // (Q of a2 is an ellipsoid.)
    let scanned = |c: &&str| rows.iter().any(|r| r.case == *c && r.method == Method::Scan(Matching::Pairs));
    for case in cases.iter().copied().filter(ball).filter(scanned) {
        bars.push(faster(rows, case, Method::Scan(Matching::Pairs), 8.0));
        bars.push(faster(rows, case, Method::Scan(Matching::Sorted), 0.0));
    }
    for case in ["a1", "a2", "a3", "a4", "a5"].into_iter().chain(four) {
        bars.push(faster(rows, case, Method::Expand, 0.0));
    }
    let known = rows.iter().filter_map(Row::holds_truth);
    let (count, held) = known.fold((0, 0), |(count, held), h| (count + 1, held + usize::from(h)));
    let found = format!("{held} of {count}");
    bars.push(Bar {
        what: "brackets of known values are true".into(),
        found,
        bar: "all".into(),
        met: Some(held == count),
    });
    let verdict = |b: &Bar| match b.met {
        _ if b.bar.is_empty() => "",
        Some(true) => "met",
        Some(false) => "MISSED",
        None => "-",
    };
    let line = |b: &Bar| format!("{:55} {:74} {:14} {}\n", b.what, b.found, b.bar, verdict(b));
    bars.iter().map(line).collect()
}
