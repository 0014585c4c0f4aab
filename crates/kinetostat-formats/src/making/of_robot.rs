//! A program of one robot written for another.

use std::collections::BTreeMap;

use crate::making::fault::{MakeError, MakeFinding};
use crate::making::limits::MakeLanguage;
use crate::making::make::{Made, make};
use crate::making::robot_events::events_of_robot;
use crate::making::stated::{has_own_zero, is_identity};
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::model::frame::FrameUse;
use crate::model::motion::{Motion, Runs, Zone};
use crate::model::program::RobotProgram;
use crate::model::site::TargetSite;
use crate::path::of_program::RobotPath;
use crate::path::tools::tool_number;

/// A robot's program in another language, with its work object and its tools where the template states none.
///
/// ```
/// use kinetostat_formats::*;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveJ [[0,0,50],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v500,z10,tool0;\n\
///     MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     ENDPROC\nENDMODULE\n";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let robot = path_of(&program, &PathOptions::default()).unwrap();
/// let made = make_of_robot(&program, &robot, &Template::default(), MakeLanguage::Krl).unwrap();
/// let text = String::from_utf8(made.files[0].1.clone()).unwrap();
/// assert!(text.contains("$VEL.CP=0.02\nLIN {X 0.000000,Y 0.000000,Z 0.000000,A 0.00000000,B 0.00000000,C 180.00000000}\n"));
/// ```
///
/// # Errors
/// Those of [`make`]; and motions in loops and branches, which run not once.
pub fn make_of_robot(
    program: &RobotProgram,
    robot: &RobotPath,
    template: &Template,
    language: MakeLanguage,
) -> Result<Made, Vec<MakeError>> {
    let faults = not_once(program);
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut template = template.clone();
    let given = template.base.clone();
    if let Some(base) = base_of_robot(program, robot) {
        template.base = base;
    } else if let (true, Some(frame)) = (given == StatedFrame::default(), &robot.work_object) {
        template.base = stated(frame, None, language);
    }
    if template.tools.is_empty() && template.tool == StatedTool::default() {
        match robot.tools.as_slice() {
            [only] => template.tool.frame = stated(only, None, language),
            all => template.tools = tools(all, language),
        }
    }
    let mut made = make(&robot.path, &events_of_robot(program), &template, language)?;
    if given != StatedFrame::default() && given.pose != template.base.pose {
        made.findings.push(MakeFinding::of(
            None,
            "the places of the source are those in the robot's base (joint values, or several work objects), and are written so: the base of the template is not used",
        ));
    }
    if matches!(
        language,
        MakeLanguage::Krl | MakeLanguage::Rapid | MakeLanguage::FanucLs
    ) {
        made.findings.extend(zones(program));
    }
    Ok(made)
}

/// The robot's base as the frame of a made program, where the path is in its axes: of joint values, and of several work objects.
///
/// ```
/// use kinetostat_formats::*;
///
/// let text = "MODULE M\nPROC main()\n\
///     MoveL [[0,0,0],[0,1,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,fine,tool0;\n\
///     ENDPROC\nENDMODULE\n";
/// let program = read_rapid(vec![SourceFile::new("m.mod", text)], &ReadOptions::default()).unwrap();
/// let robot = path_of(&program, &PathOptions::default()).unwrap();
/// assert!(base_of_robot(&program, &robot).is_none());
/// ```
#[must_use]
pub fn base_of_robot(program: &RobotProgram, robot: &RobotPath) -> Option<StatedFrame> {
    let of_joints = |motion: &Motion| matches!(motion.site.target, TargetSite::Joints(_));
    let is_in_base = robot.work_object.is_none() || program.motions.iter().any(of_joints);
    is_in_base.then(|| StatedFrame {
        number: Some(0),
        pose: Some(nalgebra::Isometry3::identity()),
        ..StatedFrame::default()
    })
}

/// What becomes of exact stops and zones of the source.
fn zones(program: &RobotProgram) -> Option<MakeFinding> {
    let stops = |motion: &&Motion| motion.zone == Zone::Exact;
    let first = program.motions.iter().find(stops)?;
    let count = program.motions.iter().filter(stops).count();
    Some(MakeFinding::of(
        first.line,
        format!(
            "the zones of the source are not kept, here first: {} at their end there; here corners are those of the template ([zones]; feeds_mm = 0 stops at each)",
            match count {
                1 => "1 motion stops".to_owned(),
                n => format!("{n} motions stop"),
            }
        ),
    ))
}

/// Motions that do not run exactly once.
fn not_once(program: &RobotProgram) -> Vec<MakeError> {
    let others = program
        .motions
        .iter()
        .filter(|motion| motion.runs != Runs::Once);
    others
        .map(|motion| {
            let reason = match motion.runs {
                Runs::OnCondition => "the motion is in a branch: whether it runs is not known",
                Runs::Elsewhere => "nothing in these files calls the routine of this motion",
                _ => "the motion is in a loop, or in a routine that is called more than once",
            };
            MakeError::at(
                motion.line,
                reason,
                "write its motions one after another, or take them out",
            )
        })
        .collect()
}

/// Several tools by their numbers in the source.
fn tools(all: &[FrameUse], language: MakeLanguage) -> BTreeMap<u32, StatedTool> {
    let numbers: Vec<u32> = (0..all.len())
        .map(|index| tool_number(all, index))
        .collect();
    let free = numbers
        .iter()
        .max()
        .map_or(1, |number| number.saturating_add(1));
    let tool = |(frame, number): (&FrameUse, u32)| {
        let mut tool = StatedTool {
            frame: stated(frame, Some(number), language),
            ..StatedTool::default()
        };
        // Another tool than the flange cannot have its number.
        tool.frame.number = tool.frame.number.or((number == 0).then_some(free));
        (number, tool)
    };
    all.iter().zip(numbers).map(tool).collect()
}

/// A frame of the source by its pose, its number, and its name where the language has names.
fn stated(frame: &FrameUse, number: Option<u32>, language: MakeLanguage) -> StatedFrame {
    let own = frame.name.as_str();
    let is_name = own.starts_with(|c: char| c.is_ascii_alphabetic())
        && own.len() <= 32
        && own.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    // The names of what a controller holds by itself are declared by none.
    let is_system = own.eq_ignore_ascii_case("tool0") || own.eq_ignore_ascii_case("wobj0");
    // What the controller has under 0 nobody sets, and it needs no other number: $NULLFRAME, wobj0.
    let is_zero = has_own_zero(language) && frame.known().is_some_and(is_identity);
    let is_named = language == MakeLanguage::Rapid && is_name && !is_system;
    StatedFrame {
        number: number
            .or(number_in(own))
            .filter(|number| *number <= 255 && (*number > 0 || !has_own_zero(language) || is_zero))
            .or(is_zero.then_some(0)),
        name: is_named.then(|| own.to_owned()),
        pose: frame.known().copied(),
    }
}

/// The number in a name: `UF:3`, `BASE_DATA[3]`, `wobj3`.
fn number_in(name: &str) -> Option<u32> {
    let digits = name.trim_end_matches(']');
    let start = digits
        .rfind(|c: char| !c.is_ascii_digit())
        .map_or(0, |at| at + 1);
    digits[start..].parse().ok()
}
