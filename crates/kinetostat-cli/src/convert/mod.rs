//! `kinetostat convert`: a program of one language written in another.
//!
//! It takes a program and a template of the cell ; it gives the program in another language, read again and
//! compared with the path before it is written, and says what is otherwise.

pub(crate) mod arguments;
pub(crate) mod completed;
pub(crate) mod for_run;
mod free_turn;
mod joints;
pub(crate) mod made;
pub(crate) mod plausible;
pub(crate) mod targets;

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{BetweenRows, Kept, Made, Template};
use kinetostat_machining::number::counted;
use kinetostat_machining::{Warning, WarningCode, merged};
use kinetostat_program::WarningTopic;
use kinetostat_report::turns_svg;

use crate::convert::arguments::ConvertArgs;
use crate::convert::completed::complete;
use crate::convert::for_run::refuse_fast_feeds;
use crate::convert::free_turn::free_turn;
use crate::convert::joints::{Asked, as_joints, with_all_digits};
use crate::convert::made::{made, spindle_text};
use crate::convert::plausible::refuse_implausible;
use crate::files::file_names::{file_name, stem};
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::file_endings::{Written, refuse_other_ending};
use crate::job::job_file::{JobFile, model_named};
use crate::job::limits::refuse_limits_but;
use crate::job::machine::machine_setup;
use crate::job::output_paths::FLAT_PROGRAM;
use crate::job::program::{ReadProgram, read_program};
use crate::job::robot::joint_arm::give_arm;
use crate::job::robot_arguments::RobotArgs;
use crate::job::setting::{Setting, setting};
use crate::job::target_word::TargetWord;
use crate::job::template_file::{TemplateAsked, TemplateFile};
use crate::job::turn_arguments::FreeTurnWord;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{item, wrapped};
use crate::ui::screen::{self, Stream};

