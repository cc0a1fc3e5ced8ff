//! The shared grasps: support functions at the reference directions, active sets, dimensions.
//! The data lie beside the project (`../shared/data/grasps`).
use crate::common;
use crate::grasp_common;

use common::memory::Memory;
use grasp_common::{recorded, vector};
use nalgebra::SMatrix;
use qdist::grasp::{
    ActiveForces, Contact, Friction, HandContact, Jacobian, Norm, Primitive, Refined, Subspace, WrenchFrame, WrenchSet,
    active_wrenches, default_tolerance, wrenches,
};
use qdist::qset::Ball;
use qdist::{Options, Real, Vector};
use serde_json::Value;

fn numbers(v: &Value) -> Vec<f64> {
    v.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

/// The rows of a matrix.
fn rows(v: &Value) -> Vec<Vec<f64>> {
    v.as_array().unwrap().iter().map(numbers).collect()
}

/// Column `j` of the 6 x k matrix with these rows.
fn column(rows: &[Vec<f64>], j: usize) -> Vector<f64, 6> {
    Vector::from_fn(|i, _| rows[i][j])
}

/// M M^T of the 6 x k matrix with these rows.
fn square(rows: &[Vec<f64>]) -> SMatrix<f64, 6, 6> {
    SMatrix::from_fn(|i, j| rows[i].iter().zip(&rows[j]).map(|(a, b)| a * b).sum())
}

/// The direction of a reference in the coordinates of its Q. For an ellipsoid Q = D B the data have the unit vector D u.
fn local_direction(r: &Value) -> Vec<f64> {
    let u = numbers(&r["direction"]);
    match r["Q"]["semi_axes"].as_array() {
        Some(_) => u.iter().zip(numbers(&r["Q"]["semi_axes"])).map(|(x, a)| x / a).collect(),
        None => u,
    }
}

/// The direction of a reference as one of R^6: its coordinates refer to the columns of R, or to the rows of S, if there
/// are any.
fn direction(r: &Value) -> Vector<f64, 6> {
    let u = local_direction(r);
    let sum = |axis: &dyn Fn(usize) -> Vector<f64, 6>| (0..u.len()).map(|k| axis(k) * u[k]).sum();
    if !r["R"].is_null() {
        let basis = rows(&r["R"]);
        sum(&|k| column(&basis, k))
    } else if !r["Q"]["S"].is_null() {
        let basis = rows(&r["Q"]["S"]);
        sum(&|k| Vector::from_column_slice(&basis[k]))
    } else {
        Vector::from_column_slice(&u)
    }
}

fn contact<T: Real>(v: &Value) -> HandContact<T> {
    let point = |key: &str| vector::<T, 3>(numbers(&v[key]).try_into().unwrap());
    let number = |key: &str| T::of(v[key].as_f64().unwrap());
    let friction = match v["type"].as_str().unwrap() {
        "soft" => Friction::Soft { mu: number("mu"), mus: number("mus") },
        "hard" => Friction::Hard { mu: number("mu") },
        "frictionless" => Friction::Frictionless,
        other => panic!("contact type {other}"),
    };
    let contact = Contact::new(point("p"), point("n"), friction).unwrap();
    let contact = contact.with_tangents(point("o"), point("t")).unwrap();
    let jacobian = v["J"].as_array().map(|rows| {
        let rows: Vec<Vec<T>> = rows.iter().map(|row| numbers(row).into_iter().map(T::of).collect()).collect();
        Jacobian::new([&rows[0], &rows[1], &rows[2], &rows[3]]).unwrap()
    });
    HandContact { contact, jacobian }
}

/// What is read from a grasp: passive and active primitives, in the data's own scaled units.
struct Grasp<T: Real> {
    id: String,
    hand: Vec<HandContact<T>>,
    passive: Vec<Primitive<T>>,
    active: Vec<Primitive<T>>,
}

fn frame<T: Real>() -> WrenchFrame<T> {
    WrenchFrame::new(Vector::zeros(), T::one()).unwrap()
}

fn read<T: Real>(v: &Value) -> Grasp<T> {
    let hand: Vec<HandContact<T>> = v["contacts"].as_array().unwrap().iter().map(contact).collect();
    let contacts: Vec<Contact<T>> = hand.iter().map(|c| c.contact).collect();
    let mut memory = vec![Primitive::empty(); hand.len()];
    let passive = wrenches(&contacts, &frame(), &mut memory).unwrap().to_vec();
    let active = active_wrenches(&hand, &frame(), default_tolerance(), &mut memory).unwrap().to_vec();
    Grasp { id: v["id"].as_str().unwrap().to_string(), hand, passive, active }
}

/// The norm of `refs` entry `r`.
fn norm(r: &Value) -> Norm {
    match r["norm"].as_str().unwrap() {
        "L1" => Norm::L1,
        "Linf" => Norm::LInf,
        other => panic!("norm {other}"),
    }
}

/// h_Q at the reference's own direction.
fn unit(q: &Value, u: &[f64]) -> f64 {
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let scaled = |key: &str| -> Vec<f64> { numbers(&q[key]).iter().zip(u).map(|(a, x)| (a * x).abs()).collect() };
    match q["type"].as_str().unwrap() {
        "ball" => norm(u),
        "ellipsoid" => norm(&scaled("semi_axes")),
        "box" => scaled("half_widths").iter().sum(),
        "cross_polytope" => scaled("half_axes").iter().copied().fold(0.0, f64::max),
        "segment" => numbers(&q["wrench"]).iter().zip(u).map(|(a, x)| a * x).sum::<f64>().max(0.0),
        other => panic!("Q {other}"),
    }
}

/// h_W(direction) / h_Q(direction) is d, for every reference with a direction.
fn values<T: Real>(tolerance: f64) {
    let grasps = recorded();
    let (mut smooth, mut others, mut active) = (0, 0, 0);
    let mut widest = 0.0f64;
    for v in &grasps {
        let grasp = read::<T>(v);
        for r in v["refs"].as_array().unwrap() {
            if r["direction"].is_null() {
                continue;
            }
            let is_active = r["set"] == "Wa";
            let primitives = if is_active { &grasp.active } else { &grasp.passive };
            let set = WrenchSet::new(primitives, norm(r));
            let u = vector::<T, 6>(direction(r).into());
            let (found, d) = (set.value(&u).to_f64() / unit(&r["Q"], &local_direction(r)), r["d"].as_f64().unwrap());
            let kind = r["Q"]["type"].as_str().unwrap();
            assert!((found - d).abs() <= tolerance * d, "{} {} {:?} {kind}: {found} {d}", grasp.id, r["set"], norm(r));
            if d > 0.0 {
                widest = widest.max((found - d).abs() / d);
            }
            *if kind == "ball" || kind == "ellipsoid" { &mut smooth } else { &mut others } += 1;
            active += usize::from(is_active);
        }
    }
    println!("{smooth} references with ball or ellipsoid, {others} others, {active} of them active: to {widest:.1e}");
    assert!(smooth >= 30 && others >= 15 && active >= 12);
}

#[test]
#[ignore = "needs ../shared/data"]
fn values_at_the_reference_directions_in_f64() {
    values::<f64>(1e-8);
}

#[test]
#[ignore = "needs ../shared/data"]
fn values_at_the_reference_directions_in_f32() {
    values::<f32>(2e-5);
}

/// Ranks, emptiness, centers, discs and the dimension of W^a.
#[test]
#[ignore = "needs ../shared/data"]
fn active_sets_are_those_of_the_references() {
    let grasps = recorded();
    let (mut sets, mut spans) = (0, 0);
    for v in &grasps {
        let grasp = read::<f64>(v);
        for r in v["refs"].as_array().unwrap().iter().filter(|r| !r["dim"].is_null()) {
            let dimension = r["dim"].as_u64().unwrap() as usize;
            let subspace = Subspace::new(&grasp.active, default_tolerance()).unwrap();
            assert_eq!(subspace.dimension(), dimension, "{}", grasp.id);
            // The same subspace: every basis vector of one lies in the other.
            for k in 0..dimension {
                assert!(subspace.distance(&column(&rows(&r["R"]), k)) < 1e-9, "{}", grasp.id);
            }
            spans += 1;
            for (rank, c) in numbers(&r["ranks"]).iter().zip(&grasp.hand) {
                let jacobian = c.jacobian.unwrap();
                assert_eq!(jacobian.rank(1.0, default_tolerance()), Ok(*rank as usize));
            }
            let Some(references) = r["contacts"].as_array() else { continue };
            for ((want, c), primitive) in references.iter().zip(&grasp.hand).zip(&grasp.active) {
                let forces =
                    ActiveForces::new(&c.contact, &c.jacobian.unwrap(), &frame(), default_tolerance()).unwrap();
                assert_eq!(forces.rank(), want["rank"].as_u64().unwrap() as usize);
                assert_eq!(primitive.is_empty(), want["empty"].as_bool().unwrap());
                assert_eq!(forces.dimension(), want["dim_U"].as_u64().map(|d| d as usize));
                if !primitive.is_empty() {
                    let center = Vector::<f64, 6>::from_column_slice(&numbers(&want["c"]));
                    assert!((primitive.center() - center).amax() < 1e-9, "{}", grasp.id);
                    let disc = primitive.disc() * primitive.disc().transpose();
                    assert!((disc - square(&rows(&want["M"]))).amax() < 1e-9, "{}", grasp.id);
                }
                sets += 1;
            }
        }
    }
    println!("{sets} active sets, {spans} subspaces");
    assert!(sets >= 10 && spans >= 6);
}

/// The lock on a joint takes force closure away, W^a has a direction with h = 0; the free hand has none near it.
#[test]
#[ignore = "needs ../shared/data"]
fn a_grasp_that_does_not_hold_has_a_direction_without_resistance() {
    let grasps = recorded();
    let mut found = 0;
    for v in &grasps {
        let grasp = read::<f64>(v);
        for r in v["refs"].as_array().unwrap().iter().filter(|r| r["force_closure"] == false) {
            let u = direction(r);
            let primitives = if r["set"] == "Wa" { &grasp.active } else { &grasp.passive };
            assert_eq!(WrenchSet::new(primitives, norm(r)).value(&u), 0.0, "{}", grasp.id);
            found += 1;
        }
    }
    assert!(found >= 2);
}

/// From an answer known to 1 %, the references themselves: to 1e-9, where the refined minimum is smooth.
#[test]
#[ignore = "needs ../shared/data"]
fn refined_answers_are_the_references() {
    let grasps = recorded();
    let (mut compared, mut kinks) = (0, 0);
    for v in &grasps {
        let grasp = read::<f64>(v);
        for r in v["refs"].as_array().unwrap() {
            let d = r["d"].as_f64().unwrap();
            if r["Q"]["type"] != "ball" || !r["Q"]["S"].is_null() || !(d > 1e-6) {
                continue;
            }
            let primitives = if r["set"] == "Wa" { &grasp.active } else { &grasp.passive };
            let (set, ball) = (WrenchSet::new(primitives, norm(r)), Ball::unit());
            let options = Options { relative: 1e-2, ..Options::default() };
            let mut memory = Memory::new::<f64, 6>(4096, 4096);
            let answer = memory.solver::<f64, 6>().solve_in_span(&set, &ball, &options);
            let refined = Refined::new(&set, &ball, &answer);
            let found = set.value(&refined.answer.direction);
            assert!(found >= d * (1.0 - 1e-9), "{} {} {found} {d}", grasp.id, r["set"]);
            assert!(refined.answer.lower <= d && d <= refined.answer.upper + 1e-9 * d);
            println!("{} {} {:?}: {:?} {:e}", grasp.id, r["set"], norm(r), refined.kink, found / d - 1.0);
            match refined.kink {
                // Another minimum may be within the bracket.
                None if found < d * (1.0 + 1e-9) => compared += 1,
                _ => kinks += 1,
            }
        }
    }
    assert!(compared >= 10, "{compared} of {}", compared + kinks);
}
