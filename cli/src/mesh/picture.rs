//! Pictures of a query: before, two free poses on the way, after (the paper's Figs. 6 to 8), from where A is best seen.
//!
//! Parallel projection, and what is farther is drawn first (painter's algorithm). Large triangles are cut into small ones before, so that order by
//! centres is nearly order by depth, and bodies that overlap show where. Only what is visible in some pixel is drawn; and what B hides of A, on top,
//! transparent.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use qdist::mesh::{DepthOptions, DepthSolver, Mesh, Progress};
use qdist::nalgebra::{Isometry3, Point2, Point3, Vector3};

use crate::Trouble;
use crate::mesh::answer::Row;
use crate::mesh::bodies;
use crate::mesh::input::Query;

/// A panel's width and height; there are two by two.
const PANEL: (u32, u32) = (1000, 860);
/// Above the bodies, for the words.
const CAPTION: f64 = 70.0;
const MARGIN: f64 = 30.0;
/// Largest edge of a drawn triangle, in units of the scene.
const FINE: f64 = 0.045;
/// Poses on the way are at most this much farther than the last.
const FAR: f64 = 4.0;

const REST: RGBColor = RGBColor(152, 166, 186);
const BEFORE: RGBColor = RGBColor(214, 66, 54);
const WAY: RGBColor = RGBColor(240, 160, 60);
const AFTER: RGBColor = RGBColor(250, 215, 70);

/// `folder/QUERY_METRIC.svg`. The query is asked once more, and watched.
pub fn draw(
    solver: &mut DepthSolver,
    query: &Query,
    row: &Row,
    options: &DepthOptions,
    folder: &Path,
) -> Result<(), Trouble> {
    let safe: String =
        query.id.chars().map(|c| if c.is_alphanumeric() || "-_.".contains(c) { c } else { '_' }).collect();
    let file = folder.join(format!("{safe}_{}.svg", row.kind.name()));
    draw_to(&file, solver, query, row, options).map_err(|error| format!("{}: {error}", file.display()))
}

fn draw_to(
    file: &Path,
    solver: &mut DepthSolver,
    query: &Query,
    row: &Row,
    options: &DepthOptions,
) -> Result<(), Box<dyn Error>> {
    let mut panels = vec![(query.pose, BEFORE, "before".to_string())];
    if row.upper.is_finite() && row.upper > 0.0 {
        let way = way(solver, query, row, options);
        panels.extend(way.iter().map(|(pose, value)| (*pose, WAY, format!("on the way: {value:.5}"))));
        let (lower, upper) = (row.lower, row.upper);
        panels.push((row.pose, AFTER, format!("after: {lower:.5} <= depth <= {upper:.5}")));
    }
    let (a, b) = (solver.a().mesh(), solver.b().mesh());
    let still = Scene::new(a, b, &panels.iter().map(|p| p.0).collect::<Vec<_>>());
    let ends = [panels[0].0, panels[panels.len() - 1].0];
    let view = still.best_view(a, b, &ends);
    let (columns, rows) = if panels.len() < 4 { (panels.len(), 1) } else { (2, 2) };
    let root = SVGBackend::new(file, (columns as u32 * PANEL.0, rows as u32 * PANEL.1)).into_drawing_area();
    root.fill(&WHITE)?;
    for ((pose, color, words), area) in panels.iter().zip(root.split_evenly((rows, columns))) {
        let mut facets = Vec::new();
        collect(b, &Isometry3::identity(), still.size * FINE, REST, &view, &mut facets);
        let of_b = facets.len();
        collect(a, pose, still.size * FINE, *color, &view, &mut facets);
        let mut owners = view.owners(&facets, 1.0);
        owners.sort_unstable();
        owners.dedup();
        let mut seen: Vec<&Facet> = owners.iter().map(|&i| &facets[i]).collect();
        seen.sort_by(|x, y| x.depth.total_cmp(&y.depth));
        for facet in seen {
            let corners = facet.corners.map(|p| view.pixel(&p)).to_vec();
            area.draw(&Polygon::new(corners.clone(), facet.color.filled()))?;
            // Its border, so that no gap is seen between neighbours.
            area.draw(&PathElement::new([&corners[..], &corners[..1]].concat(), facet.color.stroke_width(1)))?;
        }
        for i in (of_b..facets.len()).filter(|i| owners.binary_search(i).is_err()) {
            let corners = facets[i].corners.map(|p| view.pixel(&p)).to_vec();
            area.draw(&Polygon::new(corners, facets[i].color.mix(0.4).filled()))?;
        }
        let title = format!("{} {}: {words}", query.id, row.kind.name());
        area.draw(&Text::new(title, (MARGIN as i32, MARGIN as i32 / 2), ("sans-serif", 34).into_font().color(&BLACK)))?;
    }
    root.present()?;
    Ok(())
}

