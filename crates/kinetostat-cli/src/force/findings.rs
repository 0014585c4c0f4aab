//! Warnings about a cut.

use kinetostat_cutting::{Material, SpindleFinding};
use kinetostat_machining::{Warning, WarningCode, deeper_than_edges};

use crate::force::answer::ForceAnswer;
use crate::force::cut::Cut;
use crate::force::tool::CutTool;
use crate::ui::numbers::{given, number};

pub(crate) fn findings(
    answer: &ForceAnswer,
    material: &Material,
    tool: &CutTool,
    cut: &Cut,
) -> Vec<Warning> {
    let mut list = Vec::new();
    list.extend(of_tool(answer, tool, cut));
    list.extend(of_spindle(answer, cut));
    let (mean, largest) = (answer.cut.mean_chip_mm, answer.cut.largest_chip_mm);
    list.extend(of_chip(material, mean, largest));
    list.extend(of_end(material, answer, cut));
    let speed = answer.cut.cutting_speed_m_per_min;
    list.extend(speed.and_then(|speed| of_speed(material, speed)));
    list
}

fn of_tool(answer: &ForceAnswer, tool: &CutTool, cut: &Cut) -> Vec<Warning> {
    let mut list = Vec::new();
    let mut say = |code, text: String| list.push(Warning::new(code, text));
    if let Some(most) = tool.max_chip_mm {
        let (feed, chip) = (cut.feed.level_mm, answer.cut.largest_chip_mm);
        if feed > most {
            say(
                WarningCode::ChipOverLimit,
                format!(
                    "the feed of {} mm per tooth is more than the {} mm that the tool allows",
                    given(feed),
                    given(most)
                ),
            );
        } else if chip > most {
            say(
                WarningCode::ChipOverLimit,
                format!(
                    "with the run-out a tooth cuts chips of {} mm, more than the {} mm that the tool allows",
                    number(chip, 3),
                    given(most)
                ),
            );
        }
    }
    let diameter = tool.tool.diameter_mm();
    if tool.tool.helix() < 0.0 {
        say(
            WarningCode::ImplausibleCoefficient,
            format!(
                "a helix of {} deg pushes the chip down, and materials state their axial coefficients for one that lifts it, which draws the tool to the part: the axial force has the wrong sign unless the material was measured with such a tool",
                given(tool.tool.helix().to_degrees())
            ),
        );
    }
    if tool.max_chip_mm.is_none() {
        let feed = cut.feed.level_mm.hypot(cut.feed.down_mm);
        list_coarse(feed, diameter, "per tooth", &mut say);
    }
    if tool.tool.run_out().offset_mm > RUN_OUT * diameter {
        say(
            WarningCode::ImplausibleCut,
            format!(
                "a run-out of {} um on a tool of {} mm: no tool is held like that",
                given(1e3 * tool.tool.run_out().offset_mm),
                given(diameter)
            ),
        );
    }
    let lengths = tool.flute_length_mm.or(tool.stick_out_mm);
    if let (Some(text), None) = (deeper_than_edges(cut.depth_mm, diameter), lengths) {
        say(WarningCode::ToolTooShort, text);
    }
    let depth = given(cut.depth_mm);
    if let Some(flutes) = tool.flute_length_mm.filter(|flutes| cut.depth_mm > *flutes) {
        say(
            WarningCode::ToolTooShort,
            format!(
                "the cut is {depth} mm deep and the edges are {} mm long: above them the shank rubs, and the force is not this one",
                given(flutes)
            ),
        );
    }
    if let Some(out) = tool.stick_out_mm.filter(|out| cut.depth_mm > *out) {
        say(
            WarningCode::ToolTooShort,
            format!(
                "the cut is {depth} mm deep and the tool stands {} mm out of its holder: the holder runs into the part",
                given(out)
            ),
        );
    }
    list
}

/// A feed beyond this share of the diameter is none of milling or drilling.
const COARSE: f64 = 0.1;

/// Chips under a flat end that are thinner than this are beyond a law of which no range is known, mm.
const THINNEST_MM: f64 = 0.005;

/// A run-out beyond this share of the diameter is a mistake.
const RUN_OUT: f64 = 0.03;

/// Faster than any edge cuts, m/min.
const FASTEST: f64 = 10_000.0;

fn list_coarse(feed: f64, diameter: f64, per: &str, say: &mut impl FnMut(WarningCode, String)) {
    if feed > COARSE * diameter {
        say(
            WarningCode::ChipOverLimit,
            format!(
                "a feed of {} mm {per} with a tool of {} mm: check feed, speed and number of teeth; the force is that of chips that no such tool cuts",
                given(feed),
                given(diameter)
            ),
        );
    }
}

