//! One chain evaluated over and over at states that change: pose of the tip, torques of loads, Jacobian, all in place.
//!
//! A cycle of a controller may not allocate. [`Kinematics::new`] and the systems of `chain` do, so that a caller with a
//! deadline keeps a [`ChainEvaluation`] and updates it; the torques are those of [R 4.3-4.6] and carry no derivatives.

use nalgebra::{Matrix6xX, Vector3};

use crate::model::chain::Chain;
use crate::model::kinematics::Kinematics;
use crate::model::loads::load::Load;
use crate::spatial::{Pose, Wrench};

/// Buffers of one chain. Nothing is allocated after [`Self::new`], unless a load of the caller's own
/// ([`crate::model::NodeLoad`]) does.
///
/// ```
/// # use kinetostat::nalgebra::{Vector3, vector};
/// # use kinetostat::*;
/// use kinetostat::model::ChainEvaluation;
///
/// let hinge = ActuatorSpec::new(MotionKind::Revolute, Vector3::z(), 2e5); // N m/rad
/// let arm = Chain::builder("arm").actuator("hinge", hinge).translation(vector![0.6, 0.0, 0.0]).build()?;
/// let mut at = ChainEvaluation::new(&arm, &[]);
/// let push = Wrench::new(vector![0.0, 50.0, 0.0], Vector3::zeros()); // N
/// at.move_to(&arm, &Pose::identity(), &[0.0], &[0.0]);
/// at.load(&arm, &[], &push);
/// at.differentiate();
/// assert!((at.torques()[0] - 30.0).abs() < 1e-12, "arm times force");
/// assert!((at.tip_pose().translation.x - 0.6).abs() < 1e-15);
/// assert!((at.jacobian()[(1, 0)] - 0.6).abs() < 1e-15, "a turn moves the tip along y");
/// // The spring of the hinge answers a deflection.
/// let mut answer = [0.0];
/// arm.springs()[0].add_torque(&[1e-3], &[0.0], &mut answer);
/// assert!((answer[0] - 200.0).abs() < 1e-9); // N m
/// # Ok::<(), Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct ChainEvaluation {
    kinematics: Kinematics,
    wrenches: Vec<(usize, Wrench)>,
    /// Force and moment about the base's origin of what acts on nodes, by the number of motions before the node.
    acting: Vec<(Vector3<f64>, Vector3<f64>)>,
    torques: Vec<f64>,
    jacobian: Matrix6xX<f64>,
}

impl ChainEvaluation {
    /// Buffers for a chain and its loads, evaluated at home.
    #[must_use]
    pub fn new(chain: &Chain, loads: &[Load]) -> Self {
        let (coordinates, commands) = (chain.home_coordinates(), chain.home_commands());
        let kinematics = Kinematics::new(chain, &Pose::identity(), &coordinates, &commands);
        let mut wrenches = vec![(chain.tip(), Wrench::zero())];
        for load in loads {
            load.add_wrenches(chain, &kinematics, 1.0, &mut wrenches);
        }
        // A rope that hangs slack at home pulls elsewhere.
        wrenches.reserve_exact(wrenches.len() + 4 * loads.len());
        let columns = kinematics.velocity_count();
        Self {
            acting: vec![(Vector3::zeros(), Vector3::zeros()); kinematics.motion_count() + 1],
            torques: vec![0.0; columns],
            jacobian: Matrix6xX::zeros(columns),
            kinematics,
            wrenches,
        }
    }

    /// Moves to coordinates and commands (m, rad), as many as the chain has: poses are new, torques and Jacobian are not.
    pub fn move_to(&mut self, chain: &Chain, base: &Pose, coordinates: &[f64], commands: &[f64]) {
        self.kinematics.update(chain, base, coordinates, commands);
    }

    /// Computes torques under the loads and a wrench on the tip (about it, base axes); chain and loads are those given to
    /// [`Self::new`].
    pub fn load(&mut self, chain: &Chain, loads: &[Load], tip: &Wrench) {
        self.wrenches.clear();
        self.wrenches.push((chain.tip(), *tip));
        for load in loads {
            load.add_wrenches(chain, &self.kinematics, 1.0, &mut self.wrenches);
        }
        self.kinematics
            .torques_into(&self.wrenches, &mut self.acting, &mut self.torques);
    }

    /// Computes the Jacobian of the tip.
    pub fn differentiate(&mut self) {
        let tip = self.kinematics.node_count() - 1;
        self.kinematics.jacobian_into(tip, &mut self.jacobian);
    }

    /// Pose of the tip, base from tip.
    #[must_use]
    pub fn tip_pose(&self) -> Pose {
        self.kinematics.tip_pose()
    }

    /// Torques `sum J_j^T G_j` of all loads and of the wrench on the tip, N or N m: coordinates, then commands.
    #[must_use]
    pub fn torques(&self) -> &[f64] {
        &self.torques
    }

    /// Jacobian of the tip at the last call of [`Self::differentiate`], as [`Kinematics::jacobian`] has it.
    #[must_use]
    pub fn jacobian(&self) -> &Matrix6xX<f64> {
        &self.jacobian
    }
}
