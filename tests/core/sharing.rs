//! Whatever holds no memory of a query may be shared by threads: bodies, shapes, unit sets, what remembers. That this compiles is the test.

use qdist::grasp::{Contact, Finger, Primitive, WrenchFrame, WrenchSet};
use qdist::mesh::Model;
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, Vertices};
use qdist::support::{
    BoxShape, Capsule, Cone, Cylinder, Difference, Ellipsoid, HalfSpace, Hull, HullGraph, Join, Linear, Margin, Point,
    Points, Rigid, Scaled, Sphere, Sum,
};
use qdist::{Answer, Body, Depth, Tracker, Workspace};

const fn is_shared<S: Send + Sync>() {}

const _: () = {
    is_shared::<Body<'_, f64>>();
    is_shared::<Body<'_, f32, 2>>();
    is_shared::<Point<f64, 3>>();
    is_shared::<Sphere<f64, 3>>();
    is_shared::<BoxShape<f64, 3>>();
    is_shared::<Ellipsoid<f64, 3>>();
    is_shared::<Cylinder<f64>>();
    is_shared::<Capsule<f64>>();
    is_shared::<Cone<f64>>();
    is_shared::<Points<'_, f64, 3>>();
    is_shared::<Hull<'_, f64>>();
    is_shared::<Hull<'_, f64, u32>>();
    is_shared::<HullGraph<'_>>();
    is_shared::<HalfSpace<f64, 3>>();
    is_shared::<Join<Sphere<f64, 3>, Point<f64, 3>>>();
    is_shared::<Linear<Sphere<f64, 3>, f64, 3>>();
    is_shared::<Margin<Points<'_, f64, 3>, f64>>();
    is_shared::<Rigid<Sphere<f64, 3>, f64, 3>>();
    is_shared::<Scaled<Sphere<f64, 3>, f64>>();
    is_shared::<Sum<Sphere<f64, 3>, Point<f64, 3>>>();
    is_shared::<Difference<Sphere<f64, 3>, Point<f64, 3>>>();
    is_shared::<Ball<f64>>();
    is_shared::<CrossPolytope<f64, 6>>();
    is_shared::<Segment<f64, 6>>();
    is_shared::<UnitBox<f64, 6>>();
    is_shared::<UnitEllipsoid<f64, 6>>();
    is_shared::<Vertices<'_, f64, 6>>();
    is_shared::<Answer<f64, 6>>();
    is_shared::<Depth<f64>>();
    is_shared::<Tracker<f64, 6>>();
    is_shared::<Workspace<f64, 3, 64, 128>>();
    is_shared::<Contact<f64>>();
    is_shared::<Primitive<f64>>();
    is_shared::<Finger<f64>>();
    is_shared::<WrenchFrame<f64>>();
    is_shared::<WrenchSet<'_, f64>>();
    is_shared::<Model>();
};
