//! Distance to limits, share of ratings and configuration at a point, from its joint values and drive loads.

use kinetostat::{Mechanism, MotionKind};

use crate::joints::arm::Arm;
use crate::near::natural_length;
use crate::result::joints::{LimitEnd, MostLoaded, NearestLimit};
use crate::result::point::PointResult;

/// What joint values and drive loads of a machine are compared with.
#[derive(Clone, Debug)]
pub(crate) struct JointFigures<'r> {
    /// Kind and limits, m or rad, of every actuator.
    joints: Vec<(MotionKind, Option<(f64, f64)>)>,
    ratings: &'r [Option<f64>],
    arm: Option<Arm>,
    /// At which length angles are compared with lengths, m.
    length: f64,
}

impl<'r> JointFigures<'r> {
    pub(crate) fn new(mechanism: &Mechanism, ratings: &'r [Option<f64>]) -> Self {
        let limbs = mechanism.limbs().iter();
        Self {
            joints: limbs
                .flat_map(|limb| limb.nominal.actuators())
                .map(|actuator| (actuator.kind, actuator.limits))
                .collect(),
            ratings,
            arm: Arm::of(mechanism),
            length: natural_length(mechanism),
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
        self.joints.iter().map(|(kind, limits)| {
            limits.map(|(low, high)| [low, high].map(|limit| in_display(*kind) * limit))
        })
    }

    /// Puts the figures of a point beside its joint values and drive loads.
    pub(crate) fn fill(&self, point: &mut PointResult) {
        let kinds = self.joints.iter().map(|joint| in_display(joint.0));
        let commands = point.actuator_command.iter().zip(kinds);
        let commands: Vec<f64> = commands.map(|(value, factor)| value / factor).collect();
        point.nearest_limit = self.nearest_limit(&commands);
        point.most_loaded = most_loaded(self.ratings, &point.actuator_force);
        let arm = self.arm.as_ref();
        point.configuration = arm.and_then(|arm| arm.configuration(&commands));
    }

    /// The joint nearest to a limit, of commands in m or rad. Angles are compared with lengths at the machine's natural length.
    fn nearest_limit(&self, commands: &[f64]) -> Option<NearestLimit> {
        let mut nearest: Option<(f64, NearestLimit)> = None;
        for (actuator, (command, (kind, limits))) in commands.iter().zip(&self.joints).enumerate() {
            let Some((low, high)) = limits else { continue };
            let (end, distance) = match command - low <= high - command {
                true => (LimitEnd::Lower, command - low),
                false => (LimitEnd::Upper, high - command),
            };
            let far = match kind {
                MotionKind::Prismatic => distance,
                MotionKind::Revolute => distance * self.length,
            };
            if far.is_finite() && nearest.is_none_or(|(least, _)| far < least) {
                let distance = in_display(*kind) * distance;
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
