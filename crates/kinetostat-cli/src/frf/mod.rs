//! `kinetostat frf`: how the tool's tip answers to a harmonic force on it, over the frequency.
//!
//! It takes a model, a place, a load and damping, and gives entries of the 6 x 6 receptance (or mobility, accelerance).

mod answer;
pub(crate) mod arguments;
mod fit;
mod measured;
mod scaling;
mod text;

use kinetostat::number::larger;
use kinetostat_analysis::vibration::VibratingMachine;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::{Damping, Quantity, Receptance};
use kinetostat_machining::{Warning, WarningCode};

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::files::input_files::InputFiles;
use crate::frf::answer::{FrfAnswer, curves};
use crate::frf::arguments::{FrfArgs, QuantityWord};
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::number;
use crate::ui::result_form::ResultForm;
use crate::vibration::damping::words;
use crate::vibration::pair::{frequency_hz, growth_per_s};
use crate::vibration::subject;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] = &[ResultForm::of::<FrfAnswer>(
    "frequency responses of the tip",
)];

pub(crate) fn run(args: &FrfArgs) -> Answer<()> {
    let frequencies = frequencies(&args.frequencies)?;
    let entries = args.entries();
    makes_sense(args, &frequencies, &entries)?;
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
    warnings.extend(of(args, &machine, &damping, &frequencies));
    let receptance = response.over(&frequencies).map_err(subject::refused)?;
    let finite = |m: &Receptance| m.iter().all(|v| v.re.is_finite() && v.im.is_finite());
    if let Some(at) = receptance.iter().position(|m| !finite(m)) {
        return Err(ErrorCode::FreeDirection.failure(format!(
                "the tool has no finite response at {} Hz: a direction is free there, or a mode without damping",
                frequencies[at]
            ),
        ));
    }
    if args.outputs.plot.is_some() && !text::moves(&entries, &receptance) {
        return Err(ErrorCode::RigidDirection.failure("--plot: the tool moves along none of these axes (it is held, or the machine cannot move it there), and there is nothing to draw",
        ));
    }
    let asked: Vec<Receptance> = (receptance.iter().zip(&frequencies))
        .map(|(moved, hz)| moved * quantity.factor(std::f64::consts::TAU * hz))
        .collect();
    let fit = match args.fit {
        Some(modes) => Some(fit::answer(
            args,
            modes,
            &query,
            &machine,
            &damping,
            &measured.responses,
        )?),
        None => None,
    };
    let doubts = fit.iter().flat_map(|fit| fit.doubts.iter().cloned());
    warnings.extend(doubts.map(|words| Warning::new(WarningCode::Model, words)));
    let (natural_frequencies_hz, natural_growth_per_s) = natural(&machine)?;
    if args.fit.is_some() && natural_growth_per_s.is_some() {
        warnings.push(no_real_modes());
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

/// Checks the damping and the frequencies.
fn of(
    args: &FrfArgs,
    machine: &VibratingMachine,
    damping: &Damping,
    frequencies: &[f64],
) -> Vec<Warning> {
    let mut found = Vec::new();
    if args.modes.is_some() && machine.dynamics.modes_are_coupled_by(damping) {
        found.push("with --modes each mode has its own damping alone, and what couples modes is left out; without --modes the response is solved directly".to_owned());
    }
    if *damping == Damping::Undamped {
        found.push("without damping (--damping 0.03, for one) resonances have no height: peaks are as high as a frequency happens to lie near".to_owned());
    }
    let highest_hz = frequencies.iter().copied().fold(0.0, larger);
    if let Some(fastest_hz) = subject::far_below(machine, highest_hz) {
        found.push(format!(
            "frequencies go up to {} Hz, and the fastest mode of the model has {} Hz: what is said far beyond it says nothing of a real machine; check --frequencies",
            number(highest_hz, 4),
            number(fastest_hz, 4)
        ));
    }
    let warning = |words| Warning::new(WarningCode::Model, words);
    found.into_iter().map(warning).collect()
}

/// Measured modes beside a machine that has no real ones.
fn no_real_modes() -> Warning {
    Warning::new(
        WarningCode::NoPotential,
        "measured modes are compared with modes of the symmetric part of the stiffness: the loads have no potential, and real modes are none of this machine".to_owned(),
    )
}

/// Upper limit of the frequencies of a response.
const MOST: f64 = 200_000.0;

/// Refuses options that say nothing together.
pub(crate) fn makes_sense(
    args: &FrfArgs,
    frequencies: &[f64],
    entries: &[(usize, usize)],
) -> Answer<()> {
    let is_drawn = args.outputs.plot.is_some();
    if let ([one], true) = (frequencies, is_drawn || args.fit.is_some()) {
        return Err(ErrorCode::Conflict.failure(format!(
            "--frequencies names one frequency, {one} Hz; --plot and --fit need a band"
        )));
    }
    if is_drawn && !entries.iter().any(|(to, from)| *to < 3 && *from < 3) {
        return Err(ErrorCode::Unused.failure("--plot draws motions along axes by forces along axes; there is none among --to and --from",
        ));
    }
    Ok(())
}

/// Evenly spaced frequencies, Hz.
pub(crate) fn frequencies(of: &[f64]) -> Answer<Vec<f64>> {
    let &[low, high, count] = of else {
        return Err(ErrorCode::Value.failure("--frequencies needs LO HI N"));
    };
    if count == 1.0 && low == high && low >= 0.0 && low.is_finite() {
        return Ok(vec![low]);
    }
    if !(low >= 0.0 && high > low && high.is_finite()) {
        return Err(ErrorCode::Value.failure(format!(
                "--frequencies {low} {high}: frequencies in Hz are needed, the first not below 0 and the second above the first"
            ),
        ));
    }
    if !(2.0..=MOST).contains(&count) || count.fract() != 0.0 {
        return Err(ErrorCode::Value.failure(format!(
                "--frequencies: N is {count}; a whole number from 2 to {MOST} is needed, or 1 with the same frequency twice"
            ),
        ));
    }
    let count = count as usize;
    let step = (high - low) / (count - 1) as f64;
    Ok((0..count).map(|i| low + step * i as f64).collect())
}
