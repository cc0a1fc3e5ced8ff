//! Random contacts, and the formulas of the paper in plain `f64`, for the tests of grasps.

// Each test uses a part.
#![allow(dead_code)]

pub mod socp;

use qdist::grasp::{Contact, Friction, WrenchFrame};
use qdist::{Real, Vector};

use crate::common::dice::Dice;
use crate::common::shared;
use serde_json::Value;

/// The grasps of the shared data.
pub fn recorded() -> Vec<Value> {
    let text = std::fs::read_to_string(shared("grasps/grasps.json")).unwrap();
    let data: Value = serde_json::from_str(&text).unwrap();
    let grasps = data["instances"].as_array().unwrap().clone();
    assert!(grasps.len() >= 8);
    grasps
}

/// A vector of `T` from constants.
pub fn vector<T: Real, const N: usize>(v: [f64; N]) -> Vector<T, N> {
    Vector::from(v.map(T::of))
}

/// The nearest `f64` of each coordinate.
pub fn wide<T: Real, const N: usize>(v: &Vector<T, N>) -> Vector<f64, N> {
    Vector::from(v.data.0[0].map(T::to_f64))
}

/// A contact with position of size `reach`, any friction model, given tangents every other time.
pub fn random_contact<T: Real>(dice: &mut Dice, reach: f64) -> Contact<T> {
    let [n, o, t] = dice.rotation::<3>();
    let (mu, mus) = (T::of(dice.decade(-3.0, 1.0)), T::of(reach * dice.decade(-3.0, 0.0)));
    let friction = match dice.below(4) {
        0 => Friction::Frictionless,
        1 => Friction::Hard { mu },
        _ => Friction::Soft { mu, mus },
    };
    let p = dice.direction::<3>().map(|x| reach * x);
    let contact = Contact::new(vector(p), vector(n), friction).unwrap();
    let contact = if dice.chance(0.5) { contact.with_tangents(vector(o), vector(t)).unwrap() } else { contact };
    if dice.chance(0.5) { contact.with_force_cap(T::of(dice.decade(-2.0, 2.0))).unwrap() } else { contact }
}

/// The columns of G (eq. 2), moments over the torque scale.
pub fn contact_map<T: Real>(contact: &Contact<T>, frame: &WrenchFrame<T>) -> [Vector<f64, 6>; 4] {
    let arm = (wide(contact.position()) - wide(frame.reference())) / frame.torque_scale().to_f64();
    let column = |f: Vector<f64, 3>| {
        let m = arm.cross(&f);
        Vector::from([f.x, f.y, f.z, m.x, m.y, m.z])
    };
    let n = wide(contact.normal());
    let [o, t] = contact.tangents().map(|v| column(wide(&v)));
    [column(n), o, t, Vector::from([0.0, 0.0, 0.0, n.x, n.y, n.z])]
}

/// (mu, mu, mus / L).
pub fn radii<T: Real>(contact: &Contact<T>, frame: &WrenchFrame<T>) -> [f64; 3] {
    let (mu, mus) = contact.friction().coefficients();
    [mu.to_f64(), mu.to_f64(), mus.to_f64() / frame.torque_scale().to_f64()]
}

/// h_i(u) = cap (g1 + sqrt(mu^2 (g2^2 + g3^2) + mus^2 g4^2)), g = G^T u.
pub fn value<T: Real>(contact: &Contact<T>, frame: &WrenchFrame<T>, u: &Vector<f64, 6>) -> f64 {
    let g = contact_map(contact, frame).map(|column| column.dot(u));
    let r = radii(contact, frame);
    let friction = (0..3).map(|i| (r[i] * g[i + 1]).powi(2)).sum::<f64>().sqrt();
    contact.force_cap().to_f64() * (g[0] + friction)
}

/// Directions of many kinds and lengths: generic, sparse, almost along an axis.
pub fn direction(dice: &mut Dice) -> [f64; 6] {
    let u = dice.direction::<6>();
    match dice.below(4) {
        0 => u.map(|x| if dice.chance(0.6) { 0.0 } else { x }).map(|x| x + 1e-12 * u[0]),
        1 => u.map(|x| x * dice.decade(-8.0, 0.0)),
        _ => u,
    }
}
