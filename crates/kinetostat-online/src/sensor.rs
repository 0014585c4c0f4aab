//! From a sensor's reading to the force of the process on the tool.
//!
//! A sensor measures everything that hangs beyond it: its weight, which turns with the posture, and an offset of the electronics and of
//! the cables, which is found in air by an explicit command. What is left is expressed at the tool's point in base axes. The posture is the one that the
//! program commands: a reading turned by the bent posture would be a second feedback path.

use kinetostat::spatial::{Pose, Wrench};

use crate::settings::Sensor;

/// Offset of a sensor and its zeroing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SensorState {
    /// Offset, sensor axes, once it is known.
    offset: Option<Wrench>,
    sum: Wrench,
    left: u32,
}

impl SensorState {
    /// Begins to average the offset.
    pub(crate) fn begin_zeroing(&mut self, sensor: &Sensor) {
        *self = Self {
            offset: None,
            sum: Wrench::zero(),
            left: sensor.zeroing_cycles.max(1),
        };
    }

    pub(crate) fn is_zeroed(&self) -> bool {
        self.offset.is_some()
    }

    /// Wrench of the process on the tool (base axes, at its point) for a reading at a pose of the tool; offset and weight
    /// are removed, and a zeroing takes the reading into its mean.
    pub(crate) fn process_wrench(
        &mut self,
        sensor: &Sensor,
        reading: &Wrench,
        tool: &Pose,
    ) -> Wrench {
        let turn = (tool.rotation * sensor.tool_from_sensor.rotation).to_rotation_matrix();
        let force = turn.inverse() * sensor.gravity * sensor.mass;
        let weight = Wrench::new(force, sensor.centre_of_mass.cross(&force));
        let without_weight = *reading - weight;
        if self.left > 0 {
            self.sum += without_weight;
            self.left -= 1;
            if self.left == 0 {
                self.offset = Some(self.sum * (1.0 / f64::from(sensor.zeroing_cycles.max(1))));
            }
        }
        let process = without_weight - self.offset.unwrap_or_default();
        let arm = -(tool.rotation * sensor.tool_from_sensor.translation.vector);
        process.rotated(&turn).shifted(&arm)
    }
}
