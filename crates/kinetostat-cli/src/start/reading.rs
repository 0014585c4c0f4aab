//! Answers as text: numbers, places, what cuts.

use clap::ValueEnum;
use kinetostat_cutting::Materials;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_formats::Language;

use crate::job::tool_mass::MASSES_KG;
use crate::place::orientation;
use crate::ui::failure::{Answer, Failing, Failure};
use crate::ui::numbers::short;

/// Answer that leaves something out.
pub(super) const NONE: &str = "none";

/// Position in mm and, if it was given, orientation as a table of a job states it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stated {
    pub(super) position_mm: [f64; 3],
    /// Convention and its numbers.
    pub(super) orientation: Option<(String, Vec<f64>)>,
}

/// What cuts, or the force of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cut {
    /// To the right of the feed, along it, along z of the part, N.
    Force([f64; 3]),
    Material(String),
    None,
}

/// Where the tool meets the material.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Engaged {
    /// Two corners of a block, program coordinates, mm.
    Block([f64; 6]),
    /// Width and depth everywhere, mm, and the side of the feed on which the part is.
    Everywhere([f64; 2], &'static str),
}

impl Stated {
    /// Position and orientation: three numbers, and behind them none, the angles of the robot's controller, a quaternion as ABB
    /// writes it, or numbers with the name of their convention.
    pub(super) fn read(text: &str, language: Option<Language>) -> Answer<Self> {
        let (position, named) = match text.split_once('=') {
            Some((before, values)) => {
                let (position, name) = before
                    .trim()
                    .rsplit_once([' ', ','])
                    .ok_or_else(|| wrong(POSE))?;
                (
                    position,
                    Some((name.trim().to_owned(), all_numbers(values)?)),
                )
            }
            None => (text, None),
        };
        let all = all_numbers(position)?;
        let Some((&[x, y, z], rest)) = all.split_first_chunk::<3>() else {
            return Err(wrong(POSE));
        };
        let orientation = match (rest.len(), named) {
            (0, named) => named,
            (4, None) => Some(("quaternion_wxyz".to_owned(), rest.to_vec())),
            (3, None) => match language.and_then(angles_of) {
                Some(name) => Some((name.to_owned(), rest.to_vec())),
                None => {
                    return Err(wrong(
                        "three angles mean a dozen different rotations: name them, as in 1800 0 900 a_b_c_kuka_deg=90,0,0",
                    ));
                }
            },
            _ => return Err(wrong(POSE)),
        };
        if let Some((name, values)) = &orientation {
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            orientation::option("the orientation", &format!("{name}={}", values.join(",")))?;
        }
        Ok(Self {
            position_mm: [x, y, z],
            orientation,
        })
    }
}

const POSE: &str = "X Y Z in mm are needed, and an orientation behind them if it is not parallel: A B C of KUKA, W P R of FANUC, four numbers of a quaternion (w first), or CONVENTION=numbers";

/// The angles of a controller by the name of their convention.
fn angles_of(language: Language) -> Option<&'static str> {
    match language {
        Language::Krl => Some("a_b_c_kuka_deg"),
        Language::FanucLs => Some("w_p_r_fanuc_deg"),
        _ => None,
    }
}

pub(super) fn wrong(words: &str) -> Failure {
    ErrorCode::Value.failure(words)
}

/// Word of an option for a value.
pub(super) fn word_of(value: impl ValueEnum) -> String {
    let word = value.to_possible_value();
    word.map_or_else(String::new, |word| word.get_name().to_owned())
}

/// Words of an option with their values.
pub(super) fn words_of<T: ValueEnum>() -> Vec<(String, T)> {
    let all = T::value_variants().iter();
    all.map(|value| (word_of(value.clone()), value.clone()))
        .collect()
}

pub(super) fn one_of<T: Clone>(text: &str, words: &[(impl AsRef<str>, T)]) -> Answer<T> {
    let lower = text.to_lowercase();
    let found = words.iter().find(|(word, _)| word.as_ref() == lower);
    let names: Vec<&str> = words.iter().map(|(word, _)| word.as_ref()).collect();
    found
        .map(|(_, value)| value.clone())
        .ok_or_else(|| wrong(&format!("'{text}' is none of: {}", names.join(", "))))
}

