//! `kinetostat convert`: a program of one language written in another.
//!
//! It takes a program and a template of the cell ([`template_file`]); it gives the program in another language, read again and
//! compared with the path before it is written, and says what is otherwise.

pub(crate) mod arguments;
mod file_names;
mod free_turn;
mod target_word;
mod template_file;
mod template_format;
mod text;

use kinetostat_formats::{
    Made, MakeError, MakeLanguage, SourceEvent, events_of_gcode, make, make_of_robot,
};

use crate::convert::arguments::ConvertArgs;
use crate::convert::free_turn::{FreeTurn, free_turn};
use crate::convert::template_file::TemplateFile;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::program::{ReadProgram, read_program};
use crate::job::robot_arguments::RobotArgs;
use crate::job::setting::{Setting, setting};
use crate::ui::failure::{Answer, Failure};
use crate::ui::fault_list::fault_list_text;
use crate::ui::layout::wrapped;
use crate::ui::screen::{self, Stream};

pub(crate) fn run(args: &ConvertArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let language = args.to.language();
    let template = TemplateFile::read(&files, args)?;
    let mut setting = setting(&files, job.as_ref(), &flags(args), &writing(args))?;
    setting.inputs.extend(args.template.iter().cloned());
    let mut claimed = Outputs::new(
        Existing::forced(args.force_overwrite),
        setting.inputs.clone(),
    );
    let main = claimed.claim("made program", &args.out)?;
    let flat = args.expansion.flat_program.as_deref();
    let flat = flat.map(|path| claimed.claim("flat program", path));
    let flat = flat.transpose()?;
    let plot = args.turn_plot.as_deref();
    let plot = plot.map(|path| claimed.claim("picture of the turn", path));
    let plot = plot.transpose()?;
    let read = read_program(&setting)?;
    let turned = match &args.free_turn {
        Some(model) => Some(free_turn(
            &files,
            model,
            read.path(),
            (&setting, &template),
        )?),
        None => None,
    };
    let made = made((&setting, &template), &read, turned.as_ref(), language)?;
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
        claimed.fill(plot, turned.picture.as_bytes())?;
    }
    let mut text = text::answer(&setting, &read, &made, &template, (&args.out, language));
    if let Some(turned) = &turned {
        text.push('\n');
        text.push_str(&wrapped(&format!("{}.", turned.description), 0));
    }
    text.push_str(&outputs::written(&claimed.commit()?));
    screen::print(Stream::Out, &text)
}

/// The program in the other language.
fn made(
    (setting, template): (&Setting, &TemplateFile),
    read: &ReadProgram<'_>,
    turned: Option<&FreeTurn>,
    language: MakeLanguage,
) -> Answer<Made> {
    let refused = |all: Vec<MakeError>| refused(setting, template, &all);
    if let Some(robot) = read.robot() {
        let done = make_of_robot(robot.program, robot.path, &template.template, language);
        return done.map_err(refused);
    }
    if language == MakeLanguage::Gcode {
        return Err(Failure::input(
            "the program is in G-code already: `kinetostat expand` writes it flat, `kinetostat compensate --no-compensation` as it was read",
        ));
    }
    let mut events = read
        .gcode()
        .map_or_else(Vec::new, |(program, path)| events_of_gcode(program, path));
    for event in &mut events {
        place(setting, event);
    }
    let path = turned.map_or(read.path(), |turned| &turned.path);
    make(path, &events, &template.template, language).map_err(refused)
}

/// A line of an expanded program is that of the file that it came from.
fn place(setting: &Setting, event: &mut SourceEvent) {
    let found = setting
        .flat
        .as_ref()
        .and_then(|flat| flat.source_of(event.line));
    if let Some((file, line)) = found {
        event.place = format!("{file}, line {line}");
    }
}

fn refused(setting: &Setting, template: &TemplateFile, all: &[MakeError]) -> Failure {
    let Some(first) = all.first() else {
        return Failure::input("the program is refused");
    };
    let text = fault_list_text("lines", first, all, |fault| fault.reason.as_str());
    let failure = Failure::input(text);
    match (first.line, &template.name) {
        (None, Some(name)) => failure.within(name),
        (None, None) => failure,
        (Some(_), _) => setting.within(failure),
    }
}

/// What of a run is asked for here.
fn flags(args: &ConvertArgs) -> ProgramArgs {
    let mut expansion = args.expansion.clone();
    // The notes of the made program say the lines.
    expansion.with.no_comments |= expansion.expand;
    ProgramArgs {
        program: args.program.clone(),
        reading: args.reading.clone(),
        robot: RobotArgs {
            correct: None,
            tool_axis: args.tool_axis,
            rapid_from_mm_per_s: args.rapid_from_mm_per_s,
            joint_rows: None,
        },
        expansion,
        ..ProgramArgs::default()
    }
}

fn writing(args: &ConvertArgs) -> WritingFlags<'_> {
    WritingFlags {
        out: Some(&args.out),
        ..WritingFlags::default()
    }
}
