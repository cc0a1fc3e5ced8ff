//! One sector as a plane problem: the point of the half plane for a point of M. See "A sector is a plane problem" in the module above.

use super::Spin;
use crate::math::{Vector, norm};
use crate::polytope::simplex::Vertex;
use crate::query::Query;
use crate::query::answer::Stop;
use crate::scalar::Real;
use crate::solver::depth::meridian::Section;
use crate::support::Failure;

/// Azimuths between two of them, or all.
pub(super) struct Sector<'s, T: Real> {
    pub spin: &'s Spin<T>,
    /// `offset` in the query's units.
    pub offset: Vector<T, 3>,
    pub ends: [Vector<T, 3>; 2],
    /// Cosine of half the angle between them; 0: the sector is the whole circle.
    pub cosine: T,
    pub middle: Vector<T, 3>,
}

impl<T: Real> Sector<'_, T> {
    /// A lower bound of v.e over all azimuths e.
    fn least(&self, v: &Vector<T, 3>) -> T {
        let across = -norm(&(v - self.spin.axis * v.dot(&self.spin.axis)));
        let [e, f] = &self.ends;
        let m = v.dot(e).at_most(v.dot(f));
        if !(self.cosine > T::zero()) {
            across
        } else if m >= T::zero() {
            m
        } else {
            across.at_least(m / self.cosine)
        }
    }

    /// The part of a point of M that belongs to K, and the part of C.
    fn split(&self, vertex: &Vertex<T, 3>) -> [Vector<T, 3>; 2] {
        let Vertex { point, witness } = vertex;
        if self.spin.first {
            [point - witness, *witness]
        } else {
            [witness + self.offset, point - witness - self.offset]
        }
    }

    /// The point of the half plane for a point of M that was found along `direction`: radius, height, and height downwards.
    fn flatten(&self, vertex: &Vertex<T, 3>, direction: &Vector<T, 3>) -> Vector<T, 3> {
        let axis = &self.spin.axis;
        let [rest, turning] = self.split(vertex);
        let (own, carried) = if self.spin.turns {
            let height = turning.dot(axis);
            (Vector::<T, 3>::new(norm(&(turning - axis * height)), height, -height), Vector::zeros())
        } else {
            // (One sum with the rest: what is far from both anchors cancels.)
            (Vector::zeros(), turning)
        };
        let whole = rest + carried;
        let (r, h) = (self.least(&whole), whole.dot(axis));
        let fixed = Vector::<T, 3>::new(r, h, -h);
        let best = match &self.spin.other {
            Some(b) => {
                let ring = self.ring(&rest, &carried, b, direction);
                if self.score(&ring, direction) >= self.score(&fixed, direction) { ring } else { fixed }
            }
            None => fixed,
        };
        own + best
    }

    /// The three first points of the sector's chain, of M's points at the two poles and one found along the middle. `None`: the axis itself is (nearly)
    /// the best direction, and there is no arc around it.
    pub fn chain(
        &self,
        query: &mut Query<'_, T, 3>,
        [down, up]: &[Vertex<T, 3>; 2],
    ) -> Result<Option<[Vertex<T, 3>; 3]>, Failure> {
        let axis = self.spin.axis;
        let lowest = Vertex { point: self.flatten(down, &-axis), ..*down };
        let highest = Vertex { point: self.flatten(up, &axis), ..*up };
        let farthest = self.ask(query, &self.middle)?;
        let least = self.place(&lowest, false)[1].at_most(self.place(&highest, true)[1]);
        Ok(self.judge(query, least)?.is_some().then_some([lowest, farthest, highest]))
    }

    /// What a point is worth along a direction; with some weight on the radius, which counts for all others near the equator.
    fn score(&self, place: &Vector<T, 3>, direction: &Vector<T, 3>) -> T {
        let up = direction.dot(&self.spin.axis);
        let height = if up >= T::zero() { up * place.y } else { -up * place.z };
        (direction.dot(&self.middle) + T::of(0.0625)) * place.x + height
    }

    /// The same for the circle of the point about the axis b, and what is added to each point of it.
    fn ring(
        &self,
        point: &Vector<T, 3>,
        carried: &Vector<T, 3>,
        b: &Vector<T, 3>,
        direction: &Vector<T, 3>,
    ) -> Vector<T, 3> {
        let axis = &self.spin.axis;
        let from = point - self.offset;
        let along = from.dot(b);
        let radius = norm(&(from - b * along));
        let center = self.offset + b * along + carried;
        let (s, c) = (direction.dot(&self.middle).at_least(T::zero()), direction.dot(axis));
        let cosine = axis.dot(b);
        // t and g over the sector.
        let ends = [self.least(b), -self.least(&-b)];
        let [low, high] = ends.map(|t| s * t + c * cosine);
        let nearest = if low > T::zero() { low } else { (-high).at_least(T::zero()) };
        let square = (T::one() - nearest) * (T::one() + nearest);
        // (Along b any point of the disc is as good as another: take the centre.)
        let slack = T::count(8) * T::ROUNDOFF / square.at_least(T::TINY);
        let k = if square > T::of(1e-4) { radius / square.root() * (T::one() - slack) } else { T::zero() };
        let inward = (ends[0] * low).at_least(ends[1] * high);
        let height = center.dot(axis);
        // (The differences are off by some roundoffs of 1, and k may be large: near b.)
        let rounding = k * (T::count(8) * T::ROUNDOFF);
        Vector::<T, 3>::new(
            self.least(&center) + k * (s - inward) - rounding,
            height + k * (c - cosine * high) - rounding,
            k * (cosine * low - c) - height - rounding,
        )
    }
}

