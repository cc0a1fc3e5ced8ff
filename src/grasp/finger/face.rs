//! Which contact forces equations leave to the contacts of a finger: a subspace, and a point inside of all their
//! friction cones.
//!
//! The force of contact i is `f_i = F_i x_i` with x_i in the cone L = { (s, y) in R^4 : |y| <= s }, s its normal
//! force. Equations that the forces of all contacts obey together (they are made by joints; a joint bears nothing)
//! leave `x = V z`, V with orthonormal columns. An optimum has a certificate that is known to rounding only where
//! some z has `V_i z` inside of all cones, and then the wider the better: the z and t <= 1 of
//!
//! ```text
//! maximise t   subject to   |y_i| + t <= s_i for (s_i, y_i) = V_i z, |z_j| <= 1.
//! ```
//!
//! Where t is zero its dual says why: some w_i in L, not all zero, with `sum V_i^T w_i = 0`, so that `w_i . x_i = 0` for all
//! possible x. A w_i inside of L leaves x_i = 0: contact i cannot press. One on the boundary of L leaves the ray
//! opposite to it. In both cases F_i has fewer columns, and the question is asked again. So the cones that remain are
//! the smallest face of the product of all cones that holds the possible forces (J. Borwein and H. Wolkowicz,
//! *Regularizing the abstract convex program*, 1981), decided with a tolerance: in exact arithmetic a force on the
//! edge of the cone is active, and one beside it is not.

use super::super::svd::Triangular;
use super::program::ConeProgram;
use crate::math::dot;
use crate::scalar::Real;

/// The largest number of contacts of a finger.
pub const MAX_CONTACTS: usize = 4;
/// Coordinates of all contact forces.
pub(super) const WIDTH: usize = 4 * MAX_CONTACTS;
/// Interior point steps until the point is not worth more.
const STEPS: usize = 60;

/// The forces f_i = F_i V_i z, the point z inside, and how far inside it is.
pub(super) struct Face<T> {
    /// F_i by columns: the first belongs to s, the others to y. All zero: the contact cannot press.
    pub forces: [[[T; 4]; 4]; MAX_CONTACTS],
    /// The rows of V_i; zero from column `dimension` on.
    pub basis: [[[T; WIDTH]; 4]; MAX_CONTACTS],
    pub inside: [T; WIDTH],
    /// t > 0, the least of all s_i - |y_i| at `inside`; 1 if no contact can press.
    pub margin: T,
}

impl<T: Real> Face<T> {
    /// With `equations` the rows e of `e.f = 0` in contact forces of all contacts, of size 1 or less.
    pub fn new(forces: [[[T; 4]; 4]; MAX_CONTACTS], equations: &[[T; WIDTH]], tolerance: T) -> Self {
        let mut face = Self {
            forces,
            basis: [[[T::zero(); WIDTH]; 4]; MAX_CONTACTS],
            inside: [T::zero(); WIDTH],
            margin: T::one(),
        };
        // A contact is reduced to a ray at most once, and then to zero.
        for _ in 0..2 * MAX_CONTACTS {
            face.find_basis(equations, tolerance);
            if face.forces.iter().all(|map| !presses(map)) {
                face.margin = T::one();
                break;
            }
            let Some((contact, normal)) = face.find_inside(tolerance) else { break };
            face.reduce(contact, &normal, tolerance);
        }
        face
    }

    /// The null space of the equations.
    fn find_basis(&mut self, equations: &[[T; WIDTH]], tolerance: T) {
        let (zero, one) = (T::zero(), T::one());
        let largest = self.forces.iter().flatten().flatten().fold(one, |m, x| m.at_least(x.abs()));
        let mut triangle = Triangular::<T, WIDTH>::new();
        for equation in equations {
            let mut row = [zero; WIDTH];
            for i in 0..MAX_CONTACTS {
                for c in 0..4 {
                    row[4 * i + c] =
                        (0..4).fold(zero, |s, f| s + equation[4 * i + f] * (self.forces[i][c][f] / largest));
                }
            }
            triangle.add(row);
        }
        // Coordinates without effect are zero.
        for i in 0..MAX_CONTACTS {
            for c in 0..4 {
                if self.forces[i][c].iter().all(|x| x.is_zero()) {
                    let mut row = [zero; WIDTH];
                    row[4 * i + c] = one;
                    triangle.add(row);
                }
            }
        }
        let svd = triangle.svd();
        let [sigma, ..] = svd.sigma;
        let free = svd.v.iter().zip(&svd.sigma).filter(|(_, s)| !(**s > tolerance * sigma)).map(|(v, _)| v);
        self.basis = [[[zero; WIDTH]; 4]; MAX_CONTACTS];
        for (d, v) in free.enumerate() {
            for (row, x) in self.basis.iter_mut().flatten().zip(v) {
                row.iter_mut().skip(d).take(1).for_each(|to| *to = *x);
            }
        }
    }

