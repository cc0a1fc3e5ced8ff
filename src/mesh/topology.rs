//! What touches what in a mesh: edges with their convexity, the wings of every edge, the neighbours of every vertex,
//! connected components. All of it in flat arrays.
//!
//! The local minima of the distance between two meshes are found by *normal cones*: a direction d leaves the surface at a
//! point x as a local minimum does when no direction of the surface at x climbs along it,
//!
//! ```text
//! vertex v:  d . (u - v) <= 0   for every neighbour u
//! edge e:    d . (w - a) <= 0   for the third corner w of every triangle at e, a on e;  d perpendicular to e
//! ```
//!
//! since the surface around x is the union of sectors spanned by these. No winding and no manifold is needed, so it
//! holds for polygon soups: an open edge has one wing and therefore a larger cone.
//!
//! Not every feature can be such a minimum: around a flat edge the faces' other features are as low, and a reentrant edge of a
//! solid has an empty cone. What remains are *candidates*. Each vertex and each edge is *owned* by one of its triangles, so a traversal over
//! pairs of triangles meets every pair of features once.

use nalgebra::{Point3, Vector3};

/// A feature of a mesh, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Feature {
    /// A vertex, by its place in [`Mesh::vertices`](super::Mesh::vertices).
    Vertex(u32),
    /// An edge, by its place in [`Topology::edges`].
    Edge(u32),
    /// A triangle, by its place in [`Mesh::triangles`](super::Mesh::triangles).
    Face(u32),
}

/// How the faces meet at an edge. Convex and reentrant are relative to the winding: the normals point outward.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeKind {
    /// Two faces that bend away from the normals.
    Convex,
    /// Two faces in one plane, to rounding.
    Flat,
    /// Two faces that bend toward the normals.
    Reentrant,
    /// One face only.
    Open,
    /// Anything else: more than two faces, faces that disagree about the winding, or a degenerate face.
    Irregular,
}

/// An edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Its ends, the smaller index first.
    pub vertices: [u32; 2],
    /// Two of its faces; the same one twice when it is open.
    pub faces: [u32; 2],
    /// Convexity.
    pub kind: EdgeKind,
    /// Angle between the normals of the two faces, in radians: positive when convex, negative when reentrant, 0 where
    /// it is not defined.
    pub angle: f64,
}

/// Edges and neighbourhoods of a mesh.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    edges: Vec<Edge>,
    face_edges: Vec<[u32; 3]>,
    neighbours: Lists,
    wings: Lists,
    components: Vec<u32>,
    component_count: u32,
    /// Per triangle, bits 0-2: candidate vertices it owns, bits 3-5: candidate edges.
    owned: Vec<u8>,
    /// Edge uses that do not cancel: an edge of the boundary of this chain of triangles.
    pub(super) unbalanced: Vec<u32>,
    /// Faces per edge, those along the edge (smaller to larger index) and those against it.
    pub(super) uses: Vec<[u32; 2]>,
}

/// Lists of indices, one after another.
#[derive(Clone, Debug, Default)]
struct Lists {
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Lists {
    /// Groups (key, item) pairs by key, without repetition.
    fn new(keys: usize, mut pairs: Vec<(u32, u32)>) -> Lists {
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0u32; keys + 1];
        for &(key, _) in &pairs {
            starts[key as usize + 1] += 1;
        }
        for i in 0..keys {
            starts[i + 1] += starts[i];
        }
        Lists { starts, items: pairs.into_iter().map(|(_, item)| item).collect() }
    }

    fn get(&self, key: u32) -> &[u32] {
        let key = key as usize;
        &self.items[self.starts[key] as usize..self.starts[key + 1] as usize]
    }
}

/// Faces whose normals differ by less than this angle (and by what rounding may do to the normals) are in one plane.
const FLAT: f64 = 1e-11;

