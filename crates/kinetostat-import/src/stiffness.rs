//! Joint stiffnesses, which a URDF does not have: one number for all, or a table.

use std::collections::BTreeMap;

use kinetostat::MotionKind;
use kinetostat_model::ModelError;

use crate::log::{At, Log, suggestion};

/// Stiffness of the drives.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum JointStiffness {
    /// Unknown stiffness: all drives are written as rigid, to be filled in.
    #[default]
    Unknown,
    /// One value for all drives that turn, N m/rad; those that slide stay rigid.
    All(f64),
    /// A table by its name and text: CSV with the header `name,value,unit`, one line for each
    /// joint; units `N m/rad`, `N mm/rad`, `N/m`, `N/mm`, `N/um`.
    Table {
        /// Name for messages.
        file: String,
        /// CSV.
        text: String,
    },
}

/// Stiffness (N/m or N m/rad) and its place in the table, by joint.
pub(crate) type Stiffnesses = BTreeMap<String, (f64, MotionKind, At)>;

const HEADER: &str = "name,value,unit";

/// Reads the table, if there is one.
pub(crate) fn table(given: &JointStiffness, log: &mut Log) -> Result<Stiffnesses, ModelError> {
    let mut found = Stiffnesses::new();
    let JointStiffness::Table { file, text } = given else {
        return Ok(found);
    };
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let index = log.file(file, text);
    let mut start = 0;
    let mut header = false;
    for line in text.split_inclusive('\n') {
        let at = At {
            file: index,
            span: start..start + line.trim_end().len(),
            element: String::new(),
        };
        start += line.len();
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = line
            .split(',')
            .map(|f| f.trim().trim_matches('"').trim())
            .collect();
        if !header {
            header = true;
            if fields.join(",").to_lowercase() != HEADER {
                log.error(
                    &at,
                    format!("the first line is not '{HEADER}'"),
                    format!("begin with the line {HEADER}, then one line for each joint: joint_1,2.0e6,N m/rad"),
                );
                log.stop()?;
            }
            continue;
        }
        let [name, value, unit] = fields[..] else {
            log.error(
                &at,
                format!("three fields are needed, {} were found", fields.len()),
                "write name,value,unit as in: joint_1,2.0e6,N m/rad",
            );
            continue;
        };
        let Some(value) = value
            .parse::<f64>()
            .ok()
            .filter(|v| *v > 0.0 && v.is_finite())
        else {
            log.error(
                &at,
                format!("the stiffness '{value}' is no number above zero"),
                "a drive that does not give way is left out of the table",
            );
            continue;
        };
        let Some((factor, kind)) = unit_of(unit) else {
            let known = ["N m/rad", "N mm/rad", "N m/deg", "N/m", "N/mm", "N/um"];
            log.error(
                &at,
                format!("the unit '{unit}' is unknown"),
                suggestion(unit, known.into_iter()),
            );
            continue;
        };
        if found
            .insert(name.to_owned(), (value * factor, kind, at.clone()))
            .is_some()
        {
            log.error(
                &at,
                format!("the joint '{name}' is written twice"),
                "keep one of the lines",
            );
        }
    }
    if !header {
        log.error(
            &At {
                file: index,
                ..At::default()
            },
            "the table is empty",
            format!("begin with the line {HEADER}, then one line for each joint"),
        );
    }
    Ok(found)
}

/// SI per unit, and the kind of joint that has it.
fn unit_of(unit: &str) -> Option<(f64, MotionKind)> {
    let plain: String = unit
        .chars()
        .filter(|c| !" *·".contains(*c))
        .collect::<String>()
        .to_lowercase();
    match plain.as_str() {
        "nm/rad" => Some((1.0, MotionKind::Revolute)),
        "nmm/rad" => Some((1e-3, MotionKind::Revolute)),
        "nm/deg" => Some((180.0 / std::f64::consts::PI, MotionKind::Revolute)),
        "n/m" => Some((1.0, MotionKind::Prismatic)),
        "n/mm" => Some((1e3, MotionKind::Prismatic)),
        "n/um" | "n/µm" => Some((1e6, MotionKind::Prismatic)),
        _ => None,
    }
}
