//! The state of one query: what has been asked of A and Q, the best upper bound so far, and how all of it becomes an
//! [`Answer`].

use crate::answer::{Answer, Stop};
use crate::bounds::{Bounds, Bracket, Tolerance};
use crate::polytope::Polytope;
use crate::qset::Gauge;
use crate::scalar::{Real, Vector, finite};
use crate::simplex::{Simplex, Vertex};
use crate::support::{Failure, Support};

/// How a query ends, and where it looks first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options<T, const N: usize> {
    /// Stop when upper - lower <= max(absolute, relative |d|). Default 0.
    pub absolute: T,
    /// See `absolute`. Default 1e-6 in `f64`, 1e-4 in `f32`.
    pub relative: T,
    /// Stop as soon as d >= threshold or d < threshold is certain.
    pub threshold: Option<T>,
    /// Most points to add; 0: until the workspace is full. Default 0.
    pub max_iterations: u32,
    /// The direction to look in first (any length, not zero): where the answer was last time.
    pub guess: Option<Vector<T, N>>,
}

impl<T: Real, const N: usize> Default for Options<T, N> {
    fn default() -> Self {
        Options {
            absolute: T::zero(),
            relative: T::RELATIVE_TOLERANCE,
            threshold: None,
            max_iterations: 0,
            guess: None,
        }
    }
}

/// A bracket of width ε pins the direction of a smooth minimum to about sqrt(ε) only. Running to a quarter of the tolerance
/// halves that error and costs an iteration at most.
const SHARPEN: f64 = 0.25;

pub(crate) struct Query<'q, T, const N: usize> {
    a: &'q dyn Support<T, N>,
    q: &'q dyn Gauge<T, N>,
    /// Radius of Q where it is a ball.
    pub ball: Option<T>,
    /// Its inverse, or 1.
    per_ball: T,
    gauge_error: T,
    /// What A says of its extent; 0: nothing.
    extent: T,
    pub bounds: Bounds<T>,
    /// Tolerance and threshold in scaled units.
    pub options: Options<T, N>,
    /// A power of two that brings the set to a size near 1, so that no product under- or overflows; 1 for sets that are
    /// near it already. All lengths of a query are scaled by it, the answer's are scaled back: both exactly.
    scale: T,
    /// Largest norm of a point seen.
    reach: T,
    /// The best upper bound: unit direction, support value, value of Q, and their quotient without margins.
    pub direction: Vector<T, N>,
    height: T,
    gauge: T,
    ratio: T,
    /// For a general Q: the origin is certainly outside of A, and `height` is minus a distance.
    apart: bool,
    /// The lowest key of a facet that was not queued because it was above `ratio` then.
    skipped: T,
    /// Ask the support function without its shortcuts.
    exhaustive: bool,
    pub iterations: u32,
    support_calls: u32,
    /// Affine dimension of the core.
    pub dimension: usize,
}

impl<'q, T: Real, const N: usize> Query<'q, T, N> {
    /// A query with `radius` as the ball term that is taken out of A. What the sets say of themselves is read once, here;
    /// an error when one of these lengths is negative or not finite (then the query must not be run).
    pub fn new(
        a: &'q dyn Support<T, N>,
        q: &'q dyn Gauge<T, N>,
        radius: T,
        options: Options<T, N>,
    ) -> (Self, Result<(), Failure>) {
        let (extent, support_error, gauge_error) = (a.extent(), a.error(), q.error());
        let ball = q.ball_radius();
        let per_ball = T::one() / ball.unwrap_or(T::one());
        let sane = [radius, extent, support_error, gauge_error].iter().all(|x| x.finite() && *x >= T::zero());
        let sane = sane && per_ball.finite() && per_ball > T::zero();
        let checked = if sane { Ok(()) } else { Err(Failure(crate::NOT_FINITE)) };
        let query = Query {
            a,
            q,
            ball,
            per_ball,
            gauge_error,
            extent,
            bounds: Bounds { support_error, radius, dimension: N, unknown_extent: !(extent > T::zero()) },
            options,
            scale: T::one(),
            reach: T::zero(),
            direction: Vector::zeros(),
            height: T::HUGE,
            gauge: T::one(),
            ratio: T::HUGE,
            apart: false,
            skipped: T::HUGE,
            exhaustive: false,
            iterations: 0,
            support_calls: 0,
            dimension: N,
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
            self.options.absolute *= scale;
            self.options.threshold = self.options.threshold.map(|t| t * scale);
        }
        Ok(())
    }

