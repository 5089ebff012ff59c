//! Every key of the configuration: what it means, its unit and range, and what holds when it is
//! absent.
//!
//! One table serves `--set`, the TOML reader, its messages and the commented print-out, so that
//! none of them can know a key that the others do not. Tests hold it against the types.

/// A key and what is to be said of it.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// The dotted path that `--set` takes.
    pub path: &'static str,
    /// Meaning, with its unit.
    pub meaning: &'static str,
    /// The values that it takes.
    pub expected: &'static str,
    /// For a key that may be absent: an example value, and what holds without it.
    pub absent: Option<(&'static str, &'static str)>,
}

const ROUNDING: &str = "floor, nearest_up, nearest_even or nearest_away";

/// All keys, in the order of the file: tables after plain keys, in the order of the data.
pub const KEYS: &[Key] = &[
    key("unit", "the unit that runs", "hybrid or triangles"),
    key("engine", "what lays time over the blocks", "none (timed and stepped do not exist yet)"),
    key("clock_mhz", "the unit's clock in MHz: cycles do not depend on it", "1..=100000"),
    key("position.width", "bits of a coordinate behind the port, with its sign", "8..=48"),
    key("position.rounding", "how the port rounds", ROUNDING),
    key(
        "position.overflow",
        "what the port, evaluate and emit do with values that do not fit",
        "wrap or saturate",
    ),
    optional(
        "position.clip_range_log2",
        "log2 of the largest magnitude that the port expects in clip space",
        "-126..=127",
        ("4", "the trace's range, else the largest w on the far plane"),
    ),
    optional(
        "level.criterion",
        "overrides the trace's criterion; goes with its number",
        "flatness (pixels), edge_length (pixels) or fixed (level)",
        ("\"flatness\"", "the trace's; `level` alone means fixed, `pixels` alone means flatness"),
    ),
    optional(
        "level.pixels",
        "tolerance of flatness, or segment length of edge_length, in pixels",
        "a number > 0, at most 65535",
        ("0.5", "the trace's"),
    ),
    optional(
        "level.level",
        "the level of fixed, in segments per whole edge",
        "a number from 1 to 128",
        ("8.0", "the trace's"),
    ),
    optional(
        "level.min_level",
        "least level, in segments per whole edge",
        "a number from 1 to 128, at most max_level",
        ("1.0", "the trace's"),
    ),
    optional(
        "level.max_level",
        "greatest level, in segments per whole edge",
        "a number from 1 to 128, at least min_level",
        ("64.0", "the trace's"),
    ),
    optional(
        "level.near",
        "edges with a point of smaller w get the greatest level; in units of w",
        "a number > 0",
        ("0.1", "w on the near plane"),
    ),
    key("clip.enabled", "remove patches wholly outside one clip plane", "true or false"),
    key("backface.method", "the back-face test", "off, net_facets or tangent_plane"),
    key("evaluate.scheme", "how points are computed", "forward, mixed or de_casteljau"),
    optional(
        "evaluate.guard",
        "guard bits of the forward-difference accumulators",
        "1..=52, with position.width + guard + 3 <= 63",
        ("20", "min(20, 60 - position.width)"),
    ),
    key("evaluate.rounding", "how an evaluated point is rounded", ROUNDING),
    key("evaluate.normals", "what the vertex shader gets to light with", "off or tangent_plane"),
    key("emit.divide", "divide by w and snap to the sub-pixel grid", "true or false"),
    key("emit.subpixel_bits", "fraction bits of a screen coordinate", "0..=12"),
    key("emit.rounding", "how a screen coordinate is rounded", ROUNDING),
    key("emit.vertex_bytes", "bytes of a vertex record that leaves the unit", "1..=65536"),
    key("emit.index_bytes", "bytes of a triangle index that leaves the unit", "1..=8"),
    key("vertex_shader.bytes_in", "bytes read for a vertex, normals not included", "0..=65536"),
    key("vertex_shader.bytes_in_normal", "bytes read for a vertex's tangent plane", "0..=65536"),
    key("vertex_shader.bytes_out", "bytes written for a vertex", "0..=65536"),
    key(
        "link.payload",
        "largest payload of a packet in bytes; 0: not packetised",
        "0..=65536; 0 only with header 0",
    ),
    key("link.header", "framing of a packet in bytes", "0..=65536; 0 where payload is 0"),
    key("memory.burst", "bytes of a memory burst", "1..=65536"),
    key("triangles.vertex_bytes", "bytes of a vertex on the link, unit triangles", "1..=65536"),
];

const fn key(path: &'static str, meaning: &'static str, expected: &'static str) -> Key {
    Key { path, meaning, expected, absent: None }
}

const fn optional(
    path: &'static str,
    meaning: &'static str,
    expected: &'static str,
    absent: (&'static str, &'static str),
) -> Key {
    Key { path, meaning, expected, absent: Some(absent) }
}

/// The key at `path`.
#[must_use]
pub fn find(path: &str) -> Option<&'static Key> {
    KEYS.iter().find(|key| key.path == path)
}

/// The key whose path comes nearest to `path`: as a whole, or by its last part alone.
#[must_use]
pub fn nearest(path: &str) -> &'static str {
    let last = |path: &'static str| path.rsplit('.').next().unwrap_or(path);
    let distance = |known: &'static str| {
        let whole = strsim::jaro_winkler(path, known);
        let part = strsim::jaro_winkler(path, last(known));
        whole.max(part)
    };
    // The first of equals, so that the answer does not depend on how ties are broken.
    let mut best = KEYS[0].path;
    for key in &KEYS[1..] {
        if distance(key.path) > distance(best) {
            best = key.path;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;
    use crate::config::layers::Layers;

    #[test]
    fn the_table_and_the_types_have_the_same_keys() {
        // Every key of the table can be set, each at its current or example value.
        for key in KEYS {
            let printed = toml::Value::try_from(Config::default()).expect("plain data");
            let value = key.path.split('.').try_fold(&printed, |table, part| table.get(part));
            let value = match (value, key.absent) {
                (Some(value), _) => value.to_string(),
                (None, Some((example, _))) => example.to_owned(),
                (None, None) => panic!("{} is absent from the default configuration", key.path),
            };
            let mut layers = Layers::new(crate::config::preset::Preset::Modern);
            layers.set(&[format!("{}={value}", key.path)]).unwrap();
        }
        // Every key of the types is in the table: the default configuration prints no other.
        let printed = toml::Table::try_from(Config::default()).unwrap();
        for (name, value) in &printed {
            match value {
                toml::Value::Table(table) => {
                    assert!(table.keys().all(|key| find(&format!("{name}.{key}")).is_some()));
                }
                _ => assert!(find(name).is_some()),
            }
        }
    }

    #[test]
    fn the_values_that_an_enum_takes_are_listed() {
        for key in KEYS.iter().filter(|key| key.expected.contains(" or ")) {
            let words = key.expected.split(['(', ')']).step_by(2).collect::<String>();
            let words = words.replace(" or ", ",");
            for word in words.split(',').map(str::trim).filter(|w| !w.contains(' ')) {
                let mut layers = Layers::new(crate::config::preset::Preset::Modern);
                let set = layers.set(&[format!("{}={word}", key.path)]);
                assert!(set.is_ok(), "{}={word}: {set:?}", key.path);
            }
        }
    }

    #[test]
    fn a_misspelt_key_finds_its_neighbour() {
        assert_eq!(nearest("position.widht"), "position.width");
        assert_eq!(nearest("width"), "position.width");
        assert_eq!(nearest("level.pixel"), "level.pixels");
        assert_eq!(nearest("backface"), "backface.method");
    }
}
