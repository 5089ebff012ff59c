//! A file of requests: lines in, lines out, in order and as they come, whatever its length.

use super::super::print;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;
use tessim::error::{Error, Place, Result};

/// Six factors of any reasonable number of digits fit many times over.
const LINE_BYTES_MAX: u64 = 4096;

/// The column (from 1) of what is wrong with a line, and why.
pub(super) type Fault = (usize, String);

/// A line of text without its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a>(&'a str);

impl<'a> Line<'a> {
    fn of(line: &'a [u8]) -> Result<Self, Fault> {
        if line.len() as u64 > LINE_BYTES_MAX {
            let message =
                format!("found a line of more than {LINE_BYTES_MAX} bytes, expected less");
            return Err((1, message));
        }
        let line = std::str::from_utf8(line)
            .map_err(|error| (error.valid_up_to() + 1, "expected UTF-8".to_owned()))?;
        Ok(Self(line.trim_end()))
    }

    pub(super) fn words(self) -> std::str::SplitAsciiWhitespace<'a> {
        self.0.split_ascii_whitespace()
    }

    /// Where a word of the line is, from 1, or the line's end for none.
    pub(super) fn column(self, word: Option<&str>) -> usize {
        // A word's place is its distance from the line's start, both being in the same text.
        word.map_or(self.0.len(), |word| word.as_ptr() as usize - self.0.as_ptr() as usize) + 1
    }
}

/// A word as a message shows it.
pub(super) fn found(word: Option<&str>) -> String {
    word.map_or_else(|| "nothing".to_owned(), |word| format!("{word:?}"))
}

/// Answers every line of the file at `path`, or of standard input for `-`.
pub(super) fn run<T, W: Write>(
    path: &Path,
    out: &mut W,
    request: impl Fn(Line<'_>) -> Result<T, Fault>,
    write: impl FnMut(&T, &mut W) -> io::Result<()>,
) -> Result<()> {
    if path == Path::new("-") {
        return answer(io::stdin().lock(), path, out, request, write);
    }
    let file = File::open(path).map_err(|error| Error::system(path, error))?;
    answer(BufReader::new(file), path, out, request, write)
}

/// Answers every line of `input`, which the user knows as `path`.
pub(super) fn answer<T, W: Write>(
    mut input: impl BufRead,
    path: &Path,
    out: &mut W,
    request: impl Fn(Line<'_>) -> Result<T, Fault>,
    mut write: impl FnMut(&T, &mut W) -> io::Result<()>,
) -> Result<()> {
    let mut line = Vec::new();
    for number in 1.. {
        line.clear();
        let read = input.by_ref().take(LINE_BYTES_MAX + 1).read_until(b'\n', &mut line);
        if read.map_err(|error| Error::system(path, error))? == 0 {
            break;
        }
        let request = Line::of(&line).and_then(&request).map_err(|(column, message)| {
            // What was answered is answered: the error comes after it.
            let _ = out.flush();
            let place = Place::Line { line: number, column };
            Error::Input { file: path.display().to_string(), place, message }
        })?;
        write(&request, out).map_err(print::error)?;
    }
    Ok(())
}
