//! Depth of bodies by parry, with the command line of `cpp/depth.cpp`:
//!
//! ```text
//! depth_parry solvers                               their names
//! depth_parry answers CASES SOLVER:TOLERANCE...     one line a case: outcome, lower, upper, depth, normal
//! depth_parry times ROUNDS CASES SOLVER:TOLERANCE... nanoseconds a query of each: the median over rounds, for each case
//! depth_parry count CASES SOLVER:TOLERANCE...       under callgrind: three dumps a solver, of 1, 1 and 3 rounds over all cases; SOLVER,CASES
//! ```
//!
//! and cases that are left out: `--without SOLVER:TOLERANCE=CASE,CASE`. The solvers are `parry`, and `nothing`, which is what the loop itself costs. The tolerance is
//! read and has no effect.

mod callgrind;
mod cases;
mod solver;

use std::collections::HashSet;
use std::hint::black_box;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::time::Instant;

use parry3d_f64::math::Vector;

use cases::Case;
use solver::{Answer, Query};

const SOLVERS: [&str; 2] = ["nothing", "parry"];
const USAGE: &str = "usage: see the head of main.rs";

struct Asked<'a> {
    text: &'a str,
    /// `nothing` has no query.
    nothing: bool,
    without: HashSet<&'a str>,
}

/// The solvers that are asked for, and the cases that they are not to have.
fn all_asked<'a>(words: &[&'a str]) -> Result<Vec<Asked<'a>>, String> {
    let mut all: Vec<Asked> = Vec::new();
    let mut without = Vec::new();
    let mut words = words.iter();
    while let Some(&word) = words.next() {
        if word == "--without" {
            without.push(words.next().and_then(|text| text.split_once('=')).ok_or(USAGE)?);
            continue;
        }
        let (name, _) = word.rsplit_once(':').ok_or(USAGE)?;
        if !SOLVERS.contains(&name) {
            return Err(format!("no solver {word}"));
        }
        all.push(Asked { text: word, nothing: name == "nothing", without: HashSet::new() });
    }
    for (solver, cases) in without {
        for asked in all.iter_mut().filter(|asked| asked.text == solver) {
            asked.without.extend(cases.split(','));
        }
    }
    if all.is_empty() { Err(USAGE.to_owned()) } else { Ok(all) }
}

enum Made {
    Nothing,
    Parry(Query),
}

impl Made {
    fn run(&self) -> Answer {
        match self {
            Made::Nothing => none("nothing"),
            Made::Parry(query) => query.run(),
        }
    }
}

fn none(outcome: &'static str) -> Answer {
    Answer { outcome, depth: f64::NAN, normal: Vector::NAN }
}

/// None where parry does not take the case, or is not to have it.
fn made(asked: &Asked, case: &Case) -> Option<Made> {
    if asked.without.contains(case.id.as_str()) {
        return None;
    }
    if asked.nothing {
        return Some(Made::Nothing);
    }
    catch_unwind(AssertUnwindSafe(|| Query::new(case))).ok().flatten().map(Made::Parry)
}

fn answers(cases: &[Case], all: &[Asked]) {
    println!("case,solver,outcome,lower,upper,depth,nx,ny,nz");
    for asked in all {
        for case in cases {
            let answer = match made(asked, case) {
                None => none("refused"),
                Some(query) => catch_unwind(AssertUnwindSafe(|| query.run())).unwrap_or(none("exception")),
            };
            let Answer { outcome, depth, normal } = answer;
            let [depth, x, y, z] = [depth, normal.x, normal.y, normal.z].map(number);
            println!("{},{},{outcome},nan,nan,{depth},{x},{y},{z}", case.id, asked.text);
        }
    }
}

/// As C prints it where it is none.
fn number(x: f64) -> String {
    if x.is_nan() { "nan".to_owned() } else { format!("{x:e}") }
}

fn nanoseconds(query: &Made, runs: u32) -> f64 {
    let start = Instant::now();
    for _ in 0..runs {
        black_box(black_box(query).run());
    }
    start.elapsed().as_nanos() as f64 / f64::from(runs)
}

fn times(rounds: usize, cases: &[Case], all: &[Asked]) {
    const BATCH_NS: f64 = 30e3;
    println!("case,solver,ns");
    for case in cases {
        let queries: Vec<_> = all.iter().filter_map(|asked| Some((asked.text, made(asked, case)?))).collect();
        let runs: Vec<_> = queries
            .iter()
            .map(|(_, query)| {
                nanoseconds(query, 2);
                1 + (BATCH_NS / nanoseconds(query, 2)) as u32
            })
            .collect();
        let mut samples = vec![Vec::new(); queries.len()];
        for _ in 0..rounds {
            for (i, (_, query)) in queries.iter().enumerate() {
                samples[i].push(nanoseconds(query, runs[i]));
            }
        }
        for ((text, _), mut sample) in queries.iter().zip(samples) {
            sample.sort_by(f64::total_cmp);
            if let Some(median) = sample.get(sample.len() / 2) {
                println!("{},{text},{median:.1}", case.id);
            }
        }
    }
}

/// What is between two dumps is a number of rounds: the difference of two of them has nothing else in it.
fn count(cases: &[Case], all: &[Asked]) {
    println!("solver,cases");
    for asked in all {
        let queries: Vec<_> = cases.iter().filter_map(|case| made(asked, case)).collect();
        for rounds in [1, 1, 3] {
            callgrind::zero();
            for _ in 0..rounds {
                for query in &queries {
                    black_box(black_box(query).run());
                }
            }
            callgrind::dump();
        }
        println!("{},{}", asked.text, queries.len());
    }
}

fn work(words: &[&str]) -> Result<(), String> {
    match *words {
        ["solvers"] => SOLVERS.iter().for_each(|name| println!("{name}")),
        ["answers", path, ref asked @ ..] => answers(&cases::load(path)?, &all_asked(asked)?),
        ["times", rounds, path, ref asked @ ..] => {
            times(rounds.parse().map_err(|_| USAGE)?, &cases::load(path)?, &all_asked(asked)?)
        }
        ["count", path, ref asked @ ..] => count(&cases::load(path)?, &all_asked(asked)?),
        _ => return Err(USAGE.to_owned()),
    }
    Ok(())
}

fn main() -> ExitCode {
    // A panic of parry is an outcome, and is told as one.
    std::panic::set_hook(Box::new(|_| ()));
    let words: Vec<_> = std::env::args().skip(1).collect();
    match work(&words.iter().map(String::as_str).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("depth_parry: {message}");
            ExitCode::FAILURE
        }
    }
}
