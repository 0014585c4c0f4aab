//! What depends on where routines are called from: how often motions run, where they begin, what is in force.

use crate::calls::{Holds, of_calls};
use crate::error::ProgramError;
use crate::krl::folds::{contradiction, folds_of, text_of};
use crate::krl::kept::{completed, is_beyond, kept_angles};
use crate::krl::motion::Followed;
use crate::krl::role::Role;
use crate::krl::state::{Settings, Slot, State, Thing};
use crate::krl::turning::{KEPT, turned};
use crate::krl::values::{Reason, Values};
use crate::krl::walking::walker::Walker;
use crate::model::frame::FrameUse;
use crate::model::motion::{Motion, MotionKind, Runs, Zone};
use crate::model::outside_call::OutsideCall;
use crate::model::site::{Declaration, TargetSite};
use crate::model::target::{PoseTarget, Target};
use crate::options::UnknownTargets;
use crate::text::finding::Finding;

/// Motions in their order, and what a person should know of them.
pub(crate) struct Resolved {
    pub motions: Vec<Motion>,
    pub findings: Vec<Finding>,
    /// What is called and none of the files holds.
    pub outside_calls: Vec<OutsideCall>,
}

/// Fills in what is open in a walked program.
pub(crate) fn resolve(walker: Walker<'_, '_>, main: Option<usize>) -> Resolved {
    let (runs, entry) = of_calls(&walker.summaries, &walker.finished, main);
    let Walker {
        values,
        settings,
        unknown,
        faults,
        motions,
        findings,
        targets,
        ..
    } = walker;
    let mut resolver = Resolver {
        values,
        settings,
        unknown,
        findings,
        declarations: &targets.declarations,
        beyond: Vec::with_capacity(motions.len()),
        done: Vec::with_capacity(motions.len()),
    };
    for (name, file, line) in values.contradicted() {
        let message = format!(
            "`{name}` gets other numbers here than those that are stated for it: where the program has several values for it, its own count, else those that are stated"
        );
        resolver.findings.push(Finding {
            file,
            line,
            message,
        });
    }
    let mut folds: Vec<Option<Vec<Option<usize>>>> = values.files.iter().map(|_| None).collect();
    for followed in motions {
        let state = followed.state.in_call(entry[followed.routine]);
        let often = runs[followed.routine];
        let (file, span) = (followed.motion.file, followed.motion.span.clone());
        if let Err((reason, remedy)) = resolver.motion(followed, state, often) {
            faults.push(ProgramError::at(
                values.files[file].source,
                span,
                reason,
                remedy,
            ));
        }
        let around = folds[file].get_or_insert_with(|| folds_of(&values.files[file]));
        resolver.compare_fold(around);
    }
    Resolved {
        motions: resolver.done,
        findings: resolver.findings,
        outside_calls: resolver.settings.calls,
    }
}

struct Resolver<'v, 'p> {
    values: &'v Values<'p>,
    settings: Settings,
    unknown: UnknownTargets,
    findings: Vec<Finding>,
    declarations: &'v [Declaration],
    done: Vec<Motion>,
    /// Of each motion done: whether its end has a B beyond 90 degrees, with which the angles of an orientation are not certain.
    beyond: Vec<bool>,
}

