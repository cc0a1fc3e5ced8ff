//! SETS MADE OF SETS
//!
//! Sum, difference, convex hull of the union, and linear image of sets of any dimension. The structs and the sets that they point to must outlive the
//! set that is made of them.

use super::super::generic::{
    MAX_DIMENSION, SupportFn, aligned, array, coordinates, dimension, dot, first, flag, in_range, is_mirrored, length,
    lengths, put, shared, tiny,
};
use super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_DIMENSION, QDIST_ERROR_NULL, qdist_status, status,
};
use super::sets::{qdist_set_f64, room};
use core::ffi::c_void;
use qdist::Real;

/// Two sets of the same dimension.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_pair_f64 {
    pub a: *const qdist_set_f64,
    pub b: *const qdist_set_f64,
    /// 2 to 6.
    pub dimension: u32,
}

/// The image of a set under x -> matrix * x + translation.
/// The set must state its extent, or QDIST_ERROR_ARGUMENT: without, the rounding of the map cannot be bounded.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_linear_f64 {
    pub set: *const qdist_set_f64,
    /// Row-major, `rows` x `columns`; any matrix.
    pub matrix: *const f64,
    /// The first `rows` numbers count.
    pub translation: [f64; 6],
    /// Dimension of the image, 2 to 6.
    pub rows: u32,
    /// Dimension of the set, 2 to 6.
    pub columns: u32,
}

/// Makes the Minkowski sum { x + y : x in a, y in b }.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_sum_f64(set: *mut qdist_set_f64, pair: *const qdist_pair_f64) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill_pair(set, pair, qdist_sum_support_f64, qdist_sum_exhaustive_f64) })
}

/// Makes the Minkowski difference { x - y : x in a, y in b }: it contains the origin exactly where a and b overlap.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_difference_f64(
    set: *mut qdist_set_f64,
    pair: *const qdist_pair_f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    status(unsafe { fill_pair(set, pair, qdist_difference_support_f64, qdist_difference_exhaustive_f64) })
}

/// Makes the join: the convex hull of the union of a and b. The smaller of the two radii is that of the set, the rest of the larger one becomes part
/// of the core. Both sets must state their extents, or QDIST_ERROR_ARGUMENT. (For bodies in poses see qdist_body_join.)
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_join_f64(set: *mut qdist_set_f64, pair: *const qdist_pair_f64) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller.
        let (a, b, n) = unsafe { parts(pair) }?;
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
        let made = qdist_set_f64 {
            support: Some(qdist_set_join_support_f64),
            exhaustive: a.exhaustive.or(b.exhaustive).map(|_| qdist_set_join_exhaustive_f64 as SupportFn<f64>),
            mirrored: a.mirrored.and(b.mirrored).and(Some(pair_mirrored)),
            user: pair.cast_mut().cast(),
            radius,
            extent,
            error: ((error + rounding) * 1.000001).at_least(tiny()),
            dimension: n as u32,
            contains_origin: (a.knows_origin(n) || b.knows_origin(n)).into(),
        };
        // SAFETY: checked.
        unsafe { put(set, made) };
        Ok(())
    };
    status(fill())
}

/// Makes the image of a set. A ball does not stay a ball: it becomes part of the core.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_linear_f64(set: *mut qdist_set_f64, map: *const qdist_linear_f64) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller.
        let (linear, inner, matrix) = unsafe {
            let linear = shared(map)?;
            (linear, part(linear.set, dimension(linear.columns)?)?, linear.matrix()?)
        };
        let n = dimension(linear.rows)?;
        let shift = first(&linear.translation, n)?;
        coordinates(matrix)?;
        coordinates(shift)?;
        let stretch = norm(matrix);
        // Without an extent, the rounding of an ill-conditioned map could not be bounded.
        if !(inner.extent > 0.0) {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let reach = length(stretch * (inner.extent + inner.radius) + norm(shift))?;
        let own = inner.stated_error(linear.columns as usize);
        let stays = shift.iter().all(|&x| x == 0.0) && inner.knows_origin(linear.columns as usize);
        let shortcuts = inner.exhaustive.map(|_| qdist_linear_exhaustive_f64 as SupportFn<f64>);
        // Both products, the unit vector for the ball term, the two sums: see `support::Linear`.
        let error = length((stretch * own + f64::count(4 * MAX_DIMENSION + 8) * f64::ROUNDOFF * reach) * 1.000001)?;
        let made = qdist_set_f64 {
            support: Some(qdist_linear_support_f64),
            exhaustive: shortcuts,
            mirrored: None,
            user: map.cast_mut().cast(),
            radius: 0.0,
            extent: reach,
            error,
            dimension: linear.rows,
            contains_origin: stays.into(),
        };
        // SAFETY: checked.
        unsafe { put(set, made) };
        Ok(())
    };
    status(fill())
}

