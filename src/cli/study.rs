//! `study`: a question about a design and how thoroughly to look in, its table out.

mod esc;
mod motion;

use super::print;
use clap::Subcommand;
use clap::builder::RangedU64ValueParser;
use std::path::{Path, PathBuf};
use tessim::error::Result;
use tessim::output::folder::ResultFolder;
use tessim::study::{backface, bandwidth};

/// Carry out a study and print its table
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim study backface\n  \
                        tessim study bandwidth --levels 1..16 --out result")]
pub(crate) struct Args {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
#[command(disable_help_subcommand = true)]
enum Study {
    Backface(Backface),
    Bandwidth(Bandwidth),
    Esc(esc::EscArgs),
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

/// Bytes over the link: strips, fans and meshes of patches against their triangles
///
/// A flat surface at fixed levels, its bytes by the closed forms of Sfarti et al. 2005 and as runs
/// measure them, with colour and texture at the corners and without. Prints Markdown at the powers
/// of two; with --out writes bandwidth.csv (all levels, by kind) and bandwidth.svg.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim study bandwidth --levels 1..16\n  \
                        tessim study bandwidth --patches 100 --instances 10 --out result")]
struct Bandwidth {
    /// Levels from the least to the greatest; of these 1 and the even ones, which are reached
    #[arg(long, value_name = "A..B", default_value = "1..64", value_parser = levels)]
    levels: Levels,
    /// Patches of the surface; a mesh of them is as square as can be
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = up_to(65_536))]
    patches: u32,
    /// Instances of its one draw
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = up_to(1_000))]
    instances: u32,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// The least and the greatest level.
#[derive(Clone, Copy, Debug)]
struct Levels([u32; 2]);

fn levels(text: &str) -> Result<Levels, String> {
    let most = bandwidth::LEVEL_MAX;
    let wrong = || format!("expected A..B, 1 <= A <= B <= {most}, with 1 or an even number in it");
    let (least, greatest) = text.split_once("..").ok_or_else(wrong)?;
    let number = |text: &str| text.parse::<u32>().map_err(|_| wrong());
    let (least, greatest) = (number(least)?, number(greatest)?);
    let odd = least == greatest && least > 1 && least % 2 == 1;
    let fits = 1 <= least && least <= greatest && greatest <= most;
    if fits && !odd { Ok(Levels([least, greatest])) } else { Err(wrong()) }
}

fn up_to(most: u32) -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(1..=most.into())
}

/// Some, and not more than anybody waits for.
fn number() -> RangedU64ValueParser<u32> {
    up_to(10_000_000)
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    match &args.study {
        Study::Backface(args) => of_backface(args, quiet),
        Study::Bandwidth(args) => of_bandwidth(args, quiet),
        Study::Esc(args) => esc::run(args, quiet),
        Study::Motion(args) => motion::run(args, quiet),
    }
}

fn of_backface(args: &Backface, quiet: bool) -> Result<()> {
    const NAMES: [&str; 1] = ["backface.csv"];
    let folder = folder(args.out.as_deref(), &NAMES, &backface::CSV_HEADER)?;
    let options = backface::Options { views: args.views as usize, random: args.random as usize };
    let rows = backface::run(options)?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], backface::csv(&rows).as_bytes())?;
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&backface::text(&rows)) }
}

fn of_bandwidth(args: &Bandwidth, quiet: bool) -> Result<()> {
    const NAMES: [&str; 2] = ["bandwidth.csv", "bandwidth.svg"];
    let folder = folder(args.out.as_deref(), &NAMES, &bandwidth::CSV_HEADER)?;
    let Bandwidth { levels: Levels(levels), patches, instances, .. } = *args;
    let rows = bandwidth::run(bandwidth::Options { levels, patches, instances })?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], bandwidth::csv(&rows).as_bytes())?;
        folder.write(NAMES[1], bandwidth::svg(&rows)?.as_bytes())?;
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&bandwidth::text(&rows)) }
}

fn folder(
    out: Option<&Path>,
    names: &'static [&'static str],
    header: &'static [&'static str],
) -> Result<Option<ResultFolder>> {
    out.map(|out| ResultFolder::of_study(out, names, header)).transpose()
}
