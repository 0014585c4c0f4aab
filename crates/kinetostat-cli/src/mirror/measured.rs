//! Measurement of a trial, compared with the path.

use std::path::PathBuf;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_mirror::{
    MeasureSettings, MeasuredFile, MeasuredPoints, Measurement, NominalPath, Repeatability, measure,
};

use crate::files::csv_text::with_decimal_points;
use crate::files::input_files::{InputFiles, text_in};
use crate::job::job_file::JobFile;
use crate::job::program::read_program;
use crate::mirror::arguments::MirrorArgs;
use crate::mirror::asked::{asked, hash_of};
use crate::ui::failure::{Answer, Failing, Failure};

/// Standard deviations that a measurement of a point can have, um: an interferometer at rest, and a tape measure.
const FINEST_UM: f64 = 1e-3;
const COARSEST_UM: f64 = 1e3;

/// All measurements of this trial, compared with the path. The program that was measured follows its correction within a tolerance,
/// and kinks by twice that.
pub(crate) fn measurements(
    files: &InputFiles,
    job: Option<&JobFile>,
    args: &MirrorArgs,
    nominal: &NominalPath<'_>,
    settings: &MeasureSettings,
    hash: &str,
    tolerance_mm: f64,
) -> Answer<Vec<(MeasuredFile, Measurement)>> {
    let one = |path: &PathBuf| {
        let name = path.display().to_string();
        let is_table = path.extension().is_some_and(|e| e == "csv" || e == "txt");
        let points = match is_table {
            true => {
                let bytes = files.bytes("measurement", path)?;
                let text = text_in("measurement", path, bytes)?;
                MeasuredPoints::read(&name, &with_decimal_points(&text))?
            }
            false => {
                let second = asked(files, job, args, path)?;
                let read = read_program(&second)?;
                if let Some(line) = read.with(|program| program.mark_line()) {
                    return Err(ErrorCode::ProgramUnsuited.failure(format!(
                        "line {line}: the program is marked as compensated: its path is that of the commands, not of the machine, and its corrections would be mirrored as errors; give measured points, or a program of what was measured"
                    ))
                    .within(&name));
                }
                if hash_of(&second) == hash {
                    return Err(ErrorCode::ProgramUnsuited.failure("this is the program itself, which lies on its own path: nothing was measured; give measured points, or a program of what was measured",
                    )
                    .within(&name));
                }
                MeasuredPoints::along(read.path(), 0.1 * settings.smoothing_mm)
                    .map_err(|error| Failure::from(error).within(&name))?
            }
        };
        let file = MeasuredFile {
            name: path
                .file_name()
                .map_or_else(String::new, |n| n.to_string_lossy().into_owned()),
            sha256: points.sha256(),
        };
        let points = points
            .known_to(1e-3 * args.repeatability_um.unwrap_or(0.0))
            .known_to(tolerance_mm);
        let found = measure(nominal, &points, settings);
        Ok((file, found.map_err(|e| Failure::from(e).within(&name))?))
    };
    args.measured.iter().map(one).collect()
}

/// Repeatability as given, or from several measurements of this trial.
pub(crate) fn repeatability(
    args: &MirrorArgs,
    measured: &[(MeasuredFile, Measurement)],
) -> Answer<Option<Repeatability>> {
    match args.repeatability_um {
        Some(um) if (FINEST_UM..=COARSEST_UM).contains(&um) => {
            Ok(Some(Repeatability::OfPoints(1e-3 * um)))
        }
        Some(um) => Err(ErrorCode::Value.failure(format!(
                "--repeatability-um {um}: measurements repeat within {FINEST_UM} to {COARSEST_UM} um; give a standard deviation above 0, in micrometres"
            ),
        )),
        None => Ok(Repeatability::of_repeats(
            measured.iter().map(|(_, found)| found),
        )),
    }
}
