//! A progress bar for commands with one kind of work.

use indicatif::{ProgressBar, ProgressStyle};

/// A bar on standard error, removed when dropped. Draws nothing unless standard error is a terminal.
pub struct Bar(ProgressBar);

impl Bar {
    /// A bar like `verify ###   3/10 flights  2s left`.
    pub fn new(verb: &str, noun: &str) -> Self {
        let style = format!("{verb} {{wide_bar:.cyan/blue}} {{pos}}/{{len}} {noun} {{eta:>5}} left");
        let style = ProgressStyle::with_template(&style).unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(ProgressBar::new(0).with_style(style))
    }

    /// Shows that `done` of `all` are done.
    pub fn show(&self, done: u64, all: u64) {
        self.0.set_length(all);
        self.0.set_position(done);
    }
}

impl Drop for Bar {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
