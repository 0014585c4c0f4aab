//! A program that is run in parts: surveyed, looked at, run, and put in place.

use std::io::BufReader;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{
    Envelope, FileRead, OfWhole, Run, RunError, Warning, WarningCode, Watch, analyse_part,
    compensate_part, judge_features, look_at_part,
};
use kinetostat_model::Model;
use kinetostat_program::{
    GcodePart, Part, PartError, PartLength, Parts, PartsInOrder, PlaceInOrder, Standing, Survey,
    WrittenSoFar,
};

use crate::files::origin;
use crate::job::arguments::ProgramArgs;
use crate::job::machine::MachineSetup;
use crate::job::output_paths::OutputPaths;
use crate::job::over_part::tool_over_part;
use crate::job::program::{PartRead, ReadProgram};
use crate::job::setting::Setting;
use crate::long::checkpoint::{Checkpoint, Manifest};
use crate::long::put_in_place::{LongFiles, checkpoint};
use crate::long::side_by_side::side_by_side;
use crate::long::source::{Hashed, open};
use crate::long::work::Work;
use crate::program::aim::Aim;
use crate::program::features::put_found;
use crate::program::outputs::RunOutputs;
use crate::program::points_table;
use crate::program::solve::{failure_of, too_many_blocks, with_task};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::progress::Progress;

/// Interval between checkpoints.
const EVERY: Duration = Duration::from_secs(5);

/// A long program with all that is said about it.
pub(crate) struct LongRun<'a> {
    pub(crate) aim: Aim,
    pub(crate) machine: &'a MachineSetup,
    pub(crate) model: &'a Model,
    pub(crate) setting: &'a Setting,
    /// Survey of the whole program.
    pub(crate) survey: &'a Survey,
    pub(crate) flags: &'a ProgramArgs,
    /// Paths of the outputs.
    pub(crate) targets: &'a OutputPaths,
}

/// Surveys the whole program; its hash replaces that of its first lines. `None` where it cannot be read, or moves nothing: all
/// that is wrong with it is said of the whole.
pub(crate) fn survey(
    setting: &mut Setting,
    aim: Aim,
    length: PartLength,
) -> Answer<Option<Survey>> {
    let progress = Progress::new();
    progress.stage("reading", 0);
    let mut hashed = Hashed::new(open(setting)?);
    let from = BufReader::with_capacity(1 << 16, &mut hashed);
    let survey = match Survey::of(from, &setting.reading, length) {
        Err(PartError::Program(_)) => return Ok(None),
        found => found.map_err(|error| unread(setting, error))?,
    };
    if survey.moves == 0 {
        return Ok(None);
    }
    setting.lines_of_file = Some(survey.lines);
    if let Some(first) = setting.program_files.first_mut() {
        first.sha256 = hashed.sha256();
    }
    if let Some(line) = survey.mark_line
        && !setting.writing.again
        && aim == Aim::Compensate
    {
        let error = kinetostat_program::WriteError::AlreadyCompensated { line };
        return Err(setting.within(Failure::from(RunError::from(error))));
    }
    Ok(Some(survey))
}

fn unread(setting: &Setting, error: PartError) -> Failure {
    let failure = match error {
        PartError::Changed => ErrorCode::Checkpoint.failure("the program is another one than when the run began: its file was changed meanwhile, and nothing is written; give --restart to begin anew with the new program",
        ),
        error => ErrorCode::ProgramRefused.failure(error).of_program(),
    };
    setting.within(failure)
}

impl<'a> LongRun<'a> {
    /// A part. Of a file that was changed meanwhile none is taken: what is kept is of one program.
    fn part(&self, index: usize, watch: &Progress) -> Answer<Part> {
        self.refuse_if_cancelled(watch)?;
        let from = BufReader::with_capacity(1 << 16, open(self.setting)?);
        let part = Parts::of(self.survey, &self.setting.reading).read(index, from);
        part.map_err(|error| unread(self.setting, error))
    }

