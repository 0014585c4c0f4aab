//! Warnings about unusual values of the question and its answer: usually a unit is wrong.

use kinetostat::Directions;
use kinetostat::number::{largest, short};
use kinetostat_program::{Move, MoveKind, WriteOptions};
use nalgebra::Vector3;

use crate::checks::ODD;
use crate::checks::correction::{besides, odd_correction};
use crate::checks::load::{left_out, loads, never_acts, odd_load};
use crate::checks::own_weight::by_own_loads;
use crate::checks::placement::{odd_tool, origin_in_metres, outside_workspace};
use crate::limits::Limits;
use crate::result::point::{PointResult, most, size};
use crate::result::summary::Summary;
use crate::task::{Task, ToolGiven};
use crate::warning::{Warning, WarningCode};

/// Softer tools than this are no machines that cut, N/mm.
const SOFT: f64 = 50.0;

/// Stiffer tools than this are no machines, N/mm.
const STIFF: f64 = 1e6;

/// Wider tolerances than this are not those of cutting, mm.
const WIDE_MM: f64 = 0.1;

/// Backward steps up to this are as long as corrections are, mm.
const LONG_STEP_MM: f64 = 1.0;

/// Tolerances that are allowed and unusual.
#[must_use]
pub fn odd_tolerances(writing: &WriteOptions) -> Vec<Warning> {
    let wide = [
        ("path", writing.tolerance_mm),
        ("chord", writing.chord_tolerance_mm),
    ];
    let wide = wide.into_iter().filter(|(_, mm)| *mm > WIDE_MM);
    let wide = wide.map(|(name, mm)| {
        format!(
            "the {name} tolerance is {} mm: machine tools hold hundredths of a millimetre; {name}_um is in micrometres",
            short(mm)
        )
    });
    let backward = writing.backward_step_mm;
    let long = (backward > LONG_STEP_MM).then(|| {
        format!(
            "steps that cut backwards are not warned of up to {} mm: at corners they are as long as the corrections; backward_step_um is in micrometres",
            short(backward)
        )
    });
    wide.chain(long)
        .map(|said| Warning::new(WarningCode::WideTolerance, said))
        .collect()
}

/// Warnings about unusual values of a question, before anything is solved.
#[must_use]
pub fn unusual_question(task: &Task<'_>) -> Vec<Warning> {
    let mut list: Vec<Warning> = odd_loads(task).collect();
    list.extend(odd_tools(task));
    list.extend(odd_tool_axis(task));
    list.extend(at_pole(task));
    list.extend(odd_tolerances(&task.writing));
    list
}

fn odd_loads<'t>(task: &'t Task<'_>) -> impl Iterator<Item = Warning> + use<'t> {
    let loads = loads(task).into_iter();
    let of_each = loads.flat_map(move |(whose, load)| odd_load(task, &whose, &load));
    left_out(task).into_iter().chain(of_each)
}

fn odd_tools<'t>(task: &'t Task<'_>) -> impl Iterator<Item = Warning> + use<'t> {
    let tools = task.bounds.tools.iter();
    tools.flat_map(move |tool| {
        [odd_tool(task, tool), tip_behind_flange(task, tool)]
            .into_iter()
            .flatten()
    })
}

/// Warnings about what is allowed and unusual, of the question first.
pub(crate) fn unusual(
    task: &Task<'_>,
    points: &[PointResult],
    summary: &Summary,
    compensated: bool,
) -> Vec<Warning> {
    let mut list: Vec<Warning> = odd_loads(task).collect();
    list.extend(never_acts(task, points));
    list.extend(odd_tools(task));
    list.extend(odd_tool_axis(task));
    list.extend(at_pole(task));
    list.extend(origin_in_metres(
        task.mechanism,
        &task.placement,
        task.path(),
        task.bounds.is_unplaced,
    ));
    list.extend(outside_workspace(task, points));
    let limits = &task.bounds.limits;
    if let Some((size, at)) = most(points, |p| size(&p.correction_mm)).filter(|_| compensated) {
        let tolerance = task.writing.tolerance_mm;
        let scale = task.placement.scale;
        // A large one is compared without the part of own weight.
        let size = match scale * size > ODD * limits.correction_mm {
            true => {
                let own = by_own_loads(task, &[at])
                    .pop()
                    .flatten()
                    .unwrap_or_default();
                besides(at, &own.error).max(2.0 * tolerance)
            }
            false => size,
        };
        list.extend(odd_correction(
            limits,
            scale * size,
            Some(at.line),
            scale * tolerance,
        ));
    }
    if compensated {
        list.extend(odd_tolerances(&task.writing));
    }
    list.extend(unusual_figures(task, summary));
    list
}

