//! Figures of joint values and drive loads: distance to limits, share of ratings, configuration of an arm.
//!
//! Takes the mechanism, joint values and drive loads; gives plain data. Closed forms of the nominal geometry, no equilibrium is solved.

use std::f64::consts::TAU;

use kinetostat::model::{Chain, Element, Role};
use kinetostat::{Mechanism, MotionKind, Pose};
use nalgebra::{Unit, UnitQuaternion, Vector3};

use crate::near::natural_length;
use crate::result::joints::{ArmConfiguration, LimitEnd, MostLoaded, NearestLimit};
use crate::result::point::{PointKind, PointResult};

/// References for joint values and drive loads of a machine.
#[derive(Clone, Debug)]
pub(crate) struct JointFigures<'r> {
    /// Kind and limits, mm or deg, of every actuator.
    joints: Vec<(MotionKind, Option<[f64; 2]>)>,
    ratings: &'r [Option<f64>],
    arm: Option<Arm>,
    /// A degree at the machine's natural length, where angles are compared with lengths.
    mm_per_deg: f64,
}

impl<'r> JointFigures<'r> {
    pub(crate) fn new(mechanism: &Mechanism, ratings: &'r [Option<f64>]) -> Self {
        let limbs = mechanism.limbs().iter();
        Self {
            joints: limbs
                .flat_map(|limb| limb.nominal.actuators())
                .map(|actuator| {
                    let shown = |(low, high): (f64, f64)| {
                        [low, high].map(|limit| in_display(actuator.kind) * limit)
                    };
                    (actuator.kind, actuator.limits.map(shown))
                })
                .collect(),
            ratings,
            arm: Arm::of(mechanism),
            mm_per_deg: 1e3 * natural_length(mechanism) * 1_f64.to_radians(),
        }
    }

    /// The arm that the machine is; `None` if it is another machine.
    pub(crate) fn arm(&self) -> Option<&Arm> {
        self.arm.as_ref()
    }

    /// Kind of every actuator.
    pub(crate) fn kinds(&self) -> impl Iterator<Item = MotionKind> + '_ {
        self.joints.iter().map(|joint| joint.0)
    }

    /// Limits of every actuator, mm or deg.
    pub(crate) fn limits(&self) -> impl Iterator<Item = Option<[f64; 2]>> + '_ {
        self.joints.iter().map(|joint| joint.1)
    }

    /// Takes turning joints to the whole turn next to that of the point before. A solution may take any of the values that are whole
    /// turns apart, and a controller turns its joints on: in a feed motion always, in a rapid as far as the limits allow.
    pub(crate) fn unwind(&self, before: &[f64], point: &mut PointResult) {
        let commands = point.actuator_command.iter_mut().zip(before);
        for ((command, last), (kind, limits)) in commands.zip(&self.joints) {
            let turns = ((last - *command) / 360.0).round();
            if *kind != MotionKind::Revolute || turns == 0.0 || !turns.is_finite() {
                continue;
            }
            let value = *command + 360.0 * turns;
            let is_within = limits.is_none_or(|[low, high]| (low..=high).contains(&value));
            if is_within || point.kind != PointKind::Rapid {
                *command = value;
            }
        }
    }

    /// Puts the figures of a point beside its joint values and drive loads.
    pub(crate) fn fill(&self, point: &mut PointResult) {
        point.nearest_limit = self.nearest_limit(&point.actuator_command);
        point.most_loaded = most_loaded(self.ratings, &point.actuator_force);
        point.configuration = self.configuration(&point.actuator_command);
    }

    /// The configuration at joint values, deg.
    fn configuration(&self, commands: &[f64]) -> Option<ArmConfiguration> {
        let arm = self.arm.as_ref()?;
        let commands: [f64; 6] = commands.try_into().ok()?;
        arm.configuration(&commands.map(f64::to_radians))
    }

    /// The joint nearest to a limit, of commands in mm or deg. Angles are compared with lengths at the machine's natural length.
    fn nearest_limit(&self, commands: &[f64]) -> Option<NearestLimit> {
        let mut nearest: Option<(f64, NearestLimit)> = None;
        for (actuator, (command, (kind, limits))) in commands.iter().zip(&self.joints).enumerate() {
            let Some([low, high]) = limits else { continue };
            let (end, distance) = match command - low <= high - command {
                true => (LimitEnd::Lower, command - low),
                false => (LimitEnd::Upper, high - command),
            };
            let far = match kind {
                MotionKind::Prismatic => distance,
                MotionKind::Revolute => distance * self.mm_per_deg,
            };
            if far.is_finite() && nearest.is_none_or(|(least, _)| far < least) {
                let found = NearestLimit {
                    actuator,
                    end,
                    distance,
                };
                nearest = Some((far, found));
            }
        }
        nearest.map(|(_, found)| found)
    }
}

