//! The rotary axes of a model in the frame of the part, for reading a program.

use std::sync::Arc;

use kinetostat::{Mechanism, Pose};
use kinetostat_machining::Placement;
use kinetostat_model::Model;
use kinetostat_model::schema::CarriesWord;
use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
use nalgebra::{Point3, Unit, UnitQuaternion, Vector3};

/// The rotary axes of a machine where a part lies; none where the model has none.
pub(crate) fn rotary(model: &Model, placement: &Placement) -> Option<Arc<RotaryAxes>> {
    let part_from_base = placement.base_from_part.inverse();
    let mm = 1e3 / placement.scale;
    let of_model = model.rotary_axes();
    if of_model.is_empty() {
        return None;
    }
    let axes = of_model.into_iter().map(|axis| RotaryAxis {
        letter: axis.letter,
        carries: match axis.carries {
            CarriesWord::Tool => Carries::Tool,
            CarriesWord::Part => Carries::Part,
        },
        direction: Unit::new_normalize(part_from_base.rotation * axis.direction.into_inner()),
        point_mm: mm * (part_from_base * Point3::from(axis.point)).coords,
        limits_deg: axis.limits_deg.or_else(|| match axis.carries {
            CarriesWord::Tool => limits_of_joint(&model.mechanism, &axis.direction),
            CarriesWord::Part => None,
        }),
    });
    Some(Arc::new(RotaryAxes {
        axes: axes.collect(),
        tool_at_zero: part_from_base.rotation * placement.tool_orientation,
    }))
}

/// Angle of a head in the test for the joint that turns it, rad.
const TURN: f64 = 0.01;

/// Joints that turn as much as the head are its joint, rad.
const SAME: f64 = 1e-6;

/// Limits of the word of a head by those of the joint that turns it, deg: the one joint that turns by as much as the tool does. None
/// where there is no such joint, or it has no limits.
fn limits_of_joint(mechanism: &Mechanism, direction: &Unit<Vector3<f64>>) -> Option<[f64; 2]> {
    let home: Pose = mechanism.platforms()[mechanism.tool()].home;
    let mut turned = home;
    turned.rotation = UnitQuaternion::from_axis_angle(direction, TURN) * home.rotation;
    let at = |pose: &Pose| Some(mechanism.posture(pose).ok()?.commands());
    let (before, after) = (at(&home)?, at(&turned)?);
    let actuators = (mechanism.limbs().iter()).flat_map(|limb| limb.nominal.actuators());
    let mut joints = before
        .iter()
        .zip(&after)
        .zip(actuators)
        .filter(|((a, b), joint)| {
            joint.kind == kinetostat::MotionKind::Revolute && ((*b - *a).abs() - TURN).abs() < SAME
        });
    let ((before, after), joint) = joints.next()?;
    let (low, high) = joint.limits.filter(|_| joints.next().is_none())?;
    let limits = [low - before, high - before].map(f64::to_degrees);
    match after > before {
        true => Some(limits),
        false => Some([-limits[1], -limits[0]]),
    }
}
