//! Every answer carries its proof; here each proof is checked without the crate's arithmetic.
//!
//! * The reported direction is a unit vector, and the textbook support functions of A and Q along it (in
//!   double-double) prove the upper bound.
//! * The witness simplex is made of points of A with weights that are a convex combination; for the ball its
//!   point is as far from the origin as the lower bound says.
//! * No direction anywhere proves less than the lower bound: a search over directions stays above it.
//! * The witness points of a pair lie on the bodies, and their difference is depth * normal.

use crate::common;

use common::cases::{Placed, Shape};
use common::dd::{BLUR, Dd, dot, norm, v3};
use common::dice::Dice;
use common::exact::{outside, pair_value, searched_upper};
use common::memory::{Memory, Seen, brisk, broken_promise};
use nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, Vertices};
use qdist::support::{BoxShape, Ellipsoid, Points, Rigid, Support};
use qdist::{Answer, Depth, Options, Outcome, Real, Vector};

/// A centred set and a unit set by their numbers.
enum Set {
    Box,
    Ellipsoid,
    Points(Vec<Vec<f64>>),
}

enum Q {
    Ball(f64),
    Box,
    Cross,
    Ellipsoid,
    Segment,
    Vertices(Vec<Vec<f64>>),
}

fn max(values: impl Iterator<Item = Dd>) -> Dd {
    values.fold(Dd::new(f64::MIN), Dd::max)
}

/// Textbook h of the set of half extents or semi axes `h`, moved by `t`.
fn set_value(set: &Set, h: &[f64], t: &[f64], u: &[Dd]) -> Dd {
    let scaled: Vec<Dd> = u.iter().zip(h).map(|(&u, &h)| u * Dd::new(h)).collect();
    let own = match set {
        Set::Box => scaled.iter().fold(Dd::ZERO, |s, x| s + x.abs()),
        Set::Ellipsoid => norm(&scaled),
        Set::Points(points) => max(points.iter().map(|p| dot(u, &wide(p)))),
    };
    own + dot(u, &wide(t))
}

fn unit_value(q: &Q, g: &[f64], u: &[Dd]) -> Dd {
    let scaled: Vec<Dd> = u.iter().zip(g).map(|(&u, &g)| u * Dd::new(g)).collect();
    match q {
        Q::Ball(r) => Dd::new(*r) * norm(u),
        Q::Box => scaled.iter().fold(Dd::ZERO, |s, x| s + x.abs()),
        Q::Cross => max(scaled.iter().map(|x| x.abs())),
        Q::Ellipsoid => norm(&scaled),
        Q::Segment => scaled.iter().fold(Dd::ZERO, |s, &x| s + x).max(Dd::ZERO),
        Q::Vertices(points) => max(points.iter().map(|p| dot(u, &wide(p)))).max(Dd::ZERO),
    }
}

fn wide(x: &[f64]) -> Vec<Dd> {
    x.iter().map(|&x| Dd::new(x)).collect()
}

fn vector<T: Real, const N: usize>(x: [f64; N]) -> Vector<T, N> {
    Vector::from(x.map(T::of))
}

fn exact<T: Real>(x: f64) -> f64 {
    T::of(x).to_f64()
}

