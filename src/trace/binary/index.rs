//! Index: commands and their places in, records out that say for each frame where it begins and
//! what became live since the frame before; and the trailer, by which the index is found.
//!
//! The records are as many as frames and definitions that outlive the frame where they stand, not
//! as many as commands: the points of a mesh that are replaced a hundred times in a frame are one.

use super::{Kind, Place};
use crate::trace::command::Command;
use crate::trace::definition::Definition;
use std::collections::BTreeMap;

/// A record of the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Record {
    /// From the next frame on, what this name stands for is defined there.
    Definition(Definition, Place),
    /// The next frame begins there.
    Frame(Place),
}

/// Makes the records of the commands that go by.
#[derive(Debug, Default)]
pub(super) struct Indexer {
    changed: BTreeMap<Definition, Place>,
    frames: u64,
}

impl Indexer {
    /// Takes in a command; hands the records that it brings about to `record`, as bytes.
    pub(super) fn note(&mut self, command: &Command, place: Place, mut record: impl FnMut(&[u8])) {
        if let Some(name) = Definition::of(command) {
            self.changed.insert(name, place);
        }
        if matches!(command, Command::Frame(_)) {
            self.frames += 1;
            let changed = std::mem::take(&mut self.changed);
            let records = changed.into_iter().map(|(name, place)| Record::Definition(name, place));
            for one in records.chain([Record::Frame(place)]) {
                let mut buffer = [0; RECORD_BYTES_MAX];
                let bytes = postcard::to_slice(&one, &mut buffer);
                record(bytes.expect("a record is no longer than its fields"));
            }
        }
    }

    /// Frames so far.
    pub(super) fn frames(&self) -> u64 {
        self.frames
    }
}

/// Two tags, an id and an offset of at most 5 bytes, a block of at most 10.
const RECORD_BYTES_MAX: usize = 24;

/// The last bytes of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Trailer {
    /// SHA-256 of all bytes before it.
    pub hash: [u8; 32],
    /// Where the index begins; the trailer itself where there are no frames.
    pub index: u64,
    /// How many frames there are.
    pub frames: u64,
}

impl Trailer {
    pub(super) const BYTES: usize = 56;

    pub(super) fn bytes(&self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        bytes[..4].copy_from_slice(&(Kind::Trailer as u32).to_le_bytes());
        bytes[4..36].copy_from_slice(&self.hash);
        bytes[36..44].copy_from_slice(&self.index.to_le_bytes());
        bytes[44..52].copy_from_slice(&self.frames.to_le_bytes());
        let sum = crc32fast::hash(&bytes[..52]);
        bytes[52..].copy_from_slice(&sum.to_le_bytes());
        bytes
    }

    /// The trailer of these bytes, whose kind has been seen.
    pub(super) fn read(bytes: &[u8; Self::BYTES]) -> Result<Self, String> {
        let (body, sum) = bytes.split_at(52);
        let (found, expected) = (crc32fast::hash(body), sum.try_into().map(u32::from_le_bytes));
        let expected = expected.expect("four bytes");
        if found != expected {
            return Err(format!(
                "the trailer is damaged: found the checksum {found:08x}, expected {expected:08x}"
            ));
        }
        let long =
            |at: usize| u64::from_le_bytes(body[at..at + 8].try_into().expect("eight bytes of 52"));
        let hash = body[4..36].try_into().expect("32 bytes of 52");
        Ok(Self { hash, index: long(36), frames: long(44) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_record_fits_its_buffer() {
        let place = Place { block: u64::MAX, offset: u32::MAX };
        for name in [Definition::Points(u32::MAX), Definition::Attributes(u32::MAX)] {
            let bytes = postcard::to_stdvec(&Record::Definition(name, place)).unwrap();
            assert!(bytes.len() <= RECORD_BYTES_MAX, "{}", bytes.len());
        }
    }

    #[test]
    fn a_trailer_reads_back() {
        let trailer = Trailer { hash: [7; 32], index: 1 << 40, frames: 3 };
        assert_eq!(Trailer::read(&trailer.bytes()), Ok(trailer));
    }
}
