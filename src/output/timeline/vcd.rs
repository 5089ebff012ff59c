//! A value change dump (IEEE 1364, sec. 18): FIFO levels and handshakes, for waveform viewers.
//!
//! ```text
//!   tessim.BLOCK   the FIFO before a block
//!     level   entries at the start of the cycle
//!     valid   the block upstream has an output that nothing but room keeps from leaving
//!     ready   there is room, as the block upstream sees it: level < depth
//!     push    a token enters: valid and ready
//!     pop     the block takes one
//! ```
//!
//! A step of time is a cycle; viewers call it a nanosecond. The last step, with no change, is the
//! end of the window.

use super::Labels;
use crate::report::timeline::{Queue, State, Timeline, Track};
use ::vcd::{IdCode, TimescaleUnit, Value, Writer};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::io::{self, Write};
use std::ops::Range;

/// What a signal is and becomes: cycles, ascending and at most once each, and its values.
struct Signal<'a> {
    name: &'static str,
    width: u32,
    changes: Box<dyn Iterator<Item = (u64, u64)> + 'a>,
}

/// Writes a timeline.
///
/// # Errors
/// Those of `out`.
pub fn write(timeline: &Timeline, labels: &Labels<'_>, out: &mut impl Write) -> io::Result<()> {
    let mut vcd = Writer::new(out);
    let frame = timeline.frame.map_or("all frames".to_owned(), |frame| format!("frame {frame}"));
    vcd.version(concat!("tessim ", env!("CARGO_PKG_VERSION")))?;
    let title: String = labels.title.chars().filter(|&c| c != '$').collect();
    let unit = labels.config.unit.name();
    vcd.comment(&format!("{title}, unit {unit}, {frame}: 1 ns is 1 cycle"))?;
    vcd.timescale(1, TimescaleUnit::NS)?;
    vcd.add_module("tessim")?;
    let (mut ids, mut sources) = (Vec::new(), Vec::new());
    for (k, pair) in timeline.tracks.windows(2).enumerate() {
        let stage = &timeline.chain[k + 1];
        vcd.add_module(stage.block.name())?;
        let queue = pair[1].queue.as_ref().expect("blocks behind the first have a FIFO");
        for signal in signals(&pair[0], queue, stage.shape.depth, &timeline.window) {
            ids.push((vcd.add_wire(signal.width, signal.name)?, signal.width));
            sources.push(signal.changes);
        }
        vcd.upscope()?;
    }
    vcd.upscope()?;
    vcd.enddefinitions()?;
    dump(&mut vcd, &ids, sources)?;
    vcd.timestamp(timeline.window.end)?;
    vcd.flush()
}

/// The changes of all signals, in the order of time.
fn dump<'a>(
    vcd: &mut Writer<&mut impl Write>,
    ids: &[(IdCode, u32)],
    mut sources: Vec<Box<dyn Iterator<Item = (u64, u64)> + 'a>>,
) -> io::Result<()> {
    let mut next: BinaryHeap<_> = sources
        .iter_mut()
        .enumerate()
        .filter_map(|(k, source)| source.next().map(|(at, value)| Reverse((at, k, value))))
        .collect();
    let mut now = None;
    while let Some(Reverse((at, k, value))) = next.pop() {
        if now != Some(at) {
            vcd.timestamp(at)?;
            now = Some(at);
        }
        let (id, width) = ids[k];
        if width == 1 {
            vcd.change_scalar(id, value == 1)?;
        } else {
            let bit = |place: u32| Value::from(value >> place & 1 == 1);
            vcd.change_vector(id, (0..width).rev().map(bit))?;
        }
        next.extend(sources[k].next().map(|(at, value)| Reverse((at, k, value))));
    }
    Ok(())
}

/// What is known of the FIFO behind `upstream`.
fn signals<'a>(
    upstream: &Track,
    queue: &'a Queue,
    depth: u32,
    window: &'a Range<u64>,
) -> [Signal<'a>; 5] {
    let pulses = |times: &'a [u64]| times.iter().map(|&at| (at, at + 1));
    let wire = |name, spans| Signal { name, width: 1, changes: wire(window, spans) };
    let full =
        queue.levels(window).map(move |(at, level)| (at, u64::from(level < u64::from(depth))));
    let width = u64::BITS - u64::from(depth).leading_zeros();
    [
        Signal { name: "level", width, changes: Box::new(queue.levels(window)) },
        wire("valid", Box::new(offered(upstream, queue, window).into_iter())),
        Signal { name: "ready", width: 1, changes: Box::new(without_repeats(full)) },
        wire("push", Box::new(pulses(&queue.pushed))),
        wire("pop", Box::new(pulses(&queue.popped))),
    ]
}

/// When the block upstream has an output whose turn it is: blocked by nothing but room, or leaving.
fn offered(upstream: &Track, queue: &Queue, window: &Range<u64>) -> Vec<(u64, u64)> {
    let mut spans: Vec<_> = queue.pushed.iter().map(|&at| (at, at + 1)).collect();
    for lane in &upstream.lanes {
        let ends = lane.iter().skip(1).map(|change| change.at).chain([window.end]);
        let all = lane.iter().zip(ends);
        let blocked = all.filter(|(change, _)| change.state == State::Blocked);
        spans.extend(blocked.map(|(change, end)| (change.at, end)));
    }
    spans.sort_unstable();
    spans
}

/// A wire that is 1 in these spans, ascending, and else 0.
fn wire<'a>(
    window: &Range<u64>,
    spans: Box<dyn Iterator<Item = (u64, u64)> + 'a>,
) -> Box<dyn Iterator<Item = (u64, u64)> + 'a> {
    let (start, end) = (window.start, window.end);
    let mut spans = spans.peekable();
    let first = u64::from(spans.peek().is_some_and(|span| span.0 == start));
    let edges = std::iter::from_fn(move || {
        let (from, mut to) = spans.next()?;
        while let Some((_, further)) = spans.next_if(|span| span.0 <= to) {
            to = to.max(further);
        }
        Some([(from, 1), (to, 0)])
    });
    let edges = edges.flatten().filter(move |&(at, _)| start < at && at < end);
    Box::new(std::iter::once((start, first)).chain(edges))
}

fn without_repeats(changes: impl Iterator<Item = (u64, u64)>) -> impl Iterator<Item = (u64, u64)> {
    let mut last = None;
    changes.filter(move |&(_, value)| last.replace(value) != Some(value))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wire_rises_where_spans_begin_and_falls_where_none_follows() {
        let edges = |spans: Vec<(u64, u64)>| -> Vec<_> {
            wire(&(2..9), Box::new(spans.into_iter())).collect()
        };
        assert_eq!(edges(vec![]), [(2, 0)]);
        assert_eq!(edges(vec![(2, 3), (3, 5), (7, 9)]), [(2, 1), (5, 0), (7, 1)]);
        assert_eq!(edges(vec![(4, 8), (5, 6)]), [(2, 0), (4, 1), (8, 0)]);
    }

    #[test]
    fn values_are_said_when_they_change() {
        let changes = [(1, 1), (2, 1), (3, 0), (4, 1)];
        assert_eq!(
            without_repeats(changes.into_iter()).collect::<Vec<_>>(),
            [(1, 1), (3, 0), (4, 1)]
        );
    }
}
