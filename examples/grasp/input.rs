//! Grasps from JSON.
//!
//! The file has a list `instances` of grasps; a list of grasps or one grasp alone will do. A grasp has `contacts` and,
//! usually, `id`, `length_unit_m` and `refs`. Without `id`, its number in the list is its id. No two grasps have the same.
//!
//! * A contact has `p`, the unit normal `n` into the object, and may have tangents `o` and `t`, a name `finger`, and the four rows `J` of its
//!   Jacobian (none: passive, a palm). `type` is `soft`, `hard` or `frictionless`; without it, `mu` and `mus` say what it is. A `mus` that is
//!   missing or null is 0.
//! * A reference has `set` (`W`, `Wa`), `norm` (`L1`, `Linf`), `Q`, and the value `d` with `tol`, if it is known.
//! * `Q` has a `type` with its numbers: `ball` (perhaps `radius`), `ellipsoid` `semi_axes`, `box` `half_widths`, `cross_polytope` `half_axes`,
//!   `segment` `wrench`. They are coordinates of R^6, of the rows of `Q.S`, or, where the reference says so by a `space` or where they are not
//!   six, of the columns of its `R`.
//!
//! All numbers are in units in which the torque scale is 1 and moments refer to the origin. What else the file says is not read. An error names
//! grasp, contact and field.

use std::collections::HashMap;

use qdist::Vector;
use qdist::grasp::{Contact, ContactError, Friction, HandContact, Jacobian, Norm};
use serde_json::Value;

use crate::Trouble;
use crate::gauges::{Q, Shape};

/// One grasp of the file.
pub struct Grasp {
    pub id: String,
    /// Metres of one unit of length, where the file says so.
    pub length_unit: Option<f64>,
    /// One name a contact.
    pub names: Vec<String>,
    pub hand: Vec<HandContact<f64>>,
    pub queries: Vec<Reference>,
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

/// A value and where it is.
struct Field<'a> {
    value: &'a Value,
    at: String,
}

impl<'a> Field<'a> {
    fn get(&self, key: &str) -> Field<'a> {
        let value = self.value.get(key).unwrap_or(&Value::Null);
        Field { value, at: format!("{}, {key}", self.at) }
    }

    fn wrong<T>(&self, what: &str) -> Result<T, Trouble> {
        let missing = if self.value.is_null() { " (missing)" } else { "" };
        Err(format!("{}{missing}: {what}", self.at))
    }

    /// `None` where there is nothing.
    fn maybe<T>(self, read: impl FnOnce(&Self) -> Result<T, Trouble>) -> Result<Option<T>, Trouble> {
        if self.value.is_null() { Ok(None) } else { read(&self).map(Some) }
    }

    fn number(&self) -> Result<f64, Trouble> {
        self.value.as_f64().map_or_else(|| self.wrong("is not a number"), Ok)
    }

    fn text(&self) -> Result<&'a str, Trouble> {
        self.value.as_str().map_or_else(|| self.wrong("is not a text"), Ok)
    }

    /// The entries of a list; `what` names one of them.
    fn entries(&self, what: &str) -> Result<Vec<Field<'a>>, Trouble> {
        let Some(list) = self.value.as_array() else { return self.wrong("is not a list") };
        let entry = |(i, value)| Field { value, at: format!("{}, {what} {i}", self.at) };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    fn numbers(&self) -> Result<Vec<f64>, Trouble> {
        self.entries("entry")?.iter().map(Self::number).collect()
    }

    fn vector<const N: usize>(&self) -> Result<Vector<f64, N>, Trouble> {
        let list: Result<[f64; N], _> = self.numbers()?.try_into();
        list.map_or_else(|_| self.wrong(&format!("has not {N} numbers")), |list| Ok(Vector::from(list)))
    }

    fn rows(&self) -> Result<Vec<Vec<f64>>, Trouble> {
        self.entries("row")?.iter().map(Self::numbers).collect()
    }
}

/// The grasps of a file's text.
pub fn read(text: &str) -> Result<Vec<Grasp>, Trouble> {
    let data: Value = serde_json::from_str(text).map_err(|e| e.to_string())?;
    let instances = match &data {
        Value::Object(fields) if fields.contains_key("instances") => &data["instances"],
        Value::Object(fields) if fields.contains_key("contacts") => &Value::Array(vec![data.clone()]),
        Value::Array(_) => &data,
        _ => return Err("instances (missing): is not a list of grasps".into()),
    };
    let Some(list) = instances.as_array() else { return Err("instances: is not a list of grasps".into()) };
    let name = |i: usize, v: &Value| match &v["id"] {
        Value::String(id) => id.clone(),
        Value::Number(id) => id.to_string(),
        _ => i.to_string(),
    };
    let mut seen = HashMap::new();
    let unique = |(i, v)| {
        let id = name(i, v);
        match seen.insert(id.clone(), i) {
            Some(first) => Err(format!("grasp {id}, id: is that of grasp number {first} and of number {i}, from 0")),
            None => grasp(id, v),
        }
    };
    list.iter().enumerate().map(unique).collect()
}

