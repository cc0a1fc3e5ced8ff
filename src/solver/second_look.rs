//! A second look, where rounding has left an answer open.
//!
//! A query begins with what costs least: one margin for all directions, from what A says of its size. Where that ends it with `Precision`, `Touching`,
//! `Degenerate` or `Capacity`, two things may be known better, and the query is run once more if one of them is:
//!
//! * **A's extent**: stated bounds may be loose. 2 N support calls measure it (`Measured`).
//! * **Margins by direction** ([`bounds`](crate::bounds)): what is long and flat along the coordinate axes (a floor of a kilometre, in metres) is known much
//!   better across than along.
//!
//! Both brackets are true; the narrower one is the answer.

use crate::math::{Vector, unit};
use crate::query::answer::Answer;
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Failure, Measured, Support, is_worth_measuring, measuring_calls};

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The answer, or that of a second look. `run` puts the query to a set, for an answer worth having; it is told whether that is certain because A
    /// was measured.
    pub(crate) fn look_again(
        &mut self,
        answer: Answer<T, N>,
        a: &dyn Support<T, N>,
        options: &Options<'_, T, N>,
        run: impl FnOnce(&mut Self, &dyn Support<T, N>, Options<T, N>, &Vector<T, N>, bool) -> Option<Answer<T, N>>,
    ) -> Answer<T, N> {
        if !answer.outcome.is_inconclusive() {
            return answer;
        }
        let Some(options) = options.after(answer.iterations) else { return answer };
        let asks = is_worth_measuring(a, answer.reach());
        let measured = if asks { Measured::new(a) } else { None };
        let calls = answer.support_calls.saturating_add(if asks { measuring_calls::<N>() } else { 0 });
        let set = measured.as_ref().map_or(a, |measured| measured);
        match run(self, set, options, &answer.direction, measured.is_some()) {
            Some(second) => {
                let support_calls = second.support_calls.saturating_add(calls);
                Answer { support_calls, ..second }.or_wider(&answer)
            }
            None => Answer { support_calls: calls, ..answer },
        }
    }

    /// Makes a query ready for a second look, after an answer with this direction; false when it would show nothing new.
    pub(crate) fn sharpen(
        &self,
        query: &mut Query<'_, T, N>,
        checked: Result<(), Failure>,
        first: &Vector<T, N>,
        measured: bool,
    ) -> bool {
        // (A set of unknown extent says nothing by direction, and would be asked for its size once more.)
        let known = query.knows_extent() || measured;
        if !(known && checked.and_then(|()| query.normalize()).is_ok() && (query.look_by_direction() || measured)) {
            return false;
        }
        // What rounding tilts a normal by is little, but costs the length of a floor: it is asked along the axes as well.
        let along = first.map(|x| if x.abs() < T::of(1e-2) { T::zero() } else { x });
        let whole = along.iter().any(|&x| x != T::zero());
        !(query.axes.is_some() && whole) || query.support(&unit(&along)).is_ok()
    }
}
