//! Hulls of integer points: nothing about them is rounded, and their d is a quotient of integers.
//!
//! A set here may also *lean*: its support points are off the true ones by as much as it states, always to the same side. That is the worst that a
//! support function may do, and shows whether a bracket allows for it.

use super::dd::Dd;
use super::dice::Dice;
use qdist::qset::UnitSet;
use qdist::support::{Failure, Support};
use qdist::{Real, Vector};

pub type Point = [i64; 3];
type Wide = [i128; 3];

/// The hull of integer points, in units of a power of two, with a ball around it.
#[derive(Clone, Debug)]
pub struct Lattice {
    pub points: Vec<Point>,
    pub unit: f64,
    pub radius: f64,
    /// How far support points are off along each axis: outwards where positive, inwards where negative.
    pub lean: Lean,
    /// States its extents, and errors, axis by axis.
    pub by_axis: bool,
    /// How many times its extent it states; 0: it does not know.
    pub loose: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lean {
    /// No error at all.
    None,
    /// Along the direction.
    By(f64),
    /// Along each axis, to the side of the direction.
    ByAxis([f64; 3]),
    /// A share of the point's norm, along the direction.
    Share(f64),
}

impl Lattice {
    pub fn new(points: Vec<Point>) -> Self {
        Lattice { points, unit: 1.0, radius: 0.0, lean: Lean::None, by_axis: false, loose: 1.01 }
    }

    fn reach(&self) -> [f64; 3] {
        std::array::from_fn(|i| self.points.iter().map(|p| p[i].abs()).max().unwrap() as f64 * self.unit)
    }

    fn norm(&self) -> f64 {
        self.points.iter().map(|p| (square(&wide(p)) as f64).sqrt()).fold(0.0, f64::max) * self.unit
    }

    /// What a leaning set's own arithmetic may add.
    fn rounding<T: Real>(&self) -> f64 {
        8.0 * T::ROUNDOFF.to_f64() * self.norm()
    }
}

impl<T: Real> Support<T, 3> for Lattice {
    fn support(&self, u: &Vector<T, 3>) -> Result<Vector<T, 3>, Failure> {
        // Products of 53 and 24 bits: exact in two words.
        let height = |p: &Point| (0..3).fold(Dd::new(0.0), |s, i| s + Dd::product(u[i].to_f64(), p[i] as f64));
        let far = self.points.iter().reduce(|a, b| if height(b) > height(a) { b } else { a }).unwrap();
        let far = Vector::from(far.map(|x| T::of(x as f64 * self.unit)));
        let unit = u * (T::one() / u.dot(u).root());
        Ok(match self.lean {
            Lean::None => far,
            Lean::By(e) => far + unit * T::of(e),
            Lean::Share(share) => far + unit * (T::of(share) * far.dot(&far).root()),
            Lean::ByAxis(e) => Vector::from_fn(|i, _| far[i] + T::of(if u[i] < T::zero() { -e[i] } else { e[i] })),
        })
    }
    fn radius(&self) -> T {
        T::of(self.radius)
    }
    fn extent(&self) -> T {
        T::of(self.norm() * self.loose)
    }
    fn extents(&self) -> Vector<T, 3> {
        if self.by_axis { Vector::from(self.reach().map(|x| T::of(x * 1.0001))) } else { Vector::repeat(self.extent()) }
    }
    fn contains_origin(&self) -> bool {
        self.points.contains(&[0; 3])
    }
    fn error(&self) -> T {
        if let Lean::Share(_) = self.lean {
            return T::count(48) * T::ROUNDOFF * Support::<T, 3>::extent(self); // the default of sets
        }
        T::of(match self.lean {
            Lean::None | Lean::Share(_) => 0.0,
            Lean::By(e) => e.abs() * 1.0001 + self.rounding::<T>(),
            Lean::ByAxis(e) => e.iter().map(|e| e * e).sum::<f64>().sqrt() * 1.0001 + self.rounding::<T>(),
        })
    }
    fn errors(&self) -> Vector<T, 3> {
        match self.lean {
            Lean::ByAxis(e) => Vector::from(e.map(|e| T::of(e.abs() * 1.0001))),
            _ => Vector::repeat(self.error()),
        }
    }
}

/// A unit set that is off by as much as it states, always to the same side.
pub struct Leaning<'a, T> {
    pub unit: &'a dyn UnitSet<T, 3>,
    pub by: T,
}

impl<T: Real> UnitSet<T, 3> for Leaning<'_, T> {
    fn value(&self, u: &Vector<T, 3>) -> Result<T, Failure> {
        Ok((self.unit.value(u)? + self.by * u.dot(u).root()).at_least(T::zero()))
    }
    fn mapping(&self, u: &Vector<T, 3>) -> Option<Vector<T, 3>> {
        self.unit.mapping(u)
    }
    fn vertex_count(&self) -> usize {
        self.unit.vertex_count()
    }
    fn vertex(&self, index: usize) -> Vector<T, 3> {
        let vertex = self.unit.vertex(index);
        vertex + vertex * (self.by / vertex.dot(&vertex).root())
    }
    fn inner_radius(&self) -> T {
        self.unit.inner_radius()
    }
    fn error(&self) -> T {
        self.unit.error() + self.by.abs() * T::of(1.0001)
    }
}

fn wide(p: &Point) -> Wide {
    p.map(i128::from)
}

fn dot(a: &Wide, b: &Wide) -> i128 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn square(a: &Wide) -> i128 {
    dot(a, a)
}

fn minus(a: &Wide, b: &Wide) -> Wide {
    std::array::from_fn(|i| a[i] - b[i])
}

