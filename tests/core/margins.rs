//! What a bracket may cost: margins follow what arithmetic forces, not the worst direction, a loose bound, or the place in the format's range.

use crate::common;

use common::dice::Dice;
use nalgebra::{Matrix3, Vector3};
use qdist::qset::UnitBox;
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Failure, Points, Sphere, Support};
use qdist::{Body, Depth, Options, Outcome, Real, Vector, Workspace};
use std::sync::atomic::{AtomicU32, Ordering};

fn depth<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>) -> Depth<T> {
    Workspace::<T, 3, 64, 128>::new().solver().depth(a, b, &Options::default())
}

/// The bracket holds `truth`, which is known to `blur`, and says nothing that contradicts it.
fn check<T: Real>(d: &Depth<T>, truth: f64, blur: f64) {
    let (lower, upper) = (d.lower.to_f64(), d.upper.to_f64());
    assert!(lower <= truth + blur && truth - blur <= upper, "{truth:e} {d:?}");
    assert!((d.normal.norm().to_f64() - 1.0).abs() < 1e-5, "{d:?}");
    let wrong = match d.outcome {
        Outcome::Degenerate | Outcome::Touching => {
            truth.abs() > blur && lower.abs().max(upper.abs()) < truth.abs() / 2.0
        }
        Outcome::Separated => truth > blur,
        _ => false,
    };
    assert!(!wrong, "{truth:e} {d:?}");
}

/// A turn that permutes the axes: exact in any format.
fn permutation<T: Real>(turns: usize) -> Matrix3<T> {
    let (o, l) = (T::zero(), T::one());
    let cycle = Matrix3::new(o, o, l, l, o, o, o, l, o);
    (0..turns % 3).fold(Matrix3::identity(), |m, _| m * cycle)
}

/// Bodies with their half height along z: the last is upside down.
fn body_on_the_floor<T: Real>(kind: usize, size: T) -> (Box<dyn Support<T, 3> + Sync>, T) {
    match kind % 5 {
        0 => (Box::new(BoxShape::new(Vector::from([size, size, size])).unwrap()), size),
        1 => (Box::new(Sphere::new(size).unwrap()), size),
        2 => (Box::new(Cylinder::new(size, size).unwrap()), size),
        3 => (Box::new(Capsule::new(size, size).unwrap()), size + size),
        _ => (Box::new(Cone::new(size, size).unwrap()), size),
    }
}

/// A floor of half lengths l, l and h, as box, disc or hull; a body of half height `size` stands `deep` in it at (x, y).
#[allow(clippy::too_many_arguments)]
fn on_the_floor<T: Real>(
    l: f64,
    h: f64,
    kind: usize,
    size: f64,
    deep: f64,
    at: [f64; 2],
    turns: usize,
    floor: usize,
) -> (Depth<T>, f64) {
    let (l, h) = (T::of(l), T::of(h));
    let (body, half) = body_on_the_floor(kind, T::of(size));
    let corners: Vec<[T; 3]> = (0..8).map(|i| [[-l, l][i & 1], [-l, l][i >> 1 & 1], [-h, h][i >> 2]]).collect();
    let ground: Box<dyn Support<T, 3> + Sync + '_> = match floor % 3 {
        0 => Box::new(BoxShape::new(Vector::from([l, l, h])).unwrap()),
        1 => Box::new(Cylinder::new(l, h).unwrap()),
        _ => Box::new(Points::new(&corners).unwrap()),
    };
    let turn = permutation::<T>(turns);
    let z = h + half - T::of(deep);
    let place = turn * Vector3::new(T::of(at[0]), T::of(at[1]), z);
    let truth = h.to_f64() + half.to_f64() - z.to_f64();
    let a = Body::new(&*ground, turn, Vector::zeros()).unwrap();
    let b = Body::new(&*body, turn, place).unwrap();
    (if turns.is_multiple_of(2) { depth(&a, &b) } else { depth(&b, &a) }, truth)
}

