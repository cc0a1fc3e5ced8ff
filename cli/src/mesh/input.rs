//! Queries from a JSON file.
//!
//! The file has a list `queries`. A query has an `id`, the mesh files `A` and `B` (relative to the JSON file), and the pose to ask about,
//! `pose0`: the unit quaternion `q_wxyz` and the translation `t` that place A in the frame of B, x_B = R x_A + t. What is known of the
//! answer may be missing: `disp_ub`, `sqrt_sigma_ub` (or its square, `sigma_ub`) the best values known, `disp_lb`, `sqrt_sigma_lb` lower bounds,
//! `exact_disp`, `exact_sqrt_sigma` (`exact_sigma`) the truth. Whatever else is there is not read.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use qdist::nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use serde_json::Value;

use crate::Trouble;

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, ValueEnum)]
pub enum Kind {
    /// The largest displacement of a point
    Disp,
    /// The root mean square displacement: the root of the object norm
    Sigma,
}

impl Kind {
    pub const BOTH: [Kind; 2] = [Kind::Disp, Kind::Sigma];

    pub fn name(self) -> &'static str {
        match self {
            Kind::Disp => "disp",
            Kind::Sigma => "sigma",
        }
    }
}

/// What is known of an answer, as lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Known {
    pub best: Option<f64>,
    pub lower: Option<f64>,
    pub exact: Option<f64>,
}

impl Known {
    /// The least value that is known to be possible.
    pub fn least(&self) -> Option<f64> {
        self.exact.or(self.best)
    }
}

/// A question, and what is known of its answers.
#[derive(Clone, Debug)]
pub struct Query {
    pub id: String,
    /// Queries of a kind; empty when the file does not say.
    pub group: String,
    pub a: PathBuf,
    pub b: PathBuf,
    pub pose: Isometry3<f64>,
    /// The length of the best translation known.
    pub translation: Option<f64>,
    disp: Known,
    sigma: Known,
}

impl Query {
    pub fn new(id: String, a: PathBuf, b: PathBuf, pose: Isometry3<f64>) -> Query {
        let nothing = Known::default();
        Query { id, group: String::new(), a, b, pose, translation: None, disp: nothing, sigma: nothing }
    }

    pub fn known(&self, kind: Kind) -> Known {
        match kind {
            Kind::Disp => self.disp,
            Kind::Sigma => self.sigma,
        }
    }
}

/// Reads a file. The trouble names it, the query and the field.
pub fn queries(file: &Path) -> Result<Vec<Query>, Trouble> {
    let text = std::fs::read_to_string(file).map_err(|e| format!("{}: {e}", file.display()))?;
    parse(&text, file.parent().unwrap_or(Path::new(""))).map_err(|trouble| format!("{}: {trouble}", file.display()))
}

/// The queries of a text, with mesh files in a folder.
pub fn parse(text: &str, folder: &Path) -> Result<Vec<Query>, Trouble> {
    let data: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let list = data["queries"].as_array().ok_or("`queries` is not a list")?;
    let read = |(i, v): (usize, &Value)| {
        let id = v["id"].as_str().map_or(format!("query {i}"), str::to_string);
        query(v, &id, folder).map_err(|trouble| format!("{id}: {trouble}"))
    };
    list.iter().enumerate().map(read).collect()
}

fn query(v: &Value, id: &str, folder: &Path) -> Result<Query, Trouble> {
    let path = |key: &str| v[key].as_str().map(|s| folder.join(s)).ok_or(format!("`{key}` is not the name of a file"));
    for key in ["A", "B", "pose0"] {
        if v[key].is_null() {
            return Err(format!("`{key}` is missing"));
        }
    }
    let (q, t) = (&v["pose0"]["q_wxyz"], &v["pose0"]["t"]);
    let q = numbers(q).ok_or("`pose0.q_wxyz` is not a list of 4 numbers")?;
    let t = numbers(t).ok_or("`pose0.t` is not a list of 3 numbers")?;
    let pose = pose(q, t).map_err(|trouble| format!("`pose0`: {trouble}"))?;
    let disp = known(v, ["disp_ub", "disp_lb", "exact_disp"], None)?;
    let squares = Some(["sigma_ub", "sigma_lb", "exact_sigma"]);
    let sigma = known(v, ["sqrt_sigma_ub", "sqrt_sigma_lb", "exact_sqrt_sigma"], squares)?;
    let group = v["group"].as_str().unwrap_or_default().to_string();
    let translation = number(v, "trans_only_ub")?;
    Ok(Query { group, translation, disp, sigma, ..Query::new(id.to_string(), path("A")?, path("B")?, pose) })
}

