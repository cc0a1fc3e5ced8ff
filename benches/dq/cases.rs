//! What is measured: a set A, a unit set Q, and where it is known the value d_Q(A).
//!
//! Cases are written down in `f64` and built for the scalar that is to be timed.

use crate::contacts::{Contact, Grasp, Norm, planar, spatial};
use nalgebra::{SMatrix, Vector3};
use qdist::qset::{Ball, CrossPolytope, UnitBox, UnitEllipsoid, UnitSet};
use qdist::support::{BoxShape, Ellipsoid, Support};
use qdist::{Options, Outcome, Real, Vector, Workspace};
use qdist_benches::common::dice::Dice;
use serde_json::Value;

/// The set A.
#[derive(Clone)]
pub enum Set<const N: usize> {
    Grasp(Vec<Contact<N>>, Norm),
    Ellipsoid([f64; N]),
    Box([f64; N]),
}

/// The set Q, by its semi axes.
#[derive(Clone, Copy)]
pub enum Metric<const N: usize> {
    Ball,
    Ellipsoid([f64; N]),
    Cross([f64; N]),
    Box([f64; N]),
}

#[derive(Clone)]
pub struct Case<const N: usize> {
    pub name: String,
    pub a: Set<N>,
    pub q: Metric<N>,
    /// d_Q(A) and how far it may be off.
    pub truth: Option<(f64, f64)>,
}

impl<const N: usize> Case<N> {
    pub fn a<T: Real>(&self) -> Box<dyn Support<T, N>> {
        let sizes = |x: &[f64; N]| Vector::from(x.map(T::of));
        match &self.a {
            Set::Grasp(contacts, norm) => Box::new(Grasp::new(contacts, *norm)),
            Set::Ellipsoid(semi) => Box::new(Ellipsoid::new(sizes(semi)).expect("semi axes")),
            Set::Box(half) => Box::new(BoxShape::new(sizes(half)).expect("half extents")),
        }
    }

    pub fn q<T: Real>(&self) -> Box<dyn UnitSet<T, N>> {
        let sizes = |x: [f64; N]| Vector::from(x.map(T::of));
        match self.q {
            Metric::Ball => Box::new(Ball::unit()),
            Metric::Ellipsoid(x) => Box::new(UnitEllipsoid::new(sizes(x), SMatrix::identity()).expect("semi axes")),
            Metric::Cross(x) => Box::new(CrossPolytope::new(sizes(x)).expect("semi axes")),
            Metric::Box(x) => Box::new(UnitBox::new(sizes(x)).expect("half extents")),
        }
    }
}

/// Rows (a1) to (a5) of Table I: five unit sets on one set. `corner` is the value for the box, which differs in the plane.
fn table<const N: usize>(suffix: &str, contacts: Vec<Contact<N>>, corner: f64) -> Vec<Case<N>> {
    let mut long = [1.0; N];
    long[0] = 2.0;
    let mut axis = [0.0; N];
    axis[0] = 1.0;
    let a = Set::Grasp(contacts, Norm::Each);
    let rows = [
        (Metric::Ball, 0.41 / 2.8581f64.sqrt()),
        (Metric::Ellipsoid(long), 0.41 / 3.3624f64.sqrt()),
        (Metric::Cross([1.0; N]), 0.41 / 1.3),
        (Metric::Box([1.0; N]), corner),
        (Metric::Cross(axis), 1.0),
    ];
    let case = |(i, (q, d))| Case { name: format!("a{}{suffix}", i + 1), a: a.clone(), q, truth: Some((d, 1e-14)) };
    rows.into_iter().enumerate().map(case).collect()
}

/// Two soft fingers on the x axis, as in Table I.
fn two_fingers() -> Vec<Contact<6>> {
    let finger = |x: f64, inward: f64| {
        let frame = [Vector3::x() * inward, Vector3::y(), Vector3::z() * inward];
        spatial(Vector3::x() * x, frame, 0.2, 0.2)
    };
    vec![finger(-0.75, 1.0), finger(1.3, -1.0)]
}

/// Rows a1 to a5 for W.
pub fn table_in_space() -> Vec<Case<6>> {
    table("", two_fingers(), 0.41 / (0.41 + 2.3 * 2f64.sqrt()))
}

/// Rows a1 to a5 for W^a: fingers that move in the x-y plane.
pub fn table_in_the_plane() -> Vec<Case<3>> {
    table("_plane", two_fingers().iter().map(planar).collect(), 0.41 / 2.71)
}

/// Semi axes evenly from 1 to 2: an ellipsoid and a box of depth 1.
pub fn solids<const N: usize>() -> [Case<N>; 2] {
    let axes = std::array::from_fn(|i| 1.0 + i as f64 / (N - 1) as f64);
    let case = |name: &str, a| Case { name: format!("{name}_{N}"), a, q: Metric::Ball, truth: Some((1.0, 0.0)) };
    [case("ellipsoid", Set::Ellipsoid(axes)), case("box", Set::Box(axes))]
}

