//! Data of a run: registers, signals, positions and frames, and assignments.
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4, register instructions, position register
//! instructions, frame instructions.

use std::collections::BTreeSet;

use nalgebra::{Isometry3, Vector3};

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::interpreter::operation::{one, two};
use crate::interpreter::value::{Datum, Literal, Step, Value};
use crate::ls::positions::{Held, Position};
use crate::ls::program::label_of;
use crate::ls::run::{InForce, Modal, Run};
use crate::ls::step::FRAME_DATA;
use crate::model::orientation::OrientationText;
use crate::text::Name;

/// Signals that are on or off.
const SIGNALS: [&str; 11] = [
    "DI", "DO", "RI", "RO", "SI", "SO", "UI", "UO", "WI", "WO", "F",
];

/// Parts of a position: X, Y, Z, W, P, R, and its configuration. A register that got numbers alone has an unknown configuration.
const PARTS: usize = 7;

/// The name of a register, a signal or a frame.
pub(super) fn name_of(kind: &Name, number: u32) -> Option<Name> {
    let kind = String::from_utf8_lossy(kind.letters());
    Name::of(format!("{kind}[{number}]").as_bytes())
}

/// True for the words of frames and tools.
pub(super) fn is_frame(kind: &Name) -> bool {
    kind.is("UFRAME") || kind.is("UTOOL")
}

/// The name under which the caller states a frame: `UF:2`.
fn stated_name(kind: &Name, number: u32) -> String {
    let letters = if kind.is("UFRAME") { "UF" } else { "UT" };
    format!("{letters}:{number}")
}

/// The frame that a value is.
pub(super) fn frame_of(value: &Datum) -> Option<Isometry3<f64>> {
    let numbers: Option<Vec<f64>> = value.parts().iter().take(6).map(Datum::as_number).collect();
    let [x, y, z, angles @ ..]: [f64; 6] = numbers?.try_into().ok()?;
    let rotation = OrientationText::Wpr.rotation_of(&angles)?;
    Some(Isometry3::from_parts(
        Vector3::new(x, y, z).into(),
        rotation,
    ))
}

/// A frame as a value.
fn value_of(frame: &Isometry3<f64>) -> Datum {
    let angles = OrientationText::Wpr.numbers_of(&frame.rotation, &[]);
    let place = frame.translation.vector.iter().copied();
    let mut parts: Vec<Datum> = place.chain(angles).map(Datum::number).collect();
    parts.push(Datum::of(Value::Text("".into())));
    Datum::list(parts)
}

impl Run<'_, '_> {
    /// The value of an expression of the program that runs.
    pub(super) fn value(&mut self, expression: &Expression) -> Datum {
        match &expression.node {
            Node::Number(value) => Datum::number(*value),
            Node::Truth(value) => Datum::truth(*value),
            Node::Text => {
                let text = String::from_utf8_lossy(self.file().part(&expression.tokens));
                Datum::of(Value::Text(text.trim_matches('\'').into()))
            }
            Node::Element(of, indices) => match &of.node {
                Node::Word(kind) => self.element(kind, indices, expression),
                _ => self.unknown(expression),
            },
            Node::One(operator, operand) => one(*operator, &self.value(operand)),
            Node::Two(operator, operands) => {
                let [left, right] = &**operands;
                let left = self.value(left);
                let right = self.value(right);
                match (left.parts().len(), right.parts().len()) {
                    (PARTS, PARTS) => sum(*operator, &left, &right),
                    _ => two(*operator, &left, &right),
                }
            }
            _ => self.unknown(expression),
        }
    }

    fn unknown(&self, expression: &Expression) -> Datum {
        let text = crate::error::excerpt(self.file().part(&expression.tokens));
        Datum::unknown(format!("`{text}` is not known from the text"))
    }

    /// The number that an index is; none where only the controller knows it.
    pub(super) fn index(&mut self, index: &Expression) -> Option<u32> {
        let number = self.value(index).as_number()?;
        self.decided += usize::from(label_of(&index.node).is_none());
        label_of(&Node::Number(number))
    }

    /// `R[1]`, `PR[1,2]`, `P[3]`, `UTOOL[1]`, `AR[1]`.
    fn element(&mut self, kind: &Name, indices: &[Expression], whole: &Expression) -> Datum {
        let indices: Option<Vec<u32>> = indices.iter().map(|index| self.index(index)).collect();
        let found = match indices.as_deref() {
            Some([number]) if kind.is("PR") => Some(self.register(*number)),
            Some([number, axis @ 1..=6]) if kind.is("PR") => (self
                .register(*number)
                .part(&[Step::Index(*axis as usize - 1)]))
            .cloned(),
            Some([number]) if kind.is("P") => self.position(*number),
            Some([number]) if is_frame(kind) => self.frame(kind, *number),
            Some([number]) => self.scalar(kind, *number),
            _ => None,
        };
        match found {
            Some(found) if found.unknown_reason().is_none() || !found.parts().is_empty() => found,
            _ => self.unknown(whole),
        }
    }

