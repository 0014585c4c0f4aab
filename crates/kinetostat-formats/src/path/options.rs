//! Options for the path of a robot's program.

use std::sync::Arc;

use kinetostat_program::RotaryAxes;
use nalgebra::Vector3;

use crate::path::axis_turns::TurnAboutAxis;

/// Options with which the path of a robot's program is made.
///
/// ```
/// let mut options = kinetostat_formats::PathOptions::default();
/// // All linear motions cut, whatever their speed, with a tool whose z points from the holder to the tip.
/// assert_eq!(options.rapid_from_mm_per_s, None);
/// assert_eq!(options.tool_axis, -nalgebra::Vector3::z());
/// options.rapid_from_mm_per_s = Some(200.0);
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PathOptions {
    /// Linear and circular motions at this speed or a higher one position the tool in air, mm/s; `None`: all of them cut.
    pub rapid_from_mm_per_s: Option<f64>,
    /// Unit vector from the tool's tip to its holder, in axes of the tool's frame: -z where the frame's z points out of the
    /// spindle, as is usual at ABB and FANUC; -x at KUKA.
    pub tool_axis: Vector3<f64>,
    /// Rule for the rotation of the tool about its axis, if the program states the axis alone.
    pub turn_about_axis: TurnAboutAxis,
    /// Rotary axes of the machine, in axes of the program's work object: where a program states their angles
    /// ([`crate::ReadOptions::rotary_axes`]) they stand there, and where it states the tool's axis alone they point the tool along it,
    /// within their limits. Between two poses they lead it on the great circle (APT, and SINUMERIK with ORIVECT, its
    /// basic setting), or turn evenly with the way (SINUMERIK with ORIAXES, Heidenhain). They say how the tool is turned about its axis, too.
    pub rotary: Option<Arc<RotaryAxes>>,
}

impl Default for PathOptions {
    fn default() -> Self {
        Self {
            rapid_from_mm_per_s: None,
            tool_axis: -Vector3::z(),
            turn_about_axis: TurnAboutAxis::Least,
            rotary: None,
        }
    }
}
