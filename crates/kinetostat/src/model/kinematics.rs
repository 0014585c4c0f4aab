//! Frames of a chain, their motions, and the derivatives of the loads' torques by the coordinates: `g_j`, `J`, `J_j`
//! and the Hessian `H` of [R 4.3-4.6, 4.21].
//!
//! Generalised velocities are, in this order, the chain's `n` coordinates, its `r` commands and,
//! for a chain whose base moves, six motions of the base (translation of its origin, rotation
//! about it, base axes). Everything is in the axes of the outer base.

use nalgebra::{DMatrix, Matrix3, Matrix6, Matrix6xX, Rotation3, UnitQuaternion, Vector3};

use crate::model::chain::{Chain, Element};
use crate::spatial::{MotionKind, Pose, Wrench};

/// Axis and point of one elementary motion, base axes, m.
#[derive(Clone, Copy, Debug)]
struct Screw {
    kind: MotionKind,
    axis: Vector3<f64>,
    point: Vector3<f64>,
    /// Index among the generalised velocities and ratio: coordinate, command.
    drives: [Option<(usize, f64)>; 2],
}

impl Screw {
    /// Linear and angular part of the motion of a body point at `p` per unit of this motion.
    fn twist_at(&self, p: &Vector3<f64>) -> (Vector3<f64>, Vector3<f64>) {
        match self.kind {
            MotionKind::Prismatic => (self.axis, Vector3::zeros()),
            MotionKind::Revolute => (self.axis.cross(&(p - self.point)), self.axis),
        }
    }

    fn drives(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.drives.iter().flatten().copied()
    }
}

/// Frames of a chain at one configuration.
#[derive(Clone, Debug)]
pub struct Kinematics {
    screws: Vec<Screw>,
    nodes: Vec<(Matrix3<f64>, Vector3<f64>)>,
    /// Number of screws nearer the base than each node.
    before: Vec<usize>,
    coordinates: usize,
    commands: usize,
    base_moves: bool,
}

impl Kinematics {
    /// Evaluates at the given base pose, coordinates (m, rad) and commands (m, rad); the base does not move.
    #[must_use]
    pub fn new(chain: &Chain, base: &Pose, coordinates: &[f64], commands: &[f64]) -> Self {
        Self::of_limb(chain, base, coordinates, commands, false)
    }

    /// Evaluates like [`Self::new`], with six generalised velocities more: those of a base that moves.
    #[must_use]
    pub fn with_moving_base(
        chain: &Chain,
        base: &Pose,
        coordinates: &[f64],
        commands: &[f64],
    ) -> Self {
        Self::of_limb(chain, base, coordinates, commands, true)
    }

    /// Evaluates with a fixed or a moving base.
    pub(crate) fn of_limb(
        chain: &Chain,
        base: &Pose,
        coordinates: &[f64],
        commands: &[f64],
        base_moves: bool,
    ) -> Self {
        let mut kinematics = Self {
            screws: Vec::with_capacity(chain.elements.len() + 6),
            nodes: Vec::with_capacity(chain.nodes.len()),
            before: Vec::with_capacity(chain.nodes.len()),
            coordinates: chain.coordinates.len(),
            commands: chain.actuators.len(),
            base_moves,
        };
        kinematics.update(chain, base, coordinates, commands);
        kinematics
    }

    /// Recomputes the frames in place.
    pub fn update(&mut self, chain: &Chain, base: &Pose, coordinates: &[f64], commands: &[f64]) {
        self.screws.clear();
        self.nodes.clear();
        self.before.clear();
        let n = self.coordinates;
        let mut rotation = *base.rotation.to_rotation_matrix().matrix();
        let mut point = base.translation.vector;
        if self.base_moves {
            for (k, kind) in [MotionKind::Prismatic, MotionKind::Revolute]
                .into_iter()
                .enumerate()
            {
                for axis in 0..3 {
                    self.screws.push(Screw {
                        kind,
                        axis: Matrix3::identity().column(axis).into_owned(),
                        point,
                        drives: [Some((n + self.commands + 3 * k + axis, 1.0)), None],
                    });
                }
            }
        }
        for element in &chain.elements {
            match element {
                Element::Rigid(pose) => {
                    point += rotation * pose.translation.vector;
                    if pose.rotation.imag() != Vector3::zeros() {
                        rotation *= pose.rotation.to_rotation_matrix().matrix();
                    }
                }
                Element::Node(_) => {
                    self.before.push(self.screws.len());
                    self.nodes.push((rotation, point));
                }
                Element::Motion(motion) => {
                    let mut displacement = 0.0;
                    let mut drives = [None; 2];
                    if let Some(d) = motion.coordinate {
                        displacement += d.ratio * coordinates[d.index];
                        drives[0] = Some((d.index, d.ratio));
                    }
                    if let Some(d) = motion.command {
                        displacement += d.ratio * commands[d.index];
                        drives[1] = Some((n + d.index, d.ratio));
                    }
                    let axis = rotation * motion.axis.as_ref();
                    match motion.kind {
                        MotionKind::Prismatic => point += axis * displacement,
                        MotionKind::Revolute => {
                            rotation = turn(&rotation, &motion.axis, displacement)
                        }
                    }
                    self.screws.push(Screw {
                        kind: motion.kind,
                        axis,
                        point,
                        drives,
                    });
                }
            }
        }
    }

