//! The motions that a program makes: those whose end is known, and those that stay as they are written.

use std::ops::Range;

use nalgebra::Vector3;

use crate::apt::file_reader::frame_use;
use crate::heidenhain::blocks::Block;
use crate::heidenhain::datum::is_followed;
use crate::heidenhain::ends::Shape;
use crate::heidenhain::reading::walker::{PoleThere, Reader, Way};
use crate::heidenhain::words::Word;
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::Target;
use crate::options::UnknownTargets;

const LEAVE: &str = "leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file), or let the CAM system write L blocks";

/// Reason why the end of a motion after a mirror image or a scaling is unknown.
pub(crate) const UNSTATED: &str = "an axis was not stated since the coordinates were mirrored or scaled, and where it stands in them is not known";

/// Permission to carry a motion with an unknown end: always, or only if the options allow it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Carried {
    Yes,
    IfLeft,
}

/// End of a motion: its target, the position of that in the text, and the programmed coordinates that the block states.
pub(crate) struct MotionEnd {
    pub target: Target,
    pub site: TargetSite,
    pub shape: Shape,
    pub end: [Option<f64>; 3],
}

/// The surface normal that a block states.
fn normal_of(words: &[Word]) -> Option<Vector3<f64>> {
    if !words[0].is("LN") {
        return None;
    }
    let component = |name: &str| words.iter().find(|word| word.is(name))?.value();
    let normal = Vector3::new(component("NX")?, component("NY")?, component("NZ")?);
    normal.try_normalize(1e-6)
}

impl Reader<'_> {
    /// Stores the known coordinates of the end of the last motion, which stays as it is written.
    pub(crate) fn ends_at(&mut self, end: [Option<f64>; 3]) {
        let last = self.found.ways.last_mut();
        if let Some(way) = last.filter(|way| way.shape == Shape::Unknown) {
            way.end = end;
        }
    }

    /// A cycle is called at the end of a block.
    pub(crate) fn called(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        end: [Option<f64>; 3],
    ) {
        let reason = "a cycle is called: from here the control drills or mills by itself";
        let other = self.state.cycle.filter(|cycle| !is_followed(*cycle));
        if self.options.unknown_targets == UnknownTargets::Refused {
            match other {
                Some(cycle) => self.fault(
                    span,
                    format!("cycle {cycle} is called: the control drills or mills by itself, and what this cycle does is not followed"),
                    "let the CAM system write its motions as L and C blocks, or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                ),
                None => self.fault(
                    span,
                    reason,
                    "write drilling cycles flat first (--expand), or leave such motions as written (unknown_targets = \"left_as_written\" under [robot] in a job file)",
                ),
            }
        } else {
            self.unknown(block, words, span, reason, Carried::IfLeft);
            self.ends_at(end);
        }
        // Consequences of a refused call are not reported again.
        let left = self.options.unknown_targets != UnknownTargets::Refused;
        self.state.place = [end[0], end[1], end[2].filter(|_| !left)];
        self.state.direction = None;
        self.state.last = None;
    }

    /// A motion whose end is not known: refused, or carried as it is written.
    pub(crate) fn unknown(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        reason: &'static str,
        carried: Carried,
    ) {
        let refused = self.options.unknown_targets == UnknownTargets::Refused;
        if carried == Carried::IfLeft {
            if refused {
                let remedy = match reason {
                    UNSTATED => "state X, Y and Z once behind the mirror image or the scaling",
                    _ => LEAVE,
                };
                return self.fault(span, reason, remedy);
            }
            self.finding(span, format!("it stays as it is written: {reason}"));
        }
        let target = Target::Unknown {
            reason: reason.to_owned(),
        };
        let end = MotionEnd {
            target,
            site: TargetSite::Fixed("its end is not known"),
            shape: Shape::Unknown,
            end: [None; 3],
        };
        self.push(block, words, span, MotionKind::Linear, end, true);
    }

    pub(crate) fn push(
        &mut self,
        block: &Block,
        words: &[Word],
        span: &Range<usize>,
        kind: MotionKind,
        end: MotionEnd,
        rapid: bool,
    ) {
        let MotionEnd {
            target,
            site,
            shape,
            end,
        } = end;
        let speed = match rapid {
            true => Speed {
                mm_per_s: None,
                text: "FMAX".to_owned(),
            },
            false => self.state.speed(self.unit_mm),
        };
        let known = speed.mm_per_s.is_some();
        let turns = match &kind {
            MotionKind::Arc { angle_rad, .. } => angle_rad.signum() * self.state.datum.sense(),
            _ => 0.0,
        };
        let normal = normal_of(words);
        let normals = [self.state.normal, normal];
        self.state.normal = normal;
        let is_arc = matches!(kind, MotionKind::Arc { .. });
        let fixed = TargetSite::Fixed("an arc with other ends is none about its written centre");
        self.found.motions.push(Motion {
            file: self.index,
            line: self.file.line_of(block.lines.start),
            span: span.clone(),
            kind,
            target,
            zone: Zone::Unstated,
            tool: frame_use(self.frames, &self.state.tool),
            work_object: frame_use(self.frames, &self.state.preset),
            runs: Runs::Once,
            follows: self.state.last,
            site: MotionSite {
                keyword: words[0].span.clone(),
                target_span: span.clone(),
                target: site,
                via: is_arc.then_some((span.start..span.start, fixed)),
                speed: known.then(|| SpeedSite {
                    span: span.start..span.start,
                    before: String::new(),
                    after: String::new(),
                    unit_mm_per_s: 1.0,
                }),
                zone: None,
                external: Vec::new(),
                other_speeds: None,
                external_moved_behind: false,
                indivisible: None,
                turns_otherwise: None,
            },
            speed,
        });
        let axes = self.state.standing.of_motion(self.state.tip.on);
        if let Some(axes) = &axes {
            let index = self.found.motions.len() - 1;
            self.found.axes.insert(index, axes.clone());
        }
        self.found.ways.push(Way {
            axes,
            shorter: self.state.shorter,
            block: block.clone(),
            shape,
            start: self.state.counts_from(),
            end,
            datum: self.state.datum,
            unit_mm: self.unit_mm,
            feed: self.state.feed.filter(|_| known),
            turns,
            plane: match (words[0].letters.letters(), self.state.pole) {
                (b"C" | b"CP" | b"CTP" | b"LP", Some(pole)) => pole.plane,
                _ => self.state.plane,
            },
            working: self.state.plane,
            aside: self.state.aside.map(|side| (side, self.state.cutter_mm)),
            directed: self.state.directed,
            normals,
            pole: PoleThere {
                at: self.state.pole,
                used: matches!(words[0].letters.letters(), b"C" | b"CP" | b"CTP" | b"LP"),
                count: self.poles[0],
                whole: self.poles[1],
            },
            pole_from: self.pole_from,
        });
        self.state.last = Some(self.found.motions.len() - 1);
    }
}