/// Warnings about unusual figures of a whole run: of a long program they are those of all its parts.
pub(crate) fn unusual_figures(task: &Task<'_>, summary: &Summary) -> Vec<Warning> {
    let mut list = Vec::new();
    let limits = &task.bounds.limits;
    let stiffness = summary.smallest_stiffness_n_per_mm;
    // The stiffness is infinite if nothing was solved.
    let is_known = stiffness.is_finite();
    if summary.stable && is_known && !(SOFT..=STIFF).contains(&stiffness) {
        let which = if stiffness < SOFT {
            "softer"
        } else {
            "stiffer"
        };
        list.push(Warning::new(
            WarningCode::OddStiffness,
            format!(
                "the tool gives way with {} N/mm in its softest direction, {which} than machines that cut (arms 100 to 2000, parallel machines up to 100000 N/mm): check the units of the stiffnesses",
                short(stiffness)
            ),
        ));
    }
    let mut near = |name: &str, odd: f64, value: f64, text: &str| {
        let limit = Limits::named(name).map_or(f64::NAN, |l| limits.get(l));
        if value > odd * limit && value <= limit {
            list.push(Warning::new(
                WarningCode::NearLimit,
                format!(
                    "{text} {} of the {} that are allowed",
                    largest(value, ""),
                    short(limit)
                ),
            ));
        }
    };
    near(
        "tilt_deg",
        ODD,
        summary.max_residual_rotation_deg,
        "the tool is tilted, in degrees, by",
    );
    if let Some(share) = summary.largest_share_to_buckling {
        near(
            "share_of_buckling",
            0.4,
            share,
            "the share of the way to buckling is",
        );
    }
    if let Some(share) = summary.largest_share_of_rating {
        near(
            "share_of_rating",
            0.8,
            share,
            "a drive is loaded, as a share of its rating, by",
        );
    }
    list
}

/// Cosine of the angle between feed and tool from which on the tool is taken to go along its axis: 20 degrees.
const ALONG: f64 = 0.94;

/// Share of the feed path along the tool from which on it is no milling.
const MOST: f64 = 0.5;

/// Flanges that lie less behind the tip are beside it, mm.
const LEAST_MM: f64 = 1e-3;

/// Warning if most of the path lies along the tool's axis, which a load that turns with the feed needs: it is another
/// axis of the tool's frame, or a program that drills.
fn odd_tool_axis(task: &Task<'_>) -> Option<Warning> {
    let path = task.path();
    let turns = loads(task).iter().any(|(_, load)| load.turns());
    if !turns || path.moves.iter().all(|motion| motion.tool_turn.is_none()) {
        return None;
    }
    let (mut all, mut along, mut first) = (0.0, 0.0, None);
    for (index, motion) in path.moves.iter().enumerate() {
        if motion.kind != MoveKind::Feed || !motion.is_known_feed() {
            continue;
        }
        let length = motion.length_mm();
        all += length;
        let direction = path.tool_direction(index, 0.5);
        let part = motion.tangent(0.5).map_or(0.0, |t| t.dot(&direction).abs());
        if part > ALONG {
            along += length;
            first.get_or_insert(motion.line);
        }
    }
    let line = first.filter(|_| along > MOST * all)?;
    // A component of rounding error is shown as zero.
    let [x, y, z] = [0, 1, 2].map(|k| match path.tool_axis[k].abs() < 1e-9 {
        true => "0".to_owned(),
        false => short(path.tool_axis[k]),
    });
    Some(Warning::at_line(
        WarningCode::OddToolAxis,
        line,
        format!(
            "the tool goes along its own axis on {:.0} % of the path at feed, first here, and the force of milling then has no direction across it: is the tool's axis ({x}, {y}, {z}) of its frame? State it as tool_axis under [robot], from the tip to the holder",
            100.0 * along / all
        ),
    ))
}

/// Warning of a flange on the wrong side of the tip: the axis of a tool points from its tip to its holder. The tool then
/// points into the ram: a wrong sign of its length, or of the flange's frame.
fn tip_behind_flange(task: &Task<'_>, tool: &ToolGiven) -> Option<Warning> {
    let path = task.path();
    let turned = path
        .moves
        .iter()
        .find(|motion| motion.tool_turn.is_some())?;
    let flange = tool.pose.inverse().translation.vector * 1e3;
    let along = flange.dot(&path.tool_axis);
    if along >= -LEAST_MM {
        return None;
    }
    let named = tool.number.map_or_else(String::new, |n| format!(" {n}"));
    Some(Warning::at_line(
        WarningCode::TipBehindFlange,
        turned.line,
        format!(
            "the tip of the tool{named} lies {} mm behind the flange, along the axis that the program gives the tool: it would point into the spindle. Turn z of the platform's home out of the spindle in the model, change the sign of the tool's z, or state the tool's axis (tool_axis under [robot], from the tip to the holder)",
            short(-along)
        ),
    ))
}

/// Warning if corrections of rotary axes are left out because the tool lies along one of them.
fn at_pole(task: &Task<'_>) -> Option<Warning> {
    if task.corrected != Directions::ALL {
        return None;
    }
    let path = task.path();
    let lies = |motion: &&Move| {
        let rotary = motion
            .tool_turn
            .as_ref()
            .and_then(|turn| turn.rotary.as_ref());
        let Some(rotary) = rotary.filter(|_| motion.is_known_feed()) else {
            return false;
        };
        let at_pole = |share: f64| {
            let angles = rotary.angles_deg(share);
            let none = Vector3::zeros();
            rotary.axes.turns_for(&angles, &path.tool_axis, &none).1
        };
        [0.0, 0.5, 1.0].into_iter().any(at_pole)
    };
    let mut moves = path.moves.iter().filter(lies);
    let line = moves.next()?.line;
    let more = match moves.count() {
        0 => String::new(),
        n => format!(" and in {n} more"),
    };
    Some(Warning::at_line(
        WarningCode::AtPole,
        line,
        format!(
            "the tool lies within 2 degrees of a rotary axis in this block{more}: turns about that axis are corrected in part, or not at all (nearer than 1 degree), and a tilt of the tool stays (the figures count it)"
        ),
    ))
}
