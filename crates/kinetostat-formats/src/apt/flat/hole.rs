//! The motions of one hole.

use kinetostat_program::{Spindle, SpindleRotation};
use nalgebra::Vector3;

use crate::apt::flat::cycle::{Cycle, Kind, Retract, Wrong};
use crate::extreme::{larger, smaller};

/// Limit of the steps of one hole.
const MOST_STEPS: usize = 10_000;

/// Approach distance above the last step, and retraction of BRKCHP, mm; no word states it.
const BACK_MM: f64 = 1.0;

/// Heights nearer than this are one, in units of the file.
const SAME: f64 = 1e-9;

/// A part of a hole as it is written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Part {
    Rapid(Vector3<f64>),
    Feed(Vector3<f64>),
    Text(String),
}

/// A hole: its place and the tool's axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Hole {
    pub at: Vector3<f64>,
    pub axis: Vector3<f64>,
    pub unit_mm: f64,
}

impl Hole {
    fn height(&self, place: &Vector3<f64>) -> f64 {
        (place - self.at).dot(&self.axis)
    }

    fn above(&self, height: f64) -> Vector3<f64> {
        self.at + self.axis * height
    }

    /// Motions of a hole at a place, if that is known; `began` is the tool position before the cycle.
    pub(crate) fn parts(
        &self,
        cycle: &Cycle,
        from: Option<Vector3<f64>>,
        began: Option<Vector3<f64>>,
        spindle: &Spindle,
    ) -> Result<Vec<Part>, Wrong> {
        let mut parts = Vec::new();
        let level = cycle.rapid_to;
        if let Some(from) = from {
            // Across above what lies between, and down along the axis.
            let comes = self.height(&from);
            let across = comes.max(cycle.clear).max(0.0);
            if comes < across - SAME {
                parts.push(Part::Rapid(from + self.axis * (across - comes)));
            }
            if across > level + SAME {
                parts.push(Part::Rapid(self.above(across)));
            }
        }
        parts.push(Part::Rapid(self.above(level)));
        parts.extend(self.down(cycle)?);
        if let Some(dwell) = &cycle.dwell {
            parts.push(Part::Text(format!("DELAY/{dwell}")));
        }
        let out = match cycle.retract {
            Retract::Clear => cycle.clear,
            Retract::To(height) => height.max(cycle.clear),
            Retract::Auto => {
                let began = began.map(|place| self.height(&place));
                let began = began.ok_or((
                    "where the tool was before the cycle is not known, and RTRCTO,AUTO goes back to that height".to_owned(),
                    "state the height, or a place before the cycle",
                ))?;
                began.max(cycle.clear)
            }
        };
        match cycle.kind {
            Kind::Drill | Kind::Deep | Kind::Break => parts.push(Part::Rapid(self.above(out))),
            Kind::Bore => {
                parts.push(Part::Feed(self.above(level)));
                if out > level + SAME {
                    parts.push(Part::Rapid(self.above(out)));
                }
            }
            Kind::Tap => {
                let [own, other] = turning(spindle)?;
                parts.push(Part::Text(other));
                parts.push(Part::Feed(self.above(level)));
                parts.push(Part::Text(own));
                if out > level + SAME {
                    parts.push(Part::Rapid(self.above(out)));
                }
            }
        }
        Ok(parts)
    }

    fn down(&self, cycle: &Cycle) -> Result<Vec<Part>, Wrong> {
        let bottom = || Part::Feed(self.above(-cycle.depth));
        let Some(step) = cycle.step else {
            return Ok(vec![bottom()]);
        };
        let first = cycle.first_step.unwrap_or(step);
        let count = ((cycle.depth - first) / step - SAME).ceil() + 1.0;
        if !count.is_finite() || count >= MOST_STEPS as f64 {
            return Err((
                "the hole has more than 10 000 steps".to_owned(),
                "state a larger STEP",
            ));
        }
        let back = smaller(BACK_MM / self.unit_mm, 0.5 * smaller(step, first));
        let mut parts = Vec::new();
        for index in 1..larger(count, 1.0) as usize {
            let depth = first + step * (index - 1) as f64;
            parts.push(Part::Feed(self.above(-depth)));
            if cycle.kind == Kind::Deep {
                parts.push(Part::Rapid(self.above(cycle.rapid_to)));
            }
            parts.push(Part::Rapid(self.above(back - depth)));
        }
        parts.push(bottom());
        Ok(parts)
    }
}

/// SPINDL as it turns, and the other way round.
fn turning(spindle: &Spindle) -> Result<[String; 2], Wrong> {
    let senses = match spindle.rotation {
        SpindleRotation::Clockwise => Some(["CLW", "CCLW"]),
        SpindleRotation::CounterClockwise => Some(["CCLW", "CLW"]),
        SpindleRotation::Stopped => None,
    };
    let (Some(senses), Some(rpm)) = (senses, spindle.rpm()) else {
        return Err((
            "a tap turns back at the bottom, and how the spindle turns is not stated".to_owned(),
            "state SPINDL with its speed and CLW or CCLW before it",
        ));
    };
    Ok(senses.map(|sense| format!("SPINDL/{rpm},RPM,{sense}")))
}
