//! How a written program stands to its tolerance, and where and why it is farthest off.

use kinetostat::number::largest_length;
use kinetostat_program::Corrected;

use crate::load::ramp_findings::TooFast;
use crate::result::point::{PointKind, PointResult, size};
use crate::result::run_result::RunResult;
use crate::result::tolerance::{MissedTolerance, ToleranceResult, left_out};

/// Whether the written program keeps its tolerance; where it does not, the farthest place with the likely reason.
pub(crate) fn tolerance(
    result: &RunResult,
    points: &[PointResult],
    written: Option<&Corrected>,
    too_fast: &[TooFast],
) -> ToleranceResult {
    let allowed_mm = result.allowed_mm();
    let held = result.holds_tolerance();
    let error = |p: &PointResult| size(&p.error_after_mm);
    let worst = points
        .iter()
        .filter(|p| p.kind != PointKind::Rapid)
        .max_by(|a, b| error(a).total_cmp(&error(b)))
        .filter(|_| held == Some(false));
    let missed = worst.zip(written).map(|(p, written)| {
        let a = &written.accounting;
        let reason = if a.left_out_mm > 0.5 * error(p) {
            left_out(a)
        } else if p.kind == PointKind::Corner {
            "the tool is at rest at a corner while the load turns, and the correction is written for its ends; round the corner, or reduce the load".to_owned()
        } else if p.kind == PointKind::Entry && points.first().is_some_and(|first| first.line == p.line) {
            "the program begins where the tool stands without a correction, and its first block takes the correction up in a step; begin it with a rapid".to_owned()
        } else if p.kind == PointKind::Entry {
            "the load is there at once where a rapid ends, and the correction is written for the ends of the step there; begin the cut in the air".to_owned()
        } else if size(&p.correction_mm) == 0.0 {
            "this block is carried over as it was: it comes before all axes are stated, or is of a kind that is not corrected".to_owned()
        } else if a.largest_jump_taken_up_mm > 0.5 * error(p) {
            format!(
                "a jump of the correction of {} got no step of its own; tighten the tolerance",
                largest_length(a.largest_jump_taken_up_mm)
            )
        } else if too_fast.iter().any(|found| found.off_mm > 0.5 * error(p)) {
            "the force changes faster there than the correction may follow; enter the cut more softly, or allow a larger step (largest_step_mm_per_mm)".to_owned()
        } else {
            "the correction bends more between the ends of the written pieces than was expected, also where they were divided again; tighten the tolerance of the path".to_owned()
        };
        MissedTolerance::at(p, reason)
    });
    ToleranceResult {
        allowed_mm,
        held,
        missed,
    }
}