    /// A register or a signal.
    fn scalar(&mut self, kind: &Name, number: u32) -> Option<Datum> {
        if kind.is("AR")
            && let Some(argument) = (number as usize)
                .checked_sub(1)
                .and_then(|at| self.calls.last()?.arguments.get(at))
        {
            return Some(argument.clone());
        }
        let name = name_of(kind, number)?;
        if let Some(value) = self.values.get(&name) {
            return Some(value.clone());
        }
        let stated = self.stated.ask(&name)?;
        let is_signal = SIGNALS.iter().any(|signal| kind.is(signal));
        Some(match &stated.value {
            Value::Number(number) if is_signal => Datum::truth(*number != 0.0),
            Value::Text(text) if is_signal && text.eq_ignore_ascii_case("ON") => Datum::truth(true),
            Value::Text(text) if is_signal && text.eq_ignore_ascii_case("OFF") => {
                Datum::truth(false)
            }
            _ => stated,
        })
    }

    /// A position register; parts that the program did not give are those that the caller states.
    pub(super) fn register(&mut self, number: u32) -> Datum {
        let stored = Name::of(format!("PR[{number}]").as_bytes());
        let stored = stored.and_then(|name| self.values.get(&name).cloned());
        let mut parts: Vec<Datum> = match &stored {
            Some(stored) => stored.parts().to_vec(),
            None => vec![Datum::unknown("PR"); PARTS],
        };
        for (at, part) in parts.iter_mut().enumerate() {
            if part.unknown_reason().is_some() {
                let name = format!("PR[{number},{}]", at + 1);
                let stated = Name::of(name.as_bytes()).and_then(|own| self.stated.ask(&own));
                let unknown = || Datum::unknown(format!("`{name}` is not known from the text"));
                *part = stated.unwrap_or_else(unknown);
            }
        }
        Datum::list(parts)
    }

    /// X, Y, Z, W, P, R and the configuration of a position of the program.
    fn position(&self, number: u32) -> Option<Datum> {
        let program = self.program();
        let position = self.all.positions[program].all.get(&number)?;
        let Held::Pose(declaration) = position.held else {
            return None;
        };
        let declared = self.reader.declarations.get(declaration)?;
        let place = declared.text.position.iter();
        let numbers = place.chain(&declared.text.orientation);
        let mut parts: Vec<Datum> = numbers.map(|number| Datum::number(number.value)).collect();
        let text = declared.pose.configuration.text.as_str();
        parts.push(Datum {
            value: Value::Text(text.into()),
            literal: Some(Literal::new(program, &declared.statement)),
        });
        Some(Datum::list(parts))
    }

    /// A frame or tool as the caller states it.
    pub(super) fn stated_frame(&self, kind: &Name, number: u32) -> Option<&Isometry3<f64>> {
        self.frames.get(&stated_name(kind, number))
    }

    /// A frame or tool: as the caller states it, else with the value that the program gives it.
    pub(super) fn frame(&self, kind: &Name, number: u32) -> Option<Datum> {
        if let Some(stated) = self.stated_frame(kind, number) {
            return Some(value_of(stated));
        }
        match (self.values.get(&name_of(kind, number)?), number) {
            (Some(value), _) => Some(value.clone()),
            (None, 0) => Some(value_of(&Isometry3::identity())),
            (None, _) => None,
        }
    }

    /// A place that is assigned.
    pub(super) fn name_of(&mut self, to: &Expression) -> Option<Name> {
        match &to.node {
            Node::Element(of, indices) => match (&of.node, indices.as_slice()) {
                (Node::Word(kind), [index]) => name_of(kind, self.index(index)?),
                _ => None,
            },
            _ => None,
        }
    }

    /// `R[1]=2`, `PR[9,3]=250`, `UTOOL[1]=PR[9]`, `UFRAME_NUM=2`.
    pub(super) fn assign(&mut self, at: usize, sides: &[Expression; 2]) {
        let [to, value] = sides;
        let value = self.value(value);
        match &to.node {
            Node::Element(of, indices) => match &of.node {
                Node::Word(kind) if is_frame(kind) => self.assign_frame(at, kind, indices, value),
                _ => self.store(to, value),
            },
            Node::Word(name) => {
                let number = value.as_number().and_then(|of| label_of(&Node::Number(of)));
                let number = number.map_or(InForce::Computed, InForce::Known);
                if name.is("UFRAME_NUM") {
                    self.modal.frame = number;
                } else if name.is("UTOOL_NUM") {
                    self.modal.tool = number;
                }
            }
            _ => self.forget(),
        }
    }

