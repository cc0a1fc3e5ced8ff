//! Shallow contact in single precision: bodies of size 1 whose depth is a thousand roundoffs of their size. What the numbers given mean exactly is
//! computed in double precision.

use crate::common;

use common::dice::Dice;
use nalgebra::{Rotation2, Rotation3, SMatrix, Unit, Vector2, Vector3};
use qdist::support::{BoxShape, Capsule, Cone, Cylinder, Ellipsoid, Failure, Points, Sphere, Support};
use qdist::{Body, Options, Outcome, TwoWords, Workspace};

type Pose = (SMatrix<f32, 3, 3>, Vector3<f32>);

/// The numbers of a shape, as they are given.
enum Numbers {
    Box(Vector3<f32>),
    Hull(Vec<[f32; 3]>),
    Capsule(f32, f32),
    Cylinder(f32, f32),
    Cone(f32, f32),
    Ellipsoid(Vector3<f32>),
}

impl Numbers {
    fn random(rng: &mut Dice, kind: usize) -> Self {
        match kind {
            0 => Numbers::Box(Vector3::from_fn(|_, _| rng.range(0.3, 1.0) as f32)),
            1 => {
                let n = 4 + rng.below(36);
                Numbers::Hull((0..n).map(|_| direction(rng).map(|x| x as f32).into()).collect())
            }
            2 => Numbers::Capsule(rng.range(0.0, 0.01) as f32, rng.range(0.3, 1.0) as f32),
            3 => Numbers::Capsule(rng.range(0.2, 1.0) as f32, rng.range(0.3, 1.0) as f32),
            4 => Numbers::Capsule(rng.range(0.2, 1.0) as f32, 0.0),
            5 => Numbers::Cylinder(rng.range(0.3, 1.0) as f32, rng.range(0.3, 1.0) as f32),
            6 => Numbers::Cone(rng.range(0.3, 1.0) as f32, rng.range(0.3, 1.0) as f32),
            _ => Numbers::Ellipsoid(Vector3::from_fn(|_, _| rng.range(0.3, 1.0) as f32)),
        }
    }

    /// Calls with the shape in either precision.
    fn both<R>(
        &self,
        scale: f32,
        act: impl FnOnce(&(dyn Support<f32, 3> + Sync), &(dyn Support<f64, 3> + Sync)) -> R,
    ) -> R {
        match self {
            Numbers::Box(half) => {
                let half = half * scale;
                act(&BoxShape::new(half).unwrap(), &BoxShape::new(half.map(f64::from)).unwrap())
            }
            Numbers::Hull(points) => {
                let points: Vec<[f32; 3]> = points.iter().map(|p| p.map(|x| x * scale)).collect();
                let wide: Vec<[f64; 3]> = points.iter().map(|p| p.map(f64::from)).collect();
                act(&Points::new(&points).unwrap(), &Points::new(&wide).unwrap())
            }
            &Numbers::Capsule(radius, half) => {
                let (radius, half) = (radius * scale, half * scale);
                act(&Capsule::new(radius, half).unwrap(), &Capsule::new(f64::from(radius), f64::from(half)).unwrap())
            }
            &Numbers::Cylinder(radius, half) => {
                let (radius, half) = (radius * scale, half * scale);
                act(&Cylinder::new(radius, half).unwrap(), &Cylinder::new(f64::from(radius), f64::from(half)).unwrap())
            }
            &Numbers::Cone(radius, half) => {
                let (radius, half) = (radius * scale, half * scale);
                act(&Cone::new(radius, half).unwrap(), &Cone::new(f64::from(radius), f64::from(half)).unwrap())
            }
            Numbers::Ellipsoid(semi) => {
                let semi = semi * scale;
                act(&Ellipsoid::new(semi).unwrap(), &Ellipsoid::new(semi.map(f64::from)).unwrap())
            }
        }
    }
}

/// What stands on an axis.
#[derive(Clone, Copy, Debug)]
enum Round {
    Cylinder,
    Cone,
    Capsule,
    Sphere,
    Ellipsoid,
}

