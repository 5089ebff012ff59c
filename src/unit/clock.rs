//! The clock of a run: what the host sends goes in, in the order of the trace; the engine that the
//! configuration names times it.

use super::chain::{self, Flow, Meshed, Pattern, Token, Work};
use super::host::{Delivery, Host, Hosted};
use super::timeline::Recorder;
use crate::config::{Config, Engine, TransferMode};
use crate::error::Result;
use crate::link::framing::Pieces;
use crate::link::schedule::Parcel;
use crate::report::timeline::Wanted;
use rtl_model::counter::{Counter, Counters};
use rtl_model::patch::Lists;
use rtl_model::strip::Segments;
use rtl_model::time::ordered::Ordered;
use rtl_model::time::stepped::Stepped;
use rtl_model::time::timed::Timed;
use rtl_model::time::{Probe, Times};

/// Most payload bytes of a parcel under `push`: those of its bursts fit 32 bits.
const PARCEL_MAX: u64 = 1 << 30;

/// The clock.
pub(super) struct Clock<T: Flow> {
    config: Config,
    engine: Running<T>,
    /// The command that is being sent.
    pieces: Pieces,
    /// Where the host tessellates.
    host: Host<T>,
    sent: Sent,
}

/// What the host has sent in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Sent {
    /// Tokens.
    pub(super) tokens: u64,
    /// Bytes that crossed the link, in both directions.
    pub(super) link_bytes: u64,
    /// Bytes of memory bursts, read and written.
    pub(super) memory_bytes: u64,
}

impl Sent {
    /// What was timed is what was counted.
    ///
    /// # Panics
    /// When it is not.
    pub(super) fn check(&self, config: &Config, counters: &Counters) {
        let link = counters.get(Counter::LinkTotal);
        assert_eq!(self.link_bytes, link, "bytes timed on the link, and bytes counted");
        // What shaders move themselves is timed with them.
        let bursts = counters.get(Counter::MemoryBursts) - counters.get(Counter::MemoryPatchBursts);
        let memory = bursts * u64::from(config.memory.burst);
        assert_eq!(self.memory_bytes, memory, "bytes timed in memory, and bytes counted");
    }
}

enum Running<T: Flow> {
    None,
    /// Keeps what the host sends.
    Recording(Tokens<T>),
    Plain(Timer<T, ()>),
    /// What happens when is recorded.
    Watched(Timer<T, Recorder>),
}

/// An engine.
enum Timer<T: Flow, P> {
    Timed(Box<Timed<T::Stage, P>>),
    /// Where stages share a memory port, who gets it depends on the order of time.
    Ordered(Box<Ordered<T::Stage, P>>),
    Stepped(Box<Stepped<T::Stage, P>>),
}

/// Control points of a patch that come from memory or from on chip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Fetch {
    /// How many.
    pub(super) points: u8,
    /// Bytes of the bursts that bring them, where they are resident.
    pub(super) read: u32,
    /// The patch's number within its frame.
    pub(super) patch: u32,
    /// It comes again, to be drawn.
    pub(super) measured: bool,
}

/// What the host sent in a run, frame by frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Tokens<T> {
    frames: Vec<Vec<Token<T>>>,
    frame: Vec<Token<T>>,
}

impl<T: Flow> Tokens<T> {
    fn replay(&self, config: &Config) -> Option<Times> {
        let mut engine = Running::new(config);
        for frame in &self.frames {
            frame.iter().for_each(|&token| engine.feed(token));
            engine.end_frame();
        }
        engine.finish().map(|(times, _)| times)
    }

    fn len(&self) -> usize {
        self.frames.iter().map(Vec::len).sum()
    }
}

/// What the host sent in a run: to be timed again, by itself.
#[derive(Clone, Debug)]
pub struct Recording(pub(super) Recorded);

/// By what the triangles of a patch depend on.
#[derive(Clone, Debug)]
pub(super) enum Recorded {
    Fractional(Tokens<Segments>),
    Dyadic(Tokens<Lists>),
    D3d11(Tokens<Pattern>),
    Esc(Tokens<Meshed>),
}

impl Recording {
    /// Lays the time of the configured engine over it; `None` without one. The configuration must
    /// otherwise be that of the recorded run.
    #[must_use]
    pub fn replay(&self, config: &Config) -> Option<Times> {
        match &self.0 {
            Recorded::Fractional(tokens) => tokens.replay(config),
            Recorded::Dyadic(tokens) => tokens.replay(config),
            Recorded::D3d11(tokens) => tokens.replay(config),
            Recorded::Esc(tokens) => tokens.replay(config),
        }
    }

    /// Tokens in all.
    #[must_use]
    pub fn tokens(&self) -> usize {
        match &self.0 {
            Recorded::Fractional(tokens) => tokens.len(),
            Recorded::Dyadic(tokens) => tokens.len(),
            Recorded::D3d11(tokens) => tokens.len(),
            Recorded::Esc(tokens) => tokens.len(),
        }
    }
}

