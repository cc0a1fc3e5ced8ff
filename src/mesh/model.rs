//! A body: a mesh with all that depth queries derive from it once.

use super::certificate::{BuildOptions, Pieces, SolidError};
use super::mass::MassProperties;
use super::metric::{Disp, DispError, Sigma};
use super::{Mesh, MeshError};
use nalgebra::Point3;
use std::sync::Arc;

/// Why these arrays are no body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModelError {
    /// They are no mesh.
    Mesh(MeshError),
    /// They have no displacement metric: all vertices lie on one line.
    Disp(DispError),
}

impl std::fmt::Display for ModelError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ModelError::Mesh(error) => error.fmt(f),
            ModelError::Disp(error) => write!(f, "vertices: {error}"),
        }
    }
}

impl std::error::Error for ModelError {}

impl From<MeshError> for ModelError {
    fn from(error: MeshError) -> Self {
        ModelError::Mesh(error)
    }
}

impl From<DispError> for ModelError {
    fn from(error: DispError) -> Self {
        ModelError::Disp(error)
    }
}

/// A mesh with its metrics, and convex pieces where lower bounds are wanted. It never changes, and any number of solvers may share it.
#[derive(Clone, Debug)]
pub struct Model {
    mesh: Arc<Mesh>,
    disp: Disp,
    sigma: Option<Sigma>,
    mass: Option<MassProperties>,
    pieces: Option<Pieces>,
}

impl Model {
    /// Of triangles over vertices, as [`Mesh::new`] takes them. A polygon soup is accepted: queries then see its surface only, and
    /// it has no object norm.
    ///
    /// # Errors
    /// [`ModelError`]: no mesh, or no extent across a line.
    ///
    /// Cost: O(n log n).
    pub fn new<P>(vertices: &[P], triangles: &[[u32; 3]]) -> Result<Model, ModelError>
    where
        P: Copy + Into<Point3<f64>>,
    {
        Model::from_mesh(Mesh::new(vertices, triangles)?)
    }

    /// Of a mesh.
    ///
    /// # Errors
    /// [`ModelError::Disp`].
    pub fn from_mesh(mesh: Mesh) -> Result<Model, ModelError> {
        // A vertex that no triangle uses is no point of the body.
        let mut used = vec![false; mesh.vertices().len()];
        mesh.triangles().iter().flatten().for_each(|&v| used[v as usize] = true);
        let points: Vec<_> = mesh.vertices().iter().zip(&used).filter(|(_, used)| **used).map(|(p, _)| *p).collect();
        let disp = Disp::new(&points)?;
        let mass = mesh.is_solid().then(|| MassProperties::new(mesh.vertices(), mesh.triangles()).ok()).flatten();
        let sigma = mass.as_ref().map(Sigma::new);
        Ok(Model { mesh: Arc::new(mesh), disp, sigma, mass, pieces: None })
    }

    /// Adds the convex pieces from which depth queries prove lower bounds; both bodies need them. Without, `lower` is 0.
    ///
    /// # Errors
    /// [`SolidError`]: a polygon soup has no inside, or pieces cannot be sure of it.
    ///
    /// Cost: up to a second for 3,000 triangles.
    pub fn with_pieces(mut self, options: &BuildOptions) -> Result<Model, SolidError> {
        let mut pieces = Pieces::of_mesh(self.mesh.clone(), options)?;
        // A bound for what is inside is none for queries that see a surface only.
        if !self.is_solid() {
            let inverted = self.mesh.report().inverted_components.first();
            return Err(inverted.map_or(SolidError::Volume, |&component| SolidError::Inverted(component)));
        }
        if let Some(mass) = &self.mass {
            // Without it, only the largest displacement has a bound.
            let _ = pieces.weigh(&mass.centre, &(mass.inertia / mass.volume));
        }
        self.pieces = Some(pieces);
        Ok(self)
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The largest displacement.
    pub fn disp(&self) -> &Disp {
        &self.disp
    }

    /// The root mean square displacement over the solid; `None` for a polygon soup, which has no volume.
    pub fn sigma(&self) -> Option<&Sigma> {
        self.sigma.as_ref()
    }

    /// The convex pieces, if they were asked for.
    pub fn pieces(&self) -> Option<&Pieces> {
        self.pieces.as_ref()
    }

    /// Whether it bounds a solid. Otherwise it is a polygon soup, and depths are those of its surface.
    pub fn is_solid(&self) -> bool {
        self.mesh.is_solid()
    }
}
