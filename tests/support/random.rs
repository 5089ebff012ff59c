//! Random inputs: a seeded generator written out in full, so that the same samples are drawn for
//! good, on every machine and with every version of every library; and patches of the kinds that
//! break tessellators.

use rtl_model::patch::{Patch, Point};

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// An integer of `least..=most`.
    pub(crate) fn integer(&mut self, least: u32, most: u32) -> u32 {
        least + (self.bits() >> 32) as u32 % (most - least + 1)
    }

    /// A real of `least..most`.
    pub(crate) fn real(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / 2f64.powi(53)
    }

    /// A single of `least..most`.
    pub(crate) fn single(&mut self, least: f32, most: f32) -> f32 {
        self.real(least.into(), most.into()) as f32
    }

    /// A real of `least..most`, each octave as likely as the next.
    pub(crate) fn octaves(&mut self, least: f64, most: f64) -> f64 {
        self.real(least.log2(), most.log2()).exp2()
    }

    pub(crate) fn of<T: Copy, const N: usize>(&mut self, all: [T; N]) -> T {
        all[self.integer(0, N as u32 - 1) as usize]
    }
}

/// Kinds of patches.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Kind {
    /// Points anywhere in the range.
    Wild,
    /// A sheet before the camera, turned either way, with noise; w varies.
    Sheet,
    /// The same with one row collapsed to a point.
    CollapsedEdge,
    /// The same with two rows equal.
    EqualRows,
    /// All points in one plane.
    Planar,
    /// A plane that holds the viewer: det[S, Su, Sv] = 0 everywhere.
    EdgeOn,
    /// Points of a few ulps.
    Tiny,
}

impl Kind {
    pub(crate) const ALL: [Self; 7] = [
        Self::Wild,
        Self::Sheet,
        Self::CollapsedEdge,
        Self::EqualRows,
        Self::Planar,
        Self::EdgeOn,
        Self::Tiny,
    ];
}

/// Coordinates in -1..1 as raw integers of up to `max`.
pub(crate) fn patch(random: &mut Random, kind: Kind, max: i64) -> Patch {
    let mut points = sheet(random);
    match kind {
        Kind::Wild => points = points.map(|p| p.map(|_| random.real(-1.0, 1.0))),
        Kind::Sheet => {}
        Kind::CollapsedEdge => {
            let row = random.of([0, 12]);
            points.copy_within(row..row + 1, row + 1);
            points.copy_within(row..row + 2, row + 2);
        }
        Kind::EqualRows => points.copy_within(4..8, 8),
        Kind::Planar => points = points.map(|[x, y, _, _]| [x, y, 0.3, 0.9]),
        Kind::EdgeOn => points = points.map(|p| p.map(|_| random.real(-0.3, 0.3))),
        Kind::Tiny => points = points.map(|p| p.map(|c| 8.0 * c / max as f64)),
    }
    let raw = |c: f64| ((c * max as f64).round() as i64).clamp(-max, max);
    let mut points: [Point; 16] = points.map(|p| p.map(raw));
    if matches!(kind, Kind::EdgeOn) {
        // In raw integers, so that the determinant is 0 exactly and no estimate of it is.
        let k = random.of([-2, -1, 1, 2]);
        points = points.map(|[x, y, z, _]| [x, y, z, x + k * y]);
    }
    Patch { id: 0, points, saturated: false, cull: true, reversed: random.bits() & 1 == 0 }
}

fn sheet(random: &mut Random) -> [[f64; 4]; 16] {
    let mirror = random.of([-1.0, 1.0]);
    let (size, noise) = (random.octaves(0.05, 0.6), random.octaves(0.001, 0.3));
    let [cx, cy] = [random.real(-0.6, 0.6), random.real(-0.6, 0.6)];
    let [slope_u, slope_v] = [random.real(-0.3, 0.3), random.real(-0.3, 0.3)];
    std::array::from_fn(|k| {
        let (u, v) = ((k % 4) as f64 / 1.5 - 1.0, (k / 4) as f64 / 1.5 - 1.0);
        let mut jitter = || random.real(-noise, noise) * size;
        [
            cx + size * mirror * u + jitter(),
            cy + size * v + jitter(),
            0.3 + jitter(),
            0.6 + slope_u * u * size + slope_v * v * size + jitter(),
        ]
    })
}
