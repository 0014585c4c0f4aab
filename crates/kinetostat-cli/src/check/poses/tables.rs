//! Tables of the model file in which an explanation of measured poses is true, ready to paste.

use kinetostat::MotionKind;
use kinetostat_analysis::measured_poses::{
    ControllerCoordinates, CorrectionError, Difference, Explanation, Frame, MeasuredPose,
    corrected, difference,
};
use kinetostat_model::Model;
use kinetostat_model::schema::ControllerTable;
use schemars::JsonSchema;
use serde::Serialize;
use toml::{Table, Value};

use crate::model::compare::FrameMap;
use crate::place::joints::Named;
use crate::ui::numbers::short;

/// Tables that explain measured poses, as text and as numbers.
#[derive(Serialize, JsonSchema)]
pub(crate) struct PoseTables {
    /// The tables, to be pasted into the model file (TOML).
    pub(crate) toml: String,
    /// Number of poses that they rest on.
    pub(crate) poses: usize,
    /// Largest differences of these poses from the model with the tables.
    pub(crate) difference_mm: f64,
    pub(crate) difference_deg: Option<f64>,
    /// Section `[controller]`; null if that of the model stays.
    pub(crate) controller: Option<ControllerTable>,
    /// Tool frame in the flange frame of the model as it was.
    pub(crate) tool_in_flange: Option<FrameMap>,
    /// Base frame of the model as it was in that of the controller.
    pub(crate) base_in_controller: Option<FrameMap>,
    /// Quantities that these poses cannot tell apart.
    pub(crate) undecided: Vec<String>,
}

/// The tables of an explanation.
pub(crate) fn pose_tables(
    model: &Model,
    names: &[Named],
    measured: &[MeasuredPose],
    explanation: &Explanation,
) -> Result<PoseTables, CorrectionError> {
    let kinds: Vec<MotionKind> = names.iter().map(|n| n.1).collect();
    let new = corrected(model, &kinds, explanation)?;
    let coordinates = ControllerCoordinates::of(&new);
    let differences = measured.iter().filter_map(|row| {
        let computed = coordinates.pose(&row.joints).ok()?;
        Some(difference(row, &computed))
    });
    let most = Difference::largest(&differences.collect::<Vec<_>>());
    let frame = |tool: bool| match &explanation.frame {
        Some(Frame::Tool(pose)) if tool => Some(FrameMap::new(pose)),
        Some(Frame::Base(pose)) if !tool => Some(FrameMap::new(pose)),
        _ => None,
    };
    let changed = new.document.controller != model.document.controller;
    let mut tables = PoseTables {
        toml: String::new(),
        poses: measured.len(),
        difference_mm: most.distance * 1e3,
        difference_deg: most.angle.map(f64::to_degrees),
        controller: new.document.controller.clone().filter(|_| changed),
        tool_in_flange: frame(true),
        base_in_controller: frame(false),
        undecided: undecided(names, measured),
    };
    tables.toml = toml_text(&tables, model, &new).unwrap_or_default();
    Ok(tables)
}

/// Quantities that measured poses do not test.
fn undecided(names: &[Named], measured: &[MeasuredPose]) -> Vec<String> {
    let Some((first, others)) = measured.split_first() else {
        return Vec::new();
    };
    let mut found = Vec::new();
    for (i, (name, ..)) in names.iter().enumerate() {
        let rests = |row: &MeasuredPose| (row.joints[i] - first.joints[i]).abs() < 1e-6;
        if others.iter().all(rests) {
            found.push(format!(
                "{name} has one value in all poses: its sign and its zero are not tested"
            ));
        }
    }
    match first.rotation {
        None => found.push(
            "no orientation was measured: the axes of the tool frame are not tested".to_owned(),
        ),
        Some(one) => {
            let alike = |row: &MeasuredPose| row.rotation.is_some_and(|r| r.angle_to(&one) < 1e-3);
            if others.iter().all(alike) {
                found.push("all poses have one orientation: an offset of the tool and one of the base are the same".to_owned());
            }
        }
    }
    found
}

/// The tables as TOML; each replaces what the comment above it names.
fn toml_text(tables: &PoseTables, old: &Model, new: &Model) -> Result<String, toml::ser::Error> {
    let within = tables
        .difference_deg
        .map_or_else(String::new, |deg| format!(" and {} deg", short(deg)));
    let mut out = format!(
        "# Rests on {} {}, which the model with these tables leaves up to {} mm{within} apart.\n",
        tables.poses,
        if tables.poses == 1 { "pose" } else { "poses" },
        short(tables.difference_mm),
    );
    if let Some(controller) = &tables.controller {
        out.push_str("\n# Replaces the section [controller] of the model file, or goes to its end.\n[controller]\n");
        let bare = ControllerTable {
            axis: Vec::new(),
            ..controller.clone()
        };
        let words = Table::try_from(bare)?
            .into_iter()
            .filter(|(key, _)| key != "axis");
        out.extend(words.map(|(key, text)| format!("{key} = {text}\n")));
        out.push_str("axis = [\n");
        for axis in &controller.axis {
            let mut text = String::new();
            axis.serialize(toml::ser::ValueSerializer::new(&mut text))?;
            out.push_str(&format!("  {text},\n"));
        }
        out.push_str("]\n");
    }
    let (old, new) = (&old.document, &new.document);
    out.push_str(&changed("mechanism", &old.mechanism, &new.mechanism)?);
    for (old, new) in old.platform.iter().zip(&new.platform) {
        out.push_str(&changed("[platform]", old, new)?);
    }
    for (old, new) in old.limb.iter().zip(&new.limb) {
        out.push_str(&changed("[limb]", old, new)?);
    }
    if let Some(tool) = &tables.tool_in_flange {
        out.push_str(&format!(
            "\n# If the poses were measured with a tool, leave platform and limb as they are and state it in the job:\n# [tool]\n# pose = {}\n",
            Value::try_from(tool)?
        ));
    }
    Ok(out)
}

/// The keys of a table that changed, under its head and name, with comments; empty if there are none.
fn changed<T: Serialize>(head: &str, old: &T, new: &T) -> Result<String, toml::ser::Error> {
    let (old, new) = (Table::try_from(old)?, Table::try_from(new)?);
    let keys = new
        .iter()
        .filter(|(key, value)| old.get(*key) != Some(*value));
    let mut lines = String::new();
    for (key, value) in keys {
        let what = match key.as_str() {
            "gravity_m_per_s2" => "gravity in the axes of the base frame",
            "home" => "tool frame in the base frame, at home",
            "start" => "foot of the chain in the base frame",
            "end" => "flange, the end of the chain, in the tool frame",
            _ => "in the tool frame",
        };
        lines.push_str(&format!("{key} = {value} # {what}\n"));
    }
    let name = new
        .get("name")
        .map_or_else(String::new, |name| format!("name = {name}\n"));
    Ok(match lines.is_empty() {
        true => lines,
        false => format!(
            "\n# These keys replace those of the table with this name.\n[{head}]\n{name}{lines}"
        ),
    })
}
