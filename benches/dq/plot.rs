//! Error against time, one picture a case: both axes logarithmic, one curve for every method and capacity.

use crate::methods::Method;
use crate::report::Row;
use crate::scan_and_match::Matching;
use plotters::prelude::*;
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

/// A bracket that is closed exactly is drawn here.
const LEAST: f64 = 1e-16;
const SIZE: (u32, u32) = (720, 480);

/// `folder/CASE.svg` for every case that was run in f64 more than once.
pub fn all(rows: &[Row], folder: &Path) -> Result<usize, Box<dyn Error>> {
    let mut cases: BTreeMap<&str, Vec<&Row>> = BTreeMap::new();
    for row in rows.iter().filter(|r| r.scalar == "f64") {
        cases.entry(&row.case).or_default().push(row);
    }
    cases.retain(|_, rows| rows.len() > 1);
    for (case, rows) in &cases {
        draw(case, rows, &folder.join(format!("{case}.svg")))?;
    }
    Ok(cases.len())
}

/// Milliseconds and the width of the bracket.
fn point(row: &Row) -> (f64, f64) {
    (row.median / 1e6, (row.upper - row.lower).max(LEAST))
}

fn curve_name(row: &Row) -> String {
    match row.method {
        Method::Qdist => format!("qdist, {} facets", row.max_facets),
        Method::Expand => format!("plain expansion, {}", row.max_facets),
        Method::Scan(Matching::Pairs) => "scan and match".into(),
        Method::Scan(Matching::Sorted) => "scan, sorted matching".into(),
    }
}

/// Whole decades around a range, at least two: the labels of an axis with fewer would overlap.
fn decades(low: f64, high: f64) -> std::ops::Range<f64> {
    let (first, last) = (low.log10().floor(), high.log10().ceil());
    10f64.powf(first)..10f64.powf(last.max(first + 2.0))
}

fn draw(case: &str, rows: &[&Row], file: &Path) -> Result<(), Box<dyn Error>> {
    let (mut times, mut errors) = ([f64::MAX, 0.0], [f64::MAX, 0.0]);
    for (time, error) in rows.iter().map(|r| point(r)) {
        times = [times[0].min(time), times[1].max(time)];
        errors = [errors[0].min(error), errors[1].max(error)];
    }
    let [times, errors] = [times, errors].map(|[low, high]| decades(low, high).log_scale());
    let root = SVGBackend::new(file, SIZE).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(case, ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d(times, errors)?;
    let power = |x: &f64| format!("{x:.0e}");
    let mut mesh = chart.configure_mesh();
    mesh.x_desc("time, ms").y_desc("upper - lower").x_label_formatter(&power).y_label_formatter(&power).draw()?;
    let mut curves: BTreeMap<(&str, usize), Vec<&Row>> = BTreeMap::new();
    for row in rows {
        curves.entry((row.method.suffix(), row.max_facets)).or_default().push(row);
    }
    for (i, curve) in curves.values().enumerate() {
        let color = Palette99::pick(i).to_rgba();
        let points = || curve.iter().map(|r| point(r));
        let name = curve_name(curve[0]);
        chart
            .draw_series(LineSeries::new(points(), color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color.stroke_width(2)));
        chart.draw_series(points().map(|p| Circle::new(p, 3, color.filled())))?;
    }
    let mut legend = chart.configure_series_labels();
    legend.position(SeriesLabelPosition::LowerLeft).background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
    root.present()?;
    Ok(())
}
