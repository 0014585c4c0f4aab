//! `kinetostat lobes`: at which spindle speed and depth a milling cut of a machine chatters at a place.
//!
//! It takes a model, a place, a load, damping, a tool and a cut, and gives exact limits over the spindle speed, with those
//! of zeroth order beside them under their own name.

pub(crate) mod answer;
pub(crate) mod arguments;
mod coefficients;
mod solved;

use kinetostat_diagnostic::ErrorCode;
use kinetostat_dynamics::Held;
use kinetostat_report::lobes_svg;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::lobes::answer::{Best, LobesAnswer};
use crate::lobes::arguments::LobesArgs;
use crate::lobes::solved::Lobes;
use crate::place::query::PlaceQuery;
use crate::ui::csv_table::{cell, cell_if_any, written};
use crate::ui::failure::{Answer, Failing};
use crate::ui::given::Given;
use crate::ui::layout::{columns, wrapped};
use crate::ui::numbers::{number, short, triple};
use crate::ui::result_form::ResultForm;
use crate::ui::warnings;
use crate::vibration::damping::words;
use crate::vibration::stability::{damped, instability};
use crate::vibration::subject;

/// Results that the command gives as JSON.
pub(crate) const RESULTS: &[ResultForm] =
    &[ResultForm::of::<LobesAnswer>("stability lobes of a cut")];

pub(crate) fn run(args: &LobesArgs, given: &Given) -> Answer<()> {
    refuse_unused(args, given)?;
    let request = args.cut.request()?;
    if request.speeds == 1 && args.outputs.plot.is_some() {
        return Err(ErrorCode::Unused
            .failure("--plot draws limits over the spindle speed; --rpm names one speed"));
    }
    let query = subject::query(&args.machine)?;
    let damping = damped(&args.damping, &query.damping, "lobes need")?;
    let mut inputs = query.inputs.clone();
    inputs.extend(args.cut.material.materials.clone());
    let files = ClaimedFiles::claim(&args.outputs, &inputs)?;
    let posture = query.posture()?;
    let machine = subject::machine(&query, &posture, &Held::nothing())?;
    let Lobes {
        diagram,
        coefficients,
        frame,
        warnings: of_lobes,
    } = args.cut.lobes(&query.target, &machine, &damping)?;
    let mut warnings = query.warnings.clone();
    warnings.extend(subject::limits(&machine, &posture));
    warnings.extend(of_lobes);
    let band_hz = diagram.modes_up_to_hz();
    // The last one is compared with itself, whose digits are those of another sum.
    let in_band = |hz: &f64| *hz <= band_hz * (1.0 + 1e-9);
    let modes_hz = machine.modes.frequencies_hz();
    let modes_hz: Vec<f64> = modes_hz.into_iter().filter(in_band).collect();
    let cut = &args.cut;
    let axis = |k: usize| frame.rotation().column(k).into_owned();
    let answer = LobesAnswer {
        head: query.head(1),
        force_n: query.wrench.force().into(),
        moment_n_m: query.wrench.moment().into(),
        damping: words(&damping),
        feed_direction: axis(0).into(),
        tool_axis: axis(2).into(),
        teeth: cut.teeth,
        immersion: cut.immersion,
        milled: if cut.up { "up" } else { "down" },
        coefficients_n_per_mm2: match cut.coefficients_n_per_mm2.is_empty() {
            true => coefficients.n_per_mm2(),
            // Coefficients of options are shown without rounding.
            false => cut.coefficients_n_per_mm2.clone(),
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
        depth_limit_mm: cut.depth_mm,
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

/// Refuses options of a material where coefficients are given, and a diameter that nothing depends on.
fn refuse_unused(args: &LobesArgs, given: &Given) -> Answer<()> {
    if !args.cut.coefficients_n_per_mm2.is_empty() {
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
    if args.cut.helix_deg.is_none() && !args.cut.material.correct_speed {
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
