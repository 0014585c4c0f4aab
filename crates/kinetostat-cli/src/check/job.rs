//! `kinetostat check job.toml`: what a job requests, and whether it makes sense. The program is read
//! and its ends are put into the machine; nothing is solved along it and nothing is written.

use std::path::Path;

use kinetostat::Mechanism;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::number::counted;
use kinetostat_machining::{
    FlatProgram, LoadAlongPath, Placement, Task, Unwatched, Warning, WarningCode, load_description,
    refused_question, unusual_question,
};
use kinetostat_program::{Knowledge, Move, MoveKind, Path as ToolPath};
use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::Serialize;

use crate::convert::for_run::refuse_unconvertible;
use crate::convert::targets::{Named, in_language};
use crate::files::input_files::InputFiles;
use crate::files::outputs::may_be_written;
use crate::job::all_faults::{RunQuery, with_all_others};
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::cut::along::{self, refuse_what_breaks_the_tool};
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::file_endings::refuse_other_endings;
use crate::job::job_file::JobFile;
use crate::job::of_model::machine_of;
use crate::job::output_paths::OutputPaths;
use crate::job::over_part::{is_of_positions, tool_over_part};
use crate::job::setting::{Setting, setting};
use crate::job::template_file::TemplateFile;
use crate::job::turn_arguments::FreeTurnWord;
use crate::job::{program, run_warnings};
use crate::program::aim::Aim;
use crate::program::chatter::Judging;
use crate::program::flat_lines::{WithSources, listed_under, of_warnings};
use crate::program::solve::{computed, forces_of, with_task};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::layout::{item, listed, wrapped};
use crate::ui::numbers::{short, triple};
use crate::ui::{json, warnings};
use crate::vibration::damping::words;

/// Content of a job, stable names with units.
#[derive(Serialize, JsonSchema)]
pub(crate) struct JobFindings {
    schema: u32,
    kinetostat_version: &'static str,
    job: String,
    model: String,
    model_source: String,
    model_deviations: Vec<String>,
    tool: String,
    placement: String,
    load: String,
    /// Damping of the machine, if chatter is judged along the program.
    #[serde(skip_serializing_if = "Option::is_none")]
    chatter: Option<String>,
    program: ProgramFinding,
    /// The ends of the program along every axis of the part.
    ends: Vec<EndFinding>,
    outputs: Vec<OutputFinding>,
    warnings: Vec<Warning>,
    /// Reason for which a compensation would refuse the job.
    #[serde(skip)]
    refused: Option<Failure>,
}

#[derive(Serialize, JsonSchema)]
struct ProgramFinding {
    name: String,
    /// Origin of the lines, if the program was run once and written flat.
    #[serde(skip_serializing_if = "Option::is_none")]
    flat: Option<FlatProgram>,
    lines: usize,
    blocks: usize,
    /// True where it states no unit, and its lengths are taken for millimetres.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    units_assumed: bool,
    feed_moves: usize,
    rapid_moves: usize,
    feed_length_mm: f64,
    /// Smallest and largest coordinates, program axes; none without a motion.
    smallest_mm: Option<[f64; 3]>,
    largest_mm: Option<[f64; 3]>,
}

#[derive(Serialize, JsonSchema)]
struct EndFinding {
    /// Name of the end, e.g. `smallest x`.
    end: String,
    line: usize,
    position_mm: [f64; 3],
    reached: bool,
    /// Reason if it is not reachable.
    problem: Option<String>,
}

#[derive(Serialize, JsonSchema)]
struct OutputFinding {
    what: &'static str,
    path: String,
    exists: bool,
}

pub(crate) fn run(path: &Path, json: bool) -> Answer<()> {
    let files = InputFiles::default();
    let flags = ProgramArgs::default();
    let found = findings(&files, path, &flags).map_err(|failure| {
        let query = RunQuery {
            job: Some(path),
            model: None,
            program: &flags,
            writing: WritingFlags::default(),
        };
        with_all_others(&files, &query, failure)
    })?;
    let text = answer_text(&found);
    let flat = found.program.flat.as_ref();
    json::print_answer(&text, &WithSources(&found, flat), json)?;
    if let Some(refused) = found.refused {
        return Err(refused);
    }
    match found.ends.iter().filter(|e| !e.reached).count() {
        0 => Ok(()),
        n => Err(ErrorCode::NoAnswer.failure(format!(
            "the machine does not reach {n} of the {} ends of the program; see above",
            found.ends.len()
        ))),
    }
}

/// A job that is not written yet.
pub(crate) struct AsFarAsKnown {
    /// Ends of its program that the machine does not reach, in words.
    pub(crate) unreached: Vec<String>,
    /// Outputs that exist.
    pub(crate) existing: Vec<String>,
}

