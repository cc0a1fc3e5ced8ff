//! A query from arguments to result: what the exported functions of one question do before and after they ask the solver.

use super::*;

/// The options as the solver knows them, and the deadline.
pub(super) fn convert<const N: usize>(options: In<qdist_options_f64>) -> Check<(Options<'static, f64, N>, Deadline)> {
    if options.is_null() {
        return Ok((Options::default(), Deadline::NEVER));
    }
    let options = options.version()?;
    let (absolute, relative) = (length(options.absolute)?, length(options.relative)?);
    if !(absolute > 0.0 || relative > 0.0) {
        return Err(QDIST_ERROR_ARGUMENT);
    }
    let threshold = if flag(options.use_threshold)? {
        finite(&[options.threshold])?;
        Some(options.threshold)
    } else {
        None
    };
    let guess = if flag(options.use_guess)? {
        let guess = first(&options.guess, N)?;
        finite(guess)?;
        Some(Vector::from_iterator(guess.iter().copied()))
    } else {
        None
    };
    let deadline = Deadline::new(options.interrupt, options.interrupt_user);
    let max_iterations = (options.max_iterations > 0).then_some(options.max_iterations);
    Ok((Options { absolute, relative, threshold, max_iterations, guess, interrupt: None }, deadline))
}

pub(super) fn conclude(outcome: Outcome) -> Check {
    if outcome == Outcome::SupportFailed { Err(QDIST_ERROR_CALLBACK) } else { Ok(()) }
}

/// The result for C; the third numbers of vectors in the plane are 0.
pub(super) fn from_depth<const N: usize>(depth: &Depth<f64, N>) -> qdist_depth_f64 {
    let vector = |v: &Vector<f64, N>| {
        let mut all = [0.0; 3];
        for (to, &x) in all.iter_mut().zip(&one_by_one(v)) {
            *to = x;
        }
        all
    };
    qdist_depth_f64 {
        struct_size: size_of::<qdist_depth_f64>() as u32,
        outcome: outcome(depth.outcome),
        lower: depth.lower,
        upper: depth.upper,
        normal: vector(&depth.normal),
        point_a: vector(&depth.point_a),
        point_b: vector(&depth.point_b),
        dimension: depth.dimension as u32,
        iterations: depth.iterations,
        support_calls: depth.support_calls,
        vertices_used: alone(&depth.vertices) as u32,
        facets_used: alone(&depth.facets) as u32,
        callback_code: code(depth.failure),
    }
}

pub(super) fn from_answer<const N: usize>(answer: &Answer<f64, N>, code: i32) -> qdist_result_f64 {
    let vector = |v: &Vector<f64, N>| padded(v.iter().copied());
    let mut result = qdist_result_f64 {
        struct_size: size_of::<qdist_result_f64>() as u32,
        outcome: outcome(answer.outcome),
        plan: plan(answer.plan),
        has_rival: u32::from(answer.rival.is_some()),
        lower: answer.lower,
        upper: answer.upper,
        direction: vector(&answer.direction),
        support: vector(&answer.support),
        unit: answer.unit,
        rival: answer.rival.as_ref().map_or([0.0; MAX_DIMENSION], vector),
        weights: [0.0; MAX_POINTS],
        points: [0.0; MAX_POINTS * MAX_DIMENSION],
        point_count: answer.witness.corners().len() as u32,
        dimension: answer.dimension as u32,
        iterations: answer.iterations,
        support_calls: answer.support_calls,
        vertices_used: answer.vertices as u32,
        facets_used: answer.facets as u32,
        cones: answer.cones,
        splits: answer.splits,
        callback_code: code,
    };
    for (to, corner) in result.weights.iter_mut().zip(answer.witness.corners()) {
        *to = corner.weight;
    }
    let coordinates = answer.witness.corners().iter().flat_map(|corner| corner.vertex.point.iter());
    for (to, &x) in result.points.iter_mut().zip(coordinates) {
        *to = x;
    }
    result
}

/// The answer of a result in dimension 6, without the evidence for `lower`: what there is to know about the minimiser.
#[cfg(feature = "grasp")]
pub(super) fn to_answer(result: &qdist_result_f64) -> Check<Answer<f64, 6>> {
    finite(&[result.lower, result.upper, result.unit])?;
    finite(&result.direction).and(finite(&result.support)).and(finite(&result.rival))?;
    let rival = flag(result.has_rival)?.then(|| Vector::from(result.rival));
    let mut answer = Answer::unknown();
    (answer.outcome, answer.lower, answer.upper) = (Outcome::Converged, result.lower, result.upper);
    (answer.direction, answer.support) = (Vector::from(result.direction), Vector::from(result.support));
    (answer.unit, answer.rival, answer.dimension) = (result.unit, rival, result.dimension as usize);
    (answer.iterations, answer.support_calls) = (result.iterations, result.support_calls);
    Ok(answer)
}

/// The arguments of a query of one set.
pub(super) struct Question {
    pub solver: Out<qdist_solver>,
    pub a: In<qdist_set_f64>,
    pub q: In<qdist_unit_f64>,
    pub options: In<qdist_options_f64>,
    pub result: Out<qdist_result_f64>,
}

impl Question {
    /// Checks the arguments for dimension `N` and has the solver asked. The answer, and the code of a callback that failed.
    #[inline(always)]
    pub fn ask<const N: usize>(
        &self,
        query: impl FnOnce(
            &mut Solver<'_, f64, N>,
            &CheckedSet<'_>,
            &dyn UnitSet<f64, N>,
            &Options<'_, f64, N>,
        ) -> Answer<f64, N>,
    ) -> Check<(Answer<f64, N>, i32)> {
        self.result.checked()?;
        let a = self.a.get()?;
        let mut solver = handle::open::<f64, N>(&self.solver)?;
        self.result.known()?;
        let a = CheckedSet::new::<N>(a)?;
        let (options, deadline) = convert::<N>(self.options)?;
        let q = CheckedUnit::new::<N>(&self.q)?;
        let answer = deadline.during(&options, |options| query(&mut solver, &a, q.unit(), options));
        overflow(answer.failure)?;
        let code = q.code(answer.failure);
        Ok((answer, code))
    }

    /// Writes the result.
    #[inline(always)]
    pub fn conclude<const N: usize>(&self, (answer, code): (Answer<f64, N>, i32)) -> Check {
        self.result.put_version(from_answer(&answer, code))?;
        conclude(answer.outcome)
    }

    /// `qdist_solve`
    #[inline(always)]
    pub fn solve<const N: usize>(&self) -> Check {
        self.conclude(self.ask::<N>(|solver, a, q, options| solver.solve(a, q, options))?)
    }
}
