//! A Chrome trace read back: only what the format says, and what a viewer wants of it.

use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};

#[derive(Deserialize)]
#[serde(rename_all = "camelCase", deny_unknown_fields)]
struct File {
    other_data: About,
    trace_events: Vec<Event>,
}

#[derive(Deserialize)]
struct About {
    time: String,
    title: String,
    window: [u64; 2],
    elapsed: u64,
    frame: Option<u64>,
}

#[derive(Deserialize)]
#[serde(tag = "ph", deny_unknown_fields)]
enum Event {
    #[serde(rename = "M")]
    Metadata { name: String, pid: u64, tid: u64, args: Argument },
    #[serde(rename = "X")]
    Complete { name: String, cat: String, pid: u64, tid: u64, ts: u64, dur: u64 },
    #[serde(rename = "C")]
    Counter { name: String, pid: u64, ts: u64, args: BTreeMap<String, u64> },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Argument {
    name: Option<String>,
    sort_index: Option<u64>,
}

/// A slice: its name, its category, from when to when.
pub(crate) type Slice = (String, String, u64, u64);

/// What a viewer shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Seen {
    pub(crate) window: [u64; 2],
    pub(crate) elapsed: u64,
    pub(crate) frame: Option<u64>,
    /// Blocks from top to bottom.
    pub(crate) blocks: Vec<String>,
    /// Slices by block and lane.
    pub(crate) lanes: BTreeMap<(String, String), Vec<Slice>>,
    /// Cycles and entries.
    pub(crate) fifos: BTreeMap<String, Vec<(u64, u64)>>,
    /// Cycles and bytes in both directions.
    pub(crate) link: Vec<(u64, u64, u64)>,
}

impl Seen {
    pub(crate) fn read(bytes: &[u8]) -> Self {
        let File { other_data: about, trace_events: events } =
            serde_json::from_slice(bytes).unwrap();
        assert_eq!(about.time, "1 us in the viewer is 1 cycle");
        assert_eq!(about.title, "a \"trace\"");
        let About { window, elapsed, frame, .. } = about;
        let mut seen = Self { window, elapsed, frame, ..Self::default() };
        let names = Names::of(&events);
        seen.blocks = names.sorted();
        for event in events {
            seen.take(event, &names);
        }
        seen.check();
        seen
    }

    fn take(&mut self, event: Event, names: &Names) {
        match event {
            Event::Metadata { .. } => {}
            Event::Complete { name, cat, pid, tid, ts, dur } => {
                let lane = (names.blocks[&pid].0.clone(), names.lanes[&(pid, tid)].clone());
                self.lanes.entry(lane).or_default().push((name, cat, ts, ts + dur));
            }
            Event::Counter { name, pid, ts, args } if name == "fifo" => {
                assert_eq!(args.len(), 1);
                let fifo = self.fifos.entry(names.blocks[&pid].0.clone()).or_default();
                fifo.push((ts, args["entries"]));
            }
            Event::Counter { name, pid, ts, args } => {
                assert_eq!((name.as_str(), names.blocks[&pid].0.as_str()), ("bytes", "link"));
                assert_eq!(args.len(), 2);
                self.link.push((ts, args["down"], args["up"]));
            }
        }
    }

    /// Each track begins where the window does and goes forward; slices follow each other without
    /// a gap to its end, each another one.
    fn check(&self) {
        let [start, end] = self.window;
        assert!(start < end && end <= self.elapsed);
        for (lane, slices) in &self.lanes {
            assert_eq!((slices[0].2, slices[slices.len() - 1].3), (start, end), "{lane:?}");
            assert!(slices.iter().all(|slice| slice.2 < slice.3), "{lane:?}");
            assert!(slices.windows(2).all(|p| p[0].3 == p[1].2 && p[0].0 != p[1].0), "{lane:?}");
            assert!(slices.iter().all(|(name, kind, ..)| name.starts_with(kind)), "{lane:?}");
        }
        for (block, levels) in &self.fifos {
            assert_eq!(levels[0].0, start, "{block}");
            assert!(levels.windows(2).all(|p| p[0].0 < p[1].0 && p[0].1 != p[1].1), "{block}");
            assert!(levels.iter().all(|level| level.0 < end), "{block}");
        }
        assert_eq!(self.link[0].0, start);
        assert!(self.link.windows(2).all(|p| p[0].0 < p[1].0 && p[0].1 + p[0].2 < p[1].1 + p[1].2));
        assert!(self.link.iter().all(|crossed| crossed.0 < end));
    }

    /// What is left of it in these cycles.
    pub(crate) fn cut(&self, from: u64, to: u64) -> Self {
        let mut cut = Self { window: [from, to], ..self.clone() };
        for slices in cut.lanes.values_mut() {
            slices.retain(|slice| slice.2 < to && slice.3 > from);
            slices.iter_mut().for_each(|s| (s.2, s.3) = (s.2.max(from), s.3.min(to)));
        }
        for levels in cut.fifos.values_mut() {
            let before = *levels.iter().rev().find(|level| level.0 <= from).unwrap();
            levels.retain(|level| level.0 > from && level.0 < to);
            levels.insert(0, (from, before.1));
        }
        let before = *cut.link.iter().rev().find(|crossed| crossed.0 <= from).unwrap();
        cut.link.retain(|crossed| crossed.0 > from && crossed.0 < to);
        cut.link.insert(0, (from, before.1, before.2));
        cut
    }
}

/// Names of processes, each with its place, and of threads.
#[derive(Default)]
struct Names {
    blocks: BTreeMap<u64, (String, Option<u64>)>,
    lanes: BTreeMap<(u64, u64), String>,
}

impl Names {
    fn of(events: &[Event]) -> Self {
        let mut names = Self::default();
        for event in events {
            let Event::Metadata { name, pid, tid, args } = event else { continue };
            let text = args.name.clone();
            match (name.as_str(), text, args.sort_index) {
                ("process_name", Some(text), None) => {
                    assert!(names.blocks.insert(*pid, (text, None)).is_none());
                }
                ("process_sort_index", None, Some(place)) => {
                    names.blocks.get_mut(pid).unwrap().1 = Some(place);
                }
                ("thread_name", Some(text), None) => {
                    assert!(names.lanes.insert((*pid, *tid), text).is_none());
                }
                ("thread_sort_index", None, Some(_)) => {}
                (name, ..) => panic!("metadata {name}"),
            }
        }
        let threads: BTreeSet<_> = names.lanes.keys().map(|&(_, tid)| tid).collect();
        assert_eq!(threads.len(), names.lanes.len(), "threads have numbers of their own");
        assert!(threads.iter().all(|tid| !names.blocks.contains_key(tid)));
        names
    }

    fn sorted(&self) -> Vec<String> {
        let mut blocks: Vec<_> = self.blocks.values().map(|(n, p)| (p.unwrap(), n)).collect();
        blocks.sort();
        blocks.into_iter().map(|(_, name)| name.clone()).collect()
    }
}
