//! A program in the language of a robot, verified against an original in G-code that the job has it made from.
//!
//! Both are read with the same job: each takes the keys and options of its language, the template of the job says how
//! the program was made, and its frames are compared with the machine of the run.

use std::path::Path;

use kinetostat::Pose;
use kinetostat_formats::{Language, Template, language_of};
use kinetostat_program::{Path as ToolPath, SpindleRotation};
use nalgebra::Vector3;

use crate::convert::completed::{complete, up};
use crate::convert::for_run::{Stated, settings_of_made};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, ReadingArgs};
use crate::job::job_file::JobFile;
use crate::job::machine::MachineSetup;
use crate::job::program::ReadProgram;
use crate::job::robot::read_once::Reading;
use crate::job::robot_table::RobotTable;
use crate::job::setting::Setting;
use crate::job::template_file::TemplateFile;
use crate::program::summary::SPINDLE_NOT_STARTED;
use crate::ui::failure::Answer;
use crate::ui::numbers::{short, triple};
use crate::verify::other_word::{FaultKind, OtherWord};

/// Frames nearer to each other are one: more digits than controllers write, mm and deg.
const SAME_MM: f64 = 1e-3;
const SAME_DEG: f64 = 0.02;

/// Largest turn of the tool by a correction of its orientation, deg.
const CORRECTED_DEG: f64 = 2.0;

/// The word of a spindle that the program does not start.
pub(crate) const SPINDLE: &str = "spindle";

/// The language of a program of a robot or a control; none of G-code, and of a file that cannot be read.
pub(crate) fn language(files: &InputFiles, path: &Path) -> Option<Language> {
    let bytes = files.bytes("program", path).ok()?;
    language_of(&path.file_name()?.to_string_lossy(), &bytes)
}

/// Keys and options of one of two languages: those that are for the other one alone are left out.
pub(crate) fn fitting(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    is_gcode: bool,
) -> (Option<JobFile>, ProgramArgs) {
    let (mut job, mut flags) = (job.cloned(), flags.clone());
    if is_gcode {
        flags.robot.rapid_from_mm_per_s = None;
        flags.robot.tool_axis = None;
        flags.robot.joint_rows = None;
        flags.robot.stated = Default::default();
        job.iter_mut().for_each(|j| j.job.calls.clear());
        if let Some(table) = job.as_mut().and_then(|j| j.job.robot.as_mut()) {
            let table = table.get_mut();
            *table = RobotTable {
                correct: table.correct,
                free_turn: table.free_turn,
                to: table.to.take(),
                template: table.template.take(),
                ..RobotTable::default()
            };
        }
    } else {
        flags.reading = ReadingArgs::default();
        flags.expansion = Default::default();
        if let Some(job) = &mut job {
            job.job.reading = Default::default();
            job.job.expand = None;
        }
    }
    (job, flags)
}

/// The template that the job's program is made for, completed with the machine of the job.
pub(crate) fn template(
    files: &InputFiles,
    job: Option<&JobFile>,
    machine: &MachineSetup,
) -> Answer<Option<Template>> {
    let table = job.and_then(|j| j.job.robot.as_ref());
    let is_made = table.is_some_and(|table| table.get_ref().to.is_some());
    let path = TemplateFile::path(job, None);
    let mut template = match path {
        Some(path) => TemplateFile::of_file(files, &path)?.template,
        None if is_made => Template::default(),
        None => return Ok(None),
    };
    complete(&mut template, job, machine);
    Ok(Some(template))
}

/// Reads the program as one that was made for a template.
pub(crate) fn read_as_made(
    setting: &mut Setting,
    flags: &ProgramArgs,
    template: &Template,
    original: &ReadProgram<'_>,
) -> Answer<()> {
    let correct = setting.correct_converted.directions();
    let Some(source) = setting.robot.as_mut() else {
        return Ok(());
    };
    let mut of_made = settings_of_made(flags, template, source.language, up(template))?;
    of_made.corrected = correct;
    if let Some(file) = source.files.first() {
        let stated = Stated::of(original, template);
        stated.put_into(&mut of_made.reading.frames, source.language, file)?;
    }
    source.settings = of_made;
    source.reading = Reading::new();
    Ok(())
}

