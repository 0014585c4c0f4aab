//! Settings that decide a run, except the machine: options have priority over the job file.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use kinetostat::number::larger;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{FileForm, stays_beside_flat};
use kinetostat_machining::{Feature, FileRead, FlatProgram, ForceAlongPath, Limits, WarningCode};
use kinetostat_program::{
    Arcs, Corrected, Dialect, Path as ToolPath, ReadOptions, RotaryAxes, Warning, WriteOptions,
};

use crate::files::input_files::{InputFiles, refuse_beyond_memory};
use crate::files::origin;
use crate::files::paths::named_with_own_folder;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::chatter::ChatterSetting;
use crate::job::expansion::flat::flattened;
use crate::job::expansion::settings::wanted;
use crate::job::features::features;
use crate::job::format::ArcsWord;
use crate::job::job_file::JobFile;
use crate::job::limits::limits;
use crate::job::output_paths::{Form, OutputPaths, beside_program, flat_beside, output_paths};
use crate::job::reading::reading;
use crate::job::robot::called_files::{refuse_calls_beside, with_called_files};
use crate::job::robot::frames::RobotFrames;
use crate::job::robot::parts::join_parts;
use crate::job::robot::read_once::Reading;
use crate::job::robot::read_program::{flat_text, notes_of, read_robot};
use crate::job::robot::settings::moving_subprograms;
use crate::job::robot::source::{BeforeFlat, RobotSource, robot_source};
use crate::job::robot::system_frames::with_system_frames;
use crate::job::robot_arguments::CorrectWord;
use crate::job::turn_arguments::FreeTurnWord;
use crate::job::uncertain::{Uncertainty, uncertainty};
use crate::job::values::{NotAllowed, above_zero, chosen, micrometres};
use crate::ui::failure::{Answer, Failing, Failure};

/// Settings that decide a run along a program, except the model.
pub(crate) struct Setting {
    /// The program that is run: of an expanded one the flat form.
    pub(crate) program: Vec<u8>,
    pub(crate) program_name: String,
    pub(crate) program_path: PathBuf,
    /// A program of a robot; none in G-code.
    pub(crate) robot: Option<RobotSource>,
    /// Origin of the lines, for an expanded program.
    pub(crate) flat: Option<FlatProgram>,
    /// Warnings of the expansion, by lines of the flat program.
    pub(crate) expansion_warnings: Vec<Warning>,
    /// Lines of the program's file as the user has it; none where it has no lines, or of which only the first were read.
    pub(crate) lines_of_file: Option<usize>,
    /// The program and its subprograms, as they were read.
    pub(crate) program_files: Vec<FileRead>,
    pub(crate) job_file: Option<FileRead>,
    pub(crate) reading: ReadOptions,
    /// Corrected directions of the tool's pose in a program in G-code.
    pub(crate) correct: CorrectWord,
    /// Corrected directions of the converted program: it states the tool's orientation where its source does not.
    pub(crate) correct_converted: CorrectWord,
    pub(crate) writing: WriteOptions,
    pub(crate) max_blocks_per_second: Option<f64>,
    /// Limits beyond which a program is refused.
    pub(crate) limits: Limits,
    /// True if the tolerances of path and chords were stated.
    pub(crate) stated: [bool; 2],
    /// Total requested tolerance, mm: of straight pieces, chords of arcs and rounding.
    pub(crate) asked_mm: Option<f64>,
    pub(crate) targets: OutputPaths,
    /// Redundancy resolution for a round tool.
    pub(crate) free_turn: FreeTurnWord,
    /// Forces of the cut that were found along the program before it was converted.
    pub(crate) forces: Option<ForceAlongPath>,
    /// Lines of the program with names and tolerances of their own.
    pub(crate) features: Vec<Feature>,
    /// Chatter is judged along the program.
    pub(crate) chatter: Option<ChatterSetting>,
    /// Uncertain numbers of machine and load, if stated.
    pub(crate) uncertain: Option<Uncertainty>,
    /// About how many places of the run are looked at; 0 without anybody who does.
    pub(crate) places: usize,
    /// Files that were read: never overwritten.
    pub(crate) inputs: Vec<PathBuf>,
}

