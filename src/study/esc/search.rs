//! Search: a count that falls with a threshold in, the threshold whose count is nearest to a target
//! out.

use crate::error::Result;

/// Halvings of the interval, on a logarithmic scale: twenty octaves come down to 1e-6 of one.
const STEPS: u32 = 24;

/// The threshold between two, both above 0, at which `count` is nearest to `target`, and that
/// count. `count` must not rise with its argument; where it steps over the target, the nearer side.
pub(super) fn nearest(
    target: u64,
    [low, high]: [f64; 2],
    count: &mut dyn FnMut(f64) -> Result<u64>,
) -> Result<(f64, u64)> {
    let (mut low, mut high) = (low.log2(), high.log2());
    let mut best: Option<(f64, u64)> = None;
    let mut look = |at: f64, best: &mut Option<(f64, u64)>| -> Result<u64> {
        let threshold = at.exp2();
        let counted = count(threshold)?;
        if best.is_none_or(|(_, b)| counted.abs_diff(target) < b.abs_diff(target)) {
            *best = Some((threshold, counted));
        }
        Ok(counted)
    };
    let (most, least) = (look(low, &mut best)?, look(high, &mut best)?);
    let within = least < target && target < most;
    for _ in 0..if within { STEPS } else { 0 } {
        let middle = (low + high) / 2.0;
        match look(middle, &mut best)? {
            counted if counted == target => break,
            counted if counted > target => low = middle,
            _ => high = middle,
        }
    }
    Ok(best.expect("both ends were looked at"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thresholds_of_counts_are_found() {
        let mut falling = |x: f64| Ok((1000.0 / x) as u64);
        let (x, n) = nearest(250, [0.5, 64.0], &mut falling).unwrap();
        assert_eq!(n, 250);
        assert!((3.98..=4.0).contains(&x), "{x}");
        // Beyond either end, that end.
        assert_eq!(nearest(5000, [0.5, 64.0], &mut falling).unwrap().1, 2000);
        assert_eq!(nearest(1, [0.5, 64.0], &mut falling).unwrap().1, 15);
        // 10 down to 4 at once: 8 is nearer to 10, 6 to 4.
        let mut step = |x: f64| Ok(if x < 3.0 { 10 } else { 4 });
        assert_eq!(nearest(8, [1.0, 8.0], &mut step).unwrap().1, 10);
        assert_eq!(nearest(6, [1.0, 8.0], &mut step).unwrap().1, 4);
    }
}
