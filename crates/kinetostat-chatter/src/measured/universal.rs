//! Universal files: data set 58 (function at nodal degrees of freedom) with its text formats, and 164 (units).
//!
//! Format: SDRC universal file, data sets 58 and 164, as the Structural Dynamics Research Laboratory publishes it. Binary
//! sets (58b) are refused by line.

use nalgebra::Complex;

use crate::error::{ChatterError, ChatterErrorKind, Result};
use crate::measured::response::{
    MeasuredResponse, Motion, force_unit, frequency_unit, motion_unit, response_unit,
};

/// Contents of a universal file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UniversalFile {
    /// Frequency responses, in SI units.
    pub responses: Vec<MeasuredResponse>,
    /// Other contents that were not read, by line, in words.
    pub left_out: Vec<String>,
}

/// A line of the file.
#[derive(Clone, Copy)]
struct Line<'a> {
    /// Number, from 1.
    number: usize,
    text: &'a str,
}

fn fault(line: usize, quantity: &str, found: impl ToString, expected: &str) -> ChatterError {
    ChatterError::new(ChatterErrorKind::File, quantity, found, expected).at_line(line)
}

/// Reads the frequency responses of a universal file.
///
/// Units are those that each response states with its axes (as `mm/s^2`, `N`), else those of data set 164, else SI, which
/// [`MeasuredResponse::units_stated`] then denies.
///
/// # Errors
/// A line that is not what its place in the format asks for, by its number; no frequency response at all.
pub fn read_universal(text: &str) -> Result<UniversalFile> {
    let mut file = UniversalFile::default();
    let mut units: Option<[f64; 2]> = None;
    let mut sets = 0;
    let mut lines = text
        .lines()
        .enumerate()
        .map(|(i, line)| (i + 1, line.trim_end()));
    while let Some((start, line)) = lines.next() {
        if line.trim() != "-1" {
            if line.trim().is_empty() {
                continue;
            }
            let shown: String = line.chars().take(40).collect();
            return Err(fault(
                start,
                "universal file",
                shown,
                "-1, which begins a data set",
            ));
        }
        let Some((at, number)) = lines.next() else {
            break;
        };
        let mut body: Vec<Line<'_>> = Vec::new();
        let mut closed = false;
        for (number, text) in lines.by_ref() {
            if text.trim() == "-1" {
                closed = true;
                break;
            }
            body.push(Line { number, text });
        }
        if !closed {
            return Err(fault(
                start,
                "data set",
                "no end",
                "-1 alone in a line at its end",
            ));
        }
        sets += 1;
        match number.trim() {
            "58" => match function(&body, at, units)? {
                Ok(response) => file.responses.push(response),
                Err(other) => file.left_out.push(format!("line {at}: {other}")),
            },
            "164" => units = Some(unit_factors(&body, at)?),
            other if other.starts_with("58") => {
                let expected = "58 in text: write the file anew without the binary format";
                return Err(fault(at, "data set", other, expected));
            }
            other => file.left_out.push(format!("line {at}: data set {other}")),
        }
    }
    match file.responses.is_empty() {
        false => Ok(file),
        true => Err(ChatterError::new(
            ChatterErrorKind::File,
            "universal file",
            format!("{sets} data sets, no frequency response among them"),
            "data set 58 with function type 4",
        )),
    }
}

