//! What a run takes follows from its causes, worked out by hand: the interval of the block that
//! binds, the bytes on the link, the rates that buses are known for.

use crate::runs::{self, elapsed, row, run, set};
use rtl_model::counter::Counter;
use tessim::config::Config;
use tessim::report::Report;

/// Cycles that the bytes of all frames hold the link, as its wire counts them: a transfer starts
/// where the last one ended, within a cycle if need be, so that only the sum is rounded, down. That
/// holds where every transfer takes a cycle at least, and nothing goes upstream.
fn link_cycles(report: &Report) -> u64 {
    let Config { clock_mhz, link, .. } = &report.config;
    let bytes = report.total(Counter::LinkTotal);
    bytes * u64::from(*clock_mhz) / u64::from(link.bandwidth_mb_s)
}

/// The share of its cycles that a block is used.
fn used(report: &Report, block: &str) -> f64 {
    row(report, block, "cycles.used") as f64 / row(report, block, "cycles.total") as f64
}

#[test]
fn a_stitcher_of_half_the_speed_takes_twice_the_cycles_and_binds() {
    let text = runs::shipped("teapot");
    let [one, two] =
        [1, 2].map(|interval| run(&text, &set(&[&format!("block.stitch.interval={interval}")])));
    let triangles = one.total(Counter::StitchTriangles);
    assert_eq!(row(&one, "stitch", "cycles.used"), triangles, "a triangle a cycle");
    assert_eq!(row(&two, "stitch", "cycles.used"), 2 * triangles);
    // Before the first strip and behind the last triangle: the first patch's way to stitch (the
    // link, 16 points, 89 cycles of back-face removal, ..), the vertex shader's 200 cycles.
    let rest = elapsed(&two) - 2 * triangles;
    assert!(rest < 1500, "{rest} cycles beside the stitcher's");
    assert!(elapsed(&two) as f64 > 1.8 * elapsed(&one) as f64);
    assert!(used(&two, "stitch") > 0.98);
    for stage in &two.chain {
        let block = stage.block.name();
        assert!(block == "stitch" || used(&two, block) < used(&two, "stitch"), "{block} binds");
    }
    let table = tessim::output::table::text(&two, "teapot");
    assert!(table.contains("what binds the run: \x1b[1mstitch\x1b[0m, used 98."), "{table}");
    println!("compared {} with {} cycles", elapsed(&one), elapsed(&two));
}

#[test]
fn a_faster_link_is_never_slower() {
    let mut pairs = 0;
    let traces = [runs::shipped("mesh"), runs::shipped("teapot"), runs::teacups(3, 3, 4)];
    for text in &traces {
        for unit in ["hybrid", "triangles"] {
            let cycles = ["agp1x", "agp2x", "agp4x", "agp8x"].map(|bus| {
                let bus = format!("link.bus={bus}");
                elapsed(&run(text, &set(&[&format!("unit={unit}"), &bus])))
            });
            assert!(cycles.windows(2).all(|pair| pair[1] < pair[0]), "{unit}: {cycles:?}");
            if unit == "triangles" {
                // Nothing but the link matters: half the time at twice the rate.
                let ratio = cycles[0] as f64 / cycles[3] as f64;
                assert!((ratio - 2133.0 / 266.0).abs() < 0.02, "{cycles:?}");
            }
            pairs += 3;
        }
    }
    println!("compared {pairs} pairs of runs");
}

#[test]
fn a_run_that_the_link_binds_takes_the_link_s_time() {
    // The indices of a frame's last draw follow its last vertex by more than the vertex shader's
    // 200 cycles, so the link's last byte is the last of all. Several frames: each drains, and the
    // wire carries its fraction of a cycle on, so they add up to the same.
    let traces =
        runs::SHIPPED.map(runs::shipped).into_iter().chain([runs::grid(20, 3)]).enumerate();
    let mut compared = 0;
    for (k, text) in traces {
        for bus in ["agp1x", "agp4x", "pcie1x1"] {
            let report = run(&text, &set(&["unit=triangles", &format!("link.bus={bus}")]));
            assert_eq!(elapsed(&report), link_cycles(&report), "trace {k} on {bus}");
            // The last frame's end is the link's last byte: it is used in every cycle.
            assert_eq!(row(&report, "link", "cycles.used"), elapsed(&report), "trace {k}");
            compared += 1;
        }
    }
    println!("compared {compared} runs");
}

