//! The engine that makes the other believable: a plain simulation, cycle by cycle.
//!
//! In each cycle, for each block from the first to the last: it accepts a token if one is visible
//! and a lane can take it; one output leaves if it is ready and there is room; what is done retires
//! in order. Blocks are visited in the order of the data, so a producer still sees the FIFO as it
//! was when the cycle began; a token carries the cycle from which it is visible, so a consumer does
//! not see it before the next.
//!
//! Nothing here is computed ahead: attribution counts cycles one by one, each when the next one
//! begins, for the cycle in which the last token leaves does not count.

use super::{Block, Emit, FrameTimes, Frames, LaneOrder, Probe, Shape, StageTimes, Times};
use std::collections::VecDeque;

/// The engine.
pub struct Stepped<B: Block, P = ()> {
    stages: Vec<Stage<B>>,
    policy: Frames,
    /// Until the end of the run, `elapsed` is when the frame's last token left.
    frames: Vec<FrameTimes>,
    /// The frame that is being fed.
    frame: usize,
    now: u64,
    /// Until when the shared port is taken.
    port_free: u64,
    shares_port: bool,
    probe: P,
}

struct Stage<B: Block> {
    index: usize,
    block: B,
    shape: Shape,
    /// The FIFO before it; before the first, what the host has still to send.
    fifo: VecDeque<Entry<B::Token>>,
    /// Tokens in flight, oldest first.
    flights: VecDeque<Flight>,
    /// Outputs of the tokens in flight, in order, and when each is ready.
    outputs: VecDeque<(B::Token, u64)>,
    lanes: Vec<Lane>,
    round_robin: usize,
    /// The cycle after the last acceptance.
    next_accept: u64,
    /// Entries of the FIFO when the cycle began.
    held: usize,
    /// Cycles that began with 0, 1, .. entries.
    occupancy: Vec<u64>,
}

#[derive(Clone, Copy, Debug)]
struct Entry<T> {
    token: T,
    visible: u64,
    frame: usize,
}

#[derive(Clone, Copy, Debug)]
struct Flight {
    lane: usize,
    frame: usize,
    /// When it is done, if it emits nothing.
    done: u64,
    /// Outputs that have not left.
    outputs: usize,
}

#[derive(Clone, Copy, Debug, Default)]
struct Lane {
    in_flight: u32,
    /// The first cycle in which the initiation interval is over.
    next_accept: u64,
    /// The frame that is charged with what it did in the last cycle, unless it was idle.
    frame: usize,
    /// The frame of its last token.
    last: usize,
    /// What it did in the last cycle.
    state: State,
    /// Idle cycles since its last token: they belong to the next token's frame.
    idle: u64,
    /// Of these, with a token at the door that waited for the port.
    waiting: u64,
}

/// What a lane did in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// There was no such cycle.
    #[default]
    None,
    Idle,
    Waiting,
    Busy,
    Blocked,
    BlockedByOrder,
}

/// Collects the outputs of one token.
struct Outputs<'a, T> {
    queue: &'a mut VecDeque<(T, u64)>,
    now: u64,
}

impl<T> Emit<T> for Outputs<'_, T> {
    fn emit(&mut self, token: T, offset: u32) {
        self.queue.push_back((token, self.now + u64::from(offset)));
    }
}

impl<B: Block, P: Probe> Stepped<B, P> {
    /// An engine over a chain of blocks, the first of which is fed by the host.
    ///
    /// # Panics
    /// When a shape has a zero.
    #[must_use]
    pub fn new(chain: Vec<(B, Shape)>, policy: Frames, probe: P) -> Self {
        let shares_port = chain.iter().any(|(_, shape)| shape.shares_port);
        let stages = chain.into_iter().enumerate();
        Self {
            stages: stages.map(|(k, (block, shape))| Stage::new(k, block, shape)).collect(),
            policy,
            frames: Vec::new(),
            frame: 0,
            now: 0,
            port_free: 0,
            shares_port,
            probe,
        }
    }

    /// The host sends a token, as soon as the first block takes it.
    pub fn feed(&mut self, token: B::Token) {
        self.open_books();
        let host = &mut self.stages[0].fifo;
        host.push_back(Entry { token, visible: 0, frame: self.frame });
        // One token is kept back, so that the host never seems to have nothing to send.
        while self.stages[0].fifo.len() > 1 {
            self.cycle();
        }
    }

    /// The frame's last token has been fed.
    pub fn end_frame(&mut self) {
        self.open_books();
        self.frame += 1;
        if self.policy == Frames::Drain {
            self.drain();
            (self.now, self.port_free) = (0, 0);
            self.stages.iter_mut().for_each(Stage::restart);
        }
    }

