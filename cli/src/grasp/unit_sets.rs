//! The sets Q of the files, as sets of R^6.
//!
//! A Q is given in coordinates c of some axes: the wrench is the sum of c_k times axis k. Where the axes are coordinate axes of R^6, Q is the
//! same shape with zeros for the others, which keeps its numbers exact. Otherwise an ellipsoid is one with other axes, and a polytope the hull of
//! its vertices.

use qdist::Vector;
use qdist::nalgebra::SMatrix;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet, Vertices};
use qdist::support::ShapeError;

use crate::Trouble;

/// A shape by its numbers.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    Ball(f64),
    Ellipsoid(Vec<f64>),
    Box(Vec<f64>),
    CrossPolytope(Vec<f64>),
    Segment(Vec<f64>),
}

impl Shape {
    /// One number an axis; `None` for a ball, which is the same along all.
    pub fn numbers(&self) -> Option<&[f64]> {
        match self {
            Self::Ball(_) => None,
            Self::Ellipsoid(x) | Self::Box(x) | Self::CrossPolytope(x) | Self::Segment(x) => Some(x),
        }
    }

    /// The largest t with t c in the shape.
    fn reach(&self, c: &[f64]) -> f64 {
        let norm = |x: f64, y: f64| x.hypot(y);
        let ratios = |sizes: &[f64]| -> Vec<f64> {
            let ratio = |(x, size): (&f64, &f64)| if *x == 0.0 { 0.0 } else { x.abs() / size };
            c.iter().zip(sizes).map(ratio).collect()
        };
        match self {
            Self::Ball(radius) => radius / c.iter().copied().fold(0.0, norm),
            Self::Ellipsoid(sizes) => ratios(sizes).into_iter().fold(0.0, norm).recip(),
            Self::Box(sizes) => ratios(sizes).into_iter().fold(0.0, f64::max).recip(),
            Self::CrossPolytope(sizes) => ratios(sizes).into_iter().sum::<f64>().recip(),
            Self::Segment(end) => {
                let along = c.iter().zip(end).map(|(x, y)| x * y).sum::<f64>();
                let (c, end) = (c.iter().copied().fold(0.0, norm), end.iter().copied().fold(0.0, norm));
                if along >= (1.0 - 1e-12) * c * end { end / c } else { 0.0 }
            }
        }
    }
}

/// What the library is asked with.
#[derive(Clone, Debug)]
enum Form {
    Ball(Ball<f64>),
    Ellipsoid(Box<UnitEllipsoid<f64, 6>>),
    Box(UnitBox<f64, 6>),
    CrossPolytope(CrossPolytope<f64, 6>),
    Segment(Segment<f64, 6>),
    Vertices(Vec<[f64; 6]>),
}

/// A set Q of R^6, and how it was given.
#[derive(Clone, Debug)]
pub struct Q {
    shape: Shape,
    /// The axes of its coordinates; for a ball without, all of R^6.
    axes: Vec<Vector<f64, 6>>,
    form: Form,
}

impl Q {
    /// The shape along `axes`, as many as it has numbers; along those of R^6 without.
    pub fn new(shape: Shape, axes: Option<Vec<Vector<f64, 6>>>) -> Result<Self, Trouble> {
        let plain = axes.is_none();
        let axes = axes.unwrap_or_else(|| (0..6).map(|i| Vector::from_fn(|j, _| f64::from(i == j))).collect());
        let bad = |axis: &Vector<f64, 6>| !(axis.norm() > 0.0 && axis.norm().is_finite());
        if axes.is_empty() || axes.len() > 6 || axes.iter().any(bad) {
            return Err("its axes are not 1 to 6 finite vectors other than 0".into());
        }
        let form = match &shape {
            Shape::Ball(radius) if plain => Form::Ball(Ball::new(*radius).map_err(words)?),
            Shape::Ball(radius) => ellipsoid(&vec![*radius; axes.len()], &axes)?,
            Shape::Ellipsoid(sizes) => ellipsoid(sizes, &axes)?,
            Shape::Segment(end) => Form::Segment(Segment::new(combined(end, &axes)).map_err(words)?),
            Shape::Box(sizes) => match padded(sizes, &axes) {
                Some(sizes) => Form::Box(UnitBox::new(sizes).map_err(words)?),
                None => vertices(&corners(sizes)?, &axes)?,
            },
            Shape::CrossPolytope(sizes) => match padded(sizes, &axes) {
                Some(sizes) => Form::CrossPolytope(CrossPolytope::new(sizes).map_err(words)?),
                None => vertices(&tips(sizes)?, &axes)?,
            },
        };
        Ok(Self { shape, axes, form })
    }