pub(crate) fn as_far_as_known(files: &InputFiles, path: &Path) -> Answer<AsFarAsKnown> {
    let found = findings(files, path, &ProgramArgs::default())?;
    let ends = found.ends.into_iter().filter(|end| !end.reached);
    let words = ends.map(|end| {
        let why = end.problem.unwrap_or_default();
        format!("{} of the program, line {}: {why}", end.end, end.line)
    });
    let outputs = found.outputs.into_iter().filter(|output| output.exists);
    Ok(AsFarAsKnown {
        unreached: words.collect(),
        existing: outputs.map(|output| output.path).collect(),
    })
}

fn findings(files: &InputFiles, path: &Path, flags: &ProgramArgs) -> Answer<JobFindings> {
    let job = JobFile::read(files, path)?;
    let mut setting = setting(files, Some(&job), flags, &WritingFlags::default())?;
    refuse_lines_beyond(Some(&job), &setting)?;
    named_outputs(files, &job, &mut setting)?;
    let (machine, model) = machine_of(&mut setting, files, Some(&job), None, flags)?;
    let read = program::read_program(&setting)?;
    let motion = read.path();
    let mut warnings = run_warnings::of_run(&model, Some(&job), flags);
    warnings.extend(kinetostat_machining::of_program(motion, None));
    warnings.extend(kinetostat_machining::origin_in_metres(
        &machine.mechanism,
        &machine.placement,
        motion,
        machine.bounds.is_unplaced,
    ));
    let judging = Judging::of_run(&machine, &model, &setting)
        .map_err(|failure| failure.within(&path.display().to_string()))?;
    let is_placed = setting.free_turn == FreeTurnWord::AsStated;
    let stands = tool_over_part(&machine, is_of_positions(motion));
    warnings.extend(stands.map_err(|failure| setting.within(failure))?);
    warnings.extend(machine.not_carried.clone());
    let check = |task: &Task<'_>| (refused_question(task, is_placed), unusual_question(task));
    let forces = forces_of(&machine, &setting, motion, &Unwatched)?;
    let forces = forces.as_ref();
    let ((refused, error), unusual) =
        with_task(Aim::Compensate, &machine, &setting, &read, forces, check)?;
    warnings.extend(along::warnings(forces));
    warnings.extend(setting.of_expansion());
    warnings.extend(refuse_unconvertible(
        files,
        Some(&job),
        flags,
        &model,
        &machine,
    )?);
    // The list is cut behind some: what keeps the part from being cut comes first.
    warnings.sort_by_key(|warning| warning.code != WarningCode::SpindleNotStarted);
    let of_tool = refuse_what_breaks_the_tool(forces, &setting).err();
    let error = of_tool.or_else(|| Some(setting.within(error?.into())));
    warnings.extend(refused);
    warnings.extend(unusual);
    outputs_can_be(&setting)?;
    let feed = |kind: MoveKind| motion.moves.iter().filter(move |m| m.kind == kind);
    let corners = extent(motion);
    let q = &machine.run_inputs;
    Ok(JobFindings {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        job: path.display().to_string(),
        model: q.model.clone(),
        model_source: q.model_source.clone(),
        model_deviations: q.model_deviations.clone(),
        tool: q.tool.clone(),
        placement: q.placement.clone(),
        load: load_description(
            &machine.mechanism,
            &LoadAlongPath::new(computed(machine.load, forces), motion),
        ),
        chatter: judging.map(|judging| words(&judging.damping)),
        program: ProgramFinding {
            name: setting.program_name.clone(),
            flat: setting.flat.clone(),
            lines: read.line_count(),
            blocks: read.with(|program| program.statement_count()),
            units_assumed: motion.units_assumed_on.is_some(),
            feed_moves: feed(MoveKind::Feed).count(),
            rapid_moves: feed(MoveKind::Rapid).count(),
            feed_length_mm: feed(MoveKind::Feed)
                .filter(|m| m.is_known_feed())
                .map(Move::length_mm)
                .sum(),
            smallest_mm: corners.map(|(low, _)| low.into()),
            largest_mm: corners.map(|(_, high)| high.into()),
        },
        ends: ends(&machine.mechanism, &machine.placement, motion),
        outputs: outputs(&setting.targets),
        warnings: of_warnings(warnings, setting.flat.as_ref()),
        refused: error,
    })
}

/// All points where a move ends, mm, with their lines.
fn points(motion: &ToolPath) -> impl Iterator<Item = (&Move, Vector3<f64>)> + '_ {
    motion
        .moves
        .iter()
        .filter(|m| m.known != Knowledge::Nothing)
        .map(|m| (m, m.end))
}

fn extent(motion: &ToolPath) -> Option<(Vector3<f64>, Vector3<f64>)> {
    points(motion)
        .map(|(_, p)| (p, p))
        .reduce(|a, b| (a.0.inf(&b.0), a.1.sup(&b.1)))
}

