//! The other configurations in which an arm reaches a pose, where the one next to home leaves the limits of a joint.
//!
//! Takes one place by itself. Along a program an arm stays in the configuration in which it comes along, and nothing here is asked.

use std::f64::consts::{PI, TAU};

use kinetostat::machine::LimbPosture;
use kinetostat::model::Role;
use kinetostat::{Error, Mechanism, MotionKind, Pose, Posture, PostureRequest, Result};

use crate::free_turn::closed_form::SixAxisArm;
use crate::free_turn::serial::Joints;

/// Maximum number of joints: an arm with more of them than a pose has numbers has no end of postures.
const MOST_JOINTS: usize = 6;

/// Shares of the range of a joint from which an arm without a closed form is looked at.
const SHARES: [f64; 2] = [1.0 / 6.0, 5.0 / 6.0];

/// Shapes from which all postures of an arm without a closed form are looked for.
const STARTS: usize = 128;

/// Joint values that differ by less are the same, rad or natural lengths.
const SAME: f64 = 1e-6;

/// An arm, and in which configurations it reaches a pose.
///
/// ```
/// use kinetostat_machining::Configurations;
/// use kinetostat_model::Model;
///
/// let arm = Model::preset("scara")?.mechanism;
/// // Joint values within the limits, with the elbow on the other side than at home; rad, m.
/// let joints = [0.4, -1.9, -0.05, 0.3];
/// let pose = *arm.posture(kinetostat::PostureRequest::commands(&joints))?.target();
/// let found = Configurations::of(&arm).posture(&pose)?;
/// assert!(found.within_limits().is_ok());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Configurations {
    mechanism: Mechanism,
    ways: Ways,
}

/// Method by which the configurations of a machine are found.
#[derive(Clone, Debug)]
enum Ways {
    /// Closed form.
    SixAxes(Box<SixAxisArm>),
    /// Next to some postures.
    NextTo(Vec<Posture>),
    /// Only the posture next to home is known.
    One,
}

impl Configurations {
    /// Configurations of a machine with its tool.
    #[must_use]
    pub fn of(mechanism: &Mechanism) -> Self {
        Self {
            mechanism: mechanism.clone(),
            ways: Ways::of(mechanism),
        }
    }

    /// The machine commanded for a pose: next to home, and where that leaves the limits of a joint or does not get there, in the
    /// configuration within all limits whose joints are nearest to home. Without one, what is found next to home.
    ///
    /// # Errors
    /// As [`Mechanism::posture`].
    pub fn posture(&self, pose: &Pose) -> Result<Posture> {
        let first = self.mechanism.posture(pose);
        match needs_another(&first) {
            true => self.within_limits(pose).map_or(first, Ok),
            false => first,
        }
    }

    /// False of a machine of which only the posture next to home is known.
    #[must_use]
    pub fn are_several(&self) -> bool {
        !matches!(self.ways, Ways::One)
    }

    /// The posture within all limits whose joints are nearest to home, in any configuration that is found; none without one.
    #[must_use]
    pub fn within_limits(&self, pose: &Pose) -> Option<Posture> {
        let found: Vec<Posture> = match &self.ways {
            Ways::SixAxes(arm) => {
                let ways = arm.ways(pose).into_iter().flatten();
                let turned = ways.filter_map(|way| turned_into_limits(&arm.serial, way));
                let nearest = turned.min_by(|(_, a), (_, b)| a.total_cmp(b));
                let posture = nearest.and_then(|(joints, _)| self.standing(&joints, pose));
                posture.into_iter().collect()
            }
            Ways::NextTo(starts) => {
                let near = |start| {
                    self.mechanism
                        .posture(PostureRequest::pose(pose).near(start))
                };
                let found = starts.iter().filter_map(|start| near(start).ok());
                found.filter(|p| p.within_limits().is_ok()).collect()
            }
            Ways::One => return None,
        };
        let away = |p: &Posture| away_from_home(&self.mechanism, &p.commands());
        found.into_iter().min_by(|a, b| away(a).total_cmp(&away(b)))
    }

