//! One search for contact forces: scales the question, runs the linear program until something is decided, and makes shares, a bracket and an
//! outcome of what it knows then. Questions and answers are those of [`forces`](super::forces).

use super::super::contribution::Contribution;
use super::super::wrench_set::{Norm, WrenchSet};
use super::program::LinearProgram;
use super::{ForceOptions, ForceOutcome, Forces, precision};
use crate::math::{Vector, finite, norm, unit};
use crate::polytope::simplex::Vertex;
use crate::scalar::Real;
use crate::support::failure::NOT_FINITE;
use crate::support::{Failure, Support};
use heapless::Vec;

/// Steps whose gain may be rounding alone, before a search gives up: bounds of rounding errors are pessimistic.
const PATIENCE: u32 = 32;

/// How often a search goes back to where its sums were right.
const DOUBTS: u32 = 3;

/// One search. Its program is in scaled coordinates: those of points divided by `rows`, that of w besides by `unit`, what a weight of 1 in the
/// program is as a size.
pub(super) struct ForceSearch<'a, 'b, T, C> {
    set: &'a WrenchSet<'b, T, C>,
    options: ForceOptions<T>,
    /// What the contacts shall exert.
    asked: Vector<T, 6>,
    /// The same; in the end what the shares do exert, and the rounding of their sum.
    wrench: Vector<T, 6>,
    blur: T,
    /// Powers of two near the largest coordinates of W; their largest where W has none.
    rows: Vector<T, 6>,
    /// The largest of them.
    extent: T,
    pub unit: T,
    pub program: LinearProgram<T>,
    /// The last state with sums that were right; dependent points make them wrong.
    pub sound: LinearProgram<T>,
    /// Points from directions that were known before, and from that of w, which symmetric grasps often ask for; not yet used.
    pool: Vec<Vertex<T, 6>, 7>,
    pub iterations: u32,
    /// The best lower bound so far, and its direction.
    pub best: (T, Vector<T, 6>),
    pub last: Vector<T, 6>,
}

impl<'a, 'b, T: Real, C: Contribution<T>> ForceSearch<'a, 'b, T, C> {
    pub fn new(set: &'a WrenchSet<'b, T, C>, wrench: Vector<T, 6>, options: ForceOptions<T>) -> Result<Self, Failure> {
        let mut reach = Vector::<T, 6>::zeros();
        for i in 0..6 {
            for sign in [T::one(), -T::one()] {
                let mut axis = Vector::<T, 6>::zeros();
                axis[i] = sign;
                let value = set.support(&axis)?.dot(&axis);
                if !value.finite() {
                    return Err(Failure(NOT_FINITE));
                }
                reach[i] = reach[i].at_least(value);
            }
        }
        let power = |x: T| x.at_least(T::TINY).power_of_two();
        let extent = power(reach.iter().fold(T::zero(), |m, &x| m.at_least(x)));
        let rows = reach.map(|x| if x > extent * (T::count(64) * T::ROUNDOFF) { power(x) } else { extent });
        let size = power(wrench.iter().fold(T::zero(), |m, x| m.at_least(x.abs())));
        let target = (wrench / size).zip_map(&rows, |x, row| x * (extent / row));
        let program = LinearProgram::new(&target, &rows.map(|row| set.error() / row));
        let (zero, pool) = (T::zero(), Vec::new());
        let unit = size / extent;
        Ok(ForceSearch {
            set,
            options,
            asked: wrench,
            wrench,
            blur: zero,
            rows,
            extent,
            unit,
            sound: program.clone(),
            program,
            pool,
            iterations: 0,
            best: (zero, wrench),
            last: wrench,
        })
    }

    /// Begins anew, with as many iterations as before.
    pub fn restart(&mut self) {
        let errors = self.rows.map(|row| self.set.error() / row);
        self.program = LinearProgram::new(self.program.target(), &errors);
        self.sound = self.program.clone();
        self.pool.clear();
        (self.wrench, self.blur) = (self.asked, T::zero());
        (self.best, self.last) = ((T::zero(), self.asked), self.asked);
        self.options.iterations = self.options.iterations.saturating_add(self.iterations);
    }

