//! What a block does: motions, frames, tools.

use std::ops::Range;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::site::{MotionSite, PoseText, SpeedSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::siemens::arcs::arc;
use crate::siemens::block::Block;
use crate::siemens::frames::Change;
use crate::siemens::state::{Code, FeedMode};
use crate::siemens::walker::{Reader, Written};
use crate::siemens::words::{Purpose, Words};
use crate::text::number::{NumberText, Width};

/// What a motion is, where its end is known.
struct Known {
    kind: MotionKind,
    end: Vector3<f64>,
}

impl Reader<'_> {
    /// Does what the words of a block say; `stated`: whether code and feed were stated behind the last motion before it.
    pub(crate) fn act(&mut self, block: &Block, words: Words, stated: (bool, bool)) {
        self.change_tool(&words);
        if let Some(change) = words.frame {
            return self.change_frame(block, change, &words);
        }
        let moves = words.has_axes() || words.has_arc() || words.has_direction();
        match words.purpose {
            Purpose::Dwell | Purpose::Limits => return,
            Purpose::Machine if !words.has_axes() => return,
            Purpose::Machine => {
                let end = [0, 1, 2].map(|axis| match words.axes[axis] {
                    Some(_) => None,
                    None => self.state.place[axis],
                });
                return self.unknown(block, &words, stated, end, "it is a place of the machine");
            }
            Purpose::Motion if !moves => return,
            Purpose::Motion => {}
        }
        if words.has_direction() {
            self.direction(block, &words);
        }
        self.motion(block, &words, stated);
    }

    fn change_tool(&mut self, words: &Words) {
        let takes = words.changes_tool || !self.changes_by_m6;
        if let Some(tool) = self.state.next_tool.take_if(|_| takes) {
            self.state.tool = tool;
            self.state.forget();
        } else if words.changes_tool {
            self.state.forget();
        }
    }

    fn change_frame(&mut self, block: &Block, change: Change, words: &Words) {
        if change == Change::Reset && words.has_axes() {
            let (reason, remedy) = (
                "it mirrors or scales the path",
                "let the CAM system write the path as it is cut",
            );
            return self.fault(&block.span, reason, remedy);
        }
        if words.code.is_some() || words.has_arc() || words.purpose != Purpose::Motion {
            return self.fault(
                &block.span,
                "a frame and a motion stand in one block",
                "write the frame as a block of its own",
            );
        }
        let shifts = matches!(change, Change::Shift | Change::FurtherShift);
        let values = [0, 1, 2].map(|axis| {
            words.axes[axis].as_ref().map_or(0.0, |word| match shifts {
                true => word.mm,
                false => word.written,
            })
        });
        let frame = change.applied(&self.state.frame, values, words.in_plane, self.state.normal);
        self.state.set_frame(frame);
    }

    fn direction(&mut self, block: &Block, words: &Words) {
        if !self.state.oriented {
            return self.fault(
                &block.span,
                "a direction of the tool is stated without TRAORI",
                "write TRAORI before it",
            );
        }
        if self.state.machine_orientation {
            return self.fault(
                &block.span,
                "the direction is in the machine's axes (ORIMKS)",
                "let the CAM system write it in those of the part (ORIWKS)",
            );
        }
        let by_angles = words.angles.iter().any(Option::is_some);
        let angles = [0, 1, 2].map(|i| words.angles[i].as_ref().map_or(0.0, |(_, angle)| *angle));
        let stated = match by_angles {
            true => self.turned(angles),
            false => words.vector(),
        };
        let direction = stated.and_then(|vector| vector.try_normalize(1e-6));
        match direction {
            Some(direction) => {
                self.state.direction = Some(self.state.frame.rotation * direction);
            }
            None if by_angles => self.fault(
                &block.span,
                "what A2, B2, C2 mean, is not stated",
                "write ORIEULER or ORIRPY before them, or A3, B3, C3",
            ),
            None => self.fault(
                &block.span,
                "the direction has no length",
                "mend A3, B3, C3",
            ),
        }
    }

    fn motion(&mut self, block: &Block, words: &Words, stated: (bool, bool)) {
        let start = self.state.place;
        let mut end = [0, 1, 2].map(|axis| match &words.axes[axis] {
            Some(word) if word.step => start[axis].map(|at| at + word.mm),
            Some(word) => Some(word.mm),
            None => start[axis],
        });
        if words.has_arc() && !self.state.code.is_arc() {
            self.fault(
                &block.span,
                "a centre or a radius is stated, and no arc is in force",
                "write G2, G3 or CIP, or take them out",
            );
        }
        if self.state.code != Code::Rapid && self.state.feed_mode == FeedMode::Inverse {
            self.fault(
                &block.span,
                "the feed is one over the time of each block (G93)",
                "let the CAM system write feeds in mm/min (G94)",
            );
        }
        if self.state.code != Code::Rapid {
            let away = |(name, axis): (&Vec<u8>, &super::state::OtherAxis)| {
                (axis.elsewhere && axis.at.is_some())
                    .then(|| String::from_utf8_lossy(name).into_owned())
            };
            if let Some(name) = self.state.others.iter().find_map(away) {
                self.fault(
                    &block.span,
                    format!("the axis {name} was sent to a place of the machine, and not back"),
                    "state its place again before the cut",
                );
                self.state.others.clear();
            }
        }
        let missing: Vec<&str> = (["X", "Y", "Z"].into_iter().zip(end))
            .filter_map(|(name, at)| at.is_none().then_some(name))
            .collect();
        if !missing.is_empty() {
            let reason = format!(
                "where the tool stands along {} is not known",
                missing.join(", ")
            );
            return self.unknown(block, words, stated, end, &reason);
        }
        let Some(to) = Some(Vector3::from(end.map(Option::unwrap_or_default))) else {
            return;
        };
        if !self.state.code.is_arc() {
            let kind = MotionKind::Linear;
            return self.push(block, words, stated, Some(Known { kind, end: to }), end, "");
        }
        let Some(from) = self.state.known_place() else {
            let reason = "where its arc begins is not known";
            return self.unknown(block, words, stated, end, reason);
        };
        match self.arc(words, from, to) {
            Ok(known) => {
                end = [0, 1, 2].map(|axis| Some(known.end[axis]));
                self.push(block, words, stated, Some(known), end, "");
            }
            Err(reason) => {
                self.fault(&block.span, reason, "let the CAM system write it again");
                self.state.place = end;
            }
        }
    }

    fn arc(&self, words: &Words, from: Vector3<f64>, to: Vector3<f64>) -> Result<Known, String> {
        let frame = &self.state.frame;
        if self.state.code == Code::Through {
            if words.via.iter().all(Option::is_none) {
                return Err("no point on the arc is stated (I1, J1, K1)".to_owned());
            }
            let via = Vector3::from_fn(|axis, _| match &words.via[axis] {
                Some(word) if word.step => from[axis] + word.mm,
                Some(word) => word.mm,
                None => from[axis],
            });
            let via = Target::Pose(self.pose(via));
            return Ok(Known {
                kind: MotionKind::Circular { via },
                end: to,
            });
        }
        let sense = match self.state.code {
            Code::Clockwise => -1.0,
            _ => 1.0,
        };
        let normal = self.state.normal;
        let has_end = words.has_axes();
        let found = arc(from, to, has_end, normal, sense, &words.stated_arc())?;
        let mut axis = Vector3::zeros();
        axis[normal] = 1.0;
        Ok(Known {
            kind: MotionKind::Arc {
                centre_mm: (frame * Point3::from(found.centre)).coords,
                axis: frame.rotation * axis,
                angle_rad: found.angle_rad,
            },
            end: found.end,
        })
    }

    /// A pose at a place in the frame's axes.
    fn pose(&self, place: Vector3<f64>) -> PoseTarget {
        let orientation = (self.state.direction)
            .and_then(|axis| OrientationText::Axis.rotation_of(axis.as_slice()));
        PoseTarget {
            position_mm: (self.state.frame * Point3::from(place)).coords,
            orientation: orientation.unwrap_or_else(UnitQuaternion::identity),
            configuration: Configuration::default(),
            external: Vec::new(),
        }
    }

    /// A motion whose end or way is not known: rapids stay as they are written, others are refused or left.
    fn unknown(
        &mut self,
        block: &Block,
        words: &Words,
        stated: (bool, bool),
        end: [Option<f64>; 3],
        reason: &str,
    ) {
        let stays = self.state.code == Code::Rapid
            || words.purpose == Purpose::Machine
            || self.options.unknown_targets == UnknownTargets::LeftAsWritten;
        if !stays {
            // Once: what follows comes from it.
            if !self.state.lost {
                self.fault(
                    &block.span,
                    reason,
                    "state X, Y and Z before the cut, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                );
            }
            self.state.place = end;
            return;
        }
        if words.purpose != Purpose::Machine && self.state.code != Code::Rapid {
            self.finding(&block.span, format!("it stays as it is written: {reason}"));
        }
        self.push(block, words, stated, None, end, reason);
    }

    fn push(
        &mut self,
        block: &Block,
        words: &Words,
        (code_stated, feed_stated): (bool, bool),
        known: Option<Known>,
        end: [Option<f64>; 3],
        reason: &str,
    ) {
        let (state, file) = (&self.state, self.file);
        let start_known = state.known_place().is_some();
        let rapid = state.code == Code::Rapid;
        let feed = state.feed.clone().filter(|_| !rapid);
        let per_minute = state.feed_mode == FeedMode::PerMinute;
        let mm_per_s = (feed.as_ref().filter(|_| per_minute))
            .map(|feed| feed.value * state.feed_unit_mm / 60.0);
        let speed = Speed {
            mm_per_s,
            text: match rapid {
                true => "G0".to_owned(),
                false => feed
                    .as_ref()
                    .map_or(String::new(), |feed| feed.text.clone()),
            },
        };
        let anchor = behind_axes(block, words);
        let (kind, target, site) = match known {
            Some(Known { kind, end }) => {
                let site = TargetSite::Literal(self.text(words, anchor, end));
                let mut pose = self.pose(end);
                // A turned frame leaves rounding where the tool stays: it is no way.
                let before = state.last.filter(|_| start_known);
                let before = before.and_then(|last| self.out.motions[last].target.pose());
                if let Some(before) = before
                    && (before.position_mm - pose.position_mm).norm() < SAME_MM
                {
                    pose.position_mm = before.position_mm;
                }
                (kind, Target::Pose(pose), site)
            }
            None => {
                let target = Target::Unknown {
                    reason: reason.to_owned(),
                };
                let site = TargetSite::Fixed("its end or its way is not known");
                (MotionKind::Linear, target, site)
            }
        };
        let keyword = words.code.clone().unwrap_or(block.words_at..block.words_at);
        let exact = state.exact || words.exact;
        let motion = Motion {
            file: self.index,
            line: file.line_of(block.span.start),
            span: block.span.clone(),
            kind,
            target,
            zone: match exact {
                true => Zone::Exact,
                false => Zone::Unstated,
            },
            tool: self.frame_use(&state.tool),
            work_object: self.frame_use(&state.work_object),
            runs: Runs::Once,
            follows: state.last.filter(|_| start_known),
            site: MotionSite {
                keyword,
                target_span: anchor..anchor,
                target: site,
                via: None,
                speed: speed.mm_per_s.map(|_| SpeedSite {
                    span: words
                        .feed
                        .as_ref()
                        .map_or(anchor..anchor, |(f, _)| f.clone()),
                    before: "F".to_owned(),
                    after: String::new(),
                }),
                zone: None,
                indivisible: None,
            },
            speed,
        };
        let written = Written {
            line: block.line.clone(),
            words_at: block.words_at,
            axes: words.axes.clone(),
            via: words.via.clone(),
            arc_words: words.arc_words(),
            direction_words: words.direction_words(),
            at_end: words.at_end.clone(),
            code: state.code,
            code_word: words.code.clone(),
            code_stated,
            feed: state.feed.clone(),
            feed_word: words.feed.clone(),
            feed_stated,
            frame: state.frame,
            unit_mm: state.unit_mm,
            start: state.place,
            end,
            machine: words.purpose == Purpose::Machine,
            steps: state.steps,
        };
        self.out.motions.push(motion);
        self.out.written.push(written);
        self.state.place = end;
        self.state.last = Some(self.out.motions.len() - 1);
        self.state.code_stated = false;
        self.state.feed_stated = false;
        if self.state.known_place().is_some() {
            self.state.lost = false;
        }
    }

    /// The numbers of an end, as far as they are written.
    fn text(&self, words: &Words, anchor: usize, end: Vector3<f64>) -> PoseText {
        let number = |axis: usize| NumberText {
            span: words.axes[axis]
                .as_ref()
                .map_or(anchor..anchor, |word| word.number.clone()),
            value: end[axis] / self.state.unit_mm,
        };
        let direction = self.state.direction;
        let parts = |axis: Vector3<f64>| {
            axis.iter()
                .map(|value| NumberText {
                    span: anchor..anchor,
                    value: *value,
                })
                .collect()
        };
        PoseText {
            file: self.index,
            whole: anchor..anchor,
            position: [number(0), number(1), number(2)],
            orientation: direction.map(parts).unwrap_or_default(),
            convention: match direction {
                Some(_) => OrientationText::Axis,
                None => OrientationText::Unstated,
            },
            width: Width::Free,
        }
    }

    fn frame_use(&self, name: &str) -> FrameUse {
        let stated = self.frames.get(&name.to_ascii_uppercase());
        FrameUse {
            name: name.to_owned(),
            frame: match stated {
                Some(frame) => Frame::Known(*frame),
                None => Frame::Unknown {
                    reason: "the program does not say it; state it under [robot.frames]".to_owned(),
                },
            },
        }
    }
}

/// Places nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

/// Where words of places go that are not there: behind those that are, or behind the code.
pub(crate) fn behind_axes(block: &Block, words: &Words) -> usize {
    let last = |words: &mut dyn Iterator<Item = &Range<usize>>| words.map(|word| word.end).max();
    let mut axes = words.axes.iter().flatten().map(|word| &word.word);
    let mut code = words.code.iter();
    last(&mut axes)
        .or(last(&mut code))
        .unwrap_or(block.words_at)
}
