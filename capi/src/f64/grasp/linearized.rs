//! LINEARISED CONES
//!
//! Friction pyramids instead of cones, for comparison with the tools that use them. The set of pyramids is smaller than that of the cones
//! (inscribed) or larger (circumscribed); qdist_solve6 brackets d of either, and the primitives of the same contacts give the exact one.
//! A preset is what one tool does, as read in its source; Q is the unit ball in all of them. Fill in position, normal and friction of each
//! contact, let the preset complete it, make pyramids with its frame and layout, and a set of them with its norm.

use super::super::super::generic::{aligned, array, farthest, gaps, in_range, lengths, put, shared};
use super::super::super::grasp::{
    QDIST_HARD, QDIST_LAYOUT_CIRCUMSCRIBED, QDIST_LAYOUT_DEX_NET, QDIST_LAYOUT_GRASPIT, QDIST_LAYOUT_INSCRIBED,
    QDIST_SOFT, QDIST_TOOL_DEX_NET, QDIST_TOOL_FROGGER, QDIST_TOOL_GRASPIT, from_contact, from_grasp, from_norm,
    norm as checked_norm, qdist_friction, qdist_layout, qdist_norm, qdist_tool,
};
use super::super::super::status::{
    Check, QDIST_ERROR_ARGUMENT, QDIST_ERROR_CONTACT_FRICTION, QDIST_ERROR_CONTACT_WRENCH, qdist_status, status,
};
use super::super::sets::{qdist_set_f64, room};
use super::super::unit_sets::qdist_segment_unit_f64;
use super::contacts::{qdist_contact_f64, qdist_wrench_frame_f64};
use core::ffi::c_void;
use qdist::grasp::{
    Contact, ContactError, Contribution, Friction, GraspError, Layout, Norm, Preset, PyramidalCone, WrenchFrame,
    WrenchSet, min_weight,
};
use qdist::internal::one_by_one;
use qdist::internal::{opposed, usable};
use qdist::qset::UnitSet;
use qdist::support::{Failure, Support};
use qdist::{Real, Vector};

/// Where the edges of friction pyramids are.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_layout_f64 {
    /// QDIST_LAYOUT_INSCRIBED, QDIST_LAYOUT_CIRCUMSCRIBED, QDIST_LAYOUT_GRASPIT or QDIST_LAYOUT_DEX_NET.
    pub kind: qdist_layout,
    /// Edges around the normal, at least 3; GraspIt! has its own.
    pub sides: u32,
    /// QDIST_LAYOUT_GRASPIT: one millimetre in your unit of length. QDIST_LAYOUT_DEX_NET: radius of the fingertip, 0.005 by its default. Else
    /// not read.
    pub length: f64,
}

/// What one tool computes.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_preset_f64 {
    /// Reference point and torque scale.
    pub frame: qdist_wrench_frame_f64,
    /// The edges.
    pub layout: qdist_layout_f64,
    /// How forces of several contacts are measured together.
    pub norm: qdist_norm,
    /// How tangents lie: QDIST_TOOL_GRASPIT, QDIST_TOOL_DEX_NET or QDIST_TOOL_FROGGER.
    pub tool: qdist_tool,
}

/// The friction pyramid of a contact at full normal force: the hull of its edges. Made by qdist_pyramids.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_pyramid_f64 {
    /// Coordinate k of edge j is edges[6 * j + k], a wrench.
    pub edges: *const f64,
    pub count: u32,
    /// An upper bound of the length of the edges, and of the rounding error of the support function.
    pub extent: f64,
    pub error: f64,
}

gaps!(qdist_pyramid_f64, count..extent, error..);

/// The wrench set of a list of pyramids, 1 or more, with {0} in it. The list and the edges must outlive the sets that are made of it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct qdist_pyramid_wrenches_f64 {
    pub pyramids: *const qdist_pyramid_f64,
    pub count: u32,
    /// QDIST_L1 or QDIST_LINF.
    pub norm: qdist_norm,
}

