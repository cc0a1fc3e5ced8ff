//! SETS MADE OF SETS
//!
//! Sum, difference, convex hull of the union, and linear image of sets of any dimension. The structs and the sets that they point to must outlive the
//! set that is made of them.

use super::*;

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
    status(fill_pair::<false>(set, pair))
}

/// Makes the Minkowski difference { x - y : x in a, y in b }: it contains the origin exactly where a and b overlap.
///
/// Status: as of qdist_set_sum.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_difference_f64(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> qdist_status {
    status(fill_pair::<true>(set, pair))
}

/// Makes the join: the convex hull of the union of a and b. The smaller of the two radii is that of the set, the rest of the larger one becomes part
/// of the core. Both sets must state their extents, or QDIST_ERROR_ARGUMENT. (For bodies in poses see qdist_body_join.)
///
/// Status: DIMENSION (pair->dimension), those of a set (pair->a, pair->b), ARGUMENT (one does not state its extent).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_join_f64(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> qdist_status {
    status(fill_join(set, pair))
}

/// Makes the image of a set. A ball does not stay a ball: it becomes part of the core.
///
/// Status: DIMENSION (map->rows or columns), those of a set (map->set), ARGUMENT (it does not state its extent), NONFINITE (a number of matrix or
/// translation, or the image is too large).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_linear_f64(set: Out<qdist_set_f64>, map: In<qdist_linear_f64>) -> qdist_status {
    status(fill_linear(set, map))
}

/// Asks a part for its point along `u`.
fn ask(set: &qdist_set_f64, u: &[f64], exhaustive: bool) -> Check<[f64; MAX_DIMENSION]> {
    let mut point = [f64::NAN; MAX_DIMENSION];
    match set.ask(u, exhaustive, &mut point) {
        0 => Ok(point),
        code => Err(code),
    }
}

/// At least |v|.
fn norm(v: &[f64]) -> f64 {
    dot(v, v).root() * 1.000001
}

// ------------------------------------------------------------------------------------------------- pairs

impl Dimensioned for qdist_pair_f64 {
    fn dimension(&self) -> Check<usize> {
        dimension(self.dimension)
    }
    /// Is it certain that a change of sign leaves both parts as they are?
    fn mirrored(&self, signs: u8) -> bool {
        let stays = |set: &In<qdist_set_f64>| set.get().is_ok_and(|set| set.is_mirrored(signs));
        stays(&self.a) && stays(&self.b)
    }
}

impl qdist_pair_f64 {
    /// Both sets, and their dimension.
    fn checked(&self) -> Check<(&qdist_set_f64, &qdist_set_f64, usize)> {
        let n = dimension(self.dimension)?;
        let (a, b) = (self.a.get()?, self.b.get()?);
        a.check(n)?;
        b.check(n)?;
        Ok((a, b, n))
    }

    /// The set that is made of the pair by `A`, with sizes still to be filled in.
    fn set<A: AnswersAny<Struct = Self>>(
        pair: In<Self>,
        a: &qdist_set_f64,
        b: &qdist_set_f64,
        n: usize,
    ) -> qdist_set_f64 {
        qdist_set_f64 {
            support: Some(support_any::<A, false>),
            exhaustive: if a.exhaustive.or(b.exhaustive).is_some() { Some(support_any::<A, true>) } else { None },
            mirrored: if a.mirrored.and(b.mirrored).is_some() { Some(mirrored_any::<Self>) } else { None },
            user: pair.user(),
            dimension: n as u32,
            ..qdist_set_f64::ZERO
        }
    }
}

/// Sum, or difference.
struct Sum<const DIFFERENCE: bool>;

impl<const DIFFERENCE: bool> AnswersAny for Sum<DIFFERENCE> {
    type Struct = qdist_pair_f64;
    /// x + sign * y, with x along the direction in `a` and y along sign * direction in `b`.
    fn farthest(pair: &qdist_pair_f64, u: &[f64], exhaustive: bool) -> Check<[f64; MAX_DIMENSION]> {
        let sign = if DIFFERENCE { -1.0 } else { 1.0 };
        let mut turned = [0.0; MAX_DIMENSION];
        for (to, &x) in turned.iter_mut().zip(u) {
            *to = sign * x;
        }
        let mut sum = ask(pair.a.get()?, u, exhaustive)?;
        let y = ask(pair.b.get()?, first(&turned, u.len())?, exhaustive)?;
        for (x, y) in sum.iter_mut().zip(&y) {
            *x += sign * y;
        }
        Ok(sum)
    }
}

