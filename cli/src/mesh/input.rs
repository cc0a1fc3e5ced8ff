//! Queries from a JSON file.
//!
//! The file has a list `queries`. A query has an `id` (its number in the list unless stated; no two have the same), the mesh files `A` and `B` (relative to the JSON file), and the pose to ask about,
//! `pose0`: the unit quaternion `q_wxyz` and the translation `t` that place A in the frame of B, x_B = R x_A + t. What is known of the
//! answer may be missing: `disp_ub`, `sqrt_sigma_ub` (or its square, `sigma_ub`) the best values known, `disp_lb`, `sqrt_sigma_lb` lower bounds,
//! `exact_disp`, `exact_sqrt_sigma` (`exact_sigma`) the truth; `trans_only_ub` is the length of the best translation known, and queries of one `group`
//! have a line in the summary.
//!
//! What else the shared data say is known and not read; so is every field whose name begins with an underscore. Any other field is an error, and the error
//! names query and field, and says what is there and what may be (`json`).

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use qdist::mesh::MAX_COORDINATE;
use qdist::nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

use crate::json::{self, Field, Known as Fields};
use crate::{Trouble, text};

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

const FILE: Fields = Fields { fields: &["queries"], notes: &["schema", "n", "note", "notes", "source", "description"] };
const QUERY: Fields = Fields {
    fields: &[
        "id",
        "group",
        "A",
        "B",
        "pose0",
        "disp_ub",
        "disp_lb",
        "exact_disp",
        "sqrt_sigma_ub",
        "sqrt_sigma_lb",
        "exact_sqrt_sigma",
        "sigma_ub",
        "sigma_lb",
        "exact_sigma",
        "trans_only_ub",
    ],
    notes: &[
        "set",
        "kind",
        "params",
        "planted",
        "initial",
        "diag_A",
        "disp_pose",
        "sigma_pose",
        "trans_pose",
        "exact_trans",
        "lb_kind",
        "disp_check",
        "sigma_check",
        "agree_disp",
        "agree_sqrt_sigma",
        "unplanted_disp",
        "unplanted_sqrt_sigma",
        "source",
        "description",
        "note",
        "notes",
    ],
};
const POSE: Fields = Fields { fields: &["q_wxyz", "t"], notes: &[] };

/// Reads a file. The trouble names it, the query and the field.
pub fn queries(file: &Path) -> Result<Vec<Query>, Trouble> {
    let named = |trouble| format!("{}: {trouble}", file.display());
    let text = text::read(file).map_err(named)?;
    parse(&text, file.parent().unwrap_or(Path::new(""))).map_err(named)
}

/// The queries of a text, with mesh files in a folder.
pub fn parse(text: &str, folder: &Path) -> Result<Vec<Query>, Trouble> {
    let data = json::parse(text)?;
    let file = Field::of(&data, "");
    file.only(&FILE)?;
    let list = file.get("queries").things("query", "a list of queries")?;
    if list.is_empty() {
        return file.get("queries").must("a list of one query or more");
    }
    let mut seen = HashMap::new();
    let unique = |(i, here): (usize, &Field)| {
        let id = here.get("id").maybe(Field::name)?;
        let id = id.unwrap_or_else(|| i.to_string());
        match seen.insert(id.clone(), i) {
            Some(first) => Err(format!("query {id}: `id` is that of query number {first} and of number {i}, from 0")),
            None => query(&Field::of(here.value, format!("query {id}")), &id, folder),
        }
    };
    list.iter().enumerate().map(unique).collect()
}

fn query(field: &Field, id: &str, folder: &Path) -> Result<Query, Trouble> {
    field.only(&QUERY)?;
    let path = |key: &str| match field.get(key).value.as_str() {
        Some(name) => Ok(folder.join(name)),
        None => field.get(key).must("the name of a mesh file"),
    };
    let (a, b) = (path("A")?, path("B")?);
    let place = field.get("pose0");
    place.only(&POSE)?;
    let (q, t) = (place.get("q_wxyz").vector::<4>()?, place.get("t").vector::<3>()?);
    let pose = pose(q.into(), t.into()).or_else(|trouble| place.wrong(trouble))?;
    let disp = known(field, ["disp_ub", "disp_lb", "exact_disp"], None)?;
    let squares = Some(["sigma_ub", "sigma_lb", "exact_sigma"]);
    let sigma = known(field, ["sqrt_sigma_ub", "sqrt_sigma_lb", "exact_sqrt_sigma"], squares)?;
    let group = field.get("group").maybe(Field::name)?.unwrap_or_default();
    let translation = field.get("trans_only_ub").maybe(Field::not_negative)?;
    Ok(Query { group, translation, disp, sigma, ..Query::new(id.to_string(), a, b, pose) })
}

