//! The progress of a long run, on a terminal's error output; nothing elsewhere.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};
use qdist::mesh::{Progress, Watch};

/// Steps of the bar per query.
const STEPS: u64 = 1000;
/// Between two updates within a query: watching costs next to nothing then.
const PAUSE: Duration = Duration::from_millis(50);

pub struct Bar(ProgressBar);

impl Bar {
    /// For so many queries.
    pub fn new(queries: usize) -> Bar {
        // Draws on the error output, and only if that is a terminal.
        let bar = ProgressBar::new(queries as u64 * STEPS);
        let style = ProgressStyle::with_template("[{elapsed}] {bar:30} {percent:>3} % {wide_msg}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Bar(bar)
    }

    pub fn say(&self, what: &str) {
        self.0.set_message(what.to_string());
    }

    /// One query, which may be watched.
    pub fn during<R>(&self, index: usize, name: &str, ask: impl FnOnce(Option<Watch>) -> R) -> R {
        if self.0.is_hidden() {
            return ask(None);
        }
        self.0.set_position(index as u64 * STEPS);
        self.say(name);
        let mut last = Instant::now();
        let mut watch = |progress: &Progress| {
            if last.elapsed() > PAUSE {
                last = Instant::now();
                let share = (progress.fraction * STEPS as f64) as u64;
                self.0.set_position(index as u64 * STEPS + share);
                let (lower, upper, queries) = (progress.lower, progress.upper, progress.queries);
                self.0.set_message(format!("{name}: {lower:.6} .. {upper:.6} after {queries} queries"));
            }
            false
        };
        ask(Some(&mut watch))
    }

    /// Writes to the same terminal while the bar is not there.
    pub fn aside<R>(&self, write: impl FnOnce() -> R) -> R {
        self.0.suspend(write)
    }

    pub fn finish(&self) {
        self.0.finish_and_clear();
    }
}