    /// The support function.
    pub fn unit(&self) -> Result<Box<dyn UnitSet<f64, 6> + '_>, Trouble> {
        Ok(match &self.form {
            Form::Ball(q) => Box::new(*q),
            Form::Ellipsoid(q) => Box::new(**q),
            Form::Box(q) => Box::new(*q),
            Form::CrossPolytope(q) => Box::new(*q),
            Form::Segment(q) => Box::new(*q),
            Form::Vertices(points) => Box::new(Vertices::new(points).map_err(words)?),
        })
    }

    /// The word of the files.
    pub fn kind(&self) -> &'static str {
        match self.shape {
            Shape::Ball(_) => "ball",
            Shape::Ellipsoid(_) => "ellipsoid",
            Shape::Box(_) => "box",
            Shape::CrossPolytope(_) => "cross_polytope",
            Shape::Segment(_) => "segment",
        }
    }

    /// The kind, with its numbers where they are not all 1.
    pub fn label(&self) -> String {
        let ones = self.shape == Shape::Ball(1.0) || self.shape.numbers().is_some_and(|x| x.iter().all(|&x| x == 1.0));
        let numbers = match &self.shape {
            Shape::Ball(radius) => std::slice::from_ref(radius),
            shape => shape.numbers().unwrap_or(&[]),
        };
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        if ones { self.kind().into() } else { format!("{} {}", self.kind(), numbers.join(" ")) }
    }

    /// A polytope or a segment: one ray a vertex may be all that a query takes.
    pub fn is_polytope(&self) -> bool {
        !matches!(self.shape, Shape::Ball(_) | Shape::Ellipsoid(_))
    }

    /// The end of a segment.
    pub fn segment(&self) -> Option<Vector<f64, 6>> {
        if let Shape::Segment(end) = &self.shape { Some(combined(end, &self.axes)) } else { None }
    }

    /// Vectors that span it.
    pub fn span(&self) -> Vec<Vector<f64, 6>> {
        match &self.shape {
            Shape::Ball(_) => self.axes.clone(),
            Shape::Segment(_) => self.segment().into_iter().collect(),
            shape => {
                let sizes = shape.numbers().unwrap_or(&[]);
                self.axes.iter().zip(sizes).filter(|(_, size)| **size > 0.0).map(|(axis, _)| *axis).collect()
            }
        }
    }

    /// A wrench of Q that is farthest along `u`; of several the middle, where Q is a box. Of a segment its end, wherever `u` points.
    pub fn farthest(&self, u: &Vector<f64, 6>) -> Option<Vector<f64, 6>> {
        match &self.shape {
            Shape::Segment(_) => self.segment(),
            Shape::Box(_) if matches!(self.form, Form::Box(_)) => {
                let level = u.map(|x| x.abs() < 1e-6 * u.norm());
                let corner = self.unit().ok()?.mapping(u)?;
                Some(Vector::from_fn(|i, _| if level[i] { 0.0 } else { corner[i] }))
            }
            _ => self.unit().ok()?.mapping(u),
        }
    }

    /// The largest t with t v in Q.
    pub fn reach(&self, v: &Vector<f64, 6>) -> f64 {
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        self.axes.iter().enumerate().for_each(|(k, axis)| matrix.set_column(k, axis));
        let Ok(inverse) = matrix.pseudo_inverse(1e-12) else { return 0.0 };
        let c = inverse * v;
        // Outside of the axes' span.
        if (matrix * c - v).norm() > 1e-9 * v.norm() {
            return 0.0;
        }
        let c: Vec<f64> = c.iter().take(self.axes.len()).map(|x| if x.abs() < 1e-14 { 0.0 } else { *x }).collect();
        self.shape.reach(&c)
    }
}

/// Why the library refuses the numbers of a Q.
fn words(error: ShapeError) -> Trouble {
    match error {
        ShapeError::Negative => "a size is negative".into(),
        ShapeError::NonFinite => "a number is not finite or too large".into(),
        ShapeError::Empty => "it is no more than the origin".into(),
        other => format!("{other:?}"),
    }
}

/// Sum of c_k times axis k.
fn combined(c: &[f64], axes: &[Vector<f64, 6>]) -> Vector<f64, 6> {
    axes.iter().zip(c).fold(Vector::zeros(), |sum, (axis, x)| sum + axis * *x)
}

/// The sizes along the axes of R^6, zero along those that are not named; `None` unless the axes are such axes, each another.
fn padded(sizes: &[f64], axes: &[Vector<f64, 6>]) -> Option<Vector<f64, 6>> {
    let mut padded = Vector::<f64, 6>::zeros();
    let mut named = [false; 6];
    for (axis, size) in axes.iter().zip(sizes) {
        let mut used = (0..6).filter(|&i| axis[i] != 0.0);
        let (Some(i), None) = (used.next(), used.next()) else { return None };
        if std::mem::replace(&mut named[i], true) {
            return None;
        }
        padded[i] = size * axis[i].abs();
    }
    Some(padded)
}

