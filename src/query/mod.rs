//! The state of one query: what has been asked of A and Q, the best upper bound so far, and how all of it becomes an
//! [`Answer`].

use core::fmt;

use crate::bounds::{Axes, Bounds};
use crate::math::{Vector, finite};
use crate::polytope::simplex::Vertex;
use crate::qset::UnitSet;
use crate::query::answer::{Answer, Plan, Stop};
use crate::scalar::Real;
use crate::support::failure::{NOT_FINITE, TOO_LARGE};
use crate::support::{Failure, Support};

pub(crate) mod answer;
mod bracket;
mod end;
mod work;

pub(crate) use work::Work;

/// How a query ends, and where it looks first.
///
/// Fields may be added: write `Options { relative: 1e-3, ..Options::default() }`.
#[derive(Clone, Copy)]
pub struct Options<'a, T, const N: usize> {
    /// Stop when upper - lower <= max(absolute, relative |d|). Default 0.
    pub absolute: T,
    /// See `absolute`. Default 1e-6 in `f64`, 1e-4 in `f32`.
    pub relative: T,
    /// Stop as soon as d >= threshold or d < threshold is certain.
    pub threshold: Option<T>,
    /// Most points to add. `None`, the default: 50,000, and 64 for each vertex of a polytopal Q. (What a query needs grows with a power
    /// of 1 / tolerance, up to (dimension - 1) / 2 where A is smooth; how long that takes, `examples/worst_case.rs` measures.)
    pub max_iterations: Option<u32>,
    /// The direction to look in first (any length, not zero): where the answer was last time.
    pub guess: Option<Vector<T, N>>,
    /// The deadline: asked before every iteration, it ends the query by `true`, with outcome
    /// [`Interrupted`](crate::Outcome::Interrupted) and the best bracket so far.
    pub interrupt: Option<&'a dyn Fn() -> bool>,
}

impl<T: fmt::Debug, const N: usize> fmt::Debug for Options<'_, T, N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Options")
            .field("absolute", &self.absolute)
            .field("relative", &self.relative)
            .field("threshold", &self.threshold)
            .field("max_iterations", &self.max_iterations)
            .field("guess", &self.guess)
            .field("interrupt", &self.interrupt.map(|_| "..."))
            .finish()
    }
}

impl<T: Real, const N: usize> Default for Options<'_, T, N> {
    fn default() -> Self {
        Options {
            absolute: T::zero(),
            relative: T::RELATIVE_TOLERANCE,
            threshold: None,
            max_iterations: None,
            guess: None,
            interrupt: None,
        }
    }
}

impl<T: Real, const N: usize> Options<'_, T, N> {
    /// What is left of the limit after so many iterations; `None`: nothing.
    pub(crate) fn after(&self, iterations: u32) -> Option<Self> {
        let left = self.limit().saturating_sub(iterations);
        (left > 0).then_some(Options { max_iterations: Some(left), ..*self })
    }

    fn limit(&self) -> u32 {
        self.max_iterations.unwrap_or(MAX_ITERATIONS)
    }
}

/// Points added when the caller sets no limit; and for each vertex of a polytopal Q.
const MAX_ITERATIONS: u32 = 50_000;
const MAX_ITERATIONS_PER_VERTEX: u32 = 64;

/// Directions farther apart than this cosine (8 degrees) are not two guesses at the same minimiser.
const RIVAL_COSINE: f64 = 0.99;

