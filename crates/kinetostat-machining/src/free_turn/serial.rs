//! Six turning joints in one chain: where they lead, how the tool moves with them, and the joint values near others that bring it to a
//! pose.

use kinetostat::model::unloaded_tip;
use kinetostat::spatial::pose_residual;
use kinetostat::{Mechanism, Pose};
use nalgebra::{Matrix6, Point3, Unit, UnitQuaternion, Vector3, Vector6};

use crate::joints::six_turning;

/// Joint values, rad.
pub(crate) type Joints = [f64; 6];

/// Steps of a search for joint values; it converges by the square.
const STEPS: usize = 12;

/// A pose is reached within this: rad, and shares of the natural length.
const REACHED: f64 = 1e-12;

/// Models whose springs are not at zero at home are other arms than their joints alone tell.
const SAME: f64 = 1e-9;

/// Six turning joints from the base to the tool.
#[derive(Clone, Debug)]
pub(crate) struct SerialArm {
    offsets: [Pose; 6],
    axes: [Unit<Vector3<f64>>; 6],
    /// Pose of the tool in the frame after the last joint.
    end: Pose,
    /// Base of the machine from base of the chain.
    base: Pose,
    pub home: Joints,
    pub limits: [Option<(f64, f64)>; 6],
    /// Length by which translations are divided, m.
    pub length: f64,
}

impl SerialArm {
    /// The joints of a machine; `None` if it is another machine.
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let [limb] = mechanism.limbs() else {
            return None;
        };
        let chain = &limb.nominal;
        let joints = six_turning(chain)?;
        let home: Joints = chain.home_commands().try_into().ok()?;
        let limits = chain.actuators().iter().map(|actuator| actuator.limits);
        let limits: Vec<Option<(f64, f64)>> = limits.collect();
        let mut arm = Self {
            offsets: joints.map(|(offset, _)| offset),
            axes: joints.map(|(_, axis)| axis),
            end: Pose::identity(),
            base: mechanism.platforms()[limb.from].home,
            home,
            limits: limits.try_into().ok()?,
            length: mechanism.natural_length(),
        };
        let tip = |commands: &Joints| {
            let coordinates = chain.home_coordinates();
            let tip = unloaded_tip(chain, &arm.base, &coordinates, commands);
            tip * limb.platform_from_tip.inverse()
        };
        let at_home = tip(&home);
        let elsewhere = home.map(|angle| angle + 0.3);
        let there = tip(&elsewhere);
        arm.end = arm.tool(&home).inverse() * at_home;
        let off = pose_residual(&there, &arm.tool(&elsewhere)).0.norm();
        (off < SAME * arm.length.max(1.0)).then_some(arm)
    }

    /// Pose of the tool, base from tool.
    pub fn tool(&self, joints: &Joints) -> Pose {
        let mut frame = self.base;
        for joint in 0..6 {
            frame *= self.offsets[joint];
            frame *= UnitQuaternion::from_axis_angle(&self.axes[joint], joints[joint]);
        }
        frame * self.end
    }

    /// Pose of the tool, and its motion by the joints: velocity by the natural length, angular velocity, base axes.
    pub fn jacobian(&self, joints: &Joints) -> (Pose, Matrix6<f64>) {
        let mut frame = self.base;
        let mut axes = [(Vector3::zeros(), Vector3::zeros()); 6];
        for joint in 0..6 {
            frame *= self.offsets[joint];
            axes[joint] = (
                frame.rotation * self.axes[joint].into_inner(),
                frame.translation.vector,
            );
            frame *= UnitQuaternion::from_axis_angle(&self.axes[joint], joints[joint]);
        }
        let tool = frame * self.end;
        let columns = axes.map(|(axis, point)| {
            let velocity = axis.cross(&(tool.translation.vector - point)) / self.length;
            Vector6::new(velocity.x, velocity.y, velocity.z, axis.x, axis.y, axis.z)
        });
        (tool, Matrix6::from_columns(&columns))
    }

    /// The smallest singular value of that motion.
    pub fn smallest_singular_value(&self, joints: &Joints) -> f64 {
        let (_, jacobian) = self.jacobian(joints);
        // Good to a hundred-millionth of the largest one: bounds are far above.
        let square = (jacobian.transpose() * jacobian).symmetric_eigenvalues();
        let mut least = f64::INFINITY;
        for value in square.iter() {
            if !value.is_finite() {
                return 0.0;
            }
            least = least.min(*value);
        }
        least.max(0.0).sqrt()
    }

    /// The joint values next to others that bring the tool to a pose; `None` if the search does not end there.
    pub fn near(&self, target: &Pose, start: &Joints) -> Option<Joints> {
        let mut joints = *start;
        let mut last = f64::INFINITY;
        for _ in 0..STEPS {
            let (tool, jacobian) = self.jacobian(&joints);
            let off = pose_residual(target, &tool);
            let (linear, angular) = (off.linear() / self.length, off.angular());
            let off = Vector6::new(
                linear.x, linear.y, linear.z, angular.x, angular.y, angular.z,
            );
            let size = off.norm();
            // Rounding: there is nothing more to gain.
            if size < REACHED || (size < 1e3 * REACHED && size >= 0.5 * last) {
                return Some(joints);
            }
            last = size;
            let step = jacobian.lu().solve(&off)?;
            // A step that a linear model does not reach: the posture is all but singular, or the start is far.
            if !step.iter().all(|turn| turn.abs() < 1.0) {
                return None;
            }
            for (joint, turn) in joints.iter_mut().zip(step.iter()) {
                *joint += turn;
            }
        }
        None
    }

    /// Directions of the axes and a point of each at home, and the tool there; base axes, m.
    pub fn at_home(&self) -> ([Vector3<f64>; 6], [Point3<f64>; 6], Pose) {
        let mut frame = self.base;
        let mut directions = [Vector3::zeros(); 6];
        let mut points = [Point3::origin(); 6];
        for joint in 0..6 {
            frame *= self.offsets[joint];
            directions[joint] = frame.rotation * self.axes[joint].into_inner();
            points[joint] = Point3::from(frame.translation.vector);
            frame *= UnitQuaternion::from_axis_angle(&self.axes[joint], self.home[joint]);
        }
        (directions, points, frame * self.end)
    }
}
