//! The Orthoglide with its bars as bars: two links between two cross beams in every leg, by a
//! convention of choice. Its parallelograms close as loops of the graph.

use kinetostat::{
    Chain, Limb, LinkSpec, Mechanism, MotionKind, Platform, Pose, Posture, PostureRequest,
    machine::LimbPosture,
    model::{LinkConvention, Role},
};
use nalgebra::Vector3;

use crate::Cause;
use crate::orthoglide::machine::{FOOT, Orthoglide, WIDTH, axes, bar, head};

/// Machine with such bars at one nominal target of the tool, and the joints that command it.
pub(crate) struct Barred {
    pub(super) mechanism: Mechanism,
    pub(super) joints: Vec<LimbPosture>,
    pub(super) target: Pose,
}

impl Barred {
    /// Bars in `segments` segments of a convention.
    pub(crate) fn new(
        machine: &Orthoglide,
        target: &Pose,
        convention: LinkConvention,
        segments: usize,
    ) -> Result<Self, Cause> {
        let lumped = machine.build()?;
        let posture = lumped.posture(target)?;
        let link = LinkSpec::matrix(bar(), machine.bar_length)
            .segments(segments)
            .convention(convention);
        let mut builder = Mechanism::builder("orthoglide with bars");
        let mut limbs: Vec<(Limb, LimbPosture)> = Vec::new();
        let mut heads = Vec::new();
        for leg in 0..3 {
            let joints = &posture.limbs()[leg];
            let passive = lumped.limbs()[leg].nominal.indices_of(Role::Passive);
            let [q1, q2, q3] = [0, 1, 2].map(|k| joints.coordinates[passive[k]]);
            let near = axes(leg)
                * Pose::translation(joints.commands[0], -FOOT, 0.0)
                * Pose::translation(0.0, FOOT, 0.0)
                * Pose::rotation(Vector3::z() * q1);
            let along = Pose::rotation(Vector3::y() * q2);
            let far =
                near * along * Pose::translation(machine.bar_length, 0.0, 0.0) * along.inverse();
            let name = ["x", "y", "z"][leg];
            let near = builder.platform(Platform::new(format!("near beam {name}"), near));
            let far = builder.platform(Platform::new(format!("far beam {name}"), far));
            let mut limb =
                |name: String, from, to, chain: Chain, commands: Vec<f64>, set: &[(&str, f64)]| {
                    let coordinates = coordinates_with(&chain, set);
                    limbs.push((
                        Limb::between(name, from, to, chain),
                        LimbPosture {
                            commands,
                            coordinates,
                        },
                    ));
                };
            limb(
                format!("foot {name}"),
                0,
                near,
                machine.foot(leg, false)?.build()?,
                joints.commands.clone(),
                &[("q1", q1)],
            );
            for (side, sign) in [("left", -0.5), ("right", 0.5)] {
                let offset = Vector3::new(0.0, 0.0, sign * WIDTH);
                let chain = Chain::builder(format!("bar {name} {side}"))
                    .translation(offset)
                    .passive("near pivot", MotionKind::Revolute, Vector3::y(), 0.0)
                    .link_with("bar", &link)
                    .passive("far pivot", MotionKind::Revolute, Vector3::y(), 0.0)
                    .translation(-offset)
                    .build()?;
                limb(
                    format!("bar {name} {side}"),
                    near,
                    far,
                    chain,
                    Vec::new(),
                    &[("near pivot", q2), ("far pivot", -q2)],
                );
            }
            heads.push((name, far, leg, q3));
        }
        let tool = builder.platform(Platform::new("tool", *target));
        for (name, far, leg, q3) in heads {
            let chain = head(Chain::builder(format!("head {name}")), leg).build()?;
            limbs.push((
                Limb::between(format!("head {name}"), far, tool, chain),
                LimbPosture {
                    commands: Vec::new(),
                    coordinates: vec![q3],
                },
            ));
        }
        let mut joints = Vec::new();
        for (limb, posture) in limbs {
            builder = builder.limb(limb);
            joints.push(posture);
        }
        Ok(Self {
            mechanism: builder.build()?,
            joints,
            target: *target,
        })
    }

    /// Commanded for its target.
    pub(crate) fn posture(&self) -> Result<Posture, Cause> {
        Ok(self
            .mechanism
            .posture(PostureRequest::joints(&self.target, self.joints.clone()))?)
    }
}

/// Coordinates of a chain at home, but for joints that are named with their values.
fn coordinates_with(chain: &Chain, set: &[(&str, f64)]) -> Vec<f64> {
    let mut coordinates = chain.home_coordinates();
    for (joint, value) in set {
        for (i, c) in chain.coordinates().iter().enumerate() {
            if c.name == *joint {
                coordinates[i] = *value;
            }
        }
    }
    coordinates
}
