//! A program of one robot written for another.

use crate::making::limits::MakeLanguage;
use crate::making::make::{Made, make_along};
use crate::making::of_tools::{faults_at, stated, tools_of_source};
use crate::making::otherwise::{
    arcs_from_elsewhere, dynamics, not_once, other_speeds, turning_speeds,
};
use crate::making::robot_course::course_of;
use crate::making::stated::{is_identity, of_frame};
use crate::making::template::{StatedFrame, StatedTool, Template};
use crate::making::{MakeError, MakeFinding, configurations, reconfigured};
use crate::model::Language;
use crate::model::motion::{Frame, FrameUse, Motion, Zone};
use crate::model::program::{RobotProgram, by_name};
use crate::model::site::TargetSite;
use crate::path::axis_turns::at_z;
use crate::path::of_program::RobotPath;
use crate::path::tools::same_frame;
use crate::rapid::literals::object_frames;
use crate::text::Name;

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
/// Those of [`crate::make`]; motions in loops and branches and behind what may end the program, which run not once; tools and work objects of
/// which the run alone knows which they are.
pub fn make_of_robot(
    program: &RobotProgram,
    robot: &RobotPath,
    template: &Template,
    language: MakeLanguage,
) -> Result<Made, Vec<MakeError>> {
    make_of_flat_robot(program, robot, template, language, |_| None)
}

