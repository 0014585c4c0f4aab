//! `kinetostat lobes`: at which spindle speed and depth a milling cut of a machine chatters at a place.
//!
//! It takes a model, a place, a load, damping, a tool and a cut, and gives exact limits over the spindle speed, with those
//! of zeroth order beside them under their own name.

mod answer;
pub(crate) mod arguments;
mod coefficients;

use kinetostat::Pose;
use kinetostat_analysis::vibration::{MachineCut, MachineCutError, VibratingMachine};
use kinetostat_chatter::{Arc, FeedFrame, LobeRequest, Milled, MillingCut, Swinging};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Held;
use kinetostat_machining::{Warning, WarningCode};
use kinetostat_report::lobes_svg;
use nalgebra::Vector3;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::lobes::answer::{Best, LobesAnswer};
use crate::lobes::arguments::LobesArgs;
use crate::lobes::coefficients::CutCoefficients;
use crate::options::vector;
use crate::place::query::PlaceQuery;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::given::Given;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{number, short, triple};
use crate::ui::result_form::ResultForm;
use crate::ui::warnings;
use crate::vibration::damping::words;
use crate::vibration::stability::{damped, implausible, instability, left_out_warning};
use crate::vibration::subject;

/// Modes up to this frequency vibrate whether they count or not, Hz.
const AT_LEAST_HZ: f64 = 1000.0;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<LobesAnswer>("stability lobes of a cut")];

pub(crate) fn run(args: &LobesArgs, given: &Given) -> Answer<()> {
    refuse_unused(args, given)?;
    let (cut, coefficients) = cut(args)?;
    let request = request(args)?;
    let query = subject::query(&args.machine)?;
    let damping = damped(&args.damping, &query.damping, "lobes need")?;
    let mut inputs = query.inputs.clone();
    inputs.extend(args.material.materials.clone());
    let files = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let frame = frame(args, &query.target)?;
    let posture = query.posture()?;
    let machine = subject::machine(&query, &posture, &Held::nothing())?;
    let asked = args.modes_up_to_hz;
    let swinging = asked.map_or(Swinging::AtLeastTo(AT_LEAST_HZ), Swinging::UpTo);
    let regeneration = MachineCut {
        machine: &machine,
        damping: &damping,
        frame,
        cut,
        swinging,
    }
    .regeneration()
    .map_err(refused)?;
    let diagram = regeneration
        .lobes(&request)
        .map_err(|e| ErrorCode::NoAnswer.failure(format!("lobes: {e}")))?;
    let mut warnings = query.warnings.clone();
    warnings.extend(subject::limits(&machine, &posture));
    let band_hz = diagram.modes_up_to_hz();
    // The last one is compared with itself, whose digits are those of another sum.
    let in_band = |hz: &f64| *hz <= band_hz * (1.0 + 1e-9);
    let modes_hz = machine.modes.frequencies_hz();
    let modes_hz: Vec<f64> = modes_hz.into_iter().filter(in_band).collect();
    if let Some((left_out, rpm)) = diagram.left_out() {
        let at = format!("at {} rpm", number(rpm, 4));
        warnings.push(left_out_warning(&left_out, swinging, &at, rpm));
    }
    let off = machine.lost_coupling(&damping, band_hz);
    warnings.extend(subject::lost_coupling(off.map_err(subject::refused)?));
    warnings.extend(implausible(&damping));
    warnings.extend(coefficients.warnings.iter().cloned());
    warnings.extend(beyond_all_modes(&request, args.teeth, &machine));
    if let Some((speed, why)) = diagram.without_answer.first() {
        warnings.push(Warning::new(
            WarningCode::ChatterNotJudged,
            format!(
                "no limit was found at {} of {} speeds, the first at {speed:.1} rpm: {why}",
                diagram.without_answer.len(),
                diagram.without_answer.len() + diagram.points.len()
            ),
        ));
    }
    let axis = |k: usize| frame.rotation().column(k).into_owned();
    let answer = LobesAnswer {
        head: query.head(1),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        damping: words(&damping),
        feed_direction: axis(0).into(),
        tool_axis: axis(2).into(),
        teeth: args.teeth,
        immersion: args.immersion,
        milled: if args.up { "up" } else { "down" },
        coefficients_n_per_mm2: match args.coefficients_n_per_mm2.is_empty() {
            true => coefficients.n_per_mm2(),
            // Coefficients of options are shown without rounding.
            false => args.coefficients_n_per_mm2.clone(),
        },
        material: coefficients
            .of_material
            .as_ref()
            .map(|(name, _)| name.clone()),
        chip_mm: coefficients
            .of_material
            .as_ref()
            .map(|(_, chip_mm)| *chip_mm),
        modes_hz,
        depth_limit_mm: args.depth_mm,
        modes_up_to_hz: band_hz,
        best: answer::Best::of(&diagram),
        points: answer::points(&diagram),
        warnings,
    };
    let title = format!("{}: depth of cut at which the tool chatters", query.name);
    let shown = Shown {
        text: answer_text(&query, &answer),
        csv: table(&answer)?,
        svg: lobes_svg(&diagram, &title),
        failure: None,
    };
    files.finish(&shown, &answer)
}

