//! The point of M nearest to a target: bounded least squares (Stark & Parker, *Computational Statistics* 10, 1995).
//!
//! Six coordinates are minimised over their intervals. Those that are free are solved for (Gram and Schmidt), until one meets the end of its interval; when none
//! does, the one that the residual pulls inward most strongly is freed. In the end, where the last digits count, the residual of the coordinates as they are is added up
//! in two words: so what the free ones are off is corrected.
//!
//! The ends of the search prove nothing: whatever coordinates come out are a point of M.

use super::zonotope::{EDGES, Zonotope};
use crate::math::{Vector, magnitude, norm, unit};
use crate::scalar::Real;

/// Rounds; five or six suffice nearly always.
const MOST: usize = 32;

pub(super) struct Nearest<T: Real> {
    pub coordinates: [T; EDGES],
    /// Unit vector from the point to the target, across the free edges.
    pub toward: Vector<T, 3>,
}

/// An edge that is free, and its part across those freed before.
#[derive(Clone, Copy)]
struct Free<T: Real> {
    edge: usize,
    /// A unit vector, and the length of the part.
    across: Vector<T, 3>,
    length: T,
    /// The edge along those freed before.
    along: [T; 2],
}

/// From coordinates at the ends of their intervals. `to_the_last_digit`: the residual's, not the coordinates'.
#[inline(never)]
pub(super) fn nearest<T: Real>(
    m: &Zonotope<T>,
    start: [T; EDGES],
    target: &Vector<T, 3>,
    to_the_last_digit: bool,
) -> Nearest<T> {
    let mut s = start;
    let mut free: heapless::Vec<usize, 3> = heapless::Vec::new();
    let mut found = Vector::zeros();
    let (mut exact, center) = (false, m.center() - target);
    for _ in 0..MOST {
        let x = if exact {
            // (The target is the origin then.)
            m.place(&s).high
        } else {
            m.along.iter().zip(&s).fold(center, |x, (g, &s)| x + g * s)
        };
        let basis = span(m, &free);
        let steps = solve(&basis, &x);
        if !steps.iter().all(|step| step.finite()) {
            break;
        }
        if let Some(edge) = step(m, &basis, &steps, &mut s) {
            free.retain(|&other| other != edge);
            continue;
        }
        found = basis.iter().fold(x, |x, row| x - row.across * row.across.dot(&x));
        // What pulls most strongly, and more than rounding does.
        let size = if exact { norm(&found) } else { m.size };
        let least = size * (T::count(8) * T::ROUNDOFF);
        let next = strongest(m, &s, &free, &found, least);
        if next.is_some_and(|k| free.push(k).is_ok()) {
            continue;
        }
        if exact || !to_the_last_digit {
            break;
        }
        exact = true;
    }
    Nearest { coordinates: s, toward: -unit(&found) }
}

/// Goes so far, or to the first end of an interval: that of which edge?
fn step<T: Real>(m: &Zonotope<T>, basis: &[Free<T>], steps: &[T; 3], s: &mut [T; EDGES]) -> Option<usize> {
    let (mut share, mut blocked) = (T::one(), None);
    for (row, &step) in basis.iter().zip(steps) {
        let (Some(&at), Some(&w)) = (s.get(row.edge), m.half.get(row.edge)) else { continue };
        let room = if step > T::zero() { w - at } else { w + at };
        if magnitude(step) * share > room {
            share = room / magnitude(step);
            blocked = Some((row.edge, if step > T::zero() { w } else { -w }));
        }
    }
    for (row, &step) in basis.iter().zip(steps) {
        if let (Some(at), Some(&w)) = (s.get_mut(row.edge), m.half.get(row.edge)) {
            *at = (*at + step * share).at_most(w).at_least(-w);
        }
    }
    let (edge, end) = blocked?;
    if let Some(at) = s.get_mut(edge) {
        *at = end;
    }
    Some(edge)
}

/// The edge, of those that are not free, that pulls inward most strongly, and more than `least`.
fn strongest<T: Real>(
    m: &Zonotope<T>,
    s: &[T; EDGES],
    free: &[usize],
    residual: &Vector<T, 3>,
    least: T,
) -> Option<usize> {
    let (mut most, mut next) = (least, None);
    for (k, (g, (&at, &w))) in m.along.iter().zip(s.iter().zip(&m.half)).enumerate() {
        let pull = g.dot(residual);
        let inward = if at > T::zero() { pull } else { -pull };
        if inward > most && w > T::zero() && !free.contains(&k) {
            (most, next) = (inward, Some(k));
        }
    }
    next
}

/// The free edges, made orthogonal one after the other. What is parallel to others is left out.
fn span<T: Real>(m: &Zonotope<T>, free: &[usize]) -> heapless::Vec<Free<T>, 3> {
    let mut basis: heapless::Vec<Free<T>, 3> = heapless::Vec::new();
    for &edge in free {
        let Some(&g) = m.along.get(edge) else { continue };
        let (mut across, mut along) = (g, [T::zero(); 2]);
        for (row, part) in basis.iter().zip(&mut along) {
            *part = row.across.dot(&g);
            across -= row.across * *part;
        }
        // (Once more: what was nearly parallel is left with the rounding of it.)
        for (row, part) in basis.iter().zip(&mut along) {
            let rest = row.across.dot(&across);
            *part += rest;
            across -= row.across * rest;
        }
        let length = norm(&across);
        if length > T::count(16) * T::ROUNDOFF {
            let _ = basis.push(Free { edge, across: across * (T::one() / length), length, along });
        }
    }
    basis
}

/// How much of each edge takes x as near to 0 as it gets.
fn solve<T: Real>(basis: &[Free<T>], x: &Vector<T, 3>) -> [T; 3] {
    let mut steps = [T::zero(); 3];
    for (j, row) in basis.iter().enumerate().rev() {
        let mut rest = -row.across.dot(x);
        for (later, &step) in basis.iter().zip(&steps).skip(j + 1) {
            rest -= later.along.get(j).copied().unwrap_or(T::zero()) * step;
        }
        if let Some(step) = steps.get_mut(j) {
            *step = rest / row.length;
        }
    }
    steps
}
