//! Values in braces: `{X 1.0,Y 2.0,S 2,T 35}`, with or without the name of the type.

use std::ops::Range;

use crate::krl::lex::{Kind, TokenFile};
use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::model::target::Configuration;
use crate::text::name::Name;
use crate::text::number::{NumberText, Width, values_of};

/// Members and the tokens of their values.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Aggregate {
    members: Vec<(Name, Range<usize>)>,
}

/// The members of a value in braces; none where it is none.
pub(crate) fn aggregate_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<Aggregate> {
    if tokens.len() < 2 || !file.is(tokens.start, b'{') || !file.is(tokens.end - 1, b'}') {
        return None;
    }
    let inside = tokens.start + 1..tokens.end - 1;
    let typed = file.is(inside.start + 1, b':');
    let mut at = inside.start + 2 * usize::from(typed);
    let mut members = Vec::with_capacity(14);
    while at < inside.end {
        let end = file.find(at..inside.end, b',').unwrap_or(inside.end);
        let name = file.name(at)?;
        let is_text = file.is(at + 1, b'[') && file.is(at + 2, b']');
        let value = at + 1 + 2 * usize::from(is_text)..end;
        // Without a blank between them another number could grow into the name; digits in quotation marks are no name.
        let touches = file.span(&value).start == file.span(&(at..value.start)).end;
        if value.is_empty() || (touches && file.tokens[value.start].kind != Kind::Bits) {
            return None;
        }
        members.push((name, value));
        at = end + 1;
    }
    Some(Aggregate { members })
}

impl Aggregate {
    /// The value of a member.
    pub(crate) fn member(&self, capitals: &str) -> Option<&Range<usize>> {
        let found = self.members.iter().find(|(name, _)| name.is(capitals));
        found.map(|(_, value)| value)
    }

    /// A member that is a number.
    pub(crate) fn number(&self, file: &TokenFile<'_>, capitals: &str) -> Option<f64> {
        number_of(file, self.member(capitals)?)
    }
}

/// A number with its sign, or digits of base 2 or 16.
pub(crate) fn number_of(file: &TokenFile<'_>, tokens: &Range<usize>) -> Option<f64> {
    let signed = usize::from(
        tokens.len() == 2 && (file.is(tokens.start, b'-') || file.is(tokens.start, b'+')),
    );
    if tokens.len() != 1 + signed {
        return None;
    }
    let at = tokens.start + signed;
    let text = std::str::from_utf8(file.word(at)).ok()?;
    let value: f64 = match file.tokens.get(at)?.kind {
        Kind::Number => text.parse().ok()?,
        Kind::Bits => {
            let base = match text.as_bytes().get(1)? {
                b'B' | b'b' => 2,
                _ => 16,
            };
            u32::from_str_radix(text.get(2..text.len() - 1)?, base)
                .ok()?
                .into()
        }
        _ => return None,
    };
    let value = match signed == 1 && file.is(tokens.start, b'-') {
        true => -value,
        false => value,
    };
    value.is_finite().then_some(value)
}

/// What a position in braces states.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Position {
    /// The whole literal in its file.
    pub whole: Range<usize>,
    /// X, Y, Z, A, B, C.
    pub numbers: [Option<NumberText>; 6],
    /// S and T.
    pub configuration: Configuration,
    /// E1 to E6; empty where none is stated.
    pub external: Vec<Option<NumberText>>,
    /// A1 to A6.
    pub axes: [Option<f64>; 6],
}

const PLACE: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];
const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];
const EXTERNAL: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];

/// Larger than a length in mm or an angle in degrees of any robot.
const LARGEST: f64 = 1e7;

