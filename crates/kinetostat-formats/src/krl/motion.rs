//! Conversion of a motion statement to a motion, with the modal state at its execution.

use std::ops::Range;

use crate::interpreter::run::Reason;
use crate::interpreter::token::TokenFile;
use crate::krl::behind_ends::{Rest, Rounding, SpeedPlace, rest_of};
use crate::krl::ends::{End, WRITE_END, ends_of, step_of};
use crate::krl::expression::expression_of;
use crate::krl::position::{completed, is_beyond, kept_angles, position_of};
use crate::krl::state::{KEPT, Role, Run, turned};
use crate::krl::table::{Ends, MotionRow};
use crate::model::motion::{Frame, FrameUse, Motion, MotionKind, Runs, Speed, Zone};
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::{PoseTarget, Target};
use crate::options::UnknownTargets;

const OPEN: &str = "it states only some of X, Y, Z, A, B, C, and the pose before it is not known from the text in these axes";

const BEYOND: &str = "it states only some of A, B and C, and the pose before it has a B of 90 degrees or beyond: a controller may keep other angles than those that are written";

const STEP: &str =
    "it goes on from where the tool is, and that is not known from the text in these axes";

impl Run<'_, '_> {
    /// The motion of a statement, or why it is refused. What its WITH puts in force is for it alone.
    pub(super) fn motion(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
    ) -> Result<Motion, Reason> {
        let file = self.file();
        let ends = ends_of(file, tokens, row.ends);
        let end_tokens = ends.last().cloned().unwrap_or(tokens.end..tokens.end);
        are_apart(file, row, tokens, &ends, &end_tokens)?;
        let behind = behind_end(file, end_tokens.end);
        let rest = rest_of(file, behind..tokens.end, row.ends.are_steps())?;
        let before = (!rest.with.is_empty()).then(|| self.own.force.clone());
        let motion = self
            .with(&rest.with)
            .and_then(|()| self.motion_with(row, tokens, &ends, &rest));
        if let Some(before) = before {
            self.own.force = before;
        }
        motion
    }

    fn motion_with(
        &mut self,
        row: &'static MotionRow,
        tokens: &Range<usize>,
        ends: &[Range<usize>],
        rest: &Rest,
    ) -> Result<Motion, Reason> {
        let file = self.file();
        let is_joint = matches!(row.ends, Ends::Joint | Ends::JointStep);
        let end_tokens = ends.last().cloned().unwrap_or(tokens.end..tokens.end);
        let tool = self.in_force(Role::Tool);
        let work_object = self.in_force(Role::Base);
        let last = self.here.and_then(|here| self.motions.get(here));
        let from = last
            .filter(|last| last.tool == tool && last.work_object == work_object)
            .map(|last| last.target.clone());
        let is_beyond = self.here.is_some_and(|here| self.own.beyond[here]);
        let mut end = match row.ends.are_steps() {
            true => self.step_from(&end_tokens, from.as_ref(), is_joint, rest.in_tool)?,
            false => {
                // Joint motions are not corrected: what goes on from there says whether it must be known.
                let is_left = is_joint && self.is_elsewhere(&end_tokens);
                let found = self.end(&end_tokens);
                self.left(found, is_left)?
            }
        };
        let before = from.as_ref().and_then(Target::pose);
        let circle = match row.ends {
            Ends::Circular => {
                let found = self.end(&ends[0]);
                let mut via = self.left(found, false)?;
                // The orientation on the way is that of the ends: only the place counts.
                via.open = (via.open).filter(|open| open[..3].iter().any(Option::is_none));
                self.complete(&mut via, before, is_beyond)?;
                // With the comma and the blanks up to the end.
                let span = file.span(&ends[0]).start..file.span(&end_tokens).start;
                Some((via, span))
            }
            _ => None,
        };
        self.complete(&mut end, before, is_beyond)?;
        let (kind, via) = match circle {
            Some((via, span)) => (
                MotionKind::Circular { via: via.target },
                Some((span, via.site)),
            ),
            None if is_joint => (MotionKind::Joint, None),
            None => (MotionKind::Linear, None),
        };
        let keeps = !is_joint && self.own.force.keeps_orientation;
        if keeps && let Some(reason) = turned(before, end.target.pose()) {
            self.fault(tokens, reason);
        }
        let span = file.span(tokens);
        let (speed, speed_site) = match is_joint {
            true => (Speed::default(), None),
            false => self.speed(tokens, &end_tokens, rest),
        };
        self.own.beyond.truncate(self.motions.len());
        let ends_beyond = end.b.map_or(is_beyond, crate::krl::position::is_beyond);
        self.own.beyond.push(match end.site {
            TargetSite::Offset { .. } | TargetSite::Replaced(_) | TargetSite::Joints(_) => false,
            _ => ends_beyond,
        });
        Ok(Motion {
            file: file.index,
            line: file.source.line_of(span.start),
            kind,
            target: end.target,
            speed,
            zone: self.zone(rest),
            tool,
            work_object,
            runs: Runs::Once,
            follows: None,
            site: MotionSite {
                keyword: file.span(&(tokens.start..tokens.start + 1)),
                target_span: file.span(&end_tokens),
                target: end.site,
                via,
                speed: speed_site,
                zone: rest.zone.clone(),
                external: end.external,
                other_speeds: None,
                external_moved_behind: false,
                indivisible: is_joint.then_some("this motion cannot be divided"),
                turns_otherwise: keeps.then_some(KEPT),
            },
            span,
        })
    }

