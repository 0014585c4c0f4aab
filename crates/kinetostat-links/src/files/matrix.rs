//! 6 x 6 matrices in CSV and JSON: units in the key, a stated point and stated axes.
//!
//! CSV (separated by comma, semicolon or tab; `#` starts a comment):
//!
//! ```text
//! source,FEA of the forearm 2024-03
//! reference_point_mm,0,0,25
//! stiffness_n_mm_rad,x,y,z,rx,ry,rz
//! x,85000,0,0,0,0,0
//! ...
//! ```
//!
//! JSON has the same words as keys: `{"stiffness_n_mm_rad": [[...], ...], "reference_point_mm": [0, 0, 25]}`.
//! Rows and columns of CSV may stand in any order; that of JSON is x, y, z, rx, ry, rz unless `order`
//! says otherwise.

use kinetostat::spatial::{shift_matrix, turn_matrix};
use nalgebra::{Matrix3, Matrix6, Rotation3, Vector3};
use serde::Deserialize;

use crate::error::{Error, Result};
use crate::interface::invert;
use crate::stiffness_check::DIRECTIONS;
use crate::text::{Text, fields, number, short};
use crate::units::Units;

/// Content of a file with one 6 x 6 matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkMatrix {
    /// Stiffness as the file has it, N/m, N/rad, N m/m, N m/rad; own axes, own point.
    pub stiffness: Matrix6<f64>,
    /// Point that the matrix belongs to, from the link's far end, in the link's axes, m.
    pub reference_point: Vector3<f64>,
    /// Axes of the matrix in the link's: `link = axes * own`.
    pub axes: Rotation3<f64>,
    /// Units of the file.
    pub units: Units,
    /// True if the file holds a compliance, which was inverted.
    pub was_compliance: bool,
    /// Source of the figures, as the file states it.
    pub source: Option<String>,
}

impl LinkMatrix {
    /// The stiffness at the link's far end in the link's axes, SI.
    #[must_use]
    pub fn at_link_end(&self) -> Matrix6<f64> {
        let turn = turn_matrix(&self.axes);
        let shift = shift_matrix(&self.reference_point);
        shift.transpose() * (turn * self.stiffness * turn.transpose()) * shift
    }
}

/// Axes from the direction of x and a direction that y leans to.
pub fn axes_from(x: &Vector3<f64>, y: &Vector3<f64>) -> Option<Rotation3<f64>> {
    let x = x.try_normalize(1e-9)?;
    let y = (y - x * x.dot(y)).try_normalize(1e-6 * y.norm().max(1e-3))?;
    let z = x.cross(&y);
    Some(Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[
        x, y, z,
    ])))
}

#[derive(Clone, Default)]
struct Written {
    rows: Option<(Matrix6<f64>, Units, bool)>,
    point: Option<Vector3<f64>>,
    x_axis: Option<Vector3<f64>>,
    y_axis: Option<Vector3<f64>>,
    source: Option<String>,
}

/// Reads a CSV or JSON file (distinguished by its first character). `bare`: units of six plain rows of
/// six numbers without a header; `None` refuses those.
///
/// # Errors
///
/// With file, line and what to do: no matrix, a row or number missing or wrong, unknown keys or units,
/// axes that are none, a compliance that cannot be inverted.
pub fn read_matrix(text: &Text, bare: Option<Units>) -> Result<LinkMatrix> {
    let written = if text.body().trim_start().starts_with(['{', '[']) {
        json(text)?
    } else {
        csv(text, bare)?
    };
    let Some((matrix, units, compliance)) = written.rows else {
        return Err(text.fault(
            "the file holds no matrix",
            format!(
                "a header stiffness_UNITS_rad,x,y,z,rx,ry,rz and six rows are needed; units are {}",
                Units::names()
            ),
        ));
    };
    let stiffness = if compliance {
        let c = units.compliance_to_si(&matrix);
        invert(&c).ok_or_else(|| {
            text.fault(
                "the compliance cannot be inverted",
                "a direction without any compliance is rigid: give the stiffness, or a small compliance there",
            )
        })?
    } else {
        units.stiffness_to_si(&matrix)
    };
    let x = written.x_axis.unwrap_or_else(Vector3::x);
    let y = written.y_axis.unwrap_or_else(Vector3::y);
    let axes = axes_from(&x, &y).ok_or_else(|| {
        text.fault(
            "x_axis and y_axis span no frame",
            "give two directions that are not parallel and not zero",
        )
    })?;
    Ok(LinkMatrix {
        stiffness,
        reference_point: written.point.unwrap_or_default(),
        axes,
        units,
        was_compliance: compliance,
        source: written.source,
    })
}

