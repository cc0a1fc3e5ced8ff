//! Rays in configuration space: from the query's pose outward, to where A is free.
//!
//! A ray that is not free where it reaches the best value so far is given up after that one test.

use super::super::search::Search;
use crate::mesh::optimize::Twist;
use nalgebra::{Isometry3, Translation3, Vector3};

/// Directions of translation.
const TRANSLATIONS: usize = 32;
/// Screws.
const SCREWS: usize = 64;

/// Moves A out of B's box, along the axis that is nearest. There is always such a pose, so there always is an upper bound, but for
/// coordinates at the end of what numbers can do.
pub fn escape(search: &mut Search) {
    let (low_b, high_b) = search.pair.b().bounds();
    let (low, high) = search.pair.a().bounds();
    let turn = search.start.rotation.to_rotation_matrix();
    let centre = search.start * nalgebra::center(&low, &high);
    let half = turn.matrix().abs() * (high - low) * 0.5;
    let mut shifts = [Vector3::zeros(); 6];
    for k in 0..3 {
        let slack = 1e-9 * (search.size + centre[k].abs() + low_b[k].abs() + high_b[k].abs());
        shifts[2 * k][k] = high_b[k] - (centre[k] - half[k]) + slack;
        shifts[2 * k + 1][k] = low_b[k] - (centre[k] + half[k]) - slack;
    }
    shifts.sort_by(|x, y| x.norm_squared().total_cmp(&y.norm_squared()));
    for shift in shifts {
        let pose = moved(&search.start, &shift);
        if !search.pair.collides(&pose) {
            search.take(&pose);
            return;
        }
    }
}

/// A free pose and its value.
#[derive(Clone, Copy, Debug)]
pub struct Seed {
    pub pose: Isometry3<f64>,
    pub value: f64,
}

/// Translations into all directions, then random screws. Returns the best and diverse.
pub fn cast(search: &mut Search) -> Vec<Seed> {
    let turn = search.random.rotation();
    let mut found: Vec<Seed> = Vec::new();
    for k in 0..TRANSLATIONS {
        let direction = turn * on_sphere(k, TRANSLATIONS);
        ray(search, &Motion { linear: direction, angular: Vector3::zeros() }, &mut found);
    }
    for _ in 0..SCREWS {
        let (linear, angular) = (search.random.direction(), search.random.direction());
        let share = search.random.signed().abs();
        ray(search, &Motion { linear: linear * share, angular: angular * (1.0 - share) }, &mut found);
    }
    found.sort_by(|x, y| x.value.total_cmp(&y.value));
    let mut chosen: Vec<Seed> = Vec::new();
    for seed in found {
        if chosen.len() < 4 && chosen.iter().all(|c| search.metric.distance(&c.pose, &seed.pose) > 0.3 * seed.value) {
            chosen.push(seed);
        }
    }
    chosen
}

/// A direction of motion: of the metric's centre, and a rotation vector times its radius.
struct Motion {
    linear: Vector3<f64>,
    angular: Vector3<f64>,
}

const KEEP: f64 = 1.2;

fn ray(search: &mut Search, motion: &Motion, found: &mut Vec<Seed>) {
    if !search.goes_on() {
        return;
    }
    let frame = search.metric.frame();
    let radius = frame.radius;
    let about = search.start * frame.centre;
    let at = |s: f64| {
        Twist { linear: motion.linear * s, angular: motion.angular * (s / radius), about }.applied(&search.start)
    };
    let most = KEEP * search.upper;
    // The parameter where the metric is at its most.
    let mut far = most;
    for _ in 0..6 {
        let value = search.distance(&at(far));
        if !(value > 0.0) { return; }
        if (value - most).abs() < 0.01 * most { break; }
        far *= most / value;
        if !(far * motion.angular.norm() < 3.0 * radius) { return; }
    }
    if search.pair.collides(&at(far)) {
        return;
    }
    let (mut free, mut hit) = (far, 0.0);
    while free - hit > 0.02 * free {
        let middle = 0.5 * (free + hit);
        if search.pair.collides(&at(middle)) { hit = middle } else { free = middle }
    }
    let pose = at(free);
    let value = search.distance(&pose);
    search.take(&pose);
    found.push(Seed { pose, value });
}

fn moved(pose: &Isometry3<f64>, shift: &Vector3<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(pose.translation.vector + shift), pose.rotation)
}

/// The k-th of n evenly spread directions: Fibonacci's spiral.
fn on_sphere(k: usize, n: usize) -> Vector3<f64> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let z = 1.0 - (2.0 * k as f64 + 1.0) / n as f64;
    let (sin, cos) = (golden * k as f64).sin_cos();
    Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z
}
