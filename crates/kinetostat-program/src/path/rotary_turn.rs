//! Motion of a machine's rotary axes in a move.

use std::sync::Arc;

use nalgebra::{Isometry3, UnitQuaternion};

use crate::path::great_circle::GreatCircle;
use crate::path::rotary::RotaryAxes;

/// Motion of the rotary axes in a move: each turns linearly with the share, or all of them lead the tool's axis on a great
/// circle.
#[derive(Debug, Clone, PartialEq)]
pub struct RotaryTurn {
    /// The axes.
    pub axes: Arc<RotaryAxes>,
    /// Angles at the start of the move, in the order of the axes, deg.
    pub start_deg: Vec<f64>,
    /// Angles at the end of the move.
    pub end_deg: Vec<f64>,
    /// Origin of the program's words (`G10 L2`).
    pub origin_deg: Vec<f64>,
    /// Great circle of the tool's axis in the part; `None` if each axis turns linearly with the share.
    pub great_circle: Option<GreatCircle>,
    /// Kind of the program's words: angles or a direction.
    pub stated: StatedBy,
}

/// Kind of words by which a program states the angles of rotary axes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum StatedBy {
    /// Words of the axes.
    #[default]
    Angles,
    /// Direction of the tool (G43.5 I J K, A3 B3 C3, six numbers of a GOTO).
    Direction,
}

impl RotaryTurn {
    /// Angles of the axes at a share of the move, deg.
    #[must_use]
    pub fn angles_deg(&self, share: f64) -> Vec<f64> {
        if let Some(circle) = &self.great_circle
            && share > 0.0
            && share < 1.0
        {
            return circle.angles_at(&self.axes, share);
        }
        let both = self.start_deg.iter().zip(&self.end_deg);
        both.map(|(start, end)| start + (end - start) * share.clamp(0.0, 1.0))
            .collect()
    }

    /// Travel of each axis, back and forth, deg.
    #[must_use]
    pub fn ways_deg(&self) -> Vec<f64> {
        if let Some(circle) = &self.great_circle {
            return circle.way_deg();
        }
        let both = self.start_deg.iter().zip(&self.end_deg);
        both.map(|(start, end)| (end - start).abs()).collect()
    }

    /// Orientation of the tool at a share of the move, part axes from tool axes.
    #[must_use]
    pub fn tool(&self, share: f64) -> UnitQuaternion<f64> {
        self.axes.tool(&self.angles_deg(share))
    }

    /// Motion of the part at a share of the move from its place at zero; `None` on a machine without tables.
    ///
    /// ```
    /// use kinetostat_program::{Carries, RotaryAxes, RotaryAxis, RotaryTurn, StatedBy};
    /// use nalgebra::{UnitQuaternion, Vector3};
    ///
    /// let head = RotaryAxis {
    ///     letter: 'A',
    ///     carries: Carries::Tool,
    ///     direction: Vector3::x_axis(),
    ///     point_mm: Vector3::zeros(),
    ///     limits_deg: None,
    /// };
    /// let axes = RotaryAxes { axes: vec![head], tool_at_zero: UnitQuaternion::identity() };
    /// let turn = RotaryTurn {
    ///     axes: axes.into(),
    ///     start_deg: vec![0.0],
    ///     end_deg: vec![30.0],
    ///     origin_deg: vec![0.0],
    ///     great_circle: None,
    ///     stated: StatedBy::Angles,
    /// };
    /// assert!(turn.part(0.5).is_none());
    /// assert_eq!((turn.angles_deg(0.5), turn.ways_deg()), (vec![15.0], vec![30.0]));
    /// assert!((turn.tool(1.0).angle().to_degrees() - 30.0).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn part(&self, share: f64) -> Option<Isometry3<f64>> {
        self.axes
            .turns_part()
            .then(|| self.axes.part(&self.angles_deg(share)))
    }
}
