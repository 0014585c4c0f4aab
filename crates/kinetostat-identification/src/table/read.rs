//! Reads a table of measurements.

use nalgebra::Vector3;

use crate::axes::Axes;
use crate::body::BodyPoint;
use crate::experiment::TestLoad;
use crate::table::columns::{Column, NoColumn, column_of};
use crate::table::row::{MOST_FAULTS, MeasuredRow, Read, TableFault};

/// Rows of a table, whose columns [`crate::COLUMNS`] lists.
///
/// # Errors
/// All faults, in the order of the file: columns that are unknown, missing, twice or without a unit; cells that are no numbers; rows of
/// another length; axes beyond their limits. Rows without a reading are no fault: a plan is filled in row by row.
pub fn read_table(text: &str, axes: &Axes<'_>) -> Result<Vec<MeasuredRow>, Vec<TableFault>> {
    rows_of(text, axes, measured_columns)
}

/// Commands (m or rad) of the postures of a table, of which only the axes need columns; each posture once.
///
/// # Errors
/// As [`read_table`].
pub fn read_postures(text: &str, axes: &Axes<'_>) -> Result<Vec<Vec<f64>>, Vec<TableFault>> {
    let mut postures: Vec<Vec<f64>> = Vec::new();
    for row in rows_of(text, axes, |_, _| ())? {
        if !postures.contains(&row.commands) {
            postures.push(row.commands);
        }
    }
    Ok(postures)
}

/// Rows of a table; `needed` adds what its header misses beside the axes.
fn rows_of(
    text: &str,
    axes: &Axes<'_>,
    needed: fn(&[Option<Column>], &mut Missing<'_>),
) -> Result<Vec<MeasuredRow>, Vec<TableFault>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let is_row = |l: &&str| !l.trim().is_empty() && !l.trim_start().starts_with('#');
    let head = text.lines().find(is_row).unwrap_or_default();
    let separator = [';', '\t']
        .into_iter()
        .find(|s| head.contains(*s))
        .unwrap_or(',');
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator as u8)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut records = reader
        .records()
        .filter(|r| !r.as_ref().is_ok_and(|r| r.iter().all(str::is_empty)));
    let about_file = |line: usize, message: String| TableFault {
        line,
        column: None,
        found: None,
        message,
    };
    let head = match records.next() {
        None => return Err(vec![about_file(1, "the table is empty".to_owned())]),
        Some(Err(error)) => return Err(vec![about_file(line_of(&error), error.to_string())]),
        Some(Ok(head)) => head,
    };
    let heads: Vec<&str> = head.iter().collect();
    let head_line = head.position().map_or(1, |p| p.line() as usize);
    let mut faults = Vec::new();
    let columns = columns(&heads, head_line, axes, &mut faults);
    needed(
        &columns,
        &mut Missing {
            line: head_line,
            faults: &mut faults,
        },
    );
    let mut rows = Vec::new();
    for record in records {
        if faults.len() >= MOST_FAULTS {
            break;
        }
        let record = match record {
            Ok(record) => record,
            Err(error) => {
                faults.push(about_file(line_of(&error), error.to_string()));
                continue;
            }
        };
        let line = record.position().map_or(0, |p| p.line() as usize);
        let cells: Vec<&str> = record.iter().collect();
        if cells.len() != heads.len() {
            let message = format!(
                "{} cells, but the header has {} columns",
                cells.len(),
                heads.len()
            );
            faults.push(about_file(line, message));
            continue;
        }
        let before = faults.len();
        let row = Row {
            line,
            heads: &heads,
            columns: &columns,
            cells: &cells,
            comma: separator != ',',
        };
        let found = row.read(axes, &mut faults);
        if let (Some(found), true) = (found, faults.len() == before) {
            rows.push(found);
        }
    }
    if rows.is_empty() && faults.is_empty() {
        faults.push(about_file(
            head_line,
            "the table has a header and no rows".to_owned(),
        ));
    }
    match faults.is_empty() {
        true => Ok(rows),
        false => Err(faults),
    }
}

fn line_of(error: &csv::Error) -> usize {
    error.position().map_or(1, |p| p.line() as usize)
}

/// Component of a vector that a column holds.
type ComponentOf = fn(&Column) -> Option<usize>;

