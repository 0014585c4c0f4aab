//! The nearest thing that would have been right.

use crate::problem::{Finding, KeyPath};

/// The closest of `known` to `given`, if it is close enough to be a slip of the pen.
pub(crate) fn nearest<'k>(given: &str, known: &[&'k str]) -> Option<&'k str> {
    // Long names cannot be slips, and the comparison costs the product of the lengths.
    if given.chars().count() > 60 {
        return None;
    }
    let lower = given.to_lowercase();
    known
        .iter()
        .map(|k| (strsim::damerau_levenshtein(&lower, &k.to_lowercase()), *k))
        .filter(|(distance, k)| {
            let length = k.chars().count().max(lower.chars().count());
            *distance <= (length / 3).max(1) && *distance < length
        })
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, k)| k)
}

/// Endings of keys that are units, longest first.
const UNITS: [&str; 49] = [
    "n_mm_per_rad",
    "n_m_per_rad",
    "n_m_per_deg",
    "nm_per_rad",
    "n_per_um",
    "n_per_mm",
    "n_per_m",
    "kn_per_mm",
    "n_mm_rad",
    "n_m_rad",
    "m_per_s2",
    "mm_per_s2",
    "n_mm2",
    "n_m2",
    "kg_mm2",
    "kg_m2",
    "inches",
    "inch",
    "degrees",
    "degree",
    "radians",
    "newton",
    "meter",
    "metre",
    "n_mm",
    "n_m",
    "gpa",
    "mpa",
    "kpa",
    "psi",
    "mm4",
    "cm4",
    "mm2",
    "cm2",
    "deg",
    "rad",
    "pa",
    "kg",
    "m4",
    "m2",
    "mm",
    "cm",
    "um",
    "in",
    "lb",
    "kn",
    "g",
    "m",
    "n",
];

/// A key without its unit, and the unit.
fn split_unit(key: &str) -> (&str, Option<&str>) {
    UNITS
        .iter()
        .find_map(|unit| {
            let stem = key.strip_suffix(unit)?.strip_suffix('_')?;
            (!stem.is_empty()).then_some((stem, Some(*unit)))
        })
        .unwrap_or((key, None))
}

const ORIENTATIONS: &str = "rotation_vector_deg, rotation_intrinsic_xyz_deg, roll_pitch_yaw_urdf_deg, a_b_c_kuka_deg, w_p_r_fanuc_deg, quaternion_wxyz, quaternion_xyzw, or x_axis with y_axis";

fn unnamed_orientation(key: &str) -> bool {
    let (stem, _) = split_unit(key);
    [
        "rotation",
        "rotation_xyz",
        "rotation_zyx",
        "rotation_zyz",
        "rpy",
        "euler",
        "euler_xyz",
        "euler_zyx",
        "euler_zyz",
        "orientation",
        "abc",
        "a_b_c",
        "wpr",
        "w_p_r",
        "quaternion",
        "roll_pitch_yaw",
        "angles",
    ]
    .contains(&stem)
}

/// Message and advice for a key that the schema does not have.
pub(crate) fn unknown_key(key: &str, known: &[&str]) -> (String, String) {
    let rest = |prefix: &str| -> Vec<&str> {
        known
            .iter()
            .copied()
            .filter(|k| split_unit(k).0 == prefix && split_unit(k).1.is_some())
            .collect()
    };
    if known.contains(&"quaternion_wxyz") && unnamed_orientation(key) {
        return (
            format!("'{key}' does not say which convention it follows"),
            format!("name it: {ORIENTATIONS}"),
        );
    }
    let bare = |k: &str| k.replace(['_', '-'], "").to_lowercase();
    if let Some(same) = known.iter().find(|k| bare(k) == bare(key)) {
        return (
            format!("unknown key '{key}'"),
            format!("did you mean '{same}'?"),
        );
    }
    let units_for_it = rest(key);
    if !units_for_it.is_empty() {
        return (
            format!("'{key}' has no unit"),
            format!("write the unit in the key: {}", units_for_it.join(" or ")),
        );
    }
    if let (stem, Some(unit)) = split_unit(key) {
        let others = rest(stem);
        if !others.is_empty() {
            return (
                format!("'{key}': {stem} cannot be given in '{unit}' here"),
                format!("write {}", others.join(" or ")),
            );
        }
    }
    let help = match nearest(key, known) {
        Some(word) => format!("did you mean '{word}'?"),
        None => {
            let list: Vec<&str> = known
                .iter()
                .copied()
                .filter(|k| !["source", "assumption"].contains(k))
                .collect();
            format!("known here: {}", list.join(", "))
        }
    };
    (format!("unknown key '{key}'"), help)
}

/// A name that refers to nothing.
pub(crate) fn unknown(
    place: &KeyPath,
    what: &str,
    name: &str,
    known: &[&str],
    otherwise: &str,
) -> Finding {
    let mut known = known.to_vec();
    known.dedup();
    let help = match nearest(name, &known) {
        Some(word) => format!("did you mean '{word}'?"),
        None if known.is_empty() => format!("there are none; {otherwise}"),
        None => format!("there are: {}; or {otherwise}", known.join(", ")),
    };
    Finding::new(place, format!("there is no {what} named '{name}'"), help)
}
