//! Replay: a trace that is to be read more than once.
//!
//! A file is opened anew each time. What can be read only once, standard input or a pipe, is copied
//! to a temporary file first, so that memory does not grow with the trace.

use super::open::{Trace, folder};
use crate::error::{Error, Result};
use std::fs::File;
use std::io::{self, Seek};
use std::path::{Path, PathBuf};

/// A trace that can be read from its start as often as it is needed.
#[derive(Debug)]
pub struct Replay {
    path: PathBuf,
    /// The copy of what can be read only once.
    spool: Option<File>,
}

impl Replay {
    /// Opens the trace at `path`, or standard input for `-`.
    ///
    /// # Errors
    /// [`Error::System`] for a file that cannot be opened, or a copy that cannot be made.
    pub fn open(path: &Path) -> Result<Self> {
        let failed = |error: io::Error| Error::system(path, error);
        let path_is_stdin = path == Path::new("-");
        let spool = if path_is_stdin {
            Some(copy(&mut io::stdin().lock()).map_err(failed)?)
        } else {
            let mut file = File::open(path).map_err(failed)?;
            let again = file.metadata().map_err(failed)?.is_file();
            if again { None } else { Some(copy(&mut file).map_err(failed)?) }
        };
        Ok(Self { path: path.to_owned(), spool })
    }

    /// A reader of the trace from its start, which takes the place of the one before.
    ///
    /// # Errors
    /// [`Error::System`] for a file that cannot be opened any more.
    pub fn reader(&mut self) -> Result<Trace> {
        let Some(spool) = &mut self.spool else { return Trace::open(&self.path) };
        let rewound = spool.rewind().and_then(|()| spool.try_clone());
        let copy = rewound.map_err(|error| Error::system(&self.path, error))?;
        Trace::new(copy, self.path.display().to_string(), folder(&self.path))
    }

    /// The trace as the user named it.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }
}

fn copy(input: &mut impl io::Read) -> io::Result<File> {
    let mut copy = tempfile::tempfile()?;
    io::copy(input, &mut copy)?;
    Ok(copy)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_copied_reads_as_often_as_a_file() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("traces/teapot.jsonl");
        let spool = Some(copy(&mut File::open(&path).unwrap()).unwrap());
        let mut copied = Replay { path: "-".into(), spool };
        let mut named = Replay::open(&path).unwrap();
        for _ in 0..3 {
            let [a, b] = [&mut copied, &mut named].map(|replay| {
                let mut reader = replay.reader().unwrap();
                let count = reader.by_ref().map(Result::unwrap).count();
                (count, reader.hash())
            });
            assert_eq!(a, b);
            assert!(a.0 > 3);
        }
    }
}
