//! `scene`: a name and options in, a generated trace out.

use super::print;
use clap::Subcommand;
use clap::builder::RangedI64ValueParser;
use rtl_model::level::Criterion as Quantised;
use rtl_model::patch::Level;
use std::io::{self, Write};
use std::path::PathBuf;
use tessim::config::{self, Config, Criterion};
use tessim::error::Result;
use tessim::trace::command::Tessellation;
use tessim::trace::scene::elephants::Elephants;
use tessim::trace::scene::grid::Grid;
use tessim::trace::scene::mesh::Mesh;
use tessim::trace::scene::model::Model;
use tessim::trace::scene::motion::{Kind as Moving, Motion};
use tessim::trace::scene::newell::Newell;
use tessim::trace::scene::primitives::{Kind, Primitives};
use tessim::trace::scene::rational::Rational;
use tessim::trace::scene::teacups::Teacups;

/// Write a trace of a generated scene
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  tessim scene grid --rows 100 --columns 100 | tessim run -\n  \
                        tessim scene teacups --count 25 --frames 10 --out cups.jsonl"
)]
pub(crate) struct Args {
    #[command(subcommand)]
    scene: Scene,
    /// Write into this file, which appears when it is complete [default: standard output]
    #[arg(long, value_name = "FILE", global = true)]
    out: Option<PathBuf>,
}

#[derive(Debug, Subcommand)]
#[command(disable_help_subcommand = true)]
enum Scene {
    /// The Utah teapot, 32 patches
    Teapot(Levels),
    /// The original teapot without a bottom, 28 patches
    Teapot28(Levels),
    /// Cup and saucer, 26 patches
    Teacup(Levels),
    /// The spoon, 16 patches
    Teaspoon(Levels),
    /// A mesh of 6 by 8 patches in two frames, each with its own criterion
    Mesh,
    /// An exact torus round an exact sphere: weights other than 1
    Rational(Levels),
    /// A ribbon: a strip of 12 patches with attributes
    Ribbon(Levels),
    /// Two domes: fans of 8 patches with attributes, compact and full
    Domes(Levels),
    /// Three rings: an indexed mesh of 32 patches with attributes, resident, in three instances
    Rings(Levels),
    /// Motion: a teapot crosses each plane of the frustum, in and out
    Crossing(Film),
    /// Motion: a teapot turns once
    Turning(Film),
    /// Motion: a look round inside a closed surface
    Inside(Film),
    /// Motion: a flight through 48 teapots
    Flythrough(Film),
    /// Motion: a teapot from one pixel to more than the screen
    Zoom(Film),
    /// A bumpy surface of as many patches as you like
    Grid {
        /// Patches along y
        #[arg(long, default_value_t = 32, value_parser = side())]
        rows: u32,
        /// Patches along x
        #[arg(long, default_value_t = 32, value_parser = side())]
        columns: u32,
        #[command(flatten)]
        levels: Levels,
    },
    /// A walk among teacups, instances of resident points
    Teacups {
        /// Cups, 26 patches each
        #[arg(long, default_value_t = 25, value_parser = number())]
        count: u32,
        /// Frames
        #[arg(long, default_value_t = 10, value_parser = number())]
        frames: u32,
        #[command(flatten)]
        levels: Levels,
    },
    /// A walk among elephants, closed bodies of small patches, instances of resident points
    Elephants {
        /// Elephants, 811 patches each
        #[arg(long, default_value_t = 10, value_parser = number())]
        count: u32,
        /// Frames
        #[arg(long, default_value_t = 10, value_parser = number())]
        frames: u32,
        #[command(flatten)]
        levels: Levels,
    },
}

/// Patches along a side: their product is the reader's concern, this keeps it within 64 bits.
fn side() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(1..=65536)
}

/// Cups and frames: far more than anybody waits for.
fn number() -> RangedI64ValueParser<u32> {
    clap::value_parser!(u32).range(1..=100_000)
}

/// A scene that moves.
#[derive(Debug, clap::Args)]
struct Film {
    /// Frames
    #[arg(long, default_value_t = Motion::FRAMES, value_parser = number())]
    frames: u32,
    #[command(flatten)]
    levels: Levels,
}

/// The tessellation command of a scene.
#[derive(Debug, clap::Args)]
struct Levels {
    /// How levels are chosen [default: fixed with --level, else flatness]
    #[arg(long, value_name = "C", value_parser = criterion)]
    criterion: Option<Criterion>,
    /// Pixels of flatness and edge_length
    #[arg(long, value_name = "X")]
    pixels: Option<f64>,
    /// The level of fixed, 1 to 128
    #[arg(long, value_name = "X")]
    level: Option<f64>,
    /// Least level [default: 1]
    #[arg(long, value_name = "X")]
    min_level: Option<f64>,
    /// Greatest level [default: 64]
    #[arg(long, value_name = "X")]
    max_level: Option<f64>,
}

