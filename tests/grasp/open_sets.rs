//! Sets with the origin on their boundary, open grasps above all; and polytopal Q of any number of vertices. Truths are closed forms, brute
//! force over Q's vertices, and the least contact forces of `ForceSolver`.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use common::memory::Memory;
use grasp_common::random_contact;
use nalgebra::SMatrix;
use qdist::grasp::{
    Contact, ForceOptions, ForceOutcome, ForceSolver, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches,
};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, Vertices};
use qdist::support::{BoxShape, Failure, Points, Support};
use qdist::{Answer, Options, Outcome, Real, Vector};
use std::cell::Cell;

/// Contacts that all press to one side of a plane through the reference point: an open grasp.
fn open_grasp(dice: &mut Dice, count: usize) -> Vec<Primitive<f64>> {
    let frame = WrenchFrame::new(Vector::zeros(), 1.0).unwrap();
    let side = Vector::<f64, 3>::from(dice.direction::<3>());
    let mut contacts = Vec::new();
    while contacts.len() < count {
        let contact = random_contact::<f64>(dice, 1.0);
        // The whole friction cone to one side: n.s > mu |n x s|.
        let (along, mu) = (contact.normal().dot(&side), contact.friction().coefficients().0);
        if along > 1.05 * mu * (1.0 - along * along).max(0.0).sqrt() && along > 0.05 {
            contacts.push(contact);
        }
    }
    let mut memory = vec![Primitive::empty(); count];
    wrenches(&contacts, &frame, &mut memory).unwrap().to_vec()
}

fn units() -> Vec<Box<dyn UnitSet<f64, 6>>> {
    let axes = Vector::from([1.0, 2.0, 0.5, 1.0, 1.0, 3.0]);
    vec![
        Box::new(Ball::unit()),
        Box::new(UnitEllipsoid::new(axes, SMatrix::identity()).unwrap()),
        Box::new(UnitBox::new(axes).unwrap()),
        Box::new(CrossPolytope::new(axes).unwrap()),
    ]
}

/// Six dimensions and a Q around the origin: the height 0 is met within a few points, and there is nothing more to be found out. (The memory was
/// filled first: 109 points and 4,000 facets in the median.)
#[test]
fn an_open_grasp_costs_no_more_than_its_proof() {
    let mut dice = Dice::new(20);
    let mut memory = Memory::new::<f64, 6>(512, 4000);
    let mut calls = Vec::new();
    for case in 0..100 {
        let primitives = open_grasp(&mut dice, 2 + case % 6);
        for norm in [Norm::L1, Norm::LInf] {
            let w = WrenchSet::new(&primitives, norm);
            for q in units() {
                let answer = memory.solver::<f64, 6>().solve(&w, &*q, &Options::default());
                assert!(answer.lower == 0.0 && answer.upper >= 0.0, "{case} {:e} {:e}", answer.lower, answer.upper);
                assert!(answer.upper <= 1e-12 * w.extent().max(1.0), "{case} {:e}", answer.upper);
                let outcome = answer.outcome;
                assert!(matches!(outcome, Outcome::Touching | Outcome::Degenerate), "{case} {outcome:?}");
                // (The first simplex has 7 facets. Seven contacts, as wide as a half space nearly, may take more.)
                assert!(answer.facets <= 7 || case % 6 == 5, "{case} {answer:?}");
                calls.push(answer.support_calls);
            }
        }
    }
    calls.sort_unstable();
    assert!(calls[calls.len() / 2] <= 20 && calls[calls.len() - 1] <= 40, "{:?}", &calls[calls.len() * 9 / 10..]);
}

/// A set like another one that does not tell that it contains the origin.
struct Silent<'a>(&'a dyn Support<f64, 6>);

impl Support<f64, 6> for Silent<'_> {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        self.0.support(u)
    }
    fn extent(&self) -> f64 {
        self.0.extent()
    }
    fn error(&self) -> f64 {
        self.0.error()
    }
}

