//! Input of a trial: the program, its settings and the state of the trials before.

use std::path::Path;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_mirror::{MeasureSettings, MirrorState, NominalPath, Register, Stations};

use crate::files::hash::{sha256, sha256_of_all};
use crate::files::input_files::InputFiles;
use crate::job::arguments::{ProgramArgs, WritingFlags};
use crate::job::feature_lines::refuse_lines_beyond;
use crate::job::job_file::JobFile;
use crate::job::of_model::give_of_model;
use crate::job::robot_arguments::CorrectWord;
use crate::job::setting::{Setting, setting};
use crate::mirror::arguments::MirrorArgs;
use crate::ui::failure::{Answer, Failing, Failure};

/// A program (that is drawn, or that was measured) and how it is read and written.
pub(crate) fn asked(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &MirrorArgs,
    program: &Path,
) -> Answer<Setting> {
    let flags = flags_of(args, program);
    let writing = WritingFlags {
        tolerance_um: args.tolerance_um,
        decimals: args.decimals,
        no_header: args.no_header,
        out: Some(&args.out),
        ..WritingFlags::default()
    };
    let mut setting = setting(files, job, &flags, &writing)?;
    if setting.flat.is_some() {
        return Err(setting.within(ErrorCode::ProgramUnsuited.failure("mirror takes programs without macros and in one piece, so that trials stay comparable: expand the program first (`kinetostat expand`), and mirror the flat one",
        )));
    }
    refuse_lines_beyond(job, &setting)?;
    let of_pose = args.robot.correct == Some(CorrectWord::Pose);
    if of_pose && !names_model(job) {
        return Err(ErrorCode::Unused.failure("--correct pose: measured points correct where the tool is, not how it stands; only a model does that (--job with a model)",
        ));
    }
    if names_model(job) {
        give_of_model(&mut setting, files, job, None, &flags)?;
    }
    setting.reading.tools = None;
    Ok(setting)
}

/// The job names a model, whose compensation comes first.
pub(crate) fn names_model(job: Option<&JobFile>) -> bool {
    job.is_some_and(|job| job.job.model.is_some())
}

/// Hash of the program with all files that determine its path: positions may be in a second file.
pub(crate) fn hash_of(setting: &Setting) -> String {
    let Some(robot) = &setting.robot else {
        return sha256(&setting.program);
    };
    let all: Vec<&[u8]> = robot.files.iter().map(|file| file.bytes()).collect();
    sha256_of_all(&all)
}

pub(crate) fn flags_of(args: &MirrorArgs, program: &Path) -> ProgramArgs {
    ProgramArgs {
        program: Some(program.to_owned()),
        reading: args.reading.clone(),
        robot: args.robot.clone(),
        force_overwrite: args.force_overwrite,
        limits: args.limits.clone(),
        ..ProgramArgs::default()
    }
}

/// Measurement settings of this trial, in lengths that its path allows; the registration may be that of earlier trials.
pub(crate) fn settings_of(
    args: &MirrorArgs,
    nominal: &NominalPath<'_>,
    before: Option<&MirrorState>,
) -> Answer<MeasureSettings> {
    let usual = MeasureSettings::default();
    let chosen = args.register.map(Register::from);
    let register = chosen.or(before.map(|state| state.settings.register)).ok_or_else(|| {
        ErrorCode::Missing.failure("how the points are registered is not stated, and what a registration takes away is not corrected: give --register none (points in the frame of the program), translation (a shift is not corrected), or rigid (a shift and a turn are not corrected)",
        )
    })?;
    if args.scale && register != Register::Rigid {
        return Err(ErrorCode::Unused.failure(format!(
                "--scale: a scale is sought besides a rigid motion, and the registration is '{}'; give --register rigid, or leave --scale out",
                register.word()
            ),
        ));
    }
    let settings = MeasureSettings {
        smoothing_mm: args.smoothing_mm.unwrap_or(usual.smoothing_mm),
        window_mm: args.window_mm.unwrap_or(usual.window_mm),
        align: args.align.map_or(usual.align, Into::into),
        register,
        scale: args.scale,
    };
    Stations::of(nominal, settings.smoothing_mm)
        .map_err(|error| Failure::from(error).within("--smoothing-mm"))?;
    match settings.window_mm > 0.0 {
        true => Ok(settings),
        false => Err(ErrorCode::Value.failure(format!(
            "--window-mm {}: a length above 0 is needed",
            settings.window_mm
        ))),
    }
}
