//! The points of two bodies in two words, remembered: see "Exact points" and "Balls of turned bodies" in the module above.

use core::cell::{Cell, RefCell};

use crate::math::{TwoWords, Vector, unit};
use crate::scalar::Real;
use crate::solver::depth::body::{Anchor, Body, skew};
use crate::solver::depth::pair::Pair;
use crate::support::failure::NOT_FINITE;
use crate::support::{Failure, Support};
use heapless::Vec;

/// Points that are remembered, the latest. (A query of two hulls makes some fifteen, one of curved bodies up to fifty, of which the last count.)
const POINTS: usize = 44;

/// The difference of two bodies, with points that are right to their own last digit, and remembered in two words.
pub struct Recorder<'p, 'b, 'a, T: Real, const N: usize> {
    pub pair: &'p Pair<'b, 'a, T, N>,
    points: RefCell<Vec<TwoWords<T, N>, POINTS>>,
    /// Where the next one goes when all places are taken.
    next: Cell<usize>,
    /// What the last call has found. (Points that differ by less than a roundoff have one high word; the first is remembered for all of them.)
    latest: Cell<Option<TwoWords<T, N>>>,
    /// Is nothing forgotten any more? Bounds stand on the points then.
    frozen: Cell<bool>,
    /// ρ' of A and B; 0 where there is no ρ.
    rolling: [T; 2],
}

impl<'p, 'b, 'a, T: Real, const N: usize> Recorder<'p, 'b, 'a, T, N> {
    /// Are the points of both bodies known in two words?
    #[inline(never)]
    pub fn suits(pair: &Pair<'_, '_, T, N>) -> bool {
        let axis = TwoWords::from(Vector::repeat(T::one()));
        // (Errors are told by what a shape says of its extents.)
        let exact = |body: &Body<'_, T, N>, anchor: &Anchor<T, N>| {
            let stated = body.shape.extent() > T::zero() || anchor.extent == T::zero();
            let rolls = body.shape.rolling_radius();
            let whole = rolls == T::zero() || rolls == body.ball;
            stated && whole && body.inflation == T::zero() && body.shape.support_in_two_words(&axis).is_some()
        };
        exact(pair.a, &pair.on_a) && exact(pair.b, &pair.on_b)
    }

    /// For bodies that suit.
    pub fn new(pair: &'p Pair<'b, 'a, T, N>) -> Self {
        let rolling = [pair.a, pair.b].map(|body| {
            let off = skew(&body.rotation) + T::count(8) * T::ROUNDOFF;
            body.shape.rolling_radius() * (T::one() - T::count(8) * off)
        });
        Recorder {
            pair,
            rolling,
            points: RefCell::new(Vec::new()),
            next: Cell::new(0),
            latest: Cell::new(None),
            frozen: Cell::new(false),
        }
    }

    /// The point that is farthest along a direction, in two words, and the one of A, from its anchor.
    #[inline(never)]
    fn ask(&self, u: &Vector<T, N>) -> Option<(TwoWords<T, N>, Vector<T, N>)> {
        let [rolling_a, rolling_b] = self.rolling;
        let (a, on_a) = self.pair.a.precise(u, rolling_a)?;
        let (b, _) = self.pair.b.precise(&-u, rolling_b)?;
        let on_a = self.pair.on_a.center.map_or(on_a, |center| on_a - center);
        Some((a.plus(&-b), TwoWords::from(on_a).turned(&self.pair.a.rotation).high))
    }

    /// A point that is not told in two words ends the query: one of the pair's own would be of another core, where a ball rolls in it, and perhaps a shortcut's.
    fn sample(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        let (point, on_a) = self.ask(u).ok_or(Failure(NOT_FINITE))?;
        self.latest.set(Some(point));
        if self.behind(&point.high).is_none()
            && let Ok(mut points) = self.points.try_borrow_mut()
            && points.push(point).is_err()
            && !self.frozen.get()
        {
            let next = self.next.get();
            if let Some(place) = points.get_mut(next) {
                *place = point;
            }
            self.next.set((next + 1) % POINTS);
        }
        Ok((point.high, on_a))
    }

    /// The ball terms.
    pub fn balls(&self) -> [T; 2] {
        let [a, b] = self.rolling;
        [self.pair.a.precise_ball(a), self.pair.b.precise_ball(b)]
    }

    /// What the last call has found.
    pub fn latest(&self) -> Option<TwoWords<T, N>> {
        self.latest.get()
    }

    /// Forgets all points but those behind these vertices, and none from now on.
    pub fn freeze(&self, is_needed: impl Fn(&Vector<T, N>) -> bool) {
        self.frozen.set(true);
        if let Ok(mut points) = self.points.try_borrow_mut() {
            points.retain(|point| is_needed(&point.high));
        }
    }

    /// The point behind a vertex.
    #[inline(never)]
    pub fn behind(&self, vertex: &Vector<T, N>) -> Option<TwoWords<T, N>> {
        self.points.try_borrow().ok()?.iter().find(|point| point.high == *vertex).copied()
    }
}

impl<T: Real, const N: usize> Body<'_, T, N> {
    /// The placed support point in two words, less that of the ball of radius `rolling` in place of the shape's own; and the core's point in its frame, rounded.
    fn precise(&self, u: &Vector<T, N>, rolling: T) -> Option<(TwoWords<T, N>, Vector<T, N>)> {
        let local = TwoWords::from(*u).turned_back(&self.rotation);
        let own = self.shape.support_in_two_words(&local)?;
        let point = own.turned(&self.rotation).plus(&TwoWords::from(self.translation));
        if !(rolling > T::zero()) {
            return Some((point, own.high));
        }
        let ball = TwoWords::from(*u).unit().times(&Vector::repeat(rolling));
        let core = own.high - unit(&local.high) * self.shape.rolling_radius();
        Some((point.plus(&-ball), core))
    }

    /// The ball term that goes with it.
    fn precise_ball(&self, rolling: T) -> T {
        if rolling > T::zero() { rolling } else { self.ball }
    }
}

impl<T: Real, const N: usize> Support<T, N> for Recorder<'_, '_, '_, T, N> {
    fn support(&self, u: &Vector<T, N>) -> Result<Vector<T, N>, Failure> {
        Ok(self.sample(u)?.0)
    }
    fn support_with_witness(&self, u: &Vector<T, N>) -> Result<(Vector<T, N>, Vector<T, N>), Failure> {
        self.sample(u)
    }
    fn radius(&self) -> T {
        let [a, b] = self.balls();
        a + b
    }
    fn extent(&self) -> T {
        self.pair.extent()
    }
    fn error(&self) -> T {
        self.pair.error()
    }
    fn extents(&self) -> Vector<T, N> {
        self.pair.extents()
    }
    fn errors(&self) -> Vector<T, N> {
        self.pair.errors()
    }
}
