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
//! underscore. Any other field is an error (`Field::only`), and so is what contradicts itself. An error names grasp, contact and field, and says what is there and
//! what may be.

use std::collections::HashMap;

use qdist::Vector;
use qdist::grasp::{Contact, ContactError, Friction, HandContact, Jacobian, Norm, WrenchFrame};
use serde_json::Value;

use crate::Trouble;
use crate::grasp::unit_sets::{Q, Shape};
use crate::json::{self, Field, Known};

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

const FILE: Known = Known { fields: &["instances"], notes: &["schema", "note", "notes", "source", "description"] };
const GRASP: Known = Known {
    fields: &[
        "id",
        "contacts",
        "refs",
        "length_unit_m",
        "torque_scale",
        "L",
        "reference",
        "reference_point",
        "normalize",
    ],
    notes: &["schema", "source", "licence_of_source", "description", "note", "notes", "qhull_exact"],
};
const CONTACT: Known = Known {
    fields: &["p", "n", "o", "t", "mu", "mus", "type", "finger", "force_cap", "J", "joints", "torque_limits"],
    notes: &["description", "note", "notes"],
};
const REFERENCE: Known = Known {
    fields: &["set", "norm", "Q", "d", "tol", "R"],
    notes: &[
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
};
/// The kinds of Q, and the field that has its numbers.
const KINDS: [(&str, Known); 5] = {
    const fn of(fields: &'static [&'static str]) -> Known {
        Known { fields, notes: &["description", "note", "notes"] }
    }
    [
        ("ball", of(&["type", "radius", "S", "space"])),
        ("ellipsoid", of(&["type", "semi_axes", "S", "space"])),
        ("box", of(&["type", "half_widths", "S", "space"])),
        ("cross_polytope", of(&["type", "half_axes", "S", "space"])),
        ("segment", of(&["type", "wrench", "S", "space"])),
    ]
};

/// What a file must be.
const LIST: &str = "a list of grasps (or the file is one, or it is a grasp, which has `contacts`)";

/// The grasps of a file's text; `normalize`: all normals become unit vectors.
pub fn read(text: &str, normalize: bool) -> Result<Vec<Grasp>, Trouble> {
    let data = json::parse(text)?;
    let file = Field::of(&data, "");
    let list = match &data {
        Value::Object(fields) if fields.contains_key("contacts") => vec![Field::of(&data, "grasp 0")],
        Value::Object(fields) if fields.contains_key("instances") => {
            file.only(&FILE)?;
            file.get("instances").things("grasp", "a list of grasps")?
        }
        Value::Object(_) => {
            file.only(&Known { fields: &["instances", "contacts"], ..FILE })?;
            return file.get("instances").must(LIST);
        }
        _ => file.things("grasp", LIST)?,
    };
    if list.is_empty() {
        return Err("a list of no grasps; it must be a list of one grasp or more".into());
    }
    let mut seen = HashMap::new();
    let unique = |(i, here): (usize, &Field)| {
        let id = here.get("id").maybe(Field::name)?.unwrap_or_else(|| i.to_string());
        match seen.insert(id.clone(), i) {
            Some(first) => Err(format!("grasp {id}: `id` is that of grasp number {first} and of number {i}, from 0")),
            None => grasp(id, here.value, normalize),
        }
    };
    list.iter().enumerate().map(unique).collect()
}

