//! Boxes by their axes, against the same mathematics in double-double, written out without thought of cost: all faces where boxes overlap, all
//! corners, edges and faces of A - B where they do not.

use crate::common;

use common::dd::{Dd, V3, add, cross, dot, norm, scale, sub, v3};
use common::dice::Dice;
use nalgebra::{Matrix3, Vector3};
use qdist::support::BoxShape;
use qdist::{Body, Depth, Options, Outcome, Real, Workspace};

/// Two boxes, as numbers of the scalar under test.
#[derive(Clone, Debug)]
struct Pair {
    half: [[f64; 3]; 2],
    turn: [[[f64; 3]; 3]; 2],
    place: [[f64; 3]; 2],
}

impl Pair {
    /// What the scalar makes of the numbers.
    fn rounded<T: Real>(mut self) -> Self {
        let round = |x: &mut f64| *x = T::of(*x).to_f64();
        self.half.iter_mut().chain(&mut self.place).flatten().for_each(round);
        self.turn.iter_mut().flatten().flatten().for_each(round);
        self
    }

    fn size(&self) -> f64 {
        self.half.iter().chain(&self.place).flatten().map(|x| x.abs()).sum()
    }

    /// Half edges of A - B, and its centre.
    fn zonotope(&self) -> ([V3; 6], V3) {
        let edge = |k: usize| {
            let (body, j) = (k / 3, k % 3);
            std::array::from_fn(|i| Dd::product(self.turn[body][i][j], self.half[body][j]))
        };
        (std::array::from_fn(edge), sub(&v3(self.place[0]), &v3(self.place[1])))
    }

    /// The depth, to some 25 digits of the size.
    fn truth(&self) -> f64 {
        let (edges, center) = self.zonotope();
        let column = |k: usize| v3(std::array::from_fn(|i| self.turn[k / 3][i][k % 3]));
        let mut least = Dd::new(f64::MAX);
        for i in 0..6 {
            for j in 0..i {
                let (x, y) = (column(i), column(j));
                let n = cross(&x, &y);
                if norm(&n).to_f64() < 1e-22 {
                    continue; // parallel to the last bit but for some: there is no such face, or it is as good as none
                }
                let others = (0..6).filter(|&k| k != i && k != j);
                let across = others.fold(Dd::ZERO, |sum, k| sum + dot(&edges[k], &n).abs());
                least = least.min((across - dot(&center, &n).abs()) / norm(&n));
            }
        }
        // (Of what is flat in all its faces' planes this says nothing more.)
        if least.to_f64() > 0.0 { least.to_f64() } else { -self.distance(&edges, &center) }
    }

    /// The least distance of all points of A - B from the origin that are nearest on the plane of a face, the line of an edge, or corners.
    fn distance(&self, edges: &[V3; 6], center: &V3) -> f64 {
        let mut least = f64::MAX;
        for i in 0..6 {
            for j in i..6 {
                for signs in 0..64u32 {
                    let fixed = |k: usize| k != i && k != j;
                    if (0..6).any(|k| !fixed(k) && signs >> k & 1 == 1) {
                        continue;
                    }
                    let sign = |k: usize| if signs >> k & 1 == 1 { Dd::new(1.0) } else { Dd::new(-1.0) };
                    let base = (0..6).filter(|&k| fixed(k)).fold(*center, |x, k| add(&x, &scale(&edges[k], sign(k))));
                    for x in on_patch(&base, &edges[i], (j > i).then_some(&edges[j])) {
                        least = least.min(norm(&x).to_f64());
                    }
                }
            }
        }
        least
    }
}

/// Points base + s e + t f, |s|, |t| <= 1, that may be nearest to the origin: inside, and at the ends.
fn on_patch(base: &V3, e: &V3, f: Option<&V3>) -> Vec<V3> {
    let one = Dd::new(1.0);
    let clamped = |s: Dd| s.max(-one).min(one);
    let along = |x: &V3, g: &V3| {
        let square = dot(g, g);
        if square.to_f64() > 0.0 { add(x, &scale(g, clamped(-dot(x, g) / square))) } else { *x }
    };
    let Some(f) = f else { return vec![along(base, e)] };
    let mut points = Vec::new();
    for end in [-one, one] {
        points.push(along(&add(base, &scale(f, end)), e));
        points.push(along(&add(base, &scale(e, end)), f));
    }
    // (Gram-Schmidt: the determinant of edges that are nearly parallel has lost what their difference has not.)
    let (square, shared) = (dot(e, e), dot(e, f));
    if square.to_f64() > 0.0 {
        let across = sub(f, &scale(e, shared / square));
        let rest = dot(&across, &across);
        if rest.to_f64() > 0.0 {
            let t = clamped(-dot(base, &across) / rest);
            points.push(along(&add(base, &scale(f, t)), e));
        }
    }
    points
}

