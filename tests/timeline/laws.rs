//! What timelines and counters say of each other.

use crate::runs::{self, set};
use crate::{CROWDED, UNITS, seen, watch, whole};
use std::collections::BTreeMap;
use tessim::config::{Config, Engine};
use tessim::output;
use tessim::report::timeline::{Wanted, Window};
use tessim::report::{Frame, Report};

/// All shipped traces.
fn shipped() -> impl Iterator<Item = &'static str> {
    runs::SHIPPED.into_iter().chain(["zoom"])
}

/// `cycles.*` of a frame but for the sums over states: by block and name.
fn cycles(report: &Report, frame: &Frame) -> BTreeMap<(String, String), u64> {
    let rows = report.rows(frame).into_iter();
    let rows = rows.filter_map(|row| {
        let name = row.name.strip_prefix("cycles.")?.to_owned();
        let is_sum = ["total", "used"].contains(&name.as_str());
        (!is_sum).then(|| ((row.block.name().to_owned(), name), row.value))
    });
    rows.collect()
}

/// The slices of a timeline, added up under the names of counters.
fn slices(seen: &crate::Seen) -> BTreeMap<(String, String), u64> {
    let mut sums = BTreeMap::new();
    for ((block, _), slices) in &seen.lanes {
        for (name, kind, from, to) in slices {
            let name = name.replacen(" by ", ".by.", 1);
            let mut add = |name: &str| {
                *sums.entry((block.clone(), name.to_owned())).or_default() += to - from;
            };
            add(&name);
            if name != *kind {
                add(kind);
            }
        }
    }
    sums
}

/// Holds a timeline against the rows of what it shows; returns how many there are.
fn agree(seen: &crate::Seen, report: &Report, frame: &Frame, place: &str) -> usize {
    let (rows, sums) = (cycles(report, frame), slices(seen));
    for (key, value) in &rows {
        assert_eq!(sums.get(key).unwrap_or(&0), value, "{place}: {key:?}");
    }
    for key in sums.keys() {
        assert!(rows.contains_key(key), "{place}: {key:?} is no row");
    }
    let blocks: Vec<_> = report.chain.iter().map(|stage| stage.block.name()).collect();
    assert_eq!(seen.blocks, blocks, "{place}");
    let total = report
        .rows(frame)
        .into_iter()
        .find(|row| row.block.name() == "link" && row.name == "bytes.total");
    let last = seen.link[seen.link.len() - 1];
    assert_eq!(last.1 + last.2, total.unwrap().value, "{place}: bytes over the link");
    rows.len()
}

/// Cycles by entries, and the most entries.
fn histogram(levels: &[(u64, u64)], end: u64, depth: usize) -> (Vec<u64>, u64) {
    let mut cycles = vec![0; depth + 1];
    let ends = levels.iter().skip(1).map(|level| level.0).chain([end]);
    for (&(at, level), end) in levels.iter().zip(ends) {
        cycles[level as usize] += end - at;
    }
    (cycles, levels.iter().map(|level| level.1).max().unwrap())
}

/// Holds the FIFOs of all frames against the run's; returns how many there are.
fn fifos_agree(frames: &[crate::Seen], report: &Report, place: &str) -> usize {
    for (stage, occupancy) in report.chain.iter().zip(&report.occupancy).skip(1) {
        let name = stage.block.name();
        let mut sum = vec![0; occupancy.len()];
        for (number, seen) in frames.iter().enumerate() {
            let depth = stage.shape.depth as usize;
            let (cycles, most) = histogram(&seen.fifos[name], seen.elapsed, depth);
            sum.iter_mut().zip(cycles).for_each(|(sum, cycles)| *sum += cycles);
            if frames.len() == report.frames.len() {
                // An entry that is first there in the last cycle counts in `fifo.peak` alone: that
                // cycle is not one of the elapsed. No FIFO here is empty until then.
                let rows = report.rows(&report.frames[number]);
                let mut rows = rows.iter().filter(|row| row.block == stage.block);
                let peak = rows.find(|row| row.name == "fifo.peak").unwrap().value;
                assert_eq!(most, peak, "{place}: {name}: fifo.peak of frame {number}");
            }
        }
        assert_eq!(sum, *occupancy, "{place}: {name}");
    }
    report.chain.len() - 1
}