fn grasp(id: String, value: &Value, normalize: bool) -> Result<Grasp, Trouble> {
    let top = Field::of(value, format!("grasp {id}"));
    top.only(&GRASP)?;
    let normalize = top.get("normalize").maybe(Field::flag)?.unwrap_or(normalize);
    // Positions in messages as they are counted in the file.
    let list = top.get("contacts").things("contact", "a list of contacts")?;
    let contacts: Vec<Touch> =
        list.iter().enumerate().map(|(i, c)| touch(i, c, normalize)).collect::<Result<_, _>>()?;
    if contacts.is_empty() {
        return top.get("contacts").must("a list of one contact or more");
    }
    let refs = top.get("refs").maybe(|refs| refs.things("ref", "a list of refs"))?.unwrap_or_default();
    let queries = refs.iter().map(reference).collect::<Result<Vec<_>, _>>()?;
    let passive = contacts.iter().all(|c| c.contact.jacobian.is_none());
    if let (true, Some(i)) = (passive, queries.iter().position(|q| q.set == Set::Active)) {
        return refs[i].get("set").wrong("no contact of the grasp has a Jacobian `J`");
    }
    let length_unit = top.get("length_unit_m").maybe(Field::positive)?;
    let warnings = outward(&contacts).then(|| format!("grasp {id}: {OUTWARD}")).into_iter().collect();
    Ok(Grasp { length_unit, frame: frame(&top)?, id, contacts, queries, warnings })
}

/// Reference point and torque scale.
fn frame(grasp: &Field) -> Result<WrenchFrame<f64>, Trouble> {
    let one_of = |a: &'static str, b: &'static str| match (grasp.get(a).is_missing(), grasp.get(b).is_missing()) {
        (false, false) => grasp.get(b).wrong(&format!("it says the same as `{a}`; only one of them, please")),
        (true, false) => Ok(grasp.get(b)),
        _ => Ok(grasp.get(a)),
    };
    let scale = one_of("torque_scale", "L")?;
    // In words it is a note: the positions refer to it already.
    let words = grasp.get("reference_point").value.is_string();
    let point = if words { grasp.get("reference") } else { one_of("reference", "reference_point")? };
    let l = if scale.is_missing() { 1.0 } else { scale.positive()? };
    let reference = if point.is_missing() { Vector::zeros() } else { point.vector()? };
    let at_origin = WrenchFrame::new(Vector::zeros(), l).or_else(|error| scale.wrong(&error.to_string()))?;
    if reference == Vector::<f64, 3>::zeros() {
        return Ok(at_origin);
    }
    WrenchFrame::new(reference, l).or_else(|error| point.wrong(&error.to_string()))
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
        ("frictionless", _) if slides => field.get("mu").wrong("a contact without friction has none"),
        ("frictionless" | "hard", _) if mus > 0.0 => field.get("mus").wrong("only a soft contact has it"),
        ("frictionless", _) => Ok(Friction::Frictionless),
        ("soft", Some(mu)) => Ok(Friction::Soft { mu, mus }),
        ("hard", Some(mu)) => Ok(Friction::Hard { mu }),
        ("soft" | "hard", None) => field.get("mu").must("a number, 0 or more, at a contact with friction"),
        _ => field.get("type").must("soft, hard or frictionless"),
    }
}

