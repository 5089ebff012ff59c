//! `study`: a question about a design and how thoroughly to look in, its table out.

mod motion;

use super::print;
use clap::Subcommand;
use clap::builder::RangedU64ValueParser;
use std::path::PathBuf;
use tessim::error::Result;
use tessim::output::folder::ResultFolder;
use tessim::study::backface::{self, CSV_HEADER, Options};

/// Carry out a study and print its table
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim study backface\n  \
                        tessim study motion --scene zoom --out result")]
pub(crate) struct Args {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
#[command(disable_help_subcommand = true)]
enum Study {
    Backface(Backface),
    Motion(motion::Args),
}

/// Back-face tests: what they drop, what they must not have dropped, and their operations
///
/// Newell's teapot, teacup and teaspoon from many views, and random patches, each from a view of
/// its own; then all of them with the viewer within a patch's convex hull. Prints Markdown; with
/// --out writes backface.csv: counts, and operations summed over the patches.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim study backface --views 20 --random 1000\n  \
                        tessim study backface --out result")]
struct Backface {
    /// Views of each model
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = number())]
    views: u32,
    /// Random patches
    #[arg(long, value_name = "N", default_value_t = 10_000, value_parser = number())]
    random: u32,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Some, and not more than anybody waits for.
fn number() -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(1..=10_000_000)
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    match &args.study {
        Study::Backface(args) => args.run(quiet),
        Study::Motion(args) => motion::run(args, quiet),
    }
}

impl Backface {
    fn run(&self, quiet: bool) -> Result<()> {
        let name = "backface.csv";
        let folder = self.out.as_deref();
        let folder =
            folder.map(|out| ResultFolder::of_study(out, name, &CSV_HEADER)).transpose()?;
        let options = Options { views: self.views as usize, random: self.random as usize };
        let rows = backface::run(options)?;
        if let Some(folder) = folder {
            folder.write(name, backface::csv(&rows).as_bytes())?;
            folder.commit()?;
        }
        if quiet { Ok(()) } else { print::print(&backface::text(&rows)) }
    }
}