impl<T: Flow, P: Probe> Timer<T, P> {
    /// The engine that the configuration names, if it names one.
    fn new(config: &Config, probe: P) -> Option<Self> {
        let chain = chain::stages::<T>(config);
        let shared = chain.iter().any(|(_, shape)| shape.shares_port);
        let frames = config.frames;
        Some(match config.engine {
            Engine::None => return None,
            Engine::Timed if shared => Self::Ordered(Box::new(Ordered::new(chain, frames, probe))),
            Engine::Timed => Self::Timed(Box::new(Timed::new(chain, frames, probe))),
            Engine::Stepped => Self::Stepped(Box::new(Stepped::new(chain, frames, probe))),
        })
    }

    fn feed(&mut self, token: Token<T>) {
        match self {
            Self::Timed(engine) => engine.feed(token),
            Self::Ordered(engine) => engine.feed(token),
            Self::Stepped(engine) => engine.feed(token),
        }
    }

    fn end_frame(&mut self) {
        match self {
            Self::Timed(engine) => engine.end_frame(),
            Self::Ordered(engine) => engine.end_frame(),
            Self::Stepped(engine) => engine.end_frame(),
        }
    }

    fn probe(&mut self) -> &mut P {
        match self {
            Self::Timed(engine) => engine.probe(),
            Self::Ordered(engine) => engine.probe(),
            Self::Stepped(engine) => engine.probe(),
        }
    }

    fn finish(self) -> (Times, P) {
        match self {
            Self::Timed(engine) => engine.finish(),
            Self::Ordered(engine) => engine.finish(),
            Self::Stepped(engine) => engine.finish(),
        }
    }
}

impl<T: Flow> Running<T> {
    fn new(config: &Config) -> Self {
        Timer::new(config, ()).map_or(Self::None, Self::Plain)
    }

    /// With a recorder, if there is an engine.
    fn watched(config: &Config, wanted: &Wanted) -> Self {
        let recorder = Recorder::new(wanted, config.frames, chain::shapes(config));
        Timer::new(config, recorder).map_or(Self::None, Self::Watched)
    }

    fn feed(&mut self, token: Token<T>) {
        match self {
            Self::None => {}
            Self::Recording(recording) => recording.frame.push(token),
            Self::Plain(engine) => engine.feed(token),
            Self::Watched(engine) => engine.feed(token),
        }
    }

    fn end_frame(&mut self) {
        match self {
            Self::None => {}
            Self::Recording(recording) => {
                let frame = std::mem::take(&mut recording.frame);
                recording.frames.push(frame);
            }
            Self::Plain(engine) => engine.end_frame(),
            Self::Watched(engine) => {
                engine.end_frame();
                engine.probe().end_frame();
            }
        }
    }

    fn recorder(&mut self) -> Option<&mut Recorder> {
        match self {
            Self::Watched(engine) => Some(engine.probe()),
            _ => None,
        }
    }

    fn finish(self) -> Option<(Times, Option<Recorder>)> {
        match self {
            Self::None | Self::Recording(_) => None,
            Self::Plain(engine) => Some((engine.finish().0, None)),
            Self::Watched(engine) => {
                let (times, mut recorder) = engine.finish();
                recorder.end_run(times.frames.iter().map(|frame| frame.elapsed).sum());
                Some((times, Some(recorder)))
            }
        }
    }
}

impl<T: Flow> Clock<T> {
    pub(super) fn new(config: &Config) -> Self {
        Self::with(config, Running::new(config))
    }

    /// A clock of which a part is recorded.
    pub(super) fn watched(config: &Config, wanted: &Wanted) -> Self {
        Self::with(config, Running::watched(config, wanted))
    }

    /// A clock that no time is laid over, but which remembers what it was given.
    pub(super) fn recording(config: &Config) -> Self {
        Self::with(config, Running::Recording(Tokens::default()))
    }

    /// What was recorded.
    pub(super) fn into_recording(self) -> Option<Tokens<T>> {
        match self.engine {
            Running::Recording(recording) => Some(recording),
            _ => None,
        }
    }

    fn with(config: &Config, engine: Running<T>) -> Self {
        Self {
            config: config.clone(),
            engine,
            pieces: Pieces::new(&config.link),
            host: Host::new(config),
            sent: Sent::default(),
        }
    }

    fn feed(&mut self, token: Token<T>) {
        self.sent.tokens += 1;
        let (Token::Parcel(parcel, _) | Token::Vertices(parcel, _) | Token::Fetch(parcel)) = token
        else {
            unreachable!("the host sends parcels");
        };
        self.sent.link_bytes += parcel.down + u64::from(parcel.up);
        self.sent.memory_bytes += u64::from(parcel.read) + u64::from(parcel.written);
        if let Some(recorder) = self.engine.recorder() {
            recorder.sent([parcel.down, parcel.up.into()]);
        }
        self.engine.feed(token);
    }

