//! The table `pdg.csv`, and what is printed beside the bars.

use std::fmt::Write;

use crate::measure::{Cold, VARIANTS};
use crate::peers::{Compared, Deepest};
use qdist_cli::mesh::answer::quoted;
use qdist_cli::mesh::input::Kind;
use qdist_cli::mesh::table::quantile;

/// A line for every query, metric and variant.
pub fn csv(cold: &[Cold]) -> String {
    let mut text =
        "query,group,metric,variant,outcome,lower,upper,best_known,ratio,free,collision_queries,contact_queries,\
                    distance_queries,runs,median_ns,p90_ns\n"
            .to_string();
    let optional = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    for c in cold {
        let r = &c.row;
        let (best, ratio) = (optional(r.known.least()), optional(r.ratio()));
        let [median, late] = [0.5, 0.9].map(|share| quantile(&c.times, share));
        let (id, group, kind) = (quoted(&r.query), &r.group, r.kind.name());
        let Cold { variant, free, .. } = c;
        let _ =
            write!(text, "{id},{group},{kind},{variant},{},{},{},{best},{ratio},{free},", r.outcome, r.lower, r.upper);
        let n = r.counters;
        let _ = writeln!(text, "{},{},{},{},{median},{late}", n.collision, n.contact, n.distance, c.times.len());
    }
    text
}

/// `triangles.csv`: what other libraries' pairs of triangles tell of the queries.
pub fn triangles_csv(deepest: &[Deepest]) -> String {
    let mut text = "query,group,library,depth,best_known,ns\n".to_string();
    for d in deepest {
        let best = d.best_known.map_or(String::new(), |x| x.to_string());
        let _ = writeln!(text, "{},{},{},{},{best},{}", quoted(&d.query), d.group, d.library, d.depth, d.ns);
    }
    text
}

/// `proximity.csv`: the same poses with FCL.
pub fn proximity_csv(compared: &[Compared]) -> String {
    let mut text =
        "query,group,contact,collides,fcl_collides,ns,fcl_ns,distance,fcl_distance,distance_ns,fcl_distance_ns\n"
            .to_string();
    for c in compared {
        let (o, f) = (c.ours, c.fcl);
        let _ = write!(text, "{},{},{},{},{},{},{},", quoted(&c.query), c.group, c.contact, o.0, f.0, o.1, f.1);
        let _ = writeln!(text, "{},{},{},{}", o.2, f.2, o.3, f.3);
    }
    text
}

/// How much better an answer could be: 0 where it is the best known, or better.
pub fn excess(c: &Cold) -> Option<f64> {
    c.row.ratio().map(|ratio| (ratio - 1.0).max(0.0))
}

/// Milliseconds: the medians of the queries, at a share of them.
pub fn milliseconds<'a>(of: impl IntoIterator<Item = &'a Cold>, share: f64) -> f64 {
    quantile(&of.into_iter().map(|c| quantile(&c.times, 0.5) / 1e6).collect::<Vec<_>>(), share)
}

/// Error against time: a line for every group, metric and variant.
pub fn curve(cold: &[Cold]) -> String {
    let mut text = format!(
        "{:10} {:6} {:9} {:>7} {:>10} {:>10} {:>9} {:>9} {:>12} {:>12} {:>12}\n",
        "group",
        "metric",
        "variant",
        "queries",
        "median ms",
        "p90 ms",
        "within 1%",
        "within .1%",
        "certified 5%",
        "median error",
        "p90 error"
    );
    let mut groups: Vec<&str> = cold.iter().map(|c| c.row.group.as_str()).collect();
    groups.sort_unstable();
    groups.dedup();
    for (group, kind) in groups.iter().flat_map(|g| Kind::BOTH.map(|kind| (g, kind))) {
        for variant in VARIANTS {
            let is = |c: &&Cold| c.row.group == *group && c.row.kind == kind && c.variant == variant.name;
            let of: Vec<&Cold> = cold.iter().filter(is).collect();
            if of.is_empty() {
                continue;
            }
            let errors: Vec<f64> = of.iter().filter_map(|c| excess(c)).collect();
            let within = |most: f64| format!("{}/{}", errors.iter().filter(|e| **e <= most).count(), errors.len());
            let certified = of.iter().filter(|c| c.row.lower >= 0.95 * c.row.upper).count();
            let [median, late] = [0.5, 0.9].map(|share| milliseconds(of.iter().copied(), share));
            let (kind, name, count) = (kind.name(), variant.name, of.len());
            let certified = format!("{certified}/{count}");
            let [middle, high] = [0.5, 0.9].map(|share| quantile(&errors, share));
            let [one, tenth] = [0.01, 0.001].map(within);
            let _ = writeln!(
                text,
                "{group:10} {kind:6} {name:9} {count:>7} {median:>10.3} {late:>10.3} {one:>9} {tenth:>10} {certified:>12} {middle:>12.1e} {high:>12.1e}"
            );
        }
    }
    text
}

/// Where the best known value was beaten.
pub fn beaten(cold: &[Cold]) -> String {
    let better = |c: &&Cold| c.row.known.exact.is_none() && c.row.ratio().is_some_and(|r| r < 1.0 - 1e-4);
    let name = |c: &Cold| {
        let less = 100.0 * (1.0 - c.row.ratio().unwrap_or(1.0));
        format!("{} {} {} by {less:.3} %", c.row.query, c.row.kind.name(), c.variant)
    };
    cold.iter().filter(better).map(name).collect::<Vec<_>>().join("; ")
}
