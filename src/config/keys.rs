//! Every key of the configuration: what it means, its unit and range, and what holds when it is
//! absent.
//!
//! One table serves `--set`, the TOML reader, its messages and the commented print-out, so that
//! none of them can know a key that the others do not. Tests hold it against the types.

mod block;
mod esc;
mod triangles;

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

const BUSES: &str = "agp1x, agp2x, agp4x, agp8x or pcie4x16 (or another generation of 1 to 6 and \
                     1, 2, 4, 8 or 16 lanes)";
const BANDWIDTH: &str = "1..=10000000";
const CYCLES: &str = "0..=1000000";
const FIFO: &str =
    "1..=65536; at 0 nothing could ever move, and 1 halves throughput: credit is a cycle late";
const ROUNDING: &str = "floor, nearest_up, nearest_even or nearest_away";

/// All keys, in the order of the file: tables after plain keys, in the order of the data.
pub const KEYS: &[Key] = {
    const HOST: usize = PLAIN.len() + triangles::KEYS.len();
    const BEFORE: usize = HOST + esc::KEYS.len();
    const PARTS: [Key; BEFORE] = join(&join::<HOST>(PLAIN, triangles::KEYS), esc::KEYS);
    &join::<{ BEFORE + block::KEYS.len() }>(&PARTS, block::KEYS)
};

