//! Tool and placement of a run over a robot's program: of the program where it states them, else of the job.

use kinetostat::{Mechanism, Pose};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::KRL_CONFIG;
use kinetostat_machining::{Placement, ProgramLoad, ToolGiven};
use nalgebra::Vector3;

use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::robot::frames::RobotFrames;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::{short, triple};

/// Differences below this are those of digits, m and rad.
const SAME: f64 = 1e-6;

fn differ(a: &Pose, b: &Pose) -> bool {
    (a.translation.vector - b.translation.vector).norm() > SAME
        || a.rotation.angle_to(&b.rotation) > SAME
}

/// The axis of a tool in words, `-z` or its parts.
fn axis_words(axis: &Vector3<f64>) -> String {
    let named = [("x", axis.x), ("y", axis.y), ("z", axis.z)];
    let whole = named.iter().find(|(_, part)| part.abs() > 1.0 - 1e-9);
    match whole {
        Some((name, part)) if *part < 0.0 => format!("-{name}"),
        Some((name, _)) => (*name).to_owned(),
        None => format!("({}, {}, {})", short(axis.x), short(axis.y), short(axis.z)),
    }
}

fn is_unturned(pose: &Pose) -> bool {
    pose.rotation.angle().to_degrees() < 1e-6
}

fn words(name: &str, pose: &Pose) -> String {
    let tip = triple((1e3 * pose.translation.vector).into(), short);
    let turned = pose.rotation.angle().to_degrees();
    match is_unturned(pose) {
        true => format!("{name}: tip at {tip} mm in the flange, axes of the flange"),
        false => format!(
            "{name}: tip at {tip} mm in the flange, turned by {} deg",
            short(turned)
        ),
    }
}

/// The tool in the flange, with words.
pub(crate) fn tool_of_robot(
    frames: &RobotFrames,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    stated: Pose,
    stated_words: String,
) -> Answer<(Pose, String)> {
    let is_stated = flags.tool_length_mm.is_some()
        || job.is_some_and(|j| j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some());
    match frames.tools.first() {
        None => Ok((stated, stated_words)),
        Some((_, _, None)) if is_stated || !frames.states_orientation => Ok((stated, stated_words)),
        Some((_, name, None)) => Err(ErrorCode::Missing.failure(format!("{}, or under [tool]", not_stated(name)),
        )),
        Some((_, name, Some(pose))) if is_stated && differ(pose, &stated) => Err(ErrorCode::Conflict.failure(format!(
                "the tool is stated twice, and not the same: {} by the program; {stated_words}, by the job. Leave out [tool] (or --tool-length-mm), or correct one of them",
                words(name, pose)
            ),
        )),
        Some((_, name, Some(pose))) => {
            let axis = axis_words(&frames.tool_axis);
            let own = frames.own_angles.filter(|_| !is_unturned(pose));
            let own = own.map_or_else(String::new, |own| {
                format!(" ({})", own.words(&pose.rotation))
            });
            Ok((
                *pose,
                format!(
                    "{}{own}; its axis from tip to holder is {axis} of its frame",
                    words(name, pose)
                ),
            ))
        }
    }
}

/// Message for a tool that is stated nowhere, with the remedy.
fn not_stated(name: &str) -> String {
    let of_controller = match name.contains("_DATA[") {
        true => {
            format!("lay the controller's {KRL_CONFIG}, which states it, beside the program, or ")
        }
        false => String::new(),
    };
    format!(
        "the program does not say what its tool `{name}` is: {of_controller}state it as  frames.\"{name}\" = {{ position_mm = [...] }}  under [robot] in the job file"
    )
}

/// The tools of a program that uses several, by number, where it says what they are; none where the job's `[[tools]]` do.
pub(crate) fn tools_of_robot(
    frames: &RobotFrames,
    mechanism: &Mechanism,
    load: ProgramLoad,
    described: &mut String,
    given: &mut Vec<ToolGiven>,
) -> Answer<Vec<(u32, Mechanism, ProgramLoad)>> {
    if frames.tools.len() < 2 {
        return Ok(Vec::new());
    }
    given.clear();
    let (mut tools, mut all) = (Vec::new(), Vec::new());
    for (number, name, pose) in &frames.tools {
        let Some(pose) = pose else {
            return Err(ErrorCode::Missing.failure(not_stated(name)));
        };
        all.push(words(name, pose));
        given.push(ToolGiven {
            number: Some(*number),
            pose: *pose,
            stated: true,
        });
        tools.push((*number, mechanism.with_tool(pose), load));
    }
    *described = all.join("; ");
    Ok(tools)
}

