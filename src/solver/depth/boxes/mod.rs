//! Depth of two boxes, exactly: by the directions that the faces of their difference have, and nothing else.
//!
//! M = A - B is a zonotope ([`zonotope`]): a sum of six segments, the edges of A and of B, around the difference c of the centres,
//!
//! ```text
//! M = { c + sum over k of s_k g_k,  |s_k| <= w_k }        h(n) = c.n + sum over k of w_k |g_k.n|
//! ```
//!
//! with the columns g_k of both matrices and half sizes w_k. Each face of M is spanned by two of its segments, so its normal is one of the fifteen g_i x g_j
//! (three of A's faces, three of B's, nine of an edge of each): the axes of Gottschalk, Lin & Manocha (1996). Where M contains the origin, d is the least h(n) / |n| of
//! these; every other n has more. Each ball term is added. Matrices are used as they are given: nothing here needs them to be rotations.
//!
//! Where some h(n) < 0, the boxes are apart. Then the point x of M nearest to the origin is a bounded least squares problem in the six s_k ([`nearest`]); x itself
//! proves that the distance is not more, h along -x that it is not less. The same search finds the points that touch where the boxes
//! overlap: those nearest to d n.
//!
//! # Rounding
//!
//! **In one word.** With S the sum of |c_i| and all w_k, heights along a vector of length 1 are known to 32 u S: four operations on a product's way, up to seven
//! sums, twice that in other rounding modes, and n itself, off by 16 u where it is a product of two g. So d is above (h - 64 u S) / (|n| + 16 u), h and |n| computed. That
//! is enough for most tolerances in `f64`, and for deep contact in `f32`. Edges with |n| <= 64 u are taken for parallel: that moves M by no more than 96 u S, so d is
//! above what the other axes say less twice that.
//!
//! **In two words**, along the axes that one word does not rule out (one or two, mostly): n and the point of M farthest along it, and d's both ends, as sums of
//! two words with the error E of module [`fine`](super::fine). Where g_i and g_j are nearly parallel, their product is that of g_i with g_j -+ g_i, which is exact and
//! small: so n is known to 2^8 u^2 of that length. Were they parallel, M would have no face of theirs: where n is shorter than what it is known to, the second segment is
//! taken for parallel to the first, which moves M by less than E.

mod nearest;
mod zonotope;

use super::answer::Depth;
use super::body::Body;
use super::closed::{Found, is_enough};
use super::fine::Level;
use crate::bounds::Bracket;
use crate::math::{Accumulator, TwoWords, Vector, magnitude, norm, unit};
use crate::query::Options;
use crate::query::answer::Outcome;
use crate::scalar::Real;
use nearest::nearest;
use zonotope::{EDGES, Normal, Zonotope, length};

/// The pairs of segments that span faces, those of one body first: where an axis is as good as theirs, theirs are known better.
const FACES: [(usize, usize); 15] = [
    (1, 2),
    (2, 0),
    (0, 1),
    (4, 5),
    (5, 3),
    (3, 4),
    (0, 3),
    (0, 4),
    (0, 5),
    (1, 3),
    (1, 4),
    (1, 5),
    (2, 3),
    (2, 4),
    (2, 5),
];

/// Depth of two bodies that are boxes, with whatever ball terms.
pub(super) fn depth<T: Real>(a: &Body<'_, T>, b: &Body<'_, T>, options: &Options<'_, T, 3>) -> Depth<T> {
    match Zonotope::new(a, b) {
        Ok(m) => m.depth(options).conclude(options),
        Err(failure) => Depth::failed(failure),
    }
}

/// What one word knows of the axes.
struct Axes<T: Real> {
    /// h(n) / |n| >= lower, of each; next to nothing where the edges are nearly parallel.
    lower: [T; FACES.len()],
    /// The least of all: d of the cores is not below.
    least: T,
    /// The axis with the least h(n) / |n|, as a unit vector; this height, and what it is certainly not above.
    normal: Vector<T, 3>,
    height: T,
    most: T,
}

