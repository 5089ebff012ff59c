//! The precision study: its search against the whole grid, cracks, what a bit is worth, and the
//! command as users meet it.

#![expect(clippy::unwrap_used, reason = "all of it is test code, helpers too")]

use assert_cmd::Command as Process;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use tessim::config::{Config, Criterion, Overflow, Rounding, Unit};
use tessim::study::precision::evaluators::{self, Evaluator, bits_needed, slope};
use tessim::study::precision::search::exhaustive;
use tessim::study::precision::{self, Axes, Options, Row, Study};
use tessim::trace::command::Command;
use tessim::trace::open::Trace;

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("traces/{name}.jsonl"))
}

fn commands(name: &str) -> Vec<Command> {
    let trace = Trace::open(path(name)).unwrap();
    trace.map(|located| located.unwrap().command).collect()
}

fn base(unit: Unit, level: f64) -> Config {
    let mut config = Config { unit, ..Config::default() };
    (config.level.criterion, config.level.level) = (Some(Criterion::Fixed), Some(level));
    config
}

fn options(axes: Axes) -> Options {
    Options { axes, max_error: 0.25, segments: 0, search: false }
}

fn run(name: &str, base: &Config, options: &Options) -> Study {
    precision::run(&commands(name), base, options, &|| {}).unwrap()
}

/// One point of the grid, the widest but for what is changed.
fn one(name: &str, base: &Config, change: impl FnOnce(&mut Axes), segments: u32) -> Row {
    let mut axes = Axes {
        width: vec![36],
        guard: vec![20],
        reciprocal: vec![32],
        subpixel: vec![12],
        rounding: vec![None],
        overflow: vec![Overflow::Saturate],
    };
    change(&mut axes);
    let study = run(name, base, &Options { segments, ..options(axes) });
    assert_eq!(study.rows.len(), 1);
    study.rows[0].clone()
}

/// 4096 points, and thresholds between which the answer changes.
#[test]
fn a_search_finds_what_the_whole_grid_has_and_runs_less_of_it() {
    let base = base(Unit::Hybrid, 5.0);
    let axes = Axes {
        width: (13..29).collect(),
        guard: (1..17).collect(),
        reciprocal: vec![10, 14, 18, 22],
        subpixel: vec![2, 4, 6, 8],
        rounding: vec![None],
        overflow: vec![Overflow::Saturate],
    };
    let whole = run("teaspoon", &base, &options(axes.clone()));
    assert_eq!(whole.rows.len(), 4096);
    let mut answers = Vec::new();
    for max_error in [2.0, 1.0, 0.25, 0.1, 1e-6] {
        let search = Options { max_error, search: true, ..options(axes.clone()) };
        let found = run("teaspoon", &base, &search);
        let want = exhaustive(&whole.rows, max_error).map(|k| &whole.rows[k]);
        let got = found.narrowest.map(|k| &found.rows[k]);
        assert_eq!(got, want, "{max_error} px");
        let formats = want.map(|row| row.formats);
        let (ran, corners) = (found.rows.len(), found.corner_runs);
        println!("{max_error} px: {ran} of 4096 points and {corners} corners: {formats:?}");
        assert!(2 * ran < 4096, "{ran} points for {max_error} px");
        assert!(corners <= 64, "one for each width and sub-pixel format: {corners}");
        answers.push(formats);
    }
    assert_eq!(answers.pop(), Some(None), "a millionth of a pixel is finer than the sub-pixels");
    assert!(answers.iter().all(Option::is_some) && answers.is_sorted_by(|a, b| a != b));
}

