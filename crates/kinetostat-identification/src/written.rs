//! The model with what was identified, and its uncertainty as a file.

use kinetostat_model::{Model, NumberEdit};

use crate::error::IdentificationError;
use crate::geometry::DEVIATION;
use crate::identified::IdentifiedNumber;
use crate::result::Identification;

/// The model with the identified numbers, each with its source. Errors of the geometry are deviations behind the end of the file.
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
            // All of them, because only together they say where the tool is.
            None if n.number.starts_with(DEVIATION) => format!("identified from {source}"),
            None => return None,
        };
        Some(NumberEdit {
            path: n.number.clone(),
            value: n.identified?,
            source: Some(words),
        })
    };
    let edits = found.numbers.iter().filter_map(edit);
    let (errors, others): (Vec<_>, Vec<_>) = edits.partition(|e| e.path.starts_with(DEVIATION));
    let model = model.edited(&others)?;
    let (model, errors) = match model.document.deviation.is_empty() {
        true => {
            let added = deviations(&model, &errors);
            (model, added)
        }
        false => (model.edited(&errors)?, String::new()),
    };
    let text = format!(
        "{}{errors}{}",
        without_uncertainties(&model.text, found),
        uncertainties(found, source)
    );
    Ok(Model::from_toml(&text, &model.file)?)
}

/// The text without the tables of uncertainties that name an identified number: those of an earlier identification.
fn without_uncertainties(text: &str, found: &Identification) -> String {
    let own: Vec<String> = found
        .numbers
        .iter()
        .map(|n| format!("{:?}", n.number))
        .collect();
    let mut tables = vec![String::new()];
    for line in text.split_inclusive('\n') {
        if line.trim_start().starts_with('[') {
            tables.push(String::new());
        }
        if let Some(last) = tables.last_mut() {
            last.push_str(line);
        }
    }
    let is_old = |table: &String| {
        ["[[uncertain]]", "[[correlation]]"]
            .iter()
            .any(|head| table.trim_start().starts_with(head))
            && own.iter().any(|name| table.contains(name))
    };
    tables.retain(|table| !is_old(table));
    tables.concat()
}

/// Tables of deviations that a model without any gets at its end.
fn deviations(model: &Model, errors: &[NumberEdit]) -> String {
    // Component, key and place of a path, from its end.
    let step = |e: &NumberEdit, k: usize| e.path.rsplitn(3, '.').nth(k).map(str::to_owned);
    let mut out = String::new();
    for own in errors.chunk_by(|a, b| step(a, 2) == step(b, 2)) {
        let place = step(&own[0], 2).unwrap_or_default();
        let at = |limb: &str| {
            let rest = place.strip_prefix(DEVIATION)?.strip_prefix(limb)?;
            rest.strip_prefix('.').map(str::to_owned)
        };
        let limbs = model.document.limb.iter();
        let Some((limb, at)) = limbs.filter_map(|l| Some((&l.name, at(&l.name)?))).next() else {
            continue;
        };
        let keys = own.chunk_by(|a, b| step(a, 1) == step(b, 1)).map(|own| {
            let values: Vec<f64> = own.iter().map(|e| e.value).collect();
            format!("{} = {values:?}", step(&own[0], 1).unwrap_or_default())
        });
        out += &format!(
            "\n[[deviation]]\nlimb = {limb:?}\nat = {at:?}\nmoved_by = {{ {} }}\nsource = {:?}\n",
            keys.collect::<Vec<String>>().join(", "),
            own[0].source.as_deref().unwrap_or_default(),
        );
    }
    out
}

/// Relative standard deviation beyond which a normal distribution has machines with negative stiffness among thousands.
const WIDEST: f64 = 24.0;

/// The uncertainty of the identified numbers as tables of a model file, for `tolerance` and for bands of compensated programs.
fn uncertainties(found: &Identification, source: &str) -> String {
    let of_model = (found.numbers.iter().enumerate())
        .filter(|(_, n)| n.is_of_model && n.identified.is_some())
        .filter_map(|(i, n)| Some((i, n, n.deviation.zip(n.deviation_percent)?)));
    let (wide, known): (Vec<_>, Vec<_>) =
        of_model.partition(|(_, _, (_, percent))| *percent > WIDEST);
    let mut out = format!(
        "\n# Standard deviations and correlations of the numbers that were identified from {source}.\n"
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
    let missing = found
        .numbers
        .iter()
        .filter(|n| n.is_of_model && n.deviation.is_none());
    for number in missing.filter(|n| !n.is_geometry()) {
        out += &format!(
            "\n# {}: no reading tells how well it is known, so it does not vary here.\n",
            number.number
        );
    }
    if found.numbers.iter().any(IdentifiedNumber::is_geometry) {
        out += "\n# Errors of the geometry are known in combinations only, so they do not vary here.\n";
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
