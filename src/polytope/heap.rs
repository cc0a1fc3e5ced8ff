//! The priority: which facet bounds d_Q(V) now (eq. 21).
//!
//! A binary min-heap of (key, facet) in borrowed memory. Facets die without telling the heap; an entry whose facet
//! is dead, or has been recycled under another key, is stale and is skipped when it surfaces. When the heap is full, the
//! stale entries are swept out; as many entries as there are facets are enough, but for ties between a facet and the one recycled in its place.

use super::{Facet, Index};
use crate::scalar::Real;

/// A facet and the key it had when it was pushed.
#[derive(Clone, Copy)]
pub struct Entry<T> {
    key: T,
    facet: Index,
}

impl<T: Real> Entry<T> {
    pub const EMPTY: Self = Entry { key: T::HUGE, facet: Index::MAX };

    fn is_valid<const N: usize>(&self, facets: &[Facet<T, N>]) -> bool {
        facets.get(usize::from(self.facet)).is_some_and(|f| f.is_live() && f.key == self.key)
    }
}

pub struct Heap<'a, T> {
    entries: &'a mut [Entry<T>],
    len: usize,
}

impl<'a, T: Real> Heap<'a, T> {
    pub fn new(entries: &'a mut [Entry<T>]) -> Self {
        Heap { entries, len: 0 }
    }

    pub fn memory(&mut self) -> &mut [Entry<T>] {
        self.entries
    }

    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Adds a live facet; `facets` tells stale entries apart when room must be made. False when there is none: a facet
    /// recycled under the key that it had before counts twice.
    pub fn push<const N: usize>(&mut self, key: T, facet: Index, facets: &[Facet<T, N>]) -> bool {
        if self.len == self.entries.len() {
            self.sweep(facets);
        }
        let entry = Entry { key, facet };
        let Some(last) = self.entries.get_mut(self.len) else { return false };
        *last = entry;
        self.len += 1;
        self.sift_up(self.len - 1, entry);
        true
    }

    /// Removes and returns the live facet with the smallest key.
    pub fn pop<const N: usize>(&mut self, facets: &[Facet<T, N>]) -> Option<(T, Index)> {
        while self.len > 0 {
            let top = *self.entries.first()?;
            self.len -= 1;
            let last = *self.entries.get(self.len)?;
            self.sift_down(0, last);
            if top.is_valid(facets) {
                return Some((top.key, top.facet));
            }
        }
        None
    }

    fn sift_up(&mut self, mut hole: usize, entry: Entry<T>) {
        while hole > 0 {
            let parent = (hole - 1) / 2;
            let Some(&above) = self.entries.get(parent) else { return };
            if above.key <= entry.key {
                break;
            }
            self.set(hole, above);
            hole = parent;
        }
        self.set(hole, entry);
    }

    fn sift_down(&mut self, mut hole: usize, entry: Entry<T>) {
        let len = self.len;
        loop {
            let (left, right) = (2 * hole + 1, 2 * hole + 2);
            let Some(&first) = self.entries.get(left).filter(|_| left < len) else { break };
            let (at, child) = match self.entries.get(right) {
                Some(&second) if right < len && second.key < first.key => (right, second),
                _ => (left, first),
            };
            if entry.key <= child.key {
                break;
            }
            self.set(hole, child);
            hole = at;
        }
        self.set(hole, entry);
    }

    fn set(&mut self, at: usize, entry: Entry<T>) {
        if let Some(slot) = self.entries.get_mut(at) {
            *slot = entry;
        }
    }

    /// Drops all stale entries and restores the heap order.
    fn sweep<const N: usize>(&mut self, facets: &[Facet<T, N>]) {
        let old = core::mem::replace(&mut self.len, 0);
        for i in 0..old {
            let Some(&entry) = self.entries.get(i) else { return };
            if entry.is_valid(facets) {
                // The write position never passes the read position.
                self.len += 1;
                self.sift_up(self.len - 1, entry);
            }
        }
    }
}
