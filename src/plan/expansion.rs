//! Expansion of one polytope: Algorithm 1 of Zheng & Yamane.

use crate::bounds::Bracket;
use crate::math::{Vector, norm};
use crate::plan::start::Start;
use crate::polytope::simplex::{Simplex, Vertex};
use crate::polytope::{Facet, Index, Insertion, Polytope};
use crate::query::Query;
use crate::query::answer::Stop;
use crate::scalar::Real;
use crate::support::Failure;

/// Insertions per dimension that [`Polytope::widen`] may spend.
const WIDENINGS: usize = 8;

/// What the expansion ended with: the lowest key, and its facet if it is known.
#[derive(Clone, Copy)]
pub(crate) struct Expanded<T> {
    pub stop: Stop,
    pub key: T,
    pub facet: Option<Index>,
}

impl<T: Real, const N: usize> Polytope<'_, T, N> {
    /// Is there nothing left to find out, or is it another plan's turn?
    #[inline(always)]
    fn done(&mut self, query: &mut Query<'_, T, N>) -> Result<Option<Stop>, Failure> {
        if query.is_spent() && self.confirm(query)? {
            return Ok(Some(Stop::Zero));
        }
        Ok(query.work.is_over().then_some(Stop::Turn))
    }

    /// Lines 5 to 9 of Algorithm 1.
    pub(crate) fn expand(&mut self, query: &mut Query<'_, T, N>) -> Result<Expanded<T>, Failure> {
        loop {
            if let Some(stop) = self.done(query)? {
                return Ok(Expanded { stop, key: -T::HUGE, facet: None });
            }
            let Some((key, index)) = self.pop_lowest() else {
                // No facet below the best upper bound is left.
                if !self.confirm(query)? {
                    continue;
                }
                let key = query.skipped().at_most(query.ratio());
                return Ok(Expanded { stop: Stop::Rounding, key, facet: None });
            };
            let key = key.at_most(query.skipped());
            let end = |stop| Ok(Expanded { stop, key, facet: Some(index) });
            let Some(&Facet { normal, offset, .. }) = self.facet(index) else { return end(Stop::Rounding) };
            if let Some(stop) = self.verdict(query, key) {
                if !self.confirm(query)? {
                    continue;
                }
                return end(stop);
            }
            if let Some(stop) = query.exhausted() {
                return end(stop);
            }
            let (vertex, height) = query.support(&normal)?;
            if query.is_outside(&normal, height) {
                if !self.confirm(query)? {
                    continue;
                }
                return end(Stop::Outside);
            }
            if query.is_spent() {
                continue; // It ends, unless a shortcut of A was wrong.
            }
            let tolerance = self.resolution_along(&normal);
            // On the boundary of A, as far as arithmetic can tell?
            let final_facet = (height - offset <= tolerance).then_some(Stop::Rounding);
            let verdict = self.verdict(query, key);
            if let Some(stop) = verdict.or(final_facet) {
                // That a shortcut does not push the facet out says little: it is asked again without, unless `confirm` has just done that.
                let blind = verdict.is_none() && query.takes_shortcuts();
                if !self.confirm(query)? {
                    continue;
                }
                if blind && query.best.direction != normal {
                    self.reconsider(query);
                    continue;
                }
                return end(stop);
            }
            match self.insert(index, vertex, self.resolution()) {
                Some(Insertion::Done) => self.rate_fresh(query)?,
                Some(Insertion::Full) => return end(Stop::Capacity),
                Some(Insertion::Rejected) | None => return end(Stop::Rounding),
            }
        }
    }

    /// Checks the best upper bound without A's shortcuts. When it rises, facets that were above it before matter
    /// again, and the search goes on; that happens once at most.
    fn confirm(&mut self, query: &mut Query<'_, T, N>) -> Result<bool, Failure> {
        if query.verify()? {
            return Ok(true);
        }
        self.reconsider(query);
        Ok(false)
    }

    /// Queues all facets anew.
    fn reconsider(&mut self, query: &mut Query<'_, T, N>) {
        query.forget_skipped();
        if let Some(lowest) = self.requeue(query.ratio()) {
            query.skip(lowest);
        }
    }

    /// Does the bracket, with this lowest key, end the query? First without the margins, which for a general Q cost a
    /// pass over the facets.
    fn verdict(&self, query: &Query<'_, T, N>, key: T) -> Option<Stop> {
        if query.is_gap_wide(key) {
            return None;
        }
        let upper = query.upper();
        let stop = query.verdict(&Bracket { lower: key, upper })?;
        if stop == Stop::Below {
            return Some(stop);
        }
        query.verdict(&Bracket { lower: self.lower(query, key)?, upper })
    }

    /// The lower bound that the polytope proves when its lowest key is this; `None` when the origin is not certainly
    /// inside.
    pub(crate) fn lower(&self, query: &Query<'_, T, N>, key: T) -> Option<T> {
        if self.is_sound() && query.axes.is_some() {
            return query.lower_by_direction(self.facets());
        }
        self.lower_up_to(query, key, query.margin())
    }

    /// The same where heights are known up to `margin`.
    pub(crate) fn lower_up_to(&self, query: &Query<'_, T, N>, key: T, margin: T) -> Option<T> {
        if !self.is_sound() {
            return None;
        }
        match query.ball {
            Some(radius) => {
                // Back from the key to the offset, rounded down: four roundings there and back.
                let whole = key * radius;
                let offset = whole - query.bounds.radius - whole.abs() * (T::count(5) * T::ROUNDOFF);
                query.lower_from_offset(offset, margin)
            }
            None => query.lower_from_facets(self.facets().map(|f| (f.offset, f.key)), margin),
        }
    }

    /// Line 7: keys of the new facets. One above the best upper bound will never be the lowest that matters.
    fn rate_fresh(&mut self, query: &mut Query<'_, T, N>) -> Result<(), Failure> {
        while let Some(index) = self.next_fresh() {
            let Some(facet) = self.facet(index) else { break };
            let key = query.key(&facet.normal, facet.offset).inspect_err(|_| self.doubt())?;
            if !self.set_key(index, key, key < query.ratio()) {
                query.skip(key);
            }
        }
        Ok(())
    }

    /// Lines 1 to 3: the first simplex. A stop instead when A is flat, or when it certainly does not contain the
    /// origin.
    pub(crate) fn start(&mut self, query: &mut Query<'_, T, N>, first: &Vector<T, N>) -> Result<Option<Stop>, Failure> {
        self.axes = query.axes;
        let mut start = Start::new(*first);
        while start.missing() > 0 {
            let direction = start.direction();
            let Some(vertex) = sample(query, &start, &direction, true)? else { return Ok(Some(Stop::Outside)) };
            // Two points of what is flat may be a margin off on either side.
            let margin = query.margin_along(&direction);
            let thin = self.resolution_along(&direction) + margin + margin;
            if start.accept(&vertex.point, thin) {
                if self.add_vertex(vertex).is_none() {
                    return Ok(Some(Stop::Capacity));
                }
            } else {
                // What sticks out by more than the rounding of a point is not flat, as far as arithmetic can tell.
                let told = self.resolution_along(&direction) * T::of(0.25);
                query.is_thin |= start.progress(&direction, &vertex.point) > told;
                start.flat(&direction);
            }
        }
        query.dimension = start.dimension();
        if start.dimension() < N {
            return Ok(Some(Stop::Flat));
        }
        if query.is_spent() && query.verify()? {
            return Ok(Some(Stop::Zero));
        }
        if self.make_simplex(&start.normals()).is_none() {
            return Ok(Some(Stop::Capacity));
        }
        self.rate_fresh(query)?;
        Ok(self.ends_at_origin(query)?.then_some(Stop::Zero))
    }

    /// For a Q that is not a ball, expansion towards a few directions of Q can leave facets so near to the origin that
    /// the margin swallows them, and the bracket open. Then the nearest facets are pushed out too. Is the bracket as narrow as asked for then?
    pub(crate) fn widen(&mut self, query: &mut Query<'_, T, N>, stop: Stop, key: T) -> Result<bool, Failure> {
        if query.ball.is_some() || stop != Stop::Rounding {
            return Ok(false);
        }
        let bracket = |polytope: &Self, query: &Query<'_, T, N>| {
            polytope.lower(query, key).map(|lower| Bracket { lower, upper: query.upper() })
        };
        for _ in 0..WIDENINGS * N {
            if bracket(self, query).is_some_and(|b| query.is_met(&b)) {
                return Ok(true);
            }
            if query.interrupted().is_some() {
                return Ok(false);
            }
            let Some((index, normal, offset)) = self.nearest_facet() else { return Ok(false) };
            let (vertex, height) = query.support(&normal)?;
            let tolerance = self.resolution_along(&normal);
            if height - offset <= tolerance + tolerance {
                return Ok(false);
            }
            match self.insert(index, vertex, self.resolution()) {
                Some(Insertion::Done) => self.rate_fresh(query)?,
                _ => return Ok(false),
            }
        }
        Ok(false)
    }

    /// The simplex of the surface that touches the largest d Q. For a ball, the one around the foot of the perpendicular on
    /// the plane that proves the upper bound: usually the lowest facet; but that one may be another of several in
    /// the plane, or belong to another of several minima.
    #[inline(always)]
    pub(crate) fn touching_simplex(&self, query: &Query<'_, T, N>, facet: Option<Index>) -> Simplex<T, N> {
        let mut simplex = Simplex::vacant();
        self.find_simplex(query.foot(), &query.best.direction, query.options.relative, facet, &mut simplex);
        simplex
    }

    /// The same, around a point in a plane with this normal, known to a share `relative` along it, and to the root of that sideways.
    pub(crate) fn find_simplex(
        &self,
        foot: Option<Vector<T, N>>,
        normal: &Vector<T, N>,
        relative: T,
        facet: Option<Index>,
        simplex: &mut Simplex<T, N>,
    ) {
        let lowest = match facet {
            Some(index) => self.facet(index),
            None => self.lowest(),
        };
        let Some(facet) = lowest else { return simplex.restart(&Vertex::empty()) };
        let Some(foot) = foot else { return self.see(facet, &Vector::zeros(), simplex) };
        self.see(facet, &foot, simplex);
        let miss = simplex.point();
        let resolution = self.resolution();
        let relative = relative.at_least(T::zero());
        let aside = resolution * T::count(64) + relative.root() * norm(&foot);
        let short = resolution + relative * foot.dot(normal).abs();
        if (miss.dot(&miss) > aside * aside || miss.dot(normal).abs() > short)
            && let Some(nearer) = self.nearer(&foot, norm(&miss))
        {
            self.see(nearer, &foot, simplex);
        }
        simplex.translate(&foot);
    }

    /// A facet with the weights of its point nearest to a point, which is taken for the origin.
    #[inline(never)]
    fn see(&self, facet: &Facet<T, N>, point: &Vector<T, N>, simplex: &mut Simplex<T, N>) {
        self.write_corners(facet, simplex);
        simplex.translate(&-point);
        simplex.minimize(self.resolution());
    }

    /// The facet that is nearest to a point, if one is nearer than `distance`.
    #[cold]
    #[inline(never)]
    fn nearer(&self, point: &Vector<T, N>, mut distance: T) -> Option<&Facet<T, N>> {
        let (mut nearest, mut simplex) = (None, Simplex::vacant());
        for facet in self.facets() {
            // (No point of a facet is nearer than its plane.)
            if (facet.offset - facet.normal.dot(point)).abs() < distance {
                self.see(facet, point, &mut simplex);
                let found = norm(&simplex.point());
                if found < distance {
                    (nearest, distance) = (Some(facet), found);
                }
            }
        }
        nearest
    }
}

/// The next point for the first simplex: A's support point along `direction`, or along its opposite where the first adds little and the
/// second more. With `heed`, `None` as soon as the origin is certainly outside.
#[inline(always)]
pub(crate) fn sample<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    start: &Start<T, N>,
    direction: &Vector<T, N>,
    heed: bool,
) -> Result<Option<Vertex<T, N>>, Failure> {
    let heed = heed && query.bounds.radius == T::zero();
    let (vertex, height) = query.support(direction)?;
    if heed && query.is_outside(direction, height) && query.verify()? {
        return Ok(None);
    }
    // (The first point may be the origin, and the reach 0.)
    let progress = start.progress(direction, &vertex.point);
    if progress > query.reach() * T::of(0.01) {
        return Ok(Some(vertex));
    }
    let opposite = -direction;
    let (other, height) = query.support(&opposite)?;
    if heed && query.is_outside(&opposite, height) && query.verify()? {
        return Ok(None);
    }
    Ok(Some(if start.progress(direction, &other.point) > progress { other } else { vertex }))
}