fn number(v: &Value, key: &str) -> Result<Option<f64>, Trouble> {
    match &v[key] {
        Value::Null => Ok(None),
        value => value.as_f64().map(Some).ok_or(format!("`{key}` is not a number")),
    }
}

/// Best, lower and exact under the first names, or their squares under the others.
fn known(v: &Value, names: [&str; 3], squares: Option<[&str; 3]>) -> Result<Known, Trouble> {
    let mut found = [None; 3];
    for k in 0..3 {
        found[k] = number(v, names[k])?;
        if let (None, Some(squares)) = (found[k], squares) {
            found[k] = number(v, squares[k])?.map(f64::sqrt);
        }
    }
    Ok(Known { best: found[0], lower: found[1], exact: found[2] })
}

fn numbers<const N: usize>(v: &Value) -> Option<[f64; N]> {
    let list: Option<Vec<f64>> = v.as_array()?.iter().map(Value::as_f64).collect();
    list?.try_into().ok()
}

/// A pose from a quaternion (w, x, y, z), of unit length to what a few digits can say, and a translation; or what is wrong.
pub fn pose(q: [f64; 4], t: [f64; 3]) -> Result<Isometry3<f64>, &'static str> {
    let q = Quaternion::new(q[0], q[1], q[2], q[3]);
    let near = (q.norm() - 1.0).abs() < 1e-3;
    if !near {
        return Err("the quaternion (qw, qx, qy, qz) has not length 1");
    }
    if !t.iter().all(|x| x.is_finite()) {
        return Err("the translation is not finite");
    }
    Ok(Isometry3::from_parts(Translation3::new(t[0], t[1], t[2]), UnitQuaternion::from_quaternion(q)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const QUERY: &str = r#"{"schema": "x", "queries": [{"id": "one", "A": "a.obj", "B": "sub/b.stl", "set": 7, "group": "g",
        "pose0": {"q_wxyz": [0, 1, 0, 0], "t": [1, 2, 3.5]}, "disp_ub": 0.5, "disp_lb": 0.25, "sigma_ub": 0.04, "exact_disp": null}]}"#;

    fn trouble(from: &str, to: &str) -> String {
        assert!(QUERY.contains(from));
        parse(&QUERY.replace(from, to), Path::new("")).unwrap_err()
    }

    #[test]
    fn a_query_with_some_references() {
        let queries = parse(QUERY, Path::new("dir")).unwrap();
        let [query] = &queries[..] else { panic!("{queries:?}") };
        assert_eq!((query.id.as_str(), query.group.as_str()), ("one", "g"));
        assert_eq!((query.a.as_path(), query.b.as_path()), (Path::new("dir/a.obj"), Path::new("dir/sub/b.stl")));
        assert_eq!(query.pose.translation.vector.as_slice(), [1.0, 2.0, 3.5]);
        assert_eq!(query.pose.rotation.i, 1.0);
        assert_eq!(query.known(Kind::Disp), Known { best: Some(0.5), lower: Some(0.25), exact: None });
        assert_eq!(query.known(Kind::Sigma), Known { best: Some(0.2), lower: None, exact: None });
    }

    /// README's first command; the files that it names are there.
    #[test]
    fn the_fixture() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/data/meshes");
        let queries = queries(&folder.join("queries.json")).unwrap();
        assert_eq!(queries.len(), 4);
        for query in queries {
            assert!(query.a.exists() && query.b.exists(), "{query:?}");
            assert!(query.known(Kind::Disp).best.is_some(), "{query:?}");
        }
    }

    #[test]
    fn trouble_names_the_query_and_the_field() {
        assert!(trouble("[0, 1, 0, 0]", "[0, 1, 0]").contains("one: `pose0.q_wxyz`"));
        assert!(trouble("[0, 1, 0, 0]", "[0, 2, 0, 0]").contains("has not length 1"));
        assert!(trouble("3.5", "\"3.5\"").contains("one: `pose0.t`"));
        assert!(trouble("\"a.obj\"", "1").contains("one: `A`"));
        assert!(trouble("\"B\"", "\"C\"").contains("one: `B`"));
        assert!(trouble("0.25", "[]").contains("one: `disp_lb`"));
        assert!(trouble("\"id\": \"one\", \"A\"", "\"A_\"").contains("query 0: `A`"));
        assert!(trouble("\"queries\"", "\"questions\"").contains("`queries`"));
        assert!(parse("{", Path::new("")).is_err());
        assert!(queries(Path::new("missing.json")).unwrap_err().contains("missing.json"));
    }
}
