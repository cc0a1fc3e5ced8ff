//! Pictures: which one a query gets, where it goes, and its colours.
//!
//! A set of three dimensions is drawn whole, as in the paper's Fig. 3 (`surface`), any other by its sections with coordinate planes (`slices`). Blue is the
//! wrench set, red the largest d Q in it.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use qdist::Solver;

use crate::Trouble;
use crate::grasp::input::{Grasp, norm_name};
use crate::grasp::query::Found;
use crate::grasp::sets::Wrenches;
use crate::grasp::{slices, surface};

pub const SET: RGBColor = RGBColor(31, 89, 158);
pub const INSIDE: RGBColor = RGBColor(200, 40, 40);

/// A set and the d Q in it.
pub struct Scene<'a> {
    pub wrenches: &'a Wrenches,
    pub reference: &'a crate::grasp::input::Reference,
    pub found: &'a Found,
}

impl Scene<'_> {
    /// What is drawn of Q: the multiple that is certainly inside.
    pub fn d(&self) -> f64 {
        self.found.answer.lower.max(0.0)
    }
}

/// `folder/ID_REF.svg`.
pub fn draw(
    folder: &Path,
    solver: &mut Solver<'_, f64, 6>,
    grasp: &Grasp,
    index: usize,
    wrenches: &Wrenches,
    found: &Found,
) -> Result<(), Trouble> {
    let name: String =
        grasp.id.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let file = folder.join(format!("{name}_{index}.svg"));
    let words = |error: Box<dyn Error>| format!("{}: {error}", file.display());
    let reference = &grasp.queries[index];
    let scene = Scene { wrenches, reference, found };
    let title = format!(
        "{}: {} ({}), Q: {}, d = {:.4}",
        grasp.id,
        reference.set.name().replace('a', "\u{1d43}"),
        norm_name(reference.norm),
        reference.q.label(),
        scene.d()
    );
    match wrenches.span.matrix::<3>() {
        Some(basis) if found.dimension == 3 => surface::draw(&file, &title, &scene, &basis).map_err(words),
        _ => slices::draw(&file, &title, &scene, solver).map_err(words),
    }
}

/// Names of the coordinates of R^6: forces, and moments in units of force times length.
pub const COORDINATES: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

pub fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", size).into_text_style(&(2000, 2000)).color(&BLACK)
}
