//! The nearest point to the origin in a polyhedron: minimise |x|^2 / 2 subject to n_i.x >= b_i, |n_i| = 1.
//!
//! Every strictly convex quadratic program is this one in other coordinates (module `quadratic`). It is solved by the dual
//! active-set method of Goldfarb and Idnani (*A numerically stable dual method for solving strictly convex quadratic
//! programs*, 1983), which with the identity as Hessian needs no other matrix than a factorisation N = Q R of the normals of
//! the active constraints. It begins with the origin and no constraint; then takes the most violated constraint, and
//! moves towards its plane along the others' intersection, dropping those whose multiplier falls to zero on the way. The
//! dual objective grows with each step, so no set of constraints comes twice and no first feasible point is needed. A constraint that can
//! neither be reached nor traded for another proves the polyhedron empty.
//!
//! The iterate and its multipliers are computed anew from Q, R after each full step (x = Q R^-T b, u = R^-1 R^-T b), so
//! they carry no errors along. Constraints whose normals depend on the active ones to [`DEPENDENT`] count as dependent, and those
//! violated by less than [`DEPENDENT`] times the sizes in question as satisfied: the same number, so that rounding cannot trade
//! two equal constraints for each other for ever.

use crate::math::dot;
use heapless::Vec;

/// Room for seven dimensions; eight numbers go through vector registers without a rest.
pub const WIDTH: usize = 8;
/// The coordinate after the six of the motion.
pub const LAST: usize = 6;
/// See the module's head.
const DEPENDENT: f64 = 1e-11;
/// Of the point's last coordinate, for rows that do not have it: the basis mixes coordinates.
const ROUNDING: f64 = 1e-14;
/// Steps at most; some twenty are usual.
const MAX_STEPS: usize = 300;

/// A vector of at most seven dimensions; the rest is zero.
pub type Wide = [f64; WIDTH];

/// n.x >= b.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// Of length 1, or zero.
    pub normal: Wide,
    pub offset: f64,
    /// The length of the normal before it became 1: the multiplier of the given row is that of this one over it.
    pub length: f64,
}

impl Row {
    pub fn new(normal: Wide, offset: f64) -> Self {
        let length = dot(&normal, &normal).sqrt();
        // A row of zeros says 0 >= b.
        let scale = if length > 0.0 { 1.0 / length } else { 1.0 };
        Row { normal: normal.map(|x| x * scale), offset: offset * scale, length: 1.0 / scale }
    }

    /// b - n.x: positive where violated.
    pub fn violation(&self, x: &Wide) -> f64 {
        self.offset - dot(&self.normal, x)
    }
}

/// How a projection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The nearest point.
    Found,
    /// There is no point: the constraints contradict each other.
    Empty,
    /// The limit of steps was reached: the point is that of the active constraints alone.
    Limit,
}

/// A projection's result.
#[derive(Clone, Debug)]
pub struct Projected {
    pub point: Wide,
    pub end: End,
    /// The active rows with their multipliers: point = sum of u n.
    pub active: Vec<(usize, f64), WIDTH>,
}

/// The nearest point to the origin of the polyhedron in the first `dimension` coordinates (at most 7).
pub fn project(rows: &[Row], dimension: usize) -> Projected {
    let mut state = State::new(dimension.min(WIDTH - 1));
    let end = state.run(rows);
    let active = (0..state.count).map(|i| (state.rows[i], state.multipliers[i])).collect();
    Projected { point: state.point, end, active }
}

struct State {
    dimension: usize,
    count: usize,
    /// Orthonormal; the first `count` span the active normals.
    basis: [Wide; WIDTH],
    /// Columns of the triangular factor: normal i = sum over k <= i of `factor[i][k]` `basis[k]`.
    factor: [Wide; WIDTH],
    rows: [usize; WIDTH],
    multipliers: Wide,
    point: Wide,
}

impl State {
    fn new(dimension: usize) -> Self {
        let mut basis = [[0.0; WIDTH]; WIDTH];
        for i in 0..WIDTH {
            basis[i][i] = 1.0;
        }
        let zero = [0.0; WIDTH];
        State { dimension, count: 0, basis, factor: [zero; WIDTH], rows: [0; WIDTH], multipliers: zero, point: zero }
    }

