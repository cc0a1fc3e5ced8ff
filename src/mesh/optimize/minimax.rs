//! The least of the largest displacement: minimise max |v_i(y)| over a body's points, under contacts and a trust box.
//!
//! The displacement v_i(y) = v_i + J_i y of point r_i is affine in the motion y, J_i y = dt + w x r_i. So f_i = |v_i|^2 / 2
//! is a convex quadratic with Hessian J_i^T J_i, and the problem is min s, f_i(y) <= s. Newton's method on its optimality
//! conditions is a sequence of quadratic programs
//!
//! ```text
//! minimise over (d, s)   F s + d^T H d / 2 + e s^2 / 2      H = sum of l_i J_i^T J_i + a little of a reference body's
//! subject to             f_i + f_i'.d <= f_max + F s,   contacts and walls at y + d,          F = sqrt(2 f_max)
//! ```
//!
//! whose multipliers are the next weights l_i: at the optimum they are convex weights of the farthest points, the Hessian is that of the
//! Lagrangian, and convergence is quadratic but for the small terms in H and e, which make the program strictly convex and
//! vanish with d. A search along d for the least of the parabolas' maximum keeps far starts from overshooting. Where it cuts d, points with
//! little weight bend upwards along d, which H does not show: the program is solved once more with their quadratic term at d added to
//! f_i (a second-order correction), the better of both steps is taken, and the reference body counts for more in the next.
//!
//! **Which points.** Only those that have once been the farthest take part; a new one is looked for after each step, in the whole body, by
//! the caller's hierarchy.
//!
//! **The bound.** For convex weights l and multipliers u >= 0 the Lagrangian L(y) = sum l_i f_i(y) - sum u_k (a_k.y - b_k) is not above
//! the optimum F*^2 / 2 at the optimal y*, and is convex, so F*^2 / 2 >= L(y+) + L'(y+).(y* - y+). By the program's stationarity the gradient
//! is L'(y+) = sum (l_i - l_i') J_i^T J_i d, new against old weights: forces on the points themselves, whose displacements between
//! y+ and y* are at most F_best + |v_i(y+)|. So
//!
//! ```text
//! F*^2 / 2 >= L(y+) - sum |l_i - l_i'| |J_i d| (F_best + |v_i(y+)|)
//! ```
//!
//! which needs no trust region and closes as fast as d vanishes.

use super::Linear;
use super::project::{End, LAST, Row, project};
use super::quadratic::{Factor, walls};
use heapless::Vec;
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};

/// Points that take part at one time.
pub const MEMBERS: usize = 24;
/// Weight of the reference body in the Hessian.
const REFERENCE: f64 = 1e-3;
/// sqrt(e).
const DAMPING: f64 = 1e-2;
/// A step that is best cut below this fraction is tried again with the constraints' curvature.
const CURVED: f64 = 0.9;
/// Programs at most; three to six are usual.
const MAX_PROGRAMS: usize = 40;

/// An affine field of displacements, in the body's axes: `matrix` r + `vector`.
#[derive(Clone, Copy, Debug)]
pub struct Field {
    pub matrix: Matrix3<f64>,
    pub vector: Vector3<f64>,
}

impl Field {
    pub fn at(&self, r: &Vector3<f64>) -> Vector3<f64> {
        self.matrix * r + self.vector
    }

    /// The field after a motion y of a body of this radius.
    pub fn moved(&self, y: &Vector6<f64>, radius: f64) -> Field {
        let (linear, angular) = split(y, radius);
        Field { matrix: self.matrix + angular.cross_matrix(), vector: self.vector + linear }
    }
}

fn split(y: &Vector6<f64>, radius: f64) -> (Vector3<f64>, Vector3<f64>) {
    (y.fixed_rows::<3>(0).into_owned(), y.fixed_rows::<3>(3) / radius)
}

/// J y.
fn motion(r: &Vector3<f64>, y: &Vector6<f64>, radius: f64) -> Vector3<f64> {
    let (linear, angular) = split(y, radius);
    linear + angular.cross(r)
}

/// J^T f: a force at r, as a force and a moment over the radius.
pub fn wrench(r: &Vector3<f64>, force: &Vector3<f64>, radius: f64) -> Vector6<f64> {
    let moment = r.cross(force) / radius;
    Vector6::new(force.x, force.y, force.z, moment.x, moment.y, moment.z)
}

