//! Long work of the core that cannot be interrupted from inside: it runs on a thread of its own
//! while this one looks for Ctrl-C and shows that something happens.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{RunError, Watch};

use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::host;
use crate::ui::progress::Progress;
use crate::ui::screen;

/// Says what is being done.
pub(crate) struct Stage(Option<ProgressBar>);

impl Stage {
    fn new() -> Self {
        Self(screen::watched().then(|| {
            let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(8));
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
                bar.set_style(style);
            }
            bar
        }))
    }

    pub(crate) fn is(&self, what: impl Into<String>) {
        if let Some(bar) = &self.0 {
            bar.set_message(what.into());
        }
    }
}

/// Runs `work` and hands its answer back, or ends with exit code 130 when Ctrl-C comes first; the
/// thread then ends with the program.
pub(crate) fn interruptible<R: Send + 'static>(
    work: impl FnOnce(&Stage) -> Answer<R> + Send + 'static,
) -> Answer<R> {
    let stage = Stage::new();
    let bar = stage.0.clone();
    let (to, from) = channel();
    let host = host::current();
    std::thread::spawn(move || {
        // Nobody listens any more after Ctrl-C.
        let _ = to.send(host::working_for(host, || work(&stage)));
    });
    let stop = Progress::new();
    let answer = loop {
        match from.recv_timeout(Duration::from_millis(50)) {
            Ok(answer) => break answer,
            Err(RecvTimeoutError::Timeout) if Watch::cancelled(&stop) => {
                break Err(Failure::from(RunError::Cancelled));
            }
            Err(RecvTimeoutError::Timeout) => {
                if let Some(bar) = &bar {
                    bar.tick();
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                break Err(ErrorCode::Internal.failure("the search ended by itself, which it never should: please report this command and its model",
                ));
            }
        }
    };
    if let Some(bar) = &bar {
        bar.finish_and_clear();
    }
    answer
}
