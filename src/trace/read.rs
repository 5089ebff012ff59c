//! Read: the bytes of a text trace in, its commands out, one at a time.
//!
//! The format is JSON Lines (`traces/README.md`). A trace is checked as it streams, so memory holds
//! one line and the size of each id's points, however long the trace is. After an error the reader
//! is at its end; a trace that breaks off is an error too, so that whoever got all commands without
//! one has got the whole trace.

use super::command::Command;
use super::fast;
use super::json::{Fault, path_at};
use super::lines::{LINE_BYTES_MAX, Line, Lines};
use super::parse;
use super::points::DataFile;
use super::state::State;
use crate::error::{Error, Place, Result};
use std::io::BufRead;
use std::path::PathBuf;

/// A command and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub struct Located {
    /// The command.
    pub command: Command,
    /// Its line, as a whole, or the byte where its block begins.
    pub place: Place,
}

/// An iterator over the commands of a text trace.
pub struct Reader<R> {
    lines: Lines<R>,
    file: String,
    state: State,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Header,
    Commands,
    Over,
}

impl<R: BufRead> Reader<R> {
    /// Reads the trace `input`, which messages call `file`, with its data files in `folder`.
    pub fn new(input: R, file: impl Into<String>, folder: impl Into<PathBuf>) -> Self {
        Self {
            lines: Lines::new(input),
            file: file.into(),
            state: State::new(folder.into()),
            phase: Phase::Header,
        }
    }

    /// SHA-256 of the bytes read so far, in hexadecimal: of the whole trace once [`Command::End`]
    /// has been returned.
    #[must_use]
    pub fn hash(&self) -> String {
        self.lines.hash()
    }

    /// The data files named so far, sorted by name, none twice.
    pub fn data_files(&self) -> impl Iterator<Item = &DataFile> {
        self.state.files.values()
    }

    /// The next command; `None` after the last.
    fn command(&mut self) -> Result<Option<Located>> {
        if self.phase == Phase::Over {
            return Ok(None);
        }
        match self.advance()? {
            Line::End => Err(self.truncated()),
            Line::TooLong => Err(self.too_long()),
            Line::Read => {
                let command = self.parse()?;
                let place = Place::Line { line: self.lines.number(), column: 0 };
                if matches!(command, Command::End) {
                    self.finish()?;
                    self.phase = Phase::Over;
                } else {
                    self.phase = Phase::Commands;
                }
                Ok(Some(Located { command, place }))
            }
        }
    }

    fn advance(&mut self) -> Result<Line> {
        self.lines.advance().map_err(|e| Error::system(&self.file, e))
    }

    fn parse(&mut self) -> Result<Command> {
        let bytes = self.lines.bytes();
        if self.lines.number() == 1 && bytes.starts_with(b"\xef\xbb\xbf") {
            let message = "found a byte order mark, expected UTF-8 without one";
            return Err(self.error(0, message.into()));
        }
        let line = match std::str::from_utf8(bytes) {
            Ok(line) => line,
            Err(e) => {
                let at = e.valid_up_to();
                let message = format!("found the byte 0x{:02x}, expected UTF-8", bytes[at]);
                return Err(self.error(at, message));
            }
        };
        if line.trim().is_empty() {
            return Err(self.error(0, "found a blank line, expected a command".into()));
        }
        let result = match self.phase {
            Phase::Header => parse::first(line),
            _ => match fast::points(line) {
                Some(points) => {
                    self.state.define(&points);
                    Ok(points)
                }
                None => parse::command(line, &mut self.state),
            },
        };
        result.map_err(|fault| self.fault(&fault))
    }

    /// Makes sure that nothing follows the end.
    fn finish(&mut self) -> Result<()> {
        match self.advance()? {
            Line::End => Ok(()),
            Line::TooLong => Err(self.too_long()),
            Line::Read => {
                let text = String::from_utf8_lossy(self.lines.bytes());
                let found = super::json::snippet(&text);
                let message = format!("found {found:?} after the end, expected nothing");
                Err(self.error(0, message))
            }
        }
    }

    fn truncated(&self) -> Error {
        let message = match self.phase {
            Phase::Header => "found nothing, expected the header, {\"tessim\":1,...}",
            _ => "the trace is truncated: this is its last line, expected {\"end\":{}} after it",
        };
        self.error(0, message.into())
    }

