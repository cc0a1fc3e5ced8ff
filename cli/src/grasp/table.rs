//! The answers as a table to read.

use std::io::{self, Write};

use qdist::Outcome;
use qdist::grasp::{Friction, WrenchSet};

use crate::grasp::csv::outcome_name;
use crate::grasp::input::{Grasp, Reference, Set, norm_name};
use crate::grasp::query::Found;
use crate::grasp::sets::Sets;
use crate::grasp::words;

/// Contacts, fingers and dimensions.
pub fn begin(out: &mut dyn Write, grasp: &Grasp, sets: &Sets) -> io::Result<()> {
    let unit = grasp.length_unit.map_or(String::new(), |unit| format!("; lengths in units of {unit:.4} m"));
    let contacts = if let [_] = grasp.contacts.as_slice() { "contact" } else { "contacts" };
    writeln!(out, "{}: {} {contacts}{unit}{}", grasp.id, grasp.contacts.len(), frame(grasp))?;
    let width = grasp.contacts.iter().map(|c| c.name.chars().count()).max().unwrap_or(0).max(7);
    writeln!(out, "  {:<width$}  {:<24}  {:>6}  {:>4}  active forces", "contact", "friction", "joints", "rank")?;
    for (touch, forces) in grasp.contacts.iter().zip(&sets.fingers) {
        let (name, c) = (&touch.name, &touch.contact);
        let friction = match c.contact.friction() {
            Friction::Frictionless => "none".to_string(),
            Friction::Hard { mu } => format!("hard, mu {mu:.4}"),
            Friction::Soft { mu, mus } => format!("soft, mu {mu:.4} {mus:.4}"),
        };
        let joints = c.jacobian.map_or("-".into(), |j| j.joints().to_string());
        let rank = forces.map_or("-".into(), |f| f.rank().to_string());
        let size = match forces.map(|f| f.dimension()) {
            None => "passive: all that friction allows",
            Some(None) => "none",
            Some(Some(0)) => "U^a is a point",
            Some(Some(1)) => "U^a of dimension 1",
            Some(Some(2)) => "U^a of dimension 2",
            Some(Some(_)) => "all that friction allows",
        };
        let cap = if c.contact.force_cap() == 1.0 { String::new() } else { format!(", cap {}", c.contact.force_cap()) };
        let limits = touch.limits.as_ref().map_or(String::new(), |limits| format!(", torque limits {limits:?}"));
        writeln!(out, "  {name:<width$}  {friction:<24}  {joints:>6}  {rank:>4}  {size}{cap}{limits}")?;
    }
    let [passive, active] = [Set::Passive, Set::Active].map(|set| sets.get(set).dimension());
    writeln!(out, "  W has dimension {passive}, W^a {active}")?;
    let head = ["set", "norm", "dim", "lower", "upper", "outcome", "plan", "steps", "ms", "reference", "inside"];
    let [set, norm, dim, lower, upper, outcome, plan, steps, ms, reference, inside] = head;
    writeln!(
        out,
        "  ref  {set:<3} {norm:<4} {dim:>3}  {lower:>14} {upper:>14}  {outcome:<10} {plan:<9} {steps:>7} {ms:>9}  {reference:>14}  {inside:<6}  Q"
    )
}

/// Reference point and torque scale, where they are not the usual ones.
fn frame(grasp: &Grasp) -> String {
    let ([x, y, z], scale) = ((*grasp.frame.reference()).into(), grasp.frame.torque_scale());
    let about = if [x, y, z] == [0.0; 3] { String::new() } else { format!("; moments about ({x}, {y}, {z})") };
    if scale == 1.0 { about } else { format!("{about}; torque scale {scale}") }
}

/// What the columns and words mean.
pub const LEGEND: &str = "\
d_Q(W) is in [lower, upper]; a negative value is minus the distance of the origin from W. dim: of the space that d is measured in.
hardest to resist: the external wrench of which the grasp bears the least multiple. limited by: the contacts with the largest share of
d at the weakest direction, by which d grows with their force caps (Linf: each by itself; L1: all that are named together).";

/// A bound; "unknown" for one that is not known.
fn bound(x: f64) -> String {
    match x.abs() {
        f64::MAX => "unknown".into(),
        size if size > 0.0 && size < 1e-4 => format!("{x:.3e}"),
        _ => format!("{x:.10}"),
    }
}

/// Does the bracket contain the reference, to what that is known to?
pub fn contains(found: &Found, query: &Reference) -> Option<bool> {
    let (d, off) = (query.d?, query.tolerance);
    // A bracket below 0 is that of minus a distance: d is 0.
    let [lower, upper] = [found.answer.lower, found.answer.upper].map(|x| x.max(0.0));
    Some(lower <= d + off && d - off <= upper)
}

/// One query and its answer: a line of numbers and one of words.
pub fn row(out: &mut dyn Write, sets: &Sets, number: usize, query: &Reference, found: &Found) -> io::Result<()> {
    let answer = &found.answer;
    let inside = match contains(found, query) {
        None => "-",
        Some(true) => "yes",
        Some(false) => "NO",
    };
    writeln!(
        out,
        "  {number:>3}  {:<3} {:<4} {:>3}  {:>14} {:>14}  {:<10} {:<9} {:>7} {:>9.3}  {:>14}  {inside:<6}  {}",
        query.set.name(),
        norm_name(query.norm),
        found.dimension,
        bound(answer.lower),
        bound(answer.upper),
        outcome_name(answer.outcome),
        answer.plan.to_string(),
        answer.iterations,
        found.time.as_secs_f64() * 1e3,
        query.d.map_or("-".into(), bound),
        query.q.label(),
    )?;
    let wrenches = sets.get(query.set);
    let set = WrenchSet::new(&wrenches.parts, query.norm);
    let worst = words::worst(&wrenches.names, &set, &answer.direction, 1e-3);
    let hardest = words::hardest(&found.weakest);
    let least = match answer.outcome {
        Outcome::Touching | Outcome::Separated | Outcome::Degenerate => "cannot resist",
        _ => "hardest to resist",
    };
    writeln!(out, "       {least}: {hardest}; {worst}")
}
