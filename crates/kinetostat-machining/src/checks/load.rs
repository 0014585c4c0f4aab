//! Plausibility of the load on the tool for cutting: its size, its lever, its sign, and that it acts at all.

use kinetostat::Wrench;
use kinetostat::number::short;
use kinetostat_program::{Move, SpindleRotation};
use nalgebra::Vector3;

use crate::checks::{Exceeded, ODD};
use crate::limits::Limits;
use crate::load::law::{CuttingLoad, LoadAxes, ProgramLoad};
use crate::placement::Placement;
use crate::result::point::{PointKind, PointResult};
use crate::task::Task;
use crate::warning::{Warning, WarningCode};
use crate::weight_correction::WeightCorrection;

/// A cutting load has a moment about the tip of at most its force by a large cutter's radius, m.
const LEVER: f64 = 0.3;

/// The largest wrench that the load law gives, in part axes (of a law that turns: at one heading).
pub(crate) fn of_law(cutting: CuttingLoad, placement: &Placement) -> Wrench {
    let part_from_base = placement
        .base_from_part
        .rotation
        .inverse()
        .to_rotation_matrix();
    match cutting {
        CuttingLoad::None => Wrench::zero(),
        CuttingLoad::Milling {
            radial,
            tangential,
            axial,
        } => Wrench::new(Vector3::new(tangential, -radial, axial), Vector3::zeros()),
        CuttingLoad::FromCut { largest, .. } => largest,
        CuttingLoad::Constant { axes, wrench } => match axes {
            LoadAxes::Feed => wrench,
            LoadAxes::Base => wrench.rotated(&part_from_base),
            LoadAxes::Tool => wrench
                .rotated(&placement.tool_orientation.to_rotation_matrix())
                .rotated(&part_from_base),
        },
    }
}

pub(crate) fn numbered(tool: Option<u32>) -> String {
    tool.map_or_else(String::new, |number| format!("tool {number}"))
}

/// Every load of a question, and whose it is.
pub(crate) fn loads(task: &Task<'_>) -> Vec<(String, ProgramLoad)> {
    let of_tools = task.tools.iter();
    std::iter::once((String::new(), task.load))
        .chain(of_tools.map(|tool| (numbered(Some(tool.number)), tool.load)))
        .collect()
}

/// A load of one place, a map, a curve or a search that is beyond the usual limits: an analysis warns where a program would be
/// refused.
#[must_use]
pub fn large_load(wrench: &Wrench) -> Vec<Warning> {
    let limits = Limits::default();
    let mut exceeded = Exceeded {
        limits: &limits,
        found: Vec::new(),
    };
    exceeded.above("force_n", wrench.force().norm(), None, String::new());
    exceeded.above("moment_n_m", wrench.moment().norm(), None, String::new());
    // No limit is moved where no program is written.
    exceeded
        .found
        .iter()
        .map(|beyond| Warning::new(WarningCode::OverLimit, beyond.description()))
        .collect()
}

/// A load of one place or of a map that is beyond the usual limits, or near them.
#[must_use]
pub fn unusual_load(wrench: &Wrench) -> Vec<Warning> {
    let (force, moment) = (wrench.force().norm(), wrench.moment().norm());
    let near = near_limits(&Limits::default(), force, moment);
    let near = near.map(|text| Warning::new(WarningCode::LargeLoad, text));
    large_load(wrench).into_iter().chain(near).collect()
}

/// A force (N) and a moment (N m) that are allowed and larger than cutting has them, in words.
fn near_limits(limits: &Limits, force: f64, moment: f64) -> impl Iterator<Item = String> + use<> {
    let near = |found: f64, limit: f64| found > ODD * limit && found <= limit;
    let of_force = near(force, limits.force_n).then(|| {
        format!(
            "the force on the tool is {} N: robots mill with 50 to 1000 N; check the unit",
            short(force)
        )
    });
    let of_moment = near(moment, limits.moment_n_m).then(|| {
        format!(
            "the moment on the tool is {} N m: cutting torques are 0.1 to 100 N m; check the unit (N m, not N mm)",
            short(moment)
        )
    });
    of_force.into_iter().chain(of_moment)
}