#[test]
fn behind_a_slow_link_the_unit_takes_its_own_time() {
    // All of the teapot's four commands cross before its first patch is fetched. On a link of
    // 10^7 MB/s each takes a cycle; on a slow one, its bytes' time. The rest is the same.
    let text = runs::shipped("teapot");
    let mut compared = 0;
    let fast = run(&text, &set(&["link.bandwidth_mb_s=10000000"]));
    let own = elapsed(&fast) - 4;
    for bandwidth in [1, 7, 100, 266] {
        let slow = run(&text, &set(&[&format!("link.bandwidth_mb_s={bandwidth}")]));
        assert_eq!(elapsed(&slow), link_cycles(&slow) + own, "{bandwidth} MB/s");
        compared += 1;
    }
    let slowest = run(&text, &set(&["link.bandwidth_mb_s=1"]));
    assert!(used(&slowest, "link") > 0.99, "it binds");
    println!("compared {compared} runs: {own} cycles behind the link");
}

/// Draws of one patch each, its points sent before it.
fn single_patches(draws: usize) -> String {
    let points: Vec<String> = (0..16).map(|k| format!("[{},{},0]", k % 4, k / 4)).collect();
    let identity = "[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]";
    let draw = format!(
        "{{\"points\":{{\"id\":0,\"xyz\":[{}]}}}}\n\
         {{\"draw\":{{\"primitive\":\"patches\",\"points\":0,\"count\":1}}}}\n",
        points.join(",")
    );
    format!(
        "{{\"tessim\":1}}\n\
         {{\"frame\":{{\"viewport\":[64,64],\"view\":{identity},\
         \"projection\":[0.01,0,0,0,0,0.01,0,0,0,0,-0.01,0,0,0,0.5,1]}}}}\n{}{{\"end\":{{}}}}\n",
        draw.repeat(draws)
    )
}

#[test]
fn patches_and_commands_cross_in_the_order_of_the_trace() {
    // On a slow link each patch is long through the unit when the next one's draw has crossed, so
    // what follows the link's last byte is the last patch's own time: with one draw or with many.
    // A patch's fetch takes one cycle of the link, and the last one's is its own.
    let one = run(&single_patches(1), &set(&["link.bandwidth_mb_s=10000000"]));
    let own = elapsed(&one) - 3; // a frame, points and a draw take a cycle each
    assert!(own > 300, "{own} cycles of a patch");
    for draws in [1, 2, 7] {
        let slow = run(&single_patches(draws), &set(&["link.bandwidth_mb_s=50"]));
        assert_eq!(slow.total(Counter::StitchTriangles), 2 * draws as u64);
        let fetches = draws as u64 - 1;
        assert_eq!(elapsed(&slow), link_cycles(&slow) + fetches + own, "{draws} draws");
    }
    println!("compared 3 runs: {own} cycles of a patch");
}

#[test]
fn agp_8x_brings_66_6_million_vertices_of_32_bytes_a_second() {
    let clock_mhz = 500; // the shortest command, 8 bytes, takes a cycle and more
    let bus = ["unit=triangles", "link.bus=agp8x", "clock_mhz=500", "triangles.vertex_bytes=32"];
    for trace in ["teapot", "mesh", "rational"] {
        let report = run(&runs::shipped(trace), &set(&bus));
        assert_eq!(elapsed(&report), link_cycles(&report), "{trace}: the link binds");
        // What is no vertex: commands, matrices, indices. AGP has no framing.
        let vertex_bytes = report.total(Counter::LinkVertices);
        let others = report.total(Counter::LinkTotal) - vertex_bytes;
        let indices = report.total(Counter::LinkIndices);
        assert_eq!(
            others - indices,
            report.total(Counter::LinkCommands) + report.total(Counter::LinkMatrices)
        );
        let vertices = report.total(Counter::VertexShaderInvocations);
        assert_eq!(vertex_bytes, 32 * vertices);
        let cycles = elapsed(&report) as f64 - others as f64 * f64::from(clock_mhz) / 2133.0;
        let rate = vertices as f64 * f64::from(clock_mhz) / cycles;
        // 2133 / 32 = 66.656 million a second; the elapsed cycles are rounded down by less than 1.
        assert!((rate - 66.656).abs() < 0.003, "{trace}: {rate} million vertices a second");
        let triangles = report.total(Counter::EmitTriangles);
        let with_indices = vertices as f64 * f64::from(clock_mhz) / elapsed(&report) as f64;
        println!(
            "{trace}: {rate:.3} million vertices a second, {with_indices:.3} with the indices"
        );
        assert!(indices == 6 * triangles || indices == 12 * triangles);
    }
}

/// Unit `d3d11`, eight segments everywhere: 9 x 9 points, 128 triangles a patch.
const SHADERS: [&str; 3] = ["unit=d3d11", "level.level=8", "tessellator.partitioning=integer"];

fn shaders(settings: &[&str]) -> Report {
    run(&runs::shipped("teapot"), &set(&[&SHADERS, settings].concat()))
}