/// Half-converged answers have proofs too: small capacities and limits are mixed in.
fn general<T: Real, const N: usize>() {
    let mut dice = Dice::new(61);
    let u = T::ROUNDOFF.to_f64();
    for round in 0..60 {
        let sizes = |dice: &mut Dice| -> [f64; N] { std::array::from_fn(|_| exact::<T>(dice.range(0.3, 2.0))) };
        let (h, g) = (sizes(&mut dice), sizes(&mut dice));
        // Mostly inside, sometimes outside.
        let shift = if dice.chance(0.2) { 3.0 } else { 0.3 };
        let t: [f64; N] = std::array::from_fn(|_| exact::<T>(shift * dice.signed()));
        let list = |dice: &mut Dice, n: usize| -> Vec<[f64; N]> {
            (0..n).map(|_| dice.direction::<N>().map(exact::<T>)).collect()
        };
        let (points, corners) = (list(&mut dice, 2 * N + 6), list(&mut dice, 3));
        let slices = |l: &[[f64; N]]| l.iter().map(|p| p.to_vec()).collect::<Vec<_>>();
        let typed = |l: &[[f64; N]]| l.iter().map(|p| p.map(T::of)).collect::<Vec<[T; N]>>();
        let (typed_points, typed_corners) = (typed(&points), typed(&corners));
        let (set, shape): (Set, Box<dyn Support<T, N> + '_>) = match round % 3 {
            0 => (Set::Box, Box::new(BoxShape::new(vector::<T, N>(h)).unwrap())),
            1 => (Set::Ellipsoid, Box::new(Ellipsoid::new(vector::<T, N>(h)).unwrap())),
            _ => (Set::Points(slices(&points)), Box::new(Points::new(&typed_points).unwrap())),
        };
        let (q, unit): (Q, Box<dyn UnitSet<T, N> + '_>) = match dice.below(6) {
            0 => (Q::Ball(g[0]), Box::new(Ball::new(T::of(g[0])).unwrap())),
            1 => (Q::Box, Box::new(UnitBox::new(vector::<T, N>(g)).unwrap())),
            2 => (Q::Cross, Box::new(CrossPolytope::new(vector::<T, N>(g)).unwrap())),
            3 => (Q::Ellipsoid, Box::new(UnitEllipsoid::new(vector::<T, N>(g), SMatrix::identity()).unwrap())),
            4 => (Q::Segment, Box::new(Segment::new(vector::<T, N>(g)).unwrap())),
            _ => (Q::Vertices(slices(&corners)), Box::new(Vertices::new(&typed_corners).unwrap())),
        };
        let moved = Rigid::new(&*shape, SMatrix::identity(), vector::<T, N>(t)).unwrap();
        let limit = dice.pick(&[0, 0, 1, 4, 12]);
        let options = Options { max_iterations: limit, ..brisk() };
        let (vertices, facets) = (N + 1 + dice.below(60), 2 * N + dice.below(800));
        let mut memory = Memory::new::<T, N>(vertices, facets);
        let answer: Answer<T, N> = memory.solver::<T, N>().solve(&moved, &*unit, &options);
        let seen = Seen::from(&answer);
        let tell = format!("N {N}, round {round}: {seen:?}");
        assert_eq!(broken_promise(&seen, &options, vertices, facets), None, "{tell}");

        // The direction proves the upper bound. For an origin outside in units of length.
        let n: Vec<Dd> = answer.direction.iter().map(|x| Dd::new(x.to_f64())).collect();
        let (length, top, bottom) = (norm(&n), set_value(&set, &h, &t, &n), unit_value(&q, &g, &n));
        assert!((length.hi - 1.0).abs() <= 16.0 * u * N as f64, "{tell}");
        let ball = matches!(q, Q::Ball(_));
        let proved = if seen.upper < 0.0 && !ball { top / length } else { top / bottom };
        assert!(proved.hi <= seen.upper + BLUR, "{tell}: the direction proves {:e}", proved.hi);

        // No direction proves less than the lower bound.
        if seen.lower > 0.0 {
            for _ in 0..200 {
                let v = wide(&dice.direction::<N>());
                let (top, bottom) = (set_value(&set, &h, &t, &v), unit_value(&q, &g, &v));
                assert!((top - Dd::new(seen.lower) * bottom).hi >= -BLUR, "{tell}: {v:?}");
            }
            for p in 0..N {
                for sign in [1.0, -1.0] {
                    let v: Vec<Dd> = (0..N).map(|i| Dd::new(if i == p { sign } else { 0.0 })).collect();
                    let (top, bottom) = (set_value(&set, &h, &t, &v), unit_value(&q, &g, &v));
                    assert!((top - Dd::new(seen.lower) * bottom).hi >= -BLUR, "{tell}: {v:?}");
                }
            }
        }

        // The witness simplex: points of A, weights of a convex combination.
        let corners = &answer.witness.corners;
        assert!(!corners.is_empty() && corners.len() <= N + 1, "{tell}");
        let error = moved.error().to_f64() + 4.0 * u * 4.0;
        for c in corners {
            let p: Vec<f64> = (0..N).map(|i| c.vertex.point[i].to_f64() - t[i]).collect();
            let beyond = match &set {
                Set::Box => (0..N).map(|i| p[i].abs() - h[i]).fold(f64::MIN, f64::max),
                Set::Ellipsoid => {
                    let g = (0..N).map(|i| (p[i] / h[i]).powi(2)).sum::<f64>().sqrt();
                    p.iter().map(|x| x * x).sum::<f64>().sqrt() * (1.0 - 1.0 / g)
                }
                Set::Points(list) => list
                    .iter()
                    .map(|q| p.iter().zip(q).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt())
                    .fold(f64::MAX, f64::min),
            };
            assert!(beyond <= error, "{tell}: {p:?} is {beyond:e} outside of A, {error:e} allowed");
            // A mere facet of a general Q has no weights.
            if ball {
                assert!(c.weight.to_f64() >= 0.0, "{tell}: {corners:?}");
            }
        }
        if ball {
            let sum: f64 = corners.iter().map(|c| c.weight.to_f64()).sum();
            assert!((sum - 1.0).abs() <= 64.0 * u, "{tell}: the weights add up to {sum}");
        }
        // For a ball and a narrow bracket: the foot of the perpendicular on the core of A.
        if let Q::Ball(r) = q
            && matches!(answer.outcome, Outcome::Converged | Outcome::Separated)
            && limit == 0
            && seen.upper - seen.lower <= 2.0 * options.relative.to_f64() * seen.upper.abs()
        {
            let foot = answer.witness.point().iter().map(|x| x.to_f64().powi(2)).sum::<f64>().sqrt();
            let core = (seen.lower * r - moved.radius().to_f64()).abs();
            let off = (foot - core).abs();
            let allowed = 8.0 * options.relative.to_f64() * (seen.lower.abs() * r).max(core) + 2000.0 * u;
            assert!(off <= allowed, "{tell}: the foot is at {foot:e}, {off:e} off");
        }
    }
}