/// What a header misses.
struct Missing<'f> {
    line: usize,
    faults: &'f mut Vec<TableFault>,
}

impl Missing<'_> {
    fn add(&mut self, message: String) {
        self.faults.push(TableFault {
            line: self.line,
            column: None,
            found: None,
            message,
        });
    }
}

/// Meaning of the columns, none where there is a fault; axes without a column are faults.
fn columns(
    heads: &[&str],
    line: usize,
    axes: &Axes<'_>,
    faults: &mut Vec<TableFault>,
) -> Vec<Option<Column>> {
    let mut columns: Vec<Option<Column>> = Vec::with_capacity(heads.len());
    for head in heads {
        let mut fault = |message: String| {
            faults.push(TableFault {
                line,
                column: Some((*head).to_owned()),
                found: None,
                message,
            });
        };
        let column = match column_of(head, axes) {
            Ok(column) => Some(column),
            Err(NoColumn::Unit(units)) => {
                fault(format!(
                    "the column states no unit; write {}",
                    units.join(" or ")
                ));
                None
            }
            Err(NoColumn::Unknown) => {
                let axes: Vec<&str> = axes.names().iter().map(|n| n.0.as_str()).collect();
                fault(format!(
                    "the column is not known; the axes of this model are {}, and `kinetostat identify --help` lists all columns",
                    axes.join(", ")
                ));
                None
            }
        };
        let same = |other: &Column| column.is_some_and(|c| quantity(&c) == quantity(other));
        if columns.iter().flatten().any(same) && column != Some(Column::Note) {
            fault("the quantity has a column already".to_owned());
        }
        columns.push(column);
    }
    let has = |wanted: &dyn Fn(&Column) -> bool| columns.iter().flatten().any(wanted);
    let without: Vec<&str> = (axes.names().iter().enumerate())
        .filter(|(i, _)| !has(&|c| matches!(c, Column::Axis(j, _) if j == i)))
        .map(|(_, (name, _))| name.as_str())
        .collect();
    if !without.is_empty() {
        Missing { line, faults }.add(format!(
            "columns are missing for the axes {}, with their units (such as {}_deg)",
            without.join(", "),
            without[0]
        ));
    }
    columns
}

/// Columns of a load and of what was read.
fn measured_columns(columns: &[Option<Column>], missing: &mut Missing<'_>) {
    let has = |wanted: &dyn Fn(&Column) -> bool| columns.iter().flatten().any(wanted);
    if !has(&|c| matches!(c, Column::Force(..) | Column::Moment(..) | Column::Mass)) {
        missing.add(
            "no column states the load: fx_n, fy_n, fz_n, mx_n_m, my_n_m, mz_n_m or mass_kg"
                .to_owned(),
        );
    }
    let vectors: [(&str, ComponentOf); 4] = [
        ("dx, dy and dz", |c| {
            if let Column::Displacement(k, _) = c {
                Some(*k)
            } else {
                None
            }
        }),
        ("x, y and z", |c| {
            if let Column::Position(k, _) = c {
                Some(*k)
            } else {
                None
            }
        }),
        ("rx, ry and rz", |c| {
            if let Column::Turn(k, _) = c {
                Some(*k)
            } else {
                None
            }
        }),
        ("gauge_x, gauge_y and gauge_z", |c| {
            if let Column::GaugeDirection(k) = c {
                Some(*k)
            } else {
                None
            }
        }),
    ];
    let mut reads = false;
    for (names, of) in vectors {
        let count = (0..3).filter(|k| has(&|c| of(c) == Some(*k))).count();
        reads |= count == 3;
        if count == 1 || count == 2 {
            missing.add(format!(
                "of {names} only {count} of 3 columns are there; give all three"
            ));
        }
    }
    if !reads {
        missing.add("no column states what was read: dx_mm, dy_mm, dz_mm, or x_mm, y_mm, z_mm, or rx_mrad, ry_mrad, rz_mrad, or gauge_mm with gauge_x, gauge_y, gauge_z".to_owned());
    }
    if has(&|c| matches!(c, Column::Gauge(_))) != has(&|c| matches!(c, Column::GaugeDirection(_))) {
        missing.add("a dial gauge needs its reading (gauge_mm) and its direction (gauge_x, gauge_y, gauge_z)".to_owned());
    }
}

