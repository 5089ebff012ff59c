//! Back-face removal: patches and what clip left of them in; fates with the verdicts out. Each
//! method is an entry of its own, so that a device compiles only the one that is asked for.

use super::device::{Buffer, Device};
use super::kernel::Kernel;
use super::settings::Settings;
use crate::error::Result;

/// Invocations that take a patch together.
const LANES: usize = 64;

/// Tests the settings' items, patches of [`super::PATCH`] words, by the settings' method: in
/// `fates`, four words a patch as [`super::Made::fates`] has them, what is removed becomes 1.
///
/// # Errors
/// As [`Device::run`].
pub fn backface(
    device: &Device,
    settings: &Settings,
    patches: &Buffer,
    fates: &Buffer,
) -> Result<()> {
    let (kernel, entry) = match settings.backface {
        0 => return Ok(()),
        1 => (Kernel::Backface, "net_facets"),
        2 => (Kernel::Backface, "tangent_plane"),
        3 => (Kernel::BackfaceCone, "normal_cone"),
        _ => (Kernel::BackfaceHull, "hull_literal"),
    };
    let lanes = settings.of(LANES * settings.items as usize);
    device.run(kernel, entry, &lanes, &[patches, fates])
}
