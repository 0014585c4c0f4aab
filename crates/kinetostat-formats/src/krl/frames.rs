//! Tools, bases and the data of inline forms: what the text or the caller says they are.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::{Isometry3, Translation3};

use crate::krl::aggregate::{Aggregate, Position, aggregate_of, number_of, position_of};
use crate::krl::lex::TokenFile;
use crate::krl::parser::literal_index;
use crate::krl::symbols::{Datum, Meaning, Stated, Symbols};
use crate::krl::usage::place_of;
use crate::model::frame::{Frame, FrameUse};
use crate::model::orientation::OrientationText;
use crate::options::ReadOptions;

/// Why something is refused, and what to do.
pub(crate) type Reason = (String, &'static str);

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

/// What a FDAT states.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PointData {
    pub tool: Option<u32>,
    pub base: Option<u32>,
    /// The tool stands still and the part is in the hand.
    pub is_external: bool,
}

/// Files, names, and what the caller states.
pub(crate) struct Values<'p> {
    pub files: &'p [TokenFile<'p>],
    pub symbols: Symbols<'p>,
    stated: BTreeMap<String, Isometry3<f64>>,
}

/// A name as the caller may write it: without blanks, in capitals.
fn key(name: &str) -> String {
    let letters = name.chars().filter(|letter| !letter.is_whitespace());
    letters.collect::<String>().to_uppercase()
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

impl<'p> Values<'p> {
    pub(crate) fn new(
        files: &'p [TokenFile<'p>],
        symbols: Symbols<'p>,
        options: &ReadOptions,
    ) -> Self {
        let stated = options
            .frames
            .iter()
            .map(|(name, frame)| (key(name), *frame))
            .collect();
        Self {
            files,
            symbols,
            stated,
        }
    }

    /// The file of a routine.
    pub(crate) fn file(&self, routine: usize) -> &'p TokenFile<'p> {
        &self.files[self.symbols.routines[routine].file]
    }

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

    /// The datum that a name or an element is, with its one value; why it has none.
    pub(crate) fn datum(
        &self,
        routine: usize,
        tokens: &Range<usize>,
    ) -> Result<(&Datum, &Stated), Reason> {
        let file = self.file(routine);
        let computed = || {
            (
                "where it goes is computed while the program runs".to_owned(),
                WRITE_IT,
            )
        };
        let name = file.name(tokens.start).ok_or_else(computed)?;
        let (place, element) = place_of(file, tokens.start, tokens.end);
        let element = element.ok_or_else(computed)?;
        if place != *tokens {
            return Err(computed());
        }
        let shown = file.text(&(tokens.start..tokens.start + 1));
        let index = match self.symbols.meaning(routine, &name) {
            Some(Meaning::Datum(index)) => index,
            Some(Meaning::Parameter) => {
                let reason = format!(
                    "`{shown}` is an argument of the routine: it differs from call to call"
                );
                return Err((
                    reason,
                    "write the motion where the routine is called, with its target",
                ));
            }
            None if shown.starts_with('$') => return Err(computed()),
            None => {
                let reason = format!("no `{shown}` is declared in these files");
                return Err((
                    reason,
                    "give the .dat file that declares it as well (or $config.dat)",
                ));
            }
        };
        let datum = &self.symbols.data[index];
        let stated = datum.stated.get(&element);
        if let Some((at, line)) = datum.assigned.or(stated.and_then(|stated| stated.assigned)) {
            let place = match at == file.index {
                true => String::new(),
                false => format!("{}, ", self.files[at].source.name()),
            };
            return Err((
                format!("`{shown}` is changed while the program runs ({place}line {line})"),
                WRITE_IT,
            ));
        }
        match stated {
            Some(stated) => Ok((datum, stated)),
            None => Err((
                format!("`{}` has no value in these files", file.text(tokens)),
                "give the .dat file that states it as well",
            )),
        }
    }

    /// The members of a datum.
    fn members(
        &self,
        routine: usize,
        tokens: &Range<usize>,
    ) -> Option<(&TokenFile<'p>, Aggregate)> {
        let (datum, stated) = self.datum(routine, tokens).ok()?;
        let file = &self.files[datum.file];
        Some((file, aggregate_of(file, &stated.value)?))
    }

    /// What a FDAT states.
    pub(crate) fn point_data(&self, routine: usize, tokens: &Range<usize>) -> Option<PointData> {
        let (file, members) = self.members(routine, tokens)?;
        let number = |name: &str| {
            let value = members.number(file, name)?;
            ((0.0..1e6).contains(&value) && value.fract() == 0.0).then_some(value as u32)
        };
        let mode = members.member("IPO_FRAME").map(|tokens| file.text(tokens));
        Some(PointData {
            tool: number("TOOL_NO"),
            base: number("BASE_NO"),
            is_external: mode.is_some_and(|mode| mode.trim().eq_ignore_ascii_case("#TCP")),
        })
    }

    /// A number of a LDAT or PDAT.
    pub(crate) fn member(
        &self,
        routine: usize,
        tokens: &Range<usize>,
        capitals: &str,
    ) -> Option<f64> {
        let (file, members) = self.members(routine, tokens)?;
        members.number(file, capitals)
    }

    /// A number, a quotient of numbers, or a constant of that name.
    pub(crate) fn number(&self, routine: usize, tokens: &Range<usize>) -> Option<f64> {
        let file = self.file(routine);
        if let Some(slash) = file.find(tokens.clone(), b'/') {
            let above = number_of(file, &(tokens.start..slash))?;
            let quotient = above / number_of(file, &(slash + 1..tokens.end))?;
            return quotient.is_finite().then_some(quotient);
        }
        if let Some(number) = number_of(file, tokens) {
            return Some(number);
        }
        let (datum, stated) = self.datum(routine, tokens).ok()?;
        number_of(&self.files[datum.file], &stated.value)
    }
}

pub(crate) const WRITE_IT: &str =
    "write the motion with a literal or a target of the .dat, or leave it as written when reading";