/// The position that tokens are; why they are none.
pub(crate) fn position_of(
    file: &TokenFile<'_>,
    tokens: &Range<usize>,
) -> Result<Position, &'static str> {
    let aggregate = aggregate_of(file, tokens).ok_or("it is no position in braces")?;
    let mut position = Position {
        whole: file.span(tokens),
        ..Position::default()
    };
    for (name, value) in &aggregate.members {
        let of_this_name = |other: &&(Name, Range<usize>)| other.0 == *name;
        if aggregate.members.iter().filter(of_this_name).count() > 1 {
            return Err("it states a component twice");
        }
        position.set(file, name, value)?;
    }
    Ok(position)
}

impl Position {
    /// Gives a member the number that tokens are.
    pub(crate) fn set(
        &mut self,
        file: &TokenFile<'_>,
        name: &Name,
        value: &Range<usize>,
    ) -> Result<(), &'static str> {
        let number =
            number_of(file, value).ok_or("its numbers are computed while the program runs")?;
        if number.abs() > LARGEST {
            return Err("its numbers are larger than any robot needs");
        }
        let text = NumberText {
            span: file.span(value),
            value: number,
        };
        let slot = |names: [&str; 6]| names.iter().position(|capitals| name.is(capitals));
        if let Some(index) = slot(PLACE) {
            self.numbers[index] = Some(text);
        } else if let Some(index) = slot(AXES) {
            self.axes[index] = Some(number);
        } else if let Some(index) = slot(EXTERNAL) {
            self.external.resize(EXTERNAL.len(), None);
            self.external[index] = Some(text);
        } else if name.is("S") || name.is("T") {
            if number.fract() != 0.0 || number < 0.0 {
                return Err("its S and T are not whole numbers of 0 and above");
            }
            let written = &mut self.configuration.text;
            if !written.is_empty() {
                written.push(',');
            }
            written.push_str(&file.text(&(value.start - 1..value.end)));
            self.configuration.numbers.push(number);
        } else {
            return Err("it has a member that no position has");
        }
        Ok(())
    }

    /// Without some of its members.
    pub(crate) fn without(mut self, members: &[Name]) -> Self {
        let is_left = |capitals: &str| !members.iter().any(|name| name.is(capitals));
        for index in 0..PLACE.len() {
            self.numbers[index].take_if(|_| !is_left(PLACE[index]));
            self.axes[index].take_if(|_| !is_left(AXES[index]));
        }
        for (name, value) in EXTERNAL.iter().zip(&mut self.external) {
            value.take_if(|_| !is_left(name));
        }
        self
    }
    /// What it says of X, Y, Z, A, B, C.
    pub(crate) fn values(&self) -> [Option<f64>; 6] {
        self.numbers
            .each_ref()
            .map(|number| number.as_ref().map(|number| number.value))
    }

    /// External axes as stated.
    pub(crate) fn external_values(&self) -> Vec<Option<f64>> {
        values_of(&self.external)
    }

    /// Where its numbers stand; none where X, Y and Z are not all there, or only some of A, B, C.
    pub(crate) fn text(&self, file: usize) -> Option<PoseText> {
        let [Some(x), Some(y), Some(z), a, b, c] = self.numbers.clone() else {
            return None;
        };
        let (orientation, convention) = match (a, b, c) {
            (Some(a), Some(b), Some(c)) => (vec![a, b, c], OrientationText::Abc),
            (None, None, None) => (Vec::new(), OrientationText::Unstated),
            _ => return None,
        };
        Some(PoseText {
            file,
            whole: self.whole.clone(),
            position: [x, y, z],
            orientation,
            convention,
            external: self.external.clone(),
            width: Width::Free,
        })
    }
}

/// `[3]`, or nothing, which is 0; none for all else.
pub(crate) fn literal_index(file: &TokenFile<'_>, tokens: Range<usize>) -> Option<u32> {
    if tokens.is_empty() {
        return Some(0);
    }
    let is_number = tokens.len() == 3 && file.tokens[tokens.start + 1].kind == Kind::Number;
    let closed = file.is(tokens.start, b'[') && file.is(tokens.end - 1, b']');
    let text = std::str::from_utf8(file.word(tokens.start + 1)).ok()?;
    (is_number && closed).then(|| text.parse().ok())?
}