    /// Identity of the run: all that its bytes depend on.
    fn manifest(&self) -> Manifest {
        let s = self.setting;
        let hashes = |files: &[FileRead]| {
            let all = files
                .iter()
                .map(|file| format!("{} {}", file.name, file.sha256));
            all.collect::<Vec<_>>().join(", ")
        };
        let fields = [
            (
                "the version of kinetostat",
                env!("CARGO_PKG_VERSION").to_owned(),
            ),
            ("the command", format!("{:#?}", self.aim)),
            ("the program", hashes(&s.program_files)),
            (
                "the way in which the program is read",
                format!("{:#?}", s.reading),
            ),
            (
                "a tolerance, or how the program is written",
                format!("{:#?}", s.writing),
            ),
            ("a limit", format!("{:#?}", s.limits)),
            (
                "the list of points",
                format!("{:#?}", (self.flags.all_points, &self.targets.points)),
            ),
            (
                "the compensated program's name",
                format!("{:#?}", self.targets.program),
            ),
            ("the features", format!("{:#?}", s.features)),
            ("the length of the parts", {
                let PartLength { own, beside } = self.survey.length;
                format!("{own} lines and {beside} beside them")
            }),
        ];
        let mut manifest = Manifest::of_machine(Some(self.machine));
        let own = fields.map(|(name, value)| (name.to_owned(), value));
        manifest.0.extend(own);
        manifest
    }

