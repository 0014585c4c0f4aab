//! Which of its eight ways an arm takes to a pose, from its joint values.
//!
//! Six turning axes: 2 and 3 parallel, 1 at a right angle to them, and 4, 5, 6 through one point with right angles between
//! neighbours. The determinant of such an arm's Jacobian is a product of three factors, one each of shoulder, elbow and wrist, and the
//! sign of each is a flag of the configuration (Pieper 1968; Paul and Zhang, Int. J. Robotics Research 5(2), 1986).

use kinetostat::model::{Chain, Element, Role};
use kinetostat::{Mechanism, MotionKind, Pose};
use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

use crate::result::joints::ArmConfiguration;

/// Axes meet or are parallel that do so within this: a tenth of a millimetre per metre, as models from rounded figures have it.
const CLOSE: f64 = 1e-4;

/// An arm of six axes with a wrist in one point.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    /// From the frame behind joint k to joint k + 1, the first from the base.
    offsets: [Pose; 6],
    /// Axes, each in the frame that its offset reaches.
    axes: [Unit<Vector3<f64>>; 6],
    /// Centre of the wrist in the frame behind joint 3, m.
    wrist: Point3<f64>,
    /// Signs that make front, elbow up and a wrist that is not flipped positive.
    signs: [f64; 3],
}

/// Axes of an arm at joint values: their directions and a point of each, base axes, m.
struct Axes {
    directions: [Vector3<f64>; 6],
    points: [Vector3<f64>; 6],
    /// The frame behind joint 3.
    forearm: Pose,
}

impl Arm {
    /// The arm that a machine is; none if it is another machine.
    pub(crate) fn of(mechanism: &Mechanism) -> Option<Self> {
        let [limb] = mechanism.limbs() else {
            return None;
        };
        let (offsets, axes) = six_turning(&limb.nominal)?;
        let mut arm = Self {
            offsets,
            axes,
            wrist: Point3::origin(),
            signs: [1.0; 3],
        };
        let commands = limb.nominal.home_commands();
        let home = arm.axes_at(&commands);
        let reach = CLOSE * mechanism.size();
        let [first, second, third, fourth, fifth, sixth] = home.directions;
        let square = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(b).abs() < CLOSE;
        let angles = square(&first, &second)
            && second.cross(&third).norm() < CLOSE
            && square(&fourth, &fifth)
            && square(&fifth, &sixth);
        if !angles {
            return None;
        }
        // Axis 5 is square to axis 4: where they meet, they are nearest to each other.
        let off = home.points[4] - home.points[3];
        let centre = home.points[3] + fourth * off.dot(&fourth);
        let on = |axis: usize| {
            (centre - home.points[axis])
                .cross(&home.directions[axis])
                .norm()
                < reach
        };
        if !(on(4) && on(5)) {
            return None;
        }
        arm.wrist = home.forearm.inverse_transform_point(&Point3::from(centre));
        arm.signs = arm.signs_of(&home, reach);
        Some(arm)
    }

    /// Which signs mean front, up and not flipped.
    fn signs_of(&self, home: &Axes, reach: f64) -> [f64; 3] {
        let sign = |value: f64, otherwise: f64| match value == 0.0 {
            true => otherwise,
            false => value.signum(),
        };
        let [shoulder_home, _, wrist_home] = self.signed(home);
        let [first, second, ..] = home.directions;
        // How far axis 2 lies off axis 1.
        let off = sideways(home, &home.points[1]);
        let front = match off.abs() > reach {
            true => off.signum(),
            false => sign(shoulder_home, 1.0),
        };
        let forward = second.cross(&first) * front;
        // Along axis 1, away from the base.
        let up = first * sign(home.points[1].dot(&first), sign(first.z, 1.0));
        // An elbow that is up bends the forearm about axis 2 as up turns to the front.
        let bends = second.dot(&up.cross(&forward)).signum();
        let wrist = match wrist_home.abs() > CLOSE.to_degrees() {
            true => wrist_home.signum(),
            false => 1.0,
        };
        [front, bends, wrist]
    }

    fn axes_at(&self, commands: &[f64]) -> Axes {
        let mut frame = Pose::identity();
        let mut axes = Axes {
            directions: [Vector3::zeros(); 6],
            points: [Vector3::zeros(); 6],
            forearm: frame,
        };
        let joints = self.offsets.iter().zip(&self.axes).zip(commands);
        for (joint, ((offset, axis), command)) in joints.enumerate() {
            frame *= offset;
            axes.directions[joint] = frame.rotation * axis.into_inner();
            axes.points[joint] = frame.translation.vector;
            frame *= UnitQuaternion::from_axis_angle(axis, *command);
            if joint == 2 {
                axes.forearm = frame;
            }
        }
        axes
    }

    /// Shoulder, mm, elbow and wrist, deg, with the signs of the axes.
    fn signed(&self, axes: &Axes) -> [f64; 3] {
        let [_, second, _, fourth, fifth, sixth] = axes.directions;
        let centre = axes.forearm.transform_point(&self.wrist).coords;
        let angle = |about: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>| {
            let across = |v: &Vector3<f64>| v - about * about.dot(v);
            let (from, to) = (across(from), across(to));
            about
                .dot(&from.cross(&to))
                .atan2(from.dot(&to))
                .to_degrees()
        };
        let upper_arm = axes.points[2] - axes.points[1];
        let forearm = centre - axes.points[2];
        [
            1e3 * sideways(axes, &centre),
            angle(&second, &upper_arm, &forearm),
            angle(&fifth, &fourth, &sixth),
        ]
    }

    /// The configuration at joint values, rad; none if one of them is no number.
    pub(crate) fn configuration(&self, commands: &[f64]) -> Option<ArmConfiguration> {
        let signed = self.signed(&self.axes_at(commands));
        let [shoulder, elbow, wrist] = [0, 1, 2].map(|k| self.signs[k] * signed[k]);
        ArmConfiguration::of(shoulder, elbow, wrist)
    }
}

/// Distance of a point from the plane through axis 1 that axis 2 is parallel to, m.
fn sideways(axes: &Axes, point: &Vector3<f64>) -> f64 {
    let [first, second, ..] = axes.directions;
    second.dot(&first.cross(&(point - axes.points[0])))
}

/// Offsets and axes of a chain of six commanded turns and nothing else that moves but springs.
fn six_turning(chain: &Chain) -> Option<([Pose; 6], [Unit<Vector3<f64>>; 6])> {
    let passive =
        |index: usize| chain.coordinates().get(index).map(|c| c.role) != Some(Role::Spring);
    let mut joints: Vec<(Pose, Unit<Vector3<f64>>)> = Vec::new();
    let mut offset = Pose::identity();
    for element in chain.elements() {
        let motion = match element {
            Element::Rigid(pose) => {
                offset *= pose;
                continue;
            }
            Element::Node(_) => continue,
            Element::Motion(motion) => motion,
        };
        if motion.coordinate.is_some_and(|drive| passive(drive.index)) {
            return None;
        }
        let Some(command) = motion.command else {
            continue;
        };
        let plain = command.ratio == 1.0 && command.index == joints.len();
        if !plain || motion.kind != MotionKind::Revolute {
            return None;
        }
        joints.push((
            std::mem::replace(&mut offset, Pose::identity()),
            motion.axis,
        ));
    }
    let joints: [(Pose, Unit<Vector3<f64>>); 6] = joints.try_into().ok()?;
    Some((joints.map(|joint| joint.0), joints.map(|joint| joint.1)))
}
