//! The model compared with measured poses, stable names with units.

use std::path::Path;

use kinetostat::MotionKind;
use kinetostat::number::larger;
use kinetostat_analysis::measured_poses::{
    ControllerCoordinates, Difference, Explained, Explanation, MeasuredPose, Tolerance, difference,
    explain, remaining_differences,
};
use kinetostat_model::Model;
use serde::Serialize;

use crate::check::poses::explanation_text::ExplanationText;
use crate::check::poses::pose_row::PoseRow;
use crate::machine::units::unit;
use crate::place::joints::{self, Named};
use crate::ui::failure::{Answer, Failure};

/// The answer, stable names with units.
#[derive(Serialize)]
pub(crate) struct PoseComparison {
    pub(crate) schema: u32,
    pub(crate) kinetostat_version: &'static str,
    pub(crate) model: String,
    pub(crate) model_source: String,
    pub(crate) poses_file: String,
    /// States whether the joints of the file are those of the controller or of the model.
    pub(crate) joints_are: &'static str,
    pub(crate) tolerance_mm: f64,
    pub(crate) tolerance_deg: f64,
    pub(crate) poses: Vec<PoseFinding>,
    pub(crate) agrees: bool,
    /// Simplest explanations of the differences within the tolerance; several are equally good.
    pub(crate) explanations: Vec<String>,
    pub(crate) ambiguous: bool,
    /// Nearest explanation if nothing explains them, and the largest differences that it leaves.
    pub(crate) nearest: Option<Nearest>,
}

#[derive(Serialize)]
pub(crate) struct PoseFinding {
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) measured_position_mm: [f64; 3],
    pub(crate) computed_position_mm: [f64; 3],
    pub(crate) difference_mm: f64,
    /// Absent if no orientation was measured.
    pub(crate) difference_deg: Option<f64>,
}

#[derive(Serialize)]
pub(crate) struct Nearest {
    pub(crate) in_words: String,
    pub(crate) difference_mm: f64,
    pub(crate) difference_deg: Option<f64>,
}

/// The joints of the file: the controller's axes, or the model's actuators.
pub(crate) fn axes(model: &Model) -> Vec<Named> {
    match &model.controller {
        Some(controller) => joints::on_axes(controller),
        None => {
            let m = &model.mechanism;
            let named = m.actuator_names().into_iter().zip(joints::kinds(m));
            named
                .map(|(name, kind)| (name, kind, unit(kind).1))
                .collect()
        }
    }
}

/// The model's joint of each axis.
fn joints_of(model: &Model) -> Vec<String> {
    let names = model.mechanism.actuator_names();
    match &model.controller {
        Some(c) => c.axes().iter().map(|a| names[a.joint].clone()).collect(),
        None => names,
    }
}

/// Compares the model and looks for what explains the differences.
pub(crate) fn compare(
    model: &Model,
    source: &str,
    file: &Path,
    names: &[Named],
    rows: &[PoseRow],
    tolerance: Tolerance,
    tolerance_mm: f64,
) -> Answer<PoseComparison> {
    let controller = ControllerCoordinates::of(model);
    let poses = findings(&controller, rows).map_err(|f| f.within(&file.display().to_string()))?;
    let kinds: Vec<MotionKind> = names.iter().map(|n| n.1).collect();
    let axes = controller.axes(&kinds);
    let words = ExplanationText {
        names,
        axes: &axes,
        joints: &joints_of(model),
    };
    let measured: Vec<MeasuredPose> = rows.iter().map(|p| p.measured.clone()).collect();
    let forward = |shown: &[f64]| controller.tool(shown);
    let explained = explain(&forward, &measured, &axes, controller.effort(), tolerance);
    let agrees = explained.fitting.first() == Some(&Explanation::default());
    let explanations: Vec<String> = match agrees {
        true => Vec::new(),
        false => explained
            .fitting
            .iter()
            .map(|e| words.of(e, true))
            .collect(),
    };
    Ok(PoseComparison {
        schema: 1,
        kinetostat_version: env!("CARGO_PKG_VERSION"),
        model: model.name().to_owned(),
        model_source: source.to_owned(),
        poses_file: file.display().to_string(),
        joints_are: match model.controller {
            Some(_) => "of the controller",
            None => "of the model",
        },
        tolerance_mm,
        tolerance_deg: tolerance.angle.to_degrees(),
        poses,
        agrees,
        ambiguous: explanations.len() > 1,
        explanations,
        nearest: nearest(&explained, &controller, &measured, &words),
    })
}

fn findings(controller: &ControllerCoordinates<'_>, rows: &[PoseRow]) -> Answer<Vec<PoseFinding>> {
    let each = rows.iter().map(|row| {
        let computed = controller
            .pose(&row.measured.joints)
            .map_err(|reason| Failure::input(format!("line {}: {reason}", row.line)))?;
        let off = difference(&row.measured, &computed);
        Ok(PoseFinding {
            name: row.name.clone(),
            line: row.line,
            measured_position_mm: (row.measured.position * 1e3).into(),
            computed_position_mm: (computed.translation.vector * 1e3).into(),
            difference_mm: off.distance * 1e3,
            difference_deg: off.angle.map(f64::to_degrees),
        })
    });
    each.collect()
}

/// Returns the nearest explanation if it reduces the differences noticeably.
fn nearest(
    explained: &Explained,
    controller: &ControllerCoordinates<'_>,
    measured: &[MeasuredPose],
    words: &ExplanationText<'_>,
) -> Option<Nearest> {
    let (explanation, differences) = explained.nearest.as_ref()?;
    if *explanation == Explanation::default() {
        return None;
    }
    let (distance, angle) = largest(differences);
    let forward = |shown: &[f64]| controller.tool(shown);
    let unexplained = Explanation::default();
    let before = remaining_differences(&forward, measured, words.axes, &unexplained)?;
    if distance > 0.5 * largest(&before).0 {
        return None;
    }
    Some(Nearest {
        in_words: words.of(explanation, false),
        difference_mm: distance * 1e3,
        difference_deg: angle.map(f64::to_degrees),
    })
}

fn largest(differences: &[Difference]) -> (f64, Option<f64>) {
    let distance = differences.iter().map(|d| d.distance).fold(0.0, larger);
    let angles = differences.iter().filter_map(|d| d.angle);
    let angle = angles.fold(None, |most, a| Some(most.map_or(a, |most| larger(most, a))));
    (distance, angle)
}
