//! Whole units: what the kernels make of a batch, and the meshes beside each other.

use super::item::{Item, Mesh, net};
use super::ledger::Ledger;
use crate::config::{Config, Unit};
use crate::error::Result;
use crate::gpu::{self, Device, Made, Settings, VERTEX, push_patch, words};
use crate::sink::{Arrived, FrameInfo};
use rtl_model::level::{self, Criterion};
use rtl_model::patch::Patch;
use std::ops::Range;

/// The tessellation state as the kernels have it.
pub(super) fn state(state: &level::State) -> gpu::State {
    let (criterion, number) = match state.criterion {
        Criterion::Flatness { pixels } => (0, pixels),
        Criterion::EdgeLength { pixels } => (1, pixels),
        Criterion::Fixed { level } => (2, level.fx16()),
    };
    [criterion, number, state.min.fx16(), state.max.fx16()]
}

fn patches<'a>(items: &'a [Item], of: impl Fn(&'a Arrived) -> Option<Patch>) -> Option<Vec<u32>> {
    let mut out = Vec::with_capacity(gpu::PATCH * items.len());
    for Item { arrived, .. } in items {
        push_patch(&mut out, &of(arrived)?, state(&arrived.state), [0; 3]);
    }
    Some(out)
}

/// Runs the unit's kernels on a batch.
pub(super) fn make(
    device: &Device,
    config: &Config,
    frame: &FrameInfo,
    items: &[Item],
) -> Result<Made> {
    let settings = Settings::new(config, &frame.eye, frame.view.position);
    let own = patches(items, |arrived| Some(arrived.patch)).expect("every item has a patch");
    let components: Vec<u32> = items.iter().map(|item| item.arrived.components).collect();
    match config.unit {
        Unit::Hybrid | Unit::Triangles | Unit::Sfarti | Unit::Moreton => {
            let seen = patches(items, |arrived| arrived.seen);
            gpu::surface::surface(
                device,
                &gpu::surface::Surface {
                    config,
                    settings,
                    patches: &own,
                    seen: seen.as_deref(),
                    components: &components,
                },
            )
        }
        Unit::D3d11 => {
            let shaded = items.iter().flat_map(|item| item.arrived.shaded.as_flattened());
            let shaded: Vec<u32> = shaded.map(|c| c.to_bits()).collect();
            let hull_bytes: Vec<u32> = items.iter().map(|item| item.arrived.hull_bytes).collect();
            gpu::d3d11::d3d11(
                device,
                &gpu::d3d11::D3d11 {
                    config,
                    settings,
                    position: frame.eye.position,
                    patches: &own,
                    shaded: &shaded,
                    components: &components,
                    hull_bytes: &hull_bytes,
                },
            )
        }
        Unit::Esc => {
            let object = items.iter().map(|item| item.arrived.object);
            let object: Option<Vec<u32>> = object
                .map(|points| Some(points?.into_iter().flatten().flat_map(words)))
                .try_fold(Vec::new(), |mut all, words| {
                    all.extend(words?);
                    Some(all)
                });
            let levels: Option<Vec<u32>> =
                items.iter().map(|item| item.arrived.object_level.map(u32::from)).collect();
            gpu::esc(
                device,
                &gpu::Esc {
                    config,
                    settings,
                    position: frame.eye.position,
                    object_format: frame.object,
                    patches: &own,
                    object: object.as_deref(),
                    object_levels: levels.as_deref(),
                    components: &components,
                },
            )
        }
    }
}

/// The blocks that make parameters, positions, triangles and screen positions.
fn makers(unit: Unit) -> [&'static str; 4] {
    match unit {
        Unit::Hybrid | Unit::Triangles | Unit::Sfarti | Unit::Moreton => {
            ["place", "evaluate", "stitch", "emit"]
        }
        Unit::D3d11 => ["points", "domain", "connect", "emit"],
        Unit::Esc => ["surface", "surface", "surface", "emit"],
    }
}

/// Compares what both made of each patch.
pub(super) fn compare(
    ledger: &mut Ledger,
    unit: Unit,
    frame: &FrameInfo,
    items: &[Item],
    made: &Made,
) {
    let [placed, evaluated, joined, divided] = makers(unit);
    let none = Mesh::default();
    for (k, item) in items.iter().enumerate() {
        let mesh = item.mesh.as_ref().unwrap_or(&none);
        let at = |starts: &[u32], words: usize| {
            words * starts[k] as usize..words * starts[k + 1] as usize
        };
        let [parameters, positions] = split(&made.vertices[at(&made.vertex_starts, VERTEX)]);
        let screen = match made.screen.is_empty() {
            true => &[][..],
            false => &made.screen[at(&made.vertex_starts, 3)],
        };
        let triangles = &made.triangles[at(&made.triangle_starts, 3)];
        let place = format!("frame {}, patch {}", frame.number, item.arrived.patch.id);
        let mut each = |row, what, size: usize, cpu: &[u32], gpu: &[u32]| {
            parts(ledger, row, (&place, what, size), (cpu, gpu), &item.arrived);
        };
        let [cpu_parameters, cpu_positions] = split(&mesh.vertices);
        each((placed, "parameters"), "vertex", 2, &cpu_parameters, &parameters);
        each((evaluated, "positions"), "vertex", VERTEX - 2, &cpu_positions, &positions);
        each((joined, "triangles"), "triangle", 3, &mesh.triangles, triangles);
        each((divided, "screen positions"), "vertex", 3, &mesh.screen, screen);
    }
}

/// Parameters and positions of vertices.
fn split(vertices: &[u32]) -> [Vec<u32>; 2] {
    let part = |range: Range<usize>| {
        vertices.chunks(VERTEX).flat_map(|vertex| &vertex[range.clone()]).copied().collect()
    };
    [part(VERTEX - 2..VERTEX), part(0..VERTEX - 2)]
}

/// Compares one by one, where the whole differs, so that the first difference is named.
fn parts(
    ledger: &mut Ledger,
    row: (&'static str, &'static str),
    (place, what, size): (&str, &str, usize),
    (cpu, gpu): (&[u32], &[u32]),
    arrived: &Arrived,
) {
    let inputs = || net(&arrived.patch);
    if cpu == gpu {
        return ledger.compare(row, cpu, gpu, String::new, String::new);
    }
    for k in 0..cpu.len().max(gpu.len()).div_ceil(size) {
        let part =
            |all: &[u32]| -> Vec<u32> { all.iter().skip(k * size).take(size).copied().collect() };
        let place = || format!("{place}, {what} {k}");
        ledger.compare(row, &part(cpu), &part(gpu), place, inputs);
    }
}