/// The margin was a share of the larger body, whatever the direction: a cube 1 mm deep in a floor of a kilometre had [-2.6, 3.5] mm.
#[test]
fn a_floor_of_a_kilometre_in_single_precision() {
    for l in [1.0, 10.0, 100.0, 1000.0, 10000.0] {
        let (d, truth) = on_the_floor::<f32>(l, 0.1, 0, 0.01, 1e-3, [0.3 * l, 0.1], 0, 0);
        check(&d, truth, 1e-9);
        assert!(f64::from(d.upper - d.lower) < 1e-6, "{l} {d:?}");
    }
}

#[test]
fn floors_of_any_size_and_what_stands_on_them() {
    let mut dice = Dice::new(9);
    for k in 0..600 {
        let l = 10f64.powf(dice.range(0.0, 3.0));
        let (h, size) = (dice.range(0.05, 0.5), dice.range(0.005, 0.05));
        let (deep, at) = (dice.range(1e-3, 4e-3), [dice.range(-0.6, 0.6) * l, dice.range(-0.6, 0.6) * l]);
        let (d, truth) = on_the_floor::<f32>(l, h, k, size, deep, at, k / 5, k / 15);
        check(&d, truth, 1e-9);
        // (Two points of a rim and a ball over the line between them: the disc beside the line is not known to the bound.)
        let share = if k / 15 % 3 == 1 { 0.1 } else { 0.01 };
        // (What is neither long nor flat is measured once, with the margin of the whole.)
        let whole = if l < 10.0 * h { 4e-5 } else { 0.0 };
        assert!(f64::from(d.upper - d.lower) < share * truth + whole, "{k}: {l} {h} {size} {deep} {at:?} {d:?}");
        let far = l * 1e6;
        let (d, truth) = on_the_floor::<f64>(far, h, k, size, deep, [at[0] * 1e6, at[1] * 1e6], k / 5, k / 15);
        check(&d, truth, 1e-15);
        assert!(d.upper - d.lower < 1e-6 * truth, "{k}: {far} {h} {size} {deep} {d:?}");
    }
}

/// A flat triangle of kilometres was called `degenerate`, which says d = 0, where d = 0.05.
#[test]
fn a_small_box_through_a_wide_triangle() {
    let corners = [[-1e4f32, -1e4, 0.0], [1e4, -1e4, 0.0], [0.0, 1e4, 0.0]];
    let (triangle, cube) = (Points::new(&corners).unwrap(), BoxShape::new(Vector::from([0.1f32; 3])).unwrap());
    let d = depth(&Body::at(&triangle, Vector::zeros()), &Body::at(&cube, Vector::from([1e3, -5e3, 0.05])));
    check(&d, f64::from(0.1f32) - f64::from(0.05f32), 1e-9);
    assert!(d.outcome == Outcome::Converged && d.upper - d.lower < 1e-5, "{d:?}");
    let mut dice = Dice::new(10);
    for k in 0..300 {
        let l = 10f64.powf(dice.range(0.0, 5.0));
        let turn = permutation::<f32>(k);
        let corners = [[-l, -l, 0.0], [l, -l, 0.0], [0.0, l, 0.0]].map(|p| p.map(|x| x as f32));
        let triangle = Points::new(&corners).unwrap();
        let half = dice.range(0.01, 1.0) as f32;
        let z = (dice.range(-0.9, 0.9) as f32) * half;
        let at = Vector3::new((0.1 * l) as f32, (-0.5 * l) as f32, z);
        let cube = BoxShape::new(Vector::from([half; 3])).unwrap();
        let a = Body::new(&triangle, turn, Vector::zeros()).unwrap();
        let b = Body::new(&cube, turn, turn * at).unwrap();
        let d = depth(&a, &b);
        let truth = f64::from(half) - f64::from(z).abs();
        check(&d, truth, 1e-9);
        assert!(
            d.outcome != Outcome::Degenerate && f64::from(d.upper - d.lower) < 1e-4 * f64::from(half),
            "{k} {l} {d:?}"
        );
    }
}

