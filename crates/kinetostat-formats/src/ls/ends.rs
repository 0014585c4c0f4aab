//! Where motions end: positions with the frames in force, registers, frames by number.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::ls::flow::State;
use crate::ls::lines::Line;
use crate::ls::motion::End;
use crate::ls::positions::{Held, Positions};
use crate::model::frame::{Frame, FrameUse};
use crate::model::site::{Declaration, TargetSite};
use crate::model::target::Target;
use crate::options::{ReadOptions, UnknownTargets};
use crate::text::source::SourceFile;

/// Where a motion stands.
pub(crate) struct MotionPlace<'a> {
    pub file: &'a SourceFile,
    pub index: usize,
    pub line: &'a Line,
    pub positions: &'a Positions,
    pub declarations: &'a [Declaration],
    pub before: Option<State>,
}

/// An end: what it is, where it stands, frame and tool, external axes.
pub(crate) struct EndFound {
    pub target: Target,
    pub site: TargetSite,
    pub frame: Option<u32>,
    pub tool: Option<u32>,
    pub external: Vec<Option<f64>>,
}

/// What is stated of ends and frames.
pub(crate) struct Ends<'o> {
    options: &'o ReadOptions,
    /// The options' frames by name in capitals.
    frames: BTreeMap<String, Isometry3<f64>>,
}

impl<'o> Ends<'o> {
    /// Of the caller's options.
    pub(crate) fn of(options: &'o ReadOptions) -> Self {
        let named = options.frames.iter();
        Self {
            options,
            frames: named
                .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
                .collect(),
        }
    }

    /// A frame or tool by its number.
    pub(crate) fn frame_use(&self, letters: &str, number: Option<u32>) -> FrameUse {
        let Some(number) = number else {
            return FrameUse {
                name: letters.to_owned(),
                frame: Frame::Unknown {
                    reason: "its number is not known from the text".to_owned(),
                },
            };
        };
        let name = format!("{letters}:{number}");
        let frame = match (self.frames.get(&name), number) {
            (Some(frame), _) => Frame::Known(*frame),
            (None, 0) => Frame::Known(Isometry3::identity()),
            (None, _) => Frame::Unknown {
                reason: "the controller holds it; state it under [robot.frames]".to_owned(),
            },
        };
        FrameUse { name, frame }
    }

    /// One end of a motion: what it is, where it stands, frame and tool, external axes.
    pub(crate) fn end(
        &self,
        end: &End,
        place: &MotionPlace<'_>,
        displaced: Option<&'static str>,
    ) -> Result<EndFound, (String, &'static str)> {
        let unknown = "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or teach a position";
        let (in_force, tool_in_force) = place.before.map_or((None, None), |b| (b.frame, b.tool));
        let (number, name) = match end {
            End::Position(number, name) => (number, name),
            End::Register(reason) => {
                return match self.options.unknown_targets {
                    UnknownTargets::Refused => Err(((*reason).to_owned(), unknown)),
                    UnknownTargets::LeftAsWritten => Ok(EndFound {
                        target: Target::Unknown {
                            reason: (*reason).to_owned(),
                        },
                        site: TargetSite::Fixed("its end is not known"),
                        frame: in_force,
                        tool: tool_in_force,
                        external: Vec::new(),
                    }),
                };
            }
        };
        let missing = || {
            let reason = format!("position P[{number}] is not in /POS");
            (reason, "teach it, or take the motion out")
        };
        let position = place.positions.all.get(number).ok_or_else(missing)?;
        let mut displaced = displaced.map(|reason| (reason.to_owned(), unknown));
        let is_computed = place.before.map_or([false; 2], |b| b.is_computed);
        let one_way = place.before.map_or([None; 2], |b| b.on_one_way);
        for (which, letters, word, own, now) in [
            (0, "UF", "UFRAME_NUM", position.frame, in_force),
            (1, "UT", "UTOOL_NUM", position.tool, tool_in_force),
        ] {
            let is_computed = is_computed[which];
            if let (Some(own), Some(other)) = (own, one_way[which])
                && own != other
            {
                let reason = format!(
                    "P[{number}] is taught with {letters} {own}, but {word} is {other} here, if the run came by where it is set"
                );
                displaced.get_or_insert((
                    reason,
                    "set it on all ways, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                ));
            }
            if let (Some(own), None, true) = (own, now, is_computed) {
                let reason = format!(
                    "P[{number}] is taught with {letters} {own}, but which {word} is in force here, the run decides"
                );
                displaced.get_or_insert((
                    reason,
                    "assign a number, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                ));
            }
            if let (Some(own), Some(now)) = (own, now)
                && own != now
            {
                let reason = format!(
                    "P[{number}] is taught with {letters} {own}, but {word} is {now} here, and which counts is a setting of the controller"
                );
                displaced.get_or_insert((
                    reason,
                    "teach it in the frame and with the tool in force, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                ));
            }
        }
        let (target, site) = match (&position.held, displaced) {
            (Held::Nothing(reason), _) => {
                return Err((
                    format!("P[{number}]: {reason}"),
                    "teach it, or take the motion out",
                ));
            }
            (_, Some(reason)) if self.options.unknown_targets == UnknownTargets::Refused => {
                return Err(reason);
            }
            (held, displaced) => {
                let site = match held {
                    Held::Pose(declaration) => TargetSite::Declared {
                        declaration: *declaration,
                        name: name.clone(),
                    },
                    _ => TargetSite::Fixed("it goes to joint values"),
                };
                let target = match (held, displaced) {
                    (_, Some((reason, _))) => Target::Unknown { reason },
                    (Held::Pose(at), None) => Target::Pose(place.declarations[*at].pose.clone()),
                    (Held::Joints(values), None) => Target::Joints {
                        values_deg: values.clone(),
                    },
                    (Held::Nothing(_), None) => return Err(missing()),
                };
                (target, site)
            }
        };
        Ok(EndFound {
            target,
            site,
            frame: position.frame.or(in_force),
            tool: position.tool.or(tool_in_force),
            external: position.external.clone(),
        })
    }
}
