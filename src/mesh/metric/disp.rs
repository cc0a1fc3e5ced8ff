//! DISP: the farthest that any point of a body moves between two poses.
//!
//! The displacement is an affine function of the point, so its length is convex and largest at a corner of the convex hull. The
//! corners stand in a binary tree of boxes; a box with centre c and half extents h cannot hold a displacement M r + m longer
//! than | |M c + m| + |M| h | (componentwise absolute values), and is passed over when that is no more than the best
//! so far. A few boxes are looked at, whatever the number of corners; with a pure translation, one.

use super::super::hull::{HullError, hull_vertices};
use super::super::optimize::minimax::{self, Body, Field, stiffness};
use super::super::optimize::quadratic::violation;
use super::super::optimize::{Constraint, Quadratic, Step, StepEnd, StepError, StepMemory, StepOptions};
use super::{BodyFrame, Certificate, Metric, prepare, quadratic_step};
use core::fmt;
use nalgebra::{Isometry3, Matrix3, Matrix6, Point3, Vector3, Vector6};

/// Corners in a leaf.
const LEAF: usize = 6;
/// Deep enough for 2^32 corners: the tree halves their number exactly.
const DEPTH: usize = 40;

/// Why points have no displacement metric.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DispError {
    /// They have no hull.
    Hull(HullError),
    /// They lie on a line, about which rotations cannot be seen.
    Collinear,
}

impl fmt::Display for DispError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            DispError::Hull(error) => error.fmt(f),
            DispError::Collinear => write!(f, "the points lie on a line"),
        }
    }
}

impl std::error::Error for DispError {}

impl From<HullError> for DispError {
    fn from(error: HullError) -> Self {
        DispError::Hull(error)
    }
}

/// A box of corners.
#[derive(Clone, Copy, Debug)]
struct Node {
    centre: Vector3<f64>,
    half: Vector3<f64>,
    /// Corners, as a range.
    range: (u32, u32),
    /// The second child; the first is the next node. 0 in a leaf.
    second: u32,
}

/// The largest displacement of a body's points.
///
/// ```
/// use nalgebra::{Isometry3, Point3, Vector3};
/// use qdist::mesh::metric::{Disp, Metric};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Point3::from);
/// let disp = Disp::new(&corners)?;
/// let half_turn = Isometry3::rotation(Vector3::z() * core::f64::consts::PI);
/// assert!((disp.distance(&Isometry3::identity(), &half_turn) - 2.0).abs() < 1e-15);
/// # Ok::<(), qdist::mesh::metric::DispError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Disp {
    frame: BodyFrame,
    /// Relative to the centre, in the frame's axes, in the order of the tree.
    corners: Vec<Vector3<f64>>,
    nodes: Vec<Node>,
    /// Corners that span the body.
    reference: [Vector3<f64>; 4],
    stiffness: Matrix6<f64>,
}

impl Disp {
    /// The metric of a body with these vertices. Only possible corners of their hull are kept.
    ///
    /// # Errors
    /// [`DispError`]: no points, a coordinate that is not finite, or points on one line.
    ///
    /// Cost: that of [`hull_vertices`] and O(n log n).
    pub fn new(vertices: &[Point3<f64>]) -> Result<Self, DispError> {
        let hull = hull_vertices(vertices)?;
        let points = || hull.iter().map(|&i| vertices[i as usize].coords);
        let low = points().fold(Vector3::repeat(f64::MAX), |m, p| m.inf(&p));
        let high = points().fold(Vector3::repeat(f64::MIN), |m, p| m.sup(&p));
        let middle = low + (high - low) / 2.0;
        let size = (high - low).amax();
        if !(size > 0.0) {
            return Err(DispError::Collinear);
        }
        let count = hull.len() as f64;
        let mean = points().map(|p| (p - middle) / size).sum::<Vector3<f64>>() / count;
        let spread: Matrix3<f64> = points().map(|p| (p - middle) / size - mean).map(|r| r * r.transpose()).sum();
        let centre = middle + mean * size;
        let mut frame = BodyFrame::principal(Point3::from(centre), &spread, size);
        let mut corners: Vec<Vector3<f64>> = points().map(|p| frame.axes.tr_mul(&(p - centre))).collect();
        frame.radius = corners.iter().fold(0.0, |m, r| f64::max(m, r.norm()));

        let reference = tetrahedron(&corners);
        let [a, b, c, _] = reference;
        if !((b - a).cross(&(c - a)).norm() > 1e-12 * frame.radius * frame.radius) {
            return Err(DispError::Collinear);
        }
        let share = 1.0 / reference.len() as f64;
        let stiffness = stiffness(reference.iter().map(|r| (share, r)), frame.radius);
        let mut nodes = Vec::with_capacity(2 * corners.len().div_ceil(LEAF) + 1);
        build(&mut nodes, &mut corners, 0);
        Ok(Disp { frame, corners, nodes, reference, stiffness })
    }

    /// How many corners are kept.
    #[must_use]
    pub fn corners(&self) -> usize {
        self.corners.len()
    }

