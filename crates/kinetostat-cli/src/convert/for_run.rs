//! A program in another language before it is compensated: made in memory, so that the run goes over it.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    FrameUse, Language, Made, MakeLanguage, Motion, SourceFile, Template, read,
};
use kinetostat_machining::{FlatProgram, ForceAlongPath, Unwatched, Warning, WarningCode};
use kinetostat_model::Model;
use nalgebra::{Isometry3, Vector3};

use crate::convert::completed::{complete, refuse_leaning_tool, up};
use crate::convert::free_turn::{base_of_source, free_turn};
use crate::convert::made::{made, spindle_text};
use crate::convert::plausible::refuse_implausible;
use crate::convert::targets::{Named, in_language};
use crate::files::input_files::InputFiles;
use crate::files::origin;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::along::{refuse_what_breaks_the_tool, warnings_of_moves};
use crate::job::free_turn::FreeTurn;
use crate::job::job_file::JobFile;
use crate::job::machine::{MachineSetup, machine_setup};
use crate::job::of_model::give_of_model;
use crate::job::program::{ReadProgram, read_program};
use crate::job::robot::divided::Divided;
use crate::job::robot::read_once::Reading;
use crate::job::robot::settings::{MadeArm, RobotSettings, settings};
use crate::job::robot::source::RobotSource;
use crate::job::robot_arguments::{RobotArgs, StatedArgs};
use crate::job::setting::{Setting, setting};
use crate::job::target_word::RobotWord;
use crate::job::template_file::{TemplateAsked, TemplateFile};
use crate::job::turn_arguments::FreeTurnWord;
use crate::program::solve::forces_of;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// Upper limit of the points of an undivided program: numbers of positions in a TP program have 16 bits.
const MOST_POINTS: usize = 1_000_000;
const MOST_POINTS_OF_LS: usize = 32_766;

/// A run over a program that was converted.
pub(crate) struct Converted {
    pub(crate) setting: Setting,
    /// The turn of the tool, where it was chosen.
    pub(crate) turn: Option<FreeTurn>,
    /// Differences from the source, and assumptions.
    pub(crate) findings: Vec<Warning>,
}

/// Program to be converted, with the machine that it is written for.
pub(crate) struct Source<'a> {
    pub(crate) setting: Setting,
    pub(crate) model: &'a Model,
    pub(crate) machine: &'a MachineSetup,
}

/// The run over the program in another language.
fn for_run(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    source: Source<'_>,
    mut template: TemplateFile,
    word: RobotWord,
) -> Answer<Converted> {
    let Source {
        mut setting,
        model,
        machine,
    } = source;
    let (of_robot, language) = (word.of_robot(), word.language());
    if machine.placement.scale != 1.0 {
        return Err(ErrorCode::Unused.failure("the scale of the program is not 1: a robot's program is in the robot's own millimetres; leave the scale out (--scale, scale under [placement])",
        ));
    }
    let read = read_program(&setting)?;
    let states_orientation = (read.path().moves.iter()).any(|motion| motion.tool_turn.is_some());
    if states_orientation && job.is_some_and(|j| !j.job.tools.is_empty()) {
        return Err(ErrorCode::Conflict.failure("the program says itself which tools it takes and where their tips are: leave out [[tools]] in the job file (a load for all of them stands under [load])",
        ));
    }
    let lies = refuse_implausible(&setting, &template, &read)?;
    if !states_orientation {
        complete(&mut template.template, job, machine);
    }
    let most = match language {
        MakeLanguage::FanucLs => MOST_POINTS_OF_LS,
        _ => MOST_POINTS,
    };
    template.template.most_points.get_or_insert(most);
    let turn = match setting.free_turn {
        FreeTurnWord::Choose | FreeTurnWord::Stiff => {
            let mut turn = free_turn(&setting, &template.template, model, &read)?;
            turn.description = in_source(&setting, &turn.description);
            Some(turn)
        }
        FreeTurnWord::AsStated => None,
    };
    refuse_fast_feeds(&setting, &read, &template.template, language)?;
    let forces = forces_of(machine, &setting, read.path(), &Unwatched)?;
    if forces.is_some() {
        refuse_leaning_tool(&template.template)?;
        refuse_what_breaks_the_tool(forces.as_ref(), &setting)?;
    }
    let made = made(&setting, &template, &read, turn.as_ref(), language)?;
    let whole = whole(&setting, &made, of_robot, language)?;
    let axis = match (read.robot(), &turn) {
        (Some(robot), None) if states_orientation => robot.path.path.tool_axis,
        _ => up(&template.template),
    };
    let mut found = settings_of_made(flags, &template.template, of_robot, axis)?;
    found.corrected = setting.correct_converted.directions();
    found.made_arm = Some(MadeArm {
        states_configuration: made.states_configuration,
        start_joints_deg: template.template.start_joints_deg.clone(),
    });
    let Whole { file, divided } = whole;
    let stated = Stated::of(&read, &template.template);
    stated.put_into(&mut found.reading.frames, of_robot, &file)?;
    let of_cut = warnings_of_moves(forces.as_ref());
    let mut findings = findings(&setting, &made);
    findings.extend(lies);
    findings.extend(
        spindle_text(&made)
            .map(|text| Warning::new(WarningCode::SpindleNotStarted, in_source(&setting, &text))),
    );
    let of_cut = of_cut
        .into_iter()
        .map(|warning| of_source(&setting, warning));
    findings.extend(of_cut);
    let flat = flat(&setting, &made, divided.as_ref(), language, &file);
    drop(read);
    let out = setting.targets.program.clone().unwrap_or_default();
    let parts = made.files.iter().skip(1);
    setting.targets.beside = parts.map(|(name, _)| out.with_file_name(name)).collect();
    setting.program = file.bytes().to_vec();
    setting.flat = Some(flat);
    setting.expansion_warnings.clear();
    setting.robot = Some(RobotSource {
        language: of_robot,
        files: vec![file],
        paths: Vec::new(),
        settings: found,
        parquet: None,
        divided,
        before: None,
        system_frames: None,
        reading: Reading::new(),
    });
    let target = setting.targets.flat.take();
    setting.write_flat_to(target);
    if let Some(forces) = forces {
        setting.forces = Some(on_motions(forces, &setting, &made)?);
    }
    Ok(Converted {
        setting,
        turn,
        findings,
    })
}

