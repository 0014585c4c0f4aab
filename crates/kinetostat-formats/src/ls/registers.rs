//! Position registers, frames and tools to which the program gives values: `PR[9,1]=250`, `PR[1]=P[2]`, `UTOOL[9]=PR[9]`, `OFFSET CONDITION
//! PR[1]`.
//!
//! Source: FANUC, R-30iB controller, operator's manual (basic operation), chapter 4, position register instructions, frame instructions,
//! offset instructions.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Vector3};

use crate::ls::words::{Kind, Word, index_of, words_of};
use crate::model::orientation::OrientationText;
use crate::model::site::OffsetAxes;

/// What holds X, Y, Z, W, P and R, by its number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place {
    Register(u32),
    Frame(u32),
    Tool(u32),
    /// A position of the program, to which no value is given.
    Position(u32),
}

/// What a statement gives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Given {
    /// One of X, Y, Z, W, P, R of a register; none where it is computed.
    Part(u32, usize, Option<f64>),
    /// The value of another place; none where it is computed.
    Whole(Place, Option<Place>),
    /// The register by which motions are offset; none where it is not followed.
    Offset(OffsetAxes, Option<u32>),
    /// A register says which register gets a value.
    AnyRegister,
}

/// What a statement gives, with the bytes of its text.
pub(crate) fn given_by(bytes: &[u8], text: &Range<usize>) -> Option<Given> {
    let words = words_of(bytes, text);
    let part = |word: &Word| &bytes[word.span.clone()];
    if let Some(axes) = offset_condition(&bytes[text.clone()]) {
        // Another frame or tool than that in force may stand behind the register.
        let register = match words.as_slice() {
            [.., name, bracket] if part(name) == b"PR" && bracket.kind == Kind::Bracket => {
                index_of(bytes, &bracket.span).map(|(number, _)| number)
            }
            _ => None,
        };
        let is_alone = !words.iter().any(|word| word.kind == Kind::Symbol(b','));
        return Some(Given::Offset(axes, register.filter(|_| is_alone)));
    }
    let [name, bracket, equals, value @ ..] = words.as_slice() else {
        return None;
    };
    if bracket.kind != Kind::Bracket || equals.kind != Kind::Symbol(b'=') {
        return None;
    }
    if part(name) != b"PR" {
        let to = place_of(bytes, name, bracket)?;
        return Some(Given::Whole(to, whole_value(bytes, value)));
    }
    let number = |text: &[u8]| -> Option<u32> {
        let text = text.split(|byte| *byte == b':').next()?;
        std::str::from_utf8(text.trim_ascii()).ok()?.parse().ok()
    };
    let inside = bytes.get(bracket.span.start + 1..bracket.span.end - 1)?;
    let mut numbers = inside.splitn(2, |byte| *byte == b',');
    Some(
        match (numbers.next().and_then(number), numbers.next().map(number)) {
            (Some(register), None) => {
                Given::Whole(Place::Register(register), whole_value(bytes, value))
            }
            // Further parts are external axes.
            (Some(register), Some(Some(axis))) => match usize::try_from(axis) {
                Ok(axis @ 1..=6) => Given::Part(register, axis - 1, number_value(value)),
                _ => Given::Whole(Place::Register(register), Some(Place::Register(register))),
            },
            _ => Given::AnyRegister,
        },
    )
}

fn offset_condition(text: &[u8]) -> Option<OffsetAxes> {
    match text {
        text if text.starts_with(b"OFFSET CONDITION") => Some(OffsetAxes::WorkObject),
        text if text.starts_with(b"TOOL_OFFSET CONDITION") => Some(OffsetAxes::Tool),
        _ => None,
    }
}

/// `UFRAME[2]`, `UTOOL[1]`, `PR[3]`, `P[4]`.
fn place_of(bytes: &[u8], name: &Word, bracket: &Word) -> Option<Place> {
    let (number, _) = index_of(bytes, &bracket.span)?;
    match &bytes[name.span.clone()] {
        b"UFRAME" => Some(Place::Frame(number)),
        b"UTOOL" => Some(Place::Tool(number)),
        b"PR" => Some(Place::Register(number)),
        b"P" => Some(Place::Position(number)),
        _ => None,
    }
}

