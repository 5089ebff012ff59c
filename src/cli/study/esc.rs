//! `study esc`: the tables and claims of Concheiro et al. 2014, measured again.

use super::{folder, up_to};
use crate::cli::config::Laid;
use crate::cli::print;
use clap::builder::{PossibleValuesParser, RangedU64ValueParser, TypedValueParser};
use clap::{Args, Subcommand};
use std::path::PathBuf;
use tessim::config::Config;
use tessim::config::layers::text_of;
use tessim::config::preset::Preset;
use tessim::error::Result;
use tessim::study::energy::Prices;
use tessim::study::esc::{Scene, error, triangles, work};
use tessim::trace::scene::newell::Newell;

/// ESC: the tables and claims of Concheiro et al. 2014, measured again
///
/// Nothing is clipped or culled: the paper counts all patches. docs/esc.md has the figures and what
/// agrees with the paper.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  tessim study esc triangles --cups 10 --elephants 2\n  \
                        tessim study esc work --levels 1..4 --out result")]
pub(super) struct EscArgs {
    #[command(subcommand)]
    study: Study,
}

#[derive(Debug, Subcommand)]
#[command(disable_help_subcommand = true)]
enum Study {
    Triangles(EscTriangles),
    Error(EscError),
    Work(EscWork),
}

/// Table 1: triangles of two scenes, uniform and adaptive, over the threshold mu
///
/// Both readings of "control mesh", distances in pixels and in object units; then the one mu at
/// which both scenes come nearest to the paper's rows. Prints Markdown; with --out writes
/// triangles.csv and triangles.svg.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  tessim study esc triangles --cups 10 --elephants 2\n  \
                        tessim study esc triangles --frames 10 --density 4 --out result")]
struct EscTriangles {
    /// Teacups, 26 patches each; the paper has 100
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = up_to(10_000))]
    cups: u32,
    /// Elephants, 811 patches each, of a shape of our own; the paper has 10
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = up_to(1_000))]
    elephants: u32,
    /// Frames of the walk; in object units one is enough
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = up_to(1_000))]
    frames: u32,
    /// The level of resolution
    #[arg(long, value_name = "L", default_value_t = 3, value_parser = level())]
    level: u32,
    /// Thresholds for each octave of mu
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = up_to(64))]
    density: u32,
    #[command(flatten)]
    laid: Laid,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Figure 7: how far the true surface is from its triangles, at equal counts
///
/// ESC by both readings and in both spaces, its uniform pattern, d3d11 with a factor for each edge
/// by the same test, and with one for all. Prints Markdown; with --out writes error.csv, error.svg
/// and mean.svg.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  tessim study esc error --targets 6,9 --samples 16\n  \
                        tessim study esc error --model teapot --level 7 --targets 12,18 \
                        --out result")]
struct EscError {
    /// The model
    #[arg(long, value_name = "NAME", default_value = "teacup", value_parser = models())]
    model: String,
    /// Counts to meet: those of grids of so many segments, 3 to 48
    #[arg(long, value_name = "N,..", value_delimiter = ',', default_value = "5,6,7,8,9,10,11,12")]
    #[arg(value_parser = RangedU64ValueParser::<u32>::new().range(3..=48))]
    targets: Vec<u32>,
    /// The level of resolution of the adaptive ways
    #[arg(long, value_name = "L", default_value_t = 3)]
    #[arg(value_parser = RangedU64ValueParser::<u32>::new().range(1..=15))]
    level: u32,
    /// Segments between the samples of a patch along each direction
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = up_to(1_000))]
    samples: u32,
    #[command(flatten)]
    laid: Laid,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// Invocations, reads, operations, energy and cycles of ESC and of domain shaders, over L
///
/// Teacups with uniform patterns of the same triangles; equal shader processors, whose programs are
/// counted in the same instructions. Prints Markdown; with --out writes work.csv and work.svg.
/// Energy: prices of 45 nm (Horowitz 2014), each of which a TOML file can change: integer_add_bit,
/// integer_mul_bit2, integer_compare_bit, single_add, single_mul, single_compare, chip_byte,
/// memory_byte, invocation, in picojoules.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  tessim study esc work --levels 1..4 --cups 10\n  \
                        tessim study esc work --preset hd6970 --processors 1,4,24 --out result")]
struct EscWork {
    /// Teacups, 26 patches each
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = up_to(10_000))]
    cups: u32,
    /// Levels from the least to the greatest
    #[arg(long, value_name = "A..B", default_value = "1..15", value_parser = levels)]
    levels: Levels,
    /// Shader processors of 16 lanes [default: 1 and those of the preset]
    #[arg(long, value_name = "N,..", value_delimiter = ',', value_parser = up_to(256))]
    processors: Vec<u32>,
    /// Prices of energy that differ, a TOML file
    #[arg(long, value_name = "F.toml")]
    energy: Option<PathBuf>,
    #[command(flatten)]
    laid: Laid,
    /// Write the results into this folder; one that exists is replaced only if this study wrote it
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

