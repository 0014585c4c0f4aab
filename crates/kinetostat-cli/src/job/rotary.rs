//! The rotary axes of a model in the frame of the part, for reading a program.

use std::sync::Arc;

use kinetostat_machining::Placement;
use kinetostat_model::Model;
use kinetostat_model::schema::CarriesWord;
use kinetostat_program::{Carries, RotaryAxes, RotaryAxis};
use nalgebra::{Point3, Unit};

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
    });
    Some(Arc::new(RotaryAxes {
        axes: axes.collect(),
        tool_at_zero: part_from_base.rotation * placement.tool_orientation,
    }))
}
