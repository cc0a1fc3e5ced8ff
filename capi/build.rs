//! Makes text of text, as `scripts/header.sh` does for the headers: the functions of the dimensions 3 to 6 of those of dimension 2, and the module
//! `f32` of `src/f64`, by the rules of `f32.sed`.
//!
//! With `QDIST_ONLY`, a list of functions, the library has the scalars' functions that are in it and no others (`./x lib-arm ONLY=...`): what is not exported
//! is not compiled, so that a library for one program builds in seconds.

use std::path::Path;
use std::{env, fs, io};

/// `s/from/to/`, for the first one in a line, or `s/from/to/g`, for all.
struct Rule<'a> {
    from: &'a str,
    to: &'a str,
    everywhere: bool,
}

impl<'a> Rule<'a> {
    fn parse(line: &'a str) -> Option<Self> {
        let mut parts = line.strip_prefix("s/")?.split('/');
        let (from, to, flags) = (parts.next()?, parts.next()?, parts.next()?);
        Some(Self { from, to, everywhere: flags == "g" })
    }

    fn apply(&self, line: &str) -> String {
        if self.everywhere { line.replace(self.from, self.to) } else { line.replacen(self.from, self.to, 1) }
    }
}

fn for_f32(text: &str, rules: &[Rule]) -> String {
    let scaled = |line: &str| rules.iter().fold(line.to_string(), |line, rule| rule.apply(&line)) + "\n";
    text.lines().map(scaled).collect()
}

/// The text of a module file, with the text of its submodules in it.
fn inlined(file: &Path) -> io::Result<String> {
    println!("cargo::rerun-if-changed={}", file.display());
    let mut text = String::new();
    for line in fs::read_to_string(file)?.lines() {
        let item = line.strip_prefix("pub ").unwrap_or(line);
        let child = item.strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';'));
        if let Some(name) = child {
            let folder = file.parent().unwrap_or(file);
            let alone = folder.join(name).with_extension("rs");
            let file = if alone.exists() { alone } else { folder.join(name).join("mod.rs") };
            text += &format!("pub mod {name} {{\n{}}}\n", inlined(&file)?);
        } else {
            text += line;
            text.push('\n');
        }
    }
    Ok(text)
}

/// Each exported function that this comment follows is one of dimension 2, and stands for those of the others.
const LIKEWISE: &str = "// Likewise in dimensions 3 to 6.";

fn other_dimensions(text: &str) -> String {
    let functions: Vec<_> = text
        .match_indices(LIKEWISE)
        .filter_map(|(end, _)| text.get(text.get(..end)?.rfind("#[unsafe(no_mangle)]")?..end))
        .collect();
    let of = |f: &&str, n| f.replace("2_f64(", &format!("{n}_f64(")).replace("::<2>", &format!("::<{n}>"));
    (3..=6).flat_map(|n| functions.iter().map(move |f| of(f, n))).collect()
}

/// The functions to be exported: names without `qdist_`, where `*` stands for any letters.
struct Choice(Option<Vec<String>>);

impl Choice {
    fn from_environment() -> Self {
        println!("cargo::rerun-if-env-changed=QDIST_ONLY");
        println!("cargo::rustc-check-cfg=cfg(chosen)");
        let list = env::var("QDIST_ONLY").unwrap_or_default();
        if list.trim().is_empty() {
            return Self(None);
        }
        println!("cargo::rustc-cfg=chosen");
        Self(Some(list.split_whitespace().map(|name| name.trim_start_matches("qdist_").to_string()).collect()))
    }

    fn has(&self, function: &str) -> bool {
        self.0.as_ref().is_none_or(|list| list.iter().any(|pattern| matches(pattern, function)))
    }

    /// The text, in which the functions that were not chosen are no longer exported.
    fn of(&self, text: &str) -> String {
        const EXPORTED: &str = "#[unsafe(no_mangle)]\n";
        let mut parts = text.split(EXPORTED);
        let mut chosen = parts.next().unwrap_or_default().to_string();
        for part in parts {
            let name = part.split_once("fn qdist_").and_then(|(_, rest)| rest.split_once('('));
            if name.is_none_or(|(name, _)| self.has(name)) {
                chosen += EXPORTED;
            }
            chosen += part;
        }
        chosen
    }
}

/// Is a name of this pattern?
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, tail)) => name
            .strip_prefix(head)
            .is_some_and(|rest| (0..=rest.len()).any(|i| rest.get(i..).is_some_and(|rest| matches(tail, rest)))),
    }
}

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=f32.sed");
    let choice = Choice::from_environment();
    let script = fs::read_to_string("f32.sed")?;
    let rules: Vec<Rule> = script.lines().filter_map(Rule::parse).collect();
    let text = inlined(Path::new("src/f64/mod.rs"))?;
    let others = other_dimensions(&text);
    let out = env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?;
    let write = |name: &str, text: &str| fs::write(Path::new(&out).join(name), choice.of(text));
    write("f64.rs", &format!("pub mod f64 {{\n{text}}}\n"))?;
    write("f32.rs", &format!("pub mod f32 {{\n{}}}\n", for_f32(&text, &rules)))?;
    write("dimensions_f32.rs", &for_f32(&others, &rules))?;
    write("dimensions_f64.rs", &others)
}