/// Without the set's word the nearest point shows how far below 0 d may be: by no more than rounding.
/// "Is it at least 0, or less?" is known before anything is asked.
#[test]
fn a_threshold_that_no_open_grasp_can_miss() {
    let mut dice = Dice::new(23);
    let mut memory = Memory::new::<f64, 6>(512, 4000);
    for case in 0..100 {
        let primitives = open_grasp(&mut dice, 2 + case % 6);
        let w = WrenchSet::new(&primitives, if case % 2 == 0 { Norm::L1 } else { Norm::LInf });
        for q in units() {
            for threshold in [0.0, -1e-3] {
                let options = Options { threshold: Some(threshold), ..Options::default() };
                let answer = memory.solver::<f64, 6>().solve(&w, &*q, &options);
                assert_eq!(answer.outcome, Outcome::Above, "{case} {threshold}");
                assert!(answer.lower == 0.0 && answer.upper >= 0.0, "{case} {:e} {:e}", answer.lower, answer.upper);
                assert!(answer.support_calls <= 16, "{case} {threshold}: {}", answer.support_calls);
            }
        }
    }
}

#[test]
fn an_open_grasp_that_does_not_tell() {
    let mut dice = Dice::new(21);
    let mut memory = Memory::new::<f64, 6>(512, 4000);
    for case in 0..100 {
        let primitives = open_grasp(&mut dice, 2 + case % 6);
        let w = WrenchSet::new(&primitives, Norm::LInf);
        for q in units() {
            let answer = memory.solver::<f64, 6>().solve(&Silent(&w), &*q, &Options::default());
            let size = w.extent().max(1.0);
            assert!(answer.lower <= 0.0 && answer.upper >= 0.0, "{case} {:e} {:e}", answer.lower, answer.upper);
            assert!(answer.upper <= 1e-12 * size, "{case} {:e}", answer.upper);
            assert!(answer.lower >= -1e-6 * size && answer.support_calls < 1000, "{case} {:e}", answer.lower);
        }
    }
}

/// A segment asks for its own direction only: how large one wrench may be, although the grasp resists others not at all. (The answer
/// was 0 <= d, after 50,000 points.)
#[test]
fn one_wrench_of_an_open_grasp() {
    let mut dice = Dice::new(22);
    let mut memory = Memory::new::<f64, 6>(512, 4000);
    let (mut inside, mut outside, mut narrow) = (0, 0, 0);
    for case in 0..100 {
        let primitives = open_grasp(&mut dice, 3 + case % 5);
        for norm in [Norm::L1, Norm::LInf] {
            let w = WrenchSet::new(&primitives, norm);
            // Halfway to a mean of random points of W, and somewhere else.
            let mut mean = Vector::<f64, 6>::zeros();
            for _ in 0..12 {
                mean += w.support(&Vector::from(dice.direction::<6>())).unwrap() / 24.0;
            }
            for end in [mean, Vector::from(dice.direction::<6>())] {
                let Ok(q) = Segment::new(end) else { continue };
                let answer = memory.solver::<f64, 6>().solve(&w, &q, &Options::default());
                assert!(answer.support_calls < 5000, "{case} {}", answer.support_calls);
                assert!(answer.lower >= 0.0 && answer.lower <= answer.upper);
                let mut shares = vec![Vector::zeros(); primitives.len()];
                let options = ForceOptions::default();
                let forces = ForceSolver::new().resist(&w, &-end, &options, &mut shares).unwrap();
                // The size of forces that exert the wrench is 1 / d.
                match forces.outcome {
                    ForceOutcome::Converged => {
                        inside += 1;
                        let (least, most) = (1.0 / forces.upper, 1.0 / forces.lower);
                        assert!(answer.lower <= most * (1.0 + 1e-7), "{case} {} {most}", answer.lower);
                        assert!(answer.upper >= least * (1.0 - 1e-7), "{case} {} {least}", answer.upper);
                        assert!(
                            answer.upper <= most * (1.0 + 1e-5),
                            "{case} {} {most} {:?} {:?} {}",
                            answer.upper,
                            answer.outcome,
                            answer.plan,
                            answer.lower
                        );
                        narrow += u32::from(answer.upper - answer.lower <= 1e-5 * answer.upper);
                    }
                    ForceOutcome::NotResistible => {
                        outside += 1;
                        assert!(answer.upper <= 1e-8 * w.extent() / end.norm(), "{case} {:e}", answer.upper);
                    }
                    _ => {}
                }
            }
        }
    }
    assert!(inside >= 100 && outside >= 50, "{inside} {outside}");
    // (Others run along the boundary of W: how much of them is in W is not for arithmetic to tell.)
    assert!(f64::from(narrow) >= 0.9 * f64::from(inside), "{narrow} of {inside}");
}

