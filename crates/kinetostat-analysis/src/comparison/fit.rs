//! Two chains of joints: is one the other with its base, its tool and its zeros elsewhere?
//!
//! `T_a(q) = base * T_b(s q + o) * tool` for all `q`, signs `s`, offsets `o`. For given signs the axes
//! are laid upon each other one after the other, which gives offsets near the right ones; a least
//! squares fit over many postures decides. Where a joint's offset and a frame do the same (the first
//! joint and the base, the last one and the tool), frames are left alone first.

use std::f64::consts::TAU;

use kinetostat::linalg::SingularValues;
use kinetostat::number::{larger, smaller};
use kinetostat::spatial::{moved, pose_residual};
use kinetostat::{MotionKind, Pose, Twist};
use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3, Vector6};

/// The tool in the base for commands in m and rad.
type Forward<'a> = dyn Fn(&[f64]) -> Option<Pose> + 'a;

/// The question: two sides, the kinds of their joints, postures of `a`, and the length that makes
/// angles comparable.
pub(crate) struct Fit<'a> {
    pub(crate) a: &'a Forward<'a>,
    pub(crate) b: &'a Forward<'a>,
    pub(crate) kinds: &'a [MotionKind],
    pub(crate) postures: &'a [Vec<f64>],
    /// Tool of `a` at those postures.
    pub(crate) targets: Vec<Pose>,
    pub(crate) length: f64,
    /// Share of the length below which two machines are the same.
    pub(crate) same: f64,
    /// Thousands of postures can be requested.
    pub(crate) quick: bool,
}