impl<T: Real> Zonotope<T> {
    fn depth(&self, options: &Options<'_, T, 3>) -> Found<T, 3> {
        let axes = self.axes();
        let most = axes.most;
        if options.interrupt.is_some_and(|interrupt| interrupt()) {
            let start = self.farthest(&TwoWords::from(axes.normal));
            let upper = self.with_balls(&Bracket { lower: most, upper: most }).upper;
            let found = self.found(Bracket { lower: self.not_below(&start), upper }, axes.normal, &start);
            return Found { outcome: Some(Outcome::Interrupted), ..found };
        }
        if axes.least > T::zero() {
            let bracket = self.with_balls(&Bracket { lower: axes.least, upper: most });
            if is_enough(&bracket, options) {
                return self.overlapping(bracket, axes.normal, axes.height, options);
            }
        } else if most < T::zero() {
            return self.apart(axes.normal, most, options);
        }
        let (core, normal) = self.in_two_words(&axes);
        if core.lower > T::zero() {
            self.overlapping(self.with_balls(&core), normal, core.upper, options)
        } else {
            self.apart(normal, core.upper, options)
        }
    }

    /// All axes, in one word.
    fn axes(&self) -> Axes<T> {
        let error = self.error_in_one_word();
        let center = self.center();
        let (lower, normal) = ([-T::HUGE; FACES.len()], Vector::zeros());
        let mut axes = Axes { lower, least: T::HUGE, normal, height: T::HUGE, most: T::HUGE };
        let mut moved = T::zero();
        for (lower, &(i, j)) in axes.lower.iter_mut().zip(&FACES) {
            let (Some(x), Some(y)) = (self.along.get(i), self.along.get(j)) else { continue };
            let n = x.cross(y);
            let length = norm(&n);
            if !(length > T::count(64) * T::ROUNDOFF) {
                moved = error * T::count(3);
                continue;
            }
            let (toward, height) = self.height(&n, &center, [i, j]);
            *lower = (height - error) / (length + T::count(16) * T::ROUNDOFF);
            axes.least = axes.least.at_most(*lower);
            // (What is short is known badly.)
            let inverse = T::one() / length;
            let most = (height + error) * inverse;
            if most < axes.most {
                (axes.normal, axes.height, axes.most) = (n * (inverse * toward), height * inverse, most);
            }
        }
        axes.least -= moved;
        axes
    }

    /// The bracket of the cores, should they overlap, and the direction that proves its upper end: in two words, along the axes that one word leaves in question.
    #[inline(never)]
    fn in_two_words(&self, axes: &Axes<T>) -> (Bracket<T>, Vector<T, 3>) {
        let (mut lower, mut moved) = (T::HUGE, T::zero());
        let (mut upper, mut normal) = (T::HUGE, axes.normal);
        for (&known, &(i, j)) in axes.lower.iter().zip(&FACES) {
            if known > axes.most {
                lower = lower.at_most(known);
                continue;
            }
            let (n, blur) = match self.normal_in_two_words(i, j) {
                Normal::None => continue,
                Normal::Unknown => {
                    moved = self.whole_error(); // (of all such pairs together)
                    continue;
                }
                Normal::Known(n, blur) => (n, blur),
            };
            // Of n and -n the one against c is lower. (Both, where one word does not tell.)
            let along = self.center().dot(&n.high);
            let doubtful = magnitude(along) <= self.error_in_one_word();
            let toward = if along > T::zero() { -n } else { n };
            for n in [Some(toward), doubtful.then(|| -toward)].into_iter().flatten() {
                let coordinates = self.farthest(&n);
                let point = self.place(&coordinates);
                lower = lower.at_most(Level::new(n, [T::zero(); 2], self.error(&n.high, &blur)).lower(&[point]));
                // (Along the rounded vector, mostly the same point is farthest.)
                let rounded = unit(&n.high);
                let height = self.not_above(&rounded, [T::zero(); 2], Some((&coordinates, &point)));
                if height < upper {
                    (upper, normal) = (height, rounded);
                }
            }
        }
        if upper >= T::HUGE {
            upper = self.not_above(&normal, [T::zero(); 2], None);
        }
        (Bracket { lower: (lower - moved).at_most(upper), upper }, normal)
    }

    /// An upper bound of d that a unit vector proves, for ball terms like these. A point of M may be known that is farthest along nearly the same vector.
    fn not_above(&self, n: &Vector<T, 3>, balls: [T; 2], known: Option<(&[T; EDGES], &TwoWords<T, 3>)>) -> T {
        let exact = TwoWords::from(*n);
        let coordinates = self.farthest(&exact);
        let point = match known {
            Some((same, point)) if *same == coordinates => *point,
            _ => self.place(&coordinates),
        };
        Level::new(exact, balls, self.error(n, &Vector::zeros()) + self.ball_error).upper(&point)
    }