    /// Number of generalised velocities: coordinates, commands and, if the base moves, six.
    #[must_use]
    pub fn velocity_count(&self) -> usize {
        self.coordinates + self.commands + if self.base_moves { 6 } else { 0 }
    }

    /// Number of elementary motions.
    pub(crate) fn motion_count(&self) -> usize {
        self.screws.len()
    }

    /// Number of nodes.
    pub(crate) fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// Pose of a node, base from node.
    #[must_use]
    pub fn node_pose(&self, node: usize) -> Pose {
        let (rotation, point) = self.nodes[node];
        let rotation = Rotation3::from_matrix_unchecked(rotation);
        Pose::from_parts(
            point.into(),
            UnitQuaternion::from_rotation_matrix(&rotation),
        )
    }

    /// Rotation (base from node) and position of a node, m.
    #[must_use]
    pub fn frame(&self, node: usize) -> (Matrix3<f64>, Vector3<f64>) {
        self.nodes[node]
    }

    /// Position of a node, m.
    #[must_use]
    pub fn node_position(&self, node: usize) -> Vector3<f64> {
        self.nodes[node].1
    }

    /// Pose of the end, base from tip.
    #[must_use]
    pub fn tip_pose(&self) -> Pose {
        self.node_pose(self.nodes.len() - 1)
    }

    /// Jacobian of a node, 6 x (n + r \[+ 6\]): columns are the twists of the node's origin per unit
    /// of each generalised velocity (m or rad per m or rad), base axes.
    #[must_use]
    pub fn jacobian(&self, node: usize) -> Matrix6xX<f64> {
        let mut jacobian = Matrix6xX::zeros(self.velocity_count());
        self.jacobian_into(node, &mut jacobian);
        jacobian
    }

    /// Writes into an existing matrix of the right size.
    pub(crate) fn jacobian_into(&self, node: usize, jacobian: &mut Matrix6xX<f64>) {
        jacobian.fill(0.0);
        let p = self.nodes[node].1;
        for screw in &self.screws[..self.before[node]] {
            let (v, w) = screw.twist_at(&p);
            for (index, ratio) in screw.drives() {
                for k in 0..3 {
                    jacobian[(k, index)] += ratio * v[k];
                    jacobian[(k + 3, index)] += ratio * w[k];
                }
            }
        }
    }

    /// Hessian of dead wrenches on nodes (index, wrench about the node's origin, base axes):
    /// `H = d(sum_j J_j^T G_j)/dy`, (n + r \[+ 6\]) square, N m/rad, N/rad, N/m by generalised velocity;
    /// `H_ij - H_ji = m.(w_j x w_i)`, so it is symmetric iff no moments act (or all axes are
    /// parallel). The symmetric part is the second derivative in exponential coordinates.
    #[must_use]
    pub fn hessian(&self, wrenches: &[(usize, Wrench)]) -> DMatrix<f64> {
        let count = self.velocity_count();
        let mut hessian = DMatrix::zeros(count, count);
        self.load_terms(wrenches, &mut vec![0.0; count], &mut hessian);
        hessian
    }

