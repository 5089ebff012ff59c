//! Counts: rows of words on the device in, sums named as counters.csv names them out.

use crate::config::{Config, DomainKind, Normals};
use crate::error::Result;
use crate::gpu::{Buffer, Device, Kernel, Name, Settings};

/// Words of a patch's row.
pub(super) const ROW: usize = 30;

/// Sums in all: those of the columns, and of vertices that stay homogeneous.
pub(super) const SUMS: usize = ROW + 1;
const HOMOGENEOUS: usize = ROW;

/// Bytes of a net: 16 vec4.
const NET_BYTES: u64 = 16 * 16;

/// Cycles a point of a shader that reads a net for each, 64 bytes a cycle.
const NAIVE_CYCLES: u64 = 4;

/// The sums that are a counter each, by their place in a row.
const COUNTERS: [(usize, Name); 20] = [
    (0, ("clip", "patches.culled")),
    (1, ("backface", "patches.in")),
    (2, ("backface", "patches.tested")),
    (3, ("backface", "facets.tested")),
    (4, ("backface", "patches.culled")),
    (5, ("level", "patches")),
    (6, ("level", "patches.flatness")),
    (7, ("level", "patches.edge_length")),
    (8, ("level", "splits")),
    (9, ("level", "levels.clamped")),
    (10, ("level", "edges.near")),
    (11, ("level", "overflows")),
    (12, ("hull", "distance_tests")),
    (13, ("points", "parameters")),
    (14, ("points", "points")),
    (15, ("points", "points.non_monotone")),
    (16, ("connect", "triangles")),
    (17, ("connect", "triangles.inverted")),
    (18, ("connect", "triangles.zero_area")),
    (19, ("connect", "triangles.degenerate")),
];

/// Sums that others are made of.
const POINTS: usize = 14;
const TRIANGLES: usize = 16;
const SHADED: usize = 20;
const WAVES: usize = 21;
const OVERFLOWS: usize = 22;
const CRACKS: usize = 23;
const ATTRIBUTES: usize = 24;
const COMPONENTS: usize = 25;
const READ: usize = 26;
const READ_BURSTS: usize = 27;
const WRITTEN: usize = 28;
const WRITTEN_BURSTS: usize = 29;

/// Adds the columns of so many rows.
pub(super) fn add(
    device: &Device,
    rows: &Buffer,
    count: usize,
    sums: &mut [u64; SUMS],
) -> Result<()> {
    let mut settings = Settings::default().of(ROW);
    settings.own[..2].copy_from_slice(&[count as u32, ROW as u32]);
    let out = device.empty(2 * ROW)?;
    device.run(Kernel::Scan, "columns", &settings, &[rows, &out])?;
    let words = device.read(&out, 0, 2 * ROW)?;
    for (sum, pair) in sums.iter_mut().zip(words.as_chunks::<2>().0) {
        *sum += u64::from(pair[1]) << 32 | u64::from(pair[0]);
    }
    Ok(())
}

/// The counters: all that the unit counts for patches, but for what the hull
/// shader reads, and sums of memory that other traffic has a part in.
pub(super) fn of(sums: &[u64; SUMS], config: &Config) -> Vec<(Name, u64)> {
    let mut counts: Vec<_> = COUNTERS.map(|(at, name)| (name, sums[at])).into();
    let patches = sums[0] + sums[1];
    counts.push((("clip", "patches.in"), patches));
    counts.push((("factors", "patches.culled"), sums[0] + sums[4]));
    counts.push((("factors", "factors"), 6 * patches));
    counts.push((("hull", "invocations"), patches));
    counts.push((("hull", "threads"), 16 * patches));
    counts.push((("hull", "bytes.out"), sums[WRITTEN]));
    domain(sums, config, &mut counts);
    memory(sums, config, &mut counts);
    emit(sums, config, &mut counts);
    counts
}

fn domain(sums: &[u64; SUMS], config: &Config, counts: &mut Vec<(Name, u64)>) {
    let domain = &config.domain;
    let width = u64::from(domain.width);
    let component = config.attributes.component_bytes();
    let idle = sums[WAVES] * width - sums[SHADED];
    let (nets, corners, cycles) = match domain.shader {
        DomainKind::Naive => (sums[SHADED], sums[ATTRIBUTES], NAIVE_CYCLES * width),
        DomainKind::Basis => (sums[5], sums[COMPONENTS], width),
    };
    let interval = config.block.domain.interval.map_or(cycles, u64::from);
    let out = sums[SHADED] * u64::from(domain.bytes_out) + component * sums[ATTRIBUTES];
    let planes = config.evaluate.normals == Normals::TangentPlane;
    let all = [
        ("invocations", sums[SHADED]),
        ("invocations.repeated", sums[SHADED] - sums[POINTS]),
        ("waves", sums[WAVES]),
        ("lanes.idle", idle),
        ("lane_cycles.idle", idle * interval),
        ("bytes.in.control_points", nets * NET_BYTES),
        ("bytes.in.parameters", sums[SHADED] * u64::from(domain.bytes_in)),
        ("bytes.in.attributes", 4 * component * corners),
        ("bytes.out", out),
        ("attributes", sums[ATTRIBUTES]),
        ("normals", if planes { sums[SHADED] } else { 0 }),
        ("cracks", sums[CRACKS]),
        ("overflows", sums[OVERFLOWS]),
    ];
    counts.extend(all.map(|(name, count)| (("domain", name), count)));
}

/// What goes through memory between the shaders, or stays on the chip.
fn memory(sums: &[u64; SUMS], config: &Config, counts: &mut Vec<(Name, u64)>) {
    let through = |count: u64| if config.hull.to_memory { count } else { 0 };
    let bursts = sums[READ_BURSTS] + sums[WRITTEN_BURSTS];
    counts.push((("hull", "bytes.out.on_chip"), sums[WRITTEN] - through(sums[WRITTEN])));
    counts.push((("memory", "bytes.written.patches"), through(sums[WRITTEN])));
    counts.push((("memory", "bytes.read.patches"), through(sums[READ])));
    counts.push((("memory", "bursts.patches"), through(bursts)));
}

fn emit(sums: &[u64; SUMS], config: &Config, counts: &mut Vec<(Name, u64)>) {
    let emit = &config.emit;
    let attributes = sums[ATTRIBUTES] * config.attributes.component_bytes();
    let indices = 3 * sums[TRIANGLES] * u64::from(emit.index_bytes);
    let bytes = sums[SHADED] * u64::from(emit.vertex_bytes) + attributes + indices;
    counts.push((("emit", "vertices"), sums[SHADED]));
    counts.push((("emit", "triangles"), sums[TRIANGLES]));
    counts.push((("emit", "bytes.attributes"), attributes));
    counts.push((("emit", "bytes"), bytes));
    counts.push((("emit", "vertices.to_clipper"), sums[HOMOGENEOUS]));
}
