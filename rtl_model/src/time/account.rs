//! The books of the engines that compute times: the credits and the occupancy of a FIFO, the slots
//! and the cycles of a lane.
//!
//! Times come in as they are computed, in the order of tokens, and never go back, so that a union
//! of intervals is one running maximum and a histogram is two pointers.

use super::{LaneOrder, Shape, StageTimes};

/// The FIFO before a block: when its entries were taken, and how full it was.
#[derive(Clone, Debug)]
pub(super) struct Fifo {
    /// The cycle after each of the last `depth` acceptances: when the producer sees the room.
    credits: Box<[u64]>,
    /// Where the next token's acceptance goes, which is where that of `depth` tokens ago stands.
    next: usize,
    /// Up to which cycle `cycles` is complete.
    cursor: u64,
    /// Entries at the start of that cycle.
    held: usize,
    /// Most entries since the frame began.
    peak: u64,
    /// Cycles at the start of which there were 0, 1, .. entries.
    cycles: Vec<u64>,
}

impl Fifo {
    pub(super) fn new(depth: u32) -> Self {
        let depth = depth as usize;
        let credits = vec![0; depth].into_boxed_slice();
        Self { credits, next: 0, cursor: 0, held: 0, peak: 0, cycles: vec![0; depth + 1] }
    }

    /// The first cycle in which the next token may be pushed.
    #[inline(always)]
    pub(super) fn room(&self) -> u64 {
        self.credits[self.next]
    }

    /// The same for the token after `waiting` more, fewer than `depth`, which are not accepted.
    pub(super) fn room_behind(&self, waiting: usize) -> u64 {
        self.credits[(self.next + waiting) % self.credits.len()]
    }

    /// The next token, seen from the start of cycle `arrived`, was accepted in cycle `accept`.
    #[inline(always)]
    pub(super) fn pass(&mut self, arrived: u64, accept: u64) {
        self.pop_until(arrived);
        self.advance(arrived);
        self.held += 1;
        self.peak = self.peak.max(self.held as u64);
        self.credits[self.next] = accept + 1;
        self.next += 1;
        if self.next == self.credits.len() {
            self.next = 0;
        }
    }

    /// Takes out the entries that were accepted before `cycle`.
    #[inline(always)]
    fn pop_until(&mut self, cycle: u64) {
        while self.held > 0 {
            let oldest = if self.next >= self.held {
                self.next - self.held
            } else {
                self.next + self.credits.len() - self.held
            };
            let seen = self.credits[oldest];
            if seen > cycle {
                break;
            }
            self.advance(seen);
            self.held -= 1;
        }
    }

    #[inline(always)]
    fn advance(&mut self, cycle: u64) {
        self.cycles[self.held] += cycle - self.cursor;
        self.cursor = cycle;
    }

    /// The most entries at the start of any cycle of the frame that ends here.
    pub(super) fn take_peak(&mut self) -> u64 {
        std::mem::take(&mut self.peak)
    }

    /// All has left by cycle `elapsed`, and time starts again at 0.
    pub(super) fn drain(&mut self, elapsed: u64) {
        // What was accepted in the last cycle, which does not count, is still held at its start.
        self.pop_until(elapsed);
        self.advance(elapsed);
        self.credits.fill(0);
        (self.next, self.cursor, self.held) = (0, 0, 0);
    }

    /// The histogram.
    pub(super) fn into_cycles(self) -> Vec<u64> {
        self.cycles
    }
}

/// One lane of a block.
#[derive(Clone, Debug)]
pub(super) struct Lane {
    /// The cycle after each of its last tokens left: when their slots are free again.
    slots: Box<[u64]>,
    slot: usize,
    /// The cycle after its last token left.
    pub(super) head: u64,
    /// In flight up to this cycle.
    covered: u64,
    /// Where its share of the frame began.
    start: u64,
    /// The frame of its last token.
    frame: usize,
    /// Frames that the next one overlaps and where their shares ended, as far as that may be after
    /// the end of the run.
    ends: Vec<(usize, u64)>,
    /// Cycles in flight since then.
    in_flight: u64,
    /// Of these, blocked by downstream.
    pub(super) blocked: u64,
    /// Of these, blocked by order.
    pub(super) by_order: u64,
    /// Of those not in flight, starved by the port.
    by_port: u64,
}

impl Lane {
    fn new(in_flight: u32) -> Self {
        Self {
            slots: vec![0; in_flight as usize].into_boxed_slice(),
            slot: 0,
            head: 0,
            covered: 0,
            start: 0,
            frame: 0,
            ends: Vec::new(),
            in_flight: 0,
            blocked: 0,
            by_order: 0,
            by_port: 0,
        }
    }

    /// A token accepted at `accept` left at `left`; the lane accepts its next from `next` on.
    /// Returns the first cycle in which it has both time and a slot for one.
    #[inline(always)]
    pub(super) fn done(&mut self, accept: u64, left: u64, next: u64, frame: usize) -> u64 {
        let end = next.max(left + 1);
        self.in_flight += end - accept.max(self.covered);
        self.covered = end;
        self.head = left + 1;
        self.frame = frame;
        self.slots[self.slot] = left + 1;
        self.slot += 1;
        if self.slot == self.slots.len() {
            self.slot = 0;
        }
        next.max(self.slots[self.slot])
    }

    /// When the slot is free that the token after `in_flight` more takes; `None` while those hold
    /// all slots.
    pub(super) fn slot_behind(&self, in_flight: usize) -> Option<u64> {
        let slots = self.slots.len();
        (in_flight < slots).then(|| self.slots[(self.slot + in_flight) % slots])
    }

