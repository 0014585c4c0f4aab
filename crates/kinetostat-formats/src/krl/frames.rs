//! Tools and bases: what the text or the caller says they are.

use nalgebra::Isometry3;

use crate::interpreter::expression::{Expression, Node, Operator};
use crate::interpreter::value::{Datum, Step, Value};
use crate::krl::position::position_of;
use crate::krl::state::{Role, Run, key};
use crate::model::frame::{Frame, FrameUse};
use crate::text::name::Name;

/// Frames nearer than this are one: what stated numbers lose where they are written down, mm and rad.
const SAME: [f64; 2] = [1e-6, 1e-8];

const NOWHERE: &str = "none of these files states it: give $config.dat, or state it";

/// An element of an array of frames, by its number from 1.
fn element_of(whole: Option<&Datum>, number: u32) -> Datum {
    let Some(whole) = whole else {
        return Datum::unknown(NOWHERE);
    };
    let element = whole.part(&[Step::Index(number as usize - 1)]);
    element.cloned().unwrap_or_else(|| {
        let reason = whole.unknown_reason();
        reason.map_or_else(
            || Datum::unknown(NOWHERE),
            |reason| Datum::unknown(reason.clone()),
        )
    })
}

impl Run<'_, '_> {
    /// A frame that the caller states by its name.
    pub(super) fn stated_frame(&self, name: &str) -> Option<FrameUse> {
        let frame = *self.own.stated.get(&key(name))?;
        Some(FrameUse {
            name: name.to_owned(),
            frame: Frame::Known(frame),
        })
    }

    /// The frame that an expression is: sums of frames are one behind the other.
    pub(super) fn frame(&mut self, expression: &Expression) -> FrameUse {
        let file = self.file();
        let name = key(&file.text(&expression.tokens));
        if let Some((role, index)) = self.numbered_role(expression) {
            return match index {
                Some(number) => self.numbered(role, number),
                None => {
                    let inside = expression.tokens.start + 2..expression.tokens.end - 1;
                    self.computed(role, &file.text(&inside))
                }
            };
        }
        if let Some(stated) = self.stated_frame(&name) {
            return stated;
        }
        match self.part(expression) {
            Ok(frame) => FrameUse {
                name,
                frame: Frame::Known(frame),
            },
            Err(reason) => FrameUse {
                name: self.named_apart(expression, name),
                frame: Frame::Unknown { reason },
            },
        }
    }

    /// `TOOL_DATA[n]` or `BASE_DATA[n]`; number 0 is the flange or the world. What the program gave it in this run counts, else what the
    /// caller states, else what the files state. A value that is not known and is another than that of the first use is another frame.
    pub(super) fn numbered(&mut self, role: Role, number: u32) -> FrameUse {
        let name = format!("{}[{number}]", role.array());
        let known = |name, frame| FrameUse {
            name,
            frame: Frame::Known(frame),
        };
        if number == 0 {
            return known(name, Isometry3::identity());
        }
        let now = self.element(role, number);
        let initial = match self.own.initial.get(&(role, number)) {
            Some(initial) => initial.clone(),
            None => {
                let initial = self.initial_element(role, number);
                self.own.initial.insert((role, number), initial.clone());
                initial
            }
        };
        let is_first = *(self.own.used.entry((role, number))).or_insert_with(|| now.clone()) == now;
        let stated = self.stated_frame(&name);
        match (self.frame_of(&now), stated) {
            (Ok(frame), None) => known(name, frame),
            (Ok(frame), Some(_)) if now != initial => known(name, frame),
            (_, Some(stated)) if is_first => stated,
            (Ok(frame), Some(_)) => known(name, frame),
            (Err(reason), _) => FrameUse {
                name: match is_first {
                    true => name,
                    false => format!("{name} of line {}", self.line()),
                },
                frame: Frame::Unknown { reason },
            },
        }
    }

