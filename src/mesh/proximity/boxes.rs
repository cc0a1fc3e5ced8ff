//! Whether two boxes are apart: the test that all walks spend their time in, in single precision.
//!
//! The difference d of the centres is computed in double precision, in a unit that the whole query fits in. From there on all
//! quantities are products and sums of d, the half extents and the rotation, so their rounding is a small fraction of |d| wherever the answer
//! could be that the boxes are apart: no more than 22 half ulps, 1.4e-6 |d|_1. That much is taken off every gap; the answer "apart" is true,
//! and boxes that are apart by less are opened, which is all that single precision costs. Four lanes hold three axes at once.
//!
//! Axes: those of both boxes, whose gaps in one frame add up to a distance, and the products e_i x R e_j (Gottschalk, Lin and
//! Manocha 1996). What is no number is never apart.

use super::super::Mesh;
use super::super::bvh::Node;
use super::lanes::Lanes;
use super::relative::Relative;
use nalgebra::Vector3;

/// What rounding may take, in |d|_1.
const ROUNDING: f32 = 2e-6;

/// One query's rotation and margin, for all pairs of boxes.
pub(super) struct Boxes<'r> {
    relative: &'r Relative,
    /// One over the unit of length.
    scale: f64,
    margin: f32,
    margin_squared: f32,
    /// Rounding of the coordinates, twice.
    doubt: f32,
    rows: [Lanes; 3],
    absolute_columns: [Lanes; 3],
    absolute_rows: [Lanes; 3],
    /// The absolute rows, turned by one and by two lanes.
    turned: [[Lanes; 3]; 2],
}

