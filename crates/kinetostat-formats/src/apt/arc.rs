//! Arcs about a stated centre and axis, from where the tool is to the next place.

use std::ops::Range;

use kinetostat_program::{NearlyClosed, angle_about};
use nalgebra::Vector3;

use crate::apt::dialect::Dialect;
use crate::apt::lines::Statement;
use crate::apt::numbers::{Argument, arguments_of};
use crate::text::source::SourceFile;

/// `CIRCLE` as it was read, mm.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Circle {
    /// Lines of the circle.
    pub lines: Range<usize>,
    pub span: Range<usize>,
    pub centre_mm: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub radius_mm: Option<f64>,
    /// The circle has several turns (TIMES).
    pub times: bool,
    /// Sense about the axis.
    pub sense: f64,
}

/// Farthest that written radii differ, mm; 0.0001 in the files seen.
const RADIUS_TOLERANCE_MM: f64 = 0.01;
/// Radii smaller than this are none.
const SAME_MM: f64 = 1e-4;

impl Circle {
    /// Circle of a statement, in a unit of so many mm.
    ///
    /// # Errors
    /// Reason why its arc is unknown.
    pub(crate) fn of(
        file: &SourceFile,
        statement: &Statement,
        dialect: Dialect,
        unit_mm: f64,
    ) -> Result<Self, &'static str> {
        let arguments = arguments_of(file.bytes(), &statement.arguments);
        let numbers = arguments.iter().map_while(Argument::number);
        let values: Vec<f64> = numbers.map(|number| number.value).collect();
        let sense = dialect.sense().ok_or(
            "in which sense the arc goes about its axis, is not known of this kind of file",
        )?;
        let axis = values.get(3..6).map(Vector3::from_row_slice);
        let axis = axis.filter(|axis| (axis.norm() - 1.0).abs() < 1e-3);
        let axis = axis.ok_or("the circle is not a centre and an axis of length 1")?;
        Ok(Self {
            lines: statement.lines.clone(),
            span: statement.span.clone(),
            centre_mm: Vector3::from_row_slice(&values[..3]) * unit_mm,
            axis: axis.normalize(),
            radius_mm: values.get(6).map(|radius| radius.abs() * unit_mm),
            times: arguments.len() > values.len(),
            sense,
        })
    }

    /// The angle by which the tool goes around the axis from a place to another, right-handed, rad. The words of the places have such
    /// a last digit.
    ///
    /// # Errors
    /// Where the places lie on no circle about the centre, or it is not sure whether that is a full one; what to do.
    pub(crate) fn angle(
        &self,
        from: &Vector3<f64>,
        to: &Vector3<f64>,
        digit_mm: f64,
    ) -> Result<f64, (String, &'static str)> {
        let across = |place: &Vector3<f64>| {
            let arm = place - self.centre_mm;
            arm - self.axis * arm.dot(&self.axis)
        };
        let (start, end) = (across(from), across(to));
        let (first, last) = (start.norm(), end.norm());
        let stated = self.radius_mm.unwrap_or(first);
        let differ = |one: f64, other: f64| {
            (one - other).abs() > RADIUS_TOLERANCE_MM || !one.is_finite() || !other.is_finite()
        };
        if differ(first, last) || differ(first, stated) || first < SAME_MM {
            let stated = match self.radius_mm {
                Some(radius) => format!(", and {radius:.4} is stated"),
                None => String::new(),
            };
            return Err((
                format!(
                    "the circle has radius {first:.4} at its start and {last:.4} at its end{stated}"
                ),
                "let the CAM system write it again",
            ));
        }
        let outwards = start / first;
        let aside = self.axis.cross(&outwards);
        let arms = [start, end].map(|arm| [arm.dot(&outwards), arm.dot(&aside)]);
        let angle = angle_about(arms[0], arms[1], self.sense, digit_mm)
            .map_err(|nearly| (nearly.to_string(), NearlyClosed::REMEDY))?;
        Ok(self.sense * angle)
    }
}
