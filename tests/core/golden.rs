//! Golden data of depths: the bits and the work of all fixtures, alike on every machine.
use crate::common;

use common::cases::{Case, parse};
use common::golden::{Group, compare};
use qdist::{Options, Real, Workspace};

fn group<T: Real>(name: &str, cases: &[Case], relative: f64) -> Group {
    let mut memory = Box::new(Workspace::<T, 3, 256, 512>::new());
    let mut group = Group::of::<T>(name);
    for case in cases {
        let points = case.bodies.each_ref().map(|body| body.shape.points::<T>());
        let shapes = [0, 1].map(|i| case.bodies[i].shape.build(&points[i]).unwrap());
        let [a, b] = [0, 1].map(|i| case.bodies[i].body(&*shapes[i]).unwrap());
        let options = Options { relative: T::of(relative), ..Options::default() };
        group.depth(&memory.solver().depth(&a, &b, &options));
    }
    group
}

#[test]
fn depths_of_the_fixtures() {
    let mut groups = Vec::new();
    for file in super::cases::fixtures() {
        let cases = parse(&std::fs::read_to_string(&file).unwrap()).unwrap();
        let name = file.file_stem().unwrap().to_string_lossy();
        groups.push(group::<f64>(&name, &cases, 1e-6));
        groups.push(group::<f32>(&name, &cases, 1e-4));
    }
    compare("depth.csv", &groups);
}
