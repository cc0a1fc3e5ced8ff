use qdist::{Body, Options, Vector, Workspace, Real, support::{BoxShape, Sphere, Points, Support, Ellipsoid}};
fn show<T: Real>(name: &str, a: &Body<'_, T>, b: &Body<'_, T>) {
    let mut memory = Workspace::<T, 3, 128, 256>::new();
    let d = memory.solver().depth(a, b, &Options::default());
    println!("{name}: {:?} [{:?}, {:?}] n {:?} a {:?} b {:?} dim {} fail {}", d.outcome, d.lower, d.upper, d.normal.as_slice(), d.point_a.as_slice(), d.point_b.as_slice(), d.dimension, d.failure);
}
fn main() {
    let tri = [[-1e4f32, -1e4, 0.0], [1e4, -1e4, 0.0], [0.0, 1e4, 0.0]];
    let tri = Points::new(&tri).unwrap();
    let b = BoxShape::new(Vector::from([0.1f32, 0.1, 0.1])).unwrap();
    show("10", &Body::at(&tri, Vector::zeros()), &Body::at(&b, Vector::from([1e3, -5e3, 0.05])));
    for e in [-20, -60, -61, -80, -100, -120, -139, -140, -150] {
        let s = 10f64.powi(e);
        let a = BoxShape::new(Vector::from([s, s, s])).unwrap();
        show(&format!("11 1e{e}"), &Body::at(&a, Vector::zeros()), &Body::at(&a, Vector::from([1.9 * s, 0.1 * s, 0.0])));
    }
    for e in [-10, -15, -17, -18, -20] {
        let s = 10f64.powi(e) as f32;
        let a = BoxShape::new(Vector::from([s, s, s])).unwrap();
        show(&format!("11 f32 1e{e}"), &Body::at(&a, Vector::zeros()), &Body::at(&a, Vector::from([1.9 * s, 0.1 * s, 0.0])));
    }
    for e in [100, 140, 150, 155, 160, 200, 250, 280, 290] {
        let s = 10f64.powi(e);
        let a = BoxShape::new(Vector::from([s, s, s])).unwrap();
        show(&format!("12 size 1e{e}"), &Body::at(&a, Vector::zeros()), &Body::at(&a, Vector::from([1.9 * s, 0.1 * s, 0.0])));
        let one = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap();
        show(&format!("12 at 1e{e}"), &Body::at(&one, Vector::zeros()), &Body::at(&one, Vector::from([s, 0.1 * s, 0.0])));
        show(&format!("12 both at 1e{e}"), &Body::at(&one, Vector::from([s, 0.0, 0.0])), &Body::at(&one, Vector::from([s, 0.1, 0.0])));
        let el = Ellipsoid::new(Vector::from([s, 2.0 * s, s])).unwrap();
        show(&format!("12 ell 1e{e}"), &Body::at(&el, Vector::zeros()), &Body::at(&a, Vector::from([1.9 * s, 0.1 * s, 0.0])));
    }
    let cube: Vec<[f64; 3]> = (0..8).map(|i| [1e9 + (i & 1) as f64, 1e9 + (i >> 1 & 1) as f64, -1e9 + (i >> 2 & 1) as f64]).collect();
    let hull = Points::new(&cube).unwrap();
    let c = (0.6f64, 0.8f64);
    let r = nalgebra::Matrix3::new(c.0, -c.1, 0.0, c.1, c.0, 0.0, 0.0, 0.0, 1.0);
    let one = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap();
    let t = Vector::from([1e9 * 0.2 + 0.3, -1e9 * 1.4, 1e9]);
    let a = Body::new(&hull, r, t).unwrap();
    show("13", &a, &Body::at(&one, Vector::from([0.2, 1.3, 1.9])));
}
