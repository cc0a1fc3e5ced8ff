//! What JSON files have in common, of grasps and of queries of meshes: the text, and the fields of its objects, of which none is passed over.

mod field;
mod keys;

use serde_json::Value;

use crate::Trouble;
pub use field::{Field, Known};

/// The value of a text; no object in it has a field twice.
pub fn parse(text: &str) -> Result<Value, Trouble> {
    let value = serde_json::from_str(text).map_err(|e| format!("this is no JSON: {e}"))?;
    match keys::repeated(text) {
        Some((key, line)) => Err(format!("line {line}: `{key}` is there twice in one object")),
        None => Ok(value),
    }
}
