//! Responses in columns of text (CSV), units in the names of the columns.

use nalgebra::Complex;

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::measured::response::{MeasuredResponse, Motion};

/// Units at the end of a column's name, with motion and size in SI.
const UNITS: [(&str, Motion, f64); 8] = [
    ("_mm_per_s2_per_n", Motion::Acceleration, 1e-3),
    ("_m_per_s2_per_n", Motion::Acceleration, 1.0),
    ("_mm_per_s_per_n", Motion::Velocity, 1e-3),
    ("_m_per_s_per_n", Motion::Velocity, 1.0),
    ("_g_per_n", Motion::Acceleration, 9.80665),
    ("_um_per_n", Motion::Displacement, 1e-6),
    ("_mm_per_n", Motion::Displacement, 1e-3),
    ("_m_per_n", Motion::Displacement, 1.0),
];

/// Suffixes of columns for the parts of a complex number: short ones, and those of `kinetostat frf --csv`.
const REAL: [&str; 2] = ["_re", "_real"];
const IMAGINARY: [&str; 2] = ["_im", "_imaginary"];
const MAGNITUDE: [&str; 2] = ["_mag", "_magnitude"];

/// Representation of a complex number by two columns.
#[derive(Clone, Copy, PartialEq)]
enum Parts {
    Cartesian,
    Polar,
}

/// A response by its columns.
struct Columns {
    name: String,
    parts: Parts,
    first: usize,
    second: usize,
    motion: Motion,
    size: f64,
}

fn fault(line: usize, quantity: &str, found: impl ToString, expected: &str) -> ChatterError {
    ChatterError::new(ChatterErrorKind::File, quantity, found, expected).at_line(line)
}

/// Reads responses from columns of text.
///
/// The first line names the columns: `frequency_hz`, and for each response `NAME_re_UNIT` and `NAME_im_UNIT` (or `real` and
/// `imaginary`), or `NAME_mag_UNIT` and `NAME_phase_deg`. `UNIT` is `m_per_n`, `mm_per_n`, `um_per_n`, `m_per_s_per_n`, `mm_per_s_per_n`,
/// `m_per_s2_per_n`, `mm_per_s2_per_n` or `g_per_n`. Names as `xy` or `x_by_y` are read as motion along x by a force along y. Columns are
/// parted by commas, semicolons or tabs; lines that begin with `#` are left out, and so are columns of turns or by moments
/// (`rad_per_n`, `m_per_n_m`; [`turning_columns`] names them).
///
/// ```
/// let text = "frequency_hz,xx_re_um_per_n,xx_im_um_per_n\n10,0.5,-0.01\n11,0.6,-0.02\n";
/// let responses = kinetostat_chatter::read_columns(text)?;
/// assert_eq!(responses[0].response_direction, 1);
/// assert!((responses[0].values[1].re - 0.6e-6).abs() < 1e-18);
/// # Ok::<(), kinetostat_chatter::ChatterError>(())
/// ```
///
/// # Errors
/// A column without a unit or without its other half, and a line with something else than numbers, by its number.
pub fn read_columns(text: &str) -> Result<Vec<MeasuredResponse>> {
    let mut lines = text
        .trim_start_matches('\u{feff}')
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (head, names) = lines
        .next()
        .ok_or_else(|| fault(1, "columns", "an empty file", "a line with their names"))?;
    let parting = [';', '\t', ',']
        .into_iter()
        .find(|c| names.contains(*c))
        .unwrap_or(',');
    let names: Vec<String> = names
        .split(parting)
        .map(|name| name.trim().trim_matches('"').to_lowercase())
        .collect();
    let frequency = names
        .iter()
        .position(|name| name == "frequency_hz")
        .ok_or_else(|| fault(head, "columns", names.join(", "), "one named frequency_hz"))?;
    let columns = columns(&names, frequency, head)?;
    let mut frequencies = Vec::new();
    let mut values: Vec<Vec<Complex<f64>>> = vec![Vec::new(); columns.len()];
    for (line, text) in lines {
        let fields: Vec<&str> = text.split(parting).map(str::trim).collect();
        if fields.len() != names.len() {
            let found = format!("{} fields", fields.len());
            let expected = format!("{}, as many as columns are named", names.len());
            return Err(fault(line, "line of numbers", found, &expected));
        }
        let read = |column: usize| {
            let number = fields[column].trim_matches('"').parse::<f64>().ok();
            let number = number.filter(|value| value.is_finite());
            number.ok_or_else(|| {
                let expected = "a finite number";
                fault(line, &names[column], fields[column], expected)
            })
        };
        frequencies.push(read(frequency)?);
        for (column, values) in columns.iter().zip(&mut values) {
            let (a, b) = (read(column.first)?, read(column.second)?);
            values.push(match column.parts {
                Parts::Cartesian => Complex::new(a, b) * column.size,
                Parts::Polar => Complex::from_polar(a * column.size, b.to_radians()),
            });
        }
    }
    let whole = |(column, values): (Columns, Vec<Complex<f64>>)| {
        let (response_direction, reference_direction) = directions(&column.name);
        MeasuredResponse {
            response_node: 1,
            response_direction,
            reference_node: 1,
            reference_direction,
            name: column.name,
            motion: column.motion,
            frequencies_hz: frequencies.clone(),
            values,
            units_stated: true,
        }
        .checked(head)
    };
    columns.into_iter().zip(values).map(whole).collect()
}

