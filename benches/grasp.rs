//! Grasps: what a planner and a controller pay for an answer.
//!
//! `./x bench-grasp OUT=dir [QUICK=1]` prints a table and writes `dir/grasp.csv`: one row per kind of question, number of contacts, norm and
//! tolerance, with the median, 90th percentile and maximum time over random force-closed grasps of soft fingers on a unit ball, and how many
//! such questions are answered in a second. All in `f64`, in one workspace of 512 vertices and 4096 facets.

use qdist::grasp::{
    Contact, Finger, ForceModel, ForceOptions, ForceSolver, HandContact, Jacobian, Layout, Norm, Primitive,
    PyramidalCone, Refined, WrenchSet, default_tolerance, linearized, wrenches,
};
use qdist::qset::Ball;
use qdist::{Answer, Options, Outcome, Vector, Workspace};
use qdist_benches::common::dice::Dice;
use qdist_benches::fingertips::{fingertip, frame};
use std::fmt::Write;
use std::time::Instant;

type Memory = Workspace<f64, 6, 512, 4096>;

/// Contacts and their primitives.
struct Grasp {
    contacts: Vec<Contact<f64>>,
    primitives: Vec<Primitive<f64>>,
}

impl Grasp {
    fn new(contacts: Vec<Contact<f64>>) -> Self {
        let mut memory = vec![Primitive::empty(); contacts.len()];
        let primitives = wrenches(&contacts, &frame(), &mut memory).expect("primitives").to_vec();
        Self { contacts, primitives }
    }

    fn set(&self, norm: Norm) -> WrenchSet<'_, f64> {
        WrenchSet::new(&self.primitives, norm)
    }
}

/// The d of the grasp with cones of this layout, over the exact one: what a tool that linearises them would report.
fn linearised(memory: &mut Memory, grasp: &Grasp, norm: Norm, layout: &Layout<f64>, exact: f64) -> f64 {
    let mut edges = vec![[0.0; 6]; 80 * grasp.contacts.len()];
    let mut cones = vec![PyramidalCone::empty(); grasp.contacts.len()];
    let cones = linearized(&grasp.contacts, &frame(), layout, &mut edges, &mut cones).expect("cones");
    let options = Options { relative: 1e-3, absolute: 1e-6, ..Options::default() };
    memory.solver().solve(&WrenchSet::new(cones, norm), &Ball::unit(), &options).lower.max(0.0) / exact
}

/// Force-closed grasps of so many contacts.
fn grasps(dice: &mut Dice, memory: &mut Memory, contacts: usize, count: usize) -> Vec<Grasp> {
    let mut found = Vec::new();
    while found.len() < count {
        let grasp = Grasp::new((0..contacts).map(|_| fingertip(dice)).collect());
        if memory.solver().force_closure(&grasp.set(Norm::LInf), &Options::default()).is_closed() {
            found.push(grasp);
        }
    }
    found
}

/// Seconds that each of a list of questions takes; every one is asked three times, and the least counts.
fn times<S>(list: &[S], mut ask: impl FnMut(&S)) -> Vec<f64> {
    let mut seconds: Vec<f64> = Vec::new();
    for item in list {
        let once = || {
            let start = Instant::now();
            ask(item);
            start.elapsed().as_secs_f64()
        };
        seconds.push(std::iter::repeat_with(once).take(3).fold(f64::MAX, f64::min));
    }
    seconds.sort_by(f64::total_cmp);
    seconds
}

/// Three fingers of so many contacts, whose four joints have torque limits that bind.
fn hand(dice: &mut Dice, contacts: usize) -> Vec<Finger<f64>> {
    let mut fingers = Vec::new();
    while fingers.len() < 3 {
        let contact = |dice: &mut Dice| {
            let rows: Vec<[f64; 4]> = (0..4).map(|_| std::array::from_fn(|_| dice.signed())).collect();
            let jacobian = Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).expect("a Jacobian");
            HandContact { contact: fingertip(dice), jacobian: Some(jacobian) }
        };
        let list: Vec<_> = (0..contacts).map(|_| contact(dice)).collect();
        let finger = Finger::new(&list, &[0.3; 4], ForceModel::Passive, &frame(), default_tolerance());
        fingers.extend(finger);
    }
    fingers
}

struct Report {
    csv: String,
}

impl Report {
    fn row(&mut self, question: &str, contacts: usize, norm: Norm, relative: f64, seconds: &[f64]) -> f64 {
        let n = seconds.len();
        let [median, p90, most] = [n / 2, n * 9 / 10, n - 1].map(|i| seconds[i] * 1e3);
        let rate = n as f64 / seconds.iter().sum::<f64>();
        let norm = if norm == Norm::L1 { "L1" } else { "Linf" };
        println!(
            "{question:<14} {contacts:>3} {norm:<5} {relative:>7.0e} {median:>9.4} {p90:>9.4} {most:>9.3} {rate:>9.0}"
        );
        let _ = writeln!(self.csv, "{question},{contacts},{norm},{relative:e},{n},{median},{p90},{most},{rate}");
        median
    }
}