    /// A bound in the caller's units, rounded outwards where it becomes subnormal.
    fn unscaled(&self, value: T, outward: T) -> T {
        if self.scale == T::one() || value.abs() >= T::HUGE {
            return value;
        }
        let value = value / self.scale;
        if value.abs() < T::TINY { value + outward * T::TINY } else { value.at_least(-T::HUGE).at_most(T::HUGE) }
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
        self.support_calls = self.support_calls.saturating_add(1);
        let (point, witness) = if self.exhaustive {
            let point = self.a.exhaustive(direction)?;
            let (_, witness) = self.a.support_with_witness(direction)?;
            (point, witness)
        } else {
            self.a.support_with_witness(direction)?
        };
        let (point, witness) =
            if self.scale == T::one() { (point, witness) } else { (point * self.scale, witness * self.scale) };
        self.see(&point)?;
        let height = direction.dot(&point);
        self.note(direction, height)?;
        Ok((Vertex { point, witness }, height))
    }

    /// Refuses a point that is not finite, and lets the margin grow with its norm.
    #[inline(always)]
    fn see(&mut self, point: &Vector<T, N>) -> Result<(), Failure> {
        let squared = point.dot(point);
        if !squared.finite() {
            return Err(Failure(crate::NOT_FINITE));
        }
        if squared > self.reach * self.reach {
            self.reach = squared.root();
        }
        Ok(())
    }

    fn note(&mut self, direction: &Vector<T, N>, height: T) -> Result<(), Failure> {
        let top = height + self.bounds.radius;
        if let Some(radius) = self.ball {
            if height < self.height {
                (self.direction, self.height, self.gauge, self.ratio) =
                    (*direction, height, radius, top * self.per_ball);
            }
            return Ok(());
        }
        if self.apart || self.is_outside(height) {
            // Outside, Q has no say: the distance counts.
            if !self.apart || height < self.height {
                (self.direction, self.height, self.ratio, self.apart) = (*direction, height, height, true);
            }
            return Ok(());
        }
        let gauge = self.gauge(direction)?;
        if gauge <= self.gauge_error {
            return Ok(()); // Q has no extent that way: it bounds nothing.
        }
        let ratio = top / gauge;
        if ratio < self.ratio {
            (self.direction, self.height, self.gauge, self.ratio) = (*direction, height, gauge, ratio);
        }
        Ok(())
    }

    fn gauge(&self, direction: &Vector<T, N>) -> Result<T, Failure> {
        match self.ball {
            Some(radius) => Ok(radius),
            None => {
                let value = self.q.value(direction)?;
                if value.finite() && value >= T::zero() { Ok(value) } else { Err(Failure(crate::NOT_FINITE)) }
            }
        }
    }

