//! Tools and bases: what the text or the caller says they are.

use std::ops::Range;

use nalgebra::{Isometry3, Translation3};

use crate::krl::aggregate::{Position, literal_index, position_of};
use crate::krl::lex::TokenFile;
use crate::krl::values::{Values, key};
use crate::model::frame::{Frame, FrameUse};
use crate::model::orientation::OrientationText;

/// What a frame is used as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    Tool,
    Base,
}

impl Role {
    /// The array of the numbered ones.
    pub(crate) fn array(self) -> &'static str {
        match self {
            Self::Tool => "TOOL_DATA",
            Self::Base => "BASE_DATA",
        }
    }

    /// The one in force.
    pub(crate) fn variable(self) -> &'static str {
        match self {
            Self::Tool => "$TOOL",
            Self::Base => "$BASE",
        }
    }
}

/// The pose of six numbers.
pub(crate) fn isometry(numbers: [f64; 6]) -> Option<Isometry3<f64>> {
    let [x, y, z, a, b, c] = numbers;
    let rotation = OrientationText::Abc.rotation_of(&[a, b, c])?;
    Some(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
}

fn whole(position: &Position) -> Option<Isometry3<f64>> {
    match position.values() {
        [Some(x), Some(y), Some(z), Some(a), Some(b), Some(c)] => isometry([x, y, z, a, b, c]),
        _ => None,
    }
}

impl Values<'_> {
    /// A frame that the caller states by its name.
    pub(crate) fn stated(&self, name: &str) -> Option<FrameUse> {
        let frame = *self.stated.get(&key(name))?;
        Some(FrameUse {
            name: name.to_owned(),
            frame: Frame::Known(frame),
        })
    }

    /// `TOOL_DATA[n]` or `BASE_DATA[n]`; number 0 is the flange or the world.
    pub(crate) fn numbered(&self, role: Role, number: u32) -> FrameUse {
        let name = format!("{}[{number}]", role.array());
        if let Some(stated) = self.stated(&name) {
            return stated;
        }
        let frame = match self.known(role, number) {
            Ok(frame) => Frame::Known(frame),
            Err(reason) => Frame::Unknown { reason },
        };
        FrameUse { name, frame }
    }

    fn known(&self, role: Role, number: u32) -> Result<Isometry3<f64>, String> {
        if number == 0 {
            return Ok(Isometry3::identity());
        }
        let nowhere = || "none of these files states it: give $config.dat, or state it".to_owned();
        let datum = self.symbols.of_system(role.array()).ok_or_else(nowhere)?;
        let stated = datum.stated.get(&number).ok_or_else(nowhere)?;
        if let Some((_, line)) = datum.assigned.or(stated.assigned) {
            return Err(format!(
                "it is assigned while the program runs, in line {line}"
            ));
        }
        let position = position_of(&self.files[datum.file], &stated.value);
        let frame = position.ok().and_then(|position| whole(&position));
        frame.ok_or_else(|| "its numbers are not all stated".to_owned())
    }

    /// The frame that an expression is: sums of frames are one behind the other.
    pub(crate) fn frame(&self, routine: usize, tokens: &Range<usize>) -> FrameUse {
        let file = self.file(routine);
        let name = key(&file.text(tokens));
        if let Some(stated) = self.stated(&name) {
            return stated;
        }
        for role in [Role::Tool, Role::Base] {
            if let Some(number) = self.number_in(file, role, tokens) {
                return self.numbered(role, number);
            }
        }
        let mut frame = Isometry3::identity();
        let mut at = tokens.start;
        while at < tokens.end {
            let end = file.find(at..tokens.end, b':').unwrap_or(tokens.end);
            match self.part(routine, &(at..end)) {
                Ok(part) => frame *= part,
                Err(reason) => {
                    return FrameUse {
                        name,
                        frame: Frame::Unknown { reason },
                    };
                }
            }
            at = end + 1;
        }
        FrameUse {
            name,
            frame: Frame::Known(frame),
        }
    }

    /// The number in `TOOL_DATA[3]`.
    fn number_in(&self, file: &TokenFile<'_>, role: Role, tokens: &Range<usize>) -> Option<u32> {
        let is_array = file.name(tokens.start)?.is(role.array());
        (is_array && tokens.len() > 1).then(|| literal_index(file, tokens.start + 1..tokens.end))?
    }

    fn part(&self, routine: usize, tokens: &Range<usize>) -> Result<Isometry3<f64>, String> {
        let file = self.file(routine);
        let computed = || "it is computed while the program runs".to_owned();
        if file.is(tokens.start, b'{') {
            let position = position_of(file, tokens).map_err(str::to_owned)?;
            return whole(&position).ok_or_else(|| "its numbers are not all stated".to_owned());
        }
        let name = file.name(tokens.start).ok_or_else(computed)?;
        if tokens.len() == 1 && (name.is("$NULLFRAME") || name.is("$WORLD")) {
            return Ok(Isometry3::identity());
        }
        if let Some(stated) = self.stated.get(&key(&file.text(tokens))) {
            return Ok(*stated);
        }
        for role in [Role::Tool, Role::Base] {
            if let Some(number) = self.number_in(file, role, tokens) {
                return self.known(role, number);
            }
        }
        let (datum, stated) = self.datum(routine, tokens).map_err(|(reason, _)| reason)?;
        let position =
            position_of(&self.files[datum.file], &stated.value).map_err(str::to_owned)?;
        whole(&position).ok_or_else(|| "its numbers are not all stated".to_owned())
    }
}