fn ask<T: Real>(pair: &Pair, options: &Options<'_, T, 3>) -> Depth<T> {
    let of = T::of;
    let shapes = pair.half.map(|half| BoxShape::new(Vector3::from(half.map(of))).unwrap());
    let turn = |body: usize| Matrix3::from_fn(|i, j| of(pair.turn[body][i][j]));
    let place = |body: usize| Vector3::from(pair.place[body].map(of));
    let bodies = [0, 1].map(|k| Body::new(&shapes[k], turn(k), place(k)).unwrap());
    // (Nothing is stored: the least workspace there is.)
    let mut memory = Workspace::<T, 3, 4, 6>::new();
    memory.solver().depth(&bodies[0], &bodies[1], options)
}

/// Is the bracket true, the normal what proves its upper end, and the points what they are said to be?
fn check<T: Real>(pair: &Pair, d: &Depth<T>) -> f64 {
    let truth = pair.truth();
    let (lower, upper) = (d.lower.to_f64(), d.upper.to_f64());
    // (The truth, rounded.)
    let slack = truth.abs() * 1e-15 + pair.size() * 1e-24;
    assert!(lower <= truth + slack && truth - slack <= upper, "[{lower:e}, {upper:e}] {truth:e} {pair:?} {d:?}");
    let n = v3([d.normal.x.to_f64(), d.normal.y.to_f64(), d.normal.z.to_f64()]);
    let (edges, center) = pair.zonotope();
    let height = edges.iter().fold(dot(&center, &n), |sum, edge| sum + dot(edge, &n).abs());
    let proved = (height / norm(&n)).to_f64();
    assert!(proved <= upper + proved.abs() * 1e-15 + pair.size() * 1e-24, "{proved:e} {pair:?} {d:?}");
    for (body, point) in [&d.point_a, &d.point_b].into_iter().enumerate() {
        for j in 0..3 {
            let offset = |i: usize| Dd::new(point[i].to_f64()) - Dd::new(pair.place[body][i]);
            // (R^T R is the identity to 1e-4 only.)
            let local = (0..3).fold(Dd::ZERO, |sum, i| sum + offset(i) * Dd::new(pair.turn[body][i][j]));
            let room = pair.half[body][j]
                + pair.half[body].iter().sum::<f64>() * 3e-4
                + pair.size() * T::ROUNDOFF.to_f64() * 8.0;
            assert!(local.to_f64().abs() <= room, "{body} {j} {pair:?} {d:?}");
        }
    }
    truth
}

/// Where a box may be found, what it may be like: everything that boxes in programs are, and worse.
fn random(dice: &mut Dice) -> Pair {
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let times = |a: [[f64; 3]; 3], b: [[f64; 3]; 3]| {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
    };
    let scale = if dice.chance(0.2) { dice.decade(-8.0, 8.0) } else { 1.0 };
    let mut half = [[0.0; 3]; 2];
    for w in half.iter_mut().flatten() {
        let sizes = [dice.range(0.2, 1.0), dice.range(0.2, 1.0), 0.5, 1.0, dice.decade(-4.0, 2.0)];
        *w = scale * dice.pick(&sizes);
        if dice.chance(0.03) {
            *w = 0.0;
        }
    }
    let first = if dice.chance(0.5) { identity } else { dice.rotation::<3>() };
    let second = match dice.below(5) {
        0 => first,
        1 => {
            let angle = dice.decade(-16.0, -1.0);
            times(first, dice.tilt(angle))
        }
        2 => times(first, {
            // a quarter turn, exactly
            [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]
        }),
        3 => {
            let mut turn = first; // not quite a rotation
            turn.iter_mut().flatten().for_each(|x| *x += dice.range(-1.0, 1.0) * dice.decade(-12.0, -4.7));
            turn
        }
        _ => dice.rotation::<3>(),
    };
    let offset = if dice.chance(0.2) { dice.decade(0.0, 5.0) * scale } else { 0.0 };
    let at: [f64; 3] = std::array::from_fn(|_| offset * dice.signed());
    let mut pair = Pair { half, turn: [first, second], place: [at, at] };
    // Along some direction, so far that they overlap by a share of their size, or are as far apart.
    let way: [f64; 3] = match dice.below(3) {
        0 => std::array::from_fn(|i| first[i][2]),
        1 => std::array::from_fn(|i| second[i][0]),
        _ => dice.direction(),
    };
    let height: f64 = (0..6)
        .map(|k| {
            let (body, j) = (k / 3, k % 3);
            half[body][j] * (0..3).map(|i| pair.turn[body][i][j] * way[i]).sum::<f64>().abs()
        })
        .sum();
    let depths = [0.0, 0.5, 1.0, dice.decade(-9.0, 0.0), -dice.decade(-9.0, 1.0), -0.1, 1e-3];
    let by = dice.pick(&depths);
    for i in 0..3 {
        pair.place[1][i] += way[i] * height * (1.0 - by);
        if dice.chance(0.3) {
            pair.place[1][i] += 0.3 * height * dice.signed();
        }
    }
    pair
}

