//! A progress bar on a terminal, none in a pipe.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Counts frequencies on standard error; hidden with `--quiet`, `--json`, or where that is no terminal.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    pub(crate) fn new(hidden: bool) -> Self {
        Self::of("frequencies", hidden)
    }

    /// Counts something else.
    pub(crate) fn of(what: &str, hidden: bool) -> Self {
        let bar = if hidden {
            ProgressBar::hidden()
        } else {
            // Standard error: hidden by the crate where that is no terminal.
            ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
        };
        if let Ok(style) =
            ProgressStyle::with_template(&format!("{{bar:40}} {{pos}}/{{len}} {what}, {{eta}} left"))
        {
            bar.set_style(style);
        }
        Self(bar)
    }

    /// `done` of `total` are done.
    pub(crate) fn show(&self, done: usize, total: usize) {
        self.0.set_length(total as u64);
        self.0.set_position(done as u64);
    }

    pub(crate) fn end(&self) {
        self.0.finish_and_clear();
    }
}
