//! `kinetostat force --drill`: thrust and torque of a drill.

use std::f64::consts::PI;

use kinetostat_cutting::{Drill, Material};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::Warning;
use schemars::JsonSchema;
use serde::Serialize;

use crate::files::answer_files::{ClaimedFiles, Shown};
use crate::force::answer::MaterialAnswer;
use crate::force::answer_of::material_answer;
use crate::force::arguments::ForceArgs;
use crate::force::findings::{of_chip, of_feed_per_turn, of_speed};
use crate::force::material::{Made, applied};
use crate::force::refusal::{refused, within};
use crate::force::trust::section;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::{listed, wrapped};
use crate::ui::numbers::{given, number};

#[derive(Serialize, JsonSchema)]
pub(crate) struct DrillAnswer {
    schema: u32,
    kinetostat_version: &'static str,
    question: String,
    material: MaterialAnswer,
    diameter_mm: f64,
    lips: usize,
    point_angle_deg: f64,
    hole_mm: f64,
    chisel_factor: f64,
    feed_per_turn_mm: f64,
    rpm: Option<f64>,
    /// Speed at the corner of the lips.
    cutting_speed_m_per_min: Option<f64>,
    chip_mm: f64,
    /// Along the axis towards the spindle, on the drill.
    thrust_n: f64,
    lips_thrust_n: f64,
    torque_n_mm: f64,
    cutting_per_lip_n: f64,
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

fn answer(args: &ForceArgs, material: &Material) -> Answer<DrillAnswer> {
    let of = &args.steady;
    let (Some(diameter_mm), Some(feed)) = (args.tool.diameter_mm, of.feed_per_turn_mm) else {
        return Err(ErrorCode::Missing.failure("the drill needs --diameter-mm D, in mm"));
    };
    within("feed per turn", feed, 1e-6..=100.0, "mm")?;
    let lips = of.lips.unwrap_or(2);
    let point_angle_deg = of.point_angle_deg.unwrap_or(118.0);
    let hole_mm = of.hole_mm.unwrap_or(0.0);
    let chisel_factor = of.chisel_factor.unwrap_or(1.0);
    let drill = Drill::new(diameter_mm, lips, point_angle_deg.to_radians())
        .and_then(|drill| drill.in_hole(hole_mm))
        .and_then(|drill| drill.with_chisel_factor(chisel_factor))
        .map_err(|error| refused(&error))?;
    let rpm = args.cut.rpm;
    rpm.map(|rpm| within("speed of the spindle", rpm, 1e-3..=1e6, "turns per minute"))
        .transpose()?;
    let speed = rpm.map(|rpm| 1e-3 * PI * diameter_mm * rpm);
    let corrected = match (args.material.correct_speed, speed) {
        (true, None) => {
            return Err(ErrorCode::Missing
                .failure("--correct-speed needs --rpm: the cutting speed follows from it"));
        }
        (true, speed) => speed,
        (false, _) => None,
    };
    let applied = applied(material, &args.material, Made::Steadily, None, corrected)?;
    let force = drill
        .force(&applied.law, feed)
        .map_err(|error| refused(&error))?;
    let mut assumed = material.assumptions.clone();
    if hole_mm == 0.0 {
        assumed.push(match of.chisel_factor {
            Some(_) => "The chisel's part of the thrust is what --chisel-factor says.".to_owned(),
            None => "The chisel edge in the middle presses nothing; on many drills it takes as much thrust as the lips do (--chisel-factor 2).".to_owned(),
        });
    }
    assumed.push("Chips leave the hole freely: in a deep hole the torque grows.".to_owned());
    let mut warnings: Vec<Warning> = Vec::new();
    warnings.extend(of_feed_per_turn(feed, diameter_mm));
    warnings.extend(of_chip(material, force.chip_mm, force.chip_mm));
    warnings.extend(speed.and_then(|speed| of_speed(material, speed)));
    Ok(DrillAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        question: format!("Force of one cut: drilling {}", material.name),
        material: material_answer(material, &applied),
        diameter_mm,
        lips,
        point_angle_deg,
        hole_mm,
        chisel_factor,
        feed_per_turn_mm: feed,
        rpm,
        cutting_speed_m_per_min: speed,
        chip_mm: force.chip_mm,
        thrust_n: force.thrust_n,
        lips_thrust_n: force.lips_thrust_n,
        torque_n_mm: force.torque_n_mm,
        cutting_per_lip_n: force.cutting_per_lip_n,
        power_w: rpm.map(|rpm| force.power_w(rpm)),
        assumed,
        warnings,
    })
}

fn text(a: &DrillAnswer) -> String {
    let mut out = wrapped(&a.question, 0);
    let mut tool = format!(
        "{} mm, {} lips, point angle {} deg",
        given(a.diameter_mm),
        a.lips,
        given(a.point_angle_deg)
    );
    if a.hole_mm > 0.0 {
        tool.push_str(&format!(", in a hole of {} mm", given(a.hole_mm)));
    }
    let power = match (a.power_w, a.cutting_speed_m_per_min) {
        (Some(power), Some(speed)) => {
            format!("{} W at {} m/min", number(power, 4), number(speed, 4))
        }
        _ => "needs --rpm".to_owned(),
    };
    let rows = [
        ("drill", tool),
        (
            "feed",
            format!(
                "{} mm per turn, chips of {} mm",
                given(a.feed_per_turn_mm),
                number(a.chip_mm, 3)
            ),
        ),
        ("thrust", format!("{} N", number(a.thrust_n, 4))),
        ("torque", format!("{} N m", number(1e-3 * a.torque_n_mm, 4))),
        ("power", power),
        (
            "on a lip",
            format!("{} N against its way", number(a.cutting_per_lip_n, 4)),
        ),
    ];
    let rows = rows.map(|(name, text)| vec![name.to_owned(), text]);
    out.push_str(&listed(&rows, 2));
    let spread = 0.01 * a.material.spread_percent;
    let band = format!(
        "a torque of {} to {} N m",
        number(1e-3 * (1.0 - spread) * a.torque_n_mm, 3),
        number(1e-3 * (1.0 + spread) * a.torque_n_mm, 3)
    );
    out.push_str(&section(&a.material, &band, &a.assumed, &a.warnings));
    out
}
