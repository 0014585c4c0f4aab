//! The motion of an instruction, with its ends in the frames in force.

use nalgebra::Vector3;

use crate::interpreter::value::{Datum, Value};
use crate::ls::motion::{End, MotionText, Way};
use crate::ls::positions::{Held, Position};
use crate::ls::run::{InForce, Run, index_of_axes};
use crate::ls::storage::{frame_of, name_of};
use crate::ls::table::OFFSET;
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Runs, Speed};
use crate::model::site::{MotionSite, OffsetAxes, TargetSite, TurnsOtherwise};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::text::Name;

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

/// An end: what it is, where it stands, frame and tool, external axes.
pub(super) struct EndFound {
    pub target: Target,
    pub site: TargetSite,
    pub frame: Option<u32>,
    pub tool: Option<u32>,
    pub external: Vec<Option<f64>>,
}

/// Reason and remedy of a refused end.
pub(super) type EndReason = (String, &'static str);

const LEAVE: &str = "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or teach a position";

impl Run<'_, '_> {
    /// A frame or tool by its number, for the motion of a step.
    pub(super) fn frame_use(&mut self, at: usize, letters: &str, number: Option<u32>) -> FrameUse {
        let Some(number) = number else {
            return FrameUse {
                name: letters.to_owned(),
                frame: Frame::Unknown {
                    reason: "its number is not known from the text".to_owned(),
                },
            };
        };
        let kind = Name::of(if letters == "UF" { b"UFRAME" } else { b"UTOOL" });
        let stated = kind.and_then(|kind| self.stated_frame(&kind, number).copied());
        let known = stated.or_else(|| frame_of(&self.frame(&kind?, number)?));
        if let (None, Some(name)) = (known, kind.and_then(|kind| name_of(&kind, number))) {
            let program = self.program();
            self.unknown.entry(name).or_default().push((program, at));
        }
        let held = || Frame::Unknown {
            reason: "the controller holds it; state it under [robot.frames]".to_owned(),
        };
        FrameUse {
            name: format!("{letters}:{number}"),
            frame: known.map_or_else(held, Frame::Known),
        }
    }

    /// One end of a motion: what it is, where it stands, frame and tool, external axes.
    pub(super) fn end(
        &mut self,
        end: &End,
        displaced: Option<&str>,
    ) -> Result<EndFound, EndReason> {
        let (number, name) = match end {
            End::Position(number, name) => (*number, name),
            End::Computed(index, name) => match self.index(index) {
                Some(number) => (number, name),
                None => return self.unknown_end("which position it goes to, a register says"),
            },
            End::Register(index, name) => {
                let number = self.index(index).filter(|_| displaced.is_none());
                let found = number.and_then(|number| self.register_end(number, name));
                return match found {
                    Some(found) => Ok(found),
                    None => self.unknown_end(
                        "its end is in a position register, whose value is not in the text",
                    ),
                };
            }
        };
        let Some(position) = self.taught(number) else {
            let reason = format!("position P[{number}] is not in /POS");
            return Err((reason, "teach it, or take the motion out"));
        };
        let displaced = displaced.map(|reason| (reason.to_owned(), LEAVE));
        let displaced = displaced.or_else(|| {
            let own = [
                (position.frame, "UF", "UFRAME_NUM", self.modal.frame),
                (position.tool, "UT", "UTOOL_NUM", self.modal.tool),
            ];
            own.into_iter().find_map(|(own, letters, word, now)| {
                taught_otherwise(number, letters, own?, word, now)
            })
        });
        let site = match &position.held {
            Held::Pose(declaration) => TargetSite::Declared {
                declaration: *declaration,
                name: name.clone(),
            },
            _ => TargetSite::Fixed("it goes to joint values"),
        };
        let target = match (&position.held, displaced) {
            (Held::Nothing(reason), _) => {
                let reason = format!("P[{number}]: {reason}");
                return Err((reason, "teach it, or take the motion out"));
            }
            (_, Some(reason)) if self.reader.options.unknown_targets == UnknownTargets::Refused => {
                return Err(reason);
            }
            (_, Some((reason, _))) => Target::Unknown { reason },
            (Held::Pose(at), None) => Target::Pose(self.reader.declarations[*at].pose.clone()),
            (Held::Joints(values), None) => Target::Joints {
                values_deg: values.clone(),
            },
        };
        Ok(EndFound {
            target,
            site,
            frame: position.frame.or(self.modal.frame.known()),
            tool: position.tool.or(self.modal.tool.known()),
            external: position.external.clone(),
        })
    }

    fn unknown_end(&self, reason: &'static str) -> Result<EndFound, EndReason> {
        match self.reader.options.unknown_targets {
            UnknownTargets::Refused => Err((reason.to_owned(), LEAVE)),
            UnknownTargets::LeftAsWritten => Ok(EndFound {
                target: Target::Unknown {
                    reason: reason.to_owned(),
                },
                site: TargetSite::Fixed("its end is not known"),
                frame: self.modal.frame.known(),
                tool: self.modal.tool.known(),
                external: Vec::new(),
            }),
        }
    }

    /// The pose in a position register that came from a position of the program, as a further declaration like that one: a corrected end is
    /// written as a position of its own.
    fn register_end(&mut self, number: u32, name: &std::ops::Range<usize>) -> Option<EndFound> {
        let value = self.register(number);
        let pose = frame_of(&value)?;
        let [.., configuration] = value.parts() else {
            return None;
        };
        let (Value::Text(text), Some(literal)) = (&configuration.value, configuration.literal)
        else {
            return None;
        };
        let declarations = &self.reader.declarations[..self.taught];
        let place = (literal.file, literal.span().start);
        let at = declarations.partition_point(|own| (own.text.file, own.statement.start) < place);
        let mut declared = declarations.get(at)?.clone();
        let file = &self.all.files[literal.file];
        let own = std::str::from_utf8(file.part(&declared.name))
            .ok()?
            .parse()
            .ok()?;
        let position: &Position = self.all.positions[literal.file].all.get(&own)?;
        if !position.external.is_empty() {
            return None;
        }
        let (frame, tool) = (self.modal.frame.known(), self.modal.tool.known());
        let target = PoseTarget {
            position_mm: pose.translation.vector,
            orientation: pose.rotation,
            configuration: Configuration {
                text: text.to_string(),
                numbers: declared.pose.configuration.numbers.clone(),
            },
            external: Vec::new(),
        };
        let is_here = literal.file == self.program()
            && position.frame.is_none_or(|own| frame == Some(own))
            && position.tool.is_none_or(|own| tool == Some(own));
        let site = match is_here {
            true => {
                declared.pose = target.clone();
                declared.keeps_value = true;
                self.reader.declarations.push(declared);
                TargetSite::Declared {
                    declaration: self.reader.declarations.len() - 1,
                    name: name.clone(),
                }
            }
            false => TargetSite::Fixed(
                "its position register holds a position of another program, frame or tool",
            ),
        };
        Some(EndFound {
            target: Target::Pose(target),
            site,
            frame,
            tool,
            external: Vec::new(),
        })
    }
}

/// Reason and remedy of a position that was taught with a frame or tool (`letters`, `own`) other than the one that may be in force.
fn taught_otherwise(
    position: u32,
    letters: &str,
    own: u32,
    word: &str,
    now: InForce,
) -> Option<EndReason> {
    let (how, remedy) = match now {
        InForce::Computed => (
            format!("which {word} is in force here, the run decides"),
            "assign a number, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
        ),
        InForce::Known(other) if other != own => (
            format!("{word} is {other} here, and which counts is a setting of the controller"),
            "teach it in the frame and with the tool in force, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
        ),
        _ => return None,
    };
    let reason = format!("P[{position}] is taught with {letters} {own}, but {how}");
    Some((reason, remedy))
}
