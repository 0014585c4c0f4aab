//! Results of the check of a written program besides its points.

use crate::load::ramp_findings::RampFindings;
use crate::result::force_band::ForceBand;
use crate::result::program_place::ProgramPlace;
use crate::run::largest_change::Changes;
use crate::warning::Warning;

/// Results of the check of a written program besides its points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Checked {
    /// Largest error of the speed along the part where the feed was not limited, percent.
    pub(crate) speed_percent: f64,
    /// Largest error on the corner steps that were not read so, if the load turns evenly there, mm.
    pub(crate) if_turns_mm: Option<f64>,
    /// Largest error on these steps, if the load follows the feed there.
    pub(crate) if_follows_mm: Option<f64>,
    /// The errors with the force larger and smaller by its spread.
    pub(crate) force_band: Option<ForceBand>,
    /// Places that the task asks for.
    pub(crate) places: Vec<ProgramPlace>,
    /// Warning about blocks that were divided again because the tool was found off.
    pub(crate) divided_again: Option<Warning>,
    /// The program as it is keeps the tolerance, and was left so.
    pub(crate) within_before: bool,
    /// Fastest changes of the correction.
    pub(crate) changes: Changes,
    /// Ramps of the load.
    pub(crate) ramps: RampFindings,
}
