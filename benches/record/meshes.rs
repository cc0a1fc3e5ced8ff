//! The queries of all files of meshes, both metrics, with a limit of collision queries; for each the certificate of all effort,
//! and a tracker that comes to the pose from aside.

use std::collections::BTreeMap;
use std::error::Error;
use std::path::{Path, PathBuf};

use nalgebra::Translation3;
use qdist::mesh::certificate::{Certifier, Effort, Pieces};
use qdist::mesh::metric::Metric;
use qdist::mesh::{Budget, DepthOptions, DepthSolver, DepthTracker, MeshDepth};
use qdist_cli::mesh::bodies::{Bodies, metric};
use qdist_cli::mesh::input::{self, Kind, Query};

use crate::line::Record;

/// The limit of a query.
const MOST: u64 = 400;
const TICKS: u32 = 8;

pub fn all(record: &mut Record) -> Result<(), Box<dyn Error>> {
    let shared = ["", "/narrow", "/reported"].map(|folder| format!("../shared/data/meshes{folder}"));
    for folder in ["tests/data/meshes".to_string()].iter().chain(&shared) {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder).join("queries.json");
        if !file.exists() {
            continue;
        }
        let queries = input::queries(&file)?;
        let bodies = Bodies::of(&queries, |_| ())?;
        for (file, model) in bodies.iter() {
            let pieces = model.pieces().map_or(&[][..], Pieces::pieces);
            let name = file.file_name().unwrap_or_default().display();
            for (i, piece) in pieces.iter().enumerate() {
                let corners = piece.corners();
                record.line(&format!("{folder}/{name}:piece{i}"), &corners.len(), corners.iter().flatten())?;
            }
        }
        let mut certifier = Certifier::new();
        let mut solvers: BTreeMap<(&PathBuf, &PathBuf), DepthSolver> = BTreeMap::new();
        for query in &queries {
            let pair = (bodies.get(&query.a), bodies.get(&query.b));
            let solver = solvers.entry((&query.a, &query.b)).or_insert_with(|| DepthSolver::new(pair.0, pair.1));
            let name = format!("{folder}:{}", query.id.replace(' ', "_"));
            for kind in Kind::BOTH {
                let Some(metric) = metric(pair.0, kind) else { continue };
                let name = format!("{name}:{}", kind.name());
                let options = DepthOptions { max_queries: MOST, ..DepthOptions::default() };
                one(record, &name, &solver.depth(&query.pose, metric, &options, None))?;
                if let (Some(a), Some(b)) = (pair.0.pieces(), pair.1.pieces()) {
                    let bound = match kind {
                        Kind::Disp => certifier.disp(a, b, &query.pose, Effort::Heavy),
                        Kind::Sigma => certifier.sqrt_sigma(a, b, &query.pose, Effort::Heavy),
                    };
                    record.line(&format!("{name}:certificate"), &Effort::Heavy, &[bound])?;
                }
                path(record, &name, &mut DepthTracker::new(pair.0, pair.1), metric, query)?;
            }
        }
    }
    Ok(())
}

fn one(record: &mut Record, question: &str, depth: &MeshDepth) -> std::io::Result<()> {
    let distance = depth.distance.map_or(0.0, |found| found.distance);
    let numbers = [&depth.lower, &depth.upper, &distance].into_iter();
    let numbers = numbers.chain(&depth.pose.rotation.coords).chain(&depth.pose.translation.vector);
    record.line(question, &(depth.outcome, depth.solid, depth.walks), numbers)
}

/// Ticks of a tracker, the last at the query's pose.
fn path(
    record: &mut Record,
    name: &str,
    tracker: &mut DepthTracker,
    metric: &dyn Metric,
    query: &Query,
) -> std::io::Result<()> {
    let step = 1e-3 * tracker.solver().a().mesh().diagonal();
    for tick in 0..TICKS {
        let aside = f64::from(TICKS - 1 - tick) * step;
        let pose = Translation3::new(aside, -0.5 * aside, 0.25 * aside) * query.pose;
        let depth = tracker.update(&pose, metric, &Budget::default(), None);
        one(record, &format!("{name}:tick{tick}"), &depth)?;
    }
    Ok(())
}
