//! Positions and frames as values (`{X 1.0,Y 2.0,A 90,S 2,T 35}`), and the coordinates that an end takes over from the previous pose.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Value};
use crate::model::orientation::OrientationText;
use crate::model::site::PoseText;
use crate::model::target::{Configuration, PoseTarget};
use crate::text::Name;
use crate::text::number::{NumberText, Width};

pub(crate) const PLACE: [&str; 6] = ["X", "Y", "Z", "A", "B", "C"];
const AXES: [&str; 6] = ["A1", "A2", "A3", "A4", "A5", "A6"];
const EXTERNAL: [&str; 6] = ["E1", "E2", "E3", "E4", "E5", "E6"];

/// Larger than a length in mm or an angle in degrees of any robot.
const LARGEST: f64 = 1e7;

/// A number of a position, with its text where one states it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Member {
    pub value: f64,
    pub text: Option<NumberText>,
}

/// Members of a position.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Position {
    /// File and bytes of the literal, where all of it is one.
    pub whole: Option<(usize, Range<usize>)>,
    /// X, Y, Z, A, B, C.
    pub numbers: [Option<Member>; 6],
    /// S and T.
    pub configuration: Configuration,
    /// E1 to E6; empty where none is stated.
    pub external: Vec<Option<Member>>,
    /// A1 to A6.
    pub axes: [Option<f64>; 6],
}

