//! What explains the difference between poses that were jogged and poses that were computed: a sign,
//! an offset, a coupling, a frame. Knows no files and no words.
//!
//! Every explanation is a small change of what the pendant is taken to show, or one constant frame. All
//! small changes are tried in the order of their number, so that a simpler one is found first, and all
//! that fit equally are told: three poses settle the usual cases, but not every set of three.

use kinetostat::{Pose, pose_residual};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, UnitQuaternion, Vector3};

/// A pose that was measured: joints as the pendant shows them (m, rad) and the tool's place.
#[derive(Clone, Debug)]
pub(crate) struct Jogged {
    pub(crate) joints: Vec<f64>,
    pub(crate) position: Vector3<f64>,
    pub(crate) rotation: Option<UnitQuaternion<f64>>,
}

/// A difference of two poses, m and rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Gap {
    pub(crate) distance: f64,
    /// None where no orientation was measured.
    pub(crate) angle: Option<f64>,
}

/// What counts as the same place, m and rad.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tolerance {
    pub(crate) distance: f64,
    pub(crate) angle: f64,
}

impl Tolerance {
    /// The larger of both differences, 1 at the tolerance.
    fn share(&self, gap: &Gap) -> f64 {
        let angle = gap.angle.unwrap_or(0.0) / self.angle;
        (gap.distance / self.distance).max(angle)
    }
}

/// A frame that is elsewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Frame {
    /// Model's base from the machine's: measured = base * computed.
    Base(Pose),
    /// Behind the model's tool: measured = computed * tool.
    Tool(Pose),
}

/// An axis of the pendant, as the file declares it; m and rad.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    pub(crate) turns: bool,
    /// What it shows while the model's joints are at zero.
    pub(crate) zero: f64,
    /// What it shows per unit of its own joint.
    pub(crate) ratio: f64,
    /// Axes whose joints it shows too, with what it shows per unit of theirs. Only axes that show
    /// nothing but their own joint.
    pub(crate) coupled: Vec<(usize, f64)>,
}

/// What is taken to be wrong about the coupling of an axis with the joint of another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Coupling {
    /// None is declared; to what is shown the other axis' joint has to be added, `share` times.
    Missing {
        axis: usize,
        other: usize,
        share: f64,
    },
    /// Declared, and the machine has it with the other sign.
    Reversed { axis: usize, other: usize },
    /// Declared, and the machine has none.
    Absent { axis: usize, other: usize },
}

/// What the pendant is taken to show instead: `s x + o`, one axis with a share of another; and a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Explanation {
    pub(crate) reversed: Vec<usize>,
    /// Axis and offset, m or rad.
    pub(crate) offsets: Vec<(usize, f64)>,
    pub(crate) coupling: Option<Coupling>,
    pub(crate) frame: Option<Frame>,
}

impl Explanation {
    /// What the pendant would show if the machine were as the file declares it. The machine shows
    /// `x = s a q + k c p + z` for its joint `q` and the coupled joint `p`, the file says
    /// `a q + c p + z`: that is `s (x - z) + z + (1 - s k) c p`.
    fn applied(&self, joints: &[f64], axes: &[Axis]) -> Vec<f64> {
        let mut out = joints.to_vec();
        for &i in &self.reversed {
            out[i] = 2.0 * axes[i].zero - joints[i];
        }
        for &(i, by) in &self.offsets {
            out[i] += by;
        }
        // Only axes without a coupling of their own are read here: they are done already.
        let joint = |out: &[f64], j: usize| (out[j] - axes[j].zero) / axes[j].ratio;
        for (i, axis) in axes.iter().enumerate() {
            for &(j, ratio) in &axis.coupled {
                let sign = if self.reversed.contains(&i) {
                    -1.0
                } else {
                    1.0
                };
                let has = match self.coupling {
                    Some(Coupling::Reversed { axis, other }) if (axis, other) == (i, j) => -1.0,
                    Some(Coupling::Absent { axis, other }) if (axis, other) == (i, j) => 0.0,
                    _ => 1.0,
                };
                let missing = 1.0 - sign * has;
                if missing != 0.0 {
                    out[i] += missing * ratio * joint(&out, j);
                }
            }
        }
        if let Some(Coupling::Missing { axis, other, share }) = self.coupling {
            out[axis] += share * (out[other] - axes[other].zero);
        }
        out
    }

    /// Fewer and plainer changes first; a fitted number is dearer than a quarter turn.
    fn cost(&self) -> usize {
        let offsets: usize = self
            .offsets
            .iter()
            .map(|o| if quarter(o.1) { 2 } else { 3 })
            .sum();
        2 * self.reversed.len()
            + offsets
            + 2 * usize::from(self.coupling.is_some())
            + 3 * usize::from(self.frame.is_some())
    }
}

