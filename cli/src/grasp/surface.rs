//! A wrench set of three dimensions and the largest d Q in it, seen from the front (the paper's Fig. 3).
//!
//! Both are drawn as the hulls of support points along many directions: of a polytope these are its vertices. The view is a parallel projection. Since
//! one convex set lies in the other, the order is: back of the outer one, the inner one, front of the outer one.

use std::error::Error;
use std::path::Path;

use plotters::prelude::*;
use qdist::Vector;
use qdist::grasp::WrenchSet;
use qdist::nalgebra::SMatrix;
use qdist::support::Support;

use crate::grasp::plot::{COORDINATES, INSIDE, SET, Scene, font};

type Point = Vector<f64, 3>;

const SIZE: (i32, i32) = (1200, 1000);
/// Directions that are asked; and of a smooth set, whose every point is another one.
const DIRECTIONS: usize = 2000;
const SMOOTH: usize = 300;

/// `count` unit vectors, evenly spread: a spiral from pole to pole.
fn directions(count: usize) -> impl Iterator<Item = Point> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - (2 * i + 1) as f64 / count as f64;
        let (r, turn) = ((1.0 - z * z).sqrt(), golden * i as f64);
        Point::new(r * turn.cos(), r * turn.sin(), z)
    })
}

/// A convex polytope: its vertices, and the faces as polygons with outer normals.
struct Hull {
    points: Vec<Point>,
    faces: Vec<(Point, Vec<Point>)>,
    /// Faces are of the set itself, not of a sample of a smooth one.
    flat: bool,
}

impl Hull {
    /// Of the set with this support mapping; `smooth`: how many points, where every point is another one.
    fn of(mapping: impl Fn(&Point) -> Option<Point>, smooth: usize) -> Self {
        let sample = |count: usize| {
            let mut points: Vec<Point> = Vec::new();
            for point in directions(count).filter_map(|u| mapping(&u)) {
                let close = 1e-7 * point.norm().max(1e-300);
                if !points.iter().any(|p| (p - point).norm() <= close) {
                    points.push(point);
                }
            }
            points
        };
        let mut points = sample(DIRECTIONS);
        let flat = points.len() < smooth / 2;
        if !flat {
            points = sample(smooth);
        }
        let faces = faces(&points);
        Self { points, faces, flat }
    }
}

/// The faces of the hull, as outer normals and polygons. Around an edge of the hull its points span less than half a turn: the outermost of them to
/// either side makes a face with it. Of two points that are no edge, that plane has points above it.
fn faces(points: &[Point]) -> Vec<(Point, Vec<Point>)> {
    let size = points.iter().fold(0.0, |m: f64, p| m.max(p.norm()));
    let slack = 1e-9 * size;
    let mut faces: Vec<(Point, Vec<Point>)> = Vec::new();
    for (i, from) in points.iter().enumerate() {
        for (to, side) in points[i + 1..].iter().flat_map(|to| [(to, 1.0), (to, -1.0)]) {
            let across = |p: &Point| (to - from).cross(&(p - from)) * side;
            let beside = points.iter().filter(|p| across(p).norm() > slack * size);
            let Some(outer) = beside.reduce(|outer, p| if across(outer).dot(&(p - from)) > 0.0 { p } else { outer })
            else {
                continue;
            };
            let normal = across(outer).normalize();
            let height = normal.dot(from);
            if points.iter().any(|p| normal.dot(p) > height + slack) {
                continue;
            }
            if !faces.iter().any(|(other, _)| other.dot(&normal) > 1.0 - 1e-12) {
                let on: Vec<Point> = points.iter().filter(|p| normal.dot(p) > height - slack).copied().collect();
                faces.push((normal, around(on, &normal)));
            }
        }
    }
    faces
}

/// The points of a face in order around its middle.
fn around(mut points: Vec<Point>, normal: &Point) -> Vec<Point> {
    let middle = points.iter().sum::<Point>() / points.len() as f64;
    let x = (points[0] - middle).normalize();
    let y = normal.cross(&x);
    let angle = |p: &Point| (p - middle).dot(&y).atan2((p - middle).dot(&x));
    points.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
    points
}

/// A parallel projection.
struct View {
    right: Point,
    up: Point,
    /// Towards the one who looks.
    near: Point,
    scale: f64,
    center: (f64, f64),
}

impl View {
    /// From above and aside, so that all of the points are in the picture.
    fn of(points: &[Point]) -> Self {
        let near = Point::new(0.55, -0.75, 0.45).normalize();
        let right = Point::z().cross(&near).normalize();
        let up = near.cross(&right);
        let range = |axis: &Point| {
            let along = points.iter().map(|p| p.dot(axis));
            along.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)))
        };
        let (x, y) = (range(&right), range(&up));
        let room = (f64::from(SIZE.0) - 200.0, f64::from(SIZE.1) - 240.0);
        let scale = (room.0 / (x.1 - x.0)).min(room.1 / (y.1 - y.0));
        let center =
            (f64::from(SIZE.0) / 2.0 - scale * (x.0 + x.1) / 2.0, f64::from(SIZE.1) / 2.0 + scale * (y.0 + y.1) / 2.0);
        Self { right, up, near, scale, center }
    }

    fn see(&self, p: &Point) -> (i32, i32) {
        let (x, y) = (self.center.0 + self.scale * p.dot(&self.right), self.center.1 - self.scale * p.dot(&self.up));
        (x.round() as i32, y.round() as i32)
    }

    /// How bright a face is.
    fn light(&self, normal: &Point) -> f64 {
        let lamp = (self.near + self.up * 0.8 - self.right * 0.6).normalize();
        0.35 + 0.65 * lamp.dot(normal).max(0.0)
    }
}

