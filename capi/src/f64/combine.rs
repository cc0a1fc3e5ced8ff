//! SETS MADE OF SETS
//!
//! Sum, difference, convex hull of the union, and linear image of sets of any dimension. The structs and the sets that they point to must outlive the
//! set that is made of them.

use super::*;
use qdist::internal::near_unit;
use qdist::support::{Difference, Join, Sum};

/// Two sets of the same dimension.
#[repr(C)]
pub struct qdist_pair_f64 {
    pub a: In<qdist_set_f64>,
    pub b: In<qdist_set_f64>,
    /// 2 to 6.
    pub dimension: u32,
}

/// The image of a set under x -> matrix * x + translation.
/// The set must state its extent, or QDIST_ERROR_ARGUMENT: without, the rounding of the map cannot be bounded.
#[repr(C)]
pub struct qdist_linear_f64 {
    pub set: In<qdist_set_f64>,
    /// Row-major, `rows` x `columns`; any matrix.
    pub matrix: In<f64>,
    /// The first `rows` numbers count.
    pub translation: [f64; 6],
    /// Dimension of the image, 2 to 6.
    pub rows: u32,
    /// Dimension of the set, 2 to 6.
    pub columns: u32,
}

/// Makes the Minkowski sum { x + y : x in a, y in b }.
///
/// Status: DIMENSION (pair->dimension), those of a set (pair->a, pair->b), NONFINITE (the sum of their sizes is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_sum_f64(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> qdist_status {
    status(pair.get().and_then(|p| in_dimension!(p.dimension, fill_pair::<SUM, N>(set, pair))))
}

/// Makes the Minkowski difference { x - y : x in a, y in b }: it contains the origin exactly where a and b overlap.
///
/// Status: as of qdist_set_sum.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_difference_f64(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> qdist_status {
    status(pair.get().and_then(|p| in_dimension!(p.dimension, fill_pair::<DIFFERENCE, N>(set, pair))))
}

/// Makes the join: the convex hull of the union of a and b. The smaller of the two radii is that of the set, the rest of the larger one becomes part
/// of the core. Both sets must state their extents, or QDIST_ERROR_ARGUMENT. (For bodies in poses see qdist_body_join.)
///
/// Status: DIMENSION (pair->dimension), those of a set (pair->a, pair->b), ARGUMENT (one does not state its extent).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_join_f64(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> qdist_status {
    status(pair.get().and_then(|p| in_dimension!(p.dimension, fill_pair::<JOIN, N>(set, pair))))
}

/// Makes the image of a set. A ball does not stay a ball: it becomes part of the core.
///
/// Status: DIMENSION (map->rows or columns), those of a set (map->set), ARGUMENT (it does not state its extent), NONFINITE (a number of matrix or
/// translation, or the image is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_linear_f64(set: Out<qdist_set_f64>, map: In<qdist_linear_f64>) -> qdist_status {
    status(map.get().and_then(|m| in_dimension!(m.rows, fill_linear::<N>(set, map))))
}

/// At least |v|.
fn norm(v: &[f64]) -> f64 {
    dot(v, v).root() * 1.000001
}

// ------------------------------------------------------------------------------------------------- pairs

/// What is made of two sets.
const SUM: u8 = 0;
const DIFFERENCE: u8 = 1;
const JOIN: u8 = 2;

struct Pair<const MADE: u8>;

impl<const MADE: u8> Pair<MADE> {
    /// Asks what is made of two sets of dimension `N`.
    #[inline(always)]
    fn ask<R, const N: usize>(a: CheckedSet<'_>, b: CheckedSet<'_>, ask: impl FnOnce(&dyn Support<f64, N>) -> R) -> R {
        match MADE {
            SUM => ask(&Sum::new(a, b)),
            DIFFERENCE => ask(&Difference::new(a, b)),
            _ => ask(&Join::new(a, b)),
        }
    }
}

impl<const MADE: u8, const N: usize> Answers<N> for Pair<MADE> {
    type Struct = qdist_pair_f64;
    fn farthest(pair: &qdist_pair_f64, u: &Vector<f64, N>, exhaustive: bool) -> Check<Vector<f64, N>> {
        let (a, b) = (CheckedSet::new::<N>(pair.a.get()?)?, CheckedSet::new::<N>(pair.b.get()?)?);
        let found = Self::ask(a, b, |set| if exhaustive { set.exhaustive(u).map(|(p, _)| p) } else { set.support(u) });
        found.map_err(|Failure(code)| code)
    }
    fn mirrored(pair: &qdist_pair_f64, signs: u8) -> bool {
        let stays = |set: &In<qdist_set_f64>| set.get().is_ok_and(|set| set.is_mirrored(signs));
        stays(&pair.a) && stays(&pair.b)
    }
}

