//! Where motions end: positions with the frames in force, registers, frames by number.

use std::collections::{BTreeMap, BTreeSet};

use nalgebra::Isometry3;

use crate::ls::flow::{InForce, State};
use crate::ls::lines::Line;
use crate::ls::motion::End;
use crate::ls::positions::{Held, Positions};
use crate::ls::registers::{Place, Registers};
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
    pub registers: &'a Registers,
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
    pub frames: BTreeMap<String, Isometry3<f64>>,
    /// Frames and tools to which the programs give values.
    pub given: BTreeSet<Place>,
}

impl<'o> Ends<'o> {
    /// Of the caller's options.
    pub(crate) fn of(options: &'o ReadOptions) -> Self {
        let named = options.frames.iter();
        Self {
            options,
            given: BTreeSet::new(),
            frames: named
                .map(|(name, frame)| (name.to_ascii_uppercase(), *frame))
                .collect(),
        }
    }

    /// Whether the program gives a frame or tool values, and which one it has the run decides.
    pub(crate) fn is_open(&self, letters: &str, number: Option<u32>, now: &Registers) -> bool {
        number.is_some_and(|number| {
            let place = place_of(letters, number);
            let is_stated = self.frames.contains_key(&format!("{letters}:{number}"));
            self.given.contains(&place) && !is_stated && now.pose(place).is_none()
        })
    }

    /// A frame or tool by its number: as the caller states it, else with the value that the program gives it.
    pub(crate) fn frame_use(
        &self,
        letters: &str,
        number: Option<u32>,
        now: &Registers,
    ) -> FrameUse {
        let Some(number) = number else {
            return FrameUse {
                name: letters.to_owned(),
                frame: Frame::Unknown {
                    reason: "its number is not known from the text".to_owned(),
                },
            };
        };
        let name = format!("{letters}:{number}");
        let stated = self.frames.get(&name).copied();
        let frame = match stated.or_else(|| now.pose(place_of(letters, number))) {
            Some(frame) => Frame::Known(frame),
            None => Frame::Unknown {
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
        let before = place.before.unwrap_or(State::OPEN);
        let (in_force, tool_in_force) = (before.frame.known(), before.tool.known());
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
        for (letters, word, own, now) in [
            ("UF", "UFRAME_NUM", position.frame, before.frame),
            ("UT", "UTOOL_NUM", position.tool, before.tool),
        ] {
            let why = own.and_then(|own| taught_otherwise((*number, letters, own), word, now));
            displaced = displaced.or(why);
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

/// `UF` and `UT` with their numbers.
fn place_of(letters: &str, number: u32) -> Place {
    match letters {
        "UF" => Place::Frame(number),
        _ => Place::Tool(number),
    }
}

/// Why a position that is taught with a frame or tool (`letters`, `own`) is elsewhere where another one may be in force, and
/// what to do.
fn taught_otherwise(
    (position, letters, own): (u32, &str, u32),
    word: &str,
    now: InForce,
) -> Option<(String, &'static str)> {
    let (how, remedy) = match now {
        InForce::OnOneWay(other) if other != own => (
            format!("{word} is {other} here, if the run came by where it is set"),
            "set it on all ways, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
        ),
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