/// `stiffness_n_mm_rad` -> (units, is it a compliance).
fn kind(word: &str) -> Option<(Units, bool)> {
    let word = word.to_lowercase();
    let (rest, compliance) = match word.strip_prefix("stiffness_") {
        Some(rest) => (rest, false),
        None => (word.strip_prefix("compliance_")?, true),
    };
    Some((Units::named(rest.strip_suffix("_rad")?)?, compliance))
}

fn csv(text: &Text, bare: Option<Units>) -> Result<Written> {
    let mut written = Written::default();
    let mut lines = text
        .lines()
        .filter(|(_, l)| !fields(l).iter().all(|f| f.is_empty()));
    while let Some((at, line)) = lines.next() {
        let cells = fields(line);
        let word = cells[0].to_lowercase();
        let vector = |what: &str, scale: f64| -> Result<Vector3<f64>> {
            if cells.len() < 4 || cells[4..].iter().any(|c| !c.is_empty()) {
                return Err(text
                    .fault(
                        format!("'{what}' has {} values", cells.len() - 1),
                        "three numbers are needed",
                    )
                    .at(at));
            }
            let mut v = Vector3::zeros();
            for i in 0..3 {
                v[i] = scale * text.number(at, what, cells[i + 1])?;
            }
            Ok(v)
        };
        match word.as_str() {
            "source" => {
                written.source = Some(
                    cells[1..]
                        .join(", ")
                        .trim_end_matches([',', ' '])
                        .to_owned(),
                )
            }
            "reference_point_mm" => written.point = Some(vector(&word, 1e-3)?),
            "reference_point_m" => written.point = Some(vector(&word, 1.0)?),
            "x_axis" => written.x_axis = Some(vector(&word, 1.0)?),
            "y_axis" => written.y_axis = Some(vector(&word, 1.0)?),
            _ if number(&word).is_some() && written.rows.is_none() => {
                let Some(units) = bare else {
                    return Err(text
                        .fault(
                            "the matrix has no header, so its units are unknown",
                            "put a line stiffness_n_mm_rad,x,y,z,rx,ry,rz before it (and the direction before each row), or say --units",
                        )
                        .at(at));
                };
                let matrix = bare_rows(text, at, line, &mut lines)?;
                written.rows = Some((matrix, units, false));
            }
            _ => {
                let Some((units, compliance)) = kind(&word) else {
                    return Err(text
                        .fault(
                            format!("'{}' is no key of a matrix file", short(cells[0])),
                            format!("there are stiffness_UNITS_rad, compliance_UNITS_rad (units {}), reference_point_mm, x_axis, y_axis, source", Units::names()),
                        )
                        .at(at));
                };
                if written.rows.is_some() {
                    return Err(text
                        .fault("there is a second matrix", "one file holds one matrix")
                        .at(at));
                }
                let columns = order(text, at, &cells[1..])?;
                let matrix = named_rows(text, &columns, &mut lines)?;
                written.rows = Some((matrix, units, compliance));
            }
        }
    }
    Ok(written)
}

