//! The chain of a machine with one limb, commanded for a place, with everything that acts on it.

use kinetostat::{Chain, ChainProblem, EndCondition, Load, Mechanism, Parameter, Pose, Posture};

use crate::movable::{MovableDirections, motions_near};

/// A serial chain from the base to the tool's tip.
#[derive(Clone, Debug)]
pub struct SerialChain {
    /// Chain with the tool's tip as its end.
    pub chain: Chain,
    /// Pose where the chain begins.
    pub base: Pose,
    /// Commands of its actuators, m or rad.
    pub commands: Vec<f64>,
    /// Coordinates of the commanded, unloaded posture, m or rad.
    pub posture: Vec<f64>,
    /// Gravity and everything else that acts all the time.
    pub loads: Vec<Load>,
    /// Commanded pose of the tool.
    pub place: Pose,
}

/// True if a machine is one chain from the base to the tool.
#[must_use]
pub fn is_serial_chain(mechanism: &Mechanism) -> bool {
    matches!(mechanism.limbs(), [limb] if limb.from == 0 && limb.to == mechanism.tool())
}

impl SerialChain {
    /// The chain of a machine that [`is_serial_chain`], as it stands; its tool is commanded to be at `place`.
    ///
    /// # Errors
    /// The end of the chain cannot be moved to the tool's tip.
    pub fn of(posture: &Posture, place: Pose) -> kinetostat::Result<Self> {
        let m = posture.mechanism();
        let (tool, limb) = (m.tool(), &m.limbs()[0]);
        let joints = &posture.limbs()[0];
        let offset = limb.platform_from_tip.inverse();
        // The old end keeps what acts on it; results refer to the tool's tip.
        let chain = if offset == Pose::identity() {
            limb.actual.clone()
        } else {
            let free = ["flange", "flange of the tool", "last frame of the chain"];
            let taken = limb.actual.nodes();
            let name = free.iter().find(|n| !taken.iter().any(|t| t == *n));
            limb.actual
                .with_end(name.copied().unwrap_or("old tip"), &offset)?
        };
        let gravity = m.gravity();
        let platform = &m.platforms()[tool];
        let mut loads = Vec::new();
        if gravity.norm() > 0.0 && !chain.bodies().is_empty() {
            loads.push(Load::gravity(gravity));
        }
        loads.extend(m.loads(0).iter().cloned());
        if gravity.norm() > 0.0 && platform.mass > 0.0 {
            loads.push(Load::counterweight(
                chain.tip(),
                platform.centre_of_mass,
                platform.mass,
                gravity,
            ));
        }
        Ok(Self {
            base: m.platforms()[0].home,
            commands: joints.commands.clone(),
            posture: joints.coordinates.clone(),
            loads,
            place,
            chain,
        })
    }

    /// The chain with an end condition, to be solved or followed.
    #[must_use]
    pub fn problem(&self, end: EndCondition) -> ChainProblem<'_> {
        ChainProblem {
            chain: &self.chain,
            base: self.base,
            commands: self.commands.clone(),
            posture: self.posture.clone(),
            loads: self.loads.clone(),
            end,
        }
    }

    /// Motions that the end can make near the commanded posture, whatever moves: columns of an
    /// orthonormal basis, rotations at the natural length. What is missing is rigid everywhere: a
    /// planar chain does not leave its plane.
    #[must_use]
    pub fn movable(&self) -> MovableDirections {
        let length = self.chain.scale().length;
        let motions = motions_near(
            &self.chain,
            &self.base,
            &self.posture,
            &self.commands,
            &Pose::identity(),
            length,
        );
        MovableDirections::near(&motions, length)
    }
}

/// The problem at a value of a curve's parameter: its end moved, or its loads grown. Loads on nodes grow as far as
/// they are dead forces.
#[must_use]
pub fn problem_at<'a>(
    problem: &ChainProblem<'a>,
    parameter: &Parameter,
    value: f64,
) -> ChainProblem<'a> {
    let mut there = problem.clone();
    there.end = parameter.end_at(&problem.end, value);
    if let Parameter::Load(pattern) = parameter {
        there.loads.extend(pattern.loads.iter().map(|l| match l {
            Load::Dead { node, wrench } => Load::dead(*node, *wrench * value),
            other => other.clone(),
        }));
    }
    there
}