/// An octahedron of these half axes that says of itself what it is told to.
struct Octahedron<T, const N: usize> {
    axes: [T; N],
    extent: T,
    error: Option<T>,
    asked: AtomicU32,
}

impl<T: Real, const N: usize> Support<T, N> for Octahedron<T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        let length = u.norm().to_f64();
        assert!((0.5..2.0).contains(&length), "asked along {u:?}");
        self.asked.fetch_add(1, Ordering::Relaxed);
        let heights: Vec<T> = (0..N).map(|i| u[i].abs() * self.axes[i]).collect();
        let far = (0..N).fold(0, |best, i| if heights[i] > heights[best] { i } else { best });
        let mut point = Vector::zeros();
        point[far] = self.axes[far].copysign(u[far]);
        Ok(point)
    }
    fn extent(&self) -> T {
        self.extent
    }
    fn error(&self) -> T {
        self.error.unwrap_or(T::count(16 * N) * T::ROUNDOFF * self.extent)
    }
}

fn octahedra<T: Real, const N: usize>(seed: u64, widest: f64) {
    let mut dice = Dice::new(seed);
    let mut memory = Workspace::<T, N, 64, 512>::new();
    for k in 0..40 {
        let axes: [T; N] = std::array::from_fn(|_| T::of(dice.range(0.5, 2.0)));
        let unit: [T; N] = std::array::from_fn(|_| T::of(dice.range(0.5, 3.0)));
        let q = UnitBox::new(Vector::from(unit)).unwrap();
        let truth = 1.0 / (0..N).map(|i| unit[i].to_f64() / axes[i].to_f64()).sum::<f64>();
        let extent = T::of(10f64.powf(dice.range(0.5, if k % 2 == 0 { 8.0 } else { 20.0 })));
        // Every third states its error by itself: then the bracket may be wide, and nothing else.
        let error = (k % 3 == 2).then(|| T::of(10f64.powf(dice.range(-3.0, 15.0))));
        let set = Octahedron { axes, extent, error, asked: AtomicU32::new(0) };
        let answer = memory.solver().solve(&set, &q, &Options::default());
        let (lower, upper) = (answer.lower.to_f64(), answer.upper.to_f64());
        assert!(lower <= truth * (1.0 + 1e-14) && truth * (1.0 - 1e-14) <= upper, "{truth} {lower} {upper}");
        let points = answer.witness.corners().iter().flat_map(|c| c.vertex.point.iter().chain(c.vertex.witness.iter()));
        let all = points.chain(answer.direction.iter()).chain(answer.support.iter()).chain([&answer.unit]);
        assert!(all.copied().all(|x| x.finite()) && answer.direction.norm() > T::of(0.5), "{:?}", answer.direction);
        assert_eq!(answer.support_calls, set.asked.load(Ordering::Relaxed));
        if error.is_none() {
            assert!(answer.outcome == Outcome::Converged && upper - lower < widest * truth, "{truth} {lower} {upper}");
        }
    }
}

/// An extent of 1e15 was taken for the size: points that were NaN, direction 0, no bracket, and the set asked along 0.
#[test]
fn a_stated_extent_that_is_loose_costs_nothing() {
    octahedra::<f64, 3>(1, 1e-6);
    octahedra::<f32, 3>(2, 1e-4);
    octahedra::<f64, 2>(3, 1e-6);
    octahedra::<f32, 2>(4, 1e-4);
    octahedra::<f64, 4>(5, 1e-6);
    octahedra::<f32, 4>(6, 1e-3);
}

/// Bodies are measured by themselves.
#[test]
fn a_body_with_a_loose_extent() {
    for extent in [1e3, 1e9, 1e15, 1e30] {
        let set = Octahedron { axes: [1.0; 3], extent, error: None, asked: AtomicU32::new(0) };
        let cube = BoxShape::new(Vector::from([0.5; 3])).unwrap();
        let d = depth(&Body::at(&set, Vector::zeros()), &Body::at(&cube, Vector::from([1.25, 0.125, 0.0])));
        // The face of normal (1, 1, 0) / sqrt(2) is no face of the difference; along x it reaches 1.5.
        assert!(d.outcome == Outcome::Converged && d.lower <= 0.25 && 0.25 <= d.upper, "{d:?}");
    }
}

