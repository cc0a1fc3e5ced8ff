//! Newton's method for the conditions of a minimum (module `refine`): u, d and the multipliers at once.

use heapless::Vec;

use super::super::wrench_set::Norm;
use super::problem::Problem;
use super::ties::{Kind, Matrix6, Part, TIES, Ties, Vector6, is_tip, is_weighed};
use crate::math::norm;
use crate::scalar::Real;

const SIZE: usize = 7 + TIES;
/// More steps than any convergent run takes.
const STEPS: usize = 40;

/// Where Newton's method stands.
pub(super) struct Iterate<T> {
    pub u: Vector6<T>,
    pub d: T,
    pub ties: Ties<T>,
}

/// The conditions at an iterate.
pub(super) struct Equations<T> {
    /// Σ λ_i (c_i + D_i x_i) - d s_Q(u).
    pub balance: Vector6<T>,
    /// Its derivative with respect to u.
    pub hessian: Matrix6<T>,
    /// Of each tie the gradient and the residual.
    pub rows: Vec<(Vector6<T>, T), TIES>,
    /// s_Q(u).
    pub share: Vector6<T>,
}

impl<T: Real> Problem<'_, '_, T> {
    /// The conditions at an iterate; `None` where Q has no mapping.
    pub fn equations(&self, at: &Iterate<T>) -> Option<Equations<T>> {
        let share = self.mapping(&at.u)?;
        let mut balance = share * -at.d;
        let mut hessian = self.unit_hessian(&at.u)? * -at.d;
        let level = at.d * share.dot(&at.u);
        let mut rows = Vec::new();
        for tie in &at.ties {
            let row = match tie.kind {
                Kind::Weight(index) => {
                    let primitive = self.set.contributions().get(index)?;
                    let part = Part::new(primitive, &at.u);
                    let smooth = !is_tip(&at.ties, index);
                    let gradient = if smooth { part.gradient } else { *primitive.center() } / self.size;
                    if smooth {
                        hessian += part.hessian(primitive) * (tie.multiplier / self.size);
                    }
                    let l1 = if self.set.norm() == Norm::L1 { level } else { T::zero() };
                    (gradient, gradient.dot(&at.u) - l1)
                }
                Kind::Tip(..) | Kind::Flat => (tie.along, tie.along.dot(&at.u)),
            };
            balance += row.0 * tie.multiplier;
            rows.push(row).ok()?;
        }
        if self.set.norm() == Norm::LInf {
            for (index, primitive) in self.set.contributions().iter().enumerate() {
                let part = Part::new(primitive, &at.u);
                if !(part.value > T::zero()) || is_weighed(&at.ties, index) {
                    continue;
                }
                if is_tip(&at.ties, index) {
                    balance += primitive.center() / self.size;
                } else {
                    balance += part.gradient / self.size;
                    hessian += part.hessian(primitive) / self.size;
                }
            }
        }
        Some(Equations { balance, hessian, rows, share })
    }

    /// Newton's method for u, d and the multipliers, in the plane u . near = 1.
    pub fn newton(&self, near: &Vector6<T>, ties: Ties<T>) -> Option<Iterate<T>> {
        let (ratio, _) = self.ratio(near)?;
        let mut at = Iterate { u: *near, d: ratio / self.size * self.unit, ties };
        let l1 = self.set.norm() == Norm::L1;
        let mut last = false;
        for _ in 0..STEPS {
            let Equations { balance, hessian, rows, share } = self.equations(&at)?;
            let mut a = [[T::zero(); SIZE + 1]; SIZE];
            for (i, row) in a.iter_mut().enumerate().skip(7 + rows.len()) {
                *row.get_mut(i)? = T::one();
            }
            for i in 0..6 {
                for j in 0..6 {
                    a[i][j] = hessian[(i, j)];
                }
                a[i][6] = -share[i];
                a[6][i] = near[i];
                a[i][SIZE] = -balance[i];
                for (k, (gradient, _)) in rows.iter().enumerate() {
                    *a[i].get_mut(7 + k)? = gradient[i];
                }
            }
            for (k, ((gradient, residual), tie)) in rows.iter().zip(&at.ties).enumerate() {
                let level = l1 && matches!(tie.kind, Kind::Weight(_));
                let row = a.get_mut(7 + k)?;
                for i in 0..6 {
                    row[i] = if level { gradient[i] - at.d * share[i] } else { gradient[i] };
                }
                row[6] = if level { -share.dot(&at.u) } else { T::zero() };
                // Where multipliers are not unique the step changes them least (proximal method of multipliers).
                *row.get_mut(7 + k)? = -T::ROUNDOFF.root();
                row[SIZE] = -*residual;
            }
            let step = eliminated(a)?;
            let change = Vector6::from_fn(|i, _| step[i]);
            let length = norm(&change);
            if !length.finite() {
                return None;
            }
            let limit = T::of(0.3);
            let damped = if length > limit { limit / length } else { T::one() };
            at.u += change * damped;
            at.d += step[6] * damped;
            for (tie, x) in at.ties.iter_mut().zip(step.iter().skip(7)) {
                tie.multiplier += *x * damped;
            }
            if last {
                return Some(at);
            }
            last = length <= T::ROUNDOFF.root();
        }
        None
    }
}

/// The solution of 13 linear equations, Gauss and Jordan with complete pivoting; `None` when they are not regular.
fn eliminated<T: Real>(mut a: [[T; SIZE + 1]; SIZE]) -> Option<[T; SIZE]> {
    let (mut rows, mut columns) = ([true; SIZE], [true; SIZE]);
    let mut order = [(0, 0); SIZE];
    let mut first = T::zero();
    for place in &mut order {
        let (mut largest, mut at) = (T::zero(), (0, 0));
        for i in 0..SIZE {
            for j in 0..SIZE {
                if rows[i] && columns[j] && a[i][j].abs() > largest {
                    (largest, at) = (a[i][j].abs(), (i, j));
                }
            }
        }
        first = first.at_least(largest);
        if !(largest > first * T::count(1 << 6) * T::ROUNDOFF && largest.finite()) {
            return None;
        }
        let (row, column) = at;
        *rows.get_mut(row)? = false;
        *columns.get_mut(column)? = false;
        *place = at;
        let divisor = *a.get(row)?.get(column)?;
        let pivot = a.get(row)?.map(|x| x / divisor);
        for (i, other) in a.iter_mut().enumerate() {
            if i == row {
                *other = pivot;
            } else {
                let factor = *other.get(column)?;
                other.iter_mut().zip(&pivot).for_each(|(x, &p)| *x -= factor * p);
            }
        }
    }
    let mut x = [T::zero(); SIZE];
    for (row, column) in order {
        *x.get_mut(column)? = *a.get(row)?.get(SIZE)?;
    }
    Some(x)
}
