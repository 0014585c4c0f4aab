//! Postures of an arm at a station: its joint values at every turn of the band, in every configuration and on every turn of its joints.

use std::f64::consts::{PI, TAU};

use kinetostat::machine::LimbPosture;
use kinetostat::number::larger;
use kinetostat::{Mechanism, Pose, PostureRequest};
use nalgebra::Vector3;

use crate::free_turn::closed_form::{NoWayThere, SixAxisArm};
use crate::free_turn::error::TurnError;
use crate::free_turn::serial::Joints;
use crate::free_turn::task::{TipCompliance, TurnCriterion, TurnTask};
use crate::free_turn::way::{Station, Turns, Way};

/// One posture at one station.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    /// Number of the turn in the band; of a posture at a turn between those of the band, of the one that it was found from.
    pub turn: u32,
    /// Number of the configuration.
    pub configuration: u8,
    /// Joint values, rad, on the turn of each joint on which it is.
    pub joints: Joints,
    /// Share of half its range by which the joint nearest to a limit is off the middle; 0 without limits.
    pub share_of_range: f64,
    /// Smallest singular value.
    pub singular_value: f64,
    /// m/N; 0 where nothing asks for it.
    pub compliance: f64,
    /// Cost per share of the way.
    pub cost: f64,
}

/// Reason for which there is no posture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Refused {
    OutOfReach,
    Limit(usize),
    Singular,
}

/// The criteria of a task, added up by kind.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Weights {
    limits: f64,
    singularity: f64,
    pub turning: f64,
    compliance: f64,
    of: Option<TipCompliance>,
}

impl Weights {
    /// Sums criteria whose weights have been checked.
    pub fn of(criteria: &[TurnCriterion]) -> Self {
        let mut own = Self::default();
        for criterion in criteria {
            match criterion {
                TurnCriterion::Limits { weight } => own.limits += weight,
                TurnCriterion::Singularity { weight } => own.singularity += weight,
                TurnCriterion::Turning { weight } => own.turning += weight,
                TurnCriterion::Compliance { weight, of } => {
                    own.compliance += weight;
                    own.of = Some(*of);
                }
            }
        }
        own
    }
}

/// An arm with what its postures are held against.
#[derive(Clone, Debug)]
pub(crate) struct Postures<'a> {
    mechanism: &'a Mechanism,
    pub arm: SixAxisArm,
    pub weights: Weights,
    least_singular_value: f64,
    pub ranges: JointRanges,
    configuration: Option<u8>,
    /// Direction of a compliance, base axes.
    along: Vector3<f64>,
    /// The least compliance of all postures that are tried, m/N.
    least_compliance: f64,
}

impl<'a> Postures<'a> {
    pub fn of(task: &TurnTask<'a>) -> Result<Self, TurnError> {
        let arm =
            SixAxisArm::of(task.mechanism).ok_or_else(|| TurnError::no_freedom(task.mechanism))?;
        let weights = Weights::of(&task.criteria);
        let ranges = JointRanges {
            limits: arm.serial.limits,
            margin: task.bounds.limit_margin_deg.to_radians(),
        };
        let along = match weights.of {
            Some(TipCompliance::Along(direction)) => {
                task.placement.to_base_axes(&direction).normalize()
            }
            _ => Vector3::zeros(),
        };
        Ok(Self {
            mechanism: task.mechanism,
            arm,
            weights,
            least_singular_value: task.bounds.least_singular_value,
            ranges,
            configuration: task.bounds.configuration,
            along,
            least_compliance: 0.0,
        })
    }

    /// All postures at a station, by configuration, then by turn.
    pub fn at(
        &self,
        station: &Station,
        way: &Way<'_>,
        turns: &Turns,
    ) -> Result<Vec<Node>, TurnError> {
        let mut nodes = Vec::new();
        for turn in 0..turns.count as u32 {
            let pose = way.turned(&station.place.pose, turns.deg(turn));
            for way in self.arm.ways(&pose) {
                let Ok((configuration, joints, singular_value)) = self.held(way) else {
                    continue;
                };
                let mut compliance = None;
                let mut failed = Ok(());
                self.ranges.on_turns(&joints, |joints| {
                    let compliance = *compliance.get_or_insert_with(|| {
                        self.compliance(&pose, &joints).unwrap_or_else(|error| {
                            failed = Err(TurnError::Point {
                                line: station.place.line,
                                message: error.to_string(),
                            });
                            f64::NAN
                        })
                    });
                    nodes.push(Node {
                        turn,
                        configuration,
                        joints,
                        share_of_range: self.ranges.share_of_range(&joints),
                        singular_value,
                        compliance,
                        cost: 0.0,
                    });
                });
                failed?;
            }
        }
        nodes.sort_by_key(|node| (node.configuration, node.turn));
        Ok(nodes)
    }

