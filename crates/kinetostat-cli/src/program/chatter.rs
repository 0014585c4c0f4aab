//! Chatter along the program of a run: shared by `chatter`, and by the runs of a job with `[chatter]`.

use kinetostat_analysis::vibration::program::{
    ChatterQuestion, ProgramChatter, ProgramChatterError,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{Damping, Error};
use kinetostat_machining::{
    ChatterResult, CutQuestion, ForceAlongPath, Run, Task, Warning, WarningCode, Watch,
};
use kinetostat_model::Model;

use crate::job::chatter::ChatterSetting;
use crate::job::cut::along::stopped_or_within;
use crate::job::machine::MachineSetup;
use crate::job::setting::Setting;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::vibration::damping::{DampingArgs, words};
use crate::vibration::stability::{damped, implausible, left_out_warning};
use crate::vibration::subject;

/// Stretches of which a warning tells.
const TOLD: usize = 5;

/// Input of the chatter analysis besides the task.
pub(crate) struct Judging<'a> {
    pub(crate) cut: &'a CutQuestion,
    pub(crate) damping: Damping,
    /// Bodies that are points, as a warning.
    pub(crate) points: Option<Warning>,
    pub(crate) setting: &'a ChatterSetting,
}

impl<'a> Judging<'a> {
    /// Input of a run whose job requests the analysis.
    pub(crate) fn of_run(
        machine: &'a MachineSetup,
        model: &Model,
        setting: &'a Setting,
    ) -> Answer<Option<Self>> {
        let asked = setting.chatter.as_ref();
        let judging = asked.map(|asked| Self::of(machine, model, &DampingArgs::default(), asked));
        judging.transpose()
    }

    /// Options of damping go before the job, and that before the model.
    pub(crate) fn of(
        machine: &'a MachineSetup,
        model: &Model,
        options: &DampingArgs,
        setting: &'a ChatterSetting,
    ) -> Answer<Self> {
        let model = model.damping();
        let damping = damped(
            options,
            setting.damping.as_ref().unwrap_or(&model),
            "chatter needs",
        )?;
        let Some(cut) = &machine.cut else {
            return Err(ErrorCode::Missing.failure("the job says nothing of the cut: for chatter [material], a cutter of the tool, and [stock] or [engagement] are needed",
            ));
        };
        if machine.placement.orientation_follows {
            return Err(ErrorCode::ModelUnsuited.failure("the tool of this machine turns as it moves: chatter along a program is for machines that hold their tool as the program says",
            ));
        }
        Ok(Self {
            cut: &cut.question,
            damping,
            points: subject::point_bodies(&machine.mechanism),
            setting,
        })
    }

    /// Judges the cuts along the program.
    pub(crate) fn along(
        &self,
        task: &Task<'_>,
        forces: &ForceAlongPath,
        watch: &dyn Watch,
    ) -> Result<ProgramChatter, ProgramChatterError> {
        let question = ChatterQuestion {
            task,
            forces,
            cut: self.cut,
            damping: &self.damping,
            swinging: self.setting.swinging,
            every_mm: self.setting.every_mm,
            most: self.setting.most_places,
        };
        question.along(watch)
    }
}

/// Puts what was found into a run: the result, and warnings of lines that chatter and of places that are not judged.
pub(crate) fn put_chatter(run: &mut Run, found: &ProgramChatter, judging: &Judging<'_>) {
    let result = found.result(words(&judging.damping));
    run.result.warnings.extend(chattering(&result));
    run.result.warnings.extend(implausible(&judging.damping));
    run.result.warnings.extend(judging.points.clone());
    run.result.warnings.extend(limits(found, judging.setting));
    run.result.chatter = Some(result);
}

/// Lines that chatter.
fn chattering(result: &ChatterResult) -> Vec<Warning> {
    let stretches = &result.stretches;
    let told = stretches.iter().take(TOLD).map(|s| {
        let [first, last] = s.lines;
        let lines = match first == last {
            true => String::new(),
            false => format!(" to line {last}"),
        };
        let more = match stretches.len().checked_sub(TOLD) {
            Some(more @ 1..) if s == &stretches[TOLD - 1] => {
                format!("; {more} more stretches chatter")
            }
            _ => String::new(),
        };
        Warning::at_line(
            WarningCode::Chatters,
            first,
            format!(
                "the cut chatters{lines} at {:.0} turns per minute: {:.3} mm deep, stable up to {:.3} mm{more}",
                s.rpm, s.depth_mm, s.stable_depth_mm
            ),
        )
    });
    told.collect()
}

/// Warnings about the limits of the answer.
pub(crate) fn limits(found: &ProgramChatter, setting: &ChatterSetting) -> Vec<Warning> {
    let mut all = Vec::new();
    let mut say = |text: String| all.push(Warning::new(WarningCode::ChatterNotJudged, text));
    for (why, line, places) in found.not_judged() {
        say(format!(
            "{places} of {} places are not judged, the first on line {line}: {why}",
            found.places
        ));
    }
    if let Some(without) = &found.without_side {
        say(format!(
            "at {} places a force acts and the side of the tool is not in the cut (a plunge or drilling), up to {:.0} N on line {}: chatter is not judged there, check these lines by `kinetostat engagement`",
            without.places, without.force_n, without.line
        ));
    }
    let uneven = found.uneven();
    if uneven > 0 {
        say(format!(
            "at {uneven} of {} places the arc in contact differs with the height: the widest was taken for the whole depth, which is no bound",
            found.places
        ));
    }
    if let Some((left_out, site)) = found.left_out() {
        let at = format!("line {}", site.site.line);
        all.push(left_out_warning(
            &left_out,
            setting.swinging,
            &at,
            site.site.station.rpm,
        ));
    }
    all.extend(subject::lost_coupling(found.lost_coupling()));
    let mut say = |text: String| all.push(Warning::new(WarningCode::ChatterNotJudged, text));
    if found.wider > 1.0 {
        say(format!(
            "the cut changes so often that places that differ by {:.1} times more than usual were judged together, by their deepest cut, their widest arc and both ends: a place between them may be worse (--most-places)",
            found.wider
        ));
    }
    all
}

/// Converts an error to a failure, with the line of the program.
pub(crate) fn refused(error: ProgramChatterError, setting: &Setting) -> Failure {
    match error {
        // This fault does not depend on the line.
        ProgramChatterError::Machine {
            error: error @ Error::NoMass(_),
            ..
        } => subject::refused(error),
        ProgramChatterError::Machine { line, error } => {
            let mut failure = subject::refused(error);
            failure.plain = format!("line {line}: {}", failure.plain);
            failure.styled = None;
            setting.within(failure)
        }
        ProgramChatterError::Tool(failure) => stopped_or_within(failure, setting),
        ProgramChatterError::Cancelled => ErrorCode::Stopped.failure(error),
        other => setting.within(ErrorCode::ProgramUnsuited.failure(other)),
    }
}
