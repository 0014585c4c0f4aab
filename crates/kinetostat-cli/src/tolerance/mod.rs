//! `kinetostat tolerance`: how far results scatter when the machine is not exactly as drawn.
//!
//! It takes a model, a file of uncertainties, places and perhaps a load, and gives mean, spread and quantiles of many machines beside
//! linear propagation, a table of all machines and a histogram.

mod answer;
pub(crate) mod arguments;
mod text;

use std::f64::consts::PI;
use std::path::{Path, PathBuf};

use kinetostat::number::larger;
use kinetostat::{Pose, Wrench};
use kinetostat_analysis::tolerance::{
    CONFIDENCE, DependsOnMachine, Draws, Failures, Linear, MOST_DRAWS, OutputAnswer, Quantity,
    Samples, SobolIndex, Source, TaskError, UncertainMachine, UncertaintyFile, answers,
    can_be_kept, linearised, monte_carlo, sobol as sobol_of,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{Warning, WarningCode, straight_tool};
use kinetostat_model::Model;
use kinetostat_report::{Plot, PlotLine};

use crate::files::input_files::InputFiles;
use crate::files::outputs::{self, Existing, Outputs};
use crate::place::arguments::PlaceArgs;
use crate::place::query::{PlaceQuery, place_query_of};
use crate::tolerance::answer::{ColumnResult, PlaceResults, ToleranceAnswer};
use crate::tolerance::arguments::{Asked, ToleranceArgs};
use crate::ui::csv_table::{cell, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::progress::Progress;
use crate::ui::result_form::ResultForm;
use crate::ui::{json, threads};

impl From<TaskError> for Failure {
    fn from(error: TaskError) -> Self {
        match error {
            TaskError::Model(error) => error.into(),
            TaskError::Core(error) => error.into(),
            other => ErrorCode::NoAnswer.failure(other),
        }
    }
}

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<ToleranceAnswer>("scatter of results")];

pub(crate) fn run(args: &ToleranceArgs) -> Answer<()> {
    let (model, path) = InputFiles::default().model(&args.model, Path::new(""))?;
    model.require_stiffness()?;
    let queries = queries(args, &model, path.as_ref())?;
    let Some(first) = queries.first() else {
        return Err(ErrorCode::Missing.failure("give a place with --at"));
    };
    let study = Study::of(args, &model, &queries, &first.wrench)?;
    let inputs = path.iter().chain(&args.uncertain).cloned();
    let mut outputs = Outputs::new(Existing::forced(args.force_overwrite), inputs.collect());
    let csv = args.csv.as_ref().map(|p| outputs.claim("table", p));
    let csv = csv.transpose()?;
    let plot = args.plot.as_ref().map(|p| outputs.claim("plot", p));
    let plot = plot.transpose()?;
    let drawn = study.draw(args.threads)?;
    let columns = study.machine.columns();
    let answer = answer_of(
        args,
        &study,
        &drawn,
        first,
        in_places(&queries, drawn.results(&columns), columns.len()),
    );
    if let Some(index) = csv {
        let table = table(&study.file, &study.draws, &drawn.samples, &columns)?;
        outputs.fill(index, &table)?;
    }
    if let Some(index) = plot {
        let picture = picture(&answer, &drawn.samples);
        outputs.fill(index, picture.svg().as_bytes())?;
    }
    let paths = outputs.commit()?;
    let text = format!("{}{}", text::answer_text(&answer), outputs::written(&paths));
    json::print_answer(&text, &answer, args.json)
}

/// The places, each within the limits of the actuators as drawn.
fn queries(args: &ToleranceArgs, model: &Model, path: Option<&PathBuf>) -> Answer<Vec<PlaceQuery>> {
    let each: Vec<Option<Vec<f64>>> = match args.at.is_empty() {
        true => vec![None],
        false => args.at.chunks(3).map(|at| Some(at.to_vec())).collect(),
    };
    let query = |at| {
        let place = PlaceArgs {
            at,
            rotation: args.rotation.clone(),
            ..PlaceArgs::default()
        };
        let query = place_query_of(
            model,
            path.cloned(),
            &args.model,
            &place,
            args.tool_length_mm,
            args.force.as_deref(),
            args.moment.as_deref(),
        )?;
        match &query.followed {
            Some(_) => query.posture()?,
            // Drawn machines are commanded as this one is next to home, in no other configuration.
            None => query.mechanism.posture(&query.target)?,
        }
        .within_limits()?;
        Ok(query)
    };
    each.into_iter().map(query).collect()
}

/// Uncertain machine and its draws.
struct Study {
    file: UncertaintyFile,
    machine: UncertainMachine,
    draws: Draws,
    for_sobol: Option<Draws>,
}

/// Results of all machines.
struct Drawn {
    samples: Samples,
    /// Sobol indices of every result, and draws without a whole answer.
    sobol: Option<(Vec<Vec<SobolIndex>>, Failures)>,
    each: Vec<OutputAnswer>,
}

impl Study {
    fn of(
        args: &ToleranceArgs,
        model: &Model,
        queries: &[PlaceQuery],
        wrench: &Wrench,
    ) -> Answer<Self> {
        let file = match &args.uncertain {
            Some(path) => {
                let text = InputFiles::default().settings("uncertainties", path)?;
                UncertaintyFile::read(&text, &path.display().to_string(), model, wrench)?
            }
            None if model.document.uncertain.is_empty() => {
                return Err(ErrorCode::Missing.failure("what is uncertain? Give --uncertain FILE; this model states no uncertainties of its own, as one of `kinetostat identify` does"));
            }
            None => UncertaintyFile::read(&model.text, &model.file, model, wrench)?,
        };
        let quantities = quantities(args);
        let tool = straight_tool(1e-3 * args.tool_length_mm.unwrap_or(0.0));
        let poses: Vec<Pose> = queries.iter().map(|q| q.target).collect();
        let machine = UncertainMachine::new(model, &tool, &file, &poses, *wrench, &quantities)?;
        let count = args.machines.unwrap_or(4096);
        let draws = drawn("--machines", count, args, machine.width())?;
        let for_sobol = match args.sobol {
            Some(_) if file.uncertainties.is_correlated() => {
                return Err(ErrorCode::Conflict.failure("--sobol: parts of the variance belong to single numbers only where none are correlated; leave out the correlations, or --sobol",
                ));
            }
            Some(count) => {
                let width = machine.width() * (file.uncertainties.each().len() + 2);
                Some(drawn("--sobol", count, args, width)?)
            }
            None => None,
        };
        Ok(Self {
            file,
            machine,
            draws,
            for_sobol,
        })
    }

    fn draw(&self, count: Option<usize>) -> Answer<Drawn> {
        let progress = Progress::new();
        let (machine, numbers) = (&self.machine, &self.file.uncertainties);
        let work = || -> Answer<Drawn> {
            let samples = monte_carlo(machine, numbers, &self.draws, &progress)?;
            let sobol = self.for_sobol.as_ref();
            let sobol = sobol.map(|draws| sobol_of(machine, numbers, draws, &progress));
            let sobol = sobol.transpose()?;
            let lines: Vec<Linear> = linearised(machine, numbers)?;
            let each = answers(numbers, &self.draws, &samples, lines);
            Ok(Drawn {
                samples,
                sobol,
                each,
            })
        };
        let drawn = threads::in_threads(count, work)??;
        progress.finish();
        Ok(drawn)
    }
}

impl Drawn {
    fn results(&self, columns: &[&'static str]) -> Vec<ColumnResult> {
        let result = |(k, answer): (usize, &OutputAnswer)| ColumnResult {
            name: columns[k % columns.len()],
            answer: answer.clone(),
            sobol: self.sobol.as_ref().map(|(all, _)| all[k].clone()),
        };
        self.each.iter().enumerate().map(result).collect()
    }
}

/// Histogram of the first result at the first place.
fn picture(answer: &ToleranceAnswer, samples: &Samples) -> Plot {
    let shown = &answer.places[0].results[0];
    let linear = [
        shown.answer.linear.nominal,
        shown.answer.linear.standard_deviation,
    ];
    let title = format!(
        "{}: {} of {} machines",
        answer.model, shown.name, answer.machines
    );
    histogram(title, shown.name, &samples.column(0), linear)
}

fn quantities(args: &ToleranceArgs) -> Vec<Quantity> {
    let loaded = args.force.is_some() || args.moment.is_some();
    let all = match (args.only.is_empty(), loaded) {
        (true, true) => return Quantity::ALL.to_vec(),
        (true, false) => return vec![Quantity::Error, Quantity::Stiffness],
        _ => args.only.iter().map(|asked: &Asked| asked.quantity()),
    };
    Quantity::ALL
        .into_iter()
        .filter(|q| all.clone().any(|a| a == *q))
        .collect()
}

fn drawn(option: &str, count: usize, args: &ToleranceArgs, width: usize) -> Answer<Draws> {
    // The confidence interval of an index needs a few draws of each of the sequences.
    let least = if option == "--sobol" { 128 } else { 16 };
    if !(least..=MOST_DRAWS).contains(&count) {
        return Err(ErrorCode::Value.failure(format!(
            "{option} {count}: {least} to {MOST_DRAWS} can be drawn"
        )));
    }
    can_be_kept(count, width).map_err(|many| {
        ErrorCode::Value.failure(format!(
            "{option} {count}: with all places and results {many}; take fewer places or machines, or ask for less with --only"
        ))
    })?;
    Ok(Draws::new(count, args.seed.unwrap_or(0) as u64))
}

fn in_places(
    queries: &[PlaceQuery],
    results: Vec<ColumnResult>,
    columns: usize,
) -> Vec<PlaceResults> {
    let mut results = results.into_iter();
    let place = |query: &PlaceQuery| PlaceResults {
        position_mm: (query.target.translation.vector * 1e3).into(),
        results: results.by_ref().take(columns).collect(),
    };
    queries.iter().map(place).collect()
}

fn answer_of(
    args: &ToleranceArgs,
    study: &Study,
    drawn: &Drawn,
    query: &PlaceQuery,
    places: Vec<PlaceResults>,
) -> ToleranceAnswer {
    let wrench: Wrench = query.wrench;
    let numbers = &study.file.uncertainties;
    let shared = study.file.shared.iter();
    let shared = shared.map(|s| Warning::new(WarningCode::SharedNumber, s.description()));
    let scales = study.file.sources.contains(&Source::LoadFactor);
    let unloaded = (scales && wrench.0.iter().all(|x| *x == 0.0)).then(|| {
        let text = "load = \"factor\" is uncertain, and no load acts, so that it changes nothing: give --force or --moment, or leave it out";
        Warning::new(WarningCode::LoadNeverActs, text.to_owned())
    });
    let warnings = shared.chain(unloaded);
    let warnings = warnings.chain(query.warnings.iter().cloned()).collect();
    ToleranceAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: query.name.clone(),
        model_source: query.source.clone(),
        force_n: wrench.force().into(),
        moment_n_m: wrench.moment().into(),
        machines: study.draws.len(),
        seed: args.seed.unwrap_or(0) as u64,
        confidence: CONFIDENCE,
        uncertain: numbers.as_stated(),
        correlated: numbers.is_correlated(),
        failures: drawn.samples.failures.clone(),
        sobol_failures: drawn.sobol.as_ref().map(|(_, failed)| failed.clone()),
        places,
        warnings,
    }
}

/// One row for each machine: the numbers drawn, then the results, empty where there is none.
fn table(
    file: &UncertaintyFile,
    draws: &Draws,
    samples: &Samples,
    columns: &[&str],
) -> Answer<Vec<u8>> {
    let mut head: Vec<String> = vec!["machine".to_owned()];
    head.extend(file.uncertainties.each().iter().map(|u| u.name.clone()));
    let places = samples.width / columns.len().max(1);
    for place in 1..=places {
        head.extend(columns.iter().map(|c| format!("place_{place}_{c}")));
    }
    let mut rows = vec![head];
    for (machine, numbers) in samples.numbers.chunks(samples.width.max(1)).enumerate() {
        let values = file.uncertainties.drawn(draws, machine);
        let each = values.iter().chain(numbers).map(|x| cell(*x));
        rows.push(std::iter::once(machine.to_string()).chain(each).collect());
    }
    written(&rows)
}

/// Largest height of a linear density in the drawing, in heights of the histogram.
const NEEDLE: f64 = 5.0;

/// Densities over the values: that of the draws in steps, and a normal one of the linear propagation.
fn histogram(title: String, label: &str, values: &[f64], [nominal, deviation]: [f64; 2]) -> Plot {
    let mut known: Vec<f64> = values.iter().copied().filter(|x| x.is_finite()).collect();
    known.sort_unstable_by(f64::total_cmp);
    let (Some(low), Some(high)) = (known.first().copied(), known.last().copied()) else {
        return Plot {
            title,
            ..Plot::default()
        };
    };
    // The number of bars grows with the cube root of the draws, from ten to 80.
    let bars = ((2.0 * (known.len() as f64).cbrt()) as usize).clamp(10, 80);
    let width = (high - low) / bars as f64;
    let mut lines = Vec::new();
    let mut highest = 0.0;
    if width > 0.0 {
        let mut counts = vec![0.0; bars];
        for x in &known {
            counts[(((x - low) / width) as usize).min(bars - 1)] += 1.0;
        }
        let mut steps = vec![(low, 0.0)];
        for (k, count) in counts.iter().enumerate() {
            let density = count / (known.len() as f64 * width);
            highest = larger(highest, density);
            let left = low + width * k as f64;
            steps.extend([(left, density), (left + width, density)]);
        }
        steps.push((high, 0.0));
        lines.push(PlotLine::solid(
            format!("{} machines", known.len()),
            0,
            steps,
        ));
    }
    let peak = 1.0 / (deviation * (2.0 * PI).sqrt());
    // A linear scatter far below that of the machines would be a needle that hides them.
    if deviation > 0.0 && (highest == 0.0 || peak < NEEDLE * highest) {
        let at = |k: i32| {
            let z = f64::from(k) / 20.0;
            (nominal + z * deviation, peak * (-0.5 * z * z).exp())
        };
        // The length of a vector is never below zero, whatever a normal distribution says.
        let is_length = !["_x_", "_y_", "_z_"]
            .iter()
            .any(|axis| label.contains(axis));
        let possible = |point: &(f64, f64)| !is_length || point.0 >= 0.0;
        lines.push(PlotLine::dashed(
            "linear, normal",
            1,
            (-80..=80).map(at).filter(possible).collect(),
        ));
    }
    Plot {
        title,
        x_label: label.to_owned(),
        y_label: "density".to_owned(),
        lines,
        marks: Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use kinetostat::number::smaller;

    use super::*;

    #[test]
    fn a_length_is_never_below_zero_and_a_component_may_be() {
        let values: Vec<f64> = (0..100).map(|k| 0.01 + 1e-4 * f64::from(k)).collect();
        let least = |label: &str| {
            let plot = histogram(String::new(), label, &values, [0.01, 0.005]);
            let all = plot.lines.iter().flat_map(|line| line.points.iter());
            all.map(|point| point.0).fold(0.0, smaller)
        };
        assert!(least("error_mm") >= 0.0);
        assert!(least("error_x_mm") < -0.005);
    }
}
