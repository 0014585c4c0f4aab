//! A load that a user gives as a function of node poses, with or without its tangent.

use std::sync::Arc;

use nalgebra::{DMatrix, Matrix6};

use crate::model::kinematics::{Kinematics, NodeTangent};
use crate::model::loads::node_load::NodeLoad;
use crate::spatial::{Pose, Twist, Wrench, moved};

type Wrenches = Arc<dyn Fn(&[Pose]) -> Vec<Wrench> + Send + Sync>;
type Tangent = Arc<dyn Fn(&[Pose]) -> DMatrix<f64> + Send + Sync>;
type Energy = Arc<dyn Fn(&[Pose]) -> f64 + Send + Sync>;

/// Wrenches on some nodes as a function of the poses of these nodes.
///
/// The function takes the poses (base from node) of `nodes` in their order and returns as many
/// wrenches: base axes, about each node's origin, applied to the chain. Without a tangent it is
/// differentiated by fourth-order central differences over motions of the nodes.
///
/// ```
/// use kinetostat::{Load, Wrench, model::FunctionLoad};
/// use nalgebra::Vector3;
///
/// // A current that drags node 2 towards -x, the more the higher it stands.
/// let drag = FunctionLoad::new("drag", vec![2], |poses| {
///     let height = poses[0].translation.z;
///     vec![Wrench::new(Vector3::new(-40.0 * height * height, 0.0, 0.0), Vector3::zeros())]
/// });
/// let load = Load::function(drag);
/// ```
#[derive(Clone)]
pub struct FunctionLoad {
    name: String,
    nodes: Vec<usize>,
    wrenches: Wrenches,
    tangent: Option<Tangent>,
    energy: Option<Energy>,
    steps: (f64, f64),
}

impl std::fmt::Debug for FunctionLoad {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "FunctionLoad('{}' on nodes {:?})", self.name, self.nodes)
    }
}

impl FunctionLoad {
    /// A load without a tangent of its own.
    #[must_use]
    pub fn new(
        name: impl Into<String>,
        nodes: Vec<usize>,
        wrenches: impl Fn(&[Pose]) -> Vec<Wrench> + Send + Sync + 'static,
    ) -> Self {
        Self {
            name: name.into(),
            nodes,
            wrenches: Arc::new(wrenches),
            tangent: None,
            energy: None,
            steps: (1e-4, 1e-4),
        }
    }

    /// Adds its tangent, 6k x 6k for k nodes: change of the stacked wrenches by the stacked twists of the nodes (both
    /// in base axes, about each node's origin).
    #[must_use]
    pub fn with_tangent(
        mut self,
        tangent: impl Fn(&[Pose]) -> DMatrix<f64> + Send + Sync + 'static,
    ) -> Self {
        self.tangent = Some(Arc::new(tangent));
        self
    }

    /// Adds its potential energy (J), which also declares the load conservative.
    #[must_use]
    pub fn with_energy(mut self, energy: impl Fn(&[Pose]) -> f64 + Send + Sync + 'static) -> Self {
        self.energy = Some(Arc::new(energy));
        self
    }

    /// Steps of the differences, m and rad (1e-4 both if not given): a hundredth of the distance
    /// over which the function changes its curvature is about right.
    #[must_use]
    pub fn with_steps(mut self, length: f64, angle: f64) -> Self {
        self.steps = (length, angle);
        self
    }

    fn poses(&self, kinematics: &Kinematics) -> Vec<Pose> {
        let pose = |&node: &usize| kinematics.node_pose(node);
        self.nodes.iter().map(pose).collect()
    }

    fn differences(&self, poses: &[Pose]) -> DMatrix<f64> {
        let size = 6 * poses.len();
        let mut tangent = DMatrix::zeros(size, size);
        for column in 0..size {
            let (node, k) = (column / 6, column % 6);
            let step = if k < 3 { self.steps.0 } else { self.steps.1 };
            let at = |share: f64| {
                let mut twist = Twist::zero();
                twist.0[k] = share * step;
                let mut near = poses.to_vec();
                near[node] = moved(&poses[node], &twist);
                (self.wrenches)(&near)
            };
            let points = [at(1.0), at(-1.0), at(2.0), at(-2.0)];
            let value = |p: usize, i: usize| points[p].get(i / 6).map_or(0.0, |w| w.0[i % 6]);
            for i in 0..size {
                let near = 8.0 * (value(0, i) - value(1, i));
                let far = value(2, i) - value(3, i);
                tangent[(i, column)] = (near - far) / (12.0 * step);
            }
        }
        tangent
    }
}

impl NodeLoad for FunctionLoad {
    fn wrenches(&self, kinematics: &Kinematics, out: &mut Vec<(usize, Wrench)>) {
        let wrenches = (self.wrenches)(&self.poses(kinematics));
        out.extend(self.nodes.iter().copied().zip(wrenches));
    }

    fn tangents(&self, kinematics: &Kinematics, out: &mut Vec<NodeTangent>) {
        let poses = self.poses(kinematics);
        let size = 6 * poses.len();
        let all = match &self.tangent {
            Some(tangent) => tangent(&poses),
            None => self.differences(&poses),
        };
        if all.shape() != (size, size) {
            return; // refused by `fault_at` before a chain is solved
        }
        for (i, &on) in self.nodes.iter().enumerate() {
            for (j, &by) in self.nodes.iter().enumerate() {
                let matrix = Matrix6::from_fn(|r, c| all[(6 * i + r, 6 * j + c)]);
                if matrix != Matrix6::zeros() {
                    out.push(NodeTangent { on, by, matrix });
                }
            }
        }
    }

    fn energy(&self, kinematics: &Kinematics) -> Option<f64> {
        let energy = self.energy.as_ref()?;
        Some(energy(&self.poses(kinematics)))
    }

    fn conservative(&self) -> bool {
        self.energy.is_some()
    }

    fn nodes(&self) -> Vec<usize> {
        self.nodes.clone()
    }

    fn fault(&self) -> Option<String> {
        let (length, angle) = self.steps;
        let good = |step: f64| step.is_finite() && step > 0.0;
        (!(good(length) && good(angle))).then(|| {
            format!(
                "'{}': steps {length} m, {angle} rad must be positive",
                self.name
            )
        })
    }

    fn fault_at(&self, kinematics: &Kinematics) -> Option<String> {
        let poses = self.poses(kinematics);
        let (count, size) = (poses.len(), 6 * poses.len());
        let found = (self.wrenches)(&poses).len();
        if found != count {
            return Some(format!(
                "'{}': the function returned {found} wrenches for {count} nodes",
                self.name
            ));
        }
        let shape = self.tangent.as_ref().map(|tangent| tangent(&poses).shape());
        shape
            .filter(|&shape| shape != (size, size))
            .map(|(rows, columns)| {
                format!(
                    "'{}': the tangent is {rows} x {columns}, {size} x {size} is needed",
                    self.name
                )
            })
    }
}