/// A column without its unit.
fn quantity(column: &Column) -> Column {
    match *column {
        Column::Axis(i, _) => Column::Axis(i, 0.0),
        Column::Force(k, _) => Column::Force(k, 0.0),
        Column::Moment(k, _) => Column::Moment(k, 0.0),
        Column::LoadAt(k, _) => Column::LoadAt(k, 0.0),
        Column::Marker(k, _) => Column::Marker(k, 0.0),
        Column::Displacement(k, _) => Column::Displacement(k, 0.0),
        Column::Position(k, _) => Column::Position(k, 0.0),
        Column::Turn(k, _) => Column::Turn(k, 0.0),
        Column::Gauge(_) => Column::Gauge(0.0),
        Column::Deviation(_) => Column::Deviation(0.0),
        Column::TurnDeviation(_) => Column::TurnDeviation(0.0),
        other => other,
    }
}

struct Row<'r> {
    line: usize,
    heads: &'r [&'r str],
    columns: &'r [Option<Column>],
    cells: &'r [&'r str],
    /// The decimal sign may be a comma.
    comma: bool,
}

/// What the cells of a row say, so far.
#[derive(Default)]
struct Cells {
    posture: Option<String>,
    unloading: Option<bool>,
    shown: Vec<f64>,
    force: Vector3<f64>,
    moment: Vector3<f64>,
    mass: f64,
    load_at: BodyPoint,
    marker: BodyPoint,
    displacement: [Option<f64>; 3],
    position: [Option<f64>; 3],
    turn: [Option<f64>; 3],
    gauge: Option<f64>,
    gauge_direction: [Option<f64>; 3],
    deviation: Option<f64>,
    turn_deviation: Option<f64>,
}

impl Cells {
    /// Takes a cell that holds a word.
    fn word(&mut self, column: Column, cell: &str, axes: &Axes<'_>) -> Result<(), String> {
        match column {
            Column::Posture if cell.is_empty() => return Err("the posture has no name: write it in every row (of merged cells of a spreadsheet only the first has it)".to_owned()),
            Column::Posture => self.posture = Some(cell.to_owned()),
            Column::LoadOn if !cell.is_empty() => self.load_at.on = axes.body(cell)?,
            Column::MarkerOn if !cell.is_empty() => self.marker.on = axes.body(cell)?,
            Column::Branch => {
                self.unloading = match cell {
                    "" => None,
                    "loading" => Some(false),
                    "unloading" => Some(true),
                    _ => return Err("write loading or unloading".to_owned()),
                };
            }
            _ => {}
        }
        Ok(())
    }

    /// Takes a cell that holds a number.
    fn number(&mut self, column: Column, number: f64) -> Result<(), String> {
        match column {
            Column::Axis(i, unit) => self.shown[i] = number * unit,
            Column::Force(k, unit) => self.force[k] = number * unit,
            Column::Moment(k, unit) => self.moment[k] = number * unit,
            Column::Mass if number < 0.0 => return Err("a mass is not negative".to_owned()),
            Column::Mass => self.mass = number,
            Column::LoadAt(k, unit) => self.load_at.at[k] = number * unit,
            Column::Marker(k, unit) => self.marker.at[k] = number * unit,
            Column::Displacement(k, unit) => self.displacement[k] = Some(number * unit),
            Column::Position(k, unit) => self.position[k] = Some(number * unit),
            Column::Turn(k, unit) => self.turn[k] = Some(number * unit),
            Column::Gauge(unit) => self.gauge = Some(number * unit),
            Column::GaugeDirection(k) => self.gauge_direction[k] = Some(number),
            Column::Deviation(_) | Column::TurnDeviation(_) if number <= 0.0 => {
                return Err("a standard deviation is above zero".to_owned());
            }
            Column::Deviation(unit) => self.deviation = Some(number * unit),
            Column::TurnDeviation(unit) => self.turn_deviation = Some(number * unit),
            Column::Posture | Column::Note | Column::Branch | Column::LoadOn | Column::MarkerOn => {
            }
        }
        Ok(())
    }

