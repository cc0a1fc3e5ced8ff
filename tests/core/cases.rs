//! The case files: every bracket contains the reference, every certificate proves its bound, and the brackets are as
//! narrow as asked for.
//!
//! The fixtures in `tests/data` always run. The full sets lie beside the project (`../shared/data/convex`).

use crate::common;

use common::cases::{Case, Placed};
use common::dd::{BLUR, v3};
use common::memory::{Seen, broken_promise};
use qdist::{Depth, Options, Real, Workspace};
use std::path::{Path, PathBuf};

const VERTICES: usize = 256;
const FACETS: usize = 512;

/// What one case came to.
struct Report {
    id: String,
    /// Broken promises: never allowed.
    wrong: Vec<String>,
    /// upper - lower <= max(1e-6 |depth|, 1e-12 size).
    narrow: bool,
    /// (upper - lower) / |depth|.
    relative_width: f64,
    /// Angle to the reference normal, where it counts.
    angle: Option<f64>,
}

/// A bound of |x| over the placed shape, for the rounding of the input.
fn reach(body: &Placed) -> f64 {
    let n = &body.shape.numbers;
    let size = match body.shape.kind.as_str() {
        "hull" => n.chunks_exact(3).map(|p| (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt()).fold(0.0, f64::max),
        _ => n.iter().sum(),
    };
    size + body.translation.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn rounded<T: Real>(body: &Placed) -> Placed {
    let mut body = body.clone();
    body.shape.numbers.iter_mut().for_each(|x| *x = T::of(*x).to_f64());
    body.rotation = body.rotation.map(|x| T::of(x).to_f64());
    body.translation = body.translation.map(|x| T::of(x).to_f64());
    body
}

fn run<T: Real>(case: &Case, options: &Options<'_, T, 3>, memory: &mut Workspace<T, 3, VERTICES, FACETS>) -> Report {
    let points: Vec<_> = case.bodies.iter().map(|b| b.shape.points::<T>()).collect();
    let shapes: Vec<_> = case.bodies.iter().zip(&points).map(|(b, p)| b.shape.build(p).unwrap()).collect();
    let (a, b) = (case.bodies[0].body(&*shapes[0]).unwrap(), case.bodies[1].body(&*shapes[1]).unwrap());
    let r: Depth<T> = memory.solver().depth(&a, &b, options);
    let seen = Seen::from(&r);
    let mut wrong = Vec::new();
    wrong.extend(broken_promise(&seen, options, VERTICES, FACETS));
    // The files have the reference rounded to f64, and f32 sees other bodies than the file: each coordinate
    // moves by up to 2^-24 of its size. 8 times that, of the coordinates of both bodies, covers the depth.
    let single = T::ROUNDOFF.to_f64() > 1e-10;
    let input =
        if single { 8.0 * T::ROUNDOFF.to_f64() * (reach(&case.bodies[0]) + reach(&case.bodies[1])) } else { 0.0 };
    let slack = input + f64::EPSILON * case.depth.abs();
    if !(seen.lower <= case.upper + slack && case.lower <= seen.upper + slack) {
        wrong.push(format!("bracket [{:e}, {:e}] misses the reference {:e}", seen.lower, seen.upper, case.depth));
    }
    // The certificate, for the bodies as the solver saw them.
    let bodies = [rounded::<T>(&case.bodies[0]), rounded::<T>(&case.bodies[1])];
    let n = [r.normal.x.to_f64(), r.normal.y.to_f64(), r.normal.z.to_f64()];
    let proved = common::exact::pair_value(&bodies[0], &bodies[1], &v3(n));
    if proved.to_f64() > seen.upper + BLUR * (reach(&bodies[0]) + reach(&bodies[1])) {
        wrong.push(format!("the normal proves {:e} only, not upper = {:e}", proved.to_f64(), seen.upper));
    }
    let width = seen.upper - seen.lower;
    let counts = case.depth.abs() > 1e-9 * case.size;
    let angle = case.normal.filter(|_| counts).map(|m| {
        let n = nalgebra::Vector3::from(n);
        m.cross(&n).norm().atan2(m.dot(&n))
    });
    Report {
        id: case.id.clone(),
        wrong,
        // The tolerance is relative to the larger end of the bracket, not to the reference: hence 2e-6.
        narrow: width <= (1e-6 * (1.0 + 2e-6) * case.depth.abs()).max(1e-12 * case.size),
        relative_width: width / case.depth.abs(),
        angle,
    }
}

fn run_file<T: Real>(file: &Path) -> Vec<Report> {
    let cases = common::cases::parse(&std::fs::read_to_string(file).unwrap()).unwrap();
    assert!(!cases.is_empty(), "{file:?} is empty");
    let mut memory = Box::new(Workspace::<T, 3, VERTICES, FACETS>::new());
    let single = T::ROUNDOFF.to_f64() > 1e-10;
    let run_one = |case: &Case| {
        let (relative, absolute) = if single { (1e-4, 1e-6) } else { (1e-6, 1e-12) };
        let options =
            Options { relative: T::of(relative), absolute: T::of(absolute * case.size), ..Options::default() };
        run::<T>(case, &options, &mut memory)
    };
    cases.iter().map(run_one).collect()
}

pub(super) fn fixtures() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "txt"))
        .collect();
    files.sort();
    assert!(files.len() >= 11);
    files
}

