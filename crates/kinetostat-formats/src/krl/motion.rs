//! From a motion statement to a motion; what is in force there is filled in when the order of all is known.

use std::ops::Range;

use crate::krl::behind_ends::rest_of;
use crate::krl::lex::TokenFile;
use crate::krl::speed_place::SpeedPlace;
use crate::krl::state::{Settings, State, Thing};
use crate::krl::steps::{Step, by_step, step_of};
use crate::krl::table::{Ends, MotionRow};
use crate::krl::targets::{End, Targets};
use crate::krl::usage::ends_of;
use crate::krl::values::{Reason, Values};
use crate::krl::with_list::with;
use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::site::{MotionSite, TargetSite};
use crate::model::target::Target;
use crate::options::UnknownTargets;

/// A motion that waits for what was in force before it.
pub(crate) struct Followed {
    pub motion: Motion,
    pub routine: usize,
    /// What is in force as it runs.
    pub state: State,
    /// Which rounding it asks for.
    pub rounding: Option<Thing>,
    pub speed_place: SpeedPlace,
    /// By how much its end is off where the tool is before.
    pub step: Option<Step>,
    /// Members that its end leaves open, and those of the pose on its circle.
    pub open: Option<[Option<f64>; 6]>,
    pub via_open: Option<[Option<f64>; 6]>,
}

/// Where a motion statement stands.
pub(crate) struct Statement<'r> {
    pub row: &'static MotionRow,
    pub routine: usize,
    pub tokens: &'r Range<usize>,
    /// It stands in a spline block.
    pub in_block: bool,
}

/// What a statement does, or why it is refused.
pub(crate) fn follow(
    statement: &Statement<'_>,
    values: &Values<'_>,
    targets: &mut Targets,
    settings: &mut Settings,
    mut state: State,
    unknown: UnknownTargets,
) -> Result<Followed, Reason> {
    let Statement {
        row,
        routine,
        tokens,
        in_block,
    } = *statement;
    let file = values.file(routine);
    let ends = ends_of(file, tokens, row.ends);
    let end_tokens = ends.last().cloned().unwrap_or(tokens.end..tokens.end);
    are_apart(file, (row, tokens), &ends, &end_tokens)?;
    let behind = behind_end(file, end_tokens.end);
    let rest = rest_of(file, behind..tokens.end, row.ends.are_steps())?;
    with((values, settings, routine), &rest.with, &mut state)?;
    let speed_place = SpeedPlace::of(file, &end_tokens, &rest.with, in_block);
    let joint = matches!(row.ends, Ends::Joint | Ends::JointStep);
    let (step, end) = match row.ends {
        Ends::Step | Ends::JointStep => {
            let step = step_of(file, &end_tokens, (joint, rest.in_tool))?;
            (Some(step), by_step())
        }
        _ => {
            let found = targets.find(values, (routine, &settings.given), &end_tokens);
            // Joint motions are not corrected: what goes on from there says whether it must be known.
            let is_left = joint && values.is_elsewhere(routine, &end_tokens);
            let left_as_written = UnknownTargets::LeftAsWritten;
            (
                None,
                left(found, if is_left { left_as_written } else { unknown })?,
            )
        }
    };
    let (kind, via, via_open) = match row.ends {
        Ends::Linear | Ends::Step => (MotionKind::Linear, None, None),
        Ends::Joint | Ends::JointStep => (MotionKind::Joint, None, None),
        Ends::Circular => {
            let via = left(
                targets.find(values, (routine, &settings.given), &ends[0]),
                unknown,
            )?;
            // With the comma and the blanks up to the end.
            let span = file.span(&ends[0]).start..file.span(&end_tokens).start;
            (
                MotionKind::Circular { via: via.target },
                Some((span, via.site)),
                via.open,
            )
        }
    };
    let span = file.span(tokens);
    let motion = Motion {
        file: file.index,
        line: file.source.line_of(span.start),
        kind,
        target: end.target,
        speed: Speed::default(),
        zone: match rest.zone {
            None => Zone::Exact,
            Some(_) => Zone::Unstated,
        },
        tool: nowhere("$TOOL"),
        work_object: nowhere("$BASE"),
        runs: Runs::Once,
        follows: None,
        site: MotionSite {
            keyword: file.span(&(tokens.start..tokens.start + 1)),
            target_span: file.span(&end_tokens),
            target: end.site,
            via,
            speed: None,
            zone: rest.zone,
            external: end.external,
            other_speeds: None,
            external_moved_behind: false,
            indivisible: joint.then_some("this motion cannot be divided"),
            turns_otherwise: None,
        },
        span,
    };
    Ok(Followed {
        motion,
        routine,
        state,
        rounding: rest.rounding,
        speed_place,
        step,
        open: end.open,
        via_open,
    })
}

/// Between the ends of a circle stands a comma, and behind the last end a blank.
fn are_apart(
    file: &TokenFile<'_>,
    (row, tokens): (&MotionRow, &Range<usize>),
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

/// Behind the comma before the angle of a circle.
fn behind_end(file: &TokenFile<'_>, end: usize) -> usize {
    let has_angle = file.is(end, b',') && file.name(end + 1).is_some_and(|name| name.is("CA"));
    end + usize::from(has_angle)
}

/// A frame that nothing before it sets.
fn nowhere(name: &str) -> FrameUse {
    let reason = "no statement sets it on every way to here: set it before the motion, or state it"
        .to_owned();
    FrameUse {
        name: name.to_owned(),
        frame: Frame::Unknown { reason },
    }
}

fn left(found: Result<End, Reason>, unknown: UnknownTargets) -> Result<End, Reason> {
    match found {
        Err((reason, _)) if unknown == UnknownTargets::LeftAsWritten => Ok(End {
            target: Target::Unknown { reason },
            site: TargetSite::Fixed("where it goes is not known from the text"),
            open: None,
            external: Vec::new(),
        }),
        other => other,
    }
}
