//! The unit sets of the library: what each one answers, for dimensions that are known at run time only.

use super::*;

/// Structs of one number for each dimension: those that count.
macro_rules! numbers {
    ($($struct:ty, $field:ident;)*) => {
        $(impl $struct {
            fn $field(&self) -> Check<&[f64]> {
                first(&self.$field, dimension(self.dimension)?)
            }
        })*
    };
}

numbers! {
    qdist_ellipsoid_unit_f64, semi_axes;
    qdist_box_unit_f64, half;
    qdist_cross_unit_f64, semi_axes;
    qdist_segment_unit_f64, end;
}

/// Those that are above 0, with their places.
fn positive(list: &[f64]) -> impl Iterator<Item = (usize, &f64)> {
    list.iter().enumerate().filter(|&(_, &x)| x > 0.0)
}

/// The smallest of some numbers >= 0.
fn least(list: &[f64]) -> f64 {
    list.iter().fold(f64::HUGE, |least, &x| least.at_most(x))
}

// ------------------------------------------------------------------------------------------------- ellipsoid

impl qdist_ellipsoid_unit_f64 {
    fn rotation(&self) -> Check<Option<&[f64]>> {
        let n = dimension(self.dimension)?;
        if self.rotation.is_null() { Ok(None) } else { self.rotation.array(Some(n * n)).map(Some) }
    }
}

/// Component `i` of R^T u.
#[inline(always)]
fn along(rotation: Option<&[f64]>, i: usize, u: &[f64]) -> f64 {
    match rotation {
        None => u.get(i).copied().unwrap_or(0.0),
        Some(matrix) => matrix.iter().skip(i).step_by(u.len().max(1)).zip(u).fold(0.0, |s, (&r, &x)| s + r * x),
    }
}

impl Dimensioned for qdist_ellipsoid_unit_f64 {
    fn dimension(&self) -> Check<usize> {
        dimension(self.dimension)
    }
    /// Each axis must stay on its line.
    fn mirrored(&self, signs: u8) -> bool {
        let (Ok(axes), Ok(rotation)) = (self.semi_axes(), self.rotation()) else { return false };
        let n = axes.len();
        let stays = |matrix: &[f64], j: usize| {
            let touched = |flipped: bool| {
                let column = matrix.iter().skip(j).step_by(n.max(1)).enumerate();
                column.filter(|&(i, _)| (signs >> i & 1 == 1) == flipped).any(|(_, &x)| x != 0.0)
            };
            !(touched(true) && touched(false))
        };
        rotation.is_none_or(|matrix| (0..n).all(|j| stays(matrix, j)))
    }
}

impl AnswersUnit for qdist_ellipsoid_unit_f64 {
    /// |D R^T u|, with the axes divided by the largest, so that squares stay in range.
    fn value(&self, u: &[f64]) -> Check<f64> {
        let (axes, rotation) = (self.semi_axes()?, self.rotation()?);
        let size = largest(axes);
        let mut squares = 0.0;
        for (i, &axis) in axes.iter().enumerate() {
            let y = axis / size * along(rotation, i, u);
            squares += y * y;
        }
        Ok(size * squares.root())
    }
    /// R D^2 R^T u / |D R^T u|, likewise.
    fn point(&self, u: &[f64]) -> Check<[f64; MAX_DIMENSION]> {
        let (axes, rotation) = (self.semi_axes()?, self.rotation()?);
        let size = largest(axes);
        let inner = padded(axes.iter().enumerate().map(|(i, &axis)| axis / size * along(rotation, i, u)));
        let length = dot(&inner, &inner).root();
        if !(length > 0.0) {
            return Err(QDIST_ERROR_ARGUMENT);
        }
        let local = padded(axes.iter().zip(&inner).map(|(&axis, &x)| axis * (x / length)));
        Ok(match rotation {
            None => local,
            Some(matrix) => padded(matrix.chunks_exact(axes.len().max(1)).map(|row| dot(row, &local))),
        })
    }
}