/// Two of the best free poses at some time, and their values.
fn way(solver: &mut DepthSolver, query: &Query, row: &Row, options: &DepthOptions) -> Vec<(Isometry3<f64>, f64)> {
    let mut seen: Vec<(Isometry3<f64>, f64)> = Vec::new();
    let mut watch = |progress: &Progress| {
        let nearer = seen.last().is_none_or(|(_, value)| progress.upper < *value);
        if progress.upper.is_finite() && nearer {
            seen.push((*progress.pose, progress.upper));
        }
        false
    };
    if let Some(metric) = bodies::metric(solver.a(), row.kind) {
        solver.depth(&query.pose, metric, options, Some(&mut watch));
    }
    seen.retain(|(_, value)| *value > row.upper * 1.001);
    // The last ones are the interesting ones, but two far ones are better than none.
    let near = seen.iter().filter(|(_, value)| *value < row.upper * FAR).count().max(2).min(seen.len());
    let seen = &seen[seen.len() - near..];
    match seen {
        [] | [_] => seen.to_vec(),
        _ => vec![seen[0], seen[seen.len() / 2]],
    }
}

/// A triangle as it is drawn.
struct Facet {
    corners: [Point3<f64>; 3],
    /// Of its centre, towards the one who looks.
    depth: f64,
    color: RGBColor,
}

/// The visible facets of a body, cut into small ones.
fn collect(mesh: &Mesh, pose: &Isometry3<f64>, fine: f64, color: RGBColor, view: &View, facets: &mut Vec<Facet>) {
    // From above, left of the one who looks.
    let light = (view.near * 0.75 + view.up * 0.5 - view.right * 0.4).normalize();
    for triangle in 0..mesh.triangles().len() as u32 {
        let corners = mesh.corners(triangle).map(|p| pose * p);
        let across = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let Some(mut normal) = across.try_normalize(0.0) else { continue };
        if normal.dot(&view.near) <= 0.0 {
            // The back of a solid is never seen, that of a soup is.
            if mesh.is_solid() {
                continue;
            }
            normal = -normal;
        }
        let bright = 0.45 + 0.55 * normal.dot(&light).max(0.0);
        let shade = |x: u8| (f64::from(x) * bright).round().clamp(0.0, 255.0) as u8;
        let color = RGBColor(shade(color.0), shade(color.1), shade(color.2));
        let mut open = vec![corners];
        while let Some(corners) = open.pop() {
            let length = |k: usize| (corners[(k + 1) % 3] - corners[k]).norm();
            let k = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j))).unwrap_or_default();
            let [p, q, r] = [corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]];
            if length(k) > fine {
                let middle = qdist::nalgebra::center(&p, &q);
                open.extend([[p, middle, r], [middle, q, r]]);
            } else {
                let depth = corners.iter().map(|p| p.coords.dot(&view.near)).sum();
                facets.push(Facet { corners, depth, color });
            }
        }
    }
}

/// All places of both bodies.
struct Scene {
    points: Vec<Point3<f64>>,
    size: f64,
}

impl Scene {
    fn new(a: &Mesh, b: &Mesh, poses: &[Isometry3<f64>]) -> Scene {
        let mut points: Vec<Point3<f64>> = b.triangles().iter().flatten().map(|&v| b.vertices()[v as usize]).collect();
        for pose in poses {
            points.extend(a.triangles().iter().flatten().map(|&v| pose * a.vertices()[v as usize]));
        }
        let low = points.iter().fold(points[0].coords, |m, p| m.inf(&p.coords));
        let high = points.iter().fold(points[0].coords, |m, p| m.sup(&p.coords));
        Scene { points, size: (high - low).norm() }
    }

    /// Of some directions the one where most of A is seen, at all these poses.
    fn best_view(&self, a: &Mesh, b: &Mesh, poses: &[Isometry3<f64>]) -> View {
        const DIRECTIONS: usize = 40;
        /// Pixels.
        const CELL: f64 = 12.0;
        let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
        let views = (0..DIRECTIONS).map(|k| {
            let z = 1.0 - (2 * k + 1) as f64 / DIRECTIONS as f64;
            let (sin, cos) = (golden * k as f64).sin_cos();
            View::new(Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::z() * z, &self.points)
        });
        let visible = |view: &View| -> usize {
            let seen = |pose: &Isometry3<f64>| {
                let mut facets = Vec::new();
                collect(b, &Isometry3::identity(), self.size * FINE, REST, view, &mut facets);
                let of_b = facets.len();
                collect(a, pose, self.size * FINE, REST, view, &mut facets);
                view.owners(&facets, CELL).iter().filter(|&&i| i >= of_b).count()
            };
            poses.iter().map(seen).sum()
        };
        let best = views.map(|view| (visible(&view), view)).max_by_key(|(count, _)| *count);
        best.map_or_else(|| View::new(Vector3::x(), &self.points), |(_, view)| view)
    }
}