impl<T: Real> Section<T> for Sector<'_, T> {
    fn frame(&self) -> (&Vector<T, 3>, &Vector<T, 3>) {
        (&self.spin.axis, &self.middle)
    }
    fn ask(&self, query: &mut Query<'_, T, 3>, direction: &Vector<T, 3>) -> Result<Vertex<T, 3>, Failure> {
        let (vertex, _) = query.support(direction)?;
        Ok(Vertex { point: self.flatten(&vertex, direction), witness: vertex.witness })
    }
    fn place(&self, vertex: &Vertex<T, 3>, upper: bool) -> [T; 2] {
        [vertex.point.x, if upper { vertex.point.y } else { vertex.point.z }]
    }
    fn judge(&self, query: &mut Query<'_, T, 3>, offset: T) -> Result<Option<Stop>, Failure> {
        let enough = offset + query.bounds.radius >= query.level(T::zero(), T::zero());
        Ok(enough.then_some(Stop::Met))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Round;
    use super::*;
    use crate::math::unit;
    use crate::solver::depth::body::Body;
    use crate::solver::depth::dice::dice;
    use crate::solver::depth::pair::Pair;
    use crate::support::BoxShape;

    /// In `f64`: the point of the half plane for a point of M, over the azimuths of the sector.
    fn flattened(sector: &Sector<'_, f32>, vertex: &Vertex<f32, 3>) -> [f64; 2] {
        let wide = |v: &Vector<f32, 3>| v.map(f64::from);
        let axis = wide(&sector.spin.axis).normalize();
        let across = |v: &Vector<f64, 3>| v - axis * v.dot(&axis);
        let (point, witness, offset) = (wide(&vertex.point), wide(&vertex.witness), wide(&sector.offset));
        let turning = if sector.spin.first { witness } else { point - witness - offset };
        let rest = across(&(point - turning));
        let [left, right] = sector.ends.map(|e| across(&wide(&e)).normalize());
        // Is the azimuth opposite to the rest's in the sector?
        let between = |e: &Vector<f64, 3>| left.cross(e).dot(&axis) >= 0.0 && e.cross(&right).dot(&axis) >= 0.0;
        let lowest = sector.cosine == 0.0 || between(&-rest);
        let least = if lowest { -rest.norm() } else { rest.dot(&left).min(rest.dot(&right)) };
        [least + across(&turning).norm(), point.dot(&axis)]
    }

    /// What a point of the half plane is off is no more than what is charged for it.
    #[test]
    fn points_of_the_half_plane_are_rounded() {
        let mut next = dice(1);
        for case in 0..4000 {
            let mut random = |size: f64| Vector::<f32, 3>::from_fn(|_, _| (size * next()) as f32);
            let [a, b] = [1.0, 0.5].map(|size| BoxShape::new(random(size).abs()).unwrap());
            let bodies = [Body::at(&a, Vector::zeros()), Body::at(&b, random(4.0))];
            let pair = Pair::new(&bodies[0], &bodies[1]).unwrap();
            let (axis, start) = (unit(&random(1.0)), random(1.0));
            let (point, witness) = pair.sample(&unit(&random(1.0)), false).unwrap();
            let vertex = Vertex { point, witness };
            let spin = Spin { axis, turns: true, first: case % 2 == 0, offset: pair.offset, other: None };
            let start = unit(&(start - axis * axis.dot(&start)));
            let mut round = Round::new(unit(&(start - axis * axis.dot(&start))));
            if case % 3 > 0 {
                round.quarter(&axis, round.left);
                for _ in 0..case % 5 {
                    let middle = round.sector(&spin, spin.offset).middle;
                    round.halve(middle);
                }
            }
            let sector = round.sector(&spin, spin.offset);
            let place = sector.flatten(&vertex, &sector.middle).map(f64::from);
            let ([radius, height], off) = (flattened(&sector, &vertex), f64::from(pair.rounding_of_sectors()));
            let beyond = [place.x - radius, place.y - height, place.z + height];
            assert!(beyond.iter().all(|&x| x <= off), "{case} {beyond:?} {off}");
        }
    }
}
