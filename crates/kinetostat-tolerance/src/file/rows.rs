//! Rows of the file: one uncertain number each, and pairs of them.

use std::ops::Range;

use kinetostat_model::{Model, ParameterKind};
use serde_spanned::Spanned;

use crate::distribution::Distribution;
use crate::file::load::Load;
use crate::file::source::Source;
use crate::file::written::{Pair, Reader, Row};
use crate::uncertain::Uncertain;

impl Reader<'_> {
    pub(super) fn row(
        &mut self,
        row: &Spanned<Row>,
        model: &Model,
        load: Load<'_>,
    ) -> Option<(Uncertain, Source)> {
        let (span, own) = (row.span(), row.get_ref());
        let (name, value, unit, kind, source) = match (&own.parameter, &own.load) {
            (Some(path), None) => {
                let name = path.get_ref();
                match model.parametric(&[name]) {
                    Ok(found) => {
                        let p = found.parameters()[0].clone();
                        (
                            name.clone(),
                            p.value,
                            p.unit,
                            Some(p.kind),
                            Source::Parameter(name.clone()),
                        )
                    }
                    Err(error) => {
                        let words = error.problems().first();
                        let (message, help) = words.map_or((String::new(), String::new()), |p| {
                            (p.message.clone(), p.help.clone())
                        });
                        self.refuse(path.span(), message, help);
                        return None;
                    }
                }
            }
            (None, Some(word)) => {
                let words = load.words();
                let Some(at) = words.iter().position(|l| l == word.get_ref()) else {
                    let near = words
                        .iter()
                        .min_by_key(|l| strsim::damerau_levenshtein(l, word.get_ref()));
                    let near = near.copied().unwrap_or_default();
                    let (here, there) = match load {
                        Load::Stated(_) => ("", "along a program it may be of a part of its force"),
                        Load::AlongProgram => (
                            " along a program",
                            "its force differs from place to place, so that only factors are known",
                        ),
                    };
                    let help = format!(
                        "did you mean '{near}'? There are {}; {there}",
                        words.join(", ")
                    );
                    self.refuse(
                        word.span(),
                        format!("there is no load '{}'{here}", word.get_ref()),
                        help,
                    );
                    return None;
                };
                let name = format!("load {}", words[at]);
                let (value, unit, source) = load.part(at);
                let factor = !matches!(source, Source::Load(_));
                let kind = factor.then_some(ParameterKind::Factor);
                (name, value, unit, kind, source)
            }
            _ => {
                self.refuse(
                    span,
                    "name one parameter of the model, or one load",
                    "parameter = \"chain. ... .length_mm\", or load = \"force_n.x\"",
                );
                return None;
            }
        };
        let distribution = self.distribution(own, span, value)?;
        let place = [
            &own.normal,
            &own.normal_percent,
            &own.uniform,
            &own.uniform_percent,
            &own.triangular,
            &own.triangular_percent,
        ];
        let place = place
            .into_iter()
            .flatten()
            .next()
            .map_or(0..0, Spanned::span);
        if value > 0.0 && kind.is_some_and(is_positive) && value + distribution.least() <= 0.0 {
            let word = kind.map_or("number", ParameterKind::word);
            self.refuse(
                place,
                format!("'{name}' is {value} {unit}; with this spread some machines have a {word} of {:.6} or less", value + distribution.least()),
                "four standard deviations of a normal distribution, or the half width of another, must be less than the value",
            );
            return None;
        }
        let uncertain = Uncertain {
            name,
            value,
            unit: unit.to_owned(),
            distribution,
        };
        Some((uncertain, source))
    }

    fn distribution(&mut self, row: &Row, span: Range<usize>, value: f64) -> Option<Distribution> {
        type Made = fn(f64) -> Distribution;
        let all: [(&Option<Spanned<f64>>, Made, bool); 6] = [
            (&row.normal, Distribution::Normal, false),
            (&row.normal_percent, Distribution::Normal, true),
            (&row.uniform, Distribution::Uniform, false),
            (&row.uniform_percent, Distribution::Uniform, true),
            (&row.triangular, Distribution::Triangular, false),
            (&row.triangular_percent, Distribution::Triangular, true),
        ];
        let given: Vec<_> = all
            .iter()
            .filter_map(|(x, made, percent)| Some((x.as_ref()?, made, *percent)))
            .collect();
        let [(spread, made, percent)] = given[..] else {
            self.refuse(
                span,
                format!("{} spreads are given; one is needed", given.len()),
                "normal (standard deviation), uniform or triangular (half width) in the parameter's own unit, or the same with _percent",
            );
            return None;
        };
        let number = *spread.get_ref();
        if !number.is_finite() || number < 0.0 {
            self.refuse(
                spread.span(),
                format!("a spread of {number}: it cannot be negative"),
                "state a positive standard deviation or half width",
            );
            return None;
        }
        if percent && value == 0.0 {
            self.refuse(
                spread.span(),
                "a percentage of a number that is zero is zero",
                "state the spread in the parameter's own unit",
            );
            return None;
        }
        Some(made(if percent {
            0.01 * number * value.abs()
        } else {
            number
        }))
    }

    pub(super) fn pairs(
        &mut self,
        written: &[Spanned<Pair>],
        each: &[Uncertain],
    ) -> Vec<(usize, usize, f64)> {
        let mut out: Vec<(usize, usize, f64)> = Vec::new();
        for pair in written {
            let own = pair.get_ref();
            let places: Vec<Option<usize>> = own
                .between
                .get_ref()
                .iter()
                .map(|name| {
                    let found = each
                        .iter()
                        .position(|u| u.name == *name || u.name == format!("load {name}"));
                    if found.is_none() {
                        let near = each
                            .iter()
                            .min_by_key(|u| strsim::damerau_levenshtein(&u.name, name));
                        let near =
                            near.map_or(String::new(), |u| format!("did you mean '{}'?", u.name));
                        self.refuse(
                            own.between.span(),
                            format!("'{name}' is not among the uncertain numbers"),
                            near,
                        );
                    }
                    found
                })
                .collect();
            let coefficient = *own.coefficient.get_ref();
            if !(-1.0..=1.0).contains(&coefficient) {
                self.refuse(
                    own.coefficient.span(),
                    format!("a correlation of {coefficient}: they lie between -1 and 1"),
                    "",
                );
            }
            let [Some(i), Some(j)] = places[..] else {
                continue;
            };
            let known = |(a, b, _): &(usize, usize, f64)| (*a, *b) == (i, j) || (*a, *b) == (j, i);
            if i == j || out.iter().any(known) {
                self.refuse(
                    own.between.span(),
                    "this pair is one number twice, or is given twice",
                    "keep one of them",
                );
                continue;
            }
            out.push((i, j, coefficient));
        }
        out
    }
}

/// What no machine has negative or zero.
fn is_positive(kind: ParameterKind) -> bool {
    use ParameterKind as K;
    matches!(
        kind,
        K::Stiffness
            | K::RotationalStiffness
            | K::Elasticity
            | K::Area
            | K::SecondMoment
            | K::Rigidity
            | K::Mass
            | K::Inertia
            | K::Factor
    )
}
