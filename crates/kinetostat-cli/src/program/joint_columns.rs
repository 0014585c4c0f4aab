//! Columns of limits, ratings and configuration in the table of points: only those that the machine has.

use kinetostat_machining::{Elbow, PointResult, RunInputs, Shoulder, Wrist};

use crate::ui::csv_cell::{decimals, digits};

/// Columns of joint values for a machine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JointColumns {
    /// Some joint that slides has limits, some joint that turns has.
    limits: [bool; 2],
    /// Some drive has a rating.
    ratings: bool,
    /// The machine is an arm of six axes with a wrist in one point.
    arm: bool,
}

/// Units of joints that slide and of those that turn, and their columns.
const UNITS: [(&str, &str); 2] = [("mm", "limit_distance_mm"), ("deg", "limit_distance_deg")];

impl JointColumns {
    pub(crate) fn of(run_inputs: &RunInputs) -> Self {
        let limited = |(unit, _): (&str, &str)| {
            let mut actuators = run_inputs.actuators.iter();
            actuators.any(|a| a.motion_unit == unit && a.limits.is_some())
        };
        Self {
            limits: UNITS.map(limited),
            ratings: run_inputs.actuators.iter().any(|a| a.rating.is_some()),
            arm: run_inputs.has_configuration,
        }
    }

    fn limited(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let both = UNITS.into_iter().zip(self.limits);
        both.filter(|(_, limited)| *limited).map(|(unit, _)| unit)
    }

    pub(crate) fn names(self) -> Vec<String> {
        let mut names = Vec::new();
        if self.limits != [false; 2] {
            names.push("nearest_limit".to_owned());
        }
        names.extend(self.limited().map(|(_, column)| column.to_owned()));
        if self.ratings {
            names.extend(["most_loaded_drive", "share_of_rating"].map(String::from));
        }
        if self.arm {
            let of_arm = [
                "shoulder",
                "elbow",
                "wrist",
                "configuration",
                "shoulder_from_singular_mm",
                "elbow_from_singular_deg",
                "wrist_from_singular_deg",
            ];
            names.extend(of_arm.map(String::from));
        }
        names
    }

    /// Cells of a row, one for each name; unknown ones are empty.
    pub(crate) fn cells(self, run_inputs: &RunInputs, point: &PointResult) -> Vec<String> {
        let actuator = |index: usize| run_inputs.actuators.get(index);
        let name = |index: usize| actuator(index).map_or_else(String::new, |a| one_word(&a.name));
        let mut cells = Vec::new();
        if self.limits != [false; 2] {
            cells.push(point.nearest_limit.map_or_else(String::new, |limit| {
                format!("{}_{}", name(limit.actuator), limit.end.word())
            }));
        }
        for (unit, _) in self.limited() {
            let of_unit = point
                .nearest_limit
                .filter(|limit| actuator(limit.actuator).is_some_and(|a| a.motion_unit == unit));
            cells.push(of_unit.map_or_else(String::new, |limit| decimals(limit.distance, 4)));
        }
        if self.ratings {
            let loaded = point.most_loaded;
            cells.push(loaded.map_or_else(String::new, |drive| name(drive.actuator)));
            cells.push(loaded.map_or_else(String::new, |drive| digits(drive.share_of_rating, 4)));
        }
        if self.arm {
            cells.extend(of_arm(point));
        }
        cells
    }
}

fn of_arm(point: &PointResult) -> [String; 7] {
    let Some(arm) = point.configuration else {
        return Default::default();
    };
    let shoulder = match arm.shoulder {
        Shoulder::Front => "front",
        Shoulder::Back => "back",
    };
    let elbow = match arm.elbow {
        Elbow::Up => "up",
        Elbow::Down => "down",
    };
    let wrist = match arm.wrist {
        Wrist::NoFlip => "no_flip",
        Wrist::Flip => "flip",
    };
    [
        shoulder.to_owned(),
        elbow.to_owned(),
        wrist.to_owned(),
        arm.number.to_string(),
        decimals(arm.shoulder_from_singular_mm, 3),
        decimals(arm.elbow_from_singular_deg, 4),
        decimals(arm.wrist_from_singular_deg, 4),
    ]
}

/// A name of a file in a name of a column: no blanks, nothing that a spreadsheet takes for a formula.
pub(crate) fn one_word(name: &str) -> String {
    let plain = |c: char| {
        if c.is_alphanumeric() || c == '.' {
            c
        } else {
            '_'
        }
    };
    let word: String = name.chars().map(plain).collect();
    match word.starts_with('.') || word.is_empty() {
        true => format!("_{word}"),
        false => word,
    }
}
