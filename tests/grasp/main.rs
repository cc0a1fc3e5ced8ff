//! Contacts, hands, wrench sets, contact forces, gradients.
#![cfg(feature = "grasp")]

#[macro_use]
#[path = "../common/mod.rs"]
mod common;
#[path = "../grasp_common/mod.rs"]
mod grasp_common;

mod data;
mod fingers;
mod flat;
mod forces;
mod golden;
mod gradients;
mod hand;
mod linearized;
mod open_sets;
mod plans;
mod queries;
mod sets;
mod shared;
