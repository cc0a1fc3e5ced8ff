//! What a tick of the tracker may cost.

use crate::mesh::certificate::Effort;

/// What a tick may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Collision, contact and distance queries, at least 1, default 16: the pose itself is always tested. Where no free pose is known the
    /// escape from B's box comes on top, six tests at most.
    pub max_queries: u64,
    /// The tick ends when `upper - lower` is at most this fraction of `upper`, default 1e-3.
    pub relative: f64,
    /// Tests at random poses that are nearer than the best, default 4.
    pub probes: u32,
    /// Whether lower bounds are renewed, and with what effort (0.1 to 1 ms), default fast. Without, they are 0.
    pub certificate: Option<Effort>,
}

impl Default for Budget {
    /// 16 queries, 4 probes, fast certificates.
    fn default() -> Self {
        Budget { max_queries: 16, relative: 1e-3, probes: 4, certificate: Some(Effort::Fast) }
    }
}
