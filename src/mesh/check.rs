//! What is wrong with a mesh, where, and whether it bounds a solid nevertheless.
//!
//! Triangles bound a solid when their winding numbers are whole: every edge is used as often in one direction as in the other. The
//! inside is where the winding number is positive. Every component (connected by edges) then has a signed volume. A component of
//! positive volume is an outer shell; one of negative volume is a cavity if it lies inside the others, and inverted otherwise. Edges with four
//! faces (two boxes that share an edge) and degenerate triangles are defects, but a solid may have them.
//!
//! Intersections of a mesh with itself are not looked for: where shells overlap, the winding number is two, still inside.

use super::topology::{Topology, area_vector};
use nalgebra::{Point3, Vector3};

/// The defects of a mesh. All lists are empty for a clean one. Edges are indices into
/// [`Topology::edges`](super::Topology::edges), triangles and vertices into the caller's arrays.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Edges of one triangle only.
    pub open_edges: Vec<u32>,
    /// Edges of more than two triangles.
    pub non_manifold_edges: Vec<u32>,
    /// Edges of two triangles that both use it in the same direction: one of them is wound the wrong way.
    pub inconsistent_edges: Vec<u32>,
    /// Triangles without area, to rounding of their coordinates.
    pub degenerate_triangles: Vec<u32>,
    /// Triangles with the same three vertices as one before, in any order.
    pub duplicate_triangles: Vec<u32>,
    /// Vertices of no triangle.
    pub unreferenced_vertices: Vec<u32>,
    /// Closed components that are wound inward and are no cavity.
    pub inverted_components: Vec<u32>,
    /// Closed components without volume, to rounding.
    pub flat_components: Vec<u32>,
    /// Number of components, connected by edges.
    pub components: u32,
    /// Signed volume of each component; meaningless for one that is not closed.
    pub volumes: Vec<f64>,
    /// Whether the mesh bounds a solid.
    pub solid: bool,
}

impl Report {
    /// Whether there is nothing to report.
    pub fn is_clean(&self) -> bool {
        self.solid
            && self.non_manifold_edges.is_empty()
            && self.degenerate_triangles.is_empty()
            && self.duplicate_triangles.is_empty()
            && self.unreferenced_vertices.is_empty()
    }

    /// O(n log n), and O(n) more for every cavity.
    pub(super) fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]], topology: &Topology) -> Report {
        let mut report = Report { components: topology.component_count(), ..Report::default() };
        for (edge, uses) in (0u32..).zip(&topology.uses) {
            match uses {
                [1, 1] => {}
                [0, 1] | [1, 0] => report.open_edges.push(edge),
                [0, 2] | [2, 0] => report.inconsistent_edges.push(edge),
                _ => report.non_manifold_edges.push(edge),
            }
        }
        let mut referenced = vec![false; vertices.len()];
        for (face, corners) in (0u32..).zip(triangles) {
            corners.iter().for_each(|&v| referenced[v as usize] = true);
            if is_degenerate(vertices, *corners) {
                report.degenerate_triangles.push(face);
            }
        }
        report.unreferenced_vertices = (0u32..).zip(&referenced).filter(|(_, r)| !**r).map(|(v, _)| v).collect();
        report.duplicate_triangles = duplicates(triangles);
        report.judge_components(vertices, triangles, topology);
        report.solid = topology.unbalanced.is_empty()
            && report.inverted_components.is_empty()
            && report.flat_components.len() < report.components as usize;
        report
    }

    fn judge_components(&mut self, vertices: &[Point3<f64>], triangles: &[[u32; 3]], topology: &Topology) {
        let count = self.components as usize;
        // Volumes about one vertex of the component, so that a far origin does no harm.
        let mut origin: Vec<Option<Point3<f64>>> = vec![None; count];
        let mut doubt = vec![0.0; count];
        self.volumes = vec![0.0; count];
        for (corners, &c) in triangles.iter().zip(topology.components()) {
            let c = c as usize;
            let [p, q, r] = corners.map(|v| vertices[v as usize]);
            let o = *origin[c].get_or_insert(p);
            let (p, q, r) = (p - o, q - o, r - o);
            self.volumes[c] += p.dot(&q.cross(&r)) / 6.0;
            let size = p.amax().max(q.amax()).max(r.amax());
            let coordinate = o.coords.amax() + size;
            doubt[c] += 16.0 * f64::EPSILON * coordinate * (q - p).amax().max((r - p).amax()) * size;
        }
        let mut closed = vec![true; count];
        for &edge in &topology.unbalanced {
            closed[topology.components()[topology.edges()[edge as usize].faces[0] as usize] as usize] = false;
        }
        for c in 0..count {
            if !closed[c] {
                continue;
            }
            if self.volumes[c].abs() <= doubt[c] {
                self.flat_components.push(c as u32);
            } else if self.volumes[c] < 0.0 {
                let others = triangles.iter().zip(topology.components()).filter(|(_, d)| **d as usize != c);
                let around: f64 = others
                    .zip(std::iter::repeat(origin[c].unwrap_or_default()))
                    .map(|((corners, _), p)| solid_angle(&p, corners.map(|v| &vertices[v as usize])))
                    .sum();
                if !(around > 2.0 * std::f64::consts::PI) {
                    self.inverted_components.push(c as u32);
                }
            }
        }
    }
}

/// The signed solid angle of a triangle seen from a point (van Oosterom and Strackee, 1983): positive from behind, so
/// that a closed surface wound outward adds up to 4 pi inside and 0 outside.
pub(super) fn solid_angle(p: &Point3<f64>, corners: [&Point3<f64>; 3]) -> f64 {
    let [a, b, c] = corners.map(|x| x - p);
    let [la, lb, lc] = [a.norm(), b.norm(), c.norm()];
    let across = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * a.dot(&b.cross(&c)).atan2(across)
}

fn is_degenerate(vertices: &[Point3<f64>], corners: [u32; 3]) -> bool {
    let [a, b, c] = corners.map(|v| vertices[v as usize]);
    let longest = (b - a).amax().max((c - b).amax()).max((a - c).amax());
    let coordinate = a.coords.amax().max(b.coords.amax()).max(c.coords.amax());
    let area: Vector3<f64> = area_vector(vertices, corners);
    !(area.amax() > 4.0 * f64::EPSILON * (longest + coordinate) * longest)
}

fn duplicates(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut keys: Vec<([u32; 3], u32)> = (0u32..)
        .zip(triangles)
        .map(|(face, corners)| {
            let mut key = *corners;
            key.sort_unstable();
            (key, face)
        })
        .collect();
    keys.sort_unstable();
    let mut found: Vec<u32> = keys.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| w[1].1).collect();
    found.sort_unstable();
    found
}
