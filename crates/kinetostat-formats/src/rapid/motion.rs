//! From a motion instruction to a motion.

use std::ops::Range;

use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::{Motion, MotionKind, Runs, Speed, Zone};
use crate::model::site::{MotionSite, SpeedSite, TargetSite};
use crate::model::target::Target;
use crate::options::UnknownTargets;
use crate::rapid::arguments::Arguments;
use crate::rapid::expression::{Expression, Value};
use crate::rapid::frames::{Reason, Role, Values};
use crate::rapid::literals::joints_of;
use crate::rapid::symbols::Meaning;
use crate::rapid::table::{Ends, MotionRow};
use crate::rapid::targets::{Found, Targets};

/// Arguments by which the path is corrected while it runs.
const CORRECTED: [&str; 3] = ["CORR", "TRACK", "SEAMNAME"];

/// Where a motion instruction stands.
pub(crate) struct Instruction<'r> {
    pub row: &'static MotionRow,
    /// An index of the routines.
    pub routine: usize,
    /// With its semicolon.
    pub tokens: &'r Range<usize>,
}

/// What an instruction does, or why it is refused.
pub(crate) fn follow(
    instruction: &Instruction<'_>,
    values: &mut Values<'_>,
    targets: &mut Targets,
    unknown: UnknownTargets,
) -> Result<Motion, Reason> {
    let Instruction {
        row,
        routine,
        tokens,
    } = *instruction;
    let file = &values.files[values.symbols.routines[routine].file];
    let arguments = Arguments::of(file, tokens.start + 1..tokens.end);
    let ends = match row.ends {
        Ends::Circular => 2,
        _ => 1,
    };
    let tool_at = ends + 2 + row.between;
    if arguments.ordered.len() <= tool_at {
        let reason = format!("{} needs at least {} arguments", row.name, tool_at + 1);
        return Err((reason, "write its target, speed, zone and tool"));
    }
    if CORRECTED
        .iter()
        .any(|option| arguments.option(option).is_some())
    {
        return Err((
            "the path is corrected by a sensor while the program runs".to_owned(),
            "take this motion into a program of its own",
        ));
    }
    let end = &arguments.ordered[ends - 1];
    let (target, target_site, external) = match row.ends {
        Ends::AbsoluteJoint => joints(values, routine, end),
        _ => pose(targets.find(values, routine, end), unknown)?,
    };
    let (kind, via) = match row.ends {
        Ends::Linear => (MotionKind::Linear, None),
        Ends::Joint | Ends::AbsoluteJoint => (MotionKind::Joint, None),
        Ends::Circular => {
            let first = &arguments.ordered[0];
            let (via, site, _) = pose(targets.find(values, routine, first), unknown)?;
            let span = file.span(&(first.tokens.start..end.tokens.start));
            // With the comma and the blanks up to the end.
            let span = span.start..file.span(&end.tokens).start;
            (MotionKind::Circular { via }, Some((span, site)))
        }
    };
    let (speed, speed_site, other_speeds) = speed(values, routine, &arguments, ends);
    let zone = zone(values, routine, &arguments, tool_at - 1);
    let tool = &arguments.ordered[tool_at];
    let tool = values.frame(routine, Role::Tool, tool, text(values, routine, tool))?;
    let work_object = match arguments.option("WOBJ").flatten() {
        Some(named) => values.frame(
            routine,
            Role::WorkObject,
            named,
            text(values, routine, named),
        )?,
        None => FrameUse {
            name: "wobj0".to_owned(),
            frame: Frame::Known(nalgebra::Isometry3::identity()),
        },
    };
    let span = file.span(tokens);
    let indivisible = match row.straight {
        None => Some("this instruction cannot be divided"),
        Some(_) if arguments.option("T").is_some() => Some("its time is stated, not its speed"),
        Some(_) if arguments.option("ID").is_some() => {
            Some("it runs in step with another robot (\\ID)")
        }
        Some(_) => None,
    };
    Ok(Motion {
        file: file.index,
        line: file.source.line_of(span.start),
        kind,
        target,
        speed,
        zone,
        tool,
        work_object,
        runs: Runs::Once,
        follows: None,
        site: MotionSite {
            keyword: file.span(&(tokens.start..tokens.start + 1)),
            target_span: file.span(&end.tokens),
            target: target_site,
            via,
            speed: speed_site,
            zone: Some(file.span(&arguments.ordered[tool_at - 1].tokens)),
            external,
            other_speeds,
            external_moved_behind: false,
            indivisible,
            turns_otherwise: None,
        },
        span,
    })
}