    fn run(&mut self, rows: &[Row]) -> End {
        let mut steps = 0;
        while let Some(most) = self.most_violated(rows) {
            let row = &rows[most];
            loop {
                steps += 1;
                if steps > MAX_STEPS {
                    return End::Limit;
                }
                let along: Wide = core::array::from_fn(|k| dot(&self.basis[k], &row.normal));
                let rest: f64 = (self.count..self.dimension).map(|k| along[k] * along[k]).sum();
                let trade = self.solve_factor(along);
                let (leaving, most_dual) = self.blocking(&trade);
                let independent = rest > DEPENDENT * DEPENDENT;
                let full = if independent { row.violation(&self.point) / rest } else { f64::INFINITY };
                let step = full.min(most_dual);
                if step == f64::INFINITY {
                    return End::Empty;
                }
                for i in 0..self.count {
                    self.multipliers[i] -= step * trade[i];
                }
                if full <= most_dual {
                    self.enter(most, along);
                    self.recompute(rows);
                    break;
                }
                if independent {
                    for k in self.count..self.dimension {
                        for j in 0..WIDTH {
                            self.point[j] += step * along[k] * self.basis[k][j];
                        }
                    }
                }
                self.leave(leaving);
            }
        }
        End::Found
    }

    /// The row that is most violated, if any is beyond rounding.
    fn most_violated(&self, rows: &[Row]) -> Option<usize> {
        // The last coordinate, large in one program, counts for the rows that have it.
        let (last, mut others) = (self.point[LAST].abs(), self.point);
        others[LAST] = 0.0;
        let size = dot(&others, &others).sqrt();
        let active = &self.rows[..self.count];
        let mut most = (0.0, None);
        for (i, row) in rows.iter().enumerate() {
            let violation = row.violation(&self.point);
            let sizes = || size + last * row.normal[LAST].abs() + row.offset.abs();
            // An active row is met, as well as rounding lets it.
            if violation > most.0 && violation > DEPENDENT * sizes() + ROUNDING * last && !active.contains(&i) {
                most = (violation, Some(i));
            }
        }
        most.1
    }

    /// R^-1 d: how the active multipliers fall when the new one grows.
    fn solve_factor(&self, mut d: Wide) -> Wide {
        for i in (0..self.count).rev() {
            d[i] /= self.factor[i][i];
            for k in 0..i {
                d[k] -= self.factor[i][k] * d[i];
            }
        }
        d
    }

    /// Which active multiplier is zero first, and after which step.
    fn blocking(&self, trade: &Wide) -> (usize, f64) {
        let mut first = (0, f64::INFINITY);
        for i in 0..self.count {
            if trade[i] > DEPENDENT && self.multipliers[i] / trade[i] < first.1 {
                first = (i, self.multipliers[i] / trade[i]);
            }
        }
        first
    }

    /// Adds a row whose normal has these coordinates in the basis.
    fn enter(&mut self, row: usize, mut along: Wide) {
        let at = self.count;
        for k in (at + 1..self.dimension).rev() {
            let (low, high) = self.basis.split_at_mut(k);
            along[k - 1] = rotate(along[k - 1], along[k], &mut low[k - 1], &mut high[0]);
            along[k] = 0.0;
        }
        self.factor[at] = along;
        self.rows[at] = row;
        self.count += 1;
    }

