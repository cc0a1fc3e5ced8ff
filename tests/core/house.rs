//! Arrows point down: no file of `src/` imports from a storey above its own, and no folder has a circle. The storeys are those that the essay in
//! `lib.rs` draws. Nothing is too long to be read: no file, no function. And `unsafe` of the C layer stays where it belongs.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The arrows that point up, each for a reason.
const UP: &[(&str, &str)] = &[
    // A shape names the way in which depth is found with it: so a program that has no such shape does not contain it.
    ("support", "solver::depth::route::Route"),
    ("support", "solver::depth::half_space"),
];

/// The storeys, from the top, as `lib.rs` draws them.
fn storeys() -> Vec<String> {
    let essay = fs::read_to_string("src/lib.rs").unwrap();
    let (_, house) = essay.split_once("//! # The house").unwrap();
    let (_, drawing) = house.split_once("//! ```text\n").unwrap();
    let lines = drawing.lines().take_while(|line| *line != "//! ```");
    lines.map(|line| line.trim_start_matches("//! ").split_whitespace().next().unwrap().to_string()).collect()
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.extend(files(&entry));
        } else if entry.extension().is_some_and(|extension| extension == "rs") {
            found.push(entry);
        }
    }
    found.sort();
    found
}

/// The path of a module: ["plan", "rays"] for src/plan/rays.rs, ["plan"] for src/plan/mod.rs.
fn module(file: &Path) -> Vec<String> {
    let path = file.strip_prefix("src").unwrap().with_extension("");
    let mut parts: Vec<String> = path.iter().map(|part| part.to_str().unwrap().to_string()).collect();
    if parts.last().is_some_and(|last| last == "mod") {
        parts.pop();
    }
    parts
}

/// The paths that a file names outside of comments and tests, from the root: "crate::a::b", and "super::c" with the file's own place before it.
fn arrows(file: &Path) -> BTreeSet<String> {
    let text = fs::read_to_string(file).unwrap();
    let text = text.split("#[cfg(test)]\nmod ").next().unwrap();
    let code: Vec<&str> = text.lines().map(|line| line.split("//").next().unwrap()).collect();
    let code = code.join("\n");
    let own = module(file);
    let mut found = BTreeSet::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            if code[..at].ends_with(|c: char| c == ':' || c == '_' || c == '$' || c.is_alphanumeric()) {
                continue;
            }
            let mut rest = &code[at..];
            let mut place = Vec::new();
            if let Some(next) = rest.strip_prefix("crate::") {
                rest = next;
            } else {
                place = own.clone();
                while let Some(next) = rest.strip_prefix("super::") {
                    rest = next;
                    place.pop();
                }
            }
            let tail: String = rest.chars().take_while(|&c| c == ':' || c == '_' || c.is_alphanumeric()).collect();
            if let Some(list) = rest.strip_prefix(&tail[..]).and_then(|rest| rest.strip_prefix('{')) {
                for item in list.split('}').next().unwrap().split(',').filter(|item| !item.trim().is_empty()) {
                    found.insert([&place[..], &[tail.clone() + item.trim()]].concat().join("::"));
                }
            } else {
                found.insert([&place[..], &[tail]].concat().join("::"));
            }
        }
    }
    found
}

#[test]
fn arrows_point_down() {
    let storeys = storeys();
    assert!(storeys.len() > 8, "{storeys:?}");
    let floor = |name: &str| storeys.iter().position(|storey| storey == name);
    let mut used: BTreeSet<&(&str, &str)> = BTreeSet::new();
    for file in files(Path::new("src")) {
        let own = module(&file);
        if own[0] == "lib" {
            continue;
        }
        let from = floor(&own[0]).unwrap_or_else(|| panic!("{}: no storey of the essay", file.display()));
        for arrow in arrows(&file) {
            let storey = arrow.split("::").next().unwrap();
            let to = floor(storey).unwrap_or_else(|| panic!("{}: {arrow} is no path through a storey", file.display()));
            let known = UP.iter().find(|(low, high)| *low == own[0] && arrow.starts_with(high));
            used.extend(known);
            assert!(to >= from || known.is_some(), "{}: {arrow} is above", file.display());
        }
    }
    assert_eq!(used.len(), UP.len(), "an exception is no longer needed");
}

