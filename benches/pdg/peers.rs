//! The solid test and the distance against FCL's, on the same poses in the same run: the answers' poses, in contact, and the same moved out.
//!
//! FCL is a program of its own (`fcl.cpp`), and meshes and poses go through plain files. Its boolean test knows surfaces only, ours solids.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use qdist::mesh::{Mesh, Pair};
use qdist::nalgebra::{Isometry3, Translation3};

use crate::measure::{Cold, DEFAULT};
use crate::scenes::Scenes;
use qdist_cli::mesh::input::Kind;
use qdist_cli::mesh::table::quantile;

/// How far out the second poses are, in A's diagonals.
const OUT: f64 = 0.05;

/// A pose, and what both say.
pub struct Compared {
    pub group: String,
    pub query: String,
    /// An answer's pose, not one moved out.
    pub contact: bool,
    /// Collides, nanoseconds, distance, nanoseconds.
    pub ours: (bool, f64, f64, f64),
    pub fcl: (bool, f64, f64, f64),
}

/// All poses of the default variant, with FCL's program.
pub fn compare(
    scenes: &Scenes,
    cold: &[Cold],
    program: &Path,
    folder: &Path,
    rounds: usize,
) -> Result<Vec<Compared>, String> {
    let mut pairs: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for c in cold.iter().filter(|c| c.variant == DEFAULT && c.row.upper.is_finite()) {
        let query = scenes.queries.iter().find(|q| q.id == c.row.query).ok_or("a query is lost")?;
        pairs.entry((&query.a, &query.b)).or_default().push(&c.row);
    }
    let mut all = Vec::new();
    for ((a, b), rows) in pairs {
        let (a, b) = (scenes.bodies.get(a).mesh(), scenes.bodies.get(b).mesh());
        let mut poses: Vec<Isometry3<f64>> = rows.iter().map(|r| r.pose).collect();
        poses.extend(rows.iter().map(|r| moved_out(a, b, &r.pose)));
        let ours = ours(a, b, &poses, rounds);
        let fcl = told(a, b, &poses, program, folder, rounds, 4)?;
        let fcl = fcl.iter().map(|said| (said[0] != 0.0, said[1], said[2], said[3]));
        let names = rows.iter().map(|r| (r, true)).chain(rows.iter().map(|r| (r, false)));
        for (((row, contact), ours), fcl) in names.zip(ours).zip(fcl) {
            let (group, query) = (row.group.clone(), format!("{} {}", row.query, row.kind.name()));
            all.push(Compared { group, query, contact, ours, fcl });
        }
    }
    Ok(all)
}

fn moved_out(a: &Mesh, b: &Mesh, pose: &Isometry3<f64>) -> Isometry3<f64> {
    let middle = |mesh: &Mesh| qdist::nalgebra::center(&mesh.bounds().0, &mesh.bounds().1);
    let away = (pose * middle(a) - middle(b)).try_normalize(0.0).unwrap_or_default();
    Translation3::from(away * OUT * a.diagonal()) * pose
}

fn ours(a: &Mesh, b: &Mesh, poses: &[Isometry3<f64>], rounds: usize) -> Vec<(bool, f64, f64, f64)> {
    let mut pair = Pair::new(a, b);
    let mut answers = vec![(false, 0.0); poses.len()];
    let mut times = [vec![Vec::new(); poses.len()], vec![Vec::new(); poses.len()]];
    let elapsed = |begin: Instant| begin.elapsed().as_nanos() as f64;
    for _ in 0..rounds {
        for (i, pose) in poses.iter().enumerate() {
            let begin = Instant::now();
            answers[i].0 = pair.collides(pose);
            times[0][i].push(elapsed(begin));
        }
    }
    for _ in 0..rounds {
        for (i, pose) in poses.iter().enumerate() {
            let begin = Instant::now();
            answers[i].1 = pair.distance(pose).distance;
            times[1][i].push(elapsed(begin));
        }
    }
    let median = |k: usize, i: usize| quantile(&times[k][i], 0.5);
    (0..poses.len()).map(|i| (answers[i].0, median(0, i), answers[i].1, median(1, i))).collect()
}

