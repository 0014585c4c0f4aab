//! How the answer of a posture was found.

/// How the answer of a posture was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// Together with others.
    Together,
    /// Alone, by the general engine.
    Alone,
    /// Not at all: the error that the general engine gives for this posture says why. Its numbers
    /// are not numbers.
    Not,
}
