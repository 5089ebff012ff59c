//! Every factor there is, 1 to 64 in steps of 2^-16: where the points of an edge lie.
//!
//! Rounded reciprocals make a few lists that are not monotone: just above a factor at which a point
//! splits off, the two partitions' roundings are further apart than the new segment is long. The
//! hardware does so, so it must stay; where it happens is listed here, and nowhere else may it.

use crate::draw::{ONE, pattern};
use rtl_model::d3d11::{Domain, Factors, Output, Partitioning};

/// A run of neighbouring factors (16.16) whose lists are not monotone, and by how much they are
/// not at most, in U1.16.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    first: u32,
    last: u32,
    most: u32,
}

const fn run(first: u32, last: u32, most: u32) -> Run {
    Run { first, last, most }
}

/// All of even partitioning: just above 6, and just above 30.
const EVEN: &[Run] = &[run(6 * ONE + 1, 6 * ONE + 6, 1), run(30 * ONE + 1, 30 * ONE + 414, 7)];
/// All of odd partitioning: none.
const ODD: &[Run] = &[];

/// A factor of 16.16 as f32, exact: 23 bits.
fn bits(fx16: u32) -> u32 {
    (fx16 as f32 / ONE as f32).to_bits()
}

/// The line of a factor: an isoline pattern of one line is an edge by itself.
fn edge(partitioning: Partitioning, fx16: u32) -> Vec<u32> {
    let factors = Factors::process(Domain::Isoline, partitioning, &[1f32.to_bits(), bits(fx16)])
        .expect("no factor culls");
    pattern(&factors, Output::Point).0.iter().map(|[u, _]| *u).collect()
}

/// Checks every factor; the runs that are not monotone.
fn sweep(partitioning: Partitioning, factors: std::ops::RangeInclusive<u32>) -> (Vec<Run>, u64) {
    let (mut runs, mut points): (Vec<Run>, u64) = (Vec::new(), 0);
    for fx16 in factors {
        let list = edge(partitioning, fx16);
        assert_eq!((list[0], list[list.len() - 1]), (0, ONE), "{partitioning:?} {fx16}");
        let backwards = list.windows(2).map(|pair| pair[0].saturating_sub(pair[1]));
        let back = backwards.max().expect("two points");
        points += list.len() as u64;
        match runs.last_mut() {
            _ if back == 0 => {}
            Some(run) if run.last + 1 == fx16 => {
                *run = Run { last: fx16, most: run.most.max(back), ..*run };
            }
            _ => runs.push(run(fx16, fx16, back)),
        }
    }
    (runs, points)
}

#[test]
fn every_factor_is_monotone_but_for_the_known_inversions() {
    for (partitioning, least, most, known) in
        [(Partitioning::Even, 2, 64, EVEN), (Partitioning::Odd, 1, 63, ODD)]
    {
        let (runs, points) = sweep(partitioning, least * ONE..=most * ONE);
        let inverted: u32 = runs.iter().map(|run| run.last - run.first + 1).sum();
        let factors = (most - least) * ONE + 1;
        println!(
            "{partitioning:?}: compared {factors} factors, {points} points; {inverted} factors \
             are not monotone: {runs:?}"
        );
        assert_eq!(runs, known, "{partitioning:?}");
        assert!(points > 120_000_000, "the mean factor has more than 30 points");
    }
}
