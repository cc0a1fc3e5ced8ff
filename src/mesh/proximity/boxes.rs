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