#[test]
fn general_answers_prove_themselves_in_f64() {
    general::<f64, 2>();
    general::<f64, 3>();
    general::<f64, 4>();
    general::<f64, 5>();
    general::<f64, 6>();
}

#[test]
fn general_answers_prove_themselves_in_f32() {
    general::<f32, 2>();
    general::<f32, 3>();
    general::<f32, 4>();
    general::<f32, 5>();
    general::<f32, 6>();
}

const KINDS: [&str; 7] = ["sphere", "box", "ellipsoid", "cylinder", "capsule", "cone", "hull"];

fn random_body<T: Real>(kind: &str, dice: &mut Dice, by: [f64; 3]) -> Placed {
    let numbers: Vec<f64> = match kind {
        "sphere" => vec![dice.range(0.3, 1.5)],
        "box" | "ellipsoid" => (0..3).map(|_| dice.range(0.3, 1.5)).collect(),
        "hull" => (0..4 + dice.below(24)).flat_map(|_| dice.direction::<3>()).collect(),
        _ => (0..2).map(|_| dice.range(0.3, 1.5)).collect(),
    };
    let rotation = dice.rotation::<3>();
    Placed {
        shape: Shape { kind: kind.to_string(), numbers: numbers.into_iter().map(exact::<T>).collect() },
        rotation: std::array::from_fn(|k| exact::<T>(rotation[k / 3][k % 3])),
        translation: by.map(exact::<T>),
    }
}

