//! Columns of the table of points: their units and meanings, by their names.

use kinetostat_formats::fields::RowColumn;

/// Columns that hold words.
const WORDS: [&str; 8] = [
    "kind",
    "status",
    "nearest_limit",
    "most_loaded_drive",
    "shoulder",
    "elbow",
    "wrist",
    "source_file",
];

/// Ends of names with the units that they say, longer ones first.
const UNITS: [(&str, &str); 5] = [
    ("_n_per_mm", "N/mm"),
    ("_n_m", "N m"),
    ("_mm", "mm"),
    ("_deg", "deg"),
    ("_n", "N"),
];

/// Beginnings (or all) of names with what they are, longer ones first.
const MEANINGS: [(&str, &str); 30] = [
    ("line", "line of the input program, from 1"),
    (
        "output_line",
        "line of the written program, from 1; 0 if none was written",
    ),
    (
        "kind",
        "feed, rapid (at its end), corner or entry (on a step)",
    ),
    ("share", "share of the block up to here, 0 to 1"),
    ("path", "length of the path up to here"),
    (
        "error_before",
        "where the tool is without compensation minus where it should be, program axes",
    ),
    (
        "error_after",
        "where the tool is with the written program minus where it should be, program axes",
    ),
    (
        "correction",
        "what the written program adds to the place, program axes",
    ),
    ("force", "force on the tool, program axes"),
    ("moment", "moment on the tool about its tip, program axes"),
    (
        "orientation",
        "tool in the program, program axes from tool axes: quaternion, scalar w",
    ),
    ("residual_rotation", "rotation of the tool that stays"),
    (
        "tool_turn",
        "how far the tool is turned from the orientation that it is kept near to",
    ),
    (
        "limit_distance",
        "distance of the nearest joint to its limit, below zero outside",
    ),
    (
        "share_of_rating",
        "force or torque of the most loaded drive by its rating",
    ),
    ("pendant", "what the controller shows"),
    (
        "smallest_stiffness",
        "stiffness of the tool's tip against a force in the softest direction",
    ),
    (
        "share_to_buckling",
        "largest share of the way to buckling of any limb, 1 is buckling",
    ),
    ("status", "ok or unstable"),
    (
        "nearest_limit",
        "joint that is nearest to an end of its range, and which end",
    ),
    (
        "most_loaded_drive",
        "drive that carries the largest share of its rating",
    ),
    ("shoulder", "side on which the shoulder stands"),
    ("elbow", "side to which the elbow is bent"),
    ("wrist", "side to which the wrist is turned"),
    ("configuration", "number of the configuration of the arm"),
    (
        "shoulder_from_singular",
        "distance of the wrist's centre from the axis of joint 1",
    ),
    (
        "elbow_from_singular",
        "angle of the elbow from the stretched arm",
    ),
    (
        "wrist_from_singular",
        "angle of joint 5 from where axes 4 and 6 are in line",
    ),
    ("source_line", "line in the file that it was expanded from"),
    ("source_file", "file that it was expanded from"),
];

/// The column of a name.
pub(crate) fn column(name: &str) -> RowColumn {
    let is_text = WORDS.contains(&name);
    let unit = UNITS.iter().find(|(end, _)| name.ends_with(end));
    // The longest beginning counts: a share of the way to buckling is no share of a block.
    let own = MEANINGS.iter().filter(|(start, _)| name.starts_with(start));
    let meaning = own.max_by_key(|(start, _)| start.len());
    let description = match meaning {
        Some((_, meaning)) => *meaning,
        None if ["x_mm", "y_mm", "z_mm"].contains(&name) => {
            "where the tool should be, program coordinates"
        }
        None if name.contains("_command_") => "joint value as commanded",
        None if name.contains("_force_") => "force or torque of the drive",
        None if name.contains("_correction_") => "change of the joint by the compensation",
        None => "",
    };
    RowColumn {
        name: name.to_owned(),
        unit: match (is_text, unit) {
            (true, _) => String::new(),
            (false, Some((_, unit))) => (*unit).to_owned(),
            (false, None) => "1".to_owned(),
        },
        description: description.to_owned(),
        is_text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_their_units_and_meanings() {
        for (name, unit, word) in [
            ("error_before_x_mm", "mm", "without compensation"),
            ("force_z_n", "N", "program axes"),
            ("moment_z_n_m", "N m", "about its tip"),
            ("smallest_stiffness_n_per_mm", "N/mm", "softest"),
            ("joint_1_command_deg", "deg", "commanded"),
            ("share_to_buckling", "1", "buckling"),
            ("kind", "", "rapid"),
            ("y_mm", "mm", "should be"),
        ] {
            let column = column(name);
            assert_eq!(column.unit, unit, "{name}");
            assert!(
                column.description.contains(word),
                "{name}: {}",
                column.description
            );
        }
    }
}
