//! The second look (module `solver::second_look`) at a pair, each body by itself; and the one in two words, where bodies overlap little.

use super::answer::Depth;
use super::fine::{Fine, Recorder, fine_error};
use super::pair::Pair;
use crate::qset::Ball;
use crate::query::Options;
use crate::query::answer::{Answer, Outcome};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Measured, Support, is_worth_measuring, measuring_calls};

impl<T: Real, const N: usize> Solver<'_, T, N> {
    /// The answer, or that of a second look where it is open.
    #[inline(always)]
    pub(super) fn conclude_pair(
        &mut self,
        pair: &Pair<'_, '_, T, N>,
        answer: &Answer<T, N>,
        options: &Options<'_, T, N>,
    ) -> Depth<T, N> {
        if !answer.outcome.is_inconclusive() {
            return Depth::new(answer, pair);
        }
        let second = self.look_again_at_pair(pair, answer, options);
        Depth::new(second.as_ref().unwrap_or(answer), pair)
    }

    /// A second look (module `second_look`), at each body by itself.
    #[cold]
    #[inline(never)]
    fn look_again_at_pair(
        &mut self,
        pair: &Pair<'_, '_, T, N>,
        answer: &Answer<T, N>,
        options: &Options<'_, T, N>,
    ) -> Option<Answer<T, N>> {
        let asks = [pair.a, pair.b].map(|body| is_worth_measuring(body.shape, T::zero()));
        let finer = answer.outcome == Outcome::Degenerate || pair.is_finer_along(&answer.direction);
        // (A normal in one word proves an upper bound to half a roundoff of the bodies' size: where that is too much, two do not help. Nor do they where what
        // two words leave open is.)
        let width = options.absolute.at_least(options.relative * answer.upper);
        let tellable = width >= pair.extent * (T::of(0.25) * T::ROUNDOFF) && width > fine_error(pair) * T::count(4);
        let shallow = tellable && is_shallow(answer) && Recorder::suits(pair);
        if !finer && !shallow && asks == [false; 2] {
            return None;
        }
        let (ball, options) = (Ball::unit(), &options.after(answer.iterations)?);
        let [a, b] = [(pair.a, asks[0]), (pair.b, asks[1])]
            .map(|(body, asks)| if asks { Measured::new(body.shape) } else { None });
        let measured = a.is_some() || b.is_some();
        let asked = asks.map(|asks| if asks { measuring_calls::<N>() } else { 0 });
        // Those of the body that was asked more often: the query's, which are both bodies', and those that measured it.
        let both = answer.support_calls.saturating_sub(pair.calls());
        let measuring = [pair.on_a.calls + asked[0], pair.on_b.calls + asked[1]];
        let total = |more: [u32; 2]| both.saturating_add((measuring[0] + more[0]).max(measuring[1] + more[1]));
        if !finer && !shallow && !measured {
            return Some(Answer { support_calls: total([0, 0]), ..answer.clone() });
        }
        let (a, b) = (pair.a.remade(a.as_ref()), pair.b.remade(b.as_ref()));
        let sharper = Pair::new(&a, &b).ok()?;
        let calls = total([sharper.on_a.calls, sharper.on_b.calls]);
        let recorder = (shallow && Recorder::suits(&sharper)).then(|| Recorder::new(&sharper));
        let set: &dyn Support<T, N> = recorder.as_ref().map_or(&sharper, |recorder| recorder);
        let (mut query, checked) = Pair::query(set, &ball, calls, options);
        let mut ready = (finer || measured) && self.sharpen(&mut query, checked, &answer.direction, measured);
        if !ready && recorder.is_some() {
            let checked;
            (query, checked) = Pair::query(set, &ball, calls, options);
            ready = checked.and_then(|()| query.normalize()).is_ok();
        }
        if !ready {
            return Some(Answer { support_calls: calls, ..answer.clone() });
        }
        let mut second = self.expand_apart(&mut query);
        match &recorder {
            // (A body that does not tell a point in two words after all has not failed: the first answer stands.)
            Some(_) if second.failure.is_some() => {
                return Some(Answer { support_calls: second.support_calls, ..answer.clone() });
            }
            Some(recorder) if is_shallow(&second) => {
                Fine::new(&mut self.polytope, &mut query, recorder).refine(&mut second);
            }
            _ => {}
        }
        Some(second.or_wider(answer))
    }
}

/// Was rounding the end of a query of bodies that overlap for certain?
pub(super) fn is_shallow<T: Real, const N: usize>(answer: &Answer<T, N>) -> bool {
    answer.outcome == Outcome::Precision && answer.lower > T::zero()
}