    /// The support point along a direction, scaled.
    fn point(&self, direction: &Vector<T, 6>) -> Result<Vertex<T, 6>, Failure> {
        let point = self.set.support(direction)?;
        if !finite(&point) {
            return Err(Failure(NOT_FINITE));
        }
        Ok(Vertex { point: point.component_div(&self.rows), witness: *direction })
    }

    /// Fills the pool. What is no direction is no help.
    pub fn recall(&mut self, known: &[Vector<T, 6>]) -> Result<(), Failure> {
        for direction in known.iter().filter(|u| finite(u) && u.iter().any(|&x| x != T::zero())) {
            let vertex = self.point(direction)?;
            let _ = self.pool.push(vertex);
        }
        Ok(())
    }

    /// Column generation until something is decided.
    pub fn run(&mut self) -> Result<ForceOutcome, Failure> {
        // Bound of the error of a support value per length of the direction, scaled.
        let error = self.set.error() / self.extent;
        let (mut blurred, mut doubts) = (0, 0);
        loop {
            if self.program.is_fresh() {
                if self.program.holds(precision()) {
                    if self.sound.is_short() || !self.program.is_short() {
                        self.sound = self.program.clone();
                    }
                } else if doubts < DOUBTS {
                    doubts += 1;
                    self.sound.doubt();
                    self.program = self.sound.clone();
                    continue;
                }
            }
            let (y, cost) = (self.program.dual(), self.program.cost());
            if self.enter_known(&y, cost) {
                continue;
            }
            let direction = y.zip_map(&self.rows, |y, row| y * (self.extent / row));
            if !finite(&direction) || direction.iter().all(|&x| x == T::zero()) {
                return Ok(ForceOutcome::Precision);
            }
            if self.iterations >= self.options.iterations {
                return Ok(ForceOutcome::Iterations);
            }
            self.iterations += 1;
            let vertex = self.point(&direction)?;
            let value = y.dot(&vertex.point);
            self.last = direction;
            let margin = error * norm(&direction);
            let bound = self.program.value(&y) / (value.at_least(T::zero()) + margin) * self.unit;
            if bound > self.best.0 {
                self.best = (bound, direction);
                if bound > self.options.limit && self.lower(&direction)? > self.options.limit {
                    return Ok(ForceOutcome::Above);
                }
            }
            // Half of the tolerance is left to what rounding costs in the end.
            let size = self.program.size() * self.unit;
            let met = !self.program.is_short() && size - self.best.0 <= self.options.relative * T::of(0.5) * size;
            let noise = self.program.miss(&y) * T::count(2) + margin;
            if value - cost <= noise {
                blurred += 1;
                if !self.program.is_fresh() {
                    self.program.polish();
                    continue;
                }
            }
            let settled = met || value <= cost || blurred > PATIENCE || !self.program.enter(&vertex);
            if settled && self.program.is_fresh() {
                return Ok(ForceOutcome::Precision);
            }
            if settled {
                self.program.polish();
            }
        }
    }

    /// Moves the best point of the pool into the basis, if one is worth it.
    fn enter_known(&mut self, y: &Vector<T, 6>, cost: T) -> bool {
        let worth = T::ROUNDOFF.root() * norm(y);
        let gain = |vertex: &Vertex<T, 6>| y.dot(&vertex.point) - cost;
        let best = (0..self.pool.len())
            .zip(&self.pool)
            .map(|(k, vertex)| (k, gain(vertex)))
            .reduce(|a, b| if b.1 > a.1 { b } else { a });
        match best {
            Some((k, gain)) if gain > worth => {
                let Some(last) = self.pool.pop() else { return false };
                let vertex = self.pool.get_mut(k).map_or(last, |place| core::mem::replace(place, last));
                self.program.enter(&vertex)
            }
            _ => false,
        }
    }

