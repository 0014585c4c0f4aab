//! Evaluation of a cut from tool and law.

use kinetostat_cutting::{
    Applied, CutForce, Material, Milling, Peaks, Revolution, Rotation, Shape, Side, Tool, Wall,
};
use kinetostat_diagnostic::ErrorCode;

use crate::force::answer::{
    AtAngle, AtHeight, CutAnswer, FactorAnswer, ForceAnswer, HarmonicAnswer, JobLoad,
    MaterialAnswer, MeanAnswer, PeakAnswer, SpindleAnswer, ToolAnswer, WallAnswer,
};
use crate::force::cut::{Cut, Part, Way};
use crate::force::findings::findings;
use crate::force::tool::CutTool;
use crate::ui::failure::{Answer, Failing};

/// Angles per tooth at which the force is computed, at least and at most.
const ANGLES_PER_TOOTH: (usize, usize) = (12, 360);

/// Edges at angles that are computed: with run-out every tooth at every angle, and each piece of an edge that winds about the
/// tool. A cutter of many teeth has fewer angles for each.
const EDGES: f64 = 4e5;

/// Harmonics of the teeth that are named.
const HARMONICS: usize = 4;

/// Heights at which the force on a wall is named, the tip and the full depth among them.
const HEIGHTS: usize = 5;

fn axes(rotation: Rotation) -> String {
    let from = match rotation {
        Rotation::Clockwise => "+y",
        Rotation::CounterClockwise => "-y",
    };
    format!(
        "force on the tool; x along the feed of the tool over the part, y to the left of the feed, z along the tool towards the spindle; moments about the tip; angles of the spindle from {from} to the tip of tooth 0, as the spindle turns"
    )
}

pub(crate) fn answer_of(
    question: String,
    material: &Material,
    applied: &Applied,
    of_tool: &CutTool,
    cut: &Cut,
) -> Answer<ForceAnswer> {
    let tool = &of_tool.tool;
    let milling = Milling::new(tool, &applied.law, &cut.engagement, cut.feed).turning(cut.rotation);
    let chip = milling.chip_thickness().ok_or_else(|| {
        ErrorCode::Value.failure("nothing is cut: the tool rises faster than it goes ahead")
    })?;
    let revolution = milling.revolution_at(angles_per_tooth(tool, cut));
    let mean = milling.mean();
    let peak = peak(&milling.peaks(), cut, applied.spread);
    let contact = cut.engagement.contacts.first();
    let (from, to) = contact.map_or((0.0, 0.0), |c| (c.entry, c.exit));
    let feed_mm_per_min = cut.feed_mm_per_min(tool);
    let mut answer = ForceAnswer {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        question,
        material: material_answer(material, applied),
        tool: tool_answer(of_tool),
        cut: CutAnswer {
            width_mm: cut.width_mm,
            depth_mm: cut.depth_mm,
            part: part_word(cut.part),
            milling: milling_word(cut.way),
            counter_clockwise: cut.rotation != Rotation::Clockwise,
            arc_from_deg: from.to_degrees(),
            arc_to_deg: to.to_degrees(),
            feed_per_tooth_mm: cut.feed.level_mm,
            down_feed_per_tooth_mm: cut.feed.down_mm,
            feed_mm_per_min,
            rpm: cut.rpm,
            cutting_speed_m_per_min: cut.speed_m_per_min(),
            removed_mm3_per_min: feed_mm_per_min.map(|feed| feed * cut.width_mm * cut.depth_mm),
            largest_chip_mm: chip.largest_mm,
            mean_chip_mm: chip.mean_mm,
        },
        axes: axes(cut.rotation),
        mean: mean_answer(&mean, cut, applied.spread),
        spindle: spindle(cut, mean.torque_n_mm(), peak.torque_n_mm),
        peak,
        walls: walls(&milling, cut),
        harmonics: harmonics(&revolution, tool.run_out().offset_mm > 0.0, cut.rpm),
        assumed: assumed(material, of_tool, cut),
        warnings: Vec::new(),
        end_axial_n: milling.mean_of_end().force_n.z,
        revolution: at_angles(&revolution),
    };
    answer.warnings = findings(&answer, material, of_tool, cut);
    Ok(answer)
}

