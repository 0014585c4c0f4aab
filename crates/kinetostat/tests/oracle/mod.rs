//! Slow, independent answers: kinematics by products of homogeneous rotations written out here,
//! Hessians in column form, and the equilibrium of all limbs and platforms as one dense flattened
//! system whose tangent is taken by central differences.
//!
//! Nothing of the core's kinematics, load terms, saddle solver or platform condensation is used;
//! only the description of chains and mechanisms and the algebra of poses is shared.

use kinetostat::{
    Anchor, Chain, Mechanism, MotionKind, PlatformLoad, Pose, Wrench, model::Element,
};
use kinetostat_testing::{LargestEntry, Worst};
use nalgebra::{DMatrix, DVector, Matrix3, Matrix6, UnitQuaternion, Vector3, Vector6};

/// Rotation by `angle` about the unit vector `axis`, Rodrigues' formula written out.
fn rodrigues(axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    let v = 1.0 - c;
    let (x, y, z) = (axis.x, axis.y, axis.z);
    Matrix3::new(
        c + x * x * v,
        x * y * v - z * s,
        x * z * v + y * s,
        y * x * v + z * s,
        c + y * y * v,
        y * z * v - x * s,
        z * x * v - y * s,
        z * y * v + x * s,
        c + z * z * v,
    )
}

/// Rotation vector of a rotation matrix, from its skew part (angles below pi).
fn log_rotation(r: &Matrix3<f64>) -> Vector3<f64> {
    let v = 0.5
        * Vector3::new(
            r[(2, 1)] - r[(1, 2)],
            r[(0, 2)] - r[(2, 0)],
            r[(1, 0)] - r[(0, 1)],
        );
    let s = v.norm();
    let t = s.atan2(0.5 * (r.trace() - 1.0));
    if s < 1e-5 {
        v * (1.0 + t * t / 6.0)
    } else {
        v * (t / s)
    }
}

struct Column {
    revolute: bool,
    axis: Vector3<f64>,
    point: Vector3<f64>,
    coordinate: Option<(usize, f64)>,
}

/// Frames of a chain.
pub struct Frames {
    columns: Vec<Column>,
    /// Rotation, position, number of motions before.
    nodes: Vec<(Matrix3<f64>, Vector3<f64>, usize)>,
    n: usize,
}

impl Frames {
    pub fn new(chain: &Chain, base: &Pose, coordinates: &[f64], commands: &[f64]) -> Self {
        let mut r = *base.rotation.to_rotation_matrix().matrix();
        let mut p = base.translation.vector;
        let (mut columns, mut nodes) = (Vec::new(), Vec::new());
        for element in chain.elements() {
            match element {
                Element::Rigid(pose) => {
                    p += r * pose.translation.vector;
                    r *= pose.rotation.to_rotation_matrix().matrix();
                }
                Element::Node(_) => nodes.push((r, p, columns.len())),
                Element::Motion(m) => {
                    let axis = r * m.axis.into_inner();
                    let mut s = 0.0;
                    if let Some(d) = m.coordinate {
                        s += d.ratio * coordinates[d.index];
                    }
                    if let Some(d) = m.command {
                        s += d.ratio * commands[d.index];
                    }
                    let revolute = m.kind == MotionKind::Revolute;
                    columns.push(Column {
                        revolute,
                        axis,
                        point: p,
                        coordinate: m.coordinate.map(|d| (d.index, d.ratio)),
                    });
                    if revolute {
                        r *= rodrigues(&m.axis, s);
                    } else {
                        p += axis * s;
                    }
                }
            }
        }
        Self {
            columns,
            nodes,
            n: chain.coordinate_count(),
        }
    }

    pub fn tip(&self) -> usize {
        self.nodes.len() - 1
    }

    pub fn position(&self, node: usize) -> Vector3<f64> {
        self.nodes[node].1
    }

    /// `[p* - p; log(R* R^T)]` at a node.
    pub fn pose_residual(&self, node: usize, target: &Pose) -> Vector6<f64> {
        let (r, p, _) = self.nodes[node];
        let d = target.translation.vector - p;
        let w = log_rotation(&(target.rotation.to_rotation_matrix().matrix() * r.transpose()));
        Vector6::new(d.x, d.y, d.z, w.x, w.y, w.z)
    }

    fn twists(&self, node: usize) -> Vec<(Vector3<f64>, Vector3<f64>)> {
        let (_, p, before) = self.nodes[node];
        self.columns[..before]
            .iter()
            .map(|c| {
                if c.revolute {
                    (c.axis.cross(&(p - c.point)), c.axis)
                } else {
                    (c.axis, Vector3::zeros())
                }
            })
            .collect()
    }

