//! A program that is run in parts: surveyed, looked at, run, and put in place.

use std::fs::File;
use std::io::{BufReader, Read};
use std::time::{Duration, Instant};

use kinetostat_machining::{
    Envelope, FeatureResult, FileRead, OfWhole, Run, RunError, Warning, WarningCode, Watch,
    add_to_features, analyse_part, compensate_part, judge_features, look_at_part,
};
use kinetostat_model::Model;
use kinetostat_program::{Part, PartError, PartLength, Parts, Survey, WrittenSoFar};

use crate::files::origin;
use crate::job::arguments::ProgramArgs;
use crate::job::machine::MachineSetup;
use crate::job::output_paths::OutputPaths;
use crate::job::program::{PartRead, ReadProgram};
use crate::job::setting::Setting;
use crate::long::checkpoint::{Checkpoint, Manifest, State};
use crate::long::partial::Partial;
use crate::long::put_in_place::{LongFiles, checkpoint};
use crate::long::source::{Hashed, Surveyed, open};
use crate::long::which::part_length;
use crate::program::aim::Aim;
use crate::program::features::put_found;
use crate::program::outputs::RunOutputs;
use crate::program::points_table;
use crate::program::solve::{failure_of, too_many_blocks, with_task};
use crate::ui::failure::{Answer, Failure};
use crate::ui::progress::Progress;
use crate::ui::threads::in_threads;

/// How often what is done is kept.
const EVERY: Duration = Duration::from_secs(5);

/// A long program with all that is said about it.
pub(crate) struct LongRun<'a> {
    pub(crate) aim: Aim,
    pub(crate) machine: &'a MachineSetup,
    pub(crate) model: &'a Model,
    pub(crate) setting: &'a Setting,
    /// What only the whole program tells.
    pub(crate) survey: &'a Survey,
    pub(crate) flags: &'a ProgramArgs,
    /// Where the outputs go.
    pub(crate) targets: &'a OutputPaths,
}

