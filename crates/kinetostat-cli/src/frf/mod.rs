//! `kinetostat frf`: how the tool's tip answers to a harmonic force on it, over the frequency.
//!
//! It takes a model, a place, a load and damping, and gives entries of the 6 x 6 receptance (or mobility, accelerance).

mod answer;
pub(crate) mod arguments;
mod doubts;
mod fit;
mod fit_text;
mod measured;
mod question;
mod scaling;
mod text;

use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_dynamics::{Damping, Quantity, Receptance};
use kinetostat_machining::{Warning, WarningCode};

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::frf::answer::{FrfAnswer, curves};
use crate::frf::arguments::{FrfArgs, QuantityWord};
use crate::ui::failure::{Answer, Failure};
use crate::vibration::damping::words;
use crate::vibration::pair::{frequency_hz, growth_per_s};
use crate::vibration::subject;

pub(crate) fn run(args: &FrfArgs) -> Answer<()> {
    let frequencies = question::frequencies(&args.frequencies)?;
    let entries = args.entries();
    question::makes_sense(args, &frequencies, &entries)?;
    let query = subject::query(&args.machine)?;
    let damping = args.damping.law(&query.damping)?;
    let held = subject::held(args.hold.as_deref())?;
    let mut inputs = query.inputs.clone();
    inputs.extend(args.measured.clone());
    let files = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let measured = match &args.measured {
        Some(path) => measured::read(&InputFiles::default(), path)?,
        None => measured::Measured::default(),
    };
    let posture = query.posture()?;
    let machine = subject::machine(&query, &posture, &held)?;
    let response = machine
        .tool_receptance(&damping, args.modes)
        .map_err(subject::refused)?;
    let quantity = match args.quantity {
        QuantityWord::Receptance => Quantity::Displacement,
        QuantityWord::Mobility => Quantity::Velocity,
        QuantityWord::Accelerance => Quantity::Acceleration,
    };
    let mut warnings = query.warnings.clone();
    warnings.extend(subject::limits(&machine, &posture));
    warnings.extend(measured::warnings(&measured));
    warnings.extend(doubts::of(args, (&machine, &damping), &frequencies));
    let receptance = response.over(&frequencies).map_err(subject::refused)?;
    let finite = |m: &Receptance| m.iter().all(|v| v.re.is_finite() && v.im.is_finite());
    if let Some(at) = receptance.iter().position(|m| !finite(m)) {
        return Err(Failure::unanswered(format!(
            "the tool has no finite response at {} Hz: a direction is free there, or a mode without damping",
            frequencies[at]
        )));
    }
    if args.outputs.plot.is_some() && !text::moves(&entries, &receptance) {
        return Err(Failure::input(
            "--plot: the tool moves along none of these axes (it is held, or the machine cannot move it there), and there is nothing to draw",
        ));
    }
    let asked: Vec<Receptance> = (receptance.iter().zip(&frequencies))
        .map(|(moved, hz)| moved * quantity.factor(std::f64::consts::TAU * hz))
        .collect();
    let fit = match args.fit {
        Some(modes) => Some(fit::answer(
            args,
            modes,
            (&query, &machine, &damping),
            &measured.responses,
        )?),
        None => None,
    };
    let doubts = fit.iter().flat_map(|fit| fit.doubts.iter().cloned());
    warnings.extend(doubts.map(|words| Warning::new(WarningCode::Model, words)));
    let (natural_frequencies_hz, natural_growth_per_s) = natural(&machine)?;
    if args.fit.is_some() && natural_growth_per_s.is_some() {
        warnings.push(doubts::no_real_modes());
    }
    let answer = FrfAnswer {
        head: query.head(1),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        hold: args.hold.clone(),
        damping: words(&damping),
        solution: response.solution(),
        quantity: args.quantity.word(),
        natural_frequencies_hz,
        natural_growth_per_s,
        frequencies_hz: frequencies.clone(),
        curves: curves(&entries, args.quantity, &frequencies, &asked),
        measured: measured.responses.iter().map(|m| m.name.clone()).collect(),
        fit,
        warnings,
    };
    let shown = Shown {
        text: text::answer_text(
            &query,
            &answer,
            (args.outputs.plot.is_some())
                .then(|| text::not_drawn(&entries, &receptance))
                .flatten(),
        ),
        csv: text::table(&answer)?,
        svg: text::drawn(
            &answer,
            args.quantity,
            &entries,
            &receptance,
            &measured.responses,
        ),
        failure: None,
    };
    files.finish(&shown, &answer)
}

/// Frequencies of the machine without damping, Hz, and where its loads have no potential how fast these vibrations grow, 1/s.
fn natural(machine: &VibratingMachine) -> Answer<(Vec<f64>, Option<Vec<f64>>)> {
    let complex = machine
        .complex_modes(&Damping::Undamped, usize::MAX)
        .map_err(subject::refused)?;
    let Some(found) = complex else {
        return Ok((machine.modes.frequencies_hz(), None));
    };
    let of_pair = |pair| (frequency_hz(pair), growth_per_s(pair));
    let (hz, growth) = found.modes.iter().map(of_pair).unzip();
    Ok((hz, Some(growth)))
}
