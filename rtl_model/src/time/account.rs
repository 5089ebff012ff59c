//! The books of the engines that compute times: the credits and the occupancy of a FIFO, the slots
//! and the cycles of a lane.
//!
//! Times come in as they are computed, in the order of tokens, and never go back, so that a union
//! of intervals is one running maximum and a histogram is two pointers. What nothing waits for is
//! the most frequent case, and costs least: it leaves no trace but a count.

use super::{LaneOrder, Shape, StageTimes};

/// The FIFO before a block: when its entries were taken, and how full it was.
#[derive(Clone, Debug)]
pub(super) struct Fifo {
    /// The cycle after each of the last `depth` acceptances: when the producer sees the room.
    credits: Box<[u64]>,
    /// Where the next token's acceptance goes, which is where that of `depth` tokens ago stands.
    next: usize,
    /// Where that of the next token to be pushed goes.
    tail: usize,
    /// Entries at the start of cycle `cursor`, up to which `cycles` is complete.
    held: usize,
    cursor: u64,
    /// Where the acceptance of the oldest of these stands.
    oldest: usize,
    /// Entries that were alone, and taken in the first cycle in which they were seen.
    prompt: u64,
    /// Of these, in earlier frames.
    prompt_before: u64,
    /// Cycles at the start of which there were 0, 1, .. entries, but for the prompt ones; those
    /// with none are what is left of the run.
    cycles: Box<[u64]>,
    /// Most entries since the frame began.
    peak: usize,
}

impl Fifo {
    pub(super) fn new(depth: u32) -> Self {
        let depth = depth as usize;
        Self {
            credits: vec![0; depth].into_boxed_slice(),
            next: 0,
            tail: 0,
            held: 0,
            cursor: 0,
            oldest: 0,
            prompt: 0,
            prompt_before: 0,
            cycles: vec![0; depth + 1].into_boxed_slice(),
            peak: 0,
        }
    }

    /// Pushes a token, behind fewer than `depth` of which it is not known when they are accepted.
    /// Returns the first cycle in which there is room for it.
    #[inline(always)]
    pub(super) fn push(&mut self) -> u64 {
        let room = self.credits[self.tail];
        self.tail = self.after(self.tail);
        room
    }

    /// The first cycle in which there is room for the token after `waiting` more, fewer than
    /// `depth`, which are not accepted.
    pub(super) fn room_behind(&self, waiting: usize) -> u64 {
        self.credits[(self.next + waiting) % self.credits.len()]
    }

    fn after(&self, index: usize) -> usize {
        if index + 1 == self.credits.len() { 0 } else { index + 1 }
    }

    /// The next token, seen from the start of cycle `arrived`, was accepted in cycle `accept`.
    #[inline(always)]
    pub(super) fn pass(&mut self, arrived: u64, accept: u64) {
        if self.held > 0 {
            self.pop_until(arrived);
        }
        if self.held == 0 && accept == arrived {
            self.prompt += 1;
        } else {
            self.queue(arrived);
        }
        self.credits[self.next] = accept + 1;
        self.next = self.after(self.next);
    }

    /// It waited, or found others.
    #[inline(always)]
    fn queue(&mut self, arrived: u64) {
        if self.held == 0 {
            self.oldest = self.next;
        } else {
            self.cycles[self.held] += arrived - self.cursor;
        }
        self.cursor = arrived;
        self.held += 1;
        self.peak = self.peak.max(self.held);
    }

    /// Takes out the entries that were accepted before `cycle`.
    #[inline(always)]
    fn pop_until(&mut self, cycle: u64) {
        while self.held > 0 {
            let seen = self.credits[self.oldest];
            if seen > cycle {
                break;
            }
            self.cycles[self.held] += seen - self.cursor;
            self.cursor = seen;
            self.held -= 1;
            self.oldest = self.after(self.oldest);
        }
    }

    /// The most entries at the start of any cycle of the frame that ends here.
    pub(super) fn take_peak(&mut self) -> u64 {
        let any_prompt = self.prompt != self.prompt_before;
        self.prompt_before = self.prompt;
        std::mem::take(&mut self.peak).max(usize::from(any_prompt)) as u64
    }