/// The ends of the program along every axis, put into the machine.
fn ends(mechanism: &Mechanism, placement: &Placement, motion: &ToolPath) -> Vec<EndFinding> {
    let mut found = Vec::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let by =
            |a: &(&Move, Vector3<f64>), b: &(&Move, Vector3<f64>)| a.1[axis].total_cmp(&b.1[axis]);
        let ends = [
            ("smallest", points(motion).min_by(by)),
            ("largest", points(motion).max_by(by)),
        ];
        for (word, end) in ends {
            let Some((motion, position)) = end else {
                continue;
            };
            // The posture is the one of a compensation: within the limits of the actuators, too.
            let posture = mechanism.posture(
                &placement
                    .on(motion, 1.0)
                    .pose(&position, placement.orientation_on(motion, 1.0)),
            );
            let posture = posture.and_then(|posture| posture.within_limits());
            found.push(EndFinding {
                end: format!("{word} {name}"),
                line: motion.line,
                position_mm: position.into(),
                reached: posture.is_ok(),
                problem: posture.err().map(|error| Failure::from(error).plain),
            });
        }
    }
    found
}

/// Names the programs that a compensation writes, with the file extensions of their language.
fn named_outputs(files: &InputFiles, job: &JobFile, setting: &mut Setting) -> Answer<()> {
    let Some(word) = job.to() else {
        return refuse_other_endings(setting);
    };
    let template = TemplateFile::path(Some(job), None);
    let module = TemplateFile::program_name(files, template.as_deref())?;
    in_language(
        &mut setting.targets,
        &setting.program_path,
        module,
        Some(job),
        Named::default(),
        word.language(),
    )
}

/// Checks the outputs as a compensation does, except that existing files are reported in the list.
fn outputs_can_be(setting: &Setting) -> Answer<()> {
    let mut others: Vec<(&'static str, &Path)> = Vec::new();
    for (what, path) in setting.targets.named() {
        may_be_written(what, path, &setting.inputs, &others)?;
        others.push((what, path));
    }
    Ok(())
}

fn outputs(targets: &OutputPaths) -> Vec<OutputFinding> {
    targets
        .named()
        .map(|(what, path)| OutputFinding {
            what,
            path: path.display().to_string(),
            exists: path.exists(),
        })
        .collect()
}

fn answer_text(f: &JobFindings) -> String {
    let mut out = wrapped(&format!("{}: a job for `kinetostat compensate`", f.job), 0);
    out.push('\n');
    let p = &f.program;
    let corners = match (p.smallest_mm, p.largest_mm) {
        (Some(low), Some(high)) => format!(
            ", from {} to {} mm",
            triple(low, short),
            triple(high, short)
        ),
        _ => ", no motion".to_owned(),
    };
    let units = match p.units_assumed {
        true => "; it states no unit: lengths are taken for millimetres",
        false => "",
    };
    let lines = [
        format!("Model: {} ({})", f.model, f.model_source),
        format!(
            "Program: {}, {} in {}; {} of {} mm in all, {}{corners}{units}",
            p.name,
            counted(p.blocks, "block"),
            counted(p.lines, "line"),
            counted(p.feed_moves, "feed move"),
            short(p.feed_length_mm),
            counted(p.rapid_moves, "rapid move")
        ),
        format!("Placement: {}", f.placement),
        format!("Tool: {}", f.tool),
        format!("Load: {}", f.load),
    ];
    let chatter = f.chatter.as_ref();
    let chatter =
        chatter.map(|damping| format!("Chatter: judged along the program; damping: {damping}"));
    for line in lines.into_iter().chain(chatter) {
        out.push_str(&wrapped(&line, 0));
    }
    for deviation in &f.model_deviations {
        out.push_str(&item(deviation));
    }
    let missed: Vec<&EndFinding> = f.ends.iter().filter(|e| !e.reached).collect();
    if missed.is_empty() && !f.ends.is_empty() {
        out.push_str(&wrapped(
            "The machine reaches the ends of the program along x, y and z.",
            0,
        ));
    }
    if !missed.is_empty() {
        out.push_str("\nNot reached\n");
    }
    for end in &missed {
        out.push_str(&item(&format!(
            "{} (line {}), {} mm: {}",
            end.end,
            end.line,
            triple(end.position_mm, short),
            end.problem.as_deref().unwrap_or_default()
        )));
    }
    let rows: Vec<Vec<String>> = f
        .outputs
        .iter()
        .map(|o| {
            let state = match o.exists {
                true => "exists: needs --force-overwrite",
                false => "new",
            };
            [o.what, &o.path, state].map(str::to_owned).to_vec()
        })
        .collect();
    out.push_str(&format!("\nOutputs\n{}", listed(&rows, 2)));
    out.push_str(&warnings::warnings(&f.warnings));
    out.push_str(&listed_under(&out, f.program.flat.as_ref()));
    out.push_str("\nNext\n");
    let mut mended = Vec::new();
    if !missed.is_empty() {
        mended.push("what the machine does not reach: part_origin_mm, the tool or its orientation");
    }
    if f.refused.is_some() {
        mended.push("what `kinetostat compensate` refuses: see the warnings above");
    }
    out.push_str(&match mended.is_empty() {
        true => format!(
            "  kinetostat compensate {}\n",
            crate::ui::safe_text::safe(&f.job)
        ),
        false => item(&format!("mend first {}", mended.join("; and "))),
    });
    out
}