fn touch(index: usize, field: &Field, normalize: bool) -> Result<Touch, Trouble> {
    field.only(&CONTACT)?;
    let words = |error: ContactError| {
        let key = match error {
            ContactError::Position => "p",
            ContactError::Normal => "n",
            ContactError::Tangents if field.get("o").is_missing() => "t",
            ContactError::Tangents => "o",
            // The larger of both is too large; negative ones are refused before.
            ContactError::Friction if field.get("mus").value.as_f64() > field.get("mu").value.as_f64() => "mus",
            ContactError::Friction => "mu",
            ContactError::ForceCap => "force_cap",
            _ => "J",
        };
        let hint =
            if error == ContactError::Normal { " (\"normalize\": true or --normalize makes it one)" } else { "" };
        field.get(key).wrong::<()>(&format!("{error}{hint}")).err().unwrap_or_default()
    };
    let direction = |key: &str| {
        let v: Vector<f64, 3> = field.get(key).vector()?;
        match normalize && v.norm() > 0.0 && v.norm().is_finite() {
            true => Ok::<_, Trouble>(v / v.norm()),
            false => Ok(v),
        }
    };
    let mut contact = Contact::new(field.get("p").vector()?, direction("n")?, friction(field)?).map_err(words)?;
    let tangent = |key: &str| if field.get(key).is_missing() { Ok(None) } else { direction(key).map(Some) };
    match (tangent("o")?, tangent("t")?) {
        (Some(o), Some(t)) => contact = contact.with_tangents(o, t).map_err(words)?,
        (Some(o), None) => contact = contact.with_tangents(o, contact.normal().cross(&o)).map_err(words)?,
        (None, Some(t)) => contact = contact.with_tangents(t.cross(contact.normal()), t).map_err(words)?,
        (None, None) => {}
    }
    if let Some(cap) = field.get("force_cap").maybe(Field::number)? {
        contact = contact.with_force_cap(cap).map_err(words)?;
    }
    let columns = |what: &str, found: usize, count: usize| match count {
        0 => "the contact has no Jacobian `J` that it could belong to".into(),
        _ => format!("these are {found} {what}, `J` has {count} columns"),
    };
    let jacobian = field.get("J").maybe(|j| {
        let rows = j.rows()?;
        let [n, o, t, spin] = rows.as_slice() else { return j.must("a list of 4 rows, along n, o, t and about n") };
        Jacobian::new([n, o, t, spin]).map_err(words)
    })?;
    let count = jacobian.map_or(0, |j| j.joints());
    if let Some(names) = field.get("joints").maybe(|names| names.entries("a list of names"))? {
        names.iter().try_for_each(|name| name.name().map(|_| ()))?;
        if names.len() != count {
            return field.get("joints").wrong(&columns("names", names.len(), count));
        }
    }
    let limit = |joint: &Field| if joint.is_missing() { Ok(f64::INFINITY) } else { joint.not_negative() };
    let limits = field.get("torque_limits").maybe(|list| {
        let limits: Vec<f64> = list.entries("a list of numbers")?.iter().map(limit).collect::<Result<_, Trouble>>()?;
        let fits = limits.len() == count && count > 0;
        if fits { Ok(limits) } else { list.wrong(&columns("numbers", limits.len(), count)) }
    })?;
    let name = field.get("finger").maybe(Field::name)?.unwrap_or_else(|| index.to_string());
    Ok(Touch { name, contact: HandContact { contact, jacobian }, limits })
}

fn reference(field: &Field) -> Result<Reference, Trouble> {
    field.only(&REFERENCE)?;
    let set = match word(field, "set").as_str() {
        "w" => Set::Passive,
        "wa" | "w^a" => Set::Active,
        _ => return field.get("set").must("W or Wa"),
    };
    let norm = match word(field, "norm").as_str() {
        "l1" => Norm::L1,
        "linf" | "l-infinity" => Norm::LInf,
        _ => return field.get("norm").must("L1 or Linf"),
    };
    let d = field.get("d").maybe(Field::number)?;
    let tolerance = field.get("tol").maybe(Field::not_negative)?.unwrap_or(1e-9);
    Ok(Reference { set, norm, q: unit(field)?, d, tolerance })
}

/// A word whose capitals do not matter; none where there is no text.
fn word(field: &Field, key: &str) -> String {
    field.get(key).value.as_str().unwrap_or_default().to_lowercase()
}

fn unit(reference: &Field) -> Result<Q, Trouble> {
    let q = reference.get("Q");
    if !q.value.is_object() {
        return q.must("an object, {\"type\": \"ball\"} for one");
    }
    let kind = word(&q, "type");
    let Some((_, known)) = KINDS.iter().find(|(name, _)| *name == kind) else {
        return q.get("type").must("ball, ellipsoid, box, cross_polytope or segment");
    };
    q.only(known)?;
    let numbers = q.get(known.fields[1]);
    let shape = match kind.as_str() {
        "ball" => Shape::Ball(numbers.maybe(Field::positive)?.unwrap_or(1.0)),
        "segment" => Shape::Segment(numbers.numbers()?),
        _ => {
            let sizes =
                numbers.entries("a list of numbers")?.iter().map(Field::not_negative).collect::<Result<_, _>>()?;
            match kind.as_str() {
                "ellipsoid" => Shape::Ellipsoid(sizes),
                "box" => Shape::Box(sizes),
                _ => Shape::CrossPolytope(sizes),
            }
        }
    };
    let axes = axes(reference, &q, &shape, known.fields[1])?;
    Q::new(shape, axes).or_else(|error| q.wrong(&error))
}

