//! A field that an object has twice: JSON readers keep the last one, in silence.

use std::collections::HashSet;

/// The first field of an object that has a field of this name already, and its line, in a text that is valid JSON.
pub fn repeated(text: &str) -> Option<(&str, usize)> {
    // The fields of all objects and lists that are open; a list has none.
    let mut open: Vec<HashSet<&str>> = Vec::new();
    let mut rest = text;
    while let Some(begin) = rest.find(['{', '}', '[', ']', '"']) {
        let (mark, after) = (rest.as_bytes()[begin], &rest[begin + 1..]);
        rest = after;
        match mark {
            b'{' | b'[' => open.push(HashSet::new()),
            b'}' | b']' => drop(open.pop()),
            _ => {
                let end = end_of_string(after);
                let key = &after[..end];
                rest = after.get(end + 1..).unwrap_or("");
                let is_key = rest.trim_start().starts_with(':');
                if is_key && open.last_mut().is_some_and(|fields| !fields.insert(key)) {
                    let line = text[..text.len() - after.len()].matches('\n').count() + 1;
                    return Some((key, line));
                }
            }
        }
    }
    None
}

/// Where the string ends whose quotation mark was just read.
fn end_of_string(text: &str) -> usize {
    let mut escaped = false;
    let ends = |c: u8| {
        let ends = c == b'"' && !escaped;
        escaped = c == b'\\' && !escaped;
        ends
    };
    text.bytes().position(ends).unwrap_or(text.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_are_there_twice() {
        for (text, found) in [
            ("{}", None),
            (r#"{"a": {"a": 1}, "b": [{"a": 1}, {"a": 2}]}"#, None),
            ("{\"a\": 1,\n\"b\": 2,\n \"a\": 3}", Some(("a", 3))),
            (r#"[{"x": [1, "x"], "y": "x", "x": 2}]"#, Some(("x", 1))),
            (r#"{"a\"b": 1, "a": "{\"a\": 1", "c": 1, "c" : 2}"#, Some(("c", 1))),
            (r#"{"a\\": 1, "b": 2, "b": 3}"#, Some(("b", 1))),
        ] {
            assert_eq!(repeated(text), found, "{text}");
        }
    }
}
