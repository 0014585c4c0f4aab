//! Measured points from CSV.

use nalgebra::Vector3;

use crate::error::MirrorError;
use crate::points::set::{MeasuredPoint, MeasuredPoints, possible};

/// Coarsest digit of measured points, mm: a file without finer ones leaves out zeros.
const COARSEST_DIGIT_MM: f64 = 0.01;

impl MeasuredPoints {
    /// Points from CSV with commas or semicolons: columns of x, y and z with their units (`x_mm`, `y_m`, `z_um`), and
    /// `weight` or a standard deviation (`sigma_mm`), and `line` (the line of the program on which the tool was) where the
    /// measurement knows them. Lines that begin with `#` and empty ones are passed over.
    ///
    /// ```
    /// use kinetostat_mirror::MeasuredPoints;
    ///
    /// let text = "# laser tracker\nx_mm;y_mm;z_mm\n0;0;0\n1;;0\n";
    /// let error = MeasuredPoints::read("trial1.csv", text).unwrap_err();
    /// assert_eq!(error.to_string(), "trial1.csv:4: y is ``; expected a number with a decimal point");
    /// ```
    ///
    /// # Errors
    /// With file and line: columns that are missing, unknown, there twice or without a unit; cells that are no numbers; rows
    /// of another length; and as [`MeasuredPoints::new`].
    pub fn read(name_of_file: &str, text: &str) -> Result<Self, MirrorError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut columns = None;
        let mut points = Vec::new();
        let mut last = 1;
        let rows = text.lines().zip(1..).filter(|(line, _)| {
            let line = line.trim();
            !line.is_empty() && !line.starts_with('#')
        });
        let mut separator = b',';
        let mut digit_mm = f64::INFINITY;
        for (line, number) in rows {
            let at = |error: MirrorError| error.at(name_of_file, number);
            last = number;
            if columns.is_none() && line.contains(';') {
                separator = b';';
            }
            let record = cells(line, separator).map_err(at)?;
            let Some((found, width)) = &columns else {
                columns = Some((Columns::of(&record).map_err(at)?, record.len()));
                continue;
            };
            if record.len() != *width {
                return Err(at(MirrorError::new(format!(
                    "{} cells under {width} columns; expected as many as the header has",
                    record.len()
                ))));
            }
            let row = points.len() + 1;
            let point = point(found, &record, row, number).map_err(at)?;
            possible(&point).map_err(at)?;
            points.push(point);
            for (index, unit_mm) in &found.axes {
                let digit = last_digit(record.get(*index).unwrap_or_default().trim());
                digit_mm = digit_mm.min(unit_mm * digit);
            }
        }
        let points = Self::new(points).map_err(|error| error.at(name_of_file, last))?;
        // A number that was rounded is off by anything up to half a digit: the deviation of an even spread.
        Ok(match digit_mm <= COARSEST_DIGIT_MM {
            true => points.known_to(digit_mm / 12.0_f64.sqrt()),
            false => points,
        })
    }
}

/// The cells of one line.
fn cells(line: &str, separator: u8) -> Result<csv::StringRecord, MirrorError> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .delimiter(separator)
        .buffer_capacity(line.len() + 1)
        .from_reader(line.as_bytes());
    let mut record = csv::StringRecord::new();
    match reader.read_record(&mut record) {
        Ok(_) => Ok(record),
        Err(error) => Err(MirrorError::new(error.to_string())),
    }
}

/// Value of one unit in the last digit of a number: 0.01 of `1.25`.
fn last_digit(cell: &str) -> f64 {
    let (digits, exponent) = cell.split_once(['e', 'E']).unwrap_or((cell, "0"));
    let after_point = digits.split_once('.').map_or(0, |(_, after)| after.len());
    let exponent: f64 = exponent.parse().unwrap_or(0.0);
    10.0_f64.powf(exponent - after_point as f64)
}

/// The weight of a standard deviation, whose unit has so many mm. Its square would take any sign.
fn of_deviation(sigma: f64, unit_mm: f64) -> Result<f64, MirrorError> {
    match sigma > 0.0 {
        true => Ok((unit_mm * sigma).powi(-2)),
        false => Err(MirrorError::new(format!(
            "sigma is {sigma}; expected a standard deviation above 0: leave out a row that is not to count, or the column where none is known"
        ))),
    }
}