pub(crate) fn run(args: &ConvertArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let used = [
        "nearest_base_mm",
        "shortest_tool_mm",
        "longest_tool_mm",
        "zone_mm",
        "speed_mm_per_s",
    ];
    let why = "a conversion knows neither loads nor corrections";
    refuse_limits_but(&used, &args.limits, why)?;
    let language = args.to.language();
    let made_program = Written {
        what: "made program",
        form: language.form(),
        source: None,
    };
    refuse_other_ending(made_program, &args.out)?;
    let mut template = TemplateFile::read(
        &files,
        &TemplateAsked {
            file: args.template.as_deref(),
            out: &args.out,
            tool_orientation: args.tool_orientation.as_deref(),
            tolerance_mm: args.tolerance_mm,
        },
    )?;
    let mut setting = setting(&files, job.as_ref(), &flags(args), &writing(args))?;
    setting.inputs.extend(args.template.iter().cloned());
    if args.stiff_turn {
        setting.free_turn = FreeTurnWord::Stiff;
    }
    let machine = match job.as_ref().filter(|job| job.job.model.is_some()) {
        Some(job) => {
            let inputs = &mut setting.inputs;
            Some(machine_setup(&files, Some(job), None, &flags(args), None, inputs)?.0)
        }
        None => None,
    };
    if let Some(machine) = &machine {
        setting.turned_by(machine.rotary.clone());
    }
    // The flat program is that of the source.
    let flat_program = Written {
        what: FLAT_PROGRAM,
        form: setting.form(),
        source: Some(&setting.program_path),
    };
    if let Some(flat) = &args.expansion.flat_program {
        refuse_other_ending(flat_program, flat)?;
    }
    let mut claimed = Outputs::new(
        Existing::forced(args.force_overwrite),
        setting.inputs.clone(),
    );
    let main = claimed.claim("made program", &args.out)?;
    let flat = args.expansion.flat_program.as_deref();
    let flat = flat.map(|path| claimed.claim(FLAT_PROGRAM, path));
    let flat = flat.transpose()?;
    let plot = args.turn_plot.as_deref();
    let plot = plot.map(|path| claimed.claim("picture of the turn", path));
    let plot = plot.transpose()?;
    with_arm(&files, job.as_ref(), args, &mut setting, &template.template)?;
    let read = read_program(&setting)?;
    let states_orientation = (read.path().moves.iter()).any(|motion| motion.tool_turn.is_some());
    if let Some(machine) = machine.filter(|_| !states_orientation) {
        complete(&mut template.template, job.as_ref(), &machine);
    }
    let lies = refuse_implausible(&setting, &template, &read)?;
    let turned = match &args.free_turn {
        Some(named) => {
            let (model, _) = files.model(named, Path::new(""))?;
            let turned = free_turn(&setting, &template.template, &model, &read)?;
            Some(turned)
        }
        None => None,
    };
    if args.to == TargetWord::Joints {
        with_all_digits(&mut template.template);
    }
    let mut made = made(&setting, &template, &read, turned.as_ref(), language)?;
    // A robot's own program may not tell cuts from rapids either.
    if read.robot().is_none() {
        refuse_fast_feeds(&setting, &read, &template.template, language)?;
    }
    let mut said: Vec<String> = lies.map(|warning| warning.message).into_iter().collect();
    if args.to == TargetWord::Joints {
        let (named, base) = model_named(job.as_ref(), args.model.as_deref())?;
        let (model, _) = files.model(&named, &base)?;
        let asked = Asked {
            model: &model,
            rows: args.joint_rows,
        };
        let text = as_joints(&setting, &template.template, &read, &asked, &mut made)?;
        said.push(text);
    }
    said.extend(turned.as_ref().map(|turned| turned.description.clone()));
    let mut rest = made.files.iter();
    if let Some((_, bytes)) = rest.next() {
        claimed.fill(main, bytes)?;
    }
    for (name, bytes) in rest {
        let part = claimed.claim("part of the made program", &args.out.with_file_name(name))?;
        claimed.fill(part, bytes)?;
    }
    if let Some(flat) = flat {
        claimed.fill(flat, &setting.program)?;
    }
    if let (Some(plot), Some(turned)) = (plot, &turned) {
        claimed.fill(plot, turns_svg(&turned.choice).as_bytes())?;
    }
    let mut text = answer(&setting, &read, &made, &template, &args.out, args.to);
    for sentence in said {
        text.push('\n');
        text.push_str(&wrapped(&format!("{sentence}."), 0));
    }
    text.push_str(&outputs::written(&claimed.commit()?));
    screen::print(Stream::Out, &text)
}

/// The arm of a program that is a table of joint values, with the tool of the template where there is one.
fn with_arm(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &ConvertArgs,
    setting: &mut Setting,
    template: &Template,
) -> Answer<()> {
    let is_table = (setting.robot.as_ref()).is_some_and(|of| of.language.is_list());
    if !is_table && args.to != TargetWord::Joints {
        let given = [
            ("--model", args.model.is_some()),
            ("--joint-rows", args.joint_rows.is_some()),
        ];
        if let Some((option, _)) = given.into_iter().find(|(_, is_given)| *is_given) {
            return Err(ErrorCode::Unused.failure(format!(
                    "{option} is for tables of joint values, and neither '{}' nor the new program is one: leave it out",
                    setting.program_name
                ),
            ));
        }
    }
    let Some(source) = setting.robot.as_mut().filter(|_| is_table) else {
        return Ok(());
    };
    if let Some(tool) = template.tool.frame.pose {
        let frames = &mut source.settings.reading.frames;
        frames.entry("tool".to_owned()).or_insert(tool);
    }
    // The option covers both tables of a conversion; the job's setting for the source has priority.
    let rows = &mut source.settings.joint_rows;
    *rows = rows.or(args.joint_rows.map(BetweenRows::from));
    let model = args.model.as_deref();
    give_arm(Some(source), files, job, model, &flags(args))
}

