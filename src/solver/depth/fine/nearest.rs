//! Cores that are apart: the point of their difference that is nearest to the origin, in two words.

use super::level::Level;
use super::{Asked, Fine, Found, STEPS};
use crate::math::{Accumulator, TwoWords, Vector, norm, unit};
use crate::polytope::simplex::Simplex;
use crate::scalar::Real;

impl<'f, 'm, 'q, 'p, 'b, 'a, T: Real, const N: usize> Fine<'f, 'm, 'q, 'p, 'b, 'a, T, N> {
    /// For cores that are apart: see "Cores that are apart".
    #[inline(never)]
    pub(super) fn by_nearest(&mut self, found: &mut Found<T, N>) -> Option<()> {
        let scale = self.query.scale();
        self.recorder.freeze(|point| found.witness.corners().iter().any(|corner| corner.vertex.point == *point));
        for _ in 0..STEPS {
            let points = self.exact(&found.witness)?;
            let nearest = combination(&found.witness, &points);
            if !(norm(&nearest) > T::zero()) {
                return None;
            }
            let level = self.level(&-unit(&nearest), &found.witness, &points)?;
            let n = level.n.high + level.n.low; // What x' is measured along is what the heights are.
            let distance = -n.dot(&nearest);
            let blur = self.error * T::count(4) + norm(&nearest) * (T::count(16) * T::ROUNDOFF);
            let aside = norm(&(nearest + n * distance)) * T::of(1.01) + blur;
            let least = distance - aside;
            if least > T::zero() {
                let lower = (level.lower(&points) - aside * (aside / least)) * scale;
                found.bracket.lower = found.bracket.lower.at_least(lower);
            }
            let asked = self.ask_along(&level, found)?;
            if self.query.is_met(&found.bracket) || self.query.exhausted().is_some() {
                break;
            }
            let gap = level.upper(&asked.point) - level.lower(&points);
            if !(gap > self.error * T::count(8)) {
                break;
            }
            let Some(simplex) = flattened(&found.witness, &points, &nearest, &asked, &level, gap) else { break };
            found.witness = simplex;
        }
        Some(())
    }
}

/// A simplex, whose point is `nearest`, with a point more, moved to the weights that are nearest to the origin: see "Cores that are apart".
fn flattened<T: Real, const N: usize>(
    simplex: &Simplex<T, N>,
    points: &[TwoWords<T, N>],
    nearest: &Vector<T, N>,
    asked: &Asked<T, N>,
    level: &Level<T, N>,
    gap: T,
) -> Option<Simplex<T, N>> {
    let mut all = simplex.clone();
    if !all.push(asked.vertex) {
        return None;
    }
    let n = level.n.high + level.n.low;
    let base = level.distance(points.first()?).0;
    let distance = -n.dot(nearest);
    if !(distance > T::zero()) {
        return None;
    }
    // |x|^2 = (D - r)^2 + |p|^2 for a point that rises by r and is p aside: next to the least one, what counts is |p|^2 / 2 D - r. So is it for points at height
    // H < D that are sqrt(H / D) p aside, as long as r is much less than H; and their heights are known to a roundoff of H.
    let height = (gap * T::count(64)).at_most(distance);
    let narrow = (height / distance).root();
    let mut flat = all.clone();
    for (corner, point) in flat.corners.iter_mut().zip(points.iter().chain([&asked.point])) {
        let aside = point.high - nearest;
        let rise = level.distance(point).0 - base;
        corner.vertex.witness = corner.vertex.point;
        corner.vertex.point = (aside - n * n.dot(&aside)) * narrow + n * (rise - height);
    }
    flat.minimize_by::<true>(T::count(4) * T::ROUNDOFF * distance * narrow);
    for corner in &mut flat.corners {
        let whole = all.corners.iter().find(|whole| whole.vertex.point == corner.vertex.witness)?;
        corner.vertex = whole.vertex;
    }
    (flat.corners.len() <= N).then_some(flat)
}

/// The combination of points with the weights of a simplex.
fn combination<T: Real, const N: usize>(simplex: &Simplex<T, N>, points: &[TwoWords<T, N>]) -> Vector<T, N> {
    Vector::from_fn(|i, _| {
        let mut sum = Accumulator::new(T::zero());
        for (corner, point) in simplex.corners.iter().zip(points) {
            sum.add_product(corner.weight, point.high[i]);
            sum.add_product(corner.weight, point.low[i]);
        }
        sum.value()
    })
}