/// d > 0, however small: as long as arithmetic can tell it from 0, so do we.
#[test]
fn nearly_open_sets_are_told_from_open_ones() {
    let mut memory = Memory::new::<f64, 3>(256, 512);
    for exponent in 1..16 {
        let d = 0.1f64.powi(exponent);
        let points = [[-1.0, -1.0, -d], [1.0, -1.0, -d], [0.0, 1.0, -d], [0.0, 0.0, 1.0]];
        let set = Points::new(&points).unwrap();
        for q in
            [Box::new(Ball::unit()) as Box<dyn UnitSet<f64, 3>>, Box::new(UnitBox::new(Vector::repeat(1.0)).unwrap())]
        {
            let answer = memory.solver::<f64, 3>().solve(&set, &*q, &Options::default());
            assert!(answer.lower <= d && d <= answer.upper, "{d:e} {:e} {:e}", answer.lower, answer.upper);
            assert!(exponent > 12 || answer.lower > 0.5 * d, "{d:e} {:e} {:e}", answer.lower, answer.upper);
        }
    }
}

/// Vertices on a sphere around the origin.
fn sphere<const N: usize>(dice: &mut Dice, count: usize) -> Vec<[f64; N]> {
    (0..count).map(|_| dice.direction::<N>().map(|x| 0.3 * x)).collect()
}

/// d of the octahedron |x|_1 <= 1 and of a box, by brute force: the least over Q's vertices.
fn many_vertices<const N: usize>(seed: u64) {
    let mut dice = Dice::new(seed);
    let octahedron: Vec<[f64; N]> = (0..2 * N)
        .map(|k| std::array::from_fn(|i| if i != k / 2 { 0.0 } else { 1.0 - 2.0 * (k % 2) as f64 }))
        .collect();
    let octahedron = Points::new(&octahedron).unwrap();
    let half = Vector::<f64, N>::from_fn(|i, _| 1.0 + 0.3 * i as f64);
    let cuboid = BoxShape::new(half).unwrap();
    let mut memory = Memory::new::<f64, N>(512, 4000);
    for (count, most) in [(4, 800), (64, 800), (1000, 800), (20_000, 800)] {
        for _ in 0..if count > 5000 { 1 } else { 9 } {
            let vertices = sphere::<N>(&mut dice, count);
            let q = Vertices::new(&vertices).unwrap();
            let sum = |v: &[f64; N]| v.iter().map(|x| x.abs()).sum::<f64>();
            let part = |v: &[f64; N]| (0..N).map(|i| v[i].abs() / half[i]).fold(0.0, f64::max);
            let d = 1.0 / vertices.iter().map(sum).fold(0.0, f64::max);
            let answer = memory.solver::<f64, N>().solve(&octahedron, &q, &Options::default());
            assert!(answer.lower <= d * (1.0 + 1e-15) && d <= answer.upper * (1.0 + 1e-15));
            assert_eq!(answer.outcome, Outcome::Converged);
            assert!(answer.support_calls <= most, "{N} {count} {}", answer.support_calls);
            let d = 1.0 / vertices.iter().map(part).fold(0.0, f64::max);
            let answer = memory.solver::<f64, N>().solve(&cuboid, &q, &Options::default());
            assert!(answer.lower <= d * (1.0 + 1e-15) && d <= answer.upper * (1.0 + 1e-15));
            assert_eq!(answer.outcome, Outcome::Converged);
            assert!(answer.support_calls <= most, "{N} {count} {}", answer.support_calls);
        }
    }
}

/// Rays at thousands of vertices took a second where expansion takes a millisecond.
#[test]
fn a_polytopal_q_of_many_vertices_is_not_left_to_rays() {
    many_vertices::<2>(3);
    many_vertices::<3>(4);
    many_vertices::<6>(5);
}

/// Vertices that are the origin, and one that is not: the deadline was never asked.
struct Nothing(usize);