fn brackets_of_boxes<T: Real>(cases: usize) -> [usize; 2] {
    let mut dice = Dice::new(31);
    let (mut ends, mut wide) = ([0; 2], Vec::new());
    for _ in 0..cases {
        let pair = random(&mut dice).rounded::<T>();
        let d = ask::<T>(&pair, &Options::default());
        let truth = check(&pair, &d);
        // (What is never met leaves the bracket as narrow as it was found.)
        check(&pair, &ask::<T>(&pair, &Options { relative: T::zero(), absolute: T::TINY, ..Options::default() }));
        ends[usize::from(truth > 0.0)] += 1;
        let width = (d.upper - d.lower).to_f64();
        // What one word of the normal and of the result leaves.
        let told =
            width <= truth.abs() * T::RELATIVE_TOLERANCE.to_f64() * 1.01 + pair.size() * T::ROUNDOFF.to_f64() * 8.0;
        let named = match d.outcome {
            Outcome::Converged => truth > 0.0,
            Outcome::Separated => truth < 0.0,
            Outcome::Touching | Outcome::Degenerate => d.lower <= T::zero() && d.upper >= T::zero(),
            _ => truth > 0.0,
        };
        assert!(named, "{pair:?} {d:?}");
        if !told {
            wide.push((width, truth, pair, d));
        }
    }
    wide.sort_by(|a, b| b.0.total_cmp(&a.0));
    assert!(wide.len() * 500 <= cases, "{} {:#?}", wide.len(), &wide[..wide.len().min(3)]);
    ends
}

#[test]
fn brackets_are_true_and_as_narrow_as_words_allow() {
    for [apart, overlapping] in [brackets_of_boxes::<f64>(4000), brackets_of_boxes::<f32>(4000)] {
        assert!(apart > 500 && overlapping > 500);
    }
}

/// Two flat boxes in parallel planes that are a roundoff of their places apart: which side the origin is on, one word does not tell, and it was taken for inside.
#[test]
fn plates_in_planes_next_to_one_another() {
    let turn = [
        [-0.693680585378445, -0.7190430173536524, -0.04224197751020772],
        [0.04216028990159109, -0.09907913186424497, 0.9941860165906788],
        [-0.7190478116401103, 0.6878666039458396, 0.09904433225372235],
    ];
    let half = [[0.0, 989696.7681541835, 1992501.1475560155], [0.0, 2050085.108558843, 682728.3203590999]];
    let place = [[0.0; 3], [-112893.97603529698, 2657016.052444358, 264701.34995885845]];
    let pair = Pair { half, turn: [turn, turn], place };
    assert!(check(&pair, &ask::<f64>(&pair, &Options::default())) < 0.0);
    let mut dice = Dice::new(5);
    for _ in 0..300 {
        let mut pair = random(&mut dice);
        (pair.turn[1], pair.half[0][0], pair.half[1][0]) = (pair.turn[0], 0.0, 0.0);
        // Along the plates, so far that they stay on one another.
        let along = [0, 1, 2].map(|i| pair.turn[0][i][1] * pair.half[0][1] * dice.signed());
        for i in 0..3 {
            pair.place[1][i] = pair.place[0][i] + along[i] + dice.pick(&[0.0, 1e-15, 1e-9]) * along[0];
        }
        check(&pair, &ask::<f64>(&pair, &Options::default()));
        let pair = pair.rounded::<f32>();
        check(&pair, &ask::<f32>(&pair, &Options::default()));
    }
}

/// An answer of boxes does not hang on memory, limits or guesses; thresholds are decided.
#[test]
fn what_is_asked_beside_the_depth() {
    let mut dice = Dice::new(6);
    for _ in 0..500 {
        let pair = random(&mut dice);
        let truth = check(&pair, &ask::<f64>(&pair, &Options::default()));
        let once = Options { max_iterations: Some(1), guess: Some(Vector3::x()), ..Options::default() };
        assert_eq!(ask::<f64>(&pair, &once), ask::<f64>(&pair, &Options::default()));
        for threshold in [0.0, truth + 0.1 * pair.size(), truth - 0.1 * pair.size()] {
            let d = ask::<f64>(&pair, &Options { threshold: Some(threshold), ..Options::default() });
            check(&pair, &d);
            if (truth - threshold).abs() > 1e-12 * pair.size() {
                assert_eq!(d.outcome, if truth > threshold { Outcome::Above } else { Outcome::Below }, "{pair:?}");
            }
        }
    }
}
