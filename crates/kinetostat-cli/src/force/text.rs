//! The answer of `force` for a person.

use kinetostat::number::largest_size;

use crate::force::answer::{ForceAnswer, ToolAnswer, WallAnswer};
use crate::force::cut::{Cut, Way};
use crate::force::tool::CutTool;
use crate::force::trust::trust;
use crate::ui::layout::{columns, item, named, wrapped};
use crate::ui::numbers::{given, number, triple};

/// Describes the cut in one sentence.
pub(crate) fn question(material: &str, tool: &CutTool, cut: &Cut) -> String {
    let way = way_text(cut.way);
    let tool = match (tool.number, tool.name.as_str()) {
        (None, _) => String::new(),
        (Some(number), "") => format!(" with tool {number}"),
        (Some(number), name) => format!(" with tool {number} ({name})"),
    };
    format!("Force of one cut: {way} in {material}{tool}")
}

pub(crate) fn way_text(way: Way) -> &'static str {
    match way {
        Way::Climb => "climb milling",
        Way::Conventional => "conventional milling",
        Way::Slot => "a slot",
    }
}

/// The word of the JSON as a person says it.
pub(crate) fn milling(word: &str) -> &'static str {
    match word {
        "climb" => "Climb milling",
        "conventional" => "Conventional milling",
        _ => "Slot",
    }
}

pub(crate) fn answer_text(a: &ForceAnswer) -> String {
    let mut out = wrapped(&a.question, 0);
    for (name, text) in what_is_cut(a) {
        out.push_str(&named(name, 5, &text));
    }
    out.push_str("\nForce on the tool, N\n");
    out.push_str(&forces(a));
    out.push_str(&wrapped(
        "x along the feed, y to the left of it, z along the tool towards the spindle",
        2,
    ));
    out.push_str("\nTorque of the spindle\n");
    out.push_str(&torques(a));
    out.push_str("\nWhat bends the machine, and what prints into the wall\n");
    out.push_str(&meaning(a));
    out.push_str("\nWhat shakes it: harmonics, amplitudes in N\n");
    out.push_str(&harmonics(a));
    out.push_str(&trust(a));
    out
}

/// A figure beside others of this size: what is rounding is 0.
fn figure(value: f64, size: f64) -> String {
    match value.abs() < 1e-9 * size {
        true => "0".to_owned(),
        false => number(value, 4),
    }
}

fn what_is_cut(a: &ForceAnswer) -> Vec<(&'static str, String)> {
    let c = &a.cut;
    let mut rows = vec![
        ("tool", tool_text(&a.tool)),
        (
            "cut",
            cut_text(
                c.width_mm,
                c.depth_mm,
                c.part,
                c.counter_clockwise,
                a.tool.diameter_mm,
            ),
        ),
    ];
    let mut feed = format!("{} mm per tooth", given(c.feed_per_tooth_mm));
    if c.down_feed_per_tooth_mm != 0.0 {
        let down = given(c.down_feed_per_tooth_mm);
        feed.push_str(&format!(", {down} mm down the tool"));
    }
    if let (Some(per_min), Some(rpm)) = (c.feed_mm_per_min, c.rpm) {
        let (per_min, rpm) = (given(per_min), given(rpm));
        feed.push_str(&format!(", {per_min} mm/min at {rpm} turns per minute"));
    }
    rows.push(("feed", feed));
    if let (Some(speed), Some(removed)) = (c.cutting_speed_m_per_min, c.removed_mm3_per_min) {
        let speed = number(speed, 4);
        let removed = number(1e-3 * removed, 4);
        rows.push((
            "speed",
            format!("{speed} m/min, {removed} cm3 of chips per minute"),
        ));
    }
    let chip = format!(
        "{} mm at the thickest, {} mm in the mean, from {} to {} deg",
        number(c.largest_chip_mm, 3),
        number(c.mean_chip_mm, 3),
        number(c.arc_from_deg, 4),
        number(c.arc_to_deg, 4)
    );
    rows.push(("chip", chip));
    rows
}

pub(crate) fn tool_text(t: &ToolAnswer) -> String {
    let mut text = format!(
        "{}, {} mm, {} {}, helix {} deg",
        t.shape,
        given(t.diameter_mm),
        t.teeth,
        match t.teeth {
            1 => "tooth",
            _ => "teeth",
        },
        given(t.helix_deg)
    );
    if let Some(corner) = t.corner_radius_mm {
        text.push_str(&format!(", corner {} mm", given(corner)));
    }
    if let Some(lead) = t.lead_angle_deg {
        text.push_str(&format!(", lead angle {} deg", given(lead)));
    }
    if t.run_out_um > 0.0 {
        text.push_str(&format!(", run-out {} um", given(t.run_out_um)));
    }
    text
}

pub(crate) fn cut_text(
    width_mm: f64,
    depth_mm: f64,
    part: &str,
    counter_clockwise: bool,
    diameter_mm: f64,
) -> String {
    let part = match part {
        "both" => String::new(),
        side => format!(", part on the {side}"),
    };
    let turning = match counter_clockwise {
        true => ", spindle counter-clockwise (M4)",
        false => "",
    };
    format!(
        "{} mm wide, {} % of the diameter, {} mm deep{part}{turning}",
        given(width_mm),
        number(100.0 * width_mm / diameter_mm, 3),
        given(depth_mm)
    )
}

