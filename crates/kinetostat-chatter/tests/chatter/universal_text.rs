//! Universal files written: data set 58 in text, complex numbers of double precision.

use std::fmt::Write as _;

use kinetostat_chatter::{MeasuredResponse, Motion};

/// Frequencies that differ from even spacing by less than this share of a step are even.
const EVEN: f64 = 1e-9;

/// Responses as a universal file, SI units, data sets 164 and 58 (function type 4, complex, double precision).
///
/// `read_universal` reads it back to twelve decimals, and so do other programs; evenly spaced frequencies are written as such.
pub fn write_universal(responses: &[MeasuredResponse]) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{:>6}\n{:>6}", -1, 164);
    let _ = writeln!(text, "{:>10}{:<20}{:>10}", 1, "SI: Meter (newton)", 2);
    let one = number(1.0, 17);
    let _ = writeln!(text, "{one:>25}{one:>25}{one:>25}");
    let _ = writeln!(text, "{:>25}\n{:>6}", number(273.15, 17), -1);
    for response in responses {
        write(&mut text, response);
    }
    text
}

/// A number with so many decimals and an exponent of two digits and its sign, as the format has it.
fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$E}");
    match text.split_once('E') {
        Some((mantissa, exponent)) => {
            let (sign, digits) = match exponent.strip_prefix('-') {
                Some(digits) => ('-', digits),
                None => ('+', exponent),
            };
            format!("{mantissa}E{sign}{digits:0>2}")
        }
        None => text,
    }
}

/// A text in a column of 80: one line, no control characters.
fn plain(text: &str) -> String {
    let kept = text
        .chars()
        .map(|c| if c.is_ascii_graphic() { c } else { ' ' });
    let kept: String = kept.take(80).collect();
    match kept.trim() {
        "" => "NONE".into(),
        kept => kept.to_owned(),
    }
}

fn write(text: &mut String, response: &MeasuredResponse) {
    let (kind, label, unit) = match response.motion {
        Motion::Displacement => (8, "Displacement", "m"),
        Motion::Velocity => (11, "Velocity", "m/s"),
        Motion::Acceleration => (12, "Acceleration", "m/s^2"),
    };
    let _ = writeln!(text, "{:>6}\n{:>6}", -1, 58);
    let _ = writeln!(text, "{}", plain(&response.name));
    for _ in 0..4 {
        text.push_str("NONE\n");
    }
    let _ = writeln!(
        text,
        "{:>5}{:>10}{:>5}{:>10} {:<10}{:>10}{:>4} {:<10}{:>10}{:>4}",
        4,
        0,
        0,
        0,
        "NONE",
        response.response_node,
        response.response_direction,
        "NONE",
        response.reference_node,
        response.reference_direction
    );
    let frequencies = &response.frequencies_hz;
    let step = even_step(frequencies);
    let _ = writeln!(
        text,
        "{:>10}{:>10}{:>10}{:>13}{:>13}{:>13}",
        6,
        frequencies.len(),
        i32::from(step.is_some()),
        number(frequencies.first().copied().unwrap_or_default(), 5),
        number(step.unwrap_or_default(), 5),
        number(0.0, 5)
    );
    let mut axis = |kind: i32, exponents: [i32; 3], label: &str, unit: &str| {
        let [length, force, temperature] = exponents;
        let _ = writeln!(
            text,
            "{kind:>10}{length:>5}{force:>5}{temperature:>5} {label:<20} {unit:<20}"
        );
    };
    axis(18, [0, 0, 0], "Frequency", "Hz");
    axis(kind, [1, 0, 0], label, unit);
    axis(9, [0, 1, 0], "Force", "N");
    axis(0, [0, 0, 0], "NONE", "NONE");
    let mut line = String::new();
    for (k, (frequency, value)) in frequencies.iter().zip(&response.values).enumerate() {
        if step.is_none() {
            let _ = write!(line, "{:>13}", number(*frequency, 5));
        }
        let (re, im) = (number(value.re, 11), number(value.im, 11));
        let _ = write!(line, "{re:>20}{im:>20}");
        if step.is_none() || k % 2 == 1 || k + 1 == frequencies.len() {
            let _ = writeln!(text, "{line}");
            line.clear();
        }
    }
    let _ = writeln!(text, "{:>6}", -1);
}

/// The step of evenly spaced frequencies, where first and step keep what they are in six digits.
fn even_step(frequencies: &[f64]) -> Option<f64> {
    let [first, second, ..] = frequencies else {
        return None;
    };
    let step = second - first;
    let written = |value: f64| number(value, 5).parse::<f64>().unwrap_or(f64::NAN);
    let (start, spacing) = (written(*first), written(step));
    let fits = |(k, frequency): (usize, &f64)| {
        (start + spacing * k as f64 - frequency).abs() <= EVEN * step * (1.0 + k as f64)
    };
    frequencies.iter().enumerate().all(fits).then_some(step)
}