/// The drive that carries the largest share of its rating, of forces in N and torques in N m; NaN counts as the largest.
pub(crate) fn most_loaded(ratings: &[Option<f64>], forces: &[f64]) -> Option<MostLoaded> {
    let mut most: Option<MostLoaded> = None;
    for (actuator, (rating, force)) in ratings.iter().zip(forces).enumerate() {
        let Some(rating) = rating else { continue };
        let share_of_rating = force.abs() / rating;
        if most.is_none_or(|m| share_of_rating > m.share_of_rating || share_of_rating.is_nan()) {
            most = Some(MostLoaded {
                actuator,
                share_of_rating,
            });
        }
    }
    most
}

/// Millimetres per metre or degrees per radian.
pub(crate) fn in_display(kind: MotionKind) -> f64 {
    match kind {
        MotionKind::Prismatic => 1e3,
        MotionKind::Revolute => 1_f64.to_degrees(),
    }
}

/// Axes meet or are parallel that do so within this: a tenth of a millimetre per metre, as models from rounded figures have it.
const CLOSE: f64 = 1e-4;

/// An arm of six axes with a wrist in one point: how shoulder, elbow and wrist change with joint values.
///
/// Elbow and wrist turn with joints 3 and 5 alone. The wrist's centre moves in the arm's plane with joints 2 and 3, and what counts
/// is how far it is from axis 1 in that plane: a sum of cosines and sines.
///
/// Six turning axes: 2 and 3 parallel, 1 at a right angle to them, and 4, 5, 6 through one point with right angles between
/// neighbours. The determinant of such an arm's Jacobian is a product of three factors, one each of shoulder, elbow and wrist, and the
/// sign of each is a flag of the configuration (Pieper 1968; Paul and Zhang, Int. J. Robotics Research 5(2), 1986).
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    /// Joints 2, 3 and 5 at home, rad; joint 3 as it turns about axis 2.
    home: [f64; 3],
    /// 1 if axis 3 points as axis 2 does, -1 if against it.
    third: f64,
    /// Axis 2 off axis 1, m.
    off: f64,
    /// Upper arm and forearm (to the wrist's centre) at home: off axis 1, and the same a quarter turn on, m.
    links: [[f64; 2]; 2],
    /// Elbow and wrist at home, rad.
    angles: [f64; 2],
    /// Signs that make front, elbow up and a wrist that is not flipped positive.
    signs: [f64; 3],
}

/// Axes of an arm at home: their directions and a point of each, base axes, m.
struct Axes {
    directions: [Vector3<f64>; 6],
    points: [Vector3<f64>; 6],
}

impl Axes {
    fn of(chain: &Chain) -> Option<Self> {
        let joints = six_turning(chain)?;
        let mut frame = Pose::identity();
        let mut found = Self {
            directions: [Vector3::zeros(); 6],
            points: [Vector3::zeros(); 6],
        };
        let home = chain.home_commands();
        for (joint, ((offset, axis), command)) in joints.iter().zip(home).enumerate() {
            frame *= offset;
            found.directions[joint] = frame.rotation * axis.into_inner();
            found.points[joint] = frame.translation.vector;
            frame *= UnitQuaternion::from_axis_angle(axis, command);
        }
        Some(found)
    }

    /// The point where axes 4, 5 and 6 meet; `None` if they do not within a distance, or if the angles are not those of an arm.
    fn wrist(&self, reach: f64) -> Option<Vector3<f64>> {
        let [first, second, third, fourth, fifth, sixth] = self.directions;
        let square = |a: &Vector3<f64>, b: &Vector3<f64>| a.dot(b).abs() < CLOSE;
        let angles = square(&first, &second)
            && second.cross(&third).norm() < CLOSE
            && square(&fourth, &fifth)
            && square(&fifth, &sixth);
        // Axis 5 is square to axis 4: where they meet is as far along axis 4 as any point of axis 5.
        let centre = self.points[3] + fourth * (self.points[4] - self.points[3]).dot(&fourth);
        let on = |axis: usize| {
            let off = centre - self.points[axis];
            off.cross(&self.directions[axis]).norm() < reach
        };
        (angles && on(4) && on(5)).then_some(centre)
    }
}

