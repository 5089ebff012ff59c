//! Check: a trace through the first implementation and the second, and both beside each other,
//! value by value.
//!
//! In come a trace, a configuration and a device; out comes a ledger: block by block how many
//! values were compared, how many differ, and the first that do. The units run as always; what
//! arrives behind the port is handed to the kernels too, batch by batch, and nothing else is.

mod blocks;
mod counts;
mod item;
mod ledger;
mod tap;
mod units;

use crate::config::{Config, Union, Unit};
use crate::error::{Error, Result};
use crate::gpu::Device;
use crate::trace::command::{Command, Header};
use crate::trace::replay::Replay;
use crate::unit::simulate;
use std::time::{Duration, Instant};

pub use counts::{NOT_COMPARED, compared};
pub use ledger::{Difference, Ledger, Row};

use tap::Tap;

/// What a check found.
#[derive(Debug)]
pub struct Checked {
    /// What the trace says of itself.
    pub header: Header,
    /// What was compared.
    pub ledger: Ledger,
    /// Frames, and patches that arrived.
    pub frames: u64,
    /// Patches that arrived behind the port.
    pub patches: u64,
    /// Time that the kernels took, with what goes to the device and comes from it.
    pub gpu: Duration,
    /// Time of all the rest: the units, and the comparison.
    pub rest: Duration,
}

/// Runs the trace on the configured unit and on the device. `watch` sees each command before the
/// unit does.
///
/// # Errors
/// Those of the trace, of [`simulate`] and of the device; [`Error::Usage`] for what has no kernels.
pub fn run(
    trace: &mut Replay,
    config: &Config,
    device: &Device,
    mut watch: impl FnMut(&Command),
) -> Result<Checked> {
    if config.unit == Unit::Sfarti && config.level.union != Union::Off {
        return Err(Error::Usage(
            "level.union: the second implementation has each patch's own lists only, expected off"
                .into(),
        ));
    }
    if config.unit == Unit::Triangles && config.triangles.uses_memory() {
        return Err(Error::Usage(
            "triangles: the second implementation makes patches as they are streamed and each \
             vertex once, expected triangles.residency streamed and triangles.cache.policy \
             unlimited"
                .into(),
        ));
    }
    let started = Instant::now();
    let mut header = Header::default();
    let commands = trace.reader()?.map(|located| {
        let command = located?.command;
        watch(&command);
        if let Command::Header(found) = &command {
            header = found.clone();
        }
        Ok(command)
    });
    let mut tap = Tap::new(config, device);
    let report = simulate(commands, config, &mut tap)?;
    let (frames, patches) = (report.frames.len() as u64, tap.patches);
    let (ledger, gpu) = tap.finish(&report)?;
    let rest = started.elapsed().saturating_sub(gpu);
    Ok(Checked { header, ledger, frames, patches, gpu, rest })
}
