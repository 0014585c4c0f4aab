//! The motion of an instruction, with its ends in the frames in force.

use crate::ls::ends::{EndFound, MotionPlace};
use crate::ls::found::Reader;
use crate::ls::motion::{End, MotionText, Way};
use crate::ls::positions::Held;
use crate::ls::registers::Shift;
use crate::ls::table::OFFSET;
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::site::{MotionSite, OffsetAxes, TurnsOtherwise};
use crate::model::target::Target;

impl Reader<'_> {
    /// By how much a motion is offset, or why its end is elsewhere.
    fn shift_of(
        &mut self,
        text: &MotionText,
        place: &MotionPlace<'_>,
    ) -> (Option<Shift>, Option<&'static str>) {
        let Some((axes, register)) = text.offset.filter(|_| text.displaced.is_none()) else {
            return (None, text.displaced);
        };
        let to_pose = match &text.target {
            End::Position(number, _) => {
                let position = place.positions.all.get(number);
                position.is_none_or(|position| !matches!(position.held, Held::Joints(_)))
            }
            End::Register(_) => false,
        };
        let shift = place.registers.shift(axes, register);
        let Some(shift) = shift.filter(|_| to_pose && text.via.is_none()) else {
            return (None, Some(OFFSET));
        };
        let message = format!(
            "PR[{}] is taken to hold X, Y, Z, W, P, R, and not joint values: the program gives it numbers alone",
            shift.register
        );
        if shift.is_taken && self.findings.iter().all(|said| said.message != message) {
            let line = place.file.line_of(place.line.whole.start);
            self.finding(place.index, line, message);
        }
        (Some(shift), None)
    }

    /// Refuses a frame or tool to which the program gives one value or another.
    fn refuses_open_frame(&mut self, end: &EndFound, place: &MotionPlace<'_>) -> bool {
        let used = [("UFRAME", "UF", end.frame), ("UTOOL", "UT", end.tool)];
        let mut open = used.into_iter().filter(|(_, of, number)| {
            let number = *number;
            self.ends.is_open(of, number, place.registers)
        });
        let Some((name, _, number)) = open.next() else {
            return false;
        };
        let reason = format!(
            "which value {name}[{}] has here, the run decides",
            number.unwrap_or_default()
        );
        let remedy = "give it its value on all ways, or state it under [robot.frames]";
        self.fault(place.file, place.line.whole.clone(), reason, remedy);
        true
    }

    pub(super) fn motion_of(
        &mut self,
        text: &MotionText,
        place: &MotionPlace<'_>,
    ) -> Option<Motion> {
        let file = place.file;
        let (shift, displaced) = self.shift_of(text, place);
        let end = self.ends.end(&text.target, place, displaced);
        let via = text.via.as_ref().map(|(span, end)| {
            let found = self.ends.end(end, place, displaced);
            // With what stands between the two positions.
            let span = span.start..text.target_span.start.max(span.end);
            found.map(|found| (span, found))
        });
        let (mut end, via) = match (end, via.transpose()) {
            (Ok(end), Ok(via)) => (end, via),
            (Err((reason, remedy)), _) | (_, Err((reason, remedy))) => {
                self.fault(file, place.line.whole.clone(), reason, remedy);
                return None;
            }
        };
        if let Some((_, via)) = &via
            && (via.frame, via.tool) != (end.frame, end.tool)
        {
            let (reason, remedy) = (
                "the two positions of the circle have different frames or tools",
                "teach both in one frame and with one tool",
            );
            self.fault(file, place.line.whole.clone(), reason, remedy);
            return None;
        }
        if let (Some(shift), Target::Pose(pose)) = (shift, &mut end.target) {
            pose.position_mm += match shift.axes {
                OffsetAxes::WorkObject => shift.by_mm,
                OffsetAxes::Tool => pose.orientation * shift.by_mm,
            };
        }
        if self.refuses_open_frame(&end, place) {
            return None;
        }
        Some(Motion {
            file: place.index,
            line: file.line_of(place.line.whole.start),
            span: place.line.whole.clone(),
            kind: match (text.way, &via) {
                (Way::Joint, _) => MotionKind::Joint,
                (Way::Linear, _) | (Way::Circular, None) => MotionKind::Linear,
                (Way::Circular, Some((_, via))) => MotionKind::Circular {
                    via: via.target.clone(),
                },
            },
            target: end.target,
            speed: text.speed.clone(),
            zone: text.zone,
            tool: self.ends.frame_use("UT", end.tool, place.registers),
            work_object: self.ends.frame_use("UF", end.frame, place.registers),
            runs: Runs::Once,
            follows: None,
            site: MotionSite {
                keyword: text.keyword.clone(),
                target_span: text.target_span.clone(),
                target: end.site,
                via: via.map(|(span, via)| (span, via.site)),
                speed: text.speed_site.clone(),
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
        })
    }
}
