//! Pictures of a query: before, two free poses on the way, after (the paper's Figs. 6 to 8), from where A is best seen.
//!
//! Parallel projection, and what is farther is drawn first (`order`). Only what is visible in some pixel is drawn; and A once more on top of all,
//! transparent, so that what B hides of it shows.

use std::fmt::Write;
use std::path::Path;

use qdist::mesh::{DepthOptions, DepthSolver, Mesh, Progress};
use qdist::nalgebra::{Isometry3, Point2, Point3, Vector3};

use crate::Trouble;
use crate::mesh::answer::Row;
use crate::mesh::bodies;
use crate::mesh::input::Query;
use crate::mesh::order::{Facet, back_to_front};

/// A panel's width and height; there are two by two.
const PANEL: (u32, u32) = (1000, 860);
/// Above the bodies, for the words.
const CAPTION: f64 = 70.0;
const MARGIN: f64 = 30.0;
/// Poses on the way are at most this much farther than the last.
const FAR: f64 = 4.0;
/// What is nearer than this to a plane lies in it, in units of the scene.
const SMALL: f64 = 1e-9;
/// What is seen in none of the squares of this size is not drawn, in pixels; borders are as wide.
const SEEN: f64 = 1.0;

const REST: [u8; 3] = [152, 166, 186];
const BEFORE: [u8; 3] = [214, 66, 54];
const WAY: [u8; 3] = [240, 160, 60];
const AFTER: [u8; 3] = [250, 215, 70];

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
    std::fs::write(&file, drawn(solver, query, row, options)).map_err(|error| format!("{}: {error}", file.display()))
}

fn drawn(solver: &mut DepthSolver, query: &Query, row: &Row, options: &DepthOptions) -> String {
    let mut panels = vec![(query.pose, BEFORE, "before".to_string())];
    if row.upper.is_finite() && row.upper > 0.0 {
        let way = way(solver, query, row, options);
        panels.extend(way.iter().map(|(pose, upper)| (*pose, WAY, format!("on the way, free: depth <= {upper:.5}"))));
        let (lower, upper) = (row.lower, row.upper);
        panels.push((row.pose, AFTER, format!("after, free: {lower:.5} <= depth <= {upper:.5}")));
    }
    let (a, b) = (solver.a().mesh(), solver.b().mesh());
    let scene = Scene::new(a, b, &panels.iter().map(|p| p.0).collect::<Vec<_>>());
    let ends = [panels[0].0, panels[panels.len() - 1].0];
    let view = scene.best_view(a, b, &ends);
    let (columns, rows) = if panels.len() < 4 { (panels.len(), 1) } else { (2, 2) };
    let (width, height) = (columns as u32 * PANEL.0, rows as u32 * PANEL.1);
    let mut svg = format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    for (k, (pose, color, words)) in panels.iter().enumerate() {
        let corner = Point2::new(f64::from(PANEL.0) * (k % columns) as f64, f64::from(PANEL.1) * (k / columns) as f64);
        view.panel(&mut svg, corner, scene.facets(a, b, pose, *color, &view), scene.size * SMALL);
        let title = format!("{} {}: {words}", query.id, row.kind.name());
        let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (x, y) = (corner.x + MARGIN, corner.y + 1.5 * MARGIN);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"34\">{title}</text>");
    }
    svg + "</svg>\n"
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

/// The facets of a body that are towards the one who looks.
fn collect(mesh: &Mesh, pose: &Isometry3<f64>, color: [u8; 3], of_a: bool, view: &View, facets: &mut Vec<Facet>) {
    // From above, left of the one who looks.
    let light = (view.near * 0.75 + view.up * 0.5 - view.right * 0.4).normalize();
    for triangle in 0..mesh.triangles().len() as u32 {
        let corners = mesh.corners(triangle).map(|p| pose * p);
        let across = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        let Some(mut normal) = across.try_normalize(0.0) else { continue };
        // The back of a solid is never seen, that of a soup is.
        if normal.dot(&view.near) < 0.0 && !mesh.is_solid() {
            normal = -normal;
        }
        if normal.dot(&view.near) > EDGE_ON {
            let bright = 0.45 + 0.55 * normal.dot(&light).max(0.0);
            let color = color.map(|x| (f64::from(x) * bright).round().clamp(0.0, 255.0) as u8);
            facets.push(Facet { corners: corners.to_vec(), normal, color, of_a });
        }
    }
}