impl Setting {
    /// Moves the corrected directions to the program that is made of this one.
    fn correct_what_is_made(&mut self) {
        self.correct_converted = std::mem::take(&mut self.correct);
        if let Some(robot) = &mut self.robot {
            robot.settings.corrected = self.correct.directions();
        }
    }

    /// A failure along the program: with its name, and of an expanded one with the lines that its lines came from.
    pub(crate) fn within(&self, failure: Failure) -> Failure {
        self.of_flat(failure).within(&self.program_name)
    }

    /// A failure that names lines of the program: of an expanded one with the lines that its lines came from.
    pub(crate) fn of_flat(&self, mut failure: Failure) -> Failure {
        if let Some(flat) = &self.flat {
            // The flat program of a control or a robot has the name of its first file.
            let named = format!("{}, line ", self.program_name);
            failure.plain = match self.robot {
                Some(_) => flat.with_sources(&failure.plain.replace(&named, "line ")),
                None => flat.with_sources(&failure.plain),
            };
        }
        failure
    }

    /// Half a digit along three axes, mm: what rounding alone leaves, in the coarsest units of the program.
    pub(crate) fn rounding_mm(&self, path: &ToolPath) -> f64 {
        let units = path.moves.iter().map(|m| m.words.mm_per_unit);
        let digits = units.map(|unit| self.writing.last_digit_mm(unit));
        0.5 * 3.0_f64.sqrt() * digits.fold(self.writing.last_digit_mm(1.0), larger)
    }

    /// Format of the program's file.
    pub(crate) fn form(&self) -> FileForm {
        match &self.robot {
            Some(RobotSource {
                parquet: Some(_), ..
            }) => FileForm::Parquet,
            source => {
                let language = source.as_ref().map(|source| source.language);
                FileForm::of(language, &self.program_name, &self.program)
            }
        }
    }

    /// A program that was written, as its files.
    pub(crate) fn as_files<'b>(&self, written: &'b Corrected) -> Answer<WrittenFiles<'b>> {
        let divided = self
            .robot
            .as_ref()
            .and_then(|source| source.divided.as_ref());
        if let Some(divided) = divided {
            let mut files = divided.split(&written.bytes)?.into_iter().map(Cow::Owned);
            return Ok(WrittenFiles {
                program: files.next().unwrap_or_default(),
                beside: files.collect(),
                widened: Vec::new(),
            });
        }
        let (program, widened) = match &self.robot {
            Some(source) => source.in_form_of_file(&written.bytes)?,
            None => (Cow::Borrowed(written.bytes.as_slice()), Vec::new()),
        };
        let beside = written.beside.iter();
        Ok(WrittenFiles {
            program,
            beside: beside
                .map(|(_, bytes)| Cow::Borrowed(bytes.as_slice()))
                .collect(),
            widened,
        })
    }

    /// Warnings of the expansion of the program.
    pub(crate) fn of_expansion(&self) -> impl Iterator<Item = kinetostat_machining::Warning> + '_ {
        let found = self.expansion_warnings.iter();
        found.map(|w| kinetostat_machining::Warning::of_program(WarningCode::Program, w))
    }

    /// The rotary axes of the machine, so that their words are read.
    pub(crate) fn turned_by(&mut self, rotary: Option<Arc<RotaryAxes>>) {
        if let Some(robot) = &mut self.robot {
            let is_other = rotary.is_some() && robot.settings.making.rotary != rotary;
            robot.settings.making.rotary.clone_from(&rotary);
            let axes = rotary.iter().flat_map(|rotary| &rotary.axes);
            robot.settings.reading.rotary_axes = axes.map(|axis| axis.letter).collect();
            if is_other {
                robot.reading = Reading::new();
            }
        }
        self.reading.rotary = rotary;
    }

    /// Tool and work object of a robot's program.
    pub(crate) fn robot_frames(&self) -> Answer<Option<RobotFrames>> {
        let Some(source) = &self.robot else {
            return Ok(None);
        };
        let read = read_robot(source).map_err(|failure| self.of_flat(failure).of_program())?;
        Ok(Some(RobotFrames::of(&read)))
    }

    /// Sets the path of the flat program, if there is one.
    pub(crate) fn write_flat_to(&mut self, target: Option<PathBuf>) {
        if let Some(flat) = &mut self.flat {
            flat.name = target.as_deref().map(named_with_own_folder);
        }
        self.targets.flat = target;
    }
}

