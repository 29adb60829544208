//! How far the reading of files has come: on a terminal, and only when it takes long.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tumble_io::Watch;

/// Reading that ends sooner shows nothing.
const PATIENCE: Duration = Duration::from_millis(700);

const FILE: &str = "reading {msg} {percent:>3} % [{bar:20}] {binary_bytes_per_sec}, {eta} left";
const PIPE: &str = "reading {msg} {binary_bytes}, {binary_bytes_per_sec}";

/// A line on standard error; silent where that is no terminal.
#[derive(Debug)]
pub(crate) struct Progress {
    bar: ProgressBar,
    started: Instant,
    /// File that was told of last.
    file: Mutex<String>,
}

impl Progress {
    pub(crate) fn new(quiet: bool) -> Self {
        let target = if quiet {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr_with_hz(5)
        };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        Self { bar, started: Instant::now(), file: Mutex::new(String::new()) }
    }

    /// Takes the line away.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
        self.bar.reset();
    }
}

impl Watch for Progress {
    fn progress(&self, file: &str, done: u64, total: u64) {
        if self.bar.is_hidden() || self.started.elapsed() < PATIENCE {
            return;
        }
        if let Ok(mut last) = self.file.lock()
            && *last != file
        {
            *last = file.to_owned();
            // Nobody knows how long a pipe is.
            let style = if total == 0 { PIPE } else { FILE };
            if let Ok(style) = ProgressStyle::with_template(style) {
                self.bar.set_style(style.progress_chars("=> "));
            }
            let shown: String = file.chars().filter(|c| !c.is_control()).take(30).collect();
            self.bar.set_message(shown);
        }
        if total > 0 {
            self.bar.set_length(total);
        }
        self.bar.set_position(done);
    }
}
