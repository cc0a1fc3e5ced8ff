//! Two triangles, a point and a triangle, two segments.

use nalgebra::{Point3, Vector3};

type Triangle = [Point3<f64>; 3];

/// Proves two triangles apart by an axis on which their shadows have a gap of more than `doubt`, a bound on the error of
/// the coordinates. False means that no such axis was found: they intersect, or touch, or are too close to tell.
///
/// Any axis is a proof, however inaccurate or degenerate the way it was found, so slivers and coplanar triangles need no
/// special care. For two proper triangles the axes below are all that is needed (normals, products of edges; edge normals for the
/// coplanar case).
pub(super) fn apart(a: &Triangle, b: &Triangle, doubt: f64) -> bool {
    // Relative to a corner of A, so that far coordinates do not blur the products.
    let o = a[0];
    let p = [Vector3::zeros(), a[1] - o, a[2] - o];
    let q = b.map(|x| x - o);
    let gap = |axis: &Vector3<f64>| {
        let (x1, x2) = (p[1].dot(axis), p[2].dot(axis));
        let (y0, y1, y2) = (q[0].dot(axis), q[1].dot(axis), q[2].dot(axis));
        let (low, high) = (x1.min(x2).min(0.0), x1.max(x2).max(0.0));
        (y0.min(y1).min(y2) - high).max(low - y0.max(y1).max(y2))
    };
    // |axis|_1 >= |axis|; the shadows' own rounding is relative to the extents.
    let extent = p[1].amax().max(p[2].amax()).max(q[0].amax()).max(q[1].amax()).max(q[2].amax());
    let doubt = doubt + 8.0 * f64::EPSILON * extent;
    let separates = |axis: Vector3<f64>| gap(&axis) > doubt * axis.abs().sum();

    let e = [p[1], p[2] - p[1], -p[2]];
    let n = e[0].cross(&e[1]);
    if separates(n) {
        return true;
    }
    let f = [q[1] - q[0], q[2] - q[1], q[0] - q[2]];
    let m = f[0].cross(&f[1]);
    if separates(m) {
        return true;
    }
    for u in &e {
        for v in &f {
            if separates(u.cross(v)) {
                return true;
            }
        }
    }
    if e.iter().any(|u| separates(u.cross(&n))) || f.iter().any(|v| separates(v.cross(&m))) {
        return true;
    }
    // A degenerate triangle may need another axis: the one between nearest points, at an edge or inside a face.
    let zero = Point3::origin();
    let (p, q) = (p.map(|x| zero + x), q.map(|x| zero + x));
    (0..9).any(|ij| {
        let (i, j) = (ij / 3, ij % 3);
        let (s, t) = nearest_on_segments(&p[i], &e[i], &q[j], &f[j]);
        separates(p[i] + e[i] * s - (q[j] + f[j] * t))
    }) || p.iter().any(|x| separates(x - nearest_on_triangle(x, &q).0))
        || q.iter().any(|x| separates(x - nearest_on_triangle(x, &p).0))
}

/// Where on a triangle a nearest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    Face,
    /// On the edge from corner k to the next.
    Edge(u8),
    Corner(u8),
}

/// The point of a triangle that is nearest to p (Ericson, *Real-Time Collision Detection*, 5.1.5). For a degenerate triangle it is some point
/// of it, and always a number; the edges then have the nearest one.
pub(super) fn nearest_on_triangle(p: &Point3<f64>, [a, b, c]: &Triangle) -> (Point3<f64>, Place) {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return (*a, Place::Corner(0));
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return (*b, Place::Corner(1));
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return if d1 > d3 { (a + ab * (d1 / (d1 - d3)), Place::Edge(0)) } else { (*a, Place::Corner(0)) };
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return (*c, Place::Corner(2));
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return if d2 > d6 { (a + ac * (d2 / (d2 - d6)), Place::Edge(2)) } else { (*a, Place::Corner(0)) };
    }
    let va = d3 * d6 - d5 * d4;
    let (x, y) = (d4 - d3, d5 - d6);
    if va <= 0.0 && x >= 0.0 && y >= 0.0 {
        return if x + y > 0.0 { (b + (c - b) * (x / (x + y)), Place::Edge(1)) } else { (*b, Place::Corner(1)) };
    }
    let whole = va + vb + vc;
    if whole > 0.0 { (a + ab * (vb / whole) + ac * (vc / whole), Place::Face) } else { (*a, Place::Corner(0)) }
}

/// The same for the origin, of a triangle by vectors to its corners.
pub(super) fn nearest_to_origin(corners: &[Vector3<f64>; 3]) -> Vector3<f64> {
    nearest_on_triangle(&Point3::origin(), &corners.map(Point3::from)).0.coords
}

/// Parameters in [0, 1] of the nearest points of two segments p + s d, q + t e (Ericson, 5.1.9). Parallel ones have some
/// nearest pair.
pub(super) fn nearest_on_segments(p: &Point3<f64>, d: &Vector3<f64>, q: &Point3<f64>, e: &Vector3<f64>) -> (f64, f64) {
    let r = p - q;
    let (a, c, f) = (d.norm_squared(), d.dot(&r), e.norm_squared());
    let g = e.dot(&r);
    if !(a > 0.0) {
        return (0.0, if f > 0.0 { (g / f).clamp(0.0, 1.0) } else { 0.0 });
    }
    if !(f > 0.0) {
        return ((-c / a).clamp(0.0, 1.0), 0.0);
    }
    let b = d.dot(e);
    let parallel = a * f - b * b;
    let s = if parallel > 0.0 { ((b * g - c * f) / parallel).clamp(0.0, 1.0) } else { 0.0 };
    let t = (b * s + g) / f;
    if t < 0.0 {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else if t > 1.0 {
        (((b - c) / a).clamp(0.0, 1.0), 1.0)
    } else {
        (s, t)
    }
}

/// A lower bound of the squared distance, to rounding: the gaps along both normals.
///
/// The normal of a sliver may be anything, even along the sliver, so each triangle casts a shadow on its own normal too.
#[inline]
pub(super) fn plane_gap_squared(a: &Triangle, b: &Triangle) -> f64 {
    let along = |[p, q, r]: &Triangle, other: &Triangle| {
        let (e, f) = (q - p, r - p);
        let n = e.cross(&f);
        let (s, t) = (e.dot(&n), f.dot(&n));
        let [x, y, z] = other.each_ref().map(|v| (v - p).dot(&n));
        let gap = (x.min(y).min(z) - s.max(t).max(0.0)).max(s.min(t).min(0.0) - x.max(y).max(z)).max(0.0);
        let square = n.norm_squared();
        // A gap of a product of three lengths has no square where that of two still has; too small a normal is no direction.
        if gap > 0.0 && square.is_normal() { gap * (gap / square) } else { 0.0 }
    };
    along(a, b).max(along(b, a))
}
