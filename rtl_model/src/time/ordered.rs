//! The engine for chains in which stages share a memory port: the recurrence of [`super`], event by
//! event in the order of time.
//!
//! Who gets the port next is whoever asks first, and that is known only when all that happens
//! before is. So each block names the times of its next acceptance and of its next emission, and
//! the earliest of all happens next. That is slower than [`super::timed`] by a look at every block
//! for each event, and computes the same where no port is shared.

use super::account::{Fifo, Lanes};
use super::{Block, Emit, FrameTimes, Frames, Hold, Probe, Shape, StageTimes, Times};
use std::collections::VecDeque;

/// Never, as far as is known.
const NEVER: u64 = u64::MAX;

/// The engine.
pub struct Ordered<B: Block, P = ()> {
    stages: Vec<Stage<B>>,
    policy: Frames,
    /// Until the end of the run, `elapsed` is when the frame's last token left.
    frames: Vec<FrameTimes>,
    /// The frame that is being fed.
    frame: usize,
    /// Until when the shared port is taken.
    port_free: u64,
    probe: P,
}

struct Stage<B: Block> {
    index: usize,
    block: B,
    shape: Shape,
    /// The FIFO before it; before the first, what the host has still to send.
    arrivals: VecDeque<Arrival<B::Token>>,
    /// Tokens in flight, oldest first.
    flights: VecDeque<Flight>,
    /// Outputs of the tokens in flight, in order, and when each is ready.
    outputs: VecDeque<(B::Token, u64)>,
    fifo: Option<Fifo>,
    lanes: Lanes,
    /// Tokens in flight of each lane, and when its initiation interval is over.
    busy: Vec<(usize, u64)>,
    next_accept: u64,
    next_emission: u64,
    left: u64,
    /// The frame whose tokens the FIFO's peak counts.
    peak_frame: usize,
}

struct Arrival<T> {
    token: T,
    at: u64,
    frame: usize,
}

struct Flight {
    lane: usize,
    frame: usize,
    accept: u64,
    next: u64,
    /// When it left, or will if it emits nothing.
    done: u64,
    /// Outputs that have not left.
    outputs: usize,
    blocked: u64,
    by_order: u64,
    /// From when on it waited for the port.
    waited_from: u64,
}

#[derive(Clone, Copy)]
enum Event {
    Accept(usize),
    Emission(usize),
}

struct Outputs<'a, T> {
    queue: &'a mut VecDeque<(T, u64)>,
    accept: u64,
}

impl<T> Emit<T> for Outputs<'_, T> {
    fn emit(&mut self, token: T, offset: u64) {
        self.queue.push_back((token, self.accept + offset));
    }
}

