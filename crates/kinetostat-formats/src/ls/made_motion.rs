//! The motion of an instruction, with its ends in the frames in force.

use nalgebra::Vector3;

use crate::interpreter::value::{Datum, Value};
use crate::ls::ends::EndReason;
use crate::ls::motion::{End, MotionText, Way};
use crate::ls::positions::Held;
use crate::ls::run::{Run, index_of_axes};
use crate::ls::table::OFFSET;
use crate::model::motion::{Motion, MotionKind, Runs, Speed};
use crate::model::site::{MotionSite, OffsetAxes, TurnsOtherwise};
use crate::model::target::Target;

impl Run<'_, '_> {
    /// Offset of a motion; `None` if only the controller knows it, or if a register turns the tool.
    fn shift_of(&mut self, at: usize, text: &MotionText) -> Option<(OffsetAxes, Vector3<f64>)> {
        let (axes, register) = text.offset.as_ref()?;
        let number = match register {
            Some(register) => self.index(register),
            None => self.modal.conditions[index_of_axes(*axes)],
        }?;
        let is_to_joints = match &text.target {
            End::Position(position, _) => {
                let held = self.taught(*position).map(|position| &position.held);
                matches!(held, Some(Held::Joints(_)))
            }
            _ => false,
        };
        let value = self.register(number);
        let numbers: Option<Vec<f64>> =
            value.parts().iter().take(6).map(Datum::as_number).collect();
        let [x, y, z, angles @ ..]: [f64; 6] = numbers?.try_into().ok()?;
        if is_to_joints || text.via.is_some() || angles != [0.0; 3] {
            return None;
        }
        let is_pose = matches!(
            value.parts().last(),
            Some(Datum {
                value: Value::Text(_),
                ..
            })
        );
        if !is_pose && self.taken.insert(number) {
            let message = format!(
                "PR[{number}] is taken to hold X, Y, Z, W, P, R, and not joint values: the program gives it numbers alone"
            );
            let (program, line) = (self.program(), self.line(at));
            self.reader.finding(program, line, message);
        }
        Some((*axes, Vector3::new(x, y, z)))
    }

    fn speed_of(&mut self, text: &MotionText) -> Speed {
        let mut speed = text.speed.clone();
        if let Some((register, unit_mm_per_s)) = &text.speed_by {
            let value = self.value(register).as_number();
            speed.mm_per_s = value.map(|value| value * unit_mm_per_s);
        }
        speed
    }

    /// The motion of a step; `open` says why it is not known that it runs.
    pub(super) fn motion_of(
        &mut self,
        at: usize,
        text: &MotionText,
        open: Option<&str>,
    ) -> Result<Motion, EndReason> {
        let mut displaced = open.or(text.displaced);
        let shift = match displaced {
            Some(_) => None,
            None => self.shift_of(at, text),
        };
        if text.offset.is_some() && shift.is_none() {
            displaced = displaced.or(Some(OFFSET));
        }
        let mut end = self.end(&text.target, displaced)?;
        let via = match &text.via {
            // With what stands between the two positions.
            Some((span, via)) => Some((
                span.start..text.target_span.start.max(span.end),
                self.end(via, displaced)?,
            )),
            None => None,
        };
        if let Some((_, via)) = &via
            && (via.frame, via.tool) != (end.frame, end.tool)
        {
            return Err((
                "the two positions of the circle have different frames or tools".to_owned(),
                "teach both in one frame and with one tool",
            ));
        }
        if let (Some((axes, by_mm)), Target::Pose(pose)) = (shift, &mut end.target) {
            pose.position_mm += match axes {
                OffsetAxes::WorkObject => by_mm,
                OffsetAxes::Tool => pose.orientation * by_mm,
            };
        }
        let speed = self.speed_of(text);
        let span = self.all.layouts[self.program()].lines[at].whole.clone();
        Ok(Motion {
            file: self.program(),
            line: self.file().line_of(span.start),
            span,
            kind: match (text.way, &via) {
                (Way::Joint, _) => MotionKind::Joint,
                (Way::Linear, _) | (Way::Circular, None) => MotionKind::Linear,
                (Way::Circular, Some((_, via))) => MotionKind::Circular {
                    via: via.target.clone(),
                },
            },
            target: end.target,
            zone: text.zone,
            tool: self.frame_use(at, "UT", end.tool),
            work_object: self.frame_use(at, "UF", end.frame),
            runs: Runs::Once,
            follows: None,
            site: MotionSite {
                keyword: text.keyword.clone(),
                target_span: text.target_span.clone(),
                target: end.site,
                via: via.map(|(span, via)| (span, via.site)),
                speed: text.speed_site.clone().filter(|_| speed.mm_per_s.is_some()),
                zone: text.zone_span.clone(),
                external: end.external,
                other_speeds: None,
                external_moved_behind: false,
                indivisible: text.indivisible,
                turns_otherwise: text.turns_otherwise.map(|(reason, remedy)| TurnsOtherwise {
                    reason,
                    remedy,
                    evenly: None,
                }),
            },
            speed,
        })
    }
}
