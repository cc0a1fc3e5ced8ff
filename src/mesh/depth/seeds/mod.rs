//! Where walks begin.

pub(super) mod rays;
