//! The search for explanations, the simplest first.

use kinetostat::Pose;
use kinetostat::number::larger;

use crate::measured_poses::changes::changes;
use crate::measured_poses::explanation::{Axis, Explanation, Forward, Frame};
use crate::measured_poses::frames::{base, tool};
use crate::measured_poses::measurement::{Difference, MeasuredPose, Tolerance, difference};
use crate::measured_poses::offset::fitted;

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
