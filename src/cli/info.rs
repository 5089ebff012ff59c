//! `info`: what a trace holds. Reads it to its end, so that what has been described is whole and
//! valid.

use super::{print, table};
use std::collections::HashMap;
use std::path::PathBuf;
use tessim::error::Result;
use tessim::output::table::printable;
use tessim::trace::command::{Command, Header};
use tessim::trace::open::Trace;

/// Describe a trace and check it to its end
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim info traces/teapot.jsonl\n  \
                        tessim scene grid | tessim info -")]
pub(crate) struct Args {
    /// The trace; - for standard input
    trace: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<()> {
    let mut reader = Trace::open(&args.trace)?;
    let mut tally = Tally::default();
    for located in reader.by_ref() {
        tally.command(located?.command);
    }
    let mut rows = tally.rows();
    if let Ok(file) = std::fs::metadata(&args.trace) {
        rows.push(("bytes", file.len().to_string()));
    }
    rows.push(("sha256", reader.hash()));
    for file in reader.data_files() {
        rows.push(("data file", format!("{} sha256 {}", printable(&file.name), file.sha256()?)));
    }
    print::print(&table::facts(&rows))
}

#[derive(Default)]
struct Tally {
    header: Header,
    frames: u64,
    draws: u64,
    instances: u64,
    patches: u64,
    /// Points by where they live and how many coordinates they have.
    points: HashMap<(bool, u32), u64>,
    /// Corners with attributes.
    corners: u64,
}

impl Tally {
    fn command(&mut self, command: Command) {
        match command {
            Command::Header(header) => self.header = header,
            Command::Frame(_) => self.frames += 1,
            Command::Points(points) => {
                let kind = (points.source.file().is_some(), points.source.components());
                *self.points.entry(kind).or_default() += points.source.len();
            }
            Command::Attributes(attributes) => self.corners += attributes.table.corners(),
            Command::Draw(draw) => {
                self.draws += 1;
                self.instances += draw.models.len() as u64;
                self.patches += draw.primitive.patches() * draw.models.len() as u64;
            }
            Command::Tessellation(_) | Command::End => {}
        }
    }

    fn rows(&self) -> Vec<(&'static str, String)> {
        let points = |kind| self.points.get(&kind).copied().unwrap_or(0).to_string();
        vec![
            ("title", printable(&self.header.title)),
            ("source", printable(&self.header.source)),
            ("licence", printable(&self.header.licence)),
            ("frames", self.frames.to_string()),
            ("draws", self.draws.to_string()),
            ("instances", self.instances.to_string()),
            ("patches", self.patches.to_string()),
            ("points xyz", points((false, 3))),
            ("points xyzw", points((false, 4))),
            ("points xyz in files", points((true, 3))),
            ("points xyzw in files", points((true, 4))),
            ("corners with attributes", self.corners.to_string()),
        ]
    }
}
