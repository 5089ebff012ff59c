//! Discrete levels: an instance gets the least that suffices for its patches, beside what the
//! patches themselves ask for; and its patches meet.

use crate::{counted, host, runs};
use rtl_model::counter::Counter as C;
use rtl_model::level;
use rtl_model::patch::{ONE, Vertex};
use tessim::error::Result;
use tessim::sink::{Arrived, FrameInfo, PatchMesh, Sink};

/// What patches of a run ask for, or, where all of an instance's are at one level, what they get.
#[derive(Default)]
struct Seen {
    uniform: bool,
    frame: Option<FrameInfo>,
    last: Option<Arrived>,
    /// By frame, of patches that are tessellated, their numbers; and the greatest level that is
    /// asked for, in UQ8.16, or the segments of their edges.
    levels: Vec<Vec<(u32, u32)>>,
}

impl Sink for Seen {
    fn wants(&self, _frame: u64) -> bool {
        true
    }

    fn frame(&mut self, frame: &FrameInfo) -> Result<()> {
        self.frame = Some(*frame);
        self.levels.push(Vec::new());
        Ok(())
    }

    fn taps(&self) -> bool {
        true
    }

    fn arrived(&mut self, patch: &Arrived) -> Result<()> {
        self.last = Some(patch.clone());
        Ok(())
    }

    fn patch(&mut self, mesh: &PatchMesh<'_>) -> Result<()> {
        let arrived = self.last.as_ref().expect("a patch arrives before its mesh");
        assert_eq!(arrived.patch.id, mesh.patch);
        let level = if self.uniform { segments(mesh) } else { asked(arrived, &self.frame) };
        self.levels.last_mut().expect("a frame has begun").push((mesh.patch, level));
        Ok(())
    }
}

/// The greatest level that a patch asks for.
fn asked(arrived: &Arrived, frame: &Option<FrameInfo>) -> u32 {
    let view = frame.as_ref().expect("a frame has begun").eye;
    let (levels, _) = level::accept(&arrived.patch, &view, &arrived.state);
    levels.edges.into_iter().chain(levels.interior).max().expect("it has six").fx16()
}

/// Segments of all edges of a patch, and of its rows and columns.
fn segments(mesh: &PatchMesh<'_>) -> u32 {
    let edge = |on: fn(&&Vertex) -> bool| mesh.vertices.iter().filter(on).count() - 1;
    let all: [fn(&&Vertex) -> bool; 4] =
        [|v| v.v == 0, |v| v.u == ONE, |v| v.v == ONE, |v| v.u == 0];
    let edges = all.map(edge);
    assert_eq!(edges, [edges[0]; 4]);
    assert_eq!(mesh.vertices.len(), (edges[0] + 1) * (edges[0] + 1));
    edges[0] as u32
}

/// Instances of so many patches; of all of a frame's, where that is 0.
#[test]
fn an_instance_gets_the_least_level_that_suffices() {
    let mut instances = 0;
    let mut levels = std::collections::BTreeSet::new();
    for (text, each, least, most) in [
        (runs::shipped("teapot"), 32, "1", 64),
        (runs::shipped("zoom"), 0, "1", 128),
        (runs::shipped("mesh"), 0, "1", 8),
        (runs::teacups(12, 3, 64), 26, "3", 32),
    ] {
        let least = format!("level.min_level={least}");
        let max_level = format!("triangles.max_level={most}");
        let streamed = host(&["engine=none", &least]);
        let discrete = host(&["engine=none", "triangles.residency=discrete", &max_level, &least]);
        let mut asked = Seen::default();
        let mut got = Seen { uniform: true, ..Seen::default() };
        let report = runs::run_into(&text, &streamed, &mut asked);
        runs::run_into(&text, &discrete, &mut got);
        for (frame, (asked, got)) in asked.levels.iter().zip(&got.levels).enumerate() {
            let patches = report.frames[frame].counters.get(C::TracePatches) as u32;
            let each = if each == 0 { patches } else { each };
            assert_eq!(patches % each, 0, "{patches} patches");
            for first in (0..patches).step_by(each as usize) {
                let own = first..first + each;
                let needed = asked.iter().filter(|(id, _)| own.contains(id)).map(|(_, l)| *l).max();
                let got: Vec<_> = got.iter().filter(|(id, _)| own.contains(id)).collect();
                let Some(needed) = needed else {
                    assert!(got.is_empty(), "nothing of it is in sight");
                    continue;
                };
                assert_eq!(got.len(), each as usize, "all patches, whatever is in sight of them");
                let segments = needed.div_ceil(65536).next_power_of_two().min(most);
                assert!(got.iter().all(|(_, got)| *got == segments), "{needed} {got:?}");
                levels.insert(segments);
                instances += 1;
            }
        }
    }
    assert!(instances > 20 && levels.len() >= 3, "{instances} instances at {levels:?}");
    println!("{instances} instances at {levels:?}");
}

/// Each level crosses when it is first needed, or all of them do.
#[test]
fn levels_cross_the_link_when_the_policy_says() {
    let teapot = runs::shipped("teapot");
    // Level 5 asks for 8; a mesh at level n has (n + 1)^2 vertices a patch.
    let mesh = |level: u64| 32 * ((level + 1) * (level + 1) * 32 + 2 * level * level * 3 * 2);
    let sent = |settings: &[&str]| {
        let settings = [&["triangles.residency=discrete", "level.level=5"], settings].concat();
        let totals = counted(&teapot, &settings).totals();
        (totals.get(C::LinkVertices) + totals.get(C::LinkIndices), totals.get(C::LinkCommands))
    };
    assert_eq!(sent(&[]), (mesh(8), 3 * 8));
    let all = (0..=5).map(|k| mesh(1 << k)).sum();
    assert_eq!(sent(&["triangles.upload=whole", "triangles.max_level=32"]), (all, 8 * 8));
    assert_eq!(sent(&["triangles.max_level=4"]), (mesh(4), 3 * 8));
    // Three frames of a cup that comes no nearer: what is there is not sent again.
    let cups = runs::teacups(4, 3, 16);
    let report = counted(&cups, &["triangles.residency=discrete"]);
    let [first, rest @ ..] = &report.frames[..] else { panic!("three frames") };
    assert!(first.counters.get(C::LinkVertices) > 0);
    assert!(rest.iter().all(|f| f.counters.get(C::MemoryMeshesPeak) > 0));
    let held = |frame: &tessim::report::Frame| frame.counters.get(C::MemoryMeshesPeak);
    let sent: u64 = report
        .frames
        .iter()
        .map(|frame| frame.counters.get(C::LinkVertices) + frame.counters.get(C::LinkIndices))
        .sum();
    assert_eq!(held(&report.frames[2]), sent, "all that was sent is there");
}
