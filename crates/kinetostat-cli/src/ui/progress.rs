//! Progress of long work on a terminal, and Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Watch;
use kinetostat_program::Monitor;

use crate::ui::failure::{Answer, Code, Failing, STOPPED};
use crate::ui::host::{self, Host};
use crate::ui::screen::{self, Stream};

static STOP: AtomicBool = AtomicBool::new(false);

/// Time that work has to stop by itself and to say so.
const PATIENCE: Duration = Duration::from_secs(1);

/// Time between two lines of progress.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Ctrl-C asks the work to stop. What does not look, a single place or a drawing, is ended a second
/// later, after removing temporary files.
pub(crate) fn catch_interrupts(remove_temporary: fn()) {
    let handler = move || {
        STOP.store(true, Ordering::SeqCst);
        std::thread::sleep(PATIENCE);
        remove_temporary();
        screen::complain(&ErrorCode::Stopped.failure(STOPPED));
        std::process::exit(Code::Stopped as i32);
    };
    // A file that outgrows its limit (`ulimit -f`) is then an error of writing, and temporary files are removed.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(
        signal_hook::consts::SIGXFSZ,
        Arc::new(AtomicBool::new(false)),
    );
    // Ctrl-C ends the program at once without a handler: worse, but no reason to refuse.
    let _ = ctrlc::set_handler(handler);
}

/// A stage of which it is known how long it is, and one of which it is not. With the longest name,
/// nine digits on both sides and an estimate of days both stay within 80 columns.
const KNOWN: &str = "{msg:35!} {bar:12} {pos:>9}/{len:9} {eta:>4} left";

const OPEN: &str = "{msg:35!} {pos:>9} points, {elapsed:>4}";

/// Shows stages with an estimate of the time left, if somebody watches.
pub(crate) struct Progress {
    host: Option<Arc<Host>>,
    bar: Option<ProgressBar>,
    stage: Mutex<(String, usize)>,
    /// Begin of the stage and time of the last line, where progress is written as lines.
    lines: Option<Mutex<[Instant; 2]>>,
}

impl Progress {
    pub(crate) fn new() -> Self {
        let bar = screen::watched()
            .then(|| ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr_with_hz(8)));
        Self {
            host: host::current(),
            bar,
            stage: Mutex::new((String::new(), 0)),
            lines: None,
        }
    }

    /// Progress that is written as lines where no bar can be drawn and no host asks for it.
    pub(crate) fn with_lines() -> Self {
        let mut own = Self::new();
        if own.bar.is_none() && own.host.is_none() {
            own.lines = Some(Mutex::new([Instant::now(); 2]));
        }
        own
    }

    /// Writes a line if the last one is old enough.
    fn line(&self, done: usize) {
        let (Some(lines), Ok(stage)) = (&self.lines, self.stage.lock()) else {
            return;
        };
        let Ok(mut times) = lines.lock() else { return };
        if done == 0 || times[1].elapsed() < BETWEEN_LINES {
            return;
        }
        times[1] = Instant::now();
        let (name, total) = &*stage;
        let left_s =
            times[0].elapsed().as_secs_f64() * total.saturating_sub(done) as f64 / done as f64;
        let text = format!("{name}: {done} of {total}, about {left_s:.0} s left\n");
        // A closed pipe does not end the work.
        let _ = screen::print(Stream::Err, &text);
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
        if let Some(host) = &self.host {
            host.watch().stage(name, total);
        }
        if let Some(mut times) = self.lines.as_ref().and_then(|lines| lines.lock().ok()) {
            *times = [Instant::now(); 2];
        }
        if self.lines.is_some()
            && let Ok(mut stage) = self.stage.lock()
        {
            *stage = (name.to_owned(), total);
        }
        let Some(bar) = &self.bar else { return };
        let Ok(mut stage) = self.stage.lock() else {
            return;
        };
        if stage.0 == name && stage.1 == total {
            return;
        }
        // A total that grows on the way is no total: from then on only what is done is shown.
        let open = total == 0 || stage.0 == name;
        if let Ok(style) = ProgressStyle::with_template(if open { OPEN } else { KNOWN }) {
            bar.set_style(style);
        }
        if stage.0 != name {
            bar.set_message(name.to_owned());
            bar.set_position(0);
            bar.reset_eta();
            bar.reset_elapsed();
            name.clone_into(&mut stage.0);
        }
        if !open {
            bar.set_length(total as u64);
        }
        stage.1 = total;
    }

    fn advance(&self, done: usize) {
        if let Some(host) = &self.host {
            host.watch().advance(done);
        }
        self.line(done);
        if let Some(bar) = &self.bar {
            bar.set_position(done as u64);
        }
    }

    fn cancelled(&self) -> bool {
        stopped(self.host.as_deref())
    }
}

/// Stages that are shown as one, each with its share of the work.
pub(crate) struct AsOne<'p> {
    progress: &'p Progress,
    shares: &'static [f64],
    /// Number of the stage, from 1, and its points.
    now: Mutex<(usize, usize)>,
}

