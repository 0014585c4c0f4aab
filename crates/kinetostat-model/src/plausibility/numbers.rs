//! Each number as it is written, under the unit of its key, from one traversal for documents, which have no text, and for texts,
//! whose numbers know where they stand.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use kinetostat::number::short;
use serde_json::Value;
use serde_spanned::Spanned;
use toml::de::{DeTable, DeValue};

use crate::problem::{Finding, KeyPath};
use crate::schema::Document;

/// Compares every number of a document with what its unit is used for.
pub(crate) fn of_numbers(document: &Document, warnings: &mut Vec<Finding>) {
    let Ok(tree) = serde_json::to_value(document) else {
        return;
    };
    for number in numbers(&tree) {
        if let Some((message, help)) = doubt_of(number.key, number.value) {
            warnings.push(Finding::new(&number.place, message, help));
        }
    }
}

/// Angles of a TOML text that were most likely written in the other unit: what is said, and its place in the text.
/// Empty for what is no TOML.
#[must_use]
pub fn odd_angles(text: &str) -> Vec<(Range<usize>, String)> {
    let Ok(table) = DeTable::parse(text) else {
        return Vec::new();
    };
    let root = Spanned::new(0..text.len(), DeValue::Table(table.into_inner()));
    let of_angle = |key: &str| key.ends_with("_deg") || key.ends_with("_rad");
    numbers(&root)
        .into_iter()
        .filter(|number| of_angle(number.key))
        .filter_map(|number| {
            let (message, help) = doubt_of(number.key, number.value)?;
            let said = format!("{}: {message}; {help}", number.key);
            Some((number.node.span(), said))
        })
        .collect()
}

/// Parts of a section, which may be thin but not that thin.
const SECTION_KEYS: [&str; 8] = [
    "outer_diameter",
    "inner_diameter",
    "diameter",
    "width",
    "height",
    "flange",
    "web",
    "wall",
];

/// Doubt about a number under its key, and its remedy; `None` for a usual value.
fn doubt_of(key: &str, x: f64) -> Option<(String, &'static str)> {
    if key == "repeatability_mm" && !(5e-4..=1.0).contains(&x) {
        return Some((
            format!("a repeatability of {} mm", short(x)),
            "arms repeat within 0.02 to 0.2 mm, machine tools within 0.001 to 0.01 mm; check the unit",
        ));
    }
    let compound = key.contains("_per_") || key.contains("n_m") || key.contains("kg_m");
    if x == 0.0 || compound {
        return None;
    }
    if key.ends_with("_rad") && x.abs() > 7.0 && (x.abs() > 40.0 || x % 5.0 == 0.0) {
        return Some((
            format!("{x} rad are {:.0} turns", (x / TAU).abs().max(1.0)),
            "this looks like degrees: write the key with _deg",
        ));
    }
    if key.ends_with("_deg") && looks_like_radians(x) {
        return Some((
            format!("{x} degrees are exactly {} in radians", share_of_pi(x)),
            "this looks like radians: write the key with _rad",
        ));
    }
    let moment = key.starts_with("second_moment") || key.starts_with("torsion_constant");
    let moment = moment.then(|| match key.strip_suffix("_mm4") {
        Some(_) => 1e-12 * x,
        None => x,
    });
    // Area moment of a section about 2 m wide.
    if let Some(m4) = moment.filter(|m4| *m4 > 1.0) {
        return Some((
            format!("a second moment of {} m^4", short(m4)),
            "no part of a robot has sections of metres; check the unit in the key: _mm4 or _m4",
        ));
    }
    let (name, metres) = match (key.strip_suffix("_mm"), key.strip_suffix("_m")) {
        (Some(name), _) => (name, 1e-3 * x),
        (None, Some(name)) => (name, x),
        _ => return None,
    };
    // Limits are often written far out where there are none.
    if metres.abs() > 50.0 && name != "limits" {
        return Some((
            format!("a length of {} m", short(metres.abs())),
            "robots are smaller; check the unit in the key: _mm or _m",
        ));
    }
    let least = match name {
        "length" => 1e-3,
        _ if SECTION_KEYS.iter().any(|k| name.ends_with(k)) => 5e-5,
        _ => return None,
    };
    (metres < least).then(|| {
        (
            format!(
                "the {} is {} mm",
                name.replace('_', " "),
                short(1e3 * metres)
            ),
            "parts of robots are larger; check the unit in the key: _mm or _m",
        )
    })
}

/// Twelfths of a half turn by which angles are usually written.
const USUAL: [f64; 7] = [2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 24.0];

/// True if an angle in degrees is a usual share of pi, as an angle in radians is.
///
/// ```
/// assert!(kinetostat_model::looks_like_radians(3.14159) && !kinetostat_model::looks_like_radians(3.0));
/// ```
#[must_use]
pub fn looks_like_radians(x: f64) -> bool {
    USUAL
        .iter()
        .any(|k| (x.abs() / (k * PI / 12.0) - 1.0).abs() < 6e-4)
}

fn share_of_pi(x: f64) -> String {
    let degrees = (x.to_degrees() / 15.0).round() * 15.0;
    format!("{degrees} degrees")
}

/// A value of a document or of a text.
pub(crate) trait Tree: Sized {
    /// The number that it is; none for tables, lists and words.
    fn number(&self) -> Option<f64>;

    /// Children in order, with their keys in a table, without in a list.
    fn children(&self) -> Vec<(Option<&str>, &Self)>;
}

impl Tree for Value {
    fn number(&self) -> Option<f64> {
        self.as_f64()
    }

    fn children(&self) -> Vec<(Option<&str>, &Self)> {
        match self {
            Self::Object(map) => map.iter().map(|(k, v)| (Some(k.as_str()), v)).collect(),
            Self::Array(list) => list.iter().map(|v| (None, v)).collect(),
            _ => Vec::new(),
        }
    }
}

impl Tree for Spanned<DeValue<'_>> {
    fn number(&self) -> Option<f64> {
        match self.get_ref() {
            DeValue::Float(number) => number.as_str().parse().ok(),
            DeValue::Integer(number) => number.as_str().parse().ok(),
            _ => None,
        }
    }

    fn children(&self) -> Vec<(Option<&str>, &Self)> {
        match self.get_ref() {
            DeValue::Table(table) => table
                .iter()
                .map(|(k, v)| (Some(&**k.get_ref()), v))
                .collect(),
            DeValue::Array(list) => list.iter().map(|v| (None, v)).collect(),
            _ => Vec::new(),
        }
    }
}

/// A number of a tree.
pub(crate) struct Number<'t, T> {
    /// Key of the number, or of the list that contains it.
    pub(crate) key: &'t str,
    /// The path to it from the root.
    pub(crate) place: KeyPath,
    /// The value that holds it.
    pub(crate) node: &'t T,
    pub(crate) value: f64,
}

/// All numbers of a tree, in the order of its tables and lists.
pub(crate) fn numbers<T: Tree>(root: &T) -> Vec<Number<'_, T>> {
    let mut found = Vec::new();
    collect(root, "", &KeyPath::root(), &mut found);
    found
}

fn collect<'t, T: Tree>(
    node: &'t T,
    key: &'t str,
    place: &KeyPath,
    found: &mut Vec<Number<'t, T>>,
) {
    if let Some(value) = node.number() {
        found.push(Number {
            key,
            place: place.clone(),
            node,
            value,
        });
    }
    for (index, (own, child)) in node.children().into_iter().enumerate() {
        match own {
            Some(own) => collect(child, own, &place.key(own), found),
            None => collect(child, key, &place.index(index), found),
        }
    }
}