/// The grasps of the data file with the unit ball; empty when there is no such file. The unit bounds every normal
/// force; for two of them, in another case, the sum of the normal forces.
pub fn recorded() -> Vec<Case<6>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/grasps/grasps.json");
    let Ok(text) = std::fs::read_to_string(file) else {
        println!("no {file}: recorded grasps are skipped");
        return Vec::new();
    };
    let data: Value = serde_json::from_str(&text).expect(file);
    let mut cases = Vec::new();
    for instance in data["instances"].as_array().into_iter().flatten() {
        let id = instance["id"].as_str().unwrap_or_default();
        // (The first is row a1, and a joint locked changes nothing in W.)
        if id == "paper_a1" || id.ends_with("_lock0") {
            continue;
        }
        cases.push(recorded_grasp(id, instance, Norm::Each));
        if ["allegro_lemon_3", "synthetic_fixture_12"].contains(&id) {
            cases.push(recorded_grasp(id, instance, Norm::Total));
        }
    }
    cases
}

fn recorded_grasp(id: &str, instance: &Value, norm: Norm) -> Case<6> {
    let list = |key: &str| instance[key].as_array().expect("a list").iter();
    let contact = |c: &Value| {
        let vector = |key: &str| Vector3::from_fn(|i, _| c[key][i].as_f64().expect("a coordinate"));
        let friction = |key: &str| c[key].as_f64().unwrap_or(0.0);
        spatial(vector("p"), ["n", "o", "t"].map(vector), friction("mu"), friction("mus"))
    };
    let contacts: Vec<_> = list("contacts").map(contact).collect();
    let (symbol, prefix) = if norm == Norm::Each { ("Linf", "") } else { ("L1", "total_") };
    let same = |r: &&Value| r["set"] == "W" && r["norm"] == symbol && r["Q"]["type"] == "ball";
    let truth = list("refs").find(same).and_then(|r| Some((r["d"].as_f64()?, r["tol"].as_f64().unwrap_or(1e-9))));
    let kind = instance["contacts"][0]["type"].as_str().unwrap_or("contacts");
    let name = format!("{prefix}{kind}{}_{id}", contacts.len());
    Case { name, a: Set::Grasp(contacts, norm), q: Metric::Ball, truth }
}

/// Three and five to eight soft contacts, of which the data has none.
pub fn made_up() -> Vec<Case<6>> {
    let grasp = |count| force_closure(format!("soft{count}"), &mut Dice::new(count as u64), count, 0.05);
    [3, 5, 6, 7, 8].into_iter().map(grasp).collect()
}

/// Random force-closure grasps of three to five soft contacts.
pub fn random(count: usize) -> Vec<Case<6>> {
    let mut dice = Dice::new(2013);
    let grasp = |i| force_closure(format!("random_{i:02}"), &mut dice, 3 + i % 3, 1e-3);
    (0..count).map(grasp).collect()
}

/// Soft fingers evenly around the equator of the unit ball.
pub fn regular(count: usize) -> Case<6> {
    let contact = |i: usize| {
        let angle = 2.0 * std::f64::consts::PI * i as f64 / count as f64;
        let p = Vector3::new(angle.cos(), angle.sin(), 0.0);
        spatial(p, [-p, Vector3::z(), Vector3::z().cross(&p)], 0.5, 0.2)
    };
    let contacts = (0..count).map(contact).collect();
    Case { name: format!("regular{count}"), a: Set::Grasp(contacts, Norm::Each), q: Metric::Ball, truth: None }
}

/// The first grasp that the dice give which is certainly deeper than `least`.
fn force_closure(name: String, dice: &mut Dice, count: usize, least: f64) -> Case<6> {
    let mut memory = Box::new(Workspace::<f64, 6, 512, 4096>::new());
    loop {
        let (mu, mus) = (dice.range(0.3, 0.8), dice.range(0.05, 0.3));
        let contacts: Vec<_> = (0..count).map(|_| on_ellipsoid(dice, mu, mus)).collect();
        let a = Grasp::<f64, 6>::new(&contacts, Norm::Each);
        let options = Options { threshold: Some(least), ..Options::default() };
        if memory.solver().solve(&a, &Ball::unit(), &options).outcome == Outcome::Above {
            return Case { name, a: Set::Grasp(contacts, Norm::Each), q: Metric::Ball, truth: None };
        }
    }
}

/// A contact on an ellipsoid about the size of what hands hold, in units of its largest semi axis.
fn on_ellipsoid(dice: &mut Dice, mu: f64, mus: f64) -> Contact<6> {
    let semi = Vector3::new(1.0, 0.8, 0.6);
    let p = semi.component_mul(&Vector3::from(dice.direction::<3>()));
    let n = -p.component_div(&semi.component_mul(&semi)).normalize();
    let o = n.cross(&Vector3::from(dice.direction::<3>())).normalize();
    spatial(p, [n, o, n.cross(&o)], mu, mus)
}