impl UnitSet<f64, 3> for Nothing {
    fn value(&self, u: &Vector<f64, 3>) -> Result<f64, Failure> {
        Ok((0.1 * u.x).max(0.0))
    }
    fn vertex_count(&self) -> usize {
        self.0
    }
    fn vertex(&self, index: usize) -> Vector<f64, 3> {
        Vector::from([if index == 0 { 0.1 } else { 0.0 }, 0.0, 0.0])
    }
    fn error(&self) -> f64 {
        1e-16
    }
}

#[test]
fn the_deadline_is_asked_between_vertices_that_are_the_origin() {
    let cuboid = BoxShape::new(Vector::from([1.0, 1.0, 1.0])).unwrap();
    let mut memory = Memory::new::<f64, 3>(64, 128);
    let asked = Cell::new(0);
    let expire = || {
        asked.set(asked.get() + 1);
        asked.get() > 100
    };
    let options = Options { interrupt: Some(&expire), ..Options::default() };
    let q = Nothing(100_000_000);
    let answer = memory.solver::<f64, 3>().solve(&cuboid, &q, &options);
    assert!(answer.lower <= 10.0 && 10.0 <= answer.upper * (1.0 + 1e-12));
    assert!(answer.outcome == Outcome::Interrupted || answer.outcome == Outcome::Converged);
    // Memory without room for a polytope leaves it to the rays, which have nothing but zeros to look at.
    asked.set(0);
    let mut least = Memory::least::<f64, 3>();
    let answer = least.solver::<f64, 3>().solve(&cuboid, &q, &options);
    assert!(answer.lower <= 10.0 && 10.0 <= answer.upper * (1.0 + 1e-12));
    assert_eq!(answer.outcome, Outcome::Interrupted);
    // Many of the same vertex.
    let many = vec![[0.1, 0.05, 0.0]; 1_000_000];
    let q = Vertices::new(&many).unwrap();
    asked.set(0);
    let answer = memory.solver::<f64, 3>().solve(&cuboid, &q, &options);
    assert!(answer.lower <= 10.0 && 10.0 <= answer.upper * (1.0 + 1e-12), "{} {}", answer.lower, answer.upper);
}

/// In single precision the share of a segment that is in an open grasp's set is often not told from below: then the query ends as soon as the upper end is as
/// good as asked for, in any memory. (Cone by cone it went on for 50,000 points around an origin that is on the boundary.)
#[test]
fn a_segment_whose_lower_end_one_word_does_not_tell() {
    let named = [
        Touch {
            p: [-0.045_778_31, 0.436_059_65, -0.828_758_54],
            n: [0.975_249, 0.199_921_15, 0.094_450_83],
            mu: 0.871_334,
            mus: 0.119_028_956,
        },
        Touch {
            p: [0.593_330_6, 0.632_736_86, 0.028_138_986],
            n: [0.967_059_7, -0.236_582_01, 0.093_938_716],
            mu: 0.313_708_16,
            mus: 0.150_534_96,
        },
    ];
    let end = Vector::from([0.466_561_56, 0.138_285_73, -0.015_837_226, 0.143_333_78, -0.325_014_92, -0.253_310_4]);
    let primitives = named.map(|touch| touch.primitive::<f32>());
    let answer = segment(&WrenchSet::new(&primitives, Norm::L1), end, &Options::default());
    assert!(answer.lower <= 2.021_08 && answer.upper >= 2.020_21 && answer.upper <= 2.022, "{answer:?}");
    let mut told = 0;
    for case in 0..100 {
        let touches = to_one_side(&mut Dice::new(case), 2 + case as usize % 4);
        let primitives: Vec<_> = touches.iter().map(Touch::primitive::<f32>).collect();
        let wide: Vec<_> = touches.iter().map(Touch::primitive::<f64>).collect();
        for norm in [Norm::L1, Norm::LInf] {
            let w = WrenchSet::new(&primitives, norm);
            let end = halfway(&w, &mut Dice::new(1000 + case));
            let answer = segment(&w, end, &Options::default());
            // The size of forces that exert the wrench is 1 / d.
            let mut shares = vec![Vector::zeros(); wide.len()];
            let opposite = -end.map(f64::from);
            let forces = ForceSolver::new()
                .resist(&WrenchSet::new(&wide, norm), &opposite, &ForceOptions::default(), &mut shares)
                .unwrap();
            if forces.outcome == ForceOutcome::Converged {
                let (least, most) = (1.0 / forces.upper, 1.0 / forces.lower);
                told += 1;
                assert!(f64::from(answer.lower) <= most * (1.0 + 1e-5), "{case} {norm:?} {most} {answer:?}");
                assert!(f64::from(answer.upper) >= least * (1.0 - 1e-5), "{case} {norm:?} {least} {answer:?}");
                assert!(f64::from(answer.upper) <= most * (1.0 + 1e-3), "{case} {norm:?} {most} {answer:?}");
            }
        }
    }
    assert!(told >= 150, "{told}");
}