/// What only the whole of a program tells; its hash takes the place of that of its first lines. `None` where it cannot be read,
/// or moves nothing: all that is wrong with it is said of the whole.
pub(crate) fn survey(setting: &mut Setting, aim: Aim) -> Answer<Option<Survey>> {
    let progress = Progress::new();
    progress.stage("reading", 0);
    let mut hashed = Hashed::new(open(setting)?);
    let from = BufReader::with_capacity(1 << 16, &mut hashed);
    let survey = match Survey::of(from, &setting.reading) {
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
    setting.within(Failure::input(error)).of_program()
}

impl<'a> LongRun<'a> {
    fn failed(&self, error: PartError) -> Failure {
        unread(self.setting, error)
    }

    fn parts(&self, length: PartLength) -> Answer<Parts<'a, BufReader<File>>> {
        Ok(self.parts_of(open(self.setting)?, length))
    }

    fn parts_of<R: Read>(&self, from: R, length: PartLength) -> Parts<'a, BufReader<R>> {
        let from = BufReader::with_capacity(1 << 16, from);
        Parts::new(from, (self.survey, &self.setting.reading), length)
    }

    /// What the run is: whatever its bytes depend on.
    fn manifest(&self, length: PartLength) -> Manifest {
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
                "the model",
                format!(
                    "{} {:016x}",
                    self.machine.run_inputs.model, self.machine.fingerprint
                ),
            ),
            (
                "the way in which the program is read",
                format!("{:#?}", s.reading),
            ),
            (
                "a tolerance, or how the program is written",
                format!("{:#?}", s.writing),
            ),
            ("the load", format!("{:#?}", self.machine.load)),
            (
                "the place of the part",
                format!("{:#?}", self.machine.placement),
            ),
            ("the tool", self.machine.run_inputs.tool.clone()),
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
            ("the length of the parts", format!("{length:?}")),
        ];
        Manifest(
            fields
                .map(|(name, value)| (name.to_owned(), value))
                .to_vec(),
        )
    }

    /// A part, as a run takes it.
    fn with_part<R>(
        &self,
        part: &Part,
        so_far: &WrittenSoFar<'_>,
        as_it_is: bool,
        work: impl FnOnce(&kinetostat_machining::Task<'_>) -> R,
    ) -> Answer<R> {
        let read = ReadProgram::Part(PartRead {
            part,
            so_far,
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

    /// Ctrl-C between two parts, and where parts that are done are read over.
    fn refuse_if_cancelled(&self, watch: &Progress) -> Answer<()> {
        match watch.cancelled() {
            true => Err(self.setting.within(Failure::from(RunError::Cancelled))),
            false => Ok(()),
        }
    }

    fn answered<T>(&self, result: Result<T, RunError>, part: &Part) -> Answer<T> {
        let with = (self.machine, self.model);
        result.map_err(|error| failure_of(error, with, self.setting, &part.path))
    }

    /// A first look at every part: what takes hours to be solved everywhere is refused in seconds.
    fn look(&self, length: PartLength, watch: &Progress) -> Answer<OfWhole> {
        let mut whole = OfWhole {
            moves: self.survey.moves,
            ..OfWhole::default()
        };
        let nothing = WrittenSoFar::nothing(self.survey, &self.setting.reading);
        watch.stage("first look", self.survey.lines);
        for part in self.parts(length)? {
            let part = part.map_err(|error| self.failed(error))?;
            self.refuse_if_cancelled(watch)?;
            let compensate = self.aim == Aim::Compensate;
            let looked = self.with_part(&part, &nothing, false, |task| {
                look_at_part(whole, task, compensate, watch)
            })?;
            whole = self.answered(looked, &part)?;
            watch.advance(part.next_line() - 1);
        }
        Ok(whole)
    }

    /// The run, from its outputs claimed to its result.
    pub(crate) fn run(self, outputs: &mut RunOutputs) -> Answer<(Run, LongFiles)> {
        let progress = Progress::new();
        let length = part_length(self.flags, self.model);
        let mut kept = checkpoint(self.targets);
        let opened = kept.open(&self.manifest(length), self.flags.restart);
        let begun = opened.and_then(|_| Work::go_on(&kept, self.survey, self.setting));
        let mut work = match begun {
            Ok(work) => work,
            Err(failure) => return Err(kept.left(failure)),
        };
        let done = self.work(&mut work, (&kept, length), outputs, &progress);
        if done.is_err() && work.state.parts > 0 && work.is_whole {
            // What can be kept is kept; why it ended is said.
            let _ = work.keep(&kept);
        }
        if let Err(failure) = done {
            return Err(kept.left(failure));
        }
        progress.finish();
        let reading = self.survey.warnings.iter();
        let reading =
            reading.map(|w| Warning::at_line(WarningCode::Program, w.line, w.text.clone()));
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
                .within(Failure::input("the program has no block")));
        };
        let found = too_many_blocks(self.setting, &result.summary);
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
        (kept, length): (&Checkpoint, PartLength),
        outputs: &RunOutputs,
        progress: &Progress,
    ) -> Answer<()> {
        let whole = match work.state.of_whole() {
            Some(whole) => whole,
            None => {
                let whole = in_threads(self.flags.threads, || self.look(length, progress))??;
                work.state.note(&whole);
                whole
            }
        };
        self.pass(work, (kept, length), whole, (outputs, progress))?;
        if !work.state.as_it_is && work.state.merged.leaves_as_it_is() {
            work.begin_anew(kept, (self.survey, self.setting), &whole)?;
            let whole = OfWhole {
                as_it_is: true,
                ..whole
            };
            self.pass(work, (kept, length), whole, (outputs, progress))?;
        }
        Ok(())
    }

    /// All parts that are not done yet.
    fn pass(
        &self,
        work: &mut Work<'a>,
        (kept, length): (&Checkpoint, PartLength),
        whole: OfWhole,
        (outputs, progress): (&RunOutputs, &Progress),
    ) -> Answer<()> {
        let count = self.survey.lines.div_ceil(length.own.max(1)).max(1);
        let every = match self.flags.part_lines {
            Some(_) => Duration::ZERO,
            None => EVERY,
        };
        let mut last = Instant::now();
        let surveyed = Surveyed::new(self.setting);
        let mut hashed = Hashed::new(open(self.setting)?);
        for (index, part) in self.parts_of(&mut hashed, length).enumerate() {
            // A part of a file that was changed meanwhile is never taken: what is kept is of one program.
            surveyed.refuse_if_touched()?;
            let part = part.map_err(|error| self.failed(error))?;
            self.refuse_if_cancelled(progress)?;
            if index < work.state.parts {
                continue;
            }
            let run = self.with_part(&part, &work.so_far, whole.as_it_is, |task| {
                let run = in_threads(self.flags.threads, || match self.aim {
                    Aim::Analyse => analyse_part(task, Some(&whole), progress),
                    Aim::Compensate => compensate_part(task, Some(&whole), progress),
                })?;
                let run = self.answered(run, &part)?;
                work.is_whole = false;
                work.state.merged.add(task, &run);
                let features = &mut work.state.features;
                let written = run.written.is_some();
                add_to_features(features, &run.points, |point| Some(point.line), written);
                Ok::<_, Failure>(run)
            })??;
            if let Some(written) = &run.written {
                work.program.append(&written.bytes)?;
                work.so_far
                    .advance(written)
                    .map_err(|error| self.failed(error))?;
            }
            if outputs.points.is_some() {
                let points = &mut work.points;
                let inputs = &run.result.run_inputs;
                points_table::part(
                    inputs,
                    &run.points,
                    (&outputs.listing, count, index == 0),
                    |bytes| points.append(bytes),
                )?;
            }
            work.state.parts = index + 1;
            work.is_whole = true;
            if last.elapsed() >= every || part.is_last {
                work.keep(kept)?;
                last = Instant::now();
            }
        }
        let same = surveyed.refuse_if_other(&hashed.sha256());
        if same.is_err() {
            // Changed without a trace, before the first look at its time: nobody knows what was done of which program.
            *work = Work::nothing(kept, self.survey, self.setting)?;
            kept.forget();
        }
        same
    }
}

/// What is done of a run.
struct Work<'s> {
    state: State,
    /// Result and files are those of the same parts: not while a part is being taken into them, which a full disk may end.
    is_whole: bool,
    so_far: WrittenSoFar<'s>,
    program: Partial,
    points: Partial,
}

