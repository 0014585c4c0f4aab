//! A field of corrections from a table: positions on a regular grid and what to add there.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::MapError;
use crate::field::{Correction, CorrectionField, Course, FieldFailure, Request, Structure};
use crate::path::moves::Move;

/// Columns of the table: where a node is, and its correction.
const COLUMNS: [&str; 6] = ["x_mm", "y_mm", "z_mm", "dx_mm", "dy_mm", "dz_mm"];

/// Points this far outside the grid still count as on its border: the rounding of programs, in mm.
const BORDER_MM: f64 = 1e-6;

/// Nodes nearer than this are one place written twice: no machine is measured more finely.
const NEAREST_MM: f64 = 1e-3;

/// Largest number of rows.
const MAX_ROWS: usize = 10_000_000;

/// Corrections at the nodes of a grid, interpolated linearly along each axis in between.
///
/// The nodes are all combinations of some x, some y and some z (in any order, at any spacing). An axis
/// with one value only is one along which the correction does not vary; along the others a point
/// outside the grid has no correction, and asking for it is a failure rather than a guess.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrectionMap {
    /// Ascending coordinates of the nodes along each axis, in mm.
    axes: [Vec<f64>; 3],
    /// Corrections in mm; z varies fastest, then y.
    values: Vec<Vector3<f64>>,
}

impl CorrectionMap {
    /// Reads a CSV table with the columns `x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm` in any order. Lines that
    /// begin with `#` are comments.
    ///
    /// # Errors
    ///
    /// Unknown, missing or doubled columns, cells that are no finite numbers, nodes that are missing
    /// or doubled; each with the line.
    pub fn read(bytes: &[u8]) -> Result<Self, MapError> {
        Self::read_until(bytes, 1).map_err(|mut faults| faults.swap_remove(0))
    }

    /// Everything that is refused in a table, in the order of its lines, up to `most` faults; empty where
    /// [`CorrectionMap::read`] takes it.
    pub fn faults(bytes: &[u8], most: usize) -> Vec<MapError> {
        Self::read_until(bytes, most.max(1))
            .err()
            .unwrap_or_default()
    }

    /// The table, or its first faults: at least one, at most so many.
    fn read_until(bytes: &[u8], most: usize) -> Result<Self, Vec<MapError>> {
        let rows = rows_of(bytes, most)?;
        Self::from_rows(&rows, most)
    }