    /// A command of `payload` bytes, without what the host makes of its patches, crosses the link.
    /// `written` bytes go to memory, in bursts.
    pub(super) fn command(&mut self, payload: u64, written: u64) {
        self.end_draw();
        self.pieces = Pieces::new(&self.config.link);
        if self.config.unit.host_tessellates() {
            self.host.command(payload);
        }
        self.deliver(Delivery { payload, written, read: 0 }, 0);
    }

    /// Bytes of a command, of which `vertices` come out where none of them go to memory.
    fn deliver(&mut self, delivery: Delivery, vertices: u64) {
        let Delivery { payload, written, read } = delivery;
        if self.config.unit.host_tessellates() && !self.config.triangles.uses_memory() {
            return self.stream(payload, vertices);
        }
        self.upload(payload, written);
        let mut left = read;
        while left > 0 {
            let read = left.min(PARCEL_MAX);
            left -= read;
            self.feed(Token::Fetch(Parcel { read: read as u32, ..Parcel::default() }));
        }
    }

    fn upload(&mut self, payload: u64, written: u64) {
        let (mut payload, mut written) = (payload, written);
        while payload > 0 {
            let part = payload.min(self.parcel_max());
            payload -= part;
            // The last parcel has what the bursts have beyond the payload.
            let write = if payload == 0 { written } else { written.min(part) };
            written -= write;
            let parcel = Parcel { written: write as u32, ..self.piece(part) };
            self.feed(Token::Parcel(parcel, None));
        }
    }

    /// A patch of the command that was sent last, and what became of it: fetched by the unit, or
    /// tessellated by the host.
    pub(super) fn patch(&mut self, fetch: Fetch, work: Work<T>, hosted: Hosted) {
        let Fetch { points, read, patch, measured } = fetch;
        if let Some(recorder) = self.engine.recorder() {
            recorder.begin_patch(patch);
        }
        if self.config.unit.host_tessellates() {
            let delivery = self.host.patch(&work, hosted);
            self.deliver(delivery, work.made()[0]);
            let fetches = std::mem::take(&mut self.host.fetches);
            fetches.iter().for_each(|&parcel| self.feed(Token::Fetch(parcel)));
            self.host.fetches = fetches;
        } else {
            let parcel = Parcel { points, read, ..Parcel::default() };
            self.feed(Token::Parcel(parcel, Some(work)));
        }
        if let Some(recorder) = self.engine.recorder().filter(|_| !measured) {
            recorder.end_patch(patch);
        }
    }

    /// Where the host tessellates, a draw's indices follow its vertices.
    fn end_draw(&mut self) {
        if self.config.unit.host_tessellates() {
            let delivery = self.host.end_draw();
            self.deliver(delivery, 0);
        }
    }

    /// The next `payload` bytes of a command, of which `vertices` come out.
    fn stream(&mut self, payload: u64, vertices: u64) {
        let (mut payload, mut vertices) = (payload, vertices);
        while payload > 0 {
            let part = payload.min(self.parcel_max());
            // A vertex comes out with the parcel that completes its share.
            let later =
                (u128::from(vertices) * u128::from(payload - part)).div_ceil(payload.into());
            let count = vertices - later as u64;
            payload -= part;
            vertices -= count;
            let parcel = self.piece(part);
            self.feed(Token::Vertices(parcel, count as u32));
        }
    }

    fn parcel_max(&self) -> u64 {
        match self.config.link.transfer {
            TransferMode::Push => PARCEL_MAX,
            TransferMode::Pull => self.config.link.request.into(),
        }
    }

    fn piece(&mut self, payload: u64) -> Parcel {
        let framed = self.pieces.piece(payload);
        let up = u32::try_from(framed.request_bytes).expect("a parcel is one read request");
        Parcel { down: framed.downstream(), up, ..Parcel::default() }
    }

    /// The frame's last patch has been sent. Returns what was.
    pub(super) fn end_frame(&mut self, counters: &mut Counters) -> Sent {
        self.end_draw();
        counters.merge(&self.host.take_counters());
        self.engine.end_frame();
        std::mem::take(&mut self.sent)
    }

    /// # Errors
    /// When more would have to be recorded than can be.
    pub(super) fn check(&mut self) -> Result<()> {
        self.engine.recorder().map_or(Ok(()), |recorder| recorder.check())
    }

    /// The times of the run, if an engine ran, and what was recorded.
    pub(super) fn finish(self) -> Option<(Times, Option<Recorder>)> {
        self.engine.finish()
    }
}
