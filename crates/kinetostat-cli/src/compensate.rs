//! `kinetostat compensate`: a program that cuts where it should.

use std::path::{Path, PathBuf};

use kinetostat_machining::number::{
    MISSING, Rounding, counted, fixed, largest, largest_length, significant, with_unit,
};
use kinetostat_machining::{
    RESULT_SCHEMA, RunError, Warning, odd_correction, odd_tolerances, of_accounting, of_program,
};
use kinetostat_program::{
    Accounting, CorrectionMap, Program, interpret, verify_against_field, verify_written,
    write_corrected,
};
use serde::Serialize;

use crate::along::{self, Aim, Files as Targets, tell};
use crate::args::CompensateArgs;
use crate::failure::{Answer, Failure};
use crate::faults::{Asked, with_all_others};
use crate::input::Files;
use crate::machine::{machine, of_model};
use crate::output::{Existing, Outputs};
use crate::progress::Progress;
use crate::screen::{self, Stream, columns, wrapped};
use crate::setting::{JobFile, Setting, WritingFlags, setting};
use crate::summary;

pub(crate) fn run(mut args: CompensateArgs) -> Answer<()> {
    job_after_json(&mut args);
    let files = Files::default();
    compensate(&files, &args).map_err(|failure| {
        let asked = Asked {
            // A table and a copy need no machine: not all of the job is read for them.
            job: args
                .run
                .job
                .as_deref()
                .filter(|_| args.map.is_none() && !args.no_compensation),
            model: args.run.model.as_deref(),
            program: &args.run.program,
            writing: flags(&args),
        };
        with_all_others(&files, &asked, failure)
    })
}

fn compensate(files: &Files, args: &CompensateArgs) -> Answer<()> {
    let job = args
        .run
        .job
        .as_deref()
        .map(|path| JobFile::read(files, path))
        .transpose()?;
    let mut setting = setting(files, job.as_ref(), &args.run.program, &flags(args))?;
    let existing = if args.run.program.force_overwrite {
        Existing::Replace
    } else {
        Existing::Refuse
    };
    if args.no_compensation {
        return copy(&setting, existing);
    }
    let to_screen = args.run.json.as_deref() == Some(Path::new("-"));
    if let Some(map) = &args.map {
        // A table of corrections knows no tools: a second one is warned of.
        setting.reading.tools = None;
        return from_map(files, map, &setting, existing, to_screen);
    }
    let (machine, model) = machine(
        files,
        job.as_ref(),
        args.run.model.as_deref(),
        &args.run.program,
        &mut setting.inputs,
    )?;
    // A program that cannot be read is told before outputs are looked at.
    along::read_program(&setting)?;
    let mut targets = Targets::claim(Aim::Compensate, &setting.targets, existing, &setting.inputs)?;
    let mut run = along::solve(
        Aim::Compensate,
        &machine,
        &setting,
        args.run.program.threads,
    )?;
    run.result.warnings.extend(of_model(&model));
    targets.list(args.run.program.all_points, &model);
    targets.fill(&run)?;
    let note = targets.note(&run);
    let paths = targets.outputs.commit()?;
    let text = format!(
        "{}{}{note}",
        summary::of_run(&run.result),
        along::written(&paths)
    );
    tell(&text, to_screen.then_some(&run.result))?;
    along::judged(&run.result)
}

fn flags(args: &CompensateArgs) -> WritingFlags<'_> {
    WritingFlags {
        tolerance_um: args.tolerance_um,
        decimals: args.decimals,
        max_blocks_per_second: args.max_blocks_per_second,
        max_feed_factor: args.max_feed_factor,
        backward_step_um: args.backward_step_um,
        no_header: args.no_header,
        again: args.again,
        out: args.out.as_deref(),
        json: args.run.json.as_deref(),
    }
}

/// `--json job.toml` means the job: the file of `--json` may be left out, and nobody calls a result
/// `.toml`.
fn job_after_json(args: &mut CompensateArgs) {
    let taken = args
        .run
        .json
        .as_ref()
        .is_some_and(|p| p.extension().is_some_and(|e| e == "toml"));
    if taken && args.run.job.is_none() {
        args.run.job = args.run.json.replace(PathBuf::from("-"));
    }
}

/// The program as it was read.
fn copy(setting: &Setting, existing: Existing) -> Answer<()> {
    let refuse = |error| Failure::input(error).within(&setting.program_name);
    let program = Program::read(setting.program.clone()).map_err(refuse)?;
    let mut outputs = Outputs::new(existing, setting.inputs.clone());
    let mut text = wrapped(
        &format!(
            "{}: {} in {}, written as read, byte for byte.",
            setting.program_name,
            counted(program.block_count(), "block"),
            counted(program.line_count(), "line")
        ),
        0,
    );
    if let Err(error) = interpret(&program, &setting.reading) {
        text.push_str(&wrapped(
            &format!("It could not be compensated as it is: {error}."),
            0,
        ));
    }
    if let Some(target) = &setting.targets.program {
        let index = outputs.claim("program", target)?;
        outputs.fill(index, program.bytes())?;
    }
    let paths = outputs.commit()?;
    text.push_str(&along::written(&paths));
    screen::print(Stream::Out, &text)
}