    /// All has left by cycle `elapsed`, and time starts again at 0.
    pub(super) fn drain(&mut self, elapsed: u64) {
        let last = self.next.checked_sub(1).unwrap_or(self.credits.len() - 1);
        if self.held == 0 && self.credits[last] > elapsed {
            // The last entry was prompt, in the cycle that does not count.
            self.prompt -= 1;
            self.prompt_before -= 1;
        }
        // What was accepted in that cycle is still held at its start.
        self.pop_until(elapsed);
        if self.held > 0 {
            self.cycles[self.held] += elapsed - self.cursor;
        }
        self.cycles[0] += elapsed;
        self.credits.fill(0);
        (self.next, self.tail, self.cursor, self.held) = (0, 0, 0, 0);
    }

    /// The histogram.
    pub(super) fn into_cycles(mut self) -> Vec<u64> {
        self.cycles[1] += self.prompt;
        let some: u64 = self.cycles[1..].iter().sum();
        self.cycles[0] -= some;
        self.cycles.into_vec()
    }
}

/// One lane of a block.
#[derive(Clone, Debug)]
pub(super) struct Lane {
    /// The first cycle in which it has time and a slot for a token.
    pub(super) ready: u64,
    /// The cycle after each of its last tokens left: when their slots are free again.
    slots: Box<[u64]>,
    slot: usize,
    /// The cycle after its last token left.
    pub(super) head: u64,
    /// In flight up to this cycle.
    covered: u64,
    /// Cycles since its share of the frame began in which it was not in flight.
    idle: u64,
    /// Of these, starved by the port.
    by_port: u64,
    /// Cycles in flight in which it was blocked by downstream.
    pub(super) blocked: u64,
    /// By order.
    pub(super) by_order: u64,
    /// Cycles within initiation intervals.
    used: u64,
    /// When the last of these ends.
    next: u64,
    /// The frame of its last token.
    frame: usize,
    /// Where its share of the frame began.
    start: u64,
    /// Frames that the next one overlaps and where their shares ended, as far as that may be after
    /// the end of the run.
    ends: Vec<(usize, u64)>,
}

impl Lane {
    fn new(in_flight: u32) -> Self {
        Self {
            ready: 0,
            slots: vec![0; in_flight as usize].into_boxed_slice(),
            slot: 0,
            head: 0,
            covered: 0,
            idle: 0,
            by_port: 0,
            blocked: 0,
            by_order: 0,
            used: 0,
            next: 0,
            frame: 0,
            start: 0,
            ends: Vec::new(),
        }
    }

    /// A token accepted at `accept` left at `left`; the lane accepts its next from `next` on.
    /// Returns the first cycle in which it has both time and a slot for one.
    #[inline(always)]
    pub(super) fn done(&mut self, accept: u64, left: u64, next: u64, frame: usize) -> u64 {
        self.idle += accept.saturating_sub(self.covered);
        self.head = left + 1;
        self.covered = next.max(left + 1);
        self.used += next - accept;
        self.next = next;
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

    /// A token that could have been accepted at `from` waited for the port until `accept`.
    pub(super) fn waited(&mut self, from: u64, accept: u64) {
        self.by_port += accept.saturating_sub(from.max(self.covered));
    }

    /// The next token is of this frame: if that is another one, the lane's share of the last one's
    /// ends where its last token does.
    pub(super) fn turn_to<'a>(
        &mut self,
        frame: usize,
        times: impl FnOnce(usize) -> &'a mut StageTimes,
    ) {
        if frame != self.frame {
            self.overlap(times(self.frame));
        }
    }

    /// Closes the lane's share of a frame at cycle `end`, and adds it to the block's.
    ///
    /// # Panics
    /// When the cycles do not add up.
    fn close(&mut self, end: u64, times: &mut StageTimes) {
        // An initiation interval may outlast the run; else the lane idles at the end.
        let idle = self.idle + end.saturating_sub(self.covered);
        let total = end - self.start;
        let taken = self.blocked + self.by_order;
        assert!(taken + idle <= total && self.by_port <= idle, "cycles add up: {self:?}");
        times.busy += total - idle - taken;
        times.blocked += self.blocked;
        times.blocked_by_order += self.by_order;
        times.starved_by_port += self.by_port;
        times.starved += idle - self.by_port;
        times.total += total;
        times.used += self.used - self.next.saturating_sub(end);
        (self.start, self.idle, self.by_port) = (end, 0, 0);
        (self.blocked, self.by_order, self.used) = (0, 0, 0);
    }