/// A whole number of quarter turns.
fn quarter(angle: f64) -> bool {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    (quarters - quarters.round()).abs() < 1e-6
}

/// The search's answer.
#[derive(Clone, Debug)]
pub(crate) struct Explained {
    /// All of the smallest number of changes that fit; several where the poses do not decide.
    pub(crate) fitting: Vec<Explanation>,
    /// The best of those tried where none fits, with the differences that it leaves.
    pub(crate) nearest: Option<(Explanation, Vec<Gap>)>,
}

/// Where the model's tool is for what the pendant shows (m, rad).
pub(crate) type Forward<'a> = dyn Fn(&[f64]) -> Option<Pose> + 'a;

pub(crate) fn gap(measured: &Jogged, computed: &Pose) -> Gap {
    let target = Pose::from_parts(
        measured.position.into(),
        measured.rotation.unwrap_or(computed.rotation),
    );
    let residual = pose_residual(&target, computed);
    Gap {
        distance: residual.linear().norm(),
        angle: measured.rotation.map(|_| residual.angular().norm()),
    }
}

/// The differences that an explanation leaves; `None` where the machine cannot stand there.
pub(crate) fn left(
    forward: &Forward<'_>,
    rows: &[Jogged],
    axes: &[Axis],
    e: &Explanation,
) -> Option<Vec<Gap>> {
    let each = rows.iter().map(|row| {
        let computed = forward(&e.applied(&row.joints, axes))?;
        Some(gap(
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

/// Rows that screen an explanation before all are asked.
const SCREEN: usize = 8;

/// Tries explanations; `quick` says that the machine is a plain product, so
/// that thousands can be tried.
pub(crate) fn explain(
    forward: &Forward<'_>,
    rows: &[Jogged],
    axes: &[Axis],
    quick: bool,
    tolerance: Tolerance,
) -> Explained {
    let mut found = Explained {
        fitting: Vec::new(),
        nearest: None,
    };
    let screen = &rows[..rows.len().min(SCREEN)];
    let mut nearest: Option<(f64, Explanation)> = None;
    let mut least = usize::MAX;
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
            let Some(gaps) = left(forward, screen, axes, &candidate) else {
                continue;
            };
            let worst = gaps.iter().map(|g| tolerance.share(g)).fold(0.0, f64::max);
            let whole = worst <= 1.0
                && left(forward, rows, axes, &candidate)
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
            let gaps = left(forward, rows, axes, &e)?;
            Some((e, gaps))
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
fn base(rows: &[Jogged], computed: &[Pose]) -> Option<Frame> {
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
    let n = rows.len() as f64;
    let there = rows.iter().map(|r| r.position).sum::<Vector3<f64>>() / n;
    let here = computed
        .iter()
        .map(|c| c.translation.vector)
        .sum::<Vector3<f64>>()
        / n;
    let mut h = Matrix3::zeros();
    for (r, c) in rows.iter().zip(computed) {
        h += (r.position - there) * (c.translation.vector - here).transpose();
    }
    let rotation = nearest_rotation(&h)?;
    let shift = there - rotation * here;
    Some(Frame::Base(Pose::from_parts(shift.into(), rotation)))
}

/// The frame behind the tool that brings the computed poses nearest to the measured ones.
fn tool(rows: &[Jogged], computed: &[Pose]) -> Option<Frame> {
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

fn nearest_rotation(m: &Matrix3<f64>) -> Option<UnitQuaternion<f64>> {
    let own = kinetostat::SingularValues::of(m);
    // Points on a line leave a turn about it open.
    if own.rank(1e-9) < 2 {
        return None;
    }
    let u = Matrix3::from_iterator(own.left.iter().copied());
    let v_t = Matrix3::from_iterator(own.right.iter().copied()).transpose();
    let mut sign = Matrix3::identity();
    sign[(2, 2)] = (u * v_t).determinant().signum();
    let rotation = Rotation3::from_matrix_unchecked(u * sign * v_t);
    Some(UnitQuaternion::from_rotation_matrix(&rotation))
}

/// One more offset, of any size, for each axis: Newton's iteration on that number alone.
fn fitted(
    forward: &Forward<'_>,
    rows: &[Jogged],
    change: &Explanation,
    axes: &[Axis],
) -> Vec<Explanation> {
    if !change.offsets.is_empty() || change.coupling.is_some() || change.reversed.len() > 1 {
        return Vec::new();
    }
    let miss = |e: &Explanation| -> Option<DVector<f64>> {
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
                    miss(&with(axis, by)),
                    miss(&with(axis, by + 1e-6)),
                    miss(&with(axis, by - 1e-6)),
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
            let size = miss(&with(axis, by)).map_or(f64::INFINITY, |m| m.norm());
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