impl<'s> Work<'s> {
    /// From the last state that is whole with its files, or from nothing.
    fn go_on(kept: &Checkpoint, survey: &'s Survey, setting: &'s Setting) -> Answer<Self> {
        for state in kept.states() {
            let program = Partial::reopen(kept.path("program"), state.program);
            let points = Partial::reopen(kept.path("points"), state.points);
            let (Some(program), Some(points)) = (program, points) else {
                continue;
            };
            let mut so_far = WrittenSoFar::nothing(survey, &setting.reading);
            if let Some(writer) = &state.writer
                && so_far.go_on(program.reader()?, writer.clone()).is_err()
            {
                continue;
            }
            return Ok(Self {
                state,
                is_whole: true,
                so_far,
                program,
                points,
            });
        }
        Self::nothing(kept, survey, setting)
    }

    fn nothing(kept: &Checkpoint, survey: &'s Survey, setting: &'s Setting) -> Answer<Self> {
        Ok(Self {
            state: State {
                features: FeatureResult::without_points(&setting.features),
                ..State::default()
            },
            is_whole: true,
            so_far: WrittenSoFar::nothing(survey, &setting.reading),
            program: Partial::create(kept.path("program"))?,
            points: Partial::create(kept.path("points"))?,
        })
    }

    /// Once more, with the program left as it is.
    fn begin_anew(
        &mut self,
        kept: &Checkpoint,
        (survey, setting): (&'s Survey, &'s Setting),
        whole: &OfWhole,
    ) -> Answer<()> {
        *self = Self::nothing(kept, survey, setting)?;
        self.state.as_it_is = true;
        self.state.note(whole);
        self.keep(kept)
    }

    /// Keeps how far it is, the files before the state that names their lengths.
    fn keep(&mut self, kept: &Checkpoint) -> Answer<()> {
        self.program.sync()?;
        self.points.sync()?;
        self.state.writer = self.so_far.writer().cloned();
        self.state.program = self.program.contents();
        self.state.points = self.points.contents();
        kept.keep(&self.state)
    }
}
