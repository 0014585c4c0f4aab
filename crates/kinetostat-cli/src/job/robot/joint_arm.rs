//! The arm of a table of joint values: the model says which poses they give.

use std::sync::Arc;

use kinetostat::{Pose, PostureRequest};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{JointArm, Motion, RobotProgram, TableArm, Target, read};
use kinetostat_machining::{ArmConfiguration, ArmJoints};
use kinetostat_model::{Controller, Model};
use kinetostat_program::Warning;
use nalgebra::Isometry3;

use crate::files::input_files::InputFiles;
use crate::job::arguments::ProgramArgs;
use crate::job::job_file::{JobFile, model_named};
use crate::job::robot::source::RobotSource;
use crate::job::tools::tool;
use crate::ui::failure::{Answer, Failing};
use crate::ui::numbers::short;

/// An arm of six turning joints, for a table in degrees: as the controller shows them where the model says how that is.
#[derive(Debug)]
pub(crate) struct ArmOfTable {
    arm: ArmJoints,
    controller: Option<Controller>,
}

impl ArmOfTable {
    /// Returns the arm of a model with a tool in its flange; none for a machine with other joints.
    pub(crate) fn of(model: &Model, tool: &Pose) -> Option<Self> {
        Some(Self {
            arm: ArmJoints::of(&model.mechanism.with_tool(tool))?,
            controller: model.controller.clone(),
        })
    }

    /// Joint values are those that the controller shows, not those of the model.
    pub(crate) fn has_controller(&self) -> bool {
        self.controller.is_some()
    }

    /// The configuration at what stands in the table, deg; none of an arm whose last three axes do not meet in one point.
    pub(crate) fn configuration_at(&self, shown_deg: &[f64]) -> Option<ArmConfiguration> {
        self.arm
            .configuration_by_joints(&self.model_joints(shown_deg))
    }

    /// The model's joint values, rad.
    pub(crate) fn model_joints(&self, shown_deg: &[f64]) -> [f64; 6] {
        let joints: Vec<f64> = shown_deg.iter().map(|value| value.to_radians()).collect();
        let joints = match &self.controller {
            None => joints,
            Some(controller) => {
                let axes = controller.axes().iter().zip(&joints);
                let shown: Vec<f64> = axes.map(|(axis, x)| x / axis.unit.in_si()).collect();
                controller.joints(&shown).unwrap_or_default()
            }
        };
        std::array::from_fn(|joint| joints.get(joint).copied().unwrap_or(f64::NAN))
    }

    /// Joint values as the table has them, deg.
    pub(crate) fn shown_deg(&self, joints: &[f64; 6]) -> Option<Vec<f64>> {
        let Some(controller) = &self.controller else {
            return Some(joints.map(f64::to_degrees).to_vec());
        };
        let shown = controller.coordinates(joints)?;
        let axes = controller.axes().iter().zip(shown);
        Some(
            axes.map(|(axis, x)| (x * axis.unit.in_si()).to_degrees())
                .collect(),
        )
    }
}

impl JointArm for ArmOfTable {
    fn joint_count(&self) -> usize {
        6
    }

    fn tool_pose(&self, joints: &[f64]) -> Isometry3<f64> {
        let tool = self.arm.tool_at(&self.model_joints(joints));
        Isometry3::from_parts((1e3 * tool.translation.vector).into(), tool.rotation)
    }

    fn joints_near(&self, tool: &Isometry3<f64>, near: &[f64]) -> Option<Vec<f64>> {
        let tool = Pose::from_parts((1e-3 * tool.translation.vector).into(), tool.rotation);
        self.shown_deg(&self.arm.next_to(&tool, &self.model_joints(near))?)
    }
}

