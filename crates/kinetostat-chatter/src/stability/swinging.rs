//! Selects the modes of a tool that are kept dynamic in a cut; the others enter as residual flexibility.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number::larger;
use crate::response::{Mode, ToolResponse};

/// Modes kept dynamic in a stability analysis; the others enter by their static flexibility.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Swinging {
    /// All.
    #[default]
    All,
    /// All up to a frequency, Hz, and beyond it up to the fastest one that counts: whose peak flexibility across the tool axis ([`Mode::peak_flexibility`]) is 1 % of the
    /// largest or more, or that could chatter by itself at depths that would else be called stable. As far as the calculation
    /// resolves them at the speed: about 57 vibrations while a tooth cuts.
    AtLeastTo(f64),
    /// Modes up to a frequency, Hz.
    UpTo(f64),
}

impl Swinging {
    /// Share of the largest peak flexibility from which a mode counts.
    pub const SHARE: f64 = 0.01;
}

/// A mode that is taken as a spring although it counts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema, Deserialize)]
pub struct LeftOut {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Peak flexibility across the tool axis by the largest of all modes.
    pub share: f64,
}

/// The modes of a cut in the order of their frequencies, and how many of them swing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Selection {
    pub(crate) automatic: bool,
    pub(crate) modes: Vec<Known>,
    /// The lowest ones that swing if the speed allows it.
    pub(crate) count: usize,
}

/// Data of a mode for the selection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Known {
    pub(crate) of: LeftOut,
    /// Depth below which it cannot chatter by itself, m.
    pub(crate) alone: f64,
}

impl Known {
    pub(crate) fn counts(&self) -> bool {
        self.of.share >= Swinging::SHARE
    }
}

impl Selection {
    /// Selects modes of a response in axes of the cut, whose stiffness is at most `bound`, N/m^2; `None` if all are
    /// dynamic.
    pub(crate) fn new(response: &ToolResponse, bound: f64, swinging: Swinging) -> Option<Self> {
        let sorted = response.with_lowest(usize::MAX);
        let peaks = sorted.modes().iter().map(Mode::peak_flexibility);
        let largest = peaks.fold(0.0, larger);
        let known = |mode: &Mode| Known {
            of: LeftOut {
                frequency_hz: mode.frequency_hz(),
                share: mode.peak_flexibility() / largest,
            },
            // Small gain, as of all modes.
            alone: (2.0 * mode.peak_flexibility() * bound).recip(),
        };
        let modes: Vec<Known> = sorted.modes().iter().map(known).collect();
        let counted = match swinging {
            Swinging::All => return None,
            Swinging::AtLeastTo(hz) => modes
                .iter()
                .rposition(|m| m.counts() || m.of.frequency_hz <= hz),
            Swinging::UpTo(hz) => modes.iter().rposition(|m| m.of.frequency_hz <= hz),
        };
        Some(Self {
            automatic: matches!(swinging, Swinging::AtLeastTo(_)),
            modes,
            count: counted.map_or(1, |last| last + 1),
        })
    }

    /// Number of modes up to a frequency, Hz; at least one.
    pub(crate) fn up_to(&self, hz: f64) -> usize {
        let below = |mode: &&Known| mode.of.frequency_hz <= hz;
        self.modes.iter().filter(below).count().max(1)
    }
}
