//! Preparing a large hull for hill climbing: the polytope machinery, fed with given points.
//!
//! Points are inserted one by one. A facet that sees a point is found by climbing in the dual polytope: seen from a point c
//! inside, facet F is the dual point y_F = n_F / (n_F.(v - c)), and p lies outside exactly when the largest y_F.(p - c)
//! is above 1. A linear function on the (dual) polytope has no local maxima, so walking to better neighbours finds it.

use core::fmt;

use crate::polytope::{Facet, Index, Insertion, Polytope};
use crate::scalar::{Real, Vector};
use crate::simplex::Vertex;
use crate::solver::Solver;
use crate::start::Start;
use crate::support::{BLOCK, EMPTY, GraphWriter, HullGraph, Points, SEEDS, ShapeError, Support};

/// Why a hull cannot be prepared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GraphError {
    /// No points, or a coordinate is not finite.
    Shape(ShapeError),
    /// All points lie in one plane: use [`Points`].
    Flat,
    /// The solver needs as many vertices as the hull has, and about 2 facets for each and some to spare; neither can exceed 65,535.
    Capacity,
    /// The words are fewer than the graph needs, or its lists have more than 262,140 words (above about 26,000 vertices); below that
    /// [`graph_len`](crate::support::graph_len) always suffices.
    Words,
}

impl fmt::Display for GraphError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Shape(error) => return fmt::Display::fmt(error, f),
            Self::Flat => "the points of the hull lie in one plane",
            Self::Capacity => "the solver has too few vertices or facets for the hull",
            Self::Words => "the words are fewer than the hull's graph needs",
        })
    }
}

impl core::error::Error for GraphError {}

impl<T: Real> Solver<'_, T, 3> {
    /// Computes the vertex graph of the hull of `points` into `words`, with this solver's memory as workspace.
    ///
    /// Points inside the hull, or within rounding of its facets, get no edges. Cost: about the square root of the
    /// number of facets for each vertex, and a pass over the facets for each point that is none; done once.
    ///
    /// # Errors
    /// [`GraphError`]; the contents of `words` are unspecified then.
    pub fn prepare_hull<'g>(&mut self, points: &[[T; 3]], words: &'g mut [u16]) -> Result<HullGraph<'g>, GraphError> {
        let all = Points::new(points).map_err(GraphError::Shape)?;
        let count = u16::try_from(points.len()).ok().filter(|&n| n != EMPTY).ok_or(GraphError::Capacity)?;
        self.polytope.reset();
        self.first_simplex(points)?;
        self.insert_all(points)?;
        let mut seeds = heapless::Vec::<u16, SEEDS>::new();
        for direction in seed_directions() {
            let Ok(farthest) = all.support(&direction) else { continue };
            let vertex = self.polytope.vertices().iter().find(|v| v.point == farthest - first(points));
            if let Some(index) = vertex.map(index_of)
                && !seeds.contains(&index)
            {
                let _ = seeds.push(index);
            }
        }
        let mut writer = GraphWriter::new(words, seeds.len() as u16, count).ok_or(GraphError::Words)?;
        for (word, &seed) in writer.seeds.iter_mut().zip(&seeds) {
            *word = seed;
        }
        write_lists(&self.polytope, &mut writer).ok_or(GraphError::Words)?;
        HullGraph::from_words(words).ok_or(GraphError::Words)
    }

    /// Four points that span space. All points are measured from the first one.
    fn first_simplex(&mut self, points: &[[T; 3]]) -> Result<(), GraphError> {
        let reach = points.iter().map(|p| relative(points, p)).fold(T::zero(), |m, p| m.at_least(p.dot(&p))).root();
        let thin = T::count(64) * T::ROUNDOFF * reach;
        let mut start = Start::new(Vector::<T, 3>::from([T::one(), T::zero(), T::zero()]));
        while start.missing() > 0 {
            let direction = start.direction();
            let far = points.iter().enumerate().map(|(i, p)| (start.progress(&direction, &relative(points, p)), i, p));
            // The first of the farthest.
            let mut best: Option<(T, usize, &[T; 3])> = None;
            for candidate in far {
                if best.is_none_or(|(most, ..)| candidate.0 > most) {
                    best = Some(candidate);
                }
            }
            let (_, i, p) = best.ok_or(GraphError::Flat)?;
            let vertex = labelled(points, i, p);
            if !start.accept(&vertex.point, thin) {
                return Err(GraphError::Flat);
            }
            self.polytope.add_vertex(vertex).ok_or(GraphError::Capacity)?;
        }
        self.polytope.make_simplex(&start.normals()).ok_or(GraphError::Capacity)
    }

    fn insert_all(&mut self, points: &[[T; 3]]) -> Result<(), GraphError> {
        let mut at: Index = 0;
        for (i, p) in points.iter().enumerate() {
            let vertex = labelled(points, i, p);
            at = self.polytope.climb(at, &vertex.point).ok_or(GraphError::Capacity)?;
            let tolerance = self.polytope.resolution();
            let sees = |f: &Facet<T, 3>| f.normal.dot(&vertex.point) - f.offset > tolerance;
            if !sees(self.polytope.facet(at).ok_or(GraphError::Capacity)?) {
                // Facets in one plane are one point of the dual, and climbing may end there: only a look at all says no.
                match self.polytope.numbered_facets().find(|(_, f)| sees(f)) {
                    Some((index, _)) => at = index,
                    None => continue,
                }
            }
            match self.polytope.insert(at, vertex, tolerance) {
                Some(Insertion::Done) => at = self.polytope.next_fresh().ok_or(GraphError::Capacity)?,
                Some(Insertion::Rejected) => {}
                Some(Insertion::Full) | None => return Err(GraphError::Capacity),
            }
        }
        Ok(())
    }
}

