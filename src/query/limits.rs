//! When a query must end: what it has done is counted, and the caller's limit and deadline are heeded.

use super::{Options, Query};
use crate::query::answer::Stop;
use crate::scalar::Real;

/// What was done, and what may be.
pub(super) struct Limits {
    /// Steps of all plans.
    pub iterations: u32,
    /// The most of them.
    pub most: u32,
    pub support_calls: u32,
    /// The limit that was reached: from then on nothing is added.
    pub stopped: Option<Stop>,
}

impl Limits {
    /// Nothing is done; so much is allowed with so many vertices of Q.
    pub fn new<T: Real, const N: usize>(options: &Options<'_, T, N>, vertices: usize) -> Self {
        Limits { iterations: 0, most: options.most(vertices), support_calls: 0, stopped: None }
    }
}

impl<T: Real, const N: usize> Query<'_, T, N> {
    /// Steps so far.
    pub fn iterations(&self) -> u32 {
        self.limits.iterations
    }

    /// Calls of A's support function so far.
    pub fn support_calls(&self) -> u32 {
        self.limits.support_calls
    }

    /// Calls that were made before the query.
    pub fn count_calls(&mut self, calls: u32) {
        self.limits.support_calls = self.limits.support_calls.saturating_add(calls);
    }

    /// The limit that has been reached.
    pub fn stopped(&self) -> Option<Stop> {
        self.limits.stopped
    }

    /// Has the caller set a limit?
    pub fn may_be_cut_short(&self) -> bool {
        self.options.max_iterations.is_some() || self.options.interrupt.is_some()
    }

    /// Counts an iteration; tells why there must be none when a limit is reached.
    pub fn exhausted(&mut self) -> Option<Stop> {
        if self.limits.stopped.is_none() && self.limits.iterations >= self.limits.most {
            self.limits.stopped = Some(Stop::Iterations);
        }
        if self.interrupted().is_some() {
            return self.limits.stopped;
        }
        self.limits.iterations = self.limits.iterations.saturating_add(1);
        None
    }

    /// Asks the caller, unless a limit has been reached; counts nothing.
    pub fn interrupted(&mut self) -> Option<Stop> {
        if self.limits.stopped.is_none() && self.options.interrupt.is_some_and(|interrupt| interrupt()) {
            self.limits.stopped = Some(Stop::Interrupted);
        }
        self.limits.stopped
    }
}