    /// 6 x n.
    pub fn jacobian(&self, node: usize) -> DMatrix<f64> {
        let mut j = DMatrix::zeros(6, self.n);
        for (c, (v, w)) in self.columns.iter().zip(self.twists(node)) {
            if let Some((i, ratio)) = c.coordinate {
                for k in 0..3 {
                    j[(k, i)] += ratio * v[k];
                    j[(3 + k, i)] += ratio * w[k];
                }
            }
        }
        j
    }

    /// `sum_j J_j^T G_j`.
    pub fn torque(&self, wrenches: &[(usize, Wrench)]) -> DVector<f64> {
        wrenches
            .iter()
            .fold(DVector::zeros(self.n), |sum, (node, w)| {
                sum + self.jacobian(*node).transpose() * w.0
            })
    }

    /// `d(sum_j J_j^T G_j)/dx`, dead wrenches, column form: a motion nearer the base turns the
    /// column, one farther out moves the point.
    pub fn hessian(&self, wrenches: &[(usize, Wrench)]) -> DMatrix<f64> {
        let mut h = DMatrix::zeros(self.n, self.n);
        for (node, wrench) in wrenches {
            let (f, m) = (wrench.force(), wrench.moment());
            let t = self.twists(*node);
            for (i, (vi, wi)) in t.iter().enumerate() {
                let Some((a, ra)) = self.columns[i].coordinate else {
                    continue;
                };
                for (j, (vj, wj)) in t.iter().enumerate() {
                    let Some((b, rb)) = self.columns[j].coordinate else {
                        continue;
                    };
                    let value = if j <= i {
                        f.dot(&wj.cross(vi)) + m.dot(&wj.cross(wi))
                    } else {
                        f.dot(&wi.cross(vj))
                    };
                    h[(a, b)] += ra * rb * value;
                }
            }
        }
        h
    }
}

/// Torque of all springs, their matrix and their energy at `x`; `posture` decides what depends on it.
pub fn springs(chain: &Chain, x: &[f64], posture: &[f64]) -> (DVector<f64>, DMatrix<f64>, f64) {
    let n = chain.coordinate_count();
    let mut k = DMatrix::zeros(n, n);
    let mut deflection = DVector::zeros(n);
    for block in chain.springs() {
        let own = block.stiffness_at(posture);
        for i in 0..block.len() {
            deflection[block.first + i] = x[block.first + i] - block.rest[i];
            for j in 0..block.len() {
                k[(block.first + i, block.first + j)] = own[(i, j)];
            }
        }
    }
    let torque = &k * &deflection;
    let energy = 0.5 * torque.dot(&deflection);
    (torque, k, energy)
}

/// `K_C` of a chain from the bordered system at a given state, dense, rows scaled.
pub fn chain_stiffness(
    chain: &Chain,
    frames: &Frames,
    k: &DMatrix<f64>,
    wrenches: &[(usize, Wrench)],
) -> Matrix6<f64> {
    let n = chain.coordinate_count();
    let j = frames.jacobian(frames.tip());
    let h = frames.hessian(wrenches);
    let mut a = DMatrix::zeros(6 + n, 6 + n);
    a.view_mut((0, 6), (6, n)).copy_from(&j);
    a.view_mut((6, 0), (n, 6)).copy_from(&j.transpose());
    a.view_mut((6, 6), (n, n)).copy_from(&(h - k));
    let mut b = DMatrix::zeros(6 + n, 6);
    b.view_mut((0, 0), (6, 6)).fill_with_identity();
    let x = scaled_solve(&a, &b);
    x.fixed_view::<6, 6>(0, 0).into_owned()
}

/// Solves `A X = B` after equilibrating rows and columns, with full pivoting.
pub fn scaled_solve(a: &DMatrix<f64>, b: &DMatrix<f64>) -> DMatrix<f64> {
    let n = a.nrows();
    let (mut row, mut column) = (vec![1.0_f64; n], vec![1.0_f64; n]);
    let mut s = a.clone();
    for _ in 0..12 {
        for i in 0..n {
            let m = s.row(i).largest_entry();
            if m > 0.0 {
                let f = 1.0 / m.sqrt();
                s.row_mut(i).scale_mut(f);
                row[i] *= f;
            }
        }
        for j in 0..n {
            let m = s.column(j).largest_entry();
            if m > 0.0 {
                let f = 1.0 / m.sqrt();
                s.column_mut(j).scale_mut(f);
                column[j] *= f;
            }
        }
    }
    let mut rhs = b.clone();
    for i in 0..n {
        rhs.row_mut(i).scale_mut(row[i]);
    }
    let mut x = s
        .full_piv_lu()
        .solve(&rhs)
        .expect("oracle: singular system");
    for i in 0..n {
        x.row_mut(i).scale_mut(column[i]);
    }
    x
}