    /// Closes the lane's share of a frame where its last token is through it.
    fn overlap(&mut self, times: &mut StageTimes) {
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
        times[self.frame].used -= self.next.saturating_sub(elapsed);
        // A token that leaves in the last cycle, or an initiation interval that outlasts the run.
        let mut from = elapsed;
        for (frame, end) in std::mem::take(&mut self.ends) {
            let over = end.saturating_sub(from);
            times[frame].busy -= over;
            times[frame].total -= over;
            from = from.max(end);
        }
    }

    /// Time starts again at 0.
    fn restart(&mut self) {
        self.slots.fill(0);
        (self.ready, self.slot, self.head, self.covered, self.start) = (0, 0, 0, 0, 0);
        self.next = 0;
    }
}

/// The lanes of a block.
#[derive(Clone, Debug)]
pub(super) struct Lanes {
    order: LaneOrder,
    /// Of round robin: the next lane.
    turn: usize,
    /// The first lane, mostly the only one.
    first: Lane,
    others: Vec<Lane>,
}

impl Lanes {
    pub(super) fn new(shape: &Shape) -> Self {
        let lane = Lane::new(shape.in_flight);
        let others = vec![lane.clone(); shape.lanes as usize - 1];
        Self { order: shape.order, turn: 0, first: lane, others }
    }

    pub(super) fn len(&self) -> usize {
        1 + self.others.len()
    }

    /// `ONE`: there is no other.
    #[inline(always)]
    pub(super) fn lane<const ONE: bool>(&mut self, lane: usize) -> &mut Lane {
        if ONE || lane == 0 { &mut self.first } else { &mut self.others[lane - 1] }
    }

    pub(super) fn all(&mut self) -> impl Iterator<Item = &mut Lane> {
        std::iter::once(&mut self.first).chain(&mut self.others)
    }

    /// The lane that takes a token which could be accepted at `from`, and when it does.
    #[inline(always)]
    pub(super) fn choose<const ONE: bool>(&self, from: u64) -> (usize, u64) {
        if ONE || self.others.is_empty() {
            (0, from.max(self.first.ready))
        } else {
            self.one_of(from)
        }
    }

    fn one_of(&self, from: u64) -> (usize, u64) {
        let ready =
            |lane: usize| if lane == 0 { self.first.ready } else { self.others[lane - 1].ready };
        let lane = match self.order {
            LaneOrder::RoundRobin => self.turn,
            LaneOrder::FirstFree => (0..self.len())
                .find(|&lane| ready(lane) <= from)
                .or_else(|| (0..self.len()).min_by_key(|&lane| ready(lane)))
                .expect("a block has lanes"),
        };
        (lane, from.max(ready(lane)))
    }

    /// A lane took its token.
    #[inline(always)]
    pub(super) fn took(&mut self) {
        if !self.others.is_empty() {
            self.turn = (self.turn + 1) % self.len();
        }
    }

    /// Closes a frame that is drained: every lane's share of it ends at `elapsed`, and time starts
    /// again.
    pub(super) fn drain(&mut self, elapsed: u64, times: &mut StageTimes) {
        for lane in self.all() {
            lane.close(elapsed, times);
            lane.restart();
        }
        self.turn = 0;
    }

    /// Closes a frame that the next one overlaps: a lane's share of it ends where its last token
    /// does.
    pub(super) fn overlap(&mut self, times: &mut StageTimes) {
        self.all().for_each(|lane| lane.overlap(times));
    }

    /// Extends or cuts the lanes' shares to the end of the run. `times` gives the block's times in
    /// each frame.
    pub(super) fn finish(&mut self, elapsed: u64, last: usize, times: &mut [StageTimes]) {
        self.all().for_each(|lane| lane.finish(elapsed, last, times));
    }
}
