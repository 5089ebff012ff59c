//! A device, traces, and pictures of them.

use std::path::PathBuf;
use std::sync::OnceLock;
use tessim::config::Config;
use tessim::config::layers::Layers;
use tessim::config::preset::Preset;
use tessim::gpu::render::{Image, Look, Paint, draw};
use tessim::gpu::{Backend, Device, Sources};
use tessim::study::picture::{Shot, Style, scale};
use tessim::trace::open::Trace;

/// The device of all tests; `None`, with a line that says so, where there is none.
pub(crate) fn device() -> Option<&'static Device> {
    static DEVICE: OnceLock<Option<Device>> = OnceLock::new();
    let device = DEVICE.get_or_init(|| match Device::open(Backend::Auto, Sources::default()) {
        Ok(device) => Some(device),
        Err(reason) => {
            println!("SKIPPED pictures: {reason}");
            None
        }
    });
    device.as_ref()
}

/// A file of the repository.
pub(crate) fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// A shipped trace.
pub(crate) fn trace(name: &str) -> PathBuf {
    path("traces").join(format!("{name}.jsonl"))
}

/// The default configuration with these settings over it.
pub(crate) fn config(settings: &[&str]) -> Config {
    let mut layers = Layers::new(Preset::default());
    let settings: Vec<String> = settings.iter().map(|setting| (*setting).to_owned()).collect();
    layers.set(&settings).unwrap();
    layers.finish().unwrap()
}

/// A frame of a shipped trace.
pub(crate) fn shot(name: &str, frame: u64, settings: &[&str]) -> Shot {
    Shot::take(&mut Trace::open(trace(name)).unwrap(), &config(settings), frame).unwrap()
}

/// How a style is painted.
pub(crate) fn look(shot: &Shot, style: Style, size: [u32; 2]) -> Look {
    let paint = match style {
        Style::Shaded => Paint::Shaded,
        Style::Wireframe => Paint::Wireframe,
        _ => Paint::Map(scale(style, &shot.measured(style))),
    };
    Look::new(paint, size)
}

/// Its picture, without a legend.
pub(crate) fn picture(device: &Device, shot: &Shot, style: Style, size: [u32; 2]) -> Image {
    draw(device, &shot.facets(style, size), &look(shot, style, size), size, None).unwrap()
}
