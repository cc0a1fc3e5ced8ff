//! VERSION

use core::assert;

/// Major version: changes when a program must be changed.
pub const QDIST_VERSION_MAJOR: u32 = 0;
/// Minor version: changes when something is added (before 1.0: when a program must be changed).
pub const QDIST_VERSION_MINOR: u32 = 1;
/// Patch version.
pub const QDIST_VERSION_PATCH: u32 = 0;

/// The version of the library that is linked, `(major << 16) | (minor << 8) | patch`. Compare it with QDIST_VERSION, which is
/// that of this header.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_version() -> u32 {
    (QDIST_VERSION_MAJOR << 16) | (QDIST_VERSION_MINOR << 8) | QDIST_VERSION_PATCH
}

/// A number of Cargo.toml.
const fn number(digits: &str) -> u32 {
    match u32::from_str_radix(digits, 10) {
        Ok(number) => number,
        Err(_) => panic!(),
    }
}

// The header's generator reads numbers, not `env!`; so the compiler compares the two.
const _: () = {
    assert!(QDIST_VERSION_MAJOR == number(env!("CARGO_PKG_VERSION_MAJOR")));
    assert!(QDIST_VERSION_MINOR == number(env!("CARGO_PKG_VERSION_MINOR")));
    assert!(QDIST_VERSION_PATCH == number(env!("CARGO_PKG_VERSION_PATCH")));
};