fn fill_pair<const MADE: u8, const N: usize>(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> Check {
    set.checked()?;
    let (a, b) = (pair.get()?.a.get()?, pair.get()?.b.get()?);
    let known = a.extent > 0.0 && b.extent > 0.0;
    let stated = Pair::<MADE>::ask(CheckedSet::new::<N>(a)?, CheckedSet::new::<N>(b)?, |made: &dyn Support<f64, N>| {
        let extent = if known { made.extent() } else { 0.0 };
        qdist_set_f64 { extent, ..qdist_set_f64::stated_by(&made) }
    });
    if MADE == JOIN && !known {
        return Err(QDIST_ERROR_ARGUMENT);
    }
    // Sums of lengths that are legal may be too large.
    lengths([stated.radius, stated.extent, stated.error])?;
    set.put(qdist_set_f64 {
        support: support_of::<Pair<MADE>, N>(),
        exhaustive: if a.exhaustive.or(b.exhaustive).is_some() { exhaustive_of::<Pair<MADE>, N>() } else { None },
        mirrored: if a.mirrored.and(b.mirrored).is_some() { mirrored_of::<Pair<MADE>, N>() } else { None },
        user: pair.user(),
        ..stated
    })
}

// ------------------------------------------------------------------------------------------------- linear images

impl qdist_linear_f64 {
    fn matrix(&self) -> Check<&[f64]> {
        self.matrix.array(Some(dimension(self.rows)? * dimension(self.columns)?))
    }
}

struct Linear;

impl<const N: usize> Answers<N> for Linear {
    type Struct = qdist_linear_f64;
    fn farthest(map: &qdist_linear_f64, u: &Vector<f64, N>, exhaustive: bool) -> Check<Vector<f64, N>> {
        let (matrix, columns, set) = (map.matrix()?, dimension(map.columns)?, map.set.get()?);
        let mut w = [0.0; MAX_DIMENSION];
        for (row, &x) in matrix.chunks_exact(columns).zip(u) {
            for (w, &m) in w.iter_mut().zip(row) {
                *w += m * x;
            }
        }
        let mut w = near_unit(Vector::from(w));
        let squared = w.dot(&w);
        if !(squared > 0.0) {
            // A direction that the map loses: every point of the set is as far as any other.
            w.x = 1.0;
        }
        let mut x = Vector::<f64, MAX_DIMENSION>::from_element(f64::NAN);
        from_status(set.ask(first(w.as_slice(), columns)?, exhaustive, x.as_mut_slice()))?;
        if set.radius > 0.0 && squared > 0.0 {
            x += w * (set.radius / squared.root());
        }
        let rows = matrix.chunks_exact(columns).zip(&map.translation);
        Ok(leading(&padded(rows.map(|(row, t)| dot(row, x.as_slice()) + t))))
    }
}

fn fill_linear<const N: usize>(set: Out<qdist_set_f64>, map: In<qdist_linear_f64>) -> Check {
    set.checked()?;
    let linear = map.get()?;
    let (inner, columns) = (linear.set.get()?, dimension(linear.columns)?);
    inner.check(columns)?;
    let (matrix, shift) = (linear.matrix()?, first(&linear.translation, N)?);
    coordinates(matrix)?;
    coordinates(shift)?;
    let stretch = norm(matrix);
    // Without an extent, the rounding of an ill-conditioned map could not be bounded.
    if !(inner.extent > 0.0) {
        return Err(QDIST_ERROR_ARGUMENT);
    }
    let reach = length(stretch * (inner.extent + inner.radius) + norm(shift))?;
    let own = inner.stated_error(columns);
    // Both products, the unit vector for the ball term, the two sums: see `support::Linear`.
    let error = length((stretch * own + f64::count(4 * MAX_DIMENSION + 8) * f64::ROUNDOFF * reach) * 1.000001)?;
    set.put(qdist_set_f64 {
        support: support_of::<Linear, N>(),
        exhaustive: if inner.exhaustive.is_some() { exhaustive_of::<Linear, N>() } else { None },
        user: map.user(),
        extent: reach,
        error,
        dimension: linear.rows,
        contains_origin: (shift.iter().all(|&x| x == 0.0) && inner.knows_origin(columns)).into(),
        ..qdist_set_f64::ZERO
    })
}