fn criterion(name: &str) -> Result<Criterion, String> {
    serde_json::from_value(name.into())
        .map_err(|_| "expected flatness, edge_length or fixed".to_owned())
}

impl Levels {
    fn tessellation(&self) -> Result<Tessellation> {
        let default = Tessellation::default();
        let &Self { criterion, pixels, level, min_level, max_level } = self;
        let level = config::Level {
            criterion,
            pixels,
            level,
            min_level,
            max_level,
            ..config::Level::default()
        };
        // A trace has bounds even where it does not state them.
        let bounds = config::Level {
            min_level: Some(min_level.unwrap_or(1.0)),
            max_level: Some(max_level.unwrap_or(64.0)),
            ..level.clone()
        };
        Config { level: bounds, ..Config::default() }.check()?;
        // As the reader of traces does: to nearest, ties to even, at least one unit.
        let fx16 = |value: f64| ((value * 65536.0).round_ties_even() as u32).max(1);
        let pixels = fx16(pixels.unwrap_or(0.5));
        let criterion = match level.chosen() {
            None => default.criterion,
            Some(Criterion::Flatness) => Quantised::Flatness { pixels },
            Some(Criterion::EdgeLength) => Quantised::EdgeLength { pixels },
            Some(Criterion::Fixed) => {
                let level = level.level.expect("checked: fixed has its level");
                Quantised::Fixed { level: Level::clamped(fx16(level).into()) }
            }
        };
        Ok(Tessellation {
            criterion,
            min_level: min_level.map_or(default.min_level, fx16),
            max_level: max_level.map_or(default.max_level, fx16),
        })
    }
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let write = args.scene.writer()?;
    print::to_file_or_stdout(args.out.as_deref(), write)
}

impl Scene {
    /// What writes the scene. Its options are checked before anything is written.
    fn writer(&self) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()>> {
        type Writer = Box<dyn FnOnce(&mut dyn Write) -> io::Result<()>>;
        let model = |model, levels: &Levels| -> Result<Writer> {
            let model = Model { model, tessellation: levels.tessellation()? };
            Ok(Box::new(move |mut out| model.write(&mut out)))
        };
        let primitives = |kind, levels: &Levels| -> Result<Writer> {
            let scene = Primitives { kind, tessellation: levels.tessellation()? };
            Ok(Box::new(move |mut out| scene.write(&mut out)))
        };
        let motion = |kind, film: &Film| -> Result<Writer> {
            let tessellation = film.levels.tessellation()?;
            let motion = Motion { kind, frames: film.frames, tessellation };
            Ok(Box::new(move |mut out| motion.write(&mut out)))
        };
        match self {
            Self::Teapot(levels) => model(Newell::Teapot, levels),
            Self::Teapot28(levels) => model(Newell::Teapot28, levels),
            Self::Teacup(levels) => model(Newell::Teacup, levels),
            Self::Teaspoon(levels) => model(Newell::Teaspoon, levels),
            Self::Mesh => Ok(Box::new(|mut out| Mesh.write(&mut out))),
            Self::Rational(levels) => {
                let rational = Rational { tessellation: levels.tessellation()? };
                Ok(Box::new(move |mut out| rational.write(&mut out)))
            }
            Self::Ribbon(levels) => primitives(Kind::Ribbon, levels),
            Self::Domes(levels) => primitives(Kind::Domes, levels),
            Self::Rings(levels) => primitives(Kind::Rings, levels),
            Self::Crossing(film) => motion(Moving::Crossing, film),
            Self::Turning(film) => motion(Moving::Turning, film),
            Self::Inside(film) => motion(Moving::Inside, film),
            Self::Flythrough(film) => motion(Moving::Flythrough, film),
            Self::Zoom(film) => motion(Moving::Zoom, film),
            &Self::Grid { rows, columns, ref levels } => {
                let grid = Grid { rows, columns, tessellation: levels.tessellation()? };
                Ok(Box::new(move |mut out| grid.write(&mut out)))
            }
            &Self::Teacups { count, frames, ref levels } => {
                let cups = Teacups { count, frames, tessellation: levels.tessellation()? };
                Ok(Box::new(move |mut out| cups.write(&mut out)))
            }
            &Self::Elephants { count, frames, ref levels } => {
                let herd = Elephants { count, frames, tessellation: levels.tessellation()? };
                Ok(Box::new(move |mut out| herd.write(&mut out)))
            }
        }
    }
}