impl Resolver<'_, '_> {
    fn motion(&mut self, followed: Followed, state: State, often: Runs) -> Result<(), Reason> {
        let Followed {
            mut motion,
            rounding,
            speed_place,
            step,
            open,
            via_open,
            ..
        } = followed;
        motion.runs = often.max(motion.runs);
        motion.follows = match state.get(Thing::Place) {
            Slot::Is(index) => Some(index),
            Slot::Entry | Slot::Unknown => None,
        };
        motion.tool = self.frame(state.get(Thing::Tool), Role::Tool, motion.tool);
        let base = state.get(Thing::Base);
        motion.work_object = self.frame(base, Role::Base, motion.work_object);
        if motion.kind != MotionKind::Joint
            && let Some(speed) = self.settings.speeds.get(state.get(Thing::Speed))
        {
            motion.speed = speed.clone();
            let source = self.values.files[motion.file].source;
            let start = motion.span.start;
            let line_end = [source.line_ending(), source.indentation(start)].concat();
            let line_end = String::from_utf8_lossy(&line_end);
            motion.site.speed = (speed.mm_per_s).and_then(|_| speed_place.site(start, &line_end));
        }
        if let Some(thing) = rounding
            && let Some(number) = self.settings.numbers.get(state.get(thing))
        {
            motion.zone = match thing {
                Thing::Distance => Zone::Radius(*number),
                _ => Zone::Percent(*number),
            };
        }
        let from = (motion.follows).and_then(|index| self.before(index, &motion));
        let before = from.and_then(Target::pose).cloned();
        let mut fault = None;
        if let Some(step) = step {
            let is_left = motion.kind == MotionKind::Joint;
            match (from.and_then(|from| step.from(from)), self.unknown) {
                (Some(end), _) => motion.target = end,
                (None, UnknownTargets::Refused) if !is_left => {
                    fault = Some((
                        STEP.to_owned(),
                        "write the end with LIN and all its numbers",
                    ));
                }
                (None, _) => {
                    let reason = STEP.to_owned();
                    motion.target = Target::Unknown { reason };
                }
            }
        }
        // A routine may follow a motion that stands behind it in the file, and is not known yet.
        let beyond = (motion.follows)
            .is_some_and(|index| self.beyond.get(index).is_none_or(|beyond| *beyond));
        let mut fill = |target: &mut Target, open: Option<[Option<f64>; 6]>| {
            let (Some(open), Target::Pose(pose)) = (open, &mut *target) else {
                return;
            };
            let is_beyond =
                |before: &PoseTarget| beyond || is_beyond(kept_angles(&before.orientation)[1]);
            let filled = before
                .as_ref()
                .and_then(|before| completed(&open, before, is_beyond(before)));
            let why = match before {
                Some(_) => BEYOND,
                None => OPEN,
            };
            match (filled, self.unknown) {
                (Some((position_mm, orientation)), _) => {
                    pose.position_mm = position_mm;
                    pose.orientation = orientation;
                }
                (None, UnknownTargets::LeftAsWritten) => {
                    *target = Target::Unknown {
                        reason: why.to_owned(),
                    }
                }
                (None, UnknownTargets::Refused) => {
                    fault = Some((why.to_owned(), "write all of X, Y, Z, A, B and C"));
                }
            }
        };
        fill(&mut motion.target, open);
        if let MotionKind::Circular { via } = &mut motion.kind {
            // The orientation on the way is that of the ends: only the place counts.
            let placed = via_open.filter(|open| open[..3].iter().any(Option::is_none));
            fill(via, placed);
        }
        if motion.kind != MotionKind::Joint
            && self
                .settings
                .keeps_orientation(state.get(Thing::Orientation))
        {
            motion.site.turns_otherwise = Some(KEPT);
            fault = fault.or_else(|| turned(before.as_ref(), motion.target.pose()));
        }
        self.beyond.push(self.ends_beyond(&motion, beyond));
        self.done.push(motion);
        fault.map_or(Ok(()), Err)
    }

    /// Whether the B with which a motion ends is beyond 90 degrees, as it is written or as that of before was.
    fn ends_beyond(&self, motion: &Motion, before: bool) -> bool {
        let b = match &motion.site.target {
            TargetSite::Literal(text) => text.orientation.get(1),
            TargetSite::Declared { declaration, .. } => {
                let declared = self.declarations.get(*declaration);
                declared.and_then(|declared| declared.text.orientation.get(1))
            }
            TargetSite::Partial(text) => text.numbers[4].as_ref(),
            TargetSite::Offset { .. } | TargetSite::Replaced(_) | TargetSite::Joints(_) => {
                return false;
            }
            TargetSite::Fixed(_) => None,
        };
        b.map_or(before, |b| is_beyond(b.value))
    }

    /// The end before, where it is in the same axes and of the same tool.
    fn before(&self, index: usize, motion: &Motion) -> Option<&Target> {
        let before = self.done.get(index)?;
        let same = before.tool == motion.tool && before.work_object == motion.work_object;
        same.then_some(&before.target)
    }

    /// The frame in force at a motion of a file.
    fn frame(&self, slot: Slot, role: Role, none: FrameUse) -> FrameUse {
        let found = self.settings.frames.get(slot).cloned();
        found
            .or_else(|| self.values.stated(role.variable()))
            .unwrap_or(none)
    }

    fn compare_fold(&mut self, around: &[Option<usize>]) {
        let Some(motion) = self.done.last() else {
            return;
        };
        let file = &self.values.files[motion.file];
        let line = file.lines.partition_point(|line| {
            file.tokens
                .get(line.tokens.start)
                .is_some_and(|token| token.bytes().start <= motion.span.start)
        });
        let fold = line
            .checked_sub(1)
            .and_then(|line| around.get(line).copied().flatten());
        let text = fold.map(|fold| text_of(file, fold));
        if let Some(message) =
            text.and_then(|text| contradiction(text, &motion.tool, &motion.work_object))
        {
            let (file, line) = (motion.file, motion.line);
            self.findings.push(Finding {
                file,
                line,
                message,
            });
        }
    }
}

const OPEN: &str = "it states only some of X, Y, Z, A, B, C, and the pose before it is not known from the text in these axes";

const BEYOND: &str = "it states only some of A, B and C, and the pose before it has a B of 90 degrees or beyond: a controller may keep other angles than those that are written";

const STEP: &str =
    "it goes on from where the tool is, and that is not known from the text in these axes";
