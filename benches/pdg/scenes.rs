//! What is asked: the shared queries, or where they are not there, poses of meshes made by code.

use std::path::{Path, PathBuf};

use qdist::mesh::{Model, Pair};
use qdist_benches::common::dice::Dice;
use qdist_benches::mesh_common::{Shape, l_shape, random_pose, slot, torus, torus_knot};
use qdist_cli::mesh::bodies::{Bodies, with_pieces};
use qdist_cli::mesh::input::{self, Query};

const SHARED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/meshes/queries.json");
/// Poses of every made-up pair.
const POSES: usize = 10;

/// Queries and their bodies.
pub struct Scenes {
    pub queries: Vec<Query>,
    pub bodies: Bodies,
    /// Groups that are asked with every variant.
    pub benchmarks: Vec<&'static str>,
    /// Whether these are the shared ones, which the bars are about.
    pub shared: bool,
}

impl Scenes {
    /// With `quick`, every third of the queries of a group.
    pub fn new(quick: bool) -> Result<Scenes, Box<dyn std::error::Error>> {
        let mut scenes = if Path::new(SHARED).exists() { Scenes::read()? } else { Scenes::made_up()? };
        if quick {
            let mut seen = std::collections::HashMap::new();
            scenes.queries.retain(|query| {
                let count = seen.entry(query.group.clone()).or_insert(0);
                *count += 1;
                *count % 3 == 1
            });
        }
        Ok(scenes)
    }

    fn read() -> Result<Scenes, String> {
        let queries = input::queries(Path::new(SHARED))?;
        let bodies = Bodies::of(&queries, |_| ())?;
        Ok(Scenes { queries, bodies, benchmarks: vec!["knot", "cad", "hammer"], shared: true })
    }

    fn made_up() -> Result<Scenes, Box<dyn std::error::Error>> {
        let pairs: [(&str, Shape, Shape); 3] = [
            ("own_knot", l_shape(), torus_knot(96, 15, 0.16)),
            ("own_rings", torus(24, 12, 0.5, 0.12), torus_knot(96, 15, 0.16)),
            ("own_slot", l_shape(), slot(3.0, 4.0, 1.3, 1.0, 3.0)),
        ];
        let benchmarks = pairs.each_ref().map(|p| p.0).to_vec();
        let (mut queries, mut bodies, mut dice) = (Vec::new(), Bodies::default(), Dice::new(1));
        for (group, a, b) in pairs {
            let files = [format!("{group}_a"), format!("{group}_b")].map(PathBuf::from);
            let models = [Model::new(&a.vertices, &a.triangles)?, Model::new(&b.vertices, &b.triangles)?];
            let mut pair = Pair::new(models[0].mesh(), models[1].mesh());
            let mut count = 0;
            while count < POSES {
                let pose = random_pose(&mut dice, 0.5 * models[1].mesh().diagonal());
                if pair.collides(&pose) {
                    let [a, b] = files.clone();
                    let mut query = Query::new(format!("{group}-{count:02}"), a, b, pose);
                    query.group = group.to_string();
                    queries.push(query);
                    count += 1;
                }
            }
            for (file, model) in files.iter().zip(models) {
                bodies.add(file, with_pieces(model));
            }
        }
        Ok(Scenes { queries, bodies, benchmarks, shared: false })
    }

    pub fn is_benchmark(&self, query: &Query) -> bool {
        self.benchmarks.contains(&query.group.as_str())
    }
}
