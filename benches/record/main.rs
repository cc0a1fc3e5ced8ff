//! Every answer to the last bit: what a change of the code must not change.
//!
//! ```text
//! ./x record OUT=before            ... change the code ...            ./x record OUT=after && ./x record-compare A=before B=after
//! cargo run --release -p qdist-benches --example record -- OUT [--part convex|grasps|meshes]
//! ```
//!
//! Writes `OUT/convex.txt`, `OUT/grasps.txt` and `OUT/meshes.txt`, a line an answer: what was asked, the scalar, how it ended, and the bits of the
//! bracket and of the direction, points or pose that prove it. What is asked are the files of `tests/data`, and those of `../shared/data` where they
//! are. Limits are counted in work, never in time, so that two runs of one program are the same.

mod convex;
mod grasps;
mod line;
mod meshes;

use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

use line::Record;

/// A part: its name, and what writes it.
type Part = (&'static str, fn(&mut Record) -> Result<(), Box<dyn Error>>);

const PARTS: [Part; 3] = [("convex", convex::all), ("grasps", grasps::all), ("meshes", meshes::all)];

/// The files of a folder of the project or beside it, in order; none where it is not there.
fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder);
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut files: Vec<_> = entries.filter(|file| file.extension().is_some_and(|e| e == ending)).collect();
    files.sort();
    files
}

fn main() -> Result<(), Box<dyn Error>> {
    let (mut only, mut folder) = (None, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--part" => only = Some(arguments.next().ok_or("--part takes convex, grasps or meshes")?),
            _ => folder = Some(PathBuf::from(argument)),
        }
    }
    let folder = folder.ok_or("usage: record OUT [--part convex|grasps|meshes]")?;
    if only.as_ref().is_some_and(|only| PARTS.iter().all(|(name, _)| name != only)) {
        return Err("--part takes convex, grasps or meshes".into());
    }
    std::fs::create_dir_all(&folder)?;
    for (name, write) in PARTS {
        if only.as_ref().is_some_and(|only| only != name) {
            continue;
        }
        let begin = Instant::now();
        let file = folder.join(format!("{name}.txt"));
        let mut record = Record::new(&file)?;
        write(&mut record)?;
        println!("{}: {} lines in {} s", file.display(), record.end()?, begin.elapsed().as_secs());
    }
    Ok(())
}