/// Options of a run that a conversion needs.
fn flags(args: &ConvertArgs) -> ProgramArgs {
    let mut expansion = args.expansion.clone();
    // The notes of the made program say the lines.
    expansion.with.goes_on = true;
    ProgramArgs {
        program: args.program.clone(),
        reading: args.reading.clone(),
        robot: RobotArgs {
            correct: None,
            tool_axis: args.tool_axis,
            rapid_from_mm_per_s: args.rapid_from_mm_per_s,
            joint_rows: args.joint_rows.filter(|_| args.to != TargetWord::Joints),
            stated: args.stated.clone(),
            converted: false,
            template: None,
        },
        expansion,
        limits: args.limits.clone(),
        ..ProgramArgs::default()
    }
}

fn writing(args: &ConvertArgs) -> WritingFlags<'_> {
    WritingFlags {
        out: Some(&args.out),
        ..WritingFlags::default()
    }
}

/// The answer in words.
fn answer(
    setting: &Setting,
    read: &ReadProgram<'_>,
    made: &Made,
    template: &TemplateFile,
    out: &Path,
    to: TargetWord,
) -> String {
    let kept = &made.kept;
    let mut text = wrapped(
        &format!(
            "{}: {} are {} in {}. Read again and compared with the path: {}.",
            setting.program_name,
            counted(kept.moves, "move"),
            counted(kept.motions, "motion"),
            match made.files.len() {
                1 => to.title().to_owned(),
                n => format!("{}, a main program and {} parts", to.title(), n - 1),
            },
            differences(kept)
        ),
        0,
    );
    if let Some(not_started) = spindle_text(made) {
        text.push_str(&wrapped(&format!("{not_started}."), 0));
    }
    let mut found: Vec<Warning> = Vec::new();
    let general = |text: String| Warning::new(WarningCode::Writing, text);
    let own = &template.template.program_name;
    let by_name = matches!(to, TargetWord::Krl | TargetWord::Ls);
    if by_name && !own.eq_ignore_ascii_case(&stem(out)) {
        found.push(general(format!(
            "the program is called {own} and its file {}: controllers want one name",
            file_name(out)
        )));
    }
    for finding in &made.findings {
        found.push(match finding.line {
            Some(line) => Warning::at_line(WarningCode::Writing, line, finding.message.clone()),
            None => general(finding.message.clone()),
        });
    }
    let named = |line: usize| made.findings.iter().any(|f| f.line == Some(line));
    // Warnings about corrections do not apply here.
    let warnings = read
        .path()
        .warnings
        .iter()
        .filter(|warning| !named(warning.line) && warning.topic == WarningTopic::Program);
    for warning in warnings.chain(&setting.expansion_warnings) {
        found.push(Warning::of_program(WarningCode::Program, warning));
    }
    if !found.is_empty() {
        text.push_str("\nWhat is otherwise, or was taken for granted\n");
    }
    for finding in merged(found) {
        let finding = finding.to_string();
        text.push_str(&item(&match &setting.flat {
            Some(flat) => flat.with_sources(&finding),
            None => finding,
        }));
    }
    text
}

/// The largest differences.
fn differences(kept: &Kept) -> String {
    // A smaller difference is rounding.
    let within = |what: &str, value: f64, unit: &str| match value < 1e-12 {
        true => format!("{what} equal"),
        false => format!("{what} within {value:.1e} {unit}"),
    };
    let mut parts = vec![
        within("places", kept.position_mm, "mm"),
        within("orientations", kept.orientation_rad, "rad"),
    ];
    if kept.arc_mm > 0.0 {
        parts.push(format!("arcs within {:.1e} mm", kept.arc_mm));
    }
    if kept.chord_mm > 0.0 {
        parts.push(format!(
            "lines within {:.1e} mm of the curves that they follow",
            kept.chord_mm
        ));
    }
    parts.push(match kept.speed_relative < 1e-9 {
        true => "feeds equal".to_owned(),
        false => format!("feeds within {:.2} %", 100.0 * kept.speed_relative),
    });
    parts.join(", ")
}
