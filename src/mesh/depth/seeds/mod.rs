//! Where walks begin: each file finds free poses that others miss. A new one is a file here, a function that takes the search and gives a free pose (or a [`Seed`](rays::Seed),
//! with the value of that pose), and a line in [`order`](super::order), which says when it is called and what it may cost (`schedule`). Poses of the caller's own need
//! none of that: `DepthOptions::poses`.

pub(super) mod pushout;
pub(super) mod rays;
pub(super) mod samples;
