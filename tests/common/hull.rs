//! Exact signed depth of two convex polytopes in space, by brute force over features, in double-double.
//!
//! The Minkowski difference M = A - B has three kinds of facet normals: face normals of A, face normals of B
//! (negated), and cross products of an edge of A and an edge of B. Where the origin is inside M, the depth is the
//! least of h_M(u)/|u| over these. *Any* u gives an upper bound of the depth, so candidates that are no facets of
//! M do no harm, and it is enough that none is missing. Where the origin is not inside, the distance is that of
//! the closest pair of features, found the same way: superfluous pairs do no harm either.

use super::dd::{Dd, V3, cross, dot, norm, scale, sub};

/// The hull of some points, with supersets of its faces (as triangles) and edges.
pub struct ExactHull {
    pub points: Vec<V3>,
    /// Relative to the first point, rounded.
    near: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    edges: Vec<[usize; 2]>,
    spread: f64,
}

fn dot64(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub64(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross64(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

impl ExactHull {
    /// The hull of these points. Any position is allowed: equal, collinear, coplanar, a single point.
    pub fn new(all: &[V3]) -> Self {
        let mut points: Vec<V3> = Vec::new();
        for p in all {
            if !points.contains(p) {
                points.push(*p);
            }
        }
        let near: Vec<[f64; 3]> = points.iter().map(|p| sub(p, &points[0]).map(Dd::to_f64)).collect();
        let spread = near.iter().map(|p| dot64(p, p).sqrt()).fold(0.0, f64::max);
        let n = points.len();
        // A triple belongs to a face when no point lies beyond its plane on one side, with ample room for rounding.
        let mut triangles = Vec::new();
        let mut used = vec![false; n * n];
        for i in 0..n {
            for j in i + 1..n {
                let e = sub64(&near[j], &near[i]);
                for k in j + 1..n {
                    let f = sub64(&near[k], &near[i]);
                    let m = cross64(&e, &f);
                    let length = dot64(&m, &m).sqrt();
                    // Error of the direction of m.
                    let blur = 1e-14 * (dot64(&e, &e) * dot64(&f, &f)).sqrt() / length;
                    if blur.is_nan() || blur >= 0.1 {
                        // Collinear as far as f64 can tell: kept, for the exact evaluation to judge.
                        triangles.push([i, j, k]);
                        continue;
                    }
                    let (mut low, mut high) = (0.0f64, 0.0f64);
                    for p in &near {
                        let h = dot64(&m, &sub64(p, &near[i])) / length;
                        low = low.min(h);
                        high = high.max(h);
                    }
                    if high.min(-low) <= spread * (1e-11 + blur) {
                        triangles.push([i, j, k]);
                        used[i * n + j] = true;
                        used[i * n + k] = true;
                        used[j * n + k] = true;
                    }
                }
            }
        }
        let any = used.contains(&true);
        let mut edges = Vec::new();
        for i in 0..n {
            for j in i + 1..n {
                if used[i * n + j] || !any {
                    edges.push([i, j]);
                }
            }
        }
        ExactHull { points, near, triangles, edges, spread }
    }

    /// max of u.p over the points.
    pub fn support(&self, u: &V3) -> Dd {
        self.points.iter().map(|p| dot(u, p)).fold(Dd::new(f64::MIN), Dd::max)
    }

    fn edge(&self, e: &[usize; 2]) -> V3 {
        sub(&self.points[e[1]], &self.points[e[0]])
    }

    fn face(&self, t: &[usize; 3]) -> V3 {
        cross(&sub(&self.points[t[1]], &self.points[t[0]]), &sub(&self.points[t[2]], &self.points[t[0]]))
    }
}

/// The least h_M(u)/|u| seen so far.
struct Least<'a> {
    a: &'a ExactHull,
    b: &'a ExactHull,
    /// First point of A minus first point of B.
    between: [f64; 3],
    depth: Dd,
    normal: V3,
}

impl Least<'_> {
    /// Tries u and -u, u being a cross product of vectors whose lengths multiply to `scale_of_u`, and `rough` its
    /// value in `f64`; a look in `f64` drops what cannot matter.
    fn try_both(&mut self, u: impl Fn() -> V3, scale_of_u: f64, rough: &[f64; 3]) {
        let blur = 1e-14 * scale_of_u / dot64(rough, rough).sqrt();
        let length = dot64(rough, rough).sqrt();
        if blur < 1e-3 {
            let range = |hull: &ExactHull| {
                hull.near.iter().fold((0.0f64, 0.0f64), |(l, h), p| {
                    let x = dot64(rough, p);
                    (l.min(x), h.max(x))
                })
            };
            let ((a_low, a_high), (b_low, b_high)) = (range(self.a), range(self.b));
            let base = dot64(rough, &self.between);
            let least = (base + a_high - b_low).min(-base - a_low + b_high) / length;
            let reach = self.a.spread + self.b.spread + dot64(&self.between, &self.between).sqrt();
            if least - 4.0 * reach * (1e-14 + blur) > self.depth.hi {
                return;
            }
        }
        let u = u();
        let length = norm(&u);
        // Parallel edges have no cross product, but rounding: that would be a direction made of noise.
        if length.hi <= 1e-24 * scale_of_u {
            return;
        }
        for sign in [1.0, -1.0] {
            let n = scale(&u, Dd::new(sign) / length);
            let depth = self.a.support(&n) + self.b.support(&scale(&n, Dd::new(-1.0)));
            if depth < self.depth {
                self.depth = depth;
                self.normal = n;
            }
        }
    }
}

/// What the oracle knows of a pair.
pub struct Exact {
    /// Depth, or minus the distance.
    pub depth: Dd,
    /// A direction with h_M(u) = depth, where that is positive.
    pub normal: [f64; 3],
}

/// The exact signed depth of two hulls.
pub fn signed_depth(a: &ExactHull, b: &ExactHull) -> Exact {
    let between = sub(&a.points[0], &b.points[0]).map(Dd::to_f64);
    let mut least = Least { a, b, between, depth: Dd::new(f64::MAX), normal: [Dd::ZERO; 3] };
    for hull in [a, b] {
        for t in &hull.triangles {
            let (e, f) = (sub64(&hull.near[t[1]], &hull.near[t[0]]), sub64(&hull.near[t[2]], &hull.near[t[0]]));
            let rough = cross64(&e, &f);
            let lengths = (dot64(&e, &e) * dot64(&f, &f)).sqrt();
            least.try_both(|| hull.face(t), lengths, &rough);
        }
    }
    for ea in &a.edges {
        let e = sub64(&a.near[ea[1]], &a.near[ea[0]]);
        for eb in &b.edges {
            let f = sub64(&b.near[eb[1]], &b.near[eb[0]]);
            let rough = cross64(&e, &f);
            let lengths = (dot64(&e, &e) * dot64(&f, &f)).sqrt();
            least.try_both(|| cross(&a.edge(ea), &b.edge(eb)), lengths, &rough);
        }
    }
    let found = least.depth.hi < f64::MAX;
    let size = a.spread + b.spread + dot64(&between, &between).sqrt();
    // In a flat M with the origin in its plane, rounding may leave less than this.
    if found && least.depth.hi > 1e-24 * size {
        return Exact { depth: least.depth, normal: least.normal.map(Dd::to_f64) };
    }
    Exact { depth: -distance(a, b), normal: [f64::NAN; 3] }
}

/// The least distance of two features.
fn distance(a: &ExactHull, b: &ExactHull) -> Dd {
    let mut squared = Dd::new(f64::MAX);
    for p in &a.points {
        for q in &b.points {
            let d = sub(p, q);
            squared = squared.min(dot(&d, &d));
        }
    }
    for (one, other) in [(a, b), (b, a)] {
        for p in &one.points {
            for e in &other.edges {
                squared = squared.min(point_segment(p, &other.points[e[0]], &other.points[e[1]]));
            }
            for t in &other.triangles {
                if let Some(d) = point_triangle(p, &t.map(|i| other.points[i])) {
                    squared = squared.min(d);
                }
            }
        }
    }
    for e in &a.edges {
        for f in &b.edges {
            let (p, q) = (&a.points[e[0]], &b.points[f[0]]);
            if let Some(d) = lines(p, &a.edge(e), q, &b.edge(f)) {
                squared = squared.min(d);
            }
        }
    }
    squared.sqrt()
}

fn inside(x: Dd) -> bool {
    x >= Dd::ZERO && x <= Dd::new(1.0)
}

/// Squared distance of p from the segment ab.
fn point_segment(p: &V3, a: &V3, b: &V3) -> Dd {
    let (e, w) = (sub(b, a), sub(p, a));
    let t = (dot(&w, &e) / dot(&e, &e)).max(Dd::ZERO).min(Dd::new(1.0));
    let d = sub(&w, &scale(&e, t));
    dot(&d, &d)
}

/// Squared distance of p from the triangle, if its foot lies inside.
fn point_triangle(p: &V3, t: &[V3; 3]) -> Option<Dd> {
    let (e, f, w) = (sub(&t[1], &t[0]), sub(&t[2], &t[0]), sub(p, &t[0]));
    let (ee, ef, ff, we, wf) = (dot(&e, &e), dot(&e, &f), dot(&f, &f), dot(&w, &e), dot(&w, &f));
    let det = ee * ff - ef * ef;
    // A triangle that is a segment to 24 digits adds nothing to its edges.
    if !(det.hi > 1e-24 * (ee * ff).hi) {
        return None;
    }
    let (s, r) = ((we * ff - wf * ef) / det, (wf * ee - we * ef) / det);
    if s >= Dd::ZERO && r >= Dd::ZERO && s + r <= Dd::new(1.0) {
        let d = sub(&w, &super::dd::add(&scale(&e, s), &scale(&f, r)));
        return Some(dot(&d, &d));
    }
    None
}

/// Squared distance of the segments p + s e and q + r f, if attained inside both. By the common perpendicular n: the
/// normal equations would lose twice the digits where the lines are almost parallel.
fn lines(p: &V3, e: &V3, q: &V3, f: &V3) -> Option<Dd> {
    let (w, n) = (sub(q, p), cross(e, f));
    let squared = dot(&n, &n);
    // Parallel to 20 digits: the ends decide.
    if squared.hi <= 1e-40 * (dot(e, e) * dot(f, f)).hi {
        return None;
    }
    let (s, r) = (dot(&cross(&w, f), &n) / squared, dot(&cross(&w, e), &n) / squared);
    let along = dot(&w, &n);
    (inside(s) && inside(r)).then(|| along * along / squared)
}