pub(crate) fn odd_load(task: &Task<'_>, whose: &str, load: &ProgramLoad) -> Vec<Warning> {
    let mut list = Vec::new();
    let limits = &task.bounds.limits;
    let wrench = of_law(load.cutting, &task.placement);
    let (f, m) = (wrench.force(), wrench.moment());
    let (force, moment) = (f.norm(), m.norm());
    if force == 0.0 && moment == 0.0 {
        return list;
    }
    let mut warn = |code, text: String| {
        let text = match whose {
            "" => text,
            whose => format!("{whose}: {text}"),
        };
        list.push(Warning::new(code, text));
    };
    if force < 1.0 && moment < 0.01 {
        warn(
            WarningCode::SmallLoad,
            format!(
                "the load on the tool is only {} N and {} N m: cutting takes 10 to 1000 N; check the unit",
                short(force),
                short(moment)
            ),
        );
    }
    for text in near_limits(limits, force, moment) {
        warn(WarningCode::LargeLoad, text);
    }
    if force > 0.0 && moment > LEVER * force {
        warn(
            WarningCode::LongLever,
            format!(
                "the moment on the tool, {} N m, is that of its force {} m away from the tip: check the unit (N m, not N mm)",
                short(moment),
                short(moment / force)
            ),
        );
    }
    // Even a helix of 45 degrees pulls no more along the axis than it pushes across.
    if f.z < 0.0 && -f.z > f.xy().norm() && -f.z >= 1.0 {
        warn(
            WarningCode::PullingForce,
            format!(
                "the force on the tool is {} N along -z of the program: it pulls the tool into the part, more than it pushes across, and even a helix of 45 degrees pulls by less: check the sign",
                short(-f.z)
            ),
        );
    }
    list
}

/// Warnings about missing inputs: any load, the weight of a machine whose weight is to be corrected, the start of a spindle that
/// mills.
pub(crate) fn left_out(task: &Task<'_>) -> Vec<Warning> {
    let (all, mut list) = (loads(task), Vec::new());
    let weighs = task.mechanism.has_own_loads();
    let corrected = !matches!(
        task.weight,
        WeightCorrection::NotStated | WeightCorrection::None
    );
    if corrected && !weighs {
        list.push(Warning::new(
            WarningCode::NoWeight,
            "weight is to be corrected, and the model has none: no gravity_m_per_s2, no masses, no loads of its own; state them in the model, or leave weight out",
        ));
    }
    let is_still = all
        .iter()
        .all(|(_, load)| load.cutting == CuttingLoad::None);
    if is_still && !(corrected && weighs) && task.run_inputs.model_deviations.is_empty() {
        list.push(Warning::new(
            WarningCode::LoadNeverActs,
            "no load on the tool is given: the figures are those of a machine that cuts nothing. Write --milling or --force or, in the job, [load] or [material]",
        ));
    }
    let path = task.path();
    let mills = (all.iter()).any(|(_, load)| matches!(load.cutting, CuttingLoad::Milling { .. }));
    let stands = |m: &Move| path.spindle_on(m.line).rotation == SpindleRotation::Stopped;
    let mut cuts = path.moves.iter().filter(|m| m.is_known_feed());
    let first = cuts.clone().next();
    // A robot's cell, and a part of a program, may have started it elsewhere.
    let has_words = !path.spindle_changes.is_empty() && path.part.is_none();
    if let Some(first) = first.filter(|_| mills && has_words && cuts.all(stands)) {
        list.push(Warning::at_line(
            WarningCode::SpindleNotStarted,
            first.line,
            "the tool mills, and the program, which has words for the spindle, never starts it: add M3 or M4",
        ));
    }
    list
}

/// A load that is given and acts nowhere along the program.
pub(crate) fn never_acts(task: &Task<'_>, points: &[PointResult]) -> Option<Warning> {
    let acts_on = |(_, load): &(String, ProgramLoad)| {
        of_law(load.cutting, &task.placement).force().norm() > 0.0
    };
    let cuts = |p: &&PointResult| p.kind != PointKind::Rapid;
    let acts = |p: &PointResult| p.force_n.iter().any(|x| *x != 0.0);
    if !loads(task).iter().any(acts_on) || points.iter().filter(cuts).any(acts) {
        return None;
    }
    let why = match task.load.below_z_mm {
        Some(z) => format!("no feed move goes below Z {} mm", short(z)),
        None => "the program has no feed move on which it could act".to_owned(),
    };
    Some(Warning::new(
        WarningCode::LoadNeverActs,
        format!("the load never acts: {why}; only weights and deviations are corrected"),
    ))
}
