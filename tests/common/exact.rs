//! Support functions of the shapes of the case files by their textbook formulas, in double-double: they share nothing
//! with the crate's support mappings.
//!
//! Every direction u bounds the depth from above: depth <= h_A(u) + h_B(-u). So a lower bound of the crate must not
//! exceed that for any u, and its upper bound must not be below it for the direction that it reports.

use super::cases::Placed;
use super::dd::{Dd, V3, dot, norm, scale, v3};
use super::dice::Dice;

/// h of the shape alone.
fn shape_value(kind: &str, n: &[f64], u: &V3) -> Dd {
    let d = |i: usize| Dd::new(n[i]);
    match kind {
        "sphere" => d(0) * norm(u),
        "box" => d(0) * u[0].abs() + d(1) * u[1].abs() + d(2) * u[2].abs(),
        "ellipsoid" => norm(&[d(0) * u[0], d(1) * u[1], d(2) * u[2]]),
        "cylinder" => d(0) * norm(&u[..2]) + d(1) * u[2].abs(),
        "capsule" => d(0) * norm(u) + d(1) * u[2].abs(),
        "cone" => (d(1) * u[2]).max(d(0) * norm(&u[..2]) - d(1) * u[2]),
        "hull" => n.chunks_exact(3).map(|p| dot(&v3([p[0], p[1], p[2]]), u)).fold(Dd::new(f64::MIN), Dd::max),
        kind => panic!("unknown shape {kind}"),
    }
}

/// The radius of the ball term, which a matrix that is not quite orthonormal leaves alone.
fn ball_term(body: &Placed) -> f64 {
    match body.shape.kind.as_str() {
        "sphere" | "capsule" => body.shape.numbers[0],
        _ => 0.0,
    }
}

/// h of the placed body: the matrix as it is given, the ball term a ball.
pub fn body_value(body: &Placed, u: &V3) -> Dd {
    let r = &body.rotation;
    let local: V3 = std::array::from_fn(|j| (0..3).fold(Dd::ZERO, |s, i| s + Dd::new(r[3 * i + j]) * u[i]));
    let ball = Dd::new(ball_term(body));
    let own = shape_value(&body.shape.kind, &body.shape.numbers, &local);
    own - ball * norm(&local) + ball * norm(u) + dot(&v3(body.translation), u)
}

/// (h_A(u) + h_B(-u)) / |u|.
pub fn pair_value(a: &Placed, b: &Placed, u: &V3) -> Dd {
    (body_value(a, u) + body_value(b, &scale(u, Dd::new(-1.0)))) / norm(u)
}

/// The same in `f64`, to steer a search. Moved so that large positions cancel.
fn rough(a: &Placed, b: &Placed, u: &[f64; 3]) -> f64 {
    let value = |body: &Placed, s: f64| {
        let (r, n) = (&body.rotation, &body.shape.numbers);
        let l: [f64; 3] = std::array::from_fn(|j| s * (r[j] * u[0] + r[3 + j] * u[1] + r[6 + j] * u[2]));
        let across = l[0].hypot(l[1]);
        match body.shape.kind.as_str() {
            "sphere" => n[0],
            "box" => (0..3).map(|i| n[i] * l[i].abs()).sum(),
            "ellipsoid" => (0..3).map(|i| (n[i] * l[i]).powi(2)).sum::<f64>().sqrt(),
            "cylinder" => n[0] * across + n[1] * l[2].abs(),
            "capsule" => n[0] + n[1] * l[2].abs(),
            "cone" => (n[1] * l[2]).max(n[0] * across - n[1] * l[2]),
            _ => n.chunks_exact(3).map(|p| p[0] * l[0] + p[1] * l[1] + p[2] * l[2]).fold(f64::MIN, f64::max),
        }
    };
    let apart: f64 = (0..3).map(|i| u[i] * (a.translation[i] - b.translation[i])).sum();
    value(a, 1.0) + value(b, -1.0) + apart
}

/// An upper bound of the depth by search: random directions and `first`, the best refined by shrinking random
/// steps; each value is exact, whatever the search misses.
pub fn searched_upper(a: &Placed, b: &Placed, first: Option<[f64; 3]>, tries: usize, dice: &mut Dice) -> Dd {
    let mut best = (f64::MAX, [1.0, 0.0, 0.0]);
    let axes = (0..3).flat_map(|i| {
        [1.0, -1.0].map(|s| {
            let mut axis = [0.0; 3];
            axis[i] = s;
            axis
        })
    });
    let starts: Vec<[f64; 3]> =
        first.into_iter().chain(axes).chain((0..tries).map(|_| dice.direction::<3>())).collect();
    for u in starts {
        let value = rough(a, b, &u);
        if value < best.0 {
            best = (value, u);
        }
    }
    let mut step = 0.3;
    while step > 1e-9 {
        let mut improved = false;
        for _ in 0..8 {
            let d = dice.direction::<3>();
            let v: [f64; 3] = std::array::from_fn(|i| best.1[i] + step * d[i]);
            let l = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            let v = v.map(|x| x / l);
            let value = rough(a, b, &v);
            if value < best.0 {
                best = (value, v);
                improved = true;
            }
        }
        if !improved {
            step *= 0.5;
        }
    }
    pair_value(a, b, &v3(best.1))
}

/// How far `p` (world) is outside the placed body, in its own frame; negative inside (then only roughly a distance).
pub fn outside(body: &Placed, p: [f64; 3]) -> f64 {
    let (r, t, n) = (&body.rotation, &body.translation, &body.shape.numbers);
    let w: [f64; 3] = std::array::from_fn(|i| p[i] - t[i]);
    let l: [f64; 3] = std::array::from_fn(|j| r[j] * w[0] + r[3 + j] * w[1] + r[6 + j] * w[2]);
    let across = l[0].hypot(l[1]);
    match body.shape.kind.as_str() {
        "sphere" => (l[0].hypot(l[1])).hypot(l[2]) - n[0],
        "box" => (0..3).map(|i| l[i].abs() - n[i]).fold(f64::MIN, f64::max),
        "ellipsoid" => {
            let g = (0..3).map(|i| (l[i] / n[i]).powi(2)).sum::<f64>().sqrt();
            // Distance along the ray from the centre: an upper bound of the distance outside.
            (l[0].hypot(l[1])).hypot(l[2]) * (1.0 - 1.0 / g)
        }
        "cylinder" => (across - n[0]).max(l[2].abs() - n[1]),
        "capsule" => across.hypot((l[2].abs() - n[1]).max(0.0)) - n[0],
        "cone" => {
            let slant = (across - n[0] * (n[1] - l[2]) / (2.0 * n[1])) * (2.0 * n[1]) / (2.0 * n[1]).hypot(n[0]);
            slant.max(-n[1] - l[2])
        }
        _ => f64::NAN,
    }
}