fn all_numbers(text: &str) -> Answer<Vec<f64>> {
    // `1800,5 100,0 0,0` may be three numbers or six.
    let inside = |word: &str| word.trim_matches(',').contains(',');
    if text.split_whitespace().nth(1).is_some() && text.split_whitespace().any(inside) {
        return Err(wrong("write decimals with a point, as in 1800.5 100 0"));
    }
    let words = text
        .split([' ', ',', ';', '\t'])
        .filter(|word| !word.is_empty());
    words
        .map(|word| {
            let number = word.parse::<f64>().ok().filter(|x| x.abs() <= 1e9);
            number.ok_or_else(|| wrong(&format!("'{word}' is no number; write one as in -12.5")))
        })
        .collect()
}

pub(super) fn numbers<const N: usize>(text: &str) -> Answer<[f64; N]> {
    let all = all_numbers(text)?;
    let count = all.len();
    all.try_into()
        .map_err(|_| wrong(&format!("{N} numbers are needed, {count} are given")))
}

pub(super) fn above_zero(text: &str) -> Answer<f64> {
    let [value] = numbers(text)?;
    match value > 0.0 {
        true => Ok(value),
        false => Err(wrong(&format!("{} is not above 0", short(value)))),
    }
}

/// Numbers of two frames at a controller.
pub(super) fn frame_numbers(text: &str) -> Answer<[u32; 2]> {
    let whole = |x: f64| (x.fract() == 0.0 && (0.0..=255.0).contains(&x)).then_some(x as u32);
    let [base, tool] = numbers::<2>(text)?.map(whole);
    let pair = base.zip(tool).map(Into::into);
    pair.ok_or_else(|| wrong("two whole numbers from 0 to 255 are needed"))
}

/// Statements of a controller, divided by `|`.
pub(super) fn statements(text: &str) -> Vec<String> {
    match text {
        NONE => Vec::new(),
        _ => text.split('|').map(|own| own.trim().to_owned()).collect(),
    }
}

/// Mass on the flange, kg; 0 if nothing is to be added.
pub(super) fn mass(text: &str) -> Answer<f64> {
    let [mass] = numbers(text)?;
    match mass == 0.0 || MASSES_KG.contains(&mass) {
        true => Ok(mass),
        false => Err(wrong("a mass from 0.001 to 5000 kg is needed, or 0")),
    }
}

/// Diameter in mm, teeth, helix in deg.
pub(super) fn cutter(text: &str) -> Answer<[f64; 3]> {
    let cutter @ [diameter, teeth, helix] = numbers(text)?;
    let is_whole = teeth >= 1.0 && teeth.fract() == 0.0;
    match diameter > 0.0 && is_whole && (0.0..90.0).contains(&helix) {
        true => Ok(cutter),
        false => Err(wrong(
            "a diameter above 0 mm, a whole number of teeth and a helix from 0 to 90 deg are needed",
        )),
    }
}

pub(super) fn cut(text: &str) -> Answer<Cut> {
    if text.eq_ignore_ascii_case(NONE) {
        return Ok(Cut::None);
    }
    if text.starts_with(|c: char| c.is_ascii_digit() || "-+.".contains(c))
        && all_numbers(text).is_ok()
    {
        return Ok(Cut::Force(numbers(text)?));
    }
    let materials = Materials::library();
    let material = materials
        .find(text)
        .map_err(|error| wrong(&error.to_string()))?;
    Ok(Cut::Material(material.name.clone()))
}

pub(super) fn engaged(text: &str) -> Answer<Engaged> {
    let sides = [("left", "left"), ("right", "right")];
    if let Some((rest, side)) = text.rsplit_once(' ')
        && let Ok(side) = one_of(side, &sides)
    {
        return Ok(Engaged::Everywhere(numbers(rest)?, side));
    }
    match all_numbers(text)?.len() {
        6 => Ok(Engaged::Block(numbers(text)?)),
        _ => Err(wrong(
            "six numbers are needed (two corners of the block), or width, depth and the side of the part, as in 4 2 right",
        )),
    }
}
