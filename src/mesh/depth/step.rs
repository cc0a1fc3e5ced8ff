//! One step of a walk: the contacts that it has to see, and the best motion under what they say.

use super::Scratch;
use super::contact_space::Primitive;
use super::search::PoseSearch;
use crate::mesh::Contact;
use crate::mesh::metric::Metric;
use crate::mesh::optimize::{StepOptions, Twist};
use nalgebra::Isometry3;

/// Contacts are looked for that arise when A turns by this much.
const MOST_TILT: f64 = 0.1;
/// Second-order corrections of a step at most.
const CORRECTIONS: usize = 2;
/// Contacts that a step can take; of more, the nearest.
pub const CONTACTS: usize = 256;

/// Looks for contacts at a pose, with those that a step may bring about.
pub fn see(search: &mut PoseSearch, pose: &Isometry3<f64>, trust: f64, margin: f64) {
    let tilt = (trust / search.metric.frame().radius).min(MOST_TILT);
    search.pair.contacts_when_tilted(pose, margin, tilt, &mut search.scratch.contacts);
    limit(&mut search.scratch.contacts);
    let (a, b) = (search.pair.a(), search.pair.b());
    let Scratch { contacts, primitives, .. } = &mut *search.scratch;
    primitives.clear();
    primitives.extend(contacts.iter().map(|c| Primitive::new(c, a, b, pose)));
}

/// The same with what they say of unions. Returns the sine of the angle that A may turn by.
pub fn see_space(search: &mut PoseSearch, pose: &Isometry3<f64>, trust: f64, margin: f64) -> f64 {
    see(search, pose, trust, margin);
    let tilt = (trust / search.metric.frame().radius).min(MOST_TILT);
    let meshes = (search.pair.a(), search.pair.b());
    let Scratch { contacts, space, .. } = &mut *search.scratch;
    space.set(contacts, meshes, pose, margin, tilt);
    tilt
}

/// Keeps as many contacts as a step can take, the nearest.
pub fn limit(contacts: &mut Vec<Contact>) {
    if contacts.len() > CONTACTS {
        contacts.sort_unstable_by(|x, y| x.gap.abs().total_cmp(&y.gap.abs()));
        contacts.truncate(CONTACTS);
    }
}

/// The best motion under the noted constraints. What the linearisation leaves out is looked up in the primitive constraints
/// themselves, and the program is solved again with that much less room (a second-order correction).
pub fn corrected_step(
    search: &mut PoseSearch,
    metric: &dyn Metric,
    pose: &Isometry3<f64>,
    trust: f64,
    clearance: f64,
) -> Option<Twist> {
    let Scratch { primitives, constraints, memory, .. } = &mut *search.scratch;
    let options = StepOptions { trust, tolerance: 1e-3 };
    let back = pose.inverse();
    let mut twist = metric.step(&search.start, pose, constraints, &options, memory).ok()?.twist;
    for _ in 0..CORRECTIONS {
        let motion = twist.applied(pose) * back;
        let mut held = true;
        for (primitive, constraint) in primitives.iter().zip(constraints.iter_mut()) {
            let gap = primitive.gap(&motion);
            if gap < 0.5 * clearance {
                constraint.gap -= clearance - gap;
                held = false;
            }
        }
        if held {
            break;
        }
        twist = metric.step(&search.start, pose, constraints, &options, memory).ok()?.twist;
    }
    Some(twist)
}
