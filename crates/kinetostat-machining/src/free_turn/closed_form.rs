//! The eight ways of an arm to a pose, in closed form.
//!
//! Axes 2 and 3 are parallel, 1 is at a right angle to them, and 4, 5 and 6 meet in the centre of the wrist at right angles between
//! neighbours (Pieper 1968): the centre goes where joints 1 to 3 bring it, and the orientation is left to joints 4 to 6. All angles
//! are counted from home, about the axes as they are there.

use kinetostat::{Mechanism, Pose};
use nalgebra::{Point3, Unit, UnitQuaternion, Vector2, Vector3};

use crate::free_turn::serial::{Joints, SerialArm};
use crate::joints::Arm;

/// Reason for which an arm does not reach a pose in a configuration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoWayThere {
    /// The pose is too far, or too near.
    OutOfReach,
    /// The posture is so near to a singular one that joint values are not found.
    Singular,
}

/// An arm with what its closed form needs.
#[derive(Clone, Debug)]
pub(crate) struct SixAxisArm {
    pub serial: SerialArm,
    pub flags: Arm,
    directions: [Unit<Vector3<f64>>; 6],
    points: [Point3<f64>; 6],
    tool: Pose,
    wrist: Point3<f64>,
    /// Out of axis 1 in the plane of the arm, at home.
    out: Vector3<f64>,
    /// 1 if axis 3 points as axis 2 does, -1 if against it.
    third: f64,
    /// Angle from axis 4 to axis 6 about axis 5, at home, rad.
    bend: f64,
}

/// Rotation in the plane of the arm by an angle about axis 2: from up to out.
fn turned(v: Vector2<f64>, angle: f64) -> Vector2<f64> {
    let (sine, cosine) = angle.sin_cos();
    Vector2::new(v.x * cosine + v.y * sine, v.y * cosine - v.x * sine)
}

/// Angle from a direction to another about an axis, rad.
fn about(axis: &Vector3<f64>, from: &Vector3<f64>, to: &Vector3<f64>) -> f64 {
    axis.dot(&from.cross(to))
        .atan2(from.dot(to) - axis.dot(from) * axis.dot(to))
}

impl SixAxisArm {
    /// The arm that a machine is; `None` if it is another machine.
    pub fn of(mechanism: &Mechanism) -> Option<Self> {
        let flags = Arm::of(mechanism)?;
        let mut serial = SerialArm::of(mechanism)?;
        let (directions, points, tool) = serial.at_home();
        let [first, second, third, fourth, fifth, sixth] = directions;
        let wrist = points[3] + fourth * (points[4] - points[3]).dot(&fourth);
        // Square to axis 2, where links are as long whatever points of the axes are known.
        let links = [points[2] - points[1], wrist - points[2]];
        serial.length = 0.5
            * links
                .map(|link| link.cross(&second).norm())
                .iter()
                .sum::<f64>();
        Some(Self {
            serial,
            flags,
            directions: directions.map(Unit::new_normalize),
            points,
            tool,
            wrist,
            out: second.cross(&first),
            third: second.dot(&third).signum(),
            bend: about(&fifth, &fourth, &sixth),
        })
    }

    /// A vector in the plane of the arm at home: off axis 1, along axis 1.
    fn in_plane(&self, v: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.out.dot(v), self.directions[0].dot(v))
    }

    fn turn(&self, joint: usize, angle: f64) -> Pose {
        let rotation = UnitQuaternion::from_axis_angle(&self.directions[joint], angle);
        Pose::rotation_wrt_point(rotation, self.points[joint])
    }

    /// Joint values of up to eight ways to a pose of the tool, rad, each somewhere on its circle.
    pub fn ways(&self, target: &Pose) -> [Result<Joints, NoWayThere>; 8] {
        let moved = target * self.tool.inverse();
        let mut ways = [Err(NoWayThere::OutOfReach); 8];
        for (front, reach) in [1.0, -1.0].into_iter().enumerate() {
            for (up, bent) in [1.0, -1.0].into_iter().enumerate() {
                let Some(first) = self.to_wrist(&(moved * self.wrist), reach, bent) else {
                    continue;
                };
                for (flip, side) in [1.0, -1.0].into_iter().enumerate() {
                    let found = self.through_wrist(&moved, first, side);
                    // Angles between axes are right only within a tolerance.
                    let found = self.serial.near(target, &found);
                    ways[4 * front + 2 * up + flip] = found.ok_or(NoWayThere::Singular);
                }
            }
        }
        ways
    }

    /// Turns of joints 1 to 3 from home that bring the centre of the wrist to a point.
    fn to_wrist(&self, wrist: &Point3<f64>, reach: f64, bent: f64) -> Option<[f64; 3]> {
        let second = self.directions[1].into_inner();
        let from_first = wrist - self.points[0];
        let (x, y) = (self.out.dot(&from_first), second.dot(&from_first));
        let beside = second.dot(&(self.wrist - self.points[0]));
        let square = x * x + y * y - beside * beside;
        if square.is_nan() || square < 0.0 {
            return None;
        }
        let out = reach * square.sqrt();
        let one = y.atan2(x) - beside.atan2(out);
        let shoulder = self.in_plane(&(self.points[1] - self.points[0]));
        let wanted = Vector2::new(out, self.directions[0].dot(&from_first)) - shoulder;
        let upper_arm = self.in_plane(&(self.points[2] - self.points[1]));
        let forearm = self.in_plane(&(self.wrist - self.points[2]));
        // The law of cosines, with angles from home.
        let along = upper_arm.dot(&forearm);
        let across = upper_arm.x * forearm.y - upper_arm.y * forearm.x;
        let cosine = 0.5
            * (wanted.norm_squared() - upper_arm.norm_squared() - forearm.norm_squared())
            / along.hypot(across);
        if cosine.is_nan() || cosine.abs() > 1.0 {
            return None;
        }
        let three = across.atan2(along) + bent * cosine.acos();
        let reached = upper_arm + turned(forearm, three);
        let two = wanted.x.atan2(wanted.y) - reached.x.atan2(reached.y);
        Some([one, two, self.third * three])
    }

    /// Joint values with those of the wrist, bent to one side.
    fn through_wrist(&self, moved: &Pose, first: [f64; 3], side: f64) -> Joints {
        let before = self.turn(0, first[0]) * self.turn(1, first[1]) * self.turn(2, first[2]);
        let wrist = before.rotation.inverse() * moved.rotation;
        let [fourth, fifth, sixth] = [3, 4, 5].map(|joint| self.directions[joint].into_inner());
        let across = fifth.cross(&fourth);
        let tip = wrist * sixth;
        let bend = side * tip.dot(&fourth).clamp(-1.0, 1.0).acos();
        let four = (side * tip.dot(&fifth)).atan2(side * tip.dot(&across));
        let five = bend - self.bend;
        let before = (self.turn(3, four) * self.turn(4, five)).rotation;
        let six = about(&sixth, &fifth, &(before.inverse() * wrist * fifth));
        let turns = [first[0], first[1], first[2], four, five, six];
        let mut joints = self.serial.home;
        for (joint, turn) in joints.iter_mut().zip(turns) {
            *joint += turn;
        }
        joints
    }
}