impl qdist_layout_f64 {
    fn checked(&self) -> Check<Layout<f64>> {
        let sides = self.sides as usize;
        let layout = match self.kind {
            QDIST_LAYOUT_INSCRIBED => Layout::Inscribed { sides },
            QDIST_LAYOUT_CIRCUMSCRIBED => Layout::Circumscribed { sides },
            QDIST_LAYOUT_GRASPIT => {
                // A length like that of a frame.
                WrenchFrame::new(Vector::zeros(), self.length).map_err(from_contact)?;
                Layout::GraspIt { millimetre: self.length }
            }
            QDIST_LAYOUT_DEX_NET => {
                lengths([self.length])?;
                Layout::DexNet { sides, finger_radius: self.length }
            }
            _ => return Err(QDIST_ERROR_ARGUMENT),
        };
        if sides < 3 && self.kind != QDIST_LAYOUT_GRASPIT { Err(QDIST_ERROR_ARGUMENT) } else { Ok(layout) }
    }

    fn of(layout: &Layout<f64>) -> Self {
        match *layout {
            Layout::Inscribed { sides } => Self { kind: QDIST_LAYOUT_INSCRIBED, sides: sides as u32, length: 0.0 },
            Layout::Circumscribed { sides } => {
                Self { kind: QDIST_LAYOUT_CIRCUMSCRIBED, sides: sides as u32, length: 0.0 }
            }
            Layout::GraspIt { millimetre } => Self { kind: QDIST_LAYOUT_GRASPIT, sides: 0, length: millimetre },
            Layout::DexNet { sides, finger_radius } => {
                Self { kind: QDIST_LAYOUT_DEX_NET, sides: sides as u32, length: finger_radius }
            }
        }
    }
}

/// A pyramid that has passed the checks, where it lies.
#[repr(transparent)]
pub(super) struct CheckedPyramid(qdist_pyramid_f64);

impl CheckedPyramid {
    /// # Safety
    /// The edges of each are valid for reads, if not NULL and aligned.
    unsafe fn list(list: &[qdist_pyramid_f64]) -> Check<&[Self]> {
        for pyramid in list {
            // SAFETY: the caller's promise.
            unsafe { pyramid.edges() }?;
            lengths([pyramid.extent, pyramid.error])?;
        }
        // SAFETY: transparent.
        Ok(unsafe { core::slice::from_raw_parts(list.as_ptr().cast(), list.len()) })
    }

    fn edges(&self) -> &[f64] {
        // SAFETY: the promise of `list`, which has checked the rest.
        unsafe { self.0.edges() }.unwrap_or_default()
    }
}

impl qdist_pyramid_f64 {
    /// # Safety
    /// If not NULL and aligned, `edges` is valid for reads of all coordinates.
    unsafe fn edges<'a>(&self) -> Check<&'a [f64]> {
        // SAFETY: the caller's promise.
        unsafe { array(self.edges, (self.count as usize).checked_mul(6)) }
    }
}