fn shade(color: RGBColor, light: f64) -> RGBColor {
    // Towards white where light falls, towards black where none does.
    let part = |x: u8| {
        let x = f64::from(x);
        let lit = if light > 0.7 { x + (255.0 - x) * (light - 0.7) } else { x * (0.4 + 0.6 * light / 0.7) };
        lit.clamp(0.0, 255.0) as u8
    };
    RGBColor(part(color.0), part(color.1), part(color.2))
}

pub fn draw(file: &Path, title: &str, scene: &Scene, basis: &SMatrix<f64, 6, 3>) -> Result<(), Box<dyn Error>> {
    let set = WrenchSet::new(&scene.wrenches.parts, scene.reference.norm);
    let outer = Hull::of(|u| set.support(&(basis * u)).ok().map(|p| basis.tr_mul(&p)), SMOOTH);
    let d = scene.d();
    let inner = Hull::of(|u| scene.reference.q.farthest(&(basis * u)).map(|q| basis.tr_mul(&q) * d), SMOOTH);
    // The axes stick out of the set.
    let tips: Vec<Point> = (0..3)
        .map(|i| {
            let axis = Point::from_fn(|j, _| f64::from(i == j));
            let size = outer.points.iter().fold(0.0, |m: f64, p| m.max(p[i]));
            axis * (1.2 * size).max(0.2 * outer.points.iter().fold(0.0, |m: f64, p| m.max(p.norm())))
        })
        .collect();
    let all: Vec<Point> = outer.points.iter().chain(&tips).copied().collect();
    let view = View::of(&all);
    let root = SVGBackend::new(file, (SIZE.0 as u32, SIZE.1 as u32)).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(title.to_string(), (40, 24), font(30)))?;
    let polygon =
        |face: &[Point], style: ShapeStyle| Polygon::new(face.iter().map(|p| view.see(p)).collect::<Vec<_>>(), style);
    let outline = |face: &[Point], style: ShapeStyle| {
        let closed = face.iter().chain(face.first()).map(|p| view.see(p));
        PathElement::new(closed.collect::<Vec<_>>(), style)
    };
    let front = |(normal, _): &&(Point, Vec<Point>)| normal.dot(&view.near) > 0.0;
    for (_, face) in outer.faces.iter().filter(|f| !front(f)) {
        root.draw(&polygon(face, SET.mix(0.10).filled()))?;
        if outer.flat {
            root.draw(&outline(face, SET.mix(0.35).stroke_width(1)))?;
        }
    }
    for (tip, name) in tips.iter().zip(axis_names(basis)) {
        root.draw(&PathElement::new([view.see(&Point::zeros()), view.see(tip)], BLACK.mix(0.6).stroke_width(2)))?;
        let (x, y) = view.see(&(tip * 1.04));
        root.draw(&Text::new(name, (x - 10, y - 14), font(28)))?;
    }
    if inner.faces.is_empty() {
        // A flat Q: a segment, as a line.
        for point in &inner.points {
            root.draw(&PathElement::new([view.see(&Point::zeros()), view.see(point)], INSIDE.stroke_width(7)))?;
        }
    }
    for (normal, face) in inner.faces.iter().filter(front) {
        let style = shade(INSIDE, view.light(normal));
        root.draw(&polygon(face, style.filled()))?;
        // Neighbours overlap by a line's width: no gaps between them.
        root.draw(&outline(face, if inner.flat { shade(INSIDE, 0.2) } else { style }.stroke_width(1)))?;
    }
    for (normal, face) in outer.faces.iter().filter(front) {
        root.draw(&polygon(face, shade(SET, view.light(normal)).mix(0.28).filled()))?;
        if outer.flat {
            root.draw(&outline(face, SET.stroke_width(2)))?;
        }
    }
    let legend = "blue: the wrench set; red: the largest d Q inside; moments in units of force times length";
    root.draw(&Text::new(legend, (40, SIZE.1 - 44), font(22)))?;
    root.present()?;
    Ok(())
}

/// Coordinates of R^6 where the basis is made of them.
fn axis_names(basis: &SMatrix<f64, 6, 3>) -> [String; 3] {
    std::array::from_fn(|k| {
        let column = basis.column(k);
        let axis = (0..6).find(|&i| column[i] == 1.0);
        axis.map_or(format!("r{}", k + 1), |i| COORDINATES[i].to_string())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cube_has_six_faces_of_four_corners() {
        let cube = Hull::of(|u| Some(u.map(f64::signum)), SMOOTH);
        assert_eq!((cube.points.len(), cube.faces.len(), cube.flat), (8, 6, true));
        assert!(cube.faces.iter().all(|(_, face)| face.len() == 4));
        // In order: every side is an edge of the cube.
        for (_, face) in &cube.faces {
            let sides = face.iter().zip(face.iter().cycle().skip(1));
            assert!(sides.into_iter().all(|(a, b)| ((a - b).norm() - 2.0).abs() < 1e-12));
        }
    }

    /// Euler: triangles around a sphere.
    #[test]
    fn a_ball_is_round() {
        let ball = Hull::of(|u| Some(*u), 60);
        assert_eq!((ball.points.len(), ball.flat), (60, false));
        let corners: usize = ball.faces.iter().map(|(_, face)| face.len()).sum();
        assert_eq!(60 + ball.faces.len(), 2 + corners / 2);
    }
}
