//! SYMMETRY OF A BODY

/// None that is known.
pub const QDIST_SYMMETRY_NONE: u32 = 0;
/// All rotations about the z axis of the body's frame leave the set unchanged.
pub const QDIST_SYMMETRY_AXIS: u32 = 1;
/// All rotations about the origin of the body's frame leave the set unchanged.
pub const QDIST_SYMMETRY_FULL: u32 = 2;
