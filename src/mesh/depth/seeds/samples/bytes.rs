//! Samples as bytes, alike on every machine. They belong to a pair of bodies, whose fingerprints they carry; all numbers are little endian:
//!
//! ```text
//! 8 bytes      "QDISTCS\0"
//! u32          version, 1
//! u32          0
//! u64, u64     fingerprints of A and B: 64-bit FNV-1a of the counts, the vertices and the triangles
//! u64          number of samples, n
//! n * 7 f64    pose of A in the frame of B: quaternion w x y z, translation x y z
//! u64          64-bit FNV-1a of all bytes before
//! ```

use super::ContactSamples;
use crate::mesh::{Mesh, Model};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

const MAGIC: [u8; 8] = *b"QDISTCS\0";
const VERSION: u32 = 1;
/// Bytes before the poses, of a pose, and after the poses.
const HEAD: usize = 40;
const POSE: usize = 56;
const TAIL: usize = 8;

/// Why these bytes or poses are no samples of this pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SamplesError {
    /// The bytes do not begin as contact samples do.
    NotSamples,
    /// The bytes are of a version that is not known here.
    Version {
        /// That version.
        found: u32,
    },
    /// There are fewer or more bytes than the number of samples asks for.
    Length {
        /// Bytes that there should be; `None` where the number of samples is absurd.
        expected: Option<usize>,
        /// Bytes that there are.
        found: usize,
    },
    /// The checksum is wrong: bytes have changed.
    Checksum,
    /// The samples were made for other bodies.
    Pair {
        /// Whether A is another.
        a: bool,
        /// Whether B is another.
        b: bool,
    },
    /// A pose has no unit quaternion, or a coordinate that is not finite or too large.
    Pose {
        /// Which one.
        index: usize,
    },
}

impl std::fmt::Display for SamplesError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            SamplesError::NotSamples => write!(f, "bytes: they do not begin as contact samples do"),
            SamplesError::Version { found } => {
                write!(f, "bytes: contact samples of version {found}, not {VERSION}")
            }
            SamplesError::Length { expected: Some(expected), found } => {
                write!(f, "bytes: there are {found}, not {expected}: cut off, or with something behind")
            }
            SamplesError::Length { expected: None, found } => {
                write!(f, "bytes: there are {found}, and the number of samples is larger than any memory")
            }
            SamplesError::Checksum => write!(f, "bytes: the checksum is wrong, so some have changed"),
            SamplesError::Pair { a, b } => {
                let which = match (a, b) {
                    (true, false) => "A",
                    (false, true) => "B",
                    _ => "A and B",
                };
                write!(f, "bytes: contact samples of other bodies: {which} differ in vertices or triangles")
            }
            SamplesError::Pose { index } => {
                write!(f, "poses: number {index} has no unit quaternion or no finite translation")
            }
        }
    }
}

impl std::error::Error for SamplesError {}

impl ContactSamples {
    /// The samples as bytes, alike on every machine and in every release that reads their version: 48 and 56 for each sample. To be read by
    /// [`from_bytes`](ContactSamples::from_bytes) alone.
    #[must_use]
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(HEAD + POSE * self.poses.len() + TAIL);
        bytes.extend(MAGIC);
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend(0u32.to_le_bytes());
        for number in [self.pair[0], self.pair[1], self.poses.len() as u64] {
            bytes.extend(number.to_le_bytes());
        }
        for pose in &self.poses {
            let (q, t) = (pose.rotation.quaternion(), &pose.translation.vector);
            for x in [q.w, q.i, q.j, q.k, t.x, t.y, t.z] {
                bytes.extend(x.to_le_bytes());
            }
        }
        let sum = fnv(&bytes, FNV);
        bytes.extend(sum.to_le_bytes());
        bytes
    }

    /// The samples of these bodies from their bytes, to the last bit as they were.
    ///
    /// # Errors
    /// [`SamplesError`]: says what is wrong with the bytes, or that the samples are those of other bodies.
    pub fn from_bytes(bytes: &[u8], a: &Model, b: &Model) -> Result<ContactSamples, SamplesError> {
        let Some(rest) = bytes.strip_prefix(&MAGIC) else { return Err(SamplesError::NotSamples) };
        let short = SamplesError::Length { expected: Some(HEAD + TAIL), found: bytes.len() };
        let Some((version, _)) = rest.split_first_chunk() else { return Err(short) };
        match u32::from_le_bytes(*version) {
            VERSION => {}
            found => return Err(SamplesError::Version { found }),
        }
        if bytes.len() < HEAD + TAIL {
            return Err(short);
        }
        let (head, rest) = bytes.split_at(HEAD);
        let (poses, sum) = rest.split_at(rest.len() - TAIL);
        let count = usize::try_from(word(&head[32..])).ok();
        let expected = count.and_then(|n| n.checked_mul(POSE)?.checked_add(HEAD + TAIL));
        if expected != Some(bytes.len()) {
            return Err(SamplesError::Length { expected, found: bytes.len() });
        }
        if fnv(&bytes[..bytes.len() - TAIL], FNV) != word(sum) {
            return Err(SamplesError::Checksum);
        }
        let differs = [(16, a), (24, b)].map(|(at, model)| word(&head[at..]) != fingerprint(model.mesh()));
        if let [a, b] = differs
            && (a || b)
        {
            return Err(SamplesError::Pair { a, b });
        }
        ContactSamples::from_poses(a, b, poses.chunks_exact(POSE).map(read).collect())
    }
}

/// A pose from its 56 bytes.
fn read(bytes: &[u8]) -> Isometry3<f64> {
    let mut x = [0.0; 7];
    for (x, bytes) in x.iter_mut().zip(bytes.chunks_exact(8)) {
        *x = f64::from_bits(word(bytes));
    }
    let [w, i, j, k, tx, ty, tz] = x;
    // As it was: to normalise again may change the last digit.
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
    Isometry3::from_parts(Translation3::new(tx, ty, tz), rotation)
}

/// The number that begins these bytes, at least 8.
fn word(bytes: &[u8]) -> u64 {
    bytes.first_chunk().map_or(0, |eight| u64::from_le_bytes(*eight))
}

/// Where the 64-bit FNV-1a hash begins.
const FNV: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv(bytes: &[u8], from: u64) -> u64 {
    bytes.iter().fold(from, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3))
}

/// What tells a mesh from others; -0 is 0.
pub fn fingerprint(mesh: &Mesh) -> u64 {
    let counts = [mesh.vertices().len(), mesh.triangles().len()];
    let hash = counts.iter().fold(FNV, |hash, &n| fnv(&(n as u64).to_le_bytes(), hash));
    let hash = mesh.vertices().iter().flat_map(|p| p.iter()).fold(hash, |hash, x| fnv(&(x + 0.0).to_le_bytes(), hash));
    mesh.triangles().iter().flatten().fold(hash, |hash, v| fnv(&v.to_le_bytes(), hash))
}