    /// What was read; faults are those of the row as a whole.
    fn read(&self, fault: &mut impl FnMut(String)) -> Read {
        // What no load and no machine does comes from another unit, or from a cell that is something else.
        let mut within = |parts: &[Option<f64>], most: f64, what: &str| {
            if parts.iter().flatten().any(|x| x.abs() > most) {
                fault(format!("{what}: look at its unit"));
            }
        };
        within(&self.displacement, 1.0, "a displacement of more than 1 m");
        within(&self.position, 1e3, "a place more than 1 km away");
        within(&self.turn, 1.0, "a turn of more than 1 rad");
        within(&[self.gauge], 1.0, "a gauge that reads more than 1 m");
        let mut vector = |parts: [Option<f64>; 3], names: &str| match parts {
            [Some(x), Some(y), Some(z)] => Some(Vector3::new(x, y, z)),
            [None, None, None] => None,
            _ => {
                fault(format!(
                    "of {names} some cells are empty: fill all three, or none"
                ));
                None
            }
        };
        let (displacement, position) = (
            vector(self.displacement, "dx, dy and dz"),
            vector(self.position, "x, y and z"),
        );
        let turn = vector(self.turn, "rx, ry and rz");
        let direction = vector(self.gauge_direction, "gauge_x, gauge_y and gauge_z");
        let gauge = self.gauge.zip(direction).and_then(|(value, direction)| {
            let unit = direction.try_normalize(1e-12);
            if unit.is_none() {
                fault("the direction of the gauge has no length".to_owned());
            }
            Some((value, unit?))
        });
        Read {
            displacement,
            position,
            turn,
            gauge,
        }
    }
}

impl Row<'_> {
    fn read(&self, axes: &Axes<'_>, faults: &mut Vec<TableFault>) -> Option<MeasuredRow> {
        let mut own = Cells {
            shown: vec![0.0; axes.names().len()],
            ..Cells::default()
        };
        for ((column, cell), head) in self.columns.iter().zip(self.cells).zip(self.heads) {
            let Some(column) = *column else { continue };
            let mut check = |taken: Result<(), String>| {
                if let Err(message) = taken {
                    faults.push(TableFault {
                        line: self.line,
                        column: Some((*head).to_owned()),
                        found: Some((*cell).to_owned()).filter(|c| !c.is_empty()),
                        message,
                    });
                }
            };
            if column.is_word() {
                check(own.word(column, cell, axes));
                continue;
            }
            // What was not read may stay empty; a load that is not there is zero.
            if cell.is_empty() && !matches!(column, Column::Axis(..)) {
                continue;
            }
            let number = self.number(cell);
            if number.is_none() {
                check(Err(match cell.is_empty() {
                    true => "the cell is empty; a number is needed".to_owned(),
                    false => "this is no number".to_owned(),
                }));
            }
            // A reading with a fault stays one, so that it is not taken for missing.
            check(own.number(column, number.unwrap_or(f64::NAN)));
        }
        let mut fault = |message: String| {
            faults.push(TableFault {
                line: self.line,
                column: None,
                found: None,
                message,
            });
        };
        let read = own.read(&mut fault);
        let commands = axes.commands(&own.shown)?;
        for message in axes.beyond_limits(&commands) {
            fault(message);
        }
        Some(MeasuredRow {
            line: self.line,
            posture: own.posture.unwrap_or_else(|| self.posture_of_cells()),
            shown: own.shown,
            commands,
            load: TestLoad {
                force: own.force,
                moment: own.moment,
                at: own.load_at,
            },
            mass: own.mass,
            marker: own.marker,
            read,
            deviation: own.deviation,
            turn_deviation: own.turn_deviation,
            unloading: own.unloading,
        })
    }

    fn number(&self, cell: &str) -> Option<f64> {
        let number = match self.comma && !cell.contains('.') {
            true => cell.replacen(',', ".", 1).parse::<f64>(),
            false => cell.parse::<f64>(),
        };
        number.ok().filter(|x| x.is_finite())
    }

    /// A posture without a name is called by its axes as they stand in the file.
    fn posture_of_cells(&self) -> String {
        let own = self
            .columns
            .iter()
            .zip(self.cells)
            .filter(|(c, _)| matches!(c, Some(Column::Axis(..))));
        let cells: Vec<&str> = own.map(|(_, cell)| *cell).collect();
        cells.join(" ")
    }
}