    /// What a direction proves: no forces of smaller size resist w.
    pub fn lower(&self, direction: &Vector<T, 6>) -> Result<T, Failure> {
        if !finite(direction) {
            return Ok(T::zero());
        }
        let (u, zero) = (unit(direction), T::zero());
        let mut height = zero;
        for contribution in self.set.contributions() {
            // |u| is 1 up to rounding.
            let error = contribution.error() * T::of(1.0001);
            if let Some((value, _)) = contribution.support_above(&u, -(error + error))? {
                let value = (value + error).at_least(zero);
                height = if self.set.norm() == Norm::L1 { height.at_least(value) } else { height + value };
            }
        }
        let size = u.iter().zip(self.wrench.iter()).fold(zero, |s, (&a, &b)| s + (a * b).abs());
        let along = u.dot(&self.wrench) - size * (T::count(8) * T::ROUNDOFF) - self.blur;
        let rounding = T::count(self.set.contributions().len() + 16) * T::ROUNDOFF;
        let lower = along / height * (T::one() - rounding);
        Ok(match lower {
            _ if !(along > T::TINY) => zero,
            _ if height == zero => T::HUGE,
            _ if lower > T::TINY => lower.at_most(T::HUGE),
            _ => zero,
        })
    }

    /// Writes the shares of all `parts`, directions with weights; their size, and what they are off.
    pub fn distribute<'p>(
        &mut self,
        parts: impl Iterator<Item = (&'p Vector<T, 6>, T)>,
        shares: &mut [Vector<T, 6>],
        forces: &mut Forces<T>,
        external: &Vector<T, 6>,
    ) -> Result<(), Failure> {
        let mut size = T::zero();
        for (direction, weight) in parts.filter(|(_, weight)| *weight > T::zero()) {
            size += weight;
            self.set.shares(direction, |i, share| {
                if let Some(sum) = shares.get_mut(i) {
                    *sum += share * weight;
                }
            })?;
        }
        let upper = size * (T::one() + T::count(16) * T::ROUNDOFF) + T::TINY;
        let residual = norm(&shares.iter().fold(*external, |sum, share| sum + share));
        let (sum, all) =
            shares.iter().fold((Vector::zeros(), T::zero()), |(sum, all), share| (sum + share, all + norm(share)));
        // Dependent points may have made sums that are all rounding.
        let tolerable = residual <= norm(external) * (precision::<T>() * T::count(64));
        if upper.finite() && tolerable && all.finite() {
            (forces.upper, forces.residual) = (upper, residual);
            (self.wrench, self.blur) = (sum, all * (T::count(shares.len() + 8) * T::ROUNDOFF));
        } else {
            shares.fill(Vector::zeros());
        }
        Ok(())
    }

    /// The outcome, with the bracket as it is in the end.
    pub fn verdict(&self, forces: &Forces<T>, external: &Vector<T, 6>) -> ForceOutcome {
        let narrow = forces.upper - forces.lower <= self.options.relative * forces.upper;
        let still = forces.residual <= self.options.relative.at_least(precision()) * norm(external);
        match forces.outcome {
            ForceOutcome::Above => ForceOutcome::Above,
            _ if forces.upper < T::HUGE && narrow && still => ForceOutcome::Converged,
            _ if forces.lower >= T::HUGE => ForceOutcome::NotResistible,
            ForceOutcome::Precision | ForceOutcome::Iterations
                if forces.upper >= T::HUGE && self.separates(forces, external) =>
            {
                ForceOutcome::NotResistible
            }
            outcome => outcome,
        }
    }

    /// Is h_W(u), as the lower bound takes it, no more than its error bound, u.w > 0 beyond the rounding of w, and the size that would be
    /// needed absurd?
    fn separates(&self, forces: &Forces<T>, external: &Vector<T, 6>) -> bool {
        let u = &forces.direction;
        let along = -u.dot(external);
        let all = u.iter().zip(external.iter()).fold(T::zero(), |s, (&a, &b)| s + (a * b).abs());
        let beyond = along > all * T::ROUNDOFF.root() && along <= forces.lower * self.set.error() * T::count(2);
        beyond && forces.lower * T::of(1e-5).at_least(T::ROUNDOFF.root()) >= self.unit
    }
}
