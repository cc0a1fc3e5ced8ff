//! The equations that hold at a minimiser, where contacts are at a kink, and what carries load there.

use heapless::Vec;
use nalgebra::SMatrix;

use super::super::primitive::{Primitive, frobenius};
use crate::math::{Vector, norm, unit};
use crate::scalar::Real;

/// Equations beside the six of u and the one of d: more than six are never independent.
pub(super) const TIES: usize = 6;

pub(super) type Vector6<T> = Vector<T, 6>;
pub(super) type Matrix6<T> = SMatrix<T, 6, 6>;
pub(super) type Ties<T> = Vec<Tie<T>, TIES>;

/// An equation that holds at the minimiser, and its multiplier.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tie<T> {
    pub kind: Kind,
    /// A normalised column of the disc, or a direction out of the span.
    pub along: Vector6<T>,
    pub multiplier: T,
    /// Of a tip: λ x is so many multipliers.
    pub unit: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// h_i(u) is 0 (LInf) or the largest (L1).
    Weight(usize),
    /// Contact and column of its disc: u is orthogonal to it.
    Tip(usize, usize),
    /// u stays in the span of W.
    Flat,
}

/// λ x of a contact at its tip; `None`: it is not.
pub(super) fn tip<T: Real>(ties: &[Tie<T>], index: usize) -> Option<Vector<T, 3>> {
    let (mut y, mut found) = (Vector::<T, 3>::zeros(), false);
    for tie in ties {
        for column in 0..3 {
            if tie.kind == Kind::Tip(index, column) {
                y[column] = tie.multiplier * tie.unit;
                found = true;
            }
        }
    }
    found.then_some(y)
}

/// Is the contact at its tip?
pub(super) fn is_tip<T>(ties: &[Tie<T>], index: usize) -> bool {
    ties.iter().any(|tie| matches!(tie.kind, Kind::Tip(i, _) if i == index))
}

/// Has its weight an equation?
pub(super) fn is_weighed<T>(ties: &[Tie<T>], index: usize) -> bool {
    ties.iter().any(|tie| tie.kind == Kind::Weight(index))
}

/// For LInf: are there two hard contacts at rest, h_i(u) = 0 at a tip? Then u turns about the line through both; a squeeze along it
/// balances itself, and how much of it there is does not matter: no change of theirs does work on it.
pub(super) fn has_squeeze<T>(ties: &[Tie<T>]) -> bool {
    let columns = |index: usize| ties.iter().filter(|t| matches!(t.kind, Kind::Tip(i, _) if i == index)).count();
    let at_rest = |tie: &&Tie<T>| matches!(tie.kind, Kind::Weight(index) if columns(index) == 2);
    ties.iter().filter(at_rest).count() == 2
}

/// Newton's method keeps what there is of a free squeeze: two of its ends make the line of all balances. On it, the one that is
/// farthest inside of all inequalities, whose least distance is concave.
pub(super) fn squeezed<T: Real>(one: &Ties<T>, other: &Ties<T>) -> Ties<T> {
    let at = |s: T| {
        let mut ties = one.clone();
        ties.iter_mut().zip(other).for_each(|(a, b)| a.multiplier += (b.multiplier - a.multiplier) * s);
        ties
    };
    let slack = |s: T| {
        let ties = at(s);
        let room = |tie: &Tie<T>| match tie.kind {
            Kind::Weight(index) => {
                let friction = tip(&ties, index).map_or(T::zero(), |y| norm(&y));
                (tie.multiplier - friction).at_most(T::one() - tie.multiplier)
            }
            _ => T::HUGE,
        };
        ties.iter().fold(T::HUGE, |least, tie| least.at_most(room(tie)))
    };
    let (mut low, mut high) = (T::of(-64.0), T::of(64.0));
    for _ in 0..64 {
        let third = (high - low) / T::of(3.0);
        let (a, b) = (low + third, high - third);
        if slack(a) < slack(b) { low = a } else { high = b }
    }
    at(low)
}

/// One primitive at u.
pub(super) struct Part<T> {
    /// h_i(u); -HUGE: empty.
    pub value: T,
    /// |D^T u|, and as a share of |D|.
    pub length: T,
    pub sharpness: T,
    pub x: Vector<T, 3>,
    pub gradient: Vector6<T>,
}

impl<T: Real> Part<T> {
    pub fn new(primitive: &Primitive<T>, u: &Vector6<T>) -> Self {
        let along = primitive.disc().tr_mul(u);
        let (length, size) = (norm(&along), frobenius(primitive.disc()));
        let x = if length > T::zero() { unit(&along) } else { Vector::zeros() };
        Self {
            value: primitive.value(u),
            length,
            sharpness: if size > T::zero() { length / size } else { T::one() },
            x,
            gradient: primitive.center() + primitive.disc() * x,
        }
    }

    /// D (1 - x x^T) D^T / |D^T u|
    pub fn hessian(&self, primitive: &Primitive<T>) -> Matrix6<T> {
        if !(self.length > T::zero()) {
            return Matrix6::zeros();
        }
        let disc = primitive.disc();
        let along = disc * self.x;
        (disc * disc.transpose() - along * along.transpose()) / self.length
    }
}