/// Makes a program of an expanded program; `place` names the original place of a line (`'hole.mpf', line 12`), for the notes.
///
/// # Errors
/// Those of [`make_of_robot`].
pub fn make_of_flat_robot(
    program: &RobotProgram,
    robot: &RobotPath,
    template: &Template,
    language: MakeLanguage,
    place: impl Fn(usize) -> Option<String>,
) -> Result<Made, Vec<MakeError>> {
    let mut faults = not_once(program);
    faults.extend(arcs_from_elsewhere(program, robot));
    faults.extend(computed_frames(program, template));
    if !faults.is_empty() {
        return Err(faults);
    }
    let mut template = template.clone();
    let given = template.base.clone();
    if let Some(base) = base_of_robot(program, robot) {
        template.base = base;
    } else if let (true, Some(frame)) = (given == StatedFrame::default(), &robot.work_object) {
        template.base = stated(frame, None, language);
        if (program.language, language) == (Language::Rapid, MakeLanguage::Rapid) {
            let name = Name::of(frame.name.as_bytes());
            let both = name.and_then(|name| object_frames(&program.files).get(&name).copied());
            // A pose that the caller states has priority.
            let both = both.filter(|[user, object]| frame.known() == Some(&(user * object)));
            template.base.object_frame = both.map(|[_, object]| object);
        }
    }
    if let (true, Some(frame)) = (given == StatedFrame::default(), &robot.work_object) {
        let uses = |motion: &Motion| same_frame(&motion.work_object, frame);
        faults.extend(faults_at(
            program,
            uses,
            of_frame(&template.base, "base", language),
        ));
    }
    let mut named = Vec::new();
    if template.tools.is_empty() && template.tool == StatedTool::default() {
        let made = tools_of_source(program, robot, language);
        (template.tool, template.tools) = (made.tool, made.tools);
        named = made.findings;
        faults.extend(made.faults);
    } else if template.tools.is_empty() && robot.tools.len() == 1 {
        let source = tools_of_source(program, robot, language).tool;
        named.extend(completed(&mut template.tool, source));
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if let (true, Some(frame)) = (given == StatedFrame::default(), &robot.work_object) {
        named.extend(base_by_number(program, frame, &template.base, language));
    }
    let moved = moved_frames(robot, [&given, &template.tool.frame]);
    let mut course = course_of(program, robot);
    course.show_places(place);
    course.configurations = configurations::kept(program, robot, language);
    if template.configuration.is_some() {
        // The template's configuration has priority, and the source's later ones would not be consistent with it.
        course.configurations.clear();
    }
    course.other_speeds = other_speeds(program, robot, language);
    let mut made = make_along(&robot.path, &course, &template, language)?;
    // Explicit findings precede assumptions.
    made.findings.splice(0..0, named);
    made.findings
        .sort_by_key(|finding| finding.line.unwrap_or(usize::MAX));
    if robot.work_object.is_none() && given == StatedFrame::default() {
        made.findings.push(MakeFinding::of(
            None,
            "the program has several work objects: the places are those in the robot's base, and are written so",
        ));
    }
    made.findings.extend(orientation_not_used(robot, &template));
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
    if language == MakeLanguage::Csv {
        made.findings
            .extend(robot.work_object.as_ref().and_then(unnamed_frame));
    }
    made.findings.extend(outside_calls(program, robot.file));
    made.findings.extend(external_axes(program));
    made.findings.extend(dynamics(program, robot.file));
    made.findings.extend(turning_speeds(program, language));
    let is_kept = made.states_configuration && template.configuration.is_none();
    made.findings.extend(moved.filter(|_| is_kept));
    let keeps =
        configurations::is_same(program.language, language) && template.configuration.is_none();
    let stated = template.configuration.as_deref();
    made.findings.extend(reconfigured::findings(
        program, robot, keeps, stated, language,
    ));
    made.findings
        .extend(lost_configurations(program, &template, language));
    Ok(made)
}

/// Orientations nearer to one another are one, rad.
const SAME_TURN_RAD: f64 = 1e-6;

/// Finding on a template orientation that differs from that of a source which states the tool axis.
fn orientation_not_used(robot: &RobotPath, template: &Template) -> Option<MakeFinding> {
    let stated = template.tool_orientation.filter(|_| robot.axis_alone)?;
    let same = stated.angle_to(&at_z(robot.path.tool_axis)) < SAME_TURN_RAD;
    (!same).then(|| {
        MakeFinding::of(
            None,
            "tool_orientation of the template is not used: the program says along which axis the tool lies (z of its work object where it states none), and turn_about_axis how it is turned about it",
        )
    })
}

/// A tool of the template with what the source says of it and the template does not.
fn completed(stated: &mut StatedTool, source: StatedTool) -> Option<MakeFinding> {
    if stated.frame == StatedFrame::default() {
        stated.frame = source.frame;
    }
    let mass = source.mass_kg.filter(|_| stated.mass_kg.is_none())?;
    stated.mass_kg = Some(mass);
    stated.centre_of_mass_mm = stated.centre_of_mass_mm.or(source.centre_of_mass_mm);
    stated.axes_of_moment = source.axes_of_moment;
    stated.inertia_kg_m2 = source.inertia_kg_m2;
    Some(MakeFinding::of(
        None,
        format!(
            "the template does not state the mass of the tool: {mass} kg and what else of its load is not stated are those of the source"
        ),
    ))
}

/// Finding on a different arm posture at the poses of the source, since base or tool of the template differ.
fn moved_frames(robot: &RobotPath, [base, tool]: [&StatedFrame; 2]) -> Option<MakeFinding> {
    let is_other = |stated: &StatedFrame, of_source: Option<&FrameUse>| {
        let own = of_source.and_then(FrameUse::known);
        let both = own.zip(stated.pose.as_ref());
        both.is_some_and(|(own, pose)| !is_identity(&(own.inverse() * pose)))
    };
    let own_tool = robot.tools.first().filter(|_| robot.tools.len() == 1);
    let base = is_other(base, robot.work_object.as_ref());
    // Several tools of the template have no others to be compared with.
    let tool = is_other(tool, own_tool);
    (base || tool).then(|| {
        MakeFinding::of(
            None,
            format!(
                "the configurations are those of the source, and the {} of the template stands elsewhere than there: check whether the arm reaches the poses so",
                match (base, tool) {
                    (true, true) => "base with the tool",
                    (true, false) => "base",
                    (false, _) => "tool",
                }
            ),
        )
    })
}

/// Finding on configurations that the source states.
fn lost_configurations(
    program: &RobotProgram,
    template: &Template,
    language: MakeLanguage,
) -> Option<MakeFinding> {
    let is_same = configurations::is_same(program.language, language);
    match (is_same, &template.configuration) {
        (true, None) => None,
        (true, Some(stated)) => configurations::lost(
            program,
            &format!("the template states `{stated}` (configuration)"),
        ),
        (false, stated) => {
            let why = configurations::why_lost(language, stated.as_deref());
            configurations::lost(program, &why)
        }
    }
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

/// The work object in whose axes the places of a table are.
fn unnamed_frame(frame: &FrameUse) -> Option<MakeFinding> {
    // Default name of tables and machines without a work object.
    let is_named = !["part", "PART"].contains(&frame.name.as_str());
    is_named.then(|| {
        MakeFinding::of(
            None,
            format!(
                "the places are in axes of the work object `{}` of the source, which the table does not name",
                frame.name
            ),
        )
    })
}

/// Finding on exact stops and zones of the source.
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

/// A work object of the source without a number that has one here.
fn base_by_number(
    program: &RobotProgram,
    frame: &FrameUse,
    base: &StatedFrame,
    language: MakeLanguage,
) -> Option<MakeFinding> {
    let written = match language {
        MakeLanguage::FanucLs => "UFRAME_NUM=",
        MakeLanguage::Krl if base.pose.is_none() => "BASE_DATA ",
        _ => return None,
    };
    // The part of APT and of tables is that of the template.
    (program.language.is_of_robot() && base.number.is_none()).then(|| {
        MakeFinding::of(
            program.motions.first().map(|motion| motion.line),
            format!(
                "the work object `{}` of the source has no number: it is {written}1 here",
                frame.name
            ),
        )
    })
}

/// Each, by the line of its first motion, where the template does not say what it is.
fn computed_frames(program: &RobotProgram, template: &Template) -> Vec<MakeError> {
    let of_source = [
        template.tool == StatedTool::default() && template.tools.is_empty(),
        template.base == StatedFrame::default(),
    ];
    let mut named: Vec<&str> = Vec::new();
    let mut faults = Vec::new();
    for motion in &program.motions {
        let uses = [
            ("tool", "[tool]", &motion.tool),
            ("work object", "[base]", &motion.work_object),
        ];
        for ((what, key, used), _) in uses.into_iter().zip(of_source).filter(|(_, own)| *own) {
            let Frame::Unknown { reason } = &used.frame else {
                continue;
            };
            if !is_computed(program.language, used) || named.contains(&used.name.as_str()) {
                continue;
            }
            named.push(&used.name);
            faults.push(MakeError::at(
                motion.line,
                format!("which {what} `{}` is, is not known: {reason}", used.name),
                format!("write its number, or state it in the template under {key}"),
            ));
        }
    }
    faults
}

/// An element of an array whose index is no number, or the value of an expression or of a variable.
fn is_computed(language: Language, used: &FrameUse) -> bool {
    let name = used.name.as_str();
    let Some((_, inside)) = name.split_once(['[', '{', '(']) else {
        // Without an assignment to $TOOL and $BASE, the controller's frames are valid.
        return language.numbers_frames() && !name.starts_with('$');
    };
    let index = inside.trim_end_matches([']', '}', ')']);
    index.trim().parse::<u32>().is_err()
}

/// Findings on external axes that are not at 0 throughout: first position, and motion.
fn external_axes(program: &RobotProgram) -> Vec<MakeFinding> {
    let all = || program.motions.iter().map(|motion| &motion.site.external);
    let count = all().map(Vec::len).max().unwrap_or_default();
    let mut found = Vec::new();
    for axis in 0..count {
        let at = |values: &Vec<Option<f64>>| values.get(axis).copied().flatten();
        let Some(first) = program
            .motions
            .iter()
            .find(|motion| at(&motion.site.external).is_some_and(|value| value != 0.0))
        else {
            continue;
        };
        let value = at(&first.site.external).unwrap_or_default();
        let mut before = program
            .motions
            .iter()
            .take_while(|motion| motion.line != first.line);
        let is_open =
            |motion: &Motion| motion.target.pose().is_some() && at(&motion.site.external).is_none();
        let moves = all().filter_map(at).any(|other| other != value) || before.any(is_open);
        let name = program.language.name_of_external_axis(axis);
        found.push(MakeFinding::of(
            Some(first.line),
            match moves {
                true => format!("{name} moves along the source: the made program does not state it, and leaves it where it is"),
                false => format!("{name} stands at {value} in the source: the made program does not state it; bring it there before it runs"),
            },
        ));
    }
    found
}

/// Each name once, with its lines.
fn outside_calls(program: &RobotProgram, file: usize) -> Vec<MakeFinding> {
    let all = by_name(&program.outside_calls).into_iter().map(|of| {
        let message = of.message(program.language, Some("it is a note here"));
        let other = program.files.get(of.file).filter(|_| of.file != file);
        match other {
            Some(other) => {
                let place = format!("'{}', line {}", other.name(), of.line());
                MakeFinding::of(None, format!("{place}: {message}"))
            }
            None => MakeFinding::of(of.line(), message),
        }
    });
    all.collect()
}