    /// The times of the run.
    ///
    /// # Panics
    /// When tokens were fed after the last end of a frame.
    #[must_use]
    pub fn finish(mut self) -> (Times, P) {
        assert_eq!(self.frames.len(), self.frame, "the last frame has ended");
        self.drain();
        if self.policy == Frames::Overlap {
            let mut before = 0;
            for frame in &mut self.frames {
                let left = frame.elapsed.max(before);
                frame.elapsed = left - before;
                before = left;
            }
        }
        let occupancy = self.stages.into_iter().map(|stage| stage.occupancy).collect();
        (Times { frames: self.frames, occupancy }, self.probe)
    }

    fn open_books(&mut self) {
        if self.frames.len() == self.frame {
            let stages = vec![StageTimes::default(); self.stages.len()];
            self.frames.push(FrameTimes { elapsed: 0, stages });
        }
    }

    /// Runs until nothing is left; lanes that are idle at the end are so in the last frame.
    fn drain(&mut self) {
        while self.stages.iter().any(|stage| !stage.is_empty()) {
            self.cycle();
        }
        let Some(last) = self.frames.last_mut() else { return };
        for (stage, times) in self.stages.iter_mut().zip(&mut last.stages) {
            for lane in &mut stage.lanes {
                times.starved += lane.idle;
                times.total += std::mem::take(&mut lane.idle);
            }
        }
    }

    fn cycle(&mut self) {
        let granted = if self.shares_port { self.arbitrate() } else { None };
        for k in 0..self.stages.len() {
            let (stages, after) = self.stages.split_at_mut(k + 1);
            let stage = &mut stages[k];
            stage.count_last_cycle(self.now, &mut self.frames);
            stage.accept(self.now, granted == Some(k), &mut self.frames, &mut self.probe);
            stage.emit(self.now, after.first_mut(), &mut self.frames, &mut self.probe);
            stage.note_peak(self.now, &mut self.frames);
        }
        self.now += 1;
    }

    /// Who gets the shared port in this cycle: of the blocks that could accept a token which needs
    /// it, the one nearest to the output.
    fn arbitrate(&mut self) -> Option<usize> {
        if self.port_free > self.now {
            return None;
        }
        for (k, stage) in self.stages.iter().enumerate().rev() {
            if let Some(cycles) = stage.wants_port(self.now)
                && stage.lane(self.now).is_some()
            {
                self.port_free = self.now + u64::from(cycles);
                return Some(k);
            }
        }
        None
    }
}

impl<B: Block> Stage<B> {
    fn new(index: usize, block: B, shape: Shape) -> Self {
        shape.check();
        Self {
            index,
            block,
            shape,
            fifo: VecDeque::new(),
            flights: VecDeque::new(),
            outputs: VecDeque::new(),
            lanes: vec![Lane::default(); shape.lanes as usize],
            round_robin: 0,
            next_accept: 0,
            held: 0,
            occupancy: if index == 0 { Vec::new() } else { vec![0; shape.depth as usize + 1] },
        }
    }

    fn is_empty(&self) -> bool {
        self.fifo.is_empty() && self.flights.is_empty()
    }

    /// Time starts again at 0.
    fn restart(&mut self) {
        self.lanes.fill(Lane::default());
        (self.round_robin, self.next_accept, self.held) = (0, 0, 0);
    }

    /// The token at the door, if it is visible and a cycle has passed since the one before.
    fn visible(&self, now: u64) -> Option<&Entry<B::Token>> {
        self.fifo.front().filter(|entry| entry.visible <= now && self.next_accept <= now)
    }

    /// The cycles for which the token at the door needs the shared port.
    fn wants_port(&self, now: u64) -> Option<u32> {
        let entry = self.visible(now).filter(|_| self.shape.shares_port)?;
        self.block.port(&entry.token)
    }

    fn is_free(&self, lane: &Lane, now: u64) -> bool {
        lane.next_accept <= now && lane.in_flight < self.shape.in_flight
    }

    /// The lane that takes a token now.
    fn lane(&self, now: u64) -> Option<usize> {
        match self.shape.order {
            LaneOrder::FirstFree => self.lanes.iter().position(|lane| self.is_free(lane, now)),
            LaneOrder::RoundRobin => {
                let lane = self.round_robin;
                self.is_free(&self.lanes[lane], now).then_some(lane)
            }
        }
    }

    /// Enters what the lanes did in the cycle before this one into the books.
    fn count_last_cycle(&mut self, now: u64, frames: &mut [FrameTimes]) {
        for lane in &mut self.lanes {
            let times = &mut frames[lane.frame].stages[self.index];
            let count = match lane.state {
                State::None => continue,
                State::Idle => {
                    lane.idle += 1;
                    continue;
                }
                State::Waiting => {
                    lane.idle += 1;
                    lane.waiting += 1;
                    continue;
                }
                State::Busy => &mut times.busy,
                State::Blocked => &mut times.blocked,
                State::BlockedByOrder => &mut times.blocked_by_order,
            };
            *count += 1;
            times.total += 1;
        }
        if let Some(held) = self.occupancy.get_mut(self.held)
            && self.lanes[0].state != State::None
        {
            *held += 1;
        }
        let pushed_now = self.fifo.back().is_some_and(|newest| newest.visible > now);
        self.held = self.fifo.len() - usize::from(pushed_now);
    }