/// The tools of a job under `[[tools]]`, each with its load, as a program that was converted takes them: by its own numbers, told
/// apart by where their tips are. A tool that the job does not name has the load of all.
pub(crate) fn tools_of_converted(
    frames: &RobotFrames,
    mechanism: &Mechanism,
    load: ProgramLoad,
    of_job: &[(u32, Mechanism, ProgramLoad)],
    given: &mut Vec<ToolGiven>,
) -> Answer<Vec<(u32, Mechanism, ProgramLoad)>> {
    let known = std::mem::take(given);
    let mut tools = Vec::new();
    for (number, _, pose) in &frames.tools {
        let Some(pose) = pose else { continue };
        let same = known
            .iter()
            .zip(of_job)
            .filter(|(given, _)| !differ(&given.pose, pose));
        let same: Vec<&(u32, Mechanism, ProgramLoad)> = same.map(|(_, tool)| tool).collect();
        if let [first, others @ ..] = same.as_slice()
            && let Some(other) = others.iter().find(|other| other.2 != first.2)
        {
            return Err(ErrorCode::Conflict.failure(format!(
                    "the tools {} and {} under [[tools]] have the tip at one place and other loads, and a program of a robot knows its tools by where their tips are: state one load for both under [load], or compensate the parts of the program one by one",
                    first.0, other.0
                ),
            ));
        }
        given.push(ToolGiven {
            number: Some(*number),
            pose: *pose,
            stated: true,
        });
        let own = same.first().map_or(load, |tool| tool.2);
        tools.push((*number, mechanism.with_tool(pose), own));
    }
    Ok(tools)
}

/// Placement of the path in the base.
pub(crate) fn placement_of_robot(
    frames: &RobotFrames,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    stated: Placement,
) -> Answer<Placement> {
    if stated.orientation_follows && frames.states_orientation {
        return Err(ErrorCode::ModelUnsuited.failure("the machine turns its tool as it moves (orientation follows), and the program states the orientation of its tool: give a program of positions",
        ));
    }
    let is_tool_stated = flags.tool_orientation.is_some()
        || job.is_some_and(|j| j.job.placement.tool_orientation.is_some());
    if is_tool_stated && frames.states_orientation && !frames.converted {
        return Err(ErrorCode::Conflict.failure("the program states the orientation of its tool: leave out tool_orientation under [placement] (--tool-orientation); to turn the tool about its axis, turn its frame under [robot.frames]",
        ));
    }
    let is_stated = flags.part_origin_mm.is_some()
        || flags.part_orientation.is_some()
        || job.is_some_and(|j| {
            j.job.placement.part_origin_mm.is_some() || j.job.placement.part_orientation.is_some()
        });
    let in_base = |base_from_part: Pose| Placement {
        base_from_part,
        ..stated
    };
    match &frames.work_object {
        None if frames.tools.is_empty() => Ok(stated),
        // Several work objects: the path is in axes of the base.
        None if is_stated => Err(ErrorCode::Conflict.failure("the program has several work objects, and says where they are: leave out part_origin_mm and part_orientation",
        )),
        None => Ok(in_base(Pose::identity())),
        Some((name, None)) if name.starts_with("MSYS") => Err(ErrorCode::Conflict.failure(format!(
                "the places of the program count from {name} in the part, and where the part is in the base is not stated so that this counts: state it as  frames.PART = {{ position_mm = [...] }}  under [robot] in the job file, and leave part_origin_mm out"
            ),
        )),
        Some((_, None)) if is_stated || !frames.states_orientation => Ok(stated),
        Some((name, None)) => Err(ErrorCode::Missing.failure(format!(
                "the program does not say where its work object `{name}` is: state it as  frames.\"{name}\" = {{ position_mm = [...] }}  under [robot] in the job file, or part_origin_mm under [placement]"
            ),
        )),
        Some((name, Some(pose))) if is_stated && differ(pose, &stated.base_from_part) => {
            Err(ErrorCode::Conflict.failure(format!(
                    "the place of the part is stated twice, and not the same: the work object `{name}` of the program lies at {} mm in the base. Leave out part_origin_mm and part_orientation, or correct one of them",
                    triple((1e3 * pose.translation.vector).into(), short)
                ),
            ))
        }
        Some((_, Some(pose))) => Ok(in_base(*pose)),
    }
}
