//! Reads grasps from a JSON file and tells how well they hold: d_Q of their wrench sets, with a bracket, in words, beside the file's own
//! references.
//!
//! ```text
//! cargo run --release --features std --example grasp -- ../shared/data/grasps/grasps.json
//! ```
//!
//! * `--csv`: one line for every reference, and nothing else on the standard output.
//! * `--plot DIR`: a picture for every reference, as `DIR/ID_REF.svg`.
//! * `--relative R`: the tolerance, 1e-4 otherwise, where Q is a ball or an ellipsoid. Polytopes and segments are solved to 1e-10.
//! * `--table1`: the paper's Table I beside ours; needs no file.
//!
//! What the file may say is told in `input.rs`. A grasp without `refs` is asked for a ball, with both sets and norms.

use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use qdist::grasp::Norm;

mod csv;
mod gauges;
mod input;
mod plot;
mod query;
mod sets;
mod slices;
mod surface;
mod table;
mod table1;
mod words;

use gauges::{Q, Shape};
use input::{Grasp, Reference, Set};
use query::Memory;
use sets::Sets;

/// What is wrong, in words.
type Trouble = String;

const USAGE: &str = "usage: grasp FILE.json [--csv] [--plot DIR] [--relative R]\n       grasp --table1";

/// What the command line asks for.
#[derive(Debug, PartialEq)]
struct Request {
    file: Option<String>,
    csv: bool,
    table1: bool,
    plot: Option<PathBuf>,
    relative: f64,
}

impl Request {
    fn parse(arguments: impl Iterator<Item = String>) -> Result<Self, Trouble> {
        let mut request = Self { file: None, csv: false, table1: false, plot: None, relative: 1e-4 };
        let mut arguments = arguments;
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--csv" => request.csv = true,
                "--table1" => request.table1 = true,
                "--plot" => request.plot = Some(value()?.into()),
                "--relative" => {
                    let text = value()?;
                    let number = text.parse().ok().filter(|x: &f64| *x >= 0.0 && *x < 1.0);
                    request.relative = number.ok_or(format!("--relative {text} is not a number from 0 to 1"))?;
                }
                flag if flag.starts_with('-') => return Err(format!("{flag} is not known")),
                _ if request.file.is_some() => return Err("more than one file".into()),
                _ => request.file = Some(argument),
            }
        }
        match (&request.file, request.table1, request.csv) {
            (None, false, _) => Err("no file".into()),
            (_, true, true) => Err("--table1 is not for --csv".into()),
            _ => Ok(request),
        }
    }
}

/// The queries of a grasp that comes without.
fn usual_queries() -> Result<Vec<Reference>, Trouble> {
    let kinds = [Set::Passive, Set::Active].into_iter().flat_map(|set| [(set, Norm::L1), (set, Norm::LInf)]);
    kinds
        .map(|(set, norm)| Ok(Reference { set, norm, q: Q::new(Shape::Ball(1.0), None)?, d: None, tolerance: 0.0 }))
        .collect()
}

/// Answers for all of the grasps.
fn report(request: &Request, mut grasps: Vec<Grasp>, out: &mut dyn Write) -> Result<(), Trouble> {
    let mut memory = Box::new(Memory::new());
    let mut solver = memory.solver();
    if request.csv {
        writeln!(out, "{}", csv::HEADER).map_err(written)?;
    }
    let (mut known, mut inside) = (0, 0);
    for grasp in &mut grasps {
        let sets = Sets::of_grasp(grasp)?;
        if grasp.queries.is_empty() && !request.csv {
            grasp.queries = usual_queries()?;
        }
        if !request.csv {
            table::begin(out, grasp, &sets).map_err(written)?;
        }
        for (i, q) in grasp.queries.iter().enumerate() {
            let found = query::solve(&mut solver, sets.get(q.set), q.set, q.norm, &q.q, request.relative)
                .map_err(|trouble| format!("grasp {}, ref {i}: {trouble}", grasp.id))?;
            if let Some(contained) = table::contains(&found, q) {
                known += 1;
                inside += usize::from(contained);
            }
            match request.csv {
                true => csv::row(out, grasp, i, &found),
                false => table::row(out, grasp, &sets, i, q, &found),
            }
            .map_err(written)?;
            if let Some(folder) = &request.plot {
                plot::draw(folder, &mut solver, grasp, i, sets.get(q.set), &found)?;
            }
        }
        if !request.csv {
            writeln!(out).map_err(written)?;
        }
    }
    if !request.csv {
        writeln!(out, "{}", table::LEGEND).map_err(written)?;
        if known > 0 {
            writeln!(out, "{inside} of {known} references are in their brackets").map_err(written)?;
        }
    }
    Ok(())
}

/// The reader of the output went away: that is how `| head` ends, and no trouble.
const CLOSED: &str = "";

fn written(error: io::Error) -> Trouble {
    if error.kind() == io::ErrorKind::BrokenPipe { CLOSED.into() } else { format!("standard output: {error}") }
}

fn run(request: &Request) -> Result<(), Trouble> {
    let mut out = io::stdout().lock();
    if request.table1 {
        table1::print(&mut out, request.relative)?;
    }
    if let Some(file) = &request.file {
        let named = |trouble: Trouble| if trouble == CLOSED { trouble } else { format!("{file}: {trouble}") };
        let text = std::fs::read_to_string(file).map_err(|e| named(e.to_string()))?;
        input::read(&text).and_then(|grasps| report(request, grasps, &mut out)).map_err(named)?;
    }
    out.flush().map_err(written)
}

fn main() -> ExitCode {
    if std::env::args().any(|argument| argument == "--help") {
        println!("{USAGE}");
        return ExitCode::SUCCESS;
    }
    let request = match Request::parse(std::env::args().skip(1)) {
        Ok(request) => request,
        Err(trouble) => {
            eprintln!("{trouble}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    match run(&request) {
        Ok(()) => ExitCode::SUCCESS,
        Err(trouble) if trouble == CLOSED => ExitCode::SUCCESS,
        Err(trouble) => {
            eprintln!("{trouble}");
            ExitCode::FAILURE
        }
    }
}
