//! Rays in configuration space: from the query's pose outward, to where A is free.
//!
//! A ray is a translation or a screw about the metric's centre. It is tried where its value is a little more than the best ray's: is it not free
//! there, it is given up after that one test. Otherwise bisection finds where it becomes free; the pose is a seed.
//!
//! Where facets meet at flat angles one valley has neighbours a few degrees away that are better by a few parts in a thousand. Translations around the best
//! pose's find the way over ([`beside`]).

use super::super::search::PoseSearch;
use crate::mesh::optimize::Twist;
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

/// How many rays, and which of them become seeds.
#[derive(Clone, Copy, Debug)]
pub struct Fan {
    /// Translations, evenly spread; in further rounds half as many.
    pub translations: usize,
    /// Random screws.
    pub screws: usize,
    /// How much worse than the best a ray may be.
    pub worse: f64,
    /// Seeds.
    pub seeds: usize,
}

/// Seeds are farther from each other than this fraction of their value.
const DIVERSE: f64 = 0.2;
/// A ray's free pose is found to this fraction of its value.
const ACCURACY: f64 = 0.05;
/// How far around the best pose's direction neighbours are looked for, in radians.
const BESIDE: f64 = 0.14;
/// They are tried at this fraction of the best value.
const BETTER: f64 = 0.9998;
/// A translation replaces the best pose up to this multiple of its value: a walk will gain that.
const HARDLY_WORSE: f64 = 1.02;

/// A free pose and its value.
#[derive(Clone, Copy, Debug)]
pub struct Seed {
    pub pose: Isometry3<f64>,
    pub value: f64,
}

/// Moves A out of B's box, along the axis that is nearest. There is always such a pose, so there always is an upper bound, but for
/// coordinates at the end of what numbers can do.
pub fn escape(search: &mut PoseSearch) -> Option<Seed> {
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
        let translation = Translation3::from(search.start.translation.vector + shift);
        let pose = Isometry3::from_parts(translation, search.start.rotation);
        if !search.pair.collides(&pose) {
            search.take(&pose);
            return Some(Seed { pose, value: search.distance(&pose) });
        }
    }
    None
}

/// Translations into all directions, then random screws. Returns the best and diverse of them and of a seed that is known.
pub fn cast(search: &mut PoseSearch, fan: &Fan, round: usize, known: &Seed) -> Vec<Seed> {
    let mut found = vec![*known];
    let mut best = known.value;
    let mut shoot = |search: &mut PoseSearch, linear, angular| {
        if search.goes_on()
            && let Some(seed) = ray(search, linear, angular, fan.worse * best)
        {
            best = best.min(seed.value);
            found.push(seed);
        }
    };
    let turn = search.random.rotation();
    let translations = if round == 0 { fan.translations } else { fan.translations / 2 };
    for k in 0..translations {
        shoot(search, turn * on_cap(k, translations, -1.0), Vector3::zeros());
    }
    for _ in 0..fan.screws {
        let (linear, angular) = (search.random.direction(), search.random.direction());
        let share = search.random.signed().abs();
        shoot(search, linear * share, angular * (1.0 - share));
    }
    found.sort_by(|x, y| x.value.total_cmp(&y.value));
    let mut chosen: Vec<Seed> = Vec::new();
    for seed in found {
        let apart = |c: &Seed| search.metric.distance(&c.pose, &seed.pose) > DIVERSE * seed.value;
        if chosen.len() < fan.seeds && chosen.iter().all(apart) {
            chosen.push(seed);
        }
    }
    chosen
}

/// The last of so many translations around the best pose's, each of them better than those before; `None` if none is.
pub fn beside(search: &mut PoseSearch, translations: usize) -> Option<Isometry3<f64>> {
    let towards = best_translation(search)?;
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &towards)
        .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI));
    let mut found = None;
    for k in 0..translations {
        let direction = turn * on_cap(k, translations, BESIDE.cos());
        let best = search.upper;
        if search.goes_on()
            && let Some(seed) = ray(search, direction, Vector3::zeros(), BETTER * best)
            && seed.value < best
        {
            found = Some(seed.pose);
        }
    }
    found
}

/// The translation into the direction of the best pose's, when it is hardly worse.
pub fn without_turning(search: &mut PoseSearch) -> Option<Isometry3<f64>> {
    let towards = best_translation(search)?;
    ray(search, towards, Vector3::zeros(), HARDLY_WORSE * search.upper).map(|seed| seed.pose)
}

/// The direction in which the best pose moves A's centre.
fn best_translation(search: &PoseSearch) -> Option<Vector3<f64>> {
    let centre = search.metric.frame().centre;
    (search.pose * centre - search.start * centre).try_normalize(0.0)
}

/// Where the motion s (linear, angular / radius) becomes free, if it is at the value `most`.
fn ray(search: &mut PoseSearch, linear: Vector3<f64>, angular: Vector3<f64>, most: f64) -> Option<Seed> {
    let (about, radius) = (search.start * search.metric.frame().centre, search.metric.frame().radius);
    let start = search.start;
    let at = |s: f64| Twist { linear: linear * s, angular: angular * (s / radius), about }.applied(&start);
    // The value is nearly proportional to s.
    let mut free = most;
    for _ in 0..6 {
        let value = search.distance(&at(free));
        if (value - most).abs() <= 0.01 * most {
            break;
        }
        free *= most / value;
        // Beyond a half turn the body comes back.
        if !(free * angular.norm() < std::f64::consts::PI * radius) {
            return None;
        }
    }
    if search.pair.collides(&at(free)) {
        return None;
    }
    let mut colliding = 0.0;
    while free - colliding > ACCURACY * free {
        let middle = 0.5 * (free + colliding);
        if search.pair.collides(&at(middle)) { colliding = middle } else { free = middle }
    }
    let pose = at(free);
    search.take(&pose);
    Some(Seed { pose, value: search.distance(&pose) })
}

/// The k-th of n directions, evenly spread where the cosine to z is at least this (-1: everywhere). Fibonacci's spiral.
fn on_cap(k: usize, n: usize, least: f64) -> Vector3<f64> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    let z = 1.0 - (1.0 - least) * (k as f64 + 0.5) / n as f64;
    let (sin, cos) = (golden * k as f64).sin_cos();
    Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z
}