fn ellipsoid(sizes: &[f64], axes: &[Vector<f64, 6>]) -> Result<Form, Trouble> {
    let (mut semi, mut rotation) = (Vector::<f64, 6>::zeros(), SMatrix::<f64, 6, 6>::identity());
    match padded(sizes, axes) {
        Some(sizes) => semi = sizes,
        None => axes.iter().zip(sizes).enumerate().for_each(|(k, (axis, size))| {
            semi[k] = size * axis.norm();
            rotation.set_column(k, &axis.normalize());
        }),
    }
    UnitEllipsoid::new(semi, rotation).map(|q| Form::Ellipsoid(Box::new(q))).map_err(words)
}

fn vertices(points: &[Vec<f64>], axes: &[Vector<f64, 6>]) -> Result<Form, Trouble> {
    let points: Vec<[f64; 6]> = points.iter().map(|c| combined(c, axes).into()).collect();
    Vertices::new(&points).map_err(words)?;
    Ok(Form::Vertices(points))
}

fn check(sizes: &[f64]) -> Result<(), Trouble> {
    let fits = sizes.iter().all(|x| *x >= 0.0);
    if fits { Ok(()) } else { Err(words(ShapeError::Negative)) }
}

/// The corners of a box.
fn corners(sizes: &[f64]) -> Result<Vec<Vec<f64>>, Trouble> {
    check(sizes)?;
    let sign = |bits: usize, k: usize| if bits >> k & 1 == 1 { -1.0 } else { 1.0 };
    Ok((0..1 << sizes.len())
        .map(|bits| sizes.iter().enumerate().map(|(k, size)| size * sign(bits, k)).collect())
        .collect())
}

/// The vertices of a cross-polytope.
fn tips(sizes: &[f64]) -> Result<Vec<Vec<f64>>, Trouble> {
    check(sizes)?;
    let tip = |k: usize, sign: f64| (0..sizes.len()).map(|i| if i == k { sign * sizes[k] } else { 0.0 }).collect();
    Ok((0..sizes.len()).flat_map(|k| [tip(k, 1.0), tip(k, -1.0)]).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(sizes: &[f64]) -> [Shape; 4] {
        let x = sizes.to_vec();
        [Shape::Ellipsoid(x.clone()), Shape::Box(x.clone()), Shape::CrossPolytope(x.clone()), Shape::Segment(x)]
    }

    /// Along turned and stretched axes, h is that of the shape at S u.
    #[test]
    fn support_functions_along_any_axes() {
        let sizes = [2.0, 0.5, 1.5];
        let axes = [[1.0, 2.0, 0.0, 0.0, 1.0, 0.0], [0.0, 1.0, -1.0, 0.5, 0.0, 0.0], [0.3, 0.0, 0.0, 0.0, 0.0, 2.0]];
        let axes = axes.map(Vector::<f64, 6>::from).to_vec();
        let u = -Vector::<f64, 6>::from([0.3, -0.2, 0.9, 0.1, -0.5, 0.4]);
        let c: Vec<f64> = axes.iter().zip(sizes).map(|(axis, size)| axis.dot(&u) * size).collect();
        let want = [
            c.iter().map(|x| x * x).sum::<f64>().sqrt(),
            c.iter().map(|x| x.abs()).sum(),
            c.iter().map(|x| x.abs()).fold(0.0, f64::max),
            c.iter().sum::<f64>().max(0.0),
        ];
        for (shape, want) in shapes(&sizes).into_iter().zip(want) {
            let q = Q::new(shape, Some(axes.clone())).unwrap();
            assert!((q.unit().unwrap().value(&u).unwrap() - want).abs() < 1e-13, "{q:?}");
            let point = q.farthest(&u).unwrap();
            assert!((point.dot(&u) - want).abs() < 1e-13);
            // The wrench that is farthest along u is on the surface.
            assert!((q.reach(&point) - 1.0).abs() < 1e-9, "{q:?}");
        }
    }

    #[test]
    fn coordinate_axes_keep_the_numbers() {
        let axis = |i: usize, length: f64| Vector::<f64, 6>::from_fn(|j, _| if i == j { length } else { 0.0 });
        let q = Q::new(Shape::Box(vec![1.0, 2.0]), Some(vec![axis(5, 1.0), axis(0, -3.0)])).unwrap();
        let u = Vector::from([1.0, 7.0, 0.0, 0.0, 0.0, 10.0]);
        assert_eq!(q.unit().unwrap().value(&u), Ok(16.0));
        assert_eq!(q.farthest(&Vector::from([-1.0, 1.0, 0.0, 0.0, 0.0, 1e-9])), Some(axis(0, -6.0)));
        assert_eq!(q.reach(&axis(1, 1.0)), 0.0);
    }

    #[test]
    fn what_is_no_set_is_refused() {
        for shape in shapes(&[0.0; 6]).into_iter().chain([Shape::Ball(-1.0), Shape::Box(vec![1.0, -1.0])]) {
            let count = shape.numbers().map_or(6, <[f64]>::len);
            let axes = (count != 6).then(|| vec![Vector::from([1.0; 6]), Vector::from([1.0, 0.0, 0.0, 0.0, 0.0, 2.0])]);
            assert!(Q::new(shape.clone(), axes).is_err(), "{shape:?}");
        }
    }
}