/// A parallel projection.
struct View {
    right: Vector3<f64>,
    up: Vector3<f64>,
    /// Towards the one who looks.
    near: Vector3<f64>,
    scale: f64,
    shift: Point2<f64>,
}

impl View {
    /// All points are in the panel.
    fn new(near: Vector3<f64>, points: &[Point3<f64>]) -> View {
        let right = Vector3::z().cross(&near).normalize();
        let up = near.cross(&right);
        let range = |axis: &Vector3<f64>| {
            let along = points.iter().map(|p| p.coords.dot(axis));
            along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
        };
        let (x, y) = (range(&right), range(&up));
        let (width, height) = (f64::from(PANEL.0), f64::from(PANEL.1) - CAPTION);
        let fit = |room: f64, (low, high): (f64, f64)| (room - 2.0 * MARGIN) / (high - low).max(f64::MIN_POSITIVE);
        let scale = fit(width, x).min(fit(height, y));
        let shift =
            Point2::new(0.5 * width - 0.5 * scale * (x.0 + x.1), CAPTION + 0.5 * height + 0.5 * scale * (y.0 + y.1));
        View { right, up, near, scale, shift }
    }

    fn see(&self, p: &Point3<f64>) -> Point2<f64> {
        let (x, y) = (p.coords.dot(&self.right), p.coords.dot(&self.up));
        Point2::new(self.shift.x + self.scale * x, self.shift.y - self.scale * y)
    }

    fn pixel(&self, p: &Point3<f64>) -> (i32, i32) {
        let p = self.see(p);
        (p.x.round() as i32, p.y.round() as i32)
    }

    /// The nearest facet in every cell of a grid that has one (a z-buffer); the cells are squares of so many pixels.
    fn owners(&self, facets: &[Facet], cell: f64) -> Vec<usize> {
        let (width, height) =
            ((f64::from(PANEL.0) / cell).ceil() as usize, (f64::from(PANEL.1) / cell).ceil() as usize);
        let mut nearest = vec![(f64::MIN, usize::MAX); width * height];
        for (i, facet) in facets.iter().enumerate() {
            let [p, q, r] = facet.corners.map(|p| self.see(&p) / cell);
            let cross = |a: Point2<f64>, b: Point2<f64>, c: Point2<f64>| (b - a).perp(&(c - a));
            let area = cross(p, q, r);
            let range = |k: usize, most: usize| {
                let (low, high) = (p[k].min(q[k]).min(r[k]), p[k].max(q[k]).max(r[k]));
                // Centres of cells are at one half.
                (low - 0.5).ceil().max(0.0) as usize..((high + 0.5).floor().max(0.0) as usize).min(most)
            };
            let depth = facet.corners.map(|p| p.coords.dot(&self.near));
            for y in range(1, height) {
                for x in range(0, width) {
                    let at = Point2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let weights = [cross(q, r, at) / area, cross(r, p, at) / area, cross(p, q, at) / area];
                    let here: f64 = weights.iter().zip(depth).map(|(w, z)| w * z).sum();
                    let cell = &mut nearest[y * width + x];
                    if weights.iter().all(|&w| w >= 0.0) && here > cell.0 {
                        *cell = (here, i);
                    }
                }
            }
        }
        nearest.into_iter().map(|(_, i)| i).filter(|&i| i != usize::MAX).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::answer;
    use crate::mesh::input::Kind;
    use qdist::mesh::Model;

    #[test]
    fn before_and_after_are_drawn() {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let body = Model::new(&corners, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]).unwrap();
        let mut solver = DepthSolver::new(&body, &body);
        let folder = std::env::temp_dir().join(format!("qdist_picture_{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        // The second is free: nothing happens, and that is what is seen.
        for (z, panels) in [(0.9, "before after"), (3.0, "before")] {
            let query = Query::new("a/b".into(), "a".into(), "b".into(), Isometry3::translation(0.0, 0.0, z));
            let row = answer::ask(&mut solver, &query, Kind::Disp, &DepthOptions::default(), None);
            draw(&mut solver, &query, &row, &DepthOptions::default(), &folder).unwrap();
            let picture = std::fs::read_to_string(folder.join("a_b_disp.svg")).unwrap();
            assert!(panels.split(' ').all(|word| picture.contains(word)));
            assert_eq!(picture.contains("after"), z < 1.0);
            assert!(picture.matches("<polygon").count() > 50);
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