/// A feed of a drill that none survives.
pub(crate) fn of_feed_per_turn(feed: f64, diameter: f64) -> Option<Warning> {
    let mut found = None;
    list_coarse(feed, diameter, "per turn", &mut |code, text| {
        found = Some(Warning::new(code, text));
    });
    found
}

/// A turning cut that no lathe makes.
pub(crate) fn of_turning(depth_mm: f64, feed_mm: f64) -> Option<Warning> {
    (depth_mm > 30.0 || feed_mm > 3.0).then(|| {
        Warning::new(
            WarningCode::ImplausibleCut,
            format!(
                "a depth of {} mm and a feed of {} mm per turn: hardly a lathe cuts more than 30 mm deep or 3 mm per turn",
                given(depth_mm),
                given(feed_mm)
            ),
        )
    })
}

fn of_spindle(answer: &ForceAnswer, cut: &Cut) -> Option<Warning> {
    let (curve, rpm) = (cut.spindle.as_ref()?, cut.rpm?);
    // A spindle has inertia: the mean must be borne, a peak within a turn need not.
    let message = match curve.exceeded_by(rpm, answer.mean.torque_n_mm)? {
        SpindleFinding::Speed { most_rpm, .. } => format!(
            "the cut needs {} turns per minute, and the spindle turns up to {}",
            given(rpm),
            given(most_rpm)
        ),
        SpindleFinding::Torque {
            torque_n_m, limit, ..
        } => format!(
            "the cut needs {} N m ({} W) in the mean, and at {} turns per minute the spindle gives {} N m ({} W): it slows down or stops",
            number(torque_n_m, 3),
            number(answer.mean.power_w.unwrap_or(f64::NAN), 3),
            given(rpm),
            number(limit.torque_n_m, 3),
            number(limit.power_w, 3)
        ),
        other => other.to_string(),
    };
    Some(Warning::new(WarningCode::SpindleExceeded, message))
}

/// A flat end whose chips the law does not know.
fn of_end(material: &Material, answer: &ForceAnswer, cut: &Cut) -> Option<Warning> {
    let thinnest_mm = material.chip_mm.map_or(THINNEST_MM, |(from, _)| from);
    let down_mm = cut.feed.down_mm;
    let (end_n, all_n) = (answer.end_axial_n.abs(), answer.mean.force_n[2].abs());
    (end_n > 0.0 && down_mm < thinnest_mm).then(|| {
        Warning::new(
            WarningCode::ChipsOutsideMeasured,
            format!(
                "the flat end takes {} mm per tooth, and the law of {} is known from {} mm on: {} of {} N along the tool are edge forces of the end, a guess. An end with relief bears less, down to {} N in all",
                given(down_mm),
                material.name,
                given(thinnest_mm),
                number(end_n, 3),
                number(all_n, 3),
                number((all_n - end_n).abs(), 3)
            ),
        )
    })
}

/// Chips, mm, that the law does not know.
pub(crate) fn of_chip(material: &Material, mean: f64, largest: f64) -> Option<Warning> {
    let (from, to) = material.chip_mm?;
    let found = match (mean < from, largest > to) {
        (false, false) => return None,
        (true, _) => format!("the mean chip is {} mm thick", number(mean, 3)),
        (false, true) => format!("the thickest chip has {} mm", number(largest, 3)),
    };
    let message = format!(
        "{found}, and the law of {} was measured from {} to {} mm: beyond, it is a guess, and the spread does not count that",
        material.name,
        given(from),
        given(to)
    );
    Some(Warning::new(WarningCode::ChipsOutsideMeasured, message))
}

/// A cutting speed, m/min, that the law does not know.
pub(crate) fn of_speed(material: &Material, speed: f64) -> Option<Warning> {
    if speed > FASTEST {
        return Some(Warning::new(
            WarningCode::ImplausibleCut,
            format!(
                "the cutting speed is {} m/min: check the speed of the spindle and the diameter, nothing is cut faster than {FASTEST} m/min",
                number(speed, 4)
            ),
        ));
    }
    let (from, to) = material.speed_m_per_min?;
    if (from..=to).contains(&speed) {
        return None;
    }
    let message = format!(
        "the cutting speed is {} m/min, and the law of {} was measured from {} to {} m/min",
        number(speed, 4),
        material.name,
        given(from),
        given(to)
    );
    Some(Warning::new(WarningCode::SpeedOutsideMeasured, message))
}
