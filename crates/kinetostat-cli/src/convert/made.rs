//! The program in the other language.

use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    Made, MakeError, MakeLanguage, events_of_gcode, make, make_of_flat_robot,
};
use kinetostat_machining::FlatProgram;

use crate::job::free_turn::FreeTurn;
use crate::job::program::ReadProgram;
use crate::job::setting::Setting;
use crate::job::template_file::TemplateFile;
use crate::program::summary::SPINDLE_NOT_STARTED;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::fault_list::failure_of;

/// The program in the other language.
pub(crate) fn made(
    setting: &Setting,
    template: &TemplateFile,
    read: &ReadProgram<'_>,
    turned: Option<&FreeTurn>,
    language: MakeLanguage,
) -> Answer<Made> {
    let refused = |all: Vec<MakeError>| refused(setting, template, &all);
    if let Some(robot) = read.robot() {
        let mut path = robot.path.clone().into_owned();
        if let Some(turned) = turned {
            path.path = turned.path.clone();
        }
        let program = robot.program;
        let done = make_of_flat_robot(program, &path, &template.template, language, |line| {
            setting.flat.as_ref()?.place_of(line)
        });
        return done.map_err(refused);
    }
    if language == MakeLanguage::Gcode {
        return Err(ErrorCode::Unused.failure("the program is in G-code already: `kinetostat expand` writes it flat, `kinetostat compensate --no-compensation` as it was read",
        ));
    }
    let mut events = read
        .gcode()
        .map_or_else(Vec::new, |(program, path)| events_of_gcode(program, path));
    for event in &mut events {
        let place = |flat: &FlatProgram| flat.place_of(event.line);
        if let Some(place) = setting.flat.as_ref().and_then(place) {
            event.place = place;
        }
    }
    let path = turned.map_or(read.path(), |turned| &turned.path);
    make(path, &events, &template.template, language).map_err(refused)
}

/// Warns that the made program does not start the spindle, although its source does.
pub(crate) fn spindle_text(made: &Made) -> Option<String> {
    let note = made.spindle_not_started.as_ref()?;
    Some(format!(
        "{SPINDLE_NOT_STARTED}: the language has no words for it, and {note} is a note; state the cell's statements under [spindle] in the template"
    ))
}

fn refused(setting: &Setting, template: &TemplateFile, all: &[MakeError]) -> Failure {
    let Some(first) = all.first() else {
        return ErrorCode::ProgramRefused.failure("the program is refused");
    };
    let failure = failure_of(ErrorCode::ProgramRefused, "lines", first, all);
    match (first.is_of_template, &template.name) {
        (true, Some(name)) => setting.of_flat(failure).within(name),
        (true, None) => setting.of_flat(failure),
        (false, _) => setting.within(failure),
    }
}