/// Neighbours in a folder: who imports whom, and whether that comes back.
#[test]
fn no_folder_has_a_circle() {
    let mut edges: BTreeMap<Vec<String>, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
    let all: BTreeSet<Vec<String>> = files(Path::new("src")).iter().map(|file| module(file)).collect();
    for file in files(Path::new("src")) {
        let own = module(&file);
        for arrow in arrows(&file) {
            let to: Vec<String> = arrow.split("::").map(str::to_string).collect();
            // The first place where the two paths part.
            let depth = own.iter().zip(&to).take_while(|(a, b)| a == b).count();
            let (Some(a), Some(b)) = (own.get(depth), to.get(depth)) else { continue };
            if depth > 0 && all.iter().any(|module| module.starts_with(&to[..=depth])) {
                edges.entry(own[..depth].to_vec()).or_default().entry(a.clone()).or_default().insert(b.clone());
            }
        }
    }
    let mut circles = Vec::new();
    for (folder, neighbours) in &edges {
        for start in neighbours.keys() {
            let (mut seen, mut next) = (BTreeSet::new(), vec![start]);
            while let Some(one) = next.pop() {
                for other in neighbours.get(one).into_iter().flatten() {
                    if other == start {
                        circles.push(format!("{}: {start}, by {one}", folder.join("/")));
                    } else if seen.insert(other) {
                        next.push(other);
                    }
                }
            }
        }
    }
    assert!(circles.is_empty(), "{circles:#?}");
}

/// What a public module holds is found there and nowhere else.
#[test]
fn everything_has_one_path() {
    for file in files(Path::new("src")) {
        let lines = code(&file);
        for module in lines.iter().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')) {
            let prefix = format!("pub use {module}::");
            let again = lines.iter().find(|line| line.strip_prefix(&prefix).is_some_and(|item| !item.contains("::")));
            assert!(again.is_none(), "{}: {again:?} of a public module", file.display());
        }
    }
}

/// Lines of a file without its tests, and of a function.
const LONGEST_FILE: usize = 400;
const LONGEST_FUNCTION: usize = 60;

/// The lines of a file without its tests.
fn code(file: &Path) -> Vec<String> {
    let text = fs::read_to_string(file).unwrap();
    text.split("#[cfg(test)]\nmod ").next().unwrap().lines().map(str::to_string).collect()
}

/// The name of the function that begins in a line, and what the line begins with.
fn function(line: &str) -> Option<(&str, &str)> {
    let (before, after) = line.split_once("fn ")?;
    let rest = before.trim_start();
    let words = ["pub", "pub(crate)", "pub(super)", "const", "unsafe", "extern", "\"C\""];
    let plain =
        rest.split_whitespace().all(|word| words.contains(&word) || word.starts_with("pub(in") || word.ends_with(')'));
    let name = after.split(|c: char| c != '_' && !c.is_alphanumeric()).next()?;
    (plain && !name.is_empty()).then_some((name, &before[..before.len() - rest.len()]))
}

/// The functions of a file with their numbers of lines, from `fn` to the brace that closes them; functions inside others are lines of those as well.
fn functions(lines: &[String]) -> Vec<(String, usize)> {
    let mut found = Vec::new();
    for (start, line) in lines.iter().enumerate() {
        let Some((name, indent)) = function(line) else { continue };
        let closing = format!("{indent}}}");
        let declared =
            |line: &String| line.ends_with(';') && (*line == lines[start] || line.starts_with(&format!("{indent})")));
        let end = lines[start..].iter().position(|line| declared(line) || *line == closing);
        found.push((name.to_string(), end.map_or(1, |end| end + 1)));
    }
    found
}

#[test]
fn nothing_is_too_long_to_be_read() {
    let mut long = BTreeSet::new();
    for folder in ["src", "capi/src"] {
        for file in files(Path::new(folder)) {
            let lines = code(&file);
            if lines.len() > LONGEST_FILE {
                long.insert(file.display().to_string());
            }
            let functions = functions(&lines).into_iter().filter(|(_, length)| *length > LONGEST_FUNCTION);
            long.extend(functions.map(|(name, _)| format!("{} {name}", file.display())));
        }
    }
    assert!(long.is_empty(), "longer than {LONGEST_FILE} lines, or functions than {LONGEST_FUNCTION}: {long:#?}");
}

/// The files of the C layer where memory is touched, and where the caller's functions are called.
const UNSAFE: [&str; 8] = [
    "pointer.rs",
    "layout.rs",
    "callback.rs",
    "handle.rs",
    "panic.rs",
    "f64/answers.rs",
    "f64/unit_sets.rs",
    "mesh/allocator.rs",
];
/// How often elsewhere in it, all files together: lists of the caller seen as lists of the library, `user` behind a function of the library, handles
/// that are boxes, the callbacks of meshes.
const ELSEWHERE: usize = 31;

/// (The compiler's lint `unsafe_code` also refuses names for C, which every function of a header has.)
#[test]
fn unsafe_of_the_c_layer_is_where_memory_is_touched_and_says_why() {
    let mut elsewhere = 0;
    let root = Path::new("capi/src");
    for file in files(root) {
        let (path, lines) = (file.strip_prefix(root).unwrap().display().to_string(), code(&file));
        for (index, line) in lines.iter().enumerate() {
            let bare = line.split("//").next().unwrap().replace("#[unsafe(no_mangle)]", "");
            let is_type = line.contains("unsafe extern \"C\" fn(") || line.contains("pub type ");
            if !bare.contains("unsafe") || is_type {
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
