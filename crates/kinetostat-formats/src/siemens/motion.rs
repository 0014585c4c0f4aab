//! Effects of a block: motions, arcs, frames, tools.

use nalgebra::{Point3, Vector3};

use crate::model::motion::MotionKind;
use crate::model::target::Target;
use crate::siemens::arcs::{Reason, again, arc};
use crate::siemens::block::{Block, How, Item, What};
use crate::siemens::made_motion::Known;
use crate::siemens::state::{Code, StatedModes};
use crate::siemens::walker::Reader;
use crate::siemens::words::{Change, Purpose, Words};

impl Reader<'_> {
    /// Does what the words of a block say; `stated` are the modal words between the last motion and this block.
    pub(crate) fn act(&mut self, block: &Block, words: Words, stated: StatedModes) {
        self.change_tool(&words);
        self.state.standing.begin_block();
        if let Some(change) = words.frame {
            return self.change_frame(block, change, &words);
        }
        if let (true, Some((_, word, _))) = (
            words.has_rotary() && words.has_direction(),
            words.rotary.first(),
        ) {
            return self.fault(
                &word.word.clone(),
                "an angle and a direction of the tool stand in one block",
                "keep one of them",
            );
        }
        let turns = self.turn_axes(&words);
        let moves = words.has_axes()
            || words.has_arc()
            || words.has_direction()
            || turns && self.state.oriented && words.purpose == Purpose::Motion;
        match words.purpose {
            Purpose::Dwell => return self.no_place_beside_dwell(&words),
            Purpose::Limits => return,
            Purpose::Machine if !words.has_axes() => return,
            Purpose::Machine => {
                let end = [0, 1, 2].map(|axis| match words.axes[axis] {
                    Some(_) => None,
                    None => self.state.place[axis],
                });
                return self.unknown(block, &words, stated, end, "it is a place of the machine");
            }
            Purpose::Motion if !moves && turns => return self.turn_alone(block),
            Purpose::Motion if !moves => return,
            Purpose::Motion => {}
        }
        if words.has_direction() {
            self.direction(block, &words);
        }
        self.motion(block, &words, stated);
    }

    /// G4 stands in a block of its own [SINUMERIK, fundamentals]: what becomes of a place beside it is not known.
    fn no_place_beside_dwell(&mut self, words: &Words) {
        let places = words.axes.iter().chain(&words.centre).flatten();
        let turned = words.rotary.iter().map(|(_, angle, _)| angle);
        let beside = places.chain(turned).map(|place| place.word.clone());
        let beside = beside.chain(words.direction_words()).next();
        if let Some(word) = beside {
            self.fault(
                &word,
                "a dwell (G4) and a place stand in one block",
                "write G4 in a block of its own",
            );
        }
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
        let step = |item: &&Item| matches!(item.what, What::Value { how: How::Step, .. });
        if let Some(item) = block.items.iter().find(step) {
            return self.fault(
                &item.span,
                "a value of a frame is a step (IC), and what the controller makes of it is not documented",
                "write the value without IC: ATRANS and AROT add to the frame in force",
            );
        }
        let shifts = matches!(change, Change::Shift | Change::FurtherShift);
        if let Some((_, word, _)) = words.rotary.iter().find(|(_, word, _)| word.written != 0.0) {
            return self.fault(
                &word.word.clone(),
                "the frame shifts where a rotary axis counts from",
                "let the CAM system write the angles without it",
            );
        }
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
                self.state.standing.take_direction_instead();
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

    fn motion(&mut self, block: &Block, words: &Words, stated: StatedModes) {
        if self.no_place_by_axes(block) {
            let reason = "its places are not those of the tool's tip in the part";
            return self.unknown(block, words, stated, [None; 3], reason);
        }
        let from = self.steps_from(words);
        let start = from.unwrap_or(self.state.place);
        let mut end = [0, 1, 2].map(|axis| match &words.axes[axis] {
            Some(word) if word.step => start[axis].map(|at| at + word.mm),
            Some(word) => Some(word.mm),
            None => self.state.place[axis],
        });
        if let Err((reason, axes)) = from {
            for (end, unknown) in end.iter_mut().zip(axes) {
                *end = end.filter(|_| !unknown);
            }
            return self.unknown(block, words, stated, end, reason);
        }
        if words.has_arc() && !self.state.code.is_arc() {
            self.fault(
                &block.span,
                "a centre or a radius is stated, and no arc is in force",
                "write G2, G3 or CIP, or take them out",
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
        match self.arc_stated(words, from, to) {
            Ok(known) => {
                end = [0, 1, 2].map(|axis| Some(known.end[axis]));
                self.push(block, words, stated, Some(known), end, "");
            }
            Err((reason, remedy)) => {
                self.fault(&block.span, reason, remedy);
                self.state.place = end;
            }
        }
    }

    /// The arc of a block from a place to another, in the frame's axes.
    ///
    /// # Errors
    /// Why there is none, and what to do.
    pub(crate) fn arc_stated(
        &self,
        words: &Words,
        from: Vector3<f64>,
        to: Vector3<f64>,
    ) -> Result<Known, Reason> {
        let frame = &self.state.frame;
        if self.state.code == Code::Through {
            if words.via.iter().all(Option::is_none) {
                return Err(again("no point on the arc is stated (I1, J1, K1)"));
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
        let found = arc(
            from,
            to,
            has_end,
            normal,
            sense,
            &words.stated_arc(self.state.unit_mm),
        )?;
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
}
