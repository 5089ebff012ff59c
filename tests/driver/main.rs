//! A driver's tessellator against ours: random factors through Mesa's llvmpipe and through
//! `rtl_model::d3d11`, coordinates compared bit for bit in the order of the primitives' corners,
//! and the counts that the driver's pipeline statistics give.
//!
//! OpenGL's transform feedback writes a triangle's or a line's vertices once for each primitive, so
//! that what is compared is the point of every index, in order; in point mode it is every point
//! once, as our indices are then. Beside them: which patch a vertex is of (culled patches are
//! counted and give none), evaluation-shader invocations (our points), primitives generated and
//! clipped, and patches of the control shader. Ours keeps its buffers from patch to patch and from
//! mode to mode.
//!
//! Not compared, as OpenGL has no words for it: line output of quads and triangles.
//!
//! Known difference: one. llvmpipe takes denormals for zeros while it draws (`draw_vbo` in Mesa's
//! `draw_pt.c` sets the processor so, and says why), hence culls a patch with a positive denormal
//! for an edge's factor. By the letter of the rule, that zero or less culls, such a factor does
//! not. Denormals are flushed before they are compared here, and
//! [`the_driver_tessellates_as_we_do`] fails where that is needless.
//!
//! Without EGL or llvmpipe the test says SKIPPED and why. It is a program of its own: should the
//! driver crash, the other tests have run.

mod factors;
mod gl;
mod mode;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/random.rs"]
mod random;

use gl::{Bits, Capture, Captured, Driver};
use mode::Mode;
use random::Random;
use rtl_model::d3d11::{Domain, Factors, Output, Tessellator};

/// Patches in a draw, at most.
const DRAWN_MAX: u32 = 4;

/// What was compared.
#[derive(Debug, Default)]
struct Compared {
    modes: usize,
    draws: usize,
    patches: usize,
    /// Patches that were culled, among them those for a denormal factor, of which we would not.
    culled: usize,
    culled_for_denormal: usize,
    points: usize,
    indices: usize,
    /// Points of the largest pattern.
    largest: usize,
}

/// A single as the driver takes it: a denormal is a zero.
fn flushed(bits: u32) -> u32 {
    if bits & 0x7f80_0000 == 0 { bits & 0x8000_0000 } else { bits }
}

/// A 16.16 number of 0..=1 as bits of a single, which has it exactly.
fn single(fixed: u32) -> u32 {
    assert!(fixed <= 1 << 16, "{fixed:#x} is above one");
    (fixed as f32 / 65536.0).to_bits()
}

/// The vertex that the shader sees at a point; a triangle's coordinates sum to one.
fn vertex(mode: Mode, [u, v]: [u32; 2], patch: usize) -> Captured {
    let w = if mode.domain == Domain::Tri { 65536 - u - v } else { 0 };
    Captured { coordinate: [u, v, w].map(single), patch: patch as u32 }
}

/// What a draw of `patches` has to give.
fn tessellate(
    tessellator: &mut Tessellator,
    mode: Mode,
    patches: &[Bits],
    compared: &mut Compared,
) -> Capture {
    let mut capture = Capture { patches: patches.len() as u32, ..Capture::default() };
    for (patch, bits) in patches.iter().enumerate() {
        let factors: Vec<u32> = mode.levels().iter().map(|&level| bits[level]).collect();
        let zeroed: Vec<u32> = factors.iter().map(|&bits| flushed(bits)).collect();
        let process = |bits: &[u32]| Factors::process(mode.domain, mode.partitioning, bits);
        let Some(processed) = process(&zeroed) else {
            compared.culled += 1;
            compared.culled_for_denormal += usize::from(process(&factors).is_some());
            continue;
        };
        tessellator.accept(&processed, mode.output);
        let (points, indices) = (tessellator.points(), tessellator.indices());
        let corners = indices.iter().map(|&index| vertex(mode, points[usize::from(index)], patch));
        capture.vertices.extend(corners);
        capture.evaluations += points.len() as u32;
        capture.primitives += indices.len() as u32 / mode.corners();
        compared.points += points.len();
        compared.indices += indices.len();
        compared.largest = compared.largest.max(points.len());
    }
    capture.clipped = capture.primitives;
    capture
}