/// A program that was written, as its files.
pub(crate) struct WrittenFiles<'b> {
    pub(crate) program: Cow<'b, [u8]>,
    /// Additional files, in their order.
    pub(crate) beside: Vec<Cow<'b, [u8]>>,
    /// Columns of a table that have another type than before.
    pub(crate) widened: Vec<String>,
}

/// Reads the program and everything said about it.
pub(crate) fn setting(
    files: &InputFiles,
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
) -> Answer<Setting> {
    let mut inputs: Vec<PathBuf> = job.iter().map(|j| j.path.clone()).collect();
    let path = program_path(job, flags)?;
    inputs.push(path.clone());
    let mut reading = reading(job, &flags.reading)?;
    let limits = limits(job, &flags.limits)?;
    let (mut write, stated) = tolerances(job, flags, writing)?;
    // Stated chords have a share of their own.
    let asked_mm = (writing.tolerance_um)
        .filter(|_| writing.of_all && !stated[1])
        .map(|_| write.tolerance_mm);
    let header = job.and_then(|j| j.job.output.header).unwrap_or(true);
    write.header = (header && !writing.no_header).then(Vec::new);
    let max_blocks_per_second = chosen(
        job,
        "--max-blocks-per-second",
        writing.max_blocks_per_second,
        job.and_then(|j| j.job.tolerances.max_blocks_per_second.as_ref()),
        above_zero,
    )?;
    write.max_blocks_per_s = max_blocks_per_second;
    let features = features(job)?;
    let uncertain = uncertainty(files, job, &flags.uncertain)?;
    let chatter = ChatterSetting::of_job(job)?;
    let program_name = path.file_name().map_or_else(
        || path.display().to_string(),
        |n| n.to_string_lossy().into_owned(),
    );
    let expand = wanted(job, &flags.expansion, flags.robot.converted, &reading)?;
    reading.of_fanuc_run = expand
        .as_ref()
        .is_some_and(|expand| expand.options.dialect == Dialect::Fanuc);
    let form = match expand {
        Some(_) => Form::Flat,
        None => Form::AsItStands,
    };
    let program = files.bytes("program", &path);
    let known = program.as_deref().unwrap_or_default();
    let mut targets = output_paths(job, flags, writing, &path, known, form)?;
    // The last, so that nothing else is hidden by a program that is not there.
    let program = program?;
    let lines = line_count(&program);
    refuse_beyond_memory(&path, program.len(), lines)?;
    let mut program_files = vec![origin::file("program", &path, &program)];
    if let Some(own) = &uncertain {
        program_files.push(own.read.clone());
        inputs.push(own.path.clone());
    }
    let robot = robot_source(files, job, flags, &path, &program_name, &program)?;
    // A search for faults of the job leaves out those of its program.
    let mut expand = expand.filter(|_| !job.is_some_and(|j| j.is_searched));
    if robot.is_none() {
        reading.moving_calls = moving_subprograms(job, &flags.robot.stated)?;
        if let Some(expand) = &mut expand {
            expand.options.reading.moving_calls = reading.moving_calls.clone();
        }
    }
    let (mut robot_flat, mut notes_of_run) = (None, Vec::new());
    let robot = robot.map(|(mut source, read)| -> Answer<RobotSource> {
        program_files.extend(read);
        inputs.extend(source.paths.iter().cloned());
        if expand.is_none() {
            refuse_calls_beside(&source, &path)?;
        }
        if let Some(expand) = &expand {
            for (path, read) in with_called_files(&mut source, &path, &expand.folders)? {
                program_files.push(read);
                inputs.push(path);
            }
            let (text, flat) = flat_text(&source, expand.comments_asked)?;
            notes_of_run = notes_of(&text);
            robot_flat = Some((text.file.bytes().to_vec(), flat));
            let before = std::mem::replace(&mut source.files, vec![text.file]);
            if text.changed && source.language.is_in_blocks() {
                // The flat blocks hold numbers.
                source.settings.reading.values.clear();
            }
            let paths = std::mem::take(&mut source.paths);
            for (file, path) in before.iter().skip(1).zip(paths) {
                if stays_beside_flat(source.language, file) {
                    source.files.push(file.clone());
                    source.paths.push(path);
                }
            }
            source.before = Some(BeforeFlat {
                files: before,
                origins: text.origins,
            });
        }
        let mut further = source.paths.clone();
        if let Some(joined) = join_parts(&mut source, &path)? {
            let found = joined.paths.iter().filter(|path| !inputs.contains(path));
            inputs.extend(found.cloned().collect::<Vec<_>>());
            program_files.extend(joined.read);
            further = joined.paths;
            if let (None, Some(out)) = (&targets.flat, &targets.program) {
                targets.flat = Some(flat_beside(out, &path, &program)?);
            }
            robot_flat = Some((program_of(&source), joined.flat));
        }
        // The last of its files: it is read, and not written.
        if let Some((path, read)) = with_system_frames(&mut source, &path)? {
            program_files.push(read);
            inputs.push(path);
        }
        if let Some(out) = &targets.program {
            let further = further.iter();
            targets.beside = further
                .map(|file| beside_program(out, &path, file))
                .collect();
        }
        Ok(source)
    });
    let robot = robot.transpose()?;
    let mut expansion_warnings = notes_of_run;
    let (program, flat) = match (robot_flat, expand) {
        (Some((program, flat)), _) => (program, Some(flat)),
        (None, Some(expand)) => {
            let done = flattened(program, &path, &program_name, &expand)?;
            program_files.extend(done.read);
            inputs.extend(done.paths);
            expansion_warnings = done.expanded.warnings;
            (done.expanded.program.bytes().to_vec(), Some(done.flat))
        }
        (None, None) => (program, None),
    };
    let target = targets.flat.clone();
    let in_job = job.and_then(|j| j.job.robot.as_ref()?.get_ref().correct);
    let free_turn = free_turn(job, flags)?;
    if free_turn == FreeTurnWord::AsStated {
        targets.turn_plot = None;
    }
    let mut setting = Setting {
        job_file: job.map(|j| origin::file("job", &j.path, j.text.as_bytes())),
        program_files,
        lines_of_file: None,
        flat,
        expansion_warnings,
        robot,
        program,
        program_path: path,
        program_name,
        reading,
        correct: flags.robot.correct.or(in_job).unwrap_or_default(),
        correct_converted: CorrectWord::default(),
        writing: write,
        max_blocks_per_second,
        limits,
        stated,
        asked_mm,
        targets,
        free_turn,
        forces: None,
        features,
        chatter,
        uncertain,
        places: 0,
        inputs,
    };
    // `check` and `deflect` take the same job.
    let names_robot = job.and_then(JobFile::to).is_some();
    if flags.robot.converted || (names_robot && setting.robot.is_none()) {
        setting.correct_what_is_made();
    }
    if setting.form() != FileForm::Parquet {
        setting.lines_of_file = Some(lines);
    }
    setting.write_flat_to(target);
    Ok(setting)
}