const PAIRS_ON_ONE_AXIS: [(Round, Round); 10] = [
    (Round::Cylinder, Round::Cylinder),
    (Round::Cylinder, Round::Cone),
    (Round::Cone, Round::Cylinder),
    (Round::Cylinder, Round::Capsule),
    (Round::Capsule, Round::Cone),
    (Round::Cylinder, Round::Sphere),
    (Round::Cone, Round::Sphere),
    (Round::Ellipsoid, Round::Cylinder),
    (Round::Cone, Round::Ellipsoid),
    (Round::Ellipsoid, Round::Ellipsoid),
];

impl Round {
    /// The shape and how far it reaches along the axis.
    fn random(self, rng: &mut Dice) -> (Numbers, f32) {
        let [radius, half] = [(); 2].map(|()| rng.range(0.3, 1.0) as f32);
        match self {
            Round::Cylinder => (Numbers::Cylinder(radius, half), half),
            Round::Cone => (Numbers::Cone(radius, half), half),
            Round::Capsule => (Numbers::Capsule(radius, half), radius + half),
            Round::Sphere => (Numbers::Capsule(radius, 0.0), radius),
            Round::Ellipsoid => (Numbers::Ellipsoid(Vector3::new(radius, radius, half)), half),
        }
    }
}

fn direction(rng: &mut Dice) -> Vector3<f64> {
    loop {
        let v = Vector3::from_fn(|_, _| rng.signed());
        if v.norm() > 0.1 && v.norm() < 1.0 {
            return v.normalize();
        }
    }
}

fn pose(rng: &mut Dice) -> Pose {
    let rotation = Rotation3::from_axis_angle(&Unit::new_normalize(direction(rng)), rng.range(0.0, 3.0));
    (rotation.matrix().map(|x| x as f32), Vector3::zeros())
}

fn exact(a: &(dyn Support<f64, 3> + Sync), at: &Pose, b: &(dyn Support<f64, 3> + Sync), bt: &Pose) -> (f64, f64) {
    let place = |set, pose: &Pose| Body::new(set, pose.0.map(f64::from), pose.1.map(f64::from)).map_err(drop);
    let (a, b) = (place(a, at).unwrap(), place(b, bt).unwrap());
    let mut memory = Box::new(Workspace::<f64, 3, 2048, 4096>::new());
    let depth = memory.solver().depth(&a, &b, &Options { relative: 1e-10, ..Options::default() });
    (depth.lower, depth.upper)
}

/// The last distance below `far` at which the bodies are as deep as wanted.
fn last(mut far: f64, is_deep: impl Fn(f64) -> bool) -> f64 {
    let mut near = 0.0;
    for _ in 0..60 {
        let middle = (near + far) / 2.0;
        if is_deep(middle) { near = middle } else { far = middle }
    }
    near
}

/// Of contacts of polyhedra of this size, so far from the origin of the world: how many were tried, and how many have a bracket as narrow as asked for.
/// All must be true.
fn converged(count: usize, scale: f32, offset: f32, depths: std::ops::Range<f64>) -> (usize, usize) {
    // (Two thin capsules have no cores to speak of, and cross in a point.)
    converged_of(count, scale, offset, depths, |number| ([0, 1, 3, 4, 0, 1][number % 6], number / 6 % 5))
}