/// The first difference of what the driver gave and what it has to give.
fn difference(got: &Capture, want: &Capture) -> Option<String> {
    let counts = [
        ("control-shader patches", got.patches, want.patches),
        ("evaluation-shader invocations", got.evaluations, want.evaluations),
        ("primitives", got.primitives, want.primitives),
        ("primitives at clipping", got.clipped, want.clipped),
    ];
    for (what, got, want) in counts {
        if got != want {
            return Some(format!("{what}: the driver has {got}, we {want}"));
        }
    }
    let longest = got.vertices.len().max(want.vertices.len());
    (0..longest).map(|k| (k, got.vertices.get(k), want.vertices.get(k))).find_map(
        |(k, got, want)| {
            (got != want).then(|| format!("vertex {k}: the driver has {got:x?}, we {want:x?}"))
        },
    )
}

fn compare(driver: &Driver, patches_per_mode: usize) -> Compared {
    let (mut compared, mut random) = (Compared::default(), Random::new(0xd3d11));
    let mut tessellator = Tessellator::default();
    for mode in Mode::all() {
        let program = driver.program(&mode.sources());
        let mut left = patches_per_mode;
        while left > 0 {
            let drawn = left.min(random.integer(1, DRAWN_MAX) as usize);
            let patches: Vec<Bits> = (0..drawn).map(|_| factors::draw(&mut random)).collect();
            let got = driver.draw(program, mode.corners(), &patches);
            let want = tessellate(&mut tessellator, mode, &patches, &mut compared);
            if let Some(difference) = difference(&got, &want) {
                panic!("{mode:?}, factors {patches:08x?}: {difference}");
            }
            compared.draws += 1;
            left -= drawn;
        }
        compared.patches += patches_per_mode;
        compared.modes += 1;
        driver.delete(program);
    }
    compared
}

#[test]
fn the_driver_tessellates_as_we_do() {
    let driver = match Driver::open() {
        Ok(driver) => driver,
        Err(why) => return println!("SKIPPED the driver's tessellator: {why}"),
    };
    let long = std::env::var_os("TESSIM_LONG").is_some_and(|v| v == "1");
    let compared = compare(&driver, if long { 10_000 } else { 400 });
    let Compared { modes, draws, patches, culled, points, indices, .. } = compared;
    println!(
        "{}: {patches} patches in {draws} draws and {modes} modes ({culled} culled), \
         {points} points, {indices} indices are the same",
        driver.name
    );
    // What a comparison of less would say nothing about.
    assert!(modes == 32 && patches >= 500 && draws < patches, "{compared:?}");
    assert!(culled >= 50 && culled < patches / 4, "{compared:?}");
    assert!(points > 100 * patches && indices > 3 * points, "{compared:?}");
    assert!(compared.largest > 4000, "nothing like 65 by 65: {compared:?}");
    assert!(compared.culled_for_denormal > 0, "flushing denormals is needless: {compared:?}");
}

/// A comparison that has gone blind would agree with every driver.
#[test]
fn planted_differences_are_found() {
    let mode = *Mode::all().iter().find(|m| m.output == Output::Ccw).unwrap();
    let patches = [[2.0f32, 3.0, 4.0, 5.0, 2.5, 3.5].map(f32::to_bits), [1.0f32.to_bits(); 6]];
    let mut tessellator = Tessellator::default();
    let want = tessellate(&mut tessellator, mode, &patches, &mut Compared::default());
    assert_eq!(difference(&want, &want), None);
    assert_eq!(want.vertices.len() as u32, 3 * want.primitives);
    let last = want.vertices.len() - 1;
    type Plant = fn(&mut Capture, usize);
    let planted: [(&str, Plant); 9] = [
        ("vertex 0", |c, _| c.vertices[0].coordinate[0] ^= 1),
        ("vertex 4", |c, _| c.vertices[4].coordinate[2] = 0x8000_0000),
        ("vertex 3", |c, _| c.vertices.swap(3, 4)),
        ("vertex 0", |c, _| c.vertices.rotate_left(1)),
        ("vertex", |c, last| c.vertices[last].patch = 0),
        ("vertex", |c, last| c.vertices.truncate(last)),
        ("control-shader", |c, _| c.patches += 1),
        ("evaluation-shader", |c, _| c.evaluations -= 1),
        ("primitives", |c, _| c.primitives += 1),
    ];
    for (what, plant) in planted {
        let mut got = want.clone();
        plant(&mut got, last);
        let found = difference(&got, &want).unwrap();
        assert!(found.starts_with(what), "{what}: {found}");
    }
}
