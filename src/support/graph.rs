//! The adjacency of a large hull's vertices, in one array of 16-bit words.
//!
//! ```text
//! word 0          number of seeds s
//! word 1          number of points n
//! words 2..       s seed vertices
//! then n words    where vertex i's list begins, in blocks of 4 words from the start of the lists; EMPTY when it has none
//! then the lists  k, then k neighbours, filled up to a block
//! ```
//!
//! [`Solver::prepare_hull`](crate::Solver::prepare_hull) writes it; it may be kept in a file or in flash.

/// The most seeds: support vertices along the axes and the diagonals of a cube.
pub(crate) const SEEDS: usize = 14;
const HEADER: usize = 2;
pub(crate) const BLOCK: usize = 4;
pub(crate) const EMPTY: u16 = u16::MAX;

/// A number of words that suffices for the graph of `count` points: a planar graph has at most 6 n - 12 directed edges.
#[must_use]
pub const fn graph_len(count: usize) -> usize {
    HEADER + SEEDS + 11 * count
}

/// The vertex graph of a 3-D hull, borrowed. Any content is safe to use: a reading outside of the words is an empty list.
#[derive(Clone, Copy, Debug)]
pub struct HullGraph<'a> {
    seeds: &'a [u16],
    starts: &'a [u16],
    lists: &'a [u16],
}

impl<'a> HullGraph<'a> {
    /// Opens words that [`Solver::prepare_hull`](crate::Solver::prepare_hull) has written. `None` when they are too short to be that.
    #[must_use]
    pub fn from_words(words: &'a [u16]) -> Option<Self> {
        let (header, rest) = words.split_at_checked(HEADER)?;
        let &[seeds, count] = header else { return None };
        let (seeds, rest) = rest.split_at_checked(usize::from(seeds))?;
        let (starts, lists) = rest.split_at_checked(usize::from(count))?;
        Some(HullGraph { seeds, starts, lists })
    }

    /// Vertices to start climbing from.
    #[inline]
    #[must_use]
    pub fn seeds(&self) -> &'a [u16] {
        self.seeds
    }

    /// Vertices that share an edge with this one; empty for points inside the hull.
    #[inline]
    #[must_use]
    pub fn neighbors(&self, vertex: u16) -> &'a [u16] {
        let start = self.starts.get(usize::from(vertex)).copied().unwrap_or(EMPTY);
        let list = self.lists.get(BLOCK * usize::from(start)..).unwrap_or(&[]);
        match list.split_first() {
            Some((&count, rest)) => rest.get(..usize::from(count)).unwrap_or(&[]),
            None => &[],
        }
    }
}

/// The same words while they are being written.
pub(crate) struct GraphWriter<'a> {
    pub seeds: &'a mut [u16],
    pub starts: &'a mut [u16],
    pub lists: &'a mut [u16],
}

impl<'a> GraphWriter<'a> {
    /// Lays out the words for so many seeds and points; `None` when they are too few.
    pub fn new(words: &'a mut [u16], seeds: u16, points: u16) -> Option<Self> {
        let (header, rest) = words.split_at_mut_checked(HEADER)?;
        header.copy_from_slice(&[seeds, points]);
        let (seeds, rest) = rest.split_at_mut_checked(usize::from(seeds))?;
        let (starts, lists) = rest.split_at_mut_checked(usize::from(points))?;
        Some(GraphWriter { seeds, starts, lists })
    }
}
