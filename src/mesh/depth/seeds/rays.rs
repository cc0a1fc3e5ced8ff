//! Rays in configuration space: from the query's pose outward, to where A is free.
//!
//! A ray that is not free where it reaches the best value so far is given up after that one test.

use super::super::search::Search;
use nalgebra::{Isometry3, Translation3, Vector3};

/// Directions of translation.
const DIRECTIONS: usize = 32;

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

/// Translations into all directions.
pub fn cast(search: &mut Search) {
    let turn = search.random.rotation();
    for k in 0..DIRECTIONS {
        let direction = turn * on_sphere(k, DIRECTIONS);
        if !(search.goes_on() && search.upper.is_finite()) {
            return;
        }
        let far = moved(&search.start, &(direction * search.upper));
        if !search.pair.collides(&far) {
            let slid = search.slide(&far, 1e-4 * search.size);
            search.take(&slid);
        }
    }
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
