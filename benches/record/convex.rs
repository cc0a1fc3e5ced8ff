//! Depths of the convex pairs of all case files, in both scalars. Large hulls are asked with their graph.

use std::error::Error;

use qdist::support::graph_len;
use qdist::{Options, Real, Workspace};
use qdist_cli::depth::cases::{self, Case};
use qdist_cli::depth::prepared;

use crate::files;
use crate::line::Record;

type Memory<T> = Box<Workspace<T, 3, 256, 512>>;

pub fn all(record: &mut Record) -> Result<(), Box<dyn Error>> {
    let (mut double, mut single): (Memory<f64>, Memory<f32>) = Default::default();
    for folder in ["tests/data", "../shared/data/convex"] {
        for file in files(folder, "txt") {
            let name = format!("{folder}/{}", file.file_stem().unwrap_or_default().display());
            for case in cases::parse(&std::fs::read_to_string(&file)?)? {
                let question = format!("{name}:{}", case.id);
                one(record, &question, &case, &mut double, [1e-6, 1e-12])?;
                one(record, &question, &case, &mut single, [1e-4, 1e-5])?;
            }
        }
    }
    Ok(())
}

fn one<T: Real>(
    record: &mut Record,
    question: &str,
    case: &Case,
    memory: &mut Memory<T>,
    [relative, absolute]: [f64; 2],
) -> Result<(), Box<dyn Error>> {
    let points = case.bodies.each_ref().map(|body| body.shape.points::<T>());
    let mut words = points.each_ref().map(|points| vec![0; graph_len(points.len())]);
    let [left, right] = &mut words;
    let a = prepared(&case.bodies[0].shape, &points[0], left)?;
    let b = prepared(&case.bodies[1].shape, &points[1], right)?;
    let (a, b) = (case.bodies[0].body(&*a)?, case.bodies[1].body(&*b)?);
    let options = Options { relative: T::of(relative), absolute: T::of(absolute * case.size), ..Options::default() };
    let depth = memory.solver().depth(&a, &b, &options);
    let numbers = [&depth.lower, &depth.upper].into_iter();
    let numbers = numbers.chain(&depth.normal).chain(&depth.point_a).chain(&depth.point_b);
    Ok(record.line(question, &(depth.outcome, depth.dimension), numbers)?)
}
