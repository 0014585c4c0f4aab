//! Settings for reading and writing a robot's program, from options and the table `[robot]` of a job file.

use std::collections::{BTreeMap, BTreeSet};

use kinetostat::Directions;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::{
    BetweenRows, CutterCompensation, ExternalAxes, Language, LengthUnit, PathOptions, ReadOptions,
    StatedValue, TurnAboutAxis, UnknownTargets, WriteOptions as TextOptions,
};
use kinetostat_model::schema::{Axis, AxisName};
use kinetostat_program::Warning;
use nalgebra::Vector3;
use serde_spanned::Spanned;

use crate::job::job_file::JobFile;
use crate::job::robot_arguments::{AxisWord, CorrectWord, RobotArgs, StatedArgs};
use crate::job::robot_table::{
    CutterCompensationWord, ExternalAxesWord, LengthUnitWord, RobotTable, UnknownTargetsWord,
};
use crate::job::values::{above_zero, chosen};
use crate::ui::failure::{Answer, Failing};

/// Settings for reading and writing a robot's program.
#[derive(Clone, Debug)]
pub(crate) struct RobotSettings {
    pub(crate) reading: ReadOptions,
    pub(crate) making: PathOptions,
    pub(crate) writing: TextOptions,
    pub(crate) corrected: Directions,
    /// The axis of the tool is stated, and not the usual one of the language.
    pub(crate) axis_is_stated: bool,
    /// Interpolation of the controller between rows of joint values, if it is stated.
    pub(crate) joint_rows: Option<BetweenRows>,
    /// Description of the joint values of a table.
    pub(crate) joints_are: Option<&'static str>,
    /// Posture of the arm by the template of a converted program.
    pub(crate) made_arm: Option<MadeArm>,
    /// Rows of a table of joint values that are beyond limits of the model.
    pub(crate) beyond_limits: Vec<Warning>,
}

/// Posture of the arm by a template.
#[derive(Clone, Debug)]
pub(crate) struct MadeArm {
    /// The configuration is stated.
    pub(crate) states_configuration: bool,
    /// Start joints of the arm as the controller shows them, deg.
    pub(crate) start_joints_deg: Option<Vec<f64>>,
}

/// Settings for a program of a language; `usual_axis` is its own, from the tool's tip to its holder.
pub(crate) fn settings(
    job: Option<&JobFile>,
    flags: &RobotArgs,
    language: Language,
    usual_axis: Vector3<f64>,
) -> Answer<RobotSettings> {
    let table = job.and_then(|j| Some((j, j.job.robot.as_ref()?.get_ref())));
    let mut reading = ReadOptions::default();
    let mut making = PathOptions::default();
    making.tool_axis = usual_axis;
    let given = table.and_then(|(_, table)| table.rapid_from_mm_per_s.as_ref());
    making.rapid_from_mm_per_s = chosen(
        job,
        "--rapid-from-mm-per-s",
        flags.rapid_from_mm_per_s,
        given,
        above_zero,
    )?;
    let mut correct = CorrectWord::default();
    let mut joint_rows = flags.joint_rows;
    let mut axis_is_stated = flags.tool_axis.is_some();
    if let Some((j, table)) = table {
        frames(j, table, &mut reading)?;
        if let Some(axis) = &table.tool_axis {
            making.tool_axis = direction(j, axis)?;
            axis_is_stated = true;
        }
        if table.external_axes == Some(ExternalAxesWord::Carried) {
            reading.external_axes = ExternalAxes::Carried;
        }
        if table.unknown_targets == Some(UnknownTargetsWord::LeftAsWritten) {
            reading.unknown_targets = UnknownTargets::LeftAsWritten;
        }
        if table.cutter_compensation == Some(CutterCompensationWord::CentrePath) {
            reading.cutter_compensation = CutterCompensation::CentrePath;
        }
        if let Some(unit) = &table.length_unit {
            if !language.is_list() {
                return Err(j.error(
                    unit,
                    "this unit is for lists of poses: the program is in a language that has its own",
                    "leave it out",
                ));
            }
            reading.length_unit = Some(match unit.get_ref() {
                LengthUnitWord::Mm => LengthUnit::Millimetre,
                LengthUnitWord::M => LengthUnit::Metre,
            });
        }
        if let Some(rows) = &table.joint_rows {
            if !language.is_list() {
                return Err(j.error(
                    rows,
                    "this way is for tables of joint values: the program is in a language that has its own",
                    "leave it out",
                ));
            }
            joint_rows = joint_rows.or(Some(*rows.get_ref()));
        }
        correct = table.correct.unwrap_or(correct);
    }
    reading.moving_calls = moving_calls(job, flags, language)?;
    reading.values = stated_values(job, flags, language)?;
    if let Some(axis) = flags.tool_axis {
        making.tool_axis = match axis {
            AxisWord::X => Vector3::x(),
            AxisWord::Y => Vector3::y(),
            AxisWord::Z => Vector3::z(),
            AxisWord::MinusX => -Vector3::x(),
            AxisWord::MinusY => -Vector3::y(),
            AxisWord::MinusZ => -Vector3::z(),
        };
    }
    if let Some((j, Some(turn))) = table.map(|(j, table)| (j, &table.turn_about_axis)) {
        let of_tool = direction_of(j, turn, &turn.get_ref().tool)?;
        if of_tool.cross(&making.tool_axis).norm() < ALONG {
            return Err(j.error(
                turn,
                "this direction of the tool lies along its axis, so that it says no turn about it",
                "name another one of its frame, as in  turn_about_axis = { tool = \"y\", part = \"x\" }",
            ));
        }
        making.turn_about_axis = TurnAboutAxis::Towards {
            of_tool,
            in_part: direction_of(j, turn, &turn.get_ref().part)?,
        };
    }
    let corrected = flags.correct.unwrap_or(correct).directions();
    Ok(RobotSettings {
        reading,
        making,
        writing: TextOptions::default(),
        corrected,
        axis_is_stated,
        joint_rows: joint_rows.map(BetweenRows::from),
        joints_are: None,
        made_arm: None,
        beyond_limits: Vec::new(),
    })
}

