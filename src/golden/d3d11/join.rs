//! Join: the counts of a pattern in, its triangles as a set out.
//!
//! Between two rows every segment of either is the base of one triangle; the third corner is where
//! the other row has got to. So the order of the segments is all, and that is a sort: in a
//! transition by the order in which the points appear that end them, in the strips further in by
//! their middles.

use super::place_in_order;

/// Segments of a row with their keys; ascending from one corner to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    /// From 0 at the first corner to 2 at the last, 1 being the middle.
    key: f64,
    /// Which of two comes first at the same key.
    tie: i32,
    inner: bool,
}

/// The triangles, each from its least number, sorted. `counts`: the points of each side of each
/// ring, without its last; `inner`: points of the inner partitions.
pub(super) fn triangles(counts: &[Vec<usize>], inner: &[usize], least: bool) -> Vec<[usize; 3]> {
    let mut made = Vec::new();
    if least {
        made = match counts[0].len() {
            3 => vec![[0, 2, 1]],
            _ => vec![[0, 3, 1], [1, 3, 2]],
        };
    }
    let sides = counts[0].len();
    let mut first = 0;
    let rows: Vec<Vec<Vec<usize>>> = counts
        .iter()
        .map(|ring| {
            let begin = first;
            first += ring.iter().sum::<usize>();
            rows(ring, begin, sides, inner[0] >= inner[inner.len() - 1])
        })
        .collect();
    for (ring, pair) in rows.windows(2).enumerate() {
        for (outer, within) in pair[0].iter().zip(&pair[1]) {
            let segments = [outer.len() - 1, within.len() - 1];
            let order = if ring == 0 { transition(segments) } else { strip(segments) };
            made.extend(walk(order, outer, within));
        }
    }
    let last = &rows[rows.len() - 1];
    if !least && counts[counts.len() - 1].len() == sides {
        match sides {
            3 => made.push([last[0][0], last[2][0], last[1][0]]),
            _ => made.extend(centre(last, inner[0] > inner[1])),
        }
    }
    for triangle in &mut made {
        let at = (0..3).min_by_key(|&k| triangle[k]).expect("three corners");
        triangle.rotate_left(at);
    }
    made.sort_unstable();
    made
}

/// The numbers along every side of a ring, both ends included. A line is passed twice, along
/// v = 0 and v = 1 where it is `wide`, and a point is every side.
fn rows(counts: &[usize], begin: usize, sides: usize, wide: bool) -> Vec<Vec<usize>> {
    let all: usize = counts.iter().sum();
    if counts.len() == sides {
        let mut from = 0;
        let side = |&count: &usize| {
            let row = (from..=from + count).map(|k| begin + k % all).collect();
            from += count;
            row
        };
        return counts.iter().map(side).collect();
    }
    let there: Vec<usize> = (begin..begin + all).collect();
    let back: Vec<usize> = there.iter().rev().copied().collect();
    let [first, last] = [vec![begin], vec![begin + all - 1]];
    if sides == 3 {
        vec![first; 3] // the point in the middle
    } else if wide {
        vec![first, there, last, back]
    } else {
        vec![there, last, back, first]
    }
}

/// Segments in the order in which the points that end them appear. A side's second half is its
/// first one mirrored.
fn transition([outer, inner]: [usize; 2]) -> Vec<Step> {
    let mut steps = Vec::new();
    let mut add = |inner: bool, numbers: std::ops::Range<usize>| {
        for number in numbers {
            let key = place_in_order(number);
            let tie = if inner { -1 } else { 1 };
            steps.push(Step { key, tie, inner });
            steps.push(Step { key: 2.0 - key, tie: -tie, inner });
        }
    };
    // The inner row lacks the segment at either corner.
    add(true, 1..inner / 2 + 1);
    add(false, 0..outer / 2);
    let middle = |inner: bool| Step { key: 1.0, tie: if inner { -1 } else { 1 }, inner };
    steps.extend((inner % 2 == 1).then(|| middle(true)));
    steps.extend((outer % 2 == 1).then(|| middle(false)));
    steps
}

/// Segments by their middles: of two that face each other, the one that is nearer to the middle of
/// the side comes later.
fn strip([outer, inner]: [usize; 2]) -> Vec<Step> {
    assert_eq!(outer, inner + 2, "a ring has two segments less a side");
    let middle = outer as f64 / 2.0;
    let step = |inner: bool, at: f64| {
        let near = if at <= middle { -1 } else { 1 };
        Step { key: at / middle, tie: if inner { near } else { -near }, inner }
    };
    let of_outer = (0..outer).map(|k| step(false, k as f64 + 0.5));
    of_outer.chain((0..inner).map(|k| step(true, k as f64 + 1.5))).collect()
}

/// The triangles on the segments, in this order.
fn walk(mut steps: Vec<Step>, outer: &[usize], inner: &[usize]) -> Vec<[usize; 3]> {
    steps.sort_by(|a, b| a.key.total_cmp(&b.key).then(a.tie.cmp(&b.tie)));
    let (mut o, mut i) = (0, 0);
    let mut triangles = Vec::new();
    for step in steps {
        if step.inner {
            triangles.push([inner[i], inner[i + 1], outer[o]]);
            i += 1;
        } else {
            triangles.push([outer[o], inner[i], outer[o + 1]]);
            o += 1;
        }
    }
    assert_eq!((o + 1, i + 1), (outer.len(), inner.len()), "every segment has its triangle");
    triangles
}

/// A strip of cells, for an odd axis: all diagonals fall, from the upper left, in a wide one; in a
/// tall one from the upper right, but for the middle cell of an odd number.
fn centre(rows: &[Vec<usize>], wide: bool) -> Vec<[usize; 3]> {
    let [left, low, right, high] = [0, 1, 2, 3].map(|k| rows[k].clone());
    let mirrored = |row: Vec<usize>| row.into_iter().rev().collect::<Vec<_>>();
    // Two rows from one end to the other, the second on the left of the way.
    let (a, b) = if wide { (low, mirrored(high)) } else { (left, mirrored(right)) };
    let cells = a.len() - 1;
    (0..cells)
        .flat_map(|k| {
            let middle = !wide && cells % 2 == 1 && k == cells / 2;
            if middle {
                [[a[k], b[k], b[k + 1]], [a[k], b[k + 1], a[k + 1]]]
            } else {
                [[a[k], b[k], a[k + 1]], [b[k], b[k + 1], a[k + 1]]]
            }
        })
        .collect()
}