    /// The point inside and its margin; or a contact without one, and the w that says so.
    fn find_inside(&mut self, tolerance: T) -> Option<(usize, [T; 4])> {
        let zero = T::zero();
        // Normal forces only are possible without equations.
        let upright = core::array::from_fn(|d| self.basis.iter().fold(zero, |s, [first, ..]| s + first[d]));
        self.set_inside(upright);
        if self.margin > T::of(0.5) {
            return None;
        }
        let (mut objective, mut start) = ([zero; WIDTH + 1], [zero; WIDTH + 1]);
        (objective[WIDTH], start[WIDTH]) = (T::one(), -T::of(0.5));
        let mut cone_duals = [[zero; 4]; MAX_CONTACTS];
        let pressing = self.forces.iter().filter(|map| presses(map)).count();
        for i in 0..MAX_CONTACTS {
            if presses(&self.forces[i]) {
                cone_duals[i][0] = T::count(pressing).recip();
            }
        }
        let program = self.program();
        let mut it = program.start(start, cone_duals, [T::of(0.25); 2 * (WIDTH + 1)]);
        for (d, rest) in program.residual(&objective, &it).iter().enumerate() {
            it.row_duals[2 * d] += zero.at_least(*rest);
            it.row_duals[2 * d + 1] += zero.at_least(-*rest);
        }
        for _ in 0..STEPS {
            let (t, gap) = (it.z[WIDTH], program.gap(&it));
            if t > tolerance && gap < T::of(0.25) * t || gap < T::ROUNDOFF {
                break;
            }
            let Some(next) = program.step(&objective, &it) else { break };
            it = next;
        }
        let [point @ .., _] = it.z;
        self.set_inside(point);
        if self.margin > tolerance {
            return None;
        }
        let mut strongest = (0, [zero; 4]);
        for i in 0..MAX_CONTACTS {
            if presses(&self.forces[i]) && it.cone_duals[i][0] > strongest.1[0] {
                strongest = (i, it.cone_duals[i]);
            }
        }
        Some(strongest)
    }

    /// The largest t, the last coordinate, with s_i - |y_i| >= t for all contacts that can press; |z_d| and t at most 1.
    #[inline(always)]
    fn program(&self) -> ConeProgram<T, MAX_CONTACTS, { WIDTH + 1 }, { 2 * (WIDTH + 1) }> {
        let (zero, one) = (T::zero(), T::one());
        let mut program = ConeProgram {
            cones: [[[zero; WIDTH + 1]; 4]; MAX_CONTACTS],
            rows: [[zero; WIDTH + 1]; 2 * (WIDTH + 1)],
            bounds: [zero; 2 * (WIDTH + 1)],
        };
        for i in 0..MAX_CONTACTS {
            if presses(&self.forces[i]) {
                for c in 0..4 {
                    for d in 0..WIDTH {
                        program.cones[i][c][d] = self.basis[i][c][d];
                    }
                }
                program.cones[i][0][WIDTH] = -one;
            }
        }
        for d in 0..WIDTH + 1 {
            if program.cones.iter().flatten().any(|row| !row[d].is_zero()) {
                (program.rows[2 * d][d], program.rows[2 * d + 1][d]) = (one, -one);
                (program.bounds[2 * d], program.bounds[2 * d + 1]) = (one, one);
            }
        }
        program
    }

    fn set_inside(&mut self, z: [T; WIDTH]) {
        self.inside = z;
        let margins = self.forces.iter().zip(&self.basis).filter(|(map, _)| presses(map)).map(|(_, rows)| {
            let [s, a, b, c] = rows.each_ref().map(|row| dot(row, &z));
            s - (a * a + b * b + c * c).root()
        });
        self.margin = margins.fold(T::one(), T::at_most);
    }

    /// Leaves to the contact the x with w.x = 0.
    fn reduce(&mut self, contact: usize, &[s, a, b, c]: &[T; 4], tolerance: T) {
        let Some(map) = self.forces.get_mut(contact) else { return };
        let y = (a * a + b * b + c * c).root();
        let mut ray = [T::zero(); 4];
        if y >= s * (T::one() - T::count(4) * tolerance) && y > T::zero() {
            let weights = [T::one(), -a / y, -b / y, -c / y];
            ray = core::array::from_fn(|f| (0..4).fold(T::zero(), |sum, c| sum + weights[c] * map[c][f]));
        }
        *map = [ray, [T::zero(); 4], [T::zero(); 4], [T::zero(); 4]];
    }
}

/// Can the contact with this F exert anything?
pub(super) fn presses<T: Real>(map: &[[T; 4]; 4]) -> bool {
    map.iter().flatten().any(|x| !x.is_zero())
}