/// Every rounding and overflow, formats so narrow that hardly anything of the picture is left.
/// All four corners behind the eye, the rest before it: the corners say nothing of any format.
#[test]
fn a_search_rules_nothing_out_by_corners_that_are_not_seen() {
    let corner = |k: usize| matches!(k, 0 | 3 | 12 | 15);
    let point = |k: usize| format!("[{},{},{}]", k % 4, k / 4, if corner(k) { 60 } else { -60 });
    let points: Vec<String> = (0..16).map(point).collect();
    let text = format!(
        "{{\"tessim\":1}}\n{{\"frame\":{{\"viewport\":[640,480],\"view\":[1,0,0,0,0,1,0,0,0,0,1,0,\
         -1.5,-1.5,-5,1],\"projection\":[1.5,0,0,0,0,2,0,0,0,0,-1.01,-1,0,0,-0.1,0]}}}}\n\
         {{\"points\":{{\"id\":0,\"xyz\":[{}]}}}}\n{{\"draw\":{{\"primitive\":\"patches\",\
         \"points\":0,\"count\":1}}}}\n{{\"end\":{{}}}}\n",
        points.join(",")
    );
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("corner.jsonl");
    fs::write(&path, text).unwrap();
    let trace = Trace::open(&path).unwrap();
    let commands: Vec<Command> = trace.map(|located| located.unwrap().command).collect();
    let base = base(Unit::Hybrid, 8.0);
    let axes = Axes {
        width: vec![24, 32, 36],
        guard: vec![4, 8],
        reciprocal: vec![20, 32],
        subpixel: vec![4, 8],
        rounding: vec![None],
        overflow: vec![Overflow::Saturate],
    };
    let find = |search| {
        let options = Options { max_error: 500.0, search, ..options(axes.clone()) };
        let study = precision::run(&commands, &base, &options, &|| {}).unwrap();
        study.narrowest.map(|k| study.rows[k].formats)
    };
    let found = find(true);
    assert!(found.is_some());
    assert_eq!(found, find(false));
}

#[test]
fn no_format_cracks_and_vertices_are_compared_to_say_so() {
    for (unit, name) in [(Unit::Hybrid, "teapot"), (Unit::Sfarti, "teacup")] {
        let mut config = Config { unit, ..Config::default() };
        config.level.pixels = Some(2.0);
        let mut axes = Axes::of(&config);
        axes.width = vec![11, 14, 24];
        axes.rounding = Rounding::ALL.map(Some).to_vec();
        axes.overflow = Overflow::ALL.to_vec();
        if unit == Unit::Hybrid {
            (axes.guard, axes.reciprocal) = (vec![1, 20], vec![8, 32]);
        }
        let study = run(name, &config, &options(axes));
        for row in &study.rows {
            let m = &row.measured;
            assert_eq!(m.cracks, 0, "{:?}", row.formats);
            assert!(m.boundary > 50, "{} vertices of {:?}", m.boundary, row.formats);
        }
        let sum: u64 = study.rows.iter().map(|row| row.measured.boundary).sum();
        println!("{name}: {sum} vertices compared in {} formats", study.rows.len());
    }
}