/// The bytes of an expression.
fn text(values: &Values<'_>, routine: usize, expression: &Expression) -> String {
    let file = &values.files[values.symbols.routines[routine].file];
    String::from_utf8_lossy(file.source.part(&file.span(&expression.tokens))).into_owned()
}

type End = (Target, TargetSite, Vec<Option<f64>>);

fn pose(found: Result<Found, Reason>, unknown: UnknownTargets) -> Result<End, Reason> {
    match found {
        Ok(Found { pose, site }) => {
            let external = pose.external.clone();
            Ok((Target::Pose(pose), site, external))
        }
        Err((reason, _)) if unknown == UnknownTargets::LeftAsWritten => Ok((
            Target::Unknown { reason },
            TargetSite::Fixed("its end is not known from the text"),
            Vec::new(),
        )),
        Err(reason) => Err(reason),
    }
}

/// Joints are not corrected: where they are not known the next motion begins at an unknown place.
fn joints(values: &Values<'_>, routine: usize, expression: &Expression) -> End {
    let found = match &expression.value {
        Value::Word(name) => match values.symbols.meaning(routine, name) {
            Some(Meaning::Datum(index)) if values.symbols.is_fixed(index) => values
                .initial(index)
                .and_then(|initial| joints_of(&initial)),
            _ => None,
        },
        _ => joints_of(expression),
    };
    let site = TargetSite::Fixed("its end is stated in joints");
    match found {
        Some((values_deg, external)) => (Target::Joints { values_deg }, site, external),
        None => {
            let reason = "its joints are not known from the text".to_owned();
            (Target::Unknown { reason }, site, Vec::new())
        }
    }
}

/// The speed, where it can be written otherwise, and what else the data of the speed state.
fn speed(
    values: &mut Values<'_>,
    routine: usize,
    arguments: &Arguments,
    at: usize,
) -> (Speed, Option<SpeedSite>, Option<String>) {
    let expression = &arguments.ordered[at];
    let text = text(values, routine, expression);
    let known = values.speed(routine, expression);
    let others =
        known.map(|[_, turning, linear, rotating]| format!("{turning},{linear},{rotating}"));
    if let Some(stated) = arguments.option("V").flatten() {
        let mm_per_s = values.number(routine, stated);
        return (Speed { mm_per_s, text }, None, others);
    }
    if arguments.option("T").is_some() {
        let mm_per_s = None;
        return (Speed { mm_per_s, text }, None, others);
    }
    let span = values.files[values.symbols.routines[routine].file].span(&expression.tokens);
    let site = others.as_ref().map(|others| SpeedSite {
        span,
        before: "[".to_owned(),
        after: format!(",{others}]"),
        unit_mm_per_s: 1.0,
    });
    let mm_per_s = known.map(|speed| speed[0]);
    (Speed { mm_per_s, text }, site, others)
}

fn zone(values: &mut Values<'_>, routine: usize, arguments: &Arguments, at: usize) -> Zone {
    match arguments.option("Z").flatten() {
        Some(radius) => values
            .number(routine, radius)
            .map_or(Zone::Unstated, Zone::Radius),
        None => values.zone(routine, &arguments.ordered[at]),
    }
}
