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
    /// How many corners the attributes of each id have.
    pub corners: HashMap<u32, u64>,
    /// Whether a frame has begun.
    pub in_frame: bool,
    /// The data files named so far.
    pub files: BTreeMap<String, DataFile>,
}

impl State {
    pub(crate) fn new(folder: PathBuf) -> Self {
        Self {
            folder,
            points: HashMap::new(),
            corners: HashMap::new(),
            in_frame: false,
            files: BTreeMap::new(),
        }
    }

    /// Takes in a command that begins a frame or defines points or attributes.
    pub(crate) fn define(&mut self, command: &Command) {
        match command {
            Command::Frame(_) => self.in_frame = true,
            Command::Points(points) => {
                self.points.insert(points.id, points.source.len());
            }
            Command::Attributes(attributes) => {
                self.corners.insert(attributes.id, attributes.table.corners());
            }
            _ => {}
        }
    }
}

/// The ids that something has, for a message.
pub(crate) fn ids(known: &HashMap<u32, u64>) -> String {
    const SHOWN_MAX: usize = 8;
    let mut ids: Vec<u32> = known.keys().copied().collect();
    ids.sort_unstable();
    let mut list: Vec<String> = ids.iter().take(SHOWN_MAX).map(u32::to_string).collect();
    if ids.len() > SHOWN_MAX {
        list.push("…".into());
    }
    if list.is_empty() { "none so far".into() } else { list.join(", ") }
}
