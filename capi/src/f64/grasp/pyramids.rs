//! FRICTION PYRAMIDS
//!
//! Pyramids of contacts, by the layout of a preset or one of yours, and their wrench sets.

use super::*;
use qdist::internal::{List, near_unit, opposed, usable};

/// The friction pyramid of a contact at full normal force: the hull of its edges. Made by qdist_pyramids.
#[repr(C)]
pub struct qdist_pyramid_f64 {
    /// Coordinate k of edge j is edges[6 * j + k], a wrench.
    pub edges: In<f64>,
    pub count: u32,
    /// An upper bound of the length of the edges, and of the rounding error of the support function.
    pub extent: f64,
    pub error: f64,
}
gaps!(qdist_pyramid_f64, count..extent, error..);

/// The wrench set of a list of pyramids, 1 or more, with {0} in it. The list and the edges must outlive the sets that are made of it.
#[repr(C)]
pub struct qdist_pyramid_wrenches_f64 {
    pub pyramids: In<qdist_pyramid_f64>,
    pub count: u32,
    /// QDIST_L1 or QDIST_LINF.
    pub norm: qdist_norm,
}

/// A pyramid that has passed the checks, where it lies.
#[repr(transparent)]
pub(super) struct CheckedPyramid(qdist_pyramid_f64);

impl CheckedPyramid {
    fn list(list: &[qdist_pyramid_f64]) -> Check<&[Self]> {
        for pyramid in list {
            pyramid.edges()?;
            lengths([pyramid.extent, pyramid.error])?;
        }
        // SAFETY: transparent.
        Ok(unsafe { core::slice::from_raw_parts(list.as_ptr().cast(), list.len()) })
    }

    fn edges(&self) -> &[f64] {
        self.0.edges().unwrap_or_default()
    }
}

impl qdist_pyramid_f64 {
    fn edges(&self) -> Check<&[f64]> {
        self.edges.array((self.count as usize).checked_mul(6))
    }
}

impl Support<f64, 6> for CheckedPyramid {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        let list = List::new(self.edges().as_chunks::<6>().0).ok_or(Failure(QDIST_ERROR_ARGUMENT))?;
        Ok(Vector::from(*list.scan::<false>(&near_unit(*u))))
    }
    fn extent(&self) -> f64 {
        self.0.extent
    }
    fn error(&self) -> f64 {
        self.0.error
    }
}

impl Contribution<f64> for CheckedPyramid {}

impl qdist_pyramid_wrenches_f64 {
    fn pyramids(&self) -> Check<&[CheckedPyramid]> {
        CheckedPyramid::list(self.pyramids.array(Some(self.count as usize))?)
    }
}

impl Wrenches for qdist_pyramid_wrenches_f64 {
    type Contribution<'a> = CheckedPyramid;
    fn checked(&self) -> Check<WrenchSet<'_, f64, CheckedPyramid>> {
        let (pyramids, norm) = (self.pyramids()?, checked_norm(self.norm)?);
        if !pyramids.iter().all(|pyramid| usable(pyramid.edges().iter())) {
            return Err(QDIST_ERROR_CONTACT_WRENCH);
        }
        Ok(WrenchSet::new(pyramids, norm))
    }
    fn unchecked(&self) -> Check<WrenchSet<'_, f64, CheckedPyramid>> {
        Ok(WrenchSet::without_size(self.pyramids()?, checked_norm(self.norm)?))
    }
}

/// How many edges the pyramid of a contact with this friction has.
///
/// Status: of layout: ARGUMENT (kind, sides, or length negative), NONFINITE (length), FRAME (length of QDIST_LAYOUT_GRASPIT);
/// CONTACT_FRICTION (friction).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_pyramid_edges_f64(
    layout: In<qdist_layout_f64>,
    friction: qdist_friction,
    edges: Out<u32>,
) -> qdist_status {
    status_of(|| {
        edges.checked()?;
        let layout = layout.get()?.checked()?;
        if friction > QDIST_SOFT {
            return Err(QDIST_ERROR_CONTACT_FRICTION);
        }
        edges.put(u32::try_from(layout.edges(like(friction))).map_err(|_| QDIST_ERROR_ARGUMENT)?)
    })
}

/// A friction of this kind.
fn like(friction: qdist_friction) -> Friction<f64> {
    match friction {
        QDIST_SOFT => Friction::Soft { mu: 1.0, mus: 1.0 },
        QDIST_HARD => Friction::Hard { mu: 1.0 },
        _ => Friction::Frictionless,
    }
}