    /// Drops an active row.
    fn leave(&mut self, at: usize) {
        self.count -= 1;
        for i in at..self.count {
            self.factor[i] = self.factor[i + 1];
            self.rows[i] = self.rows[i + 1];
            self.multipliers[i] = self.multipliers[i + 1];
        }
        // Each column now reaches one below the diagonal.
        for i in at..self.count {
            let (a, b) = (self.factor[i][i], self.factor[i][i + 1]);
            let length = a.hypot(b);
            let (c, s) = if length > 0.0 { (a / length, b / length) } else { (1.0, 0.0) };
            for column in &mut self.factor[i..self.count] {
                (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
            }
            let (low, high) = self.basis.split_at_mut(i + 1);
            turn(c, s, &mut low[i], &mut high[0]);
        }
    }

    /// The point and the multipliers from the active rows.
    fn recompute(&mut self, rows: &[Row]) {
        let mut w = [0.0; WIDTH];
        self.point = [0.0; WIDTH];
        for i in 0..self.count {
            let known: f64 = (0..i).map(|k| self.factor[i][k] * w[k]).sum();
            w[i] = (rows[self.rows[i]].offset - known) / self.factor[i][i];
            for j in 0..WIDTH {
                self.point[j] += w[i] * self.basis[i][j];
            }
        }
        // Zero but for rounding where the method says they cannot be negative.
        self.multipliers = self.solve_factor(w).map(|u| u.max(0.0));
    }
}

/// Turns two orthonormal vectors in their plane so that coordinates (a, b) become (length, 0); returns the length.
fn rotate(a: f64, b: f64, p: &mut Wide, q: &mut Wide) -> f64 {
    let length = a.hypot(b);
    if b != 0.0 {
        turn(a / length, b / length, p, q);
    }
    if b != 0.0 { length } else { a }
}

fn turn(c: f64, s: f64, p: &mut Wide, q: &mut Wide) {
    for j in 0..WIDTH {
        (p[j], q[j]) = (c * p[j] + s * q[j], c * q[j] - s * p[j]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Random numbers in [-1, 1).
    struct Noise(u64);

    impl Noise {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        }

        fn row(&mut self, dimension: usize) -> Row {
            let normal = core::array::from_fn(|k| if k < dimension { self.next() } else { 0.0 });
            Row::new(normal, 0.3 * self.next())
        }
    }

    /// Stationary, feasible, complementary: the conditions that are necessary and sufficient.
    fn assert_optimal(rows: &[Row], found: &Projected) {
        let size = 1.0 + dot(&found.point, &found.point).sqrt();
        let mut sum = [0.0; WIDTH];
        for &(row, u) in &found.active {
            assert!(u >= 0.0 && rows[row].violation(&found.point).abs() < 1e-9 * size);
            for k in 0..WIDTH {
                sum[k] += u * rows[row].normal[k];
            }
        }
        for k in 0..WIDTH {
            assert!((sum[k] - found.point[k]).abs() < 1e-9 * size, "{sum:?} {:?}", found.point);
        }
        assert!(rows.iter().all(|row| row.violation(&found.point) < 1e-9 * size));
    }

    /// In the plane by trial: a polygon that is not empty has a corner, or a line's nearest point to the origin, or the origin.
    fn planar_feasible(rows: &[Row]) -> bool {
        let satisfied = |x: [f64; 2]| {
            let mut wide = [0.0; WIDTH];
            wide[..2].copy_from_slice(&x);
            rows.iter().all(|row| row.violation(&wide) < 1e-12)
        };
        let lines = || rows.iter().map(|row| (row.normal[0], row.normal[1], row.offset));
        let crossing = lines().flat_map(|a| lines().map(move |b| (a, b))).any(|((a, b, e), (c, d, f))| {
            let det = a * d - b * c;
            det.abs() > 1e-12 && satisfied([(e * d - b * f) / det, (a * f - e * c) / det])
        });
        crossing || lines().any(|(a, b, e)| satisfied([a * e, b * e])) || satisfied([0.0, 0.0])
    }

    #[test]
    fn random_polyhedra_satisfy_the_conditions_of_optimality() {
        let mut noise = Noise(1);
        let (mut found, mut empty) = (0, 0);
        for run in 0..2000 {
            let dimension = 1 + run % 7;
            let count = [0, 1, 3, 8, 20, 60, 300][run / 7 % 7];
            let mut rows: std::vec::Vec<Row> = (0..count).map(|_| noise.row(dimension)).collect();
            // Repeated rows, nearly repeated, and opposite ones with no room between.
            for k in 1..rows.len() {
                let before = rows[k - 1];
                match k % 9 {
                    3 => rows[k] = before,
                    5 => rows[k] = Row::new(before.normal.map(|x| x * (1.0 + 1e-13)), before.offset),
                    7 => rows[k] = Row::new(before.normal.map(|x| -x), -before.offset),
                    _ => {}
                }
            }
            let result = project(&rows, dimension);
            match result.end {
                End::Found => {
                    found += 1;
                    assert_optimal(&rows, &result);
                    assert!(dimension != 2 || planar_feasible(&rows));
                }
                End::Empty => {
                    empty += 1;
                    assert!(dimension != 2 || !planar_feasible(&rows));
                }
                End::Limit => panic!("run {run}"),
            }
        }
        assert!(found > 500 && empty > 200, "{found} {empty}");
    }

    #[test]
    fn a_row_of_zeros_says_nothing_or_everything() {
        let zeros = |offset| Row::new([0.0; WIDTH], offset);
        assert_eq!(project(&[zeros(-1.0)], 6).end, End::Found);
        assert_eq!(project(&[zeros(0.0)], 6).end, End::Found);
        assert_eq!(project(&[zeros(1.0)], 6).end, End::Empty);
    }
}
