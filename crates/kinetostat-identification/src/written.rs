//! The model with what was identified, and its uncertainty as a file.

use kinetostat_model::{Model, NumberEdit};

use crate::error::IdentificationError;
use crate::identifiability::Knowledge;
use crate::identified::IdentifiedNumber;
use crate::result::Identification;

/// The model with the identified numbers, each with its source.
///
/// # Errors
/// Numbers with which the model would be refused.
pub fn identified_model(
    model: &Model,
    found: &Identification,
    source: &str,
) -> Result<Model, IdentificationError> {
    let edit = |n: &IdentifiedNumber| {
        if !n.is_of_model {
            return None;
        }
        let words = match n.deviation_percent {
            Some(percent) => format!("identified from {source}, standard deviation {percent:.2} %"),
            None if n.at_bound => format!("identified from {source}: not told from rigid"),
            None => return None,
        };
        Some(NumberEdit {
            path: n.number.clone(),
            value: n.identified?,
            source: Some(words),
        })
    };
    let edits: Vec<NumberEdit> = found.numbers.iter().filter_map(edit).collect();
    Ok(model.edited(&edits)?)
}

/// Relative standard deviation beyond which a normal distribution has machines with negative stiffness among thousands.
const WIDEST: f64 = 0.24;

/// The uncertainty of the identified numbers as a file for `tolerance` and for bands of compensated programs.
#[must_use]
pub fn uncertainty_file(found: &Identification, source: &str) -> String {
    let is_wide = |i: usize| found.relative_covariance[i][i].max(0.0).sqrt() > WIDEST;
    let seen: Vec<usize> = (0..found.numbers.len())
        .filter(|i| {
            found.numbers[*i].is_of_model
                && found.numbers[*i].knowledge != Knowledge::Unseen
                && found.numbers[*i].identified.is_some()
        })
        .collect();
    let (wide, known): (Vec<usize>, Vec<usize>) = seen.into_iter().partition(|i| is_wide(*i));
    let mut out = format!(
        "# Standard deviations and correlations of the numbers that were identified from {source}.\nschema = 1\n"
    );
    for i in wide {
        let percent = 100.0 * found.relative_covariance[i][i].sqrt();
        out += &format!(
            "# {} is known to {percent:.0} % only: no normal distribution of a stiffness is that wide, so it does not vary here.\n",
            found.numbers[i].number
        );
    }
    for i in &known {
        let number = &found.numbers[*i];
        let deviation = number.identified.unwrap_or(0.0).abs()
            * found.relative_covariance[*i][*i].max(0.0).sqrt();
        out += &format!(
            "\n[[uncertain]]\nparameter = {:?}\nnormal = {deviation:e} # {}\n",
            number.number, number.unit
        );
    }
    for (k, i) in known.iter().enumerate() {
        for j in &known[..k] {
            let root =
                (found.relative_covariance[*i][*i] * found.relative_covariance[*j][*j]).sqrt();
            let coefficient = found.relative_covariance[*i][*j] / root;
            if coefficient.abs() > 1e-3 {
                let (one, other) = (&found.numbers[*j].number, &found.numbers[*i].number);
                out += &format!(
                    "\n[[correlation]]\nbetween = [{one:?}, {other:?}]\ncoefficient = {coefficient:.6}\n"
                );
            }
        }
    }
    out
}