/// The axes along which the numbers of a Q are meant, where the file names them.
fn axes(reference: &Field, q: &Field, shape: &Shape, key: &str) -> Result<Option<Vec<Vector<f64, 6>>>, Trouble> {
    let count = shape.numbers().map(<[f64]>::len);
    let (s, r) = (q.get("S"), reference.get("R"));
    let (axes, of) = if !s.is_missing() {
        (s.entries("a list of rows of 6 numbers")?.iter().map(Field::vector).collect::<Result<Vec<_>, _>>()?, s)
    } else if count.is_some_and(|count| count != 6 || !q.get("space").is_missing()) {
        if r.is_missing() {
            return q.get(key).wrong("these are not 6 numbers, and neither `Q.S` nor `R` says along which axes");
        }
        let rows = r.rows()?;
        let columns = rows.first().map_or(0, Vec::len);
        if rows.len() != 6 || rows.iter().any(|row| row.len() != columns) {
            return r.must("a list of 6 rows, all of one length");
        }
        ((0..columns).map(|k| Vector::from_fn(|i, _| rows[i][k])).collect(), r)
    } else {
        return Ok(None);
    };
    match count {
        Some(count) if axes.len() != count => {
            of.wrong(&format!("these are {} axes, `Q.{key}` has {count} numbers", axes.len()))
        }
        _ => Ok(Some(axes)),
    }
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
            (BARE.replacen("\"mu\"", "\"Mu\"", 1), "contact 0: `Mu` is not known here; did you mean `mu`?"),
            (contact(r#""force_caps": 2"#), "contact 0: `force_caps` is not known here; did you mean `force_cap`?"),
            (
                contact(r#""torquelimits": [1]"#),
                "contact 0: `torquelimits` is not known here; did you mean `torque_limits`?",
            ),
            (contact(r#""normal": [0, 0, 1]"#), "contact 0: `normal` is not known here"),
            (grasp(r#""torque_scal": 1"#), "grasp 0: `torque_scal` is not known here; did you mean `torque_scale`?"),
            (grasp(r#""refences": []"#), "grasp 0: `refences` is not known here; did you mean `reference`?"),
            (query(r#""tolerance": 1"#), "grasp 0, ref 0: `tolerance` is not known here"),
            (
                of(r#"{"type": "ball", "radus": 2}"#),
                "grasp 0, ref 0: `Q.radus` is not known here; did you mean `radius`?",
            ),
            (of(r#"{"type": "box", "semi_axes": [1]}"#), "grasp 0, ref 0: `Q.semi_axes` is not known here"),
            (of("\"ball\""), "grasp 0, ref 0: `Q` is \"ball\"; it must be an object"),
            (
                format!(r#"{{"instances": [{BARE}], "instance": 1}}"#),
                "`instance` is not known here; did you mean `instances`?",
            ),
            (contact(r#""force_cap": -1"#), "grasp 0, contact 0: `force_cap` is -1: the force cap is negative"),
            (contact(r#""force_cap": "2""#), "grasp 0, contact 0: `force_cap` is \"2\"; it must be a number"),
            (contact(r#""finger": [1]"#), "grasp 0, contact 0: `finger` is [1]; it must be a text or a number"),
            (
                contact(r#""torque_limits": [1]"#),
                "grasp 0, contact 0: `torque_limits` is [1]: the contact has no Jacobian",
            ),
            (
                contact(&format!(r#"{jacobian}, "torque_limits": [1]"#)),
                "grasp 0, contact 0: `torque_limits` is [1]: these are 1 numbers, `J` has 2",
            ),
            (
                contact(&format!(r#"{jacobian}, "torque_limits": [1, -1]"#)),
                "grasp 0, contact 0: `torque_limits[1]` is -1; it must be a number, 0 or more",
            ),
            (
                contact(&format!(r#"{jacobian}, "joints": ["a"]"#)),
                "grasp 0, contact 0: `joints` is [\"a\"]: these are 1 names, `J` has 2 columns",
            ),
            (
                contact(r#""type": "frictionless""#),
                "grasp 0, contact 0: `mu` is 0.5: a contact without friction has none",
            ),
            (contact(r#""type": "hard", "mus": 0.1"#), "grasp 0, contact 0: `mus` is 0.1: only a soft contact has it"),
            (grasp(r#""L": 0"#), "grasp 0: `L` is 0; it must be a number above 0"),
            (grasp(r#""L": 1, "torque_scale": 1"#), "grasp 0: `L` is 1: it says the same as `torque_scale`"),
            (grasp(r#""reference": [1, 2]"#), "grasp 0: `reference` is [1,2]; it must be a list of 3 numbers"),
            (grasp(r#""reference": "centre""#), "grasp 0: `reference` is \"centre\"; it must be a list"),
            (
                grasp(r#""reference": [0, 0, 0], "reference_point": [0, 0, 0]"#),
                "grasp 0: `reference_point` is [0,0,0]: it says the same",
            ),
            (grasp(r#""length_unit_m": "mm""#), "grasp 0: `length_unit_m` is \"mm\"; it must be a number above 0"),
            (grasp(r#""id": [1]"#), "grasp 0: `id` is [1]; it must be a text or a number"),
            (grasp(r#""normalize": 1"#), "grasp 0: `normalize` is 1; it must be true or false"),
            (of(r#"{"type": "bal"}"#), "grasp 0, ref 0: `Q.type` is \"bal\"; it must be ball, ellipsoid, box"),
            (of("{}"), "grasp 0, ref 0: `Q.type` is missing; it must be ball, ellipsoid, box"),
            (of(r#"{"type": "ball", "radius": 0}"#), "grasp 0, ref 0: `Q.radius` is 0; it must be a number above 0"),
            (
                of(r#"{"type": "box", "half_widths": [1, 1, 1, 1, -1, 1]}"#),
                "grasp 0, ref 0: `Q.half_widths[4]` is -1; it must be a number, 0 or more",
            ),
            (of(r#"{"type": "box", "half_widths": [0, 0, 0, 0, 0, 0]}"#), "it is no more than the origin"),
            (of(r#"{"type": "segment"}"#), "grasp 0, ref 0: `Q.wrench` is missing; it must be a list of numbers"),
            (contact(r#""mus": 1e300"#), "grasp 0, contact 0: `mus` is 1e+300: a friction coefficient is"),
            (contact(r#""force_cap": 1e300"#), "grasp 0, contact 0: `force_cap` is 1e+300: the force cap is"),
            (grasp(r#""L": 1e-300"#), "grasp 0: `L` is 1e-300: "),
            (grasp(r#""reference": [0, 1e300, 0]"#), "grasp 0: `reference` is [0,1e+300,0]: "),
            ("[]".into(), "it must be a list of one grasp or more"),
            (r#"{"instances": []}"#.into(), "it must be a list of one grasp or more"),
            (r#"{"contacts": []}"#.into(), "grasp 0: `contacts` is []; it must be a list of one contact or more"),
            ("{}".into(), "`instances` is missing; it must be a list of grasps"),
            ("7".into(), "the file is 7; it must be a list of grasps"),
            ("".into(), "this is no JSON"),
            (query(r#""tol": -1"#), "grasp 0, ref 0: `tol` is -1; it must be a number, 0 or more"),
            (
                query(r#""d": 1"#).replacen("\"W\"", "\"Wa\"", 1),
                "grasp 0, ref 0: `set` is \"Wa\": no contact of the grasp has a Jacobian",
            ),
            ("[1]".into(), "grasp 0 is 1; it must be an object"),
            (contact("\n\"mu\": 0.4"), "line 2: `mu` is there twice in one object"),
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
        let [(_, q), ..] = KINDS;
        type Text<'a> = &'a dyn Fn(&str) -> String;
        let objects: [(&str, Known, Text); 5] = [
            ("grasp 0: `", GRASP, &grasp),
            ("grasp 0, contact 0: `", CONTACT, &contact),
            ("grasp 0, ref 0: `", REFERENCE, &reference),
            ("grasp 0, ref 0: `Q.", q, &unit),
            ("`", FILE, &file),
        ];
        let mut told = 0;
        for (at, Known { fields, notes }, text) in objects {
            for field in fields {
                let unknown = |slip: &String| !fields.contains(&slip.as_str()) && !notes.contains(&slip.as_str());
                for slip in slips(field).into_iter().filter(unknown) {
                    let says = refusal(&text(&slip));
                    let (place, hint) = says.split_once("` is not known here; did you mean `").unwrap_or((&says, ""));
                    assert_eq!(place, format!("{at}{slip}"), "{says}");
                    let offered = hint.split_once('`').unwrap_or_default().0;
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
            ("0.5", "-0.5", "grasp 0, contact 0: `mu` is -0.5; it must be a number, 0 or more"),
            (
                "0.5",
                "-0.5, \"type\": \"frictionless\"",
                "grasp 0, contact 0: `mu` is -0.5; it must be a number, 0 or more",
            ),
            ("0.5", "0.5, \"mus\": -0.1", "grasp 0, contact 0: `mus` is -0.1; it must be a number, 0 or more"),
            ("}]}", "}], \"refs\": {\"set\": \"W\"}}", "grasp 0: `refs` is {\"set\":\"W\"}; it must be a list of refs"),
            (r#"[0, 0, 1]"#, r#"[0, 1]"#, "grasp 0, contact 0: `p` is [0,1]; it must be a list of 3 numbers"),
            (r#"[0, 0, 1]"#, r#"[0, null, 1]"#, "grasp 0, contact 0: `p[1]` is null; it must be a number"),
            (r#"[0, 0, -1]"#, r#"[0, 0, -2]"#, "grasp 0, contact 0: `n` is [0,0,-2]: the normal is not a unit vector"),
            (r#""p""#, r#""_p""#, "grasp 0, contact 0: `p` is missing; it must be a list of 3 numbers"),
            ("0.5", "-0.5, \"type\": \"hard\"", "grasp 0, contact 0: `mu` is -0.5; it must be a number, 0 or more"),
            (
                "0.5",
                "0.5, \"J\": [[1], [1], [1]]",
                "grasp 0, contact 0: `J` is [[1],[1],[1]]; it must be a list of 4 rows",
            ),
            (
                "0.5",
                "0.5, \"J\": [[1], [1, 2], [1], [0]]",
                "grasp 0, contact 0: `J` is [[1],[1,2],[1],[0]]: the Jacobian",
            ),
            ("0.5", "0.5, \"type\": \"wet\"", "grasp 0, contact 0: `type` is \"wet\"; it must be soft"),
            ("\"contacts\"", "\"id\": \"x\", \"contact\"", "`contact` is not known here; did you mean `contacts`?"),
            ("}]}", "}], \"refs\": [{\"set\": \"V\"}]}", "grasp 0, ref 0: `set` is \"V\"; it must be W or Wa"),
            (
                "}]}",
                "}], \"refs\": [{\"set\": \"W\", \"norm\": \"L1\", \"Q\": {\"type\": \"box\", \"half_widths\": [1]}}]}",
                "grasp 0, ref 0: `Q.half_widths` is [1]: these are not 6 numbers",
            ),
        ] {
            let text = BARE.replacen(from, to, 1);
            assert!(refusal(&text).starts_with(says), "{text}: {}", refusal(&text));
        }
        assert!(refusal("{").contains("line 1"));
        let named = BARE.replacen('{', "{\"id\": \"a\", ", 1);
        assert!(refusal(&format!("[{named}, {BARE}, {named}]")).starts_with("grasp a: `id` is that of grasp number 0"));
        assert!(refusal(&format!("[{BARE}, {}]", named.replace("\"a\"", "0"))).starts_with("grasp 0: `id`"));
    }
}
