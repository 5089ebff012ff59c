//! The engine that makes the other believable: a plain simulation, cycle by cycle.
//!
//! In each cycle, for each block from the first to the last: it accepts a token if one is visible
//! and a lane can take it; one output leaves if it is ready and there is room; what is done retires
//! in order. Blocks are visited in the order of the data, so a producer still sees the FIFO as it
//! was when the cycle began; what is pushed in a cycle does not count as held, so a consumer does
//! not see it before the next.
//!
//! Nothing here is computed ahead: attribution counts cycles one by one, each when the next one
//! begins, for the cycle in which the last token leaves does not count.

use super::{Block, Emit, FrameTimes, Frames, Hold, LaneOrder, Probe, Shape, StageTimes, Times};
use std::collections::VecDeque;

/// The engine.
pub struct Stepped<B: Block, P = ()> {
    stages: Vec<Stage<B>>,
    policy: Frames,
    /// When the last token of each frame left.
    left: Vec<u64>,
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
    /// What is in flight, in order: the outputs of tokens, and tokens that have none.
    flights: VecDeque<Flight<B::Token>>,
    lanes: Vec<Lane>,
    round_robin: usize,
    /// The cycle after the last acceptance.
    next_accept: u64,
    /// Entries of the FIFO when the cycle began: those that are visible.
    held: usize,
    /// The frame of the token that was pushed in this cycle.
    pushed: Option<usize>,
    /// Cycles that began with 0, 1, .. entries.
    occupancy: Vec<u64>,
    /// Frame by frame.
    times: Vec<StageTimes>,
}

#[derive(Clone, Copy, Debug)]
struct Entry<T> {
    token: T,
    frame: usize,
}

/// An output of a token in flight, or a token that has none.
#[derive(Clone, Copy, Debug)]
struct Flight<T> {
    output: Option<T>,
    /// The first cycle in which it can leave.
    ready: u64,
    /// Whether its token leaves with it.
    last: bool,
    /// Where it leaves with it: when the token's initiation interval is over.
    next: u64,
    lane: usize,
    frame: usize,
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
    /// How many cycles it did what, since it was entered in the books of a frame. Idle cycles
    /// belong to the frame of the next token.
    cycles: [u64; 6],
    /// Cycles within initiation intervals of tokens of its last token's frame.
    used: u64,
}

/// What a lane did in a cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// There was no such cycle.
    #[default]
    None,
    /// Nothing was in flight.
    Idle,
    /// Nor was it, but a token at the door waited for the port.
    Waiting,
    Busy,
    Blocked,
    BlockedByOrder,
}

impl State {
    /// What held up the lane's oldest token in the cycle.
    fn held(self) -> Option<Hold> {
        match self {
            Self::Blocked => Some(Hold::Room),
            Self::BlockedByOrder => Some(Hold::Order),
            Self::None | Self::Idle | Self::Waiting | Self::Busy => None,
        }
    }
}

impl Lane {
    fn take(&mut self, state: State) -> u64 {
        std::mem::take(&mut self.cycles[state as usize])
    }

    /// What it does in this cycle, and the frame whose cycle it is.
    fn charge(&mut self, state: State, frame: usize, times: &mut [StageTimes]) {
        if self.frame != frame {
            self.enter(times);
            self.frame = frame;
        }
        self.state = state;
    }

    /// Enters what it did with tokens of its frame.
    fn enter(&mut self, times: &mut [StageTimes]) {
        let Some(times) = times.get_mut(self.frame) else { return };
        let cycles = [State::Busy, State::Blocked, State::BlockedByOrder].map(|s| self.take(s));
        times.busy += cycles[0];
        times.blocked += cycles[1];
        times.blocked_by_order += cycles[2];
        times.total += cycles.iter().sum::<u64>();
    }

    fn enter_used(&mut self, times: &mut [StageTimes]) {
        if let Some(times) = times.get_mut(self.last) {
            times.used += std::mem::take(&mut self.used);
        }
    }

    /// Enters the cycles in which it had nothing to do, before a token of the frame of `times`.
    fn enter_idle(&mut self, times: &mut StageTimes) {
        let (idle, waiting) = (self.take(State::Idle), self.take(State::Waiting));
        times.starved += idle;
        times.starved_by_port += waiting;
        times.total += idle + waiting;
    }
}

/// Collects the outputs of one token.
struct Outputs<'a, T> {
    flights: &'a mut VecDeque<Flight<T>>,
    now: u64,
    lane: usize,
    frame: usize,
    any: bool,
}

