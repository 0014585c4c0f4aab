//! `kinetostat compensate --map`: a program corrected from a table.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::{
    MISSING, Rounding, fixed, largest, largest_length, significant, with_unit,
};
use kinetostat_machining::{
    FieldCorrection, FlatProgram, NoMotion, RESULT_SCHEMA, RunError, ToleranceResult, Warning,
    WarningCode, correct_by_field, odd_correction, odd_tolerances, of_accounting, of_program,
    of_table, unchanged_text, wide_table,
};
use kinetostat_program::{Accounting, CorrectionMap, Path as ToolPath, WriteOptions};
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::job::output_paths::{BESIDE, FLAT_PROGRAM};
use crate::job::program;
use crate::job::setting::Setting;
use crate::program::flat_lines::{WithSources, listed_under, of_warnings};
use crate::program::report;
use crate::program::solve::too_many_blocks;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::{columns, wrapped};
use crate::ui::progress::Progress;
use crate::ui::{fault_list, json, warnings};

/// Result of a program corrected from a table.
#[derive(Serialize, JsonSchema)]
pub(crate) struct MapResult<'a> {
    schema: u32,
    kinetostat_version: &'static str,
    program: &'a str,
    map: String,
    accounting: &'a Accounting,
    /// The flat program, where the program was run once and written flat.
    #[serde(skip_serializing_if = "Option::is_none")]
    flat: Option<&'a FlatProgram>,
    /// True if no correction could be written: the program came back byte for byte.
    unchanged: bool,
    /// True if it is unchanged because it keeps the tolerance uncorrected.
    within_tolerance_before: bool,
    /// Tolerance check of the written program, as for a model.
    tolerance: ToleranceResult,
    /// Places of the written program at which the table was evaluated again.
    places_checked: usize,
    /// Largest distance between where the program goes as it is and where the table wants it.
    max_position_error_before_mm: f64,
    /// Largest distance there between where the program goes and where the table wants it.
    max_position_error_after_mm: f64,
    /// Largest position error that is allowed.
    max_position_error_allowed_mm: f64,
    largest_distance_mm: f64,
    largest_speed_error_percent: f64,
    warnings: Vec<Warning>,
}

/// Upper limit of the faults of a table.
const FAULTS_OF_A_TABLE: usize = 1000;

pub(crate) fn from_map(
    files: &InputFiles,
    map: &Path,
    setting: &Setting,
    existing: Existing,
    to_screen: bool,
) -> Answer<()> {
    let t = &setting.targets;
    if t.report.is_some() || t.pdf.is_some() || t.points.is_some() {
        return Err(ErrorCode::Unused.failure("--map writes no --report, no --pdf and no --points: a table of corrections says nothing about loads and stiffness; leave these options out",
        ));
    }
    let field = read_table(files, map)?;
    let read = program::read_program(setting)?;
    let path = read.path();
    if path.moves.is_empty() {
        let none = RunError::NoMotion(NoMotion::NoMoves);
        return Err(setting.within(Failure::from(none)));
    }
    let mut inputs = setting.inputs.clone();
    inputs.push(map.to_owned());
    let mut outputs = Outputs::new(existing, inputs);
    let mut claim = |what, target: &Option<PathBuf>| {
        target
            .as_deref()
            .map(|path| outputs.claim(what, path))
            .transpose()
    };
    let (out, json_out, flat_out) = (
        claim("corrected program", &t.program)?,
        claim("result", &t.json)?,
        claim(FLAT_PROGRAM, &t.flat)?,
    );
    let further = t.beside.iter().map(|path| outputs.claim(BESIDE, path));
    let further: Vec<usize> = further.collect::<Answer<_>>()?;
    let mut writing = setting.writing.clone();
    let name = map
        .file_name()
        .map_or_else(String::new, |n| n.to_string_lossy().into_owned());
    if let Some(header) = &mut writing.header {
        *header = vec![
            format!("version {}", env!("CARGO_PKG_VERSION")),
            format!("corrections from the table {name}"),
        ];
    }
    let refuse = |error| setting.within(Failure::from(RunError::Write(error)));
    let progress = Progress::new();
    let made = read
        .with(|program| correct_by_field(program, &field, &writing, &progress))
        .map_err(refuse)?;
    let (written, against) = (&made.written, &made.against);
    let a = &written.accounting;
    let beyond = of_accounting(&setting.limits, a);
    if !beyond.is_empty() {
        return Err(setting.within(Failure::from(RunError::BeyondLimits(beyond))));
    }
    let check = read
        .with(|program| program.verify(written, &writing))
        .map_err(refuse)?;
    progress.finish();
    let unchanged = read.with(|program| written.bytes == program.bytes());
    let farthest = match unchanged {
        true => &against.before,
        false => &against.after,
    };
    let tolerance = of_table(farthest, against.allowed_mm, a);
    let flat = setting.flat.as_ref();
    let warnings = warnings_of(setting, path, &field, &made, &tolerance, &writing);
    let warnings = of_warnings(warnings, flat);
    let result = MapResult {
        schema: RESULT_SCHEMA,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        program: &setting.program_name,
        map: name,
        accounting: a,
        flat,
        unchanged,
        within_tolerance_before: made.keeps_as_it_is,
        tolerance,
        places_checked: against.places,
        max_position_error_before_mm: against.before.distance_mm,
        max_position_error_after_mm: farthest.distance_mm,
        max_position_error_allowed_mm: against.allowed_mm,
        largest_distance_mm: check.largest_distance_mm,
        largest_speed_error_percent: 100.0 * check.largest_speed_error,
        warnings,
    };
    if let Some(index) = json_out {
        outputs.fill(index, json::json(&WithSources(&result, flat))?.as_bytes())?;
    }
    if let Some(index) = flat_out {
        outputs.fill(index, &setting.program)?;
    }
    let files = setting.as_files(written)?;
    if let Some(index) = out {
        outputs.fill(index, &files.program)?;
    }
    for (index, bytes) in further.iter().zip(&files.beside) {
        outputs.fill(*index, bytes)?;
    }
    let paths = outputs.commit()?;
    let mut text = words(&result);
    text.push_str(&warnings::warnings(&result.warnings));
    text.push_str(&listed_under(&text, flat));
    text.push_str(&outputs::written(&paths));
    json::print_answer(&text, &WithSources(&result, flat), to_screen)?;
    report::refuse_missed_tolerance(&result.tolerance, setting)
}

