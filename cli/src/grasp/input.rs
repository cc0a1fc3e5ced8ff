//! Grasps from JSON.
//!
//! The file has a list `instances` of grasps; a list of grasps or one grasp alone will do. A grasp has `contacts` and,
//! usually, `id` and `refs`. Without `id`, its number in the list is its id. No two grasps have the same.
//!
//! * A grasp: `torque_scale` L (or `L`; 1 unless stated) divides moments; `reference`, three numbers, is the point that moments refer to, usually
//!   the centre of mass (the origin unless stated; so is a `reference_point` of three numbers, while as a text it is a note); `length_unit_m` is told;
//!   `normalize`: true makes normals and tangents unit vectors, which they must be otherwise.
//! * A contact: `p`, the unit normal `n` into the object, perhaps tangents `o` and `t`, a name `finger`, a `force_cap` (1 unless stated), and the four
//!   rows `J` of its Jacobian (none: passive, a palm), with the names of its `joints`. `type` is `soft`, `hard` or `frictionless`; without it, `mu` and `mus`
//!   say what it is. A `mus` that is missing or null is 0.
//! * `torque_limits` of a contact: one number for each joint, null where there is none. Contacts with the same `finger` are then one finger, whose joints
//!   they share: one of them states the limits, or all the same.
//! * A reference: `set` (`W`, `Wa`), `norm` (`L1`, `Linf`), `Q`, and the value `d` with `tol`, if it is known. Capitals do not matter.
//! * `Q`: a `type` with its numbers: `ball` (perhaps `radius`), `ellipsoid` `semi_axes`, `box` `half_widths`, `cross_polytope` `half_axes`,
//!   `segment` `wrench`. They are coordinates of R^6, of the rows of `Q.S`, or, where the reference says so by a `space` or where they are not
//!   six, of the columns of its `R`.
//!
//! What else the shared data say (`source`, `description`, how a reference was found) is known and not read; so is every field whose name begins with an
//! underscore. Any other field is an error (`Field::only`), and so is what contradicts itself. An error names grasp, contact and field.

use std::collections::HashMap;

use qdist::Vector;
use qdist::grasp::{Contact, ContactError, Friction, HandContact, Jacobian, Norm, WrenchFrame};
use serde_json::Value;

use crate::Trouble;
use crate::grasp::field::Field;
use crate::grasp::keys::repeated;
use crate::grasp::unit_sets::{Q, Shape};

/// One grasp of the file.
pub struct Grasp {
    pub id: String,
    /// Metres of one unit of length, where the file says so.
    pub length_unit: Option<f64>,
    /// Reference point and torque scale.
    pub frame: WrenchFrame<f64>,
    pub contacts: Vec<Touch>,
    pub queries: Vec<Reference>,
    /// What is odd but no error.
    pub warnings: Vec<String>,
}

/// A contact of a grasp.
pub struct Touch {
    pub name: String,
    pub contact: HandContact<f64>,
    /// What its joints bear; `None` where nothing is said.
    pub limits: Option<Vec<f64>>,
}

/// Which wrench set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// W: whatever friction allows.
    Passive,
    /// W^a: what joint torques generate.
    Active,
}

impl Set {
    pub fn name(self) -> &'static str {
        match self {
            Self::Passive => "W",
            Self::Active => "Wa",
        }
    }
}

/// The name of a norm in the files.
pub fn norm_name(norm: Norm) -> &'static str {
    match norm {
        Norm::L1 => "L1",
        Norm::LInf => "Linf",
    }
}

/// A query, and its answer if the file has it.
pub struct Reference {
    pub set: Set,
    pub norm: Norm,
    pub q: Q,
    pub d: Option<f64>,
    /// How far `d` may be off.
    pub tolerance: f64,
}

