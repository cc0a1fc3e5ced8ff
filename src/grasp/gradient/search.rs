//! The search for a minimum of h_W / h_Q near a direction (module `refine`): guesses of the ties, and their verification.

use super::super::primitive::frobenius;
use super::super::span::Subspace;
use super::super::wrench_set::Norm;
use super::newton::{Equations, Iterate};
use super::problem::Problem;
use super::ties::{Kind, Matrix6, Part, Tie, Ties, Vector6, has_squeeze, is_weighed, squeezed, tip};
use crate::bounds::Bounds;
use crate::math::{Vector, norm, unit};
use crate::plan::shoot::descend;
use crate::query::answer::Answer;
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::support::Support;

/// Corrections of one guess.
const CORRECTIONS: usize = 4;

/// A minimum of h_W / h_Q.
#[derive(Clone)]
pub(super) struct Minimum<T> {
    /// Of unit length.
    pub u: Vector6<T>,
    /// h_W(u) / h_Q(u).
    pub ratio: T,
    pub ties: Ties<T>,
    /// The point of W that touches d Q.
    pub support: Vector6<T>,
    /// One point of Q touches it, not several.
    pub sharp: bool,
}

impl<T: Real> Problem<'_, '_, T> {
    /// The minimum near a direction that bounds d by `limit`; after some polar iterations if the direction is too coarse.
    pub fn search(&self, near: &Vector6<T>, limit: T) -> Option<Minimum<T>> {
        self.minimum(near, limit).or_else(|| self.minimum(&self.sharpened(near)?, limit))
    }

    fn sharpened(&self, near: &Vector6<T>) -> Option<Vector6<T>> {
        if self.span.is_some() {
            return None;
        }
        let options = Options { relative: T::ROUNDOFF.root(), ..Options::default() };
        let (mut query, checked) = Query::new(self.set, self.q, T::zero(), options);
        checked.and_then(|()| query.normalize()).ok()?;
        query.support(near).ok()?;
        descend(&mut query, near).ok()?;
        Some(query.best.direction)
    }

    /// The minimum that Newton's method finds from here.
    fn minimum(&self, near: &Vector6<T>, limit: T) -> Option<Minimum<T>> {
        let slack = T::one() + T::count(1 << 8) * T::ROUNDOFF;
        let limit = limit.at_most(self.ratio(near)?.0) * slack;
        let mut zero = T::of(0.3);
        let mut tried = usize::MAX;
        while zero > T::ROUNDOFF {
            let mut guess = self.guess(near, zero);
            zero *= T::of(0.4);
            // A wider zero has more equations: as many are the same.
            let count = guess.as_ref().map_or(usize::MAX, |ties| ties.len());
            if count == tried {
                continue;
            }
            tried = count;
            for _ in 0..CORRECTIONS {
                let Some(ties) = guess.take() else { break };
                match self.balanced(near, ties, limit) {
                    Ok(minimum) => return Some(minimum),
                    Err(better) => guess = better,
                }
            }
        }
        None
    }

    /// The minimum that has these ties; otherwise the ties without those that want to be inequalities.
    fn balanced(&self, near: &Vector6<T>, ties: Ties<T>, limit: T) -> Result<Minimum<T>, Option<Ties<T>>> {
        let start = |weight: T| {
            let mut ties = ties.clone();
            for tie in &mut ties {
                tie.multiplier = if let Kind::Weight(_) = tie.kind { weight } else { T::zero() };
            }
            self.newton(near, ties)
        };
        let mut at = start(T::of(0.5)).ok_or(None)?;
        if self.set.norm() == Norm::LInf
            && has_squeeze(&ties)
            && let Some(other) = start(T::of(0.75))
        {
            at.ties = squeezed(&at.ties, &other.ties);
        }
        self.verified(&at, limit)
    }

    /// The equations that hold near u when `zero` counts as zero.
    fn guess(&self, u: &Vector6<T>, zero: T) -> Option<Ties<T>> {
        let mut ties = Ties::new();
        let mut tie = |kind, along, unit| ties.push(Tie { kind, along, multiplier: T::zero(), unit }).is_ok();
        if let Some(span) = &self.span {
            for axis in Self::outside(span) {
                if !tie(Kind::Flat, axis, T::one()) {
                    return None;
                }
            }
        }
        let best = self.set.value(u);
        for (index, primitive) in self.set.contributions().iter().enumerate() {
            let part = Part::new(primitive, u);
            let room = zero * (norm(primitive.center()) + frobenius(primitive.disc()));
            let (weighed, loaded) = match self.set.norm() {
                Norm::LInf => (part.value.abs() <= room, part.value >= -room),
                Norm::L1 => (part.value >= best - room, part.value >= best - room),
            };
            if primitive.is_empty() || !loaded {
                continue;
            }
            if weighed && !tie(Kind::Weight(index), Vector::zeros(), T::one()) {
                return None;
            }
            if part.sharpness <= zero {
                for (column, radius) in primitive.disc().data.0.map(Vector::from).into_iter().enumerate() {
                    let length = norm(&radius);
                    let kind = Kind::Tip(index, column);
                    if length > T::zero() && !tie(kind, unit(&radius), self.size / length) {
                        return None;
                    }
                }
            }
        }
        Some(ties)
    }

