//! Looking for the pair of pieces with the greatest depth.
//!
//! There are tens of thousands of pairs and one of them matters. The pairs whose middle balls overlap most are starts. From a start the
//! search alternates: the best piece of B for this piece of A, then the best piece of A for that one, until nothing
//! improves. Most pairs end at a direction that bounded another pair, the others mostly in the solver's first steps, because it is asked
//! only whether they beat the best so far.

use super::piece::Piece;
use super::sigma::{Lever, Separation, selected};
use super::{Effort, Pieces};
use crate::query::Options;
use crate::scalar::Real;
use crate::solver::depth::body::Body;
use crate::solver::workspace::Workspace;
use crate::support::Points;
use nalgebra::{Isometry3, Matrix3, Vector3};

/// What is maximised over the pairs.
#[derive(Clone, Copy)]
pub(super) enum Goal<'q> {
    /// The depth.
    Disp,
    /// About what the depth bounds of the object norm; the bound itself is proved afterwards.
    SqrtSigma(&'q Lever),
}

/// A pair of pieces that was solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub a: usize,
    pub b: usize,
    /// The depth is not less.
    pub depth: f64,
    /// What the goal makes of it.
    pub value: f64,
    /// From A to B.
    pub normal: Vector3<f64>,
}

/// Enough for pieces: a run that needs more memory ends with a wider bracket.
pub(super) type Memory = Workspace<f64, 3, 512, 1024>;

/// A better pair must be better by this share: gains below it are left to the last refinement.
const GAIN: f64 = 1e-3;
/// With all effort, pairs whose value is this share of the best are tried for the object norm.
const RUNNER_UP: f64 = 0.8;
/// Balls whose travel is looked at, and cubes for each.
const TRAVELLERS: usize = 6;
const CUBES: usize = 3000;
/// Directions that are remembered.
const HINTS: usize = 8;
/// Alternations from one start.
const ROUNDS: usize = 6;

/// One query's search.
pub(super) struct PairSearch<'q> {
    a: &'q Pieces,
    b: &'q Pieces,
    memory: &'q mut Memory,
    rotation: Matrix3<f64>,
    translation: Vector3<f64>,
    goal: Goal<'q>,
    /// Middles of A's pieces in B's frame.
    placed: Vec<Vector3<f64>>,
    /// The pieces as the solver sees them, made when first used.
    shapes: [Vec<Option<Points<'q, f64, 3>>>; 2],
    /// Pairs that were looked at: what was not better then is not better later.
    seen: Vec<bool>,
    /// Times the best value: what a pair must look like to be solved.
    needed: f64,
    /// Pairs that may still be solved.
    budget: usize,
    /// Directions that bounded pairs, the latest first.
    hints: Vec<Vector3<f64>>,
    best: Option<Found>,
    /// Every pair that was solved for its depth.
    log: Vec<Found>,
}

impl<'q> PairSearch<'q> {
    pub fn new(memory: &'q mut Memory, a: &'q Pieces, b: &'q Pieces, pose: &Isometry3<f64>, goal: Goal<'q>) -> Self {
        let rotation = pose.rotation.to_rotation_matrix().into_inner();
        let translation = pose.translation.vector;
        let placed = a.pieces.iter().map(|piece| rotation * piece.middle + translation).collect();
        let shapes = [vec![None; a.pieces.len()], vec![None; b.pieces.len()]];
        let seen = vec![false; a.pieces.len() * b.pieces.len()];
        let (hints, log) = (Vec::with_capacity(HINTS), Vec::new());
        PairSearch {
            a,
            b,
            memory,
            rotation,
            translation,
            goal,
            placed,
            shapes,
            seen,
            needed: 1.0 + GAIN,
            budget: 0,
            hints,
            best: None,
            log,
        }
    }

    /// A bound of what rounding of the pose does to a point of either body: the conversion of the quaternion and the products
    /// with the rotation.
    fn margin(&self) -> f64 {
        64.0 * f64::ROUNDOFF * (self.a.surface.reach() + self.b.surface.reach() + self.translation.norm())
    }

