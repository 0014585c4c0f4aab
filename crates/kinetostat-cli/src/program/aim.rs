//! What a run along a program is for.

/// What a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    Analyse,
    Compensate,
}
