//! Error against time, a picture a metric: both axes logarithmic, a colour for every group, a mark for every variant.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;

use crate::measure::{Cold, VARIANTS, Variant};
use crate::report::{excess, milliseconds};
use qdist_cli::mesh::input::Kind;
use qdist_cli::mesh::table::quantile;

const SIZE: (u32, u32) = (900, 560);
/// Errors below this are drawn here.
const LEAST: f64 = 1e-6;

/// `folder/DISP.svg` and so on: the median time and the error that nine of ten queries undercut.
pub fn all(cold: &[Cold], groups: &[&str], folder: &Path) -> Result<(), Box<dyn Error>> {
    for kind in Kind::BOTH {
        draw(cold, groups, kind, &folder.join(format!("{}.svg", kind.name())))?;
    }
    Ok(())
}

/// Time and error of every variant that was asked.
fn points(cold: &[Cold], group: &str, kind: Kind) -> Vec<(Variant, f64, f64)> {
    let of = |variant: Variant| {
        let is = |c: &&Cold| c.variant == variant.name && c.row.group == group && c.row.kind == kind;
        let of: Vec<&Cold> = cold.iter().filter(is).collect();
        let errors: Vec<f64> = of.iter().filter_map(|c| excess(c)).collect();
        let error = quantile(&errors, 0.9).max(LEAST);
        (!errors.is_empty()).then(|| (variant, milliseconds(of.iter().copied(), 0.5), error))
    };
    VARIANTS.into_iter().filter_map(of).collect()
}

fn draw(cold: &[Cold], groups: &[&str], kind: Kind, file: &Path) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::new(file, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(format!("{}: error of 90 % of the queries against median time", kind.name()), ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d((0.1..1e4).log_scale(), (LEAST / 2.0..10.0).log_scale())?;
    let power = |x: &f64| format!("{x:.0e}");
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("time, ms")
        .y_desc("upper / best known - 1")
        .x_label_formatter(&power)
        .y_label_formatter(&power)
        .draw()?;
    for (i, group) in groups.iter().enumerate() {
        // (Yellow, the third, is hard to see on white.)
        let color = Palette99::pick(if i < 2 { i } else { i + 1 }).to_rgba();
        let points = points(cold, group, kind);
        // The efforts are a curve; the paper's variants stand alone.
        let curve = points.iter().filter(|p| p.0.is_effort).map(|p| (p.1, p.2));
        chart
            .draw_series(LineSeries::new(curve, color.stroke_width(2)))?
            .label(*group)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        for (variant, time, error) in points {
            chart.draw_series([Circle::new((time, error), 4, color.filled())])?;
            let label =
                Text::new(variant.name, (time * 1.08, error * 1.1), ("sans-serif", 13).into_font().color(&color));
            chart.draw_series([label])?;
        }
    }
    let mut legend = chart.configure_series_labels();
    legend.position(SeriesLabelPosition::UpperRight).background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
    root.present()?;
    Ok(())
}