    fn from_rows(rows: &[(u64, [f64; 6])], most: usize) -> Result<Self, Vec<MapError>> {
        if rows.is_empty() {
            return Err(vec![MapError {
                line: 1,
                found: "no row below the header".to_owned(),
                reason: "the map says nothing".to_owned(),
                remedy: "give at least one row: position and correction".to_owned(),
            }]);
        }
        let axes: [Vec<f64>; 3] = [0, 1, 2].map(|axis| {
            // Adding zero makes -0 and 0 one coordinate.
            let mut values: Vec<f64> = rows.iter().map(|(_, row)| row[axis] + 0.0).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        });
        let near = too_near(&axes, rows, most);
        if !near.is_empty() {
            return Err(near);
        }
        let places: [BTreeMap<u64, usize>; 3] = [0, 1, 2].map(|axis: usize| {
            axes[axis]
                .iter()
                .enumerate()
                .map(|(place, value)| (value.to_bits(), place))
                .collect()
        });
        let [nx, ny, nz] = [axes[0].len(), axes[1].len(), axes[2].len()];
        let count = nx.checked_mul(ny).and_then(|count| count.checked_mul(nz));
        if count.is_none_or(|count| count > rows.len()) {
            return Err(vec![MapError {
                line: rows[rows.len() - 1].0,
                found: format!(
                    "{} rows with {nx} values of x, {ny} of y, {nz} of z",
                    rows.len()
                ),
                reason: "the positions are no full grid: not every combination of these is there"
                    .to_owned(),
                remedy: "measure or interpolate on a full grid; scattered positions are not taken"
                    .to_owned(),
            }]);
        }
        let mut values = vec![None; nx * ny * nz];
        let mut faults = Vec::new();
        for (line, row) in rows {
            let place = |axis: usize| {
                places[axis]
                    .get(&(row[axis] + 0.0).to_bits())
                    .copied()
                    .unwrap_or(0)
            };
            let node = (place(0) * ny + place(1)) * nz + place(2);
            if values[node]
                .replace(Vector3::new(row[3], row[4], row[5]))
                .is_some()
            {
                faults.push(MapError {
                    line: *line,
                    found: format!("position {} {} {}", row[0], row[1], row[2]),
                    reason: "the position appears twice".to_owned(),
                    remedy: "keep one row for each position".to_owned(),
                });
                if faults.len() == most {
                    break;
                }
            }
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        // Every node is filled: there are as many rows, and none is doubled.
        let values = values.into_iter().map(Option::unwrap_or_default).collect();
        Ok(Self { axes, values })
    }

    /// Smallest and largest position of the grid, in mm.
    pub fn bounds_mm(&self) -> [Vector3<f64>; 2] {
        let first = |axis: usize| self.axes[axis].first().copied().unwrap_or_default();
        let last = |axis: usize| self.axes[axis].last().copied().unwrap_or_default();
        [
            Vector3::new(first(0), first(1), first(2)),
            Vector3::new(last(0), last(1), last(2)),
        ]
    }

    /// Correction at a position; both in mm.
    ///
    /// # Errors
    ///
    /// A position outside the grid.
    pub fn at(&self, position_mm: &Vector3<f64>) -> Result<Vector3<f64>, FieldFailure> {
        let mut cells = [(0, 0, 0.0); 3];
        for axis in 0..3 {
            cells[axis] = self.cell(axis, position_mm[axis])?;
        }
        let [_, ny, nz] = [self.axes[0].len(), self.axes[1].len(), self.axes[2].len()];
        let value = |x: usize, y: usize, z: usize| self.values[(x * ny + y) * nz + z];
        let [(x0, x1, u), (y0, y1, v), (z0, z1, w)] = cells;
        let along_z = |x: usize, y: usize| value(x, y, z0).lerp(&value(x, y, z1), w);
        let along_y = |x: usize| along_z(x, y0).lerp(&along_z(x, y1), v);
        Ok(along_y(x0).lerp(&along_y(x1), u))
    }

    /// Neighbouring nodes along an axis and the share of the way between them.
    fn cell(&self, axis: usize, value: f64) -> Result<(usize, usize, f64), FieldFailure> {
        let nodes = &self.axes[axis];
        let [first, last] = [nodes[0], nodes[nodes.len() - 1]];
        if nodes.len() == 1 {
            return Ok((0, 0, 0.0));
        }
        if !(first - BORDER_MM..=last + BORDER_MM).contains(&value) {
            // Uses enough digits to show on which side of the border it lies.
            let shown = |decimals: usize| format!("{value:.decimals$}");
            let outside = |text: &String| {
                let read = text.parse().unwrap_or(value);
                !(first..=last).contains(&read)
            };
            let shown = (4..=12).map(shown).find(outside);
            return Err(FieldFailure::new(format!(
                "{} {} mm is outside the map, which reaches from {first} to {last} mm; extend \
                 the map or move the part",
                ["x", "y", "z"][axis],
                shown.unwrap_or_else(|| value.to_string())
            )));
        }
        let above = nodes
            .partition_point(|node| *node <= value)
            .clamp(1, nodes.len() - 1);
        let share = (value - nodes[above - 1]) / (nodes[above] - nodes[above - 1]);
        Ok((above - 1, above, share.clamp(0.0, 1.0)))
    }
}

impl CorrectionField for CorrectionMap {
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Correction, FieldFailure>> {
        let shifts = requests.iter().map(|r| self.at(&r.position_mm));
        shifts.map(|shift| shift.map(Correction::from)).collect()
    }

