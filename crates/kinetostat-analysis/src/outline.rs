//! The line through the joints of a chain.

use kinetostat::{Chain, MotionKind, Pose, model::Element};
use nalgebra::Vector3;

/// Places along a chain at a state, base to tip, m, without repetition.
#[must_use]
pub fn chain_outline(
    chain: &Chain,
    base: &Pose,
    commands: &[f64],
    coordinates: &[f64],
) -> Vec<Vector3<f64>> {
    let mut pose = *base;
    let mut points = vec![pose.translation.vector];
    for element in chain.elements() {
        match element {
            Element::Rigid(offset) => pose *= offset,
            Element::Node(_) => {}
            Element::Motion(motion) => {
                let mut by = 0.0;
                if let Some(d) = motion.coordinate {
                    by += d.ratio * coordinates[d.index];
                }
                if let Some(d) = motion.command {
                    by += d.ratio * commands[d.index];
                }
                pose *= match motion.kind {
                    MotionKind::Revolute => Pose::rotation(motion.axis.into_inner() * by),
                    MotionKind::Prismatic => {
                        let t = motion.axis.into_inner() * by;
                        Pose::translation(t.x, t.y, t.z)
                    }
                };
            }
        }
        let here = pose.translation.vector;
        let last = points.last().copied().unwrap_or_default();
        if (here - last).norm() > 1e-9 * chain.scale().length {
            points.push(here);
        }
    }
    points
}
