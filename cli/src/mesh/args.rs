//! The command line.

use std::path::PathBuf;

use qdist::mesh::Effort;
use qdist::nalgebra::Isometry3;

use crate::input::{self, Kind};

pub const USAGE: &str = "\
usage: pdg --queries FILE.json [options]                          the queries of a file (format: head of cli/src/mesh/input.rs)
       pdg A B --pose qw,qx,qy,qz,tx,ty,tz [--pose ...] [options]  two mesh files (OBJ, STL, PLY, OFF); without a pose, what is wrong with them;
                                                                  x_B = R x_A + t, |q| = 1 within 1e-3
       pdg --table1 [--queries FILE.json] [options]               the paper's Table I beside ours
options:
  --metric disp|sigma          the largest displacement, or the root mean square one (the root of the object norm); else both,
                               with DISP's pose as a seed of the other
  --effort fast|default|heavy  how long to search
  --seed N                     number of the random sequence, 0 otherwise
  --samples N                  draw N contact samples of every pair first; the 6 nearest to a query are seeds too
  --help                       this text
  --csv                        nothing but CSV on the standard output
  --picture DIR                DIR/QUERY_METRIC.svg: before, on the way, after";

/// Where the table's three pairs are, from the project's root.
const SHARED: &str = "../shared/data/meshes/queries.json";

/// What is asked about.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    File(PathBuf),
    Pair([PathBuf; 2], Vec<Isometry3<f64>>),
    Table1(PathBuf),
}

/// What the command line asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct Request {
    pub source: Source,
    pub kinds: Vec<Kind>,
    pub effort: Effort,
    pub seed: u64,
    /// Contact samples of a pair.
    pub samples: usize,
    pub csv: bool,
    pub picture: Option<PathBuf>,
}

impl Request {
    pub fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Request, String> {
        let mut arguments = arguments.into_iter();
        let (mut queries, mut table1, mut meshes, mut poses) = (None, false, Vec::new(), Vec::new());
        let nothing = Source::Table1(PathBuf::new());
        let (kinds, effort) = (Kind::BOTH.to_vec(), Effort::Default);
        let mut request = Request { source: nothing, kinds, effort, seed: 0, samples: 0, csv: false, picture: None };
        while let Some(argument) = arguments.next() {
            let mut value = || arguments.next().ok_or(format!("{argument} needs a value"));
            match argument.as_str() {
                "--queries" => queries = Some(PathBuf::from(value()?)),
                "--table1" => table1 = true,
                "--csv" => request.csv = true,
                "--picture" => request.picture = Some(value()?.into()),
                "--pose" => poses.push(pose(&value()?)?),
                "--seed" => request.seed = value()?.parse().map_err(|_| "--seed is not a whole number from 0 up")?,
                "--samples" => {
                    request.samples = value()?.parse().map_err(|_| "--samples is not a whole number from 0 up")?;
                }
                "--metric" => request.kinds = vec![metric(&value()?)?],
                "--effort" => request.effort = effort_named(&value()?)?,
                _ if argument.starts_with("--") => return Err(format!("{argument} is no option")),
                _ => meshes.push(PathBuf::from(argument)),
            }
        }
        if !poses.is_empty() && (table1 || queries.is_some()) {
            return Err("--pose goes with two mesh files, not with --queries or --table1".into());
        }
        let meshes: Option<[PathBuf; 2]> = match meshes.len() {
            0 if poses.is_empty() => None,
            _ => Some(meshes.try_into().map_err(|_| "two mesh files are needed, of A and of B")?),
        };
        request.source = match (table1, queries, meshes) {
            (true, queries, None) => Source::Table1(queries.unwrap_or(SHARED.into())),
            (false, Some(file), None) => Source::File(file),
            (false, None, Some(meshes)) => Source::Pair(meshes, poses),
            (false, None, None) => return Err("there is neither --queries nor a pair of meshes".into()),
            _ => return Err("--queries, --table1 and mesh files exclude each other".into()),
        };
        Ok(request)
    }
}

fn metric(name: &str) -> Result<Kind, String> {
    let found = Kind::BOTH.into_iter().find(|kind| kind.name() == name);
    found.ok_or(format!("--metric is {name:?}, not disp or sigma"))
}

fn effort_named(name: &str) -> Result<Effort, String> {
    Ok(match name {
        "fast" => Effort::Fast,
        "default" => Effort::Default,
        "heavy" => Effort::Heavy,
        _ => return Err(format!("--effort is {name:?}, not fast, default or heavy")),
    })
}

fn pose(text: &str) -> Result<Isometry3<f64>, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|w| w.trim().parse().ok()).collect();
    let Some(&[w, x, y, z, tx, ty, tz]) = numbers.as_deref() else {
        return Err(format!("--pose is {text:?}, not 7 numbers qw,qx,qy,qz,tx,ty,tz"));
    };
    input::pose([w, x, y, z], [tx, ty, tz]).map_err(|trouble| format!("--pose {text:?}: {trouble}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Request, String> {
        Request::parse(line.split_whitespace().map(str::to_string))
    }

    #[test]
    fn what_may_be_asked() {
        let request =
            parse("--queries q.json --metric sigma --effort heavy --csv --seed 7 --samples 50 --picture out").unwrap();
        assert_eq!(request.source, Source::File("q.json".into()));
        assert_eq!((request.kinds.as_slice(), request.effort), (&[Kind::Sigma][..], Effort::Heavy));
        assert_eq!((request.csv, request.seed, request.samples), (true, 7, 50));
        assert_eq!(request.picture, Some("out".into()));

        let request = parse("a.obj b.stl --pose 0,-1,0,0,1,2,3 --pose -1,0,0,0,0,0,0").unwrap();
        let Source::Pair(files, poses) = request.source else { panic!() };
        assert_eq!(files, [PathBuf::from("a.obj"), PathBuf::from("b.stl")]);
        assert_eq!((poses.len(), poses[0].translation.vector.z), (2, 3.0));
        assert_eq!(request.kinds, Kind::BOTH);
        assert_eq!(parse("--table1").unwrap().source, Source::Table1(SHARED.into()));
        assert_eq!(parse("--table1 --queries q").unwrap().source, Source::Table1("q".into()));
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
        assert!(parse("--queries q --metric l2").unwrap_err().contains("--metric"));
    }
}