fn fill_pair<const DIFFERENCE: bool>(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> Check {
    set.checked()?;
    let (a, b, n) = pair.get()?.checked()?;
    let known = a.extent > 0.0 && b.extent > 0.0;
    let extent = if known { (a.extent + b.extent) * 1.000001 } else { 0.0 };
    let made = qdist_set_f64 {
        radius: a.radius + b.radius,
        extent,
        error: ((a.stated_error(n) + b.stated_error(n)) * 1.000001 + 2.0 * f64::ROUNDOFF * extent).max(tiny()),
        contains_origin: (a.knows_origin(n) && b.knows_origin(n)).into(),
        ..qdist_pair_f64::set::<Sum<DIFFERENCE>>(pair, a, b, n)
    };
    // Sums of lengths that are legal may be too large.
    lengths([made.radius, made.extent, made.error])?;
    set.put(made)
}

struct Join;

impl AnswersAny for Join {
    type Struct = qdist_pair_f64;
    /// The farther of the points of `a` and `b`, the larger radius' excess put on.
    fn farthest(pair: &qdist_pair_f64, u: &[f64], exhaustive: bool) -> Check<[f64; MAX_DIMENSION]> {
        let (a, b) = (pair.a.get()?, pair.b.get()?);
        let (mut x, mut y) = (ask(a, u, exhaustive)?, ask(b, u, exhaustive)?);
        let (mut store, mut other) = ([0.0; MAX_DIMENSION], [0.0; MAX_DIMENSION]);
        let w = in_range(u, &mut store);
        let excess = a.radius - b.radius;
        if excess != 0.0 {
            let larger = if excess > 0.0 { &mut x } else { &mut y };
            let scale = excess.abs() / dot(w, w).root();
            for (x, &w) in larger.iter_mut().zip(w) {
                *x += scale * w;
            }
        }
        let mut between = x;
        for (x, y) in between.iter_mut().zip(&y) {
            *x -= y;
        }
        let apart = first(&between, u.len())?;
        if apart.iter().any(|x| !x.finite()) {
            // What a part said must not get lost behind what the other one said.
            Ok(between)
        } else if dot(w, in_range(apart, &mut other)) >= 0.0 {
            Ok(x)
        } else {
            Ok(y)
        }
    }
}

fn fill_join(set: Out<qdist_set_f64>, pair: In<qdist_pair_f64>) -> Check {
    set.checked()?;
    let (a, b, n) = pair.get()?.checked()?;
    if !(a.extent > 0.0 && b.extent > 0.0) {
        return Err(QDIST_ERROR_ARGUMENT);
    }
    let radius = a.radius.at_most(b.radius);
    let (beyond_a, beyond_b) = (a.radius - radius, b.radius - radius);
    let (beyond, extent) = (beyond_a + beyond_b, (a.extent + beyond_a).at_least(b.extent + beyond_b) * 1.000001);
    // As derived for `support::Join`.
    let put_on = if beyond > 0.0 { f64::count(n / 2 + 5) * beyond + extent } else { 0.0 };
    let rounding = (f64::count(n + 2) * (a.extent + b.extent + beyond) + put_on) * f64::ROUNDOFF;
    let error = a.stated_error(n).at_least(b.stated_error(n));
    set.put(qdist_set_f64 {
        radius,
        extent,
        error: ((error + rounding) * 1.000001).at_least(tiny()),
        contains_origin: (a.knows_origin(n) || b.knows_origin(n)).into(),
        ..qdist_pair_f64::set::<Join>(pair, a, b, n)
    })
}

// ------------------------------------------------------------------------------------------------- linear images

impl qdist_linear_f64 {
    fn matrix(&self) -> Check<&[f64]> {
        self.matrix.array(Some(dimension(self.rows)? * dimension(self.columns)?))
    }
}

struct Linear;

impl AnswersAny for Linear {
    type Struct = qdist_linear_f64;
    fn farthest(map: &qdist_linear_f64, u: &[f64], exhaustive: bool) -> Check<[f64; MAX_DIMENSION]> {
        let (matrix, columns) = (map.matrix()?, dimension(map.columns)?);
        let set = map.set.get()?;
        let mut w = [0.0; MAX_DIMENSION];
        for (row, &x) in matrix.chunks_exact(columns).zip(u) {
            for (w, &m) in w.iter_mut().zip(row) {
                *w += m * x;
            }
        }
        let mut store = [0.0; MAX_DIMENSION];
        let w = in_range(first(&w, columns)?, &mut store);
        let squared = dot(w, w);
        // A direction that the map loses: every point of the set is as far as any other.
        let axis = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        let w = if squared > 0.0 { w } else { first(&axis, columns)? };
        let mut x = ask(set, w, exhaustive)?;
        if set.radius > 0.0 && squared > 0.0 {
            let scale = set.radius / squared.root();
            for (x, &w) in x.iter_mut().zip(w) {
                *x += scale * w;
            }
        }
        let mut image = [0.0; MAX_DIMENSION];
        for ((to, row), t) in image.iter_mut().zip(matrix.chunks_exact(columns)).zip(&map.translation) {
            *to = dot(row, &x) + t;
        }
        Ok(image)
    }
}

fn fill_linear(set: Out<qdist_set_f64>, map: In<qdist_linear_f64>) -> Check {
    set.checked()?;
    let linear = map.get()?;
    let (inner, columns) = (linear.set.get()?, dimension(linear.columns)?);
    inner.check(columns)?;
    let (matrix, n) = (linear.matrix()?, dimension(linear.rows)?);
    let shift = first(&linear.translation, n)?;
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
        support: Some(support_any::<Linear, false>),
        exhaustive: if inner.exhaustive.is_some() { Some(support_any::<Linear, true>) } else { None },
        user: map.user(),
        extent: reach,
        error,
        dimension: linear.rows,
        contains_origin: (shift.iter().all(|&x| x == 0.0) && inner.knows_origin(columns)).into(),
        ..qdist_set_f64::ZERO
    })
}
