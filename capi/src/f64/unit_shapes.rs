//! The unit sets of the library: which set of `qset` a struct of the header stands for.

use super::*;
use qdist::internal::{List, near_unit};
use qdist::qset::{CrossPolytope, Segment, UnitBox, UnitEllipsoid, Vertices};
use qdist::support::ShapeError;

macro_rules! unit {
    ($struct:ty, $set:ident, |$s:ident| $($size:expr),+) => {
        impl<const N: usize> AnswersUnit<N> for $struct {
            type Set<'a> = $set<f64, N>;
            fn stated(&self) -> Check<(Self::Set<'_>, f64)> {
                let $s = self;
                let set = $set::new($($size),+).map_err(from_shape)?;
                Ok((set, set.extent()))
            }
            #[inline(always)]
            fn trusted(&self) -> Check<Self::Set<'_>> {
                let $s = self;
                // A struct that has become one of another dimension is none of this.
                if $s.dimension as usize == N { Ok($set::trusted($($size),+)) } else { Err(QDIST_ERROR_DIMENSION) }
            }
        }
    };
}

unit!(qdist_box_unit_f64, UnitBox, |s| leading(&s.half));
unit!(qdist_cross_unit_f64, CrossPolytope, |s| leading(&s.semi_axes));
unit!(qdist_segment_unit_f64, Segment, |s| leading(&s.end));

/// What is done once, when the unit set is made, is the same code in every dimension; what queries ask is [`UnitEllipsoid`]'s.
impl<const N: usize> AnswersUnit<N> for qdist_ellipsoid_unit_f64 {
    type Set<'a> = UnitEllipsoid<f64, N>;
    fn stated(&self) -> Check<(Self::Set<'_>, f64)> {
        Ok((self.trusted()?, self.extent()?))
    }
    fn inner_radius(&self, _set: &Self::Set<'_>) -> f64 {
        self.within()
    }
    #[inline(always)]
    fn trusted(&self) -> Check<Self::Set<'_>> {
        // A struct that has become one of another dimension is none of this.
        if self.dimension as usize != N {
            return Err(QDIST_ERROR_DIMENSION);
        }
        let rotation = match self.matrix()? {
            None => SMatrix::identity(),
            Some(list) => SMatrix::from_fn(|i, j| list.get(N * i + j).copied().unwrap_or(f64::NAN)),
        };
        Ok(UnitEllipsoid::trusted(leading(&self.semi_axes), rotation))
    }
    fn mirrored(&self, signs: u8) -> bool {
        self.is_mirrored(signs)
    }
}

impl qdist_ellipsoid_unit_f64 {
    fn axes(&self) -> Check<&[f64]> {
        first(&self.semi_axes, dimension(self.dimension)?)
    }

    fn matrix(&self) -> Check<Option<&[f64]>> {
        let n = dimension(self.dimension)?;
        if self.rotation.is_null() { Ok(None) } else { self.rotation.array(Some(n * n)).map(Some) }
    }

    /// An upper bound of |q|, of numbers that are looked at: axes, and columns that are orthonormal to 1e-4, which are longer by less than 6e-4.
    fn extent(&self) -> Check<f64> {
        let (axes, n) = (self.axes()?, dimension(self.dimension)?);
        semi_axes(axes)?;
        if let Some(matrix) = self.matrix()? {
            orthonormal(matrix, n)?;
        }
        length(axes.iter().fold(0.0, |most: f64, &x| most.at_least(x)) * 1.001)
    }

    /// The radius of a ball in it: such columns shorten by less than 6e-4, and where there is no rotation, none can be bent.
    fn within(&self) -> f64 {
        let least = self.axes().unwrap_or_default().iter().fold(f64::HUGE, |least, &x| least.at_most(x));
        if self.rotation.is_null() { least } else { least * 0.999 }
    }

    /// Each axis must stay on its line.
    fn is_mirrored(&self, signs: u8) -> bool {
        let (Ok(n), Ok(matrix)) = (dimension(self.dimension), self.matrix()) else { return false };
        let stays = |matrix: &[f64], j: usize| {
            let column = || matrix.iter().skip(j).step_by(n.max(1)).enumerate().filter(|&(_, &x)| x != 0.0);
            let flipped = column().filter(|(i, _)| signs >> i & 1 == 1).count();
            flipped == 0 || flipped == column().count()
        };
        matrix.is_none_or(|matrix| (0..n).all(|j| stays(matrix, j)))
    }
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

/// The hull of the origin and points that have been looked at before.
pub(super) struct Corners<'a, const N: usize> {
    points: &'a [[f64; N]],
    list: List<'a, f64, N>,
}

impl<const N: usize> Corners<'_, N> {
    /// (Once a dimension, for value and point.)
    #[inline(never)]
    fn farthest(&self, u: &Vector<f64, N>) -> Vector<f64, N> {
        Vector::from(*self.list.scan::<false>(&near_unit(one_by_one(u))))
    }
}

impl<const N: usize> UnitSet<f64, N> for Corners<'_, N> {
    fn value(&self, u: &Vector<f64, N>) -> Result<f64, Failure> {
        Ok(self.farthest(u).dot(u).at_least(0.0))
    }
    fn mapping(&self, u: &Vector<f64, N>) -> Option<Vector<f64, N>> {
        Some(self.farthest(u))
    }
    fn vertex_count(&self) -> usize {
        self.points.len()
    }
    fn vertex(&self, index: usize) -> Vector<f64, N> {
        self.points.get(index).map_or(Vector::zeros(), |&point| Vector::from(point))
    }
    fn error(&self) -> f64 {
        0.0
    }
}

impl<const N: usize> AnswersUnit<N> for qdist_points_f64 {
    type Set<'a> = Corners<'a, N>;
    fn stated(&self) -> Check<(Self::Set<'_>, f64)> {
        let set: Result<_, ShapeError> = Vertices::<f64, N>::new(self.points()?);
        let extent = set.map_err(from_shape)?.extent();
        Ok((self.trusted()?, extent))
    }
    fn trusted(&self) -> Check<Self::Set<'_>> {
        Ok(Corners { points: self.points()?, list: self.list()? })
    }
}
