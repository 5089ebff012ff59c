//! `study motion`: a trace or scenes that move in, their frames counted and checked out.

use crate::cli::config::Layered;
use crate::cli::print;
use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use std::path::PathBuf;
use tessim::error::Result;
use tessim::study::motion::{self, CSV_HEADER, Film};
use tessim::trace::command::Tessellation;
use tessim::trace::open::Trace;
use tessim::trace::scene::motion::{Kind, Motion};

/// Clipping and culling from frame to frame, and whether the golden models decide the same
///
/// Takes a trace, or scenes by name, through the unit and through its golden models. Prints
/// Markdown; with --out writes motion.csv. Ends with 1 where the two disagree about a patch.
/// Columns: to backface, patches that were not clipped; no front, of these, those of which no
/// sample faces the viewer; false, patches that were removed though a sample is in sight, quantised
/// and in f64.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim study motion --scene zoom --frames 40\n  \
                        tessim study motion traces/zoom.jsonl --set backface.method=normal_cone \
                        --out result")]
pub(super) struct Args {
    /// The trace; - for standard input
    #[arg(conflicts_with = "scenes")]
    trace: Option<PathBuf>,
    /// A scene of tessim scene; may be repeated [default without a trace: all five]
    #[arg(long = "scene", value_name = "NAME", value_parser = kinds())]
    scenes: Vec<Kind>,
    /// Frames of a scene [default: 24]
    #[arg(long, value_name = "N", value_parser = frames(), conflicts_with = "trace")]
    frames: Option<u32>,
    #[command(flatten)]
    layered: Layered,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

fn kinds() -> impl TypedValueParser<Value = Kind> {
    PossibleValuesParser::new(Kind::ALL.map(Kind::name))
        .map(|name| Kind::named(&name).expect("only names of scenes are possible values"))
}

/// Not more than anybody waits for.
fn frames() -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(1..=100_000)
}

pub(super) fn run(args: &Args, quiet: bool) -> Result<()> {
    const NAMES: [&str; 1] = ["motion.csv"];
    let folder = super::folder(args.out.as_deref(), &NAMES, &CSV_HEADER)?;
    let films = args.films()?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], motion::csv(&films).as_bytes())?;
        folder.commit()?;
    }
    if !quiet {
        print::print(&motion::text(&films))?;
    }
    motion::check(&films)
}

impl Args {
    fn films(&self) -> Result<Vec<Film>> {
        let config = self.layered.configuration()?;
        if let Some(path) = &self.trace {
            let reader = Trace::open(path)?;
            let commands = reader.map(|located| Ok(located?.command));
            return Ok(vec![motion::run(&path.display().to_string(), commands, &config)?]);
        }
        let all = &Kind::ALL[..];
        let kinds = if self.scenes.is_empty() { all } else { &self.scenes };
        let frames = self.frames.unwrap_or(Motion::FRAMES);
        let motion = |&kind| Motion { kind, frames, tessellation: Tessellation::default() };
        kinds.iter().map(|kind| motion::scene(motion(kind), &config)).collect()
    }
}