    /// Configuration, joint values and smallest singular value of a way that may be gone, but for limits.
    fn held(&self, way: Result<Joints, NoWayThere>) -> Result<(u8, Joints, f64), Refused> {
        let joints = way.map_err(|why| match why {
            NoWayThere::OutOfReach => Refused::OutOfReach,
            NoWayThere::Singular => Refused::Singular,
        })?;
        let number = self.configuration_of(&joints).ok_or(Refused::Singular)?;
        if self.configuration.is_some_and(|only| only != number) {
            return Err(Refused::OutOfReach);
        }
        let mut all = (0..6).zip(joints);
        if let Some((joint, _)) = all.find(|(joint, angle)| !self.ranges.reaches(*joint, *angle)) {
            return Err(Refused::Limit(joint));
        }
        let least = self.arm.serial.smallest_singular_value(&joints);
        match least >= self.least_singular_value {
            true => Ok((number, joints, least)),
            false => Err(Refused::Singular),
        }
    }

    /// Every way to a pose, with why it may not be gone.
    pub fn refusals(&self, pose: &Pose) -> Vec<(Option<u8>, Result<(), Refused>)> {
        let ways = self.arm.ways(pose).into_iter();
        ways.map(|way| {
            let number = way.ok().and_then(|joints| self.configuration_of(&joints));
            (number, self.held(way).map(|_| ()))
        })
        .collect()
    }

    /// The number of the configuration at joint values.
    pub fn configuration_of(&self, joints: &Joints) -> Option<u8> {
        self.arm
            .flags
            .configuration(joints)
            .map(|found| found.number)
    }

    /// Checks that joint values are inside the limits and far enough from singular; returns the smallest singular
    /// value.
    pub fn allowed(&self, joints: &Joints) -> Result<f64, Refused> {
        if let Some(joint) = self.ranges.left_by(joints) {
            return Err(Refused::Limit(joint));
        }
        let least = self.arm.serial.smallest_singular_value(joints);
        match least >= self.least_singular_value {
            true => Ok(least),
            false => Err(Refused::Singular),
        }
    }

    /// The compliance that a criterion asks for, m/N.
    fn compliance(&self, pose: &Pose, joints: &Joints) -> kinetostat::Result<f64> {
        let Some(of) = self.weights.of else {
            return Ok(0.0);
        };
        let limbs = self.mechanism.limbs().iter();
        let limbs = limbs.map(|limb| LimbPosture {
            commands: joints.to_vec(),
            coordinates: limb.nominal.home_coordinates(),
        });
        let posture = self
            .mechanism
            .posture(PostureRequest::joints(pose, limbs.collect()))?;
        let compliance = posture.stiffness()?.compliance().springs;
        let of_force = compliance.fixed_view::<3, 3>(0, 0).into_owned();
        Ok(match of {
            TipCompliance::Along(_) => self.along.dot(&(of_force * self.along)),
            TipCompliance::Worst => {
                let even = 0.5 * (of_force + of_force.transpose());
                even.symmetric_eigenvalues()
                    .iter()
                    .copied()
                    .fold(0.0, larger)
            }
        })
    }

    /// Puts what every posture costs beside it; compliances are compared with the least one of all.
    pub fn put_costs(&mut self, nodes: &mut [Vec<Node>]) {
        let all = || nodes.iter().flatten().map(|node| node.compliance);
        self.least_compliance = all().fold(f64::INFINITY, kinetostat::number::smaller);
        for node in nodes.iter_mut().flatten() {
            node.cost = self.cost(node);
        }
    }

    /// Cost of a posture per share of the way.
    fn cost(&self, node: &Node) -> f64 {
        let weights = &self.weights;
        let singular = self.least_singular_value / node.singular_value;
        let soft = match weights.of.is_some() && self.least_compliance > 0.0 {
            true => node.compliance / self.least_compliance,
            false => 0.0,
        };
        weights.limits * node.share_of_range.powi(2)
            + weights.singularity * singular * singular
            + weights.compliance * soft
    }

