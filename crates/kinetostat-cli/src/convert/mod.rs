//! `kinetostat convert`: a program of one language written in another.
//!
//! It takes a program and a template of the cell ([`template_file`]); it gives the program in another language, read again and
//! compared with the path before it is written, and says what is otherwise.

pub(crate) mod arguments;
mod file_names;
pub(crate) mod for_run;
mod free_turn;
pub(crate) mod made;
pub(crate) mod template_file;
mod template_format;
mod text;

use std::path::Path;

use crate::convert::arguments::ConvertArgs;
use crate::convert::free_turn::free_turn;
use crate::convert::made::{made, refuse_other_ending};
use crate::convert::template_file::{TemplateAsked, TemplateFile};
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::job_file::JobFile;
use crate::job::program::read_program;
use crate::job::robot_arguments::RobotArgs;
use crate::job::setting::setting;
use crate::job::turn_arguments::FreeTurnWord;
use crate::ui::failure::Answer;
use crate::ui::layout::wrapped;
use crate::ui::screen::{self, Stream};

pub(crate) fn run(args: &ConvertArgs) -> Answer<()> {
    let files = InputFiles::default();
    let job = args.job.as_deref().map(|path| JobFile::read(&files, path));
    let job = job.transpose()?;
    let language = args.to.language();
    refuse_other_ending(language, &args.out)?;
    let template = TemplateFile::read(
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
        Some(named) => {
            let (model, _) = files.model(named, Path::new(""))?;
            let turned = free_turn(&setting, &template.template, &model, read.path())?;
            Some(turned)
        }
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
            converted: false,
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
