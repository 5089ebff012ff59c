//! Lines: bytes in, one line at a time out, hashed on the way. One buffer serves all lines, and a
//! line that is too long is refused while it is being read, before the rest of it is.

use sha2::{Digest, Sha256};
use std::io::{self, BufRead};

/// The longest line, in bytes, its line feed aside.
pub(crate) const LINE_BYTES_MAX: usize = 64 << 20;

/// What came of reading a line.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Line {
    /// There is one, in [`Lines::bytes`].
    Read,
    /// It has more than [`LINE_BYTES_MAX`] bytes.
    TooLong,
    /// The input has ended.
    End,
}

/// The lines of an input.
pub(crate) struct Lines<R> {
    input: R,
    buffer: Vec<u8>,
    number: u64,
    hash: Sha256,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(input: R) -> Self {
        Self { input, buffer: Vec::new(), number: 0, hash: Sha256::new() }
    }

    /// Reads the next line.
    pub(crate) fn advance(&mut self) -> io::Result<Line> {
        self.buffer.clear();
        loop {
            let available = match self.input.fill_buf() {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => continue,
                available => available?,
            };
            let started = !self.buffer.is_empty();
            if available.is_empty() && !started {
                return Ok(Line::End);
            }
            let feed = memchr::memchr(b'\n', available);
            let taken = feed.unwrap_or(available.len());
            let ends = feed.is_some() || available.is_empty();
            if self.buffer.len() + taken > LINE_BYTES_MAX {
                self.number += 1;
                return Ok(Line::TooLong);
            }
            self.buffer.extend_from_slice(&available[..taken]);
            let consumed = taken + usize::from(feed.is_some());
            self.hash.update(&available[..consumed]);
            self.input.consume(consumed);
            if ends {
                self.number += 1;
                if self.buffer.last() == Some(&b'\r') {
                    self.buffer.pop();
                }
                return Ok(Line::Read);
            }
        }
    }

    /// The line that was read last, without its line feed or carriage return.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.buffer
    }

    /// Its number, from 1; 0 before the first.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// The SHA-256 of all bytes read so far, in hexadecimal.
    pub(crate) fn hash(&self) -> String {
        hex::encode(self.hash.clone().finalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn lines_end_with_a_feed_or_the_input() {
        let mut lines = Lines::new(&b"a\r\n\nlast"[..]);
        let mut seen = Vec::new();
        while lines.advance().unwrap() == Line::Read {
            seen.push((lines.number(), lines.bytes().to_vec()));
        }
        assert_eq!(seen, [(1, b"a".to_vec()), (2, vec![]), (3, b"last".to_vec())]);
        assert_eq!(lines.hash(), hex::encode(Sha256::digest(b"a\r\n\nlast")));
    }

    #[test]
    fn an_endless_line_is_refused() {
        let mut lines = Lines::new(io::BufReader::new(io::repeat(b'x')));
        assert_eq!(lines.advance().unwrap(), Line::TooLong);
        assert!(lines.buffer.len() <= LINE_BYTES_MAX);
        let longest = io::repeat(b'x').take(LINE_BYTES_MAX as u64);
        assert_eq!(Lines::new(io::BufReader::new(longest)).advance().unwrap(), Line::Read);
    }
}
