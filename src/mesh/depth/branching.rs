//! The linearised step with unions of constraints (section IV-B.2 of the paper): the least motion to a polyhedral cone that is not convex.
//!
//! The cone is a union of convex ones, and each is a program of its own. The first is that of the walk: a plane across every gap, which lies within
//! the union that the contact is part of. Then clauses that hold the step back try their members in turn, in the place of the planes, and
//! what brings A nearer to the start is kept.
//!
//! A plane that a step ends at is another one at the next step, so the walk goes around a corner without this too, and what branching gains in
//! a step is hardly ever seen at the end.

use super::Scratch;
use super::contact_space::Primitive;
use super::search::PoseSearch;
use super::step::{corrected_step, see_space};
use crate::mesh::optimize::{Constraint, Twist};
use nalgebra::Isometry3;

/// Programs beside the first, at most.
const TRIES: usize = 8;
/// A clause holds the step back when one of its planes leaves less than this, in clearances.
const ACTIVE: f64 = 2.0;
/// The fraction by which a member must be better than the planes.
const GAIN: f64 = 1e-6;

/// Memory that steps reuse.
#[derive(Clone, Debug, Default)]
pub struct Branches {
    /// Of the clauses, what stands in the place of the planes.
    chosen: Vec<Option<Primitive>>,
    choices: Vec<Primitive>,
    /// Contacts whose planes stand.
    stands: Vec<bool>,
}

/// The best motion under the contacts.
pub fn branched_step(
    search: &mut PoseSearch,
    pose: &Isometry3<f64>,
    trust: f64,
    margin: f64,
    clearance: f64,
) -> Option<Twist> {
    let tilt = see_space(search, pose, trust, margin);
    let mut branches = std::mem::take(&mut search.scratch.branches);
    let best = branch(search, &mut branches, pose, trust, tilt, clearance);
    search.scratch.branches = branches;
    best
}

fn branch(
    search: &mut PoseSearch,
    branches: &mut Branches,
    pose: &Isometry3<f64>,
    trust: f64,
    tilt: f64,
    clearance: f64,
) -> Option<Twist> {
    let Branches { chosen, choices, stands } = branches;
    chosen.clear();
    chosen.resize(search.scratch.space.len(), None);
    let along_planes = attempt(search, pose, trust, clearance)?;
    let mut best = along_planes;
    let mut value = search.distance(&best.applied(pose));
    let mut tries = TRIES;
    for clause in 0..chosen.len() {
        let motion = best.applied(pose) * pose.inverse();
        let space = &search.scratch.space;
        let is_active =
            |part: &(usize, usize)| part.0 == clause && space.planes()[part.1].gap(&motion) < ACTIVE * clearance;
        if !space.parts().iter().any(is_active) {
            continue;
        }
        // What is out of reach makes the program contradict itself.
        let is_near = |member: &&Primitive| member.gap(&Isometry3::identity()) > -trust;
        choices.clear();
        choices.extend(space.choices(clause, tilt).filter(is_near).take(tries));
        tries -= choices.len();
        let mut kept = None;
        for choice in choices.iter() {
            chosen[clause] = Some(*choice);
            choose(search.scratch, chosen, stands);
            if let Some(twist) = attempt(search, pose, trust, clearance) {
                let reached = search.distance(&twist.applied(pose));
                if reached < value * (1.0 - GAIN) {
                    (best, value, kept) = (twist, reached, Some(*choice));
                }
            }
        }
        chosen[clause] = kept;
    }
    // Planes stand for corners that are farther away, too.
    let is_branch = chosen.iter().any(Option::is_some);
    Some(if is_branch && search.pair.collides(&best.applied(pose)) { along_planes } else { best })
}

/// Notes the chosen members, and the planes of contacts that are part of other clauses too.
fn choose(scratch: &mut Scratch, chosen: &[Option<Primitive>], stands: &mut Vec<bool>) {
    let Scratch { space, primitives, .. } = scratch;
    stands.clear();
    stands.resize(space.planes().len(), false);
    for &(clause, contact) in space.parts() {
        stands[contact] |= chosen[clause].is_none();
    }
    primitives.clear();
    primitives.extend(chosen.iter().flatten());
    primitives.extend(space.planes().iter().zip(stands.iter()).filter(|(_, stands)| **stands).map(|(plane, _)| plane));
}

/// The best motion under the noted primitives.
fn attempt(search: &mut PoseSearch, pose: &Isometry3<f64>, trust: f64, clearance: f64) -> Option<Twist> {
    let identity = Isometry3::identity();
    let Scratch { primitives, constraints, .. } = &mut *search.scratch;
    constraints.clear();
    constraints.extend(primitives.iter().map(|p| Constraint {
        point: p.on_a,
        normal: p.normal,
        gap: p.gap(&identity) - clearance,
    }));
    corrected_step(search, search.metric, pose, trust, clearance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{DepthOptions, DepthSolver, Model};
    use nalgebra::{UnitQuaternion, Vector3};

    /// A tip has entered a cube through an edge. The way back is along a ridge: to the plane across the gap there is nothing nearer, but
    /// either face is.
    #[test]
    fn a_ridge_is_left_to_either_side() {
        let tip = [[0.0, 0.0, 0.0], [0.2, 0.0, 1.0], [-0.1, 0.17, 1.0], [-0.1, -0.17, 1.0]];
        let needle = Model::new(&tip, &[[0, 2, 1], [0, 3, 2], [0, 1, 3], [1, 2, 3]]).unwrap();
        let corners: Vec<_> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2].map(|bit| f64::from(bit) - 0.5)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<_> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let cube = Model::new(&corners, &triangles).unwrap();
        assert!(needle.is_solid() && cube.is_solid());

        let out = Vector3::new(1.0, 0.0, 1.0);
        let upright = UnitQuaternion::rotation_between(&Vector3::z(), &out).unwrap();
        let at = |x: f64| Isometry3::from_parts([0.5 + x, 0.05, 0.5 + x].into(), upright);
        let (start, pose) = (at(-0.03), at(1e-4));
        let mut solver = DepthSolver::new(&needle, &cube);
        assert!(solver.pair().collides(&start) && !solver.pair().collides(&pose));

        let options = DepthOptions::default();
        for metric in [needle.disp() as &dyn crate::mesh::metric::Metric, needle.sigma().unwrap()] {
            let mut search = PoseSearch::new(&mut solver, &start, metric, &options, None);
            let (trust, margin, clearance) = (0.1, 0.01, 1e-5);
            see_space(&mut search, &pose, trust, margin);
            let planes = attempt(&mut search, &pose, trust, clearance).unwrap().applied(&pose);
            let branched = branched_step(&mut search, &pose, trust, margin, clearance).unwrap().applied(&pose);
            let (ridge, side) = (search.distance(&planes), search.distance(&branched));
            assert!(!search.pair.collides(&branched));
            assert!(side < 0.8 * ridge, "{side} {ridge}");
        }
    }
}