pub(super) fn fill_ellipsoid(unit: Out<qdist_unit_f64>, shape: In<qdist_ellipsoid_unit_f64>) -> Check {
    let ellipsoid = shape.get()?;
    let (axes, rotation) = (ellipsoid.semi_axes()?, ellipsoid.rotation()?);
    semi_axes(axes)?;
    let least = least(axes);
    let inner_radius = match rotation {
        // Columns that are orthonormal to 1e-4 shorten by less than 6e-4.
        Some(rotation) => orthonormal(rotation, axes.len()).map(|()| least * 0.999)?,
        None => least,
    };
    let extent = length(largest(axes) * 1.001)?;
    let stated = qdist_unit_f64 { extent, inner_radius, dimension: ellipsoid.dimension, ..qdist_unit_f64::ZERO };
    AnswersUnit::fill(&unit, shape, stated, true)
}

/// Are the columns of a row-major matrix orthonormal to 1e-4?
fn orthonormal(matrix: &[f64], n: usize) -> Check {
    finite(matrix)?;
    for i in 0..n {
        for j in 0..=i {
            let column = |k: usize| matrix.iter().skip(k).step_by(n.max(1));
            let product = column(i).zip(column(j)).fold(0.0, |s, (&x, &y)| s + x * y);
            let off: f64 = if i == j { product - 1.0 } else { product };
            if !(off.abs() <= 1e-4) {
                return Err(QDIST_ERROR_ROTATION);
            }
        }
    }
    Ok(())
}

// ------------------------------------------------------------------------------------------------- box

impl AnswersUnit for qdist_box_unit_f64 {
    fn value(&self, u: &[f64]) -> Check<f64> {
        Ok(self.half()?.iter().zip(u).fold(0.0, |s, (&h, &x)| s + h * x.abs()))
    }
    fn point(&self, u: &[f64]) -> Check<[f64; MAX_DIMENSION]> {
        Ok(padded(self.half()?.iter().zip(u).map(|(&h, &x)| if x < 0.0 { -h } else { h })))
    }
    /// In Gray code: one coordinate changes at a time.
    fn vertex(&self, index: usize) -> Check<[f64; MAX_DIMENSION]> {
        let mut code = index ^ (index >> 1);
        Ok(padded(self.half()?.iter().map(|&h| {
            let negative = h > 0.0 && code & 1 == 1;
            code >>= u32::from(h > 0.0);
            if negative { -h } else { h }
        })))
    }
}

pub(super) fn fill_box(unit: Out<qdist_unit_f64>, shape: In<qdist_box_unit_f64>) -> Check {
    let cuboid = shape.get()?;
    let half = cuboid.half()?;
    semi_axes(half)?;
    let stated = qdist_unit_f64 {
        mirrored: Some(mirrored_always),
        extent: length(reach(half, half.len()))?,
        inner_radius: least(half),
        vertex_count: 1 << (positive(half).count() as u32),
        dimension: cuboid.dimension,
        ..qdist_unit_f64::ZERO
    };
    AnswersUnit::fill(&unit, shape, stated, false)
}

// ------------------------------------------------------------------------------------------------- cross-polytope

impl AnswersUnit for qdist_cross_unit_f64 {
    fn value(&self, u: &[f64]) -> Check<f64> {
        Ok(self.semi_axes()?.iter().zip(u).fold(0.0, |m: f64, (&s, &x)| m.at_least(s * x.abs())))
    }
    fn point(&self, u: &[f64]) -> Check<[f64; MAX_DIMENSION]> {
        let (axes, best) = (self.semi_axes()?, self.value(u)?);
        let mut done = false;
        Ok(padded(axes.iter().zip(u).map(|(&s, &x)| {
            let here = !done && s * x.abs() == best;
            done |= here;
            match (here, x < 0.0) {
                (false, _) => 0.0,
                (true, true) => -s,
                (true, false) => s,
            }
        })))
    }
    fn vertex(&self, index: usize) -> Check<[f64; MAX_DIMENSION]> {
        let axes = self.semi_axes()?;
        let (axis, _) = positive(axes).nth(index / 2).ok_or(QDIST_ERROR_ARGUMENT)?;
        let sign = if index % 2 == 1 { -1.0 } else { 1.0 };
        Ok(padded(axes.iter().enumerate().map(|(i, &s)| if i == axis { sign * s } else { 0.0 })))
    }
}

