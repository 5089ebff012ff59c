//! Only: the commands of a trace in; out come those that one of its frames needs, as a trace of
//! that frame alone: the header, the definitions that are live where the frame begins, in their
//! order, the frame and what follows it up to the next, and an end.
//!
//! What was defined before the frame crosses the link before it here, and so is counted in it. The
//! trace is read to its end, so that what was run is part of a valid one.

use super::command::Command;
use super::definition::Definition;
use super::read::Located;
use crate::error::{Error, Result};
use std::collections::{BTreeMap, VecDeque};

/// Picks out a frame. Holds what is live before it, as a unit would.
#[derive(Debug)]
pub(crate) struct OnlyFrame {
    frame: u64,
    /// Frames that have begun.
    begun: u64,
    /// What is live, with its number in the order of the trace.
    live: BTreeMap<Definition, (u64, Located)>,
    seen: u64,
    /// What is to be handed out before anything more is read.
    queue: VecDeque<Located>,
}

impl OnlyFrame {
    /// Picks out the frame of that number, from 0.
    pub(crate) fn new(frame: u64) -> Self {
        let (live, queue) = (BTreeMap::new(), VecDeque::new());
        Self { frame, begun: 0, live, seen: 0, queue }
    }

    /// The next of the commands, out of those of the whole trace.
    pub(crate) fn next(
        &mut self,
        trace: &mut impl Iterator<Item = Result<Located>>,
    ) -> Option<Result<Located>> {
        loop {
            if let Some(located) = self.queue.pop_front() {
                return Some(Ok(located));
            }
            let located = match trace.next()? {
                Ok(located) => located,
                Err(error) => return Some(Err(error)),
            };
            match located.command {
                Command::Header(_) => return Some(Ok(located)),
                Command::End if self.begun <= self.frame => {
                    return Some(Err(no_such_frame(self.frame, self.begun)));
                }
                Command::End => return Some(Ok(located)),
                Command::Frame(_) => self.begin(located),
                _ if self.begun == self.frame + 1 => return Some(Ok(located)),
                _ if self.begun <= self.frame => self.define(located),
                _ => {}
            }
        }
    }

    fn begin(&mut self, frame: Located) {
        self.begun += 1;
        if self.begun == self.frame + 1 {
            let mut live: Vec<_> = std::mem::take(&mut self.live).into_values().collect();
            live.sort_unstable_by_key(|(number, _)| *number);
            self.queue.extend(live.into_iter().map(|(_, located)| located));
            self.queue.push_back(frame);
        }
    }

    fn define(&mut self, located: Located) {
        if let Some(name) = Definition::of(&located.command) {
            self.seen += 1;
            self.live.insert(name, (self.seen, located));
        }
    }
}

/// The error that a trace of `frames` frames has no frame of that number.
pub(crate) fn no_such_frame(frame: u64, frames: u64) -> Error {
    let numbered = match frames {
        0 => "the trace has none".to_owned(),
        1 => "the trace has frame 0 only".to_owned(),
        _ => format!("the trace has frames 0 to {}", frames - 1),
    };
    Error::Usage(format!("--only-frame {frame}: no such frame: {numbered}"))
}
