//! The forces that the contacts of a finger can exert together: a convex set of tuples, and its farthest point with a proof.
//!
//! The set is that of x = V z ([`Face`]: equations and friction cones) with `s_i <= cap_i` and `|torque_j . z| <=
//! limit_j`. It contains 0. What is farthest along a tuple of values v comes from one of two places. Where there are
//! no equations and every contact may do what is best for itself within the limits, that is the answer, in closed
//! form. Else it is that of a small convex [`ConeProgram`].
//!
//! # The proof
//!
//! For any numbers y_j and any tuple w with `V^T w = V^T v - sum y_j torque_j`,
//!
//! ```text
//! v.x = w.x + sum y_j torque_j . z <= sum_i cap_i max(0, w_i1 + |(w_i2, w_i3, w_i4)|) + sum_j |y_j| limit_j
//! ```
//!
//! for all x of the set: an upper bound in closed form. The duals of the program give y and w; what they leave of the
//! equation is put right, since V has orthonormal columns. The answer counts only if its value is within `gap` of the
//! bound.

use super::super::jacobian::MAX_JOINTS;
use super::UNSOLVED;
use super::face::{Face, MAX_CONTACTS, WIDTH, presses};
use super::program::{ConeProgram, Iterate};
use crate::math::{Accumulator, Vector, dot, norm};
use crate::scalar::Real;
use crate::support::Failure;

/// Interior point steps; 10 to 25 are usual.
const STEPS: usize = 50;
/// Roundoffs between value and bound at which there is nothing left to do.
const CLOSE: usize = 512;
/// Roundoffs between value and bound that are an answer, where the forces have a point well inside of their cones.
const GAP: usize = 1 << 12;

/// Forces x_i of all contacts, or values of them.
pub(super) type Tuple<T> = [[T; 4]; MAX_CONTACTS];

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tuples<T> {
    /// The rows of V_i.
    basis: [[[T; WIDTH]; 4]; MAX_CONTACTS],
    /// The largest s_i; 0: the contact cannot press.
    pub caps: [T; MAX_CONTACTS],
    /// Torques of the joints per z, and their limits; 0: none that counts.
    torques: [[T; WIDTH]; MAX_JOINTS],
    limits: [T; MAX_JOINTS],
    /// Strictly inside of everything.
    start: [T; WIDTH],
    /// No equations: V is a permutation.
    free: bool,
    /// How far a value may be below its bound, for values of size 1.
    pub gap: T,
}

impl<T: Real> Tuples<T> {
    /// With `rows` the torques per contact force, and limits of which 0 is none. `free`: the face has no equations.
    pub fn new(
        face: &Face<T>,
        mut caps: [T; MAX_CONTACTS],
        rows: &[[T; WIDTH]; MAX_JOINTS],
        mut limits: [T; MAX_JOINTS],
        free: bool,
    ) -> Self {
        let zero = T::zero();
        for i in 0..MAX_CONTACTS {
            if !presses(&face.forces[i]) {
                caps[i] = zero;
            }
        }
        // |z| = |x| is at most that.
        let farthest = T::count(2) * caps.iter().fold(zero, |s, &cap| s + cap);
        let mut torques = [[zero; WIDTH]; MAX_JOINTS];
        for j in 0..MAX_JOINTS {
            for (i, map) in face.forces.iter().enumerate() {
                for c in 0..4 {
                    let torque = (0..4).fold(zero, |s, f| s + rows[j][4 * i + f] * map[c][f]);
                    for d in 0..WIDTH {
                        torques[j][d] += torque * face.basis[i][c][d];
                    }
                }
            }
            // Rows of unit length: a dual is then of the size of what it does. What the equations have left may not reach the limit any
            // more.
            let length = norm(&Vector::from(torques[j]));
            let reached = limits[j] < length * farthest;
            limits[j] = if reached { limits[j] / length } else { zero };
            torques[j] = torques[j].map(|x| if reached { x / length } else { zero });
        }
        // Half of the way from 0 to the first cap or limit.
        let share = |part: T, most: T| if most > zero { part.abs() / most } else { zero };
        let at = |row: &[T; WIDTH]| dot(row, &face.inside);
        let pressed = face.basis.iter().zip(&caps).fold(zero, |m, ([s, ..], &cap)| m.at_least(share(at(s), cap)));
        let used = torques.iter().zip(&limits).fold(pressed, |m, (row, &limit)| m.at_least(share(at(row), limit)));
        let half = if used > zero { (used + used).recip() } else { zero };
        let gap = T::count(GAP) * T::ROUNDOFF * (T::one() + face.margin.recip());
        Self { basis: face.basis, caps, torques, limits, start: face.inside.map(|x| x * half), free, gap }
    }

