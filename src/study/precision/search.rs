//! Search: the narrowest formats that serve, without the whole grid.
//!
//! Errors do not fall with every bit: a rounding may happen to be kinder in a narrower format. So
//! nothing is concluded from one point about another but what can be proved:
//!
//! - The cost of a point is a formula and needs no run. In the order of cost, the first point that
//!   serves is the narrowest of the grid: no later one needs to be run.
//! - The corners of a patch are its corner control points in every format, whatever guard bits and
//!   reciprocals there are. What a run of the corners alone (one segment an edge) shows, a patch
//!   lost, a corner without its place or too far from it, is so in every run of the same positions,
//!   screen coordinates and modes: all of them are ruled out by one such run, which is cheap.
//!
//! Both hold whether errors are monotone or not, so the result is that of the exhaustive search.

use super::{Bench, Formats, Row, formats};
use crate::config::Criterion;
use crate::error::Result;
use rayon::prelude::*;

/// Points run together: as many at any number of threads, so that always the same ones are.
const TOGETHER: usize = 8;

/// What a search has run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Found<T> {
    /// What came of the points that were run, in the order of the grid.
    pub rows: Vec<T>,
    /// The place in the grid of the narrowest that serves.
    pub narrowest: Option<usize>,
    /// Runs of the corners alone.
    pub corner_runs: usize,
}

/// Which of the rows is the narrowest that serves: of the least area, then of the fewest bits, then
/// the first.
#[must_use]
pub fn exhaustive(rows: &[Row], max_error: f64) -> Option<usize> {
    let serve = |row: &&Row| row.measured.serves(max_error);
    let all = rows.iter().enumerate().filter(|(_, row)| serve(row));
    all.min_by_key(|(k, row)| (row.cost(), *k)).map(|(k, _)| k)
}

/// The narrowest formats of a grid.
///
/// # Errors
/// Those of the runs.
pub(super) fn narrowest(
    grid: &[Formats],
    bench: &Bench<'_>,
    max_error: f64,
    measure: &(dyn Fn(&Formats) -> Result<Row> + Sync),
) -> Result<Found<Row>> {
    let costs: Vec<_> = grid.iter().map(|formats| cost(formats, bench)).collect();
    // The first point with the same positions, screen coordinates and modes.
    let mut firsts: Vec<(Formats, usize)> = Vec::new();
    let group = |(k, formats): (usize, &Formats)| {
        let alike = Formats { guard: 1, reciprocal: 32, ..*formats };
        let known = firsts.iter().find(|(other, _)| *other == alike).map(|(_, first)| *first);
        known.unwrap_or_else(|| {
            firsts.push((alike, k));
            k
        })
    };
    let groups: Vec<usize> = grid.iter().enumerate().map(group).collect();
    let corners = |k: usize| -> Result<bool> {
        let mut config = grid[k].config(bench.base);
        config.level.criterion = Some(Criterion::Fixed);
        (config.level.level, config.level.pixels) = (Some(1.0), None);
        config.level.min_level = Some(1.0);
        Ok(bench.measure(&config, 0)?.may_serve(max_error))
    };
    let whole = |k: usize| {
        let row = measure(&grid[k])?;
        let serves = row.measured.serves(max_error);
        Ok((row, serves))
    };
    in_order(&costs, &groups, &corners, &whole)
}

fn cost(formats: &Formats, bench: &Bench<'_>) -> (u64, u32) {
    let config = formats.config(bench.base);
    (formats::area(&config), formats::Widths::of(&config).datapath())
}

/// Goes through points in the order of their costs until one serves. `corners` is asked once for
/// each of `groups`, by the point that it is named after, and says whether any of it may serve.
///
/// # Errors
/// Those of the runs.
pub fn in_order<C: Ord + Copy + Sync, T: Send>(
    costs: &[C],
    groups: &[usize],
    corners: &(dyn Fn(usize) -> Result<bool> + Sync),
    whole: &(dyn Fn(usize) -> Result<(T, bool)> + Sync),
) -> Result<Found<T>> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by_key(|&k| (costs[k], k));
    let mut known: Vec<Option<bool>> = vec![None; costs.len()];
    let (mut ran, mut narrowest, mut corner_runs) = (Vec::new(), None, 0);
    let mut waiting = order.into_iter().peekable();
    while narrowest.is_none() && waiting.peek().is_some() {
        let mut together = Vec::new();
        while together.len() < TOGETHER
            && let Some(k) = waiting.next()
        {
            if known[groups[k]].is_none() {
                known[groups[k]] = Some(corners(groups[k])?);
                corner_runs += 1;
            }
            if known[groups[k]] == Some(true) {
                together.push(k);
            }
        }
        let done = together.into_par_iter().map(|k| Ok((k, whole(k)?)));
        for (k, (row, serves)) in done.collect::<Result<Vec<_>>>()? {
            narrowest = narrowest.or(serves.then_some(k));
            ran.push((k, row));
        }
    }
    ran.sort_by_key(|(k, _)| *k);
    let rows = ran.into_iter().map(|(_, row)| row).collect();
    Ok(Found { rows, narrowest, corner_runs })
}

#[cfg(test)]
mod tests {
    use super::super::super::random::Random;
    use super::*;

    /// Random grids whose errors are anything but monotone: what the corners rule out does not
    /// serve, and that is all that is known.
    #[test]
    fn in_the_order_of_cost_the_first_that_serves_is_the_narrowest_of_all() {
        let (mut fewer, mut none) = (0, 0);
        for case in 0..300 {
            let mut random = Random::of(17, case);
            let points = 1 + (random.bits() % 200) as usize;
            let costs: Vec<u64> = (0..points).map(|_| random.bits() % 64).collect();
            let groups: Vec<usize> = (0..points).map(|k| k - k % 5).collect();
            let often = 1 + random.bits() % 60;
            let rule: Vec<bool> = (0..points).map(|_| !random.bits().is_multiple_of(3)).collect();
            let serves: Vec<bool> =
                groups.iter().map(|&g| rule[g] && random.bits().is_multiple_of(often)).collect();
            let want = (0..points).filter(|&k| serves[k]).min_by_key(|&k| (costs[k], k));
            let whole = |k: usize| Ok((k, serves[k]));
            let found = in_order(&costs, &groups, &|k| Ok(rule[k]), &whole).unwrap();
            assert_eq!(found.narrowest, want, "case {case}");
            assert!(found.corner_runs <= points.div_ceil(5));
            assert!(found.rows.is_sorted() && found.rows.iter().all(|&k| rule[groups[k]]));
            fewer += usize::from(found.rows.len() < points);
            none += usize::from(want.is_none());
        }
        assert!(fewer > 200, "{fewer} searches of 300 ran less than the grid");
        assert!((10..250).contains(&none), "{none} grids of 300 have nothing that serves");
    }
}