impl Arm {
    /// The arm that a machine is; `None` if it is another machine.
    pub(crate) fn of(mechanism: &Mechanism) -> Option<Self> {
        let [limb] = mechanism.limbs() else {
            return None;
        };
        let axes = Axes::of(&limb.nominal)?;
        let reach = CLOSE * mechanism.size();
        let centre = axes.wrist(reach)?;
        let [first, second, third, fourth, fifth, sixth] = axes.directions;
        // Out of axis 1 in the arm's plane.
        let out = second.cross(&first);
        let upper_arm = axes.points[2] - axes.points[1];
        let forearm = centre - axes.points[2];
        let third = second.dot(&third).signum();
        let commands = limb.nominal.home_commands();
        let mut arm = Self {
            home: [commands[1], third * commands[2], commands[4]],
            third,
            off: (axes.points[1] - axes.points[0]).dot(&out),
            links: [upper_arm, forearm].map(|link| [link.dot(&out), second.cross(&link).dot(&out)]),
            angles: [
                angle_about(&second, &upper_arm, &forearm),
                angle_about(&fifth, &fourth, &sixth),
            ],
            signs: [1.0; 3],
        };
        arm.signs = arm.signs_at_home(&axes, &commands, reach);
        Some(arm)
    }

    /// Signs that mean front, up and not flipped.
    fn signs_at_home(&self, axes: &Axes, commands: &[f64], reach: f64) -> [f64; 3] {
        let sign = |value: f64, otherwise: f64| match value == 0.0 {
            true => otherwise,
            false => value.signum(),
        };
        let [first, second, ..] = axes.directions;
        let front = match self.off.abs() > reach {
            true => self.off.signum(),
            false => sign(self.signed(commands)[0], 1.0),
        };
        let forward = second.cross(&first) * front;
        // Along axis 1, away from the base.
        let up = first * sign(axes.points[1].dot(&first), sign(first.z, 1.0));
        // An elbow that is up bends the forearm about axis 2 as up turns to the front.
        let bends = second.dot(&up.cross(&forward)).signum();
        let [_, wrist] = self.angles;
        let wrist = match wrist.abs() > CLOSE {
            true => wrist.signum(),
            false => 1.0,
        };
        [front, bends, wrist]
    }

    /// Shoulder, mm, elbow and wrist, deg, with the signs of the axes, at joint values, rad.
    fn signed(&self, commands: &[f64]) -> [f64; 3] {
        let &[_, second, third, _, fifth, _] = commands else {
            return [f64::NAN; 3];
        };
        let [second, third, fifth] = [
            second - self.home[0],
            self.third * third - self.home[1],
            fifth - self.home[2],
        ];
        let turned = |[along, across]: [f64; 2], angle: f64| {
            let (sine, cosine) = angle.sin_cos();
            along * cosine + across * sine
        };
        let [upper_arm, forearm] = self.links;
        let out = self.off + turned(upper_arm, second) + turned(forearm, second + third);
        let [elbow, wrist] = [self.angles[0] + third, self.angles[1] + fifth]
            .map(|angle| (angle - TAU * (angle / TAU).round()).to_degrees());
        [1e3 * out, elbow, wrist]
    }

    /// The configuration at joint values, rad; `None` if one of them is no number.
    pub(crate) fn configuration(&self, commands: &[f64]) -> Option<ArmConfiguration> {
        let signed = self.signed(commands);
        let [shoulder, elbow, wrist] = [0, 1, 2].map(|k| self.signs[k] * signed[k]);
        ArmConfiguration::of(shoulder, elbow, wrist)
    }
}

/// Angle from one direction to another about an axis, rad.
fn angle_about(axis: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    let across = |v: &Vector3<f64>| v - axis * axis.dot(v);
    let (from, to) = (across(from), across(to));
    axis.dot(&from.cross(&to)).atan2(from.dot(&to))
}

/// An offset and the axis behind it.
type Joint = (Pose, Unit<Vector3<f64>>);

/// Offsets and axes of a chain of six commanded turns and nothing else that moves but springs.
pub(crate) fn six_turning(chain: &Chain) -> Option<[Joint; 6]> {
    let passive =
        |index: usize| chain.coordinates().get(index).map(|c| c.role) != Some(Role::Spring);
    let mut joints: Vec<Joint> = Vec::new();
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
    joints.try_into().ok()
}
