//! The band of the errors of a program over many machines.

use kinetostat_machining::{BandPlace, ScatteredError, UncertaintyBand, Watch};

use crate::along_program::UncertainRun;
use crate::draws::Draws;
use crate::file::UncertaintyFile;
use crate::linear::Linear;
use crate::machine::TaskError;
use crate::statistics::{CONFIDENCE, quantile};
use crate::study::{OutputAnswer, Samples, answers, linearised, monte_carlo};

/// Shares of the machines between which a band lies, and its middle.
const BAND: [f64; 3] = [0.05, 0.5, 0.95];

/// Draws machines and gives the band of the errors; `name` is that of the file, `seed` that of the draws.
///
/// # Errors
/// [`TaskError`] where a machine next to the drawing is none, or the watch stops the work.
pub fn band(
    run: &UncertainRun,
    file: &UncertaintyFile,
    name: &str,
    seed: u64,
    draws: &Draws,
    watch: &dyn Watch,
) -> Result<UncertaintyBand, TaskError> {
    let samples = monte_carlo(run, &file.uncertainties, draws, watch)?;
    let each = run.columns();
    let mut lines: Vec<Linear> = linearised(run, &file.uncertainties)?;
    // Only the largest errors are propagated linearly; places have quantiles.
    lines.truncate(each);
    let largest = answers(&file.uncertainties, draws, &samples, lines);
    let mut band = UncertaintyBand::default();
    name.clone_into(&mut band.file);
    band.uncertain = file.uncertainties.as_stated();
    band.machines = draws.len();
    band.unanswered = samples.failures.no_machine + samples.failures.no_answer;
    band.unstable = samples.failures.unstable;
    band.seed = seed;
    band.confidence = CONFIDENCE;
    band.places = places(run, &samples);
    let mut scattered = largest.iter().map(scattered);
    band.before = scattered.next().unwrap_or_default();
    band.after = scattered.next();
    Ok(band)
}

fn scattered(answer: &OutputAnswer) -> ScatteredError {
    let draws = &answer.draws;
    let high = draws.quantiles.iter().find(|q| q.share == BAND[2]);
    ScatteredError {
        as_drawn_mm: answer.linear.nominal,
        mean_mm: draws.mean.value,
        deviation_mm: draws.standard_deviation.value,
        deviation_plus_minus_mm: draws.standard_deviation.plus_minus,
        low_mm: draws.quantile(BAND[0]),
        high_mm: draws.quantile(BAND[2]),
        high_at_most_mm: high.and_then(|q| q.high),
        deviation_by_line_mm: answer.linear.standard_deviation,
        linear_is_enough: answer.verdict.linear_is_enough,
    }
}

fn places(run: &UncertainRun, samples: &Samples) -> Vec<BandPlace> {
    let each = run.columns();
    let of_column = |column: usize| -> [f64; 3] {
        let mut values = samples.column(column);
        values.retain(|x| x.is_finite());
        values.sort_unstable_by(f64::total_cmp);
        BAND.map(|share| quantile(&values, share).value)
    };
    let place = |(i, place): (usize, &kinetostat_machining::ProgramPlace)| BandPlace {
        line: place.line,
        path_mm: place.path_mm,
        before_mm: of_column(each * (i + 1)),
        after_mm: (each > 1).then(|| of_column(each * (i + 1) + 1)),
    };
    run.places().iter().enumerate().map(place).collect()
}