fn point(
    columns: &Columns,
    record: &csv::StringRecord,
    row: usize,
    line: usize,
) -> Result<MeasuredPoint, MirrorError> {
    let number = |name: &str, index: usize| {
        let cell = record.get(index).unwrap_or_default().trim();
        let number = cell.parse::<f64>().ok().filter(|number| number.is_finite());
        number.ok_or_else(|| {
            let cell = shown(cell);
            MirrorError::new(format!(
                "{name} is `{cell}`; expected a number with a decimal point"
            ))
        })
    };
    let mut position_mm = Vector3::zeros();
    for (axis, (index, mm)) in columns.axes.iter().enumerate() {
        position_mm[axis] = mm * number(["x", "y", "z"][axis], *index)?;
    }
    let weight = match (columns.weight, columns.sigma) {
        (Some(index), _) => number("weight", index)?,
        (None, Some((index, mm))) => of_deviation(number("sigma", index)?, mm)?,
        (None, None) => 1.0,
    };
    let program_line = columns.line.map(|index| {
        let number = number("line", index)?;
        match number >= 1.0 && number.fract() == 0.0 {
            true => Ok(number as usize),
            false => Err(MirrorError::new(format!(
                "line is {number}; expected a line of the program, from 1"
            ))),
        }
    });
    Ok(MeasuredPoint {
        row,
        line,
        position_mm,
        weight,
        program_line: program_line.transpose()?,
    })
}

/// Units of lengths, and how many mm each has.
const UNITS: [(&str, f64); 5] = [
    ("mm", 1.0),
    ("m", 1e3),
    ("um", 1e-3),
    ("cm", 10.0),
    ("in", 25.4),
];

const NEEDED: &str = "expected x_mm,y_mm,z_mm (or _m, _um, _cm, _in) and, if they are known, weight or sigma_mm, and line (of the program)";

/// Index of each quantity's column, lengths with the mm of their unit.
#[derive(Clone, Copy, Default)]
pub(crate) struct Columns {
    pub axes: [(usize, f64); 3],
    pub weight: Option<usize>,
    pub sigma: Option<(usize, f64)>,
    pub line: Option<usize>,
}

impl Columns {
    pub(crate) fn of(headers: &csv::StringRecord) -> Result<Self, MirrorError> {
        let mut axes = [None; 3];
        let mut found = Self::default();
        for (index, name) in headers.iter().map(str::trim).enumerate() {
            let twice = match quantity(name)? {
                Quantity::Axis(axis, mm) => axes[axis].replace((index, mm)).is_some(),
                Quantity::Sigma(mm) => found.sigma.replace((index, mm)).is_some(),
                Quantity::Weight => found.weight.replace(index).is_some(),
                Quantity::Line => found.line.replace(index).is_some(),
            };
            if twice {
                return Err(refused(&format!(
                    "column `{name}` stands for something that another column says already"
                )));
            }
        }
        if found.sigma.is_some() && found.weight.is_some() {
            return Err(refused("weight and sigma both, of which one is enough"));
        }
        for (axis, place) in axes.iter().enumerate() {
            found.axes[axis] =
                place.ok_or_else(|| refused(&format!("no column of {}", ["x", "y", "z"][axis])))?;
        }
        Ok(found)
    }
}

enum Quantity {
    Axis(usize, f64),
    Sigma(f64),
    Weight,
    Line,
}

fn quantity(name: &str) -> Result<Quantity, MirrorError> {
    match name {
        "weight" => return Ok(Quantity::Weight),
        "line" => return Ok(Quantity::Line),
        _ => {}
    }
    let (quantity, unit) = name.split_once('_').unwrap_or((name, ""));
    let axis = ["x", "y", "z"].iter().position(|axis| *axis == quantity);
    if axis.is_none() && quantity != "sigma" {
        return Err(refused(&format!("unknown column `{}`", shown(name))));
    }
    if unit.is_empty() {
        return Err(refused(&format!("column `{name}` states no unit")));
    }
    let known = UNITS.iter().find(|(known, _)| *known == unit);
    let Some((_, mm)) = known else {
        return Err(refused(&format!(
            "column `{}` has an unknown unit",
            shown(name)
        )));
    };
    Ok(axis.map_or(Quantity::Sigma(*mm), |axis| Quantity::Axis(axis, *mm)))
}

fn refused(what: &str) -> MirrorError {
    MirrorError::new(format!("{what}; {NEEDED}"))
}

fn shown(cell: &str) -> String {
    cell.chars().take(40).collect()
}
