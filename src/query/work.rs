//! How much a query has done. Plans that take turns are told by it when their turn is over.
//!
//! Work is counted, not timed: an answer must not depend on the machine. The unit is about a nanosecond of a desktop computer.

/// The work of a query in N dimensions, so far and allowed.
#[derive(Clone, Copy)]
pub(crate) struct Work<const N: usize> {
    done: u64,
    allowed: u64,
    /// What a value of Q costs, with so many vertices to look at.
    unit: u64,
}

impl<const N: usize> Work<N> {
    /// A support call, with the step of a ray that it belongs to.
    pub const STEP: u64 = 60 + 20 * N as u64;
    /// A facet that is made.
    pub const FACET: u64 = 30 + (N * N * N * N) as u64 / 8;

    /// Nothing is done, and everything allowed.
    pub fn new(vertices: usize) -> Self {
        Work { done: 0, allowed: u64::MAX, unit: vertices as u64 * N as u64 / 4 }
    }

    /// What a value of Q costs.
    pub fn unit(&self) -> u64 {
        self.unit
    }

    /// Counts work.
    #[inline(always)]
    pub fn add(&mut self, work: u64) {
        self.done = self.done.saturating_add(work);
    }

    /// Allows so much more; `u64::MAX`: everything.
    pub fn allow(&mut self, more: u64) {
        self.allowed = self.done.saturating_add(more);
    }

    /// How much more than was allowed has been done.
    pub fn surplus(&self) -> u64 {
        self.done.saturating_sub(self.allowed)
    }

    /// Is all work done that is allowed?
    #[inline(always)]
    pub fn is_over(&self) -> bool {
        self.done >= self.allowed && self.allowed < u64::MAX
    }
}