/// The smallest sizes in C had a floor of 1.5e-64 in their errors; the largest overflowed in a norm.
#[test]
fn cubes_of_any_size_the_format_has() {
    fn cubes<T: Real>(exponents: impl Iterator<Item = i32>, tolerance: f64) {
        for e in exponents {
            let s = T::of(10f64.powi(e));
            let cube = BoxShape::new(Vector::from([s; 3])).unwrap();
            let at = s * T::of(1.875);
            let d = depth(
                &Body::at(&cube, Vector::zeros()),
                &Body::at(&cube, Vector::from([at, s * T::of(0.125), T::zero()])),
            );
            let share = |x: T| (x / s).to_f64();
            let truth = s + s - at; // Exactly.
            assert!(d.lower <= truth && truth <= d.upper, "{e} {d:?}");
            assert!(share(d.upper - d.lower) <= tolerance && (d.normal.x.to_f64() - 1.0).abs() < 1e-5, "{e} {d:?}");
        }
    }
    cubes::<f64>((-140..=290).step_by(5), 1e-6);
    cubes::<f32>(-17..=30, 1e-4);
}

/// Translations whose squares overflow: apart, and the distance to rounding.
#[test]
fn cubes_at_any_distance() {
    let cube = BoxShape::new(Vector::from([1.0; 3])).unwrap();
    for e in (140..=300).step_by(4) {
        let far = 10f64.powi(e);
        let d = depth(&Body::at(&cube, Vector::zeros()), &Body::at(&cube, Vector::from([far, 0.0, 0.0])));
        assert!(
            d.outcome == Outcome::Separated
                && d.lower <= -far
                && -far * (1.0 + 1e-13) <= d.lower
                && d.upper <= -far * (1.0 - 1e-13),
            "{d:?}"
        );
        let beside =
            depth(&Body::at(&cube, Vector::from([far, 0.0, 0.0])), &Body::at(&cube, Vector::from([far, 1.5, 0.0])));
        assert!(beside.lower <= 0.5 && 0.5 <= beside.upper && beside.outcome == Outcome::Converged, "{beside:?}");
    }
}

/// A hull far away in its own frame, brought back by its pose: the bracket was right to 1e-14, the witnesses to 1e-7.
#[test]
fn witnesses_of_a_hull_far_from_its_frame() {
    let mut dice = Dice::new(13);
    for k in 0..150 {
        let far = 10f64.powf(dice.range(3.0, 9.0)).round();
        // Coordinates of a cube with edges of 2 that are exact, turned by 3-4-5 or a permutation.
        let corners: Vec<[f64; 3]> = (0..8)
            .map(|i| [far + 2.0 * (i & 1) as f64, -far + 2.0 * (i >> 1 & 1) as f64, 3.0 * far + 2.0 * (i >> 2) as f64])
            .collect();
        let hull = Points::new(&corners).unwrap();
        let turn = permutation::<f64>(k);
        let middle = turn * Vector3::new(far + 1.0, -far + 1.0, 3.0 * far + 1.0);
        let cube = BoxShape::new(Vector::from([1.0; 3])).unwrap();
        let offset = Vector3::new(1.5 + dice.below(16) as f64 / 64.0, 0.25, -0.5);
        let d = depth(&Body::new(&hull, turn, -middle).unwrap(), &Body::at(&cube, offset));
        check(&d, 2.0 - offset.x, 1e-12);
        let (a, b) = (d.point_a, d.point_b);
        let off = |p: &Vector<f64, 3>, c: &Vector3<f64>| (p - c).amax() - 1.0;
        assert!(off(&a, &Vector3::zeros()).abs() < 1e-12 && off(&b, &offset).abs() < 1e-12, "{far} {d:?}");
        assert!((a - b - d.normal * d.upper).amax() < 1e-9, "{far} {d:?}");
    }
}
