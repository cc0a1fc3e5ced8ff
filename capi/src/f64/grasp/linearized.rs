//! LINEARISED CONES
//!
//! Friction pyramids instead of cones, for comparison with the tools that use them. The set of pyramids is smaller than that of the cones
//! (inscribed) or larger (circumscribed); qdist_solve6 brackets d of either, and the primitives of the same contacts give the exact one.
//! A preset is what one tool does, as read in its source; Q is the unit ball in all of them. Fill in position, normal and friction of each
//! contact, let the preset complete it, make pyramids with its frame and layout, and a set of them with its norm.

use super::*;

/// Where the edges of friction pyramids are.
#[repr(C)]
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
gaps!(qdist_preset_f64);

impl qdist_layout_f64 {
    pub(super) fn checked(&self) -> Check<Layout<f64>> {
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

/// Writes a preset. (Its layout is looked at once more: a number of sides is no error of a contact's.)
fn fill(preset: Out<qdist_preset_f64>, tool: qdist_tool, made: Result<Preset<f64>, ContactError>) -> Check {
    let made = made.map_err(from_contact)?;
    let frame =
        qdist_wrench_frame_f64 { reference: (*made.frame.reference()).into(), torque_scale: made.frame.torque_scale() };
    let (layout, norm) = (qdist_layout_f64::of(&made.layout), from_norm(made.norm));
    layout.checked()?;
    preset.put(qdist_preset_f64 { frame, layout, norm, tool })
}

/// GraspIt! with an object of this centre of gravity, three numbers, and largest radius about it. millimetre: its unit of length in yours. A
/// soft contact's mus is its 8 sqrt(a b) / 15 mu, with a and b the semi axes of the contact ellipse.
///
/// Status: ARGUMENT (norm), FRAME (center, max_radius or millimetre).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_preset_graspit_f64(
    preset: Out<qdist_preset_f64>,
    center: In<f64>,
    max_radius: f64,
    millimetre: f64,
    norm: qdist_norm,
) -> qdist_status {
    status_of(|| {
        preset.checked()?;
        let (center, norm) = (Vector::from(center.numbers::<3>()?), checked_norm(norm)?);
        fill(preset, QDIST_TOOL_GRASPIT, Preset::graspit(center, max_radius, millimetre, norm))
    })
}

/// Dex-Net's ferrari_canny_L1 with an object of this centre of mass, three numbers. torque_scale: the inverse of its torque_scaling, unless
/// configured the median of the three coordinates of the upper corner of the bounding box. Its defaults: 8 sides, and 0.005 for the radius.
/// Its normal force is the cosine between closing direction and normal: set force_cap after qdist_preset_contact.
///
/// Status: ARGUMENT (finger_radius is negative, or sides is below 3), NONFINITE (finger_radius), FRAME (center or
/// torque_scale), CONTACT_WRENCH (finger_radius is above 1.4e146, float: 4.5e15).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_preset_dex_net_f64(
    preset: Out<qdist_preset_f64>,
    center: In<f64>,
    torque_scale: f64,
    sides: u32,
    finger_radius: f64,
) -> qdist_status {
    status_of(|| {
        preset.checked()?;
        lengths([finger_radius])?;
        let center = Vector::from(center.numbers::<3>()?);
        fill(preset, QDIST_TOOL_DEX_NET, Preset::dex_net(center, torque_scale, sides as usize, finger_radius))
    })
}

/// FRoGGeR's ferrari_canny_L1, positions in the object's frame. Its defaults: 4 sides, and 1 for lamb > 0. For its min-weight metric see
/// qdist_opposed_mean.
///
/// Status: ARGUMENT (sides is below 3), FRAME (lamb).
#[unsafe(no_mangle)]
pub extern "C" fn qdist_preset_frogger_f64(preset: Out<qdist_preset_f64>, sides: u32, lamb: f64) -> qdist_status {
    status_of(|| {
        preset.checked()?;
        fill(preset, QDIST_TOOL_FROGGER, Preset::frogger(sides as usize, lamb))
    })
}

/// Completes a contact, given its position, normal and friction, as the tool has it: writes its tangents, and as force_cap the length of its
/// edges. Of the preset only `tool` counts.
///
/// Status: ARGUMENT (preset->tool); of the contact: CONTACT_POSITION, CONTACT_NORMAL, CONTACT_FRICTION.
#[unsafe(no_mangle)]
pub extern "C" fn qdist_preset_contact_f64(
    preset: In<qdist_preset_f64>,
    contact: Out<qdist_contact_f64>,
) -> qdist_status {
    status_of(|| {
        let (preset, own) = (preset.get()?, *contact.get()?);
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
        contact.put(qdist_contact_f64 { tangents, force_cap: made.force_cap(), ..own })
    })
}