pub(super) fn fill_cross(unit: Out<qdist_unit_f64>, shape: In<qdist_cross_unit_f64>) -> Check {
    let cross = shape.get()?;
    let axes = cross.semi_axes()?;
    semi_axes(axes)?;
    // The ball touches the facet with the normal 1 / axes.
    let least = least(axes);
    let sum = axes.iter().fold(0.0, |sum, &x| sum + (least / x) * (least / x));
    let slack = f64::count(4 * MAX_DIMENSION) * f64::ROUNDOFF;
    let stated = qdist_unit_f64 {
        mirrored: Some(mirrored_always),
        extent: length(largest(axes))?,
        inner_radius: if least > 0.0 { least / sum.root() * (1.0 - slack) } else { 0.0 },
        vertex_count: 2 * positive(axes).count() as u32,
        dimension: cross.dimension,
        ..qdist_unit_f64::ZERO
    };
    AnswersUnit::fill(&unit, shape, stated, false)
}

// ------------------------------------------------------------------------------------------------- segment

impl AnswersUnit for qdist_segment_unit_f64 {
    fn value(&self, u: &[f64]) -> Check<f64> {
        Ok(dot(self.end()?, u).at_least(0.0))
    }
    fn point(&self, u: &[f64]) -> Check<[f64; MAX_DIMENSION]> {
        // Behind, the origin touches the plane: no direction to look in.
        if dot(self.end()?, u) > 0.0 { self.vertex(0) } else { Err(QDIST_ERROR_ARGUMENT) }
    }
    fn vertex(&self, _index: usize) -> Check<[f64; MAX_DIMENSION]> {
        Ok(padded(self.end()?.iter().copied()))
    }
}

pub(super) fn fill_segment(unit: Out<qdist_unit_f64>, shape: In<qdist_segment_unit_f64>) -> Check {
    let segment = shape.get()?;
    let end = segment.end()?;
    let extent = some_reach(end, end.len())?;
    AnswersUnit::fill(
        &unit,
        shape,
        qdist_unit_f64 { extent, vertex_count: 1, dimension: segment.dimension, ..qdist_unit_f64::ZERO },
        false,
    )
}

// ------------------------------------------------------------------------------------------------- vertices

impl AnswersUnit for qdist_points_f64 {
    fn value(&self, u: &[f64]) -> Check<f64> {
        Ok(dot(best(self, u)?, u).at_least(0.0))
    }
    fn point(&self, u: &[f64]) -> Check<[f64; MAX_DIMENSION]> {
        Ok(padded(best(self, u)?.iter().copied()))
    }
    fn vertex(&self, index: usize) -> Check<[f64; MAX_DIMENSION]> {
        let n = dimension(self.dimension)?;
        let vertex = self.coordinates()?.chunks_exact(n).nth(index).ok_or(QDIST_ERROR_ARGUMENT)?;
        Ok(padded(vertex.iter().copied()))
    }
}

fn best<'a>(points: &'a qdist_points_f64, u: &[f64]) -> Check<&'a [f64]> {
    let found = farthest(points.coordinates()?, u.len(), in_range(u, &mut [0.0; MAX_DIMENSION]));
    found.map(|(_, best)| best).ok_or(QDIST_ERROR_ARGUMENT)
}

pub(super) fn fill_vertices(unit: Out<qdist_unit_f64>, shape: In<qdist_points_f64>) -> Check {
    let points = shape.get()?;
    let n = dimension(points.dimension)?;
    let extent = some_reach(points.coordinates()?, n)?;
    let stated =
        qdist_unit_f64 { extent, vertex_count: points.count, dimension: points.dimension, ..qdist_unit_f64::ZERO };
    AnswersUnit::fill(&unit, shape, stated, false)
}

/// The reach of points that are not all zero.
fn some_reach(list: &[f64], n: usize) -> Check<f64> {
    coordinates(list)?;
    if largest(list) > 0.0 { length(reach(list, n)) } else { Err(QDIST_ERROR_ARGUMENT) }
}