/// A program's numbers for every pose: a line of `columns` numbers each.
fn told(
    a: &Mesh,
    b: &Mesh,
    poses: &[Isometry3<f64>],
    program: &Path,
    folder: &Path,
    rounds: usize,
    columns: usize,
) -> Result<Vec<Vec<f64>>, String> {
    let (input, output) = (folder.join("peer_in.txt"), folder.join("peer_out.txt"));
    std::fs::write(&input, written(a, b, poses)).map_err(|e| format!("{}: {e}", input.display()))?;
    let run = Command::new(program).arg(&input).arg(&output).arg(rounds.to_string()).status();
    let status = run.map_err(|e| format!("{}: {e}", program.display()))?;
    if !status.success() {
        return Err(format!("{}: {status}", program.display()));
    }
    let text = std::fs::read_to_string(&output).map_err(|e| format!("{}: {e}", output.display()))?;
    let line = |line: &str| {
        let numbers: Vec<f64> = line.split_whitespace().filter_map(|w| w.parse().ok()).collect();
        if numbers.len() == columns { Ok(numbers) } else { Err(format!("{} said {line:?}", program.display())) }
    };
    let answers: Vec<_> = text.lines().map(line).collect::<Result<_, _>>()?;
    for file in [input, output] {
        std::fs::remove_file(&file).map_err(|e| format!("{}: {e}", file.display()))?;
    }
    if answers.len() == poses.len() { Ok(answers) } else { Err("a pose has no answer".into()) }
}

/// Meshes and poses, as `fcl.cpp` reads them.
fn written(a: &Mesh, b: &Mesh, poses: &[Isometry3<f64>]) -> String {
    let mut text = String::new();
    for mesh in [a, b] {
        let _ = writeln!(text, "{} {}", mesh.vertices().len(), mesh.triangles().len());
        mesh.vertices().iter().for_each(|p| _ = writeln!(text, "{} {} {}", p.x, p.y, p.z));
        mesh.triangles().iter().for_each(|t| _ = writeln!(text, "{} {} {}", t[0], t[1], t[2]));
    }
    let _ = writeln!(text, "{}", poses.len());
    for pose in poses {
        let (turn, t) = (pose.rotation.to_rotation_matrix(), pose.translation.vector);
        // The matrix is stored by columns.
        turn.matrix().transpose().iter().chain(t.iter()).for_each(|x| _ = write!(text, "{x} "));
        text.push('\n');
    }
    text
}

/// What another library's pairs of triangles tell of a query.
pub struct Deepest {
    pub library: String,
    pub group: String,
    pub query: String,
    pub depth: f64,
    pub best_known: Option<f64>,
    pub ns: f64,
}

/// The largest depth of two triangles at the poses of all queries, by these programs (`triangles.cpp`).
pub fn deepest(
    scenes: &Scenes,
    cold: &[Cold],
    programs: &[(String, PathBuf)],
    folder: &Path,
    rounds: usize,
) -> Result<Vec<Deepest>, String> {
    let mut pairs: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for query in &scenes.queries {
        pairs.entry((&query.a, &query.b)).or_default().push(query);
    }
    let mut all = Vec::new();
    for ((a, b), queries) in pairs {
        let (a, b) = (scenes.bodies.get(a).mesh(), scenes.bodies.get(b).mesh());
        let poses: Vec<_> = queries.iter().map(|query| query.pose).collect();
        for (library, program) in programs {
            for (query, said) in queries.iter().zip(told(a, b, &poses, program, folder, rounds, 2)?) {
                let row = cold.iter().map(|c| &c.row).find(|r| r.query == query.id && r.kind == Kind::Disp);
                let Some(row) = row else { continue };
                let (group, best_known) = (row.group.clone(), row.known.least());
                let (depth, ns) = (said[0], said[1]);
                all.push(Deepest { library: library.clone(), group, query: query.id.clone(), depth, best_known, ns });
            }
        }
    }
    Ok(all)
}
