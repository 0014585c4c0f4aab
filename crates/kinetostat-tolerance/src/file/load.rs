//! Words for what an uncertain number of the load is of.

use kinetostat::Wrench;

use crate::file::source::{CUTTING_PARTS, Source};

/// Names of the load's components, and of its factor.
const LOADS: [&str; 7] = [
    "force_n.x",
    "force_n.y",
    "force_n.z",
    "moment_n_m.x",
    "moment_n_m.y",
    "moment_n_m.z",
    "factor",
];

/// Words for a load along a program.
const LOADS_OF_PROGRAM: [&str; 4] = [
    "factor",
    CUTTING_PARTS[0],
    CUTTING_PARTS[1],
    CUTTING_PARTS[2],
];

/// The load that a file's numbers may be of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Load<'a> {
    /// One wrench on the tool: its components, or a factor.
    Stated(&'a Wrench),
    /// Load of a program, another at every place: factors on all of it, or on parts.
    AlongProgram,
}

impl Load<'_> {
    /// Words for it.
    pub(super) fn words(self) -> &'static [&'static str] {
        match self {
            Self::Stated(_) => &LOADS,
            Self::AlongProgram => &LOADS_OF_PROGRAM,
        }
    }

    /// Value as drawn, unit, and what it is of.
    pub(super) fn part(self, at: usize) -> (f64, &'static str, Source) {
        match self {
            Self::Stated(load) if at < 6 => {
                let unit = if at < 3 { "N" } else { "N m" };
                (load.0[at], unit, Source::Load(at))
            }
            Self::AlongProgram if at > 0 => (1.0, "", Source::CuttingPart(at - 1)),
            _ => (1.0, "", Source::LoadFactor),
        }
    }
}
