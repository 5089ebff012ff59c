//! Read: the bytes of a binary trace in, its commands out, one at a time.
//!
//! It streams: memory holds one block. Each command is checked like one of a text trace; its place
//! is the byte where its block begins. The end is handed out once all that follows it, index and
//! trailer, has been found right, so that whoever got all commands without an error has got the
//! whole trace as it was written.

use super::block::{Blocks, Part};
use super::index::{Indexer, Trailer};
use super::{Kind, Place, wire};
use crate::error::{self, Error, Result};
use crate::trace::check;
use crate::trace::command::Command;
use crate::trace::points::DataFile;
use crate::trace::read::Located;
use crate::trace::state::State;
use std::io::Read;
use std::path::PathBuf;

/// An iterator over the commands of a binary trace.
pub struct Reader<R> {
    decoder: Decoder<R>,
    indexer: Indexer,
    /// Of the index as it should be.
    records: crc32fast::Hasher,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Preamble,
    Commands,
    Over,
}

impl<R: Read> Reader<R> {
    /// Reads the trace `input`, which messages call `file`, with its data files in `folder`.
    pub fn new(input: R, file: impl Into<String>, folder: impl Into<PathBuf>) -> Self {
        Self {
            decoder: Decoder::new(input, file.into(), folder.into()),
            indexer: Indexer::default(),
            records: crc32fast::Hasher::new(),
            phase: Phase::Preamble,
        }
    }

    /// SHA-256 of the bytes read so far, in hexadecimal: of all but the trailer, which holds it
    /// too, once [`Command::End`] has been returned.
    #[must_use]
    pub fn hash(&self) -> String {
        hex::encode(self.decoder.blocks.hash())
    }

    /// The data files named so far, sorted by name, none twice.
    pub fn data_files(&self) -> impl Iterator<Item = &DataFile> {
        self.decoder.state.files.values()
    }

    /// The next command; `None` after the last.
    fn command(&mut self) -> Result<Option<Located>> {
        match self.phase {
            Phase::Over => return Ok(None),
            Phase::Preamble => self.decoder.blocks.preamble()?,
            Phase::Commands => {}
        }
        if self.decoder.at_end() {
            self.decoder.commands()?;
        }
        let first = self.phase == Phase::Preamble;
        let place = self.decoder.place();
        let located = self.decoder.decode()?;
        if first != matches!(located.command, Command::Header(_)) {
            let expected = if first { "the header first" } else { "it first and only there" };
            let name = name(&located.command);
            return Err(self.decoder.refuse(format!("found {name}, expected {expected}")));
        }
        let records = &mut self.records;
        self.indexer.note(&located.command, place, |record| records.update(record));
        self.phase = Phase::Commands;
        if matches!(located.command, Command::End) {
            self.finish()?;
            self.phase = Phase::Over;
        }
        Ok(Some(located))
    }

    /// Reads what follows the end.
    fn finish(&mut self) -> Result<()> {
        if !self.decoder.at_end() {
            let message = "found more in this block after the end, expected nothing";
            return Err(self.decoder.blocks.error(message));
        }
        let mut index = None;
        let mut found = crc32fast::Hasher::new();
        let trailer = loop {
            match self.decoder.blocks.advance()? {
                Part::Trailer(trailer) => break trailer,
                Part::Block(Kind::Index) => {
                    index.get_or_insert(self.decoder.blocks.start());
                    found.update(self.decoder.blocks.content());
                }
                Part::Block(_) => {
                    let message = "found commands after the end, expected the index or the trailer";
                    return Err(self.decoder.blocks.error(message));
                }
            }
        };
        let blocks = &mut self.decoder.blocks;
        let index = index.unwrap_or(blocks.start());
        if found.finalize() != self.records.clone().finalize() {
            let message = "found an index that is not the one of the commands, expected it to be";
            return Err(blocks.error_at(index, message));
        }
        let expected = Trailer { hash: blocks.hash(), index, frames: self.indexer.frames() };
        if trailer != expected {
            let show = |t: Trailer| {
                let hash = hex::encode(t.hash);
                format!("SHA-256 {hash}, index at byte {}, frames {}", t.index, t.frames)
            };
            let (found, expected) = (show(trailer), show(expected));
            return Err(blocks.error(format!("found the trailer {found}; expected {expected}")));
        }
        blocks.finish()
    }
}

impl<R: Read> Iterator for Reader<R> {
    type Item = Result<Located>;

    fn next(&mut self) -> Option<Self::Item> {
        let result = self.command();
        if result.is_err() {
            self.phase = Phase::Over;
        }
        result.transpose()
    }
}

/// The commands of blocks, one at a time, checked against those before.
pub(super) struct Decoder<R> {
    pub(super) blocks: Blocks<R>,
    pub(super) state: State,
    /// In the content of the current block: what is decoded next.
    pub(super) offset: usize,
    /// Where the command that was decoded last begins.
    last: usize,
}

impl<R: Read> Decoder<R> {
    pub(super) fn new(input: R, file: String, folder: PathBuf) -> Self {
        Self { blocks: Blocks::new(input, file), state: State::new(folder), offset: 0, last: 0 }
    }

    /// Whether the current block has no more commands.
    pub(super) fn at_end(&self) -> bool {
        self.offset == self.blocks.content().len()
    }

    /// Where the next command stands.
    pub(super) fn place(&self) -> Place {
        let offset = u32::try_from(self.offset).expect("contents are limited");
        Place { block: self.blocks.start(), offset }
    }

    /// Goes on to the next block, which must be one of commands.
    pub(super) fn commands(&mut self) -> Result<()> {
        self.offset = 0;
        self.last = 0;
        match self.blocks.advance()? {
            Part::Block(Kind::Commands) => Ok(()),
            other => {
                let found =
                    if matches!(other, Part::Trailer(_)) { "the trailer" } else { "an index" };
                let message = format!("found {found} before the end, expected commands");
                Err(self.blocks.error(message))
            }
        }
    }

    /// The command that stands next in the block, of which there is one.
    pub(super) fn decode(&mut self) -> Result<Located> {
        self.last = self.offset;
        let decoded = wire::decode(&self.blocks.content()[self.offset..], &mut self.state);
        let checked = decoded.and_then(|(command, bytes)| {
            let checked = check::command(&command, &self.state);
            checked.map_err(|reason| format!("{}: {reason}", name(&command)))?;
            Ok((command, bytes))
        });
        let (command, bytes) = checked.map_err(|reason| self.refuse(reason))?;
        self.state.define(&command);
        self.offset += bytes;
        Ok(Located { command, place: error::Place::Byte(self.blocks.start()) })
    }

    /// The error that the command that was decoded last is not what was expected.
    pub(super) fn refuse(&self, reason: impl std::fmt::Display) -> Error {
        self.blocks.error(format!("at {} of the block's content: {reason}", self.last))
    }
}

/// What a command is called in messages: as in the text form.
pub(super) fn name(command: &Command) -> &'static str {
    match command {
        Command::Header(_) => "header",
        Command::Frame(_) => "frame",
        Command::Points(_) => "points",
        Command::Attributes(_) => "attributes",
        Command::Tessellation(_) => "tessellation",
        Command::Draw(_) => "draw",
        Command::End => "end",
    }
}
