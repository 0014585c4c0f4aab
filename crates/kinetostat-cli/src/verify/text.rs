//! Text output of `verify`.

use kinetostat_machining::RunResult;
use kinetostat_machining::number::{against, largest, largest_length, mean_length};

use crate::program::features::features_text;
use crate::program::summary::{SPINDLE_NOT_STARTED, assumptions};
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{fixed, triple};
use crate::ui::warnings::warnings;
use crate::verify::answer::VerifyAnswer;
use crate::verify::other_language::SPINDLE;

pub(crate) fn answer_text(answer: &VerifyAnswer, assessed: &RunResult) -> String {
    let head = format!(
        "{} against {}, on {}",
        answer.program, answer.against, answer.model
    );
    let mut out = wrapped(&head, 0);
    out.push('\n');
    let (error, allowed) = against(answer.max_position_error_mm, answer.allowed_mm);
    let faults = answer.faults();
    let doubt = assessed.at_worst_text();
    let doubt = doubt.map_or_else(String::new, |doubt| format!(" {doubt}"));
    let verdict = match faults.is_empty() {
        true => format!(
            "VERIFIED: along this program the tool is at most {error} off, inside the {allowed} that are allowed; along the original as it is, {}. These figures are the model's: they are as true as its stiffnesses and masses.{doubt}",
            largest_length(answer.max_position_error_of_original_mm)
        ),
        false => faults.join(" "),
    };
    let mut words = answer.other_words.iter();
    let verdict = match words.any(|other| other.word == SPINDLE) {
        true => format!("{SPINDLE_NOT_STARTED}. {verdict}"),
        false => verdict,
    };
    out.push_str(&wrapped(&verdict, 2));
    out.push_str(&assumptions(assessed));
    out.push('\n');
    let rows = [
        ["", "original", "this program"].map(str::to_owned),
        [
            "largest position error".to_owned(),
            largest_length(answer.max_position_error_of_original_mm),
            error,
        ],
        [
            "root mean square of it".to_owned(),
            mean_length(answer.rms_position_error_of_original_mm),
            mean_length(answer.rms_position_error_mm),
        ],
        ["error allowed in all".to_owned(), String::new(), allowed],
        [
            "tool tilt that stays".to_owned(),
            String::new(),
            largest(answer.max_residual_rotation_deg, "deg"),
        ],
        [
            "from the original as the model compensates it".to_owned(),
            String::new(),
            largest_length(answer.matched.largest_distance_mm),
        ],
        [
            "points solved".to_owned(),
            String::new(),
            answer.points.to_string(),
        ],
    ];
    out.push_str(&columns(&rows.map(Vec::from), 2));
    out.push_str(&features_text(&answer.features));
    out.push_str(&worst(answer));
    out.push_str(&warnings(&answer.warnings));
    out
}

/// The lines with the largest errors.
fn worst(answer: &VerifyAnswer) -> String {
    const SHOWN: usize = 5;
    let head = ["line", "of the original", "at, mm", "off"]
        .map(str::to_owned)
        .to_vec();
    let points = answer.worst_points.iter().take(SHOWN).map(|p| {
        vec![
            p.output_line.to_string(),
            p.line.to_string(),
            triple(p.position_mm, |x| fixed(x, 2)),
            largest_length(p.off_mm()),
        ]
    });
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(points).collect();
    match rows.len() {
        1 => String::new(),
        _ => format!("\nWorst lines\n{}", columns(&rows, 2)),
    }
}