/// Reading of a program that was made for a template, whose tool lies along this axis of its frame.
pub(crate) fn settings_of_made(
    flags: &ProgramArgs,
    template: &Template,
    of_robot: Language,
    axis: Vector3<f64>,
) -> Answer<RobotSettings> {
    // Calls were refused, or are notes in the made program.
    let flags = RobotArgs {
        stated: StatedArgs::default(),
        ..flags.robot.clone()
    };
    let mut found = settings(None, &flags, of_robot, axis)?;
    found.axis_is_stated = true;
    found.making.tool_axis = axis;
    // Straight rapids have this speed, but for the last digit; APT has a word for them.
    found.making.rapid_from_mm_per_s =
        (!of_robot.has_rapid_word()).then_some(0.999_999 * template.rapid_speed_mm_per_s);
    Ok(found)
}

/// Converts the program of a job into the language that it names, for the template of options or job.
pub(crate) fn in_other_language(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    mut source: Source<'_>,
    word: RobotWord,
    named: Named<'_>,
) -> Answer<Converted> {
    let file = TemplateFile::path(job, flags.robot.template.as_deref());
    let module = TemplateFile::program_name(files, file.as_deref())?;
    let setting = &mut source.setting;
    in_language(
        &mut setting.targets,
        &setting.program_path,
        module,
        job,
        named,
        word.language(),
    )?;
    let out = setting.targets.program.clone().unwrap_or_default();
    let template = TemplateFile::read(
        files,
        &TemplateAsked {
            file: file.as_deref(),
            out: &out,
            tool_orientation: None,
            tolerance_mm: None,
        },
    )?;
    if let Some(path) = &file {
        let bytes = files.bytes("template", path)?;
        setting
            .program_files
            .push(origin::file("template", path, &bytes));
        setting.inputs.push(path.clone());
    }
    for_run(job, flags, source, template, word)
}

/// Refuses what the compensation of a job refuses of its conversion, whatever is asked of the job; warnings of the conversion.
pub(crate) fn refuse_unconvertible(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    model: &Model,
    machine: &MachineSetup,
) -> Answer<Vec<Warning>> {
    let Some(word) = job.and_then(JobFile::to) else {
        return Ok(Vec::new());
    };
    let mut flags = flags.clone();
    flags.robot.converted = true;
    let mut setting = setting(files, job, &flags, &WritingFlags::default())?;
    give_of_model(&mut setting, files, job, None, &flags)?;
    setting.turned_by(machine.rotary.clone());
    let source = Source {
        setting,
        model,
        machine,
    };
    let found = in_other_language(files, job, &flags, source, word, Named::default())?;
    let mut setting = found.setting;
    machine_of_made(files, job, None, &flags, &mut setting)?;
    Ok(found.findings)
}

/// The machine of a made program, which brings frames of its own.
pub(crate) fn machine_of_made(
    files: &InputFiles,
    job: Option<&JobFile>,
    model_named: Option<&str>,
    flags: &ProgramArgs,
    setting: &mut Setting,
) -> Answer<MachineSetup> {
    let mut frames = setting.robot_frames()?;
    if let Some(frames) = &mut frames {
        frames.converted = true;
    }
    let inputs = &mut setting.inputs;
    Ok(machine_setup(files, job, model_named, flags, frames.as_ref(), inputs)?.0)
}