/// The least and the greatest level.
#[derive(Clone, Copy, Debug)]
struct Levels([u32; 2]);

fn levels(text: &str) -> Result<Levels, String> {
    let most = work::LEVEL_MAX;
    let wrong = || format!("expected A..B, 0 <= A <= B <= {most}");
    let (least, greatest) = text.split_once("..").ok_or_else(wrong)?;
    let number = |text: &str| text.parse::<u32>().map_err(|_| wrong());
    let (least, greatest) = (number(least)?, number(greatest)?);
    if least <= greatest && greatest <= most { Ok(Levels([least, greatest])) } else { Err(wrong()) }
}

fn level() -> RangedU64ValueParser<u32> {
    RangedU64ValueParser::new().range(0..=15)
}

const MODELS: [(&str, Scene); 5] = [
    ("teapot", Scene::Model(Newell::Teapot)),
    ("teapot28", Scene::Model(Newell::Teapot28)),
    ("teacup", Scene::Model(Newell::Teacup)),
    ("teaspoon", Scene::Model(Newell::Teaspoon)),
    ("elephant", Scene::Elephants(1)),
];

fn models() -> impl TypedValueParser<Value = String> {
    PossibleValuesParser::new(MODELS.map(|(name, _)| name))
}

pub(super) fn run(args: &EscArgs, quiet: bool) -> Result<()> {
    match &args.study {
        Study::Triangles(args) => of_triangles(args, quiet),
        Study::Error(args) => of_error(args, quiet),
        Study::Work(args) => of_work(args, quiet),
    }
}

fn of_triangles(args: &EscTriangles, quiet: bool) -> Result<()> {
    const NAMES: [&str; 2] = ["triangles.csv", "triangles.svg"];
    let folder = folder(args.out.as_deref(), &NAMES, &triangles::CSV_HEADER)?;
    let base = args.laid.layers()?.finish()?;
    let &EscTriangles { cups, elephants, frames, level, density, .. } = args;
    let options = triangles::Options { cups, elephants, frames, level, density };
    let study = triangles::run(options, &base)?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], triangles::csv(&study).as_bytes())?;
        folder.write(NAMES[1], triangles::svg(&study)?.as_bytes())?;
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&triangles::text(&study)) }
}

fn of_error(args: &EscError, quiet: bool) -> Result<()> {
    const NAMES: [&str; 3] = ["error.csv", "error.svg", "mean.svg"];
    let folder = folder(args.out.as_deref(), &NAMES, &error::CSV_HEADER)?;
    let base = args.laid.layers()?.finish()?;
    let model = MODELS.iter().find(|(name, _)| *name == args.model);
    let scene = model.expect("only names of models are possible values").1;
    let mut targets = args.targets.clone();
    targets.sort_unstable();
    targets.dedup();
    let options = error::Options { scene, targets, level: args.level, segments: args.samples };
    let rows = error::run(&options, &base)?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], error::csv(&rows).as_bytes())?;
        folder.write(NAMES[1], error::svg(&rows)?.as_bytes())?;
        folder.write(NAMES[2], error::svg_of_means(&rows)?.as_bytes())?;
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&error::text(&rows)) }
}

fn of_work(args: &EscWork, quiet: bool) -> Result<()> {
    const NAMES: [&str; 2] = ["work.csv", "work.svg"];
    let folder = folder(args.out.as_deref(), &NAMES, &work::CSV_HEADER)?;
    let base = args.laid.layers_over(Preset::Hd5870)?.finish()?;
    let prices = match &args.energy {
        Some(path) => Prices::read(&path.display().to_string(), &text_of(path)?)?,
        None => Prices::default(),
    };
    let Levels(levels) = args.levels;
    let processors = args.processors(&base);
    let options = work::Options { cups: args.cups, levels, processors, prices };
    let rows = work::run(&options, &base)?;
    if let Some(folder) = folder {
        folder.write(NAMES[0], work::csv(&rows, &options).as_bytes())?;
        folder.write(NAMES[1], work::svg(&rows, &options)?.as_bytes())?;
        folder.commit()?;
    }
    if quiet { Ok(()) } else { print::print(&work::text(&rows, &options)) }
}

impl EscWork {
    /// As given, else one and as many as the machine has.
    fn processors(&self, base: &Config) -> Vec<u32> {
        if self.processors.is_empty() {
            let machine = base.block.surface.costs.lanes;
            return if machine == 1 { vec![1] } else { vec![1, machine] };
        }
        self.processors.clone()
    }
}
