//! The search for explanations, the simplest first.

use kinetostat::Pose;
use kinetostat::number::larger;
use kinetostat::spatial::pose_residual;
use kinetostat_machining::{nearest_rotation, rigid_motion};
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};

use crate::measured_poses::explanation::{
    Axis, Coupling, Difference, Explanation, Forward, Frame, MeasuredPose, Tolerance, difference,
    quarter,
};

/// The search's answer.
#[derive(Clone, Debug, Default)]
pub struct Explained {
    /// All of the smallest number of changes that fit; several where the poses do not decide.
    pub fitting: Vec<Explanation>,
    /// The best of those tried where none fits, with the differences that it leaves.
    pub nearest: Option<(Explanation, Vec<Difference>)>,
}

/// The differences that an explanation leaves; `None` where the machine cannot stand there.
#[must_use]
pub fn remaining_differences(
    forward: &Forward<'_>,
    rows: &[MeasuredPose],
    axes: &[Axis],
    e: &Explanation,
) -> Option<Vec<Difference>> {
    let each = rows.iter().map(|row| {
        let computed = forward(&e.applied(&row.joints, axes))?;
        Some(difference(
            row,
            &match e.frame {
                Some(Frame::Base(base)) => base * computed,
                Some(Frame::Tool(tool)) => computed * tool,
                None => computed,
            },
        ))
    });
    each.collect()
}

/// Rows that screen an explanation before all are computed.
const SCREEN: usize = 8;

/// Number of explanations that are tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Thousands: the machine is a plain product of joints, whose pose takes a microsecond.
    Thousands,
    /// Small changes only: the machine has loops, which are closed for every pose.
    Few,
}

/// Tries explanations of the differences between measured poses and those of a model.
#[must_use]
pub fn explain(
    forward: &Forward<'_>,
    rows: &[MeasuredPose],
    axes: &[Axis],
    effort: Effort,
    tolerance: Tolerance,
) -> Explained {
    let mut found = Explained::default();
    let screen = &rows[..rows.len().min(SCREEN)];
    let mut nearest: Option<(f64, Explanation)> = None;
    let mut least = usize::MAX;
    let quick = effort == Effort::Thousands;
    let mut tries = changes(axes, quick);
    // Stable: the order of the list decides between equals.
    tries.sort_by_key(Explanation::cost);
    for change in &tries {
        if change.cost() > least {
            break;
        }
        let computed: Option<Vec<Pose>> = screen
            .iter()
            .map(|row| forward(&change.applied(&row.joints, axes)))
            .collect();
        let Some(computed) = computed else { continue };
        let mut candidates = vec![change.clone()];
        for frame in [base(screen, &computed), tool(screen, &computed)] {
            candidates.extend(frame.map(|frame| Explanation {
                frame: Some(frame),
                ..change.clone()
            }));
        }
        if quick || change.cost() == 0 {
            candidates.extend(fitted(forward, screen, change, axes));
        }
        for candidate in candidates {
            if candidate.cost() > least {
                continue;
            }
            let Some(differences) = remaining_differences(forward, screen, axes, &candidate) else {
                continue;
            };
            let worst = differences
                .iter()
                .map(|g| tolerance.share(g))
                .fold(0.0, larger);
            let whole = worst <= 1.0
                && remaining_differences(forward, rows, axes, &candidate)
                    .is_some_and(|all| all.iter().all(|g| tolerance.share(g) <= 1.0));
            if whole {
                if candidate.cost() < least {
                    least = candidate.cost();
                    found.fitting.clear();
                }
                if !found.fitting.contains(&candidate) {
                    found.fitting.push(candidate);
                }
            } else if nearest
                .as_ref()
                .is_none_or(|(best, _)| worst < 0.999 * best)
            {
                nearest = Some((worst, candidate));
            }
        }
    }
    if found.fitting.is_empty() {
        found.nearest = nearest.and_then(|(_, e)| {
            let differences = remaining_differences(forward, rows, axes, &e)?;
            Some((e, differences))
        });
    }
    found
}

