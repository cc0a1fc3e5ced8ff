//! Sets, bodies and solvers: brackets against closed forms, other libraries' cases, properties, rounding margins, and what was found, by name.

#[macro_use]
#[path = "../common/mod.rs"]
mod common;

mod arcs;
mod boxes;
mod brackets;
mod cases;
mod certificates;
mod closed_forms;
mod depth_margins;
mod errors;
mod exact_margins;
mod far_points;
mod golden;
mod half_spaces;
mod house;
mod hulls;
mod invariance;
mod joins;
mod margins;
mod plane;
mod plans;
mod polytopes;
mod regressions;
mod scales;
mod shallow;
mod sharing;
mod shortcuts;
mod warm_and_flat;