/// Warns of teeth that pass far above all modes: the spindle speed is a slip, or modes of spindle and tool are missing.
fn beyond_all_modes(
    request: &LobeRequest,
    teeth: usize,
    machine: &VibratingMachine,
) -> Option<Warning> {
    let passing_hz = request.to_rpm * teeth as f64 / 60.0;
    let fastest_hz = subject::far_below(machine, passing_hz)?;
    Some(Warning::new(
        WarningCode::Model,
        format!(
            "at {} rpm the teeth pass at {} Hz, and the fastest mode of the model has {} Hz: no limit there says anything of a real spindle; check --rpm and --teeth",
            number(request.to_rpm, 4),
            number(passing_hz, 4),
            number(fastest_hz, 4)
        ),
    ))
}

fn cut(args: &LobesArgs) -> Answer<(MillingCut, CutCoefficients)> {
    let milled = match args.up && !args.climb {
        true => Milled::Up,
        false => Milled::Down,
    };
    let arc =
        Arc::straight(milled, args.immersion).map_err(|error| ErrorCode::Value.failure(error))?;
    let coefficients = CutCoefficients::of(args, &arc)?;
    let cut = MillingCut::new(args.teeth, arc, coefficients.law)
        .map_err(|error| ErrorCode::Value.failure(error))?;
    let cut = match (args.helix_deg, args.diameter_mm) {
        (None, _) => Ok(cut),
        (Some(_), None) => Err(ErrorCode::Missing
            .failure("--helix-deg needs --diameter-mm: the edge lags behind its tip by both")),
        (Some(helix), Some(diameter)) => cut
            .with_helix(helix.to_radians(), 1e-3 * diameter)
            .map_err(|error| ErrorCode::Value.failure(error)),
    };
    Ok((cut?, coefficients))
}

fn request(args: &LobesArgs) -> Answer<LobeRequest> {
    let &[low, high, count] = args.rpm.as_slice() else {
        return Err(ErrorCode::Value.failure("--rpm needs LO HI N"));
    };
    let one = count == 1.0 && low == high && low > 0.0 && low.is_finite();
    if one && args.outputs.plot.is_some() {
        return Err(ErrorCode::Unused
            .failure("--plot draws limits over the spindle speed; --rpm names one speed"));
    }
    if !one && (!(2.0..=20_000.0).contains(&count) || count.fract() != 0.0) {
        return Err(ErrorCode::Value.failure(format!(
                "--rpm: N is {count}; a whole number from 2 to 20000 is needed, or 1 with the same speed twice"
            ),
        ));
    }
    let rising = low > 0.0 && high > low && high.is_finite();
    if !(one || rising) {
        return Err(ErrorCode::Value.failure(format!(
            "--rpm {low} {high}: spindle speeds above 0 are needed, the second above the first"
        )));
    }
    if !(args.depth_mm > 0.0 && args.depth_mm <= 1e3) {
        return Err(ErrorCode::Value.failure(format!(
            "--depth-mm is {}; a depth above 0 and of at most 1000 mm is needed",
            args.depth_mm
        )));
    }
    Ok(LobeRequest::new(
        low,
        high,
        count as usize,
        1e-3 * args.depth_mm,
    ))
}

/// Feed, and the tool's axis: z of the tool's tip points out of the spindle.
fn frame(args: &LobesArgs, target: &Pose) -> Answer<FeedFrame> {
    let axis = match &args.tool_axis {
        Some(axis) => vector("--tool-axis", axis)?,
        None => target.rotation * -Vector3::z(),
    };
    let feed = vector("--feed-direction", &args.feed_direction)?;
    FeedFrame::new(feed, axis).map_err(|error| ErrorCode::Value.failure(error))
}

fn refused(error: MachineCutError) -> Failure {
    match error {
        MachineCutError::Machine(error) => subject::refused(error),
        MachineCutError::Cut(error) => ErrorCode::Value.failure(error),
        _ => ErrorCode::NoAnswer.failure(error),
    }
}

