//! `compare --pictures`: the units' pictures of a frame side by side, on one scale.

use crate::cli::render::{COLUMNS, Studio};
use tessim::config::Config;
use tessim::error::Result;
use tessim::gpu::{Backend, Device, Sources};
use tessim::output::picture::{self, Canvas};
use tessim::study::picture::{Shot, Style, Values};
use tessim::trace::replay::Replay;

/// Pixels of a unit's picture along its longer side, where no size is given.
const SIDE: u32 = 640;

/// The sheet as a PNG: a picture a unit, in order.
pub(super) fn sheet(
    trace: &mut Replay,
    configs: &[Config],
    frame: u64,
    style: Style,
    size: Option<[u32; 2]>,
) -> Result<Vec<u8>> {
    let shots = configs.iter().map(|config| Shot::take(&mut trace.reader()?, config, frame));
    let shots: Vec<Shot> = shots.collect::<Result<_>>()?;
    let device = Device::open(Backend::Auto, Sources::default())?;
    let over = shots.iter().map(|shot| shot.measured(style)).fold(Values::default(), Values::with);
    let [width, height] = shots[0].viewport();
    let side = |length: u32| (length * SIDE / width.max(height)).max(1);
    let size = size.unwrap_or([side(width), side(height)]);
    let studio = Studio { device: &device, size, tile: None };
    let pictures = shots.iter().map(|shot| studio.picture(shot, style, over));
    let pictures: Vec<Canvas> = pictures.collect::<Result<_>>()?;
    let mut png = Vec::new();
    picture::write(&Canvas::sheet(&pictures, COLUMNS), &mut png).expect("memory takes everything");
    Ok(png)
}
