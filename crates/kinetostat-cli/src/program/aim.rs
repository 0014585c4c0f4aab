//! Purpose of a run along a program.

/// Kind of output of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    Analyse,
    Compensate,
}
