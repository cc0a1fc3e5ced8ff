//! The problem that gradients look at: a wrench set and a Q in units of their own size.

use super::super::span::Subspace;
use super::super::wrench_set::WrenchSet;
use super::ties::{Matrix6, Vector6};
use crate::math::{Vector, finite, norm};
use crate::qset::UnitSet;
use crate::scalar::Real;
use crate::support::Support;

/// The problem in units of its own size: W divided by `size`, Q by `unit`.
pub(super) struct Problem<'p, 'a, T> {
    pub set: &'p WrenchSet<'a, T>,
    pub q: &'p dyn UnitSet<T, 6>,
    /// The projection onto the span of W.
    pub projector: Matrix6<T>,
    pub span: Option<Subspace<T>>,
    pub size: T,
    pub unit: T,
}

impl<'p, 'a, T: Real> Problem<'p, 'a, T> {
    pub fn new(
        set: &'p WrenchSet<'a, T>,
        q: &'p dyn UnitSet<T, 6>,
        span: Option<Subspace<T>>,
        near: &Vector6<T>,
    ) -> Option<Self> {
        let projector = span.as_ref().map_or(Matrix6::identity(), |span| {
            span.basis().iter().fold(Matrix6::zeros(), |sum, axis| {
                let axis = Vector::from(*axis);
                sum + axis * axis.transpose()
            })
        });
        let (size, unit) = (set.extent(), norm(&q.mapping(near)?));
        let usable = size > T::zero() && size.finite() && unit > T::zero() && unit.finite();
        usable.then_some(Self { set, q, projector, span, size, unit })
    }

    /// The projection of s_Q(u).
    pub fn mapping(&self, u: &Vector6<T>) -> Option<Vector6<T>> {
        let point = self.projector * self.q.mapping(u)? / self.unit;
        finite(&point).then_some(point)
    }

    /// The Hessian of h_Q in the span, by central differences.
    pub fn unit_hessian(&self, u: &Vector6<T>) -> Option<Matrix6<T>> {
        let h = T::ROUNDOFF.root().root();
        let mut hessian = Matrix6::zeros();
        for i in 0..6 {
            let axis = Vector6::from(self.projector.data.0[i]);
            if axis.iter().all(|x| x.is_zero()) {
                continue;
            }
            let change = self.mapping(&(u + axis * h))? - self.mapping(&(u - axis * h))?;
            hessian.data.0[i] = (change / (h + h)).data.0[0];
        }
        let symmetric = (hessian + hessian.transpose()) * T::of(0.5);
        // The differences of a polytope that steps from one vertex to the next are no derivatives.
        Some(if self.q.vertex_count() > 0 { Matrix6::zeros() } else { symmetric })
    }

    /// Does one point of Q alone attain h_Q near u?
    pub fn is_sharp(&self, u: &Vector6<T>) -> bool {
        let h = T::ROUNDOFF.root();
        let still = |axis: Vector6<T>| {
            let ends = (self.mapping(&(u + axis * h)), self.mapping(&(u - axis * h)));
            // A smooth Q moves by h times its Hessian, a polytope jumps by a good part of its size.
            matches!(ends, (Some(a), Some(b)) if norm(&(a - b)) <= T::of(1e-2))
        };
        (0..6).all(|i| still(Vector6::from(self.projector.data.0[i])))
    }

    /// Another minimiser, where W and Q are their own mirror images and u is not. (The solver looks at one of them.)
    pub fn mirror_image(&self, u: &Vector6<T>) -> Option<Vector6<T>> {
        let image = |bits: u8| Vector6::from_fn(|i, _| if bits >> i & 1 == 1 { -u[i] } else { u[i] });
        let differs = |bits: &u8| norm(&(image(*bits) - u)) > T::ROUNDOFF.root();
        let is_image = |bits: &u8| self.q.mirrored(*bits) && self.set.mirrored(*bits);
        (1..64).filter(differs).find(is_image).map(image)
    }

    /// h_W(u) / h_Q(u), and h_Q(u), in the caller's units.
    pub fn ratio(&self, u: &Vector6<T>) -> Option<(T, T)> {
        let unit = self.q.value(u).ok()?;
        let ratio = self.set.value(u) / unit;
        (unit > T::zero() && ratio.finite()).then_some((ratio, unit))
    }
}