fn whole_value(bytes: &[u8], value: &[Word]) -> Option<Place> {
    match value {
        [name, bracket] if bracket.kind == Kind::Bracket => place_of(bytes, name, bracket),
        _ => None,
    }
}

/// `12.5`, `-12.5` and `(-12.5)`.
fn number_value(value: &[Word]) -> Option<f64> {
    let kinds: Vec<Kind> = value.iter().map(|word| word.kind).collect();
    match kinds.as_slice() {
        [Kind::Symbol(b'('), inner @ .., Kind::Symbol(b')')] => signed(inner),
        plain => signed(plain),
    }
}

fn signed(kinds: &[Kind]) -> Option<f64> {
    match kinds {
        [Kind::Number(value)] => Some(*value),
        [Kind::Symbol(b'-'), Kind::Number(value)] => Some(-value),
        _ => None,
    }
}

/// The value of a place, as far as the text says it; numbers by their bits, so that states can be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Value {
    parts: [Option<u64>; 6],
    /// It came whole from a pose; else that its numbers are X, Y, Z, W, P, R is not in the text.
    is_pose: bool,
}

impl Value {
    pub(crate) fn of(numbers: [f64; 6]) -> Self {
        Self {
            parts: numbers.map(bits),
            is_pose: true,
        }
    }

    /// X, Y, Z, W, P, R.
    fn numbers(&self) -> Option<[f64; 6]> {
        let mut numbers = [0.0; 6];
        for (number, part) in numbers.iter_mut().zip(self.parts) {
            *number = f64::from_bits(part?);
        }
        Some(numbers)
    }

    fn merged(self, other: Self) -> Self {
        let same = |at: usize| self.parts[at].filter(|_| self.parts[at] == other.parts[at]);
        Self {
            parts: std::array::from_fn(same),
            is_pose: self.is_pose && other.is_pose,
        }
    }
}

/// Zero has one sign.
fn bits(number: f64) -> Option<u64> {
    Some((number + 0.0).to_bits())
}

/// By how much a motion is offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shift {
    pub axes: OffsetAxes,
    pub by_mm: Vector3<f64>,
    pub register: u32,
    /// That the register holds X, Y, Z, W, P, R is taken, and not in the text.
    pub is_taken: bool,
}

/// What places hold before an instruction: what is not here is not known.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Default)]
pub(crate) struct Registers {
    values: BTreeMap<Place, Value>,
    /// In axes of the work object, and of the tool.
    conditions: [Option<u32>; 2],
}

impl Registers {
    /// Behind a statement; `positions` are those of the program.
    pub(crate) fn give(&mut self, given: &Given, positions: &BTreeMap<u32, Value>) {
        match given {
            Given::Part(register, at, value) => {
                let place = Place::Register(*register);
                self.values.entry(place).or_default().parts[*at] = value.and_then(bits);
                self.changes(*register);
            }
            Given::Whole(to, from) => {
                let value = from.and_then(|from| match from {
                    Place::Position(number) => positions.get(&number).copied(),
                    from => self.values.get(&from).copied(),
                });
                match value {
                    Some(value) => self.values.insert(*to, value),
                    None => self.values.remove(to),
                };
                if let Place::Register(register) = to {
                    self.changes(*register);
                }
            }
            Given::Offset(axes, register) => self.conditions[index_of_axes(*axes)] = *register,
            Given::AnyRegister => self.forget(),
        }
    }

    /// What a condition offsets by is not followed where its register gets another value.
    fn changes(&mut self, register: u32) {
        for condition in &mut self.conditions {
            *condition = condition.filter(|of| *of != register);
        }
    }

    /// Behind what may give any register a value.
    pub(crate) fn forget(&mut self) {
        (self.values).retain(|place, _| !matches!(place, Place::Register(_)));
        self.without_conditions();
    }

