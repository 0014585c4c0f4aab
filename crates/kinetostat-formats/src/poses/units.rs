//! Length unit of positions: mm or m.

use crate::options::LengthUnit;
use crate::poses::row::{Row, RowTarget};

/// Length of the unit in mm.
pub(crate) fn mm_of(unit: LengthUnit) -> f64 {
    match unit {
        LengthUnit::Millimetre => 1.0,
        LengthUnit::Metre => 1000.0,
    }
}

/// Farthest coordinate of a program in metres that is not warned of, m: arms on tracks reach no further.
const FAR_M: f64 = 20.0;

/// Largest coordinate of a program in millimetres that looks like metres, mm.
const NEAR_MM: f64 = 2.0;

/// Extents of a path of ROS messages that are taken for metres where no unit is stated, m.
const EXTENTS_M: std::ops::RangeInclusive<f64> = 0.02..=5.0;

/// Extent of the positions of a list.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Reach {
    /// Largest absolute coordinate.
    pub farthest: f64,
    /// Largest difference of two coordinates of one axis.
    pub extent: f64,
    /// Places.
    pub count: usize,
}

impl Reach {
    pub(crate) fn of(rows: &[Row]) -> Self {
        let mut reach = Self::default();
        let mut least = [f64::INFINITY; 3];
        let mut most = [f64::NEG_INFINITY; 3];
        for row in rows {
            let RowTarget::Pose { position, .. } = &row.target else {
                continue;
            };
            reach.count += 1;
            for (axis, number) in position.iter().enumerate() {
                // Numbers that are read are finite.
                let value = number.value;
                if value.abs() > reach.farthest {
                    reach.farthest = value.abs();
                }
                if value < least[axis] {
                    least[axis] = value;
                }
                if value > most[axis] {
                    most[axis] = value;
                }
            }
        }
        for (least, most) in least.iter().zip(most) {
            // Without positions the difference is not above zero.
            if most - least > reach.extent {
                reach.extent = most - least;
            }
        }
        reach
    }

    /// Reason why a stated unit is implausible.
    pub(crate) fn doubt(&self, unit: LengthUnit) -> Option<String> {
        match unit {
            LengthUnit::Metre if self.farthest > FAR_M => Some(format!(
                "the places are stated in m and reach {:.1} m from the origin: are they mm?",
                self.farthest
            )),
            LengthUnit::Millimetre if self.count > 1 && self.farthest < NEAR_MM => Some(format!(
                "the places are stated in mm and reach {:.3} mm from the origin: are they metres?",
                self.farthest
            )),
            _ => None,
        }
    }

    /// True if positions of ROS messages, which are in metres by definition, have the size of metres.
    pub(crate) fn looks_like_metres(&self) -> bool {
        EXTENTS_M.contains(&self.extent) && self.farthest <= FAR_M
    }
}
