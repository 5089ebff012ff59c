//! The recorder of timelines: the times of tokens in, block by block in the order of tokens; what
//! each lane did, what each FIFO held and what crossed the link come out, in the order of time.
//!
//! A lane's slices follow from the rules at the head of `rtl_model::time`: it is in flight from a
//! token's acceptance until the token has left and its initiation interval is over, and held up in
//! between as the engine says; the rest it starves. Neighbours in the same state are one.
//!
//! Only the window is kept. Where it is one of patches, its cycles become known on the way: it
//! begins when the link takes the first patch, and until then nothing before the link's last
//! acceptance can be in it. It ends when what came of the last patch has left: tokens keep their
//! order, so the last token of the patch is followed through the chain by counting
//! (`mark`): what a block has emitted when the marked token leaves it is where the mark is next.

mod lane;

use lane::{Bounds, Lane, Times};

use crate::error::{Error, Result};
use crate::report::timeline::{Crossed, Queue, State, Timeline, Track, Wanted, Window};
use crate::report::{self, Report};
use rtl_model::counter::Block;
use rtl_model::time::{Frames, Hold, Probe, Shape};
use std::collections::VecDeque;
use std::ops::Range;

/// Most changes of lanes, pushes, pops and transfers that are kept: 64 MB of memory, and 400 MB of
/// JSON, which viewers still open.
const CHANGES_MAX: usize = 1 << 22;

/// Records a part of a run.
#[derive(Debug)]
pub(super) struct Recorder {
    wanted: Wanted,
    overlap: bool,
    stages: Vec<StageLog>,
    link: Link,
    bounds: Bounds,
    /// Frames that have drained.
    drained: u64,
    /// The frame that the host sends, the tokens it sent in the time of `stages`, and the patches
    /// of the wanted frame.
    sending: u64,
    sent: u64,
    patches: u32,
    /// Of a window of patches: the token that it begins with, and the cycle after what came of the
    /// last patch had left the blocks that the mark has passed.
    first: Option<u64>,
    behind: u64,
    /// The length of the frame, or of the run, once it has ended.
    elapsed: Option<u64>,
}

/// What is known of a block.
#[derive(Debug)]
struct StageLog {
    lanes: Vec<Lane>,
    /// Tokens that have not left: lane, acceptance, and from when on each waited for the port.
    pending: VecDeque<(usize, u64, u64)>,
    /// The same of the token that is accepted next, where it waited.
    waited: Option<u64>,
    /// Into and out of the FIFO before it.
    pushed: Times,
    popped: Times,
    emitted: u64,
    /// Whether what it makes of a token may leave with a later one: of patches, a wave.
    gathers: bool,
    /// What it had emitted when the last token left, and the one before.
    emitted_at: [u64; 2],
    /// Tokens that have left, and when the last did.
    left: u64,
    left_at: u64,
    /// The number of tokens after which those of the window's patches have left.
    mark: Option<u64>,
}

/// Bytes over the link.
#[derive(Debug, Default)]
struct Link {
    /// Of the tokens that were sent and not yet accepted.
    waiting: VecDeque<[u64; 2]>,
    accepted: u64,
    last: Crossed,
    /// At the start of the window.
    before: Crossed,
    crossed: VecDeque<Crossed>,
}

impl Recorder {
    /// A recorder for a chain of these blocks.
    pub(super) fn new(
        wanted: &Wanted,
        frames: Frames,
        chain: impl Iterator<Item = (Block, Shape)>,
    ) -> Self {
        let (floor, end) = match &wanted.window {
            Window::Cycles(cycles) => (cycles.start, Some(cycles.end)),
            Window::Whole | Window::Patches(_) => (0, None),
        };
        Self {
            wanted: wanted.clone(),
            overlap: frames == Frames::Overlap,
            stages: chain.map(|(block, shape)| StageLog::new(block, shape.lanes)).collect(),
            link: Link::default(),
            bounds: Bounds { floor, end, kept: 0 },
            drained: 0,
            sending: 0,
            sent: 0,
            patches: 0,
            first: None,
            behind: 0,
            elapsed: None,
        }
    }

    /// Whether time is that of the timeline.
    fn records(&self) -> bool {
        let now = self.overlap || self.drained == self.wanted.frame;
        now && self.elapsed.is_none() && self.bounds.kept <= CHANGES_MAX
    }

    fn is_patches_frame(&self) -> bool {
        self.sending == self.wanted.frame && self.records()
    }

