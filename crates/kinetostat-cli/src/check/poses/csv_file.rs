//! Measured poses as a table (CSV).

use std::collections::BTreeMap;

use kinetostat::MotionKind;
use kinetostat_analysis::measured_poses::MeasuredPose;
use kinetostat_diagnostic::ErrorCode;
use nalgebra::Vector3;

use crate::check::poses::pose_row::{MOST, PoseRow};
use crate::place::joints::{Named, NoQuantity, quantity};
use crate::place::orientation::{self, CONVENTIONS, NoOrientation};
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::spelling::nearest;

/// Content of a column of a table.
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

pub(crate) fn from_csv(text: &str, names: &[Named]) -> Answer<Vec<PoseRow>> {
    // Semicolons come from spreadsheets that write decimal commas; those are reported where they stand.
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
            .map_err(|reason| ErrorCode::FileForm.failure(format!("line {line}: {reason}")))?;
        rows.push(PoseRow { line, ..row });
        if rows.len() > MOST {
            break;
        }
    }
    Ok(rows)
}

fn unreadable(error: &csv::Error) -> Failure {
    let line = error.position().map_or(0, csv::Position::line);
    ErrorCode::FileForm.failure(match error.kind() {
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
        return Err(ErrorCode::FileForm.failure(format!(
                "the column '{head}' holds an orientation whose convention is not named: the same three angles mean a dozen different rotations. Name it: one column with all numbers in a cell, as in a_b_c_kuka_deg with 0 90 0, or a_b_c_kuka_deg_1, _2, _3. There are {}",
                CONVENTIONS.join(", ")
            ),
        ));
    }
    let mut known: Vec<&str> = names.iter().map(|n| n.0.as_str()).collect();
    known.extend(["pose", "x_mm", "y_mm", "z_mm"]);
    let near = nearest(head, &known).map_or_else(String::new, |n| format!("did you mean '{n}'? "));
    Err(ErrorCode::FileForm.failure(format!(
            "the column '{head}' is not known. {near}There are the joints {}; x_mm, y_mm, z_mm; and orientations by their convention",
            known[..names.len()].join(", ")
        ),
    ))
}

/// Requires every joint and every coordinate once, one orientation at most.
fn complete(columns: &[Column], names: &[Named]) -> Answer<()> {
    let twice = |what: &str| ErrorCode::FileForm.failure(format!("{what} appears in two columns"));
    for (i, (name, ..)) in names.iter().enumerate() {
        match columns
            .iter()
            .filter(|c| matches!(c, Column::Joint(j) if *j == i))
            .count()
        {
            1 => {}
            0 => {
                return Err(ErrorCode::FileForm
                    .failure(format!("there is no column for the joint '{name}'")));
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
                return Err(ErrorCode::FileForm.failure(format!(
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
        return Err(ErrorCode::FileForm.failure(format!(
            "the orientation is given twice: {}",
            list.join(" and ")
        )));
    }
    for (name, mut parts) in found {
        parts.sort_unstable();
        let most = if name.starts_with("quaternion") { 4 } else { 3 };
        let all: Vec<Option<usize>> = (0..most).map(Some).collect();
        if parts != [None] && parts != all {
            return Err(ErrorCode::FileForm.failure(format!(
                    "the columns of {name} are not complete: write {name}_1 to {name}_{most}, or one column {name}"
                ),
            ));
        }
    }
    Ok(())
}

/// Fault in a row of the file.
#[derive(Debug, thiserror::Error)]
enum RowFault {
    #[error("'{text}' in the column '{column}': a finite number with a decimal point is needed")]
    Number { text: String, column: String },
    #[error("'{text}' in the column '{column}': {fault}")]
    Quantity {
        text: String,
        column: String,
        fault: NoQuantity,
    },
    #[error(transparent)]
    Orientation(#[from] NoOrientation),
}

fn cells(
    record: &csv::StringRecord,
    columns: &[Column],
    header: &csv::StringRecord,
    names: &[Named],
    number: usize,
) -> Result<PoseRow, RowFault> {
    let mut joints = vec![0.0; names.len()];
    let mut position = Vector3::zeros();
    let mut turn: Option<(&str, Vec<f64>)> = None;
    let mut name = number.to_string();
    for ((cell, column), head) in record.iter().zip(columns).zip(header) {
        let read = |text: &str| {
            text.parse::<f64>()
                .ok()
                .filter(|x| x.is_finite())
                .ok_or_else(|| RowFault::Number {
                    text: text.to_owned(),
                    column: head.to_owned(),
                })
        };
        match column {
            Column::Name => name = cell.to_owned(),
            Column::Joint(i) => {
                let (_, kind, usual) = names[*i];
                joints[*i] = quantity(cell, kind, usual).map_err(|fault| RowFault::Quantity {
                    text: cell.to_owned(),
                    column: head.to_owned(),
                    fault,
                })?;
            }
            Column::Position(i, size) => position[*i] = read(cell)? * size,
            Column::Orientation(convention) => {
                let numbers = cell
                    .split_whitespace()
                    .map(read)
                    .collect::<Result<_, RowFault>>()?;
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
