//! What tests, benches and fuzzers share. The oracles are in the modules; the reader of convex case files is the program's.

// Each test uses a part.
#![allow(dead_code, unused_macros)]

/// A test of a generic function in both scalars and every dimension.
macro_rules! every_type_and_dimension {
    ($test:ident, $generic:ident) => {
        #[test]
        fn $test() {
            $generic::<f64, 2>();
            $generic::<f64, 3>();
            $generic::<f64, 4>();
            $generic::<f64, 5>();
            $generic::<f64, 6>();
            $generic::<f32, 2>();
            $generic::<f32, 3>();
            $generic::<f32, 4>();
            $generic::<f32, 5>();
            $generic::<f32, 6>();
        }
    };
}

#[path = "../../cli/src/depth/cases.rs"]
pub mod cases;
pub mod dd;
pub mod dice;
pub mod exact;
pub mod golden;
pub mod hull;
pub mod lattice;
pub mod memory;

use std::path::{Path, PathBuf};

/// A file or folder of the shared data, which lie beside the project and not in it. A test that calls this is marked
/// `#[ignore = "needs ../shared/data"]`: `./x test` runs it with `--include-ignored` where the data are there, or must be (`CI=true`), and
/// counts it as skipped elsewhere.
pub fn shared(path: &str) -> PathBuf {
    let asked = std::env::args().any(|a| a == "--include-ignored" || a == "--ignored");
    assert!(asked, "a test that needs ../shared/data must be #[ignore]d: it would fail where only the project is");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(path);
    assert!(path.exists(), "{path:?} is not there");
    path
}