    /// The host sends a token of so many bytes towards the device and the host.
    pub(super) fn sent(&mut self, bytes: [u64; 2]) {
        if self.records() {
            self.sent += 1;
            self.link.waiting.push_back(bytes);
        }
    }

    /// The tokens of a patch follow.
    pub(super) fn begin_patch(&mut self, patch: u32) {
        if !self.is_patches_frame() {
            return;
        }
        self.patches = self.patches.max(patch + 1);
        if let Window::Patches(patches) = &self.wanted.window
            && patches.start == patch
            && self.first.is_none()
        {
            self.first = Some(self.sent);
        }
    }

    /// All tokens of a patch have been sent.
    pub(super) fn end_patch(&mut self, patch: u32) {
        if let Window::Patches(patches) = &self.wanted.window
            && patches.end - 1 == patch
            && self.is_patches_frame()
        {
            self.stages[0].mark = Some(self.sent);
            self.follow(0);
        }
    }

    /// The host has sent a frame.
    pub(super) fn end_frame(&mut self) {
        self.sending += 1;
    }

    /// The run has ended; where frames overlap it took so many cycles.
    pub(super) fn end_run(&mut self, elapsed: u64) {
        if self.overlap {
            self.elapsed = Some(elapsed);
        }
    }

    /// Moves the mark on from stage `k`, if its token has left.
    fn follow(&mut self, k: usize) {
        for k in k..self.stages.len() {
            let StageLog { mark, left, left_at, emitted, gathers, emitted_at, .. } = self.stages[k];
            if mark != Some(left) {
                return;
            }
            // By the time the mark is through the chain, later tokens have left this block.
            self.behind = self.behind.max(left_at + 1);
            if let Some(next) = self.stages.get_mut(k + 1) {
                // A token that nothing came of waits for others.
                let waits = gathers && emitted_at[0] == emitted_at[1];
                next.mark = Some(emitted + u64::from(waits));
            }
        }
        self.bounds.end = self.bounds.end.or(Some(self.behind));
    }

    /// # Errors
    /// [`Error::Usage`] when more would have to be kept than can be.
    pub(super) fn check(&self) -> Result<()> {
        if self.bounds.kept <= CHANGES_MAX {
            return Ok(());
        }
        // Of lanes that have long been idle it is not known until when.
        let lanes = self.stages.iter().flat_map(|stage| &stage.lanes);
        let reached = lanes.map(|lane| lane.covered).max().unwrap_or(0);
        let from = self.bounds.floor;
        Err(Error::Usage(format!(
            "--timeline: more than {CHANGES_MAX} changes, from cycle {from} to about {reached}: \
             expected a smaller part, by --timeline-window cycles:A..B or patches:A..B"
        )))
    }

    /// What was recorded of the run of `report`.
    ///
    /// # Errors
    /// [`Error::Usage`] when the trace has no such frame, the frame no such cycles or patches.
    pub(super) fn into_timeline(mut self, report: &Report) -> Result<Timeline> {
        self.check()?;
        let frame = self.wanted.frame;
        let Some(elapsed) = self.elapsed.filter(|_| frame < report.frames.len() as u64) else {
            return Err(report::no_such_frame(frame, report.frames.len()));
        };
        let window = self.window(elapsed)?;
        self.bounds.floor = window.start;
        self.bounds.end = Some(window.end);
        let bounds = &mut self.bounds;
        let link = self.link.finish(&window);
        let stages = self.stages.into_iter().enumerate();
        let tracks = stages.map(|(k, stage)| {
            let lanes = stage.lanes.into_iter().map(|lane| lane.finish(&window, bounds)).collect();
            let [pushed, popped] = [stage.pushed, stage.popped].map(|t| t.finish(&window));
            let before = pushed.0 - popped.0;
            let queue = Queue { before, pushed: pushed.1, popped: popped.1 };
            Track { lanes, queue: (k > 0).then_some(queue) }
        });
        let tracks = tracks.collect();
        let (frame, chain) = ((!self.overlap).then_some(frame), report.chain.clone());
        Ok(Timeline { frame, elapsed, window, chain, tracks, link })
    }