fn main() -> std::process::ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let quick = arguments.iter().any(|a| a == "--quick");
    let out = arguments.iter().find(|a| !a.starts_with("--")).cloned().unwrap_or("out/grasp".into());
    let count = if quick { 8 } else { 100 };
    let mut dice = Dice::new(2013);
    let mut memory = Box::new(Memory::new());
    let mut report =
        Report { csv: "question,contacts,norm,relative,grasps,median_ms,p90_ms,max_ms,per_second\n".into() };
    println!(
        "{:<14} {:>3} {:<5} {:>7} {:>9} {:>9} {:>9} {:>9}",
        "question", "m", "norm", "rel", "median ms", "p90 ms", "max ms", "per s"
    );
    let mut bars = Vec::new();
    let mut theirs =
        [Layout::Inscribed { sides: 8 }, Layout::GraspIt { millimetre: 0.01 }, Layout::Inscribed { sides: 64 }]
            .map(|layout| (layout, Vec::new()));
    for contacts in [2, 3, 4, 5, 8] {
        let list = grasps(&mut dice, &mut memory, contacts, count);
        for norm in [Norm::L1, Norm::LInf] {
            let seconds = times(&list, |g| {
                memory.solver().force_closure(&g.set(norm), &Options::default());
            });
            report.row("closed?", contacts, norm, 0.0, &seconds);
            for relative in [1e-2, 1e-3, 1e-4] {
                let options = Options { relative, ..Options::default() };
                let mut open = 0;
                let seconds = times(&list, |g| {
                    let answer = memory.solver().solve(&g.set(norm), &Ball::unit(), &options);
                    open += usize::from(answer.outcome != Outcome::Converged);
                });
                assert_eq!(open, 0, "queries that did not converge");
                let median = report.row("efficiency", contacts, norm, relative, &seconds);
                match (contacts, norm, relative) {
                    (5, Norm::LInf, 1e-2) => bars.push(("five soft contacts, Linf, 1 %", median, 2.0)),
                    (5, Norm::LInf, 1e-3) => bars.push(("five soft contacts, Linf, 0.1 %", median, 20.0)),
                    _ => {}
                }
            }
            let coarse = Options { relative: 1e-2, ..Options::default() };
            let answers: Vec<_> =
                list.iter().map(|g| memory.solver().solve(&g.set(norm), &Ball::unit(), &coarse)).collect();
            let pairs: Vec<_> = list.iter().zip(&answers).collect();
            let seconds = times(&pairs, |(g, answer)| {
                let refined = Refined::new(&g.set(norm), &Ball::unit(), answer);
                for (index, contact) in g.contacts.iter().enumerate() {
                    let hand = HandContact { contact: *contact, jacobian: None };
                    let _ = refined.gradient(index, &hand, &frame(), default_tolerance());
                }
            });
            report.row("gradients", contacts, norm, 1e-2, &seconds);
            for relative in [1e-3, 1e-6, 1e-9] {
                let options = ForceOptions { relative, ..ForceOptions::default() };
                let mut shares = vec![Vector::zeros(); contacts];
                let load = Vector::from([0.0, 0.0, -0.1, 0.01, 0.0, 0.02]);
                let seconds = times(&list, |g| {
                    let _ = ForceSolver::new().resist(&g.set(norm), &load, &options, &mut shares);
                });
                report.row("forces", contacts, norm, relative, &seconds);
            }
            for (layout, shares) in &mut theirs {
                if contacts <= 5 {
                    let ratio = |(g, a): &(&Grasp, &Answer<f64, 6>)| linearised(&mut memory, g, norm, layout, a.upper);
                    let mut ratios: Vec<f64> = pairs.iter().take(20).map(ratio).collect();
                    ratios.sort_by(f64::total_cmp);
                    shares.push((contacts, norm, ratios[ratios.len() / 2], ratios[0]));
                }
            }
            for relative in [1e-2, 1e-3] {
                let options = Options { relative, ..Options::default() };
                let seconds = times(&[&list], |list| {
                    let sets = list.iter().map(|g| g.set(norm));
                    memory.solver().best_of(sets, &Ball::unit(), &options);
                });
                let each = vec![seconds[0] / count as f64; count];
                report.row("best of all", contacts, norm, relative, &each);
            }
        }
    }
    for contacts in [1, 2] {
        let hands: Vec<Vec<Finger<f64>>> = (0..count.min(20)).map(|_| hand(&mut dice, contacts)).collect();
        for relative in [1e-2, 1e-3] {
            let options = Options { relative, max_iterations: Some(2000), ..Options::default() };
            let seconds = times(&hands, |fingers| {
                memory.solver().solve(&WrenchSet::new(fingers, Norm::LInf), &Ball::unit(), &options);
            });
            report.row(&format!("limits k={contacts}"), 3 * contacts, Norm::LInf, relative, &seconds);
        }
    }
    println!("\nd with linearised cones over the exact d: median (least) of 20 grasps; soft contacts, L1 and Linf");
    for (layout, shares) in &theirs {
        print!("{:<34}", format!("{layout:?}"));
        for (contacts, norm, median, least) in shares {
            print!("  {contacts}{} {median:.2} ({least:.2})", if *norm == Norm::L1 { "" } else { "∞" });
        }
        println!();
    }
    println!();
    for (what, median, bar) in &bars {
        println!("{what}: {median:.3} ms, bar {bar} ms: {}", if median <= bar { "met" } else { "MISSED" });
    }
    let path = std::path::Path::new(&out).join("grasp.csv");
    match std::fs::create_dir_all(&out).and_then(|()| std::fs::write(&path, &report.csv)) {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{}: {error}", path.display());
            std::process::ExitCode::FAILURE
        }
    }
}