    /// The posture at a pose next to another one, in its configuration and on the turns of its joints; `None` if it is not allowed.
    pub fn next_to(&self, other: &Node, pose: &Pose) -> Option<Node> {
        let joints = self.arm.serial.near(pose, &other.joints)?;
        let singular_value = self.allowed(&joints).ok()?;
        if self.configuration_of(&joints) != Some(other.configuration) {
            return None;
        }
        let mut node = Node {
            joints,
            share_of_range: self.ranges.share_of_range(&joints),
            singular_value,
            compliance: self.compliance(pose, &joints).ok()?,
            ..*other
        };
        node.cost = self.cost(&node);
        Some(node)
    }
}

/// Values of a joint that are whole turns apart are tried so far from the middle of its range, rad.
const MOST_TURNS: f64 = 3.0 * TAU;

/// Limits of six turning joints, and how far they are kept from them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointRanges {
    /// rad; a joint without limits turns on and on.
    pub limits: [Option<(f64, f64)>; 6],
    /// rad.
    pub margin: f64,
}

impl JointRanges {
    /// Limits of a joint less what is kept from them, rad.
    fn range(&self, joint: usize) -> (f64, f64) {
        self.limits[joint].map_or((f64::NEG_INFINITY, f64::INFINITY), |(low, high)| {
            (low + self.margin, high - self.margin)
        })
    }

    /// A joint without limits turns on and on.
    pub fn is_free(&self, joint: usize) -> bool {
        self.limits[joint].is_none()
    }

    /// Values of a joint, rad: those inside its limits that are whole turns apart, or the one within half a turn of zero.
    fn values_of(&self, joint: usize, angle: f64) -> impl Iterator<Item = f64> + use<> {
        let (low, high) = match self.is_free(joint) {
            true => (-PI, PI),
            false => self.range(joint),
        };
        // A joint of a very large range is restricted to the turns around its middle.
        let middle = 0.5 * (low + high);
        let (low, high) = (low.max(middle - MOST_TURNS), high.min(middle + MOST_TURNS));
        let first = angle + TAU * ((low - angle) / TAU).ceil();
        let free = self.is_free(joint);
        (0..)
            .map(move |turn| first + TAU * f64::from(turn))
            .take_while(move |value| *value <= high)
            .take(match free {
                true => 1,
                false => usize::MAX,
            })
    }

    /// All combinations of whole turns.
    pub fn on_turns(&self, joints: &Joints, mut each: impl FnMut(Joints)) {
        let values: Vec<Vec<f64>> = (0..6)
            .map(|joint| self.values_of(joint, joints[joint]).collect())
            .collect();
        let count: usize = values.iter().map(Vec::len).product();
        for number in 0..count {
            let mut rest = number;
            let mut on = *joints;
            for joint in 0..6 {
                on[joint] = values[joint][rest % values[joint].len()];
                rest /= values[joint].len();
            }
            each(on);
        }
    }

    /// Share of half its range by which the joint nearest to a limit is off the middle.
    pub fn share_of_range(&self, joints: &Joints) -> f64 {
        let limits = self.limits.iter().zip(joints);
        let shares = limits.filter_map(|(limits, angle)| {
            let (low, high) = (*limits)?;
            Some((angle - 0.5 * (low + high)).abs() / (0.5 * (high - low)))
        });
        shares.fold(0.0, larger)
    }

    /// The joint nearest to a limit and how far it is from it, rad.
    pub fn nearest_limit(&self, joints: &Joints) -> Option<(usize, f64)> {
        let limits = self.limits.iter().zip(joints).enumerate();
        let far = limits.filter_map(|(joint, (limits, angle))| {
            let (low, high) = (*limits)?;
            Some((joint, (angle - low).min(high - angle)))
        });
        far.min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// True if a joint can be at an angle, or whole turns from it.
    pub fn reaches(&self, joint: usize, angle: f64) -> bool {
        self.values_of(joint, angle).next().is_some()
    }

    /// The first joint that is outside its range.
    pub fn left_by(&self, joints: &Joints) -> Option<usize> {
        (0..6).find(|joint| {
            let (low, high) = self.range(*joint);
            !(low..=high).contains(&joints[*joint])
        })
    }
}