/// The same of contacts of the kinds that `kinds` gives each number.
fn converged_of(
    count: usize,
    scale: f32,
    offset: f32,
    depths: std::ops::Range<f64>,
    kinds: impl Fn(usize) -> (usize, usize),
) -> (usize, usize) {
    let mut rng = Dice::new(7);
    let (mut tried, mut met) = (0, 0);
    for number in 0..count {
        let (first, second) = kinds(number);
        let (first, second) = (Numbers::random(&mut rng, first), Numbers::random(&mut rng, second));
        let (mut at, mut bt) = (pose(&mut rng), pose(&mut rng));
        at.1 = direction(&mut rng).map(|x| (x as f32) * offset * scale);
        let (along, wanted) = (direction(&mut rng), f64::from(scale) * rng.range(depths.start, depths.end));
        first.both(scale, |a, wide_a| {
            second.both(scale, |b, wide_b| {
                // Moved along until the depth is about what is wanted.
                let at_distance = |t: f64| at.1 + (along * t).map(|x| x as f32);
                let is_deep = |t| exact(wide_a, &at, wide_b, &(bt.0, at_distance(t))).0 > wanted;
                bt.1 = at_distance(last(4.0 * f64::from(scale), is_deep));
                let (lower, upper) = exact(wide_a, &at, wide_b, &bt);
                if lower < f64::from(scale) * depths.start {
                    return; // Not so deep anywhere.
                }
                tried += 1;
                let (body_a, body_b) = (Body::new(a, at.0, at.1).unwrap(), Body::new(b, bt.0, bt.1).unwrap());
                let mut memory = Workspace::<f32, 3, 64, 128>::new();
                let depth = memory.solver().depth(&body_a, &body_b, &Options::default());
                let (low, high) = (f64::from(depth.lower), f64::from(depth.upper));
                assert!(low <= upper && lower <= high, "{number}: [{low}, {high}] for [{lower}, {upper}]");
                met += usize::from(depth.outcome == Outcome::Converged);
                if depth.outcome != Outcome::Converged {
                    println!(
                        "{number}: {:?} [{low:e}, {high:e}] {:e} for {lower:e}, {} {}",
                        depth.outcome,
                        high - low,
                        depth.vertices,
                        depth.facets
                    );
                } else {
                    assert!(high - low <= 1e-4 * low, "{number}: [{low}, {high}]");
                }
            });
        });
    }
    (tried, met)
}

#[test]
fn shallow_contacts_of_polyhedra_converge_in_f32() {
    let (tried, met) = converged(300, 1.0, 0.0, 1e-3..1e-2);
    assert!(tried > 280 && met == tried, "{met} of {tried}");
}

/// Cylinders, cones and ellipsoids with each other and with all others.
#[test]
fn shallow_contacts_of_curved_bodies_converge_in_f32() {
    for first in 5..8 {
        for second in [0, 1, 3, 4, 5, 6, 7] {
            let (tried, met) = converged_of(30, 1.0, 0.0, 1e-3..1e-2, |_| (first, second));
            assert!(tried > 20 && met == tried, "{first} {second}: {met} of {tried}");
        }
    }
}

#[test]
fn in_any_unit() {
    for scale in [1e-12, 1e-4, 3e3, 1e12] {
        let (tried, met) = converged(60, scale, 0.0, 1e-3..1e-2);
        assert!(tried > 50 && met == tried, "{met} of {tried} at {scale}");
    }
}

#[test]
fn anywhere_in_the_world() {
    // A position of 100 is a number that is known to 4e-6; what it is, it is exactly.
    for offset in [10.0, 100.0] {
        let (tried, met) = converged(60, 1.0, offset, 1e-3..1e-2);
        assert!(tried > 50 && met == tried, "{met} of {tried} at {offset}");
    }
}

#[test]
fn polygons_in_the_plane() {
    let mut rng = Dice::new(11);
    for number in 0..200 {
        let half = |rng: &mut Dice| Vector2::from_fn(|_, _| rng.range(0.3, 1.0) as f32);
        let (a, b) = (half(&mut rng), half(&mut rng));
        let turn = |rng: &mut Dice| Rotation2::new(rng.range(0.0, 6.0)).matrix().map(|x| x as f32);
        let (turn_a, turn_b) = (turn(&mut rng), turn(&mut rng));
        let along = Rotation2::new(rng.range(0.0, 6.0)) * Vector2::x();
        let depth = |t: f64| {
            let boxes = (BoxShape::new(a.map(f64::from)).unwrap(), BoxShape::new(b.map(f64::from)).unwrap());
            let at = (along * t).map(|x| f64::from(x as f32));
            let body_a = Body::new(&boxes.0, turn_a.map(f64::from), Vector2::zeros()).unwrap();
            let body_b = Body::new(&boxes.1, turn_b.map(f64::from), at).unwrap();
            Workspace::<f64, 2, 16, 16>::new().solver().depth(&body_a, &body_b, &Options::default())
        };
        let near = last(4.0, |t| depth(t).lower > 2e-3);
        let truth = depth(near);
        let boxes = (BoxShape::new(a).unwrap(), BoxShape::new(b).unwrap());
        let body_a = Body::new(&boxes.0, turn_a, Vector2::zeros()).unwrap();
        let body_b = Body::new(&boxes.1, turn_b, (along * near).map(|x| x as f32)).unwrap();
        let found = Workspace::<f32, 2, 16, 16>::new().solver().depth(&body_a, &body_b, &Options::default());
        let (low, high) = (f64::from(found.lower), f64::from(found.upper));
        assert!(low <= truth.upper && truth.lower <= high, "{number}: {found:?} for {truth:?}");
        assert_eq!(found.outcome, Outcome::Converged, "{number}: {found:?} for {truth:?}");
    }
}