    fn assign_frame(&mut self, at: usize, kind: &Name, indices: &[Expression], value: Datum) {
        let number = match indices {
            [index] => self.index(index),
            _ => None,
        };
        let is_stated = number.is_some_and(|of| self.stated_frame(kind, of).is_some());
        let name = number.and_then(|number| name_of(kind, number));
        match (name, frame_of(&value)) {
            _ if is_stated => {}
            (Some(name), Some(_)) => {
                self.given.insert(name);
                self.values.insert(name, value);
            }
            _ => self.fault(at, FRAME_DATA.0, FRAME_DATA.1),
        }
    }

    /// Stores the value of a register or a signal. Of a place that only the controller knows, all of its kind are lost.
    pub(super) fn store(&mut self, to: &Expression, value: Datum) {
        let Node::Element(of, indices) = &to.node else {
            return self.forget();
        };
        let Node::Word(kind) = &of.node else {
            return self.forget();
        };
        let numbers: Option<Vec<u32>> = indices.iter().map(|index| self.index(index)).collect();
        let Some((number, axis)) = numbers.as_deref().and_then(|numbers| numbers.split_first())
        else {
            let begin = [kind.letters(), b"["].concat();
            self.values
                .retain(|name, _| !name.letters().starts_with(&begin));
            self.modal.conditions = [None, None];
            return;
        };
        let Some(name) = name_of(kind, *number) else {
            return;
        };
        if !kind.is("PR") {
            return self.put(&name, value);
        }
        // The manual does not say which value counts where the register of the condition changes behind it.
        for condition in &mut self.modal.conditions {
            *condition = condition.filter(|of| of != number);
        }
        match axis {
            [] if value.parts().len() == PARTS => self.put(&name, value),
            [] => self.values.remove(&name).map_or((), drop),
            [axis @ 1..=6] => {
                let mut whole = self.register(*number);
                whole.put(&[Step::Index(*axis as usize - 1)], value);
                self.put(&name, whole);
            }
            // External axes.
            _ => {}
        }
    }

    /// Stores a value that is known, or forgets that of before.
    pub(super) fn put(&mut self, name: &Name, value: Datum) {
        match value.value {
            Value::Unknown(_) => self.values.remove(name),
            _ => self.values.insert(*name, value),
        };
    }

    /// Forgets all registers after an unknown assignment; counters of running loops and frames are assumed to stay.
    pub(super) fn forget(&mut self) {
        let counters = self
            .calls
            .iter()
            .flat_map(|called| called.counters.values());
        let counters: BTreeSet<Name> = counters.map(|(name, _)| *name).collect();
        self.values.retain(|name, _| {
            let is_frame =
                name.letters().starts_with(b"UFRAME[") || name.letters().starts_with(b"UTOOL[");
            is_frame || counters.contains(name)
        });
        self.modal.conditions = [None, None];
    }

    /// Forgets the whole state after an unknown action.
    pub(super) fn forget_all(&mut self) {
        self.forget();
        self.here = None;
        self.modal = Modal::UNSET;
    }

    /// Forgets the operands of a WAIT: others change them, unless the condition is already true.
    pub(super) fn wait(&mut self, condition: &Expression) {
        if self.value(condition).as_truth() != Some(true) {
            self.lose_all_in(condition);
        }
    }

    fn lose_all_in(&mut self, expression: &Expression) {
        match &expression.node {
            Node::Element(..) => {
                if let Some(name) = self.name_of(expression) {
                    self.values.remove(&name);
                }
            }
            Node::One(_, operand) => self.lose_all_in(operand),
            Node::Two(_, operands) => operands.iter().for_each(|part| self.lose_all_in(part)),
            _ => {}
        }
    }

    /// The position that a register number of the program names.
    pub(super) fn taught(&self, number: u32) -> Option<&Position> {
        self.all.positions[self.program()].all.get(&number)
    }
}

/// Sum or difference of two positions by their numbers, as long as one of them turns nothing.
fn sum(operator: Operator, left: &Datum, right: &Datum) -> Datum {
    let turns = |of: &Datum| {
        of.parts()[3..6]
            .iter()
            .any(|part| part.as_number() != Some(0.0))
    };
    if !matches!(operator, Operator::Plus | Operator::Minus) || turns(right) {
        return Datum::unknown("the sum of two positions that turn is not known");
    }
    let pairs = left.parts().iter().zip(right.parts()).take(PARTS - 1);
    let mut parts: Vec<Datum> = pairs
        .map(|(left, right)| two(operator, left, right))
        .collect();
    parts.extend(left.parts().last().cloned());
    Datum::list(parts)
}
