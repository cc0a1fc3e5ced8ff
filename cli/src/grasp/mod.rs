//! `qdist grasp`: reads grasps from a JSON file and tells how well they hold: d_Q of their wrench sets, with a bracket, in words, beside the
//! file's own references.
//!
//! `--help` tells what it takes, and how a file looks. What the file may say in full is told in `input.rs`. A grasp without `refs` is asked for a ball, with
//! both norms, and with W^a where a contact has a Jacobian.

use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

use clap::Args;
use qdist::grasp::Norm;

pub mod csv;
pub mod input;
mod plot;
pub mod query;
pub mod sets;
mod slices;
mod surface;
mod table;
mod table1;
pub mod unit_sets;
mod words;

use crate::{Trouble, flags, named, text, written};
use input::{Grasp, Reference, Set};
use query::{Effort, Memory};
use sets::Sets;
use unit_sets::{Q, Shape};

/// What a file looks like; the end of `--help`.
const FILES: &str = r#"The least that a file must say, a pinch of a block by two soft fingertips (normals n point into the object):

  {"contacts": [{"p": [-0.03, 0, 0], "n": [ 1, 0, 0], "mu": 0.5, "mus": 0.01},
                {"p": [ 0.03, 0, 0], "n": [-1, 0, 0], "mu": 0.5, "mus": 0.01}]}