impl<'r> Boxes<'r> {
    pub fn new(relative: &'r Relative, a: &Mesh, b: &Mesh, margin: f64) -> Boxes<'r> {
        let scale = 1.0 / (a.scale() + b.scale() + relative.translation().amax() + margin);
        let r = relative.rotation().map(|x| x as f32);
        let s = r.abs();
        let row = |m: &nalgebra::Matrix3<f32>, i: usize, turn: usize| {
            Lanes::new(m[(i, turn % 3)], m[(i, (1 + turn) % 3)], m[(i, (2 + turn) % 3)])
        };
        let rows = |m, turn| [row(m, 0, turn), row(m, 1, turn), row(m, 2, turn)];
        // Rounded up.
        let margin = (margin * scale) as f32 * (1.0 + ROUNDING);
        Boxes {
            relative,
            scale,
            margin,
            margin_squared: margin * margin * (1.0 + ROUNDING),
            doubt: (2.0 * relative.doubt * scale) as f32 * (1.0 + ROUNDING),
            rows: rows(&r, 0),
            absolute_columns: rows(&s.transpose(), 0),
            absolute_rows: rows(&s, 0),
            turned: [rows(&s, 1), rows(&s, 2)],
        }
    }

    /// Whether the boxes are farther apart than the margin. The cheapest axes first.
    #[inline]
    pub fn are_apart(&self, a: &Node, b: &Node) -> bool {
        let single = |v: Vector3<f64>| (v * self.scale).map(|x| x as f32);
        let d = single(self.relative.place(&a.centre.into()).coords - b.centre);
        let (a, b) = (single(a.half), single(b.half));
        let square = |gaps: Lanes| (gaps.positive() * gaps.positive()).sum();
        let along =
            |m: &[Lanes; 3], v: &Vector3<f32>| m[0] * Lanes::all(v.x) + m[1] * Lanes::all(v.y) + m[2] * Lanes::all(v.z);
        let [in_a, in_b, in_d] = [a, b, d].map(|v| Lanes::new(v.x, v.y, v.z));
        let rounding = Lanes::all(self.doubt + ROUNDING * (d.x.abs() + d.y.abs() + d.z.abs()));
        let gaps = in_d.abs() - (in_b + along(&self.absolute_columns, &a) + rounding);
        if square(gaps) > self.margin_squared {
            return true;
        }
        let gaps = along(&self.rows, &d).abs() - (in_a + along(&self.absolute_rows, &b) + rounding);
        if square(gaps) > self.margin_squared {
            return true;
        }
        let (a1, a2) = (Lanes::new(a.y, a.z, a.x), Lanes::new(a.z, a.x, a.y));
        let least = rounding + Lanes::all(self.margin);
        let product = |i: usize, i1: usize, i2: usize| {
            // e_i x R e_j = R[i1, j] e_i2 - R[i2, j] e_i1 is no longer than 1, so its gap is no larger than the distance.
            let between = self.rows[i1] * Lanes::all(d[i2]) - self.rows[i2] * Lanes::all(d[i1]);
            let of_b = self.absolute_rows[i2] * Lanes::all(b[i1]) + self.absolute_rows[i1] * Lanes::all(b[i2]);
            let of_a = a1 * self.turned[1][i] + a2 * self.turned[0][i];
            between.abs().any_above(of_b + of_a + least)
        };
        product(0, 1, 2) || product(1, 2, 0) || product(2, 0, 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};

    /// Uniform in (-1, 1).
    struct Random(u64);
    impl Random {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }
        fn vector(&mut self) -> Vector3<f64> {
            Vector3::new(self.next(), self.next(), self.next())
        }
        /// From ten to the `low` to ten to the `high`.
        fn size(&mut self, low: f64, high: f64) -> f64 {
            10f64.powf(low + (high - low) * 0.5 * (1.0 + self.next()))
        }
    }

    /// A triangle whose box has these half extents.
    fn spanning(centre: &Vector3<f64>, half: &Vector3<f64>) -> Mesh {
        let at = |x: f64, y: f64, z: f64| -> [f64; 3] { (centre + half.component_mul(&Vector3::new(x, y, z))).into() };
        Mesh::new(&[at(-1.0, -1.0, -1.0), at(1.0, 1.0, 1.0), at(1.0, -1.0, 1.0)], &[[0, 1, 2]]).unwrap()
    }

    /// A point of each that are near each other: no farther apart than the boxes, and nearly as near. By alternating projections.
    fn upper_distance(relative: &Relative, a: &Node, b: &Node) -> f64 {
        let into = |p: Vector3<f64>, node: &Node| node.centre + (p - node.centre).sup(&-node.half).inf(&node.half);
        let mut on_b = b.centre;
        let mut on_a = on_b;
        for _ in 0..2000 {
            let back = relative.place_back(&on_b.into()).coords;
            on_a = relative.place(&into(back, a).into()).coords;
            on_b = into(on_a, b);
        }
        (on_a - on_b).norm()
    }

    #[test]
    fn boxes_that_are_called_apart_are() {
        let mut random = Random(1);
        let (mut apart, mut count) = (0, 0);
        for _ in 0..4000 {
            // Needles, plates and points; one body up to 1e9 times the other, far from their origins.
            let sizes = [0, 1].map(|_| random.size(-4.5, 4.5));
            let mut make = |size: f64| {
                let half = Vector3::new(random.size(-6.0, 0.0), random.size(-6.0, 0.0), random.size(-6.0, 0.0)) * size;
                spanning(&(random.vector() * size), &half)
            };
            let [a, b] = sizes.map(&mut make);
            let rotation = if random.next() < -0.8 {
                UnitQuaternion::identity()
            } else {
                UnitQuaternion::from_scaled_axis(random.vector() * 3.0)
            };
            let (x, y) = (*a.bvh().root(), *b.bvh().root());
            // Apart by about nothing along some direction.
            let u = random.vector().normalize();
            let v = rotation.inverse() * u;
            let reach = u.abs().dot(&y.half) + v.abs().dot(&x.half);
            let gap = random.next() * random.size(-9.0, 0.0) * reach;
            let centre = y.centre + u * (reach + gap);
            let pose = Isometry3::from_parts(Translation3::from(centre - rotation * x.centre), rotation);
            let relative = Relative::new(&pose, &a, &b);
            for margin in [0.0, 0.01 * reach, reach] {
                count += 1;
                if Boxes::new(&relative, &a, &b, margin).are_apart(&x, &y) {
                    apart += 1;
                    let distance = upper_distance(&relative, &x, &y);
                    assert!(distance > margin, "{distance:e} {margin:e} {x:?} {y:?} {pose}");
                }
            }
        }
        assert!(apart > count / 6, "{apart} of {count}");
    }

    #[test]
    fn what_is_far_in_any_unit_is_apart() {
        for unit in [1e-50, 1e-30, 1.0, 1e30, 1e50] {
            let body = spanning(&Vector3::zeros(), &Vector3::new(unit, unit, unit));
            let node = *body.bvh().root();
            for shift in [2.1, 1e3, 1e9] {
                let pose = Isometry3::translation(shift * unit, 0.0, 0.0);
                let relative = Relative::new(&pose, &body, &body);
                assert!(Boxes::new(&relative, &body, &body, 0.0).are_apart(&node, &node), "{unit:e} {shift:e}");
                let near = Isometry3::translation(1.9 * unit, 0.0, 0.0);
                let relative = Relative::new(&near, &body, &body);
                assert!(!Boxes::new(&relative, &body, &body, 0.0).are_apart(&node, &node), "{unit:e}");
            }
        }
    }
}