/// One query: A and Q, what they have been asked, and the best upper bound.
pub(crate) struct Query<'q, T, const N: usize> {
    a: &'q dyn Support<T, N>,
    q: &'q dyn UnitSet<T, N>,
    /// Radius of Q where it is a ball.
    pub ball: Option<T>,
    /// Its inverse, or 1.
    per_ball: T,
    unit_error: T,
    /// What A says of its extent; 0: nothing.
    extent: T,
    pub bounds: Bounds<T>,
    /// With margins by direction: what A knows of itself axis by axis.
    pub axes: Option<Axes<T, N>>,
    /// Tolerance and threshold in scaled units.
    pub options: Options<'q, T, N>,
    /// A power of two that brings the set to a size near 1, so that no product under- or overflows; 1 for sets that are
    /// near it already. All lengths of a query are scaled by it, the answer's are scaled back: both exactly.
    scale: T,
    /// Largest norm of a point seen.
    reach: T,
    /// The best upper bound: unit direction, support value, value of Q, and their quotient without margins.
    pub direction: Vector<T, N>,
    height: T,
    unit: T,
    ratio: T,
    /// The support point of the core along it.
    point: Vector<T, N>,
    /// A direction far from the best that bounds d about as well, and its quotient.
    rival: Option<(Vector<T, N>, T)>,
    /// About as well: with a quotient up to this.
    rivalry: T,
    /// Is that of interest?
    pub seeks_rivals: bool,
    /// For a general Q: the origin is certainly outside of A, and `height` is minus a distance.
    apart: bool,
    /// The lowest key of a facet that was not queued because it was above `ratio` then.
    skipped: T,
    /// The largest value of a general Q that was seen.
    widest: T,
    /// Nothing but the lower end at 0 is left to be found out.
    spent: bool,
    /// A was taken for flat, for its margins, and is not.
    pub is_thin: bool,
    /// Ask the support function without its shortcuts.
    exhaustive: bool,
    pub iterations: u32,
    /// The most of them.
    limit: u32,
    support_calls: u32,
    pub work: Work<N>,
    /// Affine dimension of the core.
    pub dimension: usize,
    /// How the query is being answered.
    pub plan: Plan,
    /// A lower bound of d that holds anyway; 0: none that says anything.
    floor: T,
    /// The largest norm of a point when that was proved.
    floor_reach: T,
    /// The limit that was reached: from then on nothing is added.
    stopped: Option<Stop>,
}

/// Lengths as sets state them: finite and >= 0.
fn are_lengths<T: Real>(list: &[T]) -> bool {
    list.iter().fold(true, |all, &x| all & (x >= T::zero()) & (x <= T::HUGE))
}

impl<'q, T: Real, const N: usize> Query<'q, T, N> {
    /// A query with `radius` as the ball term that is taken out of A. What the sets say of themselves is checked here;
    /// an error when one of these lengths is negative or not finite (then the query must not be run).
    pub fn new(
        a: &'q dyn Support<T, N>,
        q: &'q dyn UnitSet<T, N>,
        radius: T,
        options: Options<'q, T, N>,
    ) -> (Self, Result<(), Failure>) {
        let (extent, support_error, unit_error) = (a.extent(), a.error(), q.error());
        let ball = q.ball_radius();
        let per_ball = T::one() / ball.unwrap_or(T::one());
        let inner = if ball.is_some() { T::zero() } else { q.inner_radius() };
        let sane = are_lengths(&[radius, extent, support_error, unit_error, inner]);
        let sane = sane && per_ball.finite() && per_ball > T::zero();
        let checked = if sane { Ok(()) } else { Err(Failure(NOT_FINITE)) };
        // (The answer to a query that is not run is made of them too.)
        let [radius, extent, support_error] = if sane { [radius, extent, support_error] } else { [T::zero(); 3] };
        let query = Query {
            a,
            q,
            ball,
            per_ball,
            unit_error,
            extent,
            bounds: Bounds { support_error, radius, dimension: N, unknown_extent: !(extent > T::zero()) },
            axes: None,
            options,
            scale: T::one(),
            reach: T::zero(),
            direction: Vector::zeros(),
            height: T::HUGE,
            unit: T::one(),
            ratio: T::HUGE,
            point: Vector::zeros(),
            rival: None,
            rivalry: -T::HUGE,
            seeks_rivals: true,
            apart: false,
            skipped: T::HUGE,
            widest: T::zero(),
            spent: false,
            is_thin: false,
            exhaustive: false,
            iterations: 0,
            limit: options.limit().saturating_add(if options.max_iterations.is_none() {
                MAX_ITERATIONS_PER_VERTEX.saturating_mul(q.vertex_count() as u32)
            } else {
                0
            }),
            support_calls: 0,
            work: Work::new(q.vertex_count()),
            dimension: N,
            plan: Plan::Expansion,
            floor: T::zero(),
            floor_reach: T::HUGE,
            stopped: None,
        };
        (query, checked)
    }

    /// Chooses the scale. A set that does not know its extent is asked once.
    pub fn normalize(&mut self) -> Result<(), Failure> {
        let extent = if self.extent > T::zero() {
            self.extent
        } else {
            self.support_calls = self.support_calls.saturating_add(1);
            self.a.support(&self.first_direction())?.iter().fold(T::zero(), |m, x| m.at_least(x.abs()))
        };
        let size = extent + self.bounds.radius;
        let near = T::count(1 << 10);
        // (Sizes whose inverse is no normal number are left alone.)
        if !(size < near && size * near > T::one()) && size > T::TINY && size * T::count(4) < T::one() / T::TINY {
            let scale = T::one() / size.power_of_two();
            self.scale = scale;
            self.bounds.support_error *= scale;
            self.bounds.radius *= scale;
            self.floor *= scale;
            self.options.absolute *= scale;
            self.options.threshold = self.options.threshold.map(|t| t * scale);
        }
        Ok(())
    }