impl Support<f64, 6> for CheckedPyramid {
    fn support(&self, u: &Vector<f64, 6>) -> Result<Vector<f64, 6>, Failure> {
        let mut store = [0.0; 6];
        let (_, edge) =
            farthest(self.edges(), 6, in_range(u.as_slice(), &mut store)).ok_or(Failure(QDIST_ERROR_ARGUMENT))?;
        Ok(Vector::from_iterator(edge.iter().copied()))
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
    /// # Safety
    /// If not NULL and aligned, the list is valid for reads of `count` pyramids for the life of the set, and so are their edges.
    unsafe fn pyramids(&self) -> Check<&[CheckedPyramid]> {
        // SAFETY: the caller's promise.
        unsafe { CheckedPyramid::list(array(self.pyramids, Some(self.count as usize))?) }
    }
}

/// # Safety
/// If not NULL and aligned, `preset` is valid for writes.
unsafe fn fill(
    preset: *mut qdist_preset_f64,
    tool: qdist_tool,
    make: impl FnOnce() -> Check<Preset<f64>>,
) -> qdist_status {
    let fill = || {
        aligned(preset)?;
        let made = make()?;
        let frame = qdist_wrench_frame_f64 {
            reference: (*made.frame.reference()).into(),
            torque_scale: made.frame.torque_scale(),
        };
        let (layout, norm) = (qdist_layout_f64::of(&made.layout), from_norm(made.norm));
        // SAFETY: checked.
        unsafe { preset.write(qdist_preset_f64 { frame, layout, norm, tool }) };
        Ok(())
    };
    status(fill())
}

/// # Safety
/// If not NULL and aligned, `center` is valid for reads of three numbers.
unsafe fn point(center: *const f64) -> Check<Vector<f64, 3>> {
    // SAFETY: the caller's promise.
    Ok(Vector::from_iterator(unsafe { array(center, Some(3)) }?.iter().copied()))
}

/// GraspIt! with an object of this centre of gravity, three numbers, and largest radius about it. millimetre: its unit of length in yours. A
/// soft contact's mus is its 8 sqrt(a b) / 15 mu, with a and b the semi axes of the contact ellipse.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_preset_graspit_f64(
    preset: *mut qdist_preset_f64,
    center: *const f64,
    max_radius: f64,
    millimetre: f64,
    norm: qdist_norm,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    unsafe {
        fill(preset, QDIST_TOOL_GRASPIT, || {
            Preset::graspit(point(center)?, max_radius, millimetre, checked_norm(norm)?).map_err(from_contact)
        })
    }
}

/// Dex-Net's ferrari_canny_L1 with an object of this centre of mass, three numbers. torque_scale: the inverse of its torque_scaling, unless
/// configured the median of the three coordinates of the upper corner of the bounding box. Its defaults: 8 sides, and 0.005 for the radius.
/// Its normal force is the cosine between closing direction and normal: set force_cap after qdist_preset_contact.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_preset_dex_net_f64(
    preset: *mut qdist_preset_f64,
    center: *const f64,
    torque_scale: f64,
    sides: u32,
    finger_radius: f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    unsafe {
        fill(preset, QDIST_TOOL_DEX_NET, || {
            lengths([finger_radius])?;
            let made = Preset::dex_net(point(center)?, torque_scale, sides as usize, finger_radius);
            made.map_err(from_contact).and_then(enough_sides)
        })
    }
}

/// FRoGGeR's ferrari_canny_L1, positions in the object's frame. Its defaults: 4 sides, and 1 for lamb > 0. For its min-weight metric see
/// qdist_opposed_mean.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_preset_frogger_f64(
    preset: *mut qdist_preset_f64,
    sides: u32,
    lamb: f64,
) -> qdist_status {
    // SAFETY: what the header asks of the caller.
    unsafe {
        fill(preset, QDIST_TOOL_FROGGER, || {
            Preset::frogger(sides as usize, lamb).map_err(from_contact).and_then(enough_sides)
        })
    }
}

fn enough_sides(preset: Preset<f64>) -> Check<Preset<f64>> {
    qdist_layout_f64::of(&preset.layout).checked().map(|_| preset)
}

/// Completes a contact, given its position, normal and friction, as the tool has it: writes its tangents, and as force_cap the length of its
/// edges. Of the preset only `tool` counts.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_preset_contact_f64(
    preset: *const qdist_preset_f64,
    contact: *mut qdist_contact_f64,
) -> qdist_status {
    let complete = || {
        // SAFETY: what the header asks of the caller.
        let (preset, own) = unsafe { (shared(preset)?, *shared(contact.cast_const())?) };
        let bare = qdist_contact_f64 { tangents: [0.0; 6], force_cap: 0.0, ..own }.checked().map_err(from_contact)?;
        let zero = Vector::zeros();
        let tool = match preset.tool {
            QDIST_TOOL_GRASPIT => Preset::graspit(zero, 1.0, 1.0, Norm::L1),
            QDIST_TOOL_DEX_NET => Preset::dex_net(zero, 1.0, 8, 0.0),
            QDIST_TOOL_FROGGER => Preset::frogger(4, 1.0),
            _ => return Err(QDIST_ERROR_ARGUMENT),
        };
        let made = tool.and_then(|tool| tool.contact(*bare.position(), *bare.normal(), bare.friction()));
        let made: Contact<f64> = made.map_err(from_contact)?;
        let [o, t] = made.tangents();
        let tangents = [o.x, o.y, o.z, t.x, t.y, t.z];
        // SAFETY: checked.
        unsafe { put(contact, qdist_contact_f64 { tangents, force_cap: made.force_cap(), ..own }) };
        Ok(())
    };
    status(complete())
}

