//! Observer of a run, who may stop it.

/// Observer of a run, who may stop it.
pub trait Watch: Sync {
    /// A stage begins; `total` points, 0 where nobody knows how many there will be.
    fn stage(&self, name: &str, total: usize);
    /// Points done in this stage.
    fn advance(&self, done: usize);
    /// True if the run is to stop.
    fn cancelled(&self) -> bool;
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn stage(&self, _: &str, _: usize) {}
    fn advance(&self, _: usize) {}
    fn cancelled(&self) -> bool {
        false
    }
}
