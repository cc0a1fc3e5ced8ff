//! The axis that two bodies turn about both.

use super::answer::Depth;
use super::body::{Body, skew};
use super::pair::Pair;
use super::second_look::is_shallow;
use crate::math::{Vector, norm};
use crate::qset::Ball;
use crate::query::answer::Answer;
use crate::query::{Options, Query};
use crate::scalar::Real;
use crate::solver::Solver;
use crate::support::{Support, Symmetry};

/// Lengths that an axis may be off, in roundoffs of the bodies' extents: what poses computed from one another are.
pub(super) const AXIS_ROUNDOFFS: usize = 64;

/// Two axes are as good as one if what they are off is this share of the relative tolerance.
pub(super) const NEARLY_COAXIAL: f64 = 0.0625;

/// The axis of two bodies of revolution, or of one and a ball.
#[derive(Clone, Copy)]
pub(crate) struct Axis<T: Real> {
    /// A unit vector along the first body's.
    pub(super) along: Vector<T, 3>,
    /// How far the second axis, or the second body's anchor, is off the first: the angle, plus the length as a share of the extents.
    aside: T,
    /// How far the matrices are from rotations.
    stretched: T,
}

impl<T: Real> Axis<T> {
    /// Is it theirs up to rounding?
    pub(super) fn is_common(&self) -> bool {
        self.aside <= T::count(AXIS_ROUNDOFFS) * T::ROUNDOFF
    }

    /// Is this direction the axis', or nearly so? Else the minimisers are a circle around it.
    pub(super) fn has_pole(&self, direction: &Vector<T, 3>) -> bool {
        !(direction.dot(&self.along).abs() < T::of(0.99))
    }
}

impl<T: Real> Pair<'_, '_, T, 3> {
    /// The axis that both bodies turn about, up to rounding or up to `near`.
    pub(super) fn axis(&self, near: T) -> Option<Axis<T>> {
        let axis = |body: &Body<'_, T>| body.rotation.column(2).into_owned();
        let (first, second) = match (self.a.shape.symmetry(), self.b.shape.symmetry()) {
            (Symmetry::Axis, Symmetry::Axis) => (axis(self.a), axis(self.b)),
            (Symmetry::Axis, Symmetry::Full) => (axis(self.a), axis(self.a)),
            (Symmetry::Full, Symmetry::Axis) => (axis(self.b), axis(self.b)),
            _ => return None,
        };
        let aside = norm(&first.cross(&second)) + norm(&first.cross(&self.offset)) / self.extent;
        let roundoff = T::count(AXIS_ROUNDOFFS) * T::ROUNDOFF;
        if !(aside <= roundoff.at_least(near)) || self.on_a.center.is_some() || self.on_b.center.is_some() {
            return None;
        }
        let stretched = skew(&self.a.rotation).at_least(skew(&self.b.rotation));
        (stretched <= roundoff).then(|| Axis { along: first * (T::one() / norm(&first)), aside, stretched })
    }
}

impl<T: Real> Solver<'_, T, 3> {
    /// The depth in a plane, where both bodies turn about one axis; else what `otherwise` finds.
    pub(super) fn depth_about_axis(
        &mut self,
        a: &Body<'_, T>,
        b: &Body<'_, T>,
        options: &Options<'_, T, 3>,
        otherwise: impl FnOnce(&mut Self, &mut Pair<'_, '_, T, 3>, Option<Axis<T>>, u32) -> Depth<T>,
    ) -> Depth<T> {
        let mut pair = match Pair::new(a, b) {
            Ok(pair) => pair,
            Err(failure) => return Depth::failed(failure),
        };
        let mut calls = pair.calls();
        let axis = pair.axis(options.relative * T::of(NEARLY_COAXIAL));
        if let Some(axis) = axis.filter(Axis::is_common)
            && let Some(answer) = self.depth_on_axis(&mut pair, &axis, &mut calls, options)
        {
            // (What a plane of one word leaves open in shallow contact, expansion in two may close: at a pole, where no circle is to be tiled.)
            return if is_shallow(&answer) && axis.has_pole(&answer.direction) {
                self.conclude_pair(&pair, &answer, &pair.aimed(options))
            } else {
                Depth::new(&answer, &pair)
            };
        }
        otherwise(self, &mut pair, axis, calls)
    }

    /// The answer in a plane of the axis, as if both bodies turned about it: what they are off goes into the error. Adds to the support calls.
    pub(super) fn depth_on_axis(
        &mut self,
        pair: &mut Pair<'_, '_, T, 3>,
        axis: &Axis<T>,
        calls: &mut u32,
        options: &Options<'_, T, 3>,
    ) -> Option<Answer<T, 3>> {
        // Putting the second body on the axis moves its points by at most `aside` times the extents, making both matrices rotations by 1.5
        // `stretched` times those. What is asked in one plane is moved once, and once more where it stands for another plane: twice the sum.
        // The roundoffs are those of measuring it.
        let moved = axis.aside + axis.stretched + axis.stretched + T::count(4) * T::ROUNDOFF;
        let before = pair.charge(moved * T::of(2.1) * pair.extent);
        let ball = Ball::unit();
        let (mut query, checked) = Query::new(&*pair, &ball, pair.radius(), *options);
        query.count_calls(*calls);
        let ready = checked.and_then(|()| query.normalize()).is_ok();
        let answer = if ready { self.solve_meridian(&mut query, &axis.along) } else { None };
        *calls = query.support_calls();
        pair.discharge(before);
        answer
    }
}
