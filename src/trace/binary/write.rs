//! Write: commands in, the blocks of a binary trace out, which read back as the same commands.
//!
//! Like the writer of text it checks nothing but sizes: the reader does. The index is kept until
//! the end, some ten bytes for each frame and each definition that outlives its frame.

use super::block::Packer;
use super::index::{Indexer, Trailer};
use super::{BLOCK_BYTES, CONTENT_BYTES_MAX, Kind, PREAMBLE, Place, wire};
use crate::trace::command::Command;
use crate::trace::state::State;
use sha2::{Digest, Sha256};
use std::io::{self, Write};

/// A frame opens a block of its own where the one before has this content, in bytes: so that
/// reading one frame reads little else, and small frames still share a block.
const FRAME_BYTES: usize = BLOCK_BYTES / 16;

/// Writes commands as blocks. The end closes the file.
pub struct Writer<W> {
    output: W,
    /// Bytes written.
    at: u64,
    hash: Sha256,
    packer: Packer,
    /// Of the block that is being filled.
    content: Vec<u8>,
    command: Vec<u8>,
    packed: Vec<u8>,
    indexer: Indexer,
    /// The contents of the blocks of the index.
    index: Vec<Vec<u8>>,
}

/// A file that holds one block of commands, whose content is these bytes, whatever they are, and an
/// index of the commands that they are, as far as they are any. Tests get past the checksums so.
///
/// # Errors
/// Those of the compressor; contents that no block holds.
pub fn file_of(content: &[u8]) -> io::Result<Vec<u8>> {
    let mut writer = Writer::new(Vec::new())?;
    if content.is_empty() || content.len() > CONTENT_BYTES_MAX {
        return Err(io::ErrorKind::InvalidInput.into());
    }
    // There is no such folder, so that no bytes can name a file.
    let mut state = State::new("no/such/folder".into());
    let mut offset = 0;
    while let Ok((command, bytes)) = wire::decode(&content[offset..], &mut state) {
        writer.index(&command, offset);
        offset += bytes;
    }
    writer.content = content.to_vec();
    writer.finish()?;
    Ok(writer.into_inner())
}

impl<W: Write> Writer<W> {
    /// Writes to `output`, which gets whole blocks.
    ///
    /// # Errors
    /// Those of the output; a compressor that cannot be had.
    pub fn new(output: W) -> io::Result<Self> {
        let mut writer = Self {
            output,
            at: 0,
            hash: Sha256::new(),
            packer: Packer::new()?,
            content: Vec::new(),
            command: Vec::new(),
            packed: PREAMBLE.to_vec(),
            indexer: Indexer::default(),
            index: Vec::new(),
        };
        writer.send()?;
        Ok(writer)
    }

    /// Writes a command; with the end, what is left of the file. Nothing goes after the end.
    ///
    /// # Errors
    /// Those of the output. [`io::ErrorKind::InvalidInput`] for a command that needs more than
    /// [`CONTENT_BYTES_MAX`].
    pub fn write(&mut self, command: &Command) -> io::Result<()> {
        wire::encode(command, &mut self.command);
        let bytes = self.command.len();
        if bytes > CONTENT_BYTES_MAX {
            let message = format!(
                "a command of {bytes} bytes is more than the {CONTENT_BYTES_MAX} that a block \
                 holds; put large points into a file of their own"
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, message));
        }
        let held = self.content.len();
        let frame = matches!(command, Command::Frame(_)) && held >= FRAME_BYTES;
        if frame || held + bytes > BLOCK_BYTES {
            self.flush()?;
        }
        self.index(command, self.content.len());
        self.content.extend_from_slice(&self.command);
        match command {
            // By itself, so that one frame's reader need not read all that follows it.
            Command::Header(_) => self.flush(),
            Command::End => self.finish(),
            _ => Ok(()),
        }
    }

    /// The output, with all that was written.
    pub fn into_inner(self) -> W {
        self.output
    }

    /// Takes note of a command that will stand at this byte of the content.
    fn index(&mut self, command: &Command, offset: usize) {
        let offset = u32::try_from(offset).expect("contents are limited");
        let place = Place { block: self.at, offset };
        self.indexer.note(command, place, |record| {
            match self.index.last_mut().filter(|last| last.len() + record.len() <= BLOCK_BYTES) {
                Some(last) => last.extend_from_slice(record),
                None => self.index.push(record.to_vec()),
            }
        });
    }

    fn flush(&mut self) -> io::Result<()> {
        if self.content.is_empty() {
            return Ok(());
        }
        self.packer.pack(Kind::Commands, self.at, &self.content, &mut self.packed)?;
        self.content.clear();
        self.send()
    }

    fn finish(&mut self) -> io::Result<()> {
        self.flush()?;
        let index = self.at;
        for content in std::mem::take(&mut self.index) {
            self.packer.pack(Kind::Index, self.at, &content, &mut self.packed)?;
            self.send()?;
        }
        let hash = self.hash.clone().finalize().into();
        let trailer = Trailer { hash, index, frames: self.indexer.frames() };
        self.output.write_all(&trailer.bytes())?;
        self.output.flush()
    }

    /// Hands what is packed to the output.
    fn send(&mut self) -> io::Result<()> {
        self.hash.update(&self.packed);
        self.at += self.packed.len() as u64;
        self.output.write_all(&self.packed)?;
        self.packed.clear();
        Ok(())
    }
}
