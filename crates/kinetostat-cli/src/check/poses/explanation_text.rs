//! Explanations in words, and what is to be written into the model file.

use kinetostat::Pose;
use kinetostat_analysis::measured_poses::{Axis, Coupling, Explanation, Frame};
use nalgebra::UnitQuaternion;

use crate::machine::units::unit;
use crate::place::joints::Named;
use crate::ui::numbers::{fixed, short, triple};

/// Data for the words of an explanation: the axes, their values in the file, and their joints in the model.
pub(crate) struct ExplanationText<'a> {
    pub(crate) names: &'a [Named],
    pub(crate) axes: &'a [Axis],
    pub(crate) joints: &'a [String],
}

impl ExplanationText<'_> {
    /// `sign of A3 is reversed; A2 is shifted by 90 deg`. With `advice`, what to write.
    pub(crate) fn of(&self, e: &Explanation, advice: bool) -> String {
        let names = self.names;
        let name = |i: usize| names[i].0.as_str();
        let mut parts = Vec::new();
        match e.reversed.as_slice() {
            [] => {}
            [one] => parts.push(format!("sign of {} is reversed", name(*one))),
            several => {
                let list: Vec<&str> = several.iter().map(|&i| name(i)).collect();
                parts.push(format!("signs of {} are reversed", list.join(", ")));
            }
        }
        for &(i, by) in &e.offsets {
            let (unit, size) = unit(names[i].1);
            // The offset is added to the shown value: the model's zero is there.
            parts.push(format!(
                "zero of {} is off: {} {unit} have to be added to what is shown",
                name(i),
                short(by / size)
            ));
        }
        parts.extend(e.coupling.map(|c| self.coupling(e, c, advice)));
        match &e.frame {
        Some(Frame::Base(pose)) => parts.push(format!(
            "the base frame is another one: the model's base is at {}",
            place(pose)
        )),
        Some(Frame::Tool(pose)) => parts.push(format!(
            "the tool frame is another one: the measured one is, in the model's tool frame, at {}",
            place(pose)
        )),
        None => {}
    }
        let text = parts.join("; ");
        if advice && !e.reversed.is_empty() && e.offsets.is_empty() && e.coupling.is_none() {
            return format!("{text} (change 'reversed' of it in the section [controller])");
        }
        text
    }

    /// `J3 is coupled with J2: the model needs J3 + J2`. With `advice`, what to write.
    fn coupling(&self, e: &Explanation, coupling: Coupling, advice: bool) -> String {
        let name = |i: usize| self.names[i].0.as_str();
        let share_of = |i: usize, j: usize| {
            let declared = self.axes[i].coupled.iter().find(|c| c.0 == j);
            declared.map_or(0.0, |c| c.1)
        };
        // A share between a slide and a turn has a unit of its own; it is not written as a number.
        let ratio = |i: usize, j: usize, share: f64| {
            if self.axes[i].turns == self.axes[j].turns {
                format!(" ratio = {}", short(share))
            } else {
                " the ratio with the other sign".to_owned()
            }
        };
        match coupling {
            Coupling::Missing { axis, other, share } => {
                let sign = if share < 0.0 { "-" } else { "+" };
                let (own, theirs) = (name(axis), name(other));
                let text = format!(
                    "{own} is coupled with {theirs}: the model needs {own} {sign} {theirs}"
                );
                if !advice {
                    return text;
                }
                let turned = if e.reversed.contains(&axis) {
                    1.0
                } else {
                    -1.0
                };
                format!(
                    "{text} (write in the section [controller], at {own}: coupled = [{{ joint = \"{}\", ratio = {} }}])",
                    self.joints[other],
                    short(turned * share * self.axes[other].ratio)
                )
            }
            Coupling::Reversed { axis, other } => {
                let text = format!(
                    "the coupling of {} with '{}' has the wrong sign",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], in 'coupled' of {}, write for '{}'{})",
                    name(axis),
                    self.joints[other],
                    ratio(axis, other, -share_of(axis, other))
                )
            }
            Coupling::Absent { axis, other } => {
                let text = format!(
                    "{} is declared to be coupled with '{}', but the controller shows it without",
                    name(axis),
                    self.joints[other]
                );
                if !advice {
                    return text;
                }
                format!(
                    "{text} (in the section [controller], remove '{}' from 'coupled' of {})",
                    self.joints[other],
                    name(axis)
                )
            }
        }
    }
}

fn place(pose: &Pose) -> String {
    let clean = |x: f64| short(if x.abs() < 1e-6 { 0.0 } else { x });
    let position = triple((pose.translation.vector * 1e3).into(), clean);
    let turn = pose.rotation.scaled_axis().map(f64::to_degrees);
    if UnitQuaternion::angle(&pose.rotation) < 1e-6 {
        return format!("{position} mm, parallel");
    }
    format!(
        "{position} mm, turned by the rotation vector {} deg",
        triple(turn.into(), |x| fixed(x, 3))
    )
}
