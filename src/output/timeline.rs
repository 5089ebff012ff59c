//! Timelines as files: [`chrome`] for Perfetto and chrome://tracing, [`vcd`] for waveform viewers.
//! In comes a [`Timeline`], out goes text that says the same for the same run.

pub mod chrome;
pub mod vcd;

use super::file::AtomicFile;
use crate::config::Config;
use crate::error::{Error, Result};
use crate::report::timeline::Timeline;
use std::path::{Path, PathBuf};

/// A form of timelines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Trace events as JSON: lanes, FIFO levels, bytes on the link.
    Chrome,
    /// A value change dump: FIFO levels and handshakes.
    Vcd,
}

impl Form {
    /// By the extension of a file: `.json` or `.vcd`.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        match path.extension()?.to_str()? {
            "json" => Some(Self::Chrome),
            "vcd" => Some(Self::Vcd),
            _ => None,
        }
    }
}

/// What a timeline is of, for those who find the file.
#[derive(Clone, Copy, Debug)]
pub struct Labels<'a> {
    /// The title of the trace.
    pub title: &'a str,
    /// The effective configuration.
    pub config: &'a Config,
}

/// A timeline's file under construction: it is there when it is complete.
#[derive(Debug)]
pub struct TimelineFile {
    form: Form,
    file: AtomicFile,
}

impl TimelineFile {
    /// Begins the file that will be at `path`.
    ///
    /// # Errors
    /// [`Error::System`] when its folder does not exist or cannot be written.
    pub fn create(path: impl Into<PathBuf>, form: Form) -> Result<Self> {
        Ok(Self { form, file: AtomicFile::create(path)? })
    }

    /// Writes it, and puts it in its place.
    ///
    /// # Errors
    /// [`Error::System`] when it cannot be written.
    pub fn finish(mut self, timeline: &Timeline, labels: &Labels<'_>) -> Result<()> {
        let written = match self.form {
            Form::Chrome => chrome::write(timeline, labels, &mut self.file),
            Form::Vcd => vcd::write(timeline, labels, &mut self.file),
        };
        written.map_err(|error| Error::system(self.file.path(), error))?;
        self.file.commit()
    }
}
