//! The motion of an instruction, with its ends in the frames in force.

use crate::ls::ends::MotionPlace;
use crate::ls::found::Reader;
use crate::ls::motion::{MotionText, Way};
use crate::model::motion::{Motion, MotionKind, Runs};
use crate::model::site::{MotionSite, TurnsOtherwise};

impl Reader<'_> {
    pub(super) fn motion_of(
        &mut self,
        text: &MotionText,
        place: &MotionPlace<'_>,
    ) -> Option<Motion> {
        let file = place.file;
        let end = self.ends.end(&text.target, place, text.displaced);
        let via = text.via.as_ref().map(|(span, end)| {
            let found = self.ends.end(end, place, text.displaced);
            // With what stands between the two positions.
            let span = span.start..text.target_span.start.max(span.end);
            found.map(|found| (span, found))
        });
        let (end, via) = match (end, via.transpose()) {
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
            tool: self.ends.frame_use("UT", end.tool),
            work_object: self.ends.frame_use("UF", end.frame),
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