/// Lines of a text, whose last one may have no ending.
pub(crate) fn line_count(text: &[u8]) -> usize {
    let count = |ending| text.iter().filter(|byte| **byte == ending).count();
    let open = text.last().is_some_and(|last| !b"\r\n".contains(last));
    count(b'\n').max(count(b'\r')) + usize::from(open)
}

/// The bytes of the file with which a program begins.
fn program_of(source: &RobotSource) -> Vec<u8> {
    let first = source.files.first();
    first.map_or_else(Vec::new, |file| file.bytes().to_vec())
}

/// Redundancy resolution for a round tool about its own axis.
fn free_turn(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<FreeTurnWord> {
    let table = job.and_then(|j| j.job.robot.as_ref());
    let in_job = table.map_or(FreeTurnWord::AsStated, |table| table.get_ref().free_turn);
    let chosen = match (flags.turn.stiff_turn, flags.turn.free_turn) {
        (true, true) => FreeTurnWord::Stiff,
        (true, false) if in_job == FreeTurnWord::AsStated => {
            return Err(ErrorCode::Missing.failure("--stiff-turn says how the turn of the tool is chosen: give --free-turn, too (free_turn = \"stiff\" under [robot] says both)",
            ));
        }
        (true, false) => FreeTurnWord::Stiff,
        (false, true) if in_job == FreeTurnWord::AsStated => FreeTurnWord::Choose,
        (false, _) => in_job,
    };
    match (chosen, &flags.turn.turn_plot) {
        (FreeTurnWord::AsStated, Some(_)) => Err(ErrorCode::Missing.failure("--turn-plot draws the turn of the tool that is chosen along the path: give --free-turn, too (free_turn = \"choose\" under [robot])",
        )),
        _ => Ok(chosen),
    }
}

/// The program's file, of the command line or of the job.
pub(crate) fn program_path(job: Option<&JobFile>, flags: &ProgramArgs) -> Answer<PathBuf> {
    match (&flags.program, job.and_then(|j| j.job.program.as_ref())) {
        (Some(path), _) => Ok(path.clone()),
        (None, Some(written)) => Ok(job
            .map(JobFile::base)
            .unwrap_or_default()
            .join(written.get_ref())),
        (None, None) => Err(ErrorCode::Missing.failure(match job {
                Some(j) => format!(
                    "the job file '{}' names no program; write  program = \"part.ngc\"  at its top, or give --program FILE",
                    j.path.display()
                ),
                None => "no program is named; give a job file, or --program FILE".to_owned(),
            },
        )),
    }
}

/// Write options, and whether the tolerances of path and chords were stated.
fn tolerances(
    job: Option<&JobFile>,
    flags: &ProgramArgs,
    writing: &WritingFlags<'_>,
) -> Answer<(WriteOptions, [bool; 2])> {
    let tolerances = job.map(|j| j.job.tolerances.clone()).unwrap_or_default();
    let mut write = {
        let mut new_writing = WriteOptions::default();
        new_writing.again = writing.again;
        new_writing
    };
    let path_mm = chosen(
        job,
        "--tolerance-um",
        writing.tolerance_um,
        tolerances.path_um.as_ref(),
        micrometres,
    )?;
    let chord_mm = chosen(
        job,
        "--chord-tolerance-um",
        flags.chord_tolerance_um,
        tolerances.chord_um.as_ref(),
        micrometres,
    )?;
    write.tolerance_mm = path_mm.unwrap_or(write.tolerance_mm);
    write.chord_tolerance_mm = chord_mm.unwrap_or(write.chord_tolerance_mm);
    write.arcs = match writing.arcs.or(tolerances.arcs) {
        Some(ArcsWord::Lines) => Arcs::Lines,
        Some(ArcsWord::Fit) | None => Arcs::Fit,
    };
    write.min_block_mm = chosen(
        job,
        "--min-block-mm",
        writing.min_block_mm,
        tolerances.min_block_mm.as_ref(),
        |mm| match (1e-6..=1000.0).contains(&mm) {
            true => Ok(mm),
            false => Err(NotAllowed("0.000001 to 1000 mm are allowed")),
        },
    )?;
    if let Some(factor) = chosen(
        job,
        "--max-feed-factor",
        writing.max_feed_factor,
        tolerances.max_feed_factor.as_ref(),
        |factor| match (1.0..=1000.0).contains(&factor) {
            true => Ok(factor),
            false => Err(NotAllowed(
                "1 (never above the programmed feed) to 1000 are allowed",
            )),
        },
    )? {
        write.max_feed_factor = factor;
    }
    if let Some(mm) = chosen(
        job,
        "--backward-step-um",
        writing.backward_step_um,
        tolerances.backward_step_um.as_ref(),
        micrometres,
    )? {
        write.backward_step_mm = mm;
    }
    write.decimals = chosen(
        job,
        "--decimals",
        writing.decimals,
        tolerances.decimals.as_ref(),
        |decimals| {
            if (3..=8).contains(&decimals) {
                Ok(decimals)
            } else {
                Err(NotAllowed(
                    "3 to 8 decimals can be written; 4 keep the rounding below 0.1 micrometres",
                ))
            }
        },
    )?;
    Ok((write, [path_mm.is_some(), chord_mm.is_some()]))
}