/// Side of the part as a word of the JSON.
pub(crate) fn part_word(part: Part) -> &'static str {
    match part {
        Part::Side(Side::Left) => "left",
        Part::Side(Side::Right) => "right",
        Part::Slot => "both",
    }
}

/// Milling mode as a word of the JSON.
pub(crate) fn milling_word(way: Way) -> &'static str {
    match way {
        Way::Climb => "climb",
        Way::Conventional => "conventional",
        Way::Slot => "slot",
    }
}

fn angles_per_tooth(tool: &Tool, cut: &Cut) -> usize {
    let teeth = tool.teeth() as f64;
    let windings = 1.0 + (tool.lag_per_mm() * cut.depth_mm).abs() / std::f64::consts::TAU;
    let each = (EDGES / (teeth * teeth * windings)) as usize;
    each.clamp(ANGLES_PER_TOOTH.0, ANGLES_PER_TOOTH.1)
}

/// Material and law as they were used.
pub(crate) fn material_answer(material: &Material, applied: &Applied) -> MaterialAnswer {
    let of = |factor: &kinetostat_cutting::AppliedFactor| FactorAnswer {
        symbol: factor.symbol,
        value: factor.value,
        reason: factor.reason.clone(),
    };
    MaterialAnswer {
        name: material.name.clone(),
        law: material.law.description(),
        source: material.source.clone(),
        spread_percent: 100.0 * applied.spread,
        factor: applied.law.factor,
        factors: applied.factors.iter().map(of).collect(),
    }
}

pub(crate) fn tool_answer(of: &CutTool) -> ToolAnswer {
    let tool = &of.tool;
    let (corner_radius_mm, lead_angle_deg) = match tool.shape() {
        Shape::Flat | Shape::Ball => (None, None),
        Shape::Bull { corner_radius_mm } => (Some(corner_radius_mm), None),
        Shape::Face { lead_angle } => (None, Some(lead_angle.to_degrees())),
    };
    ToolAnswer {
        number: of.number,
        name: of.name.clone(),
        shape: tool.shape().word(),
        diameter_mm: tool.diameter_mm(),
        teeth: tool.teeth(),
        helix_deg: tool.helix().to_degrees(),
        corner_radius_mm,
        lead_angle_deg,
        run_out_um: 1e3 * tool.run_out().offset_mm,
        run_out_angle_deg: tool.run_out().angle.to_degrees(),
    }
}

fn mean_answer(mean: &CutForce, cut: &Cut, spread: f64) -> MeanAnswer {
    let force = mean.force_n;
    MeanAnswer {
        force_n: force.into(),
        force_low_n: (force * (1.0 - spread)).into(),
        force_high_n: (force * (1.0 + spread)).into(),
        across_tool_n: mean.in_plane_n(),
        moment_n_mm: mean.moment_n_mm.into(),
        torque_n_mm: mean.torque_n_mm(),
        power_w: cut.power_w(mean.torque_n_mm()),
        job_load: JobLoad {
            radial_n: -force.y,
            tangential_n: force.x,
            axial_n: force.z,
            moment_n_m: (1e-3 * mean.moment_n_mm).into(),
        },
    }
}

fn peak(peaks: &Peaks, cut: &Cut, spread: f64) -> PeakAnswer {
    let across = peaks.across.force;
    let torque_n_mm = peaks.torque.force.torque_n_mm();
    PeakAnswer {
        force_n: across.force_n.into(),
        across_tool_n: across.in_plane_n(),
        across_tool_high_n: (1.0 + spread) * across.in_plane_n(),
        at_deg: peaks.across.turn.to_degrees(),
        torque_n_mm,
        torque_at_deg: peaks.torque.turn.to_degrees(),
        power_w: cut.power_w(torque_n_mm),
    }
}

