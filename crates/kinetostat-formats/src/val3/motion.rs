//! Conversion of a motion instruction to a motion.

use std::ops::Range;

use nalgebra::Vector3;

use crate::interpreter::ends::Around;
use crate::interpreter::expression::{Argument, Expression, Node};
use crate::interpreter::run::{Dialect, Reason};
use crate::interpreter::value::{Datum, Value};
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::program::ACCELERATION;
use crate::model::site::{MotionSite, PoseText, ReplacedText, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::text::number::{NumberText, Width};
use crate::val3::frames::{Run, Val3, own_trsf, single};

/// A further point like an element of an array.
const AROUND: Around = Around {
    before: |node| {
        let type_name = if node.type_name.is("POINTRS") {
            "pointRs"
        } else {
            "pointRx"
        };
        format!(
            "<Data access=\"private\" xsi:type=\"array\" type=\"{type_name}\" size=\"1\" name=\""
        )
    },
    middle: b"\"><Value key=\"0\" ",
    after: b"\" /></Data>",
};

/// Threshold above which a speed is no limit: the controller's default.
const UNLIMITED_MM_PER_S: f64 = 9999.0;

const WRITE_IT: &str =
    "write the motion with a point of the data, or leave it as written when reading";

/// An end with its text and its frame.
struct End {
    target: Target,
    site: TargetSite,
    frame: FrameUse,
}

impl Run<'_, '_> {
    /// The motion of an instruction, or why it is refused.
    pub(super) fn motion(&mut self, tokens: &Range<usize>) -> Result<Motion, Reason> {
        let file = self.file();
        let arguments = Val3::arguments_of(file, tokens.start + 1..tokens.end);
        let arguments: Vec<Expression> = arguments
            .into_iter()
            .filter_map(|Argument { value, .. }| value)
            .collect();
        let is = |word: &str| file.is_word(tokens.start, word);
        let (via, end, tool, description) = match arguments.as_slice() {
            [end, tool, description] if !is("MOVEC") => (None, end, tool, description),
            [via, end, tool, description] if is("MOVEC") => (Some(via), end, tool, description),
            _ => {
                let reason =
                    "a motion has its points, its tool and its description of speed and blending"
                        .to_owned();
                return Err((
                    reason,
                    "write  movel(point, tool, mdesc)  or  movec(between, point, tool, mdesc)",
                ));
            }
        };
        let tool = self.tool(tool)?;
        let own = self.end(end, is("MOVEJ"))?;
        let (kind, via_site) = match via {
            None if is("MOVEJ") => (MotionKind::Joint, None),
            None => (MotionKind::Linear, None),
            Some(via) => {
                let found = self.end(via, false)?;
                if found.frame != own.frame {
                    return Err((
                        "the points of the circle are in two frames".to_owned(),
                        "state both in one frame",
                    ));
                }
                // With the comma and the blanks up to the end.
                let place = file.span(&via.tokens).start..file.span(&end.tokens).start;
                (
                    MotionKind::Circular { via: found.target },
                    Some((place, found.site)),
                )
            }
        };
        let keyword = file.span(&(tokens.start..tokens.start + 1));
        let mut site = MotionSite::of(keyword, self.span_of(end), own.site);
        site.via = via_site;
        site.indivisible = (kind == MotionKind::Joint).then_some("this motion cannot be divided");
        let described = self.described(description, kind == MotionKind::Joint);
        let description = self.value(description);
        // Percent of what the arm is set up for, and as much where the data leave a number out.
        let said = ["ACCEL", "VEL", "DECEL"].map(|name| {
            let number = single(&description).member(name).and_then(Datum::as_number);
            format!(" {name} {}", number.unwrap_or(100.0))
        });
        self.say_beside(tokens, format!("{ACCELERATION}{}", said.concat()));
        let frames = [tool, own.frame];
        let mut motion = self.made_motion(tokens, kind, own.target, site, frames);
        (motion.speed, motion.zone) = described;
        Ok(motion)
    }

    /// The end that an argument is: a point, or joints where the motion takes them.
    fn end(&mut self, expression: &Expression, takes_joints: bool) -> Result<End, Reason> {
        let file = self.file();
        let found = self.value(expression);
        let value = single(&found);
        let frame = FrameUse {
            name: "world".to_owned(),
            frame: Frame::Known(nalgebra::Isometry3::identity()),
        };
        if let (true, Some(values)) = (takes_joints, value.as_numbers::<6>()) {
            let (target, site) = (
                Target::Joints {
                    values_deg: values.to_vec(),
                },
                TargetSite::Fixed("its end is stated in joints"),
            );
            return Ok(End {
                target,
                site,
                frame,
            });
        }
        let trsf = match own_trsf(value) {
            Ok(trsf) => trsf,
            Err(reason) if self.options.unknown_targets == UnknownTargets::LeftAsWritten => {
                let site = TargetSite::Fixed("its end is not known from the text");
                return Ok(End {
                    target: Target::Unknown { reason },
                    site,
                    frame,
                });
            }
            Err(reason) => {
                return Err((
                    format!("`{}`: {reason}", file.text(&expression.tokens)),
                    WRITE_IT,
                ));
            }
        };
        let words = ["SHOULDER", "ELBOW", "WRIST"]
            .into_iter()
            .filter_map(|name| match &value.member(name)?.value {
                Value::Text(text) => Some(text.to_string()),
                _ => None,
            });
        let pose = PoseTarget {
            position_mm: trsf.translation.vector,
            orientation: trsf.rotation,
            configuration: Configuration {
                text: words.collect::<Vec<String>>().join(" "),
                numbers: Vec::new(),
            },
            external: Vec::new(),
        };
        let text = match expression.node {
            Node::Word(_) => self.text_of(value, !found.parts().is_empty()),
            Node::Element(..) => self.text_of(value, true),
            _ => None,
        };
        let declared = text.and_then(|text| self.declared(expression, text, &pose, &AROUND));
        let site = declared.unwrap_or_else(|| {
            TargetSite::Replaced(Box::new(ReplacedText {
                span: self.span_of(expression),
                pose: pose.clone(),
                parts: None,
            }))
        });
        let frame = self.frame_of(value);
        Ok(End {
            target: Target::Pose(pose),
            site,
            frame,
        })
    }

    /// Bytes of an end, with an index 0 behind it that has no tokens.
    fn span_of(&self, end: &Expression) -> Range<usize> {
        let mut span = self.file().span(&end.tokens);
        let behind = &self.file().source.bytes()[span.end..];
        if behind.trim_ascii_start().starts_with(b"[") {
            span.end += behind.iter().take_while(|byte| **byte != b']').count() + 1;
        }
        span
    }

    /// The numbers of a point in the data, where all stand there and a further point can be written like it.
    fn text_of(&self, value: &Datum, is_element: bool) -> Option<PoseText> {
        let literal = value.literal?;
        let (file, whole) = (literal.file, literal.span());
        let source = self.files[file].source;
        let numbers = value.member("TRSF")?.parts().iter().map(|number| {
            let own = number.literal.filter(|own| own.is_within(file, &whole))?;
            // A number that is left out has no place.
            let is_written = source.part(&own.span()) != b"<";
            is_written.then(|| {
                Some(NumberText {
                    span: own.span(),
                    value: number.as_number()?,
                })
            })?
        });
        let mut position = numbers.collect::<Option<Vec<NumberText>>>()?;
        let orientation = position.split_off(3);
        let written = std::str::from_utf8(source.part(&whole)).ok()?;
        let is_copied = !is_element || written.contains("fatherId=") && !written.contains("key=");
        is_copied.then_some(PoseText {
            file,
            whole,
            position: position.try_into().ok()?,
            orientation,
            convention: OrientationText::Xyz,
            external: Vec::new(),
            width: Width::Free,
            unit_mm: 1.0,
        })
    }

    /// The speed and the zone of a description of motion. `vel` is a part of the speeds of joints; `tvel` limits that of the tool.
    fn described(&mut self, expression: &Expression, is_joint: bool) -> (Speed, Zone) {
        let text = self.file().text(&expression.tokens);
        let value = self.value(expression);
        let value = single(&value);
        let number = |name: &str| value.member(name).and_then(Datum::as_number);
        let mm_per_s =
            number("TVEL").filter(|speed| !is_joint && (0.0..UNLIMITED_MM_PER_S).contains(speed));
        let blend = value.member("BLEND").map(|blend| &blend.value);
        let zone = match (blend, number("LEAVE"), number("REACH")) {
            (Some(Value::Text(text)), ..) if text.eq_ignore_ascii_case("off") => Zone::Exact,
            (Some(Value::Text(_)), Some(leave), Some(reach)) => {
                Zone::Radius(Vector3::new(leave, reach, 0.0).amax())
            }
            _ => Zone::Unstated,
        };
        (Speed { mm_per_s, text }, zone)
    }
}