    /// A bound in the caller's units, rounded outwards where it becomes subnormal.
    fn unscaled(&self, value: T, outward: T) -> T {
        if self.scale == T::one() || value.abs() >= T::HUGE || value.is_zero() {
            return value;
        }
        let value = value / self.scale;
        if value.abs() < T::TINY { value + outward * T::TINY } else { value.at_least(-T::HUGE).at_most(T::HUGE) }
    }

    /// The factor that brings the caller's lengths to the query's.
    pub fn scale(&self) -> T {
        self.scale
    }

    /// The largest norm of a point seen, in the caller's units.
    pub fn true_reach(&self) -> T {
        self.reach / self.scale
    }

    /// Calls of A's support function so far.
    pub fn support_calls(&self) -> u32 {
        self.support_calls
    }

    /// Calls that were made before the query.
    pub fn count_calls(&mut self, calls: u32) {
        self.support_calls = self.support_calls.saturating_add(calls);
    }

    /// Tells the query a lower bound of d that holds anyway, in the caller's units. (Positive ones end it earlier.)
    pub fn know(&mut self, lower: T) {
        if lower > T::zero() && lower < T::HUGE {
            self.raise(lower * self.scale - lower * self.scale * T::count(2) * T::ROUNDOFF, T::HUGE);
        }
    }

    /// Goes on from another query of the same set: its lower bound holds, and its points count.
    pub fn resume(&mut self, before: &Answer<T, N>) {
        self.know(before.lower);
        self.iterations = self.iterations.saturating_add(before.iterations);
    }

    /// The same in scaled units, for a bound that was proved when the largest norm of a point was `reach`.
    pub fn raise(&mut self, lower: T, reach: T) {
        if lower > self.floor && self.still_holds(reach) {
            (self.floor, self.floor_reach) = (lower, reach);
        }
    }

    /// Are margins what they were when the largest norm of a point was `reach`? Where A does not know its extent, its error grows with that.
    pub fn still_holds(&self, reach: T) -> bool {
        !self.bounds.unknown_extent || self.reach <= reach
    }

    /// The direction to look in first.
    pub fn first_direction(&self) -> Vector<T, N> {
        let mut axis = Vector::<T, N>::zeros();
        if let Some(x) = axis.iter_mut().next() {
            *x = T::one();
        }
        let guess = self.options.guess.unwrap_or(axis);
        // Scaled to coordinates of at most 1, so that the squares cannot under- or overflow.
        let largest = guess.iter().fold(T::zero(), |m, x| m.at_least(x.abs()));
        if !finite(&guess) || !(largest > T::zero()) {
            return axis;
        }
        let scaled = guess.map(|x| x / largest);
        scaled * (T::one() / scaled.dot(&scaled).root())
    }

    /// Asks A along a unit direction, and keeps the upper bound if it is the best.
    pub fn support(&mut self, direction: &Vector<T, N>) -> Result<(Vertex<T, N>, T), Failure> {
        self.support_beyond(direction, T::zero())
    }

    /// The same where h_Q is at least `floor`: if that is above 0 and makes the direction no better than the best one, Q is not asked; nor for the
    /// largest number.
    pub fn support_beyond(&mut self, direction: &Vector<T, N>, floor: T) -> Result<(Vertex<T, N>, T), Failure> {
        self.work.add(Work::<N>::STEP);
        self.support_calls = self.support_calls.saturating_add(1);
        let (point, witness) =
            if self.exhaustive { self.a.exhaustive(direction)? } else { self.a.support_with_witness(direction)? };
        let (point, witness) =
            if self.scale == T::one() { (point, witness) } else { (point * self.scale, witness * self.scale) };
        self.see(&point)?;
        let height = direction.dot(&point);
        self.note(direction, height, &point, floor)?;
        Ok((Vertex { point, witness }, height))
    }

    /// The same, but the best direction stays what it is.
    pub fn ask(&mut self, direction: &Vector<T, N>) -> Result<Vertex<T, N>, Failure> {
        let best = (self.direction, self.point, self.height, self.unit, self.ratio);
        let found = self.support(direction);
        (self.direction, self.point, self.height, self.unit, self.ratio) = best;
        found.map(|(vertex, _)| vertex)
    }

    /// Refuses a point that is not finite, and lets the margin grow with its norm.
    #[inline(always)]
    fn see(&mut self, point: &Vector<T, N>) -> Result<(), Failure> {
        let squared = point.dot(point);
        if !squared.finite() {
            return Err(Failure(if finite(point) { TOO_LARGE } else { NOT_FINITE }));
        }
        if squared > self.reach * self.reach {
            self.reach = squared.root();
        }
        Ok(())
    }

