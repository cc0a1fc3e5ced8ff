//! Golden data of grasps: the bits and the work of d for every kind of Q and both norms, alike on every machine. The numbers of the contacts come
//! from sums, products, quotients and roots alone, which no machine rounds in its own way.
use crate::common;
use crate::grasp_common;

use common::dice::Dice;
use common::golden::{Group, compare};
use grasp_common::vector;
use nalgebra::SMatrix;
use qdist::grasp::{Contact, Friction, Norm, Primitive, WrenchFrame, WrenchSet, wrenches};
use qdist::qset::{Ball, CrossPolytope, Segment, UnitBox, UnitEllipsoid, UnitSet};
use qdist::{Options, Real, Vector, Workspace};

/// Fingertips on the unit sphere that press to its middle.
fn fingertips<T: Real>(dice: &mut Dice, count: usize, soft: bool) -> Vec<Contact<T>> {
    let mut place = || loop {
        let v: [f64; 3] = std::array::from_fn(|_| dice.signed());
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        if length > 0.1 {
            return v.map(|x| x / length);
        }
    };
    let mu = T::of(0.5);
    let friction = if soft { Friction::Soft { mu, mus: T::of(0.25) } } else { Friction::Hard { mu } };
    let contact = |p: [f64; 3]| Contact::new(vector(p), vector(p.map(|x| -x)), friction).unwrap();
    (0..count).map(|_| contact(place())).collect()
}

fn units<T: Real>() -> [(&'static str, Box<dyn UnitSet<T, 6>>); 5] {
    let axes = vector([1.0, 0.75, 1.25, 0.5, 0.5, 0.25]);
    [
        ("ball", Box::new(Ball::unit())),
        ("ellipsoid", Box::new(UnitEllipsoid::new(axes, SMatrix::identity()).unwrap())),
        ("box", Box::new(UnitBox::new(axes).unwrap())),
        ("cross", Box::new(CrossPolytope::new(axes).unwrap())),
        ("segment", Box::new(Segment::new(axes).unwrap())),
    ]
}

fn groups<T: Real>(relative: f64) -> Vec<Group> {
    let frame = WrenchFrame::new(Vector::zeros(), T::one()).unwrap();
    let mut memory = Box::new(Workspace::<T, 6, 256, 2048>::new());
    let mut groups = Vec::new();
    for (q, unit) in units::<T>() {
        let mut group = Group::of::<T>(q);
        let mut dice = Dice::new(6);
        for (count, soft) in [(2, true), (3, true), (4, false), (5, true), (8, false)] {
            let contacts = fingertips(&mut dice, count, soft);
            let mut primitives = vec![Primitive::empty(); count];
            let primitives = wrenches(&contacts, &frame, &mut primitives).unwrap();
            for norm in [Norm::L1, Norm::LInf] {
                let options = Options { relative: T::of(relative), max_iterations: Some(300), ..Options::default() };
                group.answer(&memory.solver().solve(&WrenchSet::new(primitives, norm), &*unit, &options));
            }
        }
        groups.push(group);
    }
    groups
}

#[test]
fn qualities_of_fingertips() {
    let all: Vec<_> = groups::<f64>(1e-3).into_iter().chain(groups::<f32>(1e-2)).collect();
    compare("grasp.csv", &all);
}
