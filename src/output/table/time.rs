//! The table's part on time: cycles and their rates, where each block's cycles went, and what binds
//! the run.

use super::{BOLD, DIM, PLAIN, Table, ratio};
use crate::config::Engine;
use crate::report::{Frame, Report};
use rtl_model::counter::standard::{Quantity, Stage, Work, rows};
use rtl_model::counter::{Block, Counter};
use rtl_model::time::{FrameTimes, StageTimes};

/// Below this share of its cycles no block is called busy enough to bind a run.
const BINDS: f64 = 0.5;

/// A share that is worth a word.
const NOTABLE: f64 = 0.01;

/// Elapsed cycles and what follows from them, then a line a block.
pub(super) fn section(table: &mut Table, report: &Report, whole: &Frame) {
    let Some(times) = &whole.times else { return };
    table.section("time");
    table.row("elapsed cycles", times.elapsed, None);
    let triangles = whole.counters.get(Counter::EmitTriangles);
    table.rate("cycles per triangle", ratio(times.elapsed, triangles), "");
    let clock = report.config.clock_mhz;
    let milliseconds = ratio(times.elapsed, 1000 * u64::from(clock));
    table.rate(&format!("milliseconds at {clock} MHz"), milliseconds, "");
    let heads = ["block", "used", "busy", "starved", "blocked", "fifo peak", "waits for"];
    table.line(&format!("  {DIM}{}{PLAIN}", columns(heads)));
    for (k, t) in times.stages.iter().enumerate() {
        table.line(&format!("  {}", block(&report.chain, k, t)));
    }
}

fn columns([block, used, busy, starved, blocked, fifo, waits]: [&str; 7]) -> String {
    let shares = format!("{used:>8} {busy:>8} {starved:>8} {blocked:>8}");
    let line = format!("{block:13} {shares} {fifo:>12}   {waits}");
    line.trim_end().to_owned()
}

fn block(chain: &[Stage], k: usize, t: &StageTimes) -> String {
    let share = |part| ratio(part, t.total).map_or_else(|| "-".to_owned(), percent);
    let shares = [t.used, t.busy, t.starved + t.starved_by_port, t.blocked + t.blocked_by_order];
    let [used, busy, starved, blocked] = shares.map(share);
    let Stage { block, shape } = chain[k];
    let fifo = if k == 0 { "-".to_owned() } else { format!("{} of {}", t.fifo_peak, shape.depth) };
    columns([block.name(), &used, &busy, &starved, &blocked, &fifo, &waits(chain, k, t)])
}

/// What a block waits for, the longest wait first.
fn waits(chain: &[Stage], k: usize, t: &StageTimes) -> String {
    use Quantity::{BlockedByDownstream, BlockedByOrder, StarvedByPort, StarvedByUpstream};
    let culprit =
        |q| matches!(q, StarvedByUpstream | StarvedByPort | BlockedByDownstream | BlockedByOrder);
    let mut culprits: Vec<(u64, String)> = rows(chain, k)
        .filter(|(_, row)| culprit(row.quantity))
        .filter_map(|(name, row)| {
            let cycles = row.quantity.value(&Work::default(), Some(t))?;
            let culprit = name.rsplit('.').next()?.to_owned();
            (ratio(cycles, t.total)? >= NOTABLE).then_some((cycles, culprit))
        })
        .collect();
    culprits.sort_by_key(|(cycles, _)| std::cmp::Reverse(*cycles));
    let names: Vec<String> = culprits.into_iter().map(|(_, name)| name).collect();
    names.join(", ")
}

/// What binds the run, and how its neighbours bear it.
pub(super) fn verdict(table: &mut Table, report: &Report, whole: &Frame) {
    const WHAT: &str = "  what binds the run: ";
    let Some(times) = &whole.times else {
        let none = report.config.engine == Engine::None;
        let why = if none { "no engine, so no cycles" } else { "nothing, for nothing ran" };
        return table.line(&format!("{WHAT}{why}"));
    };
    let Some((k, utilisation)) = busiest(times) else {
        return table.line(&format!("{WHAT}nothing, for nothing ran"));
    };
    let name = report.chain[k].block.name();
    let used = percent(utilisation);
    if utilisation < BINDS {
        table.line(&format!("{WHAT}latency, not the throughput of a block"));
        table.line(&format!(
            "    even {name}, the most used, is used only {used} of the time: the rest"
        ));
        table.line("    is dependencies, and filling and draining the pipeline");
        return;
    }
    table.line(&format!("{WHAT}{BOLD}{name}{PLAIN}, used {used} of the time"));
    let neighbours = [upstream(&report.chain, times, k), downstream(&report.chain, times, k)];
    let next = runner_up(&report.chain, times, k);
    for consequence in neighbours.into_iter().flatten().chain(next) {
        table.line(&format!("    {consequence}"));
    }
}

/// The block that a run uses most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The block.
    pub block: Block,
    /// Its utilisation, 0..=1.
    pub used: f64,
    /// Whether that is enough to bind the run; latency does where it is not.
    pub binds: bool,
}

/// What binds a run; `None` without an engine, and where nothing ran.
#[must_use]
pub fn bound(report: &Report, whole: &Frame) -> Option<Bound> {
    let (k, used) = busiest(whole.times.as_ref()?)?;
    Some(Bound { block: report.chain[k].block, used, binds: used >= BINDS })
}

/// The block with the highest utilisation, the first of equals, and that utilisation.
fn busiest(times: &FrameTimes) -> Option<(usize, f64)> {
    let shares = times.stages.iter().map(|t| ratio(t.used, t.total));
    largest(shares.enumerate().filter_map(|(k, share)| Some((k, share?))))
}

/// The block that is used most after `k`: what would bind if that were faster.
fn runner_up(chain: &[Stage], times: &FrameTimes, k: usize) -> Option<String> {
    let others = times.stages.iter().enumerate().filter(|&(i, _)| i != k);
    let (i, used) = largest(others.filter_map(|(i, t)| Some((i, ratio(t.used, t.total)?))))?;
    Some(format!("next would be {}, used {}", chain[i].block.name(), percent(used)))
}

/// The largest share, the first of equals.
fn largest(shares: impl Iterator<Item = (usize, f64)>) -> Option<(usize, f64)> {
    shares.reduce(|best, next| if next.1 > best.1 { next } else { best })
}

/// Whether the block before `k` waits for it.
fn upstream(chain: &[Stage], times: &FrameTimes, k: usize) -> Option<String> {
    let before = k.checked_sub(1)?;
    let t = &times.stages[before];
    let blocked = ratio(t.blocked, t.total)?;
    let verb = if blocked < NOTABLE { "hardly waits" } else { "waits" };
    let (block, name) = (chain[before].block.name(), chain[k].block.name());
    Some(format!("upstream {verb} for it: {block} blocked {} by {name}", percent(blocked)))
}

/// How long the hungriest of the blocks behind `k` starves.
fn downstream(chain: &[Stage], times: &FrameTimes, k: usize) -> Option<String> {
    let behind = times.stages.iter().enumerate().skip(k + 1);
    let shares = behind.filter_map(|(i, t)| Some((i, ratio(t.starved, t.total)?)));
    let (i, starved) = largest(shares)?;
    let verb = if starved < NOTABLE { "hardly starves" } else { "starves" };
    let [block, by] = [i, i - 1].map(|i| chain[i].block.name());
    Some(format!("downstream {verb}: {block} starved {} by {by}", percent(starved)))
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}
