//! `render`: a frame of a trace through a unit, as a picture.

use super::config::Layered;
use super::print;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::{Path, PathBuf};
use tessim::error::Result;
use tessim::gpu::render::{self, Look, Paint, SIZE_MAX, Scale};
use tessim::gpu::{Backend, Device, Sources};
use tessim::output::picture::{self, Bar, Canvas, Legend, grouped};
use tessim::study::picture::{STYLES, Shot, Style, Taste, Values, scale};
use tessim::trace::open::Trace;

/// Draw a frame of a trace through a unit into a PNG
///
/// Triangles are those that the unit emitted, its roundings included; normals and the error map are
/// those of the true surface. Any adapter of Vulkan or OpenGL will do, a software one too.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim render traces/teapot.jsonl --out teapot.png\n  \
                        tessim render traces/teapot.jsonl --unit esc --style all --size 640x512 \
                        --out sheet.png")]
pub(crate) struct Args {
    /// The trace; - for standard input
    trace: PathBuf,
    #[command(flatten)]
    layered: Layered,
    /// The frame, from 0
    #[arg(long, value_name = "N", default_value_t = 0)]
    frame: u64,
    /// The picture; - for standard output
    #[arg(long, value_name = "P.png", default_value = "picture.png")]
    out: PathBuf,
    /// Width and height of what is drawn, in pixels, the legend below not included [default: the
    /// frame's viewport]
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<[u32; 2]>,
    /// What colours say; all for a sheet of every style
    #[arg(long, value_name = "S", value_parser = tastes(), default_value = "wireframe")]
    style: Taste,
    /// Draw in tiles of at most so many pixels a side, which gives the same bytes [default: 1024]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    tile: Option<u32>,
}

/// The names of all styles.
pub(super) fn tastes() -> impl TypedValueParser<Value = Taste> {
    PossibleValuesParser::new(STYLES.map(Style::name).into_iter().chain([Taste::ALL]))
        .map(|name| Taste::named(&name).expect("only names of styles are possible values"))
}

/// The names of single styles.
pub(super) fn styles() -> impl TypedValueParser<Value = Style> {
    PossibleValuesParser::new(STYLES.map(Style::name)).map(|name| {
        let style = STYLES.into_iter().find(|style| style.name() == name);
        style.expect("only names of styles are possible values")
    })
}

/// Width and height from a text.
pub(super) fn size(text: &str) -> std::result::Result<[u32; 2], String> {
    let sides: Vec<_> = text.split(['x', 'X']).map(str::parse::<u32>).collect();
    match sides[..] {
        [Ok(width), Ok(height)]
            if [width, height].iter().all(|side| (1..=SIZE_MAX).contains(side)) =>
        {
            Ok([width, height])
        }
        _ => Err(format!("expected WIDTHxHEIGHT, each from 1 to {SIZE_MAX}")),
    }
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let config = args.layered.configuration()?;
    let mut trace = Trace::open(&args.trace)?;
    let shot = Shot::take(&mut trace, &config, args.frame)?;
    let device = Device::open(Backend::Auto, Sources::default())?;
    let studio =
        Studio { device: &device, size: args.size.unwrap_or(shot.viewport()), tile: args.tile };
    let pictures = args
        .style
        .styles()
        .into_iter()
        .map(|style| studio.picture(&shot, style, shot.measured(style)));
    let pictures: Vec<Canvas> = pictures.collect::<Result<_>>()?;
    write(&Canvas::sheet(&pictures, COLUMNS), &args.out)
}

/// Pictures beside one another on a sheet.
pub(super) const COLUMNS: usize = 3;

/// Writes a PNG, which appears when it is complete.
fn write(canvas: &Canvas, path: &Path) -> Result<()> {
    print::bytes_to_file_or_stdout(path, |out| picture::write(canvas, out))
}

/// Where pictures are made, and how large.
pub(super) struct Studio<'a> {
    pub(super) device: &'a Device,
    pub(super) size: [u32; 2],
    pub(super) tile: Option<u32>,
}

impl Studio<'_> {
    /// A picture with its legend, its colours over these values.
    pub(super) fn picture(&self, shot: &Shot, style: Style, over: Values) -> Result<Canvas> {
        let scale = scale(style, &over);
        let paint = match style {
            Style::Shaded => Paint::Shaded,
            Style::Wireframe => Paint::Wireframe,
            Style::Level | Style::Error | Style::Area => Paint::Map(scale),
        };
        let look = Look::new(paint, self.size);
        let facets = shot.facets(style, self.size);
        let image = render::draw(self.device, &facets, &look, self.size, self.tile)?;
        Ok(legend(shot, style, scale).under(&Canvas::of(image.size, image.rgb)))
    }
}

fn legend(shot: &Shot, style: Style, scale: Scale) -> Legend {
    let Shot { title, unit, frame, .. } = shot;
    let [patches, triangles] = shot.counts().map(|count| grouped(count as u64));
    let mut details = format!("{patches} patches drawn, {triangles} triangles");
    let bar = style.quantity().map(|quantity| {
        let Values { least, mean, most, .. } = shot.measured(style);
        details += &match style {
            Style::Level => format!(", {least:.2} to {most:.2} segments, mean {mean:.2}"),
            Style::Error => format!(", largest {most:.3} px, mean of triangles {mean:.3} px"),
            _ => format!(", mean {mean:.2} px\u{b2}, largest {most:.0} px\u{b2}"),
        };
        let ends = [scale.least, scale.most];
        Bar { quantity: quantity.to_owned(), ends, log: scale.log, colour: render::colour }
    });
    let title = if title.is_empty() { "untitled" } else { title };
    let title = format!("{title}: unit {}, frame {frame}, {}", unit.name(), style.name());
    Legend { title, details, bar }
}