    /// Says where the program gives an element other numbers than the caller states.
    pub(super) fn compare_with_stated(&mut self, role: Role, number: u32, value: &Datum) {
        let name = format!("{}[{number}]", role.array());
        let (Some(stated), Ok(own)) = (self.own.stated.get(&name), self.frame_of(value)) else {
            return;
        };
        let apart = own.inv_mul(stated);
        let is_same =
            apart.translation.vector.norm() <= SAME[0] && apart.rotation.angle() <= SAME[1];
        if !is_same {
            let at = self.statement.clone();
            self.find(
                &at,
                format!(
                    "`{name}` gets other numbers here than those that are stated for it: those of the program count"
                ),
            );
        }
    }

    /// An element of an array of frames with an index that only the controller knows.
    pub(super) fn computed(&self, role: Role, index: &str) -> FrameUse {
        let name = format!("{}[{}]", role.array(), key(index));
        let reason = "its number is computed while the program runs".to_owned();
        self.stated_frame(&name).unwrap_or(FrameUse {
            name,
            frame: Frame::Unknown { reason },
        })
    }

    /// The value of an element now.
    fn element(&mut self, role: Role, number: u32) -> Datum {
        let name = Name::of(role.array().as_bytes());
        let root = name.and_then(|name| self.root(&name));
        if let Some(root) = root {
            let index = (number as usize).checked_sub(1);
            self.note_use(root, index.map(Step::Index));
        }
        let whole = root.and_then(|root| self.stored(root));
        element_of(whole.as_ref(), number)
    }

    /// The value of an element with which the files begin.
    fn initial_element(&mut self, role: Role, number: u32) -> Datum {
        let name = Name::of(role.array().as_bytes());
        let root = name.and_then(|name| self.root(&name));
        let whole = root
            .and_then(|root| self.datum_of(root))
            .map(|index| self.initial(index));
        element_of(whole.as_ref(), number)
    }

    /// The frame that a value is.
    pub(super) fn frame_of(&self, datum: &Datum) -> Result<Isometry3<f64>, String> {
        if datum.value == Value::Members(Default::default()) {
            return Err(NOWHERE.to_owned());
        }
        let frame = position_of(self.files, datum)?.frame();
        frame.ok_or_else(|| "its numbers are not all stated".to_owned())
    }

    /// The array of frames of an element, and its index where that is known.
    fn numbered_role(&mut self, expression: &Expression) -> Option<(Role, Option<u32>)> {
        let Node::Element(of, indices) = &expression.node else {
            return None;
        };
        let (Node::Word(name), [index]) = (&of.node, indices.as_slice()) else {
            return None;
        };
        let role = Role::of_array(name)?;
        let number = self.value(index).as_number();
        let number = number.filter(|number| (0.0..1e6).contains(number) && number.fract() == 0.0);
        Some((role, number.map(|number| number as u32)))
    }

    fn part(&mut self, expression: &Expression) -> Result<Isometry3<f64>, String> {
        if let Node::Two(Operator::Behind, operands) = &expression.node {
            let [before, behind] = &**operands;
            return Ok(self.part(before)? * self.part(behind)?);
        }
        let frame = match self.numbered_role(expression) {
            Some((role, Some(number))) => self.numbered(role, number).frame,
            Some((_, None)) => {
                return Err("its number is computed while the program runs".to_owned());
            }
            None => {
                let text = key(&self.file().text(&expression.tokens));
                if let Some(stated) = self.own.stated.get(&text) {
                    return Ok(*stated);
                }
                let value = self.value(expression);
                return self.frame_of(&value);
            }
        };
        match frame {
            Frame::Known(frame) => Ok(frame),
            Frame::Unknown { reason } => Err(reason),
        }
    }

    /// The name of a frame that is not known: with its line, where a datum gets several values and each use may be another frame.
    fn named_apart(&self, expression: &Expression, name: String) -> String {
        let file = self.file();
        let names = expression.tokens.clone().filter_map(|at| file.name(at));
        let mut counts = names.map(|name| self.own.assigned.get(&name).copied().unwrap_or(0));
        match counts.any(|count| count > 1) {
            true => format!("{name} of line {}", file.line_of(expression.tokens.start)),
            false => name,
        }
    }
}
