//! A value of a JSON file and where it is: every message names grasp, contact and field.
//!
//! Nothing that a file says is passed over in silence. An object may have the fields that are read and, beside them, notes for people, each by its
//! name, and any that begins with an underscore. Every other field is an error that offers the nearest known name.

use qdist::Vector;
use serde_json::Value;

use crate::Trouble;

/// A value and where it is.
pub struct Field<'a> {
    pub value: &'a Value,
    pub at: String,
}

impl<'a> Field<'a> {
    pub fn get(&self, key: &str) -> Field<'a> {
        let value = self.value.get(key).unwrap_or(&Value::Null);
        Field { value, at: format!("{}, {key}", self.at) }
    }

    /// The same at the place of its object: for lists, whose entries are named by their own word.
    pub fn list(&self, key: &str) -> Field<'a> {
        Field { at: self.at.clone(), ..self.get(key) }
    }

    pub fn wrong<T>(&self, what: &str) -> Result<T, Trouble> {
        let missing = if self.value.is_null() { " (missing)" } else { "" };
        Err(format!("{}{missing}: {what}", self.at))
    }

    /// An object with no other fields than these; `notes` are not read.
    pub fn only(&self, fields: &[&str], notes: &[&str]) -> Result<(), Trouble> {
        let Some(object) = self.value.as_object() else { return self.wrong("is not an object") };
        let known = |key: &str| key.starts_with('_') || fields.contains(&key) || notes.contains(&key);
        let Some(key) = object.keys().find(|key| !known(key)) else { return Ok(()) };
        let nearest = fields.iter().map(|name| (distance(key, name), name)).min();
        let hint = match nearest {
            Some((off, name)) if off <= name.len().max(key.len()).div_ceil(2) => format!("; did you mean {name}?"),
            _ => String::new(),
        };
        Err(format!("{}, {key}: is not known here{hint} (known: {})", self.at, fields.join(", ")))
    }

    /// `None` where there is nothing.
    pub fn maybe<T>(self, read: impl FnOnce(&Self) -> Result<T, Trouble>) -> Result<Option<T>, Trouble> {
        if self.value.is_null() { Ok(None) } else { read(&self).map(Some) }
    }

    pub fn number(&self) -> Result<f64, Trouble> {
        self.value.as_f64().map_or_else(|| self.wrong("is not a number"), Ok)
    }

    pub fn not_negative(&self) -> Result<f64, Trouble> {
        let x = self.number()?;
        if x >= 0.0 { Ok(x) } else { self.wrong("is negative") }
    }

    pub fn positive(&self) -> Result<f64, Trouble> {
        let x = self.number()?;
        if x > 0.0 { Ok(x) } else { self.wrong("is not above 0") }
    }

    pub fn text(&self) -> Result<&'a str, Trouble> {
        self.value.as_str().map_or_else(|| self.wrong("is not a text"), Ok)
    }

    pub fn flag(&self) -> Result<bool, Trouble> {
        self.value.as_bool().map_or_else(|| self.wrong("is not true or false"), Ok)
    }

    /// A text, or a number as one.
    pub fn name(&self) -> Result<String, Trouble> {
        match self.value {
            Value::String(name) => Ok(name.clone()),
            Value::Number(name) => Ok(name.to_string()),
            _ => self.wrong("is neither a text nor a number"),
        }
    }

    /// The entries of a list; `what` names one of them.
    pub fn entries(&self, what: &str) -> Result<Vec<Field<'a>>, Trouble> {
        let Some(list) = self.value.as_array() else { return self.wrong("is not a list") };
        let entry = |(i, value)| Field { value, at: format!("{}, {what} {i}", self.at) };
        Ok(list.iter().enumerate().map(entry).collect())
    }

    pub fn numbers(&self) -> Result<Vec<f64>, Trouble> {
        self.entries("entry")?.iter().map(Self::number).collect()
    }

    pub fn vector<const N: usize>(&self) -> Result<Vector<f64, N>, Trouble> {
        let list: Result<[f64; N], _> = self.numbers()?.try_into();
        list.map_or_else(|_| self.wrong(&format!("has not {N} numbers")), |list| Ok(Vector::from(list)))
    }

    pub fn rows(&self) -> Result<Vec<Vec<f64>>, Trouble> {
        self.entries("row")?.iter().map(Self::numbers).collect()
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
        let field = Field { value: &value, at: "here".into() };
        let told = field.only(&["mu", "force_cap"], &["note"]).unwrap_err();
        assert_eq!(told, "here, forcecap: is not known here; did you mean force_cap? (known: mu, force_cap)");
        assert!(!field.only(&["mu", "q"], &["note"]).unwrap_err().contains("did you mean"));
        assert!(field.only(&["mu", "forcecap"], &["note"]).is_ok());
        assert_eq!(field.get("mu").only(&[], &[]).unwrap_err(), "here, mu: is not an object");
    }
}