/// The disc's nearest point of the box is an end of a short side; rounding tilts that side, and the foot falls inside of it. Levelled, the side's
/// line is nearer.
#[test]
fn the_end_of_a_short_side() {
    let mut rng = Dice::new(3);
    let half = Vector2::new(0.5f32, 1.5e-4);
    let (thin, disc) = (BoxShape::new(half).unwrap(), Sphere::new(1.0f32).unwrap());
    let wide = (BoxShape::new(half.map(f64::from)).unwrap(), Sphere::new(1.0f64).unwrap());
    for number in 0..4000 {
        let angle = rng.range(0.0, 6.0);
        let turn = Rotation2::new(angle).matrix().map(|x| x as f32);
        let local = Vector2::new(0.5 + 0.999, 1.5e-4 + rng.range(0.0, 1.2e-4));
        let at = (Rotation2::new(angle) * local).map(|x| x as f32);
        let guess = (Rotation2::new(angle) * Vector2::new(1.0, -0.1)).map(|x| x as f32);
        let (a, b) = (Body::new(&thin, turn, Vector2::zeros()).unwrap(), Body::at(&disc, at));
        let options = Options { guess: Some(guess), ..Options::default() };
        let found = Workspace::<f32, 2, 16, 16>::new().solver().depth(&a, &b, &options);
        let a = Body::new(&wide.0, turn.map(f64::from), Vector2::zeros()).unwrap();
        let b = Body::at(&wide.1, at.map(f64::from));
        let truth = Workspace::<f64, 2, 16, 16>::new().solver().depth(&a, &b, &Options::default());
        let (low, high) = (f64::from(found.lower), f64::from(found.upper));
        assert!(low <= truth.upper && truth.lower <= high, "{number}: {found:?} for {truth:?}");
    }
}

/// Points of a small round body that are next to each other round to one vertex: its height is that of the point that was asked for, not of the one that is
/// remembered for all. The sphere inside and the one around the ellipsoid bound the depth.
#[test]
fn round_bodies_that_are_small_for_their_place() {
    let check =
        |radius: f32, semi: [f32; 3], rotation: SMatrix<f32, 3, 3>, at: Vector3<f32>, options: &Options<'_, f32, 3>| {
            let (sphere, egg) = (Sphere::<f32, 3>::new(radius).unwrap(), Ellipsoid::new(Vector3::from(semi)).unwrap());
            let (a, b) = (Body::at(&sphere, Vector3::zeros()), Body::new(&egg, rotation, at).unwrap());
            let depth = Workspace::<f32, 3, 64, 128>::new().solver().depth(&a, &b, options);
            let between = f64::from(radius) - at.map(f64::from).norm();
            // (The matrix is a rotation to some roundoffs.)
            let [least, most] = [f32::min, f32::max].map(|pick| f64::from(semi.into_iter().reduce(pick).unwrap()));
            let (least, most) = (between + least * (1.0 - 3e-7), between + most * (1.0 + 3e-7));
            assert!(
                f64::from(depth.lower) <= most && least <= f64::from(depth.upper),
                "{depth:?} for [{least:e}, {most:e}], {semi:?}"
            );
        };
    let rotation = SMatrix::<f32, 3, 3>::from_row_slice(&[
        -0.11731569,
        -0.9552166,
        -0.27165842,
        0.9683879,
        -0.1706714,
        0.18192358,
        -0.22014076,
        -0.24172822,
        0.9450426,
    ]);
    let guess = Some(Vector3::new(-0.17600076, -0.5737401, -0.79990375));
    let options = Options { relative: 1.0635787e-3, guess, ..Options::default() };
    let at = Vector3::new(-0.12892392, 0.54900455, -0.649243);
    check(0.859988, [0.00013625942, 0.00013625938, 0.00013625942], rotation, at, &options);
    let mut rng = Dice::new(13);
    for _ in 0..3000 {
        let (radius, size) = (rng.range(0.3, 1.0), rng.decade(-5.0, -1.0));
        let depth = size * rng.decade(-3.0, 0.0);
        let at = (direction(&mut rng) * (radius + size - depth)).map(|x| x as f32);
        let flat = 1.0 - rng.decade(-7.0, -4.0);
        let options = Options { relative: rng.decade(-4.0, -2.0) as f32, ..Options::default() };
        let (rotation, _) = pose(&mut rng);
        check(radius as f32, [size as f32, (size * flat) as f32, size as f32], rotation, at, &options);
    }
}