/// The position that a value is; why it is none. `files` have the texts of its configuration.
pub(crate) fn position_of(files: &[TokenFile<'_>], datum: &Datum) -> Result<Position, String> {
    match &datum.value {
        Value::Members(members) if !members.is_empty() => {}
        Value::Unknown(reason) => return Err(reason.to_string()),
        _ => return Err("it is no position in braces".to_owned()),
    }
    let mut position = Position {
        whole: datum.literal.map(|literal| (literal.file, literal.span())),
        ..Position::default()
    };
    for (name, value) in datum.members() {
        let same = datum.members().iter().filter(|(other, _)| other == name);
        if same.count() > 1 {
            return Err("it states a component twice".to_owned());
        }
        position.set(files, datum, name, value)?;
    }
    Ok(position)
}

impl Position {
    /// Takes a member.
    fn set(
        &mut self,
        files: &[TokenFile<'_>],
        whole: &Datum,
        name: &Name,
        value: &Datum,
    ) -> Result<(), String> {
        if let Some(reason) = value.unknown_reason() {
            return Err(reason.to_string());
        }
        let number = value.as_number().ok_or("its numbers are no numbers")?;
        if number.abs() > LARGEST {
            return Err("its numbers are larger than any robot needs".to_owned());
        }
        let literal = value.literal.filter(|own| {
            let whole = whole.literal;
            whole.is_some_and(|whole| own.is_within(whole.file, &whole.span()))
        });
        let member = Member {
            value: number,
            text: literal.map(|literal| NumberText {
                span: literal.span(),
                value: number,
            }),
        };
        let slot = |names: [&str; 6]| names.iter().position(|capitals| name.is(capitals));
        if let Some(index) = slot(PLACE) {
            self.numbers[index] = Some(member);
        } else if let Some(index) = slot(AXES) {
            self.axes[index] = Some(number);
        } else if let Some(index) = slot(EXTERNAL) {
            self.external.resize(EXTERNAL.len(), None);
            self.external[index] = Some(member);
        } else if name.is("S") || name.is("T") {
            if number.fract() != 0.0 || number < 0.0 {
                return Err("its S and T are not whole numbers of 0 and above".to_owned());
            }
            let written = value.literal.and_then(|literal| {
                let file = files.get(literal.file)?;
                Some(String::from_utf8_lossy(file.source.part(&literal.span())).into_owned())
            });
            let written = written.unwrap_or_else(|| number.to_string());
            let configuration = &mut self.configuration;
            if !configuration.text.is_empty() {
                configuration.text.push(',');
            }
            let letters = String::from_utf8_lossy(name.letters());
            configuration.text.push_str(&format!("{letters} {written}"));
            configuration.numbers.push(number);
        } else {
            return Err("it has a member that no position has".to_owned());
        }
        Ok(())
    }

    /// Values of X, Y, Z, A, B, C.
    pub(crate) fn coordinates(&self) -> [Option<f64>; 6] {
        let value = |number: &Option<Member>| number.as_ref().map(|number| number.value);
        self.numbers.each_ref().map(value)
    }

    /// External axes as stated.
    pub(crate) fn external_values(&self) -> Vec<Option<f64>> {
        let axes = self.external.iter();
        axes.map(|axis| axis.as_ref().map(|axis| axis.value))
            .collect()
    }

    /// Texts of X, Y, Z, A, B, C, where all that it states stand in its literal.
    pub(crate) fn texts(&self) -> Option<[Option<NumberText>; 6]> {
        let is_computed = |number: &&Member| number.text.is_none();
        let external = self.external.iter().flatten();
        if self
            .numbers
            .iter()
            .flatten()
            .chain(external)
            .any(|of| is_computed(&of))
        {
            return None;
        }
        let text = |number: &Option<Member>| number.as_ref().and_then(|own| own.text.clone());
        Some(self.numbers.each_ref().map(text))
    }

    /// Text position of its numbers; `None` unless X, Y and Z are all present, and A, B, C all or none.
    pub(crate) fn text(&self) -> Option<PoseText> {
        let (file, whole) = self.whole.clone()?;
        let [Some(x), Some(y), Some(z), a, b, c] = self.texts()? else {
            return None;
        };
        let (orientation, convention) = match (a, b, c) {
            (Some(a), Some(b), Some(c)) => (vec![a, b, c], OrientationText::Abc),
            (None, None, None) => (Vec::new(), OrientationText::Unstated),
            _ => return None,
        };
        let external = self.external.iter();
        Some(PoseText {
            file,
            whole,
            position: [x, y, z],
            orientation,
            unit_mm: 1.0,
            convention,
            external: external
                .map(|axis| axis.as_ref().and_then(|axis| axis.text.clone()))
                .collect(),
            width: Width::Free,
        })
    }

    /// The frame, where all six numbers are stated.
    pub(crate) fn frame(&self) -> Option<Isometry3<f64>> {
        match self.coordinates() {
            [Some(x), Some(y), Some(z), Some(a), Some(b), Some(c)] => isometry([x, y, z, a, b, c]),
            _ => None,
        }
    }

    /// The pose without the members that it leaves open, and those that it states where that is not all.
    pub(crate) fn pose(&self) -> (PoseTarget, Option<[Option<f64>; 6]>) {
        let values = self.coordinates();
        let is_whole = values.iter().all(Option::is_some);
        let numbers = values.map(Option::unwrap_or_default);
        let frame = isometry(numbers).unwrap_or_else(Isometry3::identity);
        let pose = PoseTarget {
            position_mm: frame.translation.vector,
            orientation: frame.rotation,
            configuration: self.configuration.clone(),
            external: self.external_values(),
        };
        (pose, (!is_whole).then_some(values))
    }
}

/// The pose of six numbers.
pub(crate) fn isometry(numbers: [f64; 6]) -> Option<Isometry3<f64>> {
    let [x, y, z, a, b, c] = numbers;
    let rotation = OrientationText::Abc.rotation_of(&[a, b, c])?;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

/// A, B and C of a rotation, degrees.
pub(crate) fn angles_of(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let near = OrientationText::Abc.numbers_of(rotation, &[0.0; 3]);
    [0, 1, 2].map(|index| near.get(index).copied().unwrap_or_default())
}

/// The value of a frame.
pub(crate) fn datum_of(frame: &Isometry3<f64>) -> Datum {
    let place = frame.translation.vector;
    let [a, b, c] = angles_of(&frame.rotation);
    let values = [place.x, place.y, place.z, a, b, c].map(Datum::number);
    let members = PLACE.iter().zip(values);
    let members = members.filter_map(|(name, value)| Some((Name::of(name.as_bytes())?, value)));
    Datum::of(Value::Members(members.collect::<Vec<_>>().into()))
}

/// A, B and C of an orientation as a controller says them: B no farther than 90 degrees.
pub(crate) fn kept_angles(orientation: &UnitQuaternion<f64>) -> [f64; 3] {
    let [a, b, c] = angles_of(orientation);
    let other = |angle: f64| match angle > 0.0 {
        true => angle - 180.0,
        false => angle + 180.0,
    };
    let angles = match b.abs() > 90.0 {
        true => [other(a), 180.0_f64.copysign(b) - b, other(c)],
        false => [a, b, c],
    };
    // Half a turn is 180 degrees, also where the last bit says -180.
    angles.map(|angle| match angle < HALF_TURN_DEG {
        true => angle + 360.0,
        false => angle,
    })
}

/// Half a turn backward, with the last bits that a rotation loses, degrees.
const HALF_TURN_DEG: f64 = 1e-9 - 180.0;

/// Tolerance of B about 90 degrees: from there on, omitted angles may differ from those that were written.
const NEAR_BEYOND_DEG: f64 = 1e-6;

/// True if the controller may express the same orientation with another A and C at this B.
pub(crate) fn is_beyond(b: f64) -> bool {
    b.is_nan() || b.abs() > 90.0 - NEAR_BEYOND_DEG
}

/// Fills in what a position leaves open from the pose of before; none where that is not certain.
pub(crate) fn completed(
    open: &[Option<f64>; 6],
    before: &PoseTarget,
    is_beyond: bool,
) -> Option<(Vector3<f64>, UnitQuaternion<f64>)> {
    let place = [0, 1, 2].map(|axis| open[axis].unwrap_or(before.position_mm[axis]));
    let turn = match (open[3], open[4], open[5]) {
        (None, None, None) => before.orientation,
        (Some(a), Some(b), Some(c)) => OrientationText::Abc.rotation_of(&[a, b, c])?,
        _ if is_beyond => return None,
        (a, b, c) => {
            let kept = kept_angles(&before.orientation);
            let angles = [0, 1, 2].map(|index| [a, b, c][index].unwrap_or(kept[index]));
            OrientationText::Abc.rotation_of(&angles)?
        }
    };
    Some((Vector3::from(place), turn))
}
