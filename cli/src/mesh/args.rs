//! The command line.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use qdist::mesh::certificate::Effort;
use qdist::nalgebra::Isometry3;

use crate::flags;
use crate::mesh::input::{self, Kind};

/// Where the table's three pairs are, from the project's root.
const SHARED: &str = "../shared/data/meshes/queries.json";

/// What a file looks like; the end of `--help`.
const FILES: &str = r#"The least that a file of queries must say:

  {"queries": [{"id": "corner", "A": "box.obj", "B": "bracket.obj", "pose0": {"q_wxyz": [1, 0, 0, 0], "t": [0.8, 0.9, 0.5]}}]}

`A` and `B` are relative to the file. A name that begins with _ is a note, any field that is not known an error. What is known of the answer may be there, too, and is compared: `disp_ub`, `sqrt_sigma_ub` (or its square,
`sigma_ub`) the best values known, `disp_lb`, `sqrt_sigma_lb` lower bounds, `exact_disp`, `exact_sqrt_sigma` the truth."#;

/// How little must A move, rotations included, to be free of B?
///
/// Asks the queries of a file, or poses of two mesh files (OBJ, STL, PLY, OFF), and prints a table beside the file's references, or with --csv one
/// line for every query and metric. Lengths are those of the files; for sigma they are roots of the object norm. `lower` and `upper` bracket the
/// depth, and the pose (x_B = R x_A + t) proves `upper`.
#[derive(Args, Clone, Debug, PartialEq)]
#[command(after_help = FILES, override_usage = "\
qdist mesh --queries FILE.json [OPTIONS]
       qdist mesh A B [--pose qw,qx,qy,qz,tx,ty,tz]... [OPTIONS]
       qdist mesh --table1 [--queries FILE.json] [OPTIONS]")]
pub struct Request {
    /// Two mesh files; without a pose: what is wrong with them, and where
    #[arg(value_names = ["A", "B"], num_args = 2, required_unless_present_any = ["queries", "table1"])]
    #[arg(conflicts_with_all = ["queries", "table1"])]
    meshes: Vec<PathBuf>,
    /// The queries of a file, of which more is told below
    #[arg(long, value_name = "FILE.json")]
    queries: Option<PathBuf>,
    /// The paper's Table I beside ours; of ../shared/data/meshes, which is no part of the project, unless --queries says otherwise
    #[arg(long)]
    table1: bool,
    /// Where A is in the frame of B, x_B = R x_A + t, |q| = 1 within 1e-3; as often as you like
    #[arg(long = "pose", value_name = "qw,qx,qy,qz,tx,ty,tz", value_parser = pose, allow_hyphen_values = true)]
    #[arg(requires = "meshes", conflicts_with_all = ["queries", "table1"])]
    poses: Vec<Isometry3<f64>>,
    /// What is measured; without it both, with disp's pose as a seed of sigma
    #[arg(long)]
    metric: Option<Kind>,
    /// How long to search
    #[arg(long, default_value = "default")]
    effort: Level,
    /// Number of the random sequence
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true)]
    pub seed: u64,
    /// Draw N contact samples of every pair first, a million at most; the 6 nearest to a query are seeds too
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = flags::count::<0, 1_000_000>)]
    #[arg(allow_negative_numbers = true)]
    pub samples: u32,
    /// Nothing but CSV on the standard output
    #[arg(long)]
    pub csv: bool,
    /// DIR/QUERY_METRIC.svg: before, on the way, after
    #[arg(long, value_name = "DIR")]
    pub picture: Option<PathBuf>,
}

/// [`Effort`] by name.
#[derive(Clone, Copy, Debug, PartialEq, ValueEnum)]
enum Level {
    Fast,
    Default,
    Heavy,
}

/// What is asked about.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    File(PathBuf),
    Pair([PathBuf; 2], Vec<Isometry3<f64>>),
    Table1(PathBuf),
}

impl Request {
    pub fn source(&self) -> Source {
        match (self.meshes.as_slice(), &self.queries, self.table1) {
            ([a, b], ..) => Source::Pair([a.clone(), b.clone()], self.poses.clone()),
            (_, Some(file), false) => Source::File(file.clone()),
            (_, file, _) => Source::Table1(file.clone().unwrap_or(SHARED.into())),
        }
    }

    pub fn kinds(&self) -> &[Kind] {
        self.metric.as_ref().map_or(&Kind::BOTH, std::slice::from_ref)
    }

    pub fn effort(&self) -> Effort {
        match self.effort {
            Level::Fast => Effort::Fast,
            Level::Default => Effort::Default,
            Level::Heavy => Effort::Heavy,
        }
    }
}

fn pose(text: &str) -> Result<Isometry3<f64>, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    let Some(&[w, x, y, z, tx, ty, tz]) = numbers.as_deref() else {
        return Err("not 7 numbers qw,qx,qy,qz,tx,ty,tz".into());
    };
    input::pose([w, x, y, z], [tx, ty, tz]).map_err(str::to_string)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Request, clap::Error> {
        flags::parse(line)
    }

    #[test]
    fn what_may_be_asked() {
        let request =
            parse("--queries q.json --metric sigma --effort heavy --csv --seed 7 --samples 50 --picture out").unwrap();
        assert_eq!(request.source(), Source::File("q.json".into()));
        assert_eq!((request.kinds(), request.effort()), (&[Kind::Sigma][..], Effort::Heavy));
        assert_eq!((request.csv, request.seed, request.samples), (true, 7, 50));
        assert_eq!(request.picture, Some("out".into()));

        let request = parse("a.obj b.stl --pose 0,-1,0,0,1,2,3 --pose -1,0,0,0,0,0,0").unwrap();
        let Source::Pair(files, poses) = request.source() else { panic!() };
        assert_eq!(files, [PathBuf::from("a.obj"), PathBuf::from("b.stl")]);
        assert_eq!((poses.len(), poses[0].translation.vector.z), (2, 3.0));
        assert_eq!(request.kinds(), Kind::BOTH);
        assert_eq!(parse("--table1").unwrap().source(), Source::Table1(SHARED.into()));
        assert_eq!(parse("--table1 --queries q").unwrap().source(), Source::Table1("q".into()));
    }

    #[test]
    fn what_may_not() {
        for line in [
            "",
            "a.obj",
            "a b c",
            "--queries",
            "--queries q a b",
            "--pose 1,0,0,0,0,0,0",
            "a b --pose 1,0,0,0,0,0",
            "a b --pose 2,0,0,0,0,0,0",
            "a b --pose 1,0,0,0,0,nan,0",
            "--queries q --metric l2",
            "--queries q --effort",
            "--queries q --seed -1",
            "--queries q --samples many",
            "--queries q --what",
            "--table1 a b",
            "--queries q --pose 1,0,0,0,0,0,0",
        ] {
            assert!(parse(line).is_err(), "{line}");
        }
        assert!(parse("--queries q --metric l2").unwrap_err().to_string().contains("--metric"));
        for flag in ["seed", "samples"] {
            let numbers = ["nan", "inf", "-1", "0.5", "99999999999999999999", "x"];
            flags::refuses::<Request>("--queries q", flag, &numbers);
        }
        flags::refuses::<Request>("--queries q", "samples", &["1000001", "1e7", "1e9"]);
        assert_eq!(parse("--queries q --samples 1e5").unwrap().samples, 100_000);
    }
}
