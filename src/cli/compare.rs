//! `compare`: a trace through several units, their numbers side by side, and their pictures.

#[cfg(feature = "gpu")]
mod pictures;

use super::config::Laid;
use super::print;
use super::progress::Progress;
use super::run::{engines, pool, provenance};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use tessim::config::{Config, Engine};
use tessim::error::Result;
use tessim::output::folder::ResultFolder;
use tessim::output::summary;
use tessim::study::compare::{self, CSV_HEADER, Comparison, roofline};
use tessim::trace::replay::Replay;

/// Run a trace through several units and set their numbers side by side
///
/// Prints a table with ratios to the first unit; what a unit does not have is -. With --out writes
/// compare.csv (every number over the whole run beside the first unit's, with its least, median and
/// greatest over the frames), frames.csv (the same of each frame), config.toml (the first unit's,
/// which serves for the others as well) and summary.json; docs/compare.md defines the numbers.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim compare traces/teapot.jsonl\n  \
                        tessim compare traces/teapot.jsonl --units triangles,sfarti,hybrid \
                        --preset gf3-2001 --roofline --out result")]
pub(crate) struct Args {
    /// The trace; - for standard input, which is read once
    trace: PathBuf,
    /// Names with commas between them, the one that ratios are to first; or all
    #[arg(long, value_name = "U,U,..", default_value = compare::ALL)]
    units: String,
    #[command(flatten)]
    laid: Laid,
    /// What lays time over the blocks; over all layers [default: timed]
    #[arg(long, value_name = "E", value_parser = engines())]
    engine: Option<Engine>,
    /// Points of each patch's surface along u and along v whose distance from the triangles is
    /// measured; 0: no errors
    #[arg(long, value_name = "N", default_value_t = 17,
          value_parser = clap::value_parser!(u32).range(0..=256))]
    samples: u32,
    /// Also say what binds each unit in the first frame at each level from 1 to 64; with --out in
    /// roofline.csv and roofline.svg
    #[arg(long)]
    roofline: bool,
    /// Threads, any number of which give the same bytes [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
    /// Write the results into this folder; one that exists is replaced only if compare wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[cfg(feature = "gpu")]
    #[command(flatten)]
    wanted: Wanted,
}

/// Which pictures are wanted.
#[cfg(feature = "gpu")]
#[derive(Debug, clap::Args)]
struct Wanted {
    /// Also draw the units' triangles side by side, in pictures.png (with --out)
    #[arg(long, value_name = "S", num_args = 0..=1, require_equals = true, requires = "out",
          default_missing_value = "wireframe", value_parser = super::render::styles())]
    pictures: Option<tessim::study::picture::Style>,
    /// The frame that is drawn, from 0 [default: 0]
    #[arg(long, value_name = "N", requires = "pictures")]
    frame: Option<u64>,
    /// Width and height of each unit's picture in pixels [default: 640 along the longer side]
    #[arg(long, value_name = "WxH", requires = "pictures", value_parser = super::render::size)]
    size: Option<[u32; 2]>,
}

/// What the folder holds.
const FILES: [&str; 3] = ["compare.csv", "config.toml", "summary.json"];

/// What it may hold besides; other versions wrote less.
const BESIDES: [&str; 4] = ["frames.csv", "pictures.png", "roofline.csv", "roofline.svg"];

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    let configs = args.configurations()?;
    let pool = pool(args.threads)?;
    let mut trace = Replay::open(&args.trace)?;
    let folder = args.out.as_deref();
    let begin = |out| ResultFolder::of_study_with(out, &FILES, &BESIDES, &CSV_HEADER);
    let folder = folder.map(begin).transpose()?;
    let mut progress = (configs[0].unit, Progress::new(quiet, ""));
    let watch = |unit: tessim::config::Unit, command: &_| {
        if progress.0 != unit {
            progress = (unit, Progress::new(quiet, &format!("{}: ", unit.name())));
        }
        progress.1.command(command);
    };
    let compared = pool.install(|| compare::run(&mut trace, &configs, args.samples, watch))?;
    drop(progress);
    let Comparison { header, runs, reader } = compared;
    let provenance = provenance(header, &reader)?;
    let roofs = || pool.install(|| roofline::run(&mut trace, &configs));
    let roofs = args.roofline.then(roofs).transpose()?;
    if let Some(folder) = folder {
        folder.write("compare.csv", compare::csv(&runs).as_bytes())?;
        folder.write("frames.csv", compare::frames(&runs).as_bytes())?;
        folder.write("config.toml", configs[0].to_commented_toml().as_bytes())?;
        let reports: Vec<_> = runs.iter().map(|run| &run.report).collect();
        folder.write("summary.json", summary::comparison(&reports, &provenance).as_bytes())?;
        if let Some(roofs) = &roofs {
            folder.write("roofline.csv", roofline::csv(roofs).as_bytes())?;
            folder.write("roofline.svg", roofline::svg(roofs)?.as_bytes())?;
        }
        #[cfg(feature = "gpu")]
        if let Some(style) = args.wanted.pictures {
            let (frame, size) = (args.wanted.frame.unwrap_or(0), args.wanted.size);
            let sheet = || pictures::sheet(&mut trace, &configs, frame, style, size);
            let sheet = pool.install(sheet)?;
            folder.write("pictures.png", &sheet)?;
        }
        folder.commit()?;
    }
    if quiet {
        return Ok(());
    }
    let roofs = roofs.map_or_else(String::new, |roofs| format!("\n{}", roofline::text(&roofs)));
    print::print(&(compare::text(&runs, &provenance.title) + &roofs))
}

impl Args {
    /// One a unit, in order, the same but for the unit.
    fn configurations(&self) -> Result<Vec<Config>> {
        let layers = self.laid.layers()?;
        let units = compare::units(&self.units)?.into_iter();
        let configs = units.map(|unit| {
            let config = layers.for_unit(unit)?;
            Ok(Config { engine: self.engine.unwrap_or(config.engine), ..config })
        });
        configs.collect()
    }
}
