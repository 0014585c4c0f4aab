//! An offset of one axis, of any size, fitted to measured poses.

use kinetostat::{Pose, spatial::pose_residual};
use nalgebra::{DMatrix, DVector};

use crate::measured_poses::explanation::{Axis, Explanation, Forward, quarter};
use crate::measured_poses::measurement::MeasuredPose;

/// One more offset, of any size, for each axis: Newton's iteration on that number alone.
pub(crate) fn fitted(
    forward: &Forward<'_>,
    rows: &[MeasuredPose],
    change: &Explanation,
    axes: &[Axis],
) -> Vec<Explanation> {
    if !change.offsets.is_empty() || change.coupling.is_some() || change.reversed.len() > 1 {
        return Vec::new();
    }
    let residual = |e: &Explanation| -> Option<DVector<f64>> {
        let mut all = Vec::new();
        for row in rows {
            let computed = forward(&e.applied(&row.joints, axes))?;
            let turn = row.rotation.unwrap_or(computed.rotation);
            let target = Pose::from_parts(row.position.into(), turn);
            all.extend(pose_residual(&target, &computed).0.iter());
        }
        Some(DVector::from_vec(all))
    };
    let with = |axis: usize, by: f64| Explanation {
        offsets: vec![(axis, by)],
        ..change.clone()
    };
    let mut found = Vec::new();
    for (axis, turning) in axes.iter().map(|a| a.turns).enumerate() {
        let starts: &[f64] = if turning {
            &[0.1, 1.6, 3.1, -1.6]
        } else {
            &[0.0]
        };
        let mut best: Option<(f64, f64)> = None;
        for &start in starts {
            let mut by = start;
            for _ in 0..12 {
                let (Some(here), Some(up), Some(down)) = (
                    residual(&with(axis, by)),
                    residual(&with(axis, by + 1e-6)),
                    residual(&with(axis, by - 1e-6)),
                ) else {
                    break;
                };
                let slope = DMatrix::from_columns(&[(up - down) / 2e-6]);
                let step = -slope.column(0).dot(&here) / slope.norm_squared().max(1e-30);
                by += if turning { step.clamp(-0.5, 0.5) } else { step };
                if step.abs() < 1e-12 {
                    break;
                }
            }
            let size = residual(&with(axis, by)).map_or(f64::INFINITY, |m| m.norm());
            if best.is_none_or(|(least, _)| size < least) {
                best = Some((size, by));
            }
        }
        if let Some((_, by)) = best
            && by.is_finite()
        {
            let turn = std::f64::consts::TAU;
            let by = if turning {
                by - turn * (by / turn).round()
            } else {
                by
            };
            // Quarter turns are tried as such; no offset is no explanation.
            if !turning || !quarter(by) {
                found.push(with(axis, by));
            }
        }
    }
    found
}
