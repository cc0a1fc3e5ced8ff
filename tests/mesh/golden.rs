//! Golden data of meshes: how deep, and with how many queries. Sines and cosines are the machine's, so that bits may differ from one machine to the
//! next: the sum of a pair's depths is kept to a thousandth, that of its queries to a tenth.
use crate::common;
use crate::mesh_common;

use common::dice::Dice;
use common::golden;
use mesh_common::{Shape, cuboid, l_shape, random_pose, slot, torus};
use qdist::mesh::metric::Metric;
use qdist::mesh::{DepthOptions, DepthSolver, Model};

const HEAD: &str = "pair,metric,depths,queries";

fn lines(name: &str, a: &Shape, b: &Shape, reach: f64) -> Vec<String> {
    let model = |shape: &Shape| Model::new(&shape.vertices, &shape.triangles).unwrap();
    let (a, b) = (model(a), model(b));
    let mut solver = DepthSolver::new(&a, &b);
    let mut sums = [(0.0, 0); 2];
    let mut dice = Dice::new(19);
    for _ in 0..8 {
        let pose = random_pose(&mut dice, reach);
        for (sum, metric) in sums.iter_mut().zip([a.disp() as &dyn Metric, a.sigma().unwrap()]) {
            let depth = solver.depth(&pose, metric, &DepthOptions::default(), None);
            let counters = depth.counters;
            sum.0 += depth.upper;
            sum.1 += counters.collision + counters.contact + counters.distance;
        }
    }
    let line = |(metric, sum): (&str, &(f64, u64))| format!("{name},{metric},{:.6},{}", sum.0, sum.1);
    ["disp", "sigma"].into_iter().zip(&sums).map(line).collect()
}

#[test]
fn depths_of_meshes() {
    let (plate, ring) = (cuboid([0.9, 0.9, 0.1]), torus(16, 8, 1.0, 0.3));
    let mut now = vec![HEAD.to_string()];
    now.extend(lines("box and L", &cuboid([0.4, 0.3, 0.2]), &l_shape(), 0.8));
    now.extend(lines("plate and slot", &plate, &slot(1.5, 2.0, 0.4, 0.5, 1.0), 0.8));
    now.extend(lines("rings", &ring, &ring, 0.8));
    golden::compare_with("mesh.csv", &now, |old, new| {
        let number = |line: &str, place: usize| line.split(',').nth(place).and_then(|word| word.parse::<f64>().ok());
        let near = |place, share: f64| match (number(old, place), number(new, place)) {
            (Some(old), Some(new)) => (new - old).abs() <= share * old,
            _ => old == new,
        };
        old.split(',').take(2).eq(new.split(',').take(2)) && near(2, 1e-3) && near(3, 0.1)
    });
}
