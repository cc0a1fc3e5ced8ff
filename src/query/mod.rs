//! The state of one query. Each part has a file, which says what may be done with it:
//!
//! * `options` is the caller's. `sets` is what A and Q say of themselves; nothing changes it.
//! * `asking` asks A, which may make the best upper bound better, and `rivals` notes what ties with it.
//! * `bracket` says what is proved, and when that is enough; `floor` is what was proved elsewhere.
//! * `limits` counts, `work` counts what plans take turns by, and both say when it is enough.
//! * `end` makes the [`Answer`](answer::Answer) of it (`answer`).
//!
//! What is left is here: how all of it begins, the scale that it is seen at, and the margins.

use crate::bounds::{Axes, Bounds};
use crate::math::{Vector, finite};
use crate::qset::UnitSet;
use crate::query::answer::Plan;
use crate::scalar::Real;
use crate::support::failure::NOT_FINITE;
use crate::support::{Failure, Support};

pub(crate) mod answer;
mod asking;
mod bracket;
mod end;
mod floor;
mod limits;
mod options;
mod rivals;
mod sets;
mod work;

use asking::Upper;
use floor::Floor;
use limits::Limits;
pub use options::Options;
use rivals::Rivals;
pub(crate) use work::Work;

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
    /// The best upper bound.
    pub best: Upper<T, N>,
    pub rivals: Rivals<T, N>,
    /// The lowest key of a facet that was not queued because it was above the best quotient then.
    skipped: T,
    /// Nothing but the lower end at 0 is left to be found out.
    spent: bool,
    /// The last resort: rays go on with pivots that wear their inverse out.
    pub is_patient: bool,
    /// A was taken for flat, for its margins, and is not.
    pub is_thin: bool,
    /// Ask the support function without its shortcuts.
    exhaustive: bool,
    limits: Limits,
    pub work: Work<N>,
    /// Affine dimension of the core.
    pub dimension: usize,
    /// How the query is being answered.
    pub plan: Plan,
    /// A lower bound of d that holds anyway.
    floor: Floor<T>,
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
        let (ball, vertices) = (q.ball_radius(), q.vertex_count());
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
            best: Upper::none(),
            rivals: Rivals::none(),
            skipped: T::HUGE,
            spent: false,
            is_patient: false,
            is_thin: false,
            exhaustive: false,
            limits: Limits::new(&options, vertices),
            work: Work::new(vertices),
            dimension: N,
            plan: Plan::Expansion,
            floor: Floor::none(),
        };
        (query, checked)
    }

    /// Chooses the scale. A set that does not know its extent is asked once.
    pub fn normalize(&mut self) -> Result<(), Failure> {
        let extent = if self.extent > T::zero() {
            self.extent
        } else {
            self.count_calls(1);
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
            self.floor.lower *= scale;
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

    /// Lengths below this cannot be told from zero in a plane equation.
    pub fn resolution(&self) -> T {
        T::count(8 * N) * T::ROUNDOFF * self.reach
    }

    /// The best quotient h_A/h_Q so far, without margins.
    pub fn ratio(&self) -> T {
        self.best.ratio
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
}
