//! State: what a reader remembers of the commands before, so that a draw can be checked against
//! them. Ids last across frames, and a known id is replaced.

use super::command::Command;
use super::points::DataFile;
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;

/// What has been defined so far.
#[derive(Debug)]
pub(crate) struct State {
    /// Where the trace's data files are.
    pub folder: PathBuf,
    /// How many points each id has.
    pub points: HashMap<u32, u64>,
    /// Whether a frame has begun.
    pub in_frame: bool,
    /// The data files named so far.
    pub files: BTreeMap<String, DataFile>,
}

impl State {
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self { folder, points: HashMap::new(), in_frame: false, files: BTreeMap::new() }
    }

    /// Takes in a command that defines points.
    pub(crate) fn define(&mut self, command: &Command) {
        if let Command::Points(points) = command {
            self.points.insert(points.id, points.source.len());
        }
    }

    /// The ids that points have, for a message.
    pub(crate) fn ids(&self) -> String {
        const SHOWN_MAX: usize = 8;
        let mut ids: Vec<u32> = self.points.keys().copied().collect();
        ids.sort_unstable();
        let mut list: Vec<String> = ids.iter().take(SHOWN_MAX).map(u32::to_string).collect();
        if ids.len() > SHOWN_MAX {
            list.push("…".into());
        }
        if list.is_empty() { "none so far".into() } else { list.join(", ") }
    }
}