    /// What each contact would do without the others, and the value of that: an upper bound.
    pub fn alone(&self, values: &Tuple<T>) -> (Tuple<T>, T) {
        let zero = T::zero();
        let (mut x, mut upper) = ([[zero; 4]; MAX_CONTACTS], zero);
        for ((x, &[s, a, b, c]), &cap) in x.iter_mut().zip(values).zip(&self.caps) {
            let y = (a * a + b * b + c * c).root();
            if s + y > zero && cap > zero {
                upper += cap * (s + y);
                let share = |part: T| if y > zero { cap * (part / y) } else { zero };
                *x = [cap, share(a), share(b), share(c)];
            }
        }
        (x, upper)
    }

    /// The tuple farthest along `values`, of size 1 or less, and an upper bound of its value, no more than `gap`
    /// above it. `contacts`: how many there are.
    pub fn farthest(&self, values: &Tuple<T>, contacts: usize) -> Result<(Tuple<T>, T), Failure> {
        let (alone, upper) = self.alone(values);
        if !(upper > T::zero()) || self.free && self.bears(&alone) {
            return Ok((alone, upper));
        }
        match contacts {
            1 => self.solve::<1, 4, 17>(values, upper),
            2 => self.solve::<2, 8, 18>(values, upper),
            3 => self.solve::<3, 12, 19>(values, upper),
            _ => self.solve::<4, 16, 20>(values, upper),
        }
    }

    /// Are the torques of x within the limits? Without equations.
    fn bears(&self, x: &Tuple<T>) -> bool {
        let mut z = [T::zero(); WIDTH];
        for (row, &x) in self.basis.iter().flatten().zip(x.iter().flatten()) {
            z.iter_mut().zip(row).for_each(|(z, &v)| *z += v * x);
        }
        self.torques.iter().zip(&self.limits).all(|(row, &limit)| limit.is_zero() || dot(row, &z).abs() <= limit)
    }

    /// For K contacts: N = 4 K coordinates; R = K caps and two sides of each limit.
    fn solve<const K: usize, const N: usize, const R: usize>(
        &self,
        values: &Tuple<T>,
        alone: T,
    ) -> Result<(Tuple<T>, T), Failure> {
        let zero = T::zero();
        let mut program = ConeProgram { cones: [[[zero; N]; 4]; K], rows: [[zero; N]; R], bounds: [zero; R] };
        let mut b = [zero; N];
        let mut sides = program.rows.iter_mut().zip(&mut program.bounds);
        for ((cone, own), (&cap, values)) in program.cones.iter_mut().zip(&self.basis).zip(self.caps.iter().zip(values))
        {
            *cone = own.each_ref().map(head);
            for (row, &value) in cone.iter().zip(values) {
                b.iter_mut().zip(row).for_each(|(b, &x)| *b += x * value);
            }
            sides.by_ref().take(1).for_each(|(row, bound)| (*row, *bound) = (cone[0], cap));
        }
        for (torque, &limit) in self.torques.iter().zip(&self.limits) {
            for (sign, (row, bound)) in [T::one(), -T::one()].into_iter().zip(sides.by_ref()) {
                if limit > zero {
                    (*row, *bound) = (head(torque).map(|x| x * sign), limit);
                }
            }
        }
        let (cone_duals, row_duals) = first_duals(&program, &b);
        let mut it = program.start(head(&self.start), cone_duals, row_duals);
        let (mut upper, mut lower, mut z) = (alone, zero, [zero; N]);
        for _ in 0..STEPS {
            upper = upper.at_most(bound(&program, &b, &it));
            let value = dot(&b, &it.z);
            if value > lower {
                (lower, z) = (value, it.z);
            }
            if upper - lower <= T::count(CLOSE) * T::ROUNDOFF {
                break;
            }
            let Some(next) = program.step(&b, &it) else { break };
            it = next;
        }
        if !(upper - lower <= self.gap) {
            return Err(Failure(UNSOLVED));
        }
        let mut x = [[zero; 4]; MAX_CONTACTS];
        for (x, rows) in x.iter_mut().zip(&program.cones) {
            *x = rows.each_ref().map(|row| dot(row, &z));
        }
        Ok((x, upper))
    }
}

