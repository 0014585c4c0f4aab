//! Plausibility of a correction for cutting forces: the part due to the machine's own weight has a limit of its own, and a
//! displacement may be too large to be a deflection.

use kinetostat::number::{Rounding, largest_length, length_setting, significant};
use nalgebra::Vector3;

use crate::checks::own_weight::by_own_loads;
use crate::checks::{Exceeded, ODD};
use crate::limits::Limits;
use crate::result::point::{PointResult, most, place, size};
use crate::task::Task;
use crate::warning::{Warning, WarningCode};

/// Points at which the part of own weight is computed, where a correction is large.
const MOST_POINTS: usize = 4096;

/// The correction at a point or, of an analysis, what it would have to make up for, mm.
fn to_make_up(point: &PointResult) -> f64 {
    size(&point.correction_mm).max(size(&point.error_before_mm))
}

/// Size of the correction without the part due to the machine's own weight.
pub(crate) fn besides(point: &PointResult, own: &Vector3<f64>) -> f64 {
    let correction = Vector3::from(point.correction_mm);
    // A correction is against what it makes up for; an analysis has none.
    let corrected = match correction == Vector3::zeros() {
        true => 0.0,
        false => (correction + own).norm(),
    };
    corrected.max((Vector3::from(point.error_before_mm) - own).norm())
}

/// Corrections beyond their limit, that by own weight and that by the rest each by its own. Limits are
/// millimetres of the machine, results those of a program that may be scaled in it.
pub(crate) fn corrections(exceeded: &mut Exceeded<'_>, task: &Task<'_>, points: &[PointResult]) {
    let limits = exceeded.limits;
    let scale = task.placement.scale;
    let least = limits.correction_mm.min(limits.own_weight_mm) / scale;
    // NaN is beyond every limit.
    let large: Vec<&PointResult> = points
        .iter()
        .filter(|p| !matches!(to_make_up(p).partial_cmp(&least), Some(order) if order.is_le()))
        .collect();
    let mut compared: Vec<&PointResult> = large
        .iter()
        .step_by(large.len().div_ceil(MOST_POINTS).max(1))
        .copied()
        .collect();
    compared.extend(
        most(points, to_make_up)
            .map(|(_, at)| at)
            .filter(|_| !large.is_empty()),
    );
    let own = by_own_loads(task, &compared);
    let mut worst: [Option<(f64, &PointResult)>; 2] = [None, None];
    let mut note = |kind: usize, value: f64, at| {
        let key = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        if worst[kind].is_none_or(|(most, _)| key(value) > key(most)) {
            worst[kind] = Some((value, at));
        }
    };
    for (point, own) in compared.into_iter().zip(own) {
        let own = own.unwrap_or_default().error;
        note(0, scale * besides(point, &own), point);
        note(1, scale * own.norm(), point);
    }
    for (name, found) in ["correction_mm", "own_weight_mm"].into_iter().zip(worst) {
        if let Some((value, at)) = found {
            exceeded.above(name, value, Some(at.line), place(at));
        }
    }
}

/// Corrections that are allowed and unusual; for tables as for models.
#[must_use]
pub fn odd_correction(
    limits: &Limits,
    largest_mm: f64,
    line: Option<usize>,
    tolerance_mm: f64,
) -> Option<Warning> {
    let warning = if largest_mm > ODD * limits.correction_mm {
        Warning::new(
            WarningCode::LargeCorrection,
            format!(
                "corrections of up to {} are large: check units and signs of load and stiffnesses, or of the table",
                largest_length(largest_mm)
            ),
        )
    } else if largest_mm <= tolerance_mm {
        Warning::new(
            WarningCode::SmallCorrection,
            format!(
                "the largest correction, {}, is not more than the tolerance, {}: there is nothing to correct; check units, load and placement",
                largest_length(largest_mm),
                length_setting(tolerance_mm)
            ),
        )
    } else {
        return None;
    };
    Some(Warning { line, ..warning })
}

/// A displacement by this share of the machine's size is no deflection any more.
const LARGE: f64 = 0.05;

/// The tool moves by `far`, which is no deflection any more of a machine of this size, m.
#[must_use]
pub fn folds(far: f64, size: f64) -> Option<Warning> {
    folds_at(far, size, "")
}

/// Warning for `places` of a grid, in words; empty for one place.
#[must_use]
pub fn folds_at(far: f64, size: f64, places: &str) -> Option<Warning> {
    is_large(far, size).then(|| {
        Warning::new(WarningCode::LargeDisplacement, format!(
            "the tool moves by {} % of the machine's size{places}: the machine folds over under this load; check the force and the stiffnesses",
            significant(100.0 * far / size, 2, Rounding::Nearest)
        ))
    })
}

/// True if a displacement is too large to be a deflection of a machine of this size, m.
#[must_use]
pub fn is_large(far: f64, size: f64) -> bool {
    far > LARGE * size
}
