//! `qdist depth`: convex pairs from case files, their brackets against references, iterations and time. The format is told in [`cases`].

pub mod cases;

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use qdist::support::{Hull, Support, graph_len};
use qdist::{Depth, HullFacet, Options, Real, Solver, Workspace, hull_facets, prepare_hull};

use crate::{Trouble, flags, named, text, written};
use cases::{Case, Shape};

/// What a file looks like; the end of `--help`.
const FILES: &str = "\
A case file is one stream of tokens, without comments:

  CASE id
  S type np p...          shape A: sphere[r] box[hx hy hz, half extents] ellipsoid[a b c] cylinder[r hh] capsule[r hh] cone[r hh]
                          (axis z, half heights, cone apex at +z); `S hull nv` is followed by nv lines x y z
  P r00 .. r22 tx ty tz   pose of A: rotation row by row, then translation
  S ... / P ...           shape B and its pose
  T depth lb ub size nx ny nz

depth is minus the distance where the bodies are apart, lb and ub bracket it, size is the scale that errors are quoted against, n the unit
direction from A to B, nan where it is not known.";

/// Depths of convex pairs from case files, beside their references
///
/// A table of the families of shapes: how many brackets contradict their reference, how many are as narrow as asked for, how many normals are
/// within 1e-3 of the reference's, and time, steps and facets of the median. The exit code is 1 when a bracket is wrong.
#[derive(Args, Clone, Debug, PartialEq)]
#[command(after_help = FILES)]
pub struct Request {
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// In single precision
    #[arg(long)]
    f32: bool,
    /// The tolerance, in units of the depth [default: 1e-6, with --f32 1e-4]; with 0 for both, as narrow as rounding and 50,000 steps let it
    #[arg(long, value_name = "R", value_parser = flags::tolerance_or_none, allow_negative_numbers = true)]
    relative: Option<f64>,
    /// The tolerance, in units of the case's size [default: 1e-12, with --f32 1e-5]
    #[arg(long, value_name = "R", value_parser = flags::tolerance_or_none, allow_negative_numbers = true)]
    absolute: Option<f64>,
    /// One line for every case, and nothing else on the standard output
    #[arg(long)]
    csv: bool,
    /// Name the cases whose bracket is wrong or wide, or whose normal is off
    #[arg(long, short, conflicts_with = "csv")]
    verbose: bool,
}

const HEADER: &str = "id,family,outcome,lower,upper,nx,ny,nz,depth,iterations,support_calls,vertices,facets,ns";
/// Timed queries: the median of so many batches.
const BATCHES: usize = 5;
const QUERIES: u32 = 20;
/// Hulls of more points are prepared.
const PLAIN: usize = 32;

/// A solved case.
struct Found {
    depth: Depth<f64>,
    /// Microseconds.
    time: f64,
    right: bool,
    narrow: bool,
    along: bool,
}

/// Answers on the standard output.
pub fn run(request: &Request) -> Result<(), Trouble> {
    let mut out = io::stdout().lock();
    if request.csv {
        writeln!(out, "{HEADER}").map_err(written)?;
    }
    let mut wrong = 0;
    for file in &request.files {
        let named = |trouble| named(file, trouble);
        let text = text::read(file).map_err(named)?;
        let cases = cases::parse(&text).map_err(named)?;
        if cases.is_empty() {
            return Err(named("there is no case in it".into()));
        }
        let found = match request.f32 {
            true => solve_all::<f32>(request, &cases),
            false => solve_all::<f64>(request, &cases),
        }
        .map_err(named)?;
        wrong += found.iter().filter(|f| !f.right).count();
        match request.csv {
            true => csv(&mut out, &cases, &found),
            false => table(&mut out, file, request, &cases, &found),
        }
        .map_err(written)?;
    }
    out.flush().map_err(written)?;
    crate::agree(wrong)
}

fn solve_all<T: Real>(request: &Request, cases: &[Case]) -> Result<Vec<Found>, Trouble> {
    let (relative, absolute) = if request.f32 { (1e-4, 1e-5) } else { (1e-6, 1e-12) };
    let tolerances = (request.relative.unwrap_or(relative), request.absolute.unwrap_or(absolute));
    let mut memory = Box::new(Workspace::<T, 3, 256, 512>::new());
    let mut solver = memory.solver();
    cases.iter().map(|case| solve(&mut solver, case, tolerances)).collect()
}

