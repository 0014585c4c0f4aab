//! Tools, work objects, speeds and zones by name or literal.

use std::collections::BTreeMap;

use nalgebra::Isometry3;

use crate::model::frame::{Frame, FrameUse};
use crate::model::motion::Zone;
use crate::options::ReadOptions;
use crate::rapid::constants::Constants;
use crate::rapid::expression::{Expression, Value};
use crate::rapid::held_speeds::AssignedSpeeds;
use crate::rapid::literals::{frame_of, values};
use crate::rapid::symbols::{Meaning, Symbols};
use crate::rapid::tree::{Change, TokenFile};
use crate::text::name::Name;

/// Why something is refused, and what to do.
pub(crate) type Reason = (String, &'static str);

/// What names are worth.
pub(crate) struct Values<'p> {
    pub files: &'p [TokenFile<'p>],
    pub symbols: Symbols<'p>,
    stated: BTreeMap<Name, Isometry3<f64>>,
    /// By index of the datum: read once.
    frames: BTreeMap<usize, Result<FrameUse, Reason>>,
    speeds: BTreeMap<usize, Option<[f64; 4]>>,
    zones: BTreeMap<usize, Zone>,
    pub assigned_speeds: AssignedSpeeds,
}

/// Tool or work object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Tool,
    WorkObject,
}

const STATE_IT: &str =
    "state the frame when reading, or write the motions with one that does not change";

