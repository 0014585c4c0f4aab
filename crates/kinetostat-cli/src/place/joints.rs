//! Joint values on the command line and in answers: the model's, and what the controller shows.

use kinetostat::{Mechanism, MotionKind};
use kinetostat_diagnostic::ErrorCode;
use kinetostat_model::schema::ControllerUnit;
use kinetostat_model::{Controller, Model};
use schemars::JsonSchema;
use serde::Serialize;

use crate::machine::units::unit;
use crate::place::arguments::PlaceArgs;
use crate::ui::failure::{Answer, Failing};
use crate::ui::layout::wrapped;
use crate::ui::numbers::short;
use crate::ui::screen::{self, Stream};
use crate::ui::spelling::nearest;

/// A joint or an axis and where it stands.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct JointValue {
    pub(crate) name: String,
    pub(crate) value: f64,
    pub(crate) unit: &'static str,
}

/// Kinds of all actuators, in the order of their names.
pub(crate) fn kinds(m: &Mechanism) -> Vec<MotionKind> {
    let limbs = m.limbs().iter();
    limbs
        .flat_map(|l| l.nominal.actuators().iter().map(|a| a.kind))
        .collect()
}

/// Commands at home, m or rad.
pub(crate) fn home(m: &Mechanism) -> Vec<f64> {
    let limbs = m.limbs().iter();
    limbs.flat_map(|l| l.nominal.home_commands()).collect()
}

/// Commands (m, rad) in the unit that answers show for each kind of actuator.
pub(crate) fn of_model(m: &Mechanism, commands: &[f64]) -> Vec<JointValue> {
    let named = m.actuator_names().into_iter().zip(kinds(m));
    named
        .zip(commands)
        .map(|((name, kind), command)| {
            let (unit, size) = unit(kind);
            JointValue {
                name,
                value: command / size,
                unit,
            }
        })
        .collect()
}

/// Commands as the controller shows them; nothing where no controller is declared.
pub(crate) fn in_controller_coordinates(
    controller: Option<&Controller>,
    commands: &[f64],
) -> Vec<JointValue> {
    let Some(controller) = controller else {
        return Vec::new();
    };
    let shown = controller.coordinates(commands).unwrap_or_default();
    let axes = controller.axes().iter();
    axes.zip(shown)
        .map(|(axis, value)| JointValue {
            name: axis.name.clone(),
            value,
            unit: axis.unit.word(),
        })
        .collect()
}

/// `label: A1 10 deg, A2 -90 deg, E1 1250 mm`.
pub(crate) fn values_text(label: &str, values: &[JointValue]) -> String {
    if values.is_empty() {
        return String::new();
    }
    let list: Vec<String> = values
        .iter()
        .map(|v| format!("{} {} {}", v.name, short(v.value), v.unit))
        .collect();
    wrapped(&format!("{label}: {}", list.join(", ")), 0)
}

/// Commands (m, rad) of `--joints` or `--controller`; `None` if neither is given. What is not named
/// stays at home.
pub(crate) fn given(model: &Model, place: &PlaceArgs) -> Answer<Option<Vec<f64>>> {
    let m = &model.mechanism;
    let commands = home(m);
    if !place.joints.is_empty() {
        let named = m.actuator_names().into_iter().zip(kinds(m));
        let names: Vec<Named> = named
            .map(|(name, kind)| (name, kind, unit(kind).1))
            .collect();
        return read("--joints", &place.joints, &names, commands).map(Some);
    }
    let (option, values) = match (place.controller.is_empty(), place.pendant.is_empty()) {
        (true, true) => return Ok(None),
        (false, _) => ("--controller", &place.controller),
        (true, false) => {
            screen::print(
                Stream::Err,
                "warning: --pendant is called --controller now; the old name goes with the next version\n",
            )?;
            ("--pendant", &place.pendant)
        }
    };
    let Some(controller) = &model.controller else {
        return Err(ErrorCode::ModelUnsuited.failure(format!(
                "{option}: the model has no [controller] that says what the controller shows; give the model's own joint values with --joints, or write the section (kinetostat model schema)",
            ),
        ));
    };
    let axes = controller.axes();
    let names = on_axes(controller);
    let shown = controller.coordinates(&commands).unwrap_or_default();
    let start = shown.iter().zip(axes).map(|(x, a)| x * a.unit.in_si());
    let shown = read(option, values, &names, start.collect())?;
    let shown: Vec<f64> = shown
        .iter()
        .zip(axes)
        .map(|(x, a)| x / a.unit.in_si())
        .collect();
    Ok(controller.joints(&shown))
}

/// A joint, its kind, and m or rad in one of its usual unit.
pub(crate) type Named = (String, MotionKind, f64);

/// The axes of the controller as [`read`] takes them, in the controller's order.
pub(crate) fn on_axes(controller: &Controller) -> Vec<Named> {
    let kind = |unit| match unit {
        ControllerUnit::Mm | ControllerUnit::M => MotionKind::Prismatic,
        ControllerUnit::Deg | ControllerUnit::Rad => MotionKind::Revolute,
    };
    let axes = controller.axes().iter();
    axes.map(|a| (a.name.clone(), kind(a.unit), a.unit.in_si()))
        .collect()
}

/// `NAME=VALUE` over `start`, all in m or rad; `names` with the size of their usual unit.
pub(crate) fn read(
    flag: &str,
    given: &[String],
    names: &[Named],
    start: Vec<f64>,
) -> Answer<Vec<f64>> {
    let mut values = start;
    let mut seen: Vec<usize> = Vec::new();
    for text in given {
        let refuse =
            |reason: String| ErrorCode::Value.failure(format!("{flag} '{text}': {reason}"));
        let Some((name, value)) = text.rsplit_once('=') else {
            return Err(refuse(
                "write the name of a joint and its value, as in J1=10 or E1=1250mm".into(),
            ));
        };
        let name = name.trim();
        let Some(index) = names.iter().position(|(n, ..)| n == name) else {
            let known: Vec<&str> = names.iter().map(|(n, ..)| n.as_str()).collect();
            let near =
                nearest(name, &known).map_or_else(String::new, |n| format!("did you mean '{n}'? "));
            return Err(refuse(format!(
                "there is no joint of that name. {near}There are {}",
                known.join(", ")
            )));
        };
        if seen.contains(&index) {
            return Err(refuse(format!("'{name}' is given twice")));
        }
        seen.push(index);
        let (_, kind, usual) = names[index];
        values[index] =
            quantity(value.trim(), kind, usual).map_err(|fault| refuse(fault.to_string()))?;
    }
    Ok(values)
}

/// A text is no length or angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("a finite number is needed, in {} or {} where a unit is written", units[0], units[1])]
pub(crate) struct NoQuantity {
    units: [&'static str; 2],
}

/// `10`, `10deg`, `0.2 rad`, `1250mm`: m or rad. `usual` is the size of the unit without a word.
pub(crate) fn quantity(text: &str, kind: MotionKind, usual: f64) -> Result<f64, NoQuantity> {
    let degree = std::f64::consts::PI / 180.0;
    let words = match kind {
        MotionKind::Prismatic => [("mm", 1e-3), ("m", 1.0)],
        MotionKind::Revolute => [("deg", degree), ("rad", 1.0)],
    };
    let word = words.iter().find(|(word, _)| text.ends_with(word));
    let (number, size) = word.map_or((text, usual), |(word, size)| {
        (text[..text.len() - word.len()].trim_end(), *size)
    });
    match number.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value * size),
        _ => Err(NoQuantity {
            units: words.map(|(unit, _)| unit),
        }),
    }
}