    /// The key of a facet, eq. 24: no more than its true distance with respect to Q, up to the margin of the bracket.
    pub fn key(&self, normal: &Vector<T, N>, offset: T) -> Result<T, Failure> {
        let top = offset + self.bounds.radius;
        let bottom = match self.ball {
            Some(_) => return Ok(top * self.per_ball),
            None => self.gauge(normal)? + self.gauge_error,
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

    /// Where the plane that proves the upper bound touches the core of A, were A a ball: direction times support value.
    pub fn foot(&self) -> Vector<T, N> {
        self.direction * self.height
    }

    /// Largest norm of a point of the core seen so far.
    pub fn reach(&self) -> T {
        self.reach
    }

    pub fn margin(&self) -> T {
        self.bounds.margin(self.reach)
    }

    /// Is the origin certainly outside the core, by this support value?
    pub fn is_outside(&self, height: T) -> bool {
        height + self.margin() < T::zero()
    }

    /// The upper bound: proved by `direction`.
    pub fn upper(&self) -> T {
        if self.height >= T::HUGE {
            return T::HUGE; // nothing has been asked yet
        }
        let margin = self.margin();
        match self.ball {
            Some(_) => self.bounds.upper_ball(self.height, margin, self.per_ball),
            None if self.apart => self.bounds.upper(self.height, margin, T::one(), T::zero()),
            None => self.bounds.upper(self.height, margin, self.gauge, self.gauge_error),
        }
    }

    /// Lower bound from a point of A at this distance: d >= -distance, whether or not the origin is inside.
    pub fn lower_from_distance(&self, distance: T) -> T {
        self.bounds.lower_ball(-distance, self.margin(), self.per_ball)
    }

    /// Lower bound from the lowest offset of a closed surface around the origin, for a ball; `None` when the origin is
    /// not certainly inside (module `bounds`).
    pub fn lower_from_offset(&self, offset: T) -> Option<T> {
        let margin = self.margin();
        (offset > margin).then(|| self.bounds.lower_ball(offset, margin, self.per_ball))
    }

    /// The same for any Q, from (offset, key) of all facets of the surface.
    pub fn lower_from_facets(&self, facets: impl Iterator<Item = (T, T)>) -> Option<T> {
        let margin = self.margin();
        let (mut inradius, mut least) = (T::HUGE, T::HUGE);
        for (offset, key) in facets {
            // (e - m) / h, from e and e / h.
            inradius = inradius.at_most(offset);
            least = least.at_most(key - key * (margin / offset));
        }
        (inradius > margin).then(|| least * (T::one() - T::count(16) * T::ROUNDOFF))
    }

    /// A quick no to [`verdict`](Query::verdict): the gap between lowest key and best quotient is too wide even
    /// without margins.
    #[inline]
    pub fn is_open(&self, key: T) -> bool {
        let gap = Bracket { lower: key, upper: self.ratio };
        self.options.threshold.is_none() && !self.tolerance(T::of(SHARPEN)).met(&gap)
    }

    /// Does the bracket end the query?
    pub fn verdict(&self, bracket: &Bracket<T>) -> Option<Stop> {
        if let Some(threshold) = self.options.threshold {
            if bracket.lower >= threshold {
                return Some(Stop::Above);
            }
            if bracket.upper < threshold {
                return Some(Stop::Below);
            }
        }
        self.tolerance(T::of(SHARPEN)).met(bracket).then_some(Stop::Met)
    }

    fn tolerance(&self, share: T) -> Tolerance<T> {
        Tolerance { absolute: self.options.absolute * share, relative: self.options.relative * share }
    }

    /// Is this bracket as narrow as asked for?
    pub fn is_met(&self, bracket: &Bracket<T>) -> bool {
        self.tolerance(T::one()).met(bracket)
    }

    /// Is this bracket about as narrow as rounding allows?
    pub fn is_tight(&self, bracket: &Bracket<T>) -> bool {
        bracket.upper - bracket.lower <= self.margin() * T::count(64) * self.per_ball
    }

    /// Counts an iteration; true when the limit is reached.
    pub fn exhausted(&mut self) -> bool {
        if self.options.max_iterations != 0 && self.iterations >= self.options.max_iterations {
            return true;
        }
        self.iterations = self.iterations.saturating_add(1);
        false
    }

    /// Checks the direction that is about to be reported without shortcuts. False when that raises the upper bound;
    /// shortcuts are then over for this query.
    pub fn verify(&mut self) -> Result<bool, Failure> {
        if self.exhaustive || !self.a.has_shortcuts() {
            return Ok(true);
        }
        self.exhaustive = true;
        let direction = self.direction;
        self.support_calls = self.support_calls.saturating_add(1);
        let point = self.a.exhaustive(&direction)? * self.scale;
        self.see(&point)?;
        let height = direction.dot(&point);
        if height <= self.height {
            return Ok(true);
        }
        // The shortcut was wrong: what it said is forgotten.
        (self.height, self.ratio, self.apart) = (T::HUGE, T::HUGE, false);
        self.note(&direction, height)?;
        Ok(false)
    }

    /// The answer for this stop, lower bound and evidence. `polytope` tells what was used.
    pub fn answer(
        &mut self,
        stop: Stop,
        lower: T,
        mut witness: Simplex<T, N>,
        polytope: &Polytope<'_, T, N>,
    ) -> Answer<T, N> {
        let stop = match self.verify() {
            Ok(_) => stop,
            Err(Failure(code)) => {
                (self.height, self.gauge) = (T::HUGE, T::one());
                Stop::Failed(code)
            }
        };
        let upper = self.upper();
        let known = lower > -T::HUGE && lower < T::HUGE && upper < T::HUGE;
        let met = known && self.is_met(&Bracket { lower, upper });
        // Whatever ended the run, a threshold that the final bracket decides is decided, and no other.
        let stop = match (stop, self.options.threshold) {
            (Stop::Failed(code), _) => Stop::Failed(code),
            (_, Some(t)) if lower >= t => Stop::Above,
            (_, Some(t)) if upper < t => Stop::Below,
            (Stop::Above | Stop::Below, _) => Stop::Rounding,
            (stop, _) => stop,
        };
        let at_zero = lower <= T::zero() && (met || self.is_tight(&Bracket { lower, upper }));
        let outcome = stop.outcome(lower, upper, met, at_zero);
        witness.rescale(T::one() / self.scale);
        Answer {
            outcome,
            lower: self.unscaled(lower, -T::one()),
            upper: self.unscaled(upper, T::one()),
            direction: self.direction,
            witness,
            dimension: self.dimension,
            iterations: self.iterations,
            support_calls: self.support_calls,
            vertices: polytope.vertices().len(),
            facets: polytope.peak_facets(),
            failure: if let Stop::Failed(code) = stop { code } else { 0 },
        }
    }
}
