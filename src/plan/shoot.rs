//! Rays shot at A by a query: for a polytopal Q they are the whole answer, for any other they find upper bounds.

use super::ray::Ray;
use crate::math::{Vector, finite, norm};
use crate::polytope::simplex::Vertex;
use crate::query::Query;
use crate::query::answer::Stop;
use crate::scalar::Real;
use crate::support::Failure;

/// More steps than any ray takes: rounding ends them earlier.
const STEPS: usize = 512;

/// Size of the artificial corners, as a share of A's: the larger, the better the arithmetic; the smaller, the nearer to the origin may A end
/// before that takes a program of its own.
const SPECK: f64 = 1e-3;

/// How far a ray is of interest. (By reference: one copy of the loop for all.)
pub(crate) type Level<'l, T, const N: usize> = dyn Fn(&Query<'_, T, N>) -> T + 'l;

/// Where a shot ended.
pub(crate) enum Shot {
    /// The crossing is known as well as asked for, or as arithmetic allows.
    Hit,
    /// The ray leaves A where it begins, up to rounding.
    Left,
    Stopped(Stop),
    /// It stopped at what is not there: once more.
    Again,
}

/// A ray from the origin along `target`, shot until the crossing is beyond `level`, or known to a share `accuracy` of its distance; from the simplex that
/// another ray pierced, if this one does as well.
#[inline(never)]
pub(crate) fn shoot<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    target: &Vector<T, N>,
    near: Option<Ray<T, N>>,
    accuracy: T,
    level: &Level<'_, T, N>,
) -> Result<(Ray<T, N>, Shot), Failure> {
    let ray = match near.and_then(|ray| ray.aimed(target)) {
        Some(ray) => ray,
        None => Ray::new(target, query.size() * T::of(SPECK)),
    };
    shoot_on(query, ray, accuracy, level)
}

/// The same from another point of A.
pub(crate) fn shoot_from<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    from: &Vector<T, N>,
    target: &Vector<T, N>,
    accuracy: T,
    level: &Level<'_, T, N>,
) -> Result<(Ray<T, N>, Shot), Failure> {
    let ray = Ray::begin(from, target, query.size() * T::of(SPECK));
    shoot_on(query, ray, accuracy, level)
}

fn shoot_on<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    mut ray: Ray<T, N>,
    accuracy: T,
    level: &Level<'_, T, N>,
) -> Result<(Ray<T, N>, Shot), Failure> {
    let mut shot = follow(query, &mut ray, accuracy, level)?;
    if matches!(shot, Shot::Hit) && ray.reach().is_none() {
        ray.reach_out();
        shot = follow(query, &mut ray, accuracy, level)?;
    }
    Ok((ray, shot))
}

/// Whether the inverse still is one is checked before anything is concluded from it: false where it had to be polished.
fn settle<T: Real, const N: usize>(ray: &mut Ray<T, N>, query: &Query<'_, T, N>, polished: &mut bool) -> bool {
    let fine = *polished || ray.reach().is_none_or(|(_, miss)| miss <= query.resolution());
    if !fine {
        ray.polish();
        *polished = true;
    }
    fine
}

fn follow<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    ray: &mut Ray<T, N>,
    accuracy: T,
    level: &Level<'_, T, N>,
) -> Result<Shot, Failure> {
    let mut polished = false;
    for _ in 0..STEPS {
        if let Some((t, _)) = ray.reach()
            && t >= level(query)
        {
            if settle(ray, query, &mut polished) {
                break;
            }
            continue;
        }
        let plane = ray.plane();
        let length = norm(&plane);
        if !(length > T::zero()) || !length.finite() {
            break;
        }
        let direction = plane * (T::one() / length);
        let floor = if query.spares_unit() { ray.floor(&direction) } else { T::zero() };
        let (vertex, height) = query.support_beyond(&direction, floor)?;
        if query.is_outside(&direction, height) {
            return Ok(Shot::Stopped(Stop::Outside));
        }
        if query.is_spent() {
            return Ok(Shot::Stopped(Stop::Zero));
        }
        let height = height - direction.dot(&ray.from);
        let offset = if ray.is_reaching() { T::zero() } else { T::one() / length };
        let beyond = height - offset;
        if ray.is_reaching() && beyond <= query.margin() {
            if ray.arrive(T::ROUNDOFF.root()) {
                continue; // Along the boundary of A: q is in the cone over A, or nearly. What it misses is measured in the end.
            }
            return Ok(Shot::Left);
        }
        if beyond <= query.resolution() || beyond <= accuracy * offset {
            if settle(ray, query, &mut polished) {
                break;
            }
            continue;
        }
        if let Some(stop) = query.exhausted() {
            return Ok(Shot::Stopped(stop));
        }
        let seen = Vertex { point: vertex.point - ray.from, ..vertex };
        if !ray.enter(&seen, query.is_patient) {
            break;
        }
        polished = false;
    }
    Ok(Shot::Hit)
}

/// The polar power iteration: from a direction u to the normal of A where the ray along s_Q(u) leaves it, which bounds d at least as
/// tightly; a local minimum of h_A / h_Q is what it leaves unchanged.
///
/// Why it descends: let t be the crossing along q = s_Q(u) and v the normal there. Then h_A(v) = t v.q <= t h_Q(v), and
/// h_A(u) >= t u.q = t h_Q(u). So h_A(v) / h_Q(v) <= t <= h_A(u) / h_Q(u).
#[inline(never)]
pub(crate) fn descend<T: Real, const N: usize>(
    query: &mut Query<'_, T, N>,
    from: &Vector<T, N>,
) -> Result<Option<Stop>, Failure> {
    let mut direction = *from;
    let mut last: Option<Ray<T, N>> = None;
    for _ in 0..STEPS {
        let Some(target) = query.mapping(&direction) else { return Ok(None) };
        let before = query.ratio();
        let (ray, shot) = shoot(query, &target, last.take(), T::of(1e-6), &|_| T::HUGE)?;
        if let Shot::Stopped(stop) = shot {
            return Ok(Some(stop));
        }
        let plane = ray.plane();
        direction = plane * (T::one() / norm(&plane));
        if !finite(&direction) || !(query.ratio() < before - before * query.options.relative.at_least(T::of(1e-9))) {
            break;
        }
        last = Some(ray);
    }
    Ok(None)
}