    /// All postures of an arm at a pose, those within all limits first, then by their distance from home; commands of joints that
    /// turn are those nearest to home, or within their limits. In closed form for arms with six axes and a spherical wrist; of
    /// other arms those that Newton's iteration finds from home and from 128 shapes spread over the ranges of the joints.
    #[must_use]
    pub fn all(&self, pose: &Pose) -> Vec<Posture> {
        let ask = |request: PostureRequest<'_>| self.mechanism.posture(request).ok();
        let found: Vec<Posture> = match &self.ways {
            Ways::SixAxes(arm) => {
                let ways = arm.ways(pose).into_iter().flatten();
                ways.filter_map(|way| self.reached(&way, pose)).collect()
            }
            _ => {
                let starts = (1..=STARTS).map(|k| self.spread(k));
                let near = starts.filter_map(|commands| {
                    let start = ask(PostureRequest::commands(&commands))?;
                    ask(PostureRequest::pose(pose).near(&start))
                });
                ask(PostureRequest::pose(pose))
                    .into_iter()
                    .chain(near)
                    .collect()
            }
        };
        let mut different: Vec<Posture> = Vec::new();
        for posture in found {
            let posture = self.next_to_home(posture);
            let same = |other: &Posture| self.is_same(&posture.commands(), &other.commands());
            if !different.iter().any(same) {
                different.push(posture);
            }
        }
        let rank = |p: &Posture| {
            let outside = f64::from(u8::from(p.within_limits().is_err()));
            (outside, away_from_home(&self.mechanism, &p.commands()))
        };
        different.sort_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        different
    }

    /// Joint values of the `k`-th start, spread evenly over the ranges of the joints.
    fn spread(&self, k: usize) -> Vec<f64> {
        let drives = self.mechanism.limbs().iter();
        let drives = drives.flat_map(|limb| limb.nominal.actuators());
        let length = self.mechanism.natural_length();
        // Multiples of the roots of primes are spread evenly, whatever their number.
        drives
            .zip(
                [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0]
                    .into_iter()
                    .cycle(),
            )
            .map(|(drive, prime)| {
                let half = match drive.kind {
                    MotionKind::Prismatic => length,
                    MotionKind::Revolute => PI,
                };
                let (low, high) = (drive.limits).unwrap_or((drive.home - half, drive.home + half));
                low + (high - low) * (prime.sqrt() * k as f64).fract()
            })
            .collect()
    }

    /// Posture with its turning joints shifted by full turns to within limits, or nearest to home.
    fn next_to_home(&self, posture: Posture) -> Posture {
        let [limb] = posture.limbs() else {
            return posture;
        };
        let drives = self.mechanism.limbs()[0].nominal.actuators();
        let commands = drives.iter().zip(&limb.commands).map(|(drive, x)| {
            let nearest = x - TAU * ((x - drive.home) / TAU).round();
            match (drive.kind, drive.limits) {
                (MotionKind::Prismatic, _) => *x,
                (MotionKind::Revolute, None) => nearest,
                (MotionKind::Revolute, Some((low, high))) => {
                    [nearest, nearest - TAU, nearest + TAU]
                        .into_iter()
                        .find(|x| (low..=high).contains(x))
                        .unwrap_or(nearest)
                }
            }
        });
        let mut limb = limb.clone();
        limb.commands = commands.collect();
        let turned = PostureRequest::joints(posture.target(), vec![limb]);
        self.mechanism.posture(turned).unwrap_or(posture)
    }

    fn is_same(&self, one: &[f64], other: &[f64]) -> bool {
        let drives = self.mechanism.limbs().iter();
        let drives = drives.flat_map(|limb| limb.nominal.actuators());
        let length = self.mechanism.natural_length();
        drives.zip(one.iter().zip(other)).all(|(drive, (a, b))| {
            let apart = match drive.kind {
                MotionKind::Prismatic => (a - b) / length,
                MotionKind::Revolute => (a - b) - TAU * ((a - b) / TAU).round(),
            };
            apart.abs() < SAME
        })
    }

    /// The machine at a pose, next to these joint values.
    fn reached(&self, joints: &Joints, pose: &Pose) -> Option<Posture> {
        let limb = self.mechanism.limbs().first()?;
        let start = LimbPosture {
            commands: joints.to_vec(),
            coordinates: limb.nominal.home_coordinates(),
        };
        let start = self
            .mechanism
            .posture(PostureRequest::joints(pose, vec![start]));
        let request = PostureRequest::pose(pose);
        self.mechanism.posture(request.near(&start.ok()?)).ok()
    }