    fn too_long(&self) -> Error {
        let message = format!(
            "found a line of more than {} MiB, expected less; put large points into a file of \
             their own: {{\"points\":{{\"id\":0,\"file\":\"NAME\",\"layout\":\"xyz\",\
             \"count\":N}}}}",
            LINE_BYTES_MAX >> 20
        );
        self.error(0, message)
    }

    /// A fault of the current line, with the path of the field that it concerns.
    fn fault(&self, fault: &Fault) -> Error {
        let line = std::str::from_utf8(self.lines.bytes()).unwrap_or_default();
        let path = if fault.has_path { path_at(line, fault.offset) } else { String::new() };
        let colon = if path.is_empty() { "" } else { ": " };
        self.error(fault.offset, format!("{path}{colon}{}", fault.message))
    }

    fn error(&self, offset: usize, message: String) -> Error {
        let place = Place::Line { line: self.lines.number().max(1), column: offset + 1 };
        Error::Input { file: self.file.clone(), place, message }
    }
}

impl<R: BufRead> Iterator for Reader<R> {
    type Item = Result<Located>;

    fn next(&mut self) -> Option<Self::Item> {
        let result = self.command();
        if result.is_err() {
            self.phase = Phase::Over;
        }
        result.transpose()
    }
}

#[cfg(test)]
mod tests {
    use super::super::points::PointSource;
    use super::*;

    const HEAD: &str = r#"{"tessim":1,"title":"t"}"#;

    fn commands(text: &str) -> Result<Vec<Located>> {
        Reader::new(text.as_bytes(), "t.jsonl", ".").collect()
    }

    fn matrix(diagonal: f32) -> String {
        let one = |i| if i % 5 == 0 { diagonal } else { 0.0 };
        serde_json::to_string(&(0..16).map(one).collect::<Vec<f32>>()).unwrap()
    }

    fn frame() -> String {
        let (view, projection) = (matrix(1.0), matrix(2.0));
        format!(r#"{{"frame":{{"viewport":[1280,1024],"view":{view},"projection":{projection}}}}}"#)
    }

    #[test]
    fn a_whole_trace_is_read() {
        let points: Vec<String> = (0..17).map(|i| format!("[{i},0.5,-1e-3]")).collect();
        let points = points.join(",");
        let text = format!(
            "{HEAD}\r\n{}\n{{\"points\":{{\"id\":7,\"xyz\":[{points}]}}}}\n \
             {{\"tessellation\":{{\"criterion\":\"fixed\",\"level\":2.5,\"max_level\":3}}}}\n\
             {{\"draw\":{{\"primitive\":\"patches\",\"points\":7,\"first\":1,\"count\":1}}}}\n\
             {{\"end\":{{}}}}",
            frame()
        );
        let mut reader = Reader::new(text.as_bytes(), "t.jsonl", ".");
        let all: Vec<Located> = reader.by_ref().collect::<Result<_>>().unwrap();
        let places = (1..=6).map(|line| Place::Line { line, column: 0 });
        assert!(all.iter().map(|c| c.place.clone()).eq(places));
        let Command::Points(points) = &all[2].command else { panic!("{:?}", all[2]) };
        let PointSource::Xyz(rows) = &*points.source else { panic!("{points:?}") };
        assert_eq!((points.id, rows.len(), rows[16]), (7, 17, [16.0, 0.5, -1e-3]));
        let Command::Tessellation(state) = all[3].command else { panic!("{:?}", all[3]) };
        assert_eq!((state.min_level, state.max_level), (1 << 16, 3 << 16));
        let Command::Draw(draw) = &all[4].command else { panic!("{:?}", all[4]) };
        assert_eq!((draw.first, draw.models.len(), draw.models_sent), (1, 1, false));
        let hash = hex::encode(<sha2::Sha256 as sha2::Digest>::digest(text.as_bytes()));
        assert_eq!(reader.hash(), hash);
    }

    #[test]
    fn an_error_is_the_last_item() {
        let mut reader = Reader::new(&b"{\"tessim\":1}\n{\"end\":1}\n{\"end\":{}}"[..], "t", ".");
        assert!(reader.next().unwrap().is_ok());
        assert_eq!(
            reader.next().unwrap().unwrap_err().to_string(),
            "t:2:8: end: found 1, expected an object"
        );
        assert!(reader.next().is_none());
    }

    #[test]
    fn a_trace_without_an_end_is_truncated() {
        let error = commands(&format!("{HEAD}\n{}\n", frame())).unwrap_err().to_string();
        assert!(error.starts_with("t.jsonl:2:1: the trace is truncated"), "{error}");
    }
}
