use qdist::{
    Body, Options, Vector, Workspace,
    support::{BoxShape, Sphere},
};
fn main() {
    let l = 100.0f32;
    let ground = BoxShape::new(Vector::from([l, l, 0.1])).unwrap();
    let ball = Sphere::new(0.01f32).unwrap();
    let mut memory = Workspace::<f32, 3, 256, 512>::new();
    let (x, y) = (Body::at(&ground, Vector::zeros()), Body::at(&ball, Vector::from([0.3 * l, 0.1, 0.109])));
    let d = memory.solver().depth(&x, &y, &Options::default());
    println!("{d:?}");
}
