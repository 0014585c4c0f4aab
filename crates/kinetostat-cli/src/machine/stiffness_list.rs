//! A model's stiffnesses, one line each, for the head of a result.

use kinetostat::{
    Chain, MotionKind,
    model::{SpringBlock, SpringLaw},
};
use kinetostat_machining::number::{DIGITS, Rounding, significant};
use kinetostat_model::Model;
use nalgebra::DMatrix;

/// Upper limit of the sentences about stiffnesses; longer lists hide the model, which the files name.
const MOST: usize = 60;

/// The stiffnesses that a result was computed with, one sentence for each spring or link; what several
/// limbs share stands once.
pub(crate) fn stiffnesses(model: &Model) -> Vec<String> {
    let mut found: Vec<(String, Vec<String>)> = Vec::new();
    for limb in model.mechanism.limbs() {
        for text in of_chain(&limb.actual) {
            match found.iter_mut().find(|(known, _)| *known == text) {
                Some((_, limbs)) if limbs.contains(&limb.name) => {}
                Some((_, limbs)) => limbs.push(limb.name.clone()),
                None => found.push((text, vec![limb.name.clone()])),
            }
        }
    }
    let left = found.len().saturating_sub(MOST);
    let mut list: Vec<String> = found
        .into_iter()
        .take(MOST)
        .map(|(text, limbs)| format!("{}: {text}", limbs.join(", ")))
        .collect();
    if left > 0 {
        list.push(format!("and {left} more, in the model file"));
    }
    list
}

fn of_chain(chain: &Chain) -> Vec<String> {
    let mut out: Vec<String> = Vec::new();
    for spring in chain.springs() {
        let text = match &spring.segment {
            // The pieces of a link are springs that nobody wrote.
            Some(piece) => format!(
                "link '{}', {} mm, bending stiffness EI {} N m2 in its softer plane",
                piece.link,
                shown(1e3 * piece.link_length),
                shown(piece.bending_stiffness)
            ),
            None => format!("'{}' {}", spring.name, law(chain, spring)),
        };
        if !out.contains(&text) {
            out.push(text);
        }
    }
    out
}

fn law(chain: &Chain, spring: &SpringBlock) -> String {
    match &spring.law {
        SpringLaw::Linear(matrix) => diagonal(chain, spring, matrix),
        SpringLaw::Parallelogram(_) => "two parallel bars as one spring".to_owned(),
        SpringLaw::Bowing(_) => "a beam that shortens as it bends".to_owned(),
        _ => "a spring of six directions".to_owned(),
    }
}

fn diagonal(chain: &Chain, spring: &SpringBlock, matrix: &DMatrix<f64>) -> String {
    let entries: Vec<String> = (0..spring.len())
        .map(|i| {
            let kind = chain.coordinates().get(spring.first + i).map(|c| c.kind);
            let (factor, unit) = match kind {
                Some(MotionKind::Prismatic) => (1e-3, "N/mm"),
                _ => (1.0, "N m/rad"),
            };
            format!("{} {unit}", shown(factor * matrix[(i, i)]))
        })
        .collect();
    let coupled = (0..spring.len()).any(|i| (0..i).any(|j| matrix[(i, j)] != 0.0));
    match coupled {
        true => format!("{} (coupled; diagonal)", entries.join(", ")),
        false => entries.join(", "),
    }
}

/// Formats figures from 10 000 on with powers in steps of three, so that one list does not change its
/// notation at 10 million.
pub(crate) fn shown(value: f64) -> String {
    let digits = |value: f64| significant(value, DIGITS, Rounding::Nearest);
    match value.abs() {
        size if (1e4..999.5e3).contains(&size) => format!("{}e3", digits(1e-3 * value)),
        size if (999.5e3..1e7).contains(&size) => format!("{}e6", digits(1e-6 * value)),
        _ => digits(value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number of five digits or more is written by powers, or all the digits in the list are of one kind.
    #[test]
    fn stiffnesses_have_one_notation() {
        let said = [9_999.0, 10_000.0, 540_000.0, 999_700.0, 3_811_513.0, 90.8e6].map(shown);
        assert_eq!(
            said,
            ["9999", "10.0e3", "540e3", "1.00e6", "3.81e6", "90.8e6"]
        );
        for name in kinetostat_model::preset_names().iter().map(|p| p.name) {
            for text in stiffnesses(&Model::preset(name).unwrap()) {
                let long = |word: &str| word.len() > 4 && word.bytes().all(|b| b.is_ascii_digit());
                assert!(!text.split([' ', ',']).any(long), "{name}: {text}");
            }
        }
    }

    #[test]
    fn every_preset_states_its_stiffnesses() {
        for name in kinetostat_model::preset_names().iter().map(|p| p.name) {
            let model = Model::preset(name).unwrap();
            let list = stiffnesses(&model);
            let any = model
                .mechanism
                .limbs()
                .iter()
                .any(|l| !l.actual.springs().is_empty());
            assert_eq!(any, !list.is_empty(), "{name}");
            for text in list {
                assert!(
                    !text.contains("NaN") && !text.contains('?'),
                    "{name}: {text}"
                );
            }
        }
    }
}
