//! `kinetostat force --turning`: the force on a turning tool.

use kinetostat_cutting::{Material, Turning};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::force::answer::MaterialAnswer;
use crate::force::answer_of::material_answer;
use crate::force::arguments::ForceArgs;
use crate::force::findings::{of_chip, of_speed, of_turning};
use crate::force::material::{Made, applied};
use crate::force::refusal::{refused, within};
use crate::force::trust::section;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{listed, wrapped};
use crate::ui::numbers::{given, number};

#[derive(Serialize, JsonSchema)]
pub(crate) struct TurningAnswer {
    schema: u32,
    kinetostat_version: &'static str,
    question: String,
    material: MaterialAnswer,
    depth_mm: f64,
    feed_per_turn_mm: f64,
    approach_angle_deg: f64,
    cutting_speed_m_per_min: Option<f64>,
    chip_mm: f64,
    chip_width_mm: f64,
    /// Along the speed of the part at the edge, on the tool.
    cutting_n: f64,
    /// Force against the feed.
    feed_n: f64,
    /// Away from the part, across the feed.
    passive_n: f64,
    power_w: Option<f64>,
    assumed: Vec<String>,
    warnings: Vec<Warning>,
}

pub(crate) fn run(args: &ForceArgs, material: &Material, files: ClaimedFiles) -> Answer<()> {
    let answer = answer(args, material)?;
    let shown = Shown {
        text: text(&answer),
        csv: Vec::new(),
        svg: String::new(),
        failure: None,
    };
    files.finish(&shown, &answer)
}

fn answer(args: &ForceArgs, material: &Material) -> Answer<TurningAnswer> {
    let of = &args.steady;
    let (Some(depth_mm), Some(feed)) = (args.cut.depth_mm, of.feed_per_turn_mm) else {
        return Err(ErrorCode::Missing.failure("the cut needs --depth-mm AP, in mm"));
    };
    within("feed per turn", feed, 1e-6..=100.0, "mm")?;
    let approach_angle_deg = of.approach_angle_deg.unwrap_or(90.0);
    let cut = Turning::new(depth_mm, feed, approach_angle_deg.to_radians())
        .map_err(|error| refused(&error))?;
    let speed = of.speed_m_per_min;
    if let Some(speed) = speed.filter(|speed| !(1e-3..=1e5).contains(speed)) {
        return Err(ErrorCode::Value.failure(format!(
            "--speed-m-per-min: cutting speed of {speed} m/min; expected 0.001 to 100000 m/min"
        )));
    }
    let corrected = match (args.material.correct_speed, speed) {
        (true, None) => {
            return Err(ErrorCode::Missing.failure("--correct-speed needs --speed-m-per-min"));
        }
        (true, speed) => speed,
        (false, _) => None,
    };
    let applied = applied(material, &args.material, Made::Steadily, None, corrected)?;
    let force = cut.force(&applied.law).map_err(|error| refused(&error))?;
    let mut assumed = material.assumptions.clone();
    assumed.push(
        "The corner radius of the tool is left out: it counts where the depth is not several times that radius."
            .to_owned(),
    );
    let mut warnings: Vec<Warning> = Vec::new();
    warnings.extend(of_turning(depth_mm, feed));
    warnings.extend(of_chip(material, force.chip_mm, force.chip_mm));
    warnings.extend(speed.and_then(|speed| of_speed(material, speed)));
    Ok(TurningAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        question: format!("Force of one cut: turning {}", material.name),
        material: material_answer(material, &applied),
        depth_mm,
        feed_per_turn_mm: feed,
        approach_angle_deg,
        cutting_speed_m_per_min: speed,
        chip_mm: force.chip_mm,
        chip_width_mm: force.width_mm,
        cutting_n: force.cutting_n,
        feed_n: force.feed_n,
        passive_n: force.passive_n,
        power_w: speed.map(|speed| force.power_w(speed)),
        assumed,
        warnings,
    })
}

fn text(a: &TurningAnswer) -> String {
    let mut out = wrapped(&a.question, 0);
    let power = match (a.power_w, a.cutting_speed_m_per_min) {
        (Some(power), Some(speed)) => {
            format!("{} W at {} m/min", number(power, 4), number(speed, 4))
        }
        _ => "needs --speed-m-per-min".to_owned(),
    };
    // An edge across the feed has no passive force but for rounding.
    let small = |force: f64| match force.abs() < 1e-9 * a.cutting_n.abs() {
        true => "0 N".to_owned(),
        false => format!("{} N", number(force, 4)),
    };
    let rows = [
        (
            "cut",
            format!(
                "{} mm deep, {} mm per turn, edge at {} deg to the feed",
                given(a.depth_mm),
                given(a.feed_per_turn_mm),
                given(a.approach_angle_deg)
            ),
        ),
        (
            "chip",
            format!(
                "{} mm thick, {} mm wide",
                number(a.chip_mm, 3),
                number(a.chip_width_mm, 4)
            ),
        ),
        ("cutting force", small(a.cutting_n)),
        (
            "feed force",
            format!("{} against the feed", small(a.feed_n)),
        ),
        (
            "passive force",
            format!(
                "{} away from the part; it bends the part",
                small(a.passive_n)
            ),
        ),
        ("power", power),
    ];
    let rows = rows.map(|(name, text)| vec![name.to_owned(), text]);
    out.push_str(&listed(&rows, 2));
    let spread = 0.01 * a.material.spread_percent;
    let band = format!(
        "a cutting force of {} to {} N",
        number((1.0 - spread) * a.cutting_n, 3),
        number((1.0 + spread) * a.cutting_n, 3)
    );
    out.push_str(&section(&a.material, &band, &a.assumed, &a.warnings));
    out
}