    /// Posture within all limits.
    fn standing(&self, joints: &Joints, pose: &Pose) -> Option<Posture> {
        let found = self.reached(joints, pose);
        found.filter(|p| p.within_limits().is_ok())
    }
}

/// The machine commanded for a pose as by [`Configurations::posture`], for one pose.
///
/// # Errors
/// As [`Mechanism::posture`].
pub fn posture_at(mechanism: &Mechanism, pose: &Pose) -> Result<Posture> {
    let first = mechanism.posture(pose);
    match needs_another(&first) {
        true => Configurations::of(mechanism)
            .within_limits(pose)
            .map_or(first, Ok),
        false => first,
    }
}

fn needs_another(first: &Result<Posture>) -> bool {
    match first {
        Ok(posture) => posture.within_limits().is_err(),
        Err(error) => matches!(error, Error::Unreachable { .. }),
    }
}

impl Ways {
    fn of(mechanism: &Mechanism) -> Self {
        if let Some(arm) = SixAxisArm::of(mechanism) {
            return Self::SixAxes(Box::new(arm));
        }
        let [limb] = mechanism.limbs() else {
            return Self::One;
        };
        let chain = &limb.nominal;
        let passive = !chain.indices_of(Role::Passive).is_empty();
        let drives = chain.actuators();
        if passive || drives.len() > MOST_JOINTS {
            return Self::One;
        }
        let at = |joint: usize| match (drives.get(joint)?.kind, drives[joint].limits) {
            (MotionKind::Revolute, Some((low, high))) => {
                Some(SHARES.map(|share| low + share * (high - low)).to_vec())
            }
            _ => None,
        };
        let home = chain.home_commands();
        let Some(first) = home.first().copied() else {
            return Self::One;
        };
        let turned = at(0).unwrap_or_else(|| vec![first]);
        // An elbow is a joint between others: it is bent to either side.
        let inner = 1..drives.len().saturating_sub(1);
        let bent = inner.flat_map(|joint| at(joint).into_iter().flatten().map(move |x| (joint, x)));
        let each = bent.flat_map(|bent| turned.iter().map(move |turned| (*turned, bent)));
        let starts = each.map(|(turned, (joint, bent))| {
            let mut commands = home.clone();
            (commands[0], commands[joint]) = (turned, bent);
            mechanism.posture(PostureRequest::commands(&commands)).ok()
        });
        let starts: Vec<Posture> = starts.flatten().collect();
        match starts.is_empty() {
            true => Self::One,
            false => Self::NextTo(starts),
        }
    }
}

/// Joint values on those of their circles that are within limits and nearest to home, and how far that is, rad squared; none where a
/// joint has none within its limits.
fn turned_into_limits(
    arm: &crate::free_turn::serial::SerialArm,
    way: Joints,
) -> Option<(Joints, f64)> {
    let (mut joints, mut away) = (way, 0.0);
    for (joint, (home, limits)) in joints.iter_mut().zip(arm.home.iter().zip(arm.limits)) {
        let nearest = *joint - TAU * ((*joint - home) / TAU).round();
        let (low, high) = limits.unwrap_or((f64::NEG_INFINITY, f64::INFINITY));
        let circles = [nearest, nearest - TAU, nearest + TAU].into_iter();
        let within = circles.filter(|angle| (low..=high).contains(angle));
        let distance = |angle: &f64| (angle - home).abs();
        *joint = within.min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        away += distance(joint).powi(2);
    }
    Some((joints, away))
}

/// Sum of the squares of all commands from home, slides as shares of the natural length.
fn away_from_home(mechanism: &Mechanism, commands: &[f64]) -> f64 {
    let length = mechanism.natural_length();
    let drives = mechanism.limbs().iter().flat_map(|l| l.nominal.actuators());
    let each = drives
        .zip(commands)
        .map(|(drive, command)| match drive.kind {
            MotionKind::Prismatic => (command - drive.home) / length,
            MotionKind::Revolute => command - drive.home,
        });
    each.map(|x| x * x).sum()
}