impl<'p> AsOne<'p> {
    pub(crate) fn new(progress: &'p Progress, name: &str, shares: &'static [f64]) -> Self {
        progress.stage(name, 100);
        Self {
            progress,
            shares,
            now: Mutex::default(),
        }
    }
}

impl Watch for AsOne<'_> {
    fn stage(&self, _: &str, total: usize) {
        if let Ok(mut now) = self.now.lock() {
            *now = (now.0 + 1, total.max(1));
        }
        self.advance(0);
    }

    fn advance(&self, done: usize) {
        let Ok(now) = self.now.lock() else { return };
        let (before, own) = self.shares.split_at(now.0.clamp(1, self.shares.len()) - 1);
        let share = before.iter().sum::<f64>() + own[0] * done as f64 / now.1.max(1) as f64;
        self.progress.advance((100.0 * share) as usize);
    }

    fn cancelled(&self) -> bool {
        Watch::cancelled(self.progress)
    }
}

/// True if the command is to end: its host requests it, or without one Ctrl-C came.
fn stopped(host: Option<&Host>) -> bool {
    match host {
        Some(host) => host.watch().cancelled(),
        None => STOP.load(Ordering::SeqCst),
    }
}

/// Ends a command of a host that wants no answer any more: nothing is put in place then. Without a host the
/// handler of Ctrl-C ends the process.
///
/// # Errors
/// That it was stopped.
pub(crate) fn still_wanted() -> Answer<()> {
    match host::current() {
        Some(host) if host.watch().cancelled() => Err(ErrorCode::Stopped.failure(STOPPED)),
        _ => Ok(()),
    }
}

impl Monitor for Progress {
    fn progress(&self, done: usize, _so_far: usize) {
        // The number of points is not known in advance: every division adds some.
        self.stage("corrections", 0);
        self.advance(done);
    }

    fn cancelled(&self) -> bool {
        Watch::cancelled(self)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use indicatif::TermLike;

    use super::*;

    /// A terminal of 200 columns that remembers the last line.
    #[derive(Clone, Debug, Default)]
    struct Screen(Arc<Mutex<String>>);

    impl Screen {
        fn line(&self) -> String {
            self.0.lock().expect("a line").trim_end().to_owned()
        }
    }

    impl TermLike for Screen {
        fn width(&self) -> u16 {
            200
        }
        fn move_cursor_up(&self, _: usize) -> std::io::Result<()> {
            Ok(())
        }
        fn move_cursor_down(&self, _: usize) -> std::io::Result<()> {
            Ok(())
        }
        fn move_cursor_right(&self, _: usize) -> std::io::Result<()> {
            Ok(())
        }
        fn move_cursor_left(&self, _: usize) -> std::io::Result<()> {
            Ok(())
        }
        fn write_line(&self, text: &str) -> std::io::Result<()> {
            self.write_str(text)
        }
        fn write_str(&self, text: &str) -> std::io::Result<()> {
            if !text.trim().is_empty() {
                text.clone_into(&mut self.0.lock().expect("a line"));
            }
            Ok(())
        }
        fn clear_line(&self) -> std::io::Result<()> {
            Ok(())
        }
        fn flush(&self) -> std::io::Result<()> {
            Ok(())
        }
    }

    fn shown(progress: &Progress, screen: &Screen) -> String {
        if let Some(bar) = &progress.bar {
            bar.force_draw();
        }
        screen.line()
    }

    /// The longest names of stages, the largest counts, and a total that would grow.
    #[test]
    fn the_line_fits_80_columns_and_shows_no_total_that_grows() {
        let screen = Screen::default();
        let target = ProgressDrawTarget::term_like(Box::new(screen.clone()));
        let progress = Progress {
            host: None,
            bar: Some(ProgressBar::with_draw_target(None, target)),
            stage: Mutex::new((String::new(), 0)),
            lines: None,
        };
        let names = [
            "corrections",
            "check of the written program",
            "deflections of the written program",
            "numbers of the report",
        ];
        for name in names {
            for (total, done) in [(123_456_789, 100_000_000), (223_456_789, 200_000_000)] {
                progress.stage(name, total);
                progress.advance(done);
                let line = shown(&progress, &screen);
                let width = line.chars().count();
                assert!((40..=80).contains(&width), "{width}: {line:?}");
                assert!(line.starts_with(name), "{line:?}");
                assert!(line.contains(&done.to_string()), "{line:?}");
                let total_shown = line.contains(&total.to_string());
                assert_eq!(total_shown, total == 123_456_789, "{line:?}");
            }
        }
        progress.stage("another", 0);
        Monitor::progress(&progress, 10, 20);
        let line = shown(&progress, &screen);
        assert!(
            line.contains("10 points") && !line.contains("20"),
            "{line:?}"
        );
    }
}