/// Names of calls that are stated to move the tool.
fn stated_to_move(job: Option<&JobFile>, stated: &StatedArgs) -> BTreeSet<String> {
    let in_job = job.iter().flat_map(|j| j.job.calls.keys());
    let in_job = in_job.map(|name| name.get_ref().clone());
    in_job.chain(stated.moving_calls.iter().cloned()).collect()
}

fn moving_calls(
    job: Option<&JobFile>,
    flags: &RobotArgs,
    language: Language,
) -> Answer<BTreeSet<String>> {
    let found = stated_to_move(job, &flags.stated);
    match found.first() {
        Some(name) if !language.takes_values() => Err(ErrorCode::Unused.failure(format!(
                "'{name}' is stated to move the tool ([calls] in the job, --call), which is for programs that call others: leave it out"
            ),
        )),
        _ => Ok(found),
    }
}

/// Numbers of the subprograms of G-code that are stated to move the tool.
pub(crate) fn moving_subprograms(
    job: Option<&JobFile>,
    stated: &StatedArgs,
) -> Answer<BTreeSet<u32>> {
    let number = |name: &String| {
        let digits = name.trim_start_matches(['O', 'o']);
        digits.parse::<u32>().map_err(|_| {
            ErrorCode::Value.failure(format!(
                "'{name}' is stated to move the tool ([calls] in the job, --call), and a subprogram of G-code has a number: write it as O9810"
            ))
        })
    };
    stated_to_move(job, stated).iter().map(number).collect()
}

/// Values that only the controller knows, for programs that are run with them.
fn stated_values(
    job: Option<&JobFile>,
    flags: &RobotArgs,
    language: Language,
) -> Answer<BTreeMap<String, StatedValue>> {
    let of_job = job.iter().flat_map(|j| &j.job.values);
    let of_job = of_job.map(|(name, value)| (name.get_ref().clone(), StatedValue::from(value)));
    let mut found: BTreeMap<String, StatedValue> = of_job.collect();
    for (name, value) in &flags.stated.values {
        found.retain(|own, _| !own.eq_ignore_ascii_case(name));
        found.insert(name.clone(), value.clone());
    }
    match found.keys().next() {
        Some(name) if !language.takes_values() => Err(ErrorCode::Unused.failure(format!(
                "a value of '{name}' is stated ([values] in the job, --set), which is for programs that are run with values (of robots, Heidenhain, SINUMERIK): leave it out"
            ),
        )),
        _ => Ok(found),
    }
}

fn frames(j: &JobFile, table: &RobotTable, reading: &mut ReadOptions) -> Answer<()> {
    for (name, written) in &table.frames {
        let pose = written
            .get_ref()
            .pose()
            .map_err(|(message, help)| j.error(written, &message, &help))?;
        let in_mm = 1e3 * pose.translation.vector;
        let frame = nalgebra::Isometry3::from_parts(in_mm.into(), pose.rotation);
        reading.frames.insert(name.get_ref().clone(), frame);
    }
    Ok(())
}

/// Directions nearer to the tool's axis say no turn about it (1.1 degrees).
const ALONG: f64 = 0.02;

fn direction(j: &JobFile, axis: &Spanned<Axis>) -> Answer<Vector3<f64>> {
    direction_of(j, axis, axis.get_ref())
}

/// The direction of an axis that stands at a place of the job file.
fn direction_of<T>(j: &JobFile, at: &Spanned<T>, axis: &Axis) -> Answer<Vector3<f64>> {
    let vector = match axis {
        Axis::Named(AxisName::X) => Vector3::x(),
        Axis::Named(AxisName::Y) => Vector3::y(),
        Axis::Named(AxisName::Z) => Vector3::z(),
        Axis::Named(AxisName::MinusX) => -Vector3::x(),
        Axis::Named(AxisName::MinusY) => -Vector3::y(),
        Axis::Named(AxisName::MinusZ) => -Vector3::z(),
        Axis::Vector(v) => Vector3::from(*v),
    };
    let unit = vector
        .try_normalize(1e-9)
        .filter(|unit| unit.iter().all(|x| x.is_finite()));
    unit.ok_or_else(|| {
        j.error(
            at,
            "this axis has no direction",
            "write a letter (\"-z\", \"x\", ...) or three numbers that are not all zero",
        )
    })
}
