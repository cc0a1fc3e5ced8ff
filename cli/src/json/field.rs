//! A value of a JSON file and where it is.
//!
//! Nothing that a file says is passed over in silence. An object may have the fields that are read and, beside them, notes for people, each by its
//! name, and any that begins with an underscore. Every other field is an error that offers the nearest known name.
//!
//! A message says whose field it is (grasp, contact; query), which, what was found there, and what may be there:
//! ``grasp 0, contact 1: `p` is "x"; it must be a list of 3 numbers``. Entries of a list of numbers are written as they are in most languages, `p[1]`
//! is the second. (Who reads the file puts its name in front.)

use qdist::Vector;
use serde_json::Value;

use crate::Trouble;

/// The fields of an object.
pub struct Known {
    /// Those that are read.
    pub fields: &'static [&'static str],
    /// Those that are for people.
    pub notes: &'static [&'static str],
}

/// A value, whose it is, and the name of its field there; a thing by itself (a grasp, a contact) has no name.
pub struct Field<'a> {
    pub value: &'a Value,
    owner: String,
    name: Option<String>,
}

/// The value of a field that is not there. (What is there may be null, too.)
static MISSING: Value = Value::Null;

/// What is quoted of a value at most, in letters.
const QUOTED: usize = 60;

impl<'a> Field<'a> {
    /// A thing by itself; the whole file has no name.
    pub fn of(value: &'a Value, owner: impl Into<String>) -> Field<'a> {
        Field { value, owner: owner.into(), name: None }
    }

    pub fn get(&self, key: &str) -> Field<'a> {
        let value = self.value.get(key).unwrap_or(&MISSING);
        let name = self.name.as_ref().map_or(key.to_string(), |name| format!("{name}.{key}"));
        Field { value, owner: self.owner.clone(), name: Some(name) }
    }

    /// Is nothing there, or null, which says as much?
    pub fn is_missing(&self) -> bool {
        self.value.is_null()
    }

    /// Owner and field, as messages begin.
    fn place(&self) -> String {
        match (self.owner.as_str(), &self.name) {
            ("", None) => "the file".into(),
            (owner, None) => owner.into(),
            ("", Some(name)) => format!("`{name}`"),
            (owner, Some(name)) => format!("{owner}: `{name}`"),
        }
    }

    /// The value, or its beginning.
    fn found(&self) -> String {
        if std::ptr::eq(self.value, &MISSING) {
            return "missing".into();
        }
        let text = self.value.to_string();
        match text.char_indices().nth(QUOTED) {
            Some((end, _)) => format!("{}...", &text[..end]),
            None => text,
        }
    }

    /// What may be there is something else.
    pub fn must<T>(&self, be: &str) -> Result<T, Trouble> {
        Err(format!("{} is {}; it must be {be}", self.place(), self.found()))
    }

    /// What is there is not right, for this reason.
    pub fn wrong<T>(&self, why: &str) -> Result<T, Trouble> {
        Err(format!("{} is {}: {why}", self.place(), self.found()))
    }

    /// An object with no other fields than these.
    pub fn only(&self, known: &Known) -> Result<(), Trouble> {
        let Some(object) = self.value.as_object() else { return self.must("an object") };
        let Known { fields, notes } = known;
        let told = |key: &str| key.starts_with('_') || fields.contains(&key) || notes.contains(&key);
        let Some(key) = object.keys().find(|key| !told(key)) else { return Ok(()) };
        let nearest = fields.iter().map(|name| (distance(key, name), name)).min();
        let hint = match nearest {
            Some((off, name)) if off <= name.len().max(key.len()).div_ceil(2) => format!("; did you mean `{name}`?"),
            _ => String::new(),
        };
        Err(format!("{} is not known here{hint} (known: {})", self.get(key).place(), fields.join(", ")))
    }

    /// `None` where there is nothing.
    pub fn maybe<T>(self, read: impl FnOnce(&Self) -> Result<T, Trouble>) -> Result<Option<T>, Trouble> {
        if self.is_missing() { Ok(None) } else { read(&self).map(Some) }
    }

    pub fn number(&self) -> Result<f64, Trouble> {
        self.value.as_f64().map_or_else(|| self.must("a number"), Ok)
    }

    pub fn not_negative(&self) -> Result<f64, Trouble> {
        self.value.as_f64().filter(|x| *x >= 0.0).map_or_else(|| self.must("a number, 0 or more"), Ok)
    }

    pub fn positive(&self) -> Result<f64, Trouble> {
        self.value.as_f64().filter(|x| *x > 0.0).map_or_else(|| self.must("a number above 0"), Ok)
    }

