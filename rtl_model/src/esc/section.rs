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

#[cfg(test)]
mod tests {
    use super::*;

    /// Vertices that each section can list at `level`; every strip of every coarse triangle is in
    /// one section, in order.
    fn lists(sections: &Sections, level: u8) -> Vec<u32> {
        let mut vertices = vec![0; sections.count as usize];
        let mut strips = Vec::new();
        let mut last = 0;
        for part in sections.parts(level) {
            assert!(part.section >= last, "sections in order");
            last = part.section;
            for k in part.strips[0]..=part.strips[1] {
                vertices[part.section as usize] += strip_vertices(k.into());
                strips.push((part.triangle, k));
            }
        }
        let all = (0..COARSE_TRIANGLES as u8).flat_map(|t| (1..=level + 1).map(move |k| (t, k)));
        assert_eq!(strips, all.collect::<Vec<_>>(), "level {level}");
        vertices
    }

    #[test]
    fn sections_own_every_strip_once_and_list_no_more_than_declared() {
        let mut seen = 0;
        for level_max in 0..=LEVEL_MAX {
            let longest = strip_vertices(u32::from(level_max) + 1);
            for values_per_vertex in [1, 4, 12] {
                for room in longest..longest + 700 {
                    let values_max = room * values_per_vertex + (values_per_vertex - 1);
                    let output = Output { values_max, values_per_vertex, level_max };
                    assert!(output.fits() && output.vertices() == room);
                    let sections = Sections::new(Some(output));
                    for level in 0..=level_max {
                        let vertices = lists(&sections, level);
                        assert!(vertices.iter().all(|&count| count <= room), "{output:?} {level}");
                        seen += 1;
                    }
                    let own = lists(&sections, level_max);
                    assert!(own.iter().all(|&count| count > 0), "an idle one: {output:?}");
                    let less = Output { values_max: longest * values_per_vertex - 1, ..output };
                    assert!(!less.fits());
                }
            }
        }
        println!("compared {seen} layouts");
        assert_eq!(seen, 136 * 3 * 700);
    }

    #[test]
    fn whole_coarse_triangles_where_one_fits() {
        let count = |values_max, values_per_vertex, level_max| {
            Sections::new(Some(Output { values_max, values_per_vertex, level_max })).count
        };
        // 24 vertices a coarse triangle at level 3
        assert_eq!(count(1024, 4, 3), 2);
        assert_eq!(count(1024, 8, 3), 4); // five at a time
        assert_eq!(count(96, 4, 3), 18);
        assert_eq!(count(18 * 96, 4, 3), 1);
        // 23: 3 + 5 + 7, then 9 + 3 + 5, 7 + 9 + 3 and so on
        let sections =
            Sections::new(Some(Output { values_max: 95, values_per_vertex: 4, level_max: 3 }));
        let vertices = lists(&sections, 3);
        assert_eq!(vertices[..4], [15, 17, 19, 21]);
        assert_eq!(vertices.iter().sum::<u32>(), 18 * 24);
        assert_eq!(Sections::new(None).count, 1);
        assert_eq!(lists(&Sections::new(None), 15), [18 * (256 + 32)]);
    }

    #[test]
    #[should_panic(expected = "the longest strip fits")]
    fn a_strip_that_does_not_fit_has_no_section() {
        Sections::new(Some(Output { values_max: 35, values_per_vertex: 4, level_max: 3 }));
    }

    #[test]
    #[should_panic(expected = "a level above the declared one")]
    fn a_level_above_the_declared_one_has_no_parts() {
        Sections::new(Some(Output { values_max: 36, values_per_vertex: 4, level_max: 3 })).parts(4);
    }
}