More of it: several grasps as {"instances": [...]} or [...].
  a grasp     "id", "torque_scale" (L: moments are divided by it; 1), "reference" (moments are about this point; the origin), "normalize",
              "length_unit_m", "refs"
  a contact   "p", "n"; "o", "t" (tangents, n = o x t); "mu" (friction), "mus" (spin friction, a length), "type" (soft, hard, frictionless);
              "force_cap" (largest normal force; 1); "finger" (a name); "J" (4 rows: motion along n, o, t and turn about n, per joint),
              "joints" (names), "torque_limits" (one a joint, null: none; contacts of the same finger share them)
  a ref       "set" (W: all that friction allows; Wa: what joints generate), "norm" (L1: contacts share one force; Linf: each has its own),
              "Q", and, if known, "d" with "tol"
  Q           {"type": "ball", "radius"}, {"type": "ellipsoid", "semi_axes"}, {"type": "box", "half_widths"}, {"type": "cross_polytope", "half_axes"},
              {"type": "segment", "wrench"}: six numbers, forces first; or fewer along the rows of "S" (or the columns of the ref's "R")

Any other field is an error; a name that begins with _ is a note. Without "refs" a grasp is asked for the unit ball."#;

/// How well do grasps hold?
///
/// For each grasp of the file, and each set of wrenches Q that it asks about: d, the largest multiple of Q that the contacts can resist, as a
/// bracket [lower, upper]; what is hardest to resist, and which contacts limit it.
#[derive(Args, Clone, Debug, PartialEq)]
#[command(after_help = FILES)]
pub struct Request {
    /// Grasps; what a file may say is told below
    #[arg(value_name = "FILE.json", required_unless_present = "table1")]
    file: Option<PathBuf>,
    /// One line for every reference, and nothing else on the standard output
    #[arg(long)]
    csv: bool,
    /// The paper's Table I beside ours; needs no file
    #[arg(long, conflicts_with = "csv")]
    table1: bool,
    /// Make all normals and tangents unit vectors (in the file: "normalize": true)
    #[arg(long)]
    normalize: bool,
    /// A picture for every reference: DIR/ID_REF.svg
    #[arg(long, value_name = "DIR")]
    plot: Option<PathBuf>,
    /// The tolerance where Q is a ball or an ellipsoid, above 0 and below 1; polytopes and segments are solved to 1e-10
    ///
    /// In six dimensions a tenth of the tolerance takes up to some hundred times as long: below 1e-6 most queries end with their time.
    #[arg(long, value_name = "R", default_value = "1e-4", value_parser = flags::tolerance, allow_negative_numbers = true)]
    relative: f64,
    /// A query of a ball or an ellipsoid ends after so long, with the bracket so far and the outcome `interrupted`
    #[arg(long, value_name = "S", default_value = "60", value_parser = flags::seconds, allow_negative_numbers = true)]
    seconds: Duration,
}

impl Request {
    fn effort(&self) -> Effort {
        Effort { relative: self.relative, time: self.seconds }
    }
}

/// The queries of a grasp that comes without: W^a where joints make forces.
fn usual_queries(grasp: &Grasp) -> Result<Vec<Reference>, Trouble> {
    let actuated = grasp.contacts.iter().any(|c| c.contact.jacobian.is_some());
    let sets: &[Set] = if actuated { &[Set::Passive, Set::Active] } else { &[Set::Passive] };
    let kinds = sets.iter().flat_map(|&set| [(set, Norm::L1), (set, Norm::LInf)]);
    kinds
        .map(|(set, norm)| Ok(Reference { set, norm, q: Q::new(Shape::Ball(1.0), None)?, d: None, tolerance: 0.0 }))
        .collect()
}

/// How far a long run has come, on the standard error; at most once in two seconds, and nothing of a short one.
struct Progress {
    all: usize,
    last: Instant,
}

impl Progress {
    fn new(all: usize) -> Self {
        Self { all, last: Instant::now() }
    }

    fn tell(&mut self, done: usize, id: &str) {
        if self.last.elapsed() > Duration::from_secs(2) {
            self.last = Instant::now();
            eprintln!("{done} of {} grasps done; now {id}", self.all);
        }
    }
}

/// Answers for all of the grasps.
fn report(request: &Request, mut grasps: Vec<Grasp>, out: &mut dyn Write) -> Result<(), Trouble> {
    let mut memory = Box::new(Memory::new());
    let mut solver = memory.solver();
    if request.csv {
        writeln!(out, "{}", csv::HEADER).map_err(written)?;
    }
    let (mut known, mut inside) = (0, 0);
    let mut progress = Progress::new(grasps.len());
    for (done, grasp) in grasps.iter_mut().enumerate() {
        grasp.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
        progress.tell(done, &grasp.id);
        let sets = Sets::of_grasp(grasp)?;
        if grasp.queries.is_empty() {
            grasp.queries = usual_queries(grasp)?;
        }
        if !request.csv {
            table::begin(out, grasp, &sets).map_err(written)?;
        }
        for (i, q) in grasp.queries.iter().enumerate() {
            let found = query::solve(&mut solver, sets.get(q.set), q.set, q.norm, &q.q, &request.effort())
                .map_err(|trouble| format!("grasp {}, ref {i}: {trouble}", grasp.id))?;
            if let Some(contained) = table::contains(&found, q) {
                known += 1;
                inside += usize::from(contained);
            }
            match request.csv {
                true => csv::row(out, grasp, i, &found),
                false => table::row(out, &sets, i, q, &found),
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
    out.flush().map_err(written)?;
    crate::agree(known - inside)
}

/// Answers on the standard output.
pub fn run(request: &Request) -> Result<(), Trouble> {
    let mut out = io::stdout().lock();
    if request.table1 {
        table1::print(&mut out, &request.effort())?;
    }
    if let Some(file) = &request.file {
        let named = |trouble| named(file, trouble);
        let text = text::read(file).map_err(named)?;
        let grasps = input::read(&text, request.normalize).map_err(named)?;
        if let Some(folder) = &request.plot {
            std::fs::create_dir_all(folder).map_err(|e| format!("--plot {}: {e}", folder.display()))?;
        }
        report(request, grasps, &mut out).map_err(named)?;
    }
    out.flush().map_err(written)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flags::refuses;

    fn parse(line: &str) -> Result<Request, clap::Error> {
        flags::parse(line)
    }

    #[test]
    fn what_may_be_asked() {
        let request = parse("a.json --csv --relative 1e-6 --plot out --normalize").unwrap();
        assert_eq!((request.file, request.plot), (Some("a.json".into()), Some("out".into())));
        assert_eq!((request.csv, request.normalize, request.relative), (true, true, 1e-6));
        let request = parse("--table1").unwrap();
        assert_eq!((request.file, request.table1, request.relative), (None, true, 1e-4));
    }

    #[test]
    fn what_may_not() {
        let lines = ["", "a b", "a --what", "a --plot", "--table1 --csv"];
        lines.into_iter().for_each(|line| assert!(parse(line).is_err(), "{line}"));
        for flag in ["relative", "seconds"] {
            refuses::<Request>("a", flag, &["nan", "inf", "-1", "0", "1e9", "x"]);
        }
    }
    /// The answers of a grasp without `refs` are the usual ones, in numbers, too; one that is not in its reference's bracket is trouble.
    #[test]
    fn answers_and_references() {
        let contacts = r#""contacts": [{"p": [-1, 0, 0], "n": [1, 0, 0], "mu": 0.5, "mus": 0.1}, {"p": [1, 0, 0], "n": [-1, 0, 0], "mu": 0.5, "mus": 0.1}]"#;
        let answers = |refs: &str| {
            let grasps = input::read(&format!("{{{contacts}{refs}}}"), false).unwrap();
            let mut out = Vec::new();
            let told = report(&parse("a --csv").unwrap(), grasps, &mut out);
            (told, String::from_utf8(out).unwrap().lines().count())
        };
        assert_eq!(answers(""), (Ok(()), 3));
        let (told, lines) = answers(r#", "refs": [{"set": "W", "norm": "L1", "Q": {"type": "ball"}, "d": 5.0}]"#);
        assert_eq!((told.unwrap_err().as_str(), lines), ("1 bracket contradicts its reference", 2));
    }
}