/// Sum of weight J^T J over weighted points.
pub fn stiffness<'a>(points: impl Iterator<Item = (f64, &'a Vector3<f64>)>, radius: f64) -> Matrix6<f64> {
    let (mut mass, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
    for (weight, r) in points {
        mass += weight;
        first += r * (weight / radius);
        second += r * r.transpose() * (weight / (radius * radius));
    }
    let arm = first.cross_matrix();
    let inertia = Matrix3::identity() * second.trace() - second;
    let mut all = Matrix6::zeros();
    all.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * mass));
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(&-arm);
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(&arm);
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
    all
}

/// A body's points as this problem needs them.
pub struct Body<'a, P> {
    /// The farthest point under a field of displacements, and its squared displacement.
    pub farthest: P,
    /// Points that span the body, equally weighted.
    pub reference: &'a [Vector3<f64>],
    /// Their stiffness, at a total weight of 1.
    pub stiffness: &'a Matrix6<f64>,
    pub radius: f64,
}

struct Member {
    r: Vector3<f64>,
    weight: f64,
}

/// A minimax's solution.
pub struct Solution {
    pub y: Vector6<f64>,
    pub value: f64,
    pub lower: f64,
    pub programs: usize,
    pub closed: bool,
}

/// Minimises from a feasible y.
pub fn minimise<P>(
    body: &Body<'_, P>,
    field: &Field,
    contacts: &[Linear],
    trust: f64,
    tolerance: f64,
    start: Vector6<f64>,
    rows: &mut std::vec::Vec<Row>,
) -> Solution
where
    P: Fn(&Field) -> (Vector3<f64>, f64),
{
    let radius = body.radius;
    let mut y = start;
    let mut members: Vec<Member, MEMBERS> = Vec::new();
    let mut reference = 1.0;
    let (r, square) = (body.farthest)(&field.moved(&y, radius));
    meet(&mut members, r);
    let first = square.sqrt();
    let mut best = Solution { y, value: first, lower: 0.0, programs: 0, closed: false };
    while best.programs < MAX_PROGRAMS {
        let here = field.moved(&y, radius);
        let square = members.iter().fold(0.0, |m, p| f64::max(m, here.at(&p.r).norm_squared()));
        let size = square.sqrt();
        // The pose itself is within reach, or as good as.
        if !(best.value > (1e-9 * first).max(1e-13 * radius)) || !(size > 0.0) {
            best.closed = true;
            best.lower = 0.0;
            return best;
        }
        let weighted = members.iter().map(|p| (p.weight, &p.r));
        let factor = Factor::new(&(stiffness(weighted, radius) + body.stiffness * reference));

        rows.clear();
        for c in contacts.iter().copied().chain(walls(trust)) {
            // y satisfies all, to rounding that must not make the program empty.
            rows.push(Row::new(factor.forward(&c.normal), (c.offset - c.normal.dot(&y)).min(0.0)));
        }
        let program = StepProgram { body, members: &members, here, size, factor, constraints: rows.len(), reference };
        let Some(proposal) = best.proposed_by(&program, rows) else { return best };
        let Proposal { d, weights, fraction, .. } = proposal;
        y += d * fraction;
        for (p, new) in members.iter_mut().zip(&weights) {
            p.weight += fraction * (new - p.weight);
        }
        reference = if fraction > 0.5 { (reference * 0.1).max(REFERENCE) } else { (reference * 10.0).min(1.0) };
        let (r, square) = (body.farthest)(&field.moved(&y, radius));
        if square.sqrt() < best.value {
            best.y = y;
            best.value = square.sqrt();
        }
        meet(&mut members, r);
        if best.value - best.lower <= tolerance * best.value {
            best.closed = true;
            return best;
        }
    }
    best
}

impl Solution {
    /// The step that a program proposes, corrected for curvature where it is cut short; takes over its lower bound.
    fn proposed_by<P>(&mut self, program: &StepProgram<'_, P>, rows: &mut std::vec::Vec<Row>) -> Option<Proposal>
    where
        P: Fn(&Field) -> (Vector3<f64>, f64),
    {
        let mut proposal = program.propose(rows, self.value, None)?;
        self.programs += 1;
        self.lower = self.lower.max(proposal.lower);
        if proposal.fraction < CURVED {
            let corrected = program.propose(rows, self.value, Some(&proposal.d))?;
            self.programs += 1;
            self.lower = self.lower.max(corrected.lower);
            if corrected.height < proposal.height {
                proposal = corrected;
            }
        }
        Some(proposal)
    }
}

/// Takes a point among the members, if need be in the place of the one with the least weight.
fn meet(members: &mut Vec<Member, MEMBERS>, r: Vector3<f64>) {
    if members.iter().any(|p| p.r == r) {
        return;
    }
    if members.is_full()
        && let Some(least) = (0..members.len()).min_by(|&i, &j| members[i].weight.total_cmp(&members[j].weight))
    {
        members.swap_remove(least);
    }
    let _ = members.push(Member { r, weight: 0.0 });
}

/// One quadratic program at a point y.
struct StepProgram<'a, P> {
    body: &'a Body<'a, P>,
    members: &'a [Member],
    /// The field of displacements at y.
    here: Field,
    /// F: the largest displacement of a member at y.
    size: f64,
    factor: Factor,
    /// The rows of contacts and walls, which are there already.
    constraints: usize,
    /// Weight of the reference body.
    reference: f64,
}

