//! d_Q in up to six dimensions: time, memory and width of the bracket, against plain expansion and the paper's
//! bookkeeping.
//!
//! `./x bench-dq OUT=dir [QUICK=1]` writes `dir/dq.csv`, `dir/fit.csv`, `dir/anytime.csv` and one picture a case, and
//! compares with the bars the project has set itself.
//!
//! A suffix of a case's name says what was run: nothing for the solver, `/expand`, `/scan`, `/scan_sorted`. `eps` is
//! absolute; relative for the cases `random_*`.
//!
//! Every case is run on a ladder of tolerances and capacities. Left out are the runs that could tell nothing new:
//! * more memory, where less was not half full;
//! * a smaller eps in the same memory, after a run ended for want of memory or of digits (it would be that run again);
//! * a smaller eps, after a run took longer than [`Effort::patience`];
//! * plain expansion with less than 8192 facets; the paper's bookkeeping for bodies (their ball term would be
//!   its worst case), for more than four contacts, and in `f32`;
//! * `f32` below 1e-4, which it does not resolve in six dimensions.

mod anytime;
mod bars;
mod cases;
mod contacts;
mod methods;
mod plot;
mod report;
mod scan_and_match;

use cases::Case;
use methods::{Method, Tolerance};
use nalgebra::{Const, DimMin};
use qdist::MAX_CAPACITY;
use qdist::{Outcome, Real};
use report::Row;
use scan_and_match::Matching;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How much is measured.
struct Effort {
    eps: &'static [f64],
    capacities: &'static [usize],
    /// Repetitions of one run.
    sample: Duration,
    /// No smaller eps after a run of this length.
    patience: Duration,
    /// A run of the baseline is cut off after this, and nothing optional is begun once the bench has taken `budget`.
    limit: Duration,
    budget: Duration,
}

const FULL: Effort = Effort {
    eps: &[1e-2, 1e-3, 1e-4, 1e-5, 1e-6],
    capacities: &[512, 1024, 2048, 4096, 8192],
    sample: Duration::from_millis(100),
    patience: Duration::from_millis(100),
    limit: Duration::from_secs(20),
    budget: Duration::from_secs(300),
};

const QUICK: Effort = Effort {
    eps: &[1e-2, 1e-3, 1e-4],
    capacities: &[512, 2048, 4096],
    sample: Duration::from_millis(30),
    patience: Duration::from_millis(100),
    limit: Duration::from_secs(2),
    budget: Duration::from_secs(12),
};

/// Rows so far, and what they cost.
struct Bench {
    effort: Effort,
    begin: Instant,
    rows: Vec<Row>,
    late: Vec<String>,
}

impl Bench {
    fn push(&mut self, row: Row) {
        println!("{}", row.line());
        self.rows.push(row);
    }

    /// Is a smaller eps in the same memory worth a run?
    fn goes_on(&self, row: &Row) -> bool {
        row.outcome == Outcome::Converged && row.median < self.effort.patience.as_secs_f64() * 1e9
    }

    /// Is there time for these runs?
    fn in_time(&mut self, what: String) -> bool {
        let in_time = self.begin.elapsed() < self.effort.budget;
        if !in_time {
            self.late.push(what);
        }
        in_time
    }

    /// Tolerances down to `finest`, in each of these capacities.
    fn ladder<T: Real, const N: usize>(&mut self, case: &Case<N>, method: Method, finest: f64, capacities: &[usize]) {
        let mut settled: Vec<f64> = Vec::new();
        for &capacity in capacities {
            if !self.in_time(format!("{}{} with {capacity} facets", case.name, method.suffix())) {
                return;
            }
            for &eps in self.effort.eps.iter().filter(|&&eps| eps >= finest) {
                if settled.contains(&eps) {
                    continue;
                }
                let row = methods::run::<T, N>(case, method, Tolerance::Absolute(eps), capacity, self.effort.sample);
                if row.spare && row.converged() {
                    settled.push(eps);
                }
                let goes_on = self.goes_on(&row);
                self.push(row);
                if !goes_on {
                    break;
                }
            }
        }
    }

    fn qdist<T: Real, const N: usize>(&mut self, case: &Case<N>, finest: f64) {
        self.ladder::<T, N>(case, Method::Qdist, finest, self.effort.capacities);
    }

    fn expand<const N: usize>(&mut self, case: &Case<N>) {
        self.ladder::<f64, N>(case, Method::Expand, 0.0, &[8192, MAX_CAPACITY]);
    }