#[test]
fn wide_formats_are_off_by_the_snap_and_narrow_ones_by_what_they_lack() {
    let config = base(Unit::Hybrid, 11.0);
    let wide = one("teapot", &config, |_| {}, 8);
    // Half a sub-pixel of 2^-12 in x and y; the shader's f32 and a reported parameter's 2^-17 add
    // less than a hundredth of a pixel.
    let snap = 0.5f64.hypot(0.5) / 4096.0;
    let m = &wide.measured;
    assert!((snap..0.01).contains(&m.reported.largest), "{}", m.reported.largest);
    assert!(m.reported.rms() < m.reported.largest && m.unplaced == 0);
    assert_eq!([m.lost, m.kept, m.lists_differing, m.saturated], [0; 4]);
    assert!(50 * m.flipped < m.triangles, "{} seen from their edges", m.flipped);
    assert!(m.lists > 100 && m.patches == 32, "{} lists", m.lists);
    // Eleven segments of a teapot are off by pixels, whatever the formats.
    assert!((0.2..20.0).contains(&m.surface.largest_pixels), "{}", m.surface.largest_pixels);
    assert_eq!(m.surface.samples % 81, 0);

    // Coarse sub-pixels: at least a quarter of the step of 1/4 pixel somewhere, at most its
    // diagonal's half.
    let coarse = one("teapot", &config, |axes| axes.subpixel = vec![2], 0).measured.reported;
    assert!((0.125..0.5 * 0.25f64.hypot(0.25) + 0.01).contains(&coarse.largest));
    assert!((coarse.rms() / (0.25 / 6f64.sqrt()) - 1.0).abs() < 0.1, "{}", coarse.rms());

    // A reciprocal of 8 bits puts vertices elsewhere, but on the surface: k R is still what is
    // reported.
    let short = one("teapot", &config, |axes| axes.reciprocal = vec![8], 0).measured;
    assert!(short.exact.largest > 0.5, "{}", short.exact.largest);
    assert!(short.reported.largest < 0.01, "{}", short.reported.largest);

    // Without guard bits differences drift off it, and a narrow position does.
    let drifts = one(
        "teapot",
        &base(Unit::Hybrid, 64.0),
        |axes| {
            (axes.width, axes.guard) = (vec![20], vec![1]);
        },
        0,
    );
    let guarded = one("teapot", &base(Unit::Hybrid, 64.0), |axes| axes.width = vec![20], 0);
    let [drifts, guarded] = [drifts, guarded].map(|row| row.measured.reported.largest);
    assert!(drifts > 20.0 * guarded, "{drifts} px without guard bits, {guarded} with 20");
}

#[test]
fn what_narrow_formats_decide_otherwise_is_counted() {
    let config = Config::default();
    let narrow = one("teapot", &config, |axes| axes.width = vec![10], 0).measured;
    assert!(narrow.lists_differing > 0 && narrow.lists_differing <= narrow.lists);
    assert!(narrow.flipped > 0 && narrow.flat > 0 && narrow.equal_corners > 0);
    assert!(!narrow.serves(0.25));
    let wide = one("teapot", &config, |_| {}, 0).measured;
    assert!(20 * wide.lists_differing < wide.lists, "{} of {}", wide.lists_differing, wide.lists);
    // A range that the teapot does not fit: points saturate, and vertices lose their places.
    let mut small = config.clone();
    small.position.clip_range_log2 = Some(2);
    let small = one("teapot", &small, |_| {}, 0).measured;
    assert!(small.saturated > 0 && small.largest() > 10.0 && !small.serves(0.25));
    // Wrapped round, they are not to be seen at all; the spoon has a back that 12 bits cannot tell.
    let mut wrapped = config.clone();
    wrapped.position.clip_range_log2 = Some(2);
    let wrap = |axes: &mut Axes| (axes.width, axes.overflow) = (vec![12], vec![Overflow::Wrap]);
    let wrapped = one("teapot", &wrapped, wrap, 0).measured;
    assert!(wrapped.lost > 0 && !wrapped.serves(f64::INFINITY));
    let spoon = one("teaspoon", &config, |axes| axes.width = vec![12], 0).measured;
    assert!(spoon.kept > 0 && spoon.lost == 0);
    // Dyadic lists are f64's too, and there is nothing else that they could be.
    let sfarti = Config { unit: Unit::Sfarti, ..Config::default() };
    let sfarti = one("teapot", &sfarti, |_| {}, 0).measured;
    assert!(50 * sfarti.lists_differing < sfarti.lists, "{}", sfarti.lists_differing);
    assert_eq!(sfarti.reported, sfarti.exact);
}