/// A set that knows itself in two words along some directions only, and takes shortcuts that fall short.
struct Forgetful<'a> {
    whole: &'a (dyn Support<f32, 3> + Sync),
    /// Along directions below this it tells nothing, or NaN.
    below: f32,
    nan: bool,
    short: f32,
}

impl Support<f32, 3> for Forgetful<'_> {
    fn support(&self, u: &Vector3<f32>) -> Result<Vector3<f32>, Failure> {
        Ok(self.whole.support(u)? * self.short)
    }
    fn exhaustive(&self, u: &Vector3<f32>) -> Result<(Vector3<f32>, Vector3<f32>), Failure> {
        self.whole.exhaustive(u)
    }
    fn has_shortcuts(&self) -> bool {
        true
    }
    fn radius(&self) -> f32 {
        self.whole.radius()
    }
    fn rolling_radius(&self) -> f32 {
        self.whole.rolling_radius()
    }
    fn extent(&self) -> f32 {
        self.whole.extent()
    }
    fn error(&self) -> f32 {
        self.whole.error()
    }
    fn support_in_two_words(&self, u: &TwoWords<f32, 3>) -> Option<TwoWords<f32, 3>> {
        let along = u.high.z / u.high.norm();
        match along < self.below {
            true if self.nan => Some(TwoWords::from(Vector3::repeat(f32::NAN))),
            true => None,
            false => self.whole.support_in_two_words(u),
        }
    }
}

/// Where a point is not told in two words after all, what one word has found stands: not a shortcut's point in its place, nor one of another core.
#[test]
fn bodies_that_do_not_always_tell_their_points_in_two_words() {
    let mut rng = Dice::new(17);
    let mut tried = 0;
    for number in 0..400 {
        let (first, second) = ([7, 0, 5][number % 3], [0, 7, 4, 6][number % 4]);
        let (first, second) = (Numbers::random(&mut rng, first), Numbers::random(&mut rng, second));
        let (at, mut bt) = (pose(&mut rng), pose(&mut rng));
        let along = direction(&mut rng);
        let (below, nan, short) = (rng.signed() as f32, number % 2 == 0, [1.0, 0.999][number / 2 % 2]);
        first.both(1.0, |a, wide_a| {
            second.both(1.0, |b, wide_b| {
                let at_distance = |t: f64| (along * t).map(|x| x as f32);
                bt.1 = at_distance(last(4.0, |t| exact(wide_a, &at, wide_b, &(bt.0, at_distance(t))).0 > 2e-3));
                let (lower, upper) = exact(wide_a, &at, wide_b, &bt);
                let forgetful = Forgetful { whole: a, below, nan, short };
                let (body_a, body_b) = (Body::new(&forgetful, at.0, at.1).unwrap(), Body::new(b, bt.0, bt.1).unwrap());
                let depth = Workspace::<f32, 3, 64, 128>::new().solver().depth(&body_a, &body_b, &Options::default());
                let (low, high) = (f64::from(depth.lower), f64::from(depth.upper));
                assert!(low <= upper && lower <= high, "{number}: [{low}, {high}] for [{lower}, {upper}], {depth:?}");
                assert_eq!(depth.failure, None, "{number}: {depth:?}");
                tried += 1;
            });
        });
    }
    assert_eq!(tried, 400);
}