/// Factors of length and force by which numbers of the file are divided for SI.
fn unit_factors(body: &[Line<'_>], at: usize) -> Result<[f64; 2]> {
    let &Line { number, text } = body
        .get(1)
        .ok_or_else(|| fault(at, "data set 164", "too short", "units and their factors"))?;
    let numbers = numbers(text, 25).filter(|n| n.len() >= 2 && n[0] > 0.0 && n[1] > 0.0);
    let numbers = numbers.ok_or_else(|| {
        let expected = "positive factors of length and force";
        fault(number, "units", text.trim(), expected)
    })?;
    Ok([numbers[0], numbers[1]])
}

/// Text of a column of a line; empty beyond its end or inside a letter.
fn column(text: &str, from: usize, to: usize) -> &str {
    let end = to.min(text.len());
    text.get(from.min(end)..end).unwrap_or("").trim()
}

fn integer(line: Line<'_>, from: usize, to: usize, quantity: &str) -> Result<i64> {
    match column(line.text, from, to) {
        "" => Ok(0),
        field => field
            .parse()
            .map_err(|_| fault(line.number, quantity, field, "a whole number in its column")),
    }
}

/// All numbers of a line, by blanks, or where they touch by columns of a width; `D` is an exponent, too.
fn numbers(text: &str, width: usize) -> Option<Vec<f64>> {
    let read = |field: &str| field.trim().replace(['D', 'd'], "E").parse::<f64>().ok();
    let by_blanks: Option<Vec<f64>> = text.split_whitespace().map(read).collect();
    by_blanks.or_else(|| {
        let text = text.trim_end();
        text.is_ascii()
            .then(|| {
                (0..text.len())
                    .step_by(width)
                    .map(|at| read(column(text, at, at + width)))
                    .collect()
            })
            .flatten()
    })
}

/// A unit as an axis states it; nothing where the field is empty or says so.
fn stated_unit(text: &str) -> Option<&str> {
    let text = text.trim();
    let none = text.is_empty() || text.eq_ignore_ascii_case("none") || text == "-";
    (!none).then_some(text)
}

/// An axis: kind of quantity and unit as it is written.
fn axis<'a>(body: &[Line<'a>], record: usize) -> Result<(i64, Line<'a>, &'a str)> {
    let line = body[record];
    let kind = integer(line, 0, 10, "kind of an axis")?;
    Ok((kind, line, column(line.text, 47, 67)))
}