#[test]
fn slices_levels_and_bytes_are_those_of_the_counters() {
    let (mut rows, mut fifos) = (0, 0);
    for name in shipped() {
        let text = runs::shipped(name);
        for unit in UNITS {
            let place = format!("{name}, {unit}");
            let config = set(&[&format!("unit={unit}")]);
            let plain = runs::run(&text, &config);
            let mut frames = Vec::new();
            for (number, frame) in plain.frames.iter().enumerate() {
                let (report, timeline) = watch(&text, &config, &whole(number as u64));
                assert_eq!(runs::said(&report), runs::said(&plain), "{place}: watched or not");
                frames.push(seen(&timeline, &config));
                assert_eq!(frames[number].frame, Some(number as u64));
                rows += agree(&frames[number], &plain, frame, &place);
            }
            fifos += fifos_agree(&frames, &plain, &place);
        }
    }
    println!("compared {rows} rows of cycles, {fifos} FIFOs");
    assert!(rows > 3000 && fifos > 400, "{rows} {fifos}");
}

#[test]
fn lanes_that_wait_for_each_other_or_the_port_are_counted_too() {
    let mut kinds = BTreeMap::<String, u64>::new();
    for text in [runs::shipped("mesh"), runs::teacups(3, 2, 4), runs::resident_grid(18, 3)] {
        for settings in CROWDED {
            for frames in ["frames=drain", "frames=overlap"] {
                let place = format!("{settings:?} {frames}");
                let config = set(&[settings, &[frames]].concat());
                let (report, timeline) = watch(&text, &config, &whole(0));
                let seen = seen(&timeline, &config);
                let of_run = frames == "frames=overlap";
                assert_eq!(seen.frame.is_none(), of_run);
                if of_run {
                    agree(&seen, &report, &report.whole(), &place);
                    fifos_agree(std::slice::from_ref(&seen), &report, &place);
                } else {
                    agree(&seen, &report, &report.frames[0], &place);
                }
                for (name, _, from, to) in seen.lanes.values().flatten() {
                    *kinds.entry(name.clone()).or_default() += to - from;
                }
            }
        }
    }
    for kind in ["blocked by order", "starved by memory_port", "blocked by stitch"] {
        assert!(kinds.get(kind).is_some_and(|&cycles| cycles > 0), "{kind}: {kinds:?}");
    }
}

#[test]
fn both_engines_record_the_same() {
    let mut compared = 0;
    let texts = [runs::shipped("mesh"), runs::resident_grid(6, 2)];
    for (text, wanted) in texts.iter().zip([whole(1), whole(0)]) {
        for settings in CROWDED.into_iter().chain([&["level.union=primitive", "unit=sfarti"][..]]) {
            for frames in ["frames=drain", "frames=overlap"] {
                let config = set(&[settings, &[frames]].concat());
                let [timed, stepped] = [Engine::Timed, Engine::Stepped]
                    .map(|engine| watch(text, &Config { engine, ..config.clone() }, &wanted).1);
                compared += timed.tracks.iter().flat_map(|t| &t.lanes).map(Vec::len).sum::<usize>();
                assert!(timed == stepped, "{settings:?} {frames}");
            }
        }
    }
    println!("compared {compared} slices");
    assert!(compared > 10_000, "{compared}");
}

#[test]
fn a_window_is_the_whole_one_cut() {
    let text = runs::teacups(3, 2, 4);
    let mut compared = 0;
    for settings in [CROWDED[0], CROWDED[3], &["unit=triangles"][..], &["unit=esc"][..]] {
        for frames in ["frames=drain", "frames=overlap"] {
            let config = set(&[settings, &[frames]].concat());
            let frame = u64::from(frames == "frames=drain");
            let all = seen(&watch(&text, &config, &whole(frame)).1, &config);
            let end = all.elapsed;
            for (from, to) in [(0, end), (0, 1), (1, 500), (end / 2, end / 2 + 777), (end - 9, end)]
            {
                let window = Window::Cycles(from..to);
                let part = watch(&text, &config, &Wanted { frame, window }).1;
                assert_eq!(seen(&part, &config), all.cut(from, to), "{from}..{to} {settings:?}");
                compared += to - from;
            }
            // What is asked for beyond the end is not there.
            let window = Window::Cycles(end - 1..end + 1000);
            let part = watch(&text, &config, &Wanted { frame, window }).1;
            assert_eq!(seen(&part, &config), all.cut(end - 1, end));
        }
    }
    println!("compared {compared} cycles");
}

#[test]
fn any_number_of_threads_writes_the_same_bytes() {
    let (text, config) = (runs::teacups(3, 2, 4), set(&[]));
    let labels = output::timeline::Labels { title: "cups", config: &config };
    let [one, four] = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let timeline = pool.install(|| watch(&text, &config, &whole(1)).1);
        let (mut json, mut vcd) = (Vec::new(), Vec::new());
        output::timeline::chrome::write(&timeline, &labels, &mut json).unwrap();
        output::timeline::vcd::write(&timeline, &labels, &mut vcd).unwrap();
        (json, vcd)
    });
    assert!(one == four);
    assert!(one.0.len() > 10_000 && one.1.len() > 10_000);
}