/// Support function of a sum.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_sum_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_pair(user, direction, point, 1.0, false) })
}

/// The same, where a part has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_sum_exhaustive_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_pair(user, direction, point, 1.0, true) })
}

/// Support function of a difference.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_difference_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_pair(user, direction, point, -1.0, false) })
}

/// The same, where a part has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_difference_exhaustive_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_pair(user, direction, point, -1.0, true) })
}

/// Support function of a linear image.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_linear_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_linear(user, direction, point, false) })
}

/// The same, where the set has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_linear_exhaustive_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_linear(user, direction, point, true) })
}

/// Support function of a join.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_join_support_f64(user: *mut c_void, direction: *const f64, point: *mut f64) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_join(user, direction, point, false) })
}

/// The same, where a part has shortcuts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_join_exhaustive_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    // SAFETY: what the header asks of the caller.
    status(unsafe { ask_join(user, direction, point, true) })
}

impl qdist_linear_f64 {
    /// # Safety
    /// If not NULL and aligned, `matrix` is valid for reads of all entries.
    unsafe fn matrix<'a>(&self) -> Check<&'a [f64]> {
        let length = dimension(self.rows)? * dimension(self.columns)?;
        // SAFETY: the caller's promise.
        unsafe { array(self.matrix, Some(length)) }
    }
}

/// A part of a combination, for dimension `n`.
///
/// # Safety
/// If not NULL and aligned, `set` is valid for reads.
unsafe fn part<'a>(set: *const qdist_set_f64, n: usize) -> Check<&'a qdist_set_f64> {
    // SAFETY: the caller's promise.
    let set = unsafe { shared(set) }?;
    set.support.ok_or(QDIST_ERROR_NULL)?;
    lengths([set.radius, set.extent, set.error])?;
    flag(set.contains_origin)?;
    if set.dimension != 0 && set.dimension as usize != n { Err(QDIST_ERROR_DIMENSION) } else { Ok(set) }
}

/// Both sets of a pair, and their dimension.
///
/// # Safety
/// Pointers that are neither NULL nor misaligned are valid for reads.
unsafe fn parts<'a>(pair: *const qdist_pair_f64) -> Check<(&'a qdist_set_f64, &'a qdist_set_f64, usize)> {
    // SAFETY: the caller's promise.
    unsafe {
        let pair = shared(pair)?;
        let n = dimension(pair.dimension)?;
        Ok((part(pair.a, n)?, part(pair.b, n)?, n))
    }
}

fn norm(v: &[f64]) -> f64 {
    dot(v, v).root() * 1.000001
}

/// # Safety
/// Pointers that are neither NULL nor misaligned are valid.
unsafe fn fill_pair(
    set: *mut qdist_set_f64,
    pair: *const qdist_pair_f64,
    support: SupportFn<f64>,
    exhaustive: SupportFn<f64>,
) -> Check {
    aligned(set)?;
    // SAFETY: the caller's promise.
    let (a, b, n) = unsafe { parts(pair) }?;
    let known = a.extent > 0.0 && b.extent > 0.0;
    let extent = if known { (a.extent + b.extent) * 1.000001 } else { 0.0 };
    let made = qdist_set_f64 {
        support: Some(support),
        exhaustive: a.exhaustive.or(b.exhaustive).map(|_| exhaustive),
        mirrored: a.mirrored.and(b.mirrored).and(Some(pair_mirrored)),
        user: pair.cast_mut().cast(),
        radius: a.radius + b.radius,
        extent,
        error: ((a.stated_error(n) + b.stated_error(n)) * 1.000001 + 2.0 * f64::ROUNDOFF * extent).max(tiny()),
        dimension: n as u32,
        contains_origin: (a.knows_origin(n) && b.knows_origin(n)).into(),
    };
    // Sums of lengths that are legal may be too large.
    lengths([made.radius, made.extent, made.error])?;
    // SAFETY: checked.
    unsafe { put(set, made) };
    Ok(())
}

