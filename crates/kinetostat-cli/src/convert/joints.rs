//! A program as a table of joint values of an arm: `convert --to joints`.

use std::sync::Arc;

use kinetostat::{Mechanism, Pose, PostureRequest};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    BetweenRows, FrameUse, JointStart, Made, Rapids, TableArm, Template, joint_table,
};
use kinetostat_machining::number::counted;
use kinetostat_model::Model;
use kinetostat_program::{Knowledge, Move};
use nalgebra::Isometry3;

use crate::convert::free_turn::base_of_source;
use crate::job::program::ReadProgram;
use crate::job::robot::frames::in_metres;
use crate::job::robot::joint_arm::ArmOfTable;
use crate::job::robot_arguments::JointRowsWord;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing, Failure};

/// Uses all digits: the poses are only an intermediate result.
pub(crate) fn with_all_digits(template: &mut Template) {
    template.position_decimals = 12;
    template.quaternion_decimals = 15;
}

/// Model of the joint values, and the interpolation of the controller from row to row.
pub(crate) struct Asked<'m> {
    pub(crate) model: &'m Model,
    pub(crate) rows: Option<JointRowsWord>,
}

/// Puts joint values in place of the poses of a made table; what is to be said of them.
pub(crate) fn as_joints(
    setting: &Setting,
    template: &Template,
    read: &ReadProgram<'_>,
    asked: &Asked<'_>,
    made: &mut Made,
) -> Answer<String> {
    let (base, tool) = frames(template, read)?;
    let mechanism = asked.model.mechanism.with_tool(&tool);
    let Some(arm) = ArmOfTable::of(asked.model, &tool).map(Arc::new) else {
        return Err(ErrorCode::ModelUnsuited.failure(format!(
                "the model '{}' is no arm of six turning joints in one chain: name one with --model, or write poses (--to csv)",
                asked.model.name()
            ),
        ));
    };
    let mut start = JointStart::default();
    start.tolerance_mm = template.tolerance_mm;
    start.base = base;
    // Rapids of G-code (no robot language) are straight.
    let language = read.robot().map(|robot| robot.program.language);
    start.straight_rapids = template.rapids == Rapids::Linear
        && language.is_none_or(|language| language.rapids_are_straight());
    start.near = match &template.start_joints_deg {
        Some(joints) => joints.clone(),
        None => {
            let commands = first_joints(read, template, &mechanism, &base);
            let commands = commands.map_err(|failure| setting.within(failure))?;
            arm.shown_deg(&commands).unwrap_or_default()
        }
    };
    let table = TableArm {
        between: asked.rows.map_or(BetweenRows::Linear, BetweenRows::from),
        arm: arm.clone(),
    };
    let Some((_, bytes)) = made.files.first_mut() else {
        return Ok(String::new());
    };
    let done = joint_table(bytes, &table, &start);
    let done = done.map_err(|error| {
        let line = source_line(made, error.line);
        setting.within(ErrorCode::ProgramUnsuited.failure(format!("line {line}: {}", error.reason)))
    })?;
    for (line, joints) in &done.rows {
        let commands = arm.model_joints(joints);
        let posture = mechanism.posture(PostureRequest::commands(&commands));
        if let Err(error) = posture.and_then(|posture| posture.within_limits()) {
            let line = source_line(made, *line);
            let failure = Failure::from(error);
            return Err(setting.within(ErrorCode::ProgramUnsuited.failure(format!(
                "line {line}: {}: move the part, turn the tool about its axis (--free-turn), or begin in another configuration (start_joints_deg in the template)",
                failure.plain
            ))));
        }
    }
    if let Some((_, bytes)) = made.files.first_mut() {
        *bytes = done.bytes;
    }
    let [mm, rad] = done.departure;
    let rapids = match done.rapid_departure_mm > template.tolerance_mm {
        true => format!(
            ". In rapids all joints move in step from one end to the other, up to {:.3} mm beside the straight way at their middle",
            done.rapid_departure_mm
        ),
        false => String::new(),
    };
    Ok(format!(
        "{} of joint values of {}, as {}, each next to the one before; they give the poses within {mm:.1e} mm and {rad:.1e} rad. From row to row {}. To read them: --joint-rows {}, and the tool in the flange{rapids}",
        counted(done.rows.len(), "row"),
        asked.model.name(),
        match &asked.model.controller {
            Some(_) => "the controller shows them ([controller] of the model)",
            None => "the model counts them",
        },
        match table.between {
            BetweenRows::Joint => "all joints move in step",
            BetweenRows::Linear =>
                "the controller has to go straight (all joints in step: --joint-rows joint)",
        },
        match table.between {
            BetweenRows::Joint => "joint",
            BetweenRows::Linear => "linear",
        }
    ))
}

/// The line of the source that a line of the made table is of.
fn source_line(made: &Made, line: usize) -> usize {
    let found = made.lines.iter().find(|[own, _]| *own >= line);
    found.map_or(1, |[_, source]| *source)
}

/// Joint values of the first place, rad, in the configuration of the model's home.
fn first_joints(
    read: &ReadProgram<'_>,
    template: &Template,
    mechanism: &Mechanism,
    base: &Isometry3<f64>,
) -> Answer<[f64; 6]> {
    let mut moves = read.path().moves.iter();
    let first = moves.find(|motion| motion.known != Knowledge::Nothing);
    let turned = |motion: &Move| motion.orientation(1.0).or(template.tool_orientation);
    let Some((motion, turn)) = first.and_then(|motion| Some((motion, turned(motion)?))) else {
        return Err(ErrorCode::ProgramUnsuited.failure("the path has no place, or does not say how the tool stands: state its orientation (tool_orientation in the template, or --tool-orientation)",
        ));
    };
    let pose = in_metres(&(base * Isometry3::from_parts(motion.end.into(), turn)));
    let posture = mechanism.posture(&pose).map_err(|error| {
        let failure = Failure::from(error);
        ErrorCode::ProgramUnsuited.failure(format!("line {}: {}", motion.line, failure.plain))
    })?;
    let commands = <[f64; 6]>::try_from(posture.commands());
    commands.map_err(|_| ErrorCode::ModelUnsuited.failure("the model has other joints than six"))
}

/// Poses of part in base, mm, and tool in flange, m: of the template, else of the program.
fn frames(template: &Template, read: &ReadProgram<'_>) -> Answer<(Isometry3<f64>, Pose)> {
    let robot = read.robot().map(|robot| &robot.path);
    let several = robot.is_some_and(|path| path.tools.len() > 1) || template.tools.len() > 1;
    if several {
        return Err(ErrorCode::ProgramUnsuited.failure("the program takes several tools, and a table of joint values is of one: divide the program",
        ));
    }
    let of_source = |frame: &FrameUse| frame.known().copied();
    let base = base_of_source(read).or(template.base.pose).or_else(|| {
        let frame = robot.and_then(|path| path.work_object.as_ref());
        frame.and_then(of_source)
    });
    let numbered = template.tools.values().next();
    let of_template = numbered.map_or(template.tool.frame.pose, |tool| tool.frame.pose);
    let tool = of_template.or_else(|| robot.and_then(|path| of_source(path.tools.first()?)));
    let missing = |what: &str| {
        ErrorCode::Missing.failure(format!(
                "joint values need to know {what}, and neither the program nor the template (--template) says it"
            ),
        )
    };
    let base = base.ok_or_else(|| missing("where the part is: pose under [base]"))?;
    let tool = tool.ok_or_else(|| missing("where the tip of the tool is: pose under [tool]"))?;
    Ok((base, in_metres(&tool)))
}