    /// Torques `sum_j J_j^T G_j` of dead wrenches on nodes (about the node's origin, base axes) and
    /// their derivative, the Hessian `H`, by all generalised velocities; [R 4.21] in closed form on
    /// SO(3): with `z` the axes, `M` the moment of all outer loads about the axis' point, `S` their
    /// first moment `sum r f^T`,
    ///
    /// ```text
    /// j nearer the base (or i = j), both revolute:  (z_j x z_i).M_i + z_i.(S_i z_j - z_j tr S_i)
    /// j farther out:                                 z_i.(S_j z_j - z_j tr S_j)
    /// i revolute, j prismatic farther out:           f_j.(z_i x z_j)
    /// i prismatic, j revolute nearer the base:       f_i.(z_j x z_i)
    /// ```
    ///
    /// `H - H^T` is `m.(w_j x w_i)`: not symmetric under moments. For a moving base the last six
    /// torques are force and moment on the base's origin in fixed axes. `hessian` is overwritten.
    pub(crate) fn load_terms(
        &self,
        wrenches: &[(usize, Wrench)],
        torque: &mut [f64],
        hessian: &mut DMatrix<f64>,
    ) {
        let count = self.velocity_count();
        torque[..count].fill(0.0);
        hessian.fill(0.0);
        // Outer loads, summed from the tip inwards, about the outer base's origin.
        let mut force = Vector3::zeros();
        let mut moment = Vector3::zeros();
        let mut virial = Matrix3::zeros();
        let mut outer = vec![Outer::default(); self.screws.len()];
        let mut node = self.nodes.len();
        for i in (0..self.screws.len()).rev() {
            while node > 0 && self.before[node - 1] > i {
                node -= 1;
                let p = self.nodes[node].1;
                for (_, wrench) in wrenches.iter().filter(|(n, _)| *n == node) {
                    let f = wrench.force();
                    force += f;
                    moment += p.cross(&f) + wrench.moment();
                    virial += p * f.transpose();
                }
            }
            let p = self.screws[i].point;
            outer[i] = Outer {
                force,
                moment: moment - p.cross(&force),
                virial: virial - p * force.transpose(),
            };
        }
        let fixed_axes = if self.base_moves { 6 } else { 0 };
        for (i, (a, load_i)) in self.screws.iter().zip(&outer).enumerate() {
            let value = match a.kind {
                MotionKind::Prismatic => a.axis.dot(&load_i.force),
                MotionKind::Revolute => a.axis.dot(&load_i.moment),
            };
            for (row, ratio) in a.drives() {
                torque[row] += ratio * value;
            }
            let trace = load_i.virial.trace();
            for (j, (b, load_j)) in self.screws.iter().zip(&outer).enumerate() {
                use MotionKind::{Prismatic, Revolute};
                let value = match (a.kind, b.kind) {
                    (Revolute, Revolute) if j <= i => {
                        let change = load_i.virial * b.axis - b.axis * trace;
                        let turned = if i < fixed_axes {
                            0.0
                        } else {
                            b.axis.cross(&a.axis).dot(&load_i.moment)
                        };
                        turned + a.axis.dot(&change)
                    }
                    (Revolute, Revolute) => {
                        let change = load_j.virial * b.axis - b.axis * load_j.virial.trace();
                        a.axis.dot(&change)
                    }
                    (Revolute, Prismatic) if j > i => a.axis.cross(&b.axis).dot(&load_j.force),
                    (Prismatic, Revolute) if j < i => b.axis.cross(&a.axis).dot(&load_i.force),
                    _ => continue,
                };
                for (row, row_ratio) in a.drives() {
                    for (column, column_ratio) in b.drives() {
                        hessian[(row, column)] += row_ratio * column_ratio * value;
                    }
                }
            }
        }
    }

    /// Torques of dead wrenches as in [`Self::load_terms`], without derivatives and without allocating: one entry of
    /// `acting` (force, moment about the outer base's origin) for each motion and one more.
    pub(crate) fn torques_into(
        &self,
        wrenches: &[(usize, Wrench)],
        acting: &mut [(Vector3<f64>, Vector3<f64>)],
        torque: &mut [f64],
    ) {
        acting.fill((Vector3::zeros(), Vector3::zeros()));
        for (node, wrench) in wrenches {
            let f = wrench.force();
            let outer = &mut acting[self.before[*node]];
            outer.0 += f;
            outer.1 += self.nodes[*node].1.cross(&f) + wrench.moment();
        }
        torque.fill(0.0);
        let (mut force, mut moment) = (Vector3::zeros(), Vector3::zeros());
        for (i, screw) in self.screws.iter().enumerate().rev() {
            force += acting[i + 1].0;
            moment += acting[i + 1].1;
            let value = match screw.kind {
                MotionKind::Prismatic => screw.axis.dot(&force),
                MotionKind::Revolute => screw.axis.dot(&(moment - screw.point.cross(&force))),
            };
            for (row, ratio) in screw.drives() {
                torque[row] += ratio * value;
            }
        }
    }

    /// Adds `J_a^T T J_b` for every load whose wrench follows the motion of the nodes.
    pub(crate) fn add_tangents(&self, tangents: &[NodeTangent], hessian: &mut DMatrix<f64>) {
        for tangent in tangents {
            let rows = self.jacobian(tangent.on);
            let columns = self.jacobian(tangent.by);
            *hessian += rows.transpose() * tangent.matrix * columns;
        }
    }
}

/// Loads that act beyond a screw, about the screw's point.
#[derive(Clone, Copy, Default)]
struct Outer {
    force: Vector3<f64>,
    moment: Vector3<f64>,
    virial: Matrix3<f64>,
}

/// `rotation * exp(hat(axis) * angle)`; coordinate axes touch two columns only.
fn turn(rotation: &Matrix3<f64>, axis: &Vector3<f64>, angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    for k in 0..3 {
        if axis[k] == 1.0 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (a, b) = (rotation.column(i), rotation.column(j));
            let mut turned = *rotation;
            turned.set_column(i, &(a * c + b * s));
            turned.set_column(j, &(b * c - a * s));
            return turned;
        }
    }
    rotation * Rotation3::from_axis_angle(&nalgebra::Unit::new_unchecked(*axis), angle).matrix()
}

/// `d(wrench on node "on") = matrix * (twist of node "by")`, base axes, each at its node's origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeTangent {
    /// Node on which the wrench acts.
    pub on: usize,
    /// Node whose motion changes it.
    pub by: usize,
    /// 6 x 6 (N/m, N/rad, N m/m, N m/rad).
    pub matrix: Matrix6<f64>,
}

/// Tip pose of the unloaded chain (all springs at zero, not at `theta0`) for given passive
/// coordinates and commands.
#[must_use]
pub fn unloaded_tip(chain: &Chain, base: &Pose, coordinates: &[f64], commands: &[f64]) -> Pose {
    Kinematics::new(chain, base, coordinates, commands).tip_pose()
}
