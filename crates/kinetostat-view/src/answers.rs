//! What the page asks.

use crate::refused::Refused;

/// What the page asks; answers are JSON.
pub trait Answers: Send + Sync + 'static {
    /// The machine of the session.
    ///
    /// # Errors
    /// A machine without a place at home.
    fn machine(&self) -> Result<String, Refused>;

    /// A state of the machine.
    ///
    /// # Errors
    /// A question that cannot be asked; that a place cannot be reached is an answer.
    fn state(&self, request: &[u8]) -> Result<String, Refused>;

    /// Vibrations of the machine about a state.
    ///
    /// # Errors
    /// As for [`Answers::state`]; a machine without masses.
    fn modes(&self, request: &[u8]) -> Result<String, Refused>;

    /// Equilibria of the machine while a load on it grows.
    ///
    /// # Errors
    /// As for [`Answers::state`]; a state without a load.
    fn curve(&self, request: &[u8]) -> Result<String, Refused>;

    /// The path of the program of the session, if it has one.
    fn path(&self) -> Option<String>;
}
