//! The adjacency of a large hull's vertices, in one array of words of 16 or 32 bits.
//!
//! ```text
//! word 0          number of seeds s
//! word 1          number of points n
//! words 2..       s seed vertices
//! then n words    where vertex i's list begins, in blocks from the start of the lists; all ones when it has none
//! then the lists  k, then k neighbours, filled up to a block
//! ```
//!
//! A block is 4 words of 16 bits, so that they reach far enough, or 1 word of 32 bits.
//! [`Solver::prepare_hull`](crate::Solver::prepare_hull) and [`prepare_hull`](crate::solver::prepare::prepare_hull) write it; it may be
//! kept in a file or in flash.

/// The most seeds: support vertices along the axes and the diagonals of a cube.
pub(crate) const SEEDS: usize = 14;
const HEADER: usize = 2;

mod sealed {
    pub trait Sealed {}
    impl Sealed for u16 {}
    impl Sealed for u32 {}
}

/// A word of a hull's graph: `u16`, or `u32` for hulls of more than 26,214 points.
pub trait Word: Copy + Eq + core::fmt::Debug + sealed::Sealed {
    /// No list, no point.
    const EMPTY: Self;
    /// Lists begin at multiples of so many words.
    const BLOCK: usize;
    /// Any so many points can be prepared. (As `u16`, up to 65,534 points if few enough of them are vertices of the hull.)
    const MAX_POINTS: usize;

    /// As a position.
    fn position(self) -> usize;
    /// A position or a count; `None` where it does not fit, or is [`EMPTY`](Self::EMPTY).
    fn from_position(position: usize) -> Option<Self>;
}

macro_rules! word {
    ($t:ident, $block:expr, $points:expr) => {
        impl Word for $t {
            const EMPTY: Self = $t::MAX;
            const BLOCK: usize = $block;
            const MAX_POINTS: usize = $points;

            #[inline(always)]
            fn position(self) -> usize {
                self as usize
            }
            #[inline(always)]
            fn from_position(position: usize) -> Option<Self> {
                $t::try_from(position).ok().filter(|&word| word != Self::EMPTY)
            }
        }
    };
}

// n points have at most 6 n - 12 neighbours, so at most (6 n - 12 + n BLOCK) / BLOCK blocks.
word!(u16, 4, 26_214);
word!(u32, 1, 1 << 27);
const _: () = assert!((6 + 4) * <u16 as Word>::MAX_POINTS - 12 < 4 * u16::MAX as usize);
const _: () = assert!(7 * <u32 as Word>::MAX_POINTS < u32::MAX as usize);

/// A number of `u16` that suffices for the graph of `count` points: a planar graph has at most 6 n - 12 directed edges.
#[must_use]
pub const fn graph_len(count: usize) -> usize {
    HEADER + SEEDS + 11 * count
}

/// A number of `u32` that suffices for the graph of `count` points.
#[must_use]
pub const fn large_graph_len(count: usize) -> usize {
    HEADER + SEEDS + 8 * count
}

/// The vertex graph of a 3-D hull, borrowed. Any content is safe to use: a reading outside of the words is an empty list, and what
/// a query spends on a graph is bounded by the number of points ([`Hull`](crate::support::Hull)).
#[derive(Clone, Copy, Debug)]
pub struct HullGraph<'a, W = u16> {
    seeds: &'a [W],
    starts: &'a [W],
    lists: &'a [W],
}

impl<'a, W: Word> HullGraph<'a, W> {
    /// Opens words that [`Solver::prepare_hull`](crate::Solver::prepare_hull) or
    /// [`prepare_hull`](crate::solver::prepare::prepare_hull) has written. `None` when they are too short to be that.
    #[must_use]
    pub fn from_words(words: &'a [W]) -> Option<Self> {
        let (header, rest) = words.split_at_checked(HEADER)?;
        let &[seeds, count] = header else { return None };
        let (seeds, rest) = rest.split_at_checked(seeds.position())?;
        let (starts, lists) = rest.split_at_checked(count.position())?;
        Some(HullGraph { seeds, starts, lists })
    }

    /// Vertices to start climbing from.
    #[inline]
    #[must_use]
    pub fn seeds(&self) -> &'a [W] {
        self.seeds
    }

    /// Vertices that share an edge with this one; empty for points inside the hull.
    #[inline]
    #[must_use]
    pub fn neighbors(&self, vertex: W) -> &'a [W] {
        let start = self.starts.get(vertex.position()).copied().unwrap_or(W::EMPTY);
        let list = W::BLOCK.checked_mul(start.position()).and_then(|start| self.lists.get(start..)).unwrap_or(&[]);
        match list.split_first() {
            Some((&count, rest)) => rest.get(..count.position()).unwrap_or(&[]),
            None => &[],
        }
    }
}

/// The same words while they are being written.
pub(crate) struct GraphWriter<'a, W> {
    pub seeds: &'a mut [W],
    pub starts: &'a mut [W],
    pub lists: &'a mut [W],
}

impl<'a, W: Word> GraphWriter<'a, W> {
    /// Lays out the words for so many seeds and points; `None` when they are too few.
    pub fn new(words: &'a mut [W], seeds: W, points: W) -> Option<Self> {
        let (header, rest) = words.split_at_mut_checked(HEADER)?;
        header.copy_from_slice(&[seeds, points]);
        let (seeds, rest) = rest.split_at_mut_checked(seeds.position())?;
        let (starts, lists) = rest.split_at_mut_checked(points.position())?;
        Some(GraphWriter { seeds, starts, lists })
    }
}