const PLAIN: &[Key] = &[
    key("unit", "the unit that runs", "hybrid, triangles, sfarti, moreton, d3d11 or esc"),
    key("engine", "what lays time over the blocks", "timed, stepped or none"),
    key("clock_mhz", "the clock in MHz; every number of cycles is one of this clock", "1..=100000"),
    key("frames", "whether a frame waits until the one before has left", "drain or overlap"),
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
    key(
        "position.object_range_log2",
        "log2 of the largest magnitude that the port expects in object space, where the trace's \
         range does not say (unit moreton)",
        "-126..=127",
    ),
    key(
        "assemble.cache_entries",
        "transformed points that the cache of an indexed mesh holds, first in first out; 0: none",
        "0..=65536",
    ),
    key(
        "hull.policy",
        "what the hull shader computes tessellation factors from: the criterion of the trace or \
         of level.*, or the distance between each edge and its control polygon (unit d3d11)",
        "criterion or adaptive",
    ),
    key(
        "hull.pixels",
        "distance above which adaptive inserts a vertex, in pixels",
        "a number >= 0, at most 65535",
    ),
    key(
        "hull.candidates",
        "positions in each third of an edge at which adaptive tests the distance",
        "1..=20",
    ),
    key(
        "hull.to_memory",
        "whether what the hull shader hands to the domain shader goes through device memory, and \
         not on chip (unit d3d11)",
        "true or false",
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
    key(
        "level.termination",
        "when midpoint subdivision by flatness ends: when each of eight curves is flat, or by the \
         bound of the surface (unit sfarti)",
        "eight_curves or bounded",
    ),
    key(
        "level.union",
        "which patches use one union of their lists, so that nothing is left to zip: those of a \
         strip, fan or mesh that share edges, in two passes, watertight within the primitive but \
         not against other draws (unit sfarti)",
        "off or primitive",
    ),
    key("clip.enabled", "remove patches wholly outside one clip plane", "true or false"),
    key(
        "backface.method",
        "the back-face test; net_facets and hull_literal remove what a viewer can see, too: \
         `tessim study backface`",
        "off, net_facets, tangent_plane, normal_cone or hull_literal",
    ),
    key(
        "tessellator.partitioning",
        "how tessellation factors divide edges (unit d3d11)",
        "integer, pow2, odd or even",
    ),
    key(
        "place.reciprocal_bits",
        "fraction bits of a level's reciprocal, of which parameters and forward differences are \
         made; units d3d11, esc and sfarti have none",
        "8..=32",
    ),
    key(
        "evaluate.scheme",
        "how points are computed; unit sfarti: always de_casteljau",
        "forward, mixed or de_casteljau",
    ),
    optional(
        "evaluate.guard",
        "guard bits of the forward-difference accumulators",
        "1..=52, with position.width + guard + 3 <= 63",
        ("20", "min(20, 60 - position.width)"),
    ),
    key("evaluate.rounding", "how an evaluated point is rounded", ROUNDING),
    key("evaluate.normals", "what the vertex shader gets to light with", "off or tangent_plane"),
    key(
        "domain.shader",
        "whether the domain shader reads the control points for every point, and forms the whole \
         product of it, or once a patch (unit d3d11)",
        "naive or basis",
    ),
    optional(
        "domain.form",
        "in which form it evaluates: Bernstein sums that are the same from either end of an edge, \
         those from left to right, or the power basis; in f32 only paired is without cracks",
        "paired, sequential or power",
        ("\"paired\"", "paired under basis, power under naive"),
    ),
    key(
        "domain.arithmetic",
        "in which numbers it evaluates; fixed: those of position.width, each product rounded",
        "f32 or fixed",
    ),
    key("domain.weight_bits", "fraction bits of a weight (fixed)", "16..=30"),
    optional(
        "domain.cache_entries",
        "shaded points that are kept for the triangles that follow, first in first out",
        "0..=65536",
        ("32", "all of a patch's"),
    ),
    key(
        "domain.width",
        "points that a wave shades side by side; a wave is of one patch",
        "1..=1024",
    ),
    key("domain.bytes_in", "bytes of a point's parameters, u and v", "0..=65536"),
    key("domain.bytes_out", "bytes of a shaded point without its attributes", "0..=65536"),
    key("attributes.width", "bits of an attribute's component, with its sign", "8..=46"),
    key(
        "attributes.fraction",
        "fraction bits of an attribute's component",
        "0..=45, less than attributes.width",
    ),
    key("attributes.rounding", "how attributes are rounded", ROUNDING),
    key(
        "emit.divide",
        "divide by w and snap to the sub-pixel grid; unit moreton: never",
        "true or false",
    ),
    key("emit.subpixel_bits", "fraction bits of a screen coordinate", "0..=12"),
    key("emit.rounding", "how a screen coordinate is rounded", ROUNDING),
    key("emit.vertex_bytes", "bytes of a vertex record that leaves the unit", "1..=65536"),
    key("emit.index_bytes", "bytes of a triangle index that leaves the unit", "1..=8"),
    key("vertex_shader.bytes_in", "bytes read for a vertex, normals not included", "0..=65536"),
    key("vertex_shader.bytes_in_normal", "bytes read for a vertex's tangent plane", "0..=65536"),
    key("vertex_shader.bytes_out", "bytes written for a vertex", "0..=65536"),
    key(
        "vertex_shader.to_memory",
        "also write shaded vertices to device memory (stream output)",
        "true or false",
    ),
    optional(
        "link.bus",
        "a bus by its name: sets the bandwidths, payload, header, request and completion that no \
         key beside it sets",
        BUSES,
        ("\"pcie4x16\"", "the numbers below are no named bus's"),
    ),
    key("link.bandwidth_mb_s", "bandwidth towards the device, 10^6 bytes a second", BANDWIDTH),
    key(
        "link.upstream_mb_s",
        "bandwidth towards the host, which carries read requests, 10^6 bytes a second",
        BANDWIDTH,
    ),
    key(
        "link.payload",
        "largest payload of a packet in bytes; 0: not packetised",
        "0..=65536; 0 only with header 0",
    ),
    key("link.header", "framing of a packet in bytes", "0..=65536; 0 where payload is 0"),
    key(
        "link.transfer",
        "who moves the data: the host writes, or the device reads the host's memory",
        "push or pull",
    ),
    key("link.request", "most bytes that one read asks for (pull)", "1..=65536"),
    key("link.request_header", "bytes of a read request, upstream (pull)", "0..=65536"),
    key(
        "link.completion",
        "most bytes that one completion of a read brings; 0: not packetised (pull)",
        "0..=65536; 0 only with completion_header 0",
    ),
    key(
        "link.completion_header",
        "framing of a completion in bytes (pull)",
        "0..=65536; 0 where completion is 0",
    ),
    key(
        "link.latency",
        "cycles from a read request to its data (pull); 500 ns are assumed",
        CYCLES,
    ),
    key("link.outstanding", "read requests under way at once (pull)", "1..=65536"),
    key("memory.burst", "bytes of a memory burst", "1..=65536"),
    key("memory.bandwidth_mb_s", "bandwidth of a channel, 10^6 bytes a second", BANDWIDTH),
    key("memory.latency", "cycles from a read to its data; 200 ns are assumed", CYCLES),
    key("memory.outstanding", "reads of a burst each under way at once", "1..=65536"),
    key(
        "memory.channels",
        "whether reads and writes have a channel each, or the stages take turns at one",
        "separate or shared",
    ),
    key("memory.fifo", "entries of the FIFO before memory: commands", FIFO),
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

const fn join<const N: usize>(first: &[Key], then: &[Key]) -> [Key; N] {
    assert!(N == first.len() + then.len(), "the array holds both");
    let mut keys = [first[0]; N];
    let mut i = 1;
    while i < N {
        keys[i] = if i < first.len() { first[i] } else { then[i - first.len()] };
        i += 1;
    }
    keys
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
        let printed = toml::Value::try_from(Config::default()).unwrap();
        let mut paths = Vec::new();
        leaves("", &printed, &mut paths);
        for path in &paths {
            assert!(find(path).is_some(), "{path}");
        }
        let optional = KEYS.iter().filter(|key| key.absent.is_some()).count();
        assert!(paths.len() <= KEYS.len() && KEYS.len() - optional <= paths.len());
    }

    fn leaves(prefix: &str, value: &toml::Value, paths: &mut Vec<String>) {
        let toml::Value::Table(table) = value else { return paths.push(prefix.to_owned()) };
        for (name, value) in table {
            let dot = if prefix.is_empty() { "" } else { "." };
            leaves(&format!("{prefix}{dot}{name}"), value, paths);
        }
    }

    #[test]
    fn every_block_has_its_six_keys_and_some_have_more() {
        use crate::config::block::TIMED;
        for block in TIMED {
            let prefix = format!("block.{}.", block.name());
            let keys = KEYS.iter().filter(|key| key.path.starts_with(&prefix)).count();
            let more = match block.name() {
                "evaluate" => 1,
                "surface" => 4,
                _ => 0,
            };
            assert_eq!(keys, 6 + more, "{prefix}");
        }
        let blocks = KEYS.iter().filter(|key| key.path.starts_with("block.")).count();
        assert_eq!(blocks, 6 * TIMED.len() + 5);
    }

    #[test]
    fn an_example_of_what_a_block_leaves_absent_is_what_holds_by_default() {
        let config = Config::default();
        for block in crate::config::block::TIMED {
            let costs = config.costs(block).unwrap();
            let example = |name: &str| {
                let key = find(&format!("block.{}.{name}", block.name())).unwrap();
                key.absent.map(|(example, _)| example.parse::<u32>().unwrap())
            };
            assert_eq!(example("in_flight"), Some(costs.in_flight()), "{block:?}");
            assert_eq!(example("interval").unwrap_or(costs.interval), costs.interval);
            assert_eq!(example("latency").unwrap_or(costs.latency), costs.latency);
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
        assert_eq!(nearest("block.stich.fifo"), "block.stitch.fifo");
        assert_eq!(nearest("block.evaluate.set_up"), "block.evaluate.setup");
        assert_eq!(nearest("block.clip.in_fligth"), "block.clip.in_flight");
        assert_eq!(nearest("clock"), "clock_mhz");
    }
}