    /// Runs the search of one level of effort on top of what is known.
    pub fn run(&mut self, effort: Effort) {
        match effort {
            Effort::Fast => self.climb_from(1, 150),
            Effort::Default => self.climb_from(4, 400),
            Effort::Heavy => {
                self.budget = usize::MAX;
                // The goal only guesses what a pair proves of the object norm: those that look a little worse are tried as well.
                if matches!(self.goal, Goal::SqrtSigma(_)) {
                    self.needed = RUNNER_UP;
                    self.seen.fill(false);
                }
                for a in 0..self.a.pieces.len() {
                    for b in 0..self.b.pieces.len() {
                        self.consider(a, b);
                    }
                }
            }
        }
    }

    /// The depth of the best pair to all digits.
    pub fn refined(&mut self) -> f64 {
        let Some(best) = self.best else { return 0.0 };
        let fine = self.solve(best.a, best.b, best.normal, Options { relative: 1e-9, ..Options::default() });
        self.best = fine.filter(|found| found.depth >= best.depth).or(self.best);
        (self.best.map_or(0.0, |best| best.depth) - self.margin()).max(0.0)
    }

    /// The shortest translation of A that parts the best pair. Two convex bodies are that pair, and no motion does with less.
    pub fn way_out(&self) -> Option<Vector3<f64>> {
        self.best.map(|best| best.normal * -best.depth)
    }

    /// The bound of the object norm that the best pairs prove.
    pub fn sqrt_sigma(&mut self, lever: &Lever, effort: Effort) -> f64 {
        let (pairs, cells) = match effort {
            Effort::Fast => (1, 96),
            Effort::Default => (2, 256),
            Effort::Heavy => (64, 20_000),
        };
        let mut best: f64 = 0.0;
        self.log.sort_by(|x, y| y.value.total_cmp(&x.value));
        for found in self.log.iter().take(pairs) {
            let into_a = |p| self.rotation.tr_mul(&(p - self.translation));
            let b = selected(&self.b.pieces[found.b].corners).map(into_a);
            best = best.max((found.depth - self.margin()) / lever.largest(found.a));
            if let Some(separation) = Separation::new(lever, found.a, b, self.margin()) {
                best = best.max(separation.bound(cells, best));
            }
        }
        best
    }

    /// The bound by the travel of A's most promising balls, where it is above `known`.
    pub fn travel(&self, known: f64) -> f64 {
        let k = |piece: usize| match self.goal {
            Goal::Disp => 1.0,
            Goal::SqrtSigma(lever) => lever.of_middle(piece),
        };
        let far = 2.0 * self.b.surface.reach();
        let mut stuck: Vec<_> = self
            .placed
            .iter()
            .zip(&self.a.pieces)
            .enumerate()
            .filter(|(_, (center, _))| center.norm() <= far)
            .map(|(a, (center, piece))| (self.b.surface.stuck(center, piece.inradius), a))
            .filter(|(depth, _)| *depth > 0.0)
            .collect();
        stuck.sort_by(|x, y| (y.0 / k(y.1)).total_cmp(&(x.0 / k(x.1))));
        stuck.iter().take(TRAVELLERS).fold(known, |best, &(depth, a)| {
            let (ball, enough, range) = (self.a.pieces[a].inradius, best * k(a), 4.0 * depth);
            let travel = self.b.surface.travel(&self.placed[a], ball, range, enough, CUBES);
            best.max((travel - self.margin()) / k(a))
        })
    }

    /// Climbs from the most promising pairs, no two with the same piece of B, and solves so many pairs at most.
    fn climb_from(&mut self, starts: usize, budget: usize) {
        self.budget = budget;
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for a in 0..self.a.pieces.len() {
            // The best partner of each piece.
            let scores = (0..self.b.pieces.len()).map(|b| (self.score(a, b), a, b));
            pairs.extend(scores.max_by(|x, y| x.0.total_cmp(&y.0)));
        }
        pairs.sort_by(|x, y| y.0.total_cmp(&x.0));
        let mut taken: Vec<usize> = Vec::new();
        for (_, a, b) in pairs {
            if taken.len() >= starts {
                break;
            }
            if !taken.contains(&b) {
                taken.push(b);
                self.climb(a, b);
            }
        }
    }

    fn climb(&mut self, mut a: usize, mut b: usize) {
        self.consider(a, b);
        for _ in 0..ROUNDS {
            let before = self.best.map(|best| best.value);
            for k in self.ordered(self.b.pieces.len(), |s, k| s.score(a, k)) {
                self.consider(a, k);
            }
            b = self.best.map_or(b, |best| best.b);
            for k in self.ordered(self.a.pieces.len(), |s, k| s.score(k, b)) {
                self.consider(k, b);
            }
            a = self.best.map_or(a, |best| best.a);
            if self.best.map(|best| best.value) == before {
                break;
            }
        }
    }

