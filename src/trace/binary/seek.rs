//! Seek: a binary trace and the number of a frame in; out come the header, the definitions that are
//! live where the frame begins, the frame and its draws, and an end, as `OnlyFrame` makes them of
//! a whole trace. Reads the trailer, the index, and the blocks where these stand.
//!
//! What is read is checked as ever; what is not read is not.

use super::block::Part;
use super::index::{Record, Trailer};
use super::read::{Decoder, name};
use super::{Kind, PREAMBLE, Place};
use crate::error::{Error, Result};
use crate::trace::command::Command;
use crate::trace::definition::Definition;
use crate::trace::only::no_such_frame;
use crate::trace::points::DataFile;
use crate::trace::read::Located;
use std::collections::{BTreeMap, VecDeque};
use std::io::{Read, Seek};
use std::path::PathBuf;

/// An iterator over the commands that one frame needs.
pub struct FrameReader<R> {
    decoder: Decoder<R>,
    trailer: Trailer,
    /// What is still to be read before the draws of the frame.
    plan: VecDeque<(Expected, Place)>,
    over: bool,
}

/// What the index says of a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Expected {
    Header,
    Definition(Definition),
    Frame,
}

impl Expected {
    fn is(self, command: &Command) -> bool {
        match self {
            Self::Header => matches!(command, Command::Header(_)),
            Self::Definition(name) => Definition::of(command) == Some(name),
            Self::Frame => matches!(command, Command::Frame(_)),
        }
    }
}

impl<R: Read + Seek> FrameReader<R> {
    /// Reads frame `frame`, from 0, of the trace `input`, which messages call `file`, with its data
    /// files in `folder`.
    ///
    /// # Errors
    /// A trailer or an index that is damaged, no such frame, or an input that cannot be read.
    pub fn new(
        input: R,
        file: impl Into<String>,
        folder: impl Into<PathBuf>,
        frame: u64,
    ) -> Result<Self> {
        let mut decoder = Decoder::new(input, file.into(), folder.into());
        decoder.blocks.preamble()?;
        let trailer = decoder.blocks.last()?;
        if frame >= trailer.frames {
            return Err(no_such_frame(frame, trailer.frames));
        }
        let mut places =
            vec![(Expected::Header, Place { block: PREAMBLE.len() as u64, offset: 0 })];
        places.extend(live(&mut decoder, &trailer, frame)?);
        Ok(Self { decoder, trailer, plan: places.into(), over: false })
    }

    /// SHA-256 of all bytes of the file before its trailer, in hexadecimal, as the trailer has it.
    #[must_use]
    pub fn hash(&self) -> String {
        hex::encode(self.trailer.hash)
    }

    /// The data files named so far, sorted by name, none twice.
    pub fn data_files(&self) -> impl Iterator<Item = &DataFile> {
        self.decoder.state.files.values()
    }

    fn command(&mut self) -> Result<Option<Located>> {
        if self.over {
            return Ok(None);
        }
        if let Some((expected, place)) = self.plan.pop_front() {
            return self.planned(expected, place).map(Some);
        }
        if self.decoder.at_end() {
            self.decoder.commands()?;
        }
        let mut located = self.decoder.decode()?;
        match located.command {
            Command::Header(_) => {
                return Err(self.decoder.refuse("found a header within a frame, expected none"));
            }
            Command::Frame(_) | Command::End => {
                self.over = true;
                located.command = Command::End;
            }
            _ => {}
        }
        Ok(Some(located))
    }

    /// The command at a place that the index names.
    fn planned(&mut self, expected: Expected, place: Place) -> Result<Located> {
        let decoder = &mut self.decoder;
        if decoder.blocks.start() != place.block || decoder.blocks.content().is_empty() {
            decoder.blocks.seek(place.block)?;
            decoder.commands()?;
        }
        decoder.offset = place.offset as usize;
        if decoder.offset >= decoder.blocks.content().len() {
            let length = decoder.blocks.content().len();
            return Err(decoder.blocks.error(format!(
                "found {length} bytes of content, expected more, as the index names byte {}",
                place.offset
            )));
        }
        let located = decoder.decode()?;
        if !expected.is(&located.command) {
            let found = name(&located.command);
            let reason = format!("found {found}, expected {expected:?}, as the index says");
            return Err(decoder.refuse(reason));
        }
        Ok(located)
    }
}

/// The places of what is live where a frame begins, in the order of the trace, and its own.
fn live<R: Read + Seek>(
    decoder: &mut Decoder<R>,
    trailer: &Trailer,
    frame: u64,
) -> Result<Vec<(Expected, Place)>> {
    let mut live = BTreeMap::new();
    let mut frames = 0;
    decoder.blocks.seek(trailer.index)?;
    loop {
        match decoder.blocks.advance()? {
            Part::Block(Kind::Index) => {}
            _ => {
                let message = format!("found the index at its end, expected frame {frame} in it");
                return Err(decoder.blocks.error(message));
            }
        }
        let mut records = decoder.blocks.content();
        while !records.is_empty() {
            let (record, rest) =
                postcard::take_from_bytes::<Record>(records).map_err(|reason| {
                    decoder
                        .blocks
                        .error(format!("found no record of an index, expected one: {reason}"))
                })?;
            records = rest;
            match record {
                Record::Definition(name, place) => {
                    live.insert(name, place);
                }
                Record::Frame(place) if frames == frame => {
                    let live = live.into_iter();
                    let mut places: Vec<_> =
                        live.map(|(name, place)| (Expected::Definition(name), place)).collect();
                    places.sort_unstable_by_key(|(_, place)| *place);
                    places.push((Expected::Frame, place));
                    return Ok(places);
                }
                Record::Frame(_) => frames += 1,
            }
        }
    }
}

impl<R: Read + Seek> Iterator for FrameReader<R> {
    type Item = Result<Located, Error>;

    fn next(&mut self) -> Option<Self::Item> {
        let result = self.command();
        if result.is_err() {
            self.over = true;
        }
        result.transpose()
    }
}