/// All pairs of shapes, overlapping and apart.
fn bodies<T: Real>() {
    let u = T::ROUNDOFF.to_f64();
    let mut dice = Dice::new(62);
    let mut complaints = Vec::new();
    for round in 0..12 {
        for one in KINDS {
            for other in KINDS {
                let by = dice.range(0.0, 3.0);
                let direction = dice.direction::<3>();
                let a = random_body::<T>(one, &mut dice, [0.5, 0.25, -1.0]);
                let shift = std::array::from_fn(|i| a.translation[i] + by * direction[i]);
                let b = random_body::<T>(other, &mut dice, shift);
                let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
                let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
                let options = brisk();
                let mut memory = Memory::new::<T, 3>(256, 512);
                let r: Depth<T> =
                    memory.solver::<T, 3>().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
                let seen = Seen::from(&r);
                let mut complain =
                    |what: String| complaints.push(format!("{one} {other} {round}, u = {u:.0e}: {what}; {seen:?}"));
                if let Some(text) = broken_promise(&seen, &options, 256, 512) {
                    complain(text);
                }
                let n = [r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64);
                let proved = pair_value(&a, &b, &v3(n));
                if !(proved <= Dd::new(seen.upper) + Dd::new(BLUR)) {
                    complain(format!("the normal proves {:e}", proved.hi));
                }
                let found = searched_upper(&a, &b, Some(n), 60, &mut dice);
                if !(Dd::new(seen.lower) <= found + Dd::new(BLUR)) {
                    complain(format!("a direction proves depth <= {:e}", found.hi));
                }
                // Witnesses: on their bodies, and depth * normal apart.
                let narrow =
                    seen.upper - seen.lower <= 2.0 * (options.relative.to_f64() * seen.upper.abs()).max(500.0 * u);
                if !narrow {
                    // Minima that form a circle take many facets.
                    if seen.outcome != Outcome::Capacity {
                        complain("wide".to_string());
                    }
                    continue;
                }
                let (wa, wb) = (
                    [r.point_a.x, r.point_a.y, r.point_a.z].map(Real::to_f64),
                    [r.point_b.x, r.point_b.y, r.point_b.z].map(Real::to_f64),
                );
                // A direction whose height is off by a share t may be off by an angle of the root of 2 t, and
                // the point that goes with it by that times the size of the cores' distance.
                let radii = (sa.radius() + sb.radius()).to_f64();
                let slack = 2.0 * (2.0 * options.relative.to_f64()).sqrt() * (seen.upper.abs() + radii) + 2000.0 * u;
                for (body, w, name) in [(&a, wa, "A"), (&b, wb, "B")] {
                    let off = outside(body, w);
                    if off.is_nan() {
                        continue;
                    }
                    if off > slack {
                        complain(format!("the witness on {name} is {off:e} outside of it"));
                    }
                    // Apart, nearest points are on the surface; the depth of a point inside is known roughly only.
                    if off < -0.05 - slack {
                        complain(format!("the witness on {name} is {:e} inside of it", -off));
                    }
                }
                let miss = (0..3)
                    .map(|i| (wa[i] - wb[i] - 0.5 * (seen.lower + seen.upper) * n[i]).powi(2))
                    .sum::<f64>()
                    .sqrt();
                if miss > slack {
                    complain(format!("point_a - point_b is {miss:e} off depth * normal, {slack:e} allowed"));
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{} complaints\n{}", complaints.len(), complaints.join("\n"));
}

#[test]
fn bodies_prove_their_depth_in_f64() {
    bodies::<f64>();
}

#[test]
fn bodies_prove_their_depth_in_f32() {
    bodies::<f32>();
}

/// Matrices that are off orthonormal, as far as `Body::new` takes them, are used as they are: coaxial solids are
/// then not quite round, and ellipsoids have other axes.
fn skewed<T: Real>() {
    let u = T::ROUNDOFF.to_f64();
    let mut dice = Dice::new(63);
    let mut complaints = Vec::new();
    for round in 0..20 {
        // From rounding to all that is allowed.
        let off = dice.decade(u.log10() - 0.5, 2e-5f64.log10());
        for one in KINDS {
            for other in KINDS {
                let coaxial = round % 2 == 0;
                let direction = if coaxial { [0.0, 0.0, 1.0] } else { dice.direction::<3>() };
                let by = dice.range(0.0, 1.0);
                let mut a = random_body::<T>(one, &mut dice, [0.0; 3]);
                let mut b = random_body::<T>(other, &mut dice, direction.map(|x| x * by));
                for body in [&mut a, &mut b] {
                    for k in 0..9 {
                        let base = if !coaxial {
                            body.rotation[k]
                        } else if k % 4 == 0 {
                            1.0
                        } else {
                            0.0
                        };
                        // Coaxial ones keep their axis.
                        let axis = coaxial && (k % 3 == 2 || k / 3 == 2);
                        body.rotation[k] = exact::<T>(base + if axis { 0.0 } else { off * dice.signed() });
                    }
                }
                let (pa, pb) = (a.shape.points::<T>(), b.shape.points::<T>());
                let (sa, sb) = (a.shape.build(&pa).unwrap(), b.shape.build(&pb).unwrap());
                let options = brisk();
                let mut memory = Memory::new::<T, 3>(256, 512);
                let r: Depth<T> =
                    memory.solver::<T, 3>().depth(&a.body(&*sa).unwrap(), &b.body(&*sb).unwrap(), &options);
                let seen = Seen::from(&r);
                let mut complain = |what: String| {
                    complaints.push(format!(
                        "{one} {other} {round}, coaxial {coaxial}, off by {off:.1e}, u = {u:.0e}: {what}; {seen:?}"
                    ));
                };
                if let Some(text) = broken_promise(&seen, &options, 256, 512) {
                    complain(text);
                }
                let n = [r.normal.x, r.normal.y, r.normal.z].map(Real::to_f64);
                let proved = pair_value(&a, &b, &v3(n));
                if !(proved <= Dd::new(seen.upper) + Dd::new(BLUR)) {
                    complain(format!("the normal proves {:e}", proved.hi));
                }
                let found = searched_upper(&a, &b, Some(n), 60, &mut dice);
                if !(Dd::new(seen.lower) <= found + Dd::new(BLUR)) {
                    complain(format!("a direction proves depth <= {:e}", found.hi));
                }
            }
        }
    }
    assert!(complaints.is_empty(), "{} complaints\n{}", complaints.len(), complaints.join("\n"));
}

#[test]
fn skewed_matrices_are_taken_as_given_in_f64() {
    skewed::<f64>();
}

#[test]
fn skewed_matrices_are_taken_as_given_in_f32() {
    skewed::<f32>();
}
