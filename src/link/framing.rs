//! How a command's bytes are cut for the link. In goes a payload, whole or piece by piece; out come
//! the bytes that cross, in either direction.
//!
//! ```text
//!   push   downstream  header payload, header payload, ...        packets of link.payload
//!   pull   upstream    request, request, ...                      one each link.request bytes
//!          downstream  header data, header data, ...              completions of link.completion
//! ```
//!
//! A command starts a packet, a request and a completion of its own; so does a request the first of
//! its completions. Everything is counted where it starts: a piece that ends within a packet has
//! paid the packet's header, and the next piece goes on in it.

use crate::config::{Link, TransferMode};

/// Bytes on the link.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Framed {
    /// The payload.
    pub payload: u64,
    /// Framing of packets or completions, downstream.
    pub overhead: u64,
    /// Read requests, a number.
    pub requests: u64,
    /// Their bytes, upstream.
    pub request_bytes: u64,
}

impl Framed {
    /// A whole command of `payload` bytes; nothing at all if it has none.
    #[must_use]
    pub fn of(payload: u64, link: &Link) -> Self {
        let (packets, header, requests) = match link.transfer {
            TransferMode::Push => (packets(payload, link.payload), link.header, 0),
            TransferMode::Pull => {
                let request = u64::from(link.request);
                let full = payload / request * packets(request, link.completion);
                let rest = packets(payload % request, link.completion);
                (full + rest, link.completion_header, payload.div_ceil(request))
            }
        };
        Self {
            payload,
            overhead: packets * u64::from(header),
            requests,
            request_bytes: requests * u64::from(link.request_header),
        }
    }

    /// Bytes towards the device.
    #[must_use]
    pub fn downstream(&self) -> u64 {
        self.payload + self.overhead
    }

    /// Bytes in both directions.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.downstream() + self.request_bytes
    }
}

/// Packets of at most `most` bytes; a link with `most` 0 has none.
fn packets(bytes: u64, most: u32) -> u64 {
    match most {
        0 => 0,
        most => bytes.div_ceil(most.into()),
    }
}

/// One command that is sent in pieces, such as a draw whose vertices come patch by patch.
#[derive(Clone, Copy, Debug)]
pub struct Pieces {
    link: Link,
    /// Of the whole command so far.
    sent: Framed,
}

impl Pieces {
    /// A command of which nothing was sent yet.
    #[must_use]
    pub fn new(link: &Link) -> Self {
        Self { link: *link, sent: Framed::default() }
    }

    /// What the next `payload` bytes of the command bring onto the link: with the framing and the
    /// requests that start in them. Over all pieces these sum to [`Framed::of`] the whole.
    pub fn piece(&mut self, payload: u64) -> Framed {
        let before = self.sent;
        self.sent = Framed::of(before.payload + payload, &self.link);
        Framed {
            payload,
            overhead: self.sent.overhead - before.overhead,
            requests: self.sent.requests - before.requests,
            request_bytes: self.sent.request_bytes - before.request_bytes,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Bus;
    use crate::link::Transfer;
    use proptest::prelude::*;

    fn framed(payload: u64, overhead: u64, requests: u64, request_bytes: u64) -> Framed {
        Framed { payload, overhead, requests, request_bytes }
    }

    #[test]
    fn small_transfers_are_cut_as_by_hand() {
        let push = Link::of(Bus::PCIE4X16, 2000);
        assert_eq!(Framed::of(0, &push), Framed::default());
        assert_eq!(Framed::of(256, &push), framed(256, 24, 0, 0));
        assert_eq!(Framed::of(257, &push), framed(257, 48, 0, 0));
        let pull = Link { transfer: TransferMode::Pull, ..push };
        // 512 + 512 + 276: three requests; 4 + 4 + 3 completions.
        assert_eq!(Framed::of(1300, &pull), framed(1300, 11 * 20, 3, 3 * 24));
        assert_eq!(Framed::of(1300, &pull).total(), 1300 + 220 + 72);
        assert_eq!(Framed::of(0, &pull), Framed::default());
        // 6 x 200 + 100: a request's last completion is short.
        let odd = Link { request: 200, ..pull };
        assert_eq!(Framed::of(1300, &odd), framed(1300, (6 * 2 + 1) * 20, 7, 7 * 24));
        let agp = Link { transfer: TransferMode::Pull, ..Link::of(Bus::AGP4X, 200) };
        assert_eq!(Framed::of(120, &agp), framed(120, 0, 2, 16));
        assert_eq!(Framed::of(120, &Link::of(Bus::AGP4X, 200)), framed(120, 0, 0, 0));
    }

    #[test]
    fn a_piece_pays_for_the_packets_that_start_in_it() {
        let mut pieces = Pieces::new(&Link::of(Bus::PCIE2X16, 850)); // packets of 128
        assert_eq!(pieces.piece(100), framed(100, 24, 0, 0));
        assert_eq!(pieces.piece(28), framed(28, 0, 0, 0));
        assert_eq!(pieces.piece(0), framed(0, 0, 0, 0));
        assert_eq!(pieces.piece(1), framed(1, 24, 0, 0));
        assert_eq!(pieces.piece(256), framed(256, 48, 0, 0));
    }

    fn links() -> impl Strategy<Value = Link> {
        let sizes = (0u32..300, 0u32..40, 1u32..700, 0u32..40, 0u32..300, 0u32..40);
        (sizes, any::<bool>()).prop_map(|(sizes, pull)| Link {
            payload: sizes.0,
            header: if sizes.0 == 0 { 0 } else { sizes.1 },
            request: sizes.2,
            request_header: sizes.3,
            completion: sizes.4,
            completion_header: if sizes.4 == 0 { 0 } else { sizes.5 },
            transfer: if pull { TransferMode::Pull } else { TransferMode::Push },
            ..Link::default()
        })
    }

    /// Byte by byte: whoever is at a boundary starts something.
    fn walked(payload: u64, link: &Link) -> Framed {
        let mut framed = Framed { payload, ..Framed::default() };
        let starts = |at: u64, every: u32| every != 0 && at.is_multiple_of(every.into());
        for at in 0..payload {
            if link.transfer == TransferMode::Push {
                framed.overhead += u64::from(starts(at, link.payload)) * u64::from(link.header);
                continue;
            }
            let within = at % u64::from(link.request);
            framed.requests += u64::from(within == 0);
            framed.request_bytes += u64::from(within == 0) * u64::from(link.request_header);
            let completes = starts(within, link.completion);
            framed.overhead += u64::from(completes) * u64::from(link.completion_header);
        }
        framed
    }

    proptest! {
        #[test]
        fn pieces_sum_to_the_whole(
            link in links(),
            pieces in prop::collection::vec(0u64..900, 0..12),
        ) {
            let payload = pieces.iter().sum();
            let mut command = Pieces::new(&link);
            let mut sum = Framed::default();
            for &bytes in &pieces {
                let piece = command.piece(bytes);
                sum.payload += piece.payload;
                sum.overhead += piece.overhead;
                sum.requests += piece.requests;
                sum.request_bytes += piece.request_bytes;
            }
            prop_assert_eq!(sum, walked(payload, &link));
            prop_assert_eq!(sum, Framed::of(payload, &link));
            let transfer = Transfer { vertices: payload, ..Transfer::default() };
            prop_assert_eq!(sum.total(), transfer.total(&link));
        }
    }
}
