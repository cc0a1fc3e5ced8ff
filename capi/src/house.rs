//! What the files of this crate keep: where `unsafe` may stand, and that each says why it is right. (How long files and functions may be is looked at
//! with those of the library, in `tests/core/house.rs`.)

use std::fs;
use std::path::{Path, PathBuf};

/// Where memory is touched, and where the caller's functions are called.
const UNSAFE: [&str; 7] =
    ["pointer.rs", "layout.rs", "callback.rs", "handle.rs", "panic.rs", "f64/answers.rs", "mesh/allocator.rs"];
/// How often elsewhere, all files together: lists of the caller seen as lists of the library, `user` behind a function of the library, handles that
/// are boxes, the callbacks of meshes.
const ELSEWHERE: usize = 36;

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.extend(files(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
    found
}

/// Path, and lines without tests.
fn sources() -> Vec<(String, Vec<String>)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let read = |file: PathBuf| {
        let text = fs::read_to_string(&file).unwrap();
        let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
        (file.strip_prefix(&root).unwrap().display().to_string(), text.lines().map(str::to_string).collect())
    };
    files(&root).into_iter().map(read).filter(|(path, _)| path != "house.rs").collect()
}

/// Code of a line, without comments and without the attribute that gives a function its name in C.
fn code(line: &str) -> String {
    line.split("//").next().unwrap().replace("#[unsafe(no_mangle)]", "")
}

#[test]
fn unsafe_is_where_memory_is_touched_and_says_why() {
    let mut elsewhere = 0;
    for (path, lines) in sources() {
        for (index, line) in lines.iter().enumerate() {
            let is_type = line.contains("unsafe extern \"C\" fn(") || line.contains("pub type ");
            if !code(line).contains("unsafe") || is_type {
                continue;
            }
            elsewhere += usize::from(!UNSAFE.contains(&path.as_str()));
            if line.contains("unsafe {") || line.contains("unsafe impl") {
                let before = &lines[index.saturating_sub(6)..=index];
                assert!(before.iter().any(|line| line.contains("SAFETY:")), "{path}:{}: {line}", index + 1);
            }
        }
    }
    assert!(elsewhere <= ELSEWHERE, "{elsewhere} times outside of {UNSAFE:?}");
}