/// Bodies of revolution on one axis, one on top of the other: the plane search leaves what one word does not tell to expansion in two.
#[test]
fn bodies_of_revolution_on_one_axis() {
    let mut rng = Dice::new(19);
    let (mut tried, mut open) = (0, Vec::new());
    for number in 0..720 {
        let (first, second) = PAIRS_ON_ONE_AXIS[number % PAIRS_ON_ONE_AXIS.len()];
        let ((a, top), (b, bottom)) = (first.random(&mut rng), second.random(&mut rng));
        // Along an axis of the world, or along any: then the numbers are of one axis up to rounding.
        let turn = if number % 3 == 0 { pose(&mut rng).0 } else { SMatrix::identity() };
        let height = f64::from(top) + f64::from(bottom) - rng.range(1e-3, 1e-2);
        let (at, bt) =
            ((turn, Vector3::zeros()), (turn, (turn.map(f64::from) * Vector3::z() * height).map(|x| x as f32)));
        a.both(1.0, |a, wide_a| {
            b.both(1.0, |b, wide_b| {
                let (lower, upper) = exact(wide_a, &at, wide_b, &bt);
                if lower < 1e-3 {
                    return;
                }
                tried += 1;
                let (a, b) = (Body::new(a, at.0, at.1).unwrap(), Body::new(b, bt.0, bt.1).unwrap());
                let found = Workspace::<f32, 3, 64, 128>::new().solver().depth(&a, &b, &Options::default());
                let (low, high) = (f64::from(found.lower), f64::from(found.upper));
                assert!(low <= upper && lower <= high, "{number}: [{low}, {high}] for [{lower}, {upper}]");
                if found.outcome != Outcome::Converged {
                    open.push((number, first, second, found.outcome, low, high));
                }
            });
        });
    }
    assert!(tried > 500 && open.is_empty(), "{} of {tried}: {open:?}", open.len());
}

/// Two cones, tip to tip: a whole circle of directions is the least, which expansion cannot tile, and their plane knows one word. The bracket is true, and
/// some roundoffs of the bodies' size wide.
#[test]
fn tips_of_cones_on_one_axis() {
    let mut rng = Dice::new(23);
    let over = SMatrix::<f32, 3, 3>::from_diagonal(&Vector3::new(1.0, -1.0, -1.0));
    for number in 0..200 {
        let ((a, top), (b, bottom)) = (Round::Cone.random(&mut rng), Round::Cone.random(&mut rng));
        let height = top + bottom - rng.range(2e-3, 2e-2) as f32;
        let (at, bt) = ((SMatrix::identity(), Vector3::zeros()), (over, Vector3::new(0.0, 0.0, height)));
        a.both(1.0, |a, wide_a| {
            b.both(1.0, |b, wide_b| {
                let (lower, upper) = exact(wide_a, &at, wide_b, &bt);
                let (a, b) = (Body::new(a, at.0, at.1).unwrap(), Body::new(b, bt.0, bt.1).unwrap());
                let found = Workspace::<f32, 3, 64, 128>::new().solver().depth(&a, &b, &Options::default());
                let (low, high) = (f64::from(found.lower), f64::from(found.upper));
                assert!(low <= upper && lower <= high, "{number}: [{low}, {high}] for [{lower}, {upper}]");
                assert!(high - low < 3e-5, "{number}: {found:?}");
            });
        });
    }
}

/// Long thin cylinders in one another: the plane's bracket stays, in any memory. Expansion would tile the circle, for nothing in a small one.
#[test]
fn a_circle_of_minimisers_is_not_tiled() {
    let thin = [0.01, 0.013].map(|radius| Cylinder::new(radius, 1.0f32).unwrap());
    let truth = f64::from(0.01f32) + f64::from(0.013f32);
    let (a, b) = (Body::at(&thin[0], Vector3::zeros()), Body::at(&thin[1], Vector3::zeros()));
    let options = Options::default();
    let small = Workspace::<f32, 3, 64, 128>::new().solver().depth(&a, &b, &options);
    let mut large = Box::new(Workspace::<f32, 3, 1024, 2048>::new());
    let large = large.solver().depth(&a, &b, &options);
    assert!(f64::from(small.lower) <= truth && truth <= f64::from(small.upper), "{small:?}");
    assert!(small.upper - small.lower < 2e-5 && small.iterations < 8, "{small:?}");
    assert_eq!(small, large);
}
