//! Tool and placement of a run over a robot's program: of the program where it states them, else of the job.

use kinetostat::Pose;
use kinetostat_machining::Placement;

use crate::job::arguments::ProgramArgs;
use crate::job::job_file::JobFile;
use crate::job::robot::frames::RobotFrames;
use crate::ui::failure::{Answer, Failure};
use crate::ui::numbers::{short, triple};

/// Differences below this are those of digits, m and rad.
const SAME: f64 = 1e-6;

fn differ(a: &Pose, b: &Pose) -> bool {
    (a.translation.vector - b.translation.vector).norm() > SAME
        || a.rotation.angle_to(&b.rotation) > SAME
}

fn words(name: &str, pose: &Pose) -> String {
    let tip = triple((1e3 * pose.translation.vector).into(), short);
    let turned = pose.rotation.angle().to_degrees();
    match turned < 1e-6 {
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
    (stated, stated_words): (Pose, String),
) -> Answer<(Pose, String)> {
    if job.is_some_and(|j| !j.job.tools.is_empty()) {
        return Err(Failure::input(
            "[[tools]] are tools by their number in G-code; a robot's program names its own: give [tool], or frames under [robot]",
        ));
    }
    let is_stated = flags.tool_length_mm.is_some()
        || job.is_some_and(|j| j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some());
    match &frames.tool {
        None => Ok((stated, stated_words)),
        Some((_, None)) if is_stated => Ok((stated, stated_words)),
        Some((name, None)) => Err(Failure::input(format!(
            "the program does not say what its tool `{name}` is: state it as  frames.{name} = {{ position_mm = [...] }}  under [robot] in the job file, or under [tool]"
        ))),
        Some((name, Some(pose))) if is_stated && differ(pose, &stated) => {
            Err(Failure::input(format!(
                "the tool is stated twice, and not the same: {} by the program; {stated_words}, by the job. Leave out [tool] (or --tool-length-mm), or correct one of them",
                words(name, pose)
            )))
        }
        Some((name, Some(pose))) => Ok((*pose, words(name, pose))),
    }
}

/// Where the path lies in the base.
pub(crate) fn placement_of_robot(
    frames: &RobotFrames,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    stated: Placement,
) -> Answer<Placement> {
    if stated.orientation_follows {
        return Err(Failure::input(
            "the machine turns its tool as it moves (orientation follows), and the program states the orientation of its tool: give a program of positions",
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
        // Several work objects: the path is in axes of the base.
        None if is_stated => Err(Failure::input(
            "the program has several work objects, and says where they are: leave out part_origin_mm and part_orientation",
        )),
        None => Ok(in_base(Pose::identity())),
        Some((_, None)) if is_stated => Ok(stated),
        Some((name, None)) => Err(Failure::input(format!(
            "the program does not say where its work object `{name}` is: state it as  frames.{name} = {{ position_mm = [...] }}  under [robot] in the job file, or part_origin_mm under [placement]"
        ))),
        Some((name, Some(pose))) if is_stated && differ(pose, &stated.base_from_part) => {
            Err(Failure::input(format!(
                "the place of the part is stated twice, and not the same: the work object `{name}` of the program lies at {} mm in the base. Leave out part_origin_mm and part_orientation, or correct one of them",
                triple((1e3 * pose.translation.vector).into(), short)
            )))
        }
        Some((_, Some(pose))) => Ok(in_base(*pose)),
    }
}