    pub fn text(&self) -> Result<&'a str, Trouble> {
        self.value.as_str().map_or_else(|| self.must("a text"), Ok)
    }

    pub fn flag(&self) -> Result<bool, Trouble> {
        self.value.as_bool().map_or_else(|| self.must("true or false"), Ok)
    }

    /// A text, or a number as one.
    pub fn name(&self) -> Result<String, Trouble> {
        match self.value {
            Value::String(name) => Ok(name.clone()),
            Value::Number(name) => Ok(name.to_string()),
            _ => self.must("a text or a number"),
        }
    }

    /// The things of a list by themselves, `contact 0` for one; `of` says what the list holds.
    pub fn things(&self, thing: &str, of: &str) -> Result<Vec<Field<'a>>, Trouble> {
        let Some(list) = self.value.as_array() else { return self.must(of) };
        let owner =
            |i| if self.owner.is_empty() { format!("{thing} {i}") } else { format!("{}, {thing} {i}", self.owner) };
        Ok(list.iter().enumerate().map(|(i, value)| Field::of(value, owner(i))).collect())
    }

    /// The entries of a list; `of` says what it holds.
    pub fn entries(&self, of: &str) -> Result<Vec<Field<'a>>, Trouble> {
        let Some(list) = self.value.as_array() else { return self.must(of) };
        let name = self.name.as_deref().unwrap_or_default();
        let entry = |(i, value)| Field { value, owner: self.owner.clone(), name: Some(format!("{name}[{i}]")) };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    pub fn numbers(&self) -> Result<Vec<f64>, Trouble> {
        self.entries("a list of numbers")?.iter().map(Self::number).collect()
    }

    pub fn vector<const N: usize>(&self) -> Result<Vector<f64, N>, Trouble> {
        let of = format!("a list of {N} numbers");
        let list = self.entries(&of)?;
        if list.len() != N {
            return self.must(&of);
        }
        let numbers: Vec<f64> = list.iter().map(Self::number).collect::<Result<_, _>>()?;
        Ok(Vector::from_fn(|i, _| numbers[i]))
    }

    pub fn rows(&self) -> Result<Vec<Vec<f64>>, Trouble> {
        self.entries("a list of rows")?.iter().map(Self::numbers).collect()
    }
}

/// How many letters must be added, left out or replaced to make one word the other; capitals do not count.
fn distance(a: &str, b: &str) -> usize {
    let (a, b) = (a.to_lowercase(), b.to_lowercase());
    let mut row: Vec<usize> = (0..=b.chars().count()).collect();
    for (i, x) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, y) in b.chars().enumerate() {
            let replaced = diagonal + usize::from(x != y);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[row.len() - 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_of_words() {
        for (a, b, d) in [("mu", "Mu", 0), ("mu", "mus", 1), ("", "abc", 3), ("kitten", "sitting", 3), ("L", "l", 0)] {
            assert_eq!((distance(a, b), distance(b, a)), (d, d), "{a} {b}");
        }
    }

    #[test]
    fn unknown_fields_are_told_with_the_nearest() {
        let value = serde_json::json!({"mu": 1, "_mine": 2, "forcecap": 3, "note": 4});
        let field = Field::of(&value, "here");
        let known = |fields| Known { fields, notes: &["note"] };
        let told = field.only(&known(&["mu", "force_cap"])).unwrap_err();
        assert_eq!(told, "here: `forcecap` is not known here; did you mean `force_cap`? (known: mu, force_cap)");
        assert!(!field.only(&known(&["mu", "q"])).unwrap_err().contains("did you mean"));
        assert!(field.only(&known(&["mu", "forcecap"])).is_ok());
        assert_eq!(field.get("mu").only(&known(&[])).unwrap_err(), "here: `mu` is 1; it must be an object");
    }

    /// Whose field, which, what was found, what may be there.
    #[test]
    fn messages_are_sentences() {
        let value = serde_json::json!({"p": [0, "x", 1], "q": {"kind": "bal"}, "long": vec!["\u{fc}"; 100]});
        let field = Field::of(&value, "grasp 0");
        let told = field.get("p").vector::<3>().unwrap_err();
        assert_eq!(told, "grasp 0: `p[1]` is \"x\"; it must be a number");
        let told = field.get("p").vector::<2>().unwrap_err();
        assert_eq!(told, "grasp 0: `p` is [0,\"x\",1]; it must be a list of 2 numbers");
        let told = field.get("n").vector::<3>().unwrap_err();
        assert_eq!(told, "grasp 0: `n` is missing; it must be a list of 3 numbers");
        let nothing = serde_json::json!({"t": [0, null], "n": null});
        let told = |key: &str| Field::of(&nothing, "").get(key).vector::<2>().unwrap_err();
        assert_eq!(told("t"), "`t[1]` is null; it must be a number");
        assert_eq!(told("n"), "`n` is null; it must be a list of 2 numbers");
        let told = field.get("q").get("kind").must::<()>("ball").unwrap_err();
        assert_eq!(told, "grasp 0: `q.kind` is \"bal\"; it must be ball");
        let told = field.get("long").number().unwrap_err();
        assert!(told.ends_with("...; it must be a number") && told.chars().count() < 120, "{told}");
        let list = field.get("p").things("contact", "a list").unwrap();
        assert_eq!(
            list[1].only(&Known { fields: &[], notes: &[] }).unwrap_err(),
            "grasp 0, contact 1 is \"x\"; it must be an object"
        );
        assert_eq!(Field::of(&value, "").get("a").text().unwrap_err(), "`a` is missing; it must be a text");
    }
}