/// Refuses options of a material where coefficients are given, and a diameter that nothing depends on.
fn refuse_unused(args: &LobesArgs, given: &Given) -> Answer<()> {
    if !args.coefficients_n_per_mm2.is_empty() {
        given.refuse(
            &[
                "--feed-per-tooth-mm",
                "--materials",
                "--rake-deg",
                "--wear",
                "--coolant",
                "--edge",
                "--correct-speed",
                "--process-factor",
            ],
            "corrects the coefficients of a material, and --coefficients-n-per-mm2 states them: leave one of them out",
        )?;
    }
    if args.helix_deg.is_none() && !args.material.correct_speed {
        given.refuse(
            &["--diameter-mm"],
            "has an effect with a helix and with the correction for the cutting speed alone: add --helix-deg or --correct-speed, or leave it out",
        )?;
    }
    Ok(())
}

/// Upper limit of the speeds shown to a person; JSON, table and drawing have all.
const SHOWN: usize = 25;

fn answer_text(query: &PlaceQuery, a: &LobesAnswer) -> String {
    let mut out = query.heading();
    out.push_str(&wrapped(
        &format!(
            "{}-milling, {} teeth, immersion {}, feed along {}, tool axis {}, {} N/mm^2{}; damping: {}; {} modes up to {} Hz.",
            a.milled,
            a.teeth,
            a.immersion,
            triple(a.feed_direction, |x| number(x, 3)),
            triple(a.tool_axis, |x| number(x, 3)),
            a.coefficients_n_per_mm2
                .iter()
                .map(|x| short(*x))
                .collect::<Vec<_>>()
                .join(" "),
            a.material.as_ref().zip(a.chip_mm).map_or_else(String::new, |(name, chip_mm)| format!(
                " ({name}, chips of {} mm)",
                number(chip_mm, 3)
            )),
            a.damping,
            a.modes_hz.len(),
            number(a.modes_hz.last().copied().unwrap_or(f64::NAN), 4)
        ),
        0,
    ));
    out.push('\n');
    let mut rows = vec![
        [
            "rpm",
            "stable to, mm",
            "then",
            "chatter, Hz",
            "zeroth order, mm",
        ]
        .map(str::to_owned)
        .to_vec(),
    ];
    let every = a.points.len().div_ceil(SHOWN);
    for p in a.points.iter().step_by(every) {
        rows.push(vec![
            number(p.speed_rpm, 5),
            p.limit_mm.map_or_else(
                || format!("all {}", short(a.depth_limit_mm)),
                |x| number(x, 4),
            ),
            instability(p.kind).to_owned(),
            p.chatter_hz.map_or_else(String::new, |x| number(x, 4)),
            p.zeroth_order_mm.map_or_else(String::new, |x| number(x, 4)),
        ]);
    }
    out.push_str(&columns(&rows, 0));
    if every > 1 {
        out.push_str(&wrapped(
            &format!(
                "One speed in {every} is shown of {}; files have all.",
                a.points.len()
            ),
            0,
        ));
    }
    if let Some(best) = &a.best {
        out.push_str(&wrapped(&deepest(best, a.points.len()), 0));
    }
    out.push_str(&wrapped(
        "The limits are as true as masses, stiffness and damping of the model; modes of spindle and tool are in them only if the model has them. The limit of zeroth order is no bound.",
        0,
    ));
    out.push_str(&warnings::warnings(&a.warnings));
    out
}

fn deepest(best: &Best, speeds: usize) -> String {
    let (depth, rpm) = (number(best.depth_mm, 4), number(best.speed_rpm, 5));
    match (best.no_limit_found, best.speeds_without_limit) {
        (false, _) => format!("Deepest stable cut of these speeds: {depth} mm at {rpm} rpm."),
        (true, without) if without == speeds => format!(
            "No limit was found: all speeds are stable up to {} mm, the largest depth that was looked at (--depth-mm).",
            short(best.depth_mm)
        ),
        (true, without) => format!(
            "Deepest stable cut of these speeds: {} mm or more at {without} of {speeds} speeds, the slowest {rpm} rpm; that is the largest depth that was looked at (--depth-mm), and no limit.",
            short(best.depth_mm)
        ),
    }
}

/// One row for each speed.
fn table(a: &LobesAnswer) -> Answer<Vec<u8>> {
    let head = [
        "speed_rpm",
        "limit_mm",
        "kind",
        "chatter_hz",
        "stable_mm",
        "zeroth_order_mm",
        "modes_up_to_hz",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for p in &a.points {
        let stretches = p
            .stable_mm
            .iter()
            .map(|(low, high)| format!("{low}-{high}"));
        rows.push(vec![
            cell(p.speed_rpm),
            cell_if_any(p.limit_mm),
            instability(p.kind).to_lowercase(),
            cell_if_any(p.chatter_hz),
            stretches.collect::<Vec<_>>().join(" "),
            cell_if_any(p.zeroth_order_mm),
            cell(p.modes_up_to_hz),
        ]);
    }
    written(&rows)
}
