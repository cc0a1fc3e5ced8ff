//! The bodies of some queries: every mesh file is read once, and cut into the convex pieces that lower bounds come from.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use qdist::mesh::certificate::BuildOptions;
use qdist::mesh::metric::Metric;
use qdist::mesh::{Mesh, Model};

use crate::mesh::input::{Kind, Query};
use crate::mesh::read;

#[derive(Default)]
pub struct Bodies(BTreeMap<PathBuf, Model>);

impl Bodies {
    /// Of all files that the queries name. The trouble names the query, the field and the file.
    /// `tell` hears of every file before it is read: pieces may take a second.
    pub fn of(queries: &[Query], tell: impl Fn(&Path)) -> Result<Bodies, String> {
        let mut bodies = Bodies::default();
        for query in queries {
            for (field, file) in [("A", &query.a), ("B", &query.b)] {
                tell(file);
                bodies.read(file).map_err(|trouble| format!("query {}: `{field}`: {trouble}", query.id))?;
            }
        }
        Ok(bodies)
    }

    /// Reads a file, unless it is there already. The trouble names the file.
    pub fn read(&mut self, file: &Path) -> Result<(), String> {
        if !self.0.contains_key(file) {
            self.add(file, model(file)?);
        }
        Ok(())
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

/// With pieces where that is possible; a polygon soup has no lower bounds.
pub fn with_pieces(model: Model) -> Model {
    model.clone().with_pieces(&BuildOptions::default()).unwrap_or(model)
}

fn model(file: &Path) -> Result<Model, String> {
    let named = |trouble: String| format!("{}: {trouble}", file.display());
    let shape = read::mesh(file)?;
    let mesh = Mesh::new(&shape.vertices, &shape.triangles).map_err(|e| named(e.to_string()))?;
    Model::from_mesh(mesh).map(with_pieces).map_err(|e| named(e.to_string()))
}

/// A metric of a body; a polygon soup has no object norm.
pub fn metric(model: &Model, kind: Kind) -> Option<&dyn Metric> {
    match kind {
        Kind::Disp => Some(model.disp()),
        Kind::Sigma => model.sigma().map(|sigma| sigma as &dyn Metric),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use qdist::nalgebra::Isometry3;

    #[test]
    fn a_missing_file_is_named_with_its_query_and_field() {
        let query = Query::new("one".into(), "missing.obj".into(), "b.obj".into(), Isometry3::identity());
        let trouble = Bodies::of(&[query], |_| ()).err().unwrap_or_default();
        assert!(trouble.starts_with("query one: `A`: missing.obj: "), "{trouble}");
        assert!(Bodies::of(&[], |_| ()).is_ok_and(|bodies| bodies.iter().next().is_none()));
    }
}
