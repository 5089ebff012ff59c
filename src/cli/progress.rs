//! Progress on standard error, on a terminal only, and never with `-q`.
//!
//! The length of a trace is not known while it streams, so what is shown is what has been read.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;
use tessim::trace::command::Command;

/// A line that says how far a run is. Gone when it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    what: String,
    frames: u64,
    draws: u64,
    patches: u64,
}

impl Progress {
    /// Of something that a prefix names, or of all there is.
    pub(crate) fn new(quiet: bool, what: &str) -> Self {
        let target =
            if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(None, target);
        let style = ProgressStyle::with_template("{spinner} {elapsed} {msg}");
        bar.set_style(style.expect("the template is well formed"));
        if !bar.is_hidden() {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self { bar, what: what.to_owned(), frames: 0, draws: 0, patches: 0 }
    }

    /// Takes note of a command that has been read.
    pub(crate) fn command(&mut self, command: &Command) {
        match command {
            Command::Frame(_) => self.frames += 1,
            Command::Draw(draw) => {
                self.draws += 1;
                self.patches += draw.primitive.patches() * draw.models.len() as u64;
            }
            _ => return,
        }
        if !self.bar.is_hidden() {
            let Self { what, frames, draws, patches, .. } = self;
            self.bar
                .set_message(format!("{what}{frames} frames, {draws} draws, {patches} patches"));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

/// A bar that says how many of so many steps are done. Gone when it is dropped.
pub(crate) struct Steps(ProgressBar);

impl Steps {
    /// Of something that has a name.
    pub(crate) fn new(quiet: bool, what: &'static str, length: u64) -> Self {
        let target =
            if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
        let bar = ProgressBar::with_draw_target(Some(length), target);
        let style = ProgressStyle::with_template("{elapsed} {wide_bar} {pos} of {len} {msg}");
        bar.set_style(style.expect("the template is well formed"));
        bar.set_message(what);
        Self(bar)
    }

    /// One more is done.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
