//! Layers: a preset, then a TOML file, then single settings, each over the one before. Out comes a
//! checked configuration, or an error that says where the offending key was set.
//!
//! A key is applied as soon as it is read, so that a wrong value is blamed on its own line. What
//! keys demand of each other is checked at the end, when the last layer has spoken.

use super::preset::Preset;
use super::{Config, Unit, keys, link};
use crate::error::{Error, Place, Result};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use toml::de::{DeTable, DeValue};
use toml::{Table, Value};

/// A configuration under construction.
#[derive(Clone, Debug)]
pub struct Layers {
    config: Config,
    /// Where each key that is not the preset's was last set.
    origins: BTreeMap<&'static str, Origin>,
}

/// A key's value in a file that is no configuration itself, such as a study, and where it stands.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The key.
    pub key: &'static keys::Key,
    /// Its value, of whatever kind.
    pub value: Value,
    /// Where it stands.
    pub place: Place,
}

#[derive(Clone, Debug)]
enum Origin {
    File { file: String, place: Place },
    Setting(String),
}

impl Origin {
    fn error(&self, message: String) -> Error {
        match self {
            Self::File { file, place } => {
                Error::Input { file: file.clone(), place: place.clone(), message }
            }
            Self::Setting(setting) => Error::Usage(format!("--set {setting}: {message}")),
        }
    }
}

impl Layers {
    /// The bottom layer.
    #[must_use]
    pub fn new(preset: Preset) -> Self {
        Self { config: preset.config(), origins: BTreeMap::new() }
    }

    /// Lays the TOML `text` of `file` over what there is.
    ///
    /// # Errors
    /// [`Error::Input`] with line and column: no TOML, an unknown key, a value of the wrong kind.
    pub fn file(&mut self, file: &str, text: &str) -> Result<()> {
        let at = |offset: usize, message: String| Error::Input {
            file: file.to_owned(),
            place: place(text, offset),
            message,
        };
        let table = DeTable::parse(text).map_err(|error| {
            at(error.span().map_or(0, |span| span.start), error.message().to_owned())
        })?;
        let mut leaves = Vec::new();
        flatten(&mut leaves, "", table.get_ref());
        let mut settings = Vec::new();
        for leaf in leaves {
            let key = known(&leaf.path).map_err(|message| at(leaf.key.start, message))?;
            let value = text[leaf.value.clone()].parse::<Value>();
            let value = value.map_err(|error| at(leaf.value.start, error.message().to_owned()))?;
            let place = place(text, leaf.value.start);
            settings.push((key, value, Origin::File { file: file.to_owned(), place }));
        }
        self.lay(settings)
    }

    /// Lays settings `key=value` over what there is, the later over the earlier. A value is TOML,
    /// or a bare word for a string.
    ///
    /// # Errors
    /// [`Error::Usage`]: no `=`, an unknown key, a value of the wrong kind.
    pub fn set(&mut self, settings: &[String]) -> Result<()> {
        let mut layer = Vec::new();
        for setting in settings {
            let origin = Origin::Setting(setting.clone());
            let Some((path, value)) = setting.split_once('=') else {
                return Err(origin.error("expected key=value".to_owned()));
            };
            let key = known(path.trim()).map_err(|message| origin.error(message))?;
            let value = value.trim();
            let value = value.parse().unwrap_or_else(|_| Value::String(value.to_owned()));
            layer.push((key, value, origin));
        }
        self.lay(layer)
    }

    /// Lays values that stand in `file` over what there is.
    ///
    /// # Errors
    /// [`Error::Input`] with line and column: a value of the wrong kind.
    pub fn values(&mut self, file: &str, values: &[Placed]) -> Result<()> {
        let placed = values.iter().cloned().map(|Placed { key, value, place }| {
            (key, value, Origin::File { file: file.to_owned(), place })
        });
        self.lay(placed.collect())
    }

    /// The effective configuration.
    ///
    /// # Errors
    /// A key out of its range, or keys that contradict each other.
    pub fn finish(self) -> Result<Config> {
        self.check()?;
        Ok(self.config.effective())
    }

    /// The configuration of another unit under the same layers. What follows from the unit where
    /// nobody set it is left open, so that the text of one unit's serves for all of them.
    ///
    /// # Errors
    /// As [`Self::finish`].
    pub fn for_unit(&self, unit: Unit) -> Result<Config> {
        let mut layers = self.clone();
        layers.config.unit = unit;
        layers.check()?;
        Ok(layers.config)
    }

    fn check(&self) -> Result<()> {
        self.config.problem().map_err(|problem| match self.origins.get(problem.key) {
            Some(origin) => origin.error(format!("{}: {}", problem.key, problem.message)),
            None => Error::from(problem),
        })
    }

