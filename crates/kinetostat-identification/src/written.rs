//! The model with what was identified, and its uncertainty as a file.

use kinetostat_model::{Model, NumberEdit};

use crate::error::IdentificationError;
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
const WIDEST: f64 = 24.0;

/// The uncertainty of the identified numbers as a file for `tolerance` and for bands of compensated programs.
#[must_use]
pub fn uncertainty_file(found: &Identification, source: &str) -> String {
    let of_model = (found.numbers.iter().enumerate())
        .filter(|(_, n)| n.is_of_model && n.identified.is_some())
        .filter_map(|(i, n)| Some((i, n, n.deviation.zip(n.deviation_percent)?)));
    let (wide, known): (Vec<_>, Vec<_>) =
        of_model.partition(|(_, _, (_, percent))| *percent > WIDEST);
    let mut out = format!(
        "# Standard deviations and correlations of the numbers that were identified from {source}.\nschema = 1\n"
    );
    for (_, number, (_, percent)) in wide {
        out += &format!(
            "# {} is known to {percent:.0} % only: no normal distribution of a stiffness is that wide, so it does not vary here.\n",
            number.number
        );
    }
    for (_, number, (deviation, _)) in &known {
        out += &format!(
            "\n[[uncertain]]\nparameter = {:?}\nnormal = {deviation:e} # {}\n",
            number.number, number.unit
        );
    }
    for (k, (i, one, (of_one, _))) in known.iter().enumerate() {
        for (j, other, (of_other, _)) in &known[..k] {
            let coefficient = found.covariance[*i][*j] / (of_one * of_other);
            if coefficient.abs() > 1e-3 {
                let (one, other) = (&other.number, &one.number);
                out += &format!(
                    "\n[[correlation]]\nbetween = [{one:?}, {other:?}]\ncoefficient = {coefficient:.6}\n"
                );
            }
        }
    }
    out
}