/// Fields that are read, and those that the shared data have for people.
const FILE: [&[&str]; 2] = [&["instances"], &["schema", "note", "notes", "source", "description"]];
const GRASP: [&[&str]; 2] = [
    &["id", "contacts", "refs", "length_unit_m", "torque_scale", "L", "reference", "reference_point", "normalize"],
    &["schema", "source", "licence_of_source", "description", "note", "notes", "qhull_exact"],
];
const CONTACT: [&[&str]; 2] = [
    &["p", "n", "o", "t", "mu", "mus", "type", "finger", "force_cap", "J", "joints", "torque_limits"],
    &["description", "note", "notes"],
];
const REFERENCE: [&[&str]; 2] = [
    &["set", "norm", "Q", "d", "tol", "R"],
    &[
        "force_closure",
        "certified_lower_bound",
        "certified_rel_gap",
        "direction",
        "starts",
        "hits",
        "second_best_local_min",
        "kkt_residual",
        "raw_ccp",
        "active_contacts",
        "cert_points",
        "cert_facets",
        "vertex",
        "max_primal_dual_gap",
        "method",
        "dim",
        "ranks",
        "contacts",
        "separation",
        "separation_meaning",
        "description",
        "note",
        "notes",
    ],
];

/// The grasps of a file's text; `normalize`: all normals become unit vectors.
pub fn read(text: &str, normalize: bool) -> Result<Vec<Grasp>, Trouble> {
    let data: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
    if let Some((key, line)) = repeated(text) {
        return Err(format!("line {line}: {key} is there twice in one object"));
    }
    let instances = match &data {
        Value::Object(fields) if fields.contains_key("instances") => {
            Field { value: &data, at: "the file".into() }.only(FILE[0], FILE[1])?;
            &data["instances"]
        }
        Value::Object(fields) if fields.contains_key("contacts") => &Value::Array(vec![data.clone()]),
        Value::Array(_) => &data,
        Value::Object(_) => {
            Field { value: &data, at: "the file".into() }.only(&["instances", "contacts"], FILE[1])?;
            return Err("instances (missing): is not a list of grasps".into());
        }
        _ => return Err("instances (missing): is not a list of grasps".into()),
    };
    let Some(list) = instances.as_array() else { return Err("instances: is not a list of grasps".into()) };
    let mut seen = HashMap::new();
    let unique = |(i, value): (usize, &Value)| {
        let here = Field { value, at: format!("grasp {i}") };
        let id = here.get("id").maybe(Field::name)?.unwrap_or_else(|| i.to_string());
        match seen.insert(id.clone(), i) {
            Some(first) => Err(format!("grasp {id}, id: is that of grasp number {first} and of number {i}, from 0")),
            None => grasp(id, value, normalize),
        }
    };
    list.iter().enumerate().map(unique).collect()
}

fn grasp(id: String, value: &Value, normalize: bool) -> Result<Grasp, Trouble> {
    let top = Field { value, at: format!("grasp {id}") };
    top.only(GRASP[0], GRASP[1])?;
    let normalize = top.get("normalize").maybe(Field::flag)?.unwrap_or(normalize);
    // Positions in messages as they are counted in the file.
    if !top.get("contacts").value.is_array() {
        return top.get("contacts").wrong("is not a list");
    }
    let list = top.list("contacts").entries("contact")?;
    let contacts: Vec<Touch> =
        list.iter().enumerate().map(|(i, c)| touch(i, c, normalize)).collect::<Result<_, _>>()?;
    let refs = top.list("refs");
    let queries = match refs.value {
        Value::Null => Vec::new(),
        Value::Array(_) => refs.entries("ref")?.iter().map(reference).collect::<Result<Vec<_>, _>>()?,
        _ => return top.get("refs").wrong("is not a list"),
    };
    let passive = contacts.iter().all(|c| c.contact.jacobian.is_none());
    if let (true, Some(i)) = (passive, queries.iter().position(|q| q.set == Set::Active)) {
        return Err(format!("{}, ref {i}, set: is Wa, but no contact has a Jacobian", top.at));
    }
    let length_unit = top.get("length_unit_m").maybe(Field::positive)?;
    let warnings = outward(&contacts).then(|| format!("{}: {OUTWARD}", top.at)).into_iter().collect();
    Ok(Grasp { length_unit, frame: frame(&top)?, id, contacts, queries, warnings })
}