/// A point relative to the first one, with its position in the list as witness.
fn labelled<T: Real>(points: &[[T; 3]], index: usize, p: &[T; 3]) -> Vertex<T, 3> {
    Vertex { point: relative(points, p), witness: Vector::repeat(T::count(index)) }
}

fn index_of<T: Real>(vertex: &Vertex<T, 3>) -> u16 {
    vertex.witness.x.to_f64() as u16
}

fn first<T: Real>(points: &[[T; 3]]) -> Vector<T, 3> {
    points.first().map_or(Vector::zeros(), |p| Vector::from(*p))
}

fn relative<T: Real>(points: &[[T; 3]], p: &[T; 3]) -> Vector<T, 3> {
    Vector::from(*p) - first(points)
}

/// The axes and the diagonals of a cube, both ways.
fn seed_directions<T: Real>() -> impl Iterator<Item = Vector<T, 3>> {
    let one = [-1.0, 0.0, 1.0];
    let all =
        one.into_iter().flat_map(move |x| one.into_iter().flat_map(move |y| one.into_iter().map(move |z| [x, y, z])));
    all.filter(|d| matches!(d.iter().filter(|&&x| x == 0.0).count(), 0 | 2)).map(|d| Vector::from(d.map(T::of)))
}

/// Two passes over the edges: count the neighbours of each vertex, then fill its list.
fn write_lists<T: Real>(polytope: &Polytope<'_, T, 3>, writer: &mut GraphWriter<'_>) -> Option<()> {
    writer.starts.fill(0);
    writer.lists.fill(0);
    for (a, b) in polytope.edges() {
        for end in [a, b] {
            *writer.starts.get_mut(usize::from(index_of(&end)))? += 1;
        }
    }
    let mut block = 0;
    for start in writer.starts.iter_mut() {
        let degree = usize::from(*start);
        *start = if degree == 0 { EMPTY } else { u16::try_from(block).ok().filter(|&b| b != EMPTY)? };
        block += if degree == 0 { 0 } else { (degree + 1).div_ceil(BLOCK) };
    }
    for (a, b) in polytope.edges() {
        for (from, to) in [(a, b), (b, a)] {
            let start = *writer.starts.get(usize::from(index_of(&from)))?;
            let list = writer.lists.get_mut(BLOCK * usize::from(start)..)?;
            let (count, neighbors) = list.split_first_mut()?;
            *neighbors.get_mut(usize::from(*count))? = index_of(&to);
            *count += 1;
        }
    }
    Some(())
}
