//! Parts of a long program side by side, on all threads.

use std::sync::atomic::{AtomicUsize, Ordering};

use kinetostat_machining::Watch;
use kinetostat_program::{Part, PartsInOrder, PlaceInOrder, Standing};

use crate::ui::failure::Answer;
use crate::ui::host;
use crate::ui::progress::Progress;
use crate::ui::threads::{in_threads, not_started};

/// Parts that are in memory at a time, at most: each takes 20 to 60 MB. Where there are more threads, several solve the points of
/// one part.
const MOST: usize = 4;

/// Watch of one part: it reports no progress, since other parts run in parallel. It is stopped with them.
struct Beside<'a, 'o> {
    progress: &'a Progress,
    order: &'a PartsInOrder<'o>,
}

impl Watch for Beside<'_, '_> {
    fn stage(&self, _: &str, _: usize) {}
    fn advance(&self, _: usize) {}
    fn cancelled(&self) -> bool {
        self.progress.cancelled() || self.order.has_ended()
    }
}

/// Has nobody wait for a thread that panics.
struct EndsInPanic<'a, 'o>(&'a PartsInOrder<'o>);

impl Drop for EndsInPanic<'_, '_> {
    fn drop(&mut self) {
        if std::thread::panicking() {
            self.0.end();
        }
    }
}

/// Reads every part that is not taken yet, of so many, and does the work on it, on a number of threads (all, where none is stated).
/// `work` waits for the turn of its part, takes it, and says whether it did: what it takes comes in the order of the parts,
/// however many threads there are. The failure of the first part that fails is that of all.
pub(crate) fn side_by_side<'o>(
    read: impl Fn(usize) -> Answer<Part> + Sync,
    order: &PartsInOrder<'o>,
    count: usize,
    threads: Option<usize>,
    progress: &Progress,
    work: impl Fn(&Part, &PlaceInOrder<'_, 'o>, &dyn Watch) -> Answer<bool> + Sync,
) -> Answer<()> {
    // The number is a sensible one, and there are so many.
    let threads = in_threads(threads, rayon::current_num_threads)?;
    let at_once = threads.min(count.saturating_sub(order.taken()).clamp(1, MOST));
    let side = SideBySide {
        next: AtomicUsize::new(order.taken()),
        count,
        order,
        read: &read,
        watch: &Beside { progress, order },
        work: &work,
    };
    let host = host::current();
    std::thread::scope(|scope| {
        let begun: Vec<_> = (0..at_once)
            .map(|index| {
                let own = threads / at_once + usize::from(index < threads % at_once);
                let (side, host) = (&side, host.clone());
                let work = move || {
                    let done =
                        host::working_for(host, || in_threads(Some(own), || side.go_through()));
                    done.and_then(|done| done).inspect_err(|_| side.order.end())
                };
                let begun = std::thread::Builder::new().spawn_scoped(scope, work);
                begun.map_err(|error| {
                    side.order.end();
                    not_started(threads, &error)
                })
            })
            .collect();
        let mut all = Ok(());
        for thread in begun {
            let done = thread.map(|thread| {
                let joined = thread.join();
                joined.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            all = all.and(done.and_then(|done| done));
        }
        all
    })
}

/// State shared by all threads.
struct SideBySide<'a, 'o, R, W> {
    /// The next part that nobody has.
    next: AtomicUsize,
    count: usize,
    order: &'a PartsInOrder<'o>,
    watch: &'a Beside<'a, 'o>,
    read: &'a R,
    work: &'a W,
}

impl<'o, R, W> SideBySide<'_, 'o, R, W>
where
    R: Fn(usize) -> Answer<Part>,
    W: Fn(&Part, &PlaceInOrder<'_, 'o>, &dyn Watch) -> Answer<bool>,
{
    /// One part after the other, as long as there are some.
    fn go_through(&self) -> Answer<()> {
        let _guard = EndsInPanic(self.order);
        loop {
            let index = self.next.fetch_add(1, Ordering::Relaxed);
            if index >= self.count || !self.take(index)? {
                return Ok(());
            }
        }
    }

    /// Has a part taken; whether there is reason to go on.
    fn take(&self, index: usize) -> Answer<bool> {
        let part = (self.read)(index);
        loop {
            let place = self.order.place(index);
            let done = match &part {
                Ok(part) => (self.work)(part, &place, self.watch),
                Err(failure) => Err(failure.clone()),
            };
            match (done, place.wait_for_turn()) {
                (_, Standing::Ended) => return Ok(false),
                (_, Standing::Again) => {}
                (Ok(true), Standing::Next) => {
                    place.taken();
                    return Ok(true);
                }
                // The state changed during the wait.
                (Ok(false), Standing::Next) => {}
                (Err(failure), Standing::Next) => return Err(failure),
            }
        }
    }
}