    /// The correction is linear in each coordinate within a cell, so along a line of third degree at most; where the
    /// move passes from one cell to the next its slope jumps.
    fn structure(&self, _move_index: usize, motion: &Move) -> Structure {
        Structure {
            breaks: (0..3)
                .flat_map(|axis| motion.shares_at(axis, &self.axes[axis]))
                .collect(),
            course: Course::Cubic,
        }
    }
}

/// Nodes along an axis that are nearer than any measurement: one place written with different digits, between
/// which the field would jump.
fn too_near(axes: &[Vec<f64>; 3], rows: &[(u64, [f64; 6])], most: usize) -> Vec<MapError> {
    let mut faults = Vec::new();
    for (axis, nodes) in axes.iter().enumerate() {
        for pair in nodes.windows(2) {
            // Numbers as far out as a machine reaches have this much rounding.
            if pair[1] - pair[0] >= NEAREST_MM - 1e-9 {
                continue;
            }
            // The later of the two lines on which they stand first.
            let line_of = |value: f64| rows.iter().find(|(_, row)| row[axis] == value);
            let lines = [line_of(pair[0]), line_of(pair[1])].map(|row| row.map_or(1, |r| r.0));
            faults.push(MapError {
                line: lines[0].max(lines[1]),
                found: format!(
                    "{} {} mm beside {} mm on line {}",
                    ["x", "y", "z"][axis],
                    pair[usize::from(lines[1] > lines[0])],
                    pair[usize::from(lines[1] <= lines[0])],
                    lines[0].min(lines[1]),
                ),
                reason: format!("nodes of a grid are at least {NEAREST_MM} mm apart"),
                remedy: "write the same place with the same digits in every row".to_owned(),
            });
            if faults.len() == most {
                break;
            }
        }
    }
    faults.sort_by_key(|fault| fault.line);
    faults.truncate(most);
    faults
}

/// Line and cells of every row, or the first faults.
fn rows_of(bytes: &[u8], most: usize) -> Result<Vec<(u64, [f64; 6])>, Vec<MapError>> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(bytes);
    let headers = reader
        .headers()
        .map_err(|error| vec![csv_error(bytes, &error)])?
        .clone();
    let columns = columns_of(&headers, line_of(bytes, headers.position()), most)?;
    let mut rows = Vec::new();
    let mut faults = Vec::new();
    for record in reader.records() {
        let read = record.map_err(|e| csv_error(bytes, &e)).and_then(|record| {
            let line = line_of(bytes, record.position());
            let row = (line, row_of(&record, line, &columns, &headers)?);
            match rows.len() {
                MAX_ROWS => Err(MapError {
                    line: row.0,
                    found: format!("more than {MAX_ROWS} rows"),
                    reason: "the map is too large".to_owned(),
                    remedy: "use a coarser grid".to_owned(),
                }),
                _ => Ok(row),
            }
        });
        match read {
            Ok(row) => rows.push(row),
            Err(fault) => faults.push(fault),
        }
        if faults.len() == most {
            break;
        }
    }
    if faults.is_empty() {
        Ok(rows)
    } else {
        Err(faults)
    }
}

fn row_of(
    record: &csv::StringRecord,
    line: u64,
    columns: &[usize; 6],
    headers: &csv::StringRecord,
) -> Result<[f64; 6], MapError> {
    let mut row = [0.0; 6];
    for (value, &column) in row.iter_mut().zip(columns) {
        let cell = &record[column];
        *value = cell
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite() && number.abs() < 1e9)
            .ok_or_else(|| MapError {
                line,
                found: format!("`{}` in column {}", shown(cell), &headers[column]),
                reason: "it is no finite number".to_owned(),
                remedy: "write a number with a decimal point, in mm".to_owned(),
            })?;
    }
    Ok(row)
}