    /// An orthonormal basis of the complement of the span.
    fn outside(span: &Subspace<T>) -> impl Iterator<Item = Vector6<T>> + '_ {
        span.complement().iter().map(|axis| Vector::from(*axis))
    }

    /// The minimum, if it is one with strict inequalities; otherwise the equations without those that want to be
    /// inequalities.
    fn verified(&self, at: &Iterate<T>, limit: T) -> Result<Minimum<T>, Option<Ties<T>>> {
        let strict = T::ROUNDOFF.root();
        let l1 = self.set.norm() == Norm::L1;
        let one = T::one();
        let weight =
            |index: usize| at.ties.iter().find(|tie| tie.kind == Kind::Weight(index)).map_or(one, |tie| tie.multiplier);
        let overdrawn = |index: usize| {
            let y = tip(&at.ties, index);
            y.is_some_and(|y| !(norm(&y) < weight(index) * (one - strict)))
        };
        let bad = |tie: &Tie<T>| match tie.kind {
            Kind::Weight(_) if l1 => !(tie.multiplier > strict),
            Kind::Weight(_) => !(tie.multiplier > strict && tie.multiplier < one - strict),
            Kind::Tip(index, _) => overdrawn(index),
            Kind::Flat => false,
        };
        if at.ties.iter().any(bad) {
            let mut rest = Ties::new();
            // A contact that pulls is not loaded at all.
            let pulls = |index| at.ties.iter().any(|t| t.kind == Kind::Weight(index) && !(t.multiplier > strict));
            let freed = |tie: &Tie<T>| matches!(tie.kind, Kind::Weight(i) | Kind::Tip(i, _) if pulls(i));
            for tie in at.ties.iter().filter(|tie| !bad(tie) && !freed(tie)) {
                let _ = rest.push(*tie);
            }
            return Err(Some(rest));
        }
        let u = unit(&at.u);
        let (ratio, _) = self.ratio(&u).ok_or(None)?;
        if !(ratio <= limit) {
            return Err(None);
        }
        let best = self.set.value(&u);
        let mut support = Vector6::zeros();
        for (index, primitive) in self.set.contributions().iter().enumerate() {
            if primitive.is_empty() {
                continue;
            }
            let part = Part::new(primitive, &u);
            let room = strict * (norm(primitive.center()) + frobenius(primitive.disc()));
            let weighed = is_weighed(&at.ties, index);
            let off = if l1 { part.value < best - room } else { part.value < -room };
            if off && !weighed {
                continue;
            }
            let loaded = weighed || !l1 && part.value > room;
            let tip = tip(&at.ties, index);
            if !loaded || tip.is_none() && !(part.sharpness > strict) {
                return Err(None);
            }
            let weight = weight(index);
            support += primitive.center() * weight + primitive.disc() * tip.unwrap_or(part.x * weight);
        }
        let at = Iterate { u, d: at.d, ties: at.ties.clone() };
        let conditions = self.equations(&at).ok_or(None)?;
        if !(norm(&conditions.balance) <= strict * at.d && self.grows(&at, &conditions)) {
            return Err(None);
        }
        Ok(Minimum { u, ratio, ties: at.ties, support, sharp: self.is_sharp(&u) })
    }

    /// The second-order condition: with P the projection on the directions that the equations, and the length of u, leave
    /// free, P H P is positive on them.
    fn grows(&self, at: &Iterate<T>, conditions: &Equations<T>) -> bool {
        let Equations { hessian, rows, share, .. } = conditions;
        let l1 = self.set.norm() == Norm::L1;
        let mut free = Matrix6::identity() - at.u * at.u.transpose();
        let mut rank = 0;
        for ((gradient, _), tie) in rows.iter().zip(&at.ties) {
            let level = l1 && matches!(tie.kind, Kind::Weight(_));
            let rest = free * if level { gradient - share * at.d } else { *gradient };
            if norm(&rest) > T::ROUNDOFF.root() * norm(gradient) {
                let rest = unit(&rest);
                free -= rest * rest.transpose();
                rank += 1;
            }
        }
        // For L1 the balance itself is a combination of the gradients that vanishes; else only a squeeze between two
        // hard contacts at rest may be one.
        if rows.len() > rank + usize::from(l1 || has_squeeze(&at.ties)) {
            return false;
        }
        let curved = free * hessian * free;
        let scale = curved.trace();
        let mut m = curved + (Matrix6::identity() - free) * scale.abs().at_least(T::one());
        let floor = scale.abs() * T::ROUNDOFF.root();
        for k in 0..6 {
            let pivot = m[(k, k)];
            if !(pivot > floor) {
                return false;
            }
            for i in 0..6 {
                if i > k {
                    let factor = m[(i, k)] / pivot;
                    for j in 0..6 {
                        let x = m[(k, j)];
                        m[(i, j)] -= factor * x;
                    }
                }
            }
        }
        true
    }

    /// Writes the minimum into the answer.
    pub fn conclude(&self, minimum: &Minimum<T>, answer: &mut Answer<T, 6>) {
        let Ok(unit) = self.q.value(&minimum.u) else { return };
        let bounds = Bounds { support_error: self.set.error(), radius: T::zero(), dimension: 6, unknown_extent: false };
        let height = self.set.value(&minimum.u);
        let upper = bounds.upper(height, bounds.margin(self.size), unit, self.q.error());
        // What the span's basis is off by is not known here.
        if answer.dimension == 6 {
            answer.upper = answer.upper.at_most(upper.at_least(answer.lower));
        }
        answer.direction = minimum.u;
        answer.support = minimum.support;
        answer.unit = unit;
    }
}