/// The made program in one file.
struct Whole {
    file: SourceFile,
    /// Files of the program, if there are several.
    divided: Option<Divided>,
}

fn whole(
    setting: &Setting,
    made: &Made,
    of_robot: Language,
    language: MakeLanguage,
) -> Answer<Whole> {
    let name = setting.program_name.as_str();
    if let [(_, bytes)] = made.files.as_slice() {
        return Ok(Whole {
            file: SourceFile::new(name, bytes.as_slice()),
            divided: None,
        });
    }
    let files = made.files.iter();
    let files = files.map(|(name, bytes)| SourceFile::new(name.as_str(), bytes.as_slice()));
    let Some(divided) = Divided::of(of_robot, files.collect()) else {
        return Err(ErrorCode::ProgramUnsuited.failure(format!(
                "the program needs {} files in {}, and a run compensates one, with at most {MOST_POINTS_OF_LS} places: leave most_points out of the template where it is smaller, or divide the program and run each part by itself",
                made.files.len(),
                language.title()
            ),
        ));
    };
    let joined = divided.joined()?;
    Ok(Whole {
        file: SourceFile::new(name, joined.bytes()),
        divided: Some(divided),
    })
}

/// Forces along the source as they act along the made program; what they found is said of the source.
fn on_motions(
    mut forces: ForceAlongPath,
    setting: &Setting,
    made: &Made,
) -> Answer<ForceAlongPath> {
    forces.findings.clear();
    let read = read_program(setting)?;
    let parts = read.robot().and_then(|robot| {
        let motions = robot.path.motions.iter();
        let part = |motion: &usize| made.parts.get(*motion).copied();
        motions.map(part).collect::<Option<Vec<_>>>()
    });
    let parts = parts.filter(|parts| parts.len() == read.path().moves.len());
    let Some(parts) = parts else {
        return Err(ErrorCode::Internal.failure("the forces of the cut do not go with the motions of the made program; nothing was written, please report this",
        ));
    };
    Ok(forces.on_parts(&parts))
}

/// Speeds tell cuts from rapids in a program of a robot; APT and G-code have a word for rapids.
pub(crate) fn refuse_fast_feeds(
    setting: &Setting,
    read: &ReadProgram<'_>,
    template: &Template,
    language: MakeLanguage,
) -> Answer<()> {
    if matches!(language, MakeLanguage::Apt | MakeLanguage::Gcode) {
        return Ok(());
    }
    let rapid = template.rapid_speed_mm_per_s;
    let feeds = read
        .path()
        .moves
        .iter()
        .filter(|motion| motion.is_known_feed());
    let mut fast = feeds.filter_map(|motion| {
        let speed = motion.feed_mm_per_minute(f64::NAN)? / 60.0;
        (speed >= 0.999 * rapid).then_some((motion.line, speed))
    });
    match fast.next() {
        Some((line, speed)) => Err(setting.within(ErrorCode::Value.failure(format!(
            "line {line}: the feed, {} mm/s, is not below the speed of rapids, {} mm/s, by which a program of a robot tells cuts from rapids: write a larger rapid_speed_mm_per_s in the template",
            short(speed),
            short(rapid)
        )))),
        None => Ok(()),
    }
}

/// Poses of work object and tools, which not every language declares; mm.
pub(crate) struct Stated {
    base: Option<Isometry3<f64>>,
    /// Tools with their numbers in the made program, if stated.
    tools: Vec<(Option<u32>, Option<Isometry3<f64>>)>,
}

impl Stated {
    pub(crate) fn of(read: &ReadProgram<'_>, template: &Template) -> Self {
        let robot = read.robot().map(|robot| &robot.path);
        let of_source = |frame: &FrameUse| frame.known().copied();
        let tools: Vec<_> = match (template.tool.frame.pose, robot) {
            _ if !template.tools.is_empty() => (template.tools.iter())
                .map(|(number, tool)| (Some(tool.frame.number.unwrap_or(*number)), tool.frame.pose))
                .collect(),
            (Some(pose), _) => vec![(None, Some(pose))],
            (None, Some(robot)) => (robot.tools.iter())
                .map(|tool| (None, of_source(tool)))
                .collect(),
            (None, None) => Vec::new(),
        };
        let of_robot = || robot.and_then(|robot| robot.work_object.as_ref().and_then(of_source));
        Self {
            base: base_of_source(read)
                .or(template.base.pose)
                .or_else(of_robot),
            tools,
        }
    }