/// Signs, offsets by quarter turns, couplings and their combinations, without numbers to be fitted.
fn changes(axes: &[Axis], quick: bool) -> Vec<Explanation> {
    let count = axes.len();
    let most_signs = match (quick, count) {
        (true, ..=8) => count,
        (true, _) => 2,
        (false, _) => 1,
    };
    let mut signs: Vec<Vec<usize>> = vec![Vec::new()];
    for axis in 0..count {
        let longer: Vec<Vec<usize>> = signs
            .iter()
            .filter(|s| s.len() < most_signs)
            .map(|s| s.iter().copied().chain([axis]).collect())
            .collect();
        signs.extend(longer);
    }
    let quarter = std::f64::consts::FRAC_PI_2;
    let single: Vec<(usize, f64)> = (0..count)
        .filter(|&i| axes[i].turns)
        .flat_map(|i| [1.0, -1.0, 2.0].map(|n| (i, n * quarter)))
        .collect();
    let mut extras = vec![Explanation::default()];
    extras.extend(single.iter().map(|&o| Explanation {
        offsets: vec![o],
        ..Explanation::default()
    }));
    if quick {
        for (k, &a) in single.iter().enumerate() {
            extras.extend(
                single[k + 1..]
                    .iter()
                    .filter(|b| b.0 != a.0)
                    .map(|&b| Explanation {
                        offsets: vec![a, b],
                        ..Explanation::default()
                    }),
            );
        }
    }
    let mut couplings = Vec::new();
    for (axis, own) in axes.iter().enumerate() {
        for (other, theirs) in axes.iter().enumerate() {
            if own.coupled.iter().any(|c| c.0 == other) {
                couplings.push(Coupling::Reversed { axis, other });
                couplings.push(Coupling::Absent { axis, other });
            } else if other != axis && own.turns == theirs.turns {
                couplings.extend([1.0, -1.0].map(|share| Coupling::Missing { axis, other, share }));
            }
        }
    }
    extras.extend(couplings.into_iter().map(|c| Explanation {
        coupling: Some(c),
        ..Explanation::default()
    }));
    let mut all = Vec::new();
    for reversed in signs {
        for extra in &extras {
            if !quick && !reversed.is_empty() && extra.cost() > 0 {
                continue;
            }
            all.push(Explanation {
                reversed: reversed.clone(),
                ..extra.clone()
            });
        }
    }
    all
}

/// The base frame that brings the computed poses nearest to the measured ones.
fn base(rows: &[MeasuredPose], computed: &[Pose]) -> Option<Frame> {
    if rows.len() < 2 {
        return None;
    }
    if let Some(turns) = rows.iter().map(|r| r.rotation).collect::<Option<Vec<_>>>() {
        let rotation = mean(
            turns
                .iter()
                .zip(computed)
                .map(|(t, c)| t * c.rotation.inverse()),
        );
        let n = rows.len() as f64;
        let shift = rows
            .iter()
            .zip(computed)
            .map(|(r, c)| r.position - rotation * c.translation.vector)
            .sum::<Vector3<f64>>()
            / n;
        return Some(Frame::Base(Pose::from_parts(shift.into(), rotation)));
    }
    // Positions alone: the rotation between two clouds of points [Kabsch].
    if rows.len() < 4 {
        return None;
    }
    let there: Vec<Vector3<f64>> = rows.iter().map(|r| r.position).collect();
    let here = computed.iter().map(|c| c.translation.vector);
    rigid_motion(&here.collect::<Vec<_>>(), &there).map(Frame::Base)
}

/// The frame behind the tool that brings the computed poses nearest to the measured ones.
fn tool(rows: &[MeasuredPose], computed: &[Pose]) -> Option<Frame> {
    if rows.len() < 2 {
        return None;
    }
    let n = rows.len() as f64;
    let turns = rows.iter().map(|r| r.rotation).collect::<Option<Vec<_>>>();
    let rotation = turns.map_or_else(UnitQuaternion::identity, |turns| {
        mean(
            turns
                .iter()
                .zip(computed)
                .map(|(t, c)| c.rotation.inverse() * t),
        )
    });
    let shift = rows
        .iter()
        .zip(computed)
        .map(|(r, c)| c.rotation.inverse() * (r.position - c.translation.vector))
        .sum::<Vector3<f64>>()
        / n;
    Some(Frame::Tool(Pose::from_parts(shift.into(), rotation)))
}

/// The rotation nearest to several ones.
fn mean(turns: impl Iterator<Item = UnitQuaternion<f64>>) -> UnitQuaternion<f64> {
    let sum = turns.fold(Matrix3::zeros(), |s, q| {
        s + q.to_rotation_matrix().into_inner()
    });
    nearest_rotation(&sum).unwrap_or_default()
}

/// One more offset, of any size, for each axis: Newton's iteration on that number alone.
fn fitted(
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
