//! A field of corrections from a table: positions on a regular grid and what to add there.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::error::MapError;
use crate::field::{CorrectionField, Course, FieldFailure, Request, Structure};
use crate::path::Move;

/// Columns of the table, in the order of [`CorrectionMap::from_nodes`].
const COLUMNS: [&str; 6] = ["x_mm", "y_mm", "z_mm", "dx_mm", "dy_mm", "dz_mm"];

/// Points this far outside the grid still count as on its border: the rounding of programs, in mm.
const BORDER_MM: f64 = 1e-6;

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
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .comment(Some(b'#'))
            .from_reader(bytes);
        let headers = reader.headers().map_err(csv_error)?.clone();
        let columns = columns_of(&headers)?;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(csv_error)?;
            let line = record.position().map_or(0, csv::Position::line);
            let mut row = [0.0; 6];
            for (value, column) in row.iter_mut().zip(columns) {
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
            if rows.len() == MAX_ROWS {
                return Err(MapError {
                    line,
                    found: format!("more than {MAX_ROWS} rows"),
                    reason: "the map is too large".to_owned(),
                    remedy: "use a coarser grid".to_owned(),
                });
            }
            rows.push((line, row));
        }
        Self::from_rows(&rows)
    }

    fn from_rows(rows: &[(u64, [f64; 6])]) -> Result<Self, MapError> {
        if rows.is_empty() {
            return Err(MapError {
                line: 1,
                found: "no row below the header".to_owned(),
                reason: "the map says nothing".to_owned(),
                remedy: "give at least one row: position and correction".to_owned(),
            });
        }
        let axes: [Vec<f64>; 3] = [0, 1, 2].map(|axis| {
            // Adding zero makes -0 and 0 one coordinate.
            let mut values: Vec<f64> = rows.iter().map(|(_, row)| row[axis] + 0.0).collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        });
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
            return Err(MapError {
                line: rows[rows.len() - 1].0,
                found: format!(
                    "{} rows with {nx} values of x, {ny} of y, {nz} of z",
                    rows.len()
                ),
                reason: "the positions are no full grid: not every combination of these is there"
                    .to_owned(),
                remedy: "measure or interpolate on a full grid; scattered positions are not taken"
                    .to_owned(),
            });
        }
        let mut values = vec![None; nx * ny * nz];
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
                return Err(MapError {
                    line: *line,
                    found: format!("position {} {} {}", row[0], row[1], row[2]),
                    reason: "the position stands there twice".to_owned(),
                    remedy: "keep one row for each position".to_owned(),
                });
            }
        }
        // As many rows as nodes and none doubled: every node is filled.
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
            return Err(FieldFailure::new(format!(
                "{} {value:.4} mm is outside the map, which reaches from {first} to {last} mm; extend \
                 the map or move the part",
                ["x", "y", "z"][axis]
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
    fn corrections(&self, requests: &[Request]) -> Vec<Result<Vector3<f64>, FieldFailure>> {
        requests
            .iter()
            .map(|request| self.at(&request.position_mm))
            .collect()
    }

    /// In a cell the correction is linear in each coordinate, so along a line of third degree at most;
    /// where the move passes from one cell to the next its slope jumps.
    fn structure(&self, _move_index: usize, motion: &Move) -> Structure {
        Structure {
            breaks: (0..3)
                .flat_map(|axis| motion.shares_at(axis, &self.axes[axis]))
                .collect(),
            course: Course::Cubic,
        }
    }
}

fn columns_of(headers: &csv::StringRecord) -> Result<[usize; 6], MapError> {
    let refuse = |found: String, reason: &str, remedy: String| MapError {
        line: 1,
        found,
        reason: reason.to_owned(),
        remedy,
    };
    for (index, name) in headers.iter().enumerate() {
        if headers.iter().take(index).any(|before| before == name) {
            return Err(refuse(
                format!("column `{}`", shown(name)),
                "the column stands there twice",
                "keep one of the two".to_owned(),
            ));
        }
        if !COLUMNS.contains(&name) {
            let nearest = COLUMNS
                .into_iter()
                .max_by(|a, b| strsim::jaro(name, a).total_cmp(&strsim::jaro(name, b)))
                .unwrap_or(COLUMNS[0]);
            return Err(refuse(
                format!("column `{}`", shown(name)),
                "the column is not known",
                format!(
                    "did you mean `{nearest}`? The columns are {}",
                    COLUMNS.join(",")
                ),
            ));
        }
    }
    let mut columns = [0; 6];
    for (column, name) in columns.iter_mut().zip(COLUMNS) {
        *column = headers
            .iter()
            .position(|header| header == name)
            .ok_or_else(|| {
                refuse(
                    format!("no column `{name}`"),
                    "a column is missing",
                    format!("the first line must name {}", COLUMNS.join(",")),
                )
            })?;
    }
    Ok(columns)
}

fn csv_error(error: csv::Error) -> MapError {
    MapError {
        line: error.position().map_or(1, csv::Position::line),
        found: "a row that is no CSV of the header's width".to_owned(),
        reason: error.to_string(),
        remedy: "write six numbers a row, with commas between them".to_owned(),
    }
}

fn shown(cell: &str) -> String {
    crate::error::excerpt(cell.as_bytes())
}