fn columns_of(
    headers: &csv::StringRecord,
    line: u64,
    most: usize,
) -> Result<[usize; 6], Vec<MapError>> {
    let fault = |found: String, reason: &str, remedy: String| MapError {
        line,
        found,
        reason: reason.to_owned(),
        remedy,
    };
    let mut faults = Vec::new();
    for (index, name) in headers.iter().enumerate() {
        if headers.iter().take(index).any(|before| before == name) {
            faults.push(fault(
                format!("column `{}`", shown(name)),
                "the column appears twice",
                "keep one of the two".to_owned(),
            ));
        } else if !COLUMNS.contains(&name) {
            faults.push(fault(
                format!("column `{}`", shown(name)),
                "the column is not known",
                meant(name),
            ));
        }
        if faults.len() == most {
            return Err(faults);
        }
    }
    // A column of another name is one of these with a slip of the pen: it is said already.
    let known = faults.is_empty();
    let mut columns = [0; 6];
    for (column, name) in columns.iter_mut().zip(COLUMNS) {
        match headers.iter().position(|header| header == name) {
            Some(index) => *column = index,
            None if known && faults.len() < most => faults.push(fault(
                format!("no column `{name}`"),
                "a column is missing",
                format!("the first line must name {}", COLUMNS.join(",")),
            )),
            None => {}
        }
    }
    if faults.is_empty() {
        Ok(columns)
    } else {
        Err(faults)
    }
}

/// Suggestion for a column that is not known.
fn meant(name: &str) -> String {
    let all = COLUMNS.join(",");
    if name.contains([';', '\t']) {
        return format!("columns are separated by commas, and decimals by points: write {all}");
    }
    let lower = name.to_lowercase();
    let nearest = COLUMNS
        .into_iter()
        .max_by(|a, b| strsim::jaro(&lower, a).total_cmp(&strsim::jaro(&lower, b)))
        .unwrap_or(COLUMNS[0]);
    // A name in another unit: renaming alone would make a thousandfold of its numbers.
    let quantity = lower.split('_').next().unwrap_or_default();
    let known = COLUMNS
        .into_iter()
        .find(|c| c.split('_').next() == Some(quantity));
    match (known, lower.split_once('_')) {
        (Some(column), Some((_, unit))) if unit != "mm" => format!(
            "write it as `{column}` and convert its numbers into millimetres (1 um is 0.001 mm, 1 inch 25.4 mm, 1 m \
             1000 mm): a new name alone is not enough"
        ),
        _ => format!("did you mean `{nearest}`? The columns are {all}"),
    }
}

/// Line of the record that is read from a position on: comments and empty lines before it are passed over.
fn line_of(bytes: &[u8], position: Option<&csv::Position>) -> u64 {
    let Some(position) = position else { return 1 };
    let from = usize::try_from(position.byte()).unwrap_or(bytes.len());
    let rest = bytes.get(from..).unwrap_or_default();
    let passed = rest
        .split_inclusive(|byte| *byte == b'\n')
        .take_while(|line| matches!(*line, b"\n" | b"\r\n" | [b'#', ..]))
        .count();
    position.line() + passed as u64
}

fn csv_error(bytes: &[u8], error: &csv::Error) -> MapError {
    MapError {
        line: line_of(bytes, error.position()),
        found: "a row that is no CSV of the header's width".to_owned(),
        reason: match error.kind() {
            csv::ErrorKind::UnequalLengths {
                expected_len, len, ..
            } => format!("it has {len} cells, the header has {expected_len}"),
            csv::ErrorKind::Utf8 { .. } => "it is no UTF-8 text".to_owned(),
            _ => error.to_string(),
        },
        remedy: "write six numbers a row, with commas between them and points for decimals"
            .to_owned(),
    }
}

fn shown(cell: &str) -> String {
    crate::error::excerpt(cell.as_bytes())
}