    /// The corner that a field of displacements moves farthest, and its squared displacement.
    fn farthest(&self, field: &Field) -> (Vector3<f64>, f64) {
        let absolute = field.matrix.abs();
        let bound = |node: &Node| (field.at(&node.centre).abs() + absolute * node.half).norm_squared();
        let mut best = (self.corners[0], field.at(&self.corners[0]).norm_squared());
        let mut stack = heapless::Vec::<(u32, f64), DEPTH>::new();
        let _ = stack.push((0, f64::INFINITY));
        while let Some((at, most)) = stack.pop() {
            // Boxes that are better by rounding only are not worth the walk.
            if most <= best.1 * (1.0 + 1e-14) {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.second == 0 {
                for r in &self.corners[node.range.0 as usize..node.range.1 as usize] {
                    let square = field.at(r).norm_squared();
                    if square > best.1 {
                        best = (*r, square);
                    }
                }
                continue;
            }
            let children = [at + 1, node.second].map(|i| (i, bound(&self.nodes[i as usize])));
            let [a, b] = children;
            // The better one last: it is taken first.
            let [first, second] = if a.1 > b.1 { [b, a] } else { [a, b] };
            let _ = stack.push(first);
            let _ = stack.push(second);
        }
        best
    }

    /// The displacement field between two poses, in the axes of the body at the second.
    fn field(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Field {
        let (matrix, vector) = self.frame.displacement(from, at);
        let axes = self.frame.world_axes(at);
        Field { matrix: axes.tr_mul(&matrix), vector: axes.tr_mul(&vector) }
    }
}

/// The point farthest from the centre, the one farthest from that, from the line through both, and from the plane through the three: as large a
/// tetrahedron as comes cheaply. It is flat only where the body is.
fn tetrahedron(points: &[Vector3<f64>]) -> [Vector3<f64>; 4] {
    let most = |score: &dyn Fn(&Vector3<f64>) -> f64| {
        points.iter().fold(points[0], |best, r| if score(r) > score(&best) { *r } else { best })
    };
    let a = most(&|r| r.norm());
    let b = most(&|r| (r - a).norm());
    let c = most(&|r| (r - a).cross(&(b - a)).norm());
    let d = most(&|r| (r - a).dot(&(b - a).cross(&(c - a))).abs());
    [a, b, c, d]
}

/// Appends the tree over these corners, which begin at position `offset` of all, and sorts them into it.
fn build(nodes: &mut Vec<Node>, corners: &mut [Vector3<f64>], offset: usize) {
    let low = corners.iter().fold(corners[0], |m, r| m.inf(r));
    let high = corners.iter().fold(corners[0], |m, r| m.sup(r));
    let (centre, half) = ((low + high) / 2.0, (high - low) / 2.0);
    let at = nodes.len();
    nodes.push(Node { centre, half, range: (offset as u32, (offset + corners.len()) as u32), second: 0 });
    if corners.len() > LEAF {
        let axis = half.imax();
        let middle = corners.len() / 2;
        corners.select_nth_unstable_by(middle, |a, b| a[axis].total_cmp(&b[axis]));
        let (first, second) = corners.split_at_mut(middle);
        build(nodes, first, offset);
        nodes[at].second = nodes.len() as u32;
        build(nodes, second, offset + middle);
    }
}

impl Metric for Disp {
    fn distance(&self, from: &Isometry3<f64>, to: &Isometry3<f64>) -> f64 {
        let (matrix, vector) = self.frame.displacement(from, to);
        self.farthest(&Field { matrix, vector }).1.sqrt()
    }

    fn certificate(&self) -> Certificate {
        Certificate::Disp
    }

    fn frame(&self) -> &BodyFrame {
        &self.frame
    }

    /// The mean square displacement of four corners that span the body: a smooth stand-in, with which the step begins.
    fn model(&self, from: &Isometry3<f64>, at: &Isometry3<f64>) -> Quadratic {
        let field = self.field(from, at);
        let share = 1.0 / self.reference.len() as f64;
        let (mut value, mut gradient) = (0.0, Vector6::zeros());
        for r in &self.reference {
            let v = field.at(r);
            value += share * v.norm_squared();
            gradient += minimax::wrench(r, &v, self.frame.radius) * share;
        }
        Quadratic { value, gradient, hessian: self.stiffness }
    }

    /// A few quadratic programs, until the value is proved to be within the tolerance of the least.
    fn step(
        &self,
        from: &Isometry3<f64>,
        at: &Isometry3<f64>,
        contacts: &[Constraint],
        options: &StepOptions,
        memory: &mut StepMemory,
    ) -> Result<Step, StepError> {
        prepare(&self.frame, [from, at], contacts, options, memory)?;
        let mut step = quadratic_step(&self.frame, &self.model(from, at), options, memory)?;
        let field = self.field(from, at);
        if step.end != StepEnd::Optimal {
            step.value = self.farthest(&field.moved(&step.y, self.frame.radius)).1.sqrt();
            return Ok(step.finish(&self.frame, at));
        }
        let body = Body {
            farthest: |field: &Field| self.farthest(field),
            reference: &self.reference,
            stiffness: &self.stiffness,
            radius: self.frame.radius,
        };
        let StepMemory { contacts, rows, .. } = memory;
        let solution = minimax::minimise(&body, &field, contacts, options.trust, options.tolerance, step.y, rows);
        step.y = solution.y;
        step.value = solution.value;
        step.lower = solution.lower;
        step.violation = violation(contacts, &step.y);
        step.programs += solution.programs;
        step.end = if solution.closed { StepEnd::Optimal } else { StepEnd::Limit };
        Ok(step.finish(&self.frame, at))
    }
}