    /// The cycles of the window.
    fn window(&self, elapsed: u64) -> Result<Range<u64>> {
        let none = |wanted: String, has: String| {
            let whose = match self.overlap {
                true => "the run".to_owned(),
                false => format!("frame {}", self.wanted.frame),
            };
            Err(Error::Usage(format!("--timeline-window {wanted}: {whose} has {has}")))
        };
        let end = self.bounds.end.map_or(elapsed, |end| end.min(elapsed));
        match &self.wanted.window {
            Window::Whole => Ok(0..elapsed),
            Window::Cycles(cycles) if cycles.start >= elapsed => none(
                format!("cycles:{}..{}", cycles.start, cycles.end),
                format!("{elapsed} cycles"),
            ),
            Window::Cycles(cycles) => Ok(cycles.start..end),
            Window::Patches(patches) => {
                let wanted = format!("patches:{}..{}", patches.start, patches.end);
                if patches.start >= self.patches {
                    return none(wanted, format!("{} patches", self.patches));
                }
                // The floor is the window's once its first token was accepted.
                let accepted = self.first.is_some_and(|first| first < self.link.accepted);
                if !accepted || self.bounds.floor >= end {
                    return none(wanted, "nothing to do for them".to_owned());
                }
                Ok(self.bounds.floor..end)
            }
        }
    }
}

impl StageLog {
    fn new(block: Block, lanes: u32) -> Self {
        Self {
            lanes: (0..lanes).map(|_| Lane::default()).collect(),
            pending: VecDeque::new(),
            waited: None,
            pushed: Times::default(),
            popped: Times::default(),
            emitted: 0,
            gathers: block == Block::Group,
            emitted_at: [0; 2],
            left: 0,
            left_at: 0,
            mark: None,
        }
    }
}

impl Link {
    fn accept(&mut self, at: u64, bounds: &mut Bounds) {
        self.accepted += 1;
        let [down, up] = self.waiting.pop_front().expect("what is accepted was sent");
        if down + up == 0 {
            return;
        }
        self.last = Crossed { at, down: self.last.down + down, up: self.last.up + up };
        bounds.kept -= self.forget(bounds.floor);
        if bounds.end.is_none_or(|end| at < end) {
            self.crossed.push_back(self.last);
            bounds.kept += 1;
        }
    }

    /// Drops what has begun to cross before the window, and says how many.
    fn forget(&mut self, floor: u64) -> usize {
        let mut count = 0;
        while let Some(&crossed) = self.crossed.front().filter(|crossed| crossed.at <= floor) {
            self.before = crossed;
            self.crossed.pop_front();
            count += 1;
        }
        count
    }

    fn finish(mut self, window: &Range<u64>) -> Vec<Crossed> {
        self.forget(window.start);
        self.crossed.retain(|crossed| crossed.at < window.end);
        let before = Crossed { at: window.start, ..self.before };
        std::iter::once(before).chain(self.crossed).collect()
    }
}

impl Probe for Recorder {
    fn held(&mut self, stage: usize, lane: usize, by: Hold, from: u64, to: u64) {
        if from >= to || !self.records() {
            return;
        }
        let stage = &mut self.stages[stage];
        match by {
            Hold::Port => stage.waited = Some(from),
            Hold::Room => stage.lanes[lane].hold(State::Blocked, from, to),
            Hold::Order => stage.lanes[lane].hold(State::BlockedByOrder, from, to),
        }
    }

    fn accepted(&mut self, stage: usize, lane: usize, at: u64) {
        if !self.records() {
            return;
        }
        if stage == 0 {
            if let Window::Patches(_) = self.wanted.window
                && self.first.is_none_or(|first| self.link.accepted <= first)
            {
                self.bounds.floor = at;
            }
            self.link.accept(at, &mut self.bounds);
        } else {
            self.stages[stage].popped.push(at, &mut self.bounds);
        }
        let stage = &mut self.stages[stage];
        let waited = stage.waited.take().unwrap_or(at);
        stage.pending.push_back((lane, at, waited));
    }

    fn emitted(&mut self, stage: usize, at: u64) {
        if !self.records() {
            return;
        }
        self.stages[stage].emitted += 1;
        if let Some(next) = self.stages.get_mut(stage + 1) {
            next.pushed.push(at, &mut self.bounds);
        }
    }

    fn left(&mut self, stage: usize, at: u64, next: u64) {
        if !self.records() {
            return;
        }
        let log = &mut self.stages[stage];
        let (lane, accept, waited) = log.pending.pop_front().expect("what leaves was accepted");
        log.lanes[lane].close(accept, waited, next.max(at + 1), &mut self.bounds);
        log.left += 1;
        log.left_at = at;
        log.emitted_at = [log.emitted_at[1], log.emitted];
        if log.mark.is_some() {
            self.follow(stage);
        }
    }

    fn drained(&mut self, elapsed: u64) {
        if self.records() {
            self.elapsed = Some(elapsed);
        }
        self.drained += 1;
    }
}