/// Six rows without names, the first of which has been read.
fn bare_rows<'t>(
    text: &Text,
    first_at: usize,
    first: &'t str,
    lines: &mut impl Iterator<Item = (usize, &'t str)>,
) -> Result<Matrix6<f64>> {
    let mut matrix = Matrix6::zeros();
    let mut row = Some((first_at, first));
    for i in 0..6 {
        let (at, line) = row.ok_or_else(|| rows_missing(text, i))?;
        set_row(
            text,
            at,
            &fields(line),
            0,
            &mut matrix,
            i,
            &[0, 1, 2, 3, 4, 5],
        )?;
        row = if i < 5 { lines.next() } else { None };
    }
    Ok(matrix)
}

/// Six rows, each after the name of its direction, in any order.
fn named_rows<'t>(
    text: &Text,
    columns: &[usize; 6],
    lines: &mut impl Iterator<Item = (usize, &'t str)>,
) -> Result<Matrix6<f64>> {
    let mut matrix = Matrix6::zeros();
    let mut seen = [0; 6];
    for i in 0..6 {
        let (at, line) = lines.next().ok_or_else(|| rows_missing(text, i))?;
        let cells = fields(line);
        let row = direction(text, at, cells[0])?;
        if seen[row] > 0 {
            return Err(text
                .fault(
                    format!(
                        "the row {} is written twice, also at line {}",
                        DIRECTIONS[row], seen[row]
                    ),
                    "there is one row for each of x, y, z, rx, ry, rz",
                )
                .at(at));
        }
        seen[row] = at;
        set_row(text, at, &cells, 1, &mut matrix, row, columns)?;
    }
    Ok(matrix)
}

fn rows_missing(text: &Text, found: usize) -> Error {
    text.fault(
        format!("the matrix ends after {found} rows"),
        "six rows are needed: x, y, z, rx, ry, rz",
    )
}

fn set_row(
    text: &Text,
    at: usize,
    cells: &[&str],
    skip: usize,
    matrix: &mut Matrix6<f64>,
    row: usize,
    columns: &[usize; 6],
) -> Result<()> {
    let values = &cells[skip.min(cells.len())..];
    let used = values
        .iter()
        .rposition(|c| !c.is_empty())
        .map_or(0, |p| p + 1);
    if used != 6 {
        return Err(text
            .fault(
                format!("the row {} of the matrix has {used} numbers", DIRECTIONS[row]),
                "six are needed; a decimal comma needs semicolons between the fields and becomes a point",
            )
            .at(at));
    }
    for (c, value) in values[..6].iter().enumerate() {
        let what = format!("row {} column {}", DIRECTIONS[row], DIRECTIONS[columns[c]]);
        matrix[(row, columns[c])] = text.number(at, &what, value)?;
    }
    Ok(())
}

fn direction(text: &Text, at: usize, word: &str) -> Result<usize> {
    let lower = word.to_lowercase();
    DIRECTIONS.iter().position(|d| *d == lower).ok_or_else(|| {
        text.fault(
            format!("'{}' is no direction", short(word)),
            "the directions are x, y, z, rx, ry, rz",
        )
        .at(at)
    })
}