/// Result of a program corrected from a table.
#[derive(Serialize)]
struct MapResult<'a> {
    schema: u32,
    kinetostat_version: &'static str,
    program: &'a str,
    map: String,
    accounting: &'a Accounting,
    /// No correction could be written: the program came back byte for byte.
    unchanged: bool,
    /// Places of the written program at which the table was asked again.
    places_checked: usize,
    /// Largest distance there between where the program goes and where the table wants it.
    max_position_error_after_mm: f64,
    /// What that may be at most.
    max_position_error_allowed_mm: f64,
    largest_distance_mm: f64,
    largest_speed_error_percent: f64,
    warnings: Vec<Warning>,
}

/// More faults than this are not looked for in a table.
const FAULTS_OF_A_TABLE: usize = 1000;

fn from_map(
    files: &Files,
    map: &Path,
    setting: &Setting,
    existing: Existing,
    to_screen: bool,
) -> Answer<()> {
    let t = &setting.targets;
    if t.report.is_some() || t.points.is_some() {
        return Err(Failure::input(
            "--map writes no --report and no --points: a table of corrections says nothing about loads and stiffness; leave these options out",
        ));
    }
    let bytes = files.bytes("map", map)?;
    let field = CorrectionMap::read(&bytes).map_err(|first| {
        let all = CorrectionMap::faults(&bytes, FAULTS_OF_A_TABLE);
        let places = match all.len() {
            FAULTS_OF_A_TABLE => "or more places of the table",
            _ => "places of the table",
        };
        let message = along::faults_in_words(places, &first, &all, |fault| fault.reason.as_str());
        Failure::input(message).within(&map.display().to_string())
    })?;
    let (program, path) = along::read_program(setting)?;
    let mut inputs = setting.inputs.clone();
    inputs.push(map.to_owned());
    let mut outputs = Outputs::new(existing, inputs);
    let mut claim = |what, target: &Option<PathBuf>| {
        target
            .as_deref()
            .map(|path| outputs.claim(what, path))
            .transpose()
    };
    let (out, json_out) = (
        claim("corrected program", &t.program)?,
        claim("result", &t.json)?,
    );
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
    let refuse = |error| {
        Failure::from(kinetostat_machining::RunError::Write(error)).within(&setting.program_name)
    };
    let progress = Progress::new();
    let written = write_corrected(&program, &path, &field, &writing, &progress).map_err(refuse)?;
    let a = &written.accounting;
    let beyond = of_accounting(&setting.limits, a);
    if !beyond.is_empty() {
        return Err(Failure::from(RunError::BeyondLimits(beyond)).within(&setting.program_name));
    }
    let check =
        verify_written(&program, &path, &written, &setting.reading, &writing).map_err(refuse)?;
    let against =
        verify_against_field(&path, &written, &field, &writing, &progress).map_err(refuse)?;
    progress.finish();
    let mut warnings = of_program(&path, Some(&a.warnings));
    warnings.extend(odd_correction(
        &setting.limits,
        a.largest_correction_mm,
        a.largest_correction_line,
        writing.tolerance_mm,
    ));
    warnings.extend(odd_tolerances(
        writing.tolerance_mm,
        writing.chord_tolerance_mm,
    ));
    let result = MapResult {
        schema: RESULT_SCHEMA,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        program: &setting.program_name,
        map: name,
        accounting: a,
        unchanged: written.bytes == program.bytes(),
        places_checked: against.places,
        max_position_error_after_mm: against.largest_mm,
        max_position_error_allowed_mm: against.allowed_mm,
        largest_distance_mm: check.largest_distance_mm,
        largest_speed_error_percent: 100.0 * check.largest_speed_error,
        warnings,
    };
    if let Some(index) = json_out {
        outputs.fill(index, along::json(&result)?.as_bytes())?;
    }
    if let Some(index) = out {
        outputs.fill(index, &written.bytes)?;
    }
    let paths = outputs.commit()?;
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let mut text = wrapped(
        &format!(
            "{} corrected by the table {}",
            setting.program_name, result.map
        ),
        0,
    );
    if result.unchanged {
        text.push('\n');
        text.push_str(&wrapped(
            "Nothing was to be corrected: no correction along the program reaches the last digit written, and it comes back byte for byte.",
            2,
        ));
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
    text.push_str(&summary::warnings(&result.warnings));
    text.push_str(&along::written(&paths));
    if to_screen {
        screen::print(Stream::Err, &text)?;
        return screen::print_bytes(along::json(&result)?.as_bytes());
    }
    screen::print(Stream::Out, &text)
}