#[test]
fn the_front_has_what_nothing_beats_and_the_narrowest_serves() {
    let base = base(Unit::Hybrid, 11.0);
    let mut axes = Axes::of(&base);
    (axes.width, axes.guard) = ((12..=28).step_by(4).collect(), vec![1, 8, 20]);
    let study = run("teacup", &base, &options(axes));
    let price = |row: &Row| (row.widths.datapath(), row.area, row.measured.largest());
    let better = |a: &Row, b: &Row| {
        let (a, b) = (price(a), price(b));
        a.0 <= b.0 && a.1 <= b.1 && a.2 <= b.2 && a != b
    };
    for (k, row) in study.rows.iter().enumerate() {
        let usable = row.measured.serves(f64::INFINITY);
        let beaten = study.rows.iter().any(|r| r.measured.serves(f64::INFINITY) && better(r, row));
        if study.front.contains(&k) {
            assert!(usable && !beaten, "{:?}", row.formats);
        } else {
            let twin = study.front.iter().any(|&f| price(&study.rows[f]) == price(row));
            assert!(!usable || beaten || twin, "{:?}", row.formats);
        }
    }
    assert!(study.front.len() > 3);
    let narrowest = &study.rows[study.narrowest.unwrap()];
    assert!(narrowest.measured.largest() <= 0.25);
    let serving = study.rows.iter().filter(|row| row.measured.serves(0.25));
    assert!(serving.clone().count() > 3);
    assert!(serving.map(|row| row.area).min() == Some(narrowest.area));
}

/// 6.02 dB a bit: an error that halves. The band is a quarter of a decibel, which a missing or a
/// superfluous rounding does not change but a wrong scale does. Single bits are worth 5 to 6.5 dB,
/// so that it takes some more than two widths below a pixel: 64 steps without guard bits get there
/// with 28.
#[test]
fn a_bit_is_worth_six_decibels_and_steps_cost_bits() {
    let options = evaluators::Options {
        segments: vec![8, 32, 128],
        width: (16..=36).step_by(2).collect(),
        guard: vec![16],
    };
    let config = Config::default();
    let rows = evaluators::run(&commands("teaspoon"), &config, &options, &|| {}).unwrap();
    for segments in [8, 32, 128] {
        for (evaluator, guard) in [
            (Evaluator::DeCasteljau, 0),
            (Evaluator::PowerBasis, 0),
            (Evaluator::Forward, 1),
            (Evaluator::Forward, 16),
        ] {
            let slope = slope(&rows, evaluator, segments, guard).unwrap();
            println!("{} {segments} segments, guard {guard}: {slope:.3} dB", evaluator.name());
            assert!((slope - evaluators::BIT_DB).abs() < 0.25, "{evaluator:?} {segments}: {slope}");
        }
    }
    let bits =
        |evaluator, segments, guard| bits_needed(&rows, evaluator, segments, guard, 0.25).unwrap();
    let forward = [8, 32, 128].map(|n| bits(Evaluator::Forward, n, 1));
    assert!(forward[0] + 4 <= forward[1] && forward[1] + 4 <= forward[2], "{forward:?}");
    let casteljau = [8, 32, 128].map(|n| bits(Evaluator::DeCasteljau, n, 0));
    assert!(casteljau[2] <= casteljau[0] + 2, "{casteljau:?}");
    let guarded = bits(Evaluator::Forward, 128, 16);
    assert!(guarded <= casteljau[2] + 2, "16 guard bits are enough: {guarded}");
}

fn tessim() -> Process {
    Process::cargo_bin("tessim").expect("the command is built for its tests")
}

/// Everything in a folder.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let named =
        files.map(|file| (file.file_name().into_string().unwrap(), fs::read(file.path()).unwrap()));
    named.collect()
}