impl<T> Emit<T> for Outputs<'_, T> {
    fn emit(&mut self, token: T, offset: u64) {
        let Self { now, lane, frame, .. } = *self;
        let ready = now + offset;
        let output = Some(token);
        self.flights.push_back(Flight { output, ready, last: false, next: 0, lane, frame });
        self.any = true;
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
            left: Vec::new(),
            frame: 0,
            now: 0,
            port_free: 0,
            shares_port,
            probe,
        }
    }

    /// Who is told the times.
    pub fn probe(&mut self) -> &mut P {
        &mut self.probe
    }

    /// The host sends a token, as soon as the first block takes it.
    pub fn feed(&mut self, token: B::Token) {
        self.open_books();
        let host = &mut self.stages[0].fifo;
        host.push_back(Entry { token, frame: self.frame });
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
            self.probe.drained(self.left[self.frame - 1]);
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
        assert_eq!(self.left.len(), self.frame, "the last frame has ended");
        self.drain();
        let mut before = 0;
        let mut frames = Vec::new();
        for (frame, &left) in self.left.iter().enumerate() {
            let left = left.max(before);
            let stages = self.stages.iter().map(|stage| stage.times[frame].clone()).collect();
            frames.push(FrameTimes { elapsed: left - before, stages });
            before = if self.policy == Frames::Overlap { left } else { 0 };
        }
        let occupancy = self.stages.into_iter().map(|stage| stage.occupancy).collect();
        (Times { frames, occupancy }, self.probe)
    }

    fn open_books(&mut self) {
        if self.left.len() == self.frame {
            self.left.push(0);
            self.stages.iter_mut().for_each(|stage| stage.times.push(StageTimes::default()));
        }
    }

    /// Runs until nothing is left; lanes that are idle at the end are so in the last frame.
    fn drain(&mut self) {
        while self.stages.iter().any(|stage| !stage.is_empty()) {
            self.cycle();
        }
        self.stages.iter_mut().for_each(Stage::close_books);
    }

    fn cycle(&mut self) {
        let granted = if self.shares_port { self.arbitrate() } else { None };
        for k in 0..self.stages.len() {
            let (stages, after) = self.stages.split_at_mut(k + 1);
            let stage = &mut stages[k];
            let pushed = stage.begin(self.now, &mut self.probe);
            if stage.held > 0 && stage.next_accept <= self.now {
                stage.accept(self.now, granted == Some(k), &mut self.probe);
            }
            if stage.flights.is_empty() {
                stage.idle(self.now);
            } else {
                stage.emit(self.now, after.first_mut(), &mut self.left, &mut self.probe);
            }
            if let Some(frame) = pushed {
                // At the start of the next cycle.
                let peak = &mut stage.times[frame].fifo_peak;
                *peak = (*peak).max(stage.fifo.len() as u64);
            }
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
                self.port_free = self.now + cycles;
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
            lanes: vec![Lane::default(); shape.lanes as usize],
            round_robin: 0,
            next_accept: 0,
            held: 0,
            pushed: None,
            occupancy: if index == 0 { Vec::new() } else { vec![0; shape.depth as usize + 1] },
            times: Vec::new(),
        }
    }

    fn is_empty(&self) -> bool {
        self.fifo.is_empty() && self.flights.is_empty()
    }

    /// Time starts again at 0.
    fn restart(&mut self) {
        let frame = self.times.len();
        self.lanes.fill(Lane { frame, last: frame, ..Lane::default() });
        (self.round_robin, self.next_accept, self.held) = (0, 0, 0);
    }

    /// The cycles for which the token at the door needs the shared port.
    fn wants_port(&self, now: u64) -> Option<u64> {
        let door = self.fifo.front().filter(|_| self.shape.shares_port);
        self.block.port(&door.filter(|_| self.next_accept <= now)?.token)
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

    /// Begins a cycle: counts what the lanes did in the one before. Returns the frame of the token
    /// that has just been pushed and is not yet visible, if one was.
    fn begin(&mut self, now: u64, probe: &mut impl Probe) -> Option<usize> {
        for (number, lane) in self.lanes.iter_mut().enumerate() {
            lane.cycles[lane.state as usize] += 1;
            if let Some(by) = lane.state.held() {
                probe.held(self.index, number, by, now - 1, now);
            }
            lane.used += u64::from(lane.next_accept >= now && now > 0);
            lane.state = State::Idle;
        }
        if let Some(held) = self.occupancy.get_mut(self.held) {
            *held += u64::from(now > 0);
        }
        let pushed = self.pushed.take();
        self.held = self.fifo.len() - usize::from(pushed.is_some());
        pushed
    }

    /// Accepts the token at the door, which is visible, if a lane can take it.
    fn accept(&mut self, now: u64, granted: bool, probe: &mut impl Probe) {
        if self.shape.shares_port && self.wants_port(now).is_some() && !granted {
            for k in 0..self.lanes.len() {
                if self.is_free(&self.lanes[k], now) {
                    self.lanes[k].state = State::Waiting;
                }
            }
            return;
        }
        let Some(lane) = self.lane(now) else { return };
        let Entry { token, frame, .. } = self.fifo.pop_front().expect("a token is visible");
        let mut outputs = Outputs { flights: &mut self.flights, now, lane, frame, any: false };
        let cost = self.block.accept(&token, &mut outputs);
        let next = now + cost.interval;
        if outputs.any {
            let output = self.flights.back_mut().expect("an output");
            (output.last, output.next) = (true, next);
        } else {
            let ready = now + cost.latency;
            let flight = Flight { output: None, ready, last: true, next, lane, frame };
            self.flights.push_back(flight);
        }
        self.next_accept = now + 1;
        let times = &mut self.times[frame];
        times.tokens_in += 1;
        let taken = &mut self.lanes[lane];
        let waited = taken.cycles[State::Waiting as usize];
        if waited > 0 {
            probe.held(self.index, lane, Hold::Port, now - waited, now);
        }
        probe.accepted(self.index, lane, now);
        taken.enter_idle(times);
        taken.in_flight += 1;
        if taken.last != frame {
            taken.enter_used(&mut self.times);
            taken.last = frame;
        }
        taken.next_accept = next;
        if self.shape.lanes > 1 {
            self.round_robin = (self.round_robin + 1) % self.lanes.len();
            // The others did not wait for the port: this token did not go to them.
            for lane in &mut self.lanes {
                lane.cycles[State::Idle as usize] += lane.take(State::Waiting);
            }
        }
    }

    /// Lets an output leave and tokens retire; notes when each frame's last token left.
    fn emit(
        &mut self,
        now: u64,
        next: Option<&mut Self>,
        left: &mut [u64],
        probe: &mut impl Probe,
    ) {
        let room = next.as_ref().is_none_or(|next| next.fifo.len() < next.shape.depth as usize);
        self.observe(now, room);
        let mut next = next;
        let mut emitted = false;
        while let Some(&Flight { output, ready, last, next: over, lane, frame }) =
            self.flights.front()
        {
            if ready > now || output.is_some() && (emitted || !room) {
                break;
            }
            self.flights.pop_front();
            if let Some(token) = output {
                emitted = true;
                self.times[frame].tokens_out += 1;
                probe.emitted(self.index, now);
                if let Some(next) = &mut next {
                    next.fifo.push_back(Entry { token, frame });
                    next.pushed = Some(frame);
                }
            }
            if last {
                self.lanes[lane].in_flight -= 1;
                left[frame] = now;
                probe.left(self.index, now, over);
            }
        }
    }

    /// What each lane does in this cycle, by its oldest token: before anything leaves.
    fn observe(&mut self, now: u64, room: bool) {
        // Whether order lets an output leave: what is before it leaves now, and is no output.
        let mut turn = true;
        for flight in &self.flights {
            let lane = &mut self.lanes[flight.lane];
            let ready = flight.ready <= now;
            if matches!(lane.state, State::Idle | State::Waiting) {
                let state = match (flight.output.is_some() && ready, turn) {
                    (true, false) => State::BlockedByOrder,
                    (true, true) if !room => State::Blocked,
                    _ => State::Busy,
                };
                lane.charge(state, flight.frame, &mut self.times);
                if self.shape.lanes == 1 {
                    return;
                }
            }
            turn &= flight.output.is_none() && ready;
        }
        self.idle(now);
    }

    /// Lanes with nothing in flight, of whose last token the initiation interval is not over.
    fn idle(&mut self, now: u64) {
        for lane in &mut self.lanes {
            if now < lane.next_accept && matches!(lane.state, State::Idle | State::Waiting) {
                lane.charge(State::Busy, lane.last, &mut self.times);
            }
        }
    }

    /// Enters what the lanes did last. What they idled at the end belongs to the last frame.
    fn close_books(&mut self) {
        let Some(last) = self.times.len().checked_sub(1) else { return };
        for lane in &mut self.lanes {
            lane.enter(&mut self.times);
            lane.enter_used(&mut self.times);
            lane.enter_idle(&mut self.times[last]);
        }
    }
}
