//! The file of uncertainties: TOML, refused by name and line.

use std::ops::Range;

use kinetostat::Wrench;
use kinetostat_model::{Model, ModelError, ParameterKind, Problem, Severity};
use serde::Deserialize;
use serde_spanned::Spanned;

use crate::distribution::Distribution;
use crate::uncertain::{Uncertain, Uncertainties};

/// What an uncertain number is of.
#[derive(Clone, Debug, PartialEq)]
pub enum Source {
    /// A number of the model file, by its path.
    Parameter(String),
    /// A component of the load on the tool: force (N), then moment (N m).
    Load(usize),
    /// A factor on the whole load, 1 in the drawing: how far all cutting coefficients may be off together.
    LoadFactor,
}

/// What a file of uncertainties says.
#[derive(Clone, Debug, PartialEq)]
pub struct UncertaintyFile {
    /// The numbers and their distributions.
    pub uncertainties: Uncertainties,
    /// What each is of.
    pub sources: Vec<Source>,
}

/// Names of the load's components, and of its factor.
const LOADS: [&str; 7] = [
    "force_n.x",
    "force_n.y",
    "force_n.z",
    "moment_n_m.x",
    "moment_n_m.y",
    "moment_n_m.z",
    "factor",
];

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    schema: Spanned<u32>,
    #[serde(default)]
    uncertain: Vec<Spanned<Row>>,
    #[serde(default)]
    correlation: Vec<Spanned<Pair>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    parameter: Option<Spanned<String>>,
    load: Option<Spanned<String>>,
    normal: Option<Spanned<f64>>,
    normal_percent: Option<Spanned<f64>>,
    uniform: Option<Spanned<f64>>,
    uniform_percent: Option<Spanned<f64>>,
    triangular: Option<Spanned<f64>>,
    triangular_percent: Option<Spanned<f64>>,
    #[serde(default, rename = "source")]
    _source: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Pair {
    between: Spanned<[String; 2]>,
    coefficient: Spanned<f64>,
}

/// The text with its name: where problems are told.
struct Reader<'a> {
    text: &'a str,
    file: &'a str,
    problems: Vec<Problem>,
}

impl Reader<'_> {
    fn refuse(&mut self, span: Range<usize>, message: impl Into<String>, help: impl Into<String>) {
        let words = [message.into(), help.into()];
        let problem = Problem::found(Severity::Error, self.file, self.text, span, "", words);
        self.problems.push(problem);
    }
}

impl UncertaintyFile {
    /// Reads the uncertainties of a model's numbers and of the load on its tool; `file` names the text in messages.
    ///
    /// # Errors
    /// Every fault with its line: an unknown parameter (with the nearest that exist), a negative spread, one that makes a stiffness
    /// negative, correlations that contradict each other.
    pub fn read(text: &str, file: &str, model: &Model, load: &Wrench) -> Result<Self, ModelError> {
        let mut reader = Reader {
            text,
            file,
            problems: Vec::new(),
        };
        let written: Written = match toml::from_str(text) {
            Ok(written) => written,
            Err(error) => {
                let span = error.span().unwrap_or(0..0);
                reader.refuse(
                    span,
                    error.message(),
                    "see `kinetostat tolerance --help` for what such a file says",
                );
                return Err(ModelError::new(reader.problems));
            }
        };
        if *written.schema.get_ref() != 1 {
            reader.refuse(
                written.schema.span(),
                "this version reads schema 1",
                "write schema = 1",
            );
        }
        if written.uncertain.is_empty() {
            reader.refuse(
                0..0,
                "nothing is uncertain",
                "add a table [[uncertain]] with a parameter and its spread",
            );
        }
        let mut each: Vec<Uncertain> = Vec::new();
        let mut sources = Vec::new();
        for row in &written.uncertain {
            let Some((uncertain, source)) = reader.row(row, model, load) else {
                continue;
            };
            if each.iter().any(|u| u.name == uncertain.name) {
                reader.refuse(
                    row.span(),
                    format!("'{}' is given twice", uncertain.name),
                    "keep one of them",
                );
            }
            each.push(uncertain);
            sources.push(source);
        }
        let pairs = reader.pairs(&written.correlation, &each);
        if !reader.problems.is_empty() {
            return Err(ModelError::new(reader.problems));
        }
        match Uncertainties::correlated(each, &pairs) {
            Ok(uncertainties) => Ok(Self {
                uncertainties,
                sources,
            }),
            Err(contradiction) => {
                let first = written.correlation.first();
                let span = first.map_or(0..0, |p| p.get_ref().coefficient.span());
                reader.refuse(
                    span,
                    contradiction.to_string(),
                    "of three numbers, two that both go with the third go with each other: make the coefficients smaller, or state the missing ones",
                );
                Err(ModelError::new(reader.problems))
            }
        }
    }
}

impl Reader<'_> {
    fn row(
        &mut self,
        row: &Spanned<Row>,
        model: &Model,
        load: &Wrench,
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
                let Some(at) = LOADS.iter().position(|l| l == word.get_ref()) else {
                    let near = LOADS
                        .iter()
                        .min_by_key(|l| strsim::damerau_levenshtein(l, word.get_ref()));
                    let near = near.copied().unwrap_or_default();
                    let help = format!("did you mean '{near}'? There are {}", LOADS.join(", "));
                    self.refuse(
                        word.span(),
                        format!("there is no load '{}'", word.get_ref()),
                        help,
                    );
                    return None;
                };
                let name = format!("load {}", LOADS[at]);
                match at {
                    6 => (
                        name,
                        1.0,
                        "",
                        Some(ParameterKind::Factor),
                        Source::LoadFactor,
                    ),
                    at => (
                        name,
                        load.0[at],
                        if at < 3 { "N" } else { "N m" },
                        None,
                        Source::Load(at),
                    ),
                }
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

    fn pairs(&mut self, written: &[Spanned<Pair>], each: &[Uncertain]) -> Vec<(usize, usize, f64)> {
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