/// Direction of each column.
fn order(text: &Text, at: usize, cells: &[&str]) -> Result<[usize; 6]> {
    let cells: Vec<&str> = cells.iter().copied().filter(|c| !c.is_empty()).collect();
    let mut columns = [usize::MAX; 6];
    if cells.len() != 6 {
        return Err(text
            .fault(
                format!("the header names {} directions", cells.len()),
                "it names six: x, y, z, rx, ry, rz",
            )
            .at(at));
    }
    for (c, word) in cells.iter().enumerate() {
        let d = direction(text, at, word)?;
        if columns.contains(&d) {
            return Err(text
                .fault(
                    format!("the header names {} twice", DIRECTIONS[d]),
                    "it names x, y, z, rx, ry, rz once each",
                )
                .at(at));
        }
        columns[c] = d;
    }
    Ok(columns)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Json {
    stiffness_n_mm_rad: Option<[[f64; 6]; 6]>,
    stiffness_n_m_rad: Option<[[f64; 6]; 6]>,
    stiffness_kn_mm_rad: Option<[[f64; 6]; 6]>,
    stiffness_kn_m_rad: Option<[[f64; 6]; 6]>,
    stiffness_lbf_in_rad: Option<[[f64; 6]; 6]>,
    compliance_n_mm_rad: Option<[[f64; 6]; 6]>,
    compliance_n_m_rad: Option<[[f64; 6]; 6]>,
    compliance_kn_mm_rad: Option<[[f64; 6]; 6]>,
    compliance_kn_m_rad: Option<[[f64; 6]; 6]>,
    compliance_lbf_in_rad: Option<[[f64; 6]; 6]>,
    order: Option<[String; 6]>,
    reference_point_mm: Option<[f64; 3]>,
    reference_point_m: Option<[f64; 3]>,
    x_axis: Option<[f64; 3]>,
    y_axis: Option<[f64; 3]>,
    source: Option<String>,
}

fn json(text: &Text) -> Result<Written> {
    let read: Json = serde_json::from_str(text.body()).map_err(|e| {
        text.fault(
            short_reason(&e.to_string()),
            "a matrix file is an object with one key such as stiffness_n_mm_rad (six rows of six numbers), and reference_point_mm, x_axis, y_axis, order, source as needed",
        )
        .at(e.line())
    })?;
    let given = [
        ("stiffness_n_mm_rad", read.stiffness_n_mm_rad),
        ("stiffness_n_m_rad", read.stiffness_n_m_rad),
        ("stiffness_kn_mm_rad", read.stiffness_kn_mm_rad),
        ("stiffness_kn_m_rad", read.stiffness_kn_m_rad),
        ("stiffness_lbf_in_rad", read.stiffness_lbf_in_rad),
        ("compliance_n_mm_rad", read.compliance_n_mm_rad),
        ("compliance_n_m_rad", read.compliance_n_m_rad),
        ("compliance_kn_mm_rad", read.compliance_kn_mm_rad),
        ("compliance_kn_m_rad", read.compliance_kn_m_rad),
        ("compliance_lbf_in_rad", read.compliance_lbf_in_rad),
    ];
    let mut given = given.into_iter().filter_map(|(k, m)| Some((k, m?)));
    let first = given.next();
    if let (Some((one, _)), Some((other, _))) = (&first, given.next()) {
        return Err(text.fault(
            format!("the matrix is given twice: '{one}' and '{other}'"),
            "keep one of them",
        ));
    }
    if read.reference_point_mm.is_some() && read.reference_point_m.is_some() {
        return Err(text.fault("the reference point is given twice", "keep one of them"));
    }
    let columns = match &read.order {
        None => [0, 1, 2, 3, 4, 5],
        Some(words) => {
            let words: Vec<&str> = words.iter().map(String::as_str).collect();
            order(text, 1, &words)?
        }
    };
    let rows = first.and_then(|(key, rows)| {
        let (units, compliance) = kind(key)?;
        let mut matrix = Matrix6::zeros();
        for i in 0..6 {
            for j in 0..6 {
                matrix[(columns[i], columns[j])] = rows[i][j];
            }
        }
        Some((matrix, units, compliance))
    });
    let point = read
        .reference_point_mm
        .map(|p| Vector3::from(p) * 1e-3)
        .or(read.reference_point_m.map(Vector3::from));
    Ok(Written {
        rows,
        point,
        x_axis: read.x_axis.map(Vector3::from),
        y_axis: read.y_axis.map(Vector3::from),
        source: read.source,
    })
}

/// Serde's reason without the place that it repeats, of bounded length.
fn short_reason(reason: &str) -> String {
    let reason = reason.rsplit_once(" at line").map_or(reason, |(r, _)| r);
    match reason.char_indices().nth(200) {
        Some((at, _)) => format!("{}...", &reason[..at]),
        None => reason.to_owned(),
    }
}
