//! Text output about a program that was made.

use std::path::Path;

use kinetostat_formats::{Kept, Made};
use kinetostat_machining::number::counted;
use kinetostat_machining::{Warning, WarningCode, merged};

use crate::convert::made::spindle_text;
use crate::files::file_names::{file_name, stem};
use crate::job::program::ReadProgram;
use crate::job::setting::Setting;
use crate::job::target_word::TargetWord;
use crate::job::template_file::TemplateFile;
use crate::ui::layout::{item, wrapped};

/// The answer in words.
pub(crate) fn answer(
    setting: &Setting,
    read: &ReadProgram<'_>,
    made: &Made,
    template: &TemplateFile,
    (out, to): (&Path, TargetWord),
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
    let warnings = read.path().warnings.iter().filter(|warning| {
        let of_systems = warning.text.contains("work coordinate system");
        !named(warning.line)
            && (of_systems
                || !warning.text.contains("correct") && !warning.text.contains("carried"))
    });
    for warning in warnings.chain(&setting.expansion_warnings) {
        let own = Warning::at_line(WarningCode::Program, warning.line, warning.text.clone());
        found.push(own);
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
