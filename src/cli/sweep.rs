//! `sweep`: a study in, a folder with the results of all its points and two tables out.

use super::print;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;
use tessim::error::{Error, Result};
use tessim::study::sweep::{self, Event, Plan, Shard, Status, Store, Study, Work};

/// Run a grid or a list of configurations over traces and units
///
/// The study names traces, presets, units, keys that are set, and a grid or a list of values.
/// Results are kept under the hash of trace, configuration and version: a sweep that was stopped
/// goes on when it is started again, and several processes may share a folder. When all points are
/// settled, points.csv (a row a point), sweep.svg (plots of it) and sweep.csv (a row a point and
/// counter) are written.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  tessim sweep traces/sweeps/buses.toml --out buses\n  \
                        tessim sweep traces/sweeps/buses.toml --out buses --status\n  \
                        tessim sweep traces/sweeps/buses.toml --out part --shard 2/4")]
pub(crate) struct Args {
    /// The study
    study: PathBuf,
    /// The folder of the sweep [default: the study's name with .sweep for .toml]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Compute nothing; say how many points are completed, failed, running and never run
    #[arg(long)]
    status: bool,
    /// Compute part i of n, from 1: the parts of a study are the same on every machine
    #[arg(long, value_name = "I/N", value_parser = Shard::parse, conflicts_with = "status")]
    shard: Option<Shard>,
    /// Points computed at a time, which changes no byte of them [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
}

pub(crate) fn run(args: &Args, quiet: bool) -> Result<()> {
    let pool = super::run::pool(args.threads)?;
    let out = args.out.clone().unwrap_or_else(|| args.study.with_extension("sweep"));
    let study = Study::open(&args.study)?;
    let plan = pool.install(|| Plan::new(study))?;
    let store = Store::at(&out)?;
    if args.status {
        let status = Status::of(&plan, &store)?;
        return print::print(&(status.text() + &status.failures(&plan)));
    }
    let threads = NonZeroUsize::new(pool.current_num_threads()).expect("a pool has threads");
    let progress = Progress::new(quiet);
    let watch = |event| progress.event(event);
    let done = sweep::run(&plan, &store, args.shard.unwrap_or(Shard::WHOLE), threads, &watch);
    drop(progress);
    let (work, status) = done?;
    if !quiet {
        print::print(&told(&work, &status, &out))?;
    }
    match status.failed.len() {
        0 => Ok(()),
        failed => {
            let (all, failures) = (status.all(), status.failures(&plan));
            Err(Error::Check(format!("{failures}{failed} of {all} points failed")))
        }
    }
}

/// What was done and what there is now.
fn told(work: &Work, status: &Status, out: &std::path::Path) -> String {
    let Work { all, found, computed, by_others } = work;
    let done = format!(
        "{all} different points: {computed} computed, {found} found, {by_others} computed by \
         other processes\n"
    );
    let open = status.running + status.never_run;
    let tables = match open {
        0 => format!("{0}/points.csv\n{0}/sweep.svg\n{0}/sweep.csv\n", out.display()),
        _ => format!("no tables yet: {open} of {} points are open\n", status.all()),
    };
    done + &status.text() + &tables
}

/// A bar on standard error, on a terminal only. Gone when it is dropped.
struct Progress {
    bar: ProgressBar,
    failed: AtomicUsize,
}

impl Progress {
    fn new(quiet: bool) -> Self {
        let target =
            if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style = "{elapsed} [{wide_bar}] {pos}/{len} points{msg}, {eta} left";
        let style = ProgressStyle::with_template(style).expect("the template is well formed");
        bar.set_style(style.progress_chars("=> "));
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(500));
        }
        Self { bar, failed: AtomicUsize::new(0) }
    }

    fn event(&self, event: Event) {
        match event {
            Event::Begin { all, found } => {
                self.bar.set_length(all as u64);
                self.bar.set_position(found as u64);
                // What was found says nothing about how long the others take.
                self.bar.reset_eta();
            }
            Event::Settled { failed } => {
                if failed {
                    let failed = self.failed.fetch_add(1, Ordering::Relaxed) + 1;
                    self.bar.set_message(format!(", {failed} failed"));
                }
                self.bar.inc(1);
            }
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