    /// Accepts the token at the door, if a lane can take it.
    fn accept(
        &mut self,
        now: u64,
        granted: bool,
        frames: &mut [FrameTimes],
        probe: &mut impl Probe,
    ) {
        let wants_port = self.wants_port(now).is_some();
        for k in 0..self.lanes.len() {
            let waiting = wants_port && self.is_free(&self.lanes[k], now);
            self.lanes[k].state = if waiting { State::Waiting } else { State::Idle };
        }
        if self.visible(now).is_none() || wants_port && !granted {
            return;
        }
        let Some(lane) = self.lane(now) else { return };
        let Entry { token, frame, .. } = self.fifo.pop_front().expect("a token is visible");
        let before = self.outputs.len();
        let cost = self.block.accept(token, &mut Outputs { queue: &mut self.outputs, now });
        let outputs = self.outputs.len() - before;
        let done = now + u64::from(cost.latency);
        self.flights.push_back(Flight { lane, frame, done, outputs });
        self.next_accept = now + 1;
        self.round_robin = (self.round_robin + 1) % self.lanes.len();
        probe.accepted(self.index, lane, now);

        let times = &mut frames[frame].stages[self.index];
        let taken = &mut self.lanes[lane];
        times.tokens_in += 1;
        times.starved_by_port += taken.waiting;
        times.starved += taken.idle - taken.waiting;
        times.total += taken.idle;
        taken.idle = 0;
        taken.in_flight += 1;
        taken.last = frame;
        taken.next_accept = now + u64::from(cost.interval);
        for lane in &mut self.lanes {
            (lane.waiting, lane.state) = (0, State::Idle);
        }
    }

    /// Lets an output leave and tokens retire.
    fn emit(
        &mut self,
        now: u64,
        next: Option<&mut Self>,
        frames: &mut [FrameTimes],
        probe: &mut impl Probe,
    ) {
        let room = next.as_ref().is_none_or(|next| next.fifo.len() < next.shape.depth as usize);
        let mut emitter = None;
        let mut retired = 0;
        let mut next = next;
        while let Some(flight) = self.flights.get_mut(retired) {
            if flight.outputs > 0 {
                let ready = self.outputs[0].1 <= now;
                if !ready || !room || emitter.is_some() {
                    break;
                }
                let (token, _) = self.outputs.pop_front().expect("it is ready");
                emitter = Some(retired);
                flight.outputs -= 1;
                flight.done = now;
                frames[flight.frame].stages[self.index].tokens_out += 1;
                probe.emitted(self.index, now);
                if let Some(next) = &mut next {
                    let frame = flight.frame;
                    next.fifo.push_back(Entry { token, visible: now + 1, frame });
                }
                if flight.outputs > 0 {
                    break;
                }
            } else if flight.done > now {
                break;
            }
            retired += 1;
        }
        self.observe(now, emitter, retired);
        for flight in self.flights.drain(..retired) {
            self.lanes[flight.lane].in_flight -= 1;
            frames[flight.frame].elapsed = now;
            probe.left(self.index, now);
        }
    }

    /// What each lane does in this cycle, by its oldest token. The first `retired` tokens leave in
    /// it, and the token `emitter` has emitted.
    fn observe(&mut self, now: u64, emitter: Option<usize>, retired: usize) {
        let mut first_output = 0;
        for (k, flight) in self.flights.iter().enumerate() {
            let lane = &mut self.lanes[flight.lane];
            if matches!(lane.state, State::Idle | State::Waiting) {
                lane.frame = flight.frame;
                let waits =
                    flight.outputs > 0 && emitter != Some(k) && self.outputs[first_output].1 <= now;
                lane.state = match (waits, k == retired && emitter.is_none()) {
                    (false, _) => State::Busy,
                    (true, true) => State::Blocked,
                    (true, false) => State::BlockedByOrder,
                };
                if self.shape.lanes == 1 {
                    return;
                }
            }
            first_output += flight.outputs;
        }
        for lane in &mut self.lanes {
            // The initiation interval of its last token is not over.
            if matches!(lane.state, State::Idle | State::Waiting) && now < lane.next_accept {
                (lane.state, lane.frame) = (State::Busy, lane.last);
            }
        }
    }

    /// Most entries of the FIFO, at the start of the next cycle.
    fn note_peak(&mut self, now: u64, frames: &mut [FrameTimes]) {
        let Some(newest) = self.fifo.back() else { return };
        if self.index > 0 && newest.visible == now + 1 {
            let peak = &mut frames[newest.frame].stages[self.index].fifo_peak;
            *peak = (*peak).max(self.fifo.len() as u64);
        }
    }
}
