//! How a written program stands to its tolerance, and where and why it is farthest off.

use kinetostat::number::{largest_length, short};
use kinetostat_program::{Corrected, Path};

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
    path: &Path,
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
        let rounding_mm = result.summary.max_rounding_error_mm;
        let reason = if rounding_mm > 0.5 * allowed_mm {
            format!(
                "rounding to {} decimals alone leaves up to {}; write more of them, or allow more",
                result.summary.decimals.shown(result.run_inputs.decimals, "to").0,
                largest_length(rounding_mm)
            )
        } else if a.left_out_mm > 0.5 * error(p) {
            left_out(a)
        } else if let Some(at_pole) = near_pole(path, p, AT_POLE_RAD) {
            at_pole
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
        } else if let Some(near) = near_pole(path, p, NEAR_POLE_RAD) {
            near
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

/// Nearer to the pole than this, the axis that turns about it turns more than ten times as far as the tool.
const NEAR_POLE_RAD: f64 = 0.1;

/// Nearer than this it is the reason, whatever else there is: at a corner the program turns nothing.
const AT_POLE_RAD: f64 = 1e-4;

/// That directions lead the tool past the pole of its rotary axes at a place, how far from it, and what can be done.
fn near_pole(path: &Path, point: &PointResult, within_rad: f64) -> Option<String> {
    let turn = path.moves.get(point.move_index)?.tool_turn.as_ref()?;
    let rotary = turn.rotary.as_ref()?;
    let angles = rotary.angles_deg(point.share);
    let from_pole = rotary.axes.from_pole_rad(&angles)?;
    let is_near = rotary.great_circle.is_some() && from_pole < within_rad;
    is_near.then(|| {
        let axes = rotary.axes.axes.iter().zip(angles);
        let stand: Vec<String> = axes
            .map(|(axis, angle)| format!("{}{angle:.3}", axis.letter))
            .collect();
        format!(
            "directions lead the tool past the pole of its rotary axes, here at {} deg ({}), where they turn fast, and between the ends of pieces not as in the block; let the CAM system keep the tool farther from the pole there, write angles of the axes, or widen the tolerance of the path",
            short(from_pole.to_degrees()),
            stand.join(" ")
        )
    })
}
