//! The paper's Table I beside ours.

use std::io::{self, Write};

use crate::mesh::answer::Row;
use crate::mesh::bodies::Bodies;
use crate::mesh::input::{Kind, Query};
use crate::mesh::table::quantile;

/// A column of the paper: the meshes' names, here and there, and milliseconds for DISP and sigma.
struct Column {
    files: [&'static str; 2],
    names: [&'static str; 2],
    triangles: [usize; 2],
    ms: [f64; 2],
}

const COLUMNS: [Column; 3] = [
    Column {
        files: ["lshape", "torusknot"],
        names: ["L-Shape", "Torus-with-a-Knot"],
        triangles: [20, 2880],
        ms: [219.0, 156.0],
    },
    Column { files: ["pawn", "cad"], names: ["Pawn", "CAD"], triangles: [304, 2442], ms: [297.0, 445.0] },
    Column {
        files: ["hammer", "bumpysphere"],
        names: ["Hammer", "Bumpy-Sphere"],
        triangles: [1692, 2880],
        ms: [109.0, 138.0],
    },
];

const NOTES: &str = "\
The paper's times are averages on a PC of 2007, for poses and an implementation that are not available, with at most 30 iterations and no word on how good the
bounds are. Its meshes are not available either: ours are re-creations with the same numbers of triangles. So the numbers of triangles compare, the
times do only in order of magnitude (a core of today is some five to ten times faster), and the quality does not. Ours are medians over the file's queries.";

/// Where the queries come from, for who has none.
pub const WHENCE: &str = "\
the pairs of Table I (lshape torusknot, pawn cad, hammer bumpysphere) are no part of the project: they lie beside it, in ../shared/data/meshes; \
--queries FILE.json names another file of queries about meshes of these names";

impl Column {
    fn has(&self, query: &Query) -> bool {
        let stem = |file: &std::path::Path| file.file_stem().map(|s| s.to_string_lossy().to_string());
        [&query.a, &query.b].into_iter().zip(self.files).all(|(file, name)| stem(file).as_deref() == Some(name))
    }
}

/// The queries whose meshes are in the table.
pub fn select(queries: Vec<Query>) -> Result<Vec<Query>, String> {
    let found: Vec<Query> = queries.into_iter().filter(|q| COLUMNS.iter().any(|column| column.has(q))).collect();
    match found.is_empty() {
        true => Err("no query is about a pair of Table I (lshape torusknot, pawn cad, hammer bumpysphere)".into()),
        false => Ok(found),
    }
}

pub fn write(out: &mut impl Write, queries: &[Query], bodies: &Bodies, rows: &[Row]) -> io::Result<()> {
    writeln!(
        out,
        "{:8} {:>20} {:>8} {:>7} {:>8} {:>8} {:>10} {:>12} {:>11} {:>10}",
        "", "A / B", "tri's", "ours", "metric", "queries", "paper ms", "ours ms", "paper/ours", "within 1%"
    )?;
    for (i, column) in COLUMNS.iter().enumerate() {
        let of: Vec<&Query> = queries.iter().filter(|q| column.has(q)).collect();
        let Some(first) = of.first() else { continue };
        let ours = [&first.a, &first.b].map(|file| bodies.get(file).mesh().triangles().len());
        for (k, kind) in Kind::BOTH.into_iter().enumerate() {
            let rows: Vec<&Row> =
                rows.iter().filter(|r| r.kind == kind && of.iter().any(|q| q.id == r.query)).collect();
            if rows.is_empty() {
                continue;
            }
            let ms = quantile(&rows.iter().map(|r| r.ns as f64 / 1e6).collect::<Vec<_>>(), 0.5);
            let ratios: Vec<f64> = rows.iter().filter_map(|r| r.ratio()).collect();
            let near = format!("{}/{}", ratios.iter().filter(|r| **r <= 1.01).count(), ratios.len());
            let (number, name, paper) = (i + 1, column.names[k], column.ms[k]);
            let (theirs, ours, metric, count) = (column.triangles[k], ours[k], kind.name(), rows.len());
            writeln!(
                out,
                "{number:<8} {name:>20} {theirs:>8} {ours:>7} {metric:>8} {count:>8} {paper:>10.0} {ms:>12.3} {:>11.1} {near:>10}",
                paper / ms
            )?;
        }
    }
    writeln!(out, "\n{NOTES}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use qdist::nalgebra::Isometry3;

    #[test]
    fn pairs_are_known_by_their_names() {
        let query = |a: &str, b: &str| Query::new(format!("{a}-{b}"), a.into(), b.into(), Isometry3::identity());
        let found = select(vec![query("dir/pawn.obj", "cad.ply"), query("cad.obj", "pawn.obj"), query("x", "y")]);
        let names: Vec<String> = found.unwrap().into_iter().map(|q| q.id).collect();
        assert_eq!(names, ["dir/pawn.obj-cad.ply"]);
        assert!(select(vec![query("a.obj", "b.obj")]).is_err());
    }
}
