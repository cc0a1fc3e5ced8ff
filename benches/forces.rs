//! Contact forces of least size: error against time, beside Clarabel, an interior point solver of cone programs.
//!
//! `cargo bench -p qdist-benches --bench forces -- [--quick] OUT` writes `OUT/forces.csv`: a row for every number of contacts, norm, solver and tolerance, over
//! random force-closed grasps of soft fingers. The error is that of the size, relative to what Clarabel says at its finest; the residual how far the forces are
//! from equilibrium, of the wrench. Times
//! begin with the contacts: what is made of them for every new grasp, primitives or a program, is in them.

use clarabel::solver::DefaultSettings;
use qdist::grasp::{Contact, ForceOptions, ForceSolver, Norm, Primitive, WrenchSet, wrenches};
use qdist::{Options, Vector, Workspace};
use qdist_benches::common::dice::Dice;
use qdist_benches::fingertips::{fingertip, frame};
use qdist_benches::grasp_common::socp::LeastForces;
use std::error::Error;
use std::fmt::Write;
use std::time::Instant;

const OURS: [f64; 7] = [0.3, 1e-1, 1e-2, 1e-3, 1e-6, 1e-9, 1e-11];
const THEIRS: [f64; 5] = [1e-1, 1e-2, 1e-4, 1e-8, 1e-10];
const ROUNDS: usize = 5;

struct Grasp {
    contacts: Vec<Contact<f64>>,
    load: Vector<f64, 6>,
}

fn grasps(dice: &mut Dice, contacts: usize, count: usize) -> Vec<Grasp> {
    let mut memory = Box::new(Workspace::<f64, 6, 64, 512>::new());
    let mut found = Vec::new();
    while found.len() < count {
        let contacts: Vec<_> = (0..contacts).map(|_| fingertip(dice)).collect();
        let mut primitives = vec![Primitive::empty(); contacts.len()];
        wrenches(&contacts, &frame(), &mut primitives).expect("primitives");
        if memory.solver().force_closure(&WrenchSet::new(&primitives, Norm::LInf), &Options::default()).is_closed() {
            let load = Vector::from(dice.direction::<6>());
            found.push(Grasp { contacts, load });
        }
    }
    found
}

/// Size, residual and nanoseconds of one search.
type Said = (f64, f64, f64);

fn ours(grasp: &Grasp, norm: Norm, relative: f64) -> Said {
    let options = ForceOptions { relative, ..ForceOptions::default() };
    let mut shares = vec![Vector::zeros(); grasp.contacts.len()];
    let mut primitives = vec![Primitive::empty(); grasp.contacts.len()];
    let begin = Instant::now();
    let primitives = wrenches(&grasp.contacts, &frame(), &mut primitives).expect("primitives");
    let forces = ForceSolver::new().resist(&WrenchSet::new(primitives, norm), &grasp.load, &options, &mut shares);
    let ns = begin.elapsed().as_nanos() as f64;
    let forces = forces.expect("forces");
    (forces.upper, forces.residual, ns)
}

fn theirs(grasp: &Grasp, norm: Norm, tolerance: f64) -> Said {
    let mut settings = DefaultSettings::<f64> { verbose: false, ..DefaultSettings::default() };
    (settings.tol_gap_abs, settings.tol_gap_rel, settings.tol_feas) = (tolerance, tolerance, tolerance);
    let begin = Instant::now();
    let program = LeastForces::new(&grasp.contacts, &frame(), norm, &grasp.load);
    let solver = program.solved(settings);
    let ns = begin.elapsed().as_nanos() as f64;
    let x = &solver.solution.x;
    (x[0] * program.unit, program.residual(x) * program.unit, ns)
}

/// All tolerances of both, one after the other in every round: what disturbs one disturbs all. The least time counts.
fn measured(grasp: &Grasp, norm: Norm) -> Vec<Said> {
    let round = || -> Vec<Said> {
        let mine = OURS.iter().map(|&relative| ours(grasp, norm, relative));
        mine.chain(THEIRS.iter().map(|&tolerance| theirs(grasp, norm, tolerance))).collect()
    };
    let rounds: Vec<_> = (0..ROUNDS).map(|_| round()).collect();
    let least = |at: usize| rounds.iter().map(|round| round[at].2).fold(f64::MAX, f64::min);
    rounds[0].iter().enumerate().map(|(at, said)| (said.0, said.1, least(at))).collect()
}

fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list[list.len() / 2]
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let count = if arguments.iter().any(|a| a == "--quick") { 12 } else { 60 };
    let out = arguments.iter().find(|a| !a.starts_with("--")).cloned().unwrap_or("out/forces".into());
    let mut csv = String::from("contacts,norm,solver,tolerance,grasps,failed,median_error,median_residual,median_ns\n");
    let mut dice = Dice::new(2014);
    for contacts in [2, 3, 4, 5, 8] {
        let list = grasps(&mut dice, contacts, count);
        for norm in [Norm::L1, Norm::LInf] {
            let truth: Vec<f64> = list.iter().map(|grasp| theirs(grasp, norm, 1e-13).0).collect();
            let said: Vec<_> = list.iter().map(|grasp| measured(grasp, norm)).collect();
            let names = OURS.iter().map(|t| ("qdist", t)).chain(THEIRS.iter().map(|t| ("Clarabel", t)));
            for (at, (solver, tolerance)) in names.enumerate() {
                let errors: Vec<_> = said.iter().zip(&truth).map(|(all, t)| (all[at].0 - t).abs() / t).collect();
                let failed = errors.iter().filter(|e| !(**e < 1.0)).count();
                let [residual, ns] =
                    [|s: &Said| s.1, |s: &Said| s.2].map(|of| median(said.iter().map(|all| of(&all[at])).collect()));
                let norm = if norm == Norm::L1 { "L1" } else { "Linf" };
                let error = median(errors);
                writeln!(
                    csv,
                    "{contacts},{norm},{solver},{tolerance:e},{count},{failed},{error:e},{residual:e},{ns:.0}"
                )?;
            }
        }
    }
    std::fs::create_dir_all(&out)?;
    std::fs::write(std::path::Path::new(&out).join("forces.csv"), &csv)?;
    print!("{csv}");
    Ok(())
}
