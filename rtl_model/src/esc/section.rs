//! Section: what one invocation does, where a shader may emit only so much.
//!
//! Concheiro et al. 2014, section 4: the geometry shader of 2014 emits at most 1024 32-bit values,
//! and declares how many before the first patch is seen. So a shader for levels up to `level_max`
//! takes a section of the parametric map: consecutive coarse triangles, as many as fit; or, where
//! not even one fits, consecutive strips. Strip k has at most 2 k + 1 vertices in the paper's list.
//!
//! At a lower level, strip k of R is where the map has strip ceil(k R_max / R): another one for
//! each k and at least as long, so that what was declared suffices.

use super::LEVEL_MAX;
use super::pattern::COARSE_TRIANGLES;

/// How much an invocation may emit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Output {
    /// 32-bit values in all; 1024 in 2014.
    pub values_max: u32,
    /// 32-bit values of a vertex, at least 1.
    pub values_per_vertex: u32,
    /// The greatest level for which the shader is written, 0 to 15.
    pub level_max: u8,
}

impl Output {
    /// Vertices that an invocation may emit.
    #[must_use]
    pub const fn vertices(self) -> u32 {
        self.values_max / self.values_per_vertex
    }

    /// Whether the longest strip fits: if not, no section can be made.
    #[must_use]
    pub const fn fits(self) -> bool {
        strip_vertices(self.level_max as u32 + 1) <= self.vertices()
    }
}

/// Vertices of the list of strip `k`, from 1.
const fn strip_vertices(k: u32) -> u32 {
    2 * k + 1
}

/// The strips of a coarse triangle that a section owns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Part {
    /// Number of the section.
    pub(super) section: u32,
    /// Number of the coarse triangle.
    pub(super) triangle: u8,
    /// The first and the last strip, by the number of the lower row.
    pub(super) strips: [u8; 2],
}

/// The sections of every level.
#[derive(Clone, Debug)]
pub(super) struct Sections {
    /// How many there are, whatever the level.
    pub(super) count: u32,
    /// By level: the parts, in order.
    parts: Vec<Vec<Part>>,
}

impl Sections {
    /// # Panics
    /// Where the longest strip does not fit.
    pub(super) fn new(output: Option<Output>) -> Self {
        let level_max = output.map_or(LEVEL_MAX, |output| output.level_max);
        let declared = declare(output, level_max);
        let count = declared.last().map_or(1, |part| part.section + 1);
        let at = |level: u8| {
            let [own, most] = [level, level_max].map(|level| u16::from(level) + 1);
            let strips = |part: &Part| {
                // k R_max / R, rounded up, within first..=last
                let [first, last] = part.strips.map(u16::from);
                Part {
                    strips: [(first - 1) * own / most + 1, last * own / most].map(|k| k as u8),
                    ..*part
                }
            };
            let parts = declared.iter().map(strips);
            parts.filter(|part| part.strips[0] <= part.strips[1]).collect()
        };
        Self { count, parts: (0..=level_max).map(at).collect() }
    }

    /// The parts of a level.
    ///
    /// # Panics
    /// Where the level is above the declared one.
    pub(super) fn parts(&self, level: u8) -> &[Part] {
        assert!(usize::from(level) < self.parts.len(), "a level above the declared one");
        &self.parts[usize::from(level)]
    }
}

/// The sections at the greatest level.
fn declare(output: Option<Output>, level_max: u8) -> Vec<Part> {
    let segments = level_max + 1;
    let whole = |section: u32, triangle: u8| Part { section, triangle, strips: [1, segments] };
    let triangles = 0..COARSE_TRIANGLES as u8;
    let Some(output) = output else {
        return triangles.map(|triangle| whole(0, triangle)).collect();
    };
    assert!(output.fits(), "the longest strip fits an invocation's output");
    let room = output.vertices();
    let each: u32 = (1..=u32::from(segments)).map(strip_vertices).sum();
    if each <= room {
        let many = room / each;
        return triangles.map(|triangle| whole(u32::from(triangle) / many, triangle)).collect();
    }
    let (mut section, mut left) = (0, room);
    let mut parts: Vec<Part> = Vec::new();
    for (triangle, k) in triangles.flat_map(|t| (1..=segments).map(move |k| (t, k))) {
        let need = strip_vertices(k.into());
        if need > left {
            (section, left) = (section + 1, room);
        }
        left -= need;
        match parts.last_mut() {
            Some(part) if (part.section, part.triangle) == (section, triangle) => {
                part.strips[1] = k;
            }
            _ => parts.push(Part { section, triangle, strips: [k, k] }),
        }
    }
    parts
}