/// What a program proposes.
struct Proposal {
    d: Vector6<f64>,
    /// Convex weights of the members.
    weights: [f64; MEMBERS],
    /// The bound of the whole problem that the program's multipliers prove.
    lower: f64,
    /// How far along d the members' largest displacement is least, and its square there.
    fraction: f64,
    height: f64,
}

impl<P> StepProgram<'_, P> {
    /// Solves the program. With a `curved` step, the members' constraints have the quadratic term that they have at that step.
    fn propose(&self, rows: &mut std::vec::Vec<Row>, most: f64, curved: Option<&Vector6<f64>>) -> Option<Proposal> {
        let radius = self.body.radius;
        rows.truncate(self.constraints);
        for p in self.members {
            let v = self.here.at(&p.r);
            let mut normal = self.factor.forward(&wrench(&p.r, &(v * (-DAMPING / self.size)), radius));
            normal[LAST] = 1.0;
            let bend = curved.map_or(0.0, |d| motion(&p.r, d, radius).norm_squared());
            let excess = (v.norm_squared() + bend - self.size * self.size) / (2.0 * self.size);
            rows.push(Row::new(normal, DAMPING * excess + self.size / DAMPING));
        }
        let projected = project(rows, 7);
        if projected.end != End::Found {
            return None;
        }
        let d = self.factor.backward(&projected.point);

        let mut weights = [0.0; MEMBERS];
        for &(row, u) in &projected.active {
            if row >= self.constraints {
                weights[row - self.constraints] = u / rows[row].length * (DAMPING / self.size);
            }
        }
        let total: f64 = weights.iter().sum();
        if !(total > 0.0) {
            return None;
        }
        weights = weights.map(|w| w / total);

        let after = self.here.moved(&d, radius);
        let slip = |r: &Vector3<f64>| motion(r, &d, radius).norm() * (most + after.at(r).norm());
        let mut lagrangian = 0.0;
        for (p, new) in self.members.iter().zip(&weights) {
            lagrangian += new * 0.5 * after.at(&p.r).norm_squared() - (new - p.weight / total).abs() * slip(&p.r);
        }
        let share = self.reference / (total * self.body.reference.len() as f64);
        lagrangian -= self.body.reference.iter().map(|r| share * slip(r)).sum::<f64>();
        for &(row, u) in &projected.active {
            if let Some(row) = rows[..self.constraints].get(row) {
                // a.(y + d) - b, in the program's coordinates.
                lagrangian += u / total * row.violation(&projected.point);
            }
        }
        let lower = (2.0 * lagrangian).max(0.0).sqrt();
        let (fraction, height) = least_of_parabolas(self.members, &self.here, &d, radius);
        Some(Proposal { d, weights, lower, fraction, height })
    }
}

/// The fraction of a step with the least maximum of the members' squared displacements, each a parabola of it, and that maximum.
fn least_of_parabolas(members: &[Member], here: &Field, d: &Vector6<f64>, radius: f64) -> (f64, f64) {
    let mut parabolas: Vec<[f64; 3], MEMBERS> = Vec::new();
    for p in members {
        let (v, m) = (here.at(&p.r), motion(&p.r, d, radius));
        let _ = parabolas.push([v.norm_squared(), 2.0 * v.dot(&m), m.norm_squared()]);
    }
    // The highest parabola, and its slope, which tells on which side the least lies.
    let highest = |t: f64| {
        let mut highest = (f64::NEG_INFINITY, 0.0);
        for [a, b, c] in &parabolas {
            let height = a + t * (b + t * c);
            if height > highest.0 {
                highest = (height, b + 2.0 * t * c);
            }
        }
        highest
    };
    let end = highest(1.0);
    if end.1 <= 0.0 {
        return (1.0, end.0);
    }
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..12 {
        let middle = 0.5 * (low + high);
        if highest(middle).1 > 0.0 { high = middle } else { low = middle }
    }
    let least = if low > 0.0 { low } else { high };
    (least, highest(least).0)
}