/// Facets that are seen from the side are not seen: the cosine.
const EDGE_ON: f64 = 1e-6;

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

    /// Those of both bodies, A in this pose.
    fn facets(&self, a: &Mesh, b: &Mesh, pose: &Isometry3<f64>, color: [u8; 3], view: &View) -> Vec<Facet> {
        let mut facets = Vec::new();
        collect(b, &Isometry3::identity(), REST, false, view, &mut facets);
        collect(a, pose, color, true, view, &mut facets);
        facets
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
                let facets = self.facets(a, b, pose, REST, view);
                view.owners(&facets, CELL).iter().flatten().filter(|&&i| facets[i].of_a).count()
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

    /// Draws them into the panel with this corner.
    fn panel(&self, svg: &mut String, corner: Point2<f64>, facets: Vec<Facet>, small: f64) {
        let facets = back_to_front(facets, [self.right, self.up], small);
        let owners = self.owners(&facets, SEEN);
        let mut seen = vec![false; facets.len()];
        owners.iter().flatten().for_each(|&i| seen[i] = true);
        for (facet, _) in facets.iter().zip(&seen).filter(|(_, seen)| **seen) {
            self.polygon(svg, corner, facet);
        }
        // A alone, if there is anything of it behind B: transparent as a whole, so that what of it is seen anyhow stays as it is.
        let a: Vec<Facet> = facets.iter().filter(|facet| facet.of_a).cloned().collect();
        let alone = self.owners(&a, SEEN);
        if !alone.iter().zip(&owners).any(|(a, all)| a.is_some() && !all.is_some_and(|i| facets[i].of_a)) {
            return;
        }
        let mut seen = vec![false; a.len()];
        alone.iter().flatten().for_each(|&i| seen[i] = true);
        svg.push_str("<g opacity=\"0.4\">\n");
        for (facet, _) in a.iter().zip(&seen).filter(|(_, seen)| **seen) {
            self.polygon(svg, corner, facet);
        }
        svg.push_str("</g>\n");
    }

    fn polygon(&self, svg: &mut String, corner: Point2<f64>, facet: &Facet) {
        let [r, g, b] = facet.color;
        svg.push_str("<polygon points=\"");
        for p in facet.corners.iter().map(|p| self.see(p) + corner.coords) {
            let _ = write!(svg, "{:.1},{:.1} ", p.x, p.y);
        }
        // (With a border, so that no gap is seen between neighbours.)
        let color = format!("#{r:02X}{g:02X}{b:02X}");
        let _ = writeln!(svg, "\" fill=\"{color}\" stroke=\"{color}\" stroke-linejoin=\"round\"/>");
    }

    /// The nearest facet in every cell of a grid (a z-buffer); the cells are squares of so many pixels.
    fn owners(&self, facets: &[Facet], cell: f64) -> Vec<Option<usize>> {
        let (width, height) =
            ((f64::from(PANEL.0) / cell).ceil() as usize, (f64::from(PANEL.1) / cell).ceil() as usize);
        let mut nearest = vec![(f64::MIN, None); width * height];
        for (i, facet) in facets.iter().enumerate() {
            let corners: Vec<Point2<f64>> = facet.corners.iter().map(|p| self.see(p) / cell).collect();
            // Centres of cells are at one half.
            let range = |of: fn(&Point2<f64>) -> f64, most: usize| {
                let (low, high) = corners.iter().map(of).fold((f64::MAX, f64::MIN), |(l, h), x| (l.min(x), h.max(x)));
                (low - 0.5).ceil().max(0.0) as usize..((high + 0.5).floor().max(0.0) as usize).min(most)
            };
            let tilt = facet.normal / facet.normal.dot(&self.near) * (cell / self.scale);
            let (across, down) = (-tilt.dot(&self.right), tilt.dot(&self.up));
            let first = facet.corners[0].coords.dot(&self.near);
            for y in range(|p| p.y, height) {
                for x in range(|p| p.x, width) {
                    let at = Point2::new(x as f64 + 0.5, y as f64 + 0.5);
                    let depth = first + across * (at.x - corners[0].x) + down * (at.y - corners[0].y);
                    let cell = &mut nearest[y * width + x];
                    if depth > cell.0 && contains(&corners, &at) {
                        *cell = (depth, Some(i));
                    }
                }
            }
        }
        nearest.into_iter().map(|(_, i)| i).collect()
    }
}

/// Whether a point is in a convex polygon, whichever way that turns.
fn contains(corners: &[Point2<f64>], at: &Point2<f64>) -> bool {
    let (mut left, mut right) = (false, false);
    for (i, p) in corners.iter().enumerate() {
        let turn = (corners[(i + 1) % corners.len()] - p).perp(&(at - p));
        left |= turn > 0.0;
        right |= turn < 0.0;
    }
    !(left && right)
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
            // Up to three facets each are seen, and of them some are cut.
            assert!((2..100).contains(&picture.matches("<polygon").count()) && picture.len() < 20_000);
        }
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