/// Frames, orientation of the tool and spindle of the program, beside the job of its original.
pub(crate) fn words_of_cell(
    machine: &MachineSetup,
    verified: &Setting,
    original: &ToolPath,
    own: &ReadProgram<'_>,
    template: Option<&Template>,
) -> Answer<Vec<OtherWord>> {
    let mut found = Vec::new();
    let frames = verified.robot_frames()?;
    let placement = &machine.placement;
    if let Some((name, Some(pose))) = frames.as_ref().and_then(|f| f.work_object.as_ref())
        && apart(pose, &placement.base_from_part)
    {
        found.push(other_frame(
            FaultKind::Frame,
            name,
            pose,
            "the part of the job",
        ));
    }
    let known = |pose: &Pose| machine.bounds.tools.iter().any(|of| !apart(pose, &of.pose));
    let tools = frames.iter().flat_map(|frames| &frames.tools);
    found.extend(tools.filter_map(|(_, name, pose)| {
        let pose = pose.as_ref().filter(|pose| !known(pose))?;
        Some(other_frame(
            FaultKind::Tool,
            name,
            pose,
            "the tool of the job",
        ))
    }));
    if !placement.orientation_follows {
        found.extend(leaning(machine, own));
    }
    if own
        .robot()
        .is_some_and(|robot| robot.program.language.states_turn())
    {
        found.extend(spindle_of_cell(template, verified, original));
    }
    Ok(found)
}

/// The first motion with the axis of the tool elsewhere than in the job.
fn leaning(machine: &MachineSetup, own: &ReadProgram<'_>) -> Option<OtherWord> {
    let placement = &machine.placement;
    let axis = own.path().tool_axis;
    let most = match own.corrected().len() {
        3 => SAME_DEG,
        _ => CORRECTED_DEG,
    };
    let stated = own.path().moves.iter().filter(|m| m.tool_turn.is_some());
    let (line, deg) = stated
        .map(|motion| {
            let stands = placement.orientation_on(motion, 1.0);
            let angle = (stands * axis).angle(&(placement.tool_orientation * axis));
            (motion.line, angle.to_degrees())
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    (deg.is_nan() || deg > most).then(|| {
        let text = format!(
            "the axis of the tool lies {} deg from that of the job at line {line}",
            short(deg)
        );
        OtherWord::new(
            "orientation",
            Some(FaultKind::Tool),
            [Some(line), None],
            text,
        )
    })
}

/// The first speed or direction of the spindle at a cut of the original for which the program has no statement of the cell.
fn spindle_of_cell(
    template: Option<&Template>,
    verified: &Setting,
    original: &ToolPath,
) -> Option<OtherWord> {
    let program = String::from_utf8_lossy(&verified.program);
    let cuts = original.moves.iter().filter(|m| m.is_known_feed());
    let mut states: Vec<_> = cuts
        .map(|m| (m.line, original.spindle_on(m.line)))
        .collect();
    states.dedup_by_key(|(_, spindle)| *spindle);
    states.retain(|(_, spindle)| spindle.rotation != SpindleRotation::Stopped);
    states.into_iter().find_map(|(line, spindle)| {
        let lines = [None, Some(line)];
        let statements = template.map(|template| &template.spindle);
        let Some(all) = statements.and_then(|all| all.lines(spindle.rotation, spindle.speed)) else {
            let text = format!(
                "{SPINDLE_NOT_STARTED}: the original cuts with a spindle that turns (line {line} there), and no statement of this program is known to start it; state the cell's statements under [spindle] in the template"
            );
            return Some(OtherWord::new(SPINDLE, None, lines, text));
        };
        let said = all.into_iter().find(|said| !program.contains(said.trim()))?;
        let text = format!(
            "`{said}`, by which the template has the spindle turn as at line {line} of the original, stands nowhere in this program"
        );
        let fault = Some(FaultKind::Spindle);
        Some(OtherWord::new("spindle of the cell", fault, lines, text))
    })
}

fn apart(a: &Pose, b: &Pose) -> bool {
    1e3 * (a.translation.vector - b.translation.vector).norm() > SAME_MM
        || a.rotation.angle_to(&b.rotation).to_degrees() > SAME_DEG
}

fn other_frame(fault: FaultKind, name: &str, pose: &Pose, of_job: &str) -> OtherWord {
    let mm: Vector3<f64> = 1e3 * pose.translation.vector;
    let text = format!(
        "'{name}' of the program at {} mm is not {of_job}",
        triple(mm.into(), short)
    );
    OtherWord::new(name, Some(fault), [None, None], text)
}