    /// One layer, its values applied one by one.
    fn lay(&mut self, mut settings: Vec<(&'static keys::Key, Value, Origin)>) -> Result<()> {
        let sets = |path: &str| settings.iter().any(|(key, _, _)| key.path == path);
        self.forget_other_criterion(&sets, &settings);
        // A bus takes the place of the numbers of the layers below; those beside it win.
        settings.sort_by_key(|(key, _, _)| key.path != "link.bus");
        for (key, value, origin) in settings {
            let found = snippet(&value.to_string());
            let mut table = Table::try_from(&self.config).expect("a configuration is plain data");
            let hint = hint(key, &value);
            insert(&mut table, key.path, value);
            self.config = table.try_into().map_err(|_| {
                let expected = key.expected;
                origin.error(format!("{}: found {found}, expected {expected}{hint}", key.path))
            })?;
            if let Some(bus) = self.config.link.bus.filter(|_| key.path == "link.bus") {
                self.config.link.take(bus);
                self.origins.extend(link::OF_BUS.map(|path| (path, origin.clone())));
            }
            self.origins.insert(key.path, origin);
        }
        Ok(())
    }

    /// A criterion and its number are one setting: a layer that gives one of them takes back what
    /// the layers below said to the contrary, so that `--set level.level=8` works over any file.
    fn forget_other_criterion(
        &mut self,
        sets: &impl Fn(&str) -> bool,
        settings: &[(&'static keys::Key, Value, Origin)],
    ) {
        let level = &mut self.config.level;
        let given = settings.iter().rev().find(|(key, _, _)| key.path == "level.criterion");
        let fixed = match given {
            Some((_, value, _)) => value.as_str() == Some("fixed"),
            None if sets("level.level") => true,
            None if sets("level.pixels") => false,
            None => return,
        };
        if (level.chosen() == Some(super::Criterion::Fixed)) != fixed {
            level.criterion = None;
        }
        if fixed {
            level.pixels = None;
        } else {
            level.level = None;
        }
    }
}

/// The text of a file of settings.
///
/// # Errors
/// A file that cannot be read, or that is no UTF-8.
pub fn text_of(path: &Path) -> Result<String> {
    let bytes = std::fs::read(path).map_err(|error| Error::system(path, error))?;
    String::from_utf8(bytes).map_err(|error| Error::Input {
        file: path.display().to_string(),
        place: Place::Byte(error.utf8_error().valid_up_to() as u64),
        message: "expected UTF-8".to_owned(),
    })
}

/// A value in a TOML file: its dotted path, and where key and value stand.
struct Leaf {
    path: String,
    key: Range<usize>,
    value: Range<usize>,
}

fn flatten(leaves: &mut Vec<Leaf>, prefix: &str, table: &DeTable<'_>) {
    for (key, value) in table {
        let path = format!("{prefix}{}", key.get_ref());
        match value.get_ref() {
            // An empty table says nothing; its name is checked all the same.
            DeValue::Table(inner) if is_section(&path) => {
                flatten(leaves, &format!("{path}."), inner);
            }
            _ => leaves.push(Leaf { path, key: key.span(), value: value.span() }),
        }
    }
}

fn is_section(path: &str) -> bool {
    keys::KEYS.iter().any(|key| key.path.strip_prefix(path).is_some_and(|p| p.starts_with('.')))
}

/// The key at `path`.
///
/// # Errors
/// For a path that no key has: what was probably meant.
pub(crate) fn known(path: &str) -> Result<&'static keys::Key, String> {
    keys::find(path).ok_or_else(|| {
        let nearest = keys::nearest(path);
        let path = snippet(path);
        format!("unknown key `{path}`; did you mean `{nearest}`? (see `tessim config`)")
    })
}

/// What was probably meant, where the names are too many to be listed.
fn hint(key: &keys::Key, value: &Value) -> String {
    match value.as_str() {
        Some(name) if key.path == "link.bus" => {
            format!("; did you mean `{}`?", link::Bus::nearest(name))
        }
        _ => String::new(),
    }
}

fn insert(table: &mut Table, path: &str, value: Value) {
    match path.split_once('.') {
        None => {
            table.insert(path.to_owned(), value);
        }
        Some((section, rest)) => {
            let inner = table.entry(section).or_insert_with(|| Value::Table(Table::new()));
            let inner = inner.as_table_mut().expect("the table of keys has sections only");
            insert(inner, rest, value);
        }
    }
}

/// Line and column, both from 1, of a byte offset.
pub(crate) fn place(text: &str, offset: usize) -> Place {
    let before = &text.as_bytes()[..offset.min(text.len())];
    let line = before.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
    let column = before.iter().rev().take_while(|&&byte| byte != b'\n').count() + 1;
    Place::Line { line, column }
}

/// What is quoted from input is cut, as in traces.
pub(crate) fn snippet(text: &str) -> String {
    let text = text.replace('\n', " ");
    match text.char_indices().nth(200) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{Bus, Criterion, Unit};

    fn layered(file: &str, settings: &[&str]) -> Result<Config> {
        let mut layers = Layers::new(Preset::Modern);
        layers.file("c.toml", file)?;
        layers.set(&settings.iter().map(|&s| s.to_owned()).collect::<Vec<_>>())?;
        layers.finish()
    }

    fn message(file: &str, settings: &[&str]) -> String {
        layered(file, settings).expect_err("refused").to_string()
    }

    #[test]
    fn later_layers_win() {
        let config = layered(
            "unit = \"triangles\"\n[position]\nwidth = 24\n[link]\npayload = 64\n",
            &["position.width=16", "position.width=20", "backface.method=off"],
        )
        .unwrap();
        assert_eq!(config.position.width, 20);
        assert_eq!((config.link.payload, config.link.header), (64, 24));
        assert_eq!(config.unit, Unit::Triangles);
        assert_eq!(config.evaluate.guard, Some(20));
    }

    #[test]
    fn errors_name_the_place_the_key_and_its_neighbour() {
        let unknown = message("[position]\n  widht = 24\n", &[]);
        assert!(unknown.starts_with("c.toml:2:3: unknown key `position.widht`"), "{unknown}");
        assert!(unknown.contains("`position.width`"), "{unknown}");
        let kind = message("[position]\nwidth = \"wide\"\n", &[]);
        assert_eq!(kind, "c.toml:2:9: position.width: found \"wide\", expected 8..=48");
        let range = message("position = { width = 99 }", &[]);
        assert_eq!(range, "c.toml:1:22: position.width: found 99, expected 8..=48");
        assert!(message("position = \n", &[]).starts_with("c.toml:1:1"));
        assert!(message("[[position]]\nwidth = 9\n", &[]).starts_with("c.toml:1:3: unknown"));
        assert!(message("position = 3\n", &[]).starts_with("c.toml:1:1: unknown"));
        let set = message("", &["backface.method=maybe"]);
        assert!(set.starts_with("--set backface.method=maybe: backface.method: found \"maybe\""));
        assert!(message("", &["emit.divides=true"]).contains("`emit.divide`"));
        assert!(message("", &["emit.divide"]).contains("key=value"));
        let engine = message("", &["engine=tmied"]);
        assert!(engine.contains("found \"tmied\", expected timed, stepped or none"), "{engine}");
        let block = message("[block.stitch]\n  fiof = 2\n", &[]);
        assert!(block.starts_with("c.toml:2:3: unknown key `block.stitch.fiof`"), "{block}");
        assert!(block.contains("`block.stitch.fifo`"), "{block}");
        let fifo = message("[block.stitch]\nfifo = 0\n", &[]);
        assert!(fifo.starts_with("c.toml:2:8: block.stitch.fifo: found 0, expected 1..=65536;"));
        assert!(message("", &["position.width=-1"]).contains("found -1, expected 8..=48"));
    }

    #[test]
    fn a_number_alone_chooses_its_criterion_and_replaces_the_one_below() {
        let file = "[level]\ncriterion = \"edge_length\"\npixels = 4\n";
        let fixed = layered(file, &["level.level=8"]).unwrap().level;
        assert_eq!((fixed.criterion, fixed.pixels), (Some(Criterion::Fixed), None));
        let length = layered(file, &["level.pixels=9"]).unwrap().level;
        assert_eq!(length.criterion, Some(Criterion::EdgeLength));
        let flat = layered("level.level = 4\n", &["level.pixels=1"]).unwrap().level;
        assert_eq!((flat.criterion, flat.level), (Some(Criterion::Flatness), None));
        assert!(layered(file, &["level.criterion=fixed"]).is_err());
        assert!(layered("", &["level.pixels=1", "level.level=2"]).is_err());
    }

    #[test]
    fn a_bus_replaces_the_layers_below_and_yields_to_the_keys_beside_it() {
        let file = "[link]\npayload = 64\nheader = 8\nlatency = 77\n";
        let link = layered(file, &["link.bus=agp4x"]).unwrap().link;
        assert_eq!((link.payload, link.header, link.bandwidth_mb_s), (0, 0, 1066));
        assert_eq!((link.latency, link.bus), (77, Some(Bus::AGP4X)));
        // In any order within a layer; and then the bus is none that has a name.
        for settings in
            [["link.bus=pcie2x16", "link.payload=64"], ["link.payload=64", "link.bus=pcie2x16"]]
        {
            let link = layered("", &settings).unwrap().link;
            assert_eq!((link.payload, link.bandwidth_mb_s, link.bus), (64, 8000, None));
        }
        let above = layered("link.bus = \"pcie2x16\"\n", &["link.payload=64"]).unwrap().link;
        assert_eq!((above.payload, above.bandwidth_mb_s, above.bus), (64, 8000, None));
        let unknown = message("[link]\nbus = \"pci4x16\"\n", &[]);
        assert!(unknown.starts_with("c.toml:2:7: link.bus: found \"pci4x16\", expected agp1x,"));
        assert!(unknown.ends_with("did you mean `pcie4x16`?"), "{unknown}");
        assert!(message("", &["link.bus=16"]).contains("link.bus: found 16, expected agp1x,"));
        // What a bus set is blamed on the bus, and what stands beside it on its own place.
        let blamed = message("link.header = 8\n", &["link.bus=pcie2x16", "link.payload=0"]);
        assert!(blamed.starts_with("--set link.bus=pcie2x16: link.header: found 24"), "{blamed}");
        let blamed = message("[link]\nheader = 8\nbus = \"agp8x\"\n", &[]);
        assert!(blamed.starts_with("c.toml:2:10: link.header: found 8 with payload 0"), "{blamed}");
    }
}
