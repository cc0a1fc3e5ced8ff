//! The weakest direction to rounding, and the contact forces that it loads.
//!
//! A bracket of relative width e pins the minimiser u of h_W / h_Q to about e where h_W has a kink across it, and to sqrt(e) only
//! where h_W is smooth. What depends on u to first order, as the gradient of d does (module `gradient`), wants it to rounding. Near
//! the minimiser everything has a closed form, so Newton's method does the rest. The conditions of a minimum are
//!
//! ```text
//! Σ λ_i (c_i + D_i x_i) = d s_Q(u)                  a point of W, and the same of d Q
//! ```
//!
//! with the parts of the primitives { c + D x : |x| <= 1 }. Kinks of h_W are where minima like to be, and each has its equation and
//! its multiplier:
//!
//! ```text
//! LInf   h_i(u) > 0: λ_i = 1     h_i(u) < 0: λ_i = 0     h_i(u) = 0: 0 <= λ_i <= 1
//! L1     h_i(u) = d h_Q(u): λ_i >= 0, the sum is 1       h_i(u) less: λ_i = 0
//! both   D_i^T u = 0: |x_i| <= 1, at a tip               else x_i = D_i^T u / |D_i^T u|
//! ```
//!
//! Which contacts are at a kink is guessed, from the widest notion of "is zero" to the narrowest, corrected by the signs of
//! the multipliers, and then **verified**: an optimum is only called smooth when all inequalities hold strictly, the equations are
//! regular, and h_W grows to second order along all that they leave free. Then u and the multipliers are unique, and follow the
//! grasp smoothly (Fiacco, *Introduction to Sensitivity and Stability Analysis*, 1983): d has a gradient. One irregular case is
//! common and harmless: three hard fingers are weakest about the line through two of them, whose squeeze is then free.
//!
//! The Hessian of h_Q is taken from differences of its mapping s_Q: zero for polytopes, good to sqrt(roundoff) for others,
//! which costs Newton's method nothing that counts, since the equations themselves are exact.

use heapless::Vec;
use nalgebra::SMatrix;

use super::default_tolerance;
use super::primitive::{Primitive, frobenius};
use super::span::Subspace;
use super::wrench_set::{Norm, WrenchSet};
use crate::answer::Answer;
use crate::bounds::Bounds;
use crate::plan::shoot::descend;
use crate::qset::Gauge;
use crate::query::{Options, Query};
use crate::scalar::{Real, Vector, finite, norm, unit};
use crate::support::Support;

/// Equations beside the six of u and the one of d: more than six are never independent.
const TIES: usize = 6;
const SIZE: usize = 7 + TIES;
/// More Newton steps than any convergent run takes.
const STEPS: usize = 40;
/// Corrections of one guess.
const CORRECTIONS: usize = 4;

type Vector6<T> = Vector<T, 6>;
type Matrix6<T> = SMatrix<T, 6, 6>;
type Ties<T> = Vec<Tie<T>, TIES>;

/// Why an optimum has no gradient, or none that could be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kink {
    /// Another direction bounds d as tightly: the minimiser is not unique.
    Rival,
    /// Two or more points of Q touch the boundary of W.
    Gauge,
    /// No minimum with strict inequalities and regular equations was found near the answer's direction: a contact is just
    /// about to carry load, contacts share it in more than one way, h_W / h_Q is constant along a curve, or the answer was
    /// too far from a minimum.
    Degenerate,
    /// The grasp is not known to be closed: d is not known to be above 0.
    NotClosed,
}

/// What one contact carries at the weakest direction: `weight (center + disc x)` of its primitive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share<T> {
    /// λ, 0 to 1: the share of the full normal force.
    pub weight: T,
    /// |x| <= 1: how the friction is used, in the coordinates of the primitive's disc.
    pub friction: Vector<T, 3>,
}

