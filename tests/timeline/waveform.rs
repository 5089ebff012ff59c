//! A value change dump read back by a reader of its own, and held against the Chrome trace and the
//! laws of a handshake.

use crate::runs::{self, set};
use crate::{CROWDED, seen, watch, whole};
use std::collections::BTreeMap;
use tessim::config::Config;
use tessim::output::timeline::{Labels, vcd};
use tessim::report::timeline::{Timeline, Wanted, Window};

/// Value changes by the full name of a signal, and the last time.
struct Dump {
    signals: BTreeMap<String, Vec<(u64, u64)>>,
    end: u64,
}

fn dump(timeline: &Timeline, config: &Config) -> Dump {
    let mut bytes = Vec::new();
    vcd::write(timeline, &Labels { title: "a $title $end", config }, &mut bytes).unwrap();
    read(std::str::from_utf8(&bytes).unwrap())
}

/// IEEE 1364, sec. 18.2, as far as it is used.
fn read(text: &str) -> Dump {
    let (header, body) = text.split_once("$enddefinitions $end").unwrap();
    let (mut scope, mut names) = (Vec::new(), BTreeMap::new());
    let mut timescale = None;
    for declaration in header.split("$end").map(str::trim).filter(|text| !text.is_empty()) {
        let words: Vec<_> = declaration.split_whitespace().collect();
        match words[..] {
            ["$scope", "module", name] => scope.push(name),
            ["$upscope"] => assert!(scope.pop().is_some()),
            ["$var", "wire", width, id, name] => {
                let name = format!("{}.{name}", scope.join("."));
                let width: usize = width.parse().unwrap();
                assert!(names.insert(id, (name, width)).is_none(), "{declaration}");
            }
            ["$timescale", ..] => timescale = Some(words[1..].concat()),
            ["$comment" | "$version", ..] => {}
            _ => panic!("{declaration}"),
        }
    }
    assert_eq!((timescale.as_deref(), scope.len()), (Some("1ns"), 0));
    let mut signals: BTreeMap<_, Vec<_>> = BTreeMap::new();
    let mut now = None;
    for line in body.lines().map(str::trim).filter(|line| !line.is_empty()) {
        if let Some(time) = line.strip_prefix('#') {
            let time: u64 = time.parse().unwrap();
            assert!(now.is_none_or(|now| now < time), "time goes forward: {line}");
            now = Some(time);
            continue;
        }
        let (value, id) = match line.strip_prefix('b') {
            Some(vector) => vector.split_once(' ').unwrap(),
            None => line.split_at(1),
        };
        let (name, width) = &names[id];
        assert!(value.len() <= *width, "{line}");
        let value = u64::from_str_radix(value, 2).unwrap();
        signals.entry(name.clone()).or_default().push((now.unwrap(), value));
    }
    assert_eq!(signals.len(), names.len(), "every signal has a value");
    Dump { signals, end: now.unwrap() }
}

/// A signal in each cycle from `start` on.
fn cycles(dump: &Dump, name: &str, start: u64) -> Vec<u64> {
    let changes = &dump.signals[name];
    assert_eq!(changes[0].0, start, "{name}");
    let mut cycles = Vec::new();
    for (k, &(at, value)) in changes.iter().enumerate() {
        let end = changes.get(k + 1).map_or(dump.end, |next| next.0);
        assert!(at < end && changes.get(k + 1).is_none_or(|next| next.1 != value), "{name}");
        cycles.resize((end - start) as usize, value);
    }
    cycles
}

#[test]
fn levels_are_those_of_the_chrome_trace_and_handshakes_keep_their_laws() {
    let (mut compared, mut refused) = (0, 0);
    for text in [runs::shipped("mesh"), runs::teacups(3, 1, 4)] {
        for settings in CROWDED.into_iter().chain([&["unit=d3d11"][..], &["unit=triangles"]]) {
            let config = set(settings);
            let (report, timeline) = watch(&text, &config, &whole(0));
            let end = timeline.window.end;
            for (from, to) in [(0, end), (end / 3, end / 2)] {
                let window = Window::Cycles(from..to);
                let timeline = watch(&text, &config, &Wanted { frame: 0, window }).1;
                let (dump, seen) = (dump(&timeline, &config), seen(&timeline, &config));
                assert_eq!(dump.end, to);
                assert_eq!(dump.signals.len(), 5 * (report.chain.len() - 1));
                for stage in &report.chain[1..] {
                    let (name, depth) = (stage.block.name(), u64::from(stage.shape.depth));
                    let of = |signal| cycles(&dump, &format!("tessim.{name}.{signal}"), from);
                    let [level, valid, ready, push, pop] =
                        ["level", "valid", "ready", "push", "pop"].map(of);
                    assert_eq!(dump.signals[&format!("tessim.{name}.level")], seen.fifos[name]);
                    for c in 0..level.len() {
                        assert_eq!(ready[c], u64::from(level[c] < depth), "{name} {c}");
                        assert_eq!(push[c], valid[c] & ready[c], "{name} {c} {settings:?}");
                        assert!(pop[c] == 0 || level[c] > 0, "{name} {c}");
                        if let Some(next) = level.get(c + 1) {
                            assert_eq!(*next, level[c] + push[c] - pop[c], "{name} {c}");
                        }
                        refused += valid[c] & (1 - ready[c]);
                    }
                    compared += level.len();
                }
            }
        }
    }
    println!("compared {compared} cycles of FIFOs, {refused} of them with an output and no room");
    assert!(refused > 1000, "{refused}");
}
