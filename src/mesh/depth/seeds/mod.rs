//! Where walks begin.

pub(super) mod pushout;
pub(super) mod rays;
pub(super) mod samples;
