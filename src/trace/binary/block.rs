//! Blocks: content in, checksummed and compressed bytes out; and bytes in, content out, or where
//! they are damaged.

use super::index::Trailer;
use super::{BLOCK_BYTES, CONTENT_BYTES_MAX, Kind, PREAMBLE};
use crate::error::{Error, Place, Result};
use sha2::{Digest, Sha256};
use std::io::{self, Read, Seek, SeekFrom};
use zstd::bulk::{Compressor, Decompressor};
use zstd::zstd_safe;

/// Bytes of a block before its payload.
const HEAD_BYTES: usize = 28;
/// zstd's default: higher levels gain a few per cent and cost several times as much.
const ZSTD_LEVEL: i32 = 3;

/// Makes blocks of contents.
pub(super) struct Packer {
    compressor: Compressor<'static>,
}

impl Packer {
    pub(super) fn new() -> io::Result<Self> {
        Ok(Self { compressor: Compressor::new(ZSTD_LEVEL)? })
    }

    /// Appends to `out` the block at byte `at`.
    pub(super) fn pack(
        &mut self,
        kind: Kind,
        at: u64,
        content: &[u8],
        out: &mut Vec<u8>,
    ) -> io::Result<()> {
        let payload = self.compressor.compress(content)?;
        let start = out.len();
        let size = |bytes: &[u8]| u32::try_from(bytes.len()).expect("contents are limited");
        out.extend((kind as u32).to_le_bytes());
        out.extend(at.to_le_bytes());
        out.extend(size(content).to_le_bytes());
        out.extend(size(&payload).to_le_bytes());
        out.extend(crc32fast::hash(&payload).to_le_bytes());
        let sum = crc32fast::hash(&out[start..]);
        out.extend(sum.to_le_bytes());
        out.extend(payload);
        Ok(())
    }
}

/// What comes next in a file.
#[derive(Debug)]
pub(super) enum Part {
    /// A block, whose content is [`Blocks::content`].
    Block(Kind),
    /// The trailer, and the bytes that a whole reading hashes all before it.
    Trailer(Trailer),
}

/// The blocks of an input.
pub(super) struct Blocks<R> {
    input: R,
    file: String,
    /// Of the input: the byte that is read next.
    at: u64,
    /// Where the block that was read last begins.
    start: u64,
    hash: Sha256,
    payload: Vec<u8>,
    content: Vec<u8>,
    decompressor: Decompressor<'static>,
}

impl<R: Read> Blocks<R> {
    pub(super) fn new(input: R, file: String) -> Self {
        Self {
            input,
            file,
            at: 0,
            start: 0,
            hash: Sha256::new(),
            payload: Vec::new(),
            content: Vec::new(),
            decompressor: Decompressor::default(),
        }
    }

    /// The content of the block that was read last.
    pub(super) fn content(&self) -> &[u8] {
        &self.content
    }

    /// Where the block that was read last begins.
    pub(super) fn start(&self) -> u64 {
        self.start
    }

    /// SHA-256 of the bytes read so far, the trailer's aside.
    pub(super) fn hash(&self) -> [u8; 32] {
        self.hash.clone().finalize().into()
    }

    /// An error at the block that was read last.
    pub(super) fn error(&self, message: impl Into<String>) -> Error {
        self.error_at(self.start, message)
    }

    pub(super) fn error_at(&self, byte: u64, message: impl Into<String>) -> Error {
        Error::Input { file: self.file.clone(), place: Place::Byte(byte), message: message.into() }
    }

    pub(super) fn preamble(&mut self) -> Result<()> {
        let mut bytes = [0; PREAMBLE.len()];
        self.fill(&mut bytes, "the preamble of a binary trace")?;
        let Some(k) = (0..bytes.len()).find(|k| bytes[*k] != PREAMBLE[*k]) else {
            self.hash.update(bytes);
            return Ok(());
        };
        let (found, expected) = (bytes[k], PREAMBLE[k]);
        let message = if k == PREAMBLE.len() - 1 {
            format!("found version {found}, expected {expected}, the only one known here")
        } else {
            format!("found the byte 0x{found:02x}, expected 0x{expected:02x} of \"tessim\"")
        };
        Err(self.error_at(k as u64, message))
    }

    /// Reads the next block or the trailer.
    pub(super) fn advance(&mut self) -> Result<Part> {
        self.start = self.at;
        self.content.clear();
        let mut head = [0; HEAD_BYTES];
        self.fill(&mut head[..4], "a block or the trailer")?;
        if word(&head, 0) == Kind::Trailer as u32 {
            return self.trailer(&head[..4]).map(Part::Trailer);
        }
        self.fill(&mut head[4..], "the rest of a block's head")?;
        let kind = self.kind(&head)?;
        self.payload(&head, kind)?;
        Ok(Part::Block(kind))
    }

    fn trailer(&mut self, kind: &[u8]) -> Result<Trailer> {
        let mut bytes = [0; Trailer::BYTES];
        bytes[..4].copy_from_slice(kind);
        self.fill(&mut bytes[4..], "the rest of the trailer")?;
        Trailer::read(&bytes).map_err(|reason| self.error(reason))
    }