/// A function; in words what it is, where it is no frequency response.
fn function(
    body: &[Line<'_>],
    at: usize,
    units: Option<[f64; 2]>,
) -> Result<std::result::Result<MeasuredResponse, String>> {
    if body.len() < 11 {
        let found = format!("{} lines", body.len());
        return Err(fault(
            at,
            "data set 58",
            found,
            "eleven lines before its numbers",
        ));
    }
    let place = body[5];
    let kind = integer(place, 0, 5, "function type")?;
    if kind != 4 {
        return Ok(Err(format!(
            "function of type {kind}, no frequency response (4)"
        )));
    }
    let form = numbers(body[6].text, 10).filter(|form| form.len() >= 5);
    let form = form.ok_or_else(|| {
        let expected = "data type, number of points, spacing, first abscissa and its step";
        fault(
            body[6].number,
            "form of the numbers",
            body[6].text.trim(),
            expected,
        )
    })?;
    let (frequencies_hz, raw) = points(body, &form)?;
    let (abscissa, line, per) = axis(body, 7)?;
    if !matches!(abscissa, 0 | 1 | 18) {
        return Err(fault(
            line.number,
            "abscissa",
            abscissa,
            "18, a frequency, Hz",
        ));
    }
    let hertz = match stated_unit(per) {
        None => 1.0,
        Some(unit) => frequency_unit(unit).ok_or_else(|| {
            fault(
                line.number,
                "unit of the abscissa",
                unit,
                "Hz, kHz, rad/s or rpm",
            )
        })?,
    };
    let (motion, size, stated) = unit(body, units)?;
    let direction = |from, to| -> Result<i32> { Ok(integer(place, from, to, "direction")? as i32) };
    let name = [body[0].text, body[1].text].map(str::trim);
    let response = MeasuredResponse {
        name: name[0].to_owned(),
        response_node: integer(place, 41, 51, "node of the response")?,
        response_direction: direction(51, 55)?,
        reference_node: integer(place, 66, 76, "node of the reference")?,
        reference_direction: direction(76, 80)?,
        motion,
        frequencies_hz: frequencies_hz.into_iter().map(|f| f * hertz).collect(),
        values: raw.into_iter().map(|value| value * size).collect(),
        units_stated: stated,
    };
    response.checked(body[6].number).map(Ok)
}

/// Motion per force, the size of its unit in SI, and true if the file states it.
fn unit(body: &[Line<'_>], units: Option<[f64; 2]>) -> Result<(Motion, f64, bool)> {
    let (numerator, line, moved) = axis(body, 8)?;
    let (denominator, below, by) = axis(body, 9)?;
    let motion = match numerator {
        8 => Some(Motion::Displacement),
        11 => Some(Motion::Velocity),
        12 => Some(Motion::Acceleration),
        0 | 1 => None,
        other => {
            let expected = "8, 11 or 12: displacement, velocity or acceleration";
            return Err(fault(line.number, "ordinate", other, expected));
        }
    };
    if !matches!(denominator, 0 | 1 | 9 | 13) {
        return Err(fault(
            below.number,
            "denominator",
            denominator,
            "9 or 13, a force",
        ));
    }
    // Some write the whole unit beside the ordinate, as mm/N.
    let whole = stated_unit(moved).and_then(response_unit);
    let written = match (whole, stated_unit(moved)) {
        (Some(_), _) => whole,
        (None, Some(unit)) => Some(motion_unit(unit).ok_or_else(|| {
            let expected =
                "m, cm, mm, um, in or ft, these by s or s^2, g, or one of these by N, kN or lbf";
            fault(line.number, "unit of the ordinate", unit, expected)
        })?),
        (None, None) => None,
    };
    let force =
        match stated_unit(by) {
            _ if whole.is_some() => Some(1.0),
            Some(unit) => Some(force_unit(unit).ok_or_else(|| {
                fault(below.number, "unit of the force", unit, "N, mN, kN or lbf")
            })?),
            None => None,
        };
    if let (Some(motion), Some((other, _))) = (motion, written)
        && motion != other
    {
        let expected = "the unit of the kind that the same line states";
        return Err(fault(line.number, "unit of the ordinate", moved, expected));
    }
    let Some(motion) = motion.or(written.map(|w| w.0)) else {
        let expected = "its kind (8, 11, 12) or its unit (m, m/s, m/s^2, mm, g, ...)";
        return Err(fault(
            line.number,
            "ordinate",
            "neither kind nor unit",
            expected,
        ));
    };
    Ok(match (written, force, units) {
        (Some((_, size)), Some(force), _) => (motion, size / force, true),
        (_, _, Some([length, force])) => (motion, force / length, true),
        // Half a unit is none.
        _ => (motion, 1.0, false),
    })
}

/// Frequencies and numbers of a function.
fn points(body: &[Line<'_>], form: &[f64]) -> Result<(Vec<f64>, Vec<Complex<f64>>)> {
    let line = body[6].number;
    let (complex, double) = match form[0] as i64 {
        2 => (false, false),
        4 => (false, true),
        5 => (true, false),
        6 => (true, true),
        other => {
            let expected = "2, 4, 5 or 6: real or complex, single or double";
            return Err(fault(line, "data type", other, expected));
        }
    };
    let even = match form[2] as i64 {
        0 => false,
        1 => true,
        other => return Err(fault(line, "spacing", other, "0 (uneven) or 1 (even)")),
    };
    if even && (form[4].is_nan() || form[4] <= 0.0) {
        return Err(fault(
            line,
            "step of the abscissa",
            form[4],
            "a positive one",
        ));
    }
    let each = usize::from(!even) + 1 + usize::from(complex);
    let width = if double && even { 20 } else { 13 };
    let mut all = Vec::new();
    for &Line { number, text } in &body[11..] {
        if text.trim().is_empty() {
            continue;
        }
        let read = numbers(text, width).or_else(|| mixed(text, double, even, complex));
        let Some(read) = read else {
            let shown: String = text.chars().take(60).collect();
            return Err(fault(
                number,
                "numbers of a function",
                shown,
                "numbers alone",
            ));
        };
        all.extend(read);
    }
    let wanted = form[1];
    if all.len() as f64 != wanted * each as f64 {
        return Err(fault(
            line,
            "number of points",
            format!("{wanted} in this line, {} numbers below", all.len()),
            &format!("{each} numbers for each point"),
        ));
    }
    let frequency = |k: usize, point: &[f64]| match even {
        true => form[3] + form[4] * k as f64,
        false => point[0],
    };
    let value = |point: &[f64]| {
        let from = usize::from(!even);
        Complex::new(point[from], if complex { point[from + 1] } else { 0.0 })
    };
    let chunks = || all.chunks_exact(each);
    Ok((
        chunks().enumerate().map(|(k, p)| frequency(k, p)).collect(),
        chunks().map(value).collect(),
    ))
}

/// Numbers that touch, in columns of two widths: abscissa 13, ordinates 20 wide.
fn mixed(text: &str, double: bool, even: bool, complex: bool) -> Option<Vec<f64>> {
    if !double || even || !text.is_ascii() {
        return None;
    }
    let widths: &[usize] = if complex { &[13, 20, 20] } else { &[13, 20] };
    let (mut at, mut all) = (0, Vec::new());
    for width in widths.iter().cycle() {
        if at >= text.trim_end().len() {
            return Some(all);
        }
        all.push(
            numbers(column(text, at, at + width), 20)?
                .first()
                .copied()?,
        );
        at += width;
    }
    None
}