#[test]
fn the_command_writes_the_same_bytes_at_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let run = |threads: &str, out: &str| {
        let out = folder.path().join(out);
        let mut command = tessim();
        command.arg("precision").arg(path("teaspoon")).args(["--set", "level.level=6"]);
        command.args(["--width", "14..20:3", "--guard", "4,12", "--subpixel", "8"]);
        command.args(["--rounding", "floor,nearest_even", "--overflow", "wrap,saturate"]);
        command.args(["--threads", threads, "--out"]).arg(&out);
        let output = command.output().unwrap();
        assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
        (output.stdout, contents(&out))
    };
    let (text, files) = run("1", "a");
    assert_eq!(run("3", "b"), (text.clone(), files.clone()));
    assert_eq!(run("2", "a"), (text.clone(), files.clone()), "it replaces its like");
    let names: Vec<&str> = files.keys().map(String::as_str).collect();
    assert_eq!(names, ["config.toml", "precision.csv", "precision.svg", "summary.json"]);
    let csv = String::from_utf8(files["precision.csv"].clone()).unwrap();
    let mut lines = csv.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header, precision::CSV_HEADER);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 3 * 2 * 4 * 2 * 2);
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    for row in &rows {
        assert_eq!(row.len(), header.len());
        assert_eq!(row[column("cracks")], "0");
        assert!(row[column("vertices")].parse::<u64>().unwrap() > 100);
        let names = ["unit", "rounding", "overflow"].map(column);
        let numbers = (0..row.len()).filter(|k| !names.contains(k));
        assert!(
            numbers.clone().count() > 40
                && numbers.into_iter().all(|k| row[k].parse::<u64>().is_ok())
        );
    }
    let summary: serde_json::Value = serde_json::from_slice(&files["summary.json"]).unwrap();
    let on_front = rows.iter().filter(|row| row[column("on_front")] == "1").count();
    assert_eq!(summary["front"].as_array().unwrap().len(), on_front);
    assert_eq!(summary["measured"], 96);
    let text = String::from_utf8(text).unwrap();
    assert!(text.contains("96 of 96 points") && text.contains("position.width"), "{text}");
    let mut again = tessim();
    again.args(["run", "--out"]).arg(folder.path().join("a")).arg(path("teaspoon"));
    assert_eq!(again.output().unwrap().status.code(), Some(2), "no run replaces a study");
}

#[test]
fn wrong_options_are_told_what_was_expected() {
    let fails = |arguments: &[&str], says: &str| {
        let mut command = tessim();
        let output = command.arg("precision").args(arguments).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(output.stdout.is_empty() && error.contains(says), "{arguments:?}: {error}");
    };
    let teapot = path("teapot");
    let teapot = teapot.to_str().unwrap();
    fails(&[teapot, "--width", "32..12"], "expected N, A..B or A..B:S");
    fails(&[teapot, "--width", "12,12"], "expected each once");
    fails(&[teapot, "--width", "7"], "position.width: found 7, expected 8..=48");
    fails(&[teapot, "--guard", "0,4"], "evaluate.guard: found 0");
    fails(&[teapot, "--width", "48", "--guard", "20"], "position.width + guard + 3 <= 63");
    fails(&[teapot, "--reciprocal", "33"], "place.reciprocal_bits: found 33, expected 8..=32");
    fails(&[teapot, "--subpixel", "13"], "emit.subpixel_bits: found 13");
    fails(&[teapot, "--rounding", "up"], "nearest_even");
    fails(&[teapot, "--overflow", "clamp"], "expected wrap, saturate");
    fails(&[teapot, "--max-error", "0"], "above 0");
    fails(&[teapot, "--unit", "moreton"], "expected hybrid or sfarti");
    fails(&[teapot, "--unit", "sfarti", "--guard", "4"], "--guard: found it with unit sfarti");
    fails(&[teapot, "--unit", "sfarti", "--reciprocal", "16"], "--reciprocal: found it");
    fails(&[teapot, "--set", "emit.divide=false"], "emit.divide");
    let many = ["--width", "8..48", "--guard", "1..12", "--reciprocal", "8..32", "--subpixel"];
    fails(&[&[teapot][..], &many, &["0..12"]].concat(), "expected 1 to 65536 points");
    fails(&["traces/none.jsonl", "--rounding", "floor,floor"], "found floor twice");
}