    /// Checks a block's head.
    fn kind(&self, head: &[u8; HEAD_BYTES]) -> Result<Kind> {
        let (sum, expected) = (crc32fast::hash(&head[..HEAD_BYTES - 4]), word(head, 24));
        if sum != expected {
            return Err(self.error(format!(
                "the block's head is damaged: found the checksum {sum:08x}, expected {expected:08x}"
            )));
        }
        let (begins, content, payload) = (long(head, 4), word(head, 12), word(head, 16));
        if begins != self.start {
            let message = format!("found the block of byte {begins}, expected that of this place");
            return Err(self.error(message));
        }
        let (kind, most) = match word(head, 0) {
            1 => (Kind::Commands, CONTENT_BYTES_MAX),
            2 => (Kind::Index, BLOCK_BYTES),
            other => {
                let message = format!("found a block of kind {other}, expected 1 or 2");
                return Err(self.error(message));
            }
        };
        if content == 0 || content as usize > most {
            let message = format!("found a content of {content} bytes, expected 1 to {most}");
            return Err(self.error(message));
        }
        let most = zstd_safe::compress_bound(content as usize);
        if payload as usize > most {
            return Err(self.error(format!(
                "found a payload of {payload} bytes, expected at most {most} for a content of \
                 {content}"
            )));
        }
        Ok(kind)
    }

    /// Reads and unpacks the payload of a block whose head has been checked.
    fn payload(&mut self, head: &[u8; HEAD_BYTES], kind: Kind) -> Result<()> {
        let (content, payload, expected) = (word(head, 12), word(head, 16), word(head, 20));
        self.payload.clear();
        // Grows as bytes come, so that a file that breaks off costs no more than it has.
        let input = self.input.by_ref().take(payload.into());
        let read = { input }.read_to_end(&mut self.payload);
        let read = read.map_err(|e| Error::system(&self.file, e))?;
        self.at += read as u64;
        if read < payload as usize {
            return Err(self.truncated("the rest of a block's payload"));
        }
        let sum = crc32fast::hash(&self.payload);
        if sum != expected {
            return Err(self.error(format!(
                "the block is damaged: found the checksum {sum:08x} over its payload, expected \
                 {expected:08x}"
            )));
        }
        self.hash.update(head);
        self.hash.update(&self.payload);
        self.unpack(content as usize, kind)
    }

    fn unpack(&mut self, content: usize, kind: Kind) -> Result<()> {
        if kind == Kind::Index {
            // Few and short: no room is kept for them.
            self.content.shrink_to(BLOCK_BYTES);
        }
        // Asked before there is any room for it; what zstd then makes is held against it again.
        match zstd_safe::get_frame_content_size(&self.payload) {
            Ok(Some(size)) if size == content as u64 => {}
            found => {
                let found = found.ok().flatten().map_or("none".into(), |size| size.to_string());
                return Err(self.error(format!(
                    "found a payload that states the size {found}, expected {content} as the block \
                     does"
                )));
            }
        }
        self.content.reserve_exact(content);
        let made = self.decompressor.decompress_to_buffer(&self.payload, &mut self.content);
        match made {
            Ok(made) if made == content => Ok(()),
            Ok(made) => {
                Err(self.error(format!("found {made} bytes of content, expected {content}")))
            }
            Err(reason) => Err(self.error(format!(
                "found a payload that zstd refuses, expected a frame of it: {reason}"
            ))),
        }
    }

    /// Makes sure that nothing follows.
    pub(super) fn finish(&mut self) -> Result<()> {
        let mut more = [0];
        loop {
            match self.input.read(&mut more) {
                Ok(0) => return Ok(()),
                Ok(_) => {
                    let message = "found more bytes after the trailer, expected none";
                    return Err(self.error_at(self.at, message));
                }
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(Error::system(&self.file, e)),
            }
        }
    }

    fn fill(&mut self, bytes: &mut [u8], what: &str) -> Result<()> {
        let mut filled = 0;
        while filled < bytes.len() {
            match self.input.read(&mut bytes[filled..]) {
                Ok(0) => {
                    self.at += filled as u64;
                    return Err(self.truncated(what));
                }
                Ok(n) => filled += n,
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                Err(e) => return Err(Error::system(&self.file, e)),
            }
        }
        self.at += filled as u64;
        Ok(())
    }

    fn truncated(&self, what: &str) -> Error {
        let message = format!("the trace is truncated: found the end of the file, expected {what}");
        self.error_at(self.at, message)
    }
}

impl<R: Read + Seek> Blocks<R> {
    /// Reads the trailer, wherever the file ends.
    pub(super) fn last(&mut self) -> Result<Trailer> {
        let end = self.input.seek(SeekFrom::End(0)).map_err(|e| Error::system(&self.file, e))?;
        let Some(at) = end.checked_sub(Trailer::BYTES as u64) else {
            self.at = end;
            return Err(self.truncated("a trailer"));
        };
        self.seek(at)?;
        self.start = at;
        let mut kind = [0; 4];
        self.fill(&mut kind, "the trailer")?;
        if u32::from_le_bytes(kind) != Kind::Trailer as u32 {
            let message = "found no trailer here, expected one as the file's last 56 bytes: the \
                           trace is truncated or damaged";
            return Err(self.error(message));
        }
        self.trailer(&kind)
    }

    /// Goes to a byte.
    pub(super) fn seek(&mut self, byte: u64) -> Result<()> {
        self.input.seek(SeekFrom::Start(byte)).map_err(|e| Error::system(&self.file, e))?;
        self.at = byte;
        Ok(())
    }
}

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn long(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}