/// How many edges the pyramid of a contact with this friction has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_pyramid_edges_f64(
    layout: *const qdist_layout_f64,
    friction: qdist_friction,
    edges: *mut u32,
) -> qdist_status {
    let count = || {
        aligned(edges)?;
        // SAFETY: what the header asks of the caller.
        let layout = unsafe { shared(layout) }?.checked()?;
        if friction > QDIST_SOFT {
            return Err(QDIST_ERROR_CONTACT_FRICTION);
        }
        let made = layout.edges(like(friction));
        // SAFETY: checked.
        unsafe { edges.write(u32::try_from(made).map_err(|_| QDIST_ERROR_ARGUMENT)?) };
        Ok(())
    };
    status(count())
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
/// QDIST_ERROR_CAPACITY: there is no room for the edges. which: NULL; or after an error that is a contact's, its index is written there. After
/// QDIST_ERROR_CONTACT_WRENCH what `edges` contains is unspecified.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_pyramids_f64(
    contacts: *const qdist_contact_f64,
    count: u32,
    frame: *const qdist_wrench_frame_f64,
    layout: *const qdist_layout_f64,
    edges: *mut f64,
    capacity: u32,
    pyramids: *mut qdist_pyramid_f64,
    which: *mut u32,
) -> qdist_status {
    let make = || {
        aligned(edges)?;
        aligned(pyramids)?;
        if !which.is_null() {
            aligned(which)?;
        }
        // SAFETY: what the header asks of the caller.
        let (contacts, frame, layout) = unsafe {
            let contacts = array(contacts, Some(count as usize))?;
            (contacts, shared(frame)?.checked()?, shared(layout)?.checked()?)
        };
        // SAFETY: what the header asks of the caller.
        let refuse = |contact: usize, error| unsafe { from_grasp(GraspError { contact, error }, which) };
        let most = (isize::MAX as usize / size_of::<[f64; 6]>()).min(capacity as usize);
        let mut total = 0usize;
        for (index, contact) in contacts.iter().enumerate() {
            let contact = contact.checked().map_err(|error| refuse(index, error))?;
            total = total.saturating_add(layout.edges(contact.friction()));
            if total > most {
                return Err(refuse(index, ContactError::Room));
            }
        }
        // SAFETY: what the header asks of the caller: room for them, which nothing else refers to. It needs no initial value, but
        // a reference does.
        let all = unsafe {
            edges.write_bytes(0, 6 * total);
            core::slice::from_raw_parts_mut(edges.cast::<[f64; 6]>(), total)
        };
        // All are made before the first pyramid is written.
        for write in [false, true] {
            let mut rest = &mut *all;
            for (index, contact) in contacts.iter().enumerate() {
                let make = |contact: Contact<f64>| {
                    let count = layout.edges(contact.friction());
                    let (own, left) =
                        core::mem::take(&mut rest).split_at_mut_checked(count).ok_or(ContactError::Room)?;
                    rest = left;
                    PyramidalCone::new(&contact, &frame, &layout, own).map(|cone| from_cone(&cone))
                };
                let made = contact.checked().and_then(make).map_err(|error| refuse(index, error))?;
                if write {
                    // SAFETY: what the header asks of the caller: room for `count`.
                    unsafe { put(pyramids.add(index), made) };
                }
            }
        }
        Ok(())
    };
    status(make())
}

