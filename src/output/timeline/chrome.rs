//! Chrome's trace events, as a JSON object (Trace Event Format, Google 2016): what Perfetto and
//! chrome://tracing show.
//!
//! ```text
//!   process: block        in the order of the data
//!     counter: fifo       entries of the FIFO before it
//!     thread: lane        slices: busy, starved by .., blocked by ..
//!   process: link         also counters: bytes down, bytes up, since the frame began
//! ```
//!
//! The viewers' microsecond is a cycle. Slices are complete events (`X`), which cannot be nested
//! wrongly; numbers of threads are the file's, because Perfetto takes them for the system's, and
//! none is a process's, which would make it that process's main thread.

use super::Labels;
use crate::report::timeline::{Change, Crossed, State, Timeline};
use rtl_model::counter::standard::Stage;
use serde::Serialize;
use std::io::{self, Write};
use std::ops::Range;

/// What the file says of itself.
#[derive(Serialize)]
struct About<'a> {
    tessim: &'static str,
    /// What a unit of time is.
    time: &'static str,
    title: &'a str,
    unit: &'a str,
    clock_mhz: u32,
    /// `null`: all frames, which overlap.
    frame: Option<u64>,
    elapsed: u64,
    window: [u64; 2],
}

/// Writes a timeline.
///
/// # Errors
/// Those of `out`.
pub fn write(timeline: &Timeline, labels: &Labels<'_>, out: &mut impl Write) -> io::Result<()> {
    let Range { start, end } = timeline.window;
    let about = About {
        tessim: env!("CARGO_PKG_VERSION"),
        time: "1 us in the viewer is 1 cycle",
        title: labels.title,
        unit: labels.config.unit.name(),
        clock_mhz: labels.config.clock_mhz,
        frame: timeline.frame,
        elapsed: timeline.elapsed,
        window: [start, end],
    };
    write!(out, "{{\"otherData\":{},\"traceEvents\":[", serde_json::to_string(&about)?)?;
    let mut events = Events { out: &mut *out, any: false };
    let chain = &timeline.chain;
    let mut tid = chain.len();
    for (k, (stage, track)) in chain.iter().zip(&timeline.tracks).enumerate() {
        let pid = k + 1;
        events.process(pid, stage)?;
        if k == 0 {
            events.bytes(pid, &timeline.link)?;
        }
        if let Some(queue) = &track.queue {
            for (at, level) in queue.levels(&timeline.window) {
                events.counter("fifo", pid, at, &format!("\"entries\":{level}"))?;
            }
        }
        let names = State::ALL.map(|state| state.name(chain, k));
        for (number, lane) in track.lanes.iter().enumerate() {
            tid += 1;
            events.lane([pid, tid], number, lane, end, &names)?;
        }
    }
    out.write_all(b"\n]}\n")
}

/// Events, one a line.
struct Events<'a, W> {
    out: &'a mut W,
    any: bool,
}

impl<W: Write> Events<'_, W> {
    fn begin(&mut self) -> io::Result<()> {
        let comma: &[u8] = if self.any { b",\n" } else { b"\n" };
        self.any = true;
        self.out.write_all(comma)
    }

    fn about(&mut self, what: &str, ids: [usize; 2], value: &str) -> io::Result<()> {
        let [pid, tid] = ids;
        self.begin()?;
        write!(
            self.out,
            "{{\"ph\":\"M\",\"name\":\"{what}\",\"pid\":{pid},\"tid\":{tid},\"args\":{{{value}}}}}"
        )
    }

    fn process(&mut self, pid: usize, stage: &Stage) -> io::Result<()> {
        let name = stage.block.name();
        self.about("process_name", [pid, 0], &format!("\"name\":\"{name}\""))?;
        self.about("process_sort_index", [pid, 0], &format!("\"sort_index\":{pid}"))
    }

    fn counter(&mut self, name: &str, pid: usize, at: u64, values: &str) -> io::Result<()> {
        self.begin()?;
        write!(
            self.out,
            "{{\"ph\":\"C\",\"name\":\"{name}\",\"pid\":{pid},\"ts\":{at},\"args\":{{{values}}}}}"
        )
    }

    fn bytes(&mut self, pid: usize, link: &[Crossed]) -> io::Result<()> {
        link.iter().try_for_each(|Crossed { at, down, up }| {
            self.counter("bytes", pid, *at, &format!("\"down\":{down},\"up\":{up}"))
        })
    }

    fn lane(
        &mut self,
        ids: [usize; 2],
        number: usize,
        changes: &[Change],
        end: u64,
        names: &[String; 5],
    ) -> io::Result<()> {
        let [pid, tid] = ids;
        self.about("thread_name", ids, &format!("\"name\":\"lane {number}\""))?;
        self.about("thread_sort_index", ids, &format!("\"sort_index\":{number}"))?;
        let ends = changes.iter().skip(1).map(|change| change.at).chain([end]);
        for (&Change { at, state }, end) in changes.iter().zip(ends) {
            let (name, kind, duration) = (&names[state as usize], state.kind(), end - at);
            self.begin()?;
            write!(
                self.out,
                "{{\"ph\":\"X\",\"name\":\"{name}\",\"cat\":\"{kind}\",\"pid\":{pid},\
                 \"tid\":{tid},\"ts\":{at},\"dur\":{duration}}}"
            )?;
        }
        Ok(())
    }
}