impl<B: Block, P: Probe> Ordered<B, P> {
    /// An engine over a chain of blocks, the first of which is fed by the host.
    ///
    /// # Panics
    /// When a shape has a zero.
    #[must_use]
    pub fn new(chain: Vec<(B, Shape)>, policy: Frames, probe: P) -> Self {
        let stages = chain.into_iter().enumerate();
        Self {
            stages: stages.map(|(k, (block, shape))| Stage::new(k, block, shape)).collect(),
            policy,
            frames: Vec::new(),
            frame: 0,
            port_free: 0,
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
        self.stages[0].arrivals.push_back(Arrival { token, at: 0, frame: self.frame });
        // One token is kept back: what the host sends next may come before all else.
        while self.stages[0].arrivals.len() > 1 {
            assert!(self.happen(), "a chain always moves");
        }
    }

    /// The frame's last token has been fed.
    pub fn end_frame(&mut self) {
        self.open_books();
        self.frame += 1;
        if self.policy == Frames::Drain {
            while self.happen() {}
            let frame = &mut self.frames[self.frame - 1];
            for (stage, times) in self.stages.iter_mut().zip(&mut frame.stages) {
                stage.drain(frame.elapsed, times);
            }
            self.port_free = 0;
            self.probe.drained(frame.elapsed);
        }
    }

    /// The times of the run.
    ///
    /// # Panics
    /// When tokens were fed after the last end of a frame.
    #[must_use]
    pub fn finish(mut self) -> (Times, P) {
        assert_eq!(self.frames.len(), self.frame, "the last frame has ended");
        while self.happen() {}
        if self.policy == Frames::Overlap {
            let mut before = 0;
            for frame in &mut self.frames {
                let left = frame.elapsed.max(before);
                frame.elapsed = left - before;
                before = left;
            }
            for stage in &mut self.stages {
                stage.finish(before, &mut self.frames);
            }
        }
        let cycles = |stage: Stage<B>| stage.fifo.map_or_else(Vec::new, Fifo::into_cycles);
        let occupancy = self.stages.into_iter().map(cycles).collect();
        (Times { frames: self.frames, occupancy }, self.probe)
    }

    fn open_books(&mut self) {
        if self.frames.len() == self.frame {
            let stages = vec![StageTimes::default(); self.stages.len()];
            self.frames.push(FrameTimes { elapsed: 0, stages });
        }
    }

    /// Lets the next event happen; whether there was one.
    fn happen(&mut self) -> bool {
        let mut first = (NEVER, None);
        // From the output back: of those that ask for the port in one cycle, the last gets it.
        for (k, stage) in self.stages.iter().enumerate().rev() {
            let accept = stage.acceptance(self.port_free).map_or(NEVER, |(_, at)| at);
            if accept < first.0 {
                first = (accept, Some(Event::Accept(k)));
            }
            let emission = stage.emission(self.stages.get(k + 1)).map_or(NEVER, |(_, at)| at);
            if emission < first.0 {
                first = (emission, Some(Event::Emission(k)));
            }
        }
        match first.1 {
            None => return false,
            Some(Event::Accept(k)) => {
                let stage = &mut self.stages[k];
                stage.accept(&mut self.port_free, &mut self.frames, &mut self.probe);
            }
            Some(Event::Emission(k)) => {
                let (stages, after) = self.stages.split_at_mut(k + 1);
                stages[k].emit(after.first_mut(), &mut self.frames, &mut self.probe);
            }
        }
        true
    }
}

impl<B: Block> Stage<B> {
    fn new(index: usize, block: B, shape: Shape) -> Self {
        shape.check();
        Self {
            index,
            block,
            shape,
            arrivals: VecDeque::new(),
            flights: VecDeque::new(),
            outputs: VecDeque::new(),
            fifo: (index > 0).then(|| Fifo::new(shape.depth)),
            lanes: Lanes::new(&shape),
            busy: vec![(0, 0); shape.lanes as usize],
            next_accept: 0,
            next_emission: 0,
            left: 0,
            peak_frame: 0,
        }
    }

    /// The lane of the next acceptance and its time, as far as is known.
    fn acceptance(&self, port_free: u64) -> Option<(usize, u64)> {
        let arrival = self.arrivals.front()?;
        let mut from = arrival.at.max(self.next_accept);
        if self.shape.shares_port && self.block.port(&arrival.token).is_some() {
            from = from.max(port_free);
        }
        Some(self.lanes.choose::<false>(from)).filter(|&(_, at)| at < NEVER)
    }

    /// From when on order lets the next output leave, and when it does.
    fn emission(&self, next: Option<&Self>) -> Option<(u64, u64)> {
        let &(_, ready) = self.outputs.front()?;
        let turn = ready.max(self.next_emission).max(self.left);
        let room = match next {
            None => 0,
            Some(next) if next.arrivals.len() < next.shape.depth as usize => {
                next.fifo.as_ref().map_or(0, |fifo| fifo.room_behind(next.arrivals.len()))
            }
            Some(_) => return None,
        };
        Some((turn, turn.max(room)))
    }

    fn accept(&mut self, port_free: &mut u64, frames: &mut [FrameTimes], probe: &mut impl Probe) {
        let (lane, accept) = self.acceptance(*port_free).expect("it was the next event");
        let Arrival { token, at, frame } = self.arrivals.pop_front().expect("it has arrived");
        let without_port = at.max(self.next_accept).max(self.lanes.lane::<false>(lane).ready);
        let port = self.block.port(&token).filter(|_| self.shape.shares_port);
        if let Some(cycles) = port {
            *port_free = accept + cycles;
        }
        if let Some(fifo) = &mut self.fifo {
            if frame != self.peak_frame {
                frames[self.peak_frame].stages[self.index].fifo_peak = fifo.take_peak();
                self.peak_frame = frame;
            }
            fifo.pass(at, accept);
        }
        let before = self.outputs.len();
        let cost = self.block.accept(&token, &mut Outputs { queue: &mut self.outputs, accept });
        assert!(cost.interval >= 1, "an initiation interval is at least a cycle");
        let next = accept + cost.interval;
        self.next_accept = accept + 1;
        self.flights.push_back(Flight {
            lane,
            frame,
            accept,
            next,
            done: accept + cost.latency,
            outputs: self.outputs.len() - before,
            blocked: 0,
            by_order: 0,
            waited_from: if port.is_some() { without_port } else { accept },
        });
        frames[frame].stages[self.index].tokens_in += 1;
        if port.is_some() {
            probe.held(self.index, lane, Hold::Port, without_port, accept);
        }
        probe.accepted(self.index, lane, accept);
        let (in_flight, _) = self.busy[lane];
        self.busy[lane] = (in_flight + 1, next);
        self.know_ready(lane);
        self.lanes.took();
        self.retire(frames, probe);
    }