fn solve<T: Real>(solver: &mut Solver<'_, T, 3>, case: &Case, tolerances: (f64, f64)) -> Result<Found, Trouble> {
    let points = case.bodies.each_ref().map(|b| b.shape.points::<T>());
    let mut words = points.each_ref().map(|p| vec![0; graph_len(p.len())]);
    let [left, right] = &mut words;
    let at = |i: usize| move |trouble| format!("line {}: case {}: {trouble}", case.lines[i], case.id);
    let a = prepared(&case.bodies[0].shape, &points[0], left).map_err(at(0))?;
    let b = prepared(&case.bodies[1].shape, &points[1], right).map_err(at(1))?;
    let (a, b) = (case.bodies[0].body(&*a).map_err(at(0))?, case.bodies[1].body(&*b).map_err(at(1))?);
    let (relative, absolute) = (T::of(tolerances.0), T::of(tolerances.1 * case.size));
    let options = Options { relative, absolute, ..Options::default() };
    let depth = solver.depth(&a, &b, &options).to_f64();
    let mut times = [0.0; BATCHES];
    for time in &mut times {
        let begin = Instant::now();
        for _ in 0..QUERIES {
            std::hint::black_box(solver.depth(&a, &b, &options));
        }
        *time = begin.elapsed().as_secs_f64() * 1e6 / f64::from(QUERIES);
    }
    times.sort_by(f64::total_cmp);
    let blur = blur::<T>(case);
    Ok(Found {
        time: times[BATCHES / 2],
        right: depth.lower - blur <= case.upper && case.lower <= depth.upper + blur,
        narrow: depth.upper - depth.lower <= (tolerances.0 * case.depth.abs()).max(tolerances.1 * case.size),
        along: case.normal.is_none_or(|n| n.dot(&depth.normal) > 1.0 - 0.5e-6),
        depth,
    })
}

/// Large hulls with their graph, other shapes as they are; `words` has [`graph_len`] of the points.
pub fn prepared<'a, T: Real>(
    shape: &Shape,
    points: &'a [[T; 3]],
    words: &'a mut [u16],
) -> Result<Box<dyn Support<T, 3> + Sync + 'a>, Trouble> {
    if points.len() > PLAIN && shape.kind == "hull" {
        let mut facets = vec![HullFacet::EMPTY; hull_facets(points.len())];
        // (A hull that cannot be prepared, a flat one say, is asked as it is.)
        if let Ok(graph) = prepare_hull(points, words, &mut facets, None) {
            return Ok(Box::new(Hull::new(points, graph).map_err(|error| format!("hull: {error}"))?));
        }
    }
    shape.build(points)
}

/// The reference is about the file's numbers: in single precision they are others, and so is the truth.
fn blur<T: Real>(case: &Case) -> f64 {
    if size_of::<T>() == size_of::<f64>() {
        return 0.0;
    }
    let offset: f64 = case.bodies.iter().flat_map(|b| b.translation).map(f64::abs).sum();
    let sizes = case.bodies.iter().map(|b| b.shape.numbers.iter().fold(0.0f64, |most, x| most.max(x.abs())));
    8.0 * T::ROUNDOFF.to_f64() * (offset + 3.0 * sizes.sum::<f64>())
}

fn csv(out: &mut dyn Write, cases: &[Case], found: &[Found]) -> io::Result<()> {
    for (case, Found { depth: d, time, .. }) in cases.iter().zip(found) {
        let outcome = crate::grasp::csv::outcome_name(d.outcome);
        let (n, ns) = (d.normal, (1e3 * time).round());
        write!(out, "{},{},{outcome},{:?},{:?},", case.id, case.family(), d.lower, d.upper)?;
        write!(out, "{:?},{:?},{:?},{:?},", n[0], n[1], n[2], case.depth)?;
        writeln!(out, "{},{},{},{},{ns}", d.iterations, d.support_calls, d.vertices, d.facets)?;
    }
    Ok(())
}