    /// A part, as a run takes it.
    fn with_part<R>(
        &self,
        part: &Part,
        place: &PlaceInOrder<'_, '_>,
        as_it_is: bool,
        work: impl FnOnce(&kinetostat_machining::Task<'_>) -> R,
    ) -> Answer<R> {
        let read = ReadProgram::Part(PartRead {
            part,
            program: &GcodePart { part, place },
            setting: self.setting,
        });
        with_task(self.aim, self.machine, self.setting, &read, None, |task| {
            let mut task = task.clone();
            if as_it_is {
                // A copy is no compensated program.
                task.writing.header = None;
            }
            work(&task)
        })
    }

    /// Ctrl-C between two parts.
    fn refuse_if_cancelled(&self, watch: &Progress) -> Answer<()> {
        match watch.cancelled() {
            true => Err(self.setting.within(Failure::from(RunError::Cancelled))),
            false => Ok(()),
        }
    }

    fn answered<T>(&self, result: Result<T, RunError>, part: &Part) -> Answer<T> {
        result
            .map_err(|error| failure_of(error, self.machine, self.model, self.setting, &part.path))
    }

    /// A first look at every part: what takes hours to be solved everywhere is refused in seconds.
    fn look(&self, progress: &Progress) -> Answer<OfWhole> {
        let whole = OfWhole {
            moves: self.survey.moves,
            ..OfWhole::default()
        };
        let found = Mutex::new(whole);
        let compensate = self.aim == Aim::Compensate;
        progress.stage("first look", self.survey.lines);
        let nothing = WrittenSoFar::nothing(self.survey, &self.setting.reading);
        let order = PartsInOrder::from(0, nothing);
        let threads = self.flags.threads;
        side_by_side(
            |index| self.part(index, progress),
            &order,
            self.survey.part_count(),
            threads,
            progress,
            |part, place, watch| {
                let looked = self.with_part(part, place, false, |task| {
                    look_at_part(whole, task, compensate, watch)
                })?;
                let looked = self.answered(looked, part)?;
                if place.wait_for_turn() != Standing::Next {
                    return Ok(false);
                }
                locked(&found).add(&looked);
                progress.advance(part.next_line() - 1);
                Ok(true)
            },
        )?;
        Ok(found.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// The run, from its outputs claimed to its result.
    pub(crate) fn run(self, outputs: &mut RunOutputs) -> Answer<(Run, LongFiles)> {
        // Programs that turn the tool are run as a whole: this one has positions only.
        let stands = tool_over_part(self.machine, true);
        let stands = stands.map_err(|failure| self.setting.within(failure))?;
        let progress = Progress::new();
        let mut kept = checkpoint(self.targets);
        let opened = kept.open(&self.manifest(), self.flags.restart);
        let begun = opened.and_then(|_| Work::go_on(&kept, self.survey, self.setting));
        let mut work = match begun {
            Ok(work) => work,
            Err(failure) => return Err(kept.left(failure)),
        };
        let done = self.work(&mut work, &kept, outputs, &progress);
        if done.is_err() && work.state.parts > 0 && work.is_whole {
            // Saves a checkpoint and returns the original error.
            let _ = work.keep(&kept);
        }
        if let Err(failure) = done {
            return Err(kept.left(failure));
        }
        progress.finish();
        let reading = self.survey.warnings.iter();
        let reading = reading.map(|w| Warning::of_program(WarningCode::Program, w));
        let Work {
            state,
            program,
            points,
            ..
        } = work;
        let result = state.merged.finish(reading.collect());
        let Some(mut result) = result else {
            return Err(self
                .setting
                .within(ErrorCode::ProgramUnsuited.failure("the program has no block")));
        };
        result.warnings.extend(stands);
        result.warnings.extend(self.machine.not_carried.clone());
        let found = too_many_blocks(self.setting, result.summary.blocks_per_second);
        result.warnings.extend(found);
        let (written, allowed_mm) = match self.aim {
            Aim::Analyse => (false, self.setting.writing.tolerance_mm),
            Aim::Compensate => (true, result.tolerance.allowed_mm),
        };
        let mut features = state.features;
        judge_features(&mut features, &self.setting.features, allowed_mm, written);
        put_found(&mut result, features);
        // Comments of a job may be others than when the run began.
        if let Some(job) = &self.setting.job_file {
            let files = result.run_inputs.files.iter_mut();
            let of_job = files.filter(|file| file.what == job.what);
            of_job.for_each(|file| file.clone_from(job));
        }
        // The day on which it was finished.
        result.run_inputs.date = origin::day();
        let mut envelope = Envelope::default();
        envelope.extend(&result.points);
        let run = Run {
            points: result.points.clone(),
            envelope,
            result,
            written: None,
            places: Vec::new(),
        };
        Ok((
            run,
            LongFiles {
                program,
                points,
                kept,
            },
        ))
    }

    fn work(
        &self,
        work: &mut Work<'a>,
        kept: &Checkpoint,
        outputs: &RunOutputs,
        progress: &Progress,
    ) -> Answer<()> {
        let whole = match work.state.of_whole() {
            Some(whole) => whole,
            None => {
                let whole = self.look(progress)?;
                work.state.note(&whole);
                whole
            }
        };
        self.pass(work, kept, whole, outputs, progress)?;
        if !work.state.as_it_is && work.state.merged.leaves_as_it_is() {
            work.begin_anew(kept, self.survey, self.setting, &whole)?;
            let whole = OfWhole {
                as_it_is: true,
                ..whole
            };
            self.pass(work, kept, whole, outputs, progress)?;
        }
        Ok(())
    }

    /// All parts that are not done yet.
    fn pass(
        &self,
        work: &mut Work<'a>,
        kept: &Checkpoint,
        whole: OfWhole,
        outputs: &RunOutputs,
        progress: &Progress,
    ) -> Answer<()> {
        let every = match self.flags.part_lines {
            Some(_) => Duration::ZERO,
            None => EVERY,
        };
        let (count, done) = (self.survey.part_count(), work.state.parts);
        progress.stage(
            match self.aim {
                Aim::Analyse => "lines solved",
                Aim::Compensate => "lines corrected and solved again",
            },
            self.survey.lines,
        );
        let nothing = WrittenSoFar::nothing(self.survey, &self.setting.reading);
        let order = PartsInOrder::from(done, std::mem::replace(&mut work.so_far, nothing));
        let taking = Mutex::new((&mut *work, Instant::now()));
        let threads = self.flags.threads;
        side_by_side(
            |index| self.part(index, progress),
            &order,
            count,
            threads,
            progress,
            |part, place, watch| {
                self.with_part(part, place, whole.as_it_is, |task| {
                    let run = match self.aim {
                        Aim::Analyse => analyse_part(task, Some(&whole), watch),
                        Aim::Compensate => compensate_part(task, Some(&whole), watch),
                    };
                    let mut run = self.answered(run, part)?;
                    let begins = part.first_line() == 1;
                    let mut rows = self.rows(&run, outputs, count, begins)?;
                    if place.wait_for_turn() != Standing::Next {
                        return Ok(false);
                    }
                    let (work, last) = &mut *locked(&taking);
                    if work.state.merged.join(task, &mut run) {
                        rows = self.rows(&run, outputs, count, begins)?;
                    }
                    work.take(task, run, &rows)?;
                    progress.advance(part.next_line() - 1);
                    if last.elapsed() >= every || part.is_last {
                        work.keep(kept)?;
                        *last = Instant::now();
                    }
                    Ok(true)
                })?
            },
        )
    }

    /// The rows of a part in the table of points, if there is to be one.
    fn rows(&self, run: &Run, outputs: &RunOutputs, count: usize, begins: bool) -> Answer<Vec<u8>> {
        let mut rows = Vec::new();
        if outputs.points.is_some() {
            points_table::part(
                &run.result.run_inputs,
                &run.points,
                &outputs.listing,
                count,
                begins,
                |bytes| {
                    rows.extend_from_slice(bytes);
                    Ok(())
                },
            )?;
        }
        Ok(rows)
    }
}

fn locked<T>(state: &Mutex<T>) -> MutexGuard<'_, T> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