/// True for a column of a rotation, or of the response to a moment.
fn is_turning(name: &str) -> bool {
    name.contains("_rad_per_") || name.ends_with("_per_n_m")
}

/// Responses of turns or by moments in columns of text, by their names: [`read_columns`] leaves them out.
///
/// ```
/// let head = "frequency_hz,x_by_x_re_m_per_n,x_by_x_im_m_per_n,rz_by_x_re_rad_per_n,rz_by_x_im_rad_per_n\n";
/// assert_eq!(kinetostat_chatter::turning_columns(head), ["rz_by_x"]);
/// ```
#[must_use]
pub fn turning_columns(text: &str) -> Vec<String> {
    let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
    let mut lines = lines.filter(|line| !line.is_empty() && !line.starts_with('#'));
    let mut names: Vec<String> = Vec::new();
    for name in lines.next().unwrap_or("").split([';', '\t', ',']) {
        let name = name.trim().trim_matches('"').to_lowercase();
        let words = [REAL, IMAGINARY, MAGNITUDE].concat();
        let stem = words
            .iter()
            .find_map(|word| Some(name.split_once(&format!("{word}_"))?.0));
        if let Some(stem) = stem.filter(|_| is_turning(&name))
            && names.iter().all(|own| own != stem)
        {
            names.push(stem.to_owned());
        }
    }
    names
}

/// Motion and force of a name as `xy` or `x_by_y`; 0 for what it does not tell.
fn directions(name: &str) -> (i32, i32) {
    let of = |c: char| "xyz".find(c).map_or(0, |at| at as i32 + 1);
    match name.replace("_by_", "").chars().collect::<Vec<_>>()[..] {
        [a, b] if of(a) > 0 && of(b) > 0 => (of(a), of(b)),
        _ => (0, 0),
    }
}

/// Responses by their pairs of columns.
fn columns(names: &[String], frequency: usize, head: usize) -> Result<Vec<Columns>> {
    let mut all = Vec::new();
    let other = |wanted: String, of: &str| {
        names
            .iter()
            .position(|name| *name == wanted)
            .ok_or_else(|| {
                let expected = format!("{wanted} beside it");
                fault(head, of, "alone", &expected)
            })
    };
    for (first, name) in names.iter().enumerate() {
        if first == frequency || name.ends_with("_phase_deg") || is_turning(name) {
            continue;
        }
        let unit = UNITS.iter().find(|(unit, ..)| name.ends_with(unit));
        let Some((unit, motion, size)) = unit else {
            let expected = "a unit at its end, as _m_per_n, _um_per_n, _m_per_s2_per_n, _g_per_n";
            return Err(fault(head, "name of a column", name, expected));
        };
        let stem = &name[..name.len() - unit.len()];
        let parted = |words: [&str; 2]| {
            let at = words.iter().position(|word| stem.ends_with(word))?;
            Some((&stem[..stem.len() - words[at].len()], at))
        };
        let (name, parts, second) = if let Some((stem, at)) = parted(REAL) {
            let second = other(format!("{stem}{}{unit}", IMAGINARY[at]), name)?;
            (stem, Parts::Cartesian, second)
        } else if let Some((stem, at)) = parted(IMAGINARY) {
            other(format!("{stem}{}{unit}", REAL[at]), name)?;
            continue;
        } else if let Some((stem, _)) = parted(MAGNITUDE) {
            let second = other(format!("{stem}_phase_deg"), name)?;
            // Duplicate of other columns, as `frf --csv` writes them.
            if REAL
                .iter()
                .any(|real| names.contains(&format!("{stem}{real}{unit}")))
            {
                continue;
            }
            (stem, Parts::Polar, second)
        } else {
            let expected = "_re, _im or _mag before its unit";
            return Err(fault(head, "name of a column", name, expected));
        };
        all.push(Columns {
            name: name.to_owned(),
            parts,
            first,
            second,
            motion: *motion,
            size: *size,
        });
    }
    match all.is_empty() {
        true => Err(fault(
            head,
            "columns",
            "no response of a motion along an axis by a force",
            "at least one response",
        )),
        false => Ok(all),
    }
}
