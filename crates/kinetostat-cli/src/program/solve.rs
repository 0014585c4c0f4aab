//! A run along a program, from question to files: shared by `compensate`, `deflect` and `demo`.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::path::PathBuf;

use kinetostat_machining::number::{largest, length_setting, setting as setting_of};
use kinetostat_machining::{
    Bounds, LoadAlongPath, Run, RunResult, Task, ToleranceVerdict, Tool, Warning, WarningCode,
    analyse, compensate_program, load_in_words, origin_in_metres,
};
use kinetostat_model::Model;
use kinetostat_program::{Path as ToolPath, Program, faults, interpret};

use crate::files::output::{Existing, Outputs};
use crate::job::machine::Machine;
use crate::job::setting::{Setting, Targets};
use crate::program::points_table::{self, Listing};
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;
use crate::ui::screen::{self, Stream};

/// What a run writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Aim {
    Analyse,
    Compensate,
}

/// Claimed outputs of a run by what they hold.
pub(crate) struct Files {
    pub(crate) outputs: Outputs,
    program: Option<usize>,
    report: Option<usize>,
    json: Option<usize>,
    points: Option<usize>,
    listing: Listing,
}

impl Files {
    /// Claims every target before the long work begins.
    pub(crate) fn claim(
        aim: Aim,
        targets: &Targets,
        existing: Existing,
        inputs: &[PathBuf],
    ) -> Answer<Self> {
        let mut outputs = Outputs::new(existing, inputs.to_vec());
        let mut claim = |what, target: &Option<PathBuf>| {
            target
                .as_deref()
                .map(|path| outputs.claim(what, path))
                .transpose()
        };
        let program = match aim {
            Aim::Compensate => claim("compensated program", &targets.program)?,
            Aim::Analyse => None,
        };
        Ok(Self {
            program,
            report: claim("report", &targets.report)?,
            json: claim("result", &targets.json)?,
            points: claim("table of points", &targets.points)?,
            listing: Listing::default(),
            outputs,
        })
    }

    /// How points are listed.
    pub(crate) fn list(&mut self, all: bool, model: &Model) {
        self.listing = Listing {
            all,
            controller: model.controller.clone(),
        };
    }

    /// What a person should know about the files.
    pub(crate) fn note(&self, run: &Run) -> String {
        self.points
            .and_then(|_| points_table::note(&run.result.question, &run.points, &self.listing))
            .map_or_else(String::new, |note| {
                format!("\n{}", screen::wrapped(&note, 2))
            })
    }

    /// Writes a run beside its targets; nothing is in place yet.
    pub(crate) fn fill(&mut self, run: &Run) -> Answer<()> {
        if let (Some(index), Some(written)) = (self.program, &run.written) {
            self.outputs.fill(index, &written.bytes)?;
        }
        if let Some(index) = self.json {
            self.outputs.fill(index, json(&run.result)?.as_bytes())?;
        }
        if let Some(index) = self.points {
            let outputs = &mut self.outputs;
            points_table::table(&run.result.question, &run.points, &self.listing, |bytes| {
                outputs.append(index, bytes)
            })?;
            outputs.complete(index)?;
        }
        if let Some(index) = self.report {
            let page = kinetostat_report::html_of_run(run)
                .map_err(|error| Failure::input(format!("the report cannot be made: {error}")))?;
            self.outputs.fill(index, page.as_bytes())?;
        }
        Ok(())
    }
}

/// Reads and interprets a program.
pub(crate) fn read_program(setting: &Setting) -> Answer<(Program, ToolPath)> {
    let read = Program::read(setting.program.clone()).and_then(|program| {
        let path = interpret(&program, &setting.reading)?;
        Ok((program, path))
    });
    read.map_err(|error| {
        let all = faults(setting.program.clone(), &setting.reading);
        let message = faults_in_words("lines", &error, &all, |fault| fault.reason.as_str());
        Failure::input(message).within(&setting.program_name)
    })
}

/// Faults of one reason that are listed; further ones are counted.
const FAULTS_OF_A_REASON: usize = 3;

/// Faults listed in all.
const FAULTS_SHOWN: usize = 40;

/// All faults of a file in the order of its lines, or the only one.
pub(crate) fn faults_in_words<'f, F: Display>(
    places: &str,
    first: &F,
    all: &'f [F],
    reason: impl Fn(&'f F) -> &'f str,
) -> String {
    if all.len() < 2 {
        return first.to_string();
    }
    let mut text = format!("{} {places} are refused:", all.len());
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    let mut shown = 0;
    for fault in all {
        let count = counts.entry(reason(fault)).or_default();
        *count += 1;
        if *count <= FAULTS_OF_A_REASON && shown < FAULTS_SHOWN {
            shown += 1;
            text.push_str(&format!("\n  {fault}"));
        }
    }
    if shown < all.len() {
        text.push_str(&format!(
            "\n  and {} more, most for the same reasons as above",
            all.len() - shown
        ));
    }
    text
}

/// The tools of a job, where it names several.
pub(crate) fn tools(machine: &Machine) -> Vec<Tool<'_>> {
    machine
        .tools
        .iter()
        .map(|(number, mechanism, load)| Tool {
            number: *number,
            mechanism,
            load: *load,
        })
        .collect()
}

