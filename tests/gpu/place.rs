//! Place: what is planned of random levels and lists, against the first implementation's counts.

use crate::batch::{Batch, Division};
use crate::random::Random;
use crate::support;
use crate::table::Quantity;
use rtl_model::place::{DyadicPlacement, Parameters, Placement};
use tessim::gpu::surface::{PLAN, Source};

/// The segments of the six lists.
fn segments(division: &Division) -> Vec<u32> {
    match division {
        Division::Fractional(levels) => {
            let mut placement = Placement::default();
            placement.set(levels);
            list_segments(&placement)
        }
        Division::Dyadic(lists) => {
            let mut placement = DyadicPlacement::default();
            placement.set_lists(lists);
            list_segments(&placement)
        }
    }
}

fn list_segments<L: Parameters>(placement: &Placement<L>) -> Vec<u32> {
    let lists = placement.edges.iter().chain([&placement.u, &placement.v]);
    lists.map(|list| list.segments() as u32).collect()
}

/// The levels of the six lists and their reciprocals, where there are any to speak of.
fn reciprocals(division: &Division) -> Vec<u32> {
    let Division::Fractional(levels) = division else { return Vec::new() };
    let mut placement = Placement::default();
    placement.set(levels);
    let lists = placement.edges.iter().chain([&placement.u, &placement.v]);
    lists.flat_map(|list| [list.level().fx16(), list.reciprocal() as u32]).collect()
}

#[test]
fn lists_are_planned_alike() {
    let Some(device) = support::device() else { return };
    let mut ledger = support::ledger();
    let mut random = Random::new(73);
    for width in 8..=48 {
        let source = [Source::Levels, Source::Masks][width as usize % 2];
        let batch = Batch::draw(&mut random, width, source, 24 * support::effort(), 128);
        let placed = batch.place(device).placed;
        let plans = device.read(&placed.plans, 0, PLAN * batch.patches.len()).unwrap();
        for (k, (made, plan)) in batch.expected().iter().zip(plans.chunks(PLAN)).enumerate() {
            let division = &batch.divisions[k];
            let vertices = made.vertices.len() as u32;
            let want = [
                made.reciprocals,
                made.parameters as u32,
                made.cost.invocations as u32,
                vertices,
                made.strips as u32,
                made.cost.curves as u32,
                made.cost.steps as u32,
                vertices * batch.components[k],
                made.triangles.len() as u32,
            ];
            let mut compare = |what, want: &[u32], got: &[u32]| {
                let place = || format!("patch {k}, {:?}", batch.config.evaluate);
                ledger.compare(("place", what), want, got, place, || format!("{division:?}"));
            };
            compare("counts", &want, &plan[11..20]);
            compare("segments", &segments(division), &plan[24..30]);
            let reciprocals = reciprocals(division);
            let got: Vec<u32> = plan[30..54].chunks(4).flat_map(|l| [l[0], l[1]]).collect();
            if !reciprocals.is_empty() {
                compare("levels and reciprocals", &reciprocals, &got);
            }
        }
    }
    support::settle(&ledger, Quantity::KernelPlaceRandom);
}