/// A mechanism flattened: poses of the moving platforms, then per limb six wrench components and
/// its coordinates.
#[derive(Clone)]
pub struct Flat<'m> {
    pub mechanism: &'m Mechanism,
    pub commands: Vec<Vec<f64>>,
    pub posture: Vec<Vec<f64>>,
    pub platforms: Vec<Pose>,
    pub wrenches: Vec<Vector6<f64>>,
    pub coordinates: Vec<Vec<f64>>,
    /// Wrench on the tool, about its origin.
    pub load: Vector6<f64>,
}

impl<'m> Flat<'m> {
    /// At rest for a posture.
    pub fn at_rest(posture: &'m kinetostat::Posture) -> Self {
        let m = posture.mechanism();
        let start = posture.rest_state();
        Self {
            mechanism: m,
            commands: posture.limbs().iter().map(|l| l.commands.clone()).collect(),
            posture: posture
                .limbs()
                .iter()
                .map(|l| l.coordinates.clone())
                .collect(),
            platforms: start.platforms,
            wrenches: vec![Vector6::zeros(); m.limbs().len()],
            coordinates: start.coordinates,
            load: Vector6::zeros(),
        }
    }

    /// At a state of the core.
    pub fn at_state(
        posture: &'m kinetostat::Posture,
        state: &kinetostat::machine::MechanismState,
        load: &Wrench,
    ) -> Self {
        Self {
            platforms: state.platforms.clone(),
            wrenches: state.wrenches.iter().map(|w| w.0).collect(),
            coordinates: state.coordinates.clone(),
            load: load.0,
            ..Self::at_rest(posture)
        }
    }

    fn size(&self) -> usize {
        6 * (self.platforms.len() - 1) + self.coordinates.iter().map(|x| 6 + x.len()).sum::<usize>()
    }

    /// Rows: equilibrium of every moving platform, then closure and torques of every limb.
    pub fn residual(&self) -> DVector<f64> {
        let m = self.mechanism;
        let gravity = m.gravity();
        let mut rows = DVector::zeros(self.size());
        let mut at = 6 * (self.platforms.len() - 1);
        let put = |rows: &mut DVector<f64>, platform: usize, w: Vector6<f64>| {
            if platform > 0 {
                let mut part = rows.rows_mut(6 * (platform - 1), 6);
                part += w;
            }
        };
        let joined = |f: Vector3<f64>, t: Vector3<f64>| Vector6::new(f.x, f.y, f.z, t.x, t.y, t.z);
        for (k, platform) in m.platforms().iter().enumerate() {
            let weight = gravity * platform.mass;
            let arm = self.platforms[k].rotation * platform.centre_of_mass;
            put(&mut rows, k, joined(weight, arm.cross(&weight)));
        }
        put(&mut rows, m.tool(), self.load);
        for load in m.platform_loads() {
            for (platform, [place, force, moment]) in self.on_platforms(load) {
                let arm = place - self.platforms[platform].translation.vector;
                put(
                    &mut rows,
                    platform,
                    joined(force, moment + arm.cross(&force)),
                );
            }
        }
        for (i, limb) in m.limbs().iter().enumerate() {
            let chain = &limb.actual;
            let x = &self.coordinates[i];
            let base = self.platforms[limb.from];
            let frames = Frames::new(chain, &base, x, &self.commands[i]);
            let tip = frames.tip();
            let mut loads: Vec<(usize, Wrench)> = chain
                .bodies()
                .iter()
                .map(|b| (b.node, Wrench::new(gravity * b.mass, Vector3::zeros())))
                .collect();
            let f = Wrench(self.wrenches[i]);
            loads.push((tip, f));
            let target = self.platforms[limb.to] * limb.platform_from_tip;
            let torque = frames.torque(&loads) - springs(chain, x, &self.posture[i]).0;
            rows.rows_mut(at, 6)
                .copy_from(&frames.pose_residual(tip, &target));
            rows.rows_mut(at + 6, x.len()).copy_from(&torque);
            at += 6 + x.len();
            let arm = target.translation.vector - self.platforms[limb.to].translation.vector;
            put(
                &mut rows,
                limb.to,
                -joined(f.force(), f.moment() + arm.cross(&f.force())),
            );
            for (node, w) in &loads {
                let arm = frames.position(*node) - base.translation.vector;
                put(
                    &mut rows,
                    limb.from,
                    joined(w.force(), w.moment() + arm.cross(&w.force())),
                );
            }
        }
        rows
    }