/// The full sets.
fn full_sets() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(common::shared("convex")).unwrap();
    let mut files: Vec<PathBuf> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "txt"))
        .collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn name(file: &Path) -> String {
    file.file_stem().unwrap().to_string_lossy().into_owned()
}

/// Collects what is not allowed, for one message at the end.
#[derive(Default)]
struct Verdict(Vec<String>);

impl Verdict {
    fn brackets(&mut self, file: &Path, reports: &[Report]) {
        for r in reports {
            for w in &r.wrong {
                self.0.push(format!("{} {}: {w}", name(file), r.id));
            }
        }
    }

    /// At least this share of the cases has a narrow bracket.
    fn narrow(&mut self, what: &str, reports: &[Report], share: f64) {
        let wide: Vec<&Report> = reports.iter().filter(|r| !r.narrow).collect();
        let have = 1.0 - wide.len() as f64 / reports.len() as f64;
        if have < share {
            let list: Vec<String> = wide.iter().map(|r| format!("{} ({:.1e})", r.id, r.relative_width)).collect();
            self.0.push(format!(
                "{what}: {:.2} % narrow, {:.2} % wanted; wide: {}",
                100.0 * have,
                100.0 * share,
                list.join(" ")
            ));
        }
    }

    fn normals(&mut self, file: &Path, reports: &[Report]) {
        for r in reports {
            if let Some(angle) = r.angle.filter(|&a| a > 1e-3 || a.is_nan()) {
                self.0.push(format!("{} {}: normal off by {angle:.2e} rad", name(file), r.id));
            }
        }
    }

    fn end(self) {
        assert!(self.0.is_empty(), "{} complaints:\n{}", self.0.len(), self.0.join("\n"));
    }
}

/// Where every direction, or many, are equally deep: the bar is lower there.
fn is_concentric(file: &Path) -> bool {
    ["alignedconc", "concentric", "identical"].iter().any(|k| name(file).contains(k))
}

#[test]
fn fixtures_have_true_brackets_and_certificates_in_f64() {
    let mut verdict = Verdict::default();
    for file in fixtures() {
        verdict.brackets(&file, &run_file::<f64>(&file));
    }
    verdict.end();
}

#[test]
fn fixtures_have_true_brackets_and_certificates_in_f32() {
    let mut verdict = Verdict::default();
    for file in fixtures() {
        verdict.brackets(&file, &run_file::<f32>(&file));
    }
    verdict.end();
}

#[test]
fn fixtures_are_narrow_with_the_right_normal() {
    let mut verdict = Verdict::default();
    for file in fixtures() {
        let reports = run_file::<f64>(&file);
        verdict.narrow(&name(&file), &reports, 1.0);
        verdict.normals(&file, &reports);
    }
    verdict.end();
}

#[test]
#[ignore = "needs ../shared/data"]
fn full_sets_have_true_brackets_and_certificates() {
    let files = full_sets();
    let mut verdict = Verdict::default();
    for file in files {
        verdict.brackets(&file, &run_file::<f64>(&file));
        verdict.brackets(&file, &run_file::<f32>(&file));
    }
    verdict.end();
}

#[test]
#[ignore = "needs ../shared/data"]
fn full_sets_are_narrow_with_the_right_normals() {
    let files = full_sets();
    let mut verdict = Verdict::default();
    let mut standard = Vec::new();
    for file in files {
        let reports = run_file::<f64>(&file);
        verdict.normals(&file, &reports);
        match name(&file).as_str() {
            "reported" => verdict.narrow("reported", &reports, 1.0),
            other if other.starts_with("std_") => standard.extend(reports),
            other if is_concentric(&file) => {
                verdict.narrow(other, &reports, 0.9);
                for r in reports.iter().filter(|r| !r.narrow && r.relative_width > 1e-3) {
                    verdict.0.push(format!("{}: width {:.1e} of the depth", r.id, r.relative_width));
                }
            }
            other => verdict.narrow(other, &reports, 0.99),
        }
    }
    verdict.narrow("std_*", &standard, 0.995);
    verdict.end();
}
