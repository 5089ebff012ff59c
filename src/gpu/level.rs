//! Level: patches that culling left in; their levels, or the dyadic lists of units that divide at
//! midpoints, out. What is culled gets neither: its words stay 0.

use super::device::{Buffer, Device};
use super::kernel::Kernel;
use super::settings::Settings;
use crate::error::Result;

/// Words of a patch's levels: of the edges v0, u1, v1, u0 and of the interior along u and v in
/// UQ8.16; then levels clamped, edges too near, points whose projection does not fit; 3 are 0.
pub const LEVELS: usize = 12;

/// Words of a patch's lists: masks of four words, the low one first, of the edges v0, u1, v1, u0
/// and of all that runs along u and along v; then lists clamped, edges too near, points whose
/// projection does not fit, subdivisions.
pub const LISTS: usize = 28;

/// Curves of a patch that are divided each on its own, and words of what becomes of one.
const CURVES: usize = 8;
const CURVE: usize = 6;

/// The levels of the settings' items, [`LEVELS`] words a patch, before any raising of the interior.
///
/// # Errors
/// As [`Device::run`] and [`Device::empty`].
pub fn level(
    device: &Device,
    settings: &Settings,
    patches: &Buffer,
    fates: &Buffer,
) -> Result<Buffer> {
    let levels = device.empty(LEVELS * settings.items as usize)?;
    device.run(Kernel::Level, "level", settings, &[patches, fates, &levels])?;
    Ok(levels)
}

/// The lists of the settings' items, [`LISTS`] words a patch. The batch must be small enough for a
/// binding of 48 words a patch, eight curves of six, which is less than the patches have.
///
/// # Errors
/// As [`level`].
pub fn subdivide(
    device: &Device,
    settings: &Settings,
    patches: &Buffer,
    fates: &Buffer,
) -> Result<Buffer> {
    let items = settings.items as usize;
    let levels = level(device, settings, patches, fates)?;
    let curves = device.empty(CURVES * CURVE * items)?;
    let each = settings.of(CURVES * items);
    device.run(Kernel::Curve, "curve", &each, &[patches, fates, &curves])?;
    let lists = device.empty(LISTS * items)?;
    let buffers = [patches, fates, &lists, &levels, &curves];
    device.run(Kernel::Curve, "lists", settings, &buffers)?;
    Ok(lists)
}