    fn note(&mut self, direction: &Vector<T, N>, height: T, point: &Vector<T, N>, floor: T) -> Result<(), Failure> {
        let top = height + self.bounds.radius;
        let (unit, ratio) = if let Some(radius) = self.ball {
            (radius, top * self.per_ball)
        } else if self.apart || self.is_outside(direction, height) {
            // Outside, Q has no say: the distance counts.
            if !self.apart {
                (self.apart, self.ratio) = (true, T::HUGE);
            }
            (T::one(), height)
        } else if floor >= T::HUGE || floor > T::zero() && !(top < self.ratio * floor) {
            return Ok(());
        } else {
            self.work.add(self.work.unit());
            let unit = self.unit(direction)?;
            self.widest = self.widest.at_least(unit);
            if unit <= self.unit_error {
                return Ok(()); // Q has no extent that way: it bounds nothing.
            }
            (unit, top / unit)
        };
        if ratio < self.ratio {
            if self.seeks_rivals {
                self.rivalry = self.tolerance(T::one()).above(ratio);
                let (old, old_ratio) = (self.direction, self.ratio);
                self.meet(&old, old_ratio, direction);
            }
            (self.direction, self.point) = (*direction, *point);
            (self.height, self.unit, self.ratio) = (height, unit, ratio);
        } else if self.seeks_rivals {
            let best = self.direction;
            self.meet(direction, ratio, &best);
        }
        Ok(())
    }

    /// Keeps a direction that bounds d about as well as the best, well away from that.
    #[inline]
    fn meet(&mut self, direction: &Vector<T, N>, ratio: T, best: &Vector<T, N>) {
        if self.ties(ratio) && self.is_far(direction, best) {
            self.rival = Some((*direction, ratio));
        }
    }

    /// Does a quotient tie with the best, up to the tolerance?
    pub fn ties(&self, ratio: T) -> bool {
        ratio <= self.rivalry
    }

    /// Are two directions no two guesses at the same minimiser?
    pub fn is_far(&self, u: &Vector<T, N>, v: &Vector<T, N>) -> bool {
        u.dot(v) < T::of(RIVAL_COSINE)
    }

    /// The best direction, where rivals are sought and none is known.
    pub fn lonely(&self) -> Option<Vector<T, N>> {
        (self.seeks_rivals && self.rival().is_none()).then_some(self.direction)
    }

    /// A direction well away from the best one that bounds d as tightly, up to the tolerance.
    fn rival(&self) -> Option<Vector<T, N>> {
        let (direction, ratio) = self.rival?;
        (self.is_far(&direction, &self.direction) && self.ties(ratio)).then_some(direction)
    }

    fn unit(&self, direction: &Vector<T, N>) -> Result<T, Failure> {
        match self.ball {
            Some(radius) => Ok(radius),
            None => {
                let value = self.q.value(direction)?;
                if value.finite() && value >= T::zero() { Ok(value) } else { Err(Failure(NOT_FINITE)) }
            }
        }
    }

    /// s_Q(u), if Q tells.
    pub fn mapping(&self, direction: &Vector<T, N>) -> Option<Vector<T, N>> {
        self.q.mapping(direction).filter(|q| finite(q) && q.iter().any(|&x| x != T::zero()))
    }

    /// How far h_Q may be off, as a length.
    pub fn unit_error(&self) -> T {
        self.unit_error
    }

    /// The point of A's core that is known along the best direction.
    pub fn supported(&self) -> Vertex<T, N> {
        Vertex { point: self.point, witness: self.point }
    }

    /// Does a value of Q cost more than a step of a ray? Then Q is asked only where it may count.
    pub fn spares_unit(&self) -> bool {
        self.work.unit() > Work::<N>::STEP
    }

    /// How many rays decide the query, for a polytopal Q; else 0.
    pub fn rays(&self) -> usize {
        self.q.vertex_count()
    }

    pub fn ray(&self, index: usize) -> Vector<T, N> {
        self.q.vertex(index)
    }

    pub fn inner_radius(&self) -> T {
        self.q.inner_radius()
    }

    /// Is the origin certainly in A, whatever its heights?
    pub fn contains_origin(&self) -> bool {
        self.a.contains_origin()
    }

    /// A's size, as far as it is known.
    pub fn size(&self) -> T {
        if self.extent > T::zero() { self.extent * self.scale } else { self.reach }
    }

