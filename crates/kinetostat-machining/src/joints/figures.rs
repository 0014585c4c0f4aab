//! Distance to limits, share of ratings and configuration at a point, from its joint values and drive loads.

use kinetostat::{Mechanism, MotionKind};

use crate::joints::arm::Arm;
use crate::near::natural_length;
use crate::result::joints::{ArmConfiguration, LimitEnd, MostLoaded, NearestLimit};
use crate::result::point::{PointKind, PointResult};

/// What joint values and drive loads of a machine are compared with.
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

    /// The arm that the machine is; none if it is another machine.
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