fn table(out: &mut dyn Write, file: &Path, request: &Request, cases: &[Case], found: &[Found]) -> io::Result<()> {
    let count = |of: fn(&Found) -> bool| found.iter().filter(|f| of(f)).count();
    writeln!(
        out,
        "{}: {} cases, {} brackets wrong, {} narrow, {} normals right",
        file.display(),
        cases.len(),
        count(|f| !f.right),
        count(|f| f.narrow),
        count(|f| f.along)
    )?;
    let mut families: BTreeMap<String, Vec<&Found>> = BTreeMap::new();
    for (case, found) in cases.iter().zip(found) {
        families.entry(case.family()).or_default().push(found);
        if request.verbose && !(found.right && found.narrow && found.along) {
            one(out, case, found)?;
        }
    }
    writeln!(
        out,
        "  {:22} {:>5} {:>9} {:>9} {:>9} {:>7} {:>7}",
        "family", "cases", "us least", "median", "most", "steps", "facets"
    )?;
    for (family, mut list) in families {
        list.sort_by(|a, b| a.time.total_cmp(&b.time));
        let [least, middle, most] = [0, list.len() / 2, list.len() - 1].map(|i| list[i]);
        let (steps, facets) = (middle.depth.iterations, middle.depth.facets);
        let times = format!("{:9.2} {:9.2} {:9.2}", least.time, middle.time, most.time);
        writeln!(out, "  {family:22} {:5} {times} {steps:7} {facets:7}", list.len())?;
    }
    Ok(())
}

/// A case that is not as it should be.
fn one(out: &mut dyn Write, case: &Case, found: &Found) -> io::Result<()> {
    let d = &found.depth;
    let faults = [(found.right, "WRONG"), (found.narrow, "wide"), (found.along, "normal off")];
    let faults: Vec<&str> = faults.into_iter().filter(|fault| !fault.0).map(|fault| fault.1).collect();
    let outcome = crate::grasp::csv::outcome_name(d.outcome);
    let (under, over) = (d.lower - case.depth, d.upper - case.depth);
    writeln!(
        out,
        "  {}: {}; {outcome}, depth {:e}, bracket {under:+.1e} {over:+.1e} of it, size {:.1e}, {} steps, {} facets",
        case.id,
        faults.join(", "),
        case.depth,
        case.size,
        d.iterations,
        d.facets
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flags::{parse, refuses};

    #[test]
    fn what_may_not_be_asked() {
        for line in ["", "a --verbose --csv"] {
            assert!(parse::<Request>(line).is_err(), "{line}");
        }
        for flag in ["relative", "absolute"] {
            refuses::<Request>("a", flag, &["nan", "inf", "-1", "1", "x"]);
        }
    }

    /// Every bracket of a fixture is right and narrow, in both scalar types; a reference that is not true is noticed.
    #[test]
    fn the_fixture_and_a_false_reference() {
        let text =
            std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/data/std_box_box.txt")).unwrap();
        let mut cases = cases::parse(&text).unwrap();
        let request = |line: &str| parse::<Request>(line).unwrap();
        let found = solve_all::<f64>(&request("a.txt"), &cases).unwrap();
        assert!(found.iter().all(|f| f.right && f.narrow && f.along));
        assert!(solve_all::<f32>(&request("a.txt --f32"), &cases).unwrap().iter().all(|f| f.right));
        let mut lines = Vec::new();
        csv(&mut lines, &cases, &found).unwrap();
        let lines = String::from_utf8(lines).unwrap();
        assert!(lines.lines().all(|line| line.split(',').count() == HEADER.split(',').count()));
        cases[1].bodies[1].shape.numbers[0] = -1.0;
        let told = solve_all::<f64>(&request("a.txt"), &cases[1..2]).err().unwrap();
        let says = format!("line {}: case {}: box: a size of the shape", cases[1].lines[1], cases[1].id);
        assert!(told.starts_with(&says) && cases[1].lines[0] < cases[1].lines[1], "{told}");
        cases.truncate(1);
        (cases[0].lower, cases[0].upper) = (2.0 * cases[0].depth, 2.0 * cases[0].depth);
        assert!(!solve_all::<f64>(&request("a.txt"), &cases).unwrap()[0].right);
    }
}
