//! The binary form of a trace: commands in, blocks of bytes out, and back, to the bit.
//!
//! It says what the text form says (`traces/README.md`), is smaller and faster to read, and every
//! byte of it is under a checksum, so that damage is found and located. All integers are
//! little-endian.
//!
//! ```text
//! file      preamble, block .. block of commands, block .. block of the index, trailer
//! preamble   8 bytes   "tessim", 0, the version 1: compared as they are
//! block     28 bytes   kind u32, byte of the file where it begins u64, size u32 of its content,
//!                      size u32 of its payload, CRC-32 u32 of its payload, CRC-32 u32 of these 24
//!            n bytes   payload: one zstd frame, which holds the content
//! trailer   56 bytes   kind u32, SHA-256 of all bytes before it, byte of the first block of the
//!                      index u64, frames u64, CRC-32 u32 of these 52
//! ```
//!
//! The content of a block of commands (kind 1) is whole commands in postcard, `wire.rs`, the last
//! of all being the end. The first block holds the header alone. A block is closed before it
//! outgrows [`BLOCK_BYTES`]; a command that is longer by itself has a block of its own, up to
//! [`CONTENT_BYTES_MAX`]. The content of a block of the index (kind 2) is whole records,
//! `index.rs`: for each frame where it begins, and before that the definitions that became live
//! since the frame before. So what one frame needs is found by reading the trailer, the index up to
//! it, the blocks of what is live, and its own. Kind 3 is the trailer.
//!
//! A block that says where it begins can be neither moved nor left out. Sizes are checked against
//! their limits before anything is allocated, and zstd is given no more room than the size stated.
//! The same commands always make the same bytes, for a given version of zstd: the level is fixed
//! and nothing else goes in.

mod block;
mod index;
mod wire;

pub mod read;
pub mod seek;
pub mod write;

/// The first bytes of every binary trace: a name, and the version of the format.
pub(crate) const PREAMBLE: [u8; 8] = *b"tessim\0\x01";
/// Content of an ordinary block, in bytes: what a reader must hold at a time.
pub const BLOCK_BYTES: usize = 1 << 20;
/// The most content of a block, in bytes. A number takes two bytes of text or more, and four here,
/// so this is twice a line of text of the longest kind, and a little for the rest of the command.
pub const CONTENT_BYTES_MAX: usize = 2 * super::lines::LINE_BYTES_MAX + (1 << 20);

/// What a block holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Kind {
    Commands = 1,
    Index = 2,
    Trailer = 3,
}

/// Where a command stands.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
pub(crate) struct Place {
    /// The byte of the file where its block begins.
    pub block: u64,
    /// The byte of the block's content where it begins.
    pub offset: u32,
}

/// Whether a file that begins with `head` is meant to be a binary trace. A few bytes of the
/// preamble may be damaged; then the reader says which.
#[must_use]
pub fn is_binary(head: &[u8]) -> bool {
    let head = &head[..head.len().min(PREAMBLE.len())];
    let wrong = head.iter().zip(&PREAMBLE).filter(|(a, b)| a != b).count();
    // Text begins with a brace or white space, so its first byte is wrong and so are most others.
    !head.is_empty() && wrong <= head.len() / 3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_form_is_told_from_the_first_bytes() {
        assert!(is_binary(&PREAMBLE) && is_binary(b"tes") && is_binary(b"tessim\0\x02more"));
        assert!(is_binary(b"dessim\0\x01"), "a damaged bit is no reason to take it for text");
        for text in [&b"{\"tessim\":1}"[..], b" {\"tess", b"", b"1\n3 3\n", b"\xef\xbb\xbf{", b"{"]
        {
            assert!(!is_binary(text), "{text:?}");
        }
    }
}
