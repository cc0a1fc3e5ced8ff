//! Cones of directions: the 2^N orthants, halved as often as needed, described by how they came about.
//!
//! A cone is { G c : c >= 0 }. Its generators, the columns of G, are those of an orthant at first (plus or minus the axes);
//! halving puts the midpoint of two generators in the place of one of them. G is never formed: a direction is brought from c to u = G c,
//! and a point from x to y = G^T x (so that c.y = u.x), halving by halving, each in two or three operations. Whatever they round, the
//! halves cover the whole: the cover is a matter of the description.
//!
//! # Rounding
//!
//! All generators have coordinates of one sign pattern that add up to 1 (in size). So |g|_1 = 1, |u|_1 = |c|_1, and
//! c.y is off u.x by at most one roundoff of |c|_1 max |x_i| <= sqrt(N) |u| |x| per halving, beside the rounding of the product.

use crate::math::Vector;
use crate::scalar::Real;
use heapless::Vec;

/// The most halvings of an orthant: an edge of it is at most sqrt(2) long, and one in fifteen halves the longest.
pub const MAX_SPLITS: usize = 192;

/// The midpoint of generators `kept` and `replaced` in the place of the latter.
#[derive(Clone, Copy)]
struct Split {
    kept: u8,
    replaced: u8,
    /// The other half is done.
    second: bool,
}

/// A cone, and its place in the depth-first order of all.
pub(crate) struct Cone<const N: usize> {
    /// Bit i: coordinate i is negative.
    orthant: u8,
    path: Vec<Split, MAX_SPLITS>,
}

impl<const N: usize> Cone<N> {
    pub const ORTHANTS: u8 = 1 << N;

    /// An orthant.
    pub fn new(orthant: u8) -> Self {
        Cone { orthant, path: Vec::new() }
    }

    /// The orthant that a direction lies in.
    pub fn orthant_of<T: Real>(u: &Vector<T, N>) -> u8 {
        (0..N).fold(0, |bits, i| if u[i] < T::zero() { bits | 1 << i } else { bits })
    }

    /// Halvings that led here.
    pub fn depth(&self) -> usize {
        self.path.len()
    }

    /// Is this a whole orthant?
    pub fn is_orthant(&self) -> bool {
        self.path.is_empty()
    }

    /// Signs of the orthant's coordinates.
    fn signed<T: Real>(&self, v: &Vector<T, N>) -> Vector<T, N> {
        let mut v = *v;
        for i in 0..N {
            if self.orthant >> i & 1 == 1 {
                v[i] = -v[i];
            }
        }
        v
    }

    /// u = G c.
    pub fn direction<T: Real>(&self, c: &Vector<T, N>) -> Vector<T, N> {
        let mut u = *c;
        for split in self.path.iter().rev() {
            let (i, j) = (usize::from(split.kept), usize::from(split.replaced));
            if i < N && j < N {
                let half = u[j] * T::of(0.5);
                u[i] += half;
                u[j] = half;
            }
        }
        self.signed(&u)
    }

    /// y = G^T x.
    pub fn coordinates<T: Real>(&self, x: &Vector<T, N>) -> Vector<T, N> {
        let mut y = self.signed(x);
        for split in &self.path {
            let (i, j) = (usize::from(split.kept), usize::from(split.replaced));
            if i < N && j < N {
                y[j] = (y[i] + y[j]) * T::of(0.5);
            }
        }
        y
    }

    /// x = G^-T y, up to rounding.
    pub fn point<T: Real>(&self, y: &Vector<T, N>) -> Vector<T, N> {
        let mut x = *y;
        for split in self.path.iter().rev() {
            let (i, j) = (usize::from(split.kept), usize::from(split.replaced));
            if i < N && j < N {
                x[j] = x[j] + x[j] - x[i];
            }
        }
        self.signed(&x)
    }

    /// Squared distances of the generators.
    pub fn squared_edges<T: Real>(&self) -> [[T; N]; N] {
        let mut generators = [Vector::<T, N>::zeros(); N];
        for i in 0..N {
            let mut axis = Vector::zeros();
            axis[i] = T::one();
            generators[i] = self.direction(&axis);
        }
        let mut edges = [[T::zero(); N]; N];
        for i in 0..N {
            for j in 0..N {
                let edge = generators[i] - generators[j];
                edges[i][j] = edge.dot(&edge);
            }
        }
        edges
    }

    /// Goes to the first half: the one nearer to generator i, of the pair (i, j). False when the path is full.
    pub fn split(&mut self, i: usize, j: usize) -> bool {
        self.path.push(Split { kept: i as u8, replaced: j as u8, second: false }).is_ok()
    }

    /// Goes to the next cone of this orthant; false when all are done.
    pub fn advance(&mut self) -> bool {
        while let Some(last) = self.path.last_mut() {
            if !last.second {
                (last.kept, last.replaced, last.second) = (last.replaced, last.kept, true);
                return true;
            }
            self.path.pop();
        }
        false
    }
}
