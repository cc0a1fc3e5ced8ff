use qdist::{
    Body, Options, Vector, Workspace,
    support::{BoxShape, Cylinder, Sphere, Support},
};
fn run(name: &str, l: f32, a: &dyn Support<f32, 3>, b: &dyn Support<f32, 3>, at: [f32; 3]) {
    let mut memory = Workspace::<f32, 3, 256, 512>::new();
    for swap in [false, true] {
        let (x, y) = (Body::at(a, Vector::zeros()), Body::at(b, Vector::from(at)));
        let d = if swap {
            memory.solver().depth(&y, &x, &Options::default())
        } else {
            memory.solver().depth(&x, &y, &Options::default())
        };
        println!(
            "{name} L={l} {swap}: {:?} [{:.6}, {:.6}] mm n {:?} it {} v {}",
            d.outcome,
            d.lower * 1e3,
            d.upper * 1e3,
            d.normal.as_slice(),
            d.iterations,
            d.vertices
        );
    }
}
fn main() {
    for l in [1.0f32, 10.0, 100.0, 1000.0, 10000.0] {
        let ground = BoxShape::new(Vector::from([l, l, 0.1])).unwrap();
        let cube = BoxShape::new(Vector::from([0.01, 0.01, 0.01])).unwrap();
        run("cube", l, &ground, &cube, [0.3 * l, 0.1, 0.109]);
        let ball = Sphere::new(0.01f32).unwrap();
        run("ball", l, &ground, &ball, [0.3 * l, 0.1, 0.109]);
        let post = Cylinder::new(0.01f32, 0.01).unwrap();
        run("post", l, &ground, &post, [0.3 * l, 0.1, 0.109]);
        let disc = Cylinder::new(l, 0.1f32).unwrap();
        run("disc", l, &disc, &cube, [0.3 * l, 0.1, 0.109]);
    }
}