/// A soft contact of numbers that both formats have.
struct Touch {
    p: [f32; 3],
    n: [f32; 3],
    mu: f32,
    mus: f32,
}

impl Touch {
    fn primitive<T: Real>(&self) -> Primitive<T> {
        let wide = |x: [f32; 3]| Vector::from(x.map(|x| T::of(x.into())));
        let friction = Friction::Soft { mu: T::of(self.mu.into()), mus: T::of(self.mus.into()) };
        let n = wide(self.n);
        let contact = Contact::new(wide(self.p), n / n.norm(), friction).unwrap();
        Primitive::passive(&contact, &WrenchFrame::new(Vector::zeros(), T::one()).unwrap()).unwrap()
    }
}

/// Contacts that all press towards x.
fn to_one_side(dice: &mut Dice, count: usize) -> Vec<Touch> {
    let mut random = |scale: f64| dice.direction::<3>().map(|x| (x * scale) as f32);
    (0..count)
        .map(|_| {
            let (p, lean) = (random(1.0), random(0.5));
            Touch { p, n: [1.0 + lean[0], lean[1], lean[2]], mu: 0.3, mus: 0.1 }
        })
        .collect()
}

/// Halfway to a mean of random points of W.
fn halfway(w: &WrenchSet<'_, f32>, dice: &mut Dice) -> Vector<f32, 6> {
    (0..12).map(|_| w.support(&Vector::from(dice.direction::<6>().map(|x| x as f32))).unwrap() / 24.0).sum()
}

/// How much of a segment is in W.
fn segment(w: &WrenchSet<'_, f32>, end: Vector<f32, 6>, options: &Options<'_, f32, 6>) -> Answer<f32, 6> {
    let q = Segment::new(end).unwrap();
    let answer = Memory::new::<f32, 6>(64, 2048).solver::<f32, 6>().solve(w, &q, options);
    assert!(answer.lower >= 0.0 && answer.lower <= answer.upper && answer.iterations < 5000, "{answer:?}");
    answer
}

/// Outcome `precision` says that more steps tell no more. A limit that was met while rays measured what rounding costs was told so, too.
#[test]
fn a_limit_is_told_as_one() {
    let mut cut = 0;
    for case in 0..12 {
        let touches = to_one_side(&mut Dice::new(case), 2 + case as usize % 4);
        let primitives: Vec<_> = touches.iter().map(Touch::primitive::<f32>).collect();
        let w = WrenchSet::new(&primitives, Norm::L1);
        let end = halfway(&w, &mut Dice::new(1000 + case));
        let whole = segment(&w, end, &Options { max_iterations: Some(40_000), ..Options::default() });
        for limit in 1..whole.iterations {
            let answer = segment(&w, end, &Options { max_iterations: Some(limit), ..Options::default() });
            let asked = Cell::new(0);
            let expire = || {
                asked.set(asked.get() + 1);
                asked.get() > limit
            };
            let late = segment(&w, end, &Options { interrupt: Some(&expire), ..Options::default() });
            for answer in [answer, late] {
                cut += u32::from(matches!(answer.outcome, Outcome::Iterations | Outcome::Interrupted));
                let same = answer.lower == whole.lower && answer.upper <= whole.upper * (1.0 + 1e-5);
                assert!(
                    answer.outcome != Outcome::Precision || same,
                    "{case} {limit}: {:?}",
                    [&answer, &whole].map(|a| (a.lower, a.upper, a.outcome, a.iterations, a.plan))
                );
            }
        }
    }
    assert!(cut > 100, "{cut}");
}
