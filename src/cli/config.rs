//! The flags that make a configuration, and `config`, which prints it.

use super::print;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::path::PathBuf;
use tessim::config::layers::{Layers, text_of};
use tessim::config::preset::Preset;
use tessim::config::{Config, Unit};
use tessim::error::Result;

/// Flags that make a configuration; each layer lies over the one before.
#[derive(Debug, clap::Args)]
pub(crate) struct Layered {
    /// The unit that runs; over all layers [default: hybrid]
    #[arg(long, value_name = "U", value_parser = units())]
    unit: Option<String>,
    #[command(flatten)]
    laid: Laid,
}

/// The flags that lay one layer over another, whatever the unit.
#[derive(Debug, clap::Args)]
pub(crate) struct Laid {
    /// The machine whose numbers are assumed [default: modern]
    #[arg(long, value_name = "P", value_parser = presets(), hide_default_value = true)]
    preset: Option<Preset>,
    /// A TOML file over the preset
    #[arg(long, value_name = "F.toml")]
    config: Option<PathBuf>,
    /// One setting over the file, such as position.width=24; may be repeated
    #[arg(long = "set", value_name = "key=value")]
    settings: Vec<String>,
}

/// The names of all units.
pub(crate) fn units() -> PossibleValuesParser {
    PossibleValuesParser::new(Unit::ALL.map(Unit::name))
}

fn presets() -> impl TypedValueParser<Value = Preset> {
    PossibleValuesParser::new(Preset::ALL.map(Preset::name))
        .map(|name| Preset::named(&name).expect("only names of presets are possible values"))
}

impl Layered {
    /// The effective configuration.
    pub(crate) fn configuration(&self) -> Result<Config> {
        let mut layers = self.laid.layers()?;
        if let Some(unit) = &self.unit {
            layers.set(&[format!("unit={unit}")])?;
        }
        layers.finish()
    }
}

impl Laid {
    /// What was laid.
    pub(crate) fn layers(&self) -> Result<Layers> {
        self.layers_over(Preset::default())
    }

    /// What was laid, over this preset where none was named.
    pub(crate) fn layers_over(&self, preset: Preset) -> Result<Layers> {
        let mut layers = Layers::new(self.preset.unwrap_or(preset));
        if let Some(path) = &self.config {
            layers.file(&path.display().to_string(), &text_of(path)?)?;
        }
        layers.set(&self.settings)?;
        Ok(layers)
    }
}

/// Print the effective configuration as commented TOML; `--set` takes its paths
///
/// The text reads back with `--config`. Layers: preset, then --config, then --set in order.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim config --preset gf3-2001\n  \
                        tessim config --set position.width=24 > narrow.toml")]
pub(crate) struct Args {
    #[command(flatten)]
    layered: Layered,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    print::print(&args.layered.configuration()?.to_commented_toml())
}