/// Duals that prove a bound, too, and that are about as far from their edges as the start is from its own: w = V b.
fn first_duals<T: Real, const K: usize, const N: usize, const R: usize>(
    program: &ConeProgram<T, K, N, R>,
    b: &[T; N],
) -> ([[T; 4]; K], [T; R]) {
    let zero = T::zero();
    let w = program.cones.each_ref().map(|cone| cone.each_ref().map(|row| dot(row, b)));
    let product = w.iter().zip(&program.bounds).fold(zero, |s, (w, &cap)| s + cap * dot(w, w).root());
    let (mut cone_duals, mut row_duals) = ([[zero; 4]; K], [zero; R]);
    for r in 0..R {
        if program.bounds[r] > zero {
            row_duals[r] = product / program.bounds[r];
        }
    }
    for i in 0..K {
        row_duals[i] += row_duals[i];
        cone_duals[i] = w[i].map(|x| -x);
        cone_duals[i][0] += row_duals[i];
    }
    (cone_duals, row_duals)
}

/// The bound that the duals prove, rounding included.
///
/// What the duals leave of the equation is summed in twice the precision, so that its error is its own roundoff. Then
/// v.x of contact i has 10 roundoffs of its dual and its cap's, and `4 N` of that rest.
fn bound<T: Real, const K: usize, const N: usize, const R: usize>(
    program: &ConeProgram<T, K, N, R>,
    b: &[T; N],
    it: &Iterate<T, K, N, R>,
) -> T {
    let zero = T::zero();
    let rest: [T; N] = core::array::from_fn(|d| {
        let mut sum = Accumulator::new(b[d]);
        for (cone, dual) in program.cones.iter().zip(&it.cone_duals) {
            let seen = cone.iter().zip(dual).filter(|(row, _)| !row[d].is_zero());
            seen.for_each(|(row, &dual)| sum.add_product(row[d], dual));
        }
        let seen = program.rows.iter().zip(&it.row_duals).filter(|(row, _)| !row[d].is_zero());
        seen.for_each(|(row, &dual)| sum.add_product(row[d], -dual));
        sum.value()
    });
    let size = rest.iter().fold(zero, |s, x| s + x.abs());
    let mut sum = zero;
    for r in K..R {
        if program.bounds[r] > zero {
            sum += it.row_duals[r] * program.bounds[r];
        }
    }
    for i in 0..K {
        if program.bounds[i] > zero {
            let [s, a, b, c] = core::array::from_fn(|c| dot(&program.cones[i][c], &rest) - it.cone_duals[i][c]);
            let value = s + it.row_duals[i] + (a * a + b * b + c * c).root();
            let blur = T::count(10) * (it.cone_duals[i][0] + it.row_duals[i]) + T::count(4 * N) * size;
            sum += program.bounds[i] * zero.at_least(value + blur * T::ROUNDOFF);
        }
    }
    sum * (T::one() + T::count(4 * N) * T::ROUNDOFF)
}

/// The first N of M numbers.
fn head<T: Real, const M: usize, const N: usize>(from: &[T; M]) -> [T; N] {
    let mut to = [T::zero(); N];
    to.iter_mut().zip(from).for_each(|(to, &from)| *to = from);
    to
}
