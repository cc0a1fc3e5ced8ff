//! `qdist mesh`: how little must A move, rotations included, to be free of B? Asks the queries of a file, or poses of two mesh files.
//!
//! All options are in `args.rs`, what a file may say is in `input.rs`.

use std::collections::HashMap;
use std::io::{self, BufWriter, Write};

use qdist::mesh::{ContactSamples, DepthOptions, DepthSolver};

pub mod answer;
mod args;
mod bar;
pub mod bodies;
pub mod input;
mod order;
mod picture;
pub mod read;
pub mod seeds;
pub mod table;
mod table1;
mod words;

use crate::{Trouble, written};
use answer::Row;
pub use args::{Request, Source};
use bar::Bar;
use bodies::Bodies;
use input::Query;

/// What is asked: the queries of a file, or of the command line.
fn queries(source: &Source) -> Result<Vec<Query>, String> {
    match source {
        Source::File(file) => input::queries(file),
        Source::Table1(file) => {
            let queries = input::queries(file).map_err(|trouble| match file.exists() {
                true => trouble,
                false => format!("{trouble}; {}", table1::WHENCE),
            })?;
            table1::select(queries)
        }
        Source::Pair([a, b], poses) => {
            let query = |(i, pose)| Query::new(format!("pose{i}"), a.clone(), b.clone(), pose);
            Ok(poses.iter().copied().enumerate().map(query).collect())
        }
    }
}

/// Answers on the standard output.
pub fn run(request: &Request) -> Result<(), Trouble> {
    let source = request.source();
    let queries = queries(&source)?;
    if let Some(folder) = &request.picture {
        std::fs::create_dir_all(folder).map_err(|e| format!("--picture {}: {e}", folder.display()))?;
    }
    let bar = Bar::new(queries.len() * request.kinds().len());
    let bodies = match &source {
        Source::File(file) | Source::Table1(file) => Bodies::of(&queries, |file| bar.say(&file.display().to_string()))
            .map_err(|trouble| format!("{}: {trouble}", file.display()))?,
        Source::Pair(files, _) => {
            let mut bodies = Bodies::default();
            files.iter().try_for_each(|file| bodies.read(file))?;
            bodies
        }
    };
    let named = match &source {
        Source::Pair(files, _) if files[0] != files[1] => files.iter().map(|f| (f.as_path(), bodies.get(f))).collect(),
        _ => bodies.iter().collect::<Vec<_>>(),
    };
    for (file, model) in named {
        let report = words::report(file, model);
        if request.csv || !matches!(source, Source::Pair(..)) {
            // Only what is wrong, and not between the answers.
            if !model.mesh().report().is_clean() {
                eprint!("{report}");
            }
        } else {
            write!(io::stdout(), "{report}").map_err(written)?;
        }
    }
    answer_all(request, &source, &queries, &bodies, &bar)
}

fn answer_all(
    request: &Request,
    source: &Source,
    queries: &[Query],
    bodies: &Bodies,
    bar: &Bar,
) -> Result<(), Trouble> {
    let table1 = matches!(source, Source::Table1(_));
    let mut out = BufWriter::new(io::stdout().lock());
    let readable = !request.csv && !table1 && !queries.is_empty();
    if request.csv {
        writeln!(out, "{}", answer::HEADER).map_err(written)?;
    } else if readable {
        table::head(&mut out).map_err(written)?;
    }
    let options = DepthOptions { effort: request.effort(), seed: request.seed, ..DepthOptions::default() };
    let mut solvers: HashMap<_, (DepthSolver, ContactSamples)> = HashMap::new();
    let mut rows: Vec<Row> = Vec::new();
    for query in queries {
        let (solver, samples) = solvers.entry((&query.a, &query.b)).or_insert_with(|| {
            let (a, b) = (bodies.get(&query.a), bodies.get(&query.b));
            let mut tell = |made: usize| {
                bar.say(&format!("{}: {made} contact samples", query.id));
                false
            };
            let samples = ContactSamples::new(a, b, request.samples as usize, request.seed, Some(&mut tell));
            (DepthSolver::new(a, b), samples)
        });
        let mut before = None;
        for &kind in request.kinds() {
            let name = format!("{} {}", query.id, kind.name());
            let mut poses = seeds::nearest(samples, solver.a(), kind, &query.pose);
            // No point moves more than DISP's pose says, so the object norm's depth is no more either.
            poses.extend(before);
            let options = DepthOptions { poses: &poses, ..options };
            let row = bar.during(rows.len(), &name, |watch| answer::ask(solver, query, kind, &options, watch));
            before = (row.upper.is_finite() && row.upper > 0.0).then_some(row.pose);
            if let Some(folder) = &request.picture {
                picture::draw(solver, query, &row, &options, folder)?;
            }
            if request.csv {
                row.write(&mut out).map_err(written)?;
            } else if readable {
                table::line(&mut out, &row).map_err(written)?;
                if matches!(source, Source::Pair(..)) {
                    table::pose(&mut out, &row).map_err(written)?;
                }
            }
            rows.push(row);
        }
        // Who waits sees what there is.
        bar.aside(|| out.flush()).map_err(written)?;
    }
    bar.finish();
    if table1 && !request.csv {
        table1::write(&mut out, queries, bodies, &rows).map_err(written)?;
    } else if readable && queries.len() > 1 && !matches!(source, Source::Pair(..)) {
        table::summary(&mut out, &rows).map_err(written)?;
    }
    out.flush().map_err(written)?;
    crate::agree(rows.iter().filter(|row| row.contradiction().is_some()).count())
}