    /// When a lane has time and a slot for a token, as far as is known.
    fn know_ready(&mut self, lane: usize) {
        let (in_flight, next) = self.busy[lane];
        let lane = self.lanes.lane::<false>(lane);
        lane.ready = lane.slot_behind(in_flight).map_or(NEVER, |free| free.max(next));
    }

    fn emit(&mut self, next: Option<&mut Self>, frames: &mut [FrameTimes], probe: &mut impl Probe) {
        let (turn, at) = self.emission(next.as_deref()).expect("it was the next event");
        let (token, ready) = self.outputs.pop_front().expect("it is ready");
        let flight = self.flights.front_mut().expect("an output belongs to a token");
        // Its lane's older tokens have left, and its own earlier outputs.
        let lane = self.lanes.lane::<false>(flight.lane);
        let first = ready.max(lane.head);
        let room = turn.max(first);
        flight.by_order += room - first;
        flight.blocked += at.saturating_sub(room);
        probe.held(self.index, flight.lane, Hold::Order, first, room);
        probe.held(self.index, flight.lane, Hold::Room, room, at.max(room));
        lane.head = at + 1;
        flight.outputs -= 1;
        flight.done = at;
        self.next_emission = at + 1;
        frames[flight.frame].stages[self.index].tokens_out += 1;
        probe.emitted(self.index, at);
        if let Some(next) = next {
            next.arrivals.push_back(Arrival { token, at: at + 1, frame: flight.frame });
        }
        if flight.outputs == 0 {
            self.retire(frames, probe);
        }
    }

    /// Takes out the oldest tokens while they have nothing left to emit.
    fn retire(&mut self, frames: &mut [FrameTimes], probe: &mut impl Probe) {
        while self.flights.front().is_some_and(|flight| flight.outputs == 0) {
            let flight = self.flights.pop_front().expect("it is the oldest");
            let Flight { lane, frame, .. } = flight;
            self.left = self.left.max(flight.done);
            frames[frame].elapsed = frames[frame].elapsed.max(self.left);
            probe.left(self.index, self.left, flight.next);
            let books = self.lanes.lane::<false>(lane);
            books.turn_to(frame, |last| &mut frames[last].stages[self.index]);
            books.waited(flight.waited_from, flight.accept);
            books.blocked += flight.blocked;
            books.by_order += flight.by_order;
            books.done(flight.accept, self.left, flight.next, frame);
            self.busy[lane].0 -= 1;
            self.know_ready(lane);
        }
    }

    fn drain(&mut self, elapsed: u64, times: &mut StageTimes) {
        self.lanes.drain(elapsed, times);
        if let Some(fifo) = &mut self.fifo {
            times.fifo_peak = fifo.take_peak();
            fifo.drain(elapsed);
        }
        self.busy.fill((0, 0));
        (self.next_accept, self.next_emission, self.left) = (0, 0, 0);
        self.peak_frame += 1;
    }

    /// The run ends at `elapsed`.
    fn finish(&mut self, elapsed: u64, frames: &mut [FrameTimes]) {
        let Some(last) = frames.len().checked_sub(1) else { return };
        let mut times: Vec<_> =
            frames.iter_mut().map(|frame| std::mem::take(&mut frame.stages[self.index])).collect();
        for lane in self.lanes.all() {
            lane.turn_to(usize::MAX, |frame| &mut times[frame]);
        }
        self.lanes.finish(elapsed, last, &mut times);
        if let Some(fifo) = &mut self.fifo {
            times[self.peak_frame].fifo_peak = fifo.take_peak();
            fifo.drain(elapsed);
        }
        for (frame, times) in frames.iter_mut().zip(times) {
            frame.stages[self.index] = times;
        }
    }
}