impl<'p> Values<'p> {
    /// With what the caller states.
    pub(crate) fn new(
        files: &'p [TokenFile<'p>],
        symbols: Symbols<'p>,
        options: &ReadOptions,
    ) -> Self {
        let stated = options.frames.iter();
        let stated = stated.filter_map(|(name, frame)| Some((Name::of(name.as_bytes())?, *frame)));
        Self {
            files,
            symbols,
            stated: stated.collect(),
            frames: BTreeMap::new(),
            speeds: BTreeMap::new(),
            zones: BTreeMap::new(),
            assigned_speeds: AssignedSpeeds::default(),
        }
    }

    fn constants(&self) -> Constants<'_, 'p> {
        Constants {
            symbols: &self.symbols,
            files: self.files,
        }
    }

    /// The first value of a datum, in its file.
    pub(crate) fn initial(&self, index: usize) -> Option<Expression> {
        self.constants().declared(index)
    }

    /// An expression of a routine in numbers alone; none where the run of the program says one of them.
    pub(crate) fn in_numbers(&self, routine: usize, expression: &Expression) -> Option<Expression> {
        self.constants().numbers_in(routine, expression)
    }

    /// That something is changed at run time, as said in a file.
    pub(crate) fn changed(&self, text: &str, here: usize, file: usize, line: usize) -> String {
        match here == file {
            true => format!("`{text}` is changed while the program runs (line {line})"),
            false => {
                let file = self.files[file].source.name();
                format!("`{text}` is changed while the program runs ({file}, line {line})")
            }
        }
    }

    /// The datum of a name in a routine, if it is one.
    fn datum(&self, routine: usize, name: &Name) -> Option<usize> {
        match self.symbols.meaning(routine, name)? {
            Meaning::Datum(index) => Some(index),
            Meaning::Parameter => None,
        }
    }

    /// A number: written, or of a constant.
    pub(crate) fn number(&self, routine: usize, expression: &Expression) -> Option<f64> {
        match &expression.value {
            Value::Number(value) => Some(*value),
            Value::Word(name) => {
                let index = self.datum(routine, name)?;
                let node = self.symbols.data[index].node;
                let fixed = node.change == Change::Constant && node.type_name.is("NUM");
                match fixed.then(|| self.in_numbers(routine, expression))??.value {
                    Value::Number(value) => Some(value),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The tool or work object that an expression names.
    pub(crate) fn frame(
        &mut self,
        routine: usize,
        role: Role,
        expression: &Expression,
        text: String,
    ) -> Result<FrameUse, Reason> {
        let known = |frame| FrameUse {
            name: text.clone(),
            frame: Frame::Known(frame),
        };
        let Value::Word(name) = &expression.value else {
            if let Value::List(_) = expression.value {
                return Ok(FrameUse {
                    frame: literal(role, expression)?,
                    name: text,
                });
            }
            let reason = "it is not a name or a literal".to_owned();
            return Ok(FrameUse {
                name: text,
                frame: Frame::Unknown { reason },
            });
        };
        if let Some(frame) = self.stated.get(name) {
            return Ok(known(*frame));
        }
        match self.symbols.meaning(routine, name) {
            Some(Meaning::Parameter) => {
                let reason = format!(
                    "`{text}` is an argument of the routine: it may differ from call to call"
                );
                Err((reason, STATE_IT))
            }
            None if role == Role::Tool && name.is("TOOL0")
                || role == Role::WorkObject && name.is("WOBJ0") =>
            {
                Ok(known(Isometry3::identity()))
            }
            None => {
                let reason = format!("`{text}` is not declared in these files");
                Ok(FrameUse {
                    name: text,
                    frame: Frame::Unknown { reason },
                })
            }
            Some(Meaning::Datum(index)) => {
                if !self.frames.contains_key(&index) {
                    let found =
                        self.declared(role, index, &text, self.symbols.routines[routine].file);
                    self.frames
                        .insert(index, found.map(|frame| FrameUse { name: text, frame }));
                }
                self.frames[&index].clone()
            }
        }
    }

    fn declared(&self, role: Role, index: usize, text: &str, from: usize) -> Result<Frame, Reason> {
        if !self.symbols.is_fixed(index)
            && let Some((file, line)) = self.symbols.data[index].assigned
        {
            return Err((self.changed(text, from, file, line), STATE_IT));
        }
        match self.initial(index) {
            Some(initial) => literal(role, &initial),
            None => Ok(Frame::Unknown {
                reason: format!("`{text}` is declared without a value"),
            }),
        }
    }

    /// TCP speed in mm/s and the three others, if known.
    pub(crate) fn speed(&mut self, routine: usize, expression: &Expression) -> Option<[f64; 4]> {
        let name = match &expression.value {
            Value::Word(name) => name,
            _ => return values(&self.in_numbers(routine, expression)?),
        };
        match self.symbols.meaning(routine, name) {
            None => predefined_speed(name),
            Some(Meaning::Parameter) => None,
            Some(Meaning::Datum(index)) => {
                if let Some(known) = self.speeds.get(&index) {
                    return *known;
                }
                if !self.symbols.is_fixed(index) {
                    return self.assigned_speeds.held(&self.symbols, (routine, index));
                }
                let found = self.first_speed(index);
                self.speeds.insert(index, found);
                found
            }
        }
    }

    /// The speed with which a datum is declared.
    pub(crate) fn first_speed(&self, index: usize) -> Option<[f64; 4]> {
        values(&self.initial(index)?)
    }

    /// A zone.
    pub(crate) fn zone(&mut self, routine: usize, expression: &Expression) -> Zone {
        let name = match &expression.value {
            Value::Word(name) => name,
            _ => return literal_zone(expression),
        };
        match self.symbols.meaning(routine, name) {
            None => predefined_zone(name),
            Some(Meaning::Parameter) => Zone::Unstated,
            Some(Meaning::Datum(index)) => {
                if let Some(known) = self.zones.get(&index) {
                    return *known;
                }
                let initial = self
                    .symbols
                    .is_fixed(index)
                    .then(|| self.initial(index))
                    .flatten();
                let zone = initial.map_or(Zone::Unstated, |initial| literal_zone(&initial));
                self.zones.insert(index, zone);
                zone
            }
        }
    }
}

/// `[robhold, tframe, tload]` or `[robhold, ufprog, ufmec, uframe, oframe]`.
fn literal(role: Role, expression: &Expression) -> Result<Frame, Reason> {
    let Value::List(parts) = &expression.value else {
        return Ok(Frame::Unknown {
            reason: "it is not a literal".to_owned(),
        });
    };
    let truth = |part: &Expression| match part.value {
        Value::Truth(value) => Some(value),
        _ => None,
    };
    let found = match (role, parts.as_slice()) {
        (Role::Tool, [hold, frame, _]) => {
            if truth(hold) == Some(false) {
                return Err((
                    "the tool stands still and the robot holds the work piece".to_owned(),
                    "such programs are not corrected: take them out",
                ));
            }
            truth(hold).and_then(|_| frame_of(frame))
        }
        (Role::WorkObject, [hold, fixed, _, user, object]) => {
            if truth(hold) == Some(true) {
                return Err((
                    "the robot holds the work object".to_owned(),
                    "such programs are not corrected: take them out",
                ));
            }
            if truth(fixed) == Some(false) {
                return Err((
                    "the work object's user frame moves with a mechanical unit".to_owned(),
                    "a moving work piece is not corrected: take these motions into a program of their own",
                ));
            }
            frame_of(user).and_then(|user| Some(user * frame_of(object)?))
        }
        _ => None,
    };
    Ok(found.map_or_else(
        || Frame::Unknown {
            reason: "its declaration is not the literal of a tool or work object".to_owned(),
        },
        Frame::Known,
    ))
}

/// `v100` and its kin: 500 degrees/s, 5000 mm/s, 1000 degrees/s with each.
fn predefined_speed(name: &Name) -> Option<[f64; 4]> {
    const SPEEDS: [u32; 25] = [
        5, 10, 20, 30, 40, 50, 60, 80, 100, 150, 200, 300, 400, 500, 600, 800, 1000, 1500, 2000,
        2500, 3000, 4000, 5000, 6000, 7000,
    ];
    let number = number_behind(name, b"V").filter(|number| SPEEDS.contains(number))?;
    Some([f64::from(number), 500.0, 5000.0, 1000.0])
}

/// `fine`, `z10` and its kin.
fn predefined_zone(name: &Name) -> Zone {
    const ZONES: [u32; 14] = [0, 1, 5, 10, 15, 20, 30, 40, 50, 60, 80, 100, 150, 200];
    match number_behind(name, b"Z").filter(|number| ZONES.contains(number)) {
        Some(0) => Zone::Radius(0.3),
        Some(number) => Zone::Radius(f64::from(number)),
        None if name.is("FINE") => Zone::Exact,
        None => Zone::Unstated,
    }
}

fn number_behind(name: &Name, letter: &[u8]) -> Option<u32> {
    let digits = std::str::from_utf8(name.letters().strip_prefix(letter)?).ok()?;
    digits.parse().ok()
}

/// `[finep, pzone_tcp, ...]`.
fn literal_zone(expression: &Expression) -> Zone {
    let Value::List(parts) = &expression.value else {
        return Zone::Unstated;
    };
    match parts.as_slice() {
        [
            Expression {
                value: Value::Truth(true),
                ..
            },
            ..,
        ] => Zone::Exact,
        [
            _,
            Expression {
                value: Value::Number(radius),
                ..
            },
            ..,
        ] => Zone::Radius(*radius),
        _ => Zone::Unstated,
    }
}
