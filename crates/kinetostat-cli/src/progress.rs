//! Progress of long work on a terminal, and Ctrl-C.

use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinetostat_machining::Watch;
use kinetostat_program::Monitor;

use crate::output::remove_temporary;
use crate::screen;

static STOP: AtomicBool = AtomicBool::new(false);

/// Ctrl-C asks the work to stop; a second one ends at once, after removing temporary files.
pub(crate) fn catch_interrupts() {
    let handler = || {
        if STOP.swap(true, Ordering::SeqCst) {
            remove_temporary();
            std::process::exit(130);
        }
    };
    // Without a handler Ctrl-C ends the program at once: worse, but no reason to refuse.
    let _ = ctrlc::set_handler(handler);
}

/// Shows stages with an estimate of the time left, if somebody watches.
pub(crate) struct Progress {
    bar: Option<ProgressBar>,
    stage: Mutex<(String, usize)>,
}

impl Progress {
    pub(crate) fn new() -> Self {
        let bar = screen::watched().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(8));
            if let Ok(style) =
                ProgressStyle::with_template("{msg:36} {bar:20} {pos:>8}/{len} points, {eta} left")
            {
                bar.set_style(style);
            }
            bar
        });
        Self {
            bar,
            stage: Mutex::new((String::new(), 0)),
        }
    }

    pub(crate) fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Watch for Progress {
    fn stage(&self, name: &str, total: usize) {
        let Some(bar) = &self.bar else { return };
        let Ok(mut stage) = self.stage.lock() else {
            return;
        };
        if stage.0 != name {
            bar.set_message(name.to_owned());
            bar.set_position(0);
            bar.reset_eta();
            name.clone_into(&mut stage.0);
        }
        if stage.1 != total {
            bar.set_length(total as u64);
            stage.1 = total;
        }
    }

    fn advance(&self, done: usize) {
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        }
    }

    fn cancelled(&self) -> bool {
        STOP.load(Ordering::SeqCst)
    }
}

impl Monitor for Progress {
    fn progress(&self, done: usize, total: usize) {
        self.stage("corrections", total);
        self.advance(done);
    }

    fn cancelled(&self) -> bool {
        Watch::cancelled(self)
    }
}