    /// The speed in force, and where another one is written.
    fn speed(
        &self,
        tokens: &Range<usize>,
        end: &Range<usize>,
        rest: &Rest,
    ) -> (Speed, Option<SpeedSite>) {
        let file = self.file();
        let Some(speed) = self.own.force.speed.clone() else {
            return (Speed::default(), None);
        };
        let place = SpeedPlace::of(file, end, &rest.with, self.own.spline.is_some());
        let start = file.span(tokens).start;
        let line_end = [file.source.line_ending(), file.source.indentation(start)].concat();
        let line_end = String::from_utf8_lossy(&line_end);
        let site = speed.mm_per_s.and_then(|_| place.site(start, &line_end));
        (speed, site)
    }

    fn zone(&self, rest: &Rest) -> Zone {
        let force = &self.own.force;
        let zone = match rest.rounding {
            None if rest.zone.is_none() => return Zone::Exact,
            None | Some(Rounding::Turning) => None,
            Some(Rounding::Distance) => force.distance_mm.map(Zone::Radius),
            Some(Rounding::JointPercent) => force.joint_percent.map(Zone::Percent),
            Some(Rounding::SpeedPercent) => force.speed_percent.map(Zone::Percent),
        };
        zone.unwrap_or(Zone::Unstated)
    }

    /// The tool or base in force, or the one that the caller states where nothing sets it.
    fn in_force(&self, role: Role) -> FrameUse {
        let set = match role {
            Role::Tool => &self.own.force.tool,
            Role::Base => &self.own.force.base,
        };
        let stated = || self.stated_frame(role.variable());
        set.clone().or_else(stated).unwrap_or_else(|| FrameUse {
            name: role.variable().to_owned(),
            frame: Frame::Unknown {
                reason:
                    "no statement sets it on every way to here: set it before the motion, or state it"
                        .to_owned(),
            },
        })
    }