    /// Puts the frames in, under their names in the made program, if it does not define them itself.
    pub(crate) fn put_into(
        &self,
        frames: &mut std::collections::BTreeMap<String, Isometry3<f64>>,
        language: Language,
        file: &SourceFile,
    ) -> Answer<()> {
        let program = read(
            language,
            vec![file.clone()],
            &kinetostat_formats::ReadOptions::default(),
        );
        let Ok(program) = program else {
            return Ok(());
        };
        let mut names: Vec<&str> = Vec::new();
        for Motion { tool, .. } in &program.motions {
            if !names.contains(&tool.name.as_str()) {
                names.push(&tool.name);
            }
        }
        for (index, name) in names.iter().enumerate() {
            let digits = name.trim_start_matches(|c: char| !c.is_ascii_digit());
            let number = digits.trim_end_matches(']').parse().ok();
            let numbered = self
                .tools
                .iter()
                .find(|tool| tool.0.is_some() && tool.0 == number);
            let Some((_, pose)) = numbered.or_else(|| self.tools.get(index)) else {
                continue;
            };
            let is_open = (program.motions.iter())
                .any(|motion| motion.tool.name == *name && motion.tool.known().is_none());
            if let (Some(pose), true) = (pose, is_open) {
                frames.insert((*name).to_owned(), *pose);
            }
        }
        for motion in &program.motions {
            let object = &motion.work_object;
            if let (None, Some(base)) = (object.known(), self.base) {
                frames.insert(object.name.clone(), base);
            }
        }
        Ok(())
    }
}

/// A message about lines of the source, each with its file: lines of a run over a converted program are those of that one.
fn in_source(setting: &Setting, message: &str) -> String {
    if let Some(flat) = &setting.flat {
        return flat.in_sources(message);
    }
    let mut out = String::with_capacity(message.len());
    let mut rest = message;
    while let Some(at) = rest.find("line ") {
        let number = at + "line ".len();
        let digits = rest[number..]
            .bytes()
            .take_while(u8::is_ascii_digit)
            .count();
        let end = number + digits;
        out.push_str(&rest[..end]);
        rest = &rest[end..];
        if digits > 0 && !rest.starts_with(" of ") {
            out.push_str(" of ");
            out.push_str(&setting.program_name);
        }
    }
    out + rest
}

/// A warning about a line of the source, with its file; of a program that was expanded before, the line that it came from.
fn of_source(setting: &Setting, mut warning: Warning) -> Warning {
    let flat = setting.flat.as_ref();
    let found = warning.line.and_then(|line| flat?.source_of(line));
    let file = found.map_or(setting.program_name.as_str(), |(file, _)| file);
    warning.line = found.map_or(warning.line, |(_, line)| Some(line));
    warning.message = in_source(setting, &warning.message);
    warning.of_file(file.to_owned())
}

/// Warnings of the conversion, with lines of the source.
fn findings(setting: &Setting, made: &Made) -> Vec<Warning> {
    let at_line = |line: usize, text: &str| {
        of_source(setting, Warning::at_line(WarningCode::Program, line, text))
    };
    let said = made.findings.iter().map(|finding| match finding.line {
        Some(line) => at_line(line, &finding.message),
        None => Warning::new(WarningCode::Program, in_source(setting, &finding.message)),
    });
    let expanded = setting.expansion_warnings.iter();
    let expanded = expanded.map(|w| at_line(w.line, &w.text));
    said.chain(expanded).collect()
}

/// Maps lines of the made program to the source: each from that of the motion on it or after it.
fn flat(
    setting: &Setting,
    made: &Made,
    divided: Option<&Divided>,
    language: MakeLanguage,
    file: &SourceFile,
) -> FlatProgram {
    let count = file.line_count();
    let last = made.lines.last().map_or(1, |[_, source]| *source);
    let mut origins = vec![last; count];
    let mut from = 0;
    for [line, source] in &made.lines {
        let line = divided.map_or(*line, |divided| divided.line_of(*line));
        let end = line.min(count);
        if from < end {
            origins[from..end].fill(*source);
        }
        from = usize::max(from, end);
    }
    let number = |line: usize| u32::try_from(line).unwrap_or(u32::MAX);
    // A program that was expanded before keeps the lines of its files.
    let before = setting.flat.as_ref();
    let mut files = before.map_or_else(|| vec![setting.program_name.clone()], |b| b.files.clone());
    let mut sources = Vec::with_capacity(count);
    for line in origins {
        let found = before.and_then(|flat| flat.source_of(line));
        let (name, line) = found.unwrap_or((setting.program_name.as_str(), line));
        let index = files
            .iter()
            .position(|file| file == name)
            .unwrap_or_else(|| {
                files.push(name.to_owned());
                files.len() - 1
            });
        sources.push((number(index), number(line)));
    }
    let mut flat = FlatProgram::new(files, made.lines.len(), sources);
    flat.language = Some(language.title().to_owned());
    flat
}