fn walls<L: kinetostat_cutting::ForceLaw>(milling: &Milling<'_, L>, cut: &Cut) -> Vec<WallAnswer> {
    let walls = match cut.part {
        Part::Side(side) => vec![Wall::from(side)],
        Part::Slot => vec![Wall::Left, Wall::Right],
    };
    let height = |i: usize| cut.depth_mm * i as f64 / (HEIGHTS - 1) as f64;
    let of = |wall: Wall| -> Option<WallAnswer> {
        let whole = milling.surface_generation(wall)?;
        let (name, away) = match wall {
            Wall::Left => ("left", -whole.force_n.y),
            Wall::Right => ("right", whole.force_n.y),
        };
        let at = |i: usize| AtHeight {
            above_tip_mm: height(i),
            force_n: milling.at_wall(wall, height(i)).force_n.into(),
        };
        Some(WallAnswer {
            wall: name,
            force_n: whole.force_n.into(),
            away_from_wall_n: away,
            heights: (0..HEIGHTS).map(at).collect(),
        })
    };
    walls.into_iter().filter_map(of).collect()
}

/// The first of the teeth's; with run-out, which has every multiple of the spindle's, the largest of them.
fn harmonics(revolution: &Revolution, run_out: bool, rpm: Option<f64>) -> Vec<HarmonicAnswer> {
    let teeth = revolution.teeth();
    let wanted: Vec<usize> = match run_out && teeth > 1 {
        false => (1..=HARMONICS).map(|k| k * teeth).collect(),
        true => {
            let size = |k: usize| revolution.harmonic(k).amplitude_n.norm();
            let mut all: Vec<(usize, f64)> =
                (1..=HARMONICS * teeth).map(|k| (k, size(k))).collect();
            all.sort_by(|a, b| b.1.total_cmp(&a.1));
            all.truncate(HARMONICS + 1);
            let mut largest: Vec<usize> = all.into_iter().map(|(k, _)| k).collect();
            largest.sort_unstable();
            largest
        }
    };
    let of = |per_revolution: usize| HarmonicAnswer {
        per_revolution,
        frequency_hz: rpm.map(|rpm| per_revolution as f64 * rpm / 60.0),
        amplitude_n: revolution.harmonic(per_revolution).amplitude_n.into(),
    };
    wanted.into_iter().map(of).collect()
}

fn spindle(cut: &Cut, mean_n_mm: f64, peak_n_mm: f64) -> Option<SpindleAnswer> {
    let limit = cut.spindle.as_ref()?.limit_at(cut.rpm?)?;
    let torque_n_mm = 1e3 * limit.torque_n_m;
    Some(SpindleAnswer {
        torque_n_mm,
        power_w: limit.power_w,
        share_of_torque: mean_n_mm / torque_n_mm,
        share_of_torque_at_peak: peak_n_mm / torque_n_mm,
    })
}

fn at_angles(revolution: &Revolution) -> Vec<AtAngle> {
    let at = |(turn, force): (f64, &CutForce)| AtAngle {
        angle_deg: turn.to_degrees(),
        force_n: force.force_n.into(),
        moment_n_mm: force.moment_n_mm.into(),
        torque_n_mm: force.torque_n_mm(),
    };
    revolution.turns().zip(&revolution.forces).map(at).collect()
}

fn assumed(material: &Material, tool: &CutTool, cut: &Cut) -> Vec<String> {
    let mut list = material.assumptions.clone();
    let mut say = |text: &str| list.push(text.to_owned());
    if material.chip_mm.is_none() {
        say("At which thicknesses of chip its law was measured is not known.");
    }
    say("Tool and part are rigid: the cut is as wide and as deep as it was asked.");
    match cut.part {
        Part::Slot => {}
        Part::Side(_) => say("The cut is straight: in an inside corner the arc is longer."),
    }
    if tool.tool.run_out().offset_mm == 0.0 {
        say("All teeth cut alike: run-out raises the peaks (--run-out-um).");
    }
    let rounded = match tool.tool.shape() {
        Shape::Ball => true,
        Shape::Bull { corner_radius_mm } => corner_radius_mm > 0.0,
        Shape::Flat | Shape::Face { .. } => false,
    };
    if rounded && !matches!(cut.part, Part::Slot) {
        say(
            "At every height the arc in the material is that of this width at the full diameter; near the tip, where the tool is narrower, the true one is another.",
        );
    }
    if matches!(tool.tool.shape(), Shape::Face { .. }) {
        say("The inserts are straight: corner radius and wiper are left out.");
    }
    list
}
