//! Grasps from C, for `f64`.

pub mod contacts;
pub mod fingers;
pub mod forces;
pub mod gradients;
pub mod linearized;
pub mod pyramids;
pub mod quality;
pub mod wrenches;

use super::*;
use qdist::grasp::{
    ActiveForces, Closure, Contact, ContactGradient, Contribution, Finger, ForceOptions, ForceSolver, HandContact,
    Jacobian, Layout, MAX_CONTACTS, MAX_JOINTS, Preset, Primitive, PyramidalCone, Refined, Subspace, WrenchFrame,
    WrenchSet, default_tolerance,
};
use {contacts::*, forces::*, linearized::*, wrenches::*};
