//! The model compared with measured poses, stable names with units.

use std::path::Path;

use kinetostat::MotionKind;
use kinetostat_analysis::measured_poses::{
    Axis, ControllerCoordinates, Coupling, Difference, Explained, Explanation, Frame, MeasuredPose,
    Tolerance, difference, explain, remaining_differences,
};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::Model;
use schemars::JsonSchema;
use serde::Serialize;

use crate::check::poses::pose_row::PoseRow;
use crate::check::poses::tables::{PoseTables, pose_tables};
use crate::machine::units::unit;
use crate::model::compare::FrameMap;
use crate::place::joints::{self, Named};
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// The answer, stable names with units.
#[derive(Serialize, JsonSchema)]
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
    /// Tables of the model file for the first explanation.
    pub(crate) tables: Option<PoseTables>,
    /// Reason why that explanation is not written as tables.
    pub(crate) tables_missing: Option<String>,
    /// Nearest explanation if nothing explains them, and the largest differences that it leaves.
    pub(crate) nearest: Option<Nearest>,
}

#[derive(Serialize, JsonSchema)]
pub(crate) struct PoseFinding {
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) measured_position_mm: [f64; 3],
    pub(crate) computed_position_mm: [f64; 3],
    pub(crate) difference_mm: f64,
    /// Absent if no orientation was measured.
    pub(crate) difference_deg: Option<f64>,
}

#[derive(Serialize, JsonSchema)]
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
    let first = explained.fitting.first().filter(|_| !agrees);
    let tables = first.map(|e| pose_tables(model, names, &measured, e));
    Ok(PoseComparison {
        tables_missing: match &tables {
            Some(Err(error)) => Some(error.to_string()),
            _ => None,
        },
        tables: tables.and_then(Result::ok),
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
        let computed = controller.pose(&row.measured.joints).map_err(|reason| {
            ErrorCode::FileForm.failure(format!("line {}: {reason}", row.line))
        })?;
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
    let most = Difference::largest(differences);
    let forward = |shown: &[f64]| controller.tool(shown);
    let unexplained = Explanation::default();
    let before = remaining_differences(&forward, measured, words.axes, &unexplained)?;
    if most.distance > 0.5 * Difference::largest(&before).distance {
        return None;
    }
    Some(Nearest {
        in_words: words.of(explanation, false),
        difference_mm: most.distance * 1e3,
        difference_deg: most.angle.map(f64::to_degrees),
    })
}

/// Data for the words of an explanation: the axes, their values in the file, and their joints in the model.
pub(crate) struct ExplanationText<'a> {
    pub(crate) names: &'a [Named],
    pub(crate) axes: &'a [Axis],
    pub(crate) joints: &'a [String],
}

impl ExplanationText<'_> {
    /// `sign of A3 is reversed; A2 is shifted by 90 deg`. With `advice`, what to write.
    pub(crate) fn of(&self, e: &Explanation, advice: bool) -> String {
        let names = self.names;
        let name = |i: usize| names[i].0.as_str();
        let mut parts = Vec::new();
        match e.reversed.as_slice() {
            [] => {}
            [one] => parts.push(format!("sign of {} is reversed", name(*one))),
            several => {
                let list: Vec<&str> = several.iter().map(|&i| name(i)).collect();
                parts.push(format!("signs of {} are reversed", list.join(", ")));
            }
        }
        for &(i, by) in &e.offsets {
            let (unit, size) = unit(names[i].1);
            // The offset is added to the shown value: the model's zero is there.
            parts.push(format!(
                "zero of {} is off: {} {unit} have to be added to what is shown",
                name(i),
                short(by / size)
            ));
        }
        parts.extend(e.coupling.map(|c| self.coupling(e, c, advice)));
        match &e.frame {
            Some(Frame::Base(pose)) => parts.push(format!(
                "the base frame is another one: the model's base is {}",
                FrameMap::new(pose).description()
            )),
            Some(Frame::Tool(pose)) => parts.push(format!(
                "the tool frame is another one: the measured one is, in the model's tool frame, {}",
                FrameMap::new(pose).description()
            )),
            None => {}
        }
        let text = parts.join("; ");
        if advice && !e.reversed.is_empty() && e.offsets.is_empty() && e.coupling.is_none() {
            return format!("{text} (change 'reversed' of it in the section [controller])");
        }
        text
    }

    /// `J3 is coupled with J2: the model needs J3 + J2`. With `advice`, what to write.
    fn coupling(&self, e: &Explanation, coupling: Coupling, advice: bool) -> String {
        let name = |i: usize| self.names[i].0.as_str();
        let share_of = |i: usize, j: usize| {
            let declared = self.axes[i].coupled.iter().find(|c| c.0 == j);
            declared.map_or(0.0, |c| c.1)
        };
        // A share between a slide and a turn has a unit of its own; it is not written as a number.
        let ratio = |i: usize, j: usize, share: f64| {
            if self.axes[i].turns == self.axes[j].turns {
                format!(" ratio = {}", short(share))
            } else {
                " the ratio with the other sign".to_owned()
            }
        };
        match coupling {
            Coupling::Missing { axis, other, share } => {
                let sign = if share < 0.0 { "-" } else { "+" };
                let (own, theirs) = (name(axis), name(other));
                let text = format!(
                    "{own} is coupled with {theirs}: the model needs {own} {sign} {theirs}"
                );
                if !advice {
                    return text;
                }
                let turned = if e.reversed.contains(&axis) {
                    1.0
                } else {
                    -1.0
                };
                format!(
                    "{text} (write in the section [controller], at {own}: coupled = [{{ joint = \"{}\", ratio = {} }}])",
                    self.joints[other],
                    short(turned * share * self.axes[other].ratio)
                )
            }
            Coupling::Reversed { axis, other } => {
                let text = format!(
                    "the coupling of {} with '{}' has the wrong sign",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], in 'coupled' of {}, write for '{}'{})",
                    name(axis),
                    self.joints[other],
                    ratio(axis, other, -share_of(axis, other))
                )
            }
            Coupling::Absent { axis, other } => {
                let text = format!(
                    "{} is declared to be coupled with '{}', but the controller shows it without",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], remove '{}' from 'coupled' of {})",
                    self.joints[other],
                    name(axis)
                )
            }
        }
    }
}
