use qdist::{
    Options, Real, Vector, Workspace,
    qset::BoxGauge,
    support::{Failure, Support},
};
struct Octa<T> {
    extent: T,
}
impl<T: Real> Support<T, 3> for Octa<T> {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        if !(u.norm() > T::zero()) {
            println!("ASKED {u:?}");
        }
        let i = u.iamax();
        let mut p = Vector::zeros();
        p[i] = if u[i] < T::zero() { -T::one() } else { T::one() };
        Ok(p)
    }
    fn extent(&self) -> T {
        self.extent
    }
}
fn run<T: Real>(e: f64) {
    let mut memory = Workspace::<T, 3, 64, 128>::new();
    let q = BoxGauge::new(Vector::from([T::of(1.0), T::of(2.0), T::of(3.0)])).unwrap();
    let a = memory.solver().solve(&Octa { extent: T::of(e) }, &q, &Options::default());
    println!(
        "{e}: {:?} [{:?}, {:?}] u {:?} s {:?} w {:?} dim {}",
        a.outcome, a.lower, a.upper, a.direction, a.support, a.witness.corners, a.dimension
    );
}
fn main() {
    for e in [1.0, 1e3, 1e6, 1e7, 1e10, 1e15, 1e20] {
        run::<f64>(e);
        run::<f32>(e);
    }
}
