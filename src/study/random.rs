//! Seeded numbers, the same on every machine: a stream for each case, so that cases can be worked
//! on in any order.

use glam::DVec3;

/// SplitMix64 (Steele, Lea, Flood 2014).
pub(super) struct Random(u64);

impl Random {
    /// The stream of case `number` of the study's part `part`.
    pub(super) fn of(part: u32, number: usize) -> Self {
        let mut random = Self((u64::from(part) << 32) ^ number as u64);
        Self(random.bits()) // neighbours must not have overlapping streams
    }

    pub(super) fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A real of `least..most`.
    pub(super) fn real(&mut self, least: f64, most: f64) -> f64 {
        least + (most - least) * (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(super) fn one_of<T: Copy, const N: usize>(&mut self, all: [T; N]) -> T {
        all[(((self.bits() >> 32) * N as u64) >> 32) as usize]
    }

    /// A direction, all alike, of length 1. By rejection: a sine is not the same everywhere.
    pub(super) fn direction(&mut self) -> DVec3 {
        loop {
            let d = DVec3::from([(); 3].map(|()| self.real(-1.0, 1.0)));
            if (0.1..1.0).contains(&d.length()) {
                return d.normalize();
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_differ_and_fill_their_ranges() {
        let first: Vec<u64> = (0..1000).map(|n| Random::of(n as u32 % 2, n / 2).bits()).collect();
        let mut distinct = first.clone();
        distinct.sort_unstable();
        distinct.dedup();
        assert_eq!(distinct.len(), 1000);
        let mut random = Random::of(7, 0);
        let mut counts = [0; 5];
        for _ in 0..5000 {
            counts[random.one_of([0usize, 1, 2, 3, 4])] += 1;
            assert!((-3.0..2.0).contains(&random.real(-3.0, 2.0)));
            assert!((random.direction().length() - 1.0).abs() < 1e-12);
        }
        assert!(counts.iter().all(|n| (850..1150).contains(n)), "{counts:?}");
    }
}
