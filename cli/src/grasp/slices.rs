//! Sections of a wrench set of any dimension, and of the largest d Q in it, with planes through the origin.
//!
//! Three planes of forces at zero moment, three of moments at zero force, and the plane of force and moment that contains the weakest wrench: there
//! d Q touches the set's surface. A section is not a projection: each point of its outline is the end of a ray, shot by the library (Q = a segment).

use std::error::Error;
use std::f64::consts::TAU;
use std::path::Path;

use plotters::prelude::*;
use qdist::grasp::WrenchSet;
use qdist::support::Support;
use qdist::{Solver, Vector};

use crate::grasp::plot::{COORDINATES, INSIDE, SET, Scene, font};
use crate::grasp::query::reach;

const SIZE: (u32, u32) = (1760, 940);
const RAYS: usize = 360;

/// A plane by two unit wrenches and their names.
struct Plane {
    axes: [Vector<f64, 6>; 2],
    names: [String; 2],
}

fn planes(weakest: &Vector<f64, 6>) -> Vec<Plane> {
    let axis = |i: usize| Vector::<f64, 6>::from_fn(|j, _| f64::from(i == j));
    let plane =
        |i: usize, j: usize| Plane { axes: [axis(i), axis(j)], names: [i, j].map(|i| COORDINATES[i].to_string()) };
    let part = |first: usize, name: &str| {
        let part = Vector::<f64, 6>::from_fn(|i, _| if i / 3 == first { weakest[i] } else { 0.0 });
        let used = part.norm() > 1e-9 * weakest.norm() && weakest.norm() > 0.0;
        if used {
            (part.normalize(), format!("{name} of the weakest wrench"))
        } else {
            (axis(3 * first), COORDINATES[3 * first].to_string())
        }
    };
    let ((force, force_name), (moment, moment_name)) = (part(0, "force"), part(1, "moment"));
    let mut planes: Vec<Plane> = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)].map(|(i, j)| plane(i, j)).into();
    planes.push(Plane { axes: [force, moment], names: [force_name, moment_name] });
    planes
}

type Outline = Vec<(f64, f64)>;

/// The outlines of the set and of d Q.
fn sections(solver: &mut Solver<'_, f64, 6>, scene: &Scene, plane: &Plane) -> [Outline; 2] {
    let (mut outer, mut inner) = (Outline::new(), Outline::new());
    for turn in 0..RAYS {
        let (y, x) = (TAU * turn as f64 / RAYS as f64).sin_cos();
        // Exactly along the axes, where sets are often flat.
        let [x, y] = [x, y].map(|c| if c.abs() < 1e-15 { 0.0 } else { c });
        let v = plane.axes[0] * x + plane.axes[1] * y;
        if let Some(t) = reach(solver, scene.wrenches, scene.reference.norm, &v) {
            outer.push((t * x, t * y));
        }
        let t = scene.d() * scene.reference.q.reach(&v);
        inner.push((t * x, t * y));
    }
    [outer, inner]
}

/// Half the width of a picture: that of the outlines, unless they are no more than points.
fn extent(outlines: &[[Outline; 2]], whole: f64) -> f64 {
    let largest = outlines.iter().flatten().flatten().fold(0.0, |m: f64, (x, y)| m.max(x.abs()).max(y.abs()));
    1.1 * if largest > 1e-3 * whole { largest } else { whole.max(f64::MIN_POSITIVE) }
}

/// A number of an axis that goes up to `size`, without the sign of what is rounded to 0.
fn label(x: f64, size: f64) -> String {
    let x = if x.abs() < 1e-9 * size { 0.0 } else { x };
    if (0.05..1e4).contains(&size) { ((x * 1e3).round() / 1e3).to_string() } else { format!("{x:.1e}") }
}

pub fn draw(file: &Path, title: &str, scene: &Scene, solver: &mut Solver<'_, f64, 6>) -> Result<(), Box<dyn Error>> {
    let planes = planes(&scene.found.weakest);
    let outlines: Vec<[Outline; 2]> = planes.iter().map(|plane| sections(solver, scene, plane)).collect();
    // Forces have one scale, moments another.
    let whole = WrenchSet::new(&scene.wrenches.parts, scene.reference.norm).extent();
    let scales = [extent(&outlines[..3], whole), extent(&outlines[3..6], whole), extent(&outlines[6..], whole)];
    let root = SVGBackend::new(file, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, body) = root.split_vertically(60);
    head.draw(&Text::new(title.to_string(), (24, 18), font(28)))?;
    let cells = body.split_evenly((2, 4));
    let order = [0, 1, 2, 4, 5, 6, 3];
    for (i, (plane, [outer, inner])) in planes.iter().zip(&outlines).enumerate() {
        let size = scales[i / 3];
        let caption = match i / 3 {
            0 => format!("{}, {}; no moment", plane.names[0], plane.names[1]),
            1 => format!("{}, {}; no force", plane.names[0], plane.names[1]),
            _ => "through the weakest wrench".to_string(),
        };
        let mut chart = ChartBuilder::on(&cells[order[i]])
            .caption(caption, ("sans-serif", 22))
            .margin(12)
            .margin_right(24)
            .x_label_area_size(42)
            .y_label_area_size(56)
            .build_cartesian_2d(-size..size, -size..size)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .bold_line_style(BLACK.mix(0.08))
            .label_style(font(16))
            .x_label_formatter(&|x| label(*x, size))
            .y_label_formatter(&|y| label(*y, size))
            .x_labels(5)
            .y_labels(5)
            .x_desc(plane.names[0].as_str())
            .y_desc(plane.names[1].as_str())
            .draw()?;
        for (outline, color) in [(outer, SET), (inner, INSIDE)] {
            let closed: Outline = outline.iter().chain(outline.first()).copied().collect();
            chart.draw_series([Polygon::new(closed.clone(), color.mix(0.25).filled())])?;
            chart.draw_series([PathElement::new(closed, color.stroke_width(2))])?;
        }
        chart.draw_series([Cross::new((0.0, 0.0), 5, BLACK)])?;
    }
    let legend = [
        "blue: section of the wrench set",
        "red: section of the largest d Q inside",
        "",
        "Sections at zero in the other coordinates,",
        "by ray shooting. d Q touches the set in the",
        "plane through the weakest wrench.",
        "Moments in units of force times length.",
    ];
    for (i, line) in legend.into_iter().enumerate() {
        cells[7].draw(&Text::new(line, (16, 60 + 30 * i as i32), font(19)))?;
    }
    root.present()?;
    Ok(())
}