impl Fit<'_> {
    /// The best mapping; `None` where nothing could be computed.
    pub(crate) fn run(&self) -> Option<Mapping> {
        let count = self.kinds.len();
        let mut rough: Vec<(f64, Mapping)> = Vec::new();
        for signs in sign_patterns(count, self.quick) {
            let start = match self.quick {
                true => self.laid(&signs),
                false => None,
            }
            .unwrap_or_else(|| Mapping {
                signs: signs.clone(),
                offsets: vec![0.0; count],
                base: Pose::identity(),
                tool: Pose::identity(),
                largest_difference: (f64::INFINITY, f64::INFINITY),
            });
            if let Some(size) = self.size(&start) {
                rough.push((size, start));
            }
        }
        // Stable: fewer reversed joints come first among equals.
        rough.sort_by(|x, y| x.0.total_cmp(&y.0));
        let kept = if self.quick { 8 } else { 3 };
        let mut others: Vec<Mapping> = Vec::new();
        let mut same: Vec<Mapping> = Vec::new();
        for (_, start) in rough.into_iter().take(kept) {
            let found = match self.with_difference(start.clone()) {
                Some(exact) if self.is_same(&exact) => Some(exact),
                _ => self.refined(start),
            };
            match found {
                Some(found) if self.is_same(&found) => same.push(found),
                Some(found) => others.push(found),
                None => {}
            }
            if !self.quick && !same.is_empty() {
                break;
            }
        }
        let plain = same.into_iter().map(|m| self.plainest(m));
        if let Some(plain) = plain.min_by_key(Mapping::changes) {
            return Some(plain);
        }
        // Prefers, among mappings with about the same residual, the one that reverses fewest joints.
        let least = others
            .iter()
            .map(|m| self.rank(m))
            .fold(f64::INFINITY, smaller);
        others.retain(|m| self.rank(m) <= 1.2 * least);
        others
            .into_iter()
            .min_by_key(|m| m.signs.iter().filter(|s| **s < 0.0).count())
    }

    fn is_same(&self, m: &Mapping) -> bool {
        self.rank(m) < self.same * self.length
    }

    fn rank(&self, m: &Mapping) -> f64 {
        m.largest_difference
            .0
            .max(self.length * m.largest_difference.1)
    }

    /// Returns an equal mapping with as few frames moved as possible: a base displacement along the first joint, or a
    /// tool displacement along the last one, becomes that joint's offset where it is the whole displacement of the
    /// frame.
    fn plainest(&self, full: Mapping) -> Mapping {
        let last = full.offsets.len() - 1;
        let zero = vec![0.0; last + 1];
        let (Some(a), Some(b), Some(there)) = (
            self.axes(self.a, &zero),
            self.axes(self.b, &full.offsets),
            (self.b)(&full.offsets),
        ) else {
            return full;
        };
        let along = |pose: &Pose, axis: &Vector3<f64>, kind: MotionKind| match kind {
            MotionKind::Prismatic => axis.dot(&pose.translation.vector),
            MotionKind::Revolute => {
                let q = pose.rotation;
                2.0 * axis.dot(&q.imag()).atan2(q.w)
            }
        };
        let mut by_first = full.clone();
        by_first.offsets[0] += full.signs[0] * along(&full.base, &a[0].0, self.kinds[0]);
        by_first.base = Pose::identity();
        let mut by_last = full.clone();
        let own = there.rotation.inverse() * b[last].0;
        by_last.offsets[last] += along(&full.tool, &own, self.kinds[last]);
        by_last.tool = Pose::identity();
        let mut by_both = by_first.clone();
        if last > 0 {
            by_both.offsets[last] = by_last.offsets[last];
        }
        by_both.tool = Pose::identity();
        let tried = [by_both, by_first, by_last];
        let fits = tried.into_iter().filter_map(|m| {
            let m = self.with_difference(self.reduced(m))?;
            self.is_same(&m).then_some(m)
        });
        let full = self.reduced(full);
        match fits.min_by_key(Mapping::changes) {
            Some(plain) if plain.changes() < full.changes() => plain,
            _ => full,
        }
    }

    /// Angles in (-pi, pi].
    fn reduced(&self, mut m: Mapping) -> Mapping {
        for (offset, kind) in m.offsets.iter_mut().zip(self.kinds) {
            if *kind == MotionKind::Revolute {
                *offset -= TAU * (*offset / TAU).round();
            }
        }
        m
    }

    /// Differences over all postures, scaled.
    fn residual(&self, m: &Mapping) -> Option<DVector<f64>> {
        let mut all = Vec::with_capacity(6 * self.postures.len());
        for (q, a) in self.postures.iter().zip(&self.targets) {
            let b = m.base * (self.b)(&m.joints(q))? * m.tool;
            let difference = pose_residual(a, &b);
            all.extend(difference.linear().iter());
            all.extend(difference.angular().iter().map(|x| self.length * x));
        }
        Some(DVector::from_vec(all))
    }

    fn size(&self, m: &Mapping) -> Option<f64> {
        self.residual(m).map(|v| v.norm())
    }

    fn with_difference(&self, mut m: Mapping) -> Option<Mapping> {
        let residual = self.residual(&m)?;
        let mut left = (0.0_f64, 0.0_f64);
        for difference in residual.as_slice().chunks(6) {
            let size = |part: &[f64]| part.iter().map(|x| x * x).sum::<f64>().sqrt();
            left.0 = larger(left.0, size(&difference[..3]));
            left.1 = larger(left.1, size(&difference[3..]) / self.length);
        }
        m.largest_difference = left;
        Some(m)
    }

    /// Refines a mapping by damped Gauss-Newton least squares.
    fn refined(&self, mut at: Mapping) -> Option<Mapping> {
        let mut residual = self.residual(&at)?;
        let mut damping = 1e-6;
        for _ in 0..if self.quick { 40 } else { 8 } {
            let before = residual.norm();
            if before < 1e-13 * self.length {
                break;
            }
            let count = 12 + self.inner().len();
            let h = 1e-6;
            let mut columns = Vec::with_capacity(count);
            for k in 0..count {
                let up = self.residual(&self.changed(&at, k, h))?;
                let down = self.residual(&self.changed(&at, k, -h))?;
                columns.push((up - down) / (2.0 * h));
            }
            if columns.is_empty() {
                break;
            }
            let jacobian = DMatrix::from_columns(&columns);
            let normal = jacobian.transpose() * &jacobian;
            let gradient = jacobian.transpose() * &residual;
            let scale = normal.diagonal().max().max(f64::MIN_POSITIVE);
            let mut better = false;
            for _ in 0..12 {
                let mut damped = normal.clone();
                for i in 0..count {
                    damped[(i, i)] += damping * scale;
                }
                let Some(step) = damped.cholesky().map(|c| c.solve(&gradient)) else {
                    damping *= 10.0;
                    continue;
                };
                let mut trial = at.clone();
                for k in 0..count {
                    trial = self.changed(&trial, k, -step[k]);
                }
                match self.residual(&trial) {
                    Some(next) if next.norm() < before => {
                        (at, residual) = (trial, next);
                        damping = (damping * 0.1).max(1e-14);
                        better = true;
                        break;
                    }
                    _ => damping *= 10.0,
                }
            }
            if !better || residual.norm() > (1.0 - 1e-6) * before {
                break;
            }
        }
        self.with_difference(self.reduced(at))
    }

    /// Joints whose offsets no frame can take over.
    fn inner(&self) -> std::ops::Range<usize> {
        let count = self.kinds.len();
        1..count.max(2) - 1
    }

    /// Changes parameter `k` of the fit by `by`; the order is inner offsets, base, tool.
    fn changed(&self, m: &Mapping, k: usize, by: f64) -> Mapping {
        let mut out = m.clone();
        let inner = self.inner();
        if k < inner.len() {
            out.offsets[inner.start + k] += by;
            return out;
        }
        let k = k - inner.len();
        let mut twist = Vector6::zeros();
        twist[k % 6] = by;
        let frame = if k < 6 { &mut out.base } else { &mut out.tool };
        *frame = moved(frame, &Twist(twist));
        out
    }

    /// Directions and points of all joint axes at a posture, in the base.
    fn axes(&self, forward: &Forward<'_>, q: &[f64]) -> Option<Vec<(Vector3<f64>, Vector3<f64>)>> {
        let h = 1e-5;
        let tool = forward(q)?;
        (0..q.len())
            .map(|i| {
                let at = |by: f64| {
                    let mut moved = q.to_vec();
                    moved[i] += by;
                    forward(&moved)
                };
                let twist = Twist(pose_residual(&at(h)?, &at(-h)?).0 / (2.0 * h));
                let (v, w) = (twist.linear(), twist.angular());
                Some(match self.kinds[i] {
                    MotionKind::Prismatic => (v.try_normalize(1e-9)?, tool.translation.vector),
                    MotionKind::Revolute => (
                        w.try_normalize(1e-9)?,
                        tool.translation.vector + w.cross(&v) / w.norm_squared(),
                    ),
                })
            })
            .collect()
    }

    /// Lays the axes of `b` upon those of `a`, from the base on, each turn taken by the joint before.
    fn laid(&self, signs: &[f64]) -> Option<Mapping> {
        let count = self.kinds.len();
        let zero = vec![0.0; count];
        let a = self.axes(self.a, &zero)?;
        let mut offsets = vec![0.0; count];
        let first = self.axes(self.b, &offsets)?;
        let mut turn = UnitQuaternion::rotation_between(&(first[0].0 * signs[0]), &a[0].0)
            .unwrap_or_else(|| half_turn(&a[0].0));
        // Undetermined rotation: about this axis of `a`, by this joint (`None`: by the base).
        let mut open: Option<(usize, Option<usize>)> = Some((0, None));
        for j in 1..count {
            let b = self.axes(self.b, &offsets)?;
            if let Some((axis, owner)) = open {
                let u = a[axis].0;
                let square = |v: Vector3<f64>| v - u * u.dot(&v);
                let mut from = square(turn * (b[j].0 * signs[j]));
                let mut to = square(a[j].0);
                if to.norm() < 1e-6 {
                    // Parallel: by where the axes are.
                    from = square(turn * (b[j].1 - b[axis].1));
                    to = square(a[j].1 - a[axis].1);
                }
                if from.norm() > 1e-6 * self.length && to.norm() > 1e-6 * self.length {
                    let angle = u.dot(&from.cross(&to)).atan2(from.dot(&to));
                    match owner {
                        None => turn = UnitQuaternion::from_scaled_axis(u * angle) * turn,
                        // The turn is about the axis of `b`, which is `signs` times that of `a`.
                        Some(joint) => offsets[joint] += signs[joint] * angle,
                    }
                    open = None;
                }
            }
            if open.is_none() && self.kinds[j] == MotionKind::Revolute {
                open = Some((j, Some(j)));
            }
        }
        let mut mapping = Mapping {
            signs: signs.to_vec(),
            offsets,
            base: Pose::from_parts(Vector3::zeros().into(), turn),
            tool: Pose::identity(),
            largest_difference: (f64::INFINITY, f64::INFINITY),
        };
        // The base's place from the axes, then the tool from a posture.
        mapping.base.translation.vector = self.shift(&mapping, &a)?;
        let q = self.postures.first()?;
        let there = mapping.base * (self.b)(&mapping.joints(q))?;
        mapping.tool = there.inverse() * self.targets.first()?;
        Some(mapping)
    }

    /// Translation of the base that brings the axes that turn nearest to each other.
    fn shift(&self, m: &Mapping, a: &[(Vector3<f64>, Vector3<f64>)]) -> Option<Vector3<f64>> {
        let b = self.axes(self.b, &m.offsets)?;
        let mut matrix = Matrix3::zeros();
        let mut right = Vector3::zeros();
        for i in (0..a.len()).filter(|&i| self.kinds[i] == MotionKind::Revolute) {
            let u = a[i].0;
            let square = Matrix3::identity() - u * u.transpose();
            matrix += square;
            right += square * (a[i].1 - m.base.rotation * b[i].1);
        }
        let right = DVector::from_column_slice(right.as_slice());
        let shift = SingularValues::of(&matrix).shortest(&right, 1e-9);
        Some(Vector3::new(shift[0], shift[1], shift[2]))
    }
}

