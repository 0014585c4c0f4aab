//! Measured poses as TOML.

use std::collections::BTreeMap;

use kinetostat_analysis::measured_poses::MeasuredPose;
use kinetostat_model::schema::Placement;
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::check::poses::pose_row::PoseRow;
use crate::job::source::Source;
use crate::place::joints::Named;
use crate::ui::failure::{Answer, Failure};

/// The file in TOML.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    schema: u32,
    pose: Vec<Spanned<Entry>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    name: Option<String>,
    joints: BTreeMap<String, f64>,
    tool: Placement,
}

pub(crate) fn from_toml(file: &str, text: &str, names: &[Named]) -> Answer<Vec<PoseRow>> {
    let source = Source { file, text };
    let document: Document = source.read_as(
        "write schema = 1 and, for each pose, [[pose]] with joints = { ... } and tool = { position_mm = [...], ... }",
    )?;
    if document.schema != 1 {
        return Err(Failure::input(format!(
            "{file}: this is version {} of the format; version 1 is read here",
            document.schema
        )));
    }
    let mut rows = Vec::new();
    for (number, entry) in document.pose.iter().enumerate() {
        let refuse = |message: &str, help: &str| source.error(entry.span(), message, help);
        let written = entry.get_ref();
        let mut joints = vec![0.0; names.len()];
        for (i, (name, _, size)) in names.iter().enumerate() {
            let value = written.joints.get(name).ok_or_else(|| {
                refuse(
                    &format!("the joint '{name}' is missing in this pose"),
                    "write all joints of every pose",
                )
            })?;
            joints[i] = value * size;
        }
        if let Some(other) = written
            .joints
            .keys()
            .find(|k| names.iter().all(|n| n.0 != **k))
        {
            let known: Vec<&str> = names.iter().map(|n| n.0.as_str()).collect();
            return Err(refuse(
                &format!("there is no joint '{other}'"),
                &format!("there are {}", known.join(", ")),
            ));
        }
        let tool = &written.tool;
        let placed = tool.position_mm.is_some()
            || tool.position_m.is_some()
            || tool.translation_mm.is_some()
            || tool.translation_m.is_some();
        if !placed {
            return Err(refuse(
                "the measured place of the tool is missing",
                "write tool = { position_mm = [x, y, z] }",
            ));
        }
        let pose = tool
            .pose()
            .map_err(|(message, help)| refuse(&message, &help))?;
        let bare = Placement {
            position_mm: None,
            position_m: None,
            translation_mm: None,
            translation_m: None,
            ..tool.clone()
        };
        rows.push(PoseRow {
            name: written
                .name
                .clone()
                .unwrap_or_else(|| (number + 1).to_string()),
            line: 1 + text[..entry.span().start].matches('\n').count(),
            measured: MeasuredPose {
                joints,
                position: pose.translation.vector,
                rotation: (bare != Placement::default()).then_some(pose.rotation),
            },
        });
    }
    Ok(rows)
}
