//! Inside: the segments of a ring's sides in, the numbers of all triangles inside it out.
//!
//! What lies inside a ring of the inner partition depends on its sides and on nothing else: no
//! edge's factor, no place. So the strips of small rings, which are most of the work where factors
//! are small, are made once for all patterns, with numbers from 0, and a pattern adds the number of
//! its ring's first point. It is a matter of speed alone, and a table of the program's, not of the
//! hardware's; [`Stitch`] makes the same strip by strip.

use super::stitch::{Ring, SLACK, Stitch};
use std::sync::LazyLock;

/// Segments of the greatest side in the table: of quads 73 KB, of tris 41 KB for each winding.
const QUAD_MOST: usize = 12;
const TRI_MOST: usize = 24;

/// Numbers that are copied at once: so many that small patterns have one or two blocks, and the
/// branch at their end is seldom missed.
pub(super) const BLOCK: usize = 64;

/// The triangles inside small rings.
pub(super) struct Insides {
    most: usize,
    numbers: Vec<u16>,
    /// Where those of a ring begin, by the segments along V and along U; of tris by those of V
    /// alone. The next one's are where they end.
    starts: Vec<usize>,
}

impl Insides {
    /// The numbers inside `ring`, counted from its first point, and how many there are; after them
    /// stand more, to a whole block. `None` where the ring is greater than the table's.
    #[inline(always)]
    pub(super) fn find<const SIDES: usize>(&self, ring: &Ring<SIDES>) -> Option<(&[u16], usize)> {
        let [v, u] = [ring.segments[0], ring.segments[1]];
        if u.max(v) > self.most {
            return None;
        }
        let place = if SIDES == 3 { v } else { v * (self.most + 1) + u };
        let [start, end] = [self.starts[place], self.starts[place + 1]];
        Some((&self.numbers[start..], end - start))
    }

    fn of<const SIDES: usize, const CLOCKWISE: bool>(
        most: usize,
        rings: impl Iterator<Item = [usize; SIDES]>,
    ) -> Self {
        let mut buffer = vec![0; 3 * 2 * most * most + SLACK];
        let (mut numbers, mut starts) = (Vec::new(), vec![0]);
        for segments in rings {
            let mut stitch = Stitch::<CLOCKWISE> { out: &mut buffer, at: 0 };
            stitch.inside_by_strips(Ring { first: 0, segments });
            let count = stitch.at;
            numbers.extend_from_slice(&buffer[..count]);
            starts.push(numbers.len());
        }
        numbers.resize(numbers.len() + BLOCK, 0);
        Self { most, numbers, starts }
    }

    fn quads<const CLOCKWISE: bool>() -> Self {
        let rings = (0..=QUAD_MOST).flat_map(|v| (0..=QUAD_MOST).map(move |u| [v, u, v, u]));
        Self::of::<4, CLOCKWISE>(QUAD_MOST, rings)
    }

    fn tris<const CLOCKWISE: bool>() -> Self {
        Self::of::<3, CLOCKWISE>(TRI_MOST, (0..=TRI_MOST).map(|segments| [segments; 3]))
    }
}

/// By winding: counter-clockwise, clockwise.
pub(super) static QUADS: [LazyLock<Insides>; 2] =
    [LazyLock::new(Insides::quads::<false>), LazyLock::new(Insides::quads::<true>)];
pub(super) static TRIS: [LazyLock<Insides>; 2] =
    [LazyLock::new(Insides::tris::<false>), LazyLock::new(Insides::tris::<true>)];
