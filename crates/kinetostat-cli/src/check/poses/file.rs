//! Files of measured poses: a table (CSV) or TOML. Units and conventions are in the names of the columns.

use std::collections::BTreeMap;
use std::path::Path;

use kinetostat::MotionKind;
use kinetostat_analysis::measured_poses::MeasuredPose;
use kinetostat_model::schema::Placement;
use nalgebra::Vector3;
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::files::input_files::InputFiles;
use crate::job::source::Source;
use crate::place::joints::{Named, quantity};
use crate::place::orientation::{self, CONVENTIONS};
use crate::ui::failure::{Answer, Failure};
use crate::ui::spelling::nearest;

/// More rows are not measured by hand.
const MOST: usize = 10_000;

/// A row and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct PoseRow {
    pub(crate) name: String,
    pub(crate) line: usize,
    pub(crate) measured: MeasuredPose,
}

pub(crate) fn read(files: &InputFiles, path: &Path, names: &[Named]) -> Answer<Vec<PoseRow>> {
    let bytes = files.bytes("file of poses", path)?;
    let name = path.display().to_string();
    let text = String::from_utf8(bytes)
        .map_err(|_| Failure::input(format!("{name}: not UTF-8 text; save it as UTF-8")))?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let toml = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("toml"));
    let rows = match toml {
        true => from_toml(&name, text, names)?,
        false => from_csv(text, names).map_err(|f| f.within(&name))?,
    };
    if rows.is_empty() {
        return Err(Failure::input(format!(
            "{name}: there is no pose in it; write one row for each"
        )));
    }
    if rows.len() > MOST {
        return Err(Failure::input(format!(
            "{name}: {} poses, at most {MOST} are read",
            rows.len()
        )));
    }
    Ok(rows)
}

/// What a column of a table holds.
enum Column {
    Name,
    Joint(usize),
    /// x, y, z and m in one of its unit.
    Position(usize, f64),
    /// All numbers of an orientation in one cell.
    Orientation(&'static str),
    /// One number of an orientation, from 0.
    Part(&'static str, usize),
}

fn from_csv(text: &str, names: &[Named]) -> Answer<Vec<PoseRow>> {
    // Semicolons come from spreadsheets that write decimal commas; those are told where they stand.
    let head = text.lines().find(|l| !l.trim().is_empty()).unwrap_or("");
    let delimiter = if head.contains(';') { b';' } else { b',' };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let header = reader.headers().map_err(|e| unreadable(&e))?.clone();
    let columns: Vec<Column> = header
        .iter()
        .map(|h| column(h, names))
        .collect::<Answer<_>>()?;
    complete(&columns, names)?;
    let mut rows = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| unreadable(&e))?;
        let line = record.position().map_or(0, |p| p.line() as usize);
        let row = cells(&record, &columns, &header, names, rows.len() + 1)
            .map_err(|reason| Failure::input(format!("line {line}: {reason}")))?;
        rows.push(PoseRow { line, ..row });
        if rows.len() > MOST {
            break;
        }
    }
    Ok(rows)
}

fn unreadable(error: &csv::Error) -> Failure {
    let line = error.position().map_or(0, csv::Position::line);
    Failure::input(match error.kind() {
        csv::ErrorKind::UnequalLengths {
            expected_len, len, ..
        } => format!("line {line}: {len} cells, but the table has {expected_len} columns"),
        _ => format!("no table: {error}"),
    })
}

fn column(head: &str, names: &[Named]) -> Answer<Column> {
    if head == "pose" || head == "name" {
        return Ok(Column::Name);
    }
    // A joint, with or without the unit that it has anyway.
    for (i, (name, kind, usual)) in names.iter().enumerate() {
        let unit = match (kind, *usual == 1.0) {
            (MotionKind::Prismatic, false) => "mm",
            (MotionKind::Prismatic, true) => "m",
            (MotionKind::Revolute, false) => "deg",
            (MotionKind::Revolute, true) => "rad",
        };
        if head == name || head == format!("{name}_{unit}") {
            return Ok(Column::Joint(i));
        }
    }
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        for (unit, size) in [("mm", 1e-3), ("m", 1.0)] {
            if head == format!("{axis}_{unit}") {
                return Ok(Column::Position(i, size));
            }
        }
    }
    for convention in CONVENTIONS {
        if head == convention {
            return Ok(Column::Orientation(convention));
        }
        if let Some(k) = head
            .strip_prefix(convention)
            .and_then(|r| r.strip_prefix('_'))
        {
            let most = if convention.starts_with("quaternion") {
                4
            } else {
                3
            };
            if let Some(k) = k.parse::<usize>().ok().filter(|k| (1..=most).contains(k)) {
                return Ok(Column::Part(convention, k - 1));
            }
        }
    }
    let plain = head.to_lowercase();
    let turned = [
        "a", "b", "c", "w", "p", "r", "rx", "ry", "rz", "roll", "pitch", "yaw",
    ];
    let angles = turned
        .iter()
        .any(|t| plain == *t || plain == format!("{t}_deg") || plain == format!("{t}_rad"))
        || plain.starts_with('q');
    if angles {
        return Err(Failure::input(format!(
            "the column '{head}' holds an orientation whose convention is not named: the same three angles mean a dozen different rotations. Name it: one column with all numbers in a cell, as in a_b_c_kuka_deg with 0 90 0, or a_b_c_kuka_deg_1, _2, _3. There are {}",
            CONVENTIONS.join(", ")
        )));
    }
    let mut known: Vec<&str> = names.iter().map(|n| n.0.as_str()).collect();
    known.extend(["pose", "x_mm", "y_mm", "z_mm"]);
    let near = nearest(head, &known).map_or_else(String::new, |n| format!("did you mean '{n}'? "));
    Err(Failure::input(format!(
        "the column '{head}' is not known. {near}There are the joints {}; x_mm, y_mm, z_mm; and orientations by their convention",
        known[..names.len()].join(", ")
    )))
}