    /// The bracket of boxes that overlap with ball terms, from that of their cores.
    fn with_balls(&self, core: &Bracket<T>) -> Bracket<T> {
        // What the ball terms are off, and the rounding of adding them.
        let blur = |x: T| self.ball_error + (x.abs() + self.ball) * (T::count(8) * T::ROUNDOFF);
        Bracket { lower: core.lower + self.ball - blur(core.lower), upper: core.upper + self.ball + blur(core.upper) }
    }

    /// The answer for boxes that overlap, with the points that touch after `height` along the normal.
    fn overlapping(
        &self,
        bracket: Bracket<T>,
        normal: Vector<T, 3>,
        height: T,
        options: &Options<'_, T, 3>,
    ) -> Found<T, 3> {
        let start = self.farthest(&TwoWords::from(normal));
        let point = nearest(self, start, &(normal * height), false);
        self.found(self.as_asked(bracket, &normal, options), normal, &point.coordinates)
    }

    /// The answer for boxes whose cores do not certainly overlap, seen along this unit vector, which proves this upper bound for the cores.
    #[inline(never)]
    fn apart(&self, normal: Vector<T, 3>, core: T, options: &Options<'_, T, 3>) -> Found<T, 3> {
        let start = self.farthest(&TwoWords::from(normal));
        let upper = self.with_balls(&Bracket { lower: core, upper: core }).upper;
        // (Where that decides, nothing is searched.)
        if options.threshold.is_some_and(|threshold| upper < threshold) {
            return self.found(Bracket { lower: self.not_below(&start), upper }, normal, &start);
        }
        let point = nearest(self, start, &Vector::zeros(), true);
        let seen = self.not_above(&point.toward, self.balls, None);
        let (upper, normal) = if seen < upper { (seen, point.toward) } else { (upper, normal) };
        let bracket = Bracket { lower: self.not_below(&point.coordinates), upper };
        self.found(self.as_asked(bracket, &normal, options), normal, &point.coordinates)
    }

    /// No more is claimed than was asked for. Boxes are described by rounded numbers, and a bracket that contains what these stand for is worth more than
    /// one that is narrower.
    fn as_asked(&self, bracket: Bracket<T>, normal: &Vector<T, 3>, options: &Options<'_, T, 3>) -> Bracket<T> {
        let rounding = self.size_along(normal) * (T::count(2) * T::ROUNDOFF);
        let wider = Bracket { lower: bracket.lower - rounding, upper: bracket.upper + rounding };
        if is_enough(&wider, options) { wider } else { bracket }
    }

    /// A point of M: d is not below minus its distance, the ball terms added.
    fn not_below(&self, coordinates: &[T; EDGES]) -> T {
        let point = self.place(coordinates);
        let (root, slip) = length(&point);
        let mut sum = Accumulator::new(root);
        for term in [-self.balls[0], -self.balls[1], slip] {
            sum.add(term);
        }
        let distance = sum.value();
        // |x + e| <= |x| + e.x / |x| + |e|^2 / (2 |x|), and not above |x| + |e|.
        let whole = self.whole_error();
        let along = self.error(&unit(&point.high), &Vector::zeros()) + whole * (whole / root.at_least(T::TINY));
        let error = along.at_most(whole) + self.ball_error;
        -(distance + error + distance.abs() * (T::count(8) * T::ROUNDOFF))
    }

    fn found(&self, bracket: Bracket<T>, normal: Vector<T, 3>, coordinates: &[T; EDGES]) -> Found<T, 3> {
        let [on_a, on_b] = self.points(coordinates);
        let [ball_a, ball_b] = self.balls;
        let dimension = self.dimension();
        let is_flat = dimension < 3 && self.ball.is_zero() && bracket.lower <= T::zero() && bracket.upper >= T::zero();
        Found {
            bracket,
            normal,
            on_a: on_a + normal * ball_a,
            on_b: on_b - normal * ball_b,
            calls: 1,
            outcome: is_flat.then_some(Outcome::Degenerate),
            dimension,
        }
    }
}
