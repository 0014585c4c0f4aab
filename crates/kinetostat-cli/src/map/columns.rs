//! Additional variables of a map: the requested ones, and the names of their columns.

use kinetostat::MotionKind;
use kinetostat_diagnostic::ErrorCode;
use kinetostat_machining::{MapPlace, VARIABLES, Variable, Worse};

use crate::map::arguments::{MapArgs, Quantity};
use crate::ui::failure::{Answer, Failing};

/// A column of a further variable, SI.
#[derive(Clone, Debug)]
pub(crate) struct Column {
    /// Index among the values of a place.
    pub(crate) at: usize,
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) description: &'static str,
}

impl Column {
    /// Head of the column in a table: its name with the unit.
    pub(crate) fn head(&self) -> String {
        match self.unit {
            "1" => self.name.clone(),
            unit => {
                let words = unit.replace('/', " per ").to_lowercase();
                let words: Vec<&str> = words.split_whitespace().collect();
                format!("{}_{}", self.name, words.join("_"))
            }
        }
    }
}

/// Drawn quantity: one of the usual figures, or a column.
#[derive(Clone, Debug)]
pub(crate) enum Shown {
    Usual(Quantity),
    Column(Column),
}

impl Shown {
    pub(crate) fn of(&self, place: &MapPlace) -> f64 {
        match self {
            Self::Usual(quantity) => quantity.of(place),
            Self::Column(column) => place.values.get(column.at).copied().unwrap_or(f64::NAN),
        }
    }

    pub(crate) fn description(&self) -> String {
        match self {
            Self::Usual(quantity) => quantity.description().to_owned(),
            Self::Column(column) => column.name.replace('_', " "),
        }
    }

    pub(crate) fn unit(&self) -> &'static str {
        match self {
            Self::Usual(quantity) => quantity.unit(),
            Self::Column(column) => column.unit,
        }
    }

    /// A small value is a bad one.
    pub(crate) fn small_is_bad(&self) -> Option<bool> {
        match self {
            Self::Usual(Quantity::Displacement | Quantity::Rotation) => Some(false),
            Self::Usual(_) => Some(true),
            Self::Column(column) => {
                let own = VARIABLES.iter().find(|e| e.name == column.name)?;
                match own.worse {
                    Worse::Smaller => Some(true),
                    Worse::Larger => Some(false),
                    Worse::LargerSize | Worse::Neither => None,
                }
            }
        }
    }
}

fn words(name: &str) -> Option<Quantity> {
    Some(match name {
        "softest" => Quantity::Softest,
        "x" => Quantity::X,
        "y" => Quantity::Y,
        "z" => Quantity::Z,
        "displacement" => Quantity::Displacement,
        "rotation" => Quantity::Rotation,
        _ => return None,
    })
}

/// Names of the columns of a variable.
fn names(variable: Variable, actuators: usize) -> Vec<String> {
    let entry = variable.entry();
    match variable.width(actuators) {
        1 => vec![entry.name.to_owned()],
        n if entry.name.ends_with("_xyz") && n == 3 => {
            let stem = entry.name.trim_end_matches("xyz");
            ["x", "y", "z"].map(|k| format!("{stem}{k}")).to_vec()
        }
        n => (1..=n).map(|k| format!("{}_{k}", entry.name)).collect(),
    }
}

/// All columns of some variables; what is one of each actuator is of the unit of its kind.
pub(crate) fn columns(variables: &[Variable], actuators: &[MotionKind]) -> Vec<Column> {
    let each = variables.iter().flat_map(|variable| {
        let entry = variable.entry();
        let own = names(*variable, actuators.len()).into_iter();
        own.enumerate().map(move |(k, name)| {
            let unit = match (entry.unit.split_once(" or "), actuators.get(k)) {
                (Some((of_slide, _)), Some(MotionKind::Prismatic)) => of_slide,
                (Some((_, of_turn)), Some(MotionKind::Revolute)) => of_turn,
                _ => entry.unit,
            };
            (name, unit, entry.description)
        })
    });
    each.enumerate()
        .map(|(at, (name, unit, description))| Column {
            at,
            name,
            unit,
            description,
        })
        .collect()
}

/// The variables that are asked for with --variables and --show, and what is shown.
pub(crate) fn asked(
    args: &MapArgs,
    actuators: &[MotionKind],
    loaded: bool,
    cases: usize,
) -> Answer<(Vec<Variable>, Shown)> {
    let known = || {
        let all: Vec<&str> = VARIABLES.iter().map(|e| e.name).collect();
        all.join(", ")
    };
    let mut variables = Vec::new();
    for name in &args.variables {
        let Some(variable) = Variable::named(name) else {
            return Err(ErrorCode::UnknownName.failure(format!(
                "--variables: there is no '{name}'; there are {}",
                known()
            )));
        };
        if !variables.contains(&variable) {
            variables.push(variable);
        }
    }
    let usual = words(&args.show);
    if usual.is_none() {
        let entries = VARIABLES.iter().map(|e| e.variable);
        let own = entries
            .clone()
            .find(|v| names(*v, actuators.len()).contains(&args.show));
        let Some(own) = own else {
            let several = entries.clone().find(|v| v.entry().name == args.show);
            return Err(ErrorCode::Missing.failure(match several {
                    Some(several) => format!(
                        "--show: '{}' has several columns; choose one of {}",
                        args.show,
                        names(several, actuators.len()).join(", ")
                    ),
                    None => format!(
                        "--show: there is no '{}'; there are softest, x, y, z, displacement, rotation, and columns of {}",
                        args.show,
                        known()
                    ),
                },
            ));
        };
        if !variables.contains(&own) {
            variables.push(own);
        }
    }
    for variable in &variables {
        let name = variable.entry().name;
        let refuse = |what: &str| Err(ErrorCode::Missing.failure(format!("'{name}' {what}")));
        if variable.needs_load() && !loaded {
            return refuse("needs a load; give --force or --moment (zeros are one, too)");
        }
        if cases > 1 && variable.entry().worse == Worse::Neither {
            return refuse("has no worst value; give one orientation and one load");
        }
        if variable.needs_drives() && actuators.is_empty() {
            return refuse("is about drives, and this machine has none");
        }
    }
    let shown = match usual {
        Some(quantity) => Shown::Usual(quantity),
        None => {
            let all = columns(&variables, actuators);
            let own = all.into_iter().find(|c| c.name == args.show);
            Shown::Column(own.ok_or_else(|| ErrorCode::Missing.failure("--show: nothing to show"))?)
        }
    };
    Ok((variables, shown))
}
