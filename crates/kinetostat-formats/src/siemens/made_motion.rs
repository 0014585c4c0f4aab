//! The motions that blocks make, with how each is written.

use std::ops::Range;

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::model::motion::{FrameUse, Motion, MotionKind, Runs, Speed, Zone};
use crate::model::orientation::OrientationText;
use crate::model::site::{MotionSite, PoseText, SpeedSite, TargetSite};
use crate::model::target::{Configuration, PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::siemens::block::Block;
use crate::siemens::state::{Code, FeedMode, StatedModes};
use crate::siemens::walker::{Reader, Written};
use crate::siemens::words::{Purpose, Words};
use crate::text::number::{NumberText, Width};

/// Kind of a motion whose end is known.
pub(crate) struct Known {
    pub kind: MotionKind,
    pub end: Vector3<f64>,
}

impl Reader<'_> {
    /// A pose at a place in the frame's axes.
    pub(crate) fn pose(&self, place: Vector3<f64>) -> PoseTarget {
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
    pub(crate) fn unknown(
        &mut self,
        block: &Block,
        words: &Words,
        stated: StatedModes,
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

    pub(crate) fn push(
        &mut self,
        block: &Block,
        words: &Words,
        stated: StatedModes,
        known: Option<Known>,
        end: [Option<f64>; 3],
        reason: &str,
    ) {
        let state = &self.state;
        let follows = state.last.filter(|_| state.known_place().is_some());
        let speed = self.speed_in_force();
        let anchor = behind_axes(block, words);
        let (kind, target, site) = match known {
            Some(known) => self.known_end(words, anchor, known, follows),
            None => {
                let reason = reason.to_owned();
                let site = TargetSite::Fixed("its end or its way is not known");
                (MotionKind::Linear, Target::Unknown { reason }, site)
            }
        };
        let motion = Motion {
            file: self.index,
            line: self.file.line_of(block.span.start),
            span: block.span.clone(),
            kind,
            target,
            zone: match state.exact || words.exact {
                true => Zone::Exact,
                false => Zone::Unstated,
            },
            tool: self.frame_use(&state.tool),
            work_object: self.frame_use(&state.work_object),
            runs: Runs::Once,
            follows,
            site: site_of(block, words, anchor, site, &speed),
            speed,
        };
        let written = self.as_written(block, words, stated, end);
        self.note_axes(&block.span);
        self.out.motions.push(motion);
        self.out.written.push(written);
        self.count_from(words, end);
        self.state.place = end;
        self.state.last = Some(self.out.motions.len() - 1);
        self.state.stated = StatedModes::default();
        if self.state.known_place().is_some() {
            self.state.lost = false;
        }
    }

    fn speed_in_force(&self) -> Speed {
        let state = &self.state;
        let rapid = state.code == Code::Rapid;
        let feed = state.feed.as_ref().filter(|_| !rapid);
        // Feeds in a minute.
        let feeds = match state.feed_mode {
            FeedMode::PerMinute => Some(1.0),
            FeedMode::PerTurn => state.spindle.in_force(),
        };
        Speed {
            mm_per_s: (feed.zip(feeds))
                .map(|(feed, feeds)| feed.value * feeds * state.feed_unit_mm / 60.0),
            text: match rapid {
                true => "G0".to_owned(),
                false => feed.map_or(String::new(), |feed| feed.text.clone()),
            },
        }
    }

    /// An end that is known, with its numbers, behind the motion that it follows.
    fn known_end(
        &self,
        words: &Words,
        anchor: usize,
        Known { kind, end }: Known,
        follows: Option<usize>,
    ) -> (MotionKind, Target, TargetSite) {
        let site = TargetSite::Literal(self.text(words, anchor, end));
        let mut pose = self.pose(end);
        // A turned frame leaves rounding where the tool stays: it is no way.
        let before = follows.and_then(|last| self.out.motions[last].target.pose());
        if let Some(before) = before
            && (before.position_mm - pose.position_mm).norm() < SAME_MM
        {
            pose.position_mm = before.position_mm;
        }
        (kind, Target::Pose(pose), site)
    }

    /// Collects the data of a block that the writer needs beside its motion.
    fn as_written(
        &self,
        block: &Block,
        words: &Words,
        stated: StatedModes,
        end: [Option<f64>; 3],
    ) -> Written {
        let state = &self.state;
        Written {
            line: block.line.clone(),
            words_at: block.words_at,
            axes: words.axes.clone(),
            rotary: words.rotary.clone(),
            via: words.via.clone(),
            arc_words: words.arc_words(),
            direction_words: words.direction_words(),
            at_end: words.at_end.clone(),
            code: state.code,
            code_word: words.code.clone(),
            feed: state.feed.clone(),
            feed_word: words.feed.clone(),
            stated,
            frame: state.frame,
            unit_mm: state.unit_mm,
            start: state.place,
            end,
            machine: words.purpose == Purpose::Machine,
            steps: state.steps,
            normal: state.normal,
            corner: words.corner.clone(),
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
            unit_mm: 1.0,
            convention: match direction {
                Some(_) => OrientationText::Axis,
                None => OrientationText::Unstated,
            },
            external: Vec::new(),
            width: Width::Free,
        }
    }

    fn frame_use(&self, name: &str) -> FrameUse {
        let stated = self.frames.get(&name.to_ascii_uppercase());
        FrameUse::stated(name, stated, "the program")
    }
}

/// Places nearer than this are one, mm.
const SAME_MM: f64 = 1e-9;

/// Insertion point of missing axis words: after the axis words of the block, or after its code.
pub(crate) fn behind_axes(block: &Block, words: &Words) -> usize {
    let last = |words: &mut dyn Iterator<Item = &Range<usize>>| words.map(|word| word.end).max();
    let mut axes = words.axes.iter().flatten().map(|word| &word.word);
    let mut code = words.code.iter();
    last(&mut axes)
        .or(last(&mut code))
        .unwrap_or(block.words_at)
}

/// Positions of the parts of a motion in its block.
fn site_of(
    block: &Block,
    words: &Words,
    anchor: usize,
    target: TargetSite,
    speed: &Speed,
) -> MotionSite {
    let feed_word = || {
        let feed = words.feed.as_ref();
        feed.map_or(anchor..anchor, |(feed, _)| feed.clone())
    };
    MotionSite {
        keyword: words.code.clone().unwrap_or(block.words_at..block.words_at),
        target_span: anchor..anchor,
        target,
        via: None,
        speed: speed.mm_per_s.map(|_| SpeedSite {
            span: feed_word(),
            before: "F".to_owned(),
            after: String::new(),
            unit_mm_per_s: 1.0,
        }),
        zone: None,
        external: Vec::new(),
        other_speeds: None,
        external_moved_behind: false,
        indivisible: None,
        turns_otherwise: None,
    }
}