/// An answer whose upper end and direction are those of an exact local minimum.
///
/// ```
/// use qdist::grasp::{Contact, ContactError, Friction, Norm, Primitive, Refined, WrenchFrame, WrenchSet, wrenches};
/// use qdist::{Options, Vector, Workspace, qset::Ball};
/// let frame = WrenchFrame::new(Vector::zeros(), 1.0)?;
/// let soft = Friction::Soft { mu: 0.5, mus: 0.2 };
/// let contact = |x: f64, y: f64, z: f64| {
///     let p = Vector::from([x, y, z]);
///     Contact::new(p, -p.normalize(), soft)
/// };
/// let contacts = [contact(1.0, 0.1, 0.2)?, contact(-0.4, 0.8, 0.1)?, contact(-0.5, -0.9, -0.2)?];
/// let mut primitives = [Primitive::empty(); 3];
/// let set = WrenchSet::new(wrenches(&contacts, &frame, &mut primitives).unwrap(), Norm::L1);
/// let mut memory = Workspace::<f64, 6, 2048, 2048>::new();
/// let coarse = memory.solver().solve(&set, &Ball::unit(), &Options { relative: 1e-2, ..Options::default() });
/// let refined = Refined::new(&set, &Ball::unit(), &coarse);
/// assert_eq!(refined.kink, None);
/// assert!(refined.answer.upper <= coarse.upper && refined.answer.upper >= coarse.lower);
/// # Ok::<(), ContactError>(())
/// ```
#[derive(Clone)]
pub struct Refined<'a, T> {
    /// The answer; `lower` is untouched, `upper` not worse. Where the minimum was found, `direction`, `support` (the point of W that
    /// touches d Q) and `gauge` are those of it, and `rival` is what still is one.
    pub answer: Answer<T, 6>,
    /// Why there is no gradient; `None`: there is one.
    pub kink: Option<Kink>,
    set: WrenchSet<'a, T>,
    ties: Ties<T>,
}

/// An equation that holds at the minimiser, and its multiplier.
#[derive(Clone, Copy, Debug)]
struct Tie<T> {
    kind: Kind,
    /// A normalised column of the disc, or a direction out of the span.
    along: Vector6<T>,
    multiplier: T,
    /// Of a tip: λ x is so many multipliers.
    unit: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    /// h_i(u) is 0 (LInf) or the largest (L1).
    Weight(usize),
    /// Contact and column of its disc: u is orthogonal to it.
    Tip(usize, usize),
    /// u stays in the span of W.
    Flat,
}

/// A minimum of h_W / h_Q.
#[derive(Clone)]
struct Minimum<T> {
    u: Vector6<T>,
    ratio: T,
    ties: Ties<T>,
    support: Vector6<T>,
    sharp: bool,
}

impl<'a, T: Real> Refined<'a, T> {
    /// Refines an answer of [`Solver::solve`](crate::Solver::solve) or [`solve_in_span`](crate::Solver::solve_in_span) for the same
    /// `set` and `q`, to be called with a Q that has a [`mapping`](Gauge::mapping). The answer's bracket may be coarse, 1e-2
    /// is usually enough; but only the bracket tells how far another, deeper minimum may be below.
    ///
    /// Cost: some ten Newton steps for each guess, of some 12 calls of the mapping, m primitives of 200 operations, and one elimination
    /// with 13 unknowns.
    pub fn new(set: &WrenchSet<'a, T>, q: &dyn Gauge<T, 6>, answer: &Answer<T, 6>) -> Self {
        let mut refined = Self { answer: answer.clone(), kink: Some(Kink::Degenerate), set: *set, ties: Vec::new() };
        if !(answer.lower > T::zero()) {
            refined.kink = Some(Kink::NotClosed);
            return refined;
        }
        let flat = answer.dimension < 6;
        let span = if flat { Subspace::new(set.contributions(), default_tolerance()).ok() } else { None };
        if flat && span.is_none_or(|span| span.dimension() != answer.dimension) {
            return refined;
        }
        let Some(problem) = Problem::new(set, q, span, &answer.direction) else { return refined };
        let Some(mut best) = problem.search(&answer.direction, answer.upper) else { return refined };
        if let Some(rival) = answer.rival {
            // Is it still one? What is not settled counts as a tie.
            let slack = best.ratio * T::count(1 << 20) * T::ROUNDOFF;
            match problem.search(&rival, T::HUGE) {
                Some(other) if other.ratio > best.ratio + slack => refined.answer.rival = None,
                Some(other) if norm(&(other.u - best.u)) <= T::ROUNDOFF.root() => refined.answer.rival = None,
                Some(other) if other.ratio < best.ratio - slack => {
                    best = other;
                    refined.answer.rival = None;
                }
                _ => {}
            }
        }
        refined.answer.rival = refined.answer.rival.or_else(|| problem.mirror_image(&best.u));
        refined.kink = match refined.answer.rival {
            Some(_) => Some(Kink::Rival),
            None if !best.sharp => Some(Kink::Gauge),
            None => None,
        };
        problem.conclude(&best, &mut refined.answer);
        refined.ties = best.ties;
        refined
    }