    /// In another program.
    pub(crate) fn without_conditions(&mut self) {
        self.conditions = [None, None];
    }

    /// The same in both.
    pub(crate) fn merged(&self, other: &Self) -> Self {
        let both = self.values.iter().filter_map(|(place, value)| {
            let other = other.values.get(place)?;
            Some((*place, value.merged(*other)))
        });
        Self {
            values: both.collect(),
            conditions: [0, 1].map(|at| {
                self.conditions[at].filter(|_| self.conditions[at] == other.conditions[at])
            }),
        }
    }

    /// Where a frame or tool is.
    pub(crate) fn pose(&self, place: Place) -> Option<Isometry3<f64>> {
        let [x, y, z, angles @ ..] = self.values.get(&place)?.numbers()?;
        let rotation = OrientationText::Wpr.rotation_of(&angles)?;
        Some(Isometry3::from_parts(
            Vector3::new(x, y, z).into(),
            rotation,
        ))
    }

    /// By how much a register offsets motions, or that of the condition: only a register that does not turn the tool.
    pub(crate) fn shift(&self, axes: OffsetAxes, register: Option<u32>) -> Option<Shift> {
        let register = register.or(self.conditions[index_of_axes(axes)])?;
        let value = self.values.get(&Place::Register(register))?;
        let [x, y, z, angles @ ..] = value.numbers()?;
        (angles == [0.0; 3]).then(|| Shift {
            axes,
            by_mm: Vector3::new(x, y, z),
            register,
            is_taken: !value.is_pose,
        })
    }
}

fn index_of_axes(axes: OffsetAxes) -> usize {
    match axes {
        OffsetAxes::WorkObject => 0,
        OffsetAxes::Tool => 1,
    }
}

/// All that places hold somewhere, each once.
#[derive(Debug)]
pub(crate) struct Pool {
    all: Vec<Registers>,
    known: BTreeMap<Registers, usize>,
}

impl Pool {
    /// The first of them holds the frames and tools that the caller states by their names (`UF:2`), and the world and the flange.
    pub(crate) fn of(frames: &BTreeMap<String, Isometry3<f64>>) -> Self {
        let mut first = Registers::default();
        let world = ("UF:0".to_owned(), Isometry3::identity());
        let flange = ("UT:0".to_owned(), Isometry3::identity());
        let stated = frames.iter().map(|(name, frame)| (name.clone(), *frame));
        for (name, frame) in [world, flange].into_iter().chain(stated) {
            let place = match name
                .split_once(':')
                .map(|(of, number)| (of, number.parse()))
            {
                Some(("UF", Ok(number))) => Place::Frame(number),
                Some(("UT", Ok(number))) => Place::Tool(number),
                _ => continue,
            };
            let angles = OrientationText::Wpr.numbers_of(&frame.rotation, &[]);
            let [w, p, r] = [0, 1, 2].map(|at| angles.get(at).copied().unwrap_or(f64::NAN));
            let [x, y, z] = frame.translation.vector.into();
            let value = Value::of([x, y, z, w, p, r]);
            first.values.insert(place, value);
        }
        Self {
            known: BTreeMap::from([(first.clone(), 0)]),
            all: vec![first],
        }
    }

    pub(crate) fn get(&self, index: usize) -> &Registers {
        &self.all[index]
    }

    /// What becomes of them.
    pub(crate) fn changed(&mut self, index: usize, change: impl FnOnce(&mut Registers)) -> usize {
        let mut changed = self.all[index].clone();
        change(&mut changed);
        self.index(changed)
    }

    /// The same in both.
    pub(crate) fn merged(&mut self, one: usize, other: usize) -> usize {
        match one == other {
            true => one,
            false => self.index(self.all[one].merged(&self.all[other])),
        }
    }

    fn index(&mut self, registers: Registers) -> usize {
        if let Some(index) = self.known.get(&registers) {
            return *index;
        }
        self.all.push(registers.clone());
        self.known.insert(registers, self.all.len() - 1);
        self.all.len() - 1
    }
}