/// Pyramids of `count` contacts: their edges, one contact's after the other's, go to `edges`, with room for `capacity` edges of six numbers, and
/// `pyramids`, with room for `count`, points there.
///
/// After QDIST_ERROR_CONTACT_WRENCH what `edges` contains is unspecified.
///
/// Status: ARGUMENT (count is 0), FRAME (frame), CAPACITY (capacity: there is no room for the edges); of layout: ARGUMENT (kind, sides, or length negative), NONFINITE
/// (length), FRAME (length of QDIST_LAYOUT_GRASPIT); of a contact, which `which` names: CONTACT_POSITION, CONTACT_NORMAL, CONTACT_TANGENTS,
/// CONTACT_FRICTION, CONTACT_CAP, CONTACT_WRENCH.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_pyramids_f64(
    contacts: In<qdist_contact_f64>,
    count: u32,
    frame: In<qdist_wrench_frame_f64>,
    layout: In<qdist_layout_f64>,
    edges: Out<f64>,
    capacity: u32,
    pyramids: Out<qdist_pyramid_f64>,
    which: Out<u32>,
) -> qdist_status {
    status_of(|| {
        edges.checked()?;
        pyramids.checked()?;
        which.optional()?;
        let contacts = contacts.array(Some(count as usize))?;
        let (frame, layout) = (frame.get()?.checked()?, layout.get()?.checked()?);
        let refuse = |contact: usize, error| from_grasp(GraspError { contact, error }, &which);
        let most = (isize::MAX as usize / size_of::<[f64; 6]>()).min(capacity as usize);
        let mut total = 0usize;
        for (index, contact) in contacts.iter().enumerate() {
            let contact = contact.checked().map_err(|error| refuse(index, error))?;
            total = total.saturating_add(layout.edges(contact.friction()));
            if total > most {
                return Err(refuse(index, ContactError::Room));
            }
        }
        let rows = edges.rows::<[f64; 6]>();
        let all = rows.zeroed(total)?;
        // All are made before the first pyramid is written.
        for write in [false, true] {
            let (mut rest, mut done) = (&mut *all, 0);
            for (index, contact) in contacts.iter().enumerate() {
                let make = |contact: Contact<f64>| {
                    let count = layout.edges(contact.friction());
                    let (own, left) =
                        core::mem::take(&mut rest).split_at_mut_checked(count).ok_or(ContactError::Room)?;
                    rest = left;
                    let cone = PyramidalCone::new(&contact, &frame, &layout, own)?;
                    Ok(from_cone(&cone, edges.filled_from(6 * done)))
                };
                let made = contact.checked().and_then(make).map_err(|error| refuse(index, error))?;
                done += made.count as usize;
                if write {
                    pyramids.put_at(index, made)?;
                }
            }
        }
        Ok(())
    })
}

fn from_cone(cone: &PyramidalCone<'_, f64>, edges: In<f64>) -> qdist_pyramid_f64 {
    // The support function here measures from the origin, wherever the edges are.
    let error = cone.error() + 14.0 * f64::ROUNDOFF * cone.extent();
    qdist_pyramid_f64 { edges, count: cone.edges().len() as u32, extent: cone.extent(), error }
}

/// Makes a set of a list of pyramids. Reads all edges.
///
/// Status: ARGUMENT (wrenches->norm; count of them or of the edges of one is 0; extent or error negative), NONFINITE (extent or error, or all of
/// them together), CONTACT_WRENCH (an edge).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_set_pyramid_wrenches_f64(
    set: Out<qdist_set_f64>,
    wrenches: In<qdist_pyramid_wrenches_f64>,
) -> qdist_status {
    status(Wrenches::fill(set, wrenches))
}

/// Minus the mean of all edges, as a segment for Q: d of the set with QDIST_L1 is then the t of FRoGGeR's min-weight metric N l = t / (1 + t), which
/// increases in t, so that it takes a bracket to a bracket. Its default asks for N l = 0.3. QDIST_ERROR_ARGUMENT: the mean is 0, and the metric 1.
///
/// Status: ARGUMENT (count of them or of the edges of one is 0; extent or error negative; or the mean is 0), NONFINITE (extent or error),
/// CONTACT_WRENCH (an edge).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_opposed_mean_f64(
    segment: Out<qdist_segment_unit_f64>,
    pyramids: In<qdist_pyramid_f64>,
    count: u32,
) -> qdist_status {
    status_of(|| {
        segment.checked()?;
        let list = CheckedPyramid::list(pyramids.array(Some(count as usize))?)?;
        let edges = || list.iter().flat_map(|pyramid| pyramid.edges().as_chunks::<6>().0);
        if !edges().all(|edge| usable(edge.iter())) {
            return Err(QDIST_ERROR_CONTACT_WRENCH);
        }
        let found = opposed(edges()).ok_or(QDIST_ERROR_ARGUMENT)?;
        segment.put(qdist_segment_unit_f64 { end: found.vertex(0).into(), dimension: 6 })
    })
}