    /// The end of a step from where the tool is.
    fn step_from(
        &mut self,
        tokens: &Range<usize>,
        from: Option<&Target>,
        is_joint: bool,
        in_tool: bool,
    ) -> Result<End, Reason> {
        let value = self.value(&expression_of(self.file(), tokens.clone()));
        let position = position_of(self.files, &value)
            .map_err(|reason| (format!("its step: {reason}"), WRITE_END))?;
        let step = step_of(&position, is_joint, in_tool)?;
        let target = match (from.and_then(|from| step.from(from)), is_joint) {
            (Some(end), _) => end,
            (None, false) if self.options.unknown_targets == UnknownTargets::Refused => {
                return Err((
                    STEP.to_owned(),
                    "write the end with LIN and all its numbers",
                ));
            }
            (None, _) => Target::Unknown {
                reason: STEP.to_owned(),
            },
        };
        Ok(End {
            target,
            site: TargetSite::Fixed("it goes on from where the tool is"),
            open: None,
            external: Vec::new(),
            b: None,
        })
    }

    /// Fills in what an end leaves open from the pose before.
    fn complete(
        &self,
        end: &mut End,
        before: Option<&PoseTarget>,
        beyond: bool,
    ) -> Result<(), Reason> {
        let (Some(open), Target::Pose(pose)) = (end.open, &mut end.target) else {
            return Ok(());
        };
        let filled = before.and_then(|before| {
            let is_beyond = beyond || is_beyond(kept_angles(&before.orientation)[1]);
            completed(&open, before, is_beyond)
        });
        let why = match before {
            Some(_) => BEYOND,
            None => OPEN,
        };
        match (filled, self.options.unknown_targets) {
            (Some((position_mm, orientation)), _) => {
                pose.position_mm = position_mm;
                pose.orientation = orientation;
            }
            (None, UnknownTargets::LeftAsWritten) => {
                end.target = Target::Unknown {
                    reason: why.to_owned(),
                };
            }
            (None, UnknownTargets::Refused) => {
                return Err((why.to_owned(), "write all of X, Y, Z, A, B and C"));
            }
        }
        Ok(())
    }

    /// An end that is not known is left as it is written, where the caller (or `is_left`) says so.
    fn left(&self, found: Result<End, Reason>, is_left: bool) -> Result<End, Reason> {
        match found {
            Err((reason, _))
                if is_left || self.options.unknown_targets == UnknownTargets::LeftAsWritten =>
            {
                Ok(End {
                    target: Target::Unknown { reason },
                    site: TargetSite::Fixed("where it goes is not known from the text"),
                    open: None,
                    external: Vec::new(),
                    b: None,
                })
            }
            other => other,
        }
    }

    /// True for a name that none of the files declares, as home positions of the controller are: its `$config.dat` has XHOME.
    fn is_elsewhere(&self, tokens: &Range<usize>) -> bool {
        let name = self.file().name(tokens.start);
        let name = name.filter(|_| tokens.len() == 1);
        name.is_some_and(|name| {
            let is_own = !name.letters().starts_with(b"$") || name.is("$H_POS");
            is_own && self.root(&name).is_none()
        })
    }
}

/// Between the ends of a circle stands a comma, and behind the last end a blank.
fn are_apart(
    file: &TokenFile<'_>,
    row: &MotionRow,
    tokens: &Range<usize>,
    ends: &[Range<usize>],
    last: &Range<usize>,
) -> Result<(), Reason> {
    if row.ends == Ends::Circular
        && let Some(via) = ends.first()
        && via.end < tokens.end
        && !file.is(via.end, b',')
    {
        return Err((
            "no comma stands between the place on the circle and its end".to_owned(),
            "write  CIRC place, end",
        ));
    }
    let next = file.tokens.get(last.end);
    let next = next.map(|token| token.bytes().start);
    let touches = next == Some(file.span(last).end);
    if last.end < tokens.end && touches && file.name(last.end).is_some() {
        return Err((
            "nothing stands between the target and the word behind it".to_owned(),
            "write a blank there",
        ));
    }
    Ok(())
}

/// Position after the comma before the angle of a circle.
fn behind_end(file: &TokenFile<'_>, end: usize) -> usize {
    let has_angle = file.is(end, b',') && file.name(end + 1).is_some_and(|name| name.is("CA"));
    end + usize::from(has_angle)
}
