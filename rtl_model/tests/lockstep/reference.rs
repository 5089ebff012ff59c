//! The rules of `time.rs` for one block between two FIFOs, as they are written there: strips and
//! who is willing when in, the time of everything out.
//!
//! What a strip emits, and when it may, is the block's own [`Schedule`].

use rtl_model::patch::Triangle;
use rtl_model::stitch::Schedule;
use rtl_model::strip::Strip;
use rtl_model::time::Emit;

/// Entries of the FIFO before the block.
pub(crate) const DEPTH_BEFORE: usize = 2;

/// One run: what flows, and who is willing in which cycle.
pub(crate) struct Run {
    /// What the source has, in order.
    pub(crate) strips: Vec<Strip>,
    /// Whether the source would push in a cycle.
    pub(crate) source: Vec<bool>,
    /// Whether the sink would pop in a cycle.
    pub(crate) sink: Vec<bool>,
    /// Entries of the FIFO behind the block.
    pub(crate) depth: usize,
}

/// Times of a run, as far as they lie in its cycles.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Times {
    /// When each strip was accepted.
    pub(crate) accepted: Vec<usize>,
    /// When each triangle left.
    pub(crate) emitted: Vec<(usize, Triangle)>,
    /// Strips that waited for a slot in flight and for nothing else.
    pub(crate) waited_for_slot: usize,
    /// Triangles that waited for room and for nothing else.
    pub(crate) waited_for_room: usize,
}

struct Outputs(Vec<(usize, Triangle)>);

impl Emit<Triangle> for Outputs {
    fn emit(&mut self, triangle: Triangle, offset: u64) {
        self.0.push((offset as usize, triangle));
    }
}

/// The first cycle from `from` on in which one is willing; the run's end if there is none.
fn willing(cycles: &[bool], from: usize) -> usize {
    let later = cycles.get(from..).unwrap_or_default();
    later.iter().position(|&w| w).map_or(cycles.len().max(from), |wait| from + wait)
}

/// The cycle after entry `back` places before the end; 0 where there is none.
fn after(times: &[usize], back: usize) -> usize {
    times.len().checked_sub(back).map_or(0, |index| times[index] + 1)
}

/// The times of `run`.
pub(crate) fn times(run: &Run) -> Times {
    let (schedule, cycles) = (Schedule::default(), run.source.len());
    let mut times = Times::default();
    let (mut pushed, mut accepted, mut left) = (Vec::new(), Vec::new(), Vec::new());
    let (mut emitted, mut popped) = (Vec::new(), Vec::new());
    let (mut interval, mut outputs) = (0, Outputs(Vec::new()));
    for strip in &run.strips {
        pushed.push(willing(&run.source, after(&pushed, 1).max(after(&accepted, DEPTH_BEFORE))));
        let input = after(&pushed, 1).max(accepted.last().map_or(0, |last| last + interval));
        let slot = after(&left, Schedule::IN_FLIGHT as usize);
        let accept = input.max(slot);
        if accept >= cycles {
            break;
        }
        outputs.0.clear();
        interval = schedule.accept(strip, &mut outputs).interval as usize;
        for &(offset, triangle) in &outputs.0 {
            let ready = (accept + offset).max(after(&emitted, 1));
            let room = after(&popped, run.depth);
            emitted.push(ready.max(room));
            popped.push(willing(&run.sink, after(&emitted, 1).max(after(&popped, 1))));
            times.emitted.push((ready.max(room), triangle));
            times.waited_for_room += usize::from(room > ready);
        }
        accepted.push(accept);
        left.push(*emitted.last().expect("a strip has a triangle"));
        times.waited_for_slot += usize::from(slot > input);
    }
    times.accepted = accepted;
    times.emitted.retain(|&(cycle, _)| cycle < cycles);
    times
}
