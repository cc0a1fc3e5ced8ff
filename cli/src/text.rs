//! Text files: read whole, in UTF-8, a mark at the beginning allowed.

use std::path::Path;

use crate::Trouble;

/// The text of a file; the trouble does not name it.
pub fn read(file: &Path) -> Result<String, Trouble> {
    of(std::fs::read(file).map_err(|e| e.to_string())?)
}

/// The text that these bytes are.
pub fn of(bytes: Vec<u8>) -> Result<String, Trouble> {
    if let [0xff, 0xfe, ..] | [0xfe, 0xff, ..] = bytes.as_slice() {
        return Err("this is UTF-16; it must be UTF-8".into());
    }
    let text = String::from_utf8(bytes).map_err(|e| {
        let good = e.utf8_error().valid_up_to();
        format!("line {}: this is no text in UTF-8 (byte {good} of the file)", line(e.as_bytes(), good))
    })?;
    Ok(text.strip_prefix('\u{feff}').map(str::to_string).unwrap_or(text))
}

/// The line, from 1, of a byte.
pub fn line(bytes: &[u8], at: usize) -> usize {
    bytes.iter().take(at).filter(|&&c| c == b'\n').count() + 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_text() {
        assert_eq!(of(b"\xef\xbb\xbfa\nb".to_vec()).as_deref(), Ok("a\nb"));
        assert_eq!(of("\u{fc}".into()).as_deref(), Ok("\u{fc}"));
        assert!(of(b"\xff\xfe{\0".to_vec()).unwrap_err().contains("UTF-16"));
        assert_eq!(of(b"a\nb\xff".to_vec()).unwrap_err(), "line 2: this is no text in UTF-8 (byte 3 of the file)");
        assert!(read(Path::new("missing.json")).is_err());
    }
}