fn cross(a: &Wide, b: &Wide) -> Wide {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// An integer of up to 106 bits, exactly.
pub fn exact(x: i128) -> Dd {
    let high = x as f64;
    Dd::new(high) + Dd::new((x - high as i128) as f64)
}

/// Supporting planes n.x <= k of the hull, by trying all triples.
pub fn planes(points: &[Point]) -> Vec<(Wide, i128)> {
    let points: Vec<Wide> = points.iter().map(wide).collect();
    let mut found = Vec::new();
    for i in 0..points.len() {
        for j in 0..i {
            for k in 0..j {
                let n = cross(&minus(&points[j], &points[i]), &minus(&points[k], &points[i]));
                for n in [n, n.map(|x| -x)] {
                    let offset = dot(&n, &points[i]);
                    if n != [0; 3] && points.iter().all(|p| dot(&n, p) <= offset) {
                        found.push((n, offset));
                    }
                }
            }
        }
    }
    found
}

/// The least crossing of the rays along `vertices` with the hull's surface: d for Q the hull of the origin and these. `None` where there is none, or not
/// above 0, or the hull is flat or not around the origin.
pub fn crossing(points: &[Point], vertices: &[Point]) -> Option<Dd> {
    let planes = planes(points);
    if planes.iter().any(|(_, k)| *k < 0) {
        return None;
    }
    let along = |n: &Wide, v: &Point| (0..3).map(|i| n[i] * i128::from(v[i])).sum::<i128>();
    let pairs = planes.iter().flat_map(|(n, k)| vertices.iter().map(move |v| (*k, along(n, v))));
    let d = pairs.filter(|(_, a)| *a > 0).map(|(k, a)| exact(k) / exact(a)).reduce(Dd::min)?;
    (d > Dd::ZERO).then_some(d)
}

/// Distance of the origin from the hull: the least over its points, edges and triangles.
pub fn distance(points: &[Point]) -> Dd {
    let points: Vec<Wide> = points.iter().map(wide).collect();
    let mut least = Dd::new(f64::MAX);
    for (i, a) in points.iter().enumerate() {
        least = least.min(exact(square(a)).sqrt());
        for (j, b) in points[..i].iter().enumerate() {
            let edge = minus(b, a);
            let along = -dot(a, &edge);
            if along > 0 && along < square(&edge) {
                least = least.min((exact(square(&cross(a, b))) / exact(square(&edge))).sqrt());
            }
            for c in &points[..j] {
                let n = cross(&edge, &minus(c, a));
                let inside = |p: &Wide, q: &Wide| dot(&n, &cross(p, q)) >= 0;
                if n != [0; 3] && inside(a, b) && inside(b, c) && inside(c, a) {
                    least = least.min(exact(dot(&n, a)).abs() / exact(square(&n)).sqrt());
                }
            }
        }
    }
    least
}

/// d, with h_Q of integer vectors; where the origin is outside, minus the distance.
pub fn truth(points: &[Point], value: impl Fn(&[i128; 3]) -> Dd) -> Dd {
    let planes = planes(points);
    if planes.iter().all(|(_, k)| *k > 0) && !planes.is_empty() {
        planes.iter().fold(Dd::new(f64::MAX), |d, (n, k)| d.min(exact(*k) / value(n)))
    } else {
        -distance(points)
    }
}

/// h of the unit ball.
pub fn ball(n: &[i128; 3]) -> Dd {
    exact(square(n)).sqrt()
}

/// h of a box.
pub fn cuboid(half: [i64; 3]) -> impl Fn(&[i128; 3]) -> Dd {
    move |n| exact((0..3).map(|i| n[i].abs() * i128::from(half[i])).sum())
}

/// Points and their opposites within a box of these half lengths.
pub fn symmetric(dice: &mut Dice, half: [i64; 3]) -> Vec<Point> {
    let mut points: Vec<Point> = (0..4 + dice.below(3))
        .map(|_| std::array::from_fn(|i| dice.below(2 * half[i] as usize + 1) as i64 - half[i]))
        .flat_map(|p: Point| [p, p.map(|x| -x)])
        .collect();
    points.dedup();
    points
}

/// A thin slab, not along the axes: about `size` long, and about 1 / `size` thick. (The image of a small set under an integer matrix of determinant 1.)
pub fn slab(dice: &mut Dice, size: f64) -> Vec<Point> {
    let mut points = symmetric(dice, [6, 6, 3]);
    let step = (size.sqrt() as usize).clamp(2, 1000);
    for round in 0.. {
        if points.iter().flatten().any(|x| x.abs() as f64 > size) {
            break;
        }
        let (to, from) = ([1, 2, 0][round % 3], [2, 0, 1][round % 3]);
        let factor = dice.below(step) as i64 + 1;
        points.iter_mut().for_each(|p| p[to] += factor * p[from]);
    }
    points
}

/// The set moved by an integer vector.
pub fn moved(points: &[Point], by: Point) -> Vec<Point> {
    points.iter().map(|p| std::array::from_fn(|i| p[i] + by[i])).collect()
}

/// d of a set in a plane through the origin, within that plane; `None` where it does not hold the origin inside.
pub fn truth_in_plane(points: &[Point], value: impl Fn(&[i128; 3]) -> Dd) -> Option<Dd> {
    let points: Vec<Wide> = points.iter().map(wide).collect();
    let plane = points.iter().map(|p| cross(&points[0], p)).find(|n| *n != [0; 3])?;
    let mut least: Option<Dd> = None;
    for a in &points {
        for b in &points {
            let n = cross(&plane, &minus(b, a));
            let k = dot(&n, a);
            if n != [0; 3] && points.iter().all(|p| dot(&n, p) <= k) {
                if k <= 0 {
                    return None;
                }
                let d = exact(k) / value(&n);
                least = Some(least.map_or(d, |least| least.min(d)));
            }
        }
    }
    least
}
