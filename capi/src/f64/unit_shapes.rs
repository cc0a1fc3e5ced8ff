//! The unit sets of the library: which set of `qset` a struct of the header stands for.

use super::*;
use qdist::internal::{List, near_unit};
use qdist::qset::{CrossPolytope, Segment, UnitBox, UnitEllipsoid, Vertices};
use qdist::support::ShapeError;

macro_rules! unit {
    ($struct:ty, $set:ident, |$s:ident| $($size:expr),+ $(; $($own:tt)+)?) => {
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
            $($($own)+)?
        }
    };
}

unit!(qdist_ellipsoid_unit_f64, UnitEllipsoid, |s| leading(&s.semi_axes), s.rotation()?;
    /// Without a rotation there is none that rounding could have bent.
    fn inner_radius(&self, set: &Self::Set<'_>) -> f64 {
        let axes = self.semi_axes.iter().take(N);
        if self.rotation.is_null() { axes.fold(f64::HUGE, |least, &x| least.at_most(x)) } else { set.inner_radius() }
    }
);
unit!(qdist_box_unit_f64, UnitBox, |s| leading(&s.half));
unit!(qdist_cross_unit_f64, CrossPolytope, |s| leading(&s.semi_axes));
unit!(qdist_segment_unit_f64, Segment, |s| leading(&s.end));

impl qdist_ellipsoid_unit_f64 {
    fn rotation<const N: usize>(&self) -> Check<SMatrix<f64, N, N>> {
        if self.rotation.is_null() {
            return Ok(SMatrix::identity());
        }
        let list = self.rotation.array(Some(N * N))?;
        Ok(SMatrix::from_fn(|i, j| list.get(N * i + j).copied().unwrap_or(f64::NAN)))
    }
}

/// The hull of the origin and points that have been looked at before.
pub(super) struct Corners<'a, const N: usize> {
    points: &'a [[f64; N]],
    list: List<'a, f64, N>,
}

impl<const N: usize> UnitSet<f64, N> for Corners<'_, N> {
    fn value(&self, u: &Vector<f64, N>) -> Result<f64, Failure> {
        Ok(self.mapping(u).map_or(0.0, |point| point.dot(u)).at_least(0.0))
    }
    fn mapping(&self, u: &Vector<f64, N>) -> Option<Vector<f64, N>> {
        Some(Vector::from(*self.list.scan::<false>(&near_unit(one_by_one(u)))))
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
