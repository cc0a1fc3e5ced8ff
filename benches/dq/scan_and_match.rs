//! The paper's bookkeeping (Sections IV-B and IV-C), as a baseline.
//!
//! Facets are a flat list without links. The next facet is the lowest of all (eq. 21); the eliminated facets are found
//! by testing all (Proposition 3), the new ones by comparing the ridges of the eliminated ones (Proposition 4), and
//! every normal solves a linear system (eq. 22). The paper does not say how ridges are compared: "by verifying
//! Proposition 4 for the facets of every eliminated facet" is taken to mean all pairs; a sorted list is the kinder
//! reading.
//!
//! Two liberties, both in the baseline's favour. With a strict ">" Proposition 3 corrupts the surface where facets are
//! coplanar, so visibility has a tolerance of 1e-13 of A's size. And the first simplex is any n + 1 support points:
//! eq. 22 is solved about its centroid instead of the origin, which need not be inside.
//!
//! The bracket is not rounded outwards: this measures time, it certifies nothing.

use nalgebra::{Const, DimMin, SMatrix};
use qdist::qset::UnitSet;
use qdist::support::Support;
use qdist::{Outcome, Vector};
use std::time::{Duration, Instant};

/// How ridges of eliminated facets are compared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Matching {
    Pairs,
    Sorted,
}

struct Facet<const N: usize> {
    /// Ascending.
    vertices: [u32; N],
    /// Unit, outward.
    normal: Vector<f64, N>,
    offset: f64,
    key: f64,
}

pub struct Result {
    pub outcome: Outcome,
    pub lower: f64,
    pub upper: f64,
    pub iterations: u32,
    pub support_calls: u32,
    pub peak: usize,
    pub bytes: usize,
}

struct Surface<'a, const N: usize> {
    q: &'a dyn UnitSet<f64, N>,
    points: Vec<Vector<f64, N>>,
    facets: Vec<Facet<N>>,
    inside: Vector<f64, N>,
}

/// Ends with `Capacity` when there are more facets than that, with `Iterations` when time is up, and with `Precision`
/// when the surface is no longer one.
pub fn solve<const N: usize>(
    a: &dyn Support<f64, N>,
    q: &dyn UnitSet<f64, N>,
    matching: Matching,
    eps: f64,
    max_facets: usize,
    time: Duration,
) -> Result
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let begin = Instant::now();
    let tolerance = 1e-13 * a.extent();
    let mut calls = 0;
    let mut support = |u: &Vector<f64, N>| {
        calls += 1;
        a.support(u).expect("a support point") + u * (a.radius() / u.norm())
    };
    let points = first_simplex(&mut support);
    let inside = points.iter().sum::<Vector<f64, N>>() / (N + 1) as f64;
    let mut surface = Surface { q, points, facets: Vec::new(), inside };
    let all: [u32; N] = std::array::from_fn(|i| i as u32);
    let whole = (0..=N as u32).all(|left_out| surface.add(all.map(|i| i + u32::from(i >= left_out))));
    let (mut lower, mut upper) = (0.0, f64::MAX);
    let (mut iterations, mut peak) = (0, surface.facets.len());
    let outcome = loop {
        let lowest = surface.facets.iter().min_by(|f, g| f.key.total_cmp(&g.key));
        let Some(&Facet { normal, offset, key, .. }) = lowest.filter(|_| whole) else { break Outcome::Precision };
        let point = support(&normal);
        let (height, unit) = (normal.dot(&point), q.value(&normal).expect("a value"));
        lower = f64::max(0.0, key);
        upper = f64::min(upper, if unit > 0.0 { height / unit } else { f64::MAX });
        if height < 0.0 {
            break Outcome::Separated;
        }
        if height - offset <= eps * unit {
            break Outcome::Converged;
        }
        if surface.facets.len() > max_facets {
            break Outcome::Capacity;
        }
        if begin.elapsed() > time {
            break Outcome::Iterations;
        }
        if height - offset <= tolerance || !surface.insert(point, tolerance, matching) {
            break Outcome::Precision;
        }
        iterations += 1;
        peak = peak.max(surface.facets.len());
    };
    let bytes = peak * size_of::<Facet<N>>() + surface.points.len() * size_of::<Vector<f64, N>>();
    Result { outcome, lower, upper, iterations, support_calls: calls, peak, bytes }
}