    /// Which changes of sign leave both A and Q as they are: bit s for the coordinates named by the bits of s.
    pub fn mirrors(&self) -> u64 {
        let both = |signs: u8| self.q.mirrored(signs) && self.a.mirrored(signs);
        (1..1 << N).filter(|&signs| both(signs)).fold(0, |bits, signs| bits | 1 << signs)
    }

    /// Lengths below this cannot be told from zero in a plane equation.
    pub fn resolution(&self) -> T {
        T::count(8 * N) * T::ROUNDOFF * self.reach
    }

    /// The key of a facet, eq. 24: no more than its true distance with respect to Q, up to the margin of the bracket.
    pub fn key(&mut self, normal: &Vector<T, N>, offset: T) -> Result<T, Failure> {
        let top = offset + self.bounds.radius;
        let bottom = match self.ball {
            Some(_) => return Ok(top * self.per_ball),
            None => {
                self.work.add(Work::<N>::FACET + self.work.unit());
                self.unit(normal)? + self.unit_error
            }
        };
        Ok(if bottom > T::zero() { top / bottom } else { T::HUGE })
    }

    /// The best quotient h_A/h_Q so far, without margins.
    pub fn ratio(&self) -> T {
        self.ratio
    }

    /// The lowest key of a facet that will not come back from the queue.
    pub fn skipped(&self) -> T {
        self.skipped
    }

    /// The queue was made anew.
    pub fn forget_skipped(&mut self) {
        self.skipped = T::HUGE;
    }

    /// A facet with this key is not queued.
    pub fn skip(&mut self, key: T) {
        self.skipped = self.skipped.at_most(key);
    }

    /// Where dQ touches the plane that proves the upper bound (less the ball term): there A's core ends, if the bracket is narrow. `None`
    /// where Q does not tell.
    pub fn foot(&self) -> Option<Vector<T, N>> {
        if self.ratio >= T::HUGE {
            None // nothing bounds d from above yet
        } else if self.ball.is_some() {
            Some(self.direction * self.height)
        } else {
            Some(self.mapping(&self.direction)? * self.ratio)
        }
    }

    /// Largest norm of a point of the core seen so far.
    pub fn reach(&self) -> T {
        self.reach
    }

    /// How far a height may be off, whatever the direction.
    pub fn margin(&self) -> T {
        self.bounds.margin(self.reach)
    }

    /// The same along a unit vector.
    pub fn margin_along(&self, direction: &Vector<T, N>) -> T {
        let margin = self.margin();
        self.axes.as_ref().map_or(margin, |axes| axes.margin(direction).at_most(margin))
    }

    /// Does A state its extent?
    pub fn knows_extent(&self) -> bool {
        self.extent > T::zero()
    }

    /// Takes margins by direction from now on, if that gains anything: where A is long and flat along the coordinate axes (a floor), heights
    /// across are known much better. The query has been made ready.
    pub fn look_by_direction(&mut self) -> bool {
        let margin = self.bounds.margin(self.size());
        let reach = self.a.extents() * (self.scale * T::of(1.01));
        let axes = Axes { errors: self.a.errors() * self.scale, reach };
        let stated = reach.iter().any(|&x| x > T::zero());
        let sane = stated && reach.iter().chain(axes.errors.iter()).all(|x| x.finite() && *x >= T::zero());
        self.axes = (sane && axes.are_uneven(margin)).then_some(axes);
        self.axes.is_some()
    }

    /// Is the origin certainly outside the core, by this support value?
    #[inline]
    pub fn is_outside(&self, direction: &Vector<T, N>, height: T) -> bool {
        height < T::zero() && height + self.margin_along(direction) < T::zero() && !self.contains_origin()
    }

    /// The limit that has been reached.
    pub fn stopped(&self) -> Option<Stop> {
        self.stopped
    }

    /// Has the caller set a limit?
    pub fn may_be_cut_short(&self) -> bool {
        self.options.max_iterations.is_some() || self.options.interrupt.is_some()
    }

    /// Counts an iteration; tells why there must be none when a limit is reached.
    pub fn exhausted(&mut self) -> Option<Stop> {
        if self.stopped.is_none() && self.iterations >= self.limit {
            self.stopped = Some(Stop::Iterations);
        }
        if self.interrupted().is_some() {
            return self.stopped;
        }
        self.iterations = self.iterations.saturating_add(1);
        None
    }

    /// Asks the caller, unless a limit has been reached; counts nothing.
    pub fn interrupted(&mut self) -> Option<Stop> {
        if self.stopped.is_none() && self.options.interrupt.is_some_and(|interrupt| interrupt()) {
            self.stopped = Some(Stop::Interrupted);
        }
        self.stopped
    }
}