/// Reference point and torque scale.
fn frame(grasp: &Field) -> Result<WrenchFrame<f64>, Trouble> {
    let one_of = |a: &'static str, b: &'static str| match (grasp.get(a).value.is_null(), grasp.get(b).value.is_null()) {
        (false, false) => Err(format!("{}, {b}: says the same as {a}; only one of them, please", grasp.at)),
        (true, false) => Ok(grasp.get(b)),
        _ => Ok(grasp.get(a)),
    };
    let scale = one_of("torque_scale", "L")?.maybe(Field::positive)?.unwrap_or(1.0);
    // In words it is a note: the positions refer to it already.
    let words = grasp.get("reference_point").value.is_string();
    let reference = if words { grasp.get("reference") } else { one_of("reference", "reference_point")? };
    let reference = reference.maybe(Field::vector)?.unwrap_or_else(Vector::zeros);
    WrenchFrame::new(reference, scale).map_err(|error| format!("{}, torque_scale, reference: {error}", grasp.at))
}

const OUTWARD: &str = "all normals point away from the middle of the contacts; they must point into the object";

/// Do all normals point away from the centroid of the contacts?
fn outward(contacts: &[Touch]) -> bool {
    let positions = || contacts.iter().map(|c| c.contact.contact.position());
    let centroid = positions().sum::<Vector<f64, 3>>() / contacts.len().max(1) as f64;
    let away = |c: &Touch| {
        let out = c.contact.contact.position() - centroid;
        c.contact.contact.normal().dot(&out) > 1e-3 * out.norm()
    };
    contacts.len() > 1 && contacts.iter().all(away)
}

fn friction(field: &Field) -> Result<Friction<f64>, Trouble> {
    let coefficient = |key: &str| field.get(key).maybe(Field::not_negative);
    let (mu, mus) = (coefficient("mu")?, coefficient("mus")?.unwrap_or(0.0));
    let slides = mu.is_some_and(|mu| mu > 0.0);
    let kind = match field.get("type").maybe(|kind| kind.text())? {
        Some(kind) => kind.to_lowercase(),
        None if mus > 0.0 => "soft".into(),
        None if slides => "hard".into(),
        None => "frictionless".into(),
    };
    match (kind.as_str(), mu) {
        ("frictionless", _) if slides => field.get("mu").wrong("is above 0 at a contact without friction"),
        ("frictionless" | "hard", _) if mus > 0.0 => field.get("mus").wrong("is above 0 at a contact that is not soft"),
        ("frictionless", _) => Ok(Friction::Frictionless),
        ("soft", Some(mu)) => Ok(Friction::Soft { mu, mus }),
        ("hard", Some(mu)) => Ok(Friction::Hard { mu }),
        ("soft" | "hard", None) => field.get("mu").wrong("is needed for a contact with friction"),
        _ => field.get("type").wrong("is not soft, hard or frictionless"),
    }
}

fn touch(index: usize, field: &Field, normalize: bool) -> Result<Touch, Trouble> {
    field.only(CONTACT[0], CONTACT[1])?;
    let words = |error: ContactError| {
        let key = match error {
            ContactError::Position => "p",
            ContactError::Normal => "n",
            ContactError::Tangents => "o, t",
            ContactError::Friction => "mu, mus",
            ContactError::ForceCap => "force_cap",
            _ => "J",
        };
        let hint =
            if error == ContactError::Normal { " (\"normalize\": true or --normalize makes it one)" } else { "" };
        format!("{}, {key}: {error}{hint}", field.at)
    };
    let direction = |key: &str| {
        let v: Vector<f64, 3> = field.get(key).vector()?;
        match normalize && v.norm() > 0.0 && v.norm().is_finite() {
            true => Ok::<_, Trouble>(v / v.norm()),
            false => Ok(v),
        }
    };
    let mut contact = Contact::new(field.get("p").vector()?, direction("n")?, friction(field)?).map_err(words)?;
    let tangent = |key: &str| if field.get(key).value.is_null() { Ok(None) } else { direction(key).map(Some) };
    match (tangent("o")?, tangent("t")?) {
        (Some(o), Some(t)) => contact = contact.with_tangents(o, t).map_err(words)?,
        (Some(o), None) => contact = contact.with_tangents(o, contact.normal().cross(&o)).map_err(words)?,
        (None, Some(t)) => contact = contact.with_tangents(t.cross(contact.normal()), t).map_err(words)?,
        (None, None) => {}
    }
    if let Some(cap) = field.get("force_cap").maybe(Field::number)? {
        contact = contact.with_force_cap(cap).map_err(words)?;
    }
    let jacobian = field.get("J").maybe(|j| {
        let rows = j.rows()?;
        let [n, o, t, spin] = rows.as_slice() else { return j.wrong("has not 4 rows") };
        Jacobian::new([n, o, t, spin]).map_err(words)
    })?;
    let count = jacobian.map_or(0, |j| j.joints());
    if let Some(names) = field.get("joints").maybe(|names| names.entries("joint"))? {
        names.iter().try_for_each(|name| name.name().map(|_| ()))?;
        if names.len() != count {
            return field.get("joints").wrong(&format!("has {} names, J has {count} columns", names.len()));
        }
    }
    let limit = |joint: &Field| if joint.value.is_null() { Ok(f64::INFINITY) } else { joint.not_negative() };
    let limits = field.get("torque_limits").maybe(|list| {
        let limits: Vec<f64> = list.entries("joint")?.iter().map(limit).collect::<Result<_, Trouble>>()?;
        let fits = limits.len() == count && count > 0;
        if fits { Ok(limits) } else { list.wrong(&format!("has {} numbers, J has {count} columns", limits.len())) }
    })?;
    let name = field.get("finger").maybe(Field::name)?.unwrap_or_else(|| index.to_string());
    Ok(Touch { name, contact: HandContact { contact, jacobian }, limits })
}

