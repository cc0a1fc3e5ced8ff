//! One query, timed, and its line of CSV.

use std::io::{self, Write};
use std::time::Instant;

use qdist::mesh::{Counters, DepthOptions, DepthSolver, Outcome, Watch};
use qdist::nalgebra::Isometry3;

use crate::mesh::bodies;
use crate::mesh::input::{Kind, Known, Query};

pub const HEADER: &str = "query,metric,outcome,lower,upper,qw,qx,qy,qz,tx,ty,tz,collision_queries,contact_queries,ns";

/// An answer, and what was known before.
#[derive(Clone, Debug)]
pub struct Row {
    pub query: String,
    pub group: String,
    pub kind: Kind,
    pub outcome: &'static str,
    pub lower: f64,
    pub upper: f64,
    pub pose: Isometry3<f64>,
    /// Of the surfaces, when separated.
    pub distance: Option<f64>,
    pub counters: Counters,
    pub ns: u64,
    pub known: Known,
    /// The length of the best translation known: an upper bound for both metrics.
    pub translation: Option<f64>,
}

/// Asks. A polygon soup's object norm is the outcome `no_volume`, with nothing known.
pub fn ask(solver: &mut DepthSolver, query: &Query, kind: Kind, options: &DepthOptions, watch: Option<Watch>) -> Row {
    let mut row = Row {
        query: query.id.clone(),
        group: query.group.clone(),
        kind,
        outcome: "no_volume",
        lower: 0.0,
        upper: f64::INFINITY,
        pose: query.pose,
        distance: None,
        counters: Counters::default(),
        ns: 0,
        known: query.known(kind),
        translation: query.translation,
    };
    if let Some(metric) = bodies::metric(solver.a(), kind) {
        let begin = Instant::now();
        let depth = solver.depth(&query.pose, metric, options, watch);
        row.ns = begin.elapsed().as_nanos() as u64;
        (row.outcome, row.counters) = (outcome(depth.outcome), depth.counters);
        row.distance = depth.distance.map(|d| d.distance);
        (row.lower, row.upper, row.pose) = (depth.lower, depth.upper, depth.pose);
    }
    row
}

fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Separated => "separated",
        Outcome::Converged => "converged",
        Outcome::Bounded => "bounded",
        Outcome::Interrupted => "interrupted",
        Outcome::Budget => "budget",
        Outcome::Stuck => "stuck",
        Outcome::Invalid => "invalid",
        _ => "other",
    }
}

impl Row {
    /// The upper bound in units of the least known value.
    pub fn ratio(&self) -> Option<f64> {
        self.known.least().filter(|least| *least > 0.0).map(|least| self.upper / least)
    }

    /// Whether the bracket and what is known contradict each other, in words. References are not better than 1e-9.
    pub fn contradiction(&self) -> Option<&'static str> {
        let (more, less) = (1.0 + 1e-9, 1.0 - 1e-9);
        let proved = self.known.exact.or(self.known.lower);
        if !(self.lower <= self.upper) {
            Some("LOWER ABOVE UPPER")
        } else if self.known.least().is_some_and(|least| self.lower > least * more) {
            Some("LOWER ABOVE BEST KNOWN")
        } else if proved.is_some_and(|lower| self.upper < lower * less) {
            Some("UPPER BELOW LEAST POSSIBLE")
        } else {
            None
        }
    }

    /// A line, with every number to the last digit.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let (q, t) = (self.pose.rotation.quaternion(), self.pose.translation.vector);
        let (lower, upper) = (self.lower, self.upper);
        write!(out, "{},{},{},{lower:?},{upper:?},", quoted(&self.query), self.kind.name(), self.outcome)?;
        write!(out, "{:?},{:?},{:?},{:?},{:?},{:?},{:?},", q.w, q.i, q.j, q.k, t.x, t.y, t.z)?;
        writeln!(out, "{},{},{}", self.counters.collision, self.counters.contact, self.ns)
    }
}

/// A field of CSV.
pub fn quoted(field: &str) -> String {
    match field.contains(['"', ',', '\n', '\r']) {
        true => format!("\"{}\"", field.replace('"', "\"\"")),
        false => field.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qdist::mesh::Model;
    use qdist::nalgebra::{Isometry3, Point3};

    const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const TRIANGLES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn at(z: f64) -> Query {
        Query::new("tip, \"in\"".into(), "a".into(), "b".into(), Isometry3::translation(0.0, 0.0, z))
    }

    #[test]
    fn a_line_has_the_columns_of_the_header_and_every_digit() {
        let body = Model::new(&CORNERS, &TRIANGLES).unwrap();
        let mut solver = DepthSolver::new(&body, &body);
        for (z, kind) in [(0.9, Kind::Disp), (0.9, Kind::Sigma), (2.0, Kind::Disp)] {
            let row = ask(&mut solver, &at(z), kind, &DepthOptions::default(), None);
            let mut line = Vec::new();
            row.write(&mut line).unwrap();
            let line = String::from_utf8(line).unwrap();
            let rest = line.strip_prefix("\"tip, \"\"in\"\"\",").unwrap();
            let fields: Vec<&str> = rest.trim_end().split(',').collect();
            assert_eq!(fields.len() + 1, HEADER.split(',').count());
            assert_eq!((fields[0], fields[1] == "separated"), (kind.name(), z > 1.0));
            let numbers: Vec<f64> = fields[2..].iter().map(|f| f.parse().unwrap()).collect();
            assert_eq!(numbers[..2], [row.lower, row.upper]);
            assert_eq!(numbers[8], row.pose.translation.z);
            assert!(row.upper.is_finite() && row.contradiction().is_none());
            assert!((numbers[1] > 0.0) == (z < 1.0) && (numbers[9] > 0.0));
        }
    }

    #[test]
    fn a_soup_has_no_object_norm() {
        let open = Model::new(&CORNERS, &TRIANGLES[1..]).unwrap();
        let mut solver = DepthSolver::new(&open, &open);
        let row = ask(&mut solver, &at(0.5), Kind::Sigma, &DepthOptions::default(), None);
        assert_eq!((row.outcome, row.lower, row.upper), ("no_volume", 0.0, f64::INFINITY));
        let mut line = Vec::new();
        row.write(&mut line).unwrap();
        assert!(String::from_utf8(line).unwrap().contains(",no_volume,0.0,inf,"));
        let point: Point3<f64> = row.pose * Point3::origin();
        assert_eq!(point.z, 0.5);
    }

    #[test]
    fn contradictions_are_seen() {
        let body = Model::new(&CORNERS, &TRIANGLES).unwrap();
        let mut row = ask(&mut DepthSolver::new(&body, &body), &at(0.9), Kind::Disp, &DepthOptions::default(), None);
        row.known = Known { best: Some(row.lower * 0.5 - 1.0), ..Known::default() };
        assert_eq!(row.contradiction(), Some("LOWER ABOVE BEST KNOWN"));
        row.known = Known { exact: Some(row.upper * 1.01), ..Known::default() };
        assert_eq!(row.contradiction(), Some("UPPER BELOW LEAST POSSIBLE"));
        row.known = Known { best: Some(row.upper * 1.01), lower: Some(row.lower), exact: None };
        assert_eq!(row.contradiction(), None);
        assert!((row.ratio().unwrap() - 1.0 / 1.01).abs() < 1e-12);
    }
}