/// Best, lower and exact under the first names, or their squares under the others.
fn known(query: &Field, names: [&str; 3], squares: Option<[&str; 3]>) -> Result<Known, Trouble> {
    let mut found = [None; 3];
    for k in 0..3 {
        found[k] = query.get(names[k]).maybe(Field::not_negative)?;
        if let (None, Some(squares)) = (found[k], squares) {
            found[k] = query.get(squares[k]).maybe(Field::not_negative)?.map(f64::sqrt);
        }
    }
    Ok(Known { best: found[0], lower: found[1], exact: found[2] })
}

/// A pose from a quaternion (w, x, y, z), of unit length to what a few digits can say, and a translation; or what is wrong.
pub fn pose(q: [f64; 4], t: [f64; 3]) -> Result<Isometry3<f64>, &'static str> {
    let q = Quaternion::new(q[0], q[1], q[2], q[3]);
    let near = (q.norm() - 1.0).abs() < 1e-3;
    if !near {
        return Err("the quaternion (qw, qx, qy, qz) has not length 1");
    }
    if !t.iter().all(|x| x.abs() <= MAX_COORDINATE) {
        return Err("the translation is not finite, or too large");
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

    /// What would have been passed over is told with the nearest known name; whose field, what is there, what may be.
    #[test]
    fn trouble_names_the_query_and_the_field() {
        for (from, to, says) in [
            ("[0, 1, 0, 0]", "[0, 1, 0]", "query one: `pose0.q_wxyz` is [0,1,0]; it must be a list of 4 numbers"),
            (
                "[0, 1, 0, 0]",
                "[0, 2, 0, 0]",
                "query one: `pose0` is {\"q_wxyz\":[0,2,0,0],\"t\":[1,2,3.5]}: the quaternion",
            ),
            ("3.5", "\"3.5\"", "query one: `pose0.t[2]` is \"3.5\"; it must be a number"),
            ("3.5", "3.5e70", "query one: `pose0` is"),
            ("\"a.obj\"", "1", "query one: `A` is 1; it must be the name of a mesh file"),
            ("\"B\"", "\"_B\"", "query one: `B` is missing; it must be the name of a mesh file"),
            ("\"B\"", "\"C\"", "query one: `C` is not known here; did you mean `A`?"),
            ("0.25", "[]", "query one: `disp_lb` is []; it must be a number, 0 or more"),
            ("0.25", "-1", "query one: `disp_lb` is -1; it must be a number, 0 or more"),
            ("0.04", "-0.04", "query one: `sigma_ub` is -0.04; it must be a number, 0 or more"),
            ("\"disp_lb\"", "\"disp_lp\"", "query one: `disp_lp` is not known here; did you mean `disp_lb`?"),
            ("\"pose0\"", "\"pose\"", "query one: `pose` is not known here; did you mean `pose0`?"),
            ("\"t\"", "\"T\"", "query one: `pose0.T` is not known here; did you mean `t`?"),
            ("\"q_wxyz\"", "\"q_xyzw\"", "query one: `pose0.q_xyzw` is not known here; did you mean `q_wxyz`?"),
            ("\"schema\"", "\"unit\"", "`unit` is not known here"),
            ("\"one\"", "[1]", "query 0: `id` is [1]; it must be a text or a number"),
            ("\"id\": \"one\", \"A\": ", "\"A\": 1, \"_\": ", "query 0: `A` is 1"),
            ("\"queries\"", "\"questions\"", "`questions` is not known here; did you mean `queries`?"),
            ("\"queries\"", "\"_queries\"", "`queries` is missing; it must be a list of queries"),
            ("\"set\": 7", "\"id\": \"two\"", "line 1: `id` is there twice in one object"),
        ] {
            let told = trouble(from, to);
            assert!(told.starts_with(says), "{from} -> {to}: {told}");
        }
        let told = |text: &str| parse(text, Path::new("")).unwrap_err();
        assert!(told("{").starts_with("this is no JSON"));
        assert!(told("[]").starts_with("the file is []; it must be an object"));
        assert!(told(r#"{"queries": []}"#).contains("one query or more"));
        let twice = QUERY.replacen("[{", "[{\"id\": \"one\", \"A\": \"a\", \"B\": \"b\", \"pose0\": {\"q_wxyz\": [1, 0, 0, 0], \"t\": [0, 0, 0]}}, {", 1);
        assert!(
            told(&twice).starts_with("query one: `id` is that of query number 0 and of number 1"),
            "{}",
            told(&twice)
        );
        assert!(queries(Path::new("missing.json")).unwrap_err().starts_with("missing.json: "));
    }

    /// The shared files say nothing that is not known.
    #[test]
    #[ignore = "needs ../shared/data"]
    fn the_shared_files_are_read() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data/meshes");
        for (file, count) in [("queries.json", 62), ("reported/queries.json", 85), ("narrow/queries.json", 18)] {
            assert_eq!(queries(&root.join(file)).unwrap().len(), count, "{file}");
        }
    }
}