/// Solves the machine along the program.
pub(crate) fn solve(
    aim: Aim,
    machine: &Machine,
    setting: &Setting,
    threads: Option<usize>,
) -> Answer<Run> {
    let (program, path) = read_program(setting)?;
    let tools = tools(machine);
    let mut question = machine.question.clone();
    question.program.clone_from(&setting.program_name);
    question.files.insert(0, setting.program_file.clone());
    question.files.extend(setting.job_file.clone());
    question.date = crate::files::origin::day();
    let mut writing = setting.writing.clone();
    question.tolerance_from = "as stated".to_owned();
    if aim == Aim::Compensate {
        let (usual_mm, from) = &machine.usual_tolerance;
        // Of the machine, where the program may be scaled.
        let usual_mm = usual_mm / machine.placement.scale;
        let [path_stated, chord_stated] = setting.stated;
        if !path_stated {
            // The bounds of a tolerance; of a program without a scale no machine is outside.
            if !(1e-6..=10.0).contains(&usual_mm) {
                return Err(Failure::input(format!(
                    "the scale {}: with it the machine's tolerance of {} is {} of the program, where 0.000001 to 10 mm are allowed; correct the scale (--scale, or scale under [placement] in the job), or state the tolerance (--tolerance-um, or path_um under [tolerances])",
                    setting_of(machine.placement.scale),
                    length_setting(machine.usual_tolerance.0),
                    length_setting(usual_mm)
                )));
            }
            writing.tolerance_mm = usual_mm;
            question.tolerance_from.clone_from(from);
        }
        if !chord_stated {
            // Never finer than the program of a machine that is not known.
            let in_proportion = 0.8 * usual_mm.min(writing.tolerance_mm);
            writing.chord_tolerance_mm = writing.chord_tolerance_mm.max(in_proportion);
        }
    }
    if let Some(header) = &mut writing.header {
        *header = vec![
            format!("version {}", env!("CARGO_PKG_VERSION")),
            format!(
                "model {} ({}), fingerprint {:016x}",
                question.model, question.model_source, machine.fingerprint
            ),
            format!(
                "load {}",
                load_in_words(
                    &machine.mechanism,
                    &LoadAlongPath::with_tools(machine.load, &path, &tools)
                )
            ),
            format!("tool {}", question.tool),
            format!("placement {}", question.placement),
        ];
    }
    let task = Task {
        mechanism: &machine.mechanism,
        program: &program,
        reading: setting.reading.clone(),
        path: &path,
        placement: machine.placement,
        load: machine.load,
        tools: &tools,
        writing,
        question,
        bounds: Bounds {
            limits: setting.limits,
            ..machine.bounds.clone()
        },
    };
    let progress = Progress::new();
    let work = || match aim {
        Aim::Analyse => analyse(&task, &progress),
        Aim::Compensate => compensate_program(&task, &progress),
    };
    let result = in_threads(threads, work)?;
    progress.finish();
    let mut run = result.map_err(|error| {
        let failure = Failure::from(error).within(&setting.program_name);
        // What is no warning without an answer may be the reason why there is none.
        match origin_in_metres(&machine.mechanism, &machine.placement, &path) {
            Some(smell) => failure.with_reason(&smell.message),
            None => failure,
        }
    })?;
    if let Some(limit) = setting.max_blocks_per_second
        && let Some(most) = run.result.summary.blocks_per_second
        && most > limit
    {
        run.result.warnings.push(Warning::new(WarningCode::BlocksPerSecond, format!(
            "the written program asks for up to {} blocks per second, more than the {limit} that were stated: the machine may stutter. Widen the tolerance (path_um, chord_um) or cut more slowly",
            largest(most, "")
        )));
    }
    Ok(run)
}

/// Runs `work` on a number of threads.
pub(crate) fn in_threads<R: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> R + Send,
) -> Answer<R> {
    let Some(count) = threads else {
        return Ok(work());
    };
    if !(1..=1024).contains(&count) {
        return Err(Failure::input(format!(
            "--threads {count}: 1 to 1024 threads can be used"
        )));
    }
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(count)
        .build()
        .map_err(|error| Failure::input(format!("{count} threads cannot be started: {error}")))?;
    Ok(pool.install(work))
}

/// A result as JSON with a final newline.
pub(crate) fn json<T: serde::Serialize>(value: &T) -> Answer<String> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| {
        Failure::input(format!("the result cannot be written as JSON: {error}"))
    })?;
    text.push('\n');
    Ok(text)
}

/// A written program that misses its tolerance has an exit code of its own; files are in place.
pub(crate) fn judged(tolerance: &ToleranceVerdict, program: &str) -> Answer<()> {
    match tolerance.missed_in_words() {
        Some(text) => Err(Failure::tolerance_missed(text).within(program)),
        None => Ok(()),
    }
}

/// Where the text for people goes, and the JSON on the standard output if it is wanted there.
pub(crate) fn tell(text: &str, result: Option<&RunResult>) -> Answer<()> {
    match result {
        Some(result) => {
            screen::print(Stream::Err, text)?;
            screen::print_bytes(json(result)?.as_bytes())
        }
        None => screen::print(Stream::Out, text),
    }
}

/// Files that were written, one a line.
pub(crate) fn written(paths: &[PathBuf]) -> String {
    if paths.is_empty() {
        return String::new();
    }
    let mut out = String::from("\nWritten\n");
    for path in paths {
        out.push_str(&format!(
            "  {}\n",
            crate::ui::failure::safe(&path.display().to_string())
        ));
    }
    out
}