impl Topology {
    /// Of valid triangles over these vertices. O(n log n).
    pub(super) fn new(vertices: &[Point3<f64>], triangles: &[[u32; 3]]) -> Topology {
        let mut sides: Vec<([u32; 2], u32, u8, bool)> = Vec::with_capacity(3 * triangles.len());
        for (face, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                let (from, to) = (corners[k], corners[(k + 1) % 3]);
                sides.push(([from.min(to), from.max(to)], face as u32, k as u8, from <= to));
            }
        }
        sides.sort_unstable();
        let mut topology = Topology { face_edges: vec![[0; 3]; triangles.len()], ..Topology::default() };
        let mut group = DisjointSets::new(triangles.len());
        let (mut neighbours, mut wings) = (Vec::new(), Vec::new());
        for run in sides.chunk_by(|x, y| x.0 == y.0) {
            let edge = topology.edges.len() as u32;
            let along = run.iter().filter(|side| side.3).count() as u32;
            let uses = [along, run.len() as u32 - along];
            if uses[0] != uses[1] {
                topology.unbalanced.push(edge);
            }
            topology.uses.push(uses);
            let ends = run[0].0;
            for &(_, face, k, _) in run {
                topology.face_edges[face as usize][k as usize] = edge;
                wings.push((edge, triangles[face as usize][(k as usize + 2) % 3]));
                group.join(face, run[0].1);
            }
            neighbours.extend([(ends[0], ends[1]), (ends[1], ends[0])]);
            let faces = [run[0].1, run[run.len() - 1].1];
            let (kind, angle) = bend(vertices, triangles, run.len(), uses, ends, faces);
            topology.edges.push(Edge { vertices: ends, faces, kind, angle });
        }
        topology.neighbours = Lists::new(vertices.len(), neighbours);
        topology.wings = Lists::new(topology.edges.len(), wings);
        (topology.components, topology.component_count) = group.numbered();
        topology
    }

    /// Chooses the candidates and their owners. Of a `plain` surface, one of a solid that does not cross itself, reentrant edges are none.
    pub(super) fn set_owners(&mut self, vertex_count: usize, triangles: &[[u32; 3]], plain: bool) {
        let candidate = |kind| match kind {
            EdgeKind::Flat => false,
            EdgeKind::Reentrant => !plain,
            EdgeKind::Convex | EdgeKind::Open | EdgeKind::Irregular => true,
        };
        let mut vertex_taken = vec![true; vertex_count];
        let mut edge_taken: Vec<bool> = self.edges.iter().map(|edge| !candidate(edge.kind)).collect();
        for (edge, taken) in self.edges.iter().zip(&edge_taken) {
            if !taken {
                edge.vertices.iter().for_each(|&v| vertex_taken[v as usize] = false);
            }
        }
        self.owned = vec![0; triangles.len()];
        for (face, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                if !std::mem::replace(&mut vertex_taken[corners[k] as usize], true) {
                    self.owned[face] |= 1 << k;
                }
                if !std::mem::replace(&mut edge_taken[self.face_edges[face][k] as usize], true) {
                    self.owned[face] |= 8 << k;
                }
            }
        }
    }

    /// All edges.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The edges of a triangle; the k-th goes from corner k to the next.
    pub fn face_edges(&self, face: u32) -> [u32; 3] {
        self.face_edges[face as usize]
    }

    /// The edge of two vertices, if there is one. O(log n).
    pub fn edge_between(&self, v: u32, w: u32) -> Option<u32> {
        let ends = [v.min(w), v.max(w)];
        self.edges.binary_search_by_key(&ends, |edge| edge.vertices).ok().map(|edge| edge as u32)
    }

    /// The vertices that share an edge with this one, ascending.
    pub fn neighbours(&self, vertex: u32) -> &[u32] {
        self.neighbours.get(vertex)
    }

    /// The third corners of the triangles at this edge, ascending.
    pub fn wings(&self, edge: u32) -> &[u32] {
        self.wings.get(edge)
    }

    /// The component (connected by edges) that each triangle belongs to.
    pub fn components(&self) -> &[u32] {
        &self.components
    }

    /// Number of components.
    pub fn component_count(&self) -> u32 {
        self.component_count
    }

    /// The candidates that this triangle owns: bits 0-2 vertices, bits 3-5 edges.
    pub(super) fn owned(&self, face: u32) -> u8 {
        self.owned[face as usize]
    }
}

/// Twice the area times the unit normal.
pub(super) fn area_vector(vertices: &[Point3<f64>], corners: [u32; 3]) -> Vector3<f64> {
    let [a, b, c] = corners.map(|v| vertices[v as usize]);
    (b - a).cross(&(c - a))
}

fn bend(
    vertices: &[Point3<f64>],
    triangles: &[[u32; 3]],
    count: usize,
    uses: [u32; 2],
    ends: [u32; 2],
    faces: [u32; 2],
) -> (EdgeKind, f64) {
    if count == 1 {
        return (EdgeKind::Open, 0.0);
    }
    if count != 2 || uses != [1, 1] {
        return (EdgeKind::Irregular, 0.0);
    }
    let mut normals = [Vector3::zeros(); 2];
    let mut doubt = FLAT;
    for (normal, face) in normals.iter_mut().zip(faces) {
        let corners = triangles[face as usize];
        let area = area_vector(vertices, corners);
        let [a, b, c] = corners.map(|v| vertices[v as usize]);
        let size = area.norm();
        let coordinate = corners.iter().fold(0.0f64, |m, &v| m.max(vertices[v as usize].coords.amax()));
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        // The direction of an area vector is off by the rounding of the coordinates over the height of the triangle.
        doubt += 16.0 * f64::EPSILON * (longest + coordinate) * longest / size;
        *normal = area / size;
    }
    if !(doubt < 0.1) {
        return (EdgeKind::Irregular, 0.0);
    }
    // The face on the left of the edge runs along it: turning its normal into the other one about the edge is positive when convex.
    let [from, to] = ends.map(|v| vertices[v as usize]);
    let left_first = {
        let corners = triangles[faces[0] as usize];
        (0..3).any(|k| [corners[k], corners[(k + 1) % 3]] == ends)
    };
    let [left, right] = if left_first { normals } else { [normals[1], normals[0]] };
    let along = (to - from).normalize();
    let angle = left.cross(&right).dot(&along).atan2(left.dot(&right));
    if angle.abs() <= doubt {
        (EdgeKind::Flat, angle)
    } else if !(angle.abs() < std::f64::consts::PI - doubt) {
        (EdgeKind::Irregular, angle)
    } else if angle > 0.0 {
        (EdgeKind::Convex, angle)
    } else {
        (EdgeKind::Reentrant, angle)
    }
}

/// Union-find with path halving.
struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    fn new(n: usize) -> Self {
        DisjointSets { parent: (0..n as u32).collect() }
    }

    fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let up = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = up;
            x = up;
        }
        x
    }

    /// The smaller index becomes the root.
    fn join(&mut self, x: u32, y: u32) {
        let (x, y) = (self.find(x), self.find(y));
        self.parent[x.max(y) as usize] = x.min(y);
    }

    /// Numbers the sets in the order of their first member.
    fn numbered(mut self) -> (Vec<u32>, u32) {
        let n = self.parent.len();
        let (mut number, mut count) = (vec![0u32; n], 0);
        for x in 0..n as u32 {
            let root = self.find(x);
            if root == x {
                number[x as usize] = count;
                count += 1;
            } else {
                number[x as usize] = number[root as usize];
            }
        }
        (number, count)
    }
}