    /// The set that the answer is about.
    pub fn set(&self) -> &WrenchSet<'a, T> {
        &self.set
    }

    /// What contribution `index` carries at the minimum; `None` where there is a [`kink`](Self::kink) or no such contribution.
    pub fn share(&self, index: usize) -> Option<Share<T>> {
        if self.kink.is_some() {
            return None;
        }
        let part = Part::new(self.set.contributions().get(index)?, &self.answer.direction);
        let own = |tie: &&Tie<T>| tie.kind == Kind::Weight(index);
        let weight = match (self.ties.iter().find(own), self.set.norm()) {
            (Some(tie), _) => tie.multiplier,
            (None, Norm::LInf) if part.value > T::zero() => T::one(),
            (None, _) => T::zero(),
        };
        let friction = tip(&self.ties, index).map_or(part.x, |y| y / weight);
        Some(Share { weight, friction })
    }
}

/// λ x of a contact at its tip; `None`: it is not.
fn tip<T: Real>(ties: &[Tie<T>], index: usize) -> Option<Vector<T, 3>> {
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

/// One primitive at u.
struct Part<T> {
    /// h_i(u); -HUGE: empty.
    value: T,
    /// |D^T u|, and as a share of |D|.
    length: T,
    sharpness: T,
    x: Vector<T, 3>,
    gradient: Vector6<T>,
}

impl<T: Real> Part<T> {
    fn new(primitive: &Primitive<T>, u: &Vector6<T>) -> Self {
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
    fn hessian(&self, primitive: &Primitive<T>) -> Matrix6<T> {
        if !(self.length > T::zero()) {
            return Matrix6::zeros();
        }
        let disc = primitive.disc();
        let along = disc * self.x;
        (disc * disc.transpose() - along * along.transpose()) / self.length
    }
}

/// Where Newton's method stands.
struct Iterate<T> {
    u: Vector6<T>,
    d: T,
    ties: Ties<T>,
}

/// The problem in units of its own size: W divided by `size`, Q by `gauge`.
struct Problem<'p, 'a, T> {
    set: &'p WrenchSet<'a, T>,
    q: &'p dyn Gauge<T, 6>,
    /// The projection onto the span of W.
    projector: Matrix6<T>,
    span: Option<Subspace<T>>,
    size: T,
    gauge: T,
}

impl<'p, 'a, T: Real> Problem<'p, 'a, T> {
    fn new(
        set: &'p WrenchSet<'a, T>,
        q: &'p dyn Gauge<T, 6>,
        span: Option<Subspace<T>>,
        near: &Vector6<T>,
    ) -> Option<Self> {
        let projector = span.as_ref().map_or(Matrix6::identity(), |span| {
            span.basis().iter().fold(Matrix6::zeros(), |sum, axis| {
                let axis = Vector::from(*axis);
                sum + axis * axis.transpose()
            })
        });
        let (size, gauge) = (set.extent(), norm(&q.mapping(near)?));
        let usable = size > T::zero() && size.finite() && gauge > T::zero() && gauge.finite();
        usable.then_some(Self { set, q, projector, span, size, gauge })
    }

    /// The projection of s_Q(u).
    fn mapping(&self, u: &Vector6<T>) -> Option<Vector6<T>> {
        let point = self.projector * self.q.mapping(u)? / self.gauge;
        finite(&point).then_some(point)
    }

    fn step() -> T {
        T::ROUNDOFF.root().root()
    }

    /// The Hessian of h_Q in the span, by central differences.
    fn gauge_hessian(&self, u: &Vector6<T>) -> Option<Matrix6<T>> {
        let h = Self::step();
        let mut hessian = Matrix6::zeros();
        for i in 0..6 {
            let axis: Vector6<T> = self.projector.column(i).into_owned();
            if axis.iter().all(|x| x.is_zero()) {
                continue;
            }
            let change = self.mapping(&(u + axis * h))? - self.mapping(&(u - axis * h))?;
            hessian.set_column(i, &(change / (h + h)));
        }
        let symmetric = (hessian + hessian.transpose()) * T::of(0.5);
        // The differences of a polytope that steps from one vertex to the next are no derivatives.
        Some(if self.q.vertex_count() > 0 { Matrix6::zeros() } else { symmetric })
    }

    /// Another minimiser, where W and Q are their own mirror images and u is not. (The solver looks at one of them.)
    fn mirror_image(&self, u: &Vector6<T>) -> Option<Vector6<T>> {
        let image = |bits: u8| Vector6::from_fn(|i, _| if bits >> i & 1 == 1 { -u[i] } else { u[i] });
        let differs = |bits: &u8| norm(&(image(*bits) - u)) > T::ROUNDOFF.root();
        let is_image = |bits: &u8| self.q.mirrored(*bits) && self.set.mirrored(*bits);
        (1..64).filter(differs).find(is_image).map(image)
    }

    /// Does one point of Q alone attain h_Q near u?
    fn is_sharp(&self, u: &Vector6<T>) -> bool {
        let h = T::ROUNDOFF.root();
        let still = |axis: Vector6<T>| {
            let ends = (self.mapping(&(u + axis * h)), self.mapping(&(u - axis * h)));
            // A smooth Q moves by h times its Hessian, a polytope jumps by a good part of its size.
            matches!(ends, (Some(a), Some(b)) if norm(&(a - b)) <= T::of(1e-2))
        };
        (0..6).all(|i| still(self.projector.column(i).into_owned()))
    }

    /// h_W(u) / h_Q(u), and h_Q(u), in the caller's units.
    fn ratio(&self, u: &Vector6<T>) -> Option<(T, T)> {
        let gauge = self.q.value(u).ok()?;
        let ratio = self.set.value(u) / gauge;
        (gauge > T::zero() && ratio.finite()).then_some((ratio, gauge))
    }

    /// The minimum near a direction that bounds d by `limit`; after some polar iterations if the direction is too coarse.
    fn search(&self, near: &Vector6<T>, limit: T) -> Option<Minimum<T>> {
        self.minimum(near, limit).or_else(|| self.minimum(&self.sharpened(near)?, limit))
    }

    fn sharpened(&self, near: &Vector6<T>) -> Option<Vector6<T>> {
        if self.span.is_some() {
            return None;
        }
        let options = Options { relative: T::ROUNDOFF.root(), ..Options::default() };
        let (mut query, checked) = Query::new(self.set, self.q, T::zero(), options);
        checked.and_then(|()| query.normalize()).ok()?;
        query.support(near).ok()?;
        descend(&mut query, near).ok()?;
        Some(query.direction)
    }

    /// The minimum that Newton's method finds from here.
    fn minimum(&self, near: &Vector6<T>, limit: T) -> Option<Minimum<T>> {
        let slack = T::one() + T::count(1 << 8) * T::ROUNDOFF;
        let limit = limit.at_most(self.ratio(near)?.0) * slack;
        let mut zero = T::of(0.3);
        let mut tried = usize::MAX;
        while zero > T::ROUNDOFF {
            let mut guess = self.guess(near, zero);
            zero *= T::of(0.4);
            // A wider zero has more equations: as many are the same.
            let count = guess.as_ref().map_or(usize::MAX, |ties| ties.len());
            if count == tried {
                continue;
            }
            tried = count;
            for _ in 0..CORRECTIONS {
                let Some(ties) = guess.take() else { break };
                match self.balanced(near, ties, limit) {
                    Ok(minimum) => return Some(minimum),
                    Err(better) => guess = better,
                }
            }
        }
        None
    }

    /// The minimum that has these ties; otherwise the ties without those that want to be inequalities.
    fn balanced(&self, near: &Vector6<T>, ties: Ties<T>, limit: T) -> Result<Minimum<T>, Option<Ties<T>>> {
        let start = |weight: T| {
            let mut ties = ties.clone();
            for tie in &mut ties {
                tie.multiplier = if let Kind::Weight(_) = tie.kind { weight } else { T::zero() };
            }
            self.newton(near, ties)
        };
        let mut at = start(T::of(0.5)).ok_or(None)?;
        if self.has_squeeze(&ties)
            && let Some(other) = start(T::of(0.75))
        {
            at.ties = Self::squeezed(&at.ties, &other.ties);
        }
        self.verified(&at, limit)
    }

    /// Newton's method keeps what there is of a free squeeze: two of its ends make the line of all balances. On it, the one that is
    /// farthest inside of all inequalities, whose least distance is concave.
    fn squeezed(one: &Ties<T>, other: &Ties<T>) -> Ties<T> {
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

    /// The equations that hold near u when `zero` counts as zero.
    fn guess(&self, u: &Vector6<T>, zero: T) -> Option<Ties<T>> {
        let mut ties = Vec::new();
        let mut tie = |kind, along, unit| ties.push(Tie { kind, along, multiplier: T::zero(), unit }).is_ok();
        if let Some(span) = &self.span {
            for axis in Self::outside(span) {
                if !tie(Kind::Flat, axis, T::one()) {
                    return None;
                }
            }
        }
        let best = self.set.value(u);
        for (index, primitive) in self.set.contributions().iter().enumerate() {
            let part = Part::new(primitive, u);
            let room = zero * (norm(primitive.center()) + frobenius(primitive.disc()));
            let (weighed, loaded) = match self.set.norm() {
                Norm::LInf => (part.value.abs() <= room, part.value >= -room),
                Norm::L1 => (part.value >= best - room, part.value >= best - room),
            };
            if primitive.is_empty() || !loaded {
                continue;
            }
            if weighed && !tie(Kind::Weight(index), Vector::zeros(), T::one()) {
                return None;
            }
            if part.sharpness <= zero {
                for column in 0..3 {
                    let radius: Vector6<T> = primitive.disc().column(column).into_owned();
                    let length = norm(&radius);
                    let kind = Kind::Tip(index, column);
                    if length > T::zero() && !tie(kind, unit(&radius), self.size / length) {
                        return None;
                    }
                }
            }
        }
        Some(ties)
    }

    /// An orthonormal basis of the complement of the span.
    fn outside(span: &Subspace<T>) -> impl Iterator<Item = Vector6<T>> + '_ {
        span.complement().iter().map(|axis| Vector::from(*axis))
    }

    fn is_tip(ties: &[Tie<T>], index: usize) -> bool {
        ties.iter().any(|tie| matches!(tie.kind, Kind::Tip(i, _) if i == index))
    }

    fn is_weighed(ties: &[Tie<T>], index: usize) -> bool {
        ties.iter().any(|tie| tie.kind == Kind::Weight(index))
    }

    /// The left side less the right side of the balance at an iterate, its derivative with respect to u, and of each
    /// equation the gradient and the residual.
    #[allow(clippy::type_complexity)]
    fn equations(&self, at: &Iterate<T>) -> Option<(Vector6<T>, Matrix6<T>, Vec<(Vector6<T>, T), TIES>, Vector6<T>)> {
        let share = self.mapping(&at.u)?;
        let mut balance = share * -at.d;
        let mut hessian = self.gauge_hessian(&at.u)? * -at.d;
        let level = at.d * share.dot(&at.u);
        let mut rows = Vec::new();
        for tie in &at.ties {
            let row = match tie.kind {
                Kind::Weight(index) => {
                    let primitive = self.set.contributions().get(index)?;
                    let part = Part::new(primitive, &at.u);
                    let smooth = !Self::is_tip(&at.ties, index);
                    let gradient = if smooth { part.gradient } else { *primitive.center() } / self.size;
                    if smooth {
                        hessian += part.hessian(primitive) * (tie.multiplier / self.size);
                    }
                    let l1 = if self.set.norm() == Norm::L1 { level } else { T::zero() };
                    (gradient, gradient.dot(&at.u) - l1)
                }
                Kind::Tip(..) | Kind::Flat => (tie.along, tie.along.dot(&at.u)),
            };
            balance += row.0 * tie.multiplier;
            rows.push(row).ok()?;
        }
        if self.set.norm() == Norm::LInf {
            for (index, primitive) in self.set.contributions().iter().enumerate() {
                let part = Part::new(primitive, &at.u);
                if !(part.value > T::zero()) || Self::is_weighed(&at.ties, index) {
                    continue;
                }
                if Self::is_tip(&at.ties, index) {
                    balance += primitive.center() / self.size;
                } else {
                    balance += part.gradient / self.size;
                    hessian += part.hessian(primitive) / self.size;
                }
            }
        }
        Some((balance, hessian, rows, share))
    }

    /// Newton's method for u, d and the multipliers, in the plane u . near = 1.
    fn newton(&self, near: &Vector6<T>, ties: Ties<T>) -> Option<Iterate<T>> {
        let (ratio, _) = self.ratio(near)?;
        let mut at = Iterate { u: *near, d: ratio / self.size * self.gauge, ties };
        let l1 = self.set.norm() == Norm::L1;
        let mut last = false;
        for _ in 0..STEPS {
            let (balance, hessian, rows, share) = self.equations(&at)?;
            let mut a = [[T::zero(); SIZE + 1]; SIZE];
            for (i, row) in a.iter_mut().enumerate().skip(7 + rows.len()) {
                *row.get_mut(i)? = T::one();
            }
            for i in 0..6 {
                for j in 0..6 {
                    a[i][j] = hessian[(i, j)];
                }
                a[i][6] = -share[i];
                a[6][i] = near[i];
                a[i][SIZE] = -balance[i];
                for (k, (gradient, _)) in rows.iter().enumerate() {
                    *a[i].get_mut(7 + k)? = gradient[i];
                }
            }
            for (k, ((gradient, residual), tie)) in rows.iter().zip(&at.ties).enumerate() {
                let level = l1 && matches!(tie.kind, Kind::Weight(_));
                let row = a.get_mut(7 + k)?;
                for i in 0..6 {
                    row[i] = if level { gradient[i] - at.d * share[i] } else { gradient[i] };
                }
                row[6] = if level { -share.dot(&at.u) } else { T::zero() };
                // Where multipliers are not unique the step changes them least (proximal method of multipliers).
                *row.get_mut(7 + k)? = -T::ROUNDOFF.root();
                row[SIZE] = -*residual;
            }
            let step = eliminated(a)?;
            let change = Vector6::from_fn(|i, _| step[i]);
            let length = norm(&change);
            if !length.finite() {
                return None;
            }
            let limit = T::of(0.3);
            let damped = if length > limit { limit / length } else { T::one() };
            at.u += change * damped;
            at.d += step[6] * damped;
            for (tie, x) in at.ties.iter_mut().zip(step.iter().skip(7)) {
                tie.multiplier += *x * damped;
            }
            if last {
                return Some(at);
            }
            last = length <= T::ROUNDOFF.root();
        }
        None
    }

    /// The minimum, if it is one with strict inequalities; otherwise the equations without those that want to be
    /// inequalities.
    fn verified(&self, at: &Iterate<T>, limit: T) -> Result<Minimum<T>, Option<Ties<T>>> {
        let strict = T::ROUNDOFF.root();
        let l1 = self.set.norm() == Norm::L1;
        let (zero, one) = (T::zero(), T::one());
        let weight =
            |index: usize| at.ties.iter().find(|tie| tie.kind == Kind::Weight(index)).map_or(one, |tie| tie.multiplier);
        let overdrawn = |index: usize| {
            let y = tip(&at.ties, index);
            y.is_some_and(|y| !(norm(&y) < weight(index) * (one - strict)))
        };
        let bad = |tie: &Tie<T>| match tie.kind {
            Kind::Weight(_) if l1 => !(tie.multiplier > strict),
            Kind::Weight(_) => !(tie.multiplier > strict && tie.multiplier < one - strict),
            Kind::Tip(index, _) => overdrawn(index),
            Kind::Flat => false,
        };
        if at.ties.iter().any(bad) {
            let mut rest = Vec::new();
            let freed = |tie: &Tie<T>| {
                matches!(tie.kind, Kind::Weight(i) | Kind::Tip(i, _)
                if at.ties.iter().any(|other| other.kind == Kind::Weight(i) && bad(other) && !(other.multiplier > strict)))
            };
            for tie in at.ties.iter().filter(|tie| !bad(tie) && !freed(tie)) {
                let _ = rest
                    .push(Tie { multiplier: if let Kind::Weight(_) = tie.kind { T::of(0.5) } else { zero }, ..*tie });
            }
            return Err(Some(rest));
        }
        let u = unit(&at.u);
        let (ratio, _) = self.ratio(&u).ok_or(None)?;
        if !(ratio <= limit) {
            return Err(None);
        }
        let best = self.set.value(&u);
        let mut support = Vector6::zeros();
        for (index, primitive) in self.set.contributions().iter().enumerate() {
            if primitive.is_empty() {
                continue;
            }
            let part = Part::new(primitive, &u);
            let room = strict * (norm(primitive.center()) + frobenius(primitive.disc()));
            let weighed = Self::is_weighed(&at.ties, index);
            let off = if l1 { part.value < best - room } else { part.value < -room };
            if off && !weighed {
                continue;
            }
            let loaded = weighed || !l1 && part.value > room;
            let tip = tip(&at.ties, index);
            if !loaded || tip.is_none() && !(part.sharpness > strict) {
                return Err(None);
            }
            let weight = weight(index);
            support += primitive.center() * weight + primitive.disc() * tip.unwrap_or(part.x * weight);
        }
        let at = Iterate { u, d: at.d, ties: at.ties.clone() };
        if !self.grows(&at).unwrap_or(false) {
            return Err(None);
        }
        Ok(Minimum { u, ratio, ties: at.ties, support, sharp: self.is_sharp(&u) })
    }

    /// Are there two hard contacts at rest, h_i(u) = 0 at a tip? Then u turns about the line through both; a squeeze along it
    /// balances itself, and how much of it there is does not matter: no change of theirs does work on it.
    fn has_squeeze(&self, ties: &[Tie<T>]) -> bool {
        let columns = |index: usize| ties.iter().filter(|t| matches!(t.kind, Kind::Tip(i, _) if i == index)).count();
        let at_rest = |tie: &&Tie<T>| matches!(tie.kind, Kind::Weight(index) if columns(index) == 2);
        self.set.norm() == Norm::LInf && ties.iter().filter(at_rest).count() == 2
    }

    /// The second-order condition: with P the projection on the directions that the equations, and the length of u, leave
    /// free, P H P is positive on them.
    fn grows(&self, at: &Iterate<T>) -> Option<bool> {
        let (_, hessian, rows, share) = self.equations(at)?;
        let l1 = self.set.norm() == Norm::L1;
        let mut free = Matrix6::identity() - at.u * at.u.transpose();
        let mut rank = 0;
        for ((gradient, _), tie) in rows.iter().zip(&at.ties) {
            let level = l1 && matches!(tie.kind, Kind::Weight(_));
            let rest = free * if level { gradient - share * at.d } else { *gradient };
            if norm(&rest) > T::ROUNDOFF.root() * norm(gradient) {
                let rest = unit(&rest);
                free -= rest * rest.transpose();
                rank += 1;
            }
        }
        // For L1 the balance itself is a combination of the gradients that vanishes; else only a squeeze between two
        // hard contacts at rest may be one.
        let excess = rows.len().checked_sub(rank + usize::from(l1))?;
        if excess > usize::from(self.has_squeeze(&at.ties)) {
            return Some(false);
        }
        let curved = free * hessian * free;
        let scale = curved.trace();
        let mut m = curved + (Matrix6::identity() - free) * scale.abs().at_least(T::one());
        let floor = scale.abs() * T::ROUNDOFF.root();
        for k in 0..6 {
            let pivot = m[(k, k)];
            if !(pivot > floor) {
                return Some(false);
            }
            for i in 0..6 {
                if i > k {
                    let factor = m[(i, k)] / pivot;
                    for j in 0..6 {
                        let x = m[(k, j)];
                        m[(i, j)] -= factor * x;
                    }
                }
            }
        }
        Some(true)
    }

    /// Writes the minimum into the answer.
    fn conclude(&self, minimum: &Minimum<T>, answer: &mut Answer<T, 6>) {
        let Ok(gauge) = self.q.value(&minimum.u) else { return };
        let bounds = Bounds { support_error: self.set.error(), radius: T::zero(), dimension: 6, unknown_extent: false };
        let height = self.set.value(&minimum.u);
        let upper = bounds.upper(height, bounds.margin(self.size), gauge, self.q.error());
        // What the span's basis is off by is not known here.
        if answer.dimension == 6 {
            answer.upper = answer.upper.at_most(upper.at_least(answer.lower));
        }
        answer.direction = minimum.u;
        answer.support = minimum.support;
        answer.gauge = gauge;
    }
}

/// The solution of 13 linear equations, Gauss and Jordan with complete pivoting; `None` when they are not regular.
fn eliminated<T: Real>(mut a: [[T; SIZE + 1]; SIZE]) -> Option<[T; SIZE]> {
    let (mut rows, mut columns) = ([true; SIZE], [true; SIZE]);
    let mut order = [(0, 0); SIZE];
    let mut first = T::zero();
    for place in &mut order {
        let (mut largest, mut at) = (T::zero(), (0, 0));
        for i in 0..SIZE {
            for j in 0..SIZE {
                if rows[i] && columns[j] && a[i][j].abs() > largest {
                    (largest, at) = (a[i][j].abs(), (i, j));
                }
            }
        }
        first = first.at_least(largest);
        if !(largest > first * T::count(1 << 6) * T::ROUNDOFF && largest.finite()) {
            return None;
        }
        let (row, column) = at;
        *rows.get_mut(row)? = false;
        *columns.get_mut(column)? = false;
        *place = at;
        let divisor = *a.get(row)?.get(column)?;
        let pivot = a.get(row)?.map(|x| x / divisor);
        for (i, other) in a.iter_mut().enumerate() {
            if i == row {
                *other = pivot;
            } else {
                let factor = *other.get(column)?;
                other.iter_mut().zip(&pivot).for_each(|(x, &p)| *x -= factor * p);
            }
        }
    }
    let mut x = [T::zero(); SIZE];
    for (row, column) in order {
        *x.get_mut(column)? = *a.get(row)?.get(SIZE)?;
    }
    Some(x)
}