    fn ordered(&self, count: usize, score: impl Fn(&Self, usize) -> f64) -> Vec<usize> {
        let mut scored: Vec<_> = (0..count).map(|k| (score(self, k), k)).collect();
        scored.sort_by(|x, y| y.0.total_cmp(&x.0));
        scored.into_iter().map(|(_, k)| k).collect()
    }

    /// The depth of the balls about the middles.
    fn score(&self, a: usize, b: usize) -> f64 {
        let (p, q) = (&self.a.pieces[a], &self.b.pieces[b]);
        p.inradius + q.inradius - (self.placed[a] - q.middle).norm()
    }

    /// Solves a pair if it may be better than the best.
    fn consider(&mut self, a: usize, b: usize) {
        if self.budget == 0 || std::mem::replace(&mut self.seen[a * self.b.pieces.len() + b], true) {
            return;
        }
        let (p, q) = (&self.a.pieces[a], &self.b.pieces[b]);
        let ease = match self.goal {
            Goal::Disp => 1.0,
            Goal::SqrtSigma(lever) => lever.least(a),
        };
        let needed = self.best.map_or(0.0, |best| best.value * ease * self.needed);
        let apart = self.placed[a] - q.middle;
        if p.radius + q.radius - apart.norm() <= needed {
            return;
        }
        // Most pairs are no better along a direction that bounded another.
        let enough = self.best.map_or(0.0, |best| best.value * self.needed);
        if let Some(hint) = self.hints.iter().position(|u| self.value_along(p, q, u) <= enough) {
            self.hints[..=hint].rotate_right(1);
            return;
        }
        let guess = self.hints.first().map_or(-apart, |&u| u);
        self.budget -= 1;
        let options = Options { threshold: Some(needed), relative: 1e-2, ..Options::default() };
        match self.solve(a, b, guess, options) {
            Some(found) if found.depth >= needed && self.value_along(p, q, &found.normal) > enough => {}
            Some(found) => return self.remember(found.normal),
            None => return,
        }
        let Some(found) = self.solve(a, b, guess, Options { relative: 1e-3, ..Options::default() }) else { return };
        if found.value > 0.0 {
            self.log.push(found);
            self.best = self.best.filter(|best| best.value >= found.value).or(Some(found));
        }
        self.remember(found.normal);
    }

    /// What the goal makes of the depth along u: for the object norm by the corner of A that is farthest.
    fn value_along(&self, p: &Piece, q: &Piece, u: &Vector3<f64>) -> f64 {
        let local = self.rotation.tr_mul(u);
        let (height, corner) = p.farthest(&local);
        let depth = height + u.dot(&self.translation) + q.farthest(&-u).0;
        match self.goal {
            Goal::Disp => depth,
            Goal::SqrtSigma(lever) => depth / lever.along(&corner, &local),
        }
    }

    fn remember(&mut self, normal: Vector3<f64>) {
        self.hints.truncate(HINTS - 1);
        self.hints.insert(0, normal);
    }

    fn solve(&mut self, a: usize, b: usize, guess: Vector3<f64>, options: Options<f64, 3>) -> Option<Found> {
        let shape = |list: &mut Vec<Option<Points<'q, f64, 3>>>, pieces: &'q [Piece], k: usize| {
            let cached: &mut Option<_> = &mut list[k];
            if cached.is_none() {
                *cached = Points::new(&pieces[k].corners).ok();
            }
            *cached
        };
        let on_a = shape(&mut self.shapes[0], &self.a.pieces, a)?;
        let on_b = shape(&mut self.shapes[1], &self.b.pieces, b)?;
        let body = Body::new(&on_a, self.rotation, self.translation).ok()?;
        let guess = guess.iter().any(|&x| x != 0.0).then_some(guess);
        let other = Body::at(&on_b, Vector3::zeros());
        let depth = self.memory.solver().depth(&body, &other, &Options { guess, ..options });
        let value = match self.goal {
            Goal::Disp => depth.lower,
            Goal::SqrtSigma(lever) => {
                let x = self.rotation.tr_mul(&(depth.point_a - self.translation));
                depth.lower / lever.along(&x, &self.rotation.tr_mul(&depth.normal))
            }
        };
        Some(Found { a, b, depth: depth.lower, value, normal: depth.normal })
    }
}