#[test]
fn each_stage_of_shaders_and_tessellator_is_used_for_what_it_does() {
    let report = shaders(&[]);
    let kept = report.total(Counter::LevelPatches);
    assert!(kept < 32, "some patches are culled");
    let used = |block| row(&report, block, "cycles.used");
    assert_eq!(used("hull"), 32 * 17, "16 threads for control points and one for factors");
    assert_eq!(used("factors"), 32 * 6);
    assert_eq!(used("points"), kept * 81);
    assert_eq!(used("connect"), kept * 128);
    assert_eq!(used("domain"), kept * 2 * 64, "two waves of 64, a cycle a lane, idle or not");
    let naive = shaders(&["domain.shader=naive"]);
    assert_eq!(row(&naive, "domain", "cycles.used"), kept * 2 * 256);
    // Without a cache: 384 points in six waves.
    let none = shaders(&["domain.cache_entries=0"]);
    assert_eq!(row(&none, "domain", "cycles.used"), kept * 6 * 64);
    assert!(elapsed(&none) > elapsed(&report) && elapsed(&naive) > elapsed(&report));
    println!("compared {} with {} cycles", elapsed(&report), elapsed(&naive));
}

#[test]
fn a_wave_of_surfaces_takes_its_longest_invocation_and_processors_share_waves() {
    // Level 3 and no tests: a net, 169 points, 288 slots, of 4 cycles an instruction.
    let wave = 4 * (64 + 169 * 16 + 288 * 4);
    let uniform = |settings: &[&str]| {
        let fixed = ["unit=esc", "esc.level=fixed", "esc.fixed_level=3", "esc.mu=0"];
        run(&runs::shipped("teapot"), &set(&[&fixed[..], settings].concat()))
    };
    let one = uniform(&[]);
    let kept = one.total(Counter::LevelPatches);
    assert!(kept > 4 && kept < 32, "some of the teapot is culled");
    // Whether one patch or all of them: the lanes do the same side by side.
    assert_eq!(row(&one, "surface", "cycles.used"), wave);
    assert!(used(&one, "surface") > 0.5);
    let serial = uniform(&["esc.width=1"]);
    assert_eq!(row(&serial, "surface", "cycles.used"), kept * wave);
    // Two processors take waves in turn, and the last one may be alone.
    let two = uniform(&["esc.width=1", "block.surface.lanes=2"]);
    assert_eq!(row(&two, "surface", "cycles.used"), kept * wave);
    let [serial, two] = [&serial, &two].map(elapsed);
    assert!(serial >= kept * wave && serial < (kept + 1) * wave, "{serial} cycles");
    let share = kept.div_ceil(2) * wave;
    assert!(two >= share && two < share + wave, "{two} cycles");
    // Emit takes a point, or a triangle, a cycle: 288 are more than 169.
    let slow = uniform(&["esc.width=1", "block.emit.interval=3"]);
    assert_eq!(row(&slow, "emit", "cycles.used"), 3 * 288 * kept);
    // Sections of five coarse triangles: four invocations, of which the last has three.
    let sections = uniform(&["esc.width=4", "esc.output_values=1024", "esc.level_max=3"]);
    let points = row(&sections, "surface", "evaluations") + row(&sections, "surface", "corners");
    let used = row(&sections, "surface", "lane_cycles.used");
    assert_eq!(used, 4 * (4 * 64 * kept + 16 * points + 4 * 288 * kept));
    println!("compared {serial} with {two} cycles, {kept} patches");
}

#[test]
fn what_a_hull_shader_writes_holds_memory_for_its_bytes() {
    // 40 MB/s at 2 GHz: a byte takes 50 cycles, a patch of nine bursts of 32 bytes 14 400.
    let slow = ["hull.to_memory=true", "memory.bandwidth_mb_s=40"];
    let report = shaders(&slow);
    let kept = report.total(Counter::LevelPatches);
    let patch = 9 * 32 * 50;
    assert_eq!(row(&report, "hull", "cycles.used"), 32 * patch);
    // The second wave of a patch needs nothing more.
    assert_eq!(row(&report, "domain", "cycles.used"), kept * (patch + 64));
    let on_chip = shaders(&["memory.bandwidth_mb_s=40"]);
    assert_eq!(row(&on_chip, "hull", "cycles.used"), 32 * 17);
    // One port for both: it is held for all that is written and read, one after another.
    let shared = shaders(&[slow[0], slow[1], "memory.channels=shared"]);
    let bytes = shared.total(Counter::MemoryBursts) * 32;
    assert_eq!(bytes, (32 + kept) * 9 * 32);
    assert!(elapsed(&shared) >= 50 * bytes, "{} cycles for {bytes} bytes", elapsed(&shared));
    assert!(elapsed(&shared) < 50 * bytes + patch, "{} cycles", elapsed(&shared));
    println!("compared {} with {} cycles", elapsed(&report), elapsed(&shared));
}