fn from_cone(cone: &PyramidalCone<'_, f64>) -> qdist_pyramid_f64 {
    let edges = cone.edges();
    // The support function here measures from the origin, wherever the edges are.
    let error = cone.error() + 14.0 * f64::ROUNDOFF * cone.extent();
    qdist_pyramid_f64 { edges: edges.as_ptr().cast(), count: edges.len() as u32, extent: cone.extent(), error }
}

/// Makes a set of a list of pyramids. Reads all edges.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_set_pyramid_wrenches_f64(
    set: *mut qdist_set_f64,
    wrenches: *const qdist_pyramid_wrenches_f64,
) -> qdist_status {
    let fill = || {
        aligned(set)?;
        // SAFETY: what the header asks of the caller.
        let (pyramids, norm) = unsafe {
            let wrenches = shared(wrenches)?;
            (wrenches.pyramids()?, checked_norm(wrenches.norm)?)
        };
        for pyramid in pyramids {
            if !usable(pyramid.edges().iter()) {
                return Err(QDIST_ERROR_CONTACT_WRENCH);
            }
        }
        let checked = WrenchSet::new(pyramids, norm);
        lengths([checked.extent(), checked.error()])?;
        let made = qdist_set_f64 {
            support: Some(qdist_pyramid_wrenches_support_f64),
            exhaustive: None,
            mirrored: None,
            user: wrenches.cast_mut().cast(),
            radius: 0.0,
            extent: checked.extent(),
            error: checked.error(),
            dimension: 6,
            contains_origin: checked.contains_origin().into(),
        };
        // SAFETY: checked.
        unsafe { put(set, made) };
        Ok(())
    };
    status(fill())
}

/// Support function of a set of pyramids.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_pyramid_wrenches_support_f64(
    user: *mut c_void,
    direction: *const f64,
    point: *mut f64,
) -> i32 {
    let ask = || {
        let point = room::<6>(point)?;
        // SAFETY: what the header asks of the caller.
        let found = unsafe {
            let set = shared(user.cast::<qdist_pyramid_wrenches_f64>().cast_const())?;
            let u = Vector::from_iterator(array(direction, Some(6))?.iter().copied());
            WrenchSet::without_size(set.pyramids()?, checked_norm(set.norm)?)
                .support(&u)
                .map_err(|Failure(code)| code)?
        };
        // SAFETY: checked.
        unsafe { point.write(one_by_one(&found).into()) };
        Ok(())
    };
    status(ask())
}

/// Minus the mean of all edges, as a segment for Q: d of the set with QDIST_L1 is then the t of FRoGGeR's min-weight metric, see qdist_min_weight.
/// QDIST_ERROR_ARGUMENT: the mean is 0, and the metric 1.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn qdist_opposed_mean_f64(
    pyramids: *const qdist_pyramid_f64,
    count: u32,
    segment: *mut qdist_segment_unit_f64,
) -> qdist_status {
    let make = || {
        aligned(segment)?;
        // SAFETY: what the header asks of the caller.
        let list = unsafe { CheckedPyramid::list(array(pyramids, Some(count as usize))?) }?;
        let edges = || list.iter().flat_map(|pyramid| pyramid.edges().as_chunks::<6>().0);
        if !edges().all(|edge| usable(edge.iter())) {
            return Err(QDIST_ERROR_CONTACT_WRENCH);
        }
        let found = opposed(edges()).ok_or(QDIST_ERROR_ARGUMENT)?;
        // SAFETY: checked.
        unsafe { put(segment, qdist_segment_unit_f64 { end: found.vertex(0).into(), dimension: 6 }) };
        Ok(())
    };
    status(make())
}

/// FRoGGeR's normalised min-weight metric N l from t: t / (1 + t). Increasing in t, so that it takes a bracket to a bracket. Its default asks for 0.3.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_min_weight_f64(t: f64) -> f64 {
    min_weight(t)
}