/// Gives a table of joint values the arm of the model, with its tool; other programs stay as they are.
pub(crate) fn give_arm(
    source: Option<&mut RobotSource>,
    files: &InputFiles,
    job: Option<&JobFile>,
    flag_model: Option<&str>,
    flags: &ProgramArgs,
) -> Answer<()> {
    let Some(source) = source.filter(|source| source.language.is_list()) else {
        return Ok(());
    };
    // Faults of the program are reported by its own reader.
    let Ok(program) = read(
        source.language,
        source.files.clone(),
        &source.settings.reading,
    ) else {
        return Ok(());
    };
    let joints = |motion: &&Motion| matches!(motion.target, Target::Joints { .. });
    let Some(first) = program.motions.iter().find(joints) else {
        return Ok(());
    };
    let refuse = |reason: String| {
        let line = first.line;
        Err(ErrorCode::ProgramUnsuited.failure(format!(
            "line {line}: the table states joint values{reason}"
        )))
    };
    let Some(between) = source.settings.joint_rows else {
        return refuse(", and how the controller moves from row to row is not stated: state it, joint_rows = \"joint\" (all joints in step) or \"linear\" (the tool on a straight line), under [robot] in the job file, or --joint-rows".to_owned());
    };
    let name = &first.tool.name;
    if let Some(other) = program
        .motions
        .iter()
        .find(|motion| motion.tool.name != *name)
    {
        return refuse(format!(
            " of several tools, `{name}` and on line {} `{}`: write one table for each tool",
            other.line, other.tool.name
        ));
    }
    let is_stated = flags.tool_length_mm.is_some()
        || job.is_some_and(|j| j.job.tool.length_mm.is_some() || j.job.tool.pose.is_some());
    let tool = match (first.tool.known(), is_stated) {
        (Some(frame), _) => {
            Pose::from_parts((1e-3 * frame.translation.vector).into(), frame.rotation)
        }
        (None, true) => tool(job, flags)?.0,
        (None, false) => {
            return refuse(", and where the tip of the tool is in the flange is not stated: state length_mm or pose under [tool] in the job file, or --tool-length-mm (0: the flange itself); to convert the table, pose under [tool] in the template".to_owned());
        }
    };
    let (named, base) = model_named(job, flag_model)?;
    let (model, _) = files.model(&named, &base)?;
    let Some(arm) = ArmOfTable::of(&model, &tool) else {
        return refuse(format!(
            ", and the model '{named}' is no arm of six turning joints in one chain: write poses (x_mm, y_mm, z_mm, qw, qx, qy, qz)"
        ));
    };
    source.settings.beyond_limits =
        rows_beyond_limits(&model, |shown| arm.model_joints(shown), &program);
    let in_mm = Isometry3::from_parts((1e3 * tool.translation.vector).into(), tool.rotation);
    let reading = &mut source.settings.reading;
    reading.frames.insert(name.clone(), in_mm);
    reading.arm = Some(TableArm {
        arm: Arc::new(arm),
        between,
    });
    source.settings.joints_are = Some(match &model.controller {
        Some(_) => "joint values are taken as the controller shows them: [controller] of the model",
        None => {
            "joint values are taken as those of the model, which has no [controller]: zeros and directions of the controller's axes may be others"
        }
    });
    Ok(())
}

/// Stretches of rows that are named; further ones are counted.
const MOST_NAMED: usize = 20;

/// Excess over a limit that is a matter of digits, rad.
const DIGITS: f64 = 1e-6;

/// Rows one behind the other in which a joint is beyond the same limit.
struct Stretch {
    joint: String,
    limit: f64,
    /// The other side of its range.
    other: f64,
    first: usize,
    last: usize,
    /// Index of its last row.
    row: usize,
    /// Line and value where it is farthest beyond.
    most: (usize, f64),
}

/// Warnings about rows beyond limits; `program` is the table with its joint values, `model_joints` converts the values of a row
/// (deg) to those of the model, rad.
fn rows_beyond_limits(
    model: &Model,
    model_joints: impl Fn(&[f64]) -> [f64; 6],
    program: &RobotProgram,
) -> Vec<Warning> {
    let mut found: Vec<Stretch> = Vec::new();
    for (row, motion) in program.motions.iter().enumerate() {
        let Target::Joints { values_deg } = &motion.target else {
            continue;
        };
        let commands = model_joints(values_deg);
        let posture = (model.mechanism).posture(PostureRequest::commands(&commands));
        // Non-finite values are refused by the reader of the rows.
        let Ok(posture) = posture else { continue };
        for (joint, value, (low, high)) in posture.limit_violations() {
            let (limit, other) = match value < low {
                true => (low, high),
                false => (high, low),
            };
            if (value - limit).abs() < DIGITS {
                continue;
            }
            let known = found
                .iter_mut()
                .rev()
                .find(|known| known.joint == joint && known.limit == limit && known.row + 1 == row);
            match known {
                Some(known) => {
                    (known.last, known.row) = (motion.line, row);
                    if (value - limit).abs() > (known.most.1 - limit).abs() {
                        known.most = (motion.line, value);
                    }
                }
                None => found.push(Stretch {
                    joint,
                    limit,
                    other,
                    first: motion.line,
                    last: motion.line,
                    row,
                    most: (motion.line, value),
                }),
            }
        }
    }
    let unnamed = found.split_off(MOST_NAMED.min(found.len()));
    let mut said: Vec<Warning> = found.iter().map(Stretch::warning).collect();
    if let Some(first) = unnamed.first() {
        said.push(Warning::new(
            first.first,
            format!(
                "from here on joints are beyond their limits in {} more stretches of rows",
                unnamed.len()
            ),
        ));
    }
    said
}

impl Stretch {
    fn warning(&self) -> Warning {
        let degrees = |value: f64| short(value.to_degrees());
        let (line, value) = self.most;
        let place = match (self.first == self.last, line == self.first) {
            (true, _) => String::new(),
            (false, true) => format!(" (and beyond it up to line {})", self.last),
            (false, false) => format!(
                " in line {line} (beyond it from here to line {})",
                self.last
            ),
        };
        // Equivalent angle, whole turns away.
        let turn = std::f64::consts::TAU.copysign(self.other - self.limit);
        let turned = value + turn * ((self.limit - value) / turn).ceil();
        let (low, high) = (self.limit.min(self.other), self.limit.max(self.other));
        let instead = match (low..=high).contains(&turned) {
            true => format!(", where {} deg is the same place", degrees(turned)),
            false => String::new(),
        };
        Warning::new(
            self.first,
            format!(
                "{} is at {} deg{place}, and its limit in the model is {} deg: a controller stops there. Let the program be written inside the limits{instead}, or change limits_deg in the model if the arm goes farther",
                self.joint,
                degrees(value),
                degrees(self.limit)
            ),
        )
    }
}
