//! Which plan finds the depth of two bodies: what their shapes need, and no more.
//!
//! A shape names its route, a pair takes that of the body that needs more. Nothing but a route refers to its plan's code: a program of boxes has
//! that of boxes, and none that expands a polytope; one without bodies of revolution searches for no arcs.

use core::fmt;

use super::answer::Depth;
use super::body::Body;
use super::boxes;
use super::pair::Pair;
use crate::query::Options;
use crate::scalar::Real;
use crate::solver::Solver;

/// What a body needs to be measured, from little to much: a plan serves all bodies that need less as well.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Need {
    /// The axes of two boxes.
    Boxes,
    /// Expansion: any convex body.
    Expansion,
    /// A look whether both bodies turn about one axis, then expansion.
    Axis,
    /// A closed form, where the other one is an ellipsoid as well; else expansion.
    Ellipsoid,
    /// A look for arcs of minimisers around an axis (module `arcs`).
    Arcs,
}

/// How depth is found for a body ([`Support::route`](crate::support::Support::route)).
#[derive(Clone, Copy)]
pub struct Route<T: Real> {
    pub(super) need: Need,
    find: Find<T>,
    /// The function that makes this: C carries it.
    made_by: fn() -> Self,
}

type Find<T> = fn(&mut Solver<'_, T, 3>, &Body<'_, T>, &Body<'_, T>, &Options<'_, T, 3>) -> Depth<T>;

impl<T: Real> Route<T> {
    /// For a box: with another one, the axes of both. (With anything else, that one's route is taken.)
    pub(crate) fn boxes() -> Self {
        Route { need: Need::Boxes, find: |_, a, b, options| boxes::depth(a, b, options), made_by: Self::boxes }
    }

    /// For any set: expansion.
    pub fn expansion() -> Self {
        let find: Find<T> = |solver, a, b, options| match Pair::new(a, b) {
            Ok(pair) => solver.expand_pair(&pair, pair.calls(), options),
            Err(failure) => Depth::failed(failure),
        };
        Route { need: Need::Expansion, find, made_by: Self::expansion }
    }

    /// For a set that may turn about the z axis of its frame ([`Symmetry::Axis`](crate::support::Symmetry::Axis)): with another one about the same axis it is
    /// measured in a plane.
    pub fn axis() -> Self {
        let find: Find<T> = |solver, a, b, options| {
            solver.depth_about_axis(a, b, options, |solver, pair, _, calls| solver.expand_pair(pair, calls, options))
        };
        Route { need: Need::Axis, find, made_by: Self::axis }
    }

    /// For an ellipsoid of different axes.
    pub(crate) fn ellipsoid() -> Self {
        let find: Find<T> = |solver, a, b, options| {
            solver.depth_about_axis(a, b, options, |solver, pair, _, calls| {
                solver.depth_with_ellipsoid(pair, calls, options)
            })
        };
        Route { need: Need::Ellipsoid, find, made_by: Self::ellipsoid }
    }

    /// For a set that turns: arcs of minimisers around its axis are searched for (a corner of the other body on the axis, a second axis nearby), which else
    /// need thousands of facets.
    pub fn arcs() -> Self {
        let find: Find<T> = |solver, a, b, options| {
            solver.depth_about_axis(a, b, options, |solver, pair, axis, calls| {
                solver.depth_with_arcs(pair, axis, calls, options)
            })
        };
        Route { need: Need::Arcs, find, made_by: Self::arcs }
    }

    /// Takes that of the body that needs more.
    pub(super) fn find(
        routes: [Self; 2],
        solver: &mut Solver<'_, T, 3>,
        a: &Body<'_, T>,
        b: &Body<'_, T>,
        options: &Options<'_, T, 3>,
    ) -> Depth<T> {
        let [x, y] = routes;
        (if y.need > x.need { y.find } else { x.find })(solver, a, b, options)
    }

    /// As a pointer that C can carry.
    #[doc(hidden)]
    pub fn into_raw(self) -> unsafe extern "C" fn() {
        // SAFETY: function pointers are alike; this one is not called before `from_raw` has turned it back.
        unsafe { core::mem::transmute::<fn() -> Self, unsafe extern "C" fn()>(self.made_by) }
    }

    /// Back from there.
    ///
    /// # Safety
    /// The pointer comes from `into_raw` of the same scalar type.
    #[doc(hidden)]
    pub unsafe fn from_raw(raw: unsafe extern "C" fn()) -> Self {
        // SAFETY: the caller's promise.
        let make = unsafe { core::mem::transmute::<unsafe extern "C" fn(), fn() -> Self>(raw) };
        make()
    }
}

impl<T: Real> fmt::Debug for Route<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Route").field("need", &self.need).finish_non_exhaustive()
    }
}
