//! The generalized penetration depth of meshes: quality, time, and the bars.
//!
//! ```text
//! ./x bench-pdg OUT=dir [QUICK=1]
//! cargo bench -p qdist-benches --bench pdg -- [--quick] [--fcl PROGRAM] [--triangles LIBRARY=PROGRAM]... [DIR]
//! ```
//!
//! One thread. Cold queries of the shared set, or of meshes made by code where it is not there, with every effort and with the paper's variants:
//! unions of constraints, sampling, and the K nearest contact samples as seeds. The tracker along paths; the solid test and the distance against
//! FCL's on the same poses; the deepest pair of triangles by other libraries. Writes `pdg.csv`, `warm.csv`, `proximity.csv`, `triangles.csv` and a
//! picture of error against time per metric.

mod bars;
mod measure;
mod peers;
mod plot;
mod report;
mod scenes;
mod warm;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn Error>> {
    let (mut quick, mut fcl, mut folder) = (false, None, PathBuf::from("out/pdg"));
    let mut triangles = Vec::new();
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--quick" => quick = true,
            "--fcl" => fcl = arguments.next().map(PathBuf::from),
            "--triangles" => {
                let asked = arguments.next().unwrap_or_default();
                let (library, program) = asked.split_once('=').ok_or("--triangles takes LIBRARY=PROGRAM")?;
                triangles.push((library.to_string(), PathBuf::from(program)));
            }
            // cargo bench says `--bench`.
            _ if argument.starts_with('-') => {}
            _ => folder = argument.into(),
        }
    }
    std::fs::create_dir_all(&folder)?;
    let begin = Instant::now();
    let scenes = scenes::Scenes::new(quick)?;
    if !scenes.shared {
        println!(
            "../shared/data/meshes is not there: these are meshes made by code, and the best known is the best of this run"
        );
    }
    let (repetitions, enough, rounds) = if quick { (1, 100, 5) } else { (9, 500, 15) };
    let cold = measure::cold(&scenes, repetitions, Duration::from_millis(enough));
    std::fs::write(folder.join("pdg.csv"), report::csv(&cold))?;
    plot::all(&cold, &scenes.benchmarks, &folder)?;
    let warm = warm::all(&scenes, if quick { 800 } else { 8000 });
    std::fs::write(folder.join("warm.csv"), warm::csv(&warm))?;
    let compare = |program: &Path| peers::compare(&scenes, &cold, program, &folder, rounds);
    let compared = fcl.as_deref().map(compare).transpose()?;
    if let Some(compared) = &compared {
        std::fs::write(folder.join("proximity.csv"), report::proximity_csv(compared))?;
    }
    if !triangles.is_empty() {
        let deepest = peers::deepest(&scenes, &cold, &triangles, &folder, rounds)?;
        std::fs::write(folder.join("triangles.csv"), report::triangles_csv(&deepest))?;
    }
    println!("\nError against time\n{}", report::curve(&cold));
    println!("Bars, default effort\n{}", bars::summary(&scenes, &cold, &warm, compared.as_deref()));
    match report::beaten(&cold) {
        better if better.is_empty() => {}
        better => println!("better than the best known: {better}"),
    }
    println!("{} rows in {} s; results are in {}", cold.len(), begin.elapsed().as_secs(), folder.display());
    Ok(())
}