    fn scan<const N: usize>(&mut self, case: &Case<N>, matching: Matching)
    where
        Const<N>: DimMin<Const<N>, Output = Const<N>>,
    {
        if !self.in_time(format!("{}{}", case.name, Method::Scan(matching).suffix())) {
            return;
        }
        for &eps in self.effort.eps {
            let row = methods::scan(case, matching, Tolerance::Absolute(eps), self.effort.sample, self.effort.limit);
            let goes_on = self.goes_on(&row);
            self.push(row);
            if !goes_on {
                break;
            }
        }
    }

    fn baselines(&mut self, case: &Case<6>) {
        self.scan(case, Matching::Pairs);
        self.scan(case, Matching::Sorted);
        self.expand(case);
    }

    fn solids<const N: usize>(&mut self) {
        for case in &cases::solids::<N>() {
            self.qdist::<f64, N>(case, 0.0);
            if matches!(case.a, cases::Set::Ellipsoid(_)) {
                self.qdist::<f32, N>(case, 1e-4);
            }
        }
    }
}

/// Most facets of the workspace of 64 KB.
fn small() -> usize {
    methods::facets_within::<f64, 6>(1 << 16, 512)
}

fn measure(bench: &mut Bench) {
    // What the bars ask for comes first: a slow machine then lacks the least.
    let (space, plane) = (cases::table_in_space(), cases::table_in_the_plane());
    let (recorded, made_up) = (cases::recorded(), cases::made_up());
    plane.iter().for_each(|case| bench.qdist::<f64, 3>(case, 0.0));
    space.iter().for_each(|case| bench.qdist::<f64, 6>(case, 0.0));
    if small() != 512 {
        bench.ladder::<f64, 6>(&space[0], Method::Qdist, 1e-4, &[small()]);
    }
    recorded.iter().for_each(|case| bench.qdist::<f64, 6>(case, 0.0));
    for case in cases::random(40) {
        let row =
            methods::run::<f64, 6>(&case, Method::Qdist, Tolerance::Relative(1e-3), 4096, bench.effort.sample / 5);
        bench.push(row);
    }
    let regular = [3, 4].map(cases::regular);
    regular.iter().for_each(|case| bench.qdist::<f64, 6>(case, 0.0));
    for case in space.iter().chain(recorded.iter().filter(|c| c.name.starts_with("soft"))) {
        bench.baselines(case);
    }
    plane.iter().for_each(|case| bench.scan(case, Matching::Pairs));
    plane.iter().for_each(|case| bench.expand(case));
    made_up.iter().for_each(|case| bench.qdist::<f64, 6>(case, 0.0));
    [&space[0], &space[2], &space[3]].into_iter().for_each(|case| bench.qdist::<f32, 6>(case, 1e-4));
    bench.solids::<2>();
    bench.solids::<3>();
    bench.solids::<4>();
    bench.solids::<5>();
    bench.solids::<6>();
    for case in made_up.iter().filter(|c| c.name == "soft3").chain(&regular[..1]) {
        bench.baselines(case);
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let quick = std::env::args().any(|a| a == "--quick");
    let folder = std::env::args().skip(1).find(|a| !a.starts_with('-'));
    let folder = PathBuf::from(folder.unwrap_or_else(|| "out/dq".into()));
    std::fs::create_dir_all(&folder)?;
    let effort = if quick { QUICK } else { FULL };
    let mut bench = Bench { effort, begin: Instant::now(), rows: Vec::new(), late: Vec::new() };
    measure(&mut bench);
    std::fs::write(folder.join("dq.csv"), report::table(&bench.rows))?;
    std::fs::write(folder.join("anytime.csv"), anytime::table(bench.effort.sample / 5, bench.effort.patience / 2))?;
    let fits = report::fits(&bench.rows);
    std::fs::write(folder.join("fit.csv"), &fits)?;
    let pictures = plot::all(&bench.rows, &folder)?;
    println!(
        "\nExponents against K\n{fits}\nBars (absolute 1e-4 unless said)\n{}",
        bars::summary(&bench.rows, small())
    );
    if !bench.late.is_empty() {
        println!("not begun, for want of time: {}", bench.late.join("; "));
    }
    let (rows, time) = (bench.rows.len(), bench.begin.elapsed().as_secs());
    println!(
        "{rows} rows in {time} s; dq.csv, fit.csv, anytime.csv and {pictures} pictures are in {}",
        folder.display()
    );
    Ok(())
}