    /// Platform, and point, force and moment there, of a load on platforms.
    fn on_platforms(&self, load: &PlatformLoad) -> Vec<(usize, [Vector3<f64>; 3])> {
        let at = |p: usize, point: &Vector3<f64>| {
            self.platforms[p].translation.vector + self.platforms[p].rotation * point
        };
        match load {
            PlatformLoad::Wrench {
                platform,
                point,
                wrench,
                turns,
            } => {
                let turn = |v: Vector3<f64>| match turns {
                    true => self.platforms[*platform].rotation * v,
                    false => v,
                };
                let (force, moment) = (turn(wrench.force()), turn(wrench.moment()));
                vec![(*platform, [at(*platform, point), force, moment])]
            }
            PlatformLoad::Strut(strut) => {
                let end = |anchor: &Anchor| match anchor {
                    Anchor::Base(point) => (0, *point),
                    Anchor::Node { node, point } => (*node, at(*node, point)),
                };
                let ((a, from), (b, to)) = (end(&strut.from), end(&strut.to));
                let between = to - from;
                let pull = between.normalize() * strut.law.respond(between.norm()).tension;
                let none = Vector3::zeros();
                vec![(a, [from, pull, none]), (b, [to, -pull, none])]
            }
            other => panic!("unknown load {other:?}"),
        }
    }

    fn moved(&self, step: &DVector<f64>) -> Self {
        let mut next = self.clone();
        let mut at = 0;
        for pose in next.platforms.iter_mut().skip(1) {
            let d = Vector3::new(step[at], step[at + 1], step[at + 2]);
            let w = Vector3::new(step[at + 3], step[at + 4], step[at + 5]);
            pose.translation.vector += d;
            pose.rotation = UnitQuaternion::from_scaled_axis(w) * pose.rotation;
            at += 6;
        }
        for (f, x) in next.wrenches.iter_mut().zip(&mut next.coordinates) {
            for k in 0..6 {
                f[k] += step[at + k];
            }
            for (k, v) in x.iter_mut().enumerate() {
                *v += step[at + 6 + k];
            }
            at += 6 + x.len();
        }
        next
    }

    /// Derivative of [`Self::residual`], sixth-order central differences: steps of 3e-3 leave 1e-13 of
    /// what they differentiate. Wrenches act linearly; their step is of their own size.
    pub fn tangent(&self) -> DMatrix<f64> {
        let n = self.size();
        let mut steps = vec![3e-3; 6 * (self.platforms.len() - 1)];
        for x in &self.coordinates {
            steps.extend([100.0; 6]);
            steps.resize(steps.len() + x.len(), 3e-3);
        }
        let mut a = DMatrix::zeros(n, n);
        for j in 0..n {
            let at = |s: f64| {
                let mut d = DVector::zeros(n);
                d[j] = s * steps[j];
                self.moved(&d).residual()
            };
            let odd = |s: f64| at(s) - at(-s);
            let column = (45.0 * odd(1.0) - 9.0 * odd(2.0) + odd(3.0)) / (60.0 * steps[j]);
            a.set_column(j, &column);
        }
        a
    }

    /// Newton; with `hold_tool` the tool stays where it is and `load` follows.
    pub fn solve(&mut self, hold_tool: bool) {
        let tool = 6 * (self.mechanism.tool() - 1);
        let mut before = f64::INFINITY;
        for _ in 0..60 {
            let r = self.residual();
            let mut a = self.tangent();
            if hold_tool {
                for k in 0..6 {
                    a.column_mut(tool + k).fill(0.0);
                    a[(tool + k, tool + k)] = 1.0;
                }
            }
            let b = DMatrix::from_column_slice(r.len(), 1, (-&r).as_slice());
            let mut step = scaled_solve(&a, &b).column(0).into_owned();
            let mut load = Vector6::zeros();
            if hold_tool {
                for k in 0..6 {
                    load[k] = step[tool + k];
                    step[tool + k] = 0.0;
                }
            }
            let mut angle = Worst::new();
            let mut at = 6 * (self.platforms.len() - 1);
            for x in &self.coordinates {
                angle.add(step.rows(at + 6, x.len()).largest_entry());
                at += 6 + x.len();
            }
            let now = angle.value();
            let length = (0.3 / now.max(1e-300)).min(1.0);
            self.load += load * length;
            *self = self.moved(&(&step * length));
            if now < 1e-14 || (now < 1e-10 && now >= 0.5 * before) {
                return;
            }
            before = now;
        }
        panic!("oracle: no convergence (last step {before:.1e})");
    }

    /// `K` of the tool, other platforms free: how the wrench answers prescribed motions.
    pub fn stiffness(&self) -> Matrix6<f64> {
        let tool = 6 * (self.mechanism.tool() - 1);
        let mut a = self.tangent();
        let mut b = DMatrix::zeros(a.nrows(), 6);
        for k in 0..6 {
            b.set_column(k, &-a.column(tool + k));
            a.column_mut(tool + k).fill(0.0);
            a[(tool + k, tool + k)] = 1.0;
        }
        scaled_solve(&a, &b)
            .fixed_view::<6, 6>(tool, 0)
            .into_owned()
    }
}