/// n + 1 affinely independent points of A: each as far as possible from the flat through those before it, one way or
/// the other.
fn first_simplex<const N: usize>(mut support: impl FnMut(&Vector<f64, N>) -> Vector<f64, N>) -> Vec<Vector<f64, N>> {
    let axis = |i: usize| Vector::<f64, N>::from_fn(|j, _| f64::from(u8::from(i == j)));
    let mut points = vec![support(&axis(0))];
    let mut basis: Vec<Vector<f64, N>> = Vec::new();
    let across = |basis: &[Vector<f64, N>], x: Vector<f64, N>| {
        let once = basis.iter().fold(x, |x, b| x - b * b.dot(&x));
        basis.iter().fold(once, |x, b| x - b * b.dot(&x))
    };
    for _ in 0..N {
        // The coordinate direction that sticks out of the flat most.
        let out = (0..N).map(|i| across(&basis, axis(i)));
        let out = out.max_by(|x, y| x.norm().total_cmp(&y.norm())).expect("N > 0").normalize();
        let ends = [support(&out), support(&-out)];
        let far = |p: &Vector<f64, N>| out.dot(&(p - points[0])).abs();
        let point = if far(&ends[0]) >= far(&ends[1]) { ends[0] } else { ends[1] };
        basis.push(across(&basis, point - points[0]).normalize());
        points.push(point);
    }
    points
}

impl<const N: usize> Surface<'_, N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    /// Eq. 22 to 24. False when the points span no plane.
    fn add(&mut self, vertices: [u32; N]) -> bool {
        let corners = SMatrix::<f64, N, N>::from_fn(|i, j| self.points[vertices[i] as usize][j] - self.inside[j]);
        let solved: Option<Vector<f64, N>> = corners.lu().solve::<Const<N>, Const<1>, _>(&Vector::repeat(1.0));
        let Some(normal) = solved else { return false };
        let length = normal.norm();
        let normal = normal / length;
        let offset = 1.0 / length + normal.dot(&self.inside);
        let unit = self.q.value(&normal).expect("a value");
        let key = if unit > 0.0 { offset / unit } else { f64::MAX };
        self.facets.push(Facet { vertices, normal, offset, key });
        offset.is_finite()
    }

    /// Propositions 3 and 4. False when a new facet spans no plane, or nothing is eliminated.
    fn insert(&mut self, point: Vector<f64, N>, tolerance: f64, matching: Matching) -> bool {
        let mut ridges = Vec::new();
        self.facets.retain(|f| {
            let eliminated = f.normal.dot(&point) - f.offset > tolerance;
            if eliminated {
                ridges.extend((0..N).map(|left_out| without(&f.vertices, left_out)));
            }
            !eliminated
        });
        let apex = self.points.len() as u32;
        self.points.push(point);
        let horizon = match matching {
            Matching::Pairs => single_among_pairs(&ridges),
            Matching::Sorted => {
                ridges.sort_unstable();
                ridges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]).collect()
            }
        };
        !horizon.is_empty()
            && horizon.into_iter().all(|mut ridge| {
                ridge[N - 1] = apex;
                self.add(ridge)
            })
    }
}

/// A ridge of two eliminated facets comes twice: those that come once.
fn single_among_pairs<const N: usize>(ridges: &[[u32; N]]) -> Vec<[u32; N]> {
    let twice = |(i, ridge): &(usize, &[u32; N])| ridges[..*i].contains(ridge) || ridges[i + 1..].contains(ridge);
    ridges.iter().enumerate().filter(|x| !twice(x)).map(|(_, &ridge)| ridge).collect()
}

/// A facet's vertices but one, and a last place that is the same for all.
fn without<const N: usize>(vertices: &[u32; N], left_out: usize) -> [u32; N] {
    let mut ridge = *vertices;
    ridge[left_out..].rotate_left(1);
    ridge[N - 1] = u32::MAX;
    ridge
}
