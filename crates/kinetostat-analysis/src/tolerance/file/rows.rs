//! Rows of the file: one uncertain number each, and pairs of them.

use std::ops::Range;

use kinetostat::number::short;
use kinetostat_machining::Limits;
use kinetostat_model::{Model, ParameterKind};
use serde_spanned::Spanned;

use crate::tolerance::draws::Distribution;
use crate::tolerance::file::written::{Load, Pair, Reader, Row, Source};
use crate::tolerance::uncertain::Uncertain;

/// Largest spread of a length (m) and of an angle (rad): machines are built to micrometres or to tenths of a millimetre. Larger errors
/// are measured and put into the model.
const LARGEST_LENGTH: f64 = 3e-3;
const LARGEST_ANGLE: f64 = 2.0 * std::f64::consts::PI / 180.0;

/// A number of a chain, a section or a stiffness that several limbs share.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SharedNumber {
    /// Path of the number.
    pub name: String,
    /// Limbs that have it.
    pub limbs: Vec<String>,
}

impl SharedNumber {
    /// States that the limbs move together, and the other way.
    #[must_use]
    pub fn description(&self) -> String {
        format!(
            "'{}' is one number of {} limbs ({}) and scatters in all of them together: write each = true in its table where every limb scatters by itself",
            self.name,
            self.limbs.len(),
            self.limbs.join(", ")
        )
    }
}

impl Reader<'_> {
    /// The rows, those with `each` once for every limb; numbers without it that several limbs share are added to `shared`.
    pub(super) fn of_each_limb(
        &mut self,
        rows: &[Spanned<Row>],
        model: &Model,
        shared: &mut Vec<SharedNumber>,
    ) -> Vec<Spanned<Row>> {
        let mut all = Vec::new();
        for row in rows {
            let path = row.get_ref().parameter.as_ref();
            let own = path.map_or_else(Vec::new, |path| own_paths(model, path.get_ref()));
            let each = row.get_ref().each.as_ref();
            match (path, each.is_some_and(|each| *each.get_ref())) {
                (Some(path), true) if own.len() > 1 => {
                    all.extend(own.into_iter().map(|(_, own)| {
                        let mut of_limb = row.get_ref().clone();
                        of_limb.parameter = Some(Spanned::new(path.span(), own));
                        Spanned::new(row.span(), of_limb)
                    }));
                    continue;
                }
                (_, true) => self.refuse(
                    each.map_or(0..0, Spanned::span),
                    "'each' is for a number that several limbs share",
                    "name a number of such a chain, section or stiffness, or leave 'each' out",
                ),
                (Some(path), false) if own.len() > 1 => shared.push(SharedNumber {
                    name: path.get_ref().clone(),
                    limbs: own.into_iter().map(|(limb, _)| limb).collect(),
                }),
                _ => {}
            }
            all.push(row.clone());
        }
        all
    }

    pub(super) fn row(
        &mut self,
        row: &Spanned<Row>,
        model: &Model,
        load: Load<'_>,
    ) -> Option<(Uncertain, Source)> {
        let (span, own) = (row.span(), row.get_ref());
        let mut in_si = 1.0;
        let (name, value, unit, kind, source) = match (&own.parameter, &own.load) {
            (Some(path), None) => {
                let name = path.get_ref();
                match model.parametric(&[name]) {
                    Ok(found) => {
                        let p = found.parameters()[0].clone();
                        in_si = p.in_si;
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
        let most = match (kind, load) {
            (Some(ParameterKind::Length), _) => Some((
                LARGEST_LENGTH / in_si,
                "machines are built to 0.001 to 1 mm",
            )),
            (Some(ParameterKind::Angle), _) => Some((
                LARGEST_ANGLE / in_si,
                "machines are built to 0.001 to 0.5 deg",
            )),
            (Some(ParameterKind::Force | ParameterKind::Moment), _) if value != 0.0 => {
                Some((value.abs(), "a preload keeps its sign"))
            }
            (None, Load::Stated(wrench)) if source_is_force(&source) => Some((
                largest_of(wrench.force().norm(), Limits::default().force_n),
                "a component scatters by less than the whole force",
            )),
            (None, Load::Stated(wrench)) => Some((
                largest_of(wrench.moment().norm(), Limits::default().moment_n_m),
                "a component scatters by less than the whole moment",
            )),
            _ => None,
        };
        let spread = distribution.spread();
        if let Some((most, usual)) = most.filter(|(most, _)| spread > *most) {
            self.refuse(
                place,
                format!(
                    "'{name}' is {} {unit}; a spread of {} {unit} is more than the {} {unit} that are allowed",
                    short(value),
                    short(spread),
                    short(most)
                ),
                format!("{usual}: check the unit, or the percentage"),
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
        if !number.is_finite() || number <= 0.0 {
            self.refuse(
                spread.span(),
                format!("a spread of {number}: a number above 0 is needed"),
                "state a positive standard deviation or half width, or leave out the table of a number that is known exactly",
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

/// The number of every limb that has it, by name of the limb and path; of a number of one limb at most one.
fn own_paths(model: &Model, path: &str) -> Vec<(String, String)> {
    let limbs = model.document.limb.iter();
    let own = limbs.filter_map(|limb| {
        let of_chain = path.strip_prefix(&format!("chain.{}.", limb.chain));
        let is_table = path.starts_with("section.") || path.starts_with("stiffness.");
        let rest = of_chain.or(is_table.then_some(path))?;
        Some((limb.name.clone(), format!("limb.{}.{rest}", limb.name)))
    });
    own.filter(|(_, own)| model.parametric(&[own.as_str()]).is_ok())
        .collect()
}

fn source_is_force(source: &Source) -> bool {
    matches!(source, Source::Load(component) if *component < 3)
}

/// A component may scatter by the size of the whole; of no load at all by what is allowed on a tool.
fn largest_of(whole: f64, limit: f64) -> f64 {
    match whole > 0.0 {
        true => whole,
        false => limit,
    }
}

/// True if a number of this kind must be positive.
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