fn reference(field: &Field) -> Result<Reference, Trouble> {
    field.only(REFERENCE[0], REFERENCE[1])?;
    let set = match field.get("set").text()?.to_lowercase().as_str() {
        "w" => Set::Passive,
        "wa" | "w^a" => Set::Active,
        _ => return field.get("set").wrong("is not W or Wa"),
    };
    let norm = match field.get("norm").text()?.to_lowercase().as_str() {
        "l1" => Norm::L1,
        "linf" | "l-infinity" => Norm::LInf,
        _ => return field.get("norm").wrong("is not L1 or Linf"),
    };
    let d = field.get("d").maybe(Field::number)?;
    let tolerance = field.get("tol").maybe(Field::not_negative)?.unwrap_or(1e-9);
    Ok(Reference { set, norm, q: unit(field)?, d, tolerance })
}

fn unit(reference: &Field) -> Result<Q, Trouble> {
    let q = reference.get("Q");
    if !q.value.is_object() {
        return q.wrong("is not an object");
    }
    let kind = q.get("type").text()?.to_lowercase();
    let numbers = match kind.as_str() {
        "ball" => "radius",
        "ellipsoid" => "semi_axes",
        "box" => "half_widths",
        "cross_polytope" => "half_axes",
        _ => "wrench",
    };
    q.only(&["type", numbers, "S", "space"], &["description", "note", "notes"])?;
    let shape = match kind.as_str() {
        "ball" => Shape::Ball(q.get("radius").maybe(Field::number)?.unwrap_or(1.0)),
        "ellipsoid" => Shape::Ellipsoid(q.get("semi_axes").numbers()?),
        "box" => Shape::Box(q.get("half_widths").numbers()?),
        "cross_polytope" => Shape::CrossPolytope(q.get("half_axes").numbers()?),
        "segment" => Shape::Segment(q.get("wrench").numbers()?),
        _ => return q.get("type").wrong("is not ball, ellipsoid, box, cross_polytope or segment"),
    };
    let count = shape.numbers().map_or(6, <[f64]>::len);
    let (s, r) = (q.get("S"), reference.get("R"));
    let axes = if !s.value.is_null() {
        Some((s.entries("row")?.iter().map(Field::vector).collect::<Result<Vec<_>, _>>()?, s.at))
    } else if shape.numbers().is_some() && (count != 6 || !q.get("space").value.is_null()) {
        if r.value.is_null() {
            return q
                .wrong(&format!("has {count} numbers, which is not 6, and neither R nor Q.S says along which axes"));
        }
        let rows = r.rows()?;
        let columns = rows.first().map_or(0, Vec::len);
        if rows.len() != 6 || rows.iter().any(|row| row.len() != columns) {
            return r.wrong("is not a matrix of 6 rows");
        }
        Some(((0..columns).map(|k| Vector::from_fn(|i, _| rows[i][k])).collect(), r.at))
    } else {
        None
    };
    if let Some((axes, at)) = &axes
        && shape.numbers().is_some()
        && axes.len() != count
    {
        return Err(format!("{at}: has {} axes, Q has {count} numbers", axes.len()));
    }
    Q::new(shape, axes.map(|(axes, _)| axes)).map_err(|error| format!("{}: {error}", q.at))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str) -> String {
        read(text, false).err().unwrap_or_default()
    }

    const BARE: &str = r#"{"contacts": [{"p": [0, 0, 1], "n": [0, 0, -1], "mu": 0.5}]}"#;

    #[test]
    fn little_is_enough() {
        let grasps = read(BARE, false).unwrap();
        let [grasp] = grasps.as_slice() else { panic!("{}", grasps.len()) };
        assert_eq!((grasp.id.as_str(), grasp.contacts[0].name.as_str(), grasp.queries.len()), ("0", "0", 0));
        assert_eq!(grasp.contacts[0].contact.contact.friction(), Friction::Hard { mu: 0.5 });
        assert!(grasp.contacts[0].contact.jacobian.is_none());
        assert_eq!(read(&format!("[{BARE}, {BARE}]"), false).unwrap().len(), 2);
        assert_eq!(read("[]", false).unwrap().len(), 0);
        assert_eq!(read(&format!(r#"{{"instances": [{BARE}]}}"#), false).unwrap().len(), 1);
    }

    #[test]
    fn friction_by_its_numbers() {
        for (numbers, friction) in [
            ("", Friction::Frictionless),
            (r#", "mu": 0, "mus": null"#, Friction::Frictionless),
            (r#", "mu": 0.5, "mus": null"#, Friction::Hard { mu: 0.5 }),
            (r#", "mu": 0.5, "mus": 0.1"#, Friction::Soft { mu: 0.5, mus: 0.1 }),
            (r#", "mu": 0.5, "type": "soft""#, Friction::Soft { mu: 0.5, mus: 0.0 }),
        ] {
            let text = BARE.replace(r#", "mu": 0.5"#, numbers);
            assert_eq!(read(&text, false).unwrap()[0].contacts[0].contact.contact.friction(), friction, "{numbers}");
        }
    }

    /// What would have been passed over, in silence, is an error with the nearest known name; what contradicts itself is one, too.
    #[test]
    fn nothing_is_passed_over() {
        let jacobian = r#""J": [[1, 2], [0, 1], [0, 0], [0, 0]]"#;
        let contact = |more: &str| BARE.replacen("\"mu\": 0.5", &format!("\"mu\": 0.5, {more}"), 1);
        let grasp = |more: &str| BARE.replacen('{', &format!("{{{more}, "), 1);
        let query = |more: &str| {
            let query = format!(r#"}}], "refs": [{{"set": "W", "norm": "L1", "Q": {{"type": "ball"}}, {more}}}]}}"#);
            BARE.replacen("}]}", &query, 1)
        };
        let of = |q: &str| query(r#""d": null"#).replacen(r#"{"type": "ball"}"#, q, 1);
        for (text, says) in [
            (BARE.replacen("\"mu\"", "\"Mu\"", 1), "contact 0, Mu: is not known here; did you mean mu?"),
            (contact(r#""force_caps": 2"#), "contact 0, force_caps: is not known here; did you mean force_cap?"),
            (
                contact(r#""torquelimits": [1]"#),
                "contact 0, torquelimits: is not known here; did you mean torque_limits?",
            ),
            (contact(r#""normal": [0, 0, 1]"#), "contact 0, normal: is not known here"),
            (grasp(r#""torque_scal": 1"#), "grasp 0, torque_scal: is not known here; did you mean torque_scale?"),
            (grasp(r#""refences": []"#), "grasp 0, refences: is not known here; did you mean reference?"),
            (query(r#""tolerance": 1"#), "grasp 0, ref 0, tolerance: is not known here"),
            (
                of(r#"{"type": "ball", "radus": 2}"#),
                "grasp 0, ref 0, Q, radus: is not known here; did you mean radius?",
            ),
            (of(r#"{"type": "box", "semi_axes": [1]}"#), "grasp 0, ref 0, Q, semi_axes: is not known here"),
            (of("\"ball\""), "grasp 0, ref 0, Q: is not an object"),
            (
                format!(r#"{{"instances": [{BARE}], "instance": 1}}"#),
                "the file, instance: is not known here; did you mean instances?",
            ),
            (contact(r#""force_cap": -1"#), "grasp 0, contact 0, force_cap: the force cap is negative"),
            (contact(r#""force_cap": "2""#), "grasp 0, contact 0, force_cap: is not a number"),
            (contact(r#""finger": [1]"#), "grasp 0, contact 0, finger: is neither a text nor a number"),
            (contact(r#""torque_limits": [1]"#), "grasp 0, contact 0, torque_limits: has 1 numbers, J has 0 columns"),
            (
                contact(&format!(r#"{jacobian}, "torque_limits": [1]"#)),
                "grasp 0, contact 0, torque_limits: has 1 numbers, J has 2",
            ),
            (
                contact(&format!(r#"{jacobian}, "torque_limits": [1, -1]"#)),
                "grasp 0, contact 0, torque_limits, joint 1: is negative",
            ),
            (
                contact(&format!(r#"{jacobian}, "joints": ["a"]"#)),
                "grasp 0, contact 0, joints: has 1 names, J has 2 columns",
            ),
            (contact(r#""type": "frictionless""#), "grasp 0, contact 0, mu: is above 0 at a contact without friction"),
            (
                contact(r#""type": "hard", "mus": 0.1"#),
                "grasp 0, contact 0, mus: is above 0 at a contact that is not soft",
            ),
            (grasp(r#""L": 0"#), "grasp 0, L: is not above 0"),
            (grasp(r#""L": 1, "torque_scale": 1"#), "grasp 0, L: says the same as torque_scale"),
            (grasp(r#""reference": [1, 2]"#), "grasp 0, reference: has not 3 numbers"),
            (grasp(r#""reference": "centre""#), "grasp 0, reference: is not a list"),
            (
                grasp(r#""reference": [0, 0, 0], "reference_point": [0, 0, 0]"#),
                "grasp 0, reference_point: says the same",
            ),
            (grasp(r#""length_unit_m": "mm""#), "grasp 0, length_unit_m: is not a number"),
            (grasp(r#""id": [1]"#), "grasp 0, id: is neither a text nor a number"),
            (grasp(r#""normalize": 1"#), "grasp 0, normalize: is not true or false"),
            (query(r#""tol": -1"#), "grasp 0, ref 0, tol: is negative"),
            (
                query(r#""d": 1"#).replacen("\"W\"", "\"Wa\"", 1),
                "grasp 0, ref 0, set: is Wa, but no contact has a Jacobian",
            ),
            ("[1]".into(), "grasp 0: is not an object"),
            (contact("\n\"mu\": 0.4"), "line 2: mu is there twice in one object"),
        ] {
            let told = refusal(&text);
            assert!(told.contains(says), "{text}: {told}");
        }
    }

    /// All words that are one letter away from this one: a letter left out, doubled, replaced, or two of them exchanged; and other capitals.
    fn slips(word: &str) -> Vec<String> {
        let letters: Vec<char> = word.chars().collect();
        let with = |change: &dyn Fn(&mut Vec<char>)| {
            let mut letters = letters.clone();
            change(&mut letters);
            letters.into_iter().collect::<String>()
        };
        let mut slips = vec![word.to_uppercase(), word.to_lowercase()];
        for i in 0..letters.len() {
            slips.push(with(&|l| {
                l.remove(i);
            }));
            slips.push(with(&|l| l.insert(i, l[i])));
            slips.extend(['e', 'x'].map(|other| with(&|l| l[i] = other)));
            slips.push(with(&|l| {
                l[i] = if l[i].is_uppercase() { l[i].to_ascii_lowercase() } else { l[i].to_ascii_uppercase() }
            }));
        }
        // (Of two letters, these are both changed: no name is near.)
        slips.extend((1..letters.len()).filter(|_| letters.len() > 2).map(|i| with(&|l| l.swap(i - 1, i))));
        slips
    }

    /// Every field of every object, written with one slip: an error at its place that offers the field, or another one that is as near.
    #[test]
    fn every_slip_of_every_field_is_told() {
        let grasp = |key: &str| BARE.replacen('{', &format!("{{\"{key}\": null, "), 1);
        let contact = |key: &str| BARE.replacen("\"mu\": 0.5", &format!("\"mu\": 0.5, \"{key}\": null"), 1);
        let reference = |key: &str| {
            let refs =
                format!(r#"}}], "refs": [{{"set": "W", "norm": "L1", "Q": {{"type": "ball"}}, "{key}": null}}]}}"#);
            BARE.replacen("}]}", &refs, 1)
        };
        let unit = |key: &str| {
            reference("d").replacen(r#"{"type": "ball"}"#, &format!(r#"{{"type": "ball", "{key}": 1}}"#), 1)
        };
        let file = |key: &str| format!(r#"{{"instances": [{BARE}], "{key}": null}}"#);
        let q: [&[&str]; 2] = [&["type", "radius", "S", "space"], &["description", "note", "notes"]];
        type Text<'a> = &'a dyn Fn(&str) -> String;
        let objects: [(&str, [&[&str]; 2], Text); 5] = [
            ("grasp 0", GRASP, &grasp),
            ("grasp 0, contact 0", CONTACT, &contact),
            ("grasp 0, ref 0", REFERENCE, &reference),
            ("grasp 0, ref 0, Q", q, &unit),
            ("the file", FILE, &file),
        ];
        let mut told = 0;
        for (at, [fields, notes], text) in objects {
            for field in fields {
                let unknown = |slip: &String| !fields.contains(&slip.as_str()) && !notes.contains(&slip.as_str());
                for slip in slips(field).into_iter().filter(unknown) {
                    let says = refusal(&text(&slip));
                    let (place, hint) = says.split_once(": is not known here; did you mean ").unwrap_or((&says, ""));
                    assert_eq!(place, format!("{at}, {slip}"), "{says}");
                    let offered = hint.split_once('?').unwrap_or_default().0;
                    // Capitals do not count; an exchange of two letters is two changes, so that another name may be as near.
                    let near = |name: &str| slips(&name.to_lowercase()).contains(&slip.to_lowercase());
                    let same = offered == *field || fields.contains(&offered) && (near(offered) || field.len() < 4);
                    assert!(same, "{field} as {slip}: {says}");
                    told += 1;
                }
            }
        }
        assert!(told > 500, "{told}");
    }

    /// Notes, capitals, and the words of the shared data.
    #[test]
    fn what_is_known_is_read() {
        let text = r#"{"_who": 1, "source": "x", "reference_point": "centre of mass", "torque_scale": 0.05, "reference": [0, 0, 0.5],
            "contacts": [{"p": [0, 0, 1], "n": [0, 0, -1], "mu": 0.5, "type": "Soft", "mus": 0.01, "force_cap": 3, "finger": 7,
                          "J": [[1, 2], [0, 1], [0, 0], [0, 0]], "joints": ["a", "b"], "torque_limits": [1.5, null]}],
            "refs": [{"set": "wa", "norm": "linf", "Q": {"type": "Ball"}, "hits": 3, "_mine": 1}]}"#;
        let grasps = read(text, false).unwrap();
        let grasp = &grasps[0];
        assert_eq!((grasp.frame.torque_scale(), *grasp.frame.reference()), (0.05, Vector::from([0.0, 0.0, 0.5])));
        let touch = &grasp.contacts[0];
        assert_eq!((touch.name.as_str(), touch.contact.contact.force_cap()), ("7", 3.0));
        assert_eq!(touch.limits, Some(vec![1.5, f64::INFINITY]));
        assert_eq!((grasp.queries[0].set, grasp.queries[0].norm), (Set::Active, Norm::LInf));
    }

    /// The shared files, and that of the project, say nothing that is not known.
    #[test]
    #[ignore = "needs ../shared/data"]
    fn the_shared_files_are_read() {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        for (file, count) in [("grasps", 8), ("hands", 16), ("open", 12), ("regular", 42), ("reported", 32)] {
            let text = std::fs::read_to_string(root.join(format!("../../shared/data/grasps/{file}.json"))).unwrap();
            let grasps = read(&text, false).unwrap();
            assert_eq!(grasps.len(), count, "{file}");
            // (Two contacts of a grasp that is open look away from each other.)
            let warned = grasps.iter().filter(|g| !g.warnings.is_empty()).count();
            assert!(warned <= usize::from(file == "open"), "{file}: {warned}");
        }
    }

    #[test]
    fn normals_on_request() {
        let long = BARE.replacen("[0, 0, -1]", "[0, 0, -2]", 1);
        assert!(refusal(&long).contains("normalize"), "{}", refusal(&long));
        assert_eq!(read(&long, true).unwrap()[0].contacts[0].contact.contact.normal().z, -1.0);
        assert!(read(&long.replacen('{', "{\"normalize\": true, ", 1), false).is_ok());
        assert!(read(&long.replacen('{', "{\"normalize\": false, ", 1), true).is_err());
        let none = BARE.replacen("[0, 0, -1]", "[0, 0, 0]", 1);
        assert!(read(&none, true).is_err());
    }

    #[test]
    fn normals_that_point_out_are_told() {
        let pinch = |sign: i32| {
            let touch = |x: i32| format!(r#"{{"p": [{x}, 0, 0], "n": [{}, 0, 0], "mu": 0.5}}"#, x * sign);
            format!(r#"{{"contacts": [{}, {}]}}"#, touch(1), touch(-1))
        };
        assert_eq!(read(&pinch(-1), false).unwrap()[0].warnings.len(), 0);
        let warnings = &read(&pinch(1), false).unwrap()[0].warnings;
        assert!(warnings.len() == 1 && warnings[0].starts_with("grasp 0: all normals point away"), "{warnings:?}");
        assert_eq!(read(BARE, false).unwrap()[0].warnings.len(), 0);
    }

    /// Grasp, contact or reference, and field are named.
    #[test]
    fn errors_say_where() {
        for (from, to, says) in [
            ("0.5", "-0.5", "grasp 0, contact 0, mu: is negative"),
            ("0.5", "-0.5, \"type\": \"frictionless\"", "grasp 0, contact 0, mu: is negative"),
            ("0.5", "0.5, \"mus\": -0.1", "grasp 0, contact 0, mus: is negative"),
            ("}]}", "}], \"refs\": {\"set\": \"W\"}}", "grasp 0, refs: is not a list"),
            (r#"[0, 0, 1]"#, r#"[0, 1]"#, "grasp 0, contact 0, p: has not 3 numbers"),
            (r#"[0, 0, 1]"#, r#"[0, null, 1]"#, "grasp 0, contact 0, p, entry 1 (missing): is not a number"),
            (r#"[0, 0, -1]"#, r#"[0, 0, -2]"#, "grasp 0, contact 0, n: the normal is not a unit vector"),
            (r#""p""#, r#""_p""#, "grasp 0, contact 0, p (missing): is not a list"),
            ("0.5", "-0.5, \"type\": \"hard\"", "grasp 0, contact 0, mu: is negative"),
            ("0.5", "0.5, \"J\": [[1], [1], [1]]", "grasp 0, contact 0, J: has not 4 rows"),
            ("0.5", "0.5, \"J\": [[1], [1, 2], [1], [0]]", "grasp 0, contact 0, J: the Jacobian"),
            ("0.5", "0.5, \"type\": \"wet\"", "grasp 0, contact 0, type: is not soft"),
            (
                "\"contacts\"",
                "\"id\": \"x\", \"contact\"",
                "the file, contact: is not known here; did you mean contacts?",
            ),
            ("}]}", "}], \"refs\": [{\"set\": \"V\"}]}", "grasp 0, ref 0, set: is not W or Wa"),
            (
                "}]}",
                "}], \"refs\": [{\"set\": \"W\", \"norm\": \"L1\", \"Q\": {\"type\": \"box\", \"half_widths\": [1]}}]}",
                "grasp 0, ref 0, Q: has 1 numbers, which is not 6",
            ),
        ] {
            let text = BARE.replacen(from, to, 1);
            assert!(refusal(&text).starts_with(says), "{text}: {}", refusal(&text));
        }
        assert!(refusal("{").contains("line 1"));
        let named = BARE.replacen('{', "{\"id\": \"a\", ", 1);
        assert!(refusal(&format!("[{named}, {BARE}, {named}]")).starts_with("grasp a, id: is that of grasp number 0"));
        assert!(refusal(&format!("[{BARE}, {}]", named.replace("\"a\"", "0"))).starts_with("grasp 0, id:"));
    }
}
