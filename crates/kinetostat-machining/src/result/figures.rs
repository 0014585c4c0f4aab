//! The figures of a run as text, made once: the terminal, the report's boxes, its sentences and the
//! titles of its plots show these very strings, so that none differs from another.

use crate::number::{
    MISSING, Rounding, largest, largest_angle, largest_length, least, least_length, mean_length,
    share, significant, with_unit,
};
use crate::result::joints::LimitPlace;
use crate::result::run_result::RunResult;

/// The figures of a [`RunResult`], as [`crate::number`] writes them: largest values rounded up, least
/// ones down.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Largest distance of the tool from its programmed place without compensation.
    pub error_before: String,
    /// Root mean square of it along the path.
    pub rms_before: String,
    /// Largest distance with the written program.
    pub error_after: String,
    /// Root mean square of it along the path.
    pub rms_after: String,
    /// Part of it that comes from the decimals written.
    pub rounding: String,
    /// Largest correction.
    pub correction: String,
    /// Largest rotation of the tool.
    pub rotation: String,
    /// Largest deviation of the tool's speed along the part.
    pub speed: String,
    /// Longest step at a corner; none without steps.
    pub corner_step: Option<String>,
    /// Longest step where a rapid ends; none without such steps.
    pub entry_step: Option<String>,
    /// Fastest change of the correction per mm of path; `None` if none was written.
    pub change: Option<String>,
    /// Shortest piece of a divided block; `None` if no block was divided.
    pub shortest_piece: Option<String>,
    /// Maximum block rate per second; `None` if the program's feed does not determine it.
    pub blocks_per_second: Option<String>,
    /// Length of the feed path.
    pub feed_length: String,
    /// Smallest stiffness against a force.
    pub stiffness: String,
    /// Largest share of the way to buckling; `None` if no limb can buckle.
    pub share_to_buckling: Option<String>,
    /// Smallest distance of a joint to one of its limits; `None` if no joint has limits.
    pub nearest_limit: Option<String>,
    /// Joint, end and line, as in "joint 5, upper, line 12".
    pub nearest_limit_at: String,
    /// Largest force or torque of a drive as a share of its rating; `None` if the model states no rating.
    pub share_of_rating: Option<String>,
    /// Drive and place.
    pub share_of_rating_at: String,
    /// Configuration of an arm; `None` for other machines.
    pub configuration: Option<String>,
    /// Largest force or torque of each actuator.
    pub actuator_force: Vec<String>,
    /// Largest change of each actuator.
    pub actuator_correction: Vec<String>,
}

/// A change in mm per mm of path.
pub(crate) fn per_mm(value: f64) -> String {
    largest(value, "mm/mm")
}

impl Figures {
    /// Texts with units of the summary of `result`; those of actuators are in the order of its list of actuators.
    #[must_use]
    pub fn of(result: &RunResult) -> Self {
        let s = &result.summary;
        let actuators = &result.run_inputs.actuators;
        let per = |values: &[f64], unit: fn(&crate::ActuatorColumn) -> &str| {
            actuators
                .iter()
                .enumerate()
                .map(|(i, actuator)| {
                    let value = values.get(i).filter(|v| v.is_finite());
                    value.map_or_else(|| MISSING.to_owned(), |v| largest(*v, unit(actuator)))
                })
                .collect()
        };
        let joints = &result.joints;
        let actuator = |index: usize| actuators.get(index);
        let name = |index: usize| actuator(index).map_or("", |a| a.name.as_str());
        let limit = joints.nearest_limit.as_ref();
        let loaded = joints.most_loaded.as_ref();
        let above_zero = |value: f64| (value.is_finite() && value > 0.0).then_some(value);
        Self {
            error_before: largest_length(s.max_position_error_before_mm),
            rms_before: mean_length(s.rms_position_error_before_mm),
            error_after: largest_length(s.max_position_error_after_mm),
            rms_after: mean_length(s.rms_position_error_after_mm),
            rounding: largest_length(s.max_rounding_error_mm),
            correction: largest_length(s.max_correction_mm),
            rotation: largest_angle(s.max_residual_rotation_deg),
            speed: largest(s.max_speed_deviation_percent, "%"),
            corner_step: (s.corner_steps > 0).then(|| largest_length(s.largest_corner_step_mm)),
            entry_step: (s.entry_steps > 0).then(|| largest_length(s.largest_entry_step_mm)),
            change: s.largest_change_mm_per_mm.map(|c| per_mm(c.value)),
            shortest_piece: above_zero(s.smallest_piece_mm).map(least_length),
            blocks_per_second: s
                .blocks_per_second
                .and_then(above_zero)
                .map(|b| largest(b, "1/s")),
            feed_length: with_unit(&significant(s.feed_length_mm, 5, Rounding::Nearest), "mm"),
            stiffness: least(s.smallest_stiffness_n_per_mm, "N/mm"),
            share_to_buckling: s.largest_share_to_buckling.map(share),
            nearest_limit: limit.map(|found| {
                let unit = actuator(found.limit.actuator).map_or("", |a| a.motion_unit.as_str());
                least(found.limit.distance, unit)
            }),
            nearest_limit_at: limit.map_or_else(String::new, |found| {
                let LimitPlace { line, limit, .. } = found;
                format!(
                    "{}, {} end, line {line}",
                    name(limit.actuator),
                    limit.end.word()
                )
            }),
            share_of_rating: loaded.map(|found| share(found.drive.share_of_rating)),
            share_of_rating_at: loaded.map_or_else(String::new, |found| {
                format!("{}, line {}", name(found.drive.actuator), found.line)
            }),
            configuration: joints.configuration_text(),
            actuator_force: per(&s.max_actuator_force, |a| &a.force_unit),
            actuator_correction: per(&s.max_actuator_correction, |a| &a.motion_unit),
        }
    }
}