/// Every joint and every coordinate once, one orientation at most.
fn complete(columns: &[Column], names: &[Named]) -> Answer<()> {
    let twice = |what: &str| Failure::input(format!("{what} stands in two columns"));
    for (i, (name, ..)) in names.iter().enumerate() {
        match columns
            .iter()
            .filter(|c| matches!(c, Column::Joint(j) if *j == i))
            .count()
        {
            1 => {}
            0 => {
                return Err(Failure::input(format!(
                    "there is no column for the joint '{name}'"
                )));
            }
            _ => return Err(twice(&format!("the joint '{name}'"))),
        }
    }
    for (i, axis) in ["x", "y", "z"].iter().enumerate() {
        match columns
            .iter()
            .filter(|c| matches!(c, Column::Position(j, _) if *j == i))
            .count()
        {
            1 => {}
            0 => {
                return Err(Failure::input(format!(
                    "there is no column {axis}_mm: the measured place of the tool's tip in the base"
                )));
            }
            _ => return Err(twice(axis)),
        }
    }
    let mut found: BTreeMap<&str, Vec<Option<usize>>> = BTreeMap::new();
    for c in columns {
        match c {
            Column::Orientation(name) => found.entry(name).or_default().push(None),
            Column::Part(name, k) => found.entry(name).or_default().push(Some(*k)),
            _ => {}
        }
    }
    if found.len() > 1 {
        let list: Vec<&str> = found.keys().copied().collect();
        return Err(Failure::input(format!(
            "the orientation is given twice: {}",
            list.join(" and ")
        )));
    }
    for (name, mut parts) in found {
        parts.sort_unstable();
        let most = if name.starts_with("quaternion") { 4 } else { 3 };
        let all: Vec<Option<usize>> = (0..most).map(Some).collect();
        if parts != [None] && parts != all {
            return Err(Failure::input(format!(
                "the columns of {name} are not complete: write {name}_1 to {name}_{most}, or one column {name}"
            )));
        }
    }
    Ok(())
}

fn cells(
    record: &csv::StringRecord,
    columns: &[Column],
    header: &csv::StringRecord,
    names: &[Named],
    number: usize,
) -> Result<PoseRow, String> {
    let mut joints = vec![0.0; names.len()];
    let mut position = Vector3::zeros();
    let mut turn: Option<(&str, Vec<f64>)> = None;
    let mut name = number.to_string();
    for ((cell, column), head) in record.iter().zip(columns).zip(header) {
        let read = |text: &str| {
            text.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or_else(|| {
                format!("'{text}' in the column '{head}': a finite number with a decimal point is needed")
            })
        };
        match column {
            Column::Name => name = cell.to_owned(),
            Column::Joint(i) => {
                let (_, kind, usual) = names[*i];
                joints[*i] = quantity(cell, kind, usual)
                    .map_err(|reason| format!("'{cell}' in the column '{head}': {reason}"))?;
            }
            Column::Position(i, size) => position[*i] = read(cell)? * size,
            Column::Orientation(convention) => {
                let numbers = cell
                    .split_whitespace()
                    .map(read)
                    .collect::<Result<_, _>>()?;
                turn = Some((convention, numbers));
            }
            Column::Part(convention, k) => {
                let (_, numbers) = turn.get_or_insert_with(|| {
                    let most = if convention.starts_with("quaternion") {
                        4
                    } else {
                        3
                    };
                    (convention, vec![0.0; most])
                });
                numbers[*k] = read(cell)?;
            }
        }
    }
    let rotation = match turn {
        None => None,
        Some((convention, numbers)) => Some(orientation::of(convention, &numbers)?),
    };
    Ok(PoseRow {
        name,
        line: 0,
        measured: MeasuredPose {
            joints,
            position,
            rotation,
        },
    })
}

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

fn from_toml(file: &str, text: &str, names: &[Named]) -> Answer<Vec<PoseRow>> {
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
