//! Golden data: what every machine answers, to the last bit, and with how much work. A file of `tests/data/golden` has a line a group of queries,
//! and a test writes its groups down anew and compares. A change that is meant to change them renews them: `GOLDEN=write cargo test ... golden`.

use qdist::{Answer, Depth, Real};
use std::path::Path;

const HEAD: &str = "group,scalar,answers,iterations,support_calls,vertices,facets,bits";

/// One group: how many answers, the sums of their counts, and a hash of all bits of brackets and what proves them.
pub struct Group {
    name: String,
    answers: usize,
    counts: [u64; 4],
    bits: u64,
}

impl Group {
    /// The answers of one scalar.
    pub fn of<T: Real>(name: &str) -> Self {
        let scalar = if size_of::<T>() == 4 { "f32" } else { "f64" };
        Group { name: format!("{name},{scalar}"), answers: 0, counts: [0; 4], bits: 0xcbf2_9ce4_8422_2325 }
    }

    pub fn depth<T: Real>(&mut self, depth: &Depth<T>) {
        self.count([depth.iterations, depth.support_calls], [depth.vertices, depth.facets]);
        let ends = [depth.lower, depth.upper];
        self.hash(ends.iter().chain(&depth.normal).chain(&depth.point_a).chain(&depth.point_b));
    }

    pub fn answer<T: Real, const N: usize>(&mut self, answer: &Answer<T, N>) {
        self.count([answer.iterations, answer.support_calls], [answer.vertices, answer.facets]);
        let ends = [answer.lower, answer.upper];
        self.hash(ends.iter().chain(&answer.direction).chain(&answer.support));
    }

    fn count(&mut self, steps: [u32; 2], memory: [usize; 2]) {
        self.answers += 1;
        let all = steps.map(u64::from).into_iter().chain(memory.map(|n| n as u64));
        self.counts.iter_mut().zip(all).for_each(|(sum, n)| *sum += n);
    }

    /// Fowler, Noll and Vo's hash (FNV-1a) of the numbers as `f64`, which tells every `f32`.
    fn hash<'a, T: Real>(&mut self, numbers: impl Iterator<Item = &'a T>) {
        // (Which NaN it is depends on the machine.)
        let bits = |x: &T| if x.to_f64().is_nan() { u64::MAX } else { x.to_f64().to_bits() };
        for byte in numbers.flat_map(|x| bits(x).to_le_bytes()) {
            self.bits = (self.bits ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    fn line(&self) -> String {
        let [iterations, calls, vertices, facets] = self.counts;
        format!("{},{},{iterations},{calls},{vertices},{facets},{:016x}", self.name, self.answers, self.bits)
    }
}

/// Compares with the file, to the last bit, or writes it.
pub fn compare(file: &str, groups: &[Group]) {
    let lines: Vec<_> = std::iter::once(HEAD.to_string()).chain(groups.iter().map(Group::line)).collect();
    compare_with(file, &lines, |old, new| old == new);
}

/// Compares line by line with the file, or writes it.
pub fn compare_with(file: &str, now: &[String], same: impl Fn(&str, &str) -> bool) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/golden").join(file);
    if std::env::var_os("GOLDEN").is_some_and(|word| word == "write") {
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, now.join("\n") + "\n").unwrap();
    }
    let golden = std::fs::read_to_string(&path).unwrap();
    let differ: Vec<_> = golden.lines().zip(now).filter(|(old, new)| !same(old, new)).collect();
    assert!(differ.is_empty(), "{file}, golden and now:\n{differ:#?}\n(GOLDEN=write renews them)");
    assert_eq!(golden.lines().count(), now.len(), "{file}: other groups");
}
