//! The bodies of some queries: every mesh file is read once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use qdist::mesh::metric::Metric;
use qdist::mesh::{Mesh, Model};

use crate::input::{Kind, Query};
use crate::read;

#[derive(Default)]
pub struct Bodies(BTreeMap<PathBuf, Model>);

impl Bodies {
    /// Of all files that the queries name. The trouble names the query and the file.
    pub fn of(queries: &[Query]) -> Result<Bodies, String> {
        let mut bodies = Bodies::default();
        for query in queries {
            for file in [&query.a, &query.b] {
                if !bodies.0.contains_key(file) {
                    bodies.add(file, model(file).map_err(|trouble| format!("{}: {trouble}", query.id))?);
                }
            }
        }
        Ok(bodies)
    }

    pub fn add(&mut self, name: &Path, model: Model) {
        self.0.insert(name.to_path_buf(), model);
    }

    /// A body that was read.
    pub fn get(&self, file: &Path) -> &Model {
        &self.0[file]
    }

    /// All of them, by name.
    pub fn iter(&self) -> impl Iterator<Item = (&Path, &Model)> {
        self.0.iter().map(|(file, model)| (file.as_path(), model))
    }
}

fn model(file: &Path) -> Result<Model, String> {
    let named = |trouble: String| format!("{}: {trouble}", file.display());
    let shape = read::mesh(file)?;
    let mesh = Mesh::new(&shape.vertices, &shape.triangles).map_err(|e| named(e.to_string()))?;
    Model::from_mesh(mesh).map_err(|e| named(e.to_string()))
}

/// A metric of a body; a polygon soup has no object norm.
pub fn metric(model: &Model, kind: Kind) -> Option<&dyn Metric> {
    match kind {
        Kind::Disp => Some(model.disp()),
        Kind::Sigma => model.sigma().map(|sigma| sigma as &dyn Metric),
    }
}