/// The mirror function of sums and differences: a change of sign that both parts allow.
unsafe extern "C" fn pair_mirrored(user: *mut c_void, signs: u32) -> i32 {
    let ask = || {
        // SAFETY: what the header asks of the caller.
        let (a, b) = unsafe {
            let pair = shared(user.cast::<qdist_pair_f64>().cast_const())?;
            (shared(pair.a)?, shared(pair.b)?)
        };
        // SAFETY: what the header asks of the caller.
        let mirrored = |set: &qdist_set_f64| unsafe { is_mirrored(set.mirrored, set.user, signs as u8) };
        Ok(mirrored(a) && mirrored(b))
    };
    let answer: Check<bool> = ask();
    i32::from(answer.unwrap_or(false))
}

/// Asks a part for its point along `u`.
///
/// # Safety
/// The set's functions work in dimension `u.len()`.
unsafe fn ask(set: &qdist_set_f64, u: &[f64], exhaustive: bool) -> Check<[f64; MAX_DIMENSION]> {
    let mut point = [f64::NAN; MAX_DIMENSION];
    let slow = if exhaustive { set.exhaustive } else { None };
    let function = slow.or(set.support).ok_or(QDIST_ERROR_NULL)?;
    // SAFETY: the caller's promise; `point` has room for every dimension.
    match unsafe { function(set.user, u.as_ptr(), point.as_mut_ptr()) } {
        0 => Ok(point),
        code => Err(code),
    }
}

/// x + sign * y, with x along the direction in `a` and y along sign * direction in `b`.
///
/// # Safety
/// Those of a support function.
unsafe fn ask_pair(user: *mut c_void, direction: *const f64, point: *mut f64, sign: f64, exhaustive: bool) -> Check {
    // SAFETY: what the header asks of the caller.
    unsafe {
        let pair = shared(user.cast::<qdist_pair_f64>().cast_const())?;
        let n = dimension(pair.dimension)?;
        let u = array(direction, Some(n))?;
        room::<1>(point)?;
        let mut turned = [0.0; MAX_DIMENSION];
        for (to, &x) in turned.iter_mut().zip(u) {
            *to = sign * x;
        }
        let x = ask(shared(pair.a)?, u, exhaustive)?;
        let y = ask(shared(pair.b)?, first(&turned, n)?, exhaustive)?;
        for (i, (x, y)) in x.iter().zip(&y).enumerate().take(n) {
            point.add(i).write(x + sign * y);
        }
    }
    Ok(())
}

/// The farther of the points of `a` and `b`, the larger radius' excess put on.
///
/// # Safety
/// Those of a support function.
unsafe fn ask_join(user: *mut c_void, direction: *const f64, point: *mut f64, exhaustive: bool) -> Check {
    // SAFETY: what the header asks of the caller.
    let (a, b, u, mut x, mut y) = unsafe {
        let pair = shared(user.cast::<qdist_pair_f64>().cast_const())?;
        let u = array(direction, Some(dimension(pair.dimension)?))?;
        room::<1>(point)?;
        let (a, b) = (shared(pair.a)?, shared(pair.b)?);
        (a, b, u, ask(a, u, exhaustive)?, ask(b, u, exhaustive)?)
    };
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
    let between = first(&between, u.len())?;
    let farther = if between.iter().any(|x| !x.finite()) {
        // What a part said must not get lost behind what the other one said.
        between
    } else if dot(w, in_range(between, &mut other)) >= 0.0 {
        first(&x, u.len())?
    } else {
        first(&y, u.len())?
    };
    // SAFETY: `farther` and the caller's room have as many numbers as `u`.
    unsafe { farther.as_ptr().copy_to(point, farther.len()) };
    Ok(())
}

/// # Safety
/// Those of a support function.
unsafe fn ask_linear(user: *mut c_void, direction: *const f64, point: *mut f64, exhaustive: bool) -> Check {
    // SAFETY: what the header asks of the caller.
    unsafe {
        let map = shared(user.cast::<qdist_linear_f64>().cast_const())?;
        let matrix = map.matrix()?;
        let (rows, columns) = (dimension(map.rows)?, dimension(map.columns)?);
        let u = array(direction, Some(rows))?;
        room::<1>(point)?;
        let set = shared(map.set)?;
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
        for (i, (row, t)) in matrix.chunks_exact(columns).zip(&map.translation).enumerate() {
            point.add(i).write(dot(row, &x) + t);
        }
    }
    Ok(())
}