fn forces(a: &ForceAnswer) -> String {
    let mut rows = vec![["", "x", "y", "z", "across"].map(String::from).to_vec()];
    let mut row = |name: String, force: [f64; 3]| {
        let size = largest_size(force);
        let across = force[0].hypot(force[1]);
        let mut cells = vec![name];
        cells.extend(force.iter().map(|x| figure(*x, size)));
        cells.push(figure(across, size));
        rows.push(cells);
    };
    row("mean over the turn".into(), a.mean.force_n);
    row(
        format!("largest, at {} deg", number(a.peak.at_deg, 4)),
        a.peak.force_n,
    );
    for wall in &a.walls {
        row(format!("making the {} wall", wall.wall), wall.force_n);
    }
    columns(&rows, 2)
}

fn torques(a: &ForceAnswer) -> String {
    let mut rows = vec![["", "N m", "W"].map(String::from).to_vec()];
    let mut row = |name: &str, torque_n_mm: f64, power_w: Option<f64>| {
        let power = power_w.map_or_else(|| "needs --rpm".to_owned(), |w| number(w, 4));
        rows.push(vec![name.to_owned(), number(1e-3 * torque_n_mm, 4), power]);
    };
    row("mean", a.mean.torque_n_mm, a.mean.power_w);
    row("largest", a.peak.torque_n_mm, a.peak.power_w);
    if let Some(spindle) = &a.spindle {
        row(
            "the spindle gives",
            spindle.torque_n_mm,
            Some(spindle.power_w),
        );
    }
    let mut out = columns(&rows, 2);
    let size = largest_size(a.mean.moment_n_mm);
    let moment = triple(a.mean.moment_n_mm.map(|m| 1e-3 * m), |m| {
        figure(m, 1e-3 * size)
    });
    out.push_str(&wrapped(
        &format!("Moment of the mean on the tool about its tip: {moment} N m"),
        2,
    ));
    out
}

/// Explains the use of each force.
fn meaning(a: &ForceAnswer) -> String {
    let load = &a.mean.job_load;
    let size = largest_size(a.mean.force_n);
    let mut out = item(
        "The mean bends the machine: its drives and links are too heavy to follow single teeth. As load of a job:",
    );
    // Lines that can be copied.
    out.push_str(&format!(
        "    milling = {{ radial_n = {}, tangential_n = {}, axial_n = {} }}\n",
        figure(load.radial_n, size),
        figure(load.tangential_n, size),
        figure(load.axial_n, size)
    ));
    out.push_str("    or, with the moment on the tool about its tip:\n");
    let [force, moment] = [a.mean.force_n, load.moment_n_m].map(|v| {
        let size = largest_size(v);
        v.map(|x| figure(x, size)).join(", ")
    });
    out.push_str(&format!(
        "    force_n = [{force}]\n    moment_n_m = [{moment}]\n    axes = \"feed\"\n"
    ));
    for wall in &a.walls {
        out.push_str(&item(&wall_text(wall, a)));
    }
    out
}

fn wall_text(wall: &WallAnswer, a: &ForceAnswer) -> String {
    let away = |force: [f64; 3]| match wall.wall {
        "left" => -force[1],
        _ => force[1],
    };
    let size = largest_size(a.peak.force_n);
    let say = |force: f64| match force < 0.0 {
        true => format!("{} N into it", figure(-force, size)),
        false => format!("{} N away from it", figure(force, size)),
    };
    let effect = match wall.away_from_wall_n < 0.0 {
        true => "so too much comes off",
        false => "so material stays",
    };
    format!(
        "The {} wall is made only at the moments at which an edge passes it. The force is then {}, {effect}; the mean over the turn is {}. The first one prints into the wall. {}",
        wall.wall,
        say(wall.away_from_wall_n),
        say(away(a.mean.force_n)),
        along_the_wall(wall, away, size)
    )
}

/// Describes the force away from the wall from the tip upward.
fn along_the_wall(wall: &WallAnswer, away: impl Fn([f64; 3]) -> f64, size: f64) -> String {
    let forces: Vec<f64> = wall.heights.iter().map(|at| away(at.force_n)).collect();
    let last = wall.heights.last().map_or(0.0, |at| at.above_tip_mm);
    let first = forces.first().copied().unwrap_or(f64::NAN);
    match forces
        .iter()
        .all(|force| (force - first).abs() <= 1e-3 * size)
    {
        true => "It is the same at all heights.".to_owned(),
        false => {
            let shown: Vec<String> = forces.iter().map(|force| figure(*force, size)).collect();
            format!(
                "From the tip to {} mm above it: {} N away from the wall.",
                given(last),
                shown.join(", ")
            )
        }
    }
}

fn harmonics(a: &ForceAnswer) -> String {
    let mut rows = vec![
        ["times per turn", "Hz", "x", "y", "z"]
            .map(String::from)
            .to_vec(),
    ];
    let size = largest_size(a.peak.force_n);
    for h in &a.harmonics {
        let hz = h
            .frequency_hz
            .map_or_else(|| "-".to_owned(), |f| number(f, 5));
        let mut row = vec![h.per_revolution.to_string(), hz];
        row.extend(h.amplitude_n.iter().map(|x| figure(*x, size)));
        rows.push(row);
    }
    columns(&rows, 2)
}