fn grasp(id: String, value: &Value) -> Result<Grasp, Trouble> {
    let top = Field { value, at: format!("grasp {id}") };
    let (mut names, mut hand) = (Vec::new(), Vec::new());
    // Positions in messages as they are counted in the file.
    let contacts = Field { value: &value["contacts"], at: top.at.clone() };
    if !contacts.value.is_array() {
        return top.get("contacts").wrong("is not a list");
    }
    for (i, field) in contacts.entries("contact")?.into_iter().enumerate() {
        names.push(field.get("finger").value.as_str().map_or_else(|| i.to_string(), str::to_string));
        hand.push(hand_contact(&field)?);
    }
    let refs = Field { value: &value["refs"], at: top.at.clone() };
    let queries = match refs.value {
        Value::Null => Vec::new(),
        Value::Array(_) => refs.entries("ref")?.iter().map(reference).collect::<Result<_, _>>()?,
        _ => return top.get("refs").wrong("is not a list"),
    };
    let length_unit = top.get("length_unit_m").maybe(Field::number)?;
    Ok(Grasp { id, length_unit, names, hand, queries })
}

fn hand_contact(field: &Field) -> Result<HandContact<f64>, Trouble> {
    let coefficient = |key: &str| field.get(key).maybe(Field::number);
    let (mu, mus) = (coefficient("mu")?, coefficient("mus")?.unwrap_or(0.0));
    // Also where the model, given or guessed, has no use for them.
    for (key, x) in [("mu", mu.unwrap_or(0.0)), ("mus", mus)] {
        if x < 0.0 {
            return field.get(key).wrong("is negative");
        }
    }
    let kind = match field.get("type").maybe(|kind| kind.text())? {
        Some(kind) => kind,
        None if mus > 0.0 => "soft",
        None if mu.is_some_and(|mu| mu > 0.0) => "hard",
        None => "frictionless",
    };
    let friction = match (kind, mu) {
        ("frictionless", _) => Friction::Frictionless,
        ("soft", Some(mu)) => Friction::Soft { mu, mus },
        ("hard", Some(mu)) => Friction::Hard { mu },
        ("soft" | "hard", None) => return field.get("mu").wrong("is needed for a contact with friction"),
        _ => return field.get("type").wrong("is not soft, hard or frictionless"),
    };
    let words = |error: ContactError| {
        let key = match error {
            ContactError::Position => "p",
            ContactError::Normal => "n",
            ContactError::Tangents => "o, t",
            ContactError::Friction => "mu, mus",
            _ => "J",
        };
        format!("{}, {key}: {error}", field.at)
    };
    let mut contact = Contact::new(field.get("p").vector()?, field.get("n").vector()?, friction).map_err(words)?;
    let tangent = |key: &str| field.get(key).maybe(Field::vector);
    match (tangent("o")?, tangent("t")?) {
        (Some(o), Some(t)) => contact = contact.with_tangents(o, t).map_err(words)?,
        (Some(o), None) => contact = contact.with_tangents(o, contact.normal().cross(&o)).map_err(words)?,
        (None, Some(t)) => contact = contact.with_tangents(t.cross(contact.normal()), t).map_err(words)?,
        (None, None) => {}
    }
    let jacobian = field.get("J").maybe(|j| {
        let rows = j.rows()?;
        let [n, o, t, spin] = rows.as_slice() else { return j.wrong("has not 4 rows") };
        Jacobian::new([n, o, t, spin]).map_err(words)
    })?;
    Ok(HandContact { contact, jacobian })
}

fn reference(field: &Field) -> Result<Reference, Trouble> {
    let set = match field.get("set").text()? {
        "W" => Set::Passive,
        "Wa" => Set::Active,
        _ => return field.get("set").wrong("is not W or Wa"),
    };
    let norm = match field.get("norm").text()? {
        "L1" => Norm::L1,
        "Linf" => Norm::LInf,
        _ => return field.get("norm").wrong("is not L1 or Linf"),
    };
    let d = field.get("d").maybe(Field::number)?;
    let tolerance = field.get("tol").maybe(Field::number)?.unwrap_or(1e-9);
    Ok(Reference { set, norm, q: gauge(field)?, d, tolerance })
}

fn gauge(reference: &Field) -> Result<Q, Trouble> {
    let q = reference.get("Q");
    let shape = match q.get("type").text()? {
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
        read(text).err().unwrap_or_default()
    }

    const BARE: &str = r#"{"contacts": [{"p": [0, 0, 1], "n": [0, 0, -1], "mu": 0.5}]}"#;

    #[test]
    fn little_is_enough() {
        let grasps = read(BARE).unwrap();
        let [grasp] = grasps.as_slice() else { panic!("{}", grasps.len()) };
        assert_eq!((grasp.id.as_str(), grasp.names[0].as_str(), grasp.queries.len()), ("0", "0", 0));
        assert_eq!(grasp.hand[0].contact.friction(), Friction::Hard { mu: 0.5 });
        assert!(grasp.hand[0].jacobian.is_none());
        assert_eq!(read(&format!("[{BARE}, {BARE}]")).unwrap().len(), 2);
        assert_eq!(read("[]").unwrap().len(), 0);
        assert_eq!(read(&format!(r#"{{"instances": [{BARE}]}}"#)).unwrap().len(), 1);
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
            assert_eq!(read(&text).unwrap()[0].hand[0].contact.friction(), friction, "{numbers}");
        }
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
            (r#""p""#, r#""q""#, "grasp 0, contact 0, p (missing): is not a list"),
            ("0.5", "-0.5, \"type\": \"hard\"", "grasp 0, contact 0, mu: is negative"),
            ("0.5", "0.5, \"J\": [[1], [1], [1]]", "grasp 0, contact 0, J: has not 4 rows"),
            ("0.5", "0.5, \"J\": [[1], [1, 2], [1], [0]]", "grasp 0, contact 0, J: the Jacobian"),
            ("0.5", "0.5, \"type\": \"wet\"", "grasp 0, contact 0, type: is not soft"),
            ("\"contacts\"", "\"id\": \"x\", \"contact\"", "instances (missing)"),
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
