//! State of a run beside its data: transformations, and the frames and tools in which they are; each has a father, up to `world` or `flange`.
//!
//! Source: Staubli, VAL3 Reference Manual, the pages of `trsf`, `frame`, `tool` and `point`: rx, ry, rz turn about X, the new Y and the
//! new Z, in degrees.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Translation3};

use crate::interpreter::expression::Expression;
use crate::interpreter::run;
use crate::interpreter::run::{Reason, Root};
use crate::interpreter::symbols::Symbols;
use crate::interpreter::token::TokenFile;
use crate::interpreter::value::{Datum, Step, Value};
use crate::model::motion::{Frame, FrameUse};
use crate::model::orientation::OrientationText;
use crate::options::ReadOptions;
use crate::text::Name;

/// Limit of the ancestors of a frame.
const DEEPEST: usize = 12;

/// The six numbers of a transformation.
pub(super) fn trsf_of(numbers: [f64; 6]) -> Option<Isometry3<f64>> {
    let [x, y, z, turn @ ..] = numbers;
    let rotation = OrientationText::Xyz.rotation_of(&turn)?;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

/// A transformation as six numbers, near to others.
pub(super) fn numbers_of(trsf: &Isometry3<f64>, near: [f64; 3]) -> [f64; 6] {
    let turn = OrientationText::Xyz.numbers_of(&trsf.rotation, &near);
    let place = trsf.translation;
    [place.x, place.y, place.z, turn[0], turn[1], turn[2]]
}

/// The first element of an array: a name without an index means it.
pub(super) fn single(value: &Datum) -> &Datum {
    match value.parts().first() {
        Some(first) if !matches!(first.value, Value::Number(_) | Value::Unknown(_)) => first,
        _ => value,
    }
}

/// The transformation of a point, a frame or a tool, in its father.
pub(super) fn own_trsf(value: &Datum) -> Result<Isometry3<f64>, String> {
    if let Some(reason) = value.unknown_reason() {
        return Err(reason.to_string());
    }
    let numbers = value.member("TRSF").and_then(Datum::as_numbers::<6>);
    numbers
        .and_then(trsf_of)
        .ok_or_else(|| "it is no point, frame or tool with six numbers".to_owned())
}

/// The name of the father that a value states, with its index.
fn father_of(value: &Datum) -> Option<String> {
    let text = |name: &str| match &value.member(name)?.value {
        Value::Text(text) => Some(text.to_string()),
        Value::Number(number) => Some(number.to_string()),
        _ => None,
    };
    text("FATHERID").or_else(|| {
        let library = text("ALIAS").filter(|alias| !alias.is_empty());
        let library = library.map_or_else(String::new, |alias| format!("{alias}:"));
        Some(format!(
            "{library}{}[{}]",
            text("NAME")?,
            text("FATHERINDEX")?
        ))
    })
}

impl Run<'_, '_> {
    /// The frame of a point.
    pub(super) fn frame_of(&mut self, point: &Datum) -> FrameUse {
        let Some(father) = father_of(point) else {
            let reason = "the point states no frame: state its fatherId in the data".to_owned();
            return FrameUse {
                name: "no frame".to_owned(),
                frame: Frame::Unknown { reason },
            };
        };
        let name = father.strip_suffix("[0]").unwrap_or(&father).to_owned();
        let frame = match self.origin(&father, 0) {
            Ok(frame) => Frame::Known(frame),
            Err(reason) => Frame::Unknown { reason },
        };
        FrameUse { name, frame }
    }

    /// The tool that an argument names.
    pub(super) fn tool(&mut self, expression: &Expression) -> Result<FrameUse, Reason> {
        let name = self.file().text(&expression.tokens);
        let value = self.value(expression);
        let value = single(&value);
        if let Some(frame) = Name::of(name.as_bytes()).and_then(|name| self.own.stated.get(&name)) {
            return Ok(FrameUse {
                name,
                frame: Frame::Known(*frame),
            });
        }
        if value.unknown_reason().is_none() && value.member("TRSF").is_none() {
            return Err((
                format!("`{name}` is no tool"),
                "write the name of a tool of the application",
            ));
        }
        let frame = match self.placed(value, 0) {
            Ok(frame) => Frame::Known(frame),
            Err(reason) => Frame::Unknown { reason },
        };
        Ok(FrameUse { name, frame })
    }

    /// A transformation in `world` or `flange`, by that of its father.
    pub(super) fn placed(&mut self, value: &Datum, depth: usize) -> Result<Isometry3<f64>, String> {
        let own = own_trsf(value)?;
        let father = father_of(value).ok_or("it states no father")?;
        Ok(self.origin(&father, depth + 1)? * own)
    }

    /// A frame or a tool by its name with its index, as the caller states it, or as the data of the application do.
    fn origin(&mut self, father: &str, depth: usize) -> Result<Isometry3<f64>, String> {
        let named = father.strip_suffix("[0]").unwrap_or(father);
        let (word, index) = named.split_once('[').unwrap_or((named, "0]"));
        let index = index.trim_end_matches(']').parse::<usize>().ok();
        let stated = |name: &str| self.own.stated.get(&Name::of(name.as_bytes())?);
        if let Some(frame) = stated(named) {
            return Ok(*frame);
        }
        if ["world", "flange"].contains(&named) {
            return Ok(Isometry3::identity());
        }
        if depth > DEEPEST {
            return Err(format!(
                "more than {DEEPEST} fathers stand above it, or they go round"
            ));
        }
        let datum = Name::of(word.as_bytes()).and_then(|name| self.symbols.datum_in(0, &name));
        let (Some(datum), Some(index)) = (datum, index) else {
            return Err(format!(
                "no frame or tool `{word}` is declared in these files"
            ));
        };
        self.note_use(Root::Module(datum), Some(Step::Index(index)));
        let value = self
            .stored(Root::Module(datum))
            .unwrap_or_else(|| Datum::unknown("it has no value"));
        let none = Datum::unknown(format!("`{word}` has no such element"));
        let element = match value.parts() {
            [] if index == 0 => &value,
            parts => parts.get(index).unwrap_or(&none),
        };
        self.placed(element, depth)
    }
}

/// A run of a VAL3 program.
pub(super) type Run<'r, 'p> = run::Run<'r, 'p, Val3>;

/// What a run keeps beside its data.
pub(crate) struct Val3 {
    /// Frames that the caller states.
    pub stated: BTreeMap<Name, Isometry3<f64>>,
    /// Motions were commanded, and nothing waited for their ends.
    pub is_moving: bool,
}

impl Val3 {
    /// A run that has not begun.
    pub(super) fn run<'r, 'p>(
        files: &'p [TokenFile<'p>],
        symbols: &'r Symbols<'p>,
        options: &'r ReadOptions,
    ) -> Run<'r, 'p> {
        let stated = options.frames.iter();
        let stated = stated.filter_map(|(name, frame)| Some((Name::of(name.as_bytes())?, *frame)));
        let own = Self {
            stated: stated.collect(),
            is_moving: false,
        };
        Run::new(files, symbols, options, own)
    }
}