    /// The next token is of this frame: if that is another one, the lane's share of the last one's
    /// ends where its last token does.
    pub(super) fn turn_to<'a>(
        &mut self,
        frame: usize,
        times: impl FnOnce(usize) -> &'a mut StageTimes,
    ) {
        if frame != self.frame {
            self.close_overlapped(times(self.frame));
        }
    }

    /// Closes the lane's share of a frame where its last token is through it.
    fn close_overlapped(&mut self, times: &mut StageTimes) {
        let end = self.covered.max(self.start);
        self.close(end, times);
        let head = self.head;
        self.ends.retain(|&(_, end)| end >= head);
        self.ends.push((self.frame, end));
    }

    /// Extends or cuts the lane's shares to the end of the run.
    fn finish(&mut self, elapsed: u64, last: usize, times: &mut [StageTimes]) {
        let tail = elapsed.saturating_sub(self.start);
        times[last].starved += tail;
        times[last].total += tail;
        // A token that leaves in the last cycle, or an initiation interval that outlasts the run.
        let mut from = elapsed;
        for (frame, end) in std::mem::take(&mut self.ends) {
            let over = end.saturating_sub(from);
            times[frame].busy -= over;
            times[frame].total -= over;
            from = from.max(end);
        }
    }

    /// A token that could have been accepted at `from` waited for the port until `accept`.
    pub(super) fn waited(&mut self, from: u64, accept: u64) {
        self.by_port += accept.saturating_sub(from.max(self.covered));
    }

    /// Closes the lane's share of a frame at cycle `end`, and adds it to the block's.
    ///
    /// # Panics
    /// When the cycles do not add up.
    fn close(&mut self, end: u64, times: &mut StageTimes) {
        // An initiation interval may outlast the run.
        let in_flight = self.in_flight - self.covered.saturating_sub(end);
        let total = end - self.start;
        let taken = self.blocked + self.by_order;
        assert!(taken <= in_flight && in_flight + self.by_port <= total, "cycles add up: {self:?}");
        times.busy += in_flight - taken;
        times.blocked += self.blocked;
        times.blocked_by_order += self.by_order;
        times.starved_by_port += self.by_port;
        times.starved += total - in_flight - self.by_port;
        times.total += total;
        (self.start, self.in_flight, self.blocked) = (end, 0, 0);
        (self.by_order, self.by_port) = (0, 0);
    }

    fn drain(&mut self) {
        self.slots.fill(0);
        (self.slot, self.head, self.covered, self.start) = (0, 0, 0, 0);
    }
}

/// The lanes of a block.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    order: LaneOrder,
    /// Of round robin: the next lane.
    turn: usize,
    /// When each lane has time and a slot for a token.
    ready: Vec<u64>,
    pub(super) lanes: Vec<Lane>,
}

impl Lanes {
    pub(super) fn new(shape: &Shape) -> Self {
        let lanes = shape.lanes as usize;
        Self {
            order: shape.order,
            turn: 0,
            ready: vec![0; lanes],
            lanes: vec![Lane::new(shape.in_flight); lanes],
        }
    }

    /// The lane that takes a token which could be accepted at `from`, and when it does.
    #[inline(always)]
    pub(super) fn choose(&self, from: u64) -> (usize, u64) {
        if let [ready] = self.ready[..] {
            return (0, ready.max(from));
        }
        let lane = match self.order {
            LaneOrder::RoundRobin => self.turn,
            LaneOrder::FirstFree => self.first_free(from),
        };
        (lane, self.ready[lane].max(from))
    }

    fn first_free(&self, from: u64) -> usize {
        let mut best = 0;
        for (lane, &ready) in self.ready.iter().enumerate() {
            if ready <= from {
                return lane;
            }
            if ready < self.ready[best] {
                best = lane;
            }
        }
        best
    }

    /// The lane took its token and is ready for the next one at `ready`.
    #[inline(always)]
    pub(super) fn took(&mut self, lane: usize, ready: u64) {
        self.ready[lane] = ready;
        self.turn += 1;
        if self.turn >= self.ready.len() {
            self.turn = 0;
        }
    }

    /// It is known anew when the lane has time and a slot for a token.
    pub(super) fn set_ready(&mut self, lane: usize, ready: u64) {
        self.ready[lane] = ready;
    }

    /// When the lane has time and a slot for a token.
    pub(super) fn ready(&self, lane: usize) -> u64 {
        self.ready[lane]
    }

    /// Closes a frame that is drained: every lane's share of it ends at `elapsed`, and time starts
    /// again.
    pub(super) fn drain(&mut self, elapsed: u64, times: &mut StageTimes) {
        for lane in &mut self.lanes {
            lane.close(elapsed, times);
            lane.drain();
        }
        self.ready.fill(0);
        self.turn = 0;
    }

    /// Closes a frame that the next one overlaps: a lane's share of it ends where its last token
    /// does.
    pub(super) fn overlap(&mut self, times: &mut StageTimes) {
        for lane in &mut self.lanes {
            lane.close_overlapped(times);
        }
    }

    /// Extends or cuts the lanes' shares to the end of the run. `times` gives the block's times in
    /// a frame.
    pub(super) fn finish(&mut self, elapsed: u64, last: usize, times: &mut [StageTimes]) {
        for lane in &mut self.lanes {
            lane.finish(elapsed, last, times);
        }
    }
}
