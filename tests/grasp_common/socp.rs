//! d of a grasp by second-order cone programs in the contact forces themselves: independent of wrench sets and their support
//! functions.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSettingsBuilder, DefaultSolver, IPSolver, SupportedConeT};
use qdist::Vector;
use qdist::grasp::{Contact, HandContact, Norm, WrenchFrame};

use super::{contact_map, radii};

/// The largest t with t q in W, and the direction that proves it: contact forces in their cones and, with a Jacobian, in
/// its range.
pub fn ray(
    hand: &[HandContact<f64>],
    frame: &WrenchFrame<f64>,
    norm: Norm,
    q: &Vector<f64, 6>,
) -> Option<(f64, Vector<f64, 6>)> {
    let joints = |h: &HandContact<f64>| h.jacobian.map_or(0, |j| j.joints());
    let size = 1 + hand.iter().map(|h| 4 + joints(h)).sum::<usize>();
    let mut rows: Vec<Vec<f64>> = (0..6).map(|_| vec![0.0; size]).collect();
    (0..6).for_each(|i| rows[i][0] = q[i]);
    let (mut equal, mut limits, mut cones) = (Vec::new(), Vec::new(), Vec::new());
    let mut shared = vec![0.0; size];
    let mut at = 1;
    for h in hand {
        let g = contact_map(&h.contact, frame);
        let r = radii(&h.contact, frame);
        let unit = |j: usize, x: f64| {
            let mut row = vec![0.0; size];
            row[j] = x;
            row
        };
        for j in 0..4 {
            (0..6).for_each(|i| rows[i][at + j] = -g[j][i]);
            let scale = if j == 3 { frame.torque_scale() } else { 1.0 };
            if let Some(jacobian) = h.jacobian {
                let mut row = unit(at + j, 1.0);
                (0..jacobian.joints()).for_each(|k| row[at + 4 + k] = -scale * jacobian.entry(j, k).unwrap());
                equal.push(row);
            }
        }
        let mut cone = vec![unit(at, -1.0)];
        for j in 0..3 {
            match r[j] > 0.0 {
                true => cone.push(unit(at + 1 + j, -1.0 / r[j])),
                false => equal.push(unit(at + 1 + j, 1.0)),
            }
        }
        cones.push(cone);
        let cap = h.contact.force_cap();
        shared[at] = 1.0 / cap;
        limits.push((unit(at, 1.0), cap));
        at += 4 + joints(h);
    }
    if norm == Norm::L1 {
        limits = vec![(shared, 1.0)];
    }
    let mut kinds = vec![SupportedConeT::ZeroConeT(6 + equal.len()), SupportedConeT::NonnegativeConeT(limits.len())];
    rows.extend(equal);
    let mut b = vec![0.0; rows.len()];
    b.extend(limits.iter().map(|(_, cap)| *cap));
    rows.extend(limits.into_iter().map(|(row, _)| row));
    for cone in cones {
        kinds.push(SupportedConeT::SecondOrderConeT(cone.len()));
        b.extend(cone.iter().map(|_| 0.0));
        rows.extend(cone);
    }
    let mut cost = vec![0.0; size];
    cost[0] = -1.0;
    let settings = DefaultSettingsBuilder::default()
        .verbose(false)
        .tol_gap_abs(1e-13)
        .tol_gap_rel(1e-13)
        .tol_feas(1e-13)
        .build()
        .unwrap();
    let (p, a) = (CscMatrix::zeros((size, size)), CscMatrix::from(&rows));
    let mut solver = DefaultSolver::new(&p, &cost, &a, &b, &kinds, settings).unwrap();
    solver.solve();
    let solution = &solver.solution;
    // What the gap does not prove is not told.
    if !((solution.obj_val - solution.obj_val_dual).abs() < 1e-11 * (1.0 + solution.obj_val.abs())) {
        return None;
    }
    let u: Vector<f64, 6> = Vector::from_fn(|i, _| solution.z[i]);
    let u = if u.dot(q) < 0.0 { -u } else { u };
    Some((solution.x[0], u.normalize()))
}

/// The least contact forces against an external wrench. Unknowns: the size, and per contact (f1, x) with |x| <= f1, where the force is cap (f1, mu x1, mu x2, mus x3).
/// The six equations of equilibrium come first, each divided by its largest coefficient; the objective is the size, in units of `unit`.
pub struct LeastForces {
    rows: Vec<Vec<f64>>,
    b: Vec<f64>,
    cones: Vec<SupportedConeT<f64>>,
    pub unit: f64,
}

impl LeastForces {
    pub fn new(contacts: &[Contact<f64>], frame: &WrenchFrame<f64>, norm: Norm, external: &Vector<f64, 6>) -> Self {
        let m = contacts.len();
        let n = 1 + 4 * m;
        let single = |at: usize, x: f64| (0..n).map(|j| if j == at { x } else { 0.0 }).collect::<Vec<f64>>();
        let unit = external.amax();
        let mut rows = vec![vec![0.0; n]; 6];
        let mut b = vec![0.0; 6];
        for (i, c) in contacts.iter().enumerate() {
            let (map, r) = (contact_map(c, frame), radii(c, frame));
            for j in 0..4 {
                let column = map[j] * c.force_cap() * if j == 0 { 1.0 } else { r[j - 1] };
                (0..6).for_each(|k| rows[k][1 + 4 * i + j] = column[k]);
            }
        }
        for k in 0..6 {
            let scale = rows[k].iter().fold(0.0f64, |s, x| s.max(x.abs()));
            let scale = if scale > 0.0 { scale } else { 1.0 };
            rows[k].iter_mut().for_each(|x| *x /= scale);
            b[k] = -external[k] / unit / scale;
        }
        let mut cones = vec![SupportedConeT::ZeroConeT(6)];
        match norm {
            Norm::LInf => {
                rows.extend((0..m).map(|i| single(1 + 4 * i, 1.0)));
                cones.push(SupportedConeT::NonnegativeConeT(m));
            }
            Norm::L1 => {
                rows.push((0..n).map(|j| if j % 4 == 1 { 1.0 } else { 0.0 }).collect());
                cones.push(SupportedConeT::NonnegativeConeT(1));
            }
        }
        rows[6..].iter_mut().for_each(|row| row[0] = -1.0);
        for i in 0..m {
            rows.extend((0..4).map(|j| single(1 + 4 * i + j, -1.0)));
            cones.push(SupportedConeT::SecondOrderConeT(4));
        }
        b.resize(rows.len(), 0.0);
        Self { rows, b, cones, unit }
    }

    pub fn solved(&self, settings: DefaultSettings<f64>) -> DefaultSolver<f64> {
        let n = self.rows[0].len();
        let cost: Vec<f64> = (0..n).map(|j| if j == 0 { 1.0 } else { 0.0 }).collect();
        let (p, a) = (CscMatrix::zeros((n, n)), CscMatrix::from(&self.rows));
        let mut solver = DefaultSolver::new(&p, &cost, &a, &self.b, &self.cones, settings).unwrap();
        solver.solve();
        solver
    }

    /// How far from equilibrium, in units of `unit`: the root of the sum of squares of the equations' errors.
    pub fn residual(&self, x: &[f64]) -> f64 {
        let error = |(row, b): (&Vec<f64>, &f64)| row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>() - b;
        self.rows[..6].iter().zip(&self.b).map(error).map(|e| e * e).sum::<f64>().sqrt()
    }
}