/// The table of corrections; of a faulty one all faults.
fn read_table(files: &InputFiles, map: &Path) -> Answer<CorrectionMap> {
    let bytes = files.bytes("map", map)?;
    // Bytes that are no text are refused by the reader, with its line.
    let text = std::str::from_utf8(&bytes).ok();
    let points = text.and_then(|text| match with_decimal_points(text) {
        Cow::Owned(text) => Some(text.into_bytes()),
        Cow::Borrowed(_) => None,
    });
    let bytes = points.unwrap_or(bytes);
    CorrectionMap::read(&bytes).map_err(|first| {
        let all = CorrectionMap::faults(&bytes, FAULTS_OF_A_TABLE);
        let places = match all.len() {
            FAULTS_OF_A_TABLE => "or more places of the table",
            _ => "places of the table",
        };
        let failure = fault_list::failure_of(ErrorCode::FileForm, places, &first, &all);
        failure.within(&map.display().to_string())
    })
}

fn warnings_of(
    setting: &Setting,
    path: &ToolPath,
    field: &CorrectionMap,
    made: &FieldCorrection,
    tolerance: &ToleranceResult,
    writing: &WriteOptions,
) -> Vec<Warning> {
    let mut warnings = of_program(path, Some(&made.written.accounting.warnings));
    let (largest_mm, largest_line) = made.largest_correction;
    let odd = odd_correction(
        &setting.limits,
        largest_mm,
        largest_line,
        writing.tolerance_mm,
    );
    // The warning of a small correction applies only if the tolerance is held.
    let nothing_left_out =
        |w: &Warning| tolerance.held == Some(true) || w.code != WarningCode::SmallCorrection;
    warnings.extend(odd.filter(nothing_left_out));
    warnings.extend(wide_table(path, field));
    warnings.extend(odd_tolerances(writing));
    let a = &made.written.accounting;
    let most = a.peak_blocks_per_second.or(a.mean_blocks_per_second);
    warnings.extend(too_many_blocks(setting, most));
    warnings
}

/// The result for a person: what is missed first, then the figures.
fn words(result: &MapResult<'_>) -> String {
    let a = result.accounting;
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut text = wrapped(
        &format!("{} corrected by the table {}", result.program, result.map),
        0,
    );
    let said = result.tolerance.missed_text().or_else(|| {
        let before = result.max_position_error_before_mm;
        result
            .unchanged
            .then(|| result.within_tolerance_before.then_some(before))
            .map(unchanged_text)
    });
    if let Some(said) = said {
        text.push('\n');
        text.push_str(&wrapped(&said, 2));
    }
    text.push('\n');
    let per_second =
        |rate: Option<f64>| rate.map_or_else(|| MISSING.to_owned(), |rate| largest(rate, "1/s"));
    let mean_per_second = |rate: Option<f64>| {
        let nearest = |rate| with_unit(&significant(rate, 3, Rounding::Nearest), "1/s");
        rate.map_or_else(|| MISSING.to_owned(), nearest)
    };
    let seconds = |time: Option<f64>| {
        time.map_or_else(
            || MISSING.to_owned(),
            |time| with_unit(&fixed(time, 1), "s"),
        )
    };
    text.push_str(&columns(
        &[
            row(
                "largest correction",
                largest_length(a.largest_correction_mm),
            ),
            row(
                "farthest from where the table wants it",
                largest_length(result.max_position_error_after_mm),
            ),
            row("places checked", result.places_checked.to_string()),
            row("rounding", largest_length(a.largest_rounding_mm)),
            row(
                match a.feed_limited_pieces {
                    0 => "speed along the part, error",
                    _ => "error of the speed, feed not limited",
                },
                largest(result.largest_speed_error_percent, "%"),
            ),
            row("blocks read", a.blocks_in.to_string()),
            row("blocks written", a.blocks_out.to_string()),
            row("blocks unchanged", a.blocks_carried.to_string()),
            row(
                "length at feed, before",
                with_unit(&fixed(a.feed_length_in_mm, 1), "mm"),
            ),
            row(
                "length at feed, after",
                with_unit(&fixed(a.feed_length_out_mm, 1), "mm"),
            ),
            row("time at feed, before", seconds(a.feed_time_in_s)),
            row("time at feed, after", seconds(a.feed_time_out_s)),
            row(
                "blocks per second, before",
                mean_per_second(a.mean_blocks_per_second_in),
            ),
            row(
                "blocks per second, after",
                mean_per_second(a.mean_blocks_per_second),
            ),
            row(
                "most of 16 in a row, after",
                per_second(a.peak_blocks_per_second),
            ),
        ],
        2,
    ));
    text
}
