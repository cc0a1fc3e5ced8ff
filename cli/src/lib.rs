//! What the program `qdist` is made of: one module a subcommand, and in it what benches use as well, its reader, its question and its table.
//!
//! A subcommand is a `Request`, which clap fills from the command line and whose comments are its `--help`, and a function `run`, whose error is what
//! is wrong, in words.

pub mod depth;
mod flags;
pub mod grasp;
pub mod haptic;
mod json;
pub mod mesh;
mod text;

use std::io;
use std::path::Path;

/// What is wrong, in words.
pub type Trouble = String;

/// The reader of the output went away: that is how `| head` ends, and no trouble.
pub const CLOSED: &str = "";

const OUTPUT: &str = "standard output";

/// An answer that is not in its reference's bracket is trouble, whoever is right.
pub fn agree(contradictions: usize) -> Result<(), Trouble> {
    match contradictions {
        0 => Ok(()),
        1 => Err("1 bracket contradicts its reference".into()),
        n => Err(format!("{n} brackets contradict their references")),
    }
}

/// What went wrong with the standard output.
pub fn written(error: io::Error) -> Trouble {
    if error.kind() == io::ErrorKind::BrokenPipe { CLOSED.into() } else { format!("{OUTPUT}: {error}") }
}

/// What is wrong with a file, or with what was made of it; what is wrong with the standard output is no file's.
pub fn named(file: &Path, trouble: Trouble) -> Trouble {
    if trouble == CLOSED || trouble.starts_with(OUTPUT) { trouble } else { format!("{}: {trouble}", file.display()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn troubles_of_the_output_are_no_files() {
        let file = Path::new("a.json");
        let output = |kind: io::ErrorKind| named(file, written(kind.into()));
        assert_eq!(output(io::ErrorKind::BrokenPipe), CLOSED);
        assert!(output(io::ErrorKind::StorageFull).starts_with("standard output: "));
        assert_eq!(named(file, "empty".into()), "a.json: empty");
    }

    /// Numbers of JSON files are those that Rust reads, to the last bit. (Run alone, too: `cargo test -p qdist-cli`; what other packages ask of
    /// serde_json counts for all that is built with them.)
    #[test]
    fn numbers_are_read_to_the_last_bit() {
        let mut state = 1u64;
        for _ in 0..1000 {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            let text = format!("{:?}", f64::from_bits(0x3fb0_0000_0000_0000 | (state >> 12)));
            assert_eq!(serde_json::from_str::<f64>(&text).unwrap().to_bits(), text.parse::<f64>().unwrap().to_bits());
        }
    }
}
