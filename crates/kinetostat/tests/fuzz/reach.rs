//! Machines reach what chains reach: one rod as a chain and as a machine, bent and rolled up as far as its
//! segments are a rod.

use std::f64::consts::TAU;

use kinetostat::{
    Chain, ChainProblem, CurveSettings, EndCondition, Error, LinkSpec, Mechanism, Parameter, Pose,
    Settings, Wrench, continuation::SpecialKind, follow, solve_chain, spatial::pose_residual,
};
use nalgebra::{Vector3, vector};

use super::random::Random;
use super::rod::slender;

/// A rod of unit length and bending stiffness under a load at its end.
#[derive(Clone, Copy, Debug)]
pub struct Rod {
    pub segments: usize,
    /// EA, N.
    pub axial: f64,
    pub wrench: Wrench,
}

impl Rod {
    fn random(random: &mut Random) -> Self {
        let segments = (random.power(0.0, 2.0) as usize).clamp(1, 100);
        let moment = random.axis() * random.between(0.0, TAU);
        // Across, and no push that could buckle it: then there is more than one equilibrium.
        let mut force = random.axis() * random.power(-2.0, 1.5);
        force.x = force.x.abs();
        let (force, moment) = match random.below(3) {
            0 => (force, Vector3::zeros()),
            1 => (Vector3::zeros(), vector![0.0, moment.norm(), 0.0]),
            _ => (force, vector![0.0, moment.y, moment.z]),
        };
        Self {
            segments,
            axial: random.power(0.0, 11.0),
            wrench: Wrench::new(force, moment),
        }
    }

    /// Segments that each turn by so much are no rod any more: machines of one to three of them, hardly
    /// stretching and rolled up, are refused where the chain has an equilibrium.
    fn is_a_rod(&self) -> bool {
        let turn = self.wrench.moment().norm() + self.wrench.force().norm().sqrt();
        turn <= LARGEST_TURN * self.segments as f64
    }

    fn chain(&self) -> Chain {
        let link = LinkSpec::beam(slender(self.axial), 1.0).segments(self.segments);
        let chain = Chain::builder("rod").link_with("rod", &link).build();
        chain.expect("a rod")
    }

    /// Whether the path from rest turns back just above a share of the load: the machine stops there, a chain may
    /// know of an equilibrium elsewhere. The fold of a rod that hardly stretches is that of one that stretches by a
    /// millionth, whose path is not lost there.
    fn snaps(&self, share: f64) -> bool {
        let soft = Self {
            axial: self.axial.min(1e7),
            ..*self
        };
        let chain = soft.chain();
        let rest = ChainProblem::new(&chain, EndCondition::wrench(Wrench::zero()));
        let start = solve_chain(&rest, &Settings::default()).expect("at rest");
        let grown = Parameter::end_wrench(self.wrench);
        let settings = CurveSettings::within(0.0, 1.0);
        let curves = follow(&rest, &grown, &start, 0.0, &settings).expect("a path from rest");
        let limits = curves.specials.iter();
        let mut limits = limits.filter(|s| s.kind == SpecialKind::LoadLimit);
        limits.any(|s| (share - 1e-3..share + 1e-2).contains(&s.point.parameter))
    }

    /// What differs between the chain and the machine, in words.
    pub fn difference(&self) -> Option<String> {
        let chain = self.chain();
        let problem = ChainProblem::new(&chain, EndCondition::wrench(self.wrench));
        let alone = solve_chain(&problem, &Settings::default());
        let home = Pose::translation(1.0, 0.0, 0.0);
        let machine = Mechanism::serial(chain.clone(), home, Vector3::zeros()).expect("a machine");
        let posture = machine.posture(&home).expect("home");
        match (alone, posture.deflected_by(&self.wrench)) {
            (Ok(chain), Ok(machine)) => {
                let off = pose_residual(&chain.tip, &machine.tool).0.norm();
                let exact = 1e-8 + EXACT * f64::EPSILON * self.axial;
                let stable = (chain.stability.stable, machine.shapes_stable());
                (off.is_nan() || off > exact || stable.0 != stable.1).then(|| {
                    format!("the tips are {off:e} apart, stable as chain and machine: {stable:?}")
                })
            }
            (Err(_), Err(_)) => None,
            (Ok(_), Err(Error::NotConverged { load_factor, .. })) if self.snaps(load_factor) => {
                None
            }
            (Ok(_), Err(error)) => Some(format!(
                "the chain has an equilibrium, the machine: {error}"
            )),
            (Err(error), Ok(_)) => Some(format!(
                "the machine has an equilibrium, the chain: {error}"
            )),
        }
    }
}

/// The axial force of a rod is known to the rounding of its coordinates times EA, and what it turns back to a share
/// of that, m and rad per bending stiffness of 1 N m2.
const EXACT: f64 = 1e-2;

/// Rotation of one segment, rad, up to which it is one.
const LARGEST_TURN: f64 = 0.8;

/// One rod.
pub fn case(random: &mut Random) {
    let rod = Rod::random(random);
    if !rod.is_a_rod() {
        return;
    }
    if let Some(difference) = rod.difference() {
        panic!("{rod:?}: {difference}");
    }
}