/// A half turn that reverses a direction.
fn half_turn(v: &Vector3<f64>) -> UnitQuaternion<f64> {
    let helper = if v.x.abs() < 0.9 {
        Vector3::x()
    } else {
        Vector3::y()
    };
    UnitQuaternion::from_scaled_axis(v.cross(&helper).normalize() * std::f64::consts::PI)
}

/// All patterns of up to ten joints, the fewest reversed first; else none, one and all.
fn sign_patterns(count: usize, quick: bool) -> Vec<Vec<f64>> {
    let mut list: Vec<Vec<f64>> = if quick && count <= 10 {
        (0..1_usize << count)
            .map(|bits| {
                (0..count)
                    .map(|i| if bits >> i & 1 == 1 { -1.0 } else { 1.0 })
                    .collect()
            })
            .collect()
    } else {
        let one = |k: usize| {
            (0..count)
                .map(|i| if i == k { -1.0 } else { 1.0 })
                .collect()
        };
        let mut list: Vec<Vec<f64>> = vec![vec![1.0; count], vec![-1.0; count]];
        list.extend((0..count).map(one));
        list
    };
    list.sort_by_key(|s: &Vec<f64>| s.iter().filter(|x| **x < 0.0).count());
    list
}

/// Mapping of machine `b` to machine `a`: `T_a(q) = base * T_b(s q + o) * tool` for all `q`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    /// -1 or 1 for each joint.
    pub signs: Vec<f64>,
    /// m or rad, added to `b`'s joint.
    pub offsets: Vec<f64>,
    /// Base of `a` from base of `b`.
    pub base: Pose,
    /// Tool of `b` from tool of `a`.
    pub tool: Pose,
    /// Largest difference left over all postures, m and rad.
    pub largest_difference: (f64, f64),
}

impl Mapping {
    /// The joints of `b` where those of `a` are, m or rad.
    #[must_use]
    pub fn joints(&self, a: &[f64]) -> Vec<f64> {
        let both = self.signs.iter().zip(&self.offsets);
        both.zip(a).map(|((s, o), q)| s * q + o).collect()
    }

    /// Fewer reversed joints, moved zeros and frames are plainer.
    pub(crate) fn changes(&self) -> usize {
        let frame = |p: &Pose| {
            usize::from(p.translation.vector.norm() > 1e-7 || p.rotation.angle() > 1e-7) * 3
        };
        2 * self.signs.iter().filter(|s| **s < 0.0).count()
            + self.offsets.iter().filter(|o| o.abs() > 1e-7).count()
            + frame(&self.base)
            + frame(&self.tool)
    }
}
